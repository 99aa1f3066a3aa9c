"""What the table in facegear.floquet says of each method against what the method does."""

import re
from dataclasses import dataclass

import numpy as np
import pytest

from facegear import floquet
from facegear.floquet.loads import ContactLoad
from facegear.floquet.methods import AdaptiveMagnus, AlignedStepwise, Collocation, Magnus, Stepwise
from facegear.floquet.multipliers import transition_matrix
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.floquet.radau import Radau
from facegear.floquet.taylor import Taylor
from facegear.maps.sensitivity import sensitivity

METHODS = {
    type(method).__name__: method
    for method in (
        Stepwise(2000),
        AlignedStepwise(2000),
        Magnus(200),
        AdaptiveMagnus(),
        Collocation(),
        Radau(),
        Taylor(),
    )
}
CONSTANT = PiecewiseChebyshev.constant([1.0, 0.4])
WAVE = PiecewiseChebyshev.fit(lambda x, _: 1.0 + np.cos(2.0 * np.pi * x), [0.0])
TENT = PiecewiseChebyshev(np.array([0.0, 0.3]), np.array([[[0.0], [1.0]], [[0.0], [-1.0]]]))
TENTS = PiecewiseChebyshev(TENT.breakpoints, TENT.coefficients * [1.0, 0.4])
JUMPS = PiecewiseChebyshev(np.array([0.0, 0.37]), np.array([[[1.0, 0.4]], [[0.2, 0.1]]]))
BODY = np.array([[5.0, -1.0], [-1.0, 3.0]])


def system(damping=0.1, stiffness=BODY, **load):
    loads = (ContactLoad(**{"shape": CONSTANT, "stiffness": 0.5, **load}),)
    return PeriodicSystem(np.eye(2), damping * np.diag([1.0, 0.3]), stiffness, loads, 2.0)


SYSTEMS = {
    "jumps": system(shape=TENTS, mass=0.4, rate="total"),
    "overdamped": system(damping=20.0),
    "rigid": system(
        damping=0.0, stiffness=np.diag([5.0, 0.0]), shape=PiecewiseChebyshev.constant([1.0, 0.0])
    ),
    "weights": system(weight=WAVE, mass=0.4),
}


@dataclass(frozen=True)
class Swept:
    depth: float = 0.5

    def system(self, speed):
        return system(stiffness=BODY, shape=JUMPS, damping=self.depth)


def table():
    """Rows of the table by method: column to entry."""
    lines = floquet.__doc__.splitlines()
    first, head, last = (i for i, line in enumerate(lines) if line.startswith("====="))
    ends = [part.span() for part in re.finditer("=+", lines[first])]
    ends[-1] = (ends[-1][0], None)
    rows = [[line[a:b].strip() for a, b in ends] for line in (lines[first + 1], *lines[head + 1 : last])]
    return {row[0]: dict(zip(rows[0][1:], row[1:], strict=True)) for row in rows[1:]}


def takes(method, capability):
    """Whether a method gives the right answer; a refusal is a ValueError, a wrong answer fails."""
    try:
        if capability == "sensitivities":
            found = sensitivity(Swept(), 1.0, ["depth"], method).growth_rate_derivatives
            ends = [
                np.log(np.abs(np.linalg.eigvals(transition_matrix(Swept(d).system(1.0)))).max()) / 2.0
                for d in (0.5 + 1e-4, 0.5 - 1e-4)
            ]
            assert found == pytest.approx([(ends[0] - ends[1]) / 2e-4], rel=1e-3)
        else:
            expected = transition_matrix(SYSTEMS[capability], AdaptiveMagnus(1e-12))
            found = transition_matrix(SYSTEMS[capability], method)
            assert np.abs(found - expected).max() < 1e-4 * np.abs(expected).max()
    except ValueError:
        return False
    return True


def test_the_table_has_all_methods():
    assert set(table()) == set(METHODS)


@pytest.mark.parametrize("name", METHODS)
def test_yes_and_no_are_true(name):
    row = table()[name]
    capabilities = ("jumps", "overdamped", "rigid", "weights", "sensitivities")
    said = {capability: row[capability] == "yes" for capability in capabilities}
    assert {row[capability] for capability in capabilities} <= {"yes", "no"}
    assert {capability: takes(METHODS[name], capability) for capability in capabilities} == said


@pytest.mark.parametrize("name", ["Stepwise", "AlignedStepwise", "Magnus"])
def test_fixed_steps_have_the_order_of_the_table(name):
    """At a jump that no number of equal sub-intervals meets; AdaptiveMagnus extrapolates three times from 4."""
    order = int(table()[name]["order"])
    ramps = PiecewiseChebyshev(
        np.array([0.0, 2.0 / np.pi**2]), np.array([[[1.0, 0.4], [0.2, 0.1]], [[0.2, 0.1], [-0.3, 0.1]]])
    )
    periodic = system(shape=ramps, stiffness=40.0 * BODY, damping=0.0).replace_loads(stiffness=30.0)
    exact = transition_matrix(periodic, AdaptiveMagnus(1e-13))
    counts = 2 ** np.arange(5, 10)
    errors = [
        np.abs(transition_matrix(periodic, type(METHODS[name])(int(q))) - exact).max()
        for q in counts.tolist()
    ]
    slope = -np.polyfit(np.log(counts), np.log(errors), 1)[0]
    assert slope == pytest.approx(order, abs=0.35 if name == "Stepwise" else 0.15)
