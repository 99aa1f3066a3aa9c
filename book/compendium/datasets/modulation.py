"""Why first-order averaging fails where it fails: borders and growth against the depth of modulation (chapter 7)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from compendium.datasets.torsional import described
from facegear.floquet.hsu import resonance_bands
from facegear.floquet.labels import Combination
from facegear.floquet.modal import standard_form
from facegear.floquet.models import Coordinate, Model, replace_parameter
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.radau import Radau
from facegear.maps.closing import growth_peaks
from facegear.maps.tracing import tongues
from facegear.mechanics.gearboxes import DRIVE
from facegear.mechanics.torsional import Torsional
from facegear.support.labelled import text, variable
from facegear.support.parameters import integer_at_least, keep, nonnegative, positive, rad_per_s, rpm
from facegear.support.types import FloatArray

_growth = partial(variable, units="1/s", rtol=1e-5, atol=1e-3)
_speed = partial(variable, units="rpm", rtol=1e-7, atol=1e-4)

# As in the maps of the chapter. Its errors are smooth along speed, where steps of the adaptive Magnus rule would cut
# the windows of interpolation short.
_METHOD = Radau()


@dataclass(frozen=True)
class ScaledModulation:
    """A model whose C(t) and K(t) keep their means while everything that varies is multiplied by a factor.

    Parameters
    ----------
    model : Model
        Of constant mass.
    depth : float
        The factor ε: 1 is the model itself, 0 its mean; 0 or greater.

    Raises
    ------
    TypeError, ValueError
        If `depth` is not a finite number of 0 or greater.
    """

    model: Model
    depth: float

    def __post_init__(self) -> None:
        keep(self, depth=nonnegative("depth", self.depth))

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Those of the model."""
        return self.model.coordinates

    def system(self, speed: float) -> PeriodicSystem:
        """Equations of motion at a speed [rad/s]: C̄ + ε (C(t) − C̄), K̄ + ε (K(t) − K̄).

        Raises
        ------
        ValueError
            If a load has a mass.
        """
        system = self.model.system(speed)
        if any(load.mass > 0.0 for load in system.loads):
            raise ValueError("model must have a constant mass; a load of it has a mass of its own")
        _, damping, stiffness = (series.mean for series in system.fourier(1))
        scaled = system.replace_loads(
            damping=[self.depth * load.damping for load in system.loads],
            stiffness=[self.depth * load.stiffness for load in system.loads],
        )
        rest = 1.0 - self.depth
        return replace(
            scaled,
            damping=system.damping + rest * (damping - system.damping),
            stiffness=system.stiffness + rest * (stiffness - system.stiffness),
        )


def undamped(model: Torsional) -> Torsional:
    """Take the dampers out of a gearbox."""
    for name in ("mesh_damping", "input_damping", "output_damping"):
        model = replace_parameter(model, name, 0.0)
    return model


def hsu_errors(resonances: Sequence[tuple[Torsional, Combination]], depths: ArrayLike) -> xr.Dataset:
    """Borders of undamped tongues from Floquet and from Hsu against the depth of modulation.

    Parameters
    ----------
    resonances : sequence of (Torsional, Combination)
        Gearbox, and modes and order of each resonance; dampers are taken out.
    depths : array_like
        ε, ascending.

    Returns
    -------
    xarray.Dataset
        Over (resonance, depth): ``lower``, ``upper``, ``hsu_lower``, ``hsu_upper``, ``width`` and ``border_error``,
        the larger distance of a border from Hsu's [rpm]. Labels in the coordinate ``label``.

    Raises
    ------
    ValueError
        If a resonance is not among Hsu's bands.
    """
    axis = np.asarray(depths, dtype=float)
    table = np.full((4, len(resonances), axis.size), np.nan)
    for row, (gearbox, combination) in enumerate(resonances):
        label = combination.label
        for column, depth in enumerate(axis.tolist()):
            model = ScaledModulation(undamped(gearbox), depth)
            # Without dampers nothing but the period depends on the speed.
            every = resonance_bands(model.system(1.0), order=combination.order)
            bands = [band for band in every if band.label == label]
            if len(bands) != 1:
                raise ValueError(f"resonances must have one band each of Hsu's; {label} has {len(bands)}")
            low, high = bands[0].lower / DRIVE.gear_teeth, bands[0].upper / DRIVE.gear_teeth
            middle, width = (low + high) / 2.0, high - low
            found = tongues(
                model,
                (middle - 2.0 * width, middle + 1.2 * width),
                method=_METHOD,
                threshold=1e-7,
                hints=[middle],
            )
            # Tongues of high order cut a slit into a wide one.
            parts = [tongue for tongue in found if tongue.label == label]
            table[:, row, column] = parts[0].lower, parts[-1].upper, low, high
    lower, upper, hsu_lower, hsu_upper = rpm(table)
    both = ("resonance", "depth")
    error = np.maximum(np.abs(hsu_lower - lower), np.abs(hsu_upper - upper))
    return xr.Dataset(
        {
            "lower": _speed(both, lower, "Lower border"),
            "upper": _speed(both, upper, "Upper border"),
            "hsu_lower": _speed(both, hsu_lower, "Lower border after Hsu"),
            "hsu_upper": _speed(both, hsu_upper, "Upper border after Hsu"),
            "width": _speed(both, upper - lower, "Width"),
            "border_error": _speed(both, error, "Largest error of Hsu's borders"),
        },
        coords={
            "resonance": np.arange(len(resonances)),
            "label": text(
                "resonance", [combination.label for _, combination in resonances], "Label of the resonance"
            ),
            "depth": axis,
        },
        attrs={
            "parameters": "; ".join(describe(undamped(gearbox)) for gearbox, _ in resonances),
        },
    )


