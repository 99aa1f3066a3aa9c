"""Figures of the design study of chapter 7: arms, variants, Hsu's errors, closing dampings."""

from __future__ import annotations

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.colors import LinearSegmentedColormap, Normalize
from matplotlib.figure import Figure

from facegear.plotting.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    ORANGE,
    PURPLE,
    SKY,
    VERMILION,
    panels,
    styled,
)

_LOOKS = ((BLUE, "o"), (VERMILION, "s"), (GREEN, "^"), (ORANGE, "D"), (PURPLE, "v"), (SKY, "P"))
# The lightest colours of the map are lost on white.
_GROWTH = LinearSegmentedColormap.from_list("growth", mpl.colormaps["YlGnBu"](np.linspace(0.35, 1.0, 256)))


@styled
def arms(data: xr.Dataset) -> Figure:
    """Moment arms of the mesh force over the mesh time of a tooth pair.

    Parameters
    ----------
    data : xarray.Dataset
        From :func:`compendium.datasets.torsional_design.arms`.
    """
    figure, (ax,) = panels(1, 1, 3.6)
    rows = (
        ("printed", r"$r\cos\alpha_c$ on the skew line, as printed", BLUE, "-"),
        ("contact_point", r"$r\cos\alpha_c$ at the true contact point", ORANGE, "-."),
        ("conjugate", r"conjugate tooth: $r_{b1}N_2/N_1$", VERMILION, "--"),
    )
    for name, label, colour, style in rows:
        ax.plot(data["fraction"], 1e3 * data[name], style, color=colour, label=label, linewidth=2)
    ax.set(
        xlabel="part of the mesh time of the pair", ylabel="arm about the face-gear axis [mm]", xlim=(0, 1)
    )
    ax.legend(loc="upper right")
    return figure


@styled
def pairs_in_mesh(data: xr.Dataset) -> Figure:
    """Draw the number of tooth pairs in mesh over its mean for Tregold's and the geometric contact ratio.

    Parameters
    ----------
    data : xarray.Dataset
        From :func:`compendium.datasets.torsional_design.pairs_in_mesh`.
    """
    figure, (ax,) = panels(1, 1, 3.2)
    names = ("Tregold", "geometric")
    for number, (colour, style) in enumerate(((BLUE, "-"), (VERMILION, "--"))):
        row = data.isel(ratio=number)
        label = f"{names[number]}, {float(row['contact_ratio']):.3f}"
        ax.step(data["fraction"], row["pairs"], style, where="post", color=colour, label=label, linewidth=2)
    ax.set(xlabel="time [mesh periods]", ylabel="mesh stiffness over its mean", ylim=(0, None), xlim=(0, 2))
    ax.legend(loc="lower right", title="contact ratio")
    return figure


@styled
def variant_tongues(data: xr.Dataset) -> Figure:
    """Unstable speeds of the variants of a gearbox, one row each.

    Parameters
    ----------
    data : xarray.Dataset
        From :func:`compendium.datasets.torsional_design.variant_tongues`.
    """
    names = data["variant_name"].values.tolist()
    figure, (ax,) = panels(1, 1, 1.2 + 0.42 * len(names))
    norm = Normalize(0.0, float(data["largest_growth"].max()))
    for row in range(len(names)):
        found = data.isel(variant=row).dropna("tongue", subset=["lower"])
        place = len(names) - 1 - row
        for number, label in enumerate(found["label"].values):
            part = found.isel(tongue=number)
            low, high = float(part["lower"]), float(part["upper"])
            colour = _GROWTH(norm(float(part["largest_growth"])))
            span = [(low, high - low)]
            ax.broken_barh(span, (place - 0.36, 0.72), facecolors=colour, edgecolors=INK, linewidth=0.5)
            if row == 0:
                # On two levels, because neighbours are narrower than their labels.
                offset = (0, 2 + 12 * (number % 2))
                above = ((low + high) / 2, place + 0.4)
                ax.annotate(label, above, xytext=offset, textcoords="offset points", ha="center", fontsize=9)
    ax.set_yticks(range(len(names)), names[::-1])
    ax.set(xlabel="speed of the face gear [rpm]", ylim=(-0.6, len(names) + 0.05))
    ax.set_axisbelow(True)
    ax.grid(axis="y", visible=False)
    figure.colorbar(
        mpl.cm.ScalarMappable(norm, _GROWTH), ax=ax, label="largest growth rate [1/s]", pad=0.02, aspect=14
    )
    return figure


