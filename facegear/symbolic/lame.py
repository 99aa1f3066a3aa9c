r"""Lamé's potentials of the plane field of a spinning disk, and the Bessel functions that solve them (6-8 to 6-21).

Everything is dimensionless as in (6-1), see :mod:`facegear.symbolic.inplane`. The closed form is evaluated by mpmath
with as many digits as asked for, because it needs more than a computer's own sixteen.

Every derivation runs on first use and is cached; nothing is derived at import.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import Any, NamedTuple

import mpmath
import sympy as sp

from facegear.symbolic.edge_terms import Numeric, loaded_at_rim
from facegear.symbolic.inplane import (
    Omega,
    equations_of_motion,
    k,
    lambda_1_squared,
    lambda_2_squared,
    nu,
    r,
    theta,
)

beta = sp.Symbol("beta_k", positive=True)
phi, psi = (sp.Function(name)(r, theta) for name in ("phi_L", "psi_L"))


def from_potentials(phi_L: Any, psi_L: Any) -> tuple[Any, Any]:
    """Displacements u_r, u_θ from Lamé's potentials (6-8)."""
    return (
        sp.diff(phi_L, r) + sp.diff(psi_L, theta) / r,
        sp.diff(phi_L, theta) / r - sp.diff(psi_L, r),
    )


def laplacian(f: Any) -> Any:
    """∇²f in polar coordinates."""
    return sp.diff(f, r, 2) + sp.diff(f, r) / r + sp.diff(f, theta, 2) / r**2


def potential_operators(phi_L: Any, psi_L: Any) -> tuple[Any, Any]:
    """G_L and H_L of (6-10)."""

    def own(f: Any, factor: Any) -> Any:
        return factor * laplacian(f) - Omega**2 * sp.diff(f, theta, 2) + Omega**2 * f

    return (
        own(phi_L, lambda_1_squared) - 2 * Omega**2 * sp.diff(psi_L, theta),
        own(psi_L, lambda_2_squared) + 2 * Omega**2 * sp.diff(phi_L, theta),
    )


@cache
def potential_residuals() -> tuple[Any, Any]:
    """Equations of motion (6-2), (6-3) in the potentials, minus (6-9): 0, 0 if (6-9) and (6-10) are right.

    With the sign that makes them the same: (6-9) is the equation of motion times -1.
    """
    first, second = equations_of_motion(*from_potentials(phi, psi))
    G, H = potential_operators(phi, psi)
    return (
        sp.simplify(sp.expand(first + sp.diff(G, r) + sp.diff(H, theta) / r)),
        sp.simplify(sp.expand(second + sp.diff(G, theta) / r - sp.diff(H, r))),
    )


class BesselPair(NamedTuple):
    """φ_L = J_k(βr) sin kθ, ψ_L = ratio J_k(βr) cos kθ with G_L = H_L = 0."""

    characteristic: Any
    """Vanishes for β_k1 and β_k2 (6-19), a polynomial in β²."""
    over_first: Any
    """Ψ/Φ from G_L = 0."""
    over_second: Any
    """Φ/Ψ from H_L = 0."""


@cache
def bessel_pair() -> BesselPair:
    """Characteristic equation (6-19) and ratios (6-20), for the potentials Φ_ks and Ψ_kc of a tangential load."""
    f = sp.Function("f")(r)
    # Bessel's equation: f'' = -f'/r - (β² - k²/r²) f
    second = -sp.diff(f, r) / r - (beta**2 - k**2 / r**2) * f
    one, two = sp.symbols("one two")
    G, H = potential_operators(one * f * sp.sin(k * theta), two * f * sp.cos(k * theta))
    G, H = (
        sp.simplify(value.subs(sp.diff(f, r, 2), second) / (f * wave))
        for value, wave in ((G, sp.sin(k * theta)), (H, sp.cos(k * theta)))
    )
    matrix = sp.Matrix([G, H]).jacobian([one, two])
    determinant = sp.collect(sp.expand(matrix.det()), beta)
    return BesselPair(
        determinant, sp.simplify(-matrix[0, 0] / matrix[0, 1]), sp.simplify(-matrix[1, 1] / matrix[1, 0])
    )


@cache
def printed_pair() -> tuple[Any, Any, Any]:
    """(6-19) and s_k1 at β_k2, s_k2 at β_k1 (6-20) as printed, in β."""
    l1, l2 = lambda_1_squared, lambda_2_squared
    characteristic = (
        l1 * l2 * beta**4 - (l1 + l2) * (1 + k**2) * Omega**2 * beta**2 + (1 - k**2) ** 2 * Omega**4
    )
    s_k1 = 2 * k * Omega**2 / ((1 + k**2) * Omega**2 - l1 * beta**2)
    s_k2 = 2 * k * Omega**2 / ((1 + k**2) * Omega**2 - l2 * beta**2)
    return characteristic, s_k1, s_k2


