"""Exact natural frequencies of torsional models with rods, counted after Wittrick and Williams.

Between its ends a rod has infinitely many degrees of freedom. Its dynamic stiffness leaves the angles of the ends alone
(:meth:`facegear.mechanics.rods.Rod.dynamic_stiffness`), and with it the dynamic stiffness D(ω) of the whole model is a
small matrix, but one with poles: where a rod oscillates with both ends held. The number of natural frequencies below ω
is that of the negative eigenvalues of D(ω) and of such poles below ω, so that halving an interval finds each of them,
double ones included.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np
from numpy.typing import ArrayLike

from facegear.floquet.piecewise import real_array
from facegear.mechanics.rods import Shaft, checked_shafts, shear_wave_speed
from facegear.support.parameters import integer_at_least, positive
from facegear.support.types import FloatArray

# Parts of the first half wave's frequency below which one counts as 0: the square root of rounding.
_AT_REST = 1e-7
# Parts of the largest entry of a matrix that may be rounding.
_ROUNDING = 1e-10


def count_below(frequency: float, mass: FloatArray, stiffness: FloatArray, shafts: Iterable[Shaft]) -> int:
    """Count the undamped natural frequencies below one, rods unreduced (Wittrick and Williams).

    Parameters
    ----------
    frequency : float
        ω [rad/s], greater than 0.
    mass, stiffness : array, shape (n, n)
        Of the model with each rod as a massless spring; symmetric.
    shafts : iterable of Shaft

    Returns
    -------
    int
        Number of negative eigenvalues of the dynamic stiffness at ω, and of frequencies that the rods have below it
        with their ends held.
    """
    frequency, shafts = positive("frequency", frequency, "rad/s"), checked_shafts(shafts, len(mass))
    dynamic = stiffness - frequency**2 * mass
    for shaft in shafts:
        massless = shaft.rod.stiffness * np.array([[1.0, -1.0], [-1.0, 1.0]])
        dynamic = dynamic + shaft.placed(
            shaft.rod.dynamic_stiffness(frequency) - massless, len(mass), len(mass)
        )
    held = sum(shaft.rod.held_frequencies_below(frequency) for shaft in shafts)
    return held + int((np.linalg.eigvalsh(dynamic) < 0.0).sum())


def exact_frequencies(
    mass: ArrayLike, stiffness: ArrayLike, shafts: Iterable[Shaft], count: int
) -> FloatArray:
    """Find the lowest undamped natural frequencies of a model with unreduced rods.

    Parameters
    ----------
    mass, stiffness : array_like, shape (n, n)
        Of the model with each rod as a massless spring; symmetric, the mass positive definite, the stiffness with no
        negative eigenvalue.
    shafts : iterable of Shaft
        At least one.
    count : int
        How many, at least 1.

    Returns
    -------
    ndarray, shape (count,)
        Ascending [rad/s], to rounding, or to half of all digits where one is also a frequency of a rod with both ends
        held; those of rigid-body motions are 0.

    Raises
    ------
    TypeError, ValueError
        If an argument is of the wrong kind or outside its range.

    Examples
    --------
    A rod held at one end, with next to nothing at the other: a quarter, three quarters, five quarters of a wave.

    >>> from facegear.mechanics.rods import Rod
    >>> rod = Rod(stiffness=1e6, length=0.5)
    >>> found = exact_frequencies([[1e-12]], [[1e6]], [Shaft(rod, end=0)], 3)
    >>> (found * rod.length / shear_wave_speed(rod.material) / np.pi).round(6)
    array([0.5, 1.5, 2.5])
    """
    mass, stiffness = real_array(mass, "mass", 2), real_array(stiffness, "stiffness", 2)
    if mass.shape != stiffness.shape or mass.shape[0] != mass.shape[1]:
        raise ValueError(
            f"mass and stiffness must be square and of one size, got {mass.shape} and {stiffness.shape}"
        )
    for name, matrix in (("mass", mass), ("stiffness", stiffness)):
        if np.abs(matrix - matrix.T).max() > _ROUNDING * np.abs(matrix).max():
            raise ValueError(f"{name} must be symmetric, got {matrix.tolist()}")
    if np.linalg.eigvalsh(mass)[0] <= 0.0:
        raise ValueError(f"mass must be positive definite, got {mass.tolist()}")
    if np.linalg.eigvalsh(stiffness)[0] < -_ROUNDING * np.abs(stiffness).max():
        raise ValueError(
            f"stiffness must have no negative eigenvalue, as none of a model at rest has, got {stiffness.tolist()}"
        )
    shafts = checked_shafts(shafts, len(mass))
    if not shafts:
        raise ValueError("shafts must list at least one shaft, got none")
    count = integer_at_least("count", count, 1)
    # About one half wave of the longest rod: from there on it only takes doubling. No whole number of half waves of any
    # rod, at which the dynamic stiffness has a pole and cannot be counted: lengths are rational numbers.
    lowest = min(np.pi * shear_wave_speed(x.rod.material) / x.rod.length for x in shafts) / math.sqrt(2.0)
    found: list[float] = []
    for number in range(count):
        low, high = (found[-1] if found else 0.0), float(lowest)
        while count_below(high, mass, stiffness, shafts) <= number:
            low, high = high, 2.0 * high
        while high - low > 4.0 * np.spacing(high) and high > _AT_REST * lowest:
            middle = (low + high) / 2.0
            if count_below(middle, mass, stiffness, shafts) > number:
                high = middle
            else:
                low = middle
        found.append(high if high > _AT_REST * lowest else 0.0)
    return np.array(found)
