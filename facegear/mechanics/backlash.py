"""Gearbox with play between its teeth (section 8.2, Eq. 8-1, Figs 8.4 and 8.5).

A constant torque at the output presses the forward flanks. A forward pair carries load while its mesh deformation g
exceeds half the gap, a backward pair while it is less than minus half the gap, each on its own path.

The backward flank. Mirrored in the plane of both axes a tooth is its own image and the rotation is reversed: the pairs
of the other flanks run through the path of the forward ones in the opposite sense, r_b(τ) = r_f(Σ − τ). At the pitch
circle tooth and space are of one width, so that the other flanks pass the pitch point half a mesh period away from the
forward ones: a forward pair at τ_P, a backward pair at τ_P + ½, and Σ = 2τ_P + ½. Equation (8-1) as printed delays the
forward path by a phase t_b instead and keeps its sense; with t_b = ½ both agree at the pitch point, and nowhere else.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Literal

from numpy.typing import ArrayLike

from facegear.floquet.clearance import ClearanceSystem
from facegear.floquet.models import Coordinate
from facegear.floquet.orbits import Orbit
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.mechanics.torsional import Torsional
from facegear.support.kinds import named, require_kind
from facegear.support.parameters import designed, finite, keep, one_of, within
from facegear.support.types import FloatArray

BackFlank = Literal["reversed", "printed"]


@lru_cache(maxsize=256)
def _reversed(function: PiecewiseChebyshev, turning_point: float) -> PiecewiseChebyshev:
    """X ↦ f(Σ − x)."""
    return function.backwards().shift(-turning_point)


@lru_cache(maxsize=256)
def _shifted(function: PiecewiseChebyshev) -> PiecewiseChebyshev:
    """X ↦ f(x − ½)."""
    return function.shift(-0.5)


@dataclass(frozen=True)
class Backlash:
    """Torsional vibration of a gearbox with play between its teeth.

    Parameters
    ----------
    torsional : Torsional
        The gearbox without play (chapter 7).
    torque : float
        Constant torque of the load against the rotation of the output [N m], greater than 0: without it nothing closes
        the gap. At most what presses one pair of teeth in by a module.
    gap : float
        Backlash along the line of action [m], from 0 to a module. It turns gear and load on by half of it. Where the
        arm of the mesh force varies, as that printed (7-3) does, this turn is a transmission error by itself, in
        proportion to the gap, and motions depend on the gap though no flank parts; with the constant arm of conjugate
        teeth they do not. With 0 the flanks are one: they pull as well as push,
        the back flanks' own path plays no part, and the system is the linear one of chapter 7 under the torque. That is
        not the limit of small gaps wherever the teeth would pull.
    transmission_error : PiecewiseChebyshev, optional
        Static transmission error of the forward flanks against t/T0 [m].
    back_flank : {"reversed", "printed"}
        Path of the backward pairs: r(Σ − τ), or as (8-1) prints it r(τ − ½), in the sense of the forward ones.

    Raises
    ------
    TypeError, ValueError
        If an argument is of the wrong kind or outside its range, or the path of the contact does not say when a pair
        passes the pitch point.

    Examples
    --------
    At 700 rpm the torque keeps the flanks together: nothing strikes back.

    >>> from facegear.floquet.orbits import periodic_orbit
    >>> from facegear.mechanics.gearboxes import FIGURES
    >>> from facegear.support.parameters import rad_per_s
    >>> model = Backlash(FIGURES["7.12a"].model(), torque=800.0, gap=1e-4)
    >>> orbit = periodic_orbit(model.system(rad_per_s(700.0)))
    >>> orbit.is_stable, model.parts(orbit), model.strikes_back(orbit)
    (True, False, False)
    """

    torsional: Torsional
    torque: float = field(metadata=designed("torque"))
    gap: float = field(metadata=designed("backlash"))
    transmission_error: PiecewiseChebyshev | None = None
    back_flank: BackFlank = "reversed"

    def __post_init__(self) -> None:
        require_kind("torsional", self.torsional, Torsional)
        torque = finite("torque", self.torque, "N m")
        if torque <= 0.0:
            raise ValueError(
                "torque must be greater than 0 N m, or nothing presses the flanks together and closes the gap, got "
                f"{self.torque!r} N m"
            )
        self._require_small(torque)
        keep(self, torque=torque, gap=within("gap", self.gap, 0.0, self.torsional.drive.module, "m"))
        error = self.transmission_error
        if error is not None and not isinstance(error, PiecewiseChebyshev):
            raise TypeError(f"transmission_error must be a PiecewiseChebyshev or None, got {named(error)}")
        if error is not None and error.components != 1:
            raise ValueError(f"transmission_error must have one component, got {error.components}")
        one_of("back_flank", self.back_flank, ("reversed", "printed"))
        _ = self.turning_point

    def _require_small(self, torque: float) -> None:
        """Refuse a torque that presses the teeth in by more than a module at rest."""
        drive, box = self.torsional.drive, self.torsional.gearbox.in_si
        per_torque = 1.0 / (box.mesh_stiffness * drive.base_radius * drive.gear_ratio)
        if torque * per_torque > drive.module:
            raise ValueError(
                f"torque must be at most {drive.module / per_torque:.3g} N m, which presses one pair of teeth in by a "
                f"module, got {torque!r} N m (N mm?)"
            )

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Elastic deviation angles χ1, χ2, χo (7-9)."""
        return self.torsional.coordinates

    @property
    def turning_point(self) -> float:
        """Σ = 2τ_P + ½ of the backward path r(Σ − τ) [mesh periods]."""
        contact = self.torsional.contact
        return 2.0 * contact.path(self.torsional.drive, contact.contact_ratio).pitch_passage + 0.5

    @property
    def _pairs(self) -> int:
        return len(self.torsional.shapes)

    def _backward(self, function: PiecewiseChebyshev) -> PiecewiseChebyshev:
        """Return what a forward pair has against t/T0 as a backward pair has it."""
        return _shifted(function) if self.back_flank == "printed" else _reversed(function, self.turning_point)

    def pressed(self, speed: float) -> PeriodicSystem:
        """Equations of motion under the torque with the flanks always in contact, those of chapter 7.

        Parameters
        ----------
        speed : float
            Ω2 of the face gear [rad/s], greater than 0.
        """
        system, error = self.torsional.under(self.torque, speed), self.transmission_error
        if error is None:
            return system
        loads = tuple(dataclasses.replace(load, transmission_error=error) for load in system.loads)
        return dataclasses.replace(system, loads=loads)

    def system(self, speed: float) -> ClearanceSystem:
        """Equations of motion at a constant speed.

        Parameters
        ----------
        speed : float
            Ω2 of the face gear [rad/s], greater than 0.

        Returns
        -------
        ClearanceSystem
            Three coordinates; loads of the forward pairs, the youngest first, then of the backward pairs.

        Raises
        ------
        TypeError, ValueError
            If `speed` is not a finite number greater than 0.
        """
        forward, count = self.pressed(speed), self._pairs
        if self.gap == 0.0:
            return ClearanceSystem(forward, (0,) * count, (0.0,) * count)
        backward = tuple(load.moved(self._backward) for load in self.torsional.system(speed).loads)
        both = dataclasses.replace(forward, loads=forward.loads + backward)
        return ClearanceSystem(both, (1,) * count + (-1,) * count, (self.gap / 2.0,) * (2 * count))

    def deformation(self, orbit: Orbit, fraction: ArrayLike) -> FloatArray:
        """Mesh deformation of the gears, r_b1 (χ1 − χ2 N2/N1), at fractions of the orbit's periods [m]."""
        return self.torsional.deformation(orbit.displacements(fraction))

    def parts(self, orbit: Orbit) -> bool:
        """Whether at some instants no forward pair is in contact."""
        return not bool(orbit.pattern.pressed[:, : self._pairs].any(axis=1).all())

    def strikes_back(self, orbit: Orbit) -> bool:
        """Whether some backward pair is in contact at some instant."""
        return bool(orbit.pattern.pressed[:, self._pairs :].any())
