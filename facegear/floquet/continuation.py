"""Families of periodic motions along one parameter, through folds, with what happens on the way.

A motion of a system with clearances changes with speed, force or gap, and may turn back where two motions meet in a
fold: the family is followed by its arc length in the space of initial state and parameter
(:mod:`facegear.floquet.arc_length`). Where a Floquet multiplier passes 1 (fold), −1 (flip, from which motions of twice
the period branch) or a pair of them the unit circle (torus), the place is found as the root of a function of the
multipliers along the family.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from scipy.optimize import brentq

from facegear.floquet.arc_length import (
    USUAL_STEPS,
    Following,
    LeftError,
    Point,
    Setting,
    Systems,
    away,
    corrected,
    first_point,
    slope_at,
)
from facegear.floquet.branches import Branch, Kind, Special
from facegear.floquet.orbits import Orbit, Step, periodic_orbit
from facegear.support.kinds import named, require_kind
from facegear.support.parameters import finite, within
from facegear.support.types import FloatArray

# Arc to which a special point is found; arcs below which a family is stuck.
_RESOLUTION, _STUCK = 1e-9, 1e-7
# First arc onto a branch of twice the period.
_ONTO_BRANCH = 1e-3
# Least cosine between the tangents at both ends of an arc.
_STRAIGHT = 0.9
# Way from the tangent, over the arc, at which another family may have been met.
_ASIDE = 0.5
# Distance of the end of a period from its start, over the size of the motion, at which that is one that repeats itself.
_PERIODIC = 1e-4
# Motions of a family from which another one nearby is looked for.
_NEIGHBOURS = 3
# Part of the parameter in a tangent that is no rounding.
_VERTICAL = 1e-6


def followed(
    systems: Systems,
    parameter: float,
    orbit: Orbit,
    low: float,
    high: float,
    *,
    direction: float = 1.0,
    following: Following | None = None,
) -> Branch:
    """Follow a periodic motion along a parameter, through folds, until it leaves a range.

    Parameters
    ----------
    systems : callable
        Parameter to :class:`ClearanceSystem`, whose breakpoints stay where they are.
    parameter : float
        Where the motion is known, from `low` to `high`.
    orbit : Orbit
        That motion, of any number of periods.
    low, high : float
        Ends of the range.
    direction : float
        Sense in which the parameter first goes: greater than 0, upwards, or less.
    following : Following, optional

    Returns
    -------
    Branch
        All that was found; `ended` says why it ends.

    Raises
    ------
    TypeError, ValueError
        Naming the argument.

    Examples
    --------
    A mass on a spring that acts beyond a gap of 1, under a force that swings: resonance bends to lower frequencies.

    >>> from facegear.floquet.clearance import ClearanceSystem
    >>> from facegear.floquet.orbits import periodic_orbit
    >>> from facegear.floquet.loads import ContactLoad
    >>> from facegear.floquet.periodic import PeriodicSystem
    >>> from facegear.floquet.piecewise import PiecewiseChebyshev
    >>> one = PiecewiseChebyshev.constant([1.0])
    >>> force = PiecewiseChebyshev.fit(lambda x, piece: 0.1 + 0.05 * np.cos(2.0 * np.pi * x), [0.0])
    >>> def at(frequency):
    ...     loads = (ContactLoad(one, 1.0), ContactLoad(one, 1.0))
    ...     system = PeriodicSystem([[1.0]], [[0.06]], [[0.0]], loads, 2.0 * np.pi / frequency, force)
    ...     return ClearanceSystem(system, sides=(1, -1), clearances=(1.0, 1.0))
    >>> branch = followed(at, 1.0, periodic_orbit(at(1.0)), 0.46, 1.0, direction=-1.0)
    >>> [(point.kind, round(point.parameter, 4)) for point in branch.special], branch.ended
    ([], 'at 0.46, the end of the range')
    """
    setting = Setting.of(systems, orbit, low, high, following)
    at = within("parameter", parameter, setting.low, setting.high)
    if finite("direction", direction) == 0.0:
        raise ValueError(
            "direction must be greater than 0 for larger parameters or less for smaller ones, got 0"
        )
    sense = math.copysign(1.0, direction)
    first = first_point(setting, orbit, at, sense)
    missed = np.abs(
        setting.scaled(first.step.transition @ first.state + first.step.moved - first.state)
    ).max()
    if missed > _PERIODIC:
        raise ValueError(
            f"orbit must be a motion of systems({at:.9g}): from where it begins, that ends {missed:.2g} of its size "
            "away"
        )
    if at == (setting.high if sense > 0.0 else setting.low):
        return Branch(np.array([at]), (orbit,), (), f"at {at:.9g}, the end of the range")
    return _followed(setting, first, setting.following.longest_arc / 30.0)


def doubled(
    systems: Systems, flip: Special, low: float, high: float, *, following: Following | None = None
) -> Branch:
    """Follow the motion of twice the period that branches from a flip.

    Parameters
    ----------
    systems, low, high, following
        As for :func:`followed`.
    flip : Special
        Of that kind.

    Returns
    -------
    Branch
        From the first motion beside the flip.

    Raises
    ------
    TypeError, ValueError
        Naming the argument.
    ArithmeticError
        If no such motion is found beside the flip.
    """
    if not isinstance(flip, Special) or flip.kind != "flip":
        raise ValueError(f'flip must be a Special of kind "flip", got {getattr(flip, "kind", named(flip))}')
    setting = Setting.of(systems, flip.orbit, low, high, following, 2)
    values, vectors = np.linalg.eig(setting.scale @ flip.orbit.transition @ np.linalg.inv(setting.scale))
    direction = vectors[:, np.abs(values + 1.0).argmin()].real
    tangent = np.append(direction / np.linalg.norm(direction), 0.0)
    whole = setting.at(flip.parameter)
    step = Step.of(whole, flip.orbit.pattern.repeated(2), setting.panels)
    state = flip.orbit.start
    point = Point(flip.parameter, step, step.motion(state), tangent, slope_at(setting, step, flip.parameter))
    onto, _ = corrected(setting, point, _ONTO_BRANCH)
    return _followed(setting, onto, _ONTO_BRANCH)


def orbits_at(systems: Systems, branch: Branch, parameter: float) -> tuple[Orbit | None, ...]:
    """Find the motions of a family at one value of its parameter.

    Parameters
    ----------
    systems : callable
        As for :func:`followed`.
    branch : Branch
    parameter : float

    Returns
    -------
    tuple of Orbit or None
        One for each of :attr:`Branch.sheets`; None where that has no such value, or the motion nearest to it leads to
        none, as may be next to a fold.

    Raises
    ------
    TypeError, ValueError
        Naming the argument.
    """
    require_kind("branch", branch, Branch)
    value = finite("parameter", parameter)
    return tuple(_orbit_at(systems, sheet, value) for sheet in branch.sheets)


def _orbit_at(systems: Systems, sheet: Branch, parameter: float) -> Orbit | None:
    if not sheet.parameters.min() <= parameter <= sheet.parameters.max():
        return None
    # Which side of a fold a motion is on: the sign of det(I − Φ), which only a fold changes.
    middle = sheet.orbits[len(sheet.orbits) // 2]
    for place in np.argsort(np.abs(sheet.parameters - parameter))[:_NEIGHBOURS].tolist():
        guess = sheet.orbits[place]
        try:
            found = periodic_orbit(systems(parameter), guess.periods, guess, guess.panels)
        except ArithmeticError:
            continue
        if _side(found) * _side(middle) > 0.0:
            return found
    return None


def _side(orbit: Orbit) -> float:
    return float(np.prod(1.0 - orbit.multipliers).real)


def _followed(setting: Setting, first: Point, arc: float) -> Branch:
    points, special = [first], list[Special]()
    longest, ended, why = setting.following.longest_arc, "", ""
    largest = setting.following.largest * setting.size
    orbits = [_orbit(setting, first)]
    while not ended:
        point = points[-1]
        if len(orbits) >= setting.following.most:
            ended = f"after {len(orbits)} motions, at {point.parameter:.9g}"
            break
        if arc < _STUCK:
            ended = f"stuck at {point.parameter:.9g}: {why}"
            break
        try:
            new, count = corrected(setting, point, arc)
        except LeftError as error:
            last = _at_bound(setting, point)
            if last is None:
                arc, why = arc / 3.0, str(error)
                continue
            new, count = last, 0
            ended = f"at {new.parameter:.9g}, the end of the range"
            arc = float(point.tangent @ away(setting, point, new))
        except (ArithmeticError, np.linalg.LinAlgError) as error:
            arc, why = arc / 3.0, str(error)
            continue
        off = np.linalg.norm(away(setting, point, new) - arc * point.tangent)
        if not ended and (
            off > _ASIDE * arc or (new.tangent @ point.tangent < _STRAIGHT and arc > 10.0 * _STUCK)
        ):
            arc, why = arc / 2.0, "the motion turns or jumps however short the step"
            continue
        special += _special(setting, point, new, arc)
        orbits.append(_orbit(setting, new))
        points = [points[0], new]
        if len(orbits) > 5 and _closed(setting, points[0], point, new):
            ended = "closed upon itself"
        size = new.size(setting)
        if size > largest and not ended:
            ended = (
                f"at {new.parameter:.9g}, where the motion is {setting.following.largest:g} times as large"
            )
        if not 0.5 < size / setting.size < 2.0:
            factor = size / setting.size
            setting = replace(setting, size=size)
            points = [point.measured(factor) for point in points]
        if count < USUAL_STEPS:
            arc = min(1.5 * arc, longest)
        elif count > USUAL_STEPS + 1:
            arc *= 0.7
    parameters = np.array([x for x, _ in orbits])
    return Branch(parameters, tuple(orbit for _, orbit in orbits), tuple(special), ended)


def _orbit(setting: Setting, point: Point) -> tuple[float, Orbit]:
    return point.parameter, point.step.orbit(setting.one(point.parameter), setting.base_periods, point.motion)


def _at_bound(setting: Setting, point: Point) -> Point | None:
    """Motion at the end of the range to which a point leads, if it is found from there without a turn."""
    rate = float(point.tangent[-1]) * setting.span
    bound = setting.high if rate > 0.0 else setting.low
    arc = (bound - point.parameter) / rate if rate != 0.0 else np.inf
    if not 0.0 < arc <= 3.0 * setting.following.longest_arc:
        return None
    try:
        new, _ = corrected(setting, point, arc, bound)
    except (ArithmeticError, np.linalg.LinAlgError):
        return None
    straight = new.tangent @ point.tangent > _STRAIGHT
    return new if straight and np.linalg.norm(away(setting, point, new)) < 2.0 * arc else None


def _closed(setting: Setting, first: Point, before: Point, new: Point) -> bool:
    """Whether the first motion lies between two successive ones."""

    def place(point: Point) -> FloatArray:
        return np.append(setting.scaled(point.state), point.parameter / setting.span)

    start, end, at = place(before), place(new), place(first)
    step = end - start
    part = (at - start) @ step / (step @ step)
    off = np.linalg.norm(at - start - part * step)
    same = new.tangent @ first.tangent > _STRAIGHT
    return bool(0.0 < part <= 1.0 and off < 0.05 * np.linalg.norm(step) and same)


def _special(setting: Setting, point: Point, new: Point, arc: float) -> list[Special]:
    """Places between two points at which a test changes its sign, in their order."""
    found = []
    for kind, before in point.tests.items():
        # A family of one parameter, as that of a linear system where it flips, has tangents that are rounding there.
        clear = kind != "fold" or min(abs(before), abs(new.tests[kind])) > _VERTICAL
        if before * new.tests[kind] < 0.0 and clear:
            located = _located(setting, point, arc, kind)
            if located is not None:
                found.append(located)
    found.sort(key=lambda item: item[0])
    return [item for _, item in found]


def _located(setting: Setting, point: Point, arc: float, kind: Kind) -> tuple[float, Special] | None:
    known: dict[float, Point] = {0.0: point}

    def test(s: float) -> float:
        if s not in known:
            known[s] = corrected(setting, point, s)[0]
        return known[s].tests[kind]

    try:
        at = float(brentq(test, 0.0, arc, xtol=_RESOLUTION, rtol=1e-12))
        there = known[at] if at in known else corrected(setting, point, at)[0]
    except (ArithmeticError, np.linalg.LinAlgError):
        return None
    values = np.linalg.eigvals(there.step.scaled_transition)
    # Two real multipliers with product 1 change the sign of the test for a torus too, and are none.
    crossing = values[np.abs(np.abs(values) - 1.0).argmin()]
    if kind == "torus" and abs(crossing.imag) < 1e-6:
        return None
    parameter, orbit = _orbit(setting, there)
    return at, Special(kind, parameter, orbit)
