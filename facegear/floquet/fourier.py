"""Fourier series of periodic matrices that are smooth between breakpoints (2-14)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from facegear.floquet.piecewise import merge_breakpoints, real_array
from facegear.support.parameters import integer_at_least
from facegear.support.types import FloatArray


@dataclass(frozen=True, eq=False)
class FourierSeries:
    """Periodic matrix F(x) = mean + Σ_s cosine[s-1] cos 2πsx + sine[s-1] sin 2πsx, s = 1 ... order.

    Attributes
    ----------
    mean : array, shape (rows, columns)
    cosine, sine : array, shape (order, rows, columns)
    """

    mean: FloatArray
    cosine: FloatArray
    sine: FloatArray

    def __call__(self, fraction: ArrayLike) -> FloatArray:
        """Value of the truncated series, shape (..., rows, columns)."""
        angle = (
            2.0
            * np.pi
            * np.multiply.outer(np.asarray(fraction, dtype=float), 1 + np.arange(len(self.cosine)))
        )
        return (
            self.mean
            + np.tensordot(np.cos(angle), self.cosine, axes=1)
            + np.tensordot(np.sin(angle), self.sine, axes=1)
        )

    def plus(self, factor: float, other: FourierSeries) -> FourierSeries:
        """Return this series and `factor` times another of the same order."""
        return FourierSeries(
            self.mean + factor * other.mean,
            self.cosine + factor * other.cosine,
            self.sine + factor * other.sine,
        )


@lru_cache(maxsize=64)
def _gauss_legendre(nodes: int) -> tuple[FloatArray, FloatArray]:
    """Nodes and weights on [-1, 1]."""
    x, weights = np.polynomial.legendre.leggauss(nodes)
    return x, weights


def fourier_series(
    function: Callable[[FloatArray], FloatArray],
    breakpoints: ArrayLike,
    order: int,
    *,
    tolerance: float = 1e-13,
) -> FourierSeries:
    """Fourier coefficients (2-14) of a periodic matrix function that is smooth between breakpoints.

    Gauss-Legendre quadrature on each piece, the number of nodes raised until two successive results agree, so
    jumps and kinks cost no accuracy.

    Parameters
    ----------
    function : callable
        ``function(fractions)``, shape (m,) -> (m, rows, columns).
    breakpoints : array_like
        Fractions in [0, 1) where the function is not smooth.
    order : int
        Highest harmonic.
    tolerance : float
        Largest change of a coefficient between the last two node counts, relative to the largest entry.

    Raises
    ------
    ValueError
        If `order` is not a whole number >= 1, or the quadrature does not settle with 600 nodes a piece.
    """
    order = integer_at_least("order", order, 1)
    edges = merge_breakpoints([real_array(breakpoints, "breakpoints", 1)])
    ends = np.append(edges[1:], edges[0] + 1.0)
    harmonics = np.arange(order + 1)

    def integrate(nodes: int) -> NDArray[np.complex128]:
        x, w = _gauss_legendre(nodes)
        half, middle = (ends - edges) / 2.0, (ends + edges) / 2.0
        points = (middle[:, None] + half[:, None] * x).ravel()
        kernel = np.exp(2j * np.pi * np.outer(harmonics, points)) * (half[:, None] * w).ravel()
        return np.tensordot(kernel, function(points), axes=1)

    # e^{i 2π s x} over a piece of length L adds degree π s L besides that of the function.
    nodes = 24 + int(np.ceil(np.pi * order * (ends - edges).max() / 2.0))
    coarse = integrate(nodes)
    while True:
        nodes = nodes * 3 // 2
        fine = integrate(nodes)
        scale = float(np.abs(fine).max())
        change = float(np.abs(fine - coarse).max())
        if change <= tolerance * max(scale, np.finfo(float).tiny):
            break
        if nodes > 600 + 4 * order:
            raise ValueError(
                f"function is not smooth between the breakpoints: its Fourier integrals still change by "
                f"{change / scale:.2g} with {nodes} nodes a piece"
            )
        coarse = fine
    return FourierSeries(mean=fine[0].real.copy(), cosine=2.0 * fine[1:].real, sine=2.0 * fine[1:].imag)
