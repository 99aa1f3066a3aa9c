"""Change of many small real matrices in their own eigenvectors: what perturbation theory asks for.

LAPACK takes one matrix at a time; where Numba is installed (the extra ``speed``),
:mod:`facegear.floquet.lockstep_vectors` takes many at once, a vector only of each eigenvalue that is asked for. What it
finds is checked by what is left of (A − λ) x and by the products of vectors of different eigenvalues, and LAPACK is
asked again where they are not nothing: eigenvalues that coincide have no vectors of their own.
"""

from __future__ import annotations

from types import ModuleType
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from facegear.floquet.compiled import where_compiled
from facegear.floquet.eigenvalues import eigenvalues
from facegear.support.types import ComplexArray, FloatArray

# Fewer matrices than this are not worth a batch.
_FEWEST = 8
# Largest part of (A − λ) x, relative to the norm of A, and largest product of vectors that belong to different values.
_LEFT_OVER, _OBLIQUE = 1e-12, 1e-8

T = TypeVar("T", bound=np.generic)


class Critical(NamedTuple):
    """Largest eigenvalue of each matrix, of a conjugate pair the one above the real axis, and its vectors.

    Attributes
    ----------
    values : ndarray of complex, shape (V,)
    right, left : ndarray of complex, shape (V, d)
        v and w with w v = 1.
    """

    values: ComplexArray
    right: ComplexArray
    left: ComplexArray


class Change(NamedTuple):
    """Change S of matrices A in their eigenvectors, left wᵢ and right vⱼ with wᵢ vᵢ = 1, m of them.

    Of a conjugate pair only the one with the positive imaginary part is among them.

    Attributes
    ----------
    values : ndarray of complex, shape (V, m)
        Eigenvalues, zero where a matrix has fewer than others.
    direct, crossed : ndarray of complex, shape (V, m, m)
        wᵢ S vⱼ, and wᵢ S v̄ⱼ, v̄ⱼ being the right vector of the other one of a pair.
    largest : ndarray of int, shape (V,)
        Which of the m eigenvalues is the largest.
    critical : Critical
        That, and its vectors.
    """

    values: ComplexArray
    direct: ComplexArray
    crossed: ComplexArray
    largest: NDArray[np.intp]
    critical: Critical


def change(matrices: FloatArray, slopes: FloatArray, least: float = 0.0) -> Change:
    """Look at the change of each of many matrices in its eigenvectors.

    Parameters
    ----------
    matrices, slopes : array, shape (V, d, d)
        A and S.
    least : float
        Eigenvalues whose product with the largest one of their matrix is not larger than this are left out, all but
        that one.

    Returns
    -------
    Change

    Raises
    ------
    ArithmeticError
        If an entry of A is not finite.

    Examples
    --------
    >>> turning = np.array([[[0.0, 1.0], [-1.0, 0.0]]])
    >>> found = change(turning, 3.0 * turning)
    >>> found.values.tolist(), found.direct.round(9).tolist()
    ([[1j]], [[[3j]]])
    """
    values, right, left = _vectors(matrices, least)
    # (Re w, Im w) S (Re v, Im v) in real numbers: four products a pair of vectors.
    parts = _products((_rows(left) @ slopes).reshape(left.shape), right)
    direct, crossed = _combined(parts)
    largest = np.abs(values).argmax(axis=1)
    return Change(values, direct, crossed, largest, _critical(values, right, left, largest))


def critical(matrices: FloatArray) -> Critical:
    """Find the largest eigenvalue of each of many matrices, and its eigenvectors.

    Parameters
    ----------
    matrices : array, shape (V, d, d)

    Returns
    -------
    Critical

    Raises
    ------
    ArithmeticError
        If an entry is not finite.

    Examples
    --------
    >>> found = critical(np.array([[[0.0, 2.0], [-2.0, 0.0]], [[1.0, 0.0], [0.0, -3.0]]]))
    >>> found.values.round(9).tolist(), (found.left * found.right).sum(axis=1).real.round(9).tolist()
    ([2j, (-3+0j)], [1.0, 1.0])
    """
    values, right, left = _vectors(matrices, np.inf)
    return _critical(values, right, left, np.zeros(len(values), dtype=np.intp))


def _critical(values: ComplexArray, right: FloatArray, left: FloatArray, which: NDArray[np.intp]) -> Critical:
    """Pick one of the eigenvalues of each matrix, and its vectors."""
    own = np.arange(len(values))
    vectors = (part[own, 0, which] + 1j * part[own, 1, which] for part in (right, left))
    return Critical(values[own, which], *vectors)


