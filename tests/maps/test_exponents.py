"""Derivatives of characteristic exponents: closed forms, and difference quotients by another method."""

import numpy as np
import pytest

from facegear.floquet.hill import exponents
from facegear.floquet.models import replace_parameter, value_of
from facegear.floquet.multipliers import transition_matrix
from facegear.maps.exponents import exponent_sensitivity
from facegear.maps.sensitivity import sensitivity
from facegear.mechanics.classical import Mathieu
from facegear.mechanics.gearboxes import FIGURES
from facegear.mechanics.torsional import Torsional
from facegear.support.parameters import rad_per_s

GEARBOX = Torsional(FIGURES["7.12b"].gearbox.in_si)
SPEED = float(rad_per_s(700.0))
NAMES = ("input_stiffness", "output_stiffness", "mesh_stiffness", "mesh_damping", "load_inertia")


def nearest(found, to):
    return np.array([found[np.abs(found - mu).argmin()] for mu in to])


def test_constant_system_in_closed_form():
    """Λ = −ϑω0 ± iω0 √(1 − ϑ²)."""
    model = Mathieu(depth=1e-12, damping_ratio=0.1, natural_frequency=1.5)
    found = exponent_sensitivity(model, 4.0, ["damping_ratio", "natural_frequency"])
    root = np.sqrt(1.0 - 0.01)
    np.testing.assert_allclose(found.exponents[0], 1.5 * (-0.1 + 1j * root), rtol=1e-10)
    np.testing.assert_allclose(
        found.derivatives[0], [1.5 * (-1.0 - 0.1j / root), -0.1 + 1j * root], rtol=1e-9
    )


def test_difference_quotients():
    """Richardson's extrapolation of central differences of exponents by contact-force collocation."""
    found = exponent_sensitivity(GEARBOX, SPEED, NAMES)
    for name, derivatives in zip(NAMES, found.derivatives.T, strict=True):
        value = value_of(GEARBOX, name)

        def quotient(step, name=name, value=value):
            ends = [
                nearest(
                    exponents(replace_parameter(GEARBOX, name, value * (1.0 + s)).system(SPEED)),
                    found.exponents,
                )
                for s in (-step, step)
            ]
            return (ends[1] - ends[0]) / (2.0 * step * value)

        expected = (4.0 * quotient(1e-3) - quotient(2e-3)) / 3.0
        assert np.abs(derivatives - expected).max() < 1e-6 * np.abs(expected).max()


def test_by_the_speed():
    found = exponent_sensitivity(GEARBOX, SPEED, ["speed"])
    step = 1e-4 * SPEED
    ends = [nearest(exponents(GEARBOX.system(SPEED + s)), found.exponents) for s in (-step, step)]
    expected = (ends[1] - ends[0]) / (2.0 * step)
    np.testing.assert_allclose(
        found.derivatives[:, 0], expected, rtol=1e-5, atol=1e-6 * np.abs(expected).max()
    )


def test_growth_rate_is_the_first_one():
    whole, critical = (f(GEARBOX, SPEED, NAMES) for f in (exponent_sensitivity, sensitivity))
    assert whole.exponents[0].real == pytest.approx(critical.growth_rate, rel=1e-10)
    np.testing.assert_allclose(whole.derivatives[0].real, critical.growth_rate_derivatives, rtol=1e-8)


def test_vectors_are_those_of_the_transition_matrix():
    found = exponent_sensitivity(GEARBOX, SPEED, NAMES)
    transition = transition_matrix(GEARBOX.system(SPEED))
    multipliers = np.exp(found.exponents * found.period)
    size = np.abs(transition @ found.right).max()
    assert np.abs(transition @ found.right - found.right * multipliers).max() < 1e-8 * size
    np.testing.assert_allclose(found.left @ found.right, np.eye(6), atol=1e-9)


def test_motions_are_told_apart_by_their_vectors():
    found = exponent_sensitivity(GEARBOX, SPEED, NAMES)
    changed = exponent_sensitivity(replace_parameter(GEARBOX, "input_stiffness", 1.1e6), SPEED, NAMES)
    assert found.numbers_in(found) == list(range(6))
    numbers = found.numbers_in(changed)
    assert sorted(numbers) == list(range(6))
    # The decay of each motion hardly changes with the stiffness.
    np.testing.assert_allclose(changed.exponents[numbers].real, found.exponents.real, rtol=0.2)
    assert found.oscillating == [0, 2, 4]


def test_refused():
    with pytest.raises(ArithmeticError, match="lost in the rounding"):
        exponent_sensitivity(Torsional(FIGURES["7.10a"].gearbox.in_si), 30.0, ["input_stiffness"])
    with pytest.raises(ArithmeticError, match="double"):
        # Half the period of free vibration: both multipliers are −1.
        exponent_sensitivity(Mathieu(depth=1e-14), 2.0, ["natural_frequency"])
    with pytest.raises(ValueError, match="parameter must be one of"):
        exponent_sensitivity(GEARBOX, SPEED, ["stifness"])
    with pytest.raises(ValueError, match="number of parameters"):
        exponent_sensitivity(GEARBOX, SPEED, [])
