"""Gap between two flanks that touch at a point, slice by slice along the face.

A slice is what has one local pressure angle q; the gap g(q) between the flanks there is the same at every rotation
(:meth:`facegear.geometry.point_contact.UnloadedContact.gap`). Slices are named by s, the square root of their gap,
negative inside of the unloaded contact: in s, what is nearer than an approach δ is the interval from −√δ to √δ.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial import Chebyshev
from numpy.typing import ArrayLike

from facegear.floquet.series import ChebyshevSeries
from facegear.geometry.drive import Drive
from facegear.geometry.misalignment import ALIGNED, Misalignment
from facegear.geometry.point_contact import UnloadedContact
from facegear.support.roots import crossing
from facegear.support.types import FloatArray

#: Local pressure angles beyond the edges of the face that are looked at too [rad].
MARGIN = 0.05
# Local pressure angles that a flank cannot reach [rad].
_FLATTEST, _STEEPEST = 1e-3, 1.45
# Errors of series, relative to the largest value; degrees that they may have.
_TOLERANCE, _LEAST_DEGREE, _LARGEST_DEGREE = 1e-13, 16, 128
# Gauss–Legendre on [-1, 1]; 1 − t of it on [0, 1].
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(24)


@dataclass(frozen=True)
class SliceGap:
    """Gap between the flanks of a pinion and of a face gear cut by a shaper with more teeth, at each slice.

    Parameters
    ----------
    drive : Drive
        Its `shaper_teeth` exceed `pinion_teeth`.
    misalignment : Misalignment
        Default: none.

    Raises
    ------
    TypeError, ValueError
        As :class:`UnloadedContact`, or if the gap has another minimum on the flank.
    """

    drive: Drive
    misalignment: Misalignment = ALIGNED

    def __post_init__(self) -> None:
        angles = np.linspace(*self._range, 97)
        beyond = self._slope(angles) * (angles - self.contact.pressure_angle) < 0.0
        if np.any(beyond):
            away = abs(float(angles[beyond][0]) - self.contact.pressure_angle)
            raise ValueError(
                f"misalignment lets the gap narrow again {away:.3g} rad beside the contact, where flanks would touch "
                f"at a second place; {self.misalignment!r}"
            )

    @cached_property
    def contact(self) -> UnloadedContact:
        """Where the flanks touch without load."""
        return UnloadedContact(self.drive, self.misalignment)

    @cached_property
    def _range(self) -> tuple[float, float]:
        """Local pressure angles of the face, and a little more [rad]."""
        first, last = self.contact.face_angles
        return max(first - MARGIN, _FLATTEST), min(last + MARGIN, _STEEPEST)

    @cached_property
    def _turn(self) -> Callable[[FloatArray], FloatArray]:
        """ψ(q) N2/Ns, what misalignment adds to the roll angle of a slice [rad]."""
        ratio = self.drive.generating.speed_ratio
        return self._series(lambda q: self.contact.lines.turn(q) / ratio)

    @cached_property
    def _slope(self) -> Chebyshev:
        """dg/dq = A(q) dθ1/dq [m]: of parallel planes, one normal to each body, only their orientation counts."""
        direction = self._series(self.contact.lines.direction).deriv()
        return self._series(lambda q: self.contact.lines.residual(q) * direction(q))

    def _series(self, function: Callable[[FloatArray], FloatArray]) -> Chebyshev:
        return _polynomial(_resolved(function, *self._range))

    def root_gap(self, q: ArrayLike) -> FloatArray:
        """Square root s of the gap of slices [√m], negative inside of the unloaded contact.

        s = (q − q0) √h, and h = ∫(1 − t) g''(q0 + t(q − q0)) dt, in which nothing cancels.
        """
        away = np.asarray(q, dtype=float) - self.contact.pressure_angle
        t = 0.5 * (_NODES + 1.0)
        bend = self._slope.deriv()(self.contact.pressure_angle + away[..., np.newaxis] * t)
        return np.asarray(away * np.sqrt(bend @ (0.5 * _WEIGHTS * (1.0 - t))), dtype=float)

    def at(self, position: FloatArray) -> FloatArray:
        """Slices s at coordinates u along the shaper's axis [√m], between the ends of :attr:`UnloadedContact.face`."""
        gap = self.contact.gap(position)
        return np.asarray(np.sign(position - self.contact.position) * np.sqrt(np.maximum(gap, 0.0)))

    @cached_property
    def pressure_angle(self) -> Chebyshev:
        """Local pressure angle q of the slice s [rad]."""
        low, high = self.root_gap(np.array(self._range)).tolist()

        def angle(s: FloatArray) -> FloatArray:
            return crossing(lambda q, wanted: self.root_gap(q) - wanted, *self._range, s)

        return _polynomial(_resolved(angle, low, high))

    @cached_property
    def position(self) -> Chebyshev:
        """Coordinate u along the shaper's axis of the slice s [m], see :attr:`UnloadedContact.face`."""
        low, high = self.pressure_angle.domain.tolist()
        return _polynomial(
            _resolved(lambda s: self.drive.contact_region.position(self.pressure_angle(s)), low, high)
        )

    def distance_and_area(self, s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Distance of slices from the unloaded contact [m], and ∫ g du as far as there [m²]."""
        moments = self._moments(s)
        return s * moments[..., 0], s**3 * moments[..., 1]

    @cached_property
    def _moments(self) -> ChebyshevSeries:
        """∫ u'(ts) dt and ∫ t² u'(ts) dt over t from 0 to 1: differences without cancellation next to s = 0."""
        slope, t = self.position.deriv(), 0.5 * (_NODES + 1.0)
        weights = 0.5 * _WEIGHTS * np.stack([np.ones_like(t), t**2])
        low, high = self.position.domain.tolist()
        return _resolved(lambda s: slope(s[:, np.newaxis] * t) @ weights.T, low, high)


def _resolved(function: Callable[[FloatArray], FloatArray], low: float, high: float) -> ChebyshevSeries:
    """Series of a function of a slice."""
    return ChebyshevSeries.resolved(function, low, high, _LEAST_DEGREE, _LARGEST_DEGREE, _TOLERANCE)


def _polynomial(series: ChebyshevSeries) -> Chebyshev:
    """Return the same as what can be derived and integrated."""
    return Chebyshev(series.coefficients, domain=[series.low, series.high])
