"""Measured characteristic exponents and their errors: what is refused, how they scatter, and whether as they must."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.stats import chi2

from facegear.support.parameters import finite_array, integer_at_least
from facegear.support.types import ComplexArray, FloatArray


def checked_deviations(deviations: ArrayLike, motions: int) -> FloatArray:
    """Return standard deviations of decay rate and frequency of each motion, shape (motions, 2)."""
    try:
        sizes = np.array(deviations, dtype=float)
    except (TypeError, ValueError):
        raise TypeError(
            f"deviations must be real numbers, shape ({motions}, 2), got {deviations!r}"
        ) from None
    if sizes.shape != (motions, 2):
        raise ValueError(
            f"deviations must have shape ({motions}, 2), of decay rate and frequency of each motion; got shape "
            f"{sizes.shape}"
        )
    if np.isnan(sizes).any() or (sizes <= 0.0).any() or np.isinf(sizes).all():
        raise ValueError(
            "deviations must be greater than 0, infinite where nothing is measured, not all of them; got "
            f"{sizes.tolist()}"
        )
    return sizes


def checked_exponents(name: str, exponents: ArrayLike, motions: int | None = None) -> ComplexArray:
    """Return finite complex numbers, one a motion."""
    wanted = (
        "finite exponents, one a motion" if motions is None else f"{motions} finite exponents, one a motion"
    )
    try:
        values = np.array(exponents, dtype=complex)
    except (TypeError, ValueError):
        raise TypeError(f"{name} must be {wanted}; got {exponents!r}") from None
    if values.ndim != 1 or len(values) != (motions or len(values)) or not np.isfinite(values).all():
        raise ValueError(f"{name} must be {wanted}; got {values.tolist()}")
    return values


def drawn(exponents: ArrayLike, deviations: ArrayLike, count: int, seed: int) -> ComplexArray:
    """Draw measurements with independent normal errors, none where the deviation is infinite, shape (count, m).

    Parameters
    ----------
    exponents : array_like of complex, shape (m,)
    deviations : array_like, shape (m, 2)
        As for :class:`Survey`.
    count : int
        1 or more.
    seed : int
        0 or greater.

    Raises
    ------
    TypeError, ValueError
        Naming the argument and what would be valid.
    """
    values = checked_exponents("exponents", exponents)
    sizes = checked_deviations(deviations, len(values))
    rng = np.random.default_rng(integer_at_least("seed", seed, 0))
    errors = rng.normal(size=(integer_at_least("count", count, 1), len(sizes), 2))
    errors *= np.where(np.isfinite(sizes), sizes, 0.0)
    return np.asarray(values + errors[..., 0] + 1j * errors[..., 1], dtype=complex)


def scatter_over_bound(losses: ArrayLike, truth: ArrayLike, bound: ArrayLike) -> tuple[float, float, float]:
    """Mean square of standardised errors of losses over their number, 1 where the bound is attained, with 95 % limits.

    Parameters
    ----------
    losses : array_like, shape (D, P)
        Told from D measurements, 1 or more.
    truth : array_like, shape (P,)
    bound : array_like, shape (P, P)
        Positive definite.

    Returns
    -------
    ratio, low, high : float
        The sum of squares of a sample of normal errors at the bound is χ² with D P degrees of freedom, which gives the
        limits.

    Raises
    ------
    TypeError, ValueError
        Naming the argument and what would be valid.
    """
    told, right, least = (
        finite_array(name, array) for name, array in (("losses", losses), ("truth", truth), ("bound", bound))
    )
    if told.ndim != 2 or told.size == 0:
        raise ValueError(f"losses must have shape (D, P), one measurement or more, got {told.shape}")
    size = told.shape[1]
    if right.shape != (size,):
        raise ValueError(f"truth must have shape ({size},), one a loss, got {right.shape}")
    if least.shape != (size, size) or not (np.linalg.eigvalsh(least) > 0.0).all():
        raise ValueError(f"bound must be a positive definite matrix ({size}, {size}), got {least.tolist()}")
    errors = np.linalg.solve(np.linalg.cholesky(least), (told - right).T)
    total, free = float((errors**2).sum()), errors.size
    low, high = chi2.ppf([0.975, 0.025], free)
    return total / free, total / float(low), total / float(high)
