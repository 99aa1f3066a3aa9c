"""The derived torsional equations against the printed ones, and their Fourier coefficients against quadrature."""

import math

import numpy as np
import pytest
import sympy as sp

from facegear.mechanics.gearboxes import FIGURES
from facegear.symbolic import meshing
from facegear.symbolic import torsional as s


def is_zero(matrix) -> bool:
    return sp.Matrix(matrix).applyfunc(lambda entry: sp.simplify(sp.expand(entry))).is_zero_matrix


def printed_pair(radius):
    """C_i and K_i of (7-12) and (7-13)."""
    c, r_dot = sp.cos(s.alpha_c), radius.diff(s.t)
    dyad = sp.Matrix(
        [[s.r_b1**2, -s.r_b1 * radius * c, 0], [-s.r_b1 * radius * c, radius**2 * c**2, 0], [0, 0, 0]]
    )
    from_rate = sp.Matrix([[0, -s.r_b1 * r_dot * c, 0], [0, radius * r_dot * c**2, 0], [0, 0, 0]])
    return s.c_m * dyad, s.c_m * from_rate + s.k_m * dyad


def printed_shafts(first, second):
    return sp.Matrix([[first, 0, 0], [0, second, -second], [0, -second, second]])


def test_lagrange_gives_the_printed_matrices():
    mass, damping, stiffness = s.matrices()
    pairs = [printed_pair(radius) for radius in s.RADII]
    assert mass == sp.diag(s.J_1, s.J_2, s.J_o)
    assert is_zero(damping - printed_shafts(s.c_1, s.c_2) - pairs[0][0] - pairs[1][0])
    assert is_zero(stiffness - printed_shafts(s.k_1, s.k_2) - pairs[0][1] - pairs[1][1])


def test_only_the_moving_contact_point_makes_the_stiffness_non_symmetric():
    stiffness = s.matrices().stiffness
    skew = stiffness - stiffness.T
    assert not is_zero(skew)
    assert is_zero(skew.subs(s.c_m, 0))
    fixed = {radius: sp.Symbol(f"R{i}") for i, radius in enumerate(s.RADII)}
    assert is_zero(skew.subs(fixed).doit())


def test_the_input_side_drops_out():
    equations = s.equations_of_motion()
    assert not equations.free_symbols & {s.J_m, s.Omega, s.m_21}


def test_rank_one_form_is_the_same():
    for derived, rank_one in zip(s.matrices(), s.rank_one_matrices(), strict=True):
        assert is_zero(derived - rank_one)


def test_conjugate_arm_is_constant():
    # u cos q = rb/m on the true tooth
    assert s.conjugate_arm() == meshing.r_bs / meshing.m_2s


@pytest.mark.parametrize("name", ["7.9a", "7.12a", "7.13b"])
def test_fourier_coefficients_against_exact_integration(name):
    model = FIGURES[name].model()
    box, system = model.gearbox.in_si, model.system(37.0)
    order = 7
    _, damping, stiffness = system.fourier(order)
    drive = box.drive
    rest = (
        system.period,
        drive.base_radius,
        drive.pressure_angle,
        drive.inner_radius,
        drive.outer_radius,
        model.contact_ratio,
        box.mesh_stiffness,
        box.mesh_damping,
        box.input_stiffness,
        box.input_damping,
        box.output_stiffness,
        box.output_damping,
    )
    symbols = (s.T_0, s.r_b1, s.alpha_c, s.R_1, s.R_2, s.cr, s.k_m, s.c_m, s.k_1, s.c_1, s.k_2, s.c_2)
    numbers = sp.lambdify((s.s, *symbols), list(s.fourier_coefficients()), modules="numpy", cse=True)
    for harmonic in range(1, order + 1):
        U, D, E, F0, F, G = numbers(harmonic, *rest)
        expected = (
            stiffness.mean,
            stiffness.cosine[harmonic - 1],
            stiffness.sine[harmonic - 1],
            damping.mean,
            damping.cosine[harmonic - 1],
            damping.sine[harmonic - 1],
        )
        for derived, integrated in zip((U, D, E, F0, F, G), expected, strict=True):
            scale = np.abs(stiffness.mean if integrated is not F0 else damping.mean).max()
            assert np.abs(derived - integrated).max() <= 1e-12 * scale


def test_one_fourier_coefficient_by_hand():
    # Entry (1, 1) of C_i is c_m r_b1² while a pair is in mesh: a pulse of length cr T0.
    entry = s.fourier_coefficients().damping_cosine[0, 0]
    by_hand = 2 * s.c_m * s.r_b1**2 * sp.sin(2 * sp.pi * s.s * s.cr) / (2 * sp.pi * s.s)
    assert is_zero([[entry - by_hand]])
    values = {s.c_m: 3.0, s.r_b1: 0.5, s.cr: 1.5, s.s: 1}
    assert float(entry.subs(values)) == pytest.approx(1.5 * math.sin(3 * math.pi) / (2 * math.pi), abs=1e-15)
