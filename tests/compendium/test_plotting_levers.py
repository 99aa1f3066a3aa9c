"""Charts of levers write every number where it belongs."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from compendium.datasets.torsional_design import SYMBOLS
from compendium.plotting import levers as draw
from facegear.support import labelled

STORED = Path(__file__).resolve().parents[2] / "data" / "reference"


def written(figure):
    return {
        (round(text.get_position()[1]), round(text.get_position()[0])): text.get_text()
        for text in figure.axes[0].texts
    }


@pytest.mark.parametrize("what", ["width_change", "centre_change"])
def test_every_number_is_where_it_belongs(what):
    data = labelled.load(STORED / "ch07_design_levers.nc")
    values = data[what].values
    expected = {
        (i, j): f"{values[i, j]:.2f}".replace("-0.00", "0.00").replace("-", "−")
        for i, j in np.ndindex(*values.shape)
    }
    assert written(draw.levers(data, SYMBOLS, what)) == expected


def test_what_is_not_there_is_a_dot_and_long_numbers_are_cut():
    data = xr.Dataset(
        {"growth_change": (("tongue", "change"), [[np.nan, -0.001, 12.34], [-123.4, 9.876, 0.0]])},
        coords={"case_name": ("tongue", ["a", "b"]), "label": ("tongue", ["(1+1)/1", "(1+2)/1"])},
    )
    figure = draw.levers(data, ("x", "y", "z"), "growth_change")
    assert written(figure) == {
        (0, 0): "·", (0, 1): "0.00", (0, 2): "12.3", (1, 0): "−123", (1, 1): "9.88", (1, 2): "0.00"
    }  # fmt: skip
    assert [label.get_text() for label in figure.axes[0].get_yticklabels()] == ["a: (1+1)/1", "b: (1+2)/1"]


def test_quantities_are_the_rows_of_a_chart_of_arrows():
    data = xr.Dataset(
        {"change_of": (("change", "quantity"), [[1.0, -2.0], [0.5, 3.0]])},
        coords={"quantity_name": ("quantity", ["mass", "stress"])},
    )
    figure = draw.arrows(data, ("x", "y"))
    assert written(figure) == {(0, 0): "1.00", (0, 1): "0.50", (1, 0): "−2.00", (1, 1): "3.00"}
    assert [label.get_text() for label in figure.axes[0].get_yticklabels()] == ["mass", "stress"]
