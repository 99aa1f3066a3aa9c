"""Gearbox with play: the backward path, linear limits, borders of tongues, and event-driven shooting."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from facegear.floquet.arc_length import Following
from facegear.floquet.continuation import doubled, followed
from facegear.floquet.multipliers import multipliers
from facegear.floquet.orbits import periodic_orbit
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.floquet.response import steady_response
from facegear.mechanics.backlash import Backlash
from facegear.mechanics.contact import Contact
from facegear.mechanics.gearboxes import FIGURES
from facegear.support.parameters import rad_per_s, rpm
from tests.independent.impacts import Drive, Touch

MODEL = Backlash(FIGURES["7.12a"].model(), torque=800.0, gap=1e-4)
X = np.linspace(0.0, 1.0, 60)
WAVE = PiecewiseChebyshev.fit(lambda x, piece: 2e-5 * np.cos(2.0 * np.pi * x), [0.0])


def as_drive(model, speed):
    """Return the gearbox from the formulas of the text, on the skew line (3-22) and its reverse."""
    drive, gearbox = model.torsional.drive, model.torsional.gearbox.in_si
    ratio, base = model.torsional.contact_ratio, drive.base_radius
    period = 2.0 * np.pi / (drive.gear_teeth * speed)
    fall = (drive.inner_radius - drive.outer_radius) / ratio
    turning = model.turning_point

    def pair(age, sense):
        """Shape of a pair so many mesh periods after it came, and its rate."""
        cosine = math.cos(drive.pressure_angle)
        phi = np.array([base, -(drive.outer_radius + fall * age) * cosine, 0.0])
        return phi, np.array([0.0, -sense * fall * cosine / period, 0.0]), 0.0, 0.0

    def forward(number):
        age = lambda t: t / period % 1.0 + number  # noqa: E731
        return lambda t: pair(age(t), 1.0), lambda t: age(t) < ratio

    def backward(number):
        age = lambda t: (turning - t / period) % 1.0 + number  # noqa: E731
        return lambda t: pair(age(t), -1.0), lambda t: age(t) < ratio

    k, c, half = gearbox.mesh_stiffness, gearbox.mesh_damping, model.gap / 2.0
    touches = [
        Touch(at, side, half, k, c, there)
        for side, flank in ((1, forward), (-1, backward))
        for at, there in map(flank, range(math.ceil(ratio)))
    ]
    breaks = {ratio % 1.0, turning % 1.0, (turning - ratio) % 1.0}
    shafts = [
        np.array([[first, 0.0, 0.0], [0.0, second, -second], [0.0, -second, second]])
        for first, second in (
            (gearbox.input_damping, gearbox.output_damping),
            (gearbox.input_stiffness, gearbox.output_stiffness),
        )
    ]
    mass = np.diag([gearbox.pinion_inertia, gearbox.gear_inertia, gearbox.load_inertia])
    torque = np.array([0.0, 0.0, -model.torque])
    ends = tuple(x * period for x in sorted(breaks))
    return Drive(mass, *shafts, lambda t: torque, touches, period, ends)


# States (q, q̇) near which a motion repeats itself, settled from random ones, and what it is like.
PRESSED = None
PARTS = [-1.4e-4, -5.607e-4, -6.031e-4, -0.626, -1.086, -1.204]
STRIKES = [-4.26122e-4, -1.013356e-3, -1.096966e-3, 1.861405, 2.917373, 3.279848]
TWICE = [-2.214583e-4, -6.866316e-4, -7.428211e-4, -0.5196433, -0.9471254, -1.007117]


# More of them, stable or not, on either side of folds: start states to seven digits.
FURTHER = [
    (245.0, 1, [-2.034843e-4, -6.512433e-4, -7.012452e-4, -0.5588287, -1.622695, -2.020431], True, False),
    (245.0, 1, [-2.308186e-4, -6.92901e-4, -7.524791e-4, -0.7354439, -1.925843, -2.278899], True, True),
    (300.0, 1, [-5.9999e-4, -1.319417e-3, -1.44947e-3, -1.922116, -3.343597, -4.396339], True, True),
    (215.0, 1, [-2.020649e-4, -6.546823e-4, -7.109887e-4, 0.9600241, 1.497778, 1.594384], True, False),
    (280.0, 1, [-9.217606e-4, -1.815077e-3, -2.014684e-3, 3.81505, 6.182636, 7.065663], True, True),
    (160.0, 1, [-2.189823e-4, -6.812091e-4, -7.360402e-4, -0.2869349, -0.4858661, -0.5499993], True, False),
    (500.0, 2, [3.21719e-4, 8.988145e-4, 8.629901e-4, -0.7900045, -2.093781, -1.21006], True, True),
    (560.0, 2, [-2.262585e-6, -1.047196e-4, -1.384169e-4, 0.4168457, 0.6830536, 0.4919576], True, False),
]


@pytest.mark.parametrize(
    ("speed_rpm", "periods", "guess", "parts", "strikes"),
    [
        *FURTHER,
        (250.0, 1, PRESSED, False, False),
        (320.0, 1, PARTS, True, False),
        (250.0, 1, STRIKES, True, True),
        (640.0, 2, TWICE, True, False),
    ],
)
def test_event_driven_shooting(speed_rpm, periods, guess, parts, strikes):
    speed = rad_per_s(speed_rpm)
    orbit = periodic_orbit(MODEL.system(speed), periods, guess)
    assert guess is None or np.abs(np.array(guess) / orbit.start - 1.0).max() < 0.01
    assert (MODEL.parts(orbit), MODEL.strikes_back(orbit)) == (parts, strikes)
    drive = as_drive(MODEL, speed)
    end, crossings = drive.flown(orbit.start, periods)
    assert crossings == len(orbit.pattern.crossings)
    # How far the motion that shooting repeats is from this one: (I − Φ)⁻¹ of what it misses by.
    away = np.linalg.solve(np.eye(6) - orbit.transition, end - orbit.start)
    sizes = np.abs(orbit.state(X)).max(axis=0)
    assert (np.abs(away) < 1e-8 * sizes).all()


def test_flips_are_the_borders_of_the_linear_tongue():
    speeds = [rad_per_s(x) for x in (560.0, 700.0)]
    orbit = periodic_orbit(MODEL.system(speeds[1]))
    branch = followed(MODEL.system, speeds[1], orbit, *speeds, direction=-1.0)
    assert [point.kind for point in branch.special] == ["flip", "flip"]

    def beyond(speed):
        return np.prod(multipliers(MODEL.pressed(speed)) + 1.0).real

    for point, (low, high) in zip(branch.special, ((650.0, 700.0), (570.0, 620.0)), strict=True):
        border = brentq(beyond, rad_per_s(low), rad_per_s(high), xtol=1e-10)
        assert rpm(point.parameter) == pytest.approx(rpm(border), abs=1e-4)
    assert (~branch.stable).any()
    # Twice the period: amplitudes of the linear system, all at its border, until the first pair lets go.
    twice = doubled(MODEL.system, branch.special[0], *speeds, following=Following(most=25))
    lets_go = np.array([len(orbit.pattern.crossings) > 0 for orbit in twice.orbits])
    assert twice.orbits[0].periods == 2
    assert twice.parameters[~lets_go] == pytest.approx(branch.special[0].parameter, rel=1e-6)
    assert MODEL.parts(twice.orbits[-1])
    assert twice.parameters[-1] < 0.95 * twice.parameters[0]


def test_backward_pairs_run_through_the_path_in_reverse():
    system = MODEL.system(50.0)
    count = len(MODEL.torsional.shapes)
    forward, backward = system.system.loads[:count], system.system.loads[count:]
    for ahead, behind in zip(forward, backward, strict=True):
        np.testing.assert_allclose(
            behind.shape(X + 0.013), ahead.shape(MODEL.turning_point - X - 0.013), atol=1e-14
        )
    places = MODEL.torsional.contact.coasting_places(MODEL.torsional.drive)
    arm = MODEL.torsional.drive.outer_radius * math.cos(MODEL.torsional.drive.pressure_angle)
    for place, load in zip(places, backward, strict=True):
        np.testing.assert_allclose(
            load.shape(X + 0.013)[:, 1], -arm * place.position(X + 0.013)[:, 0], atol=1e-12
        )
    # As printed the path keeps its sense; both agree where a pair passes the pitch point, half a period on.
    printed = replace(MODEL, back_flank="printed").system(50.0).system.loads[count:]
    passage = (MODEL.turning_point - 0.5) / 2.0
    age, number = math.modf(passage)
    for loads in (backward, printed):
        radii = np.sort([load.shape(age + 0.5)[1] for load in loads])
        assert np.abs(radii - forward[int(number)].shape(age)[1]).min() < 1e-12
    assert np.abs(printed[0].shape(0.3) - backward[0].shape(0.3)).max() > 1e-3


def test_without_a_gap_or_under_a_large_torque_it_is_the_linear_response():
    speed = rad_per_s(250.0)
    model = replace(MODEL, gap=0.0, transmission_error=WAVE)
    response = steady_response(model.pressed(speed))
    size = np.abs(response.state(X)).max(axis=0)
    orbit = periodic_orbit(model.system(speed))
    assert (np.abs(orbit.state(X) - response.state(X)).max(axis=0) < 1e-9 * size).all()
    # Half a gap beyond, with the pinion at rest on average: the motion about it is that of the linear system.
    loaded = replace(MODEL, torque=8000.0, gap=1e-7)
    response = steady_response(loaded.pressed(speed))
    orbit = periodic_orbit(loaded.system(speed))
    assert not loaded.parts(orbit)
    size = np.abs(response.state(X)).max(axis=0)
    assert (np.abs(orbit.state(X) - response.state(X)).max(axis=0) < 1e-3 * size).all()
    assert (np.abs(orbit.state(X) - response.state(X)).max(axis=0) > 1e-6 * size).any()


def test_homogeneous_in_torque_gap_and_transmission_error():
    speed = rad_per_s(250.0)
    model = replace(MODEL, transmission_error=WAVE)
    times = Backlash(
        MODEL.torsional,
        2.5 * MODEL.torque,
        2.5 * MODEL.gap,
        PiecewiseChebyshev(WAVE.breakpoints, 2.5 * WAVE.coefficients),
    )
    guess = np.array(STRIKES)
    orbit = periodic_orbit(model.system(speed), guess=guess)
    assert model.strikes_back(orbit)
    larger = periodic_orbit(times.system(speed), guess=2.5 * guess)
    size = np.abs(orbit.state(X)).max(axis=0)
    assert (np.abs(larger.state(X) / 2.5 - orbit.state(X)).max(axis=0) < 1e-10 * size).all()


def test_at_rest_the_deformation_carries_the_torque():
    """Slowly turned, the mean force at the face gear is the torque: stiffness of the pairs times deformation."""
    orbit = periodic_orbit(MODEL.system(rad_per_s(700.0)))
    forces = orbit.response.mean(orbit.response.contact_forces)
    arms = orbit.response.mean(
        lambda x: sum(
            -load.shape(x)[:, 1] * orbit.response.contact_forces(x)[:, number]
            for number, load in enumerate(orbit.response.system.loads)
        )
    )
    assert arms == pytest.approx(MODEL.torque, rel=1e-6)
    assert forces[: len(MODEL.torsional.shapes)].min() > 0.0


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (
            lambda: replace(MODEL, torque=0.0),
            ValueError,
            "torque must be greater than 0 N m, or nothing presses",
        ),
        (lambda: replace(MODEL, gap=-1e-5), ValueError, "gap must lie in"),
        (lambda: replace(MODEL, gap=0.1), ValueError, "wrong by a factor of 1000"),
        (lambda: replace(MODEL, torsional=3), TypeError, "torsional must be a Torsional"),
        (lambda: replace(MODEL, transmission_error=3.0), TypeError, "transmission_error must be a Piece"),
        (
            lambda: replace(MODEL, transmission_error=PiecewiseChebyshev.constant([0.0, 0.0])),
            ValueError,
            "transmission_error must have one component",
        ),
        (lambda: replace(MODEL, back_flank="delayed"), ValueError, "back_flank must be"),
        (lambda: MODEL.system(0.0), ValueError, r"^speed must be greater than 0"),
        (lambda: MODEL.system(1e300), ValueError, r"^speed must be at most 1e\+07 rad/s"),
        (
            lambda: replace(MODEL, torque=1e12),
            ValueError,
            r"torque must be at most .* N m, which presses one pair",
        ),
    ],
)
def test_bad_input_names_the_parameter(call, error, message):
    with pytest.raises(error, match=message):
        call()


@pytest.mark.parametrize(("arm", "moves"), [("printed", True), ("conjugate", False)])
def test_a_turn_by_half_the_gap_is_a_transmission_error_where_the_arm_varies(arm, moves):
    """Seen while all flanks stay pressed: with a constant arm the gap turns gear and load, and nothing else."""
    swings = []
    for gap in (1e-8, 4e-4):
        model = replace(MODEL, torsional=FIGURES["7.12a"].model(arm=arm), gap=gap)
        orbit = periodic_orbit(model.system(float(rad_per_s(700.0))))
        assert not model.parts(orbit)
        swings.append(np.ptp(model.deformation(orbit, np.linspace(0.0, 1.0, 401))))
    assert (swings[1] > 1.5 * swings[0]) == moves
    assert moves or swings[1] == pytest.approx(swings[0], rel=1e-6)


def test_other_contacts():
    """Any contact that says when its pairs pass the pitch point, such as the centroid of the contact lines."""
    torsional = replace(MODEL.torsional, contact=Contact(rate="total"))
    model = replace(MODEL, torsional=torsional)
    system = model.system(rad_per_s(700.0))
    assert len(system.sides) == 2
    orbit = periodic_orbit(system)
    assert orbit.in_contact[1] == 0.0


def test_a_torus_is_the_border_of_a_combination_tongue():
    model = Backlash(FIGURES["7.12b"].model(), torque=100.0, gap=5e-5)
    low, high = rad_per_s(780.0), rad_per_s(840.0)
    branch = followed(model.system, high, periodic_orbit(model.system(high)), low, high, direction=-1.0)
    (torus,) = branch.special
    assert torus.kind == "torus"
    border = brentq(
        lambda speed: np.abs(multipliers(model.pressed(speed))).max() - 1.0, low, high, xtol=1e-11
    )
    assert rpm(torus.parameter) == pytest.approx(rpm(border), abs=1e-4)
    pair = torus.orbit.multipliers[:2]
    np.testing.assert_allclose(np.abs(pair), 1.0, atol=1e-7)
    assert np.abs(pair.imag).min() > 0.01
