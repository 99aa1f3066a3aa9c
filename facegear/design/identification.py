"""What measured frequencies and decay rates say of the losses of a model's parameters.

A loss d makes a parameter p (1 − d). Characteristic exponents Λ(d) of some motions are measured with independent
normal errors of known deviations; the losses that fit best are least squares over the deviations. A frequency is known
but for multiples of that of the mesh, so that far from the intact model other losses may fit as well: fits are sought
from many starts, and those that do not explain the data, or are not the only ones, are refused. No unbiased estimate
scatters less than the Cramér–Rao bound (GᵀG)⁻¹, G the derivatives of what is measured over the deviations, and least
squares attain it where errors are small (Kay, Fundamentals of Statistical Signal Processing: Estimation Theory, 1993).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from operator import attrgetter

import numpy as np
from numpy.typing import ArrayLike
from scipy.stats import chi2

from facegear.design.fits import Fit, local_fits, spread_starts
from facegear.design.measurements import checked_deviations, checked_exponents
from facegear.floquet.models import (
    Model,
    parameter_path,
    replace_parameter,
    require_model,
    system_at,
    value_of,
)
from facegear.maps.exponents import ExponentSensitivity, exponent_sensitivity
from facegear.support.parameters import (
    finite,
    finite_array,
    integer_at_least,
    integer_within,
    keep,
    positive,
)
from facegear.support.types import ComplexArray, FloatArray

# Starts of a fit, evenly spread over the losses that are looked at.
_STARTS = 16
# Part of all measurements whose errors alone exceed the largest misfit that is taken for a fit.
_EXCEEDED = 1e-4
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
        for name, kind in (("parameters", "names"), ("motions", "numbers")):
            listed = getattr(self, name)
            if isinstance(listed, str) or not isinstance(listed, Iterable):
                raise TypeError(f"{name} must be a list of {kind}, got {listed!r}")
            keep(self, **{name: tuple(listed)})
        integer_at_least("number of parameters", len(self.parameters), 1)
        system_at(self.model, self.speed)
        paths = [parameter_path(self.model, name) for name in self.parameters]
        if len(set(paths)) < len(paths):
            raise ValueError(f"parameters must differ, got {self.parameters}")
        for name, path in zip(self.parameters, paths, strict=True):
            if isinstance(attrgetter(".".join(path))(self.model), int):
                raise ValueError(
                    f"parameters must be such that can lose a part, got {name!r}, a whole number"
                )
        integer_at_least("number of motions", len(self.motions), 1)
        count = len(self.intact.oscillating)
        for number, motion in enumerate(self.motions):
            integer_within(f"motions[{number}]", motion, 0, count - 1)
        if len(set(self.motions)) < len(self.motions):
            raise ValueError(f"motions must differ, got {self.motions}")
        keep(self, deviations=checked_deviations(self.deviations, len(self.motions)))

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

    def _losses(self, losses: ArrayLike, name: str = "losses") -> FloatArray:
        array = finite_array(name, losses)
        if array.shape != self._values.shape or (array >= 1.0).any():
            raise ValueError(
                f"{name} must be {self._values.size} numbers below 1, one a parameter; got {array.tolist()}"
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

    def identified(
        self, measured: ArrayLike, start: ArrayLike | None = None, least: float = 0.0, most: float = 0.5
    ) -> FloatArray:
        """Losses that fit measured exponents best, by least squares with their analytic derivatives.

        Parameters
        ----------
        measured : array_like of complex, shape (m,)
            Λ [1/s] in the order of the motions, any image; the real part counts for nothing where it has no finite
            deviation. Frequencies alone do not tell that two of them were exchanged, where other losses explain them.
        start : array_like, shape (P,), optional
            Losses to begin with, for the fit next to them, where they are about known: whether others fit as well is
            then not asked. Default: many starts all over the range.
        least, most : float
            Range of losses that are looked for [-]. A part is not stiffer than it was, and has half of its stiffness
            left, unless you say otherwise; `most` is below 1. In a wider range more losses fit.

        Returns
        -------
        array, shape (P,)
            In the range. Where the true ones are on its edge, errors of the data move them inwards only.

        Raises
        ------
        TypeError, ValueError
            If an argument is of the wrong kind, or what is measured does not tell all losses.
        ArithmeticError
            If no losses in the range were found that explain what is measured: χ² of the misfit over the deviations
            is larger than errors alone make it once in ten thousand measurements. Or if several were found that do,
            further apart than such errors would move them: a narrower range, more motions or another speed may exclude
            all but one.
        """
        values = checked_exponents("measured", measured, len(self.motions))
        least, most = _checked_range(least, most)
        first = (
            np.full(self._values.size, max(least, min(0.0, most)))
            if start is None
            else self._losses(start, "start")
        )
        if (first < least).any() or (first > most).any():
            raise ValueError(
                f"start must lie between least={least:g} and most={most:g}, got {first.tolist()}"
            )
        self.bound(first)  # refuses what is not told

        def residuals(losses: FloatArray) -> tuple[FloatArray, FloatArray]:
            exponents, derivatives = self.expected(losses)
            away = exponents - self._nearest(values, exponents)
            return self._over_deviations(away), self._over_deviations(derivatives)

        starts = spread_starts(least, most, first.size, _STARTS) if start is None else first[None]
        fits = local_fits(residuals, starts, least, most)
        allowed = float(chi2.isf(_EXCEEDED, np.isfinite(self.deviations).sum()))
        if not fits or fits[0].misfit > allowed:
            raise ArithmeticError(
                f"no losses from {least:g} to {most:g} were found that explain measured {values.round(3).tolist()} "
                f"within its deviations, χ² up to {allowed:.3g}{'; the best: ' + _told(fits[0]) if fits else ''}"
            )
        self.bound(fits[0].values)
        for other in fits[1:]:
            if other.misfit <= allowed and fits[0].differs(other, allowed):
                raise ArithmeticError(
                    f"measured {values.round(3).tolist()} is explained by losses {_told(fits[0])} and by "
                    f"{_told(other)}: narrow the range by least and most, give a start next to the right ones, or "
                    "measure more"
                )
        return fits[0].values


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


def _told(fit: Fit) -> str:
    return f"{fit.values.round(4).tolist()} (χ² = {fit.misfit:.3g})"


def _checked_range(least: float, most: float) -> tuple[float, float]:
    """Return the range of losses, ascending and below 1."""
    least, most = finite("least", least), finite("most", most)
    if not least < most < 1.0:
        raise ValueError(f"most must be greater than least={least:g} and below 1, got {most!r}")
    return least, most
