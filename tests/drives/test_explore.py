"""What the explorer computes, against closed forms and the maps it takes a shorter way to."""

from dataclasses import replace

import numpy as np
import pytest

from facegear.drives.cell import cell_detail
from facegear.drives.explore import map_stages, reading_map, unstable, view
from facegear.drives.studies.drive import drive_study
from facegear.drives.studies.gearbox import gearbox_study
from facegear.drives.studies.oscillator import SQUARE as SQUARE_WAVE
from facegear.drives.studies.oscillator import oscillator_study
from facegear.maps.stability_map import stability_map
from facegear.maps.sweep import Sweep
from facegear.maps.ways import Way
from facegear.mechanics import cases
from facegear.mechanics.classical import Meissner, meissner_trace
from facegear.support.parameters import rad_per_s

SQUARE = Meissner(depth=0.6, duty=0.4)
FREQUENCIES = np.linspace(0.4, 2.6, 23)
DEPTHS = np.linspace(0.0, 0.9, 11)


def test_map_of_an_oscillator_is_unstable_where_the_trace_of_its_closed_form_says_so():
    *_, chart = map_stages(SQUARE, FREQUENCIES, "depth", DEPTHS)
    trace = np.abs(meissner_trace(FREQUENCIES, DEPTHS[:, np.newaxis], 0.4))
    clear = np.abs(trace - 2.0) > 1e-6
    assert clear.mean() > 0.9
    assert unstable(chart)[clear].tolist() == (trace > 2.0)[clear].tolist()
    # The larger of the two multipliers that have the trace for their sum and 1 for their product.
    radius = np.where(trace > 2.0, trace / 2.0 + np.sqrt(np.maximum(trace**2 / 4.0 - 1.0, 0.0)), 1.0)
    period = 2.0 * np.pi / FREQUENCIES
    assert chart.values[clear] == pytest.approx((np.log(radius) / period)[clear], abs=1e-8)


@pytest.mark.parametrize("parameter", ["depth", pytest.param("damping_ratio", marks=pytest.mark.slow)])
def test_last_stage_is_the_map_and_the_first_one_agrees_where_it_is_computed(parameter):
    model = replace(SQUARE, damping_ratio=0.02)
    values = np.linspace(0.01, 0.2, 8)
    stages = list(map_stages(model, FREQUENCIES, parameter, values))
    expected = stability_map(model, FREQUENCIES, parameter, values, jobs=1, progress=False)
    assert stages[-1].dims == expected.dims
    at_once = reading_map(model, FREQUENCIES, parameter, values)
    assert at_once.values == pytest.approx(expected.values, abs=1e-12)
    assert at_once.attrs == stages[-1].attrs
    assert at_once["period"].values == pytest.approx(2.0 * np.pi / FREQUENCIES)
    assert stages[-1].values == pytest.approx(expected.values, abs=1e-8)
    assert stages[0].values[4::8, 2::4] == pytest.approx(expected.values[4::8, 2::4], abs=1e-8)
    done = [stage.attrs["computed"] for stage in stages]
    assert done == sorted(done)
    assert done[0] < done[-1] == 1.0
    # What is not yet computed is a neighbour's, not a gap.
    assert np.isfinite(stages[0].values).all()


def test_a_slow_map_has_every_second_row_when_half_of_it_is_final():
    model, values = cases.FIGURES["4.4a"].model(), np.linspace(0.02, 0.09, 17)
    stages = list(map_stages(model, rad_per_s(np.linspace(150.0, 900.0, 12)), "thickness_ratio", values))
    (half,) = (s for s in stages if (s.attrs["row_step"], s.attrs["column_step"]) == (2, 1))
    assert half.attrs["computed"] == pytest.approx(9 / 17)
    expected = stages[-1].values
    assert half.values[::2] == pytest.approx(expected[::2], abs=1e-8)
    # Those between are their neighbours'.
    assert half.values[1::2] == pytest.approx(half.values[:-1:2])


