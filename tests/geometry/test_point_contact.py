"""Contact at a point against a full tooth contact analysis, closed forms and Hertz; what is refused."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import root

from facegear.geometry import solids
from facegear.geometry.drive import Drive
from facegear.geometry.kinematics import ContactPath
from facegear.geometry.misalignment import Misalignment
from facegear.geometry.point_contact import UnloadedContact
from facegear.mechanics.contact import Contact
from facegear.mechanics.plate import Body
from facegear.mechanics.properties import MeshLoad
from facegear.mechanics.transverse import Transverse

CASE_ONE = Drive(26, 130, 3.175e-3, shaper_teeth=27)
OBLIQUE = Drive(26, 130, 3.175e-3, shaft_angle=math.radians(75.0), shaper_teeth=28)


# --- the independent route: five equations in five unknowns, written from the pictures of both gears --------------


def turn(axis, angle):
    """Rotation matrix about a unit axis."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross


def involute(base, half_space, roll, along):
    """Point of an involute cylinder and its normal, a tooth space centred on −y."""
    angle = half_space + roll
    point = base * np.array(
        [math.sin(angle) - roll * math.cos(angle), -math.cos(angle) - roll * math.sin(angle), 0.0]
    )
    return point + np.array([0.0, 0.0, along]), -np.array([math.cos(angle), math.sin(angle), 0.0])


def half_space(teeth, pressure):
    return math.pi / (2 * teeth) - (math.tan(pressure) - pressure)


def contact_by_five_equations(drive, error, gear_turn, guess):
    """φ, θs of the shaper; φ1, θ1, z1 of the pinion, for a rotation of the gear: equal points, equal normals."""
    ns, n1, n2, pressure = drive.shaper_teeth, drive.pinion_teeth, drive.gear_teeth, drive.pressure_angle
    base_s, base_1 = (drive.module * n / 2 * math.cos(pressure) for n in (ns, n1))
    supplement = math.pi - drive.shaft_angle
    k = np.array([0.0, math.sin(supplement), math.cos(supplement)])
    m, offset = ns / n2, drive.module * (ns - n1) / 2
    pivot = offset / math.tan(drive.shaft_angle) if error.pivot is None else error.pivot
    tilt = turn([1.0, 0.0, 0.0], -error.shaft_angle)

    def surfaces(unknown):
        phi, roll, phi_1, roll_1, z_1 = unknown
        spun = turn([0.0, 0.0, 1.0], phi)
        q = phi + half_space(ns, pressure) + roll
        u = base_s * (1 - m * math.cos(supplement)) / (m * math.sin(supplement) * math.cos(q))
        point, normal = involute(base_s, half_space(ns, pressure), roll, u)
        held = turn(k, gear_turn - m * phi)
        gear = held @ spun @ point + error.gear_axial * k, held @ spun @ normal
        point, normal = involute(base_1, half_space(n1, pressure), roll_1, z_1 - pivot + error.pinion_axial)
        own = tilt @ turn([0.0, 0.0, 1.0], phi_1)
        pinion = own @ point + [error.offset, -offset, pivot], own @ normal
        return gear, pinion

    def equations(unknown):
        (gear, gear_normal), (pinion, pinion_normal) = surfaces(unknown)
        return np.concatenate([(gear - pinion) / drive.module, np.cross(gear_normal, pinion_normal)[1:]])

    found = root(equations, guess, method="lm", options={"xtol": 1e-15, "ftol": 1e-15})
    assert np.abs(equations(found.x)).max() < 1e-11
    return found.x


