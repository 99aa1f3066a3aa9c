"""The gear body: dimensions, frequencies, what is refused."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from facegear.geometry.drive import Drive
from facegear.mechanics.plate import Body
from tests.mechanics.test_radial_modes import collocation_roots


class TestBody:
    drive = Drive(26, 130, 3.175e-3)

    def test_dimensions_of_case_one(self):
        # Tables 4.2 and 4.3; a = 231.94 mm is printed for 26/130.
        body = Body(self.drive, 0.03)
        assert body.outer_radius == pytest.approx(0.23194, abs=5e-6)
        assert body.thickness == 0.03 * body.outer_radius
        assert body.bore_ratio == 0.05 / body.outer_radius
        assert body.mass == pytest.approx(7840 * np.pi * (0.231939**2 - 0.05**2) * 0.03 * 0.231939, rel=1e-5)
        assert body.bending_stiffness == pytest.approx(200e9 * body.thickness**3 / 10.92, rel=1e-14)

    def test_natural_frequencies(self):
        body = Body(self.drive, 0.03, nodal_circles=2, nodal_diameters=4)
        frequencies = body.natural_frequencies_hz()
        assert frequencies.shape == (3, 5)
        a, h = body.outer_radius, body.thickness
        wave_speed = np.sqrt(200e9 * h**2 / (12 * (1 - 0.3**2) * 7840))
        for n in range(5):
            roots = collocation_roots(body.bore_ratio, 0.3, n, 3)
            np.testing.assert_allclose(
                frequencies[:, n], roots**2 * wave_speed / (2 * np.pi * a**2), rtol=1e-9
            )

    @given(st.floats(0.002, 0.05), st.floats(1.1, 3.0))
    @settings(deadline=None, derandomize=True, max_examples=20)
    def test_frequencies_grow_with_the_thickness(self, thickness_ratio, factor):
        thin, thick = (Body(self.drive, thickness_ratio * f).natural_frequencies_hz() for f in (1.0, factor))
        np.testing.assert_allclose(thick, factor * thin, rtol=1e-12)

    @pytest.mark.parametrize(
        ("change", "error", "message"),
        [
            ({"drive": "26/130"}, TypeError, "drive must be a Drive"),
            ({"material": 7840.0}, TypeError, "material must be a Material"),
            ({"thickness_ratio": 0.0}, ValueError, "thickness_ratio"),
            ({"thickness_ratio": float("nan")}, ValueError, "thickness_ratio"),
            ({"thickness_ratio": 3.0}, ValueError, "thickness_ratio"),
            ({"bore_radius": 50.0}, ValueError, "bore_radius=0.05 would be valid"),
            ({"bore_radius": 0.005}, ValueError, "bore_radius"),
            (
                {"bore_radius": 0.19},
                ValueError,
                r"bore_radius must lie in \[0.0115969, 0.188433\] in m, got 0.19 m",
            ),
            ({"nodal_circles": 5}, ValueError, "nodal_circles"),
            ({"nodal_diameters": 2.0}, TypeError, "nodal_diameters"),
        ],
    )
    def test_bad_input(self, change, error, message):
        with pytest.raises(error, match=message):
            Body(**({"drive": self.drive, "thickness_ratio": 0.03} | change))
