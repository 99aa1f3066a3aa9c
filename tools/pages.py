"""Pages of the book that are put together from what the build knows: index of figures, run times, citation.

`dodo.py` writes them into the source folder of the book beside the pages that people write.
"""

import re
from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

import nbformat
import yaml

from compendium.contents import PrintedFigure, cited, load_contents

FIGURE_INDEX = """\
(figure-index)=
# Find a figure of the dissertation

Every figure in the dissertation's list {{cite}}`peng2012`, and where this book has what it shows. {shown} of {data}
figures that show numbers are computed here. Of drawings and flow charts the book has its own where they help.

{chapters}
"""

RUN_TIMES = """\
(run-times)=
# Look up how long each notebook runs

Wall time of each notebook the last time this build executed it, as papermill recorded it: {total:.0f} s in sum, with
up to two notebooks at once on the same machine. A build redoes only what has changed, so that rows may be of different
days. What a single map costs is measured on {{doc}}`notebooks/91_performance`.

| wall time [s] | notebook | longest cell [s] | which is under | code cells | executed (UTC) |
|--:|---|--:|---|--:|---|
{rows}
"""


@dataclass(frozen=True)
class BookFigure:
    """A figure of a notebook: its label, its caption without Markdown links, the page it is on."""

    label: str
    caption: str
    page: str

    @property
    def name(self) -> str:
        """Number of the figure of the dissertation that its label names, such as 4.9, or an empty string."""
        found = re.fullmatch(r"fig-(\d+)-(\d+)(?:[a-z]|-[\w-]+)?", self.label)
        return f"{found[1]}.{found[2]}" if found else ""


def figures_of(notebook: Path) -> list[BookFigure]:
    """Return the labelled figures of a notebook, in its order."""
    found = []
    for cell in nbformat.read(notebook, as_version=4).cells:
        figure = cell.metadata.get("mystnb", {}).get("figure", {})
        if "name" in figure:
            caption = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", figure["caption"])
            found.append(BookFigure(figure["name"], caption, notebook.stem))
    return found


def numbers_of(cell: nbformat.NotebookNode, stored: Collection[str]) -> list[str]:
    """Return the names of the stored arrays that a figure's cell shows, as far as cell and label tell.

    Those that the cell hands to its chapter by name, or else those of the figure of the dissertation in its label.
    """
    figure = cell.metadata["mystnb"]["figure"]
    named = re.findall(r'\bchapter\.figure\(\s*"(\w+)"', cell.source)
    found = [name for name in dict.fromkeys(named) if name in stored]
    label = re.fullmatch(r"fig-(\d+)-(\d+)([a-z]?)", figure.get("name", ""))
    if not found and label:
        name = f"ch{int(label[1]):02d}_figure_{label[1]}_{int(label[2]):02d}"
        found = [known for known in sorted(stored) if re.fullmatch(name + (label[3] or "[a-z]?"), known)]
    return found


def offer_numbers(cell: nbformat.NotebookNode, stored: Collection[str]) -> None:
    """Give the caption of a figure's cell links to the arrays it shows, unless its caption has some."""
    figure = cell.metadata.get("mystnb", {}).get("figure", {})
    if "caption" not in figure or ".nc" in figure["caption"]:
        return
    links = []
    names = numbers_of(cell, stored)
    for name in names:
        part = re.fullmatch(r"ch\d+_figure_\d+_\d+([a-z])", name)
        text = f"({part[1]})" if part else name.split("_", 1)[1].replace("_", " ")
        links.append(f"{{download}}`{text if len(names) > 1 else 'netCDF'} <../data/{name}.nc>`")
    if links:
        figure["caption"] += f" Numbers: {', '.join(links)}."


