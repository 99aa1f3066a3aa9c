"""Derivation of the torsional equations of motion (7-10 to 7-13) from the energies (7-4 to 7-6), in SymPy.

Lagrange's equations (7-8) are applied with the radii r_i(t) of the contact points left as functions of time, so
that every term in ṙ appears by itself. The Fourier coefficients (7-16) on the skew line (3-22) are integrated in
closed form: of all pairs together, a period of the mesh is the whole mesh time of one pair.

Every derivation runs on first use and is cached; nothing is derived at import.
"""

from functools import cache
from typing import Any, NamedTuple

import sympy as sp

from facegear.symbolic import meshing

t = sp.Symbol("t", real=True)  # time [s]
J_m, J_1, J_2, J_o = sp.symbols("J_m J_1 J_2 J_o", positive=True)  # moments of inertia [kg m²]
k_1, k_2 = sp.symbols("k_1 k_2", positive=True)  # stiffness of input and output shaft [N m/rad]
c_1, c_2 = sp.symbols("c_1 c_2", nonnegative=True)  # damping of input and output shaft [N m s/rad]
k_m = sp.Symbol("k_m", positive=True)  # mesh stiffness of a tooth pair [N/m]
c_m = sp.Symbol("c_m", nonnegative=True)  # mesh damping of a tooth pair [N s/m]
r_b1 = sp.Symbol("r_b1", positive=True)  # base radius of the pinion [m]
alpha_c = sp.Symbol("alpha_c", positive=True)  # pressure angle [rad]
Omega = sp.Symbol("Omega", positive=True)  # speed of the pinion [rad/s]
m_21 = sp.Symbol("m_21", positive=True)  # gear ratio N1/N2
R_1, R_2 = sp.symbols("R_1 R_2", positive=True)  # inner and outer radius of the face gear [m]
cr = sp.Symbol("c_r", positive=True)  # contact ratio
T_0 = sp.Symbol("T_0", positive=True)  # mesh period [s]
s = sp.Symbol("s", positive=True)  # order of a harmonic
r = sp.Function("r", positive=True)(t)  # radius of the contact point of one pair [m]

PAIRS = (1, 2)
"""Tooth pairs of the derivation; the energies are sums, so any number gives the same terms for each."""

RADII: tuple[Any, ...] = tuple(sp.Function(f"r_{i}", positive=True)(t) for i in PAIRS)
"""r_k(t_i), radius of the contact point of each pair [m]."""

COORDINATES: tuple[Any, ...] = tuple(sp.Function(name, real=True)(t) for name in ("chi_1", "chi_2", "chi_o"))
"""χ1, χ2, χo: elastic deviation angles of pinion, face gear and load, ψ1, ψ2, ψo in (7-9) [rad]."""


class Matrices(NamedTuple):
    """Coefficient matrices of M q̈ + C q̇ + K q = 0, each of shape (3, 3)."""

    mass: Any
    damping: Any
    stiffness: Any


class FourierCoefficients(NamedTuple):
    """Coefficients (7-16) of C(t) and K(t), each of shape (3, 3)."""

    stiffness_mean: Any
    """U(0)."""
    stiffness_cosine: Any
    """D(s)."""
    stiffness_sine: Any
    """E(s)."""
    damping_mean: Any
    """F(0)."""
    damping_cosine: Any
    """F(s)."""
    damping_sine: Any
    """G(s)."""


def deformation(radius: Any) -> Any:
    """Mesh deformation g = r_b1 χ1 − r cos α_c χ2 of a pair in contact (7-3) [m]."""
    return r_b1 * COORDINATES[0] - radius * sp.cos(alpha_c) * COORDINATES[1]


@cache
def kinetic_energy() -> Any:
    """T of input side, pinion, face gear and load, with the total angles (7-7) put in (7-4) [J]."""
    chi_1, chi_2, chi_o = COORDINATES
    angles = (Omega * t, Omega * t + chi_1, m_21 * Omega * t + chi_2, m_21 * Omega * t + chi_o)
    inertias = (J_m, J_1, J_2, J_o)
    return sum(inertia * angle.diff(t) ** 2 / 2 for inertia, angle in zip(inertias, angles, strict=True))


@cache
def strain_energy() -> Any:
    """V of both shafts and of the tooth pairs (7-5) [J]."""
    chi_1, chi_2, chi_o = COORDINATES
    mesh = sum(deformation(radius) ** 2 for radius in RADII)
    return k_1 * chi_1**2 / 2 + k_2 * (chi_2 - chi_o) ** 2 / 2 + k_m * mesh / 2


@cache
def dissipation() -> Any:
    """Rayleigh's dissipation function of both shafts and of the tooth pairs (7-6) [W]."""
    chi_1, chi_2, chi_o = COORDINATES
    mesh = sum(deformation(radius).diff(t) ** 2 for radius in RADII)
    return c_1 * chi_1.diff(t) ** 2 / 2 + c_2 * (chi_2 - chi_o).diff(t) ** 2 / 2 + c_m * mesh / 2


