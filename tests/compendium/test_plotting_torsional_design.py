"""Figures of the torsional design study show what their arrays hold."""

from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest

from compendium.plotting import torsional_design as draw
from facegear.support import labelled

STORED = Path(__file__).resolve().parents[2] / "data" / "reference"


def arrays(name):
    return labelled.load(STORED / f"ch07_design_{name}.nc")


def texts(figure):
    return [text.get_text() for text in figure.findobj(mpl.text.Text) if text.get_text()]


def lines(figure):
    return [line for line in figure.axes[0].get_lines() if len(line.get_xdata()) > 2]


def test_arms_are_drawn_in_millimetres():
    data = arrays("arms")
    drawn = lines(draw.arms(data))
    for line, name in zip(drawn, ("printed", "contact_point", "conjugate"), strict=True):
        np.testing.assert_allclose(line.get_ydata(), 1e3 * data[name].values)


def test_pairs_in_mesh_name_their_contact_ratios():
    shown = texts(draw.pairs_in_mesh(arrays("pairs")))
    assert "Tregold, 1.563" in shown
    assert "geometric, 3.464" in shown


@pytest.mark.parametrize("name", ["variants_12", "variants_13"])
def test_every_tongue_of_every_variant_is_a_bar_at_its_place(name):
    data = arrays(name)
    bars = draw.variant_tongues(data).axes[0].collections
    spans = sorted((p.vertices[:, 0].min(), p.vertices[:, 0].max()) for bar in bars for p in bar.get_paths())
    found = np.isfinite(data.lower.values)
    expected = sorted(zip(data.lower.values[found], data.upper.values[found], strict=True))
    np.testing.assert_allclose(spans, expected)


def test_errors_are_drawn_in_rpm_and_over_the_width():
    data = arrays("hsu_errors")
    names = [f"resonance {i}" for i in range(6)]
    figure = draw.hsu_errors(data, names, [2.0] * 6)
    for row in range(6):
        error, width = data.border_error.values[row], data.width.values[row]
        np.testing.assert_allclose(figure.axes[0].get_lines()[row].get_ydata(), error)
        np.testing.assert_allclose(figure.axes[1].get_lines()[row].get_ydata(), error / width)


def test_openings_draw_floquet_and_hsu():
    data = arrays("openings")
    drawn = lines(draw.openings(data))
    np.testing.assert_allclose([line.get_ydata() for line in drawn[::2]], data.growth_rate.values)
    np.testing.assert_allclose([line.get_ydata() for line in drawn[1::2]], data.hsu_growth.values)


@pytest.mark.parametrize("name", ["712a", "713a", "712b", "713b"])
def test_closing_values_are_full_and_opening_ones_open(name):
    data = arrays(f"closing_{name}")
    axes = draw.closing(data, "damping [s]").axes[0]
    marks = [line for line in axes.get_lines() if line.get_marker() == "o" and len(line.get_xdata())]
    full = [x for line in marks if line.get_markerfacecolor() != "white" for x in line.get_xdata()]
    empty = [x for line in marks if line.get_markerfacecolor() == "white" for x in line.get_xdata()]
    for sign, found in ((1.0, full), (-1.0, empty)):
        np.testing.assert_allclose(
            sorted(found), np.sort(data.closing_damping.values[data.closes.values == sign])
        )
