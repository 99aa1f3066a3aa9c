"""Forced response of the disk as arrays: over speed, and its peaks, which lie between the speeds."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from facegear.drives.disk_response import DiskResponse
from facegear.drives.response_peaks import peak_arrays
from facegear.drives.variants import Variant
from facegear.support.labelled import text, variable
from facegear.support.types import FloatArray

_MEANINGS = {
    "force_rms": "Rms of what varies of the force of a mesh",
    "force_lowest": "Lowest force of a mesh less the static one",
    "force_highest": "Highest force of a mesh less the static one",
}


def response_table(found: Sequence[DiskResponse], parameters: str) -> xr.Dataset | None:
    """Put forced responses into arrays, those without one as NaN with the reason; None if no model has one.

    Parameters
    ----------
    found : sequence of DiskResponse
    parameters : str
        Of the drive, for provenance.

    Returns
    -------
    xarray.Dataset or None
        Over ``model``, ``speed`` [rad/s] and ``pinion``: ``force_rms``, ``force_lowest``, ``force_highest``, forces of
        a whole mesh along the normal without the static one [N]; over ``model``: ``transmission_error`` [m], its
        basis (``nodal_circles``, ``nodal_diameters``), ``moved`` and ``settled`` [-], NaN without a response.
    """
    computed = [each.data for each in found if each.data is not None]
    if not computed:
        return None
    first = computed[0]
    nothing = np.full((first.sizes["speed"], first.sizes["load"]), np.nan)

    def stacked(name: str) -> FloatArray:
        return np.stack([nothing if each.data is None else each.data[name].values for each in found])

    dims = ("model", "speed", "pinion")
    swings = [each.error for each in found]
    name = "Static transmission error from peak to peak, along the line of action"
    bodies = [None if each.data is None else each.variant.model.gear.body for each in found]
    bases = {
        key: [math.nan if body is None else float(getattr(body, key)) for body in bodies]
        for key in ("nodal_circles", "nodal_diameters")
    }
    settled = [math.nan if each.data is None else float(each.settled) for each in found]
    moved = [each.moved for each in found]
    return xr.Dataset(
        {
            **{
                key: variable(dims, stacked(key), words, "N", rtol=1e-6, atol=1e-6)
                for key, words in _MEANINGS.items()
            },
            "transmission_error": variable("model", swings, name, "m", rtol=1e-6, atol=1e-15),
            **{
                key: variable(
                    "model", values, f"{key.replace('_', ' ').capitalize()} of the basis", "1", atol=0.1
                )
                for key, values in bases.items()
            },
            "moved": variable(
                "model", moved, "Change of the largest force with two nodal diameters fewer", "1", rtol=1e-6
            ),
            "settled": variable("model", settled, "1 where that is at most 0.1", "1", atol=0.1),
        },
        {
            "model": np.arange(len(found)),
            "speed": ("speed", first.speed.values, {"units": "rad/s", "long_name": "Speed of the face gear"}),
            "pinion": np.arange(first.sizes["load"]),
            **_names("model", [each.variant for each in found]),
            "none_because": text("model", [each.reason for each in found], "Why there is none"),
        },
        {"parameters": parameters},
    )


def peaks_table(found: Sequence[DiskResponse], parameters: str) -> xr.Dataset | None:
    """Put the peaks of forced responses into arrays, model by model; None if there is none.

    Parameters
    ----------
    found : sequence of DiskResponse
    parameters : str
        Of the drive, for provenance.

    Returns
    -------
    xarray.Dataset or None
        Over ``peak``: ``peak_speed`` [rad/s], ``force_rms``, ``force_lowest``, ``force_highest``, as in
        :func:`response_table` [N], ``pinion``, numbered from 0; label and names of the model as coordinates.
    """
    computed = [(each.variant, each.data) for each in found if each.data is not None]
    variants = [variant for variant, data in computed for _ in range(data.sizes["peak"])]
    names, responses = _names("peak", variants), [data for _, data in computed]
    return peak_arrays(responses, _MEANINGS, ("pinion", "pinion"), parameters, names)


def _names(dimension: str, variants: Sequence[Variant]) -> dict[str, Any]:
    """Names of models as coordinates."""
    return {
        key: text(dimension, [getattr(each, key) for each in variants], words)
        for key, words in (("contact", "Contact"), ("force", "Driving force"), ("teeth", "Teeth"))
    }
