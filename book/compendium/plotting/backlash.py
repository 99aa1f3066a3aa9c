"""Figures of the section on backlash."""

from __future__ import annotations

from collections.abc import Mapping

import xarray as xr
from matplotlib.figure import Figure

from facegear.plotting.style import BLUE, FAINT, GREEN, INK, ORANGE, VERMILION, panels, styled

_SPEED = "speed of the face gear [rpm]"
_AXES = {"speed": _SPEED, "torque": "torque of the load [N m]"}
_CONTACT = {
    0: ("flanks stay pressed", BLUE),
    1: ("flanks part", ORANGE),
    2: ("back flanks are struck", VERMILION),
}


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
            for contact, (_, colour) in _CONTACT.items():
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
    handles = [axes[0].plot([], [], color=colour, label=name)[0] for name, colour in _CONTACT.values()]
    figure.legend(handles=handles, loc="outside lower center", ncols=3)
    return figure


@styled
def motions(data: xr.Dataset, gap: float) -> Figure:
    """Draw motions over time and in the phase plane, by what the contact does; the gap between both flanks in grey."""
    figure, (over_time, plane) = panels(1, 2, 3.6)
    for motion in data.motion.values:
        row = data.sel(motion=motion)
        colour = _CONTACT[int(row.contact)][1]
        size, periods = 1e6 * row.deformation.values, int(row.periods)
        over_time.plot(periods * data.fraction.values, size, color=colour)
        plane.plot(size, 1e3 * row.rate.values, color=colour)
    over_time.axhspan(-5e5 * gap, 5e5 * gap, color=FAINT, linewidth=0)
    plane.axvspan(-5e5 * gap, 5e5 * gap, color=FAINT, linewidth=0)
    over_time.set(xlabel="mesh periods", ylabel="mesh deformation [µm]")
    plane.set(xlabel="mesh deformation [µm]", ylabel="its rate [mm/s]")
    kinds = sorted({int(contact) for contact in data.contact.values})
    handles = [plane.plot([], [], color=_CONTACT[kind][1], label=_CONTACT[kind][0])[0] for kind in kinds]
    figure.legend(handles=handles, loc="outside lower center", ncols=len(kinds))
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
