"""Phases between pinions against printed angles and their definition."""

import math

import numpy as np
import pytest

from facegear.geometry.drive import Drive
from facegear.geometry.phases import phase_split


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
