"""Drawings of the models name what the equations beside them name."""

import pytest
from matplotlib.colors import to_rgba
from matplotlib.text import Text

from compendium.plotting import models


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
