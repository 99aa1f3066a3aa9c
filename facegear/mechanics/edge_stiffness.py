"""Stiffness of the disk against bending under driving forces in its plane, K_f of section 6.3.

`edge_load_stiffness` is that of the text, from the plane stress of a force at the rim. `DrivingForce` has the force of
a power wherever it presses (:mod:`facegear.mechanics.spreads`); at the rim both are one matrix.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Literal

import numpy as np

from facegear.floquet.series import ChebyshevSeries
from facegear.geometry.drive import Drive
from facegear.mechanics.disk import mirror_signs, unit_shape
from facegear.mechanics.inplane import EdgeLoadStress, fastest_speed
from facegear.mechanics.plate import Body
from facegear.mechanics.pressed_points import Spread, points_on, require_spread
from facegear.mechanics.pressed_stiffness import pressed_stiffness
from facegear.mechanics.radial_modes import plate_quadrature
from facegear.mechanics.spreads import RIM_POINT
from facegear.support.kinds import require_kind
from facegear.support.parameters import (
    designed,
    integer_at_least,
    keep,
    nonnegative,
    one_of,
    positive,
    within,
)
from facegear.support.types import FloatArray

Following = Literal["follower", "dead"]
_FOLLOWS = {"follower": 1.0, "dead": 0.0}

# K_f as a series in the square of the speed, from 0 to this speed [rad/s] or 2, 4, 8 ... times it.
_LOWEST_TOP = 128.0
_SERIES_DEGREE = 8
# Ratio h/a of the body of which it is kept.
_STANDARD = 0.125
# Mean shear stress at the bore over Young's modulus that a driving force may have: steel breaks at a thousandth.
_MOST_SHEAR = 100.0


def complete_harmonics(body: Body) -> int:
    """Largest harmonic that can couple two modes of a body, 2N."""
    return 2 * body.nodal_diameters


@dataclass(frozen=True, eq=False)
class _Grid:
    """Basis functions at the nodes of a quadrature over the disk, and along its rim, on unit outer radius.

    Values and slopes have the shape (radii, angles, n) on the disk and (angles, n) along the rim. `weights` (radii,)
    are those of ∫ x dx, averages over the angles are sums over their number.
    """

    x: FloatArray
    weights: FloatArray
    angles: FloatArray
    by_radius: FloatArray
    by_angle: FloatArray
    rim: FloatArray
    rim_by_radius: FloatArray
    rim_by_angle: FloatArray


@lru_cache(maxsize=64)
def _grid(body: Body, harmonics: int) -> _Grid:
    x, weights = plate_quadrature(body.bore_ratio)
    # Products of two modes and a harmonic have at most 2N + K waves: with more points than that sums are exact.
    count = complete_harmonics(body) + harmonics + 1
    angles = 2 * np.pi * np.arange(count) / count

    modes, radii, rim = body.modes, x[:, np.newaxis], np.ones(count)
    return _Grid(
        x,
        weights,
        angles,
        unit_shape(modes, radii, angles, by_radius=1),
        unit_shape(modes, radii, angles, by_angle=1),
        unit_shape(modes, rim, angles),
        unit_shape(modes, rim, angles, by_radius=1),
        unit_shape(modes, rim, angles, by_angle=1),
    )


def edge_load_stiffness(stress: EdgeLoadStress, following: Following = "follower") -> FloatArray:
    """Stiffness K_f of the disk in the plane field of a force at its rim (6-26, 6-27), real basis.

    Parameters
    ----------
    stress : EdgeLoadStress
        The field; harmonics beyond 2N couple no modes and leave K_f as it is.
    following : {"follower", "dead"}
        Whether the force stays in the tangent plane of the bent rim, as the dissertation assumes, or keeps its
        direction in space. K_f of a dead force is symmetric.

    Returns
    -------
    ndarray, shape (n, n)
        K_f [1/s²], divided by 2πρh as all matrices of (4-8); coordinates as
        :func:`facegear.mechanics.disk.disk_modes`.

    Raises
    ------
    TypeError, ValueError
        If an argument is of the wrong kind.

    Notes
    -----
    The weak form of the operator (6-23) is the work of the stresses on the slopes, symmetric, and the transverse part
    of the rim load times the deflection at the rim, which is what a follower force adds.
    """
    require_kind("stress", stress, EdgeLoadStress)
    one_of("following", following, ("follower", "dead"))
    body = stress.body
    harmonics = min(stress.harmonics, complete_harmonics(body))
    grid = _grid(body, harmonics)
    used = EdgeLoadStress(body, stress.force, stress.speed, harmonics, stress.direction, stress.angle)
    radial, shear, hoop = used.field(grid.x[:, np.newaxis] * body.outer_radius, grid.angles)
    weights = grid.weights[:, np.newaxis] / grid.angles.size
    x = grid.x[:, np.newaxis]
    # σ·grad φ: radial and circumferential part
    first = np.einsum("ra,ran->ran", weights * radial, grid.by_radius)
    first += np.einsum("ra,ran->ran", weights * shear / x, grid.by_angle)
    second = np.einsum("ra,ran->ran", weights * shear / x, grid.by_radius)
    second += np.einsum("ra,ran->ran", weights * hoop / x**2, grid.by_angle)
    stiffness = np.tensordot(grid.by_radius, first, axes=((0, 1), (0, 1)))
    stiffness += np.tensordot(grid.by_angle, second, axes=((0, 1), (0, 1)))
    if following == "follower":
        radial, shear, _ = used.field(body.outer_radius, grid.angles)
        slope = radial[:, np.newaxis] * grid.rim_by_radius + shear[:, np.newaxis] * grid.rim_by_angle
        stiffness -= grid.rim.T @ slope / grid.angles.size
    found: FloatArray = stiffness / (body.material.density * body.outer_radius**2)
    return found


def strong_form_stiffness(stress: EdgeLoadStress) -> FloatArray:
    """K_f of a follower force on a disk at rest from the strong form of (6-23), a second route to the same matrix.

    Stresses in equilibrium leave -σ : ∇∇w of the operator. It takes second derivatives of the modes where the weak
    form takes slopes, and no term at the rim.

    Parameters
    ----------
    stress : EdgeLoadStress
        At speed 0: with inertia the stresses alone are not in equilibrium.

    Returns
    -------
    ndarray, shape (n, n)
        As :func:`edge_load_stiffness`.

    Raises
    ------
    ValueError
        If the speed is not 0.
    """
    if stress.speed != 0.0:
        raise ValueError(f"stress must be that of a disk at rest, got speed={stress.speed!r} rad/s")
    body = stress.body
    x, weights = plate_quadrature(body.bore_ratio)
    count = complete_harmonics(body) + stress.harmonics + 1
    angles, x = 2 * np.pi * np.arange(count) / count, x[:, np.newaxis]

    def shape(by_radius: int, by_angle: int) -> FloatArray:
        return unit_shape(body.modes, x, angles, by_radius=by_radius, by_angle=by_angle)

    radius = x[:, :, np.newaxis]
    radial, shear, hoop = (part[:, :, np.newaxis] for part in stress.field(x * body.outer_radius, angles))
    curvature = radial * shape(2, 0)
    curvature = curvature + 2 * shear * (shape(1, 1) / radius - shape(0, 1) / radius**2)
    curvature = curvature + hoop * (shape(1, 0) / radius + shape(0, 2) / radius**2)
    weighted = shape(0, 0) * (weights / count)[:, np.newaxis, np.newaxis]
    work = np.tensordot(weighted, curvature, axes=((0, 1), (0, 1)))
    found: FloatArray = -work / (body.material.density * body.outer_radius**2)
    return found


def unit_stiffness(
    body: Body,
    speed: float,
    harmonics: int,
    following: Following,
    angles: tuple[float, ...],
    spread: Spread = RIM_POINT,
) -> FloatArray:
    """Sum of K_f of equal forces with the moment of 1 N at the rim, at several angles [1/(s² N)].

    Speed enters by its square, and weakly: a series through nine speeds, kept, is exact to rounding.

    Parameters
    ----------
    body : Body
    speed : float
        Ω2 [rad/s].
    harmonics : int
        Largest k.
    following : {"follower", "dead"}
    angles : tuple of float
        Of the forces [rad].
    spread : Spread
        Where each presses.

    Returns
    -------
    ndarray, shape (n, n)
    """
    limit = fastest_speed(body)
    speed = within("speed", speed, 0.0, limit, "rad/s", hint="rpm?")
    octave = max(0, math.ceil(math.log2(speed / _LOWEST_TOP))) if speed > 0.0 else 0
    top = min(_LOWEST_TOP * 2**octave, limit)
    dead, added = _stiffness_series(_standard(body), top, harmonics, angles, spread)((speed / top) ** 2)
    found: FloatArray = (_STANDARD / body.thickness_ratio) * (dead + _FOLLOWS[following] * added)
    return found


@lru_cache(maxsize=256)
def _standard(body: Body) -> Body:
    """Return a body with the same field in its plane but for a factor, in inverse proportion to its thickness."""
    return replace(body, thickness_ratio=_STANDARD)


@lru_cache(maxsize=256)
def _stiffness_series(
    body: Body, top: float, harmonics: int, angles: tuple[float, ...], spread: Spread
) -> ChebyshevSeries:
    """K_f of dead forces and what following adds, (2, n, n), over (Ω2/top)² from 0 to 1."""

    def sampled(squares: FloatArray) -> FloatArray:
        speeds = (top * np.sqrt(squares)).tolist()
        return np.stack([pressed_stiffness(body, speed, harmonics, angles, spread) for speed in speeds])

    return ChebyshevSeries.sampled(sampled, 0.0, 1.0, _SERIES_DEGREE)


@dataclass(frozen=True)
class DrivingForce:
    """Force in the plane with which each pinion drives the disk (4-21), the same at every speed.

    Parameters
    ----------
    power : float
        P [W] that each pinion brings in at its speed `pinion_speed`, 0 or greater.
    pinion_speed : float
        Ω1 at that power [rad/s], greater than 0.
    following : {"follower", "dead"}
        Whether the force stays tangent to the bent rim, as printed, or keeps its direction.
    harmonics : int
        Largest harmonic of the stress under the force. Default 5, as printed; 2N couples all modes
        (:func:`complete_harmonics`).
    spread : Spread
        Where the force presses, with the moment that it has at the rim. Default: at one point of the rim, as printed;
        `FaceStrip`, `ToothPatches`, `ContactPoints` of :mod:`facegear.mechanics.spreads` have it over the teeth.

    Raises
    ------
    TypeError, ValueError
        If an argument is of the wrong kind or outside its range.

    Examples
    --------
    >>> import facegear as fg
    >>> round(fg.DrivingForce(power=447.42e3, pinion_speed=523.6).newtons(fg.Drive(26, 130, 3.175e-3)))
    20703
    """

    power: float = field(metadata=designed("power of each pinion"))
    pinion_speed: float
    following: Following = "follower"
    harmonics: int = 5
    spread: Spread = RIM_POINT

    def __post_init__(self) -> None:
        keep(
            self,
            power=nonnegative("power", self.power, "W"),
            pinion_speed=positive("pinion_speed", self.pinion_speed, "rad/s"),
            harmonics=integer_at_least("harmonics", self.harmonics, 0),
        )
        one_of("following", self.following, ("follower", "dead"))
        require_spread("spread", self.spread)

    def newtons(self, drive: Drive) -> float:
        """Force at the pinion's pitch circle, F_t = P/(Ω1 r_p) [N] (4-21)."""
        return self.power / (self.pinion_speed * drive.pitch_radius)

    def require(self, body: Body) -> None:
        """Refuse a force that no body bears, such as by a power or a speed in another unit.

        Raises
        ------
        TypeError, ValueError
            If the mean shear stress round the bore, F_t R2/(2π b² h), passes a hundred times Young's modulus, or the
            teeth of the body's drive have no such spread.
        """
        points_on(body, self.spread)
        force, bore = self.newtons(body.drive), 2.0 * math.pi * body.bore_radius**2 * body.thickness
        stress, most = force * body.outer_radius / bore, _MOST_SHEAR * body.material.youngs_modulus
        if stress > most:
            raise ValueError(
                f"power must be at most {self.power * most / stress:.3g} W at pinion_speed={self.pinion_speed!r} rad/s "
                f"on this body, got {self.power!r} W: a force of {force:.3g} N, whose shear stress at the bore is "
                f"{stress / body.material.youngs_modulus:.3g} times Young's modulus (another unit of power or speed?)"
            )

    def stiffness(
        self, body: Body, speed: float, angles: Sequence[float], senses: Sequence[int] | None = None
    ) -> FloatArray:
        """K_f of forces of one size at several angles [1/s²].

        Parameters
        ----------
        body : Body
        speed : float
            Ω2 [rad/s].
        angles : sequence of float
            Of the pinions, in the sense in which the disk turns [rad].
        senses : sequence of int, optional
            1 where a pinion drives the disk, -1 where the disk drives it, by the other flanks of the teeth: the force
            and its places are then the mirror image. Default: all drive.

        Returns
        -------
        ndarray, shape (n, n)
        """
        ways = senses or (1,) * len(angles)
        driving = tuple(angle for angle, way in zip(angles, ways, strict=True) if way > 0)
        driven = tuple(-angle for angle, way in zip(angles, ways, strict=True) if way < 0)
        signs, found = mirror_signs(body), np.zeros((1, 1))
        for here, image in ((driving, np.ones((1, 1))), (driven, np.outer(signs, signs))):
            if here:
                unit = unit_stiffness(body, speed, self.harmonics, self.following, here, self.spread)
                found = found + image * unit
        return np.asarray(self.newtons(body.drive) * found)
