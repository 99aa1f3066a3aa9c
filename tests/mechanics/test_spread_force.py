"""Driving force spread over teeth: limits, statics, a route by its stresses, symmetry, and what is refused."""

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad_vec

import facegear as fg
from facegear.design.envelope import critical_power, mode_critical_powers
from facegear.mechanics.cases import CASE_1, CASE_2
from facegear.mechanics.disk import disk_modes, unit_shape
from facegear.mechanics.edge_stiffness import edge_load_stiffness, unit_stiffness
from facegear.mechanics.spread_force import (
    RIM_POINT,
    ContactPoints,
    ContactPointsAt,
    FaceStrip,
    PitchPoint,
    PressedPoints,
    RimPoint,
    Spread,
    ToothPatches,
    pitch_ratio,
    pressed_stiffness,
    root_thickness,
)
from tests.independent.spread_load import Press, PressedDisk, stresses
from tests.mechanics.test_transverse import complex_disk, unitary

DRIVE = CASE_1.drive
SHARED = fg.Contact(path=fg.shared_load("length_share"), sharing="each")


class Moved(Spread):
    """Points of one's own: shares of the moment at radii and angles."""

    def __init__(self, radius, angle=0.0, share=1.0):
        columns = np.broadcast_arrays(*map(np.atleast_1d, (radius, angle, share)))
        self.given = PressedPoints(*(np.asarray(column, dtype=float) for column in columns))

    def points(self, drive):
        return self.given


@dataclass(frozen=True)
class Own(Spread):
    """As somebody would write it from the documentation."""

    radius: object = (1.0,)
    angle: object = (0.0,)
    share: object = (1.0,)

    def points(self, drive):
        return PressedPoints(self.radius, self.angle, self.share)


def by_stresses(body, speed, press, harmonics):
    """K_f of a dead and of a following force by an independent route, in real coordinates."""
    plain, U = complex_disk(body), unitary(body)
    names = ("radial", "M", "N", "a", "b", "h", "E", "rho", "nu", "xi")
    values = {name: getattr(plain, name) for name in names}
    disk = PressedDisk(**values, force=1.0, harmonics=harmonics, press=press)
    return [U.conj().T @ part @ U for part in disk.parts(speed)]


def assert_same(found, expected, relative=1e-12):
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=relative * np.abs(expected).max())


@pytest.mark.parametrize("speed", [0.0, 104.7])
def test_at_the_rim_it_is_the_stiffness_of_the_text(speed):
    for body in (CASE_2, replace(CASE_1, nodal_circles=2, nodal_diameters=6, bore_radius=0.02)):
        found = pressed_stiffness(body, speed, 5, (0.4,), RIM_POINT)
        stress = fg.EdgeLoadStress(body, 1.0, speed, 5, angle=0.4)
        assert_same(found.dead, edge_load_stiffness(stress, "dead"))
        assert_same(sum(found), edge_load_stiffness(stress))


STRIP = (DRIVE.inner_radius / DRIVE.outer_radius, 1.0)
PRESSES = {
    "circle": (Moved(0.8, [0.3, -0.1], [0.4, 0.6]), Press((0.3, -0.1), (0.4, 0.6), (0.8, 0.8))),
    "face": (FaceStrip(), Press(strip=STRIP)),
    "root": (
        FaceStrip(root_thickness(DRIVE)),
        Press(strip=STRIP, thickness=root_thickness(DRIVE) / DRIVE.outer_radius),
    ),
    "teeth": (
        ToothPatches(Moved(1.0, [-0.04, 0.01], [0.3, 0.7])),
        Press((-0.04, 0.01), (0.3, 0.7), STRIP),
    ),
}


@pytest.mark.parametrize(
    ("name", "speed"), [("circle", 0.0), ("face", 104.7), ("root", 0.0), ("teeth", 104.7)]
)
def test_work_of_the_stresses_is_that_of_the_drawn_in_points(name, speed):
    spread, press = PRESSES[name]
    body = replace(CASE_1, nodal_diameters=2)
    found = pressed_stiffness(body, speed, 4, (0.0,), spread)
    dead, follower = by_stresses(body, speed, press, 4)
    assert_same(found.dead, dead.real, 1e-9)
    assert_same(sum(found), follower.real, 1e-9)
    assert np.abs(follower.imag).max() < 1e-9 * np.abs(dead).max()


