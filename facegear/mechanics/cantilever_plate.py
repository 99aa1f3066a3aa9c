"""A tooth as a plate of variable thickness, clamped at its root, that bends, twists and shears.

Wellauer and Seireg took the cantilever plate for a gear tooth (Bending strength of gear teeth by cantilever-plate
theory, ASME Journal of Engineering for Industry 82, 1960, p. 213); Gagnon, Gosselin and Cloutier that of Mindlin with
the true thickness (Analysis of spur and straight bevel gear teeth deflection by the finite strip method). The
deflection is found after Rayleigh and Ritz, in polynomials. Under loads on a line, across which the shear jumps, it
converges only as a power of their number: what they leave out is one or two hundredths.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre

from facegear.support.quadrature import gauss
from facegear.support.types import FloatArray

# Polynomials of Ritz' method: against height, of degrees 1 and up, and along the face, of degrees 0 and up.
ACROSS, ALONG = 6, 12
# Shear correction of a rectangular section.
_SHEAR = 5.0 / 6.0


class Load(NamedTuple):
    """Where a unit force along the normal presses on a tooth, at points of shape S, and what work it does.

    Attributes
    ----------
    height : ndarray, shape S
        Above the root [m].
    position : ndarray, shape S
        u along the face [m].
    across : ndarray, shape S
        Work per deflection of the middle of the tooth [-].
    up, along : ndarray, shape S
        Work per rotation of a fibre across the tooth, in its height and along the face [m]: components of the force in
        the plane of the tooth act at half its thickness.
    """

    height: FloatArray
    position: FloatArray
    across: FloatArray
    up: FloatArray
    along: FloatArray


@dataclass(frozen=True, eq=False)
class CantileverPlate:
    """A plate of variable thickness, clamped along one edge, that bends and shears (Mindlin).

    Its points move by w across it, and by −ζβ in its plane at a distance ζ from its middle.

    Parameters
    ----------
    height : float
        From the clamped edge to the free one [m].
    ends : (float, float)
        Coordinates u of the two free edges square to it [m].
    thickness : callable
        Of heights and u, arrays of one shape [m].
    modulus, poissons_ratio : float
        E [Pa] and ν.
    across, along : int
        Polynomials of each displacement: of degrees 1 to `across` in height, 0 to `along` − 1 along the face.
    """

    height: float
    ends: tuple[float, float]
    thickness: Callable[[FloatArray, FloatArray], FloatArray]
    modulus: float
    poissons_ratio: float
    across: int = ACROSS
    along: int = ALONG

    @property
    def _half(self) -> float:
        return 0.5 * (self.ends[1] - self.ends[0])

    def _polynomials(self, height: FloatArray, position: FloatArray) -> tuple[FloatArray, ...]:
        """Values and slopes of polynomials in height, (..., across), and along the face, (..., along)."""
        x = height / self.height
        y = (position - 0.5 * sum(self.ends)) / self._half
        plain, slopes = (_legendre(2.0 * x - 1.0, self.across), _legendre_slopes(2.0 * x - 1.0, self.across))
        clamped = x[..., np.newaxis] * plain
        clamped_slopes = (plain + 2.0 * x[..., np.newaxis] * slopes) / self.height
        return clamped, clamped_slopes, _legendre(y, self.along), _legendre_slopes(y, self.along) / self._half

    @cached_property
    def stiffness(self) -> FloatArray:
        """Second derivatives of the energy in the coefficients of w, hβ_h and hβ_u, (3n, 3n) [N/m]."""
        x, x_weights = gauss(0.0, self.height, 2 * self.across + 8)
        u, u_weights = gauss(*self.ends, 2 * self.along + 10)
        heights, positions = (part.ravel() for part in np.meshgrid(x, u, indexing="ij"))
        weights = np.outer(x_weights, u_weights).ravel()
        thickness = self.thickness(heights, positions)
        values, by_height, along, by_along = self._polynomials(heights, positions)
        count = self.across * self.along

        def products(one: FloatArray, other: FloatArray) -> FloatArray:
            return (one[:, :, np.newaxis] * other[:, np.newaxis, :]).reshape(len(one), count)

        plain, up, sideways = products(values, along), products(by_height, along), products(values, by_along)
        shear = self.modulus / (2.0 * (1.0 + self.poissons_ratio))
        membrane = weights * _SHEAR * shear * thickness
        bending = weights * self.modulus * thickness**3 / (12.0 * (1.0 - self.poissons_ratio**2))
        nothing, size = np.zeros_like(plain), self.height
        # Strains of the three displacements: two shears, two curvatures, twist.
        strains = (
            (membrane, [up, -plain / size, nothing]),
            (membrane, [sideways, nothing, -plain / size]),
            (bending * (1.0 + self.poissons_ratio) / 2.0, [nothing, up / size, sideways / size]),
            (bending * (1.0 - self.poissons_ratio) / 2.0, [nothing, up / size, -sideways / size]),
            (bending * (1.0 - self.poissons_ratio) / 2.0, [nothing, sideways / size, up / size]),
        )
        total = np.zeros((3 * count, 3 * count))
        for weight, parts in strains:
            rows = np.sqrt(weight)[:, np.newaxis] * np.concatenate(parts, axis=1)
            total += rows.T @ rows
        return total

    @cached_property
    def _root(self) -> FloatArray:
        """R with R Rᵀ the inverse of the stiffness, (3n, 3n)."""
        lower = np.linalg.cholesky(self.stiffness)
        return np.asarray(np.linalg.inv(lower).T)

    def influence_factor(self, load: Load) -> FloatArray:
        """F with F Fᵀ the influence: what a unit force at one point moves another along its own normal.

        Parameters
        ----------
        load : Load, shape S

        Returns
        -------
        ndarray, shape S + (3n,)
            [√(m/N)].
        """
        values, _, along, _ = self._polynomials(load.height, load.position)
        products = values[..., :, np.newaxis] * along[..., np.newaxis, :]
        work = np.stack([load.across, load.up / self.height, load.along / self.height], axis=-1)
        whole = work[..., np.newaxis, np.newaxis] * products[..., np.newaxis, :, :]
        # As one product of two matrices, which is faster than one for each line.
        factor = whole.reshape(load.height.size, -1) @ self._root
        return np.asarray(factor.reshape(*load.height.shape, -1))

    def influence(self, one: Load, other: Load) -> FloatArray:
        """Move of points, shape S, along their own normals by unit forces at others, T: S + T [m/N]."""
        first, second = self.influence_factor(one), self.influence_factor(other)
        return np.asarray(np.tensordot(first, second, axes=(-1, -1)))


def _legendre(x: FloatArray, count: int) -> FloatArray:
    """Legendre polynomials of degrees 0 to count − 1, (..., count)."""
    return np.asarray(legendre.legvander(x, count - 1))


def _legendre_slopes(x: FloatArray, count: int) -> FloatArray:
    """Slopes of them."""
    return np.asarray(np.moveaxis(legendre.legval(x, legendre.legder(np.eye(count))), 0, -1))
