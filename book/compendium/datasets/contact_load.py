"""Arrays of the chapter on contact under load, labelled, with units and the tolerances at which they are checked."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from compendium.datasets.meshing import describe
from facegear.floquet.models import replace_parameter
from facegear.floquet.modified_models import Excited
from facegear.geometry.drive import Drive
from facegear.geometry.misalignment import Misalignment
from facegear.geometry.point_contact import UnloadedContact
from facegear.maps.parallel import in_processes
from facegear.maps.response_map import frequency_response
from facegear.maps.stability_map import stability_map
from facegear.maps.tracing import tongues
from facegear.mechanics.contact import Contact
from facegear.mechanics.contact_pattern import loaded_contact_pattern
from facegear.mechanics.loaded_contact import LoadedContact
from facegear.mechanics.paths import loaded_contact
from facegear.mechanics.torsional import Gearbox, Torsional
from facegear.mechanics.transverse import Transverse
from facegear.support.labelled import text, variable
from facegear.support.parameters import rad_per_s, rpm
from facegear.support.types import FloatArray

COMPLIANCES = ("slice", "pair")
"""Laws at the two ends of how slices of a tooth hold one another, in the order of the arrays."""

_length = partial(variable, units="m", atol=1e-10)
_number = partial(variable, units="1", atol=1e-9)
_speed = partial(variable, units="rpm", rtol=1e-7, atol=1e-4)
_growth = partial(variable, units="1/s", rtol=1e-6, atol=1e-3)


def cut_by_larger_shaper(drive: Drive, more: int = 1) -> Drive:
    """Return the same drive, cut by a shaper with so many teeth more than the pinion."""
    return replace(drive, shaper_teeth=drive.pinion_teeth + more)


def contact_pattern(drive: Drive, errors: Mapping[str, ArrayLike], depth: float) -> xr.Dataset:
    """Where contact is without load, against errors of alignment, and where marking compound would show it.

    Parameters
    ----------
    drive : Drive
        Its shaper has more teeth than the pinion.
    errors : mapping of str to array_like
        Fields of :class:`Misalignment` and their values [m or rad], as many of each.
    depth : float
        Thickness of the compound [m].

    Returns
    -------
    xarray.Dataset
        ``size`` [m or rad], ``position``, ``inner``, ``outer`` over (error, step) [m], along the shaper's axis.
    """
    sizes = np.array([np.asarray(values, dtype=float) for values in errors.values()])
    contacts = [
        [UnloadedContact(drive, Misalignment(**{name: float(size)})) for size in row]
        for name, row in zip(errors, sizes, strict=True)
    ]
    bands = np.array([[contact.marking_band(depth) for contact in row] for row in contacts])
    both = ("error", "step")
    return xr.Dataset(
        {
            "size": variable(both, sizes, "Error of alignment, m or rad", "1", atol=1e-15),
            "position": _length(
                both, [[contact.position for contact in row] for row in contacts], "Place of the contact"
            ),
            "inner": _length(both, bands[..., 0], "Inner end of the marking"),
            "outer": _length(both, bands[..., 1], "Outer end of the marking"),
        },
        {
            "error": np.arange(len(errors)),
            "step": np.arange(sizes.shape[1]),
            "error_name": text("error", list(errors), "Error of alignment"),
        },
        {"parameters": describe(drive, shaper_teeth=drive.generating.pinion_teeth, depth_um=1e6 * depth)},
    )


def effective_contact_ratio(
    drive: Drive, more: Sequence[int], torques: ArrayLike, laws: Sequence[str] = COMPLIANCES
) -> xr.Dataset:
    """Effective contact ratio against torque, shaper and compliance.

    Parameters
    ----------
    drive : Drive
    more : sequence of int
        Teeth that the shaper has more than the pinion.
    torques : array_like
        At the pinion [N m].
    laws : sequence of str
        How teeth give way.

    Returns
    -------
    xarray.Dataset
        ``contact_ratio`` over (law, more, torque), ``unloaded`` over (more).
    """
    torques = np.asarray(torques, dtype=float)
    drives = [cut_by_larger_shaper(drive, count) for count in more]
    ratios = [
        [[LoadedContact(cut, t, compliance=law).contact_ratio for t in torques] for cut in drives]
        for law in laws
    ]
    return xr.Dataset(
        {
            "contact_ratio": _number(("law", "more", "torque"), ratios, "Effective contact ratio"),
            "unloaded": _number(
                "more", [UnloadedContact(cut).contact_ratio for cut in drives], "Without load"
            ),
        },
        {
            "law": np.arange(len(laws)),
            "more": list(more),
            "torque": torques,
            "law_name": text("law", list(laws), "Law of compliance"),
        },
        {"parameters": describe(drive)},
    )


def misaligned_contact_ratio(
    drive: Drive, errors: Mapping[str, ArrayLike], torques: ArrayLike, laws: Sequence[str] = COMPLIANCES
) -> xr.Dataset:
    """Effective contact ratio against errors of alignment.

    Parameters
    ----------
    drive : Drive
        Its shaper has more teeth than the pinion.
    errors : mapping of str to array_like
        Fields of :class:`Misalignment` and their values [m or rad], as many of each.
    torques : array_like
        At the pinion [N m].
    laws : sequence of str

    Returns
    -------
    xarray.Dataset
        ``contact_ratio`` over (law, torque, error, step), ``size`` [m or rad] over (error, step).
    """
    torques = np.asarray(torques, dtype=float)
    sizes = np.array([np.asarray(values, dtype=float) for values in errors.values()])
    misaligned = [
        [Misalignment(**{name: float(size)}) for size in row] for name, row in zip(errors, sizes, strict=True)
    ]
    ratios = [
        [
            [[LoadedContact(drive, torque, m, law).contact_ratio for m in row] for row in misaligned]
            for torque in torques
        ]
        for law in laws
    ]
    return xr.Dataset(
        {
            "contact_ratio": _number(("law", "torque", "error", "step"), ratios, "Effective contact ratio"),
            "size": variable(("error", "step"), sizes, "Error of alignment, m or rad", "1", atol=1e-15),
        },
        {
            "law": np.arange(len(laws)),
            "torque": torques,
            "error": np.arange(len(errors)),
            "step": np.arange(sizes.shape[1]),
            "law_name": text("law", list(laws), "Compliance"),
            "error_name": text("error", list(errors), "Error of alignment"),
        },
        {"parameters": describe(drive, shaper_teeth=drive.generating.pinion_teeth)},
    )


def mesh_period_under_load(drive: Drive, torques: ArrayLike, instants: int = 200) -> xr.Dataset:
    """Mesh stiffness, loaded transmission error and load sharing over a mesh period.

    Parameters
    ----------
    drive : Drive
        Its shaper has more teeth than the pinion.
    torques : array_like
        At the pinion [N m].
    instants : int
        Of the period, equally spaced from where a pair begins to be pressed.

    Returns
    -------
    xarray.Dataset
        ``stiffness`` (over k_m) and ``approach`` [m] over (law, torque, time), ``share`` of the load over (law, torque,
        pair, time), the youngest pair first.
    """
    torques = np.asarray(torques, dtype=float)
    time = np.arange(instants) / instants
    contacts = [[LoadedContact(drive, t, compliance=law) for t in torques] for law in COMPLIANCES]
    shares = np.zeros((2, torques.size, 4, instants))
    for place, row in zip(shares, contacts, strict=True):
        for target, contact in zip(place, row, strict=True):
            force = contact.pairs(time).force
            target[: len(force)] = force / contact.force
    three = ("law", "torque", "time")
    stiffness = [[c.mesh_stiffness(time) / c.pair_stiffness for c in row] for row in contacts]
    approach = [[c.transmission_error(time) for c in row] for row in contacts]
    return xr.Dataset(
        {
            "stiffness": _number(three, stiffness, "Mesh stiffness over that of a pair"),
            "approach": variable(three, approach, "Loaded transmission error", "m", rtol=1e-9, atol=1e-15),
            "share": _number(("law", "torque", "pair", "time"), shares, "Share of the load"),
        },
        {
            "law": [0, 1],
            "torque": torques,
            "pair": np.arange(4),
            "time": time,
            "law_name": text("law", list(COMPLIANCES), "Law of compliance"),
        },
        {"parameters": describe(drive, shaper_teeth=drive.generating.pinion_teeth)},
    )


def pressed_flank(drive: Drive, torques: ArrayLike, ages: int = 121, points: int = 121) -> xr.Dataset:
    """Load per length of face on a flank while it goes through the mesh, for slices that give way each for itself.

    Parameters
    ----------
    drive : Drive
        Its shaper has more teeth than the pinion.
    torques : array_like
        At the pinion [N m].
    ages : int
        Lines of contact from first to last.
    points : int
        Along each.

    Returns
    -------
    xarray.Dataset
        ``pressure`` [N/m] over (torque, age, point), and where: ``position`` along the face and ``height`` below the
        gear's tooth top [m] over (age, point).
    """
    patterns = [
        loaded_contact_pattern(LoadedContact(drive, torque), lines=ages, points=points)
        for torque in np.asarray(torques, dtype=float).tolist()
    ]
    pressures = xr.concat([pattern["pressure"] for pattern in patterns], "torque")
    # Where the lines are is the same under any torque.
    found = patterns[0].drop_vars("torque").assign(pressure=pressures)
    found.attrs["parameters"] = describe(drive, shaper_teeth=drive.generating.pinion_teeth)
    return found


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
