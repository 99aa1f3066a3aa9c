"""Where the driving force presses on the disk, and how stiff against bending it makes the disk there.

Section 6.3 has the force at one point of the rim. A tooth takes it over its face width and hands it to the body over
the thickness of its root, and several pairs share it. Each is a set of points of the disk with their parts of the
moment (`Spread`).

**Moment and direction.** A flank of a spur pinion has its normals at right angles to the pinion's axis. So has the
force in the plane: at the place (r, θ), θ from the pinion's axis, its tangential part is to its radial part as cos θ to
sin θ, and its arm about the gear's axis is r cos θ. A normal force of one size has the moment r_b N2/N1 wherever it
presses on a conjugate tooth. Parts ϖ of the moment therefore are parts of the normal force. Their sum is one and the
moment is that of the printed force, F_t a:

    F_θ = ϖ F_t a/r,    F_r = ϖ F_t (a/r) tan θ.

**Stiffness.** Where the disk bends by w = Σ q_i φ_i it is drawn in: its points move in its plane by u = ½ Σ q_i q_j
v_ij, with v_ij the field, held at the bore and free of load, that relaxes the strain E_ij = sym(∇φ_i ⊗ ∇φ_j). A dead
force has the potential -F·u, and thus the stiffness

    K_ij = -F·v_ij at the place where it acts.

By Betti's theorem this is the work ∫ σ : E_ij h dA of its stresses (6-27); the acceleration of the steady field is
symmetric too, so that it holds for a spinning disk. But the force may act anywhere: v_ij is smooth where σ has a pole
under the force. Averages of a smooth field over a patch need a few points, and there is no field to be solved with a
force inside the disk. A force that follows the slope of the disk pushes sideways on the deflection under it, and adds
-φ_i (F_θ φ_j,θ/r + F_r φ_j,r) at each of its points: the one part that is not symmetric.

In the harmonic k the amplitudes of v obey the equations of :mod:`facegear.mechanics.inplane` with the right-hand sides

    U' = ... - x(E_rr + ν E_θθ),    V' = ... - 2x E_rθ,    P' = ... + x E_θθ,    Q' = ... - k x E_θθ

and S = T = 0 at the rim (:func:`facegear.symbolic.inplane.drawn_in` derives them). All that is asked of the solution is
its value at points, a linear functional; so one solution of the transposed equations for each k serves all i, j.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from facegear.geometry.drive import DEDENDUM, Drive
from facegear.mechanics.contact import Contact
from facegear.mechanics.disk import unit_shape
from facegear.mechanics.inplane import (
    collocation_points,
    collocation_system,
    edge_rows,
    resolving_degree,
    spin_per_speed,
)
from facegear.mechanics.plate import Body
from facegear.support.parameters import finite_array, keep, nonnegative, within
from facegear.support.types import ComplexArray, FloatArray

# Largest r over the outer radius of a point: a tooth enters mesh beside the pinion's axis, and nearly equal numbers of
# teeth put that 0.04 beyond the rim.
_FURTHEST = 1.05
# By how much the parts of the moment may miss 1 in sum.
_ONE_MOMENT = 1e-9
# Gauss nodes along the face, across a root and in each smooth piece of the mesh period: more change nothing.
_ALONG, _ACROSS, _IN_PIECE = 12, 4, 16


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


@dataclass(frozen=True)
class RimPoint(Spread):
    """One point of the rim, as printed (6-5).

    Examples
    --------
    >>> RimPoint().points(Drive(26, 130, 3.175e-3)).radius
    array([1.])
    """

    def points(self, drive: Drive) -> PressedPoints:
        """Return the point of the rim on the pinion's axis."""
        return PressedPoints(np.ones(1), np.zeros(1), np.ones(1))


RIM_POINT = RimPoint()
"""The force of chapter 6."""


