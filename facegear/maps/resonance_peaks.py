"""Peaks of a steady response over speed: where a resonance makes a force largest, however narrow it is."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from facegear.floquet.models import Model
from facegear.floquet.modes import mean_matrices, natural_exponents
from facegear.support.types import FloatArray

# Harmonics of the mesh that are looked for between speeds.
_HARMONICS = 6
# Part of the largest force that is no peak, but rounding.
_NOISE = 1e-10
# Steps of the resolution within which a peak is at a border of instability.
_AT_BORDER = 10.0


def peaks_of(
    speeds: FloatArray,
    forces: FloatArray,
    forces_at: Callable[[float], FloatArray],
    label_at: Callable[[float], str],
    resolution: float,
) -> tuple[dict[str, Any], int]:
    """Find local maxima of the rms of each load's force over speed, each between its neighbours, and label them.

    Parameters
    ----------
    speeds : array, shape (S,)
        Ascending [rad/s].
    forces : array, shape (S, loads, 3)
        Rms of what varies, lowest and highest value of each force; NaN where there is no response.
    forces_at, label_at : callable
        Forces (loads, 3) at a speed, and the resonance that they are of.
    resolution : float
        Part of its speed to which that of a peak is found.

    Returns
    -------
    variables : dict
        For a dataset, along "peak".
    at_borders : int
        How many were left out because they are at a border of instability.
    """
    from scipy.signal import find_peaks

    peaks: list[tuple[float, int, float, float, float, str]] = []
    at_borders = 0
    for load in range(forces.shape[1]):
        rms = forces[:, load, 0]
        noise = _NOISE * float(np.nan_to_num(np.abs(forces[:, load, 1:])).max())
        # Next to where nothing is known nobody can tell.
        finite = np.flatnonzero(np.isfinite(rms))
        for run in np.split(finite, np.flatnonzero(np.diff(finite) > 1) + 1):
            for i in find_peaks(rms[run], prominence=max(noise, np.finfo(float).tiny))[0].tolist():
                three = run[i - 1 : i + 2]
                known = dict(zip(speeds[three].tolist(), forces[three], strict=True))
                speed, found, at_border = _settled(forces_at, load, known, resolution)
                if at_border:
                    at_borders += 1
                    continue
                peaks.append((speed, load, *found[load].tolist(), label_at(speed)))
    peaks.sort()
    columns = [list(column) for column in zip(*peaks, strict=True)] if peaks else [[]] * 6
    places, loads, values, lowest, highest, labels = columns
    extremes = {"lowest": lowest, "highest": highest}
    variables = {
        "peak_speed": (
            "peak",
            np.array(places, dtype=float),
            {"units": "rad/s", "long_name": "speed of a peak"},
        ),
        "peak_load": ("peak", np.array(loads, dtype=int), {"long_name": "load"}),
        "peak_force_rms": (
            "peak",
            np.array(values, dtype=float),
            {"long_name": "rms of the force's varying part"},
        ),
        **{
            f"peak_force_{name}": (
                "peak",
                np.array(column, dtype=float),
                {"long_name": f"{name} force over the period"},
            )
            for name, column in extremes.items()
        },
        "peak_label": (
            "peak",
            np.array(labels, dtype=str),
            {"long_name": "number of the mode / harmonic of the mesh"},
        ),
    }
    return variables, at_borders


def _settled(
    forces_at: Callable[[float], FloatArray],
    load: int,
    known: dict[float, FloatArray],
    resolution: float,
) -> tuple[float, FloatArray, bool]:
    """Find a peak of a load between the first and the last of three known speeds.

    Returns its speed and forces, and whether a speed without a response is all but as near as the resolution.
    """
    bracket = tuple(known)
    forces = dict(known)

    def depth(speed: float) -> float:
        if speed not in forces:
            forces[speed] = forces_at(speed)
        return -float(np.nan_to_num(forces[speed][load, 0]))

    if depth(bracket[1]) < min(depth(bracket[0]), depth(bracket[2])):
        minimize_scalar(depth, bracket=bracket, method="brent", options={"xtol": resolution})
    best = min(forces, key=depth)
    unknown = [speed for speed, found in forces.items() if np.isnan(found[load, 0])]
    at_border = any(abs(speed - best) <= _AT_BORDER * resolution * best for speed in unknown)
    return best, forces[best], at_border


def resonances_between(model: Model, speeds: FloatArray, resolution: float) -> FloatArray:
    """Find speeds at which a natural frequency meets a harmonic of the mesh and none of those given is near it.

    Near is the half width of the resonance, the decay of the natural motion over its frequency.

    Parameters
    ----------
    model : Model
    speeds : array, shape (S,)
        Ascending [rad/s].
    resolution : float
        Part of a speed to which it is found.

    Returns
    -------
    ndarray
        Ascending [rad/s].
    """

    def detuned(speed: float) -> tuple[FloatArray, FloatArray]:
        """Frequencies less each harmonic [rad/s], ascending, and decays, shapes (harmonics, n) and (n,)."""
        system = model.system(speed)
        exponents = natural_exponents(*mean_matrices(system))
        exponents = exponents[np.argsort(exponents.imag)][system.size :]
        harmonics = 2.0 * np.pi / system.period * np.arange(1, _HARMONICS + 1)
        return exponents.imag - harmonics[:, np.newaxis], -exponents.real

    found = []
    ends = [detuned(speed) for speed in speeds.tolist()]
    for low, high, (first, decay), (last, _) in zip(speeds, speeds[1:], ends, ends[1:], strict=False):
        narrow = (first > 0.0) & (last < 0.0) & (np.abs(decay) < 0.5 * (first - last))
        for harmonic, mode in np.argwhere(narrow).tolist():

            def away(speed: float, harmonic: int = harmonic, mode: int = mode) -> float:
                return float(detuned(speed)[0][harmonic, mode])

            found.append(brentq(away, low, high, rtol=resolution, xtol=resolution * low))
    return np.unique(np.array(found, dtype=float))
