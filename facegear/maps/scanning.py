"""Speeds at which to look for instability, found by following multipliers.

A multiplier leaves the unit circle where it meets another one there, or where the system is unstable by itself. So
multipliers are followed to where they meet (:mod:`facegear.maps.meetings`), and a tongue is found at its centre and not
by the step of a grid. Where the partner of a motion dies much faster, growth is largest beside the meeting: between
samples it is followed by its tangents.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from facegear.floquet.multiplier_curves import FrozenMotions, MultiplierCurve
from facegear.maps.meetings import meetings
from facegear.maps.scans import SPEED_TOLERANCE, Motion, Scan
from facegear.support.types import FloatArray

# Largest angle [rad] by which the fastest motion turns from one sample to the next that decays in a period by less than
# e⁻⁸: in a pair with it no other has been followed by then (`meetings`), as long as none grows a great deal.
_SAMPLE_ANGLE, _DECAY = 0.4, 8.0
_FEWEST_SAMPLES = 64
# Between unstable samples the growth may differ from a straight line by this part of itself.
_STRAIGHT = 0.25
_MOST_HALVINGS = 40


def scan_of(curve: MultiplierCurve, threshold: float, hints: Sequence[float]) -> Scan:
    """Spectral radii on a grid, at all meetings of multipliers that matter, and wherever growth may pass between."""
    low, high = 1.0 / curve.highest_speed, 1.0 / curve.lowest_speed
    grid = first_grid(curve.motions)
    seeds = np.concatenate([grid, [1.0 / speed for speed in hints if low < 1.0 / speed < high]])
    places, looked_at = meetings(curve, seeds, _steps(grid, seeds), threshold)
    scan = Scan.of(curve, np.array([curve.lowest_speed, curve.highest_speed])).with_samples(looked_at)
    scan = _rising(curve, scan.with_speeds(curve, 1.0 / places), threshold)
    return scan.with_samples(_gaps(curve, scan, threshold))


def first_grid(motions: FrozenMotions) -> FloatArray:
    """Slowness 1/speed at which all motions are looked at first [s/rad], ascending."""
    return motions.points(_SAMPLE_ANGLE, _FEWEST_SAMPLES, _DECAY)


def _steps(grid: FloatArray, points: FloatArray) -> FloatArray:
    """Distance of the points of a grid next to each point, the larger of both sides."""
    steps = np.diff(grid)
    right = np.searchsorted(grid, points, side="right").clip(1, steps.size) - 1
    left = np.searchsorted(grid, points, side="left").clip(1, steps.size) - 1
    return np.asarray(np.maximum(steps[left], steps[right]))


def _rising(curve: MultiplierCurve, scan: Scan, threshold: float) -> Scan:
    """Halve intervals in which growth may pass the threshold that has not at their stable end, until it is seen to.

    Where growth rises from a stable sample so that it could pass before the next one, it may fall again before that, or
    do so where another motion has taken over. Between samples that bends like an arch stays below its tangents.
    """
    for _ in range(_MOST_HALVINGS):
        height, slowness = np.log(scan.radii) - threshold, 1.0 / scan.speeds
        step = np.diff(slowness)
        ahead, back = height[:-1] + scan.slopes[:-1] * step, height[1:] - scan.slopes[1:] * step
        open_ = _may_pass(height[:-1], ahead, height[1:]) | _may_pass(height[1:], back, height[:-1])
        wide = np.abs(step) > SPEED_TOLERANCE * slowness[1:]
        middles = 2.0 / (slowness[:-1] + slowness[1:])[open_ & wide]
        if middles.size == 0:
            break
        scan = scan.with_samples(Scan.of(curve, middles))
    return scan


def _may_pass(here: FloatArray, foretold: FloatArray, there: FloatArray) -> NDArray[np.bool_]:
    """Whether growth is foretold to pass from one sample to another, and that is not just what it does there."""
    straight = (there > 0.0) & (np.abs(foretold - there) <= _STRAIGHT * there)
    return np.asarray((here < 0.0) & (foretold > 0.0) & ~straight)


def _gaps(curve: MultiplierCurve, scan: Scan, threshold: float) -> Scan:
    """Look between unstable samples for speeds that separate tongues which lie close together.

    Intervals between unstable samples are halved where no motion leads from one end to the other, or the growth is not
    near a straight line, until a stable speed is found or nothing is left to see.
    """
    unstable = scan.radii - 1.0 > threshold
    samples = dict(zip(np.flatnonzero(unstable).tolist(), scan.some(unstable).motions(), strict=True))
    intervals = [(samples[i], samples[i + 1]) for i in samples if i + 1 in samples]
    found = []
    for _ in range(_MOST_HALVINGS):
        intervals = [(a, b) for a, b in intervals if b.speed - a.speed > SPEED_TOLERANCE * b.speed]
        if not intervals:
            break
        found.append(Scan.of(curve, np.array([(a.speed + b.speed) / 2.0 for a, b in intervals])))
        halves = []
        for (a, b), middle in zip(intervals, found[-1].motions(), strict=True):
            left, between, right = (each.radius - 1.0 - threshold for each in (a, middle, b))
            if between > 0.0:
                curved = abs(between - (left + right) / 2.0) > _STRAIGHT * min(left, between, right)
                halves += [
                    (c, d) for c, d in ((a, middle), (middle, b)) if curved or not _joined(c, d, threshold)
                ]
        intervals = halves
    return Scan.joined([*found, scan.some(slice(0))])


def _joined(one: Motion, other: Motion, threshold: float) -> bool:
    """Whether two unstable samples are of one tongue: of one motion, or of two that take over from each other.

    Tangents of two motions that both stay unstable meet between the samples, not far below them. Ahead of a stable
    speed growth falls like a root, whose tangent at the last unstable sample is half as high where the root ends.
    """
    if one.continues(other):
        return True
    step = 1.0 / other.speed - 1.0 / one.speed
    here, there = (np.log(each.radius) - threshold for each in (one, other))
    apart = (one.slope - other.slope) * step
    part = (there - here - other.slope * step) / apart if apart != 0.0 else np.nan
    return bool(0.0 < part < 1.0 and here + part * one.slope * step >= (1.0 - _STRAIGHT) * min(here, there))
