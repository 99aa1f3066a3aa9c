"""Periodic motions of systems with clearances, and whether they are stable.

A motion that repeats itself after one period or several is found by Newton's method on the whole motion
(:mod:`facegear.floquet.contact_panels`): for the contacts of the last iterate the motion is that of a linear periodic
system, whose contacts are the next ones. The transition matrix of the last step, saltation at each contact included,
has the Floquet multipliers.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from facegear.floquet.clearance import ClearanceSystem
from facegear.floquet.contact_motion import Motion, found_pattern
from facegear.floquet.contact_panels import Linearised, linearised, struck
from facegear.floquet.contact_patterns import Panels, Pattern
from facegear.floquet.loads import StateJump
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev, Side
from facegear.floquet.response import SteadyResponse
from facegear.floquet.transients import contacts_along
from facegear.support.kinds import named, require_kind
from facegear.support.parameters import finite_array, integer_at_least
from facegear.support.types import ComplexArray, FloatArray

# Change of a motion, over its size, at which it has settled; the next step would change its square.
_SETTLED = 1e-9
# Distance from the clearance, over the largest displacement, that a wrong contact may have.
_CONTACT = 1e-10
# What part of the way steps of Newton's method go from which step on, and after how many it is given up.
_PARTS = ((0, 1.0), (8, 0.5), (32, 0.25))
_MOST_STEPS = 100
# Change of the motion below which steps are whole.
_NEAR = 0.02
# A spectral radius beyond 1 by more than this is unstable and no rounding.
_BEYOND = 1e-9
# Least singular value of I − Φ, over the largest, of a motion that is known.
_SINGULAR = 1e-11


@dataclass(frozen=True, eq=False)
class Orbit:
    """A motion of a system with clearances that repeats itself.

    Attributes
    ----------
    system : ClearanceSystem
        Over one period.
    periods : int
        k, after which the motion repeats itself.
    state : PiecewiseChebyshev
        q and q̇, 2n components, against t/(k T0).
    pattern : Pattern
        Which loads are in contact when, against t/(k T0).
    transition : array, shape (2n, 2n)
        Transition matrix of k periods, saltation included.
    panels : Panels
    unresolved : float
        Last Legendre coefficients of the accelerations along a panel over the largest acceleration.
    """

    system: ClearanceSystem
    periods: int
    state: PiecewiseChebyshev
    pattern: Pattern
    transition: FloatArray
    panels: Panels
    unresolved: float

    @property
    def start(self) -> FloatArray:
        """State (q, q̇) at t = 0, shape (2n,)."""
        return self.state(0.0)

    @cached_property
    def multipliers(self) -> ComplexArray:
        """Floquet multipliers of k periods, largest modulus first, shape (2n,)."""
        scale = self.system.scale
        values = np.linalg.eigvals(scale @ self.transition @ np.linalg.inv(scale)).astype(complex)
        return np.asarray(values[np.argsort(-np.abs(values))])

    @property
    def is_stable(self) -> bool:
        """Whether no multiplier is beyond 1, but for rounding."""
        return float(np.abs(self.multipliers[0])) <= 1.0 + _BEYOND

    def displacements(self, fraction: ArrayLike, side: Side = "right") -> FloatArray:
        """Coordinates q at fractions of the k periods, shape (..., n)."""
        return np.asarray(self.state(fraction, side)[..., : self.system.size])

    def velocities(self, fraction: ArrayLike, side: Side = "right") -> FloatArray:
        """Rates q̇ at fractions of the k periods, shape (..., n)."""
        return np.asarray(self.state(fraction, side)[..., self.system.size :])

    @cached_property
    def in_contact(self) -> FloatArray:
        """Part of the time that each load is in contact, shape (p,)."""
        return np.asarray(np.diff(self.pattern.edges) @ self.pattern.pressed)

    @cached_property
    def linear(self) -> PeriodicSystem:
        """Linear system over k periods with the contacts and saltations of the motion: its multipliers are these."""
        whole, jumps = self.system.repeated(self.periods), []
        n = whole.size
        for panel, number, ratio in self.pattern.crossings:
            at, matrix = float(self.pattern.edges[panel]), np.eye(2 * n)
            phi, push = struck(whole, number, at, ratio)
            matrix[n:, :n] = -np.outer(push, phi)
            jumps.append(StateJump(at, matrix))
        return replace(self._pressed, jumps=tuple(jumps))

    @cached_property
    def _pressed(self) -> PeriodicSystem:
        """Linear system over k periods with the contacts of the motion."""
        return self.system.repeated(self.periods).pressed(self.pattern.edges, self.pattern.pressed)

    @cached_property
    def response(self) -> SteadyResponse:
        """The motion as the response of the loads in contact: means, extremes, harmonics, contact forces.

        Displacements of the loads are counted from their clearance there.
        """
        away = np.linalg.svd(np.eye(len(self.transition)) - self.transition, compute_uv=False)
        return SteadyResponse(
            self._pressed,
            self.state,
            float(np.abs(self.multipliers[0])),
            float(away[0] / max(away[-1], 1e-300)),
        )


@dataclass(frozen=True, eq=False)
class Step:
    """What one step of Newton's method knows: linear motion for a pattern, over k periods."""

    along: Linearised
    base: FloatArray

    @classmethod
    def of(cls, whole: ClearanceSystem, pattern: Pattern, panels: Panels) -> Step:
        """Linearise a system, k periods taken for one, about the contacts of a motion on any panels."""
        base = panels.edges(whole)
        return cls(linearised(whole, pattern.on(base), panels), base)

    @property
    def transition(self) -> FloatArray:
        """Φ with saltation, shape (2n, 2n)."""
        return self.along.whole[:-1, :-1]

    @property
    def scaled_transition(self) -> FloatArray:
        """S Φ S⁻¹, whose eigenvalues are the multipliers."""
        scale = self.along.system.scale
        return np.asarray(scale @ self.transition @ np.linalg.inv(scale))

    @property
    def moved(self) -> FloatArray:
        """State after the period from rest, shape (2n,)."""
        return self.along.whole[:-1, -1]

    def motion(self, state: FloatArray, forced: float = 1.0) -> Motion:
        """Motion from a state (2n,); without forces, a change of one, for `forced` 0."""
        origin = np.append(state, forced)
        return Motion(self.along, origin, self.along.starts(origin))

    def pattern(self, motion: Motion, further: FloatArray | float = 0.0) -> tuple[Pattern, float]:
        """Contacts that the motion has, and how far it is from those it was computed with."""
        return found_pattern(motion, self.base, further)

    def orbit(self, system: ClearanceSystem, periods: int, motion: Motion) -> Orbit:
        """Return the motion as an orbit."""
        along = self.along
        return Orbit(
            system, periods, motion.series, along.pattern, self.transition, along.panels, motion.unresolved
        )


