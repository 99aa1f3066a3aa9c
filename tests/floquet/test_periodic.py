"""Shape vectors on smooth pieces, loads, assembled matrices and their Fourier series."""

import time

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.polynomial import Polynomial

from facegear.floquet.fourier import fourier_series
from facegear.floquet.loads import ContactLoad, StateJump
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev, merge_breakpoints

KINKS = np.array([0.1, 0.55, 0.7])
ONE = PiecewiseChebyshev.constant([1.0])


def on_piece(x, piece):
    return np.stack([np.sin(3.0 * x + piece), np.exp(x)], axis=1)


@pytest.fixture(scope="module")
def function():
    return PiecewiseChebyshev.fit(on_piece, KINKS)


def unwrapped(x):
    """Fraction and piece as the fitted function sees them."""
    x = np.mod(x, 1.0)
    x = np.where(x < KINKS[0], x + 1.0, x)
    return x, np.searchsorted(KINKS, x, side="right") - 1


def test_fit_reproduces_function_everywhere(function):
    x = np.random.default_rng(1).uniform(-2.0, 3.0, 400)
    fraction, piece = unwrapped(x)
    exact = np.array([on_piece(np.array([f]), p)[0] for f, p in zip(fraction, piece, strict=True)])
    assert np.abs(function(x) - exact).max() < 2e-12


def test_sides_of_a_breakpoint(function):
    assert function(0.55, "left")[0] == pytest.approx(np.sin(1.65), abs=1e-12)
    assert function(0.55, "right")[0] == pytest.approx(np.sin(2.65), abs=1e-12)
    assert function(0.1, "left")[1] == pytest.approx(np.exp(1.1), abs=1e-12)
    assert function(0.1 + 1e-14)[1] == pytest.approx(np.exp(0.1), abs=1e-12)


def test_jumps(function):
    expected = np.sin(1.65 + 1.0) - np.sin(1.65), np.sin(2.1 + 2.0) - np.sin(2.1 + 1.0)
    assert function.jumps()[1:, 0] == pytest.approx(expected, abs=1e-12)
    assert function.jumps()[:, 1] == pytest.approx([np.exp(0.1) - np.exp(1.1), 0.0, 0.0], abs=1e-12)


def test_derivatives_are_exact(function):
    x, piece = np.array([0.15, 0.3, 0.6]), np.array([0, 0, 1])
    assert function.derivative()(x)[:, 0] == pytest.approx(3.0 * np.cos(3.0 * x + piece), abs=1e-10)
    assert function.derivative(2)(x)[:, 1] == pytest.approx(np.exp(x), abs=1e-9)
    assert PiecewiseChebyshev.constant([2.0, 3.0]).derivative()(0.3) == pytest.approx([0.0, 0.0], abs=0.0)


@given(phase=st.floats(-3.0, 3.0), x=st.floats(0.0, 1.0))
def test_shift_moves_the_argument(phase, x):
    function = PiecewiseChebyshev.fit(on_piece, KINKS)
    shifted = function.shift(phase)
    distance = np.abs(np.mod(x + phase - KINKS + 0.5, 1.0) - 0.5).min()
    if distance > 1e-9:
        assert shifted(x) == pytest.approx(function(x + phase), abs=1e-11)
    assert (np.diff(shifted.breakpoints) > 0.0).all()
    assert np.sort(np.mod(shifted.breakpoints + phase, 1.0)) == pytest.approx(KINKS, abs=1e-12)


def test_fit_refuses_a_hidden_kink():
    with pytest.raises(ValueError, match="not smooth on piece 0"):
        PiecewiseChebyshev.fit(lambda x, _: np.abs(x - 0.3141), [0.0])


def bump(x):
    return 1.0 + np.exp(-(((x - 0.6) / 0.01) ** 2))


