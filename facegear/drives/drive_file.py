"""One YAML file that says everything about a drive: read, checked, turned into models.

People write these files, so every mistake ends in one sentence: which key, by its dotted path, what it holds, what
would be valid. Keys stand in :mod:`facegear.drives.drive_keys`, each is checked in :mod:`facegear.drives.file_values`.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any

from facegear.design.body import Requirements
from facegear.drives.drive_keys import NARROWEST_SPEED_RATIO, WIDEST_SPEED_RATIO
from facegear.drives.file_gearbox import gearbox_models
from facegear.drives.file_teeth import (
    check_angles,
    faces_of_pinions,
    flexible_teeth,
    pair_stiffness,
    possible_contacts,
    roles_of_pinions,
)
from facegear.drives.file_values import FileValues, checked_values
from facegear.drives.flexible_teeth import FlexibleTeeth
from facegear.drives.forces import RIM, pressed
from facegear.drives.refusals import built, built_following
from facegear.drives.tolerances import AS_GIVEN, Tolerances
from facegear.geometry.drive import Drive
from facegear.mechanics.backlash import Backlash
from facegear.mechanics.contact import Contact
from facegear.mechanics.heavy_shafts import HeavyShafts
from facegear.mechanics.inplane import FASTEST_SPIN, fastest_speed
from facegear.mechanics.pinions_on_disk import FaceGears
from facegear.mechanics.plate import Body
from facegear.mechanics.properties import Material, MeshLoad
from facegear.mechanics.radial_modes import BORE_RATIO_RANGE
from facegear.mechanics.tooth_damage import DamagedTooth
from facegear.mechanics.torsional import Torsional
from facegear.mechanics.transverse import Transverse
from facegear.mechanics.two_gears import Role, TwoGears
from facegear.support.parameters import rpm
from facegear.support.plain_yaml import read_plain_yaml

_INCH = 25.4e-3


class _BoreInTeethError(ValueError):
    """The bore reaches into the teeth: of about the right size, so that no frequent mistake explains it."""


class DriveFileError(ValueError):
    """A drive file cannot be used; the message names the key, its value and what would be valid."""


@dataclass(frozen=True)
class DriveFile:
    """What a drive file says, in SI units.

    Attributes
    ----------
    name : str
        Name of the drive.
    transverse : FaceGears
        Drive, body, mesh load and pinions, with rigid teeth or with `teeth`; two gears if there are `roles`.
    requirements : Requirements
        Power [W], pinion speed [rad/s], safety factor, operating speeds of the face gear [rad/s].
    contacts : mapping of str to Contact
        Those that the teeth can have, by the names that a report gives them, that of `transverse` first.
    torsional : Torsional, HeavyShafts or None
        Shafts and inertias, if the file has a gearbox; shafts have mass where it gives their lengths.
    teeth : FlexibleTeeth or None
        None for rigid ones.
    roles : tuple of str or None
        What each pinion does between two gears; None where there is one gear.
    play : Backlash or None
        The gearbox with play of its teeth, under the torque of one pinion's power; None where there is no play.
    cracked : DamagedTooth or None
        The gearbox with one damaged tooth of the face gear, under the same torque; None where none is damaged.
    force_at : str
        Where the driving force presses, one of :data:`facegear.drives.forces.PLACES`.
    tolerances : Tolerances
        How far stiffness, damping, shafts and speed may be from that.
    content : mapping
        What the file says, as it says it: keys and values by section. No part of what makes two drives equal.
    """

    name: str
    transverse: FaceGears
    requirements: Requirements
    contacts: Mapping[str, Contact]
    torsional: Torsional | HeavyShafts | None = None
    teeth: FlexibleTeeth | None = None
    roles: tuple[Role, ...] | None = None
    play: Backlash | None = None
    cracked: DamagedTooth | None = None
    force_at: str = RIM
    tolerances: Tolerances = AS_GIVEN
    content: Mapping[str, Any] = field(default_factory=dict, compare=False, repr=False)

    @property
    def drive(self) -> Drive:
        """Teeth."""
        return self.transverse.gear.body.drive

    @property
    def not_buildable(self) -> tuple[str, ...]:
        """What of the shafts cannot be built, one sentence each; empty without lengths of shafts."""
        return () if self.torsional is None else self.torsional.not_buildable

    @property
    def yields(self) -> str:
        """How far the stress at the root of the pinion's tooth is above what is allowed; empty if it is not."""
        stress, allowed = (
            1e-6 * value for value in self.requirements.root_stresses(self.transverse.gear.body)
        )
        return f"largest stress {stress:.4g} MPa, allowable {allowed:.4g} MPa" if stress > allowed else ""


