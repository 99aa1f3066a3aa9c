"""Teeth as plates: as thick as their flanks are apart, loads square to these, strain below the contact."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import quad

from facegear.geometry.drive import Drive
from facegear.mechanics.elastic_teeth import GearTooth, PinionTooth, local_compliance
from facegear.mechanics.properties import STEEL
from facegear.mechanics.slices import Slices

DRIVE = Drive(26, 130, 3.175e-3, shaper_teeth=27)
SLICES = Slices(DRIVE)


@pytest.mark.parametrize("tooth", [PinionTooth(SLICES, STEEL), GearTooth(SLICES, STEEL)])
def test_what_a_force_moves_elsewhere_a_force_there_moves_here(tooth):
    loads = tooth.load(*SLICES.generated(np.array([-0.003, 0.0, 0.002]), np.array([2.2, 1.6, 1.1])))
    influence = tooth.plate.influence(loads, loads)
    assert_allclose(influence, influence.T, rtol=1e-12)
    assert np.all(np.linalg.eigvalsh(influence) > 0.0)
    # The work of a force is twice the energy of the plate: its stiffness solved for directly.
    size, x, y = tooth.plate.height, 2.0 * loads.height / tooth.plate.height - 1.0, loads.position
    y = (2.0 * y - sum(tooth.plate.ends)) / np.subtract(*tooth.plate.ends[::-1])
    rows = (1.0 + x[:, np.newaxis]) / 2.0 * np.polynomial.legendre.legvander(x, tooth.across - 1)
    columns = np.polynomial.legendre.legvander(y, tooth.along - 1)
    products = (rows[:, :, np.newaxis] * columns[:, np.newaxis, :]).reshape(3, -1)
    work = [part[:, np.newaxis] * products for part in (loads.across, loads.up / size, loads.along / size)]
    force = np.concatenate(work, axis=1)
    assert_allclose(influence, force @ np.linalg.solve(tooth.plate.stiffness, force.T), rtol=1e-9)


def test_the_pinions_tooth_has_half_a_pitch_on_the_pitch_circle():
    tooth, radius, quarter = PinionTooth(SLICES, STEEL), DRIVE.pitch_radius, 0.5 * np.pi / DRIVE.pinion_teeth
    root = DRIVE.dedendum_radius * np.cos(np.pi / DRIVE.pinion_teeth - DRIVE.space_half_angle)
    height = np.array([radius * np.cos(quarter) - root])
    assert_allclose(tooth.thickness(height, height), 2.0 * radius * np.sin(quarter), rtol=1e-6)


def test_the_gears_tooth_is_as_thick_as_its_flank_lies_from_its_middle():
    tooth, flank = GearTooth(SLICES, STEEL), DRIVE.generating.tooth_flank(9, 7)
    q = np.arccos(DRIVE.generating.contact_region.position(0.0) / flank.position)
    load = tooth.load(q, flank.roll)
    chord = 2.0 * np.abs(flank.points[..., 0])
    assert_allclose(
        tooth.thickness(load.height, load.position), np.maximum(chord, 0.05 * DRIVE.module), rtol=1e-9
    )
    top = tooth.thickness(np.full(5, tooth.height), flank.position[:-4, 0])
    assert_allclose(top, DRIVE.top_thickness(flank.position[:-4, 0]), rtol=1e-4)


def test_forces_on_the_gears_tooth_are_square_to_its_flank():
    tooth, flank = GearTooth(SLICES, STEEL), DRIVE.generating.tooth_flank(41, 21)
    along, up = np.gradient(flank.points, axis=0), np.gradient(flank.points, axis=1)
    normal = np.cross(along, up)[10:-10:5, 5:-5:3]
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    q = np.arccos(DRIVE.generating.contact_region.position(0.0) / flank.position[10:-10:5, 5:-5:3])
    load = tooth.load(q, flank.roll[10:-10:5, 5:-5:3])
    half = np.abs(flank.points[10:-10:5, 5:-5:3, 0])
    # In Γ2 the face runs along −y and the tooth stands up along z.
    force = np.stack([load.across, load.along / half, -load.up / half], axis=-1)
    assert_allclose(np.abs((force * normal).sum(axis=-1)), 1.0, atol=1e-3)


def test_flanks_give_way_next_to_the_contact_as_strain_under_hertzs_pressure_adds_up():
    modulus, poissons_ratio = STEEL.youngs_modulus, STEEL.poissons_ratio
    region = SLICES.contact
    middle = np.array(region.pressure_angle), np.array(0.5 * region.rolls.sum())
    plane = modulus / (1.0 - poissons_ratio**2)
    width = 4.0 * 1e9 / (region.principal_curvatures[1] * plane)
    ratio = poissons_ratio / (1.0 - poissons_ratio)

    def strain(z):
        """Plane strain below the middle of the contact, over p0 (Johnson, section 4.2)."""
        root = np.hypot(width, z)
        sideways = (width**2 + 2.0 * z**2) / root / width - 2.0 * z / width
        return (width / root - ratio * sideways) / plane

    total = 0.0
    for tooth in (PinionTooth(SLICES, STEEL), GearTooth(SLICES, STEEL)):
        load = tooth.load(*middle)
        half = np.hypot(load.up, load.along) / np.sqrt(1.0 - load.across**2)
        total += quad(strain, 0.0, float(half / np.abs(load.across)), points=[width])[0]
    # Both are deep against the width, as the formula takes them.
    assert_allclose(local_compliance(SLICES, STEEL), total * 1e9 / (0.5 * np.pi * width * 1e9), rtol=2e-3)
