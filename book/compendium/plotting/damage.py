"""Figures of the chapter on damage."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse
from matplotlib.ticker import NullFormatter

from facegear.floquet.hill import HillSpectrum
from facegear.plotting.style import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, VERMILION, panels, styled
from facegear.support.types import ComplexArray, FloatArray

_COLOURS = (BLUE, ORANGE, VERMILION, GREEN, PURPLE)
_PARTS = {
    "input_stiffness": "input shaft",
    "output_stiffness": "output shaft",
    "mesh_stiffness": "mesh",
}
# Probability within an ellipse of 95 %, two dimensions.
_WIDTH_95 = 2.0 * np.sqrt(-2.0 * np.log(0.05))


@styled
def convergence(data: xr.Dataset) -> Figure:
    """Draw errors over the number of harmonics, one panel a way to take exponents from the matrix."""
    routes = data.route.values.tolist()
    figure, axes = panels(1, len(routes), 3.9, sharey=True)
    for ax, (column, route) in zip(axes, enumerate(routes), strict=True):
        for row, (kind, colour) in enumerate(
            zip(data.kind.values.tolist(), _COLOURS[: data.system.size], strict=True)
        ):
            errors = data.error.values[row, column]
            ax.loglog(data.harmonics, errors, ".-", color=colour, label=kind if column == 0 else None)
        ax.set_title(route)
        ax.set_xlabel("harmonics $H$")
        ax.set_xticks([2, 8, 32], ["2", "8", "32"])
        ax.xaxis.set_minor_formatter(NullFormatter())
    axes[0].set_ylabel("largest error [1/s]")
    figure.legend(loc="outside lower center", ncols=5)
    return figure


@styled
def spectrum(found: HillSpectrum, chosen: ComplexArray, exact: ComplexArray, reach: float) -> Figure:
    """Draw eigenvalues of Hill's matrix, those chosen and the exact exponents; `reach` in mesh frequencies."""
    figure, (ax,) = panels(height=4.6)
    turn = 2.0 * np.pi / found.period
    near = np.abs(found.exponents.imag) < reach * turn
    ax.plot(
        found.exponents.real[near],
        found.exponents.imag[near] / turn,
        ".",
        color=GREY,
        label="all eigenvalues",
    )
    ax.plot(
        chosen.real,
        chosen.imag / turn,
        "o",
        color=VERMILION,
        fillstyle="none",
        markersize=9,
        label="best centred",
    )
    ax.plot(exact.real, exact.imag / turn, "+", color=BLUE, markersize=11, label=r"$\ln\lambda/T_0$")
    ax.axhspan(-0.5, 0.5, color=BLUE, alpha=0.08, label="base strip")
    ax.set_xlabel("real part [1/s]")
    ax.set_ylabel("imaginary part over the mesh frequency")
    figure.legend(loc="outside lower center", ncols=4)
    return figure


@styled
def frequencies(data: xr.Dataset, scale: FloatArray) -> Figure:
    """Draw the relative change of each motion's frequency over each loss, and its tangent at 0."""
    figure, axes = panels(1, data.part.size, 3.6, sharey=True)
    for ax, (part, name) in zip(axes, enumerate(data.parameter.values.tolist()), strict=True):
        for row, colour in zip(range(data.motion.size), (BLUE, ORANGE, VERMILION), strict=False):
            change = 100.0 * data.frequency_change.values[part, row] / scale[row]
            slope = float(data.frequency_slope[part, row]) / scale[row]
            ax.plot(
                100.0 * data.loss,
                np.abs(change),
                color=colour,
                label=f"motion {row + 1}" if part == 0 else None,
            )
            ax.plot(100.0 * data.loss, 100.0 * np.abs(slope) * data.loss, "--", color=colour, linewidth=0.9)
        ax.set_title(_PARTS[name])
        ax.set_xlabel("loss [%]")
    axes[0].set_ylabel("change of frequency [%]")
    figure.legend(loc="outside lower center", ncols=3)
    return figure


