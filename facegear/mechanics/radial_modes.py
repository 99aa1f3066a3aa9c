"""Radial modes and centrifugal stress of an annular plate clamped at the bore and free at the rim, in plain numbers.

The plate has unit outer radius, x = r/a between the bore ratio c = b/a and 1; :class:`facegear.mechanics.plate.Body`
gives it the dimensions of a drive. Equation numbers are those of the dissertation. In (4-4) the letter t stands for r
where second derivatives are taken.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import ArrayLike
from scipy import linalg, optimize, special

from facegear.support.parameters import (
    finite,
    finite_array,
    integer_within,
    within,
)
from facegear.support.quadrature import gauss_legendre
from facegear.support.types import FloatArray

BORE_RATIO_RANGE = (0.05, 0.9)
MAX_NODAL_CIRCLES = 4
MAX_NODAL_DIAMETERS = 10
# The modes are analytic on the plate; their nearest singularity, x = 0, lies at least 0.05 away from a bore
# of 0.05. Measured over the whole admissible range, these sizes leave only rounding errors.
_RITZ_TERMS = 40
_QUADRATURE_NODES = 80
# Half width, relative, of the interval around a Rayleigh-Ritz value in which the determinant changes sign.
_BRACKET = 1e-7


@dataclass(frozen=True, eq=False)
class RadialModes:
    """Radial mode functions R_mn of one number n of nodal diameters (4-6), outer radius one.

    Attributes
    ----------
    bore_ratio : float
        c = b/a [-].
    poissons_ratio : float
        ν [-].
    nodal_diameters : int
        n.
    roots : ndarray, shape (M + 1,)
        k_mn = β_mn a, so that the natural frequency is k² √(D/(ρ h))/a² [-].
    coefficients : ndarray, shape (M + 1, 4)
        Factors of J_n(kx), Y_n(kx), I_n(kx) e^(-k) and K_n(kx) e^(kc) [-]. They make ∫ R² x dx = 1 over
        the plate and R(1) > 0, (4-7).
    """

    bore_ratio: float
    poissons_ratio: float
    nodal_diameters: int
    roots: FloatArray
    coefficients: FloatArray

    def __call__(self, x: ArrayLike, derivative: int = 0) -> FloatArray:
        """Evaluate every R_mn, or a derivative of it.

        Parameters
        ----------
        x : array_like
            Radius over outer radius [-], between the bore ratio and one.
        derivative : {0, 1, 2}
            Order of the derivative with respect to x.

        Returns
        -------
        ndarray, shape (M + 1, ...)
            One row a mode, followed by the shape of `x` [-].

        Raises
        ------
        ValueError
            If a radius lies outside the plate or the order of the derivative is not 0, 1 or 2.
        """
        x = np.asarray(x, dtype=float)
        if derivative not in (0, 1, 2):
            raise ValueError(f"derivative must be 0, 1 or 2, got {derivative!r}")
        # Written so that NaN fails too; the slack covers the rounding of r/a at the edges.
        slack = 1e-12
        if not np.all((x >= self.bore_ratio - slack) & (x <= 1.0 + slack)):
            raise ValueError(f"x must lie between the bore ratio {self.bore_ratio} and 1, got {x}")
        return self.continued(x, derivative)

    def continued(self, x: FloatArray, derivative: int = 0) -> FloatArray:
        """Evaluate as by a call, beyond the rim too: the functions (4-6) go on there, smooth as on the plate."""
        values = np.empty((self.roots.size, *x.shape))
        for row, (root, factors) in enumerate(zip(self.roots, self.coefficients, strict=True)):
            plate = (self.nodal_diameters, root, x, self.bore_ratio)
            # Derivatives take functions of the next order as well: twice the work.
            bessel = _bessel_functions(*plate)[derivative] if derivative else _four_functions(*plate)
            values[row] = root**derivative * np.tensordot(factors, bessel, axes=1)
        return values


@lru_cache(maxsize=512)
def radial_modes(
    bore_ratio: float, poissons_ratio: float, nodal_circles: int, nodal_diameters: int
) -> RadialModes:
    """Radial modes with 0, ..., `nodal_circles` nodal circles and exactly `nodal_diameters` nodal diameters.

    A Rayleigh-Ritz computation in polynomials finds the eigenvalues in order and without gaps, to about
    twelve digits; the determinant of the boundary conditions (4-4) then fixes each root to rounding.

    Parameters
    ----------
    bore_ratio : float
        c = b/a [-], 0.05 to 0.9.
    poissons_ratio : float
        ν [-], 0 to 0.5.
    nodal_circles : int
        M, 0 to 4. The clamped edge is not counted.
    nodal_diameters : int
        n, 0 to 10.

    Returns
    -------
    RadialModes
        Immutable; the same object is returned for the same arguments.

    Raises
    ------
    TypeError, ValueError
        If an argument is of the wrong kind or outside its range.
    ArithmeticError
        If the determinant does not change sign at a Rayleigh-Ritz value.

    Examples
    --------
    >>> (radial_modes(0.5, 0.3, 0, 0).roots ** 2).round(3)
    array([13.024])
    """
    bore_ratio = within("bore_ratio", bore_ratio, *BORE_RATIO_RANGE)
    poissons_ratio = within("poissons_ratio", poissons_ratio, 0.0, 0.5)
    nodal_circles = integer_within("nodal_circles", nodal_circles, 0, MAX_NODAL_CIRCLES)
    nodal_diameters = integer_within("nodal_diameters", nodal_diameters, 0, MAX_NODAL_DIAMETERS)
    estimates = _ritz_roots(bore_ratio, poissons_ratio, nodal_circles, nodal_diameters)
    plate = (nodal_diameters, bore_ratio, poissons_ratio)
    roots = np.array([_refined_root(estimate, *plate) for estimate in estimates])
    coefficients = np.array([_null_vector(root, *plate) for root in roots])

    x, weights = plate_quadrature(bore_ratio)
    modes = RadialModes(bore_ratio, poissons_ratio, nodal_diameters, roots, coefficients)
    norms = np.sqrt((modes(x) ** 2) @ weights)
    coefficients *= (np.sign(modes(1.0)) / norms)[:, np.newaxis]
    for array in (roots, coefficients):
        array.setflags(write=False)
    return modes


def plate_quadrature(bore_ratio: float) -> tuple[FloatArray, FloatArray]:
    """Nodes and weights of ∫ f(x) x dx over the plate (Gauss-Legendre).

    Parameters
    ----------
    bore_ratio : float
        c = b/a [-].

    Returns
    -------
    nodes, weights : ndarray, shape (80,)
        Radii x [-] and weights with the factor x of the area element [-].
    """
    points, weights = gauss_legendre(_QUADRATURE_NODES)
    half = (1.0 - bore_ratio) / 2
    x = bore_ratio + half * (points + 1.0)
    return x, half * weights * x


def centrifugal_stress(
    x: ArrayLike, bore_ratio: float, poissons_ratio: float
) -> tuple[FloatArray, FloatArray]:
    """Membrane stress of the rotating disk, over ρ a² Ω² (4-2, 4-3).

    Parameters
    ----------
    x : array_like
        Radius over outer radius [-].
    bore_ratio : float
        c = b/a [-].
    poissons_ratio : float
        ν [-].

    Returns
    -------
    radial, hoop : ndarray
        σ_r and σ_θ over ρ a² Ω² [-], of the shape of `x`. No displacement at the bore, no radial stress at
        the rim.
    """
    x = finite_array("x", x)
    nu, c2 = finite("poissons_ratio", poissons_ratio), finite("bore_ratio", bore_ratio) ** 2
    d8 = 8 * ((1 + nu) + (1 - nu) * c2)
    b0 = (1 - nu) * c2 * ((3 + nu) - (1 + nu) * c2) / d8
    b1 = (1 + nu) * ((3 + nu) + (1 - nu) * c2**2) / d8
    radial = b0 / x**2 + b1 - (3 + nu) / 8 * x**2
    hoop = -b0 / x**2 + b1 - (1 + 3 * nu) / 8 * x**2
    return radial, hoop


@lru_cache(maxsize=512)
def centrifugal_stiffness(modes: RadialModes) -> FloatArray:
    """Stiffness of the radial modes in the centrifugal stress field, over Ω² (L_n of 4-9).

    Parameters
    ----------
    modes : RadialModes
        Modes of one number of nodal diameters.

    Returns
    -------
    ndarray, shape (M + 1, M + 1)
        ∫ (σ_r R' R' + n² σ_θ R R/x²) x dx over ρ a² Ω² [-]; symmetric. It does not depend on the size of
        the disk.
    """
    x, weights = plate_quadrature(modes.bore_ratio)
    radial, hoop = centrifugal_stress(x, modes.bore_ratio, modes.poissons_ratio)
    value, slope = modes(x), modes(x, derivative=1)
    n = modes.nodal_diameters
    matrix = (slope * (weights * radial)) @ slope.T + (value * (weights * n**2 * hoop / x**2)) @ value.T
    symmetric: FloatArray = (matrix + matrix.T) / 2
    symmetric.setflags(write=False)
    return symmetric


def _four_functions(n: int, root: float, x: FloatArray, bore_ratio: float) -> FloatArray:
    """J_n, Y_n, I_n e^(-k), K_n e^(kc) at z = kx, shape (4, ...)."""
    z = root * x
    # Both exponentials fall away from the edge at which they are one, so nothing overflows.
    growing, decaying = np.exp(-root * (1.0 - x)), np.exp(-root * (x - bore_ratio))
    return np.stack(
        [special.jv(n, z), special.yv(n, z), special.ive(n, z) * growing, special.kve(n, z) * decaying]
    )


def _bessel_functions(
    n: int, root: float, x: FloatArray, bore_ratio: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return :func:`_four_functions` and their first two derivatives in z, each of shape (4, ...)."""
    z = root * x
    value, above = (_four_functions(order, root, x, bore_ratio) for order in (n, n + 1))
    column = (4,) + (1,) * z.ndim
    # f_n' = (n/z) f_n + s f_(n+1) with s = -1 for J, Y, K and +1 for I (DLMF 10.6.2, 10.29.2), and
    # z² f'' + z f' ± (z² ∓ n²) f = 0 with the upper signs for J, Y (DLMF 10.2.1, 10.25.1).
    slope = n / z * value + np.array([-1.0, -1.0, 1.0, -1.0]).reshape(column) * above
    curvature = (n**2 / z**2 + np.array([-1.0, -1.0, 1.0, 1.0]).reshape(column)) * value - slope / z
    return value, slope, curvature


