"""Limits, surfaces and contact lines against printed values, closed forms and independent numerics."""

import math
import subprocess
import sys
from types import SimpleNamespace

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import fixed_quad
from scipy.optimize import brentq

from facegear.geometry.drive import Drive
from tests.independent.shaper_envelope import shaper_of

CASE_I = Drive(26, 130, 3.175e-3)
INCH = 25.4e-3
# General shaft angles, few and many teeth, and a base circle that bounds the contact lines (12 and 14 teeth).
DRIVES = [
    CASE_I,
    Drive(31, 107, 3.175e-3),
    Drive(14, 60, 2e-3, math.radians(20.0)),
    Drive(60, 200, 1e-3),
    Drive(26, 130, 3.175e-3, shaft_angle=math.radians(60.0)),
    Drive(28, 70, 3e-3, shaft_angle=math.radians(75.0)),
    Drive(12, 50, 5e-3, shaft_angle=math.radians(105.0)),
    Drive(30, 95, 3e-3, math.radians(22.5), math.radians(120.0)),
    Drive(80, 300, 2e-3, shaft_angle=math.radians(63.0)),
]


def label(drive):
    return f"{drive.pinion_teeth}-{drive.gear_teeth}-{math.degrees(drive.shaft_angle):.0f}"


each_drive = pytest.mark.parametrize("drive", DRIVES, ids=label)
both_flanks = pytest.mark.parametrize("flank", [1, -1])


@st.composite
def drives(draw):
    """Draw a valid drive of any shaft angle from 60° to 120°."""
    pinion = draw(st.integers(14, 70))
    gear = draw(st.integers(math.ceil(1.5 * pinion), 8 * pinion))
    pressure = math.radians(draw(st.floats(18.0, 25.0)))
    shaft = math.radians(draw(st.floats(60.0, 120.0)))
    return Drive(pinion, gear, draw(st.floats(1e-3, 1e-2)), pressure, shaft)


# --- motion of the shaper, written here from Fig. 3.3 and nowhere else ------------------------------------------


def rotation(axis, angle):
    c, s = np.cos(angle), np.sin(angle)
    i, j = [(1, 2), (2, 0), (0, 1)][axis]
    matrix = np.zeros((3, 3), dtype=np.result_type(c, np.float64))
    matrix[axis, axis] = 1.0
    matrix[i, i], matrix[j, j], matrix[i, j], matrix[j, i] = c, c, -s, s
    return matrix


def involute(drive, theta, u):
    """Shaper's involute unwound from the base circle: start point turned by the roll angle, plus the thread."""
    start = math.pi / (2 * drive.pinion_teeth) - (math.tan(drive.pressure_angle) - drive.pressure_angle)
    rb = drive.module * drive.pinion_teeth / 2 * math.cos(drive.pressure_angle)
    angle = start + theta
    on_circle = np.array([np.sin(angle), -np.cos(angle)])
    thread = np.array([-np.cos(angle), -np.sin(angle)])
    return np.array([*(rb * on_circle + rb * theta * thread), u])


def to_gear(drive, point, phi):
    tilt = rotation(0, math.pi - drive.shaft_angle)
    return rotation(2, -phi * drive.pinion_teeth / drive.gear_teeth) @ tilt @ rotation(2, phi) @ point


def motion_rate(drive, theta, u, phi):
    """Share of the point's motion in the gear's frame (complex step) along the flank's normal, the thread."""
    start = math.pi / (2 * drive.pinion_teeth) - (math.tan(drive.pressure_angle) - drive.pressure_angle)
    normal = to_gear(drive, np.array([math.cos(start + theta), math.sin(start + theta), 0.0]), phi)
    motion = to_gear(drive, involute(drive, theta, u), phi + 1e-30j).imag
    return np.dot(normal, motion) / np.linalg.norm(motion)


# --- printed values ------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("teeth", "printed_mm", "digits", "printed_ratio", "ratio_digits"),
    [
        ((26, 130), 231.94, 2, 1.5532, 4),
        ((31, 155), 274.54, 2, 1.5668, 4),
        ((25, 125), 223.4, 1, 1.55, 2),
        ((28, 140), 249, 0, 1.5591, 4),
        ((32, 160), 283, 0, 1.5691, 4),
    ],
)
def test_printed_outer_radius_and_contact_ratio(teeth, printed_mm, digits, printed_ratio, ratio_digits):
    drive = Drive(*teeth, 3.175e-3)
    assert round(drive.outer_radius * 1e3, digits) == printed_mm
    assert round(drive.contact_ratio, ratio_digits) == printed_ratio


