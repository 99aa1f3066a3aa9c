"""Rigid-body motions: found, named, and taken out without touching any other multiplier."""

from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from facegear.floquet.loads import ContactLoad
from facegear.floquet.modified_models import WithoutRigidMotion
from facegear.floquet.multipliers import growth_rate, multipliers
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.floquet.rigid_motion import rigid_motions, without_rigid_motion
from facegear.maps.tracing import tongues
from facegear.mechanics.cases import FIGURES
from facegear.mechanics.classical import Mathieu, cosine_wave
from facegear.mechanics.gearboxes import FIGURES as GEARBOXES


@dataclass(frozen=True)
class FreePair:
    """Two masses on one modulated spring and damper, hung on nothing: Mathieu's equation for their distance."""

    depth: float
    damping_ratio: float
    first: float = 1.0
    second: float = 2.5

    @property
    def reduced(self):
        return self.first * self.second / (self.first + self.second)

    def system(self, speed):
        apart = np.array([1.0, -1.0])
        dyad = self.reduced * np.outer(apart, apart)
        load = ContactLoad(
            PiecewiseChebyshev.constant(apart), stiffness=self.depth * self.reduced, weight=cosine_wave()
        )
        mass = np.diag([self.first, self.second])
        return PeriodicSystem(mass, 2 * self.damping_ratio * dyad, dyad, (load,), 2 * np.pi / speed)


@given(
    st.floats(0.0, 0.6), st.floats(0.0, 0.3), st.floats(0.1, 10.0), st.floats(0.1, 10.0), st.floats(0.5, 4.0)
)
@settings(max_examples=30)
def test_what_is_left_of_two_free_masses_is_mathieus_equation(depth, damping_ratio, first, second, speed):
    system = FreePair(depth, damping_ratio, first, second).system(speed)
    (motion,) = rigid_motions(system).T
    np.testing.assert_allclose(motion / motion[0], [1.0, 1.0], rtol=1e-12)
    assert motion @ system.mass @ motion == pytest.approx(1.0, rel=1e-12)
    left = without_rigid_motion(system)
    assert left.size == 1
    found, closed = multipliers(left), multipliers(Mathieu(depth, damping_ratio).system(speed))
    distance = np.abs(found[:, None] - closed[None, :]).min(axis=1)
    # Where the two meet the root of rounding is left.
    assert distance.max() < (1e-9 if abs(closed[0] - closed[1]) > 1e-3 else 1e-4)


def test_tongues_name_the_motion_and_find_all_when_it_is_out():
    pair = FreePair(0.3, 0.01)
    with pytest.raises(ValueError, match=r"1 rigid-body motion\(s\), along \(1, 1\).*WithoutRigidMotion"):
        tongues(pair, (0.8, 2.5))

    found, expected = tongues(WithoutRigidMotion(pair), (0.8, 2.5)), tongues(Mathieu(0.3, 0.01), (0.8, 2.5))
    assert len(found) == len(expected) == 2
    for one, other in zip(found, expected, strict=True):
        assert (one.lower, one.upper) == pytest.approx((other.lower, other.upper), rel=1e-7)
        assert one.growth_rate == pytest.approx(other.growth_rate, rel=1e-7)


def test_two_motions_and_smooth_coordinates():
    """Four masses, the first pair and the second each on a spring of their own: two ways to drift."""

    def system(speed):
        ones = [np.array([1.0, -1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0, -1.0])]
        stiffness = sum((1.0 + i + 0.001 * speed) * np.outer(v, v) for i, v in enumerate(ones))
        return PeriodicSystem(
            np.diag([1.0, 2.0, 3.0, 4.0]), np.zeros((4, 4)), stiffness, (), 2 * np.pi / speed
        )

    assert rigid_motions(system(1.0)).shape == (4, 2)
    left = [without_rigid_motion(system(speed)) for speed in (1.0, 1.0 + 1e-9)]
    assert left[0].size == 2
    # k (1/m1 + 1/m2) in closed form, and coordinates that stay as the speed changes.
    squares = np.linalg.eigvalsh(left[0].stiffness)
    np.testing.assert_allclose(np.sort(squares), np.sort([1.001 * 1.5, 2.001 * 7 / 12]), rtol=1e-12)
    np.testing.assert_allclose(left[0].stiffness, left[1].stiffness, rtol=0, atol=1e-8)


def test_models_of_the_chapters_hang_on_something():
    for model in (FIGURES["4.4a"].model(), GEARBOXES["7.12a"].model()):
        system = model.system(50.0)
        assert rigid_motions(system).shape == (system.size, 0)
        assert without_rigid_motion(system) is system
        assert growth_rate(WithoutRigidMotion(model).system(50.0)) == growth_rate(system)


def test_nothing_but_rigid_motion_is_refused():
    with pytest.raises(ValueError, match="rigid-body motions only"):
        without_rigid_motion(PeriodicSystem(np.eye(2), np.zeros((2, 2)), np.zeros((2, 2)), (), 1.0))


def test_a_drift_against_a_damper_is_no_rigid_motion():
    system = PeriodicSystem(np.eye(1), [[1.0]], np.zeros((1, 1)), (), 1.0)
    assert rigid_motions(system).shape == (1, 0)
    np.testing.assert_allclose(np.sort(np.abs(multipliers(system))), [np.exp(-1.0), 1.0], rtol=1e-12)
