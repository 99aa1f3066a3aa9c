"""Transition matrices as smooth functions of speed, interpolated, so that thousands of speeds cost little.

The free motion turns by ω T0 in a period and T0 is in inverse proportion to speed: in the variable 1/speed the
transition matrix is a smooth function of even oscillation, and Chebyshev series on windows of it converge fast.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from facegear.collocation import UnsuitableSystemError, is_suitable
from facegear.floquet import AdaptiveMagnus, Collocation, Method, transition_matrices
from facegear.models import Model
from facegear.periodic import PeriodicSystem
from facegear.piecewise import Array
from facegear.stepping import Family

ComplexArray = NDArray[np.complex128]

# Size of the last Chebyshev coefficients relative to the largest entry or 1.
_TOLERANCE = 1e-11
# A window spans so much of the fastest angle ω T0 [rad] to begin with, and is cut in two if the degree is not enough.
_WINDOW_ANGLE = 36.0
_DEGREES = (16, 32, 64)
_MOST_CUTS = 12


@dataclass(frozen=True, eq=False)
class _Window:
    """Chebyshev series of the scaled transition matrix for slowness 1/speed between `low` and `high`."""

    low: float
    high: float
    coefficients: Array

    def values(self, slowness: Array) -> Array:
        """Matrices, shape (m, d, d)."""
        return np.tensordot(self._basis(slowness), self.coefficients, axes=1)

    def slopes(self, slowness: Array) -> Array:
        """Their derivatives by slowness, shape (m, d, d)."""
        slope = chebyshev.chebder(self.coefficients, axis=0) / ((self.high - self.low) / 2.0)
        return np.tensordot(self._basis(slowness)[:, :-1], slope, axes=1)

    def _basis(self, slowness: Array) -> Array:
        local = (slowness - (self.high + self.low) / 2.0) / ((self.high - self.low) / 2.0)
        return np.asarray(chebyshev.chebvander(np.clip(local, -1.0, 1.0), self.coefficients.shape[0] - 1))


@dataclass(frozen=True, eq=False)
class MultiplierCurve:
    """Floquet multipliers of a model against speed, from interpolated transition matrices.

    Attributes
    ----------
    fastest_angle : tuple of float
        Angle ω T0 [rad] by which the fastest motion turns in a period, at the highest and the lowest speed.
    error : float
        Largest distance of a multiplier from that of a more accurate method, at three speeds between the nodes.
    """

    lowest_speed: float
    highest_speed: float
    fastest_angle: tuple[float, float]
    error: float
    windows: tuple[_Window, ...]

    @classmethod
    def of(
        cls, model: Model, lowest_speed: float, highest_speed: float, method: Method | None = None
    ) -> MultiplierCurve:
        """Interpolate the transition matrices of a model between two speeds [rad/s].

        Raises
        ------
        ArithmeticError
            If they do not vary smoothly with speed.
        """
        ends = [model.system(speed) for speed in (highest_speed, lowest_speed)]
        families = [Family([system]) for system in ends]
        angles = (families[0].fastest_angle, families[1].fastest_angle)
        scale = families[0].scale
        inverse = np.linalg.inv(scale)
        chosen = method_for(model, lowest_speed, highest_speed) if method is None else method

        def matrices(slowness: Array) -> Array:
            systems = [model.system(1.0 / x) for x in slowness.tolist()]
            return np.asarray(scale @ _family_matrices(systems, chosen) @ inverse, dtype=float)

        count = int(np.ceil(abs(angles[1] - angles[0]) / _WINDOW_ANGLE)) or 1
        edges = np.linspace(1.0 / highest_speed, 1.0 / lowest_speed, count + 1)
        windows = [
            window
            for low, high in pairwise(edges.tolist())
            for window in _windows(matrices, float(low), float(high), _MOST_CUTS)
        ]
        curve = cls(lowest_speed, highest_speed, angles, 0.0, tuple(windows))
        checked = 1.0 / (edges[0] + (edges[-1] - edges[0]) * np.array([0.0371, 0.4713, 0.9329]))
        error = max(_distance(curve, model.system(float(v)), float(v), chosen) for v in checked)
        return cls(lowest_speed, highest_speed, angles, error, tuple(windows))

    def transition_matrices(self, speeds: Array) -> Array:
        """Scaled Φ at speeds (m,), shape (m, 2n, 2n)."""
        return self._by_window(speeds, _Window.values)

    def slopes(self, speeds: Array) -> Array:
        """Differentiate the scaled Φ by 1/speed at speeds (m,), shape (m, 2n, 2n)."""
        return self._by_window(speeds, _Window.slopes)

    def _by_window(self, speeds: Array, evaluate: Callable[[_Window, Array], Array]) -> Array:
        slowness = 1.0 / np.asarray(speeds, dtype=float)
        found = np.empty((slowness.size, *self.windows[0].coefficients.shape[1:]))
        starts = np.array([window.low for window in self.windows])
        where = np.clip(np.searchsorted(starts, slowness, side="right") - 1, 0, None)
        for number in np.unique(where):
            inside = where == number
            found[inside] = evaluate(self.windows[number], slowness[inside])
        return found

    def spectral_radii(self, speeds: Array) -> Array:
        """max|α| at speeds (m,)."""
        matrices = self.transition_matrices(np.atleast_1d(speeds))
        return np.asarray(np.abs(np.linalg.eigvals(matrices)).max(axis=-1), dtype=float)


def method_for(model: Model, lowest_speed: float, highest_speed: float) -> Method:
    """Collocation if it suits the model at both ends and in the middle of a range of speed, else adaptive Magnus."""
    speeds = (lowest_speed, (lowest_speed + highest_speed) / 2.0, highest_speed)
    if all(is_suitable(model.system(speed)) for speed in speeds):
        return Collocation()
    return AdaptiveMagnus()


def _family_matrices(systems: list[PeriodicSystem], method: Method) -> Array:
    first = systems[0].breakpoints
    try:
        if all(np.array_equal(system.breakpoints, first) for system in systems[1:]):
            return transition_matrices(systems, method)
        return np.concatenate([transition_matrices([system], method) for system in systems])
    except UnsuitableSystemError:
        return np.concatenate([transition_matrices([system], AdaptiveMagnus()) for system in systems])


def _windows(evaluate: Callable[[Array], Array], low: float, high: float, cuts: int) -> list[_Window]:
    """Series on one window, or on halves of it where its degree does not suffice."""
    middle, half = (low + high) / 2.0, (high - low) / 2.0
    values = evaluate(middle + half * _lobatto(_DEGREES[0]))
    for degree in _DEGREES:
        if values.shape[0] <= degree:
            # The points of the coarser rule are every second one of the finer.
            between = evaluate(middle + half * _lobatto(degree)[1::2])
            finer = np.empty((degree + 1, *values.shape[1:]))
            finer[0::2], finer[1::2] = values, between
            values = finer
        coefficients = _coefficients(values)
        tail = np.abs(coefficients[-2:]).max()
        if tail <= _TOLERANCE * max(1.0, float(np.abs(values).max())):
            return [_Window(low, high, coefficients)]
    if cuts == 0:
        raise ArithmeticError(
            f"transition matrices do not vary smoothly with speed between {1.0 / high:.6g} and {1.0 / low:.6g} rad/s: "
            f"the last Chebyshev coefficient is {tail:.2g}"
        )
    return _windows(evaluate, low, middle, cuts - 1) + _windows(evaluate, middle, high, cuts - 1)


def _lobatto(degree: int) -> Array:
    return np.cos(np.pi * np.arange(degree + 1) / degree)


def _coefficients(values: Array) -> Array:
    """Chebyshev coefficients from values at cos(π j/K) along the first axis."""
    degree = values.shape[0] - 1
    ends = np.ones(degree + 1)
    ends[[0, -1]] = 0.5
    order = np.arange(degree + 1)
    transform = np.cos(np.pi * np.outer(order, order) / degree) * ends * ends[:, None] * (2.0 / degree)
    return np.tensordot(transform, values, axes=1)


def _distance(curve: MultiplierCurve, system: PeriodicSystem, speed: float, method: Method) -> float:
    """Largest distance of a multiplier of the curve to the nearest of a refined method, those inside 1/2 left out."""
    coarse = np.linalg.eigvals(curve.transition_matrices(np.array([speed]))[0])
    fine = np.linalg.eigvals(transition_matrices([system], method.refined())[0])
    distance = np.abs(coarse[:, None] - fine[None, :]).min(axis=1)
    return float(distance[np.abs(coarse) > 0.5].max(initial=0.0))
