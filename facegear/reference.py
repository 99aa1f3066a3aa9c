"""Stored reference arrays: save, load and compare, with the tolerance kept beside every number.

A figure of the book is one :class:`xarray.Dataset`. Every data variable carries its unit, a sentence, and the
tolerances ``rtol`` and ``atol`` at which it must come out again on another machine. Labels and names are coordinates
of text, see :func:`text`. The files are netCDF 3, which anything can read. They hold the name of their figure and a
digest of their content, so that a file that was truncated, edited or put in the place of another is refused, not
compared.
"""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from facegear.files import written_whole
from facegear.parameters import FloatArray
from facegear.provenance import made_by

TextArray = np.ndarray[Any, np.dtype[np.str_]]

_DIGEST = "content_sha256"
_NAME = "figure"
# What may differ between two files that hold the same result.
_PROVENANCE = (_DIGEST, _NAME, "facegear_version", "facegear_commit", "numpy_version", "xarray_version")
_LENGTH = "length_of_"
# What netCDF itself puts where an integer was never written.
_FILL_INTEGER = -2147483647
_REQUIRED_ATTRIBUTES = ("long_name", "units", "rtol", "atol")


DATASET = "(dataset)"
"""Name under which the attributes of a dataset are compared."""


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


def text(
    dimensions: str | tuple[str, ...], values: Sequence[Any] | TextArray, long_name: str
) -> tuple[str | tuple[str, ...], TextArray, dict[str, Any]]:
    """Make a coordinate of text, as :class:`xarray.Dataset` takes it: names or labels beside what they belong to.

    Parameters
    ----------
    dimensions : str or tuple of str
        Names of the dimensions of ``values``.
    values : sequence of str, nested as deep as there are dimensions
        Any text, empty where there is nothing.
    long_name : str
        What it is.
    """
    return dimensions, np.asarray(values, dtype=str), {"long_name": long_name}


def filled_labels(found: Sequence[Sequence[Any]]) -> TextArray:
    """Labels of things found, row by row, filled up with empty text to the shape of :func:`filled_rows`."""
    longest = max((len(row) for row in found), default=0) or 1
    rows = [[item.label for item in row] + [""] * (longest - len(row)) for row in found]
    return np.array(rows, dtype=str).reshape(len(found), longest)


def label_rows(labels: xr.DataArray) -> list[list[str]]:
    """Labels of each row of :func:`filled_labels`, without what it is filled up with."""
    return [[label for label in row if label] for row in labels.values.tolist()]


def digest(dataset: xr.Dataset) -> str:
    """SHA-256 over names, dimensions, values and attributes of a dataset, but for the digest that it holds itself."""
    state = hashlib.sha256()

    def feed(label: str, attributes: Mapping[Any, Any]) -> None:
        kept = {str(k): _plain(v) for k, v in attributes.items() if k != _DIGEST}
        state.update(json.dumps([label, kept], sort_keys=True).encode())

    feed("dataset", dataset.attrs)
    for name in sorted(map(str, dataset.variables)):
        variable = dataset.variables[name]
        values = np.ascontiguousarray(variable.values)
        if values.dtype.kind in "SUO":
            values = np.char.encode(values.astype(str), "utf-8")
        else:
            values = values.astype(values.dtype.newbyteorder("<"))
        place = "coordinate" if name in dataset.coords else "variable"
        feed(f"{place} {name} {variable.dims} {values.shape} {values.dtype.str}", variable.attrs)
        state.update(values.tobytes())
    return state.hexdigest()


