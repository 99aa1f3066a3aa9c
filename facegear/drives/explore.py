"""What the live explorer computes: a map at reading resolution in steps, and one cell of it in detail.

Which numbers the reader may set says a :class:`facegear.drives.studies.study.Study`. Everything here works without a
screen; :mod:`facegear.drives.explorer` puts controls and figures on it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from facegear.drives.cell import UNSTABLE, CellDetail, cell_detail
from facegear.drives.stages import Plan
from facegear.drives.studies.study import Quantity, Settings, Study
from facegear.floquet.models import Model, replace_parameter
from facegear.maps.axes import periods_at
from facegear.maps.rows import rows_of
from facegear.maps.sweep import Sweep
from facegear.maps.ways import Way
from facegear.support.threads import one_thread
from facegear.support.types import FloatArray


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
        Growth rates [1/s], with the period [s] of each speed as a coordinate, after each piece of a stage
        (:mod:`facegear.drives.stages`). Cells that are not yet computed have the value of a neighbour. Attribute
        ``computed`` is the part of the cells that are final; among them are those of every ``row_step``-th value at
        every ``column_step``-th speed.
    """
    way, periods = _way(model, speeds, parameter, values), periods_at(model, speeds)
    plan = Plan.of(model, speeds, way.name)
    growth = np.full((values.size, speeds.size), np.nan)
    for stage, steps in enumerate(plan.steps):
        before = plan.steps[max(stage - 1, 0)]
        pieces = list(plan.pieces(growth, stage))
        for number, (rows, columns) in enumerate(pieces, 1):
            for found in _growth_in_tasks(way.part(rows, columns)):
                if found is not None:
                    growth[np.ix_(rows, columns)] = found
                complete = found is not None and number == len(pieces)
                if stage > 0 or complete:
                    shown, computed = plan.shown(growth, stage), float(np.isfinite(growth).mean())
                    yield _labelled(way, shown, periods, computed, steps if complete else before)


def reading_map(model: Model, speeds: FloatArray, parameter: str, values: FloatArray) -> xr.DataArray:
    """Return the last stage of :func:`map_stages` without those before it."""
    way = _way(model, speeds, parameter, values)
    *_, growth = _growth_in_tasks(way)
    assert growth is not None
    return _labelled(way, growth, periods_at(model, speeds), 1.0, (1, 1))


def _labelled(
    way: Way, growth: FloatArray, periods: FloatArray, computed: float, steps: tuple[int, int]
) -> xr.DataArray:
    name = way.sweep.path[-1]
    return xr.DataArray(
        growth,
        dims=(name, "speed"),
        coords={name: np.array(way.sweep.values), "speed": way.speeds, "period": ("speed", periods)},
        name="growth_rate",
        attrs={"units": "1/s", "computed": computed, "row_step": steps[0], "column_step": steps[1]},
    )


def _way(model: Model, speeds: FloatArray, parameter: str, values: FloatArray) -> Way:
    return Way.throughout(Sweep(model, parameter, tuple(values.tolist()), None), speeds)


def _growth_in_tasks(way: Way) -> Iterator[FloatArray | None]:
    """Growth rates [1/s], (V, S), at last; nothing after each task before that."""
    # In this process: starting others would take longer than the map.
    if way.name == "rows":
        with one_thread():
            radii, periods = rows_of(way.sweep.models, way.speeds, way.sweep.method)
    else:
        batches, results = way.batches(), dict[int, FloatArray]()
        try:
            tasks, *_ = next(batches)
            while True:
                for number, task in enumerate(tasks):
                    with one_thread():
                        results[number] = task.compute()
                    yield None
                tasks, *_ = batches.send(results)
                results = {}
        except StopIteration as end:
            radii, periods, _ = end.value
    yield np.asarray(np.log(radii) / periods)


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
