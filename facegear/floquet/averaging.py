r"""Averaged equations of congruent eigenvalues and the intervals where they grow (equations 2-22 to 2-28).

With b_a the amplitude of the signed eigenvalue i Ω_a (Ω_a = ±ω_i) seen from a frame turning at n_a ω,
averaging leaves

    ḃ_a = i (Ω_a − n_a ω) b_a + Σ_b Â_{n_a − n_b, ab} b_b,

where Â_s is the s-th complex Fourier coefficient of the perturbation in the eigenbasis of the mean system. Two
members make the 2 × 2 block of 2-25, whose borders are in closed form; every further eigenvalue congruent to
them joins the block, so that multiple natural frequencies and internal resonances need no case of their own.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq, minimize_scalar

from facegear.floquet.modal import ModalExpansion
from facegear.support.types import ComplexArray, FloatArray

Interval = tuple[float, float, float]

# Relative sizes, to the frequencies, below which a rate or a coupling is rounding; couplings that count leave
# room above the latter for the phase of their products to be known.
_ROUNDING = 1e-11
_LEAST_COUPLING = 1e-10
# An eigenvalue joins a block if its distance is less than this many times its coupling to it. Left out, it would
# act at first order; taken in from farther away it adds some of the second-order terms without the others, which
# in the torsional systems of chapter 7 makes things worse (10 loses a band that is there).
REACH = 3.0
# Resolution of the search for unstable intervals of blocks of three and more, in points.
_SEARCH_POINTS = 601


@dataclass(frozen=True, eq=False)
class ResonanceBlock:
    """Averaged equations of a set of congruent eigenvalues; autonomous at each parametric frequency.

    Attributes
    ----------
    members : tuple of int
        Signed eigenvalues, as numbered in :class:`ModalExpansion`.
    shifts : tuple of int
        n_a, the multiples of ω by which their frames turn.
    signed_frequencies : array, shape (members,)
        Ω_a [rad/s].
    coupling : complex array, shape (members, members)
        Â_{n_a − n_b, ab} [1/s].
    modes : int
        Number m of natural frequencies of the expansion.
    """

    members: tuple[int, ...]
    shifts: tuple[int, ...]
    signed_frequencies: FloatArray
    coupling: ComplexArray
    modes: int

    def matrix(self, frequency: ArrayLike) -> ComplexArray:
        """Matrix of the averaged equations at parametric frequencies [rad/s], shape (..., members, members)."""
        turning = np.subtract(
            self.signed_frequencies, np.multiply.outer(np.asarray(frequency, dtype=float), self.shifts)
        )
        # A common rotation changes no growth rate, and keeps large numbers out of small differences.
        turning = turning - turning[..., :1]
        matrix: ComplexArray = 1j * turning[..., None] * np.eye(len(self.members)) + self.coupling
        return matrix

    def growth_rate(self, frequency: ArrayLike) -> FloatArray:
        """Largest growth rate [1/s] at parametric frequencies [rad/s], shape of ``frequency``."""
        matrix = self.matrix(frequency)
        if len(self.members) == 2:
            mean = (matrix[..., 0, 0] + matrix[..., 1, 1]) / 2
            half = (matrix[..., 0, 0] - matrix[..., 1, 1]) / 2
            root = np.sqrt(half**2 + matrix[..., 0, 1] * matrix[..., 1, 0])
            return np.asarray(mean.real + np.abs(root.real))
        return np.asarray(np.linalg.eigvals(matrix).real.max(axis=-1))

    @cached_property
    def growth_bound(self) -> float:
        """Bound of the growth rate over all parametric frequencies [1/s]: the numerical range of the matrix.

        The detunings are imaginary and on the diagonal, so that they drop out of its Hermitian part.
        """
        return float(np.linalg.eigvalsh((self.coupling + self.coupling.conj().T) / 2)[-1])


def averaged_block(
    expansion: ModalExpansion, members: tuple[int, ...], shifts: tuple[int, ...]
) -> ResonanceBlock:
    """Averaged equations of given signed eigenvalues, each seen from a frame turning at shift × ω."""
    index = np.array(members)
    difference = np.subtract.outer(np.array(shifts), np.array(shifts))
    reachable = np.abs(difference) <= expansion.order
    layer = np.where(reachable, difference + expansion.order, 0)
    matrix = np.where(reachable, expansion.coupling[layer, index[:, None], index[None, :]], 0.0)
    modes = len(expansion.frequencies)
    return ResonanceBlock(members, shifts, expansion.signed_frequencies[index], matrix, modes)


def coupled(expansion: ModalExpansion, a: int, b: int, s: int) -> bool:
    """Tell whether harmonic s couples two signed eigenvalues by more than rounding."""
    strength = expansion.strength[expansion.order + s, a, b]
    return bool(strength > _LEAST_COUPLING * expansion.frequencies[-1])


def congruent_block(
    expansion: ModalExpansion, a: int, b: int, s: int, frequency: float, reach: float
) -> ResonanceBlock:
    """Collect the pair and every eigenvalue congruent to it within its reach, until no more join."""
    members, shifts = [a, b], [s, 0]
    signed, order = expansion.signed_frequencies, expansion.order
    turns = np.rint((signed - signed[b]) / frequency).astype(int)
    rates = expansion.coupling[order].diagonal().real
    # Distance of eigenvalues in the turning frame: a mode damped much more is as far away as one detuned.
    distance = np.hypot(signed - signed[b] - turns * frequency, rates - rates[b])
    candidates = [c for c in range(len(signed)) if c not in (a, b)]
    joined = True
    while joined:
        joined = False
        for c in list(candidates):
            strength = max(
                (
                    expansion.strength[order + turns[c] - n, c, m]
                    for m, n in zip(members, shifts, strict=True)
                    if abs(turns[c] - n) <= order
                ),
                default=0.0,
            )
            if strength > _LEAST_COUPLING * expansion.frequencies[-1] and distance[c] < reach * strength:
                members.append(c)
                shifts.append(int(turns[c]))
                candidates.remove(c)
                joined = True
    return averaged_block(expansion, tuple(members), tuple(shifts))


def signature(block: ResonanceBlock) -> tuple[tuple[int, int], ...]:
    """Return what blocks share that differ by order, a common rotation or complex conjugation."""

    def normal(pairs: list[tuple[int, int]]) -> tuple[tuple[int, int], ...]:
        least = min(n for _, n in pairs)
        return tuple(sorted((member, n - least) for member, n in pairs))

    own = list(zip(block.members, block.shifts, strict=True))
    conjugate = [((member + block.modes) % (2 * block.modes), -n) for member, n in own]
    return min(normal(own), normal(conjugate))


def driving_pair(block: ResonanceBlock, interval: Interval) -> tuple[int, int]:
    """Positions of the two members after which an unstable interval is named.

    Of the pairs whose combination lies inside the interval, or of all if none does, the one whose coupling
    feeds the critical eigenvector at the peak most.
    """
    if len(block.members) == 2:
        return 0, 1
    lower, upper, peak = interval
    matrix = block.matrix(peak)
    values, right = np.linalg.eig(matrix)
    critical = int(np.argmax(values.real))
    left = np.linalg.inv(right)[critical]
    # With the left vector normalised, these shares add up to the eigenvalue.
    share = (left[:, None] * matrix * right[None, :, critical]).real
    share = share + share.T
    turns = np.subtract.outer(block.shifts, block.shifts)
    apart = np.subtract.outer(block.signed_frequencies, block.signed_frequencies)
    paired = turns > 0
    # An interval may have no end, which times 0 is no number.
    turns = np.where(paired, turns, 1)
    inside = paired & (apart > lower * turns) & (apart < upper * turns)
    share[~(inside if inside.any() else paired)] = -np.inf
    a, b = np.unravel_index(int(np.argmax(share)), share.shape)
    return int(a), int(b)


def unstable_intervals(block: ResonanceBlock, frequency: float) -> Iterator[Interval]:
    """Intervals (lower, upper, peak) of the parametric frequency in which a block grows, around ``frequency``."""
    if block.growth_bound <= _ROUNDING * float(np.abs(block.coupling).max()):
        return iter(())
    return _pair_intervals(block) if len(block.members) == 2 else _search_intervals(block, frequency)


def _pair_intervals(block: ResonanceBlock) -> Iterator[Interval]:
    """Unstable interval of the parametric frequency of a 2 × 2 block in closed form."""
    from facegear.symbolic.criterion import border_function

    s = block.shifts[0] - block.shifts[1]
    distance = float(block.signed_frequencies[0] - block.signed_frequencies[1])
    product = 16 * complex(block.coupling[0, 1] * block.coupling[1, 0])
    rounding = _ROUNDING * abs(distance)
    # In the symbols of the derivation the first member, turning with −Λ, is the coordinate j. The mean system is
    # stable, so that a negative damping can only be rounding.
    f_j, f_k = (0.0 if d <= rounding else float(d) for d in -2 * np.diag(block.coupling).real)
    # Each of the two factors is known to about 1e-12 of the frequencies.
    known = 1e-9 + 1e-12 * float(np.abs(block.signed_frequencies).max()) / abs(product) ** 0.5
    real, imag = product.real, product.imag if abs(product.imag) > known * abs(product) else 0.0
    if f_k > 0 and f_j > 0:
        low, high = border_function()(f_k, f_j, real, imag)
    elif f_k == f_j and imag == 0:
        low, high = (-math.sqrt(real) / 2, math.sqrt(real) / 2) if real > 0 else (math.nan, math.nan)
    elif imag * (f_j - f_k) == 0:
        # One mode undamped: the damped one draws growth out of any detuning, however small.
        low, high = (-math.inf, math.inf) if real > 0 or imag != 0 else (math.nan, math.nan)
    else:
        # The quadratic equation of the border has lost its leading coefficient f⁰_kk f⁰_jj.
        total = f_k + f_j
        border = -(real * total**2 + imag**2 / 4) / (2 * imag * (f_j - f_k))
        low, high = (border, math.inf) if imag * (f_j - f_k) > 0 else (-math.inf, border)
    if not low < high:
        return
    lower, upper = sorted(((distance + low) / s, (distance + high) / s))
    reach = 4 * abs(product) ** 0.5 / abs(s)
    window = (max(lower, distance / s - reach), min(upper, distance / s + reach))
    yield lower, upper, _peak(block, *window)


def _peak(block: ResonanceBlock, lower: float, upper: float) -> float:
    """Parametric frequency of the fastest growth in an interval with one maximum."""
    result = minimize_scalar(
        lambda x: -float(block.growth_rate(x)),
        bounds=(lower, upper),
        method="bounded",
        options={"xatol": 1e-10 * upper},
    )
    return float(result.x)


def _search_intervals(block: ResonanceBlock, frequency: float) -> Iterator[Interval]:
    """Unstable intervals of a block of three and more, from a scan refined at every maximum and border."""
    coupling = float(np.linalg.norm(block.coupling - np.diag(np.diag(block.coupling)), 2))
    level = 1e-9 * coupling
    turns = np.subtract.outer(block.shifts, block.shifts)
    apart = np.subtract.outer(block.signed_frequencies, block.signed_frequencies)
    centres = apart[turns > 0] / turns[turns > 0]
    strength = np.sqrt(np.abs(block.coupling * block.coupling.T))[turns > 0]
    half = float(np.abs(centres - frequency).max()) + 6 * coupling
    # Narrow bands sit at the centre of a pair with a small coupling: sample each at its own scale.
    fine = (centres[:, None] + strength[:, None] * np.linspace(-3, 3, 61)).ravel()
    grid = np.unique(np.concatenate([np.linspace(frequency - half, frequency + half, _SEARCH_POINTS), fine]))
    growth = block.growth_rate(grid)
    # Between samples a narrow maximum can hide; a plateau of equal growth rates, all rounding, cannot.
    rise = growth[1:-1] - np.maximum(growth[:-2], growth[2:])
    depth = growth[1:-1] - np.minimum(growth[:-2], growth[2:])
    inner = 1 + np.flatnonzero((rise >= 0) & (depth > level) & (growth[1:-1] < -level))
    hidden = [_peak(block, grid[i - 1], grid[i + 1]) for i in inner]
    grid = np.unique(np.concatenate([grid, hidden]))
    growth = block.growth_rate(grid)
    unstable = growth > level

    def border(first: int, second: int) -> float:
        return float(
            brentq(
                lambda x: float(block.growth_rate(x)) - level,
                grid[first],
                grid[second],
                xtol=1e-13 * frequency,
            )
        )

    edges = np.flatnonzero(np.diff(np.concatenate([[False], unstable, [False]]).astype(int)))
    for start, stop in zip(edges[::2], edges[1::2], strict=True):
        lower = border(start - 1, start) if start > 0 else -math.inf
        upper = border(stop - 1, stop) if stop < len(grid) else math.inf
        top = start + int(np.argmax(growth[start:stop]))
        peak = _peak(block, grid[max(top - 1, 0)], grid[min(top + 1, len(grid) - 1)])
        yield lower, upper, peak
