"""Largest force of a forced response over speed, and its peaks between the speeds as arrays."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from facegear.support.labelled import text, variable


def largest_force(response: xr.Dataset, *ends: str) -> tuple[float, float]:
    """Find the largest size of a force, at a speed looked at or at a peak between them.

    Parameters
    ----------
    response : xarray.Dataset
        From :func:`facegear.maps.response_map.frequency_response`.
    *ends : str
        Which ends of the force count: "lowest", "highest" or both.

    Returns
    -------
    force, speed : float
        [N], [rad/s]; NaN if there is a response nowhere.
    """
    known = response.dropna("speed", subset=["force_highest"])
    speeds = np.append(np.repeat(known["speed"].values, known.sizes["load"]), response["peak_speed"].values)
    if not speeds.size:
        return math.nan, math.nan
    sizes = np.max(
        [
            np.abs(np.append(known[f"force_{end}"].values, response[f"peak_force_{end}"].values))
            for end in ends
        ],
        axis=0,
    )
    at = int(sizes.argmax())
    return float(sizes[at]), float(speeds[at])


def peak_arrays(
    responses: Sequence[xr.Dataset],
    forces: Mapping[str, str],
    loads: tuple[str, str],
    parameters: str,
    more: Mapping[str, Any] | None = None,
) -> xr.Dataset | None:
    """Put the peaks of responses into arrays, one response after the other; None if there is no peak.

    Parameters
    ----------
    responses : sequence of xarray.Dataset
        As for :func:`largest_force`.
    forces : mapping of str to str
        Names of the forces, and what they are.
    loads : tuple of str
        Name of the loads, and what one is.
    parameters : str
        Of the drive, for provenance.
    more : mapping, optional
        Further coordinates over ``peak``.

    Returns
    -------
    xarray.Dataset or None
        Over ``peak``: ``peak_speed`` [rad/s], the forces [N], number of the load from 0; label as a coordinate.
    """

    def joined(name: str) -> Any:
        return np.concatenate([response[f"peak_{name}"].values for response in responses])

    if not sum(response.sizes["peak"] for response in responses):
        return None
    speeds, (name, words) = joined("speed"), loads
    return xr.Dataset(
        {
            "peak_speed": variable("peak", speeds, "Speed of a peak", "rad/s", rtol=1e-4),
            **{
                key: variable("peak", joined(key), meaning, "N", rtol=1e-4, atol=1e-6)
                for key, meaning in forces.items()
            },
            name: variable(
                "peak", joined("load").astype(float), f"Number of the {words}, from 0", "1", atol=0.1
            ),
        },
        {
            "peak": np.arange(len(speeds)),
            **(more or {}),
            "label": text("peak", joined("label").tolist(), "Mode / harmonic of the mesh"),
        },
        {"parameters": parameters},
    )
