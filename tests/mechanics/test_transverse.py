"""The transverse model against its complex form, printed values and the physics it stands for."""

import math
from dataclasses import replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.optimize import linear_sum_assignment

from facegear.floquet import methods
from facegear.floquet import multipliers as floquet
from facegear.floquet.models import replace_parameter
from facegear.floquet.multipliers import growth_rate
from facegear.geometry.drive import Drive
from facegear.geometry.kinematics import ContactPath
from facegear.geometry.phases import phase_split
from facegear.maps.stability_map import stability_map
from facegear.mechanics.contact import CENTROID, Contact
from facegear.mechanics.disk import (
    disk_matrices,
    disk_modes,
    disk_stiffness,
    reference_stiffness,
    shape_vector,
)
from facegear.mechanics.pinions_on_disk import nominal_pinion_mass
from facegear.mechanics.plate import Body
from facegear.mechanics.properties import MeshLoad
from facegear.mechanics.transverse import Transverse, contact_shape, rotated
from facegear.support.parameters import rad_per_s
from facegear.symbolic import galerkin
from tests.independent.complex_galerkin import ComplexDisk, Pinion
from tests.independent.complex_galerkin import multipliers as complex_multipliers

CASE_ONE = Body(Drive(26, 130, 3.175e-3), 0.03)


@cache
def complex_disk(body: Body) -> ComplexDisk:
    def radial(m, n, r):
        return body.modes[n](r / body.outer_radius)[m] / body.outer_radius

    material = body.material
    return ComplexDisk(
        radial,
        M=body.nodal_circles,
        N=body.nodal_diameters,
        a=body.outer_radius,
        b=body.bore_radius,
        h=body.thickness,
        E=material.youngs_modulus,
        rho=material.density,
        nu=material.poissons_ratio,
        xi=material.viscous_loss_factor,
    )


def unitary(body: Body) -> np.ndarray:
    """U with η = U q: η_n = (A_n - i B_n)/√2 for n > 0, its conjugate for n < 0."""
    rows = [
        (m, n)
        for n in range(-body.nodal_diameters, body.nodal_diameters + 1)
        for m in range(body.nodal_circles + 1)
    ]
    columns = disk_modes(body)
    U = np.zeros((len(rows), len(columns)), dtype=complex)
    for i, (m, n) in enumerate(rows):
        for j, coordinate in enumerate(columns):
            if (coordinate.nodal_circles, coordinate.nodal_diameters) != (m, abs(n)):
                continue
            if n == 0:
                U[i, j] = 1
            elif coordinate.wave == "cos":
                U[i, j] = 1 / np.sqrt(2)
            else:
                U[i, j] = -1j * np.sign(n) / np.sqrt(2)
    return U


def without_damping(body: Body) -> Body:
    return replace(body, material=replace(body.material, viscous_loss_factor=0.0))


