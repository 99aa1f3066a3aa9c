"""Radau collocation: transition matrices of systems with strongly damped fast modes.

A gearbox on stiff, damped shafts has modes that die out within a small part of the mesh period and still ask every
explicit or exponential rule for steps as short as their own time. The implicit Radau IIA rule (Hairer and Wanner,
Solving Ordinary Differential Equations II, section IV.5) needs short panels only where such a mode is alive: after
each instant at which tooth pairs enter or leave.

The accelerations at the nodes of a panel are the unknowns, so that a panel of m nodes costs one linear system of
m n equations for all initial states. Panels are halved until the accelerations of the motions that really occur are
resolved by their Legendre series.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar, NamedTuple

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray
from scipy.special import roots_jacobi

from facegear.floquet.gauss_panels import within_reach
from facegear.floquet.motion import MotionPanels, known_forces
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import SAME_INSTANT, merge_breakpoints
from facegear.floquet.stepping import SHARED_STEPS, Family
from facegear.support.parameters import integer_within, keep, within
from facegear.support.types import FloatArray

# Entries of the largest stack of matrices worked on at once: keeps memory near 100 MB.
_STACK_ENTRIES = 1_000_000
# Angle of a panel to begin with [rad].
_PANEL_ANGLE = 11.0
# Rounds of halving after which a family is given up.
_MOST_ROUNDS = 24
# Legendre coefficients that tell the size of the accelerations on a panel, and how well they are resolved.
_LEADING, _LAST = 3, 2


class _Rule(NamedTuple):
    """Radau IIA rule of m stages on [0, 1]."""

    nodes: FloatArray
    """c, shape (m,), ascending, the last one 1."""
    once: FloatArray
    """A, ∫ from 0 to c_i, shape (m, m); its last row is the weights."""
    twice: FloatArray
    """A², the integral taken twice."""
    to_legendre: FloatArray
    """From values at the nodes to Legendre coefficients, shape (m, m)."""


@lru_cache(maxsize=16)
def _rule(stages: int) -> _Rule:
    # Right Radau nodes are the roots of P_m − P_(m−1): the end, and those of a Jacobi polynomial.
    nodes = np.append(roots_jacobi(stages - 1, 1.0, 0.0)[0], 1.0)
    vander = legendre.legvander(nodes, stages - 1)
    to_legendre = np.asarray(np.linalg.inv(vander), dtype=float)
    integrated = np.stack(
        [legendre.legval(nodes, legendre.legint(row, lbnd=-1)) for row in np.eye(stages)], axis=1
    )
    once = 0.5 * integrated @ to_legendre
    return _Rule((1.0 + nodes) / 2.0, once, once @ once, to_legendre)


@dataclass(frozen=True)
class Radau:
    """Radau IIA collocation on panels halved until the motion is resolved, for any system.

    Parameters
    ----------
    stages : int
        Nodes of a panel m; the rule has the order 2m − 1.
    tolerance : float
        Largest error of an entry of Φ, in energy-like coordinates, relative to the largest entry or 1, that the
        last Legendre coefficients of a panel may foretell.

    Raises
    ------
    ValueError
        When used, if the family carries derivatives of the state.
    ArithmeticError
        When used, if panels do not resolve the motion.
    """

    stages: int = 16
    tolerance: float = 1e-11

    together: ClassVar[float] = SHARED_STEPS

    def __post_init__(self) -> None:
        keep(
            self,
            stages=integer_within("stages", self.stages, 3, 40),
            tolerance=within("tolerance", self.tolerance, 1e-15, 1e-2),
        )

    def scaled_transition_matrices(self, family: Family) -> FloatArray:
        """See :class:`facegear.floquet.methods.Method`."""
        if family.carries_derivatives:
            raise ValueError(
                "Radau panels take a position and its rate, not their derivatives; use AdaptiveMagnus"
            )
        rule = _rule(self.stages)
        edges = _graded_edges(family, _PANEL_ANGLE, -np.log(self.tolerance))
        panels = _Panels.between(family, rule, edges[:-1], np.diff(edges))
        for _ in range(_MOST_ROUNDS):
            total, error = panels.product(family)
            if not np.isfinite(error).all():
                raise ArithmeticError(
                    "transition matrix is not finite: the motion grows beyond double precision"
                )
            unresolved = error > self.tolerance
            if not unresolved.any():
                return total
            panels = panels.halved(family, rule, unresolved)
        raise ArithmeticError(
            f"{panels.start.size} panels of {self.stages} Radau nodes do not resolve the motion to {self.tolerance:.1g}"
        )

    def motion_panels(self, system: PeriodicSystem, instants: Sequence[float]) -> MotionPanels:
        """See :class:`facegear.floquet.motion.FollowsMotion`.

        Panels are half as long as those of a transition matrix to begin with; who asks says where that is not enough.
        """
        family, rule = Family([system]), _rule(self.stages)
        ends = _graded_edges(family, _PANEL_ANGLE / 2.0, -np.log(self.tolerance))
        edges = np.append(merge_breakpoints([ends[:-1], np.array(instants)]), 1.0)
        return _motion_panels(family, rule, edges)

    def refined(self) -> Radau:
        """Four more nodes a panel and a hundredth of the tolerance."""
        return Radau(min(self.stages + 4, 40), max(self.tolerance / 100.0, 1e-15))

    def rounding(self, family: Family) -> float:
        """Return an angle as of its first panels; dead motions leave none behind.

        See :class:`facegear.floquet.methods.Method`.
        """
        return _PANEL_ANGLE * (_graded_edges(family, _PANEL_ANGLE, -np.log(self.tolerance)).size - 1)


def _graded_edges(family: Family, panel_angle: float, dead: float) -> FloatArray:
    """Place the first ends of panels: short after each breakpoint, longer where fast motions have died.

    Each panel spans `panel_angle` [rad] of the fastest motion, frozen in the middle of the piece, that has not
    decayed by e^-dead since the breakpoint.
    """
    starts = family.breakpoints
    ends = np.append(starts[1:], 1.0)
    parts = []
    for piece, (start, end) in enumerate(zip(starts, ends, strict=True)):
        rates = family.frozen_exponents[:, piece].ravel()
        length = end - start
        death = np.minimum(dead / np.maximum(-rates.real, dead / (2.0 * length)), length)
        places = np.unique(np.append(death, [0.0, length]))
        # Where every motion has died, one panel spans the rest.
        fastest = [np.abs(rates[death >= place]).max(initial=0.0) for place in places[1:]]
        angle = np.append(0.0, np.cumsum(fastest * np.diff(places)))
        count = max(1, within_reach(angle[-1] / panel_angle))
        parts.append(start + np.interp(np.linspace(0.0, angle[-1], count + 1)[:-1], angle, places))
    return np.append(np.concatenate(parts), 1.0)


@dataclass(frozen=True, eq=False)
class _Panels:
    """Panels in ascending order and what each does to any state at its start.

    Attributes
    ----------
    start, length : array, shape (P,)
    steps : array, shape (V, P, 2n, 2n)
    coefficients : array, shape (V, P, 5, n, 2n)
        First three and last two Legendre coefficients of the accelerations times the panel's length, for unit
        states at its start.
    """

    start: FloatArray
    length: FloatArray
    steps: FloatArray
    coefficients: FloatArray

    @classmethod
    def between(cls, family: Family, rule: _Rule, start: FloatArray, length: FloatArray) -> _Panels:
        chunk = max(1, _STACK_ENTRIES // (len(family.systems) * (rule.nodes.size * family.size) ** 2))
        parts = [
            _solved(family, rule, start[i : i + chunk], length[i : i + chunk])
            for i in range(0, start.size, chunk)
        ]
        steps, coefficients = (np.concatenate(part, axis=1) for part in zip(*parts, strict=True))
        return cls(start, length, steps, coefficients)

    def halved(self, family: Family, rule: _Rule, chosen: NDArray[np.bool_]) -> _Panels:
        """Return all panels with those chosen cut in two."""
        half = self.length[chosen] / 2.0
        first = self.start[chosen]
        new = _Panels.between(family, rule, np.concatenate([first, first + half]), np.tile(half, 2))
        start = np.concatenate([self.start[~chosen], new.start])
        order = np.argsort(start)

        def merged(name: str) -> FloatArray:
            both = np.concatenate([getattr(self, name)[:, ~chosen], getattr(new, name)], axis=1)
            return np.asarray(both[:, order])

        length = np.concatenate([self.length[~chosen], new.length])
        return _Panels(start[order], length[order], merged("steps"), merged("coefficients"))

    def product(self, family: Family) -> tuple[FloatArray, FloatArray]:
        """Transition matrices, shape (V, 2n, 2n), and the error each panel brings in, shape (P,)."""
        total = np.broadcast_to(np.eye(self.steps.shape[-1]), (len(self.steps), *self.steps.shape[-2:]))
        arriving = np.empty_like(self.steps)
        # A motion that grows beyond double precision shows as an error that is not finite.
        with np.errstate(over="ignore", invalid="ignore"):
            for panel, start in enumerate(self.start.tolist()):
                total = family.jumped(total, start)
                arriving[:, panel] = total
                total = self.steps[:, panel] @ total
            coefficients = np.abs(self.coefficients @ arriving[:, :, np.newaxis]).max(axis=(3, 4))
            sizes, tails = (
                part.max(axis=2) for part in (coefficients[:, :, :_LEADING], coefficients[:, :, -_LAST:])
            )
            # The end of a panel is known with the square of the accuracy along it.
            error = tails**2 / np.maximum(sizes, np.finfo(float).tiny)
            largest = np.maximum(np.abs(arriving).max(axis=(1, 2, 3)), 1.0)
        return total, np.asarray((error / largest[:, np.newaxis]).max(axis=0), dtype=float)


class _Equations(NamedTuple):
    """Equations for y2' at the nodes, y1' = a y2, y2' = L y1 + D y2 in scaled coordinates; V systems, P panels."""

    left: FloatArray
    """Shape (V, P, m n, m n)."""
    right: FloatArray
    """For unit states at the start, shape (V, P, m n, 2n)."""
    length: FloatArray
    """h, shape (1, P, 1, 1, 1)."""
    a: FloatArray
    """Shape (V, P, 1, 1, 1)."""
    fractions: FloatArray
    """Instants of the nodes, shape (P, m)."""


