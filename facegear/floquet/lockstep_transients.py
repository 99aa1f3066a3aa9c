"""Runge-Kutta steps through clearances, compiled: what :mod:`facegear.floquet.transients` calls.

One motion after the other, each for all its periods: what a step reads of the system fits in a cache.
"""

from __future__ import annotations

import numpy as np

from facegear.floquet.lockstep import inner, outer
from facegear.support.types import FloatArray


@inner
def _rate(
    out: FloatArray,
    read: FloatArray,
    state: FloatArray,
    reading: FloatArray,
    known: FloatArray,
    row: FloatArray,
) -> None:
    """Put the rates of one state into `out`; `read` is room for what loads and shafts read of it."""
    n, loads = row.shape[1], row.shape[0]
    for j in range(read.size):
        read[j] = known[j]
    for i in range(2 * n):
        for j in range(read.size):
            read[j] += state[i] * reading[i, j]
    for i in range(n):
        out[i] = state[n + i]
        out[n + i] = read[2 * loads + i]
    for number in range(loads):
        if read[number] > 0.0:
            for i in range(n):
                out[n + i] -= read[loads + number] * row[number, i]


def _follow(
    lengths: FloatArray,
    reading: FloatArray,
    known: FloatArray,
    row: FloatArray,
    states: FloatArray,
    ends: FloatArray,
    periods: int,
) -> None:
    """Follow states (m, 2n) for some periods, into the states at the end of the last of them, (kept, m, 2n).

    Steps (S,), and of their three stages what is read (S, 3, 2n, 2p + n), known (S, 3, 2p + n) and pushed
    (S, 3, p, n).
    """
    size, kept = states.shape[1], ends.shape[0]
    state, at, total, rate = np.empty(size), np.empty(size), np.empty(size), np.empty(size)
    read = np.empty(known.shape[2])
    for number in range(states.shape[0]):
        state[:] = states[number]
        for period in range(periods):
            for step in range(lengths.size):
                h = lengths[step]
                _rate(rate, read, state, reading[step, 0], known[step, 0], row[step, 0])
                for i in range(size):
                    total[i] = rate[i]
                    at[i] = state[i] + h / 2.0 * rate[i]
                _rate(rate, read, at, reading[step, 1], known[step, 1], row[step, 1])
                for i in range(size):
                    total[i] += 2.0 * rate[i]
                    at[i] = state[i] + h / 2.0 * rate[i]
                _rate(rate, read, at, reading[step, 1], known[step, 1], row[step, 1])
                for i in range(size):
                    total[i] += 2.0 * rate[i]
                    at[i] = state[i] + h * rate[i]
                _rate(rate, read, at, reading[step, 2], known[step, 2], row[step, 2])
                for i in range(size):
                    state[i] += h / 6.0 * (total[i] + rate[i])
            if period >= periods - kept:
                ends[period - (periods - kept), number] = state


follow = outer(
    _follow,
    "void(float64[::1], float64[:, :, :, ::1], float64[:, :, ::1], float64[:, :, :, ::1], float64[:, ::1], "
    "float64[:, :, ::1], int64)",
)