class TestDisk:
    def test_fourteen_coordinates(self):
        assert len(disk_modes(CASE_ONE)) == 14
        first = [(c.nodal_circles, c.nodal_diameters, c.wave) for c in disk_modes(CASE_ONE)[:4]]
        assert first == [(0, 0, "cos"), (1, 0, "cos"), (0, 1, "cos"), (1, 1, "cos")]

    @pytest.mark.parametrize("speed_rpm", [0.0, 10.0, 1000.0])
    @pytest.mark.parametrize("size", [(1, 3), (3, 6)])
    def test_real_matrices_equal_the_complex_ones(self, speed_rpm, size):
        body = Body(CASE_ONE.drive, 0.03, nodal_circles=size[0], nodal_diameters=size[1])
        speed = float(rad_per_s(speed_rpm))
        U = unitary(body)
        np.testing.assert_allclose(U.conj().T @ U, np.eye(len(U)), atol=1e-15)
        _, C0, K0 = complex_disk(body).constant_matrices(speed)
        damping, stiffness = disk_matrices(body, speed)
        for real, full in ((damping, C0), (stiffness, K0)):
            transformed = U.conj().T @ full @ U
            np.testing.assert_allclose(real, transformed, atol=1e-9 * np.abs(full).max())

    @given(st.floats(0.05, 0.2319), st.floats(-7, 7))
    @settings(deadline=None, derandomize=True, max_examples=30)
    def test_shape_vector_equals_the_complex_one(self, radius, angle):
        U = unitary(CASE_ONE)
        disk = complex_disk(CASE_ONE)
        expected = U.T @ disk.values(radius, angle)
        np.testing.assert_allclose(
            shape_vector(CASE_ONE, radius, angle), expected, atol=1e-12 * np.abs(expected).max()
        )

    def test_shape_vector_broadcasts(self):
        radius, angle = np.array([[0.1], [0.2]]), np.array([0.0, 1.0, 2.0])
        shapes = shape_vector(CASE_ONE, radius, angle)
        assert shapes.shape == (2, 3, 14)
        expected = shape_vector(CASE_ONE, 0.2, 2.0)
        np.testing.assert_allclose(shapes[1, 2], expected, rtol=0.0, atol=1e-12 * np.abs(expected).max())

    def test_gyroscopic_terms_do_no_work(self):
        damping, stiffness = disk_matrices(without_damping(CASE_ONE), 100.0)
        np.testing.assert_allclose(damping, -damping.T, rtol=0.0, atol=1e-12 * np.abs(damping).max())
        np.testing.assert_allclose(stiffness, stiffness.T, atol=1e-12 * np.abs(stiffness).max())

    def test_waves_split_by_twice_the_rotation(self):
        """Forward and backward waves, seen from space, are at ω_rotating ± nΩ: a closed form per n for M = 0."""
        body = replace(without_damping(CASE_ONE), nodal_circles=0)
        speed = 80.0
        damping, stiffness = disk_matrices(body, speed)
        still = complex_disk(body)
        for n in (1, 2, 3):
            rows = [i for i, c in enumerate(disk_modes(body)) if c.nodal_diameters == n]
            block = np.ix_(rows, rows)
            state = np.block([[np.zeros((2, 2)), np.eye(2)], [-stiffness[block], -damping[block]]])
            found = np.sort(np.linalg.eigvals(state).imag)[2:]
            turning = np.sqrt(still.elastic(n)[0, 0] + still.centrifugal(n, speed)[0, 0])
            np.testing.assert_allclose(found, np.sort([turning - n * speed, turning + n * speed]), rtol=1e-9)

    def test_matrices_follow_the_derivation(self):
        """The pair n = 2 against the SymPy result, for M = 0."""
        g, body, speed = galerkin, replace(CASE_ONE, nodal_circles=0), 90.0
        pair = g.real_pair()
        values = {
            g.n: 2,
            g.beta: body.modes[2].roots[0] / body.outer_radius,
            g.D: body.bending_stiffness,
            g.rho: body.material.density,
            g.h: body.thickness,
            g.xi: body.material.viscous_loss_factor,
            g.Omega_2: speed,
        }
        derived = [np.array(matrix.subs(values), dtype=float) for matrix in (pair.damping, pair.stiffness)]
        rows = [i for i, c in enumerate(disk_modes(body)) if c.nodal_diameters == 2]
        damping, stiffness = (matrix[np.ix_(rows, rows)] for matrix in disk_matrices(body, speed))
        np.testing.assert_allclose(damping, derived[0], rtol=1e-12)
        centrifugal = complex_disk(body).centrifugal(2, speed)[0, 0]
        np.testing.assert_allclose(
            stiffness - derived[1], centrifugal * np.eye(2), atol=1e-12 * stiffness.max()
        )

    def test_speeds_broadcast(self):
        damping, stiffness = disk_matrices(CASE_ONE, [[0.0, 20.0, 50.0]])
        assert damping.shape == stiffness.shape == (1, 3, 14, 14)
        expected = disk_matrices(CASE_ONE, 20.0)[1]
        np.testing.assert_allclose(stiffness[0, 1], expected, rtol=0.0, atol=1e-12 * np.abs(expected).max())

    def test_bad_speed(self):
        with pytest.raises(ValueError, match="speed"):
            disk_matrices(CASE_ONE, float("nan"))


