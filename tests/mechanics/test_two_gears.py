"""Two gears that share pinions: symmetry, assembly, the flanks of driven pinions, an independent route."""

from dataclasses import dataclass, fields, replace

import numpy as np
import pytest

import facegear as fg
from facegear.design.envelope import disk_growth_rate
from facegear.floquet.loads import ContactLoad
from facegear.floquet.modes import natural_exponents
from facegear.floquet.multipliers import growth_rate, multipliers
from facegear.floquet.periodic import PeriodicSystem
from facegear.geometry.kinematics import ContactPath
from facegear.geometry.timed_pairs import mesh_period
from facegear.mechanics.contact import Contact
from facegear.mechanics.disk import disk_matrices, mirror_signs
from facegear.mechanics.mesh_oscillator import FOLLOWED, MeshOscillator
from facegear.mechanics.pressed_points import PressedPoints, Spread
from facegear.mechanics.spreads import ContactPoints, FaceStrip, ToothPatches
from facegear.mechanics.tooth_stiffness import mesh_stiffness
from facegear.mechanics.two_gears import TwoGears
from tests.independent.complex_galerkin import ComplexDisk, Pinion, Spring
from tests.independent.edge_load import LoadedDisk
from tests.mechanics.test_mesh_oscillator import beyond_the_rim, by_another_route
from tests.mechanics.test_transverse import greatest_distance

DRIVE = fg.Drive(26, 130, 3.175e-3)
ODD = fg.Drive(25, 130, 3.175e-3)
LOAD = fg.MeshLoad(stiffness=0.7, damping=3e-6, mass=1.0)
SPEED = float(fg.rad_per_s(600.0))
FORCE = fg.DrivingForce(power=1e5, pinion_speed=500.0)
TRUE = replace(FOLLOWED, contact_ratio=DRIVE.geometric_contact_ratio)


def gear(teeth=(0,), drive=DRIVE, **changes):
    body = fg.Body(drive, 0.03, nodal_circles=0, nodal_diameters=2)
    angles = tuple(drive.angular_pitch * count for count in teeth)
    settings = {"contact": FOLLOWED, "mesh_stiffness": mesh_stiffness(drive, 0.5), "mesh_damping": 1e-5}
    return MeshOscillator(body, changes.pop("load", LOAD), angles, **(settings | changes))


def distance(one, other, speed=SPEED):
    return greatest_distance(multipliers(one.system(speed)), multipliers(other.system(speed)))


def test_one_input_splits_into_half_a_pinion_and_standing_teeth():
    """Both disks against the pinion, which half of it takes part in; and both alike, while it stands still."""
    own = gear()
    half = gear(load=replace(LOAD, mass=LOAD.mass / 2.0, stiffness=LOAD.stiffness / 2.0))
    (load,) = own.loads
    disk = np.eye(len(disk_matrices(own.body, SPEED)[0]), own.system(SPEED).size)
    standing = ContactLoad(load.shape.transformed(disk), load.stiffness, load.damping, rate="total")
    alike = PeriodicSystem(
        np.eye(len(disk)), *disk_matrices(own.body, SPEED), (standing,), mesh_period(DRIVE, SPEED)
    )
    parts = np.concatenate([multipliers(half.system(SPEED)), multipliers(alike)])
    assert greatest_distance(multipliers(TwoGears(own).system(SPEED)), parts) < 1e-10


def test_the_upper_gear_is_the_lower_one_turned_about_the_axis_of_a_pinion():
    there, turned = TwoGears(gear((0, 31))), TwoGears(gear((0, -31)))
    assert distance(there, turned) < 1e-10
    idle = TwoGears(gear((0, 31)), roles=("input", "idler"))
    assert distance(there, idle) > 1e-4


def test_all_pinions_moved_by_a_tooth_are_where_they_were():
    assert distance(TwoGears(gear((0, 31, 80))), TwoGears(gear((1, 32, 81)))) < 1e-9


def test_an_odd_pinion_meets_the_upper_gear_half_a_period_later():
    even, odd = (TwoGears(gear(drive=drive)).loads for drive in (DRIVE, ODD))
    for loads, phase in ((even, 0.0), (odd, 0.5)):
        below, above = (load.shape.largest for load in loads)
        assert below == pytest.approx(above, rel=1e-9)
        # What both share is the radius, in the mode without nodal diameters.
        fraction = np.linspace(0.0, 1.0, 17)
        lower, upper = (load.shape for load in loads)
        modes = (lower.components - 1) // 2
        np.testing.assert_allclose(
            np.abs(upper(fraction)[:, modes]), np.abs(lower(fraction + phase)[:, 0]), rtol=1e-9
        )


