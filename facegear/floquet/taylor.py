"""Taylor series in time of the transition matrices of many small systems at once.

On a short part of the period the coefficients of the equations are polynomials of the time s in it,

    p' = α v,    v' = −Σ_j s^j (K_j p + C_j v),

and those of the motion follow one after the other,

    (k+1) p_{k+1} = α v_k,    (k+1) v_{k+1} = −Σ_j (K_j p_{k−j} + C_j v_{k−j}).

Terms are added until two in turn are nothing beside the state. With rank-one loads K_j and C_j are their polynomials
times stiffness and damping, so that systems which differ in these, in constant matrices or in speed share all but the
recurrence; that runs in lockstep where Numba is installed (:mod:`facegear.floquet.lockstep_taylor`). Integrators for
any equations choose steps and order for each motion alone (Jorba and Zou, Experimental Mathematics 14, 2005).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from types import ModuleType
from typing import ClassVar, NamedTuple

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from facegear.floquet.compiled import LANES, where_compiled
from facegear.floquet.free_modes import UnsuitableSystemError
from facegear.floquet.piecewise import same_function
from facegear.floquet.stepping import SHARED_STEPS, Family, aligned_edges
from facegear.support.parameters import keep, within
from facegear.support.types import FloatArray

# Points of a step through which its coefficients are laid, and what may be left of the last two, and is left out.
_POINTS, _RESOLVED, _NOTHING = 17, 1e-13, 1e-15
# How much larger powers of s may be than the polynomial that they add up to.
_CANCELLED = 5.0
# Terms before a step is halved, and how often that is done.
_MOST_TERMS, _MOST_HALVINGS = 48, 4
# Integral of the norm over a period beyond which exponentials, which are squared, take less time.
_MOST_EXPONENT = 6000.0
# Cells go together if their norms are at least this part of the largest among them, or if they are so few.
_TOGETHER = 0.8
# Cells fewer than these are not worth another library.
_FEWEST = 2


class Members(NamedTuple):
    """V systems in scaled coordinates, and p loads that they have in common.

    Attributes
    ----------
    stiffness, damping : ndarray, shape (V, n, n)
        Of the constant part; times the period they are K_0 and C_0 of it.
    load_stiffness, load_damping : ndarray, shape (V, p)
    ratio : float
        α over the period.
    """

    stiffness: FloatArray
    damping: FloatArray
    load_stiffness: FloatArray
    load_damping: FloatArray
    ratio: float


class Steps(NamedTuple):
    """Powers of s on the steps of a period; J of them, m steps.

    Attributes
    ----------
    lengths : ndarray, shape (m,)
        Parts of the period.
    dyads, slopes : ndarray, shape (m, J, p, n, n)
        Of wφφᵀ, and of wφφ'ᵀ for loads with total rate, in scaled coordinates.
    """

    lengths: FloatArray
    dyads: FloatArray
    slopes: FloatArray


@dataclass(frozen=True)
class Taylor:
    """Taylor series in time, for small systems without contact masses and jumps of the state.

    Parameters
    ----------
    angle : float
        Largest integral of the norm of the state matrix over a step [-].
    tolerance : float
        Size of two terms in turn beside the state at which a series ends [-]; what follows is far smaller.

    Raises
    ------
    UnsuitableSystemError
        When used on a family whose masses or shapes differ, on one with contact masses, jumps of the state or
        derivatives, or where dampers ask for very many steps.

    Examples
    --------
    >>> import numpy as np
    >>> import facegear as fg
    >>> free = fg.PeriodicSystem([[1.0]], [[0.0]], [[1.0]], (), period=1.0)
    >>> bool(np.allclose(fg.multipliers(free, Taylor()).real, np.cos(1.0)))
    True
    """

    angle: float = 6.0
    tolerance: float = 1e-12

    together: ClassVar[float] = SHARED_STEPS

    def __post_init__(self) -> None:
        # Larger terms would take digits with them when they cancel.
        keep(self, angle=within("angle", self.angle, 0.1, 6.0))
        keep(self, tolerance=within("tolerance", self.tolerance, 1e-16, 1e-2))

    def scaled_transition_matrices(self, family: Family) -> FloatArray:
        """See :class:`facegear.floquet.methods.Method`."""
        return np.asarray(self.over(family, np.ones(1))[:, 0])

    def refined(self) -> Taylor:
        """Return steps of half the length, with series that go further."""
        return Taylor(self.angle / 2.0, max(1e-3 * self.tolerance, 1e-16))

    def rounding(self, family: Family) -> float:
        """See :class:`facegear.floquet.methods.Method`: terms up to angle^k/k! cancel in each step."""
        largest = self.angle**self.angle / math.gamma(1.0 + self.angle)
        return float(largest / self.angle * family.exponent_norm)

    def over(self, family: Family, turns: FloatArray) -> FloatArray:
        """Scaled transition matrices of V systems at S periods each, nothing else being changed.

        Parameters
        ----------
        family : Family
        turns : ndarray, shape (S,)
            Periods over those of the family.

        Returns
        -------
        ndarray, shape (V, S, 2n, 2n)
        """
        members, left, back = _members(family)
        states = np.abs(np.linalg.norm(family.state_matrices(family.middles), 2, axis=(-2, -1)))
        norms = (states @ np.diff(np.append(family.breakpoints, 1.0)))[:, np.newaxis] * turns
        periods = (family.periods[:, np.newaxis] * turns).ravel()
        found = np.empty((periods.size, 2 * family.size, 2 * family.size))
        numbers = np.repeat(np.arange(len(family.systems)), turns.size)
        compiled = _compiled() if numbers.size >= _FEWEST else None
        most = int(_MOST_EXPONENT / self.angle)
        for cells in _groups(norms.ravel()):
            fewest = float(norms.ravel()[cells].max()) / self.angle
            for _ in range(_MOST_HALVINGS):
                steps = _steps(family, left, back, fewest, most)
                found[cells] = _matrices(
                    members, steps, numbers[cells], periods[cells], self.tolerance, compiled
                )
                cells = cells[~np.isfinite(found[cells]).all(axis=(1, 2))]
                fewest = 2.0 * steps.lengths.size
                if not cells.size:
                    break
            else:
                raise UnsuitableSystemError(
                    "series of the motion do not settle, or it grows beyond all numbers"
                )
        return found.reshape(len(family.systems), turns.size, *found.shape[1:])


def _members(family: Family) -> tuple[Members, FloatArray, FloatArray]:
    """Systems in scaled coordinates, and what turns forces and displacements into these."""
    systems, n = family.systems, family.size
    first = systems[0]
    unfit = family.carries_derivatives or any(family.jumps) or bool((family.mass != family.mass[0]).any())
    for system in systems:
        for own, load in zip(system.loads, first.loads, strict=True):
            shared = same_function(own.shape, load.shape) and same_function(own.weight, load.weight)
            shared = shared and own.rate == load.rate
            unfit = unfit or own.mass > 0.0 or not shared
    if unfit:
        raise UnsuitableSystemError(
            "Taylor series are for systems with one mass and common shapes of their loads, without contact masses or "
            "jumps of the state"
        )
    left = np.asarray(family.scale[n:, n:] @ np.linalg.inv(first.mass), dtype=float)
    back = np.asarray(family.inverse_scale[n:, n:], dtype=float)
    ratio = float(family.scale[0, 0] / family.scale[n, n])
    parts = (
        np.array([[getattr(load, name) for load in system.loads] for system in systems])
        for name in ("stiffness", "damping")
    )
    k, c = (part.reshape(len(systems), len(first.loads)) for part in parts)
    stiffness = left @ family.stiffness[:, 0] @ back / ratio
    return Members(stiffness, left @ family.damping[:, 0] @ back, k / ratio, c, ratio), left, back


def _groups(norms: FloatArray) -> Iterator[NDArray[np.intp]]:
    """Numbers of cells that may have common steps."""
    order = np.argsort(-norms)
    while order.size:
        count = max(LANES, int(np.count_nonzero(norms[order] >= _TOGETHER * norms[order[0]])))
        yield order[:count]
        order = order[count:]


@cache
def _rule(count: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Points in [0, 1], and what makes coefficients of T_j(2s − 1) of values there, and powers of s of these."""
    points = chebyshev.chebpts1(count)
    to_powers = np.zeros((count, count))
    for degree in range(count):
        # T_j(2s − 1) = T_2j(√s).
        to_powers[degree, : degree + 1] = chebyshev.cheb2poly(np.append(np.zeros(2 * degree), 1.0))[::2]
    to_series = np.linalg.inv(chebyshev.chebvander(points, count - 1))
    return (points + 1.0) / 2.0, np.asarray(to_series, dtype=float), to_powers


