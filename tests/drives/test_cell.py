"""One cell of a map in detail, against closed forms."""

from dataclasses import replace

import numpy as np
import pytest

from facegear.drives.cell import cell_detail
from facegear.mechanics import cases
from facegear.mechanics.classical import Meissner, meissner_trace
from facegear.mechanics.disk import shape_vector
from facegear.mechanics.properties import MeshLoad
from facegear.mechanics.transverse import Transverse
from facegear.support.parameters import rad_per_s

SQUARE = Meissner(depth=0.6, duty=0.4)


def test_multipliers_and_tongue_of_a_cell_are_those_of_the_closed_form():
    model = replace(SQUARE, depth=0.2)
    detail = cell_detail(model, 1.95)
    trace = float(meissner_trace(1.95, 0.2, 0.4))
    assert complex(detail.multipliers.sum()) == pytest.approx(trace, abs=1e-9)
    assert complex(detail.multipliers.prod()) == pytest.approx(1.0, abs=1e-9)
    assert detail.growth_rate == pytest.approx(np.log(abs(detail.critical)) * 1.95 / (2 * np.pi))
    assert detail.label == "(1+1)/1"
    assert detail.deflections == {}
    assert detail.tongue.lower < 1.95 < detail.tongue.upper
    for border in (detail.tongue.lower, detail.tongue.upper):
        assert abs(float(meissner_trace(border, 0.2, 0.4))) == pytest.approx(2.0, abs=1e-6)


def test_a_tongue_wider_than_what_is_searched_ends_where_the_search_does():
    detail = cell_detail(SQUARE, 1.9)
    assert abs(float(meissner_trace(detail.searched[0], 0.6, 0.4))) > 2.0
    assert detail.tongue.lower == detail.searched[0]
    assert abs(float(meissner_trace(detail.tongue.upper, 0.6, 0.4))) == pytest.approx(2.0, abs=1e-6)


def test_stable_cell_has_neither_tongue_nor_label():
    detail = cell_detail(SQUARE, 1.3)
    assert abs(float(meissner_trace(1.3, 0.6, 0.4))) < 2.0
    assert detail.tongue is None
    assert detail.label is None
    assert np.abs(detail.multipliers) == pytest.approx(1.0, abs=1e-9)


def test_motion_over_time_is_that_of_the_equation_and_returns_times_the_multiplier():
    model = replace(SQUARE, depth=0.2, damping_ratio=0.01)
    detail = cell_detail(model, 1.95)
    motion = detail.history[:, 0]
    # Within a part of the square wave the equation is q̈ + 2ϑ q̇ + (1 ± ε) q = 0.
    time = motion["time"].values
    first = motion.values[(time > 0.0) & (time < 0.4)]
    step = 2.0 * np.pi / 1.95 * (time[1] - time[0])
    acceleration = (first[2:] - 2.0 * first[1:-1] + first[:-2]) / step**2
    velocity = (first[2:] - first[:-2]) / (2.0 * step)
    residual = acceleration + 0.02 * velocity + 1.2 * first[1:-1]
    assert np.abs(residual).max() < 2e-3 * np.abs(first).max()
    one_period = motion.size // 6
    ahead = motion.values[one_period : 2 * one_period]
    assert ahead == pytest.approx(detail.critical.real * motion.values[:one_period], abs=1e-6)
    # What the integration over a period ends with is what the next one begins with.
    ends = motion.values[[one_period - 1, one_period]]
    assert ends[0] == pytest.approx(ends[1], abs=1e-6)


def test_critical_motion_of_a_free_disk_is_a_travelling_wave():
    free = Transverse(cases.CASE_1, MeshLoad(0.0, 0.0, 0.0))
    detail = cell_detail(free, float(rad_per_s(700.0)))
    deflection = detail.deflections["face gear"].values
    assert np.abs(deflection).max() == pytest.approx(1.0)
    assert np.abs(deflection[0]).max() < 1e-9  # clamped at the bore
    assert np.ptp(np.abs(deflection), axis=1).max() < 1e-6
    turns = np.unwrap(np.angle(deflection[-1]))
    diameters = (turns[-1] - turns[0]) / (2.0 * np.pi)
    assert abs(diameters) == pytest.approx(round(abs(diameters)), abs=1e-6)
    assert detail.deflections["face gear"]["radius"].values[[0, -1]] == pytest.approx(
        [cases.CASE_1.bore_radius, cases.CASE_1.outer_radius]
    )


def test_deflection_is_that_of_the_motion():
    model = cases.FIGURES["4.4a"].model()
    detail = cell_detail(model, float(rad_per_s(533.0)))
    radius, angle = (detail.deflections["face gear"][name].values for name in ("radius", "angle"))
    expected = shape_vector(model.body, radius[7], angle[30]) @ detail.motion
    assert complex(detail.deflections["face gear"].values[7, 30]) == pytest.approx(complex(expected))


class Unnamed:
    """A model that does not say, or says wrongly, what its coordinate is."""

    def __init__(self, **named):
        self.__dict__.update(named)

    def system(self, speed):
        return SQUARE.system(speed)


@pytest.mark.parametrize(
    ("model", "error", "says"),
    [
        (Unnamed(), TypeError, "each of its 1 rows, got None"),
        (Unnamed(coordinates=("q",)), TypeError, r"each of its 1 rows, got \('q',\)"),
        (Unnamed(coordinates=SQUARE.coordinates * 2), ValueError, "each of its 1 rows, got 2"),
        (Unnamed(system=lambda speed: None), TypeError, "must be a PeriodicSystem, got a NoneType"),
    ],
)
def test_a_cell_of_an_incomplete_model_says_what_is_missing(model, error, says):
    with pytest.raises(error, match=says):
        cell_detail(model, 1.9)
