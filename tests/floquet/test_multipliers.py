"""Floquet methods against closed forms, independent eigenproblems and integrators, and one another."""

from itertools import pairwise

import numpy as np
import pytest
import scipy.linalg
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from facegear.floquet import stepping
from facegear.floquet.error_estimates import error_estimate
from facegear.floquet.loads import ContactLoad
from facegear.floquet.methods import (
    FIRST,
    GENERAL,
    AdaptiveMagnus,
    AlignedStepwise,
    Collocation,
    Magnus,
    Stepwise,
    with_method,
)
from facegear.floquet.multipliers import growth_rate, multipliers, transition_matrices, transition_matrix
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.floquet.radau import Radau
from facegear.floquet.stepping import exponentials, gauss_magnus
from facegear.mechanics.cases import FIGURES

ONE = PiecewiseChebyshev.constant([1.0])
COSINE = PiecewiseChebyshev.fit(lambda x, _: np.cos(2.0 * np.pi * x), [0.0])
ACCURATE = (AdaptiveMagnus(), Collocation())


def mathieu(a, q):
    """q̈ + (a - 2 q cos 2t) q = 0, period π."""
    load = ContactLoad(
        ONE, stiffness=2.0 * q, weight=PiecewiseChebyshev(COSINE.breakpoints, -COSINE.coefficients)
    )
    return PeriodicSystem([[1.0]], [[0.0]], [[a]], (load,), np.pi)


def meissner(stiffness, change, duty, damping=0.0, period=1.0):
    """Stiffness + change on the first part of the period, stiffness - change on the rest."""
    wave = PiecewiseChebyshev(np.array([0.0, duty]), np.array([[[1.0]], [[-1.0]]]))
    load = ContactLoad(ONE, stiffness=change, weight=wave)
    return PeriodicSystem([[1.0]], [[damping]], [[stiffness]], (load,), period)


def meissner_closed_form(stiffness, change, duty, period=1.0):
    """Product of the two rotations (undamped)."""

    def part(square, time):
        w = np.sqrt(square)
        c, s = np.cos(w * time), np.sin(w * time)
        return np.array([[c, s / w], [-w * s, c]])

    return part(stiffness - change, (1.0 - duty) * period) @ part(stiffness + change, duty * period)


@pytest.mark.parametrize("method", [AlignedStepwise(2), Magnus(2), *ACCURATE], ids=repr)
@pytest.mark.parametrize("parameters", [(4.0, 1.0, 0.5), (40.0, 25.0, 0.563), (9.0, 0.5, 0.3)])
def test_meissner_closed_form(method, parameters):
    expected = meissner_closed_form(*parameters)
    got = transition_matrix(meissner(*parameters), method)
    assert np.abs(got - expected).max() <= 1e-12 * np.abs(expected).max()


def characteristic_values(q, harmonics, border):
    """Mathieu a(q) from symmetric tridiagonal eigenproblems (even or odd, period π or 2π)."""
    size = 60
    if border.startswith("period_pi"):
        index = 2.0 * np.arange(size) + (2.0 if border.endswith("odd") else 0.0)
        coupling = np.full(size - 1, q)
        diagonal = index**2
        if border.endswith("even"):
            coupling[0] *= np.sqrt(2.0)
    else:
        index = 2.0 * np.arange(size) + 1.0
        coupling = np.full(size - 1, q)
        diagonal = index**2
        diagonal[0] += q if border.endswith("even") else -q
    return scipy.linalg.eigh_tridiagonal(diagonal, coupling, eigvals_only=True)[:harmonics]


BORDERS = ("period_pi_even", "period_pi_odd", "period_2pi_even", "period_2pi_odd")


