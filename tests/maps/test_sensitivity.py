import math
from dataclasses import dataclass, replace

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import eigh_tridiagonal

from facegear.floquet.methods import Magnus
from facegear.floquet.models import replace_parameter
from facegear.floquet.multipliers import growth_rate, multipliers, transition_matrix
from facegear.floquet.periodic import PeriodicSystem
from facegear.geometry.drive import Drive
from facegear.maps.sensitivity import (
    _split,
    _varied,
    border_derivatives,
    parameter_value,
    sensitivity,
    system_derivative,
)
from facegear.maps.tracing import tongues
from facegear.mechanics.classical import Mathieu, Meissner
from facegear.mechanics.classical_pairs import CoupledPair
from facegear.mechanics.contact import Contact
from facegear.mechanics.gearboxes import FIGURES
from facegear.mechanics.plate import Body
from facegear.mechanics.properties import MeshLoad
from facegear.mechanics.transverse import Transverse
from facegear.support.parameters import rad_per_s

TURN = 2.0 * math.pi
BOX = (
    "pinion_inertia",
    "gear_inertia",
    "load_inertia",
    "mesh_stiffness",
    "mesh_damping",
    "input_stiffness",
    "input_damping",
    "output_stiffness",
    "output_damping",
)


@dataclass(frozen=True)
class Oscillator:
    """Nothing varies: multipliers are exp(λ T)."""

    frequency: float = 3.0
    damping_ratio: float = 0.1

    def system(self, speed):
        w = self.frequency
        return PeriodicSystem(np.eye(1), [[2.0 * self.damping_ratio * w]], [[w**2]], (), period=TURN / speed)


SWING = Mathieu(0.3, 0.02)


def torsional(**options):
    damped = replace_parameter(FIGURES["7.12a"].model(), "input_damping", 2e-6)
    return replace(damped, gearbox=damped.gearbox.in_si, **options)


def relative_orders(function, value, exact, steps=(0.02, 0.01, 0.005)):
    """Fitted order of central differences, and the error of the last one relative to the derivative."""
    errors = [
        abs((function(value * (1 + h)) - function(value * (1 - h))) / (2 * h * value) - exact) for h in steps
    ]
    return np.polyfit(np.log(steps), np.log(errors), 1)[0], errors[-1] / abs(exact)


def test_oscillator_has_the_closed_form():
    model, speed = Oscillator(), 2.2
    found = sensitivity(model, speed, ("frequency", "damping_ratio", "speed"))
    w, zeta, period = 3.0, 0.1, TURN / speed
    root = math.sqrt(1 - zeta**2)
    unit = -zeta + 1j * root
    if np.exp(w * unit * period).imag < 0:
        unit = unit.conjugate()
    alpha = np.exp(w * unit * period)
    side = math.copysign(1.0, unit.imag)
    exact = alpha * np.array(
        [unit * period, w * period * (-1 - 1j * side * zeta / root), -w * unit * period / speed]
    )
    assert found.multiplier == pytest.approx(alpha, abs=1e-11)
    np.testing.assert_allclose(found.multiplier_derivatives, exact, rtol=1e-9)
    # The growth rate −ζω does not know of the period.
    np.testing.assert_allclose(found.growth_rate_derivatives, [-zeta, -w, 0.0], atol=1e-9)


def test_meissner_has_the_closed_form():
    model, speed = Meissner(0.4, 0.3, 0.03), 2.0

    def largest(depth, zeta, frequency):
        period = 2 * mpmath.pi / frequency
        p, r = mpmath.sqrt(1 + depth - zeta**2), mpmath.sqrt(1 - depth - zeta**2)
        a, b = p * mpmath.mpf(0.3) * period, r * mpmath.mpf(0.7) * period
        trace = 2 * mpmath.cos(a) * mpmath.cos(b) - (p / r + r / p) * mpmath.sin(a) * mpmath.sin(b)
        trace *= mpmath.exp(-zeta * period)
        return (trace - mpmath.sqrt(trace**2 - 4 * mpmath.exp(-2 * zeta * period))) / 2

    at = (mpmath.mpf(0.4), mpmath.mpf(0.03), mpmath.mpf(2))
    exact = [float(mpmath.diff(largest, at, n)) for n in ((1, 0, 0), (0, 1, 0), (0, 0, 1))]
    found = sensitivity(model, speed, ("depth", "damping_ratio", "speed"))
    assert found.multiplier == pytest.approx(float(largest(*at)), abs=1e-12)
    np.testing.assert_allclose(found.multiplier_derivatives.real, exact, rtol=1e-9)