@pytest.mark.parametrize(("teeth", "printed_mm", "digits"), [(25, 277, 0), (28, 275.7, 1), (32, 274.2, 1)])
def test_printed_outer_radius_at_constant_pitch_radius(teeth, printed_mm, digits):
    drive = Drive(teeth, 5 * teeth, 2 * 1.9375 * INCH / teeth)
    assert drive.pitch_radius == pytest.approx(49.2125e-3, rel=1e-14)
    assert round(drive.outer_radius * 1e3, digits) == printed_mm


def test_face_width_of_chapter_7_and_geometric_ratio():
    assert round(Drive(31, 107, 3.175e-3).face_width * 1e3, 3) == 33.588
    assert round(CASE_I.geometric_contact_ratio, 3) == 3.286


# --- closed forms at a right shaft angle -------------------------------------------------------------------------


@pytest.mark.parametrize("teeth", [(22, 110), (26, 130), (31, 107), (35, 60)])
def test_right_angle_falls_out_of_the_general_code(teeth):
    md, ac = 3.175e-3, math.radians(25.0)
    ns, n2 = teeth
    drive = Drive(ns, n2, md)
    m, rp = ns / n2, 0.5 * md * ns
    rb, theta_0 = rp * math.cos(ac), math.pi / (2 * ns) - math.tan(ac) + ac
    theta_a, star = (math.sqrt((rp + k * md) ** 2 - rb**2) / rb for k in (1.0, 1.25))
    t = brentq(lambda x: m**2 * star * (star - x) - x**2 * (1 + x**2), 0.0, star, xtol=1e-17)
    r1 = rb / m * math.sqrt(1 + t**2)
    alpha = brentq(lambda a: a - (ns - 2) / (ns * math.cos(ac)) * math.sin(a) - theta_0, 0.3, 1.5, xtol=1e-17)
    r2 = n2 * md * math.cos(ac) / (2 * math.cos(alpha))
    q1, q2 = math.acos(rb / (m * r1)), math.acos(rb / (m * r2))
    top = (rp - md) / rb

    def on_top(q):
        return q - (top - math.cos(q)) / math.sin(q) - theta_0

    assert drive.inner_radius == pytest.approx(r1, rel=1e-13)
    assert drive.outer_radius == pytest.approx(r2, rel=1e-13)
    assert drive.inner_limit == pytest.approx(r1, rel=1e-13)
    assert drive.face_width == pytest.approx(r2 - r1, rel=1e-12)
    assert drive.entry_rotation == pytest.approx(on_top(q2), abs=1e-12)
    assert drive.exit_rotation == pytest.approx(q1 - theta_a - theta_0, abs=1e-12)
    kinks = sorted((on_top(q1), q2 - theta_a - theta_0), reverse=True)
    np.testing.assert_allclose(drive.kink_rotations, kinks, rtol=0, atol=1e-12)

    rotations = np.linspace(drive.exit_rotation, drive.entry_rotation, 9)[1:-1]
    lines = drive.contact_lines(rotations)
    for i, phi in enumerate(rotations):
        c = phi + theta_0
        q_top = brentq(lambda q, c=c: math.cos(q) + (q - c) * math.sin(q) - top, max(c, 0.0), 1.3, xtol=1e-17)
        lower, upper = max(q1, q_top), min(q2, c + theta_a)

        def speed(q, c=c):
            return rb * np.hypot(q - c, np.sin(q) / (m * np.cos(q) ** 2))

        def arc(a, b, speed=speed):
            return fixed_quad(speed, a, b, n=60)[0]

        whole = arc(lower, upper)

        def past_half(x, arc=arc, lower=lower, whole=whole):
            return arc(lower, x) - 0.5 * whole

        q = brentq(past_half, lower, upper, xtol=1e-17)
        x, u = rb * (math.sin(q) - (q - c) * math.cos(q)), rb / (m * math.cos(q))
        assert lines.lower[i] == pytest.approx(lower, abs=1e-12)
        assert lines.upper[i] == pytest.approx(upper, abs=1e-12)
        assert lines.length[i] == pytest.approx(whole, rel=1e-12, abs=1e-14)
        assert lines.middle[i] == pytest.approx(q, abs=1e-12)
        assert lines.radius[i] == pytest.approx(math.hypot(x, u), rel=1e-12)
        assert lines.angle[i] == pytest.approx(math.atan2(x, u), abs=1e-12)


