"""Peaks of forces given as plain functions of speed, whose maxima are known; speeds at which harmonics are met."""

import numpy as np
import pytest

from facegear.floquet.models import Coordinate
from facegear.floquet.periodic import PeriodicSystem
from facegear.maps.resonance_peaks import peaks_of, resonances_between

SPEEDS = np.linspace(1.0, 3.0, 21)


def found(rms, resolution=1e-6):
    """Peaks of one load whose force is symmetric about nothing: its lowest value is −1.5, its highest 2 times rms."""

    def forces(speed):
        value = rms(speed)
        return np.array([[value, -1.5 * value, 2.0 * value]])

    each = np.stack([forces(speed) for speed in SPEEDS.tolist()])
    return peaks_of(SPEEDS, each, forces, lambda speed: f"at {speed:.3f}", resolution)


def test_a_peak_between_the_speeds_is_found_and_its_ends_told():
    peaks, at_borders = found(lambda v: 3.0 / (1.0 + 400.0 * (v - 1.7321) ** 2))
    assert at_borders == 0
    (speed,) = peaks["peak_speed"][1]
    assert speed == pytest.approx(1.7321, rel=1e-5)
    values = [peaks[f"peak_force_{name}"][1][0] for name in ("rms", "lowest", "highest")]
    assert values == pytest.approx([3.0, -4.5, 6.0], rel=1e-8)
    assert peaks["peak_load"][1].tolist() == [0]
    assert peaks["peak_label"][1].tolist() == ["at 1.732"]


def test_peaks_come_in_the_order_of_speed_and_ends_of_the_range_are_none():
    peaks, _ = found(lambda v: float(np.cos(6.0 * np.pi * v)) + 2.0)
    np.testing.assert_allclose(peaks["peak_speed"][1], [4 / 3, 5 / 3, 2.0, 7 / 3, 8 / 3], rtol=1e-5)


def test_what_rises_up_to_where_nothing_is_known_is_counted_only():
    border = 2.0371
    peaks, at_borders = found(lambda v: np.nan if border < v < 2.06 else 1.0 / (0.01 + abs(v - border)))
    assert at_borders == 1
    assert peaks["peak_speed"][1].size == 0


def test_rounding_is_no_peak():
    assert found(lambda v: 1.0 + 1e-14 * np.sin(50.0 * v))[0]["peak_speed"][1].size == 0


class Oscillator:
    """Q'' + 2 ζ Q' + Q = 0 under a mesh of as many periods as its speed."""

    coordinates = (Coordinate("mass", "m"),)

    def __init__(self, damping_ratio):
        self.damping_ratio = damping_ratio

    def system(self, speed):
        return PeriodicSystem([[1.0]], [[2.0 * self.damping_ratio]], [[1.0]], (), 2.0 * np.pi / speed)


def test_harmonics_that_meet_a_natural_frequency_between_speeds_far_apart():
    """At 1/h of it, h up to 6; of a resonance as wide as a step the speeds themselves tell."""
    speeds = np.array([0.155, 0.18, 0.22, 0.27, 0.4, 0.7, 1.3])
    ratio = 1e-3
    own = np.sqrt(1.0 - ratio**2)
    expected = own / np.array([6.0, 5.0, 4.0, 3.0, 2.0, 1.0])
    np.testing.assert_allclose(resonances_between(Oscillator(ratio), speeds, 1e-9), expected, rtol=1e-8)
    assert resonances_between(Oscillator(0.5), speeds, 1e-9).size == 0
