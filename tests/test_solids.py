"""Outlines and meshes: closed, of the right size, and touching each other where pinion and face gear touch."""

import numpy as np
import pytest

from facegear import Drive, solids

DRIVE = Drive(26, 130, 3.175e-3)


def edges_of(mesh):
    """Directed edges of all triangles; those of a fan along a radial line have no area but join their neighbours."""
    corners = mesh.triangles
    return np.vstack([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])


def volume(mesh):
    a, b, c = (mesh.vertices[mesh.triangles[:, k]] for k in range(3))
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0


@pytest.mark.parametrize(
    "mesh", [solids.pinion(DRIVE), solids.face_gear_tooth(DRIVE)], ids=["pinion", "tooth"]
)
def test_meshes_are_closed_and_oriented(mesh):
    edges = {tuple(edge) for edge in edges_of(mesh).tolist()}
    assert len(edges) == len(edges_of(mesh))
    assert all((b, a) in edges for a, b in edges)


def test_pinion_outline_lies_between_its_circles_and_encloses_the_right_area():
    outline = solids.pinion_outline(DRIVE, 60)
    radius = np.linalg.norm(outline, axis=1)
    assert radius.min() == pytest.approx(DRIVE.dedendum_radius, rel=1e-12)
    assert radius.max() == pytest.approx(DRIVE.pinion_tip_radius, rel=1e-12)
    x, y = outline.T
    area = 0.5 * np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))
    # Tooth and space are equally wide on the pitch circle.
    assert area == pytest.approx(np.pi * DRIVE.pitch_radius**2, rel=0.02)


def test_pinion_volume_is_its_section_times_the_face_width():
    outline = solids.pinion_outline(DRIVE, 6)
    x, y = outline.T
    area = 0.5 * np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))
    assert abs(volume(solids.pinion(DRIVE))) == pytest.approx(area * DRIVE.face_width, rel=1e-12)


def test_tooth_volume_settles_under_refinement():
    volumes = [abs(volume(solids.face_gear_tooth(DRIVE, n, n))) for n in (8, 16, 32)]
    assert abs(volumes[2] - volumes[1]) < 0.3 * abs(volumes[1] - volumes[0])
    # About half a pitch wide, 2.25 modules high, as long as the face.
    assert volumes[2] == pytest.approx(0.5 * np.pi * 2.25 * DRIVE.module**2 * DRIVE.face_width, rel=0.25)


def test_every_tooth_of_the_ring_is_the_first_one_turned():
    ring = solids.face_gear(DRIVE).vertices.reshape(DRIVE.gear_teeth, -1, 3)
    radius = np.hypot(ring[..., 0], ring[..., 1])
    np.testing.assert_allclose(radius, np.broadcast_to(radius[0], radius.shape), rtol=1e-12)
    angle = np.unwrap(np.arctan2(ring[:, 0, 1], ring[:, 0, 0]))
    np.testing.assert_allclose(np.abs(np.diff(angle)), DRIVE.angular_pitch, rtol=1e-10)


def test_too_few_points_are_refused():
    with pytest.raises(ValueError, match="points_per_flank"):
        solids.pinion_outline(DRIVE, 1)
