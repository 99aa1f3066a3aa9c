"""Steady response of a model over speed, and over speed and one parameter: dynamic loads where the drive is stable."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib.metadata import version
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from facegear.floquet.labels import resonance
from facegear.floquet.models import Model, parameter_path, replace_parameter, require_model
from facegear.floquet.multipliers import Method
from facegear.floquet.response import SteadyResponse, steady_response
from facegear.maps.parallel import computed, parts_of
from facegear.maps.peaks import largest_between
from facegear.maps.stability_map import checked_speeds, speed_coordinates
from facegear.support.parameters import finite_array, number_of_workers
from facegear.support.types import FloatArray

if TYPE_CHECKING:
    import xarray

# Speeds that are computed, and kept on disk, together.
_CHUNK = 16
# What is said of the displacement and of the force of each load, in the order of the results.
_STATISTICS = ("mean", "rms", "lowest", "highest")
_QUANTITIES = {"displacement": "u of the load", "force": "force of the load"}
# Part of the distance of neighbouring speeds to which the speed of a peak is found.
_RESOLUTION = 1e-4


def frequency_response(
    model: Model,
    speeds: ArrayLike,
    *,
    method: Method | None = None,
    jobs: int = -1,
    progress: bool | None = None,
    cache_directory: str | os.PathLike[str] | None = None,
) -> xarray.Dataset:
    """Steady response of a model over speed, its peaks labelled by the resonances that make them.

    Parameters
    ----------
    model : Model
        With forces or transmission errors, such as :class:`facegear.floquet.models.Excited`.
    speeds : array_like, shape (S,)
        Speeds [rad/s], greater than 0, ascending.
    method : Method, optional
        See :func:`facegear.floquet.response.steady_response`.
    jobs, progress, cache_directory
        As for :func:`facegear.maps.stability_map.stability_map`.

    Returns
    -------
    xarray.Dataset
        Along "speed" and "load", of the displacement u of each load and of its force, in the units of the model: mean
        over the period, rms of what varies, lowest and highest value. Along "speed": `spectral_radius`, `condition`
        (:class:`facegear.floquet.response.SteadyResponse`). Not a number where the model is unstable at that speed, or
        no response is known. Along "peak": speed, load, rms of the force and label of every local maximum of that rms.

    Raises
    ------
    TypeError, ValueError
        Naming the argument.

    Examples
    --------
    >>> from facegear.floquet.models import Excited
    >>> from facegear.floquet.piecewise import PiecewiseChebyshev
    >>> from facegear.mechanics.classical import Mathieu
    >>> wave = PiecewiseChebyshev.fit(lambda x, piece: np.cos(2.0 * np.pi * x), [0.0])
    >>> model = Excited(Mathieu(depth=0.1, damping_ratio=0.1), transmission_error=wave)
    >>> found = frequency_response(model, np.linspace(0.6, 1.5, 19), jobs=1)
    >>> found.peak_label.values.tolist()
    ['1/1']
    """
    require_model(model)
    jobs = number_of_workers("jobs", jobs)
    speeds = checked_speeds(speeds)
    _require_excitation(model.system(float(speeds[0])))
    found = _computed([model], speeds, method, jobs, progress, cache_directory)[0]
    dataset = _dataset(found, ("speed",), speed_coordinates(speeds), model, method)
    return dataset.assign(_peaks(model, speeds, dataset, method))


def response_map(
    model: Model,
    speeds: ArrayLike,
    parameter: str,
    values: ArrayLike,
    *,
    method: Method | None = None,
    jobs: int = -1,
    progress: bool | None = None,
    cache_directory: str | os.PathLike[str] | None = None,
) -> xarray.Dataset:
    """Steady response of a model over speed and one of its parameters.

    Parameters
    ----------
    model, speeds, method, jobs, progress, cache_directory
        As for :func:`frequency_response`.
    parameter : str
        Name as for :func:`facegear.floquet.models.replace_parameter`.
    values : array_like, shape (V,)
        In the unit of its field.

    Returns
    -------
    xarray.Dataset
        As :func:`frequency_response` without peaks, the parameter as the first dimension.

    Raises
    ------
    TypeError, ValueError
        Naming the argument.
    """
    require_model(model)
    jobs = number_of_workers("jobs", jobs)
    speeds = checked_speeds(speeds)
    given = finite_array("values", values)
    if given.ndim != 1 or given.size == 0:
        raise ValueError(f"values must list at least one value of the parameter, got shape {given.shape}")
    path = parameter_path(model, parameter)
    models = [replace_parameter(model, parameter, value) for value in given.tolist()]
    _require_excitation(models[0].system(float(speeds[0])))
    found = _computed(models, speeds, method, jobs, progress, cache_directory)
    along = {path[-1]: (path[-1], given, {"long_name": ".".join(path)})}
    return _dataset(found, (path[-1], "speed"), along | speed_coordinates(speeds), model, method)


def _require_excitation(system: Any) -> None:
    if system.force is None and all(load.transmission_error is None for load in system.loads):
        raise ValueError(
            "model must have a force or a transmission error, or it stands still; "
            "Excited(model, force=..., transmission_error=...) gives it some"
        )
    if not system.loads:
        raise ValueError("model must have a load whose response is asked for; got a system without loads")


@dataclass(frozen=True, eq=False)
class _Chunk:
    """One model at some speeds."""

    row: int
    place: slice
    model: Model
    speeds: FloatArray
    method: Method | None

    def content(self) -> Iterator[Any]:
        """Everything the result depends on."""
        yield repr(self.method)
        for speed in self.speeds.tolist():
            yield from parts_of(self.model.system(speed))

    def compute(self) -> FloatArray:
        """Return numbers of each speed, shape (speeds, loads, 10)."""
        return np.stack([_numbers(self.model, speed, self.method) for speed in self.speeds.tolist()])


def _response(model: Model, speed: float, method: Method | None) -> SteadyResponse | None:
    """Steady response at a speed [rad/s], or None where there is none: unstable, or a multiplier close to 1."""
    try:
        return steady_response(model.system(speed), method, allow_unstable=True)
    except ArithmeticError:
        return None


def _numbers(model: Model, speed: float, method: Method | None) -> FloatArray:
    """Statistics of displacement and force of each load, spectral radius and condition, shape (loads, 10)."""
    response = _response(model, speed, method)
    if response is None:
        return np.full((len(model.system(speed).loads), 10), np.nan)
    x = response.instants
    parts = []
    for function in (response.contact_displacements, response.contact_forces):
        values = function(x)
        mean = response.weights @ values
        rms = np.sqrt(response.weights @ (values - mean) ** 2)
        ends = [function(response.state.breakpoints, side) for side in ("left", "right")]
        every = np.concatenate([values, *ends])
        parts += [mean, rms, every.min(axis=0), every.max(axis=0)]
    if not response.is_stable:
        parts = [np.full_like(part, np.nan) for part in parts]
    whole = (np.full_like(parts[0], number) for number in (response.spectral_radius, response.condition))
    return np.stack([*parts, *whole], axis=-1)


def _computed(
    models: Sequence[Model],
    speeds: FloatArray,
    method: Method | None,
    jobs: int,
    progress: bool | None,
    cache_directory: str | os.PathLike[str] | None,
) -> FloatArray:
    """Numbers of all models at all speeds, shape (models, speeds, loads, 10)."""
    tasks = [
        _Chunk(row, slice(start, start + _CHUNK), model, speeds[start : start + _CHUNK], method)
        for row, model in enumerate(models)
        for start in range(0, speeds.size, _CHUNK)
    ]
    loads = len(models[0].system(float(speeds[0])).loads)
    numbers = np.empty((len(models), speeds.size, loads, 10))
    for number, result in computed(tasks, "response", jobs, progress, cache_directory):
        numbers[tasks[number].row, tasks[number].place] = result
    return numbers


def _dataset(
    numbers: FloatArray,
    dims: tuple[str, ...],
    coordinates: dict[str, Any],
    model: Model,
    method: Method | None,
) -> xarray.Dataset:
    import xarray

    names = [f"{quantity}_{statistic}" for quantity in _QUANTITIES for statistic in _STATISTICS]
    variables: dict[str, Any] = {}
    for number, name in enumerate(names):
        quantity, statistic = name.split("_")
        text = f"{statistic} of the varying part" if statistic == "rms" else statistic
        described = {"long_name": f"{_QUANTITIES[quantity]}, {text} over the period"}
        variables[name] = ((*dims, "load"), numbers[..., number], described)
    variables["spectral_radius"] = (dims, numbers[..., 0, 8], {"units": "1", "long_name": "max|λ|"})
    variables["condition"] = (dims, numbers[..., 0, 9], {"units": "1", "long_name": "condition of I − Φ"})
    return xarray.Dataset(
        variables,
        coords=coordinates | {"load": np.arange(numbers.shape[-2])},
        attrs={
            "model": repr(model),
            "method": "default method" if method is None else repr(method),
            "facegear_version": version("facegear"),
        },
    )


def _peaks(model: Model, speeds: FloatArray, found: xarray.Dataset, method: Method | None) -> dict[str, Any]:
    """Local maxima of the rms of each load's force over speed, each found between its neighbours and labelled."""
    peaks: list[tuple[float, int, float, str]] = []
    for load in found["load"].values.tolist():
        rms = found.force_rms.sel(load=load).values
        for i in range(1, speeds.size - 1):
            if not (rms[i] > rms[i - 1] and rms[i] >= rms[i + 1]):
                continue

            def height(speed: float, load: int = load) -> float:
                return float(np.nan_to_num(_numbers(model, speed, method)[load, 5]))

            low, high = float(speeds[i - 1]), float(speeds[i + 1])
            speed, value = largest_between(height, low, high, _RESOLUTION * (high - low))
            response = _response(model, speed, method)
            label = "" if response is None else resonance(response).label
            peaks.append((speed, load, value, label))
    peaks.sort()
    columns = [list(column) for column in zip(*peaks, strict=True)] if peaks else [[], [], [], []]
    at, loads, values, labels = columns
    return {
        "peak_speed": ("peak", np.array(at, dtype=float), {"units": "rad/s", "long_name": "speed of a peak"}),
        "peak_load": ("peak", np.array(loads, dtype=int), {"long_name": "load"}),
        "peak_force_rms": (
            "peak",
            np.array(values, dtype=float),
            {"long_name": "rms of the force's varying part"},
        ),
        "peak_label": (
            "peak",
            np.array(labels, dtype=str),
            {"long_name": "number of the mode / harmonic of the mesh"},
        ),
    }
