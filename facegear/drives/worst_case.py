"""Where a drive is unstable for some values in its tolerances.

That is found from the borders of its tongues, not by drawing values: a tongue that stands at both ends of a way through
the range has swept all speeds between, and where both ends are stable the largest growth rate is followed along the
way, zeros of it that touch and turn back included.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import combinations, product
from typing import Any

import numpy as np

from facegear.drives.intervals import united
from facegear.drives.tolerances import Toleranced, TolerancedGearbox, Tolerances
from facegear.maps.closing import ClosingValue, growth_peaks
from facegear.maps.tracing import Tongue, tongues
from facegear.mechanics.pinions_on_disk import FaceGears

# Values along a way at which the largest growth is looked at before its zeros are found.
_ALONG = 5


@dataclass(frozen=True)
class WorstCase:
    """Where a drive is unstable for some values in its tolerances.

    Attributes
    ----------
    speeds : tuple of float
        Range looked at, with its tolerance [rad/s].
    corners : dict
        Tongues by the factors, in the order of `factors`.
    swept : tuple of tuple of float
        Intervals of speed [rad/s], ascending and apart, in which some value is unstable.
    opens : tuple of ClosingValue
        Tongues that open between two stable corners.
    factors : tuple of str
        What the corners have factors of, in words.
    unknown : str
        Why it is not known; empty if it is.
    """

    speeds: tuple[float, float]
    corners: dict[tuple[float, ...], tuple[Tongue, ...]] = field(repr=False)
    swept: tuple[tuple[float, float], ...]
    opens: tuple[ClosingValue, ...]
    factors: tuple[str, ...] = ("stiffness", "damping")
    unknown: str = ""

    @property
    def is_stable(self) -> bool:
        """Whether all values are known to be stable at all speeds."""
        return not self.swept and not self.opens and not self.unknown

    @property
    def fastest(self) -> tuple[tuple[float, ...], Tongue] | None:
        """Factors of the corner that grows fastest, and the tongue in which it does; None where all are stable."""
        grown = [(factors, tongue) for factors, found in self.corners.items() for tongue in found]
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
        What tongues sweep that stand, with one label, at both ends of a way between two corners, and what opens along
        the edges between corners that are all stable.

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
    >>> len(found.corners), found.share > exact.share > 0.0
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
    return WorstCase(tolerances.widened(speeds), {}, (), (), (), reason)


def _in_box(model: Any, parts: Mapping[str, float], wide: tuple[float, float]) -> WorstCase:
    """Worst case of a model with a field NAME_factor for each tolerance, named as there in words."""
    names = {words: f"{words.replace(' ', '_')}_factor" for words in parts}

    def at(factors: Sequence[float]) -> Any:
        return replace(model, **dict(zip(names.values(), factors, strict=True)))

    ends = [tuple(dict.fromkeys((1.0 - part, 1.0 + part))) for part in parts.values()]
    corners = dict.fromkeys([(1.0,) * len(parts), *product(*ends)])
    found = {corner: tongues(at(corner), wide) for corner in corners}
    intervals = [(tongue.lower, tongue.upper) for part in found.values() for tongue in part]
    for first, second in combinations(found.values(), 2):
        intervals += _between(first, second)
    opens: list[ClosingValue] = []
    # Along each edge of the box: more stiffness may open a tongue between two corners, and so may more damping.
    for place, words in enumerate(parts):
        if intervals or not parts[words]:
            continue
        way = np.linspace(ends[place][0], ends[place][-1], _ALONG)
        for corner in product(*ends[:place], ends[place][:1], *ends[place + 1 :]):
            opens += growth_peaks(at(corner), names[words], way, wide).closing_values
    return WorstCase(wide, found, united(intervals), tuple(opens), tuple(parts))


def _between(first: Sequence[Tongue], second: Sequence[Tongue]) -> list[tuple[float, float]]:
    """Return what tongues sweep on their way from one corner to another."""
    swept = []
    for label in dict.fromkeys(tongue.label for tongue in first):
        here, there = ([t for t in part if t.label == label] for part in (first, second))
        # Tongues of one label keep their order along speed; where their numbers differ it is not known which is which.
        if len(here) == len(there):
            swept += [
                (min(a.lower, b.lower), max(a.upper, b.upper)) for a, b in zip(here, there, strict=True)
            ]
    return swept
