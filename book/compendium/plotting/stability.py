"""Figures of chapter 2: multipliers, convergence of the methods, stability charts."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap, Normalize
from matplotlib.figure import Figure

from facegear.plotting.style import (
    BLUE,
    FAINT,
    GREEN,
    GROWTH,
    INK,
    ORANGE,
    PURPLE,
    VERMILION,
    WIDTH,
    panels,
    styled,
)

# Growth below this share of the natural frequency is rounding at the border of an undamped tongue.
_LEVEL = 2e-6

_METHODS = {
    "uniform": ("stepwise, equal", VERMILION, "o"),
    "aligned": ("stepwise, aligned", BLUE, "s"),
    "magnus": ("Magnus, aligned", GREEN, "^"),
    "collocation": ("collocation", PURPLE, "D"),
}


@styled
def swing(data: xr.Dataset) -> Figure:
    """Multipliers of Mathieu's equation in the complex plane, and motions inside and outside a tongue.

    Parameters
    ----------
    data : xarray.Dataset
        From :func:`compendium.datasets.stability.swing`.
    """
    figure = Figure(figsize=(WIDTH, 3.9), layout="constrained")
    plane, motion = figure.subplots(1, 2, width_ratios=(1.15, 1.0))
    circle = np.exp(1j * np.linspace(0, 2 * np.pi, 200))
    plane.plot(circle.real, circle.imag, color=INK, linewidth=0.8)
    frequency = data["frequency"].values
    norm = Normalize(frequency.min(), frequency.max())
    # Truncated: its lightest yellow is lost on white.
    colours = LinearSegmentedColormap.from_list("sweep", mpl.colormaps["cividis"](np.linspace(0, 0.9, 256)))
    for number in (1, 2):
        chosen = data.sel(number=number)
        points = plane.scatter(
            chosen["multiplier_real"],
            chosen["multiplier_imag"],
            c=frequency,
            norm=norm,
            cmap=colours,
            s=11,
            zorder=3,
        )
    plane.set(xlabel=r"Re $\lambda$", ylabel=r"Im $\lambda$", aspect="equal", xlim=(-1.45, 1.15))
    plane.set_title("(a) multipliers", loc="left")
    figure.colorbar(points, ax=plane, label=r"$\omega/\omega_0$", location="bottom", shrink=0.85)
    for shown, colour, style in zip(data["shown"].values, (VERMILION, BLUE), ("-", "--"), strict=True):
        curve = data["motion"].sel(shown=shown)
        motion.plot(
            data["time"], curve, color=colour, linestyle=style, label=rf"$\omega/\omega_0$ = {shown:.3g}"
        )
    motion.set(xlabel="time [parametric periods]", ylabel="$q$")
    motion.set_title("(b) motion", loc="left")
    motion.legend(loc="upper left")
    return figure


@styled
def convergence(cases: Mapping[str, xr.Dataset], orders: Mapping[str, Mapping[str, float]]) -> Figure:
    """Errors of the transition matrix against the number of sub-intervals.

    Parameters
    ----------
    cases : mapping of str to xarray.Dataset
        Title of the panel to the arrays of :func:`compendium.datasets.accuracy.convergence`.
    orders : mapping
        Fitted order of each method, for each title.
    """
    figure, axes = panels(1, len(cases), 4.3, sharex=True, sharey=True)
    for ax, (title, data) in zip(axes, cases.items(), strict=True):
        counts = data["sub_intervals"].values
        for name, (label, colour, marker) in _METHODS.items():
            if name == "collocation":
                ax.axhline(
                    max(float(data[name]), 1e-15), color=colour, linestyle=":", linewidth=1.8, label=label
                )
                continue
            shown = data[name].where(data[name] > 1e-13)
            ax.loglog(counts, shown, marker, color=colour, markersize=3.5, label=label)
            place = int(np.argmin(np.abs(counts - {"uniform": 150, "aligned": 600, "magnus": 40}[name])))
            ax.annotate(
                f"{orders[title][name]:.2f}",
                (counts[place], float(data[name][place])),
                xytext={"uniform": (5, 14), "aligned": (-32, -13), "magnus": (7, 3)}[name],
                textcoords="offset points",
                color=colour,
                fontsize=10,
            )
        ax.set_title(title, loc="left")
        ax.set_xlabel("sub-intervals $Q$")
        ax.xaxis.set_major_locator(mpl.ticker.LogLocator(10, numticks=4))
    axes[0].set_ylabel(r"relative error of $\Phi$")
    axes[0].set_ylim(1e-15, 1.0)
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure


@styled
def doubling(data: xr.Dataset) -> Figure:
    """Draw the change under doubling of Q, which seems to converge, and the true error, which does not.

    Parameters
    ----------
    data : xarray.Dataset
        From :func:`compendium.datasets.accuracy.doubling`.
    """
    figure, (ax,) = panels(1, 1, 3.9)
    counts = data["sub_intervals"].values
    ax.loglog(counts, data["error"], "o-", color=VERMILION, label="true error, equal sub-intervals")
    ax.loglog(counts, data["change"], "^--", color=ORANGE, label="change from half as many")
    ax.loglog(counts, data["aligned_error"], "s-", color=BLUE, label="true error, aligned sub-intervals")
    ax.set(xlabel="sub-intervals $Q$", ylabel=r"relative to the largest entry of $\Phi$")
    ax.set_xticks(counts, [str(count) for count in counts], minor=False)
    ax.xaxis.set_minor_locator(mpl.ticker.NullLocator())
    ax.legend(loc="lower left")
    return figure


@styled
def estimates(data: xr.Dataset) -> Figure:
    """Error estimates over true errors; what lies above the diagonal is on the safe side.

    Parameters
    ----------
    data : xarray.Dataset
        From :func:`compendium.datasets.accuracy.estimates`.
    """
    figure, (ax,) = panels(1, 1, 4.2)
    floor = 1e-16
    ends = np.array([floor, 1e-3])
    ax.plot(ends, ends, color=INK, linewidth=0.9)
    ax.fill_between(ends, ends, floor, color=FAINT, alpha=0.6, linewidth=0)
    ax.text(3e-8, 8e-12, "would be too\noptimistic", color=INK, ha="left", va="top")
    methods = data["method"].values
    for name in dict.fromkeys(methods.tolist()):
        chosen = data.isel(case=np.flatnonzero(methods == name))
        label, colour, marker = _METHODS[name]
        ax.loglog(
            np.maximum(chosen["error"], floor),
            chosen["estimate"],
            marker,
            color=colour,
            label=label,
            clip_on=False,
        )
    ax.set(
        xlabel="true error of the spectral radius",
        ylabel="estimated error",
        xlim=(floor, 1e-4),
        ylim=(floor, 1e-3),
    )
    ax.legend(loc="upper left")
    return figure


def _draw_growth(ax: Axes, growth: xr.DataArray, largest: float) -> Any:
    """Colour what is unstable."""
    return ax.pcolormesh(
        growth["frequency"],
        growth[growth.dims[0]],
        np.ma.masked_less(growth.values, _LEVEL),
        cmap=GROWTH,
        norm=Normalize(0.0, largest),
        shading="nearest",
        rasterized=True,
    )


def _draw_border(ax: Axes, growth: xr.DataArray) -> None:
    """Border of a damped chart, where the growth rate changes its sign."""
    if float(growth.max()) > 0.0:
        ax.contour(
            growth["frequency"], growth[growth.dims[0]], growth, levels=[0.0], colors=INK, linewidths=0.8
        )


def _finish_chart(figure: Figure, axes: list[Axes], mesh: Any, ylabel: str) -> None:
    for ax in axes:
        ax.set(xlabel=r"parametric frequency $\omega/\omega_0$", ylabel=ylabel)
        ax.grid(False)
    figure.colorbar(mesh, ax=axes, label=r"growth rate $\sigma/\omega_0$", pad=0.02)


def _draw_bands(ax: Axes, bands: xr.Dataset) -> None:
    """Hsu's borders, dashed."""
    for number in range(bands.sizes["band"]):
        band = bands.isel(band=number)
        for side in ("lower", "upper"):
            ax.plot(band[side], band["depth"], "--", color=VERMILION, linewidth=1.7)


