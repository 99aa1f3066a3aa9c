"""Charts of levers: what a percent of each design variable does to every tongue, or to what stands between."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.colors import TwoSlopeNorm
from matplotlib.figure import Figure

from facegear.plotting.style import GREY, INK, WIDTH, styled
from facegear.support.types import FloatArray

_DIVERGING = mpl.colormaps["PuOr_r"]
# Beyond this a colour says no more than the number written on it.
_DARKEST = 1.5

What = Literal["centre_change", "width_change", "growth_change"]
_CHANGES: dict[What, str] = {
    "centre_change": "middle speed [% per %]",
    "width_change": "width [% per %]",
    "growth_change": "growth rate [% per %]",
}


@styled
def levers(data: xr.Dataset, symbols: Sequence[str], what: What) -> Figure:
    """Draw what a percent of each variable does to the place, the width or the growth of each tongue.

    Parameters
    ----------
    data : xarray.Dataset
        From :func:`compendium.datasets.levers.levers` or :func:`compendium.datasets.torsional_design.sensitivities`.
    symbols : sequence of str
        Symbols of the variables.
    what : {"centre_change", "width_change", "growth_change"}
        Variable shown; a dot where it is NaN: the model has no such variable.
    """
    names = [f"{a}: {b}" for a, b in zip(data["case_name"].values, data["label"].values, strict=True)]
    return _chart(data[what].values, names, symbols, _CHANGES[what])


@styled
def arrows(data: xr.Dataset, symbols: Sequence[str]) -> Figure:
    """Draw what a percent of each variable does to what stands between it and stability.

    Parameters
    ----------
    data : xarray.Dataset
        From :func:`compendium.datasets.levers.arrows`.
    symbols : sequence of str
        Symbols of the variables.
    """
    return _chart(
        data["change_of"].values.T, data["quantity_name"].values.tolist(), symbols, "change [% per %]"
    )


def _chart(values: FloatArray, rows: Sequence[str], columns: Sequence[str], label: str) -> Figure:
    figure = Figure(figsize=(WIDTH, 1.0 + 0.3 * len(rows)), layout="constrained")
    ax = figure.subplots()
    largest = float(np.nanmax(np.abs(values)))
    limit = min(largest, _DARKEST)
    norm = TwoSlopeNorm(0.0, -limit, limit)
    mesh = ax.imshow(values, cmap=_DIVERGING, norm=norm, aspect="auto")
    for i, j in np.ndindex(*values.shape):
        if np.isnan(values[i, j]):
            ax.text(j, i, "·", ha="center", va="center", fontsize=9, color=GREY)
            continue
        number = float(values[i, j])
        ink = "white" if abs(norm(number) - 0.5) > 0.27 else INK
        ax.text(j, i, _written(number), ha="center", va="center", fontsize=9, color=ink)
    ax.set_xticks(range(len(columns)), columns)
    ax.set_yticks(range(len(rows)), rows)
    ax.xaxis.tick_top()
    ax.tick_params(length=0)
    ax.grid(visible=False)
    for side in ax.spines.values():
        side.set_visible(False)
    beyond = "both" if largest > limit else "neither"
    figure.colorbar(mesh, ax=ax, label=label, pad=0.02, extend=beyond, aspect=30)
    return figure


def _written(value: float) -> str:
    """Two decimals, fewer where a number has many digits before them; no zero with a sign."""
    return f"{value:.{2 if abs(value) < 10 else 1 if abs(value) < 100 else 0}f}".replace("-0.00", "0.00")