def test_fit_sees_what_lies_between_its_first_points():
    """A pulse is refused; a narrow bump and T16, zero at all points of T8's rule, take a higher degree."""
    with pytest.raises(ValueError, match="not smooth on piece 0"):
        PiecewiseChebyshev.fit(lambda x, _: 1.0 + 0.5 * ((x > 0.55) & (x < 0.62)), [0.0])
    with pytest.raises(ValueError, match="not smooth on piece 0"):
        PiecewiseChebyshev.fit(lambda x, _: bump(x), [0.0])
    x = np.linspace(0.0, 1.0, 1001)[1:-1]
    fitted = PiecewiseChebyshev.fit(lambda x, _: bump(x), [0.0], max_degree=1024)
    np.testing.assert_allclose(fitted(x)[:, 0], bump(x), atol=1e-12)
    fitted = PiecewiseChebyshev.fit(lambda x, _: np.cos(16.0 * np.arccos(2.0 * x - 1.0)), [0.0])
    np.testing.assert_allclose(fitted(x)[:, 0], np.cos(16.0 * np.arccos(2.0 * x - 1.0)), atol=1e-12)


def test_fit_asks_for_each_piece_once_where_its_first_points_do():
    asked = []

    def line(x, piece):
        asked.append(piece)
        return np.stack([x, 1.0 - x], axis=-1)

    PiecewiseChebyshev.fit(line, KINKS)
    assert asked == list(range(len(KINKS)))


def test_a_value_takes_no_longer_with_many_pieces():
    """Each point is looked at once, not once a piece."""
    pieces = 2000
    edges = np.arange(pieces) / pieces + 1e-4
    function = PiecewiseChebyshev(edges, np.stack([edges, np.ones(pieces)], axis=1)[:, :, None])
    x = np.random.default_rng(0).random(20_000)
    started = time.process_time()
    values = function(x)
    assert time.process_time() - started < 1.0
    number = np.floor((x - 1e-4) * pieces).astype(int)
    local = 2.0 * ((x - 1e-4) * pieces - number) - 1.0
    np.testing.assert_allclose(values[:, 0], edges[number] + local, atol=1e-9)


def test_fit_keeps_constants_and_zeros():
    assert PiecewiseChebyshev.fit(lambda x, _: 0.0 * x, [0.0])(0.4) == pytest.approx(0.0, abs=0.0)
    assert PiecewiseChebyshev.fit(lambda x, _: 0.0 * x + 2.0, [0.2])(0.4) == pytest.approx(2.0, abs=1e-15)


