"""NumPy twins of the derivations; written by `make twins`, not by hand.

Each takes numbers or arrays that broadcast, and returns a value for an expression and a tuple of values, row by row,
for a vector or a matrix. Nothing here needs SymPy.
"""

from typing import Any

import numpy as np

SOURCES = "57c0e24a7979dd0460d3281a8a94ecc696a95a7dbc1373fd04e5f1163b85aa5c"
"""Digest of the derivations that this was written from."""


def space_half_angle(N_s: Any, alpha_c: Any) -> Any:
    """Half angle θ0s of the tooth space on the base circle (3-1), from N_s and α_c."""
    return alpha_c - np.tan(alpha_c) + (1 / 2) * np.pi / N_s


def shaper_surface(u_s: Any, theta_s: Any, theta_0s: Any, r_bs: Any) -> Any:
    """Position r_s(u_s, θ_s) on the shaper's tooth flank in Γs (3-2), shape (3, 1) [m]."""
    x0 = theta_0s + theta_s
    x1 = np.cos(x0)
    x2 = np.sin(x0)
    return (r_bs * (-theta_s * x1 + x2), -r_bs * (theta_s * x2 + x1), u_s)


def shaper_normal(theta_s: Any, theta_0s: Any) -> Any:
    """Derive the normal n_s of the shaper's flank in Γs, of length one (3-3): ∂r/∂θ × ∂r/∂u, shape (3, 1)."""
    x0 = theta_0s + theta_s
    return (-np.cos(x0), -np.sin(x0), 0)


def rotation_2s(phi_s: Any, phi_2: Any, gamma_m: Any) -> Any:
    """M_2s = M_2p M_pm M_ms, from the shaper to the face gear (3-4), shape (3, 3)."""
    x0 = np.cos(phi_2)
    x1 = np.cos(phi_s)
    x2 = x0 * x1
    x3 = np.cos(gamma_m)
    x4 = np.sin(phi_2)
    x5 = np.sin(phi_s)
    x6 = x4 * x5
    x7 = x1 * x4
    x8 = np.sin(gamma_m)
    return (
        x2 + x3 * x6,
        -x0 * x5 + x3 * x7,
        -x4 * x8,
        x0 * x3 * x5 - x7,
        x2 * x3 + x6,
        -x0 * x8,
        x5 * x8,
        x1 * x8,
        x3,
    )


def rotation_2p(phi_2: Any) -> Any:
    """M_2p(φ_2): from the initial position Γp to the turning face gear Γ2, shape (3, 3)."""
    x0 = np.cos(phi_2)
    x1 = np.sin(phi_2)
    return (x0, x1, 0, -x1, x0, 0, 0, 0, 1)


def undercut_condition(t: Any, p_1: Any, p_2: Any, theta_star: Any) -> Any:
    """Left side minus right side of the condition of undercutting, a polynomial of degree four in t."""
    x0 = p_2 * t
    return -(p_1**2) * theta_star * (t - theta_star) - x0 * (t**2 + 1) * (-p_2 * theta_star + theta_star + x0)


def undercut_coefficients(p_1: Any, p_2: Any, theta_star: Any) -> Any:
    """Coefficients of the condition of undercutting, highest power of t first, shape (5, 1)."""
    x0 = -(p_2**2)
    x1 = p_1**2
    return (x0, p_2 * theta_star * (p_2 - 1), x0, -theta_star * (p_2 + x0 + x1), theta_star**2 * x1)


def inner_limit(t: Any, p_1: Any, p_2: Any, r_bs: Any, r_ds: Any, gamma: Any) -> Any:
    """Inner limit L1 along the shaper's axis (3-13) [m], from t, p1, p2 and the shaft angle γ."""
    return -r_ds / np.tan(gamma) + p_2 * r_bs * np.sqrt(t**2 + 1) / p_1


def pointing_cone_angle_cotangent(m_2s: Any, gamma: Any) -> Any:
    """Cot γ_s of the shaper's pitch cone (3-16): u_s cos α_s / r_bs where f = 0, in m_2s and γ."""
    return (m_2s * np.cos(gamma) + 1) / (m_2s * np.sin(gamma))


def pointing_condition(alpha_s: Any, theta_0s: Any, r_top: Any, r_bs: Any) -> Any:
    """Left side minus right side of the condition of pointing (3-15): α_s − (r_top/r_bs) sin α_s − θ_0s."""
    return alpha_s - theta_0s - r_top * np.sin(alpha_s) / r_bs


def outer_limit(alpha_s: Any, r_bs: Any, r_top: Any, m_2s: Any, gamma: Any) -> Any:
    """Outer limit L2 along the shaper's axis (3-14) [m]: the pointing section less r_top cot γ."""
    return -r_top / np.tan(gamma) + r_bs * (m_2s * np.cos(gamma) + 1) / (
        m_2s * np.sin(gamma) * np.cos(alpha_s)
    )


def contact_point(alpha_s: Any, theta_s: Any, r_bs: Any, m_2s: Any, gamma: Any) -> Any:
    """Contact point in the space-fixed Γp, shape (3, 1) [m], from the local pressure angle α_s and θ_s."""
    x0 = np.sin(alpha_s)
    x1 = np.cos(alpha_s)
    x2 = r_bs * x1
    x3 = np.cos(gamma)
    x4 = r_bs * theta_s * x0
    x5 = r_bs / x1
    x6 = x5 / m_2s
    x7 = np.sin(gamma)
    x8 = x7 ** (-1.0)
    return (
        r_bs * x0 - theta_s * x2,
        x2 * x3 + x3 * x4 - x3 * x5 - x6,
        -x2 * x7 - x3**2 * x5 * x8 - x3 * x6 * x8 - x4 * x7,
    )


