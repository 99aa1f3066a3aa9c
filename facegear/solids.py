"""Outlines and triangle meshes of pinion and face gear, for drawings and for export."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from facegear.flanks import gear_to_fixed, shaper_to_fixed
from facegear.geometry import Drive
from facegear.parameters import FloatArray, integer_at_least


@dataclass(frozen=True)
class Mesh:
    """Triangles in space.

    Attributes
    ----------
    vertices : ndarray, shape (v, 3)
        Corner points [m].
    triangles : ndarray of int, shape (t, 3)
        Indices of the corners of each triangle.
    """

    vertices: FloatArray
    triangles: NDArray[np.int64]


def pinion_outline(drive: Drive, points_per_flank: int = 12) -> FloatArray:
    """Trace the closed outline of the pinion's section in the shaper's frame (3-2).

    A tooth space is centred on the −y axis.

    Parameters
    ----------
    drive : Drive
    points_per_flank : int, optional
        Points on each involute.

    Returns
    -------
    ndarray, shape (n, 2)
        Counter-clockwise [m]; below the base circle the flank is continued radially to the dedendum circle.
    """
    points_per_flank = integer_at_least("points_per_flank", points_per_flank, 2)
    roll = np.linspace(0.0, drive.pinion_tip_roll, points_per_flank)
    radius = drive.base_radius * np.hypot(1.0, roll)
    # Polar angle of the flank from the centre of its tooth space.
    angle = drive.space_half_angle + roll - np.arctan(roll)
    if drive.dedendum_radius < drive.base_radius:
        radius, angle = np.append(drive.dedendum_radius, radius), np.append(angle[0], angle)
    pitch = 2.0 * np.pi / drive.pinion_teeth
    radius = np.concatenate([radius, radius[::-1]])
    angle = np.concatenate([angle, pitch - angle[::-1]])
    angles = (angle + pitch * np.arange(drive.pinion_teeth)[:, None]).ravel() - 0.5 * np.pi
    radii = np.tile(radius, drive.pinion_teeth)
    return np.column_stack([radii * np.cos(angles), radii * np.sin(angles)])


def pinion(drive: Drive, rotation: float = 0.0, points_per_flank: int = 6) -> Mesh:
    """Pinion as long as the face is wide, in the space-fixed frame Γp.

    Parameters
    ----------
    drive : Drive
    rotation : float, optional
        φs [rad].
    points_per_flank : int, optional
        Points on each involute.

    Returns
    -------
    Mesh
        Closed: the flanks and both end faces.
    """
    outline = pinion_outline(drive, points_per_flank)
    count = len(outline)
    ends = [np.column_stack([outline, np.full(count, end)]) for end in (drive.inner_limit, drive.outer_limit)]
    centres = np.array([[0.0, 0.0, drive.inner_limit], [0.0, 0.0, drive.outer_limit]])
    here = np.arange(count)
    after = np.roll(here, -1)
    sides = [
        np.column_stack([here, after, after + count]),
        np.column_stack([here, after + count, here + count]),
    ]
    # The section is star-shaped about its centre, so a fan closes each end.
    inner = np.column_stack([np.full(count, 2 * count), after, here])
    outer = np.column_stack([np.full(count, 2 * count + 1), here + count, after + count])
    vertices = shaper_to_fixed(drive.contact_region, np.vstack([*ends, centres]), rotation)
    return Mesh(vertices, np.vstack([*sides, inner, outer]))


def face_gear_tooth(drive: Drive, along: int = 9, across: int = 6) -> Mesh:
    """One tooth of the face gear in its own frame Γ2, centred on the −y axis.

    Parameters
    ----------
    drive : Drive
    along, across : int, optional
        Points along the face width and across the profile of each flank.

    Returns
    -------
    Mesh
        Closed: both flanks, top land, ends, and a bottom where the shaper's tip has cut.
    """
    right, left = (drive.tooth_flank(along, across, flank).points for flank in (1, -1))
    return tooth_between(right, left)


def tooth_between(right: FloatArray, left: FloatArray) -> Mesh:
    """Tooth closed by top land, ends and bottom between its two flanks.

    Parameters
    ----------
    right, left : ndarray, shape (along, across, 3)
        Points of the flanks [m], outwards and from top to bottom, as :meth:`Drive.tooth_flank` has them.

    Returns
    -------
    Mesh
        Closed; every edge is shared by two triangles.
    """
    along, across, _ = right.shape
    # Once around the section: up the left flank, over the top land, down the right one, back along the bottom.
    around = np.concatenate([left[:, ::-1], right, left[:, -1:]], axis=1)
    skin = _grid_triangles(*around.shape[:2])
    columns = around.shape[1]
    # An end face is a strip between the flanks: its points are shared with the skin.
    strip = np.array(
        [
            triangle
            for k in range(across - 1)
            for triangle in ((k, 2 * across - 1 - k, k + 1), (k + 1, 2 * across - 1 - k, 2 * across - 2 - k))
        ]
    )
    last = strip[:, ::-1] + (along - 1) * columns
    # The bottom's last column repeats the first one, so that the skin closes.
    triangles = np.vstack([skin, strip, last])
    column = triangles % columns
    return Mesh(around.reshape(-1, 3), np.where(column == columns - 1, triangles - (columns - 1), triangles))


def face_gear(drive: Drive, rotation: float = 0.0, along: int = 5, across: int = 4) -> Mesh:
    """All teeth of the face gear in the space-fixed frame Γp, when the pinion has turned by φs.

    Parameters
    ----------
    drive : Drive
    rotation : float, optional
        φs [rad].
    along, across : int, optional
        As for :func:`face_gear_tooth`.

    Returns
    -------
    Mesh
    """
    tooth = face_gear_tooth(drive, along, across)
    count = len(tooth.vertices)
    # Turning the gear by one pitch is what a pinion rotation of one pitch of its own does.
    turns = rotation + 2.0 * np.pi / drive.pinion_teeth * np.arange(drive.gear_teeth)
    vertices = gear_to_fixed(
        drive.contact_region, np.broadcast_to(tooth.vertices, (len(turns), count, 3)), turns[:, None]
    )
    triangles = tooth.triangles + count * np.arange(len(turns))[:, None, None]
    return Mesh(vertices.reshape(-1, 3), triangles.reshape(-1, 3))


def _grid_triangles(rows: int, columns: int) -> NDArray[np.int64]:
    """Two triangles for every cell of a grid of points numbered row by row."""
    index = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = (part.ravel() for part in (index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]))
    return np.vstack([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
