"""What the live explorer computes: a map at reading resolution in steps, and one cell of it in detail.

Which numbers the reader may set says a :class:`facegear.drives.studies.study.Study`. Everything here works without a
screen; :mod:`facegear.drives.explorer` puts controls and figures on it.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterator
from dataclasses import dataclass

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from facegear.drives.cell import UNSTABLE, CellDetail, cell_detail
from facegear.drives.studies.study import Quantity, Settings, Study
from facegear.floquet.models import Model, replace_parameter
from facegear.maps.axes import periods_at
from facegear.maps.sweep import Sweep
from facegear.maps.ways import Way
from facegear.support.threads import one_thread
from facegear.support.types import FloatArray

# Cells of the first stage lie this many columns and rows apart, and slow maps are filled so many rows at a time: first
# every second row, so that half the time gives the whole picture.
_COLUMN_STEP, _ROW_STEP, _SLOW_ROWS = 3, 5, 10


def map_stages(
    model: Model, speeds: FloatArray, parameter: str, values: FloatArray
) -> Iterator[xr.DataArray]:
    """Compute a stability map in steps, coarse at first.

    Parameters
    ----------
    model : Model
    speeds : ndarray, shape (S,)
        Ascending [rad/s].
    parameter : str
        As for :func:`facegear.maps.stability_map.stability_map`.
    values : ndarray, shape (V,)

    Yields
    ------
    xarray.DataArray, shape (V, S)
        Growth rates [1/s], with the period [s] of each speed as a coordinate. In the first, cells that are not yet
        computed have the value of a neighbour; attribute ``computed`` is the part of the cells that are final.
    """
    way = _way(model, speeds, parameter, values)
    name = way.sweep.path[-1]
    columns = np.arange(min(_COLUMN_STEP // 2, speeds.size - 1), speeds.size, _COLUMN_STEP)
    step = 1 if way.name == "loads" else _ROW_STEP
    rows = np.arange(min(step // 2, values.size - 1), values.size, step)
    growth = _growth(way.part(rows, columns))[_nearest(values.size, rows)]
    growth, periods = growth[:, _nearest(speeds.size, columns)], periods_at(model, speeds)

    def stage(computed: float) -> xr.DataArray:
        return _labelled(name, values, speeds, growth.copy(), periods, computed)

    yield stage(columns.size / speeds.size if way.name == "loads" else 0.0)
    if way.name in ("loads", "columns"):
        missing = np.setdiff1d(np.arange(speeds.size), columns if way.name == "loads" else [])
        if missing.size:
            growth[:, missing] = _growth(way.part(np.arange(values.size), missing))
            yield stage(1.0)
        return
    final = 0
    for part in _parts(values.size):
        found = _growth(way.part(part, np.arange(speeds.size)))
        if part[0] % 2 == 0:
            # The row above each comes later, and is taken for its like until then.
            above = np.minimum(part + 1, values.size - 1)
            growth[above] = found
        growth[part] = found
        final += part.size
        yield stage(final / values.size)


def _parts(rows: int) -> list[NDArray[np.int64]]:
    """Rows in the order in which a slow map is filled: every second one, then those between."""
    found = []
    for places in (np.arange(0, rows, 2), np.arange(1, rows, 2)):
        found += [places[start : start + _SLOW_ROWS] for start in range(0, places.size, _SLOW_ROWS)]
    return found


def reading_map(model: Model, speeds: FloatArray, parameter: str, values: FloatArray) -> xr.DataArray:
    """Return the last stage of :func:`map_stages` without those before it."""
    way = _way(model, speeds, parameter, values)
    return _labelled(way.sweep.path[-1], values, speeds, _growth(way), periods_at(model, speeds), 1.0)


def _labelled(
    name: Hashable,
    values: FloatArray,
    speeds: FloatArray,
    growth: FloatArray,
    periods: FloatArray,
    computed: float,
) -> xr.DataArray:
    return xr.DataArray(
        growth,
        dims=(name, "speed"),
        coords={name: values, "speed": speeds, "period": ("speed", periods)},
        name="growth_rate",
        attrs={"units": "1/s", "computed": computed},
    )


def _way(model: Model, speeds: FloatArray, parameter: str, values: FloatArray) -> Way:
    return Way.of(Sweep(model, parameter, tuple(values.tolist()), None), speeds)


def _growth(way: Way) -> FloatArray:
    """Growth rates [1/s], (V, S)."""
    # In this process: starting others would take longer than the map.
    with one_thread():
        if way.name == "rows":
            radii, periods = way.rows().compute()
        else:
            radii, periods, _ = way.radii(
                lambda tasks, *_: ((k, task.compute()) for k, task in enumerate(tasks))
            )
    return np.asarray(np.log(radii) / periods)


def _nearest(size: int, chosen: NDArray[np.int64]) -> NDArray[np.int64]:
    return np.asarray(np.abs(np.arange(size)[:, np.newaxis] - chosen).argmin(axis=1))


def unstable(chart: xr.DataArray) -> NDArray[np.bool_]:
    """Find the cells of a map whose growth in a period is more than rounding, shape (V, S)."""
    return np.asarray(np.expm1(chart.values * chart["period"].values) > UNSTABLE)


@dataclass(frozen=True, eq=False)
class View:
    """A map and one cell of it, as the explorer shows them.

    Attributes
    ----------
    study : Study
    settings : mapping
        As shown.
    vertical : Quantity
        On the vertical axis.
    chart : xarray.DataArray
        From :func:`reading_map`.
    value : float
        Of the vertical quantity in the cell [SI].
    detail : CellDetail
    """

    study: Study
    settings: Settings
    vertical: Quantity
    chart: xr.DataArray
    value: float
    detail: CellDetail


def view(
    study: Study, speed: float, value: float, vertical: str | None = None, changes: Settings | None = None
) -> View:
    """Compute what the explorer shows when the reader has clicked on a cell.

    Parameters
    ----------
    study : Study
    speed, value : float
        Of the cell, as shown on the axes.
    vertical : str, optional
        Name of the quantity on the vertical axis; that of the study if left out.
    changes : mapping, optional
        Settings that differ from the first ones, as shown.

    Returns
    -------
    View

    Raises
    ------
    TypeError, ValueError, ArithmeticError
        As the study refuses settings.
    """
    settings = study.settings(changes)
    quantity = study.swept(study.vertical if vertical is None else vertical)
    assert quantity.parameter is not None
    model = study.model(settings)
    speeds, values = study.axes(settings, quantity.name)
    chart = reading_map(model, speeds, quantity.parameter, values)
    chosen = float(quantity.si(value))
    detail = cell_detail(replace_parameter(model, quantity.parameter, chosen), speed * study.speed.unit)
    return View(study, settings, quantity, chart, chosen, detail)
