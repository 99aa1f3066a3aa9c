"""Steady response of a model over speed, and over speed and one parameter: dynamic loads where the drive is stable."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from importlib.metadata import version
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from facegear.floquet.labels import resonance
from facegear.floquet.methods import Method
from facegear.floquet.models import Model, parameter_path, replace_parameter, require_model, system_at
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.response import SteadyResponse, steady_response
from facegear.maps.axes import checked_speeds, checked_values, require_cells, speed_coordinates
from facegear.maps.parallel import computed, parts_of
from facegear.maps.resonance_peaks import peaks_of, resonances_between
from facegear.support.parameters import number_of_workers, within
from facegear.support.threads import one_thread
from facegear.support.types import FloatArray

if TYPE_CHECKING:
    import xarray

# Speeds that are computed, and kept on disk, together.
_CHUNK = 16
# What is said of the displacement and of the force of each load, in the order of the results.
_STATISTICS = ("mean", "rms", "lowest", "highest")
_QUANTITIES = {"displacement": "u of the load", "force": "force of the load"}
# Part of its speed to which that of a peak is found.
_RESOLUTION = 1e-8
# Numbers of a speed that are the rms, the lowest and the highest value of a force.
_OF_PEAKS = slice(5, 8)


@one_thread()
def frequency_response(
    model: Model,
    speeds: ArrayLike,
    *,
    together: Sequence[Sequence[int]] | None = None,
    resolution: float = _RESOLUTION,
    method: Method | None = None,
    jobs: int = -1,
    progress: bool | None = None,
    cache_directory: str | os.PathLike[str] | None = None,
) -> xarray.Dataset:
    """Steady response of a model over speed, its peaks labelled by the resonances that make them.

    Parameters
    ----------
    model : Model
        With forces or transmission errors, such as :class:`facegear.floquet.modified_models.Excited`.
    speeds : array_like, shape (S,)
        Speeds [rad/s], greater than 0, ascending.
    together : sequence of sequence of int, optional
        Numbers of loads whose forces are added up, such as those of all tooth pairs of a mesh: "load" then numbers
        these sums, which have no displacement. Default: each load for itself.
    resolution : float
        Part of its speed to which that of a peak is found, 1e-12 to 1e-2: of its height, the square of what this is of
        its width is missing.
    method : Method, optional
        See :func:`facegear.floquet.response.steady_response`.
    jobs, progress, cache_directory
        As for :func:`facegear.maps.stability_map.stability_map`.

    Returns
    -------
    xarray.Dataset
        Along "speed" and "load", of the displacement u = φᵀq − e of each load, e its transmission error, and of its
        force, in the units of the model: mean over the period, rms of what varies, lowest and highest value. Along
        "speed": `spectral_radius`, `condition` (:class:`facegear.floquet.response.SteadyResponse`). Not a number where
        the model is unstable at that speed, or no response is known. Along "peak": speed, load, rms, lowest and highest
        value of the force, and label of the local maxima of that rms that show at the speeds, or where a natural
        frequency of the mean system meets one of the first six harmonics of the mesh between speeds too far apart to
        show it. Narrower peaks from elsewhere may be missed, and the first and last speed are none. Nor are places
        where that rms rises up to a border of instability, at which it may have no bound: attribute `at_borders` counts
        those that were met.

    Raises
    ------
    TypeError, ValueError
        Naming the argument.
    ArithmeticError
        If no response is known at any speed, saying why: a rigid-body motion, for example.

    Examples
    --------
    >>> import facegear as fg
    >>> import numpy as np
    >>> from facegear.mechanics.classical import Mathieu
    >>> wave = fg.PiecewiseChebyshev.fit(lambda x, piece: np.cos(2.0 * np.pi * x), [0.0])
    >>> model = fg.Excited(Mathieu(depth=0.1, damping_ratio=0.1), transmission_error=wave)
    >>> found = fg.frequency_response(model, np.linspace(0.6, 1.5, 19), jobs=1)
    >>> found.peak_label.values.tolist()
    ['1/1']
    """
    require_model(model)
    jobs = number_of_workers("jobs", jobs)
    speeds = checked_speeds(speeds)
    resolution = within("resolution", resolution, 1e-12, 1e-2)
    asked = _asked(system_at(model, float(speeds[0])), method, together)
    found = _computed([model], speeds, asked, jobs, progress, cache_directory)[0]
    _require_some(found, model, float(speeds[0]), method)
    between = resonances_between(model, speeds, resolution)
    # Looked for coarsely, a resonance may be where one of the speeds is.
    at, where = np.unique(np.concatenate([speeds, between]), return_index=True)
    every = np.concatenate([found, _computed([model], between, asked, jobs, progress, cache_directory)[0]])
    dataset = _dataset(found, ("speed",), speed_coordinates(speeds), model, asked)
    dataset.attrs["peaks"] = (
        "local maxima that show at the speeds, or where one of the first six harmonics of the mesh meets a natural "
        "frequency of the mean system; none at the first and last speed, nor at a border of instability"
    )

    def forces(speed: float) -> FloatArray:
        return _numbers(model, speed, asked)[:, _OF_PEAKS]

    def label(speed: float) -> str:
        response = _response(model, speed, asked)
        return "" if response is None else resonance(response).label

    peaks, dataset.attrs["at_borders"] = peaks_of(at, every[where][..., _OF_PEAKS], forces, label, resolution)
    return dataset.assign(peaks)


@one_thread()
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
    ArithmeticError
        As for :func:`frequency_response`.

    Examples
    --------
    >>> import facegear as fg
    >>> body = fg.Body(fg.Drive(26, 130, 3.175e-3), thickness_ratio=0.03)
    >>> model = fg.Transverse(body, fg.MeshLoad(stiffness=1.0, damping=3e-6, mass=1.0))
    >>> unit = fg.PiecewiseChebyshev.constant([1.0] + [0.0] * 13)
    >>> excited = fg.Excited(model, force=unit)
    >>> data = fg.response_map(excited, fg.rad_per_s([700.0, 800.0]), "stiffness", [0.5, 1.0], jobs=1)
    >>> dict(data.sizes)
    {'stiffness': 2, 'speed': 2, 'load': 1}
    """
    require_model(model)
    jobs = number_of_workers("jobs", jobs)
    speeds = checked_speeds(speeds)
    given = checked_values(values)
    require_cells(speeds, given)
    path = parameter_path(model, parameter)
    models = [replace_parameter(model, parameter, value) for value in given.tolist()]
    asked = _asked(system_at(models[0], float(speeds[0])), method)
    found = _computed(models, speeds, asked, jobs, progress, cache_directory)
    _require_some(found, models[0], float(speeds[0]), method)
    along = {path[-1]: (path[-1], given, {"long_name": ".".join(path)})}
    return _dataset(found, (path[-1], "speed"), along | speed_coordinates(speeds), model, asked)