@dataclass(frozen=True)
class PitchPoint(Spread):
    """One point at the pitch radius of the gear.

    As of every spread the moment is that of the printed force, F_t at the rim, so that the force here is F_t over
    :func:`pitch_ratio`. The moment that the power itself has is F_t times the pitch radius, less by that ratio.
    """

    def points(self, drive: Drive) -> PressedPoints:
        """Return the point of the pitch circle on the pinion's axis."""
        return PressedPoints(np.array([pitch_ratio(drive)]), np.zeros(1), np.ones(1))


@dataclass(frozen=True)
class FaceStrip(Spread):
    """Face width and root thickness of one tooth on the pinion's axis, pressed equally hard everywhere.

    Parameters
    ----------
    root_thickness : float
        Over which the tooth hands the force to the body [m], 0 or greater and less than a pitch of the teeth.

    Raises
    ------
    TypeError, ValueError
        If `root_thickness` is not a number of 0 or greater.

    Examples
    --------
    >>> points = FaceStrip().points(Drive(26, 130, 3.175e-3))
    >>> round(float(points.share @ points.radius), 4)  # the middle of the face
    0.9062
    """

    root_thickness: float = 0.0

    def __post_init__(self) -> None:
        keep(self, root_thickness=nonnegative("root_thickness", self.root_thickness, "m"))

    def points(self, drive: Drive) -> PressedPoints:
        """Gauss nodes over the face and, if the root has a thickness, across it."""
        pitch = drive.inner_radius * drive.angular_pitch
        if self.root_thickness >= pitch:
            raise ValueError(
                f"root_thickness must be less than the pitch of the teeth at their inner radius, {pitch:.6g} m, "
                f"got {self.root_thickness!r} m"
            )
        return _strip(drive, self.root_thickness)


def _strip(drive: Drive, root_thickness: float) -> PressedPoints:
    """Face of one tooth and its root, pressed equally hard everywhere."""
    along, part = np.polynomial.legendre.leggauss(_ALONG)
    inner = drive.inner_radius / drive.outer_radius
    radius, share = (1.0 + inner) / 2 + (1.0 - inner) / 2 * along, part / 2
    if root_thickness == 0.0:
        return PressedPoints(radius, np.zeros(_ALONG), share)
    across, weight = np.polynomial.legendre.leggauss(_ACROSS)
    half = root_thickness / (2 * drive.outer_radius)
    angle = half * across / radius[:, np.newaxis]
    return PressedPoints(np.repeat(radius, _ACROSS), angle.ravel(), np.outer(share, weight / 2).ravel())


@dataclass(frozen=True)
class ToothRoot(Spread):
    """Face width and root of one tooth on the pinion's axis.

    The root is as thick as that of the rack (:func:`root_thickness`); from pressure angles of about 27° on, where roots
    so thick would meet at the inner radius, as thick as the pitch of the teeth there.

    Examples
    --------
    >>> drive = Drive(26, 130, 3.175e-3)
    >>> bool(np.all(ToothRoot().points(drive).angle == FaceStrip(root_thickness(drive)).points(drive).angle))
    True
    """

    def points(self, drive: Drive) -> PressedPoints:
        """Gauss nodes over face and root."""
        return _strip(drive, min(root_thickness(drive), drive.inner_radius * drive.angular_pitch))


@dataclass(frozen=True)
class ContactPointsAt(Spread):
    """Contact points of the pairs that are in mesh at one instant, each with its part of the load.

    Parameters
    ----------
    contact : Contact
        Where the pairs touch and how they share the load, as that of the model, its `travel` included; loads without
        weights share it equally.
    fraction : float
        t/T0 of a pinion of phase 0 [-], 0 to 1.

    Raises
    ------
    TypeError, ValueError
        If `contact` is no Contact, or the fraction is not a number from 0 to 1.
    """

    contact: Contact
    fraction: float

    def __post_init__(self) -> None:
        _require_contact(self.contact)
        keep(self, fraction=within("fraction", self.fraction, 0.0, 1.0))

    def points(self, drive: Drive) -> PressedPoints:
        """Contact point of every load that there is."""
        self.contact.require(drive)
        radius, angle, share = _touching(self.contact, drive, np.array([self.fraction % 1.0]))
        # At the instant at which a pair enters mesh it may have no load yet.
        loaded = share > 0.0
        return PressedPoints(radius[loaded], angle[loaded], share[loaded])


