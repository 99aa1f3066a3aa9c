"""Cantilever plates against Timoshenko's beam and Kirchhoff's endless plate."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import quad

from facegear.mechanics.cantilever_plate import CantileverPlate, Load


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
