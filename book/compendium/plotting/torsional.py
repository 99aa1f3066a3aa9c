"""Figures of chapter 7: moment arms, natural frequencies and their veering, stability maps with Hsu's bands."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter, ScalarFormatter

from facegear.plotting.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    ORANGE,
    VERMILION,
    draw_border,
    draw_unstable,
    growth_bar,
    panels,
    styled,
)
from facegear.support.labelled import label_rows

_AXIS = {
    "gear_inertia": "inertia of the face gear $J_2/J_1$",
    "load_inertia": "inertia of the load $J_o/J_1$",
    "input_stiffness": "input shaft $k_1/k_m$ [m²/rad]",
    "output_stiffness": "output shaft $k_2/k_m$ [m²/rad]",
    "input_damping": "input shaft $c_1/k_1$ [s]",
    "output_damping": "output shaft $c_2/k_2$ [s]",
}
_SPEED = "speed of the face gear [rpm]"
# Of an upright name of a tongue, as a part of the width of the axes.
_NAME_WIDTH = 0.035
_MODES = ((BLUE, "-"), (VERMILION, "--"), (GREEN, "-."))


def _parameter(chart: xr.Dataset) -> str:
    return next(str(name) for name in chart.dims if name in _AXIS)


@styled
def moment_arms(data: xr.Dataset) -> Figure:
    """Draw the moment arms of the tooth pairs and the number of pairs in mesh.

    Parameters
    ----------
    data : xarray.Dataset
        From :func:`compendium.datasets.torsional.moment_arms`.
    """
    figure, axes = panels(2, 1, 4.6, sharex=True, gridspec_kw={"height_ratios": [2.2, 1.0]})
    for number in range(data.sizes["pair"]):
        colour, style = _MODES[number % len(_MODES)]
        name = f"pair in its {('first', 'second', 'third', 'fourth')[number]} period of contact"
        axes[0].plot(data["time"], data["printed"][number] * 1e3, style, color=colour, label=name)
    axes[0].axhline(
        float(data["conjugate"]) * 1e3, color=INK, linewidth=1.0, linestyle=":", label="conjugate tooth"
    )
    axes[0].set_ylabel("moment arm [mm]")
    axes[0].legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2)
    axes[1].step(data["time"], data["pairs"], where="mid", color=INK)
    axes[1].set(
        xlabel="time [mesh periods]", ylabel="pairs in mesh", ylim=(0.0, float(data["pairs"].max()) + 0.5)
    )
    return figure


@styled
def natural_frequencies(panels_of: Mapping[str, xr.Dataset]) -> Figure:
    """Natural frequencies over a parameter, natural speeds on the right, circles where neighbours veer.

    Parameters
    ----------
    panels_of : mapping of str to xarray.Dataset
        Title to the arrays of :func:`compendium.datasets.torsional.natural_frequencies`.
    """
    figure, axes = panels(len(panels_of), 1, 3.3 * len(panels_of))
    for ax, (title, data) in zip(axes, panels_of.items(), strict=True):
        name = _parameter(data)
        for mode, (colour, style) in enumerate(_MODES):
            ax.plot(data[name], data["frequency"][mode], style, color=colour, label=rf"$\omega_{mode + 1}$")
        for pair in range(data.sizes["pair"]):
            at = float(data["veering"][pair])
            if np.isfinite(at):
                height = [np.interp(at, data[name], data["frequency"][mode]) for mode in (pair, pair + 1)]
                ax.plot([at, at], height, "o", color=INK, markersize=7, fillstyle="none")
                ax.annotate(
                    f"ratio {1 + float(data['closest'][pair]):.5g}",
                    (at, float(np.sqrt(height[0] * height[1]))),
                    xytext=(12, 0) if height[1] > 1.5 * height[0] else (12, -16),
                    textcoords="offset points",
                    fontsize=9,
                    va="center",
                    bbox={"facecolor": "white", "alpha": 0.8, "edgecolor": "none", "pad": 0.6},
                )
        ax.set(yscale="log", xscale=data.attrs["scale"], xlabel=_AXIS[name], ylabel="natural frequency [Hz]")
        ax.set_xlim(float(data[name][0]), float(data[name][-1]))
        # Both scales show the same lines: rpm = 60 Hz/N2.
        ratio = float(data["natural_speed"][0, 0] / data["frequency"][0, 0])
        right = ax.secondary_yaxis(
            "right", functions=(partial(np.multiply, ratio), partial(np.multiply, 1 / ratio))
        )
        right.set_ylabel("natural speed [rpm]")
        ax.set_title(title, loc="left")
    axes[0].legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=3)
    return figure


def _draw_map(ax: Axes, chart: xr.Dataset, largest: float) -> Any:
    """Colour what is unstable and draw its border."""
    name = _parameter(chart)
    growth = chart["growth_rate"].values
    speed, value = chart["speed_rpm"].values, chart[name].values
    mesh = draw_unstable(ax, speed, value, growth, largest)
    draw_border(ax, speed, value, growth)
    ax.set(xlim=(float(speed[0]), float(speed[-1])), yscale=chart.attrs["scale"], ylabel=_AXIS[name])
    ax.set_ylim(float(value[0]), float(value[-1]))
    ax.grid(False)
    if chart.attrs["scale"] == "log":
        ax.yaxis.set_major_locator(LogLocator())
        ax.yaxis.set_minor_formatter(NullFormatter())
    else:
        ax.yaxis.set_major_formatter(ScalarFormatter())
    return mesh


def _draw_tongues(ax: Axes, chart: xr.Dataset) -> None:
    """Traced borders as dots."""
    for number in range(chart.sizes["section"]):
        row = chart.isel(section=number)
        for side in ("lower", "upper"):
            height = np.full(row.sizes["tongue"], float(row["section"]))
            ax.plot(row[side], height, ".", color=VERMILION, markersize=5, zorder=4)


def _draw_hsu(ax: Axes, chart: xr.Dataset) -> None:
    """Hsu's bands: their borders joined from section to section, and bars where a band has no neighbour."""
    rows = label_rows(chart["hsu_label"])
    ends: dict[str, list[tuple[float, float, float, int]]] = {}
    for number, labels in enumerate(rows):
        row = chart.isel(section=number)
        for band, label in enumerate(labels):
            lower, upper = float(row["hsu_lower"][band]), float(row["hsu_upper"][band])
            ax.plot(
                [lower, upper], [float(row["section"])] * 2, "|-", color=ORANGE, linewidth=1.4, markersize=7
            )
            ends.setdefault(label, []).append((float(row["section"]), lower, upper, number))
    for found in ends.values():
        for here, there in pairwise(found):
            if there[3] == here[3] + 1:
                for side in (1, 2):
                    ends_of_line = [here[side], there[side]]
                    ax.plot(ends_of_line, [here[0], there[0]], "--", color=ORANGE, linewidth=1.1)