@dataclass(frozen=True)
class ContactPoints(Spread):
    """Contact points of the pairs in mesh, each with its part of the load, in the mean over a mesh period.

    The force is that which rests in space: what it changes by in the course of the period is left out.

    Parameters
    ----------
    contact : Contact
        As for :class:`ContactPointsAt`.

    Raises
    ------
    TypeError
        If `contact` is no Contact.

    Examples
    --------
    >>> from facegear.mechanics.sharing import shared_load
    >>> contact = Contact(path=shared_load("length_share"), sharing="each")
    >>> points = ContactPoints(contact).points(Drive(26, 130, 3.175e-3))
    >>> round(float(points.share.sum()), 12)
    1.0
    """

    contact: Contact

    def __post_init__(self) -> None:
        _require_contact(self.contact)

    def points(self, drive: Drive) -> PressedPoints:
        """Contact points at Gauss nodes in each smooth piece of the mesh period."""
        self.contact.require(drive)
        nodes, weights = np.polynomial.legendre.leggauss(_IN_PIECE)
        breakpoints = self.contact.places(drive)[0].position.breakpoints
        length = np.diff(np.append(breakpoints, 1.0))[:, np.newaxis]
        pieces = zip(
            breakpoints[:, np.newaxis] + length * (nodes + 1.0) / 2, length * weights / 2, strict=True
        )
        columns: list[list[FloatArray]] = [[], [], []]
        for instants, weight in pieces:
            radius, angle, share = _touching(self.contact, drive, instants)
            for column, part in zip(columns, (radius, angle, share * weight), strict=True):
                column.append(part.ravel())
        return PressedPoints(*map(np.concatenate, columns))


@dataclass(frozen=True)
class ToothPatches(Spread):
    """What a tooth presses, at the angle of each point of another spread, with that point's part of the load.

    Parameters
    ----------
    teeth : Spread
        Whose angles are those of the teeth, as :class:`ContactPoints`.
    tooth : Spread
        What a tooth at angle 0 presses. Default: its face.

    Raises
    ------
    TypeError
        If an argument is no spread.
    """

    teeth: Spread
    tooth: Spread = FaceStrip()

    def __post_init__(self) -> None:
        require_spread("teeth", self.teeth)
        require_spread("tooth", self.tooth)

    def points(self, drive: Drive) -> PressedPoints:
        """Every point of a tooth at the angle of every tooth."""
        teeth, tooth = self.teeth.points(drive), self.tooth.points(drive)
        return PressedPoints(
            np.tile(tooth.radius, teeth.angle.size),
            np.add.outer(teeth.angle, tooth.angle).ravel(),
            np.outer(teeth.share, tooth.share).ravel(),
        )


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
    >>> body = Body(Drive(26, 130, 3.175e-3), thickness_ratio=0.03)
    >>> points_on(body, RIM_POINT).radius
    array([1.])
    """
    return _points_from(spread, body.drive, body.bore_ratio)


def _points_from(spread: Spread, drive: Drive, bore_ratio: float) -> PressedPoints:
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


def _require_contact(value: object) -> None:
    if not isinstance(value, Contact):
        raise TypeError(f"contact must be a Contact, got {value!r}")


def _touching(
    contact: Contact, drive: Drive, instants: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Radius, angle and share of each load at instants of one smooth piece of the period, (loads, instants)."""
    places = contact.placed(contact.places(drive), 0.0, 0.0)
    piece = int(np.searchsorted(places[0].position.breakpoints, instants[0], side="right")) - 1
    there = [place for place in places if place.in_contact[piece]]
    radius, angle = np.moveaxis(np.stack([place.position(instants) for place in there]), -1, 0)
    stiffness = [
        np.ones(instants.size) if place.weight is None else place.weight(instants)[:, 0] for place in there
    ]
    share = np.asarray(stiffness) / np.sum(stiffness, axis=0)
    return radius, angle, share


