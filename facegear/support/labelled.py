"""Labelled arrays: numbers with their unit, a sentence and tolerances, text beside them, and files of them.

A figure of the book, or a table of a report, is one :class:`xarray.Dataset`. Every data variable carries its unit, a
sentence, and the tolerances ``rtol`` and ``atol`` at which it must come out again on another machine. Labels and names
are coordinates of text, see :func:`text`. The files are netCDF 3, which anything can read. They hold the name of their
figure and a digest of their content, so that a file that was truncated, edited or put in the place of another is
refused, not used.
"""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from facegear.support.files import written_whole
from facegear.support.provenance import made_by
from facegear.support.types import FloatArray, TextArray

_DIGEST = "content_sha256"
_NAME = "figure"
PROVENANCE = (_DIGEST, _NAME, "facegear_version", "facegear_commit", "numpy_version", "xarray_version")
"""Attributes that may differ between two files that hold the same result."""
_LENGTH = "length_of_"
# What netCDF itself puts where an integer was never written.
_FILL_INTEGER = -2147483647
_REQUIRED_ATTRIBUTES = ("long_name", "units", "rtol", "atol")


class ArrayFileError(Exception):
    """A file of arrays is missing, truncated, edited by hand, of another format, or of another figure."""


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
        kept = {str(k): plain_attribute(v) for k, v in attributes.items() if k != _DIGEST}
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
        (:func:`facegear.support.provenance.made_by`), and those of NumPy and xarray.

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
    stored = _with_rows(as_netcdf3(dataset))
    _check_text(stored)
    # What was loaded from another file keeps nothing of how that one was made.
    stored.attrs = {key: value for key, value in stored.attrs.items() if key not in PROVENANCE}
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
    ArrayFileError
        If the file is missing, cannot be read, holds another figure than its name says, or its content does not agree
        with its digest.
    """
    path = Path(path)
    if not path.is_file():
        raise ArrayFileError(f"array file {path.name} is missing in {path.parent}")
    try:
        # From bytes: a truncated file must not leave a half-open memory map behind.
        with xr.open_dataset(path, engine="scipy", decode_times=False, mask_and_scale=False) as opened:
            dataset = as_netcdf3(opened.load().drop_encoding())
        recorded, found = dataset.attrs.get(_DIGEST), digest(dataset)
    except Exception as error:  # scipy answers a damaged file with half a dozen types
        raise ArrayFileError(f"array file {path.name} is truncated or not netCDF 3 ({error})") from error
    if recorded is None:
        raise ArrayFileError(f"array file {path.name} has no digest: it was not written by facegear")
    if found != recorded:
        raise ArrayFileError(
            f"array file {path.name} was changed or truncated after it was written "
            f"(digest {found[:12]}, recorded {str(recorded)[:12]})"
        )
    if dataset.attrs.get(_NAME) != path.stem:
        raise ArrayFileError(
            f"array file {path.name} holds the arrays of '{dataset.attrs.get(_NAME)}': it lies in the wrong place"
        )
    return _without_rows(dataset)


def plain_attribute(value: Any) -> Any:
    """Attribute as netCDF gives it back: NumPy scalars and one-element arrays as Python numbers."""
    if isinstance(value, np.ndarray | np.generic):
        listed = value.tolist()
        return listed[0] if isinstance(listed, list) and len(listed) == 1 else listed
    return value


def as_netcdf3(dataset: xr.Dataset) -> xr.Dataset:
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
    converted.attrs = {key: plain_attribute(value) for key, value in dataset.attrs.items()}
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
