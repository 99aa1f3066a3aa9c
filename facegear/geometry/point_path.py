"""Path of the unloaded contact at a point, each pair at one place along the face."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from facegear.geometry.drive import Drive
from facegear.geometry.point_contact import UnloadedContact
from facegear.geometry.timed_pairs import PairStates, TimedPairs
from facegear.support.types import FloatArray


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
