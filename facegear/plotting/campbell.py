"""Natural frequencies over speed, and natural motions at one."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from facegear.plotting.style import GREY, GROWTH, INK, VERMILION, panels, styled
from facegear.support.parameters import rpm

# Part of the axis of speeds that a name above the frame takes.
_APART = 0.11


@styled
def campbell(data: xr.Dataset) -> Figure:
    """Draw natural frequencies in Hz over speed in rpm, coloured by damping, and where the mesh meets them.

    Parameters
    ----------
    data : xarray.Dataset
        From :func:`facegear.maps.campbell.campbell`.
    """
    _require_motions(data)
    figure, (ax,) = panels(1, 1, 5.0)
    speed, frequency = rpm(data["speed"].values), data["natural_frequency"].values
    damping = data["log_decrement"].values
    shades = Normalize(0.0, max(float(np.nanmax(damping)), 1e-9))
    for row, decrement in zip(frequency, damping, strict=True):
        ax.plot(speed, row, color=GREY, linewidth=0.8, zorder=1)
        points = ax.scatter(speed, row, c=decrement, cmap=GROWTH, norm=shades, s=9, zorder=2)
    mesh = data["mesh_frequency"].values
    top = 1.06 * float(np.nanmax(frequency))
    before: float | None = None
    raised = 0
    for harmonic in np.unique(data["crossing_harmonic"].values).tolist():
        line = harmonic * mesh
        # In proportion to speed: straight up to where it leaves the frame.
        end = min(top, line[-1])
        ax.plot(
            [speed[0], float(np.interp(end, line, speed))], [line[0], end], "--", color=INK, linewidth=1.0
        )
        leaves = float(np.interp(end, line, speed))
        # Above the frame, where nothing else is; where the next line leaves near by, one name above the other.
        raised = 0 if before is None or before - leaves > _APART * float(np.ptp(speed)) else raised + 1
        before = leaves if end == top else None
        ax.annotate(
            f"{harmonic} × mesh",
            (leaves, end),
            xytext=(0, 3 + 10 * raised) if end == top else (3, 0),
            textcoords="offset points",
            ha="center" if end == top else "left",
            va="bottom" if end == top else "center",
            fontsize=8,
            annotation_clip=False,
        )
    at = rpm(data["crossing_speed"].values)
    met = data["crossing_harmonic"].values * np.interp(at, speed, mesh)
    ax.plot(
        at, met, "o", color=VERMILION, markersize=4, markerfacecolor="none", label="met by the mesh", zorder=3
    )
    ax.set(
        xlim=(speed[0], speed[-1]),
        ylim=(0.0, top),
        xlabel="speed of the face gear [rpm]",
        ylabel="frequency [Hz]",
    )
    figure.colorbar(points, ax=ax, label="logarithmic decrement")
    return figure


@styled
def mode_shapes(data: xr.Dataset) -> Figure:
    """Draw the part of each coordinate in the kinetic energy of each natural motion.

    Parameters
    ----------
    data : xarray.Dataset
        From :func:`facegear.maps.campbell.mode_shapes`.
    """
    _require_motions(data)
    count, names = data.sizes["mode"], data["coordinate"].values.tolist()
    figure, (ax,) = panels(1, 1, 0.26 * count + 2.2)
    shares = data["energy_share"].values
    mesh = ax.pcolormesh(
        np.arange(len(names)), np.arange(count), shares, cmap=GROWTH, norm=Normalize(0.0, 1.0)
    )
    pairs = zip(data["mode"].values, data["natural_frequency"].values, strict=True)
    ax.set_yticks(np.arange(count), [f"{mode}: {frequency:.0f} Hz" for mode, frequency in pairs], fontsize=8)
    ax.set_xticks(np.arange(len(names)), names, rotation=90, fontsize=8)
    ax.grid(False)
    figure.colorbar(mesh, ax=ax, label="part of the kinetic energy")
    return figure


def _require_motions(data: xr.Dataset) -> None:
    if "mode" not in data.sizes or not data.sizes["mode"]:
        raise ValueError("data must have at least one motion that oscillates to be drawn, got none")