@pytest.mark.parametrize(
    ("study", "vertical", "way"),
    [
        (drive_study(), "stiffness", "loads"),
        (drive_study(), "power", "columns"),
        (drive_study(), "thickness_ratio", "rows"),
        (gearbox_study(), "input_damping", "cells"),
    ],
)
def test_what_a_map_goes_by(study, vertical, way):
    settings, quantity = study.settings(), study.swept(vertical)
    speeds, values = study.axes(settings, vertical)
    sweep = Sweep(study.model(settings), quantity.parameter, tuple(values.tolist()), None)
    assert Way.of(sweep, speeds).name == way


@pytest.mark.parametrize("parameter", ["thickness_ratio", "power"])
def test_a_map_in_stages_is_the_map(parameter):
    model = drive_study().model(drive_study().settings({"power": 500.0}))
    speeds = rad_per_s(np.linspace(400.0, 1000.0, 30))
    values = {"thickness_ratio": np.linspace(0.02, 0.04, 12), "power": np.linspace(0.0, 9e5, 12)}[parameter]
    *_, last = map_stages(model, speeds, parameter, values)
    expected = stability_map(model, speeds, parameter, values, jobs=1, progress=False)
    assert last.dims == expected.dims
    np.testing.assert_allclose(last.values, expected.values, atol=1e-7)
    np.testing.assert_allclose(
        reading_map(model, speeds, parameter, values).values, expected.values, atol=1e-7
    )


@pytest.mark.parametrize(
    ("vertical", "changes"),
    [
        ("thickness_ratio", {"pinions": "2"}),
        ("stiffness", {"pinions": "2"}),
        ("power", {"pinions": "2"}),
        ("stiffness", {}),
    ],
)
def test_what_a_stage_says_is_final_is_so(vertical, changes):
    study = replace(drive_study(), rows=13, columns=9)
    settings = study.settings(changes)
    (speeds, values), parameter = study.axes(settings, vertical), study.swept(vertical).parameter
    stages = list(map_stages(study.model(settings), speeds, parameter, values))
    expected, steps = stages[-1].values, []
    for stage in stages:
        row_step, column_step = (stage.attrs[name] for name in ("row_step", "column_step"))
        first, second = (
            0 if step < widest else widest // 2 for step, widest in ((row_step, 8), (column_step, 4))
        )
        final = stage.values[first::row_step, second::column_step]
        np.testing.assert_allclose(final, expected[first::row_step, second::column_step], atol=1e-7)
        assert np.isclose(stage.values, expected, atol=1e-7).mean() >= stage.attrs["computed"]
        steps.append(row_step * column_step)
    assert steps == sorted(steps, reverse=True)
    assert steps[-1] == 1


def test_pieces_of_a_map_build_no_systems_for_their_periods(monkeypatch):
    """Columns of a model that has to be built for each value: periods of all values took three systems each a piece."""
    study = drive_study()
    settings = study.settings({"pinions": "2"})
    model, asked = study.model(settings), []
    build = type(model).system
    monkeypatch.setattr(type(model), "system", lambda self, speed: asked.append(speed) or build(self, speed))
    (speeds, values), power = study.axes(settings, "power"), study.swept("power").parameter
    *_, chart = map_stages(model, speeds, power, values)
    assert chart.attrs["computed"] == 1.0
    assert len(asked) < chart.size / 2
    periods = 2.0 * np.pi / (settings["gear_teeth"] * speeds)
    np.testing.assert_allclose(chart["period"], periods, rtol=1e-12)


def test_view_is_of_the_cell_that_was_asked_for():
    study = replace(oscillator_study(), columns=9, rows=7)
    shown = view(study, 1.9, 0.6, changes={"wave": SQUARE_WAVE, "duty": 0.4, "damping_ratio": 0.0})
    assert shown.detail.speed == pytest.approx(1.9)
    assert abs(shown.detail.critical) == pytest.approx(abs(cell_detail(SQUARE, 1.9).critical))
    assert shown.chart.shape == (7, 9)