def random_error(rng, size=1.0):
    return Misalignment(
        offset=float(rng.uniform(-1.5e-4, 1.5e-4)) * size,
        gear_axial=float(rng.uniform(-4e-5, 8e-5)) * size,
        pinion_axial=float(rng.uniform(-1e-3, 1e-3)),
        shaft_angle=float(rng.uniform(-2e-4, 2e-4)) * size,
        pivot=None if rng.random() < 0.5 else 0.2,
    )


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("angle", [75.0, 90.0, 105.0])
def test_all_of_the_mesh_against_five_equations(seed, angle):
    """Position, line of action and an exact ratio: no transmission error, whatever the rigid misalignment."""
    rng = np.random.default_rng([seed, int(angle)])
    drive = Drive(26, 130, 3.175e-3, shaft_angle=math.radians(angle), shaper_teeth=int(rng.integers(27, 30)))
    error = random_error(rng)
    contact = UnloadedContact(drive, error)
    q, m = contact.pressure_angle, drive.shaper_teeth / drive.gear_teeth
    space_s, space_1 = (half_space(n, drive.pressure_angle) for n in (drive.shaper_teeth, drive.pinion_teeth))
    low, high = contact.rolls
    ratios, places = [], []
    for roll in np.linspace(low, high, 4).tolist():
        phi = q - space_s - roll
        roll_1 = 26 / drive.shaper_teeth * 0 + roll
        guess = [phi, roll, q - space_1 - roll_1, roll_1, contact.position]
        found = contact_by_five_equations(drive, error, m * phi, guess)
        places.append(found[0] + space_s + found[1])
        ratios.append((m * phi, found[2]))
    np.testing.assert_allclose(places, q, atol=1e-9)
    gear, pinion = np.array(ratios).T
    transmission_error = gear - gear[0] - (pinion - pinion[0]) * drive.pinion_teeth / drive.gear_teeth
    assert np.abs(transmission_error).max() < 1e-10


# --- closed forms -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("teeth", "ratio"), [(26, 1.557363852), (31, 1.570175792)])
@pytest.mark.parametrize("more", [1, 3])
def test_contact_ratio_of_aligned_gears_does_not_know_the_shaper(teeth, ratio, more):
    drive = Drive(teeth, 5 * teeth, 3.175e-3, shaper_teeth=teeth + more)
    contact = UnloadedContact(drive)
    assert contact.contact_ratio == pytest.approx(ratio, abs=1e-9)
    tip, base, alpha = drive.pinion_tip_radius, drive.base_radius, drive.pressure_angle
    closed = math.sqrt(tip**2 - base**2) - base * math.tan(alpha) + drive.module / math.sin(alpha)
    assert contact.contact_ratio == pytest.approx(
        closed / (math.pi * drive.module * math.cos(alpha)), rel=1e-12
    )
    assert contact.pressure_angle == pytest.approx(alpha, rel=1e-14)


@pytest.mark.parametrize("drive", [CASE_ONE, OBLIQUE, replace(OBLIQUE, shaft_angle=math.radians(105.0))])
def test_shifts_by_small_errors(drive):
    contact = UnloadedContact(drive)
    u, b, alpha, gamma = contact.position, drive.axis_offset, drive.pressure_angle, drive.shaft_angle

    def shift(**error):
        (name,) = (name for name in error if name != "pivot")
        ends = [
            UnloadedContact(drive, Misalignment(**(error | {name: sign * error[name]}))).position
            for sign in (1, -1)
        ]
        return (ends[0] - ends[1]) / (2 * error[name])

    assert shift(offset=1e-7) == pytest.approx(u * math.tan(alpha) / b, rel=1e-6)
    assert shift(gear_axial=1e-7) == pytest.approx(u * math.sin(gamma) / b, rel=1e-6)
    assert shift(pinion_axial=1e-4) == pytest.approx(0.0, abs=1e-9)
    expected = -u * (u - b / math.tan(gamma)) / (b * math.cos(alpha) ** 2)
    assert shift(shaft_angle=1e-7) == pytest.approx(expected, rel=1e-6)
    if drive is CASE_ONE:
        assert shift(gear_axial=1e-7) == pytest.approx(130.0, rel=1e-6)
        assert shift(offset=1e-7) == pytest.approx(60.62, abs=5e-3)


@settings(deadline=None, max_examples=15)
@given(
    offset=st.floats(-1e-4, 1e-4),
    gear_axial=st.floats(-4e-5, 1e-4),
    shaft_angle=st.floats(-1e-4, 1e-4),
)
def test_gap_against_its_closed_form(offset, gear_axial, shaft_angle):
    """To first order in the errors; exact for parallel ones. Its slope is the residual: least at the contact."""
    drive, alpha = CASE_ONE, CASE_ONE.pressure_angle
    b, k = drive.axis_offset, float(drive.contact_region.position(0.0))
    u = np.linspace(0.19, 0.23, 9)
    q = np.arccos(k / u)
    for tilt in (0.0, shaft_angle):
        contact = UnloadedContact(drive, Misalignment(offset, gear_axial, 0.0, tilt))

        def g(q, tilt=tilt):
            return (
                b * ((q - alpha) * np.cos(alpha) - np.sin(q) + np.sin(alpha))
                + offset * (np.cos(q) - np.cos(alpha))
                - gear_axial * (np.sin(q) - np.sin(alpha))
                + tilt * k * (np.tan(q) - np.tan(alpha))
            )

        found = contact.gap(u)
        assert (found >= -1e-15).all()
        bound = (
            1e-14
            if tilt == 0.0
            else 1e-14 + 10.0 * tilt**2 + abs(tilt) * (abs(offset) + abs(gear_axial)) * 10.0
        )
        assert np.abs(found - (g(q) - g(contact.pressure_angle))).max() <= bound
        assert contact.gap(contact.position) == pytest.approx(0.0, abs=1e-14)


