"""Tongues: all intervals of speed in which a model is unstable, however narrow.

A multiplier leaves the unit circle where it meets another one there, or where the system is unstable by itself. So
the multipliers are followed: around each sampled speed the eigenvalue problem of the transition matrix is expanded
to first order, Φ + δ Φ', which foretells for each pair of multipliers the speed where their phases meet and a bound
of their modulus there. Where the bound reaches 1 the meeting itself becomes a sample, and foretells it better. A
tongue is found at its centre in this way and not by the step of a grid.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq, minimize_scalar

from facegear.floquet import Method, multipliers
from facegear.labels import Combination, combination
from facegear.models import Model, parameter_path, replace_parameter
from facegear.multiplier_curves import MultiplierCurve, method_for
from facegear.parameters import finite_array, positive, within
from facegear.piecewise import Array

# Largest angle [rad] by which the fastest motion turns from one sample to the next.
_SAMPLE_ANGLE = 0.2
_FEWEST_SAMPLES = 65
# A pair is followed if so many times its foretold coupling could make it unstable.
_SAFETY = 4.0
# Reach of the expansion around a sample, in steps: neighbours overlap.
_REACH = 1.0
_ROUNDS = 8
# Relative accuracy of borders and of the speed where two phases meet: far below 0.01 rpm.
_SPEED_TOLERANCE = 1e-9
# Matrices worked on at once.
_BATCH = 512


@dataclass(frozen=True)
class Tongue:
    """Interval of speed in which the growth rate is positive.

    Attributes
    ----------
    lower, upper : float
        Borders [rad/s], or ends of the range looked at.
    peak : float
        Speed of the largest growth rate [rad/s].
    growth_rate : float
        Growth rate there [1/s].
    combination : Combination
        Modes and order of the resonance at the peak.
    """

    lower: float
    upper: float
    peak: float
    growth_rate: float
    combination: Combination = field(repr=False)

    @property
    def label(self) -> str:
        """Modes and order, such as "(1+2)/1"; as :attr:`facegear.hsu.ResonanceBand.label`."""
        return self.combination.label

    @property
    def width(self) -> float:
        """Width [rad/s]."""
        return self.upper - self.lower


@dataclass(frozen=True)
class TongueSection:
    """Tongues at one value of a swept parameter."""

    value: float
    tongues: tuple[Tongue, ...]


def tongues(
    model: Model,
    lowest_speed: float,
    highest_speed: float,
    *,
    method: Method | None = None,
    threshold: float = 1e-8,
    hints: Sequence[float] = (),
) -> tuple[Tongue, ...]:
    """All intervals of speed in which a model is unstable.

    Parameters
    ----------
    model : Model
        Anything with a method ``system(speed)``.
    lowest_speed, highest_speed : float
        Range looked at [rad/s].
    method : Method, optional
        Method of :mod:`facegear.floquet`; if left out, contact-force collocation where it applies, else adaptive
        Magnus.
    threshold : float
        Growth in a period, max|α| − 1, from which a speed counts as unstable [-]. Damping keeps stable multipliers
        clearly inside the unit circle; without damping they lie on it, and rounding alone must not look like growth.
    hints : sequence of float
        Further speeds [rad/s] around which to look.

    Returns
    -------
    tuple of Tongue
        Ascending. Borders are where max|α| − 1 passes the threshold, to a relative 1e-9 of the speed.

    Raises
    ------
    TypeError, ValueError
        If the range is empty or not positive, or a parameter is not valid.
    ArithmeticError
        If transition matrices do not vary smoothly with speed, or are not known well enough for the threshold.
    """
    lowest_speed = positive("lowest_speed", lowest_speed, "rad/s")
    highest_speed = positive("highest_speed", highest_speed, "rad/s")
    if lowest_speed >= highest_speed:
        raise ValueError(
            f"highest_speed must be greater than lowest_speed, {lowest_speed:.6g} rad/s; got {highest_speed!r} rad/s"
        )
    threshold = within("threshold", threshold, 1e-12, 1e-2)
    hints = finite_array("hints", hints).tolist() if len(hints) else []
    chosen = method_for(model, lowest_speed, highest_speed) if method is None else method
    curve = MultiplierCurve.of(model, lowest_speed, highest_speed, chosen)
    if curve.error > threshold:
        raise ArithmeticError(
            f"multipliers are known to {curve.error:.2g} only, which is not enough for a threshold of {threshold:.2g}"
        )
    scan = _scan(curve, threshold, hints)
    return tuple(_tongue(model, chosen, *run) for run in _runs(curve, scan, threshold))


def borders(
    model: Model,
    parameter: str,
    values: ArrayLike,
    lowest_speed: float,
    highest_speed: float,
    *,
    method: Method | None = None,
    threshold: float = 1e-8,
    jobs: int = -1,
) -> tuple[TongueSection, ...]:
    """Tongues at each of several values of a parameter, for drawing over a map.

    Parameters
    ----------
    model, lowest_speed, highest_speed, method, threshold
        As for :func:`tongues`.
    parameter : str
        Name of the swept parameter, as for :func:`facegear.maps.stability_map`.
    values : array_like, shape (V,)
        Values of the parameter.
    jobs : int
        Number of processes, as joblib's ``n_jobs``.

    Returns
    -------
    tuple of TongueSection
        One a value, in the order of `values`. Each value is searched on its own first. Tongues of its neighbours in
        `values` that it lacks are then looked for once more at their peaks.

    Raises
    ------
    TypeError, ValueError, ArithmeticError
        As :func:`tongues`, or for an unknown parameter.
    """
    array = finite_array("values", values)
    if array.ndim != 1 or array.size == 0:
        raise ValueError(f"values must list at least one value of the parameter, got shape {array.shape}")
    parameter_path(model, parameter)
    from joblib import Parallel, delayed

    models = [replace_parameter(model, parameter, value) for value in array.tolist()]

    def sections(numbers: Sequence[int], hints: dict[int, list[float]]) -> list[tuple[Tongue, ...]]:
        search = delayed(tongues)
        return list(
            Parallel(n_jobs=jobs)(
                search(
                    models[i],
                    lowest_speed,
                    highest_speed,
                    method=method,
                    threshold=threshold,
                    hints=hints.get(i, ()),
                )
                for i in numbers
            )
        )

    found = sections(range(array.size), {})
    missing = {i: peaks for i in range(array.size) if (peaks := _missing(found, i))}
    for i, again in zip(missing, sections(list(missing), missing), strict=True):
        found[i] = again
    return tuple(TongueSection(value, part) for value, part in zip(array.tolist(), found, strict=True))


def _missing(found: Sequence[tuple[Tongue, ...]], number: int) -> list[float]:
    """Peaks of a neighbour's tongues that have no counterpart of the same label."""
    own = {tongue.label for tongue in found[number]}
    neighbours = [found[i] for i in (number - 1, number + 1) if 0 <= i < len(found)]
    return [tongue.peak for part in neighbours for tongue in part if tongue.label not in own]


