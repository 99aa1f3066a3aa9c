"""Contact under load: gap and lines of slices, equilibrium, limits, and an independent route."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.integrate import quad

from facegear.geometry.drive import Drive
from facegear.geometry.misalignment import Misalignment
from facegear.geometry.point_contact import UnloadedContact
from facegear.mechanics import mesh_cycle
from facegear.mechanics.compliance import Lines
from facegear.mechanics.loaded_contact import LoadedContact
from facegear.mechanics.slices import Slices
from facegear.support.parameters import keep
from tests.independent.loaded_contact import LoadedContact as Independent

MODULE = 3.175e-3
CUT = Drive(26, 130, MODULE, shaper_teeth=27)
ERROR = Misalignment(offset=2e-5, gear_axial=-1e-5, shaft_angle=1e-4)
LAWS = ["slice", "pair"]  # plates have tests of their own


@pytest.mark.parametrize("error", [Misalignment(), ERROR], ids=["aligned", "misaligned"])
@pytest.mark.parametrize("angle", [75.0, 90.0, 105.0])
def test_gap_of_slices_is_that_of_the_unloaded_contact(angle, error):
    slices = Slices(replace(CUT, shaft_angle=math.radians(angle), shaper_teeth=28), error)
    position = slices.contact.position + np.array([-1.2e-2, -4e-3, 0.0, 3e-3, 1.5e-2])
    q = np.arccos(float(slices.drive.contact_region.position(0.0)) / position)
    s = slices.root_gap(q)
    np.testing.assert_allclose(s**2, slices.contact.gap(position), rtol=1e-9, atol=1e-16)
    away = position - slices.contact.position
    assert np.all(np.sign(s)[away != 0.0] == np.sign(away)[away != 0.0])
    np.testing.assert_allclose(slices.position(s), position, rtol=1e-13)


def test_areas_under_the_gap_by_quadrature():
    slices = Slices(CUT)
    low, high = -3e-3, 2.5e-3
    distance, area = slices.distance_and_area(np.array([low, high]))
    slope = slices.position.deriv()
    assert distance[1] - distance[0] == pytest.approx(quad(slope, low, high, epsabs=1e-15)[0], rel=1e-12)
    by_quadrature = quad(lambda s: s**2 * slope(s), low, high, epsabs=1e-20)[0]
    assert area[1] - area[0] == pytest.approx(by_quadrature, rel=1e-11)


@pytest.mark.parametrize(
    ("drive", "kinks"),
    [
        (CUT, 2),
        pytest.param(replace(CUT, shaft_angle=math.radians(105.0)), 3, marks=pytest.mark.slow),
        pytest.param(Drive(20, 100, MODULE, shaper_teeth=21), 2, marks=pytest.mark.slow),
        (Drive(52, 260, 3e-3, shaper_teeth=55), 1),
        (Drive(17, 85, 3e-3, shaper_teeth=18), 3),
        (Drive(26, 130, MODULE, shaper_teeth=115), 3),
        pytest.param(
            Drive(20, 100, MODULE, shaper_teeth=21, shaft_angle=math.radians(91.0)), 3, marks=pytest.mark.slow
        ),
    ],
    ids=["Case I", "cut again at 105°", "few", "many teeth", "fewer", "large shaper", "cut again at the end"],
)
def test_lines_lie_on_both_flanks_and_end_at_an_edge(drive, kinks):
    slices = Slices(drive)
    assert len(slices.kinks) == kinks
    region, shaper = drive.contact_region, drive.generating
    age = np.linspace(1e-3, slices.sweep - 1e-3, 57)
    ends = slices.ends(age)

    def room(s):
        """Distance to each edge, all positive on both flanks, in parts of the module or of a radian."""
        q = slices.pressure_angle(s)
        roll = slices.roll(q, slices.limits[0] - age * slices.pitch)
        parts = [
            roll,
            slices.contact.lines.own_roll(q, roll),
            drive.pinion_tip_roll - slices.contact.lines.own_roll(q, roll),
            shaper.shaper_tip_roll - roll,
            (region.depth(q, roll) - shaper.tooth_top_distance) / drive.module,
            (region.radial_position(q, roll) - shaper.flank_start) / drive.module,
            (shaper.outer_radius - region.radial_position(q, roll)) / drive.module,
        ]
        if drive.shaft_angle > 0.5 * math.pi:
            parts.append(region.shaper.clearance(q, roll) / drive.module)
        return np.min(parts, axis=0)

    for end in ends:
        assert np.abs(room(end)).max() < 1e-8
    assert room(0.5 * (ends[0] + ends[1])).min() > 0.0
    # The unloaded contact is on the line for just its own contact ratio.
    there = np.linspace(0.0, slices.sweep, 200001)
    inner, outer = slices.ends(there)
    share = np.mean((inner <= 0.0) & (outer >= 0.0)) * slices.sweep
    assert share == pytest.approx(slices.contact.contact_ratio, abs=5e-5)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("torque", [1e-3, 1.0, 30.0, 1000.0])
def test_forces_balance_the_torque(law, torque):
    contact = LoadedContact(CUT, torque, ERROR, law)
    instants = np.linspace(0.0, 1.0, 37)
    assert np.abs(contact.pairs(instants).force.sum(axis=0) / contact.force - 1.0).max() < 1e-12


@pytest.mark.parametrize("law", LAWS)
def test_a_line_of_which_nothing_is_left_carries_nothing(law):
    """However its ends are rounded: any force would count as contact."""
    s = np.random.default_rng(7).uniform(-4e-3, 3e-3, 4001)
    ages = np.zeros_like(s)
    contact = LoadedContact(CUT, 20.0, compliance=law)
    for force in contact.cycle.law.force(np.full(s.shape, 1e-5), Lines(s, s, ages)):
        assert np.count_nonzero(force) == 0


@pytest.mark.parametrize("angle", [60.0, 75.0, 100.0, 120.0])
def test_pressure_over_the_face_is_the_force(angle):
    contact = LoadedContact(replace(CUT, shaper_teeth=28, shaft_angle=math.radians(angle)), 100.0)
    u = np.linspace(*contact.slices.contact.face, 4001)
    carried = np.trapezoid(contact.pressure(0.3, u), u, axis=-1)
    np.testing.assert_allclose(carried, contact.pairs(0.3).force, atol=2e-4 * contact.force)


@pytest.mark.parametrize("law", LAWS)
def test_stiffness_is_the_slope_of_force_against_approach(law):
    """At one instant: a little more torque, a little more approach."""
    contact = LoadedContact(CUT, 50.0, compliance=law)
    more, less = (LoadedContact(CUT, 50.0 + change, compliance=law) for change in (1e-3, -1e-3))
    for fraction in (0.2, 0.6):
        # The same rotation, not the same time since a pair began to be pressed.
        ages = [fraction + contact.cycle.first - other.cycle.first for other in (more, less)]
        approach = [other.transmission_error(age) for other, age in zip((more, less), ages, strict=True)]
        slope = (more.force - less.force) / (approach[0] - approach[1])
        assert float(contact.mesh_stiffness(fraction)) == pytest.approx(float(slope), rel=1e-6)


@pytest.mark.parametrize(("law", "power"), [("slice", 1.0 / 3.0), ("pair", 0.5)], ids=["slice", "pair"])
def test_small_loads_leave_the_contact_ratio_of_the_point_like_the_root_of_the_approach(law, power):
    torques = np.array([1e-9, 1e-8, 1e-7])
    point = UnloadedContact(CUT, ERROR).contact_ratio
    more = [LoadedContact(CUT, t, ERROR, law).contact_ratio - point for t in torques]
    slopes = np.diff(np.log(more)) / np.diff(np.log(torques))
    np.testing.assert_allclose(slopes, power, atol=2e-3)
    assert more[0] < 1e-3


@pytest.mark.parametrize("law", LAWS)
def test_a_load_that_spans_the_face_presses_whole_lines(law):
    contact = LoadedContact(CUT, 1.0, compliance=law)
    keep(contact, torque=1e7)  # more than teeth take
    assert contact.contact_ratio == pytest.approx(contact.slices.sweep, abs=1e-13)
    instants = np.linspace(0.0, 1.0, 20, endpoint=False)
    pairs = contact.pairs(instants)
    # The gap is nothing against the approach: pairs share by the length of their lines, or equally.
    ages = np.stack([instants + k for k in range(len(pairs.force))])
    inner, outer = contact.slices.ends(ages)
    length = np.where(
        ages < contact.slices.sweep, contact.slices.position(outer) - contact.slices.position(inner), 0.0
    )
    shares = length if law == "slice" else (length > 0.0).astype(float)
    np.testing.assert_allclose(pairs.force / contact.force, shares / shares.sum(axis=0), atol=2e-3)


@pytest.mark.parametrize("law", LAWS)
def test_contact_ratio_grows_with_the_torque_from_point_to_line(law):
    torques = np.geomspace(1e-2, 1e4, 13)
    ratios = [LoadedContact(CUT, t, compliance=law).contact_ratio for t in torques]
    assert np.all(np.diff(ratios) >= -1e-12)
    assert UnloadedContact(CUT).contact_ratio < ratios[0] < ratios[-1] <= Slices(CUT).sweep + 1e-12
    assert ratios[-1] == pytest.approx(Drive(26, 130, MODULE).geometric_contact_ratio, rel=0.01)


def test_larger_shapers_press_for_less_time():
    ratios = [LoadedContact(replace(CUT, shaper_teeth=26 + k), 50.0).contact_ratio for k in (1, 2, 3)]
    assert ratios[0] > ratios[1] > ratios[2]


@pytest.mark.parametrize("law", [*LAWS, "plate"])
def test_one_age_and_one_slice_are_as_good_as_many(law):
    contact = LoadedContact(CUT, 60.0, compliance=law)
    for one, many in zip(contact.pairs_of_age(0.2), contact.pairs_of_age([0.2]), strict=True):
        assert float(one) == pytest.approx(many[0], rel=1e-12)
    assert contact.line_load(1.5, 0.0) == pytest.approx(contact.line_load([1.5], [[0.0]])[0], rel=1e-12)
    assert contact.line_load([1.5, 1.6], 0.0).shape == (2, 1)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("torque", [1e-13, 2e4])
def test_the_least_and_the_largest_torque_balance(law, torque):
    contact = LoadedContact(CUT, torque, compliance=law)
    # Beside the instant at which a pair begins: there, what the least torque presses is as short as its rounding.
    force = contact.pairs((np.arange(11) + 0.5) / 11).force.sum(axis=0)
    np.testing.assert_allclose(force, contact.force, rtol=1e-9)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("torque", [2.0, 60.0, 3000.0])
def test_the_series_over_a_period_are_what_equilibrium_says(law, torque):
    contact = LoadedContact(CUT, torque, compliance=law)
    rng = np.random.default_rng(3)
    fraction = rng.uniform(0.0, 1.0, 200)
    clear = np.abs(fraction[:, np.newaxis] - contact.breakpoints).min(axis=1) > 1e-6
    pairs = contact.pairs(fraction[clear])
    np.testing.assert_allclose(contact.transmission_error(fraction[clear]), pairs.approach[0], rtol=1e-10)
    np.testing.assert_allclose(
        contact.mesh_stiffness(fraction[clear]), pairs.stiffness.sum(axis=0), rtol=1e-9
    )


def test_the_excitation_is_the_transmission_error_without_its_mean():
    contact = LoadedContact(CUT, 200.0)
    time = (np.arange(4000) + 0.5) / 4000
    error = contact.transmission_error(time)
    np.testing.assert_allclose(
        contact.excitation(time)[:, 0], error - error.mean(), atol=1e-6 * np.ptp(error)
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("law", "torque", "teeth", "offset", "closer"),
    [("slice", 300.0, 28, 1e-5, -1e-5)],
)
def test_against_thirty_digits_from_the_definition(law, torque, teeth, offset, closer):
    """Nothing in common but the definitions: own limits of the tooth, own ends of lines, quadrature."""
    other = Independent((26, 130), teeth, "3.175e-3", torque, law, offset, closer)
    contact = LoadedContact(
        Drive(26, 130, MODULE, shaper_teeth=teeth),
        torque,
        Misalignment(offset=offset, gear_axial=closer),
        law,
    )
    begins, ends = other.begins(), other.stops()
    assert contact.contact_ratio == pytest.approx(float(ends - begins), abs=1e-11)
    for fraction in (0.25, 0.7):
        phase = (fraction + begins) % 1
        approach = other.approach(phase)
        pairs = other.all_pairs(approach, phase)
        ours = contact.pairs(fraction)
        count = len(ours.force)
        assert float(contact.transmission_error(fraction)) == pytest.approx(float(approach), rel=1e-11)
        assert float(contact.mesh_stiffness(fraction)) == pytest.approx(
            float(sum(p[1] for p in pairs)), rel=1e-11
        )
        np.testing.assert_allclose(
            ours.force, [float(p[0]) for p in pairs[:count]], atol=1e-10 * contact.force
        )
        for k in range(count):
            if pairs[k][0] > 0:
                assert ours.radius[k] == pytest.approx(float(pairs[k][2] / pairs[k][0]), abs=1e-12)
                assert ours.angle[k] == pytest.approx(float(pairs[k][3] / pairs[k][0]), abs=1e-12)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: LoadedContact(Drive(26, 130, MODULE), 10.0), "shaper_teeth must exceed pinion_teeth=26"),
        (lambda: Drive(26, 130, MODULE, shaper_teeth=25), "shaper_teeth must"),
        (
            lambda: LoadedContact(CUT, 0.0),
            "torque must be greater than 0 N m, got 0 N m: without load UnloadedContact",
        ),
        (lambda: LoadedContact(CUT, -5.0), "torque must be greater than 0 N m, got -5 N m"),
        (lambda: LoadedContact(CUT, math.nan), "torque must be finite"),
        (lambda: LoadedContact(CUT, 10.0, Misalignment(gear_axial=3e-4)), "outside the outer edge"),
        (lambda: LoadedContact(CUT, 10.0, compliance="beam"), "compliance must be"),
        (
            lambda: LoadedContact(CUT, 10.0, correction_factor=2.0),
            r"correction_factor must lie in \[1e-06, 1\], got 2.0 \(what gear bodies",
        ),
        (lambda: LoadedContact(CUT, 10.0, correction_factor=5e-324), "correction_factor must"),
        (
            lambda: LoadedContact(CUT, 1e5),
            r"torque must lie in \[2.4e-14, 2.4e\+04\] N m .*: teeth would give way by more than a module",
        ),
        (lambda: LoadedContact(CUT, 1e308), r"torque must lie in \[2.4e-14, 2.4e\+04\] N m"),
        (lambda: LoadedContact(CUT, 1e-100), "less is lost in rounding; got 1e-100 N m"),
        (lambda: LoadedContact(CUT, 10.0).pressure(0.0, [206.375]), "in mm"),
        (lambda: LoadedContact(CUT, 10.0).pairs_of_age(math.nan), "ages must be finite"),
        (lambda: LoadedContact(CUT, 10.0).line_load([0.5, 1.0], np.zeros((3, 4))), "s must list slices"),
        (lambda: LoadedContact(CUT, 10.0).mesh_stiffness(math.inf), "fraction must be finite"),
    ],
)
def test_bad_input(call, message):
    with pytest.raises(ValueError, match=message):
        call()


@pytest.mark.parametrize(
    "call",
    [
        lambda: LoadedContact("drive", 10.0),
        lambda: LoadedContact(CUT, "10"),
        lambda: LoadedContact(CUT, 10.0, 2e-5),
        lambda: LoadedContact(CUT, 10.0, material=7840.0),
        lambda: LoadedContact(CUT, 10.0).line_load("a", 0.0),
        lambda: LoadedContact(CUT, 10.0).pairs_of_age("a"),
    ],
)
def test_wrong_kinds(call):
    with pytest.raises(TypeError, match="must be"):
        call()


@pytest.mark.parametrize("law", ["slice", "pair"])
@pytest.mark.parametrize("torque", [1e-4, 1.0])
def test_where_no_unloaded_pair_touches_the_nearest_one_carries_the_load(law, torque):
    drive = Drive(53, 152, 9.7e-3, math.radians(24.9), shaper_teeth=56)
    error = Misalignment(offset=-0.00664)
    assert UnloadedContact(drive, error).contact_ratio < 0.97
    contact = LoadedContact(drive, torque, error, compliance=law)
    assert 1.0 - 1e-12 < contact.contact_ratio < 1.5
    carried = contact.pairs(np.linspace(0.0, 1.0, 101)).force.sum(axis=0)
    # A gap of micrometres comes before the approach, and takes its digits.
    np.testing.assert_allclose(carried, torque / drive.base_radius, rtol=1e-9)


@pytest.mark.parametrize("law", ["slice", pytest.param("plate", marks=pytest.mark.slow)])
def test_a_load_that_is_lost_in_rounding_is_refused(law):
    drive = Drive(53, 152, 9.7e-3, math.radians(24.9), shaper_teeth=56)
    contact = LoadedContact(drive, 1e-8, Misalignment(offset=-0.006637444929717929), compliance=law)
    with pytest.raises(ArithmeticError, match=r"approach did not settle|contact changes at instants"):
        _ = contact.contact_ratio


def test_a_period_that_no_series_follows_is_refused_of_plates_too(monkeypatch):
    """What the load above comes to with plates, after seconds."""

    def jumps(*_, **__):
        raise ValueError("function is not smooth")

    # That of the period alone: contact lines and compliances are fitted, too, if another test has not done so before.
    monkeypatch.setattr(mesh_cycle, "PiecewiseChebyshev", SimpleNamespace(fit_together=jumps))
    with pytest.raises(ArithmeticError, match="contact changes at instants that were not found: function is"):
        _ = LoadedContact(CUT, 10.0, compliance="plate").contact_ratio


def test_edges_that_lie_close_together_are_told_apart_or_taken_as_one():
    contact = LoadedContact(
        Drive(28, 72, 4.12e-3, math.radians(20.6), math.radians(92.9), shaper_teeth=32), 50.0
    )
    assert (np.diff(contact.slices.breakpoints) > 0.0).all()
    # Between those at 92.8° and 93°, which differ by 7e-4.
    assert contact.contact_ratio == pytest.approx(2.49935, abs=1e-5)


@pytest.mark.slow
def test_lines_that_cannot_be_followed_are_refused_with_drive_and_misalignment():
    drive = Drive(29, 199, 5e-3, math.radians(24.0), math.radians(91.0), shaper_teeth=31)
    contact = LoadedContact(drive, 500.0, Misalignment(offset=-4.6e-3))
    with pytest.raises(ArithmeticError, match=r"29/199 teeth at a shaft angle of 91°.*offset=-0\.0046"):
        _ = contact.contact_ratio


def test_the_ends_of_a_line_are_pressed_however_they_are_rounded():
    """Their load is the limit from inside: it vanished wherever an end came out one digit beyond itself."""
    contact = LoadedContact(CUT, 1000.0)
    age = np.linspace(0.2, 0.9, 8) * contact.slices.sweep
    inner, outer = contact.slices.ends(age)
    s = np.stack([inner, inner + (outer - inner) * (1.0 - 1e-9), outer * (1.0 + 1e-15), outer], axis=-1)
    load = contact.line_load(age, s)
    np.testing.assert_allclose(load[:, 2:], load[:, [1, 1]], rtol=1e-6)
    assert np.count_nonzero(load[:, 3]) > 0
