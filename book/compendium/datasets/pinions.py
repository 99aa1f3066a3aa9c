"""Arrays of chapter 5's figures, labelled, with units and the tolerances at which they are checked.

Angles are degrees here, as the figures have them.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from compendium.datasets.transverse import describe, tongue_table
from facegear.geometry.drive import Drive
from facegear.geometry.phases import phase_split
from facegear.maps.parallel import computed, in_processes, parts_of
from facegear.maps.tracing import tongues
from facegear.mechanics.rotation import growth_rates_at_angles
from facegear.mechanics.transverse import Transverse
from facegear.support.labelled import variable
from facegear.support.parameters import finite_array, integer_at_least, rad_per_s
from facegear.support.types import FloatArray

_growth = partial(variable, units="1/s", rtol=1e-6, atol=1e-3)
_number = partial(variable, units="1", atol=1e-9)


def with_pinions(model: Transverse, *angles_deg: float) -> Transverse:
    """Return the model with pinions at the given angles [°]."""
    return replace(model, pinion_angles=tuple(math.radians(angle) for angle in angles_deg))


def with_teeth(model: Transverse, pinion_teeth: int) -> Transverse:
    """Return the model with another number of pinion teeth, gear ratio and module kept."""
    drive = model.body.drive
    teeth = integer_at_least("pinion_teeth", pinion_teeth, 1) * drive.gear_teeth
    if teeth % drive.pinion_teeth:
        raise ValueError(
            f"pinion_teeth = {pinion_teeth} gives the face gear no whole number of teeth at this gear ratio"
        )
    resized = replace(drive, pinion_teeth=pinion_teeth, gear_teeth=teeth // drive.pinion_teeth)
    return replace(model, body=replace(model.body, drive=resized))


def phase_relation(drive: Drive, highest_deg: float, samples: int) -> xr.Dataset:
    """Phase between two pinions against the total angle (Fig. 5.3).

    Parameters
    ----------
    drive : Drive
    highest_deg : float
        End of the axis [°].
    samples : int
        Angles from 0.

    Returns
    -------
    xarray.Dataset
        ``phase`` [-] and ``teeth`` over total_angle [°].
    """
    angles = np.linspace(0.0, highest_deg, integer_at_least("samples", samples, 2))
    split = phase_split(drive, np.radians(angles))
    return xr.Dataset(
        {
            "phase": _number("total_angle", split.phase, "Phase between the pinions"),
            "teeth": variable("total_angle", split.teeth, "Whole face-gear teeth between the pinions", "1"),
        },
        coords={"total_angle": angles},
        attrs={"parameters": f"gear_teeth = {drive.gear_teeth}"},
    )


@dataclass(frozen=True, eq=False)
class _Column:
    """Growth rates at one speed [rad/s] for many sets of pinion angles [rad].

    Not a column of :func:`facegear.maps.stability_map.stability_map`: angles are no parameter along which matrices are
    interpolated, but a rotation of waves that :mod:`facegear.mechanics.rotation` carries out exactly, from one
    preparation a phase and ten times faster.
    """

    model: Transverse
    speed: float
    angles: FloatArray

    def content(self) -> Iterator[Any]:
        """Everything the result depends on."""
        yield from (self.speed, self.angles)
        yield from parts_of(self.model.system(self.speed))

    def compute(self) -> FloatArray:
        """Growth rates [1/s], shape (V,)."""
        return growth_rates_at_angles(self.model, self.speed, self.angles)


def _growth_table(model: Transverse, speeds_rpm: ArrayLike, angles: FloatArray, jobs: int) -> FloatArray:
    """Growth rates [1/s] for sets of angles (V, p) [rad] over speeds, shape (V, S)."""
    speeds = np.asarray(rad_per_s(finite_array("speeds_rpm", speeds_rpm, "rpm")), dtype=float)
    columns = [_Column(model, float(speed), angles) for speed in speeds]
    table = np.empty((angles.shape[0], speeds.size))
    for number, column in computed(columns, "pinion angles", jobs, False, None, "threads"):
        table[:, number] = column
    return table


def pitches(first: int, last: int, steps: int) -> FloatArray:
    """Total angles from one whole number of face-gear teeth to another, in angular pitches with `steps` to each."""
    count = integer_at_least("steps", steps, 1) * (last - first) + 1
    return first + np.arange(count) / steps


def angle_map(
    model: Transverse,
    speeds_rpm: ArrayLike,
    angles_in_pitches: ArrayLike,
    *,
    fixed: Sequence[float] = (0.0,),
    moving: Sequence[float] = (0.0,),
    jobs: int = -1,
) -> xr.Dataset:
    """Growth rates over speed and the total angle between two groups of pinions (Figs 5.5, 5.6).

    Parameters
    ----------
    model : Transverse
        Disk and load.
    speeds_rpm : array_like
        Speeds of the face gear [rpm], ascending.
    angles_in_pitches : array_like, shape (V,)
        Total angles in angular pitches θ_N; whole numbers are positioning angles.
    fixed : sequence of float, optional
        Angles of the pinions that stay [°]; one at 0 if left out.
    moving : sequence of float, optional
        Angles of the others from the total angle [°]; one at it if left out.
    jobs : int, optional
        Number of workers.

    Returns
    -------
    xarray.Dataset
        ``growth_rate`` (total_angle, speed_rpm) [1/s], total_angle in degrees.
    """
    angles = finite_array("angles_in_pitches", angles_in_pitches) * model.body.drive.angular_pitch
    staying = np.broadcast_to(np.radians(np.asarray(fixed, dtype=float)), (angles.size, len(fixed)))
    turning = angles[:, np.newaxis] + np.radians(np.asarray(moving, dtype=float))
    table = _growth_table(model, speeds_rpm, np.concatenate([staying, turning], axis=1), jobs)
    return xr.Dataset(
        {"growth_rate": _growth(("total_angle", "speed_rpm"), table, "Growth rate ln(max|λ|)/T0")},
        coords={"total_angle": np.degrees(angles), "speed_rpm": np.asarray(speeds_rpm, dtype=float)},
        attrs={
            "parameters": f"{describe(model)}, swept = total angle, pinions at {tuple(fixed)} deg and "
            f"{tuple(moving)} deg from it"
        },
    )


def phase_maps(
    model: Transverse, speeds_rpm: ArrayLike, teeth: Sequence[int], phases: ArrayLike, *, jobs: int = -1
) -> tuple[xr.Dataset, ...]:
    """Growth rates over speed and phase, one map for each positioning angle (Fig. 5.7).

    Parameters
    ----------
    model : Transverse
        Disk and load.
    speeds_rpm : array_like
        Speeds of the face gear [rpm], ascending.
    teeth : sequence of int
        ΔN2 of each positioning angle.
    phases : array_like
        ψ, from 0 to 1.
    jobs : int, optional
        Number of workers.

    Returns
    -------
    tuple of xarray.Dataset
        ``growth_rate`` (phase, speed_rpm) [1/s].
    """
    psi = finite_array("phases", phases)
    numbers = np.asarray([integer_at_least("teeth", number, 1) for number in teeth])
    # Together: what belongs to a phase is prepared once.
    second = ((numbers[:, np.newaxis] + psi) * model.body.drive.angular_pitch).ravel()
    table = _growth_table(model, speeds_rpm, np.stack([np.zeros_like(second), second], axis=1), jobs)
    return tuple(
        xr.Dataset(
            {"growth_rate": _growth(("phase", "speed_rpm"), rows, "Growth rate ln(max|λ|)/T0")},
            coords={"phase": psi, "speed_rpm": np.asarray(speeds_rpm, dtype=float)},
            attrs={"parameters": f"{describe(model)}, swept = phase, teeth = {number}"},
        )
        for number, rows in zip(numbers, table.reshape(numbers.size, psi.size, -1), strict=True)
    )


def with_tongues(chart: xr.Dataset, tongues_of_sections: xr.Dataset) -> xr.Dataset:
    """Return a map together with traced tongues of some of its lines."""
    return chart.assign(tongues_of_sections.data_vars)


def traced(
    models: Mapping[float, Transverse], speeds_rpm: tuple[float, float], *, jobs: int = -1
) -> xr.Dataset:
    """Trace all tongues of several models (Fig. 5.11 and sections of others).

    Parameters
    ----------
    models : mapping of float to Transverse
        What the figure has on its vertical axis to the model there.
    speeds_rpm : tuple of float
        Lowest and highest speed of the face gear [rpm].
    jobs : int, optional
        Number of processes, as joblib's ``n_jobs``; -1 for all processors.

    Returns
    -------
    xarray.Dataset
        As :func:`compendium.datasets.transverse.tongue_sections`.
    """
    low, high = (float(rad_per_s(speed)) for speed in speeds_rpm)
    found = in_processes(tongues, [(model, (low, high)) for model in models.values()], jobs)
    first = next(iter(models.values()))
    return tongue_table(
        found, list(models), f"{describe(first)}, from {speeds_rpm[0]:g} to {speeds_rpm[1]:g} rpm"
    )


def tooth_counts(
    model: Transverse,
    total_angle_deg: float,
    pinion_teeth: Sequence[int],
    speeds_rpm: tuple[float, float],
    *,
    jobs: int = -1,
) -> xr.Dataset:
    """Tongues of two pinions at a fixed angle for several tooth counts, gear ratio and module kept (Fig. 5.11).

    Parameters
    ----------
    model : Transverse
        Disk and load.
    total_angle_deg : float
        θ_c [°].
    pinion_teeth : sequence of int
        N1.
    speeds_rpm, jobs
        As for :func:`traced`.

    Returns
    -------
    xarray.Dataset
        As :func:`traced`, ``section`` holds N1.
    """
    placed = with_pinions(model, 0.0, total_angle_deg)
    return traced({float(n): with_teeth(placed, n) for n in pinion_teeth}, speeds_rpm, jobs=jobs)