@styled
def bordered_chart(chart: xr.Dataset, curves: xr.Dataset, bands: xr.Dataset, route: str) -> Figure:
    """Chart of an undamped equation with its exact borders and Hsu's lines.

    Parameters
    ----------
    chart : xarray.Dataset
        ``growth_rate`` (depth, frequency).
    curves : xarray.Dataset
        ``border`` (family, number, depth).
    bands : xarray.Dataset
        From :func:`compendium.datasets.stability.bands`.
    route : str
        Where the borders come from, for the legend.
    """
    figure, (ax,) = panels(1, 1, 4.8)
    growth = chart["growth_rate"]
    mesh = _draw_growth(ax, growth, float(growth.max()))
    for family in range(curves.sizes["family"]):
        for number in range(curves.sizes["number"]):
            border = curves["border"].isel(family=family, number=number)
            ax.plot(border, curves["depth"], color=INK, linewidth=1.0)
    _draw_bands(ax, bands)
    ax.plot([], [], color=INK, linewidth=1.0, label=route)
    ax.plot([], [], "--", color=VERMILION, label="Hsu")
    ax.set_xlim(float(growth["frequency"].min()), float(growth["frequency"].max()))
    ax.set_ylim(0.0, float(growth["depth"].max()))
    figure.legend(loc="outside upper center", ncols=2)
    _finish_chart(figure, [ax], mesh, r"depth of modulation $\varepsilon$")
    return figure


