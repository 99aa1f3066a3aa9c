"""Arrays of the design figures of chapter 4, labelled, with units and the tolerances at which they are checked."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr

from compendium.datasets.transverse import describe, growth_map, tongue_sections
from facegear.design.body import BodyDesign
from facegear.design.teeth import root_stress, root_thickness, tooth_thickness
from facegear.floquet.models import replace_parameter
from facegear.geometry.drive import Drive
from facegear.geometry.kinematics import ContactPath
from facegear.geometry.proportions import DEDENDUM
from facegear.geometry.skew_line import SkewLine
from facegear.maps.lobes import CriticalThickness, Lobe, highest_lobes
from facegear.maps.parallel import in_processes
from facegear.maps.tracing import tongues
from facegear.mechanics.transverse import Transverse
from facegear.support.labelled import text, variable
from facegear.support.parameters import integer_at_least, rad_per_s, rpm
from facegear.support.types import FloatArray

# Tips are traced to 1e-5 in h/a; the speed of a maximum follows to the root of the accuracy of its height.
_RATIO, _TIP_SPEED = 2e-5, 0.5

ROOTS = ("chord at dedendum circle", "chord at base circle", "half a pitch", "root of the rack")
"""Readings of the root thickness W of (4-20)."""


def root_thicknesses(drive: Drive) -> dict[str, float]:
    """Root thickness W of the pinion's tooth under several readings of the text's sketch.

    Parameters
    ----------
    drive : Drive

    Returns
    -------
    dict of str to float
        Names of :data:`ROOTS` to W [m]. "chord at base circle": where the involute begins (at the dedendum circle if
        that lies outside the base circle). "half a pitch": the thickness on the pitch circle kept down to the root.
        "root of the rack": flanks straight at the pressure angle.
    """
    widest = max(drive.base_radius, drive.dedendum_radius)
    half_pitch = math.pi * drive.module / 2
    values = (
        root_thickness(drive),
        tooth_thickness(drive, widest),
        half_pitch,
        half_pitch + 2 * DEDENDUM * drive.module * math.tan(drive.pressure_angle),
    )
    return dict(zip(ROOTS, values, strict=True))


def family_of_teeth(drives: Sequence[Drive], power: float, pinion_speed: float) -> xr.Dataset:
    """Face width and root stress of a family of drives (Figs 4.7, 4.8, 4.11, 4.12).

    Parameters
    ----------
    drives : sequence of Drive
        Different numbers of pinion teeth.
    power : float
        P [W].
    pinion_speed : float
        Ω1 [rad/s].

    Returns
    -------
    xarray.Dataset
        Over ``pinion_teeth``: ``face_width`` [m]; over (root, pinion_teeth): ``root_stress`` [Pa], ``root`` numbering
        :data:`ROOTS`, which the coordinate ``root_name`` has.
    """
    stress = [
        [root_stress(drive, power, pinion_speed, root_thicknesses(drive)[name]) for drive in drives]
        for name in ROOTS
    ]
    return xr.Dataset(
        {
            "face_width": variable(
                "pinion_teeth", [drive.face_width for drive in drives], "Face width", "m", atol=1e-11
            ),
            "root_stress": variable(
                ("root", "pinion_teeth"), stress, "Largest bending stress at the root", "Pa", rtol=1e-9
            ),
        },
        coords={
            "pinion_teeth": [drive.pinion_teeth for drive in drives],
            "root": np.arange(len(ROOTS)),
            "root_name": text("root", ROOTS, "How the root thickness is read"),
        },
        attrs={
            "parameters": f"power_W = {power:.10g}, pinion_speed = {pinion_speed:.10g}, "
            f"modules_mm = {', '.join(f'{1e3 * drive.module:.8g}' for drive in drives)}",
        },
    )


def family_of_bodies(designs: Sequence[Sequence[BodyDesign]], highest_rpm: Sequence[float]) -> xr.Dataset:
    """Critical thicknesses and weights of a family of drives (Figs 4.10, 4.14).

    Parameters
    ----------
    designs : sequence of sequence of BodyDesign
        From :func:`facegear.design.body.design_family`.
    highest_rpm : sequence of float
        Highest operating speeds of the face gear [rpm].

    Returns
    -------
    xarray.Dataset
        Over (highest_rpm, pinion_teeth): ``critical_ratio`` [-], ``critical_thickness`` [m], ``nominal_mass`` [kg],
        ``tip_speed`` [rpm]; over pinion_teeth: ``root_stress`` [Pa]. Labels of the deciding lobes in the coordinate
        ``label``.
    """
    both = ("highest_rpm", "pinion_teeth")
    columns = list(zip(*designs, strict=True))

    def table(get: Callable[[BodyDesign], float]) -> FloatArray:
        return np.array([[get(design) for design in column] for column in columns])

    return xr.Dataset(
        {
            "critical_ratio": variable(
                both,
                table(lambda design: design.critical.thickness_ratio),
                "Critical thickness ratio h/a",
                "1",
                atol=_RATIO,
            ),
            "critical_thickness": variable(
                both,
                table(lambda design: design.body.thickness),
                "Critical thickness",
                "m",
                atol=0.3 * _RATIO,
            ),
            "nominal_mass": variable(
                both, table(lambda design: design.body.mass), "Nominal mass of the body", "kg", rtol=5e-4
            ),
            "tip_speed": variable(
                both,
                table(lambda design: float(rpm(design.critical.lobe.speed))),
                "Speed of the deciding lobe's tip",
                "rpm",
                atol=_TIP_SPEED,
            ),
            "root_stress": variable(
                "pinion_teeth", [row[0].root_stress for row in designs], "Root stress", "Pa", rtol=1e-9
            ),
        },
        coords={
            "highest_rpm": list(highest_rpm),
            "pinion_teeth": [row[0].body.drive.pinion_teeth for row in designs],
            "label": text(
                both,
                [[design.critical.lobe.label for design in column] for column in columns],
                "Label of the deciding lobe",
            ),
        },
        attrs={
            "parameters": f"modules_mm = {', '.join(f'{1e3 * row[0].body.drive.module:.8g}' for row in designs)}",
        },
    )


def with_tips(chart: xr.Dataset, lobes: Sequence[Lobe]) -> xr.Dataset:
    """Add the traced tips of lobes to a chart over speed and thickness ratio.

    Parameters
    ----------
    chart : xarray.Dataset
    lobes : sequence of Lobe

    Returns
    -------
    xarray.Dataset
        The chart with ``tip_ratio`` [-] and ``tip_speed`` [rpm] over ``tip``; labels in the coordinate
        ``tip_label``.
    """
    return chart.assign(
        tip_ratio=variable(
            "tip", [lobe.thickness_ratio for lobe in lobes], "h/a of the tip of a lobe", "1", atol=_RATIO
        ),
        tip_speed=variable(
            "tip", [float(rpm(lobe.speed)) for lobe in lobes], "Speed of the tip", "rpm", atol=_TIP_SPEED
        ),
    ).assign_coords(tip_label=text("tip", [lobe.label for lobe in lobes], "Label of the lobe"))


def thickness_figure(
    model: Transverse,
    lobes: Sequence[Lobe],
    *,
    thickness_range: tuple[float, float] = (0.025, 0.045),
    speeds_rpm: tuple[float, float] = (50.0, 1000.0),
    cells: int = 200,
    sections: int = 6,
    traced_rpm: float = 100.0,
    jobs: int = -1,
) -> xr.Dataset:
    """Map of growth rates over speed and thickness ratio, with traced tongues and tips (one of Figs 4.9, 4.13).

    Parameters
    ----------
    model : Transverse
    lobes : sequence of Lobe
        Tips to keep with the map.
    thickness_range : tuple of float
        Ends of the axis of h/a; the map has `cells` values, the lowest of them above its start.
    speeds_rpm : tuple of float
        Ends of the axis of speed [rpm]; `cells` values, the lowest of them above its start.
    cells : int, optional
        Values of the thickness ratio, and speeds.
    sections : int, optional
        Thickness ratios, evenly spread from end to end, at which tongues are traced.
    traced_rpm : float, optional
        Lowest speed at which tongues are traced [rpm].
    jobs : int, optional
        Number of processes, as joblib's ``n_jobs``; -1 for all processors.

    Returns
    -------
    xarray.Dataset
        As :func:`compendium.datasets.transverse.growth_map` and
        :func:`compendium.datasets.transverse.tongue_sections`, and tips as from :func:`with_tips`.
    """
    cells = integer_at_least("cells", cells, 2)
    share = np.arange(1, cells + 1) / cells
    (slow, fast), (thin, thick) = speeds_rpm, thickness_range
    ratios = thin + (thick - thin) * share
    chart = growth_map(model, slow + (fast - slow) * share, "thickness_ratio", ratios, jobs=jobs)
    places = np.linspace(thin, thick, integer_at_least("sections", sections, 2))
    traced = tongue_sections(model, "thickness_ratio", places, (traced_rpm, fast), jobs=jobs)
    return with_tips(chart.assign(traced.data_vars), lobes)


def lobe_near_tip(
    model: Transverse, lobe: Lobe, speeds: tuple[float, float], depths: Sequence[float]
) -> xr.Dataset:
    """Width of a lobe at some distances below its tip.

    Parameters
    ----------
    model : Transverse
    lobe : Lobe
    speeds : tuple of float
        Speeds between which no other lobe lies there [rad/s].
    depths : sequence of float
        Distances below the tip, relative to its thickness ratio, ascending, in (0, 1).

    Returns
    -------
    xarray.Dataset
        ``width`` [rpm] of all tongues together and ``largest_growth`` [1/s] over ``thickness_ratio``.
    """
    ratios = lobe.thickness_ratio * (1.0 - np.asarray(depths, dtype=float))
    found = [tongues(replace_parameter(model, "thickness_ratio", float(x)), speeds) for x in ratios]
    widths = [float(rpm(sum(tongue.width for tongue in row))) for row in found]
    growth = [max((tongue.growth_rate for tongue in row), default=0.0) for row in found]
    # The ratios hang on the traced tip, whose tolerance of 1e-5 is a part of the smallest depths.
    return xr.Dataset(
        {
            "width": variable("depth", widths, "Width of the lobe", "rpm", rtol=0.02, atol=0.02),
            "largest_growth": variable("depth", growth, "Largest growth rate", "1/s", rtol=0.02, atol=0.02),
        },
        coords={"depth": np.asarray(depths, dtype=float)},
        attrs={"parameters": f"label = {lobe.label}, speeds = {speeds[0]:.8g} to {speeds[1]:.8g} rad/s"},
    )


# --- what the text leaves open ------------------------------------------------------------------------------------


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
