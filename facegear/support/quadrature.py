"""Gauss and Legendre's nodes and weights on an interval."""

from __future__ import annotations

from numpy.polynomial import legendre

from facegear.support.types import FloatArray


def gauss(low: float, high: float, count: int) -> tuple[FloatArray, FloatArray]:
    """Nodes and weights of Gauss and Legendre on an interval.

    Parameters
    ----------
    low, high : float
        Its ends.
    count : int
        Of nodes; polynomials of degree 2 `count` − 1 are integrated exactly.

    Returns
    -------
    nodes, weights : ndarray, shape (count,)

    Examples
    --------
    >>> nodes, weights = gauss(0.0, 2.0, 2)
    >>> round(float(weights @ nodes**3), 12)
    4.0
    """
    nodes, weights = legendre.leggauss(count)
    return 0.5 * (low + high) + 0.5 * (high - low) * nodes, 0.5 * (high - low) * weights
