from dataclasses import replace

import numpy as np
import pytest

from facegear.floquet.band_speeds import band_speeds
from facegear.floquet.hsu import resonance_bands
from facegear.floquet.labels import Combination, combination, growth_and_combination, moving_parts
from facegear.floquet.loads import ContactLoad
from facegear.floquet.models import Coordinate
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.geometry.drive import Drive
from facegear.maps.tracing import tongues
from facegear.mechanics.mesh_oscillator import MeshOscillator
from facegear.mechanics.plate import Body
from facegear.mechanics.properties import MeshLoad
from facegear.mechanics.transverse import Transverse
from facegear.support.parameters import rad_per_s

TURN = 2.0 * np.pi


def wave(function):
    return PiecewiseChebyshev.fit(lambda x, piece: function(TURN * x), [0.0])


def system(frequencies, shape, stiffness=0.0, damping=0.0, mean_damping=0.01, function=np.cos):
    load = ContactLoad(
        PiecewiseChebyshev.constant(shape), stiffness=stiffness, damping=damping, weight=wave(function)
    )
    n = len(frequencies)
    return PeriodicSystem(np.eye(n), mean_damping * np.eye(n), np.diag(np.square(frequencies)), [load], 1.0)


GYROSCOPIC = np.array([[0.0, 6.0], [-6.0, 0.0]])


@pytest.mark.parametrize(
    ("built", "expected"),
    [
        (system((30.0, 71.0), (0.8, 0.6), stiffness=60.0), {"(1+1)/1", "(1+2)/1", "(2+2)/1"}),
        (system((30.0, 71.0), (0.8, 0.6), damping=0.2), {"(1+1)/1", "(1+2)/1", "(2-1)/1", "(2+2)/1"}),
        (
            system((20.0, 33.0, 61.0), (0.5, 0.6, 0.7), stiffness=90.0),
            {"(1+1)/1", "(1+2)/1", "(2+2)/1", "(1+3)/1", "(2+3)/1", "(3+3)/1"},
        ),
        (
            # Two harmonics: the second drives every combination at half the speed.
            system((30.0, 71.0), (0.8, 0.6), 60.0, function=lambda p: np.cos(p) + np.sin(2.0 * p)),
            {f"({pair})/{order}" for pair in ("1+1", "1+2", "2+2") for order in (1, 2)},
        ),
    ],
)
def test_labels_are_those_of_averaging_at_the_peak_of_each_band(built, expected):
    bands = resonance_bands(built, order=2)
    assert {band.label for band in bands} == expected
    for band in bands:
        at_peak = replace(built, period=TURN / band.peak)
        assert combination(at_peak).label == band.label


def test_modes_of_a_gyroscopic_system_are_those_of_its_speed():
    base = system((30.0, 40.0), (0.8, 0.6), stiffness=60.0)
    turning = replace(base, damping=base.damping + GYROSCOPIC)
    bands = resonance_bands(turning, order=1)
    assert len(bands) >= 3
    assert abs(bands[0].frequencies[0] - 30.0) > 0.5
    for band in bands:
        assert combination(replace(turning, period=TURN / band.peak)).label == band.label


def test_resonances_of_higher_order_than_averaging_sees_are_named_by_their_phase():
    # One harmonic only: first-order averaging knows the principal tongue and no other.
    mathieu = system((50.0,), (1.0,), stiffness=0.3 * 2500.0, mean_damping=0.0)
    assert [band.label for band in resonance_bands(mathieu, order=3)] == ["(1+1)/1"]

    class Model:
        def system(self, speed):
            return replace(mathieu, period=TURN / speed)

    found = tongues(Model(), (22.0, 130.0))
    assert [tongue.label for tongue in found] == ["(1+1)/4", "(1+1)/3", "(1+1)/2", "(1+1)/1"]


def test_combination_resonances_of_second_order_are_named():
    pair = system((30.0, 71.0), (0.8, 0.6), stiffness=250.0, mean_damping=0.0)

    class Model:
        def system(self, speed):
            return replace(pair, period=TURN / speed)

    found = {tongue.label: tongue for tongue in tongues(Model(), (45.0, 56.0))}
    assert "(1+2)/2" in found
    assert found["(1+2)/2"].peak == pytest.approx(50.5, rel=0.02)


def test_tongues_of_the_transverse_model_have_the_labels_of_averaging():
    model = Transverse(Body(Drive(26, 130, 3.175e-3), thickness_ratio=0.03), MeshLoad(1.0, 3e-6, 1.0))
    low, high = rad_per_s(np.array([500.0, 1000.0]))
    bands = band_speeds(model, (float(low), float(high)), order=1)
    found = tongues(model, (float(low), float(high)))
    assert len(found) == 4
    for tongue in found:
        overlapping = {
            band.label for band in bands if band.lower < tongue.upper and tongue.lower < band.upper
        }
        assert tongue.label in overlapping