@pytest.mark.parametrize("drive", [CASE_ONE, OBLIQUE])
@pytest.mark.parametrize("seed", range(3))
def test_curvatures_of_the_gap(drive, seed):
    """Gap along the face, of tangent planes that are parallel where both normals are square to the pinion's axis.

    With the gear's own tensor G = K − κ1 e_p e_pᵀ, a point at z where the slope along z vanishes has the slope
    s = −(det G/G_pz) z, and planes of that slope are apart by −s (x + s/κ1)/2, x = −(G_zz/G_pz) z.
    """
    contact = UnloadedContact(drive, random_error(np.random.default_rng(seed)))
    roll, u = float(contact.rolls.mean()), contact.position
    tensor = contact.lines.curvature_tensor(contact.pressure_angle, roll)
    h = 2e-4
    gap = contact.gap(u + h * np.array([-2.0, -1.0, 0.0, 1.0, 2.0]))
    second = float(gap @ [-1.0, 16.0, -30.0, 16.0, -1.0]) / (12.0 * h**2)
    own = 1.0 / (float(contact.lines.at(contact.pressure_angle)[2]) + drive.generating.base_radius * roll)
    gear = tensor - np.diag([own, 0.0])
    slope = -np.linalg.det(gear) / gear[0, 1]
    assert -slope * (-gear[1, 1] / gear[0, 1] + slope / own) == pytest.approx(second, rel=3e-4)
    smaller, larger = contact.principal_curvatures
    assert smaller * larger == pytest.approx(np.linalg.det(tensor), rel=1e-10)
    assert 0.0 < smaller < larger


def test_marking_band_ends_where_the_gap_is_that_deep():
    contact = UnloadedContact(CASE_ONE, Misalignment(gear_axial=3e-5))
    inner, outer = contact.marking_band(6.35e-6)
    np.testing.assert_allclose(contact.gap([inner, outer]), 6.35e-6, rtol=1e-8)
    assert inner < contact.position < outer
    edges = contact.marking_band(1.0)
    np.testing.assert_allclose(edges, [CASE_ONE.inner_radius, CASE_ONE.outer_radius], rtol=1e-9)


def test_backlash():
    assert UnloadedContact(CASE_ONE).backlash == pytest.approx(0.0, abs=1e-15)
    closer, further = (UnloadedContact(CASE_ONE, Misalignment(gear_axial=q)).backlash for q in (-5e-6, 5e-6))
    # Closer by Δq, less play by 2 Δq tan α, to first order.
    assert (further - closer) / 1e-5 == pytest.approx(-2.0 * math.tan(CASE_ONE.pressure_angle), rel=1e-3)


@pytest.mark.parametrize("error", ["offset", "gear_axial", "shaft_angle"])
def test_windows_end_at_an_edge(error):
    low, high = UnloadedContact(CASE_ONE).window(error)
    assert low < 0.0 < high
    for end, step in ((low, -1.0), (high, 1.0)):
        contact = UnloadedContact(CASE_ONE, Misalignment(**{error: end}))
        edges = [CASE_ONE.inner_radius, CASE_ONE.outer_radius]
        assert min(abs(contact.position - edge) for edge in edges) < 1e-6
        with pytest.raises(ValueError, match=r"edge at .* mm, where an edge bears"):
            UnloadedContact(CASE_ONE, Misalignment(**{error: end + step * 1e-6}))
    # All of the face, by the straight line of parallel errors.
    if error == "offset":
        q = np.arccos(float(CASE_ONE.contact_region.position(0.0)) / np.array(edges))
        ends = CASE_ONE.axis_offset * (math.cos(CASE_ONE.pressure_angle) - np.cos(q)) / np.sin(q)
        np.testing.assert_allclose([low, high], ends, atol=1e-8)