@pytest.mark.parametrize("name", BOX)
def test_torsional_derivatives_agree_with_central_differences_of_second_order(name):
    model, speed = torsional(), float(rad_per_s(640.0))
    found = sensitivity(model, speed, (name,))
    order, error = relative_orders(
        lambda x: growth_rate(replace_parameter(model, name, x).system(speed)),
        float(found.values[0]),
        float(found.growth_rate_derivatives[0]),
        (0.08, 0.04, 0.02),
    )
    assert order == pytest.approx(2.0, abs=0.1)
    assert error < 0.02


def test_matrix_of_the_derivative_agrees_with_the_change_of_the_matrix():
    model, speed = torsional(), float(rad_per_s(300.0))
    # Beside Φ in scaled coordinates its derivative by ln p, whose left eigenvectors a sensitivity takes.
    family, values = _varied(model, speed, ("mesh_stiffness",))
    back, scale = family.inverse_scale, family.scale
    matrix, change = (back @ part @ scale for part in _split(family, None))
    change = change[0] / values[0]
    np.testing.assert_allclose(matrix, transition_matrix(model.system(speed)), atol=1e-9 * abs(matrix).max())
    value = parameter_value(model, speed, "mesh_stiffness")
    sizes, errors = (0.02, 0.01, 0.005), []
    for h in sizes:
        up, down = (
            transition_matrix(replace_parameter(model, "mesh_stiffness", value * (1 + s * h)).system(speed))
            for s in (1, -1)
        )
        errors.append(np.abs((up - down) / (2 * h * value) - change).max() / np.abs(change).max())
    assert np.polyfit(np.log(sizes), np.log(errors), 1)[0] == pytest.approx(2.0, abs=0.05)


def test_gyroscopic_transverse_model_has_derivatives_too():
    body = Body(Drive(26, 130, 3.175e-3), 0.03, nodal_circles=0, nodal_diameters=1)
    model = Transverse(body, MeshLoad(1.0, 3e-6, 1.0))
    speed = float(rad_per_s(600.0))
    names = ("stiffness", "mass", "thickness_ratio", "speed")
    found = sensitivity(model, speed, names)
    for name, value, exact in zip(names, found.values, found.growth_rate_derivatives, strict=True):

        def growth(x, name=name):
            if name == "speed":
                return growth_rate(model.system(x))
            return growth_rate(replace_parameter(model, name, x).system(speed))

        order, error = relative_orders(growth, float(value), float(exact), (4e-3, 2e-3, 1e-3))
        assert order == pytest.approx(2.0, abs=0.3)
        assert error < 1e-2


@settings(max_examples=5, deadline=None, derandomize=True)
@given(speed_rpm=st.floats(400.0, 900.0), damping=st.floats(1e-6, 3e-5))
def test_units_of_mass_and_time_change_no_multiplier(speed_rpm, damping):
    """Euler's identities: all forces in proportion, and all times in proportion, leave multipliers alone."""
    model = replace_parameter(FIGURES["7.13a"].model(), "output_damping", damping)
    model = replace(model, gearbox=model.gearbox.in_si)
    found = sensitivity(model, float(rad_per_s(speed_rpm)), (*BOX, "speed"))
    by = dict(zip((*BOX, "speed"), found.logarithmic_derivatives * found.values, strict=True))
    size = max(map(abs, by.values()))
    assert abs(sum(by[name] for name in BOX)) < 1e-6 * size
    stiffness = sum(by[name] for name in BOX if name.endswith("stiffness"))
    damping = sum(by[name] for name in BOX if name.endswith("damping"))
    assert abs(by["speed"] + 2 * stiffness + damping) < 1e-6 * size


def test_width_of_a_tongue_moves_as_its_derivative_says():
    model = SWING
    (tongue,) = tongues(model, (1.5, 2.5))
    names = ("depth", "damping_ratio", "natural_frequency")
    upper, lower = (border_derivatives(model, at, names) for at in (tongue.upper, tongue.lower))
    found = upper - lower
    for name, exact in zip(names[:2], found[:2], strict=True):
        order, error = relative_orders(
            lambda x, name=name: tongues(replace_parameter(model, name, x), (1.5, 2.5))[0].width,
            getattr(model, name),
            float(exact),
            (0.08, 0.04, 0.02),
        )
        assert error < 2e-3
        assert order == pytest.approx(2.0, abs=0.1)
    # The width is in proportion to the natural frequency.
    assert found[2] == pytest.approx(tongue.width, rel=1e-8)


