"""Derivation of the meshing of a face gear with its shaper (chapter 3), in SymPy.

Nothing is typed in that can be derived: the surface of the shaper and three rotations are the only input, and
everything else (normal, relative velocity, equation of meshing, undercutting and pointing) follows from them.
Every derivation runs on first use and is cached; `facegear.symbolic.twins` has what computations need as functions.

Coordinate systems (dissertation, Fig. 3.3): Γs turns with the shaper, Γm is its initial position, Γp is the
initial position of the face gear, Γ2 turns with the face gear. z_s is the shaper's axis, z_2 the face gear's.
"""

from functools import cache
from typing import Any

import sympy as sp
from sympy.simplify.fu import TR5

# Quantities with a sign known in advance are declared so: square roots then simplify without help.
r_bs = sp.Symbol("r_bs", positive=True)  # radius of the shaper's base circle [m]
r_ds = sp.Symbol("r_ds", positive=True)  # radius of the shaper's dedendum circle [m]
r_top = sp.Symbol("r_top", positive=True)  # distance of the face-gear tooth top from the shaper's axis [m]
u_s = sp.Symbol("u_s", positive=True)  # coordinate along the shaper's axis [m]
theta_s = sp.Symbol("theta_s", positive=True)  # roll angle of the involute [rad]
theta_star = sp.Symbol("theta_s__*", positive=True)  # roll angle at the shaper's addendum circle [rad]
theta_0s = sp.Symbol("theta_0s", real=True)  # half angle of the tooth space on the base circle [rad]
phi_s, phi_2 = sp.symbols("phi_s phi_2", real=True)  # rotation of shaper and face gear [rad]
gamma, gamma_m = sp.symbols("gamma gamma_m", positive=True)  # shaft angle and its supplement [rad]
m_2s = sp.Symbol("m_2s", positive=True)  # gear ratio N_s/N_2
Omega_s = sp.Symbol("Omega_s", positive=True)  # speed of the shaper [rad/s]
delta = sp.Symbol("delta", real=True)  # rotation of the shaper since a point was generated [rad]
alpha, alpha_c = sp.symbols("alpha_s alpha_c", positive=True)  # local and nominal pressure angle [rad]
N_s = sp.Symbol("N_s", positive=True)  # number of shaper teeth
t = sp.Symbol("t", real=True)  # tangent of the local pressure angle
p = sp.Symbol("p_1", positive=True)  # m_2s sin(gamma_m)
q = sp.Symbol("p_2", positive=True)  # 1 - m_2s cos(gamma_m)


@cache
def space_half_angle() -> Any:
    """Half angle θ0s of the tooth space on the base circle (3-1), from N_s and α_c."""
    involute = sp.tan(alpha_c) - alpha_c
    return sp.pi / (2 * N_s) - involute


@cache
def shaper_surface() -> Any:
    """Position r_s(u_s, θ_s) on the shaper's tooth flank in Γs (3-2), shape (3, 1) [m]."""
    angle = theta_0s + theta_s
    return sp.ImmutableMatrix(
        [
            r_bs * (sp.sin(angle) - theta_s * sp.cos(angle)),
            -r_bs * (sp.cos(angle) + theta_s * sp.sin(angle)),
            u_s,
        ]
    )


@cache
def shaper_normal() -> Any:
    """Derive the normal n_s of the shaper's flank in Γs, of length one (3-3): ∂r/∂θ × ∂r/∂u, shape (3, 1)."""
    surface = shaper_surface()
    cross = surface.diff(theta_s).cross(surface.diff(u_s)).expand()
    # TR5: sin² = 1 − cos², all that is needed here, where trigsimp would try everything it knows.
    length = sp.sqrt(sp.expand(TR5(sp.expand((cross.T * cross)[0]))))
    return (cross / length).applyfunc(sp.cancel).as_immutable()


def _rotation(axis: int, angle: Any) -> Any:
    """Rotation matrix by `angle` about coordinate axis 0 (x) or 2 (z)."""
    c, s = sp.cos(angle), sp.sin(angle)
    if axis == 0:
        return sp.ImmutableMatrix([[1, 0, 0], [0, c, -s], [0, s, c]])
    return sp.ImmutableMatrix([[c, -s, 0], [s, c, 0], [0, 0, 1]])


