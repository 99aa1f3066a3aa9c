"""Phases between the meshes of several pinions, from the angles between them (5-1 to 5-4)."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from facegear.geometry.drive import Drive
from facegear.support import parameters
from facegear.support.types import FloatArray

# Total angles within this fraction of a pitch of a whole number of teeth count as whole.
_WHOLE_PITCH = 1e-9


class PhaseSplit(NamedTuple):
    """Total angles between pinions split into whole teeth and a phase, shape S (5-1, 5-2).

    Attributes
    ----------
    teeth : ndarray of int
        ΔN2, whole face-gear teeth between the pinions.
    positioning_angle : ndarray
        θ_q = ΔN2 θ_N [rad].
    phasing_angle : ndarray
        θ_p = θ_c − θ_q, in [0, θ_N) [rad].
    phase : ndarray
        ψ = θ_p/θ_N, in [0, 1): the pinion's contact points at t are the first one's at t + ψ T0 (5-4).
    """

    teeth: NDArray[np.int64]
    positioning_angle: FloatArray
    phasing_angle: FloatArray
    phase: FloatArray


def phase_split(drive: Drive, pinion_angles: ArrayLike) -> PhaseSplit:
    """Split total angles of pinions into positioning and phasing angle, and give their phases (5-1, 5-2).

    Parameters
    ----------
    drive : Drive
    pinion_angles : array_like, shape S
        θ_c of each pinion from the first one [rad], within one turn, -2π to 2π. An angle within 1e-9 of a pitch of a
        whole number of teeth counts as whole: 120° in radians is not exact.

    Returns
    -------
    PhaseSplit

    Raises
    ------
    TypeError, ValueError
        Not numeric, not finite, or beyond one turn.

    Examples
    --------
    >>> import numpy as np
    >>> import facegear as fg
    >>> split = fg.phase_split(fg.Drive(26, 130, 3.175e-3), [0.0, 2.0 * np.pi / 3.0])
    >>> split.teeth.tolist(), split.phase.round(4).tolist()
    ([0, 43], [0.0, 0.3333])
    """
    angles = parameters.finite_array("pinion_angles", pinion_angles, "rad")
    beyond = np.abs(angles) > 2.0 * math.pi * (1.0 + _WHOLE_PITCH)
    if np.any(beyond):
        raise ValueError(
            f"pinion_angles must lie in [-2π, 2π] rad, within one turn, got {float(angles[beyond][0])!r} rad (degrees? "
            "np.radians converts them)"
        )
    pitches = angles / drive.angular_pitch
    nearest = np.rint(pitches)
    whole = np.abs(pitches - nearest) < _WHOLE_PITCH
    teeth = np.where(whole, nearest, np.floor(pitches))
    phase = np.where(whole, 0.0, pitches - teeth)
    positioning = teeth * drive.angular_pitch
    return PhaseSplit(teeth.astype(np.int64), positioning, phase * drive.angular_pitch, phase)


def touching_angle(drive: Drive) -> float:
    """Total angle between two pinions at which the tip circles at their inner ends touch [rad].

    A pinion touches its neighbour where it touches the plane half-way between them, which holds the gear's axis. Seen
    from there, a point of the tip circle r_a lies at the angle whose tangent is r_a cos u/(R1 − r_a |cos γ| sin u) off
    the pinion's own axis, u running round the circle: at most at that with the tangent r_a/√(R1² − (r_a cos γ)²).

    Parameters
    ----------
    drive : Drive

    Examples
    --------
    >>> round(math.degrees(touching_angle(Drive(26, 130, 3.175e-3))), 1)
    26.5
    """
    tip = drive.pinion_tip_radius
    reach = math.sqrt(drive.inner_radius**2 - (tip * math.cos(drive.shaft_angle)) ** 2)
    return 2 * math.atan2(tip, reach)
