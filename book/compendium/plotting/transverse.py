"""Figures of chapter 4: modes of the disk, stability maps with their tongues, convergence, motion of the contact."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from facegear.plotting.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    ORANGE,
    VERMILION,
    darkest,
    draw_border,
    draw_unstable,
    growth_bar,
    panels,
    styled,
)
from facegear.support.labelled import label_rows

_AXIS = {
    "stiffness": r"bearing stiffness $\mu$",
    "damping": r"bearing damping $\zeta$ [µs]",
    "mass": r"pinion mass $\tau$",
}
_SCALE = {"stiffness": 1.0, "damping": 1e6, "mass": 1.0}
_SPEED = "speed of the face gear [rpm]"
# Part of the axis within which names of two lines would touch.
_CLOSE = 0.05
# Heights at which the name of a tongue is tried, from its section, in parts of the axis.
_SHIFTS = tuple(sign * 0.09 * k for k in range(6) for sign in ((1, -1) if k else (1,)))


def _parameter(chart: xr.Dataset) -> str:
    return str(chart["growth_rate"].dims[0])


def _draw_map(ax: Axes, chart: xr.Dataset, largest: float) -> Any:
    """Colour what is unstable and draw its border."""
    name = _parameter(chart)
    growth = chart["growth_rate"].values
    speed, value = chart["speed_rpm"].values, chart[name].values * _SCALE[name]
    mesh = draw_unstable(ax, speed, value, growth, largest)
    draw_border(ax, speed, value, growth)
    ax.set(xlim=(0.0, float(speed[-1])), ylim=(0.0, float(value[-1])), ylabel=_AXIS[name])
    ax.grid(False)
    return mesh


def _largest(charts: Sequence[xr.Dataset]) -> float:
    return max(1e-9, *(float(chart["growth_rate"].max()) for chart in charts))


def _draw_sections(ax: Axes, chart: xr.Dataset) -> None:
    """Traced borders as dots, and the names of tongues above the section where they stand highest."""
    scale = _SCALE[_parameter(chart)]
    places: dict[str, tuple[float, float, float]] = {}
    for number, labels in enumerate(label_rows(chart["label"])):
        row = chart.isel(section=number)
        height = float(row["section"]) * scale
        for side in ("lower", "upper"):
            ax.plot(row[side], np.full(row.sizes["tongue"], height), ".", color=VERMILION, markersize=4)
        for tongue, label in enumerate(labels):
            growth = float(row["largest_growth"][tongue])
            if label not in places or growth > places[label][2]:
                places[label] = (float(row["peak"][tongue]), height, growth)
    taken: list[tuple[float, float]] = []
    top = ax.get_ylim()[1]
    for label, (speed, height, _) in sorted(places.items(), key=lambda item: -item[1][2]):
        # Move up and down a little until no other name is in the way; the weakest find no place.
        heights = [height + (shift + 0.04) * top for shift in _SHIFTS]
        inside = [place for place in heights if 0.04 * top < place < 0.96 * top]
        free = [
            place
            for place in inside
            if all(abs(speed - x) > 95 or abs(place - y) > 0.1 * top for x, y in taken)
        ]
        if not free:
            continue
        place = free[0]
        taken.append((speed, place))
        if abs(place - height) > 0.06 * top:
            ax.plot([speed, speed], [height, place], color=GREY, linewidth=0.7)
        ax.text(
            speed,
            place,
            label,
            ha="center",
            va="center",
            fontsize=8,
            color=INK,
            bbox={"facecolor": "white", "alpha": 0.75, "edgecolor": "none", "pad": 0.8},
        )


def _draw_windows(ax: Axes, chart: xr.Dataset, windows: Sequence[tuple[float, float]]) -> None:
    """Values of the parameter without a tongue, as a bar at the left edge and dashed ends."""
    scale, top = _SCALE[_parameter(chart)], ax.get_ylim()[1]
    for low, high in windows:
        ends = np.array([low, high]) * scale
        ax.axvspan(0.0, 0.008 * ax.get_xlim()[1], ends[0] / top, ends[1] / top, color=GREEN)
        for end in ends[ends < 0.999 * top]:
            ax.axhline(end, color=GREEN, linestyle="--", linewidth=1.4)
        if ends[1] - ends[0] > 0.05 * top:
            ax.text(
                14 * ax.get_xlim()[1] / 1000,
                ends.mean(),
                "no tongue found",
                color=GREEN,
                va="center",
                fontsize=11,
                bbox={"facecolor": "white", "alpha": 0.8, "edgecolor": "none", "pad": 1},
            )


@styled
def stability_maps(
    charts: Mapping[str, xr.Dataset], windows: Mapping[str, Sequence[tuple[float, float]]]
) -> Figure:
    """Stability maps one below the other, with traced borders, names of tongues, windows without any (Figs 4.4, 4.5).

    Parameters
    ----------
    charts : mapping of str to xarray.Dataset
        Title to the arrays of :func:`compendium.datasets.transverse.stability_figure`.
    windows : mapping of str to sequence of (float, float)
        The same titles to what :func:`compendium.datasets.map_readings.tongue_free` returns; empty for none.
    """
    figure, axes = panels(len(charts), 1, 3.4 * len(charts))
    largest = _largest(list(charts.values()))
    for ax, (title, chart) in zip(axes, charts.items(), strict=True):
        mesh = _draw_map(ax, chart, largest)
        _draw_sections(ax, chart)
        _draw_windows(ax, chart, windows[title])
        ax.set_title(title, loc="left")
    axes[-1].set_xlabel(_SPEED)
    growth_bar(figure, axes, mesh)
    return figure


@styled
def wide_maps(
    charts: Mapping[str, xr.Dataset],
    windows: Mapping[str, Sequence[tuple[float, float]]],
    marks: Mapping[str, Mapping[str, float]],
) -> Figure:
    """Draw maps over a wide range of a parameter, and beside each the share of its speeds that is unstable.

    Parameters
    ----------
    charts : mapping of str to xarray.Dataset
        Title to the arrays of :func:`compendium.datasets.transverse.growth_map`.
    windows : mapping of str to sequence of (float, float)
        The same titles to what :func:`compendium.datasets.map_readings.tongue_free` returns.
    marks : mapping of str to mapping of str to float
        The same titles to names and heights of lines to draw.
    """
    figure, axes = panels(len(charts), 2, 3.9 * len(charts), width_ratios=(3, 1), sharey="row")
    largest = _largest(list(charts.values()))
    for (ax, beside), (title, chart) in zip(
        zip(axes[::2], axes[1::2], strict=True), charts.items(), strict=True
    ):
        mesh = _draw_map(ax, chart, largest)
        _draw_windows(ax, chart, windows[title])
        right = ax.get_xlim()[1]
        heights = np.array([*marks[title].values()])
        for name, height in marks[title].items():
            # Names of two lines close together stand above the one and below the other.
            beside_it = heights[np.abs(heights - height) < _CLOSE * ax.get_ylim()[1]]
            ax.axhline(height, color=INK, linestyle=":", linewidth=1.0)
            ax.annotate(
                name,
                (right, height),
                xytext=(3, 0),
                textcoords="offset points",
                ha="left",
                va="center" if beside_it.size == 1 else "bottom" if height > beside_it.min() else "top",
                fontsize=9,
                color=INK,
            )
        share = 100.0 * (chart["growth_rate"].values > 0.0).mean(axis=1)
        beside.plot(share, chart[_parameter(chart)].values * _SCALE[_parameter(chart)], color=VERMILION)
        beside.set_xlim(left=0.0)
        ax.set_title(title, loc="left")
    axes[-2].set_xlabel(_SPEED)
    axes[-1].set_xlabel("unstable speeds [%]")
    growth_bar(figure, axes, mesh)
    return figure


@styled
def compared_maps(charts: Mapping[str, xr.Dataset], columns: int = 2) -> Figure:
    """Draw maps side by side on one scale of colours, which ends before a narrow strip of strong growth.

    Parameters
    ----------
    charts : mapping of str to xarray.Dataset
        Title to the arrays of :func:`compendium.datasets.transverse.growth_map`.
    columns : int, optional
        Maps beside each other.
    """
    rows = -(-len(charts) // columns)
    figure, axes = panels(rows, columns, 2.9 * rows + 0.5, sharex=True)
    end = darkest(np.concatenate([chart["growth_rate"].values.ravel() for chart in charts.values()]))
    for place, (ax, (title, chart)) in enumerate(zip(axes, charts.items(), strict=True)):
        mesh = _draw_map(ax, chart, end)
        ax.set_title(title, loc="left", fontsize=10)
        if place // columns == rows - 1:
            ax.set_xlabel(_SPEED)
    growth_bar(figure, axes, mesh, beyond=_largest(list(charts.values())) > end)
    return figure


@styled
def one_map(chart: xr.Dataset, title: str, largest: float) -> Figure:
    """One map, on a scale of colours that a row of maps can share.

    Parameters
    ----------
    chart : xarray.Dataset
        From :func:`compendium.datasets.transverse.growth_map`.
    title : str
    largest : float
        Growth rate at the end of the scale [1/s].
    """
    figure, (ax,) = panels(1, 1, 3.6)
    mesh = _draw_map(ax, chart, largest)
    ax.set_title(title, loc="left")
    ax.set_xlabel(_SPEED)
    figure.colorbar(mesh, ax=ax, label="growth rate [1/s]")
    return figure


@styled
def hsu_over_floquet(chart: xr.Dataset, bands: xr.Dataset) -> Figure:
    """Hsu's bands over the map of Floquet growth rates.

    Parameters
    ----------
    chart : xarray.Dataset
        From :func:`compendium.datasets.transverse.growth_map`.
    bands : xarray.Dataset
        From :func:`compendium.datasets.transverse.hsu_bands`.
    """
    figure, (ax,) = panels(1, 1, 4.4)
    mesh = _draw_map(ax, chart, _largest([chart]))
    scale = _SCALE[_parameter(chart)]
    for number in range(bands.sizes["section"]):
        row, height = bands.isel(section=number), float(bands["section"][number]) * scale
        for band in range(bands.sizes["band"]):
            ends = [float(row["lower"][band]), float(row["upper"][band])]
            ax.plot(ends, [height, height], "|-", color=VERMILION, linewidth=1.8, markersize=9)
    ax.plot([], [], "|-", color=VERMILION, label="Hsu, first order")
    ax.legend(loc="upper left")
    ax.set_xlabel(_SPEED)
    figure.colorbar(mesh, ax=ax, label="growth rate (Floquet) [1/s]")
    return figure


@styled
def disk_stiffness(cases: Mapping[str, xr.Dataset]) -> Figure:
    """Stiffness of the disk over speed at three radii, and the reference.

    Parameters
    ----------
    cases : mapping of str to xarray.Dataset
        Title to the arrays of :func:`compendium.datasets.disk.stiffness_of_disk`.
    """
    figure, axes = panels(1, len(cases), 3.3)
    names = ("inner end $R_1$", "middle", "outer end $R_2$")
    for ax, (title, data) in zip(axes, cases.items(), strict=True):
        for place, (name, colour, style) in enumerate(
            zip(names, (ORANGE, BLUE, VERMILION), ("-.", "-", "--"), strict=True)
        ):
            ax.plot(data["speed_rpm"], data["stiffness"][place] / 1e6, style, color=colour, label=name)
        ax.axhline(float(data["reference"]) / 1e6, color=INK, linewidth=0.8, linestyle=":", label="reference")
        ax.set_title(title, loc="left")
        ax.set_xlabel(_SPEED)
        ax.set_ylim(bottom=0.0)
    axes[0].set_ylabel("stiffness of the disk [N/µm]")
    axes[0].legend(loc="lower left", ncols=2)
    return figure


@styled
def convergence(data: xr.Dataset) -> Figure:
    """Growth rates along a line of speeds for several bases.

    Parameters
    ----------
    data : xarray.Dataset
        From :func:`compendium.datasets.transverse.convergence`.
    """
    figure, (ax,) = panels(1, 1, 3.9)
    styles = zip((VERMILION, ORANGE, GREEN, BLUE), ("-", "-.", ":", "--"), strict=True)
    for number, (colour, line) in zip(range(data.sizes["basis"]), styles, strict=False):
        name = f"$M$ = {int(data['circles'][number])}, $N$ = {int(data['diameters'][number])}"
        ax.plot(data["speed_rpm"], data["growth_rate"][number], line, color=colour, label=name)
    ax.axhline(0.0, color=INK, linewidth=0.9)
    ax.set(xlabel=_SPEED, ylabel="growth rate [1/s]")
    ax.legend(loc="upper right")
    return figure


@styled
def centroid_on_two_clocks(data: xr.Dataset, names: Sequence[str]) -> Figure:
    """Radius and angle of the contact centroid over a mesh period.

    Parameters
    ----------
    data : xarray.Dataset
        From :func:`compendium.datasets.disk.centroid_motion`.
    names : sequence of str
        One a contact ratio.
    """
    figure, axes = panels(1, 2, 3.5)
    for ax, variable, scale, label in zip(
        axes,
        ("radius", "angle"),
        (1e3, 180 / np.pi),
        ("radius $r_c$ [mm]", r"angle $\theta_c$ [°]"),
        strict=True,
    ):
        for number, (name, colour, style) in enumerate(
            zip(names, (VERMILION, BLUE, GREEN), ("-", "--", "-."), strict=False)
        ):
            ax.plot(data["time"], data[variable][number] * scale, style, color=colour, label=name)
        ax.set(xlabel="time [mesh periods]", ylabel=label)
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure
