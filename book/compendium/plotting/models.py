"""Drawings of the mechanical models of chapters 4 to 8: what moves, what holds it, and where it is pressed."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Rectangle

from compendium.plotting.parts import Point, arrow, bare, block, damper, held, line, note, spring, turn
from facegear.plotting.style import BLUE, FAINT, GREEN, GREY, INK, STEEL, VERMILION, panels, styled


def _disk_from_the_side(axes: Axes, height: float, text: str = "") -> None:
    """Draw a disk from −2 to 2 on its shaft."""
    axes.add_patch(
        Rectangle((-2.0, height - 0.09), 4.0, 0.18, facecolor=STEEL, edgecolor=INK, linewidth=1.2, zorder=2)
    )
    axes.add_patch(
        Rectangle((-0.22, height - 0.34), 0.44, 0.68, facecolor=FAINT, edgecolor=INK, linewidth=1.2, zorder=3)
    )
    if text:
        note(axes, (-1.15, height - 0.32), text)


def _held_pinion(axes: Axes, x: float, height: float, side: float = 1.0, text: str = "$m_p$") -> None:
    """Draw a pinion as a block at a height above its contact, with spring and damper to the ground."""
    middle = height + side * 0.27
    block(axes, (x, middle), 0.7, 0.36, text)
    top, ground = middle + side * 0.18, middle + side * 0.95
    spring(axes, (x - 0.2, top), (x - 0.2, ground))
    damper(axes, (x + 0.2, top), (x + 0.2, ground))
    held(axes, (x - 0.45, ground), (x + 0.45, ground), side)


@styled
def disk_and_pinion() -> Figure:
    """Draw the model of section 4.1: a disk clamped at the bore, a pinion on its bearing at a contact that moves."""
    figure, (left, right) = panels(1, 2, 3.0)
    bare(left, (-2.6, 2.6), (-1.3, 2.0))
    _disk_from_the_side(left, 0.0, "disk")
    _held_pinion(left, 1.45, 0.09)
    note(left, (0.98, 0.98), "$k_b$", ha="right")
    note(left, (1.95, 0.98), "$c_b$", ha="left")
    line(left, (0.0, -1.1), (0.0, 1.7), color=GREY, linewidth=0.9, linestyle=(0, (8, 3, 2, 3)))
    turn(left, (0.0, -0.85), 0.3, (200.0, 340.0))
    note(left, (0.42, -0.85), r"$\Omega_2$", ha="left")
    arrow(left, (-1.75, 0.14), (-1.75, 0.75), color=BLUE)
    note(left, (-1.62, 0.6), "$w$", ha="left", color=BLUE)
    arrow(left, (1.45, -0.35), (1.05, -0.35), color=VERMILION)
    note(left, (1.5, -0.42), "contact at $r_c(t)$", ha="center", va="top", color=VERMILION)
    bare(right, (-2.4, 2.4), (-2.2, 2.2))
    right.add_patch(Circle((0.0, 0.0), 2.0, facecolor=STEEL, edgecolor=INK, linewidth=1.2))
    right.add_patch(Circle((0.0, 0.0), 1.62, facecolor="none", edgecolor=GREY, linewidth=0.8, linestyle="--"))
    right.add_patch(Circle((0.0, 0.0), 0.43, facecolor="white", edgecolor=INK, linewidth=1.2))
    for angle in np.radians(np.arange(0.0, 360.0, 30.0)):
        spoke = np.array([np.cos(angle), np.sin(angle)])
        line(right, tuple(0.33 * spoke), tuple(0.43 * spoke), linewidth=0.8, color=GREY)
    angle = np.radians(28.0)
    at = (1.8 * np.cos(angle), 1.8 * np.sin(angle))
    line(right, (0.0, 0.0), (2.0, 0.0), linewidth=0.8, color=GREY)
    line(right, (0.0, 0.0), at, linewidth=1.0)
    right.plot(*at, marker="o", color=VERMILION, markersize=7, zorder=5)
    turn(right, (0.0, 0.0), 0.95, (0.0, 28.0), linewidth=0.9)
    note(right, (1.25, 0.27), r"$\theta_c$")
    note(right, (0.75, 0.62), "$r_c$")
    note(right, (0.0, -0.62), "$b$, clamped")
    note(right, (0.0, -1.3), "$a = R_2$, free")
    turn(right, (0.0, 0.0), 1.2, (110.0, 190.0))
    note(right, (-1.35, 0.75), r"$\Omega_2$")
    return figure


@styled
def position_and_phase(pitches: int = 24) -> Figure:
    """Draw the angles of section 5.2: whole teeth turn the second contact, the rest shifts it in time.

    Parameters
    ----------
    pitches : int
        Teeth of the gear as drawn.
    """
    figure, (axes,) = panels(1, 1, 2.9)
    bare(axes, (-4.3, 5.2), (-0.35, 2.75))
    pitch = 360.0 / pitches
    whole, rest = 6 * pitch, 0.4 * pitch
    angle = np.radians(np.linspace(-4.0, 184.0, 300))
    for radius in (1.5, 2.0):
        axes.plot(radius * np.cos(angle), radius * np.sin(angle), color=INK, linewidth=1.2)
    for tooth in np.radians(np.arange(0.0, 181.0, pitch)):
        ends = [(r * np.cos(tooth), r * np.sin(tooth)) for r in (1.5, 2.0)]
        line(axes, *ends, color=GREY, linewidth=0.9)

    def ray(degrees: float, reach: float, **options: Any) -> Point:
        end = (reach * np.cos(np.radians(degrees)), reach * np.sin(np.radians(degrees)))
        line(axes, (0.0, 0.0), end, **({"linewidth": 0.9} | options))
        return end

    for degrees, name in ((0.0, "pinion 1"), (whole + rest, "pinion 2")):
        end = ray(degrees, 2.25)
        axes.plot(
            1.75 * np.cos(np.radians(degrees)),
            1.75 * np.sin(np.radians(degrees)),
            marker="o",
            color=VERMILION,
            markersize=8,
        )
        note(axes, (end[0] * 1.05, end[1] * 1.07), name, ha="left" if degrees < 45 else "right")
    ray(whole, 2.25, linestyle="--", color=GREY)
    turn(axes, (0.0, 0.0), 0.8, (0.0, whole), color=BLUE)
    note(axes, (0.72, 0.62), r"$\theta_q$", ha="left", color=BLUE)
    turn(axes, (0.0, 0.0), 1.25, (whole - 22.0, whole), color=GREEN)
    turn(axes, (0.0, 0.0), 1.25, (whole + rest + 22.0, whole + rest), color=GREEN)
    note(axes, (-0.5, 0.95), r"$\theta_p$", ha="right", color=GREEN)
    note(axes, (2.4, 2.2), r"$\theta_c = \theta_q + \theta_p$", ha="left")
    note(axes, (2.4, 1.72), r"$\theta_q$: whole pitches", ha="left", color=BLUE)
    note(axes, (2.4, 1.24), r"$\theta_p = \psi\,\theta_N$: phase", ha="left", color=GREEN)
    turn(axes, (0.0, 0.0), 0.42, (0.0, whole + rest))
    note(axes, (-0.12, 0.2), r"$\theta_c$", ha="right")
    first, second = (np.radians(150.0), np.radians(150.0 + pitch))
    for tooth in (first, second):
        line(
            axes,
            (2.05 * np.cos(tooth), 2.05 * np.sin(tooth)),
            (2.3 * np.cos(tooth), 2.3 * np.sin(tooth)),
            linewidth=0.9,
        )
    middle = 0.5 * (first + second)
    note(axes, (2.4 * np.cos(middle), 2.4 * np.sin(middle)), r"$\theta_N = 2\pi/N_2$", ha="right")
    return figure


@styled
def edge_load() -> Figure:
    """Draw the driving force of section 6.1: on the rim, in the plane of the disk, and on a bent rim."""
    figure, (left, right) = panels(1, 2, 2.9)
    bare(left, (-2.6, 2.6), (-2.2, 2.4))
    left.add_patch(Circle((0.0, 0.0), 2.0, facecolor=STEEL, edgecolor=INK, linewidth=1.2))
    left.add_patch(Circle((0.0, 0.0), 0.43, facecolor="white", edgecolor=INK, linewidth=1.2))
    for angle in np.radians(np.arange(0.0, 360.0, 30.0)):
        spoke = np.array([np.cos(angle), np.sin(angle)])
        line(left, tuple(0.33 * spoke), tuple(0.43 * spoke), linewidth=0.8, color=GREY)
    at = np.radians(50.0)
    place = np.array([np.cos(at), np.sin(at)])
    along = np.array([-np.sin(at), np.cos(at)])
    line(left, (0.0, 0.0), tuple(2.0 * place), linewidth=0.9, color=GREY)
    arrow(
        left,
        tuple(2.0 * place - 1.0 * along),
        tuple(2.0 * place - 0.06 * along),
        color=VERMILION,
        linewidth=2.0,
        mutation_scale=15,
    )
    note(left, (1.8, 1.36), "$F_t$", ha="left", color=VERMILION)
    note(left, (0.45, 0.95), "$a$")
    turn(left, (0.0, 0.0), 1.25, (110.0, 190.0))
    note(left, (-0.75, 0.55), r"$\Omega_2$")
    for direction, name in ((place, r"$\sigma_r$"), (along, r"$\sigma_\theta$")):
        centre = np.array([-0.85, -1.0])
        arrow(left, tuple(centre), tuple(centre + 0.5 * direction), linewidth=0.9, mutation_scale=8)
        arrow(left, tuple(centre), tuple(centre - 0.5 * direction), linewidth=0.9, mutation_scale=8)
        note(left, tuple(centre + 0.68 * direction), name)
    bare(right, (-0.3, 5.0), (-1.6, 2.9))
    x = np.linspace(0.0, 4.4, 100)
    bend = 0.55 * np.sin(0.75 * x - 0.7) + 0.4
    slope = np.arctan(0.55 * 0.75 * np.cos(0.75 * 2.2 - 0.7))
    right.plot(x, bend, color=INK, linewidth=6.0, solid_capstyle="butt")
    right.plot(x, bend, color=STEEL, linewidth=3.8, solid_capstyle="butt")
    line(right, (0.0, -0.7), (4.4, -0.7), color=GREY, linewidth=0.9, linestyle="--")
    note(right, (4.4, -0.95), "rim at rest, unrolled", ha="right", va="top", color=GREY)
    foot = np.array([2.2, 0.55 * np.sin(0.75 * 2.2 - 0.7) + 0.4])
    for tilt, colour, name, shift in ((0.0, BLUE, "dead", -0.5), (slope, VERMILION, "follower", 0.2)):
        end = foot + 1.5 * np.array([np.cos(tilt), np.sin(tilt)])
        arrow(right, tuple(foot), tuple(end), color=colour, linewidth=2.0, mutation_scale=15, zorder=5)
        note(right, (float(end[0]) + 0.1, float(end[1]) + shift), name, ha="left", color=colour)
    note(right, (0.0, 2.3), "force on a bent rim", ha="left")
    return figure


@styled
def torsional_chain() -> Figure:
    """Draw the model of section 7.7: input, pinion, mesh, face gear, load."""
    figure, (axes,) = panels(1, 1, 2.3)
    bare(axes, (-0.9, 11.6), (-1.55, 1.75))

    def shaft(start: float, end: float, stiffness: str, damping: str) -> None:
        spring(axes, (start, 0.26), (end, 0.26))
        damper(axes, (start, -0.26), (end, -0.26))
        note(axes, ((start + end) / 2, 0.62), stiffness)
        note(axes, ((start + end) / 2, -0.62), damping)

    held(axes, (0.0, -0.6), (0.0, 0.6), 1.0)
    shaft(0.0, 1.8, "$k_1$", "$c_1$")
    block(axes, (2.25, 0.0), 0.9, 1.3, "$J_1$")
    shaft(2.7, 4.9, "$k_m$", "$c_m$")
    block(axes, (5.45, 0.0), 1.1, 2.2, "$J_2$", STEEL)
    shaft(6.0, 7.9, "$k_2$", "$c_2$")
    block(axes, (8.45, 0.0), 1.1, 2.2, "$J_o$", FAINT)
    for x, name in ((-0.1, "input"), (2.25, "pinion"), (3.8, "teeth"), (5.45, "face gear"), (8.45, "load")):
        note(axes, (x, -1.38), name)
    for x, name, top in ((2.25, r"$\chi_1$", 0.95), (5.45, r"$\chi_2$", 1.4), (8.45, r"$\chi_o$", 1.4)):
        arrow(axes, (x - 0.4, top), (x + 0.4, top), color=BLUE)
        note(axes, (x + 0.55, top), name, ha="left", color=BLUE)
    arrow(axes, (10.3, 0.0), (9.1, 0.0), color=VERMILION, linewidth=1.6)
    note(axes, (10.4, 0.0), "$T_o$", ha="left", color=VERMILION)
    return figure


def _tooth_spring(axes: Axes, x: float, disk: float, side: float, ground: bool = True) -> float:
    """Draw teeth as a spring and damper from a disk to a pinion; return the height of the pinion's middle."""
    start, end = disk + side * 0.09, disk + side * 0.85
    spring(axes, (x - 0.2, start), (x - 0.2, end), 0.1)
    damper(axes, (x + 0.2, start), (x + 0.2, end), 0.09)
    axes.plot(
        [x - 0.2, x + 0.2], [start, start], linestyle="none", marker="o", markersize=3.5, color=VERMILION
    )
    if ground:
        _held_pinion(axes, x, end - side * 0.09, side)
    return end


