"""Motions of a gearbox whose teeth have play, and what becomes of its tongues: bounded or not, and how large.

A linear gearbox in a tongue vibrates ever more. With play its flanks part, and from a state near rest the motion may
settle. It is followed from the static deflection under the torque; of a tongue, at the speed where it grows fastest.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from facegear.floquet.clearance import ClearanceSystem
from facegear.floquet.orbits import Orbit, periodic_orbit
from facegear.floquet.transients import settled
from facegear.maps.tracing import Tongue
from facegear.mechanics.backlash import Backlash
from facegear.support.kinds import named
from facegear.support.labelled import text, variable
from facegear.support.parameters import integer_at_least, rpm
from facegear.support.types import FloatArray

# Mesh periods that a motion is followed, at least and at most; growth by this power of e takes it far from rest.
_FEWEST, _MOST, _POWERS = 400, 4000, 15.0
# After so many it is looked at whether it has settled.
_STEP = 50
# Periods at the end that are looked at, and repetitions that are tried.
_KEPT, _REPEATS = 24, (1, 2, 3, 4)
# Beyond so many static deflections gap and torque are nothing, and a motion that still grows goes on growing.
_LARGE = 1e3
_FLANKS = ("stays pressed", "flanks part", "strikes back")
# How near a motion that repeats itself must be to what was followed, over its size: Runge-Kutta steps are coarse.
_NEAR = 0.05


def motions_in_tongues(play: Backlash, found: Sequence[Tongue], parameters: str) -> xr.Dataset:
    """Follow the motion from near rest at the peak of each tongue.

    Parameters
    ----------
    play : Backlash
    found : sequence of Tongue
        Of its gearbox without play.
    parameters : str
        For the provenance.

    Returns
    -------
    xarray.Dataset
        Over ``tongue``: ``peak`` [rpm]; ``compression`` [µm], the largest of a tooth pair along the line of action,
        infinite where the motion grows beyond a thousand times ``static``, that of one pair under the whole static
        force. Labels in ``label``, and in ``motion`` what it is: "repeats every 2 periods, flanks part" or the like,
        or why it was not followed, with NaN for its compression.
    """
    rows = [_in_tongue(play, tongue) for tongue in found]
    size = partial(variable, units="µm", rtol=0.1, atol=0.1)
    return xr.Dataset(
        {
            "peak": variable("tongue", [rpm(tongue.peak) for tongue in found], "Speed", "rpm", atol=0.1),
            "compression": size(
                "tongue", [1e6 * row.compression for row in rows], "Largest compression of a tooth pair"
            ),
            "static": size((), 1e6 * _static(play), "Compression of one pair under the whole static force"),
        },
        coords={
            "tongue": np.arange(len(rows)),
            "label": text("tongue", [tongue.label for tongue in found], "Label of the tongue"),
            "motion": text("tongue", [row.words for row in rows], "What the motion is"),
        },
        attrs={"parameters": parameters},
    )


def _in_tongue(play: Backlash, tongue: Tongue) -> Motion:
    """Motion at the peak of a tongue, or why it is not followed."""
    try:
        return motion_from_rest(play, tongue.peak, _periods(play, tongue))
    except ArithmeticError as error:
        return Motion(math.nan, f"not followed: {error}", None, np.zeros((0, 0)))


def _periods(play: Backlash, tongue: Tongue) -> int:
    """Mesh periods that take a motion in a tongue far from rest."""
    period = play.pressed(tongue.peak).period
    enough = _POWERS / (tongue.growth_rate * period)
    return _STEP * math.ceil(min(max(enough, _FEWEST), _MOST) / _STEP)


def _at_rest(play: Backlash) -> FloatArray:
    """Deflection under the torque on the mean stiffness, the forward flanks in contact, (3,)."""
    drive = play.torsional.drive
    twisted = np.linalg.solve(play.torsional.mean_stiffness, [0.0, 0.0, -play.torque])
    # Gear and load turn on by half the gap before the flanks touch.
    turned = play.gap / 2.0 / (drive.base_radius * drive.gear_ratio)
    return np.asarray(twisted - [0.0, turned, turned], dtype=float)


def _static(play: Backlash) -> float:
    """Compression of one pair that bears the whole static force T_o / (r_b1 N2/N1) [m]."""
    drive, mesh = play.torsional.drive, play.torsional.gearbox.in_si.mesh_stiffness
    return float(play.torque / (drive.base_radius * drive.gear_ratio * mesh))


def _compression(system: ClearanceSystem, fraction: ArrayLike, displacements: FloatArray) -> FloatArray:
    """How far each pair of either flank is pressed in, by its own shape φ at fractions of a period, (..., p) [m].

    Negative in the gap; without a gap flanks are one, which pull as well; out of mesh as far as the gap is.
    """
    x = np.mod(fraction, 1.0)
    found = []
    for load, side, clearance in zip(system.system.loads, system.sides, system.clearances, strict=True):
        phi, error = load.shape(x), load.transmission_error
        u = (phi * displacements).sum(axis=-1) - (0.0 if error is None else error(x)[..., 0])
        there = np.abs(phi).max(axis=-1) > 0.0
        found.append(np.where(there, side * u if side else np.abs(u), 0.0) - clearance)
    return np.stack(found, axis=-1)


@dataclass(frozen=True, eq=False)
class Motion:
    """Where a gearbox with play ends that starts at rest under its torque.

    Attributes
    ----------
    compression : float
        Largest of a tooth pair of either flank, by the arm of the model's mesh force [m], as periods begin where the
        motion is `irregular`, infinite where it grows beyond a thousand times that under the whole static force.
    words : str
        What it is: "repeats every 2 periods, flanks part" or the like.
    orbit : Orbit or None
        The motion that repeats itself, if it does.
    ends : ndarray, shape (24, 2n)
        States (q, q̇) as the last mesh periods end.
    """

    compression: float
    words: str
    orbit: Orbit | None
    ends: FloatArray


def motion_from_rest(play: Backlash, speed: float, periods: int = _FEWEST) -> Motion:
    """Follow the motion from the static deflection under the torque.

    Parameters
    ----------
    play : Backlash
    speed : float
        Ω2 [rad/s].
    periods : int
        Mesh periods that it is followed at most, a multiple of 50.

    Returns
    -------
    Motion

    Raises
    ------
    TypeError, ValueError
        If an argument is of the wrong kind, or `periods` no multiple of 50.
    ArithmeticError
        If the speed is so low that a mesh period takes too many steps, see
        :func:`facegear.floquet.transients.settled`.

    Examples
    --------
    >>> from facegear.mechanics.gearboxes import FIGURES
    >>> from facegear.support.parameters import rad_per_s
    >>> play = Backlash(FIGURES["7.12a"].model(), torque=800.0, gap=1e-4)
    >>> motion_from_rest(play, rad_per_s(700.0)).words
    'repeats each period, stays pressed'
    """
    _require_play(play)
    system, rest = play.system(speed), _at_rest(play)
    if integer_at_least("periods", periods, _STEP) % _STEP:
        raise ValueError(f"periods must be a multiple of {_STEP}, got {periods}")
    state, orbit = np.concatenate([rest, np.zeros_like(rest)]), None
    limit = _LARGE * _static(play)
    for _ in range(periods // _STEP):
        with np.errstate(over="ignore", invalid="ignore"):
            ends = settled(system, state[np.newaxis], _STEP, kept=_KEPT)[:, 0]
        state, seen = ends[-1], _compression(system, 0.0, ends[:, : rest.size])
        if not np.isfinite(ends).all() or seen.max() > limit:
            return Motion(math.inf, "grows beyond a thousand times the static compression", None, ends)
        # A motion that is near a stable one which repeats itself ends there; near an unstable one it goes on.
        if (orbit := _repeating(system, ends)) is not None:
            break
    if orbit is None:
        words = f"irregular, or not settled, after {periods} periods: seen as periods begin"
        return Motion(float(seen.max()), words, None, ends)

    def along(x: FloatArray) -> FloatArray:
        return _compression(system, x * orbit.periods, orbit.displacements(x))

    largest = float(orbit.response.extremes(along)[1].max())
    count = "each period" if orbit.periods == 1 else f"every {orbit.periods} periods"
    return Motion(largest, f"repeats {count}, {_FLANKS[_contact(play, orbit)]}", orbit, ends)


def _require_play(play: object) -> None:
    if not isinstance(play, Backlash):
        raise TypeError(f"play must be a Backlash, a gearbox whose teeth have a gap, got {named(play)}")


def _contact(play: Backlash, orbit: Orbit) -> int:
    """Whether flanks stay pressed, 0, part, 1, or the back flanks are struck as well, 2."""
    return 2 if play.strikes_back(orbit) else int(play.parts(orbit))


def motion_arrays(play: Backlash, orbits: Sequence[Orbit], points: int) -> xr.Dataset:
    """Mesh deformation and its rate over the periods of some motions, the smallest first.

    Parameters
    ----------
    play : Backlash
    orbits : sequence of Orbit
    points : int
        Instants over the whole of each motion.

    Returns
    -------
    xarray.Dataset
        Over (motion, fraction): ``deformation`` [m], ``rate`` [m/s]; over ``motion``: ``contact``, 0 where flanks stay
        pressed, 1 where they part, 2 where back flanks are struck, and ``periods``.
    """
    fraction, gearbox = np.linspace(0.0, 1.0, points), play.torsional

    def whole(orbit: Orbit) -> tuple[FloatArray, FloatArray]:
        motion = orbit.displacements(fraction), orbit.velocities(fraction)
        return gearbox.deformation(motion[0]), gearbox.deformation(motion[1])

    ordered = sorted(orbits, key=lambda orbit: float(whole(orbit)[0].max()))
    deformation, rate = np.moveaxis(np.array([whole(orbit) for orbit in ordered]), 1, 0)
    contact = [float(_contact(play, orbit)) for orbit in ordered]
    both = ("motion", "fraction")
    return xr.Dataset(
        {
            "deformation": variable(both, deformation, "Mesh deformation", units="m", rtol=1e-6, atol=1e-11),
            "rate": variable(both, rate, "Its rate", units="m/s", rtol=1e-6, atol=1e-7),
            "contact": variable("motion", contact, "0 pressed, 1 parts, 2 strikes back", units="1", atol=0.1),
        },
        {
            "motion": np.arange(len(ordered)),
            "fraction": fraction,
            "periods": ("motion", [orbit.periods for orbit in ordered]),
        },
    )


def _repeating(system: ClearanceSystem, ends: FloatArray) -> Orbit | None:
    """Motion that repeats itself and was followed, if there is one."""
    size = np.abs(ends).max(axis=0)
    if all((np.abs(ends[-1] - ends[-1 - count]) > _NEAR * size).any() for count in _REPEATS):
        return None
    # In their order: what repeats itself every period does so every two.
    for count in _REPEATS:
        try:
            orbit = periodic_orbit(system, count, ends[-1])
        except ArithmeticError:
            continue
        if orbit.is_stable and (np.abs(orbit.start - ends[-1]) <= _NEAR * size).all():
            return orbit
    return None