@pytest.mark.parametrize(
    ("build", "error", "message"),
    [
        (lambda: PiecewiseChebyshev.fit(on_piece, [0.0, 1.0]), ValueError, "breakpoints"),
        (lambda: PiecewiseChebyshev.fit(on_piece, [0.5, 0.2]), ValueError, "ascend"),
        (lambda: PiecewiseChebyshev.fit(on_piece, [-0.1]), ValueError, "breakpoints"),
        (lambda: PiecewiseChebyshev.fit(lambda x, p: x * np.nan, [0.0]), ValueError, "finite"),
        (lambda: PiecewiseChebyshev.fit(lambda x, p: np.ones(3), [0.0]), ValueError, "shape"),
        (lambda: PiecewiseChebyshev(np.zeros(1), np.ones((2, 3, 1))), ValueError, "coefficients"),
        (lambda: PiecewiseChebyshev.fit(lambda x, p: np.exp(1j * x), [0.0]), TypeError, "real numbers"),
        (lambda: PiecewiseChebyshev.fit(3.0, [0.0]), TypeError, "function must take two arguments"),
        (lambda: PiecewiseChebyshev.fit(lambda x: x, [0.0]), TypeError, "function must take two arguments"),
        (lambda: PiecewiseChebyshev.fit(on_piece, KINKS, max_degree="a"), TypeError, "max_degree must be"),
        (lambda: PiecewiseChebyshev.fit(on_piece, KINKS, max_degree=None), TypeError, "max_degree must be"),
        (
            lambda: PiecewiseChebyshev.fit(triangle, [0.0, 0.3], tolerance=[1e-9] * 3),
            ValueError,
            "or 2, one a piece",
        ),
        (
            lambda: PiecewiseChebyshev.fit(triangle, [0.0, 0.3], tolerance=-1),
            ValueError,
            "tolerance must be greater",
        ),
        (
            lambda: PiecewiseChebyshev.fit(lambda x, p: np.ones((x.size, 1 + p)), [0.0, 0.3]),
            ValueError,
            "as many components on each piece",
        ),
        (lambda: PiecewiseChebyshev.constant([1 + 2j]), TypeError, "values must be real"),
        (
            lambda: PiecewiseChebyshev.constant([[1.0, 2.0]]),
            ValueError,
            "values must be one number a component",
        ),
        (lambda: PiecewiseChebyshev.constant("3"), TypeError, "values must be real"),
        (lambda: PiecewiseChebyshev.constant([True]), TypeError, "values must be real"),
        (lambda: ONE(0.3, "middle"), ValueError, "side must be 'right' or 'left'"),
        (lambda: ONE("a"), TypeError, "fraction must be real"),
        (lambda: ONE(np.nan), ValueError, "fraction must be finite"),
        (lambda: ONE.derivative(-1), ValueError, "order must be at least 0"),
        (lambda: ONE.derivative(1.0), TypeError, "order must be an integer"),
        (lambda: ContactLoad(ONE, stiffness=-1.0), ValueError, "stiffness"),
        (lambda: ContactLoad(ONE, damping=np.nan), ValueError, "damping"),
        (lambda: ContactLoad(ONE, mass="1"), TypeError, "mass"),
        (lambda: ContactLoad(lambda x: x), TypeError, "shape"),
        (lambda: ContactLoad(ONE, rate="moving"), ValueError, "rate"),
        (
            lambda: ContactLoad(PiecewiseChebyshev.fit(on_piece, KINKS), mass=1.0, rate="total"),
            ValueError,
            "jump",
        ),
        (lambda: ContactLoad(ONE, weight=PiecewiseChebyshev.constant([1.0, 2.0])), ValueError, "weight"),
        (lambda: oscillator(mass=[[0.0]]), ValueError, "positive definite"),
        (lambda: oscillator(mass=[[-1.0]]), ValueError, "positive definite"),
        (lambda: oscillator(mass=[1.0]), ValueError, "mass"),
        (lambda: oscillator(damping=np.zeros((2, 2))), ValueError, "damping"),
        (lambda: oscillator(stiffness=[[np.inf]]), ValueError, "stiffness"),
        (lambda: oscillator(stiffness=[[1.0j]]), TypeError, "stiffness"),
        (lambda: oscillator(period=0.0), ValueError, "period"),
        (lambda: oscillator(period=-1.0), ValueError, "period"),
        (lambda: oscillator(period=np.nan), ValueError, "period"),
        (
            lambda: oscillator(loads=[ContactLoad(PiecewiseChebyshev.constant([1.0, 2.0]))]),
            ValueError,
            "loads",
        ),
        (lambda: oscillator(loads=[ONE]), TypeError, "loads"),
        (
            lambda: oscillator(loads=3),
            TypeError,
            "loads must be a sequence of ContactLoad, or \\(\\); got a int",
        ),
        (lambda: oscillator(loads=ContactLoad(ONE)), TypeError, "loads must be a sequence of ContactLoad"),
        (lambda: PeriodicSystem([[1.0]], [[0.0]], [[1.0]], None, 1.0), TypeError, "loads must be a sequence"),
        (
            lambda: PeriodicSystem([[1.0]], [[0.0]], [[1.0]], (), 1.0, jumps=StateJump(0.5, np.eye(2))),
            TypeError,
            "jumps must be a sequence of StateJump",
        ),
        (lambda: oscillator(mass=[[1.0], [1.0, 2.0]]), TypeError, "mass must be real numbers"),
        (lambda: oscillator(mass=np.zeros((0, 0))), ValueError, "mass must be square, at least one row"),
        (lambda: oscillator(mass=np.ones((2, 3))), ValueError, "mass must be square"),
        (lambda: oscillator().replace_loads(mass=[1.0, 2.0]), ValueError, "mass"),
        (lambda: oscillator().fourier(0), ValueError, "order"),
        (
            lambda: PeriodicSystem([[2.0, 1.0], [0.0, 2.0]], np.zeros((2, 2)), np.eye(2), (), 1.0),
            ValueError,
            "symmetric",
        ),
    ],
)
def test_bad_input_names_the_parameter(build, error, message):
    with pytest.raises(error, match=message):
        build()


