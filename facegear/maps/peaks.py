"""The largest growth rate over speed, and the value of a parameter at which it vanishes.

A thickness (:mod:`facegear.maps.lobes`), a power (:mod:`facegear.design.envelope`) and any parameter at which a tongue
closes (:mod:`facegear.maps.closing`) are critical in the same sense: there the peak of the growth over speed passes
through zero. They differ in how the peak is found at each value: followed from the last one, at one speed, or in the
whole range.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from facegear.floquet.compiled import LANES
from facegear.floquet.eigenvalues import spectral_radii
from facegear.floquet.error_estimates import rounding_error
from facegear.floquet.methods import Method, with_method
from facegear.floquet.models import Model
from facegear.floquet.multipliers import growth_rate
from facegear.floquet.series import ChebyshevSeries
from facegear.floquet.stepping import Family
from facegear.maps.likeness import same_layout
from facegear.support.types import FloatArray

# Windows that are tried before a peak is given up.
_MOST_WINDOWS = 60
# Degree of the series of transition matrices in a window, and size of its last coefficients, relative to the largest
# entry or 1, at which it is believed.
_DEGREE, _TOLERANCE = 8, 1e-11


Peak = Callable[[float], tuple[float, float]]
"""Value of a parameter to the speed [rad/s] of the largest growth rate and that growth rate [1/s]."""


def critical_value(peak: Peak, low: float, high: float, **accuracy: float) -> tuple[float, float]:
    """Find the value of a parameter between two at which the largest growth rate over speed is zero.

    Parameters
    ----------
    peak : callable
        See :data:`Peak`.
    low, high : float
        Values at which its growth rates have different signs.
    **accuracy : float
        Of the value, absolute and relative: `xtol` and `rtol` of :func:`scipy.optimize.brentq`.

    Returns
    -------
    value, speed : float
        In the parameter's unit, and the speed of the largest growth rate there [rad/s].

    Raises
    ------
    ValueError
        If the signs are the same.

    Examples
    --------
    >>> critical_value(lambda value: (10.0 + value, 4.0 - value**2), 0.0, 3.0)
    (2.0, 12.0)
    """
    value = float(brentq(lambda value: peak(value)[1], low, high, **accuracy))
    return value, peak(value)[0]


def largest_between(
    function: Callable[[float], float], low: float, high: float, resolution: float
) -> tuple[float, float]:
    """Find the maximum of a function that has one between two arguments, to a resolution of the argument.

    Returns
    -------
    argument, value : float
    """
    found = minimize_scalar(
        lambda argument: -function(argument),
        bounds=(low, high),
        method="bounded",
        options={"xatol": resolution},
    )
    return float(found.x), -float(found.fun)


def _peak_between(model: Model, low: float, high: float, resolution: float) -> tuple[float, float]:
    """Speed between two close ones [rad/s] at which the growth rate is largest, and the growth rate there [1/s].

    Transition matrices are computed together at a few values of the slowness 1/speed and interpolated, if they are as
    smooth as that, else at each speed that is asked for.
    """
    slowness = ChebyshevSeries.points_of(1.0 / high, 1.0 / low, _DEGREE)
    systems = [model.system(1.0 / x) for x in slowness.tolist()]

    def interpolated(method: Method) -> ChebyshevSeries | None:
        family = Family(systems)
        series = ChebyshevSeries(1.0 / high, 1.0 / low, method.scaled_transition_matrices(family))
        rounding = rounding_error(np.eye(len(family.scale)), family, method)
        return series if series.tail <= max(_TOLERANCE, 4.0 * rounding) else None

    alike = all(same_layout(systems[0], other) for other in systems[1:])
    matrices = with_method(None, interpolated) if alike else None
    if matrices is None:
        return largest_between(lambda speed: growth_rate(model.system(speed)), low, high, resolution)
    periods = ChebyshevSeries(1.0 / high, 1.0 / low, np.array([system.period for system in systems]))

    def growth(speeds: FloatArray) -> FloatArray:
        with np.errstate(divide="ignore"):
            return np.asarray(np.log(spectral_radii(matrices(1.0 / speeds))) / periods(1.0 / speeds))

    speeds = np.linspace(low, high, LANES)
    rates = growth(speeds)
    best = int(rates.argmax())
    first, last = speeds[[max(best - 1, 0), min(best + 1, LANES - 1)]].tolist()
    found = largest_between(lambda speed: float(growth(np.array([speed]))[0]), first, last, resolution)
    return max(found, (float(speeds[best]), float(rates[best])), key=lambda peak: peak[1])


def growth_peak(
    model: Model,
    guess: float,
    speeds: tuple[float, float],
    *,
    window: float,
    widest: float,
    resolution: float,
) -> tuple[float, float]:
    """Speed near a guess at which the growth rate is largest, and the growth rate there.

    A peak is looked for in a window around the guess; one at its end is followed with another window around that.

    Parameters
    ----------
    model : Model
    guess : float
        [rad/s]
    speeds : tuple of float
        Lowest and highest speed [rad/s]. The growth at an end may be the largest.
    window, widest : float
        Half width of the first window, in parts of its middle; it doubles with each further one up to the widest.
    resolution : float
        Of the speed found, in parts of the middle of the window.

    Returns
    -------
    speed, growth_rate : float
        [rad/s], [1/s].

    Raises
    ------
    ArithmeticError
        If the peak always lies at an end of its window.
    """
    lowest, highest = speeds
    centre, width = min(max(guess, lowest), highest), window
    for _ in range(_MOST_WINDOWS):
        low, high = max(centre * (1 - width), lowest), min(centre * (1 + width), highest)
        best, value = _peak_between(model, low, high, resolution * centre)
        margin = 0.02 * (high - low)
        ends = [end for end in (low, high) if abs(best - end) < margin]
        if not ends:
            return best, value
        (end,) = ends
        if end in speeds:
            at_end = growth_rate(model.system(end))
            return (end, at_end) if at_end >= value else (best, value)
        centre, width = best, min(2 * width, widest)
    raise ArithmeticError(f"no largest growth rate near {guess:.6g} rad/s: the instability was lost")
