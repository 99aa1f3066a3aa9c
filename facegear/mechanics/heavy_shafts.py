"""Gearbox whose shafts have mass (section 8.2).

The input shaft runs from the input, which turns at a constant speed, to the pinion, the output shaft from the face gear
to the load. Chapter 7 has them as springs and dampers; here both are uniform rods (:mod:`facegear.mechanics.rods`) of
the same stiffness and damping, whose inertia follows from their length. Short shafts become chapter 7's.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from facegear.floquet.models import Coordinate
from facegear.floquet.modes import undamped_frequencies
from facegear.floquet.periodic import PeriodicSystem
from facegear.mechanics.exact_rods import exact_frequencies
from facegear.mechanics.properties import STEEL, Material
from facegear.mechanics.rods import (
    MOST_MODES,
    Rod,
    Shaft,
    shear_modulus,
    with_mass,
)
from facegear.mechanics.torsional import InSi, Torsional, natural_speed
from facegear.support.kinds import require_kinds
from facegear.support.parameters import designed, integer_within, keep, within
from facegear.support.types import FloatArray

# Lengths of shafts with mass [m]: thin disks, and as long as an airframe.
_SHORTEST, _LONGEST = 1e-3, 20.0


@dataclass(frozen=True)
class HeavyShafts:
    """Torsional vibration of a gearbox with shafts that have mass.

    Parameters
    ----------
    torsional : Torsional
        The gearbox with massless shafts (chapter 7), whose stiffnesses and dampings the shafts keep.
    input_length, output_length : float
        l1, l2 of the shafts [m], from 0.001 to 20, or 0 for a massless one.
    modes : int or tuple of int
        Number n of modes of each shaft with both ends held, from 0 to 40; a pair if input and output shaft have not the
        same. Errors fall with its third power while the cost of a growth rate rises as fast or faster: of Fig. 7.13(a)
        with shafts of 0.3 m at 500 rpm, -194 1/s, two modes miss 0.09 1/s and ten 0.002 1/s; ten take a fraction of a
        second, forty some fifty times as long.
    material : Material
        Of the shafts.

    Raises
    ------
    TypeError, ValueError
        If an argument is of the wrong kind or outside its range.

    Examples
    --------
    >>> from facegear.mechanics.gearboxes import FIGURES
    >>> model = HeavyShafts(FIGURES["7.13a"].model(), input_length=0.3, output_length=0.3)
    >>> model.system(speed=50.0).size
    7
    >>> print(*model.not_buildable, sep="; ")
    input shaft of 158 mm diameter is thicker than the root circle of the pinion (90.5 mm): at most 32.1 mm long
    """

    torsional: Torsional
    input_length: float = field(metadata=designed("length of the input shaft"))
    output_length: float = field(metadata=designed("length of the output shaft"))
    modes: int | tuple[int, int] = 2
    material: Material = STEEL

    def __post_init__(self) -> None:
        require_kinds(self, torsional=Torsional, material=Material)
        for name in ("input_length", "output_length"):
            keep(self, **{name: _checked_length(name, getattr(self, name))})
        keep(self, modes=_checked_modes(self.modes))

    @property
    def gearbox(self) -> InSi:
        """That of `torsional`."""
        return self.torsional.gearbox

    @property
    def modes_of_each(self) -> tuple[int, int]:
        """Numbers of modes of the input shaft and of the output shaft, 0 for a massless one."""
        first, second = self.modes if isinstance(self.modes, tuple) else (self.modes, self.modes)
        return first if self.input_length else 0, second if self.output_length else 0

    @property
    def input_rod(self) -> Rod:
        """Shaft from the input to the pinion, if it has mass."""
        box = self.torsional.gearbox.in_si
        return Rod(
            box.input_stiffness, self.input_length, box.input_damping, self.modes_of_each[0], self.material
        )

    @property
    def output_rod(self) -> Rod:
        """Shaft from the face gear to the load, if it has mass."""
        box = self.torsional.gearbox.in_si
        return Rod(
            box.output_stiffness, self.output_length, box.output_damping, self.modes_of_each[1], self.material
        )

    @property
    def shafts(self) -> tuple[Shaft, ...]:
        """Rods between the coordinates of chapter 7, of those shafts that have mass."""
        first = (Shaft(self.input_rod, end=0),) if self.input_length else ()
        return (*first, Shaft(self.output_rod, start=1, end=2)) if self.output_length else first

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Angles χ1, χ2, χo (7-9) and the modes y_j of the input shaft, then of the output shaft."""
        modes = [
            Coordinate(f"{shaft}, mode {number}", "rad", shaft)
            for shaft, count in zip(("input shaft", "output shaft"), self.modes_of_each, strict=True)
            for number in range(1, count + 1)
        ]
        return (*self.torsional.coordinates, *modes)

    def natural_frequencies(self) -> FloatArray:
        """Natural frequencies of the mean system at rest, undamped, ascending, one a coordinate [rad/s]."""
        # Neither mass nor constant stiffness depends on speed.
        system = self.system(1.0)
        stiffness = system.stiffness.copy()
        stiffness[:3, :3] = self.torsional.mean_stiffness
        return undamped_frequencies(system.mass, stiffness)

    def natural_speeds(self) -> FloatArray:
        """Speeds of the face gear at which the mesh frequency is a natural one (7-20), one a coordinate [rad/s]."""
        return natural_speed(self.torsional.drive, self.natural_frequencies())

    def exact_frequencies(self, count: int) -> FloatArray:
        """As :meth:`natural_frequencies`, the lowest `count` of them, with rods that are not reduced to modes.

        Parameters
        ----------
        count : int
            At least 1; at most 3, all that there are, if both shafts are massless.

        Raises
        ------
        TypeError, ValueError
            If `count` is not that.
        """
        if not self.shafts:
            known = self.torsional.natural_frequencies()
            return known[: integer_within("count without a length of a shaft", count, 1, known.size)]
        mass = self.torsional.gearbox.in_si.mass_matrix
        return exact_frequencies(mass, self.torsional.mean_stiffness, self.shafts, count)

    @property
    def largest_diameters(self) -> tuple[float, float]:
        """Diameters [m] that leave room for teeth: root circle of the pinion, inner edge of the face gear's teeth."""
        drive = self.torsional.drive
        return 2.0 * drive.dedendum_radius, 2.0 * drive.inner_radius

    @property
    def largest_lengths(self) -> tuple[float, float]:
        """Lengths π G d⁴/(32 k) [m] from which on solid shafts of these stiffnesses are thicker than that."""
        scale, box = math.pi * shear_modulus(self.material) / 32.0, self.torsional.gearbox.in_si
        first, second = self.largest_diameters
        return scale * first**4 / box.input_stiffness, scale * second**4 / box.output_stiffness

    @property
    def not_buildable(self) -> tuple[str, ...]:
        """What cannot be built, and why, one sentence a shaft; empty if all can."""
        edges = ("the root circle of the pinion", "the inner edge of the teeth of the face gear")
        rows = zip(
            ("input shaft", "output shaft"),
            (self.input_length, self.output_length),
            self.largest_lengths,
            self.largest_diameters,
            edges,
            strict=True,
        )
        # Of one stiffness, the fourth power of the diameter grows as the length.
        return tuple(
            f"{name} of {_digits(1e3 * room * (length / longest) ** 0.25)} mm diameter is thicker than {edge} "
            f"({_digits(1e3 * room)} mm): at most {_digits(1e3 * longest)} mm long"
            for name, length, longest, room, edge in rows
            if length > longest
        )

    def system(self, speed: float) -> PeriodicSystem:
        """Equations of motion at a constant speed.

        Parameters
        ----------
        speed : float
            Ω2 of the face gear [rad/s], greater than 0.

        Returns
        -------
        PeriodicSystem
            Three coordinates of chapter 7 and n of each shaft; loads and period of chapter 7.

        Raises
        ------
        TypeError, ValueError
            If `speed` is not a finite number greater than 0.
        """
        return with_mass(self.torsional.system(speed), self.shafts)


def _checked_modes(value: object) -> int | tuple[int, int]:
    if not isinstance(value, tuple):
        return integer_within("modes", value, 0, MOST_MODES)
    if len(value) != 2:
        raise ValueError(f"modes must be one number, or two of input and output shaft, got {value!r}")
    first, second = (integer_within("modes", each, 0, MOST_MODES) for each in value)
    return first, second


def _checked_length(name: str, value: object) -> float:
    length = within(name, value, 0.0, _LONGEST, "m")
    if 0.0 < length < _SHORTEST:
        raise ValueError(
            f"{name} must be 0 for a massless shaft, or at least {_SHORTEST:g} m, got {length!r} m"
        )
    return length


def _digits(value: float) -> str:
    """Three significant digits, without an exponent."""
    return f"{float(f'{value:.3g}'):.12g}"