# Code, fenced or not, formulas and tags: what is not running text. And numbers as computers write them.
NOT_TEXT = re.compile(r"(```.*?```|`[^`\n]*`|\$\$.*?\$\$|\$[^$\n]*\$|</?[a-z][^>\n]*>)", re.DOTALL)
WITH_EXPONENT = re.compile(r"(?<![\w.])([-+−]?\d+(?:\.\d+)?)[eE]([-+]?\d+)(?![\w])")
MINUS_ZERO = re.compile(r"(?<![\w.)])[-−](0(?:\.0+)?)(?![\d.\w])")
# A hyphen before a number is a minus; one between two numbers is not, unless the second is an imaginary part.
HYPHEN_FOR_MINUS = re.compile(r"(?<![\w.)\]}-])-(?=\d)|(?<=\d)-(?=[\d.]+i\b)")
# A power of ten that stands as the unit of a printed value.
POWER_AS_UNIT = re.compile(r"(?<=\d) (?=10[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)")
SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def _power_of_ten(number: re.Match[str], formula: bool) -> str:
    digits, exponent = number[1].replace("−", "-"), int(number[2])
    if -4 <= exponent <= 4:
        decimals = max(0, len(digits.partition(".")[2]) - exponent)
        return f"{float(f'{digits}e{exponent}'):.{decimals}f}"
    power = f"10^{{{exponent}}}" if formula else f"10{str(exponent).translate(SUPERSCRIPTS)}"
    sign, size = ("-", digits[1:]) if digits[0] == "-" else ("", digits.removeprefix("+"))
    if float(size) == 1.0:
        return sign + power
    times = r"\cdot " if formula else "·"
    return f"{sign}{size}{times}{power}"


def _in_running_text(text: str, change: Callable[[str, bool], str]) -> str:
    """Change what is running text or a formula, by a function that is told which; code and tags stay."""
    parts = NOT_TEXT.split(text)  # every second one is what the pattern has found
    for place, part in enumerate(parts):
        if place % 2 == 0 or part.startswith("$"):
            parts[place] = change(part, place % 2 == 1)
    return "".join(parts)


def _with_powers(part: str, formula: bool) -> str:
    return WITH_EXPONENT.sub(lambda number: _power_of_ten(number, formula), part)


def with_powers_of_ten(text: str) -> str:
    """Write 1.6·10⁻⁶ for 1.6e-06 and 10470 for 1.047e+04; in a formula, a power of ten of TeX; not in code."""
    return _in_running_text(text, _with_powers)


def in_readers_digits(text: str) -> str:
    """Write the numbers in a text as a reader does: with powers of ten, 0.00 for −0.00, and −2 for -2."""

    def change(part: str, formula: bool) -> str:
        part = _with_powers(part, formula)
        part = part if formula else POWER_AS_UNIT.sub("·", part)
        return part if formula else HYPHEN_FOR_MINUS.sub("−", MINUS_ZERO.sub(r"\1", part))

    return _in_running_text(text, change)


# The hyphen at the beginning of a cell of a table of HTML.
HYPHEN_IN_CELL = re.compile(r"(<td[^>]*>)-(?=\d)")


def put_outputs_in_readers_digits(cell: nbformat.NotebookNode) -> None:
    """Do that to what a cell shows as text of the page or leaves to be quoted there; in tables of HTML a minus."""
    for output in cell.get("outputs", []):
        data = output.get("data", {})
        for kind in ("text/markdown", "application/papermill.record/text/plain"):
            if kind in data:
                data[kind] = in_readers_digits(data[kind])
        if "text/html" in data:
            data["text/html"] = HYPHEN_IN_CELL.sub(r"\1−", data["text/html"])


def counterparts(printed: PrintedFigure, figures: Iterable[BookFigure]) -> list[BookFigure]:
    """Return the figures of the book that show what a figure of the dissertation shows.

    Those whose label names it; if there is none, those whose caption does.
    """
    figures = list(figures)
    named = [figure for figure in figures if figure.name == printed.number]
    return named or [figure for figure in figures if printed.number in cited(figure.caption, "figure")]


@dataclass(frozen=True)
class Row:
    """A row of the index: a figure of the dissertation, or neighbours that are left out for one reason."""

    printed: tuple[PrintedFigure, ...]
    here: str

    def as_markdown(self) -> str:
        """Return the row of a table."""
        first, last = self.printed[0], self.printed[-1]
        number = first.number if first is last else f"{first.number} to {last.number}"
        about = "; ".join(printed.about for printed in self.printed)
        return f"| {number} | {about if first.data else f'{about} (drawing)'} | {self.here} |"


