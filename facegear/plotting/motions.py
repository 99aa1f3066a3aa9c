"""Motions of a gearbox with play, over time and in the phase plane."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

import xarray as xr
from matplotlib.figure import Figure

from facegear.plotting.style import BLUE, FAINT, ORANGE, VERMILION, panels, styled

CONTACT: Mapping[int, tuple[str, str]] = MappingProxyType(
    {
        0: ("flanks stay pressed", BLUE),
        1: ("flanks part", ORANGE),
        2: ("back flanks are struck", VERMILION),
    }
)
"""What the flanks do in a motion, in words, and its colour."""


@styled
def motions(data: xr.Dataset, gap: float) -> Figure:
    """Draw motions over time and in the phase plane, by what the contact does; the gap between both flanks in grey.

    Parameters
    ----------
    data : xarray.Dataset
        From :func:`facegear.drives.play.motion_arrays`.
    gap : float
        Backlash [m].
    """
    figure, (over_time, plane) = panels(1, 2, 3.6)
    for motion in data.motion.values:
        row = data.sel(motion=motion)
        colour = CONTACT[int(row.contact)][1]
        size, periods = 1e6 * row.deformation.values, int(row.periods)
        over_time.plot(periods * data.fraction.values, size, color=colour)
        plane.plot(size, 1e3 * row.rate.values, color=colour)
    over_time.axhspan(-5e5 * gap, 5e5 * gap, color=FAINT, linewidth=0)
    plane.axvspan(-5e5 * gap, 5e5 * gap, color=FAINT, linewidth=0)
    over_time.set(xlabel="mesh periods", ylabel="mesh deformation [µm]")
    plane.set(xlabel="mesh deformation [µm]", ylabel="its rate [mm/s]")
    kinds = sorted({int(contact) for contact in data.contact.values})
    handles = [plane.plot([], [], color=CONTACT[kind][1], label=CONTACT[kind][0])[0] for kind in kinds]
    figure.legend(handles=handles, loc="outside lower center", ncols=len(kinds))
    return figure
