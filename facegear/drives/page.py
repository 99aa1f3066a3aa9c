"""A report as a page: sections of words, tables and pictures, and one HTML file that needs no network and no script.

Everything shown is text that is escaped here, wherever it comes from; pictures are SVG inside the page.
"""

from __future__ import annotations

import base64
import html
import io
import re
import unicodedata
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from facegear.drives.refusals import told
from facegear.support.provenance import made_by

if TYPE_CHECKING:
    from matplotlib.figure import Figure


_MAKER = "Made by facegear"


class Part(Protocol):
    """A piece of a section."""

    def as_html(self) -> str:
        """HTML that shows it."""
        ...


def escaped(words: str) -> str:
    """Text as HTML that shows it and does nothing else.

    Line breaks and other control characters become blanks.

    Parameters
    ----------
    words : str

    Returns
    -------
    str

    Examples
    --------
    >>> escaped("A <b> & 'c'")
    'A &lt;b&gt; &amp; &#x27;c&#x27;'
    """
    visible = "".join(" " if unicodedata.category(c) in ("Cc", "Cf", "Zl", "Zp") else c for c in words)
    return html.escape(visible)


def as_html(words: str) -> str:
    """Text as HTML, which no script of a book's page takes for a formula.

    Parameters
    ----------
    words : str

    Returns
    -------
    str

    Examples
    --------
    >>> as_html("A <b> & $x$")
    '<span class="tex2jax_ignore mathjax_ignore">A &lt;b&gt; &amp; $x$</span>'
    """
    return f'<span class="tex2jax_ignore mathjax_ignore">{escaped(words)}</span>'


@dataclass(frozen=True)
class Paragraph:
    """Words.

    Attributes
    ----------
    words : str
    mark : {"", "good", "bad"}
        Whether a green or red bar stands beside them.
    strong : bool
        Whether they are in bold.
    """

    words: str
    mark: str = ""
    strong: bool = False

    def as_html(self) -> str:
        """HTML that shows it."""
        colour = {"good": "#2e7d32", "bad": "#c62828"}.get(self.mark)
        style = f' style="border-left: 5px solid {colour}; padding-left: 0.7em"' if colour else ""
        shown = f"<strong>{as_html(self.words)}</strong>" if self.strong else as_html(self.words)
        return f"<p{style}>{shown}</p>"


@dataclass(frozen=True)
class Listing:
    """Points of a list; what is in backticks in them is shown as code.

    Attributes
    ----------
    points : tuple of str
    """

    points: tuple[str, ...]

    def as_html(self) -> str:
        """HTML that shows it."""
        return f"<ul>{''.join(f'<li>{_with_code(point)}</li>' for point in self.points)}</ul>"


def _with_code(words: str) -> str:
    first, *rest = words.split("`")
    shown = [as_html(first) if first else ""]
    for number, piece in enumerate(rest):
        shown.append(f"<code>{escaped(piece)}</code>" if number % 2 == 0 else as_html(piece))
    return "".join(shown)


def _with_minus(cell: str) -> str:
    """Put the sign of a negative number for the hyphen before it."""
    return re.sub(r"^-(?=\d)", "\N{MINUS SIGN}", cell)


@dataclass(frozen=True)
class Table:
    """Rows under headings.

    Attributes
    ----------
    headings : tuple of str
    rows : tuple of tuple of str
    caption : str
        What the table shows, for readers who cannot see it.
    """

    headings: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    caption: str

    def as_html(self) -> str:
        """HTML that shows it."""
        # In a notebook and in the book there is no style sheet of a report.
        room = 'style="padding: 0.2em 0.6em"'
        head = "".join(f'<th scope="col" {room}>{as_html(heading)}</th>' for heading in self.headings)
        body = "".join(
            f"<tr>{''.join(f'<td {room}>{as_html(_with_minus(cell))}</td>' for cell in row)}</tr>"
            for row in self.rows
        )
        return (
            '<div class="table" style="overflow-x: auto" tabindex="0" role="region" '
            f'aria-label="{escaped(self.caption)}">'
            f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>"
        )


