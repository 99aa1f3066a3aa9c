"""The live explorer: controls, a map that can be clicked, one cell of it in detail; and the same as a picture."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Iterator
from html import escape
from pathlib import Path
from typing import Any

import ipywidgets
import numpy as np
import xarray as xr
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from facegear.drives.cell import cell_detail
from facegear.drives.cell_figure import RING, cell_figure, described, draw_detail, rows
from facegear.drives.explore import View, map_stages, reading_map, unstable
from facegear.drives.map_figure import heat, map_figure, scale_end
from facegear.drives.studies.study import Quantity, Study
from facegear.drives.widgets import (
    BEHIND,
    WHOLE_LABELS,
    entry_of,
    look,
    menu_of,
    refused,
    said,
    shown,
    small,
    typed,
    widget_of,
)
from facegear.floquet.models import Model, replace_parameter
from facegear.plotting.interactive import image
from facegear.plotting.style import GROWTH, WIDTH, styled
from facegear.support.types import FloatArray

_REFUSALS = (TypeError, ValueError, ArithmeticError)
# Seconds of computing after which it is heard what a reader has changed meanwhile, and after which a map that grows is
# drawn anew: browsers take their time.
_HEARD, _APART = 0.05, 0.2
_ORDINALS = {1: "every", 2: "every second", 4: "every fourth", 8: "every eighth"}


@styled
def picture(view: View) -> Figure:
    """Draw the explorer as it looks after a click, for readers without a kernel.

    Parameters
    ----------
    view : View
        From :func:`facegear.drives.explore.view`.
    """
    lower = 3.1 * rows(view.detail)
    figure = Figure(figsize=(WIDTH, 3.9 + lower), layout="constrained")
    parts: Any = figure.subfigures(2, 1, height_ratios=(3.9, lower))
    above, below = parts
    ax = above.subplots()
    speed, vertical = view.study.speed, view.vertical
    growth = np.ma.masked_array(view.chart.values, ~unstable(view.chart))
    mesh = ax.pcolormesh(
        view.chart["speed"] / speed.unit,
        view.chart[view.chart.dims[0]] / vertical.unit,
        growth,
        cmap=GROWTH,
        norm=Normalize(0.0, scale_end(view.chart)),
        shading="nearest",
        rasterized=True,
    )
    ax.plot(view.detail.speed / speed.unit, view.value / vertical.unit, "o", **RING)
    ax.set(xlabel=speed.label, ylabel=vertical.label)
    ax.grid(False)
    figure.colorbar(mesh, ax=ax, label="growth rate [1/s]")
    draw_detail(below, view.detail)
    return figure


class MapExplorer:
    """Controls, a stability map and the detail of a cell, alive in JupyterLab and Voilà.

    A control that changes draws the map anew, coarse at first and as it grows; a click on the map, or the two sliders
    below it, show multipliers, critical motion and tongue of a cell. What the study refuses is said beside the
    controls.

    Parameters
    ----------
    study : Study
        What is explored.
    folder : str or Path
        Where drive files are saved.

    Attributes
    ----------
    controls : dict of str to ipywidgets.Widget
        By name, "highest_speed" and the like among them.
    entries : dict of str to ipywidgets.Text
        By name, a field beside each slider. What lies out of its range, or is no number, is refused with a message.
    vertical : ipywidgets.Dropdown
        What is on the vertical axis.
    column, row : ipywidgets.IntSlider
        The cell that is shown in detail.
    figure : plotly.graph_objects.FigureWidget
        The map, and the mark of the cell.
    message, status, report : ipywidgets.HTML
        What was refused; how far the map is; the cell in words.
    picture : ipywidgets.HTML
        The cell drawn.
    name, save : ipywidgets.Text, ipywidgets.Button
        Name of a drive file, and what writes it as the controls stand; for studies of a drive.
    saved : ipywidgets.HTML
        What became of it.
    widget : ipywidgets.Widget
        All of it.
    """

    def __init__(self, study: Study, folder: str | Path = ".") -> None:
        self.study = study
        self.folder = Path(folder)
        self.controls = {control.name: widget_of(control) for control in (*study.controls, study.speed)}
        self.controls[study.speed.name].description = f"highest {study.speed.label}"
        self.entries = {
            control.name: entry_of(control)
            for control in (*study.controls, study.speed)
            if isinstance(control, Quantity)
        }
        swept = [(quantity.label, quantity.name) for quantity in study.sweepable]
        self.vertical = menu_of("vertical axis", swept, study.vertical)
        self.column, self.row = ipywidgets.IntSlider(**look()), ipywidgets.IntSlider(**look())
        for slider in (self.column, self.row):
            slider.readout, slider.continuous_update = False, False
        self.message, self.status, self.report, self.picture = (ipywidgets.HTML() for _ in range(4))
        self.name = ipywidgets.Text(value="my_drive.yaml", description="drive file", **look())
        self.save = ipywidgets.Button(description="Save as drive file")
        self.save.on_click(lambda _: self.save_as(self.name.value))
        self.saved = ipywidgets.HTML()
        # Plotly's widget loses what is changed before a page shows it (Voilà shows it last): complete from the start.
        self._turn = 0
        self._write: dict[str, Callable[[Any], None]] = {}
        self._quantity = study.swept(study.vertical)
        self._model, axes = self._begun(self._quantity)
        self._chart = reading_map(self._model, *axes)
        self.figure = map_figure(self._chart, self._quantity, study.speed)
        self.figure.data[0].on_click(self.click)
        rows, columns = self._chart.shape
        self.column.max, self.row.max = columns - 1, rows - 1
        self.column.value, self.row.value = columns // 2, rows // 2
        self.status.value = small(f"{columns} × {rows} cells")
        self.widget = self._laid_out()
        self._show_cell()
        for control in (*self.controls.values(), self.vertical):
            control.observe(lambda _: self.refresh(), "value")
        for quantity in (*study.controls, study.speed):
            if isinstance(quantity, Quantity):
                self._join(quantity)
        for slider in (self.column, self.row):
            slider.observe(self._moved, "value")

    def _repr_mimebundle_(self, **options: Any) -> Any:
        return self.widget._repr_mimebundle_(**options)

    @property
    def settings(self) -> dict[str, Any]:
        """What the controls say, as shown."""
        return {name: control.value for name, control in self.controls.items()}

    def _join(self, quantity: Quantity) -> None:
        """Let slider and field of a quantity follow each other."""
        slider, entry = self.controls[quantity.name], self.entries[quantity.name]

        def read(_change: Any) -> None:
            try:
                number = typed(quantity, entry.value)
            except ValueError as problem:
                self._refuse(problem)
                return
            if number == slider.value:
                self.refresh()
            else:
                slider.value = number

        def write(_change: Any) -> None:
            entry.unobserve(read, "value")
            entry.value = shown(slider.value)
            entry.observe(read, "value")

        entry.observe(read, "value")
        slider.observe(write, "value")
        self._write[quantity.name] = write

    def refresh(self) -> None:
        """Compute the map for what the controls say, or say why there is none."""
        quantity = self.study.swept(self.vertical.value)
        try:
            model, axes = self._begun(quantity)
            stages = map_stages(model, *axes)
            first = next(stages)
        except _REFUSALS as problem:
            self._refuse(problem)
            return
        self.message.value = ""
        for write in self._write.values():
            # What was refused is nowhere any more.
            write(None)
        self._turn += 1
        exchanged, self._model, self._quantity = quantity != self._quantity, model, quantity
        if exchanged:
            # On the new axis the cell is where the control of that quantity stands.
            values = first[first.dims[0]].values / quantity.unit
            self._place(self.column.value, int(np.abs(values - self.settings[quantity.name]).argmin()))
        self._draw(first)
        self._mark()
        self.report.value = small("This cell is computed when the map is.")
        self.picture.add_class(BEHIND)
        _in_pieces(self._refine(stages, self._turn))

    def _begun(self, quantity: Quantity) -> tuple[Model, tuple[FloatArray, str, FloatArray]]:
        """Model and axes of what the controls say; controls that do not matter are switched off."""
        settings = self.settings
        for control in self.study.controls:
            if isinstance(control, Quantity):
                off = control is quantity or not control.matters(settings)
                self.controls[control.name].disabled = self.entries[control.name].disabled = off
        model = self.study.model(settings)
        speeds, values = self.study.axes(settings, quantity.name)
        assert quantity.parameter is not None
        return model, (speeds, quantity.parameter, values)

    def click(self, _trace: Any, points: Any, _state: Any) -> None:
        """Show the cell that was clicked; the signature is Plotly's.

        Parameters
        ----------
        points : plotly.callbacks.Points
            Its ``xs`` and ``ys`` are the cell's place on the axes.
        """
        if not points.xs:
            return
        speeds, values = (self._chart[name].values for name in ("speed", self._chart.dims[0]))
        column = int(np.abs(speeds / self.study.speed.unit - points.xs[0]).argmin())
        row = int(np.abs(values / self._quantity.unit - points.ys[0]).argmin())
        self._place(column, row)
        self._show_cell()

    def _place(self, column: int, row: int) -> None:
        """Put the sliders on a cell without showing it yet."""
        for slider, place in ((self.column, column), (self.row, row)):
            slider.unobserve(self._moved, "value")
            slider.value = place
            slider.observe(self._moved, "value")

    def _moved(self, _change: Any) -> None:
        self._show_cell()

    def save_as(self, name: str) -> None:
        """Write the drive as the controls have it, or say why not.

        Parameters
        ----------
        name : str
            Of a file in the folder of the explorer; one that is there is not replaced.
        """
        try:
            path = self.folder / Path(name).name
            if path.name != name or path.suffix not in (".yaml", ".yml"):
                raise ValueError(
                    f"name must be that of a file ending in .yaml, without a folder, got {name!r}"
                )
            text = self.study.drive_text(self.settings)
            with path.open("x", encoding="utf-8") as file:
                file.write(text)
        except FileExistsError:
            self.saved.value = said(f"{path} is there already: choose another name.")
        except (*_REFUSALS, OSError) as problem:
            self.saved.value = said(f"Not saved: {problem}")
        else:
            self.saved.value = said(f"Saved: {path.resolve()}")

    def _refuse(self, problem: Exception) -> None:
        self.message.value = refused(problem)

    def _refine(self, stages: Iterator[xr.DataArray], turn: int) -> Iterator[None]:
        """Draw the map as it grows, then the cell, unless a control has changed meanwhile."""
        started = drawn = heard = time.perf_counter()
        try:
            yield
            while turn == self._turn and (chart := next(stages, None)) is not None:
                now, whole = time.perf_counter(), chart.attrs["computed"] == 1.0
                if whole or now > drawn + _APART:
                    self._draw(chart)
                    drawn = now
                if now > heard + _HEARD:
                    yield
                    heard = time.perf_counter()
            if turn == self._turn:
                self._show_cell()
                rows, columns = self._chart.shape
                self.status.value = small(
                    f"{columns} × {rows} cells, refined in {time.perf_counter() - started:.1f} s"
                )
        except _REFUSALS as problem:
            self._refuse(problem)
            self.report.value, self.picture.value = small("This cell has not been computed."), ""

    def _draw(self, chart: xr.DataArray) -> None:
        self._chart = chart
        # A coarse map may miss where motions grow most: its colours mean at least what those of the map before did.
        final = chart.attrs["computed"] == 1.0
        end = scale_end(chart, 0.0 if final else float(self.figure.data[0].zmax))
        with self.figure.batch_update():
            self.figure.layout.yaxis.title.text = self._quantity.label
            self.figure.data[0].update(heat(chart, self._quantity, self.study.speed, end))
        row, column = (_ORDINALS[chart.attrs[name]] for name in ("row_step", "column_step"))
        self.status.value = small(
            f"refining: {row} row at {column} speed and {chart.attrs['computed']:.0%} of all cells are final"
        )

    def _cell(self) -> tuple[float, float]:
        """Speed and value of the chosen cell [SI]."""
        speed = float(self._chart["speed"][self.column.value])
        return speed, float(self._chart[self._chart.dims[0]][self.row.value])

    def _mark(self) -> None:
        """Mark the chosen cell."""
        speed, value = self._cell()
        with self.figure.batch_update():
            self.figure.data[1].x = [speed / self.study.speed.unit]
            self.figure.data[1].y = [value / self._quantity.unit]
        self.column.description = f"{self.study.speed.label}: {speed / self.study.speed.unit:.4g}"
        self.row.description = f"{self._quantity.label}: {value / self._quantity.unit:.4g}"

    def _show_cell(self) -> None:
        """Mark the chosen cell and show what happens in it."""
        quantity, (speed, value) = self._quantity, self._cell()
        assert quantity.parameter is not None
        self._mark()
        self.picture.remove_class(BEHIND)
        try:
            detail = cell_detail(replace_parameter(self._model, quantity.parameter, value), speed)
        except _REFUSALS as problem:
            self._refuse(problem)
            self.report.value, self.picture.value = small("This cell has not been computed."), ""
            return
        words = described(detail, value, quantity, self.study.speed)
        self.report.value = (
            f'<p class="facegear-report" style="line-height:1.4;white-space:normal">{escape(words)}</p>'
        )
        alt = "Multipliers in the complex plane and the critical motion. " + words
        self.picture.value = image(cell_figure(detail), alt, name="facegear-cell")

    def _laid_out(self) -> ipywidgets.Widget:
        controls = [
            ipywidgets.HBox([control, self.entries[name]], layout=ipywidgets.Layout(width="98%"))
            if name in self.entries
            else control
            for name, control in self.controls.items()
        ]
        saving = [] if self.study.content is None else [self.name, self.save, self.saved]
        left = ipywidgets.VBox(
            [ipywidgets.HTML(WHOLE_LABELS), self.vertical, *controls, self.message, *saving],
            layout=ipywidgets.Layout(width="32rem", max_width="100%"),
        )
        right = ipywidgets.VBox(
            [self.figure, self.status, self.column, self.row, self.report, self.picture],
            layout=ipywidgets.Layout(flex="1 1 30rem", min_width="20rem", overflow="hidden"),
        )
        whole = ipywidgets.HBox([left, right], layout=ipywidgets.Layout(flex_flow="row wrap", width="100%"))
        whole.add_class("facegear-explorer")
        return whole


def _in_pieces(work: Iterator[None]) -> None:
    """Do work piece by piece: between pieces a running event loop, if there is one, hears of new changes."""
    try:
        loop = asyncio.get_running_loop()
    except RuntimeError:
        for _ in work:
            pass
        return

    async def do() -> None:
        for _ in work:
            await asyncio.sleep(0.01)

    task = loop.create_task(do())
    # The loop itself holds no reference to its tasks.
    _TASKS.add(task)
    task.add_done_callback(_TASKS.discard)


_TASKS: set[asyncio.Task[None]] = set()
