"""Transition matrices of one disk under pinions at very many angles (chapter 5).

The total angle of a pinion does two things. Whole teeth of it turn the contact about the axis, θ → θ + θ_a; what is
left over sets the phase ψ of its mesh (5-1, 5-2). The spinning disk looks alike from all sides: its free motions are
waves e^{i(ωt − nθ)}, and a rotation multiplies what a contact sees of each, and what its force does to each, by
e^{∓inθ_a}. So of the equations of :mod:`facegear.floquet.contact_forces` all is known for every θ_a as soon as it is
known for θ_a = 0, at given phases:

    H_ab(θ) = Re Σ_n e^{−in(θ_a − θ_b)} H_ab,n,    F_a(θ) = F_a e^{−inθ_a},    G_b(θ) = e^{inθ_b} G_b.

This is exact, and a whole column of a map over the total angle needs one preparation for each phase.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from facegear.floquet.collocation import chain
from facegear.floquet.eigenvalues import spectral_radii
from facegear.floquet.free_modes import FreeModes
from facegear.floquet.gauss_panels import gauss_rule, panel_edges
from facegear.floquet.loads import ContactLoad
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import merge_breakpoints
from facegear.geometry.phases import phase_split
from facegear.mechanics.disk import disk_modes
from facegear.mechanics.transverse import Transverse
from facegear.support.parameters import finite_array
from facegear.support.types import ComplexArray, FloatArray

#: Gauss nodes a panel, and largest product of fastest frequency and panel length [rad].
NODES = 12
PANEL_ANGLE = 4.0
# Phases closer than this are the same.
_SAME_PHASE = 1e-9
# Size relative to the largest entry below which coupling between nodal diameters is rounding.
_ROUNDING = 1e-12
# Entries of the batches worked on at once: more would not stay in the processor's cache.
_BATCH = 100_000


@dataclass(frozen=True, eq=False)
class DiskWaves:
    """Free motions of a spinning disk as waves; n coordinates.

    Attributes
    ----------
    eigenvalues : complex array, shape (n,)
        p with positive imaginary part [1/s].
    waves : array, shape (n,)
        Signed nodal diameters n of e^{i(Im p t − nθ)}: positive for a wave that runs towards growing θ.
    displacement, velocity, input : complex array, shape (n, n)
        As in :class:`facegear.floquet.free_modes.FreeModes`.
    """

    eigenvalues: ComplexArray
    waves: FloatArray
    displacement: ComplexArray
    velocity: ComplexArray
    input: ComplexArray

    @classmethod
    def of(cls, model: Transverse, system: PeriodicSystem) -> DiskWaves:
        """Find the waves of the disk of a model at the speed of a system of it.

        Raises
        ------
        ValueError
            If the disk does not look alike from all sides.
        """
        diameters = np.array([mode.nodal_diameters for mode in disk_modes(model.body)])
        different = diameters[:, None] != diameters
        for name in ("mass", "damping", "stiffness"):
            matrix = getattr(system, name)
            if np.abs(matrix[different]).max(initial=0.0) > _ROUNDING * np.abs(matrix).max():
                raise ValueError(
                    f"model must have a disk that looks alike from all sides; its {name} couples nodal diameters"
                )
        n = diameters.size
        found = cls(
            np.empty(n, dtype=complex), np.empty(n), *(np.zeros((n, n), dtype=complex) for _ in range(3))
        )
        for diameter in range(int(diameters.max()) + 1):
            own = np.flatnonzero(diameters == diameter)
            block = np.ix_(own, own)
            modes = FreeModes.of(
                PeriodicSystem(
                    system.mass[block], system.damping[block], system.stiffness[block], (), system.period
                )
            )
            found.eigenvalues[own] = modes.eigenvalues
            found.waves[own] = diameter * _senses(modes.displacement) if diameter else 0.0
            for name in ("displacement", "velocity", "input"):
                getattr(found, name)[block] = getattr(modes, name)
        return found


def _senses(displacement: ComplexArray) -> FloatArray:
    """Sense of each wave a e^{ipt} cos nθ + b e^{ipt} sin nθ, first half of the rows a, second half b: b = ±ia."""
    cosine, sine = np.split(displacement, 2)
    ratio = (sine * cosine.conj()).sum(axis=0) / (np.abs(cosine) ** 2).sum(axis=0)
    if np.abs(np.abs(ratio.imag) - 1.0).max() > 1e-6 or np.abs(ratio.real).max() > 1e-6:
        raise ValueError(
            "model must have a disk that looks alike from all sides and spins; its motions are no waves"
        )
    return np.asarray(-np.sign(ratio.imag), dtype=float)


class TurnedPinions:
    """A disk under pinions of given phases, prepared for any angles.

    Parameters
    ----------
    model : Transverse
        Disk and load; its own pinion angles are not used. Rate "frozen".
    speed : float
        Ω2 of the face gear [rad/s], greater than 0.
    phases : array_like, shape (p,)
        ψ of each pinion [-].
    waves : DiskWaves, optional
        Of the same model at the same speed, if they are known.

    Raises
    ------
    TypeError, ValueError
        If an argument is not valid, the rate is "total", or the disk does not look alike from all sides.
    """

    def __init__(
        self, model: Transverse, speed: float, phases: ArrayLike, waves: DiskWaves | None = None
    ) -> None:
        chosen = finite_array("phases", phases)
        if chosen.ndim != 1 or chosen.size == 0:
            raise ValueError(f"phases must list one phase a pinion, got shape {chosen.shape}")
        system, load = _one_pinion(model, speed)
        known = DiskWaves.of(model, system) if waves is None else waves
        # Against the disk's rotation the contact is mirrored, and turning it on turns it the other way round.
        self._sense = model.contact.sense
        self._waves = known.waves
        self._prepare(system, load, known, chosen)

    def _prepare(
        self, system: PeriodicSystem, load: ContactLoad, modes: DiskWaves, phases: FloatArray
    ) -> None:
        shapes = [load.shape.shift(float(phase)) for phase in phases]
        breakpoints = merge_breakpoints([np.zeros(1), *(shape.breakpoints for shape in shapes)])
        samples = load.shape(np.linspace(0.0, 1.0, 16, endpoint=False))
        stiffest = phases.size * load.stiffness * float((samples**2).sum(axis=1).max())
        fastest = float(np.hypot(np.abs(modes.eigenvalues).max(), np.sqrt(stiffest)))
        edges = panel_edges(breakpoints, fastest * system.period, PANEL_ANGLE)
        x, weights, integration = gauss_rule(NODES)
        length = np.diff(edges)
        h = length * system.period
        # Exponentials from the middle of each panel, so that neither they nor their inverses grow large.
        spread = np.exp(modes.eigenvalues * (h[:, None, None] * (x[:, None] - 0.5)))
        half = np.exp(modes.eigenvalues * (h[:, None, None] / 2.0))

        fractions = edges[:-1, None] + length[:, None] * x
        phi = np.stack([shape(fractions) for shape in shapes])
        force = (
            load.stiffness * modes.displacement
            + (load.damping + load.mass * modes.eigenvalues) * modes.velocity
        )
        rows = (phi @ force) * spread
        beta = phi @ modes.input.T
        columns = beta / spread
        direct = load.mass * (phi @ modes.velocity)
        self._numbers = np.unique(modes.waves)
        own = [np.flatnonzero(modes.waves == number) for number in self._numbers]
        pinions, panels = phases.size, length.size
        self._kernel = np.zeros((pinions, pinions, len(own), panels, NODES, NODES), dtype=complex)
        window = h[:, None, None] * integration
        nodes = np.arange(NODES)
        for a in range(pinions):
            for b in range(pinions):
                for place, m in enumerate(own):
                    block = (rows[a][..., m] @ columns[b][..., m].swapaxes(-1, -2)) * window
                    block[:, nodes, nodes] += (direct[a][..., m] * beta[b][..., m]).sum(axis=-1)
                    self._kernel[a, b, place] = block
        self._rows = (rows * half).swapaxes(0, 1)
        self._push = (columns * half * (h[:, None] * weights)[:, :, None]).swapaxes(0, 1)
        self._free = _oscillations(half[:, 0] ** 2)

    def transition_matrices(self, angles: ArrayLike) -> FloatArray:
        """Transition matrices in the coordinates (Re, Im) of the waves.

        Parameters
        ----------
        angles : array_like, shape (V, p)
            Angle of each pinion [rad]; the phases stay what they are.

        Returns
        -------
        array, shape (V, 2n, 2n)
        """
        pinions = self._kernel.shape[0]
        turned = self._sense * finite_array("angles", angles, "rad")
        if turned.ndim != 2 or turned.shape[1] != pinions:
            raise ValueError(f"angles must have shape (V, {pinions}), one angle a pinion; got {turned.shape}")
        panels, size = self._free.shape[0], pinions * NODES
        batch = max(1, _BATCH // (panels * size * (size + 2 * self._waves.size)))
        parts = [self._batch(turned[begin : begin + batch]) for begin in range(0, turned.shape[0], batch)]
        return np.concatenate(parts)

    def _batch(self, angles: FloatArray) -> FloatArray:
        values, pinions = angles.shape
        panels, n = self._free.shape[0], self._waves.size
        size = pinions * NODES
        blocks = np.empty((values, panels, pinions, NODES, pinions, NODES))
        for a in range(pinions):
            for b in range(pinions):
                factor = np.exp(-1j * np.outer(angles[:, a] - angles[:, b], self._numbers))
                kernel = self._kernel[a, b].reshape(self._numbers.size, -1)
                entries = factor.real @ kernel.real - factor.imag @ kernel.imag
                blocks[:, :, a, :, b, :] = entries.reshape(values, panels, NODES, NODES)
        left = blocks.reshape(values, panels, size, size)
        left[..., np.arange(size), np.arange(size)] += 1.0
        turn = np.exp(-1j * angles[:, :, None] * self._waves)[:, None, :, None, :]
        rows, push = self._rows * turn, self._push * turn.conj()
        right = np.concatenate([rows.real, -rows.imag], axis=-1).reshape(values, panels, size, 2 * n)
        answer = np.concatenate([push.real, push.imag], axis=-1).reshape(values, panels, size, 2 * n)
        return chain(self._free - answer.swapaxes(-1, -2) @ np.linalg.solve(left, right))


def _one_pinion(model: Transverse, speed: float) -> tuple[PeriodicSystem, ContactLoad]:
    """System with one pinion at angle 0, and its load."""
    if model.contact.rate != "frozen":
        raise ValueError(
            f'rate of the model must be "frozen" for pinions to be turned, got {model.contact.rate!r}'
        )
    system = replace(model, pinion_angles=(0.0,)).system(speed)
    if len(system.loads) != 1:
        raise ValueError(f"model must have no loads but its pinions, got {len(system.loads) - 1} more")
    return system, system.loads[0]


def _oscillations(decay: ComplexArray) -> FloatArray:
    """Matrices of y → decay y on (Re y, Im y), shape (P, n) -> (P, 2n, 2n)."""
    panels, n = decay.shape
    matrices = np.zeros((panels, 2 * n, 2 * n))
    i = np.arange(n)
    matrices[:, i, i] = matrices[:, n + i, n + i] = decay.real
    matrices[:, n + i, i], matrices[:, i, n + i] = decay.imag, -decay.imag
    return matrices


def growth_rates_at_angles(model: Transverse, speed: float, pinion_angles: ArrayLike) -> FloatArray:
    """Growth rates of one disk under pinions at many sets of total angles, at one speed.

    Parameters
    ----------
    model : Transverse
        Disk and load; its own pinion angles are not used. Rate "frozen".
    speed : float
        Ω2 of the face gear [rad/s], greater than 0.
    pinion_angles : array_like, shape (V, p)
        Total angles θ_c of the pinions [rad], one set a row; their phases follow from the teeth (5-1, 5-2).

    Returns
    -------
    array, shape (V,)
        ln(max|λ|)/T0 [1/s], as :func:`facegear.floquet.multipliers.growth_rate` of the model with each set.

    Raises
    ------
    TypeError, ValueError
        If an argument is not valid, or two pinions of a set are at one place.
    """
    angles = finite_array("pinion_angles", pinion_angles, "rad")
    if angles.ndim != 2 or 0 in angles.shape:
        raise ValueError(f"pinion_angles must have shape (sets, pinions), got {angles.shape}")
    for pair in range(1, angles.shape[1]):
        apart = np.abs(np.angle(np.exp(1j * (angles[:, pair:] - angles[:, pair - 1 : pair]))))
        if apart.min() < 1e-6:
            raise ValueError("pinion_angles must differ from one another within each set")
    system, _ = _one_pinion(model, speed)
    waves = DiskWaves.of(model, system)
    phases = phase_split(model.body.drive, angles).phase
    _, group = np.unique(np.rint(phases / _SAME_PHASE), axis=0, return_inverse=True)
    matrices = np.empty((angles.shape[0], 2 * waves.waves.size, 2 * waves.waves.size))
    for number in range(int(group.max()) + 1):
        own = np.flatnonzero(group.ravel() == number)
        pinions = TurnedPinions(model, speed, phases[own[0]], waves)
        matrices[own] = pinions.transition_matrices(angles[own])
    return np.asarray(np.log(spectral_radii(matrices)) / system.period, dtype=float)
