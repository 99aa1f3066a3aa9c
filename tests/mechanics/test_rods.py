"""Torsional rods: matrices from SymPy, closed-form frequencies, elements, and what is refused."""

import numpy as np
import pytest
import sympy as sp
from scipy.linalg import eigh
from scipy.optimize import brentq

from facegear.floquet.loads import ContactLoad, StateJump
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.mechanics.exact_rods import count_below, exact_frequencies
from facegear.mechanics.properties import STEEL
from facegear.mechanics.rods import (
    Rod,
    Shaft,
    shear_modulus,
    shear_wave_speed,
    with_mass,
)
from tests.independent.shafts_by_elements import craig_bampton, rod

WAVE = shear_wave_speed(STEEL)
ROD = Rod(stiffness=2e6, length=0.4, damping=30.0, modes=4)


def test_inertia_and_diameter_follow_from_stiffness_and_length():
    # ρ J_p l and G J_p/l of a solid cylinder of that diameter.
    area_moment = np.pi * ROD.diameter**4 / 32.0
    assert STEEL.density * area_moment * ROD.length == pytest.approx(ROD.inertia, rel=1e-12)
    assert shear_modulus(STEEL) * area_moment / ROD.length == pytest.approx(ROD.stiffness, rel=1e-12)
    assert ROD.shear_stress(1e3) == pytest.approx(1e3 * ROD.diameter / 2.0 / area_moment, rel=1e-12)


def test_matrices_are_the_integrals_of_the_shapes():
    s, count = sp.symbols("s"), ROD.modes
    shapes = [1 - s, s, *(sp.sin(j * sp.pi * s) for j in range(1, count + 1))]
    for own, scale, order in ((ROD.mass_matrix, ROD.inertia, 0), (ROD.stiffness_matrix, ROD.stiffness, 1)):
        kept = [sp.diff(shape, s, order) for shape in shapes]
        products = {frozenset((f, g)) for f in range(len(kept)) for g in range(len(kept))}
        integrals = {pair: sp.integrate(kept[min(pair)] * kept[max(pair)], (s, 0, 1)) for pair in products}
        derived = sp.Matrix(len(kept), len(kept), lambda a, b, x=integrals: x[frozenset((a, b))])
        np.testing.assert_allclose(
            own, scale * np.array(derived, dtype=float), rtol=1e-13, atol=1e-13 * scale
        )
    np.testing.assert_allclose(ROD.damping_matrix, 30.0 / 2e6 * ROD.stiffness_matrix, rtol=1e-14)


def test_matrices_are_those_of_reduced_elements():
    stiffness, mass = craig_bampton(2e6, 0.4, shear_modulus(STEEL), STEEL.density, 4, 60)
    np.testing.assert_allclose(ROD.stiffness_matrix, stiffness, atol=1e-5 * stiffness.max())
    np.testing.assert_allclose(ROD.mass_matrix, mass, atol=1e-5 * mass.max())


FREE = 2e6 * np.array([[1.0, -1.0], [-1.0, 1.0]])


def test_a_free_rod_turns_as_a_whole_and_in_half_waves():
    # Inertias of the wheels too small to notice. Held at both ends a rod has the same frequencies as free at both,
    # which costs half of the digits.
    wheels = 1e-13 * ROD.inertia * np.eye(2)
    found = exact_frequencies(wheels, FREE, [Shaft(ROD, start=0, end=1)], 5)
    np.testing.assert_allclose(found, np.pi * WAVE / ROD.length * np.arange(5), rtol=3e-8, atol=1e-9)


def test_a_rod_between_equal_wheels():
    found = exact_frequencies(0.7 * ROD.inertia * np.eye(2), FREE, [Shaft(ROD, start=0, end=1)], 5)
    # With h = β/2: cot h = 1.4 h where the wheels turn against each other, -tan h = 1.4 h where they turn together.
    apart = [
        brentq(lambda h: np.cos(h) - 1.4 * h * np.sin(h), j * np.pi, (j + 0.5) * np.pi, xtol=1e-14)
        for j in (0, 1)
    ]
    together = [
        brentq(lambda h: np.sin(h) + 1.4 * h * np.cos(h), (j + 0.5) * np.pi, (j + 1) * np.pi, xtol=1e-14)
        for j in (0, 1)
    ]
    roots = 2.0 * np.sort([0.0, *apart, *together])
    np.testing.assert_allclose(found, roots * WAVE / ROD.length, rtol=1e-11)


