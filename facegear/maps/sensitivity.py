"""How Floquet multipliers, growth rates and borders of tongues change with the parameters of a model.

In the fraction x = t/T0 of the period X' = B X with B = T0 A. Its derivative by a parameter p obeys the same
equation with a further term, so that the state and its derivative together have the transition matrix

    d/dx [X, dX/dp] = [[B, 0], [dB/dp, B]] [X, dX/dp]   →   [[Φ, 0], [dΦ/dp, Φ]],

which the methods of :mod:`facegear.floquet.methods` take as any other. A simple multiplier λ with the left and
right eigenvectors y and x of Φ then changes by dλ = yᴴ dΦ x / (yᴴ x), and a border of a tongue, where max|λ| = 1, moves
by dΩ/dp = −(∂|λ|/∂p) / (∂|λ|/∂Ω).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from facegear.floquet.loads import ContactLoad
from facegear.floquet.methods import Method, with_method
from facegear.floquet.models import Model, parameter_path, replace_at, value_of
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import Side
from facegear.floquet.series import ChebyshevSeries
from facegear.floquet.stepping import Family
from facegear.support.parameters import integer_at_least, positive
from facegear.support.threads import one_thread
from facegear.support.types import ComplexArray, FloatArray

SPEED = "speed"
"""Name under which the speed [rad/s] stands among the parameters."""

# Matrices are read off the model at nodes this far around the parameter's value, relative to it.
_REACH = 0.05
_NODES = 11
# Largest part of the last coefficients of the polynomial through them: far above rounding, far below any error
# that would show.
_TAIL = 1e-12
# Relative distance below which two multipliers are one: the derivative has then lost half of all digits.
_DOUBLE = 1e-7
# Relative distance of moduli below which two multipliers are critical at once.
_SAME_MODULUS = 1e-9
# How far from 1 the spectral radius may be at a speed that is given as a border.
_BORDER = 1e-5


@dataclass(frozen=True, eq=False)
class SystemDerivative:
    """Derivatives of everything a periodic system holds by one parameter; shape vectors do not change.

    Attributes
    ----------
    mass, damping, stiffness : array, shape (n, n)
        dM, dC, dK of the constant parts, in their units per unit of the parameter.
    load_mass, load_damping, load_stiffness : array, shape (p,)
        dm, dc, dk of the loads.
    period : float
        dT0.
    """

    mass: FloatArray
    damping: FloatArray
    stiffness: FloatArray
    load_mass: FloatArray
    load_damping: FloatArray
    load_stiffness: FloatArray
    period: float


def system_derivative(model: Model, speed: float, parameter: str) -> SystemDerivative:
    """Differentiate the matrices, load parameters and period of a model by one of its parameters.

    They are read at eleven Chebyshev nodes within five percent of the parameter's value and the polynomial through
    them is differentiated: exact but for rounding where they are polynomials of the parameter, as masses,
    stiffnesses and dampings are, and to twelve digits for other smooth functions.

    Parameters
    ----------
    model : Model
        A frozen dataclass with a method ``system(speed)``.
    speed : float
        Speed [rad/s].
    parameter : str
        Name as for :func:`facegear.floquet.models.replace_parameter`, or ``"speed"``.

    Raises
    ------
    TypeError, ValueError
        If there is no such parameter, its value is 0 and sets no scale, or the shape vectors depend on it.
    ArithmeticError
        If a matrix does not vary smoothly with the parameter.
    """
    value = parameter_value(model, speed, parameter)
    if value == 0.0:
        raise ValueError(
            f"{parameter} is 0 and sets no scale for its derivative; give the model a small value instead"
        )
    half = _REACH * abs(value)
    nodes = ChebyshevSeries.points_of(value - half, value + half, _NODES - 1).tolist()
    # Which field it is takes longer to find than to replace.
    path = () if parameter == SPEED else parameter_path(model, parameter)
    systems = [_system(model, speed, path, node) for node in nodes]
    present = systems[_NODES // 2]
    for system in systems:
        _same_shapes(present, system, parameter)

    def derivative(name: str, parts: Sequence[Any]) -> FloatArray:
        values = np.array(parts, dtype=float)
        # Rounding alone is no dependence.
        constant = (values == values[0]).all(axis=0)
        if constant.all():
            return np.zeros(values.shape[1:])
        series = ChebyshevSeries(value - half, value + half, values)
        sizes = np.abs(series.coefficients)
        if sizes[-2:].max() > _TAIL * sizes.max():
            raise ArithmeticError(
                f"{name} does not vary smoothly with {parameter} within {100 * _REACH:.0f} % of {value:.6g}"
            )
        return np.where(constant, 0.0, series.derivative(value))

    def of_loads(name: str) -> FloatArray:
        return derivative(
            f"{name} of the loads", [[getattr(x, name) for x in s.loads] for s in systems]
        ).reshape(-1)

    loads = {
        name: of_loads(name) if present.loads else np.zeros(0) for name in ("mass", "damping", "stiffness")
    }
    return SystemDerivative(
        mass=derivative("mass", [system.mass for system in systems]),
        damping=derivative("damping", [system.damping for system in systems]),
        stiffness=derivative("stiffness", [system.stiffness for system in systems]),
        load_mass=loads["mass"],
        load_damping=loads["damping"],
        load_stiffness=loads["stiffness"],
        period=float(derivative("period", [[system.period] for system in systems])[0]),
    )


def parameter_value(model: Model, speed: float, parameter: str) -> float:
    """Present value of a parameter of a model, or the speed for the name ``"speed"``."""
    if parameter == SPEED:
        return positive("speed", speed, "rad/s")
    return value_of(model, parameter)


def _system(model: Model, speed: float, path: tuple[str, ...], value: float) -> PeriodicSystem:
    """System with the parameter at the end of a path replaced, or the speed for an empty one."""
    return replace_at(model, path, value).system(speed) if path else model.system(value)


def _same_shapes(first: PeriodicSystem, second: PeriodicSystem, parameter: str) -> None:
    """Refuse a parameter that moves or reshapes the loads."""
    for one, other in zip(first.loads, second.loads, strict=True):
        for a, b in ((one.shape, other.shape), (one.weight, other.weight)):
            if a is b:
                continue
            if (
                a is None
                or b is None
                or a.coefficients.shape != b.coefficients.shape
                or np.abs(a.breakpoints - b.breakpoints).max() > 1e-12
                or np.abs(a.coefficients - b.coefficients).max() > 1e-12 * a.largest
            ):
                raise ValueError(
                    f"shape vectors of the loads depend on {parameter}: only parameters of matrices, loads and the "
                    "period have derivatives here"
                )


class _VariedFamily(Family):
    """State and its derivative by each of several parameters, in place of the state alone.

    Derivatives are by ln p, so that they have the size of the state.
    """

    def __init__(
        self, system: PeriodicSystem, derivatives: Sequence[SystemDerivative], values: FloatArray
    ) -> None:
        super().__init__([system])
        if any(self.jumps):
            raise ValueError(
                "system has jumps of the state (its own, or velocity kicks where the slope of a shape with total rate "
                "jumps under a mass), whose derivatives are not known here"
            )
        self._single = Family([system])
        self._derivatives = derivatives
        self._values = values
        # What product() takes for the number of systems and half the number of states.
        self.systems = [system] * len(derivatives)
        self.size = 2 * self._single.size

    def state_matrices(self, fraction: FloatArray, side: Side = "right") -> FloatArray:
        """Return [[B, 0], [dB/d ln p, B]] in scaled coordinates, shape (P, m, 4n, 4n)."""
        single = self._single
        n = single.size
        matrices = single.assembled(fraction, side)
        plain = single.state_of(matrices, fraction.size)[0]
        blocks = np.zeros((len(self._derivatives), fraction.size, 4 * n, 4 * n))
        blocks[..., : 2 * n, : 2 * n] = plain
        blocks[..., 2 * n :, 2 * n :] = plain
        changes = self._values[:, None, None, None] * self._changes(matrices, fraction, side)
        blocks[..., 2 * n :, : 2 * n] = single.scale @ changes @ single.inverse_scale
        return blocks

    def _changes(
        self, matrices: tuple[FloatArray, FloatArray, FloatArray], fraction: FloatArray, side: Side
    ) -> FloatArray:
        """d(T0 A)/dp of each parameter at fractions (m,), from M, C and K there, shape (P, m, 2n, 2n)."""
        system, count = self._single.systems[0], len(self._derivatives)
        n, period = system.size, system.period
        mass, damping, stiffness = (np.broadcast_to(part[0], (fraction.size, n, n)) for part in matrices)
        inverse = np.linalg.inv(mass)
        accelerations = inverse @ np.concatenate([stiffness, damping], axis=-1)

        def of_each(name: str) -> FloatArray:
            """One kind of derivatives by each parameter, shape (P, ...)."""
            return np.array([getattr(by, name) for by in self._derivatives], dtype=float)

        d_mass, d_damping, d_stiffness = (
            np.repeat(of_each(name)[:, None], fraction.size, axis=1)
            for name in ("mass", "damping", "stiffness")
        )
        d_period = of_each("period")[:, None, None, None]
        # φ̇ = φ'/T0 and φ̈ = φ''/T0² change with the period too.
        shorter = d_period / period
        of_loads = [of_each(f"load_{name}") for name in ("mass", "damping", "stiffness")]
        for i, load in enumerate(system.loads):
            plain, slope, bend = _dyads(load, fraction, side)
            dm, dc, dk = (part[:, i, None, None, None] for part in of_loads)
            d_mass += dm * plain
            d_damping += dc * plain
            d_stiffness += dk * plain
            if load.rate == "total":
                d_stiffness += (dc - load.damping * shorter) / period * slope
                d_damping += 2.0 * (dm - load.mass * shorter) / period * slope
                d_stiffness += (dm - 2.0 * load.mass * shorter) / period**2 * bend
        changed = np.concatenate([d_stiffness, d_damping], axis=-1) - d_mass @ accelerations
        result = np.zeros((count, fraction.size, 2 * n, 2 * n))
        result[..., :n, n:] = d_period * np.eye(n)
        result[..., n:, :] = -d_period * accelerations - period * inverse @ changed
        return result


def _dyads(load: ContactLoad, fraction: FloatArray, side: Side) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return w φφᵀ, w φφ'ᵀ and w φφ''ᵀ of a load at fractions (m,), each of shape (m, n, n)."""
    phi = load.shape(fraction, side)
    force = (phi if load.weight is None else phi * load.weight(fraction, side))[..., :, None]
    parts = (phi, load.slope(fraction, side), load.curvature(fraction, side))
    first, second, third = (force * part[..., None, :] for part in parts)
    return first, second, third


