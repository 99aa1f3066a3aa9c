"""Arrays of chapter 6's figures of power: critical power of the disk, maps over power, safe envelope."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from compendium.datasets.inplane import described
from compendium.datasets.transverse import describe, labelled_map, map_family
from facegear.design.envelope import (
    PowerLimit,
    critical_power,
    disk_growth_rate,
    largest_power,
    mode_critical_powers,
)
from facegear.floquet.models import replace_parameter
from facegear.floquet.modes import mean_growth_rate
from facegear.mechanics.disk import disk_modes
from facegear.mechanics.edge_stiffness import DrivingForce, Following, edge_load_stiffness
from facegear.mechanics.inplane import EdgeLoadStress
from facegear.mechanics.plate import Body
from facegear.mechanics.transverse import Transverse
from facegear.support.labelled import text, variable
from facegear.support.parameters import finite_array, rad_per_s, rpm

_growth = partial(variable, units="1/s", rtol=1e-6, atol=1e-3)


def describe_power(model: Transverse) -> str:
    """Parameters of a model with a driving force as text, for the provenance of a figure."""
    force = driving_force_of(model)
    return (
        f"{describe(model)}, power_speed = {force.pinion_speed:.10g}, following = {force.following}, "
        f"stress_harmonics = {force.harmonics}"
    )


def driving_force_of(model: Transverse) -> DrivingForce:
    """Return the driving force of a model that must have one.

    Raises
    ------
    ValueError
        If it has none.
    """
    if model.force is None:
        raise ValueError("force of the model must be a DrivingForce, got None")
    return model.force


def stiffness_table(body: Body, speed: float, harmonics: int) -> xr.Dataset:
    """K_f of a tangential force of 1 N, follower and dead.

    Parameters
    ----------
    body : Body
    speed : float
        Ω2 [rad/s].
    harmonics : int
        Largest k.

    Returns
    -------
    xarray.Dataset
        ``follower`` and ``dead`` (row, column) [1/(s² N)]; names of the body's coordinates in ``row_name`` and
        ``column_name``.
    """
    stress = EdgeLoadStress(body, 1.0, speed, harmonics)
    follower, dead = edge_load_stiffness(stress), edge_load_stiffness(stress, "dead")
    scale = float(np.abs(follower).max())
    number = np.arange(len(follower))
    names = [f"({c.nodal_circles},{c.nodal_diameters},{c.wave})" for c in disk_modes(body)]
    return xr.Dataset(
        {
            "follower": variable(
                ("row", "column"), follower, "K_f of a follower force", "1/(s2 N)", atol=1e-10 * scale
            ),
            "dead": variable(("row", "column"), dead, "K_f of a dead force", "1/(s2 N)", atol=1e-10 * scale),
        },
        coords={
            "row": number,
            "row_name": text("row", names, "Coordinate: nodal circles, nodal diameters, wave"),
            "column": number,
            "column_name": text("column", names, "Coordinate: nodal circles, nodal diameters, wave"),
        },
        attrs={"parameters": described(body, speed=speed, harmonics=harmonics)},
    )


def disk_alone(
    body: Body,
    pinion_speed: float,
    powers: ArrayLike,
    speeds_rpm: Sequence[float],
    *,
    harmonics: int = 5,
    critical: Sequence[float] | None = None,
) -> xr.Dataset:
    """Growth rate of the disk alone against the power, and its critical power at several speeds.

    Parameters
    ----------
    body : Body
    pinion_speed : float
        Ω1 at the power [rad/s].
    powers : array_like, shape (P,)
        [W].
    speeds_rpm : sequence of float
        Speeds of the face gear [rpm].
    harmonics : int, optional
        Largest harmonic of the stress.
    critical : sequence of float, optional
        Critical powers at the speeds [W], if they are there already.

    Returns
    -------
    xarray.Dataset
        ``growth_rate`` and ``dead`` (speed_rpm, power) [1/s] under a follower and a dead force; ``critical``
        (speed_rpm) [W]; ``mode_critical`` (circles, diameters) [W], each mode's own to first order, infinite without
        nodal diameters.
    """
    levels = finite_array("powers", powers, "W")

    def line(speed: float, following: Following) -> list[float]:
        forces = [DrivingForce(power, pinion_speed, following, harmonics) for power in levels.tolist()]
        return [disk_growth_rate(body, force, float(rad_per_s(speed))) for force in forces]

    if critical is None:
        critical = [
            critical_power(body, pinion_speed, float(rad_per_s(v)), harmonics=harmonics) for v in speeds_rpm
        ]
    both = ("speed_rpm", "power")
    return xr.Dataset(
        {
            "growth_rate": _growth(
                both, [line(v, "follower") for v in speeds_rpm], "Growth rate, follower force"
            ),
            "dead": _growth(both, [line(v, "dead") for v in speeds_rpm], "Growth rate, dead force"),
            "critical": variable("speed_rpm", critical, "Critical power of the disk alone", "W", rtol=1e-8),
            "mode_critical": variable(
                ("circles", "diameters"),
                mode_critical_powers(body, pinion_speed),
                "Critical power of each mode, first order",
                "W",
                rtol=1e-9,
            ),
        },
        coords={
            "speed_rpm": list(speeds_rpm),
            "power": levels,
            "circles": np.arange(body.nodal_circles + 1),
            "diameters": np.arange(body.nodal_diameters + 1),
        },
        attrs={"parameters": f"{described(body, power_speed=pinion_speed)}, harmonics = {harmonics}"},
    )


def power_maps(
    model: Transverse,
    powers: Sequence[float],
    speeds_rpm: ArrayLike,
    values: ArrayLike,
    *,
    growth: Mapping[float, xr.DataArray] | None = None,
    jobs: int = -1,
) -> xr.Dataset:
    """Compute maps over speed and bearing stiffness at several powers (Figs 6.6, 6.7).

    Parameters
    ----------
    model : Transverse
        With a driving force.
    powers : sequence of float
        [W].
    speeds_rpm, values : array_like
        Speeds of the face gear [rpm] and bearing stiffnesses μ.
    growth : mapping of float to xarray.DataArray, optional
        Maps of :func:`facegear.maps.stability_map.stability_map` over these, by the power, if they are there already.
    jobs : int, optional
        Number of workers.

    Returns
    -------
    xarray.Dataset
        ``growth_rate`` (power, stiffness, speed_rpm) [1/s].
    """
    known = {
        power: labelled_map(model, chart, speeds_rpm, "stiffness") for power, chart in (growth or {}).items()
    }
    family = map_family(model, "power", powers, speeds_rpm, "stiffness", values, known=known, jobs=jobs)
    return family.assign_attrs(parameters=f"{describe_power(model)}, swept = stiffness and power")


def mean_growth_map(model: Transverse, speeds_rpm: ArrayLike, values: ArrayLike) -> xr.Dataset:
    """Growth rates with the motion of the contact averaged out: what is not parametric.

    Parameters
    ----------
    model : Transverse
        With frozen rate.
    speeds_rpm, values : array_like
        Speeds of the face gear [rpm] and bearing stiffnesses μ.

    Returns
    -------
    xarray.Dataset
        ``growth_rate`` (stiffness, speed_rpm) [1/s] of the mean system: the largest real part of its eigenvalues.

    Raises
    ------
    ValueError
        If the model has the total rate, whose mean is not that of a load at rest.
    """
    if model.contact.rate != "frozen":
        raise ValueError(f"model must have the rate 'frozen', got {model.contact.rate!r}")
    speeds, heights = finite_array("speeds_rpm", speeds_rpm, "rpm"), finite_array("values", values)
    models = [replace_parameter(model, "stiffness", value) for value in heights.tolist()]
    rows = [[mean_growth_rate(one.system(speed)) for speed in rad_per_s(speeds).tolist()] for one in models]
    return xr.Dataset(
        {"growth_rate": _growth(("stiffness", "speed_rpm"), rows, "Growth rate of the mean system")},
        coords={"stiffness": heights, "speed_rpm": speeds},
        attrs={
            "parameters": f"{describe_power(model)}, power = {driving_force_of(model).power}, mean system, "
            "swept = stiffness"
        },
    )


def power_envelope(
    models: Mapping[str, Transverse],
    parameter: str,
    values: ArrayLike,
    speeds_rpm: tuple[float, float],
    known: Mapping[tuple[str, float], PowerLimit] | None = None,
) -> xr.Dataset:
    """Largest power at which a range of speeds is stable, against one parameter, for several variants of a drive.

    Parameters
    ----------
    models : mapping of str to Transverse
        Name of each variant, and the variant with a driving force.
    parameter : str
        Swept parameter.
    values : array_like, shape (V,)
        Its values.
    speeds_rpm : tuple of float
        Lowest and highest speed of the face gear [rpm].
    known : mapping of (str, float) to PowerLimit, optional
        Limits that are there already, by variant and value.

    Returns
    -------
    xarray.Dataset
        ``power`` [W] and ``speed`` [rpm] (variant, parameter), the largest power and where stability is lost first;
        infinite and NaN where no limit was found, 0 where the range is not stable without power either. Names of the
        instabilities in the coordinate ``label``, of the variants in ``variant_name``.
    """
    low, high = (float(rad_per_s(v)) for v in speeds_rpm)
    there = known or {}
    found = [
        [
            there[name, value]
            if (name, value) in there
            else largest_power(replace_parameter(model, parameter, value), (low, high))
            for value in finite_array("values", values).tolist()
        ]
        for name, model in models.items()
    ]
    both = ("variant", parameter)
    powers = [[limit.power for limit in row] for row in found]
    return xr.Dataset(
        {
            # The search stops at a thousandth of the power.
            "power": variable(both, powers, "Largest stable power", "W", rtol=3e-3),
            "speed": variable(
                both, [[rpm(limit.speed) for limit in row] for row in found], "Speed there", "rpm", 0.02
            ),
        },
        coords={
            "variant": np.arange(len(models)),
            "variant_name": text("variant", list(models), "Variant"),
            parameter: finite_array("values", values),
            "label": text(both, [[limit.label for limit in row] for row in found], "What is lost first"),
        },
        attrs={
            "parameters": "; ".join(f"{name}: {describe_power(model)}" for name, model in models.items())
            + f"; speeds_rpm = {speeds_rpm}, swept = {parameter}",
        },
    )