def _boundary_matrix(
    root: float, n: int, bore_ratio: float, poissons_ratio: float
) -> tuple[FloatArray, FloatArray]:
    """Boundary conditions (4-4) on the four factors of (4-6), columns scaled; and the scales, shape (4,)."""
    edges = np.array([bore_ratio, 1.0])
    value, slope, curvature = _bessel_functions(n, root, edges, bore_ratio)
    inner, rim, nu = 0, 1, poissons_ratio
    # Where the shear condition takes d/dr of the Laplacian: it is -k² f for J, Y and +k² f for I, K.
    laplacian_sign = np.array([-1.0, -1.0, 1.0, 1.0])
    matrix = np.stack(
        [
            value[:, inner],
            slope[:, inner],
            # bending moment over k²
            curvature[:, rim] + nu * (slope[:, rim] / root - n**2 * value[:, rim] / root**2),
            # Kirchhoff shear force over k³
            laplacian_sign * slope[:, rim]
            - (1 - nu) * n**2 * (slope[:, rim] / root**2 - value[:, rim] / root**3),
        ]
    )
    scales = np.linalg.norm(matrix, axis=0)
    return matrix / scales, scales


def _refined_root(estimate: float, n: int, bore_ratio: float, poissons_ratio: float) -> float:
    """Root k of the determinant next to an estimate, to rounding."""

    def determinant(root: float) -> float:
        return float(np.linalg.det(_boundary_matrix(root, n, bore_ratio, poissons_ratio)[0]))

    low, high = estimate * (1 - _BRACKET), estimate * (1 + _BRACKET)
    if determinant(low) * determinant(high) >= 0:
        raise ArithmeticError(
            f"no root of the plate determinant at k = {estimate} for n = {n}, bore ratio {bore_ratio}, "
            f"Poisson ratio {poissons_ratio}"
        )
    return float(optimize.brentq(determinant, low, high, xtol=1e-15 * estimate, rtol=4 * np.finfo(float).eps))


