"""Arrays of chapter 4's figures, and the drawings made of them."""

import matplotlib as mpl
import numpy as np
import pytest
import xarray as xr

from compendium.datasets import disk as disk_arrays
from compendium.datasets import map_readings
from compendium.datasets import transverse as arrays
from compendium.plotting import transverse as draw
from facegear.floquet.models import replace_parameter
from facegear.floquet.multipliers import growth_rate
from facegear.mechanics.cases import CASE_1, FIGURES
from facegear.mechanics.mode_shapes import plate_modes
from facegear.plotting import modes
from facegear.support.parameters import rad_per_s
from tests.figures import check_round_trip, texts

MODEL = FIGURES["4.4a"].model()


@pytest.fixture(scope="module")
def figure():
    return arrays.stability_figure(MODEL, "stiffness", 2.0, cells=10, sections=1, traced_rpm=400.0, jobs=1)


@pytest.fixture(scope="module")
def line():
    return arrays.convergence(FIGURES["4.4c"].model(), [(1, 3), (1, 2)], [500.0, 540.0, 600.0, 620.0], jobs=1)


def test_maps_hold_growth_rates_of_single_cells(figure, tmp_path):
    check_round_trip(figure, tmp_path)
    for value, speed in ((0.2, 500.0), (1.0, 700.0), (2.0, 1000.0)):
        system = replace_parameter(MODEL, "stiffness", value).system(float(rad_per_s(speed)))
        cell = float(figure["growth_rate"].sel(stiffness=value, speed_rpm=speed))
        assert cell == pytest.approx(growth_rate(system), abs=1e-4)


def test_traced_borders_have_no_growth(figure):
    section = figure.isel(section=0)
    assert (figure["label"] != "").sum() == section["lower"].notnull().sum() > 0
    model = replace_parameter(MODEL, "stiffness", float(section["section"]))
    for side in ("lower", "upper"):
        for speed in section[side].dropna("tongue").values:
            # The threshold of the search is a growth of 1e-8 in a mesh period.
            assert abs(growth_rate(model.system(float(rad_per_s(speed))))) < 1e-3
    peak = float(rad_per_s(float(section["peak"][0])))
    assert growth_rate(model.system(peak)) == pytest.approx(float(section["largest_growth"][0]), rel=1e-6)


def blind_chart(parameter, values):
    """Return a map that sees nothing of the tongues."""
    growth = xr.DataArray(
        np.full((len(values), 1), -1.0),
        dims=(parameter, "speed_rpm"),
        coords={parameter: values, "speed_rpm": [620.0]},
    )
    return xr.Dataset({"growth_rate": growth})


def test_windows_end_where_a_search_finds_what_lies_between_the_speeds_of_a_map():
    values = [0.25, 1.0, 1.8, 1.9, 2.0, 2.3, 3.0]
    # Above the window differences with the lowest modes open, near 400 rpm; a map of one speed sees neither kind.
    ((low, high),) = map_readings.tongue_free(MODEL, blind_chart("stiffness", values), 350.0)
    assert (low, high) == (1.8, 2.0)
    assert map_readings.tongue_free(MODEL, blind_chart("stiffness", values[:2]), 500.0) == ()
    assert map_readings.tongue_free(MODEL, blind_chart("stiffness", values[-2:]), 350.0) == ()


def test_unstable_rows_part_the_windows():
    chart = blind_chart("stiffness", [1.8, 1.85, 1.9, 1.95, 2.0])
    chart["growth_rate"][2] = 1.0
    assert map_readings.tongue_free(MODEL, chart, 500.0) == ((1.8, 1.85), (1.95, 2.0))


@pytest.mark.parametrize(
    ("number", "kinds"), [("4.4a", {0.5: 1.0, 4.0: -1.0}), ("4.5a", {0.6: 1.0, 1.8: -1.0})]
)
def test_sums_need_both_frequencies_on_one_side_of_the_bearing_and_differences_one_on_each(number, kinds):
    found = arrays.resonances_of_bearing(FIGURES[number].model(), list(kinds), (350.0, 620.0))
    sides = (found["first"] - found["bearing"]) * (found["second"] - found["bearing"])
    assert found.sizes["tongue"] >= 3
    assert (np.sign(sides) == found["sign"]).all()
    for value, sign in kinds.items():
        assert set(found["sign"].values[found["stiffness"] == value]) == {sign}


