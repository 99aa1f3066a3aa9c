"""What a drive file holds, checked key by key: values in SI, and the keys that gave them.

Of a wrong value one sentence says which key, by its dotted path, what it holds, what would be valid and, where that can
be guessed, what was meant.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from facegear.drives.drive_keys import NAME, SECTIONS
from facegear.drives.keys import LONGEST_TEXT, MOST_PINIONS, Key
from facegear.support.parameters import within

# Factors by which people miss a unit, after that to SI.
_FACTORS = (1e3, 1e-3, 1e6, 1e-6, 1e9, 1e-9)
# Nobody writes their thousandth parts.
_WITHOUT_PREFIX = ("°", "%", "rpm", "hp", "1/in")
_DECIMAL_COMMA = re.compile(r"\s*[-+]?\d+,\d+([eE][-+]?\d+)?\s*", re.ASCII)
_WITH_UNIT = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)([eE][-+]?\d+)?)\s*[^\d\s.,:eE-].*", re.ASCII)


@dataclass(frozen=True)
class FileValues:
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

    def replaced(self, section: str, **values: Any) -> FileValues:
        """Return a copy with other values in one section."""
        return replace(self, values={**self.values, section: {**self.values[section], **values}})


def checked_values(content: Any) -> FileValues:
    """Check every key of a drive file by itself.

    Parameters
    ----------
    content : object
        What the file says, as plain YAML gives it.

    Returns
    -------
    FileValues

    Raises
    ------
    TypeError, ValueError
        If it is no mapping of sections, a key is unknown or missing, or its value as :func:`checked_value` has it.
    """
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
    return FileValues(checked_value(NAME.name, NAME, content.get(NAME.name)), values, chosen)


def _chosen(section: str, same: tuple[Key, ...], entries: Mapping[str, Any]) -> Key:
    """Find the one key that a file uses of those that say the same."""
    names = " or ".join(f"{section}.{key.name}" for key in same)
    given = [key for key in same if key.name in entries]
    if len(given) > 1:
        both = " and ".join(f"{section}.{key.name} = {_shown(entries[key.name])}" for key in given)
        raise ValueError(f"{both} say the same: give one of them")
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
        if "\0" in value:
            # Many programs end a text there, netCDF's readers among them.
            raise ValueError(f"{path} must be {key.valid}, none of them NUL, got {_shown(value)}")
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
            raise TypeError(f"{path} must be {key.valid}, got {_shown(value)}{_text_hint(key, value)}")
        return tuple(key.to_si(_number(f"{path}[{i}]", key, entry)) for i, entry in enumerate(value))
    if key.kind == "integer":
        number = isinstance(value, int) and not isinstance(value, bool)
        if not (number and key.allows(value)):
            error = ValueError if number else TypeError
            raise error(f"{path} must be {key.valid_entry}, got {_shown(value)}{_text_hint(key, value)}")
        return int(value)
    return key.to_si(_number(path, key, value))


def _number(path: str, key: Key, value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise TypeError(f"{path} must be {key.valid_entry}, got {_shown(value)}{_text_hint(key, value)}")
    if key.or_zero and value == 0:
        return 0.0
    return within(path, value, key.lowest, key.highest, key.unit, _unit_hint(path, key, value))


def _text_hint(key: Key, value: Any) -> str:
    """Guess at what made a text of a number that would be valid."""
    if not isinstance(value, str):
        return ""
    if _DECIMAL_COMMA.fullmatch(value):
        meant, words = value.strip().replace(",", "."), "a point, not a comma"
    elif match := _WITH_UNIT.fullmatch(value):
        meant, words = match[1], "the number alone, its unit is that of the key"
    else:
        return ""
    is_valid = key.allows(float(meant)) and (key.kind != "integer" or meant.isdigit())
    return f" ({words}: {meant})" if is_valid else ""


def _unit_hint(path: str, key: Key, value: float) -> str:
    """Guess at a wrong unit: the value that would be valid."""
    if key.hint:
        return key.hint
    hints = [f"a ratio, not {key.no_unit}?"] if key.no_unit and value > key.highest else []
    prefixes = () if key.unit in _WITHOUT_PREFIX else _FACTORS
    factors = (key.to_si(1.0) ** -1, *prefixes) if key.unit else (1e-3,) if key.no_unit else ()
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
