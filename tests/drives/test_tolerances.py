"""Tolerances of a drive: factors on the right parameters, borders against values drawn at random."""

from pathlib import Path

import numpy as np
import pytest

from facegear.drives.drive_file import DriveFileError, parse_drive, read_drive_file
from facegear.drives.intervals import united
from facegear.drives.tolerances import Toleranced, Tolerances, worst_case
from facegear.drives.verdict import driven
from facegear.maps.tracing import tongues
from facegear.support.parameters import rad_per_s

DRIVES = Path(__file__).resolve().parents[2] / "data" / "drives"
CASE_1 = read_drive_file(DRIVES / "case_1.yaml")
BOTH = read_drive_file(DRIVES / "both_faces.yaml")
TREGOLD = driven(CASE_1, "dead", CASE_1.contacts["Tregold"])
SWEEP = driven(CASE_1, "dead", CASE_1.contacts["true sweep"])
RANGE = (float(rad_per_s(570.0)), float(rad_per_s(605.0)))


def test_more_stiffness_leaves_damping_as_it_is_and_the_other_way_round():
    stiff, damped = Toleranced(TREGOLD, stiffness_factor=1.2), Toleranced(TREGOLD, damping_factor=1.5)
    one, other, third = (model.system(60.0) for model in (TREGOLD, stiff, damped))
    (load,), (stiffer,), (more,) = one.loads, other.loads, third.loads
    assert (stiffer.stiffness, stiffer.damping) == pytest.approx(
        (1.2 * load.stiffness, load.damping), rel=1e-12
    )
    assert (more.stiffness, more.damping) == pytest.approx((load.stiffness, 1.5 * load.damping), rel=1e-12)
    np.testing.assert_allclose(other.stiffness, one.stiffness, rtol=1e-12)
    # The disk's viscous damping, beside what its rotation adds, which no tolerance changes.
    viscous = np.diag(one.damping)
    np.testing.assert_allclose(np.diag(third.damping), 1.5 * viscous, rtol=1e-9)


def test_springs_of_teeth_change_with_those_of_bearings():
    own = BOTH.transverse
    changed = Toleranced(own, 1.1, 0.8).changed
    assert changed.mesh_stiffness == pytest.approx(1.1 * own.mesh_stiffness, rel=1e-15)
    assert changed.mesh_damping * changed.mesh_stiffness == pytest.approx(
        0.8 * own.mesh_damping * own.mesh_stiffness, rel=1e-12
    )
    assert changed.gear.body.material.viscous_loss_factor == pytest.approx(
        0.8 * own.gear.body.material.viscous_loss_factor, rel=1e-15
    )


def test_without_tolerances_the_drive_is_as_it_is():
    found = worst_case(TREGOLD, RANGE, Tolerances())
    assert list(found.corners) == [(1.0, 1.0)]
    own = tongues(TREGOLD, RANGE)
    expected = united([(tongue.lower, tongue.upper) for tongue in own])
    np.testing.assert_allclose(found.swept, expected, rtol=1e-9)


def test_values_drawn_at_random_are_unstable_only_where_borders_say():
    tolerances = Tolerances(stiffness=0.1, damping=0.3)
    found = worst_case(TREGOLD, RANGE, tolerances)
    own = sum(tongue.width for tongue in tongues(TREGOLD, RANGE)) / (RANGE[1] - RANGE[0])
    assert found.share > 1.05 * own
    for stiffness, damping in np.random.default_rng(3).uniform([0.9, 0.7], [1.1, 1.3], (4, 2)):
        for tongue in tongues(Toleranced(TREGOLD, float(stiffness), float(damping)), RANGE):
            assert any(
                low - 1e-9 <= tongue.lower and tongue.upper <= high + 1e-9 for low, high in found.swept
            )


def test_speeds_beyond_the_range_are_looked_at():
    found = worst_case(TREGOLD, RANGE, Tolerances(speed=0.05))
    assert found.speeds == pytest.approx((0.95 * RANGE[0], 1.05 * RANGE[1]), rel=1e-12)


def test_a_drive_that_stays_stable():
    narrow = (float(rad_per_s(540.0)), float(rad_per_s(545.0)))
    found = worst_case(SWEEP, narrow, Tolerances(stiffness=0.02))
    assert (found.is_stable, found.swept, found.opens, found.share) == (True, (), (), 0.0)


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ("stiffness_percent: 0.01", r"tolerances.stiffness_percent must lie in .0.1, 50. in %, got 0.01"),
        ("damping_percent: 90", r"tolerances.damping_percent must .*got 90"),
        ("speed_percent: ten", r"tolerances.speed_percent must be .*got 'ten'"),
    ],
)
def test_keys_of_a_file(keys, message):
    text = (DRIVES / "case_1.yaml").read_text(encoding="utf-8")
    with pytest.raises(DriveFileError, match=message):
        parse_drive(f"{text}\ntolerances:\n  {keys}\n")


def test_a_file_gives_parts_of_one():
    text = (DRIVES / "case_1.yaml").read_text(encoding="utf-8")
    found = parse_drive(f"{text}\ntolerances:\n  stiffness_percent: 10\n  speed_percent: 2\n").tolerances
    assert found == Tolerances(stiffness=0.1, speed=0.02)
    assert not parse_drive(text).tolerances.given


def test_a_speed_beyond_what_the_rim_bears_is_refused():
    text = (DRIVES / "case_1.yaml").read_text(encoding="utf-8")
    text = text.replace("highest_speed_rpm: 1000", "highest_speed_rpm: 41000")
    text = text.replace("lowest_speed_rpm: 100", "lowest_speed_rpm: 5000")
    limit = pytest.raises(
        DriveFileError, match=r"tolerances.speed_percent must be at most .* for this body.*got 50"
    )
    with limit:
        parse_drive(f"{text}\ntolerances:\n  speed_percent: 50\n")
