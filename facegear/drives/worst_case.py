"""Where a drive is unstable for some values in its tolerances.

That is found from the tongues at a grid of values, not by drawing values: natural frequencies rise with every
stiffness, and so a tongue moves one way, and has swept all speeds between the places where it stands. They are looked
for in a wider range of speed, wide enough that none can come into the range from outside unseen. How far a tongue goes
that stands at some of the values only is not known: up to the next value of the grid, and there all is left open.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import product
from typing import Any

import numpy as np

from facegear.drives.intervals import Intervals, cut, united
from facegear.drives.tolerances import Toleranced, TolerancedGearbox, Tolerances
from facegear.floquet.models import Model
from facegear.floquet.multipliers import growth_rate
from facegear.maps.closing import ClosingValue, growth_peaks
from facegear.maps.tracing import Tongue, tongues
from facegear.mechanics.pinions_on_disk import FaceGears

# Values along a way at which the largest growth is looked at before its zeros are found.
_ALONG = 5
# Part by which the search goes beyond the speeds from which tongues can come, for what of a frequency no spring makes.
_MARGIN = 1.02
# Growth in a period from which a speed counts as unstable where that of other searches cannot be told.
_COARSE = 1e-7

Factors = tuple[float, ...]


@dataclass(frozen=True)
class WorstCase:
    """Where a drive is unstable for some values in its tolerances.

    Attributes
    ----------
    speeds : tuple of float
        Range looked at, with its tolerance [rad/s].
    points : dict
        What of the tongues lies in that range, by the factors at which they were looked for, in the order of `factors`.
    swept : tuple of tuple of float
        Intervals of speed [rad/s], ascending and apart, in which some value is unstable.
    possible : tuple of tuple of float
        Intervals in which that is so or cannot be excluded; these hold the others.
    opens : tuple of ClosingValue
        Tongues that open between values at which all is stable.
    factors : tuple of str
        What the points have factors of, in words.
    unknown : str
        Why it is not known; empty if it is.
    """

    speeds: tuple[float, float]
    points: dict[Factors, tuple[Tongue, ...]] = field(repr=False)
    swept: Intervals
    possible: Intervals
    opens: tuple[ClosingValue, ...]
    factors: tuple[str, ...] = ("stiffness", "damping")
    unknown: str = ""

    @property
    def is_stable(self) -> bool:
        """Whether all values looked at are stable at all speeds, and no tongue found near can come there."""
        return not self.possible and not self.opens and not self.unknown

    @property
    def fastest(self) -> tuple[Factors, Tongue] | None:
        """Factors of the point that grows fastest, and the tongue in which it does; None where all are stable."""
        grown = [(factors, tongue) for factors, found in self.points.items() for tongue in found]
        return max(grown, key=lambda pair: pair[1].growth_rate, default=None)

    @property
    def share(self) -> float:
        """Part of the range of speed in which some value is unstable, 0 to 1."""
        low, high = self.speeds
        return sum(stop - start for start, stop in self.swept) / (high - low)


def worst_case(model: FaceGears, speeds: tuple[float, float], tolerances: Tolerances) -> WorstCase:
    """Find where a drive is unstable for some values in its tolerances.

    Parameters
    ----------
    model : FaceGears
    speeds : tuple of float
        Lowest and highest operating speed [rad/s].
    tolerances : Tolerances

    Returns
    -------
    WorstCase
        Intervals that tongues of one label sweep which stand at all values looked at; those that others reach may be
        unstable. What stands nowhere near is followed along the edges of the range, and what opens there found.

    Raises
    ------
    TypeError, ValueError, ArithmeticError
        As :func:`facegear.maps.tracing.tongues`.
    """
    parts = {"stiffness": tolerances.stiffness, "damping": tolerances.damping}
    return _in_box(Toleranced(model), parts, tolerances.widened(speeds))


def worst_case_in_torsion(torsional: Any, speeds: tuple[float, float], tolerances: Tolerances) -> WorstCase:
    """As :func:`worst_case`, of a gearbox: mesh and shafts anywhere in their tolerances, each for itself.

    Parameters
    ----------
    torsional : Torsional or HeavyShafts
    speeds : tuple of float
        Lowest and highest operating speed [rad/s].
    tolerances : Tolerances

    Returns
    -------
    WorstCase

    Raises
    ------
    TypeError, ValueError, ArithmeticError
        As :func:`worst_case`, or if the gearbox does not take a value in its tolerance.

    Examples
    --------
    A principal tongue moves with the stiffness of the shafts, and sweeps more than it covers at any of them.

    >>> from facegear.mechanics.gearboxes import FIGURES
    >>> from facegear.support.parameters import rad_per_s
    >>> box, speeds = FIGURES["7.12a"].model(), tuple(rad_per_s([600.0, 700.0]).tolist())
    >>> exact, found = (worst_case_in_torsion(box, speeds, Tolerances(shaft_stiffness=part)) for part in (0.0, 0.05))
    >>> len(found.points), found.share > exact.share > 0.0
    (3, True)
    """
    parts = {
        "mesh stiffness": tolerances.stiffness,
        "mesh damping": tolerances.damping,
        "shaft stiffness": tolerances.shaft_stiffness,
        "shaft damping": tolerances.shaft_damping,
    }
    return _in_box(TolerancedGearbox(torsional), parts, tolerances.widened(speeds))


def not_known(reason: str, speeds: tuple[float, float], tolerances: Tolerances) -> WorstCase:
    """Worst case that could not be computed, and why."""
    wide = tolerances.widened(speeds)
    return WorstCase(wide, {}, (), (wide,), (), (), reason)


def _in_box(model: Any, parts: Mapping[str, float], wide: tuple[float, float]) -> WorstCase:
    """Worst case of a model with a field NAME_factor for each tolerance, named as there in words."""
    names = {words: f"{words.replace(' ', '_')}_factor" for words in parts}

    def at(factors: Sequence[float]) -> Any:
        return replace(model, **dict(zip(names.values(), factors, strict=True)))

    springs = {words: part for words, part in parts.items() if words.endswith("stiffness")}
    levels = [
        tuple(dict.fromkeys([1.0 - part, *([1.0] if words in springs else []), 1.0 + part]))
        for words, part in parts.items()
    ]
    # No frequency changes by more than the root of what the stiffness changes by.
    reach = max(math.sqrt((1.0 + part) / (1.0 - part)) for part in springs.values())
    step = max(math.sqrt(1.0 / (1.0 - part)) for part in springs.values())
    around = wide if reach == 1.0 else (wide[0] / (_MARGIN * reach), wide[1] * _MARGIN * reach)
    points = dict.fromkeys([(1.0,) * len(parts), *product(*levels)])
    found = {point: _tongues(at(point), around) for point in points}

    swept: list[tuple[float, float]] = []
    possible: list[tuple[float, float]] = []
    for label in dict.fromkeys(tongue.label for each in found.values() for tongue in each):
        here = [[t for t in each if t.label == label] for each in found.values()]
        lower, upper = (
            min(t.lower for each in here for t in each),
            max(t.upper for each in here for t in each),
        )
        everywhere = all(here)
        swept += [(lower, upper)] if everywhere else [(t.lower, t.upper) for each in here for t in each]
        possible.append((lower, upper) if everywhere else (lower / step, upper * step))
    inside = cut(united(possible), wide)
    opens: list[ClosingValue] = []
    # Along each edge of the box: more stiffness may open a tongue between two corners, and so may more damping.
    for place, words in enumerate(parts):
        if inside or not parts[words]:
            continue
        way = np.linspace(levels[place][0], levels[place][-1], _ALONG)
        ends = [tuple(dict.fromkeys([each[0], each[-1]])) for each in levels]
        for corner in product(*ends[:place], ends[place][:1], *ends[place + 1 :]):
            opens += growth_peaks(at(corner), names[words], way, wide).closing_values
    return WorstCase(
        wide,
        {point: _within(at(point), each, wide) for point, each in found.items()},
        cut(united(swept), wide),
        inside,
        tuple(opens),
        tuple(parts),
    )


def _tongues(model: Model, speeds: tuple[float, float]) -> tuple[Tongue, ...]:
    """Tongues of one value; one of many may have two multipliers so close together that they are known less well."""
    try:
        return tongues(model, speeds, progress=False)
    except ArithmeticError:
        return tongues(model, speeds, threshold=_COARSE, progress=False)


def _within(model: Model, found: Sequence[Tongue], wide: tuple[float, float]) -> tuple[Tongue, ...]:
    """Cut tongues to a range of speed, with the largest growth there."""
    low, high = wide
    inside = []
    for tongue in found:
        lower, upper, peak = max(tongue.lower, low), min(tongue.upper, high), min(max(tongue.peak, low), high)
        if lower < upper:
            # Growth falls off from its peak: of what lies in the range it is largest at the end next to that.
            growth = tongue.growth_rate if peak == tongue.peak else growth_rate(model.system(peak))
            inside.append(replace(tongue, lower=lower, upper=upper, peak=peak, growth_rate=growth))
    return tuple(inside)
