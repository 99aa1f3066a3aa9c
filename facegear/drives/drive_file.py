"""One YAML file that says everything about a drive: read, checked, turned into models.

People write these files, so every mistake ends in one sentence: which key, by its dotted path, what it holds, what
would be valid. What the keys are stands in :mod:`facegear.drives.drive_keys`.
"""

from __future__ import annotations

import difflib
import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any, TypeVar, cast

from facegear.design.body import Requirements
from facegear.drives.contacts import NAMES, USUAL_CORRECTION, in_torsion, transverse_contacts
from facegear.drives.drive_keys import (
    LONGEST_TEXT,
    MOST_PINIONS,
    NAME,
    SECTIONS,
    USUAL,
    WIDEST_SPEED_RATIO,
    Key,
)
from facegear.drives.flexible_teeth import FlexibleTeeth
from facegear.drives.forces import RIM, pressed
from facegear.drives.tolerances import AS_GIVEN, Tolerances
from facegear.geometry.drive import Drive
from facegear.geometry.phases import touching_angle
from facegear.mechanics.backlash import Backlash
from facegear.mechanics.contact import Contact
from facegear.mechanics.heavy_shafts import HeavyShafts
from facegear.mechanics.inplane import FASTEST_SPIN, fastest_speed
from facegear.mechanics.plate import BORE_RATIO_RANGE, Body
from facegear.mechanics.tooth_damage import DamagedTooth
from facegear.mechanics.torsional import Gearbox, Torsional, mesh_stiffness
from facegear.mechanics.transverse import FaceGears, Transverse
from facegear.mechanics.two_gears import Role, TwoGears, fitting_angles
from facegear.support.parameters import Material, MeshLoad, integer_at_least, rpm, within
from facegear.support.plain_yaml import read_plain_yaml

T = TypeVar("T")

# Factors by which people miss a unit, after that to SI.
_FACTORS = (1e3, 1e-3, 1e6, 1e-6, 1e9, 1e-9)

_INCH = 25.4e-3
# What models call following the contact where they refuse teeth that do not allow it.
_TOTAL_RATE = "rate = 'total'"
_DECIMAL_COMMA = re.compile(r"\s*[-+]?\d+,\d+([eE][-+]?\d+)?\s*", re.ASCII)
_WITH_UNIT = re.compile(r"\s*([-+]?[\d.]+([eE][-+]?\d+)?)\s*[^\d\s.,:eE-].*", re.ASCII)


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
        return getattr(self.torsional, "not_buildable", ())


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
        found = _checked(written)
        try:
            return replace(_built(found), content=written)
        except ValueError as error:
            raise ValueError(f"{error}{_guess(found)}") from None
    except (TypeError, ValueError) as error:
        raise DriveFileError(f"{source}: {error}") from None


# --- from text to numbers in SI ---------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Found:
    """What a file holds, checked key by key.

    Attributes
    ----------
    name : str
        Name of the drive.
    values : dict
        Values in SI, by section and SI name of the key; None for a section that is not there.
    keys : dict
        The keys that gave them, by section and SI name.
    """

    name: str
    values: dict[str, Any]
    keys: dict[str, dict[str, Key]]

    def key(self, section: str, quantity: str) -> str:
        """Dotted path of the key that gave a value."""
        return f"{section}.{self.keys[section][quantity].name}"

    def shown(self, section: str, quantity: str) -> str:
        """Value of a quantity as the file has it, with its unit."""
        key = self.keys[section][quantity]
        return f"{key.from_si(self.values[section][quantity]):.6g} {key.unit}".rstrip()

    def replaced(self, section: str, **values: Any) -> _Found:
        """Return a copy with other values in one section."""
        return replace(self, values={**self.values, section: {**self.values[section], **values}})


