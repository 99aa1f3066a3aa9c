"""What the text leaves open of the design of chapter 4: critical thickness of variants, tips on finer bases."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr

from compendium.datasets.transverse import describe
from facegear.floquet.models import replace_parameter
from facegear.geometry.drive import Drive
from facegear.geometry.kinematics import ContactPath
from facegear.geometry.skew_line import SkewLine
from facegear.maps.lobes import CriticalThickness, highest_lobes
from facegear.maps.parallel import in_processes
from facegear.mechanics.transverse import Transverse
from facegear.support.labelled import text, variable
from facegear.support.parameters import rad_per_s, rpm

# Tips are traced to 1e-5 in h/a; the speed of a maximum follows to the root of the accuracy of its height.
_RATIO, _TIP_SPEED = 2e-5, 0.5


class LongAddendum(Drive):
    """Drive whose pinion has the shaper's addendum of 1.25 modules, so that contact lines reach further."""

    @property
    def pinion_tip_radius(self) -> float:
        """Addendum circle of the pinion [m]."""
        return self.shaper_tip_radius


@dataclass(frozen=True)
class StillPath(ContactPath):
    """Path of the true contact points without their motion around the gear's axis."""

    @property
    def angular_travel(self) -> float:
        """Return 0: no travel about the gear's axis."""
        return 0.0


def variants(model: Transverse) -> dict[str, Transverse]:
    """List the model as the text has it, and with one thing at a time taken differently.

    Parameters
    ----------
    model : Transverse
        With one pinion.

    Returns
    -------
    dict of str to Transverse
    """
    drive, body, load = model.body.drive, model.body, model.load

    def touching(**options: Any) -> Transverse:
        return replace(model, contact=replace(model.contact, **options))

    long = LongAddendum(
        drive.pinion_teeth, drive.gear_teeth, drive.module, drive.pressure_angle, drive.shaft_angle
    )
    lighter = replace(load, mass=load.mass * (drive.base_radius / drive.pitch_radius) ** 2)
    return {
        "as in chapters 3 and 4": model,
        "pinion addendum 1.25 modules": replace(model, body=replace(body, drive=long)),
        "tooth pairs weighted equally": touching(sharing="mean"),
        "base radius in the nominal mass": replace(model, load=lighter),
        "no motion around the axis": touching(path=StillPath),
        "skew line": touching(path=SkewLine, sharing="mean"),
        "travel with the disk": touching(travel="with_disk"),
    }


def critical_of_variants(
    models: Mapping[str, Transverse],
    lowest_speed: float,
    highest_speeds: Sequence[float],
    thickness_range: tuple[float, float],
    jobs: int = -1,
) -> xr.Dataset:
    """Critical thickness ratio of several models.

    Parameters
    ----------
    models : mapping of str to Transverse
    lowest_speed : float
        Lowest operating speed [rad/s].
    highest_speeds : sequence of float
        Highest operating speeds [rad/s].
    thickness_range : tuple of float
        As for :func:`facegear.maps.lobes.highest_lobes`.
    jobs : int
        Number of processes, as joblib's ``n_jobs``; -1 for all processors.

    Returns
    -------
    xarray.Dataset
        ``critical_ratio`` over (variant, highest_rpm); names in the coordinate ``variant_name``.
    """
    work = ((model, lowest_speed, tuple(highest_speeds), thickness_range) for model in models.values())
    rows = in_processes(_critical, work, jobs)
    values = np.array([[each.thickness_ratio for each in row] for row in rows])
    highest_rpm = [round(float(rpm(highest)), 6) for highest in highest_speeds]
    return xr.Dataset(
        {
            "critical_ratio": variable(
                ("variant", "highest_rpm"), values, "Critical thickness ratio h/a", "1", atol=_RATIO
            )
        },
        coords={
            "variant": np.arange(len(models)),
            "variant_name": text("variant", list(models), "What is taken otherwise"),
            "highest_rpm": highest_rpm,
        },
        attrs={
            "parameters": ", ".join(
                f"{rpm(lowest_speed):.6g} to {highest:.6g} rpm" for highest in highest_rpm
            ),
        },
    )


def tips_in_windows(
    models: Mapping[str, Transverse],
    windows_rpm: Sequence[tuple[float, float]],
    tops: Sequence[float],
    jobs: int = -1,
) -> xr.Dataset:
    """Highest tip of a lobe in each of several windows of speed, for models that differ by their basis.

    Parameters
    ----------
    models : mapping of str to Transverse
        At any thickness.
    windows_rpm : sequence of (float, float)
        Lowest and highest speed of each window [rpm]; narrow ones make a fine basis affordable.
    tops : sequence of float
        Thickness ratio of each model from which its tips are looked for downwards, stable. The search is short if it
        is some 7 % above them (:func:`facegear.maps.lobes.highest_lobes`); it ends 20 % below.
    jobs : int
        Number of processes, as joblib's ``n_jobs``; -1 for all processors.

    Returns
    -------
    xarray.Dataset
        ``tip_ratio`` [-] and ``tip_speed`` [rpm] over (variant, window), ``circles`` and ``diameters`` over variant;
        names in the coordinate ``variant_name``.
    """
    ends = [tuple(float(end) for end in rad_per_s(np.array(window))) for window in windows_rpm]
    work = (
        (model, low, (high,), (0.8 * top, top))
        for model, top in zip(models.values(), tops, strict=True)
        for low, high in ends
    )
    found = in_processes(_critical, work, jobs)
    lobes = [critical.lobe for (critical,) in found]
    shape, both = (len(models), len(windows_rpm)), ("variant", "window")
    ratios = np.reshape([lobe.thickness_ratio for lobe in lobes], shape)
    speeds = np.reshape([float(rpm(lobe.speed)) for lobe in lobes], shape)
    circles = [model.body.nodal_circles for model in models.values()]
    diameters = [model.body.nodal_diameters for model in models.values()]
    return xr.Dataset(
        {
            "tip_ratio": variable(both, ratios, "h/a of the highest tip of a lobe", "1", atol=_RATIO),
            "tip_speed": variable(both, speeds, "Speed of the tip", "rpm", atol=_TIP_SPEED),
            "circles": variable("variant", circles, "Largest number of nodal circles", "1"),
            "diameters": variable("variant", diameters, "Largest number of nodal diameters", "1"),
        },
        coords={
            "variant": np.arange(len(models)),
            "window": np.arange(len(windows_rpm)),
            "variant_name": text("variant", list(models), "What is taken otherwise"),
        },
        attrs={
            "parameters": "windows "
            + ", ".join(f"{low:.6g} to {high:.6g} rpm" for low, high in windows_rpm)
            + f"; {describe(next(iter(models.values())))}",
        },
    )


def _critical(
    model: Transverse,
    lowest_speed: float,
    highest_speeds: tuple[float, ...],
    thickness_range: tuple[float, float],
) -> tuple[CriticalThickness, ...]:
    def model_at(thickness_ratio: float) -> Transverse:
        return replace_parameter(model, "thickness_ratio", thickness_ratio)

    return highest_lobes(model_at, lowest_speed, highest_speeds, thickness_range)
