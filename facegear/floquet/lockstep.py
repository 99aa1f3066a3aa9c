"""Eigenvalues of many real matrices in lockstep, compiled: what :mod:`facegear.floquet.eigenvalues` calls.

Balancing, Householder's reduction to Hessenberg form and Francis' double shifts, as LAPACK has them, but of
`LANES` matrices at once: the same entry of all of them lies side by side, so that one instruction of the vector unit
does a step for several. Each matrix has its own window of rows that are still coupled; where a step is not its turn its
reflection is nothing.

Buffers are flat and their indices unsigned: the compiler then sees that entries of neighbouring rows, `LANES` apart,
are not the same, and makes vector instructions of the loops over matrices. Entry (i, j) of a matrix is at
``j * stride + i * LANES + lane``; a row and a column more than there are take what reflections of three do beyond the
end.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numpy as np
from numba import config, njit
from numpy.typing import NDArray

from facegear.floquet.compiled import LANES
from facegear.support.types import FloatArray

if config.DISABLE_JIT:
    raise ImportError("NUMBA_DISABLE_JIT is set: what is not compiled is far slower than NumPy")

_N = np.uint64(LANES)
_2N, _3N, _4N = 2 * _N, 3 * _N, 4 * _N
_ONE = np.uint64(1)
_EPS = float(np.finfo(float).eps)
# What is so much smaller than the norm is zero beside any entry: its square would leave the range of numbers.
_FLOOR = 1e-20
# Sweeps without an eigenvalue before a matrix is given up, and those at which its shifts are chosen otherwise.
_MOST_SWEEPS = 40
_UNUSUAL = (10, 20, 30)
# Rounds of balancing, and what a change of scale must save of the sum of a row's and a column's size.
_ROUNDS = 4
_SAVED = 0.95

# Division by zero is no exception here, and a product with a sum may be rounded once.
_OPTIONS: dict[str, Any] = {"error_model": "numpy", "fastmath": {"contract"}}

F = TypeVar("F", bound=Callable[..., object])


def inner(function: F) -> F:
    """Compile a part of a function that is called from Python, with it."""
    return cast(F, njit(**_OPTIONS)(function))


def outer(function: F, signature: str) -> F:
    """Compile for arguments of these types at once, and keep what is compiled beside this file."""
    return cast(F, njit(signature, cache=True, nogil=True, **_OPTIONS)(function))


@inner
def _add_products(
    total: FloatArray, one: FloatArray, other: FloatArray, at: np.uint64, rows: np.uint64, n: np.uint64
) -> None:
    """Add to `total` the sum over rows of one * other, from `at` in both."""
    for _ in range(rows // np.uint64(4)):
        for lane in range(n):
            i = at + lane
            total[lane] += (
                one[i] * other[i]
                + one[i + _N] * other[i + _N]
                + one[i + _2N] * other[i + _2N]
                + one[i + _3N] * other[i + _3N]
            )
        at += _4N
    for _ in range(rows % np.uint64(4)):
        for lane in range(n):
            total[lane] += one[at + lane] * other[at + lane]
        at += _N


@inner
def _add_column(
    u: FloatArray,
    a: FloatArray,
    v: FloatArray,
    column: np.uint64,
    at: np.uint64,
    rows: np.uint64,
    n: np.uint64,
) -> None:
    """Add to u a column of A times an entry of v, at `at`."""
    i = np.uint64(0)
    for _ in range(rows):
        for lane in range(n):
            u[i + lane] += a[column + i + lane] * v[at + lane]
        i += _N


@inner
def _add_columns(
    u: FloatArray,
    a: FloatArray,
    v: FloatArray,
    column: np.uint64,
    stride: np.uint64,
    at: np.uint64,
    rows: np.uint64,
    n: np.uint64,
) -> None:
    """Add to u four columns of A times entries of v, from `at`."""
    i = np.uint64(0)
    second, third, fourth = column + stride, column + stride + stride, column + stride + stride + stride
    for _ in range(rows):
        for lane in range(n):
            u[i + lane] += (
                a[column + i + lane] * v[at + lane]
                + a[second + i + lane] * v[at + _N + lane]
                + a[third + i + lane] * v[at + _2N + lane]
                + a[fourth + i + lane] * v[at + _3N + lane]
            )
        i += _N


@inner
def _change_column(
    a: FloatArray,
    v: FloatArray,
    u: FloatArray,
    w: FloatArray,
    column: np.uint64,
    at: np.uint64,
    rows: np.uint64,
    n: np.uint64,
) -> None:
    """Take from a column of A what the entries of v and w at `at` make of u and v."""
    i = np.uint64(0)
    for _ in range(rows):
        for lane in range(n):
            a[column + i + lane] -= u[i + lane] * v[at + lane] + v[i + lane] * w[at + lane]
        i += _N


@inner
def _balance(a: FloatArray, size: int, n: np.uint64) -> None:
    """Scale rows and columns by powers of two until their sizes are alike."""
    d = np.uint64(size)
    stride = (d + _ONE) * _N
    sizes, factor = np.zeros(2 * LANES), np.zeros(LANES)
    for _ in range(_ROUNDS):
        changed = False
        for k in range(d):
            sizes[:] = 0.0
            for j in range(d):
                if j != k:
                    row, column = j * stride + k * _N, k * stride + j * _N
                    for lane in range(n):
                        sizes[lane] += abs(a[row + lane])
                        sizes[_N + lane] += abs(a[column + lane])
            scaled = False
            for lane in range(n):
                row_size, column_size = sizes[lane], sizes[_N + lane]
                factor[lane] = 1.0
                if row_size > 0.0 and column_size > 0.0 and not 0.25 <= row_size / column_size <= 4.0:
                    f = 2.0 ** np.round(0.5 * np.log2(row_size / column_size))
                    if column_size * f + row_size / f < _SAVED * (column_size + row_size):
                        factor[lane] = f
                        scaled = True
            if scaled:
                changed = True
                for j in range(d):
                    row, column = j * stride + k * _N, k * stride + j * _N
                    for lane in range(n):
                        a[row + lane] /= factor[lane]
                    for lane in range(n):
                        a[column + lane] *= factor[lane]
        if not changed:
            break


@inner
def reduce(a: FloatArray, kept: FloatArray, size: int, n: np.uint64) -> None:
    """Bring matrices to Hessenberg form by reflections I - t v vᵀ from both sides.

    Of each, v and then t are kept one after the other, if there is room for any.
    """
    d = np.uint64(size)
    stride = (d + _ONE) * _N
    v, u, w = np.zeros(size * LANES), np.zeros(size * LANES), np.zeros(size * LANES)
    t, largest, total = np.zeros(LANES), np.zeros(LANES), np.zeros(LANES)
    for k in range(np.uint64(max(size - 2, 0))):
        start, column = (k + _ONE) * _N, k * stride
        rows = d - k - _ONE
        largest[:] = 0.0
        total[:] = 0.0
        for i in range(start, d * _N, _N):
            for lane in range(n):
                largest[lane] = max(largest[lane], abs(a[column + i + lane]))
        for lane in range(n):
            largest[lane] = 1.0 / largest[lane] if largest[lane] > 0.0 else 1.0
        for i in range(start, d * _N, _N):
            for lane in range(n):
                v[i + lane] = a[column + i + lane] * largest[lane]
        # Of what is below the subdiagonal alone: next to that it may be lost in rounding, and counts all the same.
        _add_products(total, v, v, start + _N, rows - _ONE, n)
        for lane in range(n):
            first = v[start + lane]
            there = total[lane] == 0.0
            length = np.copysign(np.sqrt(total[lane] + first * first), first)
            head = first + length
            # Where there is nothing it is left as it is.
            t[lane] = 0.0 if there else head / length
            a[column + start + lane] = a[column + start + lane] if there else -length / largest[lane]
            largest[lane] = 1.0 if there else 1.0 / head
            v[start + lane] = head
        for i in range(start, d * _N, _N):
            for lane in range(n):
                v[i + lane] *= largest[lane]
        a[column + start + _N : column + d * _N] = 0.0
        v[k * _N : start] = 0.0
        if kept.size:
            at = k * (d + _ONE) * _N
            kept[at : at + d * _N] = v
            kept[at + d * _N : at + (d + _ONE) * _N] = t
        # One pass for u = A v and w = Aᵀ v, one for A - t v wᵀ - t u vᵀ + t² (vᵀ A v) v vᵀ.
        u[:] = 0.0
        w[:] = 0.0
        last = k + _ONE + (rows // np.uint64(4)) * np.uint64(4)
        for j in range(k + _ONE, last, np.uint64(4)):
            _add_columns(u, a, v, j * stride, stride, j * _N, d, n)
        for j in range(last, d):
            _add_column(u, a, v, j * stride, j * _N, d, n)
        for j in range(k + _ONE, d):
            part = w[j * _N : (j + _ONE) * _N]
            _add_products(part, a[j * stride : (j + _ONE) * stride], v, start, rows, n)
        total[:] = 0.0
        _add_products(total, u, v, start, rows, n)
        for lane in range(n):
            total[lane] *= 0.5 * t[lane]
        for i in range(np.uint64(0), d * _N, _N):
            for lane in range(n):
                u[i + lane] = t[lane] * (u[i + lane] - total[lane] * v[i + lane])
        for i in range(start, d * _N, _N):
            for lane in range(n):
                w[i + lane] = t[lane] * (w[i + lane] - total[lane] * v[i + lane])
        for j in range(k + _ONE, d):
            _change_column(a, v, u, w, j * stride, j * _N, d, n)


@inner
def _negligible(below: float, one: float, other: float, norm: float) -> bool:
    """Whether an entry below the diagonal is none, beside those of the diagonal next to it."""
    return abs(below) <= _EPS * max(abs(one) + abs(other), _FLOOR * norm)


@inner
def _find_windows(
    a: FloatArray, low: FloatArray, high_norm: FloatArray, top: np.uint64, stride: np.uint64, n: np.uint64
) -> None:
    """Write to `low` where the window of each matrix begins, below the last negligible entry."""
    low[:] = 0.0
    at = np.uint64(0)
    for k in range(top):
        row = float(k + _ONE)
        for lane in range(n):
            i = at + lane
            size = max(abs(a[i]) + abs(a[i + stride + _N]), high_norm[_N + lane])
            small = (abs(a[i + _N]) <= _EPS * size) & (row <= high_norm[lane])
            low[lane] = row if small else low[lane]
        at += stride + _N


@inner
def _reflections(
    f: FloatArray, a: FloatArray, state: FloatArray, row: float, at: np.uint64, n: np.uint64
) -> None:
    """Write to f the reflection of each matrix, 1 q r and t, for the entries at `at` and below in the column before."""
    for lane in range(n):
        i = at + lane
        low, high = state[lane], state[_N + lane]
        in_p, in_q, in_r = a[i], a[i + _N], a[i + _2N]
        new_p, new_q, new_r = state[_2N + lane], state[_3N + lane], state[_4N + lane]
        first = row == low
        p = new_p if first else in_p
        q = new_q if first else in_q
        r = new_r if first else in_r
        r = r if row < high - 1.0 else 0.0
        square = p * p + q * q + r * r
        turn = (row >= low) & (row < high) & (square > 0.0)
        length = np.copysign(np.sqrt(square), p)
        length = length if turn else 1.0
        head = p + length if turn else 1.0
        inverse = 1.0 / head if turn else 0.0
        f[lane] = q * inverse
        f[_N + lane] = r * inverse
        f[_2N + lane] = head / length if turn else 0.0
        moved = turn & (row > low)
        a[i] = -length if moved else in_p
        a[i + _N] = 0.0 if moved else in_q
        a[i + _2N] = 0.0 if moved else in_r


@inner
def _reflect_rows(
    a: FloatArray, f: FloatArray, at: np.uint64, stride: np.uint64, columns: np.uint64, n: np.uint64
) -> None:
    """Reflect three rows, from `at`."""
    for _ in range(columns):
        for lane in range(n):
            i = at + lane
            q, r = f[lane], f[_N + lane]
            s = (a[i] + q * a[i + _N] + r * a[i + _2N]) * f[_2N + lane]
            a[i] -= s
            a[i + _N] -= s * q
            a[i + _2N] -= s * r
        at += stride


@inner
def _reflect_columns(
    a: FloatArray, f: FloatArray, at: np.uint64, stride: np.uint64, rows: np.uint64, n: np.uint64
) -> None:
    """Reflect three columns, from `at`."""
    second, third = at + stride, at + stride + stride
    for _ in range(rows):
        for lane in range(n):
            q, r = f[lane], f[_N + lane]
            s = (a[at + lane] + q * a[second + lane] + r * a[third + lane]) * f[_2N + lane]
            a[at + lane] -= s
            a[second + lane] -= s * q
            a[third + lane] -= s * r
        at += _N
        second += _N
        third += _N


@inner
def _take_pair(a: FloatArray, real: FloatArray, imag: FloatArray, h: int, lane: int) -> None:
    """Eigenvalues of the two rows that end with h, of one matrix."""
    half = (a[h - 1, h - 1, lane] - a[h, h, lane]) / 2.0
    product = a[h - 1, h, lane] * a[h, h - 1, lane]
    square = half * half + product
    if square >= 0.0:
        root = half + np.copysign(np.sqrt(square), half)
        real[h - 1, lane] = a[h, h, lane] + root
        real[h, lane] = a[h, h, lane] - product / root if root != 0.0 else a[h, h, lane]
        imag[h - 1, lane] = imag[h, lane] = 0.0
    else:
        real[h - 1, lane] = real[h, lane] = a[h, h, lane] + half
        imag[h - 1, lane] = np.sqrt(-square)
        imag[h, lane] = -imag[h - 1, lane]


@inner
def _start_sweep(a: FloatArray, state: FloatArray, m: int, h: int, lane: int, unusual: bool) -> None:
    """First column of the double step of one matrix on its window of rows m to h."""
    # The shifts have the sum one + other and the product one * other - off.
    one, other, off = a[h, h, lane], a[h - 1, h - 1, lane], a[h - 1, h, lane] * a[h, h - 1, lane]
    if unusual:
        size = abs(a[h - 1, h, lane]) + abs(a[h - 2, h - 1, lane])
        one += 0.75 * size
        other, off = one, -0.4375 * size * size
    else:
        half = (other - one) / 2.0
        square = half * half + off
        if square >= 0.0:
            # Of two real shifts the one near the corner, twice.
            root = half + np.copysign(np.sqrt(square), half)
            one = one - off / root if root != 0.0 else one
            other, off = one, 0.0
    corner = a[m, m, lane]
    one, other = one - corner, other - corner
    state[2 * LANES + lane] = (one * other - off) / a[m, m + 1, lane] + a[m + 1, m, lane]
    state[3 * LANES + lane] = a[m + 1, m + 1, lane] - corner - one - other
    state[4 * LANES + lane] = a[m + 1, m + 2, lane]


@inner
def _francis(
    flat: FloatArray, d: int, real: FloatArray, imag: FloatArray, converged: NDArray[np.bool_], n: np.uint64
) -> None:
    """Eigenvalues of Hessenberg matrices, by double shifts."""
    a = flat.reshape(d + 1, d + 1, LANES)
    stride = np.uint64((d + 1) * LANES)
    # Of each matrix: first and last row of its window, and the first column of its double step.
    state, f = np.zeros(5 * LANES), np.zeros(3 * LANES)
    low, high = state[:LANES], state[LANES : 2 * LANES]
    high_norm = np.zeros(2 * LANES)
    norm, sweeps = np.zeros(LANES), np.zeros(LANES, np.int64)
    for j in range(d):
        for i in range(d):
            for lane in range(LANES):
                norm[lane] = max(norm[lane], abs(a[j, i, lane]))
    high[:] = d - 1
    high_norm[LANES:] = _FLOOR * norm
    top = d - 1
    while True:
        high_norm[:LANES] = high
        _find_windows(flat, low, high_norm, np.uint64(top), stride, n)
        top, bottom = -1, d
        for lane in range(LANES):
            m, h = int(low[lane]), int(high[lane])
            while h >= 0 and m >= h - 1:
                if m == h:
                    real[h, lane], imag[h, lane] = a[h, h, lane], 0.0
                    h -= 1
                else:
                    _take_pair(a, real, imag, h, lane)
                    h -= 2
                sweeps[lane] = 0
                m = max(h, 0)
                while m > 0 and not _negligible(
                    a[m - 1, m, lane], a[m - 1, m - 1, lane], a[m, m, lane], norm[lane]
                ):
                    m -= 1
            if sweeps[lane] == _MOST_SWEEPS:
                converged[lane] = False
                h = -1
            high[lane] = h
            if h < 0:
                low[lane] = d
                continue
            low[lane] = m
            top, bottom = max(top, h), min(bottom, m)
            sweeps[lane] += 1
            if m > 0:
                a[m - 1, m, lane] = 0.0
            _start_sweep(a, state, m, h, lane, sweeps[lane] in _UNUSUAL)
        if top < 0:
            return
        for k in range(bottom, top):
            before = np.uint64((max(k - 1, 0) * (d + 1) + k) * LANES)
            _reflections(f, flat, state, float(k), before, n)
            _reflect_rows(flat, f, np.uint64((k * (d + 1) + k) * LANES), stride, np.uint64(top + 1 - k), n)
            rows = np.uint64(min(k + 3, top) + 1 - bottom)
            _reflect_columns(flat, f, np.uint64((k * (d + 1) + bottom) * LANES), stride, rows, n)


def _eigenvalues(
    matrices: FloatArray, real: FloatArray, imag: FloatArray, converged: NDArray[np.bool_]
) -> None:
    """Write the eigenvalues of matrices (V, d, d) to `real` and `imag` (V, d), and which have converged to (V,)."""
    count, d, n = matrices.shape[0], matrices.shape[1], np.uint64(LANES)
    flat = np.zeros((d + 1) * (d + 1) * LANES)
    a = flat.reshape(d + 1, d + 1, LANES)
    own_real, own_imag, nothing = np.zeros((d, LANES)), np.zeros((d, LANES)), np.zeros(0)
    fine = np.ones(LANES, np.bool_)
    for start in range(0, count, LANES):
        a[d] = 0.0
        a[:, d] = 0.0
        for lane in range(LANES):
            fine[lane] = True
            matrix = matrices[min(start + lane, count - 1)]
            for i in range(d):
                for j in range(d):
                    a[j, i, lane] = matrix[i, j]
        _balance(flat, d, n)
        reduce(flat, nothing, d, n)
        _francis(flat, d, own_real, own_imag, fine, n)
        for lane in range(min(LANES, count - start)):
            converged[start + lane] = fine[lane]
            for k in range(d):
                real[start + lane, k], imag[start + lane, k] = own_real[k, lane], own_imag[k, lane]


eigenvalues = outer(_eigenvalues, "void(float64[:, :, ::1], float64[:, ::1], float64[:, ::1], boolean[::1])")
