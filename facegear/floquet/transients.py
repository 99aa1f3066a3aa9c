"""Where motions of systems with clearances end: many at once, by steps of the classical Runge-Kutta method.

What is found is a guess for :func:`facegear.floquet.orbits.periodic_orbit`, or which of several motions attracts which
initial states. Steps end at the breakpoints of the system, not at contacts, so that errors at these are of second order.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from facegear.floquet.clearance import ClearanceSystem
from facegear.floquet.contact_panels import Pattern, merged
from facegear.floquet.periodic import weighted_shape
from facegear.floquet.piecewise import Side
from facegear.support.parameters import finite_array, integer_at_least
from facegear.support.types import FloatArray

# Largest angle of the fastest natural motion in a step [rad].
_ANGLE = 0.2


@dataclass(frozen=True, eq=False)
class _Stages:
    """What the equations need at the start, the middle and the end of each step, first axes (S, 3)."""

    lengths: FloatArray
    edges: FloatArray
    phi: FloatArray
    rate: FloatArray
    row: FloatArray
    edge: FloatArray
    edge_rate: FloatArray
    force: FloatArray


def _stages(system: ClearanceSystem) -> _Stages:
    inner, period = system.system, system.period
    ends = np.append(inner.breakpoints, 1.0)
    turns = system.fastest * period / _ANGLE
    edges = np.append(
        np.concatenate(
            [
                np.linspace(a, b, max(2, int(np.ceil(turns * (b - a)))) + 1)[:-1]
                for a, b in zip(ends[:-1], ends[1:], strict=True)
            ]
        ),
        1.0,
    )
    places: list[tuple[FloatArray, Side]] = [
        (edges[:-1], "right"),
        ((edges[:-1] + edges[1:]) / 2.0, "right"),
        (edges[1:], "left"),
    ]
    phi, rate, row, edge, edge_rate, force = [], [], [], [], [], []
    for x, side in places:
        phi.append(np.stack([load.shape(x, side) for load in inner.loads], axis=1))
        rate.append(
            np.stack(
                [
                    load.slope(x, side) / period if load.rate == "total" else np.zeros((x.size, system.size))
                    for load in inner.loads
                ],
                axis=1,
            )
        )
        weighted = np.stack([weighted_shape(load, x, side) for load in inner.loads], axis=1)
        row.append(weighted @ system.inverse_mass.T)
        none = np.zeros(x.size)
        errors = [load.transmission_error for load in inner.loads]
        edge.append(np.stack([none if e is None else e(x, side)[:, 0] for e in errors], axis=1))
        slopes = [none if e is None else e.derivative()(x, side)[:, 0] / period for e in errors]
        edge_rate.append(np.stack(slopes, axis=1))
        pushed = np.zeros((x.size, system.size)) if inner.force is None else inner.force(x, side)
        force.append(pushed @ system.inverse_mass.T)
    return _Stages(
        np.diff(edges) * period,
        edges,
        *(np.stack(part, axis=1) for part in (phi, rate, row, edge, edge_rate, force)),
    )


@dataclass(frozen=True, eq=False)
class _Field:
    """Accelerations of many states at once."""

    system: ClearanceSystem
    at: _Stages

    def beyond(self, step: int, stage: int, q: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Displacement of the loads from their clearances (m, p), and how far they are in contact."""
        sides = np.array(self.system.sides, dtype=float)
        clearances = np.array(self.system.clearances)
        u = q @ self.at.phi[step, stage].T - self.at.edge[step, stage]
        into = u * sides - clearances
        return u - sides * clearances, np.where(sides == 0.0, 1.0, into)

    def __call__(self, step: int, stage: int, q: FloatArray, v: FloatArray) -> FloatArray:
        inner = self.system.system
        k = np.array([load.stiffness for load in inner.loads])
        c = np.array([load.damping for load in inner.loads])
        u, into = self.beyond(step, stage, q)
        rate = v @ self.at.phi[step, stage].T + q @ self.at.rate[step, stage].T - self.at.edge_rate[step, stage]
        forces = np.where(into > 0.0, k * u + c * rate, 0.0)
        shafts = (q @ inner.stiffness.T + v @ inner.damping.T) @ self.system.inverse_mass.T
        return np.asarray(self.at.force[step, stage] - shafts - forces @ self.at.row[step, stage])

    def advanced(self, step: int, q: FloatArray, v: FloatArray) -> tuple[FloatArray, FloatArray]:
        """States after a step."""
        h = float(self.at.lengths[step])
        a1 = self(step, 0, q, v)
        v2 = v + h / 2.0 * a1
        a2 = self(step, 1, q + h / 2.0 * v, v2)
        v3 = v + h / 2.0 * a2
        a3 = self(step, 1, q + h / 2.0 * v2, v3)
        v4 = v + h * a3
        a4 = self(step, 2, q + h * v3, v4)
        return q + h / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4), v + h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4)


def settled(system: ClearanceSystem, states: ArrayLike, periods: int, kept: int = 1) -> FloatArray:
    """Follow many motions for some periods.

    Parameters
    ----------
    system : ClearanceSystem
    states : array_like, shape (m, 2n)
        States (q, q̇) at t = 0.
    periods : int
        How many periods to follow them.
    kept : int
        Of how many periods, the last ones, the states are returned.

    Returns
    -------
    array, shape (kept, m, 2n)
        States at the end of each of the last periods.

    Raises
    ------
    TypeError, ValueError
        Naming the argument.
    """
    count = integer_at_least("periods", periods, 1)
    kept = integer_at_least("kept", kept, 1)
    start = finite_array("states", states)
    n = system.size
    if start.ndim != 2 or start.shape[1] != 2 * n:
        raise ValueError(f"states must have shape (m, {2 * n}), got shape {start.shape}")
    field = _Field(system, _stages(system))
    q, v, found = start[:, :n], start[:, n:], []
    for number in range(count):
        for step in range(field.at.lengths.size):
            q, v = field.advanced(step, q, v)
        if number >= count - kept:
            found.append(np.concatenate([q, v], axis=1))
    return np.array(found)


def contacts_along(system: ClearanceSystem, state: FloatArray) -> Pattern:
    """Contacts of the motion from a state along one period, to the accuracy of the steps."""
    field, n = _Field(system, _stages(system)), system.size
    q, v, rows = state[np.newaxis, :n], state[np.newaxis, n:], []
    there = np.abs(field.at.row[:, 1]).max(axis=-1) > 0.0
    for step in range(field.at.lengths.size):
        start = q
        q, v = field.advanced(step, q, v)
        rows.append(field.beyond(step, 1, (start + q) / 2.0)[1][0] > 0.0)
    pressed: NDArray[np.bool_] = np.array(rows) & there
    changes = np.flatnonzero((pressed[1:] != pressed[:-1]).any(axis=1)) + 1
    edges = merged(np.append(system.system.breakpoints, 1.0), field.at.edges[changes])
    middles = (edges[:-1] + edges[1:]) / 2.0
    found = pressed[np.searchsorted(field.at.edges, middles, side="right") - 1]
    return Pattern(edges, found, ())
