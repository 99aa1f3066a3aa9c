"""Contact-force collocation: fast transition matrices of systems with rank-one loads.

Between contacts' instants of entry and exit the free motion of the constant part M q̈ + C q̇ + K q = 0 is known
exactly from its modes (:mod:`facegear.floquet.free_modes`), and all that is unknown are the contact forces

    f_a = k_a u_a + c_a u̇_a + m_a ü_a,    u_a = φ_aᵀ q,

a few scalar functions of time. They are found at the Gauss nodes of panels that end at the breakpoints, from the
equations of :mod:`facegear.floquet.contact_forces`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from facegear.floquet.contact_forces import ForcePanels, Nodes, at_nodes, in_place
from facegear.floquet.free_modes import UnsuitableSystemError
from facegear.floquet.free_systems import FreeSystems
from facegear.floquet.gauss_panels import gauss_rule, panel_edges, within_reach
from facegear.floquet.load_columns import LoadColumn
from facegear.floquet.loads import weighted_shape
from facegear.floquet.motion import MotionPanels, known_errors
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import merge_breakpoints
from facegear.support.quadrature import legendre_from_values
from facegear.support.types import FloatArray

#: Gauss nodes a panel.
DEFAULT_NODES = 16
#: Largest product of fastest frequency and panel length [rad].
DEFAULT_PANEL_ANGLE = 8.0
#: Estimated error of the motion over one panel at which it is halved, in units of the root of the energy.
PANEL_TOLERANCE = 1e-12
# Part of the root of it, the error of the force, that the shape of a load may leave to the last coefficients.
_FOLLOWED = 0.1
# Rounds of halving before a system is refused.
_MOST_HALVINGS = 8
# Panels that take as long as to begin with other ones: systems that turn less in a period share those of another until
# they have so many more than they need.
_SHARED = 12.0
# Entries of the largest stack of matrices of a family: as many as fit in a cache.
_ENTRIES = 500_000
# Entries of matrices of systems whose modes are found together.
_MODE_ENTRIES = 100_000


class FreeMotion:
    """A system prepared for many values of its load parameters up to those of its column, or many systems, one each.

    Parameters
    ----------
    free : FreeSystems
        Their column has the values that will be asked for, so that the panels suit the fastest of them.
    nodes : int
        Gauss nodes a panel.
    panel_angle : float
        Largest product of fastest frequency and panel length [rad].
    instants : array
        Fractions of the period that panels end at, besides the breakpoints.

    Raises
    ------
    UnsuitableSystemError
        If the contact forces are too rough.
    """

    def __init__(
        self,
        free: FreeSystems,
        nodes: int = DEFAULT_NODES,
        panel_angle: float = DEFAULT_PANEL_ANGLE,
        instants: Sequence[float] = (),
    ) -> None:
        self.systems, self.column = free.systems, free.column
        column = self.column
        self._nodes = nodes
        self._held, self.modes = free.held, free.held.modes
        ends = merge_breakpoints([self.systems[0].breakpoints, np.array(instants)])
        self.edges = _following(
            self.systems[0], panel_edges(ends, float(free.angles.max()), panel_angle), nodes
        )
        # Of the free motion only what the loads ask for: its accelerations where they have mass, and so on.
        self._orders = 3 if column.mass.any() else 2 if column.damping.any() else 1
        self._own = self._load_parameters(column) if len(self.systems) > 1 else None
        self.panels = self._build(nodes, self.edges[:-1], np.diff(self.edges))
        known = column.extremes() if len(self.systems) == 1 else column
        self._known = (known, self._halve_unresolved_panels(known, nodes))
        self.kicks = [self._kick_data(system) if self._orders == 3 else [] for system in self.systems]

    def _build(self, nodes: int, start: FloatArray, length: FloatArray) -> ForcePanels:
        return ForcePanels.of(self._held.systems, self.modes, nodes, start, length, self._orders, self._own)

    def _halve_unresolved_panels(self, column: LoadColumn, nodes: int) -> FloatArray:
        """Halve panels until the contact forces of all initial states are resolved at the given values.

        Returns these forces.

        The state at the end of a panel converges twice as fast as the force along it: if the last Legendre
        coefficients of the force are ε of its size, ε² is left of its effect.
        """
        tail = legendre_from_values(nodes)[-2:]
        parameters = None if self._own is not None else self._load_parameters(column)
        force = self.panels.forces(parameters)
        for _ in range(_MOST_HALVINGS):
            shape = (*force.shape[:2], nodes, -1, force.shape[-1])
            size = np.abs(force).max(axis=2, initial=0.0)
            rough = np.abs(np.einsum("ti,vpias->vptas", tail, force.reshape(shape))).max(
                axis=(2, 3), initial=0.0
            )
            effect = np.abs(self.panels.input).sum(axis=-1).max(axis=-1)
            relative = rough / np.where(size > 0.0, size, 1.0)
            error = (effect[..., None] * size * relative**2).max(axis=(0, 2), initial=0.0)
            unresolved = error > PANEL_TOLERANCE
            if not unresolved.any():
                return force
            self.edges = _halved(self.edges, unresolved)
            new = np.repeat(unresolved, 1 + unresolved)
            halves = self._build(nodes, self.edges[:-1][new], np.diff(self.edges)[new])
            self.panels = self.panels.halved(unresolved, halves)
            force = in_place(unresolved, force, halves.forces(parameters), axis=1)
        raise UnsuitableSystemError(
            f"the contact forces are too rough: {self.edges.size - 1} panels do not resolve them"
        )

    def _kick_data(self, system: PeriodicSystem) -> list[tuple[int, int, FloatArray, FloatArray]]:
        """Panel, load, w φ and Δφ̇ of each slope jump of a load with total rate."""
        found = []
        for a, load in enumerate(system.loads):
            if load.rate != "total":
                continue
            shapes = weighted_shape(load, load.shape.breakpoints)
            jumps = load.slope.jumps() / system.period
            for at, shape, jump in zip(load.shape.breakpoints, shapes, jumps, strict=True):
                panel = int(np.argmin(np.abs(self.edges[:-1] - at)))
                found.append((panel, a, shape, jump))
        return found

    def transition_matrices(self, column: LoadColumn) -> FloatArray:
        """Φ in the modal coordinates (Re y, Im y) for each value of a column, shape (V, 2n, 2n)."""
        panels = self.panels
        if len(self.systems) > 1:
            return self._chunk(column)
        count, states, size = panels.input.shape[1:]
        # A chunk of values at a time keeps the memory near 100 MB.
        chunk = max(1, 4_000_000 // (count * max(size, states) * (size + states)))
        parts = []
        for begin in range(0, len(column), chunk):
            part = slice(begin, begin + chunk)
            parts.append(
                self._chunk(LoadColumn(column.mass[part], column.damping[part], column.stiffness[part]))
            )
        return np.concatenate(parts)

    def _forces(self, column: LoadColumn) -> FloatArray:
        """Contact forces at the nodes of each panel, for unit modal coordinates at its start, (V, P, N p, 2n)."""
        known, forces = self._known
        if np.array_equal(known.stacked(), column.stacked()):
            return forces
        if self._own is not None:
            raise ValueError("column must be that of the systems, which have one value each")
        return self.panels.forces(self._load_parameters(column))

    def _load_parameters(self, column: LoadColumn) -> FloatArray:
        """Stiffness, damping and mass of all loads, springs taken back included, shape (3, V, p)."""
        springs = np.broadcast_to(self._held.springs, (len(column), self._held.springs.shape[1]))
        none = np.zeros_like(springs)
        parts = ((column.stiffness, -springs), (column.damping, none), (column.mass, none))
        return np.stack([np.concatenate(part, axis=1) for part in parts])

    def motion_panels(self, column: LoadColumn) -> MotionPanels:
        """Follow the motion of the one system with one value of its load parameters, forces included."""
        (system,), modes = self.systems, self.modes
        x, weights, integration = gauss_rule(self._nodes)
        at = Nodes.of(self._held.systems, modes, self._nodes, self.edges[:-1], np.diff(self.edges))
        spread, half, span, beta = at.spread[0], at.half[0], at.spans[0][:, None, None], at.beta[0]

        # What forces alone do: y of modes at the nodes and at the end, u, u̇ and ü of all loads, e taken off.
        force = np.zeros((*at.fractions.shape, system.size))
        if system.force is not None:
            force = system.force(at.fractions)
        push = force @ modes.input[0].T
        pushed_only = spread * (span * (integration @ (push / spread)))
        at_end = half * span[..., 0] * np.einsum("j,pjm->pm", weights, push / spread)
        known = (at.reading[:, 0] @ pushed_only[..., None])[..., 0].real
        (shapes,) = at_nodes(self._held.systems, lambda load: load.shape, at.fractions)
        moved = np.linalg.solve(system.mass, force.reshape(-1, system.size).T).T.reshape(force.shape)
        known[2] += (shapes @ moved[..., None])[..., 0]
        known[..., : len(system.loads)] -= known_errors(system, at.fractions)

        # Forces for unit states are known from the search for the panels.
        parameters, by_state = self._load_parameters(column), self._forces(column)[0]
        left, _ = self.panels.equations(parameters)
        sizes = (parameters[:, 0, np.newaxis, np.newaxis] * known).sum(axis=0).reshape(*left.shape[1:3], 1)
        alone = np.linalg.solve(left[0], sizes)
        to_state, to_real = modes.state_from_real()[0], modes.real_from_state()[0]
        reached = to_state @ self.panels.input[0]
        own, number = np.unique(np.round(np.diff(self.edges), 12), return_index=True, return_inverse=True)[1:]
        free = (to_state @ self.panels.free[0, own] @ to_real)[number]
        offsets = np.concatenate([at_end.real, at_end.imag], axis=-1) @ to_state.T

        def inside(starts: FloatArray) -> FloatArray:
            real = starts @ to_real.T
            loads = (by_state @ real[..., None] + alone)[..., 0]
            pushed = push - (beta.swapaxes(-1, -2) @ loads.reshape(*beta.shape[:3], 1))[..., 0]
            first = real[:, np.newaxis, : modes.size] + 1j * real[:, np.newaxis, modes.size :]
            y = spread * (half[:, np.newaxis] * first + span * (integration @ (pushed / spread)))
            both = np.concatenate([modes.displacement[0], modes.velocity[0]])
            return np.asarray((y @ both.T).real, dtype=float)

        return MotionPanels(
            edges=self.edges,
            nodes=x,
            steps=np.asarray(free - reached @ (by_state @ to_real), dtype=float),
            offsets=np.asarray(offsets - (reached @ alone)[..., 0], dtype=float),
            inside=inside,
        )

    def transition_matrices_to(self, instants: Sequence[float], column: LoadColumn) -> FloatArray:
        """Φ from the period's origin to some of the instants, for one value, shape (K, 2n, 2n); as Φ of the period."""
        steps = self._steps(column)[0]
        reached = [np.eye(steps.shape[-1])]
        for step in steps:
            reached.append(step @ reached[-1])
        ends = [int(np.argmin(np.abs(self.edges - instant))) for instant in instants]
        return np.stack([reached[end] for end in ends])

    def _chunk(self, column: LoadColumn) -> FloatArray:
        return chain(self._steps(column))

    def _steps(self, column: LoadColumn) -> FloatArray:
        """Transition matrices of the panels, shape (V, P, 2n, 2n)."""
        steps = self.panels.free - self.panels.input @ self._forces(column)
        for number, system in enumerate(self.systems):
            own = slice(None) if len(self.systems) == 1 else slice(number, number + 1)
            # Right to left: the kicks come first, then the jumps of the same instant, then the panel.
            for jump in system.jumps:
                away = np.abs(self.edges[:-1] - jump.fraction)
                panel = int(np.minimum(away, 1.0 - away).argmin())
                to_state, to_real = self.modes.state_from_real()[number], self.modes.real_from_state()[number]
                steps[own, panel] = steps[own, panel] @ (to_real @ jump.matrix @ to_state)
            if column.mass.any():
                for panel, matrices in self._kicks(number, column.mass[own]).items():
                    steps[own, panel] = steps[own, panel] @ matrices
        return np.asarray(steps, dtype=float)

    def _kicks(self, number: int, masses: FloatArray) -> dict[int, FloatArray]:
        """Jumps of the modal coordinates of a system before a panel, each of shape (V, 2n, 2n)."""
        system, data = self.systems[number], self.kicks[number]
        kicks: dict[int, FloatArray] = {}
        if not data:
            return kicks
        n = system.size
        to_state, to_real = self.modes.state_from_real()[number], self.modes.real_from_state()[number]
        for panel in sorted({panel for panel, *_ in data}):
            at = self.edges[panel]
            shapes = np.stack([load.shape(at) for load in system.loads])
            weighted = np.stack([weighted_shape(load, at) for load in system.loads])
            mass = system.mass + np.einsum("va,ai,aj->vij", masses, weighted, shapes)
            impulse = np.zeros((len(masses), n, n))
            for where, a, shape, jump in data:
                if where == panel:
                    impulse += masses[:, a, None, None] * np.outer(shape, jump)
            velocity = -np.linalg.solve(mass, impulse)
            kicks[panel] = np.eye(2 * n) + to_real[:, n:] @ velocity @ to_state[:n]
        return kicks


