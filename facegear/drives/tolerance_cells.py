"""Search in a box of stiffness and damping, by cells.

Values of stiffness are not drawn. Their box is divided into cells, and tongues are traced at the corners of each, for
both ends of every damping. Natural frequencies rise with every stiffness, and so a tongue that stands at all corners of
a cell has swept all speeds between. A tongue can also stand at some corners only, or inside the cell alone, where a
resonance is better tuned. So where no tongue has been seen a drive with half the damping is looked at as well, at each
corner: what could open nearby stands there already, and where it does the cell is halved until it is small. What cannot
be told then is left open.
Tongues are looked for in a wider range of speed, wide enough that none can come into the range from outside unseen.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import combinations, count, product
from typing import Any

from facegear.drives.basis import traced
from facegear.drives.intervals import Intervals, cut, gaps, united
from facegear.maps.tracing import Tongue, search_seconds

# Ratio of the largest and the smallest stiffness of a cell above which it is halved in any case.
_COARSE = 1.25
# Change of the contact ratio c above which a cell is halved in any case: that of a contact under load depends on the
# teeth, and harmonics of what comes and goes with a pair go like sin nπc. Between places so close together even the
# one with n = 13 is at most twice as strong as at the nearer of them, or nowhere strong.
_SAME_RATIO = 0.05
FINE = 1.025
"""Ratio of the largest and the smallest stiffness of a cell that is not halved any more."""

# Where two resonances share a mode their strengths add: two of the first kind that may meet inside a fine cell count as
# one of the second.
HALF, MOST = 0.5, 0.8
"""Parts of the damping with which what could open inside a cell stands at a corner: of any cell, so that the strength
of a resonance may double from there, and of a fine one."""

# Work spent on halves of what is coarse no more, as `search_seconds` has it: alike on every machine.
_SECONDS = 12.0
# Part by which the search goes beyond the speeds from which tongues can come, for what of a frequency no spring makes.
_MARGIN = 1.02

Factors = tuple[float, ...]
Range = tuple[float, float]


@dataclass(frozen=True)
class Cell:
    """Part of a box: lower and upper factors of each stiffness, and the speeds at which it is looked at [rad/s]."""

    lower: Factors
    upper: Factors
    speeds: Range

    @property
    def reach(self) -> float:
        """Ratio by which natural frequencies can differ at most: the root of that of the stiffness."""
        return math.sqrt(self._ratio)

    @property
    def _ratio(self) -> float:
        return max(high / low for low, high in self.edges)

    @property
    def is_fine(self) -> bool:
        """Whether it is not halved any more."""
        return self._ratio < FINE

    @property
    def around(self) -> Range:
        """Speeds from which a tongue can come into those of the cell."""
        wider = 1.0 if self.lower == self.upper else _MARGIN * self.reach
        return self.speeds[0] / wider, self.speeds[1] * wider

    @property
    def corners(self) -> list[Factors]:
        """Factors at the corners."""
        return list(product(*(sorted({*ends}) for ends in self.edges)))

    @property
    def edges(self) -> list[Range]:
        """Lower and upper factor of each stiffness."""
        return list(zip(self.lower, self.upper, strict=True))

    @property
    def longest(self) -> int:
        """Number of the edge with the largest ratio."""
        return max(range(len(self.edges)), key=lambda place: self.edges[place][1] / self.edges[place][0])

    def halves(self, place: int) -> tuple[Cell, Cell]:
        """Both halves along an edge: at the value of the file, where that is inside."""
        low, high = self.edges[place]
        middle = 1.0 if low < 1.0 < high else math.sqrt(low * high)
        upper, lower = (
            tuple(middle if number == place else value for number, value in enumerate(corner))
            for corner in (self.upper, self.lower)
        )
        return replace(self, upper=upper), replace(self, lower=lower)

    def reached(self, tongue: Tongue) -> Range:
        """Where a tongue of a corner can come inside the cell."""
        return tongue.lower / self.reach, tongue.upper * self.reach


@dataclass(frozen=True)
class _Corner:
    """What stands in a range of speed at one value of each stiffness.

    Tongues by the factors of stiffness and damping, one for each corner of the dampings, and of these the ones with the
    least damping.
    """

    springs: Factors
    around: Range
    found: dict[Factors, tuple[Tongue, ...]]
    least: tuple[Tongue, ...]


@dataclass(frozen=True)
class _Judged:
    """What corners tell of a cell: intervals of speed [rad/s] that are swept, and that tongues of some may reach."""

    swept: list[Range]
    open: list[Range]


@dataclass
class BoxSearch:
    """Search for tongues anywhere in a box.

    Parameters
    ----------
    model : Model
        With a field NAME_factor for each part, and a `contact_ratio`.
    parts : mapping of str to float
        How far each may be from 1 to both sides, by its name in words, which ends in "stiffness" or "damping".
    wide : tuple of float
        Range of speed [rad/s].

    Attributes
    ----------
    points : dict of tuple of float to tuple of Tongue
        Tongues by factors, in the order of `parts`, the values of the file first: where there are none, only if the
        whole range was looked at.
    looked_at : dict of tuple of float to tuple of tuple of float
        Intervals of speed [rad/s] that were looked at with the factors of `points`, ascending and apart.
    swept, possible : list of tuple of float
        Intervals of speed [rad/s], in no order, with some value that is unstable, and in which there may be one.
    """

    model: Any
    parts: Mapping[str, float]
    wide: Range
    points: dict[Factors, tuple[Tongue, ...]] = field(default_factory=dict)
    looked_at: dict[Factors, Intervals] = field(default_factory=dict)
    swept: list[Range] = field(default_factory=list)
    possible: list[Range] = field(default_factory=list)
    _seconds: float = 0.0
    _corners: dict[Factors, list[_Corner]] = field(default_factory=dict)
    _weakly: dict[tuple[Factors, float], list[tuple[Range, tuple[Tongue, ...]]]] = field(default_factory=dict)
    _traced: dict[Factors, tuple[Range, tuple[Tongue, ...]]] = field(default_factory=dict)

    def run(self) -> None:
        """Look at cells until all is settled, or no more work is allowed."""
        cells = self._cells()
        # What cells share is looked at once, over the speeds that any of them asks for.
        widest = min(cell.around[0] for cell in cells), max(cell.around[1] for cell in cells)
        nominal = (1.0,) * len(self.parts)
        own = self.points[nominal] = self._tongues(nominal, widest)
        self.looked_at[nominal] = (self.wide,)
        self.swept += [(tongue.lower, tongue.upper) for tongue in own]
        self.possible += self.swept
        shared = [
            self._corner(springs, widest)
            for springs in sorted({corner for cell in cells for corner in cell.corners})
        ]
        judged = [self._sweep(cell) for cell in cells]
        if unswept := [around for cell in cells if (around := self._unswept(cell)) is not None]:
            lowest, highest = min(low for low, _ in unswept), max(high for _, high in unswept)
            for corner in shared:
                self._weak(corner, (lowest, highest), HALF)
        finer = [half for cell, told in zip(cells, judged, strict=True) for half in self._halves(cell, told)]
        self._seconds = 0.0
        # The largest first: what is left at the end is small.
        number = count()
        queue = [(-cell.reach, next(number), cell) for cell in finer]
        heapq.heapify(queue)
        while queue and self._seconds + self._needed(queue[0][-1]) < _SECONDS:
            *_, cell = heapq.heappop(queue)
            for half in () if self._is_known(cell) else self._halves(cell, self._sweep(cell)):
                heapq.heappush(queue, (-half.reach, next(number), half))
        self.possible += [cell.speeds for *_, cell in queue]

    def _needed(self, cell: Cell) -> float:
        """Seconds that a cell may take, none of whose corners has been looked at."""
        dampings = math.prod(2 if part else 1 for words, part in self.parts.items() if is_damping(words))
        return len(cell.corners) * (dampings + 1) * search_seconds(self.model, cell.around)

    def _cells(self) -> list[Cell]:
        """Divide the box into cells that are as large as may be."""
        cells, left = [], [Cell(*self._ends(is_stiffness), self.wide)]
        while left:
            cell = left.pop()
            if (place := self._too_long(cell)) is None:
                cells.append(cell)
            else:
                left += cell.halves(place)
        return cells

    def _too_long(self, cell: Cell) -> int | None:
        """Tell which edge of a cell is too long: by its ratio, with the file's value inside, or by what it changes."""
        for place, (low, high) in enumerate(cell.edges):
            if low < 1.0 < high:
                return place
        low, high = cell.edges[cell.longest]
        if high / low > _COARSE:
            return cell.longest
        if cell.is_fine:
            return None
        ratio = self._contact_ratio(cell.lower)
        for place, (_, high) in enumerate(cell.edges):
            there = (*cell.lower[:place], high, *cell.lower[place + 1 :])
            if abs(self._contact_ratio(there) - ratio) > _SAME_RATIO:
                return place
        return None

    def _contact_ratio(self, springs: Factors) -> float:
        """Mesh periods that a tooth pair stays in mesh, at some factors of stiffness."""
        low, _ = self._ends(is_damping)
        return float(self.at(self._factors(springs, low)).contact_ratio)

    def _is_known(self, cell: Cell) -> bool:
        """Whether all speeds of a cell are swept, and it is known how fast something grows at some of them."""
        return not gaps(united(self.swept), cell.speeds) and any(
            _stands(tongue, cell.speeds) for found in self.points.values() for tongue in found
        )

    def _halves(self, cell: Cell, judged: _Judged) -> list[Cell]:
        """Keep what may stand in a cell that has been swept, and return halves where they could tell more."""
        unsettled, corners = list(judged.open), self._at(cell)
        # What stands with half the damping alone is asked only where nothing stands in any case.
        if (around := self._unswept(cell)) is not None:
            weak = [self._weak(corner, around, HALF) for corner in corners]
            unsettled += (
                self._left(cell, around, corners, weak)
                if cell.is_fine
                else [cell.reached(tongue) for each in weak for tongue in each]
            )
        if cell.is_fine:
            self.possible += unsettled
            return []
        return [
            half
            for speeds in cut(united(unsettled), cell.speeds)
            for half in replace(cell, speeds=speeds).halves(cell.longest)
        ]

    def _at(self, cell: Cell) -> list[_Corner]:
        """Look at all corners of a cell."""
        return [self._corner(springs, cell.around) for springs in cell.corners]

    def _sweep(self, cell: Cell) -> _Judged:
        """Keep what tongues at the corners of a cell have swept."""
        judged = _judged(cell, self._at(cell))
        self.swept += judged.swept
        self.possible += judged.swept
        return judged

    def _unswept(self, cell: Cell) -> Range | None:
        """Speeds from which a tongue can come into those of a cell that nothing has swept; None if all are swept."""
        left = gaps(united(self.swept), cell.speeds)
        if not left or cell.reach == 1.0:
            return None
        return replace(cell, speeds=(left[0][0], left[-1][1])).around

    def _left(
        self, cell: Cell, around: Range, corners: Sequence[_Corner], weak: Sequence[Sequence[Tongue]]
    ) -> list[Range]:
        """Where something may open inside a fine cell that stands at its corners with half the damping alone."""
        found: list[Range] = []
        for corner, each in zip(corners, weak, strict=True):
            if any(cut([cell.reached(tongue)], cell.speeds) for tongue in each):
                found += map(cell.reached, self._weak(corner, around, MOST))
        labels = {tongue.label for each in weak for tongue in each}
        places = _places(cell, [(*corner.least, *each) for corner, each in zip(corners, weak, strict=True)])
        for one, other in combinations(places, 2):
            if {one, other} & labels and len(united([places[one], places[other]])) == 1:
                found += [places[one], places[other]]
        return found

    def _corner(self, springs: Factors, around: Range) -> _Corner:
        """Look at a corner, if that has not been done."""
        seen = self._corners.setdefault(springs, [])
        for corner in seen:
            if _holds(corner.around, around):
                return corner
        low, high = self._ends(is_damping)
        dampings = product(*(sorted({*ends}) for ends in zip(low, high, strict=True)))
        found = {
            factors: self._tongues(factors, around)
            for factors in (self._factors(springs, each) for each in dampings)
        }
        corner = _Corner(springs, around, found, found[self._factors(springs, low)])
        seen.append(corner)
        for factors, here in found.items():
            self._keep(factors, here, around)
        return corner

    def _weak(self, corner: _Corner, around: Range, part: float) -> tuple[Tongue, ...]:
        """Tongues with a part of the least damping, without those that stand with all of it."""
        seen = self._weakly.setdefault((corner.springs, part), [])
        for known, found in seen:
            if _holds(known, around):
                return found
        low, _ = self._ends(is_damping)
        with_part = self._tongues(self._factors(corner.springs, tuple(part * each for each in low)), around)
        seen.append((around, _apart(with_part, corner.least)))
        return seen[-1][1]

    def _keep(self, factors: Factors, found: tuple[Tongue, ...], around: Range) -> None:
        """Keep tongues of some factors, of a part of the range such as it does not cut, and what was looked at."""
        parts = cut(united([*self.looked_at.get(factors, ()), around]), self.wide)
        if around[0] <= self.wide[0] and self.wide[1] <= around[1]:
            self.points[factors], self.looked_at[factors] = found, parts
        elif inner := tuple(t for t in found if around[0] < t.lower and t.upper < around[1]):
            known = self.points.get(factors, ())
            self.points[factors], self.looked_at[factors] = known + _apart(inner, known), parts

    def _ends(self, wanted: Callable[[str], bool]) -> tuple[Factors, Factors]:
        """Lower and upper ends of the factors of those parts."""
        parts = [part for words, part in self.parts.items() if wanted(words)]
        return tuple(1.0 - part for part in parts), tuple(1.0 + part for part in parts)

    def _factors(self, springs: Factors, dampers: Factors) -> Factors:
        """Put factors of stiffness and of damping into the order of the parts."""
        of_springs, of_dampers = iter(springs), iter(dampers)
        return tuple(next(of_springs if is_stiffness(words) else of_dampers) for words in self.parts)

    def at(self, factors: Factors) -> Any:
        """Return the model with some factors."""
        names = (f"{words.replace(' ', '_')}_factor" for words in self.parts)
        return replace(self.model, **dict(zip(names, factors, strict=True)))

    def _tongues(self, factors: Factors, around: Range) -> tuple[Tongue, ...]:
        """Trace tongues of one value."""
        if (known := self._traced.get(factors)) is not None and known[0] == around:
            return known[1]
        model = self.at(factors)
        self._seconds += search_seconds(model, around)
        found = traced(model, around)
        self._traced[factors] = around, found
        return found