def figure_index(contents: Path, notebooks: Sequence[Path]) -> str:
    """Return the page that leads from each figure of the dissertation to the book's.

    Raises
    ------
    ValueError
        If a figure with numbers, of a chapter that the book has, is neither shown nor explained.
    """
    figures = [figure for notebook in notebooks for figure in figures_of(notebook)]
    present = {int(path.stem[:2]) for path in notebooks if re.match(r"0\d_", path.stem)}
    listed = load_contents(contents).figures
    rows: dict[int, list[Row]] = {}
    missing = []
    shown = 0
    for printed in listed:
        found = counterparts(printed, figures)
        shown += printed.data and bool(found)
        here = ", ".join(f"{{numref}}`{figure.label}`" for figure in found)
        reason = printed.not_drawn[:1].lower() + printed.not_drawn[1:]
        here = here or (f"not drawn: {reason}" if reason else "its chapter is not in the book yet")
        if not found and not printed.not_drawn and printed.chapter in present:
            missing.append(printed.number)
        chapter = rows.setdefault(printed.chapter, [])
        if chapter and not found and chapter[-1].here == here:
            chapter[-1] = Row((*chapter[-1].printed, printed), here)
        else:
            chapter.append(Row((printed,), here))
    if missing:
        raise ValueError(
            f"{contents.name}: figures {', '.join(missing)} are in no notebook (a label fig-N-M or a caption "
            "with their number) and have no `not_drawn` that says why"
        )
    chapters = [
        f"## Chapter {number}\n\n| figure | what it shows | in this book |\n|---|---|---|\n"
        + "\n".join(row.as_markdown() for row in chapter)
        for number, chapter in rows.items()
    ]
    return FIGURE_INDEX.format(
        shown=shown, data=sum(printed.data for printed in listed), chapters="\n\n".join(chapters)
    )


def run_times(executed: Sequence[Path]) -> str:
    """Return the page of run times.

    Raises
    ------
    ValueError
        If a notebook was not executed by papermill.
    """
    rows, total = [], 0.0
    for path in executed:
        notebook = nbformat.read(path, as_version=4)
        record = notebook.metadata.get("papermill")
        if record is None:
            raise ValueError(f"{path.name} carries no record of papermill: it was not executed by this build")
        total += record["duration"]
        heading, longest, cells = "", (0.0, ""), 0
        for cell in notebook.cells:
            if cell.cell_type == "markdown":
                heading = ([heading, *re.findall(r"^#+ (.+)$", cell.source, re.MULTILINE)])[-1]
            elif cell.source.strip():
                cells += 1
                # No `duration` on a cell that papermill was told to skip.
                longest = max(longest, (cell.metadata.papermill.get("duration") or 0.0, heading))
        moment = datetime.fromisoformat(record["start_time"]).strftime("%Y-%m-%d %H:%M")
        rows.append(
            f"| {record['duration']:.1f} | {{doc}}`notebooks/{path.stem}` | {longest[0]:.1f} | {longest[1]} "
            f"| {cells} | {moment} |"
        )
    return RUN_TIMES.format(total=total, rows="\n".join(rows))


def bibtex(citation: Path) -> str:
    """Return the BibTeX entry that `CITATION.cff` amounts to, and that of the work it refers to."""
    cff = yaml.safe_load(citation.read_text(encoding="utf-8"))
    (thesis,) = cff["references"]
    authors = " and ".join(f"{{{author['name']}}}" for author in cff["authors"])
    people = " and ".join(f"{a['family-names']}, {a['given-names']}" for a in thesis["authors"])
    fields = {
        "title": f"{{{cff['title']}}}",
        "author": authors,
        "version": cff["version"],
        "year": str(cff["date-released"])[:4],
        "note": "Research compendium: book and Python module",
    }
    first = ",\n".join(f"  {name} = {{{value}}}" for name, value in fields.items())
    fields = {
        "title": f"{{{thesis['title']}}}",
        "author": people,
        "school": thesis["institution"]["name"],
        "year": thesis["year"],
        "url": thesis["url"],
    }
    second = ",\n".join(f"  {name} = {{{value}}}" for name, value in fields.items())
    return f"@software{{facegear,\n{first}\n}}\n\n@phdthesis{{peng2012,\n{second}\n}}\n"
