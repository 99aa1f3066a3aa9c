"""Arrays and figures of the chapter on flexible teeth."""

from dataclasses import replace

import numpy as np
import pytest

import facegear as fg
from compendium.datasets import flexible_teeth as arrays
from compendium.plotting import flexible_teeth as draw
from tests.figures import texts

BODY = fg.Body(fg.Drive(26, 130, 3.175e-3), 0.03, nodal_circles=0, nodal_diameters=2)
HELD = fg.Transverse(BODY, fg.MeshLoad(1.0, 3e-6, 1.0))
SPRUNG = fg.MeshOscillator(BODY, HELD.load, mesh_stiffness=2e8, mesh_damping=1e-5)
SPEEDS = [400.0, 500.0, 600.0]


@pytest.fixture(scope="module")
def maps():
    return arrays.growth_maps({"rigid": HELD, "flexible": SPRUNG}, SPEEDS, "stiffness", [0.5, 1.0], jobs=1)


def test_maps_hold_growth_rates_of_single_cells(maps):
    for place, model in enumerate((HELD, SPRUNG)):
        cell = fg.growth_rate(
            fg.replace_parameter(model, "stiffness", 0.5).system(float(fg.rad_per_s(600.0)))
        )
        assert float(maps.growth_rate[place, 0, 2]) == pytest.approx(cell, abs=1e-6)


def test_rows_are_maps_of_one_value(maps):
    rows = arrays.growth_rows({1.0: HELD, 2.0: SPRUNG}, SPEEDS, "stiffness", 1.0, jobs=1)
    np.testing.assert_allclose(rows.growth_rate.values[0], maps.growth_rate.values[:, 1], atol=1e-6)
    assert rows.value.values.tolist() == [1.0, 2.0]


def test_tongues_stand_under_the_names_of_their_models():
    found = [fg.tongues(model, fg.rad_per_s([600.0, 900.0])) for model in (HELD, SPRUNG)]
    data = arrays.tongues_of(["rigid", "flexible"], found)
    assert data.model_name.values.tolist() == ["rigid", "flexible"]
    for section, one in enumerate(found):
        lower = data.lower.values[section]
        assert lower[~np.isnan(lower)].tolist() == pytest.approx(
            [float(fg.rpm(tongue.lower)) for tongue in one]
        )
    assert any(found)


def test_a_model_is_asked_for_what_its_tongues_hang_together_with():
    wave = fg.PiecewiseChebyshev.fit(lambda x, piece: 1e-6 * np.cos(2.0 * np.pi * x), [0.0])
    speeds = fg.rad_per_s(np.linspace(300.0, 1000.0, 36))
    found = fg.tongues(SPRUNG, (speeds[0], speeds[-1]))
    told = arrays.looked_at(SPRUNG, found, ("load.damping", "mesh_stiffness"), wave, speeds)
    assert 0 < told.predicted <= len(found)
    strongest = max(found, key=lambda tongue: tongue.growth_rate)
    step = 1e-4
    moved = (replace(SPRUNG, mesh_stiffness=part * SPRUNG.mesh_stiffness) for part in (1 - step, 1 + step))
    before, after = (fg.growth_rate(model.system(strongest.peak)) for model in moved)
    assert told.lever == "mesh_stiffness"
    assert told.change == pytest.approx(0.01 * (after - before) / (2.0 * step), rel=1e-3)
    assert told.resonance
    assert speeds[0] < told.speed < speeds[-1]
    assert told.force > 0.0
    without = arrays.looked_at(HELD, (), ("load.damping",), wave, speeds[:5])
    assert (without.predicted, without.lever) == (0, "")


def test_shares_count_what_grows():
    growth = np.array([[[-1.0, 2.0], [-3.0, -4.0]]])
    data = arrays.growth_maps({"rigid": HELD}, SPEEDS[:2], "stiffness", [0.5, 1.0], jobs=1)
    data["growth_rate"] = (("model", "value", "speed"), growth)
    assert arrays.shares(data) == {"rigid": (25.0, 2.0)}


def test_figures_name_what_they_show(maps):
    shown = texts(draw.growth_maps(maps, "stiffness [x]"))
    assert all(words in shown for words in ("rigid", "flexible", "stiffness [x]"))
    largest = max(share for share, _ in arrays.shares(maps).values())
    assert f"{largest:.2g}\N{NO-BREAK SPACE}%" in shown
    lengths = {"equal": {"fast": 20.0, "slow": 1.0}, "length": {"fast": 10.0, "slow": 0.5}}
    shown = texts(draw.bars(lengths, "share [%]"))
    assert all(words in shown for words in ("20.0", "0.5", "share [%]", "fast"))