def _checked(content: Any) -> _Found:
    """Check every key by itself."""
    _check_keys("", content, [NAME.name, *SECTIONS])
    values: dict[str, Any] = {}
    chosen: dict[str, dict[str, Key]] = {}
    for name, section in SECTIONS.items():
        keys = [key.name for key in section.keys]
        if name not in content:
            if section.required:
                raise ValueError(f"{name} is missing: a section with the keys {', '.join(keys)}")
            if not section.assumed:
                values[name] = None
                continue
        entries = content.get(name, {})
        _check_keys(name, entries, keys)
        chosen[name] = {same[0].si_name: _chosen(name, same, entries) for same in section.quantities()}
        values[name] = {
            # A key without a value is a mistake, not the default.
            quantity: checked_value(f"{name}.{key.name}", key, entries.get(key.name, key.default))
            for quantity, key in chosen[name].items()
        }
    return _Found(checked_value(NAME.name, NAME, content.get(NAME.name)), values, chosen)


def _chosen(section: str, same: tuple[Key, ...], entries: Mapping[str, Any]) -> Key:
    """Find the one key that a file uses of those that say the same."""
    names = " or ".join(f"{section}.{key.name}" for key in same)
    given = [key for key in same if key.name in entries]
    if len(given) > 1:
        raise ValueError(f"{names.replace(' or ', ' and ')} say the same: give one of them")
    if not given and len(same) > 1:
        raise ValueError(f"{names} is missing: {same[0].plain_meaning}; valid is {same[0].valid}")
    return given[0] if given else same[0]


def _check_keys(path: str, entries: Any, valid: Sequence[str]) -> None:
    """Refuse what is no section, and unknown keys."""
    if not isinstance(entries, Mapping):
        raise TypeError(
            f"{path or 'a drive file'} must be a section with the keys {', '.join(valid)}, got {_shown(entries)}"
        )
    prefix = f"{path}." if path else ""
    for key in entries:
        if key in valid:
            continue
        homes = [name for name, section in SECTIONS.items() if key in {k.name for k in section.keys}]
        near = difflib.get_close_matches(key, valid, 1, 0.5)
        if homes:
            told = f"it belongs to {' or '.join(homes)}"
        elif near:
            told = f"did you mean {prefix}{near[0]}?"
        else:
            told = f"valid are {', '.join(valid)}"
        name = _cut(key if key.isidentifier() else repr(key))
        raise ValueError(f"{prefix}{name} = {_shown(entries[key])} is no key of a drive file: {told}")


def checked_value(path: str, key: Key, value: Any) -> Any:
    """Check the value of a key by itself.

    Parameters
    ----------
    path : str
        The key's dotted path, for messages.
    key : Key
    value : object
        As plain YAML gives it; None where there is none.

    Returns
    -------
    object
        In SI; lists become tuples.

    Raises
    ------
    TypeError, ValueError
        If it is missing, of the wrong type or out of the key's range.
    """
    if value is None:
        raise ValueError(f"{path} is missing: {key.plain_meaning}; valid is {key.valid}")
    if key.kind == "text":
        if not isinstance(value, str) or not value.strip() or len(value) > LONGEST_TEXT:
            raise TypeError(f"{path} must be {key.valid}, got {_shown(value)}")
        return value.strip()
    if key.kind == "choice":
        if not isinstance(value, str) or value not in key.choices:
            raise ValueError(f"{path} must be {key.valid}, got {_shown(value)}")
        return value
    if key.kind == "choices":
        if not isinstance(value, list | tuple) or not key.fewest <= len(value) <= MOST_PINIONS:
            raise TypeError(f"{path} must be {key.valid}, got {_shown(value)}")
        for i, entry in enumerate(value):
            if isinstance(entry, bool) or entry not in key.choices:
                raise ValueError(f"{path}[{i}] must be {key.valid_entry}, got {_shown(entry)}")
        return tuple(key.choices[key.choices.index(entry)] for entry in value)
    if key.kind == "numbers":
        if not isinstance(value, list | tuple) or not key.fewest <= len(value) <= MOST_PINIONS:
            raise TypeError(f"{path} must be {key.valid}, got {_shown(value)}{_text_hint(value)}")
        return tuple(key.to_si(_number(f"{path}[{i}]", key, entry)) for i, entry in enumerate(value))
    if key.kind == "integer":
        if key.or_zero and value == 0 and not isinstance(value, bool):
            return 0
        return int(within(path, integer_at_least(path, value, int(key.lowest)), key.lowest, key.highest))
    return key.to_si(_number(path, key, value))


