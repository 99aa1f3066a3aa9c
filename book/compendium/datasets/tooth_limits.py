"""Arrays of chapter 3 on contact ratios and on how far teeth reach, with units and tolerances."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np
import xarray as xr
from scipy.optimize import brentq

from compendium.datasets.meshing import describe
from facegear.geometry.drive import Drive
from facegear.support.labelled import variable
from facegear.symbolic import twins

_length = partial(variable, units="m", atol=1e-11)
_number = partial(variable, units="1", atol=1e-10)


def contact_ratios(drive: Drive, pinion_teeth: Sequence[int]) -> xr.Dataset:
    """Contact ratios against the number of pinion teeth at the gear ratio and module of a drive (Fig. 4.3).

    Parameters
    ----------
    drive : Drive
        Its gear ratio N2/N1 must be a whole number.
    pinion_teeth : sequence of int
        N1.

    Returns
    -------
    xarray.Dataset
        ``contact_ratio`` (Tregold) and ``geometric_contact_ratio`` over ``pinion_teeth``.

    Raises
    ------
    ValueError
        If the gear ratio is not a whole number.
    """
    if drive.gear_teeth % drive.pinion_teeth:
        raise ValueError(
            f"drive must have a whole gear ratio, got gear_teeth/pinion_teeth = {drive.gear_teeth}/{drive.pinion_teeth}"
        )
    ratio = drive.gear_teeth // drive.pinion_teeth
    family = [
        Drive(teeth, ratio * teeth, drive.module, drive.pressure_angle, drive.shaft_angle)
        for teeth in pinion_teeth
    ]
    return xr.Dataset(
        {
            "contact_ratio": _number(
                "pinion_teeth", [member.contact_ratio for member in family], "Contact ratio after Tregold"
            ),
            "geometric_contact_ratio": _number(
                "pinion_teeth",
                [member.geometric_contact_ratio for member in family],
                "Contact ratio of the sweep",
            ),
        },
        coords={"pinion_teeth": list(pinion_teeth)},
        attrs={"parameters": describe(drive)},
    )


def limits_against_shaft_angle(drive: Drive, shaft_angles_deg: Sequence[float]) -> xr.Dataset:
    """Limiting radii and contact ratios of a drive at other shaft angles.

    Parameters
    ----------
    drive : Drive
    shaft_angles_deg : sequence of float
        γ [degree].

    Returns
    -------
    xarray.Dataset
        ``inner_radius``, ``outer_radius`` [m], ``contact_ratio``, ``geometric_contact_ratio`` over
        ``shaft_angle_deg``.
    """
    family = [
        Drive(
            drive.pinion_teeth, drive.gear_teeth, drive.module, drive.pressure_angle, float(np.radians(angle))
        )
        for angle in shaft_angles_deg
    ]

    def column(name: str) -> list[float]:
        return [getattr(member, name) for member in family]

    return xr.Dataset(
        {
            "inner_radius": _length("shaft_angle_deg", column("inner_radius"), "R1, undercut"),
            "outer_radius": _length("shaft_angle_deg", column("outer_radius"), "R2, pointed"),
            "contact_ratio": _number(
                "shaft_angle_deg", column("contact_ratio"), "Contact ratio after Tregold"
            ),
            "geometric_contact_ratio": _number(
                "shaft_angle_deg", column("geometric_contact_ratio"), "Contact ratio of the sweep"
            ),
        },
        coords={"shaft_angle_deg": list(shaft_angles_deg)},
        attrs={"parameters": describe(drive)},
    )


def undercut_condition(drive: Drive, tangents: Sequence[float]) -> xr.Dataset:
    """Condition of undercutting over the tangent of the local pressure angle, and its real roots.

    Parameters
    ----------
    drive : Drive
    tangents : sequence of float
        t = tan(φs + θ0s + θs*).

    Returns
    -------
    xarray.Dataset
        ``value``, left minus right side of the condition, over ``tangent``; ``roots``, ascending, over ``root``.
    """
    gamma_m = np.pi - drive.shaft_angle
    p, q = drive.speed_ratio * np.sin(gamma_m), 1.0 - drive.speed_ratio * np.cos(gamma_m)
    tangent = np.asarray(tangents, dtype=float)
    value = twins.undercut_condition(tangent, p, q, drive.shaper_tip_roll)
    return xr.Dataset(
        {
            "value": _number("tangent", value, "Left minus right side"),
            "roots": _number("root", np.array(drive.undercut_roots), "Real roots"),
        },
        coords={"tangent": tangent},
        attrs={"parameters": describe(drive)},
    )


def top_land(drive: Drive, samples: int = 101) -> xr.Dataset:
    """Thickness of the tooth at its top along the face width, a little past the nominal outer end.

    Parameters
    ----------
    drive : Drive
    samples : int, optional
        Radii from R1 to R2.

    Returns
    -------
    xarray.Dataset
        ``thickness`` [m] over ``distance``, the distance of the generating section from the gear's axis [m];
        ``pointed_distance`` where it vanishes [m].
    """
    distance = np.linspace(drive.inner_radius, drive.outer_radius, samples)
    pointed = brentq(
        lambda r: float(drive.top_thickness(r)), drive.inner_radius, drive.outer_radius, xtol=1e-15
    )
    return xr.Dataset(
        {
            "thickness": _length("distance", drive.top_thickness(distance), "Thickness of the top land"),
            "pointed_distance": _length((), pointed, "Distance at which the true tooth is pointed"),
        },
        coords={"distance": distance},
        attrs={"parameters": describe(drive)},
    )
