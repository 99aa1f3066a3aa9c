"""Figures of the driving force spread over teeth."""

from __future__ import annotations

import xarray as xr
from matplotlib.figure import Figure

from facegear.plotting.style import (
    BLUE,
    FAINT,
    GREEN,
    ORANGE,
    PURPLE,
    VERMILION,
    draw_border,
    draw_unstable,
    panels,
    styled,
)
from facegear.support.parameters import WATT_PER_HORSEPOWER

_LINES = ((VERMILION, "-"), (BLUE, "--"), (GREEN, "-."), (ORANGE, ":"), (PURPLE, (0, (5, 1, 1, 1))))
_SPEED = "speed of the face gear [rpm]"


@styled
def tilt_along_face(data: xr.Dataset) -> Figure:
    """Draw what a following force works on by its radius, the face of the teeth shaded.

    Parameters
    ----------
    data : xarray.Dataset
        From :func:`compendium.datasets.spread_force.tilt_along_face`.
    """
    names = data.body_name.values.tolist()
    figure, axes = panels(1, len(names), 3.6, sharey=True)
    for body, (ax, name) in enumerate(zip(axes, names, strict=True)):
        own = data.isel(body=body)
        ax.axvspan(float(own.face), 1.0, color=FAINT, zorder=0)
        for n, (colour, style) in zip(data.diameters.values.tolist(), _LINES, strict=False):
            ax.plot(
                own.radius,
                own.tilt.sel(diameters=n),
                color=colour,
                linestyle=style,
                label=f"{n} nodal diameter" + ("s" if n > 1 else ""),
            )
        ax.set_title(name, loc="left")
        ax.set(xlabel="$r/R_2$", xlim=(float(own.radius[0]), 1.0))
    axes[0].set_ylabel("work for a moment, over that at the rim")
    axes[0].legend(loc="upper left")
    return figure


@styled
def partly_following(data: xr.Dataset) -> Figure:
    """Draw critical powers against the part of the tilt that follows.

    Parameters
    ----------
    data : xarray.Dataset
        From :func:`compendium.datasets.spread_force.partly_following`.
    """
    names, spreads = data.body_name.values.tolist(), data.spread_name.values.tolist()
    figure, axes = panels(1, len(names), 3.6)
    for body, (ax, name) in enumerate(zip(axes, names, strict=True)):
        for spread, (colour, style) in zip(range(len(spreads)), _LINES, strict=False):
            power = data.critical.isel(body=body, spread=spread) / WATT_PER_HORSEPOWER
            ax.plot(data.part, power, color=colour, linestyle=style, label=spreads[spread])
        ax.set(xscale="log", yscale="log", xlabel=r"part $\chi$ that follows")
        ax.set_title(name, loc="left")
    axes[0].set_ylabel("critical power at 5000 rpm [hp]")
    axes[0].legend()
    return figure


@styled
def power_maps(data: xr.Dataset) -> Figure:
    """Draw maps under a following force, a row a power, a column a spread.

    Parameters
    ----------
    data : xarray.Dataset
        From :func:`compendium.datasets.spread_force.power_maps`.
    """
    powers, spreads = data.power.values, data.spread_name.values.tolist()
    figure, axes = panels(len(powers), len(spreads), 2.3 * len(powers) + 0.9, sharex=True, sharey=True)
    largest = max(1e-9, float(data.growth_rate.max()))
    speed, stiffness = data.speed_rpm.values, data.stiffness.values
    for place, ax in enumerate(axes):
        row, column = divmod(place, len(spreads))
        growth = data.growth_rate.isel(power=row, spread=column).values
        mesh = draw_unstable(ax, speed, stiffness, growth, largest)
        draw_border(ax, speed, stiffness, growth)
        ax.set_title(
            f"{powers[row] / WATT_PER_HORSEPOWER:.0f} hp, {spreads[column]}", loc="left", fontsize=10
        )
        ax.grid(False)
        if column == 0:
            ax.set_ylabel(r"bearing stiffness $\mu$")
    figure.supxlabel(_SPEED, fontsize="medium")
    figure.colorbar(mesh, ax=axes, label="growth rate [1/s]", shrink=0.8)
    return figure
