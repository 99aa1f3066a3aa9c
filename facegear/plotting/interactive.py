"""Figures that move: alive in JupyterLab, and in the pages of the book without a kernel or a network."""

from __future__ import annotations

import base64
import io
import json
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

import ipywidgets
import plotly.graph_objects as go
from matplotlib.figure import Figure

from facegear.geometry.solids import Mesh
from facegear.plotting.style import SKY


@dataclass(frozen=True)
class TurningView:
    """A 3-D figure that the reader can turn.

    Shown as Plotly's own type in JupyterLab, and as HTML that the book's script brings to life on a page.

    Attributes
    ----------
    figure : plotly.graph_objects.Figure
        The figure.
    alt : str
        What it shows, for readers who cannot see it.
    height : int
        Height [px].
    """

    figure: go.Figure
    alt: str
    height: int = 400

    def _repr_mimebundle_(self, **_: Any) -> dict[str, Any]:
        specification = self.figure.to_json()
        # Inside a script element only this sign could end it early.
        safe = specification.replace("<", "\\u003c")
        html = (
            f'<div class="turning-view" role="group" aria-label="{escape(self.alt)}">'
            f'<div class="turning-view-canvas" style="height:{self.height}px"></div>'
            f'<script type="application/json">{safe}</script></div>'
        )
        return {"application/vnd.plotly.v1+json": json.loads(specification), "text/html": html}


def turning_view(pinion: Mesh, gear: Mesh, alt: str) -> TurningView:
    """Pinion and face gear in mesh, to be turned by the reader.

    Parameters
    ----------
    pinion, gear : Mesh
        Both in the space-fixed frame [m].
    alt : str
        What it shows.

    Returns
    -------
    TurningView
    """
    # Small faces have a normal too: without the last number those of the gear get no light.
    light = {
        "ambient": 0.65, "diffuse": 0.7, "specular": 0.2, "roughness": 0.6, "facenormalsepsilon": 0.0,
    }  # fmt: skip

    def body(mesh: Mesh, colour: str, name: str) -> go.Mesh3d:
        # A tenth of a millimetre is finer than a pixel, and a shorter number a smaller page.
        x, y, z = (mesh.vertices * 1e3).round(2).T.astype("float32")
        i, j, k = mesh.triangles.T.astype("int32")
        return go.Mesh3d(
            x=x,
            y=y,
            z=z,
            i=i,
            j=j,
            k=k,
            color=colour,
            name=name,
            flatshading=True,
            lighting=light,
            hoverinfo="name",
        )

    figure = go.Figure([body(gear, "#C3CFD8", "face gear"), body(pinion, SKY, "pinion")])
    axis = {"visible": False}
    figure.update_layout(
        margin={"l": 0, "r": 0, "t": 0, "b": 0},
        paper_bgcolor="white",
        scene={
            "xaxis": axis,
            "yaxis": axis,
            "zaxis": axis,
            "aspectmode": "data",
            "camera": {"eye": {"x": 0.8, "y": -1.3, "z": 0.85}, "center": {"x": 0.0, "y": -0.05, "z": -0.1}},
        },
    )
    return TurningView(figure, alt)


def slider(
    figures: Sequence[Figure], labels: Sequence[str], alts: Sequence[str], description: str
) -> ipywidgets.VBox:
    """Slider through figures that were all drawn beforehand, so that it needs no kernel.

    Parameters
    ----------
    figures : sequence of matplotlib.figure.Figure
        One a step, all of one size.
    labels, alts : sequence of str
        Text beside the slider, and description of each figure for readers who cannot see it.
    description : str
        What the slider changes.

    Returns
    -------
    ipywidgets.VBox
    """
    pages = [ipywidgets.HTML(image(figure, alt, dpi=110)) for figure, alt in zip(figures, alts, strict=True)]
    control = ipywidgets.SelectionSlider(
        options=[(label, step) for step, label in enumerate(labels)],
        description=description,
        layout=ipywidgets.Layout(width="min(32rem, 100%)"),
        style={"description_width": "initial"},
    )
    stack = ipywidgets.Stack(pages, selected_index=0)
    ipywidgets.jslink((control, "index"), (stack, "selected_index"))
    return ipywidgets.VBox([control, stack])


def image(figure: Figure, alt: str, name: str = "", dpi: int = 100) -> str:
    """HTML of a figure as a picture that stands in the page itself.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
    alt : str
        What it shows, for readers who cannot see it.
    name : str
        Class of the element, by which a page finds it.
    dpi : int
        Dots an inch.
    """
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=dpi)
    drawn = base64.b64encode(buffer.getvalue()).decode()
    named = f'class="{name}" ' if name else ""
    return f'<img {named}src="data:image/png;base64,{drawn}" alt="{escape(alt)}" style="max-width:100%">'
