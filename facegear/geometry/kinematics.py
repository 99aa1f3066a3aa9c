"""Meshing kinematics: contact point and contact centroid of line contact against time (chapter 3, 3.6 and 3.7).

The contact ratio is an argument: Tregold's `drive.contact_ratio`, the default and the dissertation's choice,
compresses the whole sweep of the contact line into Tregold's shorter mesh time, rotation included;
`drive.geometric_contact_ratio` lets the pinion turn as fast as the sweep needs. The travel around the gear's axis is
compressed with it: the contact runs around with the gear (section 3.7), which turns by cr angular pitches meanwhile.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from facegear.geometry.drive import Drive
from facegear.geometry.proportions import ADDENDUM
from facegear.geometry.timed_pairs import SAME_INSTANT, SHORTEST, TOLERANCE, PairStates, TimedPairs, merged
from facegear.support import parameters
from facegear.support.types import FloatArray

# Pieces next to a square root: each is so many times shorter than the one before it, down to the shortest.
_GRADING = 8.0
# How short a piece must be, in mesh periods, before it may have more.
_SHORT = 1e-3
# The same where the shaper shortens contact lines: their ends are roots of roots, known to 1e-14 or so.
_CUT_TOLERANCE = 1e-11


class Centroid(NamedTuple):
    """Contact centroid (3-21) at instants of shape S.

    Attributes
    ----------
    radius : ndarray, shape S
        r_c [m].
    angle : ndarray, shape S
        θ_c, space-fixed about the gear's axis from the pinion's axis [rad].
    """

    radius: FloatArray
    angle: FloatArray


@dataclass(frozen=True)
class ContactPath(TimedPairs):
    """Path of the true contact points, the midpoints of the contact lines by arc length.

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
    >>> drive = fg.Drive(26, 130, 3.175e-3)
    >>> path = fg.ContactPath(drive)
    >>> path.contact_ratio == drive.contact_ratio
    True
    >>> fg.ContactPath(drive, contact_ratio=drive.geometric_contact_ratio).contact_ratio > path.contact_ratio
    True
    """

    has_lengths: ClassVar[bool] = True

    def __post_init__(self) -> None:
        self.drive.require_line_contact(type(self).__name__)
        super().__post_init__()

    @property
    def pitch_passage(self) -> float:
        """Mesh periods since entry at which a pair passes the pitch point."""
        return passage_of_pitch_point(self.drive, self.contact_ratio)

    @property
    def angular_travel(self) -> float:
        """Travel about the gear's axis over that of the true sweep: cr over the geometric contact ratio."""
        return self.contact_ratio / self.drive.geometric_contact_ratio

    @cached_property
    def breakpoints(self) -> tuple[float, ...]:
        """Fractions of T0 in [0, 1), ascending from 0, between which the positions are smooth.

        0 (a pair enters), cr − ⌊cr⌋ (a pair leaves), and the instants where an end of a contact line changes
        its bounding edge: corners of the contact region, closed forms at γ = 90°. With so few teeth that the
        end of the line comes down to the pinion's base circle (`base_circle_instant`), or nearly so, it does
        that with the square root of the time that is left. Pieces shrink towards that instant, each to an
        eighth, so that polynomials follow it on every one of them, down to a billionth of T0.
        """
        corners = self._corners
        root = self.drive.contact_region.square_root
        if root is None:
            return corners
        instant, beyond = (self._age(c - self.drive.space_half_angle) for c in root)
        gaps = ((instant - c) % 1.0 or 1.0 for c in corners)
        width = min(gap for gap in gaps if SAME_INSTANT < gap < 1.0 - SAME_INSTANT or len(corners) == 1)
        # A root further beyond than that is no trouble.
        count = math.ceil(math.log(width / max(beyond - instant, SHORTEST), _GRADING))
        if count <= 2:
            return corners
        return merged([*corners, *(instant - width / _GRADING**k for k in range(1, count + 1))])

    @cached_property
    def _corners(self) -> tuple[float, ...]:
        """Fractions of T0 at which a pair enters, leaves, or an end of its line changes edge."""
        return merged([0.0, self.contact_ratio, *map(self._age, self.drive.kink_rotations)])

    def _age(self, rotation: float) -> float:
        """Mesh periods since entry at a pinion rotation φs."""
        sweep = self.drive.entry_rotation - self.drive.exit_rotation
        return (self.drive.entry_rotation - rotation) / sweep * self.contact_ratio

    @cached_property
    def base_circle_instant(self) -> float | None:
        """Fraction of T0 at which a contact line's end comes down to the pinion's base circle; None if none does.

        Just before, the contact point moves at a speed that grows without limit, as one over the square root of
        the time left (`ContactRegion.base_circle`); positions stay continuous.
        """
        rotation = self.drive.base_circle_rotation
        return None if rotation is None else self._age(rotation) % 1.0

    def require_finite_speed(self, name: str) -> None:
        """Refuse a contact point whose speed grows without limit, for what has to follow it.

        A mass would need infinite energy: the integral of u̇², of one over the time left.

        Parameters
        ----------
        name : str
            What has to follow it, for the message.

        Raises
        ------
        ValueError
            If a contact line's end comes down to the base circle.
        """
        if self.base_circle_instant is None:
            return
        drive = self.drive
        enough = math.floor(2.0 * ADDENDUM / (1.0 - math.cos(drive.pressure_angle))) + 1
        raise ValueError(
            f"pinion_teeth = {drive.pinion_teeth} is too few for {name} (gear_teeth = {drive.gear_teeth}, pressure "
            f"angle {math.degrees(drive.pressure_angle):.4g}°): contact lines end on the pinion's base circle, where "
            f"the contact point's speed has no limit; {enough} pinion teeth are enough at any gear ratio"
        )

    def require_slow_centroid(self, name: str) -> None:
        """Refuse a centroid that springs from the exit of one pair to the entry of the next, for what follows it.

        Parameters
        ----------
        name : str
            What has to follow it, for the message.

        Raises
        ------
        ValueError
            If `contact_ratio` is below 1.001: one pair leaves as the next enters, and what is left of (cr − 1) T0
            for the way back over the whole face width lets speed, and the work of a damper, grow without limit.
        """
        if self.contact_ratio < 1.0 + _SHORT:
            raise ValueError(
                f"contact_ratio must be at least {1.0 + _SHORT:g} for {name}, which follows the contact centroid back "
                f"from exit to entry within contact_ratio - 1 mesh periods, got {self.contact_ratio!r}"
            )

    def require_followable(self, name: str, mean: bool) -> None:
        """As :meth:`TimedPairs.require_followable`: too few teeth, or a mean point that springs back."""
        self.require_finite_speed(name)
        if mean:
            self.require_slow_centroid(name)

    @property
    def fit_tolerances(self) -> FloatArray:
        """Relative errors that a fit of the positions may have, shape (pieces,) [-].

        On the short pieces next to a square root (`breakpoints`), and while the only pair leaves and the next one
        enters, an error counts by their duration.
        """
        tolerance = _CUT_TOLERANCE if self.drive.contact_region.is_cut else TOLERANCE
        widths = np.diff(self.breakpoints, append=1.0)
        if self.breakpoints == self._corners and self.contact_ratio >= 1.0 + _SHORT:
            return np.full(widths.shape, tolerance)
        return np.asarray(tolerance * np.maximum(1.0, _SHORT / widths))

    def contact_point(self, fraction: ArrayLike) -> PairStates:
        """Contact point of one tooth pair against the fraction of its own mesh time cr T0.

        Parameters
        ----------
        fraction : array_like, shape S
            From 0 at first contact (outer edge) to 1 at last contact.

        Returns
        -------
        PairStates
            Fields of shape S; always in contact.

        Raises
        ------
        TypeError, ValueError
            Not numeric, not finite, or outside [0, 1].
        """
        own = parameters.finite_array("fraction", fraction)
        if np.any((own < 0.0) | (own > 1.0)):
            bad = own[(own < 0.0) | (own > 1.0)].flat[0]
            raise ValueError(f"fraction must lie in [0, 1] of the pair's mesh time, got {bad!r}")
        rotation = self.drive.entry_rotation * (1.0 - own) + self.drive.exit_rotation * own
        lines = self.drive.contact_lines(rotation)
        angle = self.angular_travel * lines.angle
        return PairStates(np.ones(own.shape, dtype=bool), lines.radius, angle, lines.length)

    def centroid(self, x: ArrayLike) -> Centroid:
        """Contact centroid (3-21) at times x [mesh periods], any real numbers of shape S; period 1.

        Raises
        ------
        TypeError, ValueError
            `x` is not numeric or not finite.
        """
        return _weighted(self.pair_states(x))

    def centroid_on_piece(self, index: int, x: ArrayLike) -> Centroid:
        """Contact centroid (3-21) on one smooth piece, both ends included.

        Parameters
        ----------
        index : int
            Piece between `breakpoints[index]` and the next one (or 1).
        x : array_like, shape S
            From −1 at its start to 1 at its end.

        Returns
        -------
        Centroid

        Raises
        ------
        TypeError, ValueError
            No such piece, or `x` outside [−1, 1].
        """
        return _weighted(self.pair_states_on_piece(index, x))

    def overlaid(self, count: int, rotation: ArrayLike) -> PairStates:
        """Contact points of successive tooth pairs against the face gear's rotation (Fig. 3.9).

        Parameters
        ----------
        count : int
            Number of pairs; pair j enters when the face gear has turned by j θ_N.
        rotation : array_like, shape S
            Rotation of the face gear Ω2 t since the first pair entered [rad].

        Returns
        -------
        PairStates
            Fields of shape (count,) + S.

        Raises
        ------
        TypeError, ValueError
            `count` is not an integer of at least 1, or `rotation` not finite numbers.
        """
        number = parameters.integer_at_least("count", count, 1)
        periods = parameters.finite_array("rotation", rotation, "rad") / self.drive.angular_pitch
        ages = np.stack([periods - j for j in range(number)])
        return self._states(ages, (ages >= 0.0) & (ages <= self.contact_ratio))

    def _states(self, ages: FloatArray, in_mesh: NDArray[np.bool_]) -> PairStates:
        # Dividing an age by cr may pass 1 by the last digit at the end of a piece.
        point = self.contact_point(np.minimum(ages[in_mesh] / self.contact_ratio, 1.0))
        radius, angle, length = (np.zeros(ages.shape) for _ in range(3))
        radius[in_mesh], angle[in_mesh], length[in_mesh] = point.radius, point.angle, point.length
        return PairStates(np.asarray(in_mesh), radius, angle, length)


