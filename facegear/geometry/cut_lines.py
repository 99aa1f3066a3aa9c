"""What the shaper takes of contact lines, where it cuts into the flank once more.

Between shafts at more than 90° its tip comes back to the flank that it has generated (:mod:`facegear.geometry.recut`).
The lower end of a line then lies where that cut ends, or nothing of the line is left.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from facegear.geometry.generated_flank import GeneratedFlank
from facegear.support.roots import crossing, root
from facegear.support.types import FloatArray

# Contact lines that are held against the shaper to find where it cuts; pieces into which a search divides an interval,
# and how short that may be in the end [rad].
_LINES, _SECTIONS, _SAME = 48, 17, 1e-11
# How near to where the cut begins or takes all a line is looked at too, over the sweep.
_BESIDE = 1e-6


@dataclass(frozen=True, eq=False)
class Cut:
    """What the shaper takes of the contact lines.

    Parameters
    ----------
    exit : float
        C of the last contact that is left [rad].
    lines : ndarray, shape (n,)
        C of lines that were looked at, ascending [rad].
    shortened : ndarray of bool, shape (n,)
        Which of them lose their lower end.
    """

    exit: float
    lines: FloatArray
    shortened: NDArray[np.bool_]

    def may_shorten(self, c: FloatArray) -> NDArray[np.bool_]:
        """Which lines lie below one that is shortened, or next above it."""
        last = int(np.flatnonzero(self.shortened)[-1]) + 1 if np.any(self.shortened) else -1
        bound = -math.inf if last < 0 else math.inf if last == self.lines.size else self.lines[last]
        return np.asarray(c < bound)


@dataclass(frozen=True)
class CutLines:
    """Contact lines that the shaper shortens or takes away.

    Parameters
    ----------
    flank : GeneratedFlank
        Before it does.
    """

    flank: GeneratedFlank

    def gone(self, c: FloatArray) -> NDArray[np.bool_]:
        """Which contact lines the shaper has taken away whole."""
        _, upper = self.flank.generated_ends(c)
        return np.asarray(self.flank.shaper.clearance(upper, upper - c) < 0.0)

    @cached_property
    def found(self) -> Cut:
        """Which contact lines the shaper shortens, and which it takes away.

        Between shafts at up to 90° none: see `Drive.tip_undercut` for the trace that is neglected there.
        """
        if self.flank.shaft_angle <= 0.5 * math.pi:
            return Cut(self.flank.generated_exit, np.empty(0), np.empty(0, dtype=bool))
        c = np.append(
            np.linspace(self.flank.generated_exit, self.flank.entry, _LINES + 1)[:-1], self.flank.first_line
        )
        lower, _ = self.flank.generated_ends(c)
        shortened = self.flank.shaper.clearance(lower, lower - c) < 0.0
        if not np.any(shortened):
            return Cut(self.flank.generated_exit, c, shortened)
        gone = self.gone(c)
        if not np.any(gone):
            return Cut(self.flank.generated_exit, c, shortened)
        k = int(np.flatnonzero(gone)[-1])
        return Cut(root(lambda x: self._clear(x, end=1), c[k], c[k + 1]), c, shortened)

    @cached_property
    def kinks(self) -> tuple[float, ...]:
        """C at which the shaper begins or ceases to shorten lines, or another part of it does so [rad]."""
        return (*(c for c, _ in self._begins), *self.corners)

    @cached_property
    def _begins(self) -> tuple[tuple[float, float], ...]:
        """C at which the shaper begins or ceases to shorten lines [rad], and on which side of it it does, 1 or -1."""
        c, shortened = self.found.lines, self.found.shortened
        return tuple(
            (root(lambda x: self._clear(x, end=0), c[k], c[k + 1]), 1.0 if shortened[k + 1] else -1.0)
            for k in np.flatnonzero(shortened[:-1] != shortened[1:])
        )

    @cached_property
    def _affected(self) -> tuple[FloatArray, FloatArray, NDArray[np.int64], FloatArray]:
        """Shortened lines that were looked at, c ascending, with what `_cutting_parts` has of them.

        Where the cut begins, and where nothing is left, another part of the shaper may have taken over before the next
        of the lines looked at: one right beside it tells.
        """
        near = _BESIDE * self.flank.generated_sweep
        affected = self.found.lines[self.found.shortened & (self.found.lines > self.found.exit)]
        beside = [c + way * near for c, way in self._begins if c + way * near > self.found.exit]
        if affected.size and self.found.exit > self.flank.generated_exit:
            beside.append(self.found.exit + near)
        lines = np.unique(np.append(affected, beside)) if affected.size else affected
        return lines, *self._cutting_parts(lines)

    @cached_property
    def corners(self) -> tuple[float, ...]:
        """C at which another part of the shaper takes over, ascending [rad]."""
        c, starts, parts, turns = self._affected
        changes = []
        for k in np.flatnonzero(np.diff(parts)):
            both = int(parts[k]), int(parts[k + 1])
            corner = self.flank.shaper.corner(float(starts[k]), float(c[k]), float(turns[k]), both)
            inside = c[k] < corner < c[k + 1]
            changes.append(corner if inside else self._change(float(c[k]), float(c[k + 1])))
        return tuple(changes)

    def starts(self, lower: FloatArray, upper: FloatArray, c: FloatArray) -> FloatArray:
        """Where lines begin that may be shortened: followed from the nearest line that was looked at [rad]."""
        known, starts, parts, turns = self._affected
        start = np.full(c.shape, np.nan)
        if known.size:
            # Not past a corner, beyond which another part of the shaper ends the cut.
            nearest = np.abs(c[:, None] - known)
            corners = np.array(self.corners)
            apart = np.searchsorted(corners, c)[:, None] != np.searchsorted(corners, known)
            k = np.argmin(np.where(apart, np.inf, nearest), axis=1)
            start = self.flank.shaper.edge(c, starts[k], turns[k], parts[k])
        # Where there is nothing to start from, where that fails, or where the end is not cut: by search.
        search = ~((start > lower) & (start < upper))
        start[search] = self.uncut(lower[search], upper[search], c[search])
        return start

    def leaves_lower_end(self, c: float) -> bool:
        """Whether the lower end of a line on the flank as (3-8) leaves it is there in the end."""
        return not self.found.may_shorten(np.asarray(c)) or self._clear(c, end=0) >= 0.0

    def _clear(self, c: float, end: int) -> float:
        """Clearance of the lower (0) or upper (1) end of one contact line on the flank as (3-8) leaves it [rad]."""
        alpha = self.flank.generated_ends(c)[end]
        return float(self.flank.shaper.clearance(alpha, alpha - c))

    def _cutting_parts(self, c: FloatArray) -> tuple[FloatArray, NDArray[np.int64], FloatArray]:
        """Lower ends of shortened lines, which part of the shaper leaves them there, and at what δ [rad]."""
        lower, upper = self.flank.generated_ends(c)
        start = self.uncut(lower, upper, c)
        return start, *self.flank.shaper.cut_by(start, start - c)

    def _change(self, c_1: float, c_2: float) -> float:
        """C between two lines at which another part of the shaper takes over at another instant [rad]."""
        before = self._cutting_parts(np.array([c_1]))[1][0]
        while c_2 - c_1 > _SAME:
            c = np.linspace(c_1, c_2, _SECTIONS)
            same = int(np.argmax(self._cutting_parts(c)[1] != before))
            c_1, c_2 = float(c[same - 1]), float(c[same])
        return c_2

    def uncut(self, lower: FloatArray, upper: FloatArray, c: FloatArray) -> FloatArray:
        """Where lines begin that the shaper has shortened: it takes the lower end of a line, if any."""

        def clearance(alpha: FloatArray, line: FloatArray) -> FloatArray:
            return self.flank.shaper.clearance(alpha, alpha - line)

        return crossing(clearance, lower, upper, c)

    def usable_radii(self, roll: float) -> tuple[float, float]:
        """Least and greatest −y_p of the flank that is left on a profile point [m]; NaN where nothing is."""

        def room(alpha: ArrayLike) -> Any:
            below_top = self.flank.depth(alpha, roll) / self.flank.tooth_top_distance - 1.0
            if self.flank.shaft_angle <= 0.5 * math.pi:
                return below_top
            return np.minimum(below_top, self.flank.shaper.clearance(alpha, roll))

        inner, outer = (
            self.flank.edge_angle(radius, roll)
            for radius in (self.flank.flank_start, self.flank.outer_radius)
        )
        alpha = np.linspace(inner, outer, _LINES)
        free = np.flatnonzero(room(alpha) >= 0.0)
        if not free.size:
            return math.nan, math.nan
        first, last = int(free[0]), int(free[-1])
        inner = inner if first == 0 else root(lambda x: float(room(x)), alpha[first - 1], alpha[first])
        outer = (
            alpha[-1] if last == _LINES - 1 else root(lambda x: float(room(x)), alpha[last], alpha[last + 1])
        )
        return float(self.flank.radial_position(inner, roll)), float(self.flank.radial_position(outer, roll))
