"""Gearbox whose shafts have mass: limits, finite elements, DOP853, and the way through maps and labels."""

import re
from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import eigh

import facegear as fg
from facegear.floquet.labels import moving_parts
from facegear.floquet.radau import Radau
from facegear.maps.sensitivity import border_derivatives
from facegear.mechanics.gearboxes import FIGURES
from facegear.mechanics.heavy_shafts import HeavyShafts
from facegear.mechanics.properties import STEEL
from facegear.mechanics.rods import shear_modulus
from facegear.support.parameters import rad_per_s
from tests.independent.shafts_by_elements import gearbox, growth_rate, reduced_gearbox
from tests.independent.torsional_switching import numbers_of

BASE = FIGURES["7.13a"].model()
QUIET = fg.replace_parameter(BASE, "output_damping", 2e-6)
MODEL = HeavyShafts(QUIET, input_length=0.03, output_length=0.4)
G, RHO = shear_modulus(STEEL), STEEL.density


def test_names_say_what_moves():
    names = [coordinate.name for coordinate in MODEL.coordinates]
    assert names == [
        *("pinion", "face gear", "load", "input shaft, mode 1", "input shaft, mode 2"),
        *("output shaft, mode 1", "output shaft, mode 2"),
    ]
    assert moving_parts(MODEL.system(60.0), MODEL.coordinates)[:3] == ("load", "face gear", "output shaft")


def test_frequencies_are_those_of_elements_and_exact():
    n = numbers_of(QUIET)
    mass, _, stiffness = gearbox(n, 0.03, 0.4, G, RHO, (60, 60))
    stiffness[:3, :3] += QUIET.mean_stiffness - QUIET.gearbox.in_si.stiffness_matrix
    elements = np.sqrt(eigh(stiffness, mass, eigvals_only=True)[:5])
    exact = MODEL.exact_frequencies(5)
    np.testing.assert_allclose(exact, elements, rtol=1e-6)
    reduced = MODEL.natural_frequencies()
    assert len(reduced) == 7
    np.testing.assert_allclose(MODEL.natural_speeds(), reduced / 107, rtol=1e-14)
    np.testing.assert_allclose(reduced[:3], exact[:3], rtol=2e-3)
    np.testing.assert_allclose(replace(MODEL, modes=30).natural_frequencies()[:5], exact, rtol=1e-5)


def test_without_modes_the_shafts_add_their_consistent_inertia():
    rigid = replace(MODEL, modes=0)
    first, second = rigid.input_rod.inertia, rigid.output_rod.inertia
    added = rigid.system(50.0).mass - QUIET.gearbox.in_si.mass_matrix
    expected = np.array([[first / 3, 0.0, 0.0], [0.0, second / 3, second / 6], [0.0, second / 6, second / 3]])
    np.testing.assert_allclose(added, expected, rtol=1e-9, atol=1e-12)
    system, base = rigid.system(50.0), QUIET.system(50.0)
    np.testing.assert_allclose(system.stiffness, base.stiffness, rtol=1e-14)
    np.testing.assert_allclose(system.damping, base.damping, rtol=1e-14)


def test_short_shafts_become_chapter_7_with_the_square_of_their_length():
    speed = float(rad_per_s(650.0))
    truth = fg.growth_rate(QUIET.system(speed), Radau())
    lengths = np.array([0.02, 0.01, 0.005, 0.0025])
    errors = [
        abs(fg.growth_rate(HeavyShafts(QUIET, length, length).system(speed), Radau()) - truth)
        for length in lengths.tolist()
    ]
    order = np.polyfit(np.log(lengths), np.log(errors), 1)[0]
    assert order == pytest.approx(2.0, abs=0.02)
    assert errors[-1] < 1e-4 * truth


@pytest.mark.parametrize("speed_rpm", [506.0, 590.0, 700.0])
def test_growth_is_that_of_reduced_elements_by_dop853(speed_rpm):
    n = numbers_of(QUIET)
    own = fg.growth_rate(MODEL.system(float(rad_per_s(speed_rpm))), Radau())
    constant = reduced_gearbox(n, 0.03, 0.4, G, RHO, 2, 60)
    assert own == pytest.approx(growth_rate(n, constant, speed_rpm), abs=2e-3)


@pytest.mark.slow
def test_growth_is_that_of_many_elements_by_dop853():
    n = numbers_of(QUIET)
    own = fg.growth_rate(replace(MODEL, modes=12).system(float(rad_per_s(506.0))), Radau())
    assert own == pytest.approx(growth_rate(n, gearbox(n, 0.03, 0.4, G, RHO, (1, 8)), 506.0), rel=2e-3)


