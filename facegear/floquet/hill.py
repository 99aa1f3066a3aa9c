"""Hill's matrix: a periodic system as a constant one of many more coordinates (harmonic balance).

In x = t/T0 the scaled state obeys X' = B(x) X. With X = e^{Λt} Σ X_m e^{2πimx} and the Fourier coefficients B_j of B
the harmonics X_m obey

    Λ T0 X_m = Σ_k B_{m−k} X_k − 2πi m X_m,

a constant matrix, infinite but for the harmonics −H ... H that are kept. Each characteristic exponent Λ stands among
its eigenvalues once for every m, as Λ + im·2π/T0, and near the ends of the series stand others that belong to nothing:
eigenvalues have to be sorted. :func:`in_base_strip` and :func:`by_mean_harmonic` do so, and :func:`without_sorting`
does without: in the exponential of the matrix the blocks of column 0 add up to Φ (Bayer and Leine, Nonlinear Dynamics
111, 2023).

The error falls exponentially with H for smooth systems, as H⁻⁵ where A(t) kinks, as H⁻³ where it jumps, and as H⁻¹
where velocities do; the multipliers of Φ, from integration piece by piece (:func:`exponents`), know nothing of that.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import expm

from facegear.floquet.fourier import fourier_series
from facegear.floquet.methods import Method
from facegear.floquet.multipliers import multipliers
from facegear.floquet.periodic import PeriodicSystem, require_system
from facegear.floquet.stepping import Family
from facegear.support.parameters import integer_within, positive
from facegear.support.types import ComplexArray, FloatArray

_MOST_HARMONICS = 1000
# Part of π/T0 by which truncation may put an exponent beyond the edge of the strip.
_ON_THE_EDGE = 0.01


@dataclass(frozen=True, eq=False)
class HillSpectrum:
    """All eigenvalues of Hill's matrix, those that belong to nothing among them.

    Attributes
    ----------
    exponents : complex array, shape (2n (2H + 1),)
        Eigenvalues over T0 [1/s], in no order.
    vectors : complex array, shape (2H + 1, 2n, 2n (2H + 1))
        Harmonics −H ... H of the scaled state, and the eigenvalue they belong to.
    period : float
        T0 [s].
    """

    exponents: ComplexArray
    vectors: ComplexArray
    period: float

    @property
    def states(self) -> int:
        """Number of exponents of the system, 2n."""
        return int(self.vectors.shape[1])

    @property
    def mean_harmonics(self) -> FloatArray:
        """Mean of the number m of the harmonics of each eigenvector, weighted by their squares: 0 for a centred one."""
        weights = (np.abs(self.vectors) ** 2).sum(axis=1)
        half = (len(weights) - 1) // 2
        return np.asarray(np.arange(-half, half + 1) @ weights / weights.sum(axis=0), dtype=float)


def hill_matrix(system: PeriodicSystem, harmonics: int) -> ComplexArray:
    """Hill's matrix of a system, times T0, in scaled coordinates.

    Fourier coefficients are exact integrals, piece by piece; what a mass is kicked by (the velocity kicks of a load
    with a mass and total rate) stands in them as impulses.

    Parameters
    ----------
    system : PeriodicSystem
    harmonics : int
        H, from 1 to 1000.

    Returns
    -------
    complex array, shape (2n (2H + 1), 2n (2H + 1))
        Blocks of 2n rows and columns, one a harmonic from −H to H.

    Raises
    ------
    TypeError
        If an argument is of the wrong kind.
    ValueError
        If `harmonics` is outside its range, or the system has jumps of the state of its own: at a jump of the
        displacement an impulse times what jumps itself has no Fourier series.

    Examples
    --------
    >>> from facegear.mechanics.classical import Mathieu
    >>> hill_matrix(Mathieu(depth=0.2).system(1.7), 3).shape
    (14, 14)
    """
    require_system(system)
    count = integer_within("harmonics", harmonics, 1, _MOST_HARMONICS)
    if system.jumps:
        raise ValueError(
            "system must have no jumps of the state of its own for Hill's matrix: products of impulses with what jumps "
            "have no Fourier series; multipliers(system) takes them"
        )
    family = Family([system])
    series = fourier_series(lambda x: family.state_matrices(x)[0], family.breakpoints, 2 * count)
    mean, positive = series.mean, (series.cosine - 1j * series.sine) / 2.0
    for at, jump in system.state_jumps():
        change = family.scale @ (jump - np.eye(len(jump))) @ family.inverse_scale
        mean = mean + change
        positive = positive + np.exp(-2j * np.pi * at * (1.0 + np.arange(2 * count)))[:, None, None] * change
    coefficients = np.concatenate([positive[::-1].conj(), mean[None], positive])
    numbers = np.arange(-count, count + 1)
    blocks = coefficients[numbers[:, None] - numbers + 2 * count]
    size = blocks.shape[-1]
    matrix = blocks.swapaxes(1, 2).reshape(numbers.size * size, -1)
    return np.asarray(matrix - np.diag(np.repeat(2j * np.pi * numbers, size)), dtype=complex)


def hill_spectrum(system: PeriodicSystem, harmonics: int) -> HillSpectrum:
    """Find all eigenvalues and eigenvectors of :func:`hill_matrix`; arguments and errors as there."""
    matrix = hill_matrix(system, harmonics)
    values, vectors = np.linalg.eig(matrix)
    exponents = np.asarray(values / system.period, dtype=complex)
    vectors = vectors.astype(complex).reshape(2 * harmonics + 1, -1, values.size)
    return HillSpectrum(exponents, vectors, system.period)


def in_base_strip(spectrum: HillSpectrum) -> ComplexArray:
    """Return the 2n eigenvalues whose imaginary parts are the smallest: those between −π/T0 and π/T0.

    Where an exponent lies on the edge of that strip, as in every tongue with multipliers of −1, both of its images are
    as good, and one exponent may be taken twice and another one left out.

    Returns
    -------
    complex array, shape (2n,)
        Largest real part first [1/s].

    Raises
    ------
    ArithmeticError
        If the harmonics are too few to bring all exponents there, H below their frequencies over 2π/T0. As many are
        needed, not always enough.
    """
    chosen, edge = _chosen(spectrum, np.abs(spectrum.exponents.imag)), np.pi / spectrum.period
    if np.abs(chosen.imag).max() > (1.0 + _ON_THE_EDGE) * edge:
        harmonics = (len(spectrum.vectors) - 1) // 2
        # The images furthest up are those of the fastest motion with the last harmonic.
        fastest = np.abs(spectrum.exponents.imag).max() - 2.0 * edge * harmonics
        raise ArithmeticError(
            f"{harmonics} harmonics do not bring all exponents into the strip up to π/T0 = {edge:.6g} rad/s: the "
            f"fastest motion, of about {fastest:.6g} rad/s, takes at least {int(np.ceil(fastest / (2.0 * edge)))}, "
            "and as many more as its own series has; by_mean_harmonic needs only these"
        )
    return chosen


def by_mean_harmonic(spectrum: HillSpectrum) -> ComplexArray:
    """Return the 2n eigenvalues whose eigenvectors are centred best, |mean harmonic| smallest.

    Their imaginary parts need not lie in the base strip: they are the frequencies at which a motion is the largest, and
    H need not reach from there to the strip.
    On the edge it is no better than :func:`in_base_strip`.

    Returns
    -------
    complex array, shape (2n,)
        Largest real part first [1/s].
    """
    return _chosen(spectrum, np.abs(spectrum.mean_harmonics))


def _chosen(spectrum: HillSpectrum, away: FloatArray) -> ComplexArray:
    first = spectrum.exponents[np.argsort(away, kind="stable")[: spectrum.states]]
    return np.asarray(first[np.argsort(-first.real, kind="stable")], dtype=complex)


def without_sorting(system: PeriodicSystem, harmonics: int) -> ComplexArray:
    """Exponents from Hill's matrix without sorting: by its exponential, which has Φ in it.

    Parameters
    ----------
    system : PeriodicSystem
    harmonics : int
        As for :func:`hill_matrix`, errors too.

    Returns
    -------
    complex array, shape (2n,)
        As :func:`exponents` returns them.
    """
    require_system(system)
    starts = system.breakpoints
    lengths = np.diff(starts, append=1.0)
    longest = int(lengths.argmax())
    # Where nothing jumps: at an impulse the series would have half of it.
    matrix = hill_matrix(system.shift(float(starts[longest] + lengths[longest] / 2.0)), harmonics)
    size, middle = 2 * system.size, harmonics * 2 * system.size
    columns = expm(matrix)[:, middle : middle + size]
    transition = columns.reshape(-1, size, size).sum(axis=0)
    return logarithms(np.linalg.eigvals(transition), system.period)


def exponents(system: PeriodicSystem, method: Method | None = None) -> ComplexArray:
    """Characteristic exponents Λ = ln(λ)/T0 from the multipliers, imaginary parts between −π/T0 and π/T0.

    Parameters
    ----------
    system : PeriodicSystem
    method : Method, optional
        As for :func:`facegear.floquet.multipliers.multipliers`, which sorts them.

    Returns
    -------
    complex array, shape (2n,)
        Largest real part first [1/s].
    """
    return logarithms(multipliers(system, method), system.period)


def logarithms(values: ComplexArray, period: float) -> ComplexArray:
    """Exponents [1/s] of multipliers, largest modulus first; −∞ of those that are 0."""
    ordered = np.asarray(values)[np.argsort(-np.abs(values), kind="stable")]
    with np.errstate(divide="ignore"):
        logs = np.log(ordered.astype(complex))
    # By parts: an infinite complex number over a real one has an undefined imaginary part.
    return np.asarray(logs.real / period + 1j * (logs.imag / period), dtype=complex)


def apart(found: ComplexArray, truth: ComplexArray, period: float) -> FloatArray:
    """Distance of each true exponent from the nearest found one, multiples of 2πi/T0 taken off, shape (2n,) [1/s].

    Parameters
    ----------
    found, truth : complex array, shapes (m,) and (2n,)
        One or more [1/s].
    period : float
        T0 [s], greater than 0.

    Raises
    ------
    TypeError, ValueError
        Naming the argument and what would be valid.
    """
    turn = 2.0 * np.pi / positive("period", period, "s")
    for name, values in (("found", found), ("truth", truth)):
        if np.ndim(values) != 1 or np.size(values) == 0:
            raise ValueError(f"{name} must be a list of one exponent or more, got shape {np.shape(values)}")
    difference = np.asarray(truth)[:, None] - np.asarray(found)
    wrapped = difference.real + 1j * (difference.imag - turn * np.round(difference.imag / turn))
    return np.asarray(np.abs(wrapped).min(axis=1), dtype=float)
