"""The largest growth rate near a speed, against the closed first order of Mathieu's equation and a fine scan."""

import numpy as np
import pytest

from facegear.floquet.methods import Collocation
from facegear.floquet.multipliers import growth_rate
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
