"""Arrays of the design figures of chapter 7, labelled, with units and the tolerances at which they are checked."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from compendium.datasets.modulation import describe, relative_modulation
from facegear.floquet.methods import AdaptiveMagnus
from facegear.floquet.models import Model, replace_parameter, value_of
from facegear.floquet.radau import Radau
from facegear.geometry.kinematics import CentroidPath, ContactPath
from facegear.maps.closing import GrowthPeaks, growth_peaks
from facegear.maps.sensitivity import border_derivatives, parameter_value
from facegear.maps.tracing import Tongue, tongues
from facegear.mechanics.gearboxes import DRIVE
from facegear.mechanics.torsional import Torsional
from facegear.support.labelled import filled_labels, filled_rows, text, variable
from facegear.support.parameters import integer_at_least, rad_per_s, rpm
from facegear.support.types import FloatArray

_growth = partial(variable, units="1/s", rtol=1e-5, atol=1e-3)
_speed = partial(variable, units="rpm", rtol=1e-7, atol=1e-4)

# As in the maps of the chapter. Its errors are smooth along speed, where steps of the adaptive Magnus rule would cut
# the windows of interpolation short.
_METHOD = Radau()
# Derivatives are not known to Radau panels; far below what a figure shows, and several times cheaper than the default.
_DERIVATIVES = AdaptiveMagnus(1e-9)


# --- what the text takes for granted ------------------------------------------------------------------------------


def variants(model: Torsional) -> dict[str, Torsional]:
    """List the gearbox as printed, and with the arm, the path or the contact ratio taken differently."""
    tregold, geometric = DRIVE.contact_ratio, DRIVE.geometric_contact_ratio
    softer = tregold / geometric
    slow = replace(model, contact=replace(model.contact, contact_ratio=geometric))
    # Shafts keep their stiffness, which is given as a multiple of that of the mesh.
    soft = slow
    for name, factor in (
        ("correction_factor", softer),
        ("input_stiffness", 1.0 / softer),
        ("output_stiffness", 1.0 / softer),
    ):
        soft = replace_parameter(soft, name, value_of(model, name) * factor)
    return {
        "as printed": model,
        "conjugate arm": replace(model, arm="conjugate"),
        "true contact points": replace(model, contact=replace(model.contact, path=ContactPath)),
        "contact centroid": replace(model, contact=replace(model.contact, path=CentroidPath)),
        "geometric contact ratio": slow,
        "the same, softer pairs": soft,
        "geometric, conjugate arm": replace(slow, arm="conjugate"),
    }


def variant_tongues(
    models: Mapping[str, Torsional],
    speeds_rpm: tuple[float, float],
    traced: Mapping[str, Sequence[Tongue]] | None = None,
) -> xr.Dataset:
    """Tongues of several variants of a gearbox.

    Parameters
    ----------
    models : mapping of str to Torsional
        From :func:`variants`.
    speeds_rpm : tuple of float
        Lowest and highest speed [rpm].
    traced : mapping of str to sequence of Tongue, optional
        Tongues of each, if they are there already.

    Returns
    -------
    xarray.Dataset
        ``lower``, ``upper`` [rpm] and ``largest_growth`` [1/s] over (variant, tongue), NaN beyond the tongues of a
        variant; ``modulation`` over (variant, order) from :func:`relative_modulation`. Names in the
        coordinate ``variant_name``, labels in ``label``.
    """
    low, high = (float(rad_per_s(limit)) for limit in speeds_rpm)
    there = traced or {}
    found = [
        there[name] if name in there else tongues(model, (low, high), method=_METHOD)
        for name, model in models.items()
    ]
    orders = np.arange(1, 5)

    table = partial(filled_rows, found)
    both = ("variant", "tongue")
    modulation = [relative_modulation(model, high, int(orders[-1])) for model in models.values()]
    return xr.Dataset(
        {
            "lower": _speed(both, rpm(table("lower")), "Lower border"),
            "upper": _speed(both, rpm(table("upper")), "Upper border"),
            "largest_growth": _growth(both, table("growth_rate"), "Largest growth rate of the tongue"),
            "modulation": variable(
                ("variant", "order"), modulation, "Harmonics of the stiffness of mode 1", "1", atol=1e-8
            ),
        },
        coords={
            "variant": np.arange(len(found)),
            "variant_name": text("variant", list(models), "What is taken otherwise"),
            "label": text(both, filled_labels(found), "Label of the tongue"),
            "tongue": np.arange(table("lower").shape[1]),
            "order": orders,
        },
        attrs={
            "parameters": describe(next(iter(models.values()))),
        },
    )


def arms(points: int) -> xr.Dataset:
    """Moment arms of the first tooth pair about the face-gear axis over its time in mesh.

    Parameters
    ----------
    points : int
        Instants, at least 2.

    Returns
    -------
    xarray.Dataset
        Over the ``fraction`` of the mesh time of the pair: ``printed``, ``contact_point`` and ``conjugate`` [m].
    """
    fraction = np.linspace(0.0, 1.0, integer_at_least("points", points, 2))
    cosine = np.cos(DRIVE.pressure_angle)
    skew = DRIVE.outer_radius + (DRIVE.inner_radius - DRIVE.outer_radius) * fraction
    true = ContactPath(DRIVE).contact_point(fraction).radius
    length = partial(variable, "fraction", units="m", atol=1e-11)
    return xr.Dataset(
        {
            "printed": length(cosine * skew, "Arm r cos α_c on the skew line"),
            "contact_point": length(cosine * true, "Arm r cos α_c at the true contact point"),
            "conjugate": length(
                np.full(fraction.shape, DRIVE.base_radius / DRIVE.speed_ratio), "Arm of the conjugate tooth"
            ),
        },
        coords={"fraction": fraction},
        attrs={"parameters": "drive of table 7.1"},
    )


def pairs_in_mesh(points: int) -> xr.Dataset:
    """Count the tooth pairs in mesh over two mesh periods, relative to their mean, for both contact ratios.

    Parameters
    ----------
    points : int
        Instants, at least 2.

    Returns
    -------
    xarray.Dataset
        ``pairs`` over (ratio, fraction) [-]; ``contact_ratio`` and ``harmonic``, the amplitude of the mesh frequency
        relative to the mean, over ``ratio``: 0 Tregold's, 1 the geometric one.
    """
    fraction = np.linspace(0.0, 2.0, integer_at_least("points", points, 2))
    ratios = np.array([DRIVE.contact_ratio, DRIVE.geometric_contact_ratio])
    whole = np.floor(ratios)
    count = whole[:, None] + (np.mod(fraction, 1.0) < (ratios - whole)[:, None])
    # A pair adds a unit for cr mesh periods: the integral of cos over that time.
    harmonic = 2.0 * np.abs(np.sin(np.pi * ratios)) / (np.pi * ratios)
    return xr.Dataset(
        {
            "pairs": variable(
                ("ratio", "fraction"),
                count / ratios[:, None],
                "Pairs in mesh over their mean",
                "1",
                rtol=1e-10,
            ),
            "contact_ratio": variable("ratio", ratios, "Contact ratio", "1", rtol=1e-10),
            "harmonic": variable("ratio", harmonic, "First harmonic over the mean", "1", rtol=1e-9),
        },
        coords={"ratio": [0, 1], "fraction": fraction},
        attrs={"parameters": "drive of table 7.1"},
    )


# --- levers -------------------------------------------------------------------------------------------------------

PARAMETERS = (
    "pinion_inertia",
    "gear_inertia",
    "load_inertia",
    "mesh_stiffness",
    "input_stiffness",
    "output_stiffness",
    "mesh_damping",
    "input_damping",
    "output_damping",
)
"""Parameters of :class:`facegear.mechanics.torsional.Gearbox` in the design chart, each changed alone."""

SYMBOLS = ("$J_1$", "$J_2$", "$J_o$", "$k_m$", "$k_1$", "$k_2$", "$c_m$", "$c_1$", "$c_2$")


def sensitivities(cases: Mapping[str, Torsional], speeds_rpm: tuple[float, float]) -> xr.Dataset:
    """Sensitivity of every tongue to each parameter of the gearbox.

    Parameters
    ----------
    cases : mapping of str to Torsional
    speeds_rpm : tuple of float
        Lowest and highest speed [rpm]; tongues cut off there are left out.

    Returns
    -------
    xarray.Dataset
        Over (tongue, parameter): ``width_change``, percent of its width a tongue gains for a percent of the
        parameter, and ``centre_change``, the same for its middle; over tongue: ``lower``, ``upper`` [rpm]. Case and
        label in the coordinates ``case_name`` and ``label``.
    """
    low, high = (float(rad_per_s(limit)) for limit in speeds_rpm)
    names: list[tuple[str, str]] = []
    borders_found: list[tuple[float, float]] = []
    widths, centres = [], []
    for case, given in cases.items():
        # Its own parameters, in SI: what the ratios of the captions tie together varies one by one.
        model = replace(given, gearbox=given.gearbox.in_si)
        for tongue in tongues(model, (low, high), method=_METHOD):
            if tongue.lower <= low or tongue.upper >= high:
                continue
            values = np.array([parameter_value(model, tongue.peak, name) for name in PARAMETERS])
            at = _border_changes(model, tongue) * values
            names.append((case, tongue.label))
            borders_found.append((tongue.lower, tongue.upper))
            widths.append((at[1] - at[0]) / tongue.width)
            centres.append((at[1] + at[0]) / (tongue.lower + tongue.upper))
    lower, upper = rpm(np.array(borders_found)).T
    both = ("tongue", "parameter")
    relative = partial(variable, units="%/%", rtol=1e-5, atol=1e-5)
    return xr.Dataset(
        {
            "width_change": relative(both, widths, "Relative change of the width"),
            "centre_change": relative(both, centres, "Relative change of the middle speed"),
            "lower": _speed("tongue", lower, "Lower border"),
            "upper": _speed("tongue", upper, "Upper border"),
        },
        coords={
            "tongue": np.arange(len(names)),
            "case_name": text("tongue", [case for case, _ in names], "Gearbox"),
            "label": text("tongue", [label for _, label in names], "Label of the tongue"),
            "parameter": np.arange(len(PARAMETERS)),
        },
        attrs={
            "parameters": "; ".join(f"{name}: {describe(case)}" for name, case in cases.items()),
        },
    )


def _border_changes(model: Model, tongue: Tongue) -> FloatArray:
    """Differentiate lower and upper border, shape (2, P)."""
    return np.array(
        [border_derivatives(model, speed, PARAMETERS, _DERIVATIVES) for speed in (tongue.lower, tongue.upper)]
    )


def closing(
    model: Torsional,
    parameter: str,
    dampings: ArrayLike,
    ranges_rpm: Mapping[str, tuple[float, float]],
    followed: Mapping[str, GrowthPeaks] | None = None,
) -> xr.Dataset:
    """Largest growth of some tongues against the damping of a shaft, with every value that closes or opens one.

    Parameters
    ----------
    model : Torsional
    parameter : str
        ``"input_damping"`` or ``"output_damping"`` [s].
    dampings : array_like
        Its values, ascending.
    ranges_rpm : mapping of str to tuple of float
        Label of each tongue and the speeds [rpm] between which it lies at all dampings.
    followed : mapping of str to GrowthPeaks, optional
        What is there already, by the label.

    Returns
    -------
    xarray.Dataset
        ``growth_rate`` [1/s] over (tongue, damping); ``closing_damping`` [s], ``closing_speed`` [rpm] and ``closes``
        (1 where the tongue closes with more damping, -1 where it opens) over (tongue, root), NaN beyond the roots of
        a tongue.

    Raises
    ------
    ArithmeticError
        If the tongue that closes has another label than the one given.
    """
    axis = np.asarray(dampings, dtype=float)
    rows: list[GrowthPeaks] = []
    for label, limits in ranges_rpm.items():
        low, high = (float(rad_per_s(limit)) for limit in limits)
        peaks = (followed or {}).get(label)
        rows.append(peaks or growth_peaks(model, parameter, axis, (low, high), method=_METHOD))
        for closing_value in rows[-1].closing_values:
            if closing_value.label != label:
                raise ArithmeticError(
                    f"the tongue between {limits[0]:.6g} and {limits[1]:.6g} rpm is {closing_value.label}, not {label}"
                )
    most = max(1, *(len(row.closing_values) for row in rows))
    values, speeds, closes = np.full((3, len(rows), most), np.nan)
    for i, row in enumerate(rows):
        for j, found in enumerate(row.closing_values):
            values[i, j], speeds[i, j] = found.value, rpm(found.speed)
            closes[i, j] = 1.0 if found.closes else -1.0
    both = ("tongue", "root")
    return xr.Dataset(
        {
            "growth_rate": _growth(
                ("tongue", "damping"), [row.growth_rates for row in rows], "Largest growth rate"
            ),
            "closing_damping": variable(
                both, values, "Damping that closes or opens the tongue", "s", rtol=1e-6
            ),
            "closing_speed": variable(both, speeds, "Speed of the peak there", "rpm", atol=0.01),
            "closes": variable(both, closes, "1 closes, -1 opens", "1"),
        },
        coords={
            "tongue": np.arange(len(rows)),
            "label": text("tongue", list(ranges_rpm), "Label of the tongue"),
            "root": np.arange(most),
            "damping": axis,
        },
        attrs={
            "parameters": f"{describe(model)}, swept = {parameter}",
        },
    )
