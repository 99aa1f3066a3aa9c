"""Figures of chapter 5: maps over total angle and phase, tooth counts, and the charts of what silences a tongue."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from facegear.plotting.style import (
    BLUE,
    FAINT,
    GREEN,
    GREY,
    GROWTH,
    INK,
    ORANGE,
    PURPLE,
    STEEL,
    VERMILION,
    WIDTH,
    draw_unstable,
    growth_bar,
    panels,
    styled,
)
from facegear.support.labelled import label_rows

_SPEED = "speed of the face gear [rpm]"
_GROWTH_LABEL = "growth rate [1/s]"
_ANGLE = r"total angle $\theta_c$ [°]"
_WAVES = r"$n_1 \pm n_2$"
_MARKERS = ("o", "s", "^", "D")
_BOX = {"facecolor": "white", "alpha": 0.8, "edgecolor": "none", "pad": 0.8}


def _largest(charts: Sequence[xr.Dataset]) -> float:
    return max(1e-9, *(float(chart["growth_rate"].max()) for chart in charts))


def _draw_growth(ax: Axes, growth: xr.DataArray, largest: float) -> Any:
    """Colour what is unstable; rows are the first dimension."""
    return draw_unstable(ax, growth["speed_rpm"], growth[growth.dims[0]], growth.values, largest)


def _colour_bar(figure: Figure, axes: Sequence[Axes], largest: float) -> None:
    growth_bar(figure, axes, ScalarMappable(Normalize(0.0, largest), GROWTH))


def _draw_names(ax: Axes, traced: xr.Dataset, apart: float) -> None:
    """Name each tongue where it grows fastest, a little above it; `apart` is the step between names."""
    places: dict[str, tuple[float, float, float]] = {}
    for number, labels in enumerate(label_rows(traced["label"])):
        row = traced.isel(section=number)
        for tongue, label in enumerate(labels):
            growth = float(row["largest_growth"][tongue])
            if label not in places or growth > places[label][2]:
                places[label] = (float(row["peak"][tongue]), float(row["section"]), growth)
    low, high = sorted(ax.get_ylim())
    taken: list[tuple[float, float]] = []
    for label, (speed, height, _) in sorted(places.items(), key=lambda item: item[1][0]):
        for step in (0.6, -0.6, 1.6, -1.6, 2.6, -2.6, 3.6, -3.6, 4.6, -4.6):
            place = height + step * apart
            free = all(abs(speed - x) > 75 or abs(place - y) > 0.9 * apart for x, y in taken)
            if low + apart / 2 < place < high - apart / 2 and free:
                break
        taken.append((speed, place))
        if abs(place - height) > 0.7 * apart:
            ax.plot([speed, speed], [height, place], color=GREY, linewidth=0.7)
        ax.text(speed, place, label, ha="center", va="center", fontsize=8, color=INK, bbox=_BOX)


def _draw_borders(ax: Axes, traced: xr.Dataset) -> None:
    """Traced borders as dots."""
    for side in ("lower", "upper"):
        for row in range(traced.sizes["section"]):
            place = np.full(traced.sizes["tongue"], float(traced["section"][row]))
            ax.plot(traced[side][row], place, ".", color=VERMILION, markersize=3)


def _draw_zones(ax: Axes, zones: Sequence[float]) -> None:
    """Dashed lines between the speed zones, and their numbers above the axes."""
    left, right = ax.get_xlim()
    for limit in zones:
        ax.axvline(limit, color=GREY, linestyle="--", linewidth=0.9)
    ends = [left, *zones, right]
    for name, start, stop in zip(("I", "II", "III"), ends[:-1], ends[1:], strict=True):
        ax.text(
            (start + stop) / 2,
            1.01,
            name,
            transform=ax.get_xaxis_transform(),
            ha="center",
            va="bottom",
            color=GREY,
        )


@styled
def phase_relation(data: xr.Dataset) -> Figure:
    """Phase between two pinions against their total angle (Fig. 5.3).

    Parameters
    ----------
    data : xarray.Dataset
        From :func:`compendium.datasets.pinions.phase_relation`.
    """
    figure, (ax,) = panels(1, 1, 2.9)
    angle, phase = data["total_angle"].values, data["phase"].values.copy()
    # A jump is no slope: leave the line out where another tooth begins.
    starts = np.flatnonzero(np.diff(data["teeth"].values) > 0) + 1
    ax.plot(np.insert(angle, starts, np.nan), np.insert(phase, starts, np.nan), color=BLUE)
    ax.set(xlabel=_ANGLE, ylabel=r"phase $\psi$", ylim=(0, 1.05))
    return figure


@styled
def angle_maps(
    charts: Mapping[str, xr.Dataset], zones: Mapping[str, Sequence[float]], close_up: float
) -> Figure:
    """Draw maps over total angle and speed, tongues named, with a close-up of a few pitches (Fig. 5.5).

    Parameters
    ----------
    charts : mapping of str to xarray.Dataset
        Title to a map of :func:`compendium.datasets.pinions.angle_map` with tongues traced at some total angles.
    zones : mapping of str to sequence of float
        Speeds [rpm] that divide zones I, II and III; titles without zones are left out.
    close_up : float
        Range of angles of the close-up, at the upper end of the map [°].
    """
    figure = Figure(figsize=(WIDTH, 4.6 * len(charts)), layout="constrained")
    grid = figure.subplots(len(charts), 2, squeeze=False, width_ratios=(1.35, 1.0))
    largest = _largest(list(charts.values()))
    for (whole, near), (title, chart) in zip(grid, charts.items(), strict=True):
        growth = chart["growth_rate"]
        angle, speed = chart["total_angle"].values, chart["speed_rpm"].values
        for ax in (whole, near):
            _draw_growth(ax, growth, largest)
            ax.set(xlabel=_SPEED, xlim=(speed[0], speed[-1]), ylim=(angle[0], angle[-1]))
            ax.grid(False)
        whole.set_ylabel(_ANGLE)
        _draw_borders(whole, chart)
        _draw_names(whole, chart, (angle[-1] - angle[0]) / 28)
        if title in zones:
            _draw_zones(whole, zones[title])
        near.set_ylim(angle[-1] - close_up, angle[-1])
        unstable = speed[(growth.values > 0).any(axis=0) & (speed > 500)]
        if unstable.size:
            near.set_xlim(unstable[0] - 30, min(unstable[-1] + 30, speed[-1]))
        whole.set_title(title, loc="left", pad=16)
        near.set_title("close-up", loc="left", color=GREY, pad=16)
    _colour_bar(figure, list(grid.ravel()), largest)
    return figure


@styled
def one_map(chart: xr.Dataset) -> Figure:
    """Draw one map over total angle and speed.

    Parameters
    ----------
    chart : xarray.Dataset
        From :func:`compendium.datasets.pinions.angle_map`.
    """
    figure, (ax,) = panels(1, 1, 4.2)
    mesh = _draw_growth(ax, chart["growth_rate"], _largest([chart]))
    ax.set(xlabel=_SPEED, ylabel=_ANGLE)
    ax.grid(False)
    figure.colorbar(mesh, ax=ax, label=_GROWTH_LABEL)
    return figure


@styled
def positions(chart: xr.Dataset, zones: Sequence[float]) -> Figure:
    """Positioning angles as lines, coloured where unstable (Fig. 5.6).

    Parameters
    ----------
    chart : xarray.Dataset
        From :func:`compendium.datasets.pinions.angle_map` in whole teeth, with tongues traced at some of the angles.
    zones : sequence of float
        Speeds [rpm] that divide zones I, II and III.
    """
    figure, (ax,) = panels(1, 1, 5.2)
    growth = chart["growth_rate"]
    largest = max(_largest([chart]), float(chart["largest_growth"].max()))
    angle, speed = chart["total_angle"].values, chart["speed_rpm"].values
    colour, half = GROWTH, (speed[1] - speed[0]) / 2
    for row, place in zip(growth.values, angle, strict=True):
        ax.axhline(place, color=FAINT, linewidth=0.8, zorder=1)
        for column in np.flatnonzero(row > 0):
            ends = [speed[column] - half, speed[column] + half]
            ax.plot(
                ends, [place, place], color=colour(row[column] / largest), linewidth=4, solid_capstyle="butt"
            )
    for number, labels in enumerate(label_rows(chart["label"])):
        found = chart.isel(section=number)
        for tongue in range(len(labels)):
            ends = [float(found["lower"][tongue]), float(found["upper"][tongue])]
            ax.plot(
                ends,
                [float(found["section"])] * 2,
                "|-",
                color=VERMILION,
                markersize=9,
                linewidth=1.2,
                zorder=4,
            )
    ax.plot([], [], "|-", color=VERMILION, label="traced")
    ax.set(xlabel=_SPEED, ylabel=r"positioning angle $\theta_q$ [°]", xlim=(speed[0], speed[-1]))
    # Room for names above the topmost line, and above the bars.
    apart = (angle[-1] - angle[0]) / 16
    ax.set_ylim(angle[0] - apart, angle[-1] + 1.5 * apart)
    ax.legend(loc="upper center")
    ax.grid(False)
    _draw_names(ax, chart, apart)
    _draw_zones(ax, zones)
    _colour_bar(figure, [ax], largest)
    return figure


@styled
def phase_maps(charts: Mapping[str, xr.Dataset], zones: Sequence[float]) -> Figure:
    """Draw maps over phase and speed, one a positioning angle (Fig. 5.7).

    Parameters
    ----------
    charts : mapping of str to xarray.Dataset
        Title to a map of :func:`compendium.datasets.pinions.phase_maps` with tongues traced at some phases.
    zones : sequence of float
        Speeds [rpm] that divide zones I, II and III.
    """
    figure, axes = panels(len(charts), 1, 3.1 * len(charts), sharex=True)
    largest = _largest(list(charts.values()))
    for ax, (title, chart) in zip(axes, charts.items(), strict=True):
        growth = chart["growth_rate"]
        _draw_growth(ax, growth, largest)
        _draw_borders(ax, chart)
        ax.set(
            ylabel=r"phase $\psi$", ylim=(-0.03, 1.03), xlim=(growth["speed_rpm"][0], growth["speed_rpm"][-1])
        )
        ax.set_title(title, loc="left", pad=16)
        ax.grid(False)
        _draw_names(ax, chart, 0.13)
        _draw_zones(ax, zones)
    axes[-1].set_xlabel(_SPEED)
    _colour_bar(figure, axes, largest)
    return figure


@styled
def tooth_counts(charts: Mapping[str, xr.Dataset]) -> Figure:
    """Tongues of each tooth count as bars on its line (Fig. 5.11).

    Parameters
    ----------
    charts : mapping of str to xarray.Dataset
        Title to the arrays of :func:`compendium.datasets.pinions.tooth_counts`.
    """
    figure, axes = panels(len(charts), 1, 3.1 * len(charts) + 0.4, sharex=True)
    largest = max(float(chart["largest_growth"].max()) for chart in charts.values())
    for ax, (title, chart) in zip(axes, charts.items(), strict=True):
        for number, labels in enumerate(label_rows(chart["label"])):
            row = chart.isel(section=number)
            place = float(row["section"])
            ax.axhline(place, color=FAINT, linewidth=0.8, zorder=1)
            for tongue in range(len(labels)):
                low, high = float(row["lower"][tongue]), float(row["upper"][tongue])
                # A tongue too narrow for the page is still there.
                low, high = min(low, (low + high) / 2 - 1.0), max(high, (low + high) / 2 + 1.0)
                colour = GROWTH(float(row["largest_growth"][tongue]) / largest)
                ax.plot(
                    [low, high], [place, place], color=colour, linewidth=6, solid_capstyle="butt", zorder=3
                )
            if not labels:
                ax.plot([1.0], [place], "<", transform=ax.get_yaxis_transform(), color=GREEN, clip_on=False)
        ax.plot([], [], "<", color=GREEN, label="stable at all speeds")
        ax.set(ylabel="pinion teeth $N_1$", xlim=(100, 1000), yticks=chart["section"].values[::2])
        ax.set_title(title, loc="left")
        ax.grid(False)
    axes[0].legend(loc="upper left", bbox_to_anchor=(0.6, 1.16))
    axes[-1].set_xlabel(_SPEED)
    _colour_bar(figure, axes, largest)
    return figure


@styled
def speed_lines(lines: Mapping[str, xr.DataArray]) -> Figure:
    """Growth rates over speed, one line an arrangement.

    Parameters
    ----------
    lines : mapping of str to xarray.DataArray
        Name to growth rates over ``speed_rpm``.
    """
    figure, (ax,) = panels(1, 1, 3.6)
    colours = zip((BLUE, VERMILION, GREEN, ORANGE, PURPLE), ("-", "--", "-.", ":", "-"), strict=True)
    for (name, growth), (colour, line) in zip(lines.items(), colours, strict=False):
        ax.plot(growth["speed_rpm"], growth, line, color=colour, label=name)
    ax.axhline(0.0, color=INK, linewidth=0.9)
    ax.set(xlabel=_SPEED, ylabel=_GROWTH_LABEL)
    ax.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=3)
    return figure


@styled
def growth_at_angle(
    chart: xr.Dataset, row: int, phase: float, outer_radius: float, pinion_radius: float
) -> Figure:
    """Growth rates over speed at one total angle, beside a sketch of where the pinions are.

    Parameters
    ----------
    chart : xarray.Dataset
        From :func:`compendium.datasets.pinions.angle_map` for two pinions.
    row : int
        Row of the map.
    phase : float
        ψ of the second pinion.
    outer_radius, pinion_radius : float
        Of the face gear and the pinion [m].
    """
    figure = Figure(figsize=(WIDTH, 3.3), layout="constrained")
    sketch, line = figure.subplots(1, 2, width_ratios=(1.0, 2.1))
    angle = float(chart["total_angle"][row])
    sketch.add_patch(Circle((0, 0), 1.0, facecolor=STEEL, edgecolor=INK, linewidth=0.8))
    sketch.add_patch(Circle((0, 0), 0.78, facecolor="white", edgecolor=INK, linewidth=0.6))
    half = pinion_radius / outer_radius
    for number, turn in enumerate((0.0, np.radians(angle)), start=1):
        radial, across = np.array([np.cos(turn), np.sin(turn)]), np.array([-np.sin(turn), np.cos(turn)])
        corners = [
            radial * r + across * y for r, y in ((0.76, half), (1.02, half), (1.02, -half), (0.76, -half))
        ]
        sketch.fill(*np.transpose(corners), facecolor=BLUE, alpha=0.75, edgecolor=INK, linewidth=0.6)
        sketch.text(*(radial * 1.22), str(number), ha="center", va="center")
    sketch.set(xlim=(-1.35, 1.35), ylim=(-1.35, 1.35), aspect="equal")
    sketch.axis("off")
    sketch.set_title(rf"$\theta_c$ = {angle:.2f}°, $\psi$ = {phase:.2f}", fontsize=10)
    growth, speed = chart["growth_rate"].values[row], chart["speed_rpm"].values
    line.plot(speed, growth, color=BLUE)
    line.fill_between(
        speed, 0.0, growth, where=(growth > 0).tolist(), interpolate=True, color=VERMILION, alpha=0.7
    )
    line.axhline(0.0, color=INK, linewidth=0.9)
    line.set(
        xlabel=_SPEED,
        ylabel=_GROWTH_LABEL,
        ylim=(1.05 * float(chart["growth_rate"].min()), 1.05 * _largest([chart])),
        xlim=(speed[0], speed[-1]),
    )
    return figure
