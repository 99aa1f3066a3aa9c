"""Floquet multipliers of the torsional model from (7-3) and (7-10) to (7-13) by DOP853, split where pairs switch.

Shares no code with the package: the matrices are typed from the text, entry by entry. The mesh period is
integrated from one instant to the next at which a tooth pair enters or leaves, so that the integrator never
meets a jump.
"""

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.integrate import solve_ivp


@dataclass(frozen=True)
class Numbers:
    """Everything (7-11) to (7-13) hold, SI."""

    J1: float
    J2: float
    Jo: float
    km: float
    cm: float
    k1: float
    c1: float
    k2: float
    c2: float
    rb1: float
    R1: float
    R2: float
    alpha_c: float
    cr: float
    N2: int


def numbers_of(model):
    """Read them off a torsional model of the package."""
    box, drive = model.gearbox.in_si, model.drive
    return Numbers(
        J1=box.pinion_inertia,
        J2=box.gear_inertia,
        Jo=box.load_inertia,
        km=box.mesh_stiffness,
        cm=box.mesh_damping,
        k1=box.input_stiffness,
        c1=box.input_damping,
        k2=box.output_stiffness,
        c2=box.output_damping,
        rb1=drive.base_radius,
        R1=drive.inner_radius,
        R2=drive.outer_radius,
        alpha_c=drive.pressure_angle,
        cr=model.contact_ratio,
        N2=drive.gear_teeth,
    )


def skew_line(n):
    """r_k and its rate of a pair that has been in mesh for x periods of length T0 (3-22).

    Other laws may need to know on which side of a kink x is meant: `inside` is a point of the same smooth piece.
    """

    def radius(pair, x, T0, inside):
        return n.R2 - (n.R2 - n.R1) * x / n.cr, -(n.R2 - n.R1) / (n.cr * T0)

    return radius


def matrices(n, x, T0, meshing, radius, middle):
    """C(t) and K(t) of (7-12), (7-13) at the fraction x of the period with the given pairs in mesh."""
    C = np.array([[n.c1, 0, 0], [0, n.c2, -n.c2], [0, -n.c2, n.c2]])
    K = np.array([[n.k1, 0, 0], [0, n.k2, -n.k2], [0, -n.k2, n.k2]])
    cosine = math.cos(n.alpha_c)
    for pair in meshing:
        r, r_dot = radius(pair, x + pair, T0, middle + pair)
        dyad = np.array(
            [
                [n.rb1**2, -n.rb1 * r * cosine, 0],
                [-n.rb1 * r * cosine, r**2 * cosine**2, 0],
                [0, 0, 0],
            ]
        )
        from_rate = np.array([[0, -n.rb1 * r_dot * cosine, 0], [0, r * r_dot * cosine**2, 0], [0, 0, 0]])
        C = C + n.cm * dyad
        K = K + n.cm * from_rate + n.km * dyad
    return C, K


def monodromy(n, speed_rpm, *, radius=None, switches=(), rtol=1e-13):
    """Transition matrix over a mesh period in (q, T0 q̇)."""
    radius = skew_line(n) if radius is None else radius
    T0 = 60.0 / (n.N2 * speed_rpm)
    J = np.array([n.J1, n.J2, n.Jo])[:, None]
    edges = sorted({0.0, n.cr - math.floor(n.cr), *switches, 1.0})
    state = np.eye(6).ravel()
    for start, stop in pairwise(edges):
        middle = (start + stop) / 2
        meshing = [pair for pair in range(math.ceil(n.cr)) if middle + pair < n.cr]

        def rate(x, flat, meshing=meshing, middle=middle):
            q, v = flat.reshape(2, 3, 6)
            C, K = matrices(n, x, T0, meshing, radius, middle)
            return np.concatenate([v, -(T0 * (C @ v) + T0**2 * (K @ q)) / J]).ravel()

        result = solve_ivp(rate, (start, stop), state, method="DOP853", rtol=rtol, atol=1e-15)
        assert result.success
        state = result.y[:, -1]
    return state.reshape(6, 6)


def spectral_radius(n, speed_rpm, **options):
    return float(np.abs(np.linalg.eigvals(monodromy(n, speed_rpm, **options))).max())
