"""Where motions of systems with clearances end: many at once, by steps of the classical Runge-Kutta method.

What is found is a guess for :func:`facegear.floquet.orbits.periodic_orbit`, or which of several motions attracts which
initial states. Steps end at the breakpoints of the system, not at contacts: errors at these are of second order.
"""

from __future__ import annotations

from dataclasses import dataclass
from types import ModuleType

import numpy as np
from numpy.typing import ArrayLike, NDArray

from facegear.floquet.clearance import ClearanceSystem
from facegear.floquet.compiled import where_compiled
from facegear.floquet.contact_patterns import Pattern, merged
from facegear.floquet.loads import weighted_shape
from facegear.floquet.piecewise import Side
from facegear.support.parameters import finite_array, integer_at_least, integer_within
from facegear.support.types import FloatArray

# Largest angle of the fastest natural motion in a step [rad].
_ANGLE = 0.2
# Steps a period from which even one motion takes minutes.
_MOST_STEPS = 5000


@dataclass(frozen=True, eq=False)
class _Field:
    """Accelerations of many states (m, 2n) at once, at the start, the middle and the end of each step.

    Attributes
    ----------
    edges : array, shape (S + 1,)
    lengths : array, shape (S,)
        Of the steps [s].
    reading : array, shape (S, 3, 2n, 2p + n)
        States to side · u and k u + c u̇ of each load, and to what shafts do.
    known : array, shape (S, 3, 2p + n)
        What is added to that: clearances, transmission errors, forces.
    row : array, shape (S, 3, p, n)
        Forces of the loads to accelerations.
    """

    edges: FloatArray
    lengths: FloatArray
    reading: FloatArray
    known: FloatArray
    row: FloatArray

    @classmethod
    def of(cls, system: ClearanceSystem) -> _Field:
        inner, n, p = system.system, system.size, len(system.sides)
        steps = system.fastest * system.period / _ANGLE
        if steps > _MOST_STEPS:
            raise ArithmeticError(
                f"the fastest motion in contact, {system.fastest:.3g} rad/s, takes {steps:.3g} steps in a period of "
                f"{system.period:.3g} s, more than {_MOST_STEPS}: too slow to be followed"
            )
        edges = system.divided(_ANGLE, fewest=2)
        places: tuple[tuple[FloatArray, Side], ...] = (
            (edges[:-1], "right"),
            ((edges[:-1] + edges[1:]) / 2.0, "right"),
            (edges[1:], "left"),
        )
        reading, known = (
            np.zeros((edges.size - 1, 3, 2 * n, 2 * p + n)),
            np.zeros((edges.size - 1, 3, 2 * p + n)),
        )
        row = np.zeros((edges.size - 1, 3, p, n))
        shafts = np.concatenate([inner.stiffness, inner.damping], axis=1).T @ system.inverse_mass.T
        reading[..., 2 * p :] = -shafts
        for stage, (x, side) in enumerate(places):
            if inner.force is not None:
                known[:, stage, 2 * p :] = inner.force(x, side) @ system.inverse_mass.T
            for number, load in enumerate(inner.loads):
                phi, toward = load.shape(x, side), system.sides[number]
                edge, edge_rate = np.full(x.size, toward * system.clearances[number]), np.zeros(x.size)
                if load.transmission_error is not None:
                    edge = edge + load.transmission_error(x, side)[:, 0]
                    edge_rate = load.transmission_error.derivative()(x, side)[:, 0] / inner.period
                row[:, stage, number] = weighted_shape(load, x, side) @ system.inverse_mass.T
                reading[:, stage, :n, number] = toward * phi
                known[:, stage, number] = -toward * edge if toward else 1.0
                reading[:, stage, :n, p + number] = load.stiffness * phi
                if load.rate == "total":
                    reading[:, stage, :n, p + number] += load.damping * load.slope(x, side) / inner.period
                reading[:, stage, n:, p + number] = load.damping * phi
                known[:, stage, p + number] = -load.stiffness * edge - load.damping * edge_rate
        return cls(edges, np.diff(edges) * inner.period, reading, known, row)

    def into(self, step: int, states: FloatArray) -> FloatArray:
        """How far loads are in contact in the middle of a step, (m, p)."""
        count = self.row.shape[2]
        return np.asarray((states @ self.reading[step, 1] + self.known[step, 1])[:, :count])

    def rate(self, step: int, stage: int, states: FloatArray) -> FloatArray:
        """Rates of the states."""
        count, n = self.row.shape[2:]
        read = states @ self.reading[step, stage] + self.known[step, stage]
        forces = np.where(read[:, :count] > 0.0, read[:, count : 2 * count], 0.0)
        rates = np.empty_like(states)
        rates[:, :n] = states[:, n:]
        rates[:, n:] = read[:, 2 * count :] - forces @ self.row[step, stage]
        return rates

    def advanced(self, step: int, states: FloatArray) -> FloatArray:
        """States after a step."""
        h = float(self.lengths[step])
        first = self.rate(step, 0, states)
        second = self.rate(step, 1, states + h / 2.0 * first)
        third = self.rate(step, 1, states + h / 2.0 * second)
        last = self.rate(step, 2, states + h * third)
        return np.asarray(states + h / 6.0 * (first + 2.0 * (second + third) + last))

    def followed(self, states: FloatArray, periods: int, kept: int) -> FloatArray:
        """States at the end of each of the last periods, (kept, m, 2n)."""
        found = []
        for number in range(periods):
            for step in range(self.lengths.size):
                states = self.advanced(step, states)
            if number >= periods - kept:
                found.append(states)
        return np.array(found)


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
        Of how many periods, the last ones, the states are returned, 1 to `periods`.

    Returns
    -------
    array, shape (kept, m, 2n)
        States at the end of each of the last periods.

    Raises
    ------
    TypeError, ValueError
        Naming the argument.
    ArithmeticError
        If a period takes more than 5000 steps: it is too long for the fastest motion.
    """
    count = integer_at_least("periods", periods, 1)
    kept = integer_within("kept", kept, 1, count)
    start = finite_array("states", states)
    n = system.size
    if start.ndim != 2 or start.shape[1] != 2 * n:
        raise ValueError(f"states must have shape (m, {2 * n}), got shape {start.shape}")
    field = _Field.of(system)
    if (compiled := _compiled()) is not None:
        ends = np.empty((kept, *start.shape))
        stages = (np.ascontiguousarray(x) for x in (field.lengths, field.reading, field.known, field.row))
        compiled.follow(*stages, np.ascontiguousarray(start), ends, count)
        return ends
    return field.followed(start, count, kept)


@where_compiled
def _compiled() -> ModuleType:
    from facegear.floquet import lockstep_transients

    return lockstep_transients


def contacts_along(system: ClearanceSystem, state: FloatArray) -> Pattern:
    """Contacts of the motion from a state along one period, to the accuracy of the steps."""
    field, states, rows = _Field.of(system), state[np.newaxis], []
    there = np.abs(field.row[:, 1]).max(axis=-1) > 0.0
    for step in range(field.lengths.size):
        start, states = states, field.advanced(step, states)
        rows.append(field.into(step, (start + states) / 2.0)[0] > 0.0)
    pressed: NDArray[np.bool_] = np.array(rows) & there
    changes = np.flatnonzero((pressed[1:] != pressed[:-1]).any(axis=1)) + 1
    edges = merged(np.append(system.system.breakpoints, 1.0), field.edges[changes])
    middles = (edges[:-1] + edges[1:]) / 2.0
    found = pressed[np.searchsorted(field.edges, middles, side="right") - 1]
    return Pattern(edges, found)
