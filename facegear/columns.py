"""Whole columns of a map: spectral radii along one swept parameter at one speed.

The transition matrix is an entire function of stiffness and damping, and analytic in mass ≥ 0 and in every other
parameter a model depends on smoothly. It is therefore computed at Chebyshev points of the parameter only, and its
entries are interpolated, with more points until the last coefficients vanish.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from facegear.collocation import FreeMotion, UnsuitableSystemError
from facegear.floquet import AdaptiveMagnus, Method, transition_matrices
from facegear.parameters import finite_array
from facegear.periodic import LoadColumn, PeriodicSystem
from facegear.piecewise import Array

#: Size of the last Chebyshev coefficients of the interpolated matrices, relative to the largest entry or 1.
TOLERANCE = 1e-10
#: General route of columns; what it estimates is the error before its last extrapolation.
GENERAL_ROUTE = AdaptiveMagnus(1e-9)


def column_spectral_radii(
    system: PeriodicSystem,
    masses: ArrayLike,
    dampings: ArrayLike,
    stiffnesses: ArrayLike,
    method: Method | None = None,
) -> Array:
    """Largest modulus of the Floquet multipliers for many values of the load parameters.

    Parameters
    ----------
    system : PeriodicSystem
        Its own load parameters are not used.
    masses, dampings, stiffnesses : array_like, shape (V,) or (V, loads) or ()
        Load parameters m [kg], c [N s/m], k [N/m] (or rotational units) along the column, not negative. One
        number for all loads or one a load; a single number holds for the whole column.
    method : Method, optional
        If left out, contact-force collocation where the free motion allows it, else adaptive Magnus.

    Returns
    -------
    array, shape (V,)
        max|α| [-], error at most 1e-9 unless multipliers are about to coincide.

    Raises
    ------
    TypeError, ValueError
        Naming the parameter, if shapes do not match or values are negative or not finite.
    """
    column = _load_column(len(system.loads), masses, dampings, stiffnesses)
    return _spectral_radii(column_transition_matrices(system, column, method))


def family_spectral_radii(
    system_at: Callable[[float], PeriodicSystem], values: ArrayLike, method: Method | None = None
) -> Array:
    """Largest modulus of the Floquet multipliers along any one parameter of a model.

    Parameters
    ----------
    system_at : callable
        ``system_at(value)`` returns the system; an analytic function of the value, with coordinates that keep
        their meaning and breakpoints that stay.
    values : array_like, shape (V,)
    method : Method, optional
        Adaptive Magnus if left out.

    Returns
    -------
    array, shape (V,)
    """
    points = finite_array("values", values)
    if points.ndim != 1 or points.size == 0:
        raise ValueError(f"values must have shape (V,), V >= 1; got shape {points.shape}")

    chosen = GENERAL_ROUTE if method is None else method

    def evaluate(part: Array) -> Array:
        return transition_matrices([system_at(float(value)) for value in part], chosen)

    return _spectral_radii(interpolate(evaluate, points, TOLERANCE))


def column_transition_matrices(
    system: PeriodicSystem, column: LoadColumn, method: Method | None = None
) -> Array:
    """Transition matrices along a column, in coordinates that are fixed along it.

    Returns
    -------
    array, shape (V, 2n, 2n)
        Similar to the transition matrices of the state (q, q̇): the same eigenvalues.
    """
    evaluate: Callable[[LoadColumn], Array]
    mobility = 1.0
    if method is None:
        try:
            motion = FreeMotion(system, column)
        except UnsuitableSystemError:
            method = GENERAL_ROUTE
        else:
            evaluate = motion.transition_matrices
            mobility = float(motion.mobility.max(initial=0.0))
    if method is not None:

        def evaluate(part: LoadColumn) -> Array:
            systems = [
                system.replace_loads(mass=m, damping=c, stiffness=k)
                for m, c, k in zip(part.mass, part.damping, part.stiffness, strict=True)
            ]
            return transition_matrices(systems, method)

    line = _StraightLine.through(column, mobility)
    if line is None:
        return evaluate(column)
    return interpolate(lambda t: evaluate(line.column(t)), line.variable, TOLERANCE)


def _spectral_radii(matrices: Array) -> Array:
    return np.asarray(np.abs(np.linalg.eigvals(matrices)).max(axis=-1), dtype=float)


def _load_column(loads: int, masses: ArrayLike, dampings: ArrayLike, stiffnesses: ArrayLike) -> LoadColumn:
    """Bring the three parameters to shape (V, loads)."""
    given = {"masses": masses, "dampings": dampings, "stiffnesses": stiffnesses}
    arrays = {name: finite_array(name, values) for name, values in given.items()}
    length = max((array.shape[0] for array in arrays.values() if array.ndim), default=1)
    for name, array in arrays.items():
        if array.shape not in ((), (length,), (length, loads)):
            raise ValueError(
                f"{name} must have shape (), ({length},) or ({length}, {loads}), values and loads; "
                f"got {array.shape}"
            )
        column = array[:, None] if array.ndim == 1 else array
        arrays[name] = np.broadcast_to(column, (length, loads))
    return LoadColumn(arrays["masses"], arrays["dampings"], arrays["stiffnesses"])


@dataclass(frozen=True, eq=False)
class _StraightLine:
    """Load parameters start + s (end − start), and the variable t in which matrices are interpolated.

    Without a mass along the line t = s. With one, t = 1/(1 + b m), b the mobility of the contact: the matrix then
    stays smooth however heavy the mass.
    """

    start: Array
    end: Array
    variable: Array
    mobility: float
    heaviest: int | None

    @classmethod
    def through(cls, column: LoadColumn, mobility: float) -> _StraightLine | None:
        """Find the line through a column, or None if its values do not lie on one."""
        values = column.stacked()
        span = np.ptp(values, axis=0)
        size = np.abs(values).max(axis=0)
        relative = span / np.where(size > 0.0, size, 1.0)
        if relative.size == 0 or relative.max() == 0.0:
            return None
        leader = int(relative.argmax())
        start, end = values[values[:, leader].argmin()], values[values[:, leader].argmax()]
        s = (values[:, leader] - start[leader]) / (end[leader] - start[leader])
        if (np.abs(start + s[:, None] * (end - start) - values) > 1e-13 * size).any():
            return None
        change = np.abs(end - start)[: column.mass.shape[1]]
        heaviest = int(change.argmax()) if change.max(initial=0.0) > 0.0 else None
        line = cls(start, end, s, mobility, heaviest)
        if heaviest is None:
            return line
        mass = start[heaviest] + s * (end - start)[heaviest]
        return cls(start, end, 1.0 / (1.0 + mobility * mass), mobility, heaviest)

    def column(self, t: Array) -> LoadColumn:
        """Load parameters at values of the variable."""
        s = t
        if self.heaviest is not None:
            mass = (1.0 / t - 1.0) / self.mobility
            s = (mass - self.start[self.heaviest]) / (self.end - self.start)[self.heaviest]
        return LoadColumn.from_stacked(self.start + s[:, None] * (self.end - self.start))


def interpolate(evaluate: Callable[[Array], Array], points: Array, tolerance: float) -> Array:
    """Evaluate an analytic matrix function of one variable at many points by Chebyshev interpolation.

    Parameters
    ----------
    evaluate : callable
        (K,) values -> (K, d, d) matrices.
    points : array, shape (V,)
    tolerance : float
        Size of the last coefficients relative to the largest entry or 1, at which to stop.

    Returns
    -------
    array, shape (V, d, d)
        Evaluated point by point instead, if that takes no more evaluations.
    """
    low, high = float(points.min()), float(points.max())
    middle, half = (low + high) / 2.0, (high - low) / 2.0
    degree = 8
    if degree + 1 >= points.size or half == 0.0:
        return evaluate(points)
    values = evaluate(middle + half * np.cos(np.pi * np.arange(degree + 1) / degree))
    while True:
        coefficients = _lobatto_coefficients(values)
        sizes = np.abs(coefficients).max(axis=(1, 2))
        # Two coefficients, in case one is small by accident.
        if sizes[-2:].max() <= tolerance * max(float(np.abs(values).max()), 1.0):
            break
        if 2 * degree + 1 >= points.size:
            return evaluate(points)
        # The points of half the spacing contain the present ones.
        between = evaluate(middle + half * np.cos(np.pi * (np.arange(degree) + 0.5) / degree))
        finer = np.empty((2 * degree + 1, *values.shape[1:]))
        finer[0::2], finer[1::2] = values, between
        values, degree = finer, 2 * degree
    basis = np.polynomial.chebyshev.chebvander(np.clip((points - middle) / half, -1.0, 1.0), degree)
    return np.tensordot(basis, coefficients, axes=1)


def _lobatto_coefficients(values: Array) -> Array:
    """Chebyshev coefficients from values at cos(π j/K), j = 0 ... K, along the first axis."""
    degree = values.shape[0] - 1
    ends = np.ones(degree + 1)
    ends[[0, -1]] = 0.5
    order = np.arange(degree + 1)
    transform = np.cos(np.pi * np.outer(order, order) / degree) * ends * ends[:, None] * (2.0 / degree)
    return np.tensordot(transform, values, axes=1)
