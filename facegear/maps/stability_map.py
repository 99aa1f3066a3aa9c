"""Two-parameter stability maps: growth rates over speed and one swept parameter.

A map is made of columns, one a speed. Where only the mass, damping or stiffness of the contacts changes along a column,
its transition matrices share nearly all their work (:class:`facegear.floquet.columns.LoadSweep`). They are interpolated
along the parameter as far as they are smooth, and computed cell by cell where they are not. Where many columns lie
close together they are interpolated along speed as well, on a sheet (:mod:`facegear.floquet.sheets`): columns are then
computed at few speeds, and in each group of columns one is computed all the same, to see whether the sheet is right.
What is left are eigenvalues. Columns are shared out over processes or threads by joblib.

Where the parameter counts something, or moves the instants at which the load begins and ends, a map is made of rows
instead: at one value, transition matrices are smooth functions of speed alone.

Cells of small systems of which speed changes nothing but the period, as gearboxes, are computed one by one, many at a
time (:mod:`facegear.maps.cells`).

What falls between the columns of a map, tongues narrower than their distance, is found by
:func:`facegear.maps.tracing.tongues`.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from importlib.metadata import version
from typing import Any

import numpy as np
import xarray
from numpy.typing import ArrayLike

from facegear.floquet.columns import (
    LOWEST_DEGREE,
    Evaluate,
    LoadSweep,
    agree,
    column_of,
    family_matrices,
)
from facegear.floquet.eigenvalues import spectral_radii
from facegear.floquet.free_modes import UnsuitableSystemError
from facegear.floquet.load_columns import LoadColumn
from facegear.floquet.models import (
    Model,
    is_whole_number,
    parameter_path,
    replace_at,
    require_model,
    system_at,
)
from facegear.floquet.multiplier_curves import FrozenMotions, degree_between
from facegear.floquet.multipliers import (
    Method,
    multipliers,
    rounding_error,
    rounding_shift,
    with_method,
)
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.series import ChebyshevSeries
from facegear.floquet.sheets import SHEET_TOLERANCE, Sheet, is_interpolated, samples, windows
from facegear.floquet.stepping import Family
from facegear.maps.cells import cells_of
from facegear.maps.likeness import load_parameters_of, same_but_load_parameters, same_layout
from facegear.maps.parallel import Task, Workers, computed, parts_of
from facegear.maps.rows import in_rows
from facegear.support.parameters import finite_array, number_of_workers, rpm
from facegear.support.types import ComplexArray, FloatArray

# Columns of a map that are computed, and kept on disk, together.
_CHUNK = 8
# Degrees of series along parameters for each value of which a model is built.
_DEGREES = tuple(degree * 2**power for power in range(9) for degree in (8, 10, 12, 14))
# Columns are taken by series along the parameter whose degree is at most this part of the number of values.
_MOST_OF_A_COLUMN = 0.8
# The same on a sheet: each group has a column that is computed to check the others.
_SHEET_CHUNK = 16


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
    jobs = number_of_workers("jobs", jobs)
    name = parameter_path(model, parameter)[-1]
    sweep = _Sweep(model, parameter, tuple(values.tolist()), method)

    def run(tasks: Sequence[Task], description: str, prefer: Workers) -> Iterator[tuple[int, FloatArray]]:
        return computed(tasks, description, jobs, progress, cache_directory, prefer)

    radii, periods, error = _by_cell(sweep, speeds, run) or _by_column_or_row(sweep, speeds, run)

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
        raise ValueError(f"speeds must be greater than 0 rad/s, got {float(array.min())!r}")
    if (np.diff(array) <= 0.0).any():
        raise ValueError("speeds must ascend strictly, got equal or descending neighbours")
    return array


def speed_coordinates(speeds: FloatArray) -> dict[str, Any]:
    """Coordinates of a map along speeds (S,) [rad/s], in both units."""
    return {
        "speed": ("speed", speeds, {"units": "rad/s", "long_name": "speed"}),
        "speed_rpm": ("speed", rpm(speeds), {"units": "rpm", "long_name": "speed"}),
    }


def checked_values(values: ArrayLike) -> FloatArray:
    """Check that values of a parameter are finite and differ, and return them; errors as in :func:`checked_speeds`."""
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
        if not all(same_but_load_parameters(systems[0], other) for other in systems[1:]):
            return None
        return np.array([load_parameters_of(system) for system in systems])

    @property
    def probed(self) -> tuple[Model, ...]:
        """Models of these values."""
        return tuple(self.model_at(self.values[probe]) for probe in self.probes)

    def keeps(self, loads: FloatArray, speed: float) -> bool:
        """Whether the first, the middle and the last value have these load parameters at a speed, all else being equal.

        Parameters
        ----------
        loads : array, shape (V, 3, loads)
            From :meth:`load_parameters`.
        """
        found = self.load_parameters([model.system(speed) for model in self.probed])
        return found is not None and np.array_equal(found, loads[list(self.probes)])

    @property
    def description(self) -> str:
        """Method in words."""
        chosen = "default method" if self.method is None else repr(self.method)
        return f"{chosen}, transition matrices interpolated along {self.parameter} and speed where they are smooth"


@dataclass(frozen=True, eq=False)
class _LoadColumn:
    """A column along which only load parameters change."""

    system: PeriodicSystem
    loads: LoadSweep

    def content(self) -> Iterator[Any]:
        """Everything the result depends on."""
        yield self.loads.column.stacked()
        yield from parts_of(self.system)

    @property
    def variable(self) -> FloatArray:
        """Variable in which matrices are interpolated, (V,)."""
        return self.loads.variable

    @property
    def smooth(self) -> bool:
        """Whether they are smooth in it."""
        return self.loads.smooth

    @property
    def scale(self) -> FloatArray:
        """Coordinates in which entries are of comparable size."""
        return Family([self.system]).scale

    def matrices(self, method: Method, scale: FloatArray) -> Evaluate:
        """Transition matrices at values of the variable."""
        return self.loads.matrices(self.system, method, scale)

    def radii(self, method: Method | None, degree: int) -> FloatArray:
        """Spectral radii, (V,), by series of which `degree` is the first that is tried."""
        return _column_radii(self, method, degree)


@dataclass(frozen=True, eq=False)
class _ModelColumn:
    """A column along which anything may change."""

    sweep: _Sweep
    speed: float

    def content(self) -> Iterator[Any]:
        """Everything the result depends on: of the model's code, what it makes of the first, middle and last value."""
        sweep = self.sweep
        yield from (repr(sweep.model), sweep.parameter, np.array(sweep.values), self.speed)
        for system in self.probed:
            yield from parts_of(system)

    @cached_property
    def probed(self) -> list[PeriodicSystem]:
        """Systems of the first, the middle and the last value."""
        return [model.system(self.speed) for model in self.sweep.probed]

    @property
    def variable(self) -> FloatArray:
        """Values of the parameter, (V,)."""
        return np.array(self.sweep.values)

    @property
    def smooth(self) -> bool:
        """Whether matrices are smooth functions of them."""
        return True

    @property
    def scale(self) -> FloatArray:
        """Coordinates in which entries are of comparable size."""
        return Family(self.probed[:1]).scale

    def matrices(self, method: Method, scale: FloatArray) -> Evaluate:
        """Transition matrices at values of the parameter."""
        return family_matrices(lambda value: self.sweep.model_at(value).system(self.speed), method, scale)

    def radii(self, method: Method | None, degree: int) -> FloatArray:
        """Spectral radii, (V,), by series of which `degree` is the first that is tried."""
        if _cell_by_cell(self.sweep, self.probed):
            cells = (model.system(self.speed) for model in self.sweep.models)
            return np.array([_spectral_radius(cell, method) for cell in cells])
        return _column_radii(self, method, degree)


