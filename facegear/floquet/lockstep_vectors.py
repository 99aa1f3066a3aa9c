"""Eigenvectors of many real matrices in lockstep, compiled: what :mod:`facegear.floquet.eigenvectors` calls.

Inverse iteration on the Hessenberg form, as LAPACK's ``hsein`` has it: with the eigenvalue λ known, H − λ is brought to
a triangle once, by elimination with exchange of rows, and solved for a column, a row, a column and a row in turn. Each
solution is the right hand side that suits the next best.

Buffers as in :mod:`facegear.floquet.lockstep`; of a complex number the real parts of all lanes lie before the imaginary
ones.
"""

from __future__ import annotations

import numpy as np

from facegear.floquet.compiled import LANES
from facegear.floquet.lockstep import inner, outer, reduce
from facegear.support.types import FloatArray

_N, _ONE, _TWO = np.uint64(LANES), np.uint64(1), np.uint64(2)
_EPS = float(np.finfo(float).eps)
# A solution that grows by this part of 1/(ε ‖A‖) is a vector already: (A − λ) x is a hundred roundings of A or fewer.
_NEAR = 0.01


@inner
def _eliminate(
    u: FloatArray,
    steps: FloatArray,
    row: FloatArray,
    h: FloatArray,
    shift: FloatArray,
    least: FloatArray,
    d: np.uint64,
) -> None:
    """Bring H − λ to the triangle u, with the inverse of its diagonal; a step is a factor and whether rows exchange.

    `h` has the matrix row by row. No entry of the diagonal is smaller than `least`.
    """
    for j in range(d):
        at, to = j * _N, j * _TWO * _N
        for lane in range(_N):
            row[to + lane] = h[at + lane]
            row[to + _N + lane] = 0.0
    for lane in range(_TWO * _N):
        row[lane] -= shift[lane]
    for k in range(d):
        head, diagonal, below = k * _TWO * _N, k * (d + _ONE) * _TWO * _N, ((k + _ONE) * d + k) * _N
        step = k * np.uint64(3) * _N
        last = k + _ONE == d
        for lane in range(_N):
            s = 0.0 if last else h[below + lane]
            p, q = row[head + lane], row[head + _N + lane]
            small = max(abs(p), abs(q)) < least[lane]
            p, q = least[lane] if small else p, 0.0 if small else q
            swap = abs(s) > max(abs(p), abs(q))
            pivot, other = s if swap else p, 0.0 if swap else q
            square = 1.0 / (pivot * pivot + other * other)
            pivot, other = pivot * square, -other * square
            u[diagonal + lane] = pivot
            u[diagonal + _N + lane] = other
            p, q = p if swap else s, q if swap else 0.0
            steps[step + lane] = p * pivot - q * other
            steps[step + _N + lane] = p * other + q * pivot
            steps[step + _TWO * _N + lane] = 1.0 if swap else 0.0
        if last:
            return
        for j in range(k + _ONE, d):
            to, at, below = j * _TWO * _N, (k * d + j) * _TWO * _N, ((k + _ONE) * d + j) * _N
            there = 1.0 if j == k + _ONE else 0.0
            for lane in range(_N):
                s, c = h[below + lane] - there * shift[lane], -there * shift[_N + lane]
                p, q = row[to + lane], row[to + _N + lane]
                swap = steps[step + _TWO * _N + lane] != 0.0
                a, b = s if swap else p, c if swap else q
                p, q = p if swap else s, q if swap else c
                real, imag = steps[step + lane], steps[step + _N + lane]
                u[at + lane] = a
                u[at + _N + lane] = b
                row[to + lane] = p - (real * a - imag * b)
                row[to + _N + lane] = q - (real * b + imag * a)