def test_tregold_ratio_passes_through_the_rack():
    """At cos γ = −m the face gear is a crown gear: its formative gear is a rack, path a_g/sin α_c."""
    drive = Drive(26, 78, 3e-3, shaft_angle=math.acos(-26 / 78))
    c, s = math.cos(drive.pressure_angle), math.sin(drive.pressure_angle)
    virtual = 26 / math.cos(drive.shaft_angle - 0.5 * math.pi)
    pinion = virtual * (math.tan(math.acos(c * virtual / (virtual + 2))) - math.tan(drive.pressure_angle))
    assert drive.contact_ratio == pytest.approx((pinion + 2 / (s * c)) / (2 * math.pi), rel=1e-12)
    near = Drive(26, 78, 3e-3, shaft_angle=drive.shaft_angle + 1e-9)
    assert near.contact_ratio == pytest.approx(drive.contact_ratio, rel=1e-8)


# --- the generated surface -----------------------------------------------------------------------------------


@each_drive
@both_flanks
def test_tooth_is_the_envelope_of_the_shaper(drive, flank):
    tooth = drive.tooth_flank(7, 5, flank)
    mirror = np.array([flank, 1.0, 1.0])
    assert tooth.points.shape == (7, 5, 3)
    for index in np.ndindex(7, 5):
        theta, u, phi = tooth.roll[index], tooth.position[index], flank * tooth.rotation[index]
        assert abs(motion_rate(drive, theta, u, phi)) < 1e-12
        point = to_gear(drive, involute(drive, theta, u), phi) * mirror
        np.testing.assert_allclose(tooth.points[index], point, rtol=0, atol=1e-13)
        # Flank −1 is the shaper's mirror image at the opposite rotation, not only a mirrored result.
        other = to_gear(drive, involute(drive, theta, u) * mirror, tooth.rotation[index])
        np.testing.assert_allclose(tooth.points[index], other, rtol=0, atol=1e-13)


@each_drive
@both_flanks
def test_contact_lines_are_tangent_to_the_shaper(drive, flank):
    """The surface swept by the contact lines has the shaper's normal: five-point differences in φ."""
    h = 1e-3
    sweep = drive.entry_rotation - drive.exit_rotation
    for share in (0.15, 0.4, 0.6, 0.85):
        centre = drive.exit_rotation + share * sweep
        if min(abs(centre - kink) for kink in drive.kink_rotations) < 3 * h:
            centre += 5 * h
        lines = drive.contact_lines(centre + h * np.arange(-2, 3))
        before2, before, _, after, after2 = lines.gear_points(9, flank)
        tangent = (before2 - 8 * before + 8 * after - after2) / (12 * h)
        tangent /= np.linalg.norm(tangent, axis=-1, keepdims=True)
        shaper = lines.shaper_points(9, flank)[2]
        alpha = np.linspace(lines.lower[2], lines.upper[2], 9)
        angle = alpha - centre
        normal = np.stack([flank * np.cos(angle), np.sin(angle), np.zeros(9)], axis=-1)
        carried = np.array([to_gear(drive, n, flank * centre) for n in normal])
        assert np.max(np.abs(np.sum(carried * tangent, axis=-1))) < 1e-10
        radius = np.hypot(shaper[:, 0], shaper[:, 1])
        assert np.all(radius <= drive.pinion_tip_radius * (1 + 1e-12))
        assert np.all(radius >= drive.base_radius * (1 - 1e-12))


@each_drive
def test_frames_agree(drive):
    """Gear points carried to space by the gear's rotation are the pinion's carried by its own."""
    phi = 0.5 * (drive.entry_rotation + drive.exit_rotation)
    lines = drive.contact_lines([phi])
    gear, fixed = lines.gear_points(5)[0], lines.fixed_points(5)[0]
    back = rotation(2, phi * drive.speed_ratio) @ gear.T
    np.testing.assert_allclose(fixed, back.T, rtol=0, atol=1e-14)
    tooth = drive.tooth_flank(3, 3)
    turned = tooth.points @ rotation(2, 0.3 * drive.speed_ratio).T
    np.testing.assert_allclose(tooth.fixed_points(0.3), turned, rtol=0, atol=1e-14)
    pinion = drive.pinion_flank(3, 4)
    tilt = rotation(0, math.pi - drive.shaft_angle) @ rotation(2, 0.3)
    np.testing.assert_allclose(pinion.fixed_points(0.3), pinion.points @ tilt.T, rtol=0, atol=1e-14)
    radius = np.hypot(pinion.points[..., 0], pinion.points[..., 1])
    np.testing.assert_allclose(radius[:, -1], drive.pinion_tip_radius, rtol=1e-13)
    np.testing.assert_allclose(drive.pinion_flank(3, 4, -1).points, pinion.points * [-1, 1, 1])


