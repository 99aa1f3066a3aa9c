"""Whole columns of a map: spectral radii along one swept parameter at one speed.

The transition matrix is an entire function of stiffness and damping, and analytic in mass ≥ 0 and in every other
parameter a model depends on smoothly. It is therefore computed at Chebyshev points of the parameter only, and its
entries are interpolated, with more points until the last coefficients vanish. Some cells between these points are
computed as well, and tell whether to believe the others.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from facegear.floquet.contact_forces import mobilities
from facegear.floquet.eigenvalues import spectral_radii
from facegear.floquet.load_columns import LoadColumn
from facegear.floquet.methods import Method, PreparesLoads, with_method
from facegear.floquet.multipliers import transition_matrices
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.series import ChebyshevSeries
from facegear.floquet.stepping import Family
from facegear.support.parameters import finite_array
from facegear.support.types import FloatArray

#: Matrices (K, d, d) at values (K,) of a variable.
Evaluate = Callable[[FloatArray], FloatArray]

#: Size of the last Chebyshev coefficients of the interpolated matrices, relative to the largest entry or 1.
TOLERANCE = 1e-10
#: Degree of the first Chebyshev series that is tried, where nothing tells better.
LOWEST_DEGREE = 8
# Largest difference of an interpolated entry from that of the cell itself, in units of the tolerance of the series.
_WITNESSED = 10.0
# Factor between the largest entries of matrices that may share a series.
_MOST_APART = 1e3


def column_spectral_radii(
    system: PeriodicSystem,
    masses: ArrayLike,
    dampings: ArrayLike,
    stiffnesses: ArrayLike,
    method: Method | None = None,
) -> FloatArray:
    """Largest modulus of the Floquet multipliers for many values of the load parameters.

    Parameters
    ----------
    system : PeriodicSystem
        Its own load parameters are not used.
    masses, dampings, stiffnesses : array_like, shape (V,) or (V, loads) or ()
        Load parameters m [kg], c [N s/m], k [N/m] (or rotational units) along the column, not negative. One
        number for all loads or one a load; a single number holds for the whole column.
    method : Method, optional
        See :func:`facegear.floquet.methods.with_method` if left out.

    Returns
    -------
    array, shape (V,)
        max|λ| [-], error at most 1e-9 unless multipliers are about to coincide.

    Raises
    ------
    TypeError, ValueError
        Naming the parameter, if shapes do not match or values are negative or not finite.
    """
    swept = LoadSweep.of(system, _load_column(len(system.loads), masses, dampings, stiffnesses))
    scale = Family([system]).scale
    return with_method(
        method, lambda chosen: column_of(swept.matrices(system, chosen, scale), swept.variable, swept.smooth)
    )


def column_of(
    evaluate: Evaluate, variable: FloatArray, smooth: bool, degree: int = LOWEST_DEGREE
) -> FloatArray:
    """Spectral radii at values of the variable, shape (V,), interpolated if matrices are smooth in it."""
    if smooth:
        return interpolated_spectral_radii(evaluate, variable, degree=degree)
    return spectral_radii(evaluate(variable))


def family_spectral_radii(
    system_at: Callable[[float], PeriodicSystem], values: ArrayLike, method: Method | None = None
) -> FloatArray:
    """Largest modulus of the Floquet multipliers along any one parameter of a model.

    Parameters
    ----------
    system_at : callable
        ``system_at(value)`` returns the system; an analytic function of the value, with coordinates that keep
        their meaning and breakpoints that stay.
    values : array_like, shape (V,)
    method : Method, optional
        See :func:`facegear.floquet.methods.with_method` if left out.

    Returns
    -------
    array, shape (V,)
    """
    points = finite_array("values", values)
    if points.ndim != 1 or points.size == 0:
        raise ValueError(f"values must have shape (V,), V >= 1; got shape {points.shape}")

    def radii(chosen: Method) -> FloatArray:
        return interpolated_spectral_radii(family_matrices(system_at, chosen, scale), points)

    scale = Family([system_at(float(points[points.size // 2]))]).scale
    return with_method(method, radii)


def family_matrices(
    system_at: Callable[[float], PeriodicSystem], method: Method, scale: FloatArray
) -> Evaluate:
    """Transition matrices of the system at each value of a parameter, S Φ S⁻¹ with the given S."""
    inverse = np.linalg.inv(scale)

    def matrices(values: FloatArray) -> FloatArray:
        found = transition_matrices([system_at(value) for value in values.tolist()], method)
        return np.asarray(scale @ found @ inverse, dtype=float)

    return matrices


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
class LoadSweep:
    """Load parameters along a column, the same at all speeds, and the variable in which matrices are interpolated.

    Attributes
    ----------
    column : LoadColumn
    variable : array, shape (V,)
        See :class:`_StraightLine`; the number of the value where values do not lie on a line.
    line : _StraightLine, optional
    """

    column: LoadColumn
    variable: FloatArray
    line: _StraightLine | None

    @classmethod
    def of(cls, system: PeriodicSystem, column: LoadColumn) -> LoadSweep:
        """Find the variable for a system, whose own load parameters do not matter."""
        line = _StraightLine.through(column, float(mobilities([system]).max(initial=0.0)))
        return cls(column, np.arange(float(len(column))) if line is None else line.variable, line)

    @property
    def smooth(self) -> bool:
        """Whether matrices are smooth functions of the variable."""
        return self.line is not None

    def at(self, variable: FloatArray) -> LoadColumn:
        """Load parameters at values of the variable."""
        if self.line is not None:
            return self.line.column(variable)
        return LoadColumn.from_stacked(self.column.stacked()[variable.astype(int)])

    def matrices(self, system: PeriodicSystem, method: Method, scale: FloatArray) -> Evaluate:
        """Transition matrices of a system at values of the variable, S Φ S⁻¹ with the given S."""
        if isinstance(method, PreparesLoads):
            prepared = method.along_loads(system, self.column, scale)
            return lambda t: prepared(self.at(t))
        inverse = np.linalg.inv(scale)

        def matrices(t: FloatArray) -> FloatArray:
            part = self.at(t)
            systems = [
                system.replace_loads(mass=m, damping=c, stiffness=k)
                for m, c, k in zip(part.mass, part.damping, part.stiffness, strict=True)
            ]
            return np.asarray(scale @ transition_matrices(systems, method) @ inverse, dtype=float)

        return matrices


@dataclass(frozen=True, eq=False)
class _StraightLine:
    """Load parameters start + s (end − start), and the variable t in which matrices are interpolated.

    Without a mass along the line t = s. With one, t = 1/(1 + b m), b the mobility of the contact: the matrix then
    stays smooth however heavy the mass.
    """

    start: FloatArray
    end: FloatArray
    variable: FloatArray
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

    def column(self, t: FloatArray) -> LoadColumn:
        """Load parameters at values of the variable."""
        s = t
        if self.heaviest is not None:
            mass = (1.0 / t - 1.0) / self.mobility
            s = (mass - self.start[self.heaviest]) / (self.end - self.start)[self.heaviest]
        return LoadColumn.from_stacked(self.start + s[:, None] * (self.end - self.start))


def interpolated_spectral_radii(
    evaluate: Evaluate, points: FloatArray, tolerance: float = TOLERANCE, degree: int = LOWEST_DEGREE
) -> FloatArray:
    """Largest modulus of the eigenvalues of an analytic matrix function of one variable at many points.

    The matrices are evaluated at Chebyshev points of the variable and interpolated, and at some of the points
    themselves, far from those, to see whether that is right.

    Parameters
    ----------
    evaluate : callable
        (K,) values -> (K, d, d) matrices.
    points : array, shape (V,)
    tolerance : float
        Size of the last coefficients relative to the largest entry or 1, at which to stop.
    degree : int
        The first that is tried.

    Returns
    -------
    array, shape (V,)
        From matrices evaluated point by point, if interpolation takes as many evaluations or is found wrong.
    """
    series = resolved(evaluate, points, tolerance, degree)
    if series is not None:
        matrices = series(points)
        radii = spectral_radii(matrices)
        chosen = _witnesses(series, points, radii)
        if agree(matrices[chosen], evaluate(points[chosen]), tolerance):
            return radii
    return spectral_radii(evaluate(points))


def agree(interpolated: FloatArray, own: FloatArray, tolerance: float = TOLERANCE) -> bool:
    """Whether interpolated matrices are those of the cells themselves, to an error that the tolerance allows."""
    size = np.maximum(np.abs(own).max(axis=(-2, -1)), 1.0)
    apart = np.abs(interpolated - own).max(axis=(-2, -1))
    return bool((apart <= _WITNESSED * tolerance * size).all())


def of_one_size(matrices: FloatArray) -> bool:
    """Whether no matrix is far larger than another: the error of a series is small beside the largest of them alone."""
    size = np.abs(matrices).max(axis=(-2, -1))
    return bool(size.max() <= _MOST_APART * max(float(size.min()), 1.0))


def _witnesses(series: ChebyshevSeries, points: FloatArray, radii: FloatArray) -> NDArray[np.intp]:
    """Numbers of points that belie a series first: where the radius is largest, and furthest from where it was sampled.

    The latter twice, in the lower and in the upper half of the interval.
    """
    nodes = ChebyshevSeries.points_of(series.low, series.high, series.degree)
    distance = np.abs(points[:, None] - nodes).min(axis=1)
    lower = points < (series.low + series.high) / 2.0
    return np.unique([radii.argmax(), *(np.where(half, distance, 0.0).argmax() for half in (lower, ~lower))])


def resolved(evaluate: Evaluate, points: FloatArray, tolerance: float, degree: int) -> ChebyshevSeries | None:
    """Sample until the tail meets the tolerance; None if that takes too many evaluations, or says too little."""
    if not resolvable(points) or degree > points.size - 2:
        return None
    low, high = float(points.min()), float(points.max())
    series = ChebyshevSeries.sampled(evaluate, low, high, degree)
    # Matrices too different for a series at these points are so at the more of a higher degree.
    while of_one_size(series.values):
        if series.tail <= tolerance:
            return series
        if 2 * series.degree > points.size - 2:
            break
        series = series.refined(evaluate)
    return None


def resolvable(points: FloatArray) -> bool:
    """Whether a series is tried at all: there are more points than the shortest has."""
    return points.size > LOWEST_DEGREE + 1 and float(np.ptp(points)) > 0.0
