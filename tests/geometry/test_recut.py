"""Flank that the shaper leaves between shafts at more than 90°, against the brute force of `shaper_envelope`."""

import math

import numpy as np
import pytest

from facegear import Drive
from facegear.geometry.kinematics import ContactPath
from facegear.geometry.proportions import SHAPER_OVERHANG
from facegear.mechanics.contact import Contact
from tests.independent.shaper_envelope import shaper_of


def drive_of(teeth, pressure_deg, shaft_deg):
    return Drive(*teeth, 1e-3, math.radians(pressure_deg), math.radians(shaft_deg))


def drawn(count):
    """Draw drives at random, always the same ones, every second one with a ratio near one."""
    rng = np.random.default_rng(20)
    while count:
        pinion = int(rng.integers(12, 80))
        ratio = rng.uniform(1.02, 1.6) if count % 2 else rng.uniform(1.6, 6.0)
        try:
            yield drive_of((pinion, math.ceil(pinion * ratio)), rng.uniform(16, 28), rng.uniform(91, 120))
        except ValueError:  # pointed shaper
            continue
        count -= 1


NAMED = [
    drive_of((20, 60), 20.0, 110.0),
    drive_of((26, 30), 25.0, 100.0),
    drive_of((25, 26), 22.5, 120.0),
    drive_of((30, 40), 20.0, 105.0),
    drive_of((26, 130), 25.0, 105.0),
]
RANDOM = list(drawn(10))


def label(drive):
    degrees = (math.degrees(drive.pressure_angle), math.degrees(drive.shaft_angle))
    return f"{drive.pinion_teeth}/{drive.gear_teeth} {degrees[0]:.1f} {degrees[1]:.1f}"


some_drives = [*NAMED, *RANDOM[:2], *(pytest.param(drive, marks=pytest.mark.slow) for drive in RANDOM[2:])]
every_drive = pytest.mark.parametrize("drive", some_drives, ids=label)


def within(drive, roll, turn, points):
    """Whether points of the generated flank lie on the tooth and within the pinion's reach."""
    x, y, z, _ = points
    c, s = np.cos(drive.speed_ratio * turn), np.sin(drive.speed_ratio * turn)
    out = -(s * x + c * y)  # −y_p of the generating position
    top = -z * math.sin(drive.shaft_angle) - np.hypot(x, y) * math.cos(drive.shaft_angle)
    slack = 1e-12
    on_tooth = (out >= drive.inner_radius - slack) & (out <= drive.outer_radius + slack)
    return on_tooth & (top >= drive.tooth_top_distance - slack) & (roll <= drive.pinion_tip_roll)


def left_on_line(drive, shaper, rolls, turn):
    """Which profile points of one contact line are left."""
    points = shaper.generated(rolls, turn)
    inside = within(drive, rolls, turn, points)
    # α > 0: the other branch of the meshing surface is no tooth.
    inside &= turn + drive.space_half_angle + rolls > 0.0
    left = inside.copy()
    depth = shaper.deepest(*(p[inside] for p in points[:3]), np.full(inside.sum(), turn))
    left[inside] = depth < 1e-10 * drive.base_radius
    return left, inside


@every_drive
def test_points_that_are_cut(drive):
    flank, shaper = drive.tooth_flank(25, 9), shaper_of(drive)
    x, y, z, _ = shaper.generated(flank.roll, flank.rotation)
    np.testing.assert_allclose(np.stack([x, y, z], axis=-1), flank.points, rtol=0, atol=1e-15)
    depth = shaper.deepest(x, y, z, flank.rotation)
    alpha = flank.rotation + flank.roll + drive.space_half_angle
    clearance = drive.base_radius * drive.contact_region.shaper.clearance(alpha, flank.roll)
    # The lowest row is the corner of the tip itself; flanks that have crossed are the other flank's to cut.
    tooth = (np.arange(9) < 8) & (flank.points[..., 0] > 0.0)
    assert ((clearance < -1e-9) == (depth > 1e-9))[tooth].all()
    # Behind the shaper's flank lies what is inside its tooth, by the shortest way out or by a longer one; what is cut
    # very deep may lie deeper in the tooth on the other side.
    cut = tooth & (depth > 1e-9) & (depth < 0.01 * drive.module)
    assert np.all((-clearance >= depth - 1e-10)[cut])
    reported = drive.tip_undercut(25, 8)
    whole = tooth[:, :8].all(axis=1)
    expected = np.maximum(depth[:, :8], 0.0).max(axis=1)
    assert np.all((reported >= np.minimum(expected, 0.01 * drive.module) - 1e-10)[whole])
    assert ((reported > 1e-9) == (expected > 1e-9))[whole].all()


@every_drive
def test_contact_lines_lie_on_what_is_left(drive):
    shaper, step = shaper_of(drive), 2e-5
    sweep = drive.entry_rotation - drive.exit_rotation
    for share in (0.03, 0.2, 0.4, 0.6, 0.9):
        turn = drive.exit_rotation + share * sweep
        lines = drive.contact_lines(turn)
        start, end = (float(x) - turn - drive.space_half_angle for x in (lines.lower, lines.upper))
        assert end - start > 3 * step
        left, _ = left_on_line(drive, shaper, np.linspace(start + step, end - step, 33), turn)
        assert left.all()
        before, beyond = np.linspace(0.0, start - step, 17), np.linspace(end + step, 1.2 * end, 5)
        assert start <= step or not left_on_line(drive, shaper, before, turn)[0].any()
        assert not left_on_line(drive, shaper, beyond, turn)[0].any()


