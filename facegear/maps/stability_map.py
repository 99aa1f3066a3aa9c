"""Two-parameter stability maps: growth rates over speed and one swept parameter.

A map is made of columns, one a speed (:mod:`facegear.maps.map_columns`). Where many lie close together they are
interpolated along speed as well (:mod:`facegear.maps.map_sheets`). Columns are shared out over processes or threads by
joblib.

Where the parameter counts something, or moves the instants at which the load begins and ends, a map is made of rows
instead: at one value, transition matrices are smooth functions of speed alone.

Cells of small systems of which speed changes nothing but the period, as gearboxes, are computed one by one, many at a
time (:mod:`facegear.maps.cells`). By which of these a map goes says :mod:`facegear.maps.ways`.

What falls between the columns of a map, tongues narrower than their distance, is found by
:func:`facegear.maps.tracing.tongues`.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from importlib.metadata import version

import numpy as np
import xarray
from numpy.typing import ArrayLike

from facegear.floquet.error_estimates import rounding_shift
from facegear.floquet.methods import Method, with_method
from facegear.floquet.models import (
    Model,
    parameter_path,
    require_model,
)
from facegear.floquet.periodic import PeriodicSystem
from facegear.maps.axes import checked_speeds, checked_values, require_cells, speed_coordinates
from facegear.maps.map_columns import spectral_radius
from facegear.maps.parallel import Task, Workers, computed
from facegear.maps.sweep import Sweep
from facegear.maps.ways import Way
from facegear.support.parameters import number_of_workers
from facegear.support.types import FloatArray


def stability_map(
    model: Model,
    speeds: ArrayLike,
    parameter: str,
    values: ArrayLike,
    *,
    method: Method | None = None,
    jobs: int = -1,
    progress: bool | None = None,
    cache_directory: str | os.PathLike[str] | None = None,
) -> xarray.DataArray:
    """Growth rates of a model over speed and one of its parameters.

    Parameters
    ----------
    model : Model
        A dataclass with a method ``system(speed)``, such as :class:`facegear.mechanics.transverse.Transverse`.
    speeds : array_like, shape (S,)
        Speeds [rad/s], greater than 0, ascending.
    parameter : str
        Name of the swept parameter: a field of the model or of one of its parts ("stiffness" of its load,
        "thickness_ratio" of its body), see :func:`facegear.floquet.models.parameter_path`.
    values : array_like, shape (V,)
        Values of the parameter, in the unit of its field.
    method : Method, optional
        Method of :mod:`facegear.floquet.methods`; if left out, what
        :func:`facegear.floquet.methods.with_method` finds to suit each column.
    jobs : int
        Number of workers, as joblib's ``n_jobs``; -1 for all processors, or all workers of the backend that
        ``joblib.parallel_config`` names. On this machine they are threads where only load parameters change, else
        processes.
    progress : bool, optional
        Show a progress bar; if left out, only on a terminal.
    cache_directory : path, optional
        Where finished chunks of columns are kept. The same call continues from there after an interruption; a
        file that is damaged or belongs to another map is computed anew.

    Returns
    -------
    xarray.DataArray, shape (V, S)
        ln(max|λ|)/T0 [1/s] (2-8), unstable where positive; dimensions named after the parameter and "speed".
        Attribute ``error_estimate`` is the largest difference of max|λ| from a more accurate method, and what
        rounding does to it, in the corner cells and the middle one.

    Raises
    ------
    TypeError, ValueError
        Naming the argument: speeds not ascending or not positive, values not finite, empty axes, an unknown
        parameter, or what the model itself refuses.
    ArithmeticError
        If a cell cannot be computed, as where its period is too long for its fastest motion: no map has holes.

    Examples
    --------
    >>> import facegear as fg
    >>> model = fg.Transverse(fg.Body(fg.Drive(26, 130, 3.175e-3), thickness_ratio=0.03), fg.MeshLoad(1.0, 3e-6, 1.0))
    >>> chart = fg.stability_map(model, fg.rad_per_s([300.0, 600.0]), "stiffness", [0.5, 1.0], jobs=1)
    >>> chart.dims
    ('stiffness', 'speed')
    """
    require_model(model)
    speeds = checked_speeds(speeds)
    values = checked_values(values)
    require_cells(speeds, values)
    jobs = number_of_workers("jobs", jobs)
    name = parameter_path(model, parameter)[-1]
    sweep = Sweep(model, parameter, tuple(values.tolist()), method)

    def run(tasks: Sequence[Task], description: str, prefer: Workers) -> Iterator[tuple[int, FloatArray]]:
        return computed(tasks, description, jobs, progress, cache_directory, prefer)

    way = Way.of(sweep, speeds)
    radii, periods, by_cells = way.radii(run)
    error = way.cells.error_estimate(radii) if by_cells and way.cells is not None else None
    if error is None:
        error = _error_estimate(sweep, speeds, radii)

    return xarray.DataArray(
        np.log(radii) / periods,
        dims=(name, "speed"),
        coords={
            name: (name, values, {"long_name": ".".join(parameter_path(model, parameter))}),
        }
        | speed_coordinates(speeds),
        name="growth_rate",
        attrs={
            "units": "1/s",
            "long_name": "growth rate ln(max|λ|)/T0",
            "model": repr(model),
            "method": sweep.description,
            "error_estimate": error,
            "error_estimate_of": "spectral radius max|λ| [-], corner cells and middle cell",
            "facegear_version": version("facegear"),
        },
    )


def _error_estimate(sweep: Sweep, speeds: FloatArray, radii: FloatArray) -> float:
    """Largest difference of max|λ| from a more accurate method, and rounding, corner cells and middle cell."""
    last_value, last_speed = radii.shape[0] - 1, radii.shape[1] - 1
    cells = {(v, s) for v in (0, last_value) for s in (0, last_speed)} | {(last_value // 2, last_speed // 2)}
    worst = 0.0
    for v, s in sorted(cells):
        system, radius = sweep.model_at(sweep.values[v]).system(float(speeds[s])), float(radii[v, s])

        def error(method: Method, system: PeriodicSystem = system, radius: float = radius) -> float:
            difference = abs(spectral_radius(system, method.refined()) - radius)
            return difference + rounding_shift(system, method)

        worst = max(worst, with_method(sweep.method, error))
    return worst
