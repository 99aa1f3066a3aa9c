"""Parameters of the loads of a system, for many values at once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from facegear.floquet.periodic import PeriodicSystem
from facegear.support.parameters import keep
from facegear.support.types import FloatArray


@dataclass(frozen=True, eq=False)
class LoadColumn:
    """Load parameters along a column of a map: V values, p loads.

    Attributes
    ----------
    mass, damping, stiffness : array, shape (V, p)
    """

    mass: FloatArray
    damping: FloatArray
    stiffness: FloatArray

    def __post_init__(self) -> None:
        for name in ("mass", "damping", "stiffness"):
            values = np.asarray(getattr(self, name), dtype=np.float64)
            keep(self, **{name: values})
            if values.shape != self.mass.shape or values.ndim != 2:
                raise ValueError(f"{name} must have shape (values, loads) as the others; got {values.shape}")
            if not np.isfinite(values).all() or (values < 0.0).any():
                raise ValueError(f"{name} must be finite and >= 0; got {values.min()!r} as smallest value")

    @classmethod
    def of(cls, system: PeriodicSystem) -> LoadColumn:
        """Return the one value of each parameter that a system has."""
        return cls.of_all([system])

    @classmethod
    def of_all(cls, systems: Sequence[PeriodicSystem]) -> LoadColumn:
        """Return the values that several systems with as many loads have, one of each."""
        found = [[(load.mass, load.damping, load.stiffness) for load in system.loads] for system in systems]
        values = np.array(found, dtype=float).reshape(len(systems), len(systems[0].loads), 3)
        return cls(*np.moveaxis(values, 2, 0))

    def __len__(self) -> int:
        return int(self.mass.shape[0])

    @property
    def parts(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Mass, damping and stiffness, as the column is made of them."""
        return self.mass, self.damping, self.stiffness

    def stacked(self) -> FloatArray:
        """All parameters, shape (V, 3 p)."""
        return np.concatenate(self.parts, axis=1)

    def extremes(self) -> LoadColumn:
        """Rows that hold the smallest and the largest of each parameter, and the middle one."""
        values = self.stacked()
        rows = np.unique(np.concatenate([values.argmin(axis=0), values.argmax(axis=0), [len(self) // 2]]))
        return LoadColumn(self.mass[rows], self.damping[rows], self.stiffness[rows])

    @classmethod
    def from_stacked(cls, values: FloatArray) -> LoadColumn:
        """Undo :meth:`stacked`; rounding below zero is taken off."""
        mass, damping, stiffness = np.split(np.maximum(values, 0.0), 3, axis=1)
        return cls(mass, damping, stiffness)
