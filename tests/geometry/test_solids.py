"""Outlines and meshes as another program reads them: closed, turned outwards, of the right size and place."""

import math

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from facegear import Drive
from facegear.drives.export import write_stl
from facegear.geometry import solids

DRIVE = Drive(26, 130, 3.175e-3)
# Base circle inside the dedendum circle (from 27 teeth at 25°), no height at the inner end (from 48), crossed flanks
# there (200), and shafts at other angles.
DRIVES = [
    DRIVE,
    Drive(31, 107, 3.175e-3),
    Drive(48, 240, 3.175e-3),
    Drive(73, 365, 2e-3, math.radians(20.0)),
    Drive(60, 300, 2e-3),
    Drive(200, 1000, 1e-3),
    Drive(300, 1500, 0.1),
    Drive(12, 14, 1e-3, math.radians(20.0)),
    Drive(28, 126, 3e-3, shaft_angle=math.radians(70.0)),
    Drive(31, 107, 2e-3, shaft_angle=math.radians(110.0)),
]


def label(drive):
    return f"{drive.pinion_teeth}/{drive.gear_teeth} {math.degrees(drive.shaft_angle):.0f}"


each_drive = pytest.mark.parametrize("drive", DRIVES, ids=label)


def read(mesh):
    """As the outside reader has it, with vertices and triangles as they are."""
    return trimesh.Trimesh(mesh.vertices, mesh.triangles, process=False)


def assert_solid(body):
    assert body.is_watertight
    assert body.is_winding_consistent
    assert body.volume > 0.0


@each_drive
@pytest.mark.parametrize("make", [solids.pinion, solids.face_gear_tooth], ids=["pinion", "tooth"])
def test_meshes_are_closed_and_turned_outwards(drive, make):
    body = read(make(drive))
    assert_solid(body)
    assert body.euler_number == 2
    assert body.volume == pytest.approx(solids.volume(make(drive)), rel=1e-9)


def test_every_tooth_of_the_ring_is_a_body_turned_outwards():
    ring = read(solids.face_gear(DRIVE))
    bodies = ring.split(only_watertight=True, adjacency=ring.face_adjacency, engine="scipy")
    assert len(bodies) == DRIVE.gear_teeth
    tooth = solids.volume(solids.face_gear_tooth(DRIVE, 5, 4))
    for body in bodies:
        assert_solid(body)
        assert body.volume == pytest.approx(tooth, rel=1e-9)


@each_drive
def test_stl_is_read_as_the_same_solid(drive, tmp_path):
    mesh = solids.tooth_surface(drive, 9, 6).solid()
    body = trimesh.load_mesh(write_stl(mesh, tmp_path / "tooth.stl", label(drive)))
    assert_solid(body)
    assert len(body.faces) == len(mesh.triangles)
    assert body.volume == pytest.approx(1e9 * solids.volume(mesh), rel=1e-3)


@st.composite
def valid_drives(draw):
    """Any drive that is not refused."""
    pinion = draw(st.integers(10, 300))
    gear = draw(st.integers(pinion + 1, 8 * pinion))
    pressure, shaft = draw(st.floats(14.5, 30.0)), draw(st.floats(60.0, 120.0))
    try:
        return Drive(
            pinion, gear, draw(st.sampled_from([1e-4, 3e-3, 0.1])), *np.radians([pressure, shaft]).tolist()
        )
    except ValueError as refusal:
        assert str(refusal).startswith(("pinion_teeth=", "shaft_angle=", "outer_radius="))  # noqa: PT017
        return DRIVE


def closed_and_turned_outwards_or_refused(drive, tmp_path_factory):
    try:
        mesh = solids.tooth_surface(drive, 5, 4).solid()
    except ValueError as refusal:
        assert str(refusal).startswith("drive must have a tooth between its flanks")  # noqa: PT017
        return
    assert_solid(read(mesh))
    path = write_stl(mesh, tmp_path_factory.mktemp("stl") / "tooth.stl", "any")
    assert_solid(trimesh.load_mesh(path))
    assert_solid(read(solids.pinion(drive)))


