"""The map of the explorer, as Plotly draws it, and the mark of a cell on it."""

from __future__ import annotations

from typing import Any

import plotly.graph_objects as go
import xarray as xr
from matplotlib.colors import to_hex

from facegear.drives.explore import unstable
from facegear.drives.studies.study import Quantity
from facegear.plotting.style import GROWTH, INK, VERMILION

_COLOURS = [[k / 10, to_hex(GROWTH(k / 10))] for k in range(11)]


def heat(chart: xr.DataArray, quantity: Quantity, speed: Quantity) -> dict[str, Any]:
    """Turn a map into what Plotly draws: unstable growth rates as colours, all of them to hover over."""
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
        "zmax": max(float(growth.max()), 1e-9),
    }


def map_figure(chart: xr.DataArray, quantity: Quantity, speed: Quantity) -> go.FigureWidget:
    """Map and the mark of a cell."""
    heatmap = go.Heatmap(
        **heat(chart, quantity, speed),
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
