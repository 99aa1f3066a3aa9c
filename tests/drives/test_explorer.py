"""The explorer without a browser: what its controls and a click do. With one: tests/test_voila.py."""

import asyncio
import re
from dataclasses import replace

import matplotlib as mpl
import numpy as np
import pytest
from plotly.callbacks import InputDeviceState, Points

from facegear.drives import cell_figure as cell
from facegear.drives import explore, explorer
from facegear.drives.cell import cell_detail
from facegear.drives.map_figure import scale_end
from facegear.drives.studies.gearbox import gearbox_study
from facegear.drives.studies.oscillator import SQUARE, oscillator_study
from facegear.drives.widgets import BEHIND
from facegear.mechanics import cases
from facegear.mechanics.classical import Mathieu
from facegear.support.parameters import rad_per_s

STUDY = replace(oscillator_study(), columns=12, rows=8)
NO_KEYS = InputDeviceState()


def click(widget, x, y):
    widget.click(widget.figure.data[0], Points(point_inds=[[0, 0]], xs=[x], ys=[y]), NO_KEYS)


def shown_map(widget):
    return np.array(widget.figure.data[0].z, dtype=float)


def text(html):
    return re.sub(r"<[^>]+>", "", html.value)


@pytest.fixture
def widget():
    return explorer.MapExplorer(STUDY)


def test_map_is_there_from_the_start_and_white_where_stable(widget):
    expected = explore.view(STUDY, 1.3, 0.5).chart
    unstable = explore.unstable(expected)
    assert np.isnan(shown_map(widget)).tolist() == (~unstable).tolist()
    assert shown_map(widget)[unstable] == pytest.approx(expected.values[unstable])
    assert widget.figure.layout.xaxis.title.text == "parametric frequency ω/ω₀"
    assert widget._repr_mimebundle_()["application/vnd.jupyter.widget-view+json"]


def test_a_control_changes_the_map(widget):
    before = shown_map(widget)
    widget.controls["damping_ratio"].value = 0.1
    after = shown_map(widget)
    assert np.isnan(after).sum() > np.isnan(before).sum()
    assert after.shape == before.shape
    assert "12 × 8 cells" in text(widget.status)


def test_the_vertical_axis_can_be_exchanged_and_switches_its_control_off(widget):
    assert widget.controls["depth"].disabled
    widget.vertical.value = "damping_ratio"
    assert widget.figure.layout.yaxis.title.text == "damping ratio ϑ"
    assert widget.figure.data[0].y[-1] == pytest.approx(0.2)
    assert widget.controls["damping_ratio"].disabled
    assert not widget.controls["depth"].disabled


def test_on_an_exchanged_axis_the_cell_is_where_the_control_of_its_quantity_stands(widget):
    click(widget, 2.0, 0.8)
    widget.vertical.value = "damping_ratio"
    rows, (shown,) = np.array(widget.figure.data[0].y), widget.figure.data[1].y
    set_to = widget.controls["damping_ratio"].value
    assert shown == rows[np.abs(rows - set_to).argmin()]
    assert f"damping ratio ϑ {shown:.4g}" in text(widget.report)
    assert "depth" not in text(widget.report)


def test_nothing_of_the_old_axis_stays_while_the_map_is_refined(widget):
    click(widget, 2.0, 0.8)

    async def exchange():
        widget.vertical.value = "damping_ratio"
        while_refined = text(widget.report), widget.figure.data[1].y[0], BEHIND in widget.picture._dom_classes
        while "refining" in text(widget.status):
            await asyncio.sleep(0.01)
        return while_refined

    words, mark, behind = asyncio.run(exchange())
    assert "unstable" not in words
    assert mark <= 0.2
    assert behind
    assert "damping ratio" in text(widget.report)
    assert BEHIND not in widget.picture._dom_classes


def test_colours_of_a_coarse_map_mean_what_those_of_the_map_before_did(widget):
    before = widget.figure.data[0].zmax
    assert before == scale_end(explore.view(STUDY, 1.3, 0.5).chart)

    async def change(value):
        widget.controls["damping_ratio"].value = value
        coarse = widget.figure.data[0].zmax
        while "refining" in text(widget.status):
            await asyncio.sleep(0.01)
        return coarse

    little = widget.controls["damping_ratio"].value + 0.001
    assert asyncio.run(change(little)) == before == widget.figure.data[0].zmax
    assert asyncio.run(change(0.2)) == before
    assert widget.figure.data[0].zmax < before
    assert np.nanmax(shown_map(widget)) <= widget.figure.data[0].zmax


