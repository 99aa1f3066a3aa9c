"""Hsu's criterion in numbers: the twins of :mod:`facegear.symbolic.hsu`, by the kind of resonance."""

from collections.abc import Callable
from typing import Any, Literal

import numpy as np

from facegear.symbolic import twins

Kind = Literal["sum", "difference", "single"]

_GROWTH_RATES: dict[Kind, Callable[..., Any]] = {
    "sum": twins.growth_rate_sum,
    "difference": twins.growth_rate_difference,
    "single": twins.growth_rate_single,
}


def growth_rate_function(kind: Kind) -> Callable[..., Any]:
    """NumPy twin of ``hsu.derive(kind).growth_rate``; its arguments are those of ``hsu.arguments(kind)``."""
    return _GROWTH_RATES[kind]


def border_function() -> Callable[[float, float, float, float], tuple[float, float]]:
    """Numeric twin of ``hsu.border_detunings``: (f⁰_kk, f⁰_jj, P, Q) to (lower, upper) Λ [rad/s], NaN if stable.

    Both damping coefficients have to be positive.
    """
    return _borders


def _borders(f_k: float, f_j: float, real: float, imag: float) -> tuple[float, float]:
    with np.errstate(invalid="ignore"):
        lower, upper = twins.border_detunings(*map(np.float64, (f_k, f_j, real, imag)))
    return float(lower), float(upper)
