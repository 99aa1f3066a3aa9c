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

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from facegear.floquet.modes import NaturalMotions
from facegear.floquet.motion import MotionPanels, known_errors
from facegear.floquet.periodic import ContactLoad, LoadColumn, PeriodicSystem, weighted_shape
from facegear.floquet.piecewise import PiecewiseChebyshev, merge_breakpoints
from facegear.support.types import ComplexArray, FloatArray

#: Gauss nodes a panel.
DEFAULT_NODES = 16
#: Largest product of fastest frequency and panel length [rad].
DEFAULT_PANEL_ANGLE = 8.0
#: Estimated error of the motion over one panel at which it is halved, in units of the root of the energy.
PANEL_TOLERANCE = 1e-12
# A mode that is slower than this part of the fastest is a rigid-body motion, whose frequency is known to the root of
# rounding only; the modes of a system that is not held must not be taken for oscillations.
_SLOWEST = 1e-5
# Condition of the modes beyond which the square of it, in units of rounding, is more than panels may lose: as just
# below critical damping.
_MOST_DEPENDENT = 300.0
# A spring that holds what hangs on nothing lets it oscillate at this part of the fastest frequency at least.
_SOFTEST = 0.1
# Instants at which it is seen how mobile a system is under its loads.
_INSTANTS = 16
# Rounds of halving before a system is refused.
_MOST_HALVINGS = 8
# Parts of a period beyond which a motion is too fast to follow.
_MOST_PARTS = 2**17
# Panels that take as long as to begin with other ones: systems that turn less in a period share those of another until
# they have so many more than they need.
_SHARED = 12.0
# Entries of the largest stack of matrices of a family: as many as fit in a cache.
_ENTRIES = 500_000


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
        motions = NaturalMotions.of(mass, damping, stiffness)
        values = motions.exponents
        oscillating = values.imag > _SLOWEST * np.abs(values).max(axis=-1, keepdims=True)
        counts = np.count_nonzero(oscillating, axis=-1)
        if (counts != n).any():
            raise UnsuitableSystemError(
                f"the free motion has {counts[counts != n].flat[0]} oscillating modes, not {n}: "
                "some are rigid-body or overdamped"
            )
        columns = motions.vectors.swapaxes(-1, -2)[oscillating].reshape(*mass.shape[:-2], n, 2 * n)
        vectors = columns.swapaxes(-1, -2)
        vectors = vectors / np.linalg.norm(vectors[..., n:, :], axis=-2, keepdims=True)
        basis = np.concatenate([vectors, vectors.conj()], axis=-1)
        # x = Re(W y) with y twice the coefficients of the pairs W c + conj(W c).
        rows = np.asarray(2.0 * _inverse(basis)[..., :n, :], dtype=complex)
        half = replace(motions, exponents=values[oscillating].reshape(*mass.shape[:-2], n), vectors=vectors)
        return cls(
            eigenvalues=half.exponents,
            displacement=half.displacements,
            velocity=half.velocities,
            coordinates=np.asarray(rows @ half.from_state, dtype=complex),
            input=half.of_forces(rows),
        )

    @property
    def size(self) -> int:
        """Number of modes n."""
        return int(self.eigenvalues.shape[-1])

    def state_from_real(self) -> FloatArray:
        """Matrix from (Re y, Im y) to (q, q̇), shape (..., 2n, 2n)."""
        both = np.concatenate([self.displacement, self.velocity], axis=-2)
        return np.concatenate([both.real, -both.imag], axis=-1)

    def real_from_state(self) -> FloatArray:
        """Matrix from (q, q̇) to (Re y, Im y), shape (..., 2n, 2n)."""
        return np.concatenate([self.coordinates.real, self.coordinates.imag], axis=-2)


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


@lru_cache(maxsize=16)
def gauss_rule(nodes: int) -> tuple[FloatArray, FloatArray, FloatArray]:
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
def _last_coefficients(nodes: int) -> FloatArray:
    """Matrix from values at Gauss nodes to the last two Legendre coefficients, shape (2, nodes)."""
    x, weights, _ = gauss_rule(nodes)
    last = np.polynomial.legendre.legvander(2.0 * x - 1.0, nodes - 1)[:, -2:]
    return np.asarray((last * weights[:, None] * (2.0 * np.arange(nodes - 2, nodes) + 1.0)).T, dtype=float)


