"""Outlines and triangle meshes of pinion and face gear, for drawings and for export."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

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

    def joined(self, other: Mesh) -> Mesh:
        """Both meshes as one."""
        shifted = other.triangles + len(self.vertices)
        return Mesh(np.vstack([self.vertices, other.vertices]), np.vstack([self.triangles, shifted]))


def pinion_outline(drive: Drive, points_per_flank: int = 12) -> FloatArray:
    """Trace the closed outline of the pinion's section in the shaper's frame (3-2), a tooth space centred on the −y axis.

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
    integer_at_least("points_per_flank", points_per_flank, 2)
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


def grid_mesh(points: FloatArray) -> Mesh:
    """Two triangles for every cell of a grid of points, shape (rows, columns, 3)."""
    rows, columns = points.shape[:2]
    index = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = (part.ravel() for part in (index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]))
    triangles = np.vstack([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
    return Mesh(points.reshape(-1, 3), triangles)
