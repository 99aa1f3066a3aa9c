"""Arrays and figures of the chapter on damage."""

import numpy as np
import pytest

from compendium.datasets import damage as arrays
from compendium.plotting import damage as draw
from facegear.design.identification import Survey
from facegear.design.tooth_search import SlotFilter
from facegear.floquet.hill import by_mean_harmonic, exponents, hill_spectrum, in_base_strip
from facegear.floquet.response import steady_response
from facegear.mechanics.classical import Hill, Mathieu, square_wave
from facegear.mechanics.gearboxes import FIGURES
from facegear.mechanics.tooth_damage import DamagedTooth
from facegear.mechanics.torsional import Torsional
from facegear.support.parameters import rad_per_s
from tests.figures import check_round_trip, texts

GEARBOX = Torsional(FIGURES["7.12b"].gearbox.in_si)
SPEED = float(rad_per_s(500.0))
PARTS = ("input_stiffness", "output_stiffness", "mesh_stiffness")
FREQUENCIES = GEARBOX.natural_frequencies()


def survey(motions):
    sizes = 1e-3 * FREQUENCIES[list(motions)]
    return Survey(GEARBOX, SPEED, PARTS, motions, np.stack([np.inf * sizes, sizes], axis=1))


def test_convergence_and_orders(tmp_path):
    systems = {
        "smooth": Mathieu(0.4, 0.02).system(1.3),
        "jumping": Hill(0.4, square_wave(0.37), 0.02).system(1.3),
    }
    data = arrays.convergence(
        systems, {"strip": lambda one, count: in_base_strip(hill_spectrum(one, count))}, [2, 8, 11, 16, 23]
    )
    found = arrays.orders(data, 8)
    assert np.isnan(found[0, 0])
    assert found[1, 0] == pytest.approx(3.0, abs=0.5)
    assert float(data.error.min()) == 1e-11
    assert complex(data.decay[0], data.frequency[0]) == pytest.approx(
        exponents(systems["smooth"])[0], abs=1e-9
    )
    check_round_trip(data, tmp_path)
    shown = texts(draw.convergence(data))
    assert all(word in shown for word in ("smooth", "jumping", "strip", "largest error [1/s]"))


def test_spectrum_shows_what_was_chosen():
    system = GEARBOX.system(SPEED)
    found = hill_spectrum(system, 5)
    figure = draw.spectrum(found, by_mean_harmonic(found), exponents(system), 3.0)
    assert "best centred" in texts(figure)
    every, chosen, exact = figure.axes[0].lines
    assert np.abs(every.get_ydata()).max() < 3.0
    assert (chosen.get_xdata().size, exact.get_xdata().size) == (6, 6)


def test_frequencies_have_tangents():
    data = arrays.frequencies(survey((0, 1, 2)), [0.0, 1e-4])
    np.testing.assert_allclose(data.frequency_change[..., 0], 0.0, atol=1e-9)
    np.testing.assert_allclose(
        data.frequency_change[..., 1] / 1e-4, data.frequency_slope, rtol=5e-3, atol=0.5
    )
    assert "output shaft" in texts(draw.frequencies(data, FREQUENCIES))


def test_clouds_lie_about_the_truth(tmp_path):
    truth = np.array([0.05, 0.1, 0.2])
    data = arrays.clouds(survey((0, 1, 2)), truth, 12, seed=4)
    sizes = np.sqrt(np.diag(data.bound.values))
    assert np.abs((data.told.values - truth) / sizes).max() < 4.0
    check_round_trip(data, tmp_path)
    assert "loss, mesh [%]" in texts(draw.clouds(data, survey((0, 1)).untold(truth)))


def test_deviations_are_missing_where_something_is_not_told():
    both = {"three": [survey((0, 1, 2))], "two": [survey((0, 1))]}
    data = arrays.deviations(both, np.zeros(3))
    assert np.isfinite(data.deviation[0]).all()
    assert np.isnan(data.deviation[1]).all()
    assert data.measured.values.tolist() == ["three", "two"]


def test_sidebands_tell_the_tooth(tmp_path):
    models = [DamagedTooth(GEARBOX, 0.2, tooth, "pinion", torque=500.0) for tooth in (0, 11)]
    data = arrays.sidebands(models, SPEED, 40, coordinate=1)
    mesh = data.harmonic.values % 31 == 0
    assert data.intact.values[~mesh].max() < 1e-9 * data.intact.values[mesh].max()
    check_round_trip(data, tmp_path)
    figure = draw.sidebands(data)
    told = [line.get_ydata() for line in figure.axes[1].lines]
    np.testing.assert_allclose(told[0], 0.0, atol=1e-4)
    np.testing.assert_allclose(told[1], 11.0, atol=1e-4)
    assert "tooth 11" in texts(figure)


def test_hit_rates():
    model = DamagedTooth(GEARBOX, 0.2, 4, "pinion", torque=500.0)
    x = np.arange(31 * 8) / (31 * 8)
    signal = steady_response(model.system(SPEED)).displacements(x)[:, 1].reshape(31, 8)
    pattern = np.roll(signal, -4, axis=0)
    data = arrays.hit_rates(pattern, signal, 4, [0.1, 30.0], 200, seed=0)
    assert float(data.hits[0]) == 1.0
    assert float(data.hits[1]) < 0.3
    size = np.sqrt(SlotFilter(pattern).energy / pattern.size)
    assert float(data.bound[0]) == pytest.approx(0.1 / np.sqrt(pattern.size), rel=1e-12)
    assert size > 0.0
    np.testing.assert_allclose(data.scatter, data.bound, rtol=0.25)
    assert "by chance" in texts(draw.hit_rates(data))
