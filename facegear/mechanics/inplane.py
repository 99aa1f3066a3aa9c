"""Plane stress of a spinning disk under forces at its rim that rest in space (section 6.2).

A tangential force at the rim, at angle θ_F, makes u_r = U sin k(θ-θ_F), u_θ = V cos k(θ-θ_F), σ_rr = S sin k(θ-θ_F),
σ_rθ = T cos k(θ-θ_F), σ_θθ = H sin k(θ-θ_F) in its kth harmonic (6-6, 6-22). A radial force makes the same functions of
r with other conditions at the rim, a quarter of a wave on: cos, -sin, cos in the three stresses. With s = ln x,
x = r/a, P = xS, Q = xT, lengths over a and stresses over E, the steady part of (6-2), (6-3) is for every k

    U' = -ν(U - kV) + (1 - ν²)P             P' =  U - kV + νP + kQ - Ω*²x²[(k² + 1)U - 2kV]
    V' =  V - kU + 2(1 + ν)Q                Q' = -Q - k[U - kV + νP] - Ω*²x²[(k² + 1)V - 2kU]

with U = V = 0 at the bore and P, Q given at the rim, Ω* = Ω2 a √(ρ/E) (:mod:`facegear.symbolic.inplane` derives
it). Chebyshev collocation in s solves it alike for k = 0, 1 and above and for a disk at rest, where the
combinations of Bessel functions of (6-14) to (6-18) take different forms, lose digits or do not exist.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import ArrayLike

from facegear.floquet.series import ChebyshevSeries
from facegear.mechanics.plate import Body
from facegear.support.kinds import require_kind
from facegear.support.parameters import finite_array, integer_within, keep, one_of, within
from facegear.support.types import FloatArray

Direction = Literal["tangential", "radial"]

HIGHEST_HARMONIC = 400
# A force beyond this bound is a mistake of units.
_MOST_FORCE = 1e8
FASTEST_SPIN = 0.2
"""Largest Ω* [-]: beyond it the disk would burst or reach its first critical speed in the plane."""

# Rows of a solution.
_U, _V, _P, _Q = range(4)


@dataclass(frozen=True, eq=False)
class HarmonicField:
    """One harmonic of the plane field on unit outer radius, for unit stress at the rim.

    Attributes
    ----------
    bore_ratio, poissons_ratio : float
        c = b/a and ν [-].
    harmonic : int
        k.
    series : ChebyshevSeries
        In s = ln x from ln c to 0 of U, V, P, Q, for τ_k = 1 and σ_rr = 0 at the rim (first) and for σ_rr = 1 and
        τ_k = 0 (second), shape (4, 2). Displacements are over a/E.
    """

    bore_ratio: float
    poissons_ratio: float
    harmonic: int
    series: ChebyshevSeries

    def unknowns(self, x: ArrayLike) -> FloatArray:
        """U, V, P, Q at radii x = r/a [-], for both loads, shape (4, 2, ...)."""
        x = np.asarray(x, dtype=float)
        # The slack covers the rounding of r/a at the edges.
        if not np.all((x >= self.bore_ratio - 1e-12) & (x <= 1.0 + 1e-12)):
            raise ValueError(f"x must lie between the bore ratio {self.bore_ratio} and 1, got {x}")
        return np.moveaxis(self.series(np.log(x)), (-2, -1), (0, 1))

    def stresses(self, x: ArrayLike) -> FloatArray:
        """S, T, H at radii x = r/a over the stress at the rim [-], for both loads, shape (3, 2, ...)."""
        x = np.asarray(x, dtype=float)
        found = self.unknowns(x)
        radial, shear = found[_P] / x, found[_Q] / x
        # H = (U - kV)/x + νS
        hoop = (found[_U] - self.harmonic * found[_V]) / x + self.poissons_ratio * radial
        return np.stack([radial, shear, hoop])


def resolving_degree(bore_ratio: float, harmonic: int) -> int:
    """Degree at which x^±k, e^(±zt) on the interval with z = k |ln c|/2, is resolved to rounding."""
    z = (harmonic + 1) * -math.log(bore_ratio) / 2
    return 20 + math.ceil(math.sqrt(75 * z))


@lru_cache(maxsize=1024)
def collocation_points(degree: int) -> tuple[FloatArray, FloatArray]:
    """Points t_j = cos(πj/degree), from 1 down to -1, and the matrix of derivatives at them."""
    t: FloatArray = chebyshev.chebpts2(degree + 1)[::-1]
    ends = np.ones(degree + 1)
    ends[[0, -1]] = 2.0
    ends *= (-1.0) ** np.arange(degree + 1)
    matrix = np.outer(ends, 1 / ends) / (t[:, None] - t + np.eye(degree + 1))
    # The sum of each row is zero; so its rounding cancels that of the others.
    return t, matrix - np.diag(matrix.sum(axis=1))


def edge_rows(degree: int) -> list[int]:
    """Rows of :func:`collocation_system` that hold U = V = 0 at the bore, and P and Q at the rim."""
    return [unknown * (degree + 1) + row for unknown, row in ((_U, degree), (_V, degree), (_P, 0), (_Q, 0))]


def collocation_system(
    bore_ratio: float, poissons_ratio: float, spin: float, harmonic: int, degree: int
) -> FloatArray:
    """Equations of one harmonic at the points of :func:`collocation_points`, from the rim to the bore.

    Each condition at an edge takes the place of the equation of its unknown there (:func:`edge_rows`).

    Parameters
    ----------
    bore_ratio, poissons_ratio, spin, harmonic
        As for :func:`harmonic_field`.
    degree : int
        Of the polynomials in s.

    Returns
    -------
    ndarray, shape (4 (degree + 1), 4 (degree + 1))
        Factors of U, V, P, Q at all points, in this order.
    """
    k, nu = harmonic, poissons_ratio
    t, derivative = collocation_points(degree)
    half = -math.log(bore_ratio) / 2
    size = degree + 1
    one = np.eye(size)
    x2 = np.exp(2 * half * (t - 1.0))
    inertia, coupling = np.diag(spin**2 * (k**2 + 1) * x2), np.diag(spin**2 * 2 * k * x2)
    d = derivative / half
    zero = np.zeros((size, size))
    system = np.block(
        [
            [d + nu * one, -nu * k * one, -(1 - nu**2) * one, zero],
            [k * one, d - one, zero, -2 * (1 + nu) * one],
            [inertia - one, k * one - coupling, d - nu * one, -k * one],
            [k * one - coupling, inertia - k**2 * one, k * nu * one, d + one],
        ]
    )
    rows = edge_rows(degree)
    system[rows] = 0.0
    system[rows, rows] = 1.0
    return system


@lru_cache(maxsize=4096)
def harmonic_field(bore_ratio: float, poissons_ratio: float, spin: float, harmonic: int) -> HarmonicField:
    """Solve one harmonic of the plane field.

    Parameters
    ----------
    bore_ratio : float
        c = b/a [-].
    poissons_ratio : float
        ν [-].
    spin : float
        Ω* = Ω2 a √(ρ/E) [-] (6-1), from 0 to `FASTEST_SPIN`.
    harmonic : int
        k, from 0 to 400.

    Returns
    -------
    HarmonicField

    Raises
    ------
    TypeError, ValueError
        If an argument is of the wrong kind or outside its range.
    """
    bore_ratio = within("bore_ratio", bore_ratio, 0.01, 0.99)
    poissons_ratio = within("poissons_ratio", poissons_ratio, 0.0, 0.5)
    spin = within("spin", spin, 0.0, FASTEST_SPIN)
    k, nu = integer_within("harmonic", harmonic, 0, HIGHEST_HARMONIC), poissons_ratio
    degree = resolving_degree(bore_ratio, k)
    size = degree + 1
    system = collocation_system(bore_ratio, nu, spin, k, degree)
    right = np.zeros((4 * size, 2))
    right[_Q * size, 0] = right[_P * size, 1] = 1.0
    unknowns = np.linalg.solve(system, right).reshape(4, size, 2)
    values = np.ascontiguousarray(unknowns.transpose(1, 0, 2)[::-1], dtype=float)
    values.setflags(write=False)
    return HarmonicField(bore_ratio, poissons_ratio, k, ChebyshevSeries(math.log(bore_ratio), 0.0, values))


@dataclass(frozen=True)
class EdgeLoadStress:
    """Plane stress of the disk under one force at its rim that rests in space (6-22).

    Stresses add up: the field of several forces, or of an inclined one, is the sum of their fields.

    Parameters
    ----------
    body : Body
        The disk.
    force : float
        F_t [N], positive towards growing θ, the sense of the disk's rotation, if tangential, outwards if radial.
        The driving force of a pinion is tangential and positive.
    speed : float
        Ω2 [rad/s], 0 or greater.
    harmonics : int
        Largest k of the sums of `field`, 0 to 400.
    direction : {"tangential", "radial"}
        Of the force.
    angle : float
        θ_F [rad], where the force acts.

    Raises
    ------
    TypeError, ValueError
        If an argument is of the wrong kind or outside its range.

    Examples
    --------
    >>> import facegear as fg
    >>> body = fg.Body(fg.Drive(26, 130, 3.175e-3), thickness_ratio=0.03)
    >>> field = fg.EdgeLoadStress(body, force=1e4)
    >>> bool(abs(field.shear(0, body.outer_radius) * 2 - field.shear(3, body.outer_radius)) < 1e-3)
    True
    """

    body: Body
    force: float
    speed: float = 0.0
    harmonics: int = 6
    direction: Direction = "tangential"
    angle: float = 0.0

    def __post_init__(self) -> None:
        require_kind("body", self.body, Body)
        one_of("direction", self.direction, ("tangential", "radial"))
        keep(
            self,
            force=within("force", self.force, -_MOST_FORCE, _MOST_FORCE, "N"),
            speed=within("speed", self.speed, 0.0, fastest_speed(self.body), "rad/s", hint="rpm?"),
            harmonics=integer_within("harmonics", self.harmonics, 0, HIGHEST_HARMONIC),
            angle=within("angle", self.angle, -2 * math.pi, 2 * math.pi, "rad", hint="degrees?"),
        )

    def harmonic(self, k: int) -> HarmonicField:
        """Return the field of harmonic k for unit stress at the rim, on unit outer radius."""
        body = self.body
        spin = self.speed * spin_per_speed(body)
        return harmonic_field(body.bore_ratio, body.material.poissons_ratio, spin, k)

    def edge_stress(self, k: int) -> float:
        """Amplitude τ_k of the load's stress at the rim in harmonic k [Pa] (6-7): F/(2πah), twice that for k > 0."""
        mean = self.force / (2 * math.pi * self.body.outer_radius * self.body.thickness)
        return mean if integer_within("harmonic", k, 0, HIGHEST_HARMONIC) == 0 else 2 * mean

    def _amplitudes(self, k: int, r: ArrayLike) -> FloatArray:
        """S, T, H [Pa] at radii r [m], shape (3, ...)."""
        load = 0 if self.direction == "tangential" else 1
        stresses = self.harmonic(k).stresses(np.divide(finite_array("r", r, "m"), self.body.outer_radius))
        found: FloatArray = self.edge_stress(k) * stresses[:, load]
        return found

    def radial(self, k: int, r: ArrayLike) -> FloatArray:
        """Radial stress of harmonic k (6-22).

        Parameters
        ----------
        k : int
            Harmonic, from 0.
        r : array_like
            Radius [m], between bore and rim.

        Returns
        -------
        ndarray, shape of `r`
            S [Pa], factor of sin k(θ - θ_F) for a tangential force and of cos k(θ - θ_F) for a radial one.

        Raises
        ------
        TypeError, ValueError
            If `k` is not a harmonic or a radius lies off the disk.
        """
        radial: FloatArray = self._amplitudes(k, r)[0]
        return radial

    def shear(self, k: int, r: ArrayLike) -> FloatArray:
        """Shear stress of harmonic k [Pa], factor of cos k(θ - θ_F), or -sin k(θ - θ_F); as `radial` in all else."""
        shear: FloatArray = self._amplitudes(k, r)[1]
        return shear

    def hoop(self, k: int, r: ArrayLike) -> FloatArray:
        """Hoop stress of harmonic k [Pa], factor of sin k(θ - θ_F), or cos k(θ - θ_F); as `radial` in all else."""
        hoop: FloatArray = self._amplitudes(k, r)[2]
        return hoop

    def field(self, r: ArrayLike, theta: ArrayLike) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Stresses at points of the disk, harmonics summed (6-22).

        Parameters
        ----------
        r : array_like
            Radius [m], between bore and rim.
        theta : array_like
            θ [rad]; broadcast against `r`.

        Returns
        -------
        radial, shear, hoop : ndarray
            σ_rr, σ_rθ, σ_θθ [Pa].

        Raises
        ------
        TypeError, ValueError
            If a value is not finite or a radius lies off the disk.
        """
        r, theta = finite_array("r", r, "m"), finite_array("theta", theta, "rad") - self.angle
        shape = np.broadcast_shapes(r.shape, theta.shape)
        radial, shear, hoop = np.zeros(shape), np.zeros(shape), np.zeros(shape)
        for k in range(self.harmonics + 1):
            S, T, H = self._amplitudes(k, r)
            sine, cosine = np.sin(k * theta), np.cos(k * theta)
            if self.direction == "radial":
                sine, cosine = cosine, -sine
            radial, shear, hoop = radial + S * sine, shear + T * cosine, hoop + H * sine
        return radial, shear, hoop


def spin_per_speed(body: Body) -> float:
    """Ω*/Ω2 = a √(ρ/E) [s] (6-1)."""
    return body.outer_radius * math.sqrt(body.material.density / body.material.youngs_modulus)


def fastest_speed(body: Body) -> float:
    """Speed Ω2 up to which the plane field of a rotating disk is computed, Ω* = `FASTEST_SPIN` [rad/s]."""
    # Less the rounding of the product that leads back to Ω*.
    return FASTEST_SPIN * (1.0 - 1e-12) / spin_per_speed(body)
