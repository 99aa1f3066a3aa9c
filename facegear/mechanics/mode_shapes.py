"""Modes of the disk at rest as labelled arrays: radial mode functions and natural frequencies."""

from __future__ import annotations

import numpy as np
import xarray as xr

from facegear.mechanics.plate import Body
from facegear.support.labelled import variable
from facegear.support.parameters import integer_at_least


def plate_modes(body: Body, samples: int = 61) -> xr.Dataset:
    """Radial mode functions and natural frequencies of the disk at rest.

    Parameters
    ----------
    body : Body
    samples : int, optional
        Radii from bore to rim.

    Returns
    -------
    xarray.Dataset
        ``mode`` (circles, diameters, radius), R_mn times the outer radius [-]; ``frequency`` (circles, diameters)
        [Hz]; ``radius`` over the outer radius.
    """
    samples = integer_at_least("samples", samples, 2)
    x = np.linspace(body.bore_ratio, 1.0, samples)
    values = np.stack([modes(x) for modes in body.modes], axis=1)
    both = ("circles", "diameters")
    return xr.Dataset(
        {
            "mode": variable((*both, "radius"), values, "Radial mode function times a", "1", atol=1e-9),
            "frequency": variable(
                both, body.natural_frequencies_hz(), "Natural frequency at rest", "Hz", rtol=1e-10
            ),
        },
        coords={
            "circles": np.arange(body.nodal_circles + 1),
            "diameters": np.arange(body.nodal_diameters + 1),
            "radius": x,
        },
        attrs={
            "parameters": f"bore_ratio = {body.bore_ratio:.10g}, thickness_ratio = {body.thickness_ratio:.10g}"
        },
    )
