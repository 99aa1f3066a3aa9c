"""Chebyshev series from values at the points t_j = cos(π j/K), j = 0 ... K, of [-1, 1] (Chebyshev-Lobatto points)."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from facegear.support.types import FloatArray


def lobatto_points(degree: int) -> FloatArray:
    """Points t_j from 1 down to -1, shape (degree + 1,); every second one of twice the degree."""
    return np.asarray(np.cos(np.pi * np.arange(degree + 1) / degree), dtype=float)


@lru_cache(maxsize=1024)
def values_to_coefficients(degree: int) -> FloatArray:
    """Matrix from values at `lobatto_points` to Chebyshev coefficients, shape (degree + 1, degree + 1)."""
    order = np.arange(degree + 1)
    ends = np.ones(degree + 1)
    ends[[0, -1]] = 0.5
    matrix: FloatArray = np.cos(np.pi * np.outer(order, order) / degree) * np.outer(ends, ends) * (2 / degree)
    return matrix


def interleaved(coarse: FloatArray, between: FloatArray) -> FloatArray:
    """Values at the points of twice the degree K, from those of K, (K + 1, ...), and the (K, ...) between them."""
    finer = np.empty((coarse.shape[0] + between.shape[0], *coarse.shape[1:]))
    finer[0::2], finer[1::2] = coarse, between
    return finer
