"""The mesh period of teeth under load: equilibrium at every instant, and when what is pressed changes.

All pairs in mesh have one approach δ, which follows from equilibrium with the torque. Between the instants at which
contact changes it is smooth, so that a series has it, and with it the stiffness, over the whole period. Instants are
told as the age of a pair, in mesh periods since its first line on both flanks.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.geometry.timed_pairs import merged
from facegear.mechanics.compliance import Compliance, Lines
from facegear.mechanics.slices import Slices
from facegear.support.roots import crossing
from facegear.support.types import FloatArray

# Instants of a mesh period that are looked at for changes of contact; how many times as many if a fit finds another.
_INSTANTS, _FINER = 64, 4
# The first and the last line have no length but by rounding: so near to them others are looked at [mesh periods].
_NEXT = 1e-10
# Relative error of series over a mesh period.
_TOLERANCE = 1e-12
# How short a piece must be, in mesh periods, before it may have more.
_SHORT = 1e-3


@dataclass(frozen=True, eq=False)
class MeshCycle:
    """Equilibrium of all pairs of teeth over a mesh period.

    Parameters
    ----------
    slices : Slices
        Gap and lines of the flanks.
    law : Compliance
        How teeth give way.
    force : float
        Of all pairs, along the normal [N].
    stiffness : float
        Of a pair pressed over the whole face [N/m]: a size, for the first guess and for the accuracy of series.
    """

    slices: Slices
    law: Compliance
    force: float
    stiffness: float

    def lines(self, ages: FloatArray) -> Lines:
        """Return the lines of pairs of an age; empty before the first line on both flanks, and after the last."""
        inner, outer = self.slices.ends(ages)
        beyond = (ages < 0.0) | (ages > self.slices.sweep)
        return Lines(np.where(beyond, 0.0, inner), np.where(beyond, 0.0, outer), ages)

    def all_pairs(self, instants: FloatArray) -> FloatArray:
        """Ages since the first line of all pairs that may be in mesh, shape (K,) + S."""
        return ages_of_pairs(instants, self.slices.sweep)

    def _total(self, approach: FloatArray, ages: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Force [N] and stiffness [N/m] of all pairs when one of them has an age."""
        force, stiffness = self.law.force(approach, self.lines(self.all_pairs(ages)))
        return force.sum(axis=0), stiffness.sum(axis=0)

    @cached_property
    def _coarse(self) -> FloatArray:
        """Approach at equally spaced instants of the period [m]."""
        most = max(float(np.abs(end).max()) for end in self.slices.ends(self.slices.breakpoints)) ** 2
        above = most + self.force / self.stiffness
        return self._approach_from(np.full(_INSTANTS, above), np.arange(_INSTANTS) / _INSTANTS)

    def approach(self, ages: FloatArray) -> FloatArray:
        """Find the approach δ when a pair has an age [m]."""
        return self._approach_from(self._near(ages), ages)

    def settled(self, ages: FloatArray) -> FloatArray:
        """Find the same from the series over the period, by one step of Newton's rule [m]."""
        first, _, series = self._mesh
        return self._approach_from(series(ages - first)[..., 0], ages)

    def _near(self, ages: FloatArray) -> FloatArray:
        """Approach from its neighbours in time [m]."""
        return np.interp(ages, np.arange(_INSTANTS) / _INSTANTS, self._coarse, period=1.0)

    def _approach_from(self, approach: FloatArray, ages: FloatArray) -> FloatArray:
        """Approach δ from a value that is near [m]."""
        return self.law.equilibrium(self.force, approach, self.lines(self.all_pairs(ages)))

    def _events(self, instants: int) -> FloatArray:
        """Ages at which what is pressed, or how it is, changes [mesh periods since the first line], ascending."""
        phases = np.arange(instants) / instants
        count = math.floor(self.slices.sweep * instants)
        grid = np.append(np.arange(count + 1) / instants, self.slices.sweep)
        approach = self.approach(np.append(phases, self.slices.sweep))
        reach = np.sqrt(np.append(np.resize(approach[:-1], count + 1), approach[-1]))
        grid = np.clip(grid, _NEXT, self.slices.sweep - _NEXT)
        lines = self.lines(grid)
        return np.sort(
            np.concatenate([self._passages(grid, lines, reach), self._turns(grid, lines, reach**2)])
        )

    def _passages(self, grid: FloatArray, lines: Lines, reach: FloatArray) -> FloatArray:
        """Ages at which an end of a line passes a multiple of √δ, between those of a grid."""
        events = self.law.events
        signs = np.sign(np.stack([lines[end] - level * reach for end, level in events]))
        which, where = np.nonzero(signs[:, :-1] * signs[:, 1:] < 0.0)
        if not which.size:
            return np.empty(0)
        chosen = np.array(events, dtype=float)[which]

        def beyond(age: FloatArray, end: FloatArray, level: FloatArray, rising: FloatArray) -> FloatArray:
            """Of one sign with how far an end is beyond the approach, which need not be found for that."""
            lines = self.lines(age)
            s = np.where(end == 1.0, lines.outer, lines.inner)
            excess = self._total(s**2, age)[0] / self.force - 1.0
            return np.asarray(
                rising * np.where(level == 0.0, s, level * np.where(level * s > 0.0, excess, -1.0))
            )

        return crossing(beyond, grid[where], grid[where + 1], *chosen.T, signs[which, where + 1])

    def _turns(self, grid: FloatArray, lines: Lines, approach: FloatArray) -> FloatArray:
        """Ages at which a reserve of the law changes its sign, between those of a grid."""
        signs = np.sign(self.law.reserves(approach, lines))
        which, where = np.nonzero(signs[:, :-1] * signs[:, 1:] < 0.0)
        if not which.size:
            return np.empty(0)

        def reserve(age: FloatArray, number: FloatArray, rising: FloatArray) -> FloatArray:
            reserves = self.law.reserves(self.approach(age), self.lines(age))
            return np.asarray(rising * reserves[number.astype(int), np.arange(age.size)])

        return crossing(reserve, grid[where], grid[where + 1], which.astype(float), signs[which, where + 1])

    @property
    def first(self) -> float:
        """Age at which a pair begins to be pressed."""
        return self._mesh[0]

    @property
    def last(self) -> float:
        """Age at which a pair ends to be pressed."""
        return self._mesh[1]

    @property
    def series(self) -> PiecewiseChebyshev:
        """Approach [m] and stiffness of all pairs [N/m] against t/T0, from 0 where a pair begins to be pressed."""
        return self._mesh[2]

    @cached_property
    def _mesh(self) -> tuple[float, float, PiecewiseChebyshev]:
        """First, last and series: as many instants are looked at as it takes to fit the series."""
        failure: ValueError | None = None
        for finer in (1, _FINER, _FINER**2):
            ages = np.unique(np.concatenate([[0.0], self._events(finer * _INSTANTS), [self.slices.sweep]]))
            middles = 0.5 * (ages[:-1] + ages[1:])
            force, _ = self.law.force(self.approach(middles), self.lines(middles))
            pressed = np.flatnonzero(force > 0.0)
            first, last = float(ages[pressed[0]]), float(ages[pressed[-1] + 1])
            changes = np.concatenate([ages, self.slices.breakpoints]) - first
            try:
                return first, last, self._fit(first, merged([*changes.tolist(), last - first]))
            except ValueError as error:
                failure = error
        raise ArithmeticError(f"contact changes at instants that were not found: {failure}")

    def _fit(self, first: float, breakpoints: tuple[float, ...]) -> PiecewiseChebyshev:
        """Approach [m] and stiffness of all pairs [N/m] against t/T0."""
        # Both to one size, so that a fit resolves both.
        units = np.array([self.force / self.stiffness, self.stiffness])

        def values(fractions: FloatArray, pieces: NDArray[np.intp]) -> FloatArray:
            instants = fractions + first
            lines = self.lines(self.all_pairs(instants))
            balanced = self.law.balanced(self.force, self._near(instants), lines)
            return np.asarray(np.stack(balanced, axis=-1) / units)

        tolerances = fit_tolerances(breakpoints)
        return PiecewiseChebyshev.fit_together(values, breakpoints, tolerance=tolerances).transformed(
            np.diag(units)
        )


def ages_of_pairs(instants: FloatArray, longest: float) -> FloatArray:
    """Count the mesh periods since each pair that there may be began, (P,) + S, if one lasts for `longest`."""
    start = instants - np.floor(instants)
    return np.stack([start + k for k in range(math.ceil(longest))])


def fit_tolerances(breakpoints: tuple[float, ...]) -> FloatArray:
    """Relative errors that fits on pieces of a mesh period may have: on short ones they count by the duration."""
    return np.asarray(_TOLERANCE * np.maximum(1.0, _SHORT / np.diff(breakpoints, append=1.0)))
