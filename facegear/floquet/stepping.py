"""Products of matrix exponentials over sub-intervals, batched over families of periodic systems."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property
from types import ModuleType

import numpy as np

from facegear.floquet.collocation import chain
from facegear.floquet.compiled import where_compiled
from facegear.floquet.loads import ContactLoad
from facegear.floquet.periodic import PeriodicSystem, have_one_course, require_system
from facegear.floquet.piecewise import SAME_INSTANT, PiecewiseChebyshev, Side, same_function
from facegear.support.types import ComplexArray, FloatArray

# Largest norm of an exponent before it is squared.
_SQUARED_FROM = 0.3
# Entries of the largest stack of matrices worked on at once: keeps memory near 100 MB, and small stacks in cache.
_STACK_ENTRIES = 500_000
#: Systems of different periods that share the steps of one of them, at most.
SHARED_STEPS = 16

# Fewer matrices than this are not worth another library, and larger ones keep BLAS busy.
_FEWEST = 32
_COMPILED_SIZES = range(2, 13, 2)
# A call of BLAS takes longer than the product of matrices up to this size.
_TINY = 5

StateMatrices = Callable[[FloatArray], FloatArray]
# Starts and lengths of sub-intervals (m,) and the state matrices at fractions, to the steps (V, m, 2n, 2n).
Steps = Callable[[FloatArray, FloatArray, StateMatrices], FloatArray]


def aligned_edges(breakpoints: FloatArray, sub_intervals: int, factor: int = 1) -> FloatArray:
    """Return ends of sub-intervals, ascending from 0 to 1, every breakpoint (0 among them) included.

    Each piece gets its share of `sub_intervals`, rounded up, each of these cut in `factor`.
    """
    ends = np.append(breakpoints[1:], 1.0)
    parts = [
        np.linspace(start, end, factor * int(np.ceil((end - start) * sub_intervals)), endpoint=False)
        for start, end in zip(breakpoints, ends, strict=True)
    ]
    return np.append(np.concatenate(parts), 1.0)


def midpoint(start: FloatArray, length: FloatArray, state: StateMatrices) -> FloatArray:
    """Exponential of h A(midpoint) for each sub-interval (2-9)."""
    return exponentials(state(start + length / 2.0) * length[:, None, None])


def gauss_magnus(start: FloatArray, length: FloatArray, state: StateMatrices) -> FloatArray:
    """Exponential of h (A₁+A₂)/2 − √3/12 h² [A₁, A₂] for each sub-interval: fourth order, two Gauss nodes."""
    offset = np.sqrt(3.0) / 6.0
    first, second = (state(start + place * length) for place in (0.5 - offset, 0.5 + offset))
    if (compiled := _lockstep(first)) is not None:
        steps = np.empty_like(first)
        lengths = np.tile(length, first.shape[0])
        stacks = (x.reshape(-1, *x.shape[-2:]) for x in (first, second))
        compiled.magnus_steps(*stacks, lengths, steps.reshape(-1, *steps.shape[-2:]), _SQUARED_FROM)
        return steps
    first, second = first * length[:, None, None], second * length[:, None, None]
    commutator = first @ second - second @ first
    return exponentials((first + second) / 2.0 - (np.sqrt(3.0) / 12.0) * commutator)


def exponentials(matrices: FloatArray) -> FloatArray:
    """Matrix exponentials of a stack of small matrices, shape (..., d, d).

    Taylor polynomial of degree 12 in five products (Paterson and Stockmeyer), scaling and squaring. For the tens of
    thousands of small matrices of a map several times faster than scipy.linalg.expm, which the tests compare it
    with, and several times more where :mod:`facegear.floquet.lockstep_exponentials` can be compiled.
    """
    if (compiled := _lockstep(matrices)) is not None:
        results = np.empty(matrices.shape)
        stacks = (
            np.ascontiguousarray(x, dtype=float).reshape(-1, *x.shape[-2:]) for x in (matrices, results)
        )
        compiled.exponentials(*stacks, _SQUARED_FROM)
        return results
    return _exponentials(matrices)


def _lockstep(matrices: FloatArray) -> ModuleType | None:
    """Return the compiled code where it is there and pays for a stack of matrices (..., d, d)."""
    size = matrices.shape[-1]
    pays = matrices.size >= _FEWEST * size**2 and size in _COMPILED_SIZES
    return _compiled() if pays else None


@where_compiled
def _compiled() -> ModuleType:
    from facegear.floquet import lockstep_exponentials

    return lockstep_exponentials


def _exponentials(matrices: FloatArray) -> FloatArray:
    """Exponentials of a stack of matrices by NumPy, squared as often as the largest of them asks for."""
    norm = float(np.abs(matrices).sum(axis=-2).max())
    # Squarings multiply the first term left out, norm¹³/13!: below 0.3, it adds up to less than half a unit of the last
    # place for each unit of the whole exponent, which is what rounding adds. No refinement would tell it where A is
    # constant and sub-intervals are long.
    if not np.isfinite(norm):
        raise ArithmeticError(
            "state matrix is not finite: stiffness, damping or period is beyond double precision"
        )
    squarings = max(0, int(np.ceil(np.log2(max(norm, 1e-300) / _SQUARED_FROM))))
    first = matrices / 2.0**squarings
    second = first @ first
    third = second @ first
    fourth = second @ second
    identity = np.eye(matrices.shape[-1])
    inverse_factorial = 1.0 / np.cumprod(np.concatenate([[1.0], np.arange(1.0, 13.0)]))

    def cubic(order: int) -> FloatArray:
        c = inverse_factorial[order : order + 4]
        return np.asarray(c[0] * identity + c[1] * first + c[2] * second + c[3] * third, dtype=float)

    result = cubic(8) + inverse_factorial[12] * fourth
    result = cubic(4) + result @ fourth
    result = cubic(0) + result @ fourth
    for _ in range(squarings):
        result = result @ result
    return np.asarray(result, dtype=float)


class Family:
    """Systems with common size and breakpoints, stacked for batched linear algebra, in scaled coordinates.

    Parameters
    ----------
    systems : sequence of PeriodicSystem
        V systems; periods, constant matrices and loads may differ.

    Attributes
    ----------
    scale : array, shape (2n, 2n)
        S of the scaled state S X, one for the family, so that matrices can be interpolated from member to member.

    Raises
    ------
    ValueError
        If there are none, or sizes, numbers of loads or breakpoints differ.
    """

    def __init__(self, systems: Sequence[PeriodicSystem]) -> None:
        if not systems:
            raise ValueError("systems must hold at least one PeriodicSystem; got none")
        for system in systems:
            require_system(system)
        first = systems[0]
        for system in systems[1:]:
            alike = system.size == first.size and len(system.loads) == len(first.loads)
            if alike and not have_one_course(first, system):
                alike = system.breakpoints.shape == first.breakpoints.shape
                alike = alike and np.abs(system.breakpoints - first.breakpoints).max() <= 1e-12
            if not alike:
                raise ValueError("systems must have the same size, number of loads and breakpoints")
        self.systems = systems
        self.size = first.size
        self.breakpoints = first.breakpoints
        self.periods = np.array([system.period for system in systems])
        self.jumps = [dict(system.state_jumps()) for system in systems]
        self.mass, self.damping, self.stiffness = (
            np.stack([getattr(system, name) for system in systems])[:, None]
            for name in ("mass", "damping", "stiffness")
        )

        if len(systems) == 1:
            self.scale = _scaling(first.mass, float(self.frequencies[0]))
        else:
            self.scale = Family([systems[len(systems) // 2]]).scale
        self.inverse_scale = np.linalg.inv(self.scale)

    @cached_property
    def middles(self) -> FloatArray:
        """Middles of the smooth pieces, fractions of the period, shape (pieces,)."""
        return np.asarray((self.breakpoints + np.append(self.breakpoints[1:], 1.0)) / 2.0)

    @cached_property
    def frozen_exponents(self) -> ComplexArray:
        """Exponents p T0 of the motions of each system frozen at these middles, shape (V, pieces, 2n)."""
        return np.asarray(np.linalg.eigvals(self.state_matrices(self.middles)), dtype=complex)

    @cached_property
    def frequencies(self) -> FloatArray:
        """Fastest undamped motion of each system frozen in the middle of its smooth pieces [rad/s], shape (V,)."""
        mass, _, stiffness = self.assembled(self.middles)
        squares = np.linalg.eigvals(np.linalg.solve(mass, stiffness))
        frequencies = np.sqrt(np.abs(squares).max(axis=(1, 2)))
        return np.where(frequencies > 0.0, frequencies, 1.0 / self.periods)

    @property
    def carries_derivatives(self) -> bool:
        """Whether the state holds more than (q, q̇) of a system, as in :mod:`facegear.maps.sensitivity`."""
        return self.size != self.systems[0].size

    @property
    def fastest_angle(self) -> float:
        """Largest ω T0 of the family [rad]."""
        return float((self.frequencies * self.periods).max())

    @cached_property
    def exponent_norm(self) -> float:
        """Largest integral of ‖S A S⁻¹‖ over a period of the family [-], from the middles of the smooth pieces."""
        lengths = np.diff(np.append(self.breakpoints, 1.0))
        norms = np.linalg.norm(self.state_matrices(self.middles), 2, axis=(-2, -1))
        return float((norms @ lengths).max())

    @property
    def factors(self) -> float:
        """Number of exponentials of small exponents that those of a period are squared from, each of them rounded."""
        return self.exponent_norm / _SQUARED_FROM

    def assembled(
        self, fraction: FloatArray, side: Side = "right"
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """M(t), C(t), K(t) at fractions (m,), each of shape (V, m, n, n) or with an axis of length 1."""
        mass, damping, stiffness = self.mass, self.damping, self.stiffness
        period = self.periods[:, None, None, None]
        for loads in zip(*(system.loads for system in self.systems), strict=True):
            m, c, k = (
                np.array([getattr(load, name) for load in loads])[:, None, None, None]
                for name in ("mass", "damping", "stiffness")
            )
            through = np.array([load.rate == "total" for load in loads])[:, None, None, None]
            phi = _values(loads, lambda load: load.shape, fraction, side)
            force = phi
            if any(load.weight is not None for load in loads):
                force = phi * _values(loads, lambda load: load.weight, fraction, side)
            dyad = force[..., :, None] * phi[..., None, :]
            stiffness = stiffness + k * dyad
            if c.any():
                damping = damping + c * dyad
            if m.any():
                mass = mass + m * dyad
            if (through * c).any() or (through * m).any():
                rate = (
                    force[..., :, None]
                    * _values(loads, lambda load: load.slope, fraction, side)[..., None, :]
                )
                stiffness = stiffness + (through * c / period) * rate
                damping = damping + (2.0 * through * m / period) * rate
            if (through * m).any():
                second = (
                    force[..., :, None]
                    * _values(loads, lambda load: load.curvature, fraction, side)[..., None, :]
                )
                stiffness = stiffness + (through * m / period**2) * second
        return mass, damping, stiffness

    def state_matrices(self, fraction: FloatArray, side: Side = "right") -> FloatArray:
        """T0 S A S⁻¹ at fractions (m,), shape (V, m, 2n, 2n)."""
        return self.state_of(self.assembled(fraction, side), fraction.size)

    def state_of(self, matrices: tuple[FloatArray, FloatArray, FloatArray], instants: int) -> FloatArray:
        """T0 S A S⁻¹ from M(t), C(t), K(t) of :meth:`assembled` at so many instants."""
        n = self.size
        mass, damping, stiffness = matrices
        inverse = np.linalg.inv(mass)
        scale, back = (np.asarray(x[n:, n:], dtype=float) for x in (self.scale, self.inverse_scale))
        left = -self.periods[:, None, None, None] * (scale @ inverse)
        ratio = float(self.scale[0, 0] / self.scale[n, n])
        state = np.zeros((len(self.systems), instants, 2 * n, 2 * n))
        state[..., :n, n:] = (self.periods * ratio)[:, None, None, None] * np.eye(n)
        state[..., n:, :n] = _between(left, stiffness, back / ratio)
        state[..., n:, n:] = _between(left, damping, back)
        return state

    def product(self, edges: FloatArray, method: Steps) -> FloatArray:
        """Product of the steps over the sub-intervals between `edges`, jumps put in, (V, 2n, 2n)."""
        size = 2 * self.size
        chunk = max(1, _STACK_ENTRIES // (len(self.systems) * size**2))
        total = np.broadcast_to(np.eye(size), (len(self.systems), size, size))
        start, length = edges[:-1], np.diff(edges)
        for begin in range(0, start.size, chunk):
            part = slice(begin, begin + chunk)
            # A motion that grows beyond double precision shows as an entry that is not finite.
            with np.errstate(over="ignore", invalid="ignore"):
                steps = method(start[part], length[part], self.state_matrices)
                self._put_in_jumps(steps, start[part])
                total = chain(steps) @ total
        return np.asarray(total)

    def stretches(self, fewest: int) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Roughly what each part of the period does to the scaled state, enough to tell how large motions grow.

        By the midpoint rule, P parts, at least `fewest`.

        Returns
        -------
        steps : array, shape (V, P, 2n, 2n)
            Jumps at the starts put in.
        sizes : array, shape (V, P)
            ‖S J S⁻¹ − I‖ of these jumps, 0 where there is none.
        exponents : array, shape (V, P, 2n, 2n)
            Matrices of the parts times their length, of which those without their jumps are exponentials.
        """
        edges = aligned_edges(self.breakpoints, fewest)
        start, length = edges[:-1], np.diff(edges)
        with np.errstate(over="ignore", invalid="ignore"):
            exponents = self.state_matrices(start + length / 2.0) * length[:, None, None]
            steps = exponentials(exponents)
            self._put_in_jumps(steps, start)
        sizes = np.zeros(steps.shape[:2])
        for number, jumps in enumerate(self._scaled_jumps):
            for at, jump in jumps.items():
                sizes[number, np.abs(start - at) < SAME_INSTANT] = np.linalg.norm(jump - np.eye(len(jump)), 2)
        return steps, sizes, exponents

    def _put_in_jumps(self, steps: FloatArray, start: FloatArray) -> None:
        """Precede the sub-interval that starts at the instant of a jump by the jump of the state."""
        for number, jumps in enumerate(self._scaled_jumps):
            for at, jump in jumps.items():
                for place in np.flatnonzero(np.abs(start - at) < SAME_INSTANT):
                    steps[number, place] = steps[number, place] @ jump

    def jumped(self, states: FloatArray, at: float) -> FloatArray:
        """Scaled states (V, 2n, k) just before an instant of the period as they are just after it."""
        if not any(self.jumps):
            return states
        after = states.copy()
        for number, jumps in enumerate(self._scaled_jumps):
            for instant, jump in jumps.items():
                if abs(instant - at) < SAME_INSTANT:
                    after[number] = jump @ after[number]
        return after

    @cached_property
    def _scaled_jumps(self) -> list[dict[float, FloatArray]]:
        """Jumps S J S⁻¹ of the scaled state of each system, by the fraction of the period."""
        return [
            {at: self.scale @ jump @ self.inverse_scale for at, jump in jumps.items()} for jumps in self.jumps
        ]