def test_stresses_of_the_other_route_carry_moment_and_force():
    """Through any circle goes the moment of what presses outside it, and at the bore the whole force."""
    c, x = 0.25, np.array([0.25 + 1e-12, 0.4, 0.85, 0.95])
    press = Press(strip=(0.8, 1.0))
    _, shear, _ = stresses(0, 0.0, 0.3, c, press, x)
    outside = np.array([1.0, 1.0, 0.75, 0.25])
    np.testing.assert_allclose(2 * x**2 * shear, outside, rtol=1e-9)
    radial, shear, _ = stresses(1, 0.0, 0.3, c, press, x[:2])
    # Force along y is ∫ (σ_rr sin θ + σ_rθ cos θ) r dθ h; the whole force is ∫ dϖ/x.
    np.testing.assert_allclose(x[:2] * (radial + shear), np.log(1.0 / 0.8) / 0.2, rtol=1e-9)


def test_without_harmonics_statics_alone_give_the_matrix():
    """The mean shear at rest follows from the moment outside a circle, whatever the elasticity."""
    body, strip = CASE_1, FaceStrip()
    inner = body.drive.inner_radius / body.outer_radius
    found = pressed_stiffness(body, 0.0, 0, (0.0,), strip)
    rules = (_rule(body.bore_ratio, inner), _rule(inner, 1.0))
    x, weights = np.concatenate(rules, axis=1)
    outside = np.clip((1.0 - x) / (1.0 - inner), 0.0, 1.0)
    angles = 2 * np.pi * np.arange(16) / 16
    shape = [
        unit_shape(body.modes, x[:, None], angles, by_radius=i, by_angle=j)
        for i, j in ((0, 0), (1, 0), (0, 1))
    ]
    value, by_radius, by_angle = shape

    def work(left, density, right):
        return np.einsum("r,rai,raj->ij", weights * density / angles.size, left, right)

    shear = outside / x**2
    mixed = work(by_radius, shear, by_angle)
    pressed = np.where(x > inner, 1.0 / (1.0 - inner), 0.0)
    scale = 1.0 / (2 * np.pi * body.material.density * body.thickness * body.outer_radius**3)
    assert_same(found.dead, scale * (mixed + mixed.T), 1e-11)
    assert_same(found.following, -scale * work(value, pressed / x**2, by_angle), 1e-11)


def _rule(low, high):
    nodes, weights = np.polynomial.legendre.leggauss(40)
    return (low + high) / 2 + (high - low) / 2 * nodes, (high - low) / 2 * weights


def test_a_patch_that_shrinks_to_the_rim_tends_to_the_printed_force():
    """To first order in its width along the radius, and to second in its width along the rim."""
    printed = sum(pressed_stiffness(CASE_1, 50.0, 6, (0.0,), RimPoint()))
    nodes, weights = np.polynomial.legendre.leggauss(8)

    def distance(inwards, across):
        spread = Moved(1.0 - inwards * (1 + nodes) / 2, across * nodes, weights / 2)
        return np.abs(sum(pressed_stiffness(CASE_1, 50.0, 6, (0.0,), spread)) - printed).max()

    widths = np.array([0.04, 0.02, 0.01, 0.005])
    radial = np.polyfit(np.log(widths), np.log([distance(w, 0.0) for w in widths]), 1)[0]
    along = np.polyfit(np.log(widths), np.log([distance(0.0, w) for w in widths]), 1)[0]
    assert radial == pytest.approx(1.0, abs=0.05)
    assert along == pytest.approx(2.0, abs=0.05)


