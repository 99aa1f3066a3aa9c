"""Tooth pairs on a clock of mesh periods: which are in mesh when, for any law of their positions.

Time is counted in mesh periods T0 (3-20): x = t/T0. A tooth pair enters at every whole number and stays in mesh
for cr mesh periods (3-19), so that P = ceil(cr) pairs are numbered 0 … P − 1 by age: at time x the pair j has
been in mesh for frac(x) + j periods, if that is not more than cr. Nothing here depends on the speed.

Positions are smooth on the pieces between breakpoints. `..._on_piece` evaluates one piece up to and including
both its ends, each as the limit from inside, so that a fit on Chebyshev nodes is not spoilt by the neighbour.
"""

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from functools import cached_property
from typing import ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from facegear.geometry.drive import Drive
from facegear.support import parameters
from facegear.support.types import FloatArray

# Breakpoints closer than this, in mesh periods, are the same instant but for rounding.
SAME_INSTANT = 1e-12
# So short a piece, in mesh periods, cannot be told from rounding.
SHORTEST = 1e-9
# Relative error of fits.
TOLERANCE = 1e-13
# Beyond this speed numbers overflow before anything turns so fast [rad/s].
_FASTEST = 1e7


class PairStates(NamedTuple):
    """Tooth pairs at instants of shape S; row j is the pair that entered j mesh periods before frac(x) = 0.

    Where a pair is out of contact its radius, angle and length are 0, and all angles and lengths of a path that has
    none (:class:`SkewLine`).

    Attributes
    ----------
    in_contact : ndarray of bool, shape (P,) + S
    radius : ndarray, shape (P,) + S
        r_j of the contact point [m].
    angle : ndarray, shape (P,) + S
        θ_j, space-fixed about the gear's axis from the pinion's axis [rad].
    length : ndarray, shape (P,) + S
        l_j of the contact line [m]; of a contact under load the force of the pair [N], which weights it alike.
    stiffness : ndarray, shape (P,) + S, optional
        Of the pair over the mean mesh stiffness k_m [-]; None: all of it.
    """

    in_contact: NDArray[np.bool_]
    radius: FloatArray
    angle: FloatArray
    length: FloatArray
    stiffness: FloatArray | None = None


def checked_contact_ratio(drive: Drive, contact_ratio: float | None) -> float:
    """Return the contact ratio that a drive is computed with.

    Parameters
    ----------
    drive : Drive
    contact_ratio : float or None
        Mesh periods that a tooth pair stays in mesh, 1 or more; None for Tregold's, `drive.contact_ratio`. Within
        1e-9 of a whole number it counts as that: a pair then leaves as the next one enters, and the piece between
        would be too short to be told from rounding.

    Raises
    ------
    TypeError, ValueError
        `contact_ratio` is not a number, below 1, or above the number of pinion teeth.
    """
    ratio = drive.contact_ratio if contact_ratio is None else contact_ratio
    hint = "below 1 there are instants without any tooth in mesh"
    ratio = parameters.within("contact_ratio", ratio, 1.0, float(drive.pinion_teeth), hint=hint)
    return float(round(ratio)) if abs(ratio - round(ratio)) < SHORTEST else ratio


def merged(instants: list[float]) -> tuple[float, ...]:
    """Fractions of a mesh period in ascending order from 0, without repetitions."""
    fractions = sorted(instant - math.floor(instant) for instant in instants)
    kept = [0.0]
    for fraction in fractions:
        if fraction - kept[-1] > SAME_INSTANT and 1.0 - fraction > SAME_INSTANT:
            kept.append(fraction)
    return tuple(kept)


def _ages(x: ArrayLike, pairs: int) -> FloatArray:
    """Mesh periods since entry of each pair, shape (pairs,) + S."""
    instants = parameters.finite_array("x", x)
    start = instants - np.floor(instants)
    return np.stack([start + j for j in range(pairs)])