@dataclass(frozen=True, eq=False)
class _Scan:
    """Speeds looked at, ascending, and the spectral radius at each."""

    speeds: Array
    radii: Array

    def with_speeds(self, curve: MultiplierCurve, speeds: Sequence[float] | Array) -> _Scan:
        """Return the scan with more speeds; those already there are left out."""
        added = np.unique(np.asarray(speeds, dtype=float))
        added = np.setdiff1d(added[(added > curve.lowest_speed) & (added < curve.highest_speed)], self.speeds)
        if added.size == 0:
            return self
        together = np.concatenate([self.speeds, added])
        order = np.argsort(together)
        radii = np.concatenate([self.radii, curve.spectral_radii(added)])
        return _Scan(together[order], radii[order])


def _scan(curve: MultiplierCurve, threshold: float, hints: Sequence[float]) -> _Scan:
    """Spectral radii on a grid, at all meetings of multipliers that matter, and at extremes between samples."""
    low, high = 1.0 / curve.highest_speed, 1.0 / curve.lowest_speed
    turn = abs(curve.fastest_angle[1] - curve.fastest_angle[0])
    count = max(_FEWEST_SAMPLES, int(np.ceil(turn / _SAMPLE_ANGLE)) + 1)
    grid, step = np.linspace(low, high, count, retstep=True)
    seeds = np.concatenate([grid, [1.0 / speed for speed in hints if low < 1.0 / speed < high]])
    meetings = _meetings(curve, seeds, float(step), threshold)
    speeds = np.concatenate([[curve.lowest_speed, curve.highest_speed], 1.0 / grid[1:-1]])
    scan = _Scan(np.sort(speeds), curve.spectral_radii(np.sort(speeds)))
    scan = scan.with_speeds(curve, 1.0 / np.concatenate([seeds, meetings]))
    return scan.with_speeds(curve, _extremes(curve, scan, threshold))


