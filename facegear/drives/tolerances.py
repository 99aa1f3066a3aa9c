"""Tolerances of a drive: stiffness and damping anywhere in a range, speeds beyond the operating ones.

Where a drive is unstable for some values of a range is found from the borders of its tongues, not by drawing values: a
tongue that stands at both ends of a way through the range has swept all speeds between, and where both ends are stable
the largest growth rate is followed along the way, zeros of it that touch and turn back included.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import combinations

import numpy as np

from facegear.drives.intervals import united
from facegear.floquet.models import Coordinate, parameter_names, replace_parameter, value_of
from facegear.floquet.periodic import PeriodicSystem
from facegear.maps.closing import ClosingValue, growth_peaks
from facegear.maps.tracing import Tongue, tongues
from facegear.mechanics.disk import reference_stiffness
from facegear.mechanics.transverse import FaceGears
from facegear.support.parameters import keep, positive, within

# Powers of the factors of stiffness and of damping by which parameters besides the bearing's change. Damping of teeth
# is a time, over their stiffness: to keep it while stiffness changes takes its inverse.
_POWERS = {"mesh_stiffness": (1, 0), "mesh_damping": (-1, 1), "body.material.viscous_loss_factor": (0, 1)}
_MOST = 0.5
# Values along a way at which the largest growth is looked at before its zeros are found.
_ALONG = 5


@dataclass(frozen=True)
class Tolerances:
    """How far values of a drive may be from those of its file, as parts of these.

    Attributes
    ----------
    stiffness : float
        Of bearings and flexible teeth, together [-], 0 to 0.5.
    damping : float
        Of bearings, flexible teeth and the body's material, together [-], 0 to 0.5.
    speed : float
        By which the lowest operating speed may be undershot and the highest exceeded [-], 0 to 0.5.

    Raises
    ------
    TypeError, ValueError
        If one is no number in its range.
    """

    stiffness: float = 0.0
    damping: float = 0.0
    speed: float = 0.0

    def __post_init__(self) -> None:
        for name in ("stiffness", "damping", "speed"):
            keep(self, **{name: within(name, getattr(self, name), 0.0, _MOST)})

    @property
    def given(self) -> bool:
        """Whether there is any."""
        return (self.stiffness, self.damping, self.speed) != (0.0, 0.0, 0.0)

    def widened(self, speeds: tuple[float, float]) -> tuple[float, float]:
        """Range of speed with its tolerance [rad/s]."""
        return speeds[0] * (1.0 - self.speed), speeds[1] * (1.0 + self.speed)

    @property
    def corners(self) -> tuple[tuple[float, float], ...]:
        """Factors of stiffness and damping in the middle and at the corners of the range."""
        stiffness, damping = (
            dict.fromkeys((1.0 - part, 1.0 + part)) for part in (self.stiffness, self.damping)
        )
        return tuple(dict.fromkeys([(1.0, 1.0), *((s, d) for s in stiffness for d in damping)]))


AS_GIVEN = Tolerances()
"""No tolerances."""


@dataclass(frozen=True)
class Toleranced:
    """A drive with other stiffness and damping.

    Parameters
    ----------
    model : FaceGears
    stiffness_factor : float
        Of bearings and flexible teeth; dampings keep their values in N s/m.
    damping_factor : float
        Of bearings, flexible teeth and the material of the body.

    Raises
    ------
    TypeError, ValueError
        If a factor is no number greater than 0.
    """

    model: FaceGears
    stiffness_factor: float = 1.0
    damping_factor: float = 1.0

    def __post_init__(self) -> None:
        for name in ("stiffness_factor", "damping_factor"):
            keep(self, **{name: positive(name, getattr(self, name))})

    @cached_property
    def changed(self) -> FaceGears:
        """The drive with the factors put in."""
        gear, bearing = self.model.gear, self.model.gear.bearing_stiffness
        for name in parameter_names(gear):
            if name in _POWERS:
                s, d = _POWERS[name]
                factor = self.stiffness_factor**s * self.damping_factor**d
                gear = replace_parameter(gear, name, factor * value_of(gear, name))
        # The disk's stiffness by which a bearing is measured moves with its damping, if little.
        load = replace(
            gear.load,
            stiffness=self.stiffness_factor * bearing / reference_stiffness(gear.body),
            damping=gear.load.damping * self.damping_factor / self.stiffness_factor,
        )
        gear = replace(gear, load=load)
        return self.model.with_gear(gear)

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Those of the drive."""
        return self.model.coordinates

    def system(self, speed: float) -> PeriodicSystem:
        """Equations of motion at a constant speed [rad/s]."""
        return self.changed.system(speed)


@dataclass(frozen=True)
class WorstCase:
    """Where a drive is unstable for some values in its tolerances.

    Attributes
    ----------
    speeds : tuple of float
        Range looked at, with its tolerance [rad/s].
    corners : dict
        Tongues by the factors of stiffness and damping.
    swept : tuple of tuple of float
        Intervals of speed [rad/s], ascending and apart, in which some value is unstable.
    opens : tuple of ClosingValue
        Tongues that open between two stable corners.
    """

    speeds: tuple[float, float]
    corners: dict[tuple[float, float], tuple[Tongue, ...]] = field(repr=False)
    swept: tuple[tuple[float, float], ...]
    opens: tuple[ClosingValue, ...]

    @property
    def is_stable(self) -> bool:
        """Whether all values are stable at all speeds."""
        return not self.swept and not self.opens

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
        ways between corners that are stable.

    Raises
    ------
    TypeError, ValueError, ArithmeticError
        As :func:`facegear.maps.tracing.tongues`.
    """
    wide = tolerances.widened(speeds)
    found = {corner: tongues(Toleranced(model, *corner), wide) for corner in tolerances.corners}
    intervals = [(tongue.lower, tongue.upper) for part in found.values() for tongue in part]
    for first, second in combinations(found.values(), 2):
        intervals += _between(first, second)
    opens: list[ClosingValue] = []
    if not intervals and tolerances.stiffness:
        ends = (1.0 - tolerances.stiffness, 1.0 + tolerances.stiffness)
        for damping in dict.fromkeys((1.0 - tolerances.damping, 1.0 + tolerances.damping)):
            way = np.linspace(*ends, _ALONG)
            start = Toleranced(model, ends[0], damping)
            opens += growth_peaks(start, "stiffness_factor", way, wide).closing_values
    return WorstCase(wide, found, united(intervals), tuple(opens))


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
