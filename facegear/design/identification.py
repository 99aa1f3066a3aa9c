"""What measured frequencies and decay rates say of the losses of a model's parameters.

A loss d makes a parameter p (1 − d). Characteristic exponents Λ(d) of some motions are measured with independent
normal errors of known deviations; the losses that fit best are least squares over the deviations. No unbiased estimate
scatters less than the Cramér–Rao bound (GᵀG)⁻¹, G the derivatives of what is measured over the deviations, and least
squares attain it where errors are small (Kay, Fundamentals of Statistical Signal Processing: Estimation Theory, 1993).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import least_squares
from scipy.stats import chi2

from facegear.floquet.models import Model, replace_parameter, require_model, value_of
from facegear.maps.exponents import ExponentSensitivity, exponent_sensitivity
from facegear.support.parameters import finite_array, integer_at_least, integer_within, keep, positive
from facegear.support.types import ComplexArray, FloatArray

# Losses between which a fit looks: nothing is left of a part, or it is twice as stiff.
_LEAST, _MOST = -1.0, 0.95
# Condition of G from which on some mix of losses is not told at all.
_UNTOLD = 1e8


@dataclass(frozen=True, eq=False)
class Survey:
    """Measurement of some characteristic exponents of a model, from which losses of some parameters are to be told.

    Parameters
    ----------
    model : Model
        The intact one.
    speed : float
        [rad/s].
    parameters : sequence of str
        P names of parameters that may have lost something, as for
        :func:`facegear.floquet.models.replace_parameter`.
    motions : sequence of int
        m motions that are measured, numbered among the oscillating ones of the intact model, slowest decay first.
    deviations : array_like, shape (m, 2)
        Standard deviations of decay rate and frequency, Re Λ and Im Λ [1/s, rad/s]; infinite for what is not measured.

    Raises
    ------
    TypeError, ValueError
        Naming the parameter and what would be valid.
    ArithmeticError
        If the intact model has exponents without derivatives, see
        :func:`facegear.maps.exponents.exponent_sensitivity`.
    """

    model: Model
    speed: float
    parameters: tuple[str, ...]
    motions: tuple[int, ...]
    deviations: FloatArray

    def __post_init__(self) -> None:
        require_model(self.model)
        keep(self, speed=positive("speed", self.speed, "rad/s"))
        keep(self, parameters=tuple(self.parameters), motions=tuple(self.motions))
        integer_at_least("number of parameters", len(self.parameters), 1)
        integer_at_least("number of motions", len(self.motions), 1)
        count = len(self.intact.oscillating)
        for number, motion in enumerate(self.motions):
            integer_within(f"motions[{number}]", motion, 0, count - 1)
        if len(set(self.motions)) < len(self.motions):
            raise ValueError(f"motions must differ, got {self.motions}")
        deviations = np.array(self.deviations, dtype=float)
        if deviations.shape != (len(self.motions), 2):
            raise ValueError(
                f"deviations must have shape ({len(self.motions)}, 2), of decay rate and frequency of each motion; got "
                f"shape {deviations.shape}"
            )
        if np.isnan(deviations).any() or (deviations <= 0.0).any() or np.isinf(deviations).all():
            raise ValueError(
                "deviations must be greater than 0, infinite where nothing is measured, not all of them; got "
                f"{deviations.tolist()}"
            )
        keep(self, deviations=deviations)

    @cached_property
    def intact(self) -> ExponentSensitivity:
        """Exponents of the intact model and their derivatives by the parameters."""
        return exponent_sensitivity(self.model, self.speed, self.parameters)

    @cached_property
    def _values(self) -> FloatArray:
        return np.array([value_of(self.model, name) for name in self.parameters])

    @cached_property
    def _numbers(self) -> list[int]:
        """Where the measured motions are among the exponents of the intact model."""
        return [self.intact.oscillating[motion] for motion in self.motions]

    def damaged(self, losses: ArrayLike) -> Model:
        """Return the model with losses d, shape (P,), each below 1."""
        model = self.model
        for name, value, loss in zip(self.parameters, self._values, self._losses(losses), strict=True):
            model = replace_parameter(model, name, value * (1.0 - loss))
        return model

    def _losses(self, losses: ArrayLike) -> FloatArray:
        array = finite_array("losses", losses)
        if array.shape != self._values.shape or (array >= 1.0).any():
            raise ValueError(
                f"losses must be {self._values.size} numbers below 1, one a parameter; got {array.tolist()}"
            )
        return array

    def expected(self, losses: ArrayLike) -> tuple[ComplexArray, ComplexArray]:
        """Exponents of the measured motions under some losses, and their derivatives by these.

        Motions are told apart by their Floquet vectors, and an exponent is the image nearest to that of the intact
        model.

        Parameters
        ----------
        losses : array_like, shape (P,)

        Returns
        -------
        exponents : complex array, shape (m,)
            [1/s].
        derivatives : complex array, shape (m, P)
            dΛ/dd [1/s].
        """
        found = exponent_sensitivity(self.damaged(losses), self.speed, self.parameters)
        numbers = np.array(self.intact.numbers_in(found))[self._numbers]
        exponents = self._nearest(found.exponents[numbers], self.intact.exponents[self._numbers])
        return exponents, -found.derivatives[numbers] * self._values

    def _nearest(self, exponents: ComplexArray, to: ComplexArray) -> ComplexArray:
        """Images of exponents nearest to others."""
        turn = 2.0 * np.pi / self.intact.period
        return np.asarray(exponents - 1j * turn * np.round((exponents - to).imag / turn), dtype=complex)

    def jacobian(self, losses: ArrayLike) -> FloatArray:
        """Return G, derivatives of decay rates, then frequencies, over their deviations, shape (2m, P)."""
        return self._over_deviations(self.expected(losses)[1])

    def _over_deviations(self, values: ComplexArray) -> FloatArray:
        """Real and imaginary parts of values (m, ...) over the deviations, shape (2m, ...)."""
        parts = np.concatenate([values.real, values.imag])
        return np.asarray((parts.T / self.deviations.T.ravel()).T, dtype=float)

    def condition(self, losses: ArrayLike) -> float:
        """Condition of G [-]: how much worse the worst told mix of losses is told than the best; infinite if not."""
        return _condition(self.jacobian(losses))

    def bound(self, losses: ArrayLike) -> FloatArray:
        """Return the Cramér–Rao bound of the covariance of losses told from one measurement, shape (P, P) [-].

        Raises
        ------
        ValueError
            If what is measured does not tell all of them.
        """
        return bound_together((self,), losses)

    def untold(self, losses: ArrayLike) -> FloatArray:
        """Mix of losses, of unit length, that changes least of what is measured, shape (P,)."""
        rows = np.linalg.svd(self.jacobian(losses), full_matrices=True)[2]
        return np.asarray(rows[-1] * np.sign(rows[-1][np.abs(rows[-1]).argmax()]), dtype=float)

    def identified(self, measured: ArrayLike, start: ArrayLike | None = None) -> FloatArray:
        """Losses that fit measured exponents best, by least squares with their analytic derivatives.

        Parameters
        ----------
        measured : array_like of complex, shape (m,)
            Λ [1/s], any image; the real part counts for nothing where it has no finite deviation.
        start : array_like, shape (P,), optional
            Losses to begin with; default none.

        Returns
        -------
        array, shape (P,)

        Raises
        ------
        ValueError
            If the shape is wrong, or what is measured does not tell all losses.
        ArithmeticError
            If no fit was found.
        """
        values = np.asarray(measured, dtype=complex)
        if values.shape != (len(self.motions),) or not np.isfinite(values).all():
            raise ValueError(
                f"measured must be {len(self.motions)} finite exponents, one a motion; got {values.tolist()}"
            )
        first = np.zeros(self._values.size) if start is None else self._losses(start)
        self.bound(first)  # refuses what is not told
        last: dict[bytes, tuple[FloatArray, FloatArray]] = {}

        def both(losses: FloatArray) -> tuple[FloatArray, FloatArray]:
            if losses.tobytes() not in last:
                last.clear()
                exponents, derivatives = self.expected(losses)
                away = exponents - self._nearest(values, exponents)
                last[losses.tobytes()] = self._over_deviations(away), self._over_deviations(derivatives)
            return last[losses.tobytes()]

        fit = least_squares(
            lambda x: both(x)[0],
            first,
            lambda x: both(x)[1],
            bounds=(_LEAST, _MOST),
            xtol=1e-10,
            ftol=1e-12,
            gtol=1e-10,
        )
        if not fit.success:
            raise ArithmeticError(f"no losses were found that fit the measured exponents: {fit.message}")
        return np.asarray(fit.x, dtype=float)


def bound_together(surveys: Sequence[Survey], losses: ArrayLike) -> FloatArray:
    """Cramér–Rao bound of losses told from several surveys together, such as at several speeds, shape (P, P) [-].

    A periodic system has other exponents at another speed, so that the same motions say something else there.

    Parameters
    ----------
    surveys : sequence of Survey
        With the same parameters.
    losses : array_like, shape (P,)

    Raises
    ------
    ValueError
        If the parameters differ, or some mix of losses is not told.
    """
    integer_at_least("number of surveys", len(surveys), 1)
    names = surveys[0].parameters
    if any(survey.parameters != names for survey in surveys):
        raise ValueError(
            f"surveys must have the same parameters, got {[survey.parameters for survey in surveys]}"
        )
    rows = np.concatenate([survey.jacobian(losses) for survey in surveys])
    if not np.isfinite(_condition(rows)):
        raise ValueError(
            f"surveys must tell {len(names)} losses ({', '.join(names)}), but some mix of these changes nothing that "
            "is measured; measure more motions, at more speeds, or decay rates too"
        )
    inverse = np.linalg.inv(np.linalg.qr(rows, mode="r"))
    return np.asarray(inverse @ inverse.T, dtype=float)


def _condition(rows: FloatArray) -> float:
    """Condition of derivatives (2m, P), infinite where some mix of losses is not told."""
    singular = np.linalg.svd(rows, compute_uv=False)
    told = singular.size == rows.shape[1] and singular[-1] * _UNTOLD > singular[0]
    return float(singular[0] / singular[-1]) if told else float("inf")


def drawn(exponents: ArrayLike, deviations: ArrayLike, count: int, seed: int) -> ComplexArray:
    """Draw measurements with independent normal errors, none where the deviation is infinite, shape (count, m).

    Parameters
    ----------
    exponents : array_like of complex, shape (m,)
    deviations : array_like, shape (m, 2)
        As for :class:`Survey`.
    count, seed : int
    """
    sizes = np.asarray(deviations, dtype=float)
    errors = np.random.default_rng(seed).normal(size=(integer_at_least("count", count, 1), len(sizes), 2))
    errors *= np.where(np.isfinite(sizes), sizes, 0.0)
    return np.asarray(np.asarray(exponents) + errors[..., 0] + 1j * errors[..., 1], dtype=complex)


def scatter_over_bound(
    losses: FloatArray, truth: FloatArray, bound: FloatArray
) -> tuple[float, float, float]:
    """Mean square of standardised errors of losses over their number, 1 where the bound is attained, with 95 % limits.

    Parameters
    ----------
    losses : array, shape (D, P)
        Told from D measurements.
    truth : array, shape (P,)
    bound : array, shape (P, P)

    Returns
    -------
    ratio, low, high : float
        The sum of squares of a sample of normal errors at the bound is χ² with D P degrees of freedom, which gives the
        limits.
    """
    errors = np.linalg.solve(np.linalg.cholesky(bound), (losses - truth).T)
    total, free = float((errors**2).sum()), errors.size
    low, high = chi2.ppf([0.975, 0.025], free)
    return total / free, total / float(low), total / float(high)
