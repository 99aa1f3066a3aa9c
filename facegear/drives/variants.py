"""Models of one drive that could change the answer: contacts, directions of the force, rates, teeth, rules of sharing.

None of them is known of a drive before it is built. Two that differ in one effect only tell whether that decides.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from facegear.drives.contacts import NAMES, USUAL_CORRECTION, transverse_contacts
from facegear.drives.drive_file import DriveFile
from facegear.drives.flexible_teeth import CENTROID, COMPLIANCE, FlexibleTeeth
from facegear.mechanics.contact import Contact
from facegear.mechanics.pinions_on_disk import FaceGears
from facegear.mechanics.sharing import RULES
from facegear.mechanics.tooth_stiffness import mesh_stiffness
from facegear.mechanics.transverse import Transverse

RIGID, RIGID_TOTAL = "rigid teeth, frozen rate", "rigid teeth, total rate"
"""Teeth as in chapters 4 to 6, and the same with bearings that follow the moving contact."""

ASSUMED_TOOTH_DAMPING = 1e-5
"""Damping over stiffness of teeth where a file says nothing of it [s]."""

# Parts of the torque of the file at which a contact under load is looked at besides the whole.
_PART_LOADS = (0.5, 0.25)


@dataclass(frozen=True)
class Variant:
    """One of the models.

    Attributes
    ----------
    contact, force, teeth : str
        Contact; direction of the driving force; rate, flexibility and load sharing of the teeth, in words.
    model : FaceGears
    """

    contact: str
    force: str
    teeth: str
    model: FaceGears

    @property
    def name(self) -> str:
        """All three in words."""
        return f"{self.contact}; {self.force}; {self.teeth}"


def plain_contacts(file: DriveFile) -> dict[str, Contact]:
    """Contacts that the teeth of a file can have, as rigid teeth with frozen rate feel them, the file's own first.

    A contact under load stands there under a half and a quarter of the torque as well.
    """
    drive = file.drive
    stiffness, _ = _teeth(file)
    possible = transverse_contacts(
        drive, file.requirements.pinion_torque, file.transverse.gear.body.material, stiffness
    )
    named = {NAMES[name]: contact for name, contact in possible.items()}
    found = {name: named[name] for name in file.contacts}
    if drive.has_line_contact:
        return found
    for name, contact in named.items():
        # Without load there is no torque to take a part of.
        if (torque := getattr(contact.path, "torque", None)) is not None:
            for part in _PART_LOADS:
                lighter = replace(contact.path, torque=part * torque)  # type: ignore[type-var]
                found[f"{name}, {100 * part:g} % of the torque"] = replace(contact, path=lighter)
    return found


def own_teeth(file: DriveFile) -> str:
    """Say what the teeth of a file are, as :attr:`Variant.teeth` has it."""
    return RIGID if file.teeth is None else _flexible(file.teeth.sharing)


def with_own_teeth(file: DriveFile, plain: Contact) -> Contact:
    """Return a contact of :func:`plain_contacts` as the teeth of the file have it."""
    return plain if file.teeth is None else file.teeth.contact(plain, file.drive)


def other_teeth(file: DriveFile, own: Variant, plain: Contact) -> tuple[list[Variant], list[str], list[str]]:
    """Give a drive, under one contact and one force, every other kind of teeth.

    Parameters
    ----------
    file : DriveFile
    own : Variant
        Of the teeth of the file, in any basis.
    plain : Contact
        Contact of `own` as :func:`plain_contacts` has it.

    Returns
    -------
    variants : list of Variant
    refused : list of str
        Which there are not, and why, a sentence each.
    failed : list of str
        Which there are but could not be made, and why, a sentence each.
    """
    found, refused, failed = [], [], []
    for name, build in _kinds(file, own.model, plain).items():
        if name == own.teeth:
            continue
        try:
            found.append(replace(own, teeth=name, model=build()))
        except (TypeError, ValueError) as error:
            refused.append(f"{own.contact}, {name}: {error}")
        except ArithmeticError as error:
            failed.append(f"{own.contact}, {own.force}, {name}: {error}")
    return found, refused, failed


def _kinds(file: DriveFile, own: FaceGears, plain: Contact) -> dict[str, Callable[[], FaceGears]]:
    """Return what makes each kind of teeth."""
    gear = own.gear

    def rigid(contact: Contact) -> FaceGears:
        if file.roles is not None or (file.teeth is not None and -1 in file.teeth.sides):
            raise ValueError("only flexible teeth are computed on the back face or between two gears")
        return Transverse(gear.body, gear.load, gear.pinion_angles, contact, gear.force)

    def on_springs(rule: str) -> FaceGears:
        teeth = FlexibleTeeth(*_stiff_teeth(file), rule, (), 0.0)
        if file.teeth is not None:
            teeth = replace(file.teeth, sharing=rule)
        flexible = teeth.under(gear.body, gear.load, gear.pinion_angles, teeth.contact(plain, file.drive))
        return own.with_gear(replace(flexible, force=gear.force))

    rules = (CENTROID, *RULES) if file.drive.has_line_contact else (CENTROID, COMPLIANCE)
    return {
        RIGID: lambda: rigid(plain),
        RIGID_TOTAL: lambda: rigid(replace(plain, rate="total")),
        **{_flexible(rule): lambda rule=rule: on_springs(rule) for rule in rules},  # type: ignore[misc]
    }


def _flexible(sharing: str) -> str:
    return f"flexible teeth, load sharing {sharing}"


def _teeth(file: DriveFile) -> tuple[float | None, float]:
    """Stiffness of a tooth pair [N/m] that a file gives, None if it does not, and its damping over stiffness [s]."""
    if file.teeth is not None:
        return file.teeth.stiffness, file.teeth.damping
    if file.torsional is not None:
        box = file.torsional.gearbox.in_si
        return box.mesh_stiffness, box.mesh_damping / box.mesh_stiffness or ASSUMED_TOOTH_DAMPING
    return None, ASSUMED_TOOTH_DAMPING


def _stiff_teeth(file: DriveFile) -> tuple[float, float]:
    """As :func:`_teeth`, the stiffness by (7-2) with c_f = 0.5 if the file gives none."""
    stiffness, damping = _teeth(file)
    usual = mesh_stiffness(file.drive, USUAL_CORRECTION, file.transverse.gear.body.material)
    return usual if stiffness is None else stiffness, damping
