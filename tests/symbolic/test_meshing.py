"""The derivations of chapter 3 against the printed equations, the motion itself, and independent numbers."""

import mpmath
import sympy as sp

from facegear.symbolic import meshing as s

POINT = {
    s.r_bs: sp.Rational(37, 1000),
    s.theta_s: sp.Rational(2, 5),
    s.theta_0s: sp.Rational(1, 30),
    s.phi_s: sp.Rational(-7, 50),
    s.m_2s: sp.Rational(1, 5),
    s.gamma_m: sp.Rational(17, 10),
    s.Omega_s: 1,
    s.u_s: sp.Rational(1, 5),
}


def value(expression):
    return sp.N(expression.subs(POINT), 30)


def face_gear_surface():
    """Position r_2 = M_2s r_s in Γ2 with φ_2 = m_2s φ_s (3-5); on the tooth where the equation of meshing holds."""
    return s.rotation_2s().subs(s.phi_2, s.m_2s * s.phi_s) * s.shaper_surface()


def small(vector):
    return all(abs(entry) < 1e-25 for entry in vector.evalf(30))


def zero(expression):
    return sp.simplify(expression) == sp.zeros(*expression.shape)


def test_space_half_angle_is_3_1():
    involute = sp.tan(s.alpha_c) - s.alpha_c
    assert sp.expand(s.space_half_angle() - sp.pi / (2 * s.N_s) + involute) == 0


def test_normal_is_3_3_and_normal_to_the_flank():
    angle = s.theta_0s + s.theta_s
    assert zero(s.shaper_normal() + sp.Matrix([sp.cos(angle), sp.sin(angle), 0]))
    surface = s.shaper_surface()
    for variable in (s.u_s, s.theta_s):
        assert zero((s.shaper_normal().T * surface.diff(variable)).applyfunc(sp.expand))


def test_transformation_is_3_4():
    c2, s2, cs, ss = sp.cos(s.phi_2), sp.sin(s.phi_2), sp.cos(s.phi_s), sp.sin(s.phi_s)
    cm, sm = sp.cos(s.gamma_m), sp.sin(s.gamma_m)
    printed = sp.Matrix(
        [
            [c2 * cs + cm * s2 * ss, -c2 * ss + cm * s2 * cs, -sm * s2],
            [-s2 * cs + cm * c2 * ss, s2 * ss + cm * c2 * cs, -sm * c2],
            [sm * ss, sm * cs, cm],
        ]
    )
    assert (s.rotation_2s() - printed).applyfunc(sp.expand) == sp.zeros(3, 3)


def test_relative_velocity_is_3_6_and_the_derivative_of_the_motion():
    x, y, z = s.shaper_surface()
    k = 1 - s.m_2s * sp.cos(s.gamma_m)
    p = s.m_2s * sp.sin(s.gamma_m)
    printed = s.Omega_s * sp.Matrix(
        [
            -y * k - z * p * sp.cos(s.phi_s),
            x * k + z * p * sp.sin(s.phi_s),
            p * (x * sp.cos(s.phi_s) - y * sp.sin(s.phi_s)),
        ]
    )
    assert (s.relative_velocity() - printed).applyfunc(sp.expand) == sp.zeros(3, 1)
    # The shaper's point seen from the face gear moves with d/dt (M_2s r_s); no angular velocity is used here.
    turning = s.rotation_2s().subs(s.phi_2, s.m_2s * s.phi_s)
    seen = turning.T * face_gear_surface().diff(s.phi_s) * s.Omega_s
    assert small((seen - s.relative_velocity()).subs(POINT))


def test_equation_of_meshing_is_3_7():
    angle = s.phi_s + s.theta_0s + s.theta_s
    printed = s.r_bs * (1 - s.m_2s * sp.cos(s.gamma_m)) - s.u_s * s.m_2s * sp.sin(s.gamma_m) * sp.cos(angle)
    assert sp.expand(s.equation_of_meshing() - printed) == 0
    assert sp.simplify(s.equation_of_meshing().subs(s.u_s, s.meshing_position())) == 0


def test_first_determinant_vanishes_on_f_only():
    on_f = {s.u_s: value(s.meshing_position())}
    first, second, third = s.undercut_determinants()
    assert abs(value(first)) > 1e-9
    assert abs(first.subs(POINT | on_f).evalf(30)) < 1e-25
    assert abs(second.subs(POINT | on_f).evalf(30)) > 1e-9
    assert s.undercut_determinants_on_meshing()[0] == 0
    # Δ2 and Δ3 in p, q, t are the determinants themselves, factor and sign included.
    p, q = s.m_2s * sp.sin(s.gamma_m), 1 - s.m_2s * sp.cos(s.gamma_m)
    back = {s.p: p, s.q: q, s.t: sp.tan(s.phi_s + s.theta_0s + s.theta_s)}
    for direct, reduced in zip((second, third), s.undercut_determinants_on_meshing()[1:], strict=True):
        difference = direct.subs(POINT | on_f) - reduced.subs(back).subs(POINT)
        assert abs(difference.evalf(30)) < 1e-25


def test_undercut_condition_is_the_common_factor():
    star, t, p, q = s.theta_star, s.t, s.p, s.q
    stated = p**2 * star * (star - t) - q * t * (1 + t**2) * ((1 - q) * star + q * t)
    assert sp.expand(s.undercut_condition() - stated) == 0
    assert sp.expand(sum(k * t ** (4 - i) for i, k in enumerate(s.undercut_coefficients())) - stated) == 0


