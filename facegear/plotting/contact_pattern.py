"""The loaded contact pattern on a flank."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from facegear.plotting.style import GREY, GROWTH, panels, styled
from facegear.support.types import FloatArray

_MM = 1e3


def _continued(pressure: FloatArray) -> FloatArray:
    """Go on below zero where nothing presses, so that the zero is where the load ends and not at the next point."""
    place = np.arange(pressure.shape[1])
    going_on = np.full_like(pressure, -1e-3 * pressure.max())
    for row, out in zip(pressure, going_on, strict=True):
        pressed = np.flatnonzero(row)
        if len(pressed) > 1:
            for end, inside in ((pressed[0], pressed[1]), (pressed[-1], pressed[-2])):
                beyond = place < end if end < inside else place > end
                slope = max(row[inside] - row[end], 0.0)
                out[beyond] = row[end] - slope * np.abs(place[beyond] - end)
        out[pressed] = row[pressed]
    return np.where(pressure > 0.0, pressure, np.minimum(going_on, 0.0))


@styled
def contact_pattern(data: xr.Dataset) -> Figure:
    """Draw load per length over a flank: along the face, and from the tooth top down; grey where lines end.

    Parameters
    ----------
    data : xarray.Dataset
        From :func:`facegear.mechanics.contact_pattern.loaded_contact_pattern`.
    """
    figure, (ax,) = panels(height=3.4)
    position, height = data["position"] * _MM, data["height"] * _MM
    pressure = _continued(data["pressure"].values * 1e-3)
    drawn = ax.contourf(
        position.values,
        height.values,
        pressure,
        levels=pressure.max() * np.linspace(0.0, 1.0, 26),
        cmap=GROWTH,
    )
    for line in ({"point": 0}, {"point": -1}, {"age": 0}, {"age": -1}):
        ax.plot(position[line], height[line], color=GREY, linewidth=0.8)
    ax.set(xlabel="along the face, u [mm]", ylabel="below the tooth top [mm]")
    ax.invert_yaxis()
    ax.grid(False)
    figure.colorbar(drawn, ax=ax, label="load per length [N/mm]", format="%.0f")
    ax.set_title(f"{float(data['torque']):g} N m at the pinion")
    return figure
