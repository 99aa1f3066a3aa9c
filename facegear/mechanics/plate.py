"""The gear body: an annular plate clamped at the bore and free at the rim, with the dimensions of a drive."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from facegear.geometry.drive import Drive
from facegear.mechanics.properties import STEEL, Material
from facegear.mechanics.radial_modes import (
    BORE_RATIO_RANGE,
    MAX_NODAL_CIRCLES,
    MAX_NODAL_DIAMETERS,
    RadialModes,
    radial_modes,
)
from facegear.support.kinds import require_kinds
from facegear.support.parameters import designed, integer_within, keep, within
from facegear.support.types import FloatArray

# Kirchhoff's theory leaves out shear, which a thicker disk feels in its higher modes.
THICKNESS_RATIO_RANGE = (0.001, 0.2)


@dataclass(frozen=True)
class Body:
    """Face-gear body: an annular disk clamped at the bore, free at the outer radius of the teeth.

    Parameters
    ----------
    drive : Drive
        Its outer radius R2 (3-18) is the outer radius a of the disk.
    thickness_ratio : float
        h/a [-], 0.001 to 0.2.
    bore_radius : float
        b [m]; b/a from 0.05 to 0.9, and b below the inner radius R1 of the teeth.
    material : Material
        Density, elasticity and damping.
    nodal_circles : int
        M, the largest number of nodal circles of the modes, 0 to 4.
    nodal_diameters : int
        N, the largest number of nodal diameters, 0 to 10. With M = 1 and N = 3, the modes of chapter 4, borders of
        unstable speeds are wrong by a percent or two: raise both until what is asked for stands still.

    Raises
    ------
    TypeError, ValueError
        If an argument is of the wrong kind or outside its range.

    Examples
    --------
    >>> import facegear as fg
    >>> body = fg.Body(fg.Drive(26, 130, 3.175e-3), thickness_ratio=0.03)
    >>> body.natural_frequencies_hz().round().astype(int).tolist()  # rows: nodal circles, columns: diameters
    [[169, 159, 209, 399], [1059, 1128, 1355, 1765]]
    """

    drive: Drive
    thickness_ratio: float = field(metadata=designed("thickness of the body"))
    bore_radius: float = field(default=0.05, metadata=designed("bore radius"))
    material: Material = STEEL
    nodal_circles: int = 1
    nodal_diameters: int = 3

    def __post_init__(self) -> None:
        require_kinds(self, drive=Drive, material=Material)
        keep(self, thickness_ratio=within("thickness_ratio", self.thickness_ratio, *THICKNESS_RATIO_RANGE))
        lowest, highest = (ratio * self.outer_radius for ratio in BORE_RATIO_RANGE)
        # Inside the teeth: what is as large as their inner radius leaves no rim.
        largest = min(highest, math.nextafter(self.drive.inner_radius, 0.0))
        keep(self, bore_radius=within("bore_radius", self.bore_radius, lowest, largest, "m"))
        keep(
            self,
            nodal_circles=integer_within("nodal_circles", self.nodal_circles, 0, MAX_NODAL_CIRCLES),
            nodal_diameters=integer_within("nodal_diameters", self.nodal_diameters, 0, MAX_NODAL_DIAMETERS),
        )

    @property
    def outer_radius(self) -> float:
        """Outer radius a = R2 [m]."""
        return self.drive.outer_radius

    @property
    def thickness(self) -> float:
        """Thickness h [m]."""
        return self.thickness_ratio * self.outer_radius

    @property
    def bore_ratio(self) -> float:
        """Bore ratio c = b/a [-]."""
        return self.bore_radius / self.outer_radius

    @property
    def mass(self) -> float:
        """Mass of the disk, ρπ(a² - b²)h [kg]."""
        area = math.pi * (self.outer_radius**2 - self.bore_radius**2)
        return self.material.density * area * self.thickness

    @property
    def bending_stiffness(self) -> float:
        """D = E h³/(12 (1 - ν²)) [N m]."""
        return self.material.youngs_modulus * self.thickness**3 / (12 * (1 - self.material.poissons_ratio**2))

    @cached_property
    def modes(self) -> tuple[RadialModes, ...]:
        """Radial modes for n = 0, ..., N, on unit outer radius: R_mn(r) = modes[n](r/a)[m]/a (4-6)."""
        nu = self.material.poissons_ratio
        numbers = range(self.nodal_diameters + 1)
        return tuple(radial_modes(self.bore_ratio, nu, self.nodal_circles, n) for n in numbers)

    @cached_property
    def eigenvalues(self) -> FloatArray:
        """Squared natural frequencies at rest, β_mn⁴ D/(ρh) [1/s²] (4-9), shape (M + 1, N + 1)."""
        area_density = self.material.density * self.thickness
        roots = np.stack([modes.roots for modes in self.modes], axis=1)
        values: FloatArray = roots**4 * self.bending_stiffness / (area_density * self.outer_radius**4)
        values.setflags(write=False)
        return values

    def natural_frequencies_hz(self) -> FloatArray:
        """Undamped natural frequencies of the disk at rest.

        Returns
        -------
        ndarray, shape (M + 1, N + 1)
            Row m, column n: the mode with m nodal circles and n nodal diameters [Hz].
        """
        return np.sqrt(self.eigenvalues) / (2 * math.pi)
