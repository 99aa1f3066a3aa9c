"""Axes of a map: speeds and values of a parameter, checked, and the periods that go with speeds."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from facegear.floquet.models import Model
from facegear.support.parameters import finite_array, rpm
from facegear.support.types import FloatArray

MOST_CELLS = 10_000_000
"""Of one map."""


def checked_speeds(speeds: ArrayLike) -> FloatArray:
    """Check that speeds [rad/s] are finite, positive and ascending, and return them as an array of shape (S,).

    Raises
    ------
    TypeError, ValueError
        Naming what is wrong.
    """
    array = finite_array("speeds", speeds, "rad/s")
    if array.ndim != 1 or array.size == 0:
        raise ValueError(f"speeds must list at least one speed in rad/s, got shape {array.shape}")
    if array.min() <= 0.0:
        raise ValueError(f"speeds must be greater than 0 rad/s, got {float(array.min())!r}")
    if (np.diff(array) <= 0.0).any():
        raise ValueError("speeds must ascend strictly, got equal or descending neighbours")
    return array


def require_cells(speeds: FloatArray, values: FloatArray) -> None:
    """Refuse axes of so many cells that no memory holds them, nor anybody waits for them.

    Raises
    ------
    ValueError
        Naming the number of either axis.
    """
    if speeds.size * values.size > MOST_CELLS:
        raise ValueError(
            f"speeds times values must be at most {MOST_CELLS} cells, got {speeds.size} times {values.size}"
        )


def speed_coordinates(speeds: FloatArray) -> dict[str, Any]:
    """Coordinates of a map along speeds (S,) [rad/s], in both units."""
    return {
        "speed": ("speed", speeds, {"units": "rad/s", "long_name": "speed"}),
        "speed_rpm": ("speed", rpm(speeds), {"units": "rpm", "long_name": "speed"}),
    }


def periods_at(model: Model, speeds: FloatArray) -> FloatArray:
    """Periods T0 [s] of a model at speeds (S,) [rad/s]: in inverse proportion to them, if a few of them are."""
    few = speeds[[0, speeds.size // 2, -1]]
    turned = np.array([model.system(speed).period for speed in few.tolist()]) * few
    if np.ptp(turned) <= 1e-12 * turned[0]:
        return np.asarray(turned[0] / speeds)
    return np.array([model.system(speed).period for speed in speeds.tolist()])


def checked_values(values: ArrayLike) -> FloatArray:
    """Check that values of a parameter are finite and differ, and return them; errors as in :func:`checked_speeds`."""
    array = finite_array("values", values)
    if array.ndim != 1 or array.size == 0:
        raise ValueError(f"values must list at least one value of the parameter, got shape {array.shape}")
    if np.unique(array).size < array.size:
        raise ValueError("values must differ from one another, got a repeated value")
    return array
