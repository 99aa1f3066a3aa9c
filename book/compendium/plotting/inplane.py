"""Figures of chapter 6: stress under a force at the rim, critical power, maps over power, safe envelope."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from facegear.plotting.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    ORANGE,
    PURPLE,
    VERMILION,
    WIDTH,
    draw_border,
    draw_unstable,
    growth_bar,
    panels,
    styled,
)
from facegear.support.parameters import WATT_PER_HORSEPOWER

_LINES = (
    (VERMILION, "-"),
    (BLUE, "--"),
    (GREEN, "-."),
    (ORANGE, ":"),
    (PURPLE, (0, (5, 1, 1, 1))),
)
_SPEED = "speed of the face gear [rpm]"
_POWER = "power at 5000 rpm of the pinion [hp]"
_TITLES = {
    "radial": r"$\sigma_{rr}$",
    "shear": r"$\sigma_{r\theta}$",
    "hoop": r"$\sigma_{\theta\theta}$",
}


def _disk(ax: Axes, radius: Any, angle: Any, values: NDArray[np.float64], largest: float) -> Any:
    """Colour a disk by stress [MPa] and mark the force on its rim."""
    r, theta = np.meshgrid(radius, angle, indexing="ij")
    x, y = r * np.cos(theta) * 1e3, r * np.sin(theta) * 1e3
    mesh = ax.pcolormesh(
        x, y, values, cmap="PuOr", vmin=-largest, vmax=largest, shading="gouraud", rasterized=True
    )
    for edge in (0, -1):
        ax.plot(x[edge], y[edge], color=GREY, linewidth=0.8)
    # Room for the arrows of forces.
    reach = 1.24e3 * float(radius[-1])
    ax.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal")
    ax.axis("off")
    return mesh


def _force(ax: Axes, radius: float, angle: float, inward: float) -> None:
    """Draw an arrow whose point is at the force on the rim; `inward` is its angle from the tangent."""
    outwards = np.array([np.cos(angle), np.sin(angle)])
    along = np.cos(inward) * np.array([-outwards[1], outwards[0]]) - np.sin(inward) * outwards
    tip = 1.03 * radius * 1e3 * outwards
    ax.annotate(
        "",
        xy=tuple(tip),
        xytext=tuple(tip - 0.35 * radius * 1e3 * along),
        arrowprops={"arrowstyle": "-|>", "color": VERMILION, "linewidth": 1.6, "shrinkA": 0, "shrinkB": 0},
        annotation_clip=False,
    )


@styled
def harmonics_on_disk(data: xr.Dataset, name: str) -> Figure:
    """Harmonics of one stress as maps on the disk, the force at the right acting upwards (Figs 6.3 to 6.5).

    Parameters
    ----------
    data : xarray.Dataset
        From :func:`compendium.datasets.inplane.harmonic_stresses`, with one of its variables.
    name : {"radial", "shear", "hoop"}
    """
    amplitudes = data[name] / 1e6
    shown = [int(k) for k in data["harmonic"].values if np.abs(amplitudes.sel(harmonic=k)).max() > 0]
    rows = -(-len(shown) // 3)
    figure = Figure(figsize=(WIDTH, 2.5 * rows + 0.6), layout="constrained")
    axes = figure.subplots(rows, 3, squeeze=False).ravel()
    angle = np.linspace(0.0, 2 * np.pi, 181)
    for ax in axes[len(shown) :]:
        ax.axis("off")
    for ax, k in zip(axes, shown, strict=False):
        wave = np.cos(k * angle) if name == "shear" else np.sin(k * angle)
        values = amplitudes.sel(harmonic=k).values[:, np.newaxis] * wave
        # Harmonics differ too much in size for one scale.
        largest = float(np.abs(values).max())
        mesh = _disk(ax, data["radius"].values, angle, values / largest, 1.0)
        _force(ax, float(data["radius"][-1]), 0.0, 0.0)
        ax.set_title(f"$k$ = {k}, up to {largest:.2g} MPa", fontsize=10)
    figure.colorbar(
        mesh,
        ax=list(axes),
        label=f"{_TITLES[name]} over the largest of each panel",
        location="bottom",
        shrink=0.6,
        aspect=40,
    )
    return figure


@styled
def summed_on_disk(
    fields: Mapping[str, xr.Dataset], forces: Mapping[str, Sequence[tuple[float, float]]], largest: float
) -> Figure:
    """All harmonics together, one row a set of forces.

    Parameters
    ----------
    fields : mapping of str to xarray.Dataset
        Title to the arrays of :func:`compendium.datasets.inplane.summed_stress`.
    forces : mapping of str to sequence of (float, float)
        Where each force acts and its angle inwards from the tangent [rad], to draw it.
    largest : float
        End of the scale of colours [Pa]; next to a force the stress grows without bound.
    """
    figure = Figure(figsize=(WIDTH, 2.7 * len(fields) + 0.6), layout="constrained")
    axes = figure.subplots(len(fields), 3, squeeze=False)
    for row, (title, data) in zip(axes, fields.items(), strict=True):
        for ax, name in zip(row, _TITLES, strict=True):
            mesh = _disk(
                ax, data["radius"].values, data["angle"].values, data[name].values / 1e6, largest / 1e6
            )
            for angle, inward in forces[title]:
                _force(ax, float(data["radius"][-1]), angle, inward)
            ax.set_title(f"{title}: {_TITLES[name]}", fontsize=10)
    figure.colorbar(
        mesh,
        ax=list(axes.ravel()),
        label="stress [MPa]",
        location="bottom",
        shrink=0.6,
        aspect=40,
        extend="both",
    )
    return figure


@styled
def digits_lost(data: xr.Dataset) -> Figure:
    """Errors of Lamé's potentials in double precision and of collocation, against the speed.

    Parameters
    ----------
    data : xarray.Dataset
        From :func:`compendium.datasets.inplane.closed_forms`.
    """
    figure, (ax,) = panels(1, 1, 3.8)
    for (colour, _), k in zip(_LINES, data["harmonic"].values, strict=False):
        row = data.sel(harmonic=k)
        ax.loglog(
            data["speed_rpm"], row["potentials"], "o-", color=colour, label=f"potentials, $k$ = {int(k)}"
        )
        ax.loglog(
            data["speed_rpm"], row["collocation"].clip(1e-16), "s:", color=colour, markersize=4, linewidth=1.0
        )
    ax.plot([], [], "s:", color=GREY, markersize=4, linewidth=1.0, label="collocation, same colours")
    ax.set(xlabel=_SPEED, ylabel="error over the stress at the rim")
    ax.legend(loc="upper right", ncols=2)
    ax.set_ylim(1e-16, 10.0)
    return figure


@styled
def near_load(data: xr.Dataset) -> Figure:
    """Stress near the force over that of a half-plane.

    Parameters
    ----------
    data : xarray.Dataset
        From :func:`compendium.datasets.inplane.near_load`.
    """
    figure, (ax,) = panels(1, 1, 3.6)
    for (colour, line), count in zip(_LINES, data["harmonics"].values, strict=False):
        ax.semilogx(
            data["distance"],
            data["ratio"].sel(harmonics=count),
            linestyle=line,
            color=colour,
            marker=".",
            label=f"{int(count)} harmonics",
        )
    ax.axhline(1.0, color=INK, linewidth=0.8)
    ax.set(
        xlabel="distance from the force, over the outer radius",
        ylabel="stress over Flamant's",
        ylim=(0.0, 1.5),
    )
    ticks = [0.0125, 0.025, 0.05, 0.1, 0.2, 0.4]
    ax.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    ax.set_xticks([], minor=True)
    ax.legend(loc="lower right")
    return figure


def _hp(power: Any) -> Any:
    return power / WATT_PER_HORSEPOWER


@styled
def disk_alone(cases: Mapping[str, xr.Dataset], printed_hp: Mapping[str, Sequence[float]]) -> Figure:
    """Growth rate of the disk alone against the power, with the powers of the captions.

    Parameters
    ----------
    cases : mapping of str to xarray.Dataset
        Title to the arrays of :func:`compendium.datasets.power.disk_alone`.
    printed_hp : mapping of str to sequence of float
        Powers of the captions [hp] of each title.
    """
    figure, axes = panels(1, len(cases), 3.8)
    for ax, (title, data) in zip(axes, cases.items(), strict=True):
        for (colour, line), speed in zip(_LINES, data["speed_rpm"].values, strict=False):
            row = data.sel(speed_rpm=speed)
            ax.plot(
                _hp(data["power"]), row["growth_rate"], linestyle=line, color=colour, label=f"{speed:g} rpm"
            )
        ax.plot(_hp(data["power"]), data["dead"][0], color=GREY, linewidth=1.0, label="dead force")
        ax.axhline(0.0, color=INK, linewidth=0.9)
        critical = float(_hp(data["critical"][0]))
        ax.axvline(critical, color=INK, linestyle=":", linewidth=1.2)
        ax.annotate(
            f"$P_c$ = {critical:.0f} hp",
            (critical, 0.97),
            xycoords=("data", "axes fraction"),
            xytext=(-5 if critical > 0.5 * _hp(float(data["power"][-1])) else 5, 0),
            textcoords="offset points",
            ha="right" if critical > 0.5 * _hp(float(data["power"][-1])) else "left",
            va="top",
        )
        for power in printed_hp[title]:
            ax.plot([power], [0.0], "v", color=INK, markersize=7, clip_on=False)
        ax.set_title(title, loc="left")
        ax.set_xlabel(_POWER)
    axes[0].set_ylabel("growth rate [1/s]")
    handles, labels = axes[0].get_legend_handles_labels()
    handles.append(Line2D([], [], color=INK, marker="v", linestyle=""))
    figure.legend(handles, [*labels, "powers of the captions"], loc="outside lower center", ncols=3)
    return figure


@styled
def power_maps(maps: xr.Dataset, mean: Mapping[float, xr.Dataset]) -> Figure:
    """Draw maps at several powers one below the other, with the border of what the mean system does alone.

    Parameters
    ----------
    maps : xarray.Dataset
        From :func:`compendium.datasets.power.power_maps`.
    mean : mapping of float to xarray.Dataset
        Power [W] to the arrays of :func:`compendium.datasets.power.mean_growth_map`.
    """
    powers = maps["power"].values
    figure, axes = panels(len(powers), 1, 2.9 * len(powers) + 0.5, sharex=True)
    largest = float(maps["growth_rate"].max())
    speed, stiffness = maps["speed_rpm"].values, maps["stiffness"].values
    for number, (ax, power) in enumerate(zip(axes, powers, strict=True)):
        growth = maps["growth_rate"].sel(power=power).values
        mesh = draw_unstable(ax, speed, stiffness, growth, largest)
        draw_border(ax, speed, stiffness, growth)
        alone = mean[float(power)]
        if (alone["growth_rate"].values > 0).any():
            ax.contour(
                alone["speed_rpm"],
                alone["stiffness"],
                alone["growth_rate"],
                levels=[0.0],
                colors=VERMILION,
                linewidths=1.6,
                linestyles="--",
            )
        ax.set(xlim=(0.0, speed[-1]), ylim=(0.0, stiffness[-1]), ylabel=r"bearing stiffness $\mu$")
        ax.set_title(f"({'abcdef'[number]}) {_hp(power):.0f} hp", loc="left")
        ax.grid(False)
    axes[-1].set_xlabel(_SPEED)
    growth_bar(figure, axes, mesh)
    return figure


@styled
def compared_clocks(charts: Mapping[str, xr.Dataset]) -> Figure:
    """Draw maps at several powers in a grid, one row a drive.

    Parameters
    ----------
    charts : mapping of str to xarray.Dataset
        Title of a row to the arrays of :func:`compendium.datasets.power.power_maps`.
    """
    columns = max(chart.sizes["power"] for chart in charts.values())
    figure, axes = panels(len(charts), columns, 2.6 * len(charts) + 0.6)
    largest = max(1e-9, *(float(chart["growth_rate"].max()) for chart in charts.values()))
    for row, (title, chart) in enumerate(charts.items()):
        for column, power in enumerate(chart["power"].values):
            ax = axes[row * columns + column]
            growth = chart["growth_rate"].sel(power=power)
            mesh = draw_unstable(ax, chart["speed_rpm"], chart["stiffness"], growth.values, largest)
            ax.set(xlim=(0.0, float(chart["speed_rpm"][-1])), ylim=(0.0, float(chart["stiffness"][-1])))
            ax.set_title(f"{title}, {_hp(power):.0f} hp", loc="left", fontsize=10)
            ax.grid(False)
            ax.set_xlabel("speed [rpm]")
        axes[row * columns].set_ylabel(r"bearing stiffness $\mu$")
    growth_bar(figure, axes, mesh)
    return figure


@styled
def envelope(
    charts: Mapping[str, xr.Dataset], critical: Mapping[str, float], label: str, scale: float = 1.0
) -> Figure:
    """Largest stable power against a parameter, one panel a drive, one line a variant.

    Parameters
    ----------
    charts : mapping of str to xarray.Dataset
        Title to the arrays of :func:`compendium.datasets.power.power_envelope`.
    critical : mapping of str to float
        Critical power of the disk alone [W] of each title.
    label : str
        Of the horizontal axis.
    scale : float, optional
        Factor of the parameter on the axis.
    """
    figure, axes = panels(1, len(charts), 4.0)
    for ax, (title, data) in zip(axes, charts.items(), strict=True):
        parameter = str(data["power"].dims[1])
        x = data[parameter].values * scale
        finite = data["power"].values[np.isfinite(data["power"].values)]
        top = 1.15 * float(_hp(max(finite.max(initial=0.0), critical[title])))
        for number, (name, (colour, line)) in enumerate(
            zip(data["variant_name"].values, _LINES, strict=False)
        ):
            power = _hp(data["power"].values[number])
            bounded = np.where(np.isfinite(power), power, np.nan)
            ax.plot(x, bounded, linestyle=line, color=colour, marker="o", markersize=4, label=name)
            free = ~np.isfinite(power)
            ax.plot(x[free], np.full(free.sum(), 0.97 * top), "^", color=colour, markersize=7)
        ax.axhline(_hp(critical[title]), color=INK, linestyle=":", linewidth=1.2, label="disk alone")
        ax.set(ylim=(0.0, top), xlabel=label)
        ax.set_title(title, loc="left")
    axes[0].set_ylabel("largest stable power [hp]")
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3)
    return figure
