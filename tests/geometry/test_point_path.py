"""Path of the unloaded contact: on its own clock, found once."""

from dataclasses import replace

import numpy as np
import pytest

from facegear.geometry.action_path import ActionPath
from facegear.geometry.drive import Drive
from facegear.geometry.point_contact import UnloadedContact
from facegear.geometry.point_path import PointPath
from facegear.mechanics.contact import Contact
from facegear.mechanics.paths import point_contact

CASE_ONE = Drive(26, 130, 3.175e-3, shaper_teeth=27)


def test_path_on_its_own_clock():
    """Each pair runs along the line of action at one u, from the gear's tooth top to the pinion's tip."""
    contact = UnloadedContact(CASE_ONE)
    path = PointPath(CASE_ONE, contact.contact_ratio)
    x = np.linspace(0.0, 0.999, 7)
    states = path.pair_states(x)
    assert states.in_contact.sum() == sum(1 + (value < contact.contact_ratio - 1.0) for value in x)
    there = states.in_contact[0]
    # At 90° the radius is that of u and of x_m = r_bs (sin q − θs cos q) beside it.
    roll = np.interp(x, [0.0, contact.contact_ratio], contact.rolls)
    q, base = contact.pressure_angle, CASE_ONE.generating.base_radius
    beside = base * (np.sin(q) - roll * np.cos(q))
    np.testing.assert_allclose(states.radius[0], np.hypot(contact.position, beside)[there], rtol=1e-12)
    np.testing.assert_allclose(states.angle[0], np.arctan2(beside, contact.position)[there], atol=1e-12)
    # The line of action is swept with the base circle's speed.
    (place, _) = Contact(path=PointPath, sharing="each", contact_ratio=contact.contact_ratio).places(CASE_ONE)
    np.testing.assert_allclose(place.position(x)[:, 1], states.angle[0], atol=1e-11)
    with pytest.raises(ValueError, match='sharing must be "mean" or "each" for PointPath'):
        Contact(path=PointPath).require(CASE_ONE)
    with pytest.raises(ValueError, match="shaper_teeth must exceed"):
        PointPath(Drive(26, 130, 3.175e-3))


def test_the_contact_of_a_drive_is_found_once_for_its_paths(monkeypatch):
    found, fault = [], ActionPath.fault
    monkeypatch.setattr(ActionPath, "fault", lambda contact: found.append(contact) or fault(contact))
    drive = replace(CASE_ONE, module=3.3e-3)
    for path in (point_contact(drive), PointPath(drive, 1.5)):
        path.pair_states(0.25)
    assert len(found) == 1