def fitted_orders(data: xr.Dataset, name: str, largest_depth: float) -> FloatArray:
    """Slopes of a variable of :func:`hsu_errors` against depth, both logarithmic, for depths up to a limit."""
    small = data.sel(depth=slice(None, largest_depth))
    logarithm = np.log(small["depth"].values)
    return np.array([np.polyfit(logarithm, np.log(row), 1)[0] for row in small[name].values])


def openings(
    model: Torsional, ranges_rpm: Mapping[Combination, tuple[float, float]], depths: ArrayLike
) -> xr.Dataset:
    """Largest growth of the resonances of one mode with damping, against the depth of modulation.

    Parameters
    ----------
    model : Torsional
    ranges_rpm : mapping of Combination to tuple of float
        Each resonance of a single mode, and the speeds [rpm] between which it lies at all depths.
    depths : array_like
        ε, ascending.

    Returns
    -------
    xarray.Dataset
        Over (resonance, depth): ``growth_rate`` and ``hsu_growth`` [1/s]; over resonance: ``opening``, the depth from
        which on the tongue is open, NaN if it is not up to the last depth, and ``hsu_opening`` after (2-26), from the
        mean damping and the harmonic of the stiffness of the mode.
    """
    axis = np.asarray(depths, dtype=float)
    growth, opened, hsu = [], [], []
    for combination, limits in ranges_rpm.items():
        low, high = (float(rad_per_s(limit)) for limit in limits)
        peaks = growth_peaks(ScaledModulation(model, 1.0), "depth", axis, (low, high), method=_METHOD)
        growth.append(peaks.growth_rates)
        opened.append(next((c.value for c in peaks.closing_values if not c.closes), np.nan))
        hsu.append(_hsu_growth(model, combination, (low + high) / 2.0))
    at_rest, real = np.array(hsu).T
    hsu_growth = at_rest[:, None] + (real - at_rest)[:, None] * axis
    return xr.Dataset(
        {
            "growth_rate": _growth(("resonance", "depth"), growth, "Largest growth rate"),
            "hsu_growth": _growth(("resonance", "depth"), hsu_growth, "Largest growth rate after Hsu"),
            "opening": variable("resonance", opened, "Depth at which the tongue opens", "1", atol=1e-6),
            "hsu_opening": variable(
                "resonance", -at_rest / (real - at_rest), "Depth at which it opens after Hsu", "1", atol=1e-8
            ),
        },
        coords={
            "resonance": np.arange(len(ranges_rpm)),
            "label": text(
                "resonance", [combination.label for combination in ranges_rpm], "Label of the resonance"
            ),
            "depth": axis,
        },
        attrs={"parameters": describe(model)},
    )


def _hsu_growth(model: Torsional, combination: Combination, speed: float) -> tuple[float, float]:
    """Growth rate (2-26) of a resonance of one mode without modulation, −f/2, and at depth 1; linear between them."""
    number, s = combination.k, combination.order
    form = standard_form(model.system(speed), s)
    at_rest = -float(form.F0[number - 1, number - 1]) / 2.0
    return at_rest, form.growth_rate(number, number, "sum", s, 2.0 * float(form.frequencies[number - 1]) / s)


def relative_modulation(model: Torsional, speed: float, order: int) -> FloatArray:
    """Amplitude of each harmonic of the stiffness of the first mode over its mean, √(D² + E²)/ω1² (7-16 to 7-18).

    Parameters
    ----------
    model : Torsional
    speed : float
        Ω2 [rad/s].
    order : int
        Highest harmonic.

    Returns
    -------
    ndarray, shape (order,)
    """
    form = standard_form(model.system(positive("speed", speed, "rad/s")), integer_at_least("order", order, 1))
    return np.asarray(np.hypot(form.D[:, 0, 0], form.E[:, 0, 0]) / form.frequencies[0] ** 2)


def describe(model: Torsional) -> str:
    """Parameters of a gearbox as text, for the provenance of a figure."""
    names = (
        "correction_factor",
        "gear_inertia",
        "load_inertia",
        "input_stiffness",
        "output_stiffness",
        "mesh_damping",
        "input_damping",
        "output_damping",
    )
    return described(model, {name: name for name in names})
