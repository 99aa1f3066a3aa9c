"""The clock of mesh periods."""

import math

import pytest

from facegear.geometry.drive import Drive
from facegear.geometry.timed_pairs import mesh_period

CASE_I = Drive(26, 130, 3.175e-3)


def test_mesh_period_is_3_20():
    assert mesh_period(CASE_I, 100.0) == pytest.approx(2 * math.pi / 13000.0, rel=1e-15)
    for speed in (0, -1.0, math.nan, math.inf):
        with pytest.raises(ValueError, match="speed must be"):
            mesh_period(CASE_I, speed)
    with pytest.raises(TypeError, match="speed must be a real number"):
        mesh_period(CASE_I, "1000 rpm")