@settings(max_examples=12, deadline=None)
@given(
    st.floats(0.5, 1.0), st.floats(-0.3, 0.3), st.floats(0.0, 100.0), st.floats(-3.0, 3.0), st.integers(0, 6)
)
def test_a_dead_force_is_conservative_and_a_turned_one_turns_the_matrix(
    radius, angle, speed, turned, harmonics
):
    spread = Moved(radius, angle)
    dead, following = pressed_stiffness(CASE_1, speed, harmonics, (0.0,), spread)
    assert_same(dead, dead.T, 1e-13)
    rotation = _turning(CASE_1, turned)
    there = pressed_stiffness(CASE_1, speed, harmonics, (turned,), spread)
    assert_same(there.dead, rotation @ dead @ rotation.T, 1e-11)
    assert_same(there.following, rotation @ following @ rotation.T, 1e-11)


def _turning(body, angle):
    """Matrix that turns shapes by an angle."""
    modes = disk_modes(body)
    found = np.zeros((len(modes), len(modes)))
    for i, one in enumerate(modes):
        for j, other in enumerate(modes):
            if (one.nodal_circles, one.nodal_diameters) == (other.nodal_circles, other.nodal_diameters):
                n = one.nodal_diameters
                quarter = {("cos", "sin"): -1.0, ("sin", "cos"): 1.0}.get((one.wave, other.wave), 0.0)
                found[i, j] = quarter * np.sin(n * angle) if quarter else np.cos(n * angle)
    return found


def test_what_following_adds_is_the_force_on_the_slope_under_it():
    """A point force with all harmonics: its transverse part on the deflection, written without a Fourier series."""
    x, angle = 0.85, 0.2
    found = pressed_stiffness(CASE_1, 60.0, 6, (0.0,), Moved(x, angle)).following
    value = unit_shape(CASE_1.modes, x, angle)
    slope = unit_shape(CASE_1.modes, x, angle, by_angle=1) / x
    slope = slope + np.tan(angle) * unit_shape(CASE_1.modes, x, angle, by_radius=1)
    scale = 2 * np.pi * CASE_1.material.density * CASE_1.thickness * CASE_1.outer_radius**3
    assert_same(found, -np.outer(value, slope) / x / scale)


class TestPoints:
    @pytest.mark.parametrize(
        "spread",
        [
            RIM_POINT,
            PitchPoint(),
            FaceStrip(),
            FaceStrip(8e-3),
            ContactPoints(SHARED),
            ContactPointsAt(SHARED, 0.3),
            ToothPatches(ContactPoints(SHARED), FaceStrip(8e-3)),
            ContactPoints(fg.Contact(path=fg.line_contact, sharing="each")),
            ContactPoints(fg.Contact()),
        ],
    )
    def test_shares_are_of_one_moment_on_the_teeth(self, spread):
        points = spread.points(DRIVE)
        assert points.share.sum() == pytest.approx(1.0, abs=1e-12)
        assert points.share.min() > 0.0
        assert points.radius.max() < 1.002
        assert points.radius.min() > DRIVE.inner_radius / DRIVE.outer_radius - 1e-9
        # Arm of the force about the axis: r cos θ, so that the moment is ϖ F_t a.
        force = np.hypot(points.tangential, points.radial)
        moment = force * points.radius * np.cos(points.angle)
        np.testing.assert_allclose(moment, points.share, rtol=1e-12)

    def test_the_mean_over_a_period_is_that_of_its_instants(self):
        def wave(x):
            points = ContactPointsAt(SHARED, x).points(DRIVE)
            return (points.share * points.radius * np.exp(3j * points.angle)).sum()

        edges = [*SHARED.places(DRIVE)[0].position.breakpoints, 1.0]
        mean = sum(quad_vec(wave, *ends, epsabs=1e-12, epsrel=1e-12)[0] for ends in pairwise(edges))
        points = ContactPoints(SHARED).points(DRIVE)
        found = (points.share * points.radius * np.exp(3j * points.angle)).sum()
        assert abs(found - mean) < 1e-10

    def test_against_the_rotation_the_points_are_mirrored(self):
        there = ContactPoints(SHARED).points(DRIVE)
        mirrored = ContactPoints(replace(SHARED, travel="with_disk")).points(DRIVE)
        np.testing.assert_allclose(mirrored.angle, -there.angle, atol=1e-15)
        np.testing.assert_allclose(mirrored.share, there.share, atol=1e-15)

    def test_more_nodes_change_nothing(self, monkeypatch):
        spread = ToothPatches(ContactPoints(SHARED), FaceStrip(root_thickness(DRIVE)))
        few = sum(pressed_stiffness(CASE_1, 50.0, 6, (0.0,), spread))
        from facegear.mechanics import spread_force

        for name, nodes in (("_ALONG", 20), ("_ACROSS", 8), ("_IN_PIECE", 32)):
            monkeypatch.setattr(spread_force, name, nodes)
        spread_force._moments.cache_clear()
        more = sum(pressed_stiffness(CASE_1, 50.0, 6, (0.0,), spread))
        spread_force._moments.cache_clear()
        assert_same(few, more)

    def test_the_pitch_circle_bears_the_moment_of_the_power(self):
        force = fg.DrivingForce(4e5, 500.0)
        moment = force.newtons(DRIVE) * pitch_ratio(DRIVE) * DRIVE.outer_radius
        assert moment == pytest.approx(4e5 / (500.0 * DRIVE.speed_ratio), rel=1e-12)
        assert PitchPoint().points(DRIVE).radius == pytest.approx(pitch_ratio(DRIVE))


