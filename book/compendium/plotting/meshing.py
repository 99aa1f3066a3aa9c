"""Figures of chapter 3 that show data: tooth, contact lines, contact points, contact ratios."""

from __future__ import annotations

from typing import Any

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.axes3d import Axes3D

from facegear.plotting.style import (
    BLUE,
    FAINT,
    GREEN,
    GREY,
    INK,
    ORANGE,
    STEEL,
    VERMILION,
    WIDTH,
    label_line,
    panels,
    styled,
)

_MM = 1e3
_SWEEP = mpl.colormaps["cividis"]


def _axes_3d(figure: Figure, position: Any = 111) -> Axes3D:
    axes: Axes3D = figure.add_subplot(position, projection="3d")
    axes.set_facecolor("none")
    # Otherwise the nearer half of a surface hides the lines drawn on it.
    axes.computed_zorder = False
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        axis.pane.set_visible(False)
        axis._axinfo["grid"].update(linewidth=0.4, color=FAINT)
    return axes


def _draw_tooth(axes: Axes3D, tooth: xr.Dataset) -> None:
    """Both flanks in the gear's own frame: x across the tooth, y outwards along it, z up [mm]."""
    for flank in tooth.flank:
        points = tooth["surface"].sel(flank=flank).values * _MM
        axes.plot_surface(
            points[..., 0],
            -points[..., 1],
            points[..., 2],
            color=STEEL,
            alpha=0.55,
            linewidth=0,
            shade=True,
            zorder=1,
        )
        for edge in (points[:, 0], points[:, -1], points[0], points[-1]):
            axes.plot(edge[:, 0], -edge[:, 1], edge[:, 2], color=GREY, linewidth=0.7, zorder=2)
    axes.set_xlabel("across tooth [mm]", labelpad=2)
    axes.set_xticks([-4, 0, 4])
    axes.set_ylabel("radial [mm]", labelpad=12)
    axes.set_zlabel("axial [mm]")
    axes.set_box_aspect((1.1, 3.0, 1.1))
    axes.view_init(elev=24, azim=-38)


def _draw_lines(axes: Axes3D, tooth: xr.Dataset) -> None:
    count = tooth.sizes["fraction"]
    for k in range(count):
        line = tooth["line"].isel(fraction=k).values * _MM
        axes.plot(line[:, 0], -line[:, 1], line[:, 2], color=_SWEEP(k / (count - 1)), linewidth=1.6, zorder=3)


@styled
def tooth_and_contact_lines(tooth: xr.Dataset) -> Figure:
    """Figure 3.5: generated tooth with its contact lines, coloured from first contact (dark) to last (light).

    Parameters
    ----------
    tooth : xarray.Dataset
        ``surface`` (flank, along, across, axis) and ``line`` (fraction, point, axis) in the gear's frame [m].
    """
    figure = Figure(figsize=(WIDTH, 3.9))
    figure.subplots_adjust(left=0.1, right=0.95, bottom=0.02, top=1.16)
    axes = _axes_3d(figure)
    _draw_tooth(axes, tooth)
    _draw_lines(axes, tooth)
    _sweep_bar(figure, axes)
    return figure


def _sweep_bar(figure: Figure, axes: Any) -> None:
    scale = mpl.cm.ScalarMappable(mpl.colors.Normalize(0, 1), _SWEEP)
    bar = figure.colorbar(scale, ax=axes, shrink=0.5, pad=0.12, ticks=[0, 1])
    bar.ax.set_yticklabels(["first\ncontact", "last\ncontact"])