@pytest.mark.parametrize("sharing", ["centroid", "each"])
def test_driven_flanks_are_the_mirror_of_driving_ones_where_a_space_is_upright(sharing):
    """At the rotation φs = 0 all is symmetric about the plane of the axes; from there time runs the other way."""
    contact = replace(TRUE, sharing=sharing)
    sweep = DRIVE.entry_rotation - DRIVE.exit_rotation
    upright = DRIVE.entry_rotation / sweep * DRIVE.geometric_contact_ratio
    after = np.linspace(0.05, 0.95, 7)
    driving, driven = contact.places(DRIVE), contact.coasting_places(DRIVE)
    for one, other in zip(driving, driven, strict=True):
        there, mirror = one.position(upright - after), other.position(upright + after)
        np.testing.assert_allclose(mirror, there * [1.0, -1.0], rtol=0, atol=1e-9)


@pytest.mark.parametrize(
    ("path", "teeth"),
    [(fg.ContactPath, 26), (fg.SkewLine, 26), (fg.point_contact, 27), (fg.loaded_contact(200.0), 27)],
)
def test_flanks_turned_twice_are_those_of_before(path, teeth):
    drive = replace(DRIVE, shaper_teeth=teeth)
    contact = Contact(path=path, sharing="each")
    fraction = np.linspace(0.03, 0.97, 9)
    passage = path(drive, None).pitch_passage
    assert 0.0 < passage < contact.ratio(drive)
    for place in contact.places(drive):
        again = place.coasting(passage).coasting(passage)
        np.testing.assert_allclose(again.position(fraction), place.position(fraction), atol=1e-8)


def test_a_pair_at_the_pitch_point_has_the_pressure_angle_there():
    """Under load as without: the line through the pitch point is the one that the unloaded contact has then."""
    drive = replace(DRIVE, shaper_teeth=27)
    for path in (fg.point_contact(drive), fg.loaded_contact(1e-4, compliance="pair")(drive, None)):
        states = path.pair_states(path.pitch_passage)
        pair = int(path.pitch_passage)
        # The pitch point lies below the pinion's axis, at its pitch radius.
        assert states.angle[pair] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(
    "roles",
    [
        ("input", "idler"),
        pytest.param(("input", "input"), marks=pytest.mark.slow),
        pytest.param(("output", "idler"), marks=pytest.mark.slow),
    ],
)
def test_against_complex_modes_and_dop853(roles):
    own = gear((0, 40.5), contact=replace(TRUE, sharing="each"), force=FORCE)
    path = ContactPath(DRIVE, TRUE.contact_ratio)
    sweep = DRIVE.entry_rotation - DRIVE.exit_rotation
    upright = DRIVE.entry_rotation / sweep * path.contact_ratio
    springs = []
    for number, (angle, role) in enumerate(zip(own.pinion_angles, roles, strict=True)):
        phase = (angle / DRIVE.angular_pitch) % 1.0
        for disk, driving in enumerate({"input": (1, 1), "idler": (1, 0), "output": (0, 0)}[role]):
            sense = (1.0 if driving else -1.0) * (1.0, -1.0)[disk]
            for pair in range(path.pairs):
                springs.append(spring(path, pair, phase, driving, upright, sense, angle, number, disk))
    plain = beyond_the_rim()
    disk = Driven(
        **{each.name: getattr(plain, each.name) for each in fields(ComplexDisk)},
        force=FORCE.newtons(DRIVE),
        angles=own.pinion_angles,
        roles=roles,
    )
    found = by_another_route(own, springs, SPEED, turning=(SPEED, -SPEED), disk=disk)
    assert greatest_distance(found, multipliers(TwoGears(own, roles).system(SPEED))) < 1e-8
    # Far more than that comes from the forces.
    assert (
        greatest_distance(found, multipliers(TwoGears(replace(own, force=None), roles).system(SPEED))) > 1e-4
    )


@dataclass(frozen=True, eq=False)
class Driven(LoadedDisk):
    """Either gear by the sense in which it turns, seen from the lower one."""

    angles: tuple[float, ...] = ()
    roles: tuple[str, ...] = ()

    def load_stiffness(self, speed):
        alone = super().load_stiffness(abs(speed))
        wave = np.repeat(self.waves, self.M + 1)
        total = np.zeros_like(alone)
        for angle, role in zip(self.angles, self.roles, strict=True):
            lower, upper = {"input": (1, 1), "idler": (1, -1), "output": (-1, -1)}[role]
            # Forward is towards growing angles for the lower gear and towards falling ones for the upper.
            pushed = lower if speed > 0.0 else -upper
            total += pushed * np.exp(1j * (wave[None, :] - wave[:, None]) * angle) * alone
        return total


def test_the_upper_gear_is_driven_as_the_lower_one_is():
    """Turned about the axis of the first pinion it is the lower one, its forces included; an idler holds it back."""
    there, turned = TwoGears(gear((0, 31), force=FORCE)), TwoGears(gear((0, -31), force=FORCE))
    assert distance(there, turned) < 1e-10
    size = len(disk_matrices(there.gear.body, SPEED)[0])

    def alone(model):
        system = model.system(SPEED)
        for own in (slice(0, size), slice(size, 2 * size)):
            exponents = natural_exponents(np.eye(size), system.damping[own, own], system.stiffness[own, own])
            yield exponents.real.max()

    lower, upper = alone(there)
    assert lower == pytest.approx(upper, rel=1e-9)
    assert lower == pytest.approx(
        disk_growth_rate(there.gear.body, FORCE, SPEED, angles=there.gear.pinion_angles), rel=1e-9
    )
    idle = TwoGears(there.gear, roles=("input", "idler"))
    for growth, driving in zip(alone(idle), idle.driving, strict=True):
        body = idle.gear.body
        own = disk_growth_rate(body, FORCE, SPEED, angles=driving.angles, senses=driving.senses)
        assert growth == pytest.approx(own, rel=1e-9)
    assert idle.driving[1].senses == (1, -1)