def test_nested_base_circles_do_not_meet():
    limit = -CASE_ONE.axis_offset * (1.0 - math.cos(CASE_ONE.pressure_angle))
    with pytest.raises(ValueError, match="do not meet"):
        UnloadedContact(CASE_ONE, Misalignment(gear_axial=limit - 1e-6))


# --- the drive of a larger shaper -----------------------------------------------------------------------------------


def test_what_the_shaper_makes_is_that_of_a_larger_pinion():
    larger = Drive(27, 130, 3.175e-3)
    for name in (
        "inner_limit",
        "outer_limit",
        "undercut_root",
        "pointing_angle",
        "shaper_tip_radius",
        "face_width",
    ):
        assert getattr(CASE_ONE, name) == getattr(larger, name)
    for name in (
        "pitch_radius",
        "base_radius",
        "pinion_tip_radius",
        "contact_ratio",
        "gear_ratio",
        "speed_ratio",
    ):
        assert getattr(CASE_ONE, name) == getattr(Drive(26, 130, 3.175e-3), name)
    np.testing.assert_allclose(CASE_ONE.tooth_flank(5, 5).points, larger.tooth_flank(5, 5).points)
    assert replace(CASE_ONE, shaper_teeth=26).has_line_contact
    assert Drive(26, 130, 3.175e-3, shaper_teeth=26).inner_limit == Drive(26, 130, 3.175e-3).inner_limit


def test_solids_of_pinion_and_gear_touch_where_contact_says():
    """The pinion's solid stands nearer to the gear by B: its pitch cylinder touches the pitch plane."""
    mesh = solids.pinion(CASE_ONE)
    axis = mesh.vertices[-2:]
    np.testing.assert_allclose(axis[:, [0, 2]], [[0.0, -CASE_ONE.axis_offset]] * 2, atol=1e-15)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda: Drive(26, 130, 3.175e-3, shaper_teeth=25),
            "shaper_teeth must be an integer from 26 to 129, got 25",
        ),
        (
            lambda: Drive(26, 130, 3.175e-3, shaper_teeth=130),
            "shaper_teeth must be an integer from 26 to 129",
        ),
        (lambda: CASE_ONE.geometric_contact_ratio, "UnloadedContact has it"),
        (lambda: CASE_ONE.entry_rotation, "contact along lines"),
        (lambda: ContactPath(CASE_ONE), "ContactPath needs contact along lines"),
        (lambda: Contact().require(CASE_ONE), "ContactPath needs contact along lines"),
        (lambda: UnloadedContact(Drive(26, 130, 3.175e-3)), "shaper_teeth must exceed pinion_teeth=26"),
        (lambda: Misalignment(shaft_angle=0.2), "shaft_angle must be at most 0.1 rad"),
        (lambda: Misalignment(offset=math.nan), "offset"),
        (lambda: Misalignment(offset=1e300), "offset must be at most 0.1 m either way"),
        (lambda: Misalignment(gear_axial=-0.15), r"\(in mm\? gear_axial=-0.00015 would be valid\)"),
        (lambda: Misalignment(shaft_angle=1.0), r"\(in degrees\? shaft_angle=0.01745 would be valid\)"),
        (lambda: Misalignment(pivot=206.0), r"pivot must be at most 100 m either way; got 206.0 m \(in mm\?"),
        (lambda: UnloadedContact(CASE_ONE).window("pinion_axial"), "error must be 'offset' or"),
        (lambda: UnloadedContact(CASE_ONE).gap(0.1), r"position must lie in \[0.188499, 0.231573\] m"),
        (lambda: UnloadedContact(CASE_ONE).gap(206.375), r"\(in mm\? 0.206375 m would be valid\)"),
        (lambda: UnloadedContact(CASE_ONE).hertz(1e-300, 1e11), "force must be at least 1e-12 N"),
        (lambda: UnloadedContact(CASE_ONE).hertz(1e3, 1e300), "modulus must be at most"),
        (
            lambda: UnloadedContact(Drive(12, 14, 3e-3, shaper_teeth=13)),
            "shaper_teeth=13 leave aligned gears no contact on the flank",
        ),
        (lambda: Drive(10, 60, 3e-3, shaper_teeth=11), "shaper_teeth=11 is too few"),
        (lambda: UnloadedContact(CASE_ONE).hertz(0.0, 1e11), "force"),
        (lambda: UnloadedContact(CASE_ONE).marking_band(-1.0), "depth"),
        (lambda: UnloadedContact(CASE_ONE).hertz(1000.0, 110.0), "modulus must be in Pa"),
        (lambda: UnloadedContact(CASE_ONE).curvatures(100.0), "roll must lie in"),
        (lambda: UnloadedContact(CASE_ONE).curvatures(0.0), "roll must lie in"),
        (lambda: UnloadedContact(CASE_ONE).curvatures(math.nan), "roll must lie in .*got nan"),
        (
            lambda: UnloadedContact(CASE_ONE, Misalignment(shaft_angle=0.08)),
            r"do not meet; .* of it would leave some",
        ),
        (
            lambda: UnloadedContact(CASE_ONE, Misalignment(offset=-0.01)),
            r"an edge bears; .* of it would leave some",
        ),
        (
            lambda: Transverse(Body(CASE_ONE, 0.03), MeshLoad(0.6, 3e-6, 1.0)),
            r"path=fg.point_contact, sharing=\"mean\"",
        ),
    ],
)
def test_bad_input(call, message):
    with pytest.raises(ValueError, match=message):
        call()


