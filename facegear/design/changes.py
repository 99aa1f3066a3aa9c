"""What to change first: how the tongues of a model answer to each of its parameters.

A border, where the growth rate σ vanishes, moves by dΩ = −(∂σ/∂p)/(∂σ/∂Ω) dp; a peak, where ∂σ/∂Ω = 0, grows by
∂σ/∂p dp. Both come from differences at fixed speeds, so that they are there for every parameter, those that move the
contact as well.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
import xarray as xr

from facegear.floquet.models import replace_parameter, value_of
from facegear.floquet.multipliers import growth_rate
from facegear.maps.tracing import Tongue, tongues
from facegear.mechanics.torsional import Torsional
from facegear.mechanics.transverse import Transverse
from facegear.support.labelled import text, variable
from facegear.support.parameters import integer_at_least, rpm

# Relative step of parameters and speeds in the differences: growth rates are known to 1e-7 or so.
_STEP = 1e-4
FOLLOWED = 0.10
"""Size of the changes that are made in earnest."""


def unstable_width(found: Sequence[Tongue]) -> float:
    """Sum of the widths of tongues [rad/s]."""
    return sum(tongue.width for tongue in found)


@dataclass(frozen=True)
class Change:
    """A way to change a model.

    Attributes
    ----------
    name : str
        What is changed.
    apply : callable
        Model and relative change, 0.01 for one percent more, to the changed model.
    """

    name: str
    apply: Callable[[Any, float], Any]


_TRANSVERSE: Mapping[str, str] = {
    "thickness of the body": "body.thickness_ratio",
    "bearing stiffness": "load.stiffness",
    "bearing damping": "load.damping",
    "pinion mass": "load.mass",
    "bore radius": "body.bore_radius",
    "loss factor of the material": "body.material.viscous_loss_factor",
    "power of each pinion": "power",
}
_TORSIONAL: Mapping[str, str] = {
    "inertia of the pinion": "box.pinion_inertia",
    "inertia of the face gear": "box.gear_inertia",
    "inertia of the load": "box.load_inertia",
    "mesh stiffness": "box.mesh_stiffness",
    "mesh damping": "box.mesh_damping",
    "input shaft stiffness": "box.input_stiffness",
    "input shaft damping": "box.input_damping",
    "output shaft stiffness": "box.output_stiffness",
    "output shaft damping": "box.output_damping",
}


def possible_changes(model: Transverse | Torsional) -> tuple[Change, ...]:
    """Parameters of a model that a designer can change by parts of their value; those that are 0 are left out.

    Parameters
    ----------
    model : Transverse or Torsional

    Returns
    -------
    tuple of Change
        For several pinions also the angle of each but the first, by parts of the angular pitch, that is its phase.
    """
    names = _TRANSVERSE if isinstance(model, Transverse) else _TORSIONAL
    changes = [
        Change(name, partial(_scaled, parameter=parameter))
        for name, parameter in names.items()
        if _is_given(model, parameter)
    ]
    pinions = len(model.pinion_angles) if isinstance(model, Transverse) else 0
    changes += [
        Change(f"phase of pinion {number + 1}", partial(_rephased, pinion=number))
        for number in range(1, pinions)
    ]
    return tuple(changes)


def _is_given(model: Any, parameter: str) -> bool:
    """Whether a parameter has a value that can be scaled: neither 0 nor, as a power may be, left out."""
    try:
        return value_of(model, parameter) != 0.0
    except ValueError:
        return False


def _scaled(model: Any, change: float, parameter: str) -> Any:
    return replace_parameter(model, parameter, value_of(model, parameter) * (1 + change))


def _rephased(model: Transverse, change: float, pinion: int) -> Transverse:
    angles = list(model.pinion_angles)
    angles[pinion] += change * model.body.drive.angular_pitch
    return replace(model, pinion_angles=angles)


def effects_of_changes(
    model: Transverse | Torsional,
    found: Sequence[Tongue],
    speed_range: tuple[float, float],
    parameters: str,
    *,
    followed: int = 3,
) -> xr.Dataset:
    """Rank changes of a model by what they do to its tongues.

    The changes that narrow the tongues most, or slow their growth where all speeds are unstable, are made in earnest,
    by ten percent in the better direction, with all tongues traced anew.

    Parameters
    ----------
    model : Transverse or Torsional
    found : sequence of Tongue
        Its tongues.
    speed_range : tuple of float
        Lowest and highest speed that they were looked for in [rad/s]. Borders there do not move.
    parameters : str
        For the provenance.
    followed : int
        Number of changes that are made in earnest.

    Returns
    -------
    xarray.Dataset
        Over ``change``, the most effective first: ``width_slope`` [rpm], ``growth_slope`` [1/s] of the unstable width
        and of the strongest tongue's growth for one percent more (of a parameter, of the mesh period for a phase);
        ``width_after`` [rpm], ``growth_after`` [1/s] for ten percent in the better direction, NaN where that was not
        followed or the model allows no such value. Names in the coordinate ``change_name``.
    """
    followed = integer_at_least("followed", followed, 0)
    changes = possible_changes(model) if found else ()
    slopes = [_slopes(model, change, found, speed_range) for change in changes]
    # Where all speeds are unstable no width changes: growth decides.
    order = sorted(range(len(changes)), key=lambda i: (-abs(slopes[i][0]), -abs(slopes[i][1])))
    after = np.full((len(order), 2), np.nan)
    for place, i in enumerate(order[:followed]):
        after[place] = _after(model, changes[i], slopes[i][0] or slopes[i][1], speed_range)
    table = np.reshape([slopes[i] for i in order], (len(order), 2)) / 100
    return xr.Dataset(
        {
            "width_slope": variable(
                "change",
                rpm(table[:, 0]),
                "Change of the unstable width per percent",
                "rpm",
                rtol=1e-3,
                atol=1e-3,
            ),
            "growth_slope": variable(
                "change",
                table[:, 1],
                "Change of the largest growth rate per percent",
                "1/s",
                rtol=1e-3,
                atol=1e-4,
            ),
            "width_after": variable(
                "change", rpm(after[:, 0]), "Unstable width after ten percent", "rpm", rtol=1e-6, atol=1e-3
            ),
            "growth_after": variable(
                "change", after[:, 1], "Largest growth rate after ten percent", "1/s", rtol=1e-6, atol=1e-3
            ),
        },
        coords={
            "change": np.arange(len(order)),
            "change_name": text("change", [changes[i].name for i in order], "What is changed"),
        },
        attrs={"parameters": parameters},
    )


def _slopes(
    model: Any, change: Change, found: Sequence[Tongue], speed_range: tuple[float, float]
) -> tuple[float, float]:
    """Differentiate the unstable width [rad/s] and the largest growth rate [1/s] by the relative change."""
    more, less = change.apply(model, _STEP), change.apply(model, -_STEP)

    def by_change(speed: float) -> float:
        ends = (growth_rate(other.system(speed)) for other in (more, less))
        return (next(ends) - next(ends)) / (2 * _STEP)

    def by_speed(speed: float) -> float:
        step = _STEP * speed
        ends = (growth_rate(model.system(speed + sign * step)) for sign in (1, -1))
        return (next(ends) - next(ends)) / (2 * step)

    width = 0.0
    for tongue in found:
        for border, sign in ((tongue.lower, -1), (tongue.upper, 1)):
            if border not in speed_range:
                width -= sign * by_change(border) / by_speed(border)
    strongest = max(found, key=lambda tongue: tongue.growth_rate)
    return width, by_change(strongest.peak)


def _after(model: Any, change: Change, slope: float, speed_range: tuple[float, float]) -> tuple[float, float]:
    """Unstable width [rad/s] and largest growth rate [1/s] after a change in the better direction."""
    try:
        changed = change.apply(model, -math.copysign(FOLLOWED, slope))
    except ValueError:  # out of the range that the model is valid in
        return math.nan, math.nan
    found = tongues(changed, *speed_range)
    return unstable_width(found), max((tongue.growth_rate for tongue in found), default=0.0)