class _Asked(NamedTuple):
    """What is asked of each speed: method, number of loads, loads whose forces are added up."""

    method: Method | None
    loads: int
    together: tuple[tuple[int, ...], ...] | None

    @property
    def rows(self) -> int:
        """Number of loads, or of their sums."""
        return self.loads if self.together is None else len(self.together)


def _asked(
    system: PeriodicSystem, method: Method | None, together: Sequence[Sequence[int]] | None = None
) -> _Asked:
    """Say what is asked of a system that has loads, and what excites it."""
    if system.force is None and all(load.transmission_error is None for load in system.loads):
        raise ValueError(
            "model must have a force or a transmission error, or it stands still; "
            "Excited(model, force=..., transmission_error=...) gives it some"
        )
    if not system.loads:
        raise ValueError("model must have a load whose response is asked for; got a system without loads")
    count = len(system.loads)
    if together is None:
        return _Asked(method, count, None)
    groups = tuple(tuple(group) for group in together)
    if not groups or any(not group or not set(group) <= set(range(count)) for group in groups):
        raise ValueError(
            f"together must list numbers of loads, 0 to {count - 1}, in one group or more, got {together!r}"
        )
    return _Asked(method, count, groups)


@dataclass(frozen=True, eq=False)
class _Chunk:
    """One model at some speeds."""

    row: int
    place: slice
    model: Model
    speeds: FloatArray
    asked: _Asked

    def content(self) -> Iterator[Any]:
        """Everything the result depends on."""
        yield repr(self.asked.method)
        if self.asked.together is not None:
            yield repr(self.asked.together)
        for speed in self.speeds.tolist():
            yield from parts_of(self.model.system(speed))

    def compute(self) -> FloatArray:
        """Return numbers of each speed, shape (speeds, rows, 10)."""
        return np.stack([_numbers(self.model, speed, self.asked) for speed in self.speeds.tolist()])


