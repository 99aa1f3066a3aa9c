"""Rows of a map: spectral radii along speed at one value of a parameter.

At one value, transition matrices are smooth functions of the slowness 1/speed, however roughly they depend on the
parameter: on a number of teeth, or on a torque that moves the instants at which pairs begin and end. Matrices of many
speeds are computed together, and interpolated along slowness where that takes fewer of them. Of few speeds a series
would spare too little: they are computed cell by cell, neighbouring rows together.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from facegear.floquet.columns import interpolated_spectral_radii
from facegear.floquet.eigenvalues import spectral_radii
from facegear.floquet.error_estimates import rounding_error
from facegear.floquet.methods import Method, with_method
from facegear.floquet.models import Model, replace_at
from facegear.floquet.multiplier_curves import FrozenMotions
from facegear.floquet.multipliers import transition_matrices
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.sheets import FEWEST_SPEEDS, SHEET_TOLERANCE, windows
from facegear.floquet.stepping import Family
from facegear.maps.axes import periods_at
from facegear.maps.likeness import same_layout
from facegear.maps.parallel import parts_of
from facegear.support.types import FloatArray

# Rows of at most so many speeds are computed cell by cell.
_FEW = 64
# Cells that are computed, and kept on disk, together, if two such rows have fewer.
_CELLS = 32


@dataclass(frozen=True, eq=False)
class Rows:
    """Neighbouring rows.

    Attributes
    ----------
    model : Model
    path : tuple of str
        Fields that lead to the parameter.
    values : tuple of float
        Of the parameter, one a row.
    speeds : tuple of float
        Ascending [rad/s].
    method : Method, optional
        See :func:`facegear.floquet.methods.with_method` if left out.
    """

    model: Model
    path: tuple[str, ...]
    values: tuple[float, ...]
    speeds: tuple[float, ...]
    method: Method | None

    def content(self) -> Iterator[Any]:
        """Everything the result depends on: of the models' code, what it makes of the first value."""
        yield (
            repr(self.model),
            repr(self.path),
            np.array(self.values),
            np.array(self.speeds),
            repr(self.method),
        )
        first = replace_at(self.model, self.path, self.values[0])
        for speed in (self.speeds[0], self.speeds[-1]):
            yield from parts_of(first.system(speed))

    def compute(self) -> FloatArray:
        """Largest moduli of the multipliers [-], and periods [s], shape (2, rows, speeds)."""
        speeds = np.array(self.speeds)
        # Models are built here, in the process that uses them: what they prepare may be most of the work.
        models = [replace_at(self.model, self.path, value) for value in self.values]
        return rows_of(models, speeds, self.method)


def rows_of(models: Sequence[Model], speeds: FloatArray, method: Method | None) -> FloatArray:
    """Largest moduli of the multipliers [-], and periods [s], of models at speeds (S,), shape (2, models, S)."""
    if speeds.size <= _FEW:
        return _cell_by_cell(models, speeds, method)
    return np.stack([_row(model, speeds, method) for model in models], axis=1)


def in_rows(
    model: Model, path: tuple[str, ...], values: Sequence[float], speeds: FloatArray, method: Method | None
) -> Iterator[tuple[slice, Rows]]:
    """Group values, each group with its place among them."""
    size = max(2 if speeds.size <= _FEW else 1, _CELLS // speeds.size)
    for start in range(0, len(values), size):
        part = tuple(values[start : start + size])
        yield slice(start, start + len(part)), Rows(model, path, part, tuple(speeds.tolist()), method)


def _cell_by_cell(models: Sequence[Model], speeds: FloatArray, method: Method | None) -> FloatArray:
    """Spectral radii and periods of several models at speeds (S,), shape (2, rows, S)."""
    systems = [[model.system(speed) for speed in speeds.tolist()] for model in models]
    periods = [[system.period for system in row] for row in systems]
    radii = np.empty((len(models), speeds.size))
    for rows in _of_one_layout(systems):
        # Speed by speed: neighbours are then of similar periods.
        found = _radii([systems[row][column] for column in range(speeds.size) for row in rows], method)
        radii[rows] = found.reshape(speeds.size, len(rows)).T
    return np.stack([radii, periods])


def _of_one_layout(systems: Sequence[Sequence[PeriodicSystem]]) -> list[list[int]]:
    """Numbers of rows whose first systems have the same loads and breakpoints."""
    found: list[list[int]] = []
    for number, row in enumerate(systems):
        for those in found:
            if same_layout(systems[those[0]][0], row[0]):
                those.append(number)
                break
        else:
            found.append([number])
    return found


def _radii(systems: list[PeriodicSystem], method: Method | None) -> FloatArray:
    """Spectral radii of systems (K,)."""

    def scaled(chosen: Method) -> list[FloatArray]:
        return [chosen.scaled_transition_matrices(Family(group)) for group in _alike(systems, chosen)]

    return np.concatenate([spectral_radii(matrices) for matrices in with_method(method, scaled)])


def _row(model: Model, speeds: FloatArray, method: Method | None) -> FloatArray:
    """Spectral radii and periods of a model at speeds (S,), shape (2, S)."""
    slowness = 1.0 / speeds
    periods = periods_at(model, speeds)
    planned: list[tuple[slice, int]] = []
    if speeds.size >= FEWEST_SPEEDS:
        planned = windows(FrozenMotions.of(model, slowness[-1], slowness[0]), speeds)
    alone = slice(0, planned[-1][0].start if planned else speeds.size)
    # Coordinates in which entries are of comparable size, the same for all that is interpolated.
    scale = Family([model.system(float(speeds[-1]))]).scale
    inverse = np.linalg.inv(scale)

    def radii(chosen: Method) -> FloatArray:
        def matrices(x: FloatArray) -> FloatArray:
            return np.asarray(scale @ _matrices(model, x, chosen) @ inverse, dtype=float)

        found = np.empty(speeds.size)
        for inside, degree in planned:
            # No series resolves rounding, which is largest in the longest period.
            slowest = Family([model.system(float(speeds[inside.start]))])
            rounding = rounding_error(np.eye(2 * slowest.size), slowest, chosen)
            tolerance = max(SHEET_TOLERANCE, 4.0 * rounding)
            found[inside] = interpolated_spectral_radii(matrices, slowness[inside], tolerance, degree)
        if alone.stop:
            found[alone] = spectral_radii(matrices(slowness[alone]))
        return found

    return np.stack([with_method(method, radii), periods])


def _matrices(model: Model, slowness: FloatArray, method: Method) -> FloatArray:
    """Transition matrices at values of slowness (K,), shape (K, d, d)."""
    systems = [model.system(speed) for speed in (1.0 / slowness).tolist()]
    return np.concatenate([transition_matrices(group, method) for group in _alike(systems, method)])


def _alike(systems: list[PeriodicSystem], method: Method) -> Iterator[list[PeriodicSystem]]:
    """Neighbours with the same loads and breakpoints, few enough for the method to take together."""
    start = 0
    for number, system in enumerate(systems):
        if number - start == method.together or not same_layout(systems[start], system):
            yield systems[start:number]
            start = number
    yield systems[start:]
