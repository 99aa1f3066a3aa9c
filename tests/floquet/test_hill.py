"""Hill's matrix: closed forms, orders of convergence, sorting and the way without it."""

import numpy as np
import pytest

from facegear.floquet.hill import (
    apart,
    by_mean_harmonic,
    exponents,
    hill_matrix,
    hill_spectrum,
    in_base_strip,
    logarithms,
    without_sorting,
)
from facegear.floquet.loads import ContactLoad, StateJump
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.mechanics.classical import Hill, Mathieu, square_wave
from facegear.mechanics.gearboxes import FIGURES
from facegear.support.parameters import rad_per_s
from tests.independent.monodromy import fitted_order, integrated

TENT = PiecewiseChebyshev.fit(lambda x, piece: 1.0 - 4.0 * np.abs(x - 0.5), [0.0, 0.5])
BUMP = PiecewiseChebyshev.fit(lambda x, piece: 1.5 - 2.0 * np.abs(x - 0.5), [0.0, 0.5])
GATE = PiecewiseChebyshev(np.array([0.0, 0.37]), np.array([1.0, 0.0])[:, None, None])
ONE = PiecewiseChebyshev.constant([1.0])
FREQUENCY = 1.3
PERIOD = 2.0 * np.pi / FREQUENCY


def oscillator(*loads, jumps=()):
    return PeriodicSystem([[1.0]], [[0.02]], [[1.0]], loads, PERIOD, jumps=jumps)


SYSTEMS = {
    "smooth": Mathieu(depth=0.4, damping_ratio=0.02).system(FREQUENCY),
    "kinked": Hill(0.4, TENT, 0.02).system(FREQUENCY),
    "jumping stiffness": Hill(0.4, square_wave(0.37), 0.02).system(FREQUENCY),
    "jumping damping": oscillator(ContactLoad(ONE, damping=0.3, weight=GATE)),
    "kicked": oscillator(ContactLoad(BUMP, mass=0.3, rate="total")),
}


def errors(system, harmonics, route):
    truth = exponents(system)
    return np.array([apart(route(system, int(h)), truth, system.period).max() for h in harmonics])


def by_strip(system, harmonics):
    return in_base_strip(hill_spectrum(system, harmonics))


def by_harmonic(system, harmonics):
    return by_mean_harmonic(hill_spectrum(system, harmonics))


@pytest.mark.parametrize("name", SYSTEMS)
def test_exponents_are_those_of_another_integrator(name):
    system = SYSTEMS[name]
    truth = np.log(np.linalg.eigvals(integrated(system)).astype(complex)) / system.period
    assert apart(exponents(system), truth, system.period).max() < 1e-10


def test_square_wave_in_closed_form():
    """Meissner: cos ΛT from two pieces of constant stiffness, without damping."""
    system = Hill(0.4, square_wave(0.37)).system(FREQUENCY)
    fast, slow = np.sqrt(1.4), np.sqrt(0.6)
    a, b = fast * 0.37 * PERIOD, slow * 0.63 * PERIOD
    half = np.cos(a) * np.cos(b) - (fast / slow + slow / fast) / 2.0 * np.sin(a) * np.sin(b)
    truth = 1j * np.arccos(half) / PERIOD * np.array([1.0, -1.0])
    assert apart(exponents(system), truth, PERIOD).max() < 1e-12
    assert apart(by_harmonic(system, 40), truth, PERIOD).max() < 1e-6


@pytest.mark.parametrize("route", [by_strip, by_harmonic])
def test_smooth_systems_converge_exponentially(route):
    found = errors(SYSTEMS["smooth"], (2, 3, 4), route)
    assert (found[1:] < 1e-2 * found[:-1]).all()
    assert errors(SYSTEMS["smooth"], [6], route) < 1e-13


@pytest.mark.parametrize(
    ("name", "order", "spread"),
    [
        ("kinked", -5.0, 0.2),
        ("jumping stiffness", -3.0, 0.15),
        ("jumping damping", -3.0, 0.35),
        ("kicked", -1.0, 0.05),
    ],
)
def test_orders(name, order, spread):
    """One order more or less would show: errors of jumps swing by some tens of percent with H about their order."""
    harmonics = np.array([12, 15, 19, 24, 30, 38, 48])
    assert fitted_order(harmonics, errors(SYSTEMS[name], harmonics, by_harmonic)) == pytest.approx(
        order, abs=spread
    )


def test_without_sorting():
    found = errors(SYSTEMS["smooth"], (3, 5, 7), without_sorting)
    assert (found[1:] < 1e-2 * found[:-1]).all()
    harmonics = np.array([12, 19, 30, 48])
    for name in ("kinked", "jumping stiffness", "kicked"):
        found = errors(SYSTEMS[name], harmonics, without_sorting)
        assert found[-1] < 0.5 * found[0]
        assert found[-1] < 1e-4


