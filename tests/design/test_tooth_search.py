"""Matched filter over slots: closed forms for patterns that do not overlap, bounds, intervals."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.stats import binom, norm

from facegear.design.tooth_search import SlotFilter, share_interval, without_common

RNG = np.random.default_rng(5)
PATTERN = RNG.normal(size=(11, 7))


def test_exact_signals_are_found():
    search = SlotFilter(PATTERN)
    common = RNG.normal(size=7)
    signals = np.array([0.3 * np.roll(PATTERN, slot, axis=0) + common for slot in range(11)])
    slots, amounts = search.found(signals)
    assert slots.tolist() == list(range(11))
    np.testing.assert_allclose(amounts, 0.3, rtol=1e-12)


def test_projections_are_scalar_products():
    search = SlotFilter(PATTERN)
    signal = RNG.normal(size=(11, 7))
    rest = without_common(PATTERN)
    expected = [(signal * np.roll(rest, slot, axis=0)).sum() for slot in range(11)]
    np.testing.assert_allclose(search.projections(signal), expected, atol=1e-12)
    distances = [np.linalg.norm(rest - np.roll(rest, slot, axis=0)) for slot in range(1, 11)]
    np.testing.assert_allclose(search.distances, distances, rtol=1e-10)


def test_hit_rate_of_short_patterns_in_closed_form():
    """A pattern within one slot: N equal signals, of which the right one has the largest of N independent scores."""
    slots, size, deviation = 20, 1.0, 0.4
    short = np.zeros((slots, 4))
    short[0] = size / 2.0
    search = SlotFilter(short)
    # Taking the mean off moves all scores alike: the right one is ahead of the others by size/deviation.
    ahead = size / deviation
    truth = quad(lambda x: norm.pdf(x - ahead) * norm.cdf(x) ** (slots - 1), -10.0, 15.0)[0]
    low, high = search.hit_rate_bounds(deviation)
    assert low < truth < high
    trials = 4000
    noise = np.random.default_rng(1).normal(size=(trials, slots, 4))
    hits = int((search.found(np.roll(short, 13, axis=0) + deviation * noise)[0] == 13).sum())
    assert binom.ppf(0.0005, trials, truth) <= hits <= binom.ppf(0.9995, trials, truth)


def test_estimate_attains_the_bound():
    search, deviation = SlotFilter(PATTERN), 0.3
    noise = deviation * np.random.default_rng(2).normal(size=(3000, 11, 7))
    slots, amounts = search.found(np.roll(PATTERN, 4, axis=0) + noise)
    assert (slots == 4).all()
    bound = search.amount_deviation(deviation)
    assert amounts.std() == pytest.approx(bound, rel=4.0 / np.sqrt(2 * 3000))
    assert amounts.mean() == pytest.approx(1.0, abs=4.0 * bound / np.sqrt(3000))
    assert search.hit_rate_bounds(0.3)[0] > 0.999


def test_intervals_of_shares():
    low, high = share_interval(8, 10)
    # Wilson, from his formula.
    z = norm.ppf(0.975)
    middle, half = (0.8 + z**2 / 20) / (1 + z**2 / 10), z * np.sqrt(0.016 + z**2 / 400) / (1 + z**2 / 10)
    np.testing.assert_allclose([low, high], [middle - half, middle + half], rtol=1e-9)


def test_bad_input_names_the_parameter():
    with pytest.raises(ValueError, match="two slots or more"):
        SlotFilter(np.ones((1, 4)))
    with pytest.raises(ValueError, match="same in all slots"):
        SlotFilter(np.ones((3, 4)))
    with pytest.raises(ValueError, match="signals must have shape"):
        SlotFilter(PATTERN).found(np.zeros((7, 11)))
    with pytest.raises(ValueError, match="deviation"):
        SlotFilter(PATTERN).hit_rate_bounds(0.0)
    with pytest.raises(ValueError, match="hits must be an integer from 0 to 3, got 5"):
        share_interval(5, 3)


def test_one_signal_gives_plain_numbers():
    slot, amount = SlotFilter(PATTERN).found(np.roll(PATTERN, 4, axis=0))
    assert (type(slot), type(amount), slot) == (int, float, 4)
    # Where there is nothing the amount says so.
    assert abs(SlotFilter(PATTERN).found(np.zeros((11, 7)))[1]) < 1e-12