def _steps(family: Family, left: FloatArray, back: FloatArray, fewest: float, most: int) -> Steps:
    """Lay polynomials through the coefficients on the steps of a period, so many at least and at most."""
    loads, count = family.systems[0].loads, max(1, int(np.ceil(min(fewest, 2.0 * most))))
    ratio = float(family.scale[0, 0] / family.scale[family.size, family.size])
    # Polynomials of so low a degree are met by as many points.
    degrees = (2 * x.shape.degree + (0 if x.weight is None else x.weight.degree) for x in loads)
    exact = max(degrees, default=0) + 1
    points, to_series, to_powers = _rule(min(exact, _POINTS))
    while count <= most:
        edges = aligned_edges(family.breakpoints, count)
        lengths = np.diff(edges)
        x = edges[:-1, np.newaxis] + lengths[:, np.newaxis] * points
        values = np.zeros((lengths.size, points.size, 2, len(loads), family.size, family.size))
        for number, load in enumerate(loads):
            phi = load.shape(x)
            force = (phi if load.weight is None else phi * load.weight(x)) @ left.T
            values[:, :, 0, number] = force[..., :, np.newaxis] * (phi @ back)[..., np.newaxis, :]
            if load.rate == "total":
                slope = load.slope(x) @ back / ratio
                values[:, :, 1, number] = force[..., :, np.newaxis] * slope[..., np.newaxis, :]
        series = np.tensordot(values, to_series, axes=(1, 1))
        sizes = np.abs(values).max(axis=(0, 1, 4, 5), initial=0.0)[..., np.newaxis, np.newaxis, np.newaxis]
        sizes = np.where(sizes > 0.0, sizes, 1.0)
        parts = (np.abs(series) / sizes).max(axis=(0, 1, 2, 3, 4), initial=0.0)
        terms = int(np.flatnonzero(parts > _NOTHING).max(initial=0)) + 1
        powers = series[..., :terms] @ to_powers[:terms, :terms]
        cancelled = (np.abs(powers) / sizes).max(initial=0.0)
        resolved = exact <= _POINTS or parts[-2:].max() <= _RESOLVED
        if resolved and cancelled <= _CANCELLED:
            dyads, slopes = np.moveaxis(powers, (1, -1), (0, 2))
            return Steps(lengths, np.ascontiguousarray(dyads), np.ascontiguousarray(slopes))
        count *= 2
    raise UnsuitableSystemError(f"coefficients or dampers ask for more than {most} steps of the period")


