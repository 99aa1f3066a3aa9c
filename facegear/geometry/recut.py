"""What the shaper takes off a flank that it has generated before, or would generate later.

The condition of undercutting (3-8) asks whether a point of the flank is singular at the instant of its generation. It
does not ask whether the shaper, on its way in or out, has that point inside one of its teeth at another instant. Here
a point of the face gear is followed through the whole motion. With δ the rotation of the shaper since the point was
generated, the point stands at radius ρ, polar angle ψ (from −y, where the tooth space was at φs = 0) and position u in
the shaper's fixed axes, and the flank of the shaper stands on that circle at the polar angle c + δ + inv ρ, where
c = φs + θ0s and inv ρ = ϑ − atan ϑ with the roll angle ϑ of ρ. The point is inside the tooth where

    ψ − (c + δ + inv ρ) > 0

while ρ does not exceed the shaper's tip circle and u lies between the shaper's ends. That angle is largest at one of
three kinds of δ: where ρ = r_as (the edge of the tip passes), where u is at an end of the shaper (with ρ = r_as: its
tip corner), or where the equation of meshing (3-7) holds once more, u cos(ψ + atan ϑ) = r_bs cot γs, which is where
the angle is stationary. Only these are looked at.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import root as solve

from facegear.support.types import FloatArray
from facegear.symbolic import twins

# Rotations since generation between which roots are looked for. None of them is 0, where every point touches.
_TURNS = np.linspace(-1.5, 1.5, 288)
# Steps of Newton's rule from a neighbour, and how far one may go [rad].
_NEWTON, _STRIDE = 8, 0.05
# A touch but for rounding [rad].
_TOUCH = 1e-14
# Kinds of places where a point may lie deepest in a tooth of the shaper: its tip, its ends, its flank.
_KINDS = (0, 1, 2, 3)
_TIP, _ENDS = 0, (1, 2)
# What is said of a point that the shaper never has within its tip circle and its length but where it generates it.
_FAR = -1.0


def _between(
    zero: Callable[..., FloatArray],
    step: NDArray[np.int64],
    before: FloatArray,
    after: FloatArray,
    *more: FloatArray,
) -> FloatArray:
    """Roots between neighbours of `_TURNS`, to the last digit.

    The steps are so short that the secant settles at once; SciPy's bracketing search takes ten times as long.
    """
    x_1, x_2, y_1, y_2 = _TURNS[step], _TURNS[step + 1], before, after
    for _ in range(7):
        slope = np.where(y_2 == y_1, 1.0, y_2 - y_1)
        new = np.clip(x_2 - y_2 * (x_2 - x_1) / slope, _TURNS[step], _TURNS[step + 1])
        x_1, y_1, x_2, y_2 = x_2, y_2, new, zero(new, *more)
    return x_2


class Place(NamedTuple):
    """Place of points in the shaper's fixed axes: radius [m], polar angle from −y, position u [m], roll angle."""

    radius: FloatArray
    angle: FloatArray
    u: FloatArray
    roll: FloatArray


