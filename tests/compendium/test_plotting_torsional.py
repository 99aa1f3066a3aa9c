"""Figures of chapter 7 draw what they are given."""

from itertools import pairwise

import numpy as np
import pytest

from compendium.datasets import torsional as arrays
from compendium.plotting import torsional as draw
from facegear.mechanics.gearboxes import FIGURES
from tests.figures import texts


def test_moment_arms():
    figure = draw.moment_arms(arrays.moment_arms(FIGURES["7.12a"].model(), 11))
    shown = texts(figure)
    assert "moment arm [mm]" in shown
    assert "pair in its second period of contact" in shown
    highest = max(np.nanmax(line.get_ydata()) for line in figure.axes[0].lines)
    assert 165 < highest < 175


def test_natural_frequencies_mark_where_modes_veer():
    data = {title: arrays.natural_frequencies(FIGURES[title], 41) for title in ("7.8b", "7.10a")}
    shown = texts(draw.natural_frequencies(data))
    assert "natural speed [rpm]" in shown
    assert "ratio 1.0001" in shown
    assert shown.count("ratio") == 1
    # 60 Hz are 60·60/107 rpm
    figure = draw.natural_frequencies(data)
    secondary = figure.axes[0].child_axes[0]
    figure.draw_without_rendering()
    low, high = secondary.get_ylim()
    assert (low, high) == pytest.approx(tuple(60 / 107 * np.array(figure.axes[0].get_ylim())))


@pytest.mark.parametrize(("name", "band"), [("7.13a", "(1+1)/1")])
def test_maps_show_traced_borders_and_names(name, band):
    chart = arrays.stability_figure(FIGURES[name], columns=20, rows=3, sections=1, jobs=1)
    figure = draw.stability_maps({"a title": chart})
    shown = texts(figure)
    assert band in shown
    assert "a title" in shown
    assert "speed of the face gear [rpm]" in shown
    borders = arrays.section_intervals(chart, band)
    lower, _ = next(iter(borders.values()))
    drawn = np.concatenate([np.asarray(line.get_xdata(), dtype=float) for line in figure.axes[0].lines])
    assert np.isclose(drawn, lower).any()
    assert figure.axes[0].get_yscale() == FIGURES[name].scale


def test_names_of_tongues_do_not_touch_one_another():
    chart = arrays.stability_figure(FIGURES["7.12b"], columns=20, rows=3, sections=4, jobs=1)
    figure = draw.stability_maps({"a title": chart})
    figure.draw_without_rendering()
    axes = figure.axes[0]
    boxes = [text.get_window_extent() for text in axes.texts]
    assert len(boxes) > 4
    boxes.sort(key=lambda box: box.x0)
    assert all(left.x1 < right.x0 for left, right in pairwise(boxes))
    assert max(box.y1 for box in boxes) < axes._left_title.get_window_extent().y0