def _vectors(matrices: FloatArray, least: float) -> tuple[ComplexArray, FloatArray, FloatArray]:
    """Values (V, m), right and left vectors, their real and imaginary parts (V, 2, m, d)."""
    if not np.isfinite(matrices).all():
        raise ArithmeticError("transition matrix is not finite: the motion grows beyond double precision")
    lockstep = _lockstep() if len(matrices) >= _FEWEST else None
    if lockstep is None:
        return _by_lapack(matrices, least)
    matrices = np.ascontiguousarray(matrices, dtype=float)
    values = _upper(eigenvalues(matrices), least)[0]
    shape = (values.shape[0], 2, values.shape[1], matrices.shape[1])
    right, left, growth = np.empty(shape), np.empty(shape), np.empty(values.shape)
    lockstep.eigenvectors(
        matrices, np.ascontiguousarray(values.real), np.ascontiguousarray(values.imag), right, left, growth
    )
    norm = np.sqrt(np.einsum("vij,vij->v", matrices, matrices))
    wrong = ~_scaled(values, right, left, growth * norm[:, np.newaxis])
    if wrong.any():
        again = _by_lapack(matrices[wrong], least)
        most = max(values.shape[1], again[0].shape[1])
        values, right, left = _padded(values, 1, most), _padded(right, 2, most), _padded(left, 2, most)
        values[wrong] = _padded(again[0], 1, most)
        right[wrong], left[wrong] = (_padded(part, 2, most) for part in again[1:])
    return values, right, left


@where_compiled
def _lockstep() -> ModuleType:
    from facegear.floquet import lockstep_vectors

    return lockstep_vectors


def _by_lapack(matrices: FloatArray, least: float) -> tuple[ComplexArray, FloatArray, FloatArray]:
    values, vectors = np.linalg.eig(matrices)
    # Exactly dependent eigenvectors, at a border, have no inverse.
    inverse = np.linalg.inv(vectors + 1e-15 * np.eye(vectors.shape[-1]))
    kept, places = _upper(values, least)
    both = (
        np.take_along_axis(part, places[:, :, np.newaxis], axis=1)
        for part in (vectors.swapaxes(1, 2), inverse)
    )
    there = (kept != 0.0)[:, :, np.newaxis]
    right, left = (np.stack([part.real * there, part.imag * there], axis=1) for part in both)
    return kept, right, left


def _upper(values: ComplexArray, least: float) -> tuple[ComplexArray, NDArray[np.intp]]:
    """Eigenvalues (V, m) that are not below the real axis and not left out, then zeros, and their places."""
    size = np.abs(values)
    largest = size.max(axis=1, keepdims=True, initial=0.0)
    kept = (values.imag >= 0.0) & ((size * largest > least) | (size == largest))
    counts = kept.sum(axis=1, keepdims=True)
    places = np.argsort(~kept, axis=1, kind="stable")[:, : counts.max(initial=0)]
    found = np.take_along_axis(values, places, axis=1)
    return np.where(np.arange(places.shape[1]) < counts, found, 0j), places


def _padded(part: NDArray[T], axis: int, most: int) -> NDArray[T]:
    """Values or vectors with zeros added up to `most` along an axis."""
    width = [(0, most - size if number == axis else 0) for number, size in enumerate(part.shape)]
    return np.pad(part, width)


def _scaled(
    values: ComplexArray, right: FloatArray, left: FloatArray, growth: FloatArray
) -> NDArray[np.bool_]:
    """Scale left vectors so that wᵢ vᵢ = 1, and find whether all vectors of a matrix are what they should be."""
    there = values != 0.0
    direct, crossed = _combined(_products(left, right))
    own = np.einsum("vii->vi", direct).copy()
    with np.errstate(all="ignore"):
        factor = np.where(there, 1.0 / own, 0.0)[:, :, np.newaxis]
        # Products of two vectors, both scaled alike.
        root = np.sqrt(np.abs(factor[..., 0]))
        number = np.arange(values.shape[1])
        direct[:, number, number] = 0.0
        # The conjugate of a real vector is its own.
        crossed[:, number, number] *= values.imag > 0.0
        products = np.maximum(np.abs(direct), np.abs(crossed)) * root[:, :, np.newaxis] * root[:, np.newaxis]
        fine = (products <= _OBLIQUE).all(axis=(1, 2)) & ((growth * _LEFT_OVER >= 1.0) | ~there).all(axis=1)
        real, imag = left[:, 0].copy(), left[:, 1]
        left[:, 0] = real * factor.real - imag * factor.imag
        left[:, 1] = real * factor.imag + imag * factor.real
    return np.asarray(fine, dtype=bool)


def _products(left: FloatArray, right: FloatArray) -> FloatArray:
    """Products of real and imaginary parts of left and right vectors, shape (V, 2, m, 2, m)."""
    count, _, size, _ = left.shape
    return np.asarray((_rows(left) @ _rows(right).swapaxes(1, 2)).reshape(count, 2, size, 2, size))


def _rows(vectors: FloatArray) -> FloatArray:
    """Real and imaginary parts of all vectors one after the other, (V, 2m, d)."""
    count, _, size, d = vectors.shape
    return vectors.reshape(count, 2 * size, d)


def _combined(parts: FloatArray) -> tuple[ComplexArray, ComplexArray]:
    """Products of left vectors with right ones, and with their conjugates, of those of their parts."""
    both, other = parts[:, 0, :, 0] + 1j * parts[:, 1, :, 0], parts[:, 1, :, 1] - 1j * parts[:, 0, :, 1]
    return both - other, both + other
