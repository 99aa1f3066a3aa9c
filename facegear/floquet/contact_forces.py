"""Equations for the contact forces at the Gauss nodes of panels, for any values of the load parameters.

With modal coordinates y of the free motion, ẏ = Λ y − Σ β_a f_a, variation of constants gives on each panel

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

from facegear.floquet.free_modes import FreeModes
from facegear.floquet.gauss_panels import gauss_rule
from facegear.floquet.loads import ContactLoad
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.support.types import ComplexArray, FloatArray

# Instants at which it is seen how mobile a system is under its loads.
_INSTANTS = 16


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
    reading : array of complex, shape (orders, S, P, N, p, n)
        z₀, z₁, z₂, or as many of them as were asked for: what u, u̇ and ü of the free motion are made of.
    beta : array of complex, shape (S, P, N, p, n)
        Modal accelerations β by unit contact forces.
    direct : array, shape (S, P, N, p, p), optional
        D, accelerations ü by unit contact forces, where accelerations are read.
    """

    fractions: FloatArray
    spans: FloatArray
    spread: ComplexArray
    half: ComplexArray
    reading: ComplexArray
    beta: ComplexArray
    direct: FloatArray | None

    @classmethod
    def of(
        cls,
        systems: Sequence[PeriodicSystem],
        modes: FreeModes,
        nodes: int,
        start: FloatArray,
        length: FloatArray,
        orders: int = 3,
    ) -> Nodes:
        """Evaluate everything on panels of given starts and lengths, fractions of the period (P,).

        Of u, u̇ and ü the first `orders` are read.
        """
        x, _, _ = gauss_rule(nodes)
        periods = np.array([system.period for system in systems])
        systems_, count, p, n = len(systems), start.size, len(systems[0].loads), modes.size
        fractions = start[:, None] + length[:, None] * x
        h = periods[:, None] * length
        exponents = modes.eigenvalues[:, None, :] * h[:, :, None]

        # Modes act on the last axis of what is known at all nodes of all panels: (S or 1, P, N p, n).
        def values(part: Callable[[ContactLoad], PiecewiseChebyshev]) -> FloatArray:
            found = at_nodes(systems, part, fractions)
            return found.reshape(len(found), count * nodes * p, n)

        shape = (systems_, count, nodes, p, n)

        def readings(by: FloatArray, factors: ComplexArray) -> ComplexArray:
            # Real times complex as one product of real matrices, which takes half as long.
            pairs = by @ np.ascontiguousarray(factors).view(float)
            return np.asarray(pairs.view(complex).reshape(shape), dtype=complex)

        phi = values(lambda load: load.shape)
        weighted = phi
        if any(load.weight is not None for load in systems[0].loads):
            factor = at_nodes(systems, _weight, fractions)
            weighted = phi * factor.reshape(len(factor), count * nodes * p, 1)
        velocity = modes.velocity
        read = np.empty((orders, *shape), dtype=complex)
        read[0] = readings(phi, modes.displacement)
        if orders > 1:
            read[1] = readings(phi, velocity)
        if orders > 2:
            np.multiply(read[1], modes.eigenvalues[:, None, None, None, :], out=read[2])
        total = np.array([load.rate == "total" for load in systems[0].loads])
        if orders > 1 and total.any():
            rate = total[:, None] / periods[:, None, None, None, None]
            slope = values(lambda load: load.slope)
            read[1] += rate * readings(slope, modes.displacement)
            if orders > 2:
                read[2] += 2.0 * rate * readings(slope, velocity)
                read[2] += rate**2 * readings(values(lambda load: load.curvature), modes.displacement)
        direct = None
        if orders > 2:
            inverse = np.linalg.inv(np.stack([system.mass for system in systems]))
            moved = (weighted @ inverse).reshape(systems_, count, nodes, p, n)
            direct = phi.reshape(len(phi), count, nodes, p, n) @ moved.swapaxes(-1, -2)
        return cls(
            fractions=fractions,
            spans=h,
            spread=_spread(modes.eigenvalues, periods, length, nodes),
            half=np.exp(exponents / 2.0),
            reading=read,
            beta=readings(weighted, modes.input.swapaxes(-1, -2)),
            direct=direct,
        )

    def loaded(self, parameters: FloatArray) -> Nodes:
        """Read the force k u + c u̇ + m ü of each system's own parameters (3, S, p), in place of what it is made of."""
        force = np.zeros_like(self.reading[:1])
        for order, read in enumerate(self.reading):
            force[0] += parameters[order][:, np.newaxis, np.newaxis, :, np.newaxis] * read
        direct = self.direct
        if direct is not None:
            direct = parameters[2][:, np.newaxis, np.newaxis, :, np.newaxis] * direct
        return replace(self, reading=force, direct=direct)


