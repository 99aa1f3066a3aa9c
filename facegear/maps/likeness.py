"""What two periodic systems have in common: what a map may share between its cells depends on that."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from facegear.floquet.periodic import PeriodicSystem, have_one_course
from facegear.floquet.piecewise import same_function


def same_layout(one: PeriodicSystem, other: PeriodicSystem) -> bool:
    """Whether two systems have the same size, number of loads and breakpoints."""
    return (
        one.size == other.size
        and len(one.loads) == len(other.loads)
        and (have_one_course(one, other) or np.array_equal(one.breakpoints, other.breakpoints))
    )


def load_parameters_of(system: PeriodicSystem) -> list[list[float]]:
    """Mass, damping and stiffness of each load."""
    return [[getattr(load, name) for load in system.loads] for name in ("mass", "damping", "stiffness")]


def same_but_load_parameters(one: PeriodicSystem, other: PeriodicSystem) -> bool:
    """Whether two systems differ at most in the mass, damping and stiffness of their loads."""
    return (
        one.period == other.period
        and len(one.loads) == len(other.loads)
        and len(one.jumps) == len(other.jumps)
        and all(np.array_equal(getattr(one, m), getattr(other, m)) for m in ("mass", "damping", "stiffness"))
        and all(
            a.fraction == b.fraction and np.array_equal(a.matrix, b.matrix)
            for a, b in zip(one.jumps, other.jumps, strict=True)
        )
        and all(
            a.rate == b.rate and same_function(a.weight, b.weight) and same_function(a.shape, b.shape)
            for a, b in zip(one.loads, other.loads, strict=True)
        )
    )


def same_but_period(one: PeriodicSystem, other: PeriodicSystem) -> bool:
    """Whether two systems differ at most in their periods."""
    return same_but_load_parameters(one, replace(other, period=one.period)) and (
        load_parameters_of(one) == load_parameters_of(other)
    )
