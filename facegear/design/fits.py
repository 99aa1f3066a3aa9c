"""Least squares within bounds from many starts, so that other fits are seen too."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares
from scipy.stats import qmc

from facegear.support.types import FloatArray

Residuals = Callable[[FloatArray], tuple[FloatArray, FloatArray]]

# A start that has not arrived after so many evaluations is given up: from a good one it takes about ten.
_MOST_EVALUATIONS = 25


@dataclass(frozen=True, eq=False)
class Fit:
    """A local minimum of a sum of squares.

    Attributes
    ----------
    values : array, shape (P,)
    misfit : float
        Sum of squares there.
    rows : array, shape (R, P)
        Derivatives of the residuals there.
    """

    values: FloatArray
    misfit: float
    rows: FloatArray

    def differs(self, other: Fit, misfit: float) -> bool:
        """Whether another fit is further than what changes residuals by a sum of squares of `misfit`, linearised."""
        return bool(((self.rows @ (self.values - other.values)) ** 2).sum() > misfit)


def spread_starts(least: float, most: float, parameters: int, count: int) -> FloatArray:
    """Places that fill a box evenly, always the same ones (Halton's sequence), shape (count, parameters)."""
    unit = qmc.Halton(parameters, scramble=False).random(count + 1)[1:]
    return np.asarray(least + (most - least) * unit, dtype=float)


def local_fits(residuals: Residuals, starts: Iterable[FloatArray], least: float, most: float) -> list[Fit]:
    """Minima to which starts lead, the best first; none of starts from which residuals cannot be computed.

    Parameters
    ----------
    residuals : callable
        Residuals (R,) at values (P,), and their derivatives (R, P); ArithmeticError where there are none.
    starts : iterable of array, shape (P,)
    least, most : float
        Bounds of all values.
    """
    found = []
    for start in starts:
        try:
            found.append(_local_fit(residuals, start, least, most))
        except ArithmeticError:
            continue
    return sorted(found, key=lambda fit: fit.misfit)


def _local_fit(residuals: Residuals, start: FloatArray, least: float, most: float) -> Fit:
    last: dict[bytes, tuple[FloatArray, FloatArray]] = {}

    def both(values: FloatArray) -> tuple[FloatArray, FloatArray]:
        if values.tobytes() not in last:
            last.clear()
            last[values.tobytes()] = residuals(values)
        return last[values.tobytes()]

    result = least_squares(
        lambda x: both(x)[0],
        start,
        lambda x: both(x)[1],
        bounds=(least, most),
        xtol=1e-10,
        ftol=1e-12,
        gtol=1e-10,
        max_nfev=_MOST_EVALUATIONS,
        method="dogbox",  # arrives at a bound in one step; the default crawls there
    )
    return Fit(
        np.asarray(result.x, dtype=float), float(2.0 * result.cost), np.asarray(result.jac, dtype=float)
    )
