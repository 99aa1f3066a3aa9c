"""The largest growth rate near a speed, against the closed first order of Mathieu's equation and a fine scan."""

from dataclasses import dataclass

import numpy as np
import pytest

from facegear.floquet.loads import ContactLoad
from facegear.floquet.methods import Collocation
from facegear.floquet.multipliers import growth_rate
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.maps.peaks import growth_peak
from facegear.mechanics.classical import Mathieu

STEPS = {"window": 0.004, "widest": 0.03, "resolution": 3e-5}


@pytest.mark.parametrize("guess", [2.0, 1.9, 2.15])
def test_a_peak_outside_the_first_window_is_followed(guess):
    speed, growth = growth_peak(Mathieu(0.3), guess, (1.0, 3.0), **STEPS)
    scan = np.linspace(1.9, 2.1, 201)
    rates = [growth_rate(Mathieu(0.3).system(float(x)), Collocation()) for x in scan]
    assert speed == pytest.approx(scan[int(np.argmax(rates))], abs=1.5e-3)
    assert growth >= max(rates) - 1e-9
    # First order: a quarter of the depth at twice the natural frequency.
    assert growth == pytest.approx(0.3 / 4, rel=0.02)


def test_at_an_end_of_the_range_the_growth_there_counts():
    speed, growth = growth_peak(Mathieu(0.3), 1.99, (1.9, 1.98), **STEPS)
    assert speed == pytest.approx(1.98, abs=1e-4)
    assert growth == pytest.approx(growth_rate(Mathieu(0.3).system(1.98), Collocation()), abs=1e-5)


def test_a_peak_that_always_lies_farther_is_lost():
    with pytest.raises(ArithmeticError, match=r"no largest growth rate near 1\.9 rad/s"):
        growth_peak(Mathieu(0.3), 1.9, (1.0, 3.0), window=1e-5, widest=1e-5, resolution=1e-8)


@dataclass(frozen=True)
class Moving:
    """Mathieu's equation with a stiffness that jumps where speed says, if at all."""

    moves: bool

    def system(self, speed):
        at = 0.4 + 0.05 * speed * self.moves
        jump = PiecewiseChebyshev([0.0, at], [[[0.1]], [[0.5]]])
        load = ContactLoad(PiecewiseChebyshev.constant([1.0]), stiffness=1.0, damping=0.01, weight=jump)
        return PeriodicSystem([[1.0]], [[0.02]], [[1.0]], (load,), 2.0 * np.pi / speed)


@pytest.mark.parametrize("moves", [False, True])
def test_a_peak_is_that_of_a_fine_scan_whether_matrices_can_be_interpolated_or_not(moves):
    speed, growth = growth_peak(Moving(moves), 2.22, (1.0, 4.0), **STEPS)
    scan = speed * (1.0 + np.linspace(-4e-3, 4e-3, 161))
    rates = [growth_rate(Moving(moves).system(float(x))) for x in scan]
    assert growth > 0.01
    assert growth == pytest.approx(growth_rate(Moving(moves).system(speed)), abs=1e-10)
    assert growth >= max(rates) - 1e-9
    assert speed == pytest.approx(scan[int(np.argmax(rates))], rel=1e-4)
