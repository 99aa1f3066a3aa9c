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

Where the shaper cuts into the flank once more (`facegear.geometry.recut`), the line begins where that cut ends.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq

from facegear.geometry.recut import Shaper
from facegear.support.types import FloatArray
from facegear.symbolic import twins

# No flank reaches a local pressure angle near 90°: u_s would be infinite there.
_STEEPEST = 1.5
# Gauss–Legendre on [0, 1]: 24 nodes leave nothing of a smooth integrand over a fraction of a radian.
_NODES, _WEIGHTS = (array.astype(np.float64) for array in np.polynomial.legendre.leggauss(24))
_NODES, _WEIGHTS = 0.5 * (_NODES + 1.0), 0.5 * _WEIGHTS
# How soon after entry a line is looked at to know whether there are any.
_FIRST = 1e-3
# Contact lines that are held against the shaper to find where it cuts; pieces into which a search divides an interval,
# and how short that may be in the end [rad].
_LINES, _SECTIONS, _SAME = 48, 17, 1e-11
# How near to where the cut begins or takes all a line is looked at too, over the sweep.
_BESIDE = 1e-6
# Width of the interval that a search ends with, relative and, next to zero, absolute.
_DIGIT, _SMALL = 4.0 * np.finfo(float).eps, 1e-20
# Steps within which a search settles that does no worse than halve its interval now and then.
_STEPS = 200


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
        result[inside] = _enclosed(function, *ends, tuple(argument[inside] for argument in rest))
    return result


def _enclosed(
    function: Callable[..., FloatArray], low: FloatArray, high: FloatArray, rest: tuple[FloatArray, ...]
) -> FloatArray:
    """Roots between arguments where a function is negative and positive, shape (m,), by Chandrupatla's method.

    Inverse quadratic interpolation where it can be trusted, else the middle. `scipy.optimize.elementwise.find_root` is
    the same method, and takes ten times as long over a few dozen roots.
    """
    x_1, x_2, f_1, f_2 = low, high, function(low, *rest), function(high, *rest)
    found, settled, part = low.copy(), np.zeros(low.shape, dtype=bool), np.full(low.shape, 0.5)
    for _ in range(_STEPS):
        new = x_1 + part * (x_2 - x_1)
        value = function(new, *rest)
        same = np.sign(value) == np.sign(f_1)
        x_3, f_3 = np.where(same, x_1, x_2), np.where(same, f_1, f_2)
        x_2, f_2 = np.where(same, x_2, x_1), np.where(same, f_2, f_1)
        x_1, f_1 = new, value
        best = np.where(np.abs(f_1) < np.abs(f_2), x_1, x_2)
        found = np.where(settled, found, best)
        width, known = np.abs(x_2 - x_1), _DIGIT * np.abs(best) + _SMALL
        settled |= ((width <= 2.0 * known) | (f_1 == 0.0)) & ~np.isnan(f_1)
        if np.all(settled):
            return found
        # What is settled goes on from its middle, where nothing is divided by nothing.
        with np.errstate(divide="ignore", invalid="ignore"):
            place, level = (x_1 - x_2) / (x_3 - x_2), (f_1 - f_2) / (f_3 - f_2)
            trusted = ~settled & (level**2 < place) & ((1.0 - level) ** 2 < 1.0 - place)
            quadratic = f_1 / (f_2 - f_1) * f_3 / (f_2 - f_3)
            quadratic += (x_3 - x_1) / (x_2 - x_1) * f_1 / (f_3 - f_1) * f_2 / (f_3 - f_2)
            least = np.where(settled, 0.5, known / width)
        part = np.clip(np.where(trusted, quadratic, 0.5), least, 1.0 - least)
    raise RuntimeError(f"root search did not settle in {_STEPS} steps")


@dataclass(frozen=True, eq=False)
class Cut:
    """What the shaper takes of the contact lines.

    Parameters
    ----------
    exit : float
        C of the last contact that is left [rad].
    lines : ndarray, shape (n,)
        C of lines that were looked at, ascending [rad].
    shortened : ndarray of bool, shape (n,)
        Which of them lose their lower end.
    """

    exit: float
    lines: FloatArray
    shortened: NDArray[np.bool_]

    def may_shorten(self, c: FloatArray) -> NDArray[np.bool_]:
        """Which lines lie below one that is shortened, or next above it."""
        last = int(np.flatnonzero(self.shortened)[-1]) + 1 if np.any(self.shortened) else -1
        bound = -math.inf if last < 0 else math.inf if last == self.lines.size else self.lines[last]
        return np.asarray(c < bound)