@styled
def duty_chart(chart: xr.Dataset) -> Figure:
    """Chart of Meissner's equation over duty and parametric frequency.

    Parameters
    ----------
    chart : xarray.Dataset
        ``growth_rate`` (duty, frequency).
    """
    figure, (ax,) = panels(1, 1, 4.4)
    growth = chart["growth_rate"]
    mesh = _draw_growth(ax, growth, float(growth.max()))
    _finish_chart(figure, [ax], mesh, "duty (contact ratio − 1)")
    return figure


@styled
def damped_chart(chart: xr.Dataset, bands: xr.Dataset, largest: float) -> Figure:
    """Chart of Mathieu's equation at one damping ratio, with Hsu's lines.

    Parameters
    ----------
    chart : xarray.Dataset
        ``growth_rate`` (depth, frequency) of one ``damping_ratio``.
    bands : xarray.Dataset
        Hsu's bands at the same damping.
    largest : float
        Growth rate at the dark end of the colours.
    """
    figure, (ax,) = panels(1, 1, 4.6)
    growth = chart["growth_rate"]
    mesh = _draw_growth(ax, growth, largest)
    if float(chart["damping_ratio"]) > 0.0:
        _draw_border(ax, growth)
    _draw_bands(ax, bands)
    ax.plot([], [], color=INK, linewidth=0.8, label="Floquet")
    ax.plot([], [], "--", color=VERMILION, label="Hsu")
    ax.set(xlim=(float(growth["frequency"].min()), float(growth["frequency"].max())))
    ax.set_ylim(0.0, float(growth["depth"].max()))
    ax.set_title(rf"$\vartheta$ = {float(chart['damping_ratio']):.3g}", loc="left")
    figure.legend(loc="outside upper center", ncols=2)
    _finish_chart(figure, [ax], mesh, r"depth of modulation $\varepsilon$")
    return figure


@styled
def hsu_errors(data: xr.Dataset, orders: Mapping[str, float]) -> Figure:
    """Error of Hsu's borders against the depth of modulation, and the tongue that he does not see.

    Parameters
    ----------
    data : xarray.Dataset
        From :func:`compendium.datasets.stability.hsu_errors`.
    orders : mapping of str to float
        Fitted order of each variable.
    """
    figure, (ax,) = panels(1, 1, 4.0)
    rows = {
        "width": ("width of tongue 1", BLUE, "s"),
        "error": ("error of Hsu's borders of tongue 1", VERMILION, "o"),
        "second_width": ("width of tongue 2, which Hsu lacks", GREEN, "^"),
    }
    for name, (label, colour, marker) in rows.items():
        ax.loglog(
            data["depth"], data[name], marker + "-", color=colour, label=f"{label} (order {orders[name]:.2f})"
        )
    ax.set(xlabel=r"depth of modulation $\varepsilon$", ylabel=r"$\Delta\omega/\omega_0$")
    ax.legend(loc="lower right")
    return figure


@styled
def pair_charts(charts: Mapping[str, xr.Dataset], bands: Mapping[str, xr.Dataset]) -> Figure:
    """Charts of the coupled pair, one below the other, with Hsu's bands and their labels.

    Parameters
    ----------
    charts : mapping of str to xarray.Dataset
        Title to ``growth_rate`` (depth, frequency).
    bands : mapping of str to xarray.Dataset
        The same titles to Hsu's bands.
    """
    figure, axes = panels(len(charts), 1, 3.5 * len(charts), sharex=True)
    largest = max(float(chart["growth_rate"].max()) for chart in charts.values())
    for ax, (title, chart) in zip(axes, charts.items(), strict=True):
        growth = chart["growth_rate"]
        mesh = _draw_growth(ax, growth, largest)
        _draw_border(ax, growth)
        _draw_bands(ax, bands[title])
        for number, label in enumerate(bands[title]["label"].values):
            centre = float(bands[title]["centre"].isel(band=number).dropna("depth")[0])
            ax.annotate(
                label,
                (centre, 0.0),
                xytext=(0, -3),
                textcoords="offset points",
                ha="center",
                va="top",
                fontsize=10,
                color=VERMILION,
                annotation_clip=False,
            )
        ax.set_title(title, loc="left")
        ax.set_ylim(0.0, float(growth["depth"].max()))
        ax.set_xlim(float(growth["frequency"].min()), float(growth["frequency"].max()))
        ax.tick_params(axis="x", pad=16)
        ax.set_ylabel(r"depth $\varepsilon$ [N/m]")
        ax.grid(False)
    axes[0].tick_params(labelbottom=True)
    axes[-1].set_xlabel(r"parametric frequency $\omega$ [rad/s]")
    figure.colorbar(mesh, ax=axes, label=r"growth rate $\sigma$ [1/s]", pad=0.02)
    axes[0].plot([], [], "--", color=VERMILION, label="Hsu, with his label")
    axes[0].plot([], [], color=INK, linewidth=0.8, label="Floquet")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside upper center", ncols=2)
    return figure
