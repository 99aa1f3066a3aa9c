"""Flank of a face-gear tooth as (3-8) leaves it, and where the contact lines on it end.

A point of the tooth flank is named by two angles: the roll angle θs of the involute (3-2) and the local
pressure angle α_s = φs + θ0s + θs, which (3-7) ties to the position along the shaper's axis,
u_s = r_bs cot γs / cos α_s. At a rotation φs the contact line is the straight line θs = α_s − c in the (α_s, θs)
plane, with c = φs + θ0s. It lies between three edges of the face-gear tooth and two circles of the pinion:

- inner and outer edge: the planes −y_p = R1 and −y_p = R2 normal to the gear plane's radius at the pinion,
  which for γ = 90° are u_s = L1 and u_s = L2;
- tooth top of the face gear: the cone about the face gear's axis whose generator in the plane of both axes is
  parallel to the shaper's axis, one addendum short of the pitch radius away. For γ = 90° it is the plane
  at that distance below the shaper's axis;
- tip circle of the pinion θs = θa, and its base circle θs = 0, below which there is no involute.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from facegear.geometry.recut import Shaper
from facegear.support.roots import crossing, root
from facegear.support.types import FloatArray
from facegear.symbolic import twins

# No flank reaches a local pressure angle near 90°: u_s would be infinite there.
STEEPEST = 1.5
# How soon after entry a line is looked at to know whether there are any.
_FIRST = 1e-3


@dataclass(frozen=True)
class GeneratedFlank:
    """Flank as the shaper generates it, in the (α_s, θs) plane, and the circles of the pinion that touches it.

    Parameters
    ----------
    base_radius : float
        r_bs [m].
    space_half_angle : float
        θ_0s [rad].
    speed_ratio : float
        m_2s.
    shaft_angle : float
        γ [rad].
    inner_radius, outer_radius : float
        R1 and R2 on the gear plane [m].
    tooth_top_distance : float
        r_p − a_g [m].
    tip_roll : float
        θ_a, roll angle at the pinion's tip circle [rad].
    shaper_tip_roll : float
        θ_s*, roll angle at the shaper's tip circle [rad].
    pitch : float
        Angular pitch 2π/Ns of pinion and shaper [rad].
    overhang : float
        By how much the shaper is longer at either end than the part of it that generates the flank [m].
    """

    base_radius: float
    space_half_angle: float
    speed_ratio: float
    shaft_angle: float
    inner_radius: float
    outer_radius: float
    tooth_top_distance: float
    tip_roll: float
    shaper_tip_roll: float
    pitch: float
    overhang: float

    def point(self, alpha: ArrayLike, roll: ArrayLike) -> FloatArray:
        """Contact point in the space-fixed Γp, shape (..., 3) [m], from α_s and θs [rad]."""
        return np.stack(np.broadcast_arrays(*self._components(alpha, roll)), axis=-1)

    def position(self, alpha: ArrayLike) -> Any:
        """Coordinate u_s along the shaper's axis where f = 0 (3-7) [m], from α_s [rad]."""
        return self.base_radius * self.cone_cotangent / np.cos(alpha)

    @property
    def cone_cotangent(self) -> float:
        """Cot γ_s of the shaper's pitch cone (3-16)."""
        return float(twins.pointing_cone_angle_cotangent(self.speed_ratio, self.shaft_angle))

    def radial_position(self, alpha: ArrayLike, roll: ArrayLike) -> Any:
        """−y_p [m], along the gear plane in the plane of both axes."""
        return -self._components(alpha, roll)[1]

    def _components(self, alpha: ArrayLike, roll: ArrayLike) -> Any:
        return twins.contact_point(alpha, roll, self.base_radius, self.speed_ratio, self.shaft_angle)

    def depth(self, alpha: ArrayLike, roll: ArrayLike) -> Any:
        """Distance from the shaper's axis of the cone through a point that is parallel to the tooth top [m].

        The face gear's tooth lies where this is at least r_p − a_g. For γ = 90° it is −z_p.
        """
        x, y, z = self._components(alpha, roll)
        return -z * math.sin(self.shaft_angle) - np.hypot(x, y) * math.cos(self.shaft_angle)

    def line_speed(self, alpha: ArrayLike, roll: ArrayLike) -> Any:
        """Arc length of the contact line per local pressure angle at constant φs [m]."""
        return twins.contact_line_speed(alpha, roll, self.base_radius, self.speed_ratio, self.shaft_angle)

    def edge_angle(self, radius: float, roll: float) -> float:
        """Local pressure angle at −y_p = `radius` on the profile point `roll` [rad]."""
        # Next to α_s = 0, −y_p may fall before it rises: the branch in use is the rising one.
        lowest = self._lowest_angle(roll)
        return root(lambda alpha: float(self.radial_position(alpha, roll)) - radius, lowest, STEEPEST)

    def _lowest_angle(self, roll: float) -> float:
        """Where −y_p is least at constant θs: cot γs sin α_s / cos² α_s = cot γ (θs cos α_s − sin α_s)."""
        cotangent = 1.0 / math.tan(self.shaft_angle)
        cone = self.cone_cotangent

        def slope(alpha: float) -> float:
            fall = cotangent * (roll * math.cos(alpha) - math.sin(alpha))
            return cone * math.sin(alpha) / math.cos(alpha) ** 2 - fall

        return root(slope, 0.0, STEEPEST) if slope(0.0) < 0.0 else 0.0

    def top_roll(self, radius: float) -> float:
        """Roll angle of the tooth top at −y_p = `radius` [rad]; 0 where the base circle comes first.

        Raises
        ------
        ValueError
            The shaper's tip does not reach below the tooth top at `radius`: there is no flank, only fillet.
        """

        def excess(roll: float) -> float:
            return float(self.depth(self.edge_angle(radius, roll), roll)) - self.tooth_top_distance

        if radius < self.flank_start * (1.0 - 1e-12):
            raise ValueError(
                f"radius must be at least {self.flank_start:.6g} m, where the flank starts, got {radius:.6g} m"
            )
        if excess(0.0) >= 0.0:
            return 0.0
        # At the start of the flank the tooth top is at the shaper's tip but for rounding.
        return (
            root(excess, 0.0, self.shaper_tip_roll)
            if excess(self.shaper_tip_roll) > 0.0
            else self.shaper_tip_roll
        )

    def _top_angle(self, roll: float) -> float:
        """Local pressure angle of the tooth top on the profile point `roll` > 0 [rad]; not below 0."""

        def excess(alpha: float) -> float:
            return float(self.depth(alpha, roll)) - self.tooth_top_distance

        return root(excess, 0.0, math.atan(roll)) if excess(0.0) < 0.0 else 0.0

    @cached_property
    def flank_start(self) -> float:
        """Least −y_p with a flank [m]: R1, or, with many teeth, where the shaper's tip meets the tooth top.

        Inside it the tip's undercut lies above the tooth top, and the tooth there is all fillet.
        """
        alpha = self._top_angle(self.shaper_tip_roll)
        return max(self.inner_radius, float(self.radial_position(alpha, self.shaper_tip_roll)))

    @cached_property
    def entry(self) -> float:
        """C = φ_in + θ0s, first contact: the outer edge meets the tooth top [rad]."""
        roll = self.top_roll(self.outer_radius)
        if roll >= self.tip_roll:
            raise ValueError(
                f"outer_radius={self.outer_radius:.6g} m is out of the pinion's reach: the tooth top lies at "
                f"a roll angle of {roll:.4g} rad there, the pinion's tip at {self.tip_roll:.4g} rad"
            )
        return self.edge_angle(self.outer_radius, roll) - roll

    @cached_property
    def _tip_leaves_top(self) -> float:
        """Local pressure angle where the pinion's tip circle leaves the tooth top [rad]."""
        return self._top_angle(self.tip_roll)

    @cached_property
    def inner_edge_in_reach(self) -> bool:
        """Whether the pinion's tip still lies below the tooth top when it comes to the inner edge."""
        return float(self.radial_position(self._tip_leaves_top, self.tip_roll)) < self.inner_radius

    @cached_property
    def shaper(self) -> Shaper:
        """Shaper of the stated length: all that generates the flank, and `overhang` more at either end."""
        inner = [
            self.edge_angle(self.flank_start, roll)
            for roll in (self.shaper_tip_roll, self.top_roll(self.flank_start))
        ]
        outer = self.edge_angle(self.outer_radius, self.top_roll(self.outer_radius))
        return Shaper(
            base_radius=self.base_radius,
            tip_radius=self.base_radius * math.hypot(1.0, self.shaper_tip_roll),
            pitch=self.pitch,
            speed_ratio=self.speed_ratio,
            shaft_angle=self.shaft_angle,
            ends=(
                float(self.position(min(inner))) - self.overhang,
                float(self.position(outer)) + self.overhang,
            ),
        )

    @cached_property
    def generated_exit(self) -> float:
        """C of the last contact on the flank as (3-8) leaves it [rad]."""
        if self.inner_edge_in_reach:
            return self.edge_angle(self.inner_radius, self.tip_roll) - self.tip_roll
        return self._tip_leaves_top - self.tip_roll

    @property
    def generated_sweep(self) -> float:
        """Rotation from first to last contact on the flank as (3-8) leaves it [rad]."""
        return self.entry - self.generated_exit

    @property
    def first_line(self) -> float:
        """C of a line so soon after entry that nothing comes before it [rad]."""
        return self.entry - _FIRST * self.generated_sweep

    def generated_ends(self, c: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Local pressure angles at the ends of lines on the flank as (3-8) leaves it, see `line_ends` [rad]."""
        offset = np.asarray(c, dtype=np.float64)
        tip = offset + self.tip_roll
        # α_s < 0 is the branch of the meshing surface beyond the undercut.
        lowest = np.maximum(offset, 0.0)

        def above_top(alpha: FloatArray, line: FloatArray) -> FloatArray:
            return np.asarray(self.depth(alpha, alpha - line) - self.tooth_top_distance)

        def outside(alpha: FloatArray, line: FloatArray, radius: FloatArray) -> FloatArray:
            return np.asarray(self.radial_position(alpha, alpha - line) - radius)

        below_top = crossing(above_top, lowest, tip, offset)
        lower = crossing(outside, below_top, tip, offset, self.inner_radius)
        upper = crossing(outside, below_top, tip, offset, self.outer_radius)
        return lower, np.maximum(lower, upper)