class TestPointsOfOnesOwn:
    LOAD = fg.MeshLoad(1.0, 3e-6, 1.0)
    FORCE = fg.DrivingForce(3e5, 523.6)

    def test_lists_are_as_good_as_arrays(self):
        points = PressedPoints([0.9, 1], (0.0, 0.1), [0.25, 0.75])
        assert {column.dtype for column in (points.radius, points.angle, points.share)} == {np.dtype(float)}
        own = pressed_stiffness(CASE_1, 50.0, 6, (0.0,), Own((0.9, 1), (0, 0.1), (0.25, 0.75)))
        moved = pressed_stiffness(CASE_1, 50.0, 6, (0.0,), Moved([0.9, 1.0], [0.0, 0.1], [0.25, 0.75]))
        assert_same(sum(own), sum(moved), 1e-13)

    def test_a_pair_without_load_presses_nowhere(self):
        for instant in (*SHARED.places(DRIVE)[0].position.breakpoints, 1.0):
            points = ContactPointsAt(SHARED, float(instant)).points(DRIVE)
            assert points.share.min() > 0.0
            assert points.share.sum() == pytest.approx(1.0, abs=1e-12)

    @pytest.mark.parametrize(
        ("own", "error", "told"),
        [
            (Own(share=(2.0,)), ValueError, "share must have the sum 1, of one moment, got 2"),
            (Own((1.0, 1.0), (0.0, 0.1), (1.5, -0.5)), ValueError, "share must be greater than 0 .*got -0.5"),
            (Own(share=(np.nan,)), ValueError, "share must be finite, got an entry nan"),
            (Own(angle=(np.inf,)), ValueError, "angle must be finite, got an entry inf"),
            (
                Own(angle=(20.0,)),
                ValueError,
                r"angle must be less than .*got 20 rad \(radians, not degrees\?\)",
            ),
            (Own(radius=(231.9,)), ValueError, r"radius must be .* got 231\.9 \(a ratio, not m or mm\?\)"),
            (Own(radius=(0.0,)), ValueError, "radius must be .* got 0 "),
            (
                Own((1.0, 0.9), (0.0,), (1.0,)),
                ValueError,
                r"of one length, .*got the shapes \(2,\), \(1,\), \(1,\)",
            ),
            (Own((), (), ()), ValueError, "radius, angle and share must be lists .* of at least one point"),
            (Own(1.0, 0.0, 1.0), ValueError, "radius, angle and share must be lists"),
            (Own(radius=("rim",)), TypeError, "radius must be real numbers"),
        ],
    )
    def test_what_they_may_not_be_is_named_with_the_model(self, own, error, told):
        with pytest.raises(error, match=told):
            fg.Transverse(CASE_1, self.LOAD, force=replace(self.FORCE, spread=own))

    def test_points_in_the_bore_are_refused(self):
        bore = Own(radius=(0.9 * CASE_1.bore_ratio,))
        told = r"radius of Own.points must be r over the outer radius, at least that of the bore, .* not m or mm\?"
        with pytest.raises(ValueError, match=told):
            pressed_stiffness(CASE_1, 50.0, 6, (0.0,), bore)
        with pytest.raises(ValueError, match=told):
            mode_critical_powers(CASE_1, 523.6, bore)

    def test_something_else_than_points_is_refused(self):
        class Loose(Spread):
            def points(self, drive):
                return [1.0], [0.0], [1.0]

        with pytest.raises(
            TypeError, match=r"Loose\.points must return PressedPoints\(radius, angle, share\), got"
        ):
            pressed_stiffness(CASE_1, 50.0, 6, (0.0,), Loose())


