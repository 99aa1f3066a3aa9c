"""The picture on the title page of the book."""

from __future__ import annotations

from dataclasses import dataclass

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure

from facegear.plotting.style import GROWTH, INK, draw_unstable, styled


@dataclass(frozen=True)
class Look:
    """Colours for a page of one theme; the picture has no background of its own.

    Attributes
    ----------
    ink : str
        Axes and text.
    growth : Colormap
        From the smallest growth rate to the largest, each well off the page and brighter or darker in order.
    """

    ink: str
    growth: LinearSegmentedColormap


LIGHT = Look(INK, GROWTH)
DARK = Look(
    "#DDDDDD",
    LinearSegmentedColormap.from_list("on_dark", mpl.colormaps["YlGnBu"](np.linspace(0.75, 0.0, 256))),
)


@styled
def vignette(chart: xr.Dataset, look: Look) -> Figure:
    """Stability map over speed and bearing stiffness, without the detail that its chapter has.

    Parameters
    ----------
    chart : xarray.Dataset
        ``growth_rate`` (stiffness, speed_rpm) [1/s], from :func:`compendium.datasets.transverse.stability_figure`.
    look : Look
    """
    figure = Figure(figsize=(4.6, 3.3), layout="constrained")
    figure.patch.set_alpha(0.0)
    axes = figure.subplots()
    axes.patch.set_alpha(0.0)
    growth = chart["growth_rate"].values
    speed, stiffness = chart["speed_rpm"].values, chart["stiffness"].values
    draw_unstable(axes, speed, stiffness, growth, float(growth.max()), look.growth)
    axes.set(xlim=(0.0, speed[-1]), ylim=(0.0, stiffness[-1]))
    axes.set_xlabel("speed of the face gear [rpm]", color=look.ink)
    axes.set_ylabel(r"bearing stiffness $\mu$", color=look.ink)
    axes.grid(False)
    axes.tick_params(colors=look.ink)
    for spine in axes.spines.values():
        spine.set_color(look.ink)
    return figure