def _spread(eigenvalues: ComplexArray, periods: FloatArray, lengths: FloatArray, nodes: int) -> ComplexArray:
    """Motions of modes (S, n) from the middle of panels (P,) to their nodes, (S, P, N, n)."""
    x, _, _ = gauss_rule(nodes)
    # Panels of one piece are of one length, but for rounding, and nodes as far before the middle as after it.
    _, first, which = np.unique(np.round(lengths, 12), return_index=True, return_inverse=True)
    turns = (eigenvalues * periods[:, None])[:, None, None, :] * lengths[first][:, None, None]
    before = np.exp(turns * (x[: (nodes + 1) // 2, None] - 0.5))
    both = np.concatenate([before, 1.0 / before[:, :, : nodes // 2][:, :, ::-1]], axis=2)
    return np.asarray(both[:, which.ravel()], dtype=complex)


@dataclass(frozen=True, eq=False)
class ForcePanels:
    """Everything that does not depend on the load parameters; S systems, P panels, N nodes, p loads, n modes.

    Systems with one value each have all of it but E and G multiplied by their parameters and summed.

    Attributes
    ----------
    force_on_force : array, shape (orders, S, P, N p, N p)
        H₀, H₁, H₂ + D: all three for loads with mass, two for those with damping alone, else one.
    force_on_state : array, shape (orders, S, P, N p, 2n)
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

    @classmethod
    def of(
        cls,
        systems: Sequence[PeriodicSystem],
        modes: FreeModes,
        nodes: int,
        start: FloatArray,
        length: FloatArray,
        orders: int = 3,
        parameters: FloatArray | None = None,
    ) -> ForcePanels:
        """Set up the equations on panels of given starts and lengths, fractions of the period (P,).

        Of systems with one value each the parameters are given, shape (3, S, p).
        """
        _, weights, integration = gauss_rule(nodes)
        at = Nodes.of(systems, modes, nodes, start, length, orders)
        if parameters is not None:
            at, orders = at.loaded(parameters), 1
        systems_, count, p, n = len(systems), start.size, len(systems[0].loads), modes.size
        rows = (at.reading * at.spread[:, :, :, None, :]).reshape(orders, systems_, count, nodes * p, n)
        # Backwards they are their own inverses.
        columns = (at.beta * at.spread[:, :, ::-1, None, :]).reshape(systems_, count, nodes * p, n)
        columns *= at.spans[:, :, None, None]
        # Re Σ z β as one product of real matrices, their columns (Re, Im) and (Re, −Im) in turn.
        force_on_force = rows.view(float) @ columns.conj().view(float).swapaxes(-1, -2)
        force_on_force *= np.repeat(np.repeat(integration, p, axis=0), p, axis=1)
        if at.direct is not None:
            blocks = force_on_force[-1].reshape(systems_, count, nodes, p, nodes, p)
            blocks[:, :, np.arange(nodes), :, np.arange(nodes), :] += np.moveaxis(at.direct, 2, 0)

        push = columns * at.half[:, :, None, :] * np.repeat(weights, p)[:, None]
        decay = at.half**2
        free = np.zeros((systems_, count, 2 * n, 2 * n))
        i = np.arange(n)
        free[..., i, i] = free[..., n + i, n + i] = decay.real
        free[..., n + i, i] = decay.imag
        free[..., i, n + i] = -decay.imag
        return cls(
            force_on_force=force_on_force,
            force_on_state=_split(rows * at.half[:, :, None, :]),
            free=free,
            input=np.concatenate([push.real, push.imag], axis=-1).swapaxes(-1, -2),
        )

    def equations(self, parameters: FloatArray | None) -> tuple[FloatArray, FloatArray]:
        """Return both sides of the equations for the contact forces, (V, P, N p, N p) and (V, P, N p, 2n).

        Parameters are stiffness, damping and mass of all loads, shape (3, V, p); none of systems that have one value
        each.
        """
        size = self.input.shape[-1]
        if parameters is None:
            (left,), (right,) = self.force_on_force.copy(), self.force_on_state
            number = np.arange(size)
            left[..., number, number] += 1.0
            return left, right
        count = parameters.shape[1]
        left = np.empty((count, *self.force_on_force.shape[2:]))
        right = np.empty((count, *self.force_on_state.shape[2:]))
        for order, values in enumerate(parameters):
            factor = np.tile(values, (1, size // max(values.shape[1], 1)))[:, None, :, None]
            if order == 0:
                np.multiply(factor, self.force_on_force[order], out=left)
                np.multiply(factor, self.force_on_state[order], out=right)
            elif values.any():
                left += factor * self.force_on_force[order]
                right += factor * self.force_on_state[order]
        number = np.arange(size)
        left[..., number, number] += 1.0
        return left, right

    def forces(self, parameters: FloatArray | None) -> FloatArray:
        """Contact forces at the nodes of each panel, for unit modal coordinates at its start, (V, P, N p, 2n)."""
        return np.asarray(np.linalg.solve(*self.equations(parameters)), dtype=float)

    def halved(self, chosen: NDArray[np.bool_], halves: ForcePanels) -> ForcePanels:
        """Return the panels with the two halves of each chosen one in its place."""
        return ForcePanels(
            in_place(chosen, self.force_on_force, halves.force_on_force, axis=2),
            in_place(chosen, self.force_on_state, halves.force_on_state, axis=2),
            in_place(chosen, self.free, halves.free, axis=1),
            in_place(chosen, self.input, halves.input, axis=1),
        )


def in_place(chosen: NDArray[np.bool_], whole: FloatArray, halves: FloatArray, axis: int) -> FloatArray:
    """Return values with halves, two for each chosen entry along an axis, in the place of these entries."""
    twice = 1 + chosen
    found = whole.take(np.repeat(np.arange(chosen.size), twice), axis)
    found[(slice(None),) * axis + (np.repeat(chosen, twice),)] = halves
    return found


def _split(matrix: ComplexArray) -> FloatArray:
    """Real rows (Re, −Im), so that Re(matrix y) = rows (Re y, Im y)."""
    n = matrix.shape[-1]
    rows = np.empty((*matrix.shape[:-1], 2 * n))
    rows[..., :n] = matrix.real
    np.negative(matrix.imag, out=rows[..., n:])
    return rows


_ALWAYS_ONE = PiecewiseChebyshev.constant([1.0])


def _weight(load: ContactLoad) -> PiecewiseChebyshev:
    return _ALWAYS_ONE if load.weight is None else load.weight


def at_nodes(
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
    """As :func:`at_nodes`, for values of a function at instants of some shape."""
    functions = [[part(load) for load in system.loads] for system in systems]
    if all(own is first for row in functions[1:] for own, first in zip(row, functions[0], strict=True)):
        functions = functions[:1]
    if not functions[0]:
        return np.empty((1, *shape, 0, systems[0].size))
    found = {function: values(function) for function in {own for row in functions for own in row}}
    return np.stack([np.stack([found[function] for function in row], axis=-2) for row in functions])


@lru_cache(maxsize=64)
def _sampled(function: PiecewiseChebyshev) -> FloatArray:
    """Values at instants spread over the period."""
    return function(np.linspace(0.0, 1.0, _INSTANTS, endpoint=False))


def mobilities(systems: Sequence[PeriodicSystem]) -> FloatArray:
    """Return the largest φᵀM⁻¹φ of each load, at sampled instants, shape (V, p)."""
    shapes = _at_instants(systems, lambda load: load.shape, _sampled, (_INSTANTS,))
    mass = np.stack([system.mass for system in systems])[:, None]
    if (mass == mass[0]).all():
        mass = mass[:1]
    moved = np.linalg.solve(mass, shapes.swapaxes(-1, -2)).swapaxes(-1, -2)
    found = np.asarray((shapes * moved).sum(axis=-1).max(axis=1), dtype=float)
    return np.broadcast_to(found, (len(systems), found.shape[1]))