# --- limits, by independent routes ----------------------------------------------------------------------------


def mp_surface(drive, theta, phi):
    """Generate a point in mpmath, with u from the tangency of the motion (linear in u), and the normal."""
    rb = mpmath.mpf(drive.module) * drive.pinion_teeth / 2 * mpmath.cos(mpmath.mpf(drive.pressure_angle))
    ac, tilt = mpmath.mpf(drive.pressure_angle), mpmath.pi - mpmath.mpf(drive.shaft_angle)
    m = mpmath.mpf(drive.pinion_teeth) / drive.gear_teeth
    angle = mpmath.pi / (2 * drive.pinion_teeth) - mpmath.tan(ac) + ac + theta

    def carried(vector, at):
        x, y, z = vector
        x, y = x * mpmath.cos(at) - y * mpmath.sin(at), x * mpmath.sin(at) + y * mpmath.cos(at)
        y, z = y * mpmath.cos(tilt) - z * mpmath.sin(tilt), y * mpmath.sin(tilt) + z * mpmath.cos(tilt)
        c, s = mpmath.cos(m * at), mpmath.sin(m * at)
        return mpmath.matrix([x * c + y * s, -x * s + y * c, z])

    def flank(u):
        s, c = mpmath.sin(angle), mpmath.cos(angle)
        return (rb * (s - theta * c), -rb * (c + theta * s), u)

    normal = carried((mpmath.cos(angle), mpmath.sin(angle), mpmath.mpf(0)), phi)

    def slip(u):
        step = mpmath.mpf(10) ** -15
        rate = (carried(flank(u), phi + step) - carried(flank(u), phi - step)) / (2 * step)
        return (normal.T * rate)[0]

    at_0, at_1 = slip(mpmath.mpf(0)), slip(mpmath.mpf(1))
    u = -at_0 / (at_1 - at_0)
    return carried(flank(u), phi), u, normal


@each_drive
def test_undercutting_starts_at_the_inner_limit(drive):
    """Where the shaper's tip line generates a singular point of the surface: normal · (∂θ × ∂φ) = 0."""
    with mpmath.workdps(40):
        rb, ras = drive.base_radius, drive.pitch_radius + 1.25 * drive.module
        star = mpmath.sqrt((mpmath.mpf(ras) / rb) ** 2 - 1)
        step = mpmath.mpf(10) ** -10

        def singular(phi):
            normal = mp_surface(drive, star, phi)[2]
            difference = [
                (mp_surface(drive, star + a, phi + b)[0] - mp_surface(drive, star - a, phi - b)[0])
                / (2 * step)
                for a, b in ((step, 0), (0, step))
            ]
            (a, b, c), (d, e, f) = difference
            return (normal.T * mpmath.matrix([b * f - c * e, c * d - a * f, a * e - b * d]))[0] / rb**2

        guess = math.atan(drive.undercut_root) - drive.space_half_angle - drive.shaper_tip_roll
        phi = mpmath.findroot(singular, (guess - 1e-3, guess + 2e-3), tol=1e-25)
        limit = mp_surface(drive, star, phi)[1] - drive.dedendum_radius * mpmath.cot(drive.shaft_angle)
        assert float(limit) == pytest.approx(drive.inner_limit, rel=1e-10)
        # The envelope is valid on the far side of the other root too, but its u lies on the branch t < 0.
        assert len(drive.undercut_roots) == 2
        assert drive.undercut_roots[0] < 0.0 < drive.undercut_roots[1] == drive.undercut_root


def tangents_meet(drive, radius):
    """Height above the tooth top at which both flanks' tangents meet in the section of −y_p = radius [m]."""
    # The section normal to the shaper's axis that has the tooth top at −y_p = radius.
    u = (radius + drive.tooth_top_distance * math.cos(drive.shaft_angle)) / math.sin(drive.shaft_angle)
    theta = brentq(lambda x: motion_rate(drive, x, u, 0.0), 1e-3, 1.2, xtol=1e-16)
    x, y = involute(drive, theta, u)[:2]
    slope = involute(drive, theta + 1e-30j, u).imag
    return y - x * slope[1] / slope[0] + drive.tooth_top_distance


