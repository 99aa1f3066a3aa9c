"""Numbers of a drive that a report tells one by one: dimensions, strength of the teeth, power until flutter."""

from __future__ import annotations

import math
from typing import NamedTuple

from facegear.design.body import Requirements
from facegear.design.envelope import critical_power
from facegear.design.teeth import root_thickness
from facegear.drives.drive_file import DriveFile
from facegear.drives.verdict import powered
from facegear.mechanics.disk import reference_stiffness
from facegear.mechanics.edge_stiffness import DrivingForce, Following, complete_harmonics
from facegear.mechanics.pinions_on_disk import FaceGears, nominal_pinion_mass
from facegear.mechanics.spreads import RIM_POINT, pitch_ratio


class Row(NamedTuple):
    """One number of a table."""

    quantity: str
    value: float
    unit: str


def geometry(file: DriveFile) -> tuple[Row, ...]:
    """Dimensions of teeth and body, contact ratios, masses, and what bearings are measured by.

    Parameters
    ----------
    file : DriveFile

    Returns
    -------
    tuple of Row
        In mm, degrees, kg and N/m.
    """
    drive, model = file.drive, file.transverse.gear
    body = model.body
    force = DrivingForce(file.requirements.power, file.requirements.pinion_speed).newtons(drive)
    return (
        Row("gear ratio N2/N1", drive.gear_ratio, "1"),
        Row("pitch radius of the pinion", 1e3 * drive.pitch_radius, "mm"),
        Row("inner radius of the teeth R1", 1e3 * drive.inner_radius, "mm"),
        Row("outer radius of the teeth R2", 1e3 * drive.outer_radius, "mm"),
        Row("face width L", 1e3 * drive.face_width, "mm"),
        Row("angular pitch of the face gear", math.degrees(drive.angular_pitch), "°"),
        *(
            Row(f"contact ratio, {name}", contact.ratio(drive), "1")
            for name, contact in file.contacts.items()
        ),
        Row("thickness of the body", 1e3 * body.thickness, "mm"),
        Row("mass of the body", body.mass, "kg"),
        Row("mass of a solid pinion", nominal_pinion_mass(body), "kg"),
        Row("stiffness of the disk that bearings are measured by", reference_stiffness(body), "N/m"),
        Row("bearing stiffness", model.bearing_stiffness, "N/m"),
        Row("pinion mass", model.pinion_mass, "kg"),
        Row(f"driving force of a {powered(file.transverse)}", force, "N"),
        Row("moment of that force at the rim over that of the power", 1.0 / pitch_ratio(drive), "1"),
        *(() if file.teeth is None else (Row("stiffness of a tooth pair", file.teeth.stiffness, "N/m"),)),
    )


def strength(file: DriveFile) -> tuple[Row, ...]:
    """Bending stress at the root of the pinion's tooth against what is allowed (4-20 to 4-22).

    Parameters
    ----------
    file : DriveFile

    Returns
    -------
    tuple of Row
        Root thickness [mm], stress, allowable stress [MPa], their ratio [-], safe if above 1.
    """
    stress, allowed = file.requirements.root_stresses(file.transverse.gear.body)
    return (
        Row("root thickness of the pinion's tooth", 1e3 * root_thickness(file.drive), "mm"),
        Row("largest stress at the root", 1e-6 * stress, "MPa"),
        Row("allowable stress", 1e-6 * allowed, "MPa"),
        Row("allowable over largest stress", allowed / stress, "1"),
    )


def flutter(model: FaceGears, duty: Requirements) -> tuple[Row, ...]:
    """Power at which the driving forces alone make the disk flutter (chapter 6), against the power of the drive.

    Parameters
    ----------
    model : FaceGears
        Drive in the basis of the report; of its pinions only their angles count, and which of them drive; of its force
        where it presses, at the rim if there is none.
    duty : Requirements
        Power of each pinion, its speed, range of speed.

    Returns
    -------
    tuple of Row
        Power of a pinion; critical power of each pinion, all pinions together, for forces that follow the rim and for
        those that keep their direction, the smallest of all gears and both ends of the speed range [kW]; the former
        over the power of a pinion [-]. Between two gears power is that of each mesh, and rows are named so. Without
        viscous damping of the disk any power flutters, and the critical one is 0.
    """
    body = model.gear.body
    damped = body.material.viscous_loss_factor > 0.0

    def smallest(following: Following) -> float:
        return min(
            critical_power(
                body,
                duty.pinion_speed,
                speed,
                following=following,
                harmonics=complete_harmonics(body),
                angles=driving.angles,
                senses=driving.senses,
                highest_power=duty.power,
                spread=model.gear.force.spread if model.gear.force else RIM_POINT,
            )
            for speed in duty.speeds
            for driving in model.driving
        )

    each = powered(model)
    follower, dead = (smallest("follower"), smallest("dead")) if damped else (0.0, 0.0)
    return (
        Row(f"power of a {each}", 1e-3 * duty.power, "kW"),
        Row(f"critical power of a {each}, disk alone, force follows the rim", 1e-3 * follower, "kW"),
        Row(f"critical power of a {each}, disk alone, force keeps its direction", 1e-3 * dead, "kW"),
        Row(f"critical power over power of a {each}, force follows the rim", follower / duty.power, "1"),
    )
