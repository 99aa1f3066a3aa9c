"""Forced response of a gearbox in torsion: the load of a tooth pair in words, and as arrays."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr

from facegear.drives.response_peaks import largest_force, peak_arrays
from facegear.support.labelled import variable
from facegear.support.parameters import rpm

AT_BORDERS = " Closer to a border of instability it can be larger, without a bound."
"""What is said where speeds without a steady response lie among those looked at."""

_STATISTICS = ("mean", "rms", "lowest", "highest")


class Parting(NamedTuple):
    """Where flanks would part: of `known` speeds with a steady response at `speeds`, and at `peaks` between them.

    The largest `pull` on flanks there is in N.
    """

    speeds: int
    known: int
    peaks: int
    pull: float


def parted(response: xr.Dataset, static: float = 0.0) -> Parting:
    """Count speeds, and peaks between them, at which flanks would part.

    Parameters
    ----------
    response : xarray.Dataset
        From :func:`facegear.maps.response_map.frequency_response`; it may have a response nowhere.
    static : float
        Force that presses the flanks and is none of the response [N].
    """
    known = response.dropna("speed", subset=["force_highest"])["force_lowest"].min("load").values + static
    peaks = response.get("peak_force_lowest")
    between = np.zeros(0) if peaks is None else peaks.values + static
    pull = float(max(0.0, -np.concatenate([known, between, [0.0]]).min()))
    return Parting(int((known < 0.0).sum()), known.size, int((between < 0.0).sum()), pull)


def in_words(response: xr.Dataset, static: float) -> str:
    """Say how large the force of a tooth pair becomes over speed, and where flanks would part.

    Parameters
    ----------
    response : xarray.Dataset
        As for :func:`parted`.
    static : float
        Whole force of a mesh at rest [N].

    Returns
    -------
    str
    """
    known = response.dropna("speed", subset=["force_highest"])
    count = known.sizes["speed"]
    if not count:
        return "In torsion it is unstable at all speeds looked at: there is no steady load of the teeth."
    peaks, (largest, speed) = response.sizes["peak"], largest_force(response, "highest")
    part = parted(response)
    rises = count < response.sizes["speed"] or response.attrs["at_borders"]
    between = (
        f", and of {peaks} {'peak' if peaks == 1 else 'peaks'} of resonances between them at {part.peaks}"
        if peaks
        else ""
    )
    return (
        f"In torsion, at {count} of {response.sizes['speed']} speeds where it is stable, and as long as flanks do not "
        f"part, a tooth pair bears up to {largest:.4g} N, at {rpm(speed):.4g} rpm: {largest / static:.3g} times the "
        f"whole static force of {static:.4g} N. Flanks would part at {part.speeds} of these {count} speeds{between}."
        f"{AT_BORDERS if rises else ''}"
    )


def response_table(response: xr.Dataset, parameters: str) -> xr.Dataset:
    """Put the forces of tooth pairs into arrays over speed.

    Parameters
    ----------
    response : xarray.Dataset
        As :func:`in_words`.
    parameters : str
        Of the drive, for provenance.

    Returns
    -------
    xarray.Dataset
        Over ``speed`` [rad/s] and ``pair``: ``force_mean``, ``force_rms``, ``force_lowest``, ``force_highest`` [N], NaN
        where it is unstable.
    """
    speed = response["speed"].values
    return xr.Dataset(
        {
            f"force_{name}": variable(
                ("speed", "pair"),
                response[f"force_{name}"].values,
                _meaning(name),
                "N",
                rtol=1e-6,
                atol=1e-6,
            )
            for name in _STATISTICS
        },
        {
            "speed": ("speed", speed, {"units": "rad/s", "long_name": "Speed of the face gear"}),
            "pair": np.arange(response.sizes["load"]),
        },
        {"parameters": parameters},
    )


def peaks_table(response: xr.Dataset, parameters: str) -> xr.Dataset | None:
    """Put the peaks of the response into arrays; None if there is none.

    Parameters
    ----------
    response, parameters
        As :func:`response_table`.

    Returns
    -------
    xarray.Dataset or None
        Over ``peak``: ``peak_speed`` [rad/s], ``force_rms``, ``force_lowest``, ``force_highest`` [N], ``pair``,
        numbered from 0; label as a coordinate.
    """
    forces = {f"force_{name}": _meaning(name) for name in _STATISTICS[1:]}
    return peak_arrays([response], forces, ("pair", "tooth pair"), parameters)


def _meaning(name: str) -> str:
    return f"Force of a tooth pair, {'rms of what varies' if name == 'rms' else name}"
