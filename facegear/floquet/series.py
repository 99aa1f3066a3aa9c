"""Chebyshev series on an interval: what is interpolated along a parameter, along speed or along a radius.

A function with values of any shape is sampled at the Chebyshev points of the second kind, cos(π j/K) on [-1, 1]
(Chebyshev-Lobatto points). Those of twice the degree contain them, so that a series that does not suffice is refined by
K values more.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import ArrayLike
from scipy.fft import dct

from facegear.support.types import FloatArray


def lobatto_coefficients(values: FloatArray) -> FloatArray:
    """Chebyshev coefficients of the interpolant through values at `numpy.polynomial.chebyshev.chebpts2`.

    Parameters
    ----------
    values : array, shape (K + 1, ...)
        Real or complex, at ascending points, K >= 1.

    Returns
    -------
    array, shape (K + 1, ...)

    Examples
    --------
    >>> points = chebyshev.chebpts2(4)
    >>> bool(np.allclose(lobatto_coefficients(2.0 * points**2 - 1.0), [0.0, 0.0, 1.0, 0.0]))
    True
    """
    # The transform takes its points from 1 down to -1.
    coefficients = dct(values[::-1], type=1, axis=0) / (values.shape[0] - 1)
    coefficients[[0, -1]] /= 2.0
    return np.asarray(coefficients)


def chebyshev_basis(low: float, high: float, points: ArrayLike, count: int) -> FloatArray:
    """Values of the first polynomials on an interval at points, (..., count); beyond its ends, those there."""
    middle, half = (low + high) / 2.0, (high - low) / 2.0
    local = np.clip((np.asarray(points, dtype=float) - middle) / half, -1.0, 1.0)
    # NumPy makes one point of a number.
    return np.asarray(chebyshev.chebvander(local, count - 1).reshape(*local.shape, count), dtype=float)


def interleaved(coarse: FloatArray, between: FloatArray) -> FloatArray:
    """Values at the points of twice the degree K, from those of K, (K + 1, ...), and the (K, ...) between them."""
    finer = np.empty((coarse.shape[0] + between.shape[0], *coarse.shape[1:]))
    finer[0::2], finer[1::2] = coarse, between
    return finer


@dataclass(frozen=True, eq=False)
class ChebyshevSeries:
    """A smooth function on an interval by its values at Chebyshev points.

    Attributes
    ----------
    low, high : float
        Ends of the interval.
    values : ndarray, shape (K + 1, ...)
        At :meth:`points_of` the interval; K is the degree, at least 1.
    """

    low: float
    high: float
    values: FloatArray

    @classmethod
    def sampled(
        cls, evaluate: Callable[[FloatArray], FloatArray], low: float, high: float, degree: int
    ) -> ChebyshevSeries:
        """Sample a function (K + 1,) -> (K + 1, ...) once."""
        return cls(low, high, evaluate(cls.points_of(low, high, degree)))

    @classmethod
    def resolved(
        cls,
        evaluate: Callable[[FloatArray], FloatArray],
        low: float,
        high: float,
        degree: int,
        most: int,
        tolerance: float,
    ) -> ChebyshevSeries:
        """Sample a function, and double the degree up to `most` until the :attr:`tail` meets the tolerance.

        Examples
        --------
        >>> ChebyshevSeries.resolved(np.exp, 0.0, 1.0, 4, 64, 1e-12).degree
        16
        """
        series = cls.sampled(evaluate, low, high, degree)
        while series.tail > tolerance and 2 * series.degree <= most:
            series = series.refined(evaluate)
        return series

    @staticmethod
    def points_of(low: float, high: float, degree: int) -> FloatArray:
        """Chebyshev points of an interval, ascending, shape (degree + 1,)."""
        points: FloatArray = (low + high) / 2.0 + (high - low) / 2.0 * chebyshev.chebpts2(degree + 1)
        return points

    def refined(self, evaluate: Callable[[FloatArray], FloatArray]) -> ChebyshevSeries:
        """Return the series of twice the degree, from values between those that are known."""
        return ChebyshevSeries(self.low, self.high, interleaved(self.values, evaluate(self.between)))

    @property
    def degree(self) -> int:
        """Degree K."""
        return int(self.values.shape[0]) - 1

    @property
    def between(self) -> FloatArray:
        """Points that twice the degree adds, shape (K,)."""
        return self.points_of(self.low, self.high, 2 * self.degree)[1::2]

    @cached_property
    def coefficients(self) -> FloatArray:
        """Chebyshev coefficients, shape (K + 1, ...)."""
        return lobatto_coefficients(self.values)

    @property
    def tail(self) -> float:
        """Size of the last two coefficients relative to the largest value or 1: one can be small by accident."""
        last = float(np.abs(self.coefficients[-2:]).max())
        return last / max(float(np.abs(self.values).max()), 1.0)

    def __call__(self, points: ArrayLike) -> FloatArray:
        """Interpolate at points of any shape, which goes before that of a value; beyond the ends, the ends."""
        return self._sum(self.coefficients, points)

    def derivative(self, points: ArrayLike) -> FloatArray:
        """Return the derivative at points, shaped as the values there."""
        return self._sum(self._slopes, points)

    @cached_property
    def _slopes(self) -> FloatArray:
        half = (self.high - self.low) / 2.0
        return np.asarray(chebyshev.chebder(self.coefficients, axis=0) / half, dtype=float)

    def _sum(self, coefficients: FloatArray, points: ArrayLike) -> FloatArray:
        basis = chebyshev_basis(self.low, self.high, points, coefficients.shape[0])
        return np.tensordot(basis, coefficients, axes=1)