def read_drive_file(path: str | Path) -> DriveFile:
    """Read and check a drive file.

    Parameters
    ----------
    path : str or Path
        YAML file; a relative path starts at the current folder.

    Returns
    -------
    DriveFile

    Raises
    ------
    DriveFileError
        If the file cannot be read, or as :func:`parse_drive`.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> import facegear as fg
    >>> text = '''
    ... name: Case I
    ... gears: {pinion_teeth: 26, gear_teeth: 130, module_mm: 3.175}
    ... body: {thickness_ratio: 0.03, bore_radius_mm: 50}
    ... pinions: {stiffness: 1.0, damping_us: 3, mass: 1.0}
    ... operation: {lowest_speed_rpm: 100, highest_speed_rpm: 1000, power_kW: 400, pinion_speed_rpm: 5000}
    ... '''
    >>> with TemporaryDirectory() as folder:
    ...     path = Path(folder) / "mine.yaml"
    ...     _ = path.write_text(text, encoding="utf-8")
    ...     file = fg.read_drive_file(path)
    >>> file.name
    'Case I'
    """
    if not isinstance(path, str | Path) or not str(path).strip():
        raise DriveFileError(f"drive_file must be the path of a YAML file, got {path!r}")
    try:
        content = Path(path).read_bytes()
    except (OSError, ValueError) as error:
        told = (isinstance(error, OSError) and error.strerror) or str(error)
        raise DriveFileError(
            f"drive_file {str(path)!r} cannot be read: {told} (the current folder is {Path.cwd()})"
        ) from None
    return parse_drive(content, Path(path).name)


def parse_drive(content: bytes | str, source: str = "drive file") -> DriveFile:
    """Check the content of a drive file and build what it describes.

    Parameters
    ----------
    content : bytes or str
        YAML text.
    source : str
        Name of the file, for messages.

    Returns
    -------
    DriveFile

    Raises
    ------
    DriveFileError
        If the text is not plain YAML, a key is unknown, missing or given twice, or a value is of the wrong type, out
        of its range, or impossible together with others.
    """
    try:
        written = read_plain_yaml(content)
        found = checked_values(written)
        try:
            return replace(_drive_file(found), content=written)
        except _BoreInTeethError:
            raise
        except ValueError as error:
            raise ValueError(f"{error}{_guess(found)}") from None
    except (TypeError, ValueError) as error:
        raise DriveFileError(f"{source}: {error}") from None


def _drive_file(found: FileValues) -> DriveFile:
    values = found.values
    gears = values["gears"] | {"shaper_teeth": values["gears"]["shaper_teeth"] or None}
    drive = built(found, "gears", lambda: Drive(**gears))
    material = built(found, "material", lambda: Material(**values["material"]))
    roles = roles_of_pinions(found, drive)
    faces = faces_of_pinions(values["teeth"], len(values["pinions"]["angles"]))
    _check_bore(drive, values["body"]["bore_radius"])
    check_angles(drive, values["pinions"]["angles"], faces)
    body = built(found, "body", lambda: Body(drive, material=material, **values["body"]))
    pinions = dict(values["pinions"])
    angles, asked = pinions.pop("angles"), pinions.pop("contact_ratio")
    stiffness = pair_stiffness(found, drive, material)
    contacts = possible_contacts(found, drive, material, stiffness, asked)
    contact = next(iter(contacts.values()))
    load = built(found, "pinions", lambda: MeshLoad(**pinions))
    teeth = None
    transverse: FaceGears
    if values["teeth"] is None:
        transverse = built(found, "pinions", lambda: Transverse(body, load, angles, contact))
    else:
        teeth = flexible_teeth(found, drive, material, stiffness)
        contacts = built(
            found, "teeth", lambda: {name: teeth.contact(own, drive) for name, own in contacts.items()}
        )
        build = partial(teeth.under, body, load, angles, next(iter(contacts.values())))
        gear = built_following(found, "teeth", build)
        transverse = gear if roles is None else built(found, "second_gear", lambda: TwoGears(gear, roles))
    built(found, "material", lambda: built(found, "body", lambda: transverse.gear.bearing_stiffness))
    requirements = _requirements(found, body)
    tolerances = Tolerances(**values["tolerances"])
    built(found, "tolerances", lambda: tolerances.require_shafts(values["gearbox"] is not None))
    torque, fastest = (
        requirements.pinion_torque * drive.gear_ratio,
        tolerances.widened(requirements.speeds)[1],
    )
    torsional, play, cracked = gearbox_models(found, drive, contact, material, torque, fastest)
    force_at = values["operation"]["force_at"]
    built(
        found,
        "operation",
        lambda: [pressed(force_at, each, drive).points(drive) for each in contacts.values()],
    )
    return DriveFile(
        name=found.name,
        transverse=transverse,
        requirements=requirements,
        contacts=contacts,
        torsional=torsional,
        teeth=teeth,
        roles=roles,
        play=play,
        cracked=cracked,
        force_at=force_at,
        tolerances=tolerances,
    )