@dataclass(frozen=True)
class Shaper:
    """A shaper of finite length in the motion that generates a face gear.

    Parameters
    ----------
    base_radius, tip_radius : float
        r_bs and r_as [m].
    pitch : float
        Angular pitch of its teeth 2π/Ns [rad].
    speed_ratio : float
        m_2s.
    shaft_angle : float
        γ [rad].
    ends : tuple of float
        Least and greatest u_s of its teeth [m].
    """

    base_radius: float
    tip_radius: float
    pitch: float
    speed_ratio: float
    shaft_angle: float
    ends: tuple[float, float]

    @cached_property
    def _cone_cotangent(self) -> float:
        return float(twins.pointing_cone_angle_cotangent(self.speed_ratio, self.shaft_angle))

    def _place(self, alpha: FloatArray, roll: FloatArray, turn: FloatArray) -> Place:
        """Where points of the flank are in the shaper's fixed axes, a rotation δ after they were generated."""
        fixed = (self.base_radius, self.speed_ratio, self.shaft_angle)
        x, y, u = twins.returned_point(alpha, roll, turn, *fixed)
        radius = np.hypot(x, y)
        there = np.sqrt(np.maximum((radius / self.base_radius) ** 2 - 1.0, 0.0))
        return Place(radius, np.arctan2(x, -y), u, there)

    def _zeros(self, place: Place, turn: FloatArray) -> tuple[FloatArray, ...]:
        """Four functions of δ that vanish where a point may lie deepest in the tooth.

        At the tip circle, at either end of the shaper, and where the equation of meshing holds; that one is divided
        by δ, which takes the instant of generation away.
        """
        meshing_again = place.u / self.base_radius * np.cos(place.angle + np.arctan(place.roll))
        return (
            place.radius / self.tip_radius - 1.0,
            (place.u - self.ends[0]) / self.tip_radius,
            (place.u - self.ends[1]) / self.tip_radius,
            (meshing_again - self._cone_cotangent) / turn,
        )

    def _candidates(self, alpha: FloatArray, roll: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Overlap at the deepest place of each of the four kinds, `_FAR` where there is none, and its δ.

        Shapes (4, points).
        """
        found, turns = np.full((len(_KINDS), alpha.size), _FAR), np.zeros((len(_KINDS), alpha.size))
        on_grid = self._zeros(self._place(alpha[:, None], roll[:, None], _TURNS), _TURNS)
        for kind, values in zip(_KINDS, on_grid, strict=True):
            point, step = np.nonzero(values[:, :-1] * values[:, 1:] < 0.0)
            if not point.size:
                continue
            a, r = alpha[point], roll[point]

            def zero(turn: FloatArray, a: FloatArray, r: FloatArray, kind: int = kind) -> FloatArray:
                return self._zeros(self._place(a, r, turn), turn)[kind]

            turn = _between(zero, step, values[point, step], values[point, step + 1], a, r)
            place = self._place(a, r, turn)
            # From the middle of the tooth space, less its half angle: what is left is measured from the base circle.
            angle = place.angle - (a - r) - turn
            inside = np.abs(angle) <= self.pitch
            if kind != _TIP:
                inside &= place.radius <= self.tip_radius
            if kind not in _ENDS:
                inside &= (place.u >= self.ends[0]) & (place.u <= self.ends[1])
            overlap = angle - (place.roll - np.arctan(place.roll))
            # Of several places of one kind the deepest: it is written last.
            order = np.flatnonzero(inside)[np.argsort(overlap[inside])]
            found[kind, point[order]], turns[kind, point[order]] = overlap[order], turn[order]
        return found, turns

    def overlap(self, alpha: ArrayLike, roll: ArrayLike) -> FloatArray:
        """Largest angle by which a point of the flank ever lies inside the shaper's tooth [rad].

        Parameters
        ----------
        alpha, roll : array_like
            Local pressure angle α and roll angle θs of the point [rad]; they broadcast.

        Returns
        -------
        ndarray
            About the shaper's axis; positive where the point is cut off, negative where it is left. The instant of
            generation, at which it is 0, does not count.
        """
        a, r = np.broadcast_arrays(np.asarray(alpha, dtype=float), np.asarray(roll, dtype=float))
        return np.asarray(self._candidates(a.ravel(), r.ravel())[0].max(axis=0).reshape(a.shape))

    def clearance(self, alpha: ArrayLike, roll: ArrayLike) -> FloatArray:
        """Negative of `overlap`, with a touch but for rounding counted as clear [rad]."""
        return _TOUCH - self.overlap(alpha, roll)

    def cut_by(self, alpha: FloatArray, roll: FloatArray) -> tuple[NDArray[np.int64], FloatArray]:
        """Which part of the shaper comes closest (0 edge of the tip, 1 and 2 its ends, 3 its flank), and at what δ."""
        overlap, turns = self._candidates(alpha, roll)
        part = overlap.argmax(axis=0)
        return part, turns[part, np.arange(part.size)]

    def _conditions(self, alpha: Any, c: Any, turn: Any) -> tuple[Any, tuple[FloatArray, ...]]:
        """Overlap at a rotation δ, less a touch, and the four functions that vanish where it may be largest."""
        place = self._place(alpha, alpha - c, turn)
        overlap = place.angle - c - turn - (place.roll - np.arctan(place.roll))
        return overlap - _TOUCH, self._zeros(place, turn)

    def edge(self, c: FloatArray, alpha: FloatArray, turn: FloatArray, part: NDArray[np.int64]) -> FloatArray:
        """Local pressure angles at which given parts of the shaper end the cut of contact lines [rad].

        By Newton's rule in α and δ, from values that hold nearby; NaN where it does not settle.
        """

        def residual(a: FloatArray, delta: FloatArray) -> FloatArray:
            overlap, zeros = self._conditions(a, c, delta)
            return np.stack([overlap, np.choose(part, zeros)])

        a, delta, h = alpha.copy(), turn.copy(), 1e-6
        for _ in range(_NEWTON):
            by_alpha = (residual(a + h, delta) - residual(a - h, delta)) / (2.0 * h)
            by_turn = (residual(a, delta + h) - residual(a, delta - h)) / (2.0 * h)
            now = residual(a, delta)
            determinant = by_alpha[0] * by_turn[1] - by_alpha[1] * by_turn[0]
            determinant = np.where(determinant == 0.0, 1.0, determinant)
            step = (now[0] * by_turn[1] - now[1] * by_turn[0]) / determinant
            a = a - np.clip(step, -_STRIDE, _STRIDE)
            step = (by_alpha[0] * now[1] - by_alpha[1] * now[0]) / determinant
            delta = delta - np.clip(step, -_STRIDE, _STRIDE)
        settled = np.all(np.abs(residual(a, delta)) < 10.0 * _TOUCH, axis=0)
        return np.where(settled, a, np.nan)

    def corner(self, alpha: float, c: float, turn: float, parts: tuple[int, int]) -> float:
        """C near the one given at which two parts of the shaper end the cut at the same instant [rad].

        As the tip and an end do in the tip corner. NaN if the search does not settle.
        """

        def conditions(unknown: FloatArray) -> list[Any]:
            overlap, zeros = self._conditions(*unknown)
            return [overlap, *(zeros[part] for part in parts)]

        found = solve(conditions, [alpha, c, turn], tol=1e-14)
        return float(found.x[1]) if np.max(np.abs(found.fun)) < 1e-13 else math.nan
