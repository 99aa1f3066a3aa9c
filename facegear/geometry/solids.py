"""Outlines and triangle meshes of pinion and face gear, for drawings and for export."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from facegear.geometry.contact_lines import ContactRegion
from facegear.geometry.drive import Drive
from facegear.geometry.flanks import gear_to_fixed, shaper_points, shaper_to_fixed, shaper_to_gear
from facegear.support.parameters import integer_at_least
from facegear.support.roots import root
from facegear.support.types import FloatArray
from facegear.symbolic import twins


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
        Counter-clockwise [m], from the dedendum circle outwards; where the base circle lies outside it, the flank is
        continued radially.
    """
    points_per_flank = integer_at_least("points_per_flank", points_per_flank, 2)
    lowest = max(drive.dedendum_radius / drive.base_radius, 1.0)
    roll = np.linspace(np.sqrt(lowest**2 - 1.0), drive.pinion_tip_roll, points_per_flank)
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
    # R1 and R2 lie this far along the pinion's axis where it meets the pitch cone.
    offset = drive.generating.pitch_radius / np.tan(drive.shaft_angle)
    along = (drive.inner_limit + offset, drive.outer_limit + offset)
    ends = [np.column_stack([outline, np.full(count, end)]) for end in along]
    centres = np.array([[0.0, 0.0, end] for end in along])
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
    vertices += shaper_to_fixed(drive.contact_region, [0.0, -drive.axis_offset, 0.0], 0.0)
    return Mesh(vertices, np.vstack([*sides, inner, outer]))


LEAST_LAND = 2e-6
"""Narrowest top land of a tooth [m].

Near R2 the true flanks may cross just below the nominal top (see :meth:`Drive.top_thickness`), and with very many teeth
at the inner end down to the shaper's tip. There the tooth ends where it is this thick: a knife edge is no solid.
"""


@dataclass(frozen=True, eq=False)
class ToothSurface:
    """Points of both flanks of a tooth with their normals, in Γ2.

    Attributes
    ----------
    points, normals : ndarray, shape (2, along, across, 3)
        Coordinates [m] and unit vectors that point out of the tooth; first the flank that the equations of chapter 3
        describe, then its mirror image. The second index runs outwards to R2, the third from top to bottom. With many
        teeth the first profile has no height: all its points are one.
    """

    points: FloatArray
    normals: FloatArray

    def solid(self) -> Mesh:
        """Tooth between the flanks, closed, its triangles counter-clockwise seen from outside."""
        return tooth_between(self.points[0], self.points[1])


def tooth_surface(drive: Drive, along: int = 33, across: int = 17) -> ToothSurface:
    """Lay a grid on both flanks of a face-gear tooth, from its top to where the shaper's tip generates it.

    Parameters
    ----------
    drive : Drive
    along, across : int
        Points along the face width and across the profile of each flank, at least 2.

    Raises
    ------
    TypeError, ValueError
        A number of points that is no integer of at least 2; a drive whose flanks cross all along the face, so that
        there is no tooth between them.

    Notes
    -----
    The tooth begins at R1, where undercutting ends (3-8); with many teeth where the shaper's tip comes below the tooth
    top (`Drive.flank_start`) or, with very many, where the flanks no longer cross at the shaper's tip. It has no height
    there and rises from an edge.

    Between shafts at more than 90° the shaper cuts the flank once more. What it cuts off (`Drive.tip_undercut` has the
    depth, `Drive.usable_radii` the limits) is still there in this surface.
    """
    n, k = integer_at_least("along", along, 2), integer_at_least("across", across, 2)
    region = drive.contact_region
    start = _start(region)
    fraction = np.linspace(0.0, 1.0, k)
    parts = [_profile(region, float(r), start, fraction) for r in np.linspace(start, region.outer_radius, n)]
    points, normals = (np.stack([part[i] for part in parts]) for i in range(2))
    mirror = np.array([-1.0, 1.0, 1.0])
    return ToothSurface(np.stack([points, points * mirror]), np.stack([normals, normals * mirror]))


