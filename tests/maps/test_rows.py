"""Rows of a map: a parameter that moves breakpoints, against multipliers in closed form."""

import math
from dataclasses import dataclass

import numpy as np
import pytest

from facegear.floquet.loads import ContactLoad
from facegear.floquet.models import replace_parameter
from facegear.floquet.multipliers import growth_rate
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.floquet.radau import Radau
from facegear.maps.rows import in_rows
from facegear.maps.stability_map import stability_map
from facegear.mechanics import cases
from facegear.mechanics.gearboxes import FIGURES
from facegear.mechanics.torsional import Torsional
from facegear.support.parameters import rad_per_s

SOFT, STIFF, DAMPING = 0.7, 1.3, 0.02


@dataclass(frozen=True)
class Uneven:
    """q̈ + c q̇ + ω² q = 0, stiff for a part of the period and soft for the rest of it."""

    part: float = 0.3

    def breaks_at(self, speed):
        return self.part

    def system(self, speed):
        signs = PiecewiseChebyshev(np.array([0.0, self.breaks_at(speed)]), np.array([[[1.0]], [[0.0]]]))
        load = ContactLoad(PiecewiseChebyshev.constant([1.0]), STIFF - SOFT, weight=signs)
        return PeriodicSystem([[1.0]], [[DAMPING]], [[SOFT]], [load], 2.0 * math.pi / speed)

    def growth(self, speed):
        """Growth rate from the product of both motions."""
        period, product = 2.0 * math.pi / speed, np.eye(2)
        part = self.breaks_at(speed)
        for stiffness, share in ((STIFF, part), (SOFT, 1.0 - part)):
            w, t = math.sqrt(stiffness - DAMPING**2 / 4.0), share * period
            cosine, sine = math.cos(w * t), math.sin(w * t) / w
            motion = [
                [cosine + DAMPING / 2.0 * sine, sine],
                [-stiffness * sine, cosine - DAMPING / 2.0 * sine],
            ]
            product = math.exp(-DAMPING * t / 2.0) * np.array(motion) @ product
        return math.log(np.abs(np.linalg.eigvals(product)).max()) / period


class Turning(Uneven):
    """Breakpoints move with speed as well."""

    def breaks_at(self, speed):
        return self.part * (1.0 + 0.05 * speed)


@pytest.mark.parametrize("kind", [Uneven, Turning])
@pytest.mark.parametrize("speeds", [[1.3], [1.0, 1.9], np.linspace(0.9, 2.6, 150)])
def test_each_cell_is_the_closed_form(kind, speeds):
    parts = [0.2, 0.35, 0.5, 0.8]
    chart = stability_map(kind(), speeds, "part", parts, jobs=1)
    expected = [[kind(part).growth(float(speed)) for speed in speeds] for part in parts]
    # Multipliers coincide at the borders, where they are known to the root of their error.
    np.testing.assert_allclose(chart.values, expected, atol=1e-7)


def test_many_speeds_take_few_systems(monkeypatch):
    built, system = [], Uneven.system
    monkeypatch.setattr(Uneven, "system", lambda self, speed: built.append(speed) or system(self, speed))
    chart = stability_map(Uneven(), np.linspace(0.9, 2.6, 300), "part", np.linspace(0.1, 0.9, 6), jobs=1)
    assert len(built) < 0.3 * chart.size


def test_an_axis_too_rough_to_interpolate_along_goes_by_rows(monkeypatch):
    """Stiffnesses over three decades: a series along them would take as many matrices as there are values."""
    built, system = [], Torsional.system
    figure = FIGURES["7.10b"]
    speeds = rad_per_s(np.linspace(figure.lowest_rpm, 1000.0, 300))
    values = np.geomspace(figure.lowest, figure.highest, 16)
    monkeypatch.setattr(Torsional, "system", lambda self, speed: built.append(speed) or system(self, speed))
    chart = stability_map(figure.model(), speeds, figure.parameter, values, method=Radau(), jobs=1)
    assert len(built) < 0.6 * chart.size
    for row, column in ((0, 0), (5, 150), (15, 299)):
        model = replace_parameter(figure.model(), figure.parameter, float(values[row]))
        alone = growth_rate(model.system(float(speeds[column])), Radau())
        assert float(chart[row, column]) == pytest.approx(alone, abs=1e-6)


def test_rows_of_few_speeds_are_grouped():
    values = tuple(np.linspace(0.1, 0.9, 40).tolist())
    places, groups = zip(*in_rows(Uneven(), ("part",), values, np.array([1.0, 2.0]), None), strict=True)
    assert [place.stop - place.start for place in places] == [16, 16, 8]
    assert [value for group in groups for value in group.values] == list(values)


def test_rows_of_few_speeds_are_taken_together_and_are_those_of_another_method():
    """Thickness scales the frequencies of the disk: neighbouring rows differ, and each cell has its own panels."""
    model = cases.FIGURES["4.4a"].model()
    speeds, values = rad_per_s(np.linspace(150.0, 1000.0, 12)), [0.02, 0.03, 0.05, 0.08]
    chart = stability_map(model, speeds, "thickness_ratio", values, jobs=1)
    for row, column in ((0, 11), (1, 5), (2, 0), (3, 7)):
        own = replace_parameter(model, "thickness_ratio", values[row])
        alone = growth_rate(own.system(float(speeds[column])), Radau())
        assert float(chart[row, column]) == pytest.approx(alone, abs=1e-6)
