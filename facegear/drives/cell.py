"""One cell of a stability map: multipliers, critical motion, and the tongue that it lies in."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy.integrate import solve_ivp

from facegear.floquet.labels import combination
from facegear.floquet.models import Coordinate, Model, require_model, system_at
from facegear.floquet.multipliers import transition_matrix
from facegear.floquet.periodic import PeriodicSystem, require_system
from facegear.maps.tracing import Tongue, tongues
from facegear.support.parameters import positive
from facegear.support.types import ComplexArray, FloatArray

UNSTABLE = 1e-8
"""Growth in a period, max|λ| − 1, from which a cell counts as unstable [-], as for tongues."""

# Tongues are looked for within these factors of the speed of a cell, the next where they pass the ends.
_WINDOWS = (1.04, 1.2)
_RADII, _ANGLES = 25, 121
# Instants of a period and periods of a motion over time.
_INSTANTS, _PERIODS = 48, 6


@dataclass(frozen=True, eq=False)
class CellDetail:
    """One cell of a map.

    Attributes
    ----------
    speed : float
        [rad/s].
    growth_rate : float
        ln(max|λ|)/T0 [1/s].
    multipliers : ndarray of complex, shape (2n,)
        Largest modulus first.
    critical : complex
        The largest one, of a conjugate pair that above the real axis.
    motion : ndarray of complex, shape (n,)
        Displacements of the critical motion at the beginning of a mesh period; real where it is largest.
    tongue : Tongue or None
        The interval of instability that the speed lies in, None if it is stable.
    label : str or None
        Its modes and order, None if stable.
    searched : tuple of float
        Speeds [rad/s] between which the tongue's borders were looked for.
    deflections : dict of str to xarray.DataArray
        Of each part whose coordinates are shapes of a surface: critical motion over ``radius`` [m] and ``angle``
        [rad], complex, the largest modulus of all parts 1.
    history : xarray.DataArray or None
        Of all other coordinates: critical motion over ``time`` [periods] and ``coordinate``, the largest 1.
    """

    speed: float
    growth_rate: float
    multipliers: ComplexArray
    critical: complex
    motion: ComplexArray
    tongue: Tongue | None
    label: str | None
    searched: tuple[float, float]
    deflections: Mapping[str, xr.DataArray]
    history: xr.DataArray | None


def cell_detail(model: Model, speed: float) -> CellDetail:
    """Multipliers, critical motion and tongue of a model at one speed.

    Parameters
    ----------
    model : Model
    speed : float
        [rad/s], greater than 0.

    Returns
    -------
    CellDetail

    Raises
    ------
    TypeError, ValueError
        If `speed` is not a number greater than 0, or the model does not name each of its coordinates.
    """
    require_model(model)
    speed = positive("speed", speed, "rad/s")
    system = system_at(model, speed)
    _require_coordinates(model, system)
    values, vectors = np.linalg.eig(transition_matrix(system))
    # Of a conjugate pair rounding alone would decide.
    order = np.lexsort((-values.imag, -np.abs(values).round(12)))
    values, vectors = values[order], vectors[:, order]
    motion = vectors[: system.size, 0]
    radius = float(np.abs(values).max())
    tongue, searched = None, (speed, speed)
    if radius - 1.0 > UNSTABLE:
        tongue, searched = _tongue_at(model, speed)
    label = tongue.label if tongue else combination(system).label if radius - 1.0 > UNSTABLE else None
    coordinates = model.coordinates
    deflections = _deflections(coordinates, motion)
    shown = [part.values for part in deflections.values()] or [motion]
    largest = max((complex(part.flat[np.abs(part).argmax()]) for part in shown), key=abs)
    bodies = [k for k, coordinate in enumerate(coordinates) if coordinate.surface is None]
    history = None
    if bodies:
        names = [coordinates[k].name for k in bodies]
        history = _history(system, vectors[:, 0] / largest, complex(values[0]), bodies, names)
    return CellDetail(
        speed=speed,
        growth_rate=math.log(radius) / system.period,
        multipliers=values,
        critical=complex(values[0]),
        motion=motion / largest,
        tongue=tongue,
        label=label,
        searched=searched,
        deflections={name: _labelled(part, largest) for name, part in deflections.items()},
        history=history,
    )


def _require_coordinates(model: Model, system: PeriodicSystem) -> None:
    """Refuse a model that does not say what each row of its matrices is."""
    require_system(system)
    named = getattr(model, "coordinates", None)
    wanted = f"model must have coordinates, one floquet.models.Coordinate for each of its {system.size} rows"
    if not isinstance(named, list | tuple) or not all(isinstance(item, Coordinate) for item in named):
        raise TypeError(f"{wanted}, got {named!r}")
    if len(named) != system.size:
        raise ValueError(f"{wanted}, got {len(named)}")


def _tongue_at(model: Model, speed: float) -> tuple[Tongue | None, tuple[float, float]]:
    """Tongue around an unstable speed, looked for further away until both its borders are found."""
    tongue, window = None, (speed, speed)
    for factor in _WINDOWS:
        window = (speed / factor, speed * factor)
        try:
            found = tongues(model, window, threshold=UNSTABLE, hints=(speed,))
        except ArithmeticError:
            # Multipliers too large to be known to the threshold: no borders, but the cell still has its label.
            return None, window
        tongue = next((t for t in found if t.lower <= speed <= t.upper), None)
        if tongue is None or (window[0] < tongue.lower and tongue.upper < window[1]):
            break
    return tongue, window


class _Deflection(NamedTuple):
    """Deflection of one part, (radii, angles), complex."""

    radius: FloatArray
    angle: FloatArray
    values: ComplexArray


def _deflections(coordinates: Sequence[Coordinate], motion: ComplexArray) -> dict[str, _Deflection]:
    """Deflection in a motion of every part that has surfaces."""
    parts: dict[str, _Deflection] = {}
    for coordinate, amplitude in zip(coordinates, motion, strict=True):
        surface = coordinate.surface
        if surface is None:
            continue
        if coordinate.part not in parts:
            radius = np.linspace(surface.inner_radius, surface.outer_radius, _RADII)
            angle = np.linspace(0.0, 2.0 * np.pi, _ANGLES)
            parts[coordinate.part] = _Deflection(radius, angle, np.zeros((_RADII, _ANGLES), dtype=complex))
        part = parts[coordinate.part]
        part.values[:] += amplitude * surface.deflection(part.radius[:, np.newaxis], part.angle)
    return parts


def _labelled(part: _Deflection, largest: complex) -> xr.DataArray:
    return xr.DataArray(
        part.values / largest,
        dims=("radius", "angle"),
        coords={
            "radius": ("radius", part.radius, {"units": "m"}),
            "angle": ("angle", part.angle, {"units": "rad"}),
        },
        name="deflection",
        attrs={"units": "1", "long_name": "deflection over its largest amplitude"},
    )


def _history(
    system: PeriodicSystem, state: ComplexArray, critical: complex, chosen: list[int], names: list[str]
) -> xr.DataArray:
    """Chosen displacements of the critical motion over some periods: integrated over one, λ times that in the next."""
    jumps = dict(system.state_jumps())
    edges = np.append(system.breakpoints, 1.0)
    instants, motion = [], []
    for start, end in itertools.pairwise(edges):
        if start in jumps:
            state = jumps[start] @ state
        # The derivative at the end of a piece is that from the left, wherever the integrator asks for it.
        piece = solve_ivp(
            lambda x, y, end=end: system.period * system.state_matrix(x, "left" if x >= end else "right") @ y,
            (start, end),
            state,
            t_eval=np.linspace(start, end, max(2, math.ceil(_INSTANTS * (end - start)) + 1)),
            method="DOP853",
            rtol=1e-8,
            atol=1e-10,
        )
        instants.append(piece.t)
        motion.append(piece.y[chosen].T)
        state = piece.y[:, -1]
    once, time = np.concatenate(motion), np.concatenate(instants)
    periods = np.arange(_PERIODS)
    whole = (critical ** periods[:, np.newaxis, np.newaxis] * once).reshape(-1, len(chosen)).real
    return xr.DataArray(
        whole / np.abs(whole).max(),
        dims=("time", "coordinate"),
        coords={
            "time": ("time", (periods[:, np.newaxis] + time).ravel(), {"units": "periods"}),
            "coordinate": names,
        },
        name="history",
        attrs={"units": "1", "long_name": "displacement over the largest one"},
    )
