"""Contact lines of a face-gear tooth as plain numbers: where they end, how long they are, their middle.

A line lies between the edges of the flank that the shaper generates and two circles of the pinion
(:mod:`facegear.geometry.generated_flank`). Where the shaper cuts into the flank once more, it begins where that cut
ends (:mod:`facegear.geometry.cut_lines`).
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from facegear.geometry.cut_lines import CutLines
from facegear.geometry.generated_flank import STEEPEST, GeneratedFlank
from facegear.support.quadrature import gauss
from facegear.support.roots import root
from facegear.support.types import FloatArray

# Gauss–Legendre on [0, 1]: 24 nodes leave nothing of a smooth integrand over a fraction of a radian.
_NODES, _WEIGHTS = gauss(0.0, 1.0, 24)


@dataclass(frozen=True)
class ContactRegion(GeneratedFlank):
    """The part of the (α_s, θs) plane where pinion and face-gear tooth touch during a mesh cycle.

    Parameters are those of :class:`facegear.geometry.generated_flank.GeneratedFlank`.
    """

    @cached_property
    def cut(self) -> CutLines:
        """What the shaper takes of the contact lines."""
        return CutLines(self)

    @cached_property
    def exit(self) -> float:
        """C = φ_out + θ0s, last contact [rad].

        The pinion's tip leaves at the inner edge, or, with many teeth, where it leaves the tooth top before, or where
        it comes to the part that the shaper has cut off.
        """
        return self.cut.found.exit

    @cached_property
    def kinks(self) -> tuple[float, ...]:
        """C between entry and exit where an end of the contact line changes edge, descending [rad]."""
        changes = [self.edge_angle(self.outer_radius, self.tip_roll) - self.tip_roll, *self.cut.kinks]
        if self.base_circle is not None:
            changes.append(self.base_circle)
        if self.inner_edge_in_reach:
            roll = self.top_roll(self.inner_radius)
            corner = self.edge_angle(self.inner_radius, roll) - roll
            if self.cut.leaves_lower_end(corner):
                changes.append(corner)
        elif self.tooth_top_distance < self.base_radius:
            # Neither tooth top nor inner edge is reached: lines that began on the base circle then do at α_s = 0.
            changes.append(0.0)
        return tuple(sorted((c for c in changes if self.exit < c < self.entry), reverse=True))

    @property
    def has_contact_lines(self) -> bool:
        """Whether the shaper leaves anything that the pinion touches: if so, what it touches last."""
        return not self.cut.gone(np.array([self.first_line]))[0]

    @property
    def is_cut(self) -> bool:
        """Whether the shaper shortens contact lines."""
        return bool(np.any(self.cut.found.shortened))

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
        return alpha if self.cut.leaves_lower_end(alpha) else None

    @cached_property
    def _top_on_base_circle(self) -> float | None:
        """Local pressure angle where the tooth top meets θs = 0, within the face width or not [rad]."""
        if self.tooth_top_distance >= self.base_radius:
            return None

        def excess(alpha: float) -> float:
            return self.tooth_top_distance - float(self.depth(alpha, 0.0))

        return root(excess, 0.0, STEEPEST)

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
        if not self.inner_edge_in_reach:
            return None
        roll = self.top_roll(self.inner_radius)
        corner = self.edge_angle(self.inner_radius, roll) - roll
        return (corner, self._top_on_base_circle) if roll > 0.0 and self.exit < corner < self.entry else None

    def line_ends(self, c: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Local pressure angles at the two ends of the contact lines, each of the shape of `c` [rad].

        Along a line −y_p and the depth both grow with α_s, so that every edge cuts off one end.
        """
        offset = np.asarray(c, dtype=np.float64)
        lower, upper = self.generated_ends(offset)
        shortened = self.cut.found.may_shorten(offset)
        if np.any(shortened):
            lower[shortened] = self.cut.starts(lower[shortened], upper[shortened], offset[shortened])
        return lower, upper

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
