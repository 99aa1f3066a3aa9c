r"""Plane field of a spinning disk under a force at its rim, derived in SymPy (6-2 to 6-22).

Everything is dimensionless as in (6-1): lengths over the outer radius, stresses over E, Ω for Ω*. The kth harmonic
under a tangential load is u_r = U(r) sin kθ, u_θ = V(r) cos kθ with the stresses S sin kθ, T cos kθ, H sin kθ (6-22).

A disk that bends is strained in its plane by the slopes of its deflection; what these strains add to the equations is
derived too.

Two closed forms stand beside the equations: the dissertation's Lamé potentials of Bessel functions
(:mod:`facegear.symbolic.lame`), and Michell's solution of the disk at rest (:mod:`facegear.symbolic.michell`).

Every derivation runs on first use and is cached; nothing is derived at import.
"""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import sympy as sp

r, c = sp.symbols("r c", positive=True)  # radius and bore radius, over the outer radius
theta, t = sp.symbols("theta t", real=True)
nu = sp.Symbol("nu", positive=True)  # Poisson's ratio
Omega = sp.Symbol("Omega", positive=True)  # Ω* (6-1)
k = sp.Symbol("k", integer=True, nonnegative=True)  # harmonic
U, V, P, Q = (sp.Function(name)(r) for name in "UVPQ")
bending_strains = sp.symbols("E_r_r E_r_theta E_theta_theta")  # amplitudes of sym(∇φ_i ⊗ ∇φ_j)
lambda_1_squared = 1 / (1 - nu**2)  # (6-11)
lambda_2_squared = 1 / (2 * (1 + nu))


class Stresses(NamedTuple):
    """Plane stresses over E."""

    radial: Any
    shear: Any
    hoop: Any


def stresses(u_r: Any, u_theta: Any, bent: tuple[Any, Any, Any] = (0, 0, 0)) -> Stresses:
    """Hooke's law of plane stress in polar coordinates, with the strains E_rr, E_rθ, E_θθ that bending adds."""
    radial = sp.diff(u_r, r) + bent[0]
    hoop = u_r / r + sp.diff(u_theta, theta) / r + bent[2]
    shear = sp.diff(u_r, theta) / r + sp.diff(u_theta, r) - u_theta / r + 2 * bent[1]
    return Stresses(
        lambda_1_squared * (radial + nu * hoop),
        lambda_2_squared * shear,
        lambda_1_squared * (hoop + nu * radial),
    )


def equations_of_motion(u_r: Any, u_theta: Any) -> tuple[Any, Any]:
    """Right sides minus left sides of (6-2) and (6-3), without the centrifugal load Ω²r: zero for a motion.

    Equilibrium of the stresses with the acceleration of the disk's particles, seen from the frame at rest, in which
    the rate of a particle is D = ∂/∂t + Ω ∂/∂θ.
    """

    def rate(u: Any) -> Any:
        return sp.diff(u, t) + Omega * sp.diff(u, theta)

    sigma = stresses(u_r, u_theta)
    acceleration_r = rate(rate(u_r)) - 2 * Omega * rate(u_theta) - Omega**2 * u_r
    acceleration_theta = rate(rate(u_theta)) + 2 * Omega * rate(u_r) - Omega**2 * u_theta
    force_r = sp.diff(sigma.radial, r) + sp.diff(sigma.shear, theta) / r + (sigma.radial - sigma.hoop) / r
    force_theta = sp.diff(sigma.shear, r) + sp.diff(sigma.hoop, theta) / r + 2 * sigma.shear / r
    return acceleration_r - force_r, acceleration_theta - force_theta


@cache
def first_order_system() -> Any:
    """Matrix A of the steady field of one harmonic, d(U, V, P, Q)/ds = A (U, V, P, Q), s = ln r, P = rS, Q = rT.

    Returns
    -------
    ImmutableMatrix, shape (4, 4)
        In r, Ω, ν and k. It contains no derivative of a known function, so it is regular for all k, and at Ω = 0.
    """
    return sp.ImmutableMatrix(_first_order().jacobian([U, V, P, Q]).applyfunc(sp.factor))


@cache
def drawn_in() -> Any:
    """Right-hand side that the strains E_rr sin kθ, E_rθ cos kθ, E_θθ sin kθ of bending add to the system.

    Returns
    -------
    ImmutableMatrix, shape (4, 1)
        In r, ν, k and the amplitudes `bending_strains`.
    """
    return sp.ImmutableMatrix(_first_order().subs({U: 0, V: 0, P: 0, Q: 0}).applyfunc(sp.factor))


@cache
def _first_order() -> Any:
    """d(U, V, P, Q)/ds of one harmonic of the steady field of a disk that is bent."""
    sine, cosine = sp.sin(k * theta), sp.cos(k * theta)
    E_rr, E_rt, E_tt = bending_strains
    field = stresses(U * sine, V * cosine, (E_rr * sine, E_rt * cosine, E_tt * sine))
    # U' and V' from Hooke's law
    slopes = sp.solve(
        [sp.expand(field.radial / sine) - P / r, sp.expand(field.shear / cosine) - Q / r],
        [sp.diff(U, r), sp.diff(V, r)],
        dict=True,
    )[0]
    hoop = sp.expand(field.hoop / sine).subs(slopes)
    # Equilibrium, with S = P/r and T = Q/r
    radial, shear = P / r * sine, Q / r * cosine

    def rate(u: Any) -> Any:
        return Omega * sp.diff(u, theta)

    u_r, u_theta = U * sine, V * cosine
    inertia_r = rate(rate(u_r)) - 2 * Omega * rate(u_theta) - Omega**2 * u_r
    inertia_theta = rate(rate(u_theta)) + 2 * Omega * rate(u_r) - Omega**2 * u_theta
    balance_r = sp.diff(radial, r) + sp.diff(shear, theta) / r + (radial - hoop * sine) / r - inertia_r
    balance_theta = sp.diff(shear, r) + sp.diff(hoop * sine, theta) / r + 2 * shear / r - inertia_theta
    rates = sp.solve(
        [sp.expand(balance_r / sine), sp.expand(balance_theta / cosine)],
        [sp.diff(P, r), sp.diff(Q, r)],
        dict=True,
    )[0]
    derivatives = [slopes[sp.diff(U, r)], slopes[sp.diff(V, r)], rates[sp.diff(P, r)], rates[sp.diff(Q, r)]]
    return sp.Matrix([sp.expand(r * value) for value in derivatives])
