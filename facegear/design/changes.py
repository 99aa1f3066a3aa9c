"""What to change first: how the tongues of a model answer to each of its parameters.

A border, where the growth rate σ vanishes, moves by dΩ = −(∂σ/∂p)/(∂σ/∂Ω) dp; a peak, where ∂σ/∂Ω = 0, grows by
∂σ/∂p dp. Both come from differences at fixed speeds, so that they are there for every parameter, those that move the
contact as well.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from operator import attrgetter
from typing import Any

import numpy as np
import xarray as xr

from facegear.floquet.models import Model, is_part, replace_at
from facegear.floquet.multipliers import growth_rate
from facegear.maps.tracing import Tongue, tongues
from facegear.support.labelled import text, variable
from facegear.support.parameters import integer_at_least, rpm
from facegear.support.threads import one_thread
from facegear.support.types import FloatArray

# Relative step of parameters and speeds in the differences. At a border the critical multiplier leaves the unit circle
# like a root, and lightly damped modes bend the growth rate within some 1e-5 of the speed; errors of growth rates are
# the same on both sides but for rounding. Models hold values for the same that are several times closer.
_STEP = 1e-6
# The same around a peak, in widths of the tongue: a parabola through three such points is as good as rounding lets it.
_OF_WIDTH = 3e-4
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


def possible_changes(model: Model) -> tuple[Change, ...]:
    """Parameters of a model that a designer can change by parts of their value; those that are 0 are left out.

    Parameters
    ----------
    model : Model
        Its fields, and those of the dataclasses it holds, say what they are called
        (:func:`facegear.support.parameters.designed`).

    Returns
    -------
    tuple of Change
        Of a field that lists the angles of pinions one change for each but the first, by parts of the angular pitch,
        that is its phase. What stands in several places, as the material of body and teeth, changes in all of them.

    Examples
    --------
    >>> from facegear.mechanics.cases import EXAMPLE_B
    >>> [change.name for change in possible_changes(EXAMPLE_B)][:2]
    ['thickness of the body', 'bore radius']
    """
    places: dict[str, list[Change]] = {}
    for change in _changes(model, ()):
        places.setdefault(change.name, []).append(change)
    return tuple(Change(name, partial(_everywhere, changes=same)) for name, same in places.items())


def _everywhere(model: Any, change: float, changes: Sequence[Change]) -> Any:
    for each in changes:
        model = each.apply(model, change)
    return model


def _changes(part: Any, path: tuple[str, ...]) -> Iterator[Change]:
    """List the changes of a dataclass and of those it holds; `path` leads to it from the model."""
    for each in dataclasses.fields(part):
        value = getattr(part, each.name)
        here = (*path, each.name)
        words = each.metadata.get("designed")
        if is_part(value):
            yield from _changes(value, here)
        elif words is not None and "step" in each.metadata:
            step = attrgetter(each.metadata["step"])(part)
            for number in range(1, len(value)):
                yield Change(f"{words} {number + 1}", partial(_moved, path=here, number=number, step=step))
        elif words is not None and value:
            yield Change(words, partial(scaled, path=here))


def _at(model: Any, path: tuple[str, ...]) -> Any:
    return attrgetter(".".join(path))(model)


def scaled(model: Any, change: float, path: tuple[str, ...]) -> Any:
    """Return a model with the number at the end of a path of fields changed by a part of itself."""
    return replace_at(model, path, _at(model, path) * (1 + change))


def _moved(model: Any, change: float, path: tuple[str, ...], number: int, step: float) -> Any:
    values = list(_at(model, path))
    values[number] += change * step
    return replace_at(model, path, tuple(values))


def slopes_of_tongues(
    model: Model, changes: Sequence[Change], found: Sequence[Tongue], speeds: tuple[float, float]
) -> FloatArray:
    """Differentiate the borders and the growth of tongues by relative changes of a model.

    Parameters
    ----------
    model : Model
    changes : sequence of Change
        C of them, such as :func:`possible_changes`.
    found : sequence of Tongue
        T tongues of the model.
    speeds : tuple of float
        Lowest and highest speed that they were looked for in [rad/s]. Borders there do not move.

    Returns
    -------
    array, shape (C, T, 3)
        Of lower and upper border [rad/s] and of the growth rate at the peak [1/s], for a change by its whole value (a
        hundred percent more; of a phase, by a mesh period). NaN for changes that the model refuses in both directions.
    """
    steep = [
        [None if border in speeds else _by_speed(model, border) for border in (each.lower, each.upper)]
        for each in found
    ]
    peaks = [_peak(model, tongue, speeds) for tongue in found]
    slopes = np.full((len(changes), len(found), 3), np.nan)
    for row, change in zip(slopes, changes, strict=True):
        sides = _sides(model, change)
        if not sides:
            continue
        for place, tongue in enumerate(found):
            for end, border in enumerate((tongue.lower, tongue.upper)):
                slope = steep[place][end]
                row[place, end] = 0.0 if slope is None else -_by_change(sides, border) / slope
            row[place, 2] = _by_change(sides, peaks[place])
    return slopes


def _peak(model: Model, tongue: Tongue, speeds: tuple[float, float]) -> float:
    """Speed of the largest growth rate, to more digits than a search for it gives.

    Where the peak moves the growth at a constant speed changes most just beside it, and much more than the peak.
    """
    step = min(_STEP * tongue.peak, _OF_WIDTH * tongue.width)
    if min(tongue.peak - speeds[0], speeds[1] - tongue.peak) <= step:
        return tongue.peak
    below, here, above = (growth_rate(model.system(tongue.peak + k * step)) for k in (-1.0, 0.0, 1.0))
    bend = below - 2.0 * here + above
    further = 0.0 if bend >= 0.0 else 0.5 * (below - above) / bend
    # At a kink, where another motion grows faster, there is no vertex nearby.
    return tongue.peak + step * further if abs(further) < 1.0 else tongue.peak


def _by_change(sides: list[tuple[float, Any]], speed: float) -> float:
    """Slope of the growth rate over the relative change, at a speed [rad/s]."""
    (above, more), (below, less) = sides
    return (growth_rate(more.system(speed)) - growth_rate(less.system(speed))) / (above - below)


def _by_speed(model: Model, speed: float) -> float:
    step = _STEP * speed
    above, below = (growth_rate(model.system(speed + sign * step)) for sign in (1, -1))
    return (above - below) / (2 * step)


@one_thread()
def effects_of_changes(
    model: Model,
    found: Sequence[Tongue],
    speeds: tuple[float, float],
    parameters: str,
    *,
    followed: int = 3,
) -> xr.Dataset:
    """Rank changes of a model by what they do to its tongues.

    The changes that narrow the tongues most, or slow their growth where all speeds are unstable, are made in earnest,
    by ten percent in the better direction, with all tongues traced anew.

    Parameters
    ----------
    model : Model
    found : sequence of Tongue
        Its tongues.
    speeds : tuple of float
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
    every = slopes_of_tongues(model, changes, found, speeds)
    # What the model refuses in both directions cannot be changed by parts of its value.
    taken = [i for i in range(len(changes)) if np.isfinite(every[i]).all()]
    changes, every = tuple(changes[i] for i in taken), every[taken]
    strongest = max(range(len(found)), key=lambda i: found[i].growth_rate, default=0)
    slopes = [((each[:, 1] - each[:, 0]).sum(), each[strongest, 2]) for each in every]
    # Where all speeds are unstable no width changes: growth decides.
    order = sorted(range(len(changes)), key=lambda i: (-abs(slopes[i][0]), -abs(slopes[i][1])))
    after = np.full((len(order), 2), np.nan)
    for place, i in enumerate(order[:followed]):
        after[place] = _after(model, changes[i], slopes[i][0] or slopes[i][1], speeds)
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


def _sides(model: Any, change: Change) -> list[tuple[float, Any]]:
    """Relative changes, one to each side, with the models that they make; none where the model takes neither."""
    sides = [
        (step, changed) for step in (_STEP, -_STEP) if (changed := _tried(model, change, step)) is not None
    ]
    if len(sides) == 1:  # the value stands at the end of its range
        sides.append((0.0, model))
    return sides


def _tried(model: Any, change: Change, size: float) -> Any:
    """Return the changed model, or None where that leaves the range in which the model is valid."""
    try:
        return change.apply(model, size)
    except ValueError:
        return None


def _after(model: Any, change: Change, slope: float, speeds: tuple[float, float]) -> tuple[float, float]:
    """Unstable width [rad/s] and largest growth rate [1/s] after a change in the better direction."""
    changed = _tried(model, change, -math.copysign(FOLLOWED, slope))
    if changed is None:
        return math.nan, math.nan
    found = tongues(changed, speeds)
    return unstable_width(found), max((tongue.growth_rate for tongue in found), default=0.0)
