"""Contact at a point: a face gear cut by a shaper with more teeth than the pinion, as long as nothing is loaded.

A point of the face gear's flank is named by the local pressure angle q = φ + θ0s + θs where the shaper made it and by
its roll angle θs. At constant q the point being made moves along its own normal N = −(cos q, sin q, 0), which stands
still (:mod:`facegear.symbolic.point_contact` derives it). So whether a normal of the flank touches the pinion's base
circle, which is all that contact with an involute asks for, does not depend on θs: for any position of two rigid gears
it is one equation A(q) = 0. Its root holds all through the mesh; the path of contact is a straight line of action, and
the gears turn in their exact ratio.

Coordinates are those of the shaper at rest in space: z along its axis outwards, the face gear's axis along
k = (0, sin γ_m, cos γ_m), γ_m = 180° − γ.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from functools import cached_property, lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq
from scipy.special import elliprd, elliprf

from facegear.geometry.contact_lines import ContactRegion, root
from facegear.geometry.drive import Drive, involute
from facegear.geometry.kinematics import PairStates, TimedPairs
from facegear.support.parameters import finite, finite_array, keep, nonnegative, one_of, positive, within
from facegear.support.types import FloatArray

# Local pressure angles between which contact is looked for [rad].
_ANGLES = np.linspace(-1.5, 1.5, 601)
_ANGLES.setflags(write=False)
# Halvings of a misalignment that leaves no contact, to say how much of it would, and digits of that.
_HALVINGS, _DIGITS = 20, 3
# Errors of alignment that are taken for such: [m], [rad], and how far off a pivot may be [m].
_LONGEST, _WIDEST, _FARTHEST = 0.1, 0.1, 100.0
# What a coordinate along the face may miss its ends by, relative.
_ROUNDING = 1e-9
# Forces [N] and moduli [Pa] for which Hertz' ellipse is computed: below and above it is no size that a number can have.
_LEAST_FORCE, _LARGEST_MODULUS = 1e-12, 1e15


# Components x, y, z, numbers or arrays of one shape: stacked, they would take longer to stack than to work with.
Vector = tuple[Any, Any, Any]


class _Change(NamedTuple):
    """Angles between which normals begin or cease to touch the pinion's base circle."""

    first: float
    last: float
    rises: bool


@dataclass(frozen=True)
class Misalignment:
    """Position of a rigid pinion and face gear against their nominal one.

    Parameters
    ----------
    offset : float
        ΔE, displacement of the pinion's axis square to both axes [m], towards +x; for the other flank it counts the
        other way.
    gear_axial : float
        Δq, displacement of the face gear along its axis [m], positive towards the pinion.
    pinion_axial : float
        Δb, displacement of the pinion along its axis [m]; an involute cylinder does not mind.
    shaft_angle : float
        Δγ by which the shafts stand further apart [rad]: positive opens the outer end of the teeth.
    pivot : float, optional
        z_v on the pinion's axis [m], about which Δγ turns it; None where the axes meet.

    Raises
    ------
    TypeError, ValueError
        If a value is not a finite number, a length more than 0.1 m (`pivot`: 100 m), or the angle more than 0.1 rad.

    Examples
    --------
    >>> import facegear as fg
    >>> drive = fg.Drive(26, 130, 3.175e-3, shaper_teeth=28)
    >>> nominal = fg.UnloadedContact(drive)
    >>> shifted = fg.UnloadedContact(drive, fg.Misalignment(gear_axial=2e-5))
    >>> bool(shifted.backlash < nominal.backlash)
    True
    """

    offset: float = 0.0
    gear_axial: float = 0.0
    pinion_axial: float = 0.0
    shaft_angle: float = 0.0
    pivot: float | None = None

    def __post_init__(self) -> None:
        for part in fields(self):
            value = getattr(self, part.name)
            if value is not None or part.name != "pivot":
                keep(self, **{part.name: _error(part.name, value)})


