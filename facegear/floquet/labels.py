"""Names of instabilities: which modes, sum or difference, which order.

The motion of the critical multiplier λ = e^{(σ + iθ/T0) T0} is made of the natural motions of the mean system, of
which those matter that keep in step with it: ±ω_k ≡ θ/T0 modulo ω = 2π/T0. Two such, Ω_a − Ω_b ≈ sω, make a
combination resonance of order s. It is a sum if their frequencies have different signs, else a difference. A steady
response that forces cause is large where one of them is in step with a harmonic, ω_k ≈ sω. Modes are numbered as in
:mod:`facegear.floquet.modal`, by ascending natural frequency of the mean system at the given speed.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

from facegear.floquet.collocation import transition_matrices_to
from facegear.floquet.free_modes import UnsuitableSystemError
from facegear.floquet.methods import Method
from facegear.floquet.models import Coordinate
from facegear.floquet.modes import NaturalMotions
from facegear.floquet.multipliers import transition_matrix
from facegear.floquet.periodic import PeriodicSystem
from facegear.support.types import ComplexArray, FloatArray

if TYPE_CHECKING:
    from facegear.floquet.response import SteadyResponse

Kind = Literal["sum", "difference", "mean"]

# Instants of the period over which the part of each mode in the motion is averaged.
_INSTANTS = 8
# Distance from exact resonance, as a part of ω, at which a pair counts half.
_DETUNING = 0.1
# Kinetic energies of parts that differ by no more than this are the same, relative.
_ALIKE = 1e-6


@dataclass(frozen=True)
class Combination:
    """Modes and order of an instability.

    Attributes
    ----------
    k, j : int
        Numbers of the natural frequencies, from 1, ascending; equal for a single frequency; 0 if the growing
        motion of the mean system does not oscillate, which is divergence.
    kind : {"sum", "difference", "mean"}
        sω ≈ ω_k + ω_j, sω ≈ ω_j − ω_k, or a natural motion grows by itself.
    order : int
        s; 0 for the mean system.
    """

    k: int
    j: int
    kind: Kind
    order: int

    @property
    def label(self) -> str:
        """Such as "(1+2)/1" or "(3-1)/2", as :attr:`facegear.floquet.hsu.ResonanceBand.label`.

        "mean 2" for flutter of the second natural motion, "mean 0" for divergence.
        """
        if self.kind == "mean":
            return f"mean {self.k}"
        if self.kind == "sum":
            return f"({self.k}+{self.j})/{self.order}"
        return f"({self.j}-{self.k})/{self.order}"


@dataclass(frozen=True)
class Resonance:
    """What makes a steady response large: a natural motion in step with a harmonic of the mesh.

    Attributes
    ----------
    k : int
        Number of the natural frequency, from 1, ascending; 0 if nothing oscillates.
    order : int
        s of sω ≈ ω_k.
    """

    k: int
    order: int

    @property
    def label(self) -> str:
        """Such as "3/2": the third natural motion, driven twice in a mesh period."""
        return f"{self.k}/{self.order}"


def resonance(response: SteadyResponse) -> Resonance:
    """Name the resonance that a steady response is mostly made of.

    Parameters
    ----------
    response : SteadyResponse
        Best taken at a peak over speed.

    Returns
    -------
    Resonance
        Of all natural motions of the mean system and all harmonics near them the two with the largest energy.
    """
    system = response.system
    modes = _MeanModes.of(system)
    frequency = 2.0 * np.pi / system.period
    oscillating = np.flatnonzero((modes.numbers > 0) & (modes.eigenvalues.imag > 0.0))
    if oscillating.size == 0:
        return Resonance(0, 0)
    steps = modes.eigenvalues[oscillating].imag / frequency
    harmonics = response.harmonics(int(steps.max()) + 1)[1:]
    energy = np.abs(modes.coordinates[oscillating] @ harmonics.T) ** 2
    detuning = (steps[:, np.newaxis] - np.arange(1, len(harmonics) + 1)) / _DETUNING
    mode, order = np.unravel_index(int((energy / (1.0 + detuning**2)).argmax()), energy.shape)
    return Resonance(int(modes.numbers[oscillating[mode]]), int(order) + 1)


def combination(system: PeriodicSystem, method: Method | None = None) -> Combination:
    """Name the instability of a system after the modes that take part in its critical motion.

    Parameters
    ----------
    system : PeriodicSystem
        An unstable one, best taken at the peak of the growth rate.
    method : Method, optional
        Method of :mod:`facegear.floquet.methods` for the transition matrix of the period.

    Returns
    -------
    Combination
        Of all pairs with Ω_a − Ω_b near a multiple of ω the one with the largest product of actions in the motion.
        "mean" if the mean system by itself grows at least half as fast, or if there is no such pair because the mesh
        is too fast for any: then of the natural motion with the most energy.
    """
    return growth_and_combination(system, method)[1]


def growth_and_combination(system: PeriodicSystem, method: Method | None = None) -> tuple[float, Combination]:
    """Return the growth rate [1/s] of a system as well as what :func:`combination` names it.

    Parameters
    ----------
    system, method
        As there.
    """
    modes = _MeanModes.of(system)
    values, vectors = np.linalg.eig(transition_matrix(system, method))
    critical = int(np.abs(values).argmax())
    growth = float(np.log(np.abs(values[critical]))) / system.period
    fastest = int(modes.eigenvalues.real.argmax())
    if growth > 0.0 and modes.eigenvalues[fastest].real >= 0.5 * growth:
        number = int(modes.numbers[fastest])
        return growth, Combination(number, number, "mean", 0)
    action, energy = np.zeros((2, modes.eigenvalues.size))
    for state in _critical_motion(system, complex(values[critical]), vectors[:, critical], method):
        action += modes.action(state)
        energy += modes.energy(state)
    pair = _strongest_pair(modes, action, 2.0 * np.pi / system.period)
    if pair is None:
        number = int(modes.numbers[energy.argmax()])
        return growth, Combination(number, number, "mean", 0)
    return growth, pair


def moving_parts(system: PeriodicSystem, coordinates: Sequence[Coordinate]) -> tuple[str, ...]:
    """Name the part that moves most in each natural motion of the mean system.

    Parameters
    ----------
    system : PeriodicSystem
    coordinates : sequence of Coordinate
        Of the model that the system is of.

    Returns
    -------
    tuple of str
        `Coordinate.part` with the largest kinetic energy, or the name where that is empty, of the motions 1, 2, 3 ...
        in the order of the numbers of a :class:`Combination`; parts that have as much of it are joined by "and".

    Raises
    ------
    ValueError
        If there is not one coordinate for each of the system.

    Examples
    --------
    >>> from facegear.floquet.periodic import PeriodicSystem
    >>> apart = PeriodicSystem(np.eye(2), np.zeros((2, 2)), np.diag([9.0, 1.0]), (), 1.0)
    >>> moving_parts(apart, [Coordinate("w", "m", "disk"), Coordinate("x", "m", "pinion")])
    ('pinion', 'disk')
    """
    if len(coordinates) != system.size:
        raise ValueError(
            f"coordinates must be {system.size}, one a row of the system's matrices; got {len(coordinates)}"
        )
    motions = NaturalMotions.of_mean(system)
    velocities = motions.velocities[:, motions.oscillating]
    energies = (velocities.conj() * (motions.mass @ velocities)).real
    owners = [coordinate.part or coordinate.name for coordinate in coordinates]
    parts = list(dict.fromkeys(owners))
    shares = np.stack([energies[[owner == part for owner in owners]].sum(axis=0) for part in parts])
    # Parts alike share a motion alike, and which of them came out larger is rounding.
    most = shares > (1.0 - _ALIKE) * shares.max(axis=0)
    return tuple(" and ".join(np.array(parts)[chosen].tolist()) for chosen in most.T)


@dataclass(frozen=True, eq=False)
class _MeanModes:
    """Natural motions of the mean system.

    Attributes
    ----------
    eigenvalues : complex array, shape (2n,)
    numbers : int array, shape (2n,)
        Number of the mode from 1, by ascending frequency, for both signs; 0 for those that do not oscillate.
    coordinates : complex array, shape (2n, 2n)
        Amplitudes of the natural motions, of unit energy, from the state (q, q̇).
    """

    eigenvalues: ComplexArray
    numbers: NDArray[np.int64]
    coordinates: ComplexArray

    @classmethod
    def of(cls, system: PeriodicSystem) -> _MeanModes:
        motions = NaturalMotions.of_mean(system)
        values = motions.exponents
        numbers = np.zeros(values.size, dtype=np.int64)
        for number, index in enumerate(motions.oscillating.tolist(), start=1):
            numbers[index] = number
            numbers[np.abs(values - values[index].conj()).argmin()] = number
        # Nearly dependent motions, as at critical damping, only blur the shares.
        return cls(values, numbers, np.linalg.pinv(motions.vectors) @ motions.from_state)

    def energy(self, state: ComplexArray) -> FloatArray:
        """Energy of each natural motion in a state."""
        return np.asarray(np.abs(self.coordinates @ state) ** 2, dtype=float)

    def action(self, state: ComplexArray) -> FloatArray:
        """Energy over frequency of each natural motion in a state, in parts of the whole."""
        frequency = np.abs(self.eigenvalues.imag)
        action = np.where(
            self.numbers > 0, self.energy(state) / np.where(frequency > 0.0, frequency, 1.0), 0.0
        )
        return np.asarray(action / max(float(action.sum()), np.finfo(float).tiny), dtype=float)


def _critical_motion(
    system: PeriodicSystem, critical: complex, state: ComplexArray, method: Method | None
) -> list[ComplexArray]:
    """States (q, q̇) of a multiplier's motion at instants of the period, up to a factor, from the first of them."""
    instants = [instant / _INSTANTS for instant in range(_INSTANTS)]
    with suppress(UnsuitableSystemError):
        return list(transition_matrices_to(instants, system) @ state)
    return [_critical_state(system.shift(instant), critical, method) for instant in instants]


def _critical_state(system: PeriodicSystem, critical: complex, method: Method | None) -> ComplexArray:
    values, vectors = np.linalg.eig(transition_matrix(system, method))
    return np.asarray(vectors[:, np.abs(values - critical).argmin()], dtype=complex)


def _strongest_pair(modes: _MeanModes, action: FloatArray, frequency: float) -> Combination | None:
    """Pair of natural motions in step with one another that has the largest part in the motion, if there is one."""
    oscillating = np.flatnonzero(modes.numbers > 0)
    turns, parts = modes.eigenvalues.imag[oscillating] / frequency, np.sqrt(action[oscillating])
    apart = turns[:, np.newaxis] - turns
    orders = np.round(apart)
    weights = np.outer(parts, parts) / (1.0 + (np.abs(apart - orders) / _DETUNING) ** 2)
    if not (orders >= 1.0).any():
        return None
    a, b = np.unravel_index(int(np.where(orders >= 1.0, weights, -1.0).argmax()), weights.shape)
    k, j = sorted(modes.numbers[oscillating[[a, b]]].tolist())
    kind: Kind = "sum" if turns[a] * turns[b] < 0.0 else "difference"
    return Combination(k, j, kind, int(orders[a, b]))
