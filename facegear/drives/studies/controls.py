"""Controls that several studies have, and models as their controls stand."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TypeVar

from facegear.drives.studies.study import Quantity, Settings
from facegear.floquet.models import Model, replace_parameter, value_of
from facegear.mechanics.plate import Body
from facegear.mechanics.properties import MeshLoad
from facegear.support.parameters import rad_per_s

ModelT = TypeVar("ModelT", bound=Model)

RPM = float(rad_per_s(1.0))
DEGREE = math.pi / 180.0


def speed_control(highest_rpm: float) -> Quantity:
    """Return the control of the highest speed on the axis of a map."""
    return Quantity(
        "highest_speed", "speed of the face gear [rpm]", 100.0, 3000.0, highest_rpm, 50.0, unit=RPM
    )


def thickness_control(body: Body) -> Quantity:
    """Return the control of h/a, at first where that of a body is."""
    here = body.thickness_ratio
    return Quantity(
        "thickness_ratio", "thickness h/a", 0.015, 0.09, here, 0.0005, parameter="body.thickness_ratio"
    )


def bearing_stiffness_control(load: MeshLoad) -> Quantity:
    """Return the control of μ, at first where that of a load is."""
    return Quantity(
        "stiffness", "bearing stiffness μ", 0.0, 2.0, load.stiffness, 0.05, parameter="load.stiffness"
    )


def pinion_mass_control(load: MeshLoad, least: float) -> Quantity:
    """Return the control of τ from the least on, at first where that of a load is."""
    return Quantity("mass", "pinion mass τ", least, 2.0, load.mass, 0.05, parameter="load.mass")


def parameter_control(
    start: Model, name: str, label: str, lowest: float, highest: float, step: float, unit: float = 1.0
) -> Quantity:
    """Return the control of a parameter, at first where that of a model is."""
    value = value_of(start, name) / unit
    return Quantity(name, label, lowest, max(highest, value), value, step, unit, parameter=name)


def with_parameters(start: ModelT, controls: Sequence[Quantity], settings: Settings) -> ModelT:
    """Return a model with what the reader has set of its parameters."""
    for control in controls:
        if control.parameter is not None and control.name in settings:
            start = replace_parameter(start, control.parameter, settings[control.name])
    return start
