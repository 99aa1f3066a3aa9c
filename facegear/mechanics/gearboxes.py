"""The gearbox of chapter 7 (table 7.1) and the parameters that its captions print.

All stiffnesses of the captions are multiples of the mesh stiffness, all dampings multiples of a stiffness, all
inertias multiples of the pinion's. They are kept as such, so that nothing is rounded, and so that the damping of a
shaft follows its stiffness where a figure sweeps that.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from types import MappingProxyType
from typing import Any, Literal

from facegear.geometry.drive import Drive
from facegear.mechanics.properties import STEEL
from facegear.mechanics.tooth_stiffness import mesh_stiffness
from facegear.mechanics.torsional import Gearbox, Torsional, cylinder_inertia
from facegear.support.parameters import designed, keep, nonnegative, positive

DRIVE = Drive(31, 107, 25.4e-3 / 8)
"""Drive of table 7.1: 31 and 107 teeth, diametral pitch 8 per inch."""

HIGHEST_SPEED_RPM = 1000.0
"""End of the output speed range (table 7.1) [rpm of the face gear]."""

PINION_INERTIA = cylinder_inertia(DRIVE.base_radius, DRIVE.face_width, STEEL.density)
"""J1 as the captions print it, 1.6e-3 kg m²: a solid cylinder of the base radius.