@pytest.mark.parametrize("border", BORDERS)
@pytest.mark.parametrize("q", [0.9, 1.7, 4.0])
def test_mathieu_transition_curves(border, q):
    """On a transition curve a double multiplier +1 (period π) or -1 (period 2π): trace Φ = ±2."""
    sign = 1.0 if border.startswith("period_pi") else -1.0
    everything = np.concatenate([characteristic_values(q, 3, each) for each in BORDERS])
    for a in characteristic_values(q, 2 if q > 1.0 else 1, border):
        others = np.abs(everything - a)
        width = 0.4 * others[others > 1e-9].min()
        for method in (AdaptiveMagnus(1e-12), Collocation(24)):
            if a - width <= 0.0 and isinstance(method, Collocation):
                continue  # no free oscillation: the general route's business

            def offset(value, method=method):
                return np.trace(transition_matrix(mathieu(value, q), method)) - 2.0 * sign

            found = brentq(offset, a - width, a + width, xtol=1e-13, rtol=1e-14)
            assert found == pytest.approx(a, abs=1e-10)


def test_two_mode_combination_resonance():
    """Two damped oscillators coupled by ε cos Ωt: sum resonance at ω₁+ω₂ with the averaged growth rate.

    With entries e cos Ωt averaging gives growth e/(4√(ω₁ω₂)) - c/2 at exact tuning, error of higher order.
    """
    w = np.array([1.0, 1.9])
    damping = 2e-3

    def system(epsilon):
        # cos Ωt (q₁ q₂ coupling) as the difference of two rank-one loads.
        plus = ContactLoad(PiecewiseChebyshev.constant([1.0, 1.0]), epsilon / 4.0, weight=COSINE)
        minus = ContactLoad(
            PiecewiseChebyshev.constant([1.0, -1.0]),
            epsilon / 4.0,
            weight=PiecewiseChebyshev(COSINE.breakpoints, -COSINE.coefficients),
        )
        # Their difference has the off-diagonal entries ε/2.
        return PeriodicSystem(
            np.eye(2), damping * np.eye(2), np.diag(w**2), (plus, minus), 2.0 * np.pi / w.sum()
        )

    def error(epsilon):
        predicted = (epsilon / 2.0) / (4.0 * np.sqrt(w.prod())) - damping / 2.0
        return abs(growth_rate(system(epsilon)) - predicted)

    assert growth_rate(system(0.02)) > 0.0 > growth_rate(system(0.01))
    assert error(0.08) < 1e-4 * 0.08
    assert error(0.04) < error(0.08) / 3.0


def random_system(seed, size, loads, unstable=False, rates=("frozen", "total")):
    """Build a random system with kinks, jumps, moving masses, gyroscopic and circulatory terms."""
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(size, size)) / np.sqrt(size)
    mass = np.eye(size) + 0.3 * root @ root.T
    frequencies = rng.uniform(1.0, 6.0, size)
    basis = np.linalg.qr(rng.normal(size=(size, size)))[0]
    stiffness = basis @ np.diag(frequencies**2) @ basis.T
    gyroscopic = rng.normal(size=(size, size)) * 0.2
    damping = rng.uniform(0.0, 0.05) * stiffness / 6.0 + gyroscopic - gyroscopic.T
    circulatory = rng.normal(size=(size, size)) * 0.05
    stiffness = stiffness + circulatory - circulatory.T
    built = []
    for _ in range(loads):
        kinks = np.sort(rng.choice(np.arange(1, 20) / 20.0, 2, replace=False)) - 0.05 * rng.random()
        amplitude, phase = rng.normal(size=(2, size, 3))
        jump = rng.normal(size=size) * rng.integers(0, 2)
        slope = rng.normal(size=size)

        def function(x, piece, amplitude=amplitude, phase=phase, jump=jump, slope=slope, kinks=kinks):
            waves = sum(amplitude[:, d] * np.cos(2 * np.pi * d * x[:, None] + phase[:, d]) for d in range(3))
            tent = np.interp(x, [kinks[0], kinks[1], kinks[0] + 1.0], [0.0, 1.0, 0.0])[:, None] * slope
            return 0.4 * (waves + tent + (jump if piece else 0.0))

        shape = PiecewiseChebyshev.fit(function, kinks)
        rate = rates[rng.integers(0, len(rates))]
        mass_allowed = rate == "frozen" or not jump.any()
        built.append(
            ContactLoad(
                shape,
                stiffness=rng.uniform(0.0, 12.0 if unstable else 2.0),
                damping=rng.uniform(0.0, 0.2),
                mass=rng.uniform(0.0, 1.0) if mass_allowed else 0.0,
                rate=rate,
            )
        )
    return PeriodicSystem(mass, damping, stiffness, built, rng.uniform(0.5, 4.0))


