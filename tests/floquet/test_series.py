"""Chebyshev series of functions with values of any shape, against NumPy's and closed forms."""

import numpy as np
import pytest
from numpy.polynomial import chebyshev

from facegear.floquet.series import ChebyshevSeries, interleaved, lobatto_coefficients


@pytest.mark.parametrize("degree", [1, 2, 7, 32])
@pytest.mark.parametrize("shape", [(), (2, 3)])
def test_coefficients_of_a_series_come_back(degree, shape):
    coefficients = np.random.default_rng(degree).standard_normal((degree + 1, *shape))
    values = np.moveaxis(chebyshev.chebval(chebyshev.chebpts2(degree + 1), coefficients), -1, 0)
    assert np.abs(lobatto_coefficients(values) - coefficients).max() < 1e-13
    assert np.abs(lobatto_coefficients(1j * values) - 1j * coefficients).max() < 1e-13


def test_the_points_of_twice_the_degree_contain_those_of_the_degree():
    coarse, finer = chebyshev.chebpts2(9), chebyshev.chebpts2(17)
    assert np.abs(interleaved(coarse, finer[1::2]) - finer).max() < 1e-15
    rows = interleaved(np.stack([coarse, coarse], axis=1), np.stack([finer[1::2], finer[1::2]], axis=1))
    assert rows.shape == (17, 2)
    assert np.abs(rows - finer[:, None]).max() < 1e-15


def waves(x):
    """Values of shape (2, 2) at points (n,): entire functions."""
    return np.stack([np.stack([np.sin(x), np.cos(x)], -1), np.stack([np.exp(-x), x**3], -1)], -1)


def slopes(x):
    return np.stack([np.stack([np.cos(x), -np.sin(x)], -1), np.stack([-np.exp(-x), 3 * x**2], -1)], -1)


def test_a_smooth_function_is_refined_until_its_tail_vanishes():
    asked = []

    def evaluate(points):
        asked.append(points.size)
        return waves(points)

    series = ChebyshevSeries.sampled(evaluate, 1.0, 4.0, 4)
    while series.tail > 1e-13:
        series = series.refined(evaluate)
    # No value is asked for twice.
    assert asked == [5, 4, 8]
    assert series.degree == 16
    x = np.linspace(1.0, 4.0, 41)
    np.testing.assert_allclose(series(x), waves(x), rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(series.derivative(x), slopes(x), rtol=0.0, atol=1e-10)
    np.testing.assert_allclose(series(2.5), waves(np.array(2.5)), rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(series(x.reshape(1, 41)), waves(x)[None], rtol=0.0, atol=1e-12)


def test_no_point_has_no_value():
    series = ChebyshevSeries.sampled(waves, 1.0, 4.0, 4)
    assert series([]).shape == series.derivative([]).shape == (0, 2, 2)


def test_beyond_the_ends_stand_the_ends():
    series = ChebyshevSeries.sampled(waves, 1.0, 4.0, 24)
    np.testing.assert_allclose(series([0.0, 5.0]), waves(np.array([1.0, 4.0])), rtol=0.0, atol=1e-12)


def test_the_tail_is_relative_to_the_largest_value_or_one():
    line = ChebyshevSeries(0.0, 1.0, np.array([0.0, 1e3]))
    assert line.tail == pytest.approx(0.5)
    assert ChebyshevSeries(0.0, 1.0, np.array([0.0, 1e-3])).tail == pytest.approx(0.5e-3)