@pytest.mark.parametrize(
    "call",
    [
        lambda: UnloadedContact(3.0),
        lambda: UnloadedContact(CASE_ONE, 1e-5),
        lambda: UnloadedContact(CASE_ONE).curvatures("a"),
        *(
            lambda name=name: Misalignment(**{name: None})
            for name in ("offset", "gear_axial", "pinion_axial")
        ),
        lambda: Misalignment(shaft_angle=None),
    ],
)
def test_wrong_kinds(call):
    with pytest.raises(TypeError, match="must be a"):
        call()


def test_the_part_of_a_misalignment_that_is_named_would_leave_contact():
    for error, value in (("offset", -0.01), ("offset", 0.01), ("gear_axial", 0.01), ("shaft_angle", 0.08)):
        with pytest.raises(ValueError, match="would leave some") as caught:
            UnloadedContact(CASE_ONE, Misalignment(**{error: value}))
        share = float(re.search(r"\(([\d.e-]+) of it", str(caught.value))[1])
        low, high = UnloadedContact(CASE_ONE).window(error)
        limit = high if value > 0.0 else low
        assert share == pytest.approx(limit / value, rel=0.06, abs=0.001)
        # To be followed: what is named is rounded downwards.
        UnloadedContact(CASE_ONE, Misalignment(**{error: share * value}))


@pytest.mark.parametrize("error", ["offset", "gear_axial", "shaft_angle"])
def test_just_beyond_a_window_nearly_all_of_the_misalignment_would_do(error):
    for end in UnloadedContact(CASE_ONE).window(error):
        with pytest.raises(ValueError, match=r"\(0\.999 of it would leave some\)"):
            UnloadedContact(CASE_ONE, Misalignment(**{error: end * (1.0 + 1e-5)}))


@pytest.mark.parametrize("angle", [60.0, 75.0, 90.0, 100.0, 120.0])
def test_ends_of_the_face_in_the_coordinate_of_the_shapers_axis(angle):
    """All of the flank lies between them, and comes to both; at 90° they are L1 and L2."""
    drive = replace(CASE_ONE, shaper_teeth=28, shaft_angle=math.radians(angle))
    contact = UnloadedContact(drive)
    low, high = contact.face
    assert low < contact.position < high
    shaper, region = drive.generating, drive.contact_region
    places = [
        float(region.position(region.edge_angle(edge, roll)))
        for edge in (shaper.flank_start, shaper.outer_radius)
        for roll in np.linspace(0.0, shaper.shaper_tip_roll, 41).tolist()
    ]
    np.testing.assert_allclose([min(places), max(places)], [low, high], rtol=1e-12)
    if angle == 90.0:
        np.testing.assert_allclose([low, high], [drive.inner_limit, drive.outer_limit], rtol=1e-12)
    assert np.isfinite(contact.gap([low, high])).all()
    for beyond in (low - 1e-6, high + 1e-6):
        with pytest.raises(
            ValueError, match="the coordinates u along the shaper's axis where the flank has points"
        ):
            contact.gap(beyond)
