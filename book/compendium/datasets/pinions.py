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
from facegear.design.cancellation import Kind, WavePair, interference, phasing_sum, tongue_of, weakened
from facegear.geometry.drive import Drive
from facegear.geometry.phases import phase_split
from facegear.maps.parallel import computed, in_processes, parts_of
from facegear.maps.tracing import tongues
from facegear.mechanics.rotation import growth_rates_at_angles
from facegear.mechanics.transverse import Transverse
from facegear.support.labelled import text, variable
from facegear.support.parameters import finite_array, integer_at_least, rad_per_s, rpm
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


def two_pinion_chart(gear_teeth: int, wave_numbers: Sequence[int], angles_deg: ArrayLike) -> xr.Dataset:
    """Part of a tongue's strength that a second pinion leaves, against the total angle (design chart).

    Parameters
    ----------
    gear_teeth : int
        N2.
    wave_numbers : sequence of int
        n_1 ± n_2.
    angles_deg : array_like
        Total angles [°].

    Returns
    -------
    xarray.Dataset
        ``remaining`` (wave_number, total_angle), |S|/2 [-].
    """
    angles = finite_array("angles_deg", angles_deg, "°")
    pairs = np.stack([np.zeros_like(angles), np.radians(angles)], axis=-1)
    rows = [np.abs(phasing_sum(gear_teeth, pairs, number)) / 2 for number in wave_numbers]
    return xr.Dataset(
        {"remaining": _number(("wave_number", "total_angle"), rows, "|S|/p")},
        coords={"wave_number": list(wave_numbers), "total_angle": angles},
        attrs={"parameters": f"gear_teeth = {gear_teeth}, first order"},
    )


def array_chart(
    gear_teeth: Sequence[int], layouts: Mapping[str, Sequence[float]], wave_numbers: Sequence[int]
) -> xr.Dataset:
    """Part of a tongue's strength that several pinions leave, for each combination (design chart).

    Parameters
    ----------
    gear_teeth : sequence of int
        N2.
    layouts : mapping of str to sequence of float
        Name of an arrangement to its angles [°].
    wave_numbers : sequence of int
        n_1 ± n_2.

    Returns
    -------
    xarray.Dataset
        ``remaining`` (gear_teeth, layout, wave_number), |S|/p [-]; names of the layouts in the coordinate
        ``layout_name``.
    """
    table = [
        [
            [abs(phasing_sum(teeth, np.radians(angles), number)) / len(angles) for number in wave_numbers]
            for angles in layouts.values()
        ]
        for teeth in gear_teeth
    ]
    return xr.Dataset(
        {"remaining": _number(("gear_teeth", "layout", "wave_number"), table, "|S|/p")},
        coords={
            "gear_teeth": list(gear_teeth),
            "layout": np.arange(len(layouts)),
            "layout_name": text("layout", list(layouts), "Pinions and their angles in degrees"),
            "wave_number": list(wave_numbers),
        },
        attrs={
            "parameters": f"angles = {[tuple(a) for a in layouts.values()]}, first order",
        },
    )


def weak_tongues(
    model: Transverse,
    pairs: Mapping[str, WavePair],
    layouts: Sequence[Sequence[float]],
    factors: Sequence[float],
    *,
    jobs: int = -1,
) -> xr.Dataset:
    """Tongues of weak loads against the sum over the pinions (C-1).

    Parameters
    ----------
    model : Transverse
        Disk and load.
    pairs : mapping of str to WavePair
        Names to pairs of waves.
    layouts : sequence of sequence of float
        Angles of the pinions [°].
    factors : sequence of float
        Parts of the load, see :func:`facegear.design.cancellation.weakened`.
    jobs : int, optional
        Number of processes, as joblib's ``n_jobs``; -1 for all processors.

    Returns
    -------
    xarray.Dataset
        ``growth`` and ``width`` (factor, pair, layout), over those of one pinion, and ``phasing_sum`` (pair, layout),
        |S|; 0 where there is no tongue.
    """
    arrangements = [(0.0,), *(tuple(layout) for layout in layouts)]
    tasks = [
        (with_pinions(weakened(model, factor), *angles), pair, factor)
        for factor in factors
        for pair in pairs.values()
        for angles in arrangements
    ]
    rows = in_processes(_growth_and_width, tasks, jobs)
    found = np.asarray(rows, dtype=float).reshape(len(factors), len(pairs), len(arrangements), 2)
    relative = found[:, :, 1:] / found[:, :, :1]
    sums = [
        [abs(pair.phasing_sum(with_pinions(model, *angles))) for angles in arrangements[1:]]
        for pair in pairs.values()
    ]
    all_three = ("factor", "pair", "layout")
    return xr.Dataset(
        {
            "growth": variable(
                all_three, relative[..., 0], "Growth rate over that of one pinion", "1", atol=1e-5
            ),
            "width": variable(all_three, relative[..., 1], "Width over that of one pinion", "1", atol=1e-4),
            "phasing_sum": _number(("pair", "layout"), sums, "|S|"),
        },
        coords={
            "factor": list(factors),
            "pair": np.arange(len(pairs)),
            "pair_name": text("pair", list(pairs), "Pair of waves"),
            "layout": np.arange(len(layouts)),
        },
        attrs={
            "parameters": f"{describe(model)}, angles = {[tuple(a) for a in layouts]}, pairs = {tuple(pairs.values())}",
        },
    )


def _growth_and_width(model: Transverse, pair: WavePair, factor: float) -> tuple[float, float]:
    # Far enough for the shift by the mean of the load, not as far as the tongues of other pairs.
    step = factor * len(model.pinion_angles)
    tongue = tongue_of(model, pair, 0.04 * step, 0.005 * step)
    return (0.0, 0.0) if tongue is None else (tongue.growth_rate, float(rpm(tongue.width)))


def interference_curves(
    model: Transverse,
    teeth: Sequence[int],
    phases: ArrayLike,
    modes: Mapping[tuple[int, int], float],
    kind: Kind = "sum",
) -> xr.Dataset:
    """Part of the couplings of two modes that two pinions leave, against their phase.

    Parameters
    ----------
    model : Transverse
        Disk and load.
    teeth : sequence of int
        ΔN2.
    phases : array_like
        ψ.
    modes : mapping of (int, int) to float
        Numbers of two natural frequencies to the speed of the face gear [rpm] at which they combine.
    kind : {"sum", "difference"}
        Of the combination.

    Returns
    -------
    xarray.Dataset
        ``interference`` (teeth, modes, phase), 0 to 1.
    """
    psi = finite_array("phases", phases)
    pitch = model.body.drive.angular_pitch
    table = np.empty((len(teeth), len(modes), psi.size))
    for i, number in enumerate(teeth):
        for m, phase in enumerate(psi.tolist()):
            placed = replace(model, pinion_angles=(0.0, (number + phase) * pitch))
            for n, ((k, j), speed) in enumerate(modes.items()):
                table[i, n, m] = interference(placed.system(float(rad_per_s(speed))), k, j, kind)
    return xr.Dataset(
        {
            "interference": variable(
                ("teeth", "modes", "phase"), table, "|Σ| over Σ|.| of the couplings", "1", atol=1e-7
            )
        },
        coords={
            "teeth": list(teeth),
            "modes": np.arange(len(modes)),
            "mode_pair": text("modes", [f"({k}+{j})" for k, j in modes], "Numbers of the two modes"),
            "phase": psi,
        },
        attrs={"parameters": f"{describe(model)}, {dict(modes)}"},
    )
