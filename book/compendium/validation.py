"""Values from outside the package in one table, and how far each is from what the package finds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from compendium.breakable import breakable
from compendium.checks import check_anchors, element_at, load_anchors
from facegear.support.labelled import load


@dataclass(frozen=True)
class OutsideValue:
    """One value from outside and what the package finds.

    Attributes
    ----------
    what : str
        The quantity, Markdown.
    route : str
        Where the value from outside is from.
    outside, found : float
        In the same unit.
    unit : str
        Of both; empty if they have none.
    decimals : int, optional
        Of the value from outside as it is printed, a last zero among them; as many as show the deviation if left out.
    """

    what: str
    route: str
    outside: float
    found: float
    unit: str = ""
    decimals: int | None = None

    @property
    def deviation(self) -> float:
        """|found − outside| as a part of the larger of 1 and |outside| where there is no unit, else of |outside|."""
        scale = abs(self.outside) if self.unit else max(1.0, abs(self.outside))
        return abs(self.found - self.outside) / scale


@dataclass(frozen=True)
class AnchoredChapter:
    """The anchors of all figures of a chapter.

    Attributes
    ----------
    number : int
        Of the chapter.
    figures, anchors : int
        How many there are.
    median, deviation : float
        Difference from an anchor that is not zero, as a part of the largest magnitude of its array [-]: half of the
        differences are no larger than the first, and the second is the largest.
    figure : str
        The figure which that is in.
    fraction : float
        The largest difference as a fraction of its anchor's tolerance [-].
    """

    number: int
    figures: int
    anchors: int
    median: float
    deviation: float
    figure: str
    fraction: float


def readable(value: float) -> str:
    r"""Return a number of two digits as a reader writes it, in Markdown: 0.034, or a power of ten as a formula.

    Examples
    --------
    >>> readable(1.62e-6), readable(0.25), readable(0.0)
    ('$1.6\\cdot10^{-6}$', '0.25', '0')
    """
    if value == 0.0:
        return "0"
    if 0.001 <= abs(value) < 1000.0:
        return f"{value:.2g}" if abs(value) < 100.0 else f"{value:.0f}"
    digits, exponent = f"{value:.1e}".split("e")
    return rf"${digits}\cdot10^{{{int(exponent)}}}$"


def as_markdown(values: Sequence[OutsideValue]) -> str:
    """Return values from outside as a Markdown table."""
    lines = ["| quantity | source | value | here | deviation |", "|---|---|--:|--:|--:|"]
    for value in values:
        # Enough to see the deviation in.
        digits = 10 if value.deviation < 1e-7 else 8
        unit = f" [{value.unit}]" if value.unit else ""
        shown = f".{digits}g" if value.decimals is None else f".{value.decimals}f"
        numbers = f"{value.outside:{shown}} | {value.found:.{digits}g}"
        lines.append(f"| {value.what}{unit} | {value.route} | {numbers} | {readable(value.deviation)} |")
    return "\n".join(lines)


def anchored(data_directory: str | Path) -> tuple[AnchoredChapter, ...]:
    """Hold the stored arrays of all figures against their anchors, chapter by chapter.

    Each chapter compares what it computes with these arrays and with these anchors when it is built.

    Raises
    ------
    ReferenceCheckError
        If an anchor's element is not there, or differs by more than its tolerance.
    """
    differences: dict[int, list[tuple[float, str]]] = {}
    fractions: dict[int, dict[str, float]] = {}
    counts: dict[int, int] = {}
    for path in sorted((Path(data_directory) / "anchors").glob("ch*.yaml")):
        number = int(path.stem[2:4])
        arrays = load(Path(data_directory) / "reference" / f"{path.stem}.nc")
        anchors = load_anchors(path)
        fractions.setdefault(number, {})[path.stem] = check_anchors(arrays, anchors, path.stem)
        counts[number] = counts.get(number, 0) + len(anchors)
        for anchor in (anchor for anchor in anchors if anchor.value):
            error = abs(element_at(arrays, anchor, path.stem) - anchor.value)
            scale = float(np.nanmax(np.abs(arrays[anchor.variable].values)))
            differences.setdefault(number, []).append((error / scale, path.stem))
    return tuple(
        AnchoredChapter(
            number,
            len(fractions[number]),
            counts[number],
            float(np.median([difference for difference, _ in found])),
            *max(found),
            max(fractions[number].values()),
        )
        for number, found in sorted(differences.items())
    )


def chapters_as_markdown(chapters: Sequence[AnchoredChapter]) -> str:
    """Return the anchors of the chapters as a Markdown table."""
    lines = [
        "| chapter | anchors of figures | median deviation | largest | in | of a tolerance at most |",
        "|--:|--:|--:|--:|---|--:|",
    ]
    lines += [
        f"| {row.number} | {row.anchors} of {row.figures} | {readable(row.median)} "
        f"| {readable(row.deviation)} | {breakable(f'`{row.figure}`')} | {100.0 * row.fraction:.0f} % |"
        for row in chapters
    ]
    return "\n".join(lines)
