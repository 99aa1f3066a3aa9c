"""What becomes of the tongues of a gearbox whose teeth have play: motions that stay bounded, and how large they are.

A linear gearbox in a tongue vibrates ever more. With play its flanks part, and from a state near rest the motion may
settle. It is followed from the static deflection under the torque, at the speed where the tongue grows fastest.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial

import numpy as np
import xarray as xr

from facegear.floquet.clearance import ClearanceSystem
from facegear.floquet.orbits import Orbit, periodic_orbit
from facegear.floquet.transients import settled
from facegear.maps.tracing import Tongue
from facegear.mechanics.backlash import Backlash
from facegear.support.labelled import text, variable
from facegear.support.parameters import rpm
from facegear.support.types import FloatArray

# Mesh periods that a motion is followed, at least and at most; growth by this power of e takes it far from rest.
_FEWEST, _MOST, _POWERS = 400, 4000, 15.0
# Periods at the end that are looked at, and repetitions that are tried.
_KEPT, _REPEATS = 24, (1, 2, 3, 4)
# Beyond so many static deflections gap and torque are nothing, and a motion that still grows goes on growing.
_LARGE = 1e3
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
        Over ``tongue``: ``peak`` [rpm]; ``compression`` [µm], the largest of the teeth along the line of action,
        infinite where the motion grows beyond a thousand times ``at_rest``, that of the resting gearbox. Labels in
        ``label``, and in ``motion`` what it is: "repeats every 2 periods, flanks part" or the like.
    """
    rows = [_motion(play, tongue) for tongue in found]
    size = partial(variable, units="µm", rtol=0.1, atol=0.1)
    return xr.Dataset(
        {
            "peak": variable("tongue", [rpm(tongue.peak) for tongue in found], "Speed", "rpm", atol=0.1),
            "compression": size("tongue", [1e6 * row[0] for row in rows], "Largest compression of the teeth"),
            "at_rest": size((), 1e6 * _compression(play, _at_rest(play)), "Compression at rest"),
        },
        coords={
            "tongue": np.arange(len(rows)),
            "label": text("tongue", [tongue.label for tongue in found], "Label of the tongue"),
            "motion": text("tongue", [row[1] for row in rows], "What the motion is"),
        },
        attrs={"parameters": parameters},
    )


def _at_rest(play: Backlash) -> FloatArray:
    """Deflection under the torque on the mean stiffness, the forward flanks in contact, (3,)."""
    drive = play.torsional.drive
    twisted = np.linalg.solve(play.torsional.mean_stiffness, [0.0, 0.0, -play.torque])
    # Gear and load turn on by half the gap before the flanks touch.
    turned = play.gap / 2.0 / (drive.base_radius * drive.gear_ratio)
    return np.asarray(twisted - [0.0, turned, turned], dtype=float)


def _compression(play: Backlash, displacements: FloatArray) -> FloatArray:
    """How far the teeth of either flank are pressed in, negative in the gap [m]."""
    return np.asarray(np.abs(play.torsional.deformation(displacements)) - play.gap / 2.0)


def _motion(play: Backlash, tongue: Tongue) -> tuple[float, str]:
    """Largest compression [m], and what the motion is."""
    system, rest = play.system(tongue.peak), _at_rest(play)
    periods = int(min(max(_POWERS / (tongue.growth_rate * system.period), _FEWEST), _MOST))
    with np.errstate(over="ignore", invalid="ignore"):
        ends = settled(system, np.concatenate([rest, np.zeros_like(rest)])[np.newaxis], periods, kept=_KEPT)[
            :, 0
        ]
    seen = _compression(play, ends[:, : rest.size])
    if not np.isfinite(ends).all() or seen.max() > _LARGE * _compression(play, rest):
        return math.inf, "grows beyond a thousand times the compression at rest"
    orbit = _repeating(system, ends)
    if orbit is None:
        return float(seen.max()), f"irregular, or not settled, after {periods} periods: seen as periods begin"
    largest = float(orbit.response.extremes(lambda x: _compression(play, orbit.displacements(x)))[1])
    flanks = (
        "strikes back"
        if play.strikes_back(orbit)
        else "flanks part"
        if play.parts(orbit)
        else "stays pressed"
    )
    count = "each period" if orbit.periods == 1 else f"every {orbit.periods} periods"
    return largest, f"repeats {count}, {flanks}"


def _repeating(system: ClearanceSystem, ends: FloatArray) -> Orbit | None:
    """Motion that repeats itself and was followed, if there is one."""
    size = np.abs(ends).max(axis=0)
    for count in _REPEATS:
        try:
            orbit = periodic_orbit(system, count, ends[-1])
        except ArithmeticError:
            continue
        if orbit.is_stable and (np.abs(orbit.start - ends[-1]) <= _NEAR * size).all():
            return orbit
    return None
