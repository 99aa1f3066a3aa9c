"""Ranking of changes: slopes against tongues traced anew."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from facegear.design.changes import (
    Change,
    effects_of_changes,
    possible_changes,
    slopes_of_tongues,
    unstable_width,
)
from facegear.drives.drive_file import read_drive_file
from facegear.floquet.labels import Combination
from facegear.floquet.models import replace_at
from facegear.floquet.multipliers import growth_rate
from facegear.geometry.drive import Drive
from facegear.maps.tracing import Tongue, tongues
from facegear.mechanics.cases import EXAMPLE_B
from facegear.mechanics.contact import Contact
from facegear.mechanics.gearboxes import FIGURES
from facegear.mechanics.mesh_oscillator import MeshOscillator
from facegear.mechanics.paths import loaded_contact
from facegear.mechanics.plate import Body
from facegear.mechanics.properties import STEEL, MeshLoad
from facegear.mechanics.torsional import Torsional
from facegear.mechanics.two_gears import TwoGears
from facegear.support.parameters import rad_per_s, rpm

DRIVES = Path(__file__).resolve().parents[2] / "data" / "drives"
CASE_1 = read_drive_file(DRIVES / "case_1.yaml").transverse
PAIR = read_drive_file(DRIVES / "example_b.yaml").transverse
BOX = read_drive_file(DRIVES / "gearbox_table_7_1.yaml").torsional
MODULE = ("body", "drive", "module")
# One tongue inside, one cut off by the end of the range.
RANGE = (float(rad_per_s(620.0)), float(rad_per_s(880.0)))


def names(model):
    return [change.name for change in possible_changes(model)]


def test_what_can_be_changed():
    assert names(CASE_1) == [
        "thickness of the body",
        "bore radius",
        "loss factor of the material",
        "bearing stiffness",
        "bearing damping",
        "pinion mass",
    ]
    assert names(PAIR)[-1] == "phase of pinion 2"
    assert len(names(BOX)) == 9
    undamped = replace(CASE_1, load=replace(CASE_1.load, damping=0.0))
    assert "bearing damping" not in names(undamped)


def test_changes_change_what_they_say():
    changes = {change.name: change for change in possible_changes(PAIR)}
    assert changes["pinion mass"].apply(PAIR, 0.1).load.mass == pytest.approx(1.1)
    assert changes["thickness of the body"].apply(PAIR, -0.5).body.thickness_ratio == pytest.approx(0.035)
    moved = changes["phase of pinion 2"].apply(PAIR, 0.25)
    turned = (moved.pinion_angles[1] - PAIR.pinion_angles[1]) / PAIR.body.drive.angular_pitch
    assert moved.pinion_angles[0] == PAIR.pinion_angles[0]
    assert turned == pytest.approx(0.25)


@pytest.mark.parametrize(
    ("model", "speeds"),
    [
        pytest.param(CASE_1, RANGE, id="case 1", marks=pytest.mark.slow),
        pytest.param(
            PAIR,
            (float(rad_per_s(840.0)), float(rad_per_s(890.0))),
            id="two pinions",
            marks=pytest.mark.slow,
        ),
    ],
)
def test_slopes_are_those_of_tongues_traced_anew(model, speeds):
    found = tongues(model, speeds)
    effects = effects_of_changes(model, found, speeds, "", followed=0)
    changes = {change.name: change for change in possible_changes(model)}
    order = effects["change_name"].values.tolist()
    assert sorted(order) == sorted(changes)
    assert (np.diff(np.abs(effects["width_slope"])) <= 0).all()
    for name in (order[0], order[-1]):
        step = 1e-3
        ends = [tongues(changes[name].apply(model, sign * step), speeds) for sign in (1, -1)]
        width = (unstable_width(ends[0]) - unstable_width(ends[1])) / (2 * step)
        growth = np.diff([max(tongue.growth_rate for tongue in end) for end in reversed(ends)])[0] / (
            2 * step
        )
        row = effects.isel(change=order.index(name))
        assert float(row["width_slope"]) == pytest.approx(rpm(width) / 100, rel=1e-3, abs=1e-5), name
        assert float(row["growth_slope"]) == pytest.approx(growth / 100, rel=1e-3, abs=1e-7), name


def relative_slopes(model, speeds, further=()):
    """Slopes of the logarithm of each border by that of each variable, by its name, each over (tongue, border)."""
    changes = (*possible_changes(model), *further)
    found = tongues(model, speeds)
    borders = np.array([[tongue.lower, tongue.upper] for tongue in found])
    slopes = slopes_of_tongues(model, changes, found, speeds)[..., :2] / borders
    return dict(zip([change.name for change in changes], slopes, strict=True))


def test_growth_is_differentiated_at_the_very_peak_where_that_moves_along():
    """As the largest growth of changed models, each found by Newton's method; seven digits of the peak give five."""
    speeds = (float(rad_per_s(190.0)), float(rad_per_s(200.0)))
    model = replace(EXAMPLE_B, pinion_angles=(0.0, math.pi / 2.0))
    (tongue,) = tongues(model, speeds)

    def largest(factor):
        changed, peak, step = thicker(model, factor), tongue.peak, 1e-4 * tongue.width
        for _ in range(4):
            three = [growth_rate(changed.system(peak + k * step)) for k in (-1.0, 0.0, 1.0)]
            peak += 0.5 * step * (three[0] - three[2]) / (three[0] - 2.0 * three[1] + three[2])
        return growth_rate(changed.system(peak))

    changes = possible_changes(model)[:1]
    assert changes[0].name == "thickness of the body"
    found = slopes_of_tongues(model, changes, (tongue,), speeds)[0, 0, 2]
    assert found == pytest.approx((largest(1.0 + 1e-6) - largest(1.0 - 1e-6)) / 2e-6, rel=5e-6)