def _half_thickness(region: ContactRegion, radius: float, roll: float) -> float:
    """Distance of a point of the flank from the tooth's plane of symmetry, less half the least land [m]."""
    return float(_flank_points(region, radius, np.array([roll]))[0][0, 0]) - LEAST_LAND / 2.0


def _start(region: ContactRegion) -> float:
    """Least −y_p of a tooth that is thick enough at the shaper's tip [m]."""
    radii = np.linspace(region.flank_start, region.outer_radius, 65)

    def room(radius: float) -> float:
        return _half_thickness(region, radius, region.shaper_tip_roll)

    thick = np.flatnonzero([room(radius) > 0.0 for radius in radii])
    if not thick.size:
        raise ValueError(
            f"drive must have a tooth between its flanks, got one whose flanks cross all along the face from "
            f"{1e3 * radii[0]:.6g} to {1e3 * radii[-1]:.6g} mm; take fewer teeth or a smaller pressure angle"
        )
    first = int(thick[0])
    return float(radii[0]) if first == 0 else root(room, radii[first - 1], radii[first])


def _flank_points(region: ContactRegion, radius: float, roll: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Points of one profile of the flank in Γ2 [m] and the rotations that generate them [rad]."""
    alpha = np.array([region.edge_angle(radius, value) for value in roll])
    rotation = alpha - roll - region.space_half_angle
    generating = shaper_points(region, region.position(alpha), roll)
    return shaper_to_gear(region, generating, rotation), rotation


def _profile(
    region: ContactRegion, radius: float, start: float, fraction: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Points and normals of one profile, from the top, or where the tooth is thick enough, to the bottom."""
    bottom = region.shaper_tip_roll
    if radius == start and start > region.inner_radius:
        top = bottom
    else:
        top = region.top_roll(radius)
        if _half_thickness(region, radius, top) < 0.0:
            top = root(lambda roll: _half_thickness(region, radius, roll), top, bottom)
    roll = top + (bottom - top) * fraction
    place, rotation = _flank_points(region, radius, roll)
    normal = twins.shaper_normal(roll, region.space_half_angle)
    turned = shaper_to_gear(region, np.stack(np.broadcast_arrays(*normal), axis=-1), rotation)
    # (3-3) points out of the shaper's tooth space, that is into the tooth.
    return place, -turned / np.linalg.norm(turned, axis=-1, keepdims=True)


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

    Raises
    ------
    TypeError, ValueError
        As for :func:`tooth_surface`.
    """
    return tooth_surface(drive, along, across).solid()


def tooth_between(right: FloatArray, left: FloatArray) -> Mesh:
    """Tooth closed by top land, ends and bottom between its two flanks.

    Parameters
    ----------
    right, left : ndarray, shape (along, across, 3)
        Points of the flanks [m], outwards and from top to bottom, as :func:`tooth_surface` has them: the first flank
        at positive x, on the −y side of the axis, and its mirror image.

    Returns
    -------
    Mesh
        Closed, triangles counter-clockwise seen from outside; every edge is shared by two of them. Points that are
        one, as on a profile without height, are one vertex.
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
    # The bottom's last column is the first one, which closes the skin.
    vertices, names = np.unique(around.reshape(-1, 3), axis=0, return_inverse=True)
    triangles = names.reshape(-1)[np.vstack([skin, strip, last])[:, ::-1]]
    a, b, c = triangles.T
    return Mesh(vertices, triangles[(a != b) & (b != c) & (c != a)])


def volume(mesh: Mesh) -> float:
    """Volume of a closed mesh, positive if its triangles are counter-clockwise seen from outside [m³]."""
    a, b, c = (mesh.vertices[mesh.triangles[:, k]] for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)


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
        One closed body a tooth.

    Raises
    ------
    TypeError, ValueError
        As for :func:`tooth_surface`.
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
