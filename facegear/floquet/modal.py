r"""Periodic systems in the eigenbasis of their mean, ready for averaging (equations 2-12 to 2-25, 7-16 to 7-18).

A periodic system is expanded about its mean: free vibrations at natural frequencies ω_i, coupled by the
harmonics of the period. Two expansions feed the same averaging (:mod:`facegear.floquet.averaging`):

- :func:`standard_form` is the dissertation's own (2-12 to 2-16, 7-16 to 7-18): real modal coordinates of the
  mean stiffness, damping and gyroscopic terms of first order. Off-diagonal entries of F(0) drop out unless
  natural frequencies coincide.
- :func:`modal_expansion` uses the complex eigenvectors of the mean system, damping, gyroscopic and
  non-symmetric terms included exactly, and a mass that varies in time. For a symmetric, non-gyroscopic mean
  system the two differ by terms of second order in the damping, and not at all without damping.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
from scipy.linalg import eigh

from facegear.floquet.fourier import FourierSeries
from facegear.floquet.modes import ROUNDING as _ROUNDING
from facegear.floquet.modes import NaturalMotions
from facegear.floquet.periodic import PeriodicSystem
from facegear.support.parameters import integer_at_least
from facegear.support.types import ComplexArray, FloatArray

Kind = Literal["sum", "difference"]

# Condition of the eigenvectors from which on they are no basis.
_MOST_DEPENDENT = 1e8
# Part of the largest eigenvalue of the mean stiffness below which one is nothing.
_SINGULAR = 1e-12


@dataclass(frozen=True, eq=False)
class ModalExpansion:
    """A periodic system in the eigenbasis of its mean.

    Signed eigenvalues are numbered 0 … m−1 for +ω_i, m … 2m−1 for −ω_i.

    Attributes
    ----------
    frequencies : array, shape (m,)
        Natural frequencies ω_i of the mean system [rad/s], ascending, positive.
    coupling : complex array, shape (2 order + 1, 2m, 2m)
        Â_s for s = −order … order [1/s]. Â_0 holds the mean growth rates on its diagonal.
    mean_growth_rate : float
        Largest growth rate of the mean system [1/s], eigenvalues that do not oscillate included.
    parametric_frequency : float
        ω = 2π/T0 of the system as given [rad/s].
    """

    frequencies: FloatArray
    coupling: ComplexArray
    mean_growth_rate: float
    parametric_frequency: float

    @property
    def order(self) -> int:
        """Highest harmonic of the parametric frequency."""
        return len(self.coupling) // 2

    @cached_property
    def signed_frequencies(self) -> FloatArray:
        """Ω_a = ±ω_i [rad/s], shape (2m,)."""
        return np.concatenate([self.frequencies, -self.frequencies])

    @cached_property
    def strength(self) -> FloatArray:
        """√|Â_{s,ab} Â_{−s,ba}| [1/s], shape of ``coupling``: independent of how eigenvectors are scaled."""
        return np.sqrt(np.abs(self.coupling * self.coupling[::-1].transpose(0, 2, 1)))


@dataclass(frozen=True, eq=False)
class StandardForm:
    """Hsu's standard form q̈ + P(t) q̇ + [U(0) + U(t)] q = 0 in real modal coordinates (2-12 to 2-14, 7-18).

    Attributes
    ----------
    frequencies : array, shape (n,)
        ω_i [rad/s], ascending; U(0) = diag(ω_i²).
    F0 : array, shape (n, n)
        Mean damping F(0) [1/s].
    D, E : array, shape (order, n, n)
        Cosine and sine coefficients of U(t) [1/s²].
    F, G : array, shape (order, n, n)
        Cosine and sine coefficients of P(t) [1/s].
    parametric_frequency : float
        ω = 2π/T0 [rad/s].
    """

    frequencies: FloatArray
    F0: FloatArray
    D: FloatArray
    E: FloatArray
    F: FloatArray
    G: FloatArray
    parametric_frequency: float

    def growth_rate(self, k: int, j: int, kind: Kind, order: int, frequency: float) -> float:
        """Hsu's growth rate σ [1/s] of one pair (2-26 to 2-28), derived in :mod:`facegear.symbolic.hsu`.

        Parameters
        ----------
        k, j : int
            Numbers of the natural frequencies, from 1 as in the text, k ≤ j; k < j for a difference.
        kind : {"sum", "difference"}
            sω ≈ ω_k + ω_j or sω ≈ ω_j − ω_k.
        order : int
            s, from 1 to the order of the expansion.
        frequency : float
            Parametric frequency ω [rad/s].

        Raises
        ------
        ValueError
            If an argument is outside these ranges.
        """
        from facegear.symbolic import criterion as symbolic

        size = len(self.frequencies)
        if kind not in ("sum", "difference"):
            raise ValueError(f"kind = {kind!r}: valid are 'sum' and 'difference'")
        if not 1 <= k <= j <= size or (kind == "difference" and k == j):
            raise ValueError(f"k = {k}, j = {j}: valid are 1 ≤ k ≤ j ≤ {size}, and k < j for a difference")
        order = integer_at_least("order", order, 1)
        if order > len(self.D):
            raise ValueError(f"order = {order}: the expansion holds orders 1 to {len(self.D)}")
        k, j, s = k - 1, j - 1, order - 1
        w_k, w_j = self.frequencies[k], self.frequencies[j]
        detuning = order * frequency - (w_k + w_j if kind == "sum" else w_j - w_k)
        if k == j:
            entries = [m[s, k, k] for m in (self.D, self.E, self.F, self.G)]
            return float(symbolic.growth_rate_function("single")(w_k, detuning, self.F0[k, k], *entries))
        entries = [m[s, a, b] for a, b in ((k, j), (j, k)) for m in (self.D, self.E, self.F, self.G)]
        function = symbolic.growth_rate_function(kind)
        return float(function(w_k, w_j, detuning, self.F0[k, k], self.F0[j, j], *entries))

    def expansion(self) -> ModalExpansion:
        """Return the same in the eigenbasis q̈ + U(0) q = 0, everything else being the perturbation."""
        eigenvalues = 1j * np.concatenate([self.frequencies, -self.frequencies])
        position = np.concatenate([self.D - 1j * self.E, np.zeros((1, *self.F0.shape))]) / 2
        velocity = np.concatenate([self.F - 1j * self.G, 2 * self.F0[None]]) / 2
        # Harmonics −order … order; the last entry above is the mean.
        position = np.concatenate([position[-2::-1].conj(), position[-1:], position[:-1]])
        velocity = np.concatenate([velocity[-2::-1].conj(), velocity[-1:], velocity[:-1]])
        forcing = np.tile(position, (1, 2, 2)) + np.tile(velocity, (1, 2, 2)) * eigenvalues
        rates = -np.diag(self.F0) / 2
        return ModalExpansion(
            frequencies=self.frequencies,
            coupling=-forcing / (2 * eigenvalues[:, None]),
            mean_growth_rate=float(rates.max()),
            parametric_frequency=self.parametric_frequency,
        )


def standard_form(system: PeriodicSystem, order: int) -> StandardForm:
    """Transform to Hsu's standard form as the dissertation does (2-12 to 2-16, 7-16 to 7-18).

    Parameters
    ----------
    system : PeriodicSystem
        With a constant mass. The mean of the loads belongs to the mean stiffness.
    order : int
        Highest harmonic s of the parametric frequency.

    Raises
    ------
    ValueError
        If the mass varies in time, or the mean stiffness has a zero, negative or complex eigenvalue.

    Notes
    -----
    The mean damping F(0) is of first order here. Its entries off the diagonal, gyroscopic terms included, have
    no effect on a pair of distinct natural frequencies; where they are not small use :func:`modal_expansion`.
    """
    order = integer_at_least("order", order, 1)
    mass, damping, stiffness = system.fourier(order)
    scale = np.abs(mass.mean).max()
    if max(np.abs(mass.cosine).max(), np.abs(mass.sine).max()) > _ROUNDING * scale:
        raise ValueError(
            "system: its mass varies in time, which the standard form 2-12 has no place for; use modal_expansion"
        )
    if np.abs(stiffness.mean - stiffness.mean.T).max() <= _ROUNDING * np.abs(stiffness.mean).max():
        squares, right = eigh(stiffness.mean, mass.mean)
        left = right.T
    else:
        values, vectors = np.linalg.eig(np.linalg.solve(mass.mean, stiffness.mean))
        if np.abs(values.imag).max() > 1e-9 * np.abs(values).max():
            raise ValueError(
                "system: the non-symmetric mean stiffness has complex eigenvalues, so that the standard form 2-12 "
                "does not exist; use modal_expansion"
            )
        ascending = np.argsort(values.real)
        squares, right = values.real[ascending], vectors.real[:, ascending]
        left = np.linalg.inv(mass.mean @ right)
    if squares[0] <= 1e-12 * squares[-1]:
        raise ValueError(
            f"system: the mean stiffness has the eigenvalue {squares[0]:.3g} (rad/s)² beside {squares[-1]:.3g}: a "
            "rigid-body or unstable mode has no natural frequency; restrain it or remove its coordinate"
        )
    return StandardForm(
        frequencies=np.sqrt(squares),
        F0=left @ damping.mean @ right,
        D=left @ stiffness.cosine @ right,
        E=left @ stiffness.sine @ right,
        F=left @ damping.cosine @ right,
        G=left @ damping.sine @ right,
        parametric_frequency=2 * np.pi / system.period,
    )


def modal_expansion(system: PeriodicSystem, order: int) -> ModalExpansion:
    """Expand in the complex eigenvectors of the mean system.

    Parameters
    ----------
    system : PeriodicSystem
        Any; the mass may vary in time, the mean may be gyroscopic or non-symmetric.
    order : int
        Highest harmonic s of the parametric frequency.

    Returns
    -------
    ModalExpansion
        Overdamped coordinates (real negative eigenvalues) have no natural frequency and take no part.

    Raises
    ------
    ValueError
        If the mean system has a rigid-body mode (singular mean stiffness), or its eigenvectors are nearly
        dependent, as at critical damping.

    Notes
    -----
    A motion v_b exp(p_b t) of the mean system meets the harmonic (p_b² M_s + p_b C_s + K_s) v_b exp(isωt);
    its projection on the left eigenvector of p_a is Â_{s,ab}. A varying mass needs no inverse of M(t).
    """
    order = integer_at_least("order", order, 1)
    mass, damping, stiffness = system.fourier(order)
    _refuse_singular(np.asarray(np.linalg.solve(mass.mean, stiffness.mean), dtype=float))
    motions = NaturalMotions.of(mass.mean, damping.mean, stiffness.mean)
    eigenvalues, oscillating = motions.exponents, motions.oscillating
    amplitudes, bound = _inverse(motions.vectors)
    if not bound < _MOST_DEPENDENT:
        condition = np.linalg.cond(motions.vectors)
        if not condition < _MOST_DEPENDENT:
            raise ValueError(
                "system: eigenvectors of the mean system are nearly dependent "
                f"(condition {condition:.1g}), as at critical damping; first-order averaging needs an eigenbasis"
            )
    largest = np.abs(eigenvalues).max()
    if oscillating.size == 0:
        raise ValueError(
            "system: every mode of the mean system is overdamped, so that there is no natural frequency"
        )
    values = eigenvalues[oscillating]
    displacements = motions.displacements[:, oscillating]
    forces = motions.of_forces(amplitudes[oscillating])
    values, displacements, forces = (
        np.concatenate([part, part.conj()], axis=axis)
        for part, axis in ((values, 0), (displacements, 1), (forces, 0))
    )
    forcing = (
        _harmonics(mass) @ (displacements * values**2)
        + _harmonics(damping) @ (displacements * values)
        + _harmonics(stiffness) @ displacements
    )
    rates = np.where(np.abs(values.real) <= _ROUNDING * largest, 0.0, values.real)
    coupling = -forces @ forcing
    coupling[order] = np.diag(rates)
    return ModalExpansion(
        frequencies=values.imag[: oscillating.size].copy(),
        coupling=coupling,
        mean_growth_rate=float(eigenvalues.real.max()),
        parametric_frequency=2 * np.pi / system.period,
    )


def _refuse_singular(matrix: FloatArray) -> None:
    """Refuse M⁻¹ K with an eigenvalue that is nothing beside the largest."""
    # Norms bound both; eigenvalues are asked for only where that does not suffice.
    if _inverse(matrix)[1] < 1.0 / _SINGULAR:
        return
    full = np.abs(np.linalg.eigvals(matrix))
    if full.min() <= _SINGULAR * full.max():
        raise ValueError(
            f"system: the mean stiffness is singular (eigenvalues {full.min():.3g} to "
            f"{full.max():.3g} (rad/s)²): a rigid-body mode has no natural frequency; restrain it or remove "
            "its coordinate"
        )


def _inverse(matrix: FloatArray | ComplexArray) -> tuple[ComplexArray, float]:
    """Inverse of a matrix, and a bound on its condition number by Frobenius norms: infinite where it has no inverse."""
    try:
        inverse = np.asarray(np.linalg.inv(matrix), dtype=complex)
    except np.linalg.LinAlgError:
        return np.zeros_like(matrix, dtype=complex), np.inf
    return inverse, float(np.linalg.norm(matrix) * np.linalg.norm(inverse))


def _harmonics(series: FourierSeries) -> ComplexArray:
    """Complex coefficients of exp(isωt), s = −order … order; the mean is left out."""
    positive = (series.cosine - 1j * series.sine) / 2
    return np.concatenate([positive[::-1].conj(), np.zeros((1, *positive.shape[1:])), positive])
