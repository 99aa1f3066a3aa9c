"""Contact path, centroid, skew line and phases against closed forms, the definition and printed values."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from facegear.geometry.drive import Drive
from facegear.geometry.kinematics import ContactPath
from facegear.geometry.skew_line import SkewLine
from facegear.geometry.timed_pairs import mesh_period
from tests.independent import meshing_mpmath
from tests.independent.shaper_envelope import shaper_of

CASE_I = Drive(26, 130, 3.175e-3)
DRIVES = [
    CASE_I,
    Drive(31, 155, 3.175e-3),
    Drive(14, 60, 2e-3, math.radians(20.0)),
    Drive(60, 200, 1e-3),
    Drive(28, 70, 3e-3, shaft_angle=math.radians(65.0)),
    Drive(30, 95, 3e-3, shaft_angle=math.radians(115.0)),
]


def paths():
    for drive in DRIVES:
        yield pytest.param(ContactPath(drive), id=f"{drive.pinion_teeth}-Tregold")
        yield pytest.param(
            ContactPath(drive, drive.geometric_contact_ratio), id=f"{drive.pinion_teeth}-geometric"
        )


each_path = pytest.mark.parametrize("path", list(paths()))


def chebyshev_tail(values):
    """Relative size of the last eighth of the Chebyshev coefficients of samples at first-kind nodes."""
    n = len(values)
    nodes = np.cos(np.pi * (np.arange(n) + 0.5) / n)
    k = np.polynomial.chebyshev.chebfit(nodes, values, n - 1)
    return np.max(np.abs(k[-n // 8 :])) / np.max(np.abs(k))


def nodes(n):
    return np.cos(np.pi * (np.arange(n) + 0.5) / n)


def test_breakpoints_of_case_i():
    np.testing.assert_allclose(
        ContactPath(CASE_I).breakpoints, [0.0, 0.55318, 0.55380, 0.71518], rtol=0, atol=5e-6
    )


def test_breakpoints_follow_from_the_closed_form_corners():
    """γ = 90°: q(R1), q(R2) from the radii, the corners from the tooth-top plane and the tip circle."""
    d = CASE_I
    top, tip = d.tooth_top_distance / d.base_radius, math.sqrt((d.pinion_tip_radius / d.base_radius) ** 2 - 1)
    q1, q2 = (math.acos(d.base_radius / (d.speed_ratio * r)) for r in (d.inner_radius, d.outer_radius))
    on_top_1, on_top_2 = (q - (top - math.cos(q)) / math.sin(q) for q in (q1, q2))
    sweep = on_top_2 - (q1 - tip)
    for ratio in (d.contact_ratio, sweep * d.pinion_teeth / (2 * math.pi)):
        kinks = [(on_top_2 - c) / sweep * ratio % 1.0 for c in (on_top_1, q2 - tip)]
        expected = sorted([0.0, ratio % 1.0, *kinks])
        np.testing.assert_allclose(ContactPath(d, ratio).breakpoints, expected, rtol=0, atol=1e-12)


@each_path
def test_centroid_is_smooth_on_pieces(path):
    for i, tolerance in enumerate(path.fit_tolerances):
        cut = path.drive.shaft_angle > math.pi / 2
        assert tolerance == (1e-11 if cut else 1e-13) or path.base_circle_instant is not None
        here = path.centroid_on_piece(i, nodes(48))
        assert chebyshev_tail(here.radius) < tolerance
        assert chebyshev_tail(here.angle) < tolerance
        assert chebyshev_tail(path.pair_states_on_piece(i, nodes(48)).length.sum(axis=0)) < 2 * tolerance


def sampled_line(drive, c, count=100_001):
    """Length and midpoint (radius, angle) of a contact line from points all along the profile, kept where in reach.

    Profile points of the rotated shaper are unwound from the base circle, (3-7) gives their place along its axis;
    nothing is said about which edges bound the line.
    """
    m, g, rb = drive.speed_ratio, drive.shaft_angle, drive.base_radius
    roll = np.linspace(0.0, math.sqrt((drive.pinion_tip_radius / rb) ** 2 - 1), count)
    alpha = c + roll
    along = rb * (1 + m * math.cos(g)) / (m * math.sin(g) * np.cos(alpha))
    below, across = rb * (np.cos(alpha) + roll * np.sin(alpha)), rb * (np.sin(alpha) - roll * np.cos(alpha))
    out, height = along * math.sin(g) - below * math.cos(g), along * math.cos(g) + below * math.sin(g)
    depth = height * math.sin(g) - np.hypot(across, out) * math.cos(g)
    # The meshing surface turns back at α = 0: what lies beyond is its other branch.
    edges = [rb * alpha, out - drive.inner_radius, drive.outer_radius - out, depth - drive.tooth_top_distance]
    if g > math.pi / 2:
        inside = roll[np.min(edges, axis=0) > 0.0]
        cut = shaper_of(drive).cut_end(c - drive.space_half_angle, inside[0], inside[-1])
        edges += [rb * (roll - cut)] if cut > inside[0] else []
    room = np.min(edges, axis=0)
    start, end = room[:-1], room[1:]
    cut = np.maximum(start, end) / np.where(start * end < 0, np.abs(end - start), 1.0)
    part = np.where((start >= 0) & (end >= 0), 1.0, np.where((start < 0) & (end < 0), 0.0, cut))
    steps = np.diff([across, out, height], axis=1)
    travelled = np.concatenate([[0.0], np.cumsum(np.linalg.norm(steps, axis=0) * part)])
    middle = [np.interp(travelled[-1] / 2, travelled, coordinate) for coordinate in (across, out)]
    return travelled[-1], math.hypot(*middle), math.atan2(*middle)


FEW_TEETH = [Drive(20, 160, 3e-3), Drive(18, 90, 3e-3), Drive(16, 48, 3e-3), Drive(13, 26, 3e-3)]
SKEWED = [Drive(n, 80, 3e-3, shaft_angle=math.radians(s)) for n, s in ((16, 70.0), (16, 110.0), (12, 101.0))]


@pytest.mark.parametrize("drive", FEW_TEETH + SKEWED)
def test_centroid_where_lines_end_on_the_base_circle(drive):
    """Before and after the instant, and as near to it as 1e-6 of a mesh period."""
    path = ContactPath(drive)
    root = path.base_circle_instant
    entry, sweep = drive.entry_rotation, drive.entry_rotation - drive.exit_rotation
    for x in (0.7, root - 0.03, root - 1e-4, root - 1e-6, root + 1e-3, root + 0.1):
        owns = [(x % 1.0 + j) / path.contact_ratio for j in range(path.pairs)]
        lines = [
            sampled_line(drive, entry - own * sweep + drive.space_half_angle) for own in owns if 0 < own < 1
        ]
        length, radius, angle = np.transpose(lines)
        centroid = path.centroid(x)
        assert centroid.radius == pytest.approx((length @ radius) / length.sum(), rel=1e-9)
        expected = path.angular_travel * (length @ angle) / length.sum()
        assert centroid.angle == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize("drive", FEW_TEETH)
def test_line_comes_down_to_the_base_circle_with_the_square_root_of_time(drive):
    """γ = 90°: at cos c = (r_p − a_g)/r_b, as θs = √(2(c − c_b) tan c_b)."""
    c = math.acos(drive.tooth_top_distance / drive.base_radius)
    assert drive.base_circle_rotation == pytest.approx(c - drive.space_half_angle, abs=1e-14)
    for step in (1e-4, 1e-6, 1e-8):
        lower, _ = drive.contact_region.line_ends(np.array([c + step, c - step]))
        roll = lower - np.array([c + step, c - step])
        assert roll[0] == pytest.approx(math.sqrt(2 * step * math.tan(c)), rel=5 * math.sqrt(step))
        assert roll[1] == pytest.approx(0.0, abs=1e-15)


@pytest.mark.slow
@pytest.mark.takes(30)
@pytest.mark.parametrize("teeth", [(20, 160), (13, 26)])
def test_centroid_next_to_the_base_circle_in_thirty_digits(teeth):
    path = ContactPath(Drive(*teeth, 3e-3))
    # One for both steps: its limits take longer than all the rest.
    written_out = meshing_mpmath.Drive(*teeth, "3e-3")
    for step in (1e-3, 1e-6):
        x = path.base_circle_instant - step
        radius, angle = meshing_mpmath.contact_centroid(written_out, x, path.contact_ratio)
        assert path.centroid(x).radius == pytest.approx(float(radius), rel=1e-11)
        assert path.centroid(x).angle == pytest.approx(float(angle) * path.angular_travel, abs=1e-11)


@pytest.mark.parametrize("teeth", [(20, 110), (18, 58), (12, 16)])
def test_inner_edge_that_comes_just_before_the_base_circle(teeth):
    """No end on the base circle, no unlimited speed, but a square root just beyond the corner."""
    drive = Drive(*teeth, 3e-3)
    path = ContactPath(drive)
    assert path.base_circle_instant is None
    path.require_finite_speed("a test")
    assert 0.0 < drive.contact_region.top_roll(drive.inner_radius) < 0.01
    for i, tolerance in enumerate(path.fit_tolerances):
        assert chebyshev_tail(path.centroid_on_piece(i, nodes(65)).radius) < tolerance


def test_pieces_shrink_to_the_base_circle_and_no_others():
    path = ContactPath(FEW_TEETH[0])
    widths = np.diff([*path.breakpoints, 1.0])
    last = np.searchsorted(path.breakpoints, path.base_circle_instant + 1e-15) - 2
    # An eighth from one to the next, seven eighths of it wide; the last one is what is left.
    np.testing.assert_allclose(widths[last - 4 : last - 1] / widths[last - 5 : last - 2], 1 / 8, rtol=1e-5)
    assert widths.min() == widths[last] < 1e-9
    assert ContactPath(CASE_I).base_circle_instant is None
    with pytest.raises(
        ValueError, match=r"pinion_teeth = 20 is too few for a test .* 22 pinion teeth are enough"
    ):
        path.require_finite_speed("a test")
    for ratio in (1.5, 8.0):
        ContactPath(Drive(22, math.ceil(22 * ratio), 3e-3)).require_finite_speed("a test")


@each_path
def test_centroid_is_continuous_between_pieces(path):
    count = len(path.breakpoints)
    for i in range(count):
        after, end = path.centroid_on_piece((i + 1) % count, -1.0), path.centroid_on_piece(i, 1.0)
        assert after.radius == pytest.approx(end.radius, rel=1e-12)
        assert after.angle == pytest.approx(end.angle, abs=1e-12)


@each_path
def test_breakpoints_are_where_the_slope_jumps(path):
    """Chebyshev derivatives from both sides differ at entry and exit; a fit across does not converge."""
    count = len(path.breakpoints)
    for i in range(count):
        start, end = (*path.breakpoints, 1.0)[i : i + 2]
        if end - start < 0.02:
            continue
        across = path.centroid(start + 0.01 * nodes(48)).radius
        assert chebyshev_tail(across) > 1e-11


@each_path
def test_centroid_is_the_weighted_mean_of_3_21(path):
    """Every pair taken from the single-pair path at its own mesh time, summed by hand."""
    drive, cr = path.drive, path.contact_ratio
    for x in (0.0, 0.1, 0.37, 0.5, 0.83):
        top, bottom = np.zeros(2), 0.0
        for j in range(math.ceil(cr)):
            own = (x + j) / cr
            if own <= 1.0:
                phi = drive.entry_rotation + own * (drive.exit_rotation - drive.entry_rotation)
                line = drive.contact_lines(phi)
                top += line.length * np.array([line.radius, path.angular_travel * line.angle])
                bottom += line.length
        np.testing.assert_allclose(path.centroid(x), top / bottom, rtol=0, atol=1e-13)


@each_path
def test_period_is_one_and_pieces_agree_with_the_whole(path):
    x = np.linspace(0.001, 0.999, 41)
    once = path.centroid(x)
    for shift in (-3, 1, 7):
        again = path.centroid(x + shift)
        np.testing.assert_allclose(again.radius, once.radius, rtol=1e-12)
        np.testing.assert_allclose(again.angle, once.angle, atol=1e-12)
    for i, start in enumerate(path.breakpoints):
        end = (*path.breakpoints, 1.0)[i + 1]
        local = np.array([-0.9, 0.2, 0.7])
        whole = path.centroid(start + 0.5 * (local + 1.0) * (end - start))
        np.testing.assert_allclose(path.centroid_on_piece(i, local), whole, rtol=0, atol=1e-12)


@each_path
def test_contact_point_runs_outside_in(path):
    point = path.contact_point(np.linspace(0.0, 1.0, 101))
    assert np.all(np.diff(point.radius) < 0.0)
    assert np.all(np.diff(point.angle) < 0.0)
    np.testing.assert_allclose(point.length[[0, -1]], 0.0, atol=1e-14)
    assert np.all(point.length[1:-1] > 0.0)
    assert np.all(point.in_contact)


def test_conjugate_arm_is_constant():
    """The arm u cos q is r_b/m on every contact line: the mesh force's arm about the gear's axis never changes."""
    lines = CASE_I.contact_lines(np.linspace(CASE_I.exit_rotation, CASE_I.entry_rotation, 11))
    arm = -lines.contact_point[:, 1] * np.cos(lines.middle)
    np.testing.assert_allclose(arm, CASE_I.base_radius / CASE_I.speed_ratio, rtol=1e-13)


@pytest.mark.parametrize(("ratio", "printed"), [("contact_ratio", 830.0), ("geometric_contact_ratio", 75.0)])
def test_speed_of_the_centroid_just_after_entry(ratio, printed):
    """Case I at 1000 rpm: the two clocks move the centroid at some 830 and 75 m/s."""
    path = ContactPath(CASE_I, getattr(CASE_I, ratio))
    fit = np.polynomial.chebyshev.chebfit(nodes(48), path.centroid_on_piece(0, nodes(48)).radius, 47)
    slope = np.polynomial.chebyshev.chebval(-1.0, np.polynomial.chebyshev.chebder(fit))
    speed = slope * 2.0 / path.breakpoints[1] / mesh_period(CASE_I, 1000.0 * math.pi / 30.0)
    assert abs(speed) == pytest.approx(printed, rel=0.02)


def test_overlaid_pairs_lag_by_one_pitch():
    path = ContactPath(CASE_I)
    pitch = CASE_I.angular_pitch
    rotation = np.linspace(0.0, 4 * pitch, 161)
    states = path.overlaid(4, rotation)
    assert states.radius.shape == (4, 161)
    for j in range(1, 4):
        assert states.in_contact[j, 40 * j :].tolist() == states.in_contact[0, : 161 - 40 * j].tolist()
        np.testing.assert_allclose(
            states.radius[j, 40 * j :], states.radius[0, : 161 - 40 * j], rtol=0, atol=1e-9
        )
    # One pair always, two for 55 % of the time.
    number = states.in_contact[:, 80:120].sum(axis=0)
    assert set(number) == {1, 2}
    assert np.mean(number == 2) == pytest.approx(0.5532, abs=0.03)


PATHS = {
    "pinion": st.integers(14, 60),
    "ratio": st.floats(1.6, 6.0),
    "shaft": st.floats(60.0, 120.0),
    "clock": st.sampled_from(["contact_ratio", "geometric_contact_ratio"]),
    "x": st.floats(-5.0, 5.0),
}


def invariants_hold(pinion, ratio, shaft, clock, x):
    drive = Drive(pinion, math.ceil(pinion * ratio), 3e-3, shaft_angle=math.radians(shaft))
    path = ContactPath(drive, getattr(drive, clock))
    assert path.breakpoints[0] == 0.0
    assert all(a < b < 1.0 for a, b in zip((-1.0, *path.breakpoints), path.breakpoints, strict=False))
    count = len(path.breakpoints)
    for i in range(count):
        end, start = path.centroid_on_piece(i, 1.0), path.centroid_on_piece((i + 1) % count, -1.0)
        assert end.radius == pytest.approx(start.radius, rel=1e-10)
        assert end.angle == pytest.approx(start.angle, abs=1e-10)
    now, later = path.centroid(x), path.centroid(x + 1.0)
    assert now.radius == pytest.approx(later.radius, rel=1e-9)
    reach = math.hypot(drive.outer_radius, drive.pinion_tip_radius)
    assert drive.inner_radius <= now.radius <= reach


@settings(max_examples=6)
@given(**PATHS)
def test_invariants_of_random_paths(pinion, ratio, shaft, clock, x):
    invariants_hold(pinion, ratio, shaft, clock, x)


@pytest.mark.slow
@settings(max_examples=25)
@given(**PATHS)
def test_invariants_of_many_random_paths(pinion, ratio, shaft, clock, x):
    invariants_hold(pinion, ratio, shaft, clock, x)


@pytest.mark.parametrize("kind", [ContactPath, SkewLine])
def test_bad_contact_ratios_are_refused(kind):
    with pytest.raises(ValueError, match=r"contact_ratio must lie in \[1, 26\], got 0\.9 .*below 1"):
        kind(CASE_I, 0.9)
    for bad in (math.nan, math.inf, -1.5, 27.0):
        with pytest.raises(ValueError, match="contact_ratio must"):
            kind(CASE_I, bad)
    with pytest.raises(TypeError, match="contact_ratio must be a real number"):
        kind(CASE_I, "geometric")


def test_bad_arguments_are_refused():
    path = ContactPath(CASE_I)
    with pytest.raises(ValueError, match=r"index must be below 4.*got 4"):
        path.centroid_on_piece(4, 0.0)
    with pytest.raises(ValueError, match=r"x must lie in \[-1, 1\].*1\.5"):
        path.centroid_on_piece(0, [0.0, 1.5])
    with pytest.raises(ValueError, match="x must be finite"):
        path.centroid(math.nan)
    with pytest.raises(ValueError, match=r"fraction must lie in \[0, 1\].*-0\.1"):
        path.contact_point(-0.1)
    with pytest.raises(ValueError, match="count must be at least 1"):
        path.overlaid(0, 0.0)


def test_unit_contact_ratio_has_no_centroid_at_the_change():
    path = ContactPath(CASE_I, 1.0)
    assert path.breakpoints[0] == 0.0
    assert np.isfinite(path.centroid(0.5).radius)
    with pytest.raises(ValueError, match="contact_ratio must exceed 1"):
        path.centroid_on_piece(0, -1.0)
