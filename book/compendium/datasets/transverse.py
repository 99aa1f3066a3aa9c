"""Arrays of chapter 4's figures, labelled, with units and the tolerances at which they are checked.

Maps hold growth rates, not black and white. Where two multipliers meet inside the stable region the largest modulus
has a corner and its rounding errors grow to their square root, some 1e-7; over a mesh period of half a millisecond
that shows as 1e-4 of a growth rate per second.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from facegear.floquet.band_speeds import band_speeds
from facegear.floquet.modal import modal_expansion
from facegear.floquet.models import replace_parameter
from facegear.maps.stability_map import stability_map
from facegear.maps.tracing import Tongue, borders, tongues
from facegear.mechanics.disk import reference_stiffness
from facegear.mechanics.transverse import Transverse
from facegear.support.labelled import filled_labels, filled_rows, text, variable
from facegear.support.parameters import integer_at_least, rad_per_s, rpm

_growth = partial(variable, units="1/s", rtol=1e-6, atol=1e-3)
_speed = partial(variable, units="rpm", rtol=1e-7, atol=1e-4)


def describe(model: Transverse) -> str:
    """Parameters of a model as text, for the provenance of a figure."""
    body, load = model.body, model.load
    angles = ", ".join(f"{np.degrees(angle):g}" for angle in model.pinion_angles)
    values = {
        "pinion_teeth": body.drive.pinion_teeth,
        "gear_teeth": body.drive.gear_teeth,
        "module_mm": round(body.drive.module * 1e3, 9),
        "thickness_ratio": body.thickness_ratio,
        "bore_radius_mm": round(body.bore_radius * 1e3, 9),
        "nodal_circles": body.nodal_circles,
        "nodal_diameters": body.nodal_diameters,
        "stiffness": load.stiffness,
        "damping_s": load.damping,
        "mass": load.mass,
        "contact_ratio": model.contact_ratio,
    }
    numbers = ", ".join(f"{name} = {value:.10g}" for name, value in values.items())
    return f"{numbers}, pinion_angles_deg = {angles}, rate = {model.contact.rate}, travel = {model.contact.travel}"


def growth_map(
    model: Transverse, speeds_rpm: ArrayLike, parameter: str, values: ArrayLike, *, jobs: int = -1
) -> xr.Dataset:
    """Growth rates over speed and one parameter of the mesh load (Figs 4.4, 4.5).

    Parameters
    ----------
    model : Transverse
    speeds_rpm : array_like
        Speeds of the face gear [rpm], ascending.
    parameter : {"stiffness", "damping", "mass"}
        Swept parameter.
    values : array_like
        Its values.
    jobs : int, optional
        Number of processes, as joblib's ``n_jobs``; -1 for all processors.

    Returns
    -------
    xarray.Dataset
        ``growth_rate`` (parameter, speed_rpm) [1/s], unstable where positive.
    """
    speeds = np.asarray(speeds_rpm, dtype=float)
    chart = stability_map(model, rad_per_s(speeds), parameter, values, jobs=jobs, progress=False)
    return labelled_map(model, chart, speeds, parameter)


def labelled_map(model: Transverse, chart: xr.DataArray, speeds_rpm: ArrayLike, parameter: str) -> xr.Dataset:
    """Give a map that is there the labels of :func:`growth_map`.

    Parameters
    ----------
    model : Transverse
    chart : xarray.DataArray
        From :func:`facegear.maps.stability_map.stability_map`, of this model over these speeds and this parameter.
    speeds_rpm : array_like
        Its speeds of the face gear [rpm].
    parameter : str
    """
    return xr.Dataset(
        {"growth_rate": _growth((parameter, "speed_rpm"), chart.values, "Growth rate ln(max|λ|)/T0")},
        coords={
            parameter: np.asarray(chart[parameter].values, dtype=float),
            "speed_rpm": np.asarray(speeds_rpm, dtype=float),
        },
        attrs={"parameters": f"{describe(model)}, swept = {parameter}"},
    )


def map_family(
    model: Transverse,
    name: str,
    members: Sequence[float],
    speeds_rpm: ArrayLike,
    parameter: str,
    values: ArrayLike,
    *,
    known: Mapping[float, xr.Dataset] | None = None,
    jobs: int = -1,
) -> xr.Dataset:
    """Compute a map for each of several values of a further parameter.

    Parameters
    ----------
    model : Transverse
    name : str
        The further parameter, a field of the mesh load.
    members : sequence of float
        Its values.
    speeds_rpm, parameter, values, jobs
        As for :func:`growth_map`.
    known : mapping of float to xarray.Dataset, optional
        Maps that are there already, by their value of the further parameter.

    Returns
    -------
    xarray.Dataset
        ``growth_rate`` (name, parameter, speed_rpm) [1/s].

    Raises
    ------
    ValueError
        If a map that is there has other axes.
    """
    there = known or {}
    maps = [
        there[value]
        if value in there
        else growth_map(replace_parameter(model, name, value), speeds_rpm, parameter, values, jobs=jobs)
        for value in members
    ]
    axes = {parameter: np.asarray(values, dtype=float), "speed_rpm": np.asarray(speeds_rpm, dtype=float)}
    for chart in maps:
        for axis, expected in axes.items():
            if not np.array_equal(chart[axis].values, expected):
                raise ValueError(f"known must hold maps over the same {axis} as the others")
    stacked = np.stack([chart["growth_rate"].values for chart in maps])
    return xr.Dataset(
        {"growth_rate": _growth((name, parameter, "speed_rpm"), stacked, "Growth rate ln(max|λ|)/T0")},
        coords={name: list(members), **axes},
        attrs={"parameters": f"{describe(model)}, swept = {parameter} and {name}"},
    )


def resonances_of_bearing(
    model: Transverse, values: ArrayLike, speeds_rpm: tuple[float, float]
) -> xr.Dataset:
    """Tongues at some bearing stiffnesses, with the frequencies that combine and the one of pinion and bearing.

    Parameters
    ----------
    model : Transverse
    values : array_like
        Bearing stiffnesses μ.
    speeds_rpm : tuple of float
        Lowest and highest speed of the face gear [rpm].

    Returns
    -------
    xarray.Dataset
        Over ``tongue``: ``stiffness``; ``peak`` [rpm]; ``first`` and ``second``, the natural frequencies ω_k and ω_j of
        the mean system there [Hz]; ``sign``, 1 for a sum and −1 for a difference; ``bearing``, √(k_b/m_p) [Hz].
    """
    low, high = (float(speed) for speed in rad_per_s(np.asarray(speeds_rpm)))
    rows = []
    for value in np.asarray(values, dtype=float).tolist():
        softened = replace_parameter(model, "stiffness", value)
        bearing = math.sqrt(softened.bearing_stiffness / softened.pinion_mass)
        for tongue in tongues(softened, (low, high)):
            named = tongue.combination
            modes = modal_expansion(softened.system(tongue.peak), 1).frequencies
            pair = modes[named.k - 1], modes[named.j - 1]
            hertz = [float(omega) / (2.0 * math.pi) for omega in (*pair, bearing)]
            rows.append((value, float(rpm(tongue.peak)), *hertz, 1.0 if named.kind == "sum" else -1.0))
    stiffness, peak, first, second, own, sign = np.array(rows).reshape(-1, 6).T
    number = partial(variable, "tongue")
    return xr.Dataset(
        {
            "stiffness": number(stiffness, "Bearing stiffness", "1"),
            "peak": number(peak, "Speed of the largest growth", "rpm", atol=0.1),
            "first": number(
                first, "Lower natural frequency of the mean system that combines", "Hz", atol=0.01
            ),
            "second": number(second, "Higher one", "Hz", atol=0.01),
            "sign": number(sign, "1 for a sum, -1 for a difference", "1"),
            "bearing": number(own, "Frequency of the pinion on its bearing", "Hz", rtol=1e-9),
        },
        coords={"tongue": np.arange(len(rows))},
        attrs={"parameters": f"{describe(model)}, swept = stiffness"},
    )


def tongue_sections(
    model: Transverse,
    parameter: str,
    values: ArrayLike,
    speeds_rpm: tuple[float, float],
    *,
    jobs: int = -1,
) -> xr.Dataset:
    """Traced borders of all tongues at some values of a parameter.

    Parameters
    ----------
    model : Transverse
    parameter : str
        Swept parameter.
    values : array_like, shape (V,)
        Its values.
    speeds_rpm : tuple of float
        Lowest and highest speed of the face gear [rpm].
    jobs : int, optional
        Number of processes, as joblib's ``n_jobs``; -1 for all processors.

    Returns
    -------
    xarray.Dataset
        ``lower``, ``upper``, ``peak`` [rpm] and ``largest_growth`` [1/s] over (section, tongue), NaN beyond the
        tongues of a section; coordinate ``section`` holds `values`. Labels of the tongues in the
        coordinate ``label``, empty there.
    """
    low, high = rad_per_s(speeds_rpm[0]), rad_per_s(speeds_rpm[1])
    sections = borders(model, parameter, values, (low, high), jobs=jobs)
    found = [section.tongues for section in sections]
    return tongue_table(found, np.asarray(values, dtype=float), f"{describe(model)}, swept = {parameter}")


def stability_figure(
    model: Transverse,
    parameter: str,
    highest: float,
    *,
    cells: int = 200,
    sections: int = 7,
    traced_rpm: float = 50.0,
    highest_rpm: float = 1000.0,
    jobs: int = -1,
) -> xr.Dataset:
    """Map of growth rates together with traced borders of its tongues (one of Figs 4.4, 4.5).

    Parameters
    ----------
    model : Transverse
    parameter : {"stiffness", "damping", "mass"}
        Swept parameter.
    highest : float
        End of its axis; the axis has `cells` values, none of them 0.
    cells : int, optional
        Values of the parameter, and speeds.
    sections : int, optional
        Values of the parameter, evenly spread over the axis, at which borders are traced.
    traced_rpm : float, optional
        Lowest speed of the face gear at which borders are traced [rpm]; lower down there are ever more and ever
        narrower tongues.
    highest_rpm : float, optional
        Highest speed [rpm].
    jobs : int, optional
        Number of processes, as joblib's ``n_jobs``; -1 for all processors.

    Returns
    -------
    xarray.Dataset
        As :func:`growth_map` and :func:`tongue_sections`.
    """
    cells = integer_at_least("cells", cells, 2)
    share = np.arange(1, cells + 1) / cells
    chart = growth_map(model, highest_rpm * share, parameter, highest * share, jobs=jobs)
    places = highest * (np.arange(integer_at_least("sections", sections, 1)) + 0.5) / sections
    traced = tongue_sections(model, parameter, places, (traced_rpm, highest_rpm), jobs=jobs)
    return chart.assign(traced.data_vars)


def tongue_table(found: Sequence[Sequence[Tongue]], values: ArrayLike, parameters: str) -> xr.Dataset:
    """Rows of tongues of different numbers as arrays filled up with NaN, as :func:`tongue_sections` returns them."""
    table = partial(filled_rows, found)
    both = ("section", "tongue")
    return xr.Dataset(
        {
            "lower": _speed(both, rpm(table("lower")), "Lower border"),
            "upper": _speed(both, rpm(table("upper")), "Upper border"),
            # A maximum is known to the square root of the accuracy of the values around it.
            "peak": variable(both, rpm(table("peak")), "Speed of the largest growth", "rpm", atol=0.1),
            "largest_growth": _growth(both, table("growth_rate"), "Largest growth rate of the tongue"),
        },
        coords={
            "section": np.asarray(values, dtype=float),
            "tongue": np.arange(table("lower").shape[1]),
            "label": text(both, filled_labels(found), "Label of the tongue"),
        },
        attrs={
            "parameters": parameters,
        },
    )


def convergence(
    model: Transverse, modes: Sequence[tuple[int, int]], speeds_rpm: ArrayLike, *, jobs: int = -1
) -> xr.Dataset:
    """Growth rates of a model along a line of speeds for disks with more and more modes.

    The bearing stays the same: μ is measured by the stiffness of the disk of `model`, although more modes make the
    disk softer.

    Parameters
    ----------
    model : Transverse
    modes : sequence of (int, int)
        M and N.
    speeds_rpm : array_like
        Speeds of the face gear [rpm], ascending.
    jobs : int, optional
        Number of processes, as joblib's ``n_jobs``; -1 for all processors.

    Returns
    -------
    xarray.Dataset
        ``growth_rate`` (basis, speed_rpm) [1/s], ``basis`` numbering `modes`; ``circles`` and ``diameters`` over
        basis hold M and N.
    """
    speeds = np.asarray(speeds_rpm, dtype=float)
    rows = []
    for circles, diameters in modes:
        body = replace(model.body, nodal_circles=circles, nodal_diameters=diameters)
        stiffness = model.load.stiffness * reference_stiffness(model.body) / reference_stiffness(body)
        refined = replace(model, body=body, load=replace(model.load, stiffness=stiffness))
        chart = stability_map(refined, rad_per_s(speeds), "stiffness", [stiffness], jobs=jobs, progress=False)
        rows.append(chart.values[0])
    return xr.Dataset(
        {
            "growth_rate": _growth(("basis", "speed_rpm"), rows, "Growth rate ln(max|λ|)/T0"),
            "circles": variable("basis", [m for m, _ in modes], "Largest number of nodal circles", "1"),
            "diameters": variable("basis", [n for _, n in modes], "Largest number of nodal diameters", "1"),
        },
        coords={"basis": np.arange(len(modes)), "speed_rpm": speeds},
        attrs={"parameters": f"{describe(model)}, modes = {tuple(modes)}"},
    )


def hsu_bands(
    model: Transverse,
    parameter: str,
    values: Sequence[float],
    speeds_rpm: tuple[float, float],
    order: int = 2,
) -> xr.Dataset:
    """Hsu's bands of speed at some values of a parameter.

    Parameters
    ----------
    model : Transverse
    parameter : str
        Swept parameter.
    values : sequence of float
        Its values.
    speeds_rpm : tuple of float
        Lowest and highest speed of the face gear [rpm].
    order : int, optional
        Highest order s of the resonances.

    Returns
    -------
    xarray.Dataset
        ``lower``, ``upper`` and ``centre`` [rpm] over (section, band), NaN beyond the bands of a section.
    """
    speeds = (float(rad_per_s(speeds_rpm[0])), float(rad_per_s(speeds_rpm[1])))
    rows = [
        band_speeds(replace_parameter(model, parameter, value), speeds, order=order, points=21)
        for value in values
    ]
    tables = {name: rpm(filled_rows(rows, name)) for name in ("lower", "upper", "centre")}
    both = ("section", "band")
    return xr.Dataset(
        {
            "lower": _speed(both, tables["lower"], "Lower border after Hsu"),
            "upper": _speed(both, tables["upper"], "Upper border after Hsu"),
            "centre": _speed(both, tables["centre"], "Speed at which frequencies of the mean system combine"),
        },
        coords={
            "section": list(values),
            "band": np.arange(tables["lower"].shape[1]),
            "label": text(both, filled_labels(rows), "Label of the band"),
        },
        attrs={
            "parameters": f"{describe(model)}, swept = {parameter}",
        },
    )
