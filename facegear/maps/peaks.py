"""The largest growth rate near a speed, followed to where it has moved."""

from __future__ import annotations

from scipy.optimize import minimize_scalar

from facegear.floquet.models import Model
from facegear.floquet.multipliers import Method, growth_rate

# Windows that are tried before a peak is given up.
_MOST_WINDOWS = 60


def growth_peak(
    model: Model,
    method: Method | None,
    guess: float,
    speed_range: tuple[float, float],
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
    method : Method or None
        For the transition matrices; see :func:`facegear.floquet.multipliers.with_method` for None.
    guess : float
        [rad/s]
    speed_range : tuple of float
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
        return growth_rate(model.system(speed), method)

    lowest, highest = speed_range
    centre, width = min(max(guess, lowest), highest), window
    for _ in range(_MOST_WINDOWS):
        low, high = max(centre * (1 - width), lowest), min(centre * (1 + width), highest)
        result = minimize_scalar(
            lambda speed: -growth(speed),
            bounds=(low, high),
            method="bounded",
            options={"xatol": resolution * centre},
        )
        best, value = float(result.x), -float(result.fun)
        margin = 0.02 * (high - low)
        ends = [end for end in (low, high) if abs(best - end) < margin]
        if not ends:
            return best, value
        (end,) = ends
        if end in speed_range:
            at_end = growth(end)
            return (end, at_end) if at_end >= value else (best, value)
        centre, width = best, min(2 * width, widest)
    raise ArithmeticError(f"no largest growth rate near {guess:.6g} rad/s: the instability was lost")