def _varied(model: Model, speed: float, parameters: Sequence[str]) -> tuple[_VariedFamily, FloatArray]:
    values = np.array([parameter_value(model, speed, name) for name in parameters])
    derivatives = [system_derivative(model, speed, name) for name in parameters]
    return _VariedFamily(model.system(speed), derivatives, values), values


def _split(family: _VariedFamily, method: Method | None) -> tuple[FloatArray, FloatArray]:
    """Φ and dΦ/d ln p, both in scaled coordinates."""
    both = with_method(method, lambda chosen: chosen.scaled_transition_matrices(family))
    half = family.size
    return both[0, :half, :half], both[:, half:, :half]


def transition_derivatives(
    model: Model, speed: float, parameters: Sequence[str], method: Method | None = None
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Transition matrix and its derivatives by parameters, in the scaled state of a family, and those of the period.

    Parameters
    ----------
    model, speed, parameters, method
        As for :func:`sensitivity`, errors too.

    Returns
    -------
    transition : array, shape (2n, 2n)
        S Φ S⁻¹.
    derivatives : array, shape (P, 2n, 2n)
        S dΦ/dp S⁻¹.
    periods : array, shape (P,)
        dT0/dp [s per unit of the parameter].
    """
    integer_at_least("number of parameters", len(parameters), 1)
    family, values = _varied(model, speed, parameters)
    matrix, scaled = _split(family, method)
    return matrix, scaled / values[:, None, None], np.array([by.period for by in family._derivatives])


@dataclass(frozen=True, eq=False)
class Sensitivity:
    """Critical multiplier and growth rate of a model at a speed, with their derivatives by P parameters.

    Attributes
    ----------
    parameters : tuple of str
    values : array, shape (P,)
        Present values of the parameters.
    multiplier : complex
        Multiplier λ of largest modulus; of a conjugate pair the one above the real axis.
    multiplier_derivatives : complex array, shape (P,)
        dλ/dp.
    growth_rate : float
        ρ = ln|λ|/T0 [1/s].
    growth_rate_derivatives : array, shape (P,)
        dρ/dp [1/s per unit of the parameter].
    """

    parameters: tuple[str, ...]
    values: FloatArray
    multiplier: complex
    multiplier_derivatives: ComplexArray
    growth_rate: float
    growth_rate_derivatives: FloatArray

    @property
    def logarithmic_derivatives(self) -> FloatArray:
        """Derivatives of ln|λ|, shape (P,): what counts at a border, where the period plays no part."""
        return np.asarray((self.multiplier_derivatives / self.multiplier).real, dtype=float)


@one_thread()
def sensitivity(
    model: Model, speed: float, parameters: Sequence[str], method: Method | None = None
) -> Sensitivity:
    """Differentiate the critical multiplier and the growth rate.

    Parameters
    ----------
    model : Model
    speed : float
        Speed [rad/s].
    parameters : sequence of str
        P names, as for :func:`system_derivative`.
    method : Method, optional
        See :func:`facegear.floquet.methods.with_method` if left out; collocation does not apply.

    Returns
    -------
    Sensitivity

    Raises
    ------
    ArithmeticError
        If the critical multiplier is double or nearly so, or two different ones have the same modulus: neither has
        a derivative. Where damping is absent that is so at every border.
    TypeError, ValueError
        As :func:`system_derivative`; ValueError for systems with velocity kicks.
    """
    matrix, changes, d_period = transition_derivatives(model, speed, parameters, method)
    critical, left, right = _critical(matrix, speed)
    d_multiplier = np.einsum("i,pij,j->p", left, changes, right)
    period = model.system(speed).period
    growth = math.log(abs(critical)) / period
    d_growth = (d_multiplier / critical).real / period - growth * d_period / period
    values = np.array([parameter_value(model, speed, name) for name in parameters])
    return Sensitivity(tuple(parameters), values, critical, d_multiplier, growth, d_growth)


def _critical(matrix: FloatArray, speed: float) -> tuple[complex, ComplexArray, ComplexArray]:
    """Multiplier of largest modulus, its left eigenvector (a row) and its right one, their product 1."""
    values, vectors = np.linalg.eig(matrix)
    order = np.argsort(-np.abs(values) - 1e-12 * (values.imag > 0.0), kind="stable")
    first = int(order[0])
    critical = complex(values[first])
    others = np.delete(values, first)
    apart = np.abs(others - critical)
    rivals = np.abs(others - critical.conjugate()) > _DOUBLE * abs(critical)
    rivals &= np.abs(np.abs(others) - abs(critical)) <= _SAME_MODULUS * abs(critical)
    if (apart <= _DOUBLE * abs(critical)).any() or rivals.any():
        other = complex(others[np.where(rivals, 0.0, apart).argmin()])
        raise ArithmeticError(
            f"critical multiplier {critical:.9g} at {speed:.9g} rad/s has no derivative: another one, {other:.9g}, "
            "coincides with it or has the same modulus"
        )
    left = np.linalg.inv(vectors)[first]
    return critical, left.astype(complex), vectors[:, first].astype(complex)


def border_derivatives(
    model: Model, speed: float, parameters: Sequence[str], method: Method | None = None
) -> FloatArray:
    """Differentiate the speed of a border by parameters, dΩ/dp = −(∂|λ|/∂p)/(∂|λ|/∂Ω).

    Parameters
    ----------
    model : Model
    speed : float
        A border of a tongue [rad/s], where max|λ| = 1.
    parameters, method
        As for :func:`sensitivity`; ``"speed"`` is not among them.

    Returns
    -------
    array, shape (P,)
        [rad/s per unit of the parameter].

    Raises
    ------
    ValueError
        If the speed is not a border: max|λ| differs from 1 by more than 1e-5.
    ArithmeticError
        As :func:`sensitivity`.
    """
    found = sensitivity(model, speed, (*parameters, SPEED), method)
    if abs(abs(found.multiplier) - 1.0) > _BORDER:
        raise ValueError(
            f"speed must be a border of a tongue, where max|λ| = 1; at {speed:.9g} rad/s it is "
            f"{abs(found.multiplier):.9g}"
        )
    change = found.logarithmic_derivatives
    return np.asarray(-change[:-1] / change[-1], dtype=float)