def oscillator(mass=((1.0,),), damping=((0.0,),), stiffness=((1.0,),), loads=None, period=2.0):
    loads = (ContactLoad(ONE, 2.0),) if loads is None else loads
    return PeriodicSystem(mass, damping, stiffness, loads, period)


def test_systems_cannot_be_changed():
    system = oscillator()
    with pytest.raises(ValueError, match="read-only"):
        system.mass[0, 0] = 2.0
    with pytest.raises(AttributeError):
        system.period = 3.0


@pytest.mark.parametrize("rate", ["frozen", "total"])
def test_assembled_matrices_against_the_force_of_a_motion(rate):
    """M q̈ + C q̇ + K q of the loads equals φ (m ü + c u̇ + k u) with u = φᵀq differentiated as polynomials."""
    rng = np.random.default_rng(3)
    period, x0 = 0.7, 0.37
    phi = [Polynomial(rng.normal(size=6)) for _ in range(3)]
    motion = [Polynomial(rng.normal(size=5)) for _ in range(3)]
    shape = PiecewiseChebyshev.fit(lambda x, _: np.stack([p(x) for p in phi], axis=1), [0.0])
    # The mass of a total-rate load may not see the seam at the period's end.
    m = 0.8 if rate == "frozen" else 0.0
    load = ContactLoad(shape, 3.0, 0.4, m, rate)
    mass = np.diag([1.0, 2.0, 3.0])
    damping, stiffness = rng.normal(size=(2, 3, 3))
    system = PeriodicSystem(mass, damping, stiffness, (load,), period)

    # Derivatives in time, x = t / T0.
    q, v, a = (np.array([p.deriv(d)(x0) / period**d for p in motion]) for d in range(3))
    at = np.array([p(x0) for p in phi])
    if rate == "total":
        u = sum((p * r for p, r in zip(phi, motion, strict=True)), Polynomial([0.0]))
        reading = [u.deriv(d)(x0) / period**d for d in range(3)]
    else:
        reading = [at @ q, at @ v, at @ a]
    expected = (
        mass @ a + damping @ v + stiffness @ q + at * (3.0 * reading[0] + 0.4 * reading[1] + m * reading[2])
    )
    got = system.mass_matrix(x0) @ a + system.damping_matrix(x0) @ v + system.stiffness_matrix(x0) @ q
    assert got == pytest.approx(expected, rel=1e-11)
    state = system.state_matrix(x0) @ np.concatenate([q, v])
    residual = (
        system.mass_matrix(x0) @ state[3:] + system.damping_matrix(x0) @ v + system.stiffness_matrix(x0) @ q
    )
    assert np.abs(residual).max() < 1e-10


def test_total_mass_terms_against_the_acceleration_of_the_contact():
    period, x0 = 0.7, 0.37
    shape = PiecewiseChebyshev.fit(
        lambda x, _: np.stack([np.sin(2 * np.pi * x), np.cos(2 * np.pi * x) ** 2], 1), [0.0]
    )
    system = PeriodicSystem(
        np.eye(2), np.zeros((2, 2)), np.eye(2), (ContactLoad(shape, mass=0.8, rate="total"),), period
    )
    motion = PiecewiseChebyshev.fit(lambda x, _: np.stack([np.exp(x), x**3], 1), [0.0])
    contact = PiecewiseChebyshev.fit(lambda x, _: (shape(x) * motion(x)).sum(1), [0.0])
    q, v, a = (motion.derivative(d)(x0) / period**d for d in range(3))
    expected = a + q + shape(x0) * 0.8 * contact.derivative(2)(x0) / period**2
    got = system.mass_matrix(x0) @ a + system.damping_matrix(x0) @ v + system.stiffness_matrix(x0) @ q
    assert got == pytest.approx(expected, rel=1e-8)


def test_weight_multiplies_the_force():
    wave = PiecewiseChebyshev.fit(lambda x, _: np.cos(2 * np.pi * x), [0.0])
    system = oscillator(loads=[ContactLoad(PiecewiseChebyshev.constant([2.0]), 3.0, weight=wave)])
    x = np.linspace(0.0, 1.0, 7)
    assert system.stiffness_matrix(x)[:, 0, 0] == pytest.approx(1.0 + 12.0 * np.cos(2 * np.pi * x), abs=1e-12)


