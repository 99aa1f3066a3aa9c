"""Roots of a function between two arguments, one at a time or many at once."""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from facegear.support.types import FloatArray

# Width of the interval that a search ends with, relative and, next to zero, absolute.
_DIGIT, _SMALL = 4.0 * np.finfo(float).eps, 1e-20
# Steps within which a search settles that does no worse than halve its interval now and then.
_STEPS = 200


def root(function: Callable[[float], float], lower: float, upper: float) -> float:
    """Root of a scalar function between two arguments of opposite sign, to the last digit."""
    return float(brentq(function, lower, upper, xtol=1e-16, rtol=8.9e-16))


def crossing(
    function: Callable[..., FloatArray], lower: ArrayLike, upper: ArrayLike, *arguments: ArrayLike
) -> FloatArray:
    """Where an increasing function crosses zero between two arguments, elementwise, to the last digit.

    Where it is positive throughout the lower end is the answer, where negative throughout the upper one.
    """
    low, high, *rest = np.broadcast_arrays(lower, upper, *arguments)
    above = function(low, *rest) >= 0.0
    below = function(high, *rest) <= 0.0
    inside = ~(above | below)
    result = np.where(above, low, high).astype(np.float64)
    if np.any(inside):
        ends = (low[inside], high[inside])
        result[inside] = _enclosed(function, *ends, tuple(argument[inside] for argument in rest))
    return result


def _enclosed(
    function: Callable[..., FloatArray], low: FloatArray, high: FloatArray, rest: tuple[FloatArray, ...]
) -> FloatArray:
    """Roots between arguments where a function is negative and positive, shape (m,), by Chandrupatla's method.

    Inverse quadratic interpolation where it can be trusted, else the middle. `scipy.optimize.elementwise.find_root` is
    the same method, and takes ten times as long over a few dozen roots.
    """
    x_1, x_2, f_1, f_2 = low, high, function(low, *rest), function(high, *rest)
    found, settled, part = low.copy(), np.zeros(low.shape, dtype=bool), np.full(low.shape, 0.5)
    for _ in range(_STEPS):
        new = x_1 + part * (x_2 - x_1)
        value = function(new, *rest)
        same = np.sign(value) == np.sign(f_1)
        x_3, f_3 = np.where(same, x_1, x_2), np.where(same, f_1, f_2)
        x_2, f_2 = np.where(same, x_2, x_1), np.where(same, f_2, f_1)
        x_1, f_1 = new, value
        best = np.where(np.abs(f_1) < np.abs(f_2), x_1, x_2)
        found = np.where(settled, found, best)
        width, known = np.abs(x_2 - x_1), _DIGIT * np.abs(best) + _SMALL
        settled |= ((width <= 2.0 * known) | (f_1 == 0.0)) & ~np.isnan(f_1)
        if np.all(settled):
            return found
        # What is settled goes on from its middle, where nothing is divided by nothing.
        with np.errstate(divide="ignore", invalid="ignore"):
            place, level = (x_1 - x_2) / (x_3 - x_2), (f_1 - f_2) / (f_3 - f_2)
            trusted = ~settled & (level**2 < place) & ((1.0 - level) ** 2 < 1.0 - place)
            quadratic = f_1 / (f_2 - f_1) * f_3 / (f_2 - f_3)
            quadratic += (x_3 - x_1) / (x_2 - x_1) * f_1 / (f_3 - f_1) * f_2 / (f_3 - f_2)
            least = np.where(settled, 0.5, known / width)
        part = np.clip(np.where(trusted, quadratic, 0.5), least, 1.0 - least)
    raise RuntimeError(f"root search did not settle in {_STEPS} steps")
