"""The map of the explorer, as Plotly draws it, and the mark of a cell on it."""

from __future__ import annotations

import math
from typing import Any

import plotly.graph_objects as go
import xarray as xr
from matplotlib.colors import to_hex

from facegear.drives.explore import unstable
from facegear.drives.studies.study import Quantity
from facegear.plotting.style import GROWTH, INK, VERMILION

_COLOURS = [[k / 10, to_hex(GROWTH(k / 10))] for k in range(11)]


# Where a scale of colours may end, times a power of ten.
_ENDS = (1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0)


def scale_end(chart: xr.DataArray, lowest: float = 0.0) -> float:
    """Round number at which the colours of a map end [1/s], at least `lowest`.

    The largest growth rate of a coarse map is not that of the fine one: their round numbers mostly are the same.

    Examples
    --------
    >>> scale_end(xr.DataArray([[-3.0, 43.7]]))
    50.0
    """
    largest = max(float(chart.max()), lowest, 1e-9)
    power = 10.0 ** math.floor(math.log10(largest))
    return next(end for end in _ENDS if end * power >= largest * (1.0 - 1e-9)) * power


def heat(chart: xr.DataArray, quantity: Quantity, speed: Quantity, end: float) -> dict[str, Any]:
    """Turn a map into what Plotly draws: unstable growth rates as colours up to `end`, all of them to hover over."""
    growth = chart.values
    # Gaps are None: in JSON, which goes to the page, there is no NaN.
    shown = growth.astype(object)
    shown[~unstable(chart)] = None
    return {
        "x": chart["speed"].values / speed.unit,
        "y": chart[chart.dims[0]].values / quantity.unit,
        "z": shown.tolist(),
        "customdata": growth,
        "zmin": 0.0,
        "zmax": end,
    }


def map_figure(chart: xr.DataArray, quantity: Quantity, speed: Quantity) -> go.FigureWidget:
    """Map and the mark of a cell."""
    heatmap = go.Heatmap(
        **heat(chart, quantity, speed, scale_end(chart)),
        colorscale=_COLOURS,
        colorbar={"title": {"text": "growth rate [1/s]", "side": "right"}},
        hovertemplate="%{x:.4g}, %{y:.4g}<br>growth rate %{customdata:.3g} 1/s<extra></extra>",
    )
    mark = go.Scatter(
        x=[float(chart["speed"][chart.shape[1] // 2]) / speed.unit],
        y=[float(chart[chart.dims[0]][chart.shape[0] // 2]) / quantity.unit],
        mode="markers",
        marker={"symbol": "circle-open", "size": 14, "color": VERMILION, "line": {"width": 3}},
        hoverinfo="skip",
        showlegend=False,
    )
    axis = {
        "showgrid": False,
        "zeroline": False,
        "showline": True,
        "linecolor": INK,
        "ticks": "outside",
        "fixedrange": True,
    }
    figure = go.FigureWidget(
        data=[heatmap, mark],
        layout={
            "autosize": True,
            "height": 430,
            "margin": {"l": 70, "r": 10, "t": 10, "b": 60},
            "plot_bgcolor": "white",
            "dragmode": False,
            "xaxis": axis | {"title": {"text": speed.label}},
            "yaxis": axis | {"title": {"text": quantity.label}},
            "font": {"size": 14, "color": INK},
        },
    )
    # Its buttons zoom, which the axes do not, and send the chart to a server.
    figure._config = {"displayModeBar": False, "responsive": True}
    return figure
