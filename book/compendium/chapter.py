"""What a chapter's notebook has to show for itself: arrays of its figures, and answers to the printed values.

A notebook makes one :class:`Chapter`, hands it each figure's arrays and each value that the dissertation prints as they
come up, and asks for the ledger and, in its last cell, for the check of the figures. Nothing is checked before: a
chapter that gives up half-way has still written all it has.
"""

from __future__ import annotations

import re
from pathlib import Path

import xarray as xr
from IPython.display import Markdown
from myst_nb import glue

from compendium import checks, ledger_tables, printed


class ChapterError(Exception):
    """A chapter does not show what its text says, or ends without having been compared with what is stored."""


class Chapter:
    """Figures and printed values of one notebook.

    Parameters
    ----------
    name : str
        "chNN" or "chNN_topic", the name of its file of printed values.
    data_directory, build_directory : str or Path
        Where printed values, references and anchors are read, and where arrays and ledger are written.

    Attributes
    ----------
    values : dict of str to float, bool or None
        What the printed values come to here, by their ids, in the printed units; None where the text does not allow
        to decide.

    Raises
    ------
    ValueError
        If the name does not begin with the number of a chapter.

    Examples
    --------
    >>> chapter = Chapter("ch02", "../data", "../build")
    >>> chapter.values["hsu_misses_some"] = True
    >>> chapter.figure("ch03_swing", xr.Dataset())
    Traceback (most recent call last):
        ...
    ValueError: figure must begin with 'ch02_' like the other files of this chapter, got 'ch03_swing'
    """

    def __init__(self, name: str, data_directory: str | Path, build_directory: str | Path) -> None:
        if not re.fullmatch(r"ch\d\d(_\w+)?", name):
            raise ValueError(f"name must be chNN or chNN_topic, got {name!r}")
        self.name = name
        self.values: dict[str, float | bool | None] = {}
        self._data, self._build = Path(data_directory), Path(build_directory)
        self._figures: dict[str, xr.Dataset] = {}
        self._compared: dict[str, float | bool | None] | None = None

    def figure(self, name: str, arrays: xr.Dataset) -> xr.Dataset:
        """Hand in the arrays of a figure, to be checked at the end.

        Parameters
        ----------
        name : str
            That of its files in ``data/reference`` and ``data/anchors``, beginning with the number of the chapter.
        arrays : xarray.Dataset

        Returns
        -------
        xarray.Dataset
            The same, to be drawn.

        Raises
        ------
        ValueError
            If the name belongs to another chapter, or was given before: one of both would never be checked.
        """
        number = self.name[:4]
        if not name.startswith(f"{number}_"):
            raise ValueError(
                f"figure must begin with '{number}_' like the other files of this chapter, got {name!r}"
            )
        if name in self._figures:
            raise ValueError(f"figure {name!r} was handed in before")
        self._figures[name] = arrays
        return arrays

    def require(self, what: str, value: float, low: float, high: float) -> None:
        """Stop the chapter if a measured number is not what its text says.

        Parameters
        ----------
        what : str
            The quantity, for the message.
        value : float
        low, high : float
            Between which it must lie, both allowed; in its own unit.

        Raises
        ------
        ChapterError
            If it does not, or is not a number.
        """
        if not low <= value <= high:
            raise ChapterError(f"{self.name}: {what} is {value:.4g}, the text says {low:g} to {high:g}")

    def ledger(self) -> Markdown:
        """Compare the values with the printed ones, store the ledger, and return it as a table.

        The counts can be quoted in the text: ``{glue:text}`` of the chapter's name with ``_printed`` is how many there
        are, with ``_hold``, ``_differ`` and ``_undecided`` how many of them came out, did not, or cannot be decided.

        Raises
        ------
        compendium.printed.LedgerError
            If a value is missing or too many, or a status does not follow from the numbers.
        """
        entries = printed.load_printed(self._printed_file)
        rows = printed.ledger(entries, self.values)
        printed.save_ledger(rows, self._build / "ledger" / f"{self.name}.yaml")
        self._compared = dict(self.values)
        counts = {
            "printed": len(rows),
            "hold": sum(row.status in printed.HOLDING for row in rows),
            "differ": sum(row.status == printed.DIFFERS for row in rows),
            "undecided": sum(row.status == printed.UNDECIDED for row in rows),
        }
        for what, count in counts.items():
            glue(f"{self.name}_{what}", count, display=False)
        return Markdown(ledger_tables.as_markdown(rows))  # type: ignore[no-untyped-call]

    def finish(self) -> Markdown:
        """Write and check the arrays of all figures, and return the deviations as a table.

        Raises
        ------
        compendium.reference.ReferenceCheckError
            With one line a figure that lacks its reference or anchors, or disagrees with either.
        ChapterError
            If no figure was handed in, or values were never compared with the printed ones.
        """
        if not self._figures:
            raise ChapterError(f"{self.name}: no figure was handed in")
        rows = checks.check_figures(self._figures, self._data, self._build)
        if self._compared != self.values:
            raise ChapterError(f"{self.name}: values were not compared with {self._printed_file.name}")
        return Markdown(checks.as_markdown(rows))  # type: ignore[no-untyped-call]

    @property
    def _printed_file(self) -> Path:
        return self._data / "printed" / f"{self.name}.yaml"
