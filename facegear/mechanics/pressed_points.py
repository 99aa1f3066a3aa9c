"""Points of the disk at which a driving force presses, with their parts of its moment.

**Moment and direction.** A flank of a spur pinion has its normals at right angles to the pinion's axis. So has the
force in the plane: at the place (r, θ), θ from the pinion's axis, its tangential part is to its radial part as cos θ to
sin θ, and its arm about the gear's axis is r cos θ. A normal force of one size has the moment r_b N2/N1 wherever it
presses on a conjugate tooth. Parts ϖ of the moment therefore are parts of the normal force. Their sum is one and the
moment is that of the printed force, F_t a:

    F_θ = ϖ F_t a/r,    F_r = ϖ F_t (a/r) tan θ.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from facegear.geometry.drive import Drive
from facegear.mechanics.plate import Body
from facegear.support.parameters import finite_array, keep
from facegear.support.types import FloatArray

# Largest r over the outer radius of a point: a tooth enters mesh beside the pinion's axis, and nearly equal numbers of
# teeth put that 0.04 beyond the rim.
_FURTHEST = 1.05
# By how much the parts of the moment may miss 1 in sum.
_ONE_MOMENT = 1e-9


@dataclass(frozen=True, eq=False)
class PressedPoints:
    """Points at which the driving force of a pinion at angle 0 presses, m of them, at least one.

    Parameters
    ----------
    radius : array_like, shape (m,)
        r over the outer radius [-], greater than 0, on a body also no less than its bore ratio. A tooth enters mesh
        beside the pinion's axis, some thousandths beyond 1: there the disk is continued, as in
        :func:`facegear.mechanics.disk.unit_shape`.
    angle : array_like, shape (m,)
        θ from the pinion's axis [rad], less than a quarter of a turn.
    share : array_like, shape (m,)
        Part ϖ of the moment [-], each greater than 0; their sum is 1.

    Raises
    ------
    TypeError, ValueError
        If an argument is no list of finite numbers, as long as the others, or outside its range; a radius in another
        unit is named as such.

    Examples
    --------
    >>> PressedPoints([0.9, 1.0], [0.0, 0.0], [0.4, 0.6]).radial
    array([0., 0.])
    """

    radius: FloatArray
    angle: FloatArray
    share: FloatArray

    def __post_init__(self) -> None:
        columns = {name: finite_array(name, getattr(self, name)) for name in ("radius", "angle", "share")}
        shapes = {name: column.shape for name, column in columns.items()}
        if len(set(shapes.values())) > 1 or shapes["radius"] == (0,) or len(shapes["radius"]) != 1:
            raise ValueError(
                "radius, angle and share must be lists of one length, of at least one point, got the shapes "
                f"{', '.join(map(str, shapes.values()))}"
            )
        radius, angle, share = columns.values()
        if (wrong := (radius <= 0.0) | (radius > _FURTHEST)).any():
            raise ValueError(
                f"radius must be r over the outer radius, greater than 0 and at most {_FURTHEST:g}, got "
                f"{radius[wrong][0]:.6g} (a ratio, not m or mm?)"
            )
        if (wrong := np.abs(angle) >= math.pi / 2).any():
            raise ValueError(
                "angle must be less than a quarter of a turn from the pinion's axis, "
                f"{math.pi / 2:.4f} rad, got {angle[wrong][0]:.6g} rad (radians, not degrees?)"
            )
        if (wrong := share <= 0.0).any():
            raise ValueError(f"share must be greater than 0 at each point, got {share[wrong][0]:.6g}")
        if abs(share.sum() - 1.0) > _ONE_MOMENT:
            raise ValueError(f"share must have the sum 1, of one moment, got {share.sum():.12g}")
        for column in columns.values():
            column.setflags(write=False)
        keep(self, **columns)

    @property
    def tangential(self) -> FloatArray:
        """F_θ over the force at the rim that has the same moment [-], shape (m,)."""
        return self.share / self.radius

    @property
    def radial(self) -> FloatArray:
        """F_r over the force at the rim that has the same moment [-], shape (m,)."""
        return self.tangential * np.tan(self.angle)


class Spread(ABC):
    """Where a driving force presses: a frozen dataclass with `points`.

    One of your own is such a class, and its points are :class:`PressedPoints`, which says what they must be.
    """

    @abstractmethod
    def points(self, drive: Drive) -> PressedPoints:
        """Points of the disk of a drive, and their parts of the moment.

        Raises
        ------
        TypeError, ValueError
            If the drive's teeth have no such points.
        """


def require_spread(name: str, value: object) -> None:
    """Refuse what is no spread, or cannot be told from another one by its hash.

    Raises
    ------
    TypeError
        Naming the argument.
    """
    if not isinstance(value, Spread):
        raise TypeError(f"{name} must be a Spread such as FaceStrip(), got {value!r}")
    try:
        hash(value)
    except TypeError as error:
        raise TypeError(
            f"{name} must be a Spread with a hash, a frozen dataclass whose fields are numbers or tuples, got "
            f"{value!r} ({error})"
        ) from None


def points_on(body: Body, spread: Spread) -> PressedPoints:
    """Points of a spread on a body.

    Parameters
    ----------
    body : Body
    spread : Spread

    Returns
    -------
    PressedPoints

    Raises
    ------
    TypeError
        If the points of the spread are something else.
    ValueError
        If one lies inside the bore, or as :meth:`Spread.points`.

    Examples
    --------
    >>> from facegear.mechanics.spreads import RIM_POINT
    >>> body = Body(Drive(26, 130, 3.175e-3), thickness_ratio=0.03)
    >>> points_on(body, RIM_POINT).radius
    array([1.])
    """
    return points_from(spread, body.drive, body.bore_ratio)


@lru_cache(maxsize=64)
def points_from(spread: Spread, drive: Drive, bore_ratio: float) -> PressedPoints:
    """As :func:`points_on`, on a disk of which the teeth and the bore over the outer radius are known."""
    points = spread.points(drive)
    name = f"{type(spread).__name__}.points"
    if not isinstance(points, PressedPoints):
        raise TypeError(f"{name} must return PressedPoints(radius, angle, share), got {points!r}")
    if (least := points.radius.min()) < bore_ratio:
        raise ValueError(
            f"radius of {name} must be r over the outer radius, at least that of the bore, {bore_ratio:.6g}, got "
            f"{least:.6g} (a ratio, not m or mm?)"
        )
    return points
