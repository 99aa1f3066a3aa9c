"""The numbers and statements printed in the dissertation, and the verdict on each.

``data/printed/chNN.yaml`` (or ``chNN_topic.yaml``) holds what the text prints: where, what, the digits as printed,
the unit, and the status that the compendium claims. A chapter computes the same quantities and hands them to
:func:`ledger`, which works the status out from the numbers and refuses to go on if it is not the one claimed.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from decimal import Decimal, InvalidOperation
from pathlib import Path
from typing import Any

import yaml

from facegear.support.files import written_whole
from facegear.support.parameters import known_keys

REPRODUCED = "reproduced"
REPRODUCED_UNDER_CONVENTION = "reproduced under a stated convention"
DIFFERS = "differs"
UNDECIDED = "cannot be decided from the text"
STATUSES = (REPRODUCED, REPRODUCED_UNDER_CONVENTION, DIFFERS, UNDECIDED)
HOLDING = (REPRODUCED, REPRODUCED_UNDER_CONVENTION)

_REQUIRED = ("id", "where", "quantity", "printed", "how", "status", "remark")
_OPTIONAL = ("unit", "convention", "given")


class LedgerError(Exception):
    """The printed values and the computed ones do not fit together as claimed."""


@dataclass(frozen=True)
class PrintedValue:
    """One printed number or checkable statement.

    Attributes
    ----------
    id : str
        Name under which a chapter computes it.
    where : str
        Section, equation, figure or table of the dissertation.
    quantity : str
        What is stated, in our own words.
    printed : str or bool
        The digits as printed (their number sets the tolerance: half a unit of the last one), or ``True`` for a
        statement.
    unit : str
        Unit of the printed number; empty for pure numbers and statements.
    how : str
        How it is computed here.
    convention : str
        What the text leaves open and had to be chosen to reproduce it; empty if nothing.
    given : bool
        Whether it is an input that was taken over from a table or a caption, and not a result.
    status : str
        One of :data:`STATUSES`.
    remark : str
        One sentence.
    """

    id: str
    where: str
    quantity: str
    printed: str | bool
    how: str
    status: str
    remark: str
    unit: str = ""
    convention: str = ""
    given: bool = False

    def holds(self, computed: float | bool) -> bool:
        """Whether a computed value agrees with the printed one to every printed digit.

        Raises
        ------
        LedgerError
            If a statement is answered by a number or a number by a truth value.
        """
        if isinstance(self.printed, bool):
            if not isinstance(computed, bool):
                raise LedgerError(f"{self.id}: a statement needs True or False, got {computed!r}")
            return computed is self.printed
        if isinstance(computed, bool):
            raise LedgerError(f"{self.id}: a printed number needs a number, got {computed!r}")
        if not math.isfinite(computed):
            return False
        number = Decimal(self.printed)
        half_digit = Decimal(5).scaleb(int(number.as_tuple().exponent) - 1)
        return abs(Decimal(float(computed)) - number) <= half_digit

    def verdict(self, computed: float | bool | None) -> str:
        """Status that follows from a computed value; ``None`` says that the text does not allow one."""
        if computed is None:
            return UNDECIDED
        if not self.holds(computed):
            return DIFFERS
        return REPRODUCED_UNDER_CONVENTION if self.convention else REPRODUCED


@dataclass(frozen=True)
class LedgerRow:
    """A printed value with ours beside it.

    Attributes
    ----------
    printed : PrintedValue
        What the text says.
    computed : float, bool or None
        What this run found, in the printed unit.
    status : str
        The verdict.
    """

    printed: PrintedValue
    computed: float | bool | None
    status: str


def load_printed(path: str | Path) -> tuple[PrintedValue, ...]:
    """Read the printed values of one chapter.

    Parameters
    ----------
    path : str or Path
        A YAML list of mappings with the fields of :class:`PrintedValue`.

    Raises
    ------
    LedgerError
        If the file is missing or empty, a key is missing or unknown, an id stands twice, a status is not one of
        :data:`STATUSES`, or a number is not written as text in digits.
    """
    path = Path(path)
    if not path.is_file():
        raise LedgerError(f"file of printed values {path.name} is missing in {path.parent}")
    try:
        entries = yaml.safe_load(path.read_text(encoding="utf-8"))
    except yaml.YAMLError as error:
        raise LedgerError(f"{path.name} is not YAML: {error}") from error
    if not isinstance(entries, list) or not entries:
        raise LedgerError(f"{path.name} must hold a list of printed values")
    values = tuple(_printed_value(path.name, entry) for entry in entries)
    ids = [value.id for value in values]
    repeated = sorted({name for name in ids if ids.count(name) > 1})
    if repeated:
        raise LedgerError(f"{path.name}: {', '.join(repeated)} stands more than once")
    return values


def ledger(
    printed: tuple[PrintedValue, ...], computed: Mapping[str, float | bool | None]
) -> tuple[LedgerRow, ...]:
    """Put the computed values beside the printed ones and verify the claimed status of each.

    Parameters
    ----------
    printed : tuple of PrintedValue
        From :func:`load_printed`.
    computed : mapping of str to float, bool or None
        This run's values under the same ids, in the printed units.

    Returns
    -------
    tuple of LedgerRow
        In the order of ``printed``.

    Raises
    ------
    LedgerError
        If a value was not computed, a computed one is not printed, or a status does not follow from the numbers.
    """
    faults = [f"{name}: printed but not computed" for name in sorted({v.id for v in printed} - set(computed))]
    faults += [
        f"{name}: computed but not printed" for name in sorted(set(computed) - {v.id for v in printed})
    ]
    if faults:
        raise LedgerError("\n".join(faults))
    rows = tuple(LedgerRow(value, computed[value.id], value.verdict(computed[value.id])) for value in printed)
    faults = [
        f"{row.printed.id}: printed {row.printed.printed}, computed {row.computed!r} is '{row.status}', "
        f"the file claims '{row.printed.status}'"
        for row in rows
        if row.status != row.printed.status
    ]
    if faults:
        raise LedgerError("\n".join(faults))
    return rows


def save_ledger(rows: tuple[LedgerRow, ...], path: str | Path) -> Path:
    """Write the rows of one chapter as YAML for the ledger page; the file appears whole or not at all."""
    path = Path(path)
    content = [{**asdict(row.printed), "computed": row.computed} for row in rows]
    with written_whole(path) as place, place.open("w", encoding="utf-8") as stream:
        yaml.safe_dump(content, stream, sort_keys=False, allow_unicode=True)
    return path


def load_ledger(path: str | Path) -> tuple[LedgerRow, ...]:
    """Read what :func:`save_ledger` wrote, verifying every status again.

    Raises
    ------
    LedgerError
        As :func:`load_printed` and :func:`ledger`.
    """
    path = Path(path)
    if not path.is_file():
        raise LedgerError(f"ledger {path.name} is missing in {path.parent}: execute its chapter first")
    entries = yaml.safe_load(path.read_text(encoding="utf-8"))
    computed = {entry["id"]: entry.pop("computed") for entry in entries}
    return ledger(tuple(_printed_value(path.name, entry) for entry in entries), computed)


def load_chapters(printed_folder: str | Path, ledger_folder: str | Path) -> dict[int, tuple[LedgerRow, ...]]:
    """Read the ledgers of all chapters, verifying every status again.

    Parameters
    ----------
    printed_folder : str or Path
        Holds the files of printed values, ``chNN.yaml`` or ``chNN_topic.yaml``.
    ledger_folder : str or Path
        Holds what :func:`save_ledger` wrote under the same names.

    Returns
    -------
    dict of int to tuple of LedgerRow
        Rows by number of the chapter, its files one after the other.

    Raises
    ------
    LedgerError
        If a file name does not begin with the number of a chapter, a ledger is not that of its file of printed values,
        and as :func:`load_ledger`.
    """
    chapters: dict[int, tuple[LedgerRow, ...]] = {}
    for path in sorted(Path(printed_folder).glob("*.yaml")):
        name = re.fullmatch(r"ch(\d\d)(_\w+)?", path.stem)
        if name is None:
            raise LedgerError(
                f"{path.name}: a file of printed values must be called chNN.yaml or chNN_topic.yaml"
            )
        number = int(name[1])
        rows = load_ledger(Path(ledger_folder) / path.name)
        if tuple(row.printed for row in rows) != load_printed(path):
            raise LedgerError(
                f"ledger {path.name} does not hold the printed values of {path.name}: execute its chapter again"
            )
        chapters[number] = chapters.get(number, ()) + rows
    return chapters


def _printed_value(file_name: str, entry: Any) -> PrintedValue:
    """One checked entry of a YAML file."""
    try:
        known_keys(f"entry of {file_name}", entry, required=_REQUIRED, optional=_OPTIONAL)
    except (TypeError, ValueError) as error:
        raise LedgerError(str(error)) from error
    value = PrintedValue(**entry)
    if value.status not in STATUSES:
        raise LedgerError(
            f"{file_name}, {value.id}: status '{value.status}' must be one of {', '.join(STATUSES)}"
        )
    if not isinstance(value.given, bool):
        raise LedgerError(f"{file_name}, {value.id}: given = {value.given!r} must be true or false")
    if isinstance(value.printed, bool):
        return value
    try:
        # As text, because a number loses its trailing zeros and with them its tolerance.
        Decimal(value.printed if isinstance(value.printed, str) else "not text")
    except InvalidOperation:
        raise LedgerError(
            f"{file_name}, {value.id}: printed = {value.printed!r} must be digits in quotes, or true"
        ) from None
    return value