class TestReference:
    def test_case_one(self):
        assert reference_stiffness(CASE_ONE) == pytest.approx(1.0343e6, rel=5e-5)

    @pytest.mark.parametrize("speed_rpm", [0.0, 500.0, 1000.0])
    def test_state_space_route(self, speed_rpm):
        speed, radius = float(rad_per_s(speed_rpm)), 0.21
        expected = complex_disk(CASE_ONE).stiffness_at(radius, speed)
        assert disk_stiffness(CASE_ONE, speed, radius) == pytest.approx(expected, rel=1e-9)

    def test_is_the_average_over_speed(self):
        drive = CASE_ONE.drive
        radius = (drive.inner_radius + drive.outer_radius) / 2
        values = disk_stiffness(CASE_ONE, rad_per_s(np.linspace(0, 1000, 101)), radius)
        assert values.shape == (101,)
        assert reference_stiffness(CASE_ONE) == pytest.approx(values.mean(), rel=1e-14)
        assert values.min() < reference_stiffness(CASE_ONE) < values.max()

    def test_more_modes_make_a_softer_disk(self):
        richer = Body(CASE_ONE.drive, 0.03, nodal_circles=2, nodal_diameters=6)
        assert disk_stiffness(richer, 0.0, 0.21) < disk_stiffness(CASE_ONE, 0.0, 0.21)

    def test_nominal_pinion_mass(self):
        drive = CASE_ONE.drive
        volume = np.pi * (26 * 3.175e-3 / 2) ** 2 * (drive.outer_radius - drive.inner_radius)
        assert nominal_pinion_mass(CASE_ONE) == pytest.approx(7840 * volume, rel=1e-12)


def model(
    stiffness=1.0, damping=3e-6, mass=1.0, body=CASE_ONE, pinion_angles=(0.0,), **contact
) -> Transverse:
    return Transverse(body, MeshLoad(stiffness, damping, mass), pinion_angles, Contact(**contact))


def complex_pinions(transverse: Transverse) -> list[Pinion]:
    """Centroids of the pinions by (5-1) to (5-4), straight from the contact path."""
    drive = transverse.body.drive
    path = ContactPath(drive, transverse.contact_ratio)
    sense = {"printed": 1, "with_disk": -1}[transverse.contact.travel]
    pinions = []
    for angle in transverse.pinion_angles:
        phase = angle / (2 * math.pi / drive.gear_teeth) % 1.0

        def position(x, angle=angle, phase=phase):
            centroid = path.centroid(x + phase)
            return centroid.radius, sense * (centroid.angle + angle)

        pinions.append(Pinion(position, [(instant - phase) % 1.0 for instant in path.breakpoints]))
    return pinions


@cache
def average_stiffness(body: Body) -> float:
    """Mean of k_d over 0 to 1000 rpm, the denominator of (4-17), from the disk in complex exponentials."""
    disk, middle = complex_disk(body), (body.drive.inner_radius + body.drive.outer_radius) / 2
    return float(np.mean([disk.stiffness_at(middle, v) for v in np.linspace(0, rad_per_s(1000.0), 101)]))


def slow_multipliers(transverse: Transverse, speed: float) -> np.ndarray:
    body, drive = transverse.body, transverse.body.drive
    disk = complex_disk(body)
    k_b = transverse.load.stiffness * average_stiffness(body)
    m_p = transverse.load.mass * disk.rho * np.pi * drive.pitch_radius**2 * drive.face_width
    period = 2 * np.pi / (drive.gear_teeth * speed)
    c_b = transverse.load.damping * k_b
    return complex_multipliers(disk, complex_pinions(transverse), speed, period, m_p=m_p, c_b=c_b, k_b=k_b)


def greatest_distance(first: np.ndarray, second: np.ndarray) -> float:
    """Largest distance between two sets of complex numbers, paired as well as can be."""
    distances = np.abs(first[:, None] - second[None, :])
    return float(distances[linear_sum_assignment(distances)].max())


