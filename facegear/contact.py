"""Contact lines of a face-gear tooth as plain numbers: where they end, how long they are, their middle.

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
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq
from scipy.optimize.elementwise import find_root

from facegear.parameters import FloatArray
from facegear.symbolic import meshing

# No flank reaches a local pressure angle near 90°: u_s would be infinite there.
_STEEPEST = 1.5
# Gauss–Legendre on [0, 1]: 24 nodes leave nothing of a smooth integrand over a fraction of a radian.
_NODES, _WEIGHTS = (array.astype(np.float64) for array in np.polynomial.legendre.leggauss(24))
_NODES, _WEIGHTS = 0.5 * (_NODES + 1.0), 0.5 * _WEIGHTS


def root(function: Callable[[float], float], lower: float, upper: float) -> float:
    """Root of a scalar function between two arguments of opposite sign, to the last digit."""
    return float(brentq(function, lower, upper, xtol=1e-16, rtol=8.9e-16))


def crossing(
    function: Callable[..., FloatArray], lower: ArrayLike, upper: ArrayLike, *arguments: ArrayLike
) -> FloatArray:
    """Where an increasing function crosses zero between two arguments, elementwise, to the last digit.

    Where it is positive throughout the lower end is the answer, where negative throughout the upper one.
    """
    low, high, *rest = np.broadcast_arrays(lower, upper, *arguments)
    above = function(low, *rest) >= 0.0
    below = function(high, *rest) <= 0.0
    inside = ~(above | below)
    result = np.where(above, low, high).astype(np.float64)
    if np.any(inside):
        ends = (low[inside], high[inside])
        found = find_root(function, ends, args=tuple(argument[inside] for argument in rest))
        if not np.all(found.success):
            raise RuntimeError(f"root search stopped early, status {np.unique(found.status).tolist()}")
        result[inside] = found.x
    return result


@dataclass(frozen=True)
class ContactRegion:
    """The part of the (α_s, θs) plane where pinion and face-gear tooth touch during a mesh cycle.

    Parameters
    ----------
    base_radius : float
        r_bs [m].
    space_half_angle : float
        θ_0s [rad].
    gear_ratio : float
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
    """

    base_radius: float
    space_half_angle: float
    gear_ratio: float
    shaft_angle: float
    inner_radius: float
    outer_radius: float
    tooth_top_distance: float
    tip_roll: float
    shaper_tip_roll: float

    # --- one point ---------------------------------------------------------------------------------------

    def point(self, alpha: ArrayLike, roll: ArrayLike) -> FloatArray:
        """Contact point in the space-fixed Γp, shape (..., 3) [m], from α_s and θs [rad]."""
        return np.stack(np.broadcast_arrays(*self._components(alpha, roll)), axis=-1)

    def position(self, alpha: ArrayLike) -> Any:
        """Coordinate u_s along the shaper's axis where f = 0 (3-7) [m], from α_s [rad]."""
        return self.base_radius * self.cone_cotangent / np.cos(alpha)

    @property
    def cone_cotangent(self) -> float:
        """Cot γ_s of the shaper's pitch cone (3-16)."""
        s = meshing
        function = s.compiled(s.pointing_cone_angle_cotangent, s.m_2s, s.gamma)
        return float(function(self.gear_ratio, self.shaft_angle))

    def radial_position(self, alpha: ArrayLike, roll: ArrayLike) -> Any:
        """−y_p [m], along the gear plane in the plane of both axes."""
        return -self._components(alpha, roll)[1]

    def _components(self, alpha: ArrayLike, roll: ArrayLike) -> Any:
        s = meshing
        function = s.compiled(s.contact_point, s.alpha, s.theta_s, s.r_bs, s.m_2s, s.gamma)
        return function(alpha, roll, self.base_radius, self.gear_ratio, self.shaft_angle)

    def depth(self, alpha: ArrayLike, roll: ArrayLike) -> Any:
        """Distance from the shaper's axis of the cone through a point that is parallel to the tooth top [m].

        The face gear's tooth lies where this is at least r_p − a_g. For γ = 90° it is −z_p.
        """
        x, y, z = self._components(alpha, roll)
        return -z * math.sin(self.shaft_angle) - np.hypot(x, y) * math.cos(self.shaft_angle)

    def line_speed(self, alpha: ArrayLike, roll: ArrayLike) -> Any:
        """Arc length of the contact line per local pressure angle at constant φs [m]."""
        s = meshing
        function = s.compiled(s.contact_line_speed, s.alpha, s.theta_s, s.r_bs, s.m_2s, s.gamma)
        return function(alpha, roll, self.base_radius, self.gear_ratio, self.shaft_angle)

    # --- corners -----------------------------------------------------------------------------------------

    def edge_angle(self, radius: float, roll: float) -> float:
        """Local pressure angle at −y_p = `radius` on the profile point `roll` [rad]."""
        # Next to α_s = 0, −y_p may fall before it rises: the branch in use is the rising one.
        lowest = self._lowest_angle(roll)
        return root(lambda alpha: float(self.radial_position(alpha, roll)) - radius, lowest, _STEEPEST)

    def _lowest_angle(self, roll: float) -> float:
        """Where −y_p is least at constant θs: cot γs sin α_s / cos² α_s = cot γ (θs cos α_s − sin α_s)."""
        cotangent = 1.0 / math.tan(self.shaft_angle)
        cone = self.cone_cotangent

        def slope(alpha: float) -> float:
            fall = cotangent * (roll * math.cos(alpha) - math.sin(alpha))
            return cone * math.sin(alpha) / math.cos(alpha) ** 2 - fall

        return root(slope, 0.0, _STEEPEST) if slope(0.0) < 0.0 else 0.0

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
    def _inner_edge_in_reach(self) -> bool:
        """Whether the pinion's tip still lies below the tooth top when it comes to the inner edge."""
        return float(self.radial_position(self._tip_leaves_top, self.tip_roll)) < self.inner_radius

    @cached_property
    def exit(self) -> float:
        """C = φ_out + θ0s, last contact [rad].

        The pinion's tip leaves at the inner edge, or, with many teeth, where it leaves the tooth top before.
        """
        if self._inner_edge_in_reach:
            return self.edge_angle(self.inner_radius, self.tip_roll) - self.tip_roll
        return self._tip_leaves_top - self.tip_roll

    @cached_property
    def kinks(self) -> tuple[float, ...]:
        """C between entry and exit where an end of the contact line changes edge, descending [rad]."""
        changes = [self.edge_angle(self.outer_radius, self.tip_roll) - self.tip_roll]
        if self.base_circle is not None:
            changes.append(self.base_circle)
        if self._inner_edge_in_reach:
            roll = self.top_roll(self.inner_radius)
            changes.append(self.edge_angle(self.inner_radius, roll) - roll)
        elif self.tooth_top_distance < self.base_radius:
            # Neither tooth top nor inner edge is reached: lines that began on the base circle then do at α_s = 0.
            changes.append(0.0)
        return tuple(sorted((c for c in changes if self.exit < c < self.entry), reverse=True))

    @cached_property
    def base_circle(self) -> float | None:
        """C at which the tooth top brings the contact line's end down to the base circle [rad]; None if never.

        With few teeth the tooth top lies inside the base circle, r_p − a_g < r_bs, and where it meets θs = 0
        (for γ = 90° at cos c = (r_p − a_g)/r_bs) the end of the line changes from one to the other. The line
        goes on: it begins where the involute does, and the shaper, which has the pinion's own flank, has
        cleared the face gear's tooth beyond. But the involute has a cusp there, ∂r/∂θs ∝ θs, and the depth
        along the line is stationary: r_bs (cos c + ½θs² cos c) for γ = 90°. So the end comes in as
        θs = √(2(c − c_b) tan c_b), and length and midpoint of the line have that square root of time in them.

        For γ < 90° the depth rises from θs = 0, by a part cos γ x²/2y² of the way, and the root lies just beyond.
        For γ > 90° it falls first: the tooth top cuts a sliver out of the line, of up to 0.05 rad at the lowest
        gear ratios, which closes within 5e-4 rad of c and is not taken out here, so that the end jumps over it.
        """
        alpha = self._top_on_base_circle
        if alpha is None or float(self.radial_position(alpha, 0.0)) <= self.inner_radius:
            return None
        return alpha if self.exit < alpha < self.entry else None

    @cached_property
    def _top_on_base_circle(self) -> float | None:
        """Local pressure angle where the tooth top meets θs = 0, within the face width or not [rad]."""
        if self.tooth_top_distance >= self.base_radius:
            return None

        def excess(alpha: float) -> float:
            return self.tooth_top_distance - float(self.depth(alpha, 0.0))

        return root(excess, 0.0, _STEEPEST)

    @cached_property
    def square_root(self) -> tuple[float, float] | None:
        """C of the corner at which a line's end stops following a square root, and C of the root [rad].

        They are one at `base_circle`. Where the inner edge comes a little before it, the root lies beyond the corner,
        too near for polynomials all the same. None where the tooth top stays outside the base circle.
        """
        if self._top_on_base_circle is None:
            return None
        if self.base_circle is not None:
            return self.base_circle, self.base_circle
        if not self._inner_edge_in_reach:
            return None
        roll = self.top_roll(self.inner_radius)
        corner = self.edge_angle(self.inner_radius, roll) - roll
        return (corner, self._top_on_base_circle) if roll > 0.0 and self.exit < corner < self.entry else None

    # --- whole lines -------------------------------------------------------------------------------------

    def line_ends(self, c: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Local pressure angles at the two ends of the contact lines, each of the shape of `c` [rad].

        Along a line −y_p and the depth both grow with α_s, so that every edge cuts off one end.
        """
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

    def length(self, c: ArrayLike, lower: FloatArray, upper: FloatArray) -> FloatArray:
        """Arc length of contact lines between two local pressure angles [m], shape of `c`."""
        whole = np.ones_like(lower)
        return (upper - lower) * self._mean_speed(np.asarray(c, dtype=np.float64), lower, upper, whole)

    def _mean_speed(self, c: FloatArray, lower: FloatArray, upper: FloatArray, end: FloatArray) -> FloatArray:
        """Integral of the line speed over the fraction 0 … `end` of the interval taken as 0 … 1."""
        alpha = lower[..., None] + ((upper - lower) * end)[..., None] * _NODES
        speed = self.line_speed(alpha, alpha - c[..., None])
        return np.asarray(end * (speed @ _WEIGHTS), dtype=np.float64)

    def middle(self, c: ArrayLike, lower: FloatArray, upper: FloatArray) -> FloatArray:
        """Local pressure angle of the point halfway along contact lines by arc length [rad], shape of `c`."""
        offset = np.asarray(c, dtype=np.float64)
        half = 0.5 * self._mean_speed(offset, lower, upper, np.ones_like(lower))
        fraction = np.full(lower.shape, 0.5)
        # The integrand is positive and varies slowly: Newton's rule settles at once, also on zero length.
        for _ in range(20):
            alpha = lower + (upper - lower) * fraction
            miss = self._mean_speed(offset, lower, upper, fraction) - half
            step = miss / self.line_speed(alpha, alpha - offset)
            fraction = fraction - step
            if np.all(np.abs(step) < 4e-15):
                return np.asarray(lower + (upper - lower) * fraction, dtype=np.float64)
        raise RuntimeError(f"midpoint search did not settle: last step {np.max(np.abs(step)):.3g}")
