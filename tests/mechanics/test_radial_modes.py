"""The annular plate against known values, closed forms and two discretisations written here."""

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.polynomial import chebyshev

from facegear.mechanics.radial_modes import (
    RadialModes,
    centrifugal_stiffness,
    centrifugal_stress,
    plate_quadrature,
    radial_modes,
)

bore_ratios = st.floats(0.05, 0.9)
poissons_ratios = st.floats(0.0, 0.5)
nodal_diameters = st.integers(0, 10)
CORNERS = [(c, nu, n) for c in (0.05, 0.9) for nu in (0.0, 0.3, 0.5) for n in (0, 1, 2, 10)]


def collocation_roots(c: float, nu: float, n: int, count: int, degree: int = 52) -> np.ndarray:
    """λ from the strong form as four first-order equations, Chebyshev collocation in s = ln x.

    With x² ∇² = d²/ds² - n² the unknowns are R, S = dR/ds, L = x²∇²R and T = dL/ds, and
    x⁴ ∇²(L/x²) = L'' - 4 L' + (4 - n²) L = λ⁴ x⁴ R. A derivative is scaled with d, half the length in s.
    """
    nodes = np.cos(np.pi * np.arange(degree + 1) / degree)  # the rim first, the bore last
    vandermonde = chebyshev.chebvander(nodes, degree)
    slopes = chebyshev.chebval(nodes, chebyshev.chebder(np.eye(degree + 1))).T
    D = np.linalg.solve(vandermonde.T, slopes.T).T
    d = -np.log(c) / 2
    x = np.exp((nodes - 1) * d)
    size = degree + 1
    one, nil = np.eye(size), np.zeros((size, size))
    A = np.block(
        [
            [D, -one, nil, nil],
            [-((n * d) ** 2) * one, D, -one, nil],
            [nil, nil, D, -one],
            [nil, nil, (4 - n**2) * d**2 * one, D - 4 * d * one],
        ]
    )
    B = np.zeros_like(A)
    B[3 * size :, :size] = np.diag((d * x) ** 4)
    # One boundary condition replaces one row of each equation's block: R = S = 0 at the bore, and at x = 1
    # R_xx = L - S + n² R, (∇²R)_x = T - 2 L.
    R, S, L, T = range(4)
    rim, bore = 0, size - 1
    conditions = [
        (bore, {R: 1.0}),
        (bore, {S: 1.0}),
        (rim, {L: 1.0, S: (nu - 1) * d, R: (1 - nu) * (n * d) ** 2}),
        (rim, {T: 1.0, L: -2.0 * d, S: -(1 - nu) * (n * d) ** 2, R: (1 - nu) * n**2 * d**3}),
    ]
    for block, (edge, factors) in enumerate(conditions):
        row = block * size + edge
        A[row], B[row] = 0, 0
        for unknown, factor in factors.items():
            A[row, unknown * size + edge] = factor
    compliances = np.linalg.eigvals(np.linalg.solve(A, B))
    return np.sort(compliances.real)[::-1][:count] ** -0.25


def precise_determinant(c: float, nu: float, n: int, root: mpmath.mpf) -> mpmath.mpf:
    """Boundary conditions (4-4) on the Bessel functions with as many digits as mpmath is set to."""
    columns = []
    for bessel, laplacian, above, below, size in (
        (mpmath.besselj, -1, -1, 1, 1),
        (mpmath.bessely, -1, -1, 1, 1),
        (mpmath.besseli, 1, 1, 1, mpmath.exp(-root)),
        (mpmath.besselk, 1, -1, -1, mpmath.exp(root * c)),
    ):

        def value(z, order=n, bessel=bessel, size=size):
            return size * bessel(order, z)

        def slope(z, order=n, value=value, above=above, below=below):
            # f_n' = (below f_(n-1) + above f_(n+1))/2, DLMF 10.6.1 and 10.29.1
            return (below * value(z, order - 1) + above * value(z, order + 1)) / 2

        second = (below * slope(root, n - 1) + above * slope(root, n + 1)) / 2
        R, S, C = value(root), root * slope(root), root**2 * second
        columns.append(
            [
                value(root * c),
                root * slope(root * c),
                C + nu * (S - n**2 * R),
                laplacian * root**2 * S - (1 - nu) * n**2 * (S - R),
            ]
        )
    return mpmath.det(mpmath.matrix(columns))


