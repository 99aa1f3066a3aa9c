import math

import numpy as np
import pytest

from facegear.design import teeth as tooth_design
from facegear.support.parameters import rad_per_s, watt

DRIVE = tooth_design.constant_diametral_pitch(25)


def test_families_keep_what_their_names_say():
    by_pitch = [tooth_design.constant_diametral_pitch(teeth) for teeth in (22, 35)]
    assert [drive.module for drive in by_pitch] == [25.4e-3 / 8] * 2
    by_radius = [tooth_design.constant_pitch_radius(teeth) for teeth in (22, 35)]
    assert [drive.pitch_radius for drive in by_radius] == pytest.approx([49.2125e-3] * 2, rel=1e-15)
    assert [drive.gear_teeth for drive in by_pitch + by_radius] == [110, 175, 110, 175]


def test_tooth_thickness_is_half_a_pitch_at_the_pitch_circle():
    chord = 2 * DRIVE.pitch_radius * math.sin(math.pi / (2 * DRIVE.pinion_teeth))
    assert tooth_design.tooth_thickness(DRIVE, DRIVE.pitch_radius) == pytest.approx(chord, rel=1e-14)


def test_tooth_and_space_fill_the_pitch_on_the_base_circle():
    """θ0s of (3-1) is half the space; the tooth has the rest."""
    half_tooth = math.pi / DRIVE.pinion_teeth - DRIVE.space_half_angle
    chord = 2 * DRIVE.base_radius * math.sin(half_tooth)
    assert tooth_design.tooth_thickness(DRIVE, DRIVE.base_radius) == pytest.approx(chord, rel=1e-12)


def test_tooth_follows_the_flank_of_the_generating_pinion():
    """Points of the flank (3-2) bound the tooth space; the tooth lies on the other side of them."""
    drive = tooth_design.constant_diametral_pitch(32)
    points = drive.pinion_flank(along=2, across=9).points[0]
    radius = np.hypot(points[:, 0], points[:, 1])
    # Angle from the middle of the space, whichever axis it lies on.
    polar = np.abs(np.arctan2(points[:, 0], points[:, 1]))
    space = np.minimum(polar, np.abs(polar - np.pi / 2))
    space = np.minimum(space, np.pi - polar)
    chord = 2 * radius * np.sin(np.pi / drive.pinion_teeth - space)
    ours = [tooth_design.tooth_thickness(drive, r) for r in np.clip(radius, None, drive.pinion_tip_radius)]
    assert ours == pytest.approx(chord, rel=1e-10)


def test_root_stress_is_that_of_a_cantilever():
    power, speed = float(watt(600.0)), float(rad_per_s(5000.0))
    width, length = tooth_design.root_thickness(DRIVE), 1.25 * DRIVE.module
    force = power / speed / DRIVE.pitch_radius
    moment_of_area = DRIVE.face_width * width**3 / 12
    expected = force * length * (width / 2) / moment_of_area
    assert tooth_design.root_stress(DRIVE, power, speed) == pytest.approx(expected, rel=1e-14)
    assert tooth_design.root_stress(DRIVE, power, speed, thickness=2 * width) == pytest.approx(expected / 4)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: tooth_design.constant_pitch_radius(25, pitch_radius=0.0), "pitch_radius"),
        (lambda: tooth_design.constant_pitch_radius(25, pitch_radius=49.2125), "module"),
        (lambda: tooth_design.constant_pitch_radius(0), "pinion_teeth"),
        (lambda: tooth_design.constant_diametral_pitch(25, gear_ratio=1), "gear_ratio"),
        (lambda: tooth_design.root_stress(DRIVE, -1.0, 500.0), "power"),
        (lambda: tooth_design.root_stress(DRIVE, 1.0, math.nan), "pinion_speed"),
        (lambda: tooth_design.root_stress(DRIVE, 1.0, 500.0, thickness=0.0), "thickness"),
        (lambda: tooth_design.tooth_thickness(DRIVE, 39.6875), "radius"),
    ],
)
def test_wrong_input_names_the_parameter(call, message):
    with pytest.raises(ValueError, match=message):
        call()


def test_teeth_are_counted():
    with pytest.raises(TypeError, match="pinion_teeth"):
        tooth_design.constant_diametral_pitch(25.0)
