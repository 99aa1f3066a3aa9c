"""Loads of every kind through every method: weights, masses with kicks, jumps of the state, transformed functions."""

import warnings
from dataclasses import dataclass, replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from facegear.floquet.error_estimates import error_estimate
from facegear.floquet.loads import ContactLoad, StateJump
from facegear.floquet.methods import AdaptiveMagnus, AlignedStepwise, Collocation, Magnus, Stepwise
from facegear.floquet.multipliers import growth_rate, multipliers, transition_matrix
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.floquet.radau import Radau
from facegear.floquet.rigid_motion import without_rigid_motion
from facegear.floquet.stepping import Family
from facegear.maps.stability_map import stability_map
from tests.independent.monodromy import integrated

METHODS = (Collocation(), AdaptiveMagnus(1e-12), Radau(16, 1e-13))


def tent(components, at, seed):
    """Piecewise linear and continuous, with slope jumps at 0 and `at`."""
    values = np.random.default_rng(seed).normal(size=(2, components))
    middle, half = (values[0] + values[1]) / 2.0, (values[1] - values[0]) / 2.0
    return PiecewiseChebyshev(np.array([0.0, at]), np.array([[middle, half], [middle, -half]]))


def weight(at, low, high, kink=False):
    """Return a weight that steps at `at`, or is bent there."""
    if kink:
        return PiecewiseChebyshev(
            np.array([0.0, at]),
            np.array([[[(low + high) / 2], [(high - low) / 2]], [[(low + high) / 2], [(low - high) / 2]]]),
        )
    return PiecewiseChebyshev(np.array([0.0, at]), np.array([[[low]], [[high]]]))


def rich(seed, size=3, damping=0.1):
    """Build a system with all there is: weighted masses, kicks under one of them, dampers, jumps of the state."""
    rng = np.random.default_rng(seed)
    turn = np.linalg.qr(rng.normal(size=(size, size)))[0]
    stiffness = turn @ np.diag(rng.uniform(1.0, 30.0, size)) @ turn.T
    loads = (
        ContactLoad(tent(size, 0.4, seed), 2.0, 0.3, 0.5, "total", weight(0.4, 0.2, 1.0, kink=True)),
        ContactLoad(tent(size, 0.7, seed + 1), 3.0, 0.1, 0.4, "frozen", weight(0.25, 0.0, 1.0)),
        ContactLoad(tent(size, 0.1, seed + 2), 1.0, 0.2, 0.0, "total", weight(0.6, -1.0, 0.5)),
    )
    # No two of them change at one instant: a jump of a weighted mass beside a kick would be no clear question.
    loads = tuple(load.moved(lambda x, by=0.13 * i: x.shift(by)) for i, load in enumerate(loads))
    jumps = (
        StateJump(0.55, np.eye(2 * size) + 0.1 * rng.normal(size=(2 * size, 2 * size))),
        StateJump(0.4, np.eye(2 * size) + 0.1 * rng.normal(size=(2 * size, 2 * size))),
    )
    mass = np.eye(size) + 0.2 * np.outer(turn[0], turn[0])
    return PeriodicSystem(
        mass, damping * np.eye(size), (stiffness + stiffness.T) / 2, loads, 2.0, jumps=jumps
    )


def apart(one, other, system):
    scale = Family([system]).scale
    return np.abs(scale @ (one - other) @ np.linalg.inv(scale)).max()


@pytest.mark.parametrize("seed", range(4))
def test_everything_at_once_against_an_integrator(seed):
    system = rich(seed)
    exact = integrated(system)
    for method in METHODS:
        assert apart(transition_matrix(system, method), exact, system) < 3e-11, method


def test_an_overdamped_system_with_jumps_against_an_integrator():
    system = rich(7, damping=60.0)
    exact = integrated(system)
    for method in METHODS[1:]:
        assert apart(transition_matrix(system, method), exact, system) < 3e-11, method


@settings(deadline=None, max_examples=15)
@given(seed=st.integers(0, 10**6), size=st.integers(1, 5))
def test_methods_agree_within_their_error_estimates(seed, size):
    system = rich(seed, size)
    radii = [(abs(multipliers(system, method)[0]), error_estimate(system, method)) for method in METHODS]
    for one, error in radii:
        for other, estimate in radii:
            assert abs(one - other) <= 10.0 * (error + estimate)


