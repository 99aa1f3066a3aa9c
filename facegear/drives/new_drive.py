"""A drive file made by asking for what it needs, or from values that are given."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from typing import Any

from facegear.drives.drive_file import DriveFileError, parse_drive
from facegear.drives.drive_keys import SECTIONS
from facegear.drives.drive_text import drive_text
from facegear.drives.file_values import checked_value
from facegear.drives.keys import Key
from facegear.support.plain_yaml import PlainYamlError, read_plain_yaml

Content = dict[str, Any]
"""What a drive file says: keys and values by section."""


# Keys whose value is greater than that of another one in the same section.
_GREATER_THAN = {"gear_teeth": "pinion_teeth", "highest_speed_rpm": "lowest_speed_rpm"}


def value_in(text: str, key: Key) -> Any:
    """Value of a key as somebody typed it.

    Parameters
    ----------
    text : str
        Of a list: its entries with commas or blanks between them, with brackets or without.
    key : Key

    Returns
    -------
    object
        As plain YAML gives it; it is not checked.

    Examples
    --------
    >>> value_in("26", SECTIONS["gears"].keys[0]), value_in("0, 120", SECTIONS["pinions"].keys[3])
    (26, [0, 120])
    """
    if key.kind in ("text", "choice"):
        return text
    if key.kind in ("numbers", "choices"):
        return [
            _number_or_text(entry) for entry in re.split(r"[\s,]+", text.strip().strip("[]").strip()) if entry
        ]
    return _number_or_text(text)


def _number_or_text(text: str) -> Any:
    try:
        value = read_plain_yaml(text)
    except PlainYamlError:
        return text
    return value if isinstance(value, int | float) else text


def needed() -> Iterator[tuple[str, tuple[Key, ...]]]:
    """Quantities that every drive file has, with the section that they stand in; keys of one say the same."""
    for name, section in SECTIONS.items():
        if section.required:
            for same in section.quantities():
                if same[0].default is None:
                    yield name, same


def missing(content: Content) -> list[str]:
    """Keys that a content lacks, as ``"gears.module_mm or gears.diametral_pitch_per_inch"``."""
    return [
        " or ".join(f"{section}.{key.name}" for key in same)
        for section, same in needed()
        if not any(key.name in content.get(section, {}) for key in same)
    ]


def completed(content: Content, ask: Callable[[str], str], tell: Callable[[str], object]) -> Content:
    """Ask for what a drive file needs, until it can be used.

    Parameters
    ----------
    content : dict
        What is known already; its name, too.
    ask : callable
        Given a question, returns the answer.
    tell : callable
        Given a sentence: what is wrong with an answer.

    Returns
    -------
    dict
    """
    content = {name: dict(value) if isinstance(value, dict) else value for name, value in content.items()}
    for section, same in needed():
        if not any(key.name in content.get(section, {}) for key in same):
            _ask_for(content, section, same[0], ask, tell)
    while True:
        try:
            parse_drive(drive_text(content), "together")
        except DriveFileError as problem:
            tell(str(problem))
            place = _named(str(problem))
            if place is None:
                raise
            _ask_for(content, *place, ask, tell)
        else:
            return content


def _ask_for(
    content: Content, section: str, key: Key, ask: Callable[[str], str], tell: Callable[[str], object]
) -> None:
    """Ask for one value until it is valid by itself."""
    while True:
        typed = ask(f"{section}.{key.name}: {key.plain_meaning} ({key.valid})? ")
        value = value_in(typed, key)
        try:
            checked_value(f"{section}.{key.name}", key, value)
            _require_greater(content, section, key, value)
        except (TypeError, ValueError) as problem:
            tell(str(problem))
        else:
            content.setdefault(section, {})[key.name] = value
            return


def _require_greater(content: Content, section: str, key: Key, value: Any) -> None:
    """Refuse at once what is not greater than a value that is known and must be less."""
    lesser = _GREATER_THAN.get(key.name)
    known = content.get(section, {}).get(lesser)
    if known is not None and not value > known:
        raise ValueError(
            f"{section}.{key.name} must be greater than {section}.{lesser} = {known:g}, got {value:g}"
        )


def _named(message: str) -> tuple[str, Key] | None:
    """Find the key that a message is about: the first that it names."""
    for section, name in re.findall(r"\b(\w+)\.(\w+)", message):
        if section in SECTIONS:
            for key in SECTIONS[section].keys:
                if key.name == name:
                    return section, key
    return None


def all_keys() -> Iterator[tuple[str, Key]]:
    """All keys of a drive file but its name, with their sections."""
    for name, section in SECTIONS.items():
        for key in section.keys:
            yield name, key