class TestAgainstTheComplexForm:
    """DOP853 on (4-8) to (4-13): 1e-8 in every multiplier."""

    @pytest.mark.parametrize(
        ("speed_rpm", "stiffness", "unstable"),
        [
            (1000.0, 1.0, False),
            (647.6271, 0.1, True),
            (546.9492, 0.9, True),
            (400.0, 0.5, False),
            (93.8983, 0.05, True),
            (30.0, 1.0, False),
        ],
    )
    def test_case_one(self, speed_rpm, stiffness, unstable):
        transverse, speed = model(stiffness), float(rad_per_s(speed_rpm))
        slow = slow_multipliers(transverse, speed)
        fast = floquet.multipliers(transverse.system(speed))
        assert (np.abs(slow).max() > 1) == unstable
        assert abs(np.abs(slow).max() - np.abs(fast).max()) < 1e-9
        assert greatest_distance(slow, fast) < 1e-8

    @pytest.mark.parametrize(
        "options",
        [
            {"pinion_angles": (0.0, math.radians(120.0))},
            {"pinion_angles": (0.0, math.radians(90.0), math.radians(200.0))},
            {"contact_ratio": CASE_ONE.drive.geometric_contact_ratio},
            {"pinion_angles": (0.0, math.radians(100.0)), "travel": "with_disk"},
            {"mass": 0.0},
            {"body": Body(CASE_ONE.drive, 0.05, nodal_circles=2, nodal_diameters=4)},
        ],
        ids=[
            "two pinions",
            "three pinions",
            "geometric contact ratio",
            "travel with the disk",
            "no mass",
            "more modes",
        ],
    )
    def test_variants(self, options):
        transverse, speed = model(0.5, **options), float(rad_per_s(600.0))
        slow = slow_multipliers(transverse, speed)
        assert greatest_distance(slow, floquet.multipliers(transverse.system(speed))) < 1e-8

    @given(st.floats(0, 1), st.floats(5, 110))
    @settings(deadline=None, derandomize=True, max_examples=10)
    def test_assembled_matrices(self, fraction, speed):
        transverse = model(0.7, pinion_angles=(0.0, 2.0))
        system, disk, U = transverse.system(speed), complex_disk(CASE_ONE), unitary(CASE_ONE)
        M, C, K = disk.constant_matrices(speed)
        for pinion in complex_pinions(transverse):
            radius, angle = pinion.position(np.array([fraction]))
            v = disk.values(float(radius[0]), float(angle[0]))
            H = np.outer(v.conj(), v) / (2 * np.pi * disk.rho * disk.h)
            M += H * transverse.pinion_mass
            C += H * transverse.bearing_damping
            K += H * transverse.bearing_stiffness
        assembled = (
            system.mass_matrix(fraction),
            system.damping_matrix(fraction),
            system.stiffness_matrix(fraction),
        )
        for real, full in zip(assembled, (M, C, K), strict=True):
            np.testing.assert_allclose(real, U.conj().T @ full @ U, atol=1e-9 * np.abs(full).max())


