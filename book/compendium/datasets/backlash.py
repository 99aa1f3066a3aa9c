"""Arrays of the section on backlash, with units and tolerances."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from facegear.floquet.branches import Branch
from facegear.floquet.clearance import ClearanceSystem
from facegear.floquet.continuation import followed, orbits_at
from facegear.floquet.orbits import Orbit, periodic_orbit
from facegear.floquet.transients import settled
from facegear.mechanics.backlash import Backlash
from facegear.support.labelled import text, variable
from facegear.support.parameters import rad_per_s, rpm
from facegear.support.types import FloatArray

# How near a speed may be to where motions meet [rpm].
_CLEAR = 3.0


def statistics(model: Backlash, orbit: Orbit) -> tuple[float, ...]:
    """Mean, rms, lowest and highest mesh deformation [m]; 0 pressed, 1 parts, 2 strikes back; deformation at 0.

    The last is the deformation as the period begins, which tells one motion from another and from no motion.
    """

    def deformation(x: np.ndarray) -> np.ndarray:
        return model.deformation(orbit, x)

    mean = float(orbit.response.mean(deformation))
    square = float(orbit.response.mean(lambda x: (deformation(x) - mean) ** 2))
    lowest, highest = (float(x) for x in orbit.response.extremes(deformation))
    contact = 2.0 if model.strikes_back(orbit) else float(model.parts(orbit))
    return mean, math.sqrt(square), lowest, highest, contact, float(deformation(np.zeros(1))[0])


def response(
    model: Backlash, branches: Mapping[str, Branch], speeds_rpm: ArrayLike, largest: float
) -> xr.Dataset:
    """Mesh deformation of every sheet of some families at given speeds; not a number where there is none.

    None is given within 3 rpm of a fold or flip of any family, where motions that are about to meet are found by
    Newton's method on one machine and missed on another.

    Parameters
    ----------
    model : Backlash
    branches : mapping of str to Branch
    speeds_rpm : array_like
    largest : float
        Deformation above which motions are left out [m].
    """
    shown = np.asarray(speeds_rpm, dtype=float)
    meet = np.array([speed for *_, speed in special(branches)])
    clear = np.abs(shown[:, np.newaxis] - meet).min(axis=1, initial=np.inf) > _CLEAR

    def at(branch: Branch, speed_rpm: float) -> tuple[Orbit | None, ...]:
        return orbits_at(model.system, branch, float(rad_per_s(speed_rpm)))

    return _response(model, branches, at, ("speed", shown, clear), largest)


def torque_response(
    model: Backlash, speed_rpm: float, torques: ArrayLike, largest: float
) -> tuple[Branch, xr.Dataset]:
    """Follow the pressed motion from the largest torque down, and give its statistics as :func:`response` does.

    None are given within three percent of a fold or flip.

    Parameters
    ----------
    model : Backlash
    speed_rpm : float
    torques : array_like
        Ascending [N m].
    largest : float
        Deformation above which motions are left out [m].
    """
    shown, speed = np.asarray(torques, dtype=float), float(rad_per_s(speed_rpm))

    def under(torque: float) -> ClearanceSystem:
        return replace(model, torque=torque).system(speed)

    low, high = float(shown[0]), float(shown[-1])
    branch = followed(under, high, periodic_orbit(under(high)), low, high, direction=-1.0)
    meet = np.array([point.parameter for point in branch.special])
    clear = np.abs(np.log(shown[:, np.newaxis] / meet)).min(axis=1, initial=np.inf) > 0.03

    def at(branch: Branch, torque: float) -> tuple[Orbit | None, ...]:
        return orbits_at(under, branch, torque)

    return branch, _response(model, {"from above": branch}, at, ("torque", shown, clear), largest)


def _response(
    model: Backlash,
    branches: Mapping[str, Branch],
    at: Callable[[Branch, float], tuple[Orbit | None, ...]],
    axis: tuple[str, FloatArray, FloatArray],
    largest: float,
) -> xr.Dataset:
    """Statistics of every sheet of some families along an axis: its name, its values, and which are to be looked at."""
    name, shown, clear = axis
    names, periods, rows = [], [], []
    for family, branch in branches.items():
        columns = [at(branch, x) for x in shown[clear].tolist()]
        for sheet in zip(*columns, strict=True):
            table = np.full((shown.size, 7), np.nan)
            for place, orbit in zip(np.flatnonzero(clear), sheet, strict=True):
                if orbit is not None:
                    values = statistics(model, orbit)
                    if values[3] < largest:
                        table[place] = (*values, float(orbit.is_stable))
            if np.isfinite(table).any():
                names.append(family)
                periods.append(branch.orbits[0].periods)
                rows.append(table)
    stacked, both = np.moveaxis(np.array(rows), -1, 0), ("sheet", name)
    words = ("mean", "rms", "lowest", "highest")
    sizes = {
        word: variable(both, part, f"Mesh deformation, {word}", units="m", rtol=1e-6, atol=1e-12)
        for word, part in zip(words, stacked[:4], strict=True)
    }
    contact = variable(both, stacked[4], "0 pressed, 1 parts, 2 strikes back", units="1", atol=0.1)
    sizes["entering"] = variable(
        both, stacked[5], "Mesh deformation as a pair enters", units="m", rtol=1e-6, atol=1e-12
    )
    stable = variable(both, stacked[6], "1 where stable", units="1", atol=0.1)
    coordinates = {
        "sheet": np.arange(len(names)),
        name: shown,
        "family": text("sheet", names, "Family"),
        "periods": ("sheet", periods),
    }
    return xr.Dataset({**sizes, "contact": contact, "stable": stable}, coordinates)


def special(branches: Mapping[str, Branch]) -> list[tuple[str, str, int, float]]:
    """Family, kind, periods and speed [rpm] of every special point."""
    return [
        (name, point.kind, point.orbit.periods, float(rpm(point.parameter)))
        for name, branch in branches.items()
        for point in branch.special
    ]


def basins(
    model: Backlash, speed_rpm: float, spread: float, count: int, periods: int, seed: int
) -> xr.Dataset:
    """Where motions from states drawn about the pressed one end: lowest and highest deformation of the last periods.

    Parameters
    ----------
    model : Backlash
    speed_rpm : float
    spread : float
        Half the width of the box of initial states, in sizes of the pressed motion about its mean.
    count, periods, seed : int
    """
    system = model.system(float(rad_per_s(speed_rpm)))
    pressed = periodic_orbit(system)
    states = pressed.state(np.linspace(0.0, 1.0, 200))
    box = np.ptp(states, axis=0) / 2.0
    drawn = pressed.start + spread * box * np.random.default_rng(seed).uniform(-1.0, 1.0, (count, box.size))
    with np.errstate(over="ignore", invalid="ignore"):
        ends = settled(system, drawn, periods, kept=12)
    deformation = model.torsional.deformation(ends[..., :3])
    return xr.Dataset(
        {
            "lowest": variable(
                ("state",), deformation.min(axis=0), "Lowest deformation", units="m", rtol=1.0
            ),
            "highest": variable(
                ("state",), deformation.max(axis=0), "Highest deformation", units="m", rtol=1.0
            ),
        },
        {"state": np.arange(count)},
        {"speed_rpm": speed_rpm},
    )


def shares(data: xr.Dataset, bounds: Sequence[float]) -> list[tuple[int, float, float]]:
    """Count states whose highest deformation lies between bounds, with Wilson's interval of 95 % for the share."""
    highest = np.nan_to_num(np.abs(data.highest.values), nan=np.inf)
    counts, _ = np.histogram(np.minimum(highest, 1e300), [0.0, *bounds, 1e301])
    total, z = highest.size, 1.96
    rows = []
    for count in counts.tolist():
        share = count / total
        middle = (share + z**2 / (2 * total)) / (1 + z**2 / total)
        half = z * math.sqrt(share * (1 - share) / total + z**2 / (4 * total**2)) / (1 + z**2 / total)
        rows.append((count, middle - half, middle + half))
    return rows


