"""Why contact with a face gear cut by a larger shaper is one equation: its flank moves along its own normal.

The face gear's flank is where f = 0 (3-7) on the shaper's. Named by the local pressure angle q = φs + θ0s + θs and the
roll angle θs, the points that the shaper makes at one q lie, where it makes them, on one straight line in space that is
square to the flank in all of them: a line of action. Shaper and gear turn along it in their ratio.
"""

from typing import Any

import sympy as sp

from facegear.symbolic import meshing as m

whole = sp.Symbol("q", real=True)
"""Local pressure angle q = φs + θ0s + θs [rad]."""


def line_of_action() -> tuple[Any, Any, Any]:
    """Follow the point that the shaper makes at a constant q, in the frame at rest, as θs changes.

    Returns
    -------
    speed : expression
        ∂r/∂θs along the normal N = −(cos q, sin q, 0) [m/rad].
    beside : Matrix, shape (3, 1)
        What of ∂r/∂θs is not along it [m/rad]; zero.
    turning : Matrix, shape (3, 1)
        ∂N/∂θs [1/rad]; zero. With both, whether a normal passes a given axis at a given distance depends on q alone.
    """
    pressed = {m.phi_s: whole - m.theta_0s - m.theta_s}
    surface = m.shaper_surface().subs(m.u_s, m.meshing_position())
    point, normal = (
        (m.rotation_ms() * part).subs(pressed).applyfunc(lambda x: sp.simplify(sp.expand_trig(x)))
        for part in (surface, m.shaper_normal())
    )
    motion = point.diff(m.theta_s)
    speed = sp.simplify((normal.T * motion)[0])
    beside = (motion - normal * speed).applyfunc(sp.simplify)
    return speed, beside, normal.diff(m.theta_s)
