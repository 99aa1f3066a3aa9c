"""What each design variable does to every tongue, and to what stands between: section 8.1 as arrays."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from operator import attrgetter
from typing import Any

import numpy as np
import xarray as xr

from facegear.design.changes import Change, possible_changes, scaled, slopes_of_tongues
from facegear.design.teeth import constant_pitch_radius
from facegear.floquet.models import Model, replace_at
from facegear.maps.tracing import Tongue, tongues
from facegear.mechanics.transverse import Transverse
from facegear.support.labelled import text, variable
from facegear.support.parameters import rad_per_s, rpm

_relative = partial(variable, units="%/%", rtol=1e-3, atol=2e-4)
_speed = partial(variable, units="rpm", rtol=1e-7, atol=1e-4)

# Half the difference over which quantities are differentiated.
_STEP = 1e-4
# Tongues narrower than this part of their speed are about to close: their widths are known to few digits.
_NARROW = 1e-3


def of_the_teeth(path: tuple[str, ...]) -> tuple[Change, ...]:
    """List changes of module, pressure angle and contact ratio of a model, each with the others kept.

    Parameters
    ----------
    path : tuple of str
        Leads from the model to its drive.

    Returns
    -------
    tuple of Change
    """

    def longer(model: Any, change: float) -> Any:
        ratio = model.contact.ratio(attrgetter(".".join(path))(model)) * (1.0 + change)
        return replace(model, contact=replace(model.contact, contact_ratio=ratio))

    return (
        Change("module", partial(scaled, path=(*path, "module"))),
        Change("pressure angle", partial(scaled, path=(*path, "pressure_angle"))),
        Change("contact ratio alone", longer),
    )


def levers(
    cases: Mapping[str, Model], further: Sequence[Change], speeds_rpm: tuple[float, float]
) -> xr.Dataset:
    """Differentiate place, width and growth of every tongue by every design variable.

    Parameters
    ----------
    cases : mapping of str to Model
    further : sequence of Change
        Changes beside those that each model's own parameters allow.
    speeds_rpm : tuple of float
        Lowest and highest speed [rpm]; tongues cut off there are left out, and those narrower than a thousandth of
        their speed.

    Returns
    -------
    xarray.Dataset
        Over (tongue, change): ``centre_change``, ``width_change``, ``growth_change``, percent by which the middle speed
        of a tongue, its width and its largest growth rate grow for a percent more, NaN where the model has no such
        variable; of a phase, for a hundredth of the mesh period. Over tongue: ``lower``, ``upper`` [rpm], ``growth``
        [1/s]; case and label in ``case_name`` and ``label``. Variables in ``change_name``, in the order in which
        models name them.
    """
    low, high = (float(rad_per_s(limit)) for limit in speeds_rpm)
    found = {name: _whole(model, low, high) for name, model in cases.items()}
    changes = {name: (*possible_changes(model), *further) for name, model in cases.items()}
    columns = list(dict.fromkeys(change.name for each in changes.values() for change in each))
    rows = [(name, tongue) for name, here in found.items() for tongue in here]
    slopes = np.full((len(columns), len(rows), 3), np.nan)
    for name, model in cases.items():
        places = [i for i, (case, _) in enumerate(rows) if case == name]
        order = [columns.index(change.name) for change in changes[name]]
        slopes[np.ix_(order, places)] = slopes_of_tongues(model, changes[name], found[name], (low, high))
    lower, upper, growth = np.array([(each.lower, each.upper, each.growth_rate) for _, each in rows]).T
    both = ("tongue", "change")
    return xr.Dataset(
        {
            "centre_change": _relative(
                both,
                ((slopes[..., 0] + slopes[..., 1]) / (lower + upper)).T,
                "Relative change of the middle speed",
            ),
            "width_change": _relative(
                both, ((slopes[..., 1] - slopes[..., 0]) / (upper - lower)).T, "Relative change of the width"
            ),
            "growth_change": _relative(
                both, (slopes[..., 2] / growth).T, "Relative change of the largest growth rate"
            ),
            "lower": _speed("tongue", rpm(lower), "Lower border"),
            "upper": _speed("tongue", rpm(upper), "Upper border"),
            "growth": variable("tongue", growth, "Largest growth rate", "1/s", rtol=1e-6, atol=1e-4),
        },
        coords={
            "tongue": np.arange(len(rows)),
            "case_name": text("tongue", [name for name, _ in rows], "Drive"),
            "label": text("tongue", [tongue.label for _, tongue in rows], "Label of the tongue"),
            "change": np.arange(len(columns)),
            "change_name": text("change", columns, "What is changed"),
        },
        attrs={"parameters": f"{', '.join(cases)}; {speeds_rpm[0]:g} to {speeds_rpm[1]:g} rpm"},
    )


def _whole(model: Model, low: float, high: float) -> tuple[Tongue, ...]:
    """Tongues between two speeds [rad/s] that end inside, without those about to close."""
    found = tongues(model, (low, high))
    return tuple(
        each for each in found if low < each.lower and each.upper < high and each.width > _NARROW * each.upper
    )


def one_more_tooth(cases: Mapping[str, Transverse], speeds_rpm: tuple[float, float]) -> xr.Dataset:
    """Give the pinion one tooth more, and the gear as many as keep the ratio, and look for every tongue again.

    Parameters
    ----------
    cases : mapping of str to Transverse
        Drives of a ratio that is a whole number. Angles between pinions are kept.
    speeds_rpm : tuple of float
        Lowest and highest speed [rpm].

    Returns
    -------
    xarray.Dataset
        Over (tongue, family), the families "constant diametral pitch" and "constant pitch radius" (section 4.7):
        ``centre_change``, ``width_change``, percent of change, NaN where the tongue is gone or ends beyond the speeds;
        labels as in :func:`levers`.
    """
    low, high = (float(rad_per_s(limit)) for limit in speeds_rpm)
    families: tuple[str, str] = ("constant diametral pitch", "constant pitch radius")
    names, labels, changes = [], [], []
    for name, model in cases.items():
        teeth = model.body.drive
        ratio = teeth.gear_teeth // teeth.pinion_teeth
        more = replace(
            teeth, pinion_teeth=teeth.pinion_teeth + 1, gear_teeth=ratio * (teeth.pinion_teeth + 1)
        )
        finer = constant_pitch_radius(more.pinion_teeth, teeth.pinion_teeth * teeth.module / 2.0, ratio)
        after = [
            {each.label: each for each in _whole(replace_at(model, ("body", "drive"), drive), low, high)}
            for drive in (more, replace(more, module=finer.module))
        ]
        for before in _whole(model, low, high):
            names.append(name)
            labels.append(before.label)
            changes.append([_percent(before, found.get(before.label)) for found in after])
    table = np.reshape(changes, (len(names), len(families), 2))
    both = ("tongue", "family")
    percent = partial(variable, units="%", rtol=1e-5, atol=1e-4)
    return xr.Dataset(
        {
            "centre_change": percent(both, table[..., 0], "Change of the middle speed"),
            "width_change": percent(both, table[..., 1], "Change of the width"),
        },
        coords={
            "tongue": np.arange(len(names)),
            "case_name": text("tongue", names, "Drive"),
            "label": text("tongue", labels, "Label of the tongue"),
            "family": np.arange(len(families)),
            "family_name": text("family", families, "What is kept"),
        },
        attrs={"parameters": f"{', '.join(cases)}; {speeds_rpm[0]:g} to {speeds_rpm[1]:g} rpm"},
    )


def _percent(before: Tongue, after: Tongue | None) -> tuple[float, float]:
    if after is None:
        return np.nan, np.nan
    middle = (after.lower + after.upper) / (before.lower + before.upper)
    return 100.0 * (middle - 1.0), 100.0 * (after.width / before.width - 1.0)


def followed(
    model: Model, changes: Sequence[Change], size: float, table: xr.Dataset, speeds_rpm: tuple[float, float]
) -> xr.Dataset:
    """Make each change in earnest and look for the tongues of a table of levers again.

    Parameters
    ----------
    model : Model
    changes : sequence of Change
        Those of the table, in its order.
    size : float
        Relative change, such as 0.1.
    table : xarray.Dataset
        From :func:`levers`, of this model alone.
    speeds_rpm : tuple of float
        Lowest and highest speed [rpm].

    Returns
    -------
    xarray.Dataset
        Over (tongue, change): ``centre_change``, ``width_change``, found over `size`, to be held against those of the
        table; NaN where the tongue is gone, is about to close, or ends beyond the speeds.
    """
    low, high = (float(rad_per_s(limit)) for limit in speeds_rpm)
    found = np.full((2, table.sizes["tongue"], len(changes)), np.nan)
    lower, upper = rad_per_s(table["lower"].values), rad_per_s(table["upper"].values)
    for column, change in enumerate(changes):
        after = {each.label: each for each in _whole(change.apply(model, size), low, high)}
        for row, label in enumerate(table["label"].values.tolist()):
            if label in after:
                tongue = after[label]
                middle = (tongue.lower + tongue.upper) / (lower[row] + upper[row])
                width = tongue.width / (upper[row] - lower[row])
                found[:, row, column] = (middle - 1.0) / size, (width - 1.0) / size
    both = ("tongue", "change")
    return xr.Dataset(
        {
            "centre_change": _relative(
                both, found[0], "Change of the middle speed over that of the variable"
            ),
            "width_change": _relative(both, found[1], "Change of the width over that of the variable"),
        },
        coords={name: table[name] for name in ("tongue", "label", "change", "change_name")},
        attrs={"parameters": f"{size:g} of each variable; {speeds_rpm[0]:g} to {speeds_rpm[1]:g} rpm"},
    )


def arrows(
    model: Model, changes: Sequence[Change], quantities: Mapping[str, Callable[[Any], float]]
) -> xr.Dataset:
    """Differentiate what stands between a design variable and stability.

    Parameters
    ----------
    model : Model
    changes : sequence of Change
    quantities : mapping of str to callable
        What each is for a model; other than 0 for the one given.

    Returns
    -------
    xarray.Dataset
        Over (change, quantity): ``change_of``, percent for a percent.

    Raises
    ------
    ValueError
        If the model refuses a change in one of the directions.
    """
    table = np.empty((len(changes), len(quantities)))
    for row, change in zip(table, changes, strict=True):
        more, less = (change.apply(model, sign * _STEP) for sign in (1, -1))
        for place, quantity in enumerate(quantities.values()):
            row[place] = (quantity(more) - quantity(less)) / (2.0 * _STEP * quantity(model))
    return xr.Dataset(
        {"change_of": _relative(("change", "quantity"), table, "Relative change")},
        coords={
            "change": np.arange(len(changes)),
            "change_name": text("change", [change.name for change in changes], "What is changed"),
            "quantity": np.arange(len(quantities)),
            "quantity_name": text("quantity", list(quantities), "What changes with it"),
        },
    )
