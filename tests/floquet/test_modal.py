import numpy as np
import pytest

from facegear.floquet import hsu
from facegear.floquet.modal import StandardForm, modal_expansion, standard_form
from facegear.floquet.periodic import PeriodicSystem
from tests.independent.monodromy import fitted_order, floquet_growth
from tests.resonance_systems import by_label, coupled_matrices, disk, load, mathieu


@pytest.mark.parametrize("kind", ["sum", pytest.param("difference", marks=pytest.mark.slow)])
def test_standard_form_with_all_coefficients_against_floquet(kind):
    # Non-symmetric D, E, F, G and unequal damping: every term of 2-27 and 2-28 counts.
    d, e, f, g = 2 * np.random.default_rng(14).normal(size=(4, 2, 2))
    frequencies = np.array([1.0, 2.6])
    mean = np.array([[0.3, 0.4], [-0.5, 0.9]])
    sizes = np.array([0.02, 0.01, 0.005])
    for offset in (0.0, 0.3):
        errors = []
        for size in sizes:
            form = StandardForm(frequencies, size * mean, *(size * m[None] for m in (d, e, f, g)), 1.0)
            centre = 3.6 if kind == "sum" else 1.6
            frequency = centre + offset * size

            def matrices(phase, size=size):
                cosine, sine = np.cos(phase), np.sin(phase)
                velocity = size * (mean + f * cosine + g * sine)
                return np.eye(2), velocity, np.diag(frequencies**2) + size * (d * cosine + e * sine)

            predicted = form.growth_rate(1, 2, kind, 1, frequency)
            assert predicted > 0.3 * size
            errors.append(abs(floquet_growth(matrices, frequency) - predicted))
        assert fitted_order(sizes, errors) == pytest.approx(2.0, abs=0.25)


def test_two_expansions_differ_by_second_order_in_the_damping():
    sizes = np.array([0.2, 0.1, 0.05])
    errors = []
    for size in sizes:
        damping = size * np.array([[0.3, 0.1], [0.1, 0.2]])
        _, system = coupled_matrices(size, 0.0)
        system = PeriodicSystem(system.mass, damping, system.stiffness, system.loads, 1.0)
        own, printed = (
            by_label(hsu.resonance_bands(expansion, order=1))["(1+1)/1"]
            for expansion in (modal_expansion(system, 1), standard_form(system, 1).expansion())
        )
        errors.append(abs(own.upper - printed.upper))
    assert fitted_order(sizes, errors) == pytest.approx(2.0, abs=0.2)


def test_two_expansions_agree_exactly_without_damping():
    _, system = coupled_matrices(0.2, 0.0)
    own = hsu.resonance_bands(system, order=2)
    printed = hsu.resonance_bands(standard_form(system, 2).expansion(), order=2)
    assert [b.label for b in own] == [b.label for b in printed]
    for one, other in zip(own, printed, strict=True):
        assert (one.lower, one.upper) == pytest.approx((other.lower, other.upper), rel=1e-12)


def test_non_symmetric_mean_stiffness_makes_the_difference_unstable():
    mean = np.array([[1.0, 1.2], [-1.2, 6.0]])
    sizes = np.array([0.2, 0.1, 0.05])
    errors = []
    for size in sizes:
        system = PeriodicSystem(np.eye(2), np.zeros((2, 2)), mean, [load([1.0, 0.0], size, np.cos)], 1.0)
        band = by_label(hsu.resonance_bands(system, order=1))["(2-1)/1"]
        printed = by_label(hsu.resonance_bands(standard_form(system, 1).expansion(), order=1))["(2-1)/1"]
        assert (band.lower, band.upper) == pytest.approx((printed.lower, printed.upper), rel=1e-10)

        def matrices(phase, size=size):
            return np.eye(2), np.zeros((2, 2)), mean + np.diag([size * np.cos(phase), 0])

        errors.append(abs(floquet_growth(matrices, band.peak) - band.growth_rate))
    assert fitted_order(sizes, errors) > 1.8


def test_slowly_turning_disk_by_both_expansions():
    # To first order in the rotation Hsu's own form splits the pair by the group's mean coupling.
    _, system = disk(0.004, 0.1, 0.01)
    own = hsu.resonance_bands(system, order=1)
    printed = hsu.resonance_bands(standard_form(system, 1).expansion(), order=1)
    assert len(own) == len(printed) == 1
    assert own[0].modes == printed[0].modes == (1, 2)
    assert (own[0].lower, own[0].upper) == pytest.approx((printed[0].lower, printed[0].upper), abs=1e-4)
    assert own[0].growth_rate == pytest.approx(printed[0].growth_rate, rel=1e-2)


def test_rigid_body_modes_are_refused_by_name():
    mean = np.array([[1.0, -1.0], [-1.0, 1.0]])
    system = PeriodicSystem(np.eye(2), np.zeros((2, 2)), mean, [load([1.0, -1.0], 0.1, np.cos)], 1.0)
    for refused in (lambda: hsu.resonance_bands(system), lambda: standard_form(system, 1)):
        with pytest.raises(ValueError, match="rigid-body"):
            refused()


def test_overdamped_and_critical_means():
    # Overdamped coordinates take no part; critical damping leaves no eigenbasis.
    loads = [load([0.7, 0.7], 0.05, np.cos)]
    system = PeriodicSystem(np.eye(2), np.diag([0.01, 20.0]), np.diag([1.0, 5.0]), loads, 1.0)
    assert [band.label for band in hsu.resonance_bands(system, order=1)] == ["(1+1)/1"]
    with pytest.raises(ValueError, match="nearly dependent"):
        hsu.resonance_bands(mathieu(0.1, 2.0))
    with pytest.raises(ValueError, match="every mode of the mean system is overdamped"):
        hsu.resonance_bands(mathieu(0.1, 5.0))


def test_standard_form_refuses_pairs_it_does_not_have():
    form = standard_form(mathieu(0.1), 2)
    for pair in ((0, 1), (1, 2), (2, 1)):
        with pytest.raises(ValueError, match="1 ≤ k ≤ j ≤ 1"):
            form.growth_rate(*pair, "sum", 1, 2.0)
    with pytest.raises(ValueError, match="k < j for a difference"):
        form.growth_rate(1, 1, "difference", 1, 2.0)
    with pytest.raises(ValueError, match="kind = 'product'"):
        form.growth_rate(1, 1, "product", 1, 2.0)
    with pytest.raises(ValueError, match="order = 3"):
        form.growth_rate(1, 1, "sum", 3, 2.0)