@dataclass(frozen=True)
class ContactRegion:
    """The part of the (α_s, θs) plane where pinion and face-gear tooth touch during a mesh cycle.

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

        The pinion's tip leaves at the inner edge, or, with many teeth, where it leaves the tooth top before, or where
        it comes to the part that the shaper has cut off.
        """
        return self._cut.exit

    @cached_property
    def kinks(self) -> tuple[float, ...]:
        """C between entry and exit where an end of the contact line changes edge, descending [rad]."""
        changes = [self.edge_angle(self.outer_radius, self.tip_roll) - self.tip_roll, *self._cut_kinks]
        if self.base_circle is not None:
            changes.append(self.base_circle)
        if self._inner_edge_in_reach:
            roll = self.top_roll(self.inner_radius)
            corner = self.edge_angle(self.inner_radius, roll) - roll
            if self._clear_when_generated(corner):
                changes.append(corner)
        elif self.tooth_top_distance < self.base_radius:
            # Neither tooth top nor inner edge is reached: lines that began on the base circle then do at α_s = 0.
            changes.append(0.0)
        return tuple(sorted((c for c in changes if self.exit < c < self.entry), reverse=True))

    # --- what the shaper cuts off ----------------------------------------------------------------------------

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
    def _generated_exit(self) -> float:
        """C of the last contact on the flank as (3-8) leaves it [rad]."""
        if self._inner_edge_in_reach:
            return self.edge_angle(self.inner_radius, self.tip_roll) - self.tip_roll
        return self._tip_leaves_top - self.tip_roll

    @property
    def generated_sweep(self) -> float:
        """Rotation from first to last contact on the flank as (3-8) leaves it [rad]."""
        return self.entry - self._generated_exit

    @property
    def has_contact_lines(self) -> bool:
        """Whether the shaper leaves anything that the pinion touches: if so, what it touches last."""
        return not self._gone(np.array([self._first_line]))[0]

    @property
    def _first_line(self) -> float:
        """C of a line so soon after entry that nothing comes before it [rad]."""
        return self.entry - _FIRST * self.generated_sweep

    @property
    def is_cut(self) -> bool:
        """Whether the shaper shortens contact lines."""
        return bool(np.any(self._cut.shortened))

    def _gone(self, c: FloatArray) -> NDArray[np.bool_]:
        """Which contact lines the shaper has taken away whole."""
        _, upper = self._generated_ends(c)
        return np.asarray(self.shaper.clearance(upper, upper - c) < 0.0)

    @cached_property
    def _cut(self) -> Cut:
        """Which contact lines the shaper shortens, and which it takes away.

        Between shafts at up to 90° none: see `Drive.tip_undercut` for the trace that is neglected there.
        """
        if self.shaft_angle <= 0.5 * math.pi:
            return Cut(self._generated_exit, np.empty(0), np.empty(0, dtype=bool))
        c = np.append(np.linspace(self._generated_exit, self.entry, _LINES + 1)[:-1], self._first_line)
        lower, _ = self._generated_ends(c)
        shortened = self.shaper.clearance(lower, lower - c) < 0.0
        if not np.any(shortened):
            return Cut(self._generated_exit, c, shortened)
        gone = self._gone(c)
        if not np.any(gone):
            return Cut(self._generated_exit, c, shortened)
        k = int(np.flatnonzero(gone)[-1])
        return Cut(root(lambda x: self._clear(x, end=1), c[k], c[k + 1]), c, shortened)

    @cached_property
    def _cut_kinks(self) -> tuple[float, ...]:
        """C at which the shaper begins or ceases to shorten lines, or another part of it does so [rad]."""
        return (*(c for c, _ in self._cut_begins), *self._cut_corners)

    @cached_property
    def _cut_begins(self) -> tuple[tuple[float, float], ...]:
        """C at which the shaper begins or ceases to shorten lines [rad], and on which side of it it does, 1 or -1."""
        c, shortened = self._cut.lines, self._cut.shortened
        return tuple(
            (root(lambda x: self._clear(x, end=0), c[k], c[k + 1]), 1.0 if shortened[k + 1] else -1.0)
            for k in np.flatnonzero(shortened[:-1] != shortened[1:])
        )

    @cached_property
    def _affected(self) -> tuple[FloatArray, FloatArray, NDArray[np.int64], FloatArray]:
        """Shortened lines that were looked at, c ascending, with what `_cutting_parts` has of them.

        Where the cut begins, and where nothing is left, another part of the shaper may have taken over before the next
        of the lines looked at: one right beside it tells.
        """
        near = _BESIDE * self.generated_sweep
        affected = self._cut.lines[self._cut.shortened & (self._cut.lines > self._cut.exit)]
        beside = [c + way * near for c, way in self._cut_begins if c + way * near > self._cut.exit]
        if affected.size and self._cut.exit > self._generated_exit:
            beside.append(self._cut.exit + near)
        lines = np.unique(np.append(affected, beside)) if affected.size else affected
        return lines, *self._cutting_parts(lines)

    @cached_property
    def _cut_corners(self) -> tuple[float, ...]:
        """C at which another part of the shaper takes over, ascending [rad]."""
        c, starts, parts, turns = self._affected
        corners = []
        for k in np.flatnonzero(np.diff(parts)):
            both = int(parts[k]), int(parts[k + 1])
            corner = self.shaper.corner(float(starts[k]), float(c[k]), float(turns[k]), both)
            inside = c[k] < corner < c[k + 1]
            corners.append(corner if inside else self._change(float(c[k]), float(c[k + 1])))
        return tuple(corners)

    def _shortened(self, lower: FloatArray, upper: FloatArray, c: FloatArray) -> FloatArray:
        """Where lines begin that may be shortened: followed from the nearest line that was looked at [rad]."""
        known, starts, parts, turns = self._affected
        start = np.full(c.shape, np.nan)
        if known.size:
            # Not past a corner, beyond which another part of the shaper ends the cut.
            nearest = np.abs(c[:, None] - known)
            corners = np.array(self._cut_corners)
            apart = np.searchsorted(corners, c)[:, None] != np.searchsorted(corners, known)
            k = np.argmin(np.where(apart, np.inf, nearest), axis=1)
            start = self.shaper.edge(c, starts[k], turns[k], parts[k])
        # Where there is nothing to start from, where that fails, or where the end is not cut: by search.
        search = ~((start > lower) & (start < upper))
        start[search] = self._uncut(lower[search], upper[search], c[search])
        return start

    def _clear_when_generated(self, c: float) -> bool:
        """Whether the lower end of a line on the flank as (3-8) leaves it is there in the end."""
        return not self._cut.may_shorten(np.asarray(c)) or self._clear(c, end=0) >= 0.0

    def _clear(self, c: float, end: int) -> float:
        """Clearance of the lower (0) or upper (1) end of one contact line on the flank as (3-8) leaves it [rad]."""
        alpha = self._generated_ends(c)[end]
        return float(self.shaper.clearance(alpha, alpha - c))

    def _cutting_parts(self, c: FloatArray) -> tuple[FloatArray, NDArray[np.int64], FloatArray]:
        """Lower ends of shortened lines, which part of the shaper leaves them there, and at what δ [rad]."""
        lower, upper = self._generated_ends(c)
        start = self._uncut(lower, upper, c)
        return start, *self.shaper.cut_by(start, start - c)

    def _change(self, c_1: float, c_2: float) -> float:
        """C between two lines at which another part of the shaper takes over at another instant [rad]."""
        before = self._cutting_parts(np.array([c_1]))[1][0]
        while c_2 - c_1 > _SAME:
            c = np.linspace(c_1, c_2, _SECTIONS)
            same = int(np.argmax(self._cutting_parts(c)[1] != before))
            c_1, c_2 = float(c[same - 1]), float(c[same])
        return c_2

    def usable_radii(self, roll: float) -> tuple[float, float]:
        """Least and greatest −y_p of the flank that is left on a profile point [m]; NaN where nothing is."""

        def room(alpha: ArrayLike) -> Any:
            below_top = self.depth(alpha, roll) / self.tooth_top_distance - 1.0
            if self.shaft_angle <= 0.5 * math.pi:
                return below_top
            return np.minimum(below_top, self.shaper.clearance(alpha, roll))

        inner, outer = (self.edge_angle(radius, roll) for radius in (self.flank_start, self.outer_radius))
        alpha = np.linspace(inner, outer, _LINES)
        free = np.flatnonzero(room(alpha) >= 0.0)
        if not free.size:
            return math.nan, math.nan
        first, last = int(free[0]), int(free[-1])
        inner = inner if first == 0 else root(lambda x: float(room(x)), alpha[first - 1], alpha[first])
        outer = (
            alpha[-1] if last == _LINES - 1 else root(lambda x: float(room(x)), alpha[last], alpha[last + 1])
        )
        return float(self.radial_position(inner, roll)), float(self.radial_position(outer, roll))

    def _uncut(self, lower: FloatArray, upper: FloatArray, c: FloatArray) -> FloatArray:
        """Where lines begin that the shaper has shortened: it takes the lower end of a line, if any."""

        def clearance(alpha: FloatArray, line: FloatArray) -> FloatArray:
            return self.shaper.clearance(alpha, alpha - line)

        return crossing(clearance, lower, upper, c)

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
        if not self.exit < alpha < self.entry:
            return None
        return alpha if self._clear_when_generated(alpha) else None

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
        lower, upper = self._generated_ends(offset)
        shortened = self._cut.may_shorten(offset)
        if np.any(shortened):
            lower[shortened] = self._shortened(lower[shortened], upper[shortened], offset[shortened])
        return lower, upper

    def _generated_ends(self, c: ArrayLike) -> tuple[FloatArray, FloatArray]:
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
