"""How all characteristic exponents of a model change with its parameters, decay rates and frequencies alike.

With left and right eigenvectors y and x of Φ at a simple multiplier λ, dλ = yᴴ dΦ x / (yᴴ x), and the exponent
Λ = ln(λ)/T0 changes by dΛ = dλ/(λ T0) − Λ dT0/T0.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment

from facegear.floquet.methods import Method
from facegear.floquet.models import Model, system_at
from facegear.floquet.stepping import Family
from facegear.maps.sensitivity import transition_derivatives
from facegear.support.types import ComplexArray, FloatArray

# Relative distance below which two multipliers are one: half of all digits of a derivative are then lost.
_DOUBLE = 1e-7
# Modulus, relative to the norm of Φ, below which half of all digits of a multiplier are lost.
_LOST = 1e-8


@dataclass(frozen=True, eq=False)
class ExponentSensitivity:
    """Characteristic exponents of a model at a speed, and their derivatives by P parameters.

    Attributes
    ----------
    parameters : tuple of str
    exponents : complex array, shape (2n,)
        Λ [1/s], imaginary parts between −π/T0 and π/T0, slowest decay first; of a conjugate pair the one above the
        real axis first.
    derivatives : complex array, shape (2n, P)
        dΛ/dp [1/s per unit of the parameter] of that Λ. By the speed, an image Λ + 2πik/T0 has k times dω more.
    right, left : complex array, shape (2n, 2n)
        Columns x and rows yᴴ of Φ in the state (q, q̇), yᴴ x = 1.
    scale : array, shape (2n, 2n)
        To energy-like coordinates of the state, in which vectors are compared.
    period : float
        T0 [s].
    """

    parameters: tuple[str, ...]
    exponents: ComplexArray
    derivatives: ComplexArray
    right: ComplexArray
    left: ComplexArray
    scale: FloatArray
    period: float

    @property
    def oscillating(self) -> list[int]:
        """Numbers of the exponents above the real axis and below the edge π/T0, slowest decay first."""
        angles = self.exponents.imag * self.period
        return [int(i) for i in np.flatnonzero((angles > 1e-9) & (angles < np.pi - 1e-9))]

    def numbers_in(self, other: ExponentSensitivity) -> list[int]:
        """Return the number that each exponent has in another, nearby set: the two whose vectors fit best."""
        rows, columns = self.left @ np.linalg.inv(self.scale), self.scale @ other.right
        fit = np.abs(rows @ columns) / np.linalg.norm(columns, axis=0)
        fit /= np.linalg.norm(rows, axis=1)[:, None]
        return [int(number) for number in linear_sum_assignment(fit, maximize=True)[1]]


def exponent_sensitivity(
    model: Model, speed: float, parameters: Sequence[str], method: Method | None = None
) -> ExponentSensitivity:
    """Differentiate all characteristic exponents of a model by some of its parameters.

    Parameters
    ----------
    model : Model
    speed : float
        [rad/s].
    parameters : sequence of str
        P names, as for :func:`facegear.maps.sensitivity.system_derivative`.
    method : Method, optional
        As for :func:`facegear.maps.sensitivity.sensitivity`.

    Returns
    -------
    ExponentSensitivity

    Raises
    ------
    ArithmeticError
        If two multipliers coincide, or one is so small that rounding has taken half of its digits.
    TypeError, ValueError
        As :func:`facegear.maps.sensitivity.sensitivity`.

    Examples
    --------
    >>> from facegear.mechanics.classical import Mathieu
    >>> found = exponent_sensitivity(Mathieu(depth=0.2, damping_ratio=0.1), 1.3, ["damping_ratio"])
    >>> found.derivatives.real.round(9)
    array([[-1.],
           [-1.]])
    """
    transition, changes, d_period = transition_derivatives(model, speed, parameters, method)
    system = system_at(model, speed)
    period, family = system.period, Family([system])
    values, right = np.linalg.eig(transition)
    order = np.lexsort((-values.imag, -np.abs(values).round(12)))
    values, right = values[order].astype(complex), right[:, order].astype(complex)
    distances = np.abs(values[:, None] - values) + np.diag(np.full(values.size, np.inf))
    _require_known(values, distances, float(np.linalg.norm(transition, 2)), speed)
    left = np.linalg.inv(right)
    d_values = np.einsum("mi,pij,jm->mp", left, changes, right)
    exponents = np.log(values) / period
    derivatives = d_values / (values[:, None] * period) - exponents[:, None] * d_period / period
    return ExponentSensitivity(
        tuple(parameters),
        exponents,
        derivatives,
        np.asarray(family.inverse_scale @ right, dtype=complex),
        np.asarray(left @ family.scale, dtype=complex),
        family.scale,
        period,
    )


def _require_known(values: ComplexArray, distances: FloatArray, norm: float, speed: float) -> None:
    """Refuse multipliers without a derivative, or without enough digits to have one."""
    lost = np.abs(values) < _LOST * norm
    if lost.any():
        raise ArithmeticError(
            f"multiplier {complex(values[lost][0]):.3g} at {speed:.9g} rad/s is lost in the rounding of a transition "
            f"matrix of norm {norm:.3g}: that motion dies within the period; take a higher speed"
        )
    double = distances.min(axis=1) < _DOUBLE * np.abs(values)
    if double.any():
        raise ArithmeticError(
            f"multiplier {complex(values[double][0]):.9g} at {speed:.9g} rad/s is a double one and has no derivative"
        )