def test_on_the_edge_of_the_strip_sorting_fails_and_doing_without_does_not():
    """In the tongue at twice the natural frequency both exponents have the imaginary part π/T0, and two images."""
    system = Mathieu(depth=0.4, damping_ratio=0.02).system(2.0)
    truth = exponents(system)
    np.testing.assert_allclose(np.abs(truth.imag), np.pi / system.period)
    spectrum = hill_spectrum(system, 12)
    near = np.sort(np.abs(spectrum.exponents.imag))[:4]
    np.testing.assert_allclose(near, np.pi / system.period, rtol=1e-9)
    assert apart(spectrum.exponents, truth, system.period).max() < 1e-12
    assert apart(without_sorting(system, 12), truth, system.period).max() < 1e-12


def test_harmonics_that_do_not_reach_the_strip_are_refused():
    """A motion of frequency 1 under a stiffness of frequency 0.02: 50 harmonics from itself to the strip."""
    slow = Mathieu(depth=0.2, damping_ratio=0.1).system(0.02)
    with pytest.raises(
        ArithmeticError, match="10 harmonics do not bring all exponents into the strip"
    ) as told:
        in_base_strip(hill_spectrum(slow, 10))
    needed = int(str(told.value).split("takes at least ")[1].split(",")[0])
    assert 50 <= needed <= 55
    found = in_base_strip(hill_spectrum(slow, 70))
    assert apart(found, exponents(slow), slow.period).max() < 1e-9
    assert np.abs(found.imag).max() < 0.01
    # These need no strip.
    spectrum = hill_spectrum(slow, 20)
    assert apart(by_mean_harmonic(spectrum), exponents(slow), slow.period).max() < 1e-5
    assert apart(without_sorting(slow, 20), exponents(slow), slow.period).max() < 1e-5


@pytest.mark.filterwarnings("error")
def test_a_multiplier_of_zero_has_an_exponent_of_minus_infinity():
    # Whether what has died within a period is 0 or rounding differs from machine to machine.
    slow, dead = logarithms(np.array([0.0, 0.5]), 0.3)
    assert slow == pytest.approx(np.log(0.5) / 0.3)
    assert (dead.real, dead.imag) == (-np.inf, 0.0)
    found = exponents(PeriodicSystem([[1.0]], [[1e4]], [[1.0]], (), period=1.0))
    assert not np.isnan(found).any()
    assert found[0] == pytest.approx(-1e-4, rel=1e-4)
    np.testing.assert_allclose(
        logarithms(np.array([-1.0, 1j]), 2.0), [0.5j * np.pi, 0.25j * np.pi], atol=1e-15
    )


def test_mean_harmonics_number_the_images():
    spectrum = hill_spectrum(SYSTEMS["smooth"], 8)
    turn = 2.0 * np.pi / PERIOD
    first = by_mean_harmonic(spectrum)[0]
    middle = int(np.abs(spectrum.exponents - first).argmin())
    image = int(np.abs(spectrum.exponents - first - 3j * turn).argmin())
    # e^{Λt} p(t) is the same motion with the factor e^{−3iωt} put into p.
    assert spectrum.mean_harmonics[image] == pytest.approx(spectrum.mean_harmonics[middle] - 3.0, abs=1e-6)


def test_gearbox():
    system = FIGURES["7.12b"].model().system(float(rad_per_s(700.0)))
    coarse, fine = (errors(system, [h], by_harmonic)[0] for h in (8, 16))
    assert fine < coarse / 4.0
    assert fine < 1e-3 * 2.0 * np.pi / system.period


def test_constant_coefficients_are_exact():
    system = oscillator()
    truth = np.roots([1.0, 0.02, 1.0])
    assert apart(by_harmonic(system, 1), truth, PERIOD).max() < 1e-13


def test_bad_input_names_the_parameter():
    with pytest.raises(ValueError, match="harmonics"):
        hill_matrix(SYSTEMS["smooth"], 0)
    with pytest.raises(TypeError, match="harmonics"):
        hill_matrix(SYSTEMS["smooth"], 2.5)
    with pytest.raises(TypeError, match=r"model\.system\(speed\)"):
        hill_matrix(Mathieu(depth=0.1), 3)
    with pytest.raises(ValueError, match="jumps of the state"):
        without_sorting(oscillator(jumps=(StateJump(0.3, 0.5 * np.eye(2)),)), 3)
    one = np.array([1j])
    with pytest.raises(ValueError, match="period must be greater than 0"):
        apart(one, one, 0.0)
    with pytest.raises(ValueError, match="found must be a list of one exponent or more"):
        apart(np.array([]), one, 1.0)
    with pytest.raises(ValueError, match="truth must be a list of one exponent or more"):
        apart(one, np.array([]), 1.0)
