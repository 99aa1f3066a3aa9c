"""Arrays of chapter 5's charts of what silences a tongue, with units and tolerances; angles are degrees."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from compendium.datasets.pinions import with_pinions
from compendium.datasets.transverse import describe
from facegear.design.cancellation import Kind, WavePair, interference, phasing_sum, tongue_of, weakened
from facegear.maps.parallel import in_processes
from facegear.mechanics.transverse import Transverse
from facegear.support.labelled import text, variable
from facegear.support.parameters import finite_array, rad_per_s, rpm

_number = partial(variable, units="1", atol=1e-9)


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
