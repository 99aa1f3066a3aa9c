"""Periodic systems whose loads act in contact only: play between teeth, stops, impacts on springs.

A load of side +1 presses while its displacement u = φᵀq − e exceeds a clearance b, one of side −1 while u < −b, and
then as the spring and damper of :class:`facegear.floquet.loads.ContactLoad` on what is beyond the clearance,

    force = w (k (u ∓ b) + c u̇)   in contact,   0 else,

so that two loads of one shape and opposite sides are the law of a gap of width 2b. A damper that lets go with the
contact makes the force jump there. A load of side 0 acts always. All of it is homogeneous of degree one: clearances,
forces and transmission errors times ten make ten times the motion.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from facegear.floquet.loads import ContactLoad
from facegear.floquet.periodic import PeriodicSystem, require_system
from facegear.floquet.piecewise import PiecewiseChebyshev, merge_breakpoints
from facegear.support.kinds import named
from facegear.support.parameters import integer_at_least, integer_within, keep, nonnegative
from facegear.support.types import FloatArray


@dataclass(frozen=True, eq=False)
class ClearanceSystem:
    """A periodic system whose loads act on one side of a clearance.

    Parameters
    ----------
    system : PeriodicSystem
        What it is with all loads in contact; loads without mass, no jumps of the state.
    sides : sequence of {1, −1, 0}
        One a load: presses above its clearance, below, or always.
    clearances : sequence of float
        b of each load, in the unit of u, 0 or greater; 0 where the side is 0.

    Raises
    ------
    TypeError, ValueError
        Naming the parameter and what would be valid.

    Examples
    --------
    >>> spring = ContactLoad(PiecewiseChebyshev.constant([1.0]), stiffness=4.0)
    >>> system = PeriodicSystem([[1.0]], [[0.1]], [[0.0]], (spring, spring), 2.0)
    >>> ClearanceSystem(system, sides=(1, -1), clearances=(0.5, 0.5)).sides
    (1, -1)
    """

    system: PeriodicSystem
    sides: tuple[int, ...]
    clearances: tuple[float, ...]

    def __post_init__(self) -> None:
        require_system(self.system)
        sides = tuple(integer_within("sides", side, -1, 1) for side in _sequence("sides", self.sides))
        clearances = tuple(nonnegative("clearances", b) for b in _sequence("clearances", self.clearances))
        if not self.system.loads:
            raise ValueError("system must have at least one load for clearances, got none")
        for name, values in (("sides", sides), ("clearances", clearances)):
            if len(values) != len(self.system.loads):
                raise ValueError(
                    f"{name} must have {len(self.system.loads)} entries, one a load; got {len(values)}"
                )
        for side, clearance in zip(sides, clearances, strict=True):
            if side == 0 and clearance > 0.0:
                raise ValueError(
                    f"clearances must be 0 for a load that acts always (side 0), got {clearance!r}"
                )
        masses = [load.mass for load in self.system.loads if load.mass > 0.0]
        if masses:
            raise ValueError(
                f"system must have loads without mass, which an impact would move in no time; got mass {masses[0]!r}"
            )
        if self.system.jumps:
            raise ValueError(
                f"system must have no jumps of the state of its own, got {len(self.system.jumps)}"
            )
        keep(self, sides=sides, clearances=clearances)

    @property
    def size(self) -> int:
        """Number of coordinates n; the state has 2n."""
        return self.system.size

    @property
    def period(self) -> float:
        """T0 [s]."""
        return self.system.period

    def repeated(self, periods: int) -> ClearanceSystem:
        """Return the system with several periods taken for one."""
        count = integer_at_least("periods", periods, 1)
        return self if count == 1 else replace(self, system=self.system.repeated(count))

    @cached_property
    def fastest(self) -> float:
        """Highest natural frequency with all loads in contact, frozen in the middle of the smooth pieces [rad/s]."""
        edges = np.append(self.system.breakpoints, 1.0)
        middles = (edges[:-1] + edges[1:]) / 2.0
        stiffness = self.system.stiffness_matrix(middles)
        values = np.linalg.eigvals(np.linalg.solve(self.system.mass, stiffness))
        return float(np.sqrt(np.abs(values).max()))

    def divided(self, angle: float, fewest: int = 1) -> FloatArray:
        """Return the ends of parts of the period, breakpoints among them, from 0 to 1.

        Along each the fastest natural motion turns by an angle [rad] at most; a smooth piece has `fewest` or more.
        """
        ends = np.append(self.system.breakpoints, 1.0)
        turns = self.fastest * self.period / angle
        parts = [
            np.linspace(start, end, max(fewest, int(np.ceil(turns * (end - start) - 1e-9))) + 1)[:-1]
            for start, end in pairwise(ends)
        ]
        return np.append(np.concatenate(parts), 1.0)

    @cached_property
    def inverse_mass(self) -> FloatArray:
        """M⁻¹, shape (n, n)."""
        return np.asarray(np.linalg.inv(self.system.mass), dtype=float)

    @cached_property
    def scale(self) -> FloatArray:
        """S that makes velocities of a state (q, q̇), both parts in the measure of the kinetic energy, (2n, 2n)."""
        root, n = np.linalg.cholesky(self.system.mass).T, self.size
        scale = np.zeros((2 * n, 2 * n))
        scale[:n, :n], scale[n:, n:] = root * 2.0 * np.pi / self.period, root
        return scale

    def pressed(self, edges: FloatArray, pressed: NDArray[np.bool_]) -> PeriodicSystem:
        """Return the linear system of the loads that are in contact between some instants.

        Parameters
        ----------
        edges : array, shape (P + 1,)
            From 0 to 1, the breakpoints of the system among them.
        pressed : array of bool, shape (P, p)
            Whether each load is in contact between them.
        """
        loads = tuple(
            _in_contact(load, side * clearance, edges, pressed[:, number])
            for number, (load, side, clearance) in enumerate(
                zip(self.system.loads, self.sides, self.clearances, strict=True)
            )
        )
        return replace(self.system, loads=loads)


def _sequence(name: str, values: object) -> tuple[object, ...]:
    if not isinstance(values, Iterable) or isinstance(values, str):
        raise TypeError(f"{name} must be a sequence, one entry a load; got {named(values)}")
    return tuple(values)


def _in_contact(load: ContactLoad, edge: float, edges: FloatArray, pressed: NDArray[np.bool_]) -> ContactLoad:
    """Return a load that acts on u − edge while it is pressed."""
    error = PiecewiseChebyshev.constant([0.0]) if load.transmission_error is None else load.transmission_error
    moved = error.coefficients.copy()
    moved[:, 0, 0] += edge
    changes = np.flatnonzero(pressed != np.roll(pressed, 1))
    own = np.zeros(1) if load.weight is None else load.weight.breakpoints
    starts = merge_breakpoints([own, np.zeros(1), edges[:-1][changes]])
    middles = (starts + np.append(starts[1:], 1.0)) / 2.0
    acts = pressed[np.searchsorted(edges, middles, side="right") - 1]

    def weight(fraction: FloatArray, piece: int) -> FloatArray:
        if not acts[piece]:
            return np.zeros(fraction.size)
        return np.ones(fraction.size) if load.weight is None else load.weight(fraction)[:, 0]

    return replace(
        load,
        weight=PiecewiseChebyshev.fit(weight, starts),
        transmission_error=PiecewiseChebyshev(error.breakpoints, moved),
    )