@styled
def contact_points(tooth: xr.Dataset) -> Figure:
    """Figure 3.8: midpoints of the contact lines on the tooth, in space and from the side.

    Parameters
    ----------
    tooth : xarray.Dataset
        As for :func:`tooth_and_contact_lines`, with ``midpoint`` (fraction, axis) [m].
    """
    figure = Figure(figsize=(WIDTH, 6.6))
    grid = figure.add_gridspec(
        2, 1, height_ratios=(1.6, 1), left=0.12, right=0.95, bottom=0.09, top=1.02, hspace=0.1
    )
    space = _axes_3d(figure, grid[0])
    _draw_tooth(space, tooth)
    _draw_lines(space, tooth)
    midpoints = tooth["midpoint"].values * _MM
    space.plot(
        midpoints[:, 0], -midpoints[:, 1], midpoints[:, 2], "x", color=VERMILION, markersize=5, zorder=9
    )
    space.set_title("(a) in space", loc="left", y=0.9)
    side = figure.add_subplot(grid[1])
    _side_outline(side, tooth)
    count = tooth.sizes["fraction"]
    for k in range(count):
        line = tooth["line"].isel(fraction=k).values * _MM
        side.plot(-line[:, 1], line[:, 2], color=_SWEEP(k / (count - 1)))
    side.plot(
        -midpoints[:, 1], midpoints[:, 2], "x", color=VERMILION, markersize=5, label="contact point", zorder=5
    )
    side.set(xlabel="distance from the face gear's axis [mm]", ylabel="axial [mm]")
    side.set_title("(b) from the side", loc="left")
    side.legend(loc="lower left")
    return figure


@styled
def contact_line(step: xr.Dataset, tooth: xr.Dataset) -> Figure:
    """Tooth from the side with one contact line and its midpoint.

    Parameters
    ----------
    step : xarray.Dataset
        ``line`` and ``midpoint`` of a single ``fraction``.
    tooth : xarray.Dataset
        The whole tooth, for its outline.
    """
    figure, (axes,) = panels(1, 1, 2.9)
    _side_outline(axes, tooth)
    line, midpoint = step["line"].values[0] * _MM, step["midpoint"].values[0] * _MM
    axes.plot(-line[:, 1], line[:, 2], color=BLUE, linewidth=2.6)
    axes.plot(-midpoint[1], midpoint[2], "x", color=VERMILION, markersize=9, markeredgewidth=2)
    axes.set_title(f"length {float(step['length'][0]) * _MM:.1f} mm", loc="left")
    axes.set(xlabel="distance from the face gear's axis [mm]", ylabel="axial [mm]")
    return figure


def _side_outline(axes: Axes, tooth: xr.Dataset) -> None:
    outline = tooth["surface"].isel(flank=0).values * _MM
    for edge in (outline[:, 0], outline[:, -1], outline[0], outline[-1]):
        axes.plot(-edge[:, 1], edge[:, 2], color=GREY, linewidth=0.8)


def _plot_pair(axes: Axes, x: Any, y: Any, k: int, **options: Any) -> None:
    colours = (BLUE, VERMILION, GREEN, ORANGE)
    axes.plot(x, y, color=colours[k % 4], **options)


@styled
def contact_point_positions(paths: xr.Dataset) -> Figure:
    """Figure 3.9: radial and circumferential position of the contact points of successive tooth pairs.

    Parameters
    ----------
    paths : xarray.Dataset
        ``radius`` [m] and ``angle`` [rad] over (pair, time); NaN where a pair is not in mesh.
    """
    figure, axes = panels(2, 1, 5.4, sharex=True)
    for k in range(paths.sizes["pair"]):
        path = paths.isel(pair=k)
        _plot_pair(axes[0], path.time, path.radius * _MM, k, label=f"pair {k + 1}")
        _plot_pair(axes[1], path.time, np.degrees(path.angle), k)
    axes[0].set_ylabel("radius $r_i$ [mm]")
    axes[1].set_ylabel(r"angle $\theta_i$ [degree]")
    axes[1].set_xlabel(r"rotation of the face gear over its angular pitch, $t/T_0$")
    for name, at in zip("ABC", paths.attrs["instants"], strict=True):
        for panel in axes:
            panel.axvline(at, color=GREY, linewidth=0.8, linestyle=(0, (4, 3)))
        axes[0].annotate(name, (at, 1.0), xycoords=("data", "axes fraction"), ha="center", va="bottom")
    axes[0].legend(ncols=4, loc="lower center", bbox_to_anchor=(0.5, 1.06))
    return figure


