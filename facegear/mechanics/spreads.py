"""Where the driving force presses: at one point, over face and root of a tooth, on the pairs in mesh.

Section 6.3 has the force at one point of the rim. A tooth takes it over its face width and hands it to the body over
the thickness of its root, and several pairs share it. Each is a set of points of the disk with their parts of the
moment (:class:`facegear.mechanics.pressed_points.Spread`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from facegear.geometry.drive import Drive
from facegear.geometry.proportions import DEDENDUM
from facegear.mechanics.contact import Contact
from facegear.mechanics.pressed_points import PressedPoints, Spread, require_spread
from facegear.support.kinds import require_kind
from facegear.support.parameters import keep, nonnegative, within
from facegear.support.quadrature import gauss_legendre
from facegear.support.types import FloatArray

# Gauss nodes along the face, across a root and in each smooth piece of the mesh period: more change nothing.
_ALONG, _ACROSS, _IN_PIECE = 12, 4, 16


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
    along, part = gauss_legendre(_ALONG)
    inner = drive.inner_radius / drive.outer_radius
    radius, share = (1.0 + inner) / 2 + (1.0 - inner) / 2 * along, part / 2
    if root_thickness == 0.0:
        return PressedPoints(radius, np.zeros(_ALONG), share)
    across, weight = gauss_legendre(_ACROSS)
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
        require_kind("contact", self.contact, Contact)
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
        require_kind("contact", self.contact, Contact)

    def points(self, drive: Drive) -> PressedPoints:
        """Contact points at Gauss nodes in each smooth piece of the mesh period."""
        self.contact.require(drive)
        nodes, weights = gauss_legendre(_IN_PIECE)
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
