"""Controls of the driving force: its power, where it presses, whether it follows the rim."""

from __future__ import annotations

from dataclasses import replace

from facegear.drives.forces import RIM, pressed
from facegear.drives.studies.study import Choice, Quantity, Settings
from facegear.geometry.drive import Drive
from facegear.mechanics.contact import Contact
from facegear.mechanics.edge_stiffness import DrivingForce, Following
from facegear.support.parameters import rad_per_s

FOLLOWER, DEAD = "follows the rim", "keeps its direction"
RIM_ONLY = "one point of the rim"
_DIRECTIONS: dict[Following, str] = {"follower": FOLLOWER, "dead": DEAD}
# The words of a reader for those of a drive file.
PRESSED = {RIM_ONLY: RIM, "the pitch point": "pitch", "one tooth": "tooth", "the pairs in mesh": "pairs"}


def force_controls(
    force: DrivingForce | None, contact: Contact, drive: Drive, highest_speed_rpm: float
) -> tuple[Quantity | Choice, ...]:
    """Return the controls of the driving force, at first where that of a model is.

    Raises
    ------
    ValueError
        If its force presses elsewhere than a reader can choose.
    """
    at_top = float(rad_per_s(highest_speed_rpm)) / drive.speed_ratio
    here = DrivingForce(0.0, at_top) if force is None else force
    places = {name: pressed(place, contact, drive) for name, place in PRESSED.items()}
    place = next((name for name, spread in places.items() if spread == here.spread), None)
    if place is None:
        raise ValueError(f"force of the model must press on {' or '.join(places)}, got {here.spread!r}")
    # The power control holds at the highest speed: the same force.
    kilowatts = here.power / here.pinion_speed * at_top / 1e3
    return (
        Quantity(
            "power",
            "power of a pinion at top speed [kW]",
            0.0,
            1200.0,
            kilowatts,
            10.0,
            unit=1e3,
            parameter="power",
        ),
        Choice("force_at", "driving force on", tuple(PRESSED), place),
        Choice("following", "direction of the force", (FOLLOWER, DEAD), _DIRECTIONS[here.following]),
    )


def force_as_set(
    start: DrivingForce | None, settings: Settings, drive: Drive, contact: Contact
) -> DrivingForce:
    """Driving force of the power at top speed, as the reader wants it."""
    base = DrivingForce(0.0, 1.0) if start is None else start
    return replace(
        base,
        power=settings["power"],
        pinion_speed=settings["highest_speed"] / drive.speed_ratio,
        following=next(key for key, words in _DIRECTIONS.items() if words == settings["following"]),
        spread=pressed(PRESSED[settings["force_at"]], contact, drive),
    )