@styled
def contact_centroid_sketch(instants: xr.Dataset) -> Figure:
    """Figures 3.10 and 3.11: contact lines, contact points and their centroid on the gear plane at chosen instants.

    Parameters
    ----------
    instants : xarray.Dataset
        Over (instant, pair): ``line_across``, ``line_radial`` (with point) [m], ``point_across``, ``point_radial``,
        ``length`` [m]; over instant ``centroid_across``, ``centroid_radial`` [m].
    """
    figure, axes = panels(1, instants.sizes["instant"], 4.6, sharey=True)
    for k, panel in enumerate(axes):
        shown = instants.isel(instant=k)
        for j in range(shown.sizes["pair"]):
            pair = shown.isel(pair=j)
            if not np.isfinite(float(pair.length)):
                continue
            _plot_pair(panel, pair.line_across * _MM, pair.line_radial * _MM, j, linewidth=2.2)
            panel.plot(
                float(pair.point_across) * _MM, float(pair.point_radial) * _MM, "x", color=INK, markersize=8
            )
            label_line(
                panel,
                f"$l_{j + 1}$ = {float(pair.length) * _MM:.1f} mm",
                (float(pair.point_across) * _MM, float(pair.point_radial) * _MM),
                (14, 10) if k == 0 else (16, -18),
            )
        panel.plot(
            float(shown.centroid_across) * _MM,
            float(shown.centroid_radial) * _MM,
            "o",
            color=INK,
            markerfacecolor="none",
            markersize=12,
            markeredgewidth=1.6,
            label="contact centroid",
        )
        panel.set_title(f"({'ab'[k]}) $t/T_0$ = {float(shown.instant):.2f}", loc="left")
        panel.set_xlabel("across [mm]")
        panel.margins(x=0.5, y=0.1)
    axes[0].set_ylabel("radial [mm]")
    axes[-1].legend(loc="lower right")
    return figure


@styled
def contact_centroid_positions(motion: xr.Dataset) -> Figure:
    """Figure 3.12: contact points and contact centroid over two mesh periods.

    Parameters
    ----------
    motion : xarray.Dataset
        ``radius`` [m], ``angle`` [rad] over (pair, time), NaN where not in mesh; ``centroid_radius``,
        ``centroid_angle`` over time.
    """
    figure, axes = panels(2, 1, 5.6, sharex=True)
    for k in range(motion.sizes["pair"]):
        pair = motion.isel(pair=k)
        label = "contact points" if k == 0 else None
        axes[0].plot(pair.time, pair.radius * _MM, color=GREY, linestyle=(0, (5, 2)), label=label)
        axes[1].plot(pair.time, np.degrees(pair.angle), color=GREY, linestyle=(0, (5, 2)))
    axes[0].plot(
        motion.time,
        motion.centroid_radius * _MM,
        color=VERMILION,
        linewidth=2.2,
        label="contact centroid",
    )
    axes[1].plot(motion.time, np.degrees(motion.centroid_angle), color=VERMILION, linewidth=2.2)
    axes[0].set_ylabel("radius [mm]")
    axes[1].set_ylabel("angle [degree]")
    axes[1].set_xlabel("$t/T_0$")
    axes[0].set_title("(a) radial position", loc="left")
    axes[1].set_title("(b) circumferential position", loc="left")
    axes[0].legend(ncols=2, loc="lower right", bbox_to_anchor=(1.0, 1.0))
    return figure


@styled
def skew_lines(lines: xr.Dataset) -> Figure:
    """Figure 3.13: the skew line that stands for the path of the contact points in the torsional model.

    Parameters
    ----------
    lines : xarray.Dataset
        ``radius`` and ``skew_radius`` [m] over (pair, time), NaN where not in mesh.
    """
    figure, (axes,) = panels(1, 1, 3.6)
    for k in range(lines.sizes["pair"]):
        pair = lines.isel(pair=k)
        axes.plot(
            pair.time,
            pair.radius * _MM,
            color=GREY,
            linestyle=(0, (5, 2)),
            label="contact points" if k == 0 else None,
        )
        _plot_pair(axes, pair.time, pair.skew_radius * _MM, k, label=f"skew line, pair {k + 1}")
    axes.set(xlabel="$t/T_0$", ylabel="radius [mm]")
    axes.legend(ncols=3, loc="lower center", bbox_to_anchor=(0.5, 1.0), columnspacing=1.2, handlelength=1.6)
    return figure
