"""Error estimates of two thousand systems of all kinds against multipliers known to the last bit."""

from functools import lru_cache

import numpy as np
import pytest

from facegear.floquet import error_estimates as module
from facegear.floquet.error_estimates import error_estimate, multiplier_errors
from facegear.floquet.free_modes import UnsuitableSystemError
from facegear.floquet.methods import AdaptiveMagnus, AlignedStepwise, Collocation, Magnus
from facegear.floquet.multipliers import multipliers, transition_matrix
from facegear.floquet.radau import Radau
from facegear.floquet.stepping import Family
from facegear.floquet.taylor import Taylor
from tests.independent import error_systems, exact_multipliers
from tests.independent.monodromy import integrated

STORED = error_systems.stored()
METHODS = (Magnus(128), AdaptiveMagnus(), Collocation(), Radau(), Taylor(), AlignedStepwise(128))


@pytest.fixture(autouse=True)
def _judged_once(monkeypatch):
    """Both estimates of a system come from the same refinements: computed once, they take half the time."""
    monkeypatch.setattr(module._Judged, "of", lru_cache(maxsize=2)(module._Judged.of))


def shares(kind, number, method):
    """Largest true error over its estimate, of the spectral radius and of any multiplier; none where refused."""
    checksum, truth = STORED[kind, number]
    system = error_systems.system_of(kind, number)
    assert error_systems.checksum(system) == checksum, "run python -m tests.independent.make_error_systems"
    try:
        found = multipliers(system, method)
        radius = abs(abs(found[0]) - abs(truth[0])) / error_estimate(system, method)
        errors = multiplier_errors(system, method)
    except (ArithmeticError, UnsuitableSystemError):
        return []  # said so itself
    each = np.abs(found[:, None] - truth[None, :]).min(axis=1) / errors
    return [float(radius), float(each.max())]


def held(kind, numbers):
    """Check the default method and another one on some systems of a kind."""
    answered = 0
    for number in numbers:
        other = METHODS[np.random.default_rng([3, number]).integers(len(METHODS))]
        for method in (None, other):
            found = shares(kind, number, method)
            answered += bool(found)
            assert max(found, default=0.0) < 10.0, (kind, number, method, found)
    assert answered > len(numbers)


@pytest.mark.parametrize("kind", error_systems.KINDS)
def test_no_error_passes_ten_times_its_estimate(kind):
    held(kind, range(4))


@pytest.mark.slow
@pytest.mark.takes(20)
@pytest.mark.parametrize("kind", error_systems.KINDS)
def test_no_error_of_two_thousand_systems_passes_ten_times_its_estimate(kind):
    held(kind, range(error_systems.EACH))


@pytest.mark.parametrize(("kind", "number"), [("kicked", 1), ("weighted", 2), ("border", 3), ("mixed", 4)])
def test_what_is_stored_is_what_is_computed(kind, number):
    system = error_systems.system_of(kind, number)
    checksum, truth = STORED[kind, number]
    assert error_systems.checksum(system) == checksum
    again = exact_multipliers.multipliers(system, bits=300)
    np.testing.assert_allclose(again, truth, rtol=1e-15, atol=1e-30)


def off_the_integrator(kind, number):
    system = error_systems.system_of(kind, number)
    exact = exact_multipliers.transition_matrix(system)
    scale = Family([system]).scale
    difference = np.abs(scale @ (exact - integrated(system)) @ np.linalg.inv(scale)).max()
    return difference / max(1.0, np.linalg.norm(scale @ exact @ np.linalg.inv(scale)))


@pytest.mark.parametrize("kind", ["kicked", "weighted"])
def test_the_exact_ones_against_an_integrator(kind):
    assert off_the_integrator(kind, 1) < 1e-11


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["jumping", "state_jumps", "kicked", "weighted", "mixed"])
def test_many_exact_ones_against_an_integrator(kind):
    assert max(off_the_integrator(kind, number) for number in range(3)) < 1e-11


def test_estimates_of_ordinary_systems_are_not_wild():
    """Half of them are less than ten thousand times the true error."""
    found = [shares("ordinary", number, method)[0] for number in range(20) for method in (None, Magnus(128))]
    assert np.median(found) > 1e-4


def test_exponentials_leave_nothing_out():
    """A constant system in few long steps: all of them, refined or not, leave out the same terms of the exponential."""
    system = error_systems.system_of("border", 4)
    exact = exact_multipliers.transition_matrix(system)
    assert np.abs(transition_matrix(system, Magnus(8)) - exact).max() < 2e-14


def test_jumps_that_are_taken_back_lose_digits_on_the_way():
    """A jump of 1e5 and its inverse half a period later: collocation knows the rest to 1e-3 only, and says so."""
    checksum, truth = STORED["undone", 113]
    system = error_systems.system_of("undone", 113)
    assert error_systems.checksum(system) == checksum
    error = abs(abs(multipliers(system, Collocation())[0]) - abs(truth[0]))
    assert error < 10.0 * error_estimate(system, Collocation())
