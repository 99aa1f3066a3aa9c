"""What there is in the dissertation, section by section and figure by figure, and what of it the ledger covers.

``data/contents.yaml`` lists the sections with their equations, the tables and the figures; :func:`coverage` and
:func:`bare_equations` hold the rows of the ledger against it, so that a section or an equation without a row shows.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from compendium.printed import PrintedValue
from facegear.support.parameters import known_keys

_NUMBER = r"\d+\.\d+(?:\.\d+)?(?:\([a-z]\))?"
_LIST = rf"{_NUMBER}(?:(?:, and|,| and| to) {_NUMBER})*"
_EQUATION = r"\((\d+)-(\d+)\)"
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
    nothing_to_check : str
        Why the ledger has no row on it although it shows numbers; empty if it must have one.
    """

    number: str
    about: str
    data: bool = False
    not_drawn: str = ""
    nothing_to_check: str = ""

    @property
    def chapter(self) -> int:
        """Number of its chapter."""
        return int(self.number.split(".")[0])


@dataclass(frozen=True)
class WithoutRow:
    """Equations on which the ledger has no row.

    Attributes
    ----------
    numbers : str
        Their numbers, such as ``(2-1) to (2-3), (2-5)``.
    because : str
        Why there is nothing to compare.
    """

    numbers: str
    because: str


@dataclass(frozen=True)
class Contents:
    """The dissertation's section 1.3 and sections of chapters 2 to 8, its tables and its figures, in order."""

    sections: tuple[Section, ...]
    equations_without_row: tuple[WithoutRow, ...]
    tables: tuple[Section, ...]
    figures: tuple[PrintedFigure, ...]

    @property
    def equations(self) -> tuple[str, ...]:
        """Numbers of all equations, such as ``2-1``, in their order."""
        ranges = [section.equations for section in self.sections if section.equations]
        return tuple(number for first, last in ranges for number in cited_equations(f"({first}) to ({last})"))


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
        required = ("sections", "tables", "figures")
        lists = known_keys(path.name, lists, required, optional=("equations_without_row",))
        sections = tuple(_section(path.name, "section", entry) for entry in lists["sections"])
        without = tuple(_without_row(path.name, entry) for entry in lists.get("equations_without_row", ()))
        tables = tuple(_section(path.name, "table", entry) for entry in lists["tables"])
        figures = tuple(_figure(path.name, entry) for entry in lists["figures"])
    except (yaml.YAMLError, TypeError, ValueError) as error:
        raise ContentsError(f"{path.name}: {error}") from error
    for listed in (sections, tables, figures):
        numbers = [entry.number for entry in listed]
        repeated = sorted({number for number in numbers if numbers.count(number) > 1})
        if repeated:
            raise ContentsError(f"{path.name}: {', '.join(repeated)} stands more than once")
    return Contents(sections, without, tables, figures)


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


def cited_equations(text: str) -> tuple[str, ...]:
    """Numbers of the equations that a text names.

    Parameters
    ----------
    text : str
        Such as ``Equations (6-8) to (6-10), (6-12)``.

    Returns
    -------
    tuple of str
        Such as ``("6-8", "6-9", "6-10", "6-12")``: ranges written out, each once, in their order.
    """
    numbers: list[str] = []
    for match in re.finditer(rf"{_EQUATION}(?: to {_EQUATION})?", text):
        chapter, first, _, last = match.groups()
        numbers += [f"{chapter}-{number}" for number in range(int(first), int(last or first) + 1)]
    return tuple(dict.fromkeys(numbers))


def compared_equations(text: str) -> tuple[str, ...]:
    """As :func:`cited_equations`, without those that only mark a place, as in ``after (2-11)``."""
    return cited_equations(re.sub(rf"\b(?:after|before) {_EQUATION}", "", text))


def _named_equations(printed: Iterable[PrintedValue]) -> set[str]:
    return {number for value in printed for number in compared_equations(value.where)}


def bare_equations(contents: Contents, printed: Iterable[PrintedValue]) -> tuple[str, ...]:
    """Equations that neither a row of the ledger names nor the list of contents excuses.

    Parameters
    ----------
    contents : Contents
    printed : iterable of PrintedValue
        Their ``where`` names equations by number.
    """
    named = _named_equations(printed)
    excused = {
        number for entry in contents.equations_without_row for number in cited_equations(entry.numbers)
    }
    return tuple(number for number in contents.equations if number not in named | excused)


def equations_as_markdown(contents: Contents, printed: Sequence[PrintedValue]) -> str:
    """How many equations rows of the ledger name, and why the others have none, as text with a Markdown table."""
    named = _named_equations(printed)
    compared = [number for number in contents.equations if number in named]
    bare = bare_equations(contents, printed)
    lines = [
        f"Of {len(contents.equations)} numbered equations {len(compared)} are named by a row of the ledger.",
        "",
    ]
    lines += ["| without a row | because |", "|---|---|"]
    lines += [f"| {entry.numbers} | {entry.because} |" for entry in contents.equations_without_row]
    lines += [f"| {', '.join(f'({number})' for number in bare)} | **not compared yet** |"] * bool(bare)
    return "\n".join(lines)


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
    return any(section.has_equation(number) for number in cited_equations(where))


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


def _without_row(name: str, entry: Any) -> WithoutRow:
    known_keys(f"equations of {name}", entry, required=("numbers", "because"))
    if not cited_equations(str(entry["numbers"])):
        raise ValueError(f"numbers = {entry['numbers']!r} must name equations, as (2-1) to (2-3)")
    return WithoutRow(**entry)


def _figure(name: str, entry: Any) -> PrintedFigure:
    optional = ("data", "not_drawn", "nothing_to_check")
    known_keys(f"figure of {name}", entry, required=("number", "about"), optional=optional)
    _text_number(entry)
    return PrintedFigure(**entry)
