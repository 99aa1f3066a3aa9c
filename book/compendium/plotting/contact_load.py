"""Figures of the chapter on contact under load."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from facegear.plotting.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    ORANGE,
    PURPLE,
    STEEL,
    VERMILION,
    draw_border,
    label_line,
    panels,
    styled,
)

_MM, _UM = 1e3, 1e6
_LAW = {"slice": "slices, each for itself", "pair": "rigid pairs"}
_DASH = {"slice": "-", "pair": "--"}


_ERRORS = {
    "offset": ("offset ΔE [µm]", _UM),
    "gear_axial": ("gear closer [µm]", _UM),
    "shaft_angle": ("shafts opened [mrad]", 1e3),
}


@styled
def contact_pattern(data: xr.Dataset, face: tuple[float, float]) -> Figure:
    """Place of the contact and marking band against each error; `face` is its inner and outer end [m]."""
    names = data.error_name.values.tolist()
    figure, axes = panels(1, len(names), height=3.4, sharey=True)
    for ax, name, row in zip(axes, names, range(len(names)), strict=True):
        one, (label, scale) = data.isel(error=row), _ERRORS[name]
        size = one["size"] * scale
        ax.axhspan(face[0] * _MM, face[1] * _MM, color=STEEL, alpha=0.35, linewidth=0)
        ax.fill_between(size, one.inner * _MM, one.outer * _MM, color=BLUE, alpha=0.35, linewidth=0)
        ax.plot(size, one.position * _MM, color=INK)
        ax.set(xlabel=label)
    axes[0].set_ylabel("along the face, u [mm]")
    return figure


@styled
def effective_contact_ratio(data: xr.Dataset, plates: xr.Dataset, tregold: float, line: float) -> Figure:
    """Effective contact ratio against torque, between Tregold's and that of line contact; `plates` as points."""
    figure, (ax,) = panels(height=4.0)
    for place, law in enumerate(data.law_name.values.tolist()):
        for more, colour in zip(data.more.values.tolist(), (BLUE, GREEN, ORANGE), strict=True):
            ratio = data.contact_ratio.isel(law=place).sel(more=more)
            label = f"shaper with {more} more" if place == 0 else None
            ax.plot(data.torque, ratio, _DASH[law], color=colour, label=label)
    ax.axhline(tregold, color=GREY, linewidth=1.0)
    ax.axhline(line, color=GREY, linewidth=1.0)
    ax.set(xscale="log", xlabel="torque at the pinion [N m]", ylabel="effective contact ratio")
    label_line(
        ax, "Tregold's, and that of the unloaded point", (float(data.torque[10]), tregold), (0.0, 12.0)
    )
    label_line(ax, "line contact, shaper as the pinion", (float(data.torque[2]), line), (0.0, -18.0))
    ax.plot(
        plates.torque,
        plates.contact_ratio[0, 0],
        "o",
        color=BLUE,
        markersize=5,
        label="elastic plates, 1 more",
    )
    ax.plot([], [], "-", color=INK, label=_LAW["slice"])
    ax.plot([], [], "--", color=INK, label=_LAW["pair"])
    ax.legend(loc="center left")
    return figure


@styled
def misaligned_contact_ratio(data: xr.Dataset) -> Figure:
    """Effective contact ratio against each error, one colour a torque."""
    names = data.error_name.values.tolist()
    figure, axes = panels(1, len(names), height=3.6, sharey=True)
    for row, (ax, name) in enumerate(zip(axes, names, strict=True)):
        label, scale = _ERRORS[name]
        size = data["size"].isel(error=row) * scale
        for place, law in enumerate(data.law_name.values.tolist()):
            for torque, colour in zip(data.torque.values.tolist(), (BLUE, GREEN, ORANGE), strict=True):
                ratio = data.contact_ratio.isel(law=place, error=row).sel(torque=torque)
                ax.plot(size, ratio, _DASH[law], color=colour, label=f"{torque:g} N m, {_LAW[law]}")
        ax.set(xlabel=label)
    axes[0].set_ylabel("effective contact ratio")
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=2)
    return figure


@styled
def mesh_period(data: xr.Dataset) -> Figure:
    """Mesh stiffness and transmission error over a mesh period, for both laws."""
    figure, axes = panels(2, 2, height=5.4, sharex=True, sharey="row")
    colours = (BLUE, GREEN, ORANGE, VERMILION)
    for column, law in enumerate(data.law_name.values.tolist()):
        top, bottom = axes[column], axes[2 + column]
        for torque, colour in zip(data.torque.values.tolist(), colours, strict=False):
            one = data.isel(law=column).sel(torque=torque)
            top.plot(data.time, one.stiffness, color=colour, label=f"{torque:g} N m")
            bottom.plot(data.time, (one.approach - one.approach.mean()) * _UM, color=colour)
        top.set_title(_LAW[law])
        bottom.set_xlabel("$t/T_0$")
    axes[0].set_ylabel("mesh stiffness over $k_m$")
    axes[2].set_ylabel("transmission error\nless mean [µm]")
    axes[1].legend(loc="best")
    return figure


@styled
def load_sharing(data: xr.Dataset, torque: float) -> Figure:
    """Share of the load that one pair has, from its first to its last contact, for both laws."""
    figure, (ax,) = panels(height=3.2)
    for column, name in enumerate(data.law_name.values.tolist()):
        one = data.share.isel(law=column).sel(torque=torque)
        age = np.concatenate([data.time.values + pair for pair in data.pair.values])
        share = one.transpose("pair", "time").values.ravel()
        ax.plot(age, np.where(share > 0.0, share, np.nan), _DASH[name], label=_LAW[name])
    ax.set(xlabel="mesh periods since a pair was first pressed", ylabel="share of the load", ylim=(0.0, 1.05))
    ax.legend()
    return figure


