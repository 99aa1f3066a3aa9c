"""The choice of a contact ratio: which of the two a model has, and its contact with the one that is chosen."""

from __future__ import annotations

from dataclasses import replace

from facegear.drives.studies.study import Settings
from facegear.geometry.drive import Drive
from facegear.geometry.kinematics import ContactPath
from facegear.mechanics.contact import Contact

TREGOLD, TRUE_SWEEP = "Tregold, as printed", "true sweep"


def require_lines(contact: Contact, drive: Drive) -> None:
    """Refuse contacts that the choice of a contact ratio would replace."""
    if contact.path != ContactPath or contact.sharing == "each" or not drive.has_line_contact:
        raise ValueError(
            "contact of the model must be that of lines as one load, whose contact ratio a reader chooses, got "
            f"{contact!r}"
        )


def chosen_ratio(contact: Contact, drive: Drive) -> str:
    """Which of the contact ratios that a reader chooses a contact has."""
    clocks = {TREGOLD: drive.contact_ratio, TRUE_SWEEP: drive.geometric_contact_ratio}
    own = drive.contact_ratio if contact.contact_ratio is None else contact.contact_ratio
    ratio = next((name for name, value in clocks.items() if value == own), None)
    if ratio is None:
        raise ValueError(
            f"contact_ratio of the model must be {clocks[TREGOLD]:.6g} (Tregold) or {clocks[TRUE_SWEEP]:.6g} (true "
            f"sweep) for these teeth, got {own!r}"
        )
    return ratio


def contact_as_set(start: Contact, settings: Settings, drive: Drive) -> Contact:
    """Contact of a model on the clock that the reader picks."""
    swept = settings["contact_ratio"] == TRUE_SWEEP
    return replace(start, contact_ratio=drive.geometric_contact_ratio if swept else None)
