"""Steady response of a stable system to forces and transmission errors of its own period.

From one period to the next the state goes from X to Φ X + X_p, where X_p is what the forces make of a system at rest.
The motion that repeats itself starts from the solution of (I − Φ) X = X_p. Near a multiplier 1 that solution grows
without bound, and so does what rounding makes of it: `SteadyResponse.condition` tells.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.polynomial import chebyshev, legendre
from numpy.typing import ArrayLike, NDArray
from scipy.special import spherical_jn

from facegear.floquet.methods import Method, with_method
from facegear.floquet.motion import FollowsMotion, MotionPanels, known_errors, known_forces
from facegear.floquet.periodic import PeriodicSystem, require_system
from facegear.floquet.piecewise import PiecewiseChebyshev, Side
from facegear.floquet.radau import Radau
from facegear.floquet.stepping import Family
from facegear.support.parameters import finite_array, integer_at_least
from facegear.support.quadrature import gauss_legendre, legendre_from_values
from facegear.support.types import ComplexArray, FloatArray

# Largest part of the last coefficients of the motion along a panel, at which the panel is halved.
_TOLERANCE = 1e-12
# The same of forces, transmission errors, shapes and weights, with twice as many nodes in means and extremes.
_KNOWN_TOLERANCE = 1e-6
# Rounds of halving after which a motion is given up.
_MOST_ROUNDS = 12
# A spectral radius beyond 1 by more than this is unstable and no rounding.
_BEYOND = 1e-9
# Condition from which on half of all digits of the response are lost.
_LOST = 1e8
# Method where contact-force collocation does not apply.
_OTHERWISE = Radau(16, 1e-13)


@dataclass(frozen=True, eq=False)
class SteadyResponse:
    """The motion of a system that repeats itself each period.

    Attributes
    ----------
    system : PeriodicSystem
    state : PiecewiseChebyshev
        q and q̇, 2n components, against t/T0.
    spectral_radius : float
        max|λ| of the system [-]: below 1, all motions end in this one.
    condition : float
        Norm of (I − Φ)⁻¹ times that of Φ, or 1, in energy-like coordinates [-]: by so much an error of Φ, relative to
        its largest entry, may be larger in the response, relative to what the forces make of a system at rest.
    """

    system: PeriodicSystem
    state: PiecewiseChebyshev
    spectral_radius: float
    condition: float

    @property
    def is_stable(self) -> bool:
        """Whether max|λ| is not beyond 1, but for rounding."""
        return self.spectral_radius <= 1.0 + _BEYOND

    def displacements(self, fraction: ArrayLike, side: Side = "right") -> FloatArray:
        """Coordinates q at fractions of the period, shape (..., n)."""
        return np.asarray(self.state(fraction, side)[..., : self.system.size], dtype=float)

    def velocities(self, fraction: ArrayLike, side: Side = "right") -> FloatArray:
        """Rates q̇ of the coordinates at fractions of the period, shape (..., n)."""
        return np.asarray(self.state(fraction, side)[..., self.system.size :], dtype=float)

    def accelerations(self, fraction: ArrayLike, side: Side = "right") -> FloatArray:
        """Accelerations q̈ from the equations of motion at fractions of the period, shape (..., n)."""
        x, system = finite_array("fraction", fraction), self.system
        forces = known_forces(system, x, side)[..., np.newaxis]
        forces -= system.damping_matrix(x, side) @ self.velocities(x, side)[..., np.newaxis]
        forces -= system.stiffness_matrix(x, side) @ self.displacements(x, side)[..., np.newaxis]
        return np.asarray(np.linalg.solve(system.mass_matrix(x, side), forces)[..., 0], dtype=float)

    def contact_displacements(self, fraction: ArrayLike, side: Side = "right") -> FloatArray:
        """Displacement u = φᵀq − e of each load at fractions of the period, shape (..., p)."""
        displacements: FloatArray = self._contact(fraction, side, 0)[0]
        return displacements

    def contact_forces(self, fraction: ArrayLike, side: Side = "right") -> FloatArray:
        """Force w (k u + c u̇ + m ü) of each load at fractions of the period, shape (..., p)."""
        # Accelerations, which take longest, are felt by masses alone.
        order = 2 if any(load.mass for load in self.system.loads) else 1
        u = self._contact(fraction, side, order)
        forces: FloatArray = np.zeros(u.shape[1:])
        for number, load in enumerate(self.system.loads):
            parameters = np.array([load.stiffness, load.damping, load.mass])[: order + 1]
            forces[..., number] = np.tensordot(parameters, u[..., number], axes=1)
            if load.weight is not None:
                forces[..., number] *= load.weight(fraction, side)[..., 0]
        return forces

    def _contact(self, fraction: ArrayLike, side: Side, order: int) -> FloatArray:
        """U of each load and its derivatives to an order of at most 2, shape (order + 1, ..., p)."""
        x, period = finite_array("fraction", fraction), self.system.period
        motion = (self.displacements, self.velocities, self.accelerations)
        parts = [part(x, side) for part in motion[: order + 1]]
        found = -known_errors(self.system, x, side)[: order + 1]
        for number, load in enumerate(self.system.loads):
            phi = load.shape(x, side)
            for which, part in enumerate(parts):
                found[which, ..., number] += (phi * part).sum(axis=-1)
            if load.rate == "total" and order > 0:
                rate = load.slope(x, side) / period
                found[1, ..., number] += (rate * parts[0]).sum(axis=-1)
            if load.rate == "total" and order > 1:
                bend = load.curvature(x, side) / period**2
                found[2, ..., number] += (2.0 * rate * parts[1] + bend * parts[0]).sum(axis=-1)
        return found

    def mean(self, function: Callable[[FloatArray], FloatArray]) -> FloatArray:
        """Mean over the period of a function of the fractions, (m,) to (m, ...), such as a square of the motion."""
        return np.asarray(np.tensordot(self.weights, self._values(function), axes=1), dtype=float)

    def extremes(self, function: Callable[[FloatArray], FloatArray]) -> tuple[FloatArray, FloatArray]:
        """Lowest and highest value over the period of a function of the fractions, (m,) to (m, ...), each (...).

        The function must be as smooth on the panels as the motion is: contact displacements and forces are.
        """
        values = self._values(function)
        panels = values.reshape(self.state.breakpoints.size, -1, *values.shape[1:])
        fine = np.moveaxis(np.tensordot(_finer(panels.shape[1]), panels, axes=(1, 1)), 0, 1)
        # The vertex of the parabola through a sample and its neighbours, which are evenly spaced in the angle.
        before, middle, after = fine[:, :-2], fine[:, 1:-1], fine[:, 2:]
        slope, bend = (after - before) / 2.0, before - 2.0 * middle + after
        inside = np.abs(slope) < np.abs(bend)
        vertex = middle - np.where(inside, slope**2 / np.where(inside, 2.0 * bend, 1.0), 0.0)
        every = np.concatenate([fine, vertex], axis=1)
        return every.min(axis=(0, 1)), every.max(axis=(0, 1))

    def harmonics(self, order: int) -> ComplexArray:
        """Complex amplitudes X_s of the state, X = Re Σ X_s e^{isωt}, s = 0 ... order, shape (order + 1, 2n)."""
        s = np.arange(integer_at_least("order", order, 0) + 1)[:, np.newaxis]
        lengths, degrees = self.state.lengths, np.arange(self.state.degree + 1)
        nodes, _ = gauss_legendre(degrees.size)
        series = legendre_from_values(degrees.size) @ (
            chebyshev.chebvander(nodes, degrees[-1]) @ self.state.coefficients
        )
        # The integral of P_d(z) e^{−iaz} over [−1, 1] is 2 (−i)^d j_d(a), for any order.
        turning = lengths * np.exp(-2j * np.pi * s * (self.state.breakpoints + lengths / 2.0))
        found = np.zeros((s.size, 2 * self.system.size), dtype=complex)
        own, number = _distinct(lengths)
        for which, length in enumerate(own.tolist()):
            panels = number == which
            moments = np.tensordot(turning[:, panels], series[panels], axes=1)
            factors = 2.0 * (-1j) ** degrees * spherical_jn(degrees, np.pi * s * length)
            found += np.einsum("sd,sdn->sn", factors, moments)
        found[0] /= 2.0
        return found

    def _values(self, function: Callable[[FloatArray], FloatArray]) -> FloatArray:
        """Values of a function at the instants, (m, ...)."""
        if not callable(function):
            raise TypeError(f"function must be a function of fractions of the period, got {function!r}")
        values = finite_array("function", function(self.instants))
        if values.shape[:1] != self.instants.shape:
            raise ValueError(
                f"function must return shape ({self.instants.size}, ...) for {self.instants.size} fractions, got shape "
                f"{values.shape}"
            )
        return values

    @property
    def instants(self) -> FloatArray:
        """Gauss nodes of all panels, fractions of the period, ascending: dense enough for means."""
        return self._rule[0]

    @property
    def weights(self) -> FloatArray:
        """Weights of the :attr:`instants` in a mean over the period."""
        return self._rule[1]

    @cached_property
    def _rule(self) -> tuple[FloatArray, FloatArray]:
        x, weights = gauss_legendre(2 * self.state.degree + 2)
        lengths = self.state.lengths[:, np.newaxis]
        instants = self.state.breakpoints[:, np.newaxis] + lengths * (1.0 + x) / 2.0
        return instants.ravel(), (lengths * weights / 2.0).ravel()


def _distinct(lengths: FloatArray) -> tuple[FloatArray, NDArray[np.intp]]:
    """Lengths of panels that differ by more than rounding, and which of them each panel has.

    A revolution of many mesh periods has hundreds of panels and a few lengths.
    """
    order = np.argsort(lengths)
    new = np.diff(lengths[order], prepend=-1.0) > 4.0 * np.finfo(float).eps
    number = np.empty(lengths.size, dtype=np.intp)
    number[order] = np.cumsum(new) - 1
    return lengths[order][new], number


@lru_cache(maxsize=8)
def _finer(count: int) -> FloatArray:
    """Matrix from values at Gauss nodes of a panel to those at eight times as many places, its ends among them."""
    places = -np.cos(np.linspace(0.0, np.pi, 8 * count + 1))
    return np.asarray(legendre.legvander(places, count - 1) @ legendre_from_values(count), dtype=float)


def steady_response(
    system: PeriodicSystem, method: Method | None = None, *, allow_unstable: bool = False
) -> SteadyResponse:
    """Find the motion of a system that repeats itself each period under its forces and transmission errors.

    Parameters
    ----------
    system : PeriodicSystem
    method : Method, optional
        :class:`facegear.floquet.methods.Collocation` or :class:`facegear.floquet.radau.Radau`, which know the
        motion along the period. If left out, the first where it applies, else the second.
    allow_unstable : bool
        Whether a motion is wanted that any disturbance would leave.

    Returns
    -------
    SteadyResponse
        All zero for a system without forces and transmission errors.

    Raises
    ------
    ValueError
        If the system is unstable and that is not asked for, or the method knows the end of the period only.
    TypeError
        If an argument is of the wrong kind.
    ArithmeticError
        If a multiplier is so close to 1 that no motion repeats itself, or none that double precision could tell; or if
        panels do not resolve the motion.

    Examples
    --------
    An oscillator under a constant force rests at force over stiffness.

    >>> import facegear as fg
    >>> pushed = fg.PeriodicSystem([[1.0]], [[0.1]], [[4.0]], (), 2.0, force=fg.PiecewiseChebyshev.constant([2.0]))
    >>> fg.steady_response(pushed).displacements([0.0, 0.3]).round(12)
    array([[0.5],
           [0.5]])
    """
    require_system(system)
    if not isinstance(allow_unstable, bool | np.bool_):
        raise TypeError(f"allow_unstable must be True or False, got {allow_unstable!r}")
    return with_method(method, lambda chosen: _steady(system, chosen, allow_unstable), _OTHERWISE)


def _steady(system: PeriodicSystem, method: Method, allow_unstable: bool) -> SteadyResponse:
    if not isinstance(method, FollowsMotion):
        raise ValueError(
            "method must be Collocation or Radau (of facegear.floquet.methods and facegear.floquet.radau) for a "
            "response, which know the motion along the period, got "
            f"{method!r}"
        )
    family, instants = Family([system]), np.zeros(0)
    for _ in range(_MOST_ROUNDS):
        panels = method.motion_panels(system, instants.tolist())
        response, unresolved = _on_panels(family, panels, allow_unstable)
        unresolved = unresolved | _roughly_known(system, panels)
        if not unresolved.any():
            return response
        middles = (panels.edges[:-1] + panels.edges[1:]) / 2.0
        instants = np.concatenate([panels.edges[1:-1], middles[unresolved]])
    raise ArithmeticError(f"{panels.steps.shape[0]} panels do not resolve the response to {_TOLERANCE:.1g}")


def _on_panels(
    family: Family, panels: MotionPanels, allow_unstable: bool
) -> tuple[SteadyResponse, NDArray[np.bool_]]:
    """Steady response on some panels, and which of them are too long for it."""
    (system,), size = family.systems, 2 * family.size
    whole, moved = np.eye(size), np.zeros(size)
    into = _jumps(system, panels.edges[:-1])
    for jump, step, offset in zip(into, panels.steps, panels.offsets, strict=True):
        moved = step @ _jumped(jump, moved) + offset
        whole = step @ _jumped(jump, whole)
    scaled = family.scale @ whole @ family.inverse_scale
    if not np.isfinite(scaled).all():
        raise ArithmeticError("transition matrix is not finite: the motion grows beyond double precision")
    radius = float(np.abs(np.linalg.eigvals(scaled)).max())
    if radius > 1.0 + _BEYOND and not allow_unstable:
        raise ValueError(
            f"system must be stable for a steady response, got max|λ| = {radius:.9g}; allow_unstable=True finds the "
            "motion that any disturbance would leave"
        )
    away = np.eye(size) - scaled
    smallest = float(np.linalg.svd(away, compute_uv=False)[-1])
    largest = max(1.0, float(np.linalg.norm(scaled, 2)))
    condition = largest / max(smallest, 1e-300 * largest)
    if condition > _LOST:
        raise ArithmeticError(
            f"a multiplier is so close to 1 that no response is known (condition {condition:.2g}): a rigid-body "
            "motion, which facegear.WithoutRigidMotion(model) takes out, or an undamped resonance"
        )
    state = family.inverse_scale @ np.linalg.solve(away, family.scale @ moved)
    starts = []
    for jump, step, offset in zip(into, panels.steps, panels.offsets, strict=True):
        starts.append(_jumped(jump, state))
        state = step @ starts[-1] + offset
    inside = panels.inside(np.array(starts))
    coefficients = _to_series(panels) @ inside
    response = SteadyResponse(system, PiecewiseChebyshev(panels.edges[:-1], coefficients), radius, condition)
    sizes = np.abs(coefficients @ family.scale.T)
    unresolved = sizes[:, -2:].max(axis=(1, 2)) > _TOLERANCE * sizes.max()
    return response, unresolved


def _to_series(panels: MotionPanels) -> FloatArray:
    """Matrix from values at the nodes of a panel to Chebyshev coefficients."""
    values = chebyshev.chebvander(2.0 * panels.nodes - 1.0, panels.nodes.size - 1)
    return np.asarray(np.linalg.inv(values), dtype=float)


def _roughly_known(system: PeriodicSystem, panels: MotionPanels) -> NDArray[np.bool_]:
    """Panels on which what is given, forces, transmission errors, shapes and weights, is not resolved.

    A load too weak to move the system does not show in the state.
    """
    given = {system.force: None}
    for load in system.loads:
        given |= dict.fromkeys((load.shape, load.weight, load.transmission_error))
    starts, lengths = panels.edges[:-1, np.newaxis], np.diff(panels.edges)[:, np.newaxis]
    instants, last = starts + lengths * panels.nodes, _to_series(panels)[-2:]
    rough = np.zeros(starts.size, dtype=bool)
    for function in given:
        if function is not None and function.degree > 0:
            # A node at the end of a panel belongs to it.
            values = function(instants)
            values[:, -1] = function(instants[:, -1], "left")
            tails = np.abs(last @ values).max(axis=(1, 2))
            rough |= tails > _KNOWN_TOLERANCE * function.largest
    return rough


def _jumped(jump: FloatArray | None, state: FloatArray) -> FloatArray:
    """States after a jump, if there is one."""
    return state if jump is None else jump @ state


def _jumps(system: PeriodicSystem, starts: FloatArray) -> list[FloatArray | None]:
    """Jumps of the state at the starts of panels, None where there are none."""
    matrices: list[FloatArray | None] = [None] * starts.size
    for at, jump in system.state_jumps():
        matrices[int(np.abs(starts - at).argmin())] = jump
    return matrices
