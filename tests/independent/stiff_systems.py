"""Multipliers of small systems whose load is constant on two parts of the period, with any number of digits.

The product of two matrix exponentials in mpmath: no code of the package, and no rounding that matters.
"""

import mpmath
import numpy as np

from facegear.floquet.loads import ContactLoad
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev

KINDS = ("undamped", "damped", "overdamped", "stiff", "contact", "rigid")


def random_system(rng: np.random.Generator, kind: str) -> PeriodicSystem:
    """One or two coordinates, frequencies over two decades, periods over more, one load that steps."""
    size = int(rng.integers(1, 3))
    turn = np.linalg.qr(rng.normal(size=(size, size)))[0]
    squares = 100.0 ** rng.uniform(-1, 1, size=size)
    shape = rng.normal(size=size)
    strength, damper, low = 10.0 ** rng.uniform(-2, 1.5), 0.0, -rng.uniform(0, 1)
    dampings = np.zeros(size)
    if kind == "damped":
        dampings = rng.uniform(0, 0.05) * squares
    elif kind == "overdamped":
        dampings = 10.0 ** rng.uniform(0, 3, size=size)
    elif kind == "stiff":
        dampings = 10.0 ** rng.uniform(2, 8, size=size)
    elif kind == "contact":
        damper, low = 10.0 ** rng.uniform(0, 6), 0.0
    elif kind == "rigid":
        squares[0] = 0.0
        shape = turn[:, -1] if size > 1 else shape
        strength = strength if size > 1 else 0.0
    damping, stiffness = (turn @ np.diag(values) @ turn.T for values in (dampings, squares))
    wave = PiecewiseChebyshev(np.array([0.0, rng.uniform(0.1, 0.9)]), np.array([1.0, low])[:, None, None])
    load = ContactLoad(
        PiecewiseChebyshev.constant(shape / np.linalg.norm(shape)), strength, damper, weight=wave
    )
    period = 10.0 ** rng.uniform(-1, 1.3)
    return PeriodicSystem(
        np.eye(size), (damping + damping.T) / 2, (stiffness + stiffness.T) / 2, (load,), period
    )


def multipliers(system: PeriodicSystem, digits: int = 40) -> np.ndarray:
    """Floquet multipliers, largest modulus first, shape (2n,)."""
    (load,), n = system.loads, system.size
    assert load.weight is not None
    with mpmath.workdps(digits):
        shape = [mpmath.mpf(float(x)) for x in load.shape.coefficients[0, 0]]
        ends = [mpmath.mpf(float(x)) for x in (*load.weight.breakpoints, 1.0)]
        product = mpmath.eye(2 * n)
        for piece in range(2):
            weight = mpmath.mpf(float(load.weight.coefficients[piece, 0, 0]))
            state = mpmath.zeros(2 * n)
            for i in range(n):
                state[i, n + i] = 1
                for j in range(n):
                    share = weight * shape[i] * shape[j]
                    state[n + i, j] = -(mpmath.mpf(float(system.stiffness[i, j])) + share * load.stiffness)
                    state[n + i, n + j] = -(mpmath.mpf(float(system.damping[i, j])) + share * load.damping)
            product = (
                mpmath.expm(state * ((ends[piece + 1] - ends[piece]) * mpmath.mpf(system.period))) * product
            )
        found = np.array([complex(value) for value in mpmath.eig(product, left=False, right=False)])
    return found[np.argsort(-np.abs(found))]
