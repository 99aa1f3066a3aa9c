"""Arrays of chapter 7's figures, labelled, with units and the tolerances at which they are checked.

Every row of a map is one gearbox, whose transition matrices are smooth in 1/speed: :func:`stability_map` interpolates
them there, so that hundreds of columns cost as much as some tens. Tongues between the columns are traced by
:func:`facegear.maps.tracing.borders`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike
from scipy.optimize import minimize_scalar

from facegear.floquet.band_speeds import SpeedBand, band_speeds
from facegear.floquet.modal import ModalExpansion, standard_form
from facegear.floquet.models import replace_parameter, value_of
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.radau import Radau
from facegear.geometry.kinematics import CentroidPath, ContactPath
from facegear.geometry.skew_line import SkewLine
from facegear.maps.stability_map import stability_map
from facegear.maps.tracing import borders, tongues
from facegear.mechanics.gearboxes import HIGHEST_SPEED_RPM, TorsionalFigure
from facegear.mechanics.torsional import Torsional
from facegear.support.labelled import filled_labels, filled_rows, text, variable
from facegear.support.parameters import finite_array, integer_at_least, rad_per_s, rpm
from facegear.support.types import FloatArray

METHOD = Radau()
"""Rule of all maps and tongues of the chapter: shafts are stiff and damped."""

HIGHEST_ORDER = 6
"""Highest order s at which Hsu's bands are looked for."""

_growth = partial(variable, units="1/s", rtol=1e-6, atol=1e-3)
_speed = partial(variable, units="rpm", rtol=1e-7, atol=1e-4)
# Speeds at which Hsu's combinations are first compared: natural frequencies hardly depend on speed here.
_HSU_POINTS = 9
# Natural frequencies further apart than this ratio do not know of one another.
_NEIGHBOURS = 3.0
# What stored arrays call the paths of contact.
_PATHS: Mapping[Any, str] = {SkewLine: "skew_line", ContactPath: "contact_path", CentroidPath: "centroid"}


def describe(model: Torsional) -> str:
    """Parameters of a gearbox as text, for the provenance of a figure."""
    names = {
        "correction_factor": "correction_factor",
        "gear_inertia": "J2/J1",
        "load_inertia": "Jo/J1",
        "input_stiffness": "k1/km",
        "output_stiffness": "k2/km",
        "mesh_damping": "cm/km_s",
        "input_damping": "c1/k1_s",
        "output_damping": "c2/k2_s",
    }
    return described(model, names)


def described(model: Torsional, names: Mapping[str, str]) -> str:
    """Parameters of a gearbox under the names given, and its contact, as text."""
    numbers = ", ".join(f"{name} = {value_of(model, field):.10g}" for field, name in names.items())
    contact = f"contact_ratio = {model.contact_ratio:.10g}, arm = {model.arm}"
    return f"{numbers}, {contact}, path = {_PATHS[model.contact.path]}"


def axis_values(figure: TorsionalFigure, count: int) -> FloatArray:
    """Values of the swept parameter of a figure, evenly spread over its axis, ends included.

    Parameters
    ----------
    figure : TorsionalFigure
    count : int
        Number of values, at least 2.

    Returns
    -------
    ndarray, shape (count,)
    """
    count = integer_at_least("count", count, 2)
    if figure.scale == "log":
        return np.geomspace(figure.lowest, figure.highest, count)
    return np.linspace(figure.lowest, figure.highest, count)


