"""A drive file made by asking for what it needs, or from values that are given."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from facegear.drives.drive_file import DriveFileError, parse_drive
from facegear.drives.drive_keys import SECTIONS
from facegear.drives.drive_text import drive_text
from facegear.drives.examples import example_text
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


def _lacking(content: Content) -> Iterator[tuple[str, tuple[Key, ...]]]:
    """Quantities of which a content has no key."""
    for section, same in needed():
        if not any(key.name in content.get(section, {}) for key in same):
            yield section, same


def missing(content: Content) -> list[str]:
    """Keys that a content lacks, as ``"gears.module_mm or gears.diametral_pitch_per_inch"``."""
    return [" or ".join(f"{section}.{key.name}" for key in same) for section, same in _lacking(content)]


def completed(content: Content, ask: Callable[[str], str], tell: Callable[[str], object]) -> Content:
    """Ask for what a drive file needs, until it can be used; what cannot be right beside what is known, at once again.

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
    while True:
        unknown = [(section, same[0]) for section, same in _lacking(content)]
        problem = _problem(content, unknown)
        place = problem and _named(problem)
        if problem and place and _is_of_what_is_known(problem, place, unknown):
            tell(problem)
            _ask_for(content, *place, ask, tell)
        elif unknown:
            _ask_for(content, *unknown[0], ask, tell)
        elif problem:
            raise DriveFileError(problem)
        else:
            return content


def _problem(content: Content, unknown: Sequence[tuple[str, Key]]) -> str:
    """Say what is wrong with a content, with values of an example for what is unknown; nothing if it can be used."""
    whole = {name: dict(value) if isinstance(value, dict) else value for name, value in content.items()}
    usual = read_plain_yaml(example_text("case_1"))
    for section, key in unknown:
        whole.setdefault(section, {})[key.name] = usual[section][key.name]
    try:
        parse_drive(drive_text(whole), "together")
    except DriveFileError as problem:
        return str(problem)
    return ""


def _is_of_what_is_known(problem: str, place: tuple[str, Key], unknown: Sequence[tuple[str, Key]]) -> bool:
    """Whether a mistake remains whatever is answered next: it names no key that is unknown, nor follows one."""
    order = [(section, key.name) for section, key in all_keys()]
    at = order.index((place[0], place[1].name))
    return not any(
        f"{section}.{key.name}" in problem or order.index((section, key.name)) < at
        for section, key in unknown
    )


def _ask_for(
    content: Content, section: str, key: Key, ask: Callable[[str], str], tell: Callable[[str], object]
) -> None:
    """Ask for one value until it is valid by itself; it stands for what says the same in another unit."""
    while True:
        typed = ask(f"{section}.{key.name}: {key.plain_meaning} ({key.valid})? ")
        value = value_in(typed, key)
        try:
            checked_value(f"{section}.{key.name}", key, value)
            _require_greater(content, section, key, value)
        except (TypeError, ValueError) as problem:
            tell(str(problem))
        else:
            others = {
                name: known
                for name, known in content.get(section, {}).items()
                if name not in {same.name for same in SECTIONS[section].keys if same.si_name == key.si_name}
            }
            content[section] = {**others, key.name: value}
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
