"""Derivation of the modal equations of the face-gear disk (4-8 to 4-11) from its field equation, in SymPy.

One trial term w = R_k(r) e^{in′θ} η(t) is put into the field equation (4-1), multiplied by R_m(r) e^{-inθ} and
integrated over the plate. The radial functions stay functions; what is used of them is that they are sums of
Bessel functions (4-6), clamped at the bore, and orthonormal (4-7). The same is then done for a pair of real
coordinates, the factors of cos nθ and sin nθ.

Every derivation runs on first use and is cached; nothing is derived at import.
"""

from functools import cache
from typing import Any, NamedTuple

import sympy as sp

r, r_c = sp.symbols("r r_c", positive=True)  # radius; that of the contact centroid [m]
a, b = sp.symbols("a b", positive=True)  # outer and bore radius of the disk [m]
theta, theta_c = sp.symbols("theta theta_c", real=True)  # angle; that of the contact centroid [rad]
t = sp.Symbol("t", real=True)  # time [s]
rho, h, D = sp.symbols("rho h D", positive=True)  # density [kg/m³], thickness [m], bending stiffness [N m]
beta = sp.Symbol("beta", positive=True)  # wave number of the trial mode [1/m]
Omega_2 = sp.Symbol("Omega_2", real=True)  # speed of the face gear [rad/s]
xi = sp.Symbol("xi", nonnegative=True)  # viscous loss factor of the disk [s]
m_p, c_b, k_b = sp.symbols("m_p c_b k_b", nonnegative=True)  # pinion mass, bearing damping and stiffness
m, k = sp.symbols("m k", integer=True, nonnegative=True)  # nodal circles of test and trial function
n, q = sp.symbols("n n'", integer=True)  # wave numbers round the disk of test and trial function
sigma_r = sp.Function("sigma_r")(r)  # centrifugal stresses (4-2) [Pa]
sigma_theta = sp.Function("sigma_theta")(r)
R_m, R_k = sp.Function("R_m", real=True), sp.Function("R_k", real=True)  # R_mn and R_kn′ [1/m]
eta = sp.Function("eta")  # trial coordinate
a_n, b_n = sp.Function("a_n", real=True), sp.Function("b_n", real=True)  # factors of √2 cos nθ and √2 sin nθ


class RealPair(NamedTuple):
    """Equations of the pair of real coordinates with n nodal diameters, n > 0."""

    transformation: Any
    """U with (η_n, η_-n) = U (a_n, b_n), shape (2, 2), unitary."""
    mass: Any
    """Shape (2, 2)."""
    damping: Any
    """Shape (2, 2), for test and trial functions with the same nodal circles."""
    stiffness: Any
    """Shape (2, 2), without L_n, which multiplies the identity."""
    shape: Any
    """√(2πρh) φ/R of the mesh load φ φᵀ (m_p, c_b, k_b), shape (2, 1)."""


def laplacian(w: Any) -> Any:
    """∇²w in polar coordinates."""
    return sp.diff(w, r, 2) + sp.diff(w, r) / r + sp.diff(w, theta, 2) / r**2


@cache
def mode_laplacians() -> tuple[Any, Any]:
    """∇²w/w for w = f(r) e^{in′θ}, f = J_n′, Y_n′ of βr and f = I_n′, K_n′ of βr; from Bessel's equations.

    Returns
    -------
    tuple of two expressions
        -β² and β²: every R(r) e^{in′θ} of the form (4-6) therefore has ∇⁴w = β⁴w.
    """
    factors = []
    f = sp.Function("f")(r)
    for sign in (1, -1):
        # r²f'' + r f' + (± β² r² - n′²) f = 0
        second = -sp.diff(f, r) / r - (sign * beta**2 - q**2 / r**2) * f
        w = f * sp.exp(sp.I * q * theta)
        factors.append(sp.simplify((laplacian(w) / w).doit().subs(sp.diff(f, r, 2), second)))
    return factors[0], factors[1]


def disk_terms(w: Any, biharmonic: Any) -> Any:
    """Left side of the field equation (4-1) without the mesh load [Pa].

    Parameters
    ----------
    w : sympy expression
        Deflection in r, θ and t.
    biharmonic : callable
        ∇⁴ of such a deflection.
    """
    w_t, w_theta = sp.diff(w, t), sp.diff(w, theta)
    inertia = sp.diff(w, t, 2) + 2 * Omega_2 * sp.diff(w_theta, t) + Omega_2**2 * sp.diff(w_theta, theta)
    bending = D * (xi * biharmonic(w_t + Omega_2 * w_theta) + biharmonic(w))
    stress = sp.diff(r * sigma_r * sp.diff(w, r), r) / r + sp.diff(sigma_theta * w_theta, theta) / r**2
    return rho * h * inertia + bending - h * stress


def mesh_load_terms(w: Any) -> Any:
    """Mesh load of the field equation (4-1), the rate of the contact point frozen as printed [Pa]."""
    load = m_p * sp.diff(w, t, 2) + c_b * sp.diff(w, t) + k_b * w
    return sp.DiracDelta(r - r_c) * sp.DiracDelta(theta - theta_c) / r * load