@each_drive
def test_tooth_is_pointed_at_the_outer_limit(drive):
    """By its own definition (tangents in the section); thickness inside, crossed tangents outside."""
    assert abs(tangents_meet(drive, drive.outer_radius)) < 1e-12 * drive.outer_radius
    inside, outside = (tangents_meet(drive, drive.outer_radius * k) for k in (0.99, 1.01))
    assert inside > 0.0 > outside


@each_drive
def test_true_flanks_meet_close_to_the_outer_limit(drive):
    """The curved flanks meet at the tooth top where `top_thickness` says, not exactly at R2."""
    low, high = 0.5 * (drive.flank_start + drive.outer_radius), 1.02 * drive.outer_radius
    radius = brentq(drive.top_thickness, low, high, xtol=1e-15)
    assert abs(1.0 - radius / drive.outer_radius) < (3e-3 if drive.shaft_angle == math.pi / 2 else 0.02)
    # Independent: roll angle and rotation where the envelope crosses the plane of symmetry at the tooth top.
    sine, cosine = math.sin(drive.shaft_angle), math.cos(drive.shaft_angle)

    def on_top_and_symmetric(theta, phi):
        x, y, z = mp_surface(drive, theta, phi)[0]
        return [
            x / drive.module,
            (-z * sine - mpmath.hypot(x, y) * cosine - drive.tooth_top_distance) / drive.module,
        ]

    with mpmath.workdps(40):
        roll = drive.contact_region.top_roll(radius)
        phi = drive.contact_region.edge_angle(radius, roll) - roll - drive.space_half_angle
        theta, phi = mpmath.findroot(on_top_and_symmetric, (roll + 1e-3, phi - 1e-3), tol=1e-25)
        y = mp_surface(drive, theta, phi)[0][1]
        # `radius` is measured in the generating position, the gear turned by m_2s φ.
        assert float(-y * mpmath.cos(drive.speed_ratio * phi)) == pytest.approx(radius, rel=1e-10)


# --- contact lines by brute force ------------------------------------------------------------------------------


def brute_force_line(drive, phi):
    """Scan the straight contact line in small chords, keep what lies within all bounds."""
    rb, theta_0 = drive.base_radius, drive.space_half_angle
    cone = (
        (1 + drive.speed_ratio * math.cos(drive.shaft_angle))
        / drive.speed_ratio
        / math.sin(drive.shaft_angle)
    )
    tilt = rotation(0, math.pi - drive.shaft_angle) @ rotation(2, phi)

    def shaper_point(theta):
        angle = theta_0 + theta
        x, y = rb * (np.sin(angle) - theta * np.cos(angle)), -rb * (np.cos(angle) + theta * np.sin(angle))
        return np.stack([x, y, rb * cone / np.cos(phi + angle)], axis=-1)

    def allowed(theta):
        point = shaper_point(theta)
        x, y, z = np.moveaxis(point @ tilt.T, -1, 0)
        top = -z * math.sin(drive.shaft_angle) - np.hypot(x, y) * math.cos(drive.shaft_angle)
        within = (-y >= drive.inner_radius) & (-y <= drive.outer_radius) & (top >= drive.tooth_top_distance)
        tip = np.hypot(point[..., 0], point[..., 1]) <= drive.pinion_tip_radius
        return within & tip & (theta >= 0.0) & (phi + theta_0 + theta >= 0.0)

    scan = np.linspace(0.0, 1.5, 3001)
    scan = scan[np.abs(phi + theta_0 + scan) < 1.5]
    inside = np.flatnonzero(allowed(scan))
    assert np.all(np.diff(inside) == 1)
    ends = []
    for good, bad in ((inside[0], inside[0] - 1), (inside[-1], inside[-1] + 1)):
        a, b = scan[good], scan[bad] if bad >= 0 else scan[good]
        for _ in range(60):
            middle = 0.5 * (a + b)
            a, b = (middle, b) if allowed(middle) else (a, middle)
        ends.append(a)
    if drive.shaft_angle > math.pi / 2:
        ends[0] = shaper_of(drive).cut_end(phi, *ends)
    points = shaper_point(np.linspace(*ends, 40001))
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    share = [np.interp(0.5 * arc[-1], arc, points[:, i]) for i in range(3)]
    return arc[-1], tilt @ share