def test_share_and_intervals_of_known_growth():
    growth = xr.DataArray(
        [1.0, -1.0, -1.0, 1.0, 3.0, -1.0], dims="speed_rpm", coords={"speed_rpm": np.arange(6.0)}
    )
    assert map_readings.unstable_runs(growth) == [(0.0, 0.5), (2.5, 4.75)]
    assert map_readings.unstable_share(xr.Dataset({"growth_rate": growth})) == 0.5
    assert map_readings.unstable_runs(-abs(growth)) == []


def test_convergence_starts_from_the_model_itself(line, tmp_path):
    check_round_trip(line, tmp_path)
    model = FIGURES["4.4c"].model()
    for k, speed in enumerate(line["speed_rpm"].values):
        expected = growth_rate(model.system(float(rad_per_s(speed))))
        assert float(line["growth_rate"][0, k]) == pytest.approx(expected, abs=1e-4)


def test_families_are_stacks_of_maps(tmp_path):
    family = arrays.map_family(MODEL, "mass", [0.5, 1.0], [500.0, 540.0], "stiffness", [0.2, 0.6], jobs=1)
    check_round_trip(family, tmp_path)
    alone = arrays.growth_map(MODEL, [500.0, 540.0], "stiffness", [0.2, 0.6], jobs=1)
    np.testing.assert_allclose(family["growth_rate"].sel(mass=1.0), alone["growth_rate"], rtol=1e-9)
    marked = alone.assign(growth_rate=alone["growth_rate"] + 7.0)
    axes = ([500.0, 540.0], "stiffness", [0.2, 0.6])
    with_known = arrays.map_family(MODEL, "mass", [0.5, 1.0], *axes, known={1.0: marked}, jobs=1)
    np.testing.assert_allclose(with_known["growth_rate"].sel(mass=1.0), marked["growth_rate"], rtol=1e-9)
    with pytest.raises(ValueError, match="speed_rpm"):
        arrays.map_family(
            MODEL, "mass", [0.5, 1.0], [500.0, 541.0], "stiffness", [0.2, 0.6], known={1.0: alone}, jobs=1
        )


def test_small_arrays_survive_their_files(tmp_path):
    for dataset in (
        plate_modes(CASE_1, samples=5),
        disk_arrays.stiffness_of_disk(CASE_1, [0.0, 1000.0]),
        disk_arrays.centroid_motion(CASE_1, [1.5, 3.0], samples=11),
    ):
        check_round_trip(dataset, tmp_path)


def test_drawings_carry_their_labels(figure, line):
    before = dict(mpl.rcParams)
    shown = texts(draw.stability_maps({"(a) map": figure}, {"(a) map": ((1.8, 2.0),)}))
    assert "no tongue found" in shown
    assert figure["label"].values[0, 0] in shown
    assert "no tongue found" not in texts(draw.stability_maps({"(a) map": figure}, {"(a) map": ()}))
    wide = texts(draw.wide_maps({"I": figure}, {"I": ((1.8, 2.0),)}, {"I": {"a line": 1.0}}))
    assert "a line" in wide
    assert "no tongue found" in wide
    assert "second" in texts(draw.compared_maps({"first": figure, "second": figure}))
    assert "alone" in texts(draw.one_map(figure, "alone", 10.0))
    assert "$N$ = 2" in texts(draw.convergence(line))
    assert "(1, 3)" in texts(modes.plate_modes(plate_modes(CASE_1, samples=9)))
    stiffness = disk_arrays.stiffness_of_disk(CASE_1, [0.0, 1000.0])
    assert "(b) II" in texts(draw.disk_stiffness({"(a) I": stiffness, "(b) II": stiffness}))
    motion = disk_arrays.centroid_motion(CASE_1, [1.5, 3.0], samples=11)
    assert "slow" in texts(draw.centroid_on_two_clocks(motion, ["fast", "slow"]))
    assert dict(mpl.rcParams) == before


def test_hsu_over_floquet(figure, tmp_path):
    bands = arrays.hsu_bands(MODEL, "stiffness", [0.25], (500.0, 560.0), order=1)
    check_round_trip(bands, tmp_path)
    assert (bands["lower"] < bands["centre"]).all()
    assert (bands["centre"] < bands["upper"]).all()
    assert "Hsu, first order" in texts(draw.hsu_over_floquet(figure, bands))