def natural_frequencies(figure: TorsionalFigure, count: int = 201) -> xr.Dataset:
    """Natural frequencies of the gearbox at rest over the axis of a figure, and where they veer (Figs 7.8, 7.10).

    Parameters
    ----------
    figure : TorsionalFigure
    count : int, optional
        Values of the swept parameter.

    Returns
    -------
    xarray.Dataset
        ``frequency`` (mode, parameter) [Hz], ``natural_speed`` (mode, parameter) [rpm] (7-20); ``veering`` (pair),
        value of the parameter at which neighbouring frequencies come closest in ratio inside the axis, and
        ``closest`` (pair), their ratio less 1 there; NaN for pairs that only draw apart or together, or
        that stay further apart than a factor of three.
    """
    values = axis_values(figure, count)
    frequencies = np.stack([_frequencies(figure, value) for value in values.tolist()], axis=1)
    ratios = frequencies[1:] / frequencies[:-1]
    veering = np.full(len(ratios), np.nan)
    closest = np.full(len(ratios), np.nan)
    for pair, ratio in enumerate(ratios):
        at = int(np.argmin(ratio))
        if 0 < at < count - 1 and ratio[at] < _NEIGHBOURS:

            def apart(logarithm: float, pair: int = pair) -> float:
                both = _frequencies(figure, float(np.exp(logarithm)))
                return float(both[pair + 1] / both[pair])

            around = np.log(values[[at - 1, at + 1]])
            found = minimize_scalar(apart, bounds=tuple(around), method="bounded", options={"xatol": 1e-10})
            veering[pair], closest[pair] = np.exp(found.x), found.fun - 1.0
    modes = np.arange(1, len(frequencies) + 1)
    both = ("mode", figure.parameter)
    speeds = rpm(frequencies / figure.model().drive.gear_teeth)
    return xr.Dataset(
        {
            "frequency": variable(
                both, frequencies / (2 * np.pi), "Natural frequency at rest", "Hz", rtol=1e-9
            ),
            "natural_speed": variable(both, speeds, "Natural speed of the face gear", "rpm", rtol=1e-9),
            # The place of a minimum is known to the square root of the accuracy of the values around it.
            "veering": variable(
                "pair", veering, f"{figure.parameter} where neighbours come closest", "1", rtol=1e-4
            ),
            "closest": variable(
                "pair", closest, "Least ratio of neighbours less 1", "1", rtol=1e-5, atol=1e-10
            ),
        },
        coords={"mode": modes, figure.parameter: values, "pair": modes[:-1]},
        attrs={
            "parameters": f"{describe(figure.model())}, swept = {figure.parameter}",
            "scale": figure.scale,
        },
    )


def _frequencies(figure: TorsionalFigure, value: float) -> FloatArray:
    """Natural frequencies at rest, shape (3,) [rad/s]."""
    return replace_parameter(figure.model(), figure.parameter, value).natural_frequencies()


def moment_arms(model: Torsional, count: int = 201) -> xr.Dataset:
    """Moment arms of the mesh force about the face-gear axis over two mesh periods, as printed and as conjugate.

    Parameters
    ----------
    model : Torsional
    count : int, optional
        Instants of one mesh period.

    Returns
    -------
    xarray.Dataset
        ``printed`` (pair, time) [m], r(t) cos α_c of (7-3) for each tooth pair in contact, NaN out of contact;
        ``conjugate`` [m], r_b1 N2/N1; ``pairs`` (time), number of tooth pairs in mesh; ``time`` in mesh periods.
    """
    count = integer_at_least("count", count, 2)
    time = 2.0 * (np.arange(2 * count) + 0.5) / (2 * count)
    arms = np.stack([-shape(time)[:, 1] for shape in model.shapes])
    in_mesh = arms > 0.0
    drive = model.drive
    return xr.Dataset(
        {
            "printed": variable(
                ("pair", "time"), np.where(in_mesh, arms, np.nan), "Arm r cos α_c", "m", rtol=1e-9
            ),
            "conjugate": variable(
                (), drive.base_radius / drive.speed_ratio, "Arm r_b1 N2/N1", "m", rtol=1e-12
            ),
            "pairs": variable("time", in_mesh.sum(axis=0).astype(float), "Tooth pairs in mesh", "1"),
        },
        coords={"pair": np.arange(len(arms)), "time": time},
        attrs={"parameters": describe(model)},
    )


