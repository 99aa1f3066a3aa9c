"""Arrays of the chapter on flexible teeth, both faces and two gears, with units and tolerances."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from compendium.datasets.transverse import tongue_table
from facegear.floquet.band_speeds import band_speeds
from facegear.floquet.models import Model, parameter_path
from facegear.floquet.modified_models import Excited
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.maps.parallel import computed
from facegear.maps.response_map import frequency_response
from facegear.maps.rows import Rows
from facegear.maps.sensitivity import sensitivity
from facegear.maps.stability_map import stability_map
from facegear.maps.tracing import Tongue
from facegear.support.labelled import text, variable
from facegear.support.parameters import rad_per_s
from facegear.support.types import FloatArray

_growth = partial(variable, units="1/s", rtol=1e-6, atol=1e-3)


def growth_maps(
    models: Mapping[str, Model],
    speeds_rpm: ArrayLike,
    parameter: str,
    values: ArrayLike,
    jobs: int = -1,
    *,
    growth: Mapping[str, xr.DataArray] | None = None,
) -> xr.Dataset:
    """Growth rates of several models over speed and one parameter.

    Parameters
    ----------
    models : mapping of str to Model
    speeds_rpm : array_like
        Of the face gear [rpm].
    parameter : str
        Of all models.
    values : array_like
        Its values [its unit].
    jobs : int
    growth : mapping of str to xarray.DataArray, optional
        Maps of :func:`facegear.maps.stability_map.stability_map` of all models over these, if they are there already.

    Returns
    -------
    xarray.Dataset
        ``growth_rate`` [1/s] over (model, value, speed).
    """
    shown, taken = np.asarray(speeds_rpm, dtype=float), np.asarray(values, dtype=float)
    if growth is None:
        charts_of = _rows if taken.size == 1 else _maps
        charts = charts_of(list(models.values()), np.asarray(rad_per_s(shown)), parameter, taken, jobs)
    else:
        charts = [growth[name].values for name in models]
    return xr.Dataset(
        {"growth_rate": _growth(("model", "value", "speed"), charts, "Growth rate")},
        {
            "model": np.arange(len(models)),
            "value": taken,
            "speed": shown,
            "model_name": text("model", list(models), "Model"),
        },
        {"parameter": parameter},
    )


def _maps(
    models: Sequence[Model], speeds: FloatArray, parameter: str, values: FloatArray, jobs: int
) -> list[FloatArray]:
    """Growth rates [1/s], (value, speed) of each model."""
    return [stability_map(model, speeds, parameter, values, jobs=jobs).values for model in models]


def _rows(
    models: Sequence[Model], speeds: FloatArray, parameter: str, values: FloatArray, jobs: int
) -> list[FloatArray]:
    """As :func:`_maps` of one value: along speed, where a map would go along the parameter."""
    at, (value,) = tuple(speeds.tolist()), values.tolist()
    tasks = [Rows(model, parameter_path(model, parameter), (value,), at, None) for model in models]
    found = dict(computed(tasks, "growth rates", jobs, None, None))
    return [np.log(radii) / periods for radii, periods in (found[number] for number in range(len(tasks)))]


def growth_rows(
    models: Mapping[float, Model], speeds_rpm: ArrayLike, parameter: str, value: float, jobs: int = -1
) -> xr.Dataset:
    """Growth rates over speed of models that differ in more than one parameter, each named by a number.

    Parameters
    ----------
    models : mapping of float to Model
    speeds_rpm : array_like
        Of the face gear [rpm].
    parameter : str
        Any parameter of all models.
    value : float
        Its value.
    jobs : int

    Returns
    -------
    xarray.Dataset
        As :func:`growth_maps` of one model, over the numbers.
    """
    named = {str(number): model for number, model in models.items()}
    rows = growth_maps(named, speeds_rpm, parameter, [value], jobs).growth_rate.values[:, 0]
    return xr.Dataset(
        {"growth_rate": _growth(("model", "value", "speed"), rows[np.newaxis], "Growth rate")},
        {
            "model": [0],
            "value": np.array(list(models), dtype=float),
            "speed": np.asarray(speeds_rpm, dtype=float),
            "model_name": text("model", ["all"], "Model"),
        },
    )


def tongues_of(names: Sequence[str], found: Sequence[Sequence[Tongue]]) -> xr.Dataset:
    """Tongues of several models, each a section.

    Parameters
    ----------
    names : sequence of str
        Of the models.
    found : sequence of sequence of Tongue

    Returns
    -------
    xarray.Dataset
        As :func:`compendium.datasets.transverse.tongue_table`, with the coordinate ``model_name``.
    """
    table = tongue_table(found, np.arange(len(names)), "chapter 8")
    return table.assign_coords(model_name=text("section", list(names), "Model"))


class LookedAt(NamedTuple):
    """What Hsu's method, sensitivities and a transmission error say of a model.

    Attributes
    ----------
    predicted : int
        Its tongues that Hsu's method has by the same name.
    lever : str
        Parameter that changes the growth of the strongest tongue most, each by the same part; empty without a tongue.
    change : float
        What one percent more of it changes in the growth rate, to first order [1/s].
    resonance : str
        Label of the largest peak of the force; empty if none is known.
    speed : float
        Where it is [rad/s].
    force : float
        Root mean square of what varies of the force there [N].
    """

    predicted: int
    lever: str
    change: float
    resonance: str
    speed: float
    force: float


def looked_at(
    model: Model,
    found: Sequence[Tongue],
    parameters: Sequence[str],
    wave: PiecewiseChebyshev,
    speeds: ArrayLike,
) -> LookedAt:
    """Ask a model with known tongues for Hsu's bands, sensitivities, and the response to a transmission error.

    Parameters
    ----------
    model : Model
    found : sequence of Tongue
        Its tongues in the range of `speeds`.
    parameters : sequence of str
        Looked at for the strongest of them.
    wave : PiecewiseChebyshev
        Transmission error [m].
    speeds : array_like
        Of the response [rad/s], ascending.

    Returns
    -------
    LookedAt
    """
    at = np.asarray(speeds, dtype=float)
    bands = band_speeds(model, (float(at[0]), float(at[-1])), order=2, points=21)
    predicted = len({band.label for band in bands} & {tongue.label for tongue in found})
    lever, change = "", 0.0
    if found:
        strongest = max(found, key=lambda tongue: tongue.growth_rate)
        slopes = sensitivity(model, strongest.peak, parameters)
        changes = 0.01 * slopes.growth_rate_derivatives * slopes.values
        first = int(np.abs(changes).argmax())
        lever, change = parameters[first], float(changes[first])
    response = frequency_response(Excited(model, transmission_error=wave), at, jobs=1, progress=False)
    peaks = response.peak_force_rms.values
    if not np.isfinite(peaks).any():
        return LookedAt(predicted, lever, change, "", math.nan, math.nan)
    top = int(np.nanargmax(peaks))
    label, speed = str(response.peak_label.values[top]), float(response.peak_speed.values[top])
    return LookedAt(predicted, lever, change, label, speed, float(peaks[top]))


def shares(data: xr.Dataset) -> dict[str, tuple[float, float]]:
    """Unstable share of the cells [%] and largest growth rate [1/s] of each model of :func:`growth_maps`."""
    growth = data.growth_rate.values.reshape(data.sizes["model"], -1)
    return {
        name: (100.0 * float((row > 0.0).mean()), float(row.max()))
        for name, row in zip(data.model_name.values.tolist(), growth, strict=True)
    }