@styled
def flexible_teeth() -> Figure:
    """Draw the models of section 8.2 for the disk: teeth as springs, both faces, two gears on the same pinions."""
    figure, drawings = panels(1, 3, 3.4)
    for axes, title in zip(drawings, ("teeth as springs", "on both faces", "two gears"), strict=True):
        bare(axes, (-2.5, 2.7), (-2.6, 2.9))
        axes.set_title(title, fontsize=10)
    one, both, two = drawings
    _disk_from_the_side(one, -0.6)
    _tooth_spring(one, 1.4, -0.6, 1.0)
    note(one, (0.95, -0.1), "$k_z$", ha="right")
    note(one, (1.85, -0.1), "$c_z$", ha="left")
    note(one, (0.95, 1.12), "$k_b$", ha="right")
    note(one, (1.85, 1.12), "$c_b$", ha="left")
    arrow(one, (-1.7, -0.45), (-1.7, 0.2), color=BLUE)
    note(one, (-1.55, 0.1), "$w$", ha="left", color=BLUE)
    arrow(one, (0.55, 0.2), (0.55, 0.75), color=BLUE)
    note(one, (0.42, 0.55), "$w_m$", ha="right", color=BLUE)
    _disk_from_the_side(both, 0.1)
    _tooth_spring(both, 1.4, 0.1, 1.0)
    _tooth_spring(both, -1.4, 0.1, -1.0)
    note(both, (0.0, 1.6), "front", color=GREY)
    note(both, (0.0, -1.4), "back", color=GREY)
    for height, name in ((1.35, "gear 1"), (-1.35, "gear 2")):
        _disk_from_the_side(two, height)
        note(two, (0.0, height + (0.6 if height > 0 else -0.6)), name)
    for x, name in ((-1.4, "input"), (1.4, "idler")):
        block(two, (x, 0.0), 0.8, 0.4, "$m_p$")
        for side in (1.0, -1.0):
            start, end = side * 0.2, side * (1.35 - 0.09)
            spring(two, (x - 0.2, start), (x - 0.2, end), 0.1)
            damper(two, (x + 0.2, start), (x + 0.2, end), 0.09)
        note(two, (x, -2.2), name, color=GREY)
    return figure


