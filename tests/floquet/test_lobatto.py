"""Chebyshev series from values at cos(π j/K), against NumPy's evaluation of the series."""

import numpy as np
import pytest
from numpy.polynomial import chebyshev

from facegear.floquet.lobatto import interleaved, lobatto_points, values_to_coefficients


@pytest.mark.parametrize("degree", [1, 2, 7, 32])
def test_coefficients_of_a_series_come_back(degree):
    coefficients = np.random.default_rng(degree).standard_normal(degree + 1)
    values = chebyshev.chebval(lobatto_points(degree), coefficients)
    assert np.abs(values_to_coefficients(degree) @ values - coefficients).max() < 1e-13


def test_the_points_of_twice_the_degree_contain_those_of_the_degree():
    coarse, finer = lobatto_points(8), lobatto_points(16)
    assert np.abs(interleaved(coarse, finer[1::2]) - finer).max() < 1e-15
    rows = interleaved(np.stack([coarse, coarse], axis=1), np.stack([finer[1::2], finer[1::2]], axis=1))
    assert rows.shape == (17, 2)
    assert np.abs(rows - finer[:, None]).max() < 1e-15