@each_drive
def test_contact_lines_match_brute_force(drive):
    rotations = drive.exit_rotation + (drive.entry_rotation - drive.exit_rotation) * np.array(
        [0.1, 0.35, 0.6, 0.9]
    )
    lines = drive.contact_lines(rotations)
    for i, phi in enumerate(rotations):
        length, point = brute_force_line(drive, phi)
        assert lines.length[i] == pytest.approx(length, abs=1e-10)
        np.testing.assert_allclose(lines.contact_point[i], point, rtol=0, atol=1e-9)
        assert lines.radius[i] == pytest.approx(math.hypot(point[0], point[1]), abs=1e-9)
        assert lines.angle[i] == pytest.approx(math.atan2(point[0], -point[1]), abs=1e-9)


def invariants_hold(drive, share):
    assert 0.0 < drive.inner_radius < drive.outer_radius
    assert 0.0 < drive.inner_limit < drive.outer_limit
    assert drive.contact_ratio > 1.0
    assert drive.geometric_contact_ratio > 1.0
    # L1 at the undercut limit, by the spec's polynomial written out.
    m, star, t = drive.speed_ratio, drive.shaper_tip_roll, drive.undercut_root
    p, q = m * math.sin(drive.shaft_angle), 1 + m * math.cos(drive.shaft_angle)
    excess = p**2 * star * (star - t) - q * t * (1 + t**2) * ((1 - q) * star + q * t)
    assert abs(excess) < 1e-14
    z = q * drive.base_radius / p * math.sqrt(1 + t**2)
    limit = z - drive.dedendum_radius / math.tan(drive.shaft_angle)
    assert limit == pytest.approx(drive.inner_limit, rel=1e-12)
    assert abs(tangents_meet(drive, drive.outer_radius)) < 1e-12 * drive.outer_radius
    # The contact line lies within the tooth and on the pinion's flank.
    phi = drive.exit_rotation + share * (drive.entry_rotation - drive.exit_rotation)
    lines = drive.contact_lines(phi)
    assert lines.length > 0.0
    shaper, fixed = lines.shaper_points(17), lines.fixed_points(17)
    slack = 1e-12 * drive.outer_radius
    assert np.all(np.hypot(shaper[:, 0], shaper[:, 1]) <= drive.pinion_tip_radius + slack)
    assert np.all(-fixed[:, 1] >= drive.inner_radius - slack)
    assert np.all(-fixed[:, 1] <= drive.outer_radius + slack)
    depth = -fixed[:, 2] * math.sin(drive.shaft_angle)
    depth -= np.hypot(fixed[:, 0], fixed[:, 1]) * math.cos(drive.shaft_angle)
    assert np.all(depth >= drive.tooth_top_distance - slack)
    theta = (lines.lower + lines.upper) / 2 - phi - drive.space_half_angle
    u = drive.base_radius * drive.cone_cotangent / math.cos((lines.lower + lines.upper) / 2)
    assert abs(motion_rate(drive, theta, u, phi)) < 1e-12


@settings(max_examples=8)
@given(drive=drives(), share=st.floats(0.02, 0.98))
def test_invariants_of_random_drives(drive, share):
    invariants_hold(drive, share)


@pytest.mark.slow
@settings(max_examples=40)
@given(drive=drives(), share=st.floats(0.02, 0.98))
def test_invariants_of_many_random_drives(drive, share):
    invariants_hold(drive, share)


@each_drive
def test_lines_vanish_at_both_ends_of_the_sweep(drive):
    lines = drive.contact_lines([drive.entry_rotation, drive.exit_rotation])
    np.testing.assert_allclose(lines.length, 0.0, atol=1e-14)
    assert np.all(np.isfinite(lines.contact_point))