def _apart(places: list[float], least: float) -> list[float]:
    """Move ascending places as little as it takes to have them apart by a least distance."""
    groups: list[
        list[float]
    ] = []  # of neighbours that touch: the middle of where they want to be, and how many
    for place in places:
        groups.append([place, 1])
        while len(groups) > 1:
            (left, few), (right, more) = groups[-2:]
            if right - left >= 0.5 * least * (few + more):
                break
            groups[-2:] = [[(few * left + more * right) / (few + more), few + more]]
    return [
        middle + least * (number - 0.5 * (count - 1))
        for middle, count in groups
        for number in range(int(count))
    ]


def _label_tongues(ax: Axes, chart: xr.Dataset) -> None:
    """Name every tongue once, where it grows most: upright names above the axes, beside one another."""
    places: dict[str, tuple[float, float, float]] = {}
    for number, labels in enumerate(label_rows(chart["label"])):
        row = chart.isel(section=number)
        for tongue, label in enumerate(labels):
            growth = float(row["largest_growth"][tongue])
            if label not in places or growth > places[label][2]:
                places[label] = (float(row["peak"][tongue]), float(row["section"]), growth)
    low, high = ax.get_xlim()
    in_order = sorted(places.items(), key=lambda item: item[1][0])
    shares = [(speed - low) / (high - low) for _, (speed, *_) in in_order]
    for (label, (speed, height, _)), share, place in zip(
        in_order, shares, _apart(shares, _NAME_WIDTH), strict=True
    ):
        end = float(ax.transAxes.inverted().transform(ax.transData.transform((speed, height)))[1])
        ax.plot(
            [place, share, share],
            [1.05, 1.0, min(end, 1.0)],
            color=GREY,
            linewidth=0.6,
            transform=ax.transAxes,
            clip_on=False,
        )
        ax.text(
            place,
            1.06,
            label,
            transform=ax.transAxes,
            rotation="vertical",
            ha="center",
            va="bottom",
            fontsize=8.5,
            color=INK,
        )


@styled
def stability_maps(charts: Mapping[str, xr.Dataset]) -> Figure:
    """Stability maps one below the other with traced borders, names of tongues and Hsu's bands.

    Parameters
    ----------
    charts : mapping of str to xarray.Dataset
        Title to the arrays of :func:`compendium.datasets.torsional.stability_figure`.
    """
    figure, axes = panels(len(charts), 1, 4.2 * len(charts))
    largest = max(1e-9, *(float(chart["growth_rate"].max()) for chart in charts.values()))
    for ax, (title, chart) in zip(axes, charts.items(), strict=True):
        mesh = _draw_map(ax, chart, largest)
        _draw_hsu(ax, chart)
        _draw_tongues(ax, chart)
        _label_tongues(ax, chart)
        ax.set_title(title, loc="left", pad=60)
        ax.set_xlabel(_SPEED)
    axes[0].plot([], [], ".", color=VERMILION, label="traced borders (Floquet)")
    axes[0].plot([], [], "|--", color=ORANGE, label="bands after Hsu")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside upper right", ncols=2)
    growth_bar(figure, axes, mesh)
    return figure
