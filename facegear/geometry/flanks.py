"""Tooth flanks and contact lines as arrays of points, in the frame of either gear or fixed in space.

Γs turns with pinion and shaper, Γ2 with the face gear, Γp is fixed in space with z_p the face gear's axis and
−y_p towards the pinion (3-4). A rotation is always the pinion's, φs; the face gear has turned by m_2s φs.
Flank 1 is the one the equations describe, flank −1 its mirror image, met at the opposite rotation.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from facegear.geometry.contact_lines import ContactRegion
from facegear.support import parameters
from facegear.support.types import FloatArray
from facegear.symbolic import twins


def _mirror(flank: int) -> FloatArray:
    if isinstance(flank, bool) or flank not in (1, -1):
        raise ValueError(f"flank must be 1 or -1, got {flank!r}")
    return np.array([float(flank), 1.0, 1.0])


def _rotate(matrix_entries: tuple[Any, ...], points: ArrayLike) -> FloatArray:
    """Multiply points by rotation matrices given as nine arrays, row by row."""
    entries = np.stack(np.broadcast_arrays(*matrix_entries), axis=-1)
    matrices = entries.reshape(*entries.shape[:-1], 3, 3)
    turned: FloatArray = np.einsum("...ij,...j->...i", matrices, np.asarray(points, dtype=np.float64))
    return turned


def shaper_points(region: ContactRegion, position: ArrayLike, roll: ArrayLike) -> FloatArray:
    """Points of flank 1 of the shaper in Γs (3-2), shape (..., 3) [m], from u_s [m] and θs [rad]."""
    components = twins.shaper_surface(position, roll, region.space_half_angle, region.base_radius)
    return np.stack(np.broadcast_arrays(*components), axis=-1)


def shaper_to_gear(region: ContactRegion, points: ArrayLike, rotation: ArrayLike) -> FloatArray:
    """Carry points (..., 3) from Γs to Γ2 at rotations φs [rad] that broadcast against (...) (3-4, 3-5)."""
    phi = np.asarray(rotation, dtype=np.float64)
    return _rotate(twins.rotation_2s(phi, region.speed_ratio * phi, math.pi - region.shaft_angle), points)


def shaper_to_fixed(region: ContactRegion, points: ArrayLike, rotation: ArrayLike) -> FloatArray:
    """Carry points (..., 3) from Γs to Γp at rotations φs [rad] that broadcast against (...)."""
    phi = np.asarray(rotation, dtype=np.float64)
    return _rotate(twins.rotation_2s(phi, 0.0, math.pi - region.shaft_angle), points)


def gear_to_fixed(region: ContactRegion, points: ArrayLike, rotation: ArrayLike) -> FloatArray:
    """Carry points (..., 3) from Γ2 to Γp at rotations φs [rad] that broadcast against (...)."""
    # The inverse of M_2p(φ2) is M_2p(−φ2).
    phi = np.asarray(rotation, dtype=np.float64)
    return _rotate(twins.rotation_2p(-region.speed_ratio * phi), points)


@dataclass(frozen=True)
class ToothFlank:
    """A grid on a flank of a face-gear tooth.

    Parameters
    ----------
    region : ContactRegion
    points : ndarray, shape (along, across, 3)
        Coordinates in the face gear's frame Γ2 [m]; the first index runs outwards to R2, the second from tooth
        top to root.
    position : ndarray, shape (along, across)
        u_s where each point is generated [m].
    roll : ndarray, shape (along, across)
        θs of the shaper's point that generates it [rad].
    rotation : ndarray, shape (along, across)
        φs at which it does [rad].
    """

    region: ContactRegion
    points: FloatArray
    position: FloatArray
    roll: FloatArray
    rotation: FloatArray

    def fixed_points(self, rotation: float = 0.0) -> FloatArray:
        """Return the points in the space-fixed Γp with the pinion turned by φs [rad]; shape of `points`.

        A step of 2π/N1 in φs is the next tooth.
        """
        return gear_to_fixed(self.region, self.points, parameters.finite("rotation", rotation, "rad"))


@dataclass(frozen=True)
class PinionFlank:
    """A grid on a flank of the pinion.

    Parameters
    ----------
    region : ContactRegion
    points : ndarray, shape (along, across, 3)
        Coordinates in the pinion's frame Γs [m]; the first index runs along the axis, the second from base to
        tip.
    """

    region: ContactRegion
    points: FloatArray

    def fixed_points(self, rotation: float = 0.0) -> FloatArray:
        """Return the points in the space-fixed Γp with the pinion turned by φs [rad]; shape of `points`.

        A step of 2π/N1 in φs is the next tooth.
        """
        return shaper_to_fixed(self.region, self.points, parameters.finite("rotation", rotation, "rad"))


def tooth_flank(region: ContactRegion, along: int, across: int, flank: int) -> ToothFlank:
    """Generate a face-gear flank; see `Drive.tooth_flank`."""
    n = parameters.integer_at_least("along", along, 2)
    k = parameters.integer_at_least("across", across, 2)
    sign = _mirror(flank)
    radii = np.linspace(region.flank_start, region.outer_radius, n)
    top = np.array([region.top_roll(radius) for radius in radii])[:, None]
    roll = top + (region.shaper_tip_roll - top) * np.linspace(0.0, 1.0, k)
    alpha = np.array(
        [[region.edge_angle(radius, th) for th in line] for radius, line in zip(radii, roll, strict=True)]
    )
    rotation = alpha - roll - region.space_half_angle
    position = region.position(alpha)
    points = shaper_to_gear(region, shaper_points(region, position, roll), rotation) * sign
    return ToothFlank(region, points, position, roll, rotation * flank)


def tip_undercut(region: ContactRegion, along: int, across: int) -> FloatArray:
    """Depth to which the shaper cuts into the flank that it has generated [m], see `Drive.tip_undercut`."""
    flank = tooth_flank(region, along, across + 1, 1)
    # The lowest row is made by the corner of the shaper's tip itself.
    roll = flank.roll[:, :-1]
    alpha = flank.rotation[:, :-1] + region.space_half_angle + roll
    # Involutes of one base circle are parallel curves: turned by an angle, they are that times its radius apart.
    depth = -region.base_radius * region.shaper.clearance(alpha, roll)
    return np.asarray(np.maximum(depth, 0.0).max(axis=1))


def pinion_flank(
    region: ContactRegion, ends: tuple[float, float], first_roll: float, along: int, across: int, flank: int
) -> PinionFlank:
    """Lay a grid on a flank of the pinion between two positions on its axis; see `Drive.pinion_flank`."""
    n = parameters.integer_at_least("along", along, 2)
    k = parameters.integer_at_least("across", across, 2)
    position = np.linspace(*ends, n)[:, None]
    points = shaper_points(region, position, np.linspace(first_roll, region.tip_roll, k))
    return PinionFlank(region, points * _mirror(flank))


def top_thickness(region: ContactRegion, radius: float) -> float:
    """Thickness of the face-gear tooth at its top, an arc about the gear's axis [m]; see `Drive`."""
    roll = region.top_roll(radius)
    alpha = region.edge_angle(radius, roll)
    x, y, _ = region.point(alpha, roll)
    # Γ2's y axis is the tooth's plane of symmetry: both flanks lie at the same angle from it.
    gear_angle = math.atan2(x, -y) - region.speed_ratio * (alpha - roll - region.space_half_angle)
    return 2.0 * math.hypot(x, y) * gear_angle


