"""A disk under equal pinions: what its models have in common, and what reports on a drive need of them.

How the pinions hang together with the disk is the model's own affair: on bearings alone
(:mod:`facegear.mechanics.transverse`), or on the springs of their teeth (:mod:`facegear.mechanics.mesh_oscillator`).
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple, Protocol

from facegear.floquet.models import Coordinate
from facegear.floquet.periodic import PeriodicSystem
from facegear.geometry.phases import phase_split
from facegear.mechanics.contact import CENTROID, Contact
from facegear.mechanics.disk import REFERENCE_SPEED, disk_matrices, reference_stiffness
from facegear.mechanics.edge_stiffness import DrivingForce
from facegear.mechanics.plate import Body
from facegear.mechanics.properties import MeshLoad
from facegear.support.kinds import require_kinds
from facegear.support.parameters import designed, finite_array, keep, within
from facegear.support.types import FloatArray

MOST_PERIODS = 1e3
"""Phases beyond this are refused: they have lost their digits [mesh periods]."""


def nominal_pinion_mass(body: Body) -> float:
    """Mass of the pinion as a solid cylinder, ρπr_p²(L2 - L1), the denominator of (4-19) [kg]."""
    drive = body.drive
    return body.material.density * math.pi * drive.pitch_radius**2 * drive.face_width


class Driving(NamedTuple):
    """Where pinions act on a gear, and which of them drive it.

    Attributes
    ----------
    angles : tuple of float
        In the sense in which the gear turns [rad].
    senses : tuple of int
        1 for a pinion that drives the gear, -1 for one that it drives.
    """

    angles: tuple[float, ...]
    senses: tuple[int, ...]


class FaceGears(Protocol):
    """One face gear with its pinions, or several alike: what reports on a drive need of its model."""

    @property
    def gear(self) -> PinionsOnDisk:
        """A gear with its pinions; all are alike."""
        ...

    def with_gear(self, gear: PinionsOnDisk) -> FaceGears:
        """Return the model with other gears."""
        ...

    @property
    def driving(self) -> tuple[Driving, ...]:
        """How each gear is driven."""
        ...

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """One for each row of the matrices."""
        ...

    def system(self, speed: float) -> PeriodicSystem:
        """Equations of motion at a constant speed of the gears [rad/s]."""
        ...


@dataclass(frozen=True)
class PinionsOnDisk(ABC):
    """What every model of a disk under equal pinions is made of; arguments are explained at :class:`Transverse`."""

    body: Body
    load: MeshLoad
    pinion_angles: Sequence[float] = field(
        default=(0.0,), metadata=designed("phase of pinion", step="body.drive.angular_pitch")
    )
    contact: Contact = CENTROID
    force: DrivingForce | None = None
    phases: Sequence[float] | None = None

    def __post_init__(self) -> None:
        require_kinds(self, body=Body, load=MeshLoad, contact=Contact)
        if self.force is not None and not isinstance(self.force, DrivingForce):
            raise TypeError(f"force must be a DrivingForce or None, got {self.force!r}")
        if self.force is not None:
            self.force.require(self.body)
        self._require_contact()
        angles = finite_array("pinion_angles", self.pinion_angles, "rad")
        if angles.ndim != 1 or angles.size == 0:
            raise ValueError(f"pinion_angles must list one angle a pinion, got {self.pinion_angles!r}")
        for angle in angles.tolist():
            within("pinion_angles", angle, -2 * math.pi, 2 * math.pi, "rad", hint="degrees?")
        keep(self, pinion_angles=tuple(angles.tolist()))
        if self.phases is not None:
            phases = finite_array("phases", self.phases)
            if phases.shape != angles.shape:
                raise ValueError(f"phases must list one a pinion, {angles.size}, got {self.phases!r}")
            for phase in phases.tolist():
                within("phases", phase, -MOST_PERIODS, MOST_PERIODS, "mesh periods")
            keep(self, phases=tuple(phases.tolist()))

    def _require_contact(self) -> None:
        """Refuse a contact that the model does not take."""
        self.contact.require(self.body.drive)

    @property
    def contact_ratio(self) -> float:
        """Mesh periods that a tooth pair stays in mesh: that of the contact if given, else Tregold's."""
        return self.contact.ratio(self.body.drive)

    @property
    def bearing_stiffness(self) -> float:
        """k_b = μ times the reference stiffness of the disk [N/m] (4-17).

        Raises
        ------
        ValueError
            If the disk is so soft that its stiffness, averaged up to the reference speed, is not positive.
        """
        if self.load.stiffness == 0.0:
            return 0.0
        reference = reference_stiffness(self.body)
        if reference <= 0.0:
            raise ValueError(
                "thickness_ratio must be larger, or the material stiffer (youngs_modulus) or lighter (density), for "
                "bearings to be measured by the disk's own stiffness (4-17): averaged up to "
                f"{REFERENCE_SPEED:.4g} rad/s, beyond a critical speed, that is {reference:.3g} N/m, got "
                f"{self.body.thickness_ratio!r}"
            )
        return self.load.stiffness * reference

    @property
    def bearing_damping(self) -> float:
        """c_b = ζ k_b [N s/m] (4-18)."""
        return self.load.damping * self.bearing_stiffness

    @property
    def pinion_mass(self) -> float:
        """m_p = τ times the nominal pinion mass [kg] (4-19)."""
        return self.load.mass * nominal_pinion_mass(self.body)

    @property
    def mesh_phases(self) -> tuple[float, ...]:
        """Phase ψ of each pinion's mesh [mesh periods]: `phases` if given, else those of the angles (5-1, 5-2)."""
        if self.phases is not None:
            return tuple(self.phases)
        return tuple(phase_split(self.body.drive, self.pinion_angles).phase.tolist())

    @property
    @abstractmethod
    def coordinates(self) -> tuple[Coordinate, ...]:
        """One for each row of the matrices."""

    @abstractmethod
    def system(self, speed: float) -> PeriodicSystem:
        """Equations of motion at a constant speed Ω2 of the face gear [rad/s]."""

    @property
    def gear(self) -> PinionsOnDisk:
        """The gear with its pinions: itself."""
        return self

    def with_gear(self, gear: PinionsOnDisk) -> PinionsOnDisk:
        """Return the model with another gear in place of `gear`: that gear."""
        return gear

    @property
    def driving(self) -> tuple[Driving, ...]:
        """How each gear is driven: the one there is, by all its pinions."""
        angles = tuple(self.contact.sense * angle for angle in self.pinion_angles)
        return (Driving(angles, (1,) * len(angles)),)

    def disk_matrices(self, speed: float) -> tuple[FloatArray, FloatArray]:
        """Damping and stiffness of the disk under the driving forces alone at Ω2 [rad/s], each (n, n)."""
        damping, stiffness = disk_matrices(self.body, speed)
        (driving,) = self.driving
        return damping, stiffness + self.force_stiffness(speed, driving)

    def force_stiffness(self, speed: float, driving: Driving) -> FloatArray | float:
        """K_f of the driving forces at Ω2 [rad/s] on a gear that is driven so [1/s²], (n, n); 0 without a force."""
        if self.force is None or self.force.power == 0.0:
            return 0.0
        return self.force.stiffness(self.body, speed, *driving)
