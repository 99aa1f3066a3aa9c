"""Floquet analysis of periodic linear systems (section 2.2.1).

The state X = (q, q̇) after one period is Φ(T0, 0) X(0); the eigenvalues λ of the transition matrix Φ, the
Floquet multipliers, decide: the system is stable if and only if every |λ| ≤ 1 (2-5 to 2-8). Each method of
this module is a small frozen dataclass that turns a system into its Φ:

- :class:`Stepwise`: the text's rule, A(t) held at its midpoint value in equal sub-intervals (2-9 to 2-11);
- :class:`AlignedStepwise`: the same with sub-intervals that end where A(t) jumps or kinks;
- :class:`Magnus`: fourth order, aligned, for any system, with a fixed number of sub-intervals;
- :class:`AdaptiveMagnus`: the same, refined until an error estimate is met;
- :class:`Collocation`: contact-force collocation, fast and spectrally accurate where it applies.

:func:`with_method` says which of them is used where none is named; the package's docstring compares them.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Protocol, TypeVar

import numpy as np

from facegear.floquet import collocation
from facegear.floquet.free_modes import UnsuitableSystemError
from facegear.floquet.gauss_panels import within_reach
from facegear.floquet.load_columns import LoadColumn
from facegear.floquet.motion import MotionPanels
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.stepping import Family, aligned_edges, gauss_magnus, midpoint
from facegear.support.parameters import integer_at_least, keep, within
from facegear.support.types import ComplexArray, FloatArray

T = TypeVar("T")

# Changes of a transition matrix that show what rounding does to its eigenvalues.
_CHANGES = 4
# Parts of the period, at least, in each of which something is lost to rounding.
_STRETCHES = 16


class Method(Protocol):
    """A way to compute the Floquet transition matrix."""

    def scaled_transition_matrices(self, family: Family) -> FloatArray:
        """S Φ S⁻¹ of each system of a family, in its scaled coordinates, shape (V, 2n, 2n)."""
        ...

    def refined(self) -> Method:
        """Return a method to judge this one by: clearly more accurate, and blind to other things."""
        ...

    def rounding(self, family: Family) -> float:
        """Return how much rounding entries of Φ gather on the way, in units of the last place of the largest one."""
        ...


@dataclass(frozen=True)
class Stepwise:
    """Stepwise-constant A(t), equal sub-intervals, matrix exponential of each (2-9 to 2-11).

    Second order where A(t) is continuous; first order at best, and erratic, where it jumps.

    Parameters
    ----------
    sub_intervals : int
        Q, number of sub-intervals of the period.
    """

    sub_intervals: int

    def __post_init__(self) -> None:
        keep(self, sub_intervals=integer_at_least("sub_intervals", self.sub_intervals, 1))

    def scaled_transition_matrices(self, family: Family) -> FloatArray:
        """See :class:`Method`; refuses jumps of the state, as those of a contact mass with total rate."""
        if any(family.jumps):
            raise ValueError(
                "system has jumps of the state (its own, or velocity kicks where the slope of a shape with total rate "
                "jumps under a mass), which equal sub-intervals cannot place; use AlignedStepwise, Magnus or "
                "Collocation"
            )
        edges = np.linspace(0.0, 1.0, self.sub_intervals + 1)
        return family.product(edges, midpoint)

    def refined(self) -> Method:
        """Aligned sub-intervals: halving equal ones can look converged where it is not (fraction 9/16)."""
        return AlignedStepwise(2 * self.sub_intervals)

    def rounding(self, family: Family) -> float:
        """See :class:`Method`: squaring an exponential doubles what rounding has made of it."""
        return family.factors


@dataclass(frozen=True)
class AlignedStepwise:
    """Stepwise-constant A(t) with sub-intervals that end at the breakpoints: second order for any system.

    Parameters
    ----------
    sub_intervals : int
        Q; each smooth piece gets its share, rounded up.
    """

    sub_intervals: int

    def __post_init__(self) -> None:
        keep(self, sub_intervals=integer_at_least("sub_intervals", self.sub_intervals, 1))

    def scaled_transition_matrices(self, family: Family) -> FloatArray:
        """See :class:`Method`."""
        return family.product(aligned_edges(family.breakpoints, self.sub_intervals), midpoint)

    def refined(self) -> Method:
        """Twice as many sub-intervals."""
        return AlignedStepwise(2 * self.sub_intervals)

    def rounding(self, family: Family) -> float:
        """See :class:`Method`: squaring an exponential doubles what rounding has made of it."""
        return family.factors


@dataclass(frozen=True)
class Magnus:
    """Fourth-order Magnus integrator with two Gauss nodes a sub-interval, aligned with the breakpoints.

    exp(h (A₁+A₂)/2 − √3/12 h² [A₁, A₂]), A₁ and A₂ at the Gauss nodes (Iserles, Munthe-Kaas, Nørsett and Zanna,
    Acta Numerica 9, 2000).

    Parameters
    ----------
    sub_intervals : int
        Q; each smooth piece gets its share, rounded up.
    """

    sub_intervals: int

    def __post_init__(self) -> None:
        keep(self, sub_intervals=integer_at_least("sub_intervals", self.sub_intervals, 1))

    def scaled_transition_matrices(self, family: Family) -> FloatArray:
        """See :class:`Method`."""
        return family.product(aligned_edges(family.breakpoints, self.sub_intervals), gauss_magnus)

    def refined(self) -> Method:
        """Twice as many sub-intervals."""
        return Magnus(2 * self.sub_intervals)

    def rounding(self, family: Family) -> float:
        """See :class:`Method`: squaring an exponential doubles what rounding has made of it."""
        return family.factors


@dataclass(frozen=True)
class AdaptiveMagnus:
    """Magnus integrator, sub-intervals halved and extrapolated (up to order 10) until two results agree.

    Parameters
    ----------
    tolerance : float
        Largest error of an entry of Φ, in energy-like coordinates, relative to the largest entry or 1, rounding not
        counted: it grows with the integral of ‖A‖ over the period, damping included, and :func:`error_estimate`
        counts it. Strong dampers are for :class:`facegear.floquet.radau.Radau`.

    Raises
    ------
    ArithmeticError
        When used, if 2¹⁷ sub-intervals do not reach the tolerance.
    """

    tolerance: float = 1e-10

    def __post_init__(self) -> None:
        keep(self, tolerance=within("tolerance", self.tolerance, 1e-13, 1e-2))

    def scaled_transition_matrices(self, family: Family) -> FloatArray:
        """See :class:`Method`."""
        start = max(4, within_reach(family.fastest_angle / 3.0))
        factor, further, settled = 1, self._further, False
        row = [family.product(aligned_edges(family.breakpoints, start, factor), gauss_magnus)]
        while True:
            factor *= 2
            edges = aligned_edges(family.breakpoints, start, factor)
            finer = [family.product(edges, gauss_magnus)]
            # The method is symmetric, its error runs in even powers h⁴, h⁶, ...: Richardson's extrapolation.
            for order, coarse in zip((4, 6, 8), row, strict=False):
                finer.append(finer[-1] + (finer[-1] - coarse) / (2.0**order - 1.0))
            size = np.maximum(np.abs(finer[-1]).max(axis=(1, 2)), 1.0)
            change = np.abs(finer[-1] - finer[-2]).max(axis=(1, 2))
            settled = settled or bool((change <= self.tolerance * size).all())
            if settled and further == 0:
                return finer[-1]
            if settled:
                further -= 1
            elif edges.size > 2**17 or not np.isfinite(size).all():
                raise ArithmeticError(
                    f"transition matrix did not reach tolerance {self.tolerance:.1g} with {edges.size - 1} "
                    "sub-intervals; the period is too long for the fastest motion or growth"
                )
            row = finer

    def refined(self) -> Method:
        """Return the method with sub-intervals halved once more after it has settled.

        A smaller tolerance may be met by the same sub-intervals, and rounding may keep it from being met.
        """
        return _HalvedMagnus(self.tolerance, self._further + 1)

    @property
    def _further(self) -> int:
        """How often sub-intervals are halved after two results agree."""
        return 0

    def rounding(self, family: Family) -> float:
        """See :class:`Method`: squaring an exponential doubles what rounding has made of it."""
        return family.factors


@dataclass(frozen=True)
class _HalvedMagnus(AdaptiveMagnus):
    """Adaptive Magnus integrator whose sub-intervals are halved so many times more than its tolerance asks for."""

    halvings: int = 1

    @property
    def _further(self) -> int:
        return self.halvings


@dataclass(frozen=True)
class Collocation:
    """Contact-force collocation (:mod:`facegear.floquet.collocation`): exact free motion, forces at Gauss nodes.

    Parameters
    ----------
    nodes : int
        Gauss nodes a panel.
    panel_angle : float
        Largest product of fastest frequency and panel length [rad].
    fewest_held : int
        Number of coordinates from which on a system with rigid-body motions is taken: held by springs that are taken
        back as loads.

    Raises
    ------
    UnsuitableSystemError
        When used on a system whose free motion has overdamped or defective modes, or rigid-body ones and fewer
        coordinates; or on a family that carries more than the state, as its derivatives.
    """

    nodes: int = collocation.DEFAULT_NODES
    panel_angle: float = collocation.DEFAULT_PANEL_ANGLE
    fewest_held: int = 1

    def __post_init__(self) -> None:
        keep(
            self,
            nodes=integer_at_least("nodes", self.nodes, 2),
            # Beyond 14 rad the kernel of a heavily damped mode loses its digits.
            panel_angle=within("panel_angle", self.panel_angle, 0.1, 14.0),
            fewest_held=integer_at_least("fewest_held", self.fewest_held, 1),
        )

    def scaled_transition_matrices(self, family: Family) -> FloatArray:
        """See :class:`Method`."""
        if family.carries_derivatives:
            raise UnsuitableSystemError("collocation follows the motion of a system, not its derivatives")
        matrices = collocation.transition_matrices(
            family.systems, self.nodes, self.panel_angle, self.fewest_held
        )
        return np.asarray(family.scale @ matrices @ family.inverse_scale, dtype=float)

    def motion_panels(self, system: PeriodicSystem, instants: Sequence[float]) -> MotionPanels:
        """See :class:`facegear.floquet.motion.FollowsMotion`.

        Panels are half as long: along them forces are known with the root of the accuracy of the ends only.
        """
        column = LoadColumn.of(system)
        angle = self.panel_angle / 2.0
        motion = collocation.FreeMotion([system], column, self.nodes, angle, instants, self.fewest_held)
        return motion.motion_panels(column)

    def refined(self) -> Method:
        """Half as many nodes again and shorter panels."""
        return Collocation(self.nodes + self.nodes // 2, 0.7 * self.panel_angle, self.fewest_held)

    def rounding(self, family: Family) -> float:
        """See :class:`Method`: phases are known to the last place of the angle."""
        return family.fastest_angle


#: What :func:`with_method` tries first. Small systems with a rigid-body motion, such as gearboxes of three inertias, go
#: in half the time by :data:`GENERAL`.
FIRST = Collocation(fewest_held=6)

#: What :func:`with_method` takes where collocation does not apply. It estimates the error before its last
#: extrapolation, which is larger than what is left.
GENERAL = AdaptiveMagnus(1e-9)


def with_method(method: Method | None, compute: Callable[[Method], T], otherwise: Method = GENERAL) -> T:
    """Compute something by the method that is named, or by the one that suits: the only place where that is decided.

    Collocation where it applies, else adaptive Magnus, of order 10. One computation, such as a column of a map or a
    curve along speed, has one method throughout, so that what is interpolated in it is smooth.

    Parameters
    ----------
    method : Method, optional
    compute : callable
        Is given the method. Called once more if collocation refuses a system.
    otherwise : Method
        What is taken then.

    Examples
    --------
    >>> drifting = PeriodicSystem([[1.0]], [[0.0]], [[0.0]], (), 1.0)
    >>> with_method(None, lambda method: (method, transition_matrix(drifting, method))[0])
    AdaptiveMagnus(tolerance=1e-09)
    """
    if method is not None:
        require_method(method)
        return compute(method)
    # Asking first whether collocation applies would set it up twice, which is most of the work.
    try:
        return compute(FIRST)
    except UnsuitableSystemError:
        return compute(otherwise)


def require_method(method: object) -> None:
    """Refuse what is no method.

    Raises
    ------
    TypeError
        Saying what it is, and what would be one.
    """
    if isinstance(method, type) or not hasattr(method, "scaled_transition_matrices"):
        raise TypeError(
            "method must be a Collocation, AdaptiveMagnus, Magnus, AlignedStepwise or Stepwise of "
            "facegear.floquet.multipliers or a Radau of facegear.floquet.radau, such as AdaptiveMagnus(), got "
            f"{method!r}"
        )


def transition_matrix(system: PeriodicSystem, method: Method | None = None) -> FloatArray:
    """Floquet transition matrix Φ(T0, 0) of the state (q, q̇) (2-6).

    Parameters
    ----------
    system : PeriodicSystem
    method : Method, optional
        One of the methods of this module; see :func:`with_method` if left out.

    Returns
    -------
    array, shape (2n, 2n)
        Where the period's origin is a breakpoint with a velocity kick, Φ runs from just before it.

    Examples
    --------
    >>> import numpy as np
    >>> import facegear as fg
    >>> free = fg.PeriodicSystem([[1.0]], [[0.0]], [[1.0]], (), period=1.0)
    >>> bool(np.allclose(fg.transition_matrix(free), [[np.cos(1.0), np.sin(1.0)], [-np.sin(1.0), np.cos(1.0)]]))
    True
    """
    return np.asarray(transition_matrices([system], method)[0])


def transition_matrices(systems: Sequence[PeriodicSystem], method: Method | None = None) -> FloatArray:
    """Transition matrices of a family of systems with common size and breakpoints, computed together.

    Parameters
    ----------
    systems : sequence of PeriodicSystem
        V systems; their periods, constant matrices and load parameters may differ.
    method : Method, optional
        See :func:`with_method` if left out.

    Returns
    -------
    array, shape (V, 2n, 2n)
        In the state (q, q̇).

    Raises
    ------
    ValueError
        If sizes, numbers of loads or breakpoints differ.
    """
    family = Family(systems)
    scaled = with_method(method, lambda chosen: chosen.scaled_transition_matrices(family))
    return np.asarray(family.inverse_scale @ scaled @ family.scale, dtype=float)


def multipliers(system: PeriodicSystem, method: Method | None = None) -> ComplexArray:
    """Floquet multipliers, eigenvalues of the transition matrix (2-8), largest modulus first.

    All have about the same absolute error, that of Φ. Of an overdamped motion in a long period no digit is left, and
    what stands for its multiplier may be rounding: :func:`multiplier_errors` tells.

    Returns
    -------
    array of complex, shape (2n,)

    Examples
    --------
    >>> import numpy as np
    >>> import facegear as fg
    >>> free = fg.PeriodicSystem([[1.0]], [[0.0]], [[1.0]], (), period=1.0)
    >>> bool(np.allclose(fg.multipliers(free).real, np.cos(1.0)))
    True
    """
    family = Family([system])
    values = _eigenvalues(with_method(method, lambda chosen: chosen.scaled_transition_matrices(family))[0])
    return np.asarray(values[np.argsort(-np.abs(values), kind="stable")], dtype=complex)


def growth_rate(system: PeriodicSystem, method: Method | None = None) -> float:
    """Growth rate ln(max|λ|)/T0 [1/s] (2-8); the system is unstable where it is positive.

    Where all motions die within a period it is known no better than max|λ|, whose error is relative to 1; minus
    infinity where nothing at all is left.

    Examples
    --------
    >>> import facegear as fg
    >>> body = fg.Body(fg.Drive(26, 130, 3.175e-3), thickness_ratio=0.03)
    >>> model = fg.Transverse(body, fg.MeshLoad(stiffness=0.6, damping=3e-6, mass=1.0))
    >>> [fg.growth_rate(model.system(fg.rad_per_s(speed))) > 0.0 for speed in (530.0, 600.0)]
    [True, False]
    """
    radius = np.abs(multipliers(system, method)[0])
    with np.errstate(divide="ignore"):
        return float(np.log(radius) / system.period)


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
    radii = np.abs(_eigenvalues(disturbed(scaled, family, method))).max(axis=-1)
    return float(max(rounding, np.abs(radii - np.abs(_eigenvalues(scaled)).max()).max()))


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
            finer.append(_eigenvalues(better.scaled_transition_matrices(family))[0])
        rounding = rounding_error(scaled, family, method)
        return cls(
            _eigenvalues(scaled), finer, list(_eigenvalues(disturbed(scaled, family, method))), rounding
        )


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
    another, that is more than Φ itself shows. The changes are always the same ones.
    """
    size = scaled.shape[-1]
    (stretches,), (jumps,) = family.stretches(_STRETCHES)
    whole, *parts = _changes(size, len(stretches) + 1)
    changed = scaled + rounding_error(scaled, family, method) * whole
    places = size + method.rounding(family) / len(stretches)
    arriving, lost = np.eye(size), np.zeros_like(changed)
    with np.errstate(over="ignore", invalid="ignore"):
        for stretch, jump, part in zip(stretches, jumps, parts, strict=True):
            added = np.abs(stretch) @ np.abs(arriving)
            if jump > 0.0:
                added += jump * np.abs(arriving).max()
            lost = stretch @ lost + added * part
            arriving = stretch @ arriving
        lost *= places * np.finfo(float).eps
    # Frozen motions may grow beyond double precision where those of the system do not.
    return np.asarray(changed + lost if np.isfinite(lost).all() else changed, dtype=float)


@lru_cache(maxsize=64)
def _changes(size: int, count: int) -> FloatArray:
    """Random matrices of unit norm, always the same ones, shape (count, 4, size, size)."""
    changes = np.random.default_rng(0).normal(size=(count, _CHANGES, size, size))
    return np.asarray(changes / np.linalg.norm(changes, 2, axis=(-2, -1), keepdims=True), dtype=float)


def _eigenvalues(matrices: FloatArray) -> ComplexArray:
    if not np.isfinite(matrices).all():
        raise ArithmeticError("transition matrix is not finite: the motion grows beyond double precision")
    return np.asarray(np.linalg.eigvals(matrices), dtype=complex)
