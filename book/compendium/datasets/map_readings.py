"""What a computed map says: how much of it is unstable, where it is not, and whether a tongue was missed."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
import xarray as xr

from facegear.floquet.models import replace_parameter
from facegear.maps.tracing import tongues
from facegear.mechanics.transverse import Transverse
from facegear.support.parameters import rad_per_s


def unstable_share(chart: xr.Dataset) -> float:
    """Share of the cells of a map that are unstable [-]."""
    return float((chart["growth_rate"] > 0.0).mean())


def tongue_free(model: Transverse, chart: xr.Dataset, lowest_rpm: float) -> tuple[tuple[float, float], ...]:
    """Windows of the swept parameter in which no tongue is found at any speed.

    A grid of speeds can miss a narrow tongue. So runs of rows without an unstable cell are searched for tongues
    between `lowest_rpm` and the highest speed: from both ends of a run inwards until a row has none, and once in the
    middle between the two. What can be missed is a tongue that opens and closes between the rows searched and
    between the columns of the map. Nothing is said of values beyond the axis.

    Parameters
    ----------
    model : Transverse
        The model of the map.
    chart : xarray.Dataset
        From :func:`compendium.datasets.transverse.growth_map`.
    lowest_rpm : float
        Lowest speed of the face gear at which tongues are searched for [rpm].

    Returns
    -------
    tuple of (float, float)
        First and last value of the axis found free, ascending. Runs shorter than a thirtieth of the axis are left out.
    """
    growth = chart["growth_rate"]
    name = str(growth.dims[0])
    values = growth[name].values.tolist()
    low, high = rad_per_s(lowest_rpm), rad_per_s(float(growth["speed_rpm"][-1]))

    @cache
    def free(row: int) -> bool:
        return not tongues(replace_parameter(model, name, values[row]), (low, high))

    stable = np.concatenate([[False], ~(growth.values > 0.0).any(axis=1), [False]])
    starts, stops = np.flatnonzero(stable[1:] & ~stable[:-1]), np.flatnonzero(~stable[1:] & stable[:-1]) - 1
    found = []
    for start, stop in zip(starts.tolist(), stops.tolist(), strict=True):
        if stop - start < max(1, len(values) // 30):
            continue
        first, last = _first_free(free, start, stop, 1), _first_free(free, stop, start, -1)
        if first is not None and last is not None and first < last and free((first + last) // 2):
            found.append((values[first], values[last]))
    return tuple(found)


def _first_free(free: Callable[[int], bool], start: int, stop: int, step: int) -> int | None:
    """First row from `start` that is free: steps that double, for a search is dear, then halves of the last one."""
    furthest = abs(stop - start)
    offsets = [far - 1 for far in (1 << power for power in range(16)) if far - 1 < furthest] + [furthest]
    there = next((offset for offset in offsets if free(start + step * offset)), None)
    if there is None:
        return None
    before = max((offset for offset in offsets if offset < there), default=there - 1)
    while there - before > 1:
        middle = (there + before) // 2
        there, before = (middle, before) if free(start + step * middle) else (there, middle)
    return start + step * there


def unstable_runs(growth: xr.DataArray) -> list[tuple[float, float]]:
    """Intervals of speed in which a line of growth rates is positive.

    Parameters
    ----------
    growth : xarray.DataArray
        Growth rates over ``speed_rpm``.

    Returns
    -------
    list of (float, float)
        Lower and upper border [rpm], interpolated linearly; ends of the line where it starts or ends unstable.
    """
    speed, value = growth["speed_rpm"].values, growth.values
    unstable = np.concatenate([[False], value > 0.0, [False]])
    starts, stops = (
        np.flatnonzero(unstable[1:] & ~unstable[:-1]),
        np.flatnonzero(~unstable[1:] & unstable[:-1]),
    )

    def crossing(i: int) -> float:
        """Zero between points i - 1 and i."""
        if i == 0 or i == speed.size:
            return float(speed[min(i, speed.size - 1)])
        return float(speed[i] - value[i] * (speed[i] - speed[i - 1]) / (value[i] - value[i - 1]))

    return [(crossing(int(i)), crossing(int(j))) for i, j in zip(starts, stops, strict=True)]
