"""Figures of the chapter on shafts that have mass."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, NullFormatter, ScalarFormatter

from facegear.plotting.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    ORANGE,
    PURPLE,
    VERMILION,
    draw_border,
    draw_unstable,
    growth_bar,
    panels,
    styled,
)
from facegear.support.labelled import label_rows

_SPEED = "speed of the face gear [rpm]"
_COLOURS = (BLUE, VERMILION, GREEN, ORANGE, PURPLE)


@styled
def natural_speeds(charts: Mapping[str, xr.Dataset], highest: float) -> Figure:
    """Draw natural speeds over the length of shafts: lines with modes, dots exact, thin ones without mass."""
    figure, axes = panels(1, len(charts), 3.9, sharey=True)
    for ax, (title, data) in zip(axes, charts.items(), strict=True):
        for mode in range(data.sizes["mode"]):
            colour = _COLOURS[mode % len(_COLOURS)]
            ax.plot(data.length, data.reduced[mode], color=colour, label=f"mode {mode + 1}")
            ax.plot(data.length[::3], data.exact[mode][::3], ".", color=INK, markersize=3.5)
        for speed in data.massless.values[data.massless.values < highest]:
            ax.axhline(float(speed), color=GREY, linewidth=0.8, linestyle=":")
        ax.set(yscale="log", ylim=(100.0, highest), xlabel="length of the shaft [m]")
        ax.yaxis.set_major_locator(FixedLocator([100, 200, 500, 1000, 2000, 5000]))
        ax.yaxis.set_major_formatter(ScalarFormatter())
        ax.yaxis.set_minor_formatter(NullFormatter())
        ax.set_xlim(float(data.length[0]), float(data.length[-1]))
        ax.set_title(title, loc="left", fontsize=9.5)
    axes[0].set_ylabel("natural speed [rpm]")
    handles, names = axes[0].get_legend_handles_labels()
    handles += [
        axes[0].plot([], [], ".", color=INK)[0],
        axes[0].plot([], [], ":", color=GREY)[0],
    ]
    figure.legend(handles, [*names, "exact", "massless shafts"], loc="outside lower center", ncols=4)
    return figure


@styled
def convergence(data: xr.Dataset) -> Figure:
    """Draw errors against the number of modes."""
    figure, axes = panels(1, 2, 3.2)
    for mode in range(data.sizes["mode"]):
        axes[0].plot(
            data.modes,
            data.frequency[mode],
            "o-",
            color=_COLOURS[mode],
            markersize=3.5,
            label=f"mode {mode + 1}",
        )
    axes[1].plot(data.modes, np.abs(data.growth), "o-", color=BLUE, markersize=3.5)
    for ax, name in zip(
        axes, ("relative error of a frequency", "error of the growth rate [1/s]"), strict=True
    ):
        ax.set(yscale="log", xlabel="modes of a shaft", ylabel=name)
    axes[0].legend(loc="best", fontsize=8.5)
    return figure


@styled
def stability(charts: Mapping[str, xr.Dataset], named: Mapping[str, tuple[float, ...]]) -> Figure:
    """Draw maps of growth over speed and length, traced borders, and tongues of massless shafts below.

    Parameters
    ----------
    charts : mapping of str to xarray.Dataset
        Title to the arrays of :func:`compendium.datasets.heavy_shafts.stability`.
    named : mapping of str to tuple of float
        Title to the sections whose tongues are named.
    """
    figure, axes = panels(len(charts), 1, 4.0 * len(charts) + 0.5)
    largest = max(float(chart.growth_rate.max()) for chart in charts.values())
    for ax, (title, chart) in zip(axes, charts.items(), strict=True):
        speed, value, growth = chart.speed_rpm.values, chart.length.values, chart.growth_rate.values
        mesh = draw_unstable(ax, speed, value, growth, largest)
        draw_border(ax, speed, value, growth)
        for side in ("lower", "upper"):
            for number, height in enumerate(chart.section.values):
                row = chart[side][number]
                ax.plot(row, np.full(row.size, height), ".", color=VERMILION, markersize=4, zorder=4)
        for lower, upper in zip(chart.massless_lower.values, chart.massless_upper.values, strict=True):
            ax.axvspan(lower, upper, color=ORANGE, alpha=0.18, linewidth=0.0, zorder=0)
        _name(ax, chart, named[title])
        ax.set(xlabel=_SPEED, ylabel="length of the shaft [m]", xlim=(speed[0], speed[-1]))
        ax.set_ylim(float(value[0]), float(value[-1]))
        ax.grid(False)
        ax.set_title(title, loc="left")
    handles = [
        axes[0].plot([], [], ".", color=VERMILION)[0],
        axes[0].fill_between([], [], color=ORANGE, alpha=0.3),
    ]
    figure.legend(
        handles, ["traced borders", "unstable with massless shafts"], loc="outside upper right", ncols=2
    )
    growth_bar(figure, axes, mesh)
    return figure


def _name(ax: Axes, chart: xr.Dataset, sections: tuple[float, ...]) -> None:
    """Write labels of tongues above some sections."""
    for number, labels in enumerate(label_rows(chart.label)):
        height = float(chart.section[number])
        if not any(abs(height - own) < 1e-9 for own in sections):
            continue
        for tongue, label in enumerate(labels):
            middle = float(chart.lower[number, tongue] + chart.upper[number, tongue]) / 2.0
            ax.annotate(
                label,
                (middle, height),
                xytext=(0, 3),
                textcoords="offset points",
                ha="center",
                va="bottom",
                rotation=90,
                fontsize=7.5,
                color=INK,
                bbox={"facecolor": "white", "alpha": 0.75, "edgecolor": "none", "pad": 0.6},
                zorder=5,
                clip_on=True,
            )
