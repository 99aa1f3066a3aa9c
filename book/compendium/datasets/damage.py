"""Arrays of the chapter on damage, with units and tolerances."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from facegear.design.identification import Survey, bound_together
from facegear.design.measurements import drawn
from facegear.design.tooth_search import SlotFilter, share_interval, without_common
from facegear.floquet.hill import apart, exponents
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.response import steady_response
from facegear.mechanics.tooth_damage import DamagedTooth
from facegear.support.labelled import text, variable
from facegear.support.types import ComplexArray, FloatArray

Route = Callable[[PeriodicSystem, int], ComplexArray]

# Errors below this are shown as this: rounding differs from machine to machine.
_FLOOR = 1e-11


def convergence(
    systems: Mapping[str, PeriodicSystem], routes: Mapping[str, Route], harmonics: ArrayLike
) -> xr.Dataset:
    """Largest error of the exponents from Hill's matrix, against those of the transition matrix.

    Parameters
    ----------
    systems, routes : mapping of str
    harmonics : array_like of int
    """
    numbers = np.asarray(harmonics, dtype=int)
    errors = np.empty((len(systems), len(routes), numbers.size))
    truth = [exponents(system) for system in systems.values()]
    for i, (system, exact) in enumerate(zip(systems.values(), truth, strict=True)):
        for j, route in enumerate(routes.values()):
            errors[i, j] = [
                apart(route(system, count), exact, system.period).max() for count in numbers.tolist()
            ]
    slowest = np.array([values[np.argmax(values.imag)] for values in truth])
    return xr.Dataset(
        {
            "error": variable(
                ("system", "method", "harmonics"),
                np.maximum(errors, _FLOOR),
                "Largest error",
                "1/s",
                rtol=0.02,
            ),
            "decay": variable("system", slowest.real, "Real part of an exponent", "1/s", atol=1e-10),
            "frequency": variable("system", slowest.imag, "Its imaginary part", "rad/s", atol=1e-10),
        },
        {
            "harmonics": numbers,
            "system": np.arange(len(systems)),
            "kind": text("system", list(systems), "System"),
            "route": text("method", list(routes), "How exponents are taken from the matrix"),
        },
    )


def orders(data: xr.Dataset, least: int) -> FloatArray:
    """Order of each error from `least` harmonics on, fitted above the floor, shape (kinds, routes)."""
    shown = data.sel(harmonics=slice(least, None))
    log_harmonics = np.log(shown.harmonics.values)
    found = np.full(shown.error.shape[:2], np.nan)
    for i, j in np.ndindex(*found.shape):
        errors = shown.error.values[i, j]
        kept = errors > 3.0 * _FLOOR
        if kept.sum() >= 3:
            found[i, j] = -np.polyfit(log_harmonics[kept], np.log(errors[kept]), 1)[0]
    return found


def frequencies(survey: Survey, losses: ArrayLike) -> xr.Dataset:
    """Frequencies and decay rates of all measured motions over the loss of one parameter at a time, and tangents.

    Parameters
    ----------
    survey : Survey
    losses : array_like
        From 0 on [-].
    """
    values = np.asarray(losses, dtype=float)
    count = len(survey.parameters)
    found = np.empty((count, len(survey.motions), values.size), dtype=complex)
    intact, slopes = survey.expected(np.zeros(count))
    for number, unit in enumerate(np.eye(count)):
        for column, loss in enumerate(values.tolist()):
            found[number, :, column] = survey.expected(loss * unit)[0]
    shift = found - intact[:, None]
    dims = ("part", "motion", "loss")
    return xr.Dataset(
        {
            "frequency_change": variable(
                dims, shift.imag, "Change of the frequency", "rad/s", rtol=1e-6, atol=1e-5
            ),
            "decay_change": variable(
                dims, shift.real, "Change of the real part of the exponent", "1/s", rtol=1e-6, atol=1e-5
            ),
            "frequency_slope": variable(
                dims[:2], slopes.imag.T, "Change of the frequency by the loss", "rad/s", rtol=1e-6, atol=1e-4
            ),
        },
        {
            "loss": values,
            "motion": np.arange(1, len(survey.motions) + 1),
            **_parts(survey),
        },
    )


def _parts(survey: Survey) -> dict[str, Any]:
    """Coordinates that name the parameters of a survey."""
    words = text("part", survey.parameters, "What has lost stiffness")
    return {"part": np.arange(len(survey.parameters)), "parameter": words}


def clouds(survey: Survey, losses: ArrayLike, count: int, seed: int) -> xr.Dataset:
    """Losses told from noisy measurements, and the Cramér–Rao bound of their covariance.

    Parameters
    ----------
    survey : Survey
    losses : array_like, shape (P,)
        The true ones.
    count, seed : int
        Number of measurements, each with other errors.
    """
    truth = np.asarray(losses, dtype=float)
    measured = drawn(survey.expected(truth)[0], survey.deviations, count, seed)
    told = np.array([survey.identified(values, truth) for values in measured])
    dims = ("part", "other_part")
    return xr.Dataset(
        {
            "told": variable(("measurement", "part"), told, "Loss that fits best", "1", atol=1e-6),
            "truth": variable("part", truth, "Loss", "1"),
            "bound": variable(dims, survey.bound(truth), "Cramér–Rao bound", "1", rtol=1e-5, atol=1e-11),
        },
        {
            "measurement": np.arange(count),
            "other_part": np.arange(truth.size),
            **_parts(survey),
        },
    )


def deviations(surveys: Mapping[str, Sequence[Survey]], losses: ArrayLike) -> xr.Dataset:
    """Least standard deviation of each loss, by what is measured; not a number where some mix is not told.

    Parameters
    ----------
    surveys : mapping of str to sequence of Survey
        Those that are evaluated together, all of the same parameters.
    losses : array_like, shape (P,)
    """
    first = next(iter(surveys.values()))[0]
    rows = []
    for together in surveys.values():
        try:
            rows.append(np.sqrt(np.diag(bound_together(together, losses))))
        except ValueError:
            rows.append(np.full(len(first.parameters), np.nan))
    return xr.Dataset(
        {
            "deviation": variable(
                ("survey", "part"), rows, "Least standard deviation of a loss", "1", rtol=1e-4
            ),
        },
        {
            "survey": np.arange(len(surveys)),
            "measured": text("survey", list(surveys), "What is measured"),
            **_parts(first),
        },
    )


def sidebands(models: Sequence[DamagedTooth], speed: float, order: int, coordinate: int) -> xr.Dataset:
    """Harmonics of the revolution in a coordinate, for several damaged teeth and the intact gearbox.

    Parameters
    ----------
    models : sequence of DamagedTooth
        The same but for the tooth.
    speed : float
        [rad/s].
    order : int
        Highest harmonic.
    coordinate : int
    """
    first = models[0]
    intact = steady_response(first.pressed(speed).repeated(first.teeth)).harmonics(order)[:, coordinate]
    found = np.array(
        [steady_response(model.system(speed)).harmonics(order)[:, coordinate] for model in models]
    )
    size = float(np.abs(found[:, 1:]).max())
    dims = ("tooth", "harmonic")
    small = 1e-8 * size
    return xr.Dataset(
        {
            "intact": variable("harmonic", np.abs(intact[1:]), "Amplitude, intact", "rad", atol=small),
            "amplitude_real": variable(
                dims, found[:, 1:].real, "Amplitude, cosine", "rad", rtol=1e-6, atol=small
            ),
            "amplitude_imaginary": variable(
                dims, found[:, 1:].imag, "Amplitude, sine", "rad", rtol=1e-6, atol=small
            ),
        },
        {"tooth": [model.tooth for model in models], "harmonic": np.arange(1, order + 1)},
        {"teeth": first.teeth},
    )


def hit_rates(
    pattern: FloatArray, signal: FloatArray, slot: int, noises: ArrayLike, trials: int, seed: int
) -> xr.Dataset:
    """How often the matched filter finds the slot, and what it says of the amount, against noise.

    Parameters
    ----------
    pattern : array, shape (N, S)
        What the filter looks for: damage at slot 0.
    signal : array, shape (N, S)
        What is there without noise.
    slot : int
        The right one.
    noises : array_like
        Standard deviations of the noise over the root mean square of the pattern.
    trials, seed : int
        Of each noise.
    """
    search, levels = SlotFilter(pattern), np.asarray(noises, dtype=float)
    size = float(np.sqrt(search.energy / pattern.size))
    rest, rng = without_common(signal), np.random.default_rng(seed)
    rows = []
    for level in levels.tolist():
        noisy = rest + level * size * rng.normal(size=(trials, *rest.shape))
        slots, amounts = search.found(noisy)
        right = slots == slot
        known = search.projections(noisy)[:, slot] / search.energy
        rows.append(
            (
                right.mean(),
                *share_interval(int(right.sum()), trials),
                *search.hit_rate_bounds(level * size),
                known.mean(),
                known.std(),
                amounts.mean(),
                search.amount_deviation(level * size),
            )
        )
    columns = np.array(rows).T
    names = (
        ("hits", "Share of trials in which the tooth is found"),
        ("low", "Lower end of its interval of 95 %"),
        ("high", "Upper end of its interval of 95 %"),
        ("least", "Least probability, by the sum of all pairs"),
        ("most", "Largest probability, by the nearest pair"),
        ("amount", "Mean estimate of the severity, tooth known"),
        ("scatter", "Standard deviation of the estimate, tooth known"),
        ("amount_found", "Mean estimate of the severity, tooth as found"),
        ("bound", "Cramér–Rao bound of that deviation"),
    )
    # One trial of some hundreds may turn on rounding.
    shares = {"hits", "low", "high"}
    data = {
        name: variable("noise", column, words, "1", atol=2.0 / trials if name in shares else 1e-7)
        for (name, words), column in zip(names, columns, strict=True)
    }
    return xr.Dataset(data, {"noise": levels}, {"trials": trials, "slots": len(pattern)})
