"""Pinions, teeth and contacts that a drive file describes, and whether they go together."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, cast

from facegear.drives.contacts import NAMES, USUAL_CORRECTION, transverse_contacts
from facegear.drives.drive_keys import USUAL
from facegear.drives.file_values import FileValues
from facegear.drives.flexible_teeth import FlexibleTeeth
from facegear.drives.refusals import built
from facegear.geometry.drive import Drive
from facegear.geometry.phases import touching_angle
from facegear.mechanics.contact import Contact
from facegear.mechanics.properties import Material
from facegear.mechanics.tooth_stiffness import mesh_stiffness
from facegear.mechanics.two_gears import Role, fitting_angles


def faces_of_pinions(teeth: dict[str, Any] | None, pinions: int) -> Sequence[int]:
    """Face of the gear that each pinion meshes with."""
    sides = (teeth and teeth["sides"]) or (1,) * pinions
    if len(sides) != pinions:
        raise ValueError(
            f"teeth.sides must list 1 or -1 for each pinion of pinions.angles_deg, {pinions} in all, got {list(sides)}"
        )
    if teeth and teeth["clocking"] and -1 not in sides:
        raise ValueError(
            "teeth.clocking must be 0 or left out where teeth.sides has no pinion on the back face (-1), got "
            f"{teeth['clocking']:.6g}"
        )
    return sides


def roles_of_pinions(found: FileValues, drive: Drive) -> tuple[Role, ...] | None:
    """Check what each pinion does between two gears, if the file has a second one."""
    if found.values["second_gear"] is None:
        return None
    roles, teeth = found.values["second_gear"]["roles"], found.values["teeth"]
    angles = found.values["pinions"]["angles"]
    if teeth is None:
        raise ValueError(
            "second_gear must stand beside a section teeth: pinions between gears hang on their springs"
        )
    if teeth["sides"] or teeth["clocking"]:
        raise ValueError(
            "teeth.sides and teeth.clocking must be left out beside second_gear: each gear has teeth on one face"
        )
    if abs(drive.shaft_angle - math.pi / 2.0) > 1e-9:
        raise ValueError(
            f"{found.key('gears', 'shaft_angle')} must be 90° beside second_gear, or two gears on one axis are not "
            f"alike, got {math.degrees(drive.shaft_angle):.6g}°"
        )
    if len(roles) != len(angles) or "input" not in roles:
        raise ValueError(
            f"second_gear.roles must list one role for each of {len(angles)} pinions, an input among them, got "
            f"{list(roles)}"
        )
    for i, (angle, near) in enumerate(zip(angles, fitting_angles(drive, angles), strict=True)):
        if angle != near:
            raise ValueError(
                f"pinions.angles_deg[{i}] must differ from the first by a whole number of halves of the angular pitch, "
                f"{math.degrees(drive.angular_pitch) / 2.0:.10g}°, for teeth to fit into both gears, got "
                f"{math.degrees(angle):.10g}°; the nearest that fits is {math.degrees(near):.10g}°"
            )
    return cast("tuple[Role, ...]", roles)


def flexible_teeth(
    found: FileValues, drive: Drive, material: Material, stiffness: float | None
) -> FlexibleTeeth:
    """Springs of the teeth, as stiff and damped as the gearbox beside them says, if there is one."""
    values, gearbox = found.values["teeth"], found.values["gearbox"]
    if found.values["pinions"]["mass"] == 0.0:
        raise ValueError("pinions.mass must be greater than 0 for a pinion on flexible teeth to move, got 0")
    damping = values["mesh_damping"]
    if gearbox is None and damping == 0.0:
        raise ValueError(
            "teeth.tooth_damping_us is missing, or 0: without a section gearbox, whose mesh damping it would be, it "
            f"must be {found.keys['teeth']['mesh_damping'].valid.removeprefix('0, or ')}"
        )
    if gearbox:
        if gearbox["mesh_damping"] == 0.0:
            raise ValueError(
                "gearbox.mesh_damping_us must be greater than 0 beside a section teeth, whose springs have that "
                "damping, got 0 µs"
            )
        if damping not in (0.0, gearbox["mesh_damping"]):
            raise ValueError(
                "teeth.tooth_damping_us must be left out, or be that of gearbox.mesh_damping_us, "
                f"{found.shown('gearbox', 'mesh_damping')}, got {found.shown('teeth', 'mesh_damping')}"
            )
        damping = gearbox["mesh_damping"]
    if stiffness is None:
        stiffness = mesh_stiffness(drive, USUAL_CORRECTION, material)
    return FlexibleTeeth(stiffness, damping, values["sharing"], values["sides"], values["clocking"])


def pair_stiffness(found: FileValues, drive: Drive, material: Material) -> float | None:
    """k_m of a tooth pair [N/m] that the file gives, if it does."""
    gearbox, teeth = found.values["gearbox"], found.values["teeth"]
    own = teeth["correction_factor"] if teeth else 0.0
    if gearbox and own:
        raise ValueError(
            "teeth.correction_factor must be 0 or left out beside gearbox.mesh_stiffness_N_per_m, which says the same, "
            f"got {own!r}"
        )
    if gearbox:
        return float(gearbox["mesh_stiffness"])
    return mesh_stiffness(drive, own, material) if own else None


def possible_contacts(
    found: FileValues, drive: Drive, material: Material, stiffness: float | None, asked: str
) -> dict[str, Contact]:
    """Contacts that the teeth can have, under load that of the power; the one that the file asks for first."""
    operation = found.values["operation"]
    torque = operation["power"] / operation["pinion_speed"]
    possible = built(found, "gearbox", lambda: transverse_contacts(drive, torque, material, stiffness))
    if asked != USUAL and asked not in possible:
        raise ValueError(
            f"{found.key('pinions', 'contact_ratio')} must be {', '.join([USUAL, *possible])} for a shaper of "
            f"{drive.generating.pinion_teeth} teeth and a pinion of {drive.pinion_teeth}, got {asked!r}"
        )
    return {NAMES[name]: possible[name] for name in sorted(possible, key=lambda name: name != asked)}


def check_angles(drive: Drive, angles: Sequence[float], faces: Sequence[int]) -> None:
    """Check that no two pinions of a face are in each other's way, in the file's unit."""
    least = touching_angle(drive)
    for i, angle in enumerate(angles):
        for j in range(i):
            apart = abs(math.remainder(angle - angles[j], 2 * math.pi))
            if faces[i] == faces[j] and apart < least:
                raise ValueError(
                    f"pinions.angles_deg[{i}] must differ from the other angles, full turns apart, by at least "
                    f"{math.degrees(least):.4g}°, where the tips of these pinions touch, got "
                    f"{math.degrees(angle):.6g}° beside {math.degrees(angles[j]):.6g}°"
                )
