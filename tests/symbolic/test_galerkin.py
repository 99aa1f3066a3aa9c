"""The derived modal equations against the printed ones and against the plate they are derived from."""

import mpmath
import numpy as np
import pytest
import sympy as sp
from numpy.polynomial import chebyshev

from facegear.mechanics.radial_modes import centrifugal_stiffness, centrifugal_stress, radial_modes
from facegear.symbolic import galerkin as g

BETA_N = g.beta**4 * g.D / (g.rho * g.h)


def is_zero(expression) -> bool:
    return sp.simplify(sp.expand(expression)) == 0


def test_disk_coefficients_are_the_printed_ones():
    # (4-11) without L_n
    mass, damping, stiffness = g.disk_coefficients()
    assert mass == 1
    assert is_zero(damping - (g.xi * BETA_N + 2 * sp.I * g.n * g.Omega_2))
    assert is_zero(stiffness - (BETA_N + sp.I * g.n * g.xi * g.Omega_2 * BETA_N - g.n**2 * g.Omega_2**2))


def test_load_entry_is_the_printed_one():
    # (4-8), (4-9): e^{i(-n+q)θc} R_m(rc) R_k(rc)/(2πρh)
    printed = sp.exp(sp.I * (-g.n + g.q) * g.theta_c) * g.R_m(g.r_c) * g.R_k(g.r_c)
    assert is_zero(g.load_entry() - printed / (2 * sp.pi * g.rho * g.h))


def test_stress_entry_is_the_printed_one():
    # k^n of (4-9)
    entry, _ = g.stress_entry()
    assert entry.args[1] == (g.r, g.b, g.a)
    slopes = sp.diff(g.R_m(g.r), g.r) * sp.diff(g.R_k(g.r), g.r)
    printed = g.sigma_r * slopes + g.n**2 * g.sigma_theta * g.R_m(g.r) * g.R_k(g.r) / g.r**2
    assert is_zero(entry.args[0] - printed * g.r / g.rho)


def test_only_the_load_couples_unequal_waves():
    """All else of (4-8) stands before ∫ e^{i(n′−n)θ} dθ round the disk, 2π δ_nn′ for whole numbers."""
    unequal = sp.Symbol("d", integer=True, nonzero=True)
    assert sp.simplify(sp.integrate(sp.exp(sp.I * unequal * g.theta), (g.theta, 0, 2 * sp.pi))) == 0
    assert g.load_entry().subs({g.n: 2, g.q: 3}) != 0


@pytest.mark.parametrize(("kind", "which"), [("besselj", 0), ("bessely", 0), ("besseli", 1), ("besselk", 1)])
def test_laplacian_factor_of_each_bessel_function(kind, which):
    beta, q, radius = 3.7, 3, 0.61
    factor = float(g.mode_laplacians()[which].subs(g.beta, beta))

    def f(x):
        return getattr(mpmath, kind)(q, beta * x)

    with mpmath.workdps(40):
        laplacian = mpmath.diff(f, radius, 2) + mpmath.diff(f, radius) / radius - q**2 / radius**2 * f(radius)
        assert float(laplacian / f(radius)) == pytest.approx(factor, rel=1e-12)


def test_stress_weak_form_equals_the_strong_form():
    """-∫ R_m (r σ_r R_k')' dr + n² ∫ σ_θ R_m R_k/r dr by differentiation, not by parts."""
    c, nu, n = 0.25, 0.3, 2
    modes = radial_modes(c, nu, 2, n)
    radial = chebyshev.Chebyshev.interpolate(lambda x: centrifugal_stress(x, c, nu)[0], 60, [c, 1])
    hoop = chebyshev.Chebyshev.interpolate(lambda x: centrifugal_stress(x, c, nu)[1], 60, [c, 1])
    x = chebyshev.Chebyshev.identity([c, 1])
    R = [chebyshev.Chebyshev.interpolate(lambda y, m=m: modes(y)[m], 60, [c, 1]) for m in range(3)]
    over_x = chebyshev.Chebyshev.interpolate(lambda y: 1 / y, 60, [c, 1])
    matrix = np.empty((3, 3))
    for m in range(3):
        for k in range(3):
            strong = -R[m] * (x * radial * R[k].deriv()).deriv() + n**2 * hoop * R[m] * R[k] * over_x
            antiderivative = strong.integ(lbnd=c)
            matrix[m, k] = antiderivative(1.0)
    np.testing.assert_allclose(matrix, centrifugal_stiffness(modes), rtol=1e-9, atol=1e-9)
    # The boundary term that was dropped.
    _, boundary = g.stress_entry()
    assert boundary.has(g.sigma_r, g.R_m(g.r))
    assert abs(radial(1.0)) < 1e-12
    assert np.abs(modes(c)).max() < 1e-10


class TestRealPair:
    def test_transformation_is_unitary(self):
        U = g.real_pair().transformation
        assert (U.H * U).applyfunc(sp.simplify) == sp.eye(2)

    def test_transformation_keeps_the_deflection(self):
        U = g.real_pair().transformation
        cosine, sine = sp.symbols("A B", real=True)
        plus, minus = U * sp.Matrix([cosine, sine])
        wave = plus * sp.exp(sp.I * g.n * g.theta) + minus * sp.exp(-sp.I * g.n * g.theta)
        real = sp.sqrt(2) * (cosine * sp.cos(g.n * g.theta) + sine * sp.sin(g.n * g.theta))
        assert is_zero((wave - real).rewrite(sp.cos))
        assert sp.simplify(sp.conjugate(plus) - minus) == 0

    def test_matrices_are_real_and_gyroscopic(self):
        pair = g.real_pair()
        assert pair.mass == sp.eye(2)
        turning = sp.Matrix([[0, 1], [-1, 0]])
        damping = g.xi * BETA_N * sp.eye(2) + 2 * g.n * g.Omega_2 * turning
        stiffness = (BETA_N - g.n**2 * g.Omega_2**2) * sp.eye(2) + g.n * g.xi * g.Omega_2 * BETA_N * turning
        assert (pair.damping - damping).applyfunc(sp.simplify) == sp.zeros(2)
        assert (pair.stiffness - stiffness).applyfunc(sp.simplify) == sp.zeros(2)

    def test_load_matrix_is_of_rank_one(self):
        pair = g.real_pair()
        waves = (g.n, -g.n)
        unit = {g.R_m(g.r_c): 1, g.R_k(g.r_c): 1}
        entry = g.load_entry().subs(unit) * 2 * sp.pi * g.rho * g.h
        matrix = sp.Matrix(2, 2, lambda i, j: entry.subs({g.n: waves[i], g.q: waves[j]}, simultaneous=True))
        real = pair.transformation.H * matrix * pair.transformation
        difference = (real - pair.shape * pair.shape.T).applyfunc(lambda e: sp.simplify(e.rewrite(sp.cos)))
        assert difference == sp.zeros(2)


def test_derivations_are_cached():
    assert g.real_pair() is g.real_pair()
