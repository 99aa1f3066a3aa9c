"""Arrays of chapter 2's figures: consistent with independent routes and with each other."""

from functools import cache

import numpy as np
import pytest

from compendium.datasets import stability as arrays
from facegear.floquet import multipliers as floquet
from facegear.maps.stability_map import stability_map
from facegear.mechanics import classical, classical_pairs
from tests.figures import check_round_trip
from tests.independent import classical as independent

GEARS = classical_pairs.GearPair(1.563, droop=0.4, shaft_damping=0.02).system(1.1)


def mathieu_chart(frequencies, depths):
    return arrays.chart(
        stability_map(classical.Mathieu(1.0), frequencies, "depth", depths, jobs=1), "Mathieu"
    )


@pytest.mark.parametrize(
    "dataset",
    [
        arrays.swing(0.3, np.linspace(1.4, 2.6, 5), [2.0, 1.5], cycles=2),
        arrays.transition_curves([0.0, 0.3], 2),
        arrays.meissner_borders([0.0, 0.3], 2, (0.3, 3.0)),
        mathieu_chart([1.5, 2.0], [0.0, 0.3]),
        arrays.damped_charts([1.5, 2.0], [0.0, 0.3], [0.0, 0.02]),
        arrays.duty_chart([1.5, 2.0], [0.3, 0.5], 0.4),
        arrays.bands(classical.Mathieu(1.0, 0.02), [0.05, 0.2], 3, "Mathieu"),
        arrays.hsu_errors([0.05, 0.1]),
    ],
    ids=lambda dataset: next(iter(dataset.data_vars)),
)
def test_every_figure_survives_the_round_trip_through_its_file(dataset, tmp_path):
    check_round_trip(dataset, tmp_path)


def test_multipliers_of_the_swing_are_reciprocal_and_the_motion_grows_by_the_larger():
    data = arrays.swing(0.3, np.linspace(1.4, 2.6, 13), [2.0, 1.5], cycles=8)
    pair = data.multiplier_real.values + 1j * data.multiplier_imag.values
    np.testing.assert_allclose(pair.prod(axis=1), 1.0, atol=1e-12)
    largest = np.abs(pair[np.argmin(np.abs(data.frequency.values - 2.0))]).max()
    growing, bounded = np.abs(data.motion.values)
    # The starting state is the growing direction but for a decaying part.
    assert growing[-41:].max() / growing[-81:-40].max() == pytest.approx(largest, rel=2e-2)
    assert bounded.max() < 3.0


@pytest.mark.parametrize("family", range(4))
def test_transition_curves_carry_the_trace_of_their_period(family):
    curves = arrays.transition_curves([0.4], 2)
    for number in (1, 2):
        frequency = float(curves.border[family, number - 1, 0])
        trace = np.trace(floquet.transition_matrix(classical.Mathieu(0.4).system(frequency)))
        assert trace == pytest.approx(2.0 if family < 2 else -2.0, abs=1e-9)


@cache
def meissner_borders():
    return arrays.meissner_borders([0.3, 0.7], 2, (0.3, 3.0)).border.values


@pytest.mark.parametrize("family", range(4))
def test_meissner_borders_agree_with_shooting(family):
    borders = meissner_borders()[family]
    expected = [
        [independent.meissner_border(family, number, depth) for depth in (0.3, 0.7)] for number in (1, 2)
    ]
    np.testing.assert_allclose(borders, expected, rtol=1e-12)


def test_chart_cells_are_growth_rates_of_single_systems():
    data = mathieu_chart([1.0, 2.0], [0.2, 0.6])
    for depth in (0.2, 0.6):
        rate = independent.growth_rate(independent.mathieu(2.0, depth))
        assert float(data.growth_rate.sel(depth=depth, frequency=2.0)) == pytest.approx(rate, abs=1e-9)


def test_damping_ratio_zero_is_the_undamped_chart():
    damped = arrays.damped_charts([1.0, 2.0], [0.2, 0.6], [0.0, 0.05])
    plain = mathieu_chart([1.0, 2.0], [0.2, 0.6])
    np.testing.assert_allclose(damped.growth_rate.values[0], plain.growth_rate.values, rtol=1e-12, atol=1e-12)
    assert (damped.growth_rate.values[1] < damped.growth_rate.values[0]).all()


def test_duty_chart_follows_the_closed_form():
    frequencies, duties = np.linspace(0.5, 2.5, 21), np.array([0.25, 0.5, 0.75])
    data = arrays.duty_chart(frequencies, duties, 0.4)
    trace = np.abs(classical.meissner_trace(frequencies, 0.4, duties[:, None]))
    expected = np.arccosh(np.maximum(trace / 2.0, 1.0)) * frequencies / (2.0 * np.pi)
    np.testing.assert_allclose(data.growth_rate.values, expected, atol=1e-6)


def test_bands_open_at_the_threshold_of_damping():
    data = arrays.bands(classical.Mathieu(1.0, 0.02), [0.07, 0.09, 0.3], 3, "Mathieu")
    assert data["label"].values.tolist() == ["(1+1)/1"]
    # ε = 4ϑ = 0.08.
    assert np.isnan(data.lower.values[0]).tolist() == [True, False, False]
    low, high = independent.hsu_single_damped(0.3, 0.02)
    np.testing.assert_allclose([data.lower.values[0, 2], data.upper.values[0, 2]], [low, high], rtol=1e-10)


@pytest.mark.parametrize("kind", ["sum", "difference"])
def test_bands_of_the_coupled_pair_follow_the_formula(kind):
    how = {"coupling": 0.8} if kind == "sum" else {"circulation": 0.8}
    data = arrays.bands(classical_pairs.CoupledPair(1.0, damping=0.02, **how), [0.4], 1, "pair")
    label = {"sum": "(1+2)/1", "difference": "(2-1)/1"}[kind]
    band = data["label"].values.tolist().index(label)
    expected = independent.hsu_pair(0.4, how.get("coupling", 0.0), how.get("circulation", 0.0), 0.02)
    found = [float(data[name][band, 0]) for name in ("centre", "lower", "upper")]
    np.testing.assert_allclose(found, expected, rtol=1e-10)


@pytest.mark.parametrize(
    "build", [arrays.transition_curves, lambda d, n: arrays.meissner_borders(d, n, (0.3, 3.0))]
)
def test_depths_with_negative_stiffness_are_refused(build):
    with pytest.raises(ValueError, match=r"depths must lie in \[0, 1\)"):
        build([0.5, 1.0], 1)
    with pytest.raises(ValueError, match="count must be at least 1"):
        build([0.5], 0)
