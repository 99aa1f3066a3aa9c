"""The line of action, derived: why contact with a larger shaper's gear is one equation."""

import sympy as sp

from facegear.symbolic import meshing
from facegear.symbolic.point_contact import line_of_action


def test_a_point_made_at_constant_pressure_angle_moves_along_its_standing_normal():
    speed, beside, turning = line_of_action()
    assert speed == meshing.r_bs
    assert beside == sp.zeros(3, 1)
    assert turning == sp.zeros(3, 1)
