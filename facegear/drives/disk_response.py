"""Forced response of the disk: what the teeth's own giving way under the load of the drive makes of the mesh force.

Under a constant force teeth give way by the static transmission error. While they turn it changes, as pairs come and go
and their lines grow and shrink, and so it shakes disk and pinions, at speeds where nothing grows by itself as well. The
springs of the teeth feel what it departs from its mean. Flanks are conjugate and without errors of their own: where
nothing gives way, or everything evenly, there is no transmission error, and that is said.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import xarray as xr

from facegear.drives.basis import unstable_share, with_basis
from facegear.drives.outcome import Outcome
from facegear.drives.refusals import told
from facegear.drives.response_peaks import largest_force
from facegear.drives.variants import Variant
from facegear.floquet.fourier import fourier_series
from facegear.floquet.models import Coordinate, system_at
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.maps.response_map import frequency_response
from facegear.mechanics.disk import modal_mass
from facegear.mechanics.pinions_on_disk import FaceGears
from facegear.support.types import FloatArray

RIGID = "rigid teeth do not give way, and conjugate flanks without errors turn the gear evenly"
UNLOADED = "without load nothing gives way, and conjugate flanks without errors turn the gear evenly"
EVEN = "all pairs together are as stiff at all times, so that they give way evenly"
_TWO_GEARS = "between two gears, where flanks press on both sides of a tooth, it is not computed"

# Part of what teeth give way below which a change of it is rounding.
_ROUNDING = 1e-9
# Nodal circles of the response. A third one changed the forces of Case I at fifteen speeds by 4 % at most, two nodal
# diameters by tens of percent at some; it takes twice as long.
_CIRCLES = 2
# Part of its speed to which a resonance is found.
_RESOLUTION = 1e-4
# Part of the speeds that may be unstable: where little is steady there is little to say.
_MOST_UNSTABLE = 0.5

MOST_MOVED = 0.1
"""Part by which two bases may differ in the largest force where it counts as settled."""

RESPONSE_SPEEDS = 46
"""Speeds of a forced response of the disk, besides those at which the mesh meets a natural frequency between them."""


@dataclass(frozen=True)
class Shaken:
    """A face gear under the static transmission error of its teeth, each pinion's in the phase of its mesh.

    Parameters
    ----------
    model : FaceGears
        One gear with its pinions, each with as many loads.
    error : PiecewiseChebyshev
        Of a pinion at angle 0, along the gear's axis [m], against t/T0.
    """

    model: FaceGears
    error: PiecewiseChebyshev

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Those of the model."""
        return self.model.coordinates

    @cached_property
    def errors(self) -> tuple[PiecewiseChebyshev, ...]:
        """Transmission error of each pinion."""
        return tuple(self.error.shift(phase) for phase in self.model.gear.mesh_phases)

    def meshes(self, loads: int) -> tuple[range, ...]:
        """Numbers of the loads of each pinion, of so many in all."""
        pairs = loads // len(self.errors)
        return tuple(range(first, first + pairs) for first in range(0, loads, pairs))

    def system(self, speed: float) -> PeriodicSystem:
        """Equations of motion at a constant speed [rad/s]."""
        system = system_at(self.model, speed)
        loads = list(system.loads)
        for error, mesh in zip(self.errors, self.meshes(len(loads)), strict=True):
            for number in mesh:
                loads[number] = replace(loads[number], transmission_error=error)
        return replace(system, loads=tuple(loads))


@dataclass(frozen=True, eq=False)
class DiskResponse:
    """Forced response of a model of the disk, or why there is none.

    Attributes
    ----------
    variant : Variant
    error : float
        Static transmission error along the line of action, from lowest to highest [m]; 0 where there is none.
    data : xarray.Dataset or None
        Of :func:`facegear.maps.response_map.frequency_response`, the force of all tooth pairs of each mesh along the
        normal [N], without the static one.
    reason : str
        Why there is none; empty where there is one.
    before : float
        By how much the force departs from the static one at most, as :attr:`largest`, in a basis with two nodal
        diameters fewer [N]; NaN where there is none.
    """

    variant: Variant
    error: float
    data: xr.Dataset | None
    reason: str
    before: float = math.nan

    @cached_property
    def largest(self) -> float:
        """By how much the force of a mesh departs from the static one at most [N]; NaN where nothing is known."""
        return math.nan if self.data is None else largest_departure(self.data)[0]

    @property
    def moved(self) -> float:
        """Part of :attr:`largest` by which the basis before differs, 0 up; NaN where there is none."""
        return abs(self.before / self.largest - 1.0) if self.largest > 0.0 else math.nan

    @property
    def settled(self) -> bool:
        """Whether two bases agree on :attr:`largest`, to within a tenth of it."""
        return self.moved <= MOST_MOVED


