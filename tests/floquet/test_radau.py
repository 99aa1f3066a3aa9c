"""Radau collocation against closed forms, the adaptive Magnus method and an independent integrator."""

import math

import numpy as np
import pytest

from facegear.floquet import error_estimates, methods
from facegear.floquet import multipliers as floquet
from facegear.floquet.loads import ContactLoad
from facegear.floquet.models import replace_parameter
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.floquet.radau import Radau, _graded_edges, _rule
from facegear.floquet.stepping import Family
from facegear.mechanics.gearboxes import FIGURES
from facegear.support.parameters import rad_per_s
from tests.independent.torsional_switching import numbers_of, spectral_radius


@pytest.mark.parametrize("stages", [3, 8, 16, 24])
def test_rule_integrates_polynomials_up_to_its_order(stages):
    rule = _rule(stages)
    assert rule.nodes[-1] == 1.0
    for power in range(2 * stages - 1):
        assert rule.once[-1] @ rule.nodes**power == pytest.approx(1 / (power + 1), abs=1e-14)
    for power in range(stages):
        assert rule.once @ rule.nodes**power == pytest.approx(
            rule.nodes ** (power + 1) / (power + 1), abs=1e-13
        )


def test_three_stages_are_the_rule_of_the_book_and_two_are_refused():
    # Hairer and Wanner, table IV.5.6
    root = math.sqrt(6.0)
    assert _rule(3).nodes == pytest.approx([(4 - root) / 10, (4 + root) / 10, 1.0], rel=1e-14)
    assert _rule(3).once[-1] == pytest.approx([(16 - root) / 36, (16 + root) / 36, 1 / 9], rel=1e-13)
    with pytest.raises(ValueError, match="stages"):
        Radau(stages=2)
    with pytest.raises(ValueError, match="tolerance"):
        Radau(tolerance=1.0)


@pytest.mark.parametrize("damping", [0.0, 0.3, 2.0, 3e4])
def test_constant_system_against_the_exponential(damping):
    # q'' + c q' + 4 q = 0 over a period of 3 s, from hardly to extremely overdamped
    system = PeriodicSystem([[1.0]], [[damping]], [[4.0]], (), 3.0)
    roots = np.roots([1.0, damping, 4.0])
    expected = np.exp(roots * 3.0)
    found = floquet.multipliers(system, Radau())
    assert np.abs(found).max() == pytest.approx(np.abs(expected).max(), rel=1e-11)


@pytest.mark.parametrize(
    ("name", "value", "speed_rpm"),
    [("7.9a", 1.5, 1000.0), ("7.9b", 40.0, 950.0), ("7.11a", 1.0, 360.0), ("7.12b", 0.0, 300.0)],
)
def test_stiff_gearboxes_against_dop853(name, value, speed_rpm):
    figure = FIGURES[name]
    model = replace_parameter(figure.model(), figure.parameter, value)
    truth = spectral_radius(numbers_of(model), speed_rpm)
    system = model.system(rad_per_s(speed_rpm))
    assert np.abs(floquet.multipliers(system, Radau())[0]) == pytest.approx(truth, abs=1e-10)
    assert error_estimates.error_estimate(system, Radau()) < 1e-9


def test_family_agrees_with_magnus():
    model = FIGURES["7.13a"].model()
    systems = [model.system(rad_per_s(speed)) for speed in (120.0, 150.0, 400.0, 900.0)]
    one, other = (
        floquet.transition_matrices(systems, method) for method in (Radau(), methods.AdaptiveMagnus(1e-12))
    )
    for a, b in zip(one, other, strict=True):
        assert np.abs(a - b).max() <= 1e-9 * np.abs(b).max()


def test_error_falls_with_the_tolerance():
    system = FIGURES["7.12b"].model().system(rad_per_s(110.0))
    truth = np.abs(floquet.multipliers(system, Radau(24, 1e-14))[0])
    errors = [
        abs(np.abs(floquet.multipliers(system, Radau(6, tol))[0]) - truth) for tol in (1e-4, 1e-6, 1e-8)
    ]
    assert errors[0] > 10 * errors[1] > 100 * errors[2]


def test_velocity_kicks_go_between_panels():
    shape = PiecewiseChebyshev([0.0, 0.5], [[[0.5], [0.5]], [[0.5], [-0.5]]])
    system = PeriodicSystem([[1.0]], [[0.1]], [[4.0]], (ContactLoad(shape, mass=1.0, rate="total"),), 1.0)
    assert len(system.velocity_kicks()) == 2
    exact = floquet.transition_matrix(system, methods.AdaptiveMagnus(1e-12))
    np.testing.assert_allclose(floquet.transition_matrix(system, Radau()), exact, atol=1e-10)


@pytest.mark.parametrize("name", ["7.9a", "7.9b", "7.11a", "7.11b", "7.13a"])
def test_first_panels_suit_what_lives_on_after_a_breakpoint(name):
    # Motions a thousand times as fast as the mesh die after each breakpoint: no panel may be longer than they ask.
    figure = FIGURES[name]
    model = replace_parameter(figure.model(), figure.parameter, figure.lowest)
    family = Family([model.system(rad_per_s(figure.lowest_rpm * factor)) for factor in (1.0, 1.2)])
    edges = _graded_edges(family, 8.0, 25.0)
    assert set(family.breakpoints) <= set(edges)
    assert edges[-1] == 1.0
    assert (np.diff(edges) > 0).all()
    assert edges.size < 80
    coarse, fine = (rule.scaled_transition_matrices(family) for rule in (Radau(), Radau(24, 1e-14)))
    assert np.abs(coarse - fine).max() < 1e-11 * max(1.0, np.abs(fine).max())
