"""Torsional rods with mass, for any torsional model that has them as massless springs (section 8.2).

A uniform rod with the shear modulus G, density ρ, polar moment of area J_p and length l twists as

    ρ J_p χ_tt = G J_p χ_ss,    k = G J_p/l,    I = ρ J_p l = k (l/c_s)²,    c_s = √(G/ρ),

so that stiffness k, length and material fix its moment of inertia I, whatever its section, and the diameter of a solid
one, k = π G d⁴/(32 l). Craig and Bampton write its twist with the angles of its ends and n modes of the rod held at
both,

    χ(s) = (1 − s/l) χ_a + (s/l) χ_b + Σ_j y_j sin(jπs/l),

which gives the matrices of :meth:`Rod.mass_matrix` and :meth:`Rod.stiffness_matrix`. The linear shapes are those of a
massless spring, and no spring couples them to the modes: a rod adds to the spring in its place, and takes nothing away.
Without reduction a rod answers an oscillation of its ends by k [[x cot x, −x/sin x], [−x/sin x, x cot x]],
x = ωl/c_s, from which :mod:`facegear.mechanics.exact_rods` has the exact natural frequencies.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from facegear.floquet.periodic import PeriodicSystem, require_system
from facegear.mechanics.properties import STEEL, Material
from facegear.support.kinds import named, require_kind
from facegear.support.parameters import integer_at_least, integer_within, keep, nonnegative, positive
from facegear.support.types import FloatArray

MOST_MODES = 40
"""Most fixed-interface modes of a rod."""


@dataclass(frozen=True)
class Rod:
    """Uniform rod in torsion.

    Parameters
    ----------
    stiffness : float
        k = G J_p/l between its ends [N m/rad], greater than 0.
    length : float
        l [m], greater than 0.
    damping : float
        c between its ends [N m s/rad], 0 or greater; all along the rod the damping is c/k times the stiffness.
    modes : int
        Number n of modes with both ends held, from 0 to 40. With 0 its mass moves with the ends alone.
    material : Material

    Raises
    ------
    TypeError, ValueError
        A value of the wrong kind or outside its range.

    Examples
    --------
    >>> rod = Rod(stiffness=1.42e6, length=0.2)
    >>> f"{rod.inertia:.3g} kg m², {1e3 * rod.diameter:.0f} mm"
    '0.00579 kg m², 78 mm'
    """

    stiffness: float
    length: float
    damping: float = 0.0
    modes: int = 2
    material: Material = STEEL

    def __post_init__(self) -> None:
        require_kind("material", self.material, Material)
        keep(
            self,
            stiffness=positive("stiffness", self.stiffness, "N m/rad"),
            length=positive("length", self.length, "m"),
            damping=nonnegative("damping", self.damping, "N m s/rad"),
            modes=integer_within("modes", self.modes, 0, MOST_MODES),
        )

    @property
    def inertia(self) -> float:
        """Moment of inertia I = k (l/c_s)² about its axis [kg m²]."""
        return self.stiffness * (self.length / shear_wave_speed(self.material)) ** 2

    @property
    def diameter(self) -> float:
        """Diameter d = (32 k l/(π G))^¼ of a solid rod [m]; hollow ones of this stiffness are thicker."""
        return float((32.0 * self.stiffness * self.length / (math.pi * shear_modulus(self.material))) ** 0.25)

    def shear_stress(self, torque: float) -> float:
        """Largest shear stress 16 T/(π d³) of a solid rod under a torque T [N m], [Pa]."""
        return 16.0 * nonnegative("torque", torque, "N m") / (math.pi * self.diameter**3)

    @property
    def mass_matrix(self) -> FloatArray:
        """Mass of (χ_a, χ_b, y_1 … y_n), shape (2 + n, 2 + n) [kg m²]."""
        numbers = np.arange(1, self.modes + 1)
        matrix = np.diag(np.full(2 + self.modes, 0.5))
        matrix[:2, :2] = [[1.0 / 3.0, 1.0 / 6.0], [1.0 / 6.0, 1.0 / 3.0]]
        matrix[0, 2:] = 1.0 / (np.pi * numbers)
        matrix[1, 2:] = -((-1.0) ** numbers) / (np.pi * numbers)
        matrix[2:, :2] = matrix[:2, 2:].T
        return np.asarray(self.inertia * matrix)

    @property
    def stiffness_matrix(self) -> FloatArray:
        """Stiffness of (χ_a, χ_b, y_1 … y_n), shape (2 + n, 2 + n) [N m/rad]."""
        matrix = np.diag(np.concatenate([np.ones(2), (np.pi * np.arange(1, self.modes + 1)) ** 2 / 2.0]))
        matrix[0, 1] = matrix[1, 0] = -1.0
        return np.asarray(self.stiffness * matrix)

    @property
    def damping_matrix(self) -> FloatArray:
        """Damping of (χ_a, χ_b, y_1 … y_n), c/k times the stiffness, shape (2 + n, 2 + n) [N m s/rad]."""
        return self.damping / self.stiffness * self.stiffness_matrix

    def dynamic_stiffness(self, frequency: float) -> FloatArray:
        """Torques at the ends for angles there that oscillate at ω [rad/s], undamped, shape (2, 2) [N m/rad]."""
        turns = self._half_waves(frequency)
        own, other = np.cos(np.pi * turns) / np.sinc(turns), -1.0 / np.sinc(turns)
        return np.asarray(self.stiffness * np.array([[own, other], [other, own]]))

    def held_frequencies_below(self, frequency: float) -> int:
        """Count the natural frequencies jπ c_s/l below ω [rad/s] with both ends held."""
        return max(math.ceil(self._half_waves(frequency)) - 1, 0)

    def _half_waves(self, frequency: float) -> float:
        """ωl/(π c_s), the number of half waves along the rod."""
        return (
            nonnegative("frequency", frequency, "rad/s")
            * self.length
            / shear_wave_speed(self.material)
            / np.pi
        )


def shear_modulus(material: Material) -> float:
    """G = E/(2(1 + ν)) [Pa]."""
    return material.youngs_modulus / (2.0 * (1.0 + material.poissons_ratio))


def shear_wave_speed(material: Material) -> float:
    """Speed c_s = √(G/ρ) of torsional waves in a round rod [m/s]."""
    return math.sqrt(shear_modulus(material) / material.density)


@dataclass(frozen=True)
class Shaft:
    """A rod and the coordinates that its ends move with.

    Parameters
    ----------
    rod : Rod
    end : int
        Number of a coordinate, from 0.
    start : int, optional
        Number of another. Default: an end that has no angle of its own, as where a motor turns at a constant speed.

    Raises
    ------
    TypeError, ValueError
        A value of the wrong kind or outside its range.
    """

    rod: Rod
    end: int
    start: int | None = None

    def __post_init__(self) -> None:
        require_kind("rod", self.rod, Rod)
        keep(self, end=integer_at_least("end", self.end, 0))
        if self.start is not None:
            keep(self, start=integer_at_least("start", self.start, 0))
        if self.start == self.end:
            raise ValueError(f"start must be another coordinate than end, got {self.start!r} for both")

    def placed(self, own: FloatArray, size: int, first: int) -> FloatArray:
        """Put a matrix of (χ_a, χ_b, y_1 …) into one of `size` coordinates, with the modes from `first` on."""
        ends = (self.start, self.end)
        places = [*(-1 if place is None else place for place in ends), *range(first, first + len(own) - 2)]
        rows = np.eye(size)[places]
        if self.start is None:
            rows[0] = 0.0
        return np.asarray(rows.T @ own @ rows)


def with_mass(system: PeriodicSystem, shafts: Iterable[Shaft]) -> PeriodicSystem:
    """Give springs of a system the mass of rods.

    Parameters
    ----------
    system : PeriodicSystem
        Of n coordinates, with each rod as a massless spring and damper between the same coordinates.
    shafts : iterable of Shaft

    Returns
    -------
    PeriodicSystem
        Coordinates of the system, then the modes y_j of each rod [rad].

    Raises
    ------
    TypeError, ValueError
        If an argument is of the wrong kind, a coordinate does not exist, or the state of the system jumps: jumps do not
        say what becomes of the rods.

    Examples
    --------
    A spring that holds a wheel, and how much slower that turns to and fro for a spring of as much inertia:

    >>> from facegear.floquet.modes import natural_exponents
    >>> wheel = PeriodicSystem([[1.0]], [[0.0]], [[1.0]], (), period=1.0)
    >>> rod = Rod(stiffness=1.0, length=shear_wave_speed(STEEL), modes=10)
    >>> heavy = with_mass(wheel, [Shaft(rod, end=0)])
    >>> matrices = heavy.mass, heavy.damping, heavy.stiffness
    >>> f"{np.sort(natural_exponents(*matrices).imag)[11]:.4f}"
    '0.8603'
    """
    require_system(system)
    shafts = checked_shafts(shafts, system.size)
    if system.jumps:
        raise ValueError("system must have no jumps of the state: they do not say what becomes of the rods")
    size = system.size + sum(shaft.rod.modes for shaft in shafts)
    mass, damping, stiffness = (
        np.pad(matrix, (0, size - system.size)) for matrix in (system.mass, system.damping, system.stiffness)
    )
    first = system.size
    for shaft in shafts:
        rod = shaft.rod
        mass += shaft.placed(rod.mass_matrix, size, first)
        inner = np.zeros((2 + rod.modes, 2 + rod.modes))
        inner[2:, 2:] = rod.stiffness_matrix[2:, 2:]
        added = shaft.placed(inner, size, first)
        stiffness += added
        damping += rod.damping / rod.stiffness * added
        first += rod.modes
    loads = tuple(dataclasses.replace(x, shape=x.shape.embedded(size)) for x in system.loads)
    force = None if system.force is None else system.force.embedded(size)
    return dataclasses.replace(
        system, mass=mass, damping=damping, stiffness=stiffness, loads=loads, force=force
    )


def checked_shafts(shafts: Iterable[Shaft], size: int) -> tuple[Shaft, ...]:
    """Return shafts between coordinates of a model that has `size` of them, and refuse what are none."""
    if not isinstance(shafts, Iterable):
        raise TypeError(f"shafts must be a list of Shaft, got {named(shafts)}")
    shafts = tuple(shafts)
    for number, shaft in enumerate(shafts):
        require_kind(f"shafts[{number}]", shaft, Shaft)
        for name, place in (("start", shaft.start), ("end", shaft.end)):
            if place is not None and place >= size:
                raise ValueError(
                    f"shafts[{number}].{name} must be a coordinate from 0 to {size - 1}, got {place!r}"
                )
    return shafts
