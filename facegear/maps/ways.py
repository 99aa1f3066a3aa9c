"""By what a map goes, found out once: cells of small systems, columns along the parameter, or rows along speed.

A :class:`Way` is computed whole by the workers of :func:`facegear.maps.stability_map.stability_map`, or in parts, as by
the explorer, without looking again at what the systems have in common.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from facegear.maps.cells import Cells, cells_of
from facegear.maps.map_columns import Columns, columns_of
from facegear.maps.map_sheets import laid_out
from facegear.maps.parallel import Task, Workers
from facegear.maps.rows import in_rows
from facegear.maps.sweep import Sweep
from facegear.support.types import FloatArray

Batch = tuple[Sequence[Task], str, Workers]
"""Tasks that may be computed in any order, what they are called, and what their workers had best be."""
Results = dict[int, FloatArray]
"""Of a batch, by the numbers of its tasks."""
Run = Callable[[Sequence[Task], str, Workers], Iterator[tuple[int, FloatArray]]]
"""Results of tasks with their numbers, as :func:`facegear.maps.parallel.computed` gives them."""


@dataclass(frozen=True, eq=False)
class Way:
    """What a map goes by.

    Attributes
    ----------
    sweep : Sweep
    speeds : ndarray, shape (S,)
        Ascending [rad/s].
    cells : Cells, optional
        All cells, where they are computed one by one.
    columns : Columns, optional
        Of the speeds from number `start` on. Below it, and where there are none, the map goes by rows.
    start : int
    """

    sweep: Sweep
    speeds: FloatArray
    cells: Cells | None
    columns: Columns | None
    start: int

    @classmethod
    def of(cls, sweep: Sweep, speeds: FloatArray) -> Way:
        """Find out what the systems of a sweep have in common at speeds (S,), ascending [rad/s]."""
        cells = None if sweep.method is not None else cells_of(sweep.models, sweep.probes, speeds)
        if cells is not None:
            return cls(sweep, speeds, cells, None, speeds.size)
        return cls._without_cells(sweep, speeds)

    @classmethod
    def _without_cells(cls, sweep: Sweep, speeds: FloatArray) -> Way:
        columns = columns_of(sweep, speeds)
        start = speeds.size if columns is None else columns.smooth_from(speeds)
        return cls(sweep, speeds, None, columns if start < speeds.size else None, start)

    @classmethod
    def throughout(cls, sweep: Sweep, speeds: FloatArray) -> Way:
        """As :meth:`of`, but by columns only where all of them are: the rest need not be planned."""
        cells = None if sweep.method is not None else cells_of(sweep.models, sweep.probes, speeds)
        columns = columns_of(sweep, speeds) if cells is None else None
        if columns is None or not columns.smooth_at(float(speeds[0])):
            return cls(sweep, speeds, cells, None, speeds.size)
        return cls(sweep, speeds, None, columns, 0)

    @property
    def name(self) -> Literal["cells", "loads", "columns", "rows"]:
        """Say what all cells go by, or "rows" if only some do otherwise; "loads" are the cheapest columns."""
        if self.cells is not None:
            return "cells"
        if self.columns is None or self.start > 0:
            return "rows"
        return "columns" if self.columns.loads is None else "loads"

    def part(self, rows: NDArray[np.intp], columns: NDArray[np.intp]) -> Way:
        """Return the way of some rows and columns, by their numbers, ascending.

        Columns of fewer values are others: where they are not of loads alone, part of the values goes by rows.
        """
        sweep, speeds = self.sweep, self.speeds[columns]
        whole = rows.size == len(sweep.values)
        if not whole:
            sweep = sweep.some(rows)
        if self.cells is not None:
            return Way(sweep, speeds, self.cells.some(rows, columns), None, speeds.size)
        if whole and self.columns is not None:
            start = int(np.count_nonzero(columns < self.start))
            return Way(sweep, speeds, None, self.columns if start < speeds.size else None, start)
        return Way(sweep, speeds, None, None, speeds.size)

    def radii(self, run: Run) -> tuple[FloatArray, FloatArray, bool]:
        """Spectral radii [-] and periods [s], each (V, S), and whether all of them are those of `cells`."""
        batches = self.batches()
        try:
            batch = next(batches)
            while True:
                batch = batches.send(dict(run(*batch)))
        except StopIteration as end:
            found: tuple[FloatArray, FloatArray, bool] = end.value
            return found

    def batches(self) -> Generator[Batch, Results, tuple[FloatArray, FloatArray, bool]]:
        """Return what :meth:`radii` does to whoever computes the tasks of each batch and sends their results."""
        if self.cells is None:
            return *(yield from self._by_column_or_row()), False
        radii = np.empty((len(self.sweep.values), self.speeds.size))
        places, tasks = self.cells.tasks()
        results = yield tasks, "stability map", "threads"
        for number, place in enumerate(places):
            radii[place] = results[number]
        left = np.flatnonzero(np.isnan(radii[:, 0]))
        if left.size == len(self.sweep.values):
            way = Way._without_cells(self.sweep, self.speeds)
            return *(yield from way._by_column_or_row()), False
        periods = self.cells.periods
        if left.size:
            radii[left], periods[left] = yield from _by_row(self.sweep.some(left), self.speeds)
        return radii, periods, left.size == 0

    def _by_column_or_row(self) -> Generator[Batch, Results, tuple[FloatArray, FloatArray]]:
        parts = []
        if self.start > 0:
            parts.append((yield from _by_row(self.sweep, self.speeds[: self.start])))
        if self.columns is not None:
            speeds = self.speeds[self.start :]
            parts.append(((yield from _by_column(self.columns, speeds)), self.columns.periods(speeds)))
        radii, periods = (np.concatenate(part, axis=1) for part in zip(*parts, strict=True))
        return radii, periods


def _by_row(sweep: Sweep, speeds: FloatArray) -> Generator[Batch, Results, tuple[FloatArray, FloatArray]]:
    """Spectral radii and periods, (V, S), row by row."""
    found = np.empty((2, len(sweep.values), speeds.size))
    rows = in_rows(sweep.model, sweep.path, sweep.values, speeds, sweep.method)
    places, tasks = zip(*rows, strict=True)
    results = yield tasks, "stability map", "processes"
    for number, place in enumerate(places):
        found[:, place] = results[number]
    return found[0], found[1]


def _by_column(columns: Columns, speeds: FloatArray) -> Generator[Batch, Results, FloatArray]:
    """Spectral radii, (V, S), column by column."""
    radii = np.empty((len(columns.sweep.values), speeds.size))
    chunks, sheets = laid_out(columns, speeds)
    samples_of = [sample for sheet in sheets for sample in sheet.samples]
    # Columns of loads are batches of linear algebra; models are Python, of which only one thread runs at a time.
    prefer: Workers = "processes" if columns.loads is None else "threads"
    results = yield [*chunks, *samples_of], "stability map", prefer
    for number, chunk in enumerate(chunks):
        radii[:, chunk.place] = results[number]
    found = iter([results[len(chunks) + number] for number in range(len(samples_of))])
    cells = [chunk for sheet in sheets for chunk in sheet.chunks([next(found) for _ in sheet.samples])]
    # On sheets all is linear algebra, of whatever models.
    results = yield cells, "cells on sheets", "threads"
    for number, chunk in enumerate(cells):
        radii[:, chunk.place] = results[number]
    return radii