def save(dataset: xr.Dataset, path: str | Path) -> Path:
    """Write a figure's arrays; the file appears whole or not at all.

    Parameters
    ----------
    dataset : xarray.Dataset
        Real arrays. Each data variable needs the attributes ``long_name``, ``units``, ``rtol`` and ``atol``;
        coordinates may be text.
    path : str or Path
        The file, ending in ``.nc``; its folder is made. Its name becomes the name of the figure.

    Returns
    -------
    Path
        The file written. Besides the arrays it has the name of the figure, the version and commit of the package
        (:func:`facegear.provenance.made_by`), and those of NumPy and xarray.

    Raises
    ------
    ValueError
        If a variable lacks an attribute, or numbers or text are such that netCDF 3 cannot hold them.

    Notes
    -----
    In netCDF 3 a dimension of length 0 is the one that can grow, which a file may have once and whose variables lie
    elsewhere; readers that rest on netCDF-C refuse what does not fit. So an empty dimension, of a table without rows,
    is written with one row of nothing (NaN, empty text, the fill value of netCDF for integers), and the attribute
    ``length_of_<dimension>`` of the file says 0. :func:`load` takes the row away.
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
    stored = _with_rows(_as_netcdf3(dataset))
    _check_text(stored)
    # What was loaded from another file keeps nothing of how that one was made.
    stored.attrs = {key: value for key, value in stored.attrs.items() if key not in _PROVENANCE}
    stored.attrs |= made_by() | {
        _NAME: path.stem,
        "numpy_version": np.__version__,
        "xarray_version": xr.__version__,
    }
    stored.attrs[_DIGEST] = digest(stored)
    with written_whole(path) as place:
        stored.to_netcdf(place, engine="scipy", format="NETCDF3_64BIT")
    return path


def load(path: str | Path) -> xr.Dataset:
    """Read a figure's arrays into memory and verify that they are whole and where they belong.

    Parameters
    ----------
    path : str or Path
        A file written by :func:`save`, under the name that it was written under.

    Returns
    -------
    xarray.Dataset

    Raises
    ------
    ReferenceFileError
        If the file is missing, cannot be read, holds another figure than its name says, or its content does not agree
        with its digest.
    """
    path = Path(path)
    if not path.is_file():
        raise ReferenceFileError(f"reference file {path.name} is missing in {path.parent}")
    try:
        # From bytes: a truncated file must not leave a half-open memory map behind.
        with xr.open_dataset(path, engine="scipy", decode_times=False, mask_and_scale=False) as opened:
            dataset = _as_netcdf3(opened.load().drop_encoding())
        recorded, found = dataset.attrs.get(_DIGEST), digest(dataset)
    except Exception as error:  # scipy answers a damaged file with half a dozen types
        raise ReferenceFileError(
            f"reference file {path.name} is truncated or not netCDF 3 ({error})"
        ) from error
    if recorded is None:
        raise ReferenceFileError(f"reference file {path.name} has no digest: it was not written by facegear")
    if found != recorded:
        raise ReferenceFileError(
            f"reference file {path.name} was changed or truncated after it was written "
            f"(digest {found[:12]}, recorded {str(recorded)[:12]})"
        )
    if dataset.attrs.get(_NAME) != path.stem:
        raise ReferenceFileError(
            f"reference file {path.name} holds the arrays of '{dataset.attrs.get(_NAME)}': it lies in the wrong place"
        )
    return _without_rows(dataset)


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
    computed = _as_netcdf3(computed)
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
        elif variable.dtype.kind in "SUO":
            converted[name] = variable.astype(str)
        converted[name].encoding["_FillValue"] = None
    converted.attrs = {key: _plain(value) for key, value in dataset.attrs.items()}
    return converted


def _check_text(dataset: xr.Dataset) -> None:
    """Refuse text that would not come back: netCDF ends it at a zero, UTF-8 has no halves of surrogate pairs."""
    texts = [(f"attribute '{key}'", value) for key, value in dataset.attrs.items()]
    for name, variable in dataset.variables.items():
        texts += [(f"attribute '{key}' of '{name}'", value) for key, value in variable.attrs.items()]
        if variable.dtype.kind == "U":
            texts += [(f"coordinate '{name}'", value) for value in variable.values.ravel().tolist()]
    for place, value in texts:
        if isinstance(value, str) and re.search("[\0\ud800-\udfff]", value):
            raise ValueError(f"{place} = {value!r} holds a character that a netCDF file cannot")


def _nothing(dtype: np.dtype[Any]) -> Any:
    """Return what stands in the row of a table without rows."""
    return {"f": np.nan, "i": _FILL_INTEGER}.get(dtype.kind, "")


def _with_rows(dataset: xr.Dataset) -> xr.Dataset:
    """Give every empty dimension one row of nothing, and say so in an attribute."""
    empty = [str(name) for name, length in dataset.sizes.items() if length == 0]
    if not empty:
        return dataset
    filled = {
        name: xr.Variable(
            variable.dims,
            np.full([length or 1 for length in variable.shape], _nothing(variable.dtype), variable.dtype),
            variable.attrs,
            variable.encoding,
        )
        for name, variable in dataset.variables.items()
        if variable.size == 0
    }
    kept = dataset.drop_vars(list(filled))
    marks = {_LENGTH + name: 0 for name in empty}
    return (
        kept.assign({str(name): value for name, value in filled.items() if name in dataset.data_vars})
        .assign_coords({str(name): value for name, value in filled.items() if name in dataset.coords})
        .assign_attrs(marks)
    )


def _without_rows(dataset: xr.Dataset) -> xr.Dataset:
    """Take away what :func:`_with_rows` gave."""
    empty = [str(name) for name in dataset.sizes if _LENGTH + str(name) in dataset.attrs]
    whole = dataset.isel({name: slice(0) for name in empty})
    whole.attrs = {key: v for key, v in whole.attrs.items() if key not in {_LENGTH + name for name in empty}}
    return whole


def _reworded(computed: Mapping[Any, Any], stored: Mapping[Any, Any]) -> str:
    """Say which attribute differs first, empty if none does."""
    for key in sorted({*map(str, computed), *map(str, stored)} - set(_PROVENANCE)):
        new, old = (_plain(attributes.get(key)) for attributes in (computed, stored))
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
