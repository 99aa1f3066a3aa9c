"""Mode shapes of the disk."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from facegear.plotting.style import GREY, INK, WIDTH, styled


@styled
def plate_modes(data: xr.Dataset) -> Figure:
    """Deflection of each mode and its nodal lines.

    Parameters
    ----------
    data : xarray.Dataset
        From :func:`facegear.mechanics.mode_shapes.plate_modes`.
    """
    rows, columns = data.sizes["circles"], data.sizes["diameters"]
    figure = Figure(figsize=(WIDTH, 2.15 * rows), layout="constrained")
    axes = figure.subplots(rows, columns, squeeze=False)
    angle = np.linspace(0.0, 2 * np.pi, 181)
    radius, theta = np.meshgrid(data["radius"].values, angle, indexing="ij")
    for m in range(rows):
        for n in range(columns):
            ax = axes[m, n]
            w = data["mode"].values[m, n][:, np.newaxis] * np.cos(n * angle)
            w = w / np.abs(w).max()
            x, y = radius * np.cos(theta), radius * np.sin(theta)
            ax.pcolormesh(x, y, w, cmap="PuOr", vmin=-1, vmax=1, shading="gouraud", rasterized=True)
            inner = slice(2, None)  # The clamped edge itself is not a nodal line.
            if n or (w[inner].min() < 0 < w[inner].max()):
                ax.contour(x[inner], y[inner], w[inner], levels=[0.0], colors=INK, linewidths=1.4)
            for edge in (0, -1):
                ax.plot(x[edge], y[edge], color=GREY, linewidth=0.8)
            ax.set_aspect("equal")
            ax.axis("off")
            ax.set_title(f"({m}, {n})  {float(data['frequency'][m, n]):.0f} Hz", fontsize=10)
    return figure
