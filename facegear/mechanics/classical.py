"""Classical equations of one coordinate whose stability is known in closed form or from tables (section 2.1).

With natural frequency ω0, depth of modulation ε and damping ratio ϑ,

    q̈ + 2 ϑ ω0 q̇ + ω0² [1 + ε w(ωt)] q = 0,

is Mathieu's equation for w = cos, Meissner's for a square wave, and Hill's for any.

Each is a model: what elsewhere is a speed is here the parametric frequency ω [rad/s] itself.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import ArrayLike

from facegear.floquet.loads import ContactLoad
from facegear.floquet.models import Coordinate
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.support.parameters import finite, finite_array, keep, nonnegative, positive, within
from facegear.support.types import FloatArray

# What a duty may be [-].
_DUTIES = (0.001, 0.999)
# Critical damping leaves no oscillation.
_DAMPING_RATIOS = (0.0, float(np.nextafter(1.0, 0.0)))
# Shape of a load on the one coordinate.
_ALONE = PiecewiseChebyshev.constant([1.0])


@lru_cache(maxsize=1)
def cosine_wave() -> PiecewiseChebyshev:
    """Return w(ωt) = cos ωt."""
    return PiecewiseChebyshev.fit(lambda x, piece: np.cos(2.0 * np.pi * x), [0.0])


@lru_cache(maxsize=64)
def square_wave(duty: float) -> PiecewiseChebyshev:
    """Return w = +1 over the first part of the period, -1 over the rest.

    Parameters
    ----------
    duty : float
        The first part as a fraction of the period [-], between 0.001 and 0.999.

    Raises
    ------
    TypeError, ValueError
        If ``duty`` is outside this range.
    """
    duty = within("duty", duty, *_DUTIES)
    return PiecewiseChebyshev(np.array([0.0, duty]), np.array([1.0, -1.0])[:, None, None])


@dataclass(frozen=True)
class Hill:
    """Hill's equation with one coordinate: any periodic stiffness (2-1).

    Parameters
    ----------
    depth : float
        Depth of modulation ε [-], not negative.
    wave : PiecewiseChebyshev
        w over the fraction of the period, one component.
    damping_ratio : float
        ϑ [-], from 0 to below 1.
    natural_frequency : float
        ω0 [rad/s].

    Raises
    ------
    TypeError, ValueError
        Naming the parameter and what would be valid.

    Examples
    --------
    A stiffness that rises along each period and falls back at its end.

    >>> from facegear.floquet.multipliers import growth_rate
    >>> saw = PiecewiseChebyshev.fit(lambda x, piece: 2.0 * x - 1.0, [0.0])
    >>> round(growth_rate(Hill(depth=0.2, wave=saw).system(2.0)), 4)
    0.0318
    """

    depth: float
    wave: PiecewiseChebyshev
    damping_ratio: float = 0.0
    natural_frequency: float = 1.0

    def __post_init__(self) -> None:
        keep(
            self,
            depth=nonnegative("depth", self.depth),
            damping_ratio=within("damping_ratio", self.damping_ratio, *_DAMPING_RATIOS),
            natural_frequency=positive("natural_frequency", self.natural_frequency, "rad/s"),
        )
        if not isinstance(self.wave, PiecewiseChebyshev):
            raise TypeError(
                "wave must be a PiecewiseChebyshev over the fraction of the period, as "
                f"PiecewiseChebyshev.fit(lambda x, piece: np.cos(2 * np.pi * x), [0.0]), got {self.wave!r}"
            )
        if self.wave.components != 1:
            raise ValueError(f"wave must have one component, got {self.wave.components}")

    def _load(self) -> ContactLoad:
        """Return the spring that varies: stiffness ε ω0², weight w."""
        stiffness = self.depth * self.natural_frequency**2
        return ContactLoad(_ALONE, stiffness=stiffness, weight=self.wave)

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Its one coordinate."""
        return (Coordinate("q", ""),)

    def system(self, frequency: float) -> PeriodicSystem:
        """Equation of motion at a parametric frequency.

        Parameters
        ----------
        frequency : float
            ω = 2π/T0 [rad/s].

        Returns
        -------
        PeriodicSystem
            Its one load has the stiffness ε ω0² and the weight w.

        Raises
        ------
        TypeError, ValueError
            If `frequency` is not a number greater than 0.
        """
        return PeriodicSystem(
            mass=np.eye(1),
            damping=np.array([[2.0 * self.damping_ratio * self.natural_frequency]]),
            stiffness=np.array([[self.natural_frequency**2]]),
            loads=(self._load(),),
            period=2.0 * np.pi / positive("frequency", frequency, "rad/s"),
        )


