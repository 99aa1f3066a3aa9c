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
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from scipy.linalg import block_diag

from facegear.floquet.loads import ContactLoad
from facegear.floquet.models import Coordinate
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.geometry.drive import Drive
from facegear.geometry.timed_pairs import mesh_period
from facegear.mechanics.contact import Contact
from facegear.mechanics.disk import disk_coordinates, mirror_signs, modal_mass, unit_shape
from facegear.mechanics.pinions_on_disk import PinionsOnDisk
from facegear.mechanics.plate import Body
from facegear.mechanics.radial_modes import RadialModes
from facegear.support.parameters import positive


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