def triangle(x, piece):
    """Continuous, slope +1/0.3 up to 0.3, then -1/0.7."""
    return x / 0.3 if piece == 0 else (1.0 - x) / 0.7


def test_velocity_kick_of_one_load():
    mass, period = 0.5, 2.0
    shape = PiecewiseChebyshev.fit(lambda x, p: np.stack([triangle(x, p), 2.0 + 0.0 * x], 1), [0.0, 0.3])
    load = ContactLoad(shape, mass=mass, rate="total")
    system = PeriodicSystem(np.eye(2), np.zeros((2, 2)), np.eye(2), (load,), period)
    (start, at_start), (middle, at_middle) = system.velocity_kicks()
    assert (start, middle) == (0.0, 0.3)
    slope_jump = (1.0 / 0.3 + 1.0 / 0.7) / period
    phi = np.array([1.0, 2.0])
    expected = -np.outer(phi, [-slope_jump, 0.0]) * mass / (1.0 + mass * phi @ phi)
    assert at_middle == pytest.approx(expected, abs=1e-12)
    phi = np.array([0.0, 2.0])
    expected = -np.outer(phi, [slope_jump, 0.0]) * mass / (1.0 + mass * phi @ phi)
    assert at_start == pytest.approx(expected, abs=1e-12)
    assert system.replace_loads(mass=0.0).velocity_kicks() == []


def test_fourier_of_a_rectangular_wave():
    """Closed form: the wave 1 on [0.2, 0.55) has coefficients 2∫cos and 2∫sin of its support."""
    shape = PiecewiseChebyshev(np.array([0.2, 0.55]), np.array([[[1.0]], [[0.0]]]))
    _, damping, stiffness = oscillator(loads=[ContactLoad(shape, 3.0, 0.5)]).fourier(40)
    angle = 2 * np.pi * np.arange(1, 41)
    cosine = 2.0 * (np.sin(0.55 * angle) - np.sin(0.2 * angle)) / angle
    sine = 2.0 * (np.cos(0.2 * angle) - np.cos(0.55 * angle)) / angle
    assert stiffness.mean[0, 0] == pytest.approx(1.0 + 3.0 * 0.35, abs=1e-13)
    assert stiffness.cosine[:, 0, 0] == pytest.approx(3.0 * cosine, abs=1e-13)
    assert stiffness.sine[:, 0, 0] == pytest.approx(3.0 * sine, abs=1e-13)
    assert damping.cosine[:, 0, 0] == pytest.approx(0.5 * cosine, abs=1e-13)


def test_fourier_includes_the_impulses_of_a_moving_mass():
    """For a triangle φ̈ is impulses only; by parts ∫ φ φ'' e dx = -∫ (φ e)' φ' dx over the period."""
    shape = PiecewiseChebyshev.fit(triangle, [0.0, 0.3])
    mass, period, order = 0.5, 2.0, 6
    stiffness = oscillator(loads=[ContactLoad(shape, mass=mass, rate="total")], period=period).fourier(order)[
        2
    ]
    x, w = np.polynomial.legendre.leggauss(60)
    total = np.zeros(order + 1, dtype=complex)
    s = np.arange(order + 1)
    for start, end, slope in ((0.0, 0.3, 1.0 / 0.3), (0.3, 1.0, -1.0 / 0.7)):
        points, weights = (start + end) / 2 + (end - start) / 2 * x, (end - start) / 2 * w
        phi = triangle(points, 0 if end < 0.5 else 1)
        wave = np.exp(2j * np.pi * np.outer(s, points))
        total -= ((slope * wave + 2j * np.pi * s[:, None] * phi * wave) * slope) @ weights
    total *= mass / period**2
    assert stiffness.mean[0, 0] == pytest.approx(1.0 + total[0].real, abs=1e-12)
    assert stiffness.cosine[:, 0, 0] == pytest.approx(2 * total[1:].real, abs=1e-12)
    assert stiffness.sine[:, 0, 0] == pytest.approx(2 * total[1:].imag, abs=1e-12)