def _error(name: str, value: object) -> float:
    """Check one of the fields of :class:`Misalignment`."""
    unit, most, meant = ("rad", _WIDEST, "degrees") if name == "shaft_angle" else ("m", _LONGEST, "mm")
    if name == "pivot":
        most = _FARTHEST
    number = finite(name, value, unit)
    if abs(number) <= most:
        return number
    smaller = math.radians(number) if meant == "degrees" else 1e-3 * number
    hint = f" (in {meant}? {name}={smaller:.4g} would be valid)" if abs(smaller) <= most else ""
    kind = "" if name == "pivot" else ", as errors of alignment are"
    raise ValueError(f"{name} must be at most {most:g} {unit} either way{kind}; got {number!r} {unit}{hint}")


ALIGNED = Misalignment()
"""Both gears where they belong."""


@dataclass(frozen=True)
class Ellipse:
    """Contact ellipse of two elastic bodies pressed together (Hertz).

    Attributes
    ----------
    long, short : float
        Semi-axes [m].
    approach : float
        By which bodies come nearer [m].
    pressure : float
        In the middle [Pa].
    """

    long: float
    short: float
    approach: float
    pressure: float


@dataclass(frozen=True)
class UnloadedContact:
    """Contact of a pinion and a face gear cut by a shaper with more teeth, without load.

    Parameters
    ----------
    drive : Drive
        Its `shaper_teeth` exceed `pinion_teeth`.
    misalignment : Misalignment
        Default: none.

    Raises
    ------
    TypeError, ValueError
        If contact is along lines, if the gears do not touch on their flanks anywhere, or only at an edge of the tooth,
        naming which.

    Examples
    --------
    >>> contact = UnloadedContact(Drive(26, 130, 3.175e-3, shaper_teeth=27))
    >>> round(1e3 * contact.position, 3), round(contact.contact_ratio, 6)
    (206.375, 1.557364)
    """

    drive: Drive
    misalignment: Misalignment = ALIGNED

    def __post_init__(self) -> None:
        for name, kind in (("drive", Drive), ("misalignment", Misalignment)):
            if not isinstance(getattr(self, name), kind):
                raise TypeError(f"{name} must be a {kind.__name__}, got {getattr(self, name)!r}")
        if self.drive.has_line_contact:
            raise ValueError(
                f"drive.shaper_teeth must exceed pinion_teeth={self.drive.pinion_teeth} for contact at a point; with "
                "as many teeth it is along lines"
            )
        fault = self._fault()
        if fault is None:
            return
        drive, aligned = self.drive, _unchecked(self.drive, self._share(0.0))._fault()
        if aligned is not None:
            raise ValueError(
                f"pinion_teeth={drive.pinion_teeth}, gear_teeth={drive.gear_teeth}, shaper_teeth={drive.shaper_teeth} "
                f"leave aligned gears no {aligned}; take other tooth numbers"
            )
        raise ValueError(f"misalignment leaves no {fault}; {self.misalignment!r}{self._hint()}")

    def _fault(self) -> str | None:
        """Say what the misalignment leaves none of, if it does."""
        if not self._rising:
            return (
                "normal of the flank that touches the pinion's base circle: its teeth and those of the gear do not "
                "meet"
            )
        lowest, highest = self._rolls
        if lowest < highest:
            return None
        return f"contact on the flank: at −y_p = {1e3 * self._radius_of(lowest):.3f} mm it is {self._beyond(lowest)}"

    def _share(self, share: float) -> Misalignment:
        """Return so much of the misalignment, about the same pivot."""
        given = self.misalignment
        sizes = {
            part.name: share * getattr(given, part.name) for part in fields(given) if part.name != "pivot"
        }
        return Misalignment(**sizes, pivot=given.pivot)

    def _hint(self) -> str:
        """How much of the misalignment would leave contact, as an end of a message; none of it does."""
        possible, beyond = 0.0, 1.0
        for _ in range(_HALVINGS):
            share = 0.5 * (possible + beyond)
            touches = _touches(self.drive, self._share(share))
            possible, beyond = (share, beyond) if touches else (possible, share)
        if possible == 0.0:
            return ""
        # Downwards, so that who follows it has contact.
        digits = _DIGITS - 1 - math.floor(math.log10(possible))
        share = math.floor(possible * 10.0**digits) / 10.0**digits
        return (
            f" ({share:.{_DIGITS}g} of it would leave some)"
            if _touches(self.drive, self._share(share))
            else ""
        )

    # --- where ------------------------------------------------------------------------------------------------

    @cached_property
    def pressure_angle(self) -> float:
        """Local pressure angle q of the contact [rad], the same all through the mesh."""
        # Of several the one next to the nominal pressure angle.
        return min(self._rising, key=lambda q: abs(q - self.drive.pressure_angle))

    @cached_property
    def _rising(self) -> tuple[float, ...]:
        """Those of the roots where flanks touch from outside."""
        return tuple(self._root(change) for change in self._changes if change.rises)

    @property
    def roots(self) -> tuple[float, ...]:
        """All local pressure angles at which a normal touches the pinion's base circle [rad], ascending.

        Where the distance rises through it flanks touch from outside; where it falls they would have to cross.
        """
        return tuple(self._root(change) for change in self._changes)

    @cached_property
    def _changes(self) -> tuple[_Change, ...]:
        values = self.residual(_ANGLES)
        # Not a number where the gear cannot turn a normal square to the pinion: no change of sign.
        (found,) = np.nonzero(values[:-1] * values[1:] <= 0.0)
        return tuple(
            _Change(float(_ANGLES[i]), float(_ANGLES[i + 1]), values[i] < values[i + 1]) for i in found
        )

    def _root(self, change: _Change) -> float:
        return root(lambda q: float(self.residual(q)), change.first, change.last)

    @property
    def position(self) -> float:
        """Coordinate u at which the flank touches [m], the same all through the mesh, see :attr:`face`."""
        return float(self._region.position(self.pressure_angle))

    @property
    def face(self) -> tuple[float, float]:
        """Least and largest coordinate u of a point of the flank [m].

        u is where the shaper makes it: along its axis, from where the axes of shaper and gear meet, to that point
        (u_s of (3-5)). The limits of the tooth, L1 and L2 (`Drive.inner_limit`, `outer_limit`), lie on the gear plane
        instead: they are the distances −y_p of its edges from the gear's axis over sin γ, and equal u between shafts at
        90° only. Otherwise an edge has another u at each height of the tooth, and all of the tooth lies between these.
        """
        low, high = (float(self._region.position(q)) for q in self.face_angles)
        return low, high

    @cached_property
    def face_angles(self) -> tuple[float, float]:
        """Least and largest local pressure angle q of a point of the flank [rad]."""
        shaper, region = self._shaper, self._region
        rolls = (0.0, shaper.shaper_tip_roll)
        first = min(region.edge_angle(shaper.flank_start, roll) for roll in rolls)
        return first, max(region.edge_angle(shaper.outer_radius, roll) for roll in rolls)

    # --- when -------------------------------------------------------------------------------------------------

    @property
    def contact_ratio(self) -> float:
        """Mesh periods that a pair of teeth touches."""
        lowest, highest = self._rolls
        return (highest - lowest) * self._shaper.pinion_teeth / (2.0 * math.pi)

    @cached_property
    def _rolls(self) -> tuple[float, float]:
        """Roll angles θs of the shaper at which contact begins at the gear's tooth top, and ends at the pinion's tip.

        Between the edges of the face; where the pinion's base circle or the shaper's tip comes first, there.
        """
        q, region, shaper = self.pressure_angle, self._region, self._shaper
        start = float(self._line(q)[2])
        base, own = shaper.base_radius, self.drive.base_radius
        lowest = max(0.0, -start / base)
        highest = min((own * self.drive.pinion_tip_roll - start) / base, shaper.shaper_tip_roll)

        def above(roll: float) -> float:
            return float(region.depth(q, roll)) - shaper.tooth_top_distance

        def inside(roll: float) -> float:
            return self._radius_of(roll) - shaper.flank_start

        def outside(roll: float) -> float:
            return shaper.outer_radius - self._radius_of(roll)

        for function in (above, inside, outside):
            lowest, highest = _where_positive(function, lowest, highest)
        return lowest, highest

    def _radius_of(self, roll: float) -> float:
        """−y_p of a point on the line of contact where it was made [m]."""
        return float(self._region.radial_position(self.pressure_angle, roll))

    def _beyond(self, roll: float) -> str:
        radius, shaper = self._radius_of(roll), self._shaper
        if radius < shaper.flank_start:
            return f"inside the inner edge at {1e3 * shaper.inner_radius:.3f} mm, where an edge bears"
        if radius > shaper.outer_radius:
            return f"outside the outer edge at {1e3 * shaper.outer_radius:.3f} mm, where an edge bears"
        return "off the height of the tooth, where its top or the pinion's tip bears"

    # --- the pair of gears ------------------------------------------------------------------------------------

    @property
    def _shaper(self) -> Drive:
        return self.drive.generating

    @property
    def _region(self) -> ContactRegion:
        return self._shaper.contact_region

    @cached_property
    def _gear_axis(self) -> Vector:
        supplement = math.pi - self.drive.shaft_angle
        return 0.0, math.sin(supplement), math.cos(supplement)

    @cached_property
    def _pinion_axis(self) -> tuple[Vector, Vector]:
        """A point of the pinion's axis, and its direction."""
        given, offset = self.misalignment, self.drive.axis_offset
        pivot = offset / math.tan(self.drive.shaft_angle) if given.pivot is None else given.pivot
        x, y, z = (-given.gear_axial * part for part in self._gear_axis)
        at = (given.offset + x, -offset + y, pivot + z)
        return at, (0.0, math.sin(given.shaft_angle), math.cos(given.shaft_angle))

    def turn(self, q: ArrayLike) -> FloatArray:
        """ψ, by which the gear turns from where the shaper made q until the normal is square to the pinion [rad]."""
        normal, axis, k = _normal(q), self._pinion_axis[1], self._gear_axis
        along = _dot(normal, k) * _dot(k, axis)
        cosine, sine = _dot(normal, axis) - along, _dot(_cross(k, normal), axis)
        # cosine cos ψ + sine sin ψ + along = 0, of which the smaller root; not a number where there is none.
        size, phase = np.hypot(cosine, sine), np.arctan2(sine, cosine)
        with np.errstate(invalid="ignore"):
            swing = np.arccos(-along / np.where(size > 0.0, size, 1.0))
        both = np.stack([phase + swing, phase - swing])
        both = np.where(size > 0.0, (both + math.pi) % (2.0 * math.pi) - math.pi, 0.0)
        return np.asarray(np.where(np.abs(both[0]) < np.abs(both[1]), *both), dtype=float)

    def _line(self, q: ArrayLike) -> tuple[Vector, FloatArray, FloatArray]:
        """Lines of action at q: directions n, distances from the pinion's axis, places of θs = 0.

        These are measured along the line from its foot on the pinion's base circle [m]; a roll angle θs adds r_bs θs.
        """
        turn = self.turn(q)
        base = self._shaper.base_radius
        made_at = (base * np.sin(q), -base * np.cos(q), self._region.position(np.asarray(q)))
        (x, y, z), normal = (_rotated(vector, self._gear_axis, turn) for vector in (made_at, _normal(q)))
        at, axis = self._pinion_axis
        away = (x - at[0], y - at[1], z - at[2])
        return normal, np.asarray(_dot(away, _cross(axis, normal))), np.asarray(_dot(away, normal))

    def residual(self, q: ArrayLike) -> FloatArray:
        """A(q), by how much normals pass the pinion's base circle at a distance [m]."""
        return self._line(q)[1] - self.drive.base_radius

    # --- gap and curvature ------------------------------------------------------------------------------------

    def gap(self, position: ArrayLike) -> FloatArray:
        """Gap between the flanks along the normal, in slices along the face, the same at every rotation [m].

        Parameters
        ----------
        position : array_like
            u along the shaper's axis [m], between the ends of :attr:`face`.

        Returns
        -------
        ndarray, of the shape of `position`
            0 at :attr:`position`; a slice is what has one local pressure angle q.

        Raises
        ------
        TypeError, ValueError
            Not numeric, not finite, or beyond the face.
        """
        u, (low, high) = finite_array("position", position, "m"), self.face
        outside = (u < low * (1.0 - _ROUNDING)) | (u > high * (1.0 + _ROUNDING))
        if np.any(outside):
            bad = float(u[outside].flat[0])
            meant = 1e-3 * bad
            hint = f" (in mm? {meant:.6g} m would be valid)" if low <= meant <= high else ""
            raise ValueError(
                f"position must lie in [{low:.6g}, {high:.6g}] m, the coordinates u along the shaper's axis where the "
                f"flank has points; got {bad:.6g} m{hint}"
            )
        angles = np.arccos(float(self._region.position(0.0)) / u)
        return self._offset(angles) - self._offset(self.pressure_angle)

    def _offset(self, q: ArrayLike) -> FloatArray:
        """Gap of the slice at q but for a constant: place of the gear's tangent plane less that of the pinion's [m]."""
        shaper = self._shaper
        # At one rotation of the gear, θs = q + ψ/m but for a constant; θ1 is the direction of n about the pinion.
        gear = self._line(q)[2] + shaper.base_radius * (np.asarray(q) + self.turn(q) / shaper.speed_ratio)
        return np.asarray(gear - self.drive.base_radius * self.direction(q), dtype=float)

    def direction(self, q: ArrayLike) -> FloatArray:
        """Angle about the pinion's axis of the normals at q, which is its roll angle θ1 but for a rotation [rad]."""
        normal = self._line(q)[0]
        across = _cross(self._pinion_axis[1], (1.0, 0.0, 0.0))
        return np.asarray(np.arctan2(-_dot(normal, across), -normal[0]), dtype=float)

    def own_roll(self, q: ArrayLike, roll: ArrayLike) -> FloatArray:
        """Roll angle of the pinion's involute next to the point (q, θs) of the gear's flank [rad]."""
        return np.asarray(
            (self._line(q)[2] + self._shaper.base_radius * np.asarray(roll)) / self.drive.base_radius
        )

    @property
    def principal_curvatures(self) -> FloatArray:
        """Principal curvatures of the gap in the middle of the path, ascending, shape (2,) [1/m]."""
        return self.curvatures(0.5 * sum(self._rolls))

    def curvatures(self, roll: float) -> FloatArray:
        """Principal curvatures of the gap between pinion and gear about a point of the path, ascending [1/m].

        Parameters
        ----------
        roll : float
            θs of the shaper there [rad], between the two :attr:`rolls`.

        Returns
        -------
        ndarray, shape (2,)
            The smaller one is that along the face, nearly.

        Raises
        ------
        TypeError, ValueError
            `roll` is not a number, or not on the path.
        """
        roll = within("roll", roll, *self._rolls, "rad")
        return np.asarray(np.linalg.eigvalsh(self._curvature_tensor(roll)), dtype=float)

    @property
    def rolls(self) -> FloatArray:
        """Roll angles θs of the shaper at the ends of the path of contact, ascending, shape (2,) [rad]."""
        return np.array(self._rolls)

    def _curvature_tensor(self, roll: float) -> FloatArray:
        """Second derivatives of the gap in the tangent plane, along the pinion's profile and its axis, (2, 2) [1/m]."""
        q, base = self.pressure_angle, self._shaper.base_radius
        normal, _, start = self._line(q)
        axis = np.array(self._pinion_axis[1])
        profile = np.cross(axis, normal)
        shaper_axis = np.array(_rotated((0.0, 0.0, 1.0), self._gear_axis, self.turn(q)))
        shaper_profile = np.cross(shaper_axis, normal)
        # The shaper touches the gear along a line at β to its axis, and is flatter than the gear across it by κ.
        m, supplement = self._shaper.speed_ratio, math.pi - self.drive.shaft_angle
        p, k, t = m * math.sin(supplement), 1.0 - m * math.cos(supplement), math.tan(q)
        rest = k * t * ((1.0 - k) * roll + k * t) - (p * math.cos(q)) ** 2 * roll * (roll - t)
        kappa = ((k * t / roll) ** 2 + (p * math.cos(q)) ** 2) * roll / (base * rest)
        beta = math.atan2(roll * p * math.cos(q), k * t)
        across = math.cos(beta) * shaper_profile - math.sin(beta) * shaper_axis
        pairs = (
            (1.0 / (float(start) + base * roll), profile),
            (-1.0 / (base * roll), shaper_profile),
            (kappa, across),
        )
        frame = np.stack([profile, axis])
        return np.asarray(sum(size * np.outer(frame @ v, frame @ v) for size, v in pairs), dtype=float)

    def hertz(self, force: float, modulus: float) -> Ellipse:
        """Contact ellipse under a force, in the middle of the path.

        Parameters
        ----------
        force : float
            Along the normal [N].
        modulus : float
            E* [Pa]: 1/E* = (1 − ν1²)/E1 + (1 − ν2²)/E2.

        Returns
        -------
        Ellipse
            By Hertz: the gap is taken for a paraboloid, which hides that it is not symmetric; :meth:`marking_band`
            uses the true one.

        Raises
        ------
        TypeError, ValueError
            If an argument is not a number greater than 0, `force` is below 1e-12 N, `modulus` above 1e15 Pa, or the
            ellipse would be longer than the gear.
        """
        force, modulus = positive("force", force, "N"), positive("modulus", modulus, "Pa")
        if force < _LEAST_FORCE:
            raise ValueError(f"force must be at least {_LEAST_FORCE:g} N, got {force!r} N")
        if modulus > _LARGEST_MODULUS:
            raise ValueError(f"modulus must be at most {_LARGEST_MODULUS:g} Pa, got {modulus!r} Pa")
        smaller, larger = self.principal_curvatures.tolist()
        ellipse = _hertz(smaller, larger, force, modulus)
        if ellipse.long > self.drive.outer_radius:
            raise ValueError(
                f"modulus must be in Pa (some 1.1e11 for steel on steel) and force in N; with modulus={modulus!r} and "
                f"force={force!r} the contact ellipse would have a semi-axis of {ellipse.long:.3g} m, more than the "
                "gear's radius"
            )
        return ellipse

    def marking_band(self, depth: float) -> tuple[float, float]:
        """Find the band along the face where the gap is at most the thickness of marking compound.

        Parameters
        ----------
        depth : float
            Thickness [m], such as 6.35e-6.

        Returns
        -------
        inner, outer : float
            u [m], cut off at the edges of the flank as they are where the path of contact has its middle.

        Raises
        ------
        TypeError, ValueError
            If `depth` is not a number of 0 or more.
        """
        depth = nonnegative("depth", depth, "m")
        shaper, middle = self._shaper, self.pressure_angle
        roll = 0.5 * sum(self._rolls)
        here = float(self._offset(middle))

        def excess(q: float) -> float:
            return float(self._offset(q)) - here - depth

        ends = []
        for edge in (shaper.flank_start, shaper.outer_radius):
            q = self._region.edge_angle(edge, roll)
            ends.append(q if excess(q) <= 0.0 else float(brentq(excess, middle, q, xtol=1e-15)))
        return float(self._region.position(ends[0])), float(self._region.position(ends[1]))

    # --- what errors do ---------------------------------------------------------------------------------------

    def window(self, error: str) -> tuple[float, float]:
        """Range of one error of alignment in which contact stays on the flank, all others as they are.

        Parameters
        ----------
        error : {"offset", "gear_axial", "shaft_angle"}
            Field of `misalignment` that is varied.

        Returns
        -------
        low, high : float
            Of the error, in its unit: beyond them an edge bears, or nothing. To 1e-9 of the module, or of a radian.

        Raises
        ------
        ValueError
            If there is no such error.

        Examples
        --------
        >>> low, high = UnloadedContact(Drive(26, 130, 3.175e-3, shaper_teeth=27)).window("offset")
        >>> round(1e6 * low, 1), round(1e6 * high, 1)
        (-1098.3, 265.5)
        """
        one_of("error", error, ("offset", "gear_axial", "shaft_angle"))
        start, module = getattr(self.misalignment, error), self.drive.module
        unit, most = (1.0, _WIDEST) if error == "shaft_angle" else (module, min(10.0 * module, _LONGEST))

        def holds(value: float) -> bool:
            return abs(value) <= most and _touches(self.drive, replace(self.misalignment, **{error: value}))

        ends = []
        for sense in (-1.0, 1.0):
            inside, outside = 0.0, 1e-6 * unit
            while holds(start + sense * outside) and outside < most:
                inside, outside = outside, 2.0 * outside
            while outside - inside > 1e-9 * unit:
                middle = 0.5 * (inside + outside)
                inside, outside = (middle, outside) if holds(start + sense * middle) else (inside, middle)
            ends.append(start + sense * inside)
        return ends[0], ends[1]

    @property
    def backlash(self) -> float:
        """Play of the teeth along the pitch circle that misalignment opens [m]; less than none if they bind.

        j = 2C (inv α − inv α'), C² = ΔE² + (B + Δq sin γ)², cos α' = B cos α/C: standard teeth have none at C = B.
        Thinning a tooth by s on the pitch circle adds s C/B. Errors of angle are left out.
        """
        offset, alpha = self.drive.axis_offset, self.drive.pressure_angle
        centre = math.hypot(
            self.misalignment.offset,
            offset + self.misalignment.gear_axial * math.sin(self.drive.shaft_angle),
        )
        working = math.acos(offset * math.cos(alpha) / centre)
        return 2.0 * centre * (involute(alpha) - involute(working))