def _equations(family: Family, rule: _Rule, start: FloatArray, length: FloatArray) -> _Equations:
    n, m, count = family.size, rule.nodes.size, start.size
    points = start[:, np.newaxis] + length[:, np.newaxis] * rule.nodes
    # The last node is the end of the panel, where a pair may enter or leave: what counts is the side before. An instant
    # a little earlier would do but for rounding, since A may change fast.
    inner = family.state_matrices(points[:, :-1].ravel())
    inner = inner.reshape(len(family.systems), count, m - 1, 2 * n, 2 * n)
    last = family.state_matrices(points[:, -1], "left")
    state = np.concatenate([inner, last[:, :, np.newaxis]], axis=2)
    points[:, -1] -= 4.0 * SAME_INSTANT
    # y1' = a y2, y2' = L y1 + D y2 with a the same all along. Nodes come last but one: y2' of one coordinate at all
    # nodes stand together, which the long inner loops below like.
    a = state[:, :, 0, 0, n][..., np.newaxis, np.newaxis, np.newaxis]
    L, D = (np.moveaxis(part, 2, 3) for part in (state[..., n:, :n], state[..., n:, n:]))
    h = length[np.newaxis, :, np.newaxis, np.newaxis, np.newaxis]
    # Unknown are the y2' of all nodes, (V, P, n, m) for each of 2n states at the start.
    left = (h**2 * a * L)[..., np.newaxis] * -rule.twice[:, np.newaxis]
    left += (h * D)[..., np.newaxis] * -rule.once[:, np.newaxis]
    diagonal = np.arange(m * n)
    left = left.reshape(*L.shape[:2], m * n, m * n)
    left[..., diagonal, diagonal] += 1.0
    right = np.concatenate([L, h * a * rule.nodes[:, np.newaxis] * L + D], axis=-1)
    right = right.reshape(*L.shape[:2], m * n, 2 * n)
    return _Equations(left, right, h, a, points)


