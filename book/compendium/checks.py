"""Is every figure what it was, and is it right: references and anchors together.

An array that agrees with its own stored copy proves only that nothing changed. So each figure also has *anchors*:
single values computed by a route that shares no code with the package, kept as text in ``data/anchors``.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
import yaml

from compendium.reference import ReferenceCheckError, ReferenceMismatchError, compare
from facegear.support.labelled import ArrayFileError, load, save
from facegear.support.parameters import known_keys


class AnchorFileError(ReferenceCheckError):
    """A file of anchors is missing, cannot be used, or belongs to another figure."""


@dataclass(frozen=True)
class Anchor:
    """One value of a figure, computed by an independent route.

    Attributes
    ----------
    variable : str
        Variable of the figure's dataset.
    at : mapping of str to float
        Coordinate of the element along each of the variable's dimensions.
    value : float
        The independent value, in the variable's unit.
    atol : float
        Absolute tolerance of the comparison, in the variable's unit.
    """

    variable: str
    at: Mapping[str, float]
    value: float
    atol: float


def load_anchors(path: str | Path) -> tuple[Anchor, ...]:
    """Read the anchors of one figure.

    Parameters
    ----------
    path : str or Path
        YAML file with the keys ``figure`` (its own name without ending), ``route`` (a sentence) and ``anchors`` (a
        list of mappings with the fields of :class:`Anchor`).

    Raises
    ------
    AnchorFileError
        If the file is missing, holds no anchor or those of another figure, or a key is unknown or missing.
    """
    path = Path(path)
    if not path.is_file():
        raise AnchorFileError(f"anchor file {path.name} is missing in {path.parent}")
    try:
        content = yaml.safe_load(path.read_text(encoding="utf-8"))
        known_keys(path.name, content, required=("figure", "route", "anchors"))
        for entry in content["anchors"]:
            known_keys(f"anchor of {path.name}", entry, required=("variable", "at", "value", "atol"))
        anchors = tuple(
            Anchor(
                str(entry["variable"]),
                {str(k): float(v) for k, v in entry["at"].items()},
                float(entry["value"]),
                float(entry["atol"]),
            )
            for entry in content["anchors"]
        )
    except (yaml.YAMLError, ValueError, TypeError, AttributeError) as error:
        raise AnchorFileError(f"anchor file {path.name} cannot be used: {error}") from error
    if content["figure"] != path.stem:
        raise AnchorFileError(
            f"anchor file {path.name} holds the anchors of '{content['figure']}': it lies in the wrong place"
        )
    if not anchors:
        raise AnchorFileError(f"anchor file {path.name} holds no anchor")
    return anchors


def element_at(computed: xr.Dataset, anchor: Anchor, name: str = "figure") -> float:
    """Return the element of a figure that an anchor is about.

    Raises
    ------
    ReferenceMismatchError
        If it is not on the grid.
    """
    if anchor.variable not in computed:
        raise ReferenceMismatchError(
            f"{name}: the anchor's variable '{anchor.variable}' is not among the arrays"
        )
    element = computed[anchor.variable]
    if set(element.dims) != set(anchor.at):
        raise ReferenceMismatchError(
            f"{name}: '{anchor.variable}' has dimensions {element.dims}, the anchor {anchor.at}"
        )
    for dimension, wanted in anchor.at.items():
        axis = np.asarray(computed[dimension].values, dtype=float)
        index = int(np.argmin(np.abs(axis - wanted)))
        if not np.isclose(axis[index], wanted, rtol=1e-12, atol=1e-14):
            raise ReferenceMismatchError(f"{name}: the anchor at {dimension} = {wanted} is not on the grid")
        element = element.isel({dimension: index})
    return float(element)


def check_anchors(computed: xr.Dataset, anchors: tuple[Anchor, ...], name: str = "figure") -> float:
    """Compare single elements of a figure with their independent values.

    Returns
    -------
    float
        The largest error, as a fraction of its tolerance [-].

    Raises
    ------
    ReferenceMismatchError
        If an anchor's element is not on the grid, or differs by more than its tolerance.
    """
    worst = 0.0
    for anchor in anchors:
        element = element_at(computed, anchor, name)
        error = abs(element - anchor.value)
        if not error <= anchor.atol:
            raise ReferenceMismatchError(
                f"{name}: '{anchor.variable}' at {dict(anchor.at)} is {element:.12g}, "
                f"the independent route gives {anchor.value:.12g} (tolerance {anchor.atol:g})"
            )
        worst = max(worst, error / anchor.atol)
    return worst


def check_figures(
    figures: Mapping[str, xr.Dataset], data_directory: str | Path, build_directory: str | Path
) -> list[dict[str, Any]]:
    """Write every figure's arrays, then compare each with its reference and its anchors.

    All arrays are written before the first comparison, so that ``make references`` finds them even when nothing
    agrees.

    Parameters
    ----------
    figures : mapping of str to xarray.Dataset
        The arrays of each figure under the name of its reference file.
    data_directory, build_directory : str or Path
        Where ``reference/`` and ``anchors/`` are read, and where ``arrays/`` is written.

    Returns
    -------
    list of dict
        One row a figure: name, number of arrays, the largest deviation from the reference and from the anchors,
        both as fractions of the tolerance [-].

    Raises
    ------
    ReferenceCheckError
        With one line a figure that has no reference or no anchor, or disagrees with either.
    """
    data, build = Path(data_directory), Path(build_directory)
    for name, dataset in figures.items():
        save(dataset, build / "arrays" / f"{name}.nc")
    rows: list[dict[str, Any]] = []
    failures: list[str] = []
    for name, dataset in figures.items():
        try:
            compared = compare(dataset, load(data / "reference" / f"{name}.nc"), name)
            anchors = load_anchors(data / "anchors" / f"{name}.yaml")
            rows.append(
                {
                    "figure": name,
                    "arrays": len(compared),
                    "reference deviation / tolerance": max(row.exceedance for row in compared),
                    "anchors": len(anchors),
                    "anchor deviation / tolerance": check_anchors(dataset, anchors, name),
                }
            )
        except (ReferenceCheckError, ArrayFileError) as error:
            failures.append(str(error))
    if failures:
        raise ReferenceCheckError("\n".join(failures))
    return rows


def as_markdown(rows: list[dict[str, Any]]) -> str:
    """Rows of :func:`check_figures` as a Markdown table."""
    names = list(rows[0])
    lines = ["| " + " | ".join(names) + " |", "|---" * len(names) + "|"]
    for row in rows:
        cells = (f"{value:.2g}" if isinstance(value, float) else str(value) for value in row.values())
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)
