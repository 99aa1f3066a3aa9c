"""Ways to compute a Floquet transition matrix, each a small frozen dataclass (section 2.2.1).

- :class:`Stepwise`: the text's rule, A(t) held at its midpoint value in equal sub-intervals (2-9 to 2-11);
- :class:`AlignedStepwise`: the same with sub-intervals that end where A(t) jumps or kinks;
- :class:`Magnus`: fourth order, aligned, for any system, with a fixed number of sub-intervals;
- :class:`AdaptiveMagnus`: the same, refined until an error estimate is met;
- :class:`Collocation`: contact-force collocation, fast and spectrally accurate where it applies.

:func:`with_method` says which of them is used where none is named; the package's docstring compares them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import ClassVar, Protocol, TypeVar, runtime_checkable

import numpy as np

from facegear.floquet import collocation
from facegear.floquet.free_modes import UnsuitableSystemError
from facegear.floquet.free_systems import FreeSystems
from facegear.floquet.gauss_panels import within_reach
from facegear.floquet.load_columns import LoadColumn
from facegear.floquet.motion import MotionPanels
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.stepping import SHARED_STEPS, Family, aligned_edges, gauss_magnus, midpoint
from facegear.support.parameters import integer_at_least, keep, within
from facegear.support.types import FloatArray

T = TypeVar("T")


class Method(Protocol):
    """A way to compute the Floquet transition matrix."""

    @property
    def together(self) -> float:
        """Systems of different periods to hand over at once, at most: beyond, they differ too much for common steps.

        Infinity where the method looks itself which of any number go together.
        """
        ...

    def scaled_transition_matrices(self, family: Family) -> FloatArray:
        """S Φ S⁻¹ of each system of a family, in its scaled coordinates, shape (V, 2n, 2n)."""
        ...

    def refined(self) -> Method:
        """Return a method to judge this one by: clearly more accurate, and blind to other things."""
        ...

    def rounding(self, family: Family) -> float:
        """Return how much rounding entries of Φ gather on the way, in units of the last place of the largest one."""
        ...


@runtime_checkable
class PreparesLoads(Protocol):
    """A method that does once what systems which differ in their load parameters have in common."""

    def along_loads(
        self, system: PeriodicSystem, column: LoadColumn, scale: FloatArray
    ) -> Callable[[LoadColumn], FloatArray]:
        """Prepare a system for load parameters up to those of a column: S Φ S⁻¹ of any of them, (V, 2n, 2n)."""
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

    together: ClassVar[float] = SHARED_STEPS

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

    together: ClassVar[float] = SHARED_STEPS

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

    together: ClassVar[float] = SHARED_STEPS

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

    together: ClassVar[float] = SHARED_STEPS

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

    together: ClassVar[float] = math.inf

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

    def along_loads(
        self, system: PeriodicSystem, column: LoadColumn, scale: FloatArray
    ) -> Callable[[LoadColumn], FloatArray]:
        """See :class:`PreparesLoads`."""
        motion = collocation.FreeMotion(
            FreeSystems.of([system], column, self.fewest_held), self.nodes, self.panel_angle
        )
        to = scale @ motion.modes.state_from_real()[0]
        back = motion.modes.real_from_state()[0] @ np.linalg.inv(scale)
        return lambda part: np.asarray(to @ motion.transition_matrices(part) @ back, dtype=float)

    def motion_panels(self, system: PeriodicSystem, instants: Sequence[float]) -> MotionPanels:
        """See :class:`facegear.floquet.motion.FollowsMotion`.

        Panels are half as long: along them forces are known with the root of the accuracy of the ends only.
        """
        column = LoadColumn.of(system)
        free = FreeSystems.of([system], column, self.fewest_held)
        motion = collocation.FreeMotion(free, self.nodes, self.panel_angle / 2.0, instants)
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
    >>> from facegear.floquet.multipliers import transition_matrix
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
