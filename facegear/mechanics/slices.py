"""Lines of slices that a pair of teeth has in mesh, of flanks that touch at a point as long as nothing is loaded.

Under load, contact spreads from the point to slices beside it (:mod:`facegear.mechanics.slice_gap`). At a rotation, the
slices that a pair can use lie along a line θs = q + ψ(q) N2/Ns − c, between the edges of the face, the tooth top and
the pinion's tip, as contact lines do (:mod:`facegear.geometry.contact_lines`); ψ is 0 between aligned gears.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.mechanics.slice_gap import MARGIN, SliceGap
from facegear.support.roots import crossing, root
from facegear.support.types import FloatArray

# Lines that are looked at to see where another edge ends them, parts into which a search divides an interval, and how
# short that may be in the end [mesh periods].
_LINES, _SECTIONS, _SAME = 240, 17, 1e-13
# Which of the lower bounds is what the shaper leaves, where it cuts.
_CUT = 4
# Pieces next to a square root: each so many times shorter than the one before it, the last as short as this.
_GRADING, _SHORTEST = 8.0, 1e-9


@dataclass(frozen=True)
class Slices(SliceGap):
    """Slices of the flanks of a pinion and of a face gear cut by a shaper with more teeth, and lines of them.

    Parameters and errors are those of :class:`SliceGap`.
    """

    @property
    def pitch(self) -> float:
        """By how much c falls in a mesh period [rad]."""
        return 2.0 * math.pi / self.drive.generating.pinion_teeth

    def roll(self, q: FloatArray, c: FloatArray) -> FloatArray:
        """Roll angle θs at which a slice is in mesh at a rotation c [rad]."""
        return np.asarray(q + self._turn(q) - c, dtype=float)

    def _bounds(self, c: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Local pressure angles that bound lines from below, (4, ...), and from above, (3, ...) [rad].

        Below: involutes of shaper and pinion begin, tooth top of the gear, inner edge or what the shaper leaves of
        it; above: tips of shaper and pinion, outer edge.
        """
        shaper, region, contact = self.drive.generating, self.drive.contact_region, self.contact
        lines = np.asarray(c, dtype=float)
        least, most = (np.full(lines.shape, end) for end in self._range)

        def own_roll(q: FloatArray, line: FloatArray) -> FloatArray:
            return contact.lines.own_roll(q, self.roll(q, line))

        def at_roll(roll: float) -> FloatArray:
            return crossing(lambda q, line: self.roll(q, line) - roll, least, most, lines)

        base, own_base = at_roll(0.0), crossing(own_roll, least, most, lines)
        first = np.maximum(base, own_base)
        tip = at_roll(shaper.shaper_tip_roll)
        own_tip = crossing(lambda q, line: own_roll(q, line) - self.drive.pinion_tip_roll, least, most, lines)

        def above(q: FloatArray, line: FloatArray) -> FloatArray:
            return np.asarray(region.depth(q, self.roll(q, line)) - shaper.tooth_top_distance)

        def outside(q: FloatArray, line: FloatArray, radius: FloatArray) -> FloatArray:
            # Before the involute begins as at its beginning, where the radius rises with q.
            return np.asarray(region.radial_position(q, np.maximum(self.roll(q, line), 0.0)) - radius)

        top = crossing(above, first, most, lines)
        inner = crossing(outside, first, most, lines, shaper.flank_start)
        # From where lines cannot be, so that those of which nothing is left are told from those that end.
        outer = crossing(outside, least, most, lines, shaper.outer_radius)
        lower = [base, own_base, top, inner]
        if self.drive.shaft_angle > 0.5 * math.pi:
            ends = np.maximum.reduce(lower), np.minimum.reduce([tip, own_tip, outer])

            def clear(q: FloatArray, line: FloatArray) -> FloatArray:
                return region.shaper.clearance(q, self.roll(q, line))

            # A little beyond, for the same reason.
            lower.append(crossing(clear, ends[0], np.minimum(np.maximum(*ends) + MARGIN, most), lines))
        return np.stack(lower), np.stack([tip, own_tip, outer])

    def _width(self, c: float) -> float:
        lower, upper = self._bounds(np.array(c))
        return float(upper.min() - lower.max())

    @cached_property
    def limits(self) -> tuple[float, float]:
        """C of the first line that lies on both flanks, and of the last, which is smaller [rad]."""
        middle = float(self.contact.pressure_angle + self._turn(np.array(self.contact.pressure_angle)))
        middle -= 0.5 * float(sum(self.contact.rolls))
        ends = []
        for sense in (1.0, -1.0):
            step = self.pitch
            while self._width(middle + sense * step) > 0.0:
                step += self.pitch
            ends.append(root(self._width, middle + sense * (step - self.pitch), middle + sense * step))
        return ends[0], ends[1]

    @property
    def sweep(self) -> float:
        """Mesh periods from the first line to the last."""
        return (self.limits[0] - self.limits[1]) / self.pitch

    @cached_property
    def kinks(self) -> tuple[float, ...]:
        """Ages of lines at which another edge ends them [mesh periods], ascending."""
        # The first and the last line have no length, and so no edge: lines nearer and nearer to them.
        near = _GRADING ** -np.arange(1.0, round(math.log(1.0 / _SHORTEST, _GRADING))) / _LINES
        inside = np.arange(1.0, _LINES) / _LINES
        ages = self.sweep * np.concatenate([near[::-1], inside, 1.0 - near])
        found = []
        for side in (0, 1):
            labels = self._edges(ages, side)
            for k in np.flatnonzero(np.diff(labels)):
                low, label = float(ages[k]), labels[k]
                # There may be several edges in turn.
                while label != labels[k + 1]:
                    high = float(ages[k + 1])
                    while high - low > _SAME:
                        between = np.linspace(low, high, _SECTIONS)
                        first = int(np.argmax(self._edges(between, side) != label))
                        low, high = float(between[first - 1]), float(between[first])
                    found.append(high)
                    low, label = high, self._edges(np.array([high]), side)[0]
        return tuple(sorted(found))

    def _edges(self, ages: FloatArray, side: int) -> NDArray[np.int64]:
        """Which of the :meth:`_bounds` end lines at one side; of the shaper's cut also which part of the shaper."""
        lines = self._line(ages)
        bounds = self._bounds(lines)[side]
        labels = np.argmin(bounds, axis=0) if side else np.argmax(bounds, axis=0)
        cut = (labels == _CUT) & (side == 0)
        if np.any(cut):
            q = bounds[_CUT][cut]
            labels[cut] += self.drive.contact_region.shaper.cut_by(q, self.roll(q, lines[cut]))[0]
        return np.asarray(labels)

    def _line(self, age: FloatArray) -> FloatArray:
        """C of a line so many mesh periods after the first [rad]."""
        return np.asarray(self.limits[0] - age * self.pitch)

    @cached_property
    def _ends(self) -> PiecewiseChebyshev:
        """Both ends of a line against its age over `_whole`, as s [√m]; beyond the last line those of the last."""
        edges = _apart(np.array([0.0, *self.kinks, self.sweep]) / self._whole)
        tolerances = np.full(edges.shape, 1e-11 if self.drive.contact_region.is_cut else 1e-12)
        if self.few_teeth:
            # An end comes down to a base circle with the square root of time: pieces shrink towards such kinks.
            edges = np.unique([*edges, *_graded(edges)])
            tolerances = 1e-12 * np.maximum(1.0, 1e-3 / np.diff(edges, append=1.0))

        def ends(fractions: FloatArray, pieces: NDArray[np.intp]) -> FloatArray:
            lower, upper = self._bounds(self._line(np.minimum(fractions * self._whole, self.sweep)))
            return self.root_gap(np.stack([lower.max(axis=0), upper.min(axis=0)], axis=-1))

        try:
            return PiecewiseChebyshev.fit_together(ends, edges, tolerance=tolerances)
        except ValueError as error:
            drive = self.drive
            raise ArithmeticError(
                f"contact lines of {drive.pinion_teeth}/{drive.gear_teeth} teeth at a shaft angle of "
                f"{math.degrees(drive.shaft_angle):.6g}°, cut by {drive.generating.pinion_teeth} teeth, with "
                f"{self.contact.misalignment!r}: their ends cannot be followed, as where corners of the shaper cut the "
                f"flank; nearby angles or misalignments mostly can ({error})"
            ) from error

    @property
    def _whole(self) -> float:
        """What the ages of lines are counted by [mesh periods]: the last is not to be taken for the next first."""
        return self.sweep + 1.0

    @property
    def breakpoints(self) -> FloatArray:
        """Ages of lines between which their ends are smooth [mesh periods], ascending from 0."""
        return np.asarray(self._ends.breakpoints[:-1] * self._whole)

    @property
    def few_teeth(self) -> bool:
        """Whether lines end where an involute begins: there their ends have no finite speed."""
        return self.drive.generating.tooth_top_distance < max(
            self.drive.base_radius + self.drive.axis_offset, self.drive.generating.base_radius
        )

    def ends(self, age: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Slices at the two ends of lines.

        Parameters
        ----------
        age : array_like
            Mesh periods since the first line, from 0 to `sweep`.

        Returns
        -------
        inner, outer : ndarray, shape of `age`
            As s [√m].
        """
        ends = self._ends(np.clip(np.asarray(age, dtype=float), 0.0, self.sweep) / self._whole)
        return ends[..., 0], ends[..., 1]

    def generated(self, s: FloatArray, age: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Local pressure angles q and roll angles θs of the shaper where it makes what slices press at an age [rad]."""
        q = np.asarray(self.pressure_angle(s))
        return q, self.roll(q, self._line(age))

    def place(self, s: FloatArray, age: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Where slices are in mesh: radius r [m] and angle θ about the gear's axis [rad], from the pinion's."""
        x, y, _ = np.moveaxis(self.drive.contact_region.point(*self.generated(s, age)), -1, 0)
        return np.hypot(x, y), np.arctan2(x, -y)


def _apart(edges: FloatArray) -> FloatArray:
    """Ascending edges without those next to others, in whose time an end does nothing; the first and the last stay."""
    kept = [float(edges[0])]
    for edge in edges[1:-1].tolist():
        if edge - kept[-1] > _SHORTEST and edges[-1] - edge > _SHORTEST:
            kept.append(edge)
    return np.array([*kept, float(edges[-1])])


def _graded(edges: FloatArray) -> FloatArray:
    """Instants that come near each edge from both sides, each distance an eighth of the one before."""
    widths = np.diff(edges)
    steps = 0.45 / _GRADING ** np.arange(round(math.log(1.0 / _SHORTEST, _GRADING)))
    away = widths[:, np.newaxis] * steps
    found = np.stack([edges[:-1, np.newaxis] + away, edges[1:, np.newaxis] - away])
    return np.asarray(found[:, away > _SHORTEST].ravel())
