"""Transition matrices as smooth functions of speed, interpolated, so that thousands of speeds cost little.

The free motion turns by ω T0 in a period and T0 is in inverse proportion to speed: in the variable 1/speed the
transition matrix is a smooth function of even oscillation, and Chebyshev series on windows of it converge fast.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from facegear.floquet.compiled import LANES
from facegear.floquet.eigenvalues import spectral_radii
from facegear.floquet.error_estimates import disturbed, rounding_error
from facegear.floquet.methods import Method, with_method
from facegear.floquet.models import Model
from facegear.floquet.multipliers import transition_matrices
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.series import ChebyshevSeries, lobatto_coefficients
from facegear.floquet.stepping import Family
from facegear.support.types import ComplexArray, FloatArray

# Size of the last Chebyshev coefficients relative to the largest entry or 1.
_TOLERANCE = 1e-11
# A window spans so much of the fastest live angle [rad] to begin with, and is cut in two if the degree is not enough.
_WINDOW_ANGLE = 200.0
_LOWEST_DEGREE = 8
# Degree of the series from which the degree is read that motions need: far above what a window's angle asks for.
_LONGEST = 256
_MOST_CUTS = 12
# A motion that decays by e⁻³⁰ = 1e-13 in a period leaves nothing in the transition matrix.
_DEAD = 30.0
# Slowness of systems computed together differs by this factor at most: they share panels or sub-intervals.
_TOGETHER = 1.4
# Matrices of which eigenvalues are found at once, and the sum of the third powers of their sizes.
_MOST_AT_ONCE, _CUBES_AT_ONCE = 512, 320_000_000


@dataclass(frozen=True, eq=False)
class FrozenMotions:
    """Motions e^{p T0} of a model frozen at some instants, as functions of slowness 1/speed.

    Attributes
    ----------
    low, high : float
        Range of slowness.
    exponents : complex array, shape (m,)
        p T0 over slowness.
    """

    low: float
    high: float
    exponents: ComplexArray

    @classmethod
    def of(cls, model: Model, low: float, high: float) -> FrozenMotions:
        """Freeze a model in the middle of its smooth pieces, at both ends of a range of slowness."""
        found = [Family([model.system(1.0 / x)]).frozen_exponents.ravel() / x for x in (low, high)]
        return cls(low, high, np.concatenate(found))

    @cached_property
    def leading(self) -> ComplexArray:
        """Exponents of the motions of which none is both faster and less damped: all others are resolved with them."""
        order = np.argsort(-np.abs(self.exponents.imag), kind="stable")
        growth = self.exponents.real[order]
        return self.exponents[order][growth > np.append(-np.inf, np.maximum.accumulate(growth)[:-1])]

    def live_angle(self, decay: float) -> tuple[FloatArray, FloatArray]:
        """Slowness, ascending, and angle [rad] by which the fastest motion turns that decays by e^-decay or less.

        The angle is summed up from the first slowness on and runs straight between.
        """
        dead = decay / np.maximum(-self.exponents.real, decay / (2.0 * self.high))
        slowness = np.unique(np.clip(np.append(dead, [self.low, self.high]), self.low, self.high))
        middle = (slowness[1:] + slowness[:-1]) / 2.0
        fastest = np.where(dead > middle[:, None], np.abs(self.exponents.imag), 0.0).max(axis=1)
        return slowness, np.append(0.0, np.cumsum(fastest * np.diff(slowness)))

    @property
    def all_live(self) -> bool:
        """Whether no motion dies within the shortest period."""
        return bool((-self.exponents.real * self.low < _DEAD / 2.0).all())

    def points(self, step: float, fewest: int, decay: float) -> FloatArray:
        """Slowness from end to end, neighbours apart by `step` [rad] at most and by 1/`fewest` of the range.

        The angle is that of :meth:`live_angle`.
        """
        slowness, angle = self.live_angle(decay)
        density = angle / step + fewest * (slowness - self.low) / (self.high - self.low)
        # Where nothing oscillates there are the two ends.
        places = np.linspace(0.0, density[-1], max(int(np.ceil(density[-1])), 1) + 1)
        points = np.interp(places, density, slowness)
        points[[0, -1]] = self.low, self.high
        return np.asarray(points, dtype=float)

    @cached_property
    def windows(self) -> tuple[tuple[float, float], ...]:
        """Parts of the range on each of which one series is tried."""
        return tuple(pairwise(self.points(_WINDOW_ANGLE, 0, _DEAD).tolist()))

    @property
    def matrices(self) -> int:
        """Number of transition matrices that the series on all windows are expected to take."""
        return sum(self.degree(low, high) + 1 for low, high in self.windows)

    def degree(self, low: float, high: float) -> int:
        """Even degree at which the Chebyshev series of all motions between two values of slowness have ended."""
        return degree_between(self.leading * low, self.leading * high, _TOLERANCE)


def degree_between(first: ComplexArray, last: ComplexArray, tolerance: float) -> int:
    """Even degree at which Chebyshev series of motions e^p have ended, p straight from `first` to `last` (m,)."""
    # Twice the largest angle is far beyond the last Bessel function that counts.
    turn = float(np.abs(last.imag - first.imag).max()) / 2.0
    nodes = (1.0 + chebyshev.chebpts2(min(_LONGEST, 2 * int(turn) + 64) + 1)) / 2.0
    exponents = first + nodes[:, None] * (last - first)
    motions = np.exp(np.minimum(exponents.real, 0.0) + 1j * exponents.imag)
    sizes = np.abs(lobatto_coefficients(motions)).max(axis=1)
    ended = np.flatnonzero(sizes > tolerance / 10.0)
    return max(_LOWEST_DEGREE, 2 * ((int(ended[-1]) + 2) // 2) if ended.size else 0)


def _unheard(count: int) -> None:
    """Do nothing with a number of matrices."""


@dataclass(frozen=True, eq=False)
class MultiplierCurve:
    """Floquet multipliers of a model against speed, from interpolated transition matrices.

    Attributes
    ----------
    model : Model
    method : Method
        Method of the transition matrices.
    lowest_speed, highest_speed : float
        Range of speed [rad/s].
    motions : FrozenMotions
        How fast the model moves and what dies within a period.
    windows : tuple
        Series on parts of the range.
    looked_at : callable
        Told the number of matrices whenever some are interpolated, for a progress bar.
    """

    model: Model
    method: Method
    lowest_speed: float
    highest_speed: float
    motions: FrozenMotions
    windows: tuple[ChebyshevSeries, ...]
    looked_at: Callable[[int], object] = _unheard

    @classmethod
    def of(
        cls,
        model: Model,
        lowest_speed: float,
        highest_speed: float,
        method: Method | None = None,
        looked_at: Callable[[int], object] = _unheard,
    ) -> MultiplierCurve:
        """Interpolate the transition matrices of a model between two speeds [rad/s].

        The method is as :func:`facegear.floquet.methods.with_method` says, one for all speeds. `looked_at` is told
        the number of matrices whenever some have been computed or interpolated.

        Raises
        ------
        ArithmeticError
            If they do not vary smoothly with speed.
        """
        return with_method(
            method, lambda chosen: cls._interpolated(model, lowest_speed, highest_speed, chosen, looked_at)
        )

    @classmethod
    def _interpolated(
        cls,
        model: Model,
        lowest_speed: float,
        highest_speed: float,
        method: Method,
        looked_at: Callable[[int], object],
    ) -> MultiplierCurve:
        scale = Family([model.system(highest_speed)]).scale
        inverse = np.linalg.inv(scale)

        def matrices(slowness: FloatArray) -> FloatArray:
            found = np.empty((slowness.size, *scale.shape))
            for part in _neighbours(slowness):
                systems = [model.system(1.0 / x) for x in slowness[part].tolist()]
                found[part] = _matrices(systems, method)
                looked_at(len(systems))
            return np.asarray(scale @ found @ inverse, dtype=float)

        motions = FrozenMotions.of(model, 1.0 / highest_speed, 1.0 / lowest_speed)
        # No series resolves rounding, which is largest in the longest period.
        rounding = rounding_error(np.eye(len(scale)), Family([model.system(lowest_speed)]), method)
        tolerance = max(_TOLERANCE, 4.0 * rounding)
        windows = [
            window
            for low, high in motions.windows
            for window in _windows(matrices, motions, low, high, tolerance, _MOST_CUTS)
        ]
        return cls(model, method, lowest_speed, highest_speed, motions, tuple(windows), looked_at)

    @cached_property
    def error(self) -> float:
        """Largest distance of a multiplier from that of a more accurate method, at three speeds between the nodes."""
        low, high = 1.0 / self.highest_speed, 1.0 / self.lowest_speed
        speeds = (1.0 / (low + (high - low) * np.array([0.0371, 0.4713, 0.9329]))).tolist()
        systems = [self.model.system(v) for v in speeds]
        finer = _matrices(systems, self.method.refined())
        return max(
            _distance(self, system, fine, v) for system, fine, v in zip(systems, finer, speeds, strict=True)
        )

    @cached_property
    def live(self) -> MultiplierCurve:
        """Give the multipliers that do not vanish by smaller matrices, QᵀΦQ, where Q spans all columns of Φ.

        What has died within a period leaves no column in Φ, so that Φ = QQᵀΦ, and such matrices have the same
        eigenvalues but for zeros; where nothing dies in the shortest period, Q is square. Q is one for all speeds. What
        it leaves out is smaller than the error of the series at every speed, not at its nodes only, because no
        Chebyshev polynomial exceeds 1.
        """
        if self.motions.all_live:
            return self
        terms = np.concatenate([window.coefficients for window in self.windows])
        columns = np.moveaxis(terms, 0, 1).reshape(terms.shape[1], -1)
        basis, sizes, _ = np.linalg.svd(np.linalg.qr(columns.T).R.T)
        # Sums of norms are at most so many times the root of the sum of squares.
        left_out = np.sqrt(len(terms) * np.append(np.cumsum(sizes[::-1] ** 2)[::-1], 0.0))
        kept = basis[:, : int(np.argmax(left_out <= _TOLERANCE / 10.0))]
        windows = (
            ChebyshevSeries(window.low, window.high, np.asarray(kept.T @ window.values @ kept, dtype=float))
            for window in self.windows
        )
        return replace(self, windows=tuple(windows))

    def transition_matrices(self, speeds: FloatArray) -> FloatArray:
        """Scaled Φ at speeds (m,), shape (m, 2n, 2n)."""
        return self._by_window(speeds, ChebyshevSeries.__call__)

    def slopes(self, speeds: FloatArray) -> FloatArray:
        """Differentiate the scaled Φ by 1/speed at speeds (m,), shape (m, 2n, 2n)."""
        return self._by_window(speeds, ChebyshevSeries.derivative)

    def _by_window(
        self, speeds: FloatArray, evaluate: Callable[[ChebyshevSeries, FloatArray], FloatArray]
    ) -> FloatArray:
        slowness = 1.0 / np.asarray(speeds, dtype=float)
        self.looked_at(slowness.size)
        if len(self.windows) == 1:
            return evaluate(self.windows[0], slowness)
        found = np.empty((slowness.size, *self.windows[0].coefficients.shape[1:]))
        starts = np.array([window.low for window in self.windows])
        where = np.clip(np.searchsorted(starts, slowness, side="right") - 1, 0, None)
        for number in np.unique(where):
            inside = where == number
            found[inside] = evaluate(self.windows[number], slowness[inside])
        return found

    def spectral_radii(self, speeds: FloatArray) -> FloatArray:
        """max|λ| at speeds (m,)."""
        speeds = np.atleast_1d(speeds)
        parts = np.split(speeds, np.arange(self.batch, speeds.size, self.batch))
        return np.concatenate([spectral_radii(self.transition_matrices(part)) for part in parts])

    @property
    def batch(self) -> int:
        """Matrices worked on at once: what takes a second or so, for no interruption is heard meanwhile."""
        size = self.windows[0].coefficients.shape[-1]
        most = max(1, min(_MOST_AT_ONCE, _CUBES_AT_ONCE // size**3))
        return int(most - most % LANES if most > LANES else most)


def _matrices(systems: list[PeriodicSystem], method: Method) -> FloatArray:
    """Transition matrices of systems that form a family, or of each alone where breakpoints move with speed."""
    if all(np.array_equal(system.breakpoints, systems[0].breakpoints) for system in systems[1:]):
        return transition_matrices(systems, method)
    return np.concatenate([transition_matrices([system], method) for system in systems])


def _neighbours(slowness: FloatArray) -> list[NDArray[np.intp]]:
    """Numbers of values that lie close together, group by group."""
    order = np.argsort(slowness)
    steps = np.floor(np.log(slowness[order] / slowness[order[0]]) / np.log(_TOGETHER))
    return np.split(order, np.flatnonzero(np.diff(steps)) + 1)


def _windows(
    evaluate: Callable[[FloatArray], FloatArray],
    motions: FrozenMotions,
    low: float,
    high: float,
    tolerance: float,
    cuts: int,
) -> list[ChebyshevSeries]:
    """Series on one window, or on halves of it where its degree does not suffice."""
    degree = motions.degree(low, high)
    series = ChebyshevSeries.resolved(evaluate, low, high, degree, 2 * degree, tolerance)
    if series.tail <= tolerance:
        return [series]
    if cuts == 0:
        raise ArithmeticError(
            f"transition matrices do not vary smoothly with speed between {1.0 / high:.6g} and {1.0 / low:.6g} rad/s: "
            f"the last Chebyshev coefficient is {series.tail:.2g} of the largest entry"
        )
    middle = (low + high) / 2.0
    halves = ((low, middle), (middle, high))
    return [window for part in halves for window in _windows(evaluate, motions, *part, tolerance, cuts - 1)]


def _distance(curve: MultiplierCurve, system: PeriodicSystem, finer: FloatArray, speed: float) -> float:
    """Error of a multiplier of the curve, those inside 1/2 left out: distance to a refined method's, and rounding."""
    matrix = curve.transition_matrices(np.array([speed]))[0]
    coarse = np.linalg.eigvals(matrix)
    fine = np.linalg.eigvals(finer[np.newaxis])
    family = Family([system])
    rounding = rounding_error(matrix, family, curve.method)
    moved = np.linalg.eigvals(disturbed(matrix, family, curve.method))
    distance, shift = (
        np.abs(coarse[:, None] - others[:, None, :]).min(axis=2).max(axis=0) for others in (fine, moved)
    )
    errors = distance + np.maximum(shift, rounding)
    return float(errors[np.abs(coarse) > 0.5].max(initial=0.0))
