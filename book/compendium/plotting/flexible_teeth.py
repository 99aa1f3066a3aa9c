"""Figures of the chapter on flexible teeth, both faces and two gears."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from facegear.plotting.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    ORANGE,
    VERMILION,
    darkest,
    draw_unstable,
    panels,
    styled,
)
from facegear.support.types import FloatArray

_SPEED = "speed of the face gear [rpm]"


def _blocks(value: FloatArray) -> list[slice]:
    """Return the runs of rows without a gap of more than twice the usual step."""
    steps = np.diff(value)
    ends = [0, *(np.flatnonzero(steps > 2.0 * np.median(steps)) + 1).tolist(), value.size]
    return [slice(first, last) for first, last in pairwise(ends)]


def _hatch_gaps(ax: Axes, value: FloatArray) -> None:
    """Hatch what lies between the blocks, by half a step off their last rows."""
    half = 0.5 * float(np.median(np.diff(value)))
    for before, after in pairwise(_blocks(value)):
        ends = value[before][-1] + half, value[after][0] - half
        ax.axhspan(*ends, facecolor="none", edgecolor=GREY, hatch="///", linewidth=0.0)


@styled
def growth_maps(data: xr.Dataset, label: str, scale: float = 1.0, columns: int = 3) -> Figure:
    """Draw maps of several models on one scale of colours, each with the unstable share of its cells.

    `label` and `scale` are those of the parameter. Where its values leave a gap, nothing is coloured but hatched.
    One narrow strip of strong growth would leave all else pale: there the colours end before it, with an arrow.
    """
    names = data.model_name.values.tolist()
    rows = -(-len(names) // columns)
    figure, axes = panels(rows, min(columns, len(names)), 2.8 * rows + 0.8, sharex=True, sharey=True)
    largest = darkest(data.growth_rate.values)
    speed, value = data.speed.values, data.value.values * scale
    for place, (ax, name) in enumerate(zip(axes, names, strict=False)):
        growth = data.growth_rate.isel(model=place).values
        for rows_of_block in _blocks(value):
            mesh = draw_unstable(ax, speed, value[rows_of_block], growth[rows_of_block], largest)
        _hatch_gaps(ax, value)
        # A single cell cannot be seen: the number says whether there is one.
        share = f"{100 * (growth > 0.0).mean():.2g}\N{NO-BREAK SPACE}%"
        ax.set_title(f"{name}\n{share}", loc="left", fontsize=9)
        ax.grid(False)
        if place % columns == 0:
            ax.set_ylabel(label)
    figure.supxlabel(_SPEED, fontsize="medium")
    beyond = "max" if float(data.growth_rate.max()) > largest else "neither"
    figure.colorbar(mesh, ax=axes, label="growth rate [1/s]", shrink=0.8, extend=beyond)
    return figure


@styled
def bars(shares: Mapping[str, Mapping[str, float]], label: str) -> Figure:
    """Draw bars of several groups: name of a bar to its lengths by group."""
    groups = list(next(iter(shares.values())))
    figure, (ax,) = panels(height=0.5 * len(shares) + 1.6)
    height = 0.8 / len(groups)
    for place, (group, colour) in enumerate(zip(groups, (VERMILION, BLUE, GREEN, ORANGE), strict=False)):
        rows = np.arange(len(shares)) + (place - (len(groups) - 1) / 2) * height
        lengths = [lengths[group] for lengths in shares.values()]
        ax.barh(rows, lengths, height, color=colour, label=group)
        for row, length in zip(rows, lengths, strict=True):
            ax.annotate(
                f"{length:.1f}", (length, row), (3, 0), textcoords="offset points", va="center", color=INK
            )
    ax.set_yticks(np.arange(len(shares)), list(shares))
    ax.invert_yaxis()
    ax.set_xlabel(label)
    ax.grid(False)
    ax.margins(x=0.1)
    figure.legend(loc="outside lower center", ncols=len(groups))
    return figure