def within_reach(parts: float) -> int:
    """Return a number of parts of the period, rounded up, if it is one that a computer has room for.

    Raises
    ------
    ArithmeticError
        If there are too many, or infinitely many.
    """
    if not parts <= _MOST_PARTS:
        raise ArithmeticError(
            f"the period is too long for the fastest motion: it takes {parts:.2g} steps, more than {_MOST_PARTS}; the "
            "stiffness over the mass must be smaller, or the period shorter"
        )
    return int(np.ceil(parts))


def panel_edges(breakpoints: FloatArray, angle: float, panel_angle: float) -> FloatArray:
    """Return ends of panels: all breakpoints, and points between for a fastest motion of `angle` a period."""
    within_reach(angle / panel_angle)
    ends = np.append(breakpoints[1:], 1.0)
    counts = np.ceil((ends - breakpoints) * angle / panel_angle).astype(int)
    pieces = [
        np.linspace(start, end, max(int(count), 1), endpoint=False)
        for start, end, count in zip(breakpoints, ends, counts, strict=True)
    ]
    return np.append(np.concatenate(pieces), 1.0)


@dataclass(frozen=True, eq=False)
class _Panels:
    """Everything that does not depend on the load parameters; S systems, P panels, N nodes, p loads, n modes.

    Attributes
    ----------
    force_on_force : array, shape (3, S, P, N p, N p)
        H₀, H₁, H₂ + D.
    force_on_state : array, shape (3, S, P, N p, 2n)
        F₀, F₁, F₂, acting on (Re y, Im y).
    free : array, shape (S, P, 2n, 2n)
        E.
    input : array, shape (S, P, 2n, N p)
        G.
    """

    force_on_force: FloatArray
    force_on_state: FloatArray
    free: FloatArray
    input: FloatArray

    def halved(self, chosen: NDArray[np.bool_], halves: _Panels) -> _Panels:
        """Return the panels with the two halves of each chosen one in its place."""
        return _Panels(
            _in_place(chosen, self.force_on_force, halves.force_on_force, axis=2),
            _in_place(chosen, self.force_on_state, halves.force_on_state, axis=2),
            _in_place(chosen, self.free, halves.free, axis=1),
            _in_place(chosen, self.input, halves.input, axis=1),
        )


def _in_place(chosen: NDArray[np.bool_], whole: FloatArray, halves: FloatArray, axis: int) -> FloatArray:
    """Put halves, two for each chosen entry along an axis, in the place of these entries."""
    twice = 1 + chosen
    found = whole.take(np.repeat(np.arange(chosen.size), twice), axis)
    found[(slice(None),) * axis + (np.repeat(chosen, twice),)] = halves
    return found


def _split(matrix: ComplexArray) -> FloatArray:
    """Real rows (Re, −Im), so that Re(matrix y) = rows (Re y, Im y)."""
    return np.concatenate([matrix.real, -matrix.imag], axis=-1)


