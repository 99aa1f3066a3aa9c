"""Torsional vibration of a gearbox with a face-gear drive (chapter 7).

Pinion, face gear and load are rigid bodies on torsional springs and dampers; the input side turns at a constant
speed. The coordinates q = (χ1, χ2, χo) are their elastic deviation angles (7-9). Every tooth pair is a spring and
damper on the mesh deformation g = φᵀq with φ = (r_b1, −r cos α_c, 0) (7-3), a rank-one load with its time
derivative taken through the moving contact point, which makes the stiffness (7-13) non-symmetric.

The arm r cos α_c of (7-3) holds the pressure angle at α_c while the contact point moves along the tooth. On the
true, conjugate tooth the local pressure angle changes with it, and the equation of meshing leaves a constant arm,
r_b1 N2/N1 (:func:`facegear.symbolic.torsional.conjugate_arm`). `Torsional` follows the printed arm unless told
otherwise.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Literal, Protocol

import numpy as np
from numpy.typing import ArrayLike

from facegear.floquet.fourier import fourier_series
from facegear.floquet.loads import ContactLoad
from facegear.floquet.models import Coordinate
from facegear.floquet.modes import undamped_frequencies
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.geometry.drive import Drive
from facegear.geometry.timed_pairs import mesh_period
from facegear.mechanics.contact import SKEW_LINE, Contact
from facegear.mechanics.properties import STEEL
from facegear.mechanics.tooth_stiffness import tooth_stiffness
from facegear.support.kinds import require_kind
from facegear.support.parameters import designed, finite_array, keep, nonnegative, one_of, positive, within
from facegear.support.types import FloatArray

Arm = Literal["printed", "conjugate"]


def cylinder_inertia(radius: float, height: float, density: float = STEEL.density) -> float:
    """Moment of inertia of a solid cylinder about its axis, ½πρ h r⁴ [kg m²].

    Parameters
    ----------
    radius, height : float
        r and h [m].
    density : float, optional
        ρ [kg/m³].

    Raises
    ------
    TypeError, ValueError
        If a value is not a number above 0.
    """
    radius, height = positive("radius", radius, "m"), positive("height", height, "m")
    return math.pi * positive("density", density, "kg/m³") * height * radius**4 / 2.0


def natural_speed(drive: Drive, frequency: ArrayLike) -> FloatArray:
    """Speed of the face gear at which the mesh frequency equals a natural frequency (7-20).

    Parameters
    ----------
    drive : Drive
    frequency : array_like
        ω_n [rad/s].

    Returns
    -------
    ndarray
        ω_n/N2 [rad/s].
    """
    return np.asarray(finite_array("frequency", frequency, "rad/s") / drive.gear_teeth)


@dataclass(frozen=True)
class Gearbox:
    """Inertias, shafts and mesh of a gearbox with one spur pinion and one face gear (7-4 to 7-6).

    Parameters
    ----------
    drive : Drive
        Teeth of pinion and face gear.
    pinion_inertia, gear_inertia, load_inertia : float
        J1, J2, Jo [kg m²], greater than 0. The pinion's may lie from 1/100 to 100 times that of a solid steel
        cylinder as wide as the teeth with the base radius.
    mesh_stiffness : float
        k_m of a tooth pair [N/m], from 1/500 to 20 times that of two steel teeth in series.
    mesh_damping : float
        c_m of a tooth pair [N s/m], from 0 to 0.01 s times k_m.
    input_stiffness, output_stiffness : float
        k1, k2 of the shafts [N m/rad], greater than 0.
    input_damping, output_damping : float
        c1, c2 of the shafts [N m s/rad], 0 or greater.

    Raises
    ------
    TypeError, ValueError
        A value of the wrong kind or outside its range.

    Examples
    --------
    >>> import facegear as fg
    >>> gearbox = fg.Gearbox(fg.Drive(20, 100, 4e-3), 1.0e-3, 0.5, 2.0, 3e8, 300.0, 2e4, 1.0, 2e5, 10.0)
    >>> fg.Torsional(gearbox).system(fg.rad_per_s(600.0)).size
    3
    """

    drive: Drive
    pinion_inertia: float = field(metadata=designed("inertia of the pinion"))
    gear_inertia: float = field(metadata=designed("inertia of the face gear"))
    load_inertia: float = field(metadata=designed("inertia of the load"))
    mesh_stiffness: float = field(metadata=designed("mesh stiffness"))
    mesh_damping: float = field(metadata=designed("mesh damping"))
    input_stiffness: float = field(metadata=designed("input shaft stiffness"))
    input_damping: float = field(metadata=designed("input shaft damping"))
    output_stiffness: float = field(metadata=designed("output shaft stiffness"))
    output_damping: float = field(metadata=designed("output shaft damping"))

    def __post_init__(self) -> None:
        require_kind("drive", self.drive, Drive)
        inertia, stiffness = _steel_scales(self.drive)
        mesh = within("mesh_stiffness", self.mesh_stiffness, stiffness / 500.0, stiffness * 20.0, "N/m")
        keep(
            self,
            pinion_inertia=within(
                "pinion_inertia", self.pinion_inertia, inertia / 100.0, inertia * 100.0, "kg m²"
            ),
            gear_inertia=positive("gear_inertia", self.gear_inertia, "kg m²"),
            load_inertia=positive("load_inertia", self.load_inertia, "kg m²"),
            mesh_stiffness=mesh,
            mesh_damping=within("mesh_damping", self.mesh_damping, 0.0, 0.01 * mesh, "N s/m"),
            input_stiffness=positive("input_stiffness", self.input_stiffness, "N m/rad"),
            input_damping=nonnegative("input_damping", self.input_damping, "N m s/rad"),
            output_stiffness=positive("output_stiffness", self.output_stiffness, "N m/rad"),
            output_damping=nonnegative("output_damping", self.output_damping, "N m s/rad"),
        )

    @property
    def in_si(self) -> Gearbox:
        """Itself: gearboxes in other units say here what they are in SI (:class:`InSi`)."""
        return self

    @property
    def mass_matrix(self) -> FloatArray:
        """M of (7-11), shape (3, 3) [kg m²]."""
        return np.diag([self.pinion_inertia, self.gear_inertia, self.load_inertia])

    @property
    def damping_matrix(self) -> FloatArray:
        """C0 of the shafts (7-12), shape (3, 3) [N m s/rad]."""
        return _shafts(self.input_damping, self.output_damping)

    @property
    def stiffness_matrix(self) -> FloatArray:
        """K0 of the shafts (7-13), shape (3, 3) [N m/rad]."""
        return _shafts(self.input_stiffness, self.output_stiffness)


@lru_cache(maxsize=64)
def _steel_scales(drive: Drive) -> tuple[float, float]:
    """Moment of inertia of a steel pinion [kg m²] and stiffness of a pair of steel teeth [N/m]."""
    return cylinder_inertia(drive.base_radius, drive.face_width), tooth_stiffness(drive) / 2.0


def _shafts(first: float, second: float) -> FloatArray:
    return np.array([[first, 0.0, 0.0], [0.0, second, -second], [0.0, -second, second]])


class InSi(Protocol):
    """Anything that says what gearbox it is."""

    @property
    def in_si(self) -> Gearbox:
        """The gearbox in SI units."""
        ...


@lru_cache(maxsize=256)
def _shapes(drive: Drive, contact: Contact, arm: Arm) -> tuple[PiecewiseChebyshev, ...]:
    """Shape vector of each load against t/T0, of :meth:`Contact.places`."""

    def vector(x: FloatArray, angle: FloatArray) -> FloatArray:
        # Arm about the face-gear axis [m]
        if arm == "printed":
            arms = x * drive.outer_radius * math.cos(drive.pressure_angle)
        else:
            arms = np.full(x.shape, drive.base_radius * drive.gear_ratio)
        return np.stack([np.full(x.shape, drive.base_radius), -arms, np.zeros(x.shape)], axis=-1)

    return tuple(place.shape(vector) for place in contact.places(drive))


@lru_cache(maxsize=256)
def _mean_dyad(drive: Drive, contact: Contact, arm: Arm) -> FloatArray:
    """Mean over the mesh period of Σ wφφᵀ, shape (3, 3) [m²]; w is what a load has of k_m."""
    shapes = _shapes(drive, contact, arm)
    weights = [place.weight for place in contact.places(drive)]

    def dyads(fraction: FloatArray) -> FloatArray:
        vectors = np.stack([shape(fraction) for shape in shapes])
        stiffness = [
            np.ones((fraction.size, 1)) if weight is None else weight(fraction) for weight in weights
        ]
        return np.asarray(np.einsum("pmi,pmj,pmk->mij", vectors, vectors, np.stack(stiffness)))

    mean = fourier_series(dyads, shapes[0].breakpoints, 1).mean
    mean.setflags(write=False)
    return mean


@dataclass(frozen=True)
class Torsional:
    """Torsional vibration of a gearbox (7-10 to 7-13).

    Parameters
    ----------
    gearbox : Gearbox
        Or anything with such a one in SI units (:class:`InSi`), as
        :class:`facegear.mechanics.gearboxes.ProportionalGearbox`.
    contact : Contact
        How the tooth pairs touch. Default as printed: each pair on the skew line (3-22), with Tregold's contact ratio
        and total rate. Every load of it has the whole stiffness k_m of a pair, and the whole damping c_m, unless the
        path says what part (:class:`facegear.mechanics.paths.loaded_contact`).
    arm : {"printed", "conjugate"}
        Moment arm of the mesh force about the face-gear axis: r(t) cos α_c as printed in (7-3), or r_b1 N2/N1, the
        constant arm of the conjugate tooth, wherever the contact point is.

    Raises
    ------
    TypeError, ValueError
        If an argument is of the wrong kind or outside its range, or the contact not possible with these teeth.

    Examples
    --------
    >>> import facegear as fg
    >>> drive = fg.Drive(31, 107, 3.175e-3)
    >>> gearbox = fg.Gearbox(drive, 1.6e-3, 0.15, 0.17, 1.58e8, 1.58e3, 1.42e6, 14.2, 1.58e7, 158.0)
    >>> fg.Torsional(gearbox).system(speed=50.0).size
    3
    """

    gearbox: InSi
    contact: Contact = SKEW_LINE
    arm: Arm = "printed"

    def __post_init__(self) -> None:
        if not isinstance(getattr(self.gearbox, "in_si", None), Gearbox):
            raise TypeError(f"gearbox must be a Gearbox, got {self.gearbox!r}")
        require_kind("contact", self.contact, Contact)
        one_of("arm", self.arm, ("printed", "conjugate"))
        self.contact.require(self.drive)

    @property
    def drive(self) -> Drive:
        """Teeth of pinion and face gear."""
        return self.gearbox.in_si.drive

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Elastic deviation angles χ1, χ2, χo (7-9)."""
        return tuple(Coordinate(name, "rad", name) for name in ("pinion", "face gear", "load"))

    @property
    def not_buildable(self) -> tuple[str, ...]:
        """What cannot be built: nothing, as shafts without mass have no length or diameter."""
        return ()

    @property
    def contact_ratio(self) -> float:
        """Mesh periods that a tooth pair stays in mesh: that of the contact if given, else Tregold's."""
        return self.contact.ratio(self.drive)

    @property
    def shapes(self) -> tuple[PiecewiseChebyshev, ...]:
        """Shape vector φ of each tooth pair against t/T0 [m], the youngest pair first; 0 out of contact (7-3)."""
        return _shapes(self.drive, self.contact, self.arm)

    @property
    def mean_stiffness(self) -> FloatArray:
        """Mean of K(t) with the face gear at rest, U(0) of (7-16) without its term in ṙ, shape (3, 3)."""
        gearbox = self.gearbox.in_si
        dyad = _mean_dyad(self.drive, self.contact, self.arm)
        return np.asarray(gearbox.stiffness_matrix + gearbox.mesh_stiffness * dyad)

    def natural_frequencies(self) -> FloatArray:
        """Natural frequencies of the mean system at rest (7-17 with Ω2 = 0), ascending, shape (3,) [rad/s]."""
        return undamped_frequencies(self.gearbox.in_si.mass_matrix, self.mean_stiffness)

    def natural_speeds(self) -> FloatArray:
        """Speeds of the face gear at which the mesh frequency is a natural one (7-20), shape (3,) [rad/s]."""
        return natural_speed(self.drive, self.natural_frequencies())

    def deformation(self, angles: FloatArray) -> FloatArray:
        """Mesh deformation r_b1 (χ1 − χ2 N2/N1) of conjugate teeth at angles (..., 3) [m]; its rate at their rates."""
        drive = self.drive
        return np.asarray(drive.base_radius * (angles[..., 0] - drive.gear_ratio * angles[..., 1]))

    def under(self, torque: float, speed: float) -> PeriodicSystem:
        """Equations of motion as :meth:`system`, under a constant torque T_o of the load [N m]."""
        return replace(self.system(speed), force=PiecewiseChebyshev.constant([0.0, 0.0, -torque]))

    def system(self, speed: float) -> PeriodicSystem:
        """Equations of motion at a constant speed (7-10).

        Parameters
        ----------
        speed : float
            Ω2 of the face gear [rad/s], greater than 0.

        Returns
        -------
        PeriodicSystem
            Three coordinates, one load for each tooth pair, the period T0 (3-20).

        Raises
        ------
        TypeError, ValueError
            If `speed` is not a finite number greater than 0.
        """
        gearbox = self.gearbox.in_si
        loads = tuple(
            ContactLoad(
                shape,
                stiffness=gearbox.mesh_stiffness,
                damping=gearbox.mesh_damping,
                rate=self.contact.rate,
                weight=place.weight,
            )
            for shape, place in zip(self.shapes, self.contact.places(self.drive), strict=True)
        )
        return PeriodicSystem(
            gearbox.mass_matrix,
            gearbox.damping_matrix,
            gearbox.stiffness_matrix,
            loads,
            mesh_period(self.drive, speed),
        )
