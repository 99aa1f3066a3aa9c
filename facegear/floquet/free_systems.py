"""Systems before contact forces are asked for: their modes, loads and how far they turn in a period."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from facegear.floquet.contact_forces import mobilities
from facegear.floquet.free_modes import HeldSystems
from facegear.floquet.load_columns import LoadColumn
from facegear.floquet.periodic import PeriodicSystem
from facegear.support.types import FloatArray


@dataclass(frozen=True, eq=False)
class FreeSystems:
    """One system with many values of its load parameters, or many systems with one each.

    Attributes
    ----------
    systems : sequence of PeriodicSystem
        One for all values of the column, or one a value; of one size, with common breakpoints. Their own load
        parameters are not used.
    column : LoadColumn
        Values of the load parameters.
    held : HeldSystems
        The systems with springs for what hangs on nothing.
    angles : array, shape (S,)
        Fastest frequency under load times the period [rad].
    """

    systems: Sequence[PeriodicSystem]
    column: LoadColumn
    held: HeldSystems
    angles: FloatArray

    @classmethod
    def of(cls, systems: Sequence[PeriodicSystem], column: LoadColumn, fewest_held: int = 1) -> FreeSystems:
        """Find the modes.

        Parameters
        ----------
        systems, column
            As above.
        fewest_held : int
            Number of coordinates from which on motions that hang on nothing are held by springs that are taken back.

        Raises
        ------
        UnsuitableSystemError
            See :meth:`facegear.floquet.free_modes.FreeModes.of`.
        """
        stiffness = (column.stiffness * mobilities(systems)).sum(axis=-1)
        stiffest = float(stiffness.max())
        held = HeldSystems.of(systems, stiffest, fewest_held)
        fastest = np.hypot(
            np.abs(held.modes.eigenvalues).max(axis=-1),
            np.sqrt(stiffest if len(systems) == 1 else stiffness),
        )
        return cls(systems, column, held, fastest * np.array([system.period for system in systems]))

    def some(self, places: NDArray[np.intp]) -> FreeSystems:
        """Return some of many systems, by their places."""
        held = self.held.some(places)
        column = LoadColumn(*(part[places] for part in self.column.parts))
        return FreeSystems([self.systems[k] for k in places.tolist()], column, held, self.angles[places])
