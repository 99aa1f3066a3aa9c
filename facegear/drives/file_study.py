"""What the explorer explores of a drive file: its numbers as controls, everything else as the file has it.

Each setting is the file with these numbers, read and built as any other, so that what is explored can be written.
"""

from __future__ import annotations

import copy
import math
import re
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from facegear.drives.contacts import NAMES
from facegear.drives.drive_file import DriveFile, parse_drive, read_drive_file
from facegear.drives.drive_keys import SECTIONS
from facegear.drives.drive_text import drive_text
from facegear.drives.examples import example_text
from facegear.drives.forces import PLACES
from facegear.drives.keys import Key
from facegear.drives.studies.study import Choice, Control, Quantity, Settings, Study
from facegear.drives.verdict import driven
from facegear.floquet.models import Model
from facegear.mechanics.edge_stiffness import Following
from facegear.support.parameters import rpm

_DIRECTIONS: Mapping[str, Following] = {"follows the rim": "follower", "keeps its direction": "dead"}
# Numbers that have a control: section and key. Those with a range of their own: others go from a third to three times.
_NUMBERS = (
    ("gears", "pinion_teeth"),
    ("gears", "gear_teeth"),
    ("gears", "module_mm"),
    ("body", "thickness_ratio"),
    ("body", "bore_radius_mm"),
    ("pinions", "stiffness"),
    ("pinions", "damping_us"),
    ("pinions", "mass"),
    ("operation", "power_kW"),
)
# Those that can stand on the vertical axis: what the teeth are decides on too much else.
_SWEPT = ("thickness_ratio", "bore_radius_mm", "stiffness", "damping_us", "mass", "power_kW")
_AT_LEAST = {"stiffness": 2.0, "damping_us": 20.0, "mass": 2.0}
_SPREAD = 3.0
_POWER = "power_kW"
# Digits of a number that a control sets: what conversion to SI and back adds is no part of it.
_DIGITS = 12
# Steps of a slider.
_STEPS = 200


def study_of(drive_file: str | Path | None) -> Study:
    """Study of a drive file; of the example `case_1` if there is none.

    Raises
    ------
    DriveFileError
        If the file cannot be used.
    """
    return file_study(
        parse_drive(example_text("case_1")) if drive_file is None else read_drive_file(drive_file)
    )


def file_study(file: DriveFile) -> Study:
    """Make a study of a drive file.

    Parameters
    ----------
    file : DriveFile
        As it was read: its `content` is what the controls change.

    Returns
    -------
    Study
        Of its body under the driving force, in the basis of the file; teeth, gears and pinions are those of the file.
    """
    angles = file.transverse.gear.pinion_angles
    start = {
        "gears": {"module_mm": 1e3 * file.drive.module},
        "operation": {"power_kW": 1e-3 * file.requirements.power},
    }
    base: dict[str, Any] = copy.deepcopy(dict(file.content))
    base["gears"].pop("diametral_pitch_per_inch", None)
    base["operation"].pop("power_hp", None)
    for section, values in start.items():
        base[section].update({name: _tidy(value) for name, value in values.items()})
    numbers = [_quantity(_key(section, name), base[section][name]) for section, name in _NUMBERS]
    turned = [
        Quantity(
            f"angle_{k}", f"angle of pinion {k} [°]", -360.0, 360.0, _tidy(_degrees(angle)), 0.1, unit=1.0
        )
        for k, angle in enumerate(angles[1:], start=2)
    ]
    short = [name for name, long in NAMES.items() if long in file.contacts]
    asked = next(name for name in short if NAMES[name] == next(iter(file.contacts)))
    choices = (
        Choice("contact_ratio", "contact ratio", tuple(short), asked),
        Choice("force_at", "driving force on", PLACES, file.force_at),
        Choice("following", "direction of the force", tuple(_DIRECTIONS), next(iter(_DIRECTIONS))),
    )
    controls: tuple[Control, ...] = (*numbers, *turned, *choices)

    def content(settings: Settings) -> dict[str, Any]:
        changed = copy.deepcopy(base)
        for section, name in _NUMBERS:
            key = _key(section, name)
            value = settings[name]
            changed[section][name] = value if key.kind == "integer" else _tidy(key.from_si(value))
        first = _tidy(_degrees(angles[0]))
        changed["pinions"]["angles_deg"] = [first, *(settings[each.name] for each in turned)]
        changed["pinions"]["contact_ratio"] = settings["contact_ratio"]
        changed["operation"]["force_at"] = settings["force_at"]
        changed["operation"]["highest_speed_rpm"] = _tidy(float(rpm(settings["highest_speed"])))
        return changed

    def build(settings: Settings) -> Model:
        read = parse_drive(drive_text(content(settings)), "these settings")
        return driven(read, _DIRECTIONS[settings["following"]], next(iter(read.contacts.values())))

    speed = replace(
        _quantity(_key("operation", "highest_speed_rpm"), _tidy(float(rpm(file.requirements.speeds[1])))),
        name="highest_speed",
        label="speed of the face gear [rpm]",
    )
    return Study(controls, build, "stiffness", speed, content=content)


def _key(section: str, name: str) -> Key:
    return next(key for key in SECTIONS[section].keys if key.name == name)


def _degrees(angle: float) -> float:
    return _key("pinions", "angles_deg").from_si(angle)


def _tidy(value: float) -> float:
    return float(f"{value:.{_DIGITS}g}")


def _quantity(key: Key, value: float) -> Quantity:
    """Control of a number of the file, whose slider has its value among its steps."""
    low = 0.0 if key.name in _AT_LEAST else max(key.lowest, value / _SPREAD)
    if key.name == _POWER:
        low = key.lowest  # with hardly any force the map is that of the moving contact alone
    high = min(key.highest, max(_SPREAD * value, _AT_LEAST.get(key.name, 0.0)))
    if key.kind == "integer":
        return Quantity(key.name, _label(key), int(low), int(high), int(value), 1, whole=True)
    step = 10.0 ** math.floor(math.log10((high - low) / _STEPS))
    swept = key.name in _SWEPT
    return Quantity(
        key.name,
        _label(key),
        _tidy(value - math.floor((value - low) / step) * step),
        _tidy(value + math.floor((high - value) / step) * step),
        _tidy(value),
        _tidy(step),
        unit=key.to_si(1.0),
        parameter=key.si_name if swept else None,
        why="a drive in a file transmits power" if key.name == _POWER else "",
    )


def _label(key: Key) -> str:
    """Say what a key is in a few words, then its symbol, if it can be written without a subscript, and its unit."""
    first, *others = re.sub(r" \(\d-\d+\)", "", key.plain_meaning.split(";")[0]).split(", ")
    named = others and len(first) < 4
    words = first if not named else others[0] if "_" in first else f"{others[0]} {first}"
    return f"{words} [{key.unit}]" if key.unit else words