class TestTransverse:
    def test_load_is_scaled_as_in_the_text(self):
        """(4-17) to (4-19), with the disk in complex exponentials and the pinion's cylinder from Table 4.1."""
        transverse, drive = model(0.8, 1e-5, 0.4), CASE_ONE.drive
        radius = (drive.inner_radius + drive.outer_radius) / 2
        speeds = np.linspace(0.0, 1000.0, 101) * 2 * np.pi / 60
        average = np.mean([complex_disk(CASE_ONE).stiffness_at(radius, speed) for speed in speeds])
        assert transverse.bearing_stiffness == pytest.approx(0.8 * average, rel=1e-9)
        assert transverse.bearing_damping == pytest.approx(1e-5 * 0.8 * average, rel=1e-9)
        cylinder = np.pi * (26 * 3.175e-3 / 2) ** 2 * (drive.outer_radius - drive.inner_radius)
        assert transverse.pinion_mass == pytest.approx(0.4 * 7840 * cylinder, rel=1e-12)

    def test_period(self):
        assert model().system(50.0).period == pytest.approx(2 * np.pi / (130 * 50.0), rel=1e-15)

    def test_tregold_is_the_default(self):
        drive = CASE_ONE.drive
        assert model().contact.contact_ratio is None
        assert model().contact_ratio == drive.contact_ratio == pytest.approx(1.5532, abs=5e-5)
        same, other = (model(contact_ratio=r) for r in (drive.contact_ratio, drive.geometric_contact_ratio))
        assert same.contact_ratio == model().contact_ratio != other.contact_ratio
        for one, two in zip(model().shapes, same.shapes, strict=True):
            size = np.abs(one.coefficients).max()
            np.testing.assert_allclose(two.coefficients, one.coefficients, rtol=0.0, atol=1e-12 * size)

    def test_contact_ratio_follows_the_teeth_unless_it_was_given(self):
        for teeth in (25, 28):
            changed = replace_parameter(model(), "pinion_teeth", teeth)
            drive = replace(CASE_ONE.drive, pinion_teeth=teeth)
            assert changed == model(body=replace(CASE_ONE, drive=drive))
            assert changed.contact_ratio == drive.contact_ratio != model().contact_ratio
        assert replace_parameter(model(contact_ratio=2.0), "pinion_teeth", 28).contact_ratio == 2.0

    def test_map_over_teeth_is_that_of_models_built_anew(self):
        teeth, speeds = (24, 26, 30), [48.0, 55.0, 61.0]
        chart = stability_map(model(), speeds, "pinion_teeth", teeth, jobs=1, progress=False)
        for row, count in zip(chart.values, teeth, strict=True):
            anew = model(body=Body(replace(CASE_ONE.drive, pinion_teeth=count), thickness_ratio=0.03))
            np.testing.assert_allclose(row, [growth_rate(anew.system(s)) for s in speeds], atol=1e-5)
        # With the first drive's contact ratio at every count, as it once was, the map is another one.
        kept = model(contact_ratio=CASE_ONE.drive.contact_ratio)
        wrong = stability_map(kept, speeds, "pinion_teeth", teeth, jobs=1, progress=False)
        assert np.abs(wrong.values - chart.values).max() > 0.1

    def test_few_teeth_whose_contact_lines_end_on_the_base_circle(self):
        """Shape from the fit against that at the centroid itself; growth by two integrators."""
        body = Body(Drive(20, 160, 3.175e-3), thickness_ratio=0.03)
        few = model(0.7, body=body, pinion_angles=(0.0, 2.0))
        path = ContactPath(body.drive)
        x = np.sort(
            np.concatenate([np.linspace(0.01, 0.99, 23), path.base_circle_instant - np.array([1e-3, 1e-6])])
        )
        centroid = path.centroid(x)
        direct = shape_vector(body, centroid.radius, centroid.angle)
        np.testing.assert_allclose(few.shapes[0](x), direct, rtol=0, atol=1e-9 * np.abs(direct).max())
        system = few.system(55.0)
        by_magnus = growth_rate(system, methods.AdaptiveMagnus(1e-10))
        assert growth_rate(system) == pytest.approx(by_magnus, abs=1e-6)
        with pytest.raises(ValueError, match="pinion_teeth = 20 is too few for rate = 'total'"):
            replace(few, contact=Contact(rate="total"))

    def test_static_load_on_the_still_disk(self):
        """A pinion spring in parallel with the disk adds its stiffness to k_d at the contact point."""
        transverse = model(0.6)
        system = transverse.system(1e-9)
        centroid = ContactPath(CASE_ONE.drive).centroid(0.4)
        shape = shape_vector(CASE_ONE, centroid.radius, centroid.angle)
        areal = 2 * np.pi * 7840 * CASE_ONE.thickness
        under_load = areal / (shape @ np.linalg.solve(system.stiffness_matrix(0.4), shape))
        alone = disk_stiffness(CASE_ONE, 0.0, float(centroid.radius))
        assert under_load == pytest.approx(alone + transverse.bearing_stiffness, rel=1e-9)

    @pytest.mark.parametrize("angle_deg", [6.97, 90.6, 120.0, 181.2, -45.0])
    def test_second_pinion_follows_the_first(self, angle_deg):
        # (5-1) to (5-4): r2(t) = r1(t + ψT0), θ2(t) = θ1(t + ψT0) + θc
        angle = math.radians(angle_deg)
        first, second = model(pinion_angles=(0.0, angle)).shapes
        phase = phase_split(CASE_ONE.drive, angle).phase
        x = np.linspace(0, 1, 57)
        centroid = ContactPath(CASE_ONE.drive).centroid(x + phase)
        expected = shape_vector(CASE_ONE, centroid.radius, centroid.angle + angle)
        np.testing.assert_allclose(second(x), expected, atol=1e-10 * np.abs(expected).max())
        assert np.abs(first(x) - second(x)).max() > 1e-3 * np.abs(expected).max()

    def test_shape_is_continuous_and_its_slope_is_not(self):
        shape = contact_shape(CASE_ONE.modes, CENTROID, CASE_ONE.drive)
        largest = shape.largest
        assert np.abs(shape.jumps()).max() < 1e-11 * largest
        jumps = np.abs(shape.derivative().jumps()).max(axis=1)
        assert np.all(jumps > 1e-3 * largest)

    @pytest.mark.parametrize("clock", ["contact_ratio", "geometric_contact_ratio"])
    def test_contact_turns_nearly_as_fast_as_the_gear(self, clock):
        """Section 3.7: slope about one; section 3.6: θ falls. Read off where one pair alone is in mesh."""
        drive = CASE_ONE.drive
        ratio = getattr(drive, clock)
        path = ContactPath(drive, ratio)
        angle = path.contact_point([0.0, 1.0]).angle
        assert -1.0 < (angle[1] - angle[0]) / (drive.angular_pitch * ratio) < -0.9
        if clock == "contact_ratio":
            x = np.array([0.75, 0.95])
            turn = drive.angular_pitch * (x[1] - x[0])
            assert -1.1 < np.diff(CENTROID.places(drive)[0].position(x)[:, 1])[0] / turn < -0.8

    def test_travel_with_the_disk(self):
        """All angles change sign, which is the same as a disk that turns the other way."""
        angles = (0.0, CASE_ONE.drive.angular_pitch * (7 + 1 / 3))
        printed, turned = (model(0.5, pinion_angles=angles, travel=t) for t in ("printed", "with_disk"))
        x = np.linspace(0, 1, 11)
        for one, other in zip(printed.shapes, turned.shapes, strict=True):
            for coordinate, a, b in zip(disk_modes(CASE_ONE), one(x).T, other(x).T, strict=True):
                expected = -a if coordinate.wave == "sin" else a
                np.testing.assert_allclose(b, expected, rtol=0.0, atol=1e-12 * np.abs(one(x)).max())
        system = printed.system(60.0)
        backwards = replace(
            system,
            damping=np.diag(np.diag(system.damping)) * 2 - system.damping,
            stiffness=system.stiffness.T,
        )
        assert (
            greatest_distance(floquet.multipliers(backwards), floquet.multipliers(turned.system(60.0))) < 1e-9
        )

    def test_teeth_meet_the_pinions_one_after_the_other(self):
        """With the disk: a tooth under the second pinion is under the first θc/θN mesh periods later."""
        drive = CASE_ONE.drive
        angle = drive.angular_pitch * (7 + 1 / 3)
        first, second = model(pinion_angles=(0.0, angle), travel="with_disk").shapes
        # The disk turns towards growing θ and the second pinion sits at -angle.
        there = rotated(CASE_ONE, first, -angle)
        np.testing.assert_allclose(second(0.2), there(0.2 + 1 / 3), atol=1e-10 * first.largest)

    def test_rotation_of_the_shape(self):
        shape = contact_shape(CASE_ONE.modes, CENTROID, CASE_ONE.drive)
        x, angle = np.linspace(0, 1, 9), 0.83
        centroid = ContactPath(CASE_ONE.drive).centroid(x)
        expected = shape_vector(CASE_ONE, centroid.radius, centroid.angle + angle)
        np.testing.assert_allclose(
            rotated(CASE_ONE, shape, angle)(x), expected, atol=1e-10 * np.abs(expected).max()
        )

    @given(st.integers(-60, 60), st.floats(0.3, 5.9))
    @settings(deadline=None, derandomize=True, max_examples=8)
    def test_only_relative_angles_matter(self, teeth, angle):
        turn = teeth * CASE_ONE.drive.angular_pitch
        speed = float(rad_per_s(500.0))
        here, there = (
            np.abs(floquet.multipliers(model(pinion_angles=angles).system(speed)))
            for angles in (
                (0.0, angle),
                (turn, angle + turn if angle + turn < 6.2 else angle + turn - 2 * np.pi),
            )
        )
        np.testing.assert_allclose(np.sort(here), np.sort(there), rtol=1e-9)

    @pytest.mark.parametrize(
        ("printed", "tip_speed_rpm"), [(0.0375, 181.0), (0.0394, 837.0)], ids=["0-300 rpm", "0-1000 rpm"]
    )
    def test_critical_thickness_ratio_of_25_teeth(self, printed, tip_speed_rpm):
        """Printed for μ = 0.8, τ = 1, ζ = 1e-5, read from a plot: where the last tongue of the range vanishes."""
        drive = Drive(25, 125, 3.175e-3)
        speeds = float(rad_per_s(1.0)) * np.arange(tip_speed_rpm - 8, tip_speed_rpm + 8, 0.25)

        def largest_growth(thickness_ratio):
            transverse = model(0.8, 1e-5, 1.0, body=Body(drive, thickness_ratio))
            return max(floquet.growth_rate(transverse.system(float(speed))) for speed in speeds)

        assert largest_growth(printed) > 0
        assert largest_growth(printed + 2e-4) < 0

    @pytest.mark.parametrize(
        ("change", "error", "message"),
        [
            ({"body": CASE_ONE.drive}, TypeError, "body must be a Body"),
            ({"load": 1.0}, TypeError, "load must be a MeshLoad"),
            ({"contact": 1.5}, TypeError, "contact must be a Contact"),
            ({"contact": Contact(contact_ratio=27.0)}, ValueError, "contact_ratio"),
            (
                {"contact": Contact(sharing="mean", rate="total")},
                ValueError,
                'load.mass must be 0 .* else take sharing "centroid", or rate "frozen"; got load.mass=1.0',
            ),
            ({"contact": Contact(sharing="each")}, ValueError, "sharing must be"),
            ({"force": 1e3}, TypeError, "force must be a DrivingForce or None"),
            ({"pinion_angles": ()}, ValueError, "pinion_angles"),
            ({"pinion_angles": 0.0}, ValueError, "pinion_angles"),
            ({"pinion_angles": (0.0, 120.0)}, ValueError, "degrees"),
            ({"pinion_angles": (0.0, float("nan"))}, ValueError, "pinion_angles"),
            ({"pinion_angles": (0.0, 2 * math.pi)}, ValueError, "pinion_angles must differ"),
            ({"pinion_angles": (1.0, 2.0, 1.0)}, ValueError, "pinion_angles must differ"),
        ],
    )
    def test_bad_input(self, change, error, message):
        with pytest.raises(error, match=message):
            Transverse(**({"body": CASE_ONE, "load": MeshLoad(1.0, 3e-6, 1.0)} | change))

    @pytest.mark.parametrize("speed", [0.0, -1.0, float("inf")])
    def test_bad_speed(self, speed):
        with pytest.raises(ValueError, match="speed"):
            model().system(speed)