@every_drive
def test_contact_ends_where_the_shaper_leaves_nothing(drive):
    """The last rotation at which any of many points of the line is left, by bisection."""
    shaper = shaper_of(drive)
    rolls = np.linspace(0.0, drive.pinion_tip_roll, 61)

    def any_left(turn):
        _, inside = left_on_line(drive, shaper, rolls, turn)
        if not inside.any():
            return False
        k = np.flatnonzero(inside)[-1]
        good, bad = rolls[k], rolls[min(k + 1, 60)]
        for _ in range(30):  # where the line ends on the outer edge, between two points of the grid
            middle = 0.5 * (good + bad)
            beyond = within(drive, np.array([middle]), turn, shaper.generated(np.array([middle]), turn))[0]
            good, bad = (middle, bad) if beyond else (good, middle)
        return bool(left_on_line(drive, shaper, np.append(rolls, good), turn)[0].any())

    good, bad = drive.exit_rotation + 0.01, drive.exit_rotation - 0.01
    assert any_left(good)
    assert not any(any_left(drive.exit_rotation - back) for back in (0.01, 0.03, 0.1, 0.2, 0.3))
    for _ in range(14):
        middle = 0.5 * (good + bad)
        good, bad = (middle, bad) if any_left(middle) else (good, middle)
    # The end of the last line is the pinion's tip, a point of the grid, or where it meets the outer edge.
    assert drive.exit_rotation == pytest.approx(good, abs=2e-6)
    ratio = (drive.entry_rotation - good) * drive.pinion_teeth / (2 * math.pi)
    assert drive.geometric_contact_ratio == pytest.approx(ratio, abs=1e-5)


@pytest.mark.parametrize("drive", NAMED, ids=label)
def test_ends_followed_from_neighbours_are_those_found_by_search(drive):
    region = drive.contact_region
    c = np.linspace(region.exit, region.entry, 41)[1:-1]
    lower, upper = region.generated_ends(c)
    found = np.maximum(lower, region.cut.uncut(lower, upper, c))
    np.testing.assert_allclose(region.line_ends(c)[0], found, rtol=0, atol=2e-12)


def test_what_the_issue_measured():
    """Lines on removed flank were counted: 3.23 mesh periods for 2.70."""
    drive = NAMED[3]
    region = drive.contact_region
    generated = (region.entry - region.generated_exit) * drive.pinion_teeth / (2 * math.pi)
    assert generated == pytest.approx(3.2306, abs=1e-4)
    assert drive.geometric_contact_ratio == pytest.approx(2.7038, abs=1e-4)
    # A longer shaper cuts more; the length that is meant is part of the drive's conventions.
    assert SHAPER_OVERHANG == 0.5


@pytest.mark.parametrize("drive", NAMED, ids=label)
def test_usable_radii_separate_what_is_left(drive):
    shaper, step = shaper_of(drive), 1e-7
    rolls = np.linspace(0.3, 1.0, 6) * drive.pinion_tip_roll
    for roll, inner, outer in zip(rolls, *drive.usable_radii(rolls), strict=True):
        if math.isnan(inner):
            continue
        assert drive.flank_start - 1e-12 <= inner < outer <= drive.outer_radius + 1e-12
        radii = np.linspace(inner + step, outer - step, 9)
        turns = turns_at(drive, radii, roll)
        depth = shaper.deepest(*shaper.generated(np.full(9, roll), turns)[:3], turns)
        assert depth.max() < 1e-10 * drive.base_radius
        cut = inner > drive.flank_start + 1e-9 and roll > drive.contact_region.top_roll(inner) + 1e-6
        if cut:
            turn = turns_at(drive, np.array([inner - step]), roll)
            assert shaper.deepest(*shaper.generated(np.array([roll]), turn)[:3], turn)[0] > 0.0


def turns_at(drive, radii, roll):
    alpha = np.array([drive.contact_region.edge_angle(radius, roll) for radius in radii])
    return alpha - roll - drive.space_half_angle


def test_up_to_a_right_angle_lines_are_as_generated():
    """What is cut at 90° is a trace, at low gear ratios; below, nothing."""
    for teeth, shaft_deg, most in (((26, 30), 90.0, 1.5e-6), ((26, 52), 90.0, 0.0), ((26, 30), 80.0, 0.0)):
        drive = drive_of(teeth, 25.0, shaft_deg)
        assert drive.tip_undercut(41, 16).max() <= most
        assert drive.contact_region.exit == drive.contact_region.generated_exit
    assert drive_of((26, 30), 25.0, 90.0).tip_undercut(41, 16).max() > 0.5e-6


def test_roll_off_the_profile_is_refused():
    with pytest.raises(ValueError, match=r"roll must lie between 0 and the shaper's tip at .* got 2"):
        NAMED[0].usable_radii([0.1, 2.0])


@pytest.mark.parametrize(
    ("teeth", "degrees"),
    [((36, 100), 96.0), ((36, 100), 97.5), ((36, 100), 99.5), ((28, 64), 95.0), ((24, 64), 95.0)],
)
def test_a_part_of_the_shaper_that_cuts_few_lines_is_seen(teeth, degrees):
    """It takes over from another one right after the cut begins, between two of the lines that are looked at."""
    drive = Drive(*teeth, 4e-3, shaft_angle=math.radians(degrees))
    (corner,) = drive.contact_region.cut.corners
    assert any(abs(corner - kink) < 1e-12 for kink in drive.contact_region.kinks)
    # A missed corner is a kink inside a piece, which no series follows.
    [place] = Contact().places(drive)
    fitted = place.shape(lambda radius, angle: np.stack([radius, angle], axis=-1))
    x = np.linspace(0.0, 1.0, 2001)[:-1]
    centroid = ContactPath(drive, drive.contact_ratio).centroid(x)
    expected = np.stack([centroid.radius / drive.outer_radius, centroid.angle], axis=-1)
    np.testing.assert_allclose(fitted(x), expected, rtol=1e-9, atol=1e-12)
