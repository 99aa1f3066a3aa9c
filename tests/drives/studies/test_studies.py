"""What holds for every study: models it takes, and controls that do something."""

import math
from dataclasses import replace

import numpy as np
import pytest

from facegear.drives.studies.drive import drive_study
from facegear.drives.studies.gearbox import damage_study, gearbox_study, shafts_study
from facegear.drives.studies.oscillator import SQUARE, oscillator_study
from facegear.drives.studies.study import Choice
from facegear.drives.studies.teeth import BOTH, teeth_study
from facegear.floquet.multipliers import growth_rate
from facegear.geometry.drive import Drive
from facegear.mechanics import gearboxes
from facegear.mechanics.contact import Contact
from facegear.mechanics.edge_stiffness import DrivingForce
from facegear.mechanics.heavy_shafts import HeavyShafts
from facegear.mechanics.mesh_oscillator import MeshOscillator
from facegear.mechanics.plate import Body
from facegear.mechanics.properties import Material, MeshLoad
from facegear.mechanics.sharing import shared_load
from facegear.mechanics.tooth_stiffness import mesh_stiffness
from facegear.mechanics.torsional import Torsional
from facegear.mechanics.transverse import Transverse
from tests.drives.studies.models import THREE

OWN_DRIVE = Drive(30, 120, 3e-3, pressure_angle=math.radians(20.0), shaft_angle=math.radians(85.0))
ALUMINIUM = Material(2810.0, 71e9, 0.33, 2e-6, 4e8)
OWN_BODY = Body(OWN_DRIVE, 0.04, nodal_diameters=5, material=ALUMINIUM)
OWN = Transverse(
    OWN_BODY,
    MeshLoad(0.5, 4e-6, 0.0),
    (0.5, 1.5),
    Contact(rate="total", travel="with_disk"),
    DrivingForce(2e5, 400.0, harmonics=6),
    phases=(0.0, 0.3),
)
ROUND = Drive(30, 120, 3e-3)
ON_SPRINGS = MeshOscillator(
    Body(ROUND, 0.04), MeshLoad(0.5, 4e-6, 0.5), mesh_stiffness=mesh_stiffness(ROUND, 0.5), mesh_damping=2e-5
)
BY_RULE = Contact(
    path=shared_load("equal"), sharing="each", rate="total", contact_ratio=ROUND.geometric_contact_ratio
)


@pytest.mark.parametrize(
    ("study", "model"),
    [
        (drive_study, OWN),
        (teeth_study, ON_SPRINGS),
        (teeth_study, replace(ON_SPRINGS, contact=BY_RULE, pinion_angles=(0.4,))),
        (teeth_study, replace(ON_SPRINGS, force=DrivingForce(2e5, 400.0, "dead", 6))),
        (damage_study, gearboxes.FIGURES["7.13a"].model()),
    ],
)
def test_what_has_no_control_stays_as_the_model_has_it(study, model):
    """Pressure angle, material, basis, rate, phases and the like were dropped without a word."""
    made = study(model)
    built = made.model(made.settings())
    assert growth_rate(built.system(60.0)) == pytest.approx(growth_rate(model.system(60.0)), abs=1e-7)
    assert built.system(60.0).size == model.system(60.0).size


@pytest.mark.parametrize(
    ("study", "model", "error", "message"),
    [
        (drive_study, ON_SPRINGS, TypeError, "model must be a Transverse for this study, got"),
        (teeth_study, OWN, TypeError, "model must be a MeshOscillator for this study, got"),
        (teeth_study, "x", TypeError, "model must be a MeshOscillator for this study, got"),
        (
            drive_study,
            replace(OWN, contact=Contact(sharing="mean", contact_ratio=1.7)),
            ValueError,
            r"contact_ratio of the model must be .*, got 1.7",
        ),
        (
            teeth_study,
            replace(ON_SPRINGS, contact=Contact(rate="total", contact_ratio=2.2)),
            ValueError,
            "contact of the model must be along lines, shared by",
        ),
        (
            teeth_study,
            replace(ON_SPRINGS, pinion_angles=(0.0, 2.0)),
            ValueError,
            "model must have one pinion",
        ),
        (
            teeth_study,
            replace(ON_SPRINGS, sides=(-1,)),
            ValueError,
            "model must have one pinion on the front",
        ),
        (
            shafts_study,
            HeavyShafts(Torsional(gearboxes.FIGURES["7.12a"].gearbox.in_si), 0.2, 0.4),
            TypeError,
            "gearbox of the model must be a ProportionalGearbox",
        ),
        (shafts_study, gearboxes.FIGURES["7.12a"].model(), TypeError, "model must be a HeavyShafts"),
        (damage_study, ON_SPRINGS, TypeError, "model must be a Torsional"),
    ],
)
def test_a_model_that_controls_would_change_is_refused(study, model, error, message):
    with pytest.raises(error, match=message):
        study(model)


def test_what_is_lost_of_a_stiffness_leaves_the_damping_of_any_gearbox():
    given = gearboxes.FIGURES["7.13a"].model()
    study = damage_study(given)
    found, box = study.model(study.settings({"input_stiffness": 50.0})).gearbox, given.gearbox.in_si
    assert found.input_stiffness == pytest.approx(0.5 * box.input_stiffness, rel=1e-14)
    assert found.input_damping == box.input_damping


@pytest.mark.parametrize("study", [drive_study, teeth_study, shafts_study])
@pytest.mark.parametrize("highest", [0, -1.0, "x"])
def test_a_highest_speed_that_is_none_is_named(study, highest):
    with pytest.raises((TypeError, ValueError), match="highest_speed"):
        study(None, highest)


def test_an_option_that_there_is_not_is_refused():
    study = teeth_study()
    with pytest.raises(ValueError, match=r"pinions must be .*got 'x'"):
        study.model(study.settings({"pinions": "x"}))


def fingerprint(model, speed):
    system = model.system(speed)
    parts = [system.mass, system.damping, system.stiffness, np.array([system.period])]
    for load in system.loads:
        parts.append(load.breakpoints)
        parts += [np.array([load.mass, load.damping, load.stiffness]), load.shape(np.array([0.1, 0.7]))]
        parts += [] if load.weight is None else [load.weight(np.array([0.1, 0.45, 0.7]))]
    return np.concatenate([np.ravel(part) for part in parts])


STUDIES = {
    "drive": (drive_study(THREE), {}, 60.0),
    "oscillator": (oscillator_study(), {"wave": SQUARE}, 1.9),
    "gearbox": (gearbox_study(), {}, 60.0),
    "shafts": (shafts_study(), {}, 60.0),
    "damage": (damage_study(), {}, 60.0),
    "teeth": (teeth_study(), {"pinions": BOTH, "power": 300.0}, 60.0),
}


@pytest.mark.parametrize(
    ("key", "name"),
    [(key, control.name) for key, (study, _, _) in STUDIES.items() for control in study.controls],
)
def test_no_control_is_dead(key, name):
    study, changes, speed = STUDIES[key]
    control = next(c for c in study.controls if c.name == name)
    if isinstance(control, Choice):
        at_first = {**changes}.get(name, control.value)
        value = next(option for option in control.options if option != at_first)
    else:
        value = control.value + (1 if control.value + 1 <= control.highest else -1) * control.step
    before = fingerprint(study.model(study.settings(changes)), speed)
    after = fingerprint(study.model(study.settings({**changes, name: value})), speed)
    assert before.shape != after.shape or not np.allclose(before, after, rtol=1e-9, atol=0.0)
