"""One cell of a map, in words and as a figure."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from facegear.drives.cell import CellDetail
from facegear.drives.studies.study import Quantity
from facegear.plotting.style import BLUE, GREEN, GREY, INK, PURPLE, VERMILION, WIDTH, styled


def described(detail: CellDetail, value: float, vertical: Quantity, speed: Quantity) -> str:
    """Say in a sentence or two what happens in a cell."""
    horizontal = speed.label[0].upper() + speed.label[1:]
    at = f"{horizontal} {detail.speed / speed.unit:.4g}, {vertical.label} {value / vertical.unit:.4g}"
    rate = f"{detail.growth_rate:.3g} 1/s"
    if detail.label is None:
        return f"{at}: stable, largest growth rate {rate}."
    text = f"{at}: unstable, the motion grows at {rate} by the resonance {detail.label}."
    if detail.tongue is not None:
        tongue, (low, high) = detail.tongue, (limit / speed.unit for limit in detail.searched)
        ends = (tongue.lower / speed.unit, tongue.upper / speed.unit)
        beyond = ["below " * (ends[0] <= low), "above " * (ends[1] >= high)]
        text += (
            f" Its tongue reaches from {beyond[0]}{ends[0]:.5g} to {beyond[1]}{ends[1]:.5g} and is strongest at "
            f"{tongue.peak / speed.unit:.5g} with {tongue.growth_rate:.3g} 1/s."
        )
    return text


# Names of coordinates beside one another in the legend of a panel.
_NAMES_IN_ROW = 3

RING: dict[str, Any] = {
    "markersize": 11,
    "markerfacecolor": "none",
    "markeredgecolor": VERMILION,
    "markeredgewidth": 2,
}


@styled
def cell_figure(detail: CellDetail) -> Figure:
    """Multipliers in the complex plane and the critical motion.

    Parameters
    ----------
    detail : CellDetail
        From :func:`facegear.drives.cell.cell_detail`.
    """
    figure = Figure(figsize=(WIDTH, 2.9 * rows(detail)), layout="constrained")
    draw_detail(figure, detail)
    return figure


def rows(detail: CellDetail) -> int:
    """Rows of panels that a cell takes: one a part with a deflection, one more for other coordinates beside such."""
    return max(1, len(detail.deflections) + bool(detail.deflections and detail.history is not None))


def draw_detail(figure: Any, detail: CellDetail) -> None:
    """Fill a figure, or a part of one, with multipliers and critical motion."""
    grid = figure.add_gridspec(rows(detail), 12)
    if not detail.deflections:
        _draw_multipliers(figure.add_subplot(grid[0, :5]), detail)
        assert detail.history is not None
        _draw_history(figure.add_subplot(grid[0, 5:]), detail.history)
        return
    _draw_multipliers(figure.add_subplot(grid[0, :4]), detail)
    for row, (part, deflection) in enumerate(detail.deflections.items()):
        # One part needs no name.
        name = "critical motion" if len(detail.deflections) == 1 else part
        for columns, values, title in (
            (slice(4, 8), deflection.real, f"{name}, real part"),
            (slice(8, 12), deflection.imag, "imaginary part"),
        ):
            ax = figure.add_subplot(grid[row, columns])
            _draw_disk(ax, values)
            ax.set_title(title, fontsize=10)
    if detail.history is not None:
        _draw_history(figure.add_subplot(grid[-1, :]), detail.history)


def _draw_multipliers(ax: Axes, detail: CellDetail) -> None:
    circle = np.exp(1j * np.linspace(0.0, 2.0 * np.pi, 200))
    ax.plot(circle.real, circle.imag, color=GREY, linewidth=0.9)
    values = detail.multipliers
    ax.plot(values.real, values.imag, ".", color=BLUE, markersize=6)
    largest = np.array([detail.critical, detail.critical.conjugate()])
    ax.plot(largest.real, largest.imag, "o", **RING)
    reach = 1.12 * max(1.0, float(np.abs(values).max()))
    ax.set(
        xlabel=r"Re $\lambda$",
        ylabel=r"Im $\lambda$",
        aspect="equal",
        xlim=(-reach, reach),
        ylim=(-reach, reach),
    )
    ax.set_title(rf"multipliers, max $|\lambda|$ = {abs(detail.critical):.5f}", fontsize=10)


def _draw_disk(ax: Axes, deflection: xr.DataArray) -> None:
    """Deflection of the disk, seen along its axis, and its nodal lines."""
    radius, angle = np.meshgrid(deflection["radius"], deflection["angle"], indexing="ij")
    x, y = radius * np.cos(angle), radius * np.sin(angle)
    w = deflection.values
    ax.pcolormesh(x, y, w, cmap="PuOr", vmin=-1.0, vmax=1.0, shading="gouraud", rasterized=True)
    if w[1:].min() < 0.0 < w[1:].max():
        ax.contour(x[1:], y[1:], w[1:], levels=[0.0], colors=INK, linewidths=1.2)
    for edge in (0, -1):
        ax.plot(x[edge], y[edge], color=GREY, linewidth=0.8)
    ax.set_aspect("equal")
    ax.axis("off")


def _draw_history(ax: Axes, history: xr.DataArray) -> None:
    """Displacements over time, of the coordinates that move most."""
    lines = ((BLUE, "-"), (VERMILION, "--"), (GREEN, "-."), (PURPLE, ":"))
    order = np.argsort(-np.abs(history.values).max(axis=0), kind="stable")[: len(lines)]
    names = history["coordinate"].values
    for number, (colour, style) in zip(np.sort(order), lines, strict=False):
        ax.plot(history["time"], history[:, number], style, color=colour, label=str(names[number]))
    ax.set(xlabel="time [periods]", ylabel="displacement", ylim=(-1.1, 1.1))
    ax.set_title("critical motion", fontsize=10)
    if len(names) > 1:
        # Above the curves, in as many columns as fit the narrowest panel.
        ax.set_ylim(-1.1, 1.35 if len(names) <= _NAMES_IN_ROW else 1.6)
        ax.legend(loc="upper left", fontsize=8, ncols=_NAMES_IN_ROW, columnspacing=1.0, handlelength=1.6)
