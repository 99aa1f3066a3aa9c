"""A whole drive in transverse vibration: teeth, body, bearings, one to three pinions, power."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

from facegear.drives.studies.contact import TREGOLD, TRUE_SWEEP, chosen_ratio, contact_as_set, require_lines
from facegear.drives.studies.controls import (
    DEGREE,
    RPM,
    bearing_stiffness_control,
    pinion_mass_control,
    speed_control,
    thickness_control,
)
from facegear.drives.studies.force import PRESSED, force_as_set, force_controls
from facegear.drives.studies.study import Choice, Quantity, Settings, Study
from facegear.floquet.models import Model
from facegear.mechanics import cases
from facegear.mechanics.properties import MeshLoad
from facegear.mechanics.transverse import Transverse
from facegear.support.kinds import require_kind

# Angles that the second and third pinion have when they are first switched on [°].
_SECOND, _THIRD = 120.0, 240.0


def drive_study(model: Transverse | None = None, highest_speed_rpm: float = 1000.0) -> Study:
    """Transverse vibration of a whole drive: teeth, body, bearings, one to three pinions, power.

    Parameters
    ----------
    model : Transverse, optional
        Where the controls stand at first; that of Fig. 4.4(a) if left out.
    highest_speed_rpm : float
        End of the speed axis [rpm of the face gear].

    Returns
    -------
    Study

    Raises
    ------
    ValueError
        If a value of the model lies outside the range of its control, its contact ratio is neither of the two, or its
        force presses elsewhere than can be chosen.
    """
    start = cases.FIGURES["4.4a"].model() if model is None else model
    require_kind("model", start, Transverse, why="for this study")
    speed = speed_control(highest_speed_rpm)
    body, drive, load = start.body, start.body.drive, start.load
    require_lines(start.contact, drive)
    first = start.pinion_angles[0]
    degrees = [math.degrees(angle - first) % 360.0 for angle in start.pinion_angles]
    degrees += [_SECOND, _THIRD][len(degrees) - 1 :]
    ratio = chosen_ratio(start.contact, drive)

    def angles(settings: Settings) -> tuple[float, ...]:
        ahead = (0.0, settings["second_angle"], settings["third_angle"])
        return tuple(first + angle for angle in ahead[: int(settings["pinions"])])

    def build(settings: Settings) -> Model:
        gears = replace(drive, **{name: settings[name] for name in ("pinion_teeth", "gear_teeth", "module")})
        contact, there = contact_as_set(start.contact, settings, gears), angles(settings)
        return replace(
            start,
            body=replace(
                body,
                drive=gears,
                thickness_ratio=settings["thickness_ratio"],
                bore_radius=settings["bore_radius"],
            ),
            load=MeshLoad(settings["stiffness"], settings["damping"], settings["mass"]),
            pinion_angles=there,
            contact=contact,
            force=force_as_set(start.force, settings, gears, contact),
            # Phases of one's own are those of so many pinions.
            phases=start.phases if len(there) == len(start.pinion_angles) else None,
        )

    def content(settings: Settings) -> dict[str, Any]:
        return _drive_content(start, settings, [math.degrees(angle) for angle in angles(settings)])

    controls = (
        Quantity("pinion_teeth", "teeth of the pinion", 12, 60, drive.pinion_teeth, 1, whole=True),
        Quantity("gear_teeth", "teeth of the face gear", 40, 260, drive.gear_teeth, 1, whole=True),
        Quantity("module", "module [mm]", 1.0, 8.0, drive.module * 1e3, 0.025, unit=1e-3),
        thickness_control(body),
        Quantity("bore_radius", "radius of the bore [mm]", 10.0, 200.0, body.bore_radius * 1e3, 1.0, 1e-3),
        bearing_stiffness_control(load),
        Quantity(
            "damping",
            "bearing damping ζ [µs]",
            0.0,
            200.0,
            load.damping * 1e6,
            0.5,
            unit=1e-6,
            parameter="load.damping",
        ),
        pinion_mass_control(load, 0.0),
        Choice("pinions", "number of pinions", ("1", "2", "3"), str(len(start.pinion_angles))),
        Quantity(
            "second_angle",
            "angle of the 2nd [°]",
            5.0,
            355.0,
            degrees[1],
            0.1,
            unit=DEGREE,
            when=("pinions", "2", "3"),
        ),
        Quantity(
            "third_angle",
            "angle of the 3rd [°]",
            5.0,
            355.0,
            degrees[2],
            0.1,
            unit=DEGREE,
            when=("pinions", "3"),
        ),
        Choice("contact_ratio", "contact ratio", (TREGOLD, TRUE_SWEEP), ratio),
        *force_controls(start.force, start.contact, drive, highest_speed_rpm),
    )
    return Study(controls, build, "stiffness", speed, content=content)


def _drive_content(start: Transverse, settings: Settings, angles_deg: list[float]) -> dict[str, Any]:
    """Say in the words of a drive file what settings mean; its power is that at the highest speed."""
    highest, drive, material = settings["highest_speed"] / RPM, start.body.drive, start.body.material
    content = {
        "name": "From the explorer",
        "gears": {
            "pinion_teeth": settings["pinion_teeth"],
            "gear_teeth": settings["gear_teeth"],
            "module_mm": settings["module"] * 1e3,
            "pressure_angle_deg": math.degrees(drive.pressure_angle),
            "shaft_angle_deg": math.degrees(drive.shaft_angle),
        },
        "body": {
            "thickness_ratio": settings["thickness_ratio"],
            "bore_radius_mm": settings["bore_radius"] * 1e3,
            "nodal_circles": start.body.nodal_circles,
            "nodal_diameters": start.body.nodal_diameters,
        },
        "material": {
            "density_kg_per_m3": material.density,
            "youngs_modulus_GPa": material.youngs_modulus * 1e-9,
            "poissons_ratio": material.poissons_ratio,
            "viscous_loss_factor_us": material.viscous_loss_factor * 1e6,
            "yield_strength_MPa": material.yield_strength * 1e-6,
        },
        "pinions": {
            "stiffness": settings["stiffness"],
            "damping_us": settings["damping"] * 1e6,
            "mass": settings["mass"],
            "angles_deg": angles_deg,
            "contact_ratio": "geometric" if settings["contact_ratio"] == TRUE_SWEEP else "tregold",
        },
        "operation": {
            "lowest_speed_rpm": highest / 20.0,
            "highest_speed_rpm": highest,
            "power_kW": settings["power"] * 1e-3,
            "pinion_speed_rpm": highest * settings["gear_teeth"] / settings["pinion_teeth"],
            "force_at": PRESSED[settings["force_at"]],
        },
    }
    return {name: _tidied(part) for name, part in content.items()}


def _tidied(part: Any) -> Any:
    """Numbers to twelve digits, without what conversion to SI and back adds."""
    if isinstance(part, dict):
        return {name: _tidied(value) for name, value in part.items()}
    if isinstance(part, list):
        return [_tidied(value) for value in part]
    return float(f"{part:.12g}") if isinstance(part, float) else part
