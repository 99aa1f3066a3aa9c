"""Contact-force collocation: fast transition matrices of systems with rank-one loads.

Between contacts' instants of entry and exit the free motion of the constant part M q̈ + C q̇ + K q = 0 is known
exactly from its modes, and all that is unknown are the contact forces

    f_a = k_a u_a + c_a u̇_a + m_a ü_a,    u_a = φ_aᵀ q,

a few scalar functions of time. They are found at the Gauss nodes of panels that end at the breakpoints. With
modal coordinates y of the free motion, ẏ = Λ y − Σ β_a f_a, variation of constants gives on each panel

    [I + k H₀ + c H₁ + m (H₂ + D)] f = (k F₀ + c F₁ + m F₂) y₀,    y₁ = E y₀ − G f

where H_s = h a_ij Re Σ_m z_s,im e^{p_m (t_i − t_j)} β_jm, with spectral integration weights a_ij; z₀, z₁, z₂ turn
modal coordinates into u, u̇, ü of the free motion and D_ab = φ_aᵀ M⁻¹ φ_b, which carries the contact mass exactly.
H, F, E, G do not depend on k, c, m, so a whole column of a map shares them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from facegear.periodic import LoadColumn, PeriodicSystem
from facegear.piecewise import Array, merge_breakpoints

ComplexArray = NDArray[np.complex128]

#: Gauss nodes a panel.
DEFAULT_NODES = 16
#: Largest product of fastest frequency and panel length [rad].
DEFAULT_PANEL_ANGLE = 9.0
#: Estimated error of the motion over one panel at which it is halved, in units of the root of the energy.
PANEL_TOLERANCE = 1e-12
# Rounds of halving before a system is refused.
_MOST_HALVINGS = 8
# Panels of one system are tried on others that turn by at least this part of its angle in a period.
_SHARED = 0.6


class UnsuitableSystemError(ValueError):
    """The free motion of a system is not a sum of oscillations, which contact-force collocation needs."""


@dataclass(frozen=True, eq=False)
class FreeModes:
    """Modes of M q̈ + C q̇ + K q = 0: q = Re(displacement y), q̇ = Re(velocity y), y = coordinates (q, q̇).

    Attributes
    ----------
    eigenvalues : array of complex, shape (n,)
        p with positive imaginary part [1/s].
    displacement, velocity : array of complex, shape (n, n)
        Columns of modes, scaled to unit kinetic energy.
    coordinates : array of complex, shape (n, 2n)
        y from the state.
    input : array of complex, shape (n, n)
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
        n = system.size
        inverse = np.linalg.inv(np.linalg.cholesky(system.mass))
        stiffness = inverse @ system.stiffness @ inverse.T
        damping = inverse @ system.damping @ inverse.T
        scale = float(np.sqrt(np.abs(stiffness).max()))
        if scale == 0.0:
            raise UnsuitableSystemError("stiffness is zero: every free motion is a rigid-body motion")
        # In the state (scale·x, ẋ) both halves have the size of a root energy.
        state = np.block([[np.zeros((n, n)), scale * np.eye(n)], [-stiffness / scale, -damping]])
        values, vectors = np.linalg.eig(state)
        oscillating = values.imag > 1e-9 * np.abs(values).max()
        if np.count_nonzero(oscillating) != n:
            raise UnsuitableSystemError(
                f"the free motion has {np.count_nonzero(oscillating)} oscillating modes, not {n}: "
                "some are rigid-body or overdamped"
            )
        values = values[oscillating]
        vectors = vectors[:, oscillating]
        vectors = vectors / np.linalg.norm(vectors[n:], axis=0)
        basis = np.concatenate([vectors, vectors.conj()], axis=1)
        condition = np.linalg.cond(basis)
        if not condition < 1e5:
            raise UnsuitableSystemError(
                f"the free modes are close to dependent (condition number {condition:.2g})"
            )
        # x = Re(W y) with y twice the coefficients of the pairs W c + conj(W c).
        rows = 2.0 * np.linalg.inv(basis)[:n]
        root = inverse.T
        to_energy = np.linalg.inv(root)
        return cls(
            eigenvalues=values,
            displacement=root @ vectors[:n] / scale,
            velocity=root @ vectors[n:],
            coordinates=np.concatenate([rows[:, :n] * scale @ to_energy, rows[:, n:] @ to_energy], axis=1),
            input=np.asarray(rows[:, n:] @ inverse, dtype=complex),
        )

    @property
    def size(self) -> int:
        """Number of modes n."""
        return int(self.eigenvalues.size)

    def state_from_real(self) -> Array:
        """Matrix from (Re y, Im y) to (q, q̇), shape (2n, 2n)."""
        both = np.concatenate([self.displacement, self.velocity])
        return np.concatenate([both.real, -both.imag], axis=1)

    def real_from_state(self) -> Array:
        """Matrix from (q, q̇) to (Re y, Im y), shape (2n, 2n)."""
        return np.concatenate([self.coordinates.real, self.coordinates.imag])


