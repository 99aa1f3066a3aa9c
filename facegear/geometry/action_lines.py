"""Lines of action: normals of the face gear's flank, and which of them touch the pinion's base circle.

A point of the face gear's flank is named by the local pressure angle q = φ + θ0s + θs where the shaper made it and by
its roll angle θs. At constant q the point being made moves along its own normal N = −(cos q, sin q, 0), which stands
still (:mod:`facegear.symbolic.point_contact` derives it). So whether a normal of the flank touches the pinion's base
circle, which is all that contact with an involute asks for, does not depend on θs: for any position of two rigid gears
it is one equation A(q) = 0.

Coordinates are those of the shaper at rest in space: z along its axis outwards, the face gear's axis along
k = (0, sin γ_m, cos γ_m), γ_m = 180° − γ.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from facegear.geometry.drive import Drive
from facegear.geometry.misalignment import Misalignment
from facegear.geometry.vectors import Vector, cross, dot, rotated
from facegear.support.roots import root
from facegear.support.types import FloatArray

# Local pressure angles between which contact is looked for [rad].
_ANGLES = np.linspace(-1.5, 1.5, 601)
_ANGLES.setflags(write=False)


class _Change(NamedTuple):
    """Angles between which normals begin or cease to touch the pinion's base circle."""

    first: float
    last: float
    rises: bool


@dataclass(frozen=True)
class ActionLines:
    """Lines of action of a pinion and a face gear cut by a shaper with more teeth, in one position to each other.

    Parameters
    ----------
    drive : Drive
        Its `shaper_teeth` exceed `pinion_teeth`.
    misalignment : Misalignment
    """

    drive: Drive
    misalignment: Misalignment

    @cached_property
    def rising(self) -> tuple[float, ...]:
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
        along = dot(normal, k) * dot(k, axis)
        cosine, sine = dot(normal, axis) - along, dot(cross(k, normal), axis)
        # cosine cos ψ + sine sin ψ + along = 0, of which the smaller root; not a number where there is none.
        size, phase = np.hypot(cosine, sine), np.arctan2(sine, cosine)
        with np.errstate(invalid="ignore"):
            swing = np.arccos(-along / np.where(size > 0.0, size, 1.0))
        both = np.stack([phase + swing, phase - swing])
        both = np.where(size > 0.0, (both + math.pi) % (2.0 * math.pi) - math.pi, 0.0)
        return np.asarray(np.where(np.abs(both[0]) < np.abs(both[1]), *both), dtype=float)

    def at(self, q: ArrayLike) -> tuple[Vector, FloatArray, FloatArray]:
        """Lines of action at q: directions n, distances from the pinion's axis, places of θs = 0.

        These are measured along the line from its foot on the pinion's base circle [m]; a roll angle θs adds r_bs θs.
        """
        turn = self.turn(q)
        base = self.drive.generating.base_radius
        made_at = (base * np.sin(q), -base * np.cos(q), self.drive.contact_region.position(np.asarray(q)))
        (x, y, z), normal = (rotated(vector, self._gear_axis, turn) for vector in (made_at, _normal(q)))
        at, axis = self._pinion_axis
        away = (x - at[0], y - at[1], z - at[2])
        return normal, np.asarray(dot(away, cross(axis, normal))), np.asarray(dot(away, normal))

    def residual(self, q: ArrayLike) -> FloatArray:
        """A(q), by how much normals pass the pinion's base circle at a distance [m]."""
        return self.at(q)[1] - self.drive.base_radius

    def offset(self, q: ArrayLike) -> FloatArray:
        """Gap of the slice at q but for a constant: place of the gear's tangent plane less that of the pinion's [m]."""
        shaper = self.drive.generating
        # At one rotation of the gear, θs = q + ψ/m but for a constant; θ1 is the direction of n about the pinion.
        gear = self.at(q)[2] + shaper.base_radius * (np.asarray(q) + self.turn(q) / shaper.speed_ratio)
        return np.asarray(gear - self.drive.base_radius * self.direction(q), dtype=float)

    def direction(self, q: ArrayLike) -> FloatArray:
        """Angle about the pinion's axis of the normals at q, which is its roll angle θ1 but for a rotation [rad]."""
        normal = self.at(q)[0]
        across = cross(self._pinion_axis[1], (1.0, 0.0, 0.0))
        return np.asarray(np.arctan2(-dot(normal, across), -normal[0]), dtype=float)

    def own_roll(self, q: ArrayLike, roll: ArrayLike) -> FloatArray:
        """Roll angle of the pinion's involute next to the point (q, θs) of the gear's flank [rad]."""
        return np.asarray(
            (self.at(q)[2] + self.drive.generating.base_radius * np.asarray(roll)) / self.drive.base_radius
        )

    def curvature_tensor(self, q: float, roll: float) -> FloatArray:
        """Second derivatives of the gap at (q, θs) along the pinion's profile and its axis, shape (2, 2) [1/m]."""
        base = self.drive.generating.base_radius
        normal, _, start = self.at(q)
        axis = np.array(self._pinion_axis[1])
        profile = np.cross(axis, normal)
        shaper_axis = np.array(rotated((0.0, 0.0, 1.0), self._gear_axis, self.turn(q)))
        shaper_profile = np.cross(shaper_axis, normal)
        # The shaper touches the gear along a line at β to its axis, and is flatter than the gear across it by κ.
        m, supplement = self.drive.generating.speed_ratio, math.pi - self.drive.shaft_angle
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


def _normal(q: ArrayLike) -> Vector:
    """N(q), unit normals of the flank where the shaper makes it."""
    return -np.cos(q), -np.sin(q), 0.0