@styled
def hsu_errors(data: xr.Dataset, names: list[str], orders: list[float]) -> Figure:
    """Error of Hsu's borders against the depth of modulation, in rpm and as a part of the width of the tongue.

    Parameters
    ----------
    data : xarray.Dataset
        From :func:`compendium.datasets.modulation.hsu_errors`.
    names : list of str
        Name of each resonance.
    orders : list of float
        Fitted order of the error of each.
    """
    figure, axes = panels(1, 2, 4.6)
    for number, (name, order) in enumerate(zip(names, orders, strict=True)):
        row = data.isel(resonance=number)
        colour, marker = _LOOKS[number]
        axes[0].loglog(
            100 * data["depth"],
            row["border_error"],
            marker + "-",
            color=colour,
            markersize=5,
            label=f"{name}: order {order:.2f}",
        )
        axes[1].loglog(
            100 * data["depth"], row["border_error"] / row["width"], marker + "-", color=colour, markersize=5
        )
    axes[0].set_ylabel("error of Hsu's border [rpm]")
    axes[1].set_ylabel("the same over the width of the tongue")
    for ax in axes:
        ax.set_xlabel("depth of modulation [%]")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside upper center", ncols=2)
    return figure


@styled
def openings(data: xr.Dataset) -> Figure:
    """Largest growth rates against the depth of modulation, of Floquet and of Hsu.

    Parameters
    ----------
    data : xarray.Dataset
        From :func:`compendium.datasets.modulation.openings`.
    """
    figure, (ax,) = panels(1, 1, 4.2)
    for number, label in enumerate(data["label"].values):
        row = data.isel(resonance=number)
        colour, marker = _LOOKS[number]
        ax.plot(data["depth"], row["growth_rate"], marker + "-", color=colour, markersize=5, label=label)
        ax.plot(data["depth"], row["hsu_growth"], "--", color=colour, linewidth=1.3)
    ax.axhline(0.0, color=INK, linewidth=0.9)
    ax.axvline(1.0, color=GREY, linestyle=":", linewidth=1.2)
    ax.annotate(
        "the real drive",
        (1.0, 1.0),
        xycoords=("data", "axes fraction"),
        xytext=(4, -12),
        textcoords="offset points",
        color=GREY,
    )
    ax.plot([], [], "--", color=INK, linewidth=1.3, label="Hsu")
    ax.set(
        xlabel="depth of modulation $\\varepsilon$",
        ylabel="largest growth rate [1/s]",
        ylim=(-60.0, 160.0),
        xlim=(float(data["depth"][0]), float(data["depth"][-1])),
    )
    ax.legend(loc="upper left")
    return figure


@styled
def closing(data: xr.Dataset, xlabel: str) -> Figure:
    """Largest growth rate of tongues against the damping of a shaft, with closing and opening values.

    Parameters
    ----------
    data : xarray.Dataset
        From :func:`compendium.datasets.torsional_design.closing`.
    xlabel : str
        Name of the damping, with its unit.
    """
    figure, (ax,) = panels(1, 1, 4.0)
    for number, label in enumerate(data["label"].values):
        row = data.isel(tongue=number)
        colour, _ = _LOOKS[number]
        found = row["closing_damping"].dropna("root").values
        x = np.concatenate([data["damping"].values, found])
        y = np.concatenate([row["growth_rate"].values, np.zeros(found.size)])
        order = np.argsort(x)
        ax.plot(x[order], y[order], color=colour, label=label, linewidth=1.6)
        ax.plot(data["damping"], row["growth_rate"], ".", color=colour, markersize=4)
        for sign, face in ((1.0, colour), (-1.0, "white")):
            roots = row["closing_damping"].values[row["closes"].values == sign]
            ax.plot(
                roots, np.zeros(roots.size), "o", color=colour, markerfacecolor=face, markersize=7, zorder=3
            )
    ax.axhline(0.0, color=INK, linewidth=0.9, zorder=0)
    ax.plot([], [], "o", color=GREY, label="closes")
    ax.plot([], [], "o", color=GREY, markerfacecolor="white", label="opens")
    ax.set_xscale("log")
    ax.set(xlabel=xlabel, ylabel="largest growth rate [1/s]")
    figure.legend(*ax.get_legend_handles_labels(), loc="outside upper center", ncols=4)
    return figure