def spring(path, pair, phase, driving, upright, sense, angle, number, disk):
    def states(x):
        return path.pair_states(x + phase if driving else 2.0 * upright - x - phase)

    def position(x):
        there = states(x)
        radius = np.where(there.in_contact[pair], there.radius[pair], DRIVE.outer_radius)
        return radius, sense * there.angle[pair] + angle

    def weight(x):
        return states(x).in_contact[pair].astype(float)

    instants = [(x - phase if driving else 2.0 * upright - phase - x) % 1.0 for x in path.breakpoints]
    return Spring(Pinion(position, [0.0, *sorted(instants)]), weight, number, disk)


@dataclass(frozen=True)
class Beside(Spread):
    """One point beside the pinion's axis."""

    def points(self, drive):
        return PressedPoints(np.array([0.95]), np.array([0.05]), np.ones(1))


@pytest.mark.parametrize("spread", [Beside(), ToothPatches(ContactPoints(Contact()), FaceStrip())])
def test_places_of_forces_are_mirrored_too(spread):
    """A force that presses beside the middle of the mesh does so on the other side above, and on driven flanks."""
    force = replace(FORCE, spread=spread)
    assert distance(TwoGears(gear((0, 31), force=force)), TwoGears(gear((0, -31), force=force))) < 1e-10
    body = gear().body
    signs = mirror_signs(body)
    driven, driving = force.stiffness(body, SPEED, (0.3,), (-1,)), force.stiffness(body, SPEED, (-0.3,))
    np.testing.assert_allclose(driven, np.outer(signs, signs) * driving, rtol=1e-12)
    # That is not the force the other way round, which it is at a point on the axis.
    reverse = -force.stiffness(body, SPEED, (0.3,))
    assert np.abs(driven - reverse).max() > 1e-3 * np.abs(driven).max()
    point, back = (FORCE.stiffness(body, SPEED, (0.3,), (way,)) for way in (1, -1))
    np.testing.assert_allclose(back, -point, rtol=0, atol=1e-9 * np.abs(point).max())


def test_coordinates_say_which_gear_and_which_pinion():
    names = [coordinate.name for coordinate in TwoGears(gear((0, 31))).coordinates]
    assert len(set(names)) == len(names) == 12
    assert names[0].startswith("lower face gear (")
    assert names[-2:] == ["pinion 1", "pinion 2"]


def test_maps_and_tongues_take_it_like_any_model():
    model = TwoGears(gear((0, 31)))
    speeds = np.array([50.0, 60.0])
    chart = fg.stability_map(model, speeds, "gear.mesh_stiffness", [5e7, 1e8], jobs=1)
    cell = growth_rate(fg.replace_parameter(model, "mesh_stiffness", 1e8).system(60.0))
    assert float(chart[1, 1]) == pytest.approx(cell, abs=1e-6)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda: TwoGears("gear"), "gear must be a MeshOscillator, got 'gear'"),
        (
            lambda: TwoGears(gear((0, 31.3))),
            r"differ by whole halves of the angular pitch.*nearest that fits is 1\.52",
        ),
        (
            lambda: TwoGears(gear((0, 31), sides=(1, 1))),
            r"gear.sides must be None between two gears, got \(1, 1\)",
        ),
        (lambda: TwoGears(gear((0, 31), phases=(0.0, 0.1))), "gear.phases must be None"),
        (
            lambda: TwoGears(gear(drive=replace(DRIVE, shaft_angle=1.4))),
            r"gear.body.drive.shaft_angle must be a right angle.*got 1.4 rad",
        ),
        (lambda: TwoGears(gear(clocking=0.5)), "gear.clocking must be 0 between two gears, got 0.5"),
        (
            lambda: TwoGears(gear((0, 31)), roles=("input",)),
            r"roles must list one a pinion, 2, got \('input',\)",
        ),
        (lambda: TwoGears(gear((0, 31)), roles="in"), "roles must list one a pinion, 2, got 'in'"),
        (lambda: TwoGears(gear((0, 31)), roles={"input", "idler"}), "roles must list one a pinion, 2, got {"),
        (lambda: TwoGears(gear(), roles=3), "roles must list one a pinion, 1, got 3"),
        (lambda: TwoGears(gear(), roles=("sun",)), "roles must be 'input' or 'idler' or 'output', got 'sun'"),
        (lambda: TwoGears(gear()).system(0.0), "speed must be greater than 0"),
    ],
)
def test_bad_input(change, message):
    with pytest.raises((TypeError, ValueError), match=message):
        change()