@styled
def backlash() -> Figure:
    """Draw the contact law (8-1): flanks with play on either side, and the force over the deformation."""
    figure, (left, right) = panels(1, 2, 2.8)
    bare(left, (-2.7, 2.7), (-1.5, 1.9))
    block(left, (0.0, 0.0), 0.8, 0.8, "tooth", STEEL)
    for side, name in ((1.0, "forward"), (-1.0, "backward")):
        line(left, (side * 0.8, -0.5), (side * 0.8, 0.5), linewidth=1.5)
        spring(left, (side * 0.8, 0.22), (side * 2.2, 0.22), 0.12)
        damper(left, (side * 0.8, -0.22), (side * 2.2, -0.22), 0.11)
        held(left, (side * 2.2, -0.6), (side * 2.2, 0.6), -side)
        arrow(left, (side * 0.4, -0.75), (side * 0.8, -0.75), arrowstyle="<|-|>", mutation_scale=8)
        note(left, (side * 0.6, -1.0), "$b$")
        note(left, (side * 1.5, 0.62), "$k_m$")
        note(left, (side * 1.5, -0.62), "$c_m$")
        note(left, (side * 1.5, 1.3), name, color=GREY)
    arrow(left, (-0.35, 0.75), (0.35, 0.75), color=BLUE)
    note(left, (0.0, 1.02), "$g$", color=BLUE)
    bare(right, (-2.4, 2.6), (-1.8, 1.9))
    arrow(right, (-2.2, 0.0), (2.3, 0.0), linewidth=0.9)
    arrow(right, (0.0, -1.6), (0.0, 1.6), linewidth=0.9)
    line(right, (-2.0, -1.3), (-0.7, 0.0), (0.7, 0.0), (2.0, 1.3), color=VERMILION, linewidth=2.2)
    note(right, (2.35, -0.2), "$g$", ha="left")
    note(right, (-0.15, 1.6), "$k_m G$", ha="right")
    note(right, (0.7, -0.28), "$b$")
    note(right, (-0.75, 0.28), "$-b$")
    return figure