def _following(system: PeriodicSystem, edges: FloatArray, nodes: int) -> FloatArray:
    """Halve panels along which polynomials do not follow the shapes of loads: there they would not follow forces."""
    tail, allowed = legendre_from_values(nodes)[-2:], _FOLLOWED * PANEL_TOLERANCE**0.5
    for _ in range(_MOST_HALVINGS if system.loads else 0):
        at = edges[:-1, np.newaxis] + np.diff(edges)[:, np.newaxis] * gauss_rule(nodes)[0]
        (shapes,) = at_nodes([system], lambda load: load.shape, at)
        left_out = np.abs(np.tensordot(tail, shapes, axes=(1, 1))).max(axis=(0, 3))
        rough = (left_out > allowed * np.abs(shapes).max(axis=(0, 1, 3))).any(axis=1)
        if not rough.any():
            break
        edges = _halved(edges, rough)
    return edges


def _halved(edges: FloatArray, chosen: NDArray[np.bool_]) -> FloatArray:
    return np.sort(np.concatenate([edges, ((edges[:-1] + edges[1:]) / 2.0)[chosen]]))


def chain(steps: FloatArray) -> FloatArray:
    """Product steps[:, -1] ... steps[:, 1] steps[:, 0], by pairs, shape (V, m, d, d) -> (V, d, d)."""
    while steps.shape[1] > 1:
        even = steps.shape[1] - steps.shape[1] % 2
        pairs = steps[:, 1:even:2] @ steps[:, 0:even:2]
        steps = np.concatenate([pairs, steps[:, even:]], axis=1)
    return steps[:, 0]