@dataclass(frozen=True)
class ContactLines:
    """Contact lines of one tooth pair at given pinion rotations.

    Parameters
    ----------
    region : ContactRegion
    rotation : ndarray, shape S
        φs [rad].
    lower, upper : ndarray, shape S
        Local pressure angles α_s at the two ends [rad]; the upper end lies further out.
    """

    region: ContactRegion
    rotation: FloatArray
    lower: FloatArray
    upper: FloatArray

    @property
    def _offset(self) -> FloatArray:
        return self.rotation + self.region.space_half_angle

    @cached_property
    def length(self) -> FloatArray:
        """Arc lengths [m], shape S; zero at entry and exit."""
        return self.region.length(self._offset, self.lower, self.upper)

    @cached_property
    def middle(self) -> FloatArray:
        """Local pressure angles of the midpoints by arc length [rad], shape S."""
        return self.region.middle(self._offset, self.lower, self.upper)

    @cached_property
    def contact_point(self) -> FloatArray:
        """Midpoints by arc length in the space-fixed Γp, shape S + (3,) [m]."""
        return self.region.point(self.middle, self.middle - self._offset)

    @property
    def radius(self) -> FloatArray:
        """Distance r of the contact points from the gear's axis [m], shape S."""
        return np.hypot(self.contact_point[..., 0], self.contact_point[..., 1])

    @property
    def angle(self) -> FloatArray:
        """Space-fixed angle θ of the contact points about the gear's axis from the pinion [rad], shape S."""
        return np.arctan2(self.contact_point[..., 0], -self.contact_point[..., 1])

    def shaper_points(self, count: int = 33, flank: int = 1) -> FloatArray:
        """Points along the lines in the pinion's frame Γs, equally spaced in α_s.

        Parameters
        ----------
        count : int
            Points a line, at least 2.
        flank : {1, -1}
            Side of the tooth; the other is its mirror image, met at the opposite rotation.

        Returns
        -------
        ndarray, shape S + (count, 3)
            Coordinates [m].
        """
        fraction = np.linspace(0.0, 1.0, parameters.integer_at_least("count", count, 2))
        alpha = self.lower[..., None] * (1.0 - fraction) + self.upper[..., None] * fraction
        points = shaper_points(self.region, self.region.position(alpha), alpha - self._offset[..., None])
        return points * _mirror(flank)

    def gear_points(self, count: int = 33, flank: int = 1) -> FloatArray:
        """Carry `shaper_points` to the face gear's frame Γ2, where they lie on the tooth flank."""
        points = self.shaper_points(count, flank)
        return shaper_to_gear(self.region, points, flank * self.rotation[..., None])

    def fixed_points(self, count: int = 33, flank: int = 1) -> FloatArray:
        """Carry `shaper_points` to the space-fixed Γp."""
        points = self.shaper_points(count, flank)
        return shaper_to_fixed(self.region, points, flank * self.rotation[..., None])