@cache
def basis_of_potentials(harmonic: int) -> tuple[tuple[Any, Any], ...]:
    """Radial functions (Φ, Ψ) of φ_L = Φ sin kθ, ψ_L = Ψ cos kθ, as printed in (6-14), (6-16) and (6-18).

    Parameters
    ----------
    harmonic : int
        k, from 0.

    Returns
    -------
    tuple of (Φ, Ψ)
        Two pairs for k = 0, where only shear is loaded, else four.
    """
    l1, l2 = lambda_1_squared, lambda_2_squared
    if harmonic == 0:
        b02 = Omega / sp.sqrt(l2)  # (6-15)
        return ((sp.S.Zero, -sp.besselj(0, b02 * r)), (sp.S.Zero, -sp.bessely(0, b02 * r)))
    if harmonic == 1:
        b12 = Omega * sp.sqrt((3 - nu) / l2)  # (6-17)
        s11 = -(1 - nu) / 2
        logarithm = r * sp.log(r) / (l1 + l2)
        correction = (r * sp.log(r) + (l1 - l2) / (2 * r * Omega**2)) / (l1 + l2)
        return (
            (s11 * sp.besselj(1, b12 * r), -sp.besselj(1, b12 * r)),
            (s11 * sp.bessely(1, b12 * r), -sp.bessely(1, b12 * r)),
            (r / (2 * Omega**2), sp.S.Zero),
            (logarithm, -correction),
        )
    pairs = []
    # β_k1 and β_k2 are left as symbols: their roots are taken with all digits when they are needed.
    b1, b2 = sp.symbols("beta_k1 beta_k2", positive=True)
    _, s_k1, s_k2 = (part.subs(k, harmonic) for part in printed_pair())
    for function in (sp.besselj, sp.bessely):
        pairs.append((function(harmonic, b1 * r), -s_k2.subs(beta, b1) * function(harmonic, b1 * r)))
        pairs.append((s_k1.subs(beta, b2) * function(harmonic, b2 * r), -function(harmonic, b2 * r)))
    return tuple(pairs)


@cache
def _potential_field(harmonic: int) -> tuple[Numeric, ...]:
    """U, V, S, T, H of each pair of potentials as mpmath functions of r, Ω, ν, β_k1, β_k2."""
    b1, b2 = sp.symbols("beta_k1 beta_k2", positive=True)
    functions = []
    for Phi_k, Psi_k in basis_of_potentials(harmonic):
        # Factors of sin kθ and cos kθ in (6-8)
        u = sp.diff(Phi_k, r) - harmonic * Psi_k / r
        v = harmonic * Phi_k / r - sp.diff(Psi_k, r)
        ratio = (u - harmonic * v) / r
        radial = lambda_1_squared * (sp.diff(u, r) + nu * ratio)
        hoop = lambda_1_squared * (ratio + nu * sp.diff(u, r))
        shear = lambda_2_squared * (harmonic * u / r + sp.diff(v, r) - v / r)
        functions.append(sp.lambdify((r, Omega, nu, b1, b2), [u, v, radial, shear, hoop], "mpmath", cse=True))
    return tuple(functions)


def bessel_stresses(
    harmonic: int, radii: Sequence[float], spin: float, poissons_ratio: float, bore_ratio: float, digits: int
) -> list[list[float]]:
    """S, T, H of one harmonic for τ_k = 1, by Lamé's potentials and Bessel functions (6-14 to 6-21).

    Parameters
    ----------
    harmonic : int
        k, from 0.
    radii : sequence of float
        x = r/a [-].
    spin : float
        Ω* [-], greater than 0.
    poissons_ratio, bore_ratio : float
        ν and c [-].
    digits : int
        Decimal digits of the arithmetic; 15 is what double precision has.

    Returns
    -------
    list of three lists
        S, T, H at the radii [-].

    Raises
    ------
    ZeroDivisionError
        At rest, where the potentials do not exist, and where `digits` are too few to tell their conditions apart.
    """
    if spin == 0.0:
        raise ZeroDivisionError(
            "spin = 0: Lamé's potentials divide by Ω*² (6-16, 6-20); valid is a value above 0"
        )
    with mpmath.workdps(digits):
        speed, ratio = mpmath.mpf(spin), mpmath.mpf(poissons_ratio)
        l1, l2 = 1 / (1 - ratio**2), 1 / (2 * (1 + ratio))
        # Roots of the quadratic (6-19) in β²
        half = (l1 + l2) * (1 + harmonic**2) * speed**2 / 2
        root = mpmath.sqrt(half**2 - l1 * l2 * (1 - harmonic**2) ** 2 * speed**4)
        b1, b2 = (mpmath.sqrt((half + sign * root) / (l1 * l2)) for sign in (-1, 1))
        functions = _potential_field(harmonic)

        def columns(x: Any) -> list[Sequence[Any]]:
            return [function(mpmath.mpf(x), speed, ratio, b1, b2) for function in functions]

        return loaded_at_rim(columns, harmonic, radii, bore_ratio)