@cache
def equations_of_motion() -> Any:
    """Left sides of Lagrange's equations (7-8), shape (3, 1) [N m]."""
    rows = []
    for q in COORDINATES:
        rate = q.diff(t)
        inertia = kinetic_energy().diff(rate).diff(t) - kinetic_energy().diff(q)
        rows.append(sp.expand(inertia + strain_energy().diff(q) + dissipation().diff(rate)))
    return sp.ImmutableMatrix(rows)


@cache
def matrices() -> Matrices:
    """M, C(t) and K(t) of (7-10), the factors of q̈, q̇ and q in Lagrange's equations.

    Raises
    ------
    ArithmeticError
        If the equations hold anything else than these three terms.
    """
    equations = equations_of_motion()
    columns: list[Any] = []
    rest = equations
    for order in (2, 1, 0):
        variables = [q.diff(t, order) for q in COORDINATES]
        columns.append(
            sp.ImmutableMatrix(3, 3, lambda i, j, v=variables: sp.factor_terms(equations[i].coeff(v[j])))
        )
        rest = rest - columns[-1] * sp.Matrix(variables)
    if not rest.applyfunc(sp.expand).is_zero_matrix:
        raise ArithmeticError("Lagrange's equations hold terms besides those in q, its rate and acceleration")
    return Matrices(*columns)


@cache
def shape_vector() -> Any:
    """φ with g = φᵀ q for a pair with its contact point at radius r(t), shape (3, 1) [m]."""
    return sp.ImmutableMatrix([deformation(r).coeff(q) for q in COORDINATES])


@cache
def rank_one_matrices() -> Matrices:
    """M0 + 0, C0 + Σ c_m φφᵀ, K0 + Σ (k_m φφᵀ + c_m φφ̇ᵀ): the form of :mod:`facegear.floquet.periodic`."""
    absent = {k_m: 0, c_m: 0}
    mass, damping, stiffness = (matrix.subs(absent) for matrix in matrices())
    for radius in RADII:
        phi = shape_vector().subs(r, radius)
        damping += c_m * phi * phi.T
        stiffness += k_m * phi * phi.T + c_m * phi * phi.diff(t).T
    return Matrices(mass, damping, stiffness)


@cache
def fourier_coefficients() -> FourierCoefficients:
    """Fourier coefficients (7-16) on the skew line r = R2 − (R2 − R1) t/(cr T0) (3-22), in closed form.

    Of harmonics that are whole numbers s, the pair that entered earlier by a whole number of periods goes on
    where the last one left off: the sum over the pairs of integrals over T0 is one integral over cr T0.
    """
    x = sp.Symbol("x", real=True)  # mesh periods since the pair entered
    skew = R_2 - (R_2 - R_1) * t / (cr * T_0)
    absent = {k_m: 0, c_m: 0}
    _, damping, stiffness = (matrix.subs(absent) for matrix in matrices())
    phi = shape_vector()
    on_line = [
        (expression.subs(r, skew).doit()).subs(t, x * T_0).applyfunc(sp.expand)
        for expression in (k_m * phi * phi.T + c_m * phi * phi.diff(t).T, c_m * phi * phi.T)
    ]

    def integral(matrix: Any, kernel: Any) -> Any:
        # The kernel's primitives are taken power by power of x: much faster than entry by entry.
        powers = [sp.integrate(x**p * kernel, (x, 0, cr)) for p in range(3)]

        def entry(expression: Any) -> Any:
            coefficients = sp.Poly(expression, x).all_coeffs()[::-1]
            return sum(c * power for c, power in zip(coefficients, powers, strict=False))

        return matrix.applyfunc(entry).as_immutable()

    angle = 2 * sp.pi * s * x
    parts: list[Any] = []
    for constant, varying in zip((stiffness, damping), on_line, strict=True):
        parts.append((constant + integral(varying, sp.S.One)).as_immutable())
        parts += [2 * integral(varying, sp.cos(angle)), 2 * integral(varying, sp.sin(angle))]
    return FourierCoefficients(*parts)


@cache
def conjugate_arm() -> Any:
    """Moment arm of the mesh force about the face-gear axis on the true tooth [m].

    The force acts at a contact point along the common normal. Its moment about the face-gear axis is taken from
    the derived surface and normal of :mod:`facegear.symbolic.meshing`; the equation of meshing (3-7) leaves of it
    a constant, wherever on the tooth the contact point is and at any shaft angle.

    Returns
    -------
    sympy expression
        In the base radius ``meshing.r_bs`` and the gear ratio ``meshing.m_2s``.
    """
    m = meshing
    # Position and normal in the space-fixed axes Γp, whose z is the face gear's axis. The normal is that of (3-7),
    # (cos, sin, 0) in Γs, against the cross product (3-3).
    turned = m.rotation_pm() * m.rotation_ms()
    position = turned * m.shaper_surface()
    normal = -turned * m.shaper_normal()
    moment = sp.ImmutableMatrix([0, 0, 1]).dot(position.cross(normal))
    return sp.simplify(sp.trigsimp(sp.expand(moment.subs(m.u_s, m.meshing_position()))))
