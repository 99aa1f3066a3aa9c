import math

import numpy as np
import pytest
from hypothesis import given

from facegear.floquet import hsu
from facegear.floquet.averaging import ResonanceBlock, averaged_block, unstable_intervals
from facegear.floquet.modal import StandardForm, modal_expansion
from facegear.floquet.periodic import PeriodicSystem
from tests.independent.monodromy import fitted_order, floquet_growth
from tests.resonance_systems import (
    CHECK,
    by_label,
    load,
    mathieu,
    symmetric_systems,
)


@pytest.mark.parametrize(
    "number", [0, *(pytest.param(number, marks=pytest.mark.slow) for number in (1, 2, 3))]
)
def test_engine_equals_the_derived_criterion_for_every_pair(number):
    frequencies = np.array([1.0, 2.3, 3.9])
    mean = np.diag([0.02, 0.03, 0.04])
    amplitudes = 0.05 * np.random.default_rng(0).normal(size=(4, 4, 3, 3, 3))
    form = StandardForm(frequencies, mean, *amplitudes[number], 1.0)
    for band in hsu.resonance_bands(form.expansion(), order=3):
        if len(band.modes) > 2 or len(band.block.members) > 2:
            continue
        for frequency in (band.lower, band.peak, band.upper, band.centre + 0.01):
            twin = form.growth_rate(band.k, band.j, band.kind, band.order, frequency)
            assert band.growth(frequency) == pytest.approx(twin, abs=1e-13)
        for border in (band.lower, band.upper):
            assert band.growth(border) == pytest.approx(0, abs=1e-12)


def test_identical_natural_frequencies_need_the_whole_group():
    # K = 1 + cos(ωt) R diag(0.1, −0.04) Rᵀ decouples into two Mathieu equations, borders 2 ± 0.05 and 2 ± 0.02;
    # no pair of the original coordinates has either.
    angle = 0.5
    first = np.array([math.cos(angle), math.sin(angle)])
    second = np.array([-math.sin(angle), math.cos(angle)])
    loads = [load(first, 0.1, np.cos), load(second, 0.04, lambda p: -np.cos(p))]
    system = PeriodicSystem(np.eye(2), np.zeros((2, 2)), np.eye(2), loads, 1.0)
    bands = hsu.resonance_bands(system, order=1)
    assert len(bands) == 1
    assert bands[0].modes == (1, 2)
    assert bands[0].lower == pytest.approx(1.95, abs=1e-9)
    assert bands[0].upper == pytest.approx(2.05, abs=1e-9)
    assert bands[0].growth_rate == pytest.approx(0.025, rel=1e-9)


def test_close_natural_frequencies_against_floquet():
    sizes = np.array([0.2, 0.1, 0.05, 0.025])
    errors = []
    for size in sizes:
        mean = np.diag([1.0, (1 + 0.15 * size) ** 2, 6.0])
        shape = np.array([0.8, 0.7, 0.5])
        system = PeriodicSystem(np.eye(3), 0.05 * size * np.eye(3), mean, [load(shape, size, np.cos)], 1.0)
        bands = [band for band in hsu.resonance_bands(system, order=1) if band.centre < 2.5]
        assert len(bands) == 1
        assert bands[0].modes == (1, 2)

        def matrices(phase, size=size, mean=mean, shape=shape):
            stiffness = mean + size * np.cos(phase) * np.outer(shape, shape)
            return np.eye(3), 0.05 * size * np.eye(3), stiffness

        errors.append(abs(floquet_growth(matrices, bands[0].peak) - bands[0].growth_rate))
    assert fitted_order(sizes, errors) > 1.7


def test_search_of_larger_blocks_agrees_with_the_closed_form():
    # A third mode at 3 ω_1, coupled so weakly that it changes nothing visible, forces the search.
    small = 1e-7
    mean = np.diag([1.0, 9.0])
    loads = [load([1.0, small], 0.1, np.cos)]
    system = PeriodicSystem(np.eye(2), np.diag([0.02, 0.03]), mean, loads, 1.0)
    (alone,) = hsu.resonance_bands(mathieu(0.1, 0.02), order=1)
    expansion = modal_expansion(system, 1)
    a, b, c = 0, 2, 1

    block = averaged_block(expansion, (a, b, c), (1, 0, 2))
    ((lower, upper, peak),) = unstable_intervals(block, 2.0)
    assert (lower, upper) == pytest.approx((alone.lower, alone.upper), abs=1e-9)
    assert block.growth_rate(peak) == pytest.approx(alone.growth_rate, abs=1e-9)


@CHECK
@given(system=symmetric_systems(damped=True))
def test_no_band_grows_faster_than_the_bound_of_its_block(system):
    for band in hsu.resonance_bands(system, order=2):
        assert 0 < band.growth_rate <= band.block.growth_bound * (1 + 1e-9)
        around = np.linspace(0.5, 1.5, 101) * band.peak
        assert band.growth(around).max() <= band.block.growth_bound * (1 + 1e-9)


def test_one_undamped_mode_has_no_border_to_first_order():
    mean = np.diag([1.0, 5.0])
    system = PeriodicSystem(np.eye(2), np.diag([0.0, 0.02]), mean, [load([0.7, 0.7], 0.05, np.cos)], 1.0)
    band = by_label(hsu.resonance_bands(system, order=1))["(1+2)/1"]
    assert (band.lower, band.upper) == (0.0, math.inf)
    assert band.growth(band.centre + np.array([-0.3, 0.3])).min() > 0


@pytest.mark.parametrize("damping", [(0.0, 0.02), (0.02, 0.0)])
@pytest.mark.parametrize("phase", [0.4, -0.4])
def test_one_undamped_mode_with_a_complex_product_has_one_border(damping, phase):
    coupling = 0.01 * np.exp(0.5j * phase) * np.array([[0, 1], [1, 0]]) - np.diag(damping) / 2
    block = ResonanceBlock((0, 3), (1, 0), np.array([1.0, -2.2]), coupling, 2)
    ((lower, upper, _),) = unstable_intervals(block, 3.2)
    assert math.isinf(lower) != math.isinf(upper)
    border = upper if math.isinf(lower) else lower
    assert block.growth_rate(border) == pytest.approx(0, abs=1e-12)
    inside = 1e-3 if math.isinf(upper) else -1e-3
    assert block.growth_rate(border + inside) > 0 > block.growth_rate(border - inside)


def test_undamped_pair_with_a_complex_product_grows_at_every_detuning():
    coupling = 0.01 * np.exp(0.2j) * np.array([[0, 1], [1, 0]])
    block = ResonanceBlock((0, 3), (1, 0), np.array([1.0, -2.2]), coupling, 2)
    ((lower, upper, _),) = unstable_intervals(block, 3.2)
    assert (lower, upper) == (-math.inf, math.inf)
    assert block.growth_rate(np.linspace(3.0, 3.4, 101)).min() > 0
