"""Derivations of chapter 6 against the printed equations and against the numbers of the package."""

import numpy as np
import pytest
import sympy as sp

from facegear.mechanics.inplane import harmonic_field
from facegear.symbolic import edge_stiffness, lame, michell
from facegear.symbolic import inplane as symbolic


def test_potentials_solve_the_equations_of_motion():
    assert lame.potential_residuals() == (0, 0)


def test_characteristic_equation_and_ratios_are_the_printed_ones():
    pair, (characteristic, s_k1, s_k2) = lame.bessel_pair(), lame.printed_pair()
    assert sp.simplify(pair.characteristic - characteristic) == 0
    assert sp.simplify(1 / pair.over_first + s_k1) == 0
    assert sp.simplify(1 / pair.over_second + s_k2) == 0


@pytest.mark.parametrize("harmonic", [0, 1, 2])
def test_printed_potentials_have_no_remainder(harmonic):
    values = {symbolic.r: 0.4, symbolic.theta: 0.7, symbolic.Omega: 1.3, symbolic.nu: 0.3}
    characteristic = lame.printed_pair()[0].subs({symbolic.k: harmonic} | values)
    if harmonic > 1:
        roots = sorted(z for z in sp.nroots(characteristic, n=30) if z.is_real and z > 0)
        names = sp.symbols("beta_k1 beta_k2", positive=True)
        values |= dict(zip(names, roots, strict=True))
    for Phi, Psi in lame.basis_of_potentials(harmonic):
        parts = Phi * sp.sin(harmonic * symbolic.theta), Psi * sp.cos(harmonic * symbolic.theta)
        residuals = symbolic.equations_of_motion(*lame.from_potentials(*parts))
        size = abs(sp.N(sum(parts).subs(values)))
        assert all(abs(sp.N(part.subs(values))) < 1e-10 * (1 + size) for part in residuals)


@pytest.mark.parametrize("harmonic", [0, 1, 4])
def test_collocation_solves_the_derived_system(harmonic):
    matrix = sp.lambdify(
        (symbolic.r, symbolic.Omega, symbolic.nu, symbolic.k), symbolic.first_order_system(), "numpy"
    )
    field = harmonic_field(0.3, 0.3, 0.1, harmonic)
    for x in (0.35, 0.6, 0.9):
        step = 1e-4
        slope = (field.unknowns(x * np.exp(step)) - field.unknowns(x * np.exp(-step))) / (2 * step)
        expected = np.asarray(matrix(x, 0.1, 0.3, harmonic), dtype=float) @ field.unknowns(x)
        np.testing.assert_allclose(slope, expected, atol=1e-6)


def test_michells_terms_are_in_equilibrium_and_fit_hookes_law():
    for harmonic in (1, 3):
        for term in michell.michell_terms(harmonic):
            radial = sp.diff(term.S, symbolic.r) + (term.S - term.H - harmonic * term.T) / symbolic.r
            shear = sp.diff(term.T, symbolic.r) + (2 * term.T + harmonic * term.H) / symbolic.r
            assert sp.simplify(radial) == 0
            assert sp.simplify(shear) == 0


def test_potentials_need_speed_and_digits():
    with pytest.raises(ZeroDivisionError, match="spin = 0"):
        lame.bessel_stresses(2, [0.5], 0.0, 0.3, 0.2, 15)
    few = lame.bessel_stresses(1, [0.5], 1e-4, 0.3, 0.2, 15)
    many = lame.bessel_stresses(1, [0.5], 1e-4, 0.3, 0.2, 40)
    assert abs(few[0][0] - many[0][0]) > 1e-9


def test_weak_form_is_the_printed_one():
    g = edge_stiffness
    R, L = g.R_m, g.R_l
    slope_R, slope_L = sp.diff(R, g.r), sp.diff(L, g.r)
    shear = g.q * g.T_k * slope_R * L - g.n * g.T_k * R * slope_L
    mean = g.mean_stiffness_entry()
    assert sp.expand(mean.integrand - sp.I * shear) == 0
    assert sp.expand(mean.boundary + sp.I * g.q * g.T_k * R * L) == 0
    harmonic = g.harmonic_stiffness_entry()
    others = g.sign * g.r * g.S_k * slope_R * slope_L + g.sign * g.n * g.q / g.r * g.H_k * R * L
    assert sp.expand(harmonic.integrand - sp.I / 2 * (shear + others)) == 0
    assert sp.expand(harmonic.boundary + sp.I / 2 * g.q * g.T_k * R * L) == 0


def test_strains_of_bending_act_as_the_module_of_the_spread_force_says():
    E_rr, E_rt, E_tt = symbolic.bending_strains
    x, nu, k = symbolic.r, symbolic.nu, symbolic.k
    expected = sp.Matrix([-x * (E_rr + nu * E_tt), -2 * x * E_rt, x * E_tt, -k * x * E_tt])
    assert (symbolic.drawn_in() - expected).applyfunc(sp.simplify) == sp.zeros(4, 1)
