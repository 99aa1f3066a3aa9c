"""Arrays of what contact under load makes of stability and of dynamic loads, with units and tolerances."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from compendium.datasets.contact_load import cut_by_larger_shaper
from compendium.datasets.meshing import describe
from facegear.floquet.models import replace_parameter
from facegear.floquet.modified_models import Excited
from facegear.maps.parallel import in_processes
from facegear.maps.response_map import frequency_response
from facegear.maps.stability_map import stability_map
from facegear.maps.tracing import tongues
from facegear.mechanics.contact import Contact
from facegear.mechanics.paths import loaded_contact
from facegear.mechanics.torsional import Gearbox, Torsional
from facegear.mechanics.transverse import Transverse
from facegear.support.labelled import text, variable
from facegear.support.parameters import rad_per_s, rpm
from facegear.support.types import FloatArray

_length = partial(variable, units="m", atol=1e-10)
_number = partial(variable, units="1", atol=1e-9)
_speed = partial(variable, units="rpm", rtol=1e-7, atol=1e-4)
_growth = partial(variable, units="1/s", rtol=1e-6, atol=1e-3)


def _axis(speeds_rpm: ArrayLike) -> tuple[FloatArray, FloatArray]:
    speeds = np.asarray(speeds_rpm, dtype=float)
    return speeds, np.asarray(rad_per_s(speeds))


def torque_map(model: Transverse, speeds_rpm: ArrayLike, torques: ArrayLike, jobs: int = -1) -> xr.Dataset:
    """Growth rates over speed and torque.

    Parameters
    ----------
    model : Transverse
        Its contact is a :class:`loaded_contact`.
    speeds_rpm : array_like
        Of the face gear [rpm].
    torques : array_like
        At the pinion [N m].
    jobs : int

    Returns
    -------
    xarray.Dataset
        ``growth_rate`` [1/s] over (torque, speed), ``contact_ratio`` over (torque).
    """
    shown, speeds = _axis(speeds_rpm)
    torques = np.asarray(torques, dtype=float)
    chart = stability_map(model, speeds, "torque", torques, jobs=jobs)
    ratios = [replace_parameter(model, "torque", float(torque)).contact_ratio for torque in torques]
    return xr.Dataset(
        {
            "growth_rate": _growth(("torque", "speed"), chart.values, "Growth rate"),
            "contact_ratio": _number("torque", ratios, "Effective contact ratio"),
        },
        {"torque": torques, "speed": shown},
        {"parameters": describe(model.body.drive)},
    )


def unstable_shares(
    contacts: Mapping[str, Sequence[Transverse]],
    speeds_rpm: ArrayLike,
    parameter: str,
    values: Sequence[ArrayLike],
    jobs: int = -1,
) -> xr.Dataset:
    """How much of a map of speed and one parameter is unstable, for several contacts of several drives.

    Parameters
    ----------
    contacts : mapping of str to sequence of Transverse
        Name of a contact, and the models of all drives with it.
    speeds_rpm : array_like
        Of the face gear [rpm].
    parameter : str
    values : sequence of array_like
        Of the parameter, for each drive; as many of each.
    jobs : int

    Returns
    -------
    xarray.Dataset
        ``unstable``, share of the cells, ``largest`` growth rate [1/s] of all cells and where, over (contact, drive).
    """
    shown, speeds = _axis(speeds_rpm)
    charts = np.array(
        [
            [
                stability_map(model, speeds, parameter, rows, jobs=jobs).values
                for model, rows in zip(models, values, strict=True)
            ]
            for models in contacts.values()
        ]
    )
    flat = charts.reshape(*charts.shape[:2], -1)
    where = flat.argmax(axis=-1)
    both = ("contact", "drive")
    cell = 1.0 / flat.shape[-1]
    ratios = [[model.contact_ratio for model in models] for models in contacts.values()]
    columns = np.array([np.asarray(rows, dtype=float) for rows in values])
    return xr.Dataset(
        {
            # Cells next to a border may fall on either side of it.
            "unstable": variable(both, (flat > 0.0).mean(axis=-1), "Unstable share", "1", atol=3.0 * cell),
            "largest": _growth(both, flat.max(axis=-1), "Largest growth rate"),
            "contact_ratio": _number(both, ratios, "Contact ratio"),
        },
        {
            "contact": np.arange(len(contacts)),
            "drive": np.arange(len(values)),
            "speed_of_largest": (both, shown[where % shown.size]),
            "value_of_largest": (both, columns[np.arange(len(values)), where // shown.size]),
            "contact_name": text("contact", list(contacts), "Contact"),
        },
        {"parameter": parameter},
    )


def loaded_gearbox(gearbox: Gearbox, path: loaded_contact) -> Torsional:
    """Gearbox cut by a shaper with one tooth more, on the clock of its load, with the constant lever of true teeth.

    With that lever one load that has the stiffness of the whole mesh does what the loads of all pairs do.
    """
    cut = replace(gearbox, drive=cut_by_larger_shaper(gearbox.drive))
    return Torsional(cut, Contact(path=path, rate="total"), arm="conjugate")


def load_place(models: Mapping[str, Transverse], instants: int = 300) -> xr.Dataset:
    """Radius of the load on the disk over a mesh period.

    Parameters
    ----------
    models : mapping of str to Transverse
        With one load each.
    instants : int

    Returns
    -------
    xarray.Dataset
        ``radius`` [m] over (contact, time).
    """
    time = np.arange(instants) / instants
    radii = []
    for model in models.values():
        (place,) = model.contact.places(model.body.drive)
        radii.append(place.position(time)[:, 0] * model.body.outer_radius)
    return xr.Dataset(
        {"radius": _length(("contact", "time"), radii, "Radius of the load")},
        {
            "contact": np.arange(len(models)),
            "time": time,
            "contact_name": text("contact", list(models), "Contact"),
        },
    )


def gearbox_growth(
    models: Mapping[str, Mapping[str, Torsional]], speeds_rpm: ArrayLike, jobs: int = -1
) -> xr.Dataset:
    """Unstable share of a range of speeds and largest growth rate of gearboxes with several contacts.

    Parameters
    ----------
    models : mapping of str to mapping of str to Torsional
        By gearbox, then by contact.
    speeds_rpm : array_like
        Of the face gear [rpm].
    jobs : int

    Returns
    -------
    xarray.Dataset
        ``unstable``, ``largest`` [1/s] over (gearbox, contact).
    """
    shown, speeds = _axis(speeds_rpm)
    contacts = list(next(iter(models.values())))
    growth = np.array(
        [
            [
                stability_map(
                    row[name], speeds, "load_inertia", [row[name].gearbox.in_si.load_inertia], jobs=jobs
                ).values[0]
                for name in contacts
            ]
            for row in models.values()
        ]
    )
    both = ("gearbox", "contact")
    return xr.Dataset(
        {
            "unstable": variable(
                both, (growth > 0).mean(axis=-1), "Unstable share", "1", atol=3.0 / shown.size
            ),
            "largest": _growth(both, growth.max(axis=-1), "Largest growth rate"),
        },
        {
            "gearbox": np.arange(len(models)),
            "contact": np.arange(len(contacts)),
            "speed_of_largest": (both, shown[growth.argmax(axis=-1)]),
            "gearbox_name": text("gearbox", list(models), "Gearbox of figure"),
            "contact_name": text("contact", contacts, "Contact"),
        },
    )


def gearbox_tongues(
    models: Mapping[str, Mapping[str, Torsional]], speeds_rpm: tuple[float, float], jobs: int = -1
) -> xr.Dataset:
    """Tongues of gearboxes with several contacts, from a growth of 1e-7 a period on: the load is known to that.

    Parameters
    ----------
    models : mapping of str to mapping of str to Torsional
        By gearbox, then by contact.
    speeds_rpm : tuple of float
        Range of speed of the face gear [rpm].
    jobs : int

    Returns
    -------
    xarray.Dataset
        ``lower``, ``upper`` [rpm], ``largest`` growth rate [1/s] over ``tongue``; which gearbox and contact, and the
        label, in coordinates.
    """
    settings = [(box, name) for box, row in models.items() for name in row]
    low, high = (float(rad_per_s(speed)) for speed in speeds_rpm)
    search = partial(tongues, threshold=1e-7)
    found = in_processes(search, [(models[box][name], (low, high)) for box, name in settings], jobs)
    rows = [(box, name, tongue) for (box, name), part in zip(settings, found, strict=True) for tongue in part]
    boxes, contacts = list(models), list(next(iter(models.values())))
    return xr.Dataset(
        {
            "lower": _speed("tongue", [rpm(tongue.lower) for *_, tongue in rows], "Lower border"),
            "upper": _speed("tongue", [rpm(tongue.upper) for *_, tongue in rows], "Upper border"),
            "largest": _growth(
                "tongue", [tongue.growth_rate for *_, tongue in rows], "Largest growth rate of the tongue"
            ),
        },
        {
            "tongue": np.arange(len(rows)),
            "gearbox": ("tongue", [boxes.index(box) for box, *_ in rows]),
            "contact": ("tongue", [contacts.index(name) for _, name, _ in rows]),
            "label": text("tongue", [tongue.label for *_, tongue in rows], "Label of the tongue"),
        },
        {"gearboxes": ", ".join(boxes), "contacts": "; ".join(contacts)},
    )


def dynamic_load(
    gearbox: Gearbox, paths: Sequence[loaded_contact], speeds_rpm: ArrayLike, jobs: int = -1
) -> xr.Dataset:
    """Steady response of a gearbox to its own loaded transmission error.

    Parameters
    ----------
    gearbox : Gearbox
    paths : sequence of loaded_contact
        One a torque.
    speeds_rpm : array_like
        Of the face gear [rpm].
    jobs : int

    Returns
    -------
    xarray.Dataset
        ``dynamic_force``, rms over a mesh period of what the vibration adds to the force of the mesh, over the static
        force [-], over (torque, speed).
    """
    shown, speeds = _axis(speeds_rpm)
    rows = []
    for path in paths:
        model = loaded_gearbox(gearbox, path)
        contact = path.of(model.drive)
        found = frequency_response(Excited(model, transmission_error=contact.excitation), speeds, jobs=jobs)
        rows.append(found.force_rms.values[:, 0] / contact.force)
    name = "Rms of the dynamic force of the mesh over the static force"
    return xr.Dataset(
        {"dynamic_force": variable(("torque", "speed"), rows, name, "1", rtol=1e-6, atol=1e-9)},
        {"torque": [path.torque for path in paths], "speed": shown},
        {"parameters": describe(gearbox.drive)},
    )
