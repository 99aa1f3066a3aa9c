"""Gauss and Legendre's nodes and weights on an interval, and the series that values at the nodes are of."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.polynomial import legendre

from facegear.support.types import FloatArray


@lru_cache(maxsize=64)
def gauss_legendre(count: int) -> tuple[FloatArray, FloatArray]:
    """Nodes and weights on [-1, 1], shape (count,) each: an eigenproblem, which is solved once."""
    nodes, weights = legendre.leggauss(count)
    for array in (nodes, weights):
        array.setflags(write=False)
    return nodes, weights


@lru_cache(maxsize=64)
def legendre_from_values(count: int) -> FloatArray:
    """Matrix from values at the nodes to coefficients of Legendre polynomials on [-1, 1], shape (count, count)."""
    nodes, weights = gauss_legendre(count)
    degrees = np.arange(count)
    matrix = (degrees + 0.5)[:, np.newaxis] * legendre.legvander(nodes, count - 1).T * weights
    matrix.setflags(write=False)
    return np.asarray(matrix)


def gauss(low: float, high: float, count: int) -> tuple[FloatArray, FloatArray]:
    """Nodes and weights of Gauss and Legendre on an interval.

    Parameters
    ----------
    low, high : float
        Its ends.
    count : int
        Of nodes; polynomials of degree 2 `count` − 1 are integrated exactly.

    Returns
    -------
    nodes, weights : ndarray, shape (count,)

    Examples
    --------
    >>> nodes, weights = gauss(0.0, 2.0, 2)
    >>> round(float(weights @ nodes**3), 12)
    4.0
    """
    nodes, weights = gauss_legendre(count)
    return 0.5 * (low + high) + 0.5 * (high - low) * nodes, 0.5 * (high - low) * weights
