"""Teeth as plates: their deflection against beams and thin plates, their contact against its own conditions."""

from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import quad

from facegear.geometry.drive import Drive
from facegear.geometry.point_contact import ALIGNED, Misalignment
from facegear.mechanics.compliance import Lines, PairCompliance, SliceCompliance
from facegear.mechanics.contact import Contact
from facegear.mechanics.loaded_contact import LoadedContact
from facegear.mechanics.paths import loaded_contact
from facegear.mechanics.slices import Slices
from facegear.mechanics.tooth_plate import (
    CantileverPlate,
    GearTooth,
    Load,
    PinionTooth,
    PlateCompliance,
    local_compliance,
)
from facegear.support.parameters import STEEL

DRIVE = Drive(26, 130, 3.175e-3, shaper_teeth=27)
SLICES = Slices(DRIVE)
AGES = np.linspace(0.05, SLICES.sweep - 0.05, 40)
TIMES = np.linspace(0.0, 1.0, 24, endpoint=False) + 0.01


@lru_cache
def contact(torque, compliance="plate", **fields):
    return LoadedContact(DRIVE, torque, compliance=compliance, **fields)


def of_law(torque, law):
    """Contact under a law that is made by hand."""
    made = LoadedContact(DRIVE, torque, compliance="plate")
    made.__dict__["_law"] = law
    return made


# --- plates ---------------------------------------------------------------------------------------------------


def across(height, position):
    # Unit loads square to a plate.
    places = np.broadcast_arrays(np.asarray(height, dtype=float), np.asarray(position, dtype=float))
    return Load(*places, np.ones(places[0].shape), np.zeros(places[0].shape), np.zeros(places[0].shape))


def constant(thickness, width, poissons_ratio, *degrees):
    return CantileverPlate(
        1.0,
        (-0.5 * width, 0.5 * width),
        lambda h, u: np.full_like(h, thickness),
        2e11,
        poissons_ratio,
        *degrees,
    )


@pytest.mark.parametrize(("poissons_ratio", "width", "error"), [(0.0, 2.0, 1e-11), (0.3, 20.0, 1e-3)])
def test_a_line_load_at_the_tip_bends_a_plate_as_timoshenkos_beam(poissons_ratio, width, error):
    thickness, plate = 0.3, constant(0.3, width, poissons_ratio, 5, 24)
    u, weights = np.polynomial.legendre.leggauss(32)
    u, weights = 0.5 * width * u, 0.5 * width * weights
    middle = (plate.influence(across([1.0], [0.0]), across(np.ones(32), u)) @ weights).item()
    rigidity = 2e11 * thickness**3 / (12.0 * (1.0 - poissons_ratio**2))
    shear = 5.0 / 6.0 * 2e11 / (2.0 * (1.0 + poissons_ratio)) * thickness
    assert_allclose(middle, 1.0 / (3.0 * rigidity) + 1.0 / shear, rtol=error)


def long_thin_plate(poissons_ratio):
    """Return w D/(P h²) under a force on the free edge of an endless Kirchhoff plate, from its Fourier integral."""

    def amplitude(k):
        c, s = np.cosh(k), np.sinh(k)
        # Clamped at 0: sinh kx − kx cosh kx, and kx sinh kx; their derivatives at the free edge over powers of k.
        value = np.array([s - k * c, k * s])
        first = np.array([-k * s, s + k * c])
        second = np.array([-s - k * c, 2.0 * c + k * s])
        third = np.array([-2.0 * c - k * s, 3.0 * s + k * c])
        moment = second - poissons_ratio * value
        force = third - (2.0 - poissons_ratio) * first
        return value @ np.linalg.solve(np.stack([moment, force]), [0.0, -1.0]) / k**3

    return quad(amplitude, 1e-3, 60.0, limit=200)[0] / np.pi + 1e-3 * amplitude(1e-3) / np.pi


@pytest.mark.parametrize("poissons_ratio", [0.0, 0.3])
def test_a_force_on_a_thin_wide_plate_moves_its_edge_as_fouriers_integral_says(poissons_ratio):
    plate = constant(0.02, 5.0, poissons_ratio, 7, 26)
    rigidity = 2e11 * 0.02**3 / (12.0 * (1.0 - poissons_ratio**2))
    tip = across([1.0], [0.0])
    assert_allclose(plate.influence(tip, tip).item() * rigidity, long_thin_plate(poissons_ratio), rtol=0.02)


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


# --- teeth ----------------------------------------------------------------------------------------------------


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


