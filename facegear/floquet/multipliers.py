"""Floquet analysis of periodic linear systems (section 2.2.1).

The state X = (q, q̇) after one period is Φ(T0, 0) X(0); the eigenvalues λ of the transition matrix Φ, the
Floquet multipliers, decide: the system is stable if and only if every |λ| ≤ 1 (2-5 to 2-8). Φ is computed by one of
the methods of :mod:`facegear.floquet.methods`.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from facegear.floquet.methods import Method, with_method
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.stepping import Family
from facegear.support.types import ComplexArray, FloatArray


def transition_matrix(system: PeriodicSystem, method: Method | None = None) -> FloatArray:
    """Floquet transition matrix Φ(T0, 0) of the state (q, q̇) (2-6).

    Parameters
    ----------
    system : PeriodicSystem
    method : Method, optional
        One of the methods of this module; see :func:`with_method` if left out.

    Returns
    -------
    array, shape (2n, 2n)
        Where the period's origin is a breakpoint with a velocity kick, Φ runs from just before it.

    Examples
    --------
    >>> import numpy as np
    >>> import facegear as fg
    >>> free = fg.PeriodicSystem([[1.0]], [[0.0]], [[1.0]], (), period=1.0)
    >>> bool(np.allclose(fg.transition_matrix(free), [[np.cos(1.0), np.sin(1.0)], [-np.sin(1.0), np.cos(1.0)]]))
    True
    """
    return np.asarray(transition_matrices([system], method)[0])


def transition_matrices(systems: Sequence[PeriodicSystem], method: Method | None = None) -> FloatArray:
    """Transition matrices of a family of systems with common size and breakpoints, computed together.

    Parameters
    ----------
    systems : sequence of PeriodicSystem
        V systems; their periods, constant matrices and load parameters may differ.
    method : Method, optional
        See :func:`with_method` if left out.

    Returns
    -------
    array, shape (V, 2n, 2n)
        In the state (q, q̇).

    Raises
    ------
    ValueError
        If sizes, numbers of loads or breakpoints differ.
    """
    family = Family(systems)
    scaled = with_method(method, lambda chosen: chosen.scaled_transition_matrices(family))
    return np.asarray(family.inverse_scale @ scaled @ family.scale, dtype=float)


def multipliers(system: PeriodicSystem, method: Method | None = None) -> ComplexArray:
    """Floquet multipliers, eigenvalues of the transition matrix (2-8), largest modulus first.

    All have about the same absolute error, that of Φ. Of an overdamped motion in a long period no digit is left, and
    what stands for its multiplier may be rounding:
    :func:`facegear.floquet.error_estimates.multiplier_errors` tells.

    Returns
    -------
    array of complex, shape (2n,)

    Examples
    --------
    >>> import numpy as np
    >>> import facegear as fg
    >>> free = fg.PeriodicSystem([[1.0]], [[0.0]], [[1.0]], (), period=1.0)
    >>> bool(np.allclose(fg.multipliers(free).real, np.cos(1.0)))
    True
    """
    family = Family([system])
    values = eigenvalues(with_method(method, lambda chosen: chosen.scaled_transition_matrices(family))[0])
    return np.asarray(values[np.argsort(-np.abs(values), kind="stable")], dtype=complex)


def growth_rate(system: PeriodicSystem, method: Method | None = None) -> float:
    """Growth rate ln(max|λ|)/T0 [1/s] (2-8); the system is unstable where it is positive.

    Where all motions die within a period it is known no better than max|λ|, whose error is relative to 1; minus
    infinity where nothing at all is left.

    Examples
    --------
    >>> import facegear as fg
    >>> body = fg.Body(fg.Drive(26, 130, 3.175e-3), thickness_ratio=0.03)
    >>> model = fg.Transverse(body, fg.MeshLoad(stiffness=0.6, damping=3e-6, mass=1.0))
    >>> [fg.growth_rate(model.system(fg.rad_per_s(speed))) > 0.0 for speed in (530.0, 600.0)]
    [True, False]
    """
    radius = np.abs(multipliers(system, method)[0])
    with np.errstate(divide="ignore"):
        return float(np.log(radius) / system.period)


def eigenvalues(matrices: FloatArray) -> ComplexArray:
    """Return the eigenvalues of transition matrices (..., d, d), shape (..., d).

    Raises
    ------
    ArithmeticError
        If a matrix is not finite.
    """
    if not np.isfinite(matrices).all():
        raise ArithmeticError("transition matrix is not finite: the motion grows beyond double precision")
    return np.asarray(np.linalg.eigvals(matrices), dtype=complex)