@lru_cache(maxsize=64)
def aligned_contact(drive: Drive) -> UnloadedContact:
    """Contact of aligned gears, found once for all that follows it."""
    return UnloadedContact(drive)


@dataclass(frozen=True)
class PointPath(TimedPairs):
    """Path of the unloaded contact of aligned gears: each pair at one place along the face, on the line of action.

    Parameters
    ----------
    drive : Drive
        Its `shaper_teeth` exceed `pinion_teeth`.
    contact_ratio : float, optional
        Mesh periods that a tooth pair stays in mesh, 1 or more; that of the contact itself is
        `UnloadedContact(drive).contact_ratio`. Default Tregold's, `drive.contact_ratio`, which is nearly the same.

    Raises
    ------
    TypeError, ValueError
        `contact_ratio` is not valid for the drive, or contact is along lines.
    """

    def __post_init__(self) -> None:
        _ = self._contact
        super().__post_init__()

    @property
    def _contact(self) -> UnloadedContact:
        return aligned_contact(self.drive)

    @property
    def pitch_passage(self) -> float:
        """Mesh periods since entry at which a pair passes the pitch point, where the roll angle is tan α_c."""
        first, last = self._contact.rolls
        return float((math.tan(self.drive.pressure_angle) - first) / (last - first)) * self.contact_ratio

    def _states(self, ages: FloatArray, in_mesh: NDArray[np.bool_]) -> PairStates:
        first, last = self._contact.rolls
        roll = first + (last - first) * ages / self.contact_ratio
        x, y, _ = np.moveaxis(self.drive.contact_region.point(self._contact.pressure_angle, roll), -1, 0)
        none = np.zeros(ages.shape)
        return PairStates(
            np.asarray(in_mesh),
            np.where(in_mesh, np.hypot(x, y), none),
            np.where(in_mesh, np.arctan2(x, -y), none),
            none,
        )


