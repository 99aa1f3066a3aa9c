"""One step along a family of periodic motions: a given arc from one motion to the next.

The unknowns are the initial state and the parameter, and the arc is measured along the tangent of the family, so that
steps pass through folds (Keller, in: Applications of Bifurcation Theory, 1977). Each is settled with Newton's method on
the whole motion (:mod:`facegear.floquet.contact_panels`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from facegear.floquet.branches import Kind
from facegear.floquet.clearance import ClearanceSystem
from facegear.floquet.contact_motion import Motion
from facegear.floquet.contact_panels import linearised
from facegear.floquet.contact_patterns import Panels
from facegear.floquet.orbits import Orbit, Step, require_clearances
from facegear.support.kinds import named, require_kind
from facegear.support.parameters import finite, integer_at_least, keep, positive, within
from facegear.support.types import FloatArray

Systems = Callable[[float], ClearanceSystem]

#: Steps that Newton's method takes where the arc is left as it is.
USUAL_STEPS = 6
# Change of motion and parameter, over their sizes, and distance from the clearance, at which a step has settled.
_SETTLED = 1e-10
# Newton's method: steps after which it is given up, and those with the first derivative by the parameter.
_MOST_STEPS, _OLD_SLOPE = 12, 4
# Change of the parameter for its derivative, over its span.
_DIFFERENCE = 1e-6
# Distance of the ends of panels, in periods, that a derivative along them may have.
_ALIKE = 1e-3


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
        require_kind("panels", self.panels, Panels)


@dataclass(frozen=True, eq=False)
class Setting:
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
    ) -> Setting:
        """Check what was given; the family is of motions of `times` as many periods as the orbit.

        Raises
        ------
        TypeError, ValueError
            Naming the argument.
        """
        if not callable(systems):
            raise TypeError(f"systems must be a function of the parameter, got {named(systems)}")
        require_kind("orbit", orbit, Orbit)
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
        """Length of the range of the parameter."""
        return self.high - self.low

    @property
    def panels(self) -> Panels:
        """How finely motions are resolved."""
        return self.following.panels

    def one(self, parameter: float) -> ClearanceSystem:
        """Return the system of one period, refused where it is of another kind than that of the first motion."""
        system = self.systems(parameter)
        require_clearances(system)
        if (system.size, len(system.sides)) != self.kind:
            raise ArithmeticError(
                f"systems has {system.size} coordinates and {len(system.sides)} loads at {parameter:.9g}, "
                f"{self.kind[0]} and {self.kind[1]} where the family began"
            )
        return system

    def at(self, parameter: float) -> ClearanceSystem:
        """Return the system of all periods of a motion."""
        return self.one(parameter).repeated(self.base_periods)

    def scaled(self, state: FloatArray) -> FloatArray:
        """State over the sizes of its components."""
        return self.scale @ state / self.size

    def unscaled(self, state: FloatArray) -> FloatArray:
        """Undo :meth:`scaled`."""
        return np.asarray(np.linalg.solve(self.scale, state * self.size))


@dataclass(frozen=True, eq=False)
class Slope:
    """Derivatives by the parameter at a fixed pattern: of the state after a period, and of the motion."""

    whole: FloatArray
    """∂(Φ, x_p)/∂λ, shape (2n + 1, 2n + 1)."""
    stepped: Step
    step: Step
    difference: float

    def column(self, state: FloatArray) -> FloatArray:
        """Differentiate the state after a period that begins with a given one."""
        return np.asarray((self.whole @ np.append(state, 1.0))[:-1])

    def reached(self, state: FloatArray) -> FloatArray:
        """Differentiate the displacements of the loads along the motion from a state."""
        here, there = self.step.motion(state), self.stepped.motion(state)
        return (there.reached - here.reached) / self.difference


@dataclass(frozen=True, eq=False)
class Point:
    """A motion of the family and the direction in which it goes on."""

    parameter: float
    step: Step
    motion: Motion
    tangent: FloatArray
    slope: Slope

    @property
    def state(self) -> FloatArray:
        """State at the origin of the period."""
        return np.asarray(self.motion.origin[:-1])

    def size(self, setting: Setting) -> float:
        """Largest scaled state along the motion."""
        return float(np.abs(self.motion.starts[:, :-1] @ setting.scale.T).max())

    def measured(self, factor: float) -> Point:
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


def slope_at(setting: Setting, step: Step, parameter: float) -> Slope:
    """Differentiate a motion by the parameter, from another one close to it within the range."""
    change = _DIFFERENCE * setting.span
    if parameter + change > setting.high:
        change = -change
    other = linearised(setting.at(parameter + change), step.along.pattern, setting.panels)
    return Slope((other.whole - step.along.whole) / change, Step(other, step.base), step, change)


def _reached(setting: Setting, point: Point) -> FloatArray:
    """Differentiate the displacements of the loads by the parameter, at the places where the point has them."""
    here, there = (step.along.pattern.edges for step in (point.step, point.slope.step))
    alike = here.size == there.size and float(np.abs(here - there).max()) < _ALIKE
    slope = point.slope if alike else slope_at(setting, point.step, point.parameter)
    return slope.reached(point.state)


def _bordered(
    setting: Setting, step: Step, slope: Slope, state: FloatArray, tangent: FloatArray, right: FloatArray
) -> FloatArray:
    """Solve for the change of scaled state and scaled parameter with a given residual and arc."""
    n = state.size
    matrix = np.empty((n + 1, n + 1))
    inverse = np.linalg.inv(setting.scale)
    matrix[:n, :n] = setting.scale @ step.transition @ inverse - np.eye(n)
    matrix[:n, n] = setting.scaled(slope.column(state)) * setting.span
    matrix[n] = tangent
    return np.asarray(np.linalg.solve(matrix, right))


def first_point(setting: Setting, orbit: Orbit, parameter: float, sense: float) -> Point:
    """Return the motion at which a family begins, with the tangent along which its parameter grows or falls."""
    state = orbit.start
    step = Step.of(setting.at(parameter), orbit.pattern, setting.panels)
    slope = slope_at(setting, step, parameter)
    ahead = np.append(np.zeros(state.size), sense)
    tangent = _bordered(setting, step, slope, state, ahead, np.append(np.zeros(state.size), 1.0))
    return Point(parameter, step, step.motion(state), tangent / np.linalg.norm(tangent), slope)


class LeftError(ArithmeticError):
    """The range of the parameter was left."""


def corrected(setting: Setting, point: Point, arc: float, bound: float | None = None) -> tuple[Point, int]:
    """Find the motion at some arc from a point, or there where the parameter is `bound`, and how many steps it took.

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
    slope: Slope | None = None
    largest = np.inf
    for number in range(1, _MOST_STEPS + 1):
        if not setting.low <= parameter <= setting.high:
            raise LeftError(f"the range is left at {parameter:.9g}")
        step = Step.of(setting.at(parameter), pattern, setting.panels)
        fresh = slope is None or number > _OLD_SLOPE
        slope = slope_at(setting, step, parameter) if slope is None or fresh else slope
        left = step.transition @ state + step.moved - state
        gone = np.append(setting.scaled(state - point.state), (parameter - point.parameter) / setting.span)
        right = np.append(-setting.scaled(left), target - row @ gone)
        change = _bordered(setting, step, slope, state, row, right)
        last, largest = largest, float(np.abs(change).max())
        if not np.isfinite(change).all() or largest > 10.0 or (number > USUAL_STEPS and largest > last):
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
            return Point(parameter, step, motion, tangent / np.linalg.norm(tangent), slope), number
        parameter += gone_on if bound is None else 0.0
    raise ArithmeticError(
        f"Newton's method did not settle: last change {np.abs(change).max():.2g}, contacts off by {mismatch:.2g}"
    )


def away(setting: Setting, point: Point, new: Point) -> FloatArray:
    """Scaled way from one point to another, state and parameter."""
    parameter = (new.parameter - point.parameter) / setting.span
    return np.append(setting.scaled(new.state - point.state), parameter)
