"""The two face-gear drives of the dissertation, and the parameters its figures print (tables 4.1 to 4.3, captions)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

from facegear.geometry.drive import Drive
from facegear.mechanics.plate import Body
from facegear.mechanics.properties import MeshLoad
from facegear.mechanics.transverse import Transverse

MODULE = 25.4e-3 / 8
"""Module of both drives, diametral pitch 8 per inch [m] (table 4.1)."""

HIGHEST_SPEED_RPM = 1000.0
"""Highest speed of the face gear: 5000 rpm of the pinion at a gear ratio of 5 (tables 4.1, 4.2)."""

CASE_1 = Body(Drive(26, 130, MODULE), thickness_ratio=0.03, bore_radius=0.05)
"""Case I of tables 4.1 to 4.3."""

CASE_2 = Body(Drive(31, 155, MODULE), thickness_ratio=0.05, bore_radius=0.05)
"""Case II of tables 4.1 to 4.3."""


@dataclass(frozen=True)
class StabilityFigure:
    """A stability map over the speed of the face gear, as a caption describes it.

    Attributes
    ----------
    body : Body
        Case I or Case II.
    load : MeshLoad
        μ, ζ, τ of the caption; the axis of the map replaces the swept one.
    parameter : {"stiffness", "damping", "mass"}
        Parameter on the vertical axis.
    highest : float
        End of the vertical axis, in the parameter's unit. Axes are not printed: it is chosen so that what the
        text says can be seen.
    """

    body: Body
    load: MeshLoad
    parameter: str
    highest: float

    def model(self, **options: Any) -> Transverse:
        """Return the model of the figure; `options` are those of :class:`facegear.mechanics.transverse.Transverse`."""
        return Transverse(self.body, self.load, **options)


FIGURES: Mapping[str, StabilityFigure] = MappingProxyType(
    {
        "4.4a": StabilityFigure(CASE_1, MeshLoad(stiffness=1.0, damping=3e-6, mass=1.0), "stiffness", 2.0),
        "4.4b": StabilityFigure(CASE_1, MeshLoad(stiffness=0.6, damping=0.0, mass=1.0), "damping", 2e-4),
        "4.4c": StabilityFigure(CASE_1, MeshLoad(stiffness=0.6, damping=3e-6, mass=1.0), "mass", 2.0),
        "4.5a": StabilityFigure(CASE_2, MeshLoad(stiffness=1.0, damping=1e-6, mass=1.0), "stiffness", 1.0),
        "4.5b": StabilityFigure(CASE_2, MeshLoad(stiffness=0.25, damping=0.0, mass=1.0), "damping", 2e-4),
        "4.5c": StabilityFigure(CASE_2, MeshLoad(stiffness=0.25, damping=1e-6, mass=1.0), "mass", 2.0),
    }
)
"""Figures 4.4 and 4.5 with the parameters of their captions."""

EXAMPLE_A = Transverse(
    Body(Drive(26, 130, MODULE), thickness_ratio=0.05, bore_radius=0.05),
    MeshLoad(stiffness=1.5, damping=1e-6, mass=0.8),
)
"""Example A of section 5.5; figures replace the pinion angles."""

EXAMPLE_B = Transverse(
    Body(Drive(31, 155, MODULE), thickness_ratio=0.07, bore_radius=0.05),
    MeshLoad(stiffness=0.25, damping=1e-5, mass=1.0),
)
"""Example B of section 5.5; figures replace the pinion angles."""

POWER_SPEED_RPM = 5000.0
"""Speed of the pinion at which section 6.4 gives powers [rpm]."""

POWERS_HP: Mapping[str, tuple[float, ...]] = MappingProxyType(
    {"6.6": (100.0, 300.0, 600.0), "6.7": (600.0, 800.0, 1000.0)}
)
"""Powers of the captions of Figs 6.6 (Case I, otherwise Fig. 4.4(a)) and 6.7 (Case II, Fig. 4.5(a)) [hp]."""
