"""The ledger as readers see it: tables of a page, and one file of all rows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields
from decimal import Decimal
from pathlib import Path
from typing import Any

from compendium.breakable import breakable
from compendium.printed import STATUSES, LedgerRow, PrintedValue
from facegear.support.tables import write_table


def as_markdown(rows: Sequence[LedgerRow]) -> str:
    """Rows as a Markdown table: where, what, printed, computed, status."""
    lines = ["| where | quantity | printed | computed | status |", "|---|---|---|---|---|"]
    for row in rows:
        value = row.printed
        shown = "stated" if isinstance(value.printed, bool) else f"{value.printed} {value.unit}".strip()
        lines.append(_table_row(value.where, value.quantity, shown, _found(row), row.status))
    return "\n".join(lines)


def _table_row(*cells: str) -> str:
    """Row of a Markdown table; a bar inside a cell, as in |σ|, does not end it."""
    return "| " + " | ".join(cell.replace("|", r"\|") for cell in cells) + " |"


def _found(row: LedgerRow) -> str:
    """Write what this run found with two digits more than are printed, so that the rounding shows."""
    if row.computed is None:
        return "–"
    if isinstance(row.computed, bool):
        return "holds" if row.computed else "does not hold"
    digits = max(0, -int(Decimal(row.printed.printed).as_tuple().exponent)) + 2
    return f"{row.computed:.{digits}f} {row.printed.unit}".strip()


def counts_as_markdown(chapters: Mapping[int, Sequence[LedgerRow]]) -> str:
    """How many rows of each chapter and of all have each status, and are inputs, as a Markdown table.

    Parameters
    ----------
    chapters : mapping of int to sequence of LedgerRow
        Rows by number of the chapter.
    """
    lines = [
        f"| chapter | {' | '.join(STATUSES)} | all | of these inputs, taken over |",
        "|---" * (len(STATUSES) + 3) + "|",
    ]
    everything = [row for rows in chapters.values() for row in rows]
    for name, rows in [*chapters.items(), ("**all**", everything)]:
        counts = [sum(row.status == status for row in rows) for status in STATUSES]
        given = sum(row.printed.given for row in rows)
        lines.append(f"| {name} | {' | '.join(map(str, counts))} | {len(rows)} | {given} |")
    return "\n".join(lines)


def remarks_as_markdown(rows: Sequence[LedgerRow]) -> str:
    """Where, what is stated, what stands instead, and the evidence, as a Markdown table.

    The evidence is what was computed and how; a row that was not computed says what is missing.
    """
    lines = ["| where | stated | why not as it stands | evidence |", "|---|---|---|---|"]
    for row in rows:
        value = row.printed
        stated = value.quantity
        if not isinstance(value.printed, bool):
            stated += f": {value.printed} {value.unit}".rstrip()
        why = f"{value.convention} {value.remark}".strip()
        evidence = value.how if row.computed is None else f"{value.how}: {_found(row)}"
        lines.append(_table_row(value.where, stated, breakable(why), breakable(evidence)))
    return "\n".join(lines)


def save_csv(chapters: Mapping[int, Sequence[LedgerRow]], path: str | Path) -> Path:
    """Write all rows as one table, as :func:`facegear.support.tables.write_table` does.

    Parameters
    ----------
    chapters : mapping of int to sequence of LedgerRow
        Rows by number of the chapter.
    path : str or Path
        The file; its folder is made.
    """
    listed = [(number, row) for number, rows in chapters.items() for row in rows]
    columns: dict[str, list[Any]] = {"chapter": [number for number, _ in listed]}
    for field in fields(PrintedValue):
        columns[field.name] = [getattr(row.printed, field.name) for _, row in listed]
    columns["computed"] = [row.computed for _, row in listed]
    return write_table(columns, path)
