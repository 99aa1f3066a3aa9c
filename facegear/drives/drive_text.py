"""Drive files written: keys with their values, each with a comment that says what it is."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterator, Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any

import yaml

from facegear.drives.drive_file import DriveFile, DriveFileError, parse_drive
from facegear.drives.drive_keys import NAME, SECTIONS
from facegear.drives.keys import Key, Section, plain
from facegear.support.files import written_whole

_WIDTH = 110
_HEAD = "Drive file of facegear. A key that is commented out has the value that holds without it."


def write_drive_file(file: DriveFile, path: str | Path) -> Path:
    """Write a drive file that can be read again, with comments.

    Parameters
    ----------
    file : DriveFile
        As :func:`facegear.drives.drive_file.read_drive_file` or
        :func:`facegear.drives.drive_file.parse_drive` gave it.
    path : str or Path
        The file, which appears whole or not at all; its folder is made.

    Returns
    -------
    Path
        The file written. Reading it gives an equal `file`, to the last digit.

    Raises
    ------
    ValueError
        If parts of `file` were exchanged after it was read, so that its `content` no longer says what it is.

    Examples
    --------
    >>> import tempfile
    >>> import facegear as fg
    >>> from facegear.drives.drive_file import parse_drive
    >>> from facegear.drives.examples import example_text
    >>> file = parse_drive(example_text("case_1"))
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     again = fg.read_drive_file(fg.write_drive_file(file, f"{folder}/my_drive.yaml"))
    >>> again == file
    True
    """
    if not isinstance(file, DriveFile):
        raise TypeError(f"file must be a DriveFile, as read_drive_file returns it, got {file!r}")
    text = drive_text(file.content)
    try:
        again = parse_drive(text)
    except DriveFileError as problem:
        raise ValueError(f"file = {file.name!r}: its content is no drive: {problem}") from problem
    other = [part.name for part in fields(file) if getattr(again, part.name) != getattr(file, part.name)]
    if other:
        raise ValueError(
            f"file = {file.name!r} must be as it was read to be written: its content says something else than "
            f"{', '.join(other)}"
        )
    with written_whole(Path(path)) as place:
        place.write_text(text, encoding="utf-8")
    return Path(path)


def drive_text(content: Mapping[str, Any]) -> str:
    """Text of a drive file.

    Parameters
    ----------
    content : mapping
        Keys and values by section, as plain YAML gives them. Nothing is checked.

    Returns
    -------
    str
        YAML with a comment at each key. Keys that may be left out and are stand in comments with the values that they
        then have; so do the names of sections that are left out.
    """
    lines = [*_comment(_HEAD, ""), f"{NAME.name}: {_scalar(content.get(NAME.name, ''))}"]
    for name, section in SECTIONS.items():
        lines.append("")
        given = content.get(name)
        lines += _comment(plain(section.meaning), "")
        if name in content and not given:
            lines.append(f"{name}: {{}}")
        elif given is None and not section.assumed:
            keys = ", ".join(key.name for key in section.keys)
            lines += _comment(f"{name}: may have the keys {keys}", "", hanging=True)
        else:
            # A section of which nothing is given would be a key without a value.
            mark = "" if given else "# "
            lines.append(f"{mark}{name}:")
            lines += _section(section, given or {}, mark)
    return "\n".join(lines) + "\n"


def _section(section: Section, given: Mapping[str, Any], mark: str) -> Iterator[str]:
    for same in section.quantities():
        for key in same:
            if key.name in given:
                yield _line(f"  {key.name}: {_value(given[key.name])}", key)
            elif key.default is not None:
                yield _line(
                    f"{mark or '  # '}{'  ' if mark else ''}{key.name}: {_value(_listed(key.default))}", key
                )


def _line(start: str, key: Key) -> str:
    """One key, with what it means behind it, or above where that is long."""
    unit = f" [{key.unit}]" if key.unit else ""
    meaning = f"{key.plain_meaning}{unit}"
    if len(start) + len(meaning) + 3 <= _WIDTH:
        return f"{start} # {meaning}"
    return "\n".join([*_comment(meaning, "  "), start])


def _comment(words: str, indent: str, *, hanging: bool = False) -> list[str]:
    later = f"{indent}#   " if hanging else f"{indent}# "
    return textwrap.wrap(words, _WIDTH, initial_indent=f"{indent}# ", subsequent_indent=later)


def _listed(value: Any) -> Any:
    return list(value) if isinstance(value, tuple) else value


def _value(value: Any) -> str:
    if isinstance(value, list | tuple):
        return f"[{', '.join(_value(entry) for entry in value)}]"
    return _scalar(value)


def _scalar(value: Any) -> str:
    """One value in YAML: words bare where no reader takes them for something else, and in quotes otherwise."""
    if isinstance(value, str):
        if re.fullmatch(r"[a-z]+(_[a-z]+)*", value) and yaml.safe_load(value) == value:
            return value
        # On one line, whatever the text holds.
        return yaml.safe_dump(value, default_style='"', allow_unicode=True, width=10**6).rstrip("\n")
    return repr(value)
