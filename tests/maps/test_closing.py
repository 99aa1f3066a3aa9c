from dataclasses import dataclass

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from facegear.floquet.loads import ContactLoad
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.maps.closing import growth_peaks, largest_growth
from tests.independent import classical

TURN = 2.0 * np.pi
DEPTH = 0.3
COSINE = PiecewiseChebyshev.fit(lambda x, piece: np.cos(TURN * x), [0.0])


@dataclass(frozen=True)
class Shifted:
    """Mathieu's equation y'' + (1 + ε cos ωt) y = 0 with q = e^{-ct} y: its growth rate is less by c, exactly.

    c is 0.05 (p - 1)² + `least`, so that a tongue closes and opens again as p grows.
    """

    p: float = 0.0
    least: float = 0.02

    @property
    def c(self):
        return 0.05 * (self.p - 1.0) ** 2 + self.least

    def system(self, speed):
        load = ContactLoad(PiecewiseChebyshev.constant([1.0]), stiffness=DEPTH, weight=COSINE)
        return PeriodicSystem(np.eye(1), [[2.0 * self.c]], [[1.0 + self.c**2]], (load,), TURN / speed)


@pytest.fixture(scope="module")
def undamped():
    """Speed and largest growth rate of the principal tongue without damping, by DOP853."""
    found = minimize_scalar(
        lambda w: -classical.growth_rate(classical.mathieu(w, DEPTH)), bounds=(1.8, 2.2), method="bounded"
    )
    return found.x, -found.fun


def test_largest_growth_of_a_tongue_and_of_a_stable_range(undamped):
    speed, growth = undamped
    for p in (1.0, 3.0):
        model = Shifted(p)
        found = largest_growth(model, (1.7, 2.3))
        assert found[1] == pytest.approx(growth - model.c, abs=1e-9)
        assert found[0] == pytest.approx(speed, abs=1e-4)


def test_every_value_between_samples_is_found(undamped):
    _, growth = undamped
    width = np.sqrt((growth - 0.02) / 0.05)
    found = growth_peaks(Shifted(), "p", np.linspace(-0.5, 2.5, 4), (1.7, 2.3))
    values = [closing.value for closing in found.closing_values]
    np.testing.assert_allclose(values, [1.0 - width, 1.0 + width], rtol=1e-6)
    assert [closing.closes for closing in found.closing_values] == [False, True]
    assert {closing.label for closing in found.closing_values} == {"(1+1)/1"}
    np.testing.assert_allclose(found.growth_rates, [growth - Shifted(p).c for p in found.values], atol=1e-9)


@pytest.mark.slow
def test_two_values_between_neighbouring_samples_are_found(undamped):
    """All samples are stable; the tongue is open only around p = 1, by far less than the step."""
    depth = 1e-5
    _, growth = undamped
    model = Shifted(0.0, growth - depth)
    half = np.sqrt(depth / 0.05)
    found = growth_peaks(model, "p", [0.0, 0.55, 1.3, 2.0], (1.7, 2.3)).closing_values
    np.testing.assert_allclose([closing.value for closing in found], [1.0 - half, 1.0 + half], rtol=1e-4)
    assert [closing.closes for closing in found] == [False, True]


def test_nothing_is_found_where_nothing_closes(undamped):
    _, growth = undamped
    barely = Shifted(0.0, growth + 1e-5)
    assert growth_peaks(barely, "p", [0.0, 0.55, 1.3, 2.0], (1.7, 2.3)).closing_values == ()


class TestRefusals:
    @pytest.mark.parametrize("values", [[0.0, 1.0], [0.0, 2.0, 1.0], [[0.0, 1.0, 2.0]]])
    def test_values(self, values):
        with pytest.raises(ValueError, match="values must be at least three, ascending"):
            growth_peaks(Shifted(), "p", values, (1.7, 2.3))

    def test_values_that_are_not_finite(self):
        with pytest.raises(ValueError, match="values must be finite"):
            growth_peaks(Shifted(), "p", [0.0, 1.0, np.nan], (1.7, 2.3))

    def test_range_of_speed(self):
        with pytest.raises(ValueError, match="speeds must ascend"):
            largest_growth(Shifted(), (2.3, 1.7))

    def test_parameter(self):
        with pytest.raises(ValueError, match="parameter must be one of"):
            growth_peaks(Shifted(), "damping", [0.0, 1.0, 2.0], (1.7, 2.3))

    def test_tongue_that_leaves_the_range(self):
        with pytest.raises(ArithmeticError, match="widen the range"):
            growth_peaks(Shifted(), "p", np.linspace(0.0, 2.5, 4), (1.7, 1.95))
