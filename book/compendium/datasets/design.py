"""Arrays of the design figures of chapter 4, labelled, with units and the tolerances at which they are checked."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
import xarray as xr

from compendium.datasets.transverse import growth_map, tongue_sections
from facegear.design.body import BodyDesign
from facegear.design.teeth import root_stress, root_thickness, tooth_thickness
from facegear.floquet.models import replace_parameter
from facegear.geometry.drive import Drive
from facegear.geometry.proportions import DEDENDUM
from facegear.maps.lobes import Lobe
from facegear.maps.tracing import tongues
from facegear.mechanics.transverse import Transverse
from facegear.support.labelled import text, variable
from facegear.support.parameters import integer_at_least, rpm
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
