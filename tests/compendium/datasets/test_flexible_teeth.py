"""Arrays and figures of the chapter on flexible teeth."""

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


def test_shares_count_what_grows():
    growth = np.array([[[-1.0, 2.0], [-3.0, -4.0]]])
    data = arrays.growth_maps({"rigid": HELD}, SPEEDS[:2], "stiffness", [0.5, 1.0], jobs=1)
    data["growth_rate"] = (("model", "value", "speed"), growth)
    assert arrays.shares(data) == {"rigid": (25.0, 2.0)}


def test_figures_name_what_they_show(maps):
    shown = texts(draw.growth_maps(maps, "stiffness [x]"))
    assert all(words in shown for words in ("rigid", "flexible", "stiffness [x]"))
    largest = max(share for share, _ in arrays.shares(maps).values())
    assert f"{largest:.2g} %" in shown
    lengths = {"equal": {"fast": 20.0, "slow": 1.0}, "length": {"fast": 10.0, "slow": 0.5}}
    shown = texts(draw.bars(lengths, "share [%]"))
    assert all(words in shown for words in ("20.0", "0.5", "share [%]", "fast"))
