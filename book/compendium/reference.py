"""Stored reference arrays: compared with what is computed anew, at the tolerance kept beside every number.

How they are made, labelled and stored is in :mod:`facegear.support.labelled`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from facegear.support.labelled import PROVENANCE, as_netcdf3, plain_attribute

DATASET = "(dataset)"
"""Name under which the attributes of a dataset are compared."""


class ReferenceCheckError(Exception):
    """A result and its reference cannot both be right; the message says where to look."""


class ReferenceMismatchError(ReferenceCheckError):
    """A computed array disagrees with its stored reference or with an anchor."""


@dataclass(frozen=True)
class VariableDifference:
    """How far one variable has moved.

    Attributes
    ----------
    name : str
        Variable of the dataset, or :data:`DATASET` for its own attributes.
    change : str
        ``"compared"``, ``"new"``, ``"removed"``, ``"reshaped"`` or ``"reworded"``: its text, unit, sentence or
        tolerances are others.
    largest_absolute, largest_relative : float
        Largest change in the variable's unit, and relative to the stored value [-]; NaN unless compared.
    exceedance : float
        Largest change divided by the stored tolerance ``atol + rtol |stored|`` [-]; above 1 is a disagreement.
    where : str
        Index of the worst element, or what was reworded, as text.
    """

    name: str
    change: str
    largest_absolute: float = float("nan")
    largest_relative: float = float("nan")
    exceedance: float = float("inf")
    where: str = ""

    @property
    def agrees(self) -> bool:
        """Whether the variable is there on both sides and within tolerance."""
        return self.change == "compared" and self.exceedance <= 1.0


def difference(computed: xr.Dataset, stored: xr.Dataset) -> tuple[VariableDifference, ...]:
    """Compare two versions of a figure: its own attributes, then variable by variable, coordinates included.

    Text must be the same, provenance left out; numbers agree within the tolerances stored with them.

    Parameters
    ----------
    computed, stored : xarray.Dataset
        The new arrays and the stored ones; the tolerances are those of ``stored``.

    Returns
    -------
    tuple of VariableDifference
        In alphabetic order of the variables of both; before them the dataset, if its own attributes differ.
    """
    computed = as_netcdf3(computed)
    names = sorted({*map(str, computed.variables), *map(str, stored.variables)})
    rows = tuple(_variable_difference(name, computed, stored) for name in names)
    own = _reworded(computed.attrs, stored.attrs)
    return (VariableDifference(DATASET, "reworded", where=own), *rows) if own else rows


def compare(computed: xr.Dataset, stored: xr.Dataset, name: str = "figure") -> tuple[VariableDifference, ...]:
    """As :func:`difference`, but a disagreement is an error.

    Raises
    ------
    ReferenceMismatchError
        Naming the figure, the worst variable, where in it, and by how much it is off.
    """
    rows = difference(computed, stored)
    wrong = [row for row in rows if not row.agrees]
    if wrong:
        worst = max(wrong, key=lambda row: row.exceedance)
        told = (
            f"{worst.largest_absolute:.3g} off at {worst.where}, {worst.exceedance:.3g} times the tolerance"
            if worst.change == "compared"
            else f"{worst.change} {worst.where}".strip()
        )
        raise ReferenceMismatchError(
            f"{name}: {len(wrong)} of {len(rows)} arrays disagree; '{worst.name}' is {told}"
        )
    return rows


def _reworded(computed: Mapping[Any, Any], stored: Mapping[Any, Any]) -> str:
    """Say which attribute differs first, empty if none does."""
    for key in sorted({*map(str, computed), *map(str, stored)} - set(PROVENANCE)):
        new, old = (plain_attribute(attributes.get(key)) for attributes in (computed, stored))
        if not _same(new, old):
            return f"in {key}: {new!r}, stored {old!r}"
    return ""


def _same(new: Any, old: Any) -> bool:
    """Whether two attributes are the same, numbers to rounding: a tolerance may hang on what was computed."""
    if isinstance(new, str) or isinstance(old, str) or new is None or old is None:
        return bool(new == old)
    return np.shape(new) == np.shape(old) and bool(np.allclose(new, old, rtol=1e-9, atol=0.0))


def _agreement(name: str) -> VariableDifference:
    return VariableDifference(name, "compared", 0.0, 0.0, 0.0)


def _place(dataset: xr.Dataset, dimensions: Sequence[Any], indices: Sequence[Any]) -> str:
    """Where an element stands, by its coordinates."""

    def told(dimension: Any, index: int) -> str:
        if dimension not in dataset.coords:
            return f"{dimension}[{index}]"
        value = dataset[dimension].values[index]
        return f"{dimension} = {value}" if isinstance(value, str) else f"{dimension} = {value:.6g}"

    return ", ".join(told(*pair) for pair in zip(dimensions, indices, strict=True))


def _variable_difference(name: str, computed: xr.Dataset, stored: xr.Dataset) -> VariableDifference:
    """Largest deviation of one variable; NaN agrees with NaN only."""
    if name not in stored.variables:
        return VariableDifference(name, "new")
    if name not in computed.variables:
        return VariableDifference(name, "removed")
    new, old = computed[name], stored[name]
    if (
        new.dims != old.dims
        or new.shape != old.shape
        or (new.dtype.kind in "SUO") != (old.dtype.kind in "SUO")
    ):
        return VariableDifference(name, "reshaped")
    reworded = _reworded(new.attrs, old.attrs)
    if reworded:
        return VariableDifference(name, "reworded", where=reworded)
    if old.dtype.kind in "SUO":
        a, b = new.values.astype(str), old.values.astype(str)
        others = np.argwhere(a != b)
        if len(others) == 0:
            return _agreement(name)
        first = tuple(others[0])
        place = _place(computed, old.dims, first)
        return VariableDifference(
            name, "reworded", where=f"at {place}: {str(a[first])!r}, stored {str(b[first])!r}"
        )
    if old.size == 0:
        return _agreement(name)
    a, b = new.values.astype(float), old.values.astype(float)
    with np.errstate(invalid="ignore", divide="ignore"):
        absolute = np.where(np.isnan(a) & np.isnan(b) | (a == b), 0.0, np.abs(a - b))
        absolute = np.where(np.isnan(absolute), np.inf, absolute)
        # Coordinates have no tolerance of their own: they are inputs and must be the same to rounding.
        rtol = float(old.attrs.get("rtol", 1e-12))
        atol = float(old.attrs.get("atol", 0.0))
        exceedance = np.where(
            absolute == 0.0, 0.0, absolute / (atol + rtol * np.nan_to_num(np.abs(b), posinf=0.0))
        )
        relative = np.where(absolute == 0.0, 0.0, absolute / np.abs(b))
    worst = np.unravel_index(int(np.argmax(exceedance)), exceedance.shape)
    where = _place(computed, old.dims, worst)
    return VariableDifference(
        name, "compared", float(absolute.max()), float(np.nanmax(relative)), float(exceedance.max()), where
    )
