"""Two-parameter stability maps: growth rates over speed and one swept parameter.

A map is made of columns, one a speed, or of rows, one a value of the parameter. Where only the mass, damping or
stiffness of the contacts changes along a column, its transition matrices share nearly all their work
(:func:`facegear.floquet.columns.column_spectral_radii`). Where other matrices change, they are interpolated along the
parameter, or along speed where that takes fewer of them, as far as they are smooth, and computed cell by cell where
they are not. Columns and rows are shared out over processes by joblib.

What falls between the columns of a map, tongues narrower than their distance, is found by
:func:`facegear.maps.tracing.tongues`.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from importlib.metadata import version
from typing import Any

import numpy as np
import xarray
from numpy.typing import ArrayLike

from facegear.floquet.columns import column_spectral_radii, interpolated_spectral_radii
from facegear.floquet.models import Model, is_whole_number, parameter_path, replace_at, require_model
from facegear.floquet.multiplier_curves import FrozenMotions, MultiplierCurve
from facegear.floquet.multipliers import (
    Method,
    multipliers,
    rounding_shift,
    transition_matrices,
    with_method,
)
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.floquet.stepping import Family
from facegear.maps.parallel import Workers, computed, parts_of
from facegear.support.parameters import finite_array, number_of_workers, rpm
from facegear.support.types import FloatArray

# Columns of a map that are computed, and kept on disk, together.
_CHUNK = 8
# Matrices that a column takes at least, interpolated along the parameter.
_COLUMN_MATRICES = 9
# A row is interpolated a little further than its speeds.
_BEYOND = 1e-3
# Largest difference of spectral radii between interpolated matrices and a cell computed alone.
_INTERPOLATION_CHECK = 1e-8


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
        Method of :mod:`facegear.floquet.multipliers`; if left out, what
        :func:`facegear.floquet.multipliers.with_method` finds to suit each column.
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

    Examples
    --------
    >>> from facegear.geometry.drive import Drive
    >>> from facegear.support.parameters import MeshLoad, rad_per_s
    >>> from facegear.mechanics.plate import Body
    >>> from facegear.mechanics.transverse import Transverse
    >>> model = Transverse(Body(Drive(26, 130, 3.175e-3), thickness_ratio=0.03), MeshLoad(1.0, 3e-6, 1.0))
    >>> chart = stability_map(model, rad_per_s([300.0, 600.0]), "stiffness", [0.5, 1.0], jobs=1)
    >>> chart.dims
    ('stiffness', 'speed')
    """
    require_model(model)
    speeds = checked_speeds(speeds)
    values = _checked_values(values)
    jobs = number_of_workers("jobs", jobs)
    name = parameter_path(model, parameter)[-1]
    sweep = _Sweep(model, parameter, tuple(values.tolist()), method)
    first = [model.system(float(speeds[0])) for model in sweep.models]
    loads = sweep.load_parameters(first)
    tasks = (
        _rows(sweep, speeds)
        if _goes_along_speed(sweep, speeds, loads, first)
        else _chunks(sweep, speeds, loads, first)
    )
    radii = np.empty((values.size, speeds.size))
    # Columns of loads are batches of linear algebra; models are Python, of which only one thread runs at a time.
    prefer: Workers = "threads" if all(isinstance(task, _LoadChunk) for task in tasks) else "processes"
    for number, result in computed(tasks, "stability map", jobs, progress, cache_directory, prefer):
        radii[tasks[number].place] = result
    error = _error_estimate(sweep, speeds, radii)

    return xarray.DataArray(
        np.log(radii) / _periods(sweep, speeds, np.array([system.period for system in first])),
        dims=(name, "speed"),
        coords={
            name: (name, values, {"long_name": ".".join(parameter_path(model, parameter))}),
            "speed": ("speed", speeds, {"units": "rad/s", "long_name": "speed"}),
            "speed_rpm": ("speed", rpm(speeds), {"units": "rpm", "long_name": "speed"}),
        },
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


def checked_speeds(speeds: ArrayLike) -> FloatArray:
    """Check that speeds [rad/s] are finite, positive and ascending, and return them as an array of shape (S,).

    Raises
    ------
    TypeError, ValueError
        Naming what is wrong.
    """
    array = finite_array("speeds", speeds, "rad/s")
    if array.ndim != 1 or array.size == 0:
        raise ValueError(f"speeds must list at least one speed in rad/s, got shape {array.shape}")
    if array.min() <= 0.0:
        raise ValueError(f"speeds must be greater than 0 rad/s, got {array.min()!r}")
    if (np.diff(array) <= 0.0).any():
        raise ValueError("speeds must ascend strictly, got equal or descending neighbours")
    return array


def _checked_values(values: ArrayLike) -> FloatArray:
    array = finite_array("values", values)
    if array.ndim != 1 or array.size == 0:
        raise ValueError(f"values must list at least one value of the parameter, got shape {array.shape}")
    if np.unique(array).size < array.size:
        raise ValueError("values must differ from one another, got a repeated value")
    return array


@dataclass(frozen=True)
class _Sweep:
    """A model and the values of one of its parameters."""

    model: Model
    parameter: str
    values: tuple[float, ...]
    method: Method | None

    def model_at(self, value: float) -> Any:
        """Return the model with the parameter replaced; the same one each time, for columns share their values."""
        if value not in self._built:
            self._built[value] = replace_at(self.model, self.path, value)
        return self._built[value]

    @cached_property
    def _built(self) -> dict[float, Any]:
        return {}

    @cached_property
    def path(self) -> tuple[str, ...]:
        """Fields that lead to the parameter."""
        return parameter_path(self.model, self.parameter)

    @cached_property
    def models(self) -> tuple[Model, ...]:
        """One model a value."""
        return tuple(self.model_at(value) for value in self.values)

    @cached_property
    def probes(self) -> tuple[int, ...]:
        """Numbers of the first, the middle and the last value."""
        return tuple(sorted({0, len(self.values) // 2, len(self.values) - 1}))

    def load_parameters(self, systems: Sequence[PeriodicSystem]) -> FloatArray | None:
        """Mass, damping and stiffness of each contact, (V, 3, loads), if the systems differ in nothing else."""
        if not all(_same_but_load_parameters(systems[0], other) for other in systems[1:]):
            return None
        return np.array([_load_parameters(system) for system in systems])

    @property
    def description(self) -> str:
        """Method in words."""
        chosen = "default method" if self.method is None else repr(self.method)
        return f"{chosen}, transition matrices interpolated along {self.parameter} or speed where they are smooth"


def _load_parameters(system: PeriodicSystem) -> list[list[float]]:
    return [[getattr(load, name) for load in system.loads] for name in ("mass", "damping", "stiffness")]


def _same_function(one: PiecewiseChebyshev | None, other: PiecewiseChebyshev | None) -> bool:
    if one is None or other is None or one is other:
        return one is other
    return np.array_equal(one.breakpoints, other.breakpoints) and np.array_equal(
        one.coefficients, other.coefficients
    )


def _same_but_load_parameters(one: PeriodicSystem, other: PeriodicSystem) -> bool:
    """Whether two systems differ at most in the mass, damping and stiffness of their loads."""
    return (
        one.period == other.period
        and len(one.loads) == len(other.loads)
        and all(np.array_equal(getattr(one, m), getattr(other, m)) for m in ("mass", "damping", "stiffness"))
        and all(
            a.rate == b.rate and _same_function(a.weight, b.weight) and _same_function(a.shape, b.shape)
            for a, b in zip(one.loads, other.loads, strict=True)
        )
    )


Place = tuple[slice, slice]


@dataclass(frozen=True, eq=False)
class _LoadChunk:
    """Columns along which only load parameters change: systems of each speed, parameters (V, 3, loads)."""

    place: Place
    systems: tuple[PeriodicSystem, ...]
    loads: FloatArray
    method: Method | None

    def content(self) -> Iterator[Any]:
        """Everything the result depends on."""
        yield from (repr(self.method), self.loads)
        for system in self.systems:
            yield from parts_of(system)

    def compute(self) -> FloatArray:
        """Spectral radii, shape (V, speeds)."""
        masses, dampings, stiffnesses = self.loads.transpose(1, 0, 2)
        columns = [
            column_spectral_radii(system, masses, dampings, stiffnesses, self.method)
            for system in self.systems
        ]
        return np.stack(columns, axis=1)


@dataclass(frozen=True, eq=False)
class _ModelChunk:
    """Columns along which anything may change, or one row, of a single value."""

    place: Place
    sweep: _Sweep
    speeds: FloatArray
    alone: bool = False

    def content(self) -> Iterator[Any]:
        """Everything the result depends on: of the model's code, what it makes of the first, middle and last value."""
        sweep = self.sweep
        yield from (
            repr(sweep.method),
            repr(sweep.model),
            sweep.parameter,
            np.array(sweep.values),
            self.speeds,
        )
        for speed in self.speeds:
            for probe in sweep.probes:
                yield from parts_of(sweep.models[probe].system(float(speed)))

    def compute(self) -> FloatArray:
        """Spectral radii, shape (V, speeds)."""
        columns = [_model_column(self.sweep, speed, self.alone) for speed in self.speeds.tolist()]
        return np.stack(columns, axis=1)


@dataclass(frozen=True, eq=False)
class _Row(_ModelChunk):
    """A single value at all speeds."""

    def compute(self) -> FloatArray:
        """Spectral radii, shape (1, speeds)."""
        (model,) = self.sweep.models
        return _row(model, self.speeds, self.sweep.method)[np.newaxis]


_Task = _LoadChunk | _ModelChunk


def _goes_along_speed(
    sweep: _Sweep, speeds: FloatArray, loads: FloatArray | None, first: Sequence[PeriodicSystem]
) -> bool:
    """Tell whether series along speed take fewer matrices than any along the parameter; loads share theirs."""
    if speeds.size <= _COLUMN_MATRICES or loads is not None:
        return False
    motions = FrozenMotions.of(sweep.models[-1], 1.0 / float(speeds[-1]), 1.0 / float(speeds[0]))
    count = len(sweep.values)
    cells = count if _cell_by_cell(sweep, first) else min(count, _COLUMN_MATRICES)
    return count * motions.matrices < speeds.size * cells


def _cell_by_cell(sweep: _Sweep, systems: Sequence[PeriodicSystem]) -> bool:
    """Whether a column is no smooth function of its parameter, which counts something or moves breakpoints."""
    few = len(sweep.values) <= len(sweep.probes) or is_whole_number(sweep.model, sweep.parameter)
    return few or any(not _same_layout(systems[0], other) for other in systems[1:])


def _rows(sweep: _Sweep, speeds: FloatArray) -> list[_Task]:
    """Prepare one row for each value."""
    return [
        _Row((slice(i, i + 1), slice(None)), replace(sweep, values=(value,)), speeds)
        for i, value in enumerate(sweep.values)
    ]


def _chunks(
    sweep: _Sweep, speeds: FloatArray, loads: FloatArray | None, first: Sequence[PeriodicSystem]
) -> list[_Task]:
    """Prepare neighbouring columns for the fastest route that suits them.

    Load parameters are those of all values at the first speed; at the others the first, middle and last value show
    whether they, or anything else, depend on both speed and value.
    """
    tasks: list[_Task] = []
    alone = _cell_by_cell(sweep, first)
    for start in range(0, speeds.size, _CHUNK):
        part = slice(start, start + _CHUNK)
        place = (slice(None), part)
        if loads is not None:
            probed = [
                [sweep.models[probe].system(speed) for probe in sweep.probes]
                for speed in speeds[part].tolist()
            ]
            expected = loads[list(sweep.probes)]
            if all(np.array_equal(_or_empty(sweep.load_parameters(row)), expected) for row in probed):
                tasks.append(_LoadChunk(place, tuple(row[0] for row in probed), loads, sweep.method))
                continue
        # A fresh copy: models that have been built need not travel to other processes.
        tasks.append(_ModelChunk(place, replace(sweep), speeds[part], alone))
    return tasks


def _periods(sweep: _Sweep, speeds: FloatArray, first: FloatArray) -> FloatArray:
    """T0 [s] of each cell, (V, S), from those at the first speed: the parameter may be a number of teeth."""
    turned = first * speeds[0]
    for probe in sweep.probes:
        for speed in (float(speeds[speeds.size // 2]), float(speeds[-1])):
            period = sweep.models[probe].system(speed).period
            if abs(period * speed - turned[probe]) > 1e-12 * turned[probe]:
                # Not in inverse proportion to speed.
                return np.array([[m.system(v).period for v in speeds.tolist()] for m in sweep.models])
    return np.asarray(turned[:, np.newaxis] / speeds, dtype=float)


def _or_empty(loads: FloatArray | None) -> FloatArray:
    return np.empty(0) if loads is None else loads


def _model_column(sweep: _Sweep, speed: float, alone: bool) -> FloatArray:
    """Spectral radii along one column, shape (V,); `alone` if values are known to share no breakpoints."""
    systems = [sweep.models[probe].system(speed) for probe in sweep.probes]
    if alone or _cell_by_cell(sweep, systems):
        return np.array([_spectral_radius(model.system(speed), sweep.method) for model in sweep.models])
    # Coordinates in which entries are of comparable size, the same for the whole column.
    scale = Family(systems[:1]).scale
    return with_method(sweep.method, lambda method: _interpolated_column(sweep, speed, method, scale))


def _interpolated_column(sweep: _Sweep, speed: float, method: Method, scale: FloatArray) -> FloatArray:
    """Spectral radii along one column from transition matrices at some of its values, shape (V,)."""
    values = np.array(sweep.values)

    def evaluate(chosen: FloatArray) -> FloatArray:
        matrices = transition_matrices([sweep.model_at(v).system(speed) for v in chosen.tolist()], method)
        return np.asarray(scale @ matrices @ np.linalg.inv(scale), dtype=float)

    radii = interpolated_spectral_radii(evaluate, values)
    return _witnessed(radii, [partial(model.system, speed) for model in sweep.models], method)


def _row(model: Model, speeds: FloatArray, method: Method | None) -> FloatArray:
    """Spectral radii along one row from transition matrices at some speeds, shape (S,)."""
    cells = [partial(model.system, speed) for speed in speeds.tolist()]
    low, high = (1.0 - _BEYOND) * float(speeds[0]), (1.0 + _BEYOND) * float(speeds[-1])
    try:
        radii = MultiplierCurve.of(model, low, high, method).spectral_radii(speeds)
    except ArithmeticError:  # not smooth in speed
        radii = np.full(speeds.size, np.nan)
    return _witnessed(radii, cells, method)


def _witnessed(
    radii: FloatArray, cells: Sequence[Callable[[], PeriodicSystem]], method: Method | None
) -> FloatArray:
    """Interpolated spectral radii, or those of each system alone if one of them belies the others."""
    # Smooth to the samples is not yet smooth: one cell between them tells.
    witness = int(0.382 * radii.size)
    if abs(radii[witness] - _spectral_radius(cells[witness](), method)) <= _INTERPOLATION_CHECK:
        return radii
    return np.array([_spectral_radius(cell(), method) for cell in cells])


def _same_layout(one: PeriodicSystem, other: PeriodicSystem) -> bool:
    return (
        one.size == other.size
        and len(one.loads) == len(other.loads)
        and np.array_equal(one.breakpoints, other.breakpoints)
    )


def _spectral_radius(system: PeriodicSystem, method: Method | None) -> float:
    return float(np.abs(multipliers(system, method)[0]))


def _error_estimate(sweep: _Sweep, speeds: FloatArray, radii: FloatArray) -> float:
    """Largest difference of max|λ| from a more accurate method, and rounding, corner cells and middle cell."""
    last_value, last_speed = radii.shape[0] - 1, radii.shape[1] - 1
    cells = {(v, s) for v in (0, last_value) for s in (0, last_speed)} | {(last_value // 2, last_speed // 2)}
    worst = 0.0
    for v, s in sorted(cells):
        system, radius = sweep.models[v].system(float(speeds[s])), float(radii[v, s])

        def error(method: Method, system: PeriodicSystem = system, radius: float = radius) -> float:
            difference = abs(_spectral_radius(system, method.refined()) - radius)
            return difference + rounding_shift(system, method)

        worst = max(worst, with_method(sweep.method, error))
    return worst
