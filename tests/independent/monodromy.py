"""Growth rates of M(t) q̈ + C(t) q̇ + K(t) q = 0 from monodromy matrices by DOP853, and fitted orders."""

import math
from itertools import pairwise

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

TURN = 2 * np.pi


# Truth that shares nothing with the package: monodromy matrices of M(t) q̈ + C(t) q̇ + K(t) q = 0 by DOP853.
def floquet_growth(matrices, frequency):
    """Growth rate [1/s]; matrices(phase) gives M, C, K at the phase ωt."""
    n = len(matrices(0.0)[0])
    period = TURN / frequency

    def rate(time, flat):
        mass, damping, stiffness = matrices(frequency * time)
        q, v = flat.reshape(2, n, 2 * n)
        return np.concatenate([v, -np.linalg.solve(mass, damping @ v + stiffness @ q)]).ravel()

    result = solve_ivp(rate, (0, period), np.eye(2 * n).ravel(), method="DOP853", rtol=1e-11, atol=1e-13)
    multipliers = np.linalg.eigvals(result.y[:, -1].reshape(2 * n, 2 * n))
    return math.log(np.abs(multipliers).max()) / period


def floquet_border(matrices, guess, outside, level=0.0):
    return brentq(lambda w: floquet_growth(matrices, w) - level, guess, outside, xtol=1e-9)


def fitted_order(sizes, errors):
    return np.polyfit(np.log(sizes), np.log(errors), 1)[0]


def pieces_growth(rate, size, period, edges):
    """Growth rate of ẋ = rate(time, x), integrated piece by piece between instants where it jumps."""
    state = np.eye(size).ravel()
    for start, stop in pairwise(edges):
        result = solve_ivp(
            lambda t, flat: rate(t, flat.reshape(size, -1)).ravel(),
            (start * period, stop * period),
            state,
            method="DOP853",
            rtol=1e-11,
            atol=1e-13,
        )
        state = result.y[:, -1]
    return math.log(np.abs(np.linalg.eigvals(state.reshape(size, size))).max()) / period