def transition_matrices_to(instants: Sequence[float], system: PeriodicSystem) -> FloatArray:
    """Transition matrices of the state (q, q̇) from the period's origin to some fractions of it, shape (K, 2n, 2n).

    Where an instant is a breakpoint with a velocity kick, the state is that just before it.

    Raises
    ------
    UnsuitableSystemError
        If the free motion has rigid-body, overdamped or defective modes.
    """
    column = LoadColumn.of(system)
    motion = FreeMotion(FreeSystems.of([system], column), instants=instants)
    modes = motion.modes
    return np.asarray(
        modes.state_from_real() @ motion.transition_matrices_to(instants, column) @ modes.real_from_state()
    )


def transition_matrices(
    systems: Sequence[PeriodicSystem],
    nodes: int = DEFAULT_NODES,
    panel_angle: float = DEFAULT_PANEL_ANGLE,
    fewest_held: int = 1,
) -> FloatArray:
    """Floquet transition matrices of the state (q, q̇), shape (V, 2n, 2n).

    Parameters
    ----------
    systems : sequence of PeriodicSystem
        With common size and breakpoints.
    nodes : int
        Gauss nodes a panel.
    panel_angle : float
        Largest product of fastest frequency and panel length [rad].
    fewest_held : int
        As for :class:`FreeMotion`.

    Raises
    ------
    UnsuitableSystemError
        If the free motion has overdamped or defective modes, or rigid-body ones in a system that is not held.
    """
    # The longest periods first, in the units of the fastest motion: such neighbours share panels.
    order = np.argsort([-system.period * np.sqrt(np.abs(system.stiffness).max()) for system in systems])
    matrices = np.empty((len(systems), 2 * systems[0].size, 2 * systems[0].size))
    size = max(1, _MODE_ENTRIES // systems[0].size ** 2)
    for start in range(0, order.size, size):
        chosen = order[start : start + size]
        some = [systems[number] for number in chosen.tolist()]
        free = FreeSystems.of(some, LoadColumn.of_all(some), fewest_held)
        for places in _families(free, nodes, panel_angle):
            motion = FreeMotion(free.some(places), nodes, panel_angle)
            found = motion.transition_matrices(motion.column)
            matrices[chosen[places]] = motion.modes.state_from_real() @ found @ motion.modes.real_from_state()
    return matrices


def _families(free: FreeSystems, nodes: int, panel_angle: float) -> Iterator[NDArray[np.intp]]:
    """Places of systems that are taken together: panels that resolve one resolve those that turn a little less."""
    angles = free.angles
    loads, size = len(free.held.systems[0].loads) * nodes, 2 * free.systems[0].size
    order = np.argsort(-angles)
    while order.size:
        panels = free.systems[0].breakpoints.size + within_reach(angles[order[0]] / panel_angle)
        together = order[: max(1, _ENTRIES // (panels * max(loads, size) * (loads + size)))]
        more = np.cumsum(angles[together[0]] - angles[together]) / panel_angle
        together = together[: np.count_nonzero(more <= _SHARED)]
        order = order[together.size :]
        yield together
