"""Pinion teeth of the stability-based design (sections 4.5, 4.7): families of drives, root thickness and stress."""

from __future__ import annotations

import math

from facegear.geometry.drive import Drive
from facegear.geometry.proportions import DEDENDUM
from facegear.support.parameters import integer_at_least, positive, within

MODULE = 25.4e-3 / 8
"""Module of the designs with constant diametral pitch, P_d = 8 (1/in) [m]."""
PITCH_RADIUS = 1.9375 * 25.4e-3
"""Pitch radius of the designs with constant pitch radius, 1.9375 in [m] (printed beside it: 49.2 mm)."""
GEAR_RATIO = 5
"""N2/N1 of both families of designs."""


def constant_diametral_pitch(
    pinion_teeth: int, module: float = MODULE, gear_ratio: int = GEAR_RATIO
) -> Drive:
    """Drive of the family with constant diametral pitch (section 4.7.1).

    Parameters
    ----------
    pinion_teeth : int
        N1.
    module : float
        m_d = 1/P_d [m].
    gear_ratio : int
        N2/N1, at least 2.

    Raises
    ------
    TypeError, ValueError
        As :class:`facegear.geometry.drive.Drive`, or a ratio that is not a whole number of at least 2.
    """
    teeth = integer_at_least("pinion_teeth", pinion_teeth, 1)
    return Drive(teeth, integer_at_least("gear_ratio", gear_ratio, 2) * teeth, module)


def constant_pitch_radius(
    pinion_teeth: int, pitch_radius: float = PITCH_RADIUS, gear_ratio: int = GEAR_RATIO
) -> Drive:
    """Drive of the family with constant pinion pitch radius (section 4.7.2).

    Parameters
    ----------
    pinion_teeth : int
        N1.
    pitch_radius : float
        r_p [m].
    gear_ratio : int
        N2/N1, at least 2.

    Raises
    ------
    TypeError, ValueError
        As :func:`constant_diametral_pitch`, or a radius that is not a positive number.
    """
    teeth = integer_at_least("pinion_teeth", pinion_teeth, 1)
    module = 2 * positive("pitch_radius", pitch_radius, "m") / teeth
    return constant_diametral_pitch(teeth, module, gear_ratio)


def tooth_thickness(drive: Drive, radius: float) -> float:
    """Chord of the pinion's tooth at a circle about its axis [m].

    The tooth is half a pitch thick, an arc, at the pitch circle. Outside the base circle the flanks are involutes,
    inside it they are taken as radial.

    Parameters
    ----------
    drive : Drive
    radius : float
        Between dedendum and tip circle [m].

    Raises
    ------
    TypeError, ValueError
        If `radius` is not a number in that interval.
    """
    radius = within("radius", radius, drive.dedendum_radius, drive.pinion_tip_radius, "m")
    roll = math.acos(min(drive.base_radius / radius, 1.0))
    involute = math.tan(drive.pressure_angle) - drive.pressure_angle
    half_angle = math.pi / (2 * drive.pinion_teeth) + involute - (math.tan(roll) - roll)
    return 2 * radius * math.sin(half_angle)


def root_thickness(drive: Drive) -> float:
    """Root thickness W of the pinion's tooth for (4-20): its chord at the dedendum circle [m].

    The text defines W by a sketch only. Fillets are left out.
    """
    return tooth_thickness(drive, drive.dedendum_radius)


def root_stress(drive: Drive, power: float, pinion_speed: float, thickness: float | None = None) -> float:
    """Largest bending stress at the root of the pinion's tooth (4-20, 4-21).

    Parameters
    ----------
    drive : Drive
    power : float
        P [W].
    pinion_speed : float
        Ω1 [rad/s].
    thickness : float, optional
        Root thickness W [m]; :func:`root_thickness` if left out.

    Returns
    -------
    float
        σ_max = 6 F_t H/(L W²), F_t = P/(Ω1 r_p), with dedendum H and face width L = L2 - L1 [Pa].

    Raises
    ------
    TypeError, ValueError
        If a number is not positive.
    """
    power, pinion_speed = positive("power", power, "W"), positive("pinion_speed", pinion_speed, "rad/s")
    root = root_thickness(drive) if thickness is None else positive("thickness", thickness, "m")
    force = power / (pinion_speed * drive.pitch_radius)
    return 6 * force * DEDENDUM * drive.module / (drive.face_width * root**2)
