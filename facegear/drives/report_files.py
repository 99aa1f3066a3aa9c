"""The report on a drive as files: the page, and tables, arrays and meshes beside it."""

from __future__ import annotations

import errno
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import xarray as xr

from facegear.drives import export, report_columns, report_rows
from facegear.drives.contacts import NAMES
from facegear.drives.findings import TORSION, Findings
from facegear.drives.page import Listing, Paragraph, Section, attempted, is_page, page
from facegear.drives.sections import SECTIONS
from facegear.drives.verdict import FORCES
from facegear.geometry import solids
from facegear.support import labelled
from facegear.support.files import file_stem, folder_written_whole
from facegear.support.tables import write_table

PAGE = "report.html"
"""Name of the page among the files of a report."""

_FILES = "Files"
_TABLES = ("summary", "natural_frequencies", "tongues", "safe_windows", "bases", "changes", "tooth_points_mm")
_ARRAYS = ("bases", "modes", "combinations", "map_follower", "map_dead", "torsional_map", "play", "damage")
_MODELS = (TORSION, *(f"{contact}, {force}" for contact in NAMES.values() for force in FORCES.values()))
FILES = (
    PAGE,
    "tooth_mm.stl",
    *(f"{name}.csv" for name in _TABLES),
    *(f"{name}.nc" for name in _ARRAYS),
    *(f"tongues_{file_stem(name)}.nc" for name in _MODELS),
)
"""Names of all files that a report may have."""


def results_directory(drive_file: str | Path, kind: str = "results") -> Path:
    """Return the folder that results of a kind go to if none is named: beside the drive file.

    Examples
    --------
    >>> results_directory("drives/my_drive.yaml").as_posix()
    'drives/my_drive_results'
    """
    path = Path(drive_file)
    return path.with_name(f"{path.stem}_{kind}")


def foreign(folder: Path, files: Sequence[str]) -> str:
    """Say which file in a folder would be replaced although no earlier run wrote it; nothing if none would.

    Parameters
    ----------
    folder : Path
        It need not be there.
    files : sequence of str
        Names that a run writes or removes, its page first: where a page of this package lies, the others are its.
    """
    there = [name for name in files if (folder / name).exists()]
    if not there or is_page(folder / files[0]):
        return ""
    return f"{there[0]} is there and would be replaced, and no {files[0]} of facegear says that it is its own"


def parts_of(found: Findings) -> dict[str, Callable[[Path], object]]:
    """Files of a report but for its page: name to what writes it, tables first, meshes last.

    Parameters
    ----------
    found : Findings

    Returns
    -------
    dict of str to callable
        For :func:`facegear.drives.export.write_parts`. What has not been computed is computed when it is written.
    """
    file = found.file
    tables: dict[str, Callable[[], Mapping[str, Any]]] = {
        "summary": lambda: report_columns.summary_columns(summary(found)),
        "natural_frequencies": lambda: report_columns.frequency_columns(found.modes),
        "tongues": lambda: report_columns.tongue_columns(found.tongue_tables),
        "safe_windows": lambda: report_columns.window_columns(found.windows),
        "bases": lambda: report_columns.basis_columns(found.bases),
        "changes": lambda: report_columns.change_columns(found.effects),
    }
    arrays: dict[str, Callable[[], xr.Dataset | None]] = {
        "bases": lambda: found.bases,
        "modes": lambda: found.modes,
        "combinations": lambda: found.combinations,
        "map_follower": lambda: found.map_follower,
        "map_dead": lambda: found.map_dead,
    }
    if file.torsional is not None:
        arrays["torsional_map"] = lambda: found.torsional_map
    try:
        tongues = found.tongue_tables
    except (ArithmeticError, ValueError):
        tongues = {}  # the line of tongues.csv says why
    if file.play is not None and TORSION in tongues and found.play is not None:
        arrays["play"] = lambda: found.play
    if file.cracked is not None:
        arrays["damage"] = lambda: found.damage
    for name, table in tongues.items():
        arrays[f"tongues_{file_stem(name)}"] = partial(_same, table)
    drive = file.drive
    title = f"face-gear tooth, N1={drive.pinion_teeth} N2={drive.gear_teeth}"
    return {
        **{f"{name}.csv": partial(_write_columns, columns) for name, columns in tables.items()},
        **{f"{name}.nc": partial(_write_arrays, made) for name, made in arrays.items()},
        "tooth_points_mm.csv": lambda path: export.write_points(solids.tooth_surface(drive), path),
        "tooth_mm.stl": lambda path: export.write_stl(solids.tooth_surface(drive).solid(), path, title),
    }


def _same(table: xr.Dataset) -> xr.Dataset:
    return table


def _write_columns(columns: Callable[[], Mapping[str, Any]], path: Path) -> Path:
    return write_table(columns(), path)


def _write_arrays(made: Callable[[], xr.Dataset | None], path: Path) -> Path:
    arrays = made()
    assert arrays is not None
    return labelled.save(arrays, path)


def summary(found: Findings) -> tuple[report_rows.Row, ...]:
    """All single numbers of a report; those that could not be computed are left out."""
    rows: list[report_rows.Row] = []
    parts: tuple[Callable[[], tuple[report_rows.Row, ...]], ...] = (
        lambda: report_rows.geometry(found.file),
        lambda: found.torsional_rows,
        lambda: found.thickness_rows,
        lambda: report_rows.strength(found.file),
        lambda: found.powers,
    )
    for part in parts:
        try:
            rows += part()
        except (ArithmeticError, ValueError):
            continue
    return tuple(rows)


def files(found: Findings, folder: str | Path) -> Section:
    """Write tables, arrays and meshes, and list what was written.

    Parameters
    ----------
    found : Findings
    folder : str or Path
        Is made if it is not there.

    Returns
    -------
    Section
        A part that could not be written is named with the reason, and does not keep the others back.
    """
    written, refused = export.write_parts(parts_of(found), folder)
    points = [f"`{path.name}` ({max(1, round(path.stat().st_size / 1024))} kB)" for path in written]
    points += [f"`{name}` was not written: {reason}" for name, reason in refused.items()]
    words = Paragraph("The tables and arrays of this report, and the tooth, for other programs.")
    return Section(_FILES, (words, Listing(tuple(points))))


def write_report(found: Findings, folder: str | Path, say: Callable[[str], object] = lambda _: None) -> Path:
    """Write the page of a report, and tables, arrays and meshes beside it; all of it appears at once, or nothing.

    Parameters
    ----------
    found : Findings
    folder : str or Path
        Where it goes. If it is there already, files of an earlier report are replaced or removed, and others stay.
    say : callable
        Called with a line of progress as each section begins.

    Returns
    -------
    Path
        The page.

    Raises
    ------
    OSError
        If the folder cannot be written to, or holds files of these names that are not of an earlier report.
    """
    if reason := foreign(Path(folder), FILES):
        raise FileExistsError(errno.EEXIST, reason, str(folder))
    count = len(SECTIONS) + 1
    made = []
    with folder_written_whole(Path(folder), FILES) as place:
        for number, (title, make) in enumerate(SECTIONS, start=1):
            say(f"section {number} of {count}: {title}")
            made.append(attempted(title, partial(make, found)))
        say(f"section {count} of {count}: {_FILES}")
        made.append(attempted(_FILES, partial(files, found, place)))
        (place / PAGE).write_text(page(f"Report on {found.file.name}", made), encoding="utf-8")
    return Path(folder, PAGE)