def growth_map(
    figure: TorsionalFigure,
    speeds_rpm: ArrayLike,
    values: ArrayLike,
    *,
    growth: xr.DataArray | None = None,
    jobs: int = -1,
    **options: Any,
) -> xr.Dataset:
    """Growth rates over speed and the swept parameter of a figure.

    Parameters
    ----------
    figure : TorsionalFigure
    speeds_rpm : array_like
        Speeds of the face gear [rpm], ascending.
    values : array_like
        Values of the parameter.
    growth : xarray.DataArray, optional
        Map of :func:`facegear.maps.stability_map.stability_map` over these, if it is there already.
    jobs : int, optional
        Number of processes, as joblib's ``n_jobs``; -1 for all processors.
    **options
        As for :class:`facegear.mechanics.torsional.Torsional`, such as ``arm="conjugate"``.

    Returns
    -------
    xarray.Dataset
        ``growth_rate`` (parameter, speed_rpm) [1/s], unstable where positive.
    """
    array = finite_array("values", values)
    base = figure.model(**options)
    speeds = rad_per_s(finite_array("speeds_rpm", speeds_rpm, "rpm"))
    chart = growth
    if chart is None:
        chart = stability_map(base, speeds, figure.parameter, array, method=METHOD, jobs=jobs)
    both = (figure.parameter, "speed_rpm")
    return xr.Dataset(
        {"growth_rate": _growth(both, chart.values, "Growth rate ln(max|λ|)/T0")},
        coords={figure.parameter: array, "speed_rpm": np.asarray(speeds_rpm, dtype=float)},
        attrs={"parameters": f"{describe(base)}, swept = {figure.parameter}", "scale": figure.scale},
    )


def stability_figure(
    figure: TorsionalFigure,
    *,
    columns: int = 400,
    rows: int = 32,
    sections: int = 4,
    growth: xr.DataArray | None = None,
    jobs: int = -1,
) -> xr.Dataset:
    """Map of growth rates with traced borders and Hsu's bands (one of Figs 7.9, 7.11, 7.12, 7.13).

    Parameters
    ----------
    figure : TorsionalFigure
    columns, rows : int, optional
        Speeds from the figure's lowest to the highest one, and values of the parameter.
    sections : int, optional
        Values of the parameter, evenly spread over the axis from its middle cell on, at which borders are traced.
    growth : xarray.DataArray, optional
        As for :func:`growth_map`.
    jobs : int, optional
        Number of processes, as joblib's ``n_jobs``; -1 for all processors.

    Returns
    -------
    xarray.Dataset
        ``growth_rate`` as :func:`growth_map`; ``lower``, ``upper``, ``peak`` [rpm] and ``largest_growth`` [1/s] of
        the tongues over (section, tongue); ``hsu_lower``, ``hsu_upper`` and ``hsu_centre`` [rpm] over (section,
        band); NaN beyond the tongues and bands of a section. Labels in the coordinates ``label`` and
        ``hsu_label``, empty there.
    """
    columns = integer_at_least("columns", columns, 2)
    speeds = np.linspace(figure.lowest_rpm, HIGHEST_SPEED_RPM, columns)
    chart = growth_map(figure, speeds, axis_values(figure, rows), growth=growth, jobs=jobs)
    places = axis_values(figure, 2 * integer_at_least("sections", sections, 1) + 1)[1::2]
    traced = traced_sections(figure, places, jobs=jobs)
    hsu = hsu_sections(figure, places)
    return chart.assign({**traced.data_vars, **hsu.data_vars})