def test_borders_follow_the_characteristic_curves_as_damping_goes_to_zero():
    """da/dq of a₁ and b₁ from their tridiagonal eigenvectors; a border feels damping in second order."""
    depth = 0.3

    def characteristic(kind, q):
        diagonal = (2.0 * np.arange(30) + 1.0) ** 2
        diagonal[0] += q if kind == "a" else -q
        values, vectors = eigh_tridiagonal(diagonal, np.full(29, q), select="i", select_range=(0, 0))
        slope = 2.0 * vectors[:-1, 0] @ vectors[1:, 0] + (1 if kind == "a" else -1) * vectors[0, 0] ** 2
        return values[0], slope

    ratios, errors = (0.008, 0.004, 0.002), {0: [], 1: []}
    for zeta in ratios:
        model = Mathieu(depth, zeta)
        (tongue,) = tongues(model, (1.5, 2.5))
        for number, border in enumerate((tongue.lower, tongue.upper)):
            # (2/ω)² = a(q), q = ε a/2 (the sign of q is a shift by half a period): implicit differentiation.
            a = 4.0 / border**2
            kind = "a" if number == 0 else "b"
            for _ in range(60):
                a = characteristic(kind, depth * a / 2.0)[0]
            slope = characteristic(kind, depth * a / 2.0)[1]
            exact = -(a**-1.5) * slope * a / 2.0 / (1.0 - slope * depth / 2.0)
            found = border_derivatives(model, border, ("depth",))[0]
            errors[number].append(abs(found / exact - 1.0))
    for row in errors.values():
        assert np.polyfit(np.log(ratios), np.log(row), 1)[0] == pytest.approx(2.0, abs=0.1)
        assert row[-1] < 1e-3


def test_method_is_the_callers_choice():
    model = SWING
    coarse = sensitivity(model, 2.0, ("depth",), Magnus(8)).multiplier_derivatives
    fine = sensitivity(model, 2.0, ("depth",), Magnus(16)).multiplier_derivatives
    exact = sensitivity(model, 2.0, ("depth",)).multiplier_derivatives
    assert abs(coarse - exact) / abs(fine - exact) == pytest.approx(16.0, rel=0.1)


def test_derivative_of_a_system_is_exact_where_it_is_linear():
    model = torsional()
    found = system_derivative(model, 60.0, "output_stiffness")
    expected = np.array([[0.0, 0.0, 0.0], [0.0, 1.0, -1.0], [0.0, -1.0, 1.0]])
    np.testing.assert_allclose(found.stiffness, expected, atol=1e-12)
    assert not found.mass.any()
    assert not found.load_stiffness.any()
    assert system_derivative(model, 60.0, "speed").period == pytest.approx(-TURN / 107 / 60.0**2, rel=1e-12)


class TestRefusals:
    def test_two_pairs_of_one_modulus(self):
        with pytest.raises(ArithmeticError, match="no derivative"):
            sensitivity(CoupledPair(0.1, coupling=0.2), 1.3, ("depth",))

    def test_double_multiplier(self):
        # Half a turn a period: both multipliers of the undamped oscillator are -1.
        model = Oscillator(3.0, 0.0)
        np.testing.assert_allclose(multipliers(model.system(6.0)), -1.0, atol=1e-9)
        with pytest.raises(ArithmeticError, match="no derivative"):
            sensitivity(model, 6.0, ("frequency",))

    def test_parameter_without_scale(self):
        with pytest.raises(ValueError, match="damping_ratio is 0"):
            sensitivity(Mathieu(0.3, 0.0), 2.0, ("damping_ratio",))

    def test_parameter_that_moves_the_contact(self):
        with pytest.raises(ValueError, match="shape vectors of the loads depend on contact_ratio"):
            sensitivity(replace_parameter(torsional(), "contact_ratio", 1.5), 60.0, ("contact_ratio",))
        with pytest.raises(ValueError, match="contact_ratio is None"):
            sensitivity(torsional(), 60.0, ("contact_ratio",))

    def test_unknown_parameter(self):
        with pytest.raises(ValueError, match="parameter must be one of"):
            sensitivity(SWING, 2.0, ("stiffness",))

    def test_no_parameters(self):
        with pytest.raises(ValueError, match="number of parameters"):
            sensitivity(SWING, 2.0, ())

    def test_speed_that_is_no_border(self):
        with pytest.raises(ValueError, match="speed must be a border"):
            border_derivatives(SWING, 2.0, ("depth",))

    def test_rough_dependence(self):
        @dataclass(frozen=True)
        class Rough:
            damping: float = 0.1

            def system(self, speed):
                c = self.damping + (0.01 if self.damping > 0.1 else 0.0)
                return PeriodicSystem(np.eye(1), [[c]], np.eye(1), (), period=1.0)

        with pytest.raises(ArithmeticError, match="damping does not vary smoothly with damping"):
            sensitivity(Rough(), 2.0, ("damping",))

    def test_velocity_kicks(self):
        body = Body(Drive(26, 130, 3.175e-3), 0.03, nodal_circles=0, nodal_diameters=1)
        model = Transverse(body, MeshLoad(1.0, 3e-6, 1.0), contact=Contact(rate="total"))
        with pytest.raises(ValueError, match="velocity kicks"):
            sensitivity(model, 60.0, ("stiffness",))
