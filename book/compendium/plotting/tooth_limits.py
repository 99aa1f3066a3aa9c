"""Figures of chapter 3 on contact ratios and on how far teeth reach."""

from __future__ import annotations

from collections.abc import Sequence

import xarray as xr
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from facegear.plotting.style import (
    BLUE,
    GREY,
    INK,
    VERMILION,
    label_line,
    panels,
    styled,
)

_MM = 1e3


@styled
def contact_ratio_after_tregold(ratios: xr.Dataset, marked: Sequence[int]) -> Figure:
    """Figure 4.3: contact ratio after Tregold against the number of pinion teeth.

    Parameters
    ----------
    ratios : xarray.Dataset
        ``contact_ratio`` over ``pinion_teeth``.
    marked : sequence of int
        Tooth numbers to mark.
    """
    figure, (axes,) = panels(1, 1, 3.6)
    axes.plot(ratios.pinion_teeth, ratios.contact_ratio, "o-", markersize=4)
    chosen = ratios.sel(pinion_teeth=list(marked))
    axes.plot(
        chosen.pinion_teeth, chosen.contact_ratio, "o", color=VERMILION, markersize=8, markerfacecolor="none"
    )
    for teeth, ratio in zip(chosen.pinion_teeth.values, chosen.contact_ratio.values, strict=True):
        label_line(axes, f"{ratio:.4f}", (teeth, ratio), (6, -22))
    axes.set(xlabel="number of pinion teeth $N_1$", ylabel="contact ratio $c_r$")
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    return figure


@styled
def contact_ratios_compared(ratios: xr.Dataset, tregold: xr.Dataset, geometric: xr.Dataset) -> Figure:
    """Tregold's contact ratio beside that of the true sweep, and the pairs in mesh that each implies.

    Parameters
    ----------
    ratios : xarray.Dataset
        ``contact_ratio``, ``geometric_contact_ratio`` over ``pinion_teeth``.
    tregold, geometric : xarray.Dataset
        ``total_length`` [m] over ``time``, with either contact ratio.
    """
    figure, axes = panels(1, 2, 3.8)
    axes[0].plot(ratios.pinion_teeth, ratios.geometric_contact_ratio, "s-", color=VERMILION, markersize=4)
    axes[0].plot(ratios.pinion_teeth, ratios.contact_ratio, "o-", color=BLUE, markersize=4)
    axes[0].annotate(
        "true contact lines", (0.3, 0.82), xycoords="axes fraction", color=VERMILION, ha="center"
    )
    axes[0].annotate("Tregold", (0.5, 0.22), xycoords="axes fraction", color=BLUE, ha="center")
    axes[0].set(xlabel="number of pinion teeth $N_1$", ylabel="contact ratio", ylim=(1.0, None))
    axes[1].plot(geometric.time, geometric.total_length * _MM, color=VERMILION)
    axes[1].plot(tregold.time, tregold.total_length * _MM, color=BLUE)
    axes[1].set(xlabel="$t/T_0$", ylabel="total length of contact lines [mm]", ylim=(0, None))
    for panel, letter in zip(axes, "ab", strict=True):
        panel.set_title(f"({letter})", loc="left")
    return figure


@styled
def undercut_condition(condition: xr.Dataset) -> Figure:
    """Condition of undercutting over the local pressure angle, with its real roots.

    Parameters
    ----------
    condition : xarray.Dataset
        ``value`` [-] over ``tangent``; ``roots``, ascending, the last one physical.
    """
    figure, (axes,) = panels(1, 1, 3.4)
    axes.axhline(0, color=INK, linewidth=0.8)
    axes.plot(condition.tangent, condition.value)
    *others, physical = condition["roots"].values
    for root in others:
        axes.plot(root, 0, "o", color=GREY, markersize=8, markerfacecolor="white", zorder=5)
        label_line(axes, f"$t = {root:.4f}$\non the far branch", (root, 0), (-62, -78))
    axes.plot(physical, 0, "o", color=VERMILION, markersize=8, zorder=5)
    label_line(axes, f"$t = {physical:.4f}$\nphysical", (physical, 0), (-6, -78))
    axes.set(xlabel=r"$t = \tan(\phi_s + \theta_{0s} + \theta_s^*)$", ylabel="condition (left $-$ right)")
    return figure


@styled
def limits_against_shaft_angle(limits: xr.Dataset) -> Figure:
    """Limiting radii and contact ratios over the shaft angle.

    Parameters
    ----------
    limits : xarray.Dataset
        ``inner_radius``, ``outer_radius`` [m], ``contact_ratio``, ``geometric_contact_ratio`` over ``shaft_angle_deg``.
    """
    figure, axes = panels(1, 2, 3.8)
    axes[0].fill_between(
        limits.shaft_angle_deg,
        limits.inner_radius * _MM,
        limits.outer_radius * _MM,
        color=BLUE,
        alpha=0.15,
        linewidth=0,
    )
    axes[0].plot(limits.shaft_angle_deg, limits.outer_radius * _MM, color=BLUE)
    axes[0].plot(limits.shaft_angle_deg, limits.inner_radius * _MM, color=BLUE)
    axes[0].annotate("pointed, $R_2$", (0.7, 0.96), xycoords="axes fraction", ha="center")
    axes[0].annotate("undercut, $R_1$", (0.5, 0.1), xycoords="axes fraction", ha="center")
    axes[0].set(xlabel=r"shaft angle $\gamma$ [degree]", ylabel="radius on the gear plane [mm]")
    axes[1].plot(
        limits.shaft_angle_deg, limits.geometric_contact_ratio, color=VERMILION, label="true contact lines"
    )
    axes[1].plot(limits.shaft_angle_deg, limits.contact_ratio, color=BLUE, label="Tregold")
    axes[1].set(xlabel=r"shaft angle $\gamma$ [degree]", ylabel="contact ratio", ylim=(1.0, None))
    axes[1].legend(loc="center right")
    return figure


@styled
def top_land(land: xr.Dataset) -> Figure:
    """Thickness of the tooth at its top along the face, and its last millimetre enlarged.

    Parameters
    ----------
    land : xarray.Dataset
        ``thickness`` [m] over ``distance`` [m], and ``pointed_distance`` [m].
    """
    figure, axes = panels(1, 2, 3.4)
    outer, pointed = float(land.distance[-1]) * _MM, float(land.pointed_distance) * _MM
    for panel in axes:
        panel.axhline(0, color=INK, linewidth=0.8)
        panel.set_xlabel("distance from the gear's axis [mm]")
    axes[0].plot(land.distance * _MM, land.thickness * _MM)
    axes[0].set_ylabel("top land [mm]")
    axes[0].set_title("(a) whole face", loc="left")
    last = land.sel(distance=slice((outer - 1.0) / _MM, None))
    axes[1].plot(last.distance * _MM, last.thickness * 1e6)
    axes[1].plot(pointed, 0, "o", color=VERMILION)
    axes[1].axvline(outer, color=GREY, linewidth=0.8, linestyle=(0, (4, 3)))
    label_line(axes[1], f"true flanks meet\n{pointed:.3f} mm", (pointed, 0), (-96, -30))
    axes[1].annotate(
        f"$R_2$ = {outer:.3f} mm ", (outer, 0.93), xycoords=("data", "axes fraction"), ha="right"
    )
    axes[1].set_ylabel("top land [µm]")
    axes[1].set_title("(b) outer end", loc="left")
    return figure
