"""Taylor series of the motions of many small systems in lockstep, compiled: what :mod:`facegear.floquet.taylor` calls.

Buffers as in :mod:`facegear.floquet.lockstep_exponentials`: entry (i, j) of a matrix with m columns is at
``(i * m + j) * LANES + lane``.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from facegear.floquet.compiled import LANES
from facegear.floquet.lockstep import inner, outer
from facegear.support.types import FloatArray

_N = np.uint64(LANES)
_ONE, _TWO = np.uint64(1), np.uint64(2)


@inner
def _add_products(
    out: FloatArray,
    both: FloatArray,
    power: np.uint64,
    terms: FloatArray,
    before: tuple[np.uint64, np.uint64, np.uint64],
    varies: NDArray[np.bool_],
    n: np.uint64,
) -> None:
    """Add to `out` (n, 2n) the products of three powers (n, 2n) in a row with the terms (2n, 2n) that they belong to.

    Six terms a pass: the more there are in one, the fewer checks that the buffers are not the same. Where nothing
    varies there is no power but the first.
    """
    row = _TWO * n * _N
    first, second, third = before
    half, size = n * _N, n * row
    for i in range(n):
        for j in range(_TWO * n):
            to = np.uint64(i) * row + np.uint64(j) * _N
            a, b = power * size + np.uint64(i) * row, np.uint64(j) * _N
            for other in range(n):
                if not varies[i, other]:
                    if power == 0:
                        for lane in range(_N):
                            k, at = a + lane, b + lane
                            out[to + lane] += (
                                both[k] * terms[first + at] + both[k + half] * terms[first + size + at]
                            )
                    a += _N
                    b += row
                    continue
                for lane in range(_N):
                    k, at = a + lane, b + lane
                    out[to + lane] += (
                        both[k] * terms[first + at]
                        + both[k + half] * terms[first + size + at]
                        + both[k + size] * terms[second + at]
                        + both[k + size + half] * terms[second + size + at]
                        + both[k + size + size] * terms[third + at]
                        + both[k + size + size + half] * terms[third + size + at]
                    )
                a += _N
                b += row


@inner
def _coefficients(
    both: FloatArray,
    own: FloatArray,
    stiffness: FloatArray,
    damping: FloatArray,
    dyads: FloatArray,
    slopes: FloatArray,
    length: float,
    n: np.uint64,
) -> None:
    """Put powers of −h(K C) on a step into `both`, from h, periods, stiffness and damping of loads in `own`."""
    loads = dyads.shape[1]
    for power in range(dyads.shape[0]):
        for i in range(n):
            for j in range(n):
                at = ((np.uint64(power) * n + np.uint64(i)) * _TWO * n + np.uint64(j)) * _N
                beside = at + n * _N
                inside = (np.uint64(i) * n + np.uint64(j)) * _N
                for lane in range(_N):
                    both[at + lane] = -length * stiffness[inside + lane] if power == 0 else 0.0
                    both[beside + lane] = -length * damping[inside + lane] if power == 0 else 0.0
                for load in range(loads):
                    dyad, slope = -length * dyads[power, load, i, j], -length * slopes[power, load, i, j]
                    k = (_ONE + _TWO * np.uint64(load)) * _N
                    c = k + _N
                    for lane in range(_N):
                        both[at + lane] += own[k + lane] * dyad * own[lane] + own[c + lane] * slope
                        both[beside + lane] += own[c + lane] * dyad * own[lane]


@inner
def _largest(out: FloatArray, matrix: FloatArray, at: np.uint64, cells: np.uint64) -> None:
    """Put the largest modulus of the entries of each matrix into `out`."""
    for lane in range(_N):
        out[lane] = 0.0
    for _ in range(cells):
        for lane in range(_N):
            out[lane] = max(out[lane], abs(matrix[at + lane]))
        at += _N


def _taylor(
    stiffness: FloatArray,
    damping: FloatArray,
    load_stiffness: FloatArray,
    load_damping: FloatArray,
    ratio: float,
    lengths: FloatArray,
    dyads: FloatArray,
    slopes: FloatArray,
    numbers: NDArray[np.int64],
    periods: FloatArray,
    results: FloatArray,
    most: int,
    tolerance: float,
) -> None:
    """Scaled transition matrices (V, 2n, 2n) of cells, as :func:`facegear.floquet.taylor._matrices` has them."""
    size, powers, loads = stiffness.shape[1], dyads.shape[1], dyads.shape[2]
    n, m = np.uint64(size), np.uint64(2 * size)
    cells, half = m * m, n * m * _N
    whole, padded = 4 * size * size * LANES, 3 * ((powers + 2) // 3)
    # One more than powers reach back to, that a new term may replace.
    slots = padded + 1
    terms, state = np.zeros(slots * whole), np.zeros(whole)
    force, both = np.zeros(half), np.zeros(padded * 2 * size * size * LANES)
    own_k, own_c = np.zeros(size * size * LANES), np.zeros(size * size * LANES)
    varies = np.zeros((size, size), np.bool_)
    for step in range(lengths.size):
        for power in range(1, powers):
            for load in range(loads):
                for i in range(size):
                    for j in range(size):
                        there = (
                            dyads[step, power, load, i, j] != 0.0 or slopes[step, power, load, i, j] != 0.0
                        )
                        varies[i, j] = varies[i, j] or there
    # Period, and stiffness and damping of each load.
    own = np.zeros((1 + 2 * loads) * LANES)
    begun, now, last = np.zeros(LANES), np.zeros(LANES), np.zeros(LANES)
    for begin in range(0, periods.size, LANES):
        for lane in range(LANES):
            cell = min(begin + lane, periods.size - 1)
            number, period = numbers[cell], periods[cell]
            own[lane] = period
            for load in range(loads):
                own[(1 + 2 * load) * LANES + lane] = load_stiffness[number, load]
                own[(2 + 2 * load) * LANES + lane] = load_damping[number, load]
            for i in range(size):
                for j in range(size):
                    own_k[(i * size + j) * LANES + lane] = period * stiffness[number, i, j]
                    own_c[(i * size + j) * LANES + lane] = period * damping[number, i, j]
        state[:] = 0.0
        for i in range(2 * size):
            state[(i * 2 * size + i) * LANES : (i * 2 * size + i + 1) * LANES] = 1.0
        converged = True
        for step in range(lengths.size):
            length = lengths[step]
            _coefficients(both, own, own_k, own_c, dyads[step], slopes[step], length, n)
            terms[:] = 0.0
            terms[:whole] = state
            _largest(begun, state, np.uint64(0), cells)
            settled = False
            for order in range(1, most + 1):
                old, new = np.uint64((order - 1) % slots * whole), np.uint64(order % slots * whole)
                inverse = 1.0 / order
                for at in range(np.uint64(0), half, _N):
                    for lane in range(_N):
                        terms[new + at + lane] = terms[old + half + at + lane] * (
                            own[lane] * (length * ratio * inverse)
                        )
                for at in range(half):
                    force[at] = 0.0
                # What is before the first term, and beyond the last power, is zero.
                for power in range(0, min(powers, order), 3):
                    before = (
                        np.uint64((order - 1 - power) % slots * whole),
                        np.uint64((order - 2 - power) % slots * whole),
                        np.uint64((order - 3 - power) % slots * whole),
                    )
                    _add_products(force, both, np.uint64(power), terms, before, varies, n)
                for at in range(half):
                    terms[new + half + at] = force[at] * inverse
                for at in range(np.uint64(whole)):
                    state[at] += terms[new + at]
                # Two terms in turn, since one may be small by accident.
                if order < 8 or order % 2:
                    continue
                _largest(now, terms, old, cells)
                _largest(last, terms, new, cells)
                settled = True
                for lane in range(_N):
                    settled = settled and max(now[lane], last[lane]) <= tolerance * begun[lane]
                if settled:
                    break
            converged = converged and settled
        for lane in range(min(LANES, periods.size - begin)):
            for i in range(2 * size):
                for j in range(2 * size):
                    value = state[(i * 2 * size + j) * LANES + lane]
                    results[begin + lane, i, j] = value if converged else np.nan


taylor = outer(
    _taylor,
    "void(float64[:,:,::1], float64[:,:,::1], float64[:,::1], float64[:,::1], float64, float64[::1], "
    "float64[:,:,:,:,::1], float64[:,:,:,:,::1], int64[::1], float64[::1], float64[:,:,::1], int64, float64)",
)
