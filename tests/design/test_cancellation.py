"""What silences a tongue: closed forms, their limits, and Floquet theory as the judge."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from facegear.design.cancellation import (
    Wave,
    WavePair,
    interference,
    loud_wave_numbers,
    mode_content,
    phasing_sum,
    pinion_couplings,
    tongue_of,
    weakened,
)
from facegear.geometry.phases import phase_split
from facegear.mechanics.cases import EXAMPLE_B
from facegear.mechanics.contact import Contact
from facegear.mechanics.disk import disk_matrices
from facegear.support.parameters import rad_per_s

DRIVE = EXAMPLE_B.body.drive
PAIR = WavePair(Wave(0, 2), Wave(1, 0))


def placed(*angles_deg, **changes):
    return replace(EXAMPLE_B, pinion_angles=tuple(np.radians(angles_deg)), **changes)


@settings(deadline=None, derandomize=True)
@given(
    angles=st.lists(st.floats(0.0, 6.2), min_size=1, max_size=6),
    number=st.integers(-6, 6),
    order=st.integers(1, 3),
)
def test_sum_over_positions_and_phases_is_that_over_a_gear_of_other_teeth(angles, number, order):
    phases = phase_split(DRIVE, angles).phase
    expected = np.exp(1j * (2 * np.pi * order * phases + number * np.array(angles))).sum()
    assert phasing_sum(DRIVE.gear_teeth, angles, number, order) == pytest.approx(expected, abs=1e-6)


@pytest.mark.parametrize("pinions", [2, 3, 4, 5, 6])
@pytest.mark.parametrize("teeth", [155, 156])
def test_equally_spaced_pinions_are_all_or_nothing(pinions, teeth):
    angles = 2 * np.pi * np.arange(pinions) / pinions
    loud = loud_wave_numbers(teeth, pinions, 6)
    for number in range(-6, 7):
        expected = pinions if number in loud else 0.0
        assert abs(phasing_sum(teeth, angles, number)) == pytest.approx(expected, abs=1e-11)


@pytest.mark.parametrize("number", [-4, 0, 3, 7])
def test_silent_angles_are_silent(number):
    for k in range(20):
        assert abs(phasing_sum(155, [0.0, (2 * k + 1) * math.pi / (155 + number)], number)) < 1e-11


def test_a_pair_is_in_resonance_at_its_speed():
    speed = PAIR.speed(EXAMPLE_B)
    _, stiffness = disk_matrices(EXAMPLE_B.body, 0.0)
    rest = np.sqrt(np.diag(stiffness))
    frequencies = EXAMPLE_B.body.natural_frequencies_hz() * 2 * np.pi
    assert frequencies[0, 2] == pytest.approx(rest[6])
    # In the disk's own frame the frequencies are those at rest but for the centrifugal stress.
    assert (155 - 2) * speed == pytest.approx(frequencies[0, 2] + frequencies[1, 0], rel=2e-3)


@pytest.mark.parametrize("travel", ["printed", "with_disk"])
def test_weak_tongues_grow_in_proportion_to_the_sum(travel):
    """First-order error: a quarter of the load leaves about a quarter of it."""
    errors = []
    for factor in (0.02, 0.005):
        tongues = []
        for angles in ((0.0,), (0.0, 80.0, 178.1)):
            model = weakened(placed(*angles, contact=Contact(travel=travel)), factor)
            tongues.append(tongue_of(model, PAIR, 0.04 * factor * len(angles), 0.005 * factor * len(angles)))
        one, three = tongues
        expected = abs(PAIR.phasing_sum(placed(0.0, 80.0, 178.1, contact=Contact(travel=travel))))
        errors.append(abs(three.growth_rate / one.growth_rate - expected))
    assert errors[1] < 0.02
    assert 0.6 < math.log(errors[0] / errors[1]) / math.log(4) < 1.6


def test_silenced_tongue_is_gone_and_the_opposite_sign_would_not_silence_it():
    angle = 75 * math.pi / (155 + PAIR.wave_number)
    model = replace(EXAMPLE_B, pinion_angles=(0.0, angle))
    factor = 0.005
    alone = tongue_of(weakened(EXAMPLE_B, factor), PAIR, 0.04 * factor, 0.005 * factor)
    both = tongue_of(weakened(model, factor), PAIR, 0.08 * factor, 0.01 * factor)
    assert both is None or both.growth_rate < 0.02 * alone.growth_rate
    assert abs(phasing_sum(155, [0.0, angle], -PAIR.wave_number)) > 0.1


def test_opposite_pinions_follow_parity():
    """At 180° of an even number of teeth symmetry is exact but for the spin of the disk."""
    model = placed(0.0, 78.5 * math.degrees(DRIVE.angular_pitch))
    system = model.system(float(rad_per_s(197.0)))
    assert interference(system, 1, 2) > 0.99
    assert interference(system, 1, 1) < 0.03
    assert interference(system, 2, 2) < 0.03


def test_couplings_of_equal_pinions_in_step_are_equal():
    model = placed(0.0, 180.0)
    # In step: both at phase 0 of a gear with an even number of teeth.
    even = replace(model.body, drive=replace(DRIVE, pinion_teeth=32, gear_teeth=160))
    parts = pinion_couplings(replace(model, body=even).system(float(rad_per_s(180.0))), 1, 1)
    np.testing.assert_allclose(np.abs(parts[0]), np.abs(parts[1]), rtol=1e-9)


def test_content_of_modes_is_whole():
    content = mode_content(placed(0.0, 120.0), float(rad_per_s(800.0)), 1)
    assert sum(content.values()) == pytest.approx(1.0)
    assert max(content, key=content.get) == (0, 1)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: phasing_sum(155, [], 0), "pinion_angles"),
        (lambda: phasing_sum(155, [0.0], 0.5), "whole"),
        (lambda: phasing_sum(0, [0.0], 0), "gear_teeth"),
        (lambda: phasing_sum(155, [0.0], 0, 0), "order"),
        (lambda: loud_wave_numbers(155, 0, 6), "pinions"),
        (lambda: weakened(EXAMPLE_B, 0.0), "factor"),
        (lambda: WavePair(Wave(5, 0), Wave(0, 0)).speed(EXAMPLE_B), "waves of the disk"),
        (lambda: WavePair(Wave(0, 0), Wave(1, 0), "difference").speed(EXAMPLE_B), "no speed"),
        (lambda: mode_content(EXAMPLE_B, 50.0, 15), "mode"),
        (lambda: interference(EXAMPLE_B.system(50.0), 1, 15), "j must be"),
        (
            lambda: interference(replace(EXAMPLE_B, contact=Contact(rate="total")).system(50.0), 1, 1),
            "frozen",
        ),
    ],
)
def test_wrong_arguments_are_named(call, message):
    with pytest.raises(ValueError, match=message):
        call()
