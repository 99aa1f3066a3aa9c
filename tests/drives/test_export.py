"""Tooth surface and meshes for other programs: exact, closed, in millimetres."""

import csv
import math
from itertools import pairwise

import numpy as np
import pytest

from facegear import Drive
from facegear.drives.export import write_points, write_stl
from facegear.geometry.solids import LEAST_LAND, Mesh, tooth_surface, volume

DRIVES = {
    "case_1": Drive(26, 130, 3.175e-3),
    "shafts at 85 degrees": Drive(28, 126, 3e-3, shaft_angle=math.radians(85)),
    "shafts at 110 degrees": Drive(31, 107, 2e-3, shaft_angle=math.radians(110)),
}
drives = pytest.mark.parametrize("drive", DRIVES.values(), ids=DRIVES)


def turned(axis, angle, points):
    c, s = math.cos(angle), math.sin(angle)
    matrix = {"x": [[1, 0, 0], [0, c, -s], [0, s, c]], "z": [[c, -s, 0], [s, c, 0], [0, 0, 1]]}[axis]
    return points @ np.array(matrix).T


def clearance(drive, points, rotation):
    """Angle about the shaper's axis from points in Γ2 to its flank, when it has turned by φs; 0 where they touch.

    Infinite for points beyond the shaper's tip circle, which it does not reach.
    The shaper's frame and its involute are written down anew: on a circle of radius ρ the flank stands at the polar
    angle θ0s + √(ρ²/rb² − 1) − atan √(ρ²/rb² − 1) from the middle of its tooth space, which points to −y.
    """
    fixed = turned("z", drive.speed_ratio * rotation, points)
    shaper = turned("z", -rotation, turned("x", -(math.pi - drive.shaft_angle), fixed))
    x, y = shaper[:, 0], shaper[:, 1]
    beyond = np.hypot(x, y) > drive.pitch_radius + 1.25 * drive.module
    roll = np.sqrt(np.maximum((x**2 + y**2) / drive.base_radius**2 - 1.0, 0.0))
    involute = math.tan(drive.pressure_angle) - drive.pressure_angle
    middle = math.pi / (2 * drive.pinion_teeth) - involute
    return np.where(beyond, np.inf, middle + roll - np.arctan(roll) - np.arctan2(x, -y))


TURNS = np.linspace(-1.0, 1.0, 4001)


def clearances(drive, lines):
    """Clearance of the first flank's points, (line, across, turn); the shaper is in its way where it is negative.

    Without the lowest row: the corner of the shaper's tip makes it, whose clearance has no minimum but an end there.
    """
    points = tooth_surface(drive, lines, 5).points[0, :, :-1]
    gaps = [clearance(drive, points.reshape(-1, 3), turn).reshape(points.shape[:2]) for turn in TURNS]
    return np.stack(gaps, axis=-1)


@drives
def test_the_shaper_touches_every_point(drive):
    # At R1 itself, where undercutting ends, the minimum may degenerate.
    for gaps in clearances(drive, 5)[1:].reshape(-1, TURNS.size):
        dips = [i for i in range(1, TURNS.size - 1) if gaps[i - 1] > gaps[i] < gaps[i + 1] < np.inf]
        # Vertex of the parabola through the three values about a minimum.
        lowest = [
            gaps[i] - (gaps[i - 1] - gaps[i + 1]) ** 2 / (8 * (gaps[i - 1] - 2 * gaps[i] + gaps[i + 1]))
            for i in dips
            if gaps[i - 1] < np.inf
        ]
        assert min(lowest, key=abs) == pytest.approx(0.0, abs=1e-9)


@drives
def test_the_shaper_cuts_no_point(drive):
    worst = clearances(drive, 41).min(axis=(1, 2)) * drive.pitch_radius
    if drive.shaft_angle <= math.pi / 2:
        assert worst.min() > -1e-9
    else:
        # The condition of undercutting (3-8) is one of the point itself. Beyond 90° the corner of the shaper's tip
        # comes back, on its way out, and shaves some micrometres off the first few percent of the face width.
        assert -2e-5 < worst.min() < -1e-6
        assert worst[2:].min() > -1e-9


@drives
def test_depth_that_the_corner_of_the_tip_cuts(drive):
    """Against the clearances above, which are angles."""
    depth = drive.tip_undercut(41, 4)
    expected = np.maximum(-clearances(drive, 41).min(axis=(1, 2)), 0.0)
    expected[expected < 1e-8] = 0.0
    assert ((depth > 1e-8 * drive.base_radius) == (expected > 0.0)).all()
    # The turns above miss the deepest instant by up to half a step.
    assert (depth >= expected * drive.base_radius * (1 - 1e-12)).all()
    assert (depth <= expected * drive.base_radius * 1.02 + 1e-8).all()
    with pytest.raises(ValueError, match="along must be at least 2"):
        drive.tip_undercut(1)


@drives
def test_normals_are_those_of_the_surface_and_point_outwards(drive):
    surface = tooth_surface(drive, 65, 65)
    for points, normals, side in zip(surface.points, surface.normals, (1.0, -1.0), strict=True):
        along, across = np.gradient(points, axis=0, edge_order=2), np.gradient(points, axis=1, edge_order=2)
        cross = np.cross(along, across)
        cross /= np.linalg.norm(cross, axis=-1, keepdims=True)
        agreement = np.abs(np.einsum("ijk,ijk->ij", cross, normals))[4:-4, 2:-2]
        assert agreement.min() > 1.0 - 1e-4
        np.testing.assert_allclose(np.linalg.norm(normals, axis=-1), 1.0, rtol=1e-12)
        assert (side * normals[..., 0] > 0.0).all()


