"""Figures of the stability-based design: teeth and stress, charts over speed and thickness, trade-off."""

from __future__ import annotations

from typing import Any

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter

from facegear.plotting.style import (
    BLUE,
    GREEN,
    GREY,
    GROWTH,
    INK,
    ORANGE,
    VERMILION,
    WIDTH,
    draw_unstable,
    panels,
    styled,
)

# Distance of a number from its point [pt].
_BESIDE = 12.0
_PAPER = {"facecolor": "white", "alpha": 0.75, "edgecolor": "none", "pad": 0.8}
_RANGES = ((BLUE, "o"), (VERMILION, "s"))
_SPEED = "speed of the face gear [rpm]"
_TEETH = "number of pinion teeth $N_1$"
_RATIO = "thickness ratio $h/a$"


@styled
def face_width(data: xr.Dataset) -> Figure:
    """Face width against the number of pinion teeth (Figs 4.7, 4.11).

    Parameters
    ----------
    data : xarray.Dataset
        From :func:`compendium.datasets.design.family_of_teeth`.
    """
    figure, (ax,) = panels(1, 1, 3.4)
    ax.plot(data["pinion_teeth"], data["face_width"] * 1e3, "o-", color=BLUE, markersize=5)
    ax.set(xlabel=_TEETH, ylabel="face width $L$ [mm]", ylim=(0, 1.08e3 * float(data["face_width"].max())))
    return figure


@styled
def root_stress(data: xr.Dataset, allowable: float) -> Figure:
    """Stress at the root of the tooth against the number of teeth (Figs 4.8, 4.12), for each reading of W.

    Parameters
    ----------
    data : xarray.Dataset
        From :func:`compendium.datasets.design.family_of_teeth`.
    allowable : float
        Yield strength over safety factor [Pa].
    """
    figure, (ax,) = panels(1, 1, 4.2)
    looks = ((BLUE, "o-"), (GREEN, "^--"), (ORANGE, "s--"), (GREY, "D--"))
    for number, (name, (colour, look)) in enumerate(zip(data["root_name"].values, looks, strict=True)):
        stress = data["root_stress"].sel(root=number) / 1e6
        ax.plot(data["pinion_teeth"], stress, look, color=colour, markersize=4, label=name)
    ax.axhline(allowable / 1e6, color=VERMILION, linestyle=":", linewidth=2)
    # The limit is named where the curves leave most room above it.
    teeth, above = data["pinion_teeth"].values, data["root_stress"].values / allowable - 1.0
    room = np.where(above > -0.02, above, np.inf).min(axis=0)
    runs = [room[first : first + 4].min() for first in range(teeth.size - 3)]
    ax.annotate(
        rf"$\sigma_Y/SF$ = {allowable / 1e6:.0f} MPa",
        (float(teeth[int(np.argmax(runs))]), allowable / 1e6),
        xytext=(0, 5),
        textcoords="offset points",
        color=VERMILION,
    )
    ax.set(xlabel=_TEETH, ylabel=r"$\sigma_{max}$ [MPa]", ylim=(0, None))
    ax.legend(title="root thickness $W$", ncols=2, loc="upper center", bbox_to_anchor=(0.5, -0.17))
    return figure


def _draw_tips(ax: Axes, chart: xr.Dataset) -> None:
    """Tips that decide up to 300 rpm (lobe A of the text) and up to 1000 rpm (lobe B)."""
    labels = chart["tip_label"].values
    for letter, number in zip("BA", range(len(labels)), strict=False):
        speed, ratio = float(chart["tip_speed"][number]), float(chart["tip_ratio"][number])
        ax.plot(speed, ratio, "v", color=VERMILION, markersize=6, zorder=4)
        ax.annotate(
            f"{letter} {labels[number]}: {ratio:.4f}",
            (speed if speed > 150 else 5.0, ratio),
            xytext=(0, 7),
            textcoords="offset points",
            ha="right" if speed > 700 else "center" if speed > 150 else "left",
            fontsize=9,
            color=INK,
            bbox=_PAPER,
        )
        end = 1000.0 if letter == "B" else 300.0
        ax.plot([0.0, end], [ratio, ratio], color=GREY, linestyle="--", linewidth=0.9, zorder=1)


