"""Arrays of the chapter on shafts that have mass, with units and tolerances."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from compendium.datasets.torsional import METHOD
from facegear.floquet.models import replace_parameter, value_of
from facegear.floquet.multipliers import growth_rate
from facegear.maps.rows import Rows
from facegear.maps.tracing import Tongue, tongues
from facegear.mechanics.gearboxes import TorsionalFigure
from facegear.mechanics.heavy_shafts import HeavyShafts
from facegear.mechanics.torsional import Gearbox, Torsional
from facegear.support.labelled import filled_labels, filled_rows, text, variable
from facegear.support.parameters import rad_per_s, rpm


def of_length(model: HeavyShafts, length: float, lengths: Sequence[str]) -> HeavyShafts:
    """Return the gearbox with a length [m] for one shaft or both, which `lengths` names by their fields."""
    for name in lengths:
        model = replace_parameter(model, name, length)
    return model


def natural_speeds(
    model: HeavyShafts, lengths_m: ArrayLike, lengths: Sequence[str], count: int
) -> xr.Dataset:
    """Natural speeds over the length of shafts: with modes, exact, and of massless shafts.

    Parameters
    ----------
    model : HeavyShafts
    lengths_m : array_like, shape (L,)
    lengths : sequence of str
        Fields that have these lengths.
    count : int
        How many natural speeds.

    Returns
    -------
    xarray.Dataset
        ``reduced`` and ``exact`` (mode, length) [rpm], ``massless`` (massless_mode) [rpm].
    """
    teeth = model.torsional.drive.gear_teeth
    values = np.asarray(lengths_m, dtype=float)
    rows = [of_length(model, length, lengths) for length in values.tolist()]
    reduced = np.stack([row.natural_frequencies()[:count] for row in rows], axis=1)
    exact = np.stack([row.exact_frequencies(count) for row in rows], axis=1)
    both = ("mode", "length")
    return xr.Dataset(
        {
            "reduced": variable(both, rpm(reduced / teeth), "Natural speed, shafts with modes", "rpm", 1e-8),
            "exact": variable(both, rpm(exact / teeth), "Natural speed, shafts unreduced", "rpm", 1e-8),
            "massless": variable(
                "massless_mode",
                rpm(model.torsional.natural_speeds()),
                "Natural speed, massless shafts",
                "rpm",
                1e-8,
            ),
        },
        {"mode": np.arange(1, count + 1), "length": values, "massless_mode": np.arange(1, 4)},
    )


def convergence(model: HeavyShafts, speed_rpm: float, modes: Sequence[int], finest: int) -> xr.Dataset:
    """Errors against the number of modes of a shaft.

    Parameters
    ----------
    model : HeavyShafts
    speed_rpm : float
        Where the growth rate is taken.
    modes : sequence of int
    finest : int
        Number of modes of the growth rate that stands for the exact one.

    Returns
    -------
    xarray.Dataset
        ``frequency`` (mode, modes), relative error of the first four natural frequencies against the exact ones;
        ``growth`` (modes), difference of the growth rate from that of `finest` [1/s].
    """
    exact = model.exact_frequencies(4)
    speed = float(rad_per_s(speed_rpm))

    def growth(count: int) -> float:
        return growth_rate(replace(model, modes=count).system(speed), METHOD)

    found = [replace(model, modes=count).natural_frequencies() for count in modes]
    # Without modes there are three frequencies.
    errors = np.stack([np.append(x, np.nan)[:4] / exact - 1.0 for x in found], axis=1)
    truth = growth(finest)
    return xr.Dataset(
        {
            "frequency": variable(
                ("mode", "modes"), errors, "Relative error of a natural frequency", "1", 1e-4, 1e-11
            ),
            "growth": variable(
                "modes", [growth(n) - truth for n in modes], "Error of the growth rate", "1/s", 1e-3, 1e-7
            ),
        },
        {"mode": np.arange(1, 5), "modes": list(modes)},
    )


def stability(
    model: HeavyShafts,
    lengths: Sequence[str],
    speeds_rpm: ArrayLike,
    lengths_m: ArrayLike,
    sections_m: ArrayLike,
    growth: Sequence[ArrayLike],
) -> xr.Dataset:
    """Put together growth rates over speed and the length of shafts, those of massless shafts, and traced borders.

    Parameters
    ----------
    model : HeavyShafts
    lengths : sequence of str
        Fields that have the length.
    speeds_rpm : array_like, shape (S,)
    lengths_m : array_like, shape (L,)
    sections_m : array_like
        Lengths at which borders are traced.
    growth : sequence of array_like, shape (L, S)
        Growth rates [1/s], of each length a row.

    Returns
    -------
    xarray.Dataset
        ``growth_rate`` (length, speed_rpm), ``massless`` (speed_rpm) [1/s]; ``lower``, ``upper`` [rpm] and
        ``largest_growth`` [1/s] (section, tongue), with ``label``; ``massless_lower`` and ``massless_upper``
        (massless_tongue) [rpm], with ``massless_label``.
    """
    shown, values = np.asarray(speeds_rpm, dtype=float), np.asarray(lengths_m, dtype=float)
    speeds = tuple(float(x) for x in rad_per_s(shown))
    ends = (speeds[0], speeds[-1])

    base = model.torsional
    own = value_of(base, "output_stiffness")
    radii, periods = Rows(base, ("gearbox", "output_stiffness"), (own,), speeds, METHOD).compute()
    massless = np.log(radii[0]) / periods[0]
    sections = np.asarray(sections_m, dtype=float)
    found = [tongues(of_length(model, length, lengths), ends, method=METHOD) for length in sections.tolist()]
    before = tongues(base, ends, method=METHOD)
    both = ("section", "tongue")
    what = "Growth rate ln(max|λ|)/T0"
    return xr.Dataset(
        {
            "growth_rate": variable(("length", "speed_rpm"), growth, what, "1/s", 1e-6, 1e-3),
            "massless": variable("speed_rpm", massless, f"{what}, massless shafts", "1/s", 1e-6, 1e-3),
            **{
                name: variable(both, rpm(filled_rows(found, name)), f"{name} border", "rpm", 1e-7, 1e-4)
                for name in ("lower", "upper")
            },
            "largest_growth": variable(
                both,
                filled_rows(found, "growth_rate"),
                "Largest growth rate of the tongue",
                "1/s",
                1e-6,
                1e-3,
            ),
            **{
                f"massless_{name}": variable(
                    "massless_tongue",
                    rpm([getattr(tongue, name) for tongue in before]),
                    f"{name} border, massless shafts",
                    "rpm",
                    1e-7,
                    1e-4,
                )
                for name in ("lower", "upper")
            },
        },
        {
            "length": values,
            "speed_rpm": shown,
            "section": sections,
            "label": text(both, filled_labels(found), "Label of the tongue"),
            "massless_label": text("massless_tongue", [x.label for x in before], "Label of the tongue"),
        },
    )


def turned(chart: xr.Dataset) -> tuple[float, float]:
    """Share of cells that massless shafts call stable and shafts with mass unstable, and of the opposite."""
    heavy, massless = chart.growth_rate.values > 0.0, chart.massless.values > 0.0
    return float((heavy & ~massless).mean()), float((~heavy & massless).mean())


def points(models: Mapping[str, HeavyShafts], places: Sequence[tuple[str, float]], modes: int) -> xr.Dataset:
    """Growth rates at named points, with many modes of the shafts and with massless ones.

    Parameters
    ----------
    models : mapping of str to HeavyShafts
    places : sequence of (str, float)
        Name of the model, and speed [rpm].
    modes : int
        Of each shaft.
    """
    heavy, massless = [], []
    for name, speed_rpm in places:
        model, speed = models[name], float(rad_per_s(speed_rpm))
        heavy.append(growth_rate(replace(model, modes=modes).system(speed), METHOD))
        massless.append(growth_rate(model.torsional.system(speed), METHOD))
    what = "Growth rate"
    return xr.Dataset(
        {
            "heavy": variable("point", heavy, f"{what}, shafts with mass", "1/s", 1e-6, 1e-4),
            "massless": variable("point", massless, f"{what}, massless shafts", "1/s", 1e-6, 1e-4),
        },
        {
            "point": np.arange(len(places)),
            "gearbox": text("point", [name for name, _ in places], "Gearbox"),
            "speed_rpm": ("point", [speed_rpm for _, speed_rpm in places]),
        },
    )


def half_to_each_end(model: HeavyShafts) -> Torsional:
    """Return the gearbox with massless shafts, half the inertia of each added to what it joins."""
    box = model.torsional.gearbox.in_si
    first, second = model.input_rod.inertia / 2.0, model.output_rod.inertia / 2.0
    heavier: Gearbox = replace(
        box,
        pinion_inertia=box.pinion_inertia + first,
        gear_inertia=box.gear_inertia + second,
        load_inertia=box.load_inertia + second,
    )
    return replace(model.torsional, gearbox=heavier)


def sizes(figures: Mapping[str, TorsionalFigure], length: float) -> xr.Dataset:
    """Diameters of solid shafts of a length [m] for the stiffnesses of captions, and how long they may be.

    Parameters
    ----------
    figures : mapping of str to TorsionalFigure
    length : float

    Returns
    -------
    xarray.Dataset
        ``diameter``, ``room`` and ``longest`` (figure, shaft) [m], ``stiffness`` [N m/rad].
    """
    models = [HeavyShafts(figure.model(), length, length) for figure in figures.values()]
    both = ("figure", "shaft")
    tables = {
        "stiffness": ([(m.input_rod.stiffness, m.output_rod.stiffness) for m in models], "N m/rad"),
        "diameter": ([(m.input_rod.diameter, m.output_rod.diameter) for m in models], "m"),
        "room": ([m.largest_diameters for m in models], "m"),
        "longest": ([m.largest_lengths for m in models], "m"),
    }
    what = {
        "stiffness": "Stiffness of the caption",
        "diameter": f"Diameter of a solid shaft {length:g} m long",
        "room": "Largest diameter that leaves room for teeth",
        "longest": "Length from which on a solid shaft is thicker",
    }
    return xr.Dataset(
        {name: variable(both, table, what[name], units, 1e-10) for name, (table, units) in tables.items()},
        {
            "figure": np.arange(len(models)),
            "shaft": [1, 2],
            "caption": text("figure", list(figures), "Figures of chapter 7"),
        },
    )


def in_words(found: Sequence[Tongue]) -> str:
    """Labels and borders [rpm] of tongues, in one line."""
    return ", ".join(f"{x.label} {rpm(x.lower):.1f} to {rpm(x.upper):.1f}" for x in found)