@dataclass(frozen=True)
class TimedPairs(ABC):
    """Tooth pairs on a clock: which are in mesh when, for any law of their positions.

    Parameters
    ----------
    drive : Drive
    contact_ratio : float, optional
        Mesh periods that a tooth pair stays in mesh, 1 or more; default Tregold's, `drive.contact_ratio`.

    Raises
    ------
    TypeError, ValueError
        `contact_ratio` is not a number, below 1, or above the number of pinion teeth.
    """

    drive: Drive
    contact_ratio: float = field(default=None)  # type: ignore[assignment]

    has_lengths: ClassVar[bool] = False
    """Whether contact is along lines, whose lengths may weight their midpoints."""

    @property
    def centroid_jumps(self) -> bool:
        """Whether a mean weighted by the lengths jumps as pairs enter and leave: not if they do with a length of 0."""
        return False

    def __post_init__(self) -> None:
        parameters.keep(self, contact_ratio=checked_contact_ratio(self.drive, self.contact_ratio))

    @property
    def pairs(self) -> int:
        """P = ceil(cr), the greatest number of tooth pairs in mesh at once."""
        return math.ceil(self.contact_ratio)

    @cached_property
    def breakpoints(self) -> tuple[float, ...]:
        """Fractions of T0 in [0, 1), ascending from 0, where a pair enters (0) or leaves (cr − ⌊cr⌋)."""
        return merged([0.0, self.contact_ratio])

    def pair_states(self, x: ArrayLike) -> PairStates:
        """Contact points of all pairs at times x [mesh periods], any real numbers of shape S; period 1."""
        ages = _ages(x, self.pairs)
        return self._states(ages, ages <= self.contact_ratio)

    def pair_states_on_piece(self, index: int, x: ArrayLike) -> PairStates:
        """Contact points of all pairs on one smooth piece, both ends included, as limits from inside.

        Parameters
        ----------
        index : int
            Piece between `breakpoints[index]` and the next one (or 1).
        x : array_like, shape S
            From −1 at its start to 1 at its end.

        Returns
        -------
        PairStates

        Raises
        ------
        TypeError, ValueError
            No such piece, or `x` outside [−1, 1].
        """
        piece = parameters.integer_at_least("index", index, 0)
        if piece >= len(self.breakpoints):
            raise ValueError(
                f"index must be below {len(self.breakpoints)}, the number of pieces, got {index!r}"
            )
        local = parameters.finite_array("x", x)
        if np.any(np.abs(local) > 1.0):
            raise ValueError(
                f"x must lie in [-1, 1] on a piece, got {local.flat[np.argmax(np.abs(local))]!r}"
            )
        there, *others, stiffness = self.pair_states_on_pieces(np.array([piece]), local.reshape(1, -1))
        shape = (self.pairs, *local.shape)
        radius, angle, length = (part.reshape(shape) for part in others)
        own = None if stiffness is None else stiffness.reshape(shape)
        return PairStates(there.reshape(shape), radius, angle, length, own)

    def pair_states_on_pieces(self, pieces: NDArray[np.intp], local: FloatArray) -> PairStates:
        """As :meth:`pair_states_on_piece` on several pieces (k,) at once, at local times of each, shape (k, m)."""
        edges = np.append(self.breakpoints, 1.0)
        start, end = edges[pieces, np.newaxis], edges[pieces + 1, np.newaxis]
        fraction = 0.5 * (start * (1.0 - local) + end * (1.0 + local))
        number = np.arange(self.pairs)[:, np.newaxis, np.newaxis]
        # No pair enters or leaves inside a piece: its middle decides for the whole.
        in_mesh = 0.5 * (start + end) + number < self.contact_ratio
        ages = fraction + number
        return self._states(ages, np.broadcast_to(in_mesh, ages.shape))

    @abstractmethod
    def _states(self, ages: FloatArray, in_mesh: NDArray[np.bool_]) -> PairStates:
        """Positions of pairs that have been in mesh for so many mesh periods, zero where not in mesh."""

    @property
    def fit_tolerances(self) -> FloatArray:
        """Relative errors that a fit of the positions may have, shape (pieces,) [-]."""
        return np.full(len(self.breakpoints), TOLERANCE)

    @property
    def pitch_passage(self) -> float:
        """Mesh periods since entry at which a pair passes the pitch point.

        Raises
        ------
        ValueError
            If the path does not say it.
        """
        raise ValueError(
            f"path must say when a pair passes the pitch point for a pinion that is driven, and {type(self).__name__} "
            "does not: give it a pitch_passage"
        )

    def require_followable(self, name: str, mean: bool) -> None:  # noqa: B027 (nothing to refuse is an answer)
        """Refuse a contact whose speed has no limit, for what has to follow it.

        Parameters
        ----------
        name : str
            What has to follow it, for the message.
        mean : bool
            Whether it follows a mean point of all pairs in mesh, or each pair.

        Raises
        ------
        ValueError
            Saying why.
        """


def mesh_period(drive: Drive, speed: float) -> float:
    """Mesh period T0 = 2π/(N2 Ω2) [s] (3-20).

    Parameters
    ----------
    drive : Drive
    speed : float
        Ω2 of the face gear [rad/s], greater than 0, at most 1e7.

    Raises
    ------
    TypeError, ValueError
        `speed` is not a number, or outside this range.
    """
    speed = parameters.positive("speed", speed, "rad/s")
    if speed > _FASTEST:
        raise ValueError(f"speed must be at most {_FASTEST:g} rad/s, got {speed!r} rad/s")
    return 2.0 * math.pi / (drive.gear_teeth * speed)
