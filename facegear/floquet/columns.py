"""Whole columns of a map: spectral radii along one swept parameter at one speed.

The transition matrix is an entire function of stiffness and damping, and analytic in mass ≥ 0 and in every other
parameter a model depends on smoothly. It is therefore computed at Chebyshev points of the parameter only, and its
entries are interpolated, with more points until the last coefficients vanish. Where modes decay that much faster than
the others that their multipliers can never be the largest, only the block of the others is interpolated.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from facegear.floquet.collocation import FreeMotion, mobilities
from facegear.floquet.multipliers import Collocation, Method, transition_matrices, with_method
from facegear.floquet.periodic import LoadColumn, PeriodicSystem
from facegear.floquet.series import ChebyshevSeries, interleaved
from facegear.support.parameters import finite_array
from facegear.support.types import ComplexArray, FloatArray

#: Size of the last Chebyshev coefficients of the interpolated matrices, relative to the largest entry or 1.
TOLERANCE = 1e-10
# Degree of the first Chebyshev series that is tried.
_LOWEST_DEGREE = 8
# Eigenvalues are dropped where all of them are smaller than all that are kept by this factor at least.
_APART = 0.97
# Largest part of the eigenvalues that are kept: dropping fewer saves nothing.
_LARGEST_BLOCK = 0.75
# A block is followed at no more points than this part of those where it is wanted: eigenvectors cost time too.
_WORTHWHILE = 0.2
# Condition number of eigenvectors from which on what they span is not known well enough.
_DEPENDENT = 1e6


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
        See :func:`facegear.floquet.multipliers.with_method` if left out.

    Returns
    -------
    array, shape (V,)
        max|λ| [-], error at most 1e-9 unless multipliers are about to coincide.

    Raises
    ------
    TypeError, ValueError
        Naming the parameter, if shapes do not match or values are negative or not finite.
    """
    column = _load_column(len(system.loads), masses, dampings, stiffnesses)
    line = _StraightLine.through(column, float(mobilities([system]).max(initial=0.0)))

    def radii(chosen: Method) -> FloatArray:
        evaluate = _load_matrices(system, column, chosen)
        if line is None:
            return _spectral_radii(evaluate(column))
        return interpolated_spectral_radii(lambda t: evaluate(line.column(t)), line.variable)

    return with_method(method, radii)


