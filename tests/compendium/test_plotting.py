"""Figures: each draws what it is given, and leaves Matplotlib's settings alone."""

import json

import ipywidgets
import matplotlib as mpl
import numpy as np
import pytest

from compendium.datasets import accuracy as accuracy_arrays
from compendium.datasets import meshing as meshing_arrays
from compendium.datasets import stability as stability_arrays
from compendium.datasets import tooth_limits as limit_arrays
from compendium.plotting import meshing, schematics, stability, tooth_limits
from facegear import Drive
from facegear.floquet import methods
from facegear.geometry import solids
from facegear.maps.stability_map import stability_map
from facegear.mechanics import classical, classical_pairs
from facegear.plotting import interactive, style
from tests.figures import texts

DRIVE = Drive(26, 130, 3.175e-3)
TOOTH = meshing_arrays.tooth_and_contact_lines(DRIVE, lines=5, points=9)
RATIOS = limit_arrays.contact_ratios(DRIVE, (25, 26, 27))
LENGTH = meshing_arrays.mesh_length(DRIVE, 1.5, samples=21)


@pytest.mark.parametrize(
    ("draw", "shown"),
    [
        (lambda: meshing.tooth_and_contact_lines(TOOTH), "axial [mm]"),
        (lambda: meshing.contact_points(TOOTH), "(b) from the side"),
        (lambda: meshing.contact_line(TOOTH.isel(fraction=[2]), TOOTH), "length 27.8 mm"),
        (
            lambda: meshing.contact_point_positions(
                meshing_arrays.contact_point_positions(DRIVE, 1.5, samples=21)
            ),
            "pair 4",
        ),
        (
            lambda: meshing.contact_centroid_sketch(
                meshing_arrays.contact_centroid_instants(DRIVE, 1.5, [0.25, 0.75])
            ),
            "(b) $t/T_0$ = 0.75",
        ),
        (
            lambda: meshing.contact_centroid_positions(
                meshing_arrays.contact_centroid_motion(DRIVE, 1.5, samples=21)
            ),
            "contact centroid",
        ),
        (lambda: meshing.skew_lines(meshing_arrays.skew_lines(DRIVE, 1.5, samples=21)), "skew line, pair 3"),
        (lambda: tooth_limits.contact_ratio_after_tregold(RATIOS, marked=(26,)), "1.5532"),
        (lambda: tooth_limits.contact_ratios_compared(RATIOS, LENGTH, LENGTH), "true contact lines"),
        (
            lambda: tooth_limits.undercut_condition(
                limit_arrays.undercut_condition(DRIVE, np.linspace(-0.5, 0.5, 9))
            ),
            "physical",
        ),
        (
            lambda: tooth_limits.limits_against_shaft_angle(
                limit_arrays.limits_against_shaft_angle(DRIVE, (80.0, 90.0))
            ),
            "Tregold",
        ),
        (lambda: tooth_limits.top_land(limit_arrays.top_land(DRIVE, samples=21)), "$R_2$ = 231.939 mm"),
        (
            lambda: schematics.shaper_profile(
                DRIVE, solids.pinion_outline(DRIVE), DRIVE.pinion_flank(2, 9).points[0, :, :2], step=5
            ),
            "base circle",
        ),
        (lambda: schematics.coordinate_systems(DRIVE, 0.5), "(c) face gear"),
        (lambda: schematics.limiting_ends(DRIVE), "section A"),
        (lambda: schematics.tregold_cones(DRIVE), "formative pinion"),
        (lambda: schematics.generation(solids.pinion(DRIVE), solids.face_gear(DRIVE)), ""),
    ],
)
def test_figures_draw_and_carry_their_labels(draw, shown):
    before = dict(mpl.rcParams)
    figure = draw()
    figure.canvas.draw()
    assert shown in texts(figure)
    assert dict(mpl.rcParams) == before


def test_the_cones_are_drawn_at_a_right_angle_only():
    with pytest.raises(ValueError, match="shaft_angle must be 90°"):
        schematics.tregold_cones(Drive(26, 130, 3.175e-3, shaft_angle=np.radians(80.0)))