@dataclass(frozen=True, eq=False)
class Picture:
    """A figure with its caption.

    Attributes
    ----------
    figure : matplotlib.figure.Figure
    caption : str
    alt : str
        What it shows, for readers who cannot see it.
    """

    figure: Figure
    caption: str
    alt: str

    def as_html(self) -> str:
        """HTML that shows it."""
        from matplotlib import rc_context

        buffer = io.BytesIO()
        # Without date and chance, which would make each page another.
        with rc_context({"svg.hashsalt": "facegear"}):
            self.figure.savefig(buffer, format="svg", metadata={"Date": None})
        drawn = base64.b64encode(buffer.getvalue()).decode()
        return (
            f'<figure><img src="data:image/svg+xml;base64,{drawn}" alt="{escaped(self.alt)}" '
            f'style="max-width: 100%; height: auto; background: white">'
            f"<figcaption><em>{as_html(self.caption)}</em></figcaption></figure>"
        )


@dataclass(frozen=True, eq=False)
class Section:
    """A part of a report.

    Attributes
    ----------
    title : str
    parts : tuple of Part
        In the order in which they are shown.
    """

    title: str
    parts: tuple[Part, ...]

    def as_html(self) -> str:
        """HTML that shows it, without the title."""
        return "\n".join(part.as_html() for part in self.parts)

    def _repr_html_(self) -> str:
        return self.as_html()


def is_page(path: Path) -> bool:
    """Whether there is a page at a path, and one that this package wrote."""
    try:
        return f"<footer>{_MAKER}" in path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError):
        return False


def attempted(title: str, make: Callable[[], Section]) -> Section:
    """Make a section, or one that says why there is none: what fails does not take the others along.

    Parameters
    ----------
    title : str
        Of the section, if it cannot be made.
    make : callable

    Returns
    -------
    Section
    """
    try:
        return make()
    except (ArithmeticError, ValueError, OSError) as problem:
        words = f"This part could not be computed, the others could: {told(problem)}"
        return Section(title, (Paragraph(words, "bad"),))


_STYLE = """
:root { color-scheme: light; }
body { font: 1rem/1.55 system-ui, "Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif; color: #222;
  background: #fff; max-width: 56rem; margin: 0 auto; padding: 1rem 1.25rem 3rem; overflow-wrap: break-word; }
h1 { font-size: 1.7rem; line-height: 1.25; }
h2 { font-size: 1.3rem; margin-top: 2.2rem; border-bottom: 1px solid #d9d9d9; }
.table { margin: 1rem 0; }
table { border-collapse: collapse; font-size: 0.92rem; font-variant-numeric: tabular-nums; overflow-wrap: normal; }
th, td { padding: 0.25rem 0.8rem 0.25rem 0; text-align: left; vertical-align: top; border-bottom: 1px solid #e6e6e6; }
th { border-bottom: 2px solid #767676; }
figure { margin: 1.2rem 0; }
figcaption { font-size: 0.92rem; color: #444; }
nav ul { columns: 18rem; padding-left: 1.1rem; }
a { color: #00588c; }
code { font-size: 0.92em; }
footer { margin-top: 3rem; font-size: 0.85rem; color: #555; border-top: 1px solid #d9d9d9; padding-top: 0.6rem; }
@media print {
  body { max-width: none; padding: 0; }
  figure, tr { break-inside: avoid; }
  nav { display: none; }
}
"""


def page(title: str, sections: Sequence[Section]) -> str:
    """Put sections on one page of HTML that fetches nothing and runs nothing.

    Parameters
    ----------
    title : str
        Any text.
    sections : sequence of Section

    Returns
    -------
    str
        The page forbids itself scripts and whatever a network has (its Content-Security-Policy).
    """
    made = made_by()
    commit = f", commit {made['facegear_commit']}" if "facegear_commit" in made else ""
    contents = "".join(
        f'<li><a href="#section-{number}">{escaped(section.title)}</a></li>'
        for number, section in enumerate(sections, start=1)
    )
    body = "\n".join(
        f'<section aria-labelledby="section-{number}"><h2 id="section-{number}">{escaped(section.title)}</h2>\n'
        f"{section.as_html()}\n</section>"
        for number, section in enumerate(sections, start=1)
    )
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; img-src data:; style-src 'unsafe-inline'">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{escaped(title)}</title>
<style>{_STYLE}</style>
</head>
<body>
<main>
<h1>{escaped(title)}</h1>
<nav aria-label="Sections"><ul>{contents}</ul></nav>
{body}
</main>
<footer>{_MAKER} {escaped(made["facegear_version"])}{escaped(commit)}.</footer>
</body>
</html>
"""