def test_controls_that_do_not_matter_are_switched_off(widget):
    assert widget.controls["duty"].disabled
    widget.controls["wave"].value = SQUARE
    assert not widget.controls["duty"].disabled


def test_a_click_shows_the_cell(widget):
    stable = widget.picture.value
    click(widget, 2.0, 0.8)
    assert "unstable" in text(widget.report)
    assert "(1+1)/1" in text(widget.report)
    assert widget.picture.value != stable
    assert re.search(r'alt="Multipliers [^"]+\(1\+1\)/1', widget.picture.value)
    step = 2.6 * 0.95 / 11
    assert widget.figure.data[1].x[0] == pytest.approx(2.0, abs=step)
    assert widget.figure.data[1].y[0] == pytest.approx(0.8, abs=0.95 / 7)
    speed = widget.figure.data[0].x[widget.column.value]
    assert speed == pytest.approx(2.0, abs=step)
    click(widget, 1.3, 0.1)
    assert "stable" in text(widget.report)
    assert "unstable" not in text(widget.report)


def test_a_click_beside_the_cells_does_nothing(widget):
    before = widget.report.value
    widget.click(widget.figure.data[0], Points(), NO_KEYS)
    assert widget.report.value == before


def test_sliders_show_the_cell_without_a_mouse(widget):
    click(widget, 2.0, 0.8)
    before = text(widget.report)
    widget.row.value = 2
    assert text(widget.report) != before
    assert widget.figure.data[1].y[0] == pytest.approx(2 * 0.95 / 7)


def test_the_cell_follows_the_controls(widget):
    click(widget, 2.0, 0.4)
    assert "unstable" in text(widget.report)
    widget.controls["damping_ratio"].value = 0.2
    assert "unstable" not in text(widget.report)


def test_what_cannot_be_made_is_said_beside_the_controls_and_the_map_stays():
    def build(settings):
        if settings["damping_ratio"] > 0.1:
            raise ValueError("damping_ratio <too large>")
        return STUDY.build(settings)

    widget = explorer.MapExplorer(replace(STUDY, build=build))
    before = shown_map(widget)
    widget.controls["damping_ratio"].value = 0.15
    assert "damping_ratio &lt;too large&gt;" in widget.message.value
    np.testing.assert_allclose(shown_map(widget), before, rtol=1e-12)
    click(widget, 2.0, 0.8)
    assert "unstable" in text(widget.report)
    widget.controls["damping_ratio"].value = 0.05
    assert widget.message.value == ""
    assert not np.allclose(shown_map(widget), before, equal_nan=True)


def test_an_error_of_the_program_is_not_taken_for_an_impossible_setting():
    def build(settings):
        if settings["damping_ratio"] > 0.1:
            raise KeyError("a mistake")
        return STUDY.build(settings)

    widget = explorer.MapExplorer(replace(STUDY, build=build))
    with pytest.raises(KeyError, match="a mistake"):
        widget.controls["damping_ratio"].value = 0.15


@pytest.mark.slow
def test_the_last_of_two_quick_changes_wins(widget):
    """With an event loop, as in a kernel, the map is refined between other events."""
    alone = explorer.MapExplorer(STUDY)
    alone.controls["damping_ratio"].value = 0.06

    async def hurry():
        widget.controls["damping_ratio"].value = 0.18
        coarse = shown_map(widget)
        widget.controls["damping_ratio"].value = 0.06
        while "refining" in text(widget.status):
            await asyncio.sleep(0.01)
        return coarse

    coarse = asyncio.run(hurry())
    assert not np.allclose(coarse, shown_map(widget), equal_nan=True)
    # The cells shown are the unstable ones; the map of one widget is computed at once, of the other by stages.
    np.testing.assert_allclose(shown_map(widget), shown_map(alone), rtol=1e-8, atol=1e-8)


