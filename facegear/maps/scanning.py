"""Speeds at which to look for instability, found by following multipliers.

A multiplier leaves the unit circle where it meets another one there, or where the system is unstable by itself. So
the multipliers are followed: around each sampled speed the eigenvalue problem of the transition matrix is expanded
to first order, Φ + δ Φ', which foretells for each pair of multipliers the speed where their phases meet and a bound
of their modulus there. Where the bound reaches 1 the meeting itself becomes a sample, and foretells it better. A
tongue is found at its centre in this way and not by the step of a grid. Where the partner of a motion dies much faster,
growth is largest beside the meeting: between samples it is followed by its tangents.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from facegear.floquet.eigenvectors import change, critical
from facegear.floquet.multiplier_curves import MultiplierCurve
from facegear.support.types import ComplexArray, FloatArray

# Largest angle [rad] by which the fastest live motion turns from one sample to the next.
SAMPLE_ANGLE = 0.4
FEWEST_SAMPLES = 64
# A pair is followed if so many times its foretold coupling could make it unstable.
_SAFETY = 4.0
# A meeting of an unstable motion is followed if the coupling, `_SAFETY` included, changes its growth by this part.
_TELLING = 0.1
# Reach of the expansion around a sample, in steps: neighbours overlap.
_REACH = 1.0
_ROUNDS = 8
# Parts of the reach at which growth is foretold of a pair that meets beyond it or not at all.
_PLACES = np.array([0.25, 0.5, 0.75, 1.0])
# Between unstable samples the growth may differ from a straight line by this part of itself.
_STRAIGHT = 0.25
_MOST_HALVINGS = 40
# Pairs of multipliers with a smaller product are left alone: nothing brings them back to 1 within a step.
_DECAYED = 1e-6
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
        return cls.of_motions(_critical(curve, speeds))

    @classmethod
    def of_motions(cls, motions: Sequence[_Critical]) -> Scan:
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


def scan_of(curve: MultiplierCurve, threshold: float, hints: Sequence[float]) -> Scan:
    """Spectral radii on a grid, at all meetings of multipliers that matter, and wherever growth may pass between."""
    low, high = 1.0 / curve.highest_speed, 1.0 / curve.lowest_speed
    grid = curve.motions.points(SAMPLE_ANGLE, FEWEST_SAMPLES)
    seeds = np.concatenate([grid, [1.0 / speed for speed in hints if low < 1.0 / speed < high]])
    meetings, looked_at = _meetings(curve, seeds, _steps(grid, seeds), threshold)
    scan = Scan.of(curve, np.array([curve.lowest_speed, curve.highest_speed])).with_samples(looked_at)
    scan = _rising(curve, scan.with_speeds(curve, 1.0 / meetings), threshold)
    return scan.with_samples(_gaps(curve, scan, threshold))


def _steps(grid: FloatArray, points: FloatArray) -> FloatArray:
    """Distance of the points of a grid next to each point, the larger of both sides."""
    steps = np.diff(grid)
    right = np.searchsorted(grid, points, side="right").clip(1, steps.size) - 1
    left = np.searchsorted(grid, points, side="left").clip(1, steps.size) - 1
    return np.asarray(np.maximum(steps[left], steps[right]))


def _meetings(
    curve: MultiplierCurve, seeds: FloatArray, steps: FloatArray, threshold: float
) -> tuple[FloatArray, Scan]:
    """Slowness 1/speed where phases of two multipliers meet whose growth there could pass the threshold.

    Returns them and all samples that were looked at for it.
    """
    centres, reach, batch = seeds, _REACH * steps, curve.batch
    found, samples = [], []
    for _ in range(_ROUNDS):
        parts = [
            _foretold(curve, centres[i : i + batch], reach[i : i + batch], threshold)
            for i in range(0, centres.size, batch)
        ]
        meeting = np.concatenate([part[0] for part in parts])
        distance = np.concatenate([part[1] for part in parts])
        samples += [part[2] for part in parts]
        # Neighbours foretell the same meeting: those that agree to a thousandth of the step taken are one.
        keep = _distinct(meeting, np.maximum(1e-3 * distance, 1e-12 * meeting))
        meeting, distance = meeting[keep], distance[keep]
        found.append(meeting)
        moving = distance > 1e-2 * SPEED_TOLERANCE * meeting
        # The error of a foretold meeting is of second order in its distance.
        centres, reach = meeting[moving], 0.5 * distance[moving]
        if centres.size == 0:
            break
    columns = ((scan.speeds, scan.radii, scan.slopes) for scan in samples)
    return np.concatenate(found), Scan(*np.concatenate(list(columns), axis=1))


def _distinct(points: FloatArray, tolerance: FloatArray) -> FloatArray:
    """Numbers of points, the ones foretold from nearby first, that differ by more than their tolerance."""
    order = np.argsort(points)
    kept: list[int] = []
    for i in order.tolist():
        if kept and points[i] - points[kept[-1]] <= max(tolerance[i], tolerance[kept[-1]]):
            if tolerance[i] < tolerance[kept[-1]]:
                kept[-1] = i
            continue
        kept.append(i)
    return np.array(kept, dtype=int)


def _foretold(
    curve: MultiplierCurve, centres: FloatArray, reach: FloatArray, threshold: float
) -> tuple[FloatArray, FloatArray, Scan]:
    """Meetings of multipliers within `reach` of samples, their distances from them, both in slowness, and the samples.

    In the eigenvectors of a sample ln(Φ + δ Φ') is diag(p) + δ G to first order. The block of a pair has the
    exponents (p_i + p_j + δ (G_ii + G_jj))/2 ± √D with D = (p_i − p_j + δ (G_ii − G_jj))²/4 + δ² G_ij G_ji. D is
    smooth where the exponents themselves have a root, at a border, and largest in the middle of a tongue: where two
    phases would meet without the coupling. Where that is beyond the reach, or nowhere because the coupling turns the
    phases as much as they part, a stable sample foretells the places within its reach that are unstable already.
    """
    inside = (1.0 / centres >= curve.lowest_speed) & (1.0 / centres <= curve.highest_speed)
    centres, reach = centres[inside], reach[inside]
    if centres.size == 0:
        return centres, reach, Scan(centres, centres, centres)
    values, direct, crossed = change(
        curve.transition_matrices(1.0 / centres), curve.slopes(1.0 / centres), _DECAYED
    )
    values = np.where(values == 0.0, 1e-300, values)
    rates = np.einsum("vii->vi", direct) / values
    largest = np.abs(values).argmax(axis=1)[:, np.newaxis]
    radii, slopes = (np.take_along_axis(part, largest, axis=1)[:, 0] for part in (np.abs(values), rates.real))
    samples = Scan(1.0 / centres, radii, slopes)
    # Of a pair off the real axis and its conjugate, which says the same, one: both above the axis, or the second below.
    above = np.triu(np.ones(direct.shape[1:], dtype=bool), 1)
    below = np.triu(values.imag[:, np.newaxis] > 0.0)
    both = (
        _near((values, rates), (values, rates), direct * direct.swapaxes(1, 2), above, reach),
        _near(
            (values, rates),
            (values.conj(), rates.conj()),
            crossed * crossed.conj().swapaxes(1, 2),
            below,
            reach,
        ),
    )
    sample, step, apart, turning, coupling, mean, beyond = (
        np.concatenate(part) for part in zip(*both, strict=True)
    )
    difference = (apart + step * turning) / 2.0
    spread = difference.real**2 + _SAFETY**2 * np.abs(coupling) * step**2
    foretold = (difference**2 + np.where(beyond, _SAFETY**2, 1.0) * coupling * step**2).real
    # The growth of the pair without the coupling: where that alone is unstable, and the coupling can change it by a
    # small part only, the meeting tells nothing new.
    apart_only = np.abs(difference.real)
    root = np.where(beyond, np.maximum(foretold, 0.0), np.maximum(spread, np.abs(foretold)))
    added = np.sqrt(root) - apart_only
    excess = mean + apart_only - threshold
    matters = (excess + added > 0.0) & (added > _TELLING * excess)
    distance = np.where(beyond, _PLACES[0] * 2.0 * reach[sample], np.abs(step))
    return centres[sample[matters]] + step[matters], distance[matters], samples


class _Near(NamedTuple):
    """Pairs of multipliers whose phases are foretold to meet within reach, or that may grow there: of each, one entry.

    Number of the sample, step to the meeting, p_i − p_j and its slope, G_ij G_ji, (p_i + p_j)/2 at the meeting, of
    which only the growth, and whether the step is not to a meeting but to a place before it.
    """

    sample: NDArray[np.intp]
    step: FloatArray
    apart: ComplexArray
    turning: ComplexArray
    coupling: ComplexArray
    mean: FloatArray
    beyond: NDArray[np.bool_]


def _near(
    one: tuple[ComplexArray, ComplexArray],
    other: tuple[ComplexArray, ComplexArray],
    products: ComplexArray,
    pairs: NDArray[np.bool_],
    reach: FloatArray,
) -> _Near:
    """Pairs that may meet, of multipliers and their rates (V, m) and products of forces (V, m, m)."""
    a, first = (part[:, :, np.newaxis] for part in one)
    b, second = (part[:, np.newaxis] for part in other)
    p, q = np.log(a), np.log(b)
    apart = p - q
    apart.imag -= 2.0 * np.pi * np.round(apart.imag / (2.0 * np.pi))
    turning, distance = first - second, a - b
    # Off the diagonal the logarithm has the divided difference of its values.
    close = np.abs(distance) <= 1e-6 * np.abs(a)
    scale = np.where(close, 1.0 / a, apart / np.where(distance == 0.0, 1.0, distance))
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        coupling = products * scale**2
        bend = (turning**2 / 4.0 + coupling).real
        step = -(apart * turning).real / (4.0 * bend)
        level, drift = (p.real + q.real) / 2.0, (first + second).real / 2.0
        within = reach[:, np.newaxis, np.newaxis]
        # Decayed motions do not come back.
        live = pairs & (2.0 * level > np.log(_DECAYED))
        near = live & (bend < 0.0) & (np.abs(step) <= within)
        most = np.abs(apart.real) / 2.0 + within * (np.abs(drift) + _SAFETY * np.sqrt(np.abs(coupling)))
        stable = (np.abs(one[0]).max(axis=1) < 1.0)[:, np.newaxis, np.newaxis]
        far = live & ~near & stable & (level + most > 0.0)
    places = np.concatenate([-_PLACES, _PLACES])
    sample = np.append(np.nonzero(near)[0], np.repeat(np.nonzero(far)[0], places.size))
    chosen = (
        np.append(part[near], np.repeat(part[far], places.size))
        for part in (apart, turning, coupling, level, drift)
    )
    difference, slope, products, mean, change_of_mean = chosen
    steps = np.append(step[near], np.outer(reach[np.nonzero(far)[0]], places))
    beyond = np.arange(steps.size) >= np.count_nonzero(near)
    return _Near(sample, steps, difference, slope, products, mean + steps * change_of_mean, beyond)


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


class _Critical(NamedTuple):
    """Largest multiplier at a speed: its modulus, the slope of that as in a scan, and its eigenvectors, left r = 1."""

    speed: float
    radius: float
    slope: float
    left: ComplexArray
    right: ComplexArray

    def continues(self, other: _Critical) -> bool:
        """Whether the critical motion is the same at another speed nearby."""
        return bool(np.abs((self.left @ other.right) * (other.left @ self.right)) > 0.5)


def _critical(curve: MultiplierCurve, speeds: FloatArray) -> list[_Critical]:
    """Critical motions at speeds (m,)."""
    found = []
    for start in range(0, speeds.size, curve.batch):
        part = speeds[start : start + curve.batch]
        values, right, left = critical(curve.transition_matrices(part))
        change_of_value = np.einsum("vi,vij,vj->v", left, curve.slopes(part), right, optimize=True)
        with np.errstate(all="ignore"):
            slopes = (change_of_value / values).real
        found += list(map(_Critical, part.tolist(), np.abs(values).tolist(), slopes.tolist(), left, right))
    return found


def _gaps(curve: MultiplierCurve, scan: Scan, threshold: float) -> Scan:
    """Look between unstable samples for speeds that separate tongues which lie close together.

    Intervals between unstable samples are halved where the critical motion is not the same at both ends, or the
    growth is not near a straight line, until a stable speed is found or nothing is left to see.
    """
    unstable = scan.radii - 1.0 > threshold
    samples = dict(
        zip(np.flatnonzero(unstable).tolist(), _critical(curve, scan.speeds[unstable]), strict=True)
    )
    intervals = [(samples[i], samples[i + 1]) for i in samples if i + 1 in samples]
    found: list[_Critical] = []
    for _ in range(_MOST_HALVINGS):
        intervals = [(a, b) for a, b in intervals if b.speed - a.speed > SPEED_TOLERANCE * b.speed]
        if not intervals:
            break
        middles = np.array([(a.speed + b.speed) / 2.0 for a, b in intervals])
        halves = []
        for (a, b), middle in zip(intervals, _critical(curve, middles), strict=True):
            found.append(middle)
            left, between, right = (each.radius - 1.0 - threshold for each in (a, middle, b))
            if between > 0.0:
                curved = abs(between - (left + right) / 2.0) > _STRAIGHT * min(left, between, right)
                halves += [(c, d) for c, d in ((a, middle), (middle, b)) if curved or not c.continues(d)]
        intervals = halves
    return Scan.of_motions(found)