def test_flutter_of_the_mean_system_is_told_from_resonance():
    built = system((30.0, 71.0), (0.8, 0.6), stiffness=1.0)
    unstable = replace(built, damping=np.diag([0.1, -0.2]), period=0.0371)
    assert combination(unstable) == Combination(2, 2, "mean", 0)
    assert combination(unstable).label == "mean 2"
    falling = replace(built, stiffness=np.diag([-100.0, 71.0**2]))
    assert combination(falling).label == "mean 0"


def test_flutter_under_a_mesh_too_fast_for_any_pair_is_no_divergence():
    """It was called "mean 0". The mesh stiffens the first mode up to the second, and they flutter by a shear."""
    built = system((30.0, 30.0), (1.0, 0.0), stiffness=600.0, mean_damping=0.001)
    sheared = replace(built, stiffness=np.array([[892.0, 2.0], [-2.0, 900.0]]), period=TURN / 150.0)
    growth, named = growth_and_combination(sheared)
    assert growth > 0.02
    assert (named.kind, named.order) == ("mean", 0)
    assert named.k == named.j > 0


def test_labels():
    assert Combination(1, 3, "sum", 2).label == "(1+3)/2"
    assert Combination(1, 3, "difference", 2).label == "(3-1)/2"


def test_parts_of_the_natural_motions():
    """Two masses on a weak spring each move by themselves; a strong one takes both along, and the heavier has more."""
    names = [Coordinate("a", "m", "light"), Coordinate("b", "m", "heavy")]
    spring = ContactLoad(PiecewiseChebyshev.constant([1.0, -1.0]), stiffness=0.01)
    ground = np.diag([4.0, 9.0])
    built = PeriodicSystem(np.diag([1.0, 1.5]), np.zeros((2, 2)), ground, (spring,), 1.0)
    assert moving_parts(built, names) == ("light", "heavy")
    tight = replace(built, loads=(replace(spring, stiffness=1e3),))
    assert moving_parts(tight, names) == ("heavy", "light")
    assert moving_parts(built, [replace(each, part="") for each in names]) == ("a", "b")
    still = replace(built, damping=np.diag([100.0, 0.1]))
    assert moving_parts(still, names) == ("heavy",)
    with pytest.raises(ValueError, match="coordinates must be 2, one a row of the system's matrices; got 1"):
        moving_parts(built, names[:1])


def test_coordinates_of_one_part_count_together():
    names = [Coordinate("a", "m", "disk"), Coordinate("b", "m", "disk"), Coordinate("c", "m", "pinion")]
    # The pinion has the largest share of one coordinate in the first motion, and most of all in the second.
    first = np.sqrt([0.30, 0.25, 0.45])
    second = np.array([0.0, 0.0, 1.0]) - first[2] * first
    turned = np.stack(
        [first, second / np.linalg.norm(second), np.cross(first, second / np.linalg.norm(second))], 1
    )
    np.testing.assert_allclose(turned.T @ turned, np.eye(3), atol=1e-14)
    stiffness = turned @ np.diag([1.0, 4.0, 9.0]) @ turned.T
    built = PeriodicSystem(np.eye(3), np.zeros((3, 3)), stiffness, (), 1.0)
    assert moving_parts(built, names) == ("disk", "pinion", "disk")


def test_parts_that_move_alike_are_named_together():
    """Two like oscillators coupled: in both motions each has half of the energy, whichever rounding prefers."""
    coupled = PeriodicSystem(np.eye(2), np.zeros((2, 2)), [[2.0, -0.3], [-0.3, 2.0]], (), 1.0)
    names = [Coordinate(name, "m", name) for name in ("lower", "upper")]
    assert moving_parts(coupled, names) == ("lower and upper", "lower and upper")


def test_tongues_between_the_disk_and_a_pinion_on_its_bearing_are_named_after_both():
    body = Body(Drive(26, 130, 3.175e-3), thickness_ratio=0.03, nodal_circles=0, nodal_diameters=2)
    load = MeshLoad(stiffness=0.7, damping=1e-6, mass=1.0)
    model = MeshOscillator(body, load, mesh_stiffness=2e7, mesh_damping=1e-6)
    (wave,) = (t for t in tongues(model, tuple(rad_per_s(np.array([285.0, 300.0])))) if t.label == "(1+6)/1")
    parts = moving_parts(model.system(wave.peak), model.coordinates)
    assert (parts[wave.combination.k - 1], parts[wave.combination.j - 1]) == ("pinion", "face gear")
    # On a heavier pinion the number of its motion is the same, on a lighter one another.
    light = replace(model, load=replace(load, mass=0.2))
    assert moving_parts(light.system(wave.peak), light.coordinates).index("pinion") > 0