def integrated(system, momentum=False):
    """Φ by DOP853 from breakpoint to breakpoint, with matrices assembled here from the shape vectors.

    With `momentum` the state is (q, p), p = M q̇ + Σ φ m u̇, which stays continuous where φ̇ jumps.
    """
    n, period = system.size, system.period

    def parts(x, side):
        for load in system.loads:
            phi = load.shape(x, side)
            slope = load.shape.derivative()(x, side) / period if load.rate == "total" else 0.0 * phi
            yield load, phi, slope

    def total_mass(x, side):
        return system.mass + sum((ld.mass * np.outer(p, p) for ld, p, _ in parts(x, side)), np.zeros((n, n)))

    def velocity(x, q, p, side):
        drag = sum((ld.mass * np.outer(phi, slope) for ld, phi, slope in parts(x, side)), np.zeros((n, n)))
        return np.linalg.solve(total_mass(x, side), p - drag @ q)

    def rhs(t, y):
        x = t / period
        q, second = y.reshape(2, n, 2 * n)
        v = velocity(x, q, second, "right") if momentum else second
        force = -system.damping @ v - system.stiffness @ q
        for load, phi, slope in parts(x, "right"):
            u, rate = phi @ q, phi @ v + slope @ q
            force = force - np.outer(phi, load.damping * rate + load.stiffness * u)
            if momentum:
                force = force + np.outer(slope, load.mass * rate)
        change = force if momentum else np.linalg.solve(total_mass(x, "right"), force)
        return np.concatenate([v, change]).ravel()

    start = np.eye(2 * n)
    if momentum:
        drag = sum(
            (ld.mass * np.outer(phi, slope) for ld, phi, slope in parts(0.0, "left")), np.zeros((n, n))
        )
        start[n:] = total_mass(0.0, "left") @ start[n:] + drag @ start[:n]
    y = start.ravel()
    edges = np.append(system.breakpoints, 1.0) * period
    for a, b in pairwise(edges):
        # Just inside, so that the last stage does not see the piece beyond.
        inset = 1e-11 * period
        y = solve_ivp(rhs, (a, b - inset), y, method="DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
        y = y + inset * rhs(b - 2 * inset, y)
    q, second = y.reshape(2, n, 2 * n)
    return np.concatenate([q, velocity(1.0, q, second, "left") if momentum else second])


@pytest.mark.parametrize("seed", range(4))
def test_frozen_rate_against_an_integrator(seed):
    system = random_system(seed, 2 + seed % 2, 1 + seed % 3, rates=("frozen",))
    expected = integrated(system)
    for method in ACCURATE:
        assert np.abs(transition_matrix(system, method) - expected).max() < 1e-9 * max(
            np.abs(expected).max(), 1.0
        )


@pytest.mark.parametrize("seed", [0, 1, *(pytest.param(seed, marks=pytest.mark.slow) for seed in (2, 3))])
def test_total_rate_and_kicks_against_the_momentum_form(seed):
    numbers = np.random.default_rng(100 + seed).normal(size=(2, 3))

    def function(x, piece):
        tent = np.interp(x, [0.0, 0.4, 1.0], [0.0, 1.0, 0.0])[:, None]
        return numbers[0] * np.cos(2 * np.pi * x)[:, None] + numbers[1] * tent

    shape = PiecewiseChebyshev.fit(function, [0.0, 0.4])
    loads = (
        ContactLoad(shape, 3.0, 0.3, 0.8, "total"),
        ContactLoad(shape.shift(0.27 * (seed % 2)), 1.0, 0.2, 0.5, "total"),
    )
    base = random_system(seed, 3, 0)
    system = PeriodicSystem(base.mass, base.damping, base.stiffness, loads, 1.3)
    expected = integrated(system, momentum=True)
    for method in ACCURATE:
        assert np.abs(transition_matrix(system, method) - expected).max() < 1e-9 * np.abs(expected).max()
    # Without its kicks the same system is another one.
    assert np.abs(integrated(system) - expected).max() > 1e-2


@pytest.mark.parametrize("method", ACCURATE, ids=repr)
@pytest.mark.parametrize("seed", range(3))
def test_liouville(method, seed):
    """Det Φ = exp ∫ tr A dt; tr A by Gauss quadrature between the breakpoints."""
    system = random_system(seed, 3, 2, rates=("frozen",))
    x, w = np.polynomial.legendre.leggauss(50)
    edges = np.append(system.breakpoints, 1.0)
    integral = 0.0
    for a, b in pairwise(edges):
        state = system.state_matrix((a + b) / 2 + (b - a) / 2 * x)
        integral += (b - a) / 2 * (w @ np.trace(state, axis1=1, axis2=2))
    expected = np.exp(system.period * integral)
    assert np.linalg.det(transition_matrix(system, method)) == pytest.approx(expected, rel=1e-10)


def undamped(seed, size=3):
    base = random_system(seed, size, 2, unstable=True, rates=("frozen",))
    symmetric = (base.stiffness + base.stiffness.T) / 2.0
    loads = base.replace_loads(damping=0.0, mass=0.0).loads
    return PeriodicSystem(base.mass, np.zeros((size, size)), symmetric, loads, base.period)


@pytest.mark.parametrize("method", [Magnus(64), *ACCURATE], ids=repr)
@pytest.mark.parametrize("seed", range(3))
def test_reciprocal_multipliers_without_damping(method, seed):
    alpha = multipliers(undamped(seed), method)
    distance = np.abs(1.0 / alpha[:, None] - alpha[None, :])
    assert distance.min(axis=1).max() < 1e-8 * np.abs(alpha[0])


@pytest.mark.parametrize("method", ACCURATE, ids=repr)
@pytest.mark.parametrize("seed", range(3))
def test_time_reversal_without_damping(method, seed):
    """Running φ(-t) with the velocities turned round undoes a period."""
    system = undamped(seed)
    loads = []
    for load in system.loads:
        edges = load.shape.breakpoints
        ends = np.append(edges[1:], edges[0] + 1.0)
        signs = ((-1.0) ** np.arange(load.shape.degree + 1))[:, None]
        starts = np.mod(1.0 - ends, 1.0)
        order = np.argsort(starts)
        mirrored = PiecewiseChebyshev(starts[order], (load.shape.coefficients * signs)[order])
        loads.append(ContactLoad(mirrored, load.stiffness))
    reversed_ = PeriodicSystem(system.mass, system.damping, system.stiffness, loads, system.period)
    turn = np.diag([1.0] * 3 + [-1.0] * 3)
    there, back = transition_matrix(system, method), transition_matrix(reversed_, method)
    scale = np.abs(there).max() * np.abs(back).max()
    assert np.abs(turn @ back @ turn @ there - np.eye(6)).max() < 1e-9 * scale


@given(phase=st.floats(0.0, 1.0), seed=st.integers(0, 20))
@settings(max_examples=15)
def test_multipliers_do_not_depend_on_the_origin_of_time(phase, seed):
    system = random_system(seed, 2, 2)
    for method in ACCURATE:
        one, other = multipliers(system, method), multipliers(system.shift(phase), method)
        tolerance = 1e-8 * max(1.0, np.abs(one[0]))
        # Where two multipliers nearly coincide they respond to rounding by its square root; sums do not.
        powers = np.arange(1, 3)[:, None]
        assert np.abs((one**powers).sum(1) - (other**powers).sum(1)).max() < tolerance * np.abs(one[0])


def observed_order(method, counts, system):
    exact = transition_matrix(system, Collocation(28, 3.0))
    errors = [np.abs(transition_matrix(system, method(q)) - exact).max() for q in counts]
    return -np.polyfit(np.log(counts), np.log(errors), 1)[0]


def smooth_system():
    shape = PiecewiseChebyshev.fit(
        lambda x, _: np.stack([np.cos(2 * np.pi * x), 1.0 + 0.5 * np.sin(2 * np.pi * x)], 1), [0.0]
    )
    loads = (ContactLoad(shape, 20.0, 0.1, 0.3),)
    return PeriodicSystem(np.eye(2), 0.02 * np.eye(2), np.diag([9.0, 25.0]), loads, 1.0)


def jumping_system(duty=0.563):
    """Build a load that is lost at 0.563 of the period, as a tooth pair that leaves mesh."""

    def function(x, piece):
        values = np.stack([1.0 - 0.5 * x, 0.6 + x], 1)
        return values if piece == 0 else 0.2 * values

    shape = PiecewiseChebyshev.fit(function, [0.0, duty])
    loads = (ContactLoad(shape, 30.0, 0.1, 0.0, "total"),)
    return PeriodicSystem(np.eye(2), 0.02 * np.eye(2), np.diag([9.0, 25.0]), loads, 1.0)


@pytest.mark.parametrize("build", [smooth_system, jumping_system])
def test_orders_of_convergence_of_aligned_methods(build):
    counts = [64, 128, 256, 512]
    assert observed_order(AlignedStepwise, counts, build()) == pytest.approx(2.0, abs=0.1)
    assert observed_order(Magnus, counts[:3], build()) == pytest.approx(4.0, abs=0.2)


def test_uniform_rule_is_second_order_only_where_nothing_jumps():
    counts = [64, 128, 256, 512]
    assert observed_order(Stepwise, counts, smooth_system()) == pytest.approx(2.0, abs=0.1)
    erratic = [100, 170, 290, 490, 830, 1400]
    assert observed_order(Stepwise, erratic, jumping_system()) < 1.6


def test_uniform_rule_looks_converged_and_is_not():
    """At 0.563, close to 9/16, Q = 16·2^k errs by the misplaced jump, whatever k, until Q resolves 0.0005."""
    system = jumping_system()
    exact = np.abs(multipliers(system)[0])
    radii = np.array([np.abs(multipliers(system, Stepwise(q))[0]) for q in (128, 256, 512)])
    steps, errors = np.abs(np.diff(radii)), np.abs(radii - exact)
    assert (steps < 0.05 * errors[1:]).all()
    # The estimate of this module is not taken in, and the aligned rule is right with far fewer.
    assert error_estimate(system, Stepwise(256)) >= 0.5 * errors[1]
    aligned = np.abs(multipliers(system, AlignedStepwise(512))[0])
    assert abs(aligned - exact) < 0.1 * errors[-1]


METHODS = (Stepwise(96), AlignedStepwise(64), Magnus(24), AdaptiveMagnus(1e-7), Collocation(9))


def methods_agree_within_their_error_estimates(seed, size, loads, unstable):
    system = random_system(seed, size, loads, unstable)
    truth = np.abs(multipliers(system, Collocation(24, 5.0))[0])
    independent = np.abs(multipliers(system, AdaptiveMagnus(1e-11))[0])
    scale = max(1.0, truth)
    assert abs(truth - independent) < 1e-9 * scale
    for method in METHODS:
        if isinstance(method, Stepwise) and system.impulses():
            continue
        error = abs(np.abs(multipliers(system, method)[0]) - truth)
        assert error <= 2.0 * error_estimate(system, method) + 1e-10 * scale, method


SYSTEMS = {
    "seed": st.integers(0, 10_000),
    "size": st.integers(1, 6),
    "loads": st.integers(1, 3),
    "unstable": st.booleans(),
}


@given(**SYSTEMS)
@settings(max_examples=6)
def test_methods_agree_within_their_error_estimates(seed, size, loads, unstable):
    methods_agree_within_their_error_estimates(seed, size, loads, unstable)


@pytest.mark.slow
@given(**SYSTEMS)
@settings(max_examples=40)
def test_methods_agree_within_their_error_estimates_for_many_systems(seed, size, loads, unstable):
    methods_agree_within_their_error_estimates(seed, size, loads, unstable)


@pytest.mark.slow
def test_error_estimates_are_neither_blind_nor_wild():
    """Estimate over true error of the dominant multiplier, for many systems: between 1/3 and 30, mostly near 1."""
    ratios = []
    for seed in range(30):
        system = random_system(seed, 1 + seed % 6, 1 + seed % 3, unstable=bool(seed % 2))
        truth = multipliers(system, Collocation(24, 5.0))
        for method in (AlignedStepwise(64), Magnus(24)):
            error = np.abs(multipliers(system, method)[0] - truth).min()
            if error > 1e-10:
                ratios.append(error_estimate(system, method) / error)
    ratios = np.array(ratios)
    assert ratios.size > 30
    assert ratios.min() > 1.0 / 3.0
    assert ratios.max() < 30.0
    assert 0.7 < np.median(ratios) < 2.0


@given(seed=st.integers(0, 1000), size=st.integers(1, 14), norm=st.floats(1e-8, 60.0))
def test_batched_exponentials_against_scipy_one_by_one(seed, size, norm):
    rng = np.random.default_rng(seed)
    stack = rng.normal(size=(3, size, size))
    stack -= stack.swapaxes(-1, -2) * rng.uniform(0.0, 1.0)
    stack *= norm / np.abs(stack).sum(axis=-2).max()
    stack[1] *= 1e-3
    expected = np.stack([scipy.linalg.expm(matrix) for matrix in stack])
    for got, exact in zip(exponentials(stack), expected, strict=True):
        assert np.abs(got - exact).max() <= 1e-12 * max(1.0, norm) * max(np.abs(exact).max(), 1.0)


@pytest.mark.parametrize("size", [2, 6, 8, 12])
@pytest.mark.parametrize("count", [32, 45])
def test_compiled_steps_are_those_of_numpy(size, count, monkeypatch):
    """Stiff and slow ones beside each other, in full groups and in one that is not full."""
    rng = np.random.default_rng(size)
    sizes = np.geomspace(1e-3, 40.0, count)[:, None, None] / size
    ends = [sizes * rng.normal(size=(count, size, size)) for _ in range(2)]
    found, start, length = [], np.zeros(count), np.full(count, 0.7)
    for compiled in (stepping._compiled(), None):
        monkeypatch.setattr(stepping, "_compiled", lambda compiled=compiled: compiled)
        first, second = (
            exponentials(ends[0]),
            gauss_magnus(start, length, lambda x: ends[int(x[0] > 0.35)][None]),
        )
        found.append((first, second[0]))
    for own, other in zip(*found, strict=True):
        scale = np.maximum(np.abs(other).max(axis=(1, 2)), 1.0)
        assert (np.abs(own - other).max(axis=(1, 2)) <= 1e-11 * scale).all()


def test_the_error_is_estimated_for_the_default_method():
    system = mathieu(1.0, 0.1)
    assert 0.0 < error_estimate(system) == pytest.approx(error_estimate(system, Collocation()), rel=1e-6)


def test_default_method_depends_on_the_free_motion():
    def used(system):
        return with_method(None, lambda method: (method, multipliers(system, method))[0])

    assert used(mathieu(1.0, 0.1)) == FIRST
    assert used(mathieu(0.0, 0.1)) == GENERAL
    overdamped = PeriodicSystem([[1.0]], [[10.0]], [[1.0]], (ContactLoad(ONE, 1.0),), 1.0)
    assert used(overdamped) == GENERAL
    exact = np.exp(np.roots([1.0, 10.0, 2.0]).max())
    assert np.abs(multipliers(overdamped)[0]) == pytest.approx(exact, rel=1e-9)


def test_growth_rate_is_per_second():
    system = PeriodicSystem([[2.0]], [[-0.4]], [[8.0]], (), 0.5)
    assert growth_rate(system) == pytest.approx(0.1, rel=1e-10)
    assert growth_rate(system, Stepwise(3)) == pytest.approx(0.1, rel=1e-10)


def test_families_equal_single_systems():
    systems = [random_system(4, 3, 2).replace_loads(stiffness=k) for k in (0.0, 1.0, 5.0)]
    together = transition_matrices(systems)
    for system, matrix in zip(systems, together, strict=True):
        single = transition_matrix(system, Collocation(24))
        assert np.abs(matrix - single).max() < 1e-8 * np.abs(single).max()


@pytest.mark.parametrize(
    ("build", "error", "message"),
    [
        (lambda: Stepwise(0), ValueError, "sub_intervals"),
        (lambda: Magnus(2.5), TypeError, "sub_intervals"),
        (lambda: AlignedStepwise(-3), ValueError, "sub_intervals"),
        (lambda: AdaptiveMagnus(0.0), ValueError, "tolerance"),
        (lambda: Collocation(nodes=1), ValueError, "nodes"),
        (lambda: Collocation(panel_angle=50.0), ValueError, "panel_angle"),
        (lambda: transition_matrices([]), ValueError, "systems"),
        (
            lambda: transition_matrices([mathieu(1.0, 0.1), meissner(1.0, 0.1, 0.5)]),
            ValueError,
            "breakpoints",
        ),
    ],
)
def test_bad_input_names_the_parameter(build, error, message):
    with pytest.raises(error, match=message):
        build()


def test_equal_sub_intervals_refuse_kicks():
    shape = PiecewiseChebyshev.fit(lambda x, p: np.interp(x, [0.0, 0.4, 1.0], [0.0, 1.0, 0.0]), [0.0, 0.4])
    system = PeriodicSystem([[1.0]], [[0.0]], [[1.0]], (ContactLoad(shape, mass=1.0, rate="total"),), 1.0)
    with pytest.raises(ValueError, match="velocity kicks"):
        multipliers(system, Stepwise(10))


def test_growth_beyond_double_precision_is_an_error():
    system = PeriodicSystem([[1.0]], [[-3000.0]], [[1.0]], (), 1.0)
    with pytest.raises(ArithmeticError, match="not finite"):
        multipliers(system, Magnus(4))


def test_a_model_is_no_system():
    model = FIGURES["4.4a"].model()
    for ask in (multipliers, growth_rate, transition_matrix, error_estimate):
        with pytest.raises(
            TypeError, match=r"system must be a PeriodicSystem, got a Transverse; .*model\.system"
        ):
            ask(model)


@pytest.mark.parametrize("stiffness", [1e18, 1e40, 1e300])
@pytest.mark.parametrize("method", [None, AdaptiveMagnus(), Radau()])
def test_a_motion_too_fast_to_follow_is_refused_before_anything_is_computed(stiffness, method):
    """In the constant part or in a load; not a growth of 0, nor all memory there is."""
    load = ContactLoad(PiecewiseChebyshev.constant([1.0]), stiffness)
    for system in (
        PeriodicSystem([[1.0]], [[0.1]], [[stiffness]], (), 2.0),
        PeriodicSystem([[1.0]], [[0.1]], [[1.0]], (load,), 2.0),
    ):
        with pytest.raises(ArithmeticError, match="too long for the fastest motion: it takes"):
            growth_rate(system, method)