def _solved(
    family: Family, rule: _Rule, start: FloatArray, length: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Solve some panels for their steps and coefficients."""
    n, m = family.size, rule.nodes.size
    left, right, h, a, _ = _equations(family, rule, start, length)
    rates = np.linalg.solve(left, right).reshape(*left.shape[:2], n, m, 2 * n)
    ends = np.stack([rule.twice[-1], rule.once[-1], *rule.to_legendre[:_LEADING], *rule.to_legendre[-_LAST:]])
    sums = h * np.moveaxis(ends @ rates, 3, 2)
    steps = np.zeros((*left.shape[:2], 2 * n, 2 * n))
    h, a = h[..., 0], a[..., 0]
    steps[..., :n, :] = h * a * sums[:, :, 0]
    steps[..., n:, :] = sums[:, :, 1]
    steps += np.eye(2 * n)
    steps[..., :n, n:] += (h * a) * np.eye(n)
    return steps, sums[:, :, 2:]


def _motion_panels(family: Family, rule: _Rule, edges: FloatArray) -> MotionPanels:
    """Follow the motion of the one system of a family, forces included."""
    (system,), n, m = family.systems, family.size, rule.nodes.size
    left, right, h, a, fractions = _equations(family, rule, edges[:-1], np.diff(edges))
    h, a = h[0, ..., 0], a[0, ..., 0]
    forces = known_forces(system, fractions)[..., np.newaxis]
    accelerations = np.linalg.solve(system.mass_matrix(fractions), forces)[..., 0]
    pushed = system.period * accelerations @ family.scale[n:, n:].T
    pushed = pushed.swapaxes(-1, -2).reshape(*left.shape[1:3], 1)
    rates = np.linalg.solve(left[0], np.concatenate([right[0], pushed], axis=-1))
    rates = rates.reshape(-1, n, m, 2 * n + 1)

    def moved(
        starts: FloatArray, by: FloatArray, once: FloatArray, twice: FloatArray, c: FloatArray
    ) -> FloatArray:
        """Scaled states (P, 2n, k) at some nodes c, from y2' (P, n, m, k): (P, 2n, nodes, k)."""
        first, second = starts[:, :n, np.newaxis], starts[:, n:, np.newaxis]
        drift = (h * a)[..., np.newaxis] * c[:, np.newaxis] * second
        velocity = second + h[..., np.newaxis] * (once @ by)
        return np.concatenate([first + drift + (h**2 * a)[..., np.newaxis] * (twice @ by), velocity], axis=1)

    unit = np.concatenate([np.eye(2 * n), np.zeros((2 * n, 1))], axis=1)
    ends = moved(
        np.broadcast_to(unit, (len(rates), *unit.shape)), rates, rule.once[-1:], rule.twice[-1:], np.ones(1)
    )
    ends = family.inverse_scale @ ends[:, :, 0]

    def inside(starts: FloatArray) -> FloatArray:
        scaled = starts @ family.scale.T
        by = (rates[..., :-1] @ scaled[:, np.newaxis, :, np.newaxis])[..., 0] + rates[..., -1]
        states = moved(scaled[..., np.newaxis], by[..., np.newaxis], rule.once, rule.twice, rule.nodes)[
            ..., 0
        ]
        return np.asarray(states.swapaxes(-1, -2) @ family.inverse_scale.T, dtype=float)

    steps = np.asarray(ends[..., :-1] @ family.scale, dtype=float)
    return MotionPanels(edges, rule.nodes, steps, np.asarray(ends[..., -1], dtype=float), inside)
