"""In which order the cells of a map at reading resolution are computed: few all over it first, then those between.

A stage is every so manyth row at every so manyth speed. Its pieces are so short that between them a reader who has
changed something is heard; a costly drive has shorter pieces and more stages, so that one which can be read is there
early.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from facegear.floquet.models import Model
from facegear.support.types import FloatArray

# Rows first: speeds are half again as many.
_BY_ROWS = ((8, 4), (4, 4), (2, 4), (2, 2), (2, 1), (1, 1))
# Of small systems all speeds of a row take little longer than some.
_BY_CELLS = ((8, 4), (2, 1), (1, 1))
_BY_COLUMNS = ((8, 4), (1, 4), (1, 2), (1, 1))
_ALL_COLUMNS = ((8, 4), (1, 1))
# The weight of a cell is coordinates times loads, more where periods are long: that of a motion which turns by so many
# radians in one is twice that of none. Up to some weight all columns, which are cheaper together, take less than a
# second.
_TWICE, _LIGHT = 60.0, 25.0
# Weight of the cells of a piece, and of one row of its columns; and of how many cells at once it is worth the while.
_CELLS, _COLUMNS, _FEWEST = 5000.0, 320.0, 30

Goes = Literal["cells", "loads", "columns", "rows"]
Piece = tuple[NDArray[np.intp], NDArray[np.intp]]
"""Numbers of rows and of columns, ascending."""


@dataclass(frozen=True)
class Plan:
    """Stages of a map, and the size of their pieces.

    Attributes
    ----------
    steps : tuple of (int, int)
        Of each stage: every so manyth row, every so manyth speed. The last is (1, 1).
    cells : int
        Of a piece, about.
    columns : int, optional
        Of a piece, where all but the first stage are made of whole columns.
    """

    steps: tuple[tuple[int, int], ...]
    cells: int
    columns: int | None

    @classmethod
    def of(cls, model: Model, speeds: FloatArray, way: Goes) -> Plan:
        """Plan the map of a model at speeds (S,) [rad/s] by what :attr:`facegear.maps.ways.Way.name` says."""
        weight = _weight(model, speeds)
        cells = max(_FEWEST, int(_CELLS / weight))
        if way in ("rows", "cells"):
            return cls(_BY_ROWS if way == "rows" else _BY_CELLS, cells, None)
        if weight <= _LIGHT:
            return cls(_ALL_COLUMNS, cells, speeds.size)
        return cls(_BY_COLUMNS, cells, max(1, int(_COLUMNS / weight)))

    def grid(self, stage: int, shape: tuple[int, ...]) -> Piece:
        """Rows and columns of a stage, by its number, among (V, S): those of the stages before are among them."""
        # The widest steps begin in their middle, where narrower ones come by, so that neighbours lie on both sides.
        first, second = (
            np.arange(min(step // 2, size - 1) if step == widest else 0, size, step)
            for step, widest, size in zip(self.steps[stage], self.steps[0], shape, strict=True)
        )
        return first, second

    def pieces(self, growth: FloatArray, stage: int) -> Iterator[Piece]:
        """Pieces of what a stage, by its number, lacks where growth rates (V, S) are NaN."""
        rows, columns = self.grid(stage, growth.shape)
        lacking = np.isnan(growth[np.ix_(rows, columns)])
        if stage > 0 and self.columns is not None:
            for part in _in_parts(columns[lacking.any(axis=0)], self.columns):
                yield np.arange(growth.shape[0]), part
            return
        # Rows lack all of their cells, or the same ones.
        for which in np.unique(lacking, axis=0):
            of_these = rows[(lacking == which).all(axis=1)]
            for part in _in_parts(columns[which], self.cells):
                for some in _in_parts(of_these, max(1, self.cells // part.size)):
                    yield some, part

    def shown(self, growth: FloatArray, stage: int) -> FloatArray:
        """Growth rates (V, S) with those that are NaN taken from a neighbour, of the finest stage that has one."""
        found = np.full_like(growth, np.nan)
        for number in range(stage + 1):
            grid = self.grid(number, growth.shape)
            own = growth[np.ix_(*(_nearest(*each) for each in zip(grid, growth.shape, strict=True)))]
            found = np.where(np.isnan(own), found, own)
        return np.where(np.isnan(growth), found, growth)


def _weight(model: Model, speeds: FloatArray) -> float:
    """Cost of a cell, about, in units of a slow coordinate under one load."""
    fastest = float(speeds[-1])
    system = model.system(fastest)
    squares = np.abs(np.linalg.eigvals(np.linalg.solve(system.mass, system.stiffness)))
    turn = float(np.sqrt(squares.max())) * system.period * float((fastest / speeds).mean())
    return system.size * max(len(system.loads), 1) * (1.0 + turn / _TWICE)


def _in_parts(numbers: NDArray[np.intp], size: int) -> list[NDArray[np.intp]]:
    """As few parts as have at most so many numbers, of about one size."""
    return np.array_split(numbers, -(-numbers.size // size)) if numbers.size else []


def _nearest(chosen: NDArray[np.intp], size: int) -> NDArray[np.intp]:
    return np.asarray(chosen[np.abs(np.arange(size)[:, np.newaxis] - chosen).argmin(axis=1)])