def is_stiffness(words: str) -> bool:
    """Whether a part of a box is a stiffness."""
    return words.endswith("stiffness")


def is_damping(words: str) -> bool:
    """Whether a part of a box is a damping."""
    return not is_stiffness(words)


def _judged(cell: Cell, corners: Sequence[_Corner]) -> _Judged:
    """Say what tongues at the corners of a cell tell of its speeds."""
    found = _Judged([], [])
    for at_corners in zip(*(corner.found.values() for corner in corners), strict=True):
        everywhere = _everywhere(at_corners)
        for label, place in _places(cell, at_corners).items():
            if label in everywhere:
                found.swept.append(place)
            seen = any(_stands(t, cell.speeds) for each in at_corners for t in each if t.label == label)
            if label not in everywhere or not seen:
                # One that passes between the corners is halved, too: how fast it grows there is not known.
                found.open.append(place)
        found.swept.extend(
            (t.lower, t.upper) for each in at_corners for t in each if t.label not in everywhere
        )
    return found


def _holds(one: Range, other: Range) -> bool:
    """Whether a range has another one in it."""
    return one[0] <= other[0] and other[1] <= one[1]


def _stands(tongue: Tongue, speeds: Range) -> bool:
    """Whether a tongue stands at some of the speeds."""
    return tongue.lower < speeds[1] and speeds[0] < tongue.upper


def _apart(found: Sequence[Tongue], others: Sequence[Tongue]) -> tuple[Tongue, ...]:
    """Return those tongues that stand at no speed at which one of the others does."""
    return tuple(
        one for one in found if not any(_stands(one, (other.lower, other.upper)) for other in others)
    )


def _everywhere(at_corners: Sequence[Sequence[Tongue]]) -> set[str]:
    """Labels that stand at all corners."""
    return set.intersection(*({tongue.label for tongue in each} for each in at_corners))


def _places(cell: Cell, at_corners: Sequence[Sequence[Tongue]]) -> dict[str, Range]:
    """Where tongues of each label can be in a cell: between the corners, and beyond if they do not stand at all."""
    everywhere = _everywhere(at_corners)
    places: dict[str, Range] = {}
    for tongue in (tongue for each in at_corners for tongue in each):
        low, high = (tongue.lower, tongue.upper) if tongue.label in everywhere else cell.reached(tongue)
        known = places.get(tongue.label, (low, high))
        places[tongue.label] = min(low, known[0]), max(high, known[1])
    return places