def test_flanks_mirror_each_other_and_keep_a_land():
    surface = tooth_surface(DRIVES["case_1"], 9, 5)
    np.testing.assert_allclose(surface.points[0] * [-1, 1, 1], surface.points[1], rtol=1e-12)
    half = surface.points[0, :, :, 0]
    assert half.min() == pytest.approx(LEAST_LAND / 2, rel=1e-3)
    # The flanks of this drive cross below the nominal top at R2, which is what the land is for.
    assert DRIVES["case_1"].tooth_flank(9, 5).points[-1, 0, 0] < 0.0


def corners_of(path):
    content = path.read_bytes()
    count = int(np.frombuffer(content, "<u4", 1, 80)[0])
    assert len(content) == 84 + 50 * count
    record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    facets = np.frombuffer(content, record, count, 84)
    return content[:80], facets["normal"].astype(float), facets["corners"]


@drives
def test_stl_is_closed_and_turned_outwards(tmp_path, drive):
    solid = tooth_surface(drive, 17, 9).solid()
    header, normals, corners = corners_of(write_stl(solid, tmp_path / "new" / "tooth.stl", "a tooth"))
    assert header.startswith(b"facegear, millimetres: a tooth")
    # As another program reads it: corners are the same if their bits are.
    names = [tuple(corner.tobytes() for corner in triangle) for triangle in corners]
    edges = [(a, b) for t in names for a, b in ((t[0], t[1]), (t[1], t[2]), (t[2], t[0]))]
    assert len(set(edges)) == len(edges)
    assert {(b, a) for a, b in edges} == set(edges)
    vertices = {name for triangle in names for name in triangle}
    # Euler: a closed surface without holes.
    assert len(vertices) - len(edges) // 2 + len(names) == 2
    exact = corners.astype(float)
    cross = np.cross(exact[:, 1] - exact[:, 0], exact[:, 2] - exact[:, 0])
    np.testing.assert_allclose(normals, cross / np.linalg.norm(cross, axis=1, keepdims=True), atol=1e-6)
    enclosed = np.einsum("ij,ij->", exact[:, 0], np.cross(exact[:, 1], exact[:, 2])) / 6.0
    assert enclosed == pytest.approx(1e9 * volume(solid), rel=1e-4)
    assert enclosed > 0.0


def volume_by_quadrature(drive, count):
    """Volume between the flanks: the solid is |x| ≤ x_flank(y, z), so that it is 2 ∫∫ x dy dz over the flank.

    Polynomials through six by six points, piece by piece, integrated exactly. No triangles.
    """
    points = tooth_surface(drive, 5 * count + 1, 5 * count + 1).points[0]
    nodes = np.arange(6.0)
    powers = np.vander(nodes, increasing=True)
    derivative = np.linalg.solve(powers, np.eye(6))
    slopes = np.array([[k * x ** (k - 1) if k else 0.0 for k in range(6)] for x in nodes]) @ derivative
    weights = np.array([5.0 ** (k + 1) / (k + 1) for k in range(6)]) @ derivative
    total = 0.0
    for i in range(count):
        for j in range(count):
            x, y, z = np.moveaxis(points[5 * i : 5 * i + 6, 5 * j : 5 * j + 6], -1, 0)
            jacobian = (slopes @ y) * (z @ slopes.T) - (y @ slopes.T) * (slopes @ z)
            total += 2.0 * weights @ (x * jacobian) @ weights
    return abs(total)


@drives
def test_volume_of_the_mesh_converges_to_that_of_the_surface(drive):
    exact = volume_by_quadrature(drive, 6)
    assert exact == pytest.approx(volume_by_quadrature(drive, 4), rel=1e-4)
    errors = [abs(volume(tooth_surface(drive, n, n).solid()) - exact) for n in (9, 17, 33)]
    assert errors[2] < 2e-3 * exact
    assert all(coarse / fine > 2.5 for coarse, fine in pairwise(errors)), errors


def test_points_as_csv(tmp_path):
    surface = tooth_surface(DRIVES["case_1"], 3, 4)
    with write_points(surface, tmp_path / "points.csv").open(encoding="utf-8-sig") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 2 * 3 * 4
    assert list(rows[0]) == ["flank", "along", "across", "x_mm", "y_mm", "z_mm", "n_x", "n_y", "n_z"]
    for row in rows:
        place = (0 if row["flank"] == "1" else 1, int(row["along"]), int(row["across"]))
        given = [float(row[f"{axis}_mm"]) for axis in "xyz"]
        np.testing.assert_allclose(given, 1e3 * surface.points[place], rtol=1e-11)
        np.testing.assert_allclose(
            [float(row[f"n_{axis}"]) for axis in "xyz"], surface.normals[place], rtol=1e-11
        )


def test_what_cannot_be_exported_is_refused(tmp_path):
    mesh = Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0]]), np.array([[0, 1, 2]]))
    with pytest.raises(ValueError, match="mesh must have triangles of some area"):
        write_stl(mesh, tmp_path / "flat.stl", "flat")
    with pytest.raises(ValueError, match=r"path must end in \.stl, got 'tooth\.obj'"):
        write_stl(mesh, "tooth.obj", "x")
    with pytest.raises(ValueError, match="along must be at least 2, got 1"):
        tooth_surface(DRIVES["case_1"], 1, 5)
    with pytest.raises(TypeError, match="across must be an integer"):
        tooth_surface(DRIVES["case_1"], 5, 5.0)