def momentum_multipliers(transverse: Transverse, speed: float) -> np.ndarray:
    """Total rate in momenta p = q̇ + φ m u̇, which has neither φ̈ nor velocity kicks; DOP853."""
    system = transverse.system(speed)
    (load,) = system.loads
    size, period = system.size, system.period
    shape, slope = load.shape, load.slope

    def velocity(q, p, phi, rate):
        free = p - load.mass * np.outer(phi, rate @ q)
        return free - load.mass / (1 + load.mass * phi @ phi) * np.outer(phi, phi @ free)

    scale = np.sqrt(np.abs(system.stiffness).max())
    state = np.eye(2 * size)
    edges = np.append(shape.breakpoints, 1.0)
    for start, end in pairwise(edges):

        def rates(t, flat, start=start, end=end):
            q, p = flat.reshape(2, size, 2 * size)
            x = t / period
            side = "left" if x > (start + end) / 2 else "right"
            phi, rate = shape(x, side), slope(x, side) / period
            q_t = velocity(q / scale, p, phi, rate)
            u_t = phi @ q_t + rate @ q / scale
            force = load.damping * u_t + load.stiffness * (phi @ q) / scale
            p_t = load.mass * np.outer(rate, u_t) - np.outer(phi, force)
            p_t -= system.damping @ q_t + system.stiffness @ q / scale
            return np.stack([scale * q_t, p_t]).ravel()

        solution = solve_ivp(
            rates,
            (start * period, end * period),
            state.ravel(),
            method="DOP853",
            rtol=1e-11,
            atol=1e-12,
        )
        assert solution.success
        state = solution.y[:, -1].reshape(2 * size, 2 * size)
    return np.linalg.eigvals(state)


