"""Cells of a map one by one, many at once: small systems of which speed changes nothing but the period.

Their Taylor series in lockstep (:mod:`facegear.floquet.taylor`) take little time, and are interpolated along the period
where that takes fewer of them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from facegear.floquet.columns import agree, resolved
from facegear.floquet.eigenvalues import spectral_radii
from facegear.floquet.models import Model, system_at
from facegear.floquet.multipliers import FIRST, shift_by_rounding
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.sheets import SHEET_TOLERANCE
from facegear.floquet.stepping import Family
from facegear.floquet.taylor import Taylor
from facegear.maps.likeness import same_but_period, same_layout
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
        """Spectral radii, shape (V, S)."""
        found = self._matrices()
        return spectral_radii(found.reshape(-1, *found.shape[2:])).reshape(found.shape[:2]).T

    def _matrices(self) -> FloatArray:
        """Transition matrices, (S, V, 2n, 2n): along the period, in which they are entire, as few as a series takes."""
        family, turns = Family(self.systems), self.turns

        def evaluate(some: FloatArray) -> FloatArray:
            return _METHOD.over(family, some).swapaxes(0, 1)

        degree = _DEGREE + int(0.5 * family.exponent_norm * np.ptp(turns))
        series = resolved(evaluate, turns, SHEET_TOLERANCE, degree)
        if series is None:
            return evaluate(turns)
        found = series(turns)
        # Where a series is belied first: between its points, and where motions grow most.
        size = np.abs(found).max(axis=(1, 2, 3))
        chosen = np.unique([int(size.argmax()), *((0.382 * turns.size * np.array([1.0, 2.0])).astype(int))])
        return found if agree(found[chosen], evaluate(turns[chosen])) else evaluate(turns)


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

    def error_estimate(self, radii: FloatArray) -> float:
        """Largest difference from shorter steps, and what rounding does, corner cells and middle cell."""
        last, end = radii.shape[0] - 1, radii.shape[1] - 1
        places = sorted({(v, s) for v in (0, last) for s in (0, end)} | {(last // 2, end // 2)})
        systems = [
            replace(self.systems[v], period=self.systems[v].period * float(self.turns[s])) for v, s in places
        ]
        family = Family(systems)
        finer = _METHOD.refined().scaled_transition_matrices(family)
        differences = np.abs(spectral_radii(finer) - np.array([radii[place] for place in places]))
        rounding = []
        for system, matrix in zip(systems, family.inverse_scale @ finer @ family.scale, strict=True):
            alone = Family([system])
            scaled = alone.scale @ matrix @ alone.inverse_scale
            rounding.append(shift_by_rounding(scaled, alone, _METHOD))
        return float((differences + rounding).max())


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