@lru_cache(maxsize=16)
def gauss_rule(nodes: int) -> tuple[Array, Array, Array]:
    """Gauss-Legendre nodes and weights on [0, 1], and a_ij = ∫_0^{x_i} l_j, shape (nodes, nodes)."""
    x, weights = np.polynomial.legendre.leggauss(nodes)
    degrees = np.arange(nodes)
    legendre = np.polynomial.legendre.legvander(x, nodes)
    # l_j = Σ_d (2d+1)/2 w_j P_d(x_j) P_d and ∫_{-1}^x P_d = (P_{d+1} − P_{d−1})/(2d+1).
    coefficients = (degrees + 0.5)[:, None] * legendre[:, :nodes].T * weights
    integrals = np.empty((nodes, nodes))
    integrals[:, 0] = x + 1.0
    integrals[:, 1:] = (legendre[:, 2:] - legendre[:, : nodes - 1]) / (2 * degrees[1:] + 1)
    return (x + 1.0) / 2.0, weights / 2.0, integrals @ coefficients / 2.0


@lru_cache(maxsize=16)
def _last_coefficients(nodes: int) -> Array:
    """Matrix from values at Gauss nodes to the last two Legendre coefficients, shape (2, nodes)."""
    x, weights, _ = gauss_rule(nodes)
    last = np.polynomial.legendre.legvander(2.0 * x - 1.0, nodes - 1)[:, -2:]
    return np.asarray((last * weights[:, None] * (2.0 * np.arange(nodes - 2, nodes) + 1.0)).T, dtype=float)


def panel_edges(breakpoints: Array, angle: float, panel_angle: float) -> Array:
    """Return ends of panels: all breakpoints, and points between for a fastest motion of `angle` a period."""
    ends = np.append(breakpoints[1:], 1.0)
    counts = np.ceil((ends - breakpoints) * angle / panel_angle).astype(int)
    pieces = [
        np.linspace(start, end, max(int(count), 1), endpoint=False)
        for start, end, count in zip(breakpoints, ends, counts, strict=True)
    ]
    return np.append(np.concatenate(pieces), 1.0)


@dataclass(frozen=True, eq=False)
class _Panels:
    """Everything that does not depend on the load parameters; P panels, N nodes, p loads, n modes.

    Attributes
    ----------
    force_on_force : array, shape (3, P, N p, N p)
        H₀, H₁, H₂ + D.
    force_on_state : array, shape (3, P, N p, 2n)
        F₀, F₁, F₂, acting on (Re y, Im y).
    free : array, shape (P, 2n, 2n)
        E.
    input : array, shape (P, 2n, N p)
        G.
    """

    force_on_force: Array
    force_on_state: Array
    free: Array
    input: Array


def _split(matrix: ComplexArray) -> Array:
    """Real rows (Re, −Im), so that Re(matrix y) = rows (Re y, Im y)."""
    return np.concatenate([matrix.real, -matrix.imag], axis=-1)


