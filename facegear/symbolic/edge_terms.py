"""Sums of closed-form terms that hold a disk at its bore and load its rim, with as many digits as asked for.

Their arithmetic is that of mpmath, in which they are evaluated: terms of very different size cancel.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import mpmath

Numeric = Callable[..., Sequence[Any]]
"""U, V, S, T, H of one term as a function of mpmath."""


def loaded_at_rim(
    columns: Callable[[Any], list[Sequence[Any]]], harmonic: int, radii: Sequence[float], bore_ratio: float
) -> list[list[float]]:
    """S, T, H of one harmonic for τ_k = 1 at the rim, the bore held.

    Parameters
    ----------
    columns : callable
        Radius over the outer one to U, V, S, T, H of every term.
    harmonic : int
        k, from 0, where shear alone is loaded and the terms are two.
    radii : sequence of float
        x = r/a [-].
    bore_ratio : float
        c [-].

    Returns
    -------
    list of three lists
        S, T, H at the radii [-].
    """
    bore, rim = columns(bore_ratio), columns(1)
    held, loaded = ([1], [3]) if harmonic == 0 else ([0, 1], [2, 3])
    rows = [[column[i] for column in bore] for i in held]
    rows += [[column[i] for column in rim] for i in loaded]
    factors = _factors(rows, [0] * (len(rows) - 1) + [1])
    return _sums(factors, [columns(x) for x in radii])


def _factors(rows: Sequence[Sequence[Any]], loads: Sequence[int]) -> list[Any]:
    """Factors of the terms that meet the conditions at the edges; terms of very different size are scaled first."""
    scales = [max(abs(row[i]) for row in rows) for i in range(len(loads))]
    scaled = [[value / scale for value, scale in zip(row, scales, strict=True)] for row in rows]
    found = mpmath.lu_solve(mpmath.matrix(scaled), mpmath.matrix(list(loads)))
    return [value / scale for value, scale in zip(found, scales, strict=True)]


def _sums(factors: Any, columns: Sequence[Sequence[Sequence[Any]]]) -> list[list[float]]:
    """S, T, H at each radius from the factors of the terms and U, V, S, T, H of every term at each radius."""
    return [
        [
            float(mpmath.fdot((f, term[2 + place]) for f, term in zip(factors, terms, strict=True)))
            for terms in columns
        ]
        for place in range(3)
    ]
