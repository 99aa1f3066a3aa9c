"""Speeds looked at: the spectral radius at each, how it changes, and the motion whose multiplier is the largest."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from facegear.floquet.eigenvectors import Critical, critical
from facegear.floquet.multiplier_curves import MultiplierCurve
from facegear.support.types import ComplexArray, FloatArray

# Relative accuracy of borders and of the speed where two phases meet: far below 0.01 rpm.
SPEED_TOLERANCE = 1e-9


class Motion(NamedTuple):
    """Largest multiplier at a speed: its modulus, the slope of that as in a scan, and its eigenvectors, left r = 1."""

    speed: float
    radius: float
    slope: float
    left: ComplexArray
    right: ComplexArray

    def continues(self, other: Motion) -> bool:
        """Whether the critical motion is the same at another speed nearby."""
        return bool(np.abs((self.left @ other.right) * (other.left @ self.right)) > 0.5)


@dataclass(frozen=True, eq=False)
class Scan:
    """Speeds looked at, ascending.

    Attributes
    ----------
    speeds : array, shape (m,)
        [rad/s].
    radii : array, shape (m,)
        Spectral radius at each.
    slopes : array, shape (m,)
        Derivative of its logarithm by the slowness 1/speed, following the largest multiplier; NaN where it has none.
    left, right : complex array, shape (m, d)
        Eigenvectors of the largest multiplier, left r = 1.
    """

    speeds: FloatArray
    radii: FloatArray
    slopes: FloatArray
    left: ComplexArray
    right: ComplexArray

    @classmethod
    def of(cls, curve: MultiplierCurve, speeds: FloatArray) -> Scan:
        """Look at ascending speeds within the range of a curve."""
        parts = [
            cls._of_batch(curve, speeds[start : start + curve.batch])
            for start in range(0, max(speeds.size, 1), curve.batch)
        ]
        return cls.joined(parts)

    @classmethod
    def _of_batch(cls, curve: MultiplierCurve, speeds: FloatArray) -> Scan:
        found = critical(curve.transition_matrices(speeds))
        change_of_value = np.einsum(
            "vi,vij,vj->v", found.left, curve.slopes(speeds), found.right, optimize=True
        )
        with np.errstate(all="ignore"):
            slopes = (change_of_value / found.values).real
        return cls.of_critical(speeds, found, slopes)

    @classmethod
    def of_critical(cls, speeds: FloatArray, found: Critical, slopes: FloatArray) -> Scan:
        """Return the samples that largest multipliers at speeds are, with the slopes of their logarithms."""
        return cls(speeds, np.abs(found.values), slopes, found.left, found.right)

    @classmethod
    def joined(cls, scans: Sequence[Scan]) -> Scan:
        """Put the samples of scans one after the other, at least one scan."""
        return cls(
            *(np.concatenate(column) for column in zip(*(each._columns for each in scans), strict=True))
        )

    @property
    def _columns(self) -> tuple[NDArray[Any], ...]:
        return self.speeds, self.radii, self.slopes, self.left, self.right

    def some(self, chosen: slice | NDArray[Any]) -> Scan:
        """Return some of the samples."""
        return Scan(*(column[chosen] for column in self._columns))

    def motions(self) -> list[Motion]:
        """Return the critical motions, one by one."""
        numbers = (column.tolist() for column in (self.speeds, self.radii, self.slopes))
        return list(map(Motion, *numbers, self.left, self.right))

    def apart(self, part: float) -> Scan:
        """Leave out samples that are closer to the one before them than a part of their speed, but the largest."""
        close = np.append(False, np.diff(self.speeds) <= part * self.speeds[1:])
        close[np.argmax(self.radii)] = False
        return self.some(~close)

    def with_speeds(self, curve: MultiplierCurve, speeds: Sequence[float] | FloatArray) -> Scan:
        """Return the scan with more speeds; those already there are left out."""
        added = np.unique(np.asarray(speeds, dtype=float))
        added = np.setdiff1d(added[(added > curve.lowest_speed) & (added < curve.highest_speed)], self.speeds)
        return self.with_samples(Scan.of(curve, added))

    def with_samples(self, other: Scan) -> Scan:
        """Return the scan with those samples of another one that lie between its ends, each speed once."""
        inside = (other.speeds > self.speeds[0]) & (other.speeds < self.speeds[-1])
        both = Scan.joined([self, other.some(inside)])
        return both.some(np.unique(both.speeds, return_index=True)[1])