def _build(system: PeriodicSystem, modes: FreeModes, nodes: int, edges: Array) -> _Panels:
    x, weights, integration = gauss_rule(nodes)
    period = system.period
    start, length = edges[:-1], np.diff(edges)
    count, p, n = start.size, len(system.loads), modes.size
    fractions = start[:, None] + length[:, None] * x
    h = length * period
    # Exponentials from the middle of each panel, so that neither they nor their inverses grow large.
    spread = np.exp(modes.eigenvalues * (h[:, None, None] * (x[:, None] - 0.5)))
    half = np.exp(modes.eigenvalues * (h[:, None] / 2.0))

    phi, weighted = np.empty((2, count, nodes, p, n))
    for a, load in enumerate(system.loads):
        phi[:, :, a] = load.shape(fractions)
        weighted[:, :, a] = phi[:, :, a] if load.weight is None else phi[:, :, a] * load.weight(fractions)
    readings = [
        phi @ modes.displacement,
        phi @ modes.velocity,
        phi @ (modes.velocity * modes.eigenvalues),
    ]
    for a, load in enumerate(system.loads):
        if load.rate == "total":
            slope = load.slope(fractions) / period
            curvature = load.curvature(fractions) / period**2
            readings[1][:, :, a] += slope @ modes.displacement
            readings[2][:, :, a] += 2.0 * slope @ modes.velocity + curvature @ modes.displacement
    beta = weighted @ modes.input.T

    rows = (np.stack(readings) * spread[None, :, :, None, :]).reshape(3, count, nodes * p, n)
    columns = (beta / spread[:, :, None, :]).reshape(count, nodes * p, n)
    kernel = _split(rows) @ np.concatenate([columns.real, columns.imag], axis=-1).swapaxes(-1, -2)
    window = np.repeat(np.repeat(integration, p, axis=0), p, axis=1)
    force_on_force = kernel * (h[:, None, None] * window)
    direct = phi @ (np.linalg.inv(system.mass) @ weighted.swapaxes(-1, -2))
    blocks = force_on_force[2].reshape(count, nodes, p, nodes, p)
    blocks[:, np.arange(nodes), :, np.arange(nodes), :] += direct.swapaxes(0, 1)

    push = (columns * half[:, None, :]) * (h[:, None] * np.repeat(weights, p))[:, :, None]
    decay = half**2
    free = np.zeros((count, 2 * n, 2 * n))
    i = np.arange(n)
    free[:, i, i] = free[:, n + i, n + i] = decay.real
    free[:, n + i, i] = decay.imag
    free[:, i, n + i] = -decay.imag
    return _Panels(
        force_on_force=force_on_force,
        force_on_state=_split(rows * half[:, None, :]),
        free=free,
        input=np.concatenate([push.real, push.imag], axis=-1).swapaxes(-1, -2),
    )


