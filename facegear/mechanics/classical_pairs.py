"""Classical periodic systems of two coordinates (section 2.1): two masses with one modulated spring, a pair of gears.

The masses have combination resonances; the pair of gears has a mesh stiffness that steps as tooth pairs enter and
leave. Each is a model: what elsewhere is a speed is here the parametric frequency ω [rad/s] itself.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from facegear.floquet.loads import ContactLoad
from facegear.floquet.models import Coordinate
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import SAME_INSTANT, PiecewiseChebyshev
from facegear.mechanics.classical import cosine_wave
from facegear.support.parameters import finite, keep, nonnegative, positive, within
from facegear.support.types import FloatArray

# What a contact ratio may be [-].
_CONTACT_RATIOS = (1.0, 5.0)


@lru_cache(maxsize=64)
def tooth_pair_wave(contact_ratio: float, droop: float) -> PiecewiseChebyshev:
    """Sum over the tooth pairs in mesh of their stiffness, relative to that of one pair at mid-sweep.

    Parameters
    ----------
    contact_ratio, droop : float
        As in :class:`GearPair`.

    Raises
    ------
    TypeError, ValueError
        If one is outside its range.
    """
    contact_ratio = within("contact_ratio", contact_ratio, *_CONTACT_RATIOS)
    droop = within("droop", droop, 0.0, 1.0)
    # So close to a whole number a pair leaves as the next one enters.
    nearest = round(contact_ratio)
    if abs(contact_ratio - nearest) <= SAME_INSTANT:
        contact_ratio = float(nearest)
    whole = int(np.floor(contact_ratio))
    rest = contact_ratio - whole
    breakpoints = [0.0] if rest == 0.0 else [0.0, rest]

    def total(x: FloatArray, piece: int) -> FloatArray:
        count = whole + 1 if rest > 0.0 and piece == 0 else whole
        share = (x + np.arange(count)[:, None]) / contact_ratio
        return np.asarray((1.0 - droop * (2.0 * share - 1.0) ** 2).sum(axis=0))

    return PiecewiseChebyshev.fit(total, breakpoints)


@dataclass(frozen=True)
class CoupledPair:
    """Two unit masses, the spring of the first one modulated: q̈ + c q̇ + [K + ε cos ωt e1 e1ᵀ] q = 0.

    K has `stiffnesses` on its diagonal and κ - χ, κ + χ off it. Coupled by a spring (κ) the pair has resonances of
    the sum type; coupled by a circulatory force (χ), one that does work along closed paths as a follower force
    does, of the difference type.

    Parameters
    ----------
    depth : float
        ε [N/m], not negative.
    coupling, circulation : float
        κ and χ [N/m].
    damping : float
        c [N s/m] of each mass, not negative.
    stiffnesses : tuple of float
        Diagonal of K [N/m], positive.

    Raises
    ------
    TypeError, ValueError
        Naming the parameter, or if K has no two positive, distinct eigenvalues.

    Examples
    --------
    Near the sum of both natural frequencies [rad/s] the pair is unstable.

    >>> from facegear.floquet.multipliers import growth_rate
    >>> pair = CoupledPair(depth=0.6, coupling=0.8, damping=0.02)
    >>> growth_rate(pair.system(2.8)) > 0.0
    True
    """

    depth: float
    coupling: float = 0.0
    circulation: float = 0.0
    damping: float = 0.0
    stiffnesses: tuple[float, float] = (1.0, 3.5)

    def __post_init__(self) -> None:
        keep(
            self,
            depth=nonnegative("depth", self.depth, "N/m"),
            coupling=finite("coupling", self.coupling, "N/m"),
            circulation=finite("circulation", self.circulation, "N/m"),
            damping=nonnegative("damping", self.damping, "N s/m"),
            stiffnesses=_two("stiffnesses", self.stiffnesses, "N/m"),
        )
        first, second = self.stiffnesses
        apart = (first - second) ** 2 / 4.0 + self.coupling**2 - self.circulation**2
        if apart <= 0.0 or np.linalg.det(self._stiffness) <= 0.0:
            raise ValueError(
                f"coupling and circulation must leave K two positive, distinct eigenvalues, got "
                f"coupling={self.coupling!r}, circulation={self.circulation!r} with stiffnesses={self.stiffnesses!r}"
            )

    @property
    def _stiffness(self) -> FloatArray:
        """K [N/m]."""
        first, second = self.stiffnesses
        across, around = self.coupling, self.circulation
        return np.array([[first, across - around], [across + around, second]])

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Displacements of the masses."""
        return (Coordinate("first mass", "m"), Coordinate("second mass", "m"))

    def system(self, frequency: float) -> PeriodicSystem:
        """Equations of motion at a parametric frequency.

        Parameters
        ----------
        frequency : float
            ω = 2π/T0 [rad/s].

        Returns
        -------
        PeriodicSystem
            Its one load has the stiffness ε and the weight cos ωt.

        Raises
        ------
        TypeError, ValueError
            If `frequency` is not a number greater than 0.
        """
        load = ContactLoad(
            PiecewiseChebyshev.constant([1.0, 0.0]), stiffness=self.depth, weight=cosine_wave()
        )
        return PeriodicSystem(
            mass=np.eye(2),
            damping=self.damping * np.eye(2),
            stiffness=self._stiffness,
            loads=(load,),
            period=2.0 * np.pi / positive("frequency", frequency, "rad/s"),
        )