class TestDrivingForce:
    FORCE = fg.DrivingForce(3e5, 523.6)

    def test_a_model_takes_it_as_any_force(self):
        strip = replace(self.FORCE, spread=FaceStrip(), following="dead")
        model = fg.Transverse(CASE_1, fg.MeshLoad(1.0, 3e-6, 1.0), (0.0, 1.0), force=strip)
        plain = replace(model, force=None)
        added = model.system(60.0).stiffness - plain.system(60.0).stiffness
        expected = pressed_stiffness(CASE_1, 60.0, 5, (0.0, 1.0), FaceStrip()).dead
        assert_same(added, self.FORCE.newtons(DRIVE) * expected, 1e-9)
        double = fg.replace_parameter(model, "power", 6e5).system(60.0).stiffness
        assert_same(double - plain.system(60.0).stiffness, 2 * added, 1e-9)

    def test_first_order_of_flutter_is_what_eigenvalues_find(self):
        for spread in (FaceStrip(), PitchPoint(), ToothPatches(ContactPoints(SHARED))):
            first = mode_critical_powers(CASE_1, 523.6, spread).min()
            found = critical_power(CASE_1, 523.6, 50.0, spread=spread)
            assert found == pytest.approx(first, rel=3e-3)
            assert found > 1.05 * critical_power(CASE_1, 523.6, 50.0)

    def test_unit_stiffness_is_of_the_spread(self):
        strip = unit_stiffness(CASE_1, 40.0, 5, "follower", (0.0,), FaceStrip())
        assert_same(strip, sum(pressed_stiffness(CASE_1, 40.0, 5, (0.0,), FaceStrip())), 1e-12)

    def test_bad_input_is_named(self):
        with pytest.raises(TypeError, match=r"spread must be a Spread such as FaceStrip\(\), got 'face'"):
            replace(self.FORCE, spread="face")
        with pytest.raises(TypeError, match="contact must be a Contact, got 3"):
            ContactPoints(3)
        with pytest.raises(TypeError, match="contact must be a Contact"):
            ContactPointsAt(None, 0.0)
        with pytest.raises(ValueError, match=r"fraction must lie in \[0, 1\], got 1\.5"):
            ContactPointsAt(SHARED, 1.5)
        with pytest.raises(TypeError, match="teeth must be a Spread"):
            ToothPatches(SHARED)
        with pytest.raises(TypeError, match="tooth must be a Spread"):
            ToothPatches(RIM_POINT, 3)
        with pytest.raises(ValueError, match="root_thickness must be 0 or greater"):
            FaceStrip(-1e-3)
        load = fg.MeshLoad(1.0, 3e-6, 1.0)
        with pytest.raises(ValueError, match=r"root_thickness must be less than the pitch .* got 0\.02 m"):
            fg.Transverse(CASE_1, load, force=replace(self.FORCE, spread=FaceStrip(0.02)))
        unhashed = "spread must be a Spread with a hash, a frozen dataclass .*unhashable type: 'list'"
        with pytest.raises(TypeError, match=unhashed):
            replace(self.FORCE, spread=Own([1.0], [0.0], [1.0]))
        skew = ContactPoints(fg.Contact(path=fg.SkewLine))
        with pytest.raises(ValueError, match='sharing must be "mean" or "each" for SkewLine'):
            fg.Transverse(CASE_1, load, force=replace(self.FORCE, spread=skew))