def _touches(drive: Drive, misalignment: Misalignment) -> bool:
    """Whether a misalignment leaves contact, without the message that says why it does not."""
    return _unchecked(drive, misalignment)._fault() is None


def _unchecked(drive: Drive, misalignment: Misalignment) -> UnloadedContact:
    """Return the contact of a misalignment that may leave none."""
    contact = object.__new__(UnloadedContact)
    keep(contact, drive=drive, misalignment=misalignment)
    return contact


def _normal(q: ArrayLike) -> Vector:
    """N(q), unit normals of the flank where the shaper makes it."""
    return -np.cos(q), -np.sin(q), 0.0


def _dot(one: Vector, other: Vector) -> Any:
    return one[0] * other[0] + one[1] * other[1] + one[2] * other[2]


def _cross(one: Vector, other: Vector) -> Vector:
    (a, b, c), (x, y, z) = one, other
    return b * z - c * y, c * x - a * z, a * y - b * x


def _rotated(vector: Vector, axis: Vector, angle: FloatArray) -> Vector:
    """Rotate a vector about a unit axis (Rodrigues)."""
    cosine, sine = np.cos(angle), np.sin(angle)
    along = _dot(vector, axis) * (1.0 - cosine)
    x, y, z = (
        own * cosine + square * sine + along * part
        for own, square, part in zip(vector, _cross(axis, vector), axis, strict=True)
    )
    return x, y, z


