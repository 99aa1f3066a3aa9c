"""Figures of an assessment."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from facegear.plotting.style import GREEN, INK, ORANGE, VERMILION, panels, styled
from facegear.support.parameters import rpm

_SPEED = "speed of the face gear [rpm]"
_STABLE = 0.35
# Largest force over the static one from which a linear axis would hide all but the largest.
_DECADES = 100.0
Intervals = Sequence[tuple[float, float]]


@styled
def model_strips(
    models: Mapping[str, Mapping[str, Intervals]],
    stable: Intervals,
    unstable: Intervals,
    speeds_rpm: tuple[float, float],
) -> Figure:
    """Draw stable and unstable speeds of many models, in groups, and what all of them have in common below.

    Parameters
    ----------
    models : mapping of str to mapping of str to intervals
        Name of a group to names of its models and their unstable intervals [rpm].
    stable, unstable : sequence of tuple of float
        In which all models are stable, and in which they are unstable [rpm].
    speeds_rpm : tuple of float
        Lowest and highest operating speed [rpm].
    """
    rows = sum(len(group) for group in models.values())
    figure, (ax,) = panels(1, 1, 0.24 * rows + 0.4 * len(models) + 1.6)
    low, high = speeds_rpm
    ticks, place = [], 0.0
    for group, members in models.items():
        ax.text(low, place + 0.35, group, fontsize=9, fontweight="bold", va="bottom")
        for name, intervals in members.items():
            place += 1.0
            _strip(ax, place, intervals, speeds_rpm)
            ticks.append((place, name))
        place += 1.2
    place += 0.5
    ax.barh(place, high - low, 0.7, low, color=ORANGE, alpha=0.5)
    for intervals, colour in ((stable, GREEN), (unstable, VERMILION)):
        for start, stop in intervals:
            ax.barh(place, stop - start, 0.7, start, color=colour)
    ticks.append((place, "all together"))
    ax.set_yticks(*zip(*ticks, strict=True), fontsize=8)
    ax.set(xlim=speeds_rpm, ylim=(place + 0.8, -0.7), xlabel=_SPEED)
    ax.grid(False)
    handles = [
        ax.barh(0.0, 0.0, color=colour, alpha=alpha, label=label)
        for colour, alpha, label in (
            (GREEN, 1.0, "stable"),
            (VERMILION, 1.0, "unstable"),
            (ORANGE, 0.5, "depends on the model"),
        )
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=3)
    return figure


def _strip(ax: Axes, place: float, intervals: Intervals, speeds_rpm: tuple[float, float]) -> None:
    low, high = speeds_rpm
    ax.barh(place, high - low, 0.6, low, color=GREEN, alpha=_STABLE)
    for start, stop in intervals:
        # The narrowest tongues would not show: each is at least a line wide.
        ax.barh(place, max(stop - start, 2e-3 * (high - low)), 0.6, start, color=VERMILION)


@styled
def dynamic_load(response: xr.Dataset, static: float) -> Figure:
    """Draw the largest and the smallest force of a tooth pair over speed, and at peaks; gaps where it is unstable.

    The axis is linear, but for forces beyond a hundred times the static one, where it is logarithmic away from zero.

    Parameters
    ----------
    response : xarray.Dataset
        From :func:`facegear.maps.response_map.frequency_response`.
    static : float
        Whole static force of the teeth [N].
    """
    figure, (ax,) = panels(height=3.6)
    speed = rpm(response["speed"].values)
    highest, lowest = response["force_highest"].max("load"), response["force_lowest"].min("load")
    ax.plot(speed, np.asarray(highest) / 1e3, color=VERMILION, marker=".", label="largest of a pair")
    ax.plot(speed, np.asarray(lowest) / 1e3, color=ORANGE, marker=".", label="smallest of a pair")
    _peaks(ax, response, 0.0, 1e3)
    ax.axhline(static / 1e3, color=INK, linestyle="--", linewidth=1.0, label="all pairs together, at rest")
    drawn = np.concatenate([line.get_ydata() for line in ax.lines]).astype(float)
    if np.abs(drawn[np.isfinite(drawn)]).max() > _DECADES * static / 1e3:
        # Linear up to a power of ten, or labels would meet at zero.
        ax.set_yscale("symlog", linthresh=10.0 ** np.ceil(np.log10(2.0 * static / 1e3)), linscale=2.0)
    ax.set(xlabel=_SPEED, ylabel="force between teeth [kN]")
    figure.legend(loc="outside lower center", ncols=2)
    return figure


@styled
def disk_forces(responses: Mapping[str, xr.Dataset], static: float) -> Figure:
    """Draw the range of the force of a mesh over speed in models of the disk, one panel each; gaps where unstable.

    Parameters
    ----------
    responses : mapping of str to xarray.Dataset
        Name of a model to its ``force_lowest`` and ``force_highest`` [N], without the static force, over ``speed`` and
        ``load``.
    static : float
        Static force of a mesh [N].
    """
    figure, axes = panels(len(responses), 1, 2.3 * len(responses) + 0.9)
    for ax, (name, data) in zip(axes, responses.items(), strict=True):
        speed = rpm(data["speed"].values)
        highest, lowest = data["force_highest"].max("load"), data["force_lowest"].min("load")
        low, high = (1.0 + np.asarray(part) / static for part in (lowest, highest))
        ax.fill_between(speed, low, high, color=VERMILION, alpha=_STABLE, linewidth=0.0)
        ax.plot(speed, high, color=VERMILION, marker=".", markersize=3, label="highest")
        ax.plot(speed, low, color=ORANGE, marker=".", markersize=3, label="lowest")
        _peaks(ax, data, static, static)
        ax.axhline(0.0, color=INK, linestyle="--", linewidth=1.0, label="flanks part")
        ax.set(ylabel="force / static", title=name)
    axes[-1].set_xlabel(_SPEED)
    # Peaks are not in every panel.
    named = {
        label: handle for ax in axes for handle, label in zip(*ax.get_legend_handles_labels(), strict=True)
    }
    figure.legend(named.values(), named.keys(), loc="outside lower center", ncols=2)
    return figure


def _peaks(ax: Axes, response: xr.Dataset, offset: float, unit: float) -> None:
    """Mark the forces at resonances between the speeds, an offset added."""
    if not response.sizes["peak"]:
        return
    speed = rpm(response["peak_speed"].values)
    for end, colour, words in (
        ("highest", VERMILION, "at resonances between the speeds"),
        ("lowest", ORANGE, None),
    ):
        force = (offset + response[f"peak_force_{end}"].values) / unit
        ax.plot(speed, force, color=colour, marker="^", markersize=5, linestyle="none", label=words)
