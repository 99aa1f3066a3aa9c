"""Interpolated transition matrices: what dies within a period, degrees of series, truth from outside."""

from dataclasses import dataclass

import numpy as np
import pytest
from scipy.special import jv

from facegear.floquet.models import replace_parameter
from facegear.floquet.multiplier_curves import FrozenMotions, MultiplierCurve
from facegear.floquet.multipliers import growth_rate
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.radau import Radau
from facegear.mechanics.gearboxes import FIGURES
from facegear.support.parameters import rad_per_s
from tests.independent.torsional_switching import numbers_of, spectral_radius


@dataclass(frozen=True)
class Oscillators:
    """Independent oscillators of constant stiffness and damping, period 2π/speed."""

    frequencies: tuple[float, ...]
    dampings: tuple[float, ...]

    def system(self, speed):
        squares = np.square(self.frequencies)
        return PeriodicSystem(
            np.eye(squares.size), np.diag(self.dampings), np.diag(squares), (), 2 * np.pi / speed
        )


def test_degree_is_where_bessel_functions_have_ended():
    # cos(ω T0) on a window of half-width z in ω T0 has the coefficients 2 J_n(z).
    motions = FrozenMotions.of(Oscillators((50.0,), (0.0,)), 0.05, 0.3)
    size = 50.0 * 2 * np.pi * 0.25 / 2
    degree = motions.degree(0.05, 0.3)
    orders = np.arange(200)
    last = orders[2 * np.abs(jv(orders, size)) > 1e-12].max()
    assert last <= degree <= last + 2
    assert motions.live_angle(30.0)[1][-1] == pytest.approx(2 * size, rel=1e-12)


def test_what_dies_within_a_period_does_not_count():
    # The fast motion decays by e^-30 where 300 T0 = 30, at a slowness of 0.1/2π.
    low, high = 0.05 / (2 * np.pi), 0.5 / (2 * np.pi)
    motions = FrozenMotions.of(Oscillators((1000.0, 20.0), (600.0, 0.1)), low, high)
    fast, slow = np.sqrt(1000.0**2 - 300.0**2), np.sqrt(20.0**2 - 0.05**2)
    angle = np.interp(np.array([0.05, 0.1, 0.5]) / (2 * np.pi), *motions.live_angle(30.0))
    assert angle == pytest.approx([0.0, 0.05 * fast, 0.05 * fast + 0.4 * slow], rel=1e-9)
    # By e^-24 it has decayed at a slowness of 0.08/2π.
    angle = np.interp(np.array([0.05, 0.08, 0.5]) / (2 * np.pi), *motions.live_angle(24.0))
    assert angle == pytest.approx([0.0, 0.03 * fast, 0.03 * fast + 0.42 * slow], rel=1e-9)


def test_points_are_no_further_apart_than_asked():
    motions = FrozenMotions.of(Oscillators((1000.0, 20.0), (600.0, 0.1)), 0.008, 0.08)
    points = motions.points(0.2, 64, 30.0)
    assert points[[0, -1]].tolist() == [0.008, 0.08]
    slowness, angle = motions.live_angle(30.0)
    assert np.diff(np.interp(points, slowness, angle)).max() <= 0.2 * (1 + 1e-9)
    assert np.diff(points).max() <= (0.08 - 0.008) / 64 * (1 + 1e-9)


@pytest.mark.parametrize(
    ("name", "value"), [pytest.param("7.9b", 40.0, marks=pytest.mark.slow), ("7.11b", 1.0), ("7.13a", 1e-6)]
)
def test_stiff_gearboxes_take_one_window_and_agree_with_dop853(name, value):
    figure = FIGURES[name]
    model = replace_parameter(figure.model(), figure.parameter, value)
    low, high = rad_per_s(np.array([figure.lowest_rpm, 1500.0])).tolist()
    curve = MultiplierCurve.of(model, low, high, Radau())
    assert len(curve.windows) == 1
    assert curve.error < 1e-10
    speeds_rpm = np.array([711.7, 1333.3])
    truth = [spectral_radius(numbers_of(model), speed) for speed in speeds_rpm.tolist()]
    assert curve.spectral_radii(rad_per_s(speeds_rpm)) == pytest.approx(truth, abs=1e-9)


@pytest.mark.slow
def test_a_long_range_of_fast_oscillators_takes_several_windows():
    model = Oscillators((31.0, 77.7), (0.01, 0.02))
    curve = MultiplierCurve.of(model, 0.5, 20.0)
    assert len(curve.windows) > 1
    speeds = np.linspace(0.5, 20.0, 41)
    expected = [growth_rate(model.system(speed)) for speed in speeds.tolist()]
    assert np.log(curve.spectral_radii(speeds)) * speeds / (2 * np.pi) == pytest.approx(expected, abs=1e-9)
    assert curve.slopes(speeds).shape == (41, 4, 4)
