"""Teeth as plates in contact: the law against its own conditions, and between the laws at its ends."""

from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest
from numpy.testing import assert_allclose

from facegear.geometry.drive import Drive
from facegear.geometry.misalignment import ALIGNED, Misalignment
from facegear.mechanics.compliance import Lines, PairCompliance, SliceCompliance
from facegear.mechanics.contact import Contact
from facegear.mechanics.elastic_teeth import GearTooth, PinionTooth
from facegear.mechanics.loaded_contact import LoadedContact
from facegear.mechanics.paths import loaded_contact
from facegear.mechanics.plate_compliance import PlateCompliance
from facegear.mechanics.properties import STEEL
from facegear.mechanics.slices import Slices

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
    made.__dict__["cycle"] = replace(made.cycle, law=law)
    return made


@pytest.mark.parametrize("torque", [10.0, 2000.0])
def test_without_plates_slices_give_way_each_for_itself(torque):
    slices = contact(torque, "slice")
    bedding = DRIVE.face_width / slices.pair_stiffness
    law = PlateCompliance(SLICES, slices.pair_stiffness, bedding, (), 1.0)
    inner, outer = SLICES.ends(AGES)
    lines = Lines(inner, outer, AGES)
    for approach in (1e-8, 1e-6, 1e-5, 1e-4):
        one, other = (
            either.force(np.full(AGES.shape, approach), lines) for either in (law, slices.cycle.law)
        )
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
    ages = TIMES + plates.cycle.first
    lines = plates.cycle.lines(plates.cycle.all_pairs(ages))
    approach = np.broadcast_to(plates.cycle.approach(ages), lines.inner.shape)
    inner, outer = lines.inner[..., np.newaxis], lines.outer[..., np.newaxis]
    reach = np.sqrt(approach)[..., np.newaxis]
    near = np.clip(inner, -reach, reach), np.clip(outer, -reach, reach)
    steps = np.linspace(1e-9, 1.0 - 1e-9, 201)
    # Over whole lines, and closer where flanks are nearer than the approach.
    s = np.sort(
        np.concatenate([inner + (outer - inner) * steps, near[0] + (near[1] - near[0]) * steps], axis=-1)
    )
    pressure, overlap = (
        plates.cycle.law.pressure(approach, lines, s),
        plates.cycle.law.overlap(approach, lines, s),
    )
    there = np.broadcast_to(inner < outer, s.shape)
    assert pressure.min() >= 0.0
    # Next to a free end both are 0 to rounding.
    assert overlap[there & (pressure == 0.0)].max(initial=-1.0) < 1e-12 * approach.max()
    assert overlap[pressure > 0.0].min() > 0.0
    force, _ = plates.cycle.law.force(approach, lines)
    assert_allclose(np.trapezoid(pressure, SLICES.position(s), axis=-1), force, atol=1e-3 * plates.force)


def test_an_end_that_newtons_rule_sends_to_and_fro_settles():
    # Of a pair whose line ends a little beyond what is within reach; whole steps would repeat for ever.
    ratio = contact(269.77225742247344).contact_ratio
    assert contact(269.0).contact_ratio < ratio < contact(270.5).contact_ratio


@pytest.mark.parametrize("torque", [1.0, 100.0])
def test_stiffness_is_the_growth_of_force(torque):
    law, ages = contact(torque).cycle.law, np.linspace(0.2, 3.0, 15)
    inner, outer = SLICES.ends(ages)
    lines, approach = Lines(inner, outer, ages), contact(torque).cycle.approach(ages)
    step = 1e-4 * approach
    more, less = (law.force(approach + sign * step, lines)[0] for sign in (1.0, -1.0))
    stiffness = law.force(approach, lines)[1]
    assert_allclose((more - less) / (2.0 * step), stiffness, rtol=1e-4, atol=1e-4 * stiffness.max())


def test_series_hold_what_each_instant_gives():
    plates = contact(100.0)
    ages = TIMES + plates.cycle.first
    assert_allclose(plates.transmission_error(TIMES), plates.cycle.approach(ages), rtol=1e-11)


def test_between_slices_and_rigid_teeth():
    """All three with the same stiffness of a pair pressed over the whole face, as lines in mesh have it in the mean.

    Contact ratios and mean approaches lie between at any load, mean stiffness as long as contact spreads with load:
    slices come to the ends of their lines before plates, which bend away there.
    """
    for torque in (1.0, 100.0, 1000.0):
        plates = contact(torque)
        stiffness = plates.cycle.law.pair_stiffness
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
        *(SLICES.position(end) for end in heavy.cycle.lines(heavy.cycle.all_pairs(TIMES))[1::-1])
    ).sum(axis=0)
    mean = heavy.mesh_stiffness(np.linspace(0.0, 1.0, 400, endpoint=False)).mean()
    assert_allclose(mean * DRIVE.face_width / lengths.mean(), heavy.cycle.law.pair_stiffness, rtol=2e-3)


def test_bodies_make_the_teeth_softer_as_a_factor():
    stiffness = [contact(1.0, correction_factor=factor).cycle.law.pair_stiffness for factor in (0.25, 1.0)]
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
    lines, near = plates.cycle.lines(plates.cycle.all_pairs(ages)), plates.cycle.approach(ages)

    def approach(*degrees):
        teeth = PinionTooth(SLICES, STEEL, *degrees), GearTooth(SLICES, STEEL, *degrees)
        return replace(plates.cycle.law, teeth=teeth).equilibrium(plates.force, near, lines)

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
    ends = plates.cycle.law.teeth[0].plate.ends
    u = np.linspace(*ends, 2001)
    carried = np.trapezoid(plates.pressure(0.3, u), u, axis=-1)
    assert_allclose(carried, plates.pairs(0.3).force, atol=2e-3 * plates.force)


def test_a_path_takes_plates():
    path = loaded_contact(torque=5000.0, compliance="plate")
    assert_allclose(Contact(path=path).ratio(DRIVE), contact(5000.0).contact_ratio, rtol=1e-12)
