"""Tolerances of a drive: stiffness and damping anywhere in a range, shafts included, and speeds beyond the operating.

What is unstable for some values of a range is found in :mod:`facegear.drives.worst_case`.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any

from facegear.drives.contacts import massless, path_to_massless
from facegear.floquet.models import (
    Coordinate,
    parameter_names,
    replace_at,
    replace_parameter,
    system_at,
    value_of,
)
from facegear.floquet.periodic import PeriodicSystem
from facegear.mechanics.contact import Contact
from facegear.mechanics.disk import reference_stiffness
from facegear.mechanics.pinions_on_disk import FaceGears
from facegear.support.parameters import keep, positive, within

# Powers of the factors of stiffness and of damping by which parameters besides the bearing's change. Damping of teeth
# is a time, over their stiffness: to keep it while stiffness changes takes its inverse.
_POWERS = {"mesh_stiffness": (1, 0), "mesh_damping": (-1, 1), "body.material.viscous_loss_factor": (0, 1)}
_MOST = 0.5
_OF_SHAFTS = ("shaft_stiffness", "shaft_damping")


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
    def contact_ratio(self) -> float:
        """That of the drive, which under load changes with its teeth."""
        return self.changed.gear.contact_ratio

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
    def contact_ratio(self) -> float:
        """That of the gearbox, which under load changes with its teeth."""
        return float(massless(self.changed).contact_ratio)

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Those of the gearbox."""
        found: tuple[Coordinate, ...] = self.torsional.coordinates
        return found

    def system(self, speed: float) -> PeriodicSystem:
        """Equations of motion at a constant speed [rad/s]."""
        return system_at(self.changed, speed)
