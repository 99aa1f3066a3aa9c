"""What the live explorers of the book explore: drives, classical equations, gearboxes sound and damaged."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, TypeVar

from facegear.drives.explore import Choice, Quantity, Settings, Study
from facegear.drives.flexible_teeth import CENTROID, FlexibleTeeth
from facegear.drives.forces import RIM, pressed
from facegear.floquet.models import Model, replace_parameter, value_of
from facegear.floquet.periodic import named
from facegear.geometry.drive import Drive
from facegear.geometry.kinematics import ContactPath
from facegear.mechanics import cases, gearboxes
from facegear.mechanics.classical import Mathieu, Meissner
from facegear.mechanics.contact import Contact
from facegear.mechanics.edge_stiffness import DrivingForce, Following
from facegear.mechanics.heavy_shafts import HeavyShafts
from facegear.mechanics.mesh_oscillator import MeshOscillator
from facegear.mechanics.plate import Body
from facegear.mechanics.sharing import RULES
from facegear.mechanics.torsional import Gearbox, Torsional, mesh_stiffness
from facegear.mechanics.transverse import Transverse
from facegear.mechanics.two_gears import TwoGears
from facegear.support.parameters import WATT_PER_HORSEPOWER, MeshLoad, rad_per_s

ModelT = TypeVar("ModelT", bound=Model)

TREGOLD, TRUE_SWEEP = "Tregold, as printed", "true sweep"

FOLLOWER, DEAD = "follows the rim", "keeps its direction"
RIM_ONLY = "one point of the rim"
_DIRECTIONS: dict[Following, str] = {"follower": FOLLOWER, "dead": DEAD}
# The words of a reader for those of a drive file.
PRESSED = {RIM_ONLY: RIM, "the pitch point": "pitch", "one tooth": "tooth", "the pairs in mesh": "pairs"}

_RPM = float(rad_per_s(1.0))
_DEGREE = math.pi / 180.0
# Angles that the second and third pinion have when they are first switched on [°].
_SECOND, _THIRD = 120.0, 240.0


def _speed(highest_rpm: float) -> Quantity:
    return Quantity(
        "highest_speed", "speed of the face gear [rpm]", 100.0, 3000.0, highest_rpm, 50.0, unit=_RPM
    )


def _thickness(body: Body) -> Quantity:
    here = body.thickness_ratio
    return Quantity(
        "thickness_ratio", "thickness h/a", 0.015, 0.09, here, 0.0005, parameter="body.thickness_ratio"
    )


def _bearing_stiffness(load: MeshLoad) -> Quantity:
    return Quantity(
        "stiffness", "bearing stiffness μ", 0.0, 2.0, load.stiffness, 0.05, parameter="load.stiffness"
    )


def _pinion_mass(load: MeshLoad, least: float) -> Quantity:
    return Quantity("mass", "pinion mass τ", least, 2.0, load.mass, 0.05, parameter="load.mass")


def _require_kind(name: str, value: object, *kinds: type) -> None:
    """Refuse what a study cannot show."""
    if not isinstance(value, kinds):
        wanted = " or ".join(f"a {kind.__name__}" for kind in kinds)
        raise TypeError(f"{name} must be {wanted} for this study, got {named(value)}")


def _require_lines(contact: Contact, drive: Drive) -> None:
    """Refuse contacts that the choice of a contact ratio would replace."""
    if contact.path != ContactPath or contact.sharing == "each" or not drive.has_line_contact:
        raise ValueError(
            "contact of the model must be that of lines as one load, whose contact ratio a reader chooses, got "
            f"{contact!r}"
        )


def _clock(contact: Contact, drive: Drive) -> str:
    """Which of the contact ratios that a reader chooses a contact has."""
    clocks = {TREGOLD: drive.contact_ratio, TRUE_SWEEP: drive.geometric_contact_ratio}
    own = drive.contact_ratio if contact.contact_ratio is None else contact.contact_ratio
    ratio = next((name for name, value in clocks.items() if value == own), None)
    if ratio is None:
        raise ValueError(
            f"contact_ratio of the model must be {clocks[TREGOLD]:.6g} (Tregold) or {clocks[TRUE_SWEEP]:.6g} (true "
            f"sweep) for these teeth, got {own!r}"
        )
    return ratio


def _contact(start: Contact, settings: Settings, drive: Drive) -> Contact:
    """Contact of a model on the clock that the reader picks."""
    swept = settings["contact_ratio"] == TRUE_SWEEP
    return replace(start, contact_ratio=drive.geometric_contact_ratio if swept else None)


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
    _require_kind("model", start, Transverse)
    speed = _speed(highest_speed_rpm)
    body, drive, load = start.body, start.body.drive, start.load
    _require_lines(start.contact, drive)
    first = start.pinion_angles[0]
    degrees = [math.degrees(angle - first) % 360.0 for angle in start.pinion_angles]
    degrees += [_SECOND, _THIRD][len(degrees) - 1 :]
    ratio = _clock(start.contact, drive)

    def angles(settings: Settings) -> tuple[float, ...]:
        ahead = (0.0, settings["second_angle"], settings["third_angle"])
        return tuple(first + angle for angle in ahead[: int(settings["pinions"])])

    def build(settings: Settings) -> Model:
        gears = replace(drive, **{name: settings[name] for name in ("pinion_teeth", "gear_teeth", "module")})
        contact, there = _contact(start.contact, settings, gears), angles(settings)
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
            force=_force(start.force, settings, gears, contact),
            # Phases of one's own are those of so many pinions.
            phases=start.phases if len(there) == len(start.pinion_angles) else None,
        )

    def content(settings: Settings) -> dict[str, Any]:
        return _drive_content(start, settings, [math.degrees(angle) for angle in angles(settings)])

    controls = (
        Quantity("pinion_teeth", "teeth of the pinion", 12, 60, drive.pinion_teeth, 1, whole=True),
        Quantity("gear_teeth", "teeth of the face gear", 40, 260, drive.gear_teeth, 1, whole=True),
        Quantity("module", "module [mm]", 1.0, 8.0, drive.module * 1e3, 0.025, unit=1e-3),
        _thickness(body),
        Quantity("bore_radius", "radius of the bore [mm]", 10.0, 200.0, body.bore_radius * 1e3, 1.0, 1e-3),
        _bearing_stiffness(load),
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
        _pinion_mass(load, 0.0),
        Choice("pinions", "number of pinions", ("1", "2", "3"), str(len(start.pinion_angles))),
        Quantity(
            "second_angle",
            "angle of the 2nd [°]",
            5.0,
            355.0,
            degrees[1],
            0.1,
            unit=_DEGREE,
            when=("pinions", "2", "3"),
        ),
        Quantity(
            "third_angle",
            "angle of the 3rd [°]",
            5.0,
            355.0,
            degrees[2],
            0.1,
            unit=_DEGREE,
            when=("pinions", "3"),
        ),
        Choice("contact_ratio", "contact ratio", (TREGOLD, TRUE_SWEEP), ratio),
        *_force_controls(start.force, start.contact, drive, highest_speed_rpm),
    )
    return Study(controls, build, "stiffness", speed, content=content)


def _drive_content(start: Transverse, settings: Settings, angles_deg: list[float]) -> dict[str, Any]:
    """Say in the words of a drive file what settings mean; its power is that at the highest speed."""
    highest, drive, material = settings["highest_speed"] / _RPM, start.body.drive, start.body.material
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


def _force_controls(
    force: DrivingForce | None, contact: Contact, drive: Drive, highest_speed_rpm: float
) -> tuple[Quantity | Choice, ...]:
    """Return the controls of the driving force, at first where that of a model is.

    Raises
    ------
    ValueError
        If its force presses elsewhere than a reader can choose.
    """
    at_top = float(rad_per_s(highest_speed_rpm)) / drive.speed_ratio
    here = DrivingForce(0.0, at_top) if force is None else force
    places = {name: pressed(place, contact, drive) for name, place in PRESSED.items()}
    place = next((name for name, spread in places.items() if spread == here.spread), None)
    if place is None:
        raise ValueError(f"force of the model must press on {' or '.join(places)}, got {here.spread!r}")
    # The power control holds at the highest speed: the same force.
    horsepower = here.power / here.pinion_speed * at_top / WATT_PER_HORSEPOWER
    return (
        Quantity(
            "power",
            "power of a pinion at top speed [hp]",
            0.0,
            1500.0,
            horsepower,
            10.0,
            unit=WATT_PER_HORSEPOWER,
            parameter="power",
        ),
        Choice("force_at", "driving force on", tuple(PRESSED), place),
        Choice("following", "direction of the force", (FOLLOWER, DEAD), _DIRECTIONS[here.following]),
    )


def _force(start: DrivingForce | None, settings: Settings, drive: Drive, contact: Contact) -> DrivingForce:
    """Driving force of the power at top speed, as the reader wants it."""
    base = DrivingForce(0.0, 1.0) if start is None else start
    return replace(
        base,
        power=settings["power"],
        pinion_speed=settings["highest_speed"] / drive.speed_ratio,
        following=next(key for key, words in _DIRECTIONS.items() if words == settings["following"]),
        spread=pressed(PRESSED[settings["force_at"]], contact, drive),
    )


COSINE, SQUARE = "cosine (Mathieu)", "square (Meissner)"


def oscillator_study() -> Study:
    """Mathieu's and Meissner's equation with damping, over parametric frequency and depth."""
    controls = (
        Choice("wave", "stiffness", (COSINE, SQUARE), COSINE),
        Quantity("depth", "depth of modulation ε", 0.0, 0.95, 0.4, 0.01, parameter="depth"),
        Quantity("damping_ratio", "damping ratio ϑ", 0.0, 0.2, 0.02, 0.002, parameter="damping_ratio"),
        Quantity("duty", "duty of the square wave", 0.05, 0.95, 0.5, 0.01, when=("wave", SQUARE)),
    )
    speed = Quantity("highest_speed", "parametric frequency ω/ω₀", 0.5, 5.0, 2.6, 0.1)

    def build(settings: Settings) -> Model:
        depth, damping_ratio = settings["depth"], settings["damping_ratio"]
        if settings["wave"] == SQUARE:
            return Meissner(depth, settings["duty"], damping_ratio)
        return Mathieu(depth, damping_ratio)

    return Study(
        controls,
        build,
        "depth",
        speed,
    )


def gearbox_study(
    model: Torsional | None = None, highest_speed_rpm: float = gearboxes.HIGHEST_SPEED_RPM
) -> Study:
    """Torsional vibration of the gearbox of table 7.1: inertias, shafts, mesh.

    Parameters
    ----------
    model : Torsional, optional
        With a :class:`facegear.mechanics.gearboxes.ProportionalGearbox`, where the controls stand at first; that of
        Fig. 7.12(a) if left out.
    highest_speed_rpm : float
        End of the speed axis [rpm of the face gear].

    Returns
    -------
    Study
    """
    start = gearboxes.FIGURES["7.12a"].model() if model is None else model
    _require_kind("model", start, Torsional)
    _require_kind("gearbox of the model", start.gearbox, gearboxes.ProportionalGearbox)
    controls = (
        _quantity(start, "gear_inertia", "gear inertia J₂/J₁", 1.0, 100.0, 1.0),
        _quantity(start, "load_inertia", "load inertia Jₒ/J₁", 1.0, 100.0, 1.0),
        _quantity(start, "input_stiffness", "input shaft k₁/k_m [m²/rad]", 0.005, 0.5, 0.001),
        _quantity(start, "output_stiffness", "output shaft k₂/k_m [m²/rad]", 0.005, 0.5, 0.001),
        _quantity(start, "mesh_damping", "mesh damping c_m/k_m [µs]", 0.0, 50.0, 0.5, 1e-6),
        _quantity(start, "input_damping", "input damping c₁/k₁ [µs]", 0.0, 100.0, 0.5, 1e-6),
        _quantity(start, "output_damping", "output damping c₂/k₂ [µs]", 0.0, 100.0, 0.5, 1e-6),
        _quantity(start, "correction_factor", "correction of the mesh stiffness c_f", 0.05, 1.0, 0.05),
    )

    def build(settings: Settings) -> Model:
        return _with_parameters(start, controls, settings)

    return Study(
        controls,
        build,
        "input_damping",
        _speed(highest_speed_rpm),
    )


def shafts_study(model: HeavyShafts | None = None, highest_speed_rpm: float = 1000.0) -> Study:
    """Torsional vibration with shafts that have mass: their lengths, their modes, stiffness and damping (chapter 8).

    Parameters
    ----------
    model : HeavyShafts, optional
        With both lengths, and a :class:`facegear.mechanics.gearboxes.ProportionalGearbox`, where the controls stand at
        first; that of Fig. 7.12(a) with shafts of 0.3 m if left out.
    highest_speed_rpm : float
        End of the speed axis [rpm of the face gear].

    Returns
    -------
    Study
    """
    start = HeavyShafts(gearboxes.FIGURES["7.12a"].model(), 0.3, 0.3, modes=1) if model is None else model
    _require_kind("model", start, HeavyShafts)
    _require_kind("gearbox of the model", start.gearbox, gearboxes.ProportionalGearbox)
    controls = (
        _quantity(start, "input_length", "length of the input shaft [mm]", 50.0, 1000.0, 5.0, 1e-3),
        _quantity(start, "output_length", "length of the output shaft [mm]", 50.0, 1000.0, 5.0, 1e-3),
        Quantity("modes", "modes of each shaft", 0, 3, start.modes, 1, whole=True),
        _quantity(start, "input_stiffness", "input shaft k₁/k_m [m²/rad]", 0.005, 0.5, 0.001),
        _quantity(start, "output_stiffness", "output shaft k₂/k_m [m²/rad]", 0.005, 0.5, 0.001),
        _quantity(start, "mesh_damping", "mesh damping c_m/k_m [µs]", 0.0, 50.0, 0.5, 1e-6),
        _quantity(start, "input_damping", "input damping c₁/k₁ [µs]", 0.0, 100.0, 0.5, 1e-6),
        _quantity(start, "output_damping", "output damping c₂/k₂ [µs]", 0.0, 100.0, 0.5, 1e-6),
    )

    def build(settings: Settings) -> Model:
        return replace(_with_parameters(start, controls, settings), modes=settings["modes"])

    return Study(controls, build, "output_length", _speed(highest_speed_rpm), columns=40, rows=20)


def damage_study(model: Torsional | None = None, highest_speed_rpm: float = 1000.0) -> Study:
    """Torsional vibration of a gearbox that loses stiffness: what is left of shafts and teeth (chapter 8).

    Parameters
    ----------
    model : Torsional, optional
        The intact gearbox, a :class:`facegear.mechanics.torsional.Gearbox`; that of Fig. 7.12(b) if left out.
    highest_speed_rpm : float
        End of the speed axis [rpm of the face gear].

    Returns
    -------
    Study
        Its damping coefficients stay what they are.
    """
    start = Torsional(gearboxes.FIGURES["7.12b"].gearbox.in_si) if model is None else model
    _require_kind("model", start, Torsional)
    _require_kind("gearbox of the model", start.gearbox, Gearbox)
    parts = {"input_stiffness": "input shaft", "output_stiffness": "output shaft", "mesh_stiffness": "teeth"}
    controls = tuple(
        Quantity(
            name,
            f"stiffness left, {part} [%]",
            20.0,
            100.0,
            100.0,
            1.0,
            value_of(start, name) / 100.0,
            parameter=name,
        )
        for name, part in parts.items()
    )

    def build(settings: Settings) -> Model:
        return _with_parameters(start, controls, settings)

    return Study(controls, build, "mesh_stiffness", _speed(highest_speed_rpm))


def _quantity(
    start: Model, name: str, label: str, lowest: float, highest: float, step: float, unit: float = 1.0
) -> Quantity:
    """Return the control of a parameter, at first where that of a model is."""
    value = value_of(start, name) / unit
    return Quantity(name, label, lowest, max(highest, value), value, step, unit, parameter=name)


def _with_parameters(start: ModelT, controls: Sequence[Quantity], settings: Settings) -> ModelT:
    """Return a model with what the reader has set of its parameters."""
    for control in controls:
        if control.parameter is not None and control.name in settings:
            start = replace_parameter(start, control.parameter, settings[control.name])
    return start


ALONE, FRONT, BOTH, BETWEEN = "one", "two on one face", "one on either face", "one between two gears"
"""How pinions may stand in :func:`teeth_study`."""


def teeth_study(model: MeshOscillator | None = None, highest_speed_rpm: float = 1000.0) -> Study:
    """Pinions on the springs of their teeth: on one face, on both, or between two gears (chapter 8).

    Parameters
    ----------
    model : MeshOscillator, optional
        One pinion, contact along lines: where the controls stand at first. That of Fig. 4.4(a) with the teeth of (7-2)
        if left out.
    highest_speed_rpm : float
        End of the speed axis [rpm of the face gear].

    Returns
    -------
    Study

    Raises
    ------
    ValueError
        If a value of the model lies outside the range of its control.
    """
    if model is None:
        rigid = cases.FIGURES["4.4a"].model()
        stiffness = mesh_stiffness(rigid.body.drive, correction_factor=0.5)
        model = MeshOscillator(rigid.body, rigid.load, mesh_stiffness=stiffness, mesh_damping=1e-5)
    _require_kind("model", model, MeshOscillator)
    start, body, load, speed = model, model.body, model.load, _speed(highest_speed_rpm)
    if len(start.pinion_angles) > 1 or start.sides is not None or start.phases is not None:
        raise ValueError(
            "model must have one pinion on the front, without a phase, where a reader adds others, got pinion_angles = "
            f"{start.pinion_angles!r}, sides = {start.sides!r}, phases = {start.phases!r}"
        )
    first = start.pinion_angles[0]
    rule, ratio = _sharing(start)
    controls = (
        Choice("pinions", "pinions", (ALONE, FRONT, BOTH, BETWEEN), ALONE),
        Quantity(
            "second_angle",
            "angle of the 2nd [°]",
            0.0,
            355.0,
            90.0,
            0.1,
            _DEGREE,
            when=("pinions", FRONT, BOTH),
        ),
        Quantity(
            "clocking",
            "phase of the back face [periods]",
            0.0,
            1.0,
            0.5,
            0.01,
            parameter="clocking",
            when=("pinions", BOTH),
        ),
        Choice("sharing", "load sharing", (CENTROID, *RULES), rule),
        Choice("contact_ratio", "contact ratio", (TREGOLD, TRUE_SWEEP), ratio),
        Quantity(
            "mesh_stiffness",
            "stiffness of a tooth pair [N/µm]",
            5.0,
            500.0,
            start.mesh_stiffness * 1e-6,
            5.0,
            1e6,
            parameter="mesh_stiffness",
        ),
        Quantity(
            "mesh_damping",
            "mesh damping [µs]",
            0.5,
            100.0,
            start.mesh_damping * 1e6,
            0.5,
            1e-6,
            parameter="mesh_damping",
        ),
        _thickness(body),
        _bearing_stiffness(load),
        _pinion_mass(load, 0.05),
        *_force_controls(start.force, start.contact, body.drive, highest_speed_rpm),
    )

    def build(settings: Settings) -> Model:
        drive, pinions = body.drive, settings["pinions"]
        teeth = FlexibleTeeth(
            settings["mesh_stiffness"],
            settings["mesh_damping"],
            settings["sharing"],
            (1, -1) if pinions == BOTH else (),
            settings["clocking"] if pinions == BOTH else 0.0,
        )
        plain = _contact(Contact(travel=start.contact.travel), settings, drive)
        gear = teeth.under(
            replace(body, thickness_ratio=settings["thickness_ratio"]),
            replace(load, stiffness=settings["stiffness"], mass=settings["mass"]),
            (first, first + settings["second_angle"]) if pinions in (FRONT, BOTH) else (first,),
            teeth.contact(plain, drive),
        )
        gear = replace(gear, force=_force(start.force, settings, drive, plain))
        return TwoGears(gear) if pinions == BETWEEN else gear

    return Study(controls, build, "mesh_stiffness", speed)


def _sharing(start: MeshOscillator) -> tuple[str, str]:
    """Rule of sharing and contact ratio of a model, by the words of their choices.

    Raises
    ------
    ValueError
        If its contact is none of those that a reader can choose.
    """
    drive, own = start.body.drive, start.contact
    for ratio in (TREGOLD, TRUE_SWEEP):
        plain = _contact(Contact(travel=own.travel), {"contact_ratio": ratio}, drive)
        for rule in (CENTROID, *RULES):
            teeth = FlexibleTeeth(start.mesh_stiffness, start.mesh_damping, rule, (), 0.0)
            if teeth.contact(plain, drive) == own:
                return rule, ratio
    rules = ", ".join((CENTROID, *RULES))
    raise ValueError(
        f"contact of the model must be along lines, shared by {rules}, with Tregold's contact ratio or that of the "
        f"true sweep, got {own!r}"
    )
