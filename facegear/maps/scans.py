"""Speeds looked at: the spectral radius at each, how it changes, and the motion whose multiplier is the largest."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from facegear.floquet.eigenvectors import critical
from facegear.floquet.multiplier_curves import MultiplierCurve
from facegear.support.types import ComplexArray, FloatArray

# Relative accuracy of borders and of the speed where two phases meet: far below 0.01 rpm.
SPEED_TOLERANCE = 1e-9


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
    """

    speeds: FloatArray
    radii: FloatArray
    slopes: FloatArray

    @classmethod
    def of(cls, curve: MultiplierCurve, speeds: FloatArray) -> Scan:
        """Look at ascending speeds within the range of a curve."""
        return cls.of_motions(critical_motions(curve, speeds))

    @classmethod
    def of_motions(cls, motions: Sequence[Critical]) -> Scan:
        """Return the samples that critical motions are."""
        columns = zip(*((motion.speed, motion.radius, motion.slope) for motion in motions), strict=True)
        return cls(*(np.array(column) for column in columns)) if motions else cls(*np.zeros((3, 0)))

    def between(self, start: int, stop: int) -> Scan:
        """Return the samples with some numbers, the last of them `stop` − 1."""
        return Scan(self.speeds[start:stop], self.radii[start:stop], self.slopes[start:stop])

    def apart(self, part: float) -> Scan:
        """Leave out samples that are closer to the one before them than a part of their speed, but the largest."""
        close = np.append(False, np.diff(self.speeds) <= part * self.speeds[1:])
        close[np.argmax(self.radii)] = False
        return Scan(self.speeds[~close], self.radii[~close], self.slopes[~close])

    def with_speeds(self, curve: MultiplierCurve, speeds: Sequence[float] | FloatArray) -> Scan:
        """Return the scan with more speeds; those already there are left out."""
        added = np.unique(np.asarray(speeds, dtype=float))
        added = np.setdiff1d(added[(added > curve.lowest_speed) & (added < curve.highest_speed)], self.speeds)
        return self.with_samples(Scan.of(curve, added))

    def with_samples(self, other: Scan) -> Scan:
        """Return the scan with those samples of another one that lie between its ends, each speed once."""
        inside = (other.speeds > self.speeds[0]) & (other.speeds < self.speeds[-1])
        speeds, order = np.unique(np.append(self.speeds, other.speeds[inside]), return_index=True)
        radii, slopes = (
            np.append(own, more[inside])[order]
            for own, more in ((self.radii, other.radii), (self.slopes, other.slopes))
        )
        return Scan(speeds, radii, slopes)


class Critical(NamedTuple):
    """Largest multiplier at a speed: its modulus, the slope of that as in a scan, and its eigenvectors, left r = 1."""

    speed: float
    radius: float
    slope: float
    left: ComplexArray
    right: ComplexArray

    def continues(self, other: Critical) -> bool:
        """Whether the critical motion is the same at another speed nearby."""
        return bool(np.abs((self.left @ other.right) * (other.left @ self.right)) > 0.5)


def critical_motions(curve: MultiplierCurve, speeds: FloatArray) -> list[Critical]:
    """Critical motions at speeds (m,)."""
    found = []
    for start in range(0, speeds.size, curve.batch):
        part = speeds[start : start + curve.batch]
        values, right, left = critical(curve.transition_matrices(part))
        change_of_value = np.einsum("vi,vij,vj->v", left, curve.slopes(part), right, optimize=True)
        with np.errstate(all="ignore"):
            slopes = (change_of_value / values).real
        found += list(map(Critical, part.tolist(), np.abs(values).tolist(), slopes.tolist(), left, right))
    return found
