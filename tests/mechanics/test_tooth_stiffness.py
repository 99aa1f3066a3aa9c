"""Stiffness of teeth against the captions of chapter 7 and a beam."""

import math

import pytest

from facegear.mechanics.gearboxes import DRIVE
from facegear.mechanics.tooth_stiffness import DEDENDUM, mesh_stiffness, tooth_stiffness


def test_printed_mesh_stiffness():
    # Captions of Figs 7.8 to 7.13
    assert mesh_stiffness(DRIVE, 0.5) == pytest.approx(1.58e8, abs=0.005e8)
    assert mesh_stiffness(DRIVE, 0.1) == pytest.approx(3.15e7, abs=0.005e7)


def test_tooth_stiffness_is_that_of_a_cantilever():
    # A beam of length l = a_g + H, width L and thickness c_p/2 under a tip force: 3 E I/l³. The force acts at α_c to
    # the beam's normal, which (7-1) counts once.
    length, thickness = (1 + DEDENDUM) * DRIVE.module, math.pi * DRIVE.module / 2
    second_moment = DRIVE.face_width * thickness**3 / 12
    beam = 3 * 200e9 * second_moment / length**3
    assert tooth_stiffness(DRIVE) == pytest.approx(beam / math.cos(DRIVE.pressure_angle), rel=1e-12)
