"""Columns of a map that lie close together, read off a sheet (:mod:`facegear.floquet.sheets`).

Columns are computed at few speeds, and in each group of columns one is computed all the same, to see whether the sheet
is right. What is left are eigenvalues.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from facegear.floquet.columns import (
    agree,
)
from facegear.floquet.eigenvalues import spectral_radii
from facegear.floquet.error_estimates import rounding_error
from facegear.floquet.free_modes import UnsuitableSystemError
from facegear.floquet.methods import Method, with_method
from facegear.floquet.series import ChebyshevSeries
from facegear.floquet.sheets import SHEET_TOLERANCE, Sheet, samples, windows
from facegear.floquet.stepping import Family
from facegear.maps.map_columns import Chunk, Columns, SweptLoads, in_chunks
from facegear.support.types import FloatArray

# Columns of a sheet that are computed together: each group has a column that is computed to check the others.
_SHEET_CHUNK = 16


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
    columns: Columns
    speed: float

    def content(self) -> Iterator[Any]:
        """Everything the result depends on."""
        yield from self.window.content()
        yield from self.columns.at(self.speed).content()

    def compute(self) -> FloatArray:
        """See :func:`facegear.floquet.sheets.samples`; nothing where another column would be needed, or method."""
        column, window = self.columns.at(self.speed), self.window
        if isinstance(column, SweptLoads) == (self.columns.loads is not None):
            try:
                evaluate = column.matrices(window.method, window.scale)
                return samples(evaluate, column.variable, column.smooth, window.degree_along)
            except UnsuitableSystemError:
                pass
        return np.empty((0, *window.scale.shape))


@dataclass(frozen=True, eq=False)
class _SheetChunk(Chunk):
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
class Laid:
    """Neighbouring columns, and the samples of the sheet that may be laid through them."""

    start: int
    speeds: tuple[float, ...]
    columns: Columns
    window: _Window
    samples: tuple[_Samples, ...]

    @classmethod
    def between(cls, inside: slice, degree: int, speeds: FloatArray, columns: Columns) -> Laid:
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

    def chunks(self, found: Sequence[FloatArray]) -> list[Chunk]:
        """Prepare the columns, on the sheet through what was found if that is smooth."""
        window = self.window
        sheet = Sheet.through(window.low, window.high, found, self.columns.ends, window.tolerance)
        if sheet is None:
            return in_chunks(self.start, self.speeds, self.columns)
        return [
            _SheetChunk(chunk.place, self.columns, chunk.speeds, window, sheet)
            for chunk in in_chunks(self.start, self.speeds, self.columns, _SHEET_CHUNK)
        ]


def laid_out(columns: Columns, speeds: FloatArray) -> tuple[list[Chunk], list[Laid]]:
    """Prepare columns of all speeds: those that are computed, and those that may be read off sheets."""
    found: list[tuple[slice, int]] = []
    if speeds.size > 1:
        exponents = np.concatenate([own.exponents for own in columns.motions])
        found = windows(replace(columns.motions[0], exponents=exponents), speeds)
    laid = [Laid.between(inside, degree, speeds, columns) for inside, degree in found]
    stop = found[-1][0].start if found else speeds.size
    return in_chunks(0, speeds[:stop].tolist(), columns), laid
