"""What loads along a contact line move along it: influence of both teeth, as series in place and in the line's age."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.polynomial import chebyshev

from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.mechanics.compliance import Lines
from facegear.mechanics.elastic_teeth import Tooth
from facegear.mechanics.slices import Slices
from facegear.support.types import FloatArray

# Error of the influence as a series in the age of lines, relative to the largest, and points on each line.
_NEGLIGIBLE, _POINTS = 1e-9, 22
# Chebyshev points of lines, and what makes series of values there.
_PLACES = chebyshev.chebpts1(_POINTS)
# Where each pair of polynomials is in the triangle above the diagonal.
_TRIANGLE = np.triu_indices(_POINTS)
_SQUARE = np.zeros((_POINTS, _POINTS), dtype=int)
_SQUARE[_TRIANGLE] = _SQUARE.T[_TRIANGLE] = np.arange(_TRIANGLE[0].size)
_TO_SLOPES = chebyshev.chebder(np.eye(_POINTS))
_TO_SERIES = np.linalg.inv(chebyshev.chebvander(_PLACES, _POINTS - 1))


def influence_on_lines(slices: Slices, teeth: tuple[Tooth, ...], lines: Lines) -> FloatArray:
    """Influence of teeth on lines (P,), as double Chebyshev series from end to end, (P, n, n) [m/N].

    Parameters
    ----------
    slices : Slices
    teeth : tuple of Tooth
        None for teeth that do not bend.
    lines : Lines, shape (P,)
    """
    if not teeth:
        return np.zeros((lines.age.size, _POINTS, _POINTS))
    fraction = np.clip(lines.age, 0.0, slices.sweep) / (slices.sweep + 1.0)
    return np.asarray(_influence(slices, teeth)(fraction)[:, _SQUARE])


@lru_cache(maxsize=64)
def _influence(slices: Slices, teeth: tuple[Tooth, ...]) -> PiecewiseChebyshev:
    """Influence on lines of all teeth together, against age as :attr:`Slices.breakpoints` count it [m/N].

    On each line it is a double Chebyshev series from end to end, of which the triangle above the diagonal is kept.
    """
    whole = slices.sweep + 1.0

    def along_lines(fraction: FloatArray, piece: int) -> FloatArray:
        ages = np.minimum(fraction * whole, slices.sweep)
        inner, outer = slices.ends(ages)
        middle, half = 0.5 * (inner + outer), 0.5 * (outer - inner)
        where = slices.generated(middle[:, np.newaxis] + half[:, np.newaxis] * _PLACES, ages[:, np.newaxis])
        total = np.zeros((ages.size, _POINTS, _POINTS))
        for tooth in teeth:
            series = _TO_SERIES @ tooth.plate.influence_factor(tooth.load(*where))
            total += series @ series.swapaxes(1, 2)
        return total[:, *_TRIANGLE]

    edges = np.append(slices.breakpoints, slices.sweep) / whole
    # On pieces next to a square root it counts by the duration.
    tolerance = _NEGLIGIBLE * np.maximum(1.0, 1e-3 / np.diff(edges, append=1.0))
    return PiecewiseChebyshev.fit(along_lines, edges, tolerance=tolerance)


def _local(s: FloatArray, lines: Lines) -> tuple[FloatArray, FloatArray]:
    """Slices (P, n) on their lines from -1 to 1, and half the length of these, (P, 1)."""
    half = 0.5 * (lines.outer - lines.inner)[:, np.newaxis]
    half = np.where(half > 0.0, half, 1.0)
    return (s - 0.5 * (lines.inner + lines.outer)[:, np.newaxis]) / half, half


def polynomials(s: FloatArray, lines: Lines) -> FloatArray:
    """Chebyshev polynomials on lines at slices, (P, n, degrees)."""
    return np.asarray(chebyshev.chebvander(_local(s, lines)[0], _POINTS - 1))


def polynomial_slopes(s: FloatArray, lines: Lines) -> FloatArray:
    """Slopes of Chebyshev polynomials on lines at slices, (P, n, degrees) [1/√m]."""
    local, half = _local(s, lines)
    return np.asarray(chebyshev.chebvander(local, _POINTS - 2) @ _TO_SLOPES / half[..., np.newaxis])
