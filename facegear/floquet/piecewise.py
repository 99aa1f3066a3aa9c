"""Piecewise smooth periodic functions: Chebyshev series between breakpoints.

The position of a mesh contact is smooth except where a tooth pair enters or leaves mesh and where the end of
a contact line changes its bounding curve. Here such functions are held exactly: time is measured by the
fraction x = t / T0 of the period, and each smooth piece has its own Chebyshev series.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property, lru_cache
from inspect import signature
from itertools import pairwise
from typing import Literal

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import ArrayLike, NDArray
from scipy.fft import dct

from facegear.support.parameters import finite, finite_array, integer_at_least, integer_within, keep, one_of
from facegear.support.types import FloatArray

Side = Literal["left", "right"]

#: Two breakpoints closer than this fraction of the period are one.
SAME_INSTANT = 1e-12
# Points of the first series tried, of degree one less.
_FEWEST = 9
# Evenly spaced places in [-1, 1], none a Chebyshev point, at which a series must meet its function in the end.
_CHECKED = np.arange(-31.0, 32.0, 2.0) / 32.0
# Places from which on a recurrence over degrees is quicker than a cosine for each.
_MANY = 50
# Values at no more fractions than this are remembered for a while.
_REMEMBERED = 1024
# By so much it may miss it there, in units of the size that its last coefficients may have.
_LEEWAY = 100.0


def _coefficients(values: FloatArray) -> FloatArray:
    """Chebyshev coefficients of the interpolant through values at `chebpts1`, ascending, shape (count, ...)."""
    coefficients = np.asarray(dct(values[::-1], axis=0) / values.shape[0], dtype=float)
    coefficients[0] /= 2.0
    return coefficients


def _chebyshev_basis(x: FloatArray, degree: int) -> FloatArray:
    """T_0 ... T_degree at x in [-1, 1], shape (len(x), degree + 1)."""
    return np.cos(np.arange(degree + 1) * np.arccos(np.clip(x, -1.0, 1.0))[:, None])


def _ascending_basis(x: FloatArray, degree: int) -> FloatArray:
    """T_0 ... T_degree at x in [-1, 1], shape (degree + 1, len(x)); at many by the recurrence, which is quicker."""
    if x.size < _MANY and degree > 1:
        return _chebyshev_basis(x, degree).T
    x = np.clip(x, -1.0, 1.0)
    basis = np.ones((degree + 1, x.size))
    if degree > 0:
        basis[1] = x
    twice = 2.0 * x
    for number in range(2, degree + 1):
        np.multiply(twice, basis[number - 1], out=basis[number])
        basis[number] -= basis[number - 2]
    return basis


def wrap(fraction: FloatArray) -> FloatArray:
    """Fraction of the period in [0, 1); values within rounding of 1 become 0."""
    wrapped = np.mod(fraction, 1.0)
    return np.where(wrapped > 1.0 - SAME_INSTANT, 0.0, wrapped)


@dataclass(frozen=True, eq=False)
class PiecewiseChebyshev:
    """Periodic vector function of the fraction of the period, a Chebyshev series on each smooth piece.

    Piece p runs from ``breakpoints[p]`` to ``breakpoints[p + 1]``, the last one across the end of the
    period to ``breakpoints[0] + 1``.

    Parameters
    ----------
    breakpoints : array, shape (pieces,)
        Ascending, inside [0, 1).
    coefficients : array, shape (pieces, degree + 1, components)
        Chebyshev coefficients on each piece, mapped to [-1, 1].

    Raises
    ------
    ValueError
        If breakpoints are not ascending inside [0, 1), or the shapes do not match, or an entry is not finite.

    Examples
    --------
    >>> import numpy as np
    >>> import facegear as fg
    >>> sine = fg.PiecewiseChebyshev.fit(lambda s, piece: np.sin(2.0 * np.pi * s)[:, None], [0.0])
    >>> round(float(sine(0.25)[0]), 12)
    1.0
    """

    breakpoints: FloatArray
    coefficients: FloatArray

    def __post_init__(self) -> None:
        breakpoints = real_array(self.breakpoints, "breakpoints", 1)
        coefficients = real_array(self.coefficients, "coefficients", 3)
        _check_breakpoints(breakpoints)
        if coefficients.shape[0] != breakpoints.size or 0 in coefficients.shape:
            raise ValueError(
                f"coefficients must have shape ({breakpoints.size}, degree + 1, components), one series "
                f"for each of the {breakpoints.size} breakpoints; got shape {coefficients.shape}"
            )
        keep(self, breakpoints=breakpoints, coefficients=coefficients)

    @classmethod
    def fit(
        cls,
        function: Callable[[FloatArray, int], ArrayLike],
        breakpoints: ArrayLike,
        *,
        tolerance: ArrayLike = 1e-13,
        max_degree: int = 256,
    ) -> PiecewiseChebyshev:
        """Fit a function that is smooth between breakpoints, raising the degree until the tail is negligible.

        Parameters
        ----------
        function : callable
            ``function(fraction, piece)`` with `fraction` of shape (m,) strictly inside piece number `piece`
            returns shape (m,) or (m, components). On the last piece fractions run past 1, up to
            ``breakpoints[0] + 1``.
        breakpoints : array_like, shape (pieces,)
            Ascending fractions inside [0, 1). A function smooth over the whole period takes ``[0.0]``.
        tolerance : float or array_like, shape (pieces,)
            Size of the last coefficients relative to the largest value of the function [-], greater than 0.
        max_degree : int
            Highest degree tried, 8 or more.

        Raises
        ------
        TypeError, ValueError
            Naming the argument. If the tail stays above the tolerance, or the series away from the function by more
            than a hundred times that at one of 32 evenly spaced fractions of the piece: the function has a jump or a
            kink inside a piece. What is narrower than a 32nd of its piece may lie between all points and be missed.
        """
        _require_two_arguments(function)

        def rows(fractions: FloatArray, pieces: NDArray[np.intp]) -> FloatArray:
            found = [
                _values(function(own, piece), own.shape, f"piece {piece}")
                for own, piece in zip(fractions, pieces.tolist(), strict=True)
            ]
            components = {values.shape[1] for values in found}
            if len(components) > 1:
                raise ValueError(
                    f"function must return as many components on each piece; got {sorted(components)} components"
                )
            return np.stack(found)

        return cls.fit_together(rows, breakpoints, tolerance=tolerance, max_degree=max_degree)

    @classmethod
    def fit_together(
        cls,
        function: Callable[[FloatArray, NDArray[np.intp]], ArrayLike],
        breakpoints: ArrayLike,
        *,
        tolerance: ArrayLike = 1e-13,
        max_degree: int = 256,
    ) -> PiecewiseChebyshev:
        """Fit as :meth:`fit` does, a function that is asked for several pieces at once, as takes less time with arrays.

        Parameters
        ----------
        function : callable
            ``function(fractions, pieces)`` with `fractions` of shape (k, m), row i strictly inside piece `pieces[i]`,
            returns shape (k, m) or (k, m, components).
        breakpoints, tolerance, max_degree
            As there.

        Raises
        ------
        TypeError, ValueError
            As there.

        Examples
        --------
        >>> saw = PiecewiseChebyshev.fit_together(lambda x, pieces: x - 0.5 * pieces[:, None], [0.0, 0.5])
        >>> round(float(saw(0.75)[0]), 12)
        0.25
        """
        edges = real_array(breakpoints, "breakpoints", 1)
        _check_breakpoints(edges)
        allowed = _tolerances(tolerance, edges.size)
        max_degree = integer_at_least("max_degree", max_degree, 8)
        ends = np.append(edges[1:], edges[0] + 1.0)
        middle, half = (ends + edges)[:, np.newaxis] / 2.0, (ends - edges)[:, np.newaxis] / 2.0

        def sample(pieces: NDArray[np.intp], local: FloatArray) -> FloatArray:
            fractions = middle[pieces] + half[pieces] * local
            return _values(function(fractions, pieces), fractions.shape, "these pieces")

        # Chebyshev points to begin with, and others, which have to meet the series in the end.
        waiting = np.arange(edges.size)
        first = sample(waiting, np.concatenate([chebyshev.chebpts1(_FEWEST), _CHECKED]))
        values, expected = np.split(first, [_FEWEST], axis=1)
        scale = float(np.abs(first).max())
        series: dict[int, FloatArray] = {}
        while True:
            count = values.shape[1]
            found = [_coefficients(own) for own in values]
            scale = max([scale, *(float(np.abs(coefficients).max()) for coefficients in found)])
            basis = _chebyshev_basis(_CHECKED, count - 1)
            for piece, coefficients in zip(waiting.tolist(), found, strict=True):
                sizes = np.abs(coefficients).max(axis=1)
                # Three coefficients, because an even or odd function has every second one zero.
                tail, limit = float(sizes[-3:].max()), allowed[piece] * scale
                away = float(np.abs(basis @ coefficients - expected[piece]).max())
                if tail <= limit and away <= _LEEWAY * limit:
                    series[piece] = coefficients[
                        : int(np.flatnonzero(sizes > limit / 10.0).max(initial=0)) + 1
                    ]
                elif 2 * count - 2 > max_degree:
                    what = (
                        f"the last Chebyshev coefficients are {tail / scale:.2g} of the largest value, above"
                    )
                    if tail <= limit:
                        what = f"the series is off by {away / scale:.2g} of the largest value, above a hundred times"
                    raise ValueError(
                        f"function is not smooth on piece {piece} ({edges[piece]:.6g} to {ends[piece]:.6g} "
                        f"of the period): at degree {count - 1} {what} {allowed[piece]:.2g}; "
                        "add the breakpoint of the jump or kink inside it"
                    )
            waiting = np.array([piece for piece in waiting.tolist() if piece not in series], dtype=np.intp)
            if not waiting.size:
                break
            values = sample(waiting, chebyshev.chebpts1(2 * count - 1))
        length = max(part.shape[0] for part in series.values())
        padded = [np.pad(series[p], ((0, length - len(series[p])), (0, 0))) for p in range(edges.size)]
        return cls(edges, np.stack(padded))

    @classmethod
    def constant(cls, values: ArrayLike) -> PiecewiseChebyshev:
        """Constant vector `values`, shape (components,)."""
        array = np.atleast_1d(finite_array("values", values))
        if array.ndim != 1 or array.size == 0:
            raise ValueError(f"values must be one number a component; got shape {array.shape}")
        return cls(np.zeros(1), array[None, None, :])

    @property
    def components(self) -> int:
        """Number of components of the vector."""
        return int(self.coefficients.shape[2])

    @property
    def degree(self) -> int:
        """Degree of the Chebyshev series."""
        return int(self.coefficients.shape[1]) - 1

    @cached_property
    def lengths(self) -> FloatArray:
        """Lengths of the pieces as fractions of the period, shape (pieces,)."""
        return np.diff(np.append(self.breakpoints, self.breakpoints[0] + 1.0))

    @cached_property
    def largest(self) -> float:
        """A bound on the largest absolute value of any component."""
        return float(np.abs(self.coefficients).sum(axis=1).max())

    def __call__(self, fraction: ArrayLike, side: Side = "right") -> FloatArray:
        """Value at fractions of the period.

        Parameters
        ----------
        fraction : array_like, shape (...)
            Any real numbers; the function is periodic [-].
        side : {"right", "left"}
            Which limit to take at a breakpoint.

        Returns
        -------
        array, shape (..., components)
        """
        one_of("side", side, ("right", "left"))
        one: object = fraction
        if isinstance(one, float) and math.isfinite(one):
            return self._at(float(one), side)
        asked = finite_array("fraction", fraction)
        if asked.size > _REMEMBERED:
            return self._along(asked, side)
        return _evaluated(self, asked.tobytes(), side).reshape(*asked.shape, self.components).copy()

    def _along(self, asked: FloatArray, side: Side) -> FloatArray:
        """Values at many fractions."""
        flat = asked.ravel()
        within = flat.size > 0 and flat.min() >= 0.0 and flat.max() <= 1.0 - SAME_INSTANT
        wrapped = flat if within else wrap(flat)
        nudge = SAME_INSTANT if side == "right" else -SAME_INSTANT
        # Before the first breakpoint one is still on the last piece of the period before, number -1.
        piece = np.searchsorted(self.breakpoints, wrapped + nudge, side="right") - 1
        changes = np.flatnonzero(piece[1:] != piece[:-1]) + 1
        if changes.size > 2 * self.breakpoints.size:  # in no order
            order = np.argsort(piece, kind="stable")
            values = np.empty((wrapped.size, self.components))
            values[order] = self._along(wrapped[order], side)
            return values.reshape(*asked.shape, self.components)
        offset = wrapped - self.breakpoints[piece] + (piece < 0)
        basis = _ascending_basis(2.0 * offset / self.lengths[piece] - 1.0, self.degree)
        values = np.empty((wrapped.size, self.components))
        for begin, end in pairwise([0, *changes.tolist(), wrapped.size]):
            if end > begin:
                values[begin:end] = basis[:, begin:end].T @ self.coefficients[piece[begin]]
        return values.reshape(*asked.shape, self.components)

    def _at(self, fraction: float, side: Side) -> FloatArray:
        """Value at one fraction: in plain numbers, for integrators ask thousands of times."""
        starts, lengths, degrees = self._plain
        x = fraction % 1.0
        if x > 1.0 - SAME_INSTANT:
            x = 0.0
        piece = bisect_right(starts, x + (SAME_INSTANT if side == "right" else -SAME_INSTANT)) - 1
        offset = x - starts[piece] + (piece < 0)
        angle = math.acos(min(1.0, max(-1.0, 2.0 * offset / lengths[piece] - 1.0)))
        return np.asarray(np.cos(angle * degrees) @ self.coefficients[piece], dtype=float)

    @cached_property
    def _plain(self) -> tuple[list[float], list[float], FloatArray]:
        """Breakpoints, lengths of the pieces, and 0 ... degree."""
        return self.breakpoints.tolist(), self.lengths.tolist(), np.arange(self.degree + 1.0)

    def derivative(self, order: int = 1) -> PiecewiseChebyshev:
        """Exact derivative with respect to the fraction of the period, piece by piece (jumps left out)."""
        function = self
        for _ in range(integer_at_least("order", order, 0)):
            function = function._slope
        return function

    @cached_property
    def _slope(self) -> PiecewiseChebyshev:
        if self.degree == 0:
            return PiecewiseChebyshev(self.breakpoints, np.zeros_like(self.coefficients))
        coefficients = chebyshev.chebder(self.coefficients, axis=1) * (2.0 / self.lengths)[:, None, None]
        return PiecewiseChebyshev(self.breakpoints, coefficients)

    def shift(self, phase: float) -> PiecewiseChebyshev:
        """Return x ↦ f(x + phase), Eq. (5-2): ahead by `phase` of a period."""
        phase = finite("phase", phase)
        if phase == 0.0:
            return self
        moved = wrap(self.breakpoints - phase)
        order = np.argsort(moved)
        return PiecewiseChebyshev(moved[order], self.coefficients[order])

    def backwards(self) -> PiecewiseChebyshev:
        """Return x ↦ f(−x): the function run through in the opposite sense."""
        ends = np.append(self.breakpoints[1:], self.breakpoints[0] + 1.0)
        starts = wrap(-ends)
        order = np.argsort(starts)
        signs = (-1.0) ** np.arange(self.degree + 1)
        return PiecewiseChebyshev(starts[order], self.coefficients[order] * signs[:, None])

    def repeated(self, periods: int) -> PiecewiseChebyshev:
        """Return x ↦ f(p x): several periods p taken for one."""
        periods = integer_at_least("periods", periods, 1)
        starts = (self.breakpoints + np.arange(periods)[:, None]) / periods
        return PiecewiseChebyshev(starts.ravel(), np.tile(self.coefficients, (periods, 1, 1)))

    def transformed(self, matrix: ArrayLike) -> PiecewiseChebyshev:
        """Return x ↦ A f(x) for a constant matrix A, shape (new components, components)."""
        factor = real_array(matrix, "matrix", 2)
        if factor.shape[1] != self.components:
            raise ValueError(
                f"matrix must have {self.components} columns, one a component; got shape {factor.shape}"
            )
        return PiecewiseChebyshev(self.breakpoints, self.coefficients @ factor.T)

    def embedded(self, components: int, first: int = 0) -> PiecewiseChebyshev:
        """Return the function as components `first`, `first` + 1, ... of a longer vector of zeros otherwise."""
        components = integer_at_least("components", components, self.components)
        first = integer_within("first", first, 0, components - self.components)
        return self.transformed(np.eye(components)[:, first : first + self.components])

    def jumps(self) -> FloatArray:
        """Right minus left limit at each breakpoint, shape (pieces, components)."""
        signs = (-1.0) ** np.arange(self.degree + 1)
        right: FloatArray = np.einsum("d,pdn->pn", signs, self.coefficients)
        left: FloatArray = np.roll(self.coefficients.sum(axis=1), 1, axis=0)
        return right - left


@lru_cache(maxsize=128)
def _evaluated(function: PiecewiseChebyshev, fractions: bytes, side: Side) -> FloatArray:
    """Values at fractions: the systems of a family, and those of one tongue, are asked for at the same ones."""
    return function._along(np.frombuffer(fractions), side)


def merge_breakpoints(parts: Sequence[FloatArray]) -> FloatArray:
    """Union of sets of breakpoints in [0, 1), ascending; those within rounding of one another are one."""
    points = np.sort(np.concatenate([wrap(np.asarray(part, dtype=float)) for part in parts]))
    return points[np.diff(points, prepend=-1.0) > SAME_INSTANT]


def same_function(one: PiecewiseChebyshev | None, other: PiecewiseChebyshev | None) -> bool:
    """Whether two functions, or none of them, are the same to the last digit."""
    if one is None or other is None or one is other:
        return one is other
    return np.array_equal(one.breakpoints, other.breakpoints) and np.array_equal(
        one.coefficients, other.coefficients
    )


def _check_breakpoints(breakpoints: FloatArray) -> None:
    if breakpoints.size == 0 or breakpoints[0] < 0.0 or breakpoints[-1] >= 1.0:
        raise ValueError(f"breakpoints must lie inside [0, 1), at least one; got {breakpoints.tolist()}")
    if (np.diff(breakpoints) <= SAME_INSTANT).any():
        raise ValueError(f"breakpoints must ascend and differ; got {breakpoints.tolist()}")


def _require_two_arguments(function: object) -> None:
    """Refuse what cannot be called with fractions and the number of a piece."""
    fits = callable(function)
    # Some functions written in C do not say what they take.
    with suppress(ValueError, TypeError):
        parameters = signature(function)  # type: ignore[arg-type]
        try:
            parameters.bind(None, 0)
        except TypeError:
            fits = False
    if not fits:
        raise TypeError(
            f"function must take two arguments, fractions and number of the piece; got {function!r}"
        )


def _values(returned: ArrayLike, asked: tuple[int, ...], where: str) -> FloatArray:
    """Check what a function returned for fractions of a shape (..., m), and give it an axis of components."""
    values = np.asarray(returned)
    if values.dtype.kind not in "iuf":
        raise TypeError(f"function must return real numbers, got an array of {values.dtype} on {where}")
    values = np.asarray(values[..., None] if values.ndim == len(asked) else values, dtype=float)
    if values.shape[:-1] != asked:
        size = str(asked)[1:-1].rstrip(",")
        raise ValueError(
            f"function must return shape ({size},) or ({size}, components) for {asked[-1]} fractions; got shape "
            f"{np.shape(returned)} on {where}"
        )
    if not np.isfinite(values).all():
        raise ValueError(f"function must be finite on {where}; got a non-finite value")
    return values


def _tolerances(tolerance: ArrayLike, pieces: int) -> FloatArray:
    """Return one tolerance a piece."""
    array = finite_array("tolerance", tolerance)
    if array.shape not in ((), (1,), (pieces,)):
        raise ValueError(f"tolerance must be one number or {pieces}, one a piece; got shape {array.shape}")
    if not (array > 0.0).all():
        raise ValueError(f"tolerance must be greater than 0; got {float(array.min())!r}")
    return np.broadcast_to(array, (pieces,))


def real_array(values: ArrayLike, name: str, dimensions: int) -> FloatArray:
    """Return a read-only float copy, checked for its number of dimensions and for finite entries."""
    array = finite_array(name, values)
    if array.ndim != dimensions:
        raise ValueError(f"{name} must have {dimensions} dimensions; got shape {array.shape}")
    array.setflags(write=False)
    return array
