"""How well Floquet multipliers are known: by finer methods, and by what rounding changes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from facegear.floquet.methods import Method, with_method
from facegear.floquet.multipliers import eigenvalues
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.stepping import Family
from facegear.support.types import ComplexArray, FloatArray

# Changes of a transition matrix that show what rounding does to its eigenvalues.
_CHANGES = 4
# Parts of the period, at least, in each of which something is lost to rounding.
_STRETCHES = 16


def error_estimate(system: PeriodicSystem, method: Method | None = None) -> float:
    """Estimate of the error of the spectral radius max|λ| found by a method.

    The dominant multiplier of the method is compared with the nearest one of its refinement, and the other way
    round. That distance bounds the difference of the two spectral radii, and unlike that difference it does not
    vanish because both lie on the unit circle. Near a tongue's border, where two multipliers meet, it grows as the
    true error does. The largest of two successive refinements counts: on a coarse mesh the error of a real
    multiplier may change its sign between two of them. Rounding, which may be common to all of them, is told by what
    changes of Φ as large as its own do to the multiplier: those of the whole, and those of stretches of the period,
    where a motion may be far larger than at the end.

    Of two thousand systems of sixteen kinds, stiff, drifting, defective and jumping ones among them, the true error of
    none is more than ten times this, with any method (``tests/floquet/test_estimates_of_many_kinds.py``).

    Parameters
    ----------
    system : PeriodicSystem
    method : Method, optional
        See :func:`with_method` if left out.

    Returns
    -------
    float
        In the units of a multiplier [-].

    Examples
    --------
    >>> import facegear as fg
    >>> body = fg.Body(fg.Drive(26, 130, 3.175e-3), thickness_ratio=0.03)
    >>> model = fg.Transverse(body, fg.MeshLoad(stiffness=1.0, damping=3e-6, mass=1.0))
    >>> fg.error_estimate(model.system(fg.rad_per_s(600.0))) < 1e-6
    True
    """
    judged = with_method(method, lambda chosen: _Judged.of(system, chosen))
    values = judged.values

    def apart(others: ComplexArray) -> float:
        distance = np.abs(values[:, None] - others[None, :])
        forth, back = distance[np.abs(values).argmax()].min(), distance[:, np.abs(others).argmax()].min()
        return float(max(forth, back))

    return max(map(apart, judged.finer)) + max(judged.rounding, *map(apart, judged.disturbed))


def multiplier_errors(system: PeriodicSystem, method: Method | None = None) -> FloatArray:
    """Estimated error of each multiplier, found as :func:`error_estimate` finds that of the largest.

    Parameters
    ----------
    system : PeriodicSystem
    method : Method, optional
        See :func:`with_method` if left out.

    Returns
    -------
    array, shape (2n,)
        In the order of :func:`multipliers` [-]. A multiplier that is smaller is zero to all digits that are known.

    Examples
    --------
    >>> import numpy as np
    >>> from facegear.floquet.multipliers import multipliers
    >>> slow_and_fast = PeriodicSystem(np.eye(1), [[50.0]], np.eye(1), (), 100.0)
    >>> np.abs(multipliers(slow_and_fast)) > multiplier_errors(slow_and_fast)
    array([ True, False])
    """
    judged = with_method(method, lambda chosen: _Judged.of(system, chosen))
    values = judged.values[np.argsort(-np.abs(judged.values), kind="stable")]

    def apart(others: ComplexArray) -> FloatArray:
        return np.asarray(np.abs(values[:, None] - others[None, :]).min(axis=1), dtype=float)

    rounding = np.maximum(judged.rounding, np.max([apart(x) for x in judged.disturbed], axis=0))
    return np.asarray(np.max([apart(x) for x in judged.finer], axis=0) + rounding, dtype=float)


def rounding_shift(system: PeriodicSystem, method: Method) -> float:
    """Part of :func:`error_estimate` that is due to rounding: how far it moves a multiplier that may be the largest."""
    family = Family([system])
    return shift_by_rounding(method.scaled_transition_matrices(family)[0], family, method)


def shift_by_rounding(scaled: FloatArray, family: Family, method: Method) -> float:
    """As :func:`rounding_shift`, of the one system of a family whose scaled transition matrix is known."""
    rounding = rounding_error(scaled, family, method)
    radii = np.abs(eigenvalues(disturbed(scaled, family, method))).max(axis=-1)
    return float(max(rounding, np.abs(radii - np.abs(eigenvalues(scaled)).max()).max()))


@dataclass(frozen=True, eq=False)
class _Judged:
    """Multipliers of a method, those of two refinements, and those of its Φ disturbed by as much as its rounding."""

    values: ComplexArray
    finer: list[ComplexArray]
    disturbed: list[ComplexArray]
    rounding: float

    @classmethod
    def of(cls, system: PeriodicSystem, method: Method) -> _Judged:
        family = Family([system])
        scaled = method.scaled_transition_matrices(family)[0]
        finer, better = [], method
        for _ in range(2):
            better = better.refined()
            finer.append(eigenvalues(better.scaled_transition_matrices(family))[0])
        rounding = rounding_error(scaled, family, method)
        return cls(eigenvalues(scaled), finer, list(eigenvalues(disturbed(scaled, family, method))), rounding)


def rounding_error(scaled: FloatArray, family: Family, method: Method) -> float:
    """Bound of the rounding in a scaled transition matrix (2n, 2n), as the norm of its error."""
    places = 8.0 * scaled.shape[-1] + method.rounding(family)
    return float(places * np.finfo(float).eps * max(1.0, np.linalg.norm(scaled, 2)))


def disturbed(scaled: FloatArray, family: Family, method: Method) -> FloatArray:
    """Return a scaled transition matrix (d, d) of a system with changes as large as rounding, shape (4, d, d).

    What is lost on the way is as large as what is added up there, and grows as the motion does from there on. So at the
    end of each of some stretches of the period something is changed, and brought to the end of all: by parts of
    |stretch| |motion|, as the product of two matrices is, and beside a jump of the state in every direction, since a
    method may mix what jumps with what does not. Where motions grow and die within a period, or a jump is taken back by
    another, that is more than Φ itself shows. And the equations themselves are rounded on the way: a stiff damper along
    one direction is one along others too, by its last places. What that does to motions which the damper leaves alone
    remains, and so the change is taken between two stretches. The changes are always the same ones.
    """
    size = scaled.shape[-1]
    (stretches,), (jumps,), (exponents,) = family.stretches(_STRETCHES)
    whole, *parts = _changes(size, len(stretches) + 1)
    changed = scaled + rounding_error(scaled, family, method) * whole
    places = size + method.rounding(family) / len(stretches)
    arriving, lost = np.eye(size), np.zeros_like(changed)
    with np.errstate(over="ignore", invalid="ignore"):
        for stretch, jump, exponent, part in zip(stretches, jumps, exponents, parts, strict=True):
            added = np.abs(stretch) @ np.abs(arriving)
            if jump > 0.0:
                added += jump * np.abs(arriving).max()
            rounded = stretch @ (np.abs(exponent) * part) @ stretch @ arriving
            lost = stretch @ lost + added * part + rounded
            arriving = stretch @ arriving
        lost *= places * np.finfo(float).eps
    # Frozen motions may grow beyond double precision where those of the system do not.
    return np.asarray(changed + lost if np.isfinite(lost).all() else changed, dtype=float)


@lru_cache(maxsize=64)
def _changes(size: int, count: int) -> FloatArray:
    """Random matrices of unit norm, always the same ones, shape (count, 4, size, size)."""
    changes = np.random.default_rng(0).normal(size=(count, _CHANGES, size, size))
    return np.asarray(changes / np.linalg.norm(changes, 2, axis=(-2, -1), keepdims=True), dtype=float)
