"""Hertz' ellipse against the integrals of its theory."""

import math

import pytest
from scipy.integrate import quad

from facegear.geometry.hertz import contact_ellipse


def test_hertz_against_the_integrals_of_its_theory():
    """Deflection under the pressure of the ellipse at the middle and along both axes makes up the gap."""
    smaller, larger = 0.0703, 60.7
    force, modulus = 500.0, 1.1e11
    found = contact_ellipse(smaller, larger, force, modulus)
    a, b = found.long, found.short

    def deflection(x, y):
        def part(w):
            w = w**2 * b**2  # the root at 0 is taken out
            rest = 1.0 - x**2 / (a**2 + w) - y**2 / (b**2 + w)
            return 2.0 * b * rest / math.sqrt((a**2 + w) * (b**2 + w))

        return (
            found.pressure
            * a
            * b
            / (2.0 * modulus)
            * quad(part, 0.0, math.inf, epsabs=0.0, epsrel=1e-11, limit=500)[0]
        )

    assert deflection(0.0, 0.0) == pytest.approx(found.approach, rel=1e-8)
    assert deflection(0.7 * a, 0.0) == pytest.approx(
        found.approach - smaller * (0.7 * a) ** 2 / 2.0, rel=1e-6
    )
    assert deflection(0.0, 0.7 * b) == pytest.approx(found.approach - larger * (0.7 * b) ** 2 / 2.0, rel=1e-6)
    assert found.pressure == pytest.approx(1.5 * force / (math.pi * a * b))