def _finish(ax: Axes) -> None:
    ax.set(xlabel=_SPEED, ylabel=_RATIO, xlim=(0, 1000))
    ax.grid(False)


def _draw_zones(ax: Axes, chart: xr.Dataset) -> None:
    """Name what lies above all tips, lobe C, and the zone below it, where a thin disk responds too much."""
    bottom, top = ax.get_ylim()
    critical = float(chart["tip_ratio"].max())
    ax.text(12, (critical + top) / 2, "no tongue found", color=GREEN, va="center", fontsize=11)
    rows = chart["label"].values.tolist()
    width = (chart["upper"] - chart["lower"]).fillna(0.0)
    label = rows[0][int(width.isel(section=0).argmax("tongue"))]
    # The name stands on the section above the lowest, if the lobe reaches up to it.
    section = 1 if label in rows[1] else 0
    place = chart.isel(section=section, tongue=rows[section].index(label))
    ax.annotate(
        f"C {label}",
        (float(place["peak"]), float(place["section"])),
        xytext=(0, 9),
        textcoords="offset points",
        ha="center",
        fontsize=9,
        color=INK,
        bbox=_PAPER,
    )
    ax.text(
        990,
        bottom + 0.02 * (top - bottom),
        "response-\nunsafe\nzone",
        color=VERMILION,
        ha="right",
        va="bottom",
        fontsize=9,
        bbox=_PAPER,
    )


@styled
def thickness_map(chart: xr.Dataset) -> Figure:
    """Growth rates over speed and thickness ratio, with traced tongues, tips and zones (Figs 4.9, 4.13).

    Parameters
    ----------
    chart : xarray.Dataset
        From :func:`compendium.datasets.design.thickness_figure`.
    """
    figure, (ax,) = panels(1, 1, 4.8)
    growth = chart["growth_rate"].values
    speed, ratio = chart["speed_rpm"].values, chart["thickness_ratio"].values
    mesh = draw_unstable(ax, speed, ratio, growth, float(growth.max()))
    ax.contour(speed, ratio, growth, levels=[0.0], colors=INK, linewidths=0.6)
    for number, height in enumerate(chart["section"].values):
        row = chart.isel(section=number)
        ax.hlines(
            np.full(row.sizes["tongue"], height), row["lower"], row["upper"], color=VERMILION, linewidth=1
        )
        for side in ("lower", "upper"):
            ax.plot(row[side], np.full(row.sizes["tongue"], height), ".", color=VERMILION, markersize=3)
    ax.set_ylim(float(chart["section"][0]), max(float(ratio[-1]), float(chart["tip_ratio"].max()) + 0.0015))
    _draw_zones(ax, chart)
    _draw_tips(ax, chart)
    _finish(ax)
    figure.colorbar(mesh, ax=ax, label="growth rate [1/s]", pad=0.02)
    return figure


@styled
def thickness_sections(chart: xr.Dataset) -> Figure:
    """Unstable intervals of speed at many thickness ratios, with the traced tips.

    Parameters
    ----------
    chart : xarray.Dataset
        ``lower``, ``upper``, ``largest_growth`` over (section, tongue), and tips from
        :func:`compendium.datasets.design.with_tips`.
    """
    figure, (ax,) = panels(1, 1, 4.6)
    section = chart["section"].values
    height = float(section[1] - section[0])
    norm = Normalize(0.0, float(chart["largest_growth"].max()))
    for row, ratio in enumerate(section):
        _draw_row(ax, chart.isel(section=row), float(ratio), height, norm)
    _draw_tips(ax, chart)
    _finish(ax)
    ax.set_ylim(
        float(section[0]) - height / 2, max(float(section[-1]), float(chart["tip_ratio"].max())) * 1.04
    )
    figure.colorbar(
        mpl.cm.ScalarMappable(norm, GROWTH), ax=ax, label="largest growth rate of the tongue [1/s]", pad=0.02
    )
    return figure


