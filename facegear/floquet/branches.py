"""A family of periodic motions along one parameter, and the places on it where multipliers pass the unit circle."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from facegear.floquet.orbits import Orbit
from facegear.support.types import FloatArray

Kind = Literal["fold", "flip", "torus"]


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
