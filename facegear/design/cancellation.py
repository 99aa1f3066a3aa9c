r"""Which positions of the pinions silence a tongue (chapter 5).

Pinion i, at angle θ_i and phase ψ_i, is the first one moved on: r_i(t) = r_1(t + ψ_i T0) and
θ_i(t) = θ_i + θ_1(t + ψ_i T0) (5-4). In the complex coordinates of (5-7) its load couples e^{inθ} and e^{in′θ} through
e^{−i(n−n′)θ_i(t)} R_n R_n′(r_i(t)), whose Fourier coefficient of order s is that of the first pinion times
e^{i[2πsψ_i − (n−n′)θ_i]}. A combination resonance of order s needs just that coefficient. For two waves e^{i(ωt − nθ)}
of n_1 and n_2 nodal diameters, positive where they run towards growing θ, all pinions together thus give

    S = Σ_i exp(i[2πsψ_i + (n_1 ± n_2) θ_i])                                                             (C-1)

times the coupling by one: plus for a sum, sω = ω_1 + ω_2, minus for a difference. To first order in the load the
tongue's width and growth are those of one pinion times |S|. And as 2πψ_i is N_2 θ_i but for whole turns (5-1),

    S = Σ_i exp(i (s N_2 + n_1 ± n_2) θ_i) :                                                              (C-2)

each tongue sees a gear of s N_2 + n_1 ± n_2 teeth.

Loads that are not weak mix waves into standing ones before they modulate them. What the pinions then add up to first
order is :func:`pinion_couplings`; for two equal pinions modes are even or odd about the middle between them, and

    |S| = 2|cos πsψ| (both even, or both odd),   2|sin πsψ| (one even, one odd)                           (C-3)
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from facegear.floquet.gauss_panels import gauss_rule
from facegear.floquet.modes import NaturalMotions
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.maps.tracing import Tongue, tongues
from facegear.mechanics.disk import disk_modes
from facegear.mechanics.properties import MeshLoad
from facegear.mechanics.rotation import DiskWaves
from facegear.mechanics.transverse import Transverse
from facegear.support.parameters import finite_array, integer_at_least, positive, within
from facegear.support.types import ComplexArray

Kind = Literal["sum", "difference"]

# Gauss nodes on each smooth piece of the period.
_NODES = 40


def phasing_sum(
    gear_teeth: int, pinion_angles: ArrayLike, wave_number: ArrayLike, order: int = 1
) -> ComplexArray:
    """Sum over the pinions by which they couple two waves, with one pinion as the unit (C-2).

    Parameters
    ----------
    gear_teeth : int
        N2.
    pinion_angles : array_like, shape (..., p)
        θ_c of the pinions [rad].
    wave_number : array_like, shape (...)
        n_1 + n_2 of a sum, n_1 − n_2 of a difference, whole numbers.
    order : int, optional
        s.

    Returns
    -------
    complex array, shape (...)
        S; its modulus is at most p.

    Raises
    ------
    TypeError, ValueError
        If an argument is of the wrong kind or outside its range.

    Examples
    --------
    >>> import math
    >>> f"{abs(phasing_sum(155, [0.0, math.pi], 0)):.6f}"
    '0.000000'
    """
    teeth = integer_at_least("gear_teeth", gear_teeth, 1)
    angles = finite_array("pinion_angles", pinion_angles, "rad")
    if angles.ndim == 0 or angles.shape[-1] == 0:
        raise ValueError(f"pinion_angles must list one angle a pinion, got {pinion_angles!r}")
    numbers = finite_array("wave_number", wave_number)
    if (numbers != np.rint(numbers)).any():
        raise ValueError(f"wave_number must be whole, got {wave_number!r}")
    own_teeth = integer_at_least("order", order, 1) * teeth + numbers
    return np.asarray(np.exp(1j * own_teeth[..., np.newaxis] * angles).sum(axis=-1), dtype=complex)


def loud_wave_numbers(gear_teeth: int, pinions: int, highest: int, order: int = 1) -> tuple[int, ...]:
    """Wave numbers that equally spaced pinions do not silence: s N2 + n_1 ± n_2 is divisible by their number.

    Parameters
    ----------
    gear_teeth, order
        As for :func:`phasing_sum`.
    pinions : int
        p.
    highest : int
        Wave numbers from −highest to highest are looked at.

    Returns
    -------
    tuple of int
        For these |S| = p, for all others S = 0.
    """
    teeth = integer_at_least("order", order, 1) * integer_at_least("gear_teeth", gear_teeth, 1)
    count, end = integer_at_least("pinions", pinions, 1), integer_at_least("highest", highest, 0)
    return tuple(number for number in range(-end, end + 1) if (teeth + number) % count == 0)


@dataclass(frozen=True)
class Wave:
    """A wave e^{i(ωt − nθ)} of the spinning disk.

    Attributes
    ----------
    nodal_circles : int
        m.
    nodal_diameters : int
        n, positive for a wave that runs towards growing θ.
    """

    nodal_circles: int
    nodal_diameters: int

    def frequency(self, waves: DiskWaves) -> float:
        """Natural frequency ω [rad/s] in the space-fixed frame.

        Raises
        ------
        ValueError
            If the disk has no such wave.
        """
        own = np.sort(waves.eigenvalues.imag[waves.waves == self.nodal_diameters])
        if not 0 <= self.nodal_circles < own.size:
            raise ValueError(f"{self} is not among the waves of the disk")
        return float(own[self.nodal_circles])


@dataclass(frozen=True)
class WavePair:
    """Two waves in combination resonance.

    Attributes
    ----------
    first, second : Wave
    kind : {"sum", "difference"}
        sω = ω_1 + ω_2 or ω_1 − ω_2.
    order : int
        s.
    """

    first: Wave
    second: Wave
    kind: Kind = "sum"
    order: int = 1

    @property
    def sign(self) -> int:
        """Plus one for a sum, minus one for a difference."""
        return 1 if self.kind == "sum" else -1

    @property
    def wave_number(self) -> int:
        """n_1 ± n_2."""
        return self.first.nodal_diameters + self.sign * self.second.nodal_diameters

    def phasing_sum(self, model: Transverse) -> complex:
        """S of the pinions of a model (C-2)."""
        # Where the contact travels with the disk all angles count the other way.
        number = round(model.contact.sense) * self.wave_number
        return complex(phasing_sum(model.body.drive.gear_teeth, model.pinion_angles, number, self.order))

    def speed(self, model: Transverse) -> float:
        """Speed at which the disk of a model, without its pinions, is in this resonance [rad/s].

        Raises
        ------
        ValueError
            If the disk has no such waves, or they are in resonance at no speed.
        """
        light = replace(model, load=MeshLoad(stiffness=0.0, damping=0.0, mass=0.0), pinion_angles=(0.0,))
        teeth = self.order * model.body.drive.gear_teeth

        def detuning(speed: float) -> float:
            waves = DiskWaves.of(light, light.system(speed))
            return teeth * speed - self.first.frequency(waves) - self.sign * self.second.frequency(waves)

        start = -detuning(1e-3)
        if start <= 0.0:
            raise ValueError(f"{self} is in resonance at no speed above 0")
        return float(brentq(detuning, start / teeth / 2, 2 * start / teeth, xtol=1e-9, rtol=1e-12))


def weakened(model: Transverse, factor: float) -> Transverse:
    """Return the model with stiffness and mass of its pinions times a small factor and without any damping.

    Its tongues are as wide as the load couples waves, and (C-1) is what they tend to as the factor goes to 0.

    Parameters
    ----------
    model : Transverse
    factor : float
        Greater than 0.
    """
    share = positive("factor", factor)
    load = MeshLoad(model.load.stiffness * share, 0.0, model.load.mass * share)
    material = replace(model.body.material, viscous_loss_factor=0.0)
    return replace(model, body=replace(model.body, material=material), load=load)


def tongue_of(model: Transverse, pair: WavePair, below: float, above: float) -> Tongue | None:
    """Strongest tongue of its order close to the resonance of a pair of waves.

    Parameters
    ----------
    model : Transverse
    pair : WavePair
    below, above : float
        Parts of the resonance's speed by which the range looked at goes below and above it: the mass of the pinions
        lowers the frequencies.

    Returns
    -------
    Tongue or None
        None if there is none.
    """
    centre = pair.speed(model)
    low, high = (
        centre * (1 - within("below", below, 0.0, 0.5)),
        centre * (1 + within("above", above, 0.0, 0.5)),
    )
    found = tongues(model, (low, high), threshold=1e-10)
    own = [t for t in found if (t.combination.kind, t.combination.order) == (pair.kind, pair.order)]
    return max(own, key=lambda tongue: tongue.growth_rate, default=None)


def pinion_couplings(
    system: PeriodicSystem, k: int, j: int, kind: Kind = "sum", order: int = 1
) -> ComplexArray:
    """Return what each load adds to the coupling of two modes of the mean system, to first order.

    Parameters
    ----------
    system : PeriodicSystem
        Loads with frozen rate.
    k, j : int
        Numbers of the natural frequencies of the mean system, from 1, ascending.
    kind : {"sum", "difference"}
        sω ≈ ω_k + ω_j or ω_j − ω_k.
    order : int
        s.

    Returns
    -------
    complex array, shape (p,)
        Parts of one sum; the modulus of the sum over the sum of the moduli says how far the loads silence each other.

    Raises
    ------
    TypeError, ValueError
        If a number is out of range or a load has a weight or a total rate.
    """
    harmonic = integer_at_least("order", order, 1)
    if any(load.rate != "frozen" or load.weight is not None for load in system.loads):
        raise ValueError("system must have loads of frozen rate without weight")
    motions = NaturalMotions.of_mean(system)
    values, right = motions.exponents, motions.displacements
    left = motions.of_forces(motions.amplitudes)
    ascending = motions.oscillating
    for name, number in (("k", k), ("j", j)):
        if integer_at_least(name, number, 1) > ascending.size:
            raise ValueError(f"{name} must be at most {ascending.size}, the number of modes, got {number!r}")
    a, b = ascending[j - 1], ascending[k - 1]
    if kind == "sum":
        b = int(np.abs(values - values[b].conj()).argmin())
    parts = []
    for load in system.loads:
        modulation = _shape_products(load.shape, harmonic)
        strength = load.stiffness + load.damping * values[b] + load.mass * values[b] ** 2
        parts.append(-left[a] @ modulation @ right[:, b] * strength)
    return np.asarray(parts, dtype=complex)


def _shape_products(shape: PiecewiseChebyshev, harmonic: int) -> ComplexArray:
    """Coefficient of e^{isωt} of φφᵀ, s the harmonic, shape (n, n)."""
    nodes, weights, _ = gauss_rule(_NODES)
    edges = np.append(shape.breakpoints, shape.breakpoints[0] + 1.0)
    length = np.diff(edges)
    fractions = (edges[:-1, np.newaxis] + length[:, np.newaxis] * nodes).ravel()
    phi = shape(fractions)
    turning = np.outer(length, weights).ravel() * np.exp(-2j * np.pi * harmonic * fractions)
    return np.asarray((phi.T * turning) @ phi, dtype=complex)


def interference(system: PeriodicSystem, k: int, j: int, kind: Kind = "sum", order: int = 1) -> float:
    """Return what is left of the loads' couplings when they add: 1 in step, 0 silenced (:func:`pinion_couplings`)."""
    parts = pinion_couplings(system, k, j, kind, order)
    return float(np.abs(parts.sum()) / np.abs(parts).sum())


def mode_content(model: Transverse, speed: float, mode: int) -> dict[tuple[int, int], float]:
    """Parts of the disk's own modes in a mode of the mean system, by squared amplitude.

    Parameters
    ----------
    model : Transverse
    speed : float
        Ω2 [rad/s].
    mode : int
        Number of its natural frequency, from 1.

    Returns
    -------
    dict of (int, int) to float
        Nodal circles and diameters (m, n) to their part; the parts add up to 1.

    Raises
    ------
    TypeError, ValueError
        If there is no such mode.
    """
    system = model.system(speed)
    number = integer_at_least("mode", mode, 1)
    if number > system.size:
        raise ValueError(f"mode must be at most {system.size}, the number of modes, got {mode!r}")
    modes = NaturalMotions.of_mean(system).undamped
    squares = modes[:, number - 1] ** 2 / (modes[:, number - 1] ** 2).sum()
    parts: dict[tuple[int, int], float] = {}
    for shape, square in zip(disk_modes(model.body), squares.tolist(), strict=True):
        key = (shape.nodal_circles, shape.nodal_diameters)
        parts[key] = parts.get(key, 0.0) + square
    return parts
