"""Figures of the report on a drive of one's own."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from facegear.plotting.style import (
    BLUE,
    FAINT,
    GREEN,
    GREY,
    INK,
    VERMILION,
    draw_border,
    draw_unstable,
    panels,
    styled,
)

_SPEED = "speed of the face gear [rpm]"


@styled
def combinations(data: xr.Dataset, tongues: xr.Dataset) -> Figure:
    """Mesh frequency against combinations of natural frequencies; dots where they meet in a tongue.

    Parameters
    ----------
    data : xarray.Dataset
        From :func:`facegear.drives.report_arrays.combinations`.
    tongues : xarray.Dataset
        From :func:`facegear.drives.report_arrays.tongue_table`.
    """
    figure, (ax,) = panels(1, 1, 4.8)
    speed, mesh = data["speed_rpm"].values, data["mesh_frequency"].values
    for number, frequency in enumerate(data["natural_frequency"].values):
        ax.plot(speed, frequency, color=FAINT, linewidth=1.0, label=None if number else "natural frequencies")
    for number, frequency in enumerate(data["combination"].values):
        name = None if number else "combinations that open a tongue"
        ax.plot(speed, frequency, color=BLUE, linewidth=1.1, linestyle="--", label=name)
    ax.plot(speed, mesh, color=INK, linewidth=1.5, label="mesh frequency", zorder=3)
    named: set[str] = set()
    for number, (label, low, high) in enumerate(
        zip(tongues["label"].values, tongues["lower"].values, tongues["upper"].values, strict=True)
    ):
        ends = np.array([low, high])
        on_mesh = np.interp(ends, speed, mesh)
        ax.plot(ends, on_mesh, color=VERMILION, linewidth=5, solid_capstyle="round", zorder=2)
        # Flutter of the mean system goes by one name in all intervals that resonances cut out of it.
        if label in named:
            continue
        named.add(label)
        centre = float(ends.mean())
        ax.annotate(
            label,
            (centre, float(np.interp(centre, speed, mesh))),
            # Names stand in turn to the left and to the right, so that neighbours keep clear of each other.
            xytext=(-8, 7) if number % 2 else (8, -9),
            textcoords="offset points",
            ha="right" if number % 2 else "left",
            fontsize=9,
            bbox={"facecolor": "white", "alpha": 0.75, "edgecolor": "none", "pad": 0.8},
        )
    if tongues.sizes["tongue"]:
        ax.plot([], [], color=VERMILION, linewidth=5, label="tongues")
    ax.set(
        xlim=(float(speed[0]), float(speed[-1])),
        ylim=(0.0, 1.15 * float(mesh[-1])),
        xlabel=_SPEED,
        ylabel="frequency [Hz]",
    )
    figure.legend(*ax.get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure


@styled
def growth_map(chart: xr.Dataset, tongues: xr.Dataset, value: float, axis: str, scale: float = 1.0) -> Figure:
    """Stability map, with the tongues at the drive's own value of the parameter.

    Parameters
    ----------
    chart : xarray.Dataset
        From :func:`facegear.drives.report_arrays.growth_map`.
    tongues : xarray.Dataset
        From :func:`facegear.drives.report_arrays.tongue_table`.
    value : float
        The drive's own value, in SI.
    axis : str
        What the vertical axis is called, with its unit.
    scale : float, optional
        Value on the axis over value in SI.
    """
    figure, (ax,) = panels(1, 1, 4.4)
    growth = chart["growth_rate"].values
    speed, values = chart["speed_rpm"].values, chart[str(chart["growth_rate"].dims[0])].values * scale
    mesh = draw_unstable(ax, speed, values, growth, max(1e-9, float(growth.max())))
    draw_border(ax, speed, values, growth)
    ax.axhline(value * scale, color=GREY, linewidth=1.0, linestyle="--", label="this drive")
    for low, high in zip(tongues["lower"].values, tongues["upper"].values, strict=True):
        ax.plot([low, high], [value * scale] * 2, "|-", color=VERMILION, linewidth=2.0, markersize=9)
    if tongues.sizes["tongue"]:
        ax.plot([], [], "|-", color=VERMILION, linewidth=2.0, markersize=9, label="its tongues")
    ax.set(
        xlim=(float(speed[0]), float(speed[-1])),
        ylim=(float(values[0]), float(values[-1])),
        xlabel=_SPEED,
        ylabel=axis,
    )
    ax.grid(False)
    figure.colorbar(mesh, ax=ax, label="growth rate [1/s]")
    figure.legend(*ax.get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure


@styled
def speed_strips(tables: Mapping[str, xr.Dataset], speeds_rpm: tuple[float, float]) -> Figure:
    """Safe and unstable speeds, one strip a model.

    Parameters
    ----------
    tables : mapping of str to xarray.Dataset
        Name of the model to :func:`facegear.drives.report_arrays.tongue_table`.
    speeds_rpm : tuple of float
        Lowest and highest operating speed [rpm].
    """
    figure, (ax,) = panels(1, 1, 0.75 * len(tables) + 1.1)
    low, high = speeds_rpm
    for row, table in enumerate(tables.values()):
        _strip(ax, -row, table, low, high)
    ax.set(xlim=speeds_rpm, xlabel=_SPEED, ylim=(-len(tables) + 0.5, 0.6))
    ax.set_yticks([-row for row in range(len(tables))], list(tables))
    ax.grid(False)
    return figure


def _strip(ax: Axes, place: int, table: xr.Dataset, low: float, high: float) -> None:
    ax.barh(place, high - low, 0.5, low, color=GREEN, alpha=0.35)
    last = -np.inf
    for label, start, stop in zip(
        table["label"].values, table["lower"].values, table["upper"].values, strict=True
    ):
        # The narrowest tongues would not show: each is at least a line wide.
        ax.barh(place, max(stop - start, 2e-3 * (high - low)), 0.5, start, color=VERMILION)
        if start - last > 0.12 * (high - low):
            ax.text((start + stop) / 2, place + 0.29, label, ha="center", va="bottom", fontsize=8)
            last = start


@styled
def changes(data: xr.Dataset) -> Figure:
    """Draw what one percent more of each parameter does to the unstable width.

    Parameters
    ----------
    data : xarray.Dataset
        From :func:`facegear.design.changes.effects_of_changes`.
    """
    names = data["change_name"].values.tolist()
    figure, (ax,) = panels(1, 1, 0.36 * len(names) + 1.2)
    slope = data["width_slope"].values
    place = -np.arange(len(names))
    ax.barh(place, slope, 0.6, color=np.where(slope < 0, GREEN, VERMILION))
    ax.axvline(0.0, color=INK, linewidth=0.9)
    ax.set_axisbelow(True)
    ax.set_yticks(place, names)
    ax.set_xlabel("change of the unstable width for one percent more [rpm]")
    ax.grid(visible=False, axis="y")
    return figure