The text takes the pitch radius (section 7.4.1), which gives 2.4e-3 kg m².
"""

GEAR_INERTIA = cylinder_inertia(DRIVE.outer_radius, 0.05 * DRIVE.outer_radius, STEEL.density)
"""J2 of Figs 7.10 to 7.13: a solid disk of radius R2 and thickness 0.05 R2 [kg m²]."""

GEAR_INERTIA_RATIO = GEAR_INERTIA / PINION_INERTIA
"""J2/J1 of Figs 7.10 to 7.13, printed as 91.97."""

LOAD_INERTIA_RATIO = 1.1 * GEAR_INERTIA_RATIO
"""Jo/J1 of Figs 7.10 to 7.13, printed as 101.17."""


@dataclass(frozen=True)
class ProportionalGearbox:
    """Gearbox of table 7.1 in the ratios of the captions, for :class:`facegear.mechanics.torsional.Torsional`.

    Parameters
    ----------
    correction_factor : float
        c_f of the mesh stiffness (7-2).
    gear_inertia, load_inertia : float
        J2/J1 and Jo/J1, greater than 0.
    input_stiffness, output_stiffness : float
        k1/k_m and k2/k_m [m²/rad], greater than 0.
    mesh_damping, input_damping, output_damping : float
        c_m/k_m, c1/k1, c2/k2 [s], 0 or greater.

    Raises
    ------
    TypeError, ValueError
        A value of the wrong kind or outside its range.

    Examples
    --------
    >>> f"{FIGURES['7.12a'].gearbox.in_si.input_stiffness:.3g}"
    '1.42e+06'
    """

    correction_factor: float
    gear_inertia: float = field(metadata=designed("inertia of the face gear"))
    load_inertia: float = field(metadata=designed("inertia of the load"))
    input_stiffness: float = field(metadata=designed("input shaft stiffness"))
    output_stiffness: float = field(metadata=designed("output shaft stiffness"))
    mesh_damping: float = field(metadata=designed("mesh damping"))
    input_damping: float = field(metadata=designed("input shaft damping"))
    output_damping: float = field(metadata=designed("output shaft damping"))

    def __post_init__(self) -> None:
        keep(self, correction_factor=positive("correction_factor", self.correction_factor))
        for name in ("gear_inertia", "load_inertia", "input_stiffness", "output_stiffness"):
            keep(self, **{name: positive(name, getattr(self, name))})
        for name in ("mesh_damping", "input_damping", "output_damping"):
            keep(self, **{name: nonnegative(name, getattr(self, name), "s")})
        # Everything else is checked by what it is turned into.
        _ = self.in_si

    @cached_property
    def in_si(self) -> Gearbox:
        """The same in SI units."""
        stiffness = mesh_stiffness(DRIVE, self.correction_factor)
        first, second = self.input_stiffness * stiffness, self.output_stiffness * stiffness
        return Gearbox(
            DRIVE,
            pinion_inertia=PINION_INERTIA,
            gear_inertia=self.gear_inertia * PINION_INERTIA,
            load_inertia=self.load_inertia * PINION_INERTIA,
            mesh_stiffness=stiffness,
            mesh_damping=self.mesh_damping * stiffness,
            input_stiffness=first,
            input_damping=self.input_damping * first,
            output_stiffness=second,
            output_damping=self.output_damping * second,
        )


@dataclass(frozen=True)
class TorsionalFigure:
    """A figure of section 7.4 over the speed of the face gear, as its caption describes it.

    Attributes
    ----------
    gearbox : ProportionalGearbox
        Parameters of the caption; the axis of the figure replaces the swept one.
    parameter : str
        Parameter on the vertical axis, a field of `gearbox`.
    lowest, highest : float
        Ends of the vertical axis. But for the inertias (section 7.4.1) axes are not printed: they are chosen so
        that what the text says can be seen.
    scale : {"linear", "log"}
        Scale of that axis.
    lowest_rpm : float
        Lowest speed of the map [rpm of the face gear]: lower down there are ever more and ever narrower tongues.
    """

    gearbox: ProportionalGearbox
    parameter: str
    lowest: float
    highest: float
    scale: Literal["linear", "log"]
    lowest_rpm: float

    def model(self, **options: Any) -> Torsional:
        """Return the model of the figure; `options` are those of :class:`facegear.mechanics.torsional.Torsional`."""
        return Torsional(self.gearbox, **options)


def _inertias(gear_inertia: float, load_inertia: float) -> ProportionalGearbox:
    """Figs 7.8 and 7.9."""
    return ProportionalGearbox(
        correction_factor=0.5,
        gear_inertia=gear_inertia,
        load_inertia=load_inertia,
        input_stiffness=2.0,
        output_stiffness=3.0,
        mesh_damping=5e-6,
        input_damping=5e-6,
        output_damping=5e-6,
    )


def _shafts(
    correction_factor: float, input_stiffness: float, output_stiffness: float, damping: float
) -> ProportionalGearbox:
    """Figs 7.10 to 7.13, with the damping of the mesh for the shafts too."""
    return ProportionalGearbox(
        correction_factor=correction_factor,
        gear_inertia=GEAR_INERTIA_RATIO,
        load_inertia=LOAD_INERTIA_RATIO,
        input_stiffness=input_stiffness,
        output_stiffness=output_stiffness,
        mesh_damping=damping,
        input_damping=damping,
        output_damping=damping,
    )


_BASE_9 = _inertias(gear_inertia=100.0, load_inertia=10.0)
_FIGURE_9A = TorsionalFigure(_BASE_9, "gear_inertia", 1.0, 40.0, "linear", 160.0)
_FIGURE_9B = TorsionalFigure(_BASE_9, "load_inertia", 1.0, 40.0, "linear", 160.0)
_BASE_11A, _BASE_11B = _shafts(0.5, 0.5, 0.1, 3e-6), _shafts(0.5, 0.5, 0.1, 1e-5)
_FIGURE_10A = TorsionalFigure(_BASE_11A, "input_stiffness", 0.003, 1.0, "log", 130.0)
_FIGURE_10B = TorsionalFigure(_BASE_11B, "output_stiffness", 0.003, 3.0, "log", 130.0)
_FIGURE_11A = TorsionalFigure(_BASE_11A, "input_stiffness", 0.02, 1.0, "log", 130.0)
_FIGURE_11B = TorsionalFigure(_BASE_11B, "output_stiffness", 0.03, 1.0, "log", 130.0)
_FIGURE_12A = TorsionalFigure(_shafts(0.5, 0.009, 0.1, 1e-5), "input_damping", 1e-6, 1e-3, "log", 100.0)
_FIGURE_12B = TorsionalFigure(_shafts(0.1, 0.01, 0.3, 2e-6), "input_damping", 3e-7, 3e-4, "log", 60.0)
_FIGURE_13A = TorsionalFigure(_shafts(0.5, 0.1, 0.03, 1e-5), "output_damping", 1e-6, 1e-4, "log", 100.0)
_FIGURE_13B = TorsionalFigure(_shafts(0.1, 0.01, 0.3, 2e-6), "output_damping", 3e-7, 3e-4, "log", 60.0)

FIGURES: Mapping[str, TorsionalFigure] = MappingProxyType(
    {
        "7.8a": _FIGURE_9A,
        "7.8b": _FIGURE_9B,
        "7.9a": _FIGURE_9A,
        "7.9b": _FIGURE_9B,
        "7.10a": _FIGURE_10A,
        "7.10b": _FIGURE_10B,
        "7.11a": _FIGURE_11A,
        "7.11b": _FIGURE_11B,
        "7.12a": _FIGURE_12A,
        "7.12b": _FIGURE_12B,
        "7.13a": _FIGURE_13A,
        "7.13b": _FIGURE_13B,
    }
)
"""Figures 7.8 to 7.13 with the parameters of their captions. Natural frequencies (7.8, 7.10) do without dampings."""
