"""Taylor series against other methods, compiled and not; what they refuse."""

from dataclasses import replace

import numpy as np
import pytest

from facegear.floquet import taylor
from facegear.floquet.free_modes import UnsuitableSystemError
from facegear.floquet.loads import ContactLoad, StateJump
from facegear.floquet.methods import AdaptiveMagnus
from facegear.floquet.multipliers import transition_matrices
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.floquet.stepping import Family
from facegear.floquet.taylor import Taylor

RAMPS = PiecewiseChebyshev(
    np.array([0.0, 0.37]),
    np.array([[[1.0, 0.4, 0.0], [0.2, 0.1, 0.0]], [[0.2, 0.1, 0.3], [-0.3, 0.1, 0.1]]]),
)
WAVE = PiecewiseChebyshev.fit(lambda x, _: 1.0 + 0.7 * np.cos(2.0 * np.pi * x), [0.0])
MASS = np.array([[1.0, 0.2, 0.0], [0.2, 2.0, 0.1], [0.0, 0.1, 0.5]])
CHAIN = np.array([[4.0, -4.0, 0.0], [-4.0, 9.0, -5.0], [0.0, -5.0, 5.0]])  # which hangs on nothing


def systems(count=7, **load):
    one = {"shape": RAMPS, "rate": "total", **load}
    return [
        PeriodicSystem(
            MASS,
            0.05 * (k + 1) * CHAIN,
            CHAIN * (1.0 + 0.1 * k),
            (ContactLoad(**one, stiffness=3.0 + k, damping=0.1 * k), ContactLoad(RAMPS, stiffness=1.0)),
            1.0 + 0.2 * k,
        )
        for k in range(count)
    ]


@pytest.fixture(params=["compiled", "NumPy"])
def _either_way(request, monkeypatch):
    if request.param == "NumPy":
        monkeypatch.setattr(taylor, "_compiled", lambda: None)
    else:
        pytest.importorskip("numba")


@pytest.mark.usefixtures("_either_way")
@pytest.mark.parametrize("load", [{}, {"rate": "frozen"}, {"weight": WAVE}])
def test_as_by_magnus(load):
    found, exact = (
        transition_matrices(systems(**load), method) for method in (Taylor(), AdaptiveMagnus(1e-13))
    )
    assert np.abs(found - exact).max() < 1e-11 * np.abs(exact).max()


@pytest.mark.usefixtures("_either_way")
def test_other_periods_at_once():
    family, turns = Family(systems()), np.array([3.0, 1.0, 0.25])
    found = Taylor().over(family, turns)
    for column, turn in enumerate(turns.tolist()):
        others = [replace(system, period=system.period * turn) for system in family.systems]
        own = family.scale @ transition_matrices(others, AdaptiveMagnus(1e-12)) @ family.inverse_scale
        assert np.abs(found[:, column] - own).max() < 1e-10 * np.abs(own).max()


def test_a_tolerance_is_kept():
    exact = transition_matrices(systems(), AdaptiveMagnus(1e-13))
    for tolerance in (1e-4, 1e-8):
        found = transition_matrices(systems(), Taylor(tolerance=tolerance))
        assert 0.0 < np.abs(found - exact).max() < tolerance * np.abs(exact).max()


def test_strong_dampers_ask_for_shorter_steps():
    (system,) = systems(1)
    stiff = replace(system, damping=100.0 * CHAIN)
    found, exact = (transition_matrices([stiff], method) for method in (Taylor(), AdaptiveMagnus(1e-12)))
    assert np.abs(found - exact).max() < 1e-10
    # What a method takes its refinement takes too.
    stiffest = replace(system, damping=5400.0 / Family([stiff]).exponent_norm * stiff.damping)
    assert 4800.0 < Family([stiffest]).exponent_norm < 5800.0
    one, other = (transition_matrices([stiffest], method) for method in (Taylor(), Taylor().refined()))
    assert np.abs(one - other).max() < 1e-10
    with pytest.raises(UnsuitableSystemError, match="more than 1000 steps"):
        transition_matrices([replace(stiff, damping=1e4 * CHAIN)], Taylor())


def test_what_is_refused():
    one, other, *_ = systems()
    jump = StateJump(0.25, 0.5 * np.eye(6))
    for family in (
        [replace(one, mass=2.0 * MASS), other],
        [one.replace_loads(mass=np.array([0.0, 1.0]))],
        [replace(one, jumps=(jump,))],
        [one, replace(other, loads=other.loads[::-1])],
    ):
        with pytest.raises(UnsuitableSystemError, match="without contact masses"):
            transition_matrices(family, Taylor())


@pytest.mark.parametrize(("name", "value"), [("angle", 0.0), ("angle", 7.0), ("tolerance", 0.0)])
def test_arguments_are_checked(name, value):
    with pytest.raises(ValueError, match=f"{name} must"):
        Taylor(**{name: value})
