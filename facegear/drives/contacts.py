"""Contacts that the teeth of a drive file can have: what is not known of a drive, each with its name.

With a shaper of the pinion's teeth contact is along lines, and the dissertation gives it Tregold's contact ratio; with
a larger one it is at a point without load, and spreads under it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Any

from facegear.floquet.models import replace_at
from facegear.geometry.drive import Drive
from facegear.mechanics.contact import SKEW_LINE, Contact
from facegear.mechanics.paths import loaded_contact, point_contact
from facegear.mechanics.properties import Material
from facegear.mechanics.tooth_stiffness import mesh_stiffness

NAMES: Mapping[str, str] = MappingProxyType(
    {
        "tregold": "Tregold",
        "geometric": "true sweep",
        "unloaded": "point contact",
        "loaded": "contact under load",
    }
)
"""What a report calls the contacts of a drive file."""

USUAL_CORRECTION = 0.5
"""Correction c_f of the stiffness of the teeth where nothing is known (table 7.1) [-]."""


def _correction_of(drive: Drive, pair_stiffness: float, material: Material) -> float:
    """c_f at which a pair of teeth has a stiffness k_m [N/m] (7-2)."""
    most = mesh_stiffness(drive, 1.0, material)
    if pair_stiffness > most:
        raise ValueError(
            f"mesh_stiffness must be at most {most:.4g} N/m, that of the teeth alone (7-2), for contact under load, "
            f"got {pair_stiffness:.4g} N/m"
        )
    return pair_stiffness / most


def transverse_contacts(
    drive: Drive, torque: float, material: Material, pair_stiffness: float | None = None
) -> dict[str, Contact]:
    """Contacts of a drive for the transverse model, the usual one first.

    Parameters
    ----------
    drive : Drive
    torque : float
        At the pinion [N m].
    material : Material
        Of the teeth.
    pair_stiffness : float, optional
        k_m of a pair of teeth under load [N/m]. Default: that of (7-2) with c_f = 0.5.

    Returns
    -------
    dict
        By their names in a drive file.

    Raises
    ------
    ValueError
        If teeth under load cannot be so stiff.
    """
    if drive.has_line_contact:
        return {
            "tregold": Contact(),
            "geometric": Contact(contact_ratio=drive.geometric_contact_ratio),
        }
    factor = USUAL_CORRECTION if pair_stiffness is None else _correction_of(drive, pair_stiffness, material)
    return {
        "loaded": Contact(path=loaded_contact(torque, correction_factor=factor, material=material)),
        "unloaded": Contact(path=point_contact, sharing="mean"),
    }


def in_torsion(contact: Contact, drive: Drive) -> Contact:
    """Contact of a drive for the torsional model: each pair for itself, as chapter 7 has it, total rate."""
    if drive.has_line_contact:
        return replace(SKEW_LINE, contact_ratio=contact.contact_ratio)
    return replace(contact, sharing="each", rate="total")


def massless(torsional: Any) -> Any:
    """Return the gearbox with massless shafts of a torsional model: shafts with mass stand around one."""
    return getattr(torsional, "torsional", torsional)


def path_to_massless(torsional: Any) -> tuple[str, ...]:
    """Return the fields that lead from a torsional model to the gearbox with massless shafts."""
    return () if massless(torsional) is torsional else ("torsional",)


def torsional_under(torsional: Any, contact: Contact, drive: Drive, arm: str | None = None) -> Any:
    """Return a torsional model of a drive file under another contact, and with another arm of the mesh force if given.

    Parameters
    ----------
    torsional : Torsional or HeavyShafts
    contact : Contact
        As the transverse model has it.
    drive : Drive
    arm : {"printed", "conjugate"}, optional
    """
    inside = path_to_massless(torsional)
    moved = replace_at(torsional, (*inside, "contact"), in_torsion(contact, drive))
    return moved if arm is None else replace_at(moved, (*inside, "arm"), arm)
