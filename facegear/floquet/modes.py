"""Natural motions of systems with constant matrices: of the mean of a periodic system, or of its free part.

A motion v e^{pt} of M q̈ + C q̇ + K q = 0 is an eigenvector of the state matrix. That is set up here in the undamped
modes Q of the symmetric part of K, QᵀM Q = 1, in the state (ω Qᵀ M q, Qᵀ M q̇), whose halves both have the size of a
root energy: the matrix is then nearly normal, and slow motions are known as well as fast ones.

Not from here are the natural frequencies of :func:`facegear.floquet.modal.standard_form`, to which damping and
gyroscopic terms are of first order, as the dissertation has it, and the motions of a system frozen at an instant
(:attr:`facegear.floquet.stepping.Family.frozen_exponents`), whose state matrix its family has at hand.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from facegear.floquet.periodic import PeriodicSystem
from facegear.support.types import ComplexArray, FloatArray

# Relative size below which the imaginary part of an eigenvalue is rounding.
ROUNDING = 1e-11


@dataclass(frozen=True, eq=False)
class _Undamped:
    """Undamped modes of the symmetric part of a system, and the state matrix in their coordinates."""

    modes: FloatArray
    scale: FloatArray
    state: FloatArray

    @classmethod
    def of(cls, mass: FloatArray, damping: FloatArray, stiffness: FloatArray) -> _Undamped:
        n = mass.shape[-1]
        inverse = np.linalg.inv(np.linalg.cholesky(mass))
        root = inverse.swapaxes(-1, -2)
        reduced = inverse @ stiffness @ root
        squares, turned = np.linalg.eigh((reduced + reduced.swapaxes(-1, -2)) / 2.0)
        size = np.abs(squares).max(axis=-1, keepdims=True)
        scale = np.sqrt(np.where(size > 0.0, np.maximum(np.abs(squares), 1e-12 * size), 1.0))
        back = turned.swapaxes(-1, -2)
        state = np.zeros((*mass.shape[:-2], 2 * n, 2 * n))
        state[..., :n, n:] = scale[..., np.newaxis] * np.eye(n)
        state[..., n:, :n] = -(back @ reduced @ turned) / scale[..., np.newaxis, :]
        state[..., n:, n:] = -(back @ inverse @ damping @ root @ turned)
        return cls(root @ turned, scale, state)


def natural_exponents(mass: FloatArray, damping: FloatArray, stiffness: FloatArray) -> ComplexArray:
    """Return the exponents p [1/s] of all natural motions, in no order.

    Parameters
    ----------
    mass, damping, stiffness : array, shape (..., n, n)
        The mass symmetric and positive definite.

    Returns
    -------
    array of complex, shape (..., 2n)

    Examples
    --------
    >>> natural_exponents(np.eye(1), np.array([[0.2]]), np.array([[1.01]])).round(9)
    array([-0.1+1.j, -0.1-1.j])
    """
    return np.asarray(np.linalg.eigvals(_Undamped.of(mass, damping, stiffness).state), dtype=complex)


def undamped_frequencies(mass: FloatArray, stiffness: FloatArray) -> FloatArray:
    """Return natural frequencies without damping, ascending, shape (n,) [rad/s]; arguments as there."""
    exponents = natural_exponents(mass, np.zeros_like(stiffness), stiffness)
    return np.asarray(np.sort(exponents.imag)[len(mass) :], dtype=float)


def mean_matrices(system: PeriodicSystem) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Mass, damping and stiffness averaged over the period, loads and their impulses included, each (n, n)."""
    mass, damping, stiffness = (series.mean for series in system.fourier(1))
    return mass, damping, stiffness


def mean_growth_rate(system: PeriodicSystem) -> float:
    """Growth rate [1/s] of the system averaged over its period: positive where that flutters or diverges."""
    return float(natural_exponents(*mean_matrices(system)).real.max())


@dataclass(frozen=True, eq=False)
class NaturalMotions:
    """Natural motions of constant matrices, or some of them; leading axes may number several systems.

    Attributes
    ----------
    exponents : complex array, shape (..., m)
        p [1/s].
    vectors : complex array, shape (..., 2n, m)
        Columns (ω x, ẋ), x = Qᵀ M q.
    undamped : array, shape (..., n, n)
        Q, modes of mass and symmetric stiffness alone, of unit modal mass, ascending by frequency.
    scale : array, shape (..., n)
        ω [rad/s] of these modes, but never 0.
    mass : array, shape (..., n, n)
    """

    exponents: ComplexArray
    vectors: ComplexArray
    undamped: FloatArray
    scale: FloatArray
    mass: FloatArray

    @classmethod
    def of(cls, mass: FloatArray, damping: FloatArray, stiffness: FloatArray) -> NaturalMotions:
        """Find all motions, shapes as for :func:`natural_exponents`."""
        found = _Undamped.of(mass, damping, stiffness)
        exponents, vectors = np.linalg.eig(found.state)
        return cls(exponents.astype(complex), vectors.astype(complex), found.modes, found.scale, mass)

    @classmethod
    def of_mean(cls, system: PeriodicSystem) -> NaturalMotions:
        """Find the motions of the mean of a periodic system."""
        return cls.of(*mean_matrices(system))

    @property
    def displacements(self) -> ComplexArray:
        """Columns q of the motions, shape (..., n, m)."""
        n = self.scale.shape[-1]
        return np.asarray(self.undamped @ (self.vectors[..., :n, :] / self.scale[..., np.newaxis]))

    @property
    def velocities(self) -> ComplexArray:
        """Columns q̇ of the motions, shape (..., n, m)."""
        return np.asarray(self.undamped @ self.vectors[..., self.scale.shape[-1] :, :])

    @cached_property
    def from_state(self) -> FloatArray:
        """Matrix from (q, q̇) to (ω x, ẋ), shape (..., 2n, 2n)."""
        modal = self.undamped.swapaxes(-1, -2) @ self.mass
        zero = np.zeros_like(modal)
        rows = [[self.scale[..., np.newaxis] * modal, zero], [zero, modal]]
        return np.asarray(np.block(rows), dtype=float)

    def of_forces(self, rows: ComplexArray) -> ComplexArray:
        """Change rows that act on (ω x, ẋ), (..., r, 2n), to ones that act on a force, M⁻¹ included, (..., r, n)."""
        return np.asarray(rows[..., self.scale.shape[-1] :] @ self.undamped.swapaxes(-1, -2), dtype=complex)

    @property
    def amplitudes(self) -> ComplexArray:
        """Rows that take (ω x, ẋ) to the amplitude of each motion, for all 2n of them, shape (..., 2n, 2n)."""
        return np.asarray(np.linalg.inv(self.vectors), dtype=complex)

    @cached_property
    def oscillating(self) -> NDArray[np.intp]:
        """Numbers of the motions of one system with p above the real axis, ascending by frequency."""
        found = np.flatnonzero(self.exponents.imag > ROUNDING * np.abs(self.exponents).max())
        return found[np.argsort(self.exponents.imag[found])]