class TestTotalRate:
    @pytest.mark.parametrize("speed_rpm", [200.0, 700.0])
    @pytest.mark.parametrize("clock", ["Tregold", "geometric"])
    def test_momentum_form(self, clock, speed_rpm):
        drive, speed = CASE_ONE.drive, float(rad_per_s(speed_rpm))
        ratio = drive.contact_ratio if clock == "Tregold" else drive.geometric_contact_ratio
        transverse = model(0.5, contact_ratio=ratio, rate="total")
        fast = floquet.multipliers(transverse.system(speed))
        assert greatest_distance(fast, momentum_multipliers(transverse, speed)) < 1e-8
        frozen = floquet.multipliers(
            replace(transverse, contact=replace(transverse.contact, rate="frozen")).system(speed)
        )
        assert greatest_distance(fast, frozen) > 1e-4


def test_a_disk_that_turns_the_other_way_is_its_mirror_image():
    model = Transverse(CASE_ONE, MeshLoad(0.7, 3e-6, 1.0), pinion_angles=(0.3, 2.0))
    system = model.system(60.0)
    damping, stiffness = disk_matrices(CASE_ONE, -60.0)
    sign = np.array([-1.0 if mode.wave == "sin" else 1.0 for mode in disk_modes(CASE_ONE)])
    loads = tuple(replace(load, shape=load.shape.transformed(np.diag(sign))) for load in system.loads)
    mirror = replace(system, damping=damping, stiffness=stiffness, loads=loads)
    both = np.tile(sign, 2)
    expected, found = floquet.transition_matrix(system), floquet.transition_matrix(mirror)
    turned = both[:, None] * expected * both
    size = np.abs(np.concatenate([turned[:14].ravel() * 1e4, turned[14:].ravel()])).max()
    assert np.abs(found - turned).max() < 1e-10 * size
    assert np.abs(disk_matrices(CASE_ONE, 60.0)[0] - damping).max() > 1.0