@pytest.mark.parametrize(("kind", "order"), [(AlignedStepwise, 2), (Magnus, 4)])
def test_fixed_steps_keep_their_order(kind, order):
    system = rich(3)
    exact = transition_matrix(system, Radau(20, 1e-14))
    counts = 2 ** np.arange(6, 10)
    errors = [apart(transition_matrix(system, kind(int(count))), exact, system) for count in counts]
    assert -np.polyfit(np.log(counts), np.log(errors), 1)[0] == pytest.approx(order, abs=0.15)


def test_equal_steps_refuse_jumps():
    with pytest.raises(ValueError, match=r"jumps of the state.*AlignedStepwise"):
        transition_matrix(rich(0), Stepwise(100))


@settings(deadline=None, max_examples=20)
@given(seed=st.integers(0, 10**6), periods=st.integers(1, 4), phase=st.floats(-1.0, 1.0))
def test_periods_taken_for_one_and_another_origin_of_time(seed, periods, phase):
    system = rich(seed, 2)
    once = transition_matrix(system)
    assert (
        apart(transition_matrix(system.repeated(periods)), np.linalg.matrix_power(once, periods), system)
        < 1e-10
    )
    assert system.repeated(periods).period == pytest.approx(periods * system.period)
    moved = multipliers(system.shift(phase))
    assert np.abs(moved[:, None] - multipliers(system)).min(axis=1).max() < 1e-9


def test_a_jump_of_the_state_by_hand():
    """An oscillator that is turned back by a quarter at half the period: half a turn in all for a period of 3π/2."""
    quarter = np.array([[0.0, -1.0], [1.0, 0.0]])
    system = PeriodicSystem([[1.0]], [[0.0]], [[1.0]], (), 1.5 * np.pi, jumps=(StateJump(0.5, quarter),))
    for method in (*METHODS, Magnus(8), AlignedStepwise(8)):
        np.testing.assert_allclose(transition_matrix(system, method), -np.eye(2), atol=1e-11)


def test_nothing_is_left_of_a_motion_that_is_stopped():
    """A growth of minus infinity, without a warning."""
    stopped = replace(ONE, jumps=(StateJump(0.5, np.zeros((2, 2))),))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert growth_rate(stopped) == -np.inf


@dataclass(frozen=True)
class Knocked:
    """All there is, and a jump of the state of a strength that is swept; or a load, or a matrix."""

    strength: float = 0.1
    mass: float = 0.4
    damping: float = 0.1

    def system(self, speed):
        system = rich(3, 2, self.damping).replace_loads(mass=[self.mass, 0.3, 0.0])
        jump = StateJump(0.55, np.eye(4) + self.strength * np.diag([0.0, 0.0, 1.0, -1.0]))
        return replace(system, jumps=(jump,), period=2.0 / speed)


@pytest.mark.parametrize(("parameter", "high"), [("strength", 0.3), ("mass", 0.8), ("damping", 0.4)])
def test_maps_sweep_jumps_and_masses_under_weights(parameter, high):
    values, speeds = np.linspace(0.0, high, 31), np.linspace(0.8, 1.3, 31)
    chart = stability_map(Knocked(), speeds, parameter, values, jobs=1)
    for i, j in ((0, 0), (7, 29), (16, 11), (30, 30), (22, 3)):
        cell = growth_rate(replace(Knocked(), **{parameter: values[i]}).system(speeds[j]))
        assert float(chart[i, j]) == pytest.approx(cell, abs=1e-8)


def test_a_kick_and_a_jump_of_one_instant_come_in_this_order():
    load = ContactLoad(tent(1, 0.4, 0), 1.0, 0.0, 1.0, "total")
    jump = np.array([[2.0, 0.0], [0.0, 3.0]])
    system = PeriodicSystem([[1.0]], [[0.0]], [[1.0]], (load,), 1.0, jumps=(StateJump(0.4, jump),))
    (_, first), (at, both) = system.state_jumps()
    kick = dict(system.velocity_kicks())[at]
    assert at == 0.4
    assert np.abs(first - np.eye(2)).max() > 0.0
    np.testing.assert_allclose(both, jump @ np.array([[1.0, 0.0], [float(kick[0, 0]), 1.0]]))


