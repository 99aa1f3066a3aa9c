"""Families of periodic motions along one parameter, through folds, with what happens on the way.

A motion of a system with clearances changes with speed, force or gap, and may turn back where two motions meet in a
fold: the family is followed by its arc length in the space of initial state and parameter (Keller, in: Applications of
Bifurcation Theory, 1977), each time with Newton's method on the whole motion (:mod:`facegear.floquet.contact_panels`).
Where a Floquet multiplier passes 1 (fold), −1 (flip, from which motions of twice the period branch) or a pair of them
the unit circle (torus), the place is found as the root of a function of the multipliers along the family.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from facegear.floquet.clearance import ClearanceSystem
from facegear.floquet.contact_panels import Motion, Panels, linearised
from facegear.floquet.orbits import Orbit, Step, periodic_orbit, require_clearances
from facegear.floquet.periodic import named
from facegear.support.parameters import finite, integer_at_least, keep, positive, within
from facegear.support.types import FloatArray

Kind = Literal["fold", "flip", "torus"]
Systems = Callable[[float], ClearanceSystem]

# Change of motion and parameter, over their sizes, and distance from the clearance, at which a step has settled.
_SETTLED = 1e-10
# Newton's method: steps after which it is given up, and those with the first derivative by the parameter.
_MOST_STEPS, _OLD_SLOPE = 12, 4
# Steps that Newton's method takes where the arc is left as it is.
_USUAL_STEPS = 6
# Change of the parameter for its derivative, over its span.
_DIFFERENCE = 1e-6
# Arc to which a special point is found; arcs below which a family is stuck.
_RESOLUTION, _STUCK = 1e-9, 1e-7
# First arc, and that onto a branch of twice the period.
_FIRST_ARC, _ONTO_BRANCH = 1e-3, 1e-3
# Least cosine between the tangents at both ends of an arc.
_STRAIGHT = 0.9
# Way from the tangent, over the arc, at which another family may have been met.
_ASIDE = 0.5
# Distance of the end of a period from its start, over the size of the motion, at which that is one that repeats itself.
_PERIODIC = 1e-4
# Distance of the ends of panels, in periods, that a derivative along them may have.
_ALIKE = 1e-3
# Motions of a family from which another one nearby is looked for.
_NEIGHBOURS = 3
# Part of the parameter in a tangent that is no rounding.
_VERTICAL = 1e-6


@dataclass(frozen=True, eq=False)
class Special:
    """A place on a family where multipliers pass the unit circle.

    Attributes
    ----------
    kind : {"fold", "flip", "torus"}
    parameter : float
    orbit : Orbit
    """

    kind: Kind
    parameter: float
    orbit: Orbit


@dataclass(frozen=True, eq=False)
class Branch:
    """A family of periodic motions in the order in which it was followed.

    Attributes
    ----------
    parameters : array, shape (m,)
    orbits : tuple of Orbit
    special : tuple of Special
        In the same order.
    ended : str
        Why it ends: at which end of the range, closed upon itself, after so many motions, or stuck where and why.
    """

    parameters: FloatArray
    orbits: tuple[Orbit, ...]
    special: tuple[Special, ...]
    ended: str

    @cached_property
    def stable(self) -> NDArray[np.bool_]:
        """Whether each motion is stable, shape (m,)."""
        return np.array([orbit.is_stable for orbit in self.orbits], dtype=bool)

    def along(self, function: Callable[[Orbit], object]) -> FloatArray:
        """Values of a function of each motion, shape (m, ...)."""
        return np.array([function(orbit) for orbit in self.orbits], dtype=float)

    @cached_property
    def sheets(self) -> tuple[Branch, ...]:
        """Parts along which the parameter only grows or only falls, one for each passage between folds."""
        rises = np.diff(self.parameters) > 0.0
        turns = np.flatnonzero(rises[1:] != rises[:-1]) + 1
        ends = [0, *turns.tolist(), self.parameters.size - 1]
        return tuple(
            Branch(self.parameters[i : j + 1], self.orbits[i : j + 1], (), self.ended)
            for i, j in pairwise(ends)
        )

    def reversed(self) -> Branch:
        """Return the family in the opposite order."""
        return replace(
            self, parameters=self.parameters[::-1], orbits=self.orbits[::-1], special=self.special[::-1]
        )

    def joined(self, other: Branch) -> Branch:
        """Return this family, followed by another that begins with the motion with which this one ends."""
        return Branch(
            np.concatenate([self.parameters, other.parameters[1:]]),
            self.orbits + other.orbits[1:],
            self.special + other.special,
            other.ended,
        )


@dataclass(frozen=True)
class Following:
    """How a family is followed.

    Parameters
    ----------
    longest_arc : float
        Longest step, in parts of the range of the parameter and of the size of the motion, from 1e-6 to 1.
    most : int
        Motions after which it ends.
    largest : float
        Size of the motion, over that of the first, beyond which it ends: some families grow without bound.
    panels : Panels
        How finely motions are resolved.

    Raises
    ------
    TypeError, ValueError
        Naming the argument.
    """

    longest_arc: float = 0.1
    most: int = 3000
    largest: float = 1e3
    panels: Panels = field(default_factory=Panels)

    def __post_init__(self) -> None:
        keep(self, longest_arc=within("longest_arc", self.longest_arc, 1e-6, 1.0))
        keep(self, most=integer_at_least("most", self.most, 2), largest=positive("largest", self.largest))
        if not isinstance(self.panels, Panels):
            raise TypeError(f"panels must be a Panels, got {named(self.panels)}")


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

    >>> from facegear.floquet.orbits import periodic_orbit
    >>> from facegear.floquet.periodic import ContactLoad, PeriodicSystem
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
    setting = _Setting.of(systems, orbit, low, high, following)
    at = within("parameter", parameter, setting.low, setting.high)
    if finite("direction", direction) == 0.0:
        raise ValueError(
            "direction must be greater than 0 for larger parameters or less for smaller ones, got 0"
        )
    sense = math.copysign(1.0, direction)
    first = _start(setting, orbit, at, sense)
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
    setting = _Setting.of(systems, flip.orbit, low, high, following, 2)
    values, vectors = np.linalg.eig(setting.scale @ flip.orbit.transition @ np.linalg.inv(setting.scale))
    direction = vectors[:, np.abs(values + 1.0).argmin()].real
    tangent = np.append(direction / np.linalg.norm(direction), 0.0)
    whole = setting.at(flip.parameter)
    step = Step.of(whole, flip.orbit.pattern.repeated(2), setting.panels)
    state = flip.orbit.start
    point = _Point(flip.parameter, step, step.motion(state), tangent, _slope(setting, step, flip.parameter))
    onto, _ = _corrected(setting, point, _ONTO_BRANCH)
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
    if not isinstance(branch, Branch):
        raise TypeError(f"branch must be a Branch, got {named(branch)}")
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


@dataclass(frozen=True, eq=False)
class _Setting:
    """What stays the same along a family; an arc is of scaled states over their size, parameters over their span."""

    systems: Systems
    base_periods: int
    low: float
    high: float
    following: Following
    scale: FloatArray
    size: float
    kind: tuple[int, int]
    """Numbers of coordinates and loads."""

    @classmethod
    def of(
        cls,
        systems: Systems,
        orbit: Orbit,
        low: float,
        high: float,
        following: Following | None,
        times: int = 1,
    ) -> _Setting:
        if not callable(systems):
            raise TypeError(f"systems must be a function of the parameter, got {named(systems)}")
        if not isinstance(orbit, Orbit):
            raise TypeError(f"orbit must be an Orbit, got {named(orbit)}")
        low, high = finite("low", low), finite("high", high)
        if low >= high:
            raise ValueError(f"low must be less than high = {high!r}, got {low!r}")
        scale = orbit.system.scale
        states = orbit.state(np.linspace(0.0, 1.0, 200, endpoint=False)) @ scale.T
        size = positive("orbit", float(np.abs(states).max()))
        kind = orbit.system.size, len(orbit.system.sides)
        return cls(systems, times * orbit.periods, low, high, following or Following(), scale, size, kind)

    @property
    def span(self) -> float:
        return self.high - self.low

    @property
    def panels(self) -> Panels:
        return self.following.panels

    def one(self, parameter: float) -> ClearanceSystem:
        system = self.systems(parameter)
        require_clearances(system)
        if (system.size, len(system.sides)) != self.kind:
            raise ArithmeticError(
                f"systems has {system.size} coordinates and {len(system.sides)} loads at {parameter:.9g}, "
                f"{self.kind[0]} and {self.kind[1]} where the family began"
            )
        return system

    def at(self, parameter: float) -> ClearanceSystem:
        return self.one(parameter).repeated(self.base_periods)

    def scaled(self, state: FloatArray) -> FloatArray:
        return self.scale @ state / self.size

    def unscaled(self, state: FloatArray) -> FloatArray:
        return np.asarray(np.linalg.solve(self.scale, state * self.size))


@dataclass(frozen=True, eq=False)
class _Slope:
    """Derivatives by the parameter at a fixed pattern: of the state after a period, and of the motion."""

    whole: FloatArray
    """∂(Φ, x_p)/∂λ, shape (2n + 1, 2n + 1)."""
    stepped: Step
    step: Step
    difference: float

    def column(self, state: FloatArray) -> FloatArray:
        return np.asarray((self.whole @ np.append(state, 1.0))[:-1])

    def reached(self, state: FloatArray) -> FloatArray:
        """Differentiate the displacements of the loads along the motion from a state."""
        here, there = self.step.motion(state), self.stepped.motion(state)
        return (there.reached - here.reached) / self.difference


@dataclass(frozen=True, eq=False)
class _Point:
    """A motion of the family and the direction in which it goes on."""

    parameter: float
    step: Step
    motion: Motion
    tangent: FloatArray
    slope: _Slope

    @property
    def state(self) -> FloatArray:
        return np.asarray(self.motion.origin[:-1])

    def size(self, setting: _Setting) -> float:
        """Largest scaled state along the motion."""
        return float(np.abs(self.motion.starts[:, :-1] @ setting.scale.T).max())

    def measured(self, factor: float) -> _Point:
        """Return the point for sizes that are so many times as large."""
        tangent = self.tangent.copy()
        tangent[:-1] /= factor
        return replace(self, tangent=tangent / np.linalg.norm(tangent))

    @cached_property
    def tests(self) -> dict[Kind, float]:
        """Functions of the multipliers that change sign at special points."""
        values = np.linalg.eigvals(self.step.scaled_transition)
        pairs = np.triu_indices(len(values), 1)
        return {
            "fold": float(self.tangent[-1]),
            "flip": float(np.prod(values + 1.0).real),
            "torus": float(np.prod(values[pairs[0]] * values[pairs[1]] - 1.0).real),
        }


def _slope(setting: _Setting, step: Step, parameter: float) -> _Slope:
    change = _DIFFERENCE * setting.span
    if parameter + change > setting.high:
        change = -change
    other = linearised(setting.at(parameter + change), step.along.pattern, setting.panels)
    return _Slope((other.whole - step.along.whole) / change, Step(other, step.base), step, change)


def _reached(setting: _Setting, point: _Point) -> FloatArray:
    """Differentiate the displacements of the loads by the parameter, at the places where the point has them."""
    here, there = (step.along.pattern.edges for step in (point.step, point.slope.step))
    alike = here.size == there.size and float(np.abs(here - there).max()) < _ALIKE
    slope = point.slope if alike else _slope(setting, point.step, point.parameter)
    return slope.reached(point.state)


def _bordered(
    setting: _Setting, step: Step, slope: _Slope, state: FloatArray, tangent: FloatArray, right: FloatArray
) -> FloatArray:
    """Solve for the change of scaled state and scaled parameter with a given residual and arc."""
    n = state.size
    matrix = np.empty((n + 1, n + 1))
    inverse = np.linalg.inv(setting.scale)
    matrix[:n, :n] = setting.scale @ step.transition @ inverse - np.eye(n)
    matrix[:n, n] = setting.scaled(slope.column(state)) * setting.span
    matrix[n] = tangent
    return np.asarray(np.linalg.solve(matrix, right))


def _start(setting: _Setting, orbit: Orbit, parameter: float, sense: float) -> _Point:
    state = orbit.start
    step = Step.of(setting.at(parameter), orbit.pattern, setting.panels)
    slope = _slope(setting, step, parameter)
    ahead = np.append(np.zeros(state.size), sense)
    tangent = _bordered(setting, step, slope, state, ahead, np.append(np.zeros(state.size), 1.0))
    return _Point(parameter, step, step.motion(state), tangent / np.linalg.norm(tangent), slope)


class _LeftError(ArithmeticError):
    """The range of the parameter was left."""


def _corrected(
    setting: _Setting, point: _Point, arc: float, bound: float | None = None
) -> tuple[_Point, int]:
    """Motion at some arc from a point, or there where the parameter is `bound`, and how many steps it took.

    Raises
    ------
    ArithmeticError
        If it is not found.
    """
    n = point.state.size
    row, target = point.tangent, arc
    if bound is not None:
        row, target = np.append(np.zeros(n), 1.0), (bound - point.parameter) / setting.span
    moved = setting.unscaled(point.tangent[:n])
    along = point.step.motion(moved, 0.0)
    rate = point.tangent[n] * setting.span
    further = arc * (along.reached + rate * _reached(setting, point))
    pattern, _ = point.step.pattern(point.motion, further)
    state = point.state + arc * moved
    parameter = point.parameter + arc * rate if bound is None else bound
    slope: _Slope | None = None
    largest = np.inf
    for number in range(1, _MOST_STEPS + 1):
        if not setting.low <= parameter <= setting.high:
            raise _LeftError(f"the range is left at {parameter:.9g}")
        step = Step.of(setting.at(parameter), pattern, setting.panels)
        fresh = slope is None or number > _OLD_SLOPE
        slope = _slope(setting, step, parameter) if slope is None or fresh else slope
        left = step.transition @ state + step.moved - state
        gone = np.append(setting.scaled(state - point.state), (parameter - point.parameter) / setting.span)
        right = np.append(-setting.scaled(left), target - row @ gone)
        change = _bordered(setting, step, slope, state, row, right)
        last, largest = largest, float(np.abs(change).max())
        if not np.isfinite(change).all() or largest > 10.0 or (number > _USUAL_STEPS and largest > last):
            raise ArithmeticError(
                f"Newton's method leads away: its last step changed the motion by {largest:.2g}"
            )
        state = state + setting.unscaled(change[:n])
        motion = step.motion(state)
        gone_on = float(change[n]) * setting.span
        pattern, mismatch = step.pattern(motion, gone_on * slope.reached(state) if fresh else 0.0)
        if np.abs(change).max() < _SETTLED and mismatch < _SETTLED:
            ahead = np.append(np.zeros(n), 1.0)
            tangent = _bordered(setting, step, slope, state, point.tangent, ahead)
            return _Point(parameter, step, motion, tangent / np.linalg.norm(tangent), slope), number
        parameter += gone_on if bound is None else 0.0
    raise ArithmeticError(
        f"Newton's method did not settle: last change {np.abs(change).max():.2g}, contacts off by {mismatch:.2g}"
    )


def _followed(setting: _Setting, first: _Point, arc: float) -> Branch:
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
            new, count = _corrected(setting, point, arc)
        except _LeftError as error:
            last = _at_bound(setting, point)
            if last is None:
                arc, why = arc / 3.0, str(error)
                continue
            new, count = last, 0
            ended = f"at {new.parameter:.9g}, the end of the range"
            arc = float(point.tangent @ _away(setting, point, new))
        except (ArithmeticError, np.linalg.LinAlgError) as error:
            arc, why = arc / 3.0, str(error)
            continue
        off = np.linalg.norm(_away(setting, point, new) - arc * point.tangent)
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
        if count < _USUAL_STEPS:
            arc = min(1.5 * arc, longest)
        elif count > _USUAL_STEPS + 1:
            arc *= 0.7
    parameters = np.array([x for x, _ in orbits])
    return Branch(parameters, tuple(orbit for _, orbit in orbits), tuple(special), ended)


def _orbit(setting: _Setting, point: _Point) -> tuple[float, Orbit]:
    return point.parameter, point.step.orbit(setting.one(point.parameter), setting.base_periods, point.motion)


def _away(setting: _Setting, point: _Point, new: _Point) -> FloatArray:
    """Scaled way from one point to another, state and parameter."""
    parameter = (new.parameter - point.parameter) / setting.span
    return np.append(setting.scaled(new.state - point.state), parameter)


def _at_bound(setting: _Setting, point: _Point) -> _Point | None:
    """Motion at the end of the range to which a point leads, if it is found from there without a turn."""
    rate = float(point.tangent[-1]) * setting.span
    bound = setting.high if rate > 0.0 else setting.low
    arc = (bound - point.parameter) / rate if rate != 0.0 else np.inf
    if not 0.0 < arc <= 3.0 * setting.following.longest_arc:
        return None
    try:
        new, _ = _corrected(setting, point, arc, bound)
    except (ArithmeticError, np.linalg.LinAlgError):
        return None
    straight = new.tangent @ point.tangent > _STRAIGHT
    return new if straight and np.linalg.norm(_away(setting, point, new)) < 2.0 * arc else None


def _closed(setting: _Setting, first: _Point, before: _Point, new: _Point) -> bool:
    """Whether the first motion lies between two successive ones."""

    def place(point: _Point) -> FloatArray:
        return np.append(setting.scaled(point.state), point.parameter / setting.span)

    start, end, at = place(before), place(new), place(first)
    step = end - start
    part = (at - start) @ step / (step @ step)
    off = np.linalg.norm(at - start - part * step)
    same = new.tangent @ first.tangent > _STRAIGHT
    return bool(0.0 < part <= 1.0 and off < 0.05 * np.linalg.norm(step) and same)


def _special(setting: _Setting, point: _Point, new: _Point, arc: float) -> list[Special]:
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


def _located(setting: _Setting, point: _Point, arc: float, kind: Kind) -> tuple[float, Special] | None:
    known: dict[float, _Point] = {0.0: point}

    def test(s: float) -> float:
        if s not in known:
            known[s] = _corrected(setting, point, s)[0]
        return known[s].tests[kind]

    try:
        at = float(brentq(test, 0.0, arc, xtol=_RESOLUTION, rtol=1e-12))
        there = known[at] if at in known else _corrected(setting, point, at)[0]
    except (ArithmeticError, np.linalg.LinAlgError):
        return None
    values = np.linalg.eigvals(there.step.scaled_transition)
    # Two real multipliers with product 1 change the sign of the test for a torus too, and are none.
    crossing = values[np.abs(np.abs(values) - 1.0).argmin()]
    if kind == "torus" and abs(crossing.imag) < 1e-6:
        return None
    parameter, orbit = _orbit(setting, there)
    return at, Special(kind, parameter, orbit)