def large_motions(model: Backlash, speeds_rpm: ArrayLike, periods: int, seed: int = 0) -> xr.Dataset:
    """Growth a mesh period of motions beside which gap and torque are nothing."""
    grown = []
    size = 1e6 * np.abs(periodic_orbit(model.system(float(rad_per_s(800.0)))).start)
    for speed in np.asarray(speeds_rpm, dtype=float):
        system = model.system(float(rad_per_s(speed)))
        drawn = size * np.random.default_rng(seed).uniform(-1.0, 1.0, (8, size.size))
        ends = settled(system, drawn, periods, kept=periods // 2 + 1)
        sizes = np.linalg.norm(ends / size, axis=2)
        grown.append(np.log(sizes[-1] / sizes[0]).max() / (periods // 2))
    growth = variable(("speed",), grown, "Growth a mesh period", units="1", atol=0.02)
    return xr.Dataset({"growth": growth}, {"speed": np.asarray(speeds_rpm, dtype=float)})


def large_runs(data: xr.Dataset, least: float) -> list[tuple[float, float]]:
    """List intervals of speed [rpm] in which the motions of :func:`large_motions` grow by more than `least` a period.

    To the spacing of the speeds. An estimate from some periods scatters, for motions beat.
    """
    edges = np.flatnonzero(np.diff(np.concatenate([[0], data.growth.values > least, [0]])))
    speed = data.speed.values
    return [(float(speed[i]), float(speed[j - 1])) for i, j in zip(edges[::2], edges[1::2], strict=True)]