@settings(deadline=None, max_examples=30)
@given(x=st.floats(-2.0, 2.0), seed=st.integers(0, 100), periods=st.integers(1, 5))
def test_transformed_functions(x, seed, periods):
    function = tent(3, 0.3, seed).shift(0.17)
    matrix = np.random.default_rng(seed).normal(size=(2, 3))
    np.testing.assert_allclose(function.backwards()(x), function(-x), atol=1e-9)
    np.testing.assert_allclose(function.backwards().backwards()(x), function(x), atol=1e-9)
    np.testing.assert_allclose(function.repeated(periods)(x), function(periods * x), atol=1e-9)
    np.testing.assert_allclose(function.transformed(matrix)(x), matrix @ function(x), atol=1e-12)
    longer = function.embedded(6, 2)(x)
    np.testing.assert_allclose(longer, np.concatenate([np.zeros(2), function(x), np.zeros(1)]), atol=1e-15)


def test_a_rigid_motion_is_not_taken_out_where_the_state_jumps():
    system = PeriodicSystem(
        np.eye(2), np.zeros((2, 2)), np.diag([1.0, 0.0]), (), 1.0, jumps=(StateJump(0.5, np.eye(4)),)
    )
    with pytest.raises(ValueError, match="no jumps"):
        without_rigid_motion(system)
    assert without_rigid_motion(replace(system, jumps=())).size == 1


SMOOTH = PiecewiseChebyshev.constant([1.0])
STEP = weight(0.5, 0.0, 1.0)
ONE = PeriodicSystem([[1.0]], [[0.0]], [[1.0]], (), 1.0)


@pytest.mark.parametrize(
    ("build", "error", "message"),
    [
        (
            lambda: ContactLoad(SMOOTH, mass=1.0, weight=weight(0.5, -0.1, 1.0)),
            ValueError,
            "weight must not be negative",
        ),
        (
            lambda: ContactLoad(tent(1, 0.5, 0), mass=1.0, rate="total", weight=STEP),
            ValueError,
            "weight must not jump",
        ),
        (lambda: ContactLoad(SMOOTH, weight=1.0), TypeError, "weight must be a PiecewiseChebyshev"),
        (lambda: ContactLoad(SMOOTH, transmission_error=1.0), TypeError, "transmission_error must be"),
        (
            lambda: ContactLoad(SMOOTH, mass=1.0, transmission_error=STEP),
            ValueError,
            "transmission_error must not jump",
        ),
        (
            lambda: ContactLoad(SMOOTH, mass=1.0, transmission_error=weight(0.5, 0.0, 1.0, kink=True)),
            ValueError,
            "nor its slope",
        ),
        (lambda: StateJump(1.0, np.eye(2)), ValueError, "fraction must be less than 1"),
        (lambda: StateJump(-0.1, np.eye(2)), ValueError, "fraction"),
        (lambda: StateJump(0.5, np.ones((2, 3))), ValueError, "matrix must be square"),
        (
            lambda: replace(ONE, jumps=(StateJump(0.5, np.eye(4)),)),
            ValueError,
            r"jumps\[0\].matrix must have shape",
        ),
        (lambda: replace(ONE, jumps=(np.eye(2),)), TypeError, r"jumps\[0\] must be a StateJump"),
        (lambda: replace(ONE, force=3.0), TypeError, "force must be a PiecewiseChebyshev"),
        (lambda: replace(ONE, force=tent(2, 0.5, 0)), ValueError, "force must have 1 components"),
        (lambda: ONE.repeated(0), ValueError, "periods"),
        (lambda: SMOOTH.embedded(3, 3), ValueError, "first"),
        (lambda: SMOOTH.transformed(np.eye(2)), ValueError, "matrix must have 1 columns"),
    ],
)
def test_bad_input_names_the_parameter(build, error, message):
    with pytest.raises(error, match=message):
        build()