@dataclass(frozen=True, eq=False)
class Nodes:
    """Modes, loads and forces of S systems at the N Gauss nodes of P panels; p loads, n modes.

    Attributes
    ----------
    fractions : array, shape (P, N)
        Instants, fractions of the period.
    spans : array, shape (S, P)
        Lengths h of the panels [s].
    spread : array of complex, shape (S, P, N, n)
        e^{Λ(t − t_middle)}: from the middle of a panel, so that neither they nor their inverses grow large.
    half : array of complex, shape (S, P, n)
        e^{Λh/2}.
    reading : array of complex, shape (3, S, P, N, p, n)
        z₀, z₁, z₂: what u, u̇ and ü of the free motion are made of.
    beta : array of complex, shape (S, P, N, p, n)
        Modal accelerations β by unit contact forces.
    direct : array, shape (S, P, N, p, p)
        D, accelerations ü by unit contact forces.
    """

    fractions: FloatArray
    spans: FloatArray
    spread: ComplexArray
    half: ComplexArray
    reading: ComplexArray
    beta: ComplexArray
    direct: FloatArray

    @classmethod
    def of(
        cls,
        systems: Sequence[PeriodicSystem],
        modes: FreeModes,
        nodes: int,
        start: FloatArray,
        length: FloatArray,
    ) -> Nodes:
        """Evaluate everything on panels of given starts and lengths, fractions of the period (P,)."""
        x, _, _ = gauss_rule(nodes)
        periods = np.array([system.period for system in systems])
        systems_, count, p, n = len(systems), start.size, len(systems[0].loads), modes.size
        fractions = start[:, None] + length[:, None] * x
        h = periods[:, None] * length
        exponents = modes.eigenvalues[:, None, :] * h[:, :, None]

        # Modes act on the last axis of what is known at all nodes of all panels: (S or 1, P, N p, n).
        def values(part: Callable[[ContactLoad], PiecewiseChebyshev]) -> FloatArray:
            found = _at_nodes(systems, part, fractions)
            return found.reshape(len(found), count * nodes * p, n)

        shape = (systems_, count, nodes, p, n)

        def readings(by: FloatArray, factors: ComplexArray) -> ComplexArray:
            # Real times complex as one product of real matrices, which takes half as long.
            pairs = by @ np.ascontiguousarray(factors).view(float)
            return np.asarray(pairs.view(complex).reshape(shape), dtype=complex)

        phi = values(lambda load: load.shape)
        weighted = phi
        if any(load.weight is not None for load in systems[0].loads):
            factor = _at_nodes(systems, _weight, fractions)
            weighted = phi * factor.reshape(len(factor), count * nodes * p, 1)
        velocity = modes.velocity
        read = np.empty((3, *shape), dtype=complex)
        read[0], read[1] = readings(phi, modes.displacement), readings(phi, velocity)
        np.multiply(read[1], modes.eigenvalues[:, None, None, None, :], out=read[2])
        total = np.array([load.rate == "total" for load in systems[0].loads])
        if total.any():
            rate = total[:, None] / periods[:, None, None, None, None]
            slope = values(lambda load: load.slope)
            read[1] += rate * readings(slope, modes.displacement)
            read[2] += 2.0 * rate * readings(slope, velocity)
            read[2] += rate**2 * readings(values(lambda load: load.curvature), modes.displacement)
        inverse = np.linalg.inv(np.stack([system.mass for system in systems]))
        moved = (weighted @ inverse).reshape(systems_, count, nodes, p, n)
        return cls(
            fractions=fractions,
            spans=h,
            spread=_spread(modes.eigenvalues, periods, length, nodes),
            half=np.exp(exponents / 2.0),
            reading=read,
            beta=readings(weighted, modes.input.swapaxes(-1, -2)),
            direct=phi.reshape(len(phi), count, nodes, p, n) @ moved.swapaxes(-1, -2),
        )


