"""Drawings of chapter 3 that explain a definition, made from the real geometry of a drive."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LightSource, to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import Arc, FancyArrowPatch
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from facegear.geometry.drive import Drive
from facegear.geometry.solids import Mesh
from facegear.plotting.style import (
    BLUE,
    FAINT,
    GREEN,
    GREY,
    INK,
    SKY,
    STEEL,
    VERMILION,
    WIDTH,
    label_line,
    panels,
    styled,
)
from facegear.support.types import FloatArray

_MM = 1e3


def _bare(axes: Axes) -> None:
    """Equal scales, no frame: a drawing, not a diagram."""
    axes.set_aspect("equal")
    axes.axis("off")


def _circle(axes: Axes, radius: float, span: tuple[float, float], **options: Any) -> None:
    angle = np.linspace(*span, 200)
    axes.plot(radius * np.cos(angle), radius * np.sin(angle), **options)


def _arrow(axes: Axes, start: tuple[float, float], end: tuple[float, float], **options: Any) -> None:
    settings: dict[str, Any] = {
        "arrowstyle": "-|>",
        "mutation_scale": 12,
        "color": INK,
        "linewidth": 1.1,
        "shrinkA": 0,
        "shrinkB": 0,
    }
    axes.add_patch(FancyArrowPatch(start, end, **(settings | options)))


def _text(axes: Axes, at: Any, text: str, **place: Any) -> None:
    axes.text(float(at[0]), float(at[1]), text, **place)


def _dimension(
    axes: Axes, start: tuple[float, float], end: tuple[float, float], text: str, **place: Any
) -> None:
    """Double arrow with its name in the middle."""
    _arrow(axes, start, end, arrowstyle="<|-|>", linewidth=0.9, mutation_scale=9)
    middle = 0.5 * (np.asarray(start) + np.asarray(end))
    settings = {
        "ha": "center",
        "va": "center",
        "bbox": {"facecolor": "white", "edgecolor": "none", "pad": 1.2},
    }
    axes.text(float(middle[0]), float(middle[1]), text, **(settings | place))


@styled
def generation(pinion: Mesh, gear: Mesh) -> Figure:
    """Figure 3.1: pinion, or shaper, on the ring of face-gear teeth.

    Parameters
    ----------
    pinion, gear : Mesh
        Both in the space-fixed frame [m].
    """
    figure = Figure(figsize=(WIDTH, 3.6))
    axes: Any = figure.add_axes((-0.12, -0.42, 1.24, 1.84), projection="3d")
    light = LightSource(azdeg=300, altdeg=45)
    # One collection for both bodies, so that they hide each other where they should.
    triangles = np.vstack([body.vertices[body.triangles] for body in (gear, pinion)]) * _MM
    colours = np.repeat([to_rgb(STEEL), to_rgb(SKY)], [len(gear.triangles), len(pinion.triangles)], axis=0)
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = np.divide(normals, length, out=np.zeros_like(normals), where=length > 0)
    shade = 0.55 + 0.45 * np.abs(normals @ light.direction)
    collection = Poly3DCollection(
        triangles, facecolors=colours * shade[:, None], edgecolors="none", rasterized=True
    )
    axes.add_collection3d(collection)
    low, high = triangles.reshape(-1, 3).min(axis=0), triangles.reshape(-1, 3).max(axis=0)
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    axes.set_box_aspect(high - low, zoom=1.05)
    axes.view_init(elev=32, azim=-62)
    axes.axis("off")
    return figure


@styled
def shaper_profile(drive: Drive, outline: FloatArray, flank: FloatArray, step: int) -> Figure:
    """Figure 3.2: the shaper's involute and the angles of (3-1) and (3-2).

    Parameters
    ----------
    drive : Drive
    outline : ndarray, shape (n, 2)
        Closed outline of the shaper, a tooth space centred on the −y axis [m].
    flank : ndarray, shape (k, 2)
        The involute on the side x > 0 of that space, equally spaced in roll angle from the base to the tip circle [m].
    step : int
        The point of the flank to mark.
    """
    point = flank[step]
    roll = drive.pinion_tip_roll * step / (len(flank) - 1)
    figure, (axes,) = panels(1, 1, 5.2)
    _bare(axes)
    axes.fill(*(outline.T * _MM), facecolor=STEEL, edgecolor=GREY, linewidth=0.9, alpha=0.7)
    base, half = drive.base_radius * _MM, drive.space_half_angle
    right = 0.62 * base  # where the drawing ends, and the names of the circles begin
    for radius, name in (
        (drive.base_radius, "base circle $r_{bs}$"),
        (drive.pitch_radius, "pitch circle $r_p$"),
        (drive.pinion_tip_radius, "tip circle"),
    ):
        span = (-np.pi / 2 - 0.36, -np.pi / 2 + float(np.arcsin(right / (radius * _MM))))
        _circle(axes, radius * _MM, span, color=GREY, linewidth=0.8, linestyle=(0, (6, 3)))
        axes.text(right, radius * _MM * np.sin(span[1]), f" {name}", va="center", color=INK, fontsize=10)
    axes.plot(*(flank.T * _MM), color=BLUE, linewidth=2.4)
    # The string that unwinds from the base circle: its length is r_bs θs, its end the point.
    tangent = base * np.array([np.sin(half + roll), -np.cos(half + roll)])
    axes.plot([tangent[0], point[0] * _MM], [tangent[1], point[1] * _MM], color=VERMILION)
    axes.plot([0, tangent[0]], [0, tangent[1]], color=GREY, linewidth=0.9)
    axes.plot([0, base * np.sin(half)], [0, -base * np.cos(half)], color=GREY, linewidth=0.9)
    axes.plot(*(point * _MM), "o", color=VERMILION)
    label_line(axes, r"$\mathbf{r}_s(u_s,\theta_s)$", tuple(point * _MM), (-86, -34))
    middle = 0.5 * (tangent + point * _MM)
    label_line(axes, r"$r_{bs}\theta_s$", tuple(middle), (34, -40))
    for radius, start, stop, name, aside in (
        (0.62, 0.0, half, r"$\theta_{0s}$", (26, 12)),
        (0.74, half, half + roll, r"$\theta_s$", (10, -26)),
    ):
        _circle(axes, radius * base, (-np.pi / 2 + start, -np.pi / 2 + stop), color=INK, linewidth=1.1)
        angle = -np.pi / 2 + 0.5 * (start + stop)
        label_line(axes, name, (radius * base * np.cos(angle), radius * base * np.sin(angle)), aside)
    _arrow(axes, (0, 0), (0, 0.3 * base))
    _arrow(axes, (0, 0), (0.3 * base, 0))
    axes.text(0.32 * base, 0, "$x_s$", va="center")
    axes.text(0, 0.33 * base, "$y_s$", ha="center")
    axes.plot([0, 0], [0, -1.13 * base], color=INK, linewidth=0.9, linestyle=(0, (9, 3, 2, 3)))
    axes.set_xlim(-right, right)
    axes.set_ylim(-1.2 * base, 0.42 * base)
    return figure


@styled
def coordinate_systems(drive: Drive, rotation: float) -> Figure:
    """Figure 3.3: side view of the two axes, and the turning frames of shaper and face gear with their angles.

    Parameters
    ----------
    drive : Drive
    rotation : float
        φs shown [rad]; the face gear's φ2 is drawn larger than m_2s φs so that it can be seen.
    """
    figure, axes = panels(1, 3, 2.7, width_ratios=(1.7, 1, 1))
    side, shaper, gear = axes
    for panel in axes:
        _bare(panel)
    shaft = drive.shaft_angle
    # The shaper's axis z_s points right; the gear's axis z_p stands at gamma_m to it.
    _arrow(side, (0, 0), (1.25, 0))
    side.text(1.3, 0, r"$z_s, z_m$", va="center")
    axis = np.array([np.cos(np.pi - shaft), np.sin(np.pi - shaft)])
    _arrow(side, (0, 0), tuple(0.9 * axis))
    _text(side, 0.99 * axis, "$z_p, z_2$", ha="center")
    side.plot(
        [0, -0.9 * axis[0]], [0, -0.9 * axis[1]], color=GREY, linewidth=0.9, linestyle=(0, (9, 3, 2, 3))
    )
    pitch = 0.16
    side.fill([0.62, 1.0, 1.0, 0.62], [-pitch, -pitch, pitch, pitch], color=SKY, alpha=0.6)
    side.fill([-0.98, 0.98, 0.98, -0.98], [-pitch - 0.14] * 2 + [-pitch] * 2, color=STEEL)
    side.add_patch(Arc((0, 0), 0.5, 0.5, theta1=0, theta2=np.degrees(np.pi - shaft), color=INK))
    side.text(0.22, 0.24, r"$\gamma_m$")
    side.add_patch(Arc((0, 0), 0.34, 0.34, theta1=-np.degrees(shaft), theta2=0, color=INK))
    side.text(0.24, -0.14, r"$\gamma$", va="top")
    side.set_title("(a) both axes", loc="left")
    side.set_xlim(-1.02, 1.62)
    side.set_ylim(-0.55, 1.1)
    names = (
        (shaper, "m", "s", rotation, r"$\phi_s$", "(b) shaper"),
        (gear, "p", "2", -rotation, r"$\phi_2$", "(c) face gear"),
    )
    for panel, fixed, turning, angle, name, title in names:
        for turn, frame, colour in ((0.0, fixed, INK), (angle, turning, VERMILION)):
            for quarter, letter in ((0.0, "x"), (np.pi / 2, "y")):
                end = np.array([np.cos(turn + quarter), np.sin(turn + quarter)])
                _arrow(panel, (0, 0), tuple(end), color=colour)
                _text(panel, 1.14 * end, f"${letter}_{frame}$", ha="center", va="center", color=colour)
        low, high = sorted((0.0, np.degrees(angle)))
        panel.add_patch(Arc((0, 0), 1.1, 1.1, theta1=low, theta2=high, color=INK))
        middle = 0.72 * np.array([np.cos(angle / 2), np.sin(angle / 2)])
        _text(panel, middle, name, ha="center", va="center")
        panel.set_title(title, loc="left")
        panel.set_xlim(-0.75, 1.3)
        panel.set_ylim(-0.65, 1.3)
    return figure


@styled
def limiting_ends(drive: Drive) -> Figure:
    """Figure 3.6: section through both axes with the limiting ends of the tooth, drawn to scale.

    Parameters
    ----------
    drive : Drive
    """
    figure, (axes,) = panels(1, 1, 3.6)
    _bare(axes)
    inner, outer = drive.inner_limit * _MM, drive.outer_limit * _MM
    top, root = -drive.tooth_top_distance * _MM, -drive.shaper_tip_radius * _MM
    tip, dedendum = drive.pinion_tip_radius * _MM, drive.dedendum_radius * _MM
    pitch = drive.pitch_radius * _MM
    slope = 1.0 / np.tan(drive.shaft_angle)

    def at(distance: float, height: float) -> tuple[float, float]:
        return distance - height * slope, height

    axes.fill([inner, outer, outer, inner], [-tip, -tip, tip, tip], color=SKY, alpha=0.35)
    axes.fill([inner, outer, outer, inner], [-dedendum, -dedendum, dedendum, dedendum], color=SKY, alpha=0.6)
    blank = root - 12.0
    corners = [
        at(inner, top),
        at(outer, top),
        at(outer, blank),
        at(0, blank),
        at(0, blank + 5),
        at(inner, root),
    ]
    axes.fill(*np.transpose(corners), color=STEEL, alpha=0.9, zorder=0)
    axes.plot(
        *np.transpose([at(inner, top), at(outer, top), at(outer, root), at(inner, root), at(inner, top)]),
        color=INK,
    )
    axes.plot([-4, outer + 12], [0, 0], color=INK, linewidth=0.9, linestyle=(0, (9, 3, 2, 3)))
    axes.plot(
        *np.transpose([at(0, 22), at(0, blank - 10)]), color=INK, linewidth=0.9, linestyle=(0, (9, 3, 2, 3))
    )
    axes.text(outer + 14, 0, "$z_s$: pinion", va="center")
    _text(axes, at(0, 25), "$z_2$: face gear", ha="center", va="bottom")
    axes.plot([inner, outer], [-pitch, -pitch], color=GREY, linewidth=0.8, linestyle=(0, (6, 3)))
    label_line(axes, "section A\nundercut", at(inner, 0.5 * (top + root)), (-92, 26))
    label_line(axes, "section B\npointed", at(outer, 0.5 * (top + root)), (30, 4))
    for distance, level, name in ((inner, -8.0, "$R_1$"), (outer, -18.0, "$R_2$")):
        _dimension(axes, at(0, blank + level), at(distance, blank + level), name)
        axes.plot(
            *np.transpose([at(distance, blank), at(distance, blank + level)]), color=GREY, linewidth=0.6
        )
    _dimension(axes, (inner, tip + 8), (outer, tip + 8), "$L_2 - L_1$")
    return figure


@styled
def tregold_cones(drive: Drive) -> Figure:
    """Figure 3.14: pitch cones of the drive and the formative spur gears on their back cones, drawn to scale.

    Parameters
    ----------
    drive : Drive
    """
    figure, (axes,) = panels(1, 1, 4.4)
    _bare(axes)
    pinion, gear = drive.pitch_radius, drive.pitch_radius / drive.speed_ratio
    distance = float(np.hypot(pinion, gear)) if np.isclose(drive.shaft_angle, np.pi / 2) else None
    if distance is None:
        raise ValueError(
            f"shaft_angle must be 90° for this drawing, got {np.degrees(drive.shaft_angle):.6g}°"
        )
    contact = np.array([gear, -pinion]) * _MM
    cone_1 = np.arctan2(pinion, gear)
    virtual_1, virtual_2 = pinion / np.cos(cone_1) * _MM, gear / np.sin(cone_1) * _MM
    normal = np.array([np.sin(cone_1), np.cos(cone_1)])
    for end, colour in ((contact * [1, -1], BLUE), (contact * [-1, 1], GREEN)):
        axes.plot([0, end[0]], [0, end[1]], color=colour, linewidth=1.0)
    axes.plot([0, contact[0]], [0, contact[1]], color=INK, linewidth=1.4)
    axes.fill([0, contact[0], contact[0]], [0, contact[1], -contact[1]], color=BLUE, alpha=0.12)
    axes.fill([0, contact[0], -contact[0]], [0, contact[1], contact[1]], color=GREEN, alpha=0.12)
    top, bottom = contact + virtual_1 * normal, contact - virtual_2 * normal
    axes.plot([top[0], contact[0]], [top[1], contact[1]], color=BLUE, linewidth=2.0)
    axes.plot([bottom[0], contact[0]], [bottom[1], contact[1]], color=GREEN, linewidth=2.0)
    for centre, radius, colour in ((top, virtual_1, BLUE), (bottom, virtual_2, GREEN)):
        toward = np.arctan2(contact[1] - centre[1], contact[0] - centre[0])
        width = 0.5 if radius == virtual_1 else 0.09
        angle = np.linspace(toward - width, toward + width, 200)
        axes.plot(
            centre[0] + radius * np.cos(angle),
            centre[1] + radius * np.sin(angle),
            color=colour,
            linestyle="--",
        )
        axes.plot(*centre, "o", color=colour)
    axes.plot([0, 1.25 * contact[0]], [0, 0], color=FAINT, linewidth=1.0, linestyle=(0, (9, 3, 2, 3)))
    axes.plot(
        [0, 0], [0.25 * contact[0], bottom[1] * 1.02], color=FAINT, linewidth=1.0, linestyle=(0, (9, 3, 2, 3))
    )
    axes.plot(*contact, "o", color=VERMILION)
    label_line(axes, "pitch point", tuple(contact), (-70, -28))
    label_line(axes, "formative pinion\n$r_p/\\cos\\gamma_1$", tuple(0.5 * (top + contact)), (24, 12))
    label_line(
        axes,
        "formative gear\n$N_2 m_d/(2\\cos\\gamma_2)$",
        tuple(contact - 0.1 * virtual_2 * normal),
        (24, -10),
    )
    for radius, low, high, name in (
        (0.7 * contact[0], -np.degrees(cone_1), 0.0, r"$\gamma_1$"),
        (0.3 * contact[0], -90.0, -np.degrees(cone_1), r"$\gamma_2$"),
    ):
        axes.add_patch(Arc((0, 0), 2 * radius, 2 * radius, theta1=low, theta2=high, color=INK))
        middle = np.radians(0.5 * (low + high))
        place = {"ha": "center", "va": "center"}
        _text(axes, 1.07 * radius * np.array([np.cos(middle), np.sin(middle)]), name, **place)
    axes.text(0, 0, "apex ", ha="right", va="bottom")
    # The formative gear's centre lies five pitch radii below: what is near the pitch point is what matters.
    axes.set_xlim(-0.3 * contact[0], 1.75 * contact[0])
    axes.set_ylim(-0.8 * contact[0], 0.42 * contact[0])
    return figure