def returned_point(alpha_s: Any, theta_s: Any, delta: Any, r_bs: Any, m_2s: Any, gamma: Any) -> Any:
    """Point of the tooth in the shaper's fixed axes Γm when the shaper has turned by δ since, shape (3, 1) [m]."""
    x0 = delta * m_2s
    x1 = np.cos(x0)
    x2 = np.sin(alpha_s)
    x3 = np.cos(alpha_s)
    x4 = r_bs * x3
    x5 = r_bs * x2 - theta_s * x4
    x6 = np.sin(x0)
    x7 = np.cos(gamma)
    x8 = r_bs * theta_s * x2
    x9 = r_bs / x3
    x10 = x9 / m_2s
    x11 = -x10 + x4 * x7 + x7 * x8 - x7 * x9
    x12 = np.sin(gamma)
    x13 = x12 ** (-1.0)
    x14 = -x10 * x13 * x7 - x12 * x4 - x12 * x8 - x13 * x7**2 * x9
    x15 = x1 * x11 + x5 * x6
    return (x1 * x5 - x11 * x6, x12 * x14 - x15 * x7, -x12 * x15 - x14 * x7)


def contact_line_speed(alpha_s: Any, theta_s: Any, r_bs: Any, m_2s: Any, gamma: Any) -> Any:
    """Arc length of the contact line per unit of local pressure angle at constant φ_s, ds/dα_s [m]."""
    x0 = r_bs**2
    return np.sqrt(
        theta_s**2 * x0
        + x0
        * (m_2s * np.cos(gamma) + 1) ** 2
        * np.sin(alpha_s) ** 2
        / (m_2s**2 * np.sin(gamma) ** 2 * np.cos(alpha_s) ** 4)
    )


def growth_rate_sum(
    omega_k: Any,
    omega_j: Any,
    Lambda: Any,
    f0_kk: Any,
    f0_jj: Any,
    d_kj: Any,
    e_kj: Any,
    f_kj: Any,
    g_kj: Any,
    d_jk: Any,
    e_jk: Any,
    f_jk: Any,
    g_jk: Any,
) -> Any:
    """Growth rate σ of Hsu's method [1/s] (2-26, 2-27)."""
    x0 = f0_jj - f0_kk
    x1 = e_kj + f_kj * omega_j
    x2 = d_jk - g_jk * omega_k
    x3 = e_jk + f_jk * omega_k
    x4 = d_kj - g_kj * omega_j
    x5 = 1 / (omega_j * omega_k)
    x6 = -4 * Lambda**2 + x0**2 + x5 * (x1 * x3 + x2 * x4)
    return (
        -1 / 4 * f0_jj
        - 1 / 4 * f0_kk
        + (1 / 8)
        * np.sqrt(2)
        * np.sqrt(x6 + np.sqrt(x6**2 + (4 * Lambda * x0 + x5 * (x1 * x2 - x3 * x4)) ** 2))
    )


def growth_rate_difference(
    omega_k: Any,
    omega_j: Any,
    Lambda: Any,
    f0_kk: Any,
    f0_jj: Any,
    d_kj: Any,
    e_kj: Any,
    f_kj: Any,
    g_kj: Any,
    d_jk: Any,
    e_jk: Any,
    f_jk: Any,
    g_jk: Any,
) -> Any:
    """Growth rate σ of Hsu's method [1/s] (2-26, 2-28)."""
    x0 = f0_jj - f0_kk
    x1 = d_jk + g_jk * omega_k
    x2 = e_kj + f_kj * omega_j
    x3 = d_kj - g_kj * omega_j
    x4 = e_jk - f_jk * omega_k
    x5 = 1 / (omega_j * omega_k)
    x6 = 4 * Lambda**2 - x0**2 + x5 * (x1 * x3 + x2 * x4)
    return (
        -1 / 4 * f0_jj
        - 1 / 4 * f0_kk
        + (1 / 8)
        * np.sqrt(2)
        * np.sqrt(-x6 + np.sqrt(x6**2 + (4 * Lambda * x0 + x5 * (-x1 * x2 + x3 * x4)) ** 2))
    )


def growth_rate_single(
    omega_k: Any, Lambda: Any, f0_kk: Any, d_kk: Any, e_kk: Any, f_kk: Any, g_kk: Any
) -> Any:
    """Growth rate σ of Hsu's method [1/s] (2-26, 2-27)."""
    x0 = 4 * Lambda**2
    x1 = ((d_kk - g_kk * omega_k) ** 2 + (e_kk + f_kk * omega_k) ** 2) / omega_k**2
    return -1 / 2 * f0_kk + (1 / 8) * np.sqrt(2) * np.sqrt(-x0 + x1 + abs(x0 - x1))


def border_detunings(f0_kk: Any, f0_jj: Any, P: Any, Q: Any) -> Any:
    """Lower and upper detuning Λ at which the growth rate vanishes [rad/s]; NaN if stable."""
    x0 = Q * f0_kk
    x1 = np.sqrt(16 * P * f0_jj * f0_kk + Q**2 - 64 * f0_jj**2 * f0_kk**2)
    x2 = f0_jj * x1 + f0_kk * x1
    x3 = (1 / 16) / (f0_jj * f0_kk)
    return (x3 * (Q * f0_jj - x0 - x2), x3 * (Q * f0_jj - x0 + x2))