@dataclass(frozen=True)
class GearPair:
    """Pinion and gear on sprung shafts with the mesh stiffness of the tooth pairs in contact.

    Coordinates are the motions of both base circles along the line of action. A pair's stiffness over its sweep is
    k [1 - κ (2s - 1)²], s from 0 at entry to 1 at exit: with κ = 0 the mesh stiffness steps, with κ = 1 it has
    kinks only, because every pair enters and leaves without stiffness.

    Parameters
    ----------
    contact_ratio : float
        Mesh periods that a pair stays in mesh [-], from 1 to 5.
    pair_stiffness, pair_damping : float
        k [N/m] and c [N s/m] of one pair at mid-sweep, not negative; damping follows the stiffness.
    droop : float
        κ [-], from 0 to 1.
    shaft_stiffnesses : tuple of float
        Stiffness of both shafts, reduced to the line of action [N/m], positive.
    shaft_damping : float
        Damping of each [N s/m], not negative.
    masses : tuple of float
        Both inertias reduced to the line of action [kg], positive.

    Raises
    ------
    TypeError, ValueError
        Naming the parameter and what would be valid.

    Examples
    --------
    One tooth pair or two: the stiffness steps twice in a mesh period.

    >>> gears = GearPair(contact_ratio=1.563, shaft_damping=0.02)
    >>> gears.system(1.1).breakpoints.size
    2
    """

    contact_ratio: float
    pair_stiffness: float = 0.6
    pair_damping: float = 0.0
    droop: float = 0.0
    shaft_stiffnesses: tuple[float, float] = (0.5, 1.0)
    shaft_damping: float = 0.0
    masses: tuple[float, float] = (1.0, 1.5)

    def __post_init__(self) -> None:
        keep(
            self,
            contact_ratio=within("contact_ratio", self.contact_ratio, *_CONTACT_RATIOS),
            pair_stiffness=nonnegative("pair_stiffness", self.pair_stiffness, "N/m"),
            pair_damping=nonnegative("pair_damping", self.pair_damping, "N s/m"),
            droop=within("droop", self.droop, 0.0, 1.0),
            shaft_stiffnesses=_two("shaft_stiffnesses", self.shaft_stiffnesses, "N/m"),
            shaft_damping=nonnegative("shaft_damping", self.shaft_damping, "N s/m"),
            masses=_two("masses", self.masses, "kg"),
        )

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Motions of both base circles along the line of action."""
        return (Coordinate("pinion", "m", "pinion"), Coordinate("gear", "m", "gear"))

    def system(self, mesh_frequency: float) -> PeriodicSystem:
        """Equations of motion at a mesh frequency.

        Parameters
        ----------
        mesh_frequency : float
            ω = 2π/T0 [rad/s], T0 the mesh period.

        Returns
        -------
        PeriodicSystem
            Its one load has the stiffness and damping of a pair at mid-sweep and the weight of
            :func:`tooth_pair_wave`.

        Raises
        ------
        TypeError, ValueError
            If `mesh_frequency` is not a number greater than 0.
        """
        load = ContactLoad(
            PiecewiseChebyshev.constant([1.0, -1.0]),
            stiffness=self.pair_stiffness,
            damping=self.pair_damping,
            weight=tooth_pair_wave(self.contact_ratio, self.droop),
        )
        return PeriodicSystem(
            mass=np.diag(self.masses),
            damping=self.shaft_damping * np.eye(2),
            stiffness=np.diag(self.shaft_stiffnesses),
            loads=(load,),
            period=2.0 * np.pi / positive("mesh_frequency", mesh_frequency, "rad/s"),
        )


def _two(name: str, values: Any, unit: str) -> tuple[float, float]:
    """Check one value for each of both coordinates."""
    listed = isinstance(values, list | tuple) or (isinstance(values, np.ndarray) and values.ndim == 1)
    if not listed or len(values) != 2:
        raise ValueError(f"{name} must be two numbers in {unit}, one for each coordinate, got {values!r}")
    first, second = (positive(f"{name}[{i}]", values[i], unit) for i in (0, 1))
    return first, second
