"""Numbers that the report on a drive tells one by one."""

from dataclasses import replace

import pytest

from facegear.design.envelope import mode_critical_powers
from facegear.design.teeth import root_stress
from facegear.drives import report_rows
from facegear.drives.drive_file import read_drive_file
from facegear.drives.verdict import driven
from facegear.mechanics.spreads import PitchPoint, RimPoint
from facegear.support.parameters import rad_per_s
from tests.drives.drive_files import DRIVES

CASE_1 = read_drive_file(DRIVES / "case_1.yaml")
TWO_GEARS = read_drive_file(DRIVES / "two_gears.yaml")
EXAMPLE_B = read_drive_file(DRIVES / "example_b.yaml")


def values(rows):
    return {row.quantity: row.value for row in rows}


def test_geometry_has_the_printed_numbers():
    found = values(report_rows.geometry(CASE_1))
    assert found["outer radius of the teeth R2"] == pytest.approx(231.94, abs=5e-3)
    assert found["contact ratio, Tregold"] == pytest.approx(1.5532, abs=5e-5)
    assert found["gear ratio N2/N1"] == 5.0
    assert found["thickness of the body"] == pytest.approx(0.03 * found["outer radius of the teeth R2"])
    assert found["bearing stiffness"] == found["stiffness of the disk that bearings are measured by"]


def test_strength_follows_duty_and_material():
    found = values(report_rows.strength(CASE_1))
    assert found["allowable stress"] == pytest.approx(439.9 / 1.5)
    stress = root_stress(CASE_1.drive, 447420.0, rad_per_s(5000.0))
    assert found["largest stress at the root"] == pytest.approx(1e-6 * stress)
    assert found["allowable over largest stress"] == pytest.approx(439.9e6 / 1.5 / stress)


FOLLOWER = "critical power of a pinion, disk alone, force follows the rim"
DEAD = "critical power of a pinion, disk alone, force keeps its direction"
POINTS = {"rim": RimPoint(), "pitch": PitchPoint()}
RATIO = "critical power over power of a pinion, force follows the rim"


@pytest.mark.slow
def test_flutter_needs_damping_to_be_kept_off():
    model, duty = CASE_1.transverse, CASE_1.requirements
    found = values(report_rows.flutter(model, duty))
    assert found["power of a pinion"] == pytest.approx(447.42)
    assert found[RATIO] == pytest.approx(found[FOLLOWER] / 447.42)
    assert found[DEAD] > 10 * found[FOLLOWER]
    # P_c ≈ ξω³/ε: in proportion to the loss factor.
    for factor, expected in ((2.0, 2.0), (0.0, 0.0)):
        loss = factor * model.body.material.viscous_loss_factor
        other = replace(model.body, material=replace(model.body.material, viscous_loss_factor=loss))
        ratio = values(report_rows.flutter(replace(model, body=other), duty))[RATIO]
        assert ratio == pytest.approx(expected * found[RATIO], rel=0.02, abs=1e-12)


@pytest.mark.slow
def test_two_pinions_flutter_at_half_the_power_of_each():
    """The report of a drive with two pinions gave that of one: twice what is right."""
    both, duty = EXAMPLE_B.transverse, EXAMPLE_B.requirements
    alone = values(report_rows.flutter(replace(both, pinion_angles=(0.0,)), duty))
    together = values(report_rows.flutter(both, duty))
    assert together[RATIO] == pytest.approx(alone[RATIO] / 2, rel=0.01)
    # First order, in closed form: the mean shear of p forces is p times that of one.
    first = float(mode_critical_powers(both.body, duty.pinion_speed).min())
    assert together[FOLLOWER] == pytest.approx(1e-3 * first / 2, rel=0.01)


@pytest.mark.slow
def test_a_force_at_the_pitch_circle_flutters_at_the_power_of_its_first_order():
    """In closed form; on the pairs in mesh chapter 8 anchors 1.08 to 1.14 times the power at the rim."""
    contact = CASE_1.contacts["Tregold"]
    found = {}
    for place in ("rim", "pitch", "pairs"):
        model = driven(replace(CASE_1, force_at=place), "follower", contact)
        found[place] = values(report_rows.flutter(model, CASE_1.requirements))[FOLLOWER]
    body, speed = CASE_1.transverse.body, CASE_1.requirements.pinion_speed
    first = {place: mode_critical_powers(body, speed, spread).min() for place, spread in POINTS.items()}
    for place, power in first.items():
        assert found[place] == pytest.approx(1e-3 * power, rel=0.01)
    assert 1.08 < found["pairs"] / found["rim"] < 1.14


def test_between_two_gears_the_one_that_all_meshes_drive_flutters_first():
    """An idler drives the lower gear as an input does, and holds the upper one back."""
    both, duty = TWO_GEARS.transverse, TWO_GEARS.requirements
    lower = values(report_rows.flutter(both.gear, duty))
    found = values(report_rows.flutter(both, duty))
    assert list(found) == [name.replace("a pinion", "a mesh") for name in lower]
    found = dict(zip(lower, found.values(), strict=True))
    assert found[FOLLOWER] == pytest.approx(lower[FOLLOWER], rel=1e-9)
    # Without their mean shear the forces hardly make anything flutter.
    idle = values(report_rows.flutter(replace(both, roles=("input", "output")), duty))
    assert idle[FOLLOWER.replace("a pinion", "a mesh")] > 2.0 * lower[FOLLOWER]