# --- contact --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("torque", [10.0, 2000.0])
def test_without_plates_slices_give_way_each_for_itself(torque):
    slices = contact(torque, "slice")
    bedding = DRIVE.face_width / slices.pair_stiffness
    law = PlateCompliance(SLICES, slices.pair_stiffness, bedding, (), 1.0)
    inner, outer = SLICES.ends(AGES)
    lines = Lines(inner, outer, AGES)
    for approach in (1e-8, 1e-6, 1e-5, 1e-4):
        one, other = (either.force(np.full(AGES.shape, approach), lines) for either in (law, slices._law))
        assert_allclose(one, other, rtol=1e-12, atol=1e-12 * other[0].max())
    beds = of_law(torque, law)
    assert_allclose(beds.contact_ratio, slices.contact_ratio, rtol=1e-11)
    assert_allclose(beds.transmission_error(TIMES), slices.transmission_error(TIMES), rtol=2e-12)
    assert_allclose(beds.mesh_stiffness(TIMES), slices.mesh_stiffness(TIMES), rtol=1e-10)
    for one, other in zip(beds.pairs(TIMES), slices.pairs(TIMES), strict=True):
        assert_allclose(one, other, rtol=1e-10, atol=1e-10 * np.abs(other).max())


@pytest.mark.parametrize(
    "torque",
    [
        1.0,
        100.0,
        5000.0,
        pytest.param(1e-3, marks=pytest.mark.slow),
        pytest.param(300.0, marks=pytest.mark.slow),
    ],
)
def test_pairs_carry_the_torque_and_press_without_sticking_or_sinking_in(torque):
    plates = contact(torque)
    assert_allclose(plates.pairs(TIMES).force.sum(axis=0), plates.force, rtol=1e-10)
    ages = TIMES + plates._mesh[0]
    lines = plates._lines(plates._all_pairs(ages))
    approach = np.broadcast_to(plates._approach(ages), lines.inner.shape)
    inner, outer = lines.inner[..., np.newaxis], lines.outer[..., np.newaxis]
    reach = np.sqrt(approach)[..., np.newaxis]
    near = np.clip(inner, -reach, reach), np.clip(outer, -reach, reach)
    steps = np.linspace(1e-9, 1.0 - 1e-9, 201)
    # Over whole lines, and closer where flanks are nearer than the approach.
    s = np.sort(
        np.concatenate([inner + (outer - inner) * steps, near[0] + (near[1] - near[0]) * steps], axis=-1)
    )
    pressure, overlap = plates._law.pressure(approach, lines, s), plates._law.overlap(approach, lines, s)
    there = np.broadcast_to(inner < outer, s.shape)
    assert pressure.min() >= 0.0
    # Next to a free end both are 0 to rounding.
    assert overlap[there & (pressure == 0.0)].max(initial=-1.0) < 1e-12 * approach.max()
    assert overlap[pressure > 0.0].min() > 0.0
    force, _ = plates._law.force(approach, lines)
    assert_allclose(np.trapezoid(pressure, SLICES.position(s), axis=-1), force, atol=1e-3 * plates.force)


def test_an_end_that_newtons_rule_sends_to_and_fro_settles():
    # Of a pair whose line ends a little beyond what is within reach; whole steps would repeat for ever.
    ratio = contact(269.77225742247344).contact_ratio
    assert contact(269.0).contact_ratio < ratio < contact(270.5).contact_ratio


@pytest.mark.parametrize("torque", [1.0, 100.0])
def test_stiffness_is_the_growth_of_force(torque):
    law, ages = contact(torque)._law, np.linspace(0.2, 3.0, 15)
    inner, outer = SLICES.ends(ages)
    lines, approach = Lines(inner, outer, ages), contact(torque)._approach(ages)
    step = 1e-4 * approach
    more, less = (law.force(approach + sign * step, lines)[0] for sign in (1.0, -1.0))
    stiffness = law.force(approach, lines)[1]
    assert_allclose((more - less) / (2.0 * step), stiffness, rtol=1e-4, atol=1e-4 * stiffness.max())


def test_series_hold_what_each_instant_gives():
    plates = contact(100.0)
    ages = TIMES + plates._mesh[0]
    assert_allclose(plates.transmission_error(TIMES), plates._approach(ages), rtol=1e-11)


def test_between_slices_and_rigid_teeth():
    """All three with the same stiffness of a pair pressed over the whole face, as lines in mesh have it in the mean.

    Contact ratios and mean approaches lie between at any load, mean stiffness as long as contact spreads with load:
    slices come to the ends of their lines before plates, which bend away there.
    """
    for torque in (1.0, 100.0, 1000.0):
        plates = contact(torque)
        stiffness = plates._law.pair_stiffness
        soft, rigid = (of_law(torque, law(SLICES, stiffness)) for law in (SliceCompliance, PairCompliance))
        assert rigid.contact_ratio < plates.contact_ratio <= soft.contact_ratio
        errors = [law.transmission_error(TIMES).mean() for law in (rigid, plates, soft)]
        assert errors == sorted(errors)
        mean = [law.mesh_stiffness(TIMES).mean() for law in (soft, plates, rigid)]
        assert mean[1] < mean[2]
        assert mean[0] < mean[1] * (1.0 if torque < 500.0 else 1.002)