def _between(left: FloatArray, matrices: FloatArray, right: FloatArray) -> FloatArray:
    """Products left (V, m or 1, n, n) · matrices (V, m or 1, n, n) · right (n, n)."""
    systems, instants, n, _ = matrices.shape
    products = (matrices.reshape(systems, instants * n, n) @ right).reshape(matrices.shape)
    if left.shape[1] > 1 or n > _TINY:
        return np.asarray(left @ products)
    # What is the same at all instants takes their rows for those of one large matrix: several times faster.
    rows = products.swapaxes(-1, -2).reshape(systems, instants * n, n) @ left[:, 0].swapaxes(-1, -2)
    return np.asarray(rows.reshape(matrices.shape).swapaxes(-1, -2))


def _scaling(mass: FloatArray, frequency: float) -> FloatArray:
    """S of the state S X = (ω Lᵀq, Lᵀq̇), M = L Lᵀ: both halves have the size of a root energy, as q and q̇ do not."""
    factor = np.linalg.cholesky(mass).T
    zero = np.zeros_like(factor)
    return np.block([[frequency * factor, zero], [zero, factor]])


def _values(
    loads: Sequence[ContactLoad],
    part: Callable[[ContactLoad], PiecewiseChebyshev | None],
    fraction: FloatArray,
    side: Side,
) -> FloatArray:
    """Values of one periodic function of each load, evaluated once if they share it: (V or 1, m, components)."""
    functions = [part(load) for load in loads]
    # A model may build them anew for each speed.
    if all(same_function(function, functions[0]) for function in functions):
        functions = functions[:1]
    one = np.ones((fraction.size, 1))
    return np.stack([one if function is None else function(fraction, side) for function in functions])
