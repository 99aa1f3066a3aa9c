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


def integrated(system, forced=False):
    """Φ of a periodic system in (q, q̇) by DOP853, in momenta, which need neither φ̈ nor kicks; shape (2n, 2n).

    With `forced`, what forces and transmission errors make of a system at rest stands in one more column.
    """
    n, period = system.size, system.period
    columns = 2 * n + forced
    q, v = np.split(np.eye(2 * n, columns), 2)
    kicks = dict(system.velocity_kicks())
    one = np.zeros(columns)
    one[2 * n :] = 1.0

    def parts(x, side):
        """Mass, and of each load wφ, its slope, φ, φ', e, e' and e'', with the load."""
        found = []
        for load in system.loads:
            phi, slope = load.shape(x, side), load.slope(x, side) / period
            w, dw = np.ones(1), np.zeros(1)
            if load.weight is not None:
                w, dw = load.weight(x, side), load.weight.derivative()(x, side) / period
            error = np.zeros(3)
            if load.transmission_error is not None:
                error = np.array(
                    [load.transmission_error.derivative(i)(x, side)[0] / period**i for i in range(3)]
                )
            total = float(load.rate == "total")
            found.append((load, w * phi, dw * phi + w * slope, phi, total * slope, slope, error))
        return found

    def momenta(x, side, q, v):
        p = system.mass @ v
        for load, wphi, _, phi, rate, _, error in parts(x, side):
            p = p + load.mass * np.outer(wphi, phi @ v + rate @ q - error[1] * one)
        return p

    def velocities(found, q, p):
        mass, right = system.mass.copy(), p.copy()
        for load, wphi, _, phi, rate, _, error in found:
            mass += load.mass * np.outer(wphi, phi)
            right -= load.mass * np.outer(wphi, rate @ q - error[1] * one)
        return np.linalg.solve(mass, right)

    edges = np.append(system.breakpoints, 1.0)
    for start, stop in pairwise(edges):
        if start in kicks:
            v = velocities(parts(start, "right"), q, momenta(start, "left", q, v))
        for jump in system.jumps:
            if abs(jump.fraction - start) < 1e-12:
                q, v = np.split(jump.matrix @ np.concatenate([q, v]), 2)
        p = momenta(start, "right", q, v)
        middle = (start + stop) / 2.0

        def rate(t, flat, middle=middle):
            q, p = flat.reshape(2, n, columns)
            x = t / period
            side = "right" if x < middle else "left"
            found = parts(x, side)
            v = velocities(found, q, p)
            force = -system.damping @ v - system.stiffness @ q
            if forced and system.force is not None:
                force += np.outer(system.force(x, side), one)
            for load, wphi, dwphi, phi, moving, slope, error in found:
                u = phi @ q - error[0] * one
                du = phi @ v + moving @ q - error[1] * one
                force -= np.outer(wphi, load.damping * du + load.stiffness * u)
                force += load.mass * np.outer(dwphi, du)
                if load.rate == "frozen":
                    # ü = φᵀq̈ is d(φᵀq̇)/dt less φ̇ᵀq̇.
                    force += load.mass * np.outer(wphi, slope @ v)
            return np.concatenate([v, force]).ravel()

        size = np.abs(np.concatenate([q, p])).max()
        result = solve_ivp(
            rate,
            (start * period, stop * period),
            np.concatenate([q, p]).ravel(),
            method="DOP853",
            rtol=1e-13,
            atol=1e-14 * size,
        )
        q, p = result.y[:, -1].reshape(2, n, columns)
        v = velocities(parts(stop, "left"), q, p)
    return np.concatenate([q, v])
