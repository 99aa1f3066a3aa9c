"""Michell's solution of the disk at rest under a tangential load at its rim.

Everything is dimensionless as in (6-1), see :mod:`facegear.symbolic.inplane`. Terms are derived on first use and
cached.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import Any, NamedTuple

import mpmath
import sympy as sp

from facegear.symbolic.edge_terms import Numeric, loaded_at_rim
from facegear.symbolic.inplane import lambda_2_squared, nu, r, theta


class MichellTerm(NamedTuple):
    """One term of Airy's stress function at rest, with what follows from it (factors of sin kθ or cos kθ)."""

    airy: Any
    U: Any
    V: Any
    S: Any
    T: Any
    H: Any


def _michell_term(airy: Any, harmonic: Any) -> MichellTerm:
    """Stresses and displacements of a stress function in r and θ."""
    sine, cosine = sp.sin(harmonic * theta), sp.cos(harmonic * theta)
    S = sp.simplify((sp.diff(airy, r) / r + sp.diff(airy, theta, 2) / r**2) / sine)
    H = sp.simplify(sp.diff(airy, r, 2) / sine)
    T = sp.simplify(-sp.diff(sp.diff(airy, theta) / r, r) / cosine)
    # ε_r = U', ε_θ = (U - kV)/r
    displacement = sp.integrate(sp.expand(S - nu * H), r)
    other = (displacement - r * (H - nu * S)) / harmonic
    return MichellTerm(airy, sp.simplify(displacement), sp.simplify(other), S, T, H)


@cache
def michell_terms(harmonic: int) -> tuple[MichellTerm, ...]:
    """Terms of Michell's solution for one harmonic k ≥ 1 under a tangential load.

    For k = 1 the terms r ln r sin θ and rθ cos θ leave a displacement that does not close round the disk; one
    combination of them does, and a displacement of the whole disk takes the place of the other.

    Returns
    -------
    tuple of MichellTerm, length 4

    Raises
    ------
    ArithmeticError
        If a term does not obey Hooke's law for shear.
    """
    power = sp.sin(harmonic * theta)
    if harmonic == 1:
        share = sp.Symbol("D")
        mixed = _michell_term(r * sp.log(r) * power + share * r * theta * sp.cos(theta), 1)
        solution = sp.solve(sp.simplify(_shear_residual(mixed, 1)), share)
        mixed = MichellTerm(*(sp.simplify(part.subs(share, solution[0])) for part in mixed))
        shift = MichellTerm(sp.S.Zero, sp.S.One, sp.S.One, sp.S.Zero, sp.S.Zero, sp.S.Zero)
        terms = (_michell_term(r**3 * power, 1), _michell_term(power / r, 1), mixed, shift)
    else:
        exponents = (harmonic, -harmonic, harmonic + 2, 2 - harmonic)
        terms = tuple(_michell_term(r**exponent * power, harmonic) for exponent in exponents)  # type: ignore[assignment]
    for term in terms:
        if sp.simplify(_shear_residual(term, harmonic)) != 0:
            raise ArithmeticError(
                f"the stress function {term.airy} has displacements that do not fit its shear"
            )
    return terms


def _shear_residual(term: MichellTerm, harmonic: Any) -> Any:
    """Shear by Hooke's law from the displacements, minus the shear of the stress function."""
    return lambda_2_squared * (harmonic * term.U / r + sp.diff(term.V, r) - term.V / r) - term.T


def michell_stresses(
    harmonic: int, radii: Sequence[float], poissons_ratio: float, bore_ratio: float, digits: int = 30
) -> list[list[float]]:
    """S, T, H of one harmonic for τ_k = 1 in the disk at rest, Michell's solution.

    Parameters
    ----------
    harmonic : int
        k, from 0.
    radii : sequence of float
        x = r/a [-].
    poissons_ratio, bore_ratio : float
        ν and c [-].
    digits : int
        Decimal digits of the arithmetic.

    Returns
    -------
    list of three lists
        S, T, H at the radii [-].
    """
    if harmonic == 0:  # torsion in the plane: the moment of the shear is the same at every radius
        return [[0.0] * len(radii), [1 / x**2 for x in radii], [0.0] * len(radii)]
    terms = _michell_functions(harmonic)
    with mpmath.workdps(digits):
        ratio = mpmath.mpf(poissons_ratio)

        def columns(x: Any) -> list[Sequence[Any]]:
            return [function(mpmath.mpf(x), ratio) for function in terms]

        return loaded_at_rim(columns, harmonic, radii, bore_ratio)


@cache
def _michell_functions(harmonic: int) -> tuple[Numeric, ...]:
    return tuple(
        sp.lambdify((r, nu), [term.U, term.V, term.S, term.T, term.H], "mpmath")
        for term in michell_terms(harmonic)
    )
