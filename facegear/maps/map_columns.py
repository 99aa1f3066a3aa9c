"""Columns of a map: spectral radii along a parameter at one speed.

Where only the mass, damping or stiffness of the contacts changes along a column, its transition matrices share nearly
all their work (:class:`facegear.floquet.columns.LoadSweep`). They are interpolated along the parameter as far as they
are smooth, and computed cell by cell where they are not.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from facegear.floquet.columns import (
    LOWEST_DEGREE,
    Evaluate,
    LoadSweep,
    column_of,
    family_matrices,
)
from facegear.floquet.load_columns import LoadColumn
from facegear.floquet.methods import Method, with_method
from facegear.floquet.models import (
    system_at,
)
from facegear.floquet.multiplier_curves import FrozenMotions, degree_between
from facegear.floquet.multipliers import multipliers
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.sheets import SHEET_TOLERANCE, is_interpolated, samples, windows
from facegear.floquet.stepping import Family
from facegear.maps.axes import periods_at
from facegear.maps.parallel import parts_of
from facegear.maps.sweep import Sweep, cell_by_cell
from facegear.support.types import ComplexArray, FloatArray

# Columns of a map that are computed, and kept on disk, together.
_CHUNK = 8
# Degrees of series along parameters for each value of which a model is built.
_DEGREES = tuple(degree * 2**power for power in range(9) for degree in (8, 10, 12, 14))
# Columns are taken by series along the parameter whose degree is at most this part of the number of values.
_MOST_OF_A_COLUMN = 0.8


@dataclass(frozen=True, eq=False)
class SweptLoads:
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
class SweptModels:
    """A column along which anything may change."""

    sweep: Sweep
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
        if cell_by_cell(self.sweep, self.probed):
            cells = (model.system(self.speed) for model in self.sweep.models)
            return np.array([spectral_radius(cell, method) for cell in cells])
        return _column_radii(self, method, degree)


Column = SweptLoads | SweptModels


def _column_radii(column: Column, method: Method | None, degree: int) -> FloatArray:
    scale = column.scale
    return with_method(
        method,
        lambda chosen: column_of(column.matrices(chosen, scale), column.variable, column.smooth, degree),
    )


@dataclass(frozen=True, eq=False)
class Columns:
    """What all columns have in common.

    Motions are those of the first, the middle and the last value; `turned` is the period times the speed of each value,
    or nothing where that is not the same at all speeds.
    """

    sweep: Sweep
    loads: LoadSweep | None
    motions: tuple[FrozenMotions, ...]
    turned: FloatArray | None

    def periods(self, speeds: FloatArray) -> FloatArray:
        """Periods T0 [s] at speeds (S,), shape (V, S)."""
        if self.turned is None:
            return np.stack([periods_at(model, speeds) for model in self.sweep.models])
        return np.asarray(self.turned[:, np.newaxis] / speeds)

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
        if self.smooth_at(float(speeds[0])):
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
        return start if fewer and self.smooth_at(float(part[0])) else speeds.size

    def smooth_at(self, speed: float) -> bool:
        """Whether columns take few matrices at a speed and at all faster ones, or are so cheap that they may."""
        if self.loads is not None:
            return True
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
        """Exponents over slowness of the first and of the last value, slow ones first.

        Growth is left out, at the ends already: a motion that begins to grow between them turns no other way.
        """
        first, last = (
            np.minimum(exponents.real, 0.0) + 1j * exponents.imag
            for exponents in (
                motions.exponents[motions.exponents.imag >= 0.0]
                for motions in (self.motions[0], self.motions[-1])
            )
        )
        return first[np.argsort(first.imag)], last[np.argsort(last.imag)]

    def at(self, speed: float) -> Column:
        """Return the column at a speed.

        Load parameters are those of all values at the first speed; at the others the first, middle and last value show
        whether they, or anything else, depend on both speed and value.
        """
        if self.loads is not None:
            column = self.loads.column
            loads = np.stack([column.mass, column.damping, column.stiffness], axis=1)
            if self.sweep.keeps(loads, speed):
                return SweptLoads(self.sweep.probed[0].system(speed), self.loads)
        return SweptModels(self.sweep, speed)

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
class Chunk:
    """Neighbouring columns."""

    place: slice
    columns: Columns
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


def in_chunks(start: int, speeds: Sequence[float], columns: Columns, size: int = _CHUNK) -> list[Chunk]:
    """Group columns, the first of which has the number `start`."""
    parts = [tuple(speeds[k : k + size]) for k in range(0, len(speeds), size)]
    return [
        Chunk(slice(start + k * size, start + k * size + len(part)), columns, part)
        for k, part in enumerate(parts)
    ]


def columns_of(sweep: Sweep, speeds: FloatArray) -> Columns | None:
    """Gather what the columns of a map have in common; nothing where it is no smooth function of its parameter."""
    slowest, fastest = float(speeds[0]), float(speeds[-1])
    probed = [system_at(model, slowest) for model in sweep.probed]
    # Building a system may be most of the work of a row: all are built only if these do not tell.
    if cell_by_cell(sweep, probed) and sweep.load_parameters(probed) is None:
        return None
    first = [system_at(model, slowest) for model in sweep.models]
    loads, swept = sweep.load_parameters(first), None
    if loads is not None and sweep.keeps(loads, fastest):
        swept = LoadSweep.of(first[0], LoadColumn(*loads.transpose(1, 0, 2)))
    elif cell_by_cell(sweep, first):
        return None
    motions = tuple(FrozenMotions.of(model, 1.0 / fastest, 1.0 / slowest) for model in sweep.probed)
    # A fresh copy: models that have been built need not travel to other processes.
    turned = np.array([system.period for system in first]) * slowest
    # Of three values it is seen whether all have their periods in inverse proportion to speed.
    for speed in (float(speeds[speeds.size // 2]), fastest):
        again = np.array([model.system(speed).period for model in sweep.probed]) * speed
        if (np.abs(again - turned[list(sweep.probes)]) > 1e-12 * again).any():
            return Columns(replace(sweep), swept, motions, None)
    return Columns(replace(sweep), swept, motions, turned)


def spectral_radius(system: PeriodicSystem, method: Method | None) -> float:
    """Largest modulus of the multipliers."""
    return float(np.abs(multipliers(system, method)[0]))