@cache
def rotation_ms() -> Any:
    """M_ms(φ_s): from the turning shaper Γs to its initial position Γm, shape (3, 3)."""
    return _rotation(2, phi_s)


@cache
def rotation_pm() -> Any:
    """M_pm(γ_m): from the shaper's axes Γm to those of the face gear Γp, shape (3, 3)."""
    return _rotation(0, gamma_m)


@cache
def rotation_2p() -> Any:
    """M_2p(φ_2): from the initial position Γp to the turning face gear Γ2, shape (3, 3)."""
    return _rotation(2, -phi_2)


@cache
def rotation_2s() -> Any:
    """M_2s = M_2p M_pm M_ms, from the shaper to the face gear (3-4), shape (3, 3)."""
    return rotation_2p() * rotation_pm() * rotation_ms()


@cache
def relative_velocity() -> Any:
    """Velocity v^(s2) of the shaper's point relative to the face gear, in Γs (3-6), shape (3, 1) [m/s].

    Both bodies turn about fixed axes through the origin: v = (Ω^(s) − Ω^(2)) × r_s, where the face gear's
    angular velocity m_2s Ω_s about z_p is carried into Γs by the transposed rotations.
    """
    shaper_speed = sp.Matrix([0, 0, Omega_s])
    gear_speed = (rotation_pm() * rotation_ms()).T * sp.Matrix([0, 0, m_2s * Omega_s])
    return (shaper_speed - gear_speed).cross(shaper_surface()).as_immutable()


@cache
def equation_of_meshing() -> Any:
    """Equation of meshing f(u_s, θ_s, φ_s) = 0 (3-7) [m].

    The relative velocity is normal to the flank's normal. The sign is that of (3-7), which goes with the
    normal (cos, sin, 0); the cross product (3-3) points the other way. Divided by Ω_s.
    """
    product = -(shaper_normal().T * relative_velocity())[0] / Omega_s
    collected = sp.collect(sp.expand(product), [r_bs, u_s], evaluate=False)
    return sum(factor * _combine_angles(rest) for factor, rest in collected.items())


def _combine_angles(expression: Any) -> Any:
    """Contract products of sines and cosines of θ0s + θs and φs to functions of their sum."""
    whole = sp.Symbol("whole", real=True)
    single = expression.subs(theta_0s, whole - theta_s)
    contracted = sp.factor_terms(sp.trigsimp(sp.expand(single), method="fu"))
    return contracted.subs(whole, theta_0s + theta_s)


@cache
def meshing_position() -> Any:
    """Coordinate u_s along the shaper's axis that solves f = 0 (3-7) [m]."""
    f = equation_of_meshing()  # linear in u_s
    return sp.factor(-f.subs(u_s, 0)) / f.diff(u_s)


@cache
def undercut_matrices() -> tuple[Any, Any, Any]:
    """Matrices of (3-9), (3-10), (3-11): two rows of ∂r_s/∂u, ∂r_s/∂θ, v^(s2) each, and f_u, f_θ, f_φ Ω_s."""
    surface, velocity, f = shaper_surface(), relative_velocity(), equation_of_meshing()
    last = [f.diff(u_s), f.diff(theta_s), f.diff(phi_s) * Omega_s]
    rows = [[surface[i].diff(u_s), surface[i].diff(theta_s), velocity[i]] for i in range(3)]
    pairs = ((0, 1), (0, 2), (1, 2))
    first, second, third = (sp.ImmutableMatrix([rows[i], rows[j], last]) for i, j in pairs)
    return first, second, third


@cache
def undercut_determinants() -> tuple[Any, Any, Any]:
    """Determine Δ1, Δ2, Δ3 of (3-9) to (3-11), not yet restricted to f = 0."""
    first, second, third = (matrix.det(method="berkowitz") for matrix in undercut_matrices())
    return first, second, third