@settings(max_examples=10)
@given(drive=valid_drives())
def test_any_drive_gives_a_closed_tooth_turned_outwards_or_says_why_not(drive, tmp_path_factory):
    closed_and_turned_outwards_or_refused(drive, tmp_path_factory)


@pytest.mark.slow
@settings(max_examples=40)
@given(drive=valid_drives())
def test_any_of_many_drives_gives_a_closed_tooth_turned_outwards_or_says_why_not(drive, tmp_path_factory):
    closed_and_turned_outwards_or_refused(drive, tmp_path_factory)


@pytest.mark.parametrize("drive", DRIVES[2:7], ids=label)
def test_tooth_without_height_at_its_inner_end_rises_from_an_edge(drive):
    points = solids.tooth_surface(drive, 9, 6).points[0]
    assert np.ptp(points[0], axis=0).max() == 0.0
    height = np.linalg.norm(np.diff(points, axis=1), axis=-1).sum(axis=1)
    assert np.all(height[1:] > 0.1 * drive.module)
    # Inside its start the tooth is all fillet, or the flanks have crossed at the shaper's tip.
    assert points[0, 0, 0] >= 0.999 * solids.LEAST_LAND / 2


@each_drive
def test_outline_runs_once_around_from_dedendum_to_tip(drive):
    outline = solids.pinion_outline(drive, 60)
    radius = np.linalg.norm(outline, axis=1)
    assert radius.min() == pytest.approx(drive.pitch_radius - 1.25 * drive.module, rel=1e-12)
    assert radius.max() == pytest.approx(drive.pitch_radius + drive.module, rel=1e-12)
    x, y = np.vstack([outline, outline[:1]]).T
    turn = np.diff(np.unwrap(np.arctan2(y, x)))
    # Never back about the centre, so that it does not cross itself; once around.
    assert np.all(turn > -1e-12)
    assert turn.sum() == pytest.approx(2 * math.pi, rel=1e-12)


def test_dedendum_circle_outside_the_base_circle():
    """31 teeth at 25° and 3.175 mm: 45.244 mm, not the 44.602 mm of the base circle."""
    radius = np.linalg.norm(solids.pinion_outline(DRIVES[1]), axis=1)
    assert 1e3 * radius.min() == pytest.approx(3.175 * (15.5 - 1.25), rel=1e-12)


def section(drive):
    """Area of the section: an involute from its base circle sweeps r_b² θ³/6 about the centre.

    Between tips and in root lands the outline takes the chord.
    """
    rb, rf, ra = drive.base_radius, drive.dedendum_radius, drive.pinion_tip_radius
    low, high = (math.sqrt(max(r / rb, 1.0) ** 2 - 1.0) for r in (rf, ra))
    below, above = (drive.space_half_angle + t - math.atan(t) for t in (low, high))
    pitch = 2 * math.pi / drive.pinion_teeth
    chords = 0.5 * rf**2 * math.sin(2 * below) + 0.5 * ra**2 * math.sin(pitch - 2 * above)
    return drive.pinion_teeth * (chords + rb**2 * (high**3 - low**3) / 3)


@each_drive
def test_pinion_volume_is_its_section_times_the_face_width(drive):
    body = read(solids.pinion(drive, points_per_flank=200))
    assert body.volume == pytest.approx(section(drive) * drive.face_width, rel=1e-5)


@each_drive
def test_pinion_stands_where_it_touches(drive):
    """Its middle lies on its axis, over the middle of the face where the pitch cones touch."""
    middle = np.mean([drive.inner_radius, drive.outer_radius])
    gamma = drive.shaft_angle
    # A point a pitch radius below the axis, at u along it, is u sin γ − r_p cos γ from the gear's axis.
    u = (middle + drive.pitch_radius * math.cos(gamma)) / math.sin(gamma)
    centre = np.array([0.0, -u * math.sin(gamma), -u * math.cos(gamma)])
    vertices = solids.pinion(drive).vertices
    np.testing.assert_allclose(vertices.mean(axis=0), centre, rtol=0, atol=1e-9 * drive.outer_radius)


def test_tooth_volume_settles_under_refinement():
    volumes = [solids.volume(solids.face_gear_tooth(DRIVE, n, n)) for n in (8, 16, 32)]
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