def _matrices(
    members: Members,
    steps: Steps,
    numbers: NDArray[np.int64],
    periods: FloatArray,
    tolerance: float,
    compiled: ModuleType | None,
) -> FloatArray:
    """Scaled transition matrices of cells: numbers of their systems, and periods, both (V,)."""
    if compiled is None:
        return _by_numpy(members, steps, numbers, periods, tolerance)
    n = members.stiffness.shape[-1]
    found = np.empty((numbers.size, 2 * n, 2 * n))
    compiled.taylor(*members[:4], members.ratio, *steps, numbers, periods, found, _MOST_TERMS, tolerance)
    return found


@where_compiled
def _compiled() -> ModuleType:
    from facegear.floquet import lockstep_taylor

    return lockstep_taylor


def _by_numpy(
    members: Members, steps: Steps, numbers: NDArray[np.int64], periods: FloatArray, tolerance: float
) -> FloatArray:
    n = members.stiffness.shape[-1]
    period = periods[:, np.newaxis, np.newaxis]
    k, c = members.load_stiffness[numbers], members.load_damping[numbers]
    state = np.broadcast_to(np.eye(2 * n), (numbers.size, 2 * n, 2 * n)).copy()
    for length, dyads, slopes in zip(*steps, strict=True):
        stiffness = np.einsum("va,japq->jvpq", k, dyads) * period + np.einsum("va,japq->jvpq", c, slopes)
        damping = np.einsum("va,japq->jvpq", c, dyads) * period
        stiffness[0] += members.stiffness[numbers] * period
        damping[0] += members.damping[numbers] * period
        both = np.concatenate([stiffness, damping], axis=-1) * length
        size = np.abs(state).max(axis=(1, 2))
        terms, small = [state], 0
        for order in range(1, _MOST_TERMS + 1):
            new = np.empty_like(state)
            new[:, :n] = terms[-1][:, n:] * (length * members.ratio * period / order)
            new[:, n:] = sum(part @ term for part, term in zip(both, reversed(terms), strict=False))
            new[:, n:] /= -order
            terms.append(new)
            del terms[: -len(both)]
            state = state + new
            small = small + 1 if bool((np.abs(new).max(axis=(1, 2)) <= tolerance * size).all()) else 0
            if small == 2:
                break
        else:
            return np.full_like(state, np.nan)
    return state