@cache
def undercut_determinants_on_meshing() -> tuple[Any, Any, Any]:
    """Δ1, Δ2, Δ3 where f = 0, in t = tan(φ_s + θ_0s + θ_s), p = m_2s sin γ_m and q = 1 − m_2s cos γ_m.

    Δ1 comes out as zero: the two rows that it combines with f are tangent to the flank's section, along which
    f = 0 makes the relative velocity lie, so that the first of (3-9) to (3-11) holds everywhere and decides
    nothing. Δ2 and Δ3 share every factor but sin and cos of θ_0s + θ_s.
    """
    first, second, third = (_on_meshing(determinant) for determinant in undercut_determinants())
    return first, second, third


def _on_meshing(expression: Any) -> Any:
    """Restrict to f = 0 and to algebraic symbols; polynomial steps only, a fraction of a second."""
    # Sines and cosines of the two independent angles become symbols before anything is expanded.
    whole = sp.Symbol("whole", real=True)  # θ0s + θs
    cosine = sp.Symbol("cosine", positive=True)  # of the local pressure angle φs + θ0s + θs
    c, s = sp.symbols("c s", real=True)
    algebraic = expression.subs(u_s, q * r_bs / (p * cosine))
    algebraic = algebraic.subs({theta_0s: whole - theta_s, phi_s: alpha - whole})
    algebraic = sp.expand_trig(algebraic).subs(
        {
            sp.sin(gamma_m): p / m_2s,
            sp.cos(gamma_m): (1 - q) / m_2s,
            sp.sin(alpha): t * cosine,
            sp.cos(alpha): cosine,
            sp.sin(whole): s,
            sp.cos(whole): c,
        }
    )
    numerator, denominator = sp.fraction(sp.together(algebraic))
    remainder = sp.reduced(sp.expand(numerator), [c**2 + s**2 - 1], c, s)[1]
    # The local pressure angle's own identity, cos² (1 + t²) = 1, is used last: even powers of the cosine go.
    even = sp.Poly(remainder, cosine)
    powers = [coefficient * _cosine_power(cosine, power) for (power,), coefficient in even.terms()]
    restored = sp.factor(sp.together(sum(powers)))
    below = sp.Poly(denominator, cosine)
    divisor = sum(k * _cosine_power(cosine, power) for (power,), k in below.terms())
    back = {c: sp.cos(theta_0s + theta_s), s: sp.sin(theta_0s + theta_s), cosine: 1 / sp.sqrt(1 + t**2)}
    return sp.factor(restored / divisor).subs(back)


