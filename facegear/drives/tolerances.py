"""Tolerances of a drive: stiffness and damping anywhere in a range, shafts included, speeds beyond the operating ones.

Where a drive is unstable for some values of a range is found from the borders of its tongues, not by drawing values: a
tongue that stands at both ends of a way through the range has swept all speeds between, and where both ends are stable
the largest growth rate is followed along the way, zeros of it that touch and turn back included.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from itertools import combinations, product
from typing import Any

import numpy as np

from facegear.drives.contacts import massless, path_to_massless
from facegear.drives.intervals import united
from facegear.floquet.models import (
    Coordinate,
    parameter_names,
    replace_at,
    replace_parameter,
    system_at,
    value_of,
)
from facegear.floquet.periodic import PeriodicSystem
from facegear.maps.closing import ClosingValue, growth_peaks
from facegear.maps.tracing import Tongue, tongues
from facegear.mechanics.contact import Contact
from facegear.mechanics.disk import reference_stiffness
from facegear.mechanics.transverse import FaceGears
from facegear.support.parameters import keep, positive, within

# Powers of the factors of stiffness and of damping by which parameters besides the bearing's change. Damping of teeth
# is a time, over their stiffness: to keep it while stiffness changes takes its inverse.
_POWERS = {"mesh_stiffness": (1, 0), "mesh_damping": (-1, 1), "body.material.viscous_loss_factor": (0, 1)}
_MOST = 0.5
_OF_SHAFTS = ("shaft_stiffness", "shaft_damping")
# Values along a way at which the largest growth is looked at before its zeros are found.
_ALONG = 5


@dataclass(frozen=True)
class Tolerances:
    """How far values of a drive may be from those of its file, as parts of these.

    Attributes
    ----------
    stiffness : float
        Of bearings and teeth, together, and of the mesh of the gearbox [-], 0 to 0.5. Teeth are flexible ones, and
        those by which a contact under load is found, with c_f of (7-2) up to 1.
    damping : float
        Of bearings, flexible teeth and the body's material, together, and of the mesh of the gearbox [-], 0 to 0.5.
    speed : float
        By which the lowest operating speed may be undershot and the highest exceeded [-], 0 to 0.5.
    shaft_stiffness, shaft_damping : float
        Of both shafts of the gearbox, together [-], 0 to 0.5.

    Raises
    ------
    TypeError, ValueError
        If one is no number in its range.
    """

    stiffness: float = 0.0
    damping: float = 0.0
    speed: float = 0.0
    shaft_stiffness: float = 0.0
    shaft_damping: float = 0.0

    def __post_init__(self) -> None:
        for name in (each.name for each in fields(self)):
            keep(self, **{name: within(name, getattr(self, name), 0.0, _MOST)})

    @property
    def given(self) -> bool:
        """Whether there is any for the motion of the disk."""
        return any((self.stiffness, self.damping, self.speed))

    @property
    def given_in_torsion(self) -> bool:
        """Whether there is any for a gearbox, besides that of speed."""
        return any((self.stiffness, self.damping, self.shaft_stiffness, self.shaft_damping))

    def require_shafts(self, has_shafts: bool) -> None:
        """Refuse tolerances of shafts where there are none.

        Raises
        ------
        ValueError
            Naming the first of them.
        """
        for name in () if has_shafts else _OF_SHAFTS:
            if part := getattr(self, name):
                raise ValueError(
                    f"{name} must be 0 or left out without a section gearbox, whose shafts it is about, got "
                    f"{100 * part:g}"
                )

    def widened(self, speeds: tuple[float, float]) -> tuple[float, float]:
        """Range of speed with its tolerance [rad/s]."""
        return speeds[0] * (1.0 - self.speed), speeds[1] * (1.0 + self.speed)


AS_GIVEN = Tolerances()
"""No tolerances."""


def _with_stiffer_teeth(contact: Contact, factor: float) -> Contact:
    """Return a contact as it is with teeth so many times as stiff; only under load it depends on that."""
    if (own := getattr(contact.path, "correction_factor", None)) is None:
        return contact
    # Without bodies and bearings that give way, teeth are as stiff as they are.
    path: Any = replace(contact.path, correction_factor=min(1.0, factor * own))  # type: ignore[type-var]
    return replace(contact, path=path)


@dataclass(frozen=True)
class Toleranced:
    """A drive with other stiffness and damping.

    Parameters
    ----------
    model : FaceGears
    stiffness_factor : float
        Of bearings and teeth; dampings keep their values in N s/m. A contact under load changes with its teeth, which
        are at most as stiff as c_f = 1 of (7-2) has it.
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
        gear = replace(gear, contact=_with_stiffer_teeth(gear.contact, self.stiffness_factor))
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
class TolerancedGearbox:
    """A gearbox whose mesh and shafts have other stiffness and damping.

    Parameters
    ----------
    torsional : Torsional or HeavyShafts
        Shafts that have mass keep their length: stiffer ones are thicker, and heavier in proportion.
    mesh_stiffness_factor, shaft_stiffness_factor : float
        Of the tooth pairs and of both shafts; dampings keep their values in N s/m and N m s/rad. A contact under load
        changes with its tooth pairs, as for :class:`Toleranced`.
    mesh_damping_factor, shaft_damping_factor : float
        Of the tooth pairs and of both shafts.

    Raises
    ------
    TypeError, ValueError
        If a factor is no number greater than 0, or the gearbox does not take what it makes.
    """

    torsional: Any
    mesh_stiffness_factor: float = 1.0
    mesh_damping_factor: float = 1.0
    shaft_stiffness_factor: float = 1.0
    shaft_damping_factor: float = 1.0

    def __post_init__(self) -> None:
        for name in (each.name for each in fields(self)[1:]):
            keep(self, **{name: positive(name, getattr(self, name))})

    @cached_property
    def changed(self) -> Any:
        """The gearbox with the factors put in."""
        inside, box = path_to_massless(self.torsional), massless(self.torsional).gearbox.in_si
        factors = {
            "mesh_stiffness": self.mesh_stiffness_factor,
            "mesh_damping": self.mesh_damping_factor,
            **{f"{shaft}_stiffness": self.shaft_stiffness_factor for shaft in ("input", "output")},
            **{f"{shaft}_damping": self.shaft_damping_factor for shaft in ("input", "output")},
        }
        gearbox = replace(box, **{name: factor * getattr(box, name) for name, factor in factors.items()})
        changed = replace_at(self.torsional, (*inside, "gearbox"), gearbox)
        contact = _with_stiffer_teeth(massless(changed).contact, self.mesh_stiffness_factor)
        return replace_at(changed, (*inside, "contact"), contact)

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Those of the gearbox."""
        found: tuple[Coordinate, ...] = self.torsional.coordinates
        return found

    def system(self, speed: float) -> PeriodicSystem:
        """Equations of motion at a constant speed [rad/s]."""
        return system_at(self.changed, speed)


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