def _meetings(curve: MultiplierCurve, seeds: Array, step: float, threshold: float) -> Array:
    """Slowness 1/speed where phases of two multipliers meet whose growth there could pass the threshold."""
    centres, reach = seeds, np.full(seeds.size, _REACH * step)
    found = []
    for _ in range(_ROUNDS):
        parts = [
            _foretold(curve, centres[i : i + _BATCH], reach[i : i + _BATCH], threshold)
            for i in range(0, centres.size, _BATCH)
        ]
        meeting = np.concatenate([part[0] for part in parts])
        distance = np.concatenate([part[1] for part in parts])
        # Neighbours foretell the same meeting: those that agree to a thousandth of the step taken are one.
        keep = _distinct(meeting, np.maximum(1e-3 * distance, 1e-12 * meeting))
        meeting, distance = meeting[keep], distance[keep]
        found.append(meeting)
        moving = distance > 1e-2 * _SPEED_TOLERANCE * meeting
        # The error of a foretold meeting is of second order in its distance.
        centres, reach = meeting[moving], 0.5 * distance[moving]
        if centres.size == 0:
            break
    return np.concatenate(found)


def _distinct(points: Array, tolerance: Array) -> Array:
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


def _foretold(curve: MultiplierCurve, centres: Array, reach: Array, threshold: float) -> tuple[Array, Array]:
    """Meetings of phases within `reach` of samples, and their distances from them, both in slowness.

    In the eigenvectors of the sample Φ + δ Φ' is diag(α) + δ F. Two multipliers meet where the phases of
    α_i + δ F_ii agree; their block [[a, δ F_ij], [δ F_ji, d]] then has a modulus of at most
    (|a| + |d|)/2 + √((|a| − |d|)²/4 + δ²|F_ij F_ji|).
    """
    inside = (1.0 / centres >= curve.lowest_speed) & (1.0 / centres <= curve.highest_speed)
    centres, reach = centres[inside], reach[inside]
    if centres.size == 0:
        return centres, reach
    matrices, slopes = curve.transition_matrices(1.0 / centres)
    values, vectors = np.linalg.eig(matrices)
    # Exactly dependent eigenvectors, at a border, have no inverse.
    left = np.linalg.inv(vectors + 1e-15 * np.eye(vectors.shape[-1]))
    coupling = left @ slopes @ vectors
    rates = np.diagonal(coupling, axis1=1, axis2=2) / np.where(values == 0.0, 1.0, values)
    first, second = np.triu_indices(values.shape[1], 1)
    # Each pair off the real axis has a conjugate that says the same.
    phase = np.angle(values[:, first] * values[:, second].conj())
    turning = (rates[:, first] - rates[:, second]).imag
    with np.errstate(divide="ignore", invalid="ignore"):
        step = -phase / turning
    near = np.isfinite(step) & (np.abs(step) <= reach[:, None]) & (values[:, first].imag >= 0.0)
    sample, pair = np.nonzero(near)
    i, j, step = first[pair], second[pair], step[near]
    moduli = [
        np.abs(values[sample, k]) * np.exp(np.clip(rates[sample, k].real * step, -2.0, 2.0)) for k in (i, j)
    ]
    squared = np.abs(coupling[sample, i, j] * coupling[sample, j, i]) * step**2
    bound = (moduli[0] + moduli[1]) / 2.0 + np.sqrt(
        ((moduli[0] - moduli[1]) / 2.0) ** 2 + _SAFETY**2 * squared
    )
    matters = bound > 1.0 + threshold
    return centres[sample[matters]] + step[matters], np.abs(step[matters])