# --- bad input ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        ((26.0, 130, 3e-3), TypeError, r"pinion_teeth must be an integer.*26\.0"),
        ((26, 130.5, 3e-3), TypeError, r"gear_teeth must be an integer.*130\.5"),
        ((True, 130, 3e-3), TypeError, "pinion_teeth"),
        ((3, 130, 3e-3), ValueError, "pinion_teeth must be at least 10, got 3"),
        ((-26, 130, 3e-3), ValueError, "pinion_teeth must be at least 10, got -26"),
        ((10, 50, 3e-3), ValueError, r"pinion_teeth=10 is too few.*25°.*pointed"),
        ((26, 26, 3e-3), ValueError, "gear_teeth must exceed pinion_teeth=26, got 26"),
        ((26, 130, 3.175), ValueError, r"module must lie in .*3\.175 m.*1000.*0\.003175"),
        ((26, 130, -3e-3), ValueError, "module"),
        ((26, 130, 0.0), ValueError, "module"),
        ((26, 130, math.nan), ValueError, r"module must lie in .*got nan m"),
        ((26, 130, "3 mm"), TypeError, "module must be a real number"),
        ((26, 130, 3e-3, 25.0), ValueError, "pressure_angle .*looks like degrees"),
        ((26, 130, 3e-3, math.inf), ValueError, "pressure_angle must lie between .*got inf"),
        ((26, 130, 3e-3, 0.4363, 90.0), ValueError, "shaft_angle .*looks like degrees"),
        ((26, 130, 3e-3, 0.4363, 0.9), ValueError, r"shaft_angle must lie between 60° and 120°.*0\.9"),
    ],
)
def test_bad_drives_are_refused(arguments, error, message):
    with pytest.raises(error, match=message):
        Drive(*arguments)


class Overcut(Drive):
    """A drive whose undercutting is pushed out: no tooth numbers inside the valid ranges were found to do it."""

    @property
    def inner_limit(self):
        return 1.01 * self.outer_limit


def test_no_face_width_is_refused():
    with pytest.raises(
        ValueError, match=r"pinion_teeth=26, gear_teeth=130 leave no face width: undercutting"
    ):
        Overcut(26, 130, 3.175e-3)


class AllCut(Drive):
    """A drive whose shaper cuts off everything: no tooth numbers inside the valid ranges were found to do it."""

    @property
    def contact_region(self):
        return SimpleNamespace(has_contact_lines=False)


def test_no_flank_is_refused():
    with pytest.raises(
        ValueError, match=r"shaft_angle=120° leaves no flank of pinion_teeth=10, gear_teeth=11"
    ):
        AllCut(10, 11, 1e-3, math.radians(14.5), math.radians(120.0))
    # The worst there is inside the ranges keeps contact lines for a little more than one mesh period of 2.4.
    least = Drive(10, 11, 1e-3, math.radians(14.5), math.radians(120.0))
    assert 1.0 < least.geometric_contact_ratio < 1.01


def test_outer_edge_out_of_reach_is_refused():
    """With very many teeth the pinion's tip passes above the pointed tooth's top."""
    drive = Drive(1720, 1809, 1e-3, math.radians(14.968), math.radians(60.0))
    with pytest.raises(ValueError, match=r"outer_radius=.* is out of the pinion's reach"):
        drive.contact_lines(0.0)


def test_bad_arguments_of_arrays_are_refused():
    with pytest.raises(ValueError, match=r"rotation must lie between exit_rotation=.*got 1"):
        CASE_I.contact_lines([0.0, 1.0])
    with pytest.raises(ValueError, match="rotation must be finite"):
        CASE_I.contact_lines(math.nan)
    for flank in (0, 2, True):
        with pytest.raises(ValueError, match="flank must be 1 or -1"):
            CASE_I.tooth_flank(3, 3, flank)
    with pytest.raises(ValueError, match="along must be at least 2"):
        CASE_I.tooth_flank(1, 3)
    with pytest.raises(TypeError, match="across must be an integer"):
        CASE_I.pinion_flank(2, 3.0)
    with pytest.raises(ValueError, match="count must be at least 2"):
        CASE_I.contact_lines(0.0).gear_points(1)
    with pytest.raises(ValueError, match="radius must be at least"):
        CASE_I.top_thickness(0.1)


def test_import_is_light():
    """`import facegear` leaves the heavy packages alone; a name not offered is refused."""
    code = (
        "import sys, facegear\n"
        "heavy = {'sympy', 'matplotlib', 'scipy', 'xarray', 'plotly'} & set(sys.modules)\n"
        "assert not heavy, heavy\n"
        "assert 'Drive' in dir(facegear) and facegear.STEEL.density == 7840.0\n"
        "try:\n    facegear.Nothing\nexcept AttributeError as error:\n    assert 'Nothing' in str(error)\n"
        "else:\n    raise SystemExit('offered')\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