def _null_vector(root: float, n: int, bore_ratio: float, poissons_ratio: float) -> FloatArray:
    """Factors of the four Bessel functions that meet the boundary conditions at a root, shape (4,)."""
    matrix, scales = _boundary_matrix(root, n, bore_ratio, poissons_ratio)
    return np.asarray(np.linalg.svd(matrix)[2][-1] / scales)


@lru_cache(maxsize=64)
def _trial_functions(bore_ratio: float) -> tuple[FloatArray, ...]:
    """Trial functions at the nodes of :func:`plate_quadrature`, and two derivatives; the same for every n.

    Those with Legendre polynomials as second derivatives and clamped at the bore, each of shape (terms, nodes). They
    make the stiffness matrix well conditioned.
    """
    half = (1.0 - bore_ratio) / 2
    points = (plate_quadrature(bore_ratio)[0] - bore_ratio) / half - 1.0
    second = np.eye(_RITZ_TERMS)
    first = legendre.legint(second, m=1, lbnd=-1, scl=half)
    zeroth = legendre.legint(first, m=1, lbnd=-1, scl=half)
    return tuple(
        np.asarray(legendre.legval(points, series), dtype=float) for series in (zeroth, first, second)
    )


def _ritz_roots(bore_ratio: float, poissons_ratio: float, nodal_circles: int, n: int) -> FloatArray:
    """Rayleigh-Ritz estimates of k for 0, ..., nodal_circles, ascending, shape (nodal_circles + 1,).

    As the eigenvalue sought is 1/k⁴, the lowest modes come out with nearly full accuracy.
    """
    x, weights = plate_quadrature(bore_ratio)
    value, slope, curvature = _trial_functions(bore_ratio)
    hoop = slope / x - n**2 * value / x**2
    twist = n * (slope / x - value / x**2)
    # Strain energy of bending over π D: (κ_r + κ_θ)² - 2 (1 - ν)(κ_r κ_θ - κ_rθ²).
    nu = poissons_ratio
    cross = (curvature * weights) @ hoop.T
    stiffness = (
        (curvature * weights) @ curvature.T
        + (hoop * weights) @ hoop.T
        + nu * (cross + cross.T)
        + 2 * (1 - nu) * (twist * weights) @ twist.T
    )
    mass = (value * weights) @ value.T
    last = _RITZ_TERMS - 1
    compliances = linalg.eigh(
        mass, stiffness, eigvals_only=True, subset_by_index=(last - nodal_circles, last)
    )
    return np.asarray(compliances[::-1] ** -0.25)
