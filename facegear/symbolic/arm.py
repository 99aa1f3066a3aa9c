"""Moment arm of the mesh force about the face-gear axis, from the equation of meshing (section 7.2), in SymPy.

The mesh deformation (7-3) takes r(t) cos α_c for the arm: the radius of the contact point, which moves along the tooth,
times the cosine of a pressure angle that does not. On the face-gear tooth the pressure angle q = φ_s + θ_0s + θ_s moves
too, and the equation of meshing (3-7) couples it to the position u_s along the pinion's axis. At γ = 90° the arm is
u_s cos q, and meshing makes u_s cos q = r_bs/m_2s wherever the contact point is; at any shaft angle the arm is the same
constant (:func:`facegear.symbolic.torsional.conjugate_arm`).
"""

from functools import cache
from typing import Any

import sympy as sp

from facegear.symbolic import meshing as m

_RIGHT_ANGLE = {m.gamma_m: sp.pi / 2}


def _in_pressure_angle(expression: Any) -> Any:
    """Write an expression at γ = 90° in the local pressure angle α_s = φ_s + θ_0s + θ_s."""
    at_right_angle = expression.subs(_RIGHT_ANGLE).subs(m.phi_s, m.alpha - m.theta_0s - m.theta_s)
    return sp.simplify(sp.expand_trig(at_right_angle))


@cache
def moment_of_unit_force() -> Any:
    """Moment about the face-gear axis of a unit force along the common normal, before meshing is used [m].

    At γ = 90°, any point of the pinion's flank at roll angle θ_s and position u_s: z_2 · (r × n).
    """
    turned = m.rotation_pm() * m.rotation_ms()
    position = turned * m.shaper_surface()
    # The normal of (3-7), (cos, sin, 0) in Γs, against the cross product (3-3).
    normal = -turned * m.shaper_normal()
    moment = sp.ImmutableMatrix([0, 0, 1]).dot(position.cross(normal))
    return _in_pressure_angle(moment)


@cache
def arm_on_meshing() -> Any:
    """Put the equation of meshing into that moment: u_s cos q = r_bs/m_2s, a constant [m]."""
    position = _in_pressure_angle(m.meshing_position())
    return sp.simplify(moment_of_unit_force().subs(m.u_s, position))


@cache
def power_balance() -> Any:
    """Power that a unit force along the normal takes from the pinion less what it gives to the face gear, over Ω_s.

    At γ = 90°. Where the teeth are in contact and stay so this vanishes: the equation of meshing again, which is why
    the ratio of the two arms has to be the gear ratio.
    """
    pinion = sp.ImmutableMatrix([0, 0, 1]).dot(m.shaper_surface().cross(-m.shaper_normal()))
    return sp.simplify(pinion - m.m_2s * moment_of_unit_force())