def _extremes(curve: MultiplierCurve, scan: _Scan, threshold: float) -> list[float]:
    """Speeds of maxima between stable samples, and minima between unstable ones, that may cross the threshold."""
    level = scan.radii - 1.0 - threshold
    found = []
    for sign in (1.0, -1.0):
        height = sign * level
        middle, left, right = height[1:-1], height[:-2], height[2:]
        # A parabola through three samples rises at most by an eighth of its bend above the middle one.
        rise = 2.0 * middle - left - right
        near = (middle < 0.0) & (middle >= left) & (middle >= right) & (middle + rise > 0.0)
        for i in (1 + np.flatnonzero(near)).tolist():
            found.append(_maximum(curve, sign, float(scan.speeds[i - 1]), float(scan.speeds[i + 1])))
    return found


def _maximum(curve: MultiplierCurve, sign: float, low: float, high: float) -> float:
    result = minimize_scalar(
        lambda speed: -sign * float(curve.spectral_radii(np.array([speed]))[0]),
        bounds=(low, high),
        method="bounded",
        options={"xatol": _SPEED_TOLERANCE * high},
    )
    return float(result.x)


def _runs(curve: MultiplierCurve, scan: _Scan, threshold: float) -> list[tuple[float, float, float]]:
    """Lower border, upper border and peak of every run of unstable samples."""

    def level(speed: float) -> float:
        return float(curve.spectral_radii(np.array([speed]))[0]) - 1.0 - threshold

    def border(first: int, second: int) -> float:
        return float(
            brentq(level, scan.speeds[first], scan.speeds[second], xtol=_SPEED_TOLERANCE * curve.lowest_speed)
        )

    unstable = scan.radii > 1.0 + threshold
    edges = np.flatnonzero(np.diff(np.concatenate([[False], unstable, [False]]).astype(int)))
    runs = []
    last = scan.speeds.size - 1
    for start, stop in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True):
        lower = border(start - 1, start) if start > 0 else curve.lowest_speed
        upper = border(stop - 1, stop) if stop <= last else curve.highest_speed
        growth = np.log(scan.radii[start:stop]) * scan.speeds[start:stop]
        top = start + int(np.argmax(growth))
        low = max(lower, float(scan.speeds[max(top - 1, 0)]))
        high = min(upper, float(scan.speeds[min(top + 1, last)]))
        runs.append((lower, upper, _peak(curve, low, high, float(scan.speeds[top]))))
    return runs


def _peak(curve: MultiplierCurve, low: float, high: float, best: float) -> float:
    """Speed of the largest growth rate between two speeds, no worse than at `best`."""

    def growth(speed: float) -> float:
        return float(np.log(curve.spectral_radii(np.array([speed]))[0])) * speed

    if low >= high:
        return best
    result = minimize_scalar(
        lambda speed: -growth(speed), bounds=(low, high), method="bounded", options={"xatol": 1e-9 * high}
    )
    return float(result.x) if growth(float(result.x)) >= growth(best) else best


def _tongue(model: Model, method: Method, lower: float, upper: float, peak: float) -> Tongue:
    system = model.system(peak)
    growth = float(np.log(np.abs(multipliers(system, method)[0])) / system.period)
    return Tongue(lower, upper, peak, growth, combination(system, method))
