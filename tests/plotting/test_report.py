"""Figures of the report on a drive: what is drawn is what the arrays say."""

import numpy as np
import pytest
import xarray as xr

from facegear.plotting import report as draw


def tongues(lower, upper, labels):
    count = np.arange(len(lower))
    return xr.Dataset(
        {"lower": ("tongue", lower), "upper": ("tongue", upper)},
        coords={"tongue": count, "label": ("tongue", np.array(labels, dtype=str))},
    )


NONE = tongues([], [], [])
TWO = tongues([200.0, 600.0], [220.0, 700.0], ["(1+1)/1", "mean 2"])
SPEEDS = np.linspace(100.0, 1000.0, 10)


def texts(ax):
    return [text.get_text() for text in ax.texts]


@pytest.mark.parametrize("table", [NONE, TWO], ids=["stable", "two tongues"])
def test_combinations_mark_every_tongue_on_the_mesh_frequency(table):
    count = table.sizes["tongue"]
    data = xr.Dataset(
        {
            "mesh_frequency": ("speed_rpm", 2.0 * SPEEDS),
            "natural_frequency": (("mode", "speed_rpm"), np.full((3, 10), 150.0)),
            "combination": (("label", "speed_rpm"), np.full((count, 10), 400.0)),
        },
        coords={"speed_rpm": SPEEDS, "label": table["label"].values},
    )
    (ax,) = draw.combinations(data, table).axes
    assert texts(ax) == table["label"].values.tolist()
    drawn = [line.get_xydata() for line in ax.lines if line.get_linewidth() == 5 and len(line.get_xdata())]
    np.testing.assert_allclose(
        np.array(drawn).reshape(count, 4),
        [[low, 2 * low, high, 2 * high] for low, high in zip(table["lower"], table["upper"], strict=True)]
        if count
        else np.empty((0, 4)),
    )
    assert "[Hz]" in ax.get_ylabel()
    assert "[rpm]" in ax.get_xlabel()


def test_a_name_that_returns_is_written_once():
    table = tongues([200.0, 600.0], [220.0, 700.0], ["mean 1", "mean 1"])
    data = xr.Dataset(
        {
            "mesh_frequency": ("speed_rpm", 2.0 * SPEEDS),
            "natural_frequency": (("mode", "speed_rpm"), np.full((3, 10), 150.0)),
            "combination": (("label", "speed_rpm"), np.empty((0, 10))),
        },
        coords={"speed_rpm": SPEEDS, "label": np.array([], dtype=str)},
    )
    (ax,) = draw.combinations(data, table).axes
    assert texts(ax) == ["mean 1"]


@pytest.mark.parametrize("growth", [-1.0, 1.0, None], ids=["stable", "unstable", "both"])
def test_map_shows_the_drives_own_value_in_the_unit_of_the_axis(growth):
    values = np.array([1.0, 2.0, 3.0])
    rates = np.linspace(-1.0, 1.0, 30).reshape(3, 10) if growth is None else np.full((3, 10), growth)
    chart = xr.Dataset(
        {"growth_rate": (("stiffness", "speed_rpm"), rates)},
        coords={"stiffness": values, "speed_rpm": SPEEDS},
    )
    ax, bar = draw.growth_map(chart, TWO, 2.0, "stiffness [kN]", 1e-3).axes
    assert ax.get_ylim() == (1e-3, 3e-3)
    heights = {float(np.unique(line.get_ydata())[0]) for line in ax.lines if len(line.get_ydata())}
    assert heights == {2e-3}
    assert "[1/s]" in bar.get_ylabel()
    shown = ax.collections[0].get_array()
    assert np.ma.getmaskarray(shown).ravel().tolist() == (rates.ravel() <= 0).tolist()


def test_strips_are_red_where_it_is_unstable():
    (ax,) = draw.speed_strips({"first": TWO, "second": NONE}, (100.0, 1000.0)).axes
    assert [label.get_text() for label in ax.get_yticklabels()] == ["first", "second"]
    spans = [(bar.get_x(), bar.get_width()) for bar in ax.patches]
    assert spans == [(100.0, 900.0), (200.0, 20.0), (600.0, 100.0), (100.0, 900.0)]
    assert texts(ax) == ["(1+1)/1", "mean 2"]


def test_a_tongue_too_narrow_to_see_is_a_line_wide():
    (ax,) = draw.speed_strips({"one": tongues([500.0], [500.001], ["(1+1)/1"])}, (100.0, 1000.0)).axes
    assert ax.patches[1].get_width() == pytest.approx(1.8)


def test_changes_are_green_where_more_is_better():
    slopes = {"width_slope": ("change", [-3.0, 2.0])}
    data = xr.Dataset(slopes, coords={"change_name": ("change", ["mass; total", "damping"])})
    (ax,) = draw.changes(data).axes
    assert [label.get_text() for label in ax.get_yticklabels()] == ["mass; total", "damping"]
    assert [bar.get_width() for bar in ax.patches] == [-3.0, 2.0]
    better, worse = (bar.get_facecolor() for bar in ax.patches)
    assert better[1] > better[0]
    assert worse[0] > worse[1]
