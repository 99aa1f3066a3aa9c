"""Eigenvalues of many small real matrices: most of the work of a map.

LAPACK takes one matrix at a time and keeps a vector unit waiting; where Numba is installed (the extra ``speed``),
:mod:`facegear.floquet.lockstep` takes many at once. What it finds is checked by the traces of each matrix and of its
square, and LAPACK is asked again where they differ.
"""

from __future__ import annotations

from types import ModuleType

import numpy as np
from numpy.typing import NDArray

from facegear.floquet.compiled import where_compiled
from facegear.support.types import ComplexArray, FloatArray

# Fewer matrices than this are not worth another library.
_FEWEST = 8
# Largest difference of the sum of all eigenvalues, or of their squares, from the trace, relative to the norm.
_TRACE_CHECK = 1e-12
# Squares of entries beyond these bounds leave the range of numbers.
_SMALLEST, _LARGEST = 1e-100, 1e100


def eigenvalues(matrices: FloatArray) -> ComplexArray:
    """Eigenvalues of each of many matrices.

    Parameters
    ----------
    matrices : array, shape (V, d, d)

    Returns
    -------
    array of complex, shape (V, d)
        In no particular order; those of a matrix that differs by a few units in the last place of its norm.

    Raises
    ------
    ArithmeticError
        If an entry is not finite.

    Examples
    --------
    >>> eigenvalues(np.array([[[0.0, 2.0], [2.0, 0.0]]])).real.tolist()
    [[2.0, -2.0]]
    """
    sizes = np.abs(matrices).max(axis=(1, 2), initial=0.0)
    if not np.isfinite(sizes).all():
        raise ArithmeticError("transition matrix is not finite: the motion grows beyond double precision")
    lockstep = _lockstep() if len(matrices) >= _FEWEST else None
    if lockstep is None:
        return _by_lapack(matrices)
    matrices = np.ascontiguousarray(matrices, dtype=float)
    parts, converged = np.empty((2, *matrices.shape[:2])), np.empty(len(matrices), dtype=bool)
    lockstep.eigenvalues(matrices, *parts, converged)
    values = np.asarray(parts[0] + 1j * parts[1], dtype=complex)
    # Not "wrong where": what is not a number compares as neither.
    within = converged & (sizes > _SMALLEST) & (sizes < _LARGEST)
    right = np.zeros_like(within)
    right[within] = _has_traces(matrices[within], values[within])
    if not right.all():
        values[~right] = _by_lapack(matrices[~right])
    return values


def spectral_radii(matrices: FloatArray) -> FloatArray:
    """Largest modulus of the eigenvalues of each of many matrices.

    Parameters
    ----------
    matrices : array, shape (V, d, d)

    Returns
    -------
    array, shape (V,)

    Raises
    ------
    ArithmeticError
        If an entry is not finite.
    """
    return np.asarray(np.abs(eigenvalues(matrices)).max(axis=-1), dtype=float)


@where_compiled
def _lockstep() -> ModuleType:
    from facegear.floquet import lockstep

    return lockstep


def _by_lapack(matrices: FloatArray) -> ComplexArray:
    return np.asarray(np.linalg.eigvals(matrices), dtype=complex)


def _has_traces(matrices: FloatArray, values: ComplexArray) -> NDArray[np.bool_]:
    """Whether eigenvalues (V, d) have the sum that matrices (V, d, d) have on their diagonals, their squares too."""
    norm = np.sqrt(np.einsum("vij,vij->v", matrices, matrices))
    first = np.abs(values.sum(axis=1) - np.einsum("vii->v", matrices))
    second = np.abs((values**2).sum(axis=1) - np.einsum("vij,vji->v", matrices, matrices))
    bound = _TRACE_CHECK * np.maximum(norm, _SMALLEST)
    return np.asarray((first <= bound) & (second <= bound * norm), dtype=bool)
