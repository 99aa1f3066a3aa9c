"""Drawings of the models name what the equations beside them name."""

import pytest
from matplotlib.colors import to_rgba
from matplotlib.text import Text

from compendium.plotting import model_details, models


@pytest.mark.parametrize(
    ("draw", "names"),
    [
        (models.disk_and_pinion, {"$m_p$", "$k_b$", "$c_b$", r"$\theta_c$", "$r_c$", r"$\Omega_2$"}),
        (models.position_and_phase, {r"$\theta_c$", r"$\theta_q$", r"$\theta_p$", r"$\theta_N = 2\pi/N_2$"}),
        (models.edge_load, {"$F_t$", "$a$", "follower", "dead"}),
        (
            models.torsional_chain,
            {"$J_1$", "$J_2$", "$J_o$", "$k_1$", "$k_2$", "$k_m$", "$c_m$", r"$\chi_o$"},
        ),
        (models.flexible_teeth, {"$k_z$", "$c_z$", "$w_m$", "front", "back", "gear 1", "gear 2"}),
        (models.backlash, {"$g$", "$b$", "$-b$", "$k_m$", "$c_m$", "forward", "backward"}),
        (model_details.periodic_spring, {"$q$", r"$2\vartheta\omega_0$", "Mathieu", "Meissner"}),
        (model_details.pair_of_gears, {"$m_1$", "$m_2$", "$w(t)\\,k$", "$w(t)\\,c$", "$c_r T_0$", "$T_0$"}),
        (model_details.pressed_slices, {r"$\eta$", r"$\delta$", "pinion", "face gear"}),
        (model_details.body_dimensions, {"$h$", "$b$", "$a = R_2$", "$R_1$", "$L$", "$F_t$", "$H$", "$W$"}),
        (model_details.heavy_shafts, {"$J_1$", "$J_2$", "$J_o$", "$k_m$", "$c_m$", r"$\chi_a$", r"$\chi_b$"}),
        (model_details.weak_tooth, {"$j$", "$T_0$", "$N_2$ teeth"}),
    ],
)
def test_drawing_names_what_its_equations_name(draw, names):
    figure = draw()
    assert names <= {text.get_text() for text in figure.findobj(Text)}
    assert figure.get_facecolor() == to_rgba("white")


def test_number_of_teeth_drawn_changes_the_pitch_and_not_the_names():
    few, many = (models.position_and_phase(pitches) for pitches in (18, 36))
    assert len(few.axes[0].lines) < len(many.axes[0].lines)
    assert {t.get_text() for t in few.findobj(Text)} == {t.get_text() for t in many.findobj(Text)}


def test_a_pair_of_gears_has_more_pairs_in_mesh_the_longer_each_stays():
    shares = [
        (model_details.pair_of_gears(ratio, droop=0.0).axes[1].lines[-1].get_ydata() > 1.5).mean()
        for ratio in (1.2, 1.5, 1.8)
    ]
    assert shares == sorted(shares)
    assert shares[0] < shares[-1]
