"""Tables beside the page of an assessment: models, values in tolerances, forced responses and their peaks."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
import xarray as xr

from facegear.drives.growth_words import corner
from facegear.drives.worst_case import WorstCase
from facegear.support.parameters import rpm


def model_columns(table: xr.Dataset) -> dict[str, list[object]]:
    """List models row by row, from :func:`facegear.drives.assessment_table.model_table`."""
    names = ("motion", "contact", "force", "teeth", *map(str, table.data_vars), "fastest", "unstable_rpm")
    in_table = {
        "largest_growth": ("largest_growth_per_s", table["largest_growth"].values),
        "fastest_speed": ("fastest_speed_rpm", rpm(table["fastest_speed"].values)),
    }
    columns = (in_table.get(name, (name, table[name].values)) for name in names)
    return {heading: values.tolist() for heading, values in columns}


def corner_columns(worst: Mapping[str, WorstCase]) -> dict[str, list[object]]:
    """List values in tolerances row by row: a tongue there, or that there is none."""
    headings = ("model", "corner", "label", "lower_rpm", "upper_rpm", "peak_rpm", "largest_growth_per_s")
    none = (math.nan,) * 3
    rows = [
        (name, corner(factors, case.factors), *one)
        for name, case in worst.items()
        for factors, found in case.points.items()
        for one in (
            [(t.label, *(float(rpm(x)) for x in (t.lower, t.upper, t.peak)), t.growth_rate) for t in found]
            or [("", *none, 0.0)]
        )
    ]
    return {heading: list(column) for heading, column in zip(headings, zip(*rows, strict=True), strict=True)}


def response_columns(table: xr.Dataset) -> dict[str, list[object]]:
    """List forced responses row by row: a model, a speed, a pinion; models without one are in the arrays alone."""
    forces = {
        name: str(table[name].attrs["units"]) for name in ("force_rms", "force_lowest", "force_highest")
    }
    basis = ("nodal_circles", "nodal_diameters", "settled")
    of_model = ("contact", "force", "teeth", *basis)
    # Whether the force has settled; whether the unstable speeds have is another question.
    headings = (
        *of_model[:-1],
        "force_settled",
        "speed_rpm",
        "pinion",
        *(_heading(n, u) for n, u in forces.items()),
    )
    rows = [
        (
            *(str(table[name].values[model]) for name in ("contact", "force", "teeth")),
            *(int(table[name].values[model]) for name in basis),
            float(rpm(table["speed"].values[at])),
            pinion + 1,
            *(float(table[name].values[model, at, pinion]) for name in forces),
        )
        for model in np.flatnonzero(table["none_because"].values == "").tolist()
        for at in range(table.sizes["speed"])
        for pinion in range(table.sizes["pinion"])
    ]
    return {heading: list(column) for heading, column in zip(headings, zip(*rows, strict=True), strict=True)}


def peak_columns(table: xr.Dataset) -> dict[str, list[object]]:
    """List the peaks of forced responses row by row."""
    names = {name: table[name].values.tolist() for name in ("contact", "force", "teeth", "label")}
    forces = ("force_rms", "force_lowest", "force_highest")
    return {
        **names,
        "speed_rpm": rpm(table["peak_speed"].values).tolist(),
        "pinion": [int(number) + 1 for number in table["pinion"].values],
        **{_heading(name, table[name].attrs["units"]): table[name].values.tolist() for name in forces},
    }


def _heading(name: str, unit: str) -> str:
    """Column of a force: rms is that of what varies, lowest and highest are without the static force."""
    whole = name.replace("rms", "rms_of_what_varies")
    return f"{whole}{'' if 'rms' in name else '_less_static'}_{unit}"
