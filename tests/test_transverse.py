"""The transverse model against its complex form, printed values and the physics it stands for."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from facegear.geometry import Drive
from facegear.parameters import rad_per_s
from facegear.plate import Body
from facegear.transverse import (
    coordinates,
    disk_matrices,
    disk_stiffness,
    nominal_pinion_mass,
    reference_stiffness,
    shape_vector,
)
from tests.independent.complex_galerkin import ComplexDisk

CASE_ONE = Body(Drive(26, 130, 3.175e-3), 0.03)


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
    columns = coordinates(body)
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


class TestDisk:
    def test_fourteen_coordinates(self):
        assert len(coordinates(CASE_ONE)) == 14
        assert coordinates(CASE_ONE)[:4] == ((0, 0, "cos"), (1, 0, "cos"), (0, 1, "cos"), (1, 1, "cos"))

    @pytest.mark.parametrize("speed_rpm", [0.0, 10.0, 1000.0])
    @pytest.mark.parametrize("size", [(1, 3), (3, 8)])
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
        np.testing.assert_array_equal(shapes[1, 2], shape_vector(CASE_ONE, 0.2, 2.0))

    def test_gyroscopic_terms_do_no_work(self):
        undamped = Body(CASE_ONE.drive, 0.03, material=without_damping(CASE_ONE))
        damping, stiffness = disk_matrices(undamped, 100.0)
        np.testing.assert_array_equal(damping, -damping.T)
        np.testing.assert_allclose(stiffness, stiffness.T, atol=1e-12 * np.abs(stiffness).max())

    def test_waves_split_by_twice_the_rotation(self):
        """Forward and backward waves, seen from space, are at ω_rotating ± nΩ: a closed form per n for M = 0."""
        body = Body(CASE_ONE.drive, 0.03, material=without_damping(CASE_ONE), nodal_circles=0)
        speed = 80.0
        damping, stiffness = disk_matrices(body, speed)
        still = complex_disk(body)
        for n in (1, 2, 3):
            rows = [i for i, c in enumerate(coordinates(body)) if c.nodal_diameters == n]
            block = np.ix_(rows, rows)
            state = np.block([[np.zeros((2, 2)), np.eye(2)], [-stiffness[block], -damping[block]]])
            found = np.sort(np.linalg.eigvals(state).imag)[2:]
            turning = np.sqrt(still.elastic(n)[0, 0] + still.centrifugal(n, speed)[0, 0])
            np.testing.assert_allclose(found, np.sort([turning - n * speed, turning + n * speed]), rtol=1e-9)

    @pytest.mark.parametrize("speed", [-1.0, float("nan")])
    def test_bad_speed(self, speed):
        with pytest.raises(ValueError, match="speed"):
            disk_matrices(CASE_ONE, speed)


def without_damping(body: Body):
    from dataclasses import replace

    return replace(body.material, viscous_loss_factor=0.0)


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
