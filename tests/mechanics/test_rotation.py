"""Pinions turned about the axis: exact, for any number of them, and refused where it would not be."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from facegear.floquet.multipliers import growth_rate
from facegear.mechanics.cases import EXAMPLE_A, EXAMPLE_B
from facegear.mechanics.contact import Contact
from facegear.mechanics.edge_stiffness import DrivingForce
from facegear.mechanics.rotation import DiskWaves, TurnedPinions, growth_rates_at_angles
from facegear.support.parameters import rad_per_s

SPEED = float(rad_per_s(868.0))
# Growth rates from spectral radii good to 1e-9 over a mesh period.
TOLERANCE = 3e-6


def one_by_one(model, speed, angles):
    return [growth_rate(replace(model, pinion_angles=tuple(row)).system(speed)) for row in angles]


@pytest.mark.parametrize("travel", ["printed", "with_disk"])
@pytest.mark.parametrize(
    "angles", [[[0.0]], [[0.0, 1.7], [0.3, 3.1]], [[0.0, 2.0, 4.1]], [[0.0, 1.2, 3.2, 4.4]]], ids=len
)
def test_turned_pinions_are_the_model_with_these_angles(angles, travel):
    model = replace(EXAMPLE_B, contact=Contact(travel=travel))
    found = growth_rates_at_angles(model, SPEED, angles)
    np.testing.assert_allclose(found, one_by_one(model, SPEED, angles), atol=TOLERANCE)


@settings(deadline=None, derandomize=True, max_examples=10)
@given(
    speed_rpm=st.floats(60.0, 1000.0),
    teeth=st.integers(20, 110),
    part=st.floats(0.0, 0.999),
    common=st.floats(0.0, 1.0),
)
def test_two_pinions_at_any_speed_and_angle(speed_rpm, teeth, part, common):
    speed = float(rad_per_s(speed_rpm))
    angle = (teeth + part) * EXAMPLE_A.body.drive.angular_pitch
    # Turning both, phases and all, by whole teeth is looking from elsewhere; exchanging them is, too.
    whole = round(common * 10) * EXAMPLE_A.body.drive.angular_pitch
    found = growth_rates_at_angles(EXAMPLE_A, speed, [[0.0, angle], [whole, whole + angle], [0.0, -angle]])
    np.testing.assert_allclose(found, one_by_one(EXAMPLE_A, speed, [[0.0, angle]]) * 3, atol=TOLERANCE)


def test_waves_of_the_disk_have_the_frequencies_of_its_modes():
    system = EXAMPLE_B.system(SPEED)
    waves = DiskWaves.of(EXAMPLE_B, system)
    for n in (1, 2, 3):
        against, along = (np.sort(waves.eigenvalues.imag[waves.waves == sign * n]) for sign in (-1, 1))
        # Seen from a fixed point, a wave that runs with the disk is faster by 2nΩ than its mirror image.
        np.testing.assert_allclose(along - against, 2 * n * SPEED, rtol=1e-6)
    assert np.count_nonzero(waves.waves == 0) == 2


def test_many_angles_at_once_are_the_same_as_few():
    angles = np.stack([np.zeros(40), np.linspace(1.0, 2.0, 40)], axis=1)
    pinions = TurnedPinions(EXAMPLE_B, SPEED, [0.0, 0.3])
    together = pinions.transition_matrices(angles)
    np.testing.assert_allclose(together[-1:], pinions.transition_matrices(angles[-1:]), atol=1e-12)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"contact": Contact(rate="total")}, "rate"),
        ({"force": DrivingForce(1e5, 100.0)}, "model"),
    ],
)
def test_models_it_does_not_suit_are_refused(change, message):
    with pytest.raises(ValueError, match=message):
        growth_rates_at_angles(replace(EXAMPLE_B, **change), SPEED, [[0.0, 1.0]])


@pytest.mark.parametrize(
    ("angles", "message"),
    [
        ([0.0, 1.0], "sets"),
        ([[0.0, float("nan")]], "finite"),
        ([[0.0, 1.0, 2 * np.pi]], "differ"),
        (np.empty((0, 2)), "sets"),
    ],
)
def test_angles_that_are_none_are_refused(angles, message):
    with pytest.raises(ValueError, match=message):
        growth_rates_at_angles(EXAMPLE_B, SPEED, angles)


def test_other_arguments_are_checked():
    with pytest.raises(ValueError, match="phases"):
        TurnedPinions(EXAMPLE_B, SPEED, [])
    with pytest.raises(ValueError, match="shape"):
        TurnedPinions(EXAMPLE_B, SPEED, [0.0, 0.1]).transition_matrices([[0.0]])
    with pytest.raises(ValueError, match="speed"):
        growth_rates_at_angles(EXAMPLE_B, 0.0, [[0.0, 1.0]])
