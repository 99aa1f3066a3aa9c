"""Sheets of a map: transition matrices as smooth functions of speed and of a swept parameter, interpolated along both.

Along speed the variable is the slowness 1/speed, as in :mod:`facegear.floquet.multiplier_curves`. At its Chebyshev
points the matrices are sampled along the parameter, as those of a column are; between them samples are interpolated.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from facegear.floquet.columns import Evaluate, of_one_size, resolvable, resolved
from facegear.floquet.multiplier_curves import FrozenMotions
from facegear.floquet.series import ChebyshevSeries, chebyshev_basis, lobatto_coefficients
from facegear.support.types import FloatArray

#: Size of the last Chebyshev coefficients along either axis, relative to the largest entry or 1.
SHEET_TOLERANCE = 1e-11
#: Fewer speeds than this are columns.
FEWEST_SPEEDS = 24
# Speeds that a sheet must have for each of its Chebyshev points: these crowd where speeds are slow, and cost most.
_SPEEDS_A_POINT = 1.5
# Places at which a sheet is tried to end.
_TRIALS = 16


def windows(motions: FrozenMotions, speeds: FloatArray) -> list[tuple[slice, int]]:
    """Parts of ascending speeds in each of which a sheet takes few columns, and its degree along slowness."""
    found: list[tuple[slice, int]] = []
    stop = speeds.size
    while stop >= FEWEST_SPEEDS:
        starts = np.unique(np.linspace(0, stop - FEWEST_SPEEDS, _TRIALS).astype(int)).tolist()
        degrees = [motions.degree(1.0 / speeds[stop - 1], 1.0 / speeds[start]) for start in starts]
        saved = [
            stop - start - _SPEEDS_A_POINT * (degree + 1)
            for start, degree in zip(starts, degrees, strict=True)
        ]
        best = int(np.argmax(saved))
        if saved[best] <= 0:
            break
        found.append((slice(starts[best], stop), degrees[best]))
        stop = starts[best]
    return found


def samples(evaluate: Evaluate, variable: FloatArray, smooth: bool, degree: int) -> FloatArray:
    """Matrices along a column, at Chebyshev points of its variable, or at all its values where it is not interpolated.

    The degree is the first that is tried.

    Returns
    -------
    array, shape (K + 1, d, d) or (V, d, d)
        Nothing, (0, d, d), where the column is not smooth enough for fewer matrices than values.
    """
    if not is_interpolated(variable, smooth):
        return evaluate(variable)
    series = resolved(evaluate, variable, SHEET_TOLERANCE, degree)
    return evaluate(variable[:1])[:0] if series is None else series.values


def is_interpolated(variable: FloatArray, smooth: bool) -> bool:
    """Whether :func:`samples` are those of a series."""
    return smooth and resolvable(variable)


@dataclass(frozen=True, eq=False)
class Sheet:
    """Transition matrices against slowness and the variable of a column.

    Attributes
    ----------
    along_speed : ChebyshevSeries
        Along slowness, its values Chebyshev coefficients along the variable, (K + 1, d, d), or matrices at all values.
    ends : tuple of float, optional
        Of the variable, between which matrices are interpolated.
    """

    along_speed: ChebyshevSeries
    ends: tuple[float, float] | None

    @classmethod
    def through(
        cls,
        low: float,
        high: float,
        columns: Sequence[FloatArray],
        ends: tuple[float, float] | None,
        tolerance: float,
    ) -> Sheet | None:
        """Interpolate :func:`samples` at the Chebyshev points between two values of slowness, if that is enough."""
        if any(column.size == 0 for column in columns):
            return None
        if ends is not None:
            most = max(len(column) for column in columns)
            series = [lobatto_coefficients(column) for column in columns]
            columns = [np.pad(part, ((0, most - len(part)), (0, 0), (0, 0))) for part in series]
        along_speed = ChebyshevSeries(low, high, np.stack(columns))
        smooth = along_speed.tail <= tolerance and of_one_size(np.abs(along_speed.values).max(axis=1))
        return cls(along_speed, ends) if smooth else None

    def matrices(self, speeds: FloatArray, variable: FloatArray) -> FloatArray:
        """Transition matrices at speeds (m,) [rad/s] and values (V,) of the variable, (m, V, d, d).

        The variable may be left to the samples, where `ends` is None.
        """
        found = self.along_speed(1.0 / speeds)
        if self.ends is None:
            return found
        basis = chebyshev_basis(*self.ends, variable, found.shape[1])
        return np.asarray(basis @ found.reshape(*found.shape[:2], -1)).reshape(
            speeds.size, variable.size, *found.shape[2:]
        )