class TestRoots:
    @pytest.mark.parametrize(("n", "published"), [(0, 13.0), (1, 13.3), (2, 14.7), (3, 18.5)])
    def test_published_table(self, n, published):
        """Blevins (1979) for b/a = 0.5, ν = 0.3, as the test annulus-modal.fee of FeenoX quotes him.

        The last of them is 0.3 % lower than all routes of this file have it: 18.56.
        """
        assert radial_modes(0.5, 0.3, 0, n).roots[0] ** 2 == pytest.approx(
            published, abs=0.05 if n < 3 else 0.07
        )

    @pytest.mark.parametrize(("n", "printed"), [(0, 13.024), (1, 13.290), (2, 14.704), (3, 18.562)])
    def test_known_values_at_bore_ratio_one_half(self, n, printed):
        assert radial_modes(0.5, 0.3, 0, n).roots[0] ** 2 == pytest.approx(printed, abs=5e-4)

    def test_narrow_ring_tends_to_the_cantilever_beam(self):
        # cos y cosh y = -1 for y = λ (1 - c) as c -> 1; the ring's first correction is linear in 1 - c.
        widths = np.array([0.2, 0.15, 0.1])
        values = np.array([(w * radial_modes(1 - w, 0.3, 2, 0).roots) for w in widths])
        limits = np.polynomial.polynomial.polyfit(widths, values, 2)[0]
        np.testing.assert_allclose(limits, [1.8751041, 4.6940911, 7.8547574], rtol=2e-4)
        assert np.all(np.abs(values[0] - limits) > 1e-3), "the limit must not hold already at these widths"

    @pytest.mark.parametrize(("c", "nu", "n"), CORNERS)
    def test_collocation_at_the_corners(self, c, nu, n):
        # All five roots in order: a missed or doubled root would shift the rest.
        np.testing.assert_allclose(
            radial_modes(c, nu, 4, n).roots, collocation_roots(c, nu, n, 5), rtol=5e-10
        )

    @given(bore_ratios, poissons_ratios, nodal_diameters)
    @settings(deadline=None, derandomize=True, max_examples=40)
    def test_collocation_anywhere(self, c, nu, n):
        np.testing.assert_allclose(
            radial_modes(c, nu, 4, n).roots, collocation_roots(c, nu, n, 5), rtol=5e-10
        )

    @pytest.mark.parametrize(
        ("c", "nu", "n", "m"), [(0.05, 0.5, 10, 4), (0.05, 0.0, 1, 0), (0.9, 0.0, 10, 4), (0.9, 0.5, 0, 0)]
    )
    def test_many_digit_determinant_changes_sign_at_the_root(self, c, nu, n, m):
        root = radial_modes(c, nu, 4, n).roots[m]
        with mpmath.workdps(50):
            below, above = (
                precise_determinant(mpmath.mpf(c), mpmath.mpf(nu), n, mpmath.mpf(root) * (1 + shift))
                for shift in (-1e-12, 1e-12)
            )
        assert below * above < 0