def test_a_rod_held_at_one_end_with_a_wheel():
    wheel = 0.7 * ROD.inertia
    found = exact_frequencies([[wheel]], [[2e6]], [Shaft(ROD, end=0)], 6)
    # β tan β = I/J, one root in each half wave.
    roots = [
        brentq(lambda b: b * np.sin(b) - np.cos(b) / 0.7, j * np.pi, (j + 0.5) * np.pi, xtol=1e-14)
        for j in range(6)
    ]
    np.testing.assert_allclose(found, np.array(roots) * WAVE / ROD.length, rtol=1e-12)
    between = (found[:-1] + found[1:]) / 2.0
    counted = [count_below(w, np.array([[wheel]]), np.array([[2e6]]), [Shaft(ROD, end=0)]) for w in between]
    assert counted == [1, 2, 3, 4, 5]


def test_exact_frequencies_of_two_rods_and_a_double_one():
    # Two equal rods from the ground to equal wheels that know nothing of one another.
    shafts = [Shaft(ROD, end=0), Shaft(ROD, end=1)]
    both = exact_frequencies(np.eye(2) * ROD.inertia, 2e6 * np.eye(2), shafts, 4)
    one = exact_frequencies([[ROD.inertia]], [[2e6]], shafts[:1], 2)
    np.testing.assert_allclose(both, np.repeat(one, 2), rtol=1e-13)


def test_dynamic_stiffness_is_static_at_rest_and_that_of_elements():
    static = 2e6 * np.array([[1.0, -1.0], [-1.0, 1.0]])
    np.testing.assert_allclose(ROD.dynamic_stiffness(0.0), static)
    frequency = 1.3 * np.pi * WAVE / ROD.length
    stiffness, mass = rod(2e6, 0.4, shear_modulus(STEEL), STEEL.density, 60)
    whole = stiffness - frequency**2 * mass
    ends, inner = [0, len(mass) - 1], slice(1, -1)
    condensed = whole[np.ix_(ends, ends)] - whole[ends, inner] @ np.linalg.solve(
        whole[inner, inner], whole[inner][:, ends]
    )
    np.testing.assert_allclose(ROD.dynamic_stiffness(frequency), condensed, rtol=1e-6)


def _frequencies(system):
    return np.sqrt(eigh(system.stiffness, system.mass, eigvals_only=True).clip(0.0))


def test_modes_converge_from_above_with_the_third_power():
    mass, stiffness = np.diag([0.02, 0.3]), np.array([[2e6, -2e6], [-2e6, 2e6]])
    spring = PeriodicSystem(mass, np.zeros((2, 2)), stiffness, (), 1.0)
    exact = exact_frequencies(mass, stiffness, [Shaft(ROD, start=0, end=1)], 3)
    numbers = np.array([8, 12, 18, 27])
    errors = []
    for count in numbers.tolist():
        heavy = with_mass(spring, [Shaft(Rod(2e6, 0.4, modes=count), start=0, end=1)])
        errors.append(_frequencies(heavy)[1:3] / exact[1:] - 1.0)
    assert (np.array(errors) > 0.0).all()
    orders = -np.polyfit(np.log(numbers), np.log(errors), 1)[0]
    np.testing.assert_allclose(orders, 3.0, atol=0.25)


def test_forces_and_loads_go_with_their_coordinates():
    shape = PiecewiseChebyshev.constant([1.0, -2.0])
    load = ContactLoad(shape, stiffness=3.0, rate="total")
    base = PeriodicSystem(
        np.eye(2),
        np.zeros((2, 2)),
        np.diag([2e6, 0.0]),
        (load,),
        1.0,
        PiecewiseChebyshev.constant([5.0, 6.0]),
    )
    heavy = with_mass(base, [Shaft(ROD, end=0)])
    assert heavy.size == 6
    np.testing.assert_allclose(heavy.loads[0].shape(0.3), [1.0, -2.0, 0.0, 0.0, 0.0, 0.0])
    np.testing.assert_allclose(heavy.force(0.3), [5.0, 6.0, 0.0, 0.0, 0.0, 0.0])
    assert heavy.loads[0].rate == "total"
    # Springs of the ends stay as they are; of the mass a third goes with the end that moves.
    np.testing.assert_allclose(heavy.stiffness[:2, :2], base.stiffness)
    np.testing.assert_allclose(heavy.mass[:2, :2], base.mass + np.diag([ROD.inertia / 3.0, 0.0]))


