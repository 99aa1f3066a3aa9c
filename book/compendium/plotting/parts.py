"""What drawings of mechanical models are made of: springs, dampers, masses, ground, arrows."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import FancyArrowPatch, Rectangle

from facegear.plotting.style import GREY, INK, SKY
from facegear.support.types import FloatArray

Point = tuple[float, float]


def bare(axes: Axes, width: tuple[float, float], height: tuple[float, float]) -> None:
    """Equal scales and no frame: a drawing, not a diagram."""
    axes.set(xlim=width, ylim=height)
    axes.set_aspect("equal")
    axes.axis("off")


def line(axes: Axes, *points: Point, **options: Any) -> None:
    """Draw a line through points."""
    x, y = zip(*points, strict=True)
    settings: dict[str, Any] = {"color": INK, "linewidth": 1.2, "solid_capstyle": "round"}
    axes.plot(x, y, **(settings | options))


def arrow(axes: Axes, start: Point, end: Point, **options: Any) -> None:
    """Draw an arrow."""
    settings: dict[str, Any] = {"arrowstyle": "-|>", "mutation_scale": 11, "color": INK, "linewidth": 1.2}
    axes.add_patch(FancyArrowPatch(start, end, shrinkA=0, shrinkB=0, **(settings | options)))


def turn(axes: Axes, centre: Point, radius: float, span: tuple[float, float], **options: Any) -> None:
    """Draw an arc with an arrow at its end, from one angle to another [degrees]."""
    angle = np.radians(np.linspace(*span, 60))
    x, y = centre[0] + radius * np.cos(angle), centre[1] + radius * np.sin(angle)
    settings: dict[str, Any] = {"color": INK, "linewidth": 1.2} | options
    axes.plot(x[:-2], y[:-2], **settings)
    arrow(axes, (x[-4], y[-4]), (x[-1], y[-1]), **settings)


def between(start: Point, end: Point, along: FloatArray, beside: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Place a shape between two points: `along` as a fraction of the way, `beside` as it is."""
    a, b = np.asarray(start), np.asarray(end)
    unit = (b - a) / np.hypot(*(b - a))
    points = a + along[:, None] * (b - a) + beside[:, None] * np.array([-unit[1], unit[0]])
    return points[:, 0], points[:, 1]


def spring(axes: Axes, start: Point, end: Point, width: float = 0.14) -> None:
    """Draw a spring."""
    along = np.r_[0.0, 0.2, 0.2 + 0.6 * (np.arange(8) + 0.5) / 8, 0.8, 1.0]
    beside = np.r_[0.0, 0.0, width * np.where(np.arange(8) % 2, -1.0, 1.0), 0.0, 0.0]
    axes.plot(*between(start, end, along, beside), color=INK, linewidth=1.2)


def damper(axes: Axes, start: Point, end: Point, width: float = 0.12) -> None:
    """Draw a damper."""
    for along, beside in (
        ([0.0, 0.42], [0.0, 0.0]),
        ([0.62, 0.42, 0.42, 0.62], [width, width, -width, -width]),
        ([0.55, 0.55], [0.7 * width, -0.7 * width]),
        ([0.55, 1.0], [0.0, 0.0]),
    ):
        axes.plot(*between(start, end, np.array(along), np.array(beside)), color=INK, linewidth=1.2)


def held(axes: Axes, start: Point, end: Point, side: float = 1.0) -> None:
    """Draw the ground: a line with hatching on one side."""
    line(axes, start, end, linewidth=1.5)
    a, b = np.asarray(start), np.asarray(end)
    unit = (b - a) / np.hypot(*(b - a))
    beside = side * np.array([-unit[1], unit[0]])
    for part in np.linspace(0.05, 0.95, 7):
        foot = a + part * (b - a)
        line(axes, tuple(foot), tuple(foot + 0.12 * (beside - unit)), linewidth=0.8, color=GREY)


def block(axes: Axes, centre: Point, width: float, height: float, text: str, colour: str = SKY) -> None:
    """Draw a mass with its name."""
    corner = (centre[0] - width / 2, centre[1] - height / 2)
    axes.add_patch(Rectangle(corner, width, height, facecolor=colour, edgecolor=INK, linewidth=1.2, zorder=3))
    axes.text(*centre, text, ha="center", va="center", zorder=4)


def note(axes: Axes, at: Point, text: str, **place: Any) -> None:
    """Write a text, centred unless told otherwise."""
    settings: dict[str, Any] = {"ha": "center", "va": "center"}
    axes.text(*at, text, **(settings | place))
