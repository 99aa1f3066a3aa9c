"""Transverse vibration of a face gear with one or more spur pinions (chapters 4 to 6).

Disk and coordinates are those of :mod:`facegear.mechanics.disk`.

Two things about θ_c are easily lost. Tregold's contact ratio compresses the sweep of the contact with the
rotation that belongs to it, so that the contact still turns nearly as fast as the face gear (section 3.7):
the path of contact shrinks the angle by the same factor as the time. And θ_c falls as the teeth pass (section
3.6), while the disk of (4-1) turns towards growing θ: taken together as printed, contact and disk turn in
opposite senses. `Transverse` follows the printed equations unless its contact says otherwise.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from typing import NamedTuple, Protocol

import numpy as np
from scipy.linalg import block_diag

from facegear.floquet.loads import ContactLoad
from facegear.floquet.models import Coordinate
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.geometry.drive import Drive
from facegear.geometry.phases import phase_split
from facegear.geometry.timed_pairs import mesh_period
from facegear.mechanics.contact import CENTROID, Contact
from facegear.mechanics.disk import (
    REFERENCE_SPEED,
    disk_coordinates,
    disk_matrices,
    mirror_signs,
    modal_mass,
    reference_stiffness,
    unit_shape,
)
from facegear.mechanics.edge_stiffness import DrivingForce
from facegear.mechanics.plate import Body
from facegear.mechanics.properties import MeshLoad
from facegear.mechanics.radial_modes import RadialModes
from facegear.support.parameters import designed, finite_array, keep, positive, within
from facegear.support.types import FloatArray

MOST_PERIODS = 1e3
"""Phases beyond this are refused: they have lost their digits [mesh periods]."""


def nominal_pinion_mass(body: Body) -> float:
    """Mass of the pinion as a solid cylinder, ρπr_p²(L2 - L1), the denominator of (4-19) [kg]."""
    drive = body.drive
    return body.material.density * math.pi * drive.pitch_radius**2 * drive.face_width


@lru_cache(maxsize=256)
def contact_shape(modes: tuple[RadialModes, ...], contact: Contact, drive: Drive) -> PiecewiseChebyshev:
    """Shape vector at the contact point of a pinion at angle 0 against t/T0.

    It does not depend on the thickness of the body.

    Parameters
    ----------
    modes : tuple of RadialModes
        `modes` of the body.
    contact : Contact
        With one load.
    drive : Drive

    Returns
    -------
    PiecewiseChebyshev
        φ [1/m], one series for each smooth piece of the period.
    """
    (place,) = contact.places(drive)
    return place.shape(lambda x, angle: unit_shape(modes, x, angle) / drive.outer_radius)


def rotated(body: Body, shape: PiecewiseChebyshev, angle: float) -> PiecewiseChebyshev:
    """Shape vector of a point ahead of another by a constant angle: cosine and sine parts turn by n times it.

    Parameters
    ----------
    body : Body
    shape : PiecewiseChebyshev
        φ(r_c, θ_c).
    angle : float
        θ_i [rad].

    Returns
    -------
    PiecewiseChebyshev
        φ(r_c, θ_c + θ_i).
    """
    if angle == 0.0:
        return shape
    blocks = [np.eye(1)]
    for n in range(1, body.nodal_diameters + 1):
        cosine, sine = math.cos(n * angle), math.sin(n * angle)
        blocks.append(np.array([[cosine, -sine], [sine, cosine]]))
    rotation = block_diag(*(np.kron(block, np.eye(body.nodal_circles + 1)) for block in blocks))
    return PiecewiseChebyshev(shape.breakpoints, shape.coefficients @ rotation.T)


def mirrored(body: Body, shape: PiecewiseChebyshev) -> PiecewiseChebyshev:
    """Shape vector at the opposite angle, φ(r_c, -θ_c) from φ(r_c, θ_c)."""
    return PiecewiseChebyshev(shape.breakpoints, shape.coefficients * mirror_signs(body))


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
        for name, kind in (("body", Body), ("load", MeshLoad), ("contact", Contact)):
            if not isinstance(getattr(self, name), kind):
                raise TypeError(f"{name} must be a {kind.__name__}, got {getattr(self, name)!r}")
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


@dataclass(frozen=True)
class Transverse(PinionsOnDisk):
    """Transverse vibration of a face gear under one or more equal pinions (4-8, 5-6, 6-25).

    Parameters
    ----------
    body : Body
        Disk and modes.
    load : MeshLoad
        μ, ζ, τ of every pinion (4-17 to 4-19).
    pinion_angles : sequence of float
        θ_c of each pinion [rad], between -2π and 2π, all different unless `phases` are given. What is left of an angle
        after whole teeth sets the phase of the pinion's mesh (5-1 to 5-4).
    contact : Contact
        How the teeth touch, the same for all pinions, with one load a pinion. Default as printed: at the centroid of
        the contact lines, with Tregold's contact ratio and frozen rate.
    force : DrivingForce, optional
        In the plane of the disk (4-21), the same for all pinions. Default: none.
    phases : sequence of float, optional
        Phase of each pinion's mesh [mesh periods], in place of that of its angle: for gears whose teeth are clocked
        otherwise, as those on the other face.

    Raises
    ------
    TypeError, ValueError
        If an argument is of the wrong kind or outside its range.

    Examples
    --------
    >>> import facegear as fg
    >>> body = fg.Body(fg.Drive(26, 130, 3.175e-3), thickness_ratio=0.03)
    >>> model = fg.Transverse(body, fg.MeshLoad(stiffness=1.0, damping=3e-6, mass=1.0))
    >>> model.system(speed=50.0).size
    14
    """

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.phases is not None:
            return
        angles = np.mod(self.pinion_angles, 2 * math.pi)
        gaps = np.diff(np.sort(angles), append=0.0)
        gaps[-1] = 2 * math.pi - np.ptp(angles)
        if gaps.min() < 1e-6:
            raise ValueError(
                f"pinion_angles must differ from one another, unless phases are given, got {self.pinion_angles!r}"
            )

    def _require_contact(self) -> None:
        """Refuse loads of several pairs, and a mean point that jumps under a rigid pinion."""
        self.contact.require_one_load(self.body.drive, self.load.mass)

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Modes of the disk."""
        return disk_coordinates(self.body)

    @cached_property
    def shapes(self) -> tuple[PiecewiseChebyshev, ...]:
        """Shape vector at each pinion's contact point against t/T0 (5-4)."""
        first = contact_shape(self.body.modes, self.contact, self.body.drive)
        shapes = (
            rotated(self.body, first, angle).shift(phase)
            for angle, phase in zip(self.pinion_angles, self.mesh_phases, strict=True)
        )
        if self.contact.travel == "with_disk":
            shapes = (mirrored(self.body, shape) for shape in shapes)
        return tuple(shapes)

    def system(self, speed: float) -> PeriodicSystem:
        """Equations of motion at a constant speed (4-10, 5-6).

        Parameters
        ----------
        speed : float
            Ω2 of the face gear [rad/s], greater than 0.

        Returns
        -------
        PeriodicSystem
            (M + 1)(2N + 1) coordinates, one load for each pinion, period T0 (3-20).

        Raises
        ------
        TypeError, ValueError
            If `speed` is not a finite number greater than 0.
        """
        speed = positive("speed", speed, "rad/s")
        damping, stiffness = self.disk_matrices(speed)
        scale = modal_mass(self.body)
        stiffness_b, damping_b, mass_p = (
            value / scale for value in (self.bearing_stiffness, self.bearing_damping, self.pinion_mass)
        )
        loads = tuple(
            ContactLoad(shape, stiffness=stiffness_b, damping=damping_b, mass=mass_p, rate=self.contact.rate)
            for shape in self.shapes
        )
        period = mesh_period(self.body.drive, speed)
        return PeriodicSystem(np.eye(len(stiffness)), damping, stiffness, loads, period)
