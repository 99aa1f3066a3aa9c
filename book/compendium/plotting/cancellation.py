"""Figures of chapter 5: what silences a tongue, as charts and against the tongues themselves."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from facegear.plotting.style import BLUE, GREEN, INK, ORANGE, VERMILION, panels, styled

_WAVES = r"$n_1 \pm n_2$"
_MARKERS = ("o", "s", "^", "D")


@styled
def interference(curves: xr.Dataset, titles: Sequence[str], traced: Sequence[xr.Dataset]) -> Figure:
    """Draw what two pinions leave of a coupling against their phase, over the growth of the tongues.

    Parameters
    ----------
    curves : xarray.Dataset
        From :func:`compendium.datasets.cancellation.interference_curves`.
    titles : sequence of str
        One a positioning angle.
    traced : sequence of xarray.Dataset
        Tongues of :func:`compendium.datasets.pinions.traced` over the phase, one a positioning angle.
    """
    names = curves["mode_pair"].values.tolist()
    figure, axes = panels(2, curves.sizes["teeth"], 5.0, sharex=True, sharey="row")
    upper, lower = axes[: curves.sizes["teeth"]], axes[curves.sizes["teeth"] :]
    for number, (top, bottom, title, found) in enumerate(zip(upper, lower, titles, traced, strict=True)):
        labels = found["label"].values.tolist()
        growth = found["largest_growth"].values
        for place, (name, colour) in enumerate(zip(names, (BLUE, VERMILION, GREEN), strict=False)):
            top.plot(curves["phase"], curves["interference"][number, place], color=colour, label=f"{name}/1")
            points = [
                (float(found["section"][row]), growth[row, tongue])
                for row, names_there in enumerate(labels)
                for tongue, label in enumerate(names_there)
                if label == f"{name}/1"
            ]
            if points:
                x, y = zip(*points, strict=True)
                bottom.plot(x, y, _MARKERS[place], color=colour, markersize=5)
        top.set_title(title, loc="left", fontsize=10)
        top.set(ylim=(0, 1.05))
        bottom.set(xlabel=r"phase $\psi$", ylim=(0, None), xticks=(0, 0.5, 1))
    upper[0].set_ylabel("interference")
    lower[0].set_ylabel("growth rate [1/s]")
    figure.legend(*upper[0].get_legend_handles_labels(), loc="outside upper center", ncols=len(names))
    return figure


@styled
def weak_tongues(data: xr.Dataset) -> Figure:
    """Growth rate and width of tongues of weak loads against the sum over the pinions.

    Parameters
    ----------
    data : xarray.Dataset
        From :func:`compendium.datasets.cancellation.weak_tongues`; the weakest load is drawn.
    """
    figure, axes = panels(1, 2, 3.7)
    end = float(data["phasing_sum"].max()) * 1.08
    for ax, name, label in zip(axes, ("growth", "width"), ("growth rate", "width"), strict=True):
        ax.plot([0, end], [0, end], color=INK, linewidth=0.9)
        styles = zip(data["pair_name"].values, _MARKERS, (BLUE, VERMILION, GREEN, ORANGE), strict=False)
        for number, (pair, marker, colour) in enumerate(styles):
            weakest = data[name].isel(factor=int(np.argmin(data["factor"].values)), pair=number)
            ax.plot(
                data["phasing_sum"][number],
                weakest,
                marker,
                color=colour,
                markersize=6,
                mfc="none",
                label=pair,
            )
        ax.set(xlabel="$|S|$", ylabel=f"{label}, one pinion = 1", xlim=(0, end), ylim=(0, end))
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure


@styled
def two_pinion_chart(data: xr.Dataset, pitch: float) -> Figure:
    """Draw what a second pinion leaves of the tongues, over its angle and the waves (design chart).

    Parameters
    ----------
    data : xarray.Dataset
        From :func:`compendium.datasets.cancellation.two_pinion_chart`.
    pitch : float
        Angular pitch [°], ticks above the axes.
    """
    figure, (ax,) = panels(1, 1, 3.6)
    mesh = ax.pcolormesh(
        data["total_angle"],
        data["wave_number"],
        data["remaining"],
        cmap="cividis",
        vmin=0,
        vmax=1,
        rasterized=True,
    )
    ax.set(xlabel=r"total angle $\theta_c$ [°]", ylabel=_WAVES, yticks=data["wave_number"].values)
    ax.grid(False)
    low, high = float(data["total_angle"][0]), float(data["total_angle"][-1])
    above = ax.secondary_xaxis("top")
    whole = np.arange(np.ceil(low / pitch), np.floor(high / pitch) + 1)
    above.set_xticks(whole * pitch, [f"{number:.0f}" for number in whole], fontsize=8)
    above.set_xlabel(r"teeth between the pinions, $\psi = 0$")
    figure.colorbar(mesh, ax=ax, label="$|S|/2$ left")
    return figure


@styled
def array_chart(data: xr.Dataset) -> Figure:
    """Draw what several pinions leave of the tongues, for each combination of waves (design chart).

    Parameters
    ----------
    data : xarray.Dataset
        From :func:`compendium.datasets.cancellation.array_chart`.
    """
    layouts = data["layout_name"].values.tolist()
    count = data.sizes["gear_teeth"]
    figure, axes = panels(1, count, 0.36 * len(layouts) + 1.5, sharey=True)
    for ax, (place, teeth) in zip(axes, enumerate(data["gear_teeth"].values), strict=True):
        values = data["remaining"].values[place]
        ax.pcolormesh(
            data["wave_number"],
            data["layout"],
            values,
            cmap="cividis",
            vmin=0,
            vmax=1,
            edgecolors="white",
            linewidth=0.6,
        )
        ax.set(title=f"$N_2$ = {teeth}", xlabel=_WAVES, xticks=data["wave_number"].values[::2])
        ax.grid(False)
    axes[0].set_yticks(data["layout"].values, layouts)
    axes[0].invert_yaxis()
    figure.colorbar(
        ScalarMappable(Normalize(0, 1), "cividis"),
        ax=axes,
        label="$|S|/p$ left",
        location="bottom",
        shrink=0.5,
        aspect=30,
    )
    return figure
