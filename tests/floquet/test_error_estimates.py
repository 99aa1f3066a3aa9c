"""Error estimates against multipliers known to forty digits: stiff, overdamped and drifting systems among them."""

import math
from dataclasses import dataclass

import numpy as np
import pytest

from facegear.floquet.error_estimates import error_estimate, multiplier_errors
from facegear.floquet.methods import AdaptiveMagnus, Magnus, Stepwise, with_method
from facegear.floquet.multiplier_curves import MultiplierCurve
from facegear.floquet.multipliers import multipliers
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.radau import Radau
from facegear.maps.stability_map import stability_map
from facegear.maps.tracing import tongues
from tests.independent import stiff_systems


def _suiting(system):
    """Return the method that is used for a system when none is named."""

    def used(method):
        multipliers(system, method)
        return method

    return with_method(None, used)


def worst_share(kind, seed, count):
    """Largest true error over its estimate, of the spectral radius and of any multiplier."""
    rng = np.random.default_rng([seed, stiff_systems.KINDS.index(kind)])
    shares = []
    for _ in range(count):
        system = stiff_systems.random_system(rng, kind)
        truth = stiff_systems.multipliers(system)
        for method in (_suiting(system), Magnus(200), Stepwise(200), AdaptiveMagnus(), Radau()):
            try:
                found = multipliers(system, method)
            except ArithmeticError:
                continue  # said so itself
            radius = abs(abs(found[0]) - abs(truth[0])) / error_estimate(system, method)
            each = np.abs(found[:, None] - truth[None, :]).min(axis=1) / multiplier_errors(system, method)
            shares.append(max(radius, float(each.max())))
    assert len(shares) > 4 * count
    return max(shares)


@pytest.mark.parametrize("kind", stiff_systems.KINDS)
def test_no_error_passes_ten_times_its_estimate(kind):
    assert worst_share(kind, 1, 8) < 10.0


@pytest.mark.slow
@pytest.mark.parametrize("kind", stiff_systems.KINDS)
def test_no_error_of_many_systems_passes_ten_times_its_estimate(kind):
    assert worst_share(kind, 2, 50) < 10.0


def test_a_stiff_damper_is_counted_along_the_directions_that_it_leaves_alone():
    """Two coordinates, and a damper of 2.4e5 along a direction between them, in matrices of rounded entries."""
    rng = np.random.default_rng([2, stiff_systems.KINDS.index("contact")])
    *_, system = (stiff_systems.random_system(rng, "contact") for _ in range(32))
    truth = stiff_systems.multipliers(system)
    errors = np.abs(multipliers(system, Radau())[:, None] - truth[None, :]).min(axis=1)
    assert errors[1] > 1e-12
    assert (errors < 5.0 * multiplier_errors(system, Radau())).all()


def test_a_stiff_damper_is_counted():
    """Q'' + c q' + q = 0, c = 1e8: the slow multiplier is exp(-T/c (1 + ...)), known to the rounding of c T only."""
    period, c = 2.0, 1e8
    system = PeriodicSystem(np.eye(1), [[c]], np.eye(1), (), period)
    truth = math.exp(-2.0 * period / (c + math.sqrt(c**2 - 4.0)))
    error = abs(abs(multipliers(system, Magnus(16))[0]) - truth)
    assert error > 1e-11
    assert error < 10.0 * error_estimate(system, Magnus(16))
    # Implicit panels do not lose it, and their estimate does not say so.
    assert abs(abs(multipliers(system, Radau())[0]) - truth) < error_estimate(system, Radau()) < 1e-13


def test_what_is_left_of_a_dead_motion_is_below_its_error():
    """Q'' + 50 q' + q = 0 over 100 s: multipliers exp(-2.0008) and exp(-4998), which no double holds."""
    system = PeriodicSystem(np.eye(1), [[50.0]], np.eye(1), (), 100.0)
    for method in (None, Radau()):
        slow, fast = np.abs(multipliers(system, method))
        errors = multiplier_errors(system, method)
        assert slow == pytest.approx(math.exp(-100.0 * (25.0 - math.sqrt(624.0))), rel=1e-10)
        assert slow > 1e9 * errors[0]
        assert fast < errors[1] < 1e-9


@dataclass(frozen=True)
class Damped:
    """One coordinate with a strong damper, over the frequency of nothing."""

    damping: float

    def system(self, speed):
        return PeriodicSystem(np.eye(1), [[self.damping]], np.eye(1), (), 2.0 * np.pi / speed)


def test_a_map_and_a_curve_count_rounding_too():
    values, speeds = np.array([3e6, 1e7]), np.array([1.0, 2.0])
    chart = stability_map(Damped(1.0), speeds, "damping", values, method=Magnus(16), jobs=1)
    truth = -2.0 / (values + np.sqrt(values**2 - 4.0))
    error = np.abs(
        np.exp(2 * np.pi / speeds * chart.values) - np.exp(np.outer(truth, 2 * np.pi / speeds))
    ).max()
    assert 1e-12 < error < 10.0 * chart.attrs["error_estimate"]
    curve = MultiplierCurve.of(Damped(1e7), 1.0, 2.0, Magnus(16))
    radii = curve.spectral_radii(np.array([1.3]))
    error = abs(radii[0] - np.exp(truth[1] * 2 * np.pi / 1.3))
    assert 1e-12 < error < 10.0 * curve.error


def test_dampers_too_strong_for_the_threshold_are_refused_with_a_way_out():
    with pytest.raises(
        ArithmeticError, match=r"known to .* only, rounding counted.*facegear\.floquet\.radau\.Radau"
    ):
        tongues(Damped(1e9), (1.0, 2.0), method=Magnus(16))
    assert tongues(Damped(1e7), (1.0, 2.0), method=Radau()) == ()
