"""Path of contact: the part of the line of action on which the teeth of two unloaded gears touch.

A normal of the flank that touches the pinion's base circle is a line of action, whatever the roll angle
(:mod:`facegear.geometry.action_lines`): the root of A(q) = 0 holds all through the mesh. Contact begins and ends where
that line leaves one of the flanks; between misaligned gears it may lie on neither.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.optimize import brentq

from facegear.geometry.action_lines import ActionLines
from facegear.geometry.drive import Drive
from facegear.geometry.misalignment import ALIGNED, Misalignment
from facegear.support.types import FloatArray


@dataclass(frozen=True)
class ActionPath:
    """Path of contact of a pinion and a face gear cut by a shaper with more teeth, if there is any.

    Parameters
    ----------
    drive : Drive
        Its `shaper_teeth` exceed `pinion_teeth`.
    misalignment : Misalignment
        Default: none.
    """

    drive: Drive
    misalignment: Misalignment = ALIGNED

    @cached_property
    def lines(self) -> ActionLines:
        """Lines of action of the two gears."""
        return ActionLines(self.drive, self.misalignment)

    @cached_property
    def pressure_angle(self) -> float:
        """Local pressure angle q of the contact [rad], the same all through the mesh."""
        # Of several the one next to the nominal pressure angle.
        return min(self.lines.rising, key=lambda q: abs(q - self.drive.pressure_angle))

    @property
    def position(self) -> float:
        """Coordinate u at which the flank touches [m], the same all through the mesh, see :attr:`face`."""
        return float(self.drive.contact_region.position(self.pressure_angle))

    @property
    def face(self) -> tuple[float, float]:
        """Least and largest coordinate u of a point of the flank [m].

        u is where the shaper makes it: along its axis, from where the axes of shaper and gear meet, to that point
        (u_s of (3-5)). The limits of the tooth, L1 and L2 (`Drive.inner_limit`, `outer_limit`), lie on the gear plane
        instead: they are the distances −y_p of its edges from the gear's axis over sin γ, and equal u between shafts at
        90° only. Otherwise an edge has another u at each height of the tooth, and all of the tooth lies between these.
        """
        low, high = (float(self.drive.contact_region.position(q)) for q in self.face_angles)
        return low, high

    @cached_property
    def face_angles(self) -> tuple[float, float]:
        """Least and largest local pressure angle q of a point of the flank [rad]."""
        shaper, region = self.drive.generating, self.drive.contact_region
        rolls = (0.0, shaper.shaper_tip_roll)
        first = min(region.edge_angle(shaper.flank_start, roll) for roll in rolls)
        return first, max(region.edge_angle(shaper.outer_radius, roll) for roll in rolls)

    @property
    def contact_ratio(self) -> float:
        """Mesh periods that a pair of teeth touches."""
        lowest, highest = self._rolls
        return (highest - lowest) * self.drive.generating.pinion_teeth / (2.0 * math.pi)

    @property
    def rolls(self) -> FloatArray:
        """Roll angles θs of the shaper at the ends of the path of contact, ascending, shape (2,) [rad]."""
        return np.array(self._rolls)

    @cached_property
    def _rolls(self) -> tuple[float, float]:
        """Roll angles θs of the shaper at which contact begins at the gear's tooth top, and ends at the pinion's tip.

        Between the edges of the face; where the pinion's base circle or the shaper's tip comes first, there.
        """
        q, region, shaper = self.pressure_angle, self.drive.contact_region, self.drive.generating
        start = float(self.lines.at(q)[2])
        base, own = shaper.base_radius, self.drive.base_radius
        lowest = max(0.0, -start / base)
        highest = min((own * self.drive.pinion_tip_roll - start) / base, shaper.shaper_tip_roll)

        def above(roll: float) -> float:
            return float(region.depth(q, roll)) - shaper.tooth_top_distance

        def inside(roll: float) -> float:
            return self._radius_of(roll) - shaper.flank_start

        def outside(roll: float) -> float:
            return shaper.outer_radius - self._radius_of(roll)

        for function in (above, inside, outside):
            lowest, highest = _where_positive(function, lowest, highest)
        return lowest, highest

    def fault(self) -> str | None:
        """Say what there is none of, if the flanks do not touch; else None."""
        if not self.lines.rising:
            return (
                "normal of the flank that touches the pinion's base circle: its teeth and those of the gear do not "
                "meet"
            )
        lowest, highest = self._rolls
        if lowest < highest:
            return None
        return f"contact on the flank: at −y_p = {1e3 * self._radius_of(lowest):.3f} mm it is {self._beyond(lowest)}"

    def _radius_of(self, roll: float) -> float:
        """−y_p of a point on the line of contact where it was made [m]."""
        return float(self.drive.contact_region.radial_position(self.pressure_angle, roll))

    def _beyond(self, roll: float) -> str:
        radius, shaper = self._radius_of(roll), self.drive.generating
        if radius < shaper.flank_start:
            return f"inside the inner edge at {1e3 * shaper.inner_radius:.3f} mm, where an edge bears"
        if radius > shaper.outer_radius:
            return f"outside the outer edge at {1e3 * shaper.outer_radius:.3f} mm, where an edge bears"
        return "off the height of the tooth, where its top or the pinion's tip bears"


def _where_positive(function: Callable[[float], float], low: float, high: float) -> tuple[float, float]:
    """Part of an interval where a monotonic function is not negative; empty, (end, end), if it is nowhere so."""
    if low >= high:
        return low, high
    first, last = function(low), function(high)
    if first >= 0.0 and last >= 0.0:
        return low, high
    if first < 0.0 and last < 0.0:
        return (low, low) if first > last else (high, high)
    place = float(brentq(function, low, high, xtol=1e-16, rtol=8.9e-16))
    return (place, high) if first < 0.0 else (low, place)
