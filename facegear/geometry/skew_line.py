"""Skew line (3-22): contact on a straight line from R2 to R1 in time, without angle or length."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from facegear.geometry.kinematics import passage_of_pitch_point
from facegear.geometry.timed_pairs import PairStates, TimedPairs
from facegear.support.types import FloatArray


@dataclass(frozen=True)
class SkewLine(TimedPairs):
    """Contact points on the straight line from R2 to R1 in time, pair by pair, without angle or length (3-22).

    Parameters
    ----------
    drive : Drive
    contact_ratio : float, optional
        Mesh periods that a tooth pair stays in mesh, 1 or more; default Tregold's, `drive.contact_ratio`.

    Raises
    ------
    TypeError, ValueError
        `contact_ratio` is not a number, below 1, or above the number of pinion teeth.

    Examples
    --------
    >>> import facegear as fg
    >>> body = fg.Body(fg.Drive(26, 130, 3.175e-3), thickness_ratio=0.03)
    >>> pinion = fg.MeshLoad(stiffness=1.0, damping=3e-6, mass=1.0)
    >>> model = fg.Transverse(body, pinion, contact=fg.Contact(fg.SkewLine, "mean"))
    >>> model.system(fg.rad_per_s(600.0)).size
    14
    """

    @property
    def pitch_passage(self) -> float:
        """Mesh periods since entry at which a pair of the true contact lines between the same ends does."""
        return passage_of_pitch_point(self.drive, self.contact_ratio)

    @property
    def slope(self) -> float:
        """dr_j/dx of a pair in contact [m per mesh period]; over T0 its derivative to time."""
        return (self.drive.inner_radius - self.drive.outer_radius) / self.contact_ratio

    def _states(self, ages: FloatArray, in_mesh: NDArray[np.bool_]) -> PairStates:
        radius = np.where(in_mesh, self.drive.outer_radius + self.slope * ages, 0.0)
        return PairStates(np.asarray(in_mesh), radius, np.zeros(ages.shape), np.zeros(ages.shape))
