"""Classical systems: right against equations written out anew, and against what is known of each."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from facegear.floquet import methods
from facegear.floquet import multipliers as floquet
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.mechanics import classical, classical_pairs
from tests.independent import classical as independent
from tests.resonance_systems import CHECK


def deviation(system, written_out):
    right = independent.transition_matrix(written_out)
    return np.abs(floquet.transition_matrix(system) - right).max() / np.abs(right).max()


@pytest.mark.parametrize(
    ("system", "written_out"),
    [
        (classical.Mathieu(0.4, 0.03).system(1.7), independent.mathieu(1.7, 0.4, 0.03)),
        (classical.Meissner(0.6, 0.3, 0.02).system(0.9), independent.meissner(0.9, 0.6, 0.3, 0.02)),
        (
            classical_pairs.CoupledPair(0.5, coupling=0.8, damping=0.02).system(1.3),
            independent.coupled_pair(1.3, 0.5, 0.8, 0.0, 0.02),
        ),
        (
            classical_pairs.CoupledPair(0.5, circulation=0.8, damping=0.02).system(0.7),
            independent.coupled_pair(0.7, 0.5, 0.0, 0.8, 0.02),
        ),
        (
            classical_pairs.GearPair(1.563, droop=0.4, shaft_damping=0.02).system(1.1),
            independent.gear_pair(1.1, 1.563, 0.4, 0.02),
        ),
        (
            classical_pairs.GearPair(2.4, droop=1.0, shaft_damping=0.02).system(1.1),
            independent.gear_pair(1.1, 2.4, 1.0, 0.02),
        ),
    ],
    ids=["mathieu", "meissner", "spring", "circulatory", "jumps", "kinks"],
)
def test_systems_are_those_of_the_equations(system, written_out):
    assert deviation(system, written_out) < 1e-10


def test_natural_frequency_only_scales_time():
    slow, fast = (
        classical.Mathieu(0.4, 0.02).system(1.9),
        classical.Mathieu(0.4, 0.02, natural_frequency=5.0).system(9.5),
    )
    assert floquet.growth_rate(fast) == pytest.approx(5.0 * floquet.growth_rate(slow), rel=1e-9)


@CHECK
@given(
    frequency=st.floats(0.3, 4.0),
    depth=st.floats(0.0, 1.5),
    duty=st.floats(0.05, 0.95),
    damping_ratio=st.floats(0.0, 0.3),
)
def test_meissner_trace_in_closed_form(frequency, depth, duty, damping_ratio):
    system = classical.Meissner(depth, duty, damping_ratio).system(frequency)
    # Constant in each of two pieces: one exponential a piece is exact.
    matrix = floquet.transition_matrix(system, methods.AlignedStepwise(2))
    expected = classical.meissner_trace(frequency, depth, duty, damping_ratio)
    assert np.trace(matrix) == pytest.approx(float(expected), rel=1e-11, abs=1e-11)


def test_meissner_trace_stays_finite_where_the_soft_part_has_no_stiffness():
    values = classical.meissner_trace(1.2, [1.0 - 1e-12, 1.0, 1.0 + 1e-12])
    assert values[1] == pytest.approx(values[0], abs=1e-10)
    assert values[1] == pytest.approx(values[2], abs=1e-10)


@pytest.mark.parametrize(
    ("build", "name"),
    [
        (lambda: classical.Mathieu(0.1).system(0.0), "frequency"),
        (lambda: classical.Mathieu(0.1).system(math.nan), "frequency"),
        (lambda: classical.Mathieu(-0.1), "depth"),
        (lambda: classical.Mathieu(0.1, 1.0), "damping_ratio"),
        (lambda: classical.Mathieu(0.1, natural_frequency=-1.0), "natural_frequency"),
        (lambda: classical.Meissner(0.1, 1.0), "duty"),
        (
            lambda: classical.Hill(0.1, PiecewiseChebyshev.constant([1.0, 2.0])),
            "wave must have one component",
        ),
        (lambda: classical_pairs.CoupledPair(0.1, circulation=1.3), "circulation"),
        (lambda: classical_pairs.CoupledPair(0.1, coupling=2.0), "coupling"),
        (lambda: classical_pairs.CoupledPair(0.1, stiffnesses=(1.0, 0.0)), r"stiffnesses\[1\]"),
        (
            lambda: classical_pairs.CoupledPair(0.1, stiffnesses=(1,)),
            r"stiffnesses must be two numbers .* got \(1,\)",
        ),
        (lambda: classical_pairs.CoupledPair(0.1, stiffnesses=(1, 2, 3)), "stiffnesses must be two numbers"),
        (
            lambda: classical_pairs.CoupledPair(0.1, stiffnesses=2.0),
            "stiffnesses must be two numbers .* got 2.0",
        ),
        (lambda: classical_pairs.GearPair(1.5, masses=None), "masses must be two numbers"),
        (lambda: classical_pairs.CoupledPair(0.1, damping=-0.1), "damping"),
        (lambda: classical_pairs.GearPair(0.9), "contact_ratio"),
        (lambda: classical_pairs.GearPair(1.5, droop=1.2), "droop"),
        (lambda: classical_pairs.GearPair(1.5, pair_stiffness=-1.0), "pair_stiffness"),
        (lambda: classical_pairs.GearPair(1.5, masses=(1.0, -1.0)), r"masses\[1\]"),
        (lambda: classical_pairs.GearPair(1.5).system(-1.0), "mesh_frequency"),
    ],
)
def test_bad_input_is_one_clear_error(build, name):
    with pytest.raises(ValueError, match=name):
        build()


def test_text_is_no_number():
    with pytest.raises(TypeError, match="depth"):
        classical.Mathieu("0.1")


@pytest.mark.parametrize("wave", [None, 1.0, "cosine", np.cos, [0.0, 1.0]])
def test_what_is_no_wave_is_refused_with_what_would_be(wave):
    with pytest.raises(TypeError, match=r"wave must be a PiecewiseChebyshev .* as PiecewiseChebyshev\.fit"):
        classical.Hill(0.1, wave)