def _load_matrices(
    system: PeriodicSystem, column: LoadColumn, method: Method
) -> Callable[[LoadColumn], FloatArray]:
    """Transition matrices of a system for any part of a column, in one set of coordinates."""
    if isinstance(method, Collocation):
        # What does not depend on the loads is prepared once.
        motion = FreeMotion(
            [system], column, method.nodes, method.panel_angle, fewest_held=method.fewest_held
        )
        return motion.transition_matrices

    def matrices(part: LoadColumn) -> FloatArray:
        systems = [
            system.replace_loads(mass=m, damping=c, stiffness=k)
            for m, c, k in zip(part.mass, part.damping, part.stiffness, strict=True)
        ]
        return transition_matrices(systems, method)

    return matrices


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
        See :func:`facegear.floquet.multipliers.with_method` if left out.

    Returns
    -------
    array, shape (V,)
    """
    points = finite_array("values", values)
    if points.ndim != 1 or points.size == 0:
        raise ValueError(f"values must have shape (V,), V >= 1; got shape {points.shape}")

    def radii(chosen: Method) -> FloatArray:
        return interpolated_spectral_radii(
            lambda part: transition_matrices([system_at(value) for value in part.tolist()], chosen), points
        )

    return with_method(method, radii)


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
    evaluate: Callable[[FloatArray], FloatArray], points: FloatArray, tolerance: float = TOLERANCE
) -> FloatArray:
    """Largest modulus of the eigenvalues of an analytic matrix function of one variable at many points.

    The matrices are evaluated at Chebyshev points of the variable and interpolated. Where some of their eigenvalues
    are smaller than all others throughout (modes that decay fast), the block of the larger ones is interpolated
    instead, which has the same largest eigenvalue and fewer others.

    Parameters
    ----------
    evaluate : callable
        (K,) values -> (K, d, d) matrices.
    points : array, shape (V,)
    tolerance : float
        Size of the last coefficients relative to the largest entry or 1, at which to stop.

    Returns
    -------
    array, shape (V,)
        From matrices evaluated point by point, if interpolation takes as many evaluations.
    """
    series = _resolved(evaluate, points, tolerance)
    if series is None:
        return _spectral_radii(evaluate(points))
    block = None
    # Where the matrix itself bends much, the subspace of its leading eigenvalues bends more than pays.
    if series.degree == _LOWEST_DEGREE:
        block = _leading_block(series, tolerance, int(_WORTHWHILE * points.size))
    return _spectral_radii((series if block is None else block)(points))


def _spectral_radii(matrices: FloatArray) -> FloatArray:
    return np.asarray(np.abs(np.linalg.eigvals(matrices)).max(axis=-1), dtype=float)


def _resolved(
    evaluate: Callable[[FloatArray], FloatArray], points: FloatArray, tolerance: float
) -> ChebyshevSeries | None:
    """Sample until the tail meets the tolerance, or None if that takes as many evaluations as points."""
    low, high = float(points.min()), float(points.max())
    if points.size <= _LOWEST_DEGREE + 1 or low == high:
        return None
    series = ChebyshevSeries.resolved(evaluate, low, high, _LOWEST_DEGREE, points.size - 2, tolerance)
    return series if series.tail <= tolerance else None


def _tail_at(series: ChebyshevSeries, degree: int) -> float:
    """Tail of a series of higher degree, if coefficients go on to fall as they do in the upper half of this one."""
    sizes = np.abs(series.coefficients).max(axis=(1, 2))
    middle = series.degree // 2
    fall = float(sizes[-2:].max() / sizes[middle - 1 : middle + 1].max())
    exponent: float = (degree - series.degree) / (series.degree - middle)
    return float(series.tail * fall**exponent)


def _leading_block(series: ChebyshevSeries, tolerance: float, most: int) -> ChebyshevSeries | None:
    """Blocks with the eigenvalues of largest modulus, r of them, as a series of (r, r) matrices.

    In fixed coordinates (y, z) the invariant subspace of the r largest eigenvalues is z = X y, and the matrix acts on
    it as Φ_yy + Φ_yz X, which is smooth along the parameter while these eigenvalues stay apart from the others. None
    if they do not, are nearly all, or would take a degree above `most` to follow.
    """
    moduli, vectors = _ordered_eigenvectors(series.values)
    while True:
        count = _count_apart(moduli)
        blocks = None if count is None else _blocks(series.values, vectors[:, :, :count])
        if blocks is None:
            return None
        block = replace(series, values=blocks)
        if block.tail <= tolerance:
            return block
        if 2 * block.degree > most or _tail_at(block, most) > tolerance:
            return None
        between = series(series.between)
        more_moduli, more_vectors = _ordered_eigenvectors(between)
        moduli = interleaved(moduli, more_moduli)
        vectors = interleaved(vectors.view(float), more_vectors.view(float)).view(complex)
        series = replace(series, values=interleaved(series.values, between))


def _ordered_eigenvectors(matrices: FloatArray) -> tuple[FloatArray, ComplexArray]:
    """Moduli of eigenvalues, (K, d), descending, and their vectors, (K, d, d)."""
    eigenvalues, vectors = np.linalg.eig(matrices)
    order = np.argsort(-np.abs(eigenvalues), axis=-1, kind="stable")
    moduli = np.take_along_axis(np.abs(eigenvalues), order, axis=-1)
    return moduli, np.take_along_axis(vectors, order[:, None, :], axis=-1).astype(complex)


def _count_apart(moduli: FloatArray) -> int | None:
    """How many eigenvalues are larger than the others by the largest factor, from moduli (K, d), descending."""
    counts = np.arange(1, int(_LARGEST_BLOCK * moduli.shape[1]) + 1)
    if counts.size == 0:
        return None
    larger, smaller = moduli[:, counts - 1], moduli[:, counts]
    ratios = np.divide(smaller, larger, out=np.ones_like(smaller), where=larger > 0.0).max(axis=0)
    return int(counts[ratios.argmin()]) if ratios.min() <= _APART else None


def _blocks(matrices: FloatArray, vectors: ComplexArray) -> FloatArray | None:
    """Blocks of matrices (K, d, d) on the spans of their vectors (K, d, r), or None if these are close to dependent."""
    count = vectors.shape[-1]
    # Orthonormal coordinates, the first r of which span the subspace of the middle matrix: vectors of a conjugate
    # pair span the same as their real and imaginary parts.
    middle = vectors[matrices.shape[0] // 2]
    basis = np.linalg.svd(np.concatenate([middle.real, middle.imag], axis=1))[0]
    turned = basis.T @ vectors
    if np.linalg.cond(turned[:, :count]).max() > _DEPENDENT:
        return None
    graph = (turned[:, count:] @ np.linalg.inv(turned[:, :count])).real
    first = basis[:, :count].T @ matrices
    return np.asarray(first @ (basis[:, :count] + basis[:, count:] @ graph), dtype=float)
