"""What the report on a drive of one's own shows, as labelled arrays with units and tolerances.

Every function takes a model, transverse or torsional, or what a drive file says
(:class:`facegear.drives.drive_file.DriveFile`), and returns what it found; nothing is written and nothing is drawn.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from facegear.design.body import Requirements
from facegear.design.envelope import critical_power
from facegear.design.teeth import root_thickness
from facegear.drives.basis import unstable_share
from facegear.drives.drive_file import DriveFile
from facegear.drives.verdict import Case, powered
from facegear.floquet.modal import modal_expansion
from facegear.floquet.models import Model, parameter_path
from facegear.maps.lobes import CriticalThickness, StableRangeError, UnstableTopError, highest_lobes
from facegear.maps.parallel import in_processes
from facegear.maps.stability_map import stability_map
from facegear.maps.tracing import Tongue
from facegear.mechanics.disk import reference_stiffness
from facegear.mechanics.edge_stiffness import DrivingForce, Following, complete_harmonics
from facegear.mechanics.plate import THICKNESS_RATIO_RANGE
from facegear.mechanics.spread_force import RIM_POINT, pitch_ratio
from facegear.mechanics.transverse import FaceGears, nominal_pinion_mass
from facegear.support.labelled import text, variable
from facegear.support.parameters import rad_per_s, rpm
from facegear.support.types import FloatArray

_growth = partial(variable, units="1/s", rtol=1e-6, atol=1e-3)
_speed = partial(variable, units="rpm", rtol=1e-7, atol=1e-4)
# A maximum is known to the square root of the accuracy of the values around it.
_peak = partial(variable, units="rpm", atol=0.1)


class Row(NamedTuple):
    """One number of a table."""

    quantity: str
    value: float
    unit: str


def geometry(file: DriveFile) -> tuple[Row, ...]:
    """Dimensions of teeth and body, contact ratios, masses, and what bearings are measured by.

    Parameters
    ----------
    file : DriveFile

    Returns
    -------
    tuple of Row
        In mm, degrees, kg and N/m.
    """
    drive, model = file.drive, file.transverse.gear
    body = model.body
    force = DrivingForce(file.requirements.power, file.requirements.pinion_speed).newtons(drive)
    return (
        Row("gear ratio N2/N1", drive.gear_ratio, "1"),
        Row("pitch radius of the pinion", 1e3 * drive.pitch_radius, "mm"),
        Row("inner radius of the teeth R1", 1e3 * drive.inner_radius, "mm"),
        Row("outer radius of the teeth R2", 1e3 * drive.outer_radius, "mm"),
        Row("face width L", 1e3 * drive.face_width, "mm"),
        Row("angular pitch of the face gear", math.degrees(drive.angular_pitch), "°"),
        *(
            Row(f"contact ratio, {name}", contact.ratio(drive), "1")
            for name, contact in file.contacts.items()
        ),
        Row("thickness of the body", 1e3 * body.thickness, "mm"),
        Row("mass of the body", body.mass, "kg"),
        Row("mass of a solid pinion", nominal_pinion_mass(body), "kg"),
        Row("stiffness of the disk that bearings are measured by", reference_stiffness(body), "N/m"),
        Row("bearing stiffness", model.bearing_stiffness, "N/m"),
        Row("pinion mass", model.pinion_mass, "kg"),
        Row(f"driving force of a {powered(file.transverse)}", force, "N"),
        Row("moment of that force at the rim over that of the power", 1.0 / pitch_ratio(drive), "1"),
        *(() if file.teeth is None else (Row("stiffness of a tooth pair", file.teeth.stiffness, "N/m"),)),
    )


def strength(file: DriveFile) -> tuple[Row, ...]:
    """Bending stress at the root of the pinion's tooth against what is allowed (4-20 to 4-22).

    Parameters
    ----------
    file : DriveFile

    Returns
    -------
    tuple of Row
        Root thickness [mm], stress, allowable stress [MPa], their ratio [-], safe if above 1.
    """
    stress, allowed = file.requirements.root_stresses(file.transverse.gear.body)
    return (
        Row("root thickness of the pinion's tooth", 1e3 * root_thickness(file.drive), "mm"),
        Row("largest stress at the root", 1e-6 * stress, "MPa"),
        Row("allowable stress", 1e-6 * allowed, "MPa"),
        Row("allowable over largest stress", allowed / stress, "1"),
    )


def flutter(model: FaceGears, duty: Requirements) -> tuple[Row, ...]:
    """Power at which the driving forces alone make the disk flutter (chapter 6), against the power of the drive.

    Parameters
    ----------
    model : FaceGears
        Drive in the basis of the report; of its pinions only their angles count, and which of them drive; of its force
        where it presses, at the rim if there is none.
    duty : Requirements
        Power of each pinion, its speed, range of speed.

    Returns
    -------
    tuple of Row
        Power of a pinion; critical power of each pinion, all pinions together, for forces that follow the rim and for
        those that keep their direction, the smallest of all gears and both ends of the speed range [kW]; the former
        over the power of a pinion [-]. Between two gears power is that of each mesh, and rows are named so. Without
        viscous damping of the disk any power flutters, and the critical one is 0.
    """
    body = model.gear.body
    damped = body.material.viscous_loss_factor > 0.0

    def smallest(following: Following) -> float:
        return min(
            critical_power(
                body,
                duty.pinion_speed,
                speed,
                following=following,
                harmonics=complete_harmonics(body),
                angles=driving.angles,
                senses=driving.senses,
                highest_power=duty.power,
                spread=model.gear.force.spread if model.gear.force else RIM_POINT,
            )
            for speed in duty.speeds
            for driving in model.driving
        )

    each = powered(model)
    follower, dead = (smallest("follower"), smallest("dead")) if damped else (0.0, 0.0)
    return (
        Row(f"power of a {each}", 1e-3 * duty.power, "kW"),
        Row(f"critical power of a {each}, disk alone, force follows the rim", 1e-3 * follower, "kW"),
        Row(f"critical power of a {each}, disk alone, force keeps its direction", 1e-3 * dead, "kW"),
        Row(f"critical power over power of a {each}, force follows the rim", follower / duty.power, "1"),
    )


def describe(file: DriveFile) -> str:
    """Parameters of a drive file as text, for the provenance of arrays."""
    # The contact ratio in use besides the field: None there is that of the drive.
    ratio = file.transverse.gear.contact_ratio
    return f"{file.name}: {file.transverse}, {file.torsional}, contact_ratio = {ratio:.10g}"


# --- tongues and what lies between them -------------------------------------------------------------------------


def tongue_table(found: Sequence[Tongue], parameters: str) -> xr.Dataset:
    """Tongues of a model.

    Parameters
    ----------
    found : sequence of Tongue
        From :func:`facegear.maps.tracing.tongues`.
    parameters : str
        For the provenance.

    Returns
    -------
    xarray.Dataset
        Over ``tongue``: ``lower``, ``upper``, ``peak`` [rpm], ``largest_growth`` [1/s]. Labels in the coordinate
        ``label``.
    """

    def column(name: str) -> FloatArray:
        return np.array([getattr(tongue, name) for tongue in found], dtype=float)

    return xr.Dataset(
        {
            "lower": _speed("tongue", rpm(column("lower")), "Lower border"),
            "upper": _speed("tongue", rpm(column("upper")), "Upper border"),
            "peak": _peak("tongue", rpm(column("peak")), "Speed of the largest growth"),
            "largest_growth": _growth("tongue", column("growth_rate"), "Largest growth rate of the tongue"),
        },
        coords={
            "tongue": np.arange(len(found)),
            "label": text("tongue", [tongue.label for tongue in found], "Label of the tongue"),
        },
        attrs={"parameters": parameters},
    )


def safe_windows(table: xr.Dataset, speeds: tuple[float, float]) -> xr.Dataset:
    """Intervals of speed between the tongues.

    Parameters
    ----------
    table : xarray.Dataset
        From :func:`tongue_table`.
    speeds : tuple of float
        Lowest and highest speed that the tongues were looked for in [rad/s].

    Returns
    -------
    xarray.Dataset
        Over ``window``, ascending: ``lower``, ``upper`` [rpm].
    """
    low, high = rpm(speeds[0]), rpm(speeds[1])
    starts = np.concatenate([[low], table["upper"].values])
    stops = np.concatenate([table["lower"].values, [high]])
    wide = stops - starts > 1e-9 * high
    return xr.Dataset(
        {
            "lower": _speed("window", starts[wide], "Lower end of the window"),
            "upper": _speed("window", stops[wide], "Upper end of the window"),
        },
        coords={"window": np.arange(int(wide.sum()))},
        attrs={"parameters": table.attrs["parameters"]},
    )


# --- charts over speed ------------------------------------------------------------------------------------------


def combinations(model: Model, found: Sequence[Tongue], speeds_rpm: ArrayLike, parameters: str) -> xr.Dataset:
    """Mesh frequency against natural frequencies of the mean system and their combinations.

    Parameters
    ----------
    model : Model
    found : sequence of Tongue
        Tongues of the model; their combinations are followed over speed.
    speeds_rpm : array_like, shape (S,)
        Speeds of the face gear [rpm].
    parameters : str
        For the provenance.

    Returns
    -------
    xarray.Dataset
        ``mesh_frequency`` (speed_rpm), ``natural_frequency`` (mode, speed_rpm), ``combination`` (label, speed_rpm)
        [Hz]: (ω_k ± ω_j)/(2πs), NaN where a mode does not oscillate; ``label`` is text.
    """
    speeds = np.asarray(speeds_rpm, dtype=float)
    systems = [model.system(float(speed)) for speed in rad_per_s(speeds)]
    means = [modal_expansion(system, 1).frequencies / (2 * math.pi) for system in systems]
    natural = np.full((max(mean.size for mean in means), speeds.size), np.nan)
    for i, mean in enumerate(means):
        natural[: mean.size, i] = mean
    kinds = {tongue.label: tongue.combination for tongue in found if tongue.combination.order > 0}
    combined = [
        (natural[c.j - 1] + (1 if c.kind == "sum" else -1) * natural[c.k - 1]) / c.order
        for c in kinds.values()
    ]
    frequency = partial(variable, units="Hz", rtol=1e-8, atol=1e-6)
    return xr.Dataset(
        {
            "mesh_frequency": frequency("speed_rpm", [1 / s.period for s in systems], "Mesh frequency"),
            "natural_frequency": frequency(
                ("mode", "speed_rpm"), natural, "Natural frequency of the mean system"
            ),
            "combination": frequency(
                ("label", "speed_rpm"),
                np.reshape(combined, (len(combined), speeds.size)),
                "Combination of natural frequencies over its order",
            ),
        },
        coords={
            "speed_rpm": speeds,
            "mode": np.arange(1, len(natural) + 1),
            "label": text("label", list(kinds), "Label of the combination"),
        },
        attrs={"parameters": parameters},
    )


def growth_map(
    model: Model, parameter: str, values: ArrayLike, speeds_rpm: ArrayLike, parameters: str, *, jobs: int = 1
) -> xr.Dataset:
    """Growth rates over speed and one parameter.

    Parameters
    ----------
    model : Model
    parameter : str
        As for :func:`facegear.maps.stability_map.stability_map`.
    values : array_like, shape (V,)
        Its values, in SI.
    speeds_rpm : array_like, shape (S,)
        Speeds of the face gear [rpm].
    parameters : str
        For the provenance.
    jobs : int
        Number of workers.

    Returns
    -------
    xarray.Dataset
        ``growth_rate`` (parameter, speed_rpm) [1/s], unstable where positive.
    """
    speeds = np.asarray(speeds_rpm, dtype=float)
    chart = stability_map(model, rad_per_s(speeds), parameter, values, jobs=jobs, progress=False)
    name = parameter_path(model, parameter)[-1]
    return xr.Dataset(
        {"growth_rate": _growth((name, "speed_rpm"), chart.values, "Growth rate ln(max|λ|)/T0")},
        coords={name: np.asarray(values, dtype=float), "speed_rpm": speeds},
        attrs={"parameters": f"{parameters}, swept = {parameter}"},
    )


# --- critical thickness -----------------------------------------------------------------------------------------


class ThicknessVerdict(NamedTuple):
    """Critical thickness of a body, or why there is none to be told.

    Attributes
    ----------
    critical : CriticalThickness or None
    reason : str
        Empty, or what the search says.
    """

    critical: CriticalThickness | None
    reason: str


def thickness_verdict(
    model: FaceGears, speeds: tuple[float, float], *, widest: float = 2.5, tolerance: float = 1e-4
) -> ThicknessVerdict:
    """Thickness ratio above which the body is stable in its whole speed range.

    μ, ζ, τ and the power stay as they are, so that the bearing gets stiffer with the body, as in section 4.7.

    Parameters
    ----------
    model : FaceGears
        With the driving force and in the basis of the report.
    speeds : tuple of float
        Lowest and highest speed [rad/s].
    widest : float
        It is looked for between 1/`widest` and `widest` times the model's thickness.
    tolerance : float
        Of h/a.

    Returns
    -------
    ThicknessVerdict
    """
    gear = model.gear
    here = gear.body.thickness_ratio
    lowest, highest = THICKNESS_RATIO_RANGE
    searched = (max(lowest, here / widest), min(highest, here * widest))

    def model_at(thickness_ratio: float) -> FaceGears:
        return model.with_gear(replace(gear, body=replace(gear.body, thickness_ratio=thickness_ratio)))

    low, high = speeds
    try:
        (critical,) = highest_lobes(model_at, low, [high], searched, tolerance)
    except UnstableTopError as error:
        speed = f"{rpm(error.tongue.peak):.4g} rpm"
        return ThicknessVerdict(None, f"still unstable at h/a = {error.thickness_ratio:.4g}, at {speed}")
    except StableRangeError as error:
        return ThicknessVerdict(None, f"stable down to h/a = {error.thickness_ratio:.4g}")
    except ArithmeticError as error:
        return ThicknessVerdict(None, f"the search lost its way: {error}")
    return ThicknessVerdict(critical, "")


def thickness_verdicts(
    models: Sequence[FaceGears], speeds: tuple[float, float], *, jobs: int = -1
) -> tuple[ThicknessVerdict, ...]:
    """Critical thickness of several models, in processes, in their order."""
    return tuple(in_processes(thickness_verdict, [(model, speeds) for model in models], jobs))


# --- bases ------------------------------------------------------------------------------------------------------


def basis_table(computed: Sequence[Case], parameters: str) -> xr.Dataset:
    """How the unstable part of the speeds moves from basis to basis.

    Parameters
    ----------
    computed : sequence of Case
    parameters : str
        For the provenance.

    Returns
    -------
    xarray.Dataset
        Over ``basis``: ``nodal_circles``, ``nodal_diameters``, ``unstable_share``, ``moved`` [-], NaN for the first
        basis of a case; name of the case in the coordinate ``case_name``.
    """
    rows = [(case, step) for case in computed for step in case.found.steps]
    share = partial(variable, "basis", units="1", rtol=1e-6, atol=1e-6)
    return xr.Dataset(
        {
            "nodal_circles": variable("basis", [s.nodal_circles for _, s in rows], "Nodal circles M", "1"),
            "nodal_diameters": variable(
                "basis", [s.nodal_diameters for _, s in rows], "Nodal diameters N", "1"
            ),
            "unstable_share": share(
                [unstable_share(s.tongues, case.found.speeds) for case, s in rows],
                "Unstable part of the speeds",
            ),
            "moved": share(
                [s.moved for _, s in rows], "Part in which this basis and the one before disagree"
            ),
        },
        coords={
            "basis": np.arange(len(rows)),
            "case_name": text("basis", [case.name for case, _ in rows], "Name of the case"),
        },
        attrs={"parameters": parameters},
    )


# --- columns for tables -----------------------------------------------------------------------------------------

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
