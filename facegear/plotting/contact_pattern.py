"""The loaded contact pattern on a flank."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from facegear.plotting.style import GREY, GROWTH, panels, styled

_MM = 1e3


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
    pressure = data["pressure"].values * 1e-3
    drawn = ax.contourf(
        position.values,
        height.values,
        pressure,
        levels=pressure.max() * np.append(1e-3, np.linspace(0.04, 1.0, 25)),
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
