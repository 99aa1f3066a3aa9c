"""Pinions on the springs of their teeth: limits, an independent route, both faces of the disk, sharing by pairs."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import expm

import facegear as fg
from facegear.floquet.band_speeds import band_speeds
from facegear.floquet.models import parameter_names, replace_parameter
from facegear.floquet.multipliers import growth_rate, multipliers
from facegear.geometry.kinematics import ContactPath
from facegear.geometry.timed_pairs import mesh_period
from facegear.mechanics.disk import disk_matrices, disk_modes, modal_mass
from facegear.mechanics.mesh_oscillator import FOLLOWED, MeshOscillator
from facegear.mechanics.sharing import RULES, shared_load
from facegear.mechanics.tooth_stiffness import mesh_stiffness
from tests.independent.complex_galerkin import Pinion, Spring, oscillator_multipliers
from tests.independent.monodromy import fitted_order, integrated
from tests.mechanics.test_transverse import complex_disk, greatest_distance

DRIVE = fg.Drive(26, 130, 3.175e-3)
BODY = fg.Body(DRIVE, 0.03, nodal_circles=0, nodal_diameters=2)
LOAD = fg.MeshLoad(stiffness=0.7, damping=3e-6, mass=1.0)
TEETH = mesh_stiffness(DRIVE, 0.5)
SPEED = float(fg.rad_per_s(600.0))
EACH = replace(FOLLOWED, sharing="each")


def model(**changes):
    return MeshOscillator(
        **({"body": BODY, "load": LOAD, "mesh_stiffness": TEETH, "mesh_damping": 1e-5} | changes)
    )


def distance(one, other, speed=SPEED):
    """Largest distance between the multipliers of two models."""
    return greatest_distance(multipliers(one.system(speed)), multipliers(other.system(speed)))


class TestStiffness:
    @pytest.mark.parametrize(
        "contact",
        [
            FOLLOWED,
            EACH,
            replace(FOLLOWED, sharing="mean"),
            replace(FOLLOWED, path=shared_load("length")),
            *(replace(EACH, path=shared_load(rule)) for rule in RULES),
        ],
    )
    def test_all_pairs_together_have_that_of_the_contact_ratio(self, contact):
        system = model(contact=contact).system(SPEED)
        _, _, stiffness = system.fourier(1)
        expected = (
            DRIVE.contact_ratio * TEETH * math.sin(DRIVE.pressure_angle) ** 2 + model().bearing_stiffness
        )
        assert stiffness.mean[-1, -1] * modal_mass(BODY) == pytest.approx(expected, rel=1e-10)

    def test_bearing_and_teeth_are_springs_in_series(self):
        """At rest the disk feels k_b k_z/(k_b + k_z) at the contact, by elimination of the pinion."""
        oscillator = model(mesh_damping=1e-15)
        stiffness = oscillator.system(SPEED).stiffness_matrix(0.3)
        felt = stiffness[:-1, :-1] - np.outer(stiffness[:-1, -1], stiffness[-1, :-1]) / stiffness[-1, -1]
        _, alone = disk_matrices(BODY, SPEED)
        teeth, bearing = oscillator.axial_stiffness * DRIVE.contact_ratio, oscillator.bearing_stiffness
        (shape,) = oscillator.rigid.shapes
        series = bearing * teeth / (bearing + teeth) / modal_mass(BODY)
        expected = series * np.outer(shape(0.3), shape(0.3))
        np.testing.assert_allclose(felt - alone, expected, rtol=0, atol=1e-7 * np.abs(expected).max())

    def test_forces_on_disk_and_pinions_balance(self):
        """Nothing but the bearings holds disk and pinions together if all move along the axis."""
        rigid_body = fg.Body(DRIVE, 0.03, nodal_circles=0, nodal_diameters=0)
        system = model(body=rigid_body, pinion_angles=(0.0, 2.0), contact=EACH).system(SPEED)
        for load in system.loads:
            values = load.shape(np.linspace(0.0, 1.0, 20, endpoint=False))
            there = np.abs(values).max(axis=1) > 0.0
            assert (np.count_nonzero(values[there][:, 1:], axis=1) == 1).all()
            np.testing.assert_allclose(np.abs(values[there][:, 1:]).max(axis=1), 1.0, rtol=1e-12)


class TestLimits:
    body = replace(BODY, nodal_diameters=1)

    def test_stiff_teeth_are_rigid_ones_with_total_rate(self):
        """To first order in the compliance, kicks included; and by no means with frozen rate."""
        compliance = np.array([2e-12, 1e-12, 5e-13])
        stiff = [model(body=self.body, mesh_stiffness=1.0 / c) for c in compliance]
        away = np.array([distance_to_rigid(each, each.rigid) for each in stiff])
        assert fitted_order(compliance, away) == pytest.approx(1.0, abs=0.02)
        assert away[-1] < 1e-4
        assert stiff[0].rigid.system(SPEED).velocity_kicks()
        frozen = replace(stiff[-1].rigid, contact=replace(FOLLOWED, rate="frozen"))
        assert distance_to_rigid(stiff[-1], frozen) > 100.0 * away[-1]

    def test_without_teeth_disk_and_pinion_go_their_own_ways(self):
        damping, stiffness = disk_matrices(BODY, SPEED)
        period, n = mesh_period(DRIVE, SPEED), len(damping)
        state = np.block([[np.zeros((n, n)), np.eye(n)], [-stiffness, -damping]])
        mass = model().pinion_mass
        pinion = np.array(
            [[0.0, 1.0], np.array([-model().bearing_stiffness, -model().bearing_damping]) / mass]
        )
        alone = np.concatenate([np.linalg.eigvals(expm(a * period)) for a in (state, pinion)])
        soft = np.array([1e4, 5e3, 2.5e3])
        away = [greatest_distance(multipliers(model(mesh_stiffness=k).system(SPEED)), alone) for k in soft]
        assert fitted_order(soft, away) == pytest.approx(1.0, abs=0.02)
        assert away[-1] < 1e-3

    def test_a_mean_point_that_jumps_is_too_fast_for_rigid_teeth_only(self):
        skew = model(contact=fg.Contact(path=fg.SkewLine, sharing="mean", rate="total"))
        system = skew.system(SPEED)
        assert np.abs(system.loads[0].shape.jumps()).max() > 0.1 * system.loads[0].shape.largest
        found = np.linalg.eigvals(integrated(system))
        assert greatest_distance(multipliers(system), found) < 1e-9
        with pytest.raises(ValueError, match=r"mean contact point is followed .* that jumps"):
            _ = skew.rigid


def distance_to_rigid(oscillator, rigid):
    """Largest distance of a multiplier of a rigid model from those of an oscillator, which has two more near 0."""
    found, few = (multipliers(each.system(SPEED)) for each in (oscillator, rigid))
    chosen = np.argsort(np.abs(found))[2:]
    return greatest_distance(found[chosen], few)


# --- another route: complex modes, pinions in metres, DOP853 --------------------------------------------------------


@cache
def beyond_the_rim():
    """Return the disk of the complex form with its modes continued beyond the rim, where a pair enters mesh."""

    def radial(m, n, r):
        return BODY.modes[n].continued(np.asarray(r) / BODY.outer_radius, 0)[m] / BODY.outer_radius

    return replace(complex_disk(BODY), radial=radial)


def rule_by_hand(rule, states, ratio):
    total = states.length.sum(axis=0)
    if rule == "length_share":
        return ratio * states.length / total
    return states.in_contact.astype(float)


def springs(oscillator, pinion, rule, angle, phase, sense=1.0):
    """Every pair under one pinion."""
    ratio = oscillator.contact_ratio
    path = ContactPath(DRIVE, ratio)
    instants = sorted((x - phase) % 1.0 for x in path.breakpoints)
    found = []
    for pair in range(path.pairs):

        def position(x, pair=pair):
            states = path.pair_states(x + phase)
            radius = np.where(states.in_contact[pair], states.radius[pair], DRIVE.outer_radius)
            return radius, sense * (states.angle[pair] + angle)

        def weight(x, pair=pair):
            return rule_by_hand(rule, path.pair_states(x + phase), ratio)[pair]

        found.append(Spring(Pinion(position, [0.0, *instants]), weight, pinion))
    return found


def by_another_route(oscillator, found, speed, turning=None, disk=None):
    stiffness = oscillator.mesh_stiffness * math.sin(DRIVE.pressure_angle) ** 2
    return oscillator_multipliers(
        beyond_the_rim() if disk is None else disk,
        found,
        speed if turning is None else turning,
        mesh_period(DRIVE, speed),
        m_p=oscillator.pinion_mass,
        c_b=oscillator.bearing_damping,
        k_b=oscillator.bearing_stiffness,
        c_z=oscillator.mesh_damping * stiffness,
        k_z=stiffness,
        tolerance=1e-11,
    )


class TestAgainstTheComplexForm:
    def test_one_load_at_the_centroid(self):
        oscillator, path = model(), ContactPath(DRIVE)

        def position(x):
            return path.centroid(x)

        spring = Spring(
            Pinion(position, path.breakpoints), lambda x: np.full(np.shape(x), path.contact_ratio)
        )
        found = by_another_route(oscillator, [spring], SPEED)
        assert greatest_distance(found, multipliers(oscillator.system(SPEED))) < 1e-9

    def test_a_load_for_each_pair_by_its_share(self):
        oscillator = model(contact=replace(EACH, path=shared_load("length_share")))
        speed = float(fg.rad_per_s(900.0))
        found = by_another_route(oscillator, springs(oscillator, 0, "length_share", 0.0, 0.0), speed)
        assert greatest_distance(found, multipliers(oscillator.system(speed))) < 1e-9

    def test_two_pinions_on_the_two_faces_clocked_and_travelling_with_the_disk(self):
        angle, clocking = 40.3 * DRIVE.angular_pitch, 0.4
        oscillator = model(
            pinion_angles=(0.0, angle),
            sides=(1, -1),
            clocking=clocking,
            contact=replace(EACH, travel="with_disk"),
        )
        found = [
            *springs(oscillator, 0, "equal", 0.0, 0.0, -1.0),
            *springs(oscillator, 1, "equal", angle, 0.3 + clocking, -1.0),
        ]
        speed = float(fg.rad_per_s(900.0))
        assert (
            greatest_distance(
                by_another_route(oscillator, found, speed), multipliers(oscillator.system(speed))
            )
            < 1e-9
        )


# --- both faces -----------------------------------------------------------------------------------------------------


BOTH = model(pinion_angles=(0.0, 1.1), sides=(1, -1), clocking=0.3, contact=EACH)


class TestBothFaces:
    def test_clocking_has_the_mesh_period_and_moves_the_back_alone(self):
        assert distance(BOTH, replace(BOTH, clocking=1.3)) < 1e-10
        assert distance(BOTH, replace(BOTH, clocking=0.8)) > 1e-4
        assert distance(replace(BOTH, sides=None), replace(BOTH, sides=None, clocking=0.8)) == 0.0

    @pytest.mark.parametrize("ahead", [0.21, 0.5])
    def test_only_differences_of_phases_matter(self, ahead):
        moved = replace(BOTH, phases=tuple(phase + ahead for phase in BOTH.mesh_phases), clocking=0.0)
        assert distance(BOTH, moved) < 1e-9

    def test_stability_does_not_hang_on_the_sides(self):
        front = replace(BOTH, sides=(1, 1), phases=BOTH.mesh_phases, clocking=0.0)
        assert distance(BOTH, front) < 1e-10

    def test_teeth_parted_alike_on_both_faces_leave_the_disk_where_it_is(self):
        """Not so on one face: there the side decides, because a transmission error has one."""
        wave = fg.PiecewiseChebyshev.fit(lambda x, piece: 1e-6 * np.cos(2.0 * np.pi * x), [0.0])
        load = replace(LOAD, damping=1e-4)
        face = model(pinion_angles=(0.0, 0.0), sides=(1, -1), load=load, contact=FOLLOWED)
        speed = float(fg.rad_per_s(200.0))
        time = np.linspace(0.0, 1.0, 30)

        def moved(oscillator):
            system = fg.Excited(oscillator, transmission_error=wave).system(speed)
            return fg.steady_response(system).displacements(time)

        balanced = moved(face)
        assert growth_rate(face.system(speed)) < 0.0
        np.testing.assert_allclose(
            balanced[:, -1], -balanced[:, -2], atol=1e-9 * np.abs(balanced[:, -1]).max()
        )
        modes = len(disk_modes(BODY))
        same = moved(replace(face, sides=(1, 1), phases=(0.0, 1e-3)))
        deflected = np.abs(same[:, :modes]).max()
        assert deflected > 1e-3 * np.abs(same[:, modes:]).max() * BODY.outer_radius
        assert np.abs(balanced[:, :modes]).max() < 1e-9 * deflected

    def test_half_a_period_apart_rigid_teeth_have_no_odd_orders_and_springs_have(self):
        face = model(pinion_angles=(0.0, 0.0), sides=(1, -1), clocking=0.5)
        order = 5
        for series in face.rigid.system(SPEED).fourier(order):
            waves = np.abs(series.cosine).max(axis=(1, 2)) + np.abs(series.sine).max(axis=(1, 2))
            assert waves[::2].max() < 1e-10 * waves.max()
            assert waves[1] > 0.0
        _, _, stiffness = face.system(SPEED).fourier(order)
        waves = np.abs(stiffness.cosine).max(axis=(1, 2)) + np.abs(stiffness.sine).max(axis=(1, 2))
        assert waves[0] > 1e-2 * waves.max()
        # What is left of them for the disk alone would be nothing again.
        modes = len(disk_modes(BODY))
        own = np.abs(stiffness.cosine[:, :modes, :modes]).max(axis=(1, 2))
        assert own[::2].max() < 1e-10 * own.max()
        # Odd orders join the motion of one pinion against the other with the rest, and nothing else.
        apart = np.eye(modes + 2)
        apart[modes:, modes:] = [[1.0, 1.0], [1.0, -1.0]]
        odd = np.abs(apart.T @ stiffness.cosine[::2] @ apart).max(axis=0)
        assert odd[:-1, :-1].max() < 1e-10 * odd.max()
        assert odd[-1, -1] < 1e-10 * odd.max()

    def test_swapped_pinions_are_clocked_the_other_way(self):
        face = model(pinion_angles=(0.0, 0.0), sides=(1, -1), clocking=0.3)
        assert distance(face, replace(face, clocking=-0.3)) < 1e-9


def test_a_disk_that_turns_the_other_way_is_its_mirror_image():
    there = replace(BOTH, pinion_angles=(0.3, 2.0), contact=replace(EACH, path=shared_load("length")))
    system = there.system(SPEED)
    image = replace(there, contact=replace(there.contact, travel="with_disk")).system(SPEED)
    damping, stiffness = (np.pad(matrix, (0, 2)) for matrix in disk_matrices(BODY, -SPEED))
    for own, matrix in ((system.damping, damping), (system.stiffness, stiffness)):
        matrix[-2:, -2:] = own[-2:, -2:]
    found = multipliers(system)
    assert greatest_distance(multipliers(replace(image, damping=damping, stiffness=stiffness)), found) < 1e-10
    assert greatest_distance(multipliers(image), found) > 1e-4


# --- as any model ---------------------------------------------------------------------------------------------------


class TestAsAnyModel:
    def test_its_numbers_can_be_swept(self):
        names = set(parameter_names(BOTH))
        swept = {"mesh_stiffness", "mesh_damping", "clocking", "load.stiffness", "load.damping", "load.mass"}
        assert swept | {"body.thickness_ratio", "contact.contact_ratio"} <= names
        assert replace_parameter(BOTH, "mass", 0.5).pinion_mass == pytest.approx(0.5 * BOTH.pinion_mass)
        assert replace_parameter(BOTH, "stiffness", 0.5).load.stiffness == 0.5

    @pytest.mark.parametrize("parameter", ["stiffness", "clocking"])
    def test_map(self, parameter):
        face = model(pinion_angles=(0.0, 0.0), sides=(1, -1), clocking=0.25)
        start = {"stiffness": 0.7, "clocking": 0.25}[parameter]
        values, speeds = start * np.array([0.8, 1.0]), fg.rad_per_s(np.array([500.0, 600.0]))
        chart = fg.stability_map(face, speeds, parameter, values, jobs=1, progress=False)
        expected = growth_rate(replace_parameter(face, parameter, values[0]).system(float(speeds[1])))
        assert float(chart[0, 1]) == pytest.approx(expected, abs=1e-8)

    def test_coordinates(self):
        parts = [coordinate.part for coordinate in BOTH.coordinates]
        assert parts == ["face gear"] * 5 + ["pinion 1", "pinion 2"]
        assert model().coordinates[-1].name == "pinion"
        assert BOTH.system(SPEED).size == len(BOTH.coordinates)


@settings(deadline=None, derandomize=True, max_examples=8)
@given(
    stiffness=st.floats(1e5, 1e9),
    damping=st.floats(1e-7, 1e-4),
    mass=st.floats(0.05, 3.0),
    angles=st.lists(st.floats(-6.0, 6.0), min_size=1, max_size=3, unique_by=lambda x: round(x, 3)),
    clocking=st.floats(-2.0, 2.0),
    back=st.integers(0, 7),
    each=st.booleans(),
)
def test_any_drive_has_a_system_that_loses_no_load(stiffness, damping, mass, angles, clocking, back, each):
    sides = tuple(-1 if back >> number & 1 else 1 for number in range(len(angles)))
    small = model(
        body=replace(BODY, nodal_diameters=1),
        load=replace(LOAD, mass=mass),
        pinion_angles=angles,
        sides=sides,
        clocking=clocking,
        contact=EACH if each else FOLLOWED,
        mesh_stiffness=stiffness,
        mesh_damping=damping,
    )
    system = small.system(SPEED)
    time = np.linspace(0.0, 1.0, 25)
    stiff = sum(
        load.stiffness * (load.shape(time)[:, len(disk_modes(small.body)) :] ** 2).sum(axis=1)
        for load in system.loads
    )
    pairs = ContactPath(DRIVE).pair_states
    expected = np.zeros(time.size)
    for phase in small.mesh_phases:
        in_mesh = pairs(time + phase).in_contact.sum(axis=0)
        expected += (
            small.axial_stiffness * (in_mesh if each else DRIVE.contact_ratio) / modal_mass(small.body)
        )
    # An instant at which a pair comes or goes may fall to either side.
    same = np.abs(stiff - expected) < 1e-9 * expected.max()
    assert np.count_nonzero(~same) <= 2 * len(angles)


@pytest.mark.parametrize(
    ("change", "error", "message"),
    [
        ({"body": DRIVE}, TypeError, "body must be a Body"),
        ({"load": 1.0}, TypeError, "load must be a MeshLoad"),
        ({"load": replace(LOAD, mass=0.0)}, ValueError, r"load\.mass must be greater than 0"),
        ({"contact": fg.Contact()}, ValueError, r'contact\.rate must be "total" where .*got \'frozen\''),
        (
            {"contact": replace(FOLLOWED, contact_ratio=1.0)},
            ValueError,
            "contact_ratio must be at least 1.001",
        ),
        ({"mesh_stiffness": 0.0}, ValueError, "mesh_stiffness must be greater than 0"),
        ({"mesh_stiffness": float("inf")}, ValueError, "mesh_stiffness"),
        (
            {"mesh_stiffness": 204.0},
            ValueError,
            r"mesh_stiffness must lie in .*got 204.0 N/m \(N/µm, not N/m\?\)",
        ),
        ({"mesh_stiffness": 1e-300}, ValueError, "mesh_stiffness must lie in"),
        ({"mesh_stiffness": 1e17}, ValueError, "mesh_stiffness must lie in"),
        ({"mesh_stiffness": "stiff"}, TypeError, "mesh_stiffness"),
        (
            {"mesh_damping": 0.0},
            ValueError,
            "mesh_damping must be greater than 0 s, or what rings in stiff teeth",
        ),
        ({"mesh_damping": -1e-6}, ValueError, "mesh_damping must"),
        (
            {"mesh_damping": 0.1},
            ValueError,
            r"must be greater than 0 and at most 0\.01 s, got 0\.1 s \(µs\? 1e-07",
        ),
        ({"mesh_damping": 10}, ValueError, r"at most 0\.01 s, got 10 s \(µs\? 1e-05 would be valid\)"),
        ({"clocking": float("nan")}, ValueError, "clocking must lie in .*got nan"),
        ({"sides": (1, 1)}, ValueError, r"sides must list 1 \(front\) or -1 \(back\) for each of 1 pinions"),
        ({"sides": (0,)}, ValueError, "sides must list 1"),
        ({"sides": 1}, ValueError, "sides must list 1"),
        ({"sides": ("back",)}, (TypeError, ValueError), "sides"),
        (
            {"pinion_angles": (0.0, 0.0)},
            ValueError,
            "pinion_angles must differ from one another on each face",
        ),
        ({"pinion_angles": (0.0, 2 * math.pi)}, ValueError, "pinion_angles must differ"),
        ({"pinion_angles": (0.0, 0.0), "sides": (-1, -1)}, ValueError, "pinion_angles must differ"),
        ({"pinion_angles": (0.0, 0.0), "phases": (0.0, 1.0)}, ValueError, "unless their phases do"),
        ({"pinion_angles": (0.0, 1.0), "phases": (0.0,)}, ValueError, "phases must list one a pinion, 2"),
    ],
)
def test_bad_input(change, error, message):
    with pytest.raises(error, match=message):
        model(**change)


def test_two_pinions_at_one_place():
    assert model(pinion_angles=(0.0, 0.0), sides=(1, -1)).faces == (1, -1)
    assert model(pinion_angles=(0.0, 0.0), phases=(0.0, 0.5)).faces == (1, 1)


def test_a_load_for_each_pair_has_no_rigid_counterpart():
    with pytest.raises(ValueError, match='sharing must be "centroid" or "mean" for one load a pinion'):
        _ = model(contact=EACH).rigid


@pytest.mark.parametrize("speed", [0.0, -1.0, float("nan")])
def test_bad_speed(speed):
    with pytest.raises(ValueError, match="speed"):
        model().system(speed)


def test_bands_without_an_end_are_named_like_the_others():
    """Where a tongue is unstable from a speed on, Hsu's band ends at infinity."""
    whole = replace(BODY, nodal_circles=1, nodal_diameters=3)
    bands = band_speeds(
        model(body=whole, load=replace(LOAD, stiffness=1.0)),
        tuple(fg.rad_per_s(np.array([800.0, 1000.0])).tolist()),
        order=1,
        points=21,
    )
    assert max(band.upper for band in bands) == math.inf
    assert "(1+15)/1" in {band.label for band in bands}
