"""Paths of contact of real drives, each on its own clock, for :class:`facegear.mechanics.contact.Contact`.

The dissertation sweeps the whole face in the time of Tregold's contact ratio (`ContactPath`). The sweep belongs to line
contact, which lasts more than twice as long (`line_contact`); Tregold's ratio is that of the contact at a point of a
drive cut by a larger shaper (`point_contact`), where nothing sweeps. Load leads from one to the other
(`loaded_contact`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from facegear.geometry.drive import Drive
from facegear.geometry.kinematics import ContactPath
from facegear.geometry.misalignment import ALIGNED, Misalignment
from facegear.geometry.point_path import PointPath, aligned_contact
from facegear.geometry.timed_pairs import PairStates, TimedPairs
from facegear.mechanics.loaded_contact import COMPLIANCES, LoadedContact, checked_torque
from facegear.mechanics.mesh_cycle import fit_tolerances
from facegear.mechanics.properties import STEEL, Material
from facegear.mechanics.tooth_stiffness import checked_factor
from facegear.support.kinds import require_kinds
from facegear.support.parameters import keep, one_of
from facegear.support.types import FloatArray


def line_contact(drive: Drive, contact_ratio: float | None = None) -> ContactPath:
    """Contact along lines over the whole face, as between pinion and shaper of equal teeth, on its own clock.

    Parameters
    ----------
    drive : Drive
        Its shaper has as many teeth as the pinion.
    contact_ratio : float, optional
        Mesh periods that a tooth pair stays in mesh. Default: `drive.geometric_contact_ratio`, that of the sweep.

    Raises
    ------
    TypeError, ValueError
        As :class:`ContactPath`.

    Examples
    --------
    >>> import facegear as fg
    >>> round(fg.line_contact(fg.Drive(26, 130, 3.175e-3)).contact_ratio, 3)
    3.286
    """
    return ContactPath(drive, drive.geometric_contact_ratio if contact_ratio is None else contact_ratio)


def point_contact(drive: Drive, contact_ratio: float | None = None) -> PointPath:
    """Contact of aligned gears at a point, without load, on its own clock.

    Parameters
    ----------
    drive : Drive
        Its `shaper_teeth` exceed `pinion_teeth`.
    contact_ratio : float, optional
        Mesh periods that a tooth pair stays in mesh. Default: that of :class:`UnloadedContact`.

    Raises
    ------
    TypeError, ValueError
        As :class:`PointPath`.

    Examples
    --------
    >>> import facegear as fg
    >>> round(fg.point_contact(fg.Drive(26, 130, 3.175e-3, shaper_teeth=27)).contact_ratio, 6)
    1.557364
    """
    return PointPath(drive, aligned_contact(drive).contact_ratio if contact_ratio is None else contact_ratio)


@dataclass(frozen=True)
class loaded_contact:  # noqa: N801 (one of three paths, the other two are functions)
    """Contact under a torque, on the clock of its effective contact ratio: a path for `Contact`.

    Each pair presses at the centre of its pressure. Sharing "centroid" weights pairs by the forces that they carry;
    with "each" every pair has its own stiffness over the mesh period.

    Parameters
    ----------
    torque : float
        At the pinion [N m], greater than 0.
    misalignment, compliance, correction_factor, material
        As for :class:`LoadedContact`.

    Raises
    ------
    TypeError, ValueError
        If an argument is of the wrong kind or outside its range.

    Examples
    --------
    >>> import facegear as fg
    >>> contact = fg.Contact(path=fg.loaded_contact(torque=100.0))
    >>> round(contact.ratio(fg.Drive(26, 130, 3.175e-3, shaper_teeth=27)), 4)
    2.9532
    """

    torque: float
    misalignment: Misalignment = ALIGNED
    compliance: str = "slice"
    correction_factor: float = 0.5
    material: Material = STEEL

    def __post_init__(self) -> None:
        keep(
            self,
            torque=checked_torque(self.torque),
            correction_factor=checked_factor(self.correction_factor),
        )
        require_kinds(self, misalignment=Misalignment, material=Material)
        one_of("compliance", self.compliance, tuple(COMPLIANCES))

    def of(self, drive: Drive) -> LoadedContact:
        """Contact of a drive under this torque.

        Raises
        ------
        TypeError, ValueError
            As :class:`LoadedContact`.
        """
        return LoadedContact(
            drive, self.torque, self.misalignment, self.compliance, self.correction_factor, self.material
        )

    def __call__(self, drive: Drive, contact_ratio: float | None = None) -> LoadedPath:
        """Path of a drive. Its clock is that of the load: a contact ratio cannot be given."""
        contact = self.of(drive)
        if contact_ratio is not None and contact_ratio != contact.contact_ratio:
            raise ValueError(
                f"contact_ratio must be None for loaded_contact, whose torque sets it, got {contact_ratio!r}"
            )
        return LoadedPath(drive, contact.contact_ratio, contact=contact)


@dataclass(frozen=True)
class LoadedPath(TimedPairs):
    """Path of the contact of a drive under load; the weights of its pairs are the forces that they carry.

    Parameters
    ----------
    drive : Drive
    contact_ratio : float
        That of the contact.
    contact : LoadedContact

    Raises
    ------
    TypeError, ValueError
        If less than one pair is in mesh at some instants.
    """

    contact: LoadedContact = field(kw_only=True)

    has_lengths: ClassVar[bool] = True

    @property
    def breakpoints(self) -> tuple[float, ...]:
        """Fractions of T0 between which all is smooth, ascending from 0, where a pair begins to be pressed."""
        return self.contact.breakpoints

    @property
    def pitch_passage(self) -> float:
        """Mesh periods since a pair began to be pressed at which it passes the pitch point; of aligned gears."""
        if self.contact.misalignment != ALIGNED:
            raise ValueError(
                "misalignment must be none for a pinion that is driven: its other flank would need one of its own, "
                f"got {self.contact.misalignment!r}"
            )
        angle = self.drive.pressure_angle
        return self.contact.age_of_line(angle - math.tan(angle))

    @property
    def fit_tolerances(self) -> FloatArray:
        """Relative errors that a fit of the positions may have, shape (pieces,) [-]."""
        return fit_tolerances(self.breakpoints)

    @property
    def centroid_jumps(self) -> bool:
        """Whether a pair takes up or drops its load at once, as rigid teeth do under a load that spans the face."""
        return self.contact.begins_or_ends_at_once

    def require_followable(self, name: str, mean: bool) -> None:
        """Refuse lines that come down to a base circle, at a speed without limit."""
        if self.contact.slices.few_teeth:
            raise ValueError(
                f"pinion_teeth = {self.drive.pinion_teeth} is too few for {name}: under load contact lines end on a "
                "base circle, where the speed of the contact has no limit"
            )

    def _states(self, ages: FloatArray, in_mesh: NDArray[np.bool_]) -> PairStates:
        pairs = self.contact.pairs_of_age(ages)
        there = np.asarray(in_mesh)
        radius, angle, force, stiffness = (
            np.where(there, part, 0.0) for part in (pairs.radius, pairs.angle, pairs.force, pairs.stiffness)
        )
        return PairStates(there, radius, angle, force, stiffness / self.contact.pair_stiffness)
