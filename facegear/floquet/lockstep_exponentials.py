"""Exponentials of many small matrices in lockstep, compiled: what :mod:`facegear.floquet.stepping` calls.

Buffers as in :mod:`facegear.floquet.lockstep`: entry (i, j) of a matrix of size d is at ``(i * d + j) * LANES + lane``.
"""

from __future__ import annotations

import numpy as np

from facegear.floquet.compiled import LANES
from facegear.floquet.lockstep import inner, outer
from facegear.support.types import FloatArray

_N = np.uint64(LANES)
_ONE, _TWO, _THREE, _FOUR, _FIVE, _SIX = (np.uint64(number) for number in range(1, 7))
_DEGREE = 12
_COMMUTATOR = np.sqrt(3.0) / 12.0
_INVERSE_FACTORIALS = tuple(1.0 / np.cumprod(np.concatenate([[1.0], np.arange(1.0, _DEGREE + 1.0)])))


@inner
def _product(out: FloatArray, one: FloatArray, other: FloatArray, size: np.uint64) -> None:
    """Put one @ other into `out`; `size` is even.

    Six terms a pass, and then two: the more there are in one, the fewer checks that the buffers are not the same.
    """
    row = size * _N
    for i in range(size):
        for j in range(size):
            at, a, b = (np.uint64(i) * size + np.uint64(j)) * _N, np.uint64(i) * row, np.uint64(j) * _N
            for lane in range(_N):
                out[at + lane] = 0.0
            for _ in range(size // _SIX):
                for lane in range(_N):
                    k, m = a + lane, b + lane
                    out[at + lane] += (
                        one[k] * other[m]
                        + one[k + _N] * other[m + row]
                        + one[k + _TWO * _N] * other[m + _TWO * row]
                        + one[k + _THREE * _N] * other[m + _THREE * row]
                        + one[k + _FOUR * _N] * other[m + _FOUR * row]
                        + one[k + _FIVE * _N] * other[m + _FIVE * row]
                    )
                a += _SIX * _N
                b += _SIX * row
            for _ in range(size % _SIX // _TWO):
                for lane in range(_N):
                    k, m = a + lane, b + lane
                    out[at + lane] += one[k] * other[m] + one[k + _N] * other[m + row]
                a += _TWO * _N
                b += _TWO * row


@inner
def _add_cubic(out: FloatArray, powers: FloatArray, order: int, size: np.uint64, cells: np.uint64) -> None:
    """Add a cubic of the Taylor polynomial, from some order on, of the matrix whose powers 1, 2 and 3 are given."""
    c0, c1, c2, c3 = (
        _INVERSE_FACTORIALS[order],
        _INVERSE_FACTORIALS[order + 1],
        _INVERSE_FACTORIALS[order + 2],
        _INVERSE_FACTORIALS[order + 3],
    )
    for i in range(cells):
        out[i] += c1 * powers[0, i] + c2 * powers[1, i] + c3 * powers[2, i]
    for i in range(size):
        at = np.uint64(i) * (size + _ONE) * _N
        for lane in range(_N):
            out[at + lane] += c0


@inner
def _load(buffer: FloatArray, matrices: FloatArray, begin: int, factors: FloatArray) -> None:
    """Put `LANES` matrices times a factor each into a buffer; past the end of all the last one again."""
    size = matrices.shape[1]
    for lane in range(LANES):
        source = min(begin + lane, matrices.shape[0] - 1)
        at = np.uint64(lane)
        for i in range(size):
            for j in range(size):
                buffer[at] = factors[source] * matrices[source, i, j]
                at += _N


@inner
def _store(results: FloatArray, begin: int, buffer: FloatArray) -> None:
    """Undo :func:`_load`."""
    size = results.shape[1]
    for lane in range(min(LANES, results.shape[0] - begin)):
        at = np.uint64(lane)
        for i in range(size):
            for j in range(size):
                results[begin + lane, i, j] = buffer[at]
                at += _N


@inner
def _squarings(matrices: FloatArray, size: np.uint64, squared_from: float) -> int:
    """How often to halve all matrices of a buffer until none has a larger norm."""
    norm = 0.0
    for lane in range(_N):
        for j in range(size):
            column, at = 0.0, np.uint64(j) * _N + np.uint64(lane)
            for _ in range(size):
                column += abs(matrices[at])
                at += size * _N
            norm = max(norm, column)
    squarings = 0
    # What is not finite stays so without any.
    while norm > squared_from and norm < np.inf:
        norm *= 0.5
        squarings += 1
    return squarings


@inner
def _exponential(
    powers: FloatArray, result: FloatArray, other: FloatArray, size: np.uint64, squared_from: float
) -> None:
    """Put exponentials of the matrices in powers[0], which are lost, into `result`."""
    cells = size * size * _N
    squarings = _squarings(powers[0], size, squared_from)
    for i in range(cells):
        powers[0, i] *= 0.5**squarings
    _product(powers[1], powers[0], powers[0], size)
    _product(powers[2], powers[1], powers[0], size)
    _product(powers[3], powers[1], powers[1], size)
    for i in range(cells):
        result[i] = _INVERSE_FACTORIALS[_DEGREE] * powers[3, i]
    _add_cubic(result, powers, 8, size, cells)
    for order in (4, 0):
        _product(other, result, powers[3], size)
        for i in range(cells):
            result[i] = other[i]
        _add_cubic(result, powers, order, size, cells)
    for _ in range(squarings):
        _product(other, result, result, size)
        for i in range(cells):
            result[i] = other[i]


def _exponentials(matrices: FloatArray, results: FloatArray, squared_from: float) -> None:
    """Exponentials of matrices (B, d, d) of even size, into an array of this shape.

    Degree, products and squarings as :func:`facegear.floquet.stepping.exponentials` has them, squarings as many as the
    largest norm of each `LANES` matrices asks for.
    """
    size, whole = np.uint64(matrices.shape[1]), np.ones(matrices.shape[0])
    cells = size * size * _N
    powers, result, other = np.empty((4, cells)), np.empty(cells), np.empty(cells)
    for begin in range(0, matrices.shape[0], LANES):
        _load(powers[0], matrices, begin, whole)
        _exponential(powers, result, other, size, squared_from)
        _store(results, begin, result)


def _magnus_steps(
    first: FloatArray, second: FloatArray, lengths: FloatArray, results: FloatArray, squared_from: float
) -> None:
    """Exponentials of h (A₁+A₂)/2 − √3/12 h² [A₁, A₂], A₁ and A₂ (B, d, d) at the Gauss nodes, h in `lengths` (B,)."""
    size = np.uint64(first.shape[1])
    cells = size * size * _N
    powers, result, other = np.empty((4, cells)), np.empty(cells), np.empty(cells)
    for begin in range(0, first.shape[0], LANES):
        _load(powers[1], first, begin, lengths)
        _load(powers[2], second, begin, lengths)
        _product(result, powers[1], powers[2], size)
        _product(other, powers[2], powers[1], size)
        for i in range(cells):
            powers[0, i] = 0.5 * (powers[1, i] + powers[2, i]) - _COMMUTATOR * (result[i] - other[i])
        _exponential(powers, result, other, size, squared_from)
        _store(results, begin, result)


exponentials = outer(_exponentials, "void(float64[:,:,::1], float64[:,:,::1], float64)")
magnus_steps = outer(
    _magnus_steps, "void(float64[:,:,::1], float64[:,:,::1], float64[::1], float64[:,:,::1], float64)"
)
