"""Teeth of pinion and face gear as plates of their true thickness, and what their flanks give way next to the contact.

A tooth is as thick against height and along the face as its flanks make it. Next to the contact the flanks give way
besides, as two cylinders do that touch along a line. That depends on the load by a logarithm, and is taken here for a
constant per length of face, that at a Hertzian pressure of E/200: of steel 1 GPa. All of a tooth's compliance is so in
inverse proportion to E, and the contact depends on load over E alone.

Left out are the fillets, the compression of the tooth along its height, and that the local compliance grows as the load
falls. What the root of a tooth does to the gear's body, and so to its neighbours, is left to c_f of (7-2).
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from facegear.geometry.drive import Drive
from facegear.mechanics.cantilever_plate import ACROSS, ALONG, CantileverPlate, Load
from facegear.mechanics.properties import Material
from facegear.mechanics.slices import Slices
from facegear.support.types import FloatArray

# Hertzian pressure for which the local compliance is taken, over E: 1 GPa with steel.
_PRESSURE = 0.005
# No tooth is thinner than so many modules: next to R2 its top comes to a point.
_THINNEST = 0.05
# Points of the involute between which its chord is interpolated.
_TABLE = 2000


@dataclass(frozen=True)
class Tooth(ABC):
    """A tooth as a plate, and where slices press on it.

    Parameters
    ----------
    slices : Slices
    material : Material
    across, along : int
        Polynomials of its plate, see :class:`CantileverPlate`.
    """

    slices: Slices
    material: Material
    across: int = ACROSS
    along: int = ALONG

    @property
    @abstractmethod
    def height(self) -> float:
        """From root to top [m]."""

    @abstractmethod
    def thickness(self, height: FloatArray, position: FloatArray) -> FloatArray:
        """Thickness at heights above the root and coordinates u, arrays of one shape [m]."""

    @abstractmethod
    def load(self, q: FloatArray, roll: FloatArray) -> Load:
        """Load on what the shaper makes at local pressure angles q and roll angles θs, arrays of one shape [rad]."""

    @cached_property
    def plate(self) -> CantileverPlate:
        """Plate of this thickness, as wide as the face."""
        elastic = self.material.youngs_modulus, self.material.poissons_ratio
        return CantileverPlate(
            self.height, face(self.slices), self.thickness, *elastic, self.across, self.along
        )


def face(slices: Slices) -> tuple[float, float]:
    """Coordinates u of the inner and outer end of the face at the height of the shaper's pitch circle [m].

    With all slices that come in mesh, and without what lies inside of all of the flank: the edge may not reach to that
    height.
    """
    drive = slices.drive.generating
    offset = drive.pitch_radius / math.tan(drive.shaft_angle)
    used = [slices.position(end) for end in slices.ends(slices.breakpoints)]
    start = drive.flank_start / math.sin(drive.shaft_angle) + offset
    inner = max(min(start, float(used[0].min())), slices.contact.face[0])
    return inner, max(drive.outer_limit + offset, float(used[1].max()))


@dataclass(frozen=True)
class PinionTooth(Tooth):
    """Tooth of the pinion, as wide as the face gear's.

    Its thickness is the chord of the involute; below the base circle, where that lies above the root, the flanks are
    radii. The root is where they come to the dedendum circle.
    """

    @property
    def _drive(self) -> Drive:
        return self.slices.drive

    @property
    def _half_angle(self) -> float:
        """Half the angle of the tooth on the base circle [rad]."""
        return math.pi / self._drive.pinion_teeth - self._drive.space_half_angle

    def _flank(self, roll: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Distance of the involute from the axis, along the middle of the tooth, and half the chord there [m]."""
        radius, half = (
            self._drive.base_radius * np.hypot(1.0, roll),
            self._half_angle - roll + np.arctan(roll),
        )
        return radius * np.cos(half), radius * np.sin(half)

    @cached_property
    def _profile(self) -> tuple[FloatArray, FloatArray]:
        """Involute from the base circle or the root to the tip, as :meth:`_flank` has it."""
        drive = self._drive
        lowest = math.sqrt(max((drive.dedendum_radius / drive.base_radius) ** 2 - 1.0, 0.0))
        return self._flank(np.linspace(lowest, drive.pinion_tip_roll, _TABLE))

    @cached_property
    def _root(self) -> float:
        """Distance of the root from the axis [m]."""
        heights, halves = self._profile
        return self._drive.dedendum_radius / math.hypot(1.0, float(halves[0] / heights[0]))

    @property
    def height(self) -> float:
        """From the root to the chord of the tip [m]."""
        return float(self._profile[0][-1] - self._root)

    def thickness(self, height: FloatArray, position: FloatArray) -> FloatArray:
        """Chord, the same all along the face [m]."""
        heights, halves = self._profile
        above = height + self._root
        half = np.where(
            above < heights[0], above * (halves[0] / heights[0]), np.interp(above, heights, halves)
        )
        return np.asarray(np.maximum(2.0 * half, _THINNEST * self._drive.module))

    def load(self, q: FloatArray, roll: FloatArray) -> Load:
        """Load along a tangent of the base circle."""
        own = self.slices.contact.lines.own_roll(q, roll)
        height, half = self._flank(own)
        # Against a line square to the middle of the tooth, towards the root.
        direction = own - self._half_angle
        position = np.broadcast_to(self._drive.generating.contact_region.position(q), own.shape)
        return Load(
            height - self._root, position, np.cos(direction), -half * np.sin(direction), np.zeros_like(own)
        )


