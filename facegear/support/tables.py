"""Tables in files: CSV that programs read as columns and spreadsheets as nothing but text and numbers."""

from __future__ import annotations

import csv
import math
import re
import unicodedata
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from facegear.support.files import written_whole


def write_table(columns: Mapping[str, Sequence[Any]], path: str | Path) -> Path:
    """Write columns as CSV.

    Parameters
    ----------
    columns : mapping of str to sequence
        Heading with its unit to values; all of one length. Numbers are written to twelve digits, NaN as an
        empty cell. A heading or text
        that a spreadsheet would take for a formula, see :func:`defused`, gets an apostrophe before it.
    path : str or Path
        The file; its folder is made.

    Returns
    -------
    Path
        The file written, UTF-8 after a byte-order mark, without which Excel reads ° as Â°.

    Raises
    ------
    ValueError
        If the columns differ in length.
    """
    path = Path(path)
    with written_whole(path) as place, place.open("w", encoding="utf-8-sig", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(map(defused, columns))
        for row in zip(*columns.values(), strict=True):
            writer.writerow(map(_cell, row))
    return path


def _cell(value: Any) -> Any:
    if isinstance(value, float | np.floating):
        return "" if math.isnan(value) else f"{value:.12g}"
    return defused(value) if isinstance(value, str) else value


def defused(text: str) -> str:
    """Put an apostrophe before text that a spreadsheet would run as a formula.

    That is text that begins with =, +, -, @, also in full width, or with a tab or the end of a line; a number is none.

    Examples
    --------
    >>> defused("=1+1"), defused("-1.5"), defused("mean 2")
    ("'=1+1", '-1.5', 'mean 2')
    """
    first = unicodedata.normalize("NFKC", text[:1])
    risky = (
        bool(first) and first in "=+-@\t\r\n" and not re.fullmatch(r"[+-]\d+(\.\d*)?([eE][+-]?\d+)?", text)
    )
    return f"'{text}" if risky else text