_Column = _LoadColumn | _ModelColumn


def _column_radii(column: _Column, method: Method | None, degree: int) -> FloatArray:
    scale = column.scale
    return with_method(
        method,
        lambda chosen: column_of(column.matrices(chosen, scale), column.variable, column.smooth, degree),
    )


@dataclass(frozen=True, eq=False)
class _Columns:
    """What all columns have in common.

    Motions are those of the first, the middle and the last value; `turned` is the period times the speed of each value.
    """

    sweep: _Sweep
    loads: LoadSweep | None
    motions: tuple[FrozenMotions, ...]
    turned: FloatArray

    def degree(self, speed: float) -> int:
        """Estimate of the degree that a series along the parameter will have."""
        first, last = self._turning
        # Motions that stop oscillating along the parameter have no partner at its other end.
        if first.size != last.size:
            return LOWEST_DEGREE
        found = degree_between(first / speed, last / speed, SHEET_TOLERANCE)
        # Models of the points are built once for all columns that have them.
        return (
            found if self.loads is not None else next(d for d in _DEGREES if d >= found or d == _DEGREES[-1])
        )

    def smooth_from(self, speeds: FloatArray) -> int:
        """Find the first of some speeds (S,) from which on columns take few matrices, or are so cheap that they may.

        Below it, where a period is long, a series along the parameter would take as many as there are values, as it
        does everywhere along a logarithmic axis.
        """
        if self.loads is not None or self._is_smooth(float(speeds[0])):
            return 0
        most = int(_MOST_OF_A_COLUMN * len(self.sweep.values))
        degrees = [self.degree(speed) for speed in speeds.tolist()]
        start = speeds.size - int(np.argmax([degree > most for degree in degrees[::-1]] + [True]))
        part = speeds[start:]
        if part.size == 0:
            return speeds.size
        # Rows may be interpolated along speed.
        planned = windows(self.motions[len(self.motions) // 2], part)
        alone = planned[-1][0].start if planned else part.size
        row = alone + sum(degree + 1 for _, degree in planned)
        fewer = sum(degrees[start:]) + part.size < row * len(self.sweep.values)
        return start if fewer and self._is_smooth(float(part[0])) else speeds.size

    def _is_smooth(self, speed: float) -> bool:
        """Whether matrices may be interpolated along the parameter at a speed, and at all faster ones."""
        column = self.at(speed)
        return with_method(
            self.sweep.method,
            lambda chosen: (
                samples(
                    column.matrices(chosen, column.scale),
                    column.variable,
                    column.smooth,
                    self.degree(speed),
                ).size
                > 0
            ),
        )

    @cached_property
    def _turning(self) -> tuple[ComplexArray, ComplexArray]:
        """Exponents over slowness of the first and of the last value, slow ones first."""
        first, last = (
            exponents[exponents.imag >= 0.0]
            for exponents in (self.motions[0].exponents, self.motions[-1].exponents)
        )
        return first[np.argsort(first.imag)], last[np.argsort(last.imag)]

    def at(self, speed: float) -> _Column:
        """Return the column at a speed.

        Load parameters are those of all values at the first speed; at the others the first, middle and last value show
        whether they, or anything else, depend on both speed and value.
        """
        if self.loads is not None:
            column = self.loads.column
            loads = np.stack([column.mass, column.damping, column.stiffness], axis=1)
            if self.sweep.keeps(loads, speed):
                return _LoadColumn(self.sweep.probed[0].system(speed), self.loads)
        return _ModelColumn(self.sweep, speed)

    @property
    def variable(self) -> FloatArray:
        """Variable in which matrices are interpolated, (V,)."""
        return np.array(self.sweep.values) if self.loads is None else self.loads.variable

    @property
    def ends(self) -> tuple[float, float] | None:
        """Ends of the variable, if matrices are interpolated between them."""
        variable = self.variable
        smooth = self.loads is None or self.loads.smooth
        return (float(variable.min()), float(variable.max())) if is_interpolated(variable, smooth) else None


@dataclass(frozen=True, eq=False)
class _Chunk:
    """Neighbouring columns."""

    place: slice
    columns: _Columns
    speeds: tuple[float, ...]

    def content(self) -> Iterator[Any]:
        """Everything the result depends on."""
        yield repr(self.columns.sweep.method)
        for speed in self.speeds:
            yield from self.columns.at(speed).content()

    def compute(self) -> FloatArray:
        """Spectral radii, shape (V, columns)."""
        method = self.columns.sweep.method
        return np.stack(
            [self.columns.at(speed).radii(method, self.columns.degree(speed)) for speed in self.speeds],
            axis=1,
        )


@dataclass(frozen=True, eq=False)
class _Window:
    """Columns between two values of slowness, which a sheet may be laid through, and how."""

    low: float
    high: float
    degree: int
    degree_along: int
    method: Method
    scale: FloatArray
    tolerance: float

    def content(self) -> Iterator[Any]:
        """Everything that a sheet depends on besides its columns."""
        yield from (self.low, self.high, self.degree, self.degree_along)
        yield from (repr(self.method), self.scale, self.tolerance)


@dataclass(frozen=True, eq=False)
class _Samples:
    """Samples of a sheet at one speed."""

    window: _Window
    columns: _Columns
    speed: float

    def content(self) -> Iterator[Any]:
        """Everything the result depends on."""
        yield from self.window.content()
        yield from self.columns.at(self.speed).content()

    def compute(self) -> FloatArray:
        """See :func:`facegear.floquet.sheets.samples`; nothing where another column would be needed, or method."""
        column, window = self.columns.at(self.speed), self.window
        if isinstance(column, _LoadColumn) == (self.columns.loads is not None):
            try:
                evaluate = column.matrices(window.method, window.scale)
                return samples(evaluate, column.variable, column.smooth, window.degree_along)
            except UnsuitableSystemError:
                pass
        return np.empty((0, *window.scale.shape))


@dataclass(frozen=True, eq=False)
class _SheetChunk(_Chunk):
    """Neighbouring columns of a sheet."""

    window: _Window
    sheet: Sheet

    def content(self) -> Iterator[Any]:
        """Everything the result depends on."""
        yield from self.window.content()
        yield from super().content()

    def compute(self) -> FloatArray:
        """Spectral radii, shape (V, columns), column by column if one of them belies the sheet."""
        variable = self.columns.variable
        matrices = self.sheet.matrices(np.array(self.speeds), variable)
        flat = matrices.reshape(-1, *matrices.shape[2:])
        radii = spectral_radii(flat).reshape(len(self.speeds), -1).T
        middle = len(self.speeds) // 2
        # The largest radius of the middle column, and another.
        chosen = np.unique([int(radii[:, middle].argmax()), int(0.382 * variable.size)])
        column = self.columns.at(self.speeds[middle])
        own = column.matrices(self.window.method, self.window.scale)(column.variable[chosen])
        return radii if agree(matrices[middle, chosen], own) else super().compute()


@dataclass(frozen=True, eq=False)
class _Laid:
    """Neighbouring columns, and the samples of the sheet that may be laid through them."""

    start: int
    speeds: tuple[float, ...]
    columns: _Columns
    window: _Window
    samples: tuple[_Samples, ...]

    @classmethod
    def between(cls, inside: slice, degree: int, speeds: FloatArray, columns: _Columns) -> _Laid:
        """Prepare a sheet of some degree through the columns `inside`."""
        part, sweep = speeds[inside], columns.sweep
        low, high = 1.0 / float(part[-1]), 1.0 / float(part[0])
        slowest, fastest = (Family([sweep.probed[-1].system(v)]) for v in (float(part[0]), float(part[-1])))

        def tried(method: Method) -> Method:
            method.scaled_transition_matrices(fastest)
            return method

        method = with_method(sweep.method, tried)
        # No series resolves rounding, which is largest in the longest period.
        rounding = rounding_error(np.eye(len(fastest.scale)), slowest, method)
        tolerance = max(SHEET_TOLERANCE, 4.0 * rounding)
        # Along the parameter one degree for all: else what series leave out would not be smooth from speed to speed.
        along = columns.degree(float(part[0]))
        window = _Window(low, high, degree, along, method, fastest.scale, tolerance)
        points = 1.0 / ChebyshevSeries.points_of(low, high, degree)
        found = tuple(_Samples(window, columns, speed) for speed in points.tolist())
        return cls(inside.start, tuple(part.tolist()), columns, window, found)

    def chunks(self, found: Sequence[FloatArray]) -> list[_Chunk]:
        """Prepare the columns, on the sheet through what was found if that is smooth."""
        window = self.window
        sheet = Sheet.through(window.low, window.high, found, self.columns.ends, window.tolerance)
        if sheet is None:
            return _in_chunks(self.start, self.speeds, self.columns)
        return [
            _SheetChunk(chunk.place, self.columns, chunk.speeds, window, sheet)
            for chunk in _in_chunks(self.start, self.speeds, self.columns, _SHEET_CHUNK)
        ]


def _in_chunks(start: int, speeds: Sequence[float], columns: _Columns, size: int = _CHUNK) -> list[_Chunk]:
    """Group columns, the first of which has the number `start`."""
    parts = [tuple(speeds[k : k + size]) for k in range(0, len(speeds), size)]
    return [
        _Chunk(slice(start + k * size, start + k * size + len(part)), columns, part)
        for k, part in enumerate(parts)
    ]


_Run = Callable[[Sequence[Task], str, Workers], Iterator[tuple[int, FloatArray]]]


def _by_cell(sweep: _Sweep, speeds: FloatArray, run: _Run) -> tuple[FloatArray, FloatArray, float] | None:
    """Spectral radii and periods, (V, S), and an estimate of the error, of small systems that speed only turns."""
    cells = None if sweep.method is not None else cells_of(sweep.models, sweep.probes, speeds)
    if cells is None:
        return None
    radii = np.empty((len(sweep.values), speeds.size))
    places, tasks = cells.tasks()
    for number, result in run(tasks, "stability map", "threads"):
        radii[places[number]] = result
    periods, left = cells.periods, np.flatnonzero(np.isnan(radii[:, 0]))
    if left.size == len(sweep.values):
        return None
    if left.size:
        others = replace(sweep, values=tuple(sweep.values[row] for row in left.tolist()))
        radii[left], periods[left] = _by_row(others, speeds, run)
    else:
        with suppress(UnsuitableSystemError):  # shorter steps may be too many
            return radii, periods, cells.error_estimate(radii)
    return radii, periods, _error_estimate(sweep, speeds, radii)


def _by_column_or_row(sweep: _Sweep, speeds: FloatArray, run: _Run) -> tuple[FloatArray, FloatArray, float]:
    """As :func:`_by_cell`, of any models."""
    columns = _columns(sweep, speeds)
    # By rows below that speed, by columns from it on.
    start = speeds.size if columns is None else columns.smooth_from(speeds)
    parts = []
    if start > 0:
        parts.append(_by_row(sweep, speeds[:start], run))
    if columns is not None and start < speeds.size:
        parts.append(_by_column(columns, speeds[start:], run))
    radii, periods = (np.concatenate(part, axis=1) for part in zip(*parts, strict=True))
    return radii, periods, _error_estimate(sweep, speeds, radii)


def _columns(sweep: _Sweep, speeds: FloatArray) -> _Columns | None:
    """Gather what the columns of a map have in common; nothing where it is no smooth function of its parameter."""
    slowest, fastest = float(speeds[0]), float(speeds[-1])
    probed = [system_at(model, slowest) for model in sweep.probed]
    # Building a system may be most of the work of a row: all are built only if these do not tell.
    if _cell_by_cell(sweep, probed) and sweep.load_parameters(probed) is None:
        return None
    first = [system_at(model, slowest) for model in sweep.models]
    loads, swept = sweep.load_parameters(first), None
    if loads is not None and sweep.keeps(loads, fastest):
        swept = LoadSweep.of(first[0], LoadColumn(*loads.transpose(1, 0, 2)))
    elif _cell_by_cell(sweep, first):
        return None
    motions = tuple(FrozenMotions.of(model, 1.0 / fastest, 1.0 / slowest) for model in sweep.probed)
    # A fresh copy: models that have been built need not travel to other processes.
    periods = np.array([system.period for system in first]) * slowest
    return _Columns(replace(sweep), swept, motions, periods)


def _by_row(sweep: _Sweep, speeds: FloatArray, run: _Run) -> tuple[FloatArray, FloatArray]:
    """Spectral radii and periods, (V, S), row by row."""
    found = np.empty((2, len(sweep.values), speeds.size))
    rows = in_rows(sweep.model, sweep.path, sweep.values, speeds, sweep.method)
    places, tasks = zip(*rows, strict=True)
    for number, result in run(tasks, "stability map", "processes"):
        found[:, places[number]] = result
    return found[0], found[1]


def _by_column(columns: _Columns, speeds: FloatArray, run: _Run) -> tuple[FloatArray, FloatArray]:
    """Spectral radii and periods, (V, S), column by column."""
    radii = np.empty((len(columns.sweep.values), speeds.size))
    chunks, sheets = _layout(columns, speeds)
    samples_of = [sample for sheet in sheets for sample in sheet.samples]
    found: dict[int, FloatArray] = {}
    # Columns of loads are batches of linear algebra; models are Python, of which only one thread runs at a time.
    prefer: Workers = "processes" if columns.loads is None else "threads"
    for number, result in run([*chunks, *samples_of], "stability map", prefer):
        if number < len(chunks):
            radii[:, chunks[number].place] = result
        else:
            found[number - len(chunks)] = result
    results = iter([found[number] for number in range(len(samples_of))])
    cells = [chunk for sheet in sheets for chunk in sheet.chunks([next(results) for _ in sheet.samples])]
    # On sheets all is linear algebra, of whatever models.
    for number, result in run(cells, "cells on sheets", "threads"):
        radii[:, cells[number].place] = result
    return radii, _periods(columns.sweep, speeds, columns.turned)


def _layout(columns: _Columns, speeds: FloatArray) -> tuple[list[_Chunk], list[_Laid]]:
    """Prepare columns of all speeds: those that are computed, and those that may be read off sheets."""
    found: list[tuple[slice, int]] = []
    if speeds.size > 1:
        exponents = np.concatenate([own.exponents for own in columns.motions])
        found = windows(replace(columns.motions[0], exponents=exponents), speeds)
    laid = [_Laid.between(inside, degree, speeds, columns) for inside, degree in found]
    stop = found[-1][0].start if found else speeds.size
    return _in_chunks(0, speeds[:stop].tolist(), columns), laid


def _periods(sweep: _Sweep, speeds: FloatArray, turned: FloatArray) -> FloatArray:
    """T0 [s] of each cell, (V, S), from the angle by which it turns in it: the parameter may be a number of teeth."""
    for probe, model in zip(sweep.probes, sweep.probed, strict=True):
        for speed in (float(speeds[speeds.size // 2]), float(speeds[-1])):
            period = model.system(speed).period
            if abs(period * speed - turned[probe]) > 1e-12 * turned[probe]:
                # Not in inverse proportion to speed.
                return np.array([[m.system(v).period for v in speeds.tolist()] for m in sweep.models])
    return np.asarray(turned[:, np.newaxis] / speeds, dtype=float)


def _cell_by_cell(sweep: _Sweep, systems: Sequence[PeriodicSystem]) -> bool:
    """Whether a column is no smooth function of its parameter, which counts something or moves breakpoints."""
    few = len(sweep.values) <= len(sweep.probes) or is_whole_number(sweep.model, sweep.parameter)
    return few or any(not same_layout(systems[0], other) for other in systems[1:])


def _spectral_radius(system: PeriodicSystem, method: Method | None) -> float:
    return float(np.abs(multipliers(system, method)[0]))


def _error_estimate(sweep: _Sweep, speeds: FloatArray, radii: FloatArray) -> float:
    """Largest difference of max|λ| from a more accurate method, and rounding, corner cells and middle cell."""
    last_value, last_speed = radii.shape[0] - 1, radii.shape[1] - 1
    cells = {(v, s) for v in (0, last_value) for s in (0, last_speed)} | {(last_value // 2, last_speed // 2)}
    worst = 0.0
    for v, s in sorted(cells):
        system, radius = sweep.model_at(sweep.values[v]).system(float(speeds[s])), float(radii[v, s])

        def error(method: Method, system: PeriodicSystem = system, radius: float = radius) -> float:
            difference = abs(_spectral_radius(system, method.refined()) - radius)
            return difference + rounding_shift(system, method)

        worst = max(worst, with_method(sweep.method, error))
    return worst