@pytest.mark.parametrize("weighted", [False, True])
def test_fourier_series_of_a_load_are_those_of_the_assembled_matrices(weighted):
    shape = PiecewiseChebyshev.fit(
        lambda x, p: np.stack([np.cos(2 * np.pi * x), np.sin(2 * np.pi * x) ** 2], 1), [0.0]
    )
    weight = PiecewiseChebyshev(np.array([0.2, 0.55]), np.array([[[1.0]], [[0.25]]])) if weighted else None
    mass = 0.0 if weighted else 0.5
    load = ContactLoad(shape, stiffness=3.0, damping=0.2, mass=mass, rate="total", weight=weight)
    for period in (2.0, 3.0):
        system = PeriodicSystem(np.diag([1.0, 2.0]), 0.1 * np.eye(2), np.eye(2), (load, load), period)
        matrices = (system.mass_matrix, system.damping_matrix, system.stiffness_matrix)
        for found, matrix in zip(system.fourier(7), matrices, strict=True):
            expected = fourier_series(matrix, system.breakpoints, 7)
            for name in ("mean", "cosine", "sine"):
                assert getattr(found, name) == pytest.approx(getattr(expected, name), abs=1e-11)


def test_fourier_series_converges_to_the_function():
    def matrix(x):
        return (np.exp(np.cos(2 * np.pi * x)) * np.sin(2 * np.pi * x))[:, None, None]

    series = fourier_series(matrix, [0.0], 30)
    x = np.linspace(0.0, 1.0, 50)
    assert series(x) == pytest.approx(matrix(x), abs=1e-12)


def test_fourier_series_refuses_a_hidden_jump():
    with pytest.raises(ValueError, match="not smooth"):
        fourier_series(lambda x: (x > 0.31).astype(float)[:, None, None], [0.0], 2)


def test_union_of_breakpoints_takes_rounding_as_equal():
    merged = merge_breakpoints([np.array([0.0, 0.3]), np.array([0.3 + 1e-15, 0.9]), np.array([1.0 - 1e-15])])
    assert merged == pytest.approx([0.0, 0.3, 0.9], abs=1e-14)
    assert merged.size == 3


def test_replace_loads_leaves_the_rest():
    system = oscillator(loads=[ContactLoad(ONE, 1.0, 2.0, 3.0), ContactLoad(ONE, 4.0)])
    changed = system.replace_loads(stiffness=[7.0, 8.0], damping=0.5)
    assert [load.stiffness for load in changed.loads] == [7.0, 8.0]
    assert [load.damping for load in changed.loads] == [0.5, 0.5]
    assert [load.mass for load in changed.loads] == [3.0, 0.0]
    assert [load.stiffness for load in system.loads] == [1.0, 4.0]


def test_pieces_fitted_together_are_those_fitted_one_by_one():
    edges = np.array([0.0, 0.3, 0.55])
    asked = []

    def alone(x, piece):
        return np.stack([np.exp((piece + 1) * x), np.sin(20.0**piece * x)], axis=-1)

    def together(x, pieces):
        asked.append(pieces.tolist())
        return np.stack([alone(row, piece) for row, piece in zip(x, pieces, strict=True)])

    one, other = PiecewiseChebyshev.fit(alone, edges), PiecewiseChebyshev.fit_together(together, edges)
    x = np.linspace(0.0, 1.0, 201)
    assert np.abs(one(x) - other(x)).max() < 1e-11
    # Only what is not resolved yet is asked for again.
    assert asked[0] == [0, 1, 2]
    assert asked[-1] == [2]
    assert len(asked) > 2


@pytest.mark.parametrize(
    ("function", "message"),
    [
        (lambda x, pieces: x[:, :3], "must return shape"),
        (lambda x, pieces: np.full(x.shape, np.nan), "must be finite"),
        (lambda x, pieces: x + 1j, "must return real numbers"),
    ],
)
def test_what_pieces_fitted_together_refuse(function, message):
    with pytest.raises((TypeError, ValueError), match=message):
        PiecewiseChebyshev.fit_together(function, [0.0, 0.5])
