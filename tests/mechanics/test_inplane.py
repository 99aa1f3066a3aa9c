"""Plane stress under forces at the rim: second routes, equilibrium, superposition, bad input."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from facegear.mechanics import inplane
from facegear.mechanics.cases import CASE_1, CASE_2
from facegear.mechanics.inplane import EdgeLoadStress, harmonic_field
from facegear.symbolic.lame import bessel_stresses
from facegear.symbolic.michell import michell_stresses
from tests.independent.edge_load import at_rest, shot

X = np.linspace(0.2, 1.0, 7)


@pytest.mark.parametrize("spin", [0.0, 0.005, 0.15])
@pytest.mark.parametrize("harmonic", [0, 1, 2, 6])
def test_field_against_shooting(harmonic, spin):
    for load, edge in enumerate(((0.0, 1.0), (1.0, 0.0))):
        found = harmonic_field(0.2, 0.3, spin, harmonic).stresses(X)[:, load]
        np.testing.assert_allclose(found, shot(harmonic, spin, 0.3, 0.2, X, edge), atol=3e-10)


@pytest.mark.parametrize(("harmonic", "bore"), [(2, 0.05), (7, 0.2), (40, 0.9), (120, 0.3)])
def test_high_harmonics_against_powers_of_r(harmonic, bore):
    radii = np.linspace(bore, 1.0, 4)
    for load, edge in enumerate(((0, 1), (1, 0))):
        expected = np.array([at_rest(harmonic, 0.3, bore, x, edge) for x in radii]).T
        np.testing.assert_allclose(
            harmonic_field(bore, 0.3, 0.0, harmonic).stresses(radii)[:, load], expected, atol=1e-11
        )


@pytest.mark.parametrize("harmonic", [pytest.param(1, marks=pytest.mark.slow), 2])
def test_field_against_both_closed_forms(harmonic):
    michell = michell_stresses(harmonic, X.tolist(), 0.3, 0.2)
    np.testing.assert_allclose(harmonic_field(0.2, 0.3, 0.0, harmonic).stresses(X)[:, 0], michell, atol=1e-11)
    bessel = bessel_stresses(harmonic, X.tolist(), 0.01, 0.3, 0.2, digits=40)
    np.testing.assert_allclose(harmonic_field(0.2, 0.3, 0.01, harmonic).stresses(X)[:, 0], bessel, atol=1e-11)


@given(st.floats(0.05, 0.9), st.floats(0.0, 0.5), st.floats(0.0, 0.05), st.integers(0, 12))
@settings(deadline=None, derandomize=True, max_examples=15)
def test_boundary_conditions_and_resolution(bore, nu, spin, harmonic):
    field = harmonic_field(bore, nu, spin, harmonic)
    at_bore, at_rim = field.unknowns(bore), field.unknowns(1.0)
    size = np.abs(field.series.coefficients).max()
    np.testing.assert_allclose(at_bore[:2], 0.0, atol=1e-11 * size)
    np.testing.assert_allclose(at_rim[2:], [[0.0, 1.0], [1.0, 0.0]], atol=1e-11 * size)
    assert np.abs(field.series.coefficients[-2:]).max() < 1e-12 * size


def test_a_uniform_radial_pull_is_lames_thick_ring():
    """A radial load at rest, mean part: σ_rr = A + B/x² with no displacement at the bore."""
    nu, c = 0.3, 0.2
    B_over_A = c**2 * (1 - nu) / (1 + nu)
    A = 1 / (1 + B_over_A)
    found = harmonic_field(c, nu, 0.0, 0).stresses(X)[0, 1]
    np.testing.assert_allclose(found, A * (1 + B_over_A / X**2), rtol=1e-11)


def test_amplitudes_are_those_of_the_force():
    force = 2.5e4
    stress = EdgeLoadStress(CASE_2, force)
    a, h = CASE_2.outer_radius, CASE_2.thickness
    assert stress.shear(0, a) == pytest.approx(force / (2 * math.pi * a * h), rel=1e-12)
    assert stress.shear(4, a) == pytest.approx(force / (math.pi * a * h), rel=1e-12)
    assert abs(stress.radial(4, a)) < 1e-6
    assert stress.radial(0, 0.1) == 0.0
    assert stress.radial(2, 0.1).shape == ()
    assert stress.radial(2, [[0.1, 0.2]]).shape == (1, 2)
    # H = (U - kV)/x + νS with the displacements gone at the bore
    assert stress.hoop(3, CASE_2.bore_radius) == pytest.approx(
        0.3 * stress.radial(3, CASE_2.bore_radius), rel=1e-9
    )


def test_resultant_of_the_whole_field_is_the_force():
    """Traction on a circle, integrated with its moment, for an inclined pair of forces at an angle."""
    angle, r = 0.7, 0.15
    theta = 2 * np.pi * np.arange(64) / 64
    for direction, along in (("tangential", angle + np.pi / 2), ("radial", angle)):
        stress = EdgeLoadStress(CASE_1, 1e4, speed=80.0, harmonics=6, direction=direction, angle=angle)
        radial, shear, _ = stress.field(r, theta)
        arc = CASE_1.thickness * r * 2 * np.pi / 64
        x = np.sum(radial * np.cos(theta) - shear * np.sin(theta)) * arc
        y = np.sum(radial * np.sin(theta) + shear * np.cos(theta)) * arc
        np.testing.assert_allclose([x, y], [1e4 * np.cos(along), 1e4 * np.sin(along)], atol=1e-5)


@given(st.floats(-3, 3), st.floats(-3, 3), st.sampled_from(["tangential", "radial"]))
@settings(deadline=None, derandomize=True, max_examples=15)
def test_a_shifted_force_is_a_turned_field(angle, theta, direction):
    here = EdgeLoadStress(CASE_1, 1e3, direction=direction)
    there = EdgeLoadStress(CASE_1, 1e3, direction=direction, angle=angle)
    np.testing.assert_allclose(there.field(0.2, theta + angle), here.field(0.2, theta), atol=1e-6)


@pytest.mark.parametrize(
    ("change", "error", "message"),
    [
        ({"body": 3}, TypeError, "body must be a Body"),
        ({"force": math.nan}, ValueError, "force must lie in .*got nan N"),
        ({"force": 1e11}, ValueError, "force must lie"),
        ({"force": "1"}, TypeError, "force must be a real number"),
        ({"speed": -1.0}, ValueError, "speed must lie"),
        ({"speed": 1e5}, ValueError, "rpm"),
        ({"harmonics": 2.0}, TypeError, "harmonics must be an integer"),
        ({"harmonics": 401}, ValueError, "from 0 to 400"),
        ({"direction": "up"}, ValueError, "direction must be"),
        ({"angle": 90.0}, ValueError, "degrees"),
    ],
)
def test_bad_input_is_named(change, error, message):
    with pytest.raises(error, match=message):
        EdgeLoadStress(**({"body": CASE_1, "force": 1.0} | change))


def test_bad_places_are_named():
    stress = EdgeLoadStress(CASE_1, 1.0)
    with pytest.raises(ValueError, match="bore ratio"):
        stress.radial(2, 0.3)
    with pytest.raises(ValueError, match="harmonic must be an integer from 0 to 400, got -1"):
        stress.shear(-1, 0.1)
    with pytest.raises(TypeError, match="harmonic must be an integer"):
        stress.hoop(1.5, 0.1)
    with pytest.raises(ValueError, match="r must be finite"):
        stress.field(math.inf, 0.0)
    with pytest.raises(ValueError, match="spin must lie"):
        harmonic_field(0.2, 0.3, 0.3, 1)
    assert inplane.spin_per_speed(CASE_1) == pytest.approx(0.23194 * math.sqrt(7840 / 200e9), rel=1e-4)