def _response(model: Model, speed: float, asked: _Asked) -> SteadyResponse | None:
    """Steady response at a speed [rad/s], or None where there is none: unstable, or a multiplier close to 1."""
    system = model.system(speed)
    if len(system.loads) != asked.loads:
        raise ValueError(
            f"model must have as many loads at all speeds and values, {asked.loads} as at the first; got "
            f"{len(system.loads)} at {speed:.6g} rad/s"
        )
    try:
        return steady_response(system, asked.method, allow_unstable=True)
    except ArithmeticError:
        return None


def _numbers(model: Model, speed: float, asked: _Asked) -> FloatArray:
    """Statistics of displacement and force of each row, spectral radius and condition, shape (rows, 10)."""
    response = _response(model, speed, asked)
    if response is None:
        return np.full((asked.rows, 10), np.nan)

    def statistics(function: Callable[[FloatArray], FloatArray]) -> list[FloatArray]:
        values = function(response.instants)
        mean = response.weights @ values
        rms = np.sqrt(response.weights @ (values - mean) ** 2)
        return [mean, rms, *response.extremes(lambda _: values)]

    def forces(x: FloatArray) -> FloatArray:
        each = response.contact_forces(x)
        if asked.together is None:
            return each
        return np.stack([each[:, list(group)].sum(axis=1) for group in asked.together], axis=1)

    if asked.together is None:
        parts = statistics(response.contact_displacements) + statistics(forces)
    else:
        parts = [np.full(asked.rows, np.nan)] * len(_STATISTICS) + statistics(forces)
    if not response.is_stable:
        parts = [np.full_like(part, np.nan) for part in parts]
    whole = (np.full_like(parts[0], number) for number in (response.spectral_radius, response.condition))
    return np.stack([*parts, *whole], axis=-1)


def _computed(
    models: Sequence[Model],
    speeds: FloatArray,
    asked: _Asked,
    jobs: int,
    progress: bool | None,
    cache_directory: str | os.PathLike[str] | None,
) -> FloatArray:
    """Numbers of all models at all speeds, shape (models, speeds, rows, 10)."""
    tasks = [
        _Chunk(row, slice(start, start + _CHUNK), model, speeds[start : start + _CHUNK], asked)
        for row, model in enumerate(models)
        for start in range(0, speeds.size, _CHUNK)
    ]
    numbers = np.empty((len(models), speeds.size, asked.rows, 10))
    for number, result in computed(tasks, "response", jobs, progress, cache_directory):
        numbers[tasks[number].row, tasks[number].place] = result
    return numbers


def _require_some(numbers: FloatArray, model: Model, speed: float, method: Method | None) -> None:
    """Where no response is known at all, raise what is said of one model at one speed."""
    if np.isnan(numbers[..., 9]).all():
        steady_response(model.system(speed), method, allow_unstable=True)


def _dataset(
    numbers: FloatArray,
    dims: tuple[str, ...],
    coordinates: dict[str, Any],
    model: Model,
    asked: _Asked,
) -> xarray.Dataset:
    import xarray

    names = [f"{quantity}_{statistic}" for quantity in _QUANTITIES for statistic in _STATISTICS]
    variables: dict[str, Any] = {}
    for number, name in enumerate(names):
        quantity, statistic = name.split("_")
        if quantity == "displacement" and asked.together is not None:
            continue
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
            "method": "default method" if asked.method is None else repr(asked.method),
            "facegear_version": version("facegear"),
        },
    )
