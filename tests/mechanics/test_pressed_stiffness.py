"""Driving force spread over teeth: limits, statics, a route by its stresses, symmetry, and what is refused."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import facegear as fg
from facegear.design.envelope import critical_power, mode_critical_powers
from facegear.mechanics.cases import CASE_1, CASE_2
from facegear.mechanics.disk import disk_modes, unit_shape
from facegear.mechanics.edge_stiffness import edge_load_stiffness, unit_stiffness
from facegear.mechanics.pressed_stiffness import pressed_stiffness
from facegear.mechanics.spreads import (
    RIM_POINT,
    ContactPoints,
    ContactPointsAt,
    FaceStrip,
    PitchPoint,
    RimPoint,
    ToothPatches,
    root_thickness,
)
from tests.independent.spread_load import Press, PressedDisk, stresses
from tests.mechanics.own_spreads import DRIVE, SHARED, Moved, Own, assert_same
from tests.mechanics.test_transverse import complex_disk, unitary


def by_stresses(body, speed, press, harmonics):
    """K_f of a dead and of a following force by an independent route, in real coordinates."""
    plain, U = complex_disk(body), unitary(body)
    names = ("radial", "M", "N", "a", "b", "h", "E", "rho", "nu", "xi")
    values = {name: getattr(plain, name) for name in names}
    disk = PressedDisk(**values, force=1.0, harmonics=harmonics, press=press)
    return [U.conj().T @ part @ U for part in disk.parts(speed)]


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
