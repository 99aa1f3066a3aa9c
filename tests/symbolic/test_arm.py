import math

import mpmath
import pytest
import sympy as sp

from facegear.symbolic import arm, meshing, torsional
from tests.independent import meshing_mpmath
from tests.independent.make_anchors_ch07_design import moment


def test_moment_of_the_normal_force_is_the_position_times_the_cosine_of_the_local_pressure_angle():
    assert sp.simplify(arm.moment_of_unit_force() - meshing.u_s * sp.cos(meshing.alpha)) == 0


def test_meshing_leaves_the_constant_arm_that_holds_at_any_shaft_angle():
    assert sp.simplify(arm.arm_on_meshing() - meshing.r_bs / meshing.m_2s) == 0
    assert sp.simplify(arm.arm_on_meshing() - torsional.conjugate_arm()) == 0


def test_the_balance_of_power_is_the_equation_of_meshing():
    angle = {meshing.alpha: meshing.phi_s + meshing.theta_0s + meshing.theta_s}
    at_right_angle = meshing.equation_of_meshing().subs(meshing.gamma_m, sp.pi / 2)
    assert sp.simplify(arm.power_balance().subs(angle) - at_right_angle) == 0


@pytest.mark.parametrize(("rotation", "roll"), [(0.05, 0.3), (-0.2, 0.45), (0.3, 0.2)])
def test_arm_at_points_where_surfaces_touch_with_numerical_normals(rotation, roll):
    drive = meshing_mpmath.Drive(31, 107, "3.175e-3")
    expected = 107 * 3.175e-3 / 2 * math.cos(math.radians(25))
    assert float(moment(drive, mpmath.mpf(rotation), mpmath.mpf(roll))) == pytest.approx(expected, rel=1e-12)
