"""A model and the values of one of its parameters, and what its systems have in common along them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from facegear.floquet.methods import Method
from facegear.floquet.models import (
    Model,
    is_whole_number,
    parameter_path,
    replace_at,
)
from facegear.floquet.periodic import PeriodicSystem
from facegear.maps.likeness import load_parameters_of, same_but_load_parameters, same_layout
from facegear.support.types import FloatArray


@dataclass(frozen=True)
class Sweep:
    """A model and the values of one of its parameters."""

    model: Model
    parameter: str
    values: tuple[float, ...]
    method: Method | None

    def model_at(self, value: float) -> Any:
        """Return the model with the parameter replaced; the same one each time, for columns share their values."""
        if value not in self._built:
            self._built[value] = replace_at(self.model, self.path, value)
        return self._built[value]

    @cached_property
    def _built(self) -> dict[float, Any]:
        return {}

    @cached_property
    def path(self) -> tuple[str, ...]:
        """Fields that lead to the parameter."""
        return parameter_path(self.model, self.parameter)

    @cached_property
    def models(self) -> tuple[Model, ...]:
        """One model a value."""
        return tuple(self.model_at(value) for value in self.values)

    @cached_property
    def probes(self) -> tuple[int, ...]:
        """Numbers of the first, the middle and the last value."""
        return tuple(sorted({0, len(self.values) // 2, len(self.values) - 1}))

    def load_parameters(self, systems: Sequence[PeriodicSystem]) -> FloatArray | None:
        """Mass, damping and stiffness of each contact, (V, 3, loads), if the systems differ in nothing else."""
        if not all(same_but_load_parameters(systems[0], other) for other in systems[1:]):
            return None
        return np.array([load_parameters_of(system) for system in systems])

    @property
    def probed(self) -> tuple[Model, ...]:
        """Models of these values."""
        return tuple(self.model_at(self.values[probe]) for probe in self.probes)

    def keeps(self, loads: FloatArray, speed: float) -> bool:
        """Whether the first, the middle and the last value have these load parameters at a speed, all else being equal.

        Parameters
        ----------
        loads : array, shape (V, 3, loads)
            From :meth:`load_parameters`.
        """
        found = self.load_parameters([model.system(speed) for model in self.probed])
        return found is not None and np.array_equal(found, loads[list(self.probes)])

    def some(self, numbers: NDArray[np.intp]) -> Sweep:
        """Return the sweep of some of the values, by their numbers; models that have been built are shared."""
        part = replace(self, values=tuple(self.values[number] for number in numbers.tolist()))
        part._built.update(self._built)
        return part

    @property
    def description(self) -> str:
        """Method in words."""
        chosen = "default method" if self.method is None else repr(self.method)
        return f"{chosen}, transition matrices interpolated along {self.parameter} and speed where they are smooth"


def cell_by_cell(sweep: Sweep, systems: Sequence[PeriodicSystem]) -> bool:
    """Whether a column is no smooth function of its parameter, which counts something or moves breakpoints."""
    few = len(sweep.values) <= len(sweep.probes) or is_whole_number(sweep.model, sweep.parameter)
    return few or any(not same_layout(systems[0], other) for other in systems[1:])
