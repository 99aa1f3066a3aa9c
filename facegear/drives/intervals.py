"""Intervals of speed: united, what lies between them, and in words."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from facegear.support.parameters import rad_per_s, rpm

Intervals = tuple[tuple[float, float], ...]
"""Lower and upper ends."""


def united(intervals: Sequence[tuple[float, float]]) -> Intervals:
    """Unite intervals that overlap or touch; ascending.

    Examples
    --------
    >>> united([(3.0, 4.0), (1.0, 2.0), (1.5, 3.0)])
    ((1.0, 4.0),)
    """
    found: list[tuple[float, float]] = []
    for start, stop in sorted(intervals):
        if found and start <= found[-1][1]:
            found[-1] = (found[-1][0], max(stop, found[-1][1]))
        else:
            found.append((start, stop))
    return tuple(found)


def gaps(intervals: Sequence[tuple[float, float]], speeds: tuple[float, float]) -> Intervals:
    """Return what a range has besides intervals that are apart and ascend.

    Examples
    --------
    >>> gaps([(2.0, 3.0), (4.0, 5.0)], (1.0, 5.0))
    ((1.0, 2.0), (3.0, 4.0))
    """
    low, high = speeds
    edges = [low, *(edge for interval in intervals for edge in interval), high]
    pairs = zip(edges[::2], edges[1::2], strict=True)
    found = ((max(start, low), min(stop, high)) for start, stop in pairs)
    return tuple((start, stop) for start, stop in found if stop > start)


def cut(intervals: Sequence[tuple[float, float]], speeds: tuple[float, float]) -> Intervals:
    """Return what of intervals that are apart and ascend lies in a range.

    Examples
    --------
    >>> cut([(0.5, 1.5), (2.0, 3.0), (4.5, 6.0)], (1.0, 5.0))
    ((1.0, 1.5), (2.0, 3.0), (4.5, 5.0))
    """
    low, high = speeds
    found = ((max(start, low), min(stop, high)) for start, stop in intervals)
    return tuple((start, stop) for start, stop in found if stop > start)


def inward(intervals: Sequence[tuple[float, float]]) -> Intervals:
    """Shrink intervals [rad/s] to ends that four digits in rpm show as they are: of what is called stable none is more.

    Examples
    --------
    >>> from facegear.support.parameters import rad_per_s
    >>> in_rpm(inward([(rad_per_s(70.001), rad_per_s(70.002)), (rad_per_s(97.331), rad_per_s(1028.7))]), 9)
    '97.34 to 1028 rpm'
    """

    def shown(speed: float, rounded: Callable[[float], int], slack: float) -> float:
        # An end that is shown as it is stays, rounding aside.
        digit = 10.0 ** (math.floor(math.log10(rpm(speed))) - 3)
        return float(rad_per_s(rounded(rpm(speed) / digit + slack) * digit))

    ends = [(shown(start, math.ceil, -1e-6), shown(stop, math.floor, 1e-6)) for start, stop in intervals]
    return tuple((low, high) for low, high in ends if low < high)


def in_rpm(intervals: Sequence[tuple[float, float]], most: int) -> str:
    """Intervals of speed [rad/s] in rpm: the widest by their ends, at most so many, and how many there are besides.

    Examples
    --------
    >>> from facegear.support.parameters import rad_per_s
    >>> in_rpm([(rad_per_s(100.0), rad_per_s(200.0)), (rad_per_s(300.0), rad_per_s(310.0))], 1)
    '100 to 200 rpm and 1 narrower interval'
    """
    widest = sorted(sorted(intervals, key=lambda ends: ends[0] - ends[1])[:most])
    named = ", ".join(f"{rpm(start):.4g} to {rpm(stop):.4g}" for start, stop in widest)
    rest = len(intervals) - len(widest)
    others = f" and {rest} narrower {'interval' if rest == 1 else 'intervals'}" if rest else ""
    return f"{named} rpm{others}"
