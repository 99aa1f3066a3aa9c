"""Figures of the section on backlash."""

from __future__ import annotations

from collections.abc import Mapping

import xarray as xr
from matplotlib.figure import Figure

from facegear.plotting.motions import CONTACT
from facegear.plotting.style import BLUE, GREEN, INK, VERMILION, panels, styled

_SPEED = "speed of the face gear [rpm]"
_AXES = {"speed": _SPEED, "torque": "torque of the load [N m]"}


@styled
def response(
    data: xr.Dataset, gap: float, words: tuple[str, ...] = ("mean", "rms", "lowest", "highest")
) -> Figure:
    """Draw statistics of the mesh deformation over speed or torque: thick where stable, by what the contact does."""
    (along,) = (name for name in _AXES if name in data.dims)
    figure, axes = panels(len(words), 1, 2.0 * len(words) + 1.0, sharex=True)
    for ax, word in zip(axes, words, strict=True):
        for sheet in data.sheet.values:
            row = data.sel(sheet=sheet)
            for contact, (_, colour) in CONTACT.items():
                for stable, width in ((1.0, 2.0), (0.0, 0.8)):
                    chosen = (row.contact == contact) & (row.stable == stable)
                    line = "-" if row.periods == 1 else "--"
                    ax.plot(
                        data[along],
                        (1e6 * row[word]).where(chosen),
                        line,
                        color=colour,
                        linewidth=width,
                        marker=".",
                        markersize=2 * width,
                    )
        ax.set_ylabel(f"{word} [µm]")
        if word in ("lowest", "highest"):
            for edge in (-gap / 2.0, gap / 2.0):
                ax.axhline(1e6 * edge, color=INK, linewidth=0.6)
    axes[-1].set_xlabel(_AXES[along])
    handles = [axes[0].plot([], [], color=colour, label=name)[0] for name, colour in CONTACT.values()]
    figure.legend(handles=handles, loc="outside lower center", ncols=3)
    return figure


@styled
def growth(data: Mapping[str, xr.Dataset]) -> Figure:
    """Draw the growth of large motions over speed."""
    figure, (ax,) = panels(height=3.2)
    for (name, curve), colour in zip(data.items(), (BLUE, VERMILION, GREEN), strict=False):
        ax.plot(curve.speed, curve.growth, color=colour, label=name)
    ax.axhline(0.0, color=INK, linewidth=0.6)
    ax.set_xlabel(_SPEED)
    ax.set_ylabel("growth a mesh period")
    figure.legend(loc="outside lower center", ncols=len(data))
    return figure