def test_undercut_is_where_the_generated_surface_is_singular():
    """∂r_2/∂θ × ∂r_2/∂φ along f = 0, differentiated by mpmath from the motion, vanishes at the root."""
    mpmath.mp.dps = 30
    theta_0, m, gamma_m = (POINT[k] for k in (s.theta_0s, s.m_2s, s.gamma_m))
    theta = mpmath.mpf(7) / 10
    p, q = m * sp.sin(gamma_m), 1 - m * sp.cos(gamma_m)
    condition = s.undercut_condition().subs({s.p: p, s.q: q, s.theta_star: theta})
    t = max(root for root in sp.Poly(condition.evalf(30), s.t).nroots(n=25) if root.is_real)
    phi = mpmath.atan(mpmath.mpf(t)) - theta - mpmath.mpf(theta_0.p) / theta_0.q

    def surface(th, ph):
        place = {**POINT, s.theta_s: th, s.phi_s: ph}
        place[s.u_s] = s.meshing_position().subs({k: v for k, v in place.items() if k != s.u_s})
        return mpmath.matrix([mpmath.mpf(sp.N(entry, 30)) for entry in face_gear_surface().subs(place)])

    def cross(at):
        step = mpmath.mpf(10) ** -9
        by_theta = (surface(theta + step, at) - surface(theta - step, at)) / (2 * step)
        by_phi = (surface(theta, at + step) - surface(theta, at - step)) / (2 * step)
        a, b = (sp.Matrix(list(vector)) for vector in (by_theta, by_phi))
        return a.cross(b).norm() / (a.norm() * b.norm())

    assert cross(phi) < 1e-15
    assert cross(phi + mpmath.mpf("0.01")) > 1e-4


def test_inner_limit_is_3_13():
    t, p, q = s.t, s.p, s.q
    assert sp.simplify(s.inner_limit() - (q * s.r_bs / p * sp.sqrt(1 + t**2) - s.r_ds * sp.cot(s.gamma))) == 0


def test_pointing_is_3_14_to_3_16():
    pitch = sp.Symbol("P_d", positive=True)
    addendum = 1 / pitch
    circles = {s.r_bs: s.N_s / (2 * pitch) * sp.cos(s.alpha_c), s.r_top: (s.N_s - 2) / (2 * pitch)}
    condition = s.alpha - (s.N_s - 2) * sp.sin(s.alpha) / (s.N_s * sp.cos(s.alpha_c)) - s.theta_0s
    assert sp.simplify(s.pointing_condition().subs(circles) - condition) == 0
    cotangent = (1 + s.m_2s * sp.cos(s.gamma)) / (s.m_2s * sp.sin(s.gamma))
    assert sp.simplify(s.pointing_cone_angle_cotangent() - cotangent) == 0
    half = s.N_s / (2 * pitch)
    printed = half * (cotangent - sp.cot(s.gamma)) + addendum * sp.cot(s.gamma)
    printed += half * cotangent * (sp.cos(s.alpha_c) - sp.cos(s.alpha)) / sp.cos(s.alpha)
    assert sp.simplify(s.outer_limit().subs(circles) - printed) == 0


def test_contact_point_is_the_chain_of_rotations():
    chain = s.rotation_pm() * s.rotation_ms() * s.shaper_surface().subs(s.u_s, s.meshing_position())
    place = {k: v for k, v in POINT.items() if k != s.u_s}
    angle = (s.phi_s + s.theta_0s + s.theta_s).subs(place)
    contact = s.contact_point().subs({s.alpha: angle, s.gamma: sp.pi - s.gamma_m})
    assert small((chain - contact).subs(place))


def test_contact_line_speed_is_the_rate_along_the_line():
    place = {k: v for k, v in POINT.items() if k not in (s.u_s, s.theta_s)}
    line = s.shaper_surface().subs(s.u_s, s.meshing_position()).subs(place)
    rate = line.diff(s.theta_s).subs(s.theta_s, POINT[s.theta_s]).norm()
    angle = (s.phi_s + s.theta_0s + s.theta_s).subs(POINT)
    speed = s.contact_line_speed().subs({s.alpha: angle, s.gamma: sp.pi - s.gamma_m}).subs(POINT)
    assert abs((rate - speed).evalf(30)) < 1e-25


def test_returned_point_is_the_shaper_s_own_at_the_instant_and_rides_on_the_gear_after():
    """At δ = 0 the shaper's point (3-2) turned by φs, on f = 0; later the same point of Γ2, by (3-4)."""
    returned = s.returned_point().subs(s.alpha, s.phi_s + s.theta_0s + s.theta_s)
    generated = s.shaper_surface().subs(s.u_s, s.meshing_position())
    supplement = {s.gamma: sp.pi - s.gamma_m}
    now = (s.rotation_ms() * generated).subs(supplement)
    assert small(value(returned.subs(supplement).subs(s.delta, 0) - now))
    turn = sp.Rational(3, 10)
    on_gear = s.rotation_2s().subs(s.phi_2, s.m_2s * s.phi_s) * generated
    later = {s.phi_2: s.m_2s * (s.phi_s + turn)}
    back = s.rotation_pm().T * s.rotation_2p().subs(later).T * on_gear
    assert small(value(returned.subs(supplement).subs(s.delta, turn) - back))