def largest_departure(data: xr.Dataset) -> tuple[float, float]:
    """By how much the force of a mesh departs from the static one at most [N], and at which speed [rad/s]."""
    return largest_force(data, "lowest", "highest")


def transmission_error(variant: Variant, force: float) -> PiecewiseChebyshev | str:
    """Find what the static transmission error of a model departs from its mean, or say why it does not.

    Parameters
    ----------
    variant : Variant
    force : float
        Of all pairs of a mesh along the normal [N].

    Returns
    -------
    PiecewiseChebyshev or str
        Along the line of action [m], of a pinion at angle 0; or a sentence.
    """
    gear = variant.model.gear
    if len(variant.model.driving) > 1:
        return _TWO_GEARS
    # A pair alone, where teeth give way at all.
    stiffness = getattr(gear, "mesh_stiffness", None)
    if stiffness is None:
        return RIGID
    path = gear.contact.path(gear.body.drive, gear.contact.contact_ratio)
    if (loaded := getattr(path, "contact", None)) is not None:
        error = loaded.excitation
    elif (shared := getattr(path, "transmission_error", None)) is not None:
        error = _without_mean(shared(force / stiffness))
    else:
        return EVEN if path.has_lengths else UNLOADED
    return EVEN if error.largest <= _ROUNDING * force / stiffness else error


def _without_mean(error: PiecewiseChebyshev) -> PiecewiseChebyshev:
    coefficients = error.coefficients.copy()
    coefficients[:, 0] -= fourier_series(error, error.breakpoints, 1).mean
    return PiecewiseChebyshev(error.breakpoints, coefficients)


def disk_response(outcome: Outcome, force: float, speeds: FloatArray) -> DiskResponse:
    """Find the forced response of one model, with at most two nodal circles.

    Parameters
    ----------
    outcome : Outcome
    force : float
        Of all pairs of a mesh along the normal, at rest [N].
    speeds : array, shape (S,)
        [rad/s], ascending.

    Returns
    -------
    DiskResponse
    """
    variant = outcome.variant
    try:
        error = transmission_error(variant, force)
        if isinstance(error, str):
            return DiskResponse(variant, 0.0, None, error)
        size = _swing(error)
        share = unstable_share(outcome.tongues, (float(speeds[0]), float(speeds[-1])))
        if share > _MOST_UNSTABLE:
            few = f"nothing is steady at {100 * share:.3g} % of the speeds, where it is unstable"
            return DiskResponse(variant, size, None, few)
        body = variant.model.gear.body
        circles, diameters = min(body.nodal_circles, _CIRCLES), body.nodal_diameters
        model = with_basis(variant.model, circles, diameters)
        data, before = normal_forces(model, error, speeds), math.nan
        if diameters > 2:
            fewer = with_basis(variant.model, circles, diameters - 2)
            before = largest_departure(normal_forces(fewer, error, speeds))[0]
        return DiskResponse(replace(variant, model=model), size, data, "", before)
    except (ArithmeticError, ValueError) as problem:
        return DiskResponse(variant, 0.0, None, told(problem))


def normal_forces(model: FaceGears, error: PiecewiseChebyshev, speeds: FloatArray) -> xr.Dataset:
    """Steady response to a transmission error: forces of whole meshes along the normal [N].

    Parameters
    ----------
    model : FaceGears
        One gear; its pinions on the springs of their teeth.
    error : PiecewiseChebyshev
        Of a pinion at angle 0, along the line of action [m].
    speeds : array, shape (S,)
        [rad/s], ascending.

    Returns
    -------
    xarray.Dataset
        As :func:`facegear.maps.response_map.frequency_response`, "load" numbering the pinions.
    """
    body = model.gear.body
    # A deflection w along the axis closes the teeth by w sin α_c; of their force the part sin α_c is along the axis.
    along_axis = math.sin(body.drive.pressure_angle)
    shaken = Shaken(model, error.transformed([[1.0 / along_axis]]))
    meshes = shaken.meshes(len(shaken.system(float(speeds[0])).loads))
    found = frequency_response(
        shaken, speeds, together=meshes, resolution=_RESOLUTION, jobs=1, progress=False
    )
    # Models of the disk are divided by 2πρh, as (4-8).
    scale = modal_mass(body) / along_axis
    names = [str(name) for name in found.data_vars if "force" in str(name)]
    return found.assign({name: found[name] * scale for name in names})


def _swing(error: PiecewiseChebyshev) -> float:
    """From the lowest to the highest value over a period."""
    edges = np.append(error.breakpoints, 1.0)
    inside = np.linspace(0.0, 1.0, 65)[:-1]
    values = error((edges[:-1, np.newaxis] + np.diff(edges)[:, np.newaxis] * inside).ravel())
    return float(np.ptp(np.concatenate([values, error(edges[1:-1], "left")])))
