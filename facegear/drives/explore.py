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
from facegear.maps.stability_map import stability_map
from facegear.support.types import FloatArray

# Cells of the first stage lie this many columns and rows apart, and slow maps are filled so many rows at a time: a row
# takes little longer than a few cells of it. First every second row, so that half the time gives the whole picture.
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
    columns = np.arange(min(_COLUMN_STEP // 2, speeds.size - 1), speeds.size, _COLUMN_STEP)
    fast = _only_loads_change(model, float(speeds[-1]), parameter, values)
    step = 1 if fast else _ROW_STEP
    rows = np.arange(min(step // 2, values.size - 1), values.size, step)
    coarse = _chart(model, speeds[columns], parameter, values[rows])
    growth = coarse.values[_nearest(values.size, rows)][:, _nearest(speeds.size, columns)]
    periods = _periods(model, speeds)

    def stage(computed: float) -> xr.DataArray:
        return _labelled(coarse.dims[0], values, speeds, growth.copy(), periods, computed)

    yield stage(columns.size / speeds.size if fast else 0.0)
    if fast:
        missing = np.setdiff1d(np.arange(speeds.size), columns)
        if missing.size:
            growth[:, missing] = _chart(model, speeds[missing], parameter, values).values
            yield stage(1.0)
        return
    final = 0
    for part in _parts(values.size):
        found = _chart(model, speeds, parameter, values[part]).values
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
    chart = _chart(model, speeds, parameter, values)
    return _labelled(chart.dims[0], values, speeds, chart.values, _periods(model, speeds), 1.0)


def _periods(model: Model, speeds: FloatArray) -> FloatArray:
    return np.array([model.system(float(speed)).period for speed in speeds])


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


def _chart(model: Model, speeds: FloatArray, parameter: str, values: FloatArray) -> xr.DataArray:
    # One worker: starting others would take longer than the map.
    return stability_map(model, speeds, parameter, values, jobs=1, progress=False)


def _nearest(size: int, chosen: NDArray[np.int64]) -> NDArray[np.int64]:
    return np.asarray(np.abs(np.arange(size)[:, np.newaxis] - chosen).argmin(axis=1))


def _only_loads_change(model: Model, speed: float, parameter: str, values: FloatArray) -> bool:
    """Whether the constant matrices and the shape vectors stay along a column, which makes it fast."""
    one, other = (replace_parameter(model, parameter, float(v)).system(speed) for v in values[[0, -1]])
    return all(
        np.array_equal(getattr(one, name), getattr(other, name)) for name in ("mass", "damping", "stiffness")
    ) and all(
        np.array_equal(a.shape.coefficients, b.shape.coefficients)
        for a, b in zip(one.loads, other.loads, strict=True)
    )


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
