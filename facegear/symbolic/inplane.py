r"""Plane field of a spinning disk under a force at its rim, derived in SymPy (6-2 to 6-22).

Everything is dimensionless as in (6-1): lengths over the outer radius, stresses over E, Ω for Ω*. The kth harmonic
under a tangential load is u_r = U(r) sin kθ, u_θ = V(r) cos kθ with the stresses S sin kθ, T cos kθ, H sin kθ (6-22).

A disk that bends is strained in its plane by the slopes of its deflection; what these strains add to the equations is
derived too.

Two closed forms are derived beside the equations: the dissertation's Lamé potentials of Bessel functions, and
Michell's solution of the disk at rest. Both are evaluated by mpmath with as many digits as asked for, because the
first of them needs more than a computer's own sixteen.

Every derivation runs on first use and is cached; nothing is derived at import.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from typing import Any, NamedTuple

import mpmath
import sympy as sp

r, c = sp.symbols("r c", positive=True)  # radius and bore radius, over the outer radius
theta, t = sp.symbols("theta t", real=True)
nu = sp.Symbol("nu", positive=True)  # Poisson's ratio
Omega = sp.Symbol("Omega", positive=True)  # Ω* (6-1)
k = sp.Symbol("k", integer=True, nonnegative=True)  # harmonic
beta = sp.Symbol("beta_k", positive=True)
U, V, P, Q = (sp.Function(name)(r) for name in "UVPQ")
phi, psi = (sp.Function(name)(r, theta) for name in ("phi_L", "psi_L"))
Phi, Psi = (sp.Function(name)(r) for name in ("Phi", "Psi"))
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


# --- Lamé's potentials and Bessel functions ------------------------------------------------------------------------


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


Numeric = Callable[..., Sequence[Any]]


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

        bore, rim = columns(bore_ratio), columns(1)
        if harmonic == 0:
            rows = [[column[1] for column in bore], [column[3] for column in rim]]
            loads = [0, 1]
        else:
            rows = [[column[i] for column in bore] for i in (0, 1)]
            rows += [[column[i] for column in rim] for i in (2, 3)]
            loads = [0, 0, 0, 1]
        factors = _factors(rows, loads)
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


# --- Michell's solution of the disk at rest ------------------------------------------------------------------------


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

        bore, rim = columns(bore_ratio), columns(1)
        rows = [[column[i] for column in bore] for i in (0, 1)]
        rows += [[column[i] for column in rim] for i in (2, 3)]
        factors = _factors(rows, [0, 0, 0, 1])
        return _sums(factors, [columns(x) for x in radii])


@cache
def _michell_functions(harmonic: int) -> tuple[Numeric, ...]:
    return tuple(
        sp.lambdify((r, nu), [term.U, term.V, term.S, term.T, term.H], "mpmath")
        for term in michell_terms(harmonic)
    )
