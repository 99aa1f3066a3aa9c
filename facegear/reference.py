"""Stored reference arrays: save, load and compare, with the tolerance kept beside every number.

A figure of the book is one :class:`xarray.Dataset`. Every data variable carries its unit, a sentence, and the
tolerances ``rtol`` and ``atol`` at which it must come out again on another machine. The files are netCDF 3, which
anything can read, and hold a digest of their content, so that a truncated or edited file is refused, not compared.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from facegear.files import written_whole
from facegear.parameters import FloatArray

_DIGEST = "content_sha256"
# What may differ between two files that hold the same result.
_PROVENANCE = (_DIGEST, "versions")
_REQUIRED_ATTRIBUTES = ("long_name", "units", "rtol", "atol")


class ReferenceCheckError(Exception):
    """A result and its reference cannot both be right; the message says where to look."""


class ReferenceFileError(ReferenceCheckError):
    """A reference file is missing, truncated, edited by hand or of another format."""


class ReferenceMismatchError(ReferenceCheckError):
    """A computed array disagrees with its stored reference or with an anchor."""


@dataclass(frozen=True)
class VariableDifference:
    """How far one variable has moved.

    Attributes
    ----------
    name : str
        Variable of the dataset.
    change : str
        ``"compared"``, ``"new"``, ``"removed"`` or ``"reshaped"``.
    largest_absolute, largest_relative : float
        Largest change in the variable's unit, and relative to the stored value [-]; NaN unless compared.
    exceedance : float
        Largest change divided by the stored tolerance ``atol + rtol |stored|`` [-]; above 1 is a disagreement.
    where : str
        Index of the worst element, as text.
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


def variable(
    dimensions: str | tuple[str, ...],
    values: Any,
    long_name: str,
    units: str,
    rtol: float = 0.0,
    atol: float = 0.0,
) -> tuple[str | tuple[str, ...], Any, dict[str, Any]]:
    """Make a data variable of a figure, as :class:`xarray.Dataset` takes it.

    Parameters
    ----------
    dimensions : str or tuple of str
        Names of the dimensions of ``values``.
    values : array_like
        Real numbers; NaN where there is nothing.
    long_name, units : str
        What it is, and its unit ("1" for pure numbers).
    rtol, atol : float
        Tolerances at which it must come out again: ``|new - stored| <= atol + rtol |stored|``. Both 0 for counts.
    """
    attributes = {"long_name": long_name, "units": units, "rtol": float(rtol), "atol": float(atol)}
    return dimensions, values, attributes


def filled_rows(found: Sequence[Sequence[Any]], name: str) -> FloatArray:
    """Attribute of things found, tongues or bands, row by row; rows are filled up with NaN.

    Parameters
    ----------
    found : sequence of sequence
        Rows of different lengths.
    name : str
        Attribute, a number.

    Returns
    -------
    ndarray, shape (rows, longest)
        At least one column wide.
    """
    table = np.full((len(found), max((len(row) for row in found), default=0) or 1), np.nan)
    for i, row in enumerate(found):
        table[i, : len(row)] = [getattr(item, name) for item in row]
    return table


def label_lines(found: Sequence[Sequence[Any]]) -> str:
    """Labels of things found, one line a row, separated by blanks."""
    return "\n".join(" ".join(item.label for item in row) for row in found)


def digest(dataset: xr.Dataset) -> str:
    """SHA-256 over names, dimensions, values and attributes of a dataset, provenance left out."""
    state = hashlib.sha256()

    def feed(label: str, attributes: Mapping[Any, Any]) -> None:
        kept = {str(k): _plain(v) for k, v in attributes.items() if k not in _PROVENANCE}
        state.update(json.dumps([label, kept], sort_keys=True).encode())

    feed("dataset", dataset.attrs)
    for name in sorted(map(str, dataset.variables)):
        variable = dataset.variables[name]
        values = np.ascontiguousarray(variable.values)
        if values.dtype.kind in "SUO":
            values = np.char.encode(values.astype(str), "utf-8")
        else:
            values = values.astype(values.dtype.newbyteorder("<"))
        feed(f"{name} {variable.dims} {values.shape} {values.dtype.kind}", variable.attrs)
        state.update(values.tobytes())
    return state.hexdigest()


def save(dataset: xr.Dataset, path: str | Path) -> Path:
    """Write a figure's arrays; the file appears whole or not at all.

    Parameters
    ----------
    dataset : xarray.Dataset
        Real arrays. Each data variable needs the attributes ``long_name``, ``units``, ``rtol`` and ``atol``.
    path : str or Path
        The file, ending in ``.nc``; its folder is made.

    Returns
    -------
    Path
        The file written.

    Raises
    ------
    ValueError
        If a variable lacks an attribute, or has values that netCDF 3 cannot hold.
    """
    path = Path(path)
    if path.suffix != ".nc":
        raise ValueError(f"path = '{path}' must end in .nc (netCDF 3)")
    for name, variable in dataset.data_vars.items():
        missing = [key for key in _REQUIRED_ATTRIBUTES if key not in variable.attrs]
        if missing:
            raise ValueError(f"variable '{name}' lacks the attribute(s) {', '.join(missing)}")
        if variable.dtype.kind not in "fi":
            raise ValueError(f"variable '{name}' has type {variable.dtype}; store real or integer numbers")
    stored = _as_netcdf3(dataset)
    stored.attrs["versions"] = json.dumps({"numpy": np.__version__, "xarray": xr.__version__}, sort_keys=True)
    stored.attrs[_DIGEST] = digest(stored)
    with written_whole(path) as place:
        stored.to_netcdf(place, engine="scipy", format="NETCDF3_64BIT")
    return path


