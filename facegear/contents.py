"""What there is in the dissertation, section by section and figure by figure, and what of it the ledger covers.

``data/contents.yaml`` lists the sections, tables and figures; :func:`coverage` holds the rows of the ledger against
it, so that a section without a row shows.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from facegear.parameters import known_keys
from facegear.printed import PrintedValue

_NUMBER = r"\d+\.\d+(?:\.\d+)?(?:\([a-z]\))?"
_LIST = rf"{_NUMBER}(?:(?:, and|,| and| to) {_NUMBER})*"
_NAMES = {"section": r"[Ss]ections?", "table": r"Tables?", "figure": r"Figs?\.?"}


class ContentsError(Exception):
    """The list of contents is missing or not as it must be."""


@dataclass(frozen=True)
class Section:
    """A section or a table of the dissertation.

    Attributes
    ----------
    kind : str
        ``section`` or ``table``.
    number : str
        Its number, such as ``3.5``.
    equations : tuple of str
        Its first and last numbered equation, such as ``3-8`` and ``3-18``; empty if it has none.
    nothing_to_check : str
        Why the ledger has no row on it; empty if it must have one.
    """

    kind: str
    number: str
    equations: tuple[str, ...] = ()
    nothing_to_check: str = ""

    @property
    def chapter(self) -> int:
        """Number of its chapter."""
        return int(self.number.split(".")[0])

    def has_equation(self, number: str) -> bool:
        """Whether an equation such as ``3-9`` stands in it."""
        if not self.equations:
            return False
        first, last, asked = (tuple(map(int, text.split("-"))) for text in (*self.equations, number))
        return first <= asked <= last


@dataclass(frozen=True)
class PrintedFigure:
    """A figure of the dissertation.

    Attributes
    ----------
    number : str
        Its number, such as ``4.4``.
    about : str
        What it shows, in a few words of our own.
    data : bool
        Whether it shows numbers, not only an arrangement.
    not_drawn : str
        Why it has no counterpart in the book; empty if it must have one.
    """

    number: str
    about: str
    data: bool = False
    not_drawn: str = ""

    @property
    def chapter(self) -> int:
        """Number of its chapter."""
        return int(self.number.split(".")[0])


@dataclass(frozen=True)
class Contents:
    """The dissertation's sections of chapters 2 to 8, its tables and its figures, in its order."""

    sections: tuple[Section, ...]
    tables: tuple[Section, ...]
    figures: tuple[PrintedFigure, ...]


@dataclass(frozen=True)
class Covered:
    """A section or table with the number of rows that the ledger has on it."""

    section: Section
    rows: int


def load_contents(path: str | Path) -> Contents:
    """Read the list of contents.

    Parameters
    ----------
    path : str or Path
        ``data/contents.yaml``.

    Raises
    ------
    ContentsError
        If the file is missing, a key is missing or unknown, a number is not text, or stands twice.
    """
    path = Path(path)
    if not path.is_file():
        raise ContentsError(f"list of contents {path.name} is missing in {path.parent}")
    try:
        lists = yaml.safe_load(path.read_text(encoding="utf-8"))
        known_keys(path.name, lists, required=("sections", "tables", "figures"))
        sections = tuple(_section(path.name, "section", entry) for entry in lists["sections"])
        tables = tuple(_section(path.name, "table", entry) for entry in lists["tables"])
        figures = tuple(_figure(path.name, entry) for entry in lists["figures"])
    except (yaml.YAMLError, TypeError, ValueError) as error:
        raise ContentsError(f"{path.name}: {error}") from error
    for listed in (sections, tables, figures):
        numbers = [entry.number for entry in listed]
        repeated = sorted({number for number in numbers if numbers.count(number) > 1})
        if repeated:
            raise ContentsError(f"{path.name}: {', '.join(repeated)} stands more than once")
    return Contents(sections, tables, figures)


def cited(text: str, kind: str) -> tuple[str, ...]:
    """Numbers of the sections, tables or figures that a text names.

    Parameters
    ----------
    text : str
        Such as ``Section 4.6, Figs 4.4(a) and 4.5(a)``.
    kind : str
        ``section``, ``table`` or ``figure``.

    Returns
    -------
    tuple of str
        Such as ``("4.4", "4.5")``: without parts, ranges written out, each once, in their order.

    Raises
    ------
    ValueError
        If the kind is none of the three.
    """
    if kind not in _NAMES:
        raise ValueError(f"kind = {kind!r} must be one of {', '.join(_NAMES)}")
    numbers: list[str] = []
    for match in re.finditer(rf"\b{_NAMES[kind]} ({_LIST})", text):
        parts = re.split(r"(, and|,| and| to) ", match[1])
        for joint, part in zip(["", *parts[1::2]], parts[::2], strict=True):
            number = part.split("(")[0]
            if joint == " to":
                numbers += _between(numbers[-1], number)
            numbers.append(number)
    return tuple(dict.fromkeys(numbers))


def coverage(contents: Contents, printed: Iterable[PrintedValue]) -> tuple[Covered, ...]:
    """Count the rows of the ledger on each section and table.

    Parameters
    ----------
    contents : Contents
    printed : iterable of PrintedValue
        A row counts for every section and table that its ``where`` names, by its number or that of an equation.
    """
    wheres = [value.where for value in printed]
    return tuple(
        Covered(section, sum(_is_about(section, where) for where in wheres))
        for section in (*contents.sections, *contents.tables)
    )


def coverage_as_markdown(covered: Sequence[Covered]) -> str:
    """Rows on each section and table as a Markdown table, with the reason where there is none."""
    lines = ["| in the dissertation | rows | without a row, because |", "|---|---|---|"]
    for entry in covered:
        section = entry.section
        reason = "" if entry.rows else section.nothing_to_check or "**not compared yet**"
        name = f"{section.kind.capitalize()} {section.number}"
        lines.append(f"| {name} | {entry.rows or ''} | {reason} |")
    return "\n".join(lines)


def _is_about(section: Section, where: str) -> bool:
    if section.number in cited(where, section.kind):
        return True
    return any(section.has_equation(number) for number in re.findall(r"\((\d+-\d+)\)", where))


def _between(first: str, last: str) -> list[str]:
    """Numbers strictly between two of the same chapter or section."""
    stem, low = first.rsplit(".", 1)
    high = last.rsplit(".", 1)[1]
    return [f"{stem}.{number}" for number in range(int(low) + 1, int(high))]


def _text_number(entry: Any) -> None:
    if not isinstance(entry["number"], str):
        raise ValueError(f"number = {entry['number']!r} must be in quotes, or 4.10 is read as 4.1")


def _section(name: str, kind: str, entry: Any) -> Section:
    known_keys(f"{kind} of {name}", entry, required=("number",), optional=("equations", "nothing_to_check"))
    _text_number(entry)
    equations = tuple(entry.get("equations", ()))
    if len(equations) not in (0, 2) or not all(re.fullmatch(r"\d+-\d+", str(text)) for text in equations):
        raise ValueError(f"{kind} {entry['number']}: equations must be the first and the last, as 3-8")
    return Section(kind, entry["number"], equations, entry.get("nothing_to_check", ""))


def _figure(name: str, entry: Any) -> PrintedFigure:
    known_keys(f"figure of {name}", entry, required=("number", "about"), optional=("data", "not_drawn"))
    _text_number(entry)
    return PrintedFigure(**entry)