def _where_positive(function: Callable[[float], float], low: float, high: float) -> tuple[float, float]:
    """Part of an interval where a monotonic function is not negative; empty, (end, end), if it is nowhere so."""
    if low >= high:
        return low, high
    first, last = function(low), function(high)
    if first >= 0.0 and last >= 0.0:
        return low, high
    if first < 0.0 and last < 0.0:
        return (low, low) if first > last else (high, high)
    place = float(brentq(function, low, high, xtol=1e-16, rtol=8.9e-16))
    return (place, high) if first < 0.0 else (low, place)


def _hertz(smaller: float, larger: float, force: float, modulus: float) -> Ellipse:
    """Ellipse for two principal curvatures of the gap [1/m], both positive.

    Semi-axes follow from Carlson's integrals (Johnson, Contact Mechanics, section 4.2): a curvature is
    F/(πE*) R_D(0, other², own²) of the semi-axes, the approach 3F/(2πE*) R_F(0, long², short²).
    """

    def excess(logarithm: float) -> float:
        k = math.exp(logarithm)  # (short/long)²
        return math.log(float(elliprd(0.0, 1.0, k)) / float(elliprd(0.0, k, 1.0))) - math.log(
            larger / smaller
        )

    k = math.exp(float(brentq(excess, -80.0, 0.0, xtol=1e-14))) if larger > smaller else 1.0
    scale = force / (math.pi * modulus)
    long = (scale * float(elliprd(0.0, k, 1.0)) / smaller) ** (1.0 / 3.0)
    short = long * math.sqrt(k)
    approach = 1.5 * scale * float(elliprf(0.0, long**2, short**2))
    return Ellipse(long, short, approach, 1.5 * force / (math.pi * long * short))
