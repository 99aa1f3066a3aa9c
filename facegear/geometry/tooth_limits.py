"""How far the teeth of a face gear reach, and Tregold's contact ratio: what has a formula or one root (chapter 3)."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from facegear.geometry.proportions import ADDENDUM, Proportions, of_generating
from facegear.support.roots import root
from facegear.symbolic import twins

_RIGHT_ANGLE = 0.5 * math.pi


@dataclass(frozen=True)
class ToothLimits(Proportions):
    """Undercutting within, pointing without, and the face width between them.

    Parameters and errors are those of :class:`facegear.geometry.proportions.Proportions`.
    """

    @cached_property
    @of_generating
    def undercut_roots(self) -> tuple[float, ...]:
        """Real roots t = tan(φs* + θ0s + θs*) of the condition of undercutting, ascending.

        The negative one lies on the other branch of the meshing surface; `undercut_root` is the physical one.
        """
        m, gamma_m = self.speed_ratio, math.pi - self.shaft_angle
        p, q = m * math.sin(gamma_m), 1.0 - m * math.cos(gamma_m)
        values = twins.undercut_coefficients(p, q, self.shaper_tip_roll)
        polynomial = np.polynomial.Polynomial(np.array(values, dtype=np.float64)[::-1])
        roots = polynomial.roots()
        real = np.sort(roots[np.abs(roots.imag) < 1e-9 * np.abs(roots)].real)
        # Companion-matrix roots are good to 1e-14 or so; Newton's step removes what is left.
        slope = polynomial.deriv()
        for _ in range(2):
            real = real - polynomial(real) / slope(real)
        return tuple(real.tolist())

    @property
    @of_generating
    def undercut_root(self) -> float:
        """The physical root of the condition of undercutting: the smallest with t > 0."""
        return next(root for root in self.undercut_roots if root > 0.0)

    @cached_property
    @of_generating
    def inner_limit(self) -> float:
        """L1 along the shaper's axis, where undercutting ends [m] (3-13): R1 over sin γ.

        Between shafts at 90° it is the coordinate u_s of the edge; else u has its ends in `UnloadedContact.face`.
        """
        m, gamma_m = self.speed_ratio, math.pi - self.shaft_angle
        p, q = m * math.sin(gamma_m), 1.0 - m * math.cos(gamma_m)
        t = self.undercut_root
        return float(twins.inner_limit(t, p, q, self.base_radius, self.dedendum_radius, self.shaft_angle))

    @cached_property
    @of_generating
    def pointing_angle(self) -> float:
        """α_p, the pressure angle α_s of the pointing section [rad] (3-15)."""
        arguments = (self.space_half_angle, self.tooth_top_distance, self.base_radius)
        # The condition falls to a minimum at cos α_s = r_bs/r_top, if there is one, and rises through the root.
        lowest = math.acos(min(1.0, self.base_radius / self.tooth_top_distance))
        return root(lambda angle: float(twins.pointing_condition(angle, *arguments)), lowest, _RIGHT_ANGLE)

    @cached_property
    @of_generating
    def outer_limit(self) -> float:
        """L2 along the shaper's axis, where the tooth becomes pointed [m] (3-14): R2 over sin γ, as `inner_limit`."""
        alpha, top = self.pointing_angle, self.tooth_top_distance
        return float(twins.outer_limit(alpha, self.base_radius, top, self.speed_ratio, self.shaft_angle))

    @property
    def inner_radius(self) -> float:
        """R1 = L1 sin γ on the gear plane [m] (3-17)."""
        return self.inner_limit * math.sin(self.shaft_angle)

    @property
    def outer_radius(self) -> float:
        """R2 = L2 sin γ on the gear plane [m] (3-18), the radius a of the face-gear body."""
        return self.outer_limit * math.sin(self.shaft_angle)

    @property
    def face_width(self) -> float:
        """L = L2 − L1 [m] (4-21)."""
        return self.outer_limit - self.inner_limit

    @property
    def contact_ratio(self) -> float:
        """Contact ratio after Tregold, that of the formative spur gears (3-23 to 3-26).

        A face-gear pitch cone beyond 90° makes an internal formative gear, one of 90° a rack; the formula is
        written in 1/N_v so that it passes through all three.
        """
        m_12, sine, cosine = 1.0 / self.speed_ratio, math.sin(self.shaft_angle), math.cos(self.shaft_angle)
        cone_1 = math.atan2(sine, m_12 + cosine)
        cone_2 = math.atan2(m_12 * sine, 1.0 + m_12 * cosine)
        inverses = (math.cos(cone_1) / self.pinion_teeth, math.cos(cone_2) / self.gear_teeth)
        return sum(self._formative_approach(inverse) for inverse in inverses) / (2.0 * math.pi)

    def _formative_approach(self, inverse: float) -> float:
        """N_v (tan α_va − tan α_c) of one formative gear, from 1/N_v (3-25, 3-26)."""
        cosine, sine = math.cos(self.pressure_angle), math.sin(self.pressure_angle)
        tip = 1.0 + 2.0 * ADDENDUM * inverse
        # N (√(tip² − cos²) − sin)/cos, with the difference of squares divided out so that N → ∞ is regular.
        numerator = 4.0 * ADDENDUM + 4.0 * ADDENDUM**2 * inverse
        return numerator / (cosine * (math.sqrt(tip**2 - cosine**2) + sine))
