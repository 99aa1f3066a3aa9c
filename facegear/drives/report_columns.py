"""Columns of the tables that a report writes into files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from facegear.drives.report_rows import Row

Columns = dict[str, list[Any]]


def summary_columns(rows: Sequence[Row]) -> Columns:
    """Columns quantity, value, unit."""
    return {name: [getattr(row, name) for row in rows] for name in Row._fields}


def frequency_columns(modes: xr.Dataset) -> Columns:
    """Natural frequencies from :func:`facegear.mechanics.mode_shapes.plate_modes`, one row a mode."""
    circles, diameters = np.meshgrid(modes["circles"], modes["diameters"], indexing="ij")
    return {
        "nodal_circles": circles.ravel().tolist(),
        "nodal_diameters": diameters.ravel().tolist(),
        "frequency_Hz": modes["frequency"].values.ravel().tolist(),
    }


def tongue_columns(tables: Mapping[str, xr.Dataset]) -> Columns:
    """Tongues of several models, from :func:`tongue_table`, one row a tongue."""
    headings = {
        "lower": "lower_rpm",
        "upper": "upper_rpm",
        "peak": "peak_rpm",
        "largest_growth": "growth_per_s",
    }
    return {
        "model": _repeated(tables, "tongue"),
        **_stacked(tables, {"label": "tongue", **headings}),
    }


def window_columns(tables: Mapping[str, xr.Dataset]) -> Columns:
    """Safe windows of several models, from :func:`safe_windows`, one row a window."""
    return {
        "model": _repeated(tables, "window"),
        **_stacked(tables, {"lower": "lower_rpm", "upper": "upper_rpm"}),
    }


def change_columns(tables: Mapping[str, xr.Dataset]) -> Columns:
    """Effects of changes on several models, one row a change.

    From :func:`facegear.design.changes.effects_of_changes`.
    """
    headings = {
        "width_slope": "width_per_percent_rpm",
        "growth_slope": "growth_per_percent_per_s",
        "width_after": "width_after_ten_percent_rpm",
        "growth_after": "growth_after_ten_percent_per_s",
    }
    return {
        "model": _repeated(tables, "change"),
        **_stacked(tables, {"change_name": "change", **headings}),
    }


def basis_columns(table: xr.Dataset) -> Columns:
    """Bases of all cases, from :func:`basis_table`, one row a basis."""
    names = {
        "case_name": "model",
        "nodal_circles": "nodal_circles",
        "nodal_diameters": "nodal_diameters",
        "unstable_share": "unstable_share",
        "moved": "moved_from_the_basis_before",
    }
    return {heading: table[name].values.tolist() for name, heading in names.items()}


def _repeated(tables: Mapping[str, xr.Dataset], dimension: str) -> list[str]:
    return [name for name, table in tables.items() for _ in range(table.sizes[dimension])]


def _stacked(tables: Mapping[str, xr.Dataset], headings: Mapping[str, str]) -> Columns:
    return {
        heading: [value for table in tables.values() for value in table[name].values.tolist()]
        for name, heading in headings.items()
    }
