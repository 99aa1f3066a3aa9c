"""A map of a drive file as files: arrays, table and picture, each with a mark by which it is known again."""

from __future__ import annotations

import csv
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np

from facegear.drives import report_arrays
from facegear.drives.sweeps import Sweep
from facegear.support import labelled
from facegear.support.files import written_whole
from facegear.support.tables import write_table

# In the metadata of pictures and the attributes of arrays; uncompressed in all of them.
_TITLE = "facegear map: growth rate over speed and one number of a drive file"
# Of a table, after that of the number.
_SPEED, _GROWTH = "speed_rpm", "growth_rate_per_s"
# Longer than the headings of any table.
_LONGEST_LINE = 1000


def columns(found: Sweep) -> dict[str, list[float]]:
    """Columns of a table: the number in the file's unit, speed [rpm], growth rate [1/s], one row a cell."""
    speeds = found.chart["speed_rpm"].values
    value, speed = np.meshgrid(found.values, speeds, indexing="ij")
    return {
        found.key.name: value.ravel().tolist(),
        _SPEED: speed.ravel().tolist(),
        _GROWTH: found.chart["growth_rate"].values.ravel().tolist(),
    }


def _write_picture(found: Sweep, path: Path) -> object:
    from facegear.plotting.report import growth_map

    unit = f" [{found.key.unit}]" if found.key.unit else ""
    none = report_arrays.tongue_table((), "")
    scale = found.key.from_si(1.0)
    figure = growth_map(found.chart, none, found.key.to_si(found.own), f"{found.key.name}{unit}", scale)
    with written_whole(path) as place:
        figure.savefig(place, dpi=150, metadata={"Title": _TITLE})
    return path


WRITERS: Mapping[str, Callable[[Sweep, Path], object]] = {
    ".nc": lambda found, path: labelled.save(found.chart.assign_attrs(title=_TITLE), path),
    ".csv": lambda found, path: write_table(columns(found), path),
    ".svg": _write_picture,
    ".png": _write_picture,
    ".pdf": _write_picture,
}
"""What writes a map, by the ending of the file."""


def foreign(path: Path) -> str:
    """Say why a file must not be replaced by a map: none was written there before; nothing if it may.

    Parameters
    ----------
    path : Path
        It need not be there. A map is known by its title, or by the headings of its table.
    """
    if not path.exists() or (path.is_file() and _is_map(path)):
        return ""
    return f"{path.name} is there and would be replaced, and nothing in it says that facegear map wrote it"


def _is_map(path: Path) -> bool:
    try:
        if path.suffix != ".csv":
            return _TITLE.encode() in path.read_bytes()
        with path.open(encoding="utf-8-sig", newline="") as file:
            headings = next(csv.reader([file.readline(_LONGEST_LINE)]), [])
    except (OSError, UnicodeDecodeError, csv.Error):
        return False
    return headings[1:] == [_SPEED, _GROWTH]
