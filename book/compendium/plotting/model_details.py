"""Drawings of what chapters 2, 3, 4 and 8 add to the models: periodic springs, pressed slices, sizes, heavy shafts."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon, Rectangle

from compendium.plotting.parts import Point, arrow, bare, block, damper, held, line, note, spring, turn
from facegear.plotting.style import BLUE, FAINT, GREEN, GREY, INK, SKY, STEEL, VERMILION, panels, styled


def _measure(axes: Axes, start: Point, end: Point, text: str, shift: Point = (0.0, 0.0)) -> None:
    """Draw a dimension with its name beside the middle."""
    arrow(axes, start, end, arrowstyle="<|-|>", mutation_scale=8, linewidth=0.9)
    note(axes, ((start[0] + end[0]) / 2 + shift[0], (start[1] + end[1]) / 2 + shift[1]), text)


def _time_axis(axes: Axes, start: Point, length: float, height: float, text: str) -> None:
    """Draw the two axes of something over time."""
    arrow(axes, start, (start[0] + length, start[1]), linewidth=0.9)
    arrow(axes, start, (start[0], start[1] + height), linewidth=0.9)
    note(axes, (start[0] + length + 0.1, start[1]), "$t$", ha="left")
    note(axes, (start[0] - 0.1, start[1] + height), text, ha="right")


@styled
def periodic_spring() -> Figure:
    """Draw the oscillator of chapter 2 and how its stiffness varies: Mathieu's cosine and Meissner's square wave."""
    figure, (left, right) = panels(1, 2, 2.6, width_ratios=(1.0, 1.35))
    bare(left, (-2.1, 1.9), (-1.45, 1.65))
    held(left, (-1.9, -0.8), (-1.9, 0.8), 1.0)
    spring(left, (-1.9, 0.35), (0.2, 0.35))
    arrow(left, (-1.35, 0.0), (-0.4, 0.75), color=VERMILION)
    note(left, (-0.9, 1.1), r"$\omega_0^2\,(1 + \varepsilon\cos\omega t)$", color=VERMILION)
    damper(left, (-1.9, -0.4), (0.2, -0.4))
    note(left, (-0.9, -0.85), r"$2\vartheta\omega_0$")
    block(left, (0.65, 0.0), 0.9, 1.3, "mass 1")
    arrow(left, (0.65, -0.95), (1.45, -0.95), color=BLUE)
    note(left, (1.65, -0.95), "$q$", color=BLUE)
    bare(right, (-1.7, 6.3), (-0.9, 2.6))
    _time_axis(right, (0.0, 0.0), 5.2, 2.3, "stiffness")
    levels = {
        r"$\omega_0^2\,(1 + \varepsilon)$": 1.7,
        r"$\omega_0^2$": 1.1,
        r"$\omega_0^2\,(1 - \varepsilon)$": 0.5,
    }
    for name, height in levels.items():
        line(right, (0.0, height), (4.8, height), color=GREY, linewidth=0.6, linestyle="--")
        note(right, (-0.12, height), name, ha="right")
    time = np.linspace(0.0, 4.8, 200)
    right.plot(time, 1.1 + 0.6 * np.cos(2.0 * np.pi * time / 2.4), color=VERMILION)
    jumps = np.array([0.0, 1.2, 1.2, 2.4, 2.4, 3.6, 3.6, 4.8])
    right.plot(jumps, 1.1 + 0.6 * np.array([1, 1, -1, -1] * 2), color=BLUE, linewidth=1.2)
    note(right, (4.95, 1.7), "Mathieu", ha="left", color=VERMILION)
    note(right, (4.95, 0.5), "Meissner", ha="left", color=BLUE)
    _measure(right, (0.0, -0.3), (2.4, -0.3), "$T_0 = 2\\pi/\\omega$", (0.0, -0.33))
    return figure


@styled
def pair_of_gears(contact_ratio: float = 1.5, droop: float = 0.4) -> Figure:
    """Draw the pair of gears of chapter 2, and the weights of its tooth pairs over time.

    Parameters
    ----------
    contact_ratio : float
        Mesh periods that a pair stays in mesh, from 1 to 2.
    droop : float
        Part of its stiffness that a pair lacks at either end.
    """
    figure, (left, right) = panels(1, 2, 2.6, width_ratios=(1.2, 1.0))
    bare(left, (-0.5, 7.6), (-1.7, 1.8))
    held(left, (0.0, -0.6), (0.0, 0.6), 1.0)
    for start, end, stiffness, damping in (
        (0.0, 1.5, "$k_1$", "$c_1$"),
        (2.4, 4.6, "$w(t)\\,k$", "$w(t)\\,c$"),
        (5.5, 7.0, "$k_2$", "$c_2$"),
    ):
        spring(left, (start, 0.26), (end, 0.26))
        damper(left, (start, -0.26), (end, -0.26))
        colour = VERMILION if "w" in stiffness else INK
        note(left, ((start + end) / 2, 0.68), stiffness, color=colour)
        note(left, ((start + end) / 2, -0.68), damping, color=colour)
    held(left, (7.0, -0.6), (7.0, 0.6), -1.0)
    block(left, (1.95, 0.0), 0.9, 1.4, "$m_1$")
    block(left, (5.05, 0.0), 0.9, 1.4, "$m_2$", STEEL)
    for x, name in ((1.95, "$q_1$"), (5.05, "$q_2$")):
        arrow(left, (x - 0.4, 1.0), (x + 0.4, 1.0), color=BLUE)
        note(left, (x, 1.35), name, color=BLUE)
    note(left, (3.5, -1.4), "teeth", color=GREY)
    bare(right, (-0.75, 4.6), (-1.0, 2.8))
    _time_axis(right, (0.0, 0.0), 3.9, 2.4, "$w$")
    period = 1.5
    for pair, colour in enumerate((GREEN, BLUE, GREEN)):
        time = np.linspace(0.0, contact_ratio, 60)
        weight = 1.0 - droop * (2.0 * time / contact_ratio - 1.0) ** 2
        start = (pair - 0.6) * period
        shown = (start + period * time >= 0.0) & (start + period * time <= 3.7)
        right.plot(start + period * time[shown], weight[shown], color=colour, linewidth=1.2)
        for end in (0.0, contact_ratio):
            at = start + period * end
            if 0.0 < at < 3.7:
                line(right, (at, 0.0), (at, 1.0 - droop), color=colour, linewidth=0.8, linestyle=":")
    time = np.linspace(0.0, 3.7, 600)
    total = np.zeros_like(time)
    for pair in range(-1, 4):
        s = (time / period - (pair - 0.6)) / contact_ratio
        total += np.where((s >= 0.0) & (s <= 1.0), 1.0 - droop * (2.0 * s - 1.0) ** 2, 0.0)
    right.plot(time, total, color=VERMILION, linewidth=2.0)
    note(right, (3.5, 2.3), "all pairs", color=VERMILION)
    _measure(right, (0.6, -0.28), (0.6 + period * contact_ratio, -0.28), r"$c_r T_0$", (0.0, -0.34))
    _measure(right, (0.6, 1.85), (2.1, 1.85), "$T_0$", (0.0, 0.28))
    return figure


@styled
def pressed_slices() -> Figure:
    """Draw what a torque makes of contact at a point: slices within reach of the approach, from one to all."""
    figure, drawings = panels(1, 3, 3.1)
    along = np.linspace(-1.0, 1.0, 201)
    for axes, title, reach in zip(
        drawings, ("no load", "some load", "more load"), (0.0, 0.42, 0.9), strict=True
    ):
        bare(axes, (-1.5, 1.5), (-2.25, 1.3))
        axes.set_title(title, fontsize=10)
        approach = 0.35 * reach**2
        pinion = 0.32 + 0.35 * (along - 0.15) ** 2 - approach
        axes.add_patch(Rectangle((-1.0, -0.3), 2.0, 0.3, facecolor=STEEL, edgecolor=INK, linewidth=1.2))
        axes.fill_between(along, pinion, 1.2, color=SKY, linewidth=0)
        axes.plot(along, pinion, color=INK, linewidth=1.2)
        for place in np.linspace(-0.9, 0.9, 13):
            pressed = abs(place - 0.15) <= max(reach, 0.01)
            top = min(0.32, 0.32 + 0.35 * (place - 0.15) ** 2 - approach)
            colour, width = (VERMILION, 2.4) if pressed else (GREY, 0.9)
            axes.plot([place, place], [0.0, top], color=colour, linewidth=width)
        corners = [(-1.0, -2.0), (1.0, -2.0), (0.95, -1.0), (-0.95, -1.0)]
        axes.add_patch(Polygon(corners, facecolor=STEEL, edgecolor=INK, linewidth=1.2))
        line(axes, (-0.97, -1.74), (0.97, -1.29), linewidth=0.8)
        ends = [max(-0.97, 0.15 - reach), min(0.97, 0.15 + reach)]
        heights = [-1.515 + 0.232 * end for end in ends]
        line(axes, *zip(ends, heights, strict=True), color=VERMILION, linewidth=4.0)
        axes.plot(0.15, -1.48, marker="o", markersize=5, color=VERMILION)
    note(drawings[0], (0.0, 0.9), "pinion")
    note(drawings[0], (0.0, -0.15), "face gear")
    note(drawings[0], (0.0, -2.1), "flank of the face gear", va="top")
    _measure(drawings[0], (-1.08, 0.32), (-1.08, 0.32 + 0.35 * 1.15**2), r"$\eta$", (-0.18, 0.0))
    line(drawings[2], (0.1, 0.32), (1.3, 0.32), color=GREY, linewidth=0.6, linestyle="--")
    line(
        drawings[2],
        (0.1, 0.32 - 0.35 * 0.81),
        (1.3, 0.32 - 0.35 * 0.81),
        color=GREY,
        linewidth=0.6,
        linestyle="--",
    )
    _measure(drawings[2], (1.2, 0.32 - 0.35 * 0.81), (1.2, 0.32), r"$\delta$", (0.18, 0.0))
    return figure


@styled
def body_dimensions() -> Figure:
    """Draw what the design of section 4.7 chooses: the body of the face gear, and a tooth as a cantilever."""
    figure, (left, right) = panels(1, 2, 3.0, width_ratios=(1.5, 1.0))
    bare(left, (-0.7, 6.6), (-1.75, 2.2))
    axis = (0, (8, 3, 2, 3))
    line(left, (0.0, -1.6), (0.0, 2.1), color=GREY, linewidth=0.9, linestyle=axis)
    body = [(0.9, 0.0), (5.2, 0.0), (5.2, 0.45), (0.9, 0.45)]
    left.add_patch(Polygon(body, facecolor=STEEL, edgecolor=INK, linewidth=1.2))
    held(left, (0.9, -0.25), (0.9, 0.7), 1.0)
    left.add_patch(Rectangle((4.1, 0.45), 1.1, 0.35, facecolor=FAINT, edgecolor=INK, linewidth=1.2))
    left.add_patch(Rectangle((4.1, 0.72), 1.3, 0.75, facecolor=SKY, alpha=0.5, edgecolor=INK, linewidth=0.9))
    line(left, (3.8, 1.25), (6.3, 1.25), color=GREY, linewidth=0.9, linestyle=axis)
    note(left, (6.3, 1.5), "pinion", ha="right")
    note(left, (2.4, 0.22), "body")
    note(left, (3.95, 0.64), "teeth", ha="right")
    _measure(left, (5.75, 0.0), (5.75, 0.45), "$h$", (0.25, 0.0))
    for height in (0.0, 0.45):
        line(left, (5.25, height), (5.9, height), color=GREY, linewidth=0.6)
    for reach, height, name in ((0.9, -0.35, "$b$"), (4.1, -0.8, "$R_1$"), (5.2, -1.25, "$a = R_2$")):
        _measure(left, (0.0, height), (reach, height), name, (0.0, -0.22))
        line(left, (reach, -0.05), (reach, height - 0.1), color=GREY, linewidth=0.6)
    _measure(left, (4.1, 1.75), (5.2, 1.75), "$L$", (0.0, 0.24))
    bare(right, (-2.0, 2.2), (-0.95, 2.0))
    held(right, (-1.3, 0.0), (1.3, 0.0), -1.0)
    tooth = [(-0.75, 0.0), (-0.62, 0.7), (-0.28, 1.6), (0.28, 1.6), (0.62, 0.7), (0.75, 0.0)]
    right.add_patch(Polygon(tooth, facecolor=SKY, edgecolor=INK, linewidth=1.2))
    line(right, (-1.4, 0.9), (1.9, 0.9), color=GREY, linewidth=0.8, linestyle=axis)
    note(right, (1.0, 1.1), "pitch circle", ha="left", color=GREY, fontsize=9)
    arrow(right, (-1.5, 0.9), (-0.56, 0.9), color=VERMILION, linewidth=2.0, mutation_scale=14)
    note(right, (-1.4, 1.2), "$F_t$", color=VERMILION)
    _measure(right, (1.1, 0.0), (1.1, 0.9), "$H$", (0.28, 0.0))
    _measure(right, (-0.75, -0.4), (0.75, -0.4), "$W$", (0.0, -0.26))
    return figure


@styled
def heavy_shafts() -> Figure:
    """Draw the chain of chapter 7 with rods in place of springs, and what the twist of a rod is written as."""
    figure, (above, below) = panels(2, 1, 3.6, height_ratios=(1.25, 1.0))
    bare(above, (-0.6, 11.6), (-1.75, 1.6))
    held(above, (0.0, -0.7), (0.0, 0.7), 1.0)
    for start, end, name, size in ((0.0, 2.1, "$l_1,\\ I_1$", 0.36), (6.4, 9.2, "$l_2,\\ I_2$", 0.5)):
        block(above, ((start + end) / 2, 0.0), end - start, size, "", FAINT)
        note(above, ((start + end) / 2, 0.62), name)
    block(above, (2.5, 0.0), 0.8, 1.2, "$J_1$")
    spring(above, (2.9, 0.26), (5.3, 0.26))
    damper(above, (2.9, -0.26), (5.3, -0.26))
    note(above, (4.1, 0.65), "$k_m$")
    note(above, (4.1, -0.65), "$c_m$")
    block(above, (5.85, 0.0), 1.1, 2.0, "$J_2$", STEEL)
    block(above, (9.75, 0.0), 1.1, 2.0, "$J_o$", FAINT)
    for x, name in (
        (1.05, "input shaft"),
        (2.5, "pinion"),
        (4.1, "teeth"),
        (5.85, "face gear"),
        (7.8, "output shaft"),
        (9.75, "load"),
    ):
        note(above, (x, -1.35), name, fontsize=10)
    arrow(above, (11.3, 0.0), (10.4, 0.0), color=VERMILION, linewidth=1.6)
    note(above, (11.35, 0.32), "$T_o$", color=VERMILION)
    bare(below, (-0.6, 11.6), (-1.35, 1.75))
    along = np.linspace(0.0, 1.0, 80)
    shapes = (
        (0.2, "between the ends", 0.3 + 0.8 * along, INK),
        (4.3, "$j = 1$", np.sin(np.pi * along), BLUE),
        (8.4, "$j = 2$", np.sin(2.0 * np.pi * along), GREEN),
    )
    for start, name, shape, colour in shapes:
        block(below, (start + 1.3, -0.0), 2.6, 0.16, "", FAINT)
        below.plot(start + 2.6 * along, shape, color=colour, linewidth=1.6, zorder=4)
        note(below, (start + 1.3, -1.2), name)
    for x, height, name, side in ((0.2, 0.3, r"$\chi_a$", "right"), (2.8, 1.1, r"$\chi_b$", "left")):
        line(below, (x, 0.0), (x, height), linewidth=0.9, color=GREY)
        note(below, (x + (0.12 if side == "left" else -0.12), height), name, ha=side)
    for x in (3.5, 7.6):
        note(below, (x, 0.0), "+", fontsize=14)
    return figure


@styled
def weak_tooth(teeth: int = 30) -> Figure:
    """Draw a face gear with one damaged tooth, and the stiffness of its mesh over a revolution.

    Parameters
    ----------
    teeth : int
        Teeth of the gear as drawn.
    """
    figure, (left, right) = panels(1, 2, 2.9, width_ratios=(1.0, 1.7))
    bare(left, (-2.5, 2.5), (-2.3, 2.7))
    pitch = 2.0 * np.pi / teeth
    turn(left, (0.0, 0.0), 0.85, (20.0, 110.0))
    note(left, (0.0, 0.35), r"$\Omega_2$")
    for tooth in range(teeth):
        middle = np.pi / 2 - pitch * tooth
        angles = middle + pitch * np.array([-0.28, 0.28, 0.28, -0.28])
        radii = np.array([1.45, 1.45, 1.95, 1.95])
        corners = np.column_stack([radii * np.cos(angles), radii * np.sin(angles)])
        weak = tooth == 5
        colour = VERMILION if weak else STEEL
        left.add_patch(Polygon(corners, facecolor=colour, edgecolor=INK, linewidth=0.7))
        if weak:
            note(left, (2.15 * np.cos(middle), 2.15 * np.sin(middle)), "$j$", color=VERMILION)
    left.add_patch(Rectangle((-0.28, 1.35), 0.56, 1.05, facecolor=SKY, alpha=0.75, edgecolor=INK, zorder=4))
    note(left, (0.42, 2.4), "pinion", ha="left")
    note(left, (0.0, -1.15), "$N_2$ teeth")
    bare(right, (-1.0, 8.2), (-1.2, 3.4))
    _time_axis(right, (0.0, 0.0), 7.4, 2.5, "")
    note(right, (-0.3, 2.85), "stiffness of the mesh", ha="left")
    length, count, pair = 0.5, 14, 5
    time = np.linspace(0.0, count * length, 1401)[:-1]
    whole = np.where((time / length) % 1.0 < 0.55, 2.0, 1.0)
    lost = ((time / length >= pair) & (time / length < pair + 1.55)) * 0.45
    right.fill_between(time, whole - lost, whole, color=VERMILION, alpha=0.35, linewidth=0)
    right.plot(time, whole, color=GREY, linewidth=0.9, linestyle="--")
    right.plot(time, whole - lost, color=BLUE, linewidth=1.6)
    note(right, (pair * length + 0.4, 2.3), "pair $j$ is softer", ha="left", color=VERMILION)
    _measure(right, (0.0, -0.35), (count * length, -0.35), "one revolution, $N_2 T_0$", (0.0, -0.4))
    _measure(right, (5 * length, 0.3), (6 * length, 0.3), "$T_0$", (0.55, 0.0))
    return figure