class TestModeFunctions:
    def orthonormal(self, c, nu, n):
        # A quadrature of its own, finer than the module's and graded towards the bore.
        points, weights = np.polynomial.legendre.leggauss(200)
        s = np.log(c) * (1 - points) / 2
        x = np.exp(s)
        modes = radial_modes(c, nu, 4, n)
        R = modes(x)
        gram = (R * (weights * x**2 * -np.log(c) / 2)) @ R.T
        np.testing.assert_allclose(gram, np.eye(5), atol=1e-10)
        assert np.all(modes(1.0) > 0)

    @given(bore_ratios, poissons_ratios, nodal_diameters)
    @settings(deadline=None, derandomize=True, max_examples=10)
    def test_orthonormal(self, c, nu, n):
        self.orthonormal(c, nu, n)

    @pytest.mark.slow
    @given(bore_ratios, poissons_ratios, nodal_diameters)
    @settings(deadline=None, derandomize=True, max_examples=60)
    def test_orthonormal_for_many_plates(self, c, nu, n):
        self.orthonormal(c, nu, n)

    def nodal_circles_are_counted(self, c, nu, n):
        x = np.linspace(c, 1, 401)[1:]
        R = radial_modes(c, nu, 4, n)(x)
        # Close to the bore the function dies out like x^n; signs below rounding mean nothing.
        for m, row in enumerate(R):
            signs = np.sign(row[np.abs(row) > 1e-9 * np.abs(row).max()])
            assert np.count_nonzero(np.diff(signs)) == m

    @given(bore_ratios, poissons_ratios, nodal_diameters)
    @settings(deadline=None, derandomize=True, max_examples=10)
    def test_nodal_circles_are_counted(self, c, nu, n):
        self.nodal_circles_are_counted(c, nu, n)

    @pytest.mark.slow
    @given(bore_ratios, poissons_ratios, nodal_diameters)
    @settings(deadline=None, derandomize=True, max_examples=60)
    def test_nodal_circles_are_counted_for_many_plates(self, c, nu, n):
        self.nodal_circles_are_counted(c, nu, n)

    @pytest.mark.parametrize(("c", "nu", "n"), CORNERS)
    def test_plate_equation_and_edges(self, c, nu, n):
        """A Chebyshev series fitted to R meets ∇⁴R = λ⁴R and (4-4)."""
        modes = radial_modes(c, nu, 4, n)
        fits = [chebyshev.Chebyshev.interpolate(lambda x, m=m: modes(x)[m], 70, [c, 1]) for m in range(5)]
        x = np.linspace(c + 0.3 * (1 - c), c + 0.9 * (1 - c), 40)
        for root, fit in zip(modes.roots, fits, strict=True):
            d1, d2, d3, d4 = (fit.deriv(k) for k in (1, 2, 3, 4))
            biharmonic = (
                d4(x)
                + 2 / x * d3(x)
                - (1 + 2 * n**2) / x**2 * d2(x)
                + (1 + 2 * n**2) / x**3 * d1(x)
                + (n**4 - 4 * n**2) / x**4 * fit(x)
            )
            scale = root**4 * np.abs(fit(x)).max()
            assert np.abs(biharmonic - root**4 * fit(x)).max() < 1e-4 * scale
            size = np.abs(fit(1.0))
            assert abs(fit(c)) < 1e-9 * size
            assert abs(d1(c)) < 1e-7 * root * size
            moment = d2(1.0) + nu * (d1(1.0) - n**2 * fit(1.0))
            assert abs(moment) < 1e-6 * root**2 * size
            shear = (
                d3(1.0)
                + d2(1.0)
                - d1(1.0)
                + n**2 * (2 * fit(1.0) - d1(1.0))
                - (1 - nu) * n**2 * (d1(1.0) - fit(1.0))
            )
            assert abs(shear) < 1e-4 * root**3 * size

    @given(bore_ratios, poissons_ratios, nodal_diameters)
    @settings(deadline=None, derandomize=True, max_examples=30)
    def test_derivatives(self, c, nu, n):
        modes = radial_modes(c, nu, 2, n)
        x = np.linspace(c + 0.1 * (1 - c), 1 - 0.1 * (1 - c), 7)
        step = 1e-4 * (1 - c)
        for order in (1, 2):
            below, above = modes(x - step, order - 1), modes(x + step, order - 1)
            exact = modes(x, order)
            size = np.abs(exact).max()
            np.testing.assert_allclose((above - below) / (2 * step), exact, atol=3e-6 * size)

    def test_shape_follows_the_radius(self):
        modes = radial_modes(0.3, 0.3, 1, 2)
        assert modes(0.7).shape == (2,)
        assert modes(np.full((3, 4), 0.7)).shape == (2, 3, 4)
        np.testing.assert_allclose(modes(np.full((3, 4), 0.7))[:, 1, 2], modes(0.7), rtol=1e-12)

    def test_is_immutable(self):
        with pytest.raises(ValueError, match="read-only"):
            radial_modes(0.3, 0.3, 1, 2).roots[0] = 0

    @pytest.mark.parametrize(
        ("arguments", "name"),
        [
            ((0.04, 0.3, 1, 1), "bore_ratio"),
            ((0.91, 0.3, 1, 1), "bore_ratio"),
            ((float("nan"), 0.3, 1, 1), "bore_ratio"),
            ((0.5, 0.51, 1, 1), "poissons_ratio"),
            ((0.5, -0.1, 1, 1), "poissons_ratio"),
            ((0.5, 0.3, 5, 1), "nodal_circles"),
            ((0.5, 0.3, -1, 1), "nodal_circles"),
            ((0.5, 0.3, 1, 11), "nodal_diameters"),
            ((0.5, 0.3, 1, -1), "nodal_diameters"),
        ],
    )
    def test_arguments_out_of_range(self, arguments, name):
        with pytest.raises(ValueError, match=name):
            radial_modes(*arguments)

    @pytest.mark.parametrize(
        ("arguments", "name"),
        [((0.5, 0.3, 1.0, 1), "nodal_circles"), ((0.5, 0.3, 1, True), "nodal_diameters")],
    )
    def test_counts_are_integers(self, arguments, name):
        with pytest.raises(TypeError, match=name):
            radial_modes(*arguments)

    @pytest.mark.parametrize("x", [0.2, 1.01, float("nan")])
    def test_radius_off_the_plate(self, x):
        with pytest.raises(ValueError, match="x must lie between"):
            radial_modes(0.3, 0.3, 1, 2)(x)

    def test_unknown_derivative(self):
        with pytest.raises(ValueError, match="derivative"):
            radial_modes(0.3, 0.3, 1, 2)(0.5, derivative=3)