@dataclass(frozen=True)
class Mathieu:
    """Mathieu's equation q̈ + 2ϑω0 q̇ + ω0² (1 + ε cos ωt) q = 0.

    With z = ωt/2 it is the standard form q'' + (a - 2 p cos 2z) q = 0, a = (2ω0/ω)², p = -ε a/2, apart from the
    damping.

    Parameters
    ----------
    depth, damping_ratio, natural_frequency : float
        ε [-], ϑ [-] and ω0 [rad/s], as of :class:`Hill`.

    Raises
    ------
    TypeError, ValueError
        As :class:`Hill`.

    Examples
    --------
    >>> from facegear.floquet.multipliers import growth_rate
    >>> swing = Mathieu(depth=0.2)
    >>> round(growth_rate(swing.system(2.0)), 4)
    0.0499

    Its tongues between two frequencies [rad/s]; at the second one, at 1, there is none with so much damping.

    >>> from facegear.maps.tracing import tongues
    >>> [tongue.label for tongue in tongues(Mathieu(depth=0.2, damping_ratio=0.02), (0.8, 2.4))]
    ['(1+1)/1']
    """

    depth: float
    damping_ratio: float = 0.0
    natural_frequency: float = 1.0

    def __post_init__(self) -> None:
        hill = self._hill
        keep(
            self,
            depth=hill.depth,
            damping_ratio=hill.damping_ratio,
            natural_frequency=hill.natural_frequency,
        )

    @cached_property
    def _hill(self) -> Hill:
        return Hill(self.depth, cosine_wave(), self.damping_ratio, self.natural_frequency)

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Its one coordinate."""
        return (Coordinate("q", ""),)

    def system(self, frequency: float) -> PeriodicSystem:
        """Equation of motion at a parametric frequency ω [rad/s]; see :meth:`Hill.system`."""
        return self._hill.system(frequency)


@dataclass(frozen=True)
class Meissner:
    """Meissner's equation: stiffness ω0² (1 + ε) over the first part of the period, ω0² (1 - ε) over the rest.

    Parameters
    ----------
    depth : float
        ε [-], as of :class:`Hill`.
    duty : float
        The first part as a fraction of the period [-], between 0.001 and 0.999.
    damping_ratio, natural_frequency : float
        ϑ [-] and ω0 [rad/s], as of :class:`Hill`.

    Raises
    ------
    TypeError, ValueError
        As :class:`Hill`, and if `duty` is outside its range.

    Examples
    --------
    >>> from facegear.floquet.multipliers import growth_rate
    >>> round(growth_rate(Meissner(depth=0.2).system(2.0)), 4)
    0.0635
    """

    depth: float
    duty: float = 0.5
    damping_ratio: float = 0.0
    natural_frequency: float = 1.0

    def __post_init__(self) -> None:
        keep(self, duty=within("duty", self.duty, *_DUTIES))
        hill = self._hill
        keep(
            self,
            depth=hill.depth,
            damping_ratio=hill.damping_ratio,
            natural_frequency=hill.natural_frequency,
        )

    @cached_property
    def _hill(self) -> Hill:
        return Hill(self.depth, square_wave(self.duty), self.damping_ratio, self.natural_frequency)

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Its one coordinate."""
        return (Coordinate("q", ""),)

    def system(self, frequency: float) -> PeriodicSystem:
        """Equation of motion at a parametric frequency ω [rad/s]; see :meth:`Hill.system`."""
        return self._hill.system(frequency)


def meissner_trace(
    frequency: ArrayLike,
    depth: ArrayLike,
    duty: ArrayLike = 0.5,
    damping_ratio: float = 0.0,
    natural_frequency: float = 1.0,
) -> FloatArray:
    """Trace of the transition matrix of Meissner's equation in closed form.

    tr Φ = exp(-ϑω0T0) [2 cos a cos b - (p/r + r/p) sin a sin b] with p² = ω0² (1 + ε - ϑ²), r² = ω0² (1 - ε - ϑ²),
    a = p d T0 and b = r (1 - d) T0, d the duty; the undamped equation is stable while |tr Φ| < 2.

    Parameters
    ----------
    frequency, depth, duty : array_like
        ω [rad/s], and ε and d [-] as of :class:`Meissner`, broadcast against each other.
    damping_ratio, natural_frequency : float
        ϑ [-] and ω0 [rad/s], as of :class:`Meissner`.

    Returns
    -------
    array
        Of the broadcast shape [-].
    """
    given = {"frequency": frequency, "depth": depth, "duty": duty}
    w, eps, d = np.broadcast_arrays(*(finite_array(name, values) for name, values in given.items()))
    damping_ratio = finite("damping_ratio", damping_ratio)
    natural_frequency = finite("natural_frequency", natural_frequency, "rad/s")
    period = 2.0 * np.pi / w
    # Complex, because the softer part has no frequency where ε + ϑ² > 1.
    p, r = (natural_frequency * np.sqrt(1.0 + sign * eps - damping_ratio**2 + 0j) for sign in (1.0, -1.0))
    a, b = p * d * period, r * (1.0 - d) * period
    # sin b / r stays finite where r vanishes.
    share = np.where(np.abs(b) > 1e-8, np.sin(b) / np.where(r == 0.0, 1.0, r), (1.0 - d) * period)
    bracket = 2.0 * np.cos(a) * np.cos(b) - (p + r**2 / p) * np.sin(a) * share
    return np.asarray(np.exp(-damping_ratio * natural_frequency * period) * bracket.real)
