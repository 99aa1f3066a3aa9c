"""Critical power of the disk alone, and the largest power of a speed range."""

import math
from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg

from facegear.design.envelope import critical_power, disk_growth_rate, largest_power, mode_critical_powers
from facegear.floquet.models import replace_parameter
from facegear.floquet.multipliers import growth_rate
from facegear.maps.tracing import tongues
from facegear.mechanics.cases import CASE_1, CASE_2, FIGURES
from facegear.mechanics.contact import Contact
from facegear.mechanics.edge_stiffness import DrivingForce
from facegear.mechanics.properties import MeshLoad
from facegear.mechanics.transverse import Transverse
from facegear.support.parameters import rad_per_s, watt

SPEED = float(rad_per_s(5000.0))


@pytest.mark.parametrize("body", [CASE_1, CASE_2])
def test_first_order_formula_against_eigenvalues(body):
    first = mode_critical_powers(body, SPEED).min()
    for speed in (0.0, 50.0, 104.7):
        found = critical_power(body, SPEED, speed)
        assert found == pytest.approx(first, rel=0.01)
        assert (
            disk_growth_rate(body, DrivingForce(0.999 * found, SPEED), speed)
            < 0
            < disk_growth_rate(body, DrivingForce(1.001 * found, SPEED), speed)
        )


def test_growth_rate_is_feeding_less_loss():
    """At half the critical power of its mode, the wave (0, 1) grows at half of what it loses."""
    powers = mode_critical_powers(CASE_1, SPEED)
    loss = CASE_1.material.viscous_loss_factor * CASE_1.eigenvalues[0, 1] / 2
    found = disk_growth_rate(CASE_1, DrivingForce(0.5 * powers[0, 1], SPEED), 0.0)
    # Second order in the force is some percent of the loss.
    assert found == pytest.approx(-loss / 2, rel=0.05)


def test_loss_and_frequency_set_the_critical_power():
    powers = mode_critical_powers(CASE_1, SPEED)
    assert np.all(np.isinf(powers[:, 0]))
    tougher = replace(CASE_1, material=replace(CASE_1.material, viscous_loss_factor=1e-5))
    np.testing.assert_allclose(mode_critical_powers(tougher, SPEED)[:, 1:], 2 * powers[:, 1:], rtol=1e-12)
    # ω³h is proportional to h⁴
    thicker = replace(CASE_1, thickness_ratio=0.06)
    np.testing.assert_allclose(mode_critical_powers(thicker, SPEED)[:, 1:], 16 * powers[:, 1:], rtol=1e-9)


def test_a_dead_force_does_not_feed_the_disk():
    follower = critical_power(CASE_1, SPEED, 50.0)
    assert critical_power(CASE_1, SPEED, 50.0, following="dead") > 20 * follower
    lossless = replace(CASE_1, material=replace(CASE_1.material, viscous_loss_factor=0.0))
    assert disk_growth_rate(lossless, DrivingForce(float(watt(300.0)), SPEED, "dead"), 50.0) < 1e-6
    with pytest.raises(ValueError, match="viscous_loss_factor"):
        critical_power(lossless, SPEED, 50.0)


def test_powers_up_to_that_of_the_drive_are_tried_in_any_case():
    """A thin disk: the dead force makes it unstable at more than 100 times what the follower needs."""
    body = replace(CASE_1, thickness_ratio=0.008)
    follower = critical_power(body, SPEED, 100.0)
    assert critical_power(body, SPEED, 100.0, following="dead") == math.inf
    found = critical_power(body, SPEED, 100.0, following="dead", highest_power=1e4 * follower)
    assert found > 100 * follower
    model = Transverse(body, MeshLoad(0.0, 0.0, 0.0), force=DrivingForce(found, SPEED, "dead"))
    for share, unstable in ((0.99, False), (1.01, True)):
        system = replace_parameter(model, "power", share * found).system(100.0)
        zero, one = np.zeros((system.size, system.size)), np.eye(system.size)
        left = np.block([[zero, one], [-system.stiffness, -system.damping]])
        right = np.block([[one, zero], [zero, system.mass]])
        growth = float(scipy.linalg.eigvals(left, right).real.max())
        assert (growth > 0.0) == unstable


RANGE = (float(rad_per_s(930.0)), float(rad_per_s(1000.0)))


def model_of(stiffness, name="4.5a"):
    figure = FIGURES[name]
    slow = figure.body.drive.geometric_contact_ratio
    model = figure.model(force=DrivingForce(0.0, SPEED), contact=Contact(contact_ratio=slow))
    return replace_parameter(model, "stiffness", stiffness)


@pytest.mark.slow
def test_largest_power_separates_stable_from_unstable():
    model = model_of(0.5)
    limit = largest_power(model, RANGE)
    assert RANGE[0] <= limit.speed <= RANGE[1] * (1 + 1e-12)
    assert limit.label
    above = replace_parameter(model, "power", 1.01 * limit.power)
    assert growth_rate(above.system(limit.speed)) > 0
    assert tongues(replace_parameter(model, "power", 0.995 * limit.power), RANGE) == ()
    # A narrower range bears at least as much.
    assert largest_power(model, (RANGE[0], 0.96 * RANGE[1])).power >= limit.power * (1 - 2e-3)


def test_a_range_that_is_never_stable_bears_nothing():
    tregold = FIGURES["4.4a"].model(force=DrivingForce(0.0, SPEED))
    limit = largest_power(tregold, (float(rad_per_s(530.0)), float(rad_per_s(540.0))))
    assert limit.power == 0.0
    assert limit.label.endswith("/1")


@pytest.mark.slow
def test_damped_bearings_have_no_limit_within_the_levels():
    model = replace_parameter(model_of(1.0, "4.4a"), "damping", 5e-5)
    limit = largest_power(model, (RANGE[0], 1.01 * RANGE[0]))
    assert limit.power == math.inf
    assert math.isnan(limit.speed)
    assert limit.label == ""


def test_bad_input_is_named():
    with pytest.raises(ValueError, match="force of the model"):
        largest_power(FIGURES["4.4a"].model(), RANGE)
    with pytest.raises(ValueError, match="tolerance must lie"):
        largest_power(model_of(0.5), RANGE, tolerance=0.5)
    with pytest.raises(ValueError, match="speeds must ascend"):
        largest_power(model_of(0.5), (100.0, 50.0))
    with pytest.raises(ValueError, match="pinion_speed must be greater"):
        mode_critical_powers(CASE_1, 0.0)


@pytest.mark.parametrize("following", ["follower", "dead"])
def test_without_nodal_diameters_no_power_makes_the_disk_flutter(following):
    body = replace(CASE_1, nodal_diameters=0)
    assert critical_power(body, SPEED, 50.0, following=following) == math.inf
    # The eigenvalues say so as well: the force does not enter at all.
    quiet, loud = (
        disk_growth_rate(body, DrivingForce(power, SPEED, following), 50.0) for power in (0.0, 1e12)
    )
    assert quiet < 0
    assert loud == pytest.approx(quiet, rel=1e-9)


def test_without_nodal_diameters_no_power_is_the_largest():
    load = FIGURES["4.4a"].load
    model = Transverse(replace(CASE_1, nodal_diameters=0), load, force=DrivingForce(1e5, SPEED))
    found = largest_power(model, (90.0, 100.0))
    assert (found.power, found.label) == (math.inf, "")
