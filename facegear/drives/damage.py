"""What one damaged tooth of a gearbox would show: little in its exponents but near tongues, sidebands in its response.

Flanks are taken as always in contact: where a large loss makes the deformation pass zero, real teeth would part.
"""

from __future__ import annotations

import math
from functools import partial

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from facegear.floquet.multipliers import growth_rate
from facegear.floquet.response import steady_response
from facegear.mechanics.tooth_damage import DamagedTooth
from facegear.support.kinds import require_kind
from facegear.support.labelled import variable
from facegear.support.parameters import finite_array, rad_per_s
from facegear.support.types import FloatArray

# Number of the face gear among the coordinates.
_GEAR = 1
# Harmonics of the mesh whose sidebands are looked at.
_MESH_HARMONICS = 3


def signs_of_damage(cracked: DamagedTooth, speeds_rpm: ArrayLike, parameters: str) -> xr.Dataset:
    """Growth and sidebands of a gearbox with a damaged tooth, against the intact one.

    Parameters
    ----------
    cracked : DamagedTooth
        Under a torque: without one nothing vibrates.
    speeds_rpm : array_like, shape (S,)
        Speeds of the face gear [rpm].
    parameters : str
        For the provenance.

    Returns
    -------
    xarray.Dataset
        Over ``speed_rpm``: ``growth_intact`` and ``growth_damaged`` [1/s]; ``sideband`` [-], the largest amplitude of
        the face gear's angle at a multiple of the revolution that is none of the mesh, up to three mesh frequencies,
        over the largest at a multiple of the mesh; not a number where the intact or the damaged gearbox is unstable.

    Raises
    ------
    TypeError, ValueError
        If an argument is of the wrong kind, or there is no torque.
    """
    require_kind("cracked", cracked, DamagedTooth)
    shown = finite_array("speeds_rpm", speeds_rpm)
    if shown.ndim != 1 or (shown <= 0.0).any():
        raise ValueError(f"speeds_rpm must be a list of speeds greater than 0 rpm, got {speeds_rpm!r}")
    if cracked.torque == 0.0:
        raise ValueError(
            "torque of the damaged gearbox must be greater than 0, or nothing vibrates, got 0 N m"
        )
    rows = [_signs(cracked, speed) for speed in rad_per_s(shown).tolist()]
    growth = partial(variable, "speed_rpm", units="1/s", rtol=1e-6, atol=1e-3)
    intact, damaged, sideband = np.reshape(rows, (-1, 3)).T
    return xr.Dataset(
        {
            "growth_intact": growth(intact, "Growth rate of the intact gearbox"),
            "growth_damaged": growth(damaged, "Growth rate with the damaged tooth"),
            "sideband": variable(
                "speed_rpm",
                sideband,
                "Largest sideband over the largest mesh harmonic",
                "1",
                rtol=1e-5,
                atol=1e-9,
            ),
        },
        {"speed_rpm": shown},
        {"parameters": parameters},
    )


def _signs(cracked: DamagedTooth, speed: float) -> tuple[float, float, float]:
    pressed = cracked.pressed(speed)
    radius = float(np.abs(np.linalg.eigvals(cracked.transition_matrix(speed))).max())
    damaged = math.log(radius) / (cracked.teeth * pressed.period)
    intact = growth_rate(pressed)
    if max(intact, damaged) >= 0.0:
        return intact, damaged, math.nan
    return intact, damaged, _sideband(cracked, speed)


def _sideband(cracked: DamagedTooth, speed: float) -> float:
    """Largest sideband of the face gear's angle over its largest mesh harmonic."""
    lines: FloatArray = np.abs(
        steady_response(cracked.system(speed)).harmonics(_MESH_HARMONICS * cracked.teeth)[1:, _GEAR]
    )
    of_mesh = np.arange(1, lines.size + 1) % cracked.teeth == 0
    return float(lines[~of_mesh].max() / lines[of_mesh].max())