def all_pressed(whole: ClearanceSystem) -> Pattern:
    """Every load of side 1 or 0 in contact, and none of the other side."""
    edges = np.append(whole.system.breakpoints, 1.0)
    sides = np.array(whole.sides)
    middles = (edges[:-1] + edges[1:]) / 2.0
    there = np.stack([np.abs(load.shape(middles)).max(axis=-1) > 0.0 for load in whole.system.loads], axis=-1)
    return Pattern(edges, there & (sides >= 0))


def periodic_orbit(
    system: ClearanceSystem,
    periods: int = 1,
    guess: Orbit | ArrayLike | None = None,
    panels: Panels | None = None,
) -> Orbit:
    """Find a motion of a system with clearances that repeats itself.

    Parameters
    ----------
    system : ClearanceSystem
    periods : int
        k, after how many periods it repeats itself.
    guess : Orbit or array_like of shape (2n,), optional
        A motion of as many periods nearby, or a state (q, q̇) at t = 0. If left out, all loads of side 1 in contact, as
        under a large force.
    panels : Panels, optional
        How finely the motion is resolved.

    Returns
    -------
    Orbit
        Stable or not.

    Raises
    ------
    TypeError, ValueError
        Naming the argument.
    ArithmeticError
        If Newton's method finds none from there, saying what is left; or if nothing presses: the force is too small to
        close the gap, or no spring holds the system apart from its contacts.

    Examples
    --------
    A mass of 1 kg between stops of 4 N/m at ±0.5 m, pushed with 2 N.

    >>> from facegear.floquet.loads import ContactLoad
    >>> spring, push = ContactLoad(PiecewiseChebyshev.constant([1.0]), 4.0), PiecewiseChebyshev.constant([2.0])
    >>> system = PeriodicSystem([[1.0]], [[0.1]], [[0.0]], (spring, spring), 2.0, force=push)
    >>> orbit = periodic_orbit(ClearanceSystem(system, sides=(1, -1), clearances=(0.5, 0.5)))
    >>> orbit.displacements(0.3).round(12)
    array([1.])
    """
    require_clearances(system)
    count = integer_at_least("periods", periods, 1)
    chosen = Panels() if panels is None else panels
    if not isinstance(chosen, Panels):
        raise TypeError(f"panels must be a Panels or None, got {named(panels)}")
    whole = system.repeated(count)
    return _settled(system, count, whole, _first_pattern(whole, count, guess, chosen), chosen)


