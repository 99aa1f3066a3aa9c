"""Panels of a period and the Gauss rule on them.

A panel is a part of the period on which everything is smooth: panels end at the breakpoints, and are short against the
fastest motion.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from facegear.support.quadrature import gauss_legendre, legendre_from_values
from facegear.support.types import FloatArray

# Parts of a period beyond which a motion is too fast to follow.
_MOST_PARTS = 2**17


@lru_cache(maxsize=16)
def gauss_rule(nodes: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Gauss-Legendre nodes and weights on [0, 1], and a_ij = ∫_0^{x_i} l_j, shape (nodes, nodes)."""
    x, weights = gauss_legendre(nodes)
    degrees = np.arange(nodes)
    legendre = np.polynomial.legendre.legvander(x, nodes)
    # ∫_{-1}^x P_d = (P_{d+1} − P_{d−1})/(2d+1)
    integrals = np.empty((nodes, nodes))
    integrals[:, 0] = x + 1.0
    integrals[:, 1:] = (legendre[:, 2:] - legendre[:, : nodes - 1]) / (2 * degrees[1:] + 1)
    return (x + 1.0) / 2.0, weights / 2.0, integrals @ legendre_from_values(nodes) / 2.0


def within_reach(parts: float) -> int:
    """Return a number of parts of the period, rounded up, if it is one that a computer has room for.

    Raises
    ------
    ArithmeticError
        If there are too many, or infinitely many.
    """
    if not parts <= _MOST_PARTS:
        raise ArithmeticError(
            f"the period is too long for the fastest motion: it takes {parts:.2g} steps, more than {_MOST_PARTS}; the "
            "stiffness over the mass must be smaller, or the period shorter"
        )
    return int(np.ceil(parts))


def panel_edges(breakpoints: FloatArray, angle: float, panel_angle: float) -> FloatArray:
    """Return ends of panels: all breakpoints, and points between for a fastest motion of `angle` a period."""
    within_reach(angle / panel_angle)
    ends = np.append(breakpoints[1:], 1.0)
    counts = np.ceil((ends - breakpoints) * angle / panel_angle).astype(int)
    pieces = [
        np.linspace(start, end, max(int(count), 1), endpoint=False)
        for start, end, count in zip(breakpoints, ends, counts, strict=True)
    ]
    return np.append(np.concatenate(pieces), 1.0)