def _number(path: str, key: Key, value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise TypeError(f"{path} must be {key.valid_entry}, got {_shown(value)}{_text_hint(value)}")
    if key.or_zero and value == 0:
        return 0.0
    return within(path, value, key.lowest, key.highest, key.unit, _unit_hint(path, key, value))


def _text_hint(value: Any) -> str:
    """Guess at what made a text of a number."""
    if not isinstance(value, str):
        return ""
    if _DECIMAL_COMMA.fullmatch(value):
        return f" (a point, not a comma: {value.strip().replace(',', '.')})"
    if match := _WITH_UNIT.fullmatch(value):
        return f" (the number alone, its unit is that of the key: {match[1]})"
    return ""


def _unit_hint(path: str, key: Key, value: float) -> str:
    """Guess at a wrong unit: the value that would be valid."""
    if key.hint:
        return key.hint
    hints = [f"a ratio, not {key.no_unit}?"] if key.no_unit and value > key.highest else []
    factors = (key.to_si(1.0) ** -1, *_FACTORS) if key.unit else (1e-3,) if key.no_unit else ()
    for factor in factors:
        if factor != 1.0 and key.lowest <= value * factor <= key.highest:
            unit = f", in {key.unit}" if key.unit else ""
            hints.append(f"wrong unit? {path}: {value * factor:.6g} would be valid{unit}")
            break
    if key.or_zero and not hints:
        hints.append("0 is valid, too")
    return "; ".join(hints)


def _shown(value: Any) -> str:
    return _cut(repr(value))


def _cut(text: str) -> str:
    return text if len(text) <= LONGEST_TEXT else text[: LONGEST_TEXT - 1] + "…"


# --- from numbers to models ---------------------------------------------------------------------------------------


def _built(found: _Found) -> DriveFile:
    values = found.values
    gears = values["gears"] | {"shaper_teeth": values["gears"]["shaper_teeth"] or None}
    drive = _by_model(found, "gears", lambda: Drive(**gears))
    material = _by_model(found, "material", lambda: Material(**values["material"]))
    roles = _roles(found, drive)
    faces = _faces(values["teeth"], len(values["pinions"]["angles"]))
    _check_bore(drive, values["body"]["bore_radius"])
    _check_angles(drive, values["pinions"]["angles"], faces)
    body = _by_model(found, "body", lambda: Body(drive, material=material, **values["body"]))
    pinions = dict(values["pinions"])
    angles, asked = pinions.pop("angles"), pinions.pop("contact_ratio")
    stiffness = _pair_stiffness(found, drive, material)
    contacts = _contacts(found, drive, material, stiffness, asked)
    contact = next(iter(contacts.values()))
    load = _by_model(found, "pinions", lambda: MeshLoad(**pinions))
    teeth = None
    transverse: FaceGears
    if values["teeth"] is None:
        transverse = _by_model(found, "pinions", lambda: Transverse(body, load, angles, contact))
    else:
        teeth = _teeth(found, drive, material, stiffness)
        contacts = _by_model(
            found, "teeth", lambda: {name: teeth.contact(own, drive) for name, own in contacts.items()}
        )
        build = partial(teeth.under, body, load, angles, next(iter(contacts.values())))
        gear = _following(found, "teeth", build)
        transverse = gear if roles is None else _by_model(found, "second_gear", lambda: TwoGears(gear, roles))
    _by_model(found, "material", lambda: _by_model(found, "body", lambda: transverse.gear.bearing_stiffness))
    requirements = _requirements(found, body)
    torsional, play, cracked = None, None, None
    if (gearbox := values["gearbox"]) is not None:
        torsional = _following(
            found, "gearbox", lambda: _torsional(drive, gearbox, in_torsion(contact, drive), material)
        )
        torque = requirements.pinion_torque * drive.gear_ratio
        play = _by_model(found, "gearbox", lambda: _play(gearbox, torsional, torque))
        cracked = _by_model(found, "gearbox", lambda: _cracked(gearbox, torsional, torque))
    force_at = values["operation"]["force_at"]
    _by_model(
        found,
        "operation",
        lambda: [pressed(force_at, each, drive).points(drive) for each in contacts.values()],
    )
    tolerances = Tolerances(**values["tolerances"])
    _by_model(found, "tolerances", lambda: tolerances.require_shafts(gearbox is not None))
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


def _faces(teeth: dict[str, Any] | None, pinions: int) -> Sequence[int]:
    """Face of the gear that each pinion meshes with."""
    sides = (teeth and teeth["sides"]) or (1,) * pinions
    if len(sides) != pinions:
        raise ValueError(
            f"teeth.sides must list 1 or -1 for each pinion of pinions.angles_deg, {pinions} in all, got {list(sides)}"
        )
    if teeth and teeth["clocking"] and -1 not in sides:
        raise ValueError(
            "teeth.clocking must be 0 or left out where teeth.sides has no pinion on the back face (-1), got "
            f"{teeth['clocking']:.6g}"
        )
    return sides


def _roles(found: _Found, drive: Drive) -> tuple[Role, ...] | None:
    """Check what each pinion does between two gears, if the file has a second one."""
    if found.values["second_gear"] is None:
        return None
    roles, teeth = found.values["second_gear"]["roles"], found.values["teeth"]
    angles = found.values["pinions"]["angles"]
    if teeth is None:
        raise ValueError(
            "second_gear must stand beside a section teeth: pinions between gears hang on their springs"
        )
    if teeth["sides"] or teeth["clocking"]:
        raise ValueError(
            "teeth.sides and teeth.clocking must be left out beside second_gear: each gear has teeth on one face"
        )
    if abs(drive.shaft_angle - math.pi / 2.0) > 1e-9:
        raise ValueError(
            f"{found.key('gears', 'shaft_angle')} must be 90° beside second_gear, or two gears on one axis are not "
            f"alike, got {math.degrees(drive.shaft_angle):.6g}°"
        )
    if len(roles) != len(angles) or "input" not in roles:
        raise ValueError(
            f"second_gear.roles must list one role for each of {len(angles)} pinions, an input among them, got "
            f"{list(roles)}"
        )
    for i, (angle, near) in enumerate(zip(angles, fitting_angles(drive, angles), strict=True)):
        if angle != near:
            raise ValueError(
                f"pinions.angles_deg[{i}] must differ from the first by a whole number of halves of the angular pitch, "
                f"{math.degrees(drive.angular_pitch) / 2.0:.10g}°, for teeth to fit into both gears, got "
                f"{math.degrees(angle):.10g}°; the nearest that fits is {math.degrees(near):.10g}°"
            )
    return cast("tuple[Role, ...]", roles)


def _teeth(found: _Found, drive: Drive, material: Material, stiffness: float | None) -> FlexibleTeeth:
    values, gearbox = found.values["teeth"], found.values["gearbox"]
    if found.values["pinions"]["mass"] == 0.0:
        raise ValueError("pinions.mass must be greater than 0 for a pinion on flexible teeth to move, got 0")
    damping = values["mesh_damping"]
    if gearbox is None and damping == 0.0:
        raise ValueError(
            "teeth.tooth_damping_us is missing, or 0: without a section gearbox, whose mesh damping it would be, it "
            f"must be {found.keys['teeth']['mesh_damping'].valid.removeprefix('0, or ')}"
        )
    if gearbox:
        if gearbox["mesh_damping"] == 0.0:
            raise ValueError(
                "gearbox.mesh_damping_us must be greater than 0 beside a section teeth, whose springs have that "
                "damping, got 0 µs"
            )
        if damping not in (0.0, gearbox["mesh_damping"]):
            raise ValueError(
                "teeth.tooth_damping_us must be left out, or be that of gearbox.mesh_damping_us, "
                f"{found.shown('gearbox', 'mesh_damping')}, got {found.shown('teeth', 'mesh_damping')}"
            )
        damping = gearbox["mesh_damping"]
    if stiffness is None:
        stiffness = mesh_stiffness(drive, USUAL_CORRECTION, material)
    return FlexibleTeeth(stiffness, damping, values["sharing"], values["sides"], values["clocking"])


def _pair_stiffness(found: _Found, drive: Drive, material: Material) -> float | None:
    """k_m of a tooth pair [N/m] that the file gives, if it does."""
    gearbox, teeth = found.values["gearbox"], found.values["teeth"]
    own = teeth["correction_factor"] if teeth else 0.0
    if gearbox and own:
        raise ValueError(
            "teeth.correction_factor must be 0 or left out beside gearbox.mesh_stiffness_N_per_m, which says the same, "
            f"got {own!r}"
        )
    if gearbox:
        return float(gearbox["mesh_stiffness"])
    return mesh_stiffness(drive, own, material) if own else None


def _contacts(
    found: _Found, drive: Drive, material: Material, stiffness: float | None, asked: str
) -> dict[str, Contact]:
    """Contacts that the teeth can have, under load that of the power; the one that the file asks for first."""
    operation = found.values["operation"]
    torque = operation["power"] / operation["pinion_speed"]
    possible = _by_model(found, "gearbox", lambda: transverse_contacts(drive, torque, material, stiffness))
    if asked != USUAL and asked not in possible:
        raise ValueError(
            f"{found.key('pinions', 'contact_ratio')} must be {', '.join([USUAL, *possible])} for a shaper of "
            f"{drive.generating.pinion_teeth} teeth and a pinion of {drive.pinion_teeth}, got {asked!r}"
        )
    return {NAMES[name]: possible[name] for name in sorted(possible, key=lambda name: name != asked)}


def _torsional(
    drive: Drive, gearbox: dict[str, Any], contact: Contact, material: Material
) -> Torsional | HeavyShafts:
    values = {name: value for name, value in gearbox.items() if name not in ("gap", "loss")}
    arm = values.pop("arm")
    lengths = {name: values.pop(name) for name in ("input_length", "output_length")}
    for part in ("mesh", "input", "output"):
        # The file gives damping as a time.
        values[f"{part}_damping"] *= values[f"{part}_stiffness"]
    massless = Torsional(Gearbox(drive, **values), contact, arm)
    return HeavyShafts(massless, **lengths, material=material) if any(lengths.values()) else massless


def _play(gearbox: dict[str, Any], torsional: Any, torque: float) -> Backlash | None:
    """Give the gearbox the play of its teeth, if there is any."""
    if gearbox["gap"] == 0.0:
        return None
    if gearbox["input_length"] or gearbox["output_length"]:
        raise ValueError("gap must be 0 beside lengths of shafts: play is computed with massless ones")
    if gearbox["gap"] > (module := torsional.drive.module):
        raise ValueError(
            f"gap must be at most the module, {1e6 * module:.6g} µm, got {1e6 * gearbox['gap']:.6g} µm"
        )
    return Backlash(torsional, torque, gearbox["gap"])


def _cracked(gearbox: dict[str, Any], torsional: Any, torque: float) -> DamagedTooth | None:
    """Damage one tooth of the gearbox, if the file does."""
    if gearbox["loss"] == 0.0:
        return None
    if gearbox["input_length"] or gearbox["output_length"]:
        raise ValueError("loss must be 0 beside lengths of shafts: damage is computed with massless ones")
    return DamagedTooth(torsional, gearbox["loss"], torque=torque)


def _check_bore(drive: Drive, bore_radius: float) -> None:
    """Check the bore in the file's unit, before the body does so in its own."""
    lowest = BORE_RATIO_RANGE[0] * drive.outer_radius
    highest = min(BORE_RATIO_RANGE[1] * drive.outer_radius, drive.inner_radius)
    if not lowest <= bore_radius < highest:
        raise ValueError(
            f"body.bore_radius_mm must lie between {1e3 * lowest:.6g} and {1e3 * highest:.6g} mm for these gears, "
            f"whose teeth reach from {1e3 * drive.inner_radius:.6g} to {1e3 * drive.outer_radius:.6g} mm, "
            f"got {1e3 * bore_radius:.6g} mm"
        )


def _check_angles(drive: Drive, angles: Sequence[float], faces: Sequence[int]) -> None:
    """Check that no two pinions of a face are in each other's way, in the file's unit."""
    least = touching_angle(drive)
    for i, angle in enumerate(angles):
        for j in range(i):
            apart = abs(math.remainder(angle - angles[j], 2 * math.pi))
            if faces[i] == faces[j] and apart < least:
                raise ValueError(
                    f"pinions.angles_deg[{i}] must differ from the other angles, full turns apart, by at least "
                    f"{math.degrees(least):.4g}°, where the tips of these pinions touch, got "
                    f"{math.degrees(angle):.6g}° beside {math.degrees(angles[j]):.6g}°"
                )


def _requirements(found: _Found, body: Body) -> Requirements:
    operation = found.values["operation"]
    low, high, limit = operation["lowest_speed"], operation["highest_speed"], fastest_speed(body)
    fastest = high * (1.0 + found.values["tolerances"]["speed"])
    if not high / WIDEST_SPEED_RATIO <= low * (1 + 1e-12) or not low < high:
        raise ValueError(
            f"operation.lowest_speed_rpm must be lower than operation.highest_speed_rpm = {rpm(high):.6g} rpm and at "
            f"least 1/{WIDEST_SPEED_RATIO:g} of it, got {rpm(low):.6g} rpm"
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
    return _by_model(found, "operation", lambda: Requirements(*duty, (low, high)))


def _by_model(found: _Found, section: str, build: Callable[[], T]) -> T:
    """Build a part; what it refuses is told under the names of the file."""
    try:
        return build()
    except (TypeError, ValueError, ArithmeticError) as error:
        text = str(error)
        for quantity in found.keys.get(section, {}):
            text = re.sub(rf"(?<![\w.]){quantity}(?!\w)", found.key(section, quantity), text)
        raise ValueError(text if f"{section}." in text else f"{section}: {text}") from error


def _following(found: _Found, section: str, build: Callable[[], T]) -> T:
    """As `_by_model`, of a model that follows the moving contact; a file has no key for that."""

    def told() -> T:
        try:
            return build()
        except ValueError as error:
            text = str(error)
            if _TOTAL_RATE not in text:
                raise
            text = text.replace(_TOTAL_RATE, f"a section {section}, whose model follows the moving contact")
            raise ValueError(re.sub(r"\b(?=(pinion|gear)_teeth\b)", "gears.", text)) from error

    return _by_model(found, section, told)


# --- what may have happened ---------------------------------------------------------------------------------------


def _guess(found: _Found) -> str:
    """Say which frequent mistake turns values that do not go together into ones that do; empty if none does."""
    gears, operation = found.values["gears"], found.values["operation"]
    teeth = {"pinion_teeth": gears["gear_teeth"], "gear_teeth": gears["pinion_teeth"]}
    speeds = {"lowest_speed": operation["highest_speed"], "highest_speed": operation["lowest_speed"]}
    # What is 8 mm as a module is 25.4 mm/8 as a pitch, and the same the other way round.
    module = 1e-3 * _INCH / gears["module"]
    other = (
        "a diametral pitch per inch"
        if found.key("gears", "module") == "gears.module_mm"
        else "a module in mm"
    )
    guesses = (
        ("gears.pinion_teeth and gears.gear_teeth swapped?", found.replaced("gears", **teeth)),
        (
            "operation.lowest_speed_rpm and operation.highest_speed_rpm swapped?",
            found.replaced("operation", **speeds),
        ),
        (f"is {found.shown('gears', 'module')} {other}?", found.replaced("gears", module=module)),
    )
    for words, changed in guesses:
        try:
            _built(changed)
        except ValueError:
            continue
        return f" ({words})"
    return ""