def root_thickness(drive: Drive) -> float:
    """Thickness of a tooth at its root where it is that of the rack, at the pitch radius [m].

    Half a circular pitch at the pitch plane, and two flanks of the pressure angle down to the dedendum.

    Examples
    --------
    >>> round(root_thickness(Drive(26, 130, 3.175e-3)) * 1e3, 2)
    8.69
    """
    return drive.module * (math.pi / 2 + 2 * DEDENDUM * math.tan(drive.pressure_angle))


def pitch_ratio(drive: Drive) -> float:
    """Pitch radius of the gear over its outer radius [-]: moment of a power over that of its printed force."""
    return drive.pitch_radius * drive.gear_ratio / drive.outer_radius


class PressedStiffness(NamedTuple):
    """Stiffness K_f of forces whose moment is that of 1 N at the rim, in two parts [1/(s² N)].

    Attributes
    ----------
    dead : ndarray, shape (n, n)
        Of forces that keep their direction; symmetric.
    following : ndarray, shape (n, n)
        What is added for forces that follow the slope of the disk.
    """

    dead: FloatArray
    following: FloatArray


def pressed_stiffness(
    body: Body, speed: float, harmonics: int, angles: tuple[float, ...], spread: Spread
) -> PressedStiffness:
    """Sum of K_f of equal forces at several angles.

    Parameters
    ----------
    body : Body
    speed : float
        Ω2 [rad/s].
    harmonics : int
        Largest k of the forces.
    angles : tuple of float
        Of the pinions [rad].
    spread : Spread
        Where each presses.

    Returns
    -------
    PressedStiffness
    """
    c, nu = body.bore_ratio, body.material.poissons_ratio
    spin = speed * spin_per_speed(body)
    harmonics = min(harmonics, 2 * body.nodal_diameters)
    degree = _degree(body)
    grid = _disk_grid(body, harmonics)
    x = _radii(c, degree)
    moments = _moments(spread, body.drive, c, degree, harmonics)
    # What each harmonic of the forces asks of E_rr, E_rθ, E_θθ at radii and angles; and the forces themselves.
    radial, mixed, hoop = (np.zeros((degree + 1, grid.angles.size)) for _ in range(3))
    pushed = np.zeros((2, degree + 1, grid.angles.size))
    for k in range(harmonics + 1):
        turned = moments[:, k] * np.exp(1j * k * np.asarray(angles)).sum()
        sine, cosine = np.sin(k * grid.angles), np.cos(k * grid.angles)
        part = (2 if k else 1) / grid.angles.size
        asked = part * _asked(c, nu, spin, k, turned)
        radial += np.outer(asked[0, :, 0], sine) + np.outer(asked[0, :, 1], cosine)
        mixed += np.outer(asked[1, :, 0], cosine) - np.outer(asked[1, :, 1], sine)
        hoop += np.outer(asked[2, :, 0], sine) + np.outer(asked[2, :, 1], cosine)
        pushed += part * (turned.real[..., np.newaxis] * cosine + turned.imag[..., np.newaxis] * sine)

    by_radius, by_angle = grid.by_radius, grid.by_angle / x[:, np.newaxis, np.newaxis]
    dead = _work(by_radius, radial, by_radius) + _work(by_angle, hoop, by_angle)
    crossed = _work(by_radius, mixed, by_angle) / 2
    dead += crossed + crossed.T
    tilted = _work(grid.value, pushed[0], by_angle) + _work(grid.value, pushed[1], by_radius)
    scale = -1.0 / (2 * math.pi * body.material.density * body.thickness * body.outer_radius**3)
    return PressedStiffness(scale * dead, scale * tilted)