def require_clearances(system: object) -> None:
    """Refuse what is no system with clearances."""
    require_kind("system", system, ClearanceSystem)


def _first_pattern(whole: ClearanceSystem, count: int, guess: Any, panels: Panels) -> Pattern:
    if guess is None:
        return all_pressed(whole)
    if isinstance(guess, Orbit):
        if guess.periods != count:
            raise ValueError(
                f"guess must be an orbit of {count} periods, as `periods` says, got {guess.periods}"
            )
        _require_kin("guess", guess, whole)
        return guess.pattern
    state = finite_array("guess", guess)
    if state.shape != (2 * whole.size,):
        raise ValueError(f"guess must be a state of shape ({2 * whole.size},), got shape {state.shape}")
    return contacts_along(whole, state)


def _require_kin(name: str, orbit: Orbit, system: ClearanceSystem) -> None:
    """Refuse an orbit of a system with another number of coordinates or loads."""
    own, loads = orbit.system.size, len(orbit.system.sides)
    if (own, loads) != (system.size, len(system.sides)):
        raise ValueError(
            f"{name} must be an orbit of a system with {system.size} coordinates and {len(system.sides)} loads, got "
            f"one of {own} and {loads}"
        )


def _settled(
    system: ClearanceSystem, count: int, whole: ClearanceSystem, pattern: Pattern, panels: Panels
) -> Orbit:
    size = whole.scale
    before: PiecewiseChebyshev | None = None
    change, mismatch = np.inf, np.inf
    for number in range(_MOST_STEPS):
        step = Step.of(whole, pattern, panels)
        state = _fixed_point(step, size)
        if state is None:
            raise ArithmeticError(_why_none(pattern, number))
        motion = step.motion(state)
        change = _change(size, motion, before)
        found, mismatch = step.pattern(motion)
        if change < _SETTLED and mismatch < _CONTACT:
            return step.orbit(system, count, motion)
        # Whole steps may go to and fro between two patterns for ever: then part of the way, until the end is near.
        part = 1.0 if change < _NEAR else [part for start, part in _PARTS if start <= number][-1]
        if part == 1.0 or before is None:
            before, pattern = motion.series, found
        else:
            before, further = motion.towards(before, part)
            pattern, _ = step.pattern(motion, further)
    raise ArithmeticError(
        f"no motion that repeats itself after {count} periods was found in {_MOST_STEPS} steps: the last changed it by "
        f"{change:.2g}, and contacts were off by {mismatch:.2g} of the largest displacement; give a guess nearer by"
    )


def _change(scale: FloatArray, motion: Motion, before: PiecewiseChebyshev | None) -> float:
    """Largest change of the state at the ends of the panels from another motion, over the largest state."""
    if before is None:
        return float(np.inf)
    states = motion.starts[:, :-1] @ scale.T
    away = states - before(motion.along.pattern.edges[:-1]) @ scale.T
    return float(np.abs(away).max() / max(np.abs(states).max(), 1e-300))


def _fixed_point(step: Step, scale: FloatArray) -> FloatArray | None:
    """State to which the motion comes back, or nothing where a multiplier is 1."""
    inverse = np.linalg.inv(scale)
    away = np.eye(len(scale)) - scale @ step.transition @ inverse
    values = np.linalg.svd(away, compute_uv=False)
    if not np.isfinite(values).all() or values[-1] < _SINGULAR * values[0]:
        return None
    return np.asarray(inverse @ np.linalg.solve(away, scale @ step.moved))


def _why_none(pattern: Pattern, steps: int) -> str:
    """Say why the motion of a pattern is not known."""
    if steps:
        return (
            f"Newton's method came to contacts that hold nothing, or to a motion without any, after {steps} steps: "
            "there may be no such motion, or a guess nearer by finds it"
        )
    if pattern.pressed.any():
        return "no motion is known: a multiplier is 1, an undamped resonance or a rigid-body motion that nothing holds"
    return (
        "nothing is in contact in the first guess, where all loads of side 1 are pressed: the force is too small to "
        "close the gap, or points away from it; give another guess"
    )
