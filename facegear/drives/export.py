"""Files for other programs: the exact tooth surface as points, a closed tooth, tables.

Lengths are in millimetres, which CAD programs take an STL file to be in; the frame is the face gear's own, Γ2: z is
its axis, the tooth is centred on the −y axis.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from facegear.drives.refusals import told
from facegear.geometry.solids import Mesh, ToothSurface
from facegear.support.files import written_whole
from facegear.support.tables import write_table

_MM = 1e3


def write_parts(
    parts: Mapping[str, Callable[[Path], object]], folder: str | Path
) -> tuple[tuple[Path, ...], dict[str, str]]:
    """Write several files, each on its own: one that cannot be written does not keep the others back.

    Parameters
    ----------
    parts : mapping of str to callable
        Name of the file to what writes it, given its path.
    folder : str or Path

    Returns
    -------
    written : tuple of Path
    refused : dict of str to str
        Name of each file that was not written, and why.
    """
    written, refused = [], {}
    for name, write in parts.items():
        path = Path(folder, name)
        try:
            write(path)
        except (ArithmeticError, OSError, ValueError) as problem:
            refused[name] = told(problem)
        else:
            written.append(path)
    return tuple(written), refused


def write_stl(mesh: Mesh, path: str | Path, title: str) -> Path:
    """Write a mesh as a binary STL file in millimetres.

    Parameters
    ----------
    mesh : Mesh
    path : str or Path
        The file, ending in ``.stl``; its folder is made.
    title : str
        For the header, which holds 80 bytes.

    Returns
    -------
    Path
        The file written.

    Raises
    ------
    ValueError
        If the path does not end in ``.stl``, or a triangle has no area in the file's single precision.
    """
    path = Path(path)
    if path.suffix != ".stl":
        raise ValueError(f"path must end in .stl, got {str(path)!r}")
    corners = (mesh.vertices * _MM).astype("<f4")[mesh.triangles]
    sides = corners[:, 1:].astype(float) - corners[:, :1]
    normals = np.cross(sides[:, 0], sides[:, 1])
    size = np.linalg.norm(normals, axis=1, keepdims=True)
    if not np.all(size > 0.0):
        raise ValueError("mesh must have triangles of some area, got one that has none in single precision")
    record = np.zeros(
        len(corners), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")]
    )
    record["normal"], record["corners"] = normals / size, corners
    # A header that starts with "solid" would make it a text file to some programs.
    header = f"facegear, millimetres: {title}".encode("ascii", "replace")[:80].ljust(80)
    with written_whole(path) as place:
        place.write_bytes(header + np.array(len(corners), dtype="<u4").tobytes() + record.tobytes())
    return path


def write_points(surface: ToothSurface, path: str | Path) -> Path:
    """Write the points of a tooth surface and their normals as CSV, lengths in millimetres.

    Parameters
    ----------
    surface : ToothSurface
    path : str or Path
        The file; its folder is made.

    Returns
    -------
    Path
        The file written, with one row a point: flank (1 or −1), numbers along and across from 0, coordinates
        x_mm, y_mm, z_mm, unit normal n_x, n_y, n_z.
    """
    flank, along, across = np.indices(surface.points.shape[:3])
    columns: dict[str, Any] = {
        "flank": 1 - 2 * flank.ravel(),
        "along": along.ravel(),
        "across": across.ravel(),
    }
    for i, axis in enumerate("xyz"):
        columns[f"{axis}_mm"] = surface.points[..., i].ravel() * _MM
    for i, axis in enumerate("xyz"):
        columns[f"n_{axis}"] = surface.normals[..., i].ravel()
    return write_table(columns, path)