@pytest.mark.parametrize(
    ("bad", "error", "words"),
    [
        ({"stiffness": 0.0}, ValueError, "stiffness must be greater than 0"),
        ({"length": -1.0}, ValueError, "length must be greater than 0"),
        ({"length": "long"}, TypeError, "length"),
        ({"damping": -1.0}, ValueError, "damping"),
        ({"modes": -1}, ValueError, "modes"),
        ({"modes": 1.5}, TypeError, "modes"),
        ({"modes": 41}, ValueError, "modes"),
        ({"material": "steel"}, TypeError, "material must be a Material"),
    ],
)
def test_what_is_no_rod_is_refused(bad, error, words):
    with pytest.raises(error, match=words):
        Rod(**({"stiffness": 1.0, "length": 1.0} | bad))


def test_what_a_rod_cannot_join_is_refused():
    base = PeriodicSystem(np.eye(2), np.zeros((2, 2)), np.eye(2), (), 1.0)
    with pytest.raises(TypeError, match="rod must be a Rod"):
        Shaft("rod", end=0)
    with pytest.raises(ValueError, match="start must be another coordinate than end, got 1 for both"):
        Shaft(ROD, end=1, start=1)
    with pytest.raises(ValueError, match=r"shafts\[0\].end must be a coordinate from 0 to 1, got 2"):
        with_mass(base, [Shaft(ROD, end=2)])
    with pytest.raises(TypeError, match=r"shafts\[0\] must be a Shaft"):
        with_mass(base, [ROD])
    with pytest.raises(TypeError, match="system must be a PeriodicSystem"):
        with_mass("system", [])
    jumping = PeriodicSystem(
        np.eye(2), np.zeros((2, 2)), np.eye(2), (), 1.0, jumps=(StateJump(0.5, np.eye(4)),)
    )
    with pytest.raises(ValueError, match="system must have no jumps"):
        with_mass(jumping, [Shaft(ROD, end=0)])
    with pytest.raises(ValueError, match="shafts must list at least one shaft"):
        exact_frequencies([[1.0]], [[1.0]], [], 1)
    with pytest.raises(ValueError, match="mass and stiffness must be square and of one size"):
        exact_frequencies([[1.0]], np.eye(2), [Shaft(ROD, end=0)], 1)
    with pytest.raises(ValueError, match="count"):
        exact_frequencies([[1.0]], [[1.0]], [Shaft(ROD, end=0)], 0)
    for shafts in (None, Shaft(ROD, end=0)):
        with pytest.raises(TypeError, match="shafts must be a list of Shaft"):
            with_mass(base, shafts)
        with pytest.raises(TypeError, match="shafts must be a list of Shaft"):
            exact_frequencies([[1.0]], [[1.0]], shafts, 2)


def test_shafts_may_come_one_by_one():
    base = PeriodicSystem(np.eye(2), np.zeros((2, 2)), np.eye(2), (), 1.0)
    listed = [Shaft(ROD, end=0), Shaft(ROD, end=1)]
    assert with_mass(base, iter(listed)).size == with_mass(base, listed).size == 10
    matrices = np.eye(2), 2e6 * np.eye(2)
    np.testing.assert_allclose(
        exact_frequencies(*matrices, iter(listed), 3), exact_frequencies(*matrices, listed, 3), rtol=1e-14
    )
    assert count_below(1e5, *matrices, iter(listed)) == count_below(1e5, *matrices, listed) > 2


@pytest.mark.parametrize(
    ("mass", "stiffness", "words"),
    [
        (np.eye(2), [[2e6, 1e6], [0.0, 2e6]], "stiffness must be symmetric"),
        ([[1.0, 0.5], [0.0, 1.0]], np.eye(2), "mass must be symmetric"),
        (np.diag([1.0, 0.0]), np.eye(2), "mass must be positive definite"),
        (np.eye(2), np.diag([2e6, -5e6]), "stiffness must have no negative eigenvalue"),
    ],
)
def test_matrices_of_no_model_at_rest_are_refused(mass, stiffness, words):
    with pytest.raises(ValueError, match=words):
        exact_frequencies(mass, stiffness, [Shaft(ROD, end=0)], 1)
