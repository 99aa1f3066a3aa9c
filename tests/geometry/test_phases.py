"""Phases between pinions against printed angles and their definition."""

import math

import numpy as np
import pytest

from facegear.geometry.drive import Drive
from facegear.geometry.phases import phase_split, touching_angle


def test_printed_positions_of_pinions_are_whole_teeth():
    drive = Drive(31, 155, 3.175e-3)
    assert round(math.degrees(3 * drive.angular_pitch), 2) == 6.97
    for degrees, teeth in ((90.6, 39), (118.5, 51), (181.2, 78)):
        assert round(math.degrees(teeth * drive.angular_pitch), 1) == degrees
    split = phase_split(drive, np.array([39, 51, 78]) * drive.angular_pitch)
    assert split.teeth.tolist() == [39, 51, 78]
    assert not split.phase.any()


def test_phase_split_is_5_1_and_5_2():
    drive = Drive(22, 110, 3.175e-3)
    split = phase_split(drive, np.radians([0.0, 90.0, 120.0, 180.0, -90.0]))
    assert split.teeth.tolist() == [0, 27, 36, 55, -28]
    np.testing.assert_allclose(split.phase, [0.0, 0.5, 2 / 3, 0.0, 0.5], atol=1e-12)
    total = split.positioning_angle + split.phasing_angle
    np.testing.assert_allclose(total, np.radians([0.0, 90.0, 120.0, 180.0, -90.0]), atol=1e-12)
    # 120° in radians times 130/2π is not a whole number by rounding only for tooth numbers divisible by three.
    whole = phase_split(Drive(24, 120, 3e-3), np.radians([120.0, 240.0, 360.0]))
    assert whole.teeth.tolist() == [40, 80, 120]
    assert not whole.phase.any()


def test_bad_angles_are_refused():
    with pytest.raises(ValueError, match="pinion_angles must be finite"):
        phase_split(Drive(26, 130, 3.175e-3), math.inf)


def test_degrees_are_told_from_radians():
    drive = Drive(26, 130, 3.175e-3)
    with pytest.raises(ValueError, match=r"pinion_angles must lie in .* got 120\.0 rad \(degrees\?"):
        phase_split(drive, [0.0, 120.0, 240.0])
    assert phase_split(drive, [-2 * math.pi, 2 * math.pi]).teeth.tolist() == [-130, 130]


@pytest.mark.parametrize("shaft_angle_deg", [70.0, 90.0, 105.0])
def test_pinions_touch_where_one_reaches_the_plane_half_way(shaft_angle_deg):
    gamma = np.radians(shaft_angle_deg)
    drive = Drive(31, 155, 3.175e-3, shaft_angle=gamma)
    round_the_tip = np.linspace(0, 2 * np.pi, 100_001)
    # Axis of the pinion in the plane of x and z, z being the gear's; its tip circle at the inner end of the teeth.
    axis, across = np.array([np.sin(gamma), 0, np.cos(gamma)]), np.array([np.cos(gamma), 0, -np.sin(gamma)])
    centre = axis * drive.inner_radius / np.sin(gamma)
    circle = (
        centre[:, None]
        + drive.pinion_tip_radius * np.cos(round_the_tip) * np.array([[0.0], [1.0], [0.0]])
        + drive.pinion_tip_radius * np.sin(round_the_tip) * across[:, None]
    )
    widest = np.degrees(np.arctan2(circle[1], circle[0]).max())
    assert touching_angle(drive) == pytest.approx(2 * np.radians(widest), abs=1e-8)