def thicker(model, factor):
    return replace_at(model, ("body", "thickness_ratio"), factor * model.body.thickness_ratio)


def test_larger_drives_of_the_same_shape_are_slower_in_proportion():
    """All lengths and all times grow alike where the material is the same: every border falls by as much.

    The first tongue belongs to a mode with little damping: differences over 1e-4 missed this by seven percent.
    """
    larger = Change(
        "module", lambda model, part: replace_at(model, MODULE, model.body.drive.module * (1.0 + part))
    )
    slopes = relative_slopes(CASE_1, (float(rad_per_s(100.0)), float(rad_per_s(150.0))), [larger])
    together = sum(
        slopes[name] for name in ("module", "bore radius", "loss factor of the material", "bearing damping")
    )
    np.testing.assert_allclose(together, -1.0, rtol=1e-4)


def test_gearboxes_keep_their_borders_in_other_units_of_time_and_mass():
    """Other units of mass and time change no tongue: that binds the slopes of inertias, stiffnesses and dampings."""
    slopes = relative_slopes(
        Torsional(FIGURES["7.12b"].gearbox.in_si), (float(rad_per_s(130.0)), float(rad_per_s(270.0)))
    )
    of = {
        kind: sum(value for name, value in slopes.items() if kind in name)
        for kind in ("inertia", "stiffness", "damping")
    }
    np.testing.assert_allclose(2.0 * of["inertia"] + of["damping"], -1.0, rtol=1e-3)
    np.testing.assert_allclose(of["inertia"] + of["stiffness"] + of["damping"], 0.0, atol=2e-5)


def test_what_stands_in_several_places_changes_in_all_of_them():
    soft = replace(STEEL, viscous_loss_factor=1e-6)
    body = replace(CASE_1.body, drive=replace(CASE_1.body.drive, shaper_teeth=27), material=soft)
    model = replace(CASE_1, body=body, contact=Contact(path=loaded_contact(100.0, material=soft)))
    changes = possible_changes(model)
    assert len({change.name for change in changes}) == len(changes)
    (change,) = [change for change in changes if change.name == "loss factor of the material"]
    changed = change.apply(model, 0.1)
    assert changed.body.material == changed.contact.path.material == replace(soft, viscous_loss_factor=1.1e-6)


def test_best_changes_are_made_in_earnest_in_the_better_direction():
    found = tongues(CASE_1, RANGE)
    effects = effects_of_changes(CASE_1, found, RANGE, "", followed=1)
    best = effects["change_name"].values[0]
    (change,) = [change for change in possible_changes(CASE_1) if change.name == best]
    sign = -np.sign(effects["width_slope"].values[0])
    after = tongues(change.apply(CASE_1, 0.1 * sign), RANGE)
    assert float(effects["width_after"][0]) == pytest.approx(rpm(unstable_width(after)), rel=1e-9)
    assert unstable_width(after) < unstable_width(found)
    assert np.isnan(effects["width_after"][1:]).all()


@pytest.mark.slow
def test_a_change_out_of_range_is_left_out():
    thin = replace(CASE_1, body=replace(CASE_1.body, bore_radius=0.0125))
    found = tongues(thin, RANGE)
    effects = effects_of_changes(thin, found, RANGE, "", followed=6)
    after = dict(zip(effects["change_name"].values.tolist(), effects["width_after"].values, strict=True))
    # Ten percent less and b/a is below 0.05, which the body refuses.
    smaller = float(effects["width_slope"][list(after).index("bore radius")]) > 0
    assert np.isnan(after["bore radius"]) == smaller
    assert smaller
    assert np.isfinite([value for name, value in after.items() if name != "bore radius"]).all()


def test_number_followed_is_checked():
    with pytest.raises(ValueError, match="followed must be at least 0, got -1"):
        effects_of_changes(CASE_1, (), RANGE, "", followed=-1)


def test_a_value_at_the_end_of_its_range_is_differentiated_to_one_side():
    """The largest damping that is valid: the ranking holds that parameter as well, with the slope from below."""
    model = replace(CASE_1, load=replace(CASE_1.load, damping=0.01))
    tongue = Tongue(60.0, 61.0, 60.5, 1.0, Combination(1, 1, "sum", 1))
    table = effects_of_changes(model, [tongue], (50.0, 70.0), "at the limit", followed=0)
    place = table["change_name"].values.tolist().index("bearing damping")

    def one_sided(step):
        lower = replace(model, load=replace(model.load, damping=0.01 * (1 - step)))
        return (growth_rate(model.system(60.5)) - growth_rate(lower.system(60.5))) / step

    extrapolated = 2.0 * one_sided(1e-4) - one_sided(2e-4)
    assert float(table["growth_slope"][place]) == pytest.approx(
        extrapolated / 100, rel=1e-3
    )  # as its array says


def test_what_a_model_refuses_in_both_directions_is_left_out():
    """Pinions between two gears stand at whole halves of the angular pitch, and cannot be moved by parts of it."""
    body = Body(Drive(26, 130, 3.175e-3), 0.03, nodal_circles=0, nodal_diameters=1)
    angles = (0.0, 20 * body.drive.angular_pitch)
    gear = MeshOscillator(body, MeshLoad(0.7, 3e-6, 1.0), angles, mesh_stiffness=2e8, mesh_damping=1e-5)
    tongue = Tongue(60.0, 61.0, 60.5, 0.1, Combination(1, 2, "sum", 1))
    table = effects_of_changes(TwoGears(gear), [tongue], (50.0, 70.0), "", followed=0)
    found = table["change_name"].values.tolist()
    assert "mesh stiffness" in found
    assert "phase of pinion 2" not in found
