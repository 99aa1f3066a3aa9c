"""Periodic linear systems with rank-one loads (chapter 2, Eqs. 2-1 to 2-4 and 2-14).

Every mesh load of a face-gear drive, transverse or torsional, is felt through one displacement
u = φ(t)ᵀq and answers with one force, so that all systems of the text have the form

    M q̈ + C q̇ + K q + Σ_i w_i(t) φ_i(t) [ m_i ü_i + c_i u̇_i + k_i u_i ] = f(t),    u_i = φ_i(t)ᵀ q − e_i(t)

with constant M, C, K at a given speed. Time is measured by the fraction x = t / T0 of the period. Stability does not
hang on the forces f and the transmission errors e; :mod:`facegear.floquet.response` has what they cause.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache, partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from facegear.floquet.fourier import FourierSeries, fourier_series
from facegear.floquet.loads import ROUNDING_OF_A_FIT, ContactLoad, StateJump, weighted_shape
from facegear.floquet.piecewise import PiecewiseChebyshev, Side, merge_breakpoints, real_array, wrap
from facegear.support.kinds import named
from facegear.support.parameters import finite_array, integer_at_least, keep, positive
from facegear.support.types import FloatArray


@dataclass(frozen=True, eq=False)
class PeriodicSystem:
    """M q̈ + C q̇ + K q + Σ (rank-one loads) = f over one period T0 (2-1, 2-2).

    Parameters
    ----------
    mass : array_like, shape (n, n)
        M, symmetric positive definite, constant part.
    damping, stiffness : array_like, shape (n, n)
        C and K, constant parts; gyroscopic C and non-symmetric K are allowed.
    loads : sequence of ContactLoad
        The periodic loads, shape vectors with n components.
    period : float
        T0 [s].
    force : PiecewiseChebyshev, optional
        f, n components: generalised forces that do not depend on the motion.
    jumps : sequence of StateJump
        Jumps of the state that the loads do not give by themselves.

    Raises
    ------
    TypeError, ValueError
        If shapes do not match, entries are not finite, the mass is not symmetric positive definite, or the
        period is not positive.

    Examples
    --------
    Mathieu's equation q̈ + 0.02 q̇ + (1 + 0.2 cos 2t) q = 0, at its principal resonance:

    >>> import numpy as np
    >>> import facegear as fg
    >>> one = fg.PiecewiseChebyshev.constant([1.0])
    >>> factor = fg.PiecewiseChebyshev.fit(lambda s, piece: 1.0 + 0.2 * np.cos(2.0 * np.pi * s)[:, None], [0.0])
    >>> load = fg.ContactLoad(one, stiffness=1.0, weight=factor)
    >>> system = fg.PeriodicSystem([[1.0]], [[0.02]], [[0.0]], (load,), period=np.pi)
    >>> print(f"{fg.growth_rate(system):.4f} 1/s")
    0.0399 1/s
    """

    mass: FloatArray
    damping: FloatArray
    stiffness: FloatArray
    loads: tuple[ContactLoad, ...]
    period: float
    force: PiecewiseChebyshev | None = None
    jumps: tuple[StateJump, ...] = ()

    def __post_init__(self) -> None:
        for name in ("mass", "damping", "stiffness"):
            keep(self, **{name: real_array(getattr(self, name), name, 2)})
        size = self.mass.shape[0]
        if size == 0 or self.mass.shape[1] != size:
            raise ValueError(f"mass must be square, at least one row and column; got shape {self.mass.shape}")
        for name in ("damping", "stiffness"):
            if getattr(self, name).shape != (size, size):
                raise ValueError(
                    f"{name} must be square and as large as mass, {(size, size)}; got shape "
                    f"{getattr(self, name).shape}"
                )
        if np.abs(self.mass - self.mass.T).max() > 1e-12 * np.abs(self.mass).max():
            raise ValueError("mass must be symmetric; got a non-symmetric matrix")
        try:
            np.linalg.cholesky(self.mass)
        except np.linalg.LinAlgError:
            raise ValueError(
                "mass must be positive definite; got a matrix with a non-positive eigenvalue"
            ) from None
        keep(
            self,
            loads=_listed("loads", self.loads, ContactLoad),
            jumps=_listed("jumps", self.jumps, StateJump),
        )
        for number, load in enumerate(self.loads):
            if load.shape.components != size:
                raise ValueError(
                    f"loads[{number}].shape must have {size} components, one a coordinate; "
                    f"got {load.shape.components}"
                )
        keep(self, period=positive("period", self.period, "s"))
        if self.force is not None and not isinstance(self.force, PiecewiseChebyshev):
            raise TypeError(f"force must be a PiecewiseChebyshev or None; got {type(self.force).__name__}")
        if self.force is not None and self.force.components != size:
            raise ValueError(
                f"force must have {size} components, one a coordinate; got {self.force.components}"
            )
        for number, jump in enumerate(self.jumps):
            if jump.matrix.shape != (2 * size, 2 * size):
                raise ValueError(
                    f"jumps[{number}].matrix must have shape {(2 * size, 2 * size)}, displacements and velocities; "
                    f"got {jump.matrix.shape}"
                )

    @property
    def size(self) -> int:
        """Number of coordinates n; the state has 2n."""
        return int(self.mass.shape[0])

    @cached_property
    def breakpoints(self) -> FloatArray:
        """Instants where something is not smooth or the state jumps, and 0: fractions of the period, ascending."""
        own = [] if self.force is None else [self.force.breakpoints]
        jumps = np.array([jump.fraction for jump in self.jumps])
        return merge_breakpoints([np.zeros(1), *(load.breakpoints for load in self.loads), *own, jumps])

    def mass_matrix(self, fraction: ArrayLike, side: Side = "right") -> FloatArray:
        """Assembled M(t), shape (..., n, n)."""
        return self._assemble(fraction, side)[0]

    def damping_matrix(self, fraction: ArrayLike, side: Side = "right") -> FloatArray:
        """Assembled C(t), shape (..., n, n)."""
        return self._assemble(fraction, side)[1]

    def stiffness_matrix(self, fraction: ArrayLike, side: Side = "right") -> FloatArray:
        """Assembled K(t), shape (..., n, n); the impulses of φ̈ at slope jumps are :meth:`velocity_kicks`."""
        return self._assemble(fraction, side)[2]

    def state_matrix(self, fraction: ArrayLike, side: Side = "right") -> FloatArray:
        """A(t) of Ẋ = A X, X = (q, q̇), Eq. (2-4), shape (..., 2n, 2n)."""
        mass, damping, stiffness = self._assemble(fraction, side)
        right = np.linalg.solve(mass, np.concatenate([stiffness, damping], axis=-1))
        state = np.zeros((*mass.shape[:-2], 2 * self.size, 2 * self.size))
        state[..., : self.size, self.size :] = np.eye(self.size)
        state[..., self.size :, :] = -right
        return state

    def _assemble(self, fraction: ArrayLike, side: Side) -> tuple[FloatArray, FloatArray, FloatArray]:
        x = np.asarray(fraction, dtype=float)
        mass, damping, stiffness = (
            np.broadcast_to(matrix, (*x.shape, self.size, self.size)).copy()
            for matrix in (self.mass, self.damping, self.stiffness)
        )
        for load in self.loads:
            phi = load.shape(x, side)
            force = weighted_shape(load, x, side)
            mass += load.mass * force[..., :, None] * phi[..., None, :]
            damping += load.damping * force[..., :, None] * phi[..., None, :]
            stiffness += load.stiffness * force[..., :, None] * phi[..., None, :]
            if load.rate == "total":
                rate = load.slope(x, side) / self.period
                stiffness += load.damping * force[..., :, None] * rate[..., None, :]
                if load.mass > 0.0:
                    second = load.curvature(x, side) / self.period**2
                    damping += 2.0 * load.mass * force[..., :, None] * rate[..., None, :]
                    stiffness += load.mass * force[..., :, None] * second[..., None, :]
        return mass, damping, stiffness

    def impulses(self) -> list[tuple[float, FloatArray]]:
        """Impulsive part of K(t): Σ w m φ Δφ̇ᵀ at each slope jump of a load with mass and total rate.

        Returns
        -------
        list of (fraction, matrix of shape (n, n))
            Ascending fractions; empty if there are none.
        """
        found: dict[float, FloatArray] = {}
        for load in self.loads:
            if load.rate != "total" or load.mass == 0.0:
                continue
            slope_jumps = load.slope.jumps() / self.period
            largest = load.slope.largest / self.period
            for breakpoint_, jump in zip(load.shape.breakpoints, slope_jumps, strict=True):
                # Below this it is rounding of the fit, as where a smooth function crosses the period's end.
                if np.abs(jump).max() <= ROUNDING_OF_A_FIT * largest:
                    continue
                nearest = self.breakpoints[np.argmin(np.abs(self.breakpoints - breakpoint_))]
                at = float(nearest)
                matrix = load.mass * np.outer(weighted_shape(load, breakpoint_), jump)
                found[at] = found[at] + matrix if at in found else matrix
        return sorted(found.items(), key=lambda item: item[0])

    def velocity_kicks(self) -> list[tuple[float, FloatArray]]:
        """Jumps of the velocity where a contact mass with total rate meets a slope jump: q̇⁺ = q̇⁻ + P q.

        P = −M(t)⁻¹ Σ w m φ Δφ̇ᵀ, which for M = I and one load is −φ m/(1 + m φᵀφ) Δφ̇ᵀ.

        Returns
        -------
        list of (fraction, P of shape (n, n))
            Ascending fractions; empty if there are none.
        """
        kicks: list[tuple[float, FloatArray]] = []
        for at, matrix in self.impulses():
            kick: FloatArray = np.asarray(-np.linalg.solve(self.mass_matrix(at), matrix), dtype=float)
            kicks.append((at, kick))
        return kicks

    def state_jumps(self) -> list[tuple[float, FloatArray]]:
        """All jumps of the state, X⁺ = J X⁻: the velocity kicks and, after them, those of :attr:`jumps`.

        Returns
        -------
        list of (fraction, J of shape (2n, 2n))
            Ascending fractions, each one of :attr:`breakpoints`; empty if there are none.
        """
        found: dict[float, FloatArray] = {}
        for at, kick in self.velocity_kicks():
            found[at] = np.eye(2 * self.size)
            found[at][self.size :, : self.size] = kick
        for jump in self.jumps:
            away = np.abs(self.breakpoints - jump.fraction)
            # Just below 1 is the start of the next period.
            at = float(self.breakpoints[np.minimum(away, 1.0 - away).argmin()])
            found[at] = jump.matrix @ found[at] if at in found else jump.matrix
        return sorted(found.items(), key=lambda item: item[0])

    def fourier(self, order: int) -> tuple[FourierSeries, FourierSeries, FourierSeries]:
        """Fourier series (2-14) of the assembled M(t), C(t), K(t), impulses of φ̈ included in K, other jumps not.

        Parameters
        ----------
        order : int
            Highest harmonic S of 2π/T0.

        Returns
        -------
        mass, damping, stiffness : FourierSeries
            Constant parts are in the means. :func:`fourier_series` expands any other function of these
            matrices, as M(t)⁻¹K(t), in the same way.
        """
        order = integer_at_least("order", order, 1)
        none = np.zeros((order, self.size, self.size))
        mass, damping, stiffness = (
            FourierSeries(constant, none, none) for constant in (self.mass, self.damping, self.stiffness)
        )
        for load in self.loads:
            still, moving, curving = (
                partial(_dyad_series, load.shape, load.weight, derivative, order) for derivative in range(3)
            )
            mass = mass.plus(load.mass, still())
            damping = damping.plus(load.damping, still())
            stiffness = stiffness.plus(load.stiffness, still())
            if load.rate == "total":
                stiffness = stiffness.plus(load.damping / self.period, moving())
                if load.mass > 0.0:
                    damping = damping.plus(2.0 * load.mass / self.period, moving())
                    stiffness = stiffness.plus(load.mass / self.period**2, curving())
        for at, matrix in self.impulses():
            angle = 2.0 * np.pi * at * (1 + np.arange(order))[:, None, None]
            waves = FourierSeries(matrix, 2.0 * np.cos(angle) * matrix, 2.0 * np.sin(angle) * matrix)
            stiffness = stiffness.plus(1.0 / self.period, waves)
        return mass, damping, stiffness

    def replace_loads(
        self,
        *,
        mass: ArrayLike | None = None,
        damping: ArrayLike | None = None,
        stiffness: ArrayLike | None = None,
    ) -> PeriodicSystem:
        """Return the system with other load parameters, each one number for all loads or one a load."""
        masses = self._per_load(mass, "mass")
        dampings = self._per_load(damping, "damping")
        stiffnesses = self._per_load(stiffness, "stiffness")
        loads = tuple(
            replace(load, mass=m, damping=c, stiffness=k)
            for load, m, c, k in zip(self.loads, masses, dampings, stiffnesses, strict=True)
        )
        return replace(self, loads=loads)

    def _per_load(self, values: ArrayLike | None, name: str) -> list[float]:
        """Return one value a load: those given, or else the present ones."""
        if values is None:
            return [float(getattr(load, name)) for load in self.loads]
        array = finite_array(name, values)
        if array.shape not in ((), (len(self.loads),)):
            raise ValueError(
                f"{name} must be one number or {len(self.loads)}, one a load; got shape {array.shape}"
            )
        return [float(value) for value in np.broadcast_to(array, (len(self.loads),))]

    def shift(self, phase: float) -> PeriodicSystem:
        """Return the system with the origin of time moved by `phase` of a period; multipliers stay."""
        return self._moved(
            lambda function: function.shift(phase),
            tuple(
                replace(jump, fraction=float(wrap(np.array(jump.fraction - phase)))) for jump in self.jumps
            ),
        )

    def repeated(self, periods: int) -> PeriodicSystem:
        """Return the system with several periods p taken for one: Φ is the p-th power."""
        periods = integer_at_least("periods", periods, 1)
        jumps = tuple(
            replace(jump, fraction=(jump.fraction + number) / periods)
            for number in range(periods)
            for jump in self.jumps
        )
        longer = self._moved(lambda function: function.repeated(periods), jumps)
        return replace(longer, period=periods * self.period)

    def _moved(
        self, change: Callable[[PiecewiseChebyshev], PiecewiseChebyshev], jumps: tuple[StateJump, ...]
    ) -> PeriodicSystem:
        loads = tuple(load.moved(change) for load in self.loads)
        force = None if self.force is None else change(self.force)
        return replace(self, loads=loads, force=force, jumps=jumps)


def _listed(name: str, values: Any, kind: type) -> tuple[Any, ...]:
    """Return objects of one kind as a tuple, and refuse what is no list of them."""
    if not isinstance(values, Iterable):
        raise TypeError(f"{name} must be a sequence of {kind.__name__}, or (); got {named(values)}")
    listed = tuple(values)
    for number, value in enumerate(listed):
        if not isinstance(value, kind):
            raise TypeError(f"{name}[{number}] must be a {kind.__name__}; got {type(value).__name__}")
    return listed


def have_one_course(one: PeriodicSystem, other: PeriodicSystem) -> bool:
    """Whether all that varies with time is the very same in two systems, as of models that keep their functions.

    Of systems with as many loads, without jumps; others may be alike all the same.
    """
    return (
        not one.jumps
        and not other.jumps
        and one.force is other.force
        and all(
            a.shape is b.shape and a.weight is b.weight and a.transmission_error is b.transmission_error
            for a, b in zip(one.loads, other.loads, strict=True)
        )
    )


def require_system(system: object, name: str = "system") -> None:
    """Refuse what is no system at one speed, such as a model.

    Raises
    ------
    TypeError
        Saying what it is, and for a model how to get its system.
    """
    if not isinstance(system, PeriodicSystem):
        hint = "; its system at a speed is model.system(speed)" if hasattr(system, "system") else ""
        raise TypeError(f"{name} must be a PeriodicSystem, got {named(system)}{hint}")


@lru_cache(maxsize=256)
def _dyad_series(
    shape: PiecewiseChebyshev, weight: PiecewiseChebyshev | None, derivative: int, order: int
) -> FourierSeries:
    """Fourier series of w φ (dʳφ/dxʳ)ᵀ, which depend neither on speed nor on load parameters."""
    other = shape.derivative(derivative)
    breakpoints = (
        shape.breakpoints if weight is None else merge_breakpoints([shape.breakpoints, weight.breakpoints])
    )

    def dyads(fraction: FloatArray) -> FloatArray:
        force = shape(fraction) if weight is None else shape(fraction) * weight(fraction)
        return np.asarray(force[:, :, None] * other(fraction)[:, None, :])

    return fourier_series(dyads, breakpoints, order)
