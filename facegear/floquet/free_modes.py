"""Free motion of the constant part of a system: its modes, and springs for what hangs on nothing.

The modes of M q̈ + C q̇ + K q = 0 carry the free motion from one instant to another exactly, as long as all of them
oscillate. A system with rigid-body motions is held by springs, which its loads take back.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components

from facegear.floquet.loads import ContactLoad
from facegear.floquet.modes import NaturalMotions
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.support.types import ComplexArray, FloatArray

# A mode that is slower than this part of the fastest is a rigid-body motion, whose frequency is known to the root of
# rounding only; the modes of a system that is not held must not be taken for oscillations.
_SLOWEST = 1e-5
# Condition of the modes beyond which the square of it, in units of rounding, is more than panels may lose: as just
# below critical damping.
_MOST_DEPENDENT = 300.0
# Systems times the third power of their size from which on it pays to look for parts of them that are not coupled.
_WORTH_PARTS = 20_000
# A spring that holds what hangs on nothing lets it oscillate at this part of the fastest frequency at least.
_SOFTEST = 0.1


class UnsuitableSystemError(ValueError):
    """The free motion of a system is not a sum of oscillations, which contact-force collocation needs."""


@dataclass(frozen=True, eq=False)
class FreeModes:
    """Modes of M q̈ + C q̇ + K q = 0: q = Re(displacement y), q̇ = Re(velocity y), y = coordinates (q, q̇).

    Attributes
    ----------
    eigenvalues : array of complex, shape (..., n)
        p with positive imaginary part [1/s].
    displacement, velocity : array of complex, shape (..., n, n)
        Columns of modes, scaled to unit kinetic energy.
    coordinates : array of complex, shape (..., n, 2n)
        y from the state.
    input : array of complex, shape (..., n, n)
        Modal acceleration by a force on the coordinates: coordinates' velocity half times M⁻¹.
    """

    eigenvalues: ComplexArray
    displacement: ComplexArray
    velocity: ComplexArray
    coordinates: ComplexArray
    input: ComplexArray

    @classmethod
    def of(cls, system: PeriodicSystem) -> FreeModes:
        """Find the modes of the constant part of a system.

        Raises
        ------
        UnsuitableSystemError
            If a mode does not oscillate (rigid-body or overdamped) or the modes do not span the state space.
        """
        return cls.of_matrices(system.mass, system.damping, system.stiffness)

    @classmethod
    def of_all(cls, systems: Sequence[PeriodicSystem]) -> FreeModes:
        """Find the modes of several systems of one size, with the systems along the first axis; as :meth:`of`."""
        parts = [np.stack([getattr(x, name) for x in systems]) for name in ("mass", "damping", "stiffness")]
        return _modes(parts[0].shape, *(part.tobytes() for part in parts))

    @classmethod
    def of_matrices(cls, mass: FloatArray, damping: FloatArray, stiffness: FloatArray) -> FreeModes:
        """Find the modes from M, C and K, each (..., n, n); as :meth:`of`."""
        n = mass.shape[-1]
        if not stiffness.any(axis=(-1, -2)).all():
            raise UnsuitableSystemError("stiffness is zero: every free motion is a rigid-body motion")
        parts = (
            _uncoupled(mass, damping, stiffness)
            if mass.size * n >= _WORTH_PARTS
            else [np.arange(n)[np.newaxis]]
        )
        motions = [
            NaturalMotions.of(*(_part(x, places) for x in (mass, damping, stiffness))) for places in parts
        ]
        fastest = np.max([np.abs(found.exponents).max(axis=(-1, -2)) for found in motions], axis=0)
        slowest = _SLOWEST * fastest[..., np.newaxis, np.newaxis]
        oscillating = [found.exponents.imag > slowest for found in motions]
        counts = np.sum([np.count_nonzero(those, axis=(-1, -2)) for those in oscillating], axis=0)
        if (counts != n).any():
            raise UnsuitableSystemError(
                f"the free motion has {counts[counts != n].flat[0]} oscillating modes, not {n}: "
                "some are rigid-body or overdamped"
            )
        return cls._joined([_of_pairs(*pair) for pair in zip(motions, oscillating, strict=True)], parts)

    @classmethod
    def _joined(cls, modes: Sequence[FreeModes], parts: Sequence[NDArray[np.intp]]) -> FreeModes:
        """Modes of all coordinates from those of parts that are not coupled, mode by mode where its coordinate is."""
        n = sum(places.size for places in parts)
        leading = modes[0].eigenvalues.shape[:-2]
        eigenvalues = np.zeros((*leading, n), dtype=complex)
        displacement, velocity, of_forces = (np.zeros((*leading, n, n), dtype=complex) for _ in range(3))
        coordinates = np.zeros((*leading, n, 2 * n), dtype=complex)
        for found, places in zip(modes, parts, strict=True):
            rows, columns = places[:, :, np.newaxis], places[:, np.newaxis]
            both = np.concatenate([places, n + places], axis=-1)[:, np.newaxis]
            eigenvalues[..., places] = found.eigenvalues
            displacement[..., rows, columns], velocity[..., rows, columns] = (
                found.displacement,
                found.velocity,
            )
            coordinates[..., rows, both], of_forces[..., rows, columns] = found.coordinates, found.input
        return cls(eigenvalues, displacement, velocity, coordinates, of_forces)

    @property
    def size(self) -> int:
        """Number of modes n."""
        return int(self.eigenvalues.shape[-1])

    def of_some(self, places: NDArray[np.intp]) -> FreeModes:
        """Return the modes of some of the systems, by their places along the first axis."""
        return FreeModes(
            *(
                part[places]
                for part in (
                    self.eigenvalues,
                    self.displacement,
                    self.velocity,
                    self.coordinates,
                    self.input,
                )
            )
        )

    def state_from_real(self) -> FloatArray:
        """Matrix from (Re y, Im y) to (q, q̇), shape (..., 2n, 2n)."""
        both = np.concatenate([self.displacement, self.velocity], axis=-2)
        return np.concatenate([both.real, -both.imag], axis=-1)

    def real_from_state(self) -> FloatArray:
        """Matrix from (q, q̇) to (Re y, Im y), shape (..., 2n, 2n)."""
        return np.concatenate([self.coordinates.real, self.coordinates.imag], axis=-2)


def _uncoupled(*matrices: FloatArray) -> list[NDArray[np.intp]]:
    """Coordinates that matrices (..., n, n) couple, as parts of equal size, one array (parts, size) for each size."""
    n = matrices[0].shape[-1]
    there = np.any([(x != 0.0).reshape(-1, n, n).any(axis=0) for x in matrices], axis=0)
    return _parts_of(n, there.tobytes())


@lru_cache(maxsize=16)
def _parts_of(n: int, coupled: bytes) -> list[NDArray[np.intp]]:
    count, own = connected_components(np.frombuffer(coupled, dtype=bool).reshape(n, n), directed=False)
    parts = [np.flatnonzero(own == number) for number in range(count)]
    return [
        np.stack([part for part in parts if part.size == size])
        for size in sorted({part.size for part in parts})
    ]


def _part(matrix: FloatArray, places: NDArray[np.intp]) -> FloatArray:
    """Blocks (..., parts, size, size) of a matrix (..., n, n)."""
    return matrix[..., places[:, :, np.newaxis], places[:, np.newaxis]]


def _of_pairs(motions: NaturalMotions, oscillating: NDArray[np.bool_]) -> FreeModes:
    """Modes from motions that oscillate, of which every second one is chosen."""
    n = motions.mass.shape[-1]
    columns = motions.vectors.swapaxes(-1, -2)[oscillating].reshape(*motions.mass.shape[:-2], n, 2 * n)
    vectors = columns.swapaxes(-1, -2)
    vectors = vectors / np.linalg.norm(vectors[..., n:, :], axis=-2, keepdims=True)
    basis = np.concatenate([vectors, vectors.conj()], axis=-1)
    # x = Re(W y) with y twice the coefficients of the pairs W c + conj(W c).
    rows = np.asarray(2.0 * _inverse(basis)[..., :n, :], dtype=complex)
    chosen = motions.exponents[oscillating].reshape(*motions.mass.shape[:-2], n)
    half = replace(motions, exponents=chosen, vectors=vectors)
    return FreeModes(
        eigenvalues=half.exponents,
        displacement=half.displacements,
        velocity=half.velocities,
        coordinates=np.asarray(rows @ half.from_state, dtype=complex),
        input=half.of_forces(rows),
    )


@lru_cache(maxsize=16)
def _modes(shape: tuple[int, ...], mass: bytes, damping: bytes, stiffness: bytes) -> FreeModes:
    """Modes of systems with these matrices, which rows of a map have in common where only loads differ."""
    matrices = (np.frombuffer(part).reshape(shape) for part in (mass, damping, stiffness))
    return FreeModes.of_matrices(*matrices)


def _inverse(basis: ComplexArray) -> ComplexArray:
    """Inverse of modes as columns, (..., 2n, 2n), refused where they are close to dependent."""
    try:
        inverse = np.asarray(np.linalg.inv(basis), dtype=complex)
        bound = np.max(np.linalg.norm(basis, axis=(-2, -1)) * np.linalg.norm(inverse, axis=(-2, -1)))
    except np.linalg.LinAlgError:
        inverse, bound = basis, np.inf
    # Frobenius norms bound the condition number; where they do not suffice, singular values tell.
    if not bound < _MOST_DEPENDENT:
        condition = np.max(np.linalg.cond(basis))
        if not condition < _MOST_DEPENDENT:
            raise UnsuitableSystemError(
                f"the free modes are close to dependent (condition number {condition:.2g})"
            )
    return inverse


@dataclass(frozen=True, eq=False)
class HeldSystems:
    """Systems with a spring for each motion that hangs on nothing, and what it takes to undo that.

    A spring ω² M r rᵀM lets the undamped motion r of unit mass oscillate and leaves all others alone. Taken back as
    one more load, of shape M r and stiffness −ω², it changes nothing in the motion of the whole.

    Attributes
    ----------
    systems : sequence of PeriodicSystem
    modes : FreeModes
    springs : array, shape (S, extra loads)
        ω² [1/s²], to be taken off again.
    """

    systems: Sequence[PeriodicSystem]
    modes: FreeModes
    springs: FloatArray

    @classmethod
    def of(cls, systems: Sequence[PeriodicSystem], stiffest: float, fewest: int) -> HeldSystems:
        """Hold what needs it, by springs as strong as the loads, whose sum over their mobilities is `stiffest` [1/s²].

        Systems of fewer than `fewest` coordinates are not held.

        Raises
        ------
        UnsuitableSystemError
            If springs are not all that is missing.
        """
        none = np.zeros((len(systems), 0))
        try:
            return cls(systems, FreeModes.of_all(systems), none)
        except UnsuitableSystemError:
            if systems[0].size < fewest:
                raise
            # One direction serves all: that of a system with as many such motions as any.
            count, first = 0, systems[0]
            for system in systems:
                slow = int(np.count_nonzero(_undamped(system)[0] <= _SLOWEST**2))
                count, first = (slow, system) if slow > count else (count, first)
            if count == 0:
                raise
        _, size, turned = _undamped(first)
        strength = float(np.clip(stiffest, _SOFTEST**2 * size, size)) if size > 0.0 else stiffest
        if strength == 0.0:
            strength = 1.0 / max(system.period for system in systems) ** 2
        # M r = L times a unit vector, M = L Lᵀ.
        columns = np.linalg.cholesky(first.mass) @ turned[:, :count]
        extra = tuple(ContactLoad(PiecewiseChebyshev.constant(column)) for column in columns.T)
        spring = strength * columns @ columns.T
        held = [
            replace(system, stiffness=system.stiffness + spring, loads=system.loads + extra)
            for system in systems
        ]
        return cls(held, FreeModes.of_all(held), np.full((len(systems), count), strength))

    def some(self, places: NDArray[np.intp]) -> HeldSystems:
        """Return some of the systems, by their places."""
        systems = [self.systems[place] for place in places.tolist()]
        return HeldSystems(systems, self.modes.of_some(places), self.springs[places])


def _undamped(system: PeriodicSystem) -> tuple[FloatArray, float, FloatArray]:
    """Squares of undamped frequencies over the largest, ascending (n,), that [1/s²], and modes times Lᵀ, M = L Lᵀ."""
    inverse = np.linalg.inv(np.linalg.cholesky(system.mass))
    reduced = inverse @ system.stiffness @ inverse.T
    squares, turned = np.linalg.eigh((reduced + reduced.T) / 2.0)
    largest = float(np.abs(squares).max())
    return squares / (largest if largest > 0.0 else 1.0), largest, turned