def test_a_change_ends_a_map_that_is_being_filled(widget, monkeypatch):
    """Piece by piece, and the status says how far it is."""
    for seconds in ("_HEARD", "_APART"):
        monkeypatch.setattr(explorer, seconds, 0.0)
    taken = []

    def noted(*given):
        turn = len(taken)
        taken.append(0)
        for chart in explore.map_stages(*given):
            taken[turn] += 1
            yield chart

    monkeypatch.setattr(explorer, "map_stages", noted)

    async def change():
        widget.controls["damping_ratio"].value = 0.1
        said = [text(widget.status)]
        while "every eighth row" in text(widget.status):
            await asyncio.sleep(0.001)
        said.append(text(widget.status))
        taken.append(taken[0])
        widget.controls["damping_ratio"].value = 0.05
        while "refining" in text(widget.status):
            await asyncio.sleep(0.001)
        return said

    coarse, finer = asyncio.run(change())
    assert re.fullmatch(
        r"refining: every eighth row at every fourth speed and \d+% of all cells are final", coarse
    )
    assert "every second row at every speed" in finer
    first, when_changed, second = taken
    assert first == when_changed < second
    assert "refined in" in text(widget.status)


def words(figure):
    return " ".join(part.get_text() for part in figure.findobj(mpl.text.Text))


def test_picture_of_an_oscillator():
    before = dict(mpl.rcParams)
    figure = explorer.picture(explore.view(STUDY, 2.0, 0.8))
    figure.canvas.draw()
    assert "depth of modulation ε" in words(figure)
    assert "growth rate [1/s]" in words(figure)
    assert "time [periods]" in words(figure)
    assert dict(mpl.rcParams) == before


def test_cell_of_a_disk_has_its_deflection_drawn():
    detail = cell_detail(cases.FIGURES["4.4a"].model(), float(rad_per_s(300.0)))
    figure = cell.cell_figure(detail)
    figure.canvas.draw()
    assert f"{abs(detail.critical):.5f}" in words(figure)
    assert "critical motion, real part" in words(figure)


def test_cell_of_a_gearbox_names_its_coordinates():
    study = gearbox_study()
    detail = cell_detail(study.model(study.settings()), float(rad_per_s(640.0)))
    figure = cell.cell_figure(detail)
    figure.canvas.draw()
    assert "pinion face gear load" in words(figure)


def test_borders_beyond_what_was_searched_are_not_given_as_borders():
    detail = cell_detail(Mathieu(0.9), 1.9)
    low, high = detail.searched
    clipped = replace(detail, tongue=replace(detail.tongue, lower=low, upper=high))
    depth = STUDY.swept("depth")
    sentence = cell.described(clipped, 0.9, depth, STUDY.speed)
    assert f"from below {low:.5g} to above {high:.5g}" in sentence


def test_a_number_may_be_typed(widget):
    before = shown_map(widget)
    widget.entries["damping_ratio"].value = "0.1"
    assert widget.controls["damping_ratio"].value == 0.1
    assert not np.allclose(shown_map(widget), before, equal_nan=True)
    widget.controls["damping_ratio"].value = 0.05
    assert widget.entries["damping_ratio"].value == "0.05"


@pytest.mark.parametrize(
    ("written", "told"),
    [
        ("5", "damping ratio ϑ must lie between 0 and 0.2 here, got 5"),
        ("-1", "must lie between 0 and 0.2 here, got -1"),
        ("nan", "must lie between"),
        ("much", "damping ratio ϑ must be a number, got &#x27;much&#x27;"),
    ],
)
def test_what_is_out_of_range_or_no_number_is_refused_and_not_clipped(widget, written, told):
    value, before = widget.controls["damping_ratio"].value, shown_map(widget)
    widget.entries["damping_ratio"].value = written
    assert told in widget.message.value
    assert widget.controls["damping_ratio"].value == value
    np.testing.assert_allclose(shown_map(widget), before, rtol=1e-12)
    widget.entries["damping_ratio"].value = f"{value:g}"
    assert widget.message.value == ""


def test_what_was_refused_is_gone_with_the_message(widget):
    widget.entries["damping_ratio"].value = "5"
    widget.vertical.value = "damping_ratio"
    assert widget.message.value == ""
    assert widget.entries["damping_ratio"].value == f"{widget.controls['damping_ratio'].value:g}"


def test_a_field_is_switched_off_with_its_slider(widget):
    assert widget.entries["depth"].disabled
    widget.vertical.value = "damping_ratio"
    assert not widget.entries["depth"].disabled
    assert widget.entries["damping_ratio"].disabled
