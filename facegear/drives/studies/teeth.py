"""Pinions on the springs of their teeth: on one face, on both, or between two gears."""

from __future__ import annotations

from dataclasses import replace

from facegear.drives.flexible_teeth import CENTROID, FlexibleTeeth
from facegear.drives.studies.contact import TREGOLD, TRUE_SWEEP, contact_as_set
from facegear.drives.studies.controls import (
    DEGREE,
    bearing_stiffness_control,
    pinion_mass_control,
    speed_control,
    thickness_control,
)
from facegear.drives.studies.force import force_as_set, force_controls
from facegear.drives.studies.study import Choice, Quantity, Settings, Study
from facegear.floquet.models import Model
from facegear.mechanics import cases
from facegear.mechanics.contact import Contact
from facegear.mechanics.mesh_oscillator import MeshOscillator
from facegear.mechanics.sharing import RULES
from facegear.mechanics.tooth_stiffness import mesh_stiffness
from facegear.mechanics.two_gears import TwoGears
from facegear.support.kinds import require_kind

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
    require_kind("model", model, MeshOscillator, why="for this study")
    start, body, load, speed = model, model.body, model.load, speed_control(highest_speed_rpm)
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
            DEGREE,
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
        thickness_control(body),
        bearing_stiffness_control(load),
        pinion_mass_control(load, 0.05),
        *force_controls(start.force, start.contact, body.drive, highest_speed_rpm),
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
        plain = contact_as_set(Contact(travel=start.contact.travel), settings, drive)
        gear = teeth.under(
            replace(body, thickness_ratio=settings["thickness_ratio"]),
            replace(load, stiffness=settings["stiffness"], mass=settings["mass"]),
            (first, first + settings["second_angle"]) if pinions in (FRONT, BOTH) else (first,),
            teeth.contact(plain, drive),
        )
        gear = replace(gear, force=force_as_set(start.force, settings, drive, plain))
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
        plain = contact_as_set(Contact(travel=own.travel), {"contact_ratio": ratio}, drive)
        for rule in (CENTROID, *RULES):
            teeth = FlexibleTeeth(start.mesh_stiffness, start.mesh_damping, rule, (), 0.0)
            if teeth.contact(plain, drive) == own:
                return rule, ratio
    rules = ", ".join((CENTROID, *RULES))
    raise ValueError(
        f"contact of the model must be along lines, shared by {rules}, with Tregold's contact ratio or that of the "
        f"true sweep, got {own!r}"
    )