def _draw_row(ax: Axes, row: xr.Dataset, ratio: float, height: float, norm: Any) -> None:
    found = row.dropna("tongue")
    if found.sizes["tongue"] == 0:
        return
    lower, upper = found["lower"].values, found["upper"].values
    spans = list(zip(lower.tolist(), (upper - lower).tolist(), strict=True))
    colours = GROWTH(norm(found["largest_growth"].values))
    ax.broken_barh(spans, (ratio - height / 2, height), facecolors=colours, edgecolors=colours, linewidth=0.6)


@styled
def lobe_near_tip(data: xr.Dataset, steps_rpm: tuple[float, ...]) -> Figure:
    """Width of a lobe below its tip, with the steps of grids that overlook it.

    Parameters
    ----------
    data : xarray.Dataset
        From :func:`compendium.datasets.design.lobe_near_tip`.
    steps_rpm : tuple of float
        Speed steps to mark [rpm].
    """
    figure, (ax,) = panels(1, 1, 3.6)
    ax.loglog(100 * data["depth"], data["width"], "o-", color=BLUE, markersize=5)
    for step in steps_rpm:
        ax.axhline(step, color=GREY, linestyle="--", linewidth=0.9)
        ax.annotate(
            f"step of {step:g} rpm",
            (100 * float(data["depth"][0]), step),
            xytext=(0, 3),
            textcoords="offset points",
            color=GREY,
        )
    ax.set(xlabel="distance below the tip [% of $h/a$]", ylabel="width of the lobe [rpm]")
    for axis in (ax.xaxis, ax.yaxis):
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axis.set_major_formatter("{x:g}")
        axis.set_minor_formatter(NullFormatter())
    return figure


@styled
def trade_off(data: xr.Dataset, allowable: float) -> Figure:
    """Root stress over critical thickness for each tooth count and speed range (Figs 4.10, 4.14).

    Parameters
    ----------
    data : xarray.Dataset
        From :func:`compendium.datasets.design.family_of_bodies`.
    allowable : float
        Yield strength over safety factor [Pa].
    """
    figure = Figure(figsize=(WIDTH, 4.6), layout="constrained")
    ax = figure.subplots()
    named = [
        n for n in data["pinion_teeth"].values if n in data["pinion_teeth"].values[[0, -1]] or n % 4 == 0
    ]
    drawn = []
    for (colour, marker), highest in zip(_RANGES, data["highest_rpm"].values, strict=True):
        part = data.sel(highest_rpm=highest)
        thickness, stress = part["critical_thickness"] * 1e3, part["root_stress"] / 1e6
        ax.plot(
            thickness,
            stress,
            marker + "-",
            color=colour,
            markersize=5,
            label=f"up to {highest:g} rpm",
            linewidth=0.9,
        )
        drawn.append((colour, np.stack([thickness.values, stress.values], axis=1)))
    ax.axhline(allowable / 1e6, color=INK, linestyle=":", linewidth=1.6, zorder=1.2, label=r"$\sigma_Y/SF$")
    ax.set(xlabel="critical thickness $h_{cr}$ [mm]", ylabel=r"$\sigma_{max}$ [MPa]", ylim=(0, None))
    ax.margins(y=0.08)
    # Numbers stand beside their lines, away from the other one: right of the first as it runs, left of the second.
    for (colour, points), turned in zip(drawn, (1.0, -1.0), strict=True):
        places = ax.transData.transform(points) * 72.0 / figure.dpi
        along = np.gradient(places, axis=0)
        beside = turned * np.stack([along[:, 1], -along[:, 0]], axis=1) / np.hypot(*along.T)[:, None]
        taken: list[Any] = []
        # From the last one on, so that its number is there, and none upon another.
        for number in np.flatnonzero(np.isin(data["pinion_teeth"].values, named))[::-1].tolist():
            centre = places[number] + _BESIDE * beside[number]
            if all(np.hypot(*(centre - other)) > _BESIDE for other in taken):
                taken.append(centre)
                ax.annotate(
                    f"{data['pinion_teeth'].values[number]}",
                    tuple(points[number]),
                    xytext=tuple(_BESIDE * beside[number]),
                    textcoords="offset points",
                    ha="center",
                    va="center",
                    fontsize=8,
                    color=colour,
                    bbox=_PAPER,
                    zorder=1.5,  # below the points and lines, so that it hides none
                )
    ax.legend(loc="best")
    return figure
