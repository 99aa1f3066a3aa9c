"""Arrays and figures of the chapter on shafts with mass."""

from dataclasses import replace

import numpy as np
import pytest

import facegear as fg
from compendium.datasets import heavy_shafts as arrays
from compendium.plotting import heavy_shafts as draw
from facegear.mechanics.gearboxes import FIGURES
from facegear.mechanics.heavy_shafts import HeavyShafts
from facegear.support.parameters import rad_per_s
from tests.figures import texts

MODEL = HeavyShafts(FIGURES["7.12a"].model(), 0.3, 0.3, modes=1)
BOTH = ("input_length", "output_length")


@pytest.fixture(scope="module")
def chart():
    speeds, lengths = [480.0, 530.0, 560.0, 640.0], [0.1, 0.3]
    rows = [arrays.of_length(MODEL, length, BOTH) for length in lengths]
    growth = [
        fg.stability_map(
            row, rad_per_s(speeds), "output_length", [row.output_length], method=arrays.METHOD, jobs=1
        ).values[0]
        for row in rows
    ]
    return arrays.stability(MODEL, BOTH, speeds, lengths, [0.3], growth)


@pytest.fixture(scope="module")
def speeds():
    return arrays.natural_speeds(MODEL, [0.1, 0.2, 0.3], BOTH, 3)


def test_cells_of_the_map_are_those_of_single_models(chart):
    one = replace(MODEL, input_length=0.1, output_length=0.1)
    own = fg.growth_rate(one.system(float(rad_per_s(560.0))), arrays.METHOD)
    assert float(chart.growth_rate[0, 2]) == pytest.approx(own, rel=1e-8)
    massless = fg.growth_rate(MODEL.torsional.system(float(rad_per_s(640.0))), arrays.METHOD)
    assert float(chart.massless[3]) == pytest.approx(massless, rel=1e-8)


def test_borders_part_stable_cells_from_unstable_ones(chart):
    assert chart.label.values.tolist() == [["(1+1)/1"]]
    assert 480.0 < float(chart.lower[0, 0]) < 530.0 < 560.0 < float(chart.upper[0, 0]) < 640.0
    np.testing.assert_array_less(chart.growth_rate[1, [0, 3]], 0.0)
    assert float(chart.largest_growth[0, 0]) >= float(chart.growth_rate[1].max())
    assert 560.0 < float(chart.massless_lower[0]) < 640.0


def test_turned_cells_are_counted_both_ways(chart):
    # 0.1 m: unstable from 578 rpm, without mass from 593; 0.3 m: from 491 to 562.
    assert arrays.turned(chart) == (2 / 8, 1 / 8)


def test_natural_speeds_are_those_of_the_model(speeds):
    teeth = MODEL.torsional.drive.gear_teeth
    own = fg.rpm(MODEL.natural_frequencies()[:3] / teeth)
    np.testing.assert_allclose(speeds.reduced[:, -1], own, rtol=1e-12)
    np.testing.assert_allclose(speeds.exact[:, -1], fg.rpm(MODEL.exact_frequencies(3) / teeth), rtol=1e-12)
    assert (speeds.reduced.values >= speeds.exact.values).all()


def test_convergence_is_towards_the_exact_ones():
    data = arrays.convergence(MODEL, 530.0, [0, 2, 4], 8)
    assert np.isnan(data.frequency.values[3, 0])
    assert (np.diff(data.frequency.values[:3], axis=1) < 0.0).all()
    assert abs(float(data.growth[2])) < abs(float(data.growth[0]))
    assert all(word in texts(draw.convergence(data)) for word in ("mode 1", "mode 4", "modes of a shaft"))


def test_half_of_the_inertia_goes_to_each_end():
    box, heavier = MODEL.torsional.gearbox.in_si, arrays.half_to_each_end(MODEL).gearbox.in_si
    assert heavier.pinion_inertia - box.pinion_inertia == pytest.approx(MODEL.input_rod.inertia / 2)
    whole = heavier.gear_inertia + heavier.load_inertia - box.gear_inertia - box.load_inertia
    assert whole == pytest.approx(MODEL.output_rod.inertia)


def test_points_have_both_verdicts():
    data = arrays.points({"a": MODEL}, [("a", 530.0), ("a", 640.0)], 2)
    assert np.sign(data.heavy.values).tolist() == [1.0, -1.0]
    assert np.sign(data.massless.values).tolist() == [-1.0, 1.0]


def test_sizes_are_those_of_the_shafts():
    data = arrays.sizes({"7.12(a)": FIGURES["7.12a"]}, 0.3)
    assert float(data.diameter[0, 0]) == pytest.approx(MODEL.input_rod.diameter, rel=1e-12)
    assert float(data.longest[0, 1]) == pytest.approx(MODEL.largest_lengths[1], rel=1e-12)


def test_figures_name_what_they_show(chart, speeds):
    found = texts(draw.stability({"both": chart}, {"both": (0.3,)}))
    words = ("both", "(1+1)/1", "length of the shaft [m]", "unstable with massless shafts")
    assert all(word in found for word in words)
    assert "(1+1)/1" not in texts(draw.stability({"both": chart}, {"both": ()}))
    found = texts(draw.natural_speeds({"both": speeds}, 5000.0))
    assert all(word in found for word in ("both", "mode 3", "exact", "massless shafts"))