def load(path: str | Path) -> xr.Dataset:
    """Read a figure's arrays into memory and verify their digest.

    Parameters
    ----------
    path : str or Path
        A file written by :func:`save`.

    Returns
    -------
    xarray.Dataset

    Raises
    ------
    ReferenceFileError
        If the file is missing, cannot be read, or its content does not agree with its digest.
    """
    path = Path(path)
    if not path.is_file():
        raise ReferenceFileError(f"reference file {path.name} is missing in {path.parent}")
    try:
        # From bytes: a truncated file must not leave a half-open memory map behind.
        with xr.open_dataset(path, engine="scipy", decode_times=False, mask_and_scale=False) as opened:
            dataset = opened.load()
    except Exception as error:  # scipy answers a damaged file with half a dozen types
        raise ReferenceFileError(
            f"reference file {path.name} is truncated or not netCDF 3 ({error})"
        ) from error
    recorded = dataset.attrs.get(_DIGEST)
    if recorded is None:
        raise ReferenceFileError(f"reference file {path.name} has no digest: it was not written by facegear")
    found = digest(dataset)
    if found != recorded:
        raise ReferenceFileError(
            f"reference file {path.name} was changed or truncated after it was written "
            f"(digest {found[:12]}, recorded {recorded[:12]})"
        )
    return dataset


def difference(computed: xr.Dataset, stored: xr.Dataset) -> tuple[VariableDifference, ...]:
    """Compare two versions of a figure, variable by variable, coordinates included.

    Parameters
    ----------
    computed, stored : xarray.Dataset
        The new arrays and the stored ones; the tolerances are those of ``stored``.

    Returns
    -------
    tuple of VariableDifference
        In alphabetic order of the variables of both.
    """
    computed = _as_netcdf3(computed)
    names = sorted({*map(str, computed.variables), *map(str, stored.variables)})
    return tuple(_variable_difference(name, computed, stored) for name in names)


def compare(computed: xr.Dataset, stored: xr.Dataset, name: str = "figure") -> tuple[VariableDifference, ...]:
    """As :func:`difference`, but a disagreement is an error.

    Raises
    ------
    ReferenceMismatchError
        Naming the figure, the worst variable, where in it, and by how much it is off.
    """
    if computed.attrs.get("parameters") != stored.attrs.get("parameters"):
        raise ReferenceMismatchError(
            f"{name}: computed for parameters {computed.attrs.get('parameters')}, "
            f"the reference for {stored.attrs.get('parameters')}"
        )
    rows = difference(computed, stored)
    wrong = [row for row in rows if not row.agrees]
    if wrong:
        worst = max(wrong, key=lambda row: row.exceedance)
        told = (
            f"{worst.largest_absolute:.3g} off at {worst.where}, {worst.exceedance:.3g} times the tolerance"
            if worst.change == "compared"
            else worst.change
        )
        raise ReferenceMismatchError(
            f"{name}: {len(wrong)} of {len(rows)} arrays disagree; '{worst.name}' is {told}"
        )
    return rows


def _plain(value: Any) -> Any:
    """Attribute as netCDF gives it back: NumPy scalars and one-element arrays as Python numbers."""
    if isinstance(value, np.ndarray | np.generic):
        listed = value.tolist()
        return listed[0] if isinstance(listed, list) and len(listed) == 1 else listed
    return value


def _as_netcdf3(dataset: xr.Dataset) -> xr.Dataset:
    """Numbers as 64-bit floats or 32-bit integers, which netCDF 3 has; NaN stays a value."""
    converted = dataset.copy()
    for name in converted.variables:
        variable = converted[name]
        if variable.dtype.kind in "iu":
            if np.any(np.abs(variable.values.astype(float)) > np.iinfo(np.int32).max):
                raise ValueError(f"variable '{name}' does not fit into 32-bit integers")
            converted[name] = variable.astype(np.int32)
        elif variable.dtype.kind == "f":
            converted[name] = variable.astype(np.float64)
        converted[name].encoding["_FillValue"] = None
    converted.attrs = {key: _plain(value) for key, value in dataset.attrs.items()}
    return converted


def _variable_difference(name: str, computed: xr.Dataset, stored: xr.Dataset) -> VariableDifference:
    """Largest deviation of one variable; NaN agrees with NaN only."""
    if name not in stored.variables:
        return VariableDifference(name, "new")
    if name not in computed.variables:
        return VariableDifference(name, "removed")
    new, old = computed[name], stored[name]
    if new.dims != old.dims or new.shape != old.shape:
        return VariableDifference(name, "reshaped")
    if old.dtype.kind not in "fi":
        same = bool(np.array_equal(new.values.astype(str), old.values.astype(str)))
        return (
            VariableDifference(name, "compared", 0.0, 0.0, 0.0)
            if same
            else VariableDifference(name, "reshaped")
        )
    if old.size == 0:
        return VariableDifference(name, "compared", 0.0, 0.0, 0.0)
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
    where = ", ".join(
        f"{d} = {computed[d].values[i]:.6g}" if d in computed.coords else f"{d}[{i}]"
        for d, i in zip(old.dims, worst, strict=True)
    )
    return VariableDifference(
        name, "compared", float(absolute.max()), float(np.nanmax(relative)), float(exceedance.max()), where
    )