def _check_bore(drive: Drive, bore_radius: float) -> None:
    """Check the bore in the file's unit, before the body does so in its own."""
    lowest = BORE_RATIO_RANGE[0] * drive.outer_radius
    highest = min(BORE_RATIO_RANGE[1] * drive.outer_radius, drive.inner_radius)
    if not lowest <= bore_radius < highest:
        among_teeth = drive.inner_radius <= bore_radius <= drive.outer_radius
        raise (_BoreInTeethError if among_teeth else ValueError)(
            f"body.bore_radius_mm must lie between {1e3 * lowest:.6g} and {1e3 * highest:.6g} mm for these gears, "
            f"whose teeth reach from {1e3 * drive.inner_radius:.6g} to {1e3 * drive.outer_radius:.6g} mm, "
            f"got {1e3 * bore_radius:.6g} mm"
        )


def _requirements(found: FileValues, body: Body) -> Requirements:
    operation = found.values["operation"]
    low, high, limit = operation["lowest_speed"], operation["highest_speed"], fastest_speed(body)
    fastest = high * (1.0 + found.values["tolerances"]["speed"])
    if not high / WIDEST_SPEED_RATIO <= low * (1 + 1e-12) or not low < high:
        raise ValueError(
            f"operation.lowest_speed_rpm must be lower than operation.highest_speed_rpm = {rpm(high):.6g} rpm and at "
            f"least 1/{WIDEST_SPEED_RATIO:g} of it, got {rpm(low):.6g} rpm"
        )
    if not high >= NARROWEST_SPEED_RATIO * low * (1 - 1e-12):
        least = NARROWEST_SPEED_RATIO * low
        raise ValueError(
            f"operation.highest_speed_rpm must be at least {NARROWEST_SPEED_RATIO:g} times operation.lowest_speed_rpm "
            f"= {rpm(low):.9g} rpm, that is {rpm(least):.9g} rpm, got {rpm(high):.9g} rpm"
        )
    if high > limit:
        raise ValueError(
            f"operation.highest_speed_rpm must be at most {rpm(limit):.6g} rpm for this body, whose rim then moves "
            f"{FASTEST_SPIN:g} times as fast as sound in its material, got {rpm(high):.6g} rpm"
        )
    if fastest > limit:
        raise ValueError(
            f"tolerances.speed_percent must be at most {100 * (limit / high - 1):.6g} for this body, whose rim then "
            f"moves {FASTEST_SPIN:g} times as fast as sound in its material, got "
            f"{100 * found.values['tolerances']['speed']:.6g}"
        )
    duty = (operation["power"], operation["pinion_speed"], operation["safety_factor"])
    return built(found, "operation", lambda: Requirements(*duty, (low, high)))


def _guess(found: FileValues) -> str:
    """Say which frequent mistake turns values that do not go together into ones that do; empty if none does."""
    gears, operation = found.values["gears"], found.values["operation"]
    teeth = {"pinion_teeth": gears["gear_teeth"], "gear_teeth": gears["pinion_teeth"]}
    speeds = {"lowest_speed": operation["highest_speed"], "highest_speed": operation["lowest_speed"]}
    # What is 8 mm as a module is 25.4 mm/8 as a pitch, and the same the other way round.
    module = 1e-3 * _INCH / gears["module"]
    in_mm = found.key("gears", "module") == "gears.module_mm"
    # Pitches are whole numbers: a module that is none was not meant as one.
    could_be_other = not in_mm or math.isclose(1e3 * gears["module"], round(1e3 * gears["module"]))
    guesses = [
        ("gears.pinion_teeth and gears.gear_teeth swapped?", found.replaced("gears", **teeth)),
        (
            "operation.lowest_speed_rpm and operation.highest_speed_rpm swapped?",
            found.replaced("operation", **speeds),
        ),
    ]
    if could_be_other:
        other = "a diametral pitch per inch" if in_mm else "a module in mm"
        shown = f"is {found.shown('gears', 'module')} {other}?"
        guesses.append((shown, found.replaced("gears", module=module)))
    for words, changed in guesses:
        try:
            _drive_file(changed)
        except ValueError:
            continue
        return f" ({words})"
    return ""
