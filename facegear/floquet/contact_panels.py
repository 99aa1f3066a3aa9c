"""Equations of motion of a system with clearances for a given pattern of contacts.

Between the instants at which contacts are made or lost the equations are linear. The panels of an orbit end at the
breakpoints of the system and at those instants, so that the motion is smooth along each and Gauss collocation of the
accelerations converges exponentially with the number of nodes: Fourier series of the whole orbit converge as slowly as
the third power of their order, since a damper that lets go makes the accelerations jump.

Newton's method for the unknown motion follows at once. Where the iterate is in contact, the change of its force is
that of the spring and damper; where the contact is made or lost, the indicator of the contact changes by an impulse

    M Δq̇ = ∓ w φ c (u̇/|u̇|) (φᵀq − e ∓ b),

which vanishes when the new motion meets the clearance at that instant. What is left of it in the transition matrix,
∓ M⁻¹ w φ c φᵀ, is the saltation matrix of the contact. So each step of Newton's method is a linear periodic system with
jumps of the state, and its transition matrix, when the motion has settled, decides stability.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.polynomial import chebyshev, legendre

from facegear.floquet.clearance import ClearanceSystem
from facegear.floquet.contact_patterns import BoolArray, Panels, Pattern
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.support.types import FloatArray

# Samples of a panel, over its nodes, among which changes of sign are looked for.
_DENSITY = 3


@dataclass(frozen=True, eq=False)
class Rule:
    """Gauss nodes of a panel from 0 to 1, and integrals of the polynomials through values there."""

    nodes: FloatArray
    once: FloatArray
    twice: FloatArray
    end_once: FloatArray
    end_twice: FloatArray
    to_legendre: FloatArray
    ends_to_legendre: FloatArray
    places: FloatArray
    to_places: FloatArray
    series_once: FloatArray
    series_twice: FloatArray
    series_places: FloatArray
    to_series: FloatArray


@lru_cache(maxsize=16)
def rule_of(count: int) -> Rule:
    """Return the rule of so many nodes."""
    z, weights = (np.asarray(x, dtype=float) for x in legendre.leggauss(count))
    degrees = np.arange(count)
    to_legendre = np.asarray(
        (degrees + 0.5)[:, np.newaxis] * legendre.legvander(z, count - 1).T * weights, dtype=float
    )
    once = np.asarray(legendre.legint(to_legendre, scl=0.5, lbnd=-1.0), dtype=float)
    twice = np.asarray(legendre.legint(once, scl=0.5, lbnd=-1.0), dtype=float)

    def at(series: FloatArray, places: FloatArray) -> FloatArray:
        return np.asarray(legendre.legvander(places, len(series) - 1) @ series, dtype=float)

    # Of values at the start, the nodes and the end.
    with_ends = legendre.legvander(np.concatenate([[-1.0], z, [1.0]]), count + 1)
    ends_to_legendre = np.asarray(np.linalg.inv(with_ends), dtype=float)
    places = np.asarray(-np.cos(np.linspace(0.0, np.pi, _DENSITY * count + 1)), dtype=float)
    points = np.asarray(chebyshev.chebpts1(count + 2), dtype=float)
    return Rule(
        nodes=(1.0 + z) / 2.0,
        once=at(once, z),
        twice=at(twice, z),
        end_once=at(once, np.ones(1))[0],
        end_twice=at(twice, np.ones(1))[0],
        to_legendre=to_legendre,
        ends_to_legendre=ends_to_legendre,
        places=places,
        to_places=at(ends_to_legendre, places),
        series_once=at(once, points),
        series_twice=at(twice, points),
        series_places=(1.0 + points) / 2.0,
        to_series=np.asarray(np.linalg.inv(chebyshev.chebvander(points, count + 1)), dtype=float),
    )


@dataclass(frozen=True, eq=False)
class _Load:
    """One load at the nodes of all panels: shape and its rate (P, N, n), weight, e, ė (P, N), where it acts (P,).

    Shape and e at both ends besides, (P, N + 2, n) and (P, N + 2).
    """

    phi: FloatArray
    rate: FloatArray
    weight: FloatArray
    error: FloatArray
    error_rate: FloatArray
    there: BoolArray
    phi_and_ends: FloatArray
    error_and_ends: FloatArray


@dataclass(frozen=True, eq=False)
class Linearised:
    """A linear periodic system with jumps: one pattern of contacts, forces and clearances included.

    States are (q, q̇, 1), so that matrices carry what does not depend on the motion.

    Attributes
    ----------
    system : ClearanceSystem
    pattern : Pattern
    steps, jumps : array, shape (P, 2n + 1, 2n + 1)
        Along each panel, and at its start.
    accelerations : array, shape (P, N, n, 2n + 1)
        q̈ at the nodes for unit states at the start.
    loads : tuple
        Of the system, at the nodes.
    """

    system: ClearanceSystem
    pattern: Pattern
    panels: Panels
    steps: FloatArray
    jumps: FloatArray
    accelerations: FloatArray
    loads: tuple[_Load, ...]

    @cached_property
    def whole(self) -> FloatArray:
        """Transition matrix of the period, saltation included, shape (2n + 1, 2n + 1)."""
        matrices = self.steps @ self.jumps
        while len(matrices) > 1:
            even = len(matrices) - len(matrices) % 2
            matrices = np.concatenate([matrices[1:even:2] @ matrices[0:even:2], matrices[even:]])
        return np.asarray(matrices[0])

    def starts(self, state: FloatArray) -> FloatArray:
        """States at the starts of the panels after their jumps, (P, 2n + 1), of the motion from (q, q̇, a) at 0.

        With a = 0 it is a change of the motion, without what forces do.
        """
        found = np.empty((len(self.steps), state.size))
        for panel, (jump, step) in enumerate(zip(self.jumps, self.steps, strict=True)):
            found[panel] = jump @ state
            state = step @ found[panel]
        return found


def linearised(system: ClearanceSystem, pattern: Pattern, panels: Panels) -> Linearised:
    """Solve the motion along all panels of a pattern, for any states at their starts."""
    rule, n, count = rule_of(panels.nodes), system.size, panels.nodes
    start, length = pattern.edges[:-1], np.diff(pattern.edges)
    fractions = start[:, np.newaxis] + length[:, np.newaxis] * rule.nodes
    inner, inverse = system.system, system.inverse_mass
    loads = tuple(_load_at(system, number, fractions, pattern.edges) for number in range(len(inner.loads)))
    shape = (*fractions.shape, n, n)
    stiffness = np.broadcast_to(inverse @ inner.stiffness, shape).copy()
    damping = np.broadcast_to(inverse @ inner.damping, shape).copy()
    force = np.zeros((*fractions.shape, n)) if inner.force is None else inner.force(fractions) @ inverse.T
    for number, (load, at) in enumerate(zip(inner.loads, loads, strict=True)):
        on = pattern.pressed[:, number]
        if not on.any():
            continue
        row = (at.phi[on] @ inverse.T) * at.weight[on][..., np.newaxis]
        beyond = at.error[on] + system.sides[number] * system.clearances[number]
        along = load.stiffness * at.phi[on]
        if load.damping > 0.0:
            damping[on] += load.damping * row[..., :, np.newaxis] * at.phi[on][..., np.newaxis, :]
            along = along + load.damping * at.rate[on]
        stiffness[on] += row[..., :, np.newaxis] * along[..., np.newaxis, :]
        force[on] += row * (load.stiffness * beyond + load.damping * at.error_rate[on])[..., np.newaxis]
    h = (length * inner.period)[:, np.newaxis, np.newaxis, np.newaxis, np.newaxis]
    left = (h * rule.once[:, np.newaxis, :, np.newaxis]) * damping[:, :, :, np.newaxis, :]
    left += (h**2 * rule.twice[:, np.newaxis, :, np.newaxis]) * stiffness[:, :, :, np.newaxis, :]
    left = left.reshape(-1, count * n, count * n)
    diagonal = np.arange(count * n)
    left[:, diagonal, diagonal] += 1.0
    drift = damping + h[..., 0] * rule.nodes[:, np.newaxis, np.newaxis] * stiffness
    right = np.concatenate([-stiffness, -drift, force[..., np.newaxis]], axis=-1)
    found = np.linalg.solve(left, right.reshape(-1, count * n, 2 * n + 1)).reshape(-1, count, n, 2 * n + 1)
    steps = np.broadcast_to(np.eye(2 * n + 1), (len(start), 2 * n + 1, 2 * n + 1)).copy()
    step = h[:, :, 0, 0]
    steps[:, :n, n : 2 * n] += step * np.eye(n)
    steps[:, :n] += step**2 * np.tensordot(rule.end_twice, found, axes=(0, 1))
    steps[:, n : 2 * n] += step * np.tensordot(rule.end_once, found, axes=(0, 1))
    return Linearised(system, pattern, panels, steps, _jumps(system, pattern), found, loads)


def _load_at(system: ClearanceSystem, number: int, fractions: FloatArray, edges: FloatArray) -> _Load:
    load, period = system.system.loads[number], system.period
    phi = _with_ends(load.shape, fractions, edges)
    inner = phi[:, 1:-1]
    rate = load.slope(fractions) / period if load.rate == "total" else np.zeros_like(inner)
    weight = np.ones(fractions.shape) if load.weight is None else load.weight(fractions)[..., 0]
    error, error_rate = np.zeros(phi.shape[:2]), np.zeros(fractions.shape)
    if load.transmission_error is not None:
        error = _with_ends(load.transmission_error, fractions, edges)[..., 0]
        error_rate = load.transmission_error.derivative()(fractions)[..., 0] / period
    there = (np.abs(inner).max(axis=(1, 2)) > 0.0) & (np.abs(weight).max(axis=1) > 0.0)
    return _Load(inner, rate, weight, error[:, 1:-1], error_rate, there, phi, error)


def _with_ends(function: PiecewiseChebyshev, fractions: FloatArray, edges: FloatArray) -> FloatArray:
    """Values at the starts, nodes (P, N) and ends of panels, limits from inside, (P, N + 2, ...)."""
    first = function(np.concatenate([edges[:-1, np.newaxis], fractions], axis=1))
    return np.concatenate([first, function(edges[1:], "left")[:, np.newaxis]], axis=1)


def struck(system: ClearanceSystem, number: int, at: float, ratio: float) -> tuple[FloatArray, FloatArray]:
    """Shape φ of a load at an instant, and M⁻¹ w φ c times a ratio: −(push φᵀ) is the saltation of its contact."""
    load = system.system.loads[number]
    phi = load.shape(at)
    weight = 1.0 if load.weight is None else load.weight(at)[0]
    return phi, system.inverse_mass @ phi * (weight * load.damping * ratio)


def _jumps(system: ClearanceSystem, pattern: Pattern) -> FloatArray:
    """Return what Newton's method makes of contacts made or lost at the starts of panels, (P, 2n + 1, 2n + 1)."""
    n = system.size
    jumps = np.broadcast_to(np.eye(2 * n + 1), (len(pattern.pressed), 2 * n + 1, 2 * n + 1)).copy()
    for panel, number, ratio in pattern.crossings:
        load, at = system.system.loads[number], float(pattern.edges[panel])
        if load.damping == 0.0:
            continue
        phi, push = struck(system, number, at, ratio)
        error = 0.0 if load.transmission_error is None else load.transmission_error(at)[0]
        beyond = error + system.sides[number] * system.clearances[number]
        jumps[panel, n : 2 * n] -= np.outer(push, np.concatenate([phi, np.zeros(n), [-beyond]]))
    return jumps
