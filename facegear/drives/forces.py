"""Where the driving force of a drive file presses: at one point, over a tooth, or over the pairs in mesh."""

from __future__ import annotations

from dataclasses import replace

from facegear.geometry.drive import Drive
from facegear.mechanics.contact import Contact
from facegear.mechanics.pressed_points import Spread
from facegear.mechanics.sharing import shared_load
from facegear.mechanics.spreads import RIM_POINT, ContactPoints, PitchPoint, ToothPatches, ToothRoot

RIM = "rim"
_PAIRS = "pairs"
_PLACES: dict[str, Spread] = {RIM: RIM_POINT, "pitch": PitchPoint(), "tooth": ToothRoot()}
_IN_WORDS = {
    RIM: "at one point of the rim",
    "pitch": "at one point of the pitch circle",
    "tooth": "on face and root of one tooth",
    _PAIRS: "on face and root of the tooth pairs in mesh",
}
PLACES = tuple(_IN_WORDS)
"""Where the driving force may press, by the words of a drive file."""


def pressed(place: str, contact: Contact, drive: Drive) -> Spread:
    """Return where a driving force presses.

    Parameters
    ----------
    place : str
        One of `PLACES`.
    contact : Contact
        Of the model. Pairs in mesh are those of its clock; along lines each bears by its length, at a point as the
        load presses it.
    drive : Drive

    Returns
    -------
    facegear.mechanics.pressed_points.Spread

    Examples
    --------
    >>> spread = pressed("pairs", Contact(), Drive(26, 130, 3.175e-3))
    >>> round(float(spread.points(Drive(26, 130, 3.175e-3)).share.sum()), 12)
    1.0
    """
    if place != _PAIRS:
        return _PLACES[place]
    each = replace(contact, sharing="each")
    if drive.has_line_contact:
        lines = Contact(path=shared_load("length_share"), sharing="each")
        each = replace(lines, contact_ratio=contact.contact_ratio, travel=contact.travel)
    return ToothPatches(ContactPoints(each), ToothRoot())


def in_words(place: str) -> str:
    """Where a driving force presses, to end a sentence with: "at one point of the rim"."""
    return _IN_WORDS[place]
