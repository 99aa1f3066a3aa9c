"""Contact-force collocation and whole columns of a map, on a synthetic disk with 28 states."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from benchmarks.synthetic_disk import (
    CONTACT_DAMPING,
    CONTACT_MASS,
    CONTACT_STIFFNESS,
    GEAR_TEETH,
    KINKS,
    PINIONS,
    contact_path,
    contact_shape,
    disk_matrices,
    piece_of,
    shape_vector,
    synthetic_disk,
    synthetic_shafts,
)
from facegear.floquet.collocation import FreeMotion, chain, transition_matrices, transition_matrices_to
from facegear.floquet.columns import column_spectral_radii, family_spectral_radii, interpolated_spectral_radii
from facegear.floquet.free_modes import UnsuitableSystemError
from facegear.floquet.free_systems import FreeSystems
from facegear.floquet.load_columns import LoadColumn
from facegear.floquet.loads import ContactLoad
from facegear.floquet.methods import AdaptiveMagnus, Collocation
from facegear.floquet.multipliers import multipliers
from facegear.floquet.multipliers import transition_matrices as by_method
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.floquet.stepping import Family
from facegear.support.quadrature import gauss_legendre, legendre_from_values

RPM = np.pi / 30.0


@pytest.fixture(scope="module")
def shapes():
    return [contact_shape(angle, phase) for angle, phase in PINIONS]


def integrated_disk(speed, pinions, load=1.0):
    """Φ by DOP853 in the state (q, q̇), assembled here from the analytic contact path (frozen rate)."""
    damping, stiffness = disk_matrices(speed)
    period = 2.0 * np.pi / (GEAR_TEETH * speed)
    k, c, m = load * CONTACT_STIFFNESS, load * CONTACT_DAMPING, load * CONTACT_MASS
    edges = np.unique(np.concatenate([[0.0, 1.0], *(np.mod(KINKS - phase, 1.0) for _, phase in pinions)]))
    y = np.eye(28).ravel()
    for a, b in pairwise(edges):
        middle = (a + b) / 2.0

        def rhs(t, y, middle=middle):
            q, v = y.reshape(2, 14, 28)
            force = -damping @ v - stiffness @ q
            mass = np.eye(14)
            for angle, phase in pinions:
                # The smooth piece is chosen once for the whole interval, so its ends are one-sided.
                piece = piece_of((middle + phase) % 1.0)
                x = t / period + phase - np.floor(middle + phase)
                radius, moved = contact_path(x, piece)
                phi = shape_vector(radius, moved + angle)
                force -= np.outer(phi, k * (phi @ q) + c * (phi @ v))
                mass += m * np.outer(phi, phi)
            return np.concatenate([v, np.linalg.solve(mass, force)]).ravel()

        # Velocities are some thousand times displacements: tolerances by their sizes.
        size = np.concatenate([np.full(14 * 28, 1e-16), np.full(14 * 28, 1e-13)])
        y = solve_ivp(rhs, (a * period, b * period), y, method="DOP853", rtol=1e-12, atol=size).y[:, -1]
    return y.reshape(28, 28)


def spectrum_distance(one, other):
    return np.abs(np.linalg.eigvals(one)[:, None] - np.linalg.eigvals(other)[None, :]).min(axis=1).max()


@pytest.mark.parametrize(
    ("speed_rpm", "count"), [(1000.0, 1), (430.0, 1), (150.0, 1), (1000.0, 2), (600.0, 3)]
)
def test_synthetic_disk_against_an_integrator(shapes, speed_rpm, count):
    expected = integrated_disk(speed_rpm * RPM, PINIONS[:count])
    got = transition_matrices([synthetic_disk(speed_rpm * RPM, shapes[:count])])[0]
    assert spectrum_distance(got, expected) < 1e-9
    scale = np.repeat([5e3, 1.0], 14)
    assert np.abs(scale[:, None] * (got - expected) / scale).max() < 1e-9


def test_family_on_shared_panels_equals_each_alone(shapes):
    """From 150 to 1000 rpm some systems share the panels of a slower one, others cannot."""
    speeds = [600.0, 150.0, 1000.0, 700.0, 180.0]
    systems = [synthetic_disk(speed * RPM, shapes[:1]) for speed in speeds]
    together = transition_matrices(systems)
    scale = np.repeat([5e3, 1.0], 14)
    for matrix, system in zip(together, systems, strict=True):
        alone = transition_matrices([system], nodes=24, panel_angle=5.0)[0]
        assert np.abs(scale[:, None] * (matrix - alone) / scale).max() < 1e-10


@pytest.mark.parametrize("count", [1, 2])
def test_total_rate_with_kicks_against_magnus(shapes, count):
    """Moving contact masses; the momentum form is compared with in test_floquet."""
    system = synthetic_disk(800.0 * RPM, shapes[:count], "total", load=0.05)
    assert len(system.velocity_kicks()) == 4 * count
    one, other = multipliers(system, Collocation()), multipliers(system, AdaptiveMagnus(1e-12))
    assert np.abs(one[:, None] - other).min(axis=1).max() < 1e-9 * max(1.0, np.abs(one[0]))


@pytest.mark.parametrize("swept", ["stiffness", "damping", "mass", "stiffness and damping"])
@pytest.mark.parametrize(("speed_rpm", "count"), [(900.0, 1), (120.0, 1), (350.0, 2)])
def test_columns_equal_single_cells(shapes, swept, speed_rpm, count):
    s = np.linspace(0.0, 1.0, 60)
    parameters = {
        "mass": np.full(60, CONTACT_MASS),
        "damping": np.full(60, CONTACT_DAMPING),
        "stiffness": np.full(60, CONTACT_STIFFNESS),
    }
    for name in swept.split(" and "):
        parameters[name] = 2.0 * s * parameters[name]
    system = synthetic_disk(speed_rpm * RPM, shapes[:count])
    radii = column_spectral_radii(system, parameters["mass"], parameters["damping"], parameters["stiffness"])
    assert radii.shape == (60,)
    for i in (0, 1, 17, 42, 59):
        cell = system.replace_loads(**{name: values[i] for name, values in parameters.items()})
        assert radii[i] == pytest.approx(np.abs(multipliers(cell, Collocation(24, 6.0))[0]), abs=1e-9)


def test_column_with_one_value_a_load_and_off_a_line(shapes):
    rng = np.random.default_rng(0)
    stiffness = CONTACT_STIFFNESS * rng.uniform(0.0, 1.0, (15, 2))
    mass = CONTACT_MASS * rng.uniform(0.0, 1.0, (15, 2))
    system = synthetic_disk(500.0 * RPM, shapes[:2])
    radii = column_spectral_radii(system, mass, 3.0, stiffness)
    for i in (0, 7, 14):
        cell = system.replace_loads(mass=mass[i], damping=3.0, stiffness=stiffness[i])
        assert radii[i] == pytest.approx(np.abs(multipliers(cell, AdaptiveMagnus(1e-12))[0]), abs=1e-9)


def test_columns_with_total_rate(shapes):
    system = synthetic_disk(800.0 * RPM, shapes[:2], "total")
    mass = np.linspace(0.0, 0.05, 40) * CONTACT_MASS
    radii = column_spectral_radii(system, mass, 0.5, 1e5)
    for i in (0, 11, 39):
        cell = system.replace_loads(mass=mass[i], damping=0.5, stiffness=1e5)
        exact = np.abs(multipliers(cell, AdaptiveMagnus(1e-12))[0])
        assert radii[i] == pytest.approx(exact, abs=1e-9 * max(1.0, exact))


@pytest.mark.parametrize("rate", ["frozen", "total"])
def test_matrices_to_an_instant_turn_the_period_into_that_of_a_shifted_system(shapes, rate):
    system = synthetic_disk(600.0 * RPM, shapes[:1])
    system = replace(system, loads=[replace(load, rate=rate) for load in system.loads])
    # A breakpoint with a kick, an instant between breakpoints, the end.
    instants = [float(system.breakpoints[1]), 0.37, 1.0]
    reached = transition_matrices_to(instants, system)
    (whole,) = transition_matrices([system])
    scale = Family([system]).scale
    for instant, matrix in zip(instants, reached, strict=True):
        (shifted,) = transition_matrices([system.shift(instant)])
        one, other = (
            scale @ product @ np.linalg.inv(scale) for product in (shifted @ matrix, matrix @ whole)
        )
        np.testing.assert_allclose(one, other, rtol=0.0, atol=1e-11)
    one, other = (scale @ product @ np.linalg.inv(scale) for product in (reached[-1], whole))
    np.testing.assert_allclose(one, other, rtol=0.0, atol=1e-11)


def test_a_rigid_body_motion_is_held_by_a_spring_that_is_taken_back():
    """Shafts that rotate as a body but for the mesh; a disk and a mass on nothing; two masses on nothing at all."""
    systems = [synthetic_shafts(0.0), synthetic_shafts(3.0)]
    drifting = PeriodicSystem(np.diag([1.0, 2.0]), np.zeros((2, 2)), np.zeros((2, 2)), (), 3.0)
    half = replace(drifting, stiffness=np.array([[1.0, -1.0], [-1.0, 1.0]]), damping=0.1 * np.eye(2))
    for system in (*systems, drifting, half):
        scale = Family([system]).scale
        found, exact = (
            scale @ by_method([system], m)[0] @ np.linalg.inv(scale)
            for m in (Collocation(), AdaptiveMagnus(1e-13))
        )
        assert np.abs(found - exact).max() < 1e-12 * np.abs(exact).max()
    # In a family one spring serves all, held or not.
    scale = Family(systems).scale
    both = np.array([by_method(systems, m) for m in (Collocation(), AdaptiveMagnus(1e-13))])
    assert np.abs(scale @ (both[0] - both[1]) @ np.linalg.inv(scale)).max() < 1e-12
    with pytest.raises(UnsuitableSystemError, match="rigid-body"):
        by_method(systems, Collocation(fewest_held=4))


def test_a_column_of_a_system_with_a_rigid_body_motion():
    system = synthetic_shafts(0.0)
    damping = np.linspace(50.0, 400.0, 20)
    radii = column_spectral_radii(system, 0.0, damping, 1.58e8)
    held = column_spectral_radii(system, 0.0, damping, 1.58e8, Collocation())
    for i in (0, 9, 19):
        cell = system.replace_loads(damping=damping[i])
        exact = np.abs(multipliers(cell, AdaptiveMagnus(1e-12))[0])
        # A double multiplier 1 is known to the root of rounding.
        assert [radii[i], held[i]] == pytest.approx([exact, exact], abs=1e-7)


def test_any_analytic_parameter_can_be_swept():
    values = np.linspace(1e5, 6e5, 50)
    radii = family_spectral_radii(synthetic_shafts, values)
    systems = [synthetic_shafts(value) for value in values]
    direct = largest_modulus(by_method(systems, AdaptiveMagnus(1e-12)))
    assert np.abs(radii - direct).max() < 1e-8


@given(count=st.integers(1, 9), size=st.integers(1, 4), seed=st.integers(0, 99))
def test_chain_is_the_ordered_product(count, size, seed):
    steps = np.random.default_rng(seed).normal(size=(2, count, size, size))
    expected = np.eye(size)
    for step in steps[1]:
        expected = step @ expected
    assert chain(steps)[1] == pytest.approx(expected, abs=1e-9)


def largest_modulus(matrices):
    return np.abs(np.linalg.eigvals(matrices)).max(axis=-1)


@given(frequency=st.floats(0.1, 40.0), count=st.integers(2, 120))
@settings(max_examples=30)
def test_interpolation_meets_its_tolerance_or_evaluates_everything(frequency, count):
    def evaluate(x):
        wave = frequency * x
        return np.stack([np.stack([2.0 + np.cos(wave), 0.3 * np.sin(wave)], -1), np.stack([x, x], -1)], -2)

    points = np.linspace(-1.0, 2.0, count) ** 3
    assert (
        np.abs(interpolated_spectral_radii(evaluate, points) - largest_modulus(evaluate(points))).max() < 1e-9
    )


def test_interpolation_evaluates_few_points_of_a_long_column():
    asked = []

    def evaluate(x):
        asked.append(x.size)
        return np.cos(x)[:, None, None]

    interpolated_spectral_radii(evaluate, np.linspace(0.0, 1.0, 500))
    # Those of the series, and three that check it.
    assert sum(asked) <= 17 + 3


@given(
    seed=st.integers(0, 2**16),
    decay=st.floats(0.0, 1.05),
    bend=st.floats(0.0, 2.0),
    leading=st.integers(1, 5),
)
@settings(max_examples=60)
def test_decaying_modes_change_no_spectral_radius(seed, decay, bend, leading):
    """Six modes of modulus near 1 or `decay`, coupled along the parameter: with a gap, with none, dead or growing."""
    rng = np.random.default_rng(seed)
    start = np.diag(np.where(np.arange(6) < leading, 1.0, decay)) + 0.02 * rng.standard_normal((6, 6))
    change = 0.05 * bend * rng.standard_normal((2, 6, 6))

    def evaluate(x):
        return start + x[:, None, None] * change[0] + (x**2)[:, None, None] * change[1]

    points = np.linspace(-1.0, 1.0, 200)
    # Where two eigenvalues coincide an error of the matrix moves them by its square root.
    assert (
        np.abs(interpolated_spectral_radii(evaluate, points) - largest_modulus(evaluate(points))).max() < 1e-6
    )


def test_a_rigid_body_motion_is_interpolated_with_the_others():
    """Two multipliers of 1 with one vector: known to the root of rounding."""

    def evaluate(x):
        matrices = np.zeros((x.size, 6, 6))
        matrices[:, np.arange(6), np.arange(6)] = [1.0, 1.0, 0.4, 0.3, 0.2, 0.1]
        matrices[:, 0, 1] = 1.0 + x
        matrices[:, 2:, :2] = 0.1 * x[:, None, None]
        return matrices

    points = np.linspace(0.0, 1.0, 100)
    assert np.abs(interpolated_spectral_radii(evaluate, points) - 1.0).max() < 1e-7


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        ((-1.0, 1.0, 1.0), ValueError, "mass"),
        ((0.0, np.nan, 1.0), ValueError, "dampings"),
        ((0.0, 0.0, [1.0, -2.0]), ValueError, "stiffness"),
        (([0.0, 1.0], 0.0, [1.0, 2.0, 3.0]), ValueError, "masses"),
        ((0.0, 0.0, np.ones((4, 3))), ValueError, "stiffnesses"),
        ((0.0, 0.0, "stiff"), TypeError, "stiffnesses"),
    ],
)
def test_bad_input_names_the_parameter(shapes, arguments, error, message):
    system = synthetic_disk(500.0 * RPM, shapes[:2])
    with pytest.raises(error, match=message):
        column_spectral_radii(system, *arguments)


def test_load_columns_must_match():
    with pytest.raises(ValueError, match="damping"):
        LoadColumn(np.zeros((2, 1)), np.zeros((3, 1)), np.zeros((2, 1)))


def test_panels_follow_the_shapes_of_loads_before_forces_are_looked_at():
    """Of (1.2 - s)⁻⁶ 16 nodes leave too much on the whole period, and nearer to its pole more than before."""
    shape = PiecewiseChebyshev.fit(lambda s, piece: ((1.2 - s) ** -6.0)[:, None], [0.0], tolerance=1e-13)
    system = PeriodicSystem([[1.0]], [[0.01]], [[4.0]], (ContactLoad(shape, stiffness=1e-5),), period=0.5)
    free = FreeSystems.of([system], LoadColumn.of(system))
    edges = FreeMotion(free).edges
    nodes, tail = gauss_legendre(16)[0], legendre_from_values(16)[-2:]
    for start, end in pairwise(edges):
        values = shape(start + (end - start) * (nodes + 1.0) / 2.0)[:, 0]
        assert np.abs(tail @ values).max() <= 1e-7 * shape.largest
    assert edges.size > 2
    assert edges[-1] - edges[-2] < edges[1] - edges[0]
    found, expected = transition_matrices([system]), by_method([system], AdaptiveMagnus(1e-12))
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-11 * np.abs(expected).max())


def test_some_of_many_systems_keep_their_modes_loads_and_angles(shapes):
    systems = [synthetic_disk(speed * RPM, shapes[:1]) for speed in (200.0, 300.0, 500.0)]
    free = FreeSystems.of(systems, LoadColumn.of_all(systems))
    some = free.some(np.array([2, 0]))
    alone = FreeSystems.of([systems[2]], LoadColumn.of(systems[2]))
    np.testing.assert_allclose(some.angles[0], alone.angles[0], rtol=1e-12)
    np.testing.assert_allclose(
        some.held.modes.eigenvalues[0].imag, alone.held.modes.eigenvalues[0].imag, rtol=1e-9
    )
    np.testing.assert_allclose(some.column.stacked()[1:], LoadColumn.of(systems[0]).stacked(), rtol=1e-14)
    assert list(some.systems) == [systems[2], systems[0]]


@pytest.mark.parametrize("rate", ["frozen", "total"])
def test_systems_with_values_of_their_own_are_those_of_a_column(shapes, rate):
    """Many systems put their parameters into the equations, one system keeps them out: the same matrices."""
    one = synthetic_disk(400.0 * RPM, shapes)
    loads = tuple(replace(load, rate=rate) for load in one.loads)
    part = np.array([[0.2], [0.7], [1.0]]) * np.array([1.0, 0.8, 0.5])
    column = LoadColumn(CONTACT_MASS * part, CONTACT_DAMPING * part, CONTACT_STIFFNESS * part)
    each = zip(*column.parts, strict=True)
    one = replace(one, loads=loads)
    systems = [one.replace_loads(mass=m, damping=c, stiffness=k) for m, c, k in each]
    motion = FreeMotion(FreeSystems.of([one], column))
    modes = motion.modes
    expected = modes.state_from_real() @ motion.transition_matrices(column) @ modes.real_from_state()
    found = transition_matrices(systems)
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-10 * np.abs(expected).max())
    many = FreeMotion(FreeSystems.of(systems, column))
    with pytest.raises(ValueError, match="column must be that of the systems"):
        many.transition_matrices(LoadColumn(column.mass, column.damping, 2.0 * column.stiffness))