def by_parts(flux: Any, test: Any) -> tuple[Any, Any]:
    """Move the outer derivative of test · d(flux)/dr on to the test function.

    Parameters
    ----------
    flux : sympy expression
        The flux, a function of r.
    test : sympy expression
        The test function, a function of r.

    Returns
    -------
    inner, boundary : sympy expressions
        ∫ test d(flux)/dr dr = ∫ inner dr + [boundary].
    """
    boundary = flux * test
    inner = sp.expand(sp.diff(flux, r) * test - sp.diff(boundary, r))
    return inner, boundary


@cache
def stress_entry() -> tuple[Any, Any]:
    """Weak form of the centrifugal term: entry of L_n (4-9) and the boundary term that drops out.

    Returns
    -------
    entry : sympy expression
        (1/ρ) ∫ (σ_r R_m' R_k' + n² σ_θ R_m R_k/r²) r dr as an unevaluated integral.
    boundary : sympy expression
        r σ_r R_m R_k'/ρ, to be taken between b and a: zero because R_m(b) = 0 and σ_r(a) = 0.
    """
    trial, test = R_k(r), R_m(r)
    inner, boundary = by_parts(-r * sigma_r * sp.diff(trial, r) / rho, test)
    wave = sp.exp(sp.I * n * theta)
    hoop = sp.simplify(-sp.diff(sigma_theta * sp.diff(wave, theta), theta) / (r * rho * wave)) * trial * test
    integrand = sp.expand(inner + hoop)
    return sp.Integral(integrand, (r, b, a)), boundary


@cache
def disk_coefficients() -> tuple[Any, Any, Any]:
    """Factors of η̈, η̇ and η in the disk terms of (4-8), without L_n, for test and trial function alike.

    Returns
    -------
    tuple of three expressions
        1, ξβ_n + 2inΩ2 and β_n + inξΩ2β_n - n²Ω2², with β_n written out as β⁴D/(ρh).
    """
    unmodified, modified = mode_laplacians()
    if sp.simplify(unmodified**2 - modified**2) != 0:
        raise ArithmeticError("the two kinds of Bessel functions must share one biharmonic factor")
    # With η = e^{st} the rates are powers of s.
    s = sp.Symbol("s")
    trial = R_k(r) * sp.exp(sp.I * n * theta + s * t)
    unstressed = disk_terms(trial, lambda w: unmodified**2 * w).subs({sigma_r: 0, sigma_theta: 0}).doit()
    polynomial = sp.Poly(sp.simplify(sp.expand(unstressed / (rho * h * trial))), s)
    stiffness, damping, mass = (sp.expand(polynomial.coeff_monomial(s**power)) for power in (0, 1, 2))
    return mass, damping, stiffness


@cache
def load_entry() -> Any:
    """Entry e^{i(n′-n)θ_c} R_m(r_c) R_k(r_c)/(2πρh) of (4-8) that m_p, c_b and k_b share."""
    trial = R_k(r) * sp.exp(sp.I * q * theta) * eta(t)
    test = R_m(r) * sp.exp(-sp.I * n * theta) / (2 * sp.pi * rho * h)
    # The delta functions reach over the plate, so the limits do not matter.
    work = sp.expand(mesh_load_terms(trial) * test * r)
    projected = sp.integrate(sp.integrate(work, (r, -sp.oo, sp.oo)), (theta, -sp.oo, sp.oo))
    reaction = m_p * sp.diff(eta(t), t, 2) + c_b * sp.diff(eta(t), t) + k_b * eta(t)
    return sp.simplify(projected / reaction)


@cache
def real_pair() -> RealPair:
    """Write the equations of η_n and η_-n in real coordinates, n > 0.

    As the deflection is real, η_-n is the conjugate of η_n, and R (η_n e^{inθ} + η_-n e^{-inθ}) =
    √2 R (a_n cos nθ + b_n sin nθ). The transformation is unitary, so nothing is lost and nothing rescaled.
    """
    waves = (n, -n)
    coordinates = sp.Matrix([a_n(t), b_n(t)])
    plus, minus = sp.symbols("eta_+ eta_-")
    deflection = plus * sp.exp(sp.I * n * theta) + minus * sp.exp(-sp.I * n * theta)
    real = sp.sqrt(2) * (coordinates[0] * sp.cos(n * theta) + coordinates[1] * sp.sin(n * theta))
    difference = sp.expand(real.rewrite(sp.exp) - deflection)
    wave = sp.Symbol("z")
    powers = sp.expand(
        difference.subs(sp.exp(sp.I * n * theta), wave).subs(sp.exp(-sp.I * n * theta), 1 / wave)
    )
    solution = sp.solve([powers.coeff(wave, 1), powers.coeff(wave, -1)], [plus, minus], dict=True)[0]
    U = sp.Matrix([solution[plus], solution[minus]]).jacobian(coordinates)

    def in_real_coordinates(coefficient: Any) -> Any:
        diagonal = sp.diag(*(coefficient.subs(n, value) for value in waves))
        return sp.ImmutableMatrix((U.H * diagonal * U).applyfunc(sp.simplify))

    mass, damping, stiffness = (in_real_coordinates(coefficient) for coefficient in disk_coefficients())
    contact = sp.Matrix([sp.exp(sp.I * value * theta_c) for value in waves])
    shape = sp.ImmutableMatrix((U.T * contact).applyfunc(lambda entry: sp.simplify(entry.rewrite(sp.cos))))
    return RealPair(sp.ImmutableMatrix(U), mass, damping, stiffness, shape)