class FreeMotion:
    """A system prepared for many values of its load parameters up to those of `column`.

    Parameters
    ----------
    system : PeriodicSystem
        Its own load parameters are not used.
    column : LoadColumn
        The values that will be asked for, so that the panels suit the fastest of them.
    nodes : int
        Gauss nodes a panel.
    panel_angle : float
        Largest product of fastest frequency and panel length [rad].
    edges : array, optional
        Ends of panels to begin with, all breakpoints among them; chosen by `panel_angle` if left out.
    instants : array
        Fractions of the period that panels end at, besides the breakpoints.

    Raises
    ------
    UnsuitableSystemError
        See :meth:`FreeModes.of`.
    """

    def __init__(
        self,
        system: PeriodicSystem,
        column: LoadColumn,
        nodes: int = DEFAULT_NODES,
        panel_angle: float = DEFAULT_PANEL_ANGLE,
        edges: Array | None = None,
        instants: Sequence[float] = (),
    ) -> None:
        self.system = system
        self.modes = FreeModes.of(system)
        samples = np.linspace(0.0, 1.0, 16, endpoint=False)
        self.mobility = np.array(
            [_quadratic(system.mass, load.shape(samples)).max() for load in system.loads]
        )
        stiffest = float((column.stiffness @ self.mobility).max(initial=0.0))
        fastest = float(np.hypot(np.abs(self.modes.eigenvalues).max(), np.sqrt(stiffest)))
        if edges is None:
            ends = merge_breakpoints([system.breakpoints, np.array(instants)])
            edges = panel_edges(ends, fastest * system.period, panel_angle)
        self.edges = edges
        self.panels = _build(system, self.modes, nodes, self.edges)
        extremes = column.extremes()
        forces = self._halve_unresolved_panels(extremes, nodes)
        self._known = (extremes, forces)
        self.kicks = self._kick_data()

    def _halve_unresolved_panels(self, column: LoadColumn, nodes: int) -> Array:
        """Halve panels until the contact forces of all initial states are resolved at the given values.

        Returns these forces.

        The state at the end of a panel converges twice as fast as the force along it: if the last Legendre
        coefficients of the force are ε of its size, ε² is left of its effect.
        """
        tail = _last_coefficients(nodes)
        for _ in range(_MOST_HALVINGS):
            force = self._forces(column)
            shape = (*force.shape[:2], nodes, -1, force.shape[-1])
            size = np.abs(force).max(axis=2, initial=0.0)
            rough = np.abs(np.einsum("ti,vpias->vptas", tail, force.reshape(shape))).max(
                axis=(2, 3), initial=0.0
            )
            effect = np.abs(self.panels.input).sum(axis=-1).max(axis=-1)
            relative = rough / np.where(size > 0.0, size, 1.0)
            error = (effect[:, None] * size * relative**2).max(axis=(0, 2), initial=0.0)
            unresolved = error > PANEL_TOLERANCE
            if not unresolved.any():
                return force
            middle = (self.edges[:-1] + self.edges[1:]) / 2.0
            self.edges = np.sort(np.concatenate([self.edges, middle[unresolved]]))
            self.panels = _build(self.system, self.modes, nodes, self.edges)
        raise UnsuitableSystemError(
            f"the contact forces are too rough: {self.edges.size - 1} panels do not resolve them"
        )

    def _kick_data(self) -> list[tuple[int, int, Array, Array]]:
        """Panel, load, φ and Δφ̇ of each slope jump of a load with total rate."""
        found = []
        for a, load in enumerate(self.system.loads):
            if load.rate != "total":
                continue
            jumps = load.slope.jumps() / self.system.period
            for at, jump in zip(load.shape.breakpoints, jumps, strict=True):
                panel = int(np.argmin(np.abs(self.edges[:-1] - at)))
                found.append((panel, a, load.shape(at), jump))
        return found

    def transition_matrices(self, column: LoadColumn) -> Array:
        """Φ in the modal coordinates (Re y, Im y) for each value of a column, shape (V, 2n, 2n)."""
        panels = self.panels
        count, size = panels.free.shape[0], panels.input.shape[-1]
        # A chunk of values at a time keeps the memory near 100 MB.
        chunk = max(1, 4_000_000 // (count * max(size, panels.free.shape[1]) * (size + panels.free.shape[1])))
        parts = []
        for begin in range(0, len(column), chunk):
            part = slice(begin, begin + chunk)
            parts.append(
                self._chunk(LoadColumn(column.mass[part], column.damping[part], column.stiffness[part]))
            )
        return np.concatenate(parts)

    def _forces(self, column: LoadColumn) -> Array:
        """Contact forces at the nodes of each panel, for unit modal coordinates at its start, (V, P, N p, 2n)."""
        panels = self.panels
        size = panels.input.shape[-1]
        repeats = size // max(len(self.system.loads), 1)
        left = np.broadcast_to(np.eye(size), (len(column), *panels.force_on_force.shape[1:])).copy()
        right = np.zeros((len(column), *panels.force_on_state.shape[1:]))
        for order, values in enumerate((column.stiffness, column.damping, column.mass)):
            if values.any():
                factor = np.tile(values, (1, repeats))[:, None, :, None]
                left += factor * panels.force_on_force[order]
                right += factor * panels.force_on_state[order]
        return np.asarray(np.linalg.solve(left, right), dtype=float)

    def transition_matrices_to(self, instants: Sequence[float], column: LoadColumn) -> Array:
        """Φ from the period's origin to some of the instants, for one value, shape (K, 2n, 2n); as Φ of the period."""
        steps = self._steps(column)[0]
        reached = [np.eye(steps.shape[-1])]
        for step in steps:
            reached.append(step @ reached[-1])
        ends = [int(np.argmin(np.abs(self.edges - instant))) for instant in instants]
        return np.stack([reached[end] for end in ends])

    def _chunk(self, column: LoadColumn) -> Array:
        return chain(self._steps(column))

    def _steps(self, column: LoadColumn) -> Array:
        """Transition matrices of the panels, shape (V, P, 2n, 2n)."""
        known, forces = self._known
        if not np.array_equal(known.stacked(), column.stacked()):
            forces = self._forces(column)
        steps = self.panels.free - self.panels.input @ forces
        for panel, matrices in self._kicks(column).items():
            steps[:, panel] = steps[:, panel] @ matrices
        return np.asarray(steps, dtype=float)

    def _kicks(self, column: LoadColumn) -> dict[int, Array]:
        """Jumps of the modal coordinates before a panel, each of shape (V, 2n, 2n)."""
        kicks: dict[int, Array] = {}
        if not self.kicks or not column.mass.any():
            return kicks
        system, n = self.system, self.system.size
        to_state, to_real = self.modes.state_from_real(), self.modes.real_from_state()
        for panel in sorted({panel for panel, *_ in self.kicks}):
            at = self.edges[panel]
            shapes = np.stack([load.shape(at) for load in system.loads])
            mass = system.mass + np.einsum("va,ai,aj->vij", column.mass, shapes, shapes)
            impulse = np.zeros((len(column), n, n))
            for where, a, shape, jump in self.kicks:
                if where == panel:
                    impulse += column.mass[:, a, None, None] * np.outer(shape, jump)
            velocity = -np.linalg.solve(mass, impulse)
            kicks[panel] = np.eye(2 * n) + to_real[:, n:] @ velocity @ to_state[:n]
        return kicks


def _quadratic(mass: Array, vectors: Array) -> Array:
    """φᵀ M⁻¹ φ of each row, shape (m,)."""
    return np.asarray(np.einsum("mi,mi->m", vectors, np.linalg.solve(mass, vectors.T).T), dtype=float)


def chain(steps: Array) -> Array:
    """Product steps[:, -1] ... steps[:, 1] steps[:, 0], by pairs, shape (V, m, d, d) -> (V, d, d)."""
    while steps.shape[1] > 1:
        even = steps.shape[1] - steps.shape[1] % 2
        pairs = steps[:, 1:even:2] @ steps[:, 0:even:2]
        steps = np.concatenate([pairs, steps[:, even:]], axis=1)
    return steps[:, 0]


def is_suitable(system: PeriodicSystem) -> bool:
    """Whether contact-force collocation applies: oscillating free modes, contact forces it resolves."""
    try:
        FreeMotion(system, LoadColumn.of(system))
    except UnsuitableSystemError:
        return False
    return True


def transition_matrices_to(instants: Sequence[float], system: PeriodicSystem) -> Array:
    """Transition matrices of the state (q, q̇) from the period's origin to some fractions of it, shape (K, 2n, 2n).

    Where an instant is a breakpoint with a velocity kick, the state is that just before it.

    Raises
    ------
    UnsuitableSystemError
        If the free motion has rigid-body, overdamped or defective modes.
    """
    column = LoadColumn.of(system)
    motion = FreeMotion(system, column, instants=instants)
    modes = motion.modes
    return np.asarray(
        modes.state_from_real() @ motion.transition_matrices_to(instants, column) @ modes.real_from_state()
    )


def transition_matrices(
    systems: Sequence[PeriodicSystem], nodes: int = DEFAULT_NODES, panel_angle: float = DEFAULT_PANEL_ANGLE
) -> Array:
    """Floquet transition matrices of the state (q, q̇), shape (V, 2n, 2n).

    Parameters
    ----------
    systems : sequence of PeriodicSystem
        With common size and breakpoints.
    nodes : int
        Gauss nodes a panel.
    panel_angle : float
        Largest product of fastest frequency and panel length [rad].

    Raises
    ------
    UnsuitableSystemError
        If the free motion has rigid-body, overdamped or defective modes.
    """
    # Panels that resolve one system resolve all that turn a little less in a period, which saves the search.
    turns = np.array([system.period * np.sqrt(np.abs(system.stiffness).max()) for system in systems])
    matrices: list[Array] = [np.empty(0)] * len(systems)
    leading, edges = 0.0, None
    for number in np.argsort(-turns).tolist():
        if turns[number] < _SHARED * leading or edges is None:
            leading, edges = turns[number], None
        column = LoadColumn.of(systems[number])
        motion = FreeMotion(systems[number], column, nodes, panel_angle, edges)
        edges, modes = motion.edges, motion.modes
        matrices[number] = (
            modes.state_from_real() @ motion.transition_matrices(column)[0] @ modes.real_from_state()
        )
    return np.stack(matrices)