def _cosine_power(cosine: Any, power: int) -> Any:
    """cos^power with even powers written in t."""
    return cosine ** (power % 2) / (1 + t**2) ** (power // 2)


@cache
def undercut_condition() -> Any:
    """Left side minus right side of the condition of undercutting, a polynomial of degree four in t.

    The factor of Δ2 (and of Δ3) that can vanish, at the shaper's addendum circle θ_s = θ_s* (3-12):
    p1² θ* (θ* − t) = p2 t (1 + t²) [(1 − p2) θ* + p2 t], with t the tangent of φ_s* + θ_0s + θ_s*.
    """
    second = undercut_determinants_on_meshing()[1]
    numerator = sp.fraction(sp.together(second))[0]
    factor = next(term for term in sp.Mul.make_args(numerator) if term.has(p) and sp.degree(term, t) == 4)
    polynomial = sp.Poly(factor, t)
    # The sign that makes p² θ*² positive, as written above.
    sign = 1 if polynomial.eval(0).could_extract_minus_sign() is False else -1
    condition = sp.expand(sign * polynomial.as_expr().subs(theta_s, theta_star))
    pull = sp.collect(condition.coeff(p, 2), theta_star)
    return p**2 * sp.factor(pull) + sp.factor(condition - sp.expand(p**2 * pull))


@cache
def undercut_coefficients() -> Any:
    """Coefficients of the condition of undercutting, highest power of t first, shape (5, 1)."""
    return sp.ImmutableMatrix([sp.factor(k) for k in sp.Poly(undercut_condition(), t).all_coeffs()])


@cache
def undercut_position() -> Any:
    """Coordinate z_s* = u_s* of the critical point from f = 0, in t [m]."""
    return q * r_bs * sp.sqrt(1 + t**2) / p


@cache
def inner_limit() -> Any:
    """Inner limit L1 along the shaper's axis (3-13) [m], from t, p1, p2 and the shaft angle γ."""
    return undercut_position() - r_ds / sp.tan(gamma)


@cache
def contact_point() -> Any:
    """Contact point in the space-fixed Γp, shape (3, 1) [m], from the local pressure angle α_s and θ_s.

    u_s is eliminated by f = 0 and φ_s by α_s = φ_s + θ_0s + θ_s, γ_m by γ: −y_p is the distance from the face
    gear's axis along the plane of the two axes, −z_p the distance below the shaper's axis at γ = 90°.
    """
    position = rotation_pm() * (rotation_ms() * shaper_surface())
    position = position.subs(u_s, meshing_position()).subs(phi_s, alpha - theta_0s - theta_s)
    position = position.subs(gamma_m, sp.pi - gamma)

    def contract(component: Any) -> Any:
        # θ0s drops out: only the sum of the angles matters to the rotated involute.
        return sp.expand(component.subs(theta_0s, -theta_s))

    return position.applyfunc(contract).as_immutable()


@cache
def returned_point() -> Any:
    """Point of the tooth in the shaper's fixed axes Γm when the shaper has turned by δ since, shape (3, 1) [m].

    The face gear carries the contact point of α and θ_s on by m_2s δ about its own axis; at δ = 0 the third
    component is u_s.
    """
    carried = _rotation(2, m_2s * delta) * contact_point()
    return (rotation_pm().subs(gamma_m, sp.pi - gamma).T * carried).as_immutable()


@cache
def contact_line_speed() -> Any:
    """Arc length of the contact line per unit of local pressure angle at constant φ_s, ds/dα_s [m].

    In Γs, where the shaper and the contact line lie still: θ_s and α_s grow together.
    """
    position = shaper_surface().subs(u_s, meshing_position())
    # At constant φ_s the roll angle is the only variable left.
    tangent = position.diff(theta_s).subs(phi_s, alpha - theta_0s - theta_s)
    tangent = tangent.subs(gamma_m, sp.pi - gamma)
    in_section = sp.trigsimp(sp.expand(tangent[0] ** 2 + tangent[1] ** 2))
    return sp.sqrt(in_section + sp.factor(tangent[2]) ** 2)


@cache
def pointing_cone_angle_cotangent() -> Any:
    """Cot γ_s of the shaper's pitch cone (3-16): u_s cos α_s / r_bs where f = 0, in m_2s and γ."""
    at_rest = meshing_position().subs(phi_s, alpha - theta_0s - theta_s).subs(gamma_m, sp.pi - gamma)
    return sp.cancel(sp.cos(alpha) * at_rest / r_bs)


@cache
def pointing_condition() -> Any:
    """Left side minus right side of the condition of pointing (3-15): α_s − (r_top/r_bs) sin α_s − θ_0s.

    In the section Π2 normal to the shaper's axis the face-gear flank is replaced by its tangent at φ_s = 0,
    where α_s = θ_0s + θ_s. Both flanks' tangents meet in the tooth's plane of symmetry (x = 0); pointing is
    where that happens at the tooth top, y = −r_top. With r_top = (N_s − 2)/(2 P_d) this is (3-15).
    """
    surface, normal = shaper_surface(), shaper_normal()
    top = sp.Matrix([0, -r_top, u_s])
    offset = (normal.T * (top - surface))[0].subs(theta_s, alpha - theta_0s)
    scaled = sp.expand(sp.trigsimp(sp.expand(offset / r_bs)))
    return scaled * sp.sign(scaled.coeff(theta_0s)) * -1


@cache
def outer_limit() -> Any:
    """Outer limit L2 along the shaper's axis (3-14) [m]: the pointing section less r_top cot γ."""
    return r_bs * pointing_cone_angle_cotangent() / sp.cos(alpha) - r_top / sp.tan(gamma)
