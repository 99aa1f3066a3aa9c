"""Transverse vibration of a face gear with one or more spur pinions (chapters 4 to 6).

Disk and coordinates are those of :mod:`facegear.mechanics.disk`.

Two things about θ_c are easily lost. Tregold's contact ratio compresses the sweep of the contact with the
rotation that belongs to it, so that the contact still turns nearly as fast as the face gear (section 3.7):
`contact_centroid` shrinks the angle by the same factor as the time. And θ_c falls as the teeth pass (section
3.6), while the disk of (4-1) turns towards growing θ: taken together as printed, contact and disk turn in
opposite senses. `Transverse` follows the printed equations unless told otherwise.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Literal

import numpy as np
from scipy.linalg import block_diag

from facegear.floquet.periodic import ContactLoad, PeriodicSystem, Rate
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.geometry.kinematics import ContactPath, checked_contact_ratio, mesh_period
from facegear.geometry.phases import phase_split
from facegear.mechanics.disk import (
    Coordinate,
    coordinates,
    disk_matrices,
    disk_stiffness,
    modal_mass,
    reference_stiffness,
    shape_vector,
    unit_shape,
)
from facegear.mechanics.edge_stiffness import Following, driving_force, unit_stiffness
from facegear.mechanics.plate import Body, RadialModes
from facegear.support.parameters import (
    MeshLoad,
    finite_array,
    integer_at_least,
    keep,
    nonnegative,
    one_of,
    positive,
    within,
)
from facegear.support.types import FloatArray

__all__ = [
    "Coordinate",
    "Transverse",
    "contact_centroid",
    "contact_shape",
    "coordinates",
    "disk_matrices",
    "disk_stiffness",
    "mirrored",
    "nominal_pinion_mass",
    "reference_stiffness",
    "rotated",
    "shape_vector",
]

Travel = Literal["printed", "with_disk"]


def nominal_pinion_mass(body: Body) -> float:
    """Mass of the pinion as a solid cylinder, ρπr_p²(L2 - L1), the denominator of (4-19) [kg]."""
    drive = body.drive
    return body.material.density * math.pi * drive.pitch_radius**2 * drive.face_width


@lru_cache(maxsize=256)
def contact_centroid(path: ContactPath) -> PiecewiseChebyshev:
    """Contact centroid (3-21) of a pinion at angle 0 against t/T0, fitted once for each path.

    Parameters
    ----------
    path : ContactPath
        Path of the contact points and its clock.

    Returns
    -------
    PiecewiseChebyshev
        r_c over the outer radius [-] and θ_c [rad].
    """
    edges = np.append(path.breakpoints, 1.0)

    def position(fraction: FloatArray, piece: int) -> FloatArray:
        start, end = edges[piece], edges[piece + 1]
        centroid = path.centroid_on_piece(piece, (2 * fraction - start - end) / (end - start))
        return np.stack([centroid.radius / path.drive.outer_radius, centroid.angle], axis=-1)

    return PiecewiseChebyshev.fit(position, path.breakpoints, tolerance=path.fit_tolerances)


@lru_cache(maxsize=256)
def contact_shape(modes: tuple[RadialModes, ...], path: ContactPath) -> PiecewiseChebyshev:
    """Shape vector at the contact centroid of a pinion at angle 0 against t/T0.

    It does not depend on the thickness of the body.

    Parameters
    ----------
    modes : tuple of RadialModes
        `modes` of the body.
    path : ContactPath
        Path of the contact points and its clock.

    Returns
    -------
    PiecewiseChebyshev
        φ [1/m], one series for each smooth piece of the period.
    """
    centroid = contact_centroid(path)

    def shape(fraction: FloatArray, piece: int) -> FloatArray:
        x, angle = np.moveaxis(centroid(fraction), -1, 0)
        return unit_shape(modes, x, angle) / path.drive.outer_radius

    return PiecewiseChebyshev.fit(shape, centroid.breakpoints, tolerance=path.fit_tolerances)


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
    signs = np.array([-1.0 if coordinate.wave == "sin" else 1.0 for coordinate in coordinates(body)])
    return PiecewiseChebyshev(shape.breakpoints, shape.coefficients * signs)


@dataclass(frozen=True)
class Transverse:
    """Transverse vibration of a face gear under one or more equal pinions (4-8, 5-6, 6-25).

    Parameters
    ----------
    body : Body
        Disk and modes.
    load : MeshLoad
        μ, ζ, τ of every pinion (4-17 to 4-19).
    pinion_angles : sequence of float
        θ_c of each pinion [rad], between -2π and 2π and all different. What is left of an angle after whole
        teeth sets the phase of the pinion's mesh (5-1 to 5-4).
    contact_ratio : float, optional
        Mesh periods that a tooth pair stays in mesh, 1 or more, and 1.001 or more with total rate. Default None:
        Tregold's, as printed, that of whatever drive the body has (`mesh_contact_ratio`);
        `drive.geometric_contact_ratio` is that of the true sweep. A number stays when the drive is replaced.
    rate : {"frozen", "total"}
        Whether the pinion follows ∂w/∂t at the contact centroid ("frozen", as printed in 4-1) or the deflection
        under the moving centroid ("total").
    travel : {"printed", "with_disk"}
        Whether the disk turns towards growing θ while the contact turns towards falling θ, (4-1) and section
        3.6 as printed, or contact, disk and the order in which a tooth meets the pinions agree ("with_disk":
        all angles against the disk's rotation).
    power, power_speed : float, optional
        Power [W] that each pinion brings in at its speed `power_speed` [rad/s], 0 or greater and greater than 0.
        They set the driving force in the plane of the disk (4-21), the same at every speed. Default: no such force.
    following : {"follower", "dead"}
        Whether the driving force stays tangent to the bent rim, as printed, or keeps its direction.
    stress_harmonics : int
        Largest harmonic of the stress under the driving force. Default 5, as printed; 2N couples all modes.

    Raises
    ------
    TypeError, ValueError
        If an argument is of the wrong kind or outside its range.

    Examples
    --------
    >>> from facegear.geometry.drive import Drive
    >>> body = Body(Drive(26, 130, 3.175e-3), thickness_ratio=0.03)
    >>> model = Transverse(body, MeshLoad(stiffness=1.0, damping=3e-6, mass=1.0))
    >>> model.system(speed=50.0).size
    14
    """

    body: Body
    load: MeshLoad
    pinion_angles: Sequence[float] = (0.0,)
    contact_ratio: float | None = None
    rate: Rate = "frozen"
    travel: Travel = "printed"
    power: float | None = None
    power_speed: float | None = None
    following: Following = "follower"
    stress_harmonics: int = 5

    def __post_init__(self) -> None:
        if not isinstance(self.body, Body):
            raise TypeError(f"body must be a Body, got {self.body!r}")
        if not isinstance(self.load, MeshLoad):
            raise TypeError(f"load must be a MeshLoad, got {self.load!r}")
        one_of("rate", self.rate, ("frozen", "total"))
        one_of("travel", self.travel, ("printed", "with_disk"))
        if (self.power is None) != (self.power_speed is None):
            raise ValueError(
                f"power and power_speed go together, got power={self.power!r}, power_speed={self.power_speed!r}"
            )
        one_of("following", self.following, ("follower", "dead"))
        keep(self, stress_harmonics=integer_at_least("stress_harmonics", self.stress_harmonics, 0))
        if self.power is not None:
            keep(
                self,
                power=nonnegative("power", self.power, "W"),
                power_speed=positive("power_speed", self.power_speed, "rad/s"),
            )
        # Fails here rather than at the first use if the contact ratio is not valid.
        path = ContactPath(self.body.drive, self.mesh_contact_ratio)
        keep(self, contact_ratio=None if self.contact_ratio is None else path.contact_ratio)
        if self.rate == "total":
            path.require_finite_speed("rate = 'total'")
            path.require_slow_centroid("rate = 'total'")
        angles = finite_array("pinion_angles", self.pinion_angles, "rad")
        if angles.ndim != 1 or angles.size == 0:
            raise ValueError(f"pinion_angles must list one angle a pinion, got {self.pinion_angles!r}")
        for angle in angles.tolist():
            within("pinion_angles", angle, -2 * math.pi, 2 * math.pi, "rad", hint="degrees?")
        gaps = np.diff(np.sort(np.mod(angles, 2 * math.pi)), append=0.0)
        gaps[-1] = 2 * math.pi - np.ptp(np.mod(angles, 2 * math.pi))
        if gaps.min() < 1e-6:
            raise ValueError(f"pinion_angles must differ from one another, got {self.pinion_angles!r}")
        keep(self, pinion_angles=tuple(angles.tolist()))

    @property
    def mesh_contact_ratio(self) -> float:
        """Mesh periods that a tooth pair stays in mesh: `contact_ratio` if given, else Tregold's (3-23 to 3-26)."""
        return checked_contact_ratio(self.body.drive, self.contact_ratio)

    @property
    def bearing_stiffness(self) -> float:
        """k_b = μ times the reference stiffness of the disk [N/m] (4-17)."""
        return self.load.stiffness * reference_stiffness(self.body)

    @property
    def bearing_damping(self) -> float:
        """c_b = ζ k_b [N s/m] (4-18)."""
        return self.load.damping * self.bearing_stiffness

    @property
    def pinion_mass(self) -> float:
        """m_p = τ times the nominal pinion mass [kg] (4-19)."""
        return self.load.mass * nominal_pinion_mass(self.body)

    @property
    def driving_force(self) -> float:
        """F_t of each pinion [N] (4-21), 0 without a power."""
        if self.power is None or self.power_speed is None:
            return 0.0
        return driving_force(self.body, self.power, self.power_speed)

    @cached_property
    def shapes(self) -> tuple[PiecewiseChebyshev, ...]:
        """Shape vector at each pinion's contact centroid against t/T0 (5-4)."""
        drive = self.body.drive
        first = contact_shape(self.body.modes, ContactPath(drive, self.mesh_contact_ratio))
        phases = phase_split(drive, self.pinion_angles).phase
        shapes = (
            rotated(self.body, first, angle).shift(phase)
            for angle, phase in zip(self.pinion_angles, phases, strict=True)
        )
        if self.travel == "with_disk":
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
        damping, stiffness = disk_matrices(self.body, speed)
        if self.driving_force:
            sense = -1.0 if self.travel == "with_disk" else 1.0
            angles = tuple(sense * angle for angle in self.pinion_angles)
            unit = unit_stiffness(self.body, speed, self.stress_harmonics, self.following, angles)
            stiffness = stiffness + self.driving_force * unit
        scale = modal_mass(self.body)
        stiffness_b, damping_b, mass_p = (
            value / scale for value in (self.bearing_stiffness, self.bearing_damping, self.pinion_mass)
        )
        loads = tuple(
            ContactLoad(shape, stiffness=stiffness_b, damping=damping_b, mass=mass_p, rate=self.rate)
            for shape in self.shapes
        )
        period = mesh_period(self.body.drive, speed)
        return PeriodicSystem(np.eye(len(stiffness)), damping, stiffness, loads, period)
