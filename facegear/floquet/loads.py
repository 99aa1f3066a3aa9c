"""What varies within the period of a system: loads of rank one, and jumps of the state.

Every mesh load of a face-gear drive is felt through one displacement u = φ(t)ᵀq − e(t) and answers with one force. The
system that such loads act on is that of :mod:`facegear.floquet.periodic`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from facegear.floquet.piecewise import PiecewiseChebyshev, Side, merge_breakpoints, real_array
from facegear.support.parameters import keep, nonnegative, one_of, within
from facegear.support.types import FloatArray

Rate = Literal["frozen", "total"]

#: Part of the largest slope below which a jump of it is rounding of the fit.
ROUNDING_OF_A_FIT = 1e-11


@dataclass(frozen=True, eq=False)
class ContactLoad:
    """One rank-one load: force φ w [m ü + c u̇ + k u] on u = φᵀq − e, e being 0 unless given.

    Parameters
    ----------
    shape : PiecewiseChebyshev
        Shape vector φ, n components.
    stiffness, damping, mass : float
        k [N/m], c [N s/m], m [kg] (or rotational units, as the coordinates have it), not negative.
    rate : {"frozen", "total"}
        Without e, "frozen": u̇ = φᵀq̇, ü = φᵀq̈ (the transverse chapters). "total": the derivative goes through the
        shape vector, u̇ = φᵀq̇ + φ̇ᵀq, ü = φᵀq̈ + 2φ̇ᵀq̇ + φ̈ᵀq (chapter 7). A jump of φ then means that contact
        is made or lost and gives no impulse; a jump of the slope φ̇ gives the mass a kick
        (:meth:`facegear.floquet.periodic.PeriodicSystem.velocity_kicks`).
    weight : PiecewiseChebyshev, optional
        Scalar periodic factor w of the force, for loads whose strength varies (Mathieu, Hill, Meissner, pairs that
        share a load). Not negative where the load has a mass, and without a jump where that mass is kicked.
    transmission_error : PiecewiseChebyshev, optional
        Scalar e(t) [m] (or angle) by which the surfaces in contact depart from their place when nothing loads them. Its
        derivatives are taken from those of u whatever the rate. A jump of e means that another pair takes over and
        gives no impulse; under a mass neither e nor its slope may jump.

    Raises
    ------
    TypeError, ValueError
        Naming the parameter and what would be valid.

    Examples
    --------
    A spring of 4 N/m whose strength varies as in Mathieu's equation, on the one coordinate there is:

    >>> import numpy as np
    >>> import facegear as fg
    >>> shape = fg.PiecewiseChebyshev.constant([1.0])
    >>> factor = fg.PiecewiseChebyshev.fit(lambda s, piece: 1.0 + 0.2 * np.cos(2.0 * np.pi * s)[:, None], [0.0])
    >>> load = fg.ContactLoad(shape, stiffness=4.0, weight=factor)
    >>> round(float(load.weight(0.5)[0]), 12)
    0.8
    """

    shape: PiecewiseChebyshev
    stiffness: float = 0.0
    damping: float = 0.0
    mass: float = 0.0
    rate: Rate = "frozen"
    weight: PiecewiseChebyshev | None = None
    transmission_error: PiecewiseChebyshev | None = None

    def __post_init__(self) -> None:
        if not isinstance(self.shape, PiecewiseChebyshev):
            raise TypeError(f"shape must be a PiecewiseChebyshev; got {type(self.shape).__name__}")
        for name in ("stiffness", "damping", "mass"):
            value = getattr(self, name)
            keep(self, **{name: nonnegative(name, value)})
        one_of("rate", self.rate, ("frozen", "total"))
        for name in ("weight", "transmission_error"):
            function = getattr(self, name)
            if function is not None and not isinstance(function, PiecewiseChebyshev):
                raise TypeError(f"{name} must be a PiecewiseChebyshev or None; got {type(function).__name__}")
            if function is not None and function.components != 1:
                raise ValueError(f"{name} must have one component; got {function.components}")
        if self.mass > 0.0:
            self._require_steady_mass()
        if self.rate == "total" and self.mass > 0.0:
            jump = float(np.abs(self.shape.jumps()).max())
            if jump > 1e-9 * self.shape.largest:
                raise ValueError(
                    f"mass must be 0 where a shape vector with total rate jumps; got mass {self.mass!r} "
                    f"and a jump of {jump:.3g}: a mass cannot be moved by a finite distance in no time"
                )

    def _require_steady_mass(self) -> None:
        """Refuse a weight or a transmission error that a mass cannot follow."""
        weight, error = self.weight, self.transmission_error
        if weight is not None and _smallest(weight) < -1e-9 * weight.largest:
            raise ValueError(
                f"weight must not be negative for a load with a mass; got {_smallest(weight):.3g} and mass "
                f"{self.mass!r}"
            )
        if weight is not None and self.rate == "total":
            slopes = np.abs(self.slope.jumps()).max(axis=1)
            kinks = self.slope.breakpoints[slopes > ROUNDING_OF_A_FIT * self.slope.largest]
            jumps = np.abs(weight(kinks) - weight(kinks, "left"))
            if jumps.max(initial=0.0) > 1e-9 * weight.largest:
                raise ValueError(
                    "weight must not jump where the slope of a shape vector with total rate jumps under a mass; got a "
                    f"jump of {jumps.max():.3g} and mass {self.mass!r}"
                )
        if error is not None:
            jump = max(float(np.abs(error.derivative(order).jumps()).max()) for order in (0, 1))
            if jump > 1e-9 * max(error.largest, error.derivative().largest):
                raise ValueError(
                    "transmission_error must not jump, nor its slope, for a load with a mass; got a jump of "
                    f"{jump:.3g} and mass {self.mass!r}"
                )

    @property
    def slope(self) -> PiecewiseChebyshev:
        """dφ/dx, x the fraction of the period."""
        return self.shape.derivative(1)

    @property
    def curvature(self) -> PiecewiseChebyshev:
        """d²φ/dx², x the fraction of the period, impulses at slope jumps left out."""
        return self.shape.derivative(2)

    @cached_property
    def breakpoints(self) -> FloatArray:
        """Instants where φ, w or e is not smooth, fractions of the period, ascending."""
        others = [x.breakpoints for x in (self.weight, self.transmission_error) if x is not None]
        return merge_breakpoints([self.shape.breakpoints, *others]) if others else self.shape.breakpoints

    def moved(self, change: Callable[[PiecewiseChebyshev], PiecewiseChebyshev]) -> ContactLoad:
        """Return the load with another course of time: shape, weight and transmission error changed alike."""
        weight, error = (None if x is None else change(x) for x in (self.weight, self.transmission_error))
        return replace(self, shape=change(self.shape), weight=weight, transmission_error=error)


@dataclass(frozen=True, eq=False)
class StateJump:
    """A jump of the state X = (q, q̇) at an instant of the period: X⁺ = J X⁻.

    For contact laws that act by impulses or start another motion; both displacement and velocity may jump.

    Parameters
    ----------
    fraction : float
        Instant, as a fraction of the period, in [0, 1).
    matrix : array_like, shape (2n, 2n)
        J.

    Raises
    ------
    TypeError, ValueError
        Naming the parameter and what would be valid.

    Examples
    --------
    The impact of a point with a coefficient of restitution of 0.8 turns its velocity round:

    >>> import facegear as fg
    >>> jump = fg.StateJump(fraction=0.5, matrix=[[1.0, 0.0], [0.0, -0.8]])
    >>> jump.matrix.shape
    (2, 2)
    """

    fraction: float
    matrix: FloatArray

    def __post_init__(self) -> None:
        fraction = within("fraction", self.fraction, 0.0, 1.0)
        if fraction == 1.0:
            raise ValueError(
                "fraction must be less than 1, the end of the period is the start of the next; got 1.0"
            )
        matrix = real_array(self.matrix, "matrix", 2)
        if matrix.shape[0] != matrix.shape[1]:
            raise ValueError(f"matrix must be square, 2n rows for n coordinates; got shape {matrix.shape}")
        keep(self, fraction=fraction, matrix=matrix)


def weighted_shape(load: ContactLoad, fraction: ArrayLike, side: Side = "right") -> FloatArray:
    """Return w φ of a load at fractions of the period, shape (..., n)."""
    shape = load.shape(fraction, side)
    return shape if load.weight is None else np.asarray(shape * load.weight(fraction, side), dtype=float)


def _smallest(function: PiecewiseChebyshev) -> float:
    """Smallest value of a function at many instants of each piece, ends included."""
    places = (1.0 - np.cos(np.linspace(0.0, np.pi, 8 * function.degree + 9))) / 2.0
    inside = function.breakpoints[:, None] + function.lengths[:, None] * places[1:-1]
    ends = [function(function.breakpoints), function(function.breakpoints, "left")]
    return float(min(x.min() for x in (function(inside), *ends)))