def _work(left: FloatArray, weights: FloatArray, right: FloatArray) -> FloatArray:
    """Sum over radii and angles, (R, A, n), (R, A) and (R, A, n) to (n, n)."""
    product: FloatArray = np.tensordot(left, weights[:, :, np.newaxis] * right, axes=((0, 1), (0, 1)))
    return product


def _asked(c: float, nu: float, spin: float, k: int, forces: ComplexArray) -> FloatArray:
    """Factors of the amplitudes of E_rr, E_rθ, E_θθ at the radii in the work of forces on v.

    Parameters
    ----------
    forces : complex array, shape (2, radii)
        Sum of e^{ikθ} times tangential and radial force, in factors of values at the radii.

    Returns
    -------
    ndarray, shape (3, radii, 2)
        Of the amplitudes of sin, cos, sin, and of those of the field a quarter of a wave on, cos, -sin, cos.
    """
    size = forces.shape[1]
    tangential, radial = forces
    asked = np.zeros((4, size, 2))
    asked[0] = np.stack([radial.imag, radial.real], axis=-1)
    asked[1] = np.stack([tangential.real, -tangential.imag], axis=-1)
    system = collocation_system(c, nu, spin, k, size - 1)
    answer = np.linalg.solve(system.T, asked.reshape(4 * size, 2))
    answer[edge_rows(size - 1)] = 0.0  # the conditions at the edges have no right-hand side
    u, v, p, q = _radii(c, size - 1)[:, np.newaxis] * answer.reshape(4, size, 2)
    return np.stack([-u, -2 * v, -nu * u + p - k * q])


class _DiskGrid(NamedTuple):
    """Basis functions and their derivatives in x and θ at radii and angles, each of shape (radii, angles, n)."""

    angles: FloatArray
    value: FloatArray
    by_radius: FloatArray
    by_angle: FloatArray


def _degree(body: Body) -> int:
    """Degree that resolves the drawn-in field of all pairs of modes to rounding."""
    return resolving_degree(body.bore_ratio, 2 * body.nodal_diameters) + 8 * body.nodal_circles


def _radii(bore_ratio: float, degree: int) -> FloatArray:
    """Radii x = r/a of the points of the collocation, from the rim to the bore."""
    t, _ = collocation_points(degree)
    radii: FloatArray = np.exp(-math.log(bore_ratio) / 2 * (t - 1.0))
    return radii


@lru_cache(maxsize=64)
def _disk_grid(body: Body, harmonics: int) -> _DiskGrid:
    # Products of two modes and a harmonic have at most 2N + K waves: with more points than that sums are exact.
    count = 2 * body.nodal_diameters + harmonics + 1
    angles = 2 * np.pi * np.arange(count) / count
    x = _radii(body.bore_ratio, _degree(body))[:, np.newaxis]
    parts = (unit_shape(body.modes, x, angles, by_radius=i, by_angle=j) for i, j in ((0, 0), (1, 0), (0, 1)))
    return _DiskGrid(angles, *parts)


@lru_cache(maxsize=256)
def _moments(spread: Spread, drive: Drive, bore_ratio: float, degree: int, harmonics: int) -> ComplexArray:
    """Sum of e^{ikθ} times tangential and radial force, in factors of values at the radii; (2, K + 1, radii)."""
    points = _points_from(spread, drive, bore_ratio)
    t, _ = collocation_points(degree)
    local = 1.0 - np.log(points.radius) / (math.log(bore_ratio) / 2)
    to_points = np.linalg.solve(chebyshev.chebvander(t, degree).T, chebyshev.chebvander(local, degree).T)
    waves = np.exp(1j * np.multiply.outer(np.arange(harmonics + 1), points.angle))
    found = np.stack([(waves * force) @ to_points.T for force in (points.tangential, points.radial)])
    found.setflags(write=False)
    return found
