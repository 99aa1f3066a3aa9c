"""Cells of a map one by one, many at once: small systems of which speed changes nothing but the period.

Their Taylor series in lockstep (:mod:`facegear.floquet.taylor`) take little time, and are interpolated along the period
where that takes fewer of them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from facegear.floquet.columns import LOWEST_DEGREE, LoadSweep, agree, of_one_size, resolved
from facegear.floquet.eigenvalues import spectral_radii
from facegear.floquet.error_estimates import shift_by_rounding
from facegear.floquet.free_modes import UnsuitableSystemError
from facegear.floquet.load_columns import LoadColumn
from facegear.floquet.methods import FIRST
from facegear.floquet.models import Model, system_at
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.series import ChebyshevSeries, chebyshev_basis, lobatto_coefficients
from facegear.floquet.sheets import SHEET_TOLERANCE
from facegear.floquet.stepping import Family
from facegear.floquet.taylor import Taylor
from facegear.maps.likeness import (
    load_parameters_of,
    same_but_load_parameters,
    same_but_period,
    same_layout,
)
from facegear.maps.parallel import parts_of
from facegear.support.types import FloatArray

# Cells that are computed, and kept on disk, together.
_CELLS = 2**16
# Degree of a series along the period, besides half the angle that motions turn more by at its end.
_DEGREE = 20
_METHOD = Taylor()


@dataclass(frozen=True, eq=False)
class _Chunk:
    """Cells of neighbouring values at all speeds.

    Attributes
    ----------
    systems : tuple of PeriodicSystem
        One a value.
    turns : ndarray, shape (S,)
        Periods at the speeds over those of the systems.
    """

    systems: tuple[PeriodicSystem, ...]
    turns: FloatArray

    def content(self) -> Iterator[Any]:
        """Everything the result depends on."""
        yield from (repr(_METHOD), self.turns)
        for system in self.systems:
            yield from parts_of(system)

    def compute(self) -> FloatArray:
        """Spectral radii, shape (V, S), NaN in rows of systems for which Taylor series are not."""
        try:
            found = self._matrices()
        except UnsuitableSystemError:
            # One of them may be to blame, or that they are not of one mass: halves of them may do still.
            systems, count = self.systems, len(self.systems)
            ends = () if count <= 3 else (systems[0], systems[count // 2], systems[-1])
            if count == 1 or (ends and np.isnan(replace(self, systems=ends).compute()).all()):
                return np.full((count, self.turns.size), np.nan)
            halves = systems[: count // 2], systems[count // 2 :]
            return np.concatenate([replace(self, systems=half).compute() for half in halves])
        return spectral_radii(found.reshape(-1, *found.shape[2:])).reshape(found.shape[:2]).T

    def _matrices(self) -> FloatArray:
        """Transition matrices, (S, V, 2n, 2n): along the period, in which they are entire, as few as a series takes."""
        turns = self.turns
        family, of_all = self._members()

        def evaluate(some: FloatArray) -> FloatArray:
            found = _METHOD.over(family, some)
            return (of_all @ found.reshape(len(found), -1)).reshape(-1, *found.shape[1:]).swapaxes(0, 1)

        degree = _DEGREE + int(0.5 * family.exponent_norm * np.ptp(turns))
        series = resolved(evaluate, turns, SHEET_TOLERANCE, degree)
        found = evaluate(turns) if series is None else series(turns)
        if series is None and len(of_all) == len(family.systems):
            return found
        # Where a series is belied first: between its points, and where motions grow most.
        size = np.abs(found).max(axis=(2, 3))
        when, which = (
            np.unique([largest, *(0.382 * count * np.array([1.0, 2.0])).astype(int)])
            for count, largest in zip(size.shape, np.unravel_index(size.argmax(), size.shape), strict=True)
        )
        own = Family([self.systems[number] for number in which.tolist()])
        back = family.scale @ own.inverse_scale
        expected = back @ _METHOD.over(own, turns[when]).swapaxes(0, 1) @ np.linalg.inv(back)
        if agree(found[np.ix_(when, which)], expected):
            return found
        return _METHOD.over(Family(self.systems), turns).swapaxes(0, 1)

    def _members(self) -> tuple[Family, FloatArray]:
        """Systems of which matrices are computed, and what makes those of all of them, (V, members).

        Where only load parameters change, on a line, they are those at Chebyshev points of it.
        """
        systems, first = self.systems, self.systems[0]
        if len(systems) > 4 * LOWEST_DEGREE and all(same_but_load_parameters(first, own) for own in systems):
            parameters = np.array([load_parameters_of(own) for own in systems])
            swept = LoadSweep.of(first, LoadColumn(*parameters.transpose(1, 0, 2)))
            ends = float(swept.variable.min()), float(swept.variable.max())
            degree = LOWEST_DEGREE
            while swept.smooth and 4 * degree < len(systems):
                loads = swept.at(ChebyshevSeries.points_of(*ends, degree))
                each = zip(loads.mass, loads.damping, loads.stiffness, strict=True)
                family = Family([first.replace_loads(mass=m, damping=c, stiffness=k) for m, c, k in each])
                longest = _METHOD.over(family, self.turns[:1])[:, 0]
                if not of_one_size(longest):
                    break
                if ChebyshevSeries(*ends, longest).tail <= SHEET_TOLERANCE:
                    of_points = lobatto_coefficients(np.eye(degree + 1))
                    return family, chebyshev_basis(*ends, swept.variable, degree + 1) @ of_points
                degree *= 2
        return Family(systems), np.eye(len(systems))


@dataclass(frozen=True, eq=False)
class Cells:
    """All cells of a map.

    Attributes
    ----------
    systems : tuple of PeriodicSystem
        One a value, at the lowest speed.
    turns : ndarray, shape (S,)
        Periods over those at the lowest speed.
    """

    systems: tuple[PeriodicSystem, ...]
    turns: FloatArray

    @property
    def periods(self) -> FloatArray:
        """T0 [s], shape (V, S)."""
        return np.multiply.outer([system.period for system in self.systems], self.turns)

    def tasks(self) -> tuple[list[slice], list[_Chunk]]:
        """Group values, and prepare the cells of each group."""
        size = max(1, _CELLS // self.turns.size)
        places = [slice(start, start + size) for start in range(0, len(self.systems), size)]
        return places, [_Chunk(self.systems[place], self.turns) for place in places]

    def some(self, rows: NDArray[np.intp], columns: NDArray[np.intp]) -> Cells:
        """Return those of some values and speeds, by their numbers."""
        return Cells(tuple(self.systems[row] for row in rows.tolist()), self.turns[columns])

    def error_estimate(self, radii: FloatArray) -> float | None:
        """Largest difference from shorter steps, and what rounding does, corner cells and middle cell.

        None where there are too many shorter steps.
        """
        last, end = radii.shape[0] - 1, radii.shape[1] - 1
        places = sorted({(v, s) for v in (0, last) for s in (0, end)} | {(last // 2, end // 2)})
        systems = [
            replace(self.systems[v], period=self.systems[v].period * float(self.turns[s])) for v, s in places
        ]
        try:
            finer = _scaled(systems)
        except UnsuitableSystemError:  # not of one mass
            try:
                finer = np.concatenate([_scaled([system]) for system in systems])
            except UnsuitableSystemError:
                return None
        differences = np.abs(spectral_radii(finer) - np.array([radii[place] for place in places]))
        pairs = zip(systems, finer, strict=True)
        rounding = [shift_by_rounding(matrix, Family([system]), _METHOD) for system, matrix in pairs]
        return float((differences + rounding).max())


def _scaled(systems: Sequence[PeriodicSystem]) -> FloatArray:
    """Transition matrices by shorter steps, each in the scale of its own system."""
    family = Family(systems)
    found = family.inverse_scale @ _METHOD.refined().scaled_transition_matrices(family) @ family.scale
    own = [Family([system]) for system in systems]
    return np.stack([each.scale @ one @ each.inverse_scale for each, one in zip(own, found, strict=True)])


def cells_of(models: Sequence[Model], probes: Sequence[int], speeds: FloatArray) -> Cells | None:
    """Find whether a map is of such systems: from all values at the lowest speed, some of them at other speeds too.

    Parameters
    ----------
    models : sequence of Model
        One a value.
    probes : sequence of int
        Numbers of those that are looked at.
    speeds : ndarray, shape (S,)
        Ascending [rad/s].
    """
    slowest = float(speeds[0])
    for probe in probes:
        own = system_at(models[probe], slowest)
        # Larger ones go faster by collocation.
        if own.size >= FIRST.fewest_held:
            return None
        for speed in np.unique(speeds[[speeds.size // 2, -1]]).tolist():
            other = system_at(models[probe], speed)
            turned = abs(other.period * speed / slowest - own.period) <= 1e-12 * own.period
            if not turned or not same_but_period(own, other):
                return None
    systems = tuple(system_at(model, slowest) for model in models)
    if any(not same_layout(systems[0], system) for system in systems[1:]):
        return None
    return Cells(systems, slowest / speeds)