def _weighted(states: PairStates) -> Centroid:
    """Mean position weighted by the lengths of the contact lines (3-21)."""
    total = states.length.sum(axis=0)
    if np.any(total == 0.0):
        # Only a contact ratio of exactly 1 does this: one pair leaves as the next enters, both of zero length.
        raise ValueError("contact_ratio must exceed 1 for the centroid to exist at every instant")
    weights = states.length / total
    return Centroid((weights * states.radius).sum(axis=0), (weights * states.angle).sum(axis=0))


@dataclass(frozen=True)
class CentroidPath(ContactPath):
    """Path on which every tooth pair in mesh is taken to be at the contact centroid (3-21) of all of them.

    Parameters
    ----------
    drive : Drive
    contact_ratio : float, optional
        As for :class:`ContactPath`.

    Raises
    ------
    TypeError, ValueError
        As :class:`ContactPath`.
    """

    def require_followable(self, name: str, mean: bool) -> None:
        """As :meth:`ContactPath.require_followable` for a mean point, which all pairs follow here."""
        super().require_followable(name, True)

    def pair_states(self, x: ArrayLike) -> PairStates:
        """As :meth:`ContactPath.pair_states`, all pairs at the centroid."""
        return _gathered(super().pair_states(x))

    def pair_states_on_pieces(self, pieces: NDArray[np.intp], local: FloatArray) -> PairStates:
        """As :meth:`ContactPath.pair_states_on_pieces`, all pairs at the centroid."""
        return _gathered(super().pair_states_on_pieces(pieces, local))


def _gathered(states: PairStates) -> PairStates:
    centroid, there = _weighted(states), states.in_contact
    return PairStates(there, centroid.radius * there, centroid.angle * there, states.length)


def passage_of_pitch_point(drive: Drive, contact_ratio: float) -> float:
    """Mesh periods since entry at which a pair passes the pitch point: φs a quarter pitch before a space is upright."""
    sweep = drive.entry_rotation - drive.exit_rotation
    return (drive.entry_rotation + 0.5 * math.pi / drive.pinion_teeth) / sweep * contact_ratio
