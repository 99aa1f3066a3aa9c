"""The contact pattern of a torque: every line carries its part, and together they carry the torque."""

import numpy as np
import pytest

import facegear as fg
from facegear.mechanics.contact_pattern import loaded_contact_pattern

DRIVE = fg.Drive(26, 130, 3.175e-3, shaper_teeth=27)


@pytest.mark.parametrize("torque", [10.0, 300.0])
def test_lines_a_mesh_period_apart_carry_the_torque_together(torque):
    contact = fg.LoadedContact(DRIVE, torque=torque)
    lines = 799
    pattern = loaded_contact_pattern(contact, lines=lines, points=801)
    along = np.trapezoid(pattern.pressure.values, pattern.position.values, axis=1)
    age = pattern.age.values
    for start in np.linspace(0.05, 0.95, 7):
        pairs = np.arange(age[0] + start, age[-1], 1.0)
        # Load is even about the middle of a slice of a line, so that sums along lines are those of the force.
        assert np.interp(pairs, age, along).sum() == pytest.approx(torque / DRIVE.base_radius, rel=2e-3)


def test_pressure_is_that_of_the_contact_at_the_same_place():
    contact = fg.LoadedContact(DRIVE, torque=30.0)
    pattern = loaded_contact_pattern(contact, lines=31, points=21)
    row = 15
    same = contact.line_load(pattern.age[row], contact.slices.at(pattern.position.values[row]))
    np.testing.assert_allclose(pattern.pressure.values[row], same.ravel(), rtol=1e-9, atol=1e-3)


@pytest.mark.parametrize("argument", [{"lines": 1}, {"points": 0}, {"lines": 2.5}])
def test_bad_input(argument):
    with pytest.raises((TypeError, ValueError), match=next(iter(argument))):
        loaded_contact_pattern(fg.LoadedContact(DRIVE, torque=30.0), **argument)
