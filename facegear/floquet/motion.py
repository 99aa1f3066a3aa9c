"""The motion along a period, panel by panel: what collocation knows of it besides its end.

Between two instants the state at the end of a panel, and at the nodes inside, is an affine function of the state at its
start: forces and transmission errors add what does not depend on the motion. Methods that know the motion along their
panels, and not at the end of the period only, make one of these.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from facegear.floquet.loads import weighted_shape
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import Side
from facegear.support.types import FloatArray


@dataclass(frozen=True, eq=False)
class MotionPanels:
    """Motion of one system, state (q, q̇), on P panels with N nodes each.

    Attributes
    ----------
    edges : array, shape (P + 1,)
        Ends of the panels, fractions of the period, from 0 to 1.
    nodes : array, shape (N,)
        Nodes in a panel, parts of its length.
    steps : array, shape (P, 2n, 2n)
        Transition matrices of the panels, jumps at their starts left out.
    offsets : array, shape (P, 2n)
        State at the end of a panel that starts at rest.
    inside : callable
        States at the starts of the panels (P, 2n) to those at all nodes (P, N, 2n).
    """

    edges: FloatArray
    nodes: FloatArray
    steps: FloatArray
    offsets: FloatArray
    inside: Callable[[FloatArray], FloatArray]


@runtime_checkable
class FollowsMotion(Protocol):
    """A method that knows the motion along a period."""

    def motion_panels(self, system: PeriodicSystem, instants: Sequence[float]) -> MotionPanels:
        """Panels that end at the breakpoints and at some instants, fractions of the period."""
        ...


def known_errors(system: PeriodicSystem, fraction: FloatArray, side: Side = "right") -> FloatArray:
    """Transmission errors e of the loads, with their first and second derivative by time, shape (3, ..., p)."""
    found = np.zeros((3, *fraction.shape, len(system.loads)))
    for number, load in enumerate(system.loads):
        if load.transmission_error is not None:
            for order in range(3):
                values = load.transmission_error.derivative(order)(fraction, side)[..., 0]
                found[order, ..., number] = values / system.period**order
    return found


def known_forces(system: PeriodicSystem, fraction: FloatArray, side: Side = "right") -> FloatArray:
    """All of f that does not depend on the motion: forces, and loads on their transmission errors, shape (..., n)."""
    total = np.zeros((*fraction.shape, system.size))
    if system.force is not None:
        total += system.force(fraction, side)
    errors = known_errors(system, fraction, side)
    for number, load in enumerate(system.loads):
        if load.transmission_error is not None:
            e, rate, acceleration = errors[..., number]
            size = load.stiffness * e + load.damping * rate + load.mass * acceleration
            total += weighted_shape(load, fraction, side) * size[..., np.newaxis]
    return total