class TestCentrifugalStress:
    @given(bore_ratios, poissons_ratios)
    @settings(deadline=None, derandomize=True)
    def test_equilibrium_compatibility_and_edges(self, c, nu):
        # In s = ln x, where x d/dx = d/ds and the stresses are entire.
        radial, hoop = (
            chebyshev.Chebyshev.interpolate(
                lambda s, k=k: centrifugal_stress(np.exp(s), c, nu)[k], 30, [np.log(c), 0.0]
            )
            for k in (0, 1)
        )
        s = np.linspace(np.log(c), 0, 21)
        # d(x σ_r)/dx - σ_θ + x² = 0 in units of ρ a² Ω²
        np.testing.assert_allclose(radial(s) + radial.deriv()(s) - hoop(s) + np.exp(2 * s), 0, atol=1e-10)
        # The displacement E u = x (σ_θ - ν σ_r) vanishes at the bore and its slope in x is E ε_r.
        hoop_strain = hoop(s) - nu * radial(s)
        slope = hoop_strain + hoop.deriv()(s) - nu * radial.deriv()(s)
        np.testing.assert_allclose(slope, radial(s) - nu * hoop(s), atol=1e-10)
        assert hoop_strain[0] == pytest.approx(0, abs=1e-12)
        assert radial(0.0) == pytest.approx(0, abs=1e-12)

    def test_stiffness_matrix_is_the_integral(self):
        from scipy.integrate import quad

        modes = radial_modes(0.2, 0.3, 2, 3)

        def integrand(x, i, j):
            radial, hoop = centrifugal_stress(x, 0.2, 0.3)
            slope, value = modes(x, 1), modes(x)
            return (radial * slope[i] * slope[j] + 9 * hoop * value[i] * value[j] / x**2) * x

        expected = [[quad(integrand, 0.2, 1, (i, j), epsabs=1e-11)[0] for j in range(3)] for i in range(3)]
        np.testing.assert_allclose(centrifugal_stiffness(modes), expected, rtol=1e-10, atol=1e-10)

    @given(bore_ratios, poissons_ratios, nodal_diameters)
    @settings(deadline=None, derandomize=True, max_examples=40)
    def test_stiffness_matrix_is_symmetric_and_stiffens(self, c, nu, n):
        matrix = centrifugal_stiffness(radial_modes(c, nu, 2, n))
        np.testing.assert_allclose(matrix, matrix.T, rtol=1e-12)
        assert np.linalg.eigvalsh(matrix)[0] > 0


def test_quadrature_integrates_the_area():
    nodes, weights = plate_quadrature(0.25)
    assert weights.sum() == pytest.approx((1 - 0.25**2) / 2, rel=1e-14)
    assert nodes.min() > 0.25
    assert nodes.max() < 1


def test_modes_of_equal_arguments_are_shared():
    first = radial_modes(0.25, 0.3, 1, 3)
    assert isinstance(first, RadialModes)
    assert radial_modes(0.25, 0.3, 1, 3) is first