def test_maps_tongues_and_sensitivities_take_it():
    chart = fg.stability_map(MODEL, rad_per_s([506.0, 540.0]), "output_length", [0.3, 0.35, 0.4], jobs=1)
    for row, length in enumerate((0.3, 0.35, 0.4)):
        for column, speed_rpm in enumerate((506.0, 540.0)):
            one = replace(MODEL, output_length=length).system(float(rad_per_s(speed_rpm)))
            assert float(chart[row, column]) == pytest.approx(fg.growth_rate(one, Radau()), abs=1e-5)
    found = fg.tongues(MODEL, rad_per_s([480.0, 560.0]), method=Radau())
    assert [tongue.label for tongue in found] == ["(2-1)/1", "(1+2)/2"]
    border = found[0].lower
    (derivative,) = border_derivatives(MODEL, border, ["output_length"])
    step = 1e-4
    moved = [
        fg.tongues(
            replace(MODEL, output_length=0.4 + sign * step), rad_per_s([495.0, 510.0]), method=Radau()
        )[0].lower
        for sign in (-1.0, 1.0)
    ]
    assert derivative == pytest.approx((moved[1] - moved[0]) / (2.0 * step), rel=1e-3)


def test_shafts_without_length_are_massless():
    none = HeavyShafts(QUIET, 0.0, 0.0)
    speed = float(rad_per_s(600.0))
    assert none.coordinates == QUIET.coordinates
    assert none.not_buildable == ()
    assert fg.growth_rate(none.system(speed), Radau()) == pytest.approx(
        fg.growth_rate(QUIET.system(speed), Radau()), rel=1e-9
    )
    output = replace(MODEL, input_length=0.0)
    assert [coordinate.part for coordinate in output.coordinates[3:]] == ["output shaft"] * 2
    np.testing.assert_allclose(output.natural_frequencies()[:2], MODEL.natural_frequencies()[:2], rtol=1e-3)
    np.testing.assert_allclose(output.exact_frequencies(2), output.natural_frequencies()[:2], rtol=1e-3)


def test_exact_frequencies_of_massless_shafts_are_all_that_there_are():
    none = HeavyShafts(QUIET, 0.0, 0.0)
    np.testing.assert_allclose(none.exact_frequencies(3), QUIET.natural_frequencies(), rtol=1e-14)
    assert none.exact_frequencies(1).shape == (1,)
    with pytest.raises(
        ValueError, match="count without a length of a shaft must be an integer from 1 to 3, got 4"
    ):
        none.exact_frequencies(4)


def test_forced_response_takes_it():
    wave = fg.PiecewiseChebyshev.fit(lambda x, piece: 1e-5 * np.cos(2.0 * np.pi * x), [0.0])
    short = HeavyShafts(BASE, 1e-3, 1e-3)
    speed = float(rad_per_s(400.0))
    heavy, massless = (
        fg.steady_response(fg.Excited(model, transmission_error=wave).system(speed)).harmonics(1)[1, :3]
        for model in (short, BASE)
    )
    np.testing.assert_allclose(heavy, massless, rtol=1e-3)
    swept = fg.frequency_response(
        fg.Excited(MODEL, transmission_error=wave), rad_per_s([380.0, 400.0, 420.0]), jobs=1
    )
    one = fg.steady_response(fg.Excited(MODEL, transmission_error=wave).system(speed))
    np.testing.assert_allclose(swept.force_mean[1], one.mean(one.contact_forces), rtol=1e-6)
    # Resonance of the second mode with the second harmonic of the mesh.
    assert "2/2" in swept.peak_label.values.tolist()


def test_what_cannot_be_built_is_named():
    model = HeavyShafts(BASE, input_length=0.3, output_length=0.3)
    (sentence,) = model.not_buildable
    assert sentence.startswith("input shaft of 158 mm diameter is thicker than the root circle of the pinion")
    # Long ones too are told in plain digits.
    assert "at most 32.1 mm long" in sentence
    (far,) = replace(model, input_length=0.0, output_length=20.0).not_buildable
    assert re.search(r"at most 1[0-9]{4} mm long", far)
    first, second = model.largest_lengths
    assert replace(model, input_length=0.999 * first, output_length=0.999 * second).not_buildable == ()
    assert len(replace(model, input_length=1.001 * first, output_length=1.001 * second).not_buildable) == 2
    diameter = replace(model, input_length=first).input_rod.diameter
    # Pitch circle less 1.25 modules on each side.
    assert diameter == pytest.approx((31 - 2.5) * 3.175e-3, rel=1e-12)


@pytest.mark.parametrize(
    ("bad", "error", "words"),
    [
        ({"torsional": "gearbox"}, TypeError, "torsional must be a Torsional"),
        (
            {"input_length": 3e-4},
            ValueError,
            "input_length must be 0 for a massless shaft, or at least 0.001 m",
        ),
        ({"input_length": -0.1}, ValueError, "input_length"),
        ({"output_length": 30.0}, ValueError, "output_length"),
        ({"output_length": "long"}, TypeError, "output_length"),
        ({"modes": 41}, ValueError, "modes"),
        ({"material": "steel"}, TypeError, "material"),
    ],
)
def test_bad_input_is_refused(bad, error, words):
    arguments = {"torsional": BASE, "input_length": 0.1, "output_length": 0.1} | bad
    with pytest.raises(error, match=words):
        HeavyShafts(**arguments)
