"""Steady responses against closed forms, an integrator, a long transient, and fitted orders."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from facegear.floquet import collocation
from facegear.floquet.free_modes import UnsuitableSystemError
from facegear.floquet.labels import Resonance, resonance
from facegear.floquet.loads import ContactLoad, StateJump
from facegear.floquet.methods import AdaptiveMagnus, Collocation
from facegear.floquet.modified_models import Excited
from facegear.floquet.multipliers import growth_rate
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.floquet.radau import Radau
from facegear.floquet.response import steady_response
from facegear.mechanics.classical import Mathieu
from tests.floquet.test_loads import rich, tent
from tests.independent.monodromy import integrated

METHODS = (None, Collocation(), Radau(16, 1e-13))
ONE = PiecewiseChebyshev.constant([1.0])
X = np.linspace(0.0, 1.0, 57, endpoint=False)


def wave(*amplitudes):
    """Real part of the sum of c_s e^{2πisx}, s = 0, 1, ..."""
    return PiecewiseChebyshev.fit(
        lambda x, _: sum((c * np.exp(2j * np.pi * s * x)).real for s, c in enumerate(amplitudes)), [0.0]
    )


def oscillator(damping=0.1, stiffness=2.0, force=None, loads=(), period=2.5):
    return PeriodicSystem([[1.0]], [[damping]], [[stiffness]], loads, period, force=force)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("damping", [0.1, 1.0, 9.0])
def test_one_degree_of_freedom_under_harmonic_forces(method, damping):
    if isinstance(method, Collocation) and damping > 3.0:
        pytest.skip("overdamped")
    amplitudes = np.array([0.7, 1.0 - 0.4j, 0.2j, 0.05])
    system = oscillator(damping, force=wave(*amplitudes))
    w = 2.0 * np.pi / system.period * np.arange(4)
    expected = amplitudes / (2.0 - w**2 + 1j * w * damping)
    response = steady_response(system, method)
    turning = np.exp(2j * np.pi * np.outer(X, np.arange(4)))
    assert np.abs(response.displacements(X)[:, 0] - (turning @ expected).real).max() < 1e-12
    assert np.abs(response.velocities(X)[:, 0] - (turning @ (1j * w * expected)).real).max() < 1e-12
    assert np.abs(response.accelerations(X)[:, 0] + (turning @ (w**2 * expected)).real).max() < 1e-11
    found = response.harmonics(3)
    assert np.abs(found[:, 0] - expected).max() < 1e-12
    square = response.mean(lambda x: response.displacements(x)[:, 0] ** 2)
    assert square == pytest.approx(expected[0].real ** 2 + (np.abs(expected[1:]) ** 2).sum() / 2.0, rel=1e-12)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("rate", ["frozen", "total"])
def test_transmission_error_under_spring_damper_and_mass(method, rate):
    """(1 + m) q̈ + (c0 + c) q̇ + (k0 + k) q = m ë + c ė + k e."""
    m, c, k = 0.4, 0.2, 3.0
    error = np.array([0.3, 0.1 + 0.2j, 0.05])
    load = ContactLoad(ONE, k, c, m, rate, transmission_error=wave(*error))
    system = oscillator(loads=(load,))
    w = 2.0 * np.pi / system.period * np.arange(3)
    q = error * (k + 1j * w * c - w**2 * m) / (2.0 + k + 1j * w * (0.1 + c) - w**2 * (1.0 + m))
    turning = np.exp(2j * np.pi * np.outer(X, np.arange(3)))
    response = steady_response(system, method)
    assert np.abs(response.displacements(X)[:, 0] - (turning @ q).real).max() < 1e-12
    assert np.abs(response.contact_displacements(X)[:, 0] - (turning @ (q - error)).real).max() < 1e-12
    force = turning @ ((k + 1j * w * c - w**2 * m) * (q - error))
    # At the ends of a piece the second derivative of a fitted e has fewer digits.
    assert np.abs(response.contact_forces(X)[:, 0] - force.real)[1:].max() < 1e-11


@pytest.mark.parametrize("method", METHODS)
def test_piecewise_constant_stiffness_under_a_constant_force(method):
    """Each part rests about F/k: x = F/k + turned (x0 − F/k); the two matched at both ends."""
    period, share, low, high, force = 3.0, 0.35, 1.0, 4.0, 2.0
    weight = PiecewiseChebyshev(np.array([0.0, share]), np.array([[[1.0]], [[0.0]]]))
    load = ContactLoad(ONE, high - low, weight=weight)
    system = oscillator(0.0, low, PiecewiseChebyshev.constant([force]), (load,), period)

    def turned(k, time):
        w = np.sqrt(k)
        return np.array([[np.cos(w * time), np.sin(w * time) / w], [-w * np.sin(w * time), np.cos(w * time)]])

    first, second = turned(high, share * period), turned(low, (1.0 - share) * period)
    rest = np.array([[force / high, 0.0], [force / low, 0.0]])
    # x(T) = rest2 + second (rest1 + first (x0 − rest1) − rest2) = x0
    right = rest[1] + second @ (rest[0] - first @ rest[0] - rest[1])
    start = np.linalg.solve(np.eye(2) - second @ first, right)
    response = steady_response(system, method)
    for x in (0.0, 0.2, share):
        expected = rest[0] + turned(high, x * period) @ (start - rest[0])
        np.testing.assert_allclose(response.state(x, "left" if x else "right"), expected, atol=1e-12)
    # No damping, and nothing grows: |λ| = 1 is no reason to refuse.
    assert response.is_stable
    assert response.spectral_radius == pytest.approx(1.0, abs=1e-12)


def excited(seed, size=3, damping=0.1):
    system = rich(seed, size, damping)
    error = wave(0.02, 0.1, 0.05j)
    loads = (replace(x, transmission_error=error.shift(0.1 * i)) for i, x in enumerate(system.loads))
    return replace(system, loads=tuple(loads), force=tent(size, 0.33, seed))


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("method", METHODS[1:])
def test_everything_at_once_against_an_integrator(method, seed):
    system = excited(seed)
    whole = integrated(system, forced=True)
    n = 2 * system.size
    start = np.linalg.solve(np.eye(n) - whole[:, :n], whole[:, n])
    response = steady_response(system, method, allow_unstable=True)
    assert (
        np.abs(response.state(0.0, "left") - start).max() < 1e-11 * response.condition * np.abs(start).max()
    )
    # The forces at the contacts are those that the accelerations obey.
    x = np.array([0.111, 0.487, 0.93])
    left = (system.mass @ response.accelerations(x)[..., None])[..., 0]
    left += response.velocities(x) @ system.damping.T + response.displacements(x) @ system.stiffness.T
    forces = response.contact_forces(x)
    pushed = sum(load.shape(x) * forces[:, [i]] for i, load in enumerate(system.loads))
    np.testing.assert_allclose(left, system.force(x) - pushed, atol=1e-10 * np.abs(left).max())


def test_an_overdamped_system_goes_by_radau():
    system = excited(5, damping=60.0)
    whole = integrated(system, forced=True)
    start = np.linalg.solve(np.eye(6) - whole[:, :6], whole[:, 6])
    np.testing.assert_allclose(
        steady_response(system).state(0.0, "left"), start, atol=1e-11 * np.abs(start).max()
    )


def test_a_long_transient_ends_in_the_response():
    model = Excited(Mathieu(depth=0.3, damping_ratio=0.05), force=wave(1.0, 0.5))
    system = model.system(0.7)
    whole = integrated(system, forced=True)
    state, total = np.zeros(2), np.zeros(2)
    for number in range(400):
        state = whole[:, :2] @ state + whole[:, 2]
        if number >= 300:
            total += state / 100.0
    response = steady_response(system)
    assert growth_rate(system) * 300 * system.period < -60.0
    np.testing.assert_allclose(response.state(0.0), total, rtol=1e-11)


@pytest.mark.parametrize(("method", "order"), [(Collocation(3, 14.0), 6), (Radau(3), 5)])
def test_panels_have_the_order_of_their_nodes(monkeypatch, method, order):
    """At the end of the period, from rest: what forces, errors, jumping weights and kicks make."""
    monkeypatch.setattr(collocation, "PANEL_TOLERANCE", np.inf)
    system = excited(2)
    exact = integrated(system, forced=True)[:, -1]
    counts, errors = np.array([8, 16, 32, 64]), []
    for count in counts.tolist():
        panels = method.motion_panels(system, (np.arange(1, count) / count).tolist())
        jumps = dict(system.state_jumps())
        state = np.zeros(6)
        for start, step, offset in zip(panels.edges, panels.steps, panels.offsets, strict=False):
            state = step @ (jumps.get(start, np.eye(6)) @ state) + offset
        errors.append(np.abs(state - exact).max())
    assert -np.polyfit(np.log(counts), np.log(errors), 1)[0] == pytest.approx(order, abs=0.4)


@settings(deadline=None, max_examples=10)
@given(seed=st.integers(0, 10**6), phase=st.floats(-1.0, 1.0), factor=st.floats(-3.0, 3.0))
def test_linear_in_the_excitation_and_free_in_the_origin_of_time(seed, phase, factor):
    system = replace(excited(seed, 2), jumps=())
    response = steady_response(system, allow_unstable=True)
    size = np.abs(response.state(X)).max()
    moved = steady_response(system.shift(phase), allow_unstable=True)
    near = np.abs((X[:, None] + phase - system.breakpoints + 0.5) % 1.0 - 0.5).min(axis=1) < 1e-6
    bound = 1e-10 * response.condition * size
    assert np.abs(moved.state(X) - response.state(X + phase))[~near].max() < bound
    loads = tuple(
        replace(x, transmission_error=x.transmission_error.transformed([[factor]])) for x in system.loads
    )
    more = replace(system, loads=loads, force=system.force.transformed(factor * np.eye(2)))
    scaled = steady_response(more, allow_unstable=True)
    assert np.abs(scaled.state(X) - factor * response.state(X)).max() < bound
    twice = steady_response(system.repeated(2), allow_unstable=True)
    assert np.abs(twice.state(X / 2.0) - response.state(X))[X > 1e-6].max() < 10.0 * bound * twice.condition


def test_what_stands_still():
    assert np.abs(steady_response(oscillator()).state(X)).max() == 0.0


def test_an_unstable_system_is_refused_unless_asked_for():
    system = Excited(Mathieu(depth=0.8, damping_ratio=0.01), force=wave(1.0)).system(2.0)
    with pytest.raises(ValueError, match=r"stable for a steady response, got max\|λ\| = 1\."):
        steady_response(system)
    response = steady_response(system, allow_unstable=True)
    assert not response.is_stable
    whole = integrated(system, forced=True)
    np.testing.assert_allclose(
        whole[:, :2] @ response.state(0.0) + whole[:, 2], response.state(0.0), atol=1e-10
    )


def test_no_response_where_a_multiplier_is_one():
    resonant = oscillator(0.0, 1.0, wave(0.0, 1.0), period=2.0 * np.pi)
    drifting = oscillator(0.0, 0.0, wave(0.0, 1.0))
    for system in (resonant, drifting):
        with pytest.raises(ArithmeticError, match="close to 1"):
            steady_response(system)
    # Beside it the condition tells what is lost.
    near = steady_response(oscillator(1e-5, 1.0, wave(0.0, 1.0), period=2.0 * np.pi))
    assert 1e4 < near.condition < 1e7
    assert abs(near.harmonics(1)[1, 0]) == pytest.approx(1e5, rel=1e-15 * near.condition)


def test_methods_that_know_the_end_only_are_refused():
    with pytest.raises(ValueError, match="Collocation or Radau"):
        steady_response(oscillator(force=wave(1.0)), AdaptiveMagnus())


def test_jumps_turn_the_response_too():
    """Half the velocity is lost once in a period: a pendulum clock under a constant force."""
    lost = StateJump(0.4, np.diag([1.0, 0.5]))
    system = replace(oscillator(0.0, force=wave(1.0, 0.3)), jumps=(lost,))
    for method in METHODS[1:]:
        response = steady_response(system, method)
        before, after = response.state(0.4, "left"), response.state(0.4)
        np.testing.assert_allclose(after, lost.matrix @ before, atol=1e-13)
        whole = integrated(system, forced=True)
        np.testing.assert_allclose(
            whole[:, :2] @ response.state(0.0) + whole[:, 2], response.state(0.0), atol=1e-11
        )


@pytest.mark.parametrize(
    ("speed", "expected"), [(1.0, Resonance(1, 1)), (0.5, Resonance(1, 2)), (1.0 / 3, Resonance(1, 3))]
)
def test_resonances_are_named(speed, expected):
    """Frequency 1, driven by all harmonics of a tent."""
    model = Excited(Mathieu(depth=0.05, damping_ratio=0.02), force=tent(1, 0.3, 1))
    assert resonance(steady_response(model.system(speed))) == expected
    assert expected.label == f"1/{expected.order}"


def test_two_modes_are_told_apart():
    system = PeriodicSystem(
        np.eye(2), 0.02 * np.eye(2), np.diag([1.0, 9.0]), (), 2.0 * np.pi, force=tent(2, 0.3, 0)
    )
    assert resonance(steady_response(replace(system, period=2.0 * np.pi / 3.0))) == Resonance(2, 1)
    assert resonance(steady_response(replace(system, stiffness=np.diag([1.0, 30.0])))) == Resonance(1, 1)


def test_harmonics_of_any_order_are_those_of_the_motion():
    """A cosine has one, whatever is asked for: no other comes back as its alias."""
    found = steady_response(oscillator(force=wave(0.0, 1.0))).harmonics(400)
    assert np.abs(found[2:]).max() < 1e-12 * np.abs(found[1]).max()
    # Against an independent quadrature, under a force that jumps.
    saw = PiecewiseChebyshev.fit(lambda x, _: x - 0.5, [0.0])
    response = steady_response(oscillator(force=saw))
    x = (np.arange(2**15) + 0.5) / 2**15
    q = response.displacements(x)[:, 0]
    for s in (0, 7, 60):
        expected = (1.0 if s == 0 else 2.0) * (q * np.exp(-2j * np.pi * s * x)).mean()
        assert response.harmonics(60)[s, 0] == pytest.approx(expected, abs=1e-10)


def test_harmonics_of_many_periods_are_those_of_one():
    """Panels of seven periods have the lengths of those of one, but for rounding."""
    saw = PiecewiseChebyshev.fit(lambda x, _: x - 0.5, [0.3])
    system = oscillator(force=saw)
    one, seven = (steady_response(system.repeated(number)).harmonics(7 * 12) for number in (1, 7))
    np.testing.assert_allclose(seven[::7], one[:13], rtol=0.0, atol=1e-13 * np.abs(one).max())
    between = np.arange(7 * 12 + 1) % 7 > 0
    assert np.abs(seven[between]).max() < 1e-12 * np.abs(one).max()


def test_statistics_of_a_load_too_weak_to_move_the_system():
    """Its transmission error is resolved although the state does not feel it."""
    error = PiecewiseChebyshev.fit(
        lambda x, _: np.cos(126 * np.pi * x) + np.cos(130 * np.pi * x), [0.0], max_degree=512
    )
    load = ContactLoad(ONE, 1e-10, transmission_error=error)
    response = steady_response(oscillator(loads=(load,), force=wave(0.3)))
    square = response.mean(lambda x: (response.contact_displacements(x)[:, 0] - 0.15) ** 2)
    assert square == pytest.approx(1.0, rel=1e-8)
    lowest, highest = response.extremes(response.contact_displacements)
    np.testing.assert_allclose([*lowest, *highest], [0.15 - 2.0, 0.15 + 2.0], atol=1e-4)


@pytest.mark.parametrize("below", [1e-3, 1e-6, 1e-9])
def test_just_below_critical_damping(below):
    """Free modes are nearly one: whatever is chosen loses no digits, and at rest is at rest."""
    system = oscillator(2.0 - below, 1.0, force=wave(1.0), period=2.0)
    assert np.abs(steady_response(system).displacements([0.0, 0.3]) - 1.0).max() < 1e-11
    with pytest.raises(UnsuitableSystemError, match="close to dependent"):
        steady_response(oscillator(2.0 - 1e-6, 1.0, force=wave(1.0), period=2.0), Collocation())


@settings(deadline=None, max_examples=20)
@given(phase=st.floats(0.0, 1.0), part=st.floats(-0.5, 0.5))
def test_extremes_between_the_instants(phase, part):
    """A weak load has u = −e, a cosine and a part of the next one, highest at its top."""
    error = wave(0.0, 1.0, part).shift(phase)
    response = steady_response(oscillator(loads=(ContactLoad(ONE, 1e-12, transmission_error=error),)))
    x = np.linspace(0.0, 1.0, 200_001)
    exact = -(np.cos(2.0 * np.pi * x) + part * np.cos(4.0 * np.pi * x))
    lowest, highest = response.extremes(response.contact_displacements)
    np.testing.assert_allclose([*lowest, *highest], [exact.min(), exact.max()], atol=1e-6)


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (lambda r: r.harmonics(-1), ValueError, "order must be at least 0"),
        (lambda r: r.harmonics("a"), TypeError, "order must be an integer"),
        (lambda r: r.harmonics(2.5), TypeError, "order must be an integer"),
        (lambda r: r.mean(3.0), TypeError, "function must be a function of fractions"),
        (lambda r: r.mean(lambda x: 1.0), ValueError, r"function must return shape \("),
        (lambda r: r.displacements("a"), TypeError, "fraction must be real"),
        (lambda r: r.accelerations("a"), TypeError, "fraction must be real"),
        (lambda r: r.contact_forces("a"), TypeError, "fraction must be real"),
        (
            lambda r: steady_response(r.system, allow_unstable="no"),
            TypeError,
            "allow_unstable must be True or",
        ),
        (lambda r: steady_response(Mathieu(depth=0.1)), TypeError, "system must be a PeriodicSystem"),
    ],
)
def test_bad_input_names_the_parameter(call, error, message):
    response = steady_response(oscillator(force=wave(1.0)))
    with pytest.raises(error, match=message):
        call(response)
