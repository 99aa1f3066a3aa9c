"""The largest growth rate over speed, and the value of a parameter at which it vanishes.

A thickness (:mod:`facegear.maps.lobes`), a power (:mod:`facegear.design.envelope`) and any parameter at which a tongue
closes (:mod:`facegear.maps.closing`) are critical in the same sense: there the peak of the growth over speed passes
through zero. They differ in how the peak is found at each value: followed from the last one, at one speed, or in the
whole range.
"""

from __future__ import annotations

from collections.abc import Callable

from scipy.optimize import brentq, minimize_scalar

from facegear.floquet.models import Model
from facegear.floquet.multipliers import growth_rate

# Windows that are tried before a peak is given up.
_MOST_WINDOWS = 60


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

    def growth(speed: float) -> float:
        return growth_rate(model.system(speed))

    lowest, highest = speeds
    centre, width = min(max(guess, lowest), highest), window
    for _ in range(_MOST_WINDOWS):
        low, high = max(centre * (1 - width), lowest), min(centre * (1 + width), highest)
        best, value = largest_between(growth, low, high, resolution * centre)
        margin = 0.02 * (high - low)
        ends = [end for end in (low, high) if abs(best - end) < margin]
        if not ends:
            return best, value
        (end,) = ends
        if end in speeds:
            at_end = growth(end)
            return (end, at_end) if at_end >= value else (best, value)
        centre, width = best, min(2 * width, widest)
    raise ArithmeticError(f"no largest growth rate near {guess:.6g} rad/s: the instability was lost")
