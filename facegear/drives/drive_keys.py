"""All keys of a drive file, section by section: the one table that checks, JSON Schema and documentation go by.

Units are those of a workshop and part of each key's name; inside the package everything is SI.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from facegear.drives.flexible_teeth import CENTROID, SHARING
from facegear.drives.forces import PLACES, RIM
from facegear.drives.keys import PER_SI, Key, Section
from facegear.geometry.proportions import FEWEST_TEETH
from facegear.mechanics.plate import THICKNESS_RATIO_RANGE
from facegear.mechanics.properties import STEEL
from facegear.mechanics.radial_modes import MAX_NODAL_CIRCLES, MAX_NODAL_DIAMETERS
from facegear.mechanics.two_gears import DRIVES

# Tongues crowd towards standstill: their number, and the time to find them, goes with highest over lowest speed.
WIDEST_SPEED_RATIO = 50.0
# Sentences have speeds to four digits: ends that are closer to one another read as one speed.
NARROWEST_SPEED_RATIO = 1.001
# What a choice is that the drive itself decides.
USUAL = "usual"


def _count(
    name: str, meaning: str, lowest: int, highest: int, default: int | None = None, *, or_zero: bool = False
) -> Key:
    return Key(name, meaning, "integer", "", lowest, highest, or_zero=or_zero, default=default)


def _time(name: str, meaning: str, default: float | None = None) -> Key:
    """Damping as a time [µs]; a nonzero value so small that it must be in seconds is refused."""
    return Key(name, meaning, "number", "µs", 1e-3, 1e4, or_zero=True, default=default)


def _ratio(name: str, meaning: str, no_unit: str) -> Key:
    return Key(name, meaning, "number", "", 1e-6, 1e3, or_zero=True, no_unit=no_unit)


NAME = Key("name", "name of the drive, for titles: any characters, not all of them blank", "text")

_GEARS = Section(
    "Teeth of the pinion, of the shaper that cuts the face gear, and of the face gear.",
    (
        _count("pinion_teeth", "$N_1$, teeth of the pinion", 10, 300),
        _count("gear_teeth", "$N_2$, teeth of the face gear, more than the pinion's", 11, 3000),
        _count(
            "shaper_teeth",
            "$N_s$, teeth of the shaper: 0 for those of the pinion and contact along lines; more for contact at a "
            "point that spreads under load",
            FEWEST_TEETH,
            2999,
            0,
            or_zero=True,
        ),
        Key("module_mm", "$m_d$, module; not a diametral pitch", "number", "mm", 0.1, 100.0),
        Key(
            "diametral_pitch_per_inch",
            "$P_d = 1/m_d$, teeth per inch of diameter; 8 is a module of 3.175 mm",
            "number",
            "1/in",
            0.3,
            200.0,
            quantity="module",
        ),
        Key("pressure_angle_deg", "$\\alpha_c$, pressure angle", "number", "°", 14.5, 30.0, default=25.0),
        Key("shaft_angle_deg", "$\\gamma$, angle between the axes", "number", "°", 60.0, 120.0, default=90.0),
    ),
)
_BODY = Section(
    "Body of the face gear: a disk clamped at the bore, as large as the teeth reach.",
    (
        Key(
            "thickness_ratio",
            "$h/a$, thickness over outer radius",
            "number",
            "",
            *THICKNESS_RATIO_RANGE,
            no_unit="mm",
        ),
        Key(
            "bore_radius_mm",
            "$b$, bore radius; also 0.05 to 0.9 of the outer radius, and inside the teeth",
            "number",
            "mm",
            0.1,
            5000.0,
        ),
        _count("nodal_circles", "$M$, nodal circles of the modes", 0, MAX_NODAL_CIRCLES, 1),
        _count("nodal_diameters", "$N$, nodal diameters of the modes", 0, MAX_NODAL_DIAMETERS, 3),
    ),
)
_MATERIAL = Section(
    "Material of the body; the steel of table 4.3 if left out.",
    (
        Key("density_kg_per_m3", "$\\rho$, density", "number", "kg/m³", 100.0, 30e3, default=STEEL.density),
        Key(
            "youngs_modulus_GPa",
            "$E$, Young's modulus",
            "number",
            "GPa",
            0.1,
            2000.0,
            default=STEEL.youngs_modulus * PER_SI["GPa"],
        ),
        Key(
            "poissons_ratio", "$\\nu$, Poisson's ratio", "number", "", 0.0, 0.5, default=STEEL.poissons_ratio
        ),
        _time(
            "viscous_loss_factor_us", "$\\xi$, viscous loss factor", STEEL.viscous_loss_factor * PER_SI["µs"]
        ),
        Key(
            "yield_strength_MPa",
            "$\\sigma_Y$, yield strength",
            "number",
            "MPa",
            1.0,
            1e4,
            default=STEEL.yield_strength * PER_SI["MPa"],
        ),
    ),
    required=False,
    assumed=True,
)
_PINIONS = Section(
    "Pinions and their bearings, all alike, as the body feels them.",
    (
        _ratio("stiffness", "$\\mu$, bearing stiffness over that of the disk (4-17)", "N/m"),
        _time("damping_us", "$\\zeta$, bearing damping over bearing stiffness (4-18)"),
        _ratio("mass", "$\\tau$, pinion mass over that of a solid cylinder (4-19)", "kg"),
        Key(
            "angles_deg",
            "$\\theta_c$ of each pinion, so far apart that no two touch",
            "numbers",
            "°",
            -360.0,
            360.0,
            default=(0.0,),
        ),
        Key(
            "contact_ratio",
            "time a tooth pair stays in mesh. Shaper with the pinion's teeth: Tregold's, as printed (usual), or that "
            "of the true sweep (geometric). With more: under the torque of `operation` (loaded, usual) or without load",
            "choice",
            default=USUAL,
            choices=(USUAL, "tregold", "geometric", "loaded", "unloaded"),
        ),
    ),
)
_OPERATION = Section(
    "What the drive has to do.",
    (
        Key(
            "lowest_speed_rpm",
            f"lowest speed of the face gear, at least 1/{WIDEST_SPEED_RATIO:g} of the highest",
            "number",
            "rpm",
            1.0,
            1e5,
        ),
        Key(
            "highest_speed_rpm",
            f"highest speed of the face gear, at least {NARROWEST_SPEED_RATIO:g} times the lowest; its rim at most 0.2 "
            "times as fast as sound in its material",
            "number",
            "rpm",
            1.0,
            1e5,
        ),
        Key("power_kW", "power of one pinion", "number", "kW", 1e-2, 1e5),
        Key("power_hp", "power of one pinion (745.69987 W)", "number", "hp", 1e-2, 1e5),
        Key("pinion_speed_rpm", "speed of the pinion at that power", "number", "rpm", 1.0, 1e6),
        Key("safety_factor", "safety factor against yielding (4-22)", "number", "", 1.0, 100.0, default=1.5),
        Key(
            "force_at",
            "where the driving force of the power presses: one point of the rim, as printed (rim), or of the pitch "
            "circle (pitch); face and root of one tooth (tooth), or of the tooth pairs in mesh (pairs, chapter 8). "
            "Everywhere it has the moment of the printed force, which is at the rim: that of the power times outer "
            "over pitch radius of the gear",
            "choice",
            default=RIM,
            choices=PLACES,
        ),
    ),
)


def _inertia(name: str, meaning: str) -> Key:
    return Key(name, meaning, "number", "kg m²", 1e-9, 1e9)


def _length_of_shaft(name: str, meaning: str) -> Key:
    meaning = f"{meaning}, of the material of the body; 0 for a massless one. It has as many modes as the mesh asks for"
    return Key(name, meaning, "number", "mm", 1.0, 2e4, or_zero=True, default=0.0)


def _shaft(name: str, meaning: str) -> Key:
    return Key(name, meaning, "number", "N m/rad", 1e-3, 1e12)


_GEARBOX = Section(
    "Shafts and inertias for torsional vibration; without it the report leaves torsion out.",
    (
        _inertia("pinion_inertia_kg_m2", "$J_1$, pinion with what turns with it"),
        _inertia("gear_inertia_kg_m2", "$J_2$, face gear"),
        _inertia("load_inertia_kg_m2", "$J_o$, load"),
        Key("mesh_stiffness_N_per_m", "$k_m$, stiffness of a tooth pair (7-2)", "number", "N/m", 1e3, 1e12),
        _time("mesh_damping_us", "$c_m/k_m$, mesh damping over mesh stiffness"),
        _shaft("input_stiffness_Nm_per_rad", "$k_1$, stiffness of the input shaft"),
        _time("input_damping_us", "$c_1/k_1$, its damping over its stiffness"),
        _shaft("output_stiffness_Nm_per_rad", "$k_2$, stiffness of the output shaft"),
        _time("output_damping_us", "$c_2/k_2$, its damping over its stiffness"),
        _length_of_shaft("input_length_mm", "$l_1$, length of the input shaft"),
        _length_of_shaft("output_length_mm", "$l_2$, length of the output shaft"),
        Key(
            "backlash_um",
            "play of the teeth along the line of action, for what becomes of tongues in torsion; 0 for none",
            "number",
            "µm",
            0.1,
            1e5,
            or_zero=True,
            default=0.0,
            quantity="gap",
        ),
        Key(
            "damaged_tooth_percent",
            "part of its stiffness and damping that one tooth of the face gear has lost, for what would show it; 0 for "
            "none",
            "number",
            "%",
            0.1,
            99.0,
            or_zero=True,
            default=0.0,
            quantity="loss",
        ),
        Key(
            "arm",
            "moment arm of the mesh force: as printed (7-3), or the constant one of conjugate teeth",
            "choice",
            default="printed",
            choices=("printed", "conjugate"),
        ),
    ),
    required=False,
)

_TEETH = Section(
    "Teeth as springs between gear and pinions (chapter 8); without it they are rigid. The springs follow the contact, "
    "whose lines must not end on the pinion's base circle: 22 teeth of the pinion are enough at a pressure angle of "
    "25°, 34 at 20°; whether fewer are depends on the gear ratio, and a file with too few is refused.",
    (
        Key(
            "correction_factor",
            "$c_f$ (7-2), what bodies and bearings leave of the stiffness of teeth: 0 for what the mesh stiffness of "
            "`gearbox` makes it, or 0.5",
            "number",
            "",
            1e-6,
            1.0,
            or_zero=True,
            default=0.0,
        ),
        Key(
            "tooth_damping_us",
            "$c_m/k_m$, mesh damping over mesh stiffness: 0 for that of `gearbox`; without one it must be given",
            "number",
            "µs",
            1e-3,
            1e4,
            or_zero=True,
            default=0.0,
            quantity="mesh_damping",
        ),
        Key(
            "sharing",
            "how tooth pairs share the load: as one at their centre (centroid); each by the length of its contact line "
            "over that of all (length_share) or over the mean of that (length); equally; at a point, by how the load "
            "presses them (compliance)",
            "choice",
            default=CENTROID,
            choices=SHARING,
        ),
        Key(
            "sides",
            "face of the gear that each pinion meshes with, 1 for the front or -1 for the back; none for all the front",
            "choices",
            default=(),
            choices=(1, -1),
        ),
        Key(
            "clocking",
            "phase by which the teeth of the back face are ahead of those of the front, in mesh periods; it needs a "
            "pinion on the back face",
            "number",
            "",
            -1.0,
            1.0,
            default=0.0,
            hint="in mesh periods, not in degrees?",
        ),
    ),
    required=False,
)

_SECOND_GEAR = Section(
    "A second face gear, facing the first, that meshes with the same pinions (chapter 8); it needs `teeth`, all on one "
    "face. Angles of pinions then differ by whole halves of the angular pitch, and the power of `operation` is that of "
    "each mesh.",
    (
        Key(
            "roles",
            "what each pinion does: it drives both gears (input), takes power from the second gear for the first "
            "(idler), or is driven by both (output); at least one is an input",
            "choices",
            choices=tuple(DRIVES),
        ),
    ),
    required=False,
)


def _tolerance(name: str, meaning: str) -> Key:
    return Key(name, meaning, "number", "%", 0.1, 50.0, or_zero=True, default=0.0)


_TOLERANCES = Section(
    "How far the drive may be from what the file says, to either side, for `facegear assess`.",
    (
        _tolerance(
            "stiffness_percent",
            "of stiffness: bearings and teeth together, those of a contact under load too (up to $c_f = 1$); in "
            "torsion, the teeth of `gearbox`",
        ),
        _tolerance(
            "damping_percent",
            "of damping: bearings, flexible teeth and the body's material together; in torsion, the teeth of `gearbox`",
        ),
        _tolerance("shaft_stiffness_percent", "of the stiffness of the shafts of `gearbox`, both together"),
        _tolerance("shaft_damping_percent", "of the damping of the shafts of `gearbox`, both together"),
        _tolerance("speed_percent", "of speed: below the lowest and above the highest operating speed"),
    ),
    required=False,
    assumed=True,
)

SECTIONS: Mapping[str, Section] = MappingProxyType(
    {
        "gears": _GEARS,
        "body": _BODY,
        "material": _MATERIAL,
        "pinions": _PINIONS,
        "teeth": _TEETH,
        "second_gear": _SECOND_GEAR,
        "operation": _OPERATION,
        "gearbox": _GEARBOX,
        "tolerances": _TOLERANCES,
    }
)
"""Keys of a drive file, section by section."""