def test_lines_pressed_from_end_to_end_keep_their_stiffness():
    heavy, heavier = contact(5000.0), contact(8000.0)
    assert_allclose(heavy.contact_ratio, SLICES.sweep, rtol=1e-12)
    assert_allclose(heavy.mesh_stiffness(TIMES), heavier.mesh_stiffness(TIMES), rtol=1e-9)
    # As the mean over lines says, weighted by length: pairs one period apart are in mesh together.
    lengths = np.subtract(
        *(SLICES.position(end) for end in heavy._lines(heavy._all_pairs(TIMES))[1::-1])
    ).sum(axis=0)
    mean = heavy.mesh_stiffness(np.linspace(0.0, 1.0, 400, endpoint=False)).mean()
    assert_allclose(mean * DRIVE.face_width / lengths.mean(), heavy._law.pair_stiffness, rtol=2e-3)


def test_bodies_make_the_teeth_softer_as_a_factor():
    stiffness = [contact(1.0, correction_factor=factor)._law.pair_stiffness for factor in (0.25, 1.0)]
    assert_allclose(stiffness[1] / stiffness[0], 4.0, rtol=1e-12)
    # All lengths scale with the approach: half of the factor is twice the torque.
    one, other = contact(100.0, correction_factor=0.5), contact(50.0, correction_factor=0.25)
    assert_allclose(one.transmission_error(TIMES), other.transmission_error(TIMES), rtol=1e-10)


@pytest.mark.parametrize("share", [1e-3, 10.0])
def test_a_softer_material_under_as_much_less_torque_is_in_the_same_contact(share):
    soft = contact(100.0 * share, material=replace(STEEL, youngs_modulus=share * STEEL.youngs_modulus))
    assert_allclose(soft.contact_ratio, contact(100.0).contact_ratio, rtol=1e-12)
    assert_allclose(soft.transmission_error(TIMES), contact(100.0).transmission_error(TIMES), rtol=1e-10)


@pytest.mark.parametrize("gear_teeth", [80, 130])
def test_an_edge_that_does_not_reach_to_the_pitch_circle_leaves_a_plate(gear_teeth):
    drive = Drive(26, gear_teeth, 3.175e-3, shaper_teeth=28, shaft_angle=np.radians(120.0))
    plates = LoadedContact(drive, 100.0, compliance="plate")
    assert plates.slices.contact.contact_ratio < plates.contact_ratio < plates.slices.sweep
    assert_allclose(plates.pairs(TIMES).force.sum(axis=0), plates.force, rtol=1e-10)


@pytest.mark.slow
def test_more_polynomials_change_little():
    # The error falls as a power of their number: across a line of load the shear jumps.
    ages, plates = np.linspace(0.0, 0.9, 5), contact(100.0)
    lines, near = plates._lines(plates._all_pairs(ages)), plates._approach(ages)

    def approach(*degrees):
        teeth = PinionTooth(SLICES, STEEL, *degrees), GearTooth(SLICES, STEEL, *degrees)
        return replace(plates._law, teeth=teeth).equilibrium(plates.force, near, lines)

    found = np.array([approach(*n) for n in ((4, 6), (6, 12), (8, 20))])
    errors = np.abs(found[:-1] / found[-1] - 1.0).max(axis=1)
    assert errors[1] < 0.02
    assert errors[1] < 0.5 * errors[0]


@pytest.mark.parametrize(
    "misalignment",
    [ALIGNED, pytest.param(Misalignment(offset=2e-5, shaft_angle=2e-4), marks=pytest.mark.slow)],
)
def test_pressure_is_that_of_the_law(misalignment):
    plates = contact(100.0, **({} if misalignment == ALIGNED else {"misalignment": misalignment}))
    ends = plates._law.teeth[0].plate.ends
    u = np.linspace(*ends, 2001)
    carried = np.trapezoid(plates.pressure(0.3, u), u, axis=-1)
    assert_allclose(carried, plates.pairs(0.3).force, atol=2e-3 * plates.force)


def test_a_path_takes_plates():
    path = loaded_contact(torque=5000.0, compliance="plate")
    assert_allclose(Contact(path=path).ratio(DRIVE), contact(5000.0).contact_ratio, rtol=1e-12)