def test_phases_given_take_the_place_of_those_of_the_angles():
    load, angles = MeshLoad(0.7, 3e-6, 1.0), (0.3, 2.0)
    own = Transverse(CASE_ONE, load, pinion_angles=angles)
    given_ = replace(own, phases=phase_split(CASE_ONE.drive, angles).phase)
    for one, other in zip(own.shapes, given_.shapes, strict=True):
        np.testing.assert_allclose(one(0.37), other(0.37), rtol=1e-12)
    # Two pinions at one place, half a mesh period apart.
    pair = Transverse(CASE_ONE, load, pinion_angles=(0.0, 0.0), phases=(0.0, 0.5))
    first, second = pair.shapes
    np.testing.assert_allclose(first(0.8), second(0.3), rtol=1e-11)
    period = pair.system(60.0).repeated(2).period
    assert period == pytest.approx(2.0 * own.system(60.0).period)
    with pytest.raises(ValueError, match="unless phases are given"):
        replace(pair, phases=None)
    with pytest.raises(ValueError, match="phases must list one a pinion, 2"):
        replace(pair, phases=(0.0,))
    with pytest.raises(ValueError, match=r"phases must lie in .*1000.* mesh periods, got 1000000000000000"):
        replace(pair, phases=(0.0, 1e15))
