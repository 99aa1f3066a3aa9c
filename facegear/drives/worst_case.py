"""Where a drive is unstable for some values in its tolerances, and where that is not known.

Found by the cells of :mod:`facegear.drives.tolerance_cells`, not by drawing values.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from facegear.drives.basis import within
from facegear.drives.intervals import Intervals, cut, united
from facegear.drives.tolerance_cells import BoxSearch, Factors, Range
from facegear.drives.tolerances import Toleranced, TolerancedGearbox, Tolerances
from facegear.maps.tracing import Tongue
from facegear.mechanics.pinions_on_disk import FaceGears


@dataclass(frozen=True)
class WorstCase:
    """Where a drive is unstable for some values in its tolerances.

    Attributes
    ----------
    speeds : tuple of float
        Range looked at, with its tolerance [rad/s].
    points : dict
        What of the tongues lies in that range, by the factors at which they were looked for, in the order of `factors`:
        where nothing is unstable, those alone that were looked at over the whole range.
    swept : tuple of tuple of float
        Intervals of speed [rad/s], ascending and apart, in which some value is unstable.
    possible : tuple of tuple of float
        Intervals in which that is so or cannot be excluded; these hold the others.
    looked_at : dict
        Intervals of speed in which each of these points was looked at: some in a part of the range only.
    factors : tuple of str
        What the points have factors of, in words.
    unknown : str
        Why it is not known; empty if it is.
    """

    speeds: tuple[float, float]
    points: dict[Factors, tuple[Tongue, ...]] = field(repr=False)
    swept: Intervals
    possible: Intervals
    looked_at: dict[Factors, Intervals] = field(default_factory=dict, repr=False)
    factors: tuple[str, ...] = ("stiffness", "damping")
    unknown: str = ""

    @property
    def is_stable(self) -> bool:
        """Whether all values looked at are stable at all speeds, and nothing found near them could come there."""
        return not self.possible and not self.unknown

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
        Intervals that tongues sweep which stand at all corners of a cell; those that others may reach, or in which one
        may open inside a cell, are possible only.

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
    >>> 1.0 > found.share > exact.share > 0.0
    True
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
    return WorstCase(wide, {}, (), (wide,), factors=(), unknown=reason)


def _in_box(model: Any, parts: Mapping[str, float], wide: Range) -> WorstCase:
    """Worst case of a model with a field NAME_factor for each tolerance, named as there in words."""
    search = BoxSearch(model, parts, wide)
    search.run()
    return WorstCase(
        wide,
        {
            point: tuple(sorted(within(search.at(point), each, wide), key=lambda tongue: tongue.lower))
            for point, each in search.points.items()
        },
        cut(united(search.swept), wide),
        cut(united(search.possible), wide),
        {point: search.looked_at[point] for point in search.points},
        tuple(parts),
    )
