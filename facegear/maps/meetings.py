"""Where phases of two multipliers meet, foretold from speeds nearby.

Around each sampled speed the eigenvalue problem of the transition matrix is expanded to first order, Φ + δ Φ', which
foretells for each pair of multipliers the speed where their phases meet and a bound of their modulus there. Where the
bound reaches 1 the meeting itself becomes a sample, and foretells it better.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from facegear.floquet.eigenvectors import change
from facegear.floquet.multiplier_curves import MultiplierCurve
from facegear.maps.scans import SPEED_TOLERANCE, Scan
from facegear.support.types import ComplexArray, FloatArray

# A pair is followed if so many times its foretold coupling could make it unstable.
_SAFETY = 4.0
# A meeting of an unstable motion is followed if the coupling, `_SAFETY` included, changes its growth by this part.
_TELLING = 0.1
# Reach of the expansion around a sample, in steps: neighbours overlap.
_REACH = 1.0
_ROUNDS = 8
# Parts of the reach at which growth is foretold of a pair that meets beyond it or not at all.
_PLACES = np.array([0.25, 0.5, 0.75, 1.0])
# Pairs of multipliers with a smaller product are left alone. Within a step, in which the fastest motion turns by 0.4
# rad, nothing brings exponents back to 0 that are 3.5 below it on the average.
_DECAYED = 1e-3


def meetings(
    curve: MultiplierCurve, seeds: FloatArray, steps: FloatArray, threshold: float
) -> tuple[FloatArray, Scan]:
    """Slowness 1/speed where phases of two multipliers meet whose growth there could pass a threshold.

    Parameters
    ----------
    curve : MultiplierCurve
    seeds, steps : array, shape (m,)
        Slowness from which to foretell, and how far [s/rad].
    threshold : float
        Growth in a period [-].

    Returns
    -------
    meetings : array
        [s/rad]
    scan : Scan
        All samples that were looked at for it, in no order.
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
    return np.concatenate(found), Scan.joined(samples)


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
        return centres, reach, Scan.of(curve, centres)
    values, direct, crossed, largest, critical = change(
        curve.transition_matrices(1.0 / centres), curve.slopes(1.0 / centres), _DECAYED
    )
    values = np.where(values == 0.0, 1e-300, values)
    rates = np.einsum("vii->vi", direct) / values
    slopes = rates.real[np.arange(largest.size), largest]
    samples = Scan.of_critical(1.0 / centres, critical, slopes)
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