def traced_sections(figure: TorsionalFigure, values: ArrayLike, *, jobs: int = -1) -> xr.Dataset:
    """Traced borders of all tongues at some values of the swept parameter.

    Parameters
    ----------
    figure : TorsionalFigure
    values : array_like, shape (V,)
    jobs : int, optional
        Number of processes, as joblib's ``n_jobs``; -1 for all processors.

    Returns
    -------
    xarray.Dataset
        ``lower``, ``upper``, ``peak`` [rpm] and ``largest_growth`` [1/s] over (section, tongue); coordinate
        ``label``.
    """
    low, high = rad_per_s(figure.lowest_rpm), rad_per_s(HIGHEST_SPEED_RPM)
    found = [
        section.tongues
        for section in borders(
            figure.model(), figure.parameter, values, (low, high), method=METHOD, jobs=jobs
        )
    ]
    both = ("section", "tongue")
    tables = {name: filled_rows(found, name) for name in ("lower", "upper", "peak", "growth_rate")}
    return xr.Dataset(
        {
            "lower": _speed(both, rpm(tables["lower"]), "Lower border"),
            "upper": _speed(both, rpm(tables["upper"]), "Upper border"),
            "peak": variable(both, rpm(tables["peak"]), "Speed of the largest growth", "rpm", atol=0.1),
            "largest_growth": _growth(both, tables["growth_rate"], "Largest growth rate of the tongue"),
        },
        coords={
            "section": np.asarray(values, dtype=float),
            "label": text(both, filled_labels(found), "Label of the tongue"),
        },
    )


def printed_expansion(system: PeriodicSystem, order: int) -> ModalExpansion:
    """Expansion about the mean as the dissertation has it (7-16 to 7-19)."""
    return standard_form(system, order).expansion()


def hsu_bands(model: Torsional, speeds_rpm: tuple[float, float]) -> tuple[SpeedBand, ...]:
    """Hsu's bands of speed as the dissertation has them: each pair of frequencies alone (7-16 to 7-19, 2-26).

    Parameters
    ----------
    model : Torsional
    speeds_rpm : tuple of float
        Lowest and highest speed of the face gear [rpm].
    """
    speeds = (float(rad_per_s(speeds_rpm[0])), float(rad_per_s(speeds_rpm[1])))
    return band_speeds(
        model, speeds, order=HIGHEST_ORDER, points=_HSU_POINTS, reach=0.0, expand=printed_expansion
    )


def block_bands(model: Torsional, speeds_rpm: tuple[float, float]) -> tuple[SpeedBand, ...]:
    """First-order bands of speed when further frequencies in resonance join a pair; as :func:`hsu_bands`."""
    speeds = (float(rad_per_s(speeds_rpm[0])), float(rad_per_s(speeds_rpm[1])))
    return band_speeds(model, speeds, order=HIGHEST_ORDER, points=_HSU_POINTS, expand=printed_expansion)


def hsu_sections(figure: TorsionalFigure, values: ArrayLike) -> xr.Dataset:
    """Hsu's bands at some values of the swept parameter.

    Parameters
    ----------
    figure : TorsionalFigure
    values : array_like, shape (V,)

    Returns
    -------
    xarray.Dataset
        ``hsu_lower``, ``hsu_upper`` and ``hsu_centre`` [rpm] over (section, band); coordinate ``hsu_label``.
    """
    array = finite_array("values", values)
    span = (figure.lowest_rpm, HIGHEST_SPEED_RPM)
    models = [replace_parameter(figure.model(), figure.parameter, value) for value in array.tolist()]
    found = [hsu_bands(model, span) for model in models]
    both = ("section", "band")
    names = {
        "lower": "Lower border after Hsu",
        "upper": "Upper border after Hsu",
        "centre": "Speed at which natural frequencies combine",
    }
    return xr.Dataset(
        {f"hsu_{name}": _speed(both, rpm(filled_rows(found, name)), what) for name, what in names.items()},
        coords={"section": array, "hsu_label": text(both, filled_labels(found), "Label of the band")},
    )