def test_turning_view_carries_both_bodies_and_its_description():
    view = interactive.turning_view(solids.pinion(DRIVE), solids.face_gear(DRIVE), "pinion & <gear>")
    bundle = view._repr_mimebundle_()
    assert [trace["name"] for trace in bundle["application/vnd.plotly.v1+json"]["data"]] == [
        "face gear",
        "pinion",
    ]
    html = bundle["text/html"]
    assert 'aria-label="pinion &amp; &lt;gear&gt;"' in html
    inside = html.split('<script type="application/json">')[1].split("</script>")[0]
    assert json.loads(inside)["data"][0]["type"] == "mesh3d"


def test_slider_has_a_picture_with_a_description_for_every_step():
    figures = [meshing.contact_line(TOOTH.isel(fraction=[k]), TOOTH) for k in (1, 2)]
    box = interactive.slider(figures, ["1°", "2°"], ["first", "second"], "rotation")
    control, stack = box.children
    assert isinstance(stack, ipywidgets.Stack)
    assert [label for label, _ in control.options] == ["1°", "2°"]
    assert [
        f'alt="{alt}"' in page.value for alt, page in zip(("first", "second"), stack.children, strict=True)
    ] == [True] * 2


GEARS = classical_pairs.GearPair(1.563, droop=0.4, shaft_damping=0.02).system(1.1)
MATHIEU = classical.Mathieu(1.0)
GROWTH = stability_map(MATHIEU, np.linspace(0.5, 2.5, 9), "depth", np.linspace(0.0, 0.9, 7), jobs=1)
CHART = stability_arrays.chart(GROWTH, "Mathieu")
BANDS = stability_arrays.bands(MATHIEU, [0.1, 0.5], 2, "Mathieu")
DAMPED = stability_arrays.damped_charts(np.linspace(1.5, 2.5, 5), np.linspace(0.0, 0.9, 7), [0.05])


@pytest.mark.parametrize(
    ("draw", "shown"),
    [
        (
            lambda: stability.swing(stability_arrays.swing(0.3, [1.5, 2.0], [2.0, 1.5], cycles=2)),
            "(a) multipliers",
        ),
        (
            lambda: stability.convergence(
                {"(c) jumps": accuracy_arrays.convergence(GEARS, [8, 16, 32], "gears")},
                {"(c) jumps": {"uniform": 0.87, "aligned": 1.99, "magnus": 3.94}},
            ),
            "3.94",
        ),
        (
            lambda: stability.doubling(accuracy_arrays.doubling(GEARS, 16, 2, "gears")),
            "change from half as many",
        ),
        (
            lambda: stability.estimates(
                accuracy_arrays.estimates(GEARS, [("magnus", methods.Magnus(16))], "gears")
            ),
            "Magnus, aligned",
        ),
        (
            lambda: stability.bordered_chart(
                CHART, stability_arrays.transition_curves([0.0, 0.9], 2), BANDS, "tridiagonal eigenproblem"
            ),
            "tridiagonal eigenproblem",
        ),
        (
            lambda: stability.duty_chart(stability_arrays.duty_chart([1.5, 2.0], [0.3, 0.5], 0.4)),
            "duty (contact ratio − 1)",
        ),
        (lambda: stability.damped_chart(DAMPED.sel(damping_ratio=0.05), BANDS, 0.3), r"$\vartheta$ = 0.05"),
        (
            lambda: stability.hsu_errors(
                stability_arrays.hsu_errors([0.05, 0.1]), {"width": 1.0, "error": 2.0, "second_width": 2.0}
            ),
            "which Hsu lacks",
        ),
        (lambda: stability.pair_charts({"(a) spring": CHART}, {"(a) spring": BANDS}), "(1+1)/1"),
    ],
)
def test_stability_figures_draw_and_carry_their_labels(draw, shown):
    before = dict(mpl.rcParams)
    figure = draw()
    figure.canvas.draw()
    assert shown in texts(figure)
    assert dict(mpl.rcParams) == before


def test_unstable_colours_stand_off_white_and_darken_in_grey():
    # Relative luminance; white is 1.
    luminance = style.GROWTH(np.linspace(0.0, 1.0, 64))[:, :3] @ [0.2126, 0.7152, 0.0722]
    assert luminance[0] < 0.9
    assert (np.diff(luminance) < 0.0).all()