def _spread(eigenvalues: ComplexArray, periods: FloatArray, lengths: FloatArray, nodes: int) -> ComplexArray:
    """Motions of modes (S, n) from the middle of panels (P,) to their nodes, (S, P, N, n)."""
    x, _, _ = gauss_rule(nodes)
    # Panels of one piece are of one length, but for rounding, and nodes as far before the middle as after it.
    _, first, which = np.unique(np.round(lengths, 12), return_index=True, return_inverse=True)
    turns = (eigenvalues * periods[:, None])[:, None, None, :] * lengths[first][:, None, None]
    before = np.exp(turns * (x[: (nodes + 1) // 2, None] - 0.5))
    both = np.concatenate([before, 1.0 / before[:, :, : nodes // 2][:, :, ::-1]], axis=2)
    return np.asarray(both[:, which.ravel()], dtype=complex)


def _build(
    systems: Sequence[PeriodicSystem], modes: FreeModes, nodes: int, start: FloatArray, length: FloatArray
) -> _Panels:
    _, weights, integration = gauss_rule(nodes)
    at = Nodes.of(systems, modes, nodes, start, length)
    systems_, count, p, n = len(systems), start.size, len(systems[0].loads), modes.size
    rows = (at.reading * at.spread[:, :, :, None, :]).reshape(3, systems_, count, nodes * p, n)
    # Backwards they are their own inverses.
    columns = (at.beta * at.spread[:, :, ::-1, None, :]).reshape(systems_, count, nodes * p, n)
    columns *= at.spans[:, :, None, None]
    # Re Σ z β as one product of real matrices, their columns (Re, Im) and (Re, −Im) in turn.
    force_on_force = rows.view(float) @ columns.conj().view(float).swapaxes(-1, -2)
    force_on_force *= np.repeat(np.repeat(integration, p, axis=0), p, axis=1)
    blocks = force_on_force[2].reshape(systems_, count, nodes, p, nodes, p)
    blocks[:, :, np.arange(nodes), :, np.arange(nodes), :] += np.moveaxis(at.direct, 2, 0)

    push = columns * at.half[:, :, None, :] * np.repeat(weights, p)[:, None]
    decay = at.half**2
    free = np.zeros((systems_, count, 2 * n, 2 * n))
    i = np.arange(n)
    free[..., i, i] = free[..., n + i, n + i] = decay.real
    free[..., n + i, i] = decay.imag
    free[..., i, n + i] = -decay.imag
    return _Panels(
        force_on_force=force_on_force,
        force_on_state=_split(rows * at.half[:, :, None, :]),
        free=free,
        input=np.concatenate([push.real, push.imag], axis=-1).swapaxes(-1, -2),
    )


_ALWAYS_ONE = PiecewiseChebyshev.constant([1.0])


def _weight(load: ContactLoad) -> PiecewiseChebyshev:
    return _ALWAYS_ONE if load.weight is None else load.weight


def _at_nodes(
    systems: Sequence[PeriodicSystem],
    part: Callable[[ContactLoad], PiecewiseChebyshev],
    fractions: FloatArray,
) -> FloatArray:
    """Values of one function of each load, (S, P, N, p, components), or (1, ...) if all systems share them."""
    return _at_instants(systems, part, lambda function: function(fractions), fractions.shape)


def _at_instants(
    systems: Sequence[PeriodicSystem],
    part: Callable[[ContactLoad], PiecewiseChebyshev],
    values: Callable[[PiecewiseChebyshev], FloatArray],
    shape: tuple[int, ...] = (),
) -> FloatArray:
    """As :func:`_at_nodes`, for values of a function at instants of some shape."""
    functions = [[part(load) for load in system.loads] for system in systems]
    if all(own is first for row in functions[1:] for own, first in zip(row, functions[0], strict=True)):
        functions = functions[:1]
    if not functions[0]:
        return np.empty((1, *shape, 0, systems[0].size))
    return np.stack([np.stack([values(function) for function in row], axis=-2) for row in functions])


@lru_cache(maxsize=64)
def _sampled(function: PiecewiseChebyshev) -> FloatArray:
    """Values at instants spread over the period."""
    return function(np.linspace(0.0, 1.0, _INSTANTS, endpoint=False))


def mobilities(systems: Sequence[PeriodicSystem]) -> FloatArray:
    """Return the largest φᵀM⁻¹φ of each load, at sampled instants, shape (V, p)."""
    shapes = _at_instants(systems, lambda load: load.shape, _sampled, (_INSTANTS,))
    mass = np.stack([system.mass for system in systems])[:, None]
    moved = np.linalg.solve(mass, shapes.swapaxes(-1, -2)).swapaxes(-1, -2)
    return np.asarray((shapes * moved).sum(axis=-1).max(axis=1), dtype=float)


@dataclass(frozen=True, eq=False)
class _Held:
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
    def of(cls, systems: Sequence[PeriodicSystem], stiffest: float, fewest: int) -> _Held:
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


def _undamped(system: PeriodicSystem) -> tuple[FloatArray, float, FloatArray]:
    """Squares of undamped frequencies over the largest, ascending (n,), that [1/s²], and modes times Lᵀ, M = L Lᵀ."""
    inverse = np.linalg.inv(np.linalg.cholesky(system.mass))
    reduced = inverse @ system.stiffness @ inverse.T
    squares, turned = np.linalg.eigh((reduced + reduced.T) / 2.0)
    largest = float(np.abs(squares).max())
    return squares / (largest if largest > 0.0 else 1.0), largest, turned


class FreeMotion:
    """A system prepared for many values of its load parameters up to those of `column`, or many systems for one each.

    Parameters
    ----------
    systems : sequence of PeriodicSystem
        One for all values of the column, or one a value; of one size, with common breakpoints. Their own load
        parameters are not used.
    column : LoadColumn
        The values that will be asked for, so that the panels suit the fastest of them.
    nodes : int
        Gauss nodes a panel.
    panel_angle : float
        Largest product of fastest frequency and panel length [rad].
    instants : array
        Fractions of the period that panels end at, besides the breakpoints.
    fewest_held : int
        Number of coordinates from which on motions that hang on nothing are held by springs that are taken back.

    Raises
    ------
    UnsuitableSystemError
        See :meth:`FreeModes.of`.
    """

    def __init__(
        self,
        systems: Sequence[PeriodicSystem],
        column: LoadColumn,
        nodes: int = DEFAULT_NODES,
        panel_angle: float = DEFAULT_PANEL_ANGLE,
        instants: Sequence[float] = (),
        fewest_held: int = 1,
    ) -> None:
        self.systems = systems
        self._nodes = nodes
        stiffest = float((column.stiffness * mobilities(systems)).sum(axis=-1).max())
        self._held = _Held.of(systems, stiffest, fewest_held)
        self.modes = self._held.modes
        periods = np.array([system.period for system in systems])
        frequencies = np.abs(self.modes.eigenvalues).max(axis=-1)
        angle = float((np.hypot(frequencies, np.sqrt(stiffest)) * periods).max())
        ends = merge_breakpoints([systems[0].breakpoints, np.array(instants)])
        self.edges = panel_edges(ends, angle, panel_angle)
        self.panels = self._build(nodes, self.edges[:-1], np.diff(self.edges))
        known = column.extremes() if len(systems) == 1 else column
        self._known = (known, self._halve_unresolved_panels(known, nodes))
        self.kicks = [self._kick_data(system) for system in systems]

    def _build(self, nodes: int, start: FloatArray, length: FloatArray) -> _Panels:
        return _build(self._held.systems, self.modes, nodes, start, length)

    def _halve_unresolved_panels(self, column: LoadColumn, nodes: int) -> FloatArray:
        """Halve panels until the contact forces of all initial states are resolved at the given values.

        Returns these forces.

        The state at the end of a panel converges twice as fast as the force along it: if the last Legendre
        coefficients of the force are ε of its size, ε² is left of its effect.
        """
        tail = _last_coefficients(nodes)
        force = self._forces(column, self.panels)
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
            middle = (self.edges[:-1] + self.edges[1:]) / 2.0
            self.edges = np.sort(np.concatenate([self.edges, middle[unresolved]]))
            new = np.repeat(unresolved, 1 + unresolved)
            halves = self._build(nodes, self.edges[:-1][new], np.diff(self.edges)[new])
            self.panels = self.panels.halved(unresolved, halves)
            force = _in_place(unresolved, force, self._forces(column, halves), axis=1)
        raise UnsuitableSystemError(
            f"the contact forces are too rough: {self.edges.size - 1} panels do not resolve them"
        )

    def _kick_data(self, system: PeriodicSystem) -> list[tuple[int, int, FloatArray, FloatArray]]:
        """Panel, load, w φ and Δφ̇ of each slope jump of a load with total rate."""
        found = []
        for a, load in enumerate(system.loads):
            if load.rate != "total":
                continue
            jumps = load.slope.jumps() / system.period
            for at, jump in zip(load.shape.breakpoints, jumps, strict=True):
                panel = int(np.argmin(np.abs(self.edges[:-1] - at)))
                found.append((panel, a, weighted_shape(load, at), jump))
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

    def _forces(self, column: LoadColumn, panels: _Panels) -> FloatArray:
        """Contact forces at the nodes of each panel, for unit modal coordinates at its start, (V, P, N p, 2n)."""
        return np.asarray(
            np.linalg.solve(*self._equations(self._load_parameters(column), panels)), dtype=float
        )

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
        alone = spread * (span * (integration @ (push / spread)))
        at_end = half * span[..., 0] * np.einsum("j,pjm->pm", weights, push / spread)
        known = (at.reading[:, 0] @ alone[..., None])[..., 0].real
        (shapes,) = _at_nodes(self._held.systems, lambda load: load.shape, at.fractions)
        known[2] += (shapes @ np.linalg.solve(system.mass, force[..., None]))[..., 0]
        known[..., : len(system.loads)] -= known_errors(system, at.fractions)

        parameters = self._load_parameters(column)
        left, right = self._equations(parameters, self.panels)
        sizes = (parameters[:, 0, np.newaxis, np.newaxis] * known).sum(axis=0).reshape(*right.shape[1:3], 1)
        forces = np.linalg.solve(left[0], np.concatenate([right[0], sizes], axis=-1))
        to_state, to_real = modes.state_from_real()[0], modes.real_from_state()[0]
        whole = -(self.panels.input[0] @ forces)
        offsets = whole[..., -1] + np.concatenate([at_end.real, at_end.imag], axis=-1)

        def inside(starts: FloatArray) -> FloatArray:
            real = starts @ to_real.T
            loads = (forces[..., :-1] @ real[..., None])[..., 0] + forces[..., -1]
            pushed = push - (beta.swapaxes(-1, -2) @ loads.reshape(*beta.shape[:3], 1))[..., 0]
            first = real[:, np.newaxis, : modes.size] + 1j * real[:, np.newaxis, modes.size :]
            y = spread * (half[:, np.newaxis] * first + span * (integration @ (pushed / spread)))
            both = np.concatenate([modes.displacement[0], modes.velocity[0]])
            return np.asarray((y @ both.T).real, dtype=float)

        return MotionPanels(
            edges=self.edges,
            nodes=x,
            steps=np.asarray(to_state @ (self.panels.free[0] + whole[..., :-1]) @ to_real, dtype=float),
            offsets=np.asarray(offsets @ to_state.T, dtype=float),
            inside=inside,
        )

    @staticmethod
    def _equations(parameters: FloatArray, panels: _Panels) -> tuple[FloatArray, FloatArray]:
        """Left and right side of the equations for the contact forces, (V, P, N p, N p) and (V, P, N p, 2n)."""
        size = panels.input.shape[-1]
        count = parameters.shape[1]
        left = np.zeros((count, *panels.force_on_force.shape[2:]))
        right = np.zeros((count, *panels.force_on_state.shape[2:]))
        for order, values in enumerate(parameters):
            if values.any():
                factor = np.tile(values, (1, size // values.shape[1]))[:, None, :, None]
                left += factor * panels.force_on_force[order]
                right += factor * panels.force_on_state[order]
        number = np.arange(size)
        left[..., number, number] += 1.0
        return left, right

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
        known, forces = self._known
        if not np.array_equal(known.stacked(), column.stacked()):
            forces = self._forces(column, self.panels)
        steps = self.panels.free - self.panels.input @ forces
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
    motion = FreeMotion([system], column, instants=instants)
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
    turns = np.array([system.period * np.sqrt(np.abs(system.stiffness).max()) for system in systems])
    loads, size = len(systems[0].loads) * nodes, 2 * systems[0].size
    matrices = np.empty((len(systems), size, size))
    order = np.argsort(-turns)
    while order.size:
        # Panels that resolve one system resolve all that turn a little less in a period.
        panels = systems[0].breakpoints.size + within_reach(turns[order[0]] / panel_angle)
        together = order[: max(1, _ENTRIES // (panels * max(loads, size) * (loads + size)))]
        more = np.cumsum(turns[together[0]] - turns[together]) / panel_angle
        together = together[: np.count_nonzero(more <= _SHARED)]
        order = order[together.size :]
        family = [systems[number] for number in together.tolist()]
        column = LoadColumn.from_stacked(np.concatenate([LoadColumn.of(x).stacked() for x in family]))
        motion = FreeMotion(family, column, nodes, panel_angle, fewest_held=fewest_held)
        found = motion.transition_matrices(column)
        matrices[together] = motion.modes.state_from_real() @ found @ motion.modes.real_from_state()
    return matrices
