"""Columns of a map against cells computed one by one, where modes decay and where they do not."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from facegear.floquet.columns import (
    agree,
    column_spectral_radii,
    family_spectral_radii,
    interpolated_spectral_radii,
    resolved,
)
from facegear.floquet.loads import ContactLoad
from facegear.floquet.multipliers import multipliers
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from tests.resonance_systems import CHECK, TURN


def cells(system, masses, dampings, stiffnesses):
    rows = zip(masses, dampings, stiffnesses, strict=True)
    return np.array([radius(system.replace_loads(mass=m, damping=c, stiffness=k)) for m, c, k in rows])


def radius(system):
    return np.abs(multipliers(system)[0])


def two_oscillators(stiffness):
    """One of ω² = 0.3, slightly damped, beside one of ω² = 0.5 + k(1 + 0.1 cos 2t) that decays far faster."""
    swung = PiecewiseChebyshev.fit(lambda x, piece: 1.0 + 0.1 * np.cos(TURN * x), [0.0])
    load = ContactLoad(PiecewiseChebyshev.constant([0.0, 1.0]), stiffness, weight=swung)
    return PeriodicSystem(np.eye(2), np.diag([3e-4, 0.02]), np.diag([0.3, 0.5]), (load,), TURN / 2.0)


def test_a_tongue_of_a_mode_that_decays_elsewhere_is_not_lost():
    values = np.linspace(0.3334, 0.6134, 121)
    expected = np.array([radius(two_oscillators(k)) for k in values.tolist()])
    assert np.count_nonzero(expected > 1.0) == 13
    assert expected.max() == pytest.approx(1.00792, abs=1e-5)
    by_load = column_spectral_radii(two_oscillators(1.0), 0.0, 0.0, values)
    assert np.abs(by_load - expected).max() < 1e-9
    assert np.abs(family_spectral_radii(two_oscillators, values) - expected).max() < 1e-9


@given(
    seed=st.integers(0, 2**16),
    size=st.integers(1, 4),
    swept=st.sampled_from(["stiffness", "damping", "mass"]),
    strongest=st.floats(0.05, 2.0),
    slow_decay=st.floats(1e-4, 0.1),
    fast_decay=st.floats(1e-4, 1.0),
)
@CHECK
def test_a_column_is_its_cells(seed, size, swept, strongest, slow_decay, fast_decay):
    """Oscillators that turn by a few radians a period, damped much or little, under a load that moves over them."""
    rng = np.random.default_rng(seed)
    frequencies = rng.uniform(0.3, 3.0, size)
    ways = rng.normal(size=(2, size)) / np.sqrt(size)
    shape = PiecewiseChebyshev.fit(lambda x, piece: ways[0] + np.cos(TURN * x)[:, None] * ways[1], [0.0])
    damping = np.diag(np.where(np.arange(size) % 2, fast_decay, slow_decay))
    system = PeriodicSystem(np.eye(size), damping, np.diag(frequencies**2), [ContactLoad(shape)], TURN)
    values = {name: np.full(60, 0.2) for name in ("mass", "damping", "stiffness")}
    values[swept] = np.linspace(0.0, strongest, 60)
    columns = list(values.values())
    # Where two multipliers coincide an error of the matrix moves them by its square root.
    errors = np.abs(column_spectral_radii(system, *columns)[::4] - cells(system, *(c[::4] for c in columns)))
    assert errors.max() < 1e-6
    assert np.median(errors) < 1e-9


def test_what_is_smooth_to_the_samples_only_is_computed_cell_by_cell():
    """A bump between Chebyshev points that none of them meets."""
    points = np.linspace(-1.0, 1.0, 400)

    def evaluate(x):
        return (0.5 + np.exp(-(((x - 0.19) / 0.02) ** 2)))[:, None, None] * np.eye(2)

    expected = np.abs(evaluate(points)[:, 0, 0])
    assert np.abs(interpolated_spectral_radii(evaluate, points) - expected).max() < 1e-12


def test_matrices_of_very_different_size_share_no_series():
    points = np.linspace(0.0, 1.0, 60)

    def evaluate(some):
        return np.exp(some * rate)[:, None, None] * np.eye(2)

    rate = 3.0
    assert resolved(evaluate, points, 1e-11, 8) is not None
    rate = 40.0
    assert resolved(evaluate, points, 1e-11, 8) is None


def test_a_small_matrix_is_not_agreed_upon_because_a_large_one_is():
    own = np.array([1e6, 1.0])[:, None, None] * np.eye(2)
    assert agree(own * (1.0 + 1e-13), own)
    assert not agree(own + 1e-6, own)
