"""Values of a parameter at which a tongue closes or opens: every one of a range.

More damping does not always make a drive safer. A shaft's damper that is strong enough holds the shaft still instead
of taking energy from it, and a tongue that was closed opens again. So the largest growth rate over a range of speed is
followed along the whole range of the parameter, and every change of its sign is brought to a root.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from facegear.floquet.labels import Combination, combination
from facegear.floquet.methods import Method
from facegear.floquet.models import Model, parameter_path, replace_parameter
from facegear.floquet.multiplier_curves import MultiplierCurve
from facegear.maps.peaks import Peak, critical_value, largest_between
from facegear.support.parameters import ascending, finite_array
from facegear.support.threads import one_thread
from facegear.support.types import FloatArray

# Speeds at which the growth is looked at before its largest values are refined.
_SPEEDS = 513
_REFINED = 3
# Relative accuracy of the speed of a peak, and of a root.
_PEAK = 1e-9
_ROOT = 1e-8
# A root whose peak lies so close to an end of the range of speed, relative to its width, belongs to something outside.
_EDGE = 1e-4


@dataclass(frozen=True)
class ClosingValue:
    """Value of a parameter at which the largest growth rate in a range of speed passes through zero.

    Attributes
    ----------
    value : float
        Value, in the parameter's unit.
    speed : float
        Speed of the largest growth there [rad/s].
    closes : bool
        Whether the tongue is open below the value and closed above it; otherwise it opens.
    combination : Combination
        Modes and order of the resonance.
    """

    value: float
    speed: float
    closes: bool
    combination: Combination = field(repr=False)

    @property
    def label(self) -> str:
        """Modes and order, as :attr:`facegear.maps.tracing.Tongue.label`."""
        return self.combination.label


@dataclass(frozen=True, eq=False)
class GrowthPeaks:
    """Largest growth rate in a range of speed along a parameter.

    Attributes
    ----------
    values : array, shape (V,)
        Values of the parameter, ascending.
    speeds : array, shape (V,)
        Speed of the largest growth rate at each [rad/s].
    growth_rates : array, shape (V,)
        Largest growth rate [1/s], negative where the whole range is stable.
    closing_values : tuple of ClosingValue
        Every value between the first and the last at which it passes through zero, ascending.
    """

    values: FloatArray
    speeds: FloatArray
    growth_rates: FloatArray
    closing_values: tuple[ClosingValue, ...]


@one_thread()
def largest_growth(model: Model, speeds: ArrayLike, method: Method | None = None) -> tuple[float, float]:
    """Find the largest growth rate of a model in a range of speed, whether it is positive or not.

    Parameters
    ----------
    model : Model
    speeds : (low, high)
        Range looked at [rad/s], both ends included. A peak narrower than its five hundredth part may be missed.
    method : Method, optional
        As for :func:`facegear.maps.tracing.tongues`.

    Returns
    -------
    speed, growth_rate : float
        [rad/s] and [1/s].

    Raises
    ------
    TypeError, ValueError
        If the range is empty or not positive.
    ArithmeticError
        If transition matrices do not vary smoothly with speed.
    """
    low, high = ascending("speeds", speeds, "rad/s")
    curve = MultiplierCurve.of(model, low, high, method)
    # The growth in a period over the period, which is in inverse proportion to speed.
    per_second = 1.0 / (model.system(low).period * low)

    def growth(at: FloatArray) -> FloatArray:
        return np.asarray(np.log(curve.spectral_radii(at)) * at * per_second, dtype=float)

    grid = np.linspace(low, high, _SPEEDS)
    sampled = growth(grid)
    best = int(sampled.argmax())
    peak, largest = float(grid[best]), float(sampled[best])
    inner = np.flatnonzero((sampled[1:-1] >= sampled[:-2]) & (sampled[1:-1] >= sampled[2:])) + 1
    for i in inner[np.argsort(-sampled[inner])][:_REFINED].tolist():
        speed, value = largest_between(
            lambda speed: float(growth(np.array([speed]))[0]),
            float(grid[i - 1]),
            float(grid[i + 1]),
            _PEAK * high,
        )
        if value > largest:
            peak, largest = speed, value
    return peak, largest


def growth_peaks(
    model: Model,
    parameter: str,
    values: ArrayLike,
    speeds: ArrayLike,
    *,
    method: Method | None = None,
) -> GrowthPeaks:
    """Follow the largest growth rate in a range of speed along a parameter, and find every zero of it.

    Parameters
    ----------
    model : Model
        A frozen dataclass with a method ``system(speed)``.
    parameter : str
        Name as for :func:`facegear.floquet.models.replace_parameter`.
    values : array_like, shape (V,)
        Values of the parameter, ascending, at least three. Between them a zero is found where the sign changes, and
        where a parabola through three of them comes near enough to zero to touch it.
    speeds : (low, high)
        Range of speed [rad/s] that holds the tongue wherever the parameter takes it, and no other one.
    method : Method, optional
        As for :func:`facegear.maps.tracing.tongues`.

    Returns
    -------
    GrowthPeaks

    Raises
    ------
    TypeError, ValueError
        If the values do not ascend, a range is not valid, or there is no such parameter.
    ArithmeticError
        If a tongue leaves the range of speed while it closes, or as :func:`largest_growth`.
    """
    low, high = ascending("speeds", speeds, "rad/s")
    axis = finite_array("values", values)
    if axis.ndim != 1 or axis.size < 3 or (np.diff(axis) <= 0.0).any():
        raise ValueError(f"values must be at least three, ascending; got {values!r}")
    parameter_path(model, parameter)

    def peak(value: float) -> tuple[float, float]:
        return largest_growth(replace_parameter(model, parameter, value), (low, high), method)

    sampled = [peak(value) for value in axis.tolist()]
    places, growth = (np.array(part) for part in zip(*sampled, strict=True))
    closing = []
    for value, speed in _zeros(peak, axis, growth):
        if min(speed - low, high - speed) < _EDGE * (high - low):
            raise ArithmeticError(
                f"at {parameter} = {value:.6g} the largest growth is at an end of the range of speed, {speed:.6g} "
                "rad/s: widen the range so that it holds the whole tongue"
            )
        below = growth[np.searchsorted(axis, value) - 1]
        closing.append((value, speed, below))
    named = []
    for number, (value, speed, below) in enumerate(closing):
        # Two zeros between the same samples: the second undoes the first.
        again = number > 0 and np.searchsorted(axis, closing[number - 1][0]) == np.searchsorted(axis, value)
        system = replace_parameter(model, parameter, value).system(speed)
        named.append(ClosingValue(value, speed, bool((below > 0.0) != again), combination(system, method)))
    return GrowthPeaks(axis, places, growth, tuple(named))


def _below(peak: Peak, sign: float, value: float) -> float:
    """Growth rate at a value, so turned that one of the sign lies below zero."""
    return -sign * peak(value)[1]


def _zeros(peak: Peak, axis: FloatArray, values: FloatArray) -> list[tuple[float, float]]:
    """All zeros between samples and their speeds, those of extremes that cross zero between two samples among them."""
    points = dict(zip(axis.tolist(), values.tolist(), strict=True))
    for i in range(1, axis.size - 1):
        sign = np.sign(values[i])
        three = sign * values[i - 1 : i + 2]
        if not (three > 0.0).all() or three[1] > min(three[0], three[2]):
            continue
        # A parabola through three samples dips at most by an eighth of its bend below the middle one.
        if three[1] - (three[0] + three[2] - 2.0 * three[1]) > 0.0:
            continue
        low, high = float(axis[i - 1]), float(axis[i + 1])
        value, height = largest_between(partial(_below, peak, sign), low, high, 1e-6 * (high - low))
        points[value] = float(-sign * height)
    places = np.array(sorted(points))
    heights = np.array([points[place] for place in places.tolist()])
    zeros = []
    for i in np.flatnonzero(np.sign(heights[:-1]) * np.sign(heights[1:]) <= 0.0).tolist():
        if heights[i + 1] == 0.0 and i + 2 < places.size:
            continue  # The next interval begins with this zero.
        a, b = float(places[i]), float(places[i + 1])
        zeros.append(critical_value(peak, a, b, xtol=_ROOT * abs(b), rtol=_ROOT))
    return zeros