@styled
def unstable_shares(data: xr.Dataset, torques: Sequence[float], rated: float, cases: Sequence[str]) -> Figure:
    """Unstable share against torque, from point to line contact, with the dissertation's combination beside it."""
    figure, axes = panels(1, len(cases), height=4.0, sharey=True)
    names = data.contact_name.values.tolist()
    for ax, case, title in zip(axes, range(len(cases)), cases, strict=True):
        share = 100.0 * data.unstable.isel(drive=case)
        for law, colour in (("slice", BLUE), ("pair", GREEN)):
            rows = [names.index(f"{law} {torque:g}") for torque in torques]
            ax.plot(
                torques,
                share.values[rows],
                _DASH[law],
                color=colour,
                marker="o",
                markersize=3,
                label=_LAW[law],
            )
        plates = {float(name.split()[1]): k for k, name in enumerate(names) if name.startswith("plate ")}
        values = share.values[list(plates.values())]
        ax.plot(list(plates), values, "D", color=INK, markersize=4, label="elastic plates")
        low, high = torques[0], torques[-1]
        for name, marker, colour, place, label in (
            (
                "as printed",
                "*",
                VERMILION,
                (low * high) ** 0.5,
                "as printed: sweep of lines, Tregold's clock",
            ),
            ("point", "o", ORANGE, low / 2.0, "point contact, no load"),
            ("line", "s", PURPLE, high * 2.0, "line contact, its own clock"),
        ):
            value = float(share[names.index(name)])
            ax.plot(
                [place], [value], marker, color=colour, markersize=12 if marker == "*" else 7, label=label
            )
        ax.axvline(rated, color=GREY, linewidth=0.8, linestyle=":")
        ax.set(xscale="log", xlabel="torque at the pinion [N m]", title=title)
        lines = [k for k, name in enumerate(names) if name.split()[0] in ("slice", "pair", "plate")]
        if not share.values[lines].any():
            ax.annotate(
                "all zero",
                (0.5, 0.0),
                (0, 8),
                xycoords=("axes fraction", "data"),
                textcoords="offset points",
                ha="center",
            )
    axes[0].set_ylabel("unstable cells of the map [%]")
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=2)
    return figure


@styled
def load_place(data: xr.Dataset) -> Figure:
    """Radius of the load over a mesh period, one line a contact."""
    figure, (ax,) = panels(height=3.2)
    for place, (name, colour) in enumerate(
        zip(data.contact_name.values.tolist(), (VERMILION, BLUE, GREEN), strict=True)
    ):
        ax.plot(data.time, data.radius.isel(contact=place) * _MM, color=colour, label=name)
    ax.set(xlabel="$t/T_0$", ylabel="radius of the load [mm]")
    ax.legend()
    return figure


@styled
def torque_maps(maps: Sequence[xr.Dataset], titles: Sequence[str]) -> Figure:
    """How fast the slowest motion dies down over speed and torque; what grows is outlined."""
    figure, axes = panels(1, len(maps), height=3.8, sharey=True)
    fastest = max(-float(data.growth_rate.min()) for data in maps)
    for ax, data, title in zip(axes, maps, titles, strict=True):
        speed, torque, growth = data.speed.values, data.torque.values, data.growth_rate.values
        mesh = ax.pcolormesh(
            speed, torque, -growth, cmap="cividis", vmin=0.0, vmax=fastest, shading="nearest", rasterized=True
        )
        draw_border(ax, speed, torque, growth)
        ax.set(yscale="log", title=title)
        ax.grid(False)
    axes[0].set_ylabel("torque at the pinion [N m]")
    figure.supxlabel("speed of the face gear [rpm]", fontsize="medium")
    figure.colorbar(mesh, ax=axes, label="decay of the slowest motion [1/s]")
    return figure


@styled
def gearbox_tongues(data: xr.Dataset, speeds_rpm: tuple[float, float]) -> Figure:
    """Unstable intervals of speed, one panel a gearbox and one line a contact."""
    boxes, contacts = data.attrs["gearboxes"].split(", "), data.attrs["contacts"].split("; ")
    figure, axes = panels(2, 3, height=6.0, sharex=True, sharey=True)
    for number, (ax, box) in enumerate(zip(axes, boxes, strict=True)):
        own = data.isel(tongue=data.gearbox.values == number)
        ax.hlines(np.arange(len(contacts)), *speeds_rpm, color=GREY, linewidth=0.8)
        for low, high, contact in zip(own.lower.values, own.upper.values, own.contact.values, strict=True):
            # What is narrower than a line of the picture is drawn as one.
            ax.plot([low, high], [contact, contact], color=VERMILION, linewidth=7.0, solid_capstyle="butt")
        ax.set(title=f"Fig. {box}", xlim=speeds_rpm)
        ax.grid(False)
    axes[0].set_yticks(np.arange(len(contacts)), contacts)
    axes[0].invert_yaxis()
    figure.supxlabel("speed of the face gear [rpm]", fontsize="medium")
    return figure


@styled
def dynamic_load(data: xr.Dataset) -> Figure:
    """Dynamic force over speed, one line a torque."""
    figure, (ax,) = panels(height=3.6)
    for torque in data.torque.values.tolist():
        ax.plot(data.speed, 100.0 * data.dynamic_force.sel(torque=torque), label=f"{torque:g} N m")
    ax.set(
        yscale="log",
        xlabel="speed of the face gear [rpm]",
        ylabel="dynamic mesh force, rms [% of static]",
    )
    ax.legend()
    return figure