@inner
def _solve_triangle(x: FloatArray, u: FloatArray, total: FloatArray, d: np.uint64) -> None:
    """Replace a column x by u⁻¹ x."""
    for i in range(d):
        k = d - _ONE - i
        at = k * (d + _ONE) * _TWO * _N
        for lane in range(_TWO * _N):
            total[lane] = 0.0
        entry, place = at + _TWO * _N, (k + _ONE) * _TWO * _N
        for _ in range(i // _TWO):
            for lane in range(_N):
                p, q, a, b = u[entry + lane], u[entry + _N + lane], x[place + lane], x[place + _N + lane]
                r, s = u[entry + _TWO * _N + lane], u[entry + np.uint64(3) * _N + lane]
                f, g = x[place + _TWO * _N + lane], x[place + np.uint64(3) * _N + lane]
                total[lane] += p * a - q * b + (r * f - s * g)
                total[_N + lane] += p * b + q * a + (r * g + s * f)
            entry += np.uint64(4) * _N
            place += np.uint64(4) * _N
        if i % _TWO:
            for lane in range(_N):
                p, q, a, b = u[entry + lane], u[entry + _N + lane], x[place + lane], x[place + _N + lane]
                total[lane] += p * a - q * b
                total[_N + lane] += p * b + q * a
        place = k * _TWO * _N
        for lane in range(_N):
            p, q = u[at + lane], u[at + _N + lane]
            a, b = x[place + lane] - total[lane], x[place + _N + lane] - total[_N + lane]
            x[place + lane] = p * a - q * b
            x[place + _N + lane] = p * b + q * a


@inner
def _solve_column(x: FloatArray, u: FloatArray, steps: FloatArray, total: FloatArray, d: np.uint64) -> None:
    """Replace a column x by (H − λ)⁻¹ x."""
    for k in range(d - _ONE):
        step, at = k * np.uint64(3) * _N, k * _TWO * _N
        below = at + _TWO * _N
        for lane in range(_N):
            swap = steps[step + _TWO * _N + lane] != 0.0
            real, imag = steps[step + lane], steps[step + _N + lane]
            p, q, r, s = x[at + lane], x[at + _N + lane], x[below + lane], x[below + _N + lane]
            a, b = r if swap else p, s if swap else q
            r, s = p if swap else r, q if swap else s
            x[at + lane] = a
            x[at + _N + lane] = b
            x[below + lane] = r - (real * a - imag * b)
            x[below + _N + lane] = s - (real * b + imag * a)
    _solve_triangle(x, u, total, d)


@inner
def _solve_row(y: FloatArray, u: FloatArray, steps: FloatArray, own: FloatArray, d: np.uint64) -> None:
    """Replace a row y by y (H − λ)⁻¹."""
    for k in range(d):
        at, place = np.uint64(k) * (d + _ONE) * _TWO * _N, np.uint64(k) * _TWO * _N
        for lane in range(_N):
            p, q, a, b = u[at + lane], u[at + _N + lane], y[place + lane], y[place + _N + lane]
            own[lane] = p * a - q * b
            own[_N + lane] = p * b + q * a
            y[place + lane] = own[lane]
            y[place + _N + lane] = own[_N + lane]
        for _ in range(k + _ONE, d):
            at += _TWO * _N
            place += _TWO * _N
            for lane in range(_N):
                p, q, a, b = u[at + lane], u[at + _N + lane], own[lane], own[_N + lane]
                y[place + lane] -= p * a - q * b
                y[place + _N + lane] -= p * b + q * a
    for i in range(d - _ONE):
        before = d - _TWO - i
        step, at = before * np.uint64(3) * _N, before * _TWO * _N
        below = at + _TWO * _N
        for lane in range(_N):
            swap = steps[step + _TWO * _N + lane] != 0.0
            real, imag = steps[step + lane], steps[step + _N + lane]
            r, s = y[below + lane], y[below + _N + lane]
            p, q = y[at + lane] - (real * r - imag * s), y[at + _N + lane] - (real * s + imag * r)
            y[at + lane] = r if swap else p
            y[at + _N + lane] = s if swap else q
            y[below + lane] = p if swap else r
            y[below + _N + lane] = q if swap else s


@inner
def _scale(x: FloatArray, size: FloatArray, sign: float, d: np.uint64) -> None:
    """Divide by the largest entry, which is put into `size`, and multiply imaginary parts by a sign."""
    for lane in range(_N):
        size[lane] = 0.0
    at = np.uint64(0)
    for _ in range(_TWO * d):
        for lane in range(_N):
            size[lane] = max(size[lane], abs(x[at + lane]))
        at += _N
    for lane in range(_N):
        size[_N + lane] = 1.0 / size[lane]
    at = np.uint64(0)
    for _ in range(d):
        for lane in range(_N):
            x[at + lane] *= size[_N + lane]
            x[at + _N + lane] *= size[_N + lane] * sign
        at += _TWO * _N


@inner
def _turn_back(x: FloatArray, kept: FloatArray, total: FloatArray, d: np.uint64) -> None:
    """Apply the reflections to a vector of the Hessenberg form."""
    for i in range(d - _TWO if d > _TWO else np.uint64(0)):
        k = d - np.uint64(3) - i
        start, t = k * (d + _ONE) * _N, (k * (d + _ONE) + d) * _N
        for lane in range(_TWO * _N):
            total[lane] = 0.0
        for j in range(k + _ONE, d):
            at, place = start + j * _N, j * _TWO * _N
            for lane in range(_N):
                total[lane] += kept[at + lane] * x[place + lane]
                total[_N + lane] += kept[at + lane] * x[place + _N + lane]
        for lane in range(_N):
            total[lane] *= kept[t + lane]
            total[_N + lane] *= kept[t + lane]
        for j in range(k + _ONE, d):
            at, place = start + j * _N, j * _TWO * _N
            for lane in range(_N):
                x[place + lane] -= kept[at + lane] * total[lane]
                x[place + _N + lane] -= kept[at + lane] * total[_N + lane]


def _eigenvectors(
    matrices: FloatArray,
    real: FloatArray,
    imag: FloatArray,
    right: FloatArray,
    left: FloatArray,
    growth: FloatArray,
) -> None:
    """Write vectors of matrices (V, d, d) with eigenvalues (V, m) to (V, 2, m, d), and the least growth in a solution.

    The largest entry of a vector is 1; what is left of (A − λ) x is as large as the inverse of the growth (V, m).
    """
    count, size, values = matrices.shape[0], matrices.shape[1], real.shape[1]
    d = np.uint64(size)
    flat = np.zeros((size + 1) * (size + 1) * LANES)
    a = flat.reshape(size + 1, size + 1, LANES)
    h, kept = np.zeros(size * size * LANES), np.zeros(size * (size + 1) * LANES)
    u, steps, row = (
        np.zeros(2 * size * size * LANES),
        np.zeros(3 * size * LANES),
        np.zeros(2 * size * LANES),
    )
    x, y = np.zeros(2 * size * LANES), np.zeros(2 * size * LANES)
    x_of, y_of = x.reshape(size, 2, LANES), y.reshape(size, 2, LANES)
    total, shift = np.zeros(2 * LANES), np.zeros(2 * LANES)
    x_size, y_size, least = np.zeros(2 * LANES), np.zeros(2 * LANES), np.zeros(LANES)
    for start in range(0, count, LANES):
        for lane in range(LANES):
            matrix = matrices[min(start + lane, count - 1)]
            for i in range(size):
                for j in range(size):
                    a[j, i, lane] = matrix[i, j]
        a[size] = 0.0
        a[:, size] = 0.0
        reduce(flat, kept, size, _N)
        least[:] = 1e-300
        for i in range(size):
            for j in range(size):
                to = (i * size + j) * LANES
                for lane in range(LANES):
                    h[to + lane] = a[j, i, lane]
                    least[lane] = max(least[lane], _EPS * abs(a[j, i, lane]))
        for k in range(values):
            for lane in range(LANES):
                own = min(start + lane, count - 1)
                shift[lane], shift[LANES + lane] = real[own, k], imag[own, k]
            _eliminate(u, steps, row, h, shift, least, d)
            x[:] = 1.0
            _solve_triangle(x, u, total, d)
            _scale(x, x_size, -1.0, d)
            y[:] = x
            _solve_row(y, u, steps, total, d)
            _scale(y, y_size, -1.0, d)
            near = True
            for lane in range(LANES):
                near &= min(x_size[lane], y_size[lane]) * least[lane] >= _NEAR
            if near:
                _scale(y, total, -1.0, d)
            else:
                x[:] = y
                _solve_column(x, u, steps, total, d)
                _scale(x, x_size, -1.0, d)
                y[:] = x
                _solve_row(y, u, steps, total, d)
                _scale(y, y_size, 1.0, d)
            # Conjugate for the row, and back.
            _scale(x, total, -1.0, d)
            _turn_back(x, kept, total, d)
            _turn_back(y, kept, total, d)
            for lane in range(min(LANES, count - start)):
                growth[start + lane, k] = min(x_size[lane], y_size[lane])
                for part in range(2):
                    for i in range(size):
                        right[start + lane, part, k, i] = x_of[i, part, lane]
                        left[start + lane, part, k, i] = y_of[i, part, lane]


eigenvectors = outer(
    _eigenvectors,
    "void(float64[:,:,::1], float64[:,::1], float64[:,::1], float64[:,:,:,::1], float64[:,:,:,::1], float64[:,::1])",
)