def resonances(
    figure: TorsionalFigure, value: float, found: Mapping[str, Sequence[Any]] | None = None
) -> xr.Dataset:
    """Resonances of one gearbox by Floquet's and by Hsu's method, side by side.

    Parameters
    ----------
    figure : TorsionalFigure
    value : float
        Value of the swept parameter.
    found : mapping of str to sequence, optional
        Tongues and bands by ``floquet``, ``hsu`` and ``blocks``, if they are there already.

    Returns
    -------
    xarray.Dataset
        Over ``resonance``, ascending by speed: ``floquet``, ``hsu`` and ``blocks`` (resonance, border) [rpm], lower
        and upper border after Floquet, Hsu's pairs and Hsu's method with all frequencies in resonance together; NaN
        where a method finds none; ``largest_growth`` [1/s]. Labels in the coordinate ``label``; a second tongue of
        the same modes and order has a prime.
    """
    model = replace_parameter(figure.model(), figure.parameter, value)
    span = (figure.lowest_rpm, HIGHEST_SPEED_RPM)
    routes: Mapping[str, Sequence[Any]] = found or {
        "floquet": tongues(model, (rad_per_s(span[0]), rad_per_s(span[1])), method=METHOD),
        "hsu": hsu_bands(model, span),
        "blocks": block_bands(model, span),
    }
    bands = {name: _by_label(route) for name, route in routes.items()}
    first = {label: ends[0] for route in reversed(bands.values()) for label, ends in route.items()}
    labels = sorted(first, key=lambda label: float(first[label]))
    growth = dict(zip(bands["floquet"], (tongue.growth_rate for tongue in routes["floquet"]), strict=True))
    nothing = (np.nan, np.nan)
    names = {"floquet": "Floquet", "hsu": "Hsu, pairs", "blocks": "Hsu, blocks"}
    return xr.Dataset(
        {
            **{
                name: _speed(
                    ("resonance", "border"), [bands[name].get(label, nothing) for label in labels], what
                )
                for name, what in names.items()
            },
            "largest_growth": _growth(
                "resonance", [growth.get(label, np.nan) for label in labels], "Growth rate"
            ),
        },
        coords={
            "resonance": np.arange(len(labels)),
            "label": text("resonance", labels, "Label of the resonance"),
            "border": [0, 1],
        },
        attrs={"parameters": f"{describe(model)}"},
    )


def _by_label(found: Sequence[Any]) -> dict[str, tuple[float, float]]:
    """Borders [rpm] by label, repeated labels with primes."""
    bands: dict[str, tuple[float, float]] = {}
    for band in found:
        label = band.label
        while label in bands:
            label += "'"
        bands[label] = (float(rpm(band.lower)), float(rpm(band.upper)))
    return bands


def intervals(table: xr.Dataset, method: str) -> dict[str, tuple[float, float]]:
    """Borders of all resonances that a method finds, by label.

    Parameters
    ----------
    table : xarray.Dataset
        From :func:`resonances`.
    method : {"floquet", "hsu", "blocks"}

    Returns
    -------
    dict of str to (float, float)
        Lower and upper border [rpm].
    """
    rows = zip(table["label"].values.tolist(), table[method].values.tolist(), strict=True)
    return {label: (low, high) for label, (low, high) in rows if np.isfinite(low)}


def section_intervals(chart: xr.Dataset, label: str) -> dict[float, tuple[float, float]]:
    """Traced borders of the tongue with a label over the sections of a figure.

    Parameters
    ----------
    chart : xarray.Dataset
        From :func:`stability_figure`.
    label : str

    Returns
    -------
    dict of float to (float, float)
        Value of the swept parameter to lower and upper border [rpm], where the tongue exists.
    """
    found = {}
    for number, labels in enumerate(chart["label"].values.tolist()):
        if label in labels:
            place = labels.index(label)
            found[float(chart["section"][number])] = (
                float(chart["lower"][number, place]),
                float(chart["upper"][number, place]),
            )
    return found
