"""Arrays of chapter 7 at reading size, against single systems, closed forms and each other."""

import math
from functools import cache

import numpy as np
import pytest

from compendium.datasets import torsional as arrays
from facegear.floquet.models import replace_parameter, value_of
from facegear.floquet.multipliers import growth_rate
from facegear.mechanics.gearboxes import DRIVE, FIGURES
from facegear.support.labelled import label_rows
from facegear.support.parameters import rad_per_s
from tests.independent.torsional_switching import numbers_of, spectral_radius


@cache
def table_7_13a():
    return arrays.resonances(FIGURES["7.13a"], 1e-6)


@pytest.mark.parametrize("name", ["7.9b", "7.11a", "7.12a", "7.13b"])
def test_axes_run_from_end_to_end(name):
    figure = FIGURES[name]
    values = arrays.axis_values(figure, 7)
    assert values[[0, -1]] == pytest.approx([figure.lowest, figure.highest], rel=1e-14)
    steps = np.diff(np.log(values) if figure.scale == "log" else values)
    assert steps == pytest.approx(np.full(6, steps[0]))
    with pytest.raises(ValueError, match="count"):
        arrays.axis_values(figure, 1)


def test_row_is_that_of_single_systems():
    figure = FIGURES["7.12a"]
    model = figure.model()
    speeds = np.linspace(150.0, 1000.0, 120)
    value = value_of(model, figure.parameter)
    (row,) = arrays.growth_map(figure, speeds, [value], jobs=1)["growth_rate"].values
    for index in (0, 17, 63, 119):
        assert row[index] == pytest.approx(growth_rate(model.system(rad_per_s(speeds[index]))), abs=1e-6)
    (alone,) = arrays.growth_map(figure, [650.0], [value], jobs=1)["growth_rate"].values
    assert alone == pytest.approx([growth_rate(model.system(rad_per_s(650.0)))], abs=1e-6)


def test_map_has_the_unstable_cells_of_dop853():
    figure = FIGURES["7.13a"]
    chart = arrays.growth_map(figure, [571.0, 600.0, 650.0], [1e-6, 2e-5], jobs=1)
    for i, value in enumerate(chart["output_damping"].values.tolist()):
        numbers = numbers_of(replace_parameter(figure.model(), "output_damping", value))
        for j, speed in enumerate(chart["speed_rpm"].values.tolist()):
            truth = math.log(spectral_radius(numbers, speed)) * speed * DRIVE.gear_teeth / 60
            assert float(chart["growth_rate"][i, j]) == pytest.approx(truth, abs=1e-6)
    assert (chart["growth_rate"].values > 0).tolist() == [[True, False, True], [False, False, True]]


def test_options_replace_fields_of_the_caption():
    chart = arrays.growth_map(FIGURES["7.12a"], [650.0, 660.0], [1e-5], jobs=1, arm="conjugate")
    assert "arm = conjugate" in chart.attrs["parameters"]


def test_resonances_of_figure_7_13a():
    table = table_7_13a()
    floquet, hsu, blocks = (arrays.intervals(table, method) for method in ("floquet", "hsu", "blocks"))
    assert set(floquet) == {"(1+1)/4", "(1+1)/2", "(1+2)/2", "(1+1)/1"}
    # The combination near 570 rpm needs a third frequency in resonance; the third order is not there.
    assert "(1+2)/2" not in hsu
    assert "(1+2)/2" in blocks
    assert "(1+1)/3" in hsu
    assert "(1+1)/3" not in floquet
    assert floquet["(1+2)/2"][0] < 570 < floquet["(1+2)/2"][1]


def test_borders_are_where_dop853_finds_multipliers_of_one():
    lower, upper = arrays.intervals(table_7_13a(), "floquet")["(1+1)/2"]
    numbers = numbers_of(replace_parameter(FIGURES["7.13a"].model(), "output_damping", 1e-6))
    for border, outward in ((lower, -1), (upper, 1)):
        # 0.01 rpm on either side of a border
        assert (
            spectral_radius(numbers, border + 0.01 * outward)
            < 1
            < spectral_radius(numbers, border - 0.01 * outward)
        )


def test_repeated_labels_get_primes():
    class Band:
        label, lower, upper = "(1+1)/2", 10.0, 11.0

    assert list(arrays._by_label([Band, Band, Band])) == ["(1+1)/2", "(1+1)/2'", "(1+1)/2''"]


def test_natural_frequencies_and_veering():
    data = arrays.natural_frequencies(FIGURES["7.8b"], 41)
    # Between them a crossing of nearly uncoupled modes: pinion on its shaft, load on its own.
    assert 1.0 < float(data["veering"][1]) < 3.0
    assert 0.0 < float(data["closest"][1]) < 1e-3
    assert np.isnan(float(data["veering"][0]))
    assert data["natural_speed"].values == pytest.approx(data["frequency"].values * 60 / 107)
    # Beyond the veering the highest mode is the pinion on k1 and the mesh.
    box = FIGURES["7.8b"].gearbox.in_si
    pinion = box.input_stiffness + box.mesh_stiffness * DRIVE.contact_ratio * DRIVE.base_radius**2
    alone = math.sqrt(pinion / box.pinion_inertia) / (2 * math.pi)
    assert float(data["frequency"][2, -1]) == pytest.approx(alone, rel=1e-3)


def test_moment_arms_are_the_skew_line():
    data = arrays.moment_arms(FIGURES["7.12a"].model(), 50)
    cosine = math.cos(DRIVE.pressure_angle)
    time = data["time"].values
    age = time % 1.0
    slope = (DRIVE.outer_radius - DRIVE.inner_radius) / DRIVE.contact_ratio
    assert data["printed"].values[0] == pytest.approx((DRIVE.outer_radius - slope * age) * cosine)
    assert data["pairs"].values.mean() == pytest.approx(DRIVE.contact_ratio, abs=0.02)
    assert float(data["conjugate"]) == pytest.approx(DRIVE.base_radius * 107 / 31)


def test_figure_holds_map_tongues_and_bands():
    figure = FIGURES["7.12a"]
    chart = arrays.stability_figure(figure, columns=40, rows=3, sections=1, jobs=1)
    assert chart["growth_rate"].shape == (3, 40)
    assert label_rows(chart["label"]) == [["(1+1)/1"]]
    found = arrays.section_intervals(chart, "(1+1)/1")
    ((value, (lower, upper)),) = found.items()
    assert value == pytest.approx(math.sqrt(figure.lowest * figure.highest))
    assert lower < 650 < upper
    assert arrays.section_intervals(chart, "(1+1)/4") == {}
    with pytest.raises(ValueError, match="columns"):
        arrays.stability_figure(figure, columns=1)
