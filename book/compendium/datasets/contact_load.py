"""Arrays of contact without load and under load, with units and the tolerances at which they are checked."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from compendium.datasets.meshing import describe
from facegear.geometry.drive import Drive
from facegear.geometry.misalignment import Misalignment
from facegear.geometry.point_contact import UnloadedContact
from facegear.mechanics.contact_pattern import loaded_contact_pattern
from facegear.mechanics.loaded_contact import LoadedContact
from facegear.support.labelled import text, variable

COMPLIANCES = ("slice", "pair")
"""Laws at the two ends of how slices of a tooth hold one another, in the order of the arrays."""

_length = partial(variable, units="m", atol=1e-10)
_number = partial(variable, units="1", atol=1e-9)


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
