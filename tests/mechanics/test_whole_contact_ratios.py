"""Contact ratios at and next to whole numbers: a pair leaves as the next one enters, and the piece between is empty."""

from dataclasses import replace

import numpy as np
import pytest

from facegear.floquet.multipliers import growth_rate
from facegear.geometry.kinematics import CentroidPath, ContactPath
from facegear.geometry.skew_line import SkewLine
from facegear.mechanics import cases
from facegear.mechanics.classical_pairs import GearPair
from facegear.mechanics.contact import SKEW_LINE, Contact
from facegear.mechanics.disk import shape_vector, unit_shape
from facegear.mechanics.gearboxes import FIGURES
from facegear.mechanics.properties import MeshLoad
from facegear.mechanics.torsional import Torsional
from facegear.mechanics.transverse import Transverse

LOAD = MeshLoad(1.0, 3e-6, 1.0)
BOX = FIGURES["7.12a"].gearbox.in_si
SPEED = 60.0


def transverse(ratio, rate="frozen"):
    return Transverse(cases.CASE_1, LOAD, contact=Contact(contact_ratio=ratio, rate=rate)).system(SPEED)


def torsional(ratio, path):
    return Torsional(BOX, replace(SKEW_LINE, path=path, contact_ratio=ratio)).system(SPEED)


SYSTEMS = {
    "frozen": transverse,
    "total": lambda ratio: transverse(ratio, "total"),
    **{
        name: lambda ratio, path=path: torsional(ratio, path)
        for name, path in (("skew_line", SkewLine), ("contact_path", ContactPath), ("centroid", CentroidPath))
    },
    "gear pair": lambda ratio: GearPair(ratio, pair_damping=0.1).system(0.9),
}
EVERYWHERE = [
    (name, whole) for name in SYSTEMS for whole in (1, 2) if whole > 1 or name not in ("total", "centroid")
]


@pytest.mark.parametrize(("name", "whole"), EVERYWHERE)
def test_growth_is_continuous_through_a_whole_ratio(name, whole):
    def growth(ratio):
        return growth_rate(SYSTEMS[name](ratio))

    at = growth(float(whole))
    size = abs(at)
    sides = (1.0,) if whole == 1 else (1.0, -1.0)
    for side in sides:
        for beside in (1e-13, 1.1e-12, 0.9e-9, 2e-9):
            assert growth(whole + side * beside) == pytest.approx(at, rel=1e-7)
        # The change goes with the distance, so that its limit is the value at the whole number itself.
        near, far = (growth(whole + side * distance) - at for distance in (1e-6, 1e-4))
        assert abs(near) < 1e-4 * size
        assert near == pytest.approx(1e-2 * far, rel=0.1, abs=1e-9 * size)


@pytest.mark.parametrize("beside", [0.0, 1e-13, 2e-9, 1e-6])
def test_at_ratio_one_the_load_follows_the_only_pair(beside):
    body, ratio = cases.CASE_1, 1.0 + beside
    (shape,) = Transverse(body, LOAD, contact=Contact(contact_ratio=ratio)).shapes
    # Fractions at which a single pair is in mesh, from its entry, which lies beyond the rim.
    x = np.array([1e-5, 1e-3, 0.1, 0.4, 0.8, 0.999])
    point = ContactPath(body.drive, ratio).contact_point(x / ratio)
    assert point.radius[0] > body.outer_radius
    expected = unit_shape(body.modes, point.radius / body.outer_radius, point.angle) / body.outer_radius
    np.testing.assert_allclose(shape(x), expected, rtol=0, atol=1e-11 * np.abs(expected).max())


@pytest.mark.parametrize("ratio", [1.0, 1.0 + 1e-13, 1.0 + 1e-6, 1.0009])
def test_what_follows_the_centroid_back_in_no_time_is_refused_at_once(ratio):
    with pytest.raises(ValueError, match=r"contact_ratio must be at least 1\.001 for rate = 'total'.*got 1"):
        Transverse(cases.CASE_1, LOAD, contact=Contact(contact_ratio=ratio, rate="total"))
    with pytest.raises(ValueError, match=r"contact_ratio must be at least 1\.001 for rate = 'total'"):
        torsional(ratio, CentroidPath)


def test_a_point_off_the_disk_is_refused_where_it_is_asked_for():
    for radius in (0.999 * cases.CASE_1.bore_radius, 1.0001 * cases.CASE_1.outer_radius):
        with pytest.raises(ValueError, match="radius must lie on the disk"):
            shape_vector(cases.CASE_1, radius, 0.0)