@styled
def clouds(data: xr.Dataset, untold: FloatArray) -> Figure:
    """Draw losses told from three frequencies, the bound's ellipses, and the line that two frequencies leave open.

    Parameters
    ----------
    data : xarray.Dataset
    untold : array, shape (P,)
        Mix of losses that two frequencies do not tell.
    """
    names = [_PARTS[name] for name in data.parameter.values.tolist()]
    pairs = ((0, 1), (0, 2), (1, 2))
    figure, axes = panels(1, 3, 3.4)
    truth, bound = data.truth.values, data.bound.values
    for ax, (i, j) in zip(axes, pairs, strict=True):
        told = 100.0 * data.told.values
        ax.plot(told[:, i], told[:, j], ".", color=BLUE, markersize=3, label="told from three frequencies")
        values, vectors = np.linalg.eigh(bound[np.ix_((i, j), (i, j))])
        angle = float(np.degrees(np.arctan2(vectors[1, 1], vectors[0, 1])))
        width, height = 100.0 * _WIDTH_95 * np.sqrt(values[::-1])
        centre = (100.0 * truth[i], 100.0 * truth[j])
        ellipse = Ellipse(
            centre, width, height, angle=angle, fill=False, edgecolor=INK, label="95 % by the bound"
        )
        ax.add_patch(ellipse)
        limits = ax.get_xlim(), ax.get_ylim()
        reach = np.array([-1.0, 1.0]) * 50.0
        ax.plot(
            centre[0] + reach * untold[i],
            centre[1] + reach * untold[j],
            "--",
            color=VERMILION,
            label="not told by motions 1 and 2",
        )
        ax.set_xlim(*limits[0])
        ax.set_ylim(*limits[1])
        ax.set_xlabel(f"loss, {names[i]} [%]")
        ax.set_ylabel(f"loss, {names[j]} [%]")
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3)
    return figure


@styled
def sidebands(data: xr.Dataset) -> Figure:
    """Draw amplitudes of the lines of a revolution, intact and damaged, and the phases of two teeth's sidebands."""
    figure, axes = panels(2, 1, 5.6, sharex=True)
    orders, teeth = data.harmonic.values / data.attrs["teeth"], data.attrs["teeth"]
    lines = data.amplitude_real.values + 1j * data.amplitude_imaginary.values
    axes[0].semilogy(orders, np.abs(lines[0]), ".", color=VERMILION, markersize=4, label="one tooth damaged")
    mesh = data.harmonic.values % teeth == 0
    axes[0].semilogy(
        orders[mesh], data.intact.values[mesh], "o", color=BLUE, fillstyle="none", label="intact"
    )
    axes[0].set_ylabel("amplitude [rad]")
    axes[0].legend(loc="upper right")
    # A tooth that is later by j mesh periods turns line s by −s j/N2 turns, one line more than its neighbour by −j/N2.
    turned = np.angle(lines[:, 1:] * lines[:, :-1].conj() / (lines[0, 1:] * lines[0, :-1].conj()))
    told = np.round(-turned * teeth / (2.0 * np.pi), 6) % teeth
    clear = ~mesh[1:] & ~mesh[:-1]
    for row, colour in zip(range(len(told)), (VERMILION, GREEN, PURPLE), strict=False):
        label = f"tooth {int(data.tooth[row])}"
        axes[1].plot(orders[1:][clear], told[row][clear], ".", color=colour, markersize=4, label=label)
    axes[1].set_ylim(-5.0, teeth + 15.0)
    axes[1].set_ylabel("tooth told by\nneighbouring lines")
    axes[1].legend(loc="upper right", ncols=len(told))
    axes[1].set_xlabel("frequency over the mesh frequency")
    return figure


@styled
def hit_rates(data: xr.Dataset) -> Figure:
    """Draw the share of trials in which the tooth is found, and the scatter of its severity, over the noise."""
    figure, axes = panels(1, 2, 3.9)
    left, right = axes
    below, above = data.hits - data.low, data.high - data.hits
    left.errorbar(
        data.noise,
        data.hits,
        np.stack([below, above]),
        fmt="o",
        color=BLUE,
        markersize=4,
        label="found, 95 %",
    )
    left.fill_between(data.noise, data.least, data.most, color=ORANGE, alpha=0.25, label="bounds by pairs")
    left.axhline(1.0 / data.attrs["slots"], color=INK, linewidth=0.8, linestyle=":", label="by chance")
    left.set_xscale("log")
    left.set_ylabel("right tooth")
    left.set_xlabel("noise over rms of the pattern")
    right.loglog(data.noise, data.scatter, "o", color=BLUE, markersize=4, label="scatter, tooth known")
    right.loglog(data.noise, data.bound, color=INK, label="Cramér–Rao bound")
    right.set_xlabel("noise over rms of the pattern")
    right.set_ylabel("part of the severity")
    figure.legend(loc="outside lower center", ncols=3)
    return figure