@dataclass(frozen=True)
class GearTooth(Tooth):
    """Tooth of the face gear, from the shaper's tip circle, its root, to its top.

    Height and u are those at which the shaper makes a point. That the tooth turns by a few degrees about the gear's
    axis meanwhile counts in its thickness and in the direction of the load, not in these. Below the flank, where the
    fillet is, it is as thick as at the end of the flank. Its ends are taken square to the root.
    """

    @property
    def _drive(self) -> Drive:
        return self.slices.drive.generating

    @property
    def height(self) -> float:
        """From the root to the top [m]."""
        return self._drive.shaper_tip_radius - self._drive.tooth_top_distance

    def _turned(
        self, q: FloatArray, roll: FloatArray, x: FloatArray, outwards: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Components of a vector square to the middle of the tooth, and outwards in the gear's plane.

        From those, x and −y_p, where its point is made.
        """
        turn = self._drive.speed_ratio * (q - roll - self._drive.space_half_angle)
        return x * np.cos(turn) - outwards * np.sin(turn), x * np.sin(turn) + outwards * np.cos(turn)

    def _depth(self, q: FloatArray, roll: FloatArray) -> FloatArray:
        """Distance from the shaper's axis, in the plane of both axes [m]."""
        return np.asarray(self._drive.base_radius * (np.cos(q) + roll * np.sin(q)))

    def _half_thickness(self, q: FloatArray, roll: FloatArray) -> FloatArray:
        drive, region = self._drive, self._drive.contact_region
        outwards = region.position(q) * math.sin(drive.shaft_angle)
        outwards = outwards - self._depth(q, roll) * math.cos(drive.shaft_angle)
        return self._turned(q, roll, drive.base_radius * (np.sin(q) - roll * np.cos(q)), outwards)[0]

    def thickness(self, height: FloatArray, position: FloatArray) -> FloatArray:
        """Chord of the generated flanks [m]."""
        drive = self._drive
        q = np.arccos(float(drive.contact_region.position(0.0)) / position)
        roll = ((drive.shaper_tip_radius - height) / drive.base_radius - np.cos(q)) / np.sin(q)
        half = self._half_thickness(q, np.clip(roll, 0.0, drive.shaper_tip_roll))
        return np.asarray(np.maximum(2.0 * half, _THINNEST * drive.module))

    def load(self, q: FloatArray, roll: FloatArray) -> Load:
        """Load along the normal of the generated flank, into the tooth."""
        drive = self._drive
        sine, cosine = math.sin(drive.shaft_angle), math.cos(drive.shaft_angle)
        # The normal is −(cos q, sin q, 0) where it is made.
        across, outwards = self._turned(q, roll, -np.cos(q), -np.sin(q) * cosine)
        axial = -np.sin(q) * sine
        upwards, along = axial * sine + outwards * cosine, outwards * sine - axial * cosine
        half = self._half_thickness(q, roll)
        height = drive.shaper_tip_radius - self._depth(q, roll)
        position = np.broadcast_to(drive.contact_region.position(q), half.shape)
        return Load(height, position, across, -half * upwards, -half * along)


def local_compliance(slices: Slices, material: Material) -> float:
    """Give way of both flanks next to the contact, per load per length of face, λ [m²/N].

    Two cylinders of one material come nearer by p 2(1 − ν²)/(πE) [ln(4 d1 d2/a²) − ν/(1 − ν)], with the half width a of
    the contact and depths d, here as far as the middle of the teeth (Weber and Banaschek, Formänderung und
    Profilrücknahme bei gerad- und schrägverzahnten Rädern, 1953; Johnson, Contact Mechanics, section 5.6). a is that
    at a Hertzian pressure p0 of 0.005 E, with steel 1 GPa, in the middle of the path of the unloaded contact: as a =
    4 p0/(κE'), E' = E/(1 − ν²), it does not depend on E, and λ does by 1/E' alone. With the drive of the examples λ is
    1.55e-11 m²/N.
    """
    contact, stiffness = slices.contact, material.youngs_modulus / (1.0 - material.poissons_ratio**2)
    pressure = _PRESSURE * material.youngs_modulus
    half_width = 4.0 * pressure / (float(contact.principal_curvatures[1]) * stiffness)
    q, roll = np.array(contact.pressure_angle), np.array(0.5 * contact.rolls.sum())
    loads = [tooth.load(q, roll) for tooth in teeth_of(slices, material)]
    # Half the thickness across is |up| over the sine of the force, and the depth longer by its cosine.
    depths = [
        float(np.hypot(load.up, load.along) / np.sqrt(1.0 - load.across**2) / abs(load.across))
        for load in loads
    ]
    logarithm = math.log(4.0 * math.prod(depths) / half_width**2)
    poissons_ratio = material.poissons_ratio
    return 2.0 / (math.pi * stiffness) * (logarithm - poissons_ratio / (1.0 - poissons_ratio))


@lru_cache(maxsize=64)
def teeth_of(slices: Slices, material: Material) -> tuple[Tooth, Tooth]:
    """Teeth of the pinion and of the face gear, of one material."""
    return PinionTooth(slices, material), GearTooth(slices, material)
