"""Compute the anchors of the chapter on play between teeth: `python -m tests.independent.make_anchors_ch08_torsion`.

Takes some minutes. Motions are those of :mod:`tests.independent.impacts`: DOP853 from contact to contact on the
formulas of the text, repeated by Newton's method with differences of whole periods. The package tells where to begin.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import yaml

import facegear as fg
from compendium.datasets.backlash import torque_response
from facegear.floquet.arc_length import Following
from facegear.floquet.continuation import doubled, followed, orbits_at
from facegear.floquet.orbits import periodic_orbit
from facegear.mechanics.backlash import Backlash
from facegear.mechanics.gearboxes import FIGURES
from facegear.support.labelled import load
from tests.mechanics.test_backlash import as_drive

DATA = Path(__file__).resolve().parents[2] / "data"
ROUTE = (
    "tests/independent/impacts.py: DOP853 from contact to contact, shooting by differences of whole periods"
)
PLAY = Backlash(FIGURES["7.12a"].model(), torque=800.0, gap=1e-4)
# Cells of the response: family and speed [rpm].
CELLS = (
    ("from above", 750.0),
    ("from above", 500.0),
    ("from above", 250.0),
    ("from within, up", 250.0),
    ("from within, up", 245.0),
)


def families(model, lowest_rpm, highest_rpm, inner_rpm):
    """Find families of motions over speed: from the highest, both ways from one between, and two periods of flips."""
    low, high, inner = (float(fg.rad_per_s(x)) for x in (lowest_rpm, highest_rpm, inner_rpm))
    bounded = Following(largest=30.0)
    start = periodic_orbit(model.system(high))
    found = {"from above": followed(model.system, high, start, low, high, direction=-1.0, following=bounded)}
    start = periodic_orbit(model.system(inner))
    for name, sense in (("from within, down", -1.0), ("from within, up", 1.0)):
        found[name] = followed(model.system, inner, start, low, high, direction=sense, following=bounded)
    flips = [x for x in found["from above"].special if x.kind == "flip" and x.orbit.periods == 1]
    for flip in flips:
        found[f"two periods, {fg.rpm(flip.parameter):.0f} rpm"] = doubled(
            model.system, flip, low, high, following=bounded
        )
    return found


def shot(speed, start, periods, model=PLAY):
    """State at the beginning of the motion that repeats itself, from one nearby."""
    drive, state = as_drive(model, speed), np.array(start)
    for _ in range(3):
        end = drive.flown(state, periods)[0]
        steps = 1e-6 * np.maximum(np.abs(state), 1e-6)
        columns = [
            (drive.flown(state + step * unit, periods)[0] - end) / step
            for step, unit in zip(steps, np.eye(6), strict=True)
        ]
        state = state + np.linalg.solve(np.eye(6) - np.array(columns).T, end - state)
    return state


def deformation(state):
    """Mesh deformation as the model states it: on the constant arms of the pinion's base circle."""
    drive = PLAY.torsional.drive
    return drive.base_radius * (state[0] - drive.gear_teeth / drive.pinion_teeth * state[1])


def response(stored):
    branches = families(PLAY, 150.0, 800.0, 250.0)
    names, shown = stored.family.values.tolist(), stored.speed.values
    for sheet, name in enumerate(names):
        for family, speed_rpm in CELLS:
            column = int(np.abs(shown - speed_rpm).argmin())
            entering = float(stored.entering.values[sheet, column])
            if family != name or not np.isfinite(entering):
                continue
            speed = float(fg.rad_per_s(speed_rpm))
            found = [orbit for orbit in orbits_at(PLAY.system, branches[name], speed) if orbit is not None]
            near = min(found, key=lambda orbit: abs(deformation(orbit.start) - entering))
            value = deformation(shot(speed, near.start, near.periods))
            yield {
                "variable": "entering",
                "at": {"sheet": sheet, "speed": speed_rpm},
                "value": float(value),
                "atol": 1e-11,
            }


def at_250(branches):
    """Every motion there at 250 rpm."""
    speed = float(fg.rad_per_s(250.0))
    return [o for b in branches.values() for o in orbits_at(PLAY.system, b, speed) if o is not None]


def motions(stored):
    """Deformation and its rate as the period begins."""
    there = [orbit for orbit in at_250(families(PLAY, 150.0, 800.0, 250.0)) if orbit.is_stable]
    for number, entering in enumerate(stored.deformation.values[:, 0]):
        near = min(there, key=lambda orbit: abs(deformation(orbit.start) - entering))
        state = shot(float(fg.rad_per_s(250.0)), near.start, near.periods)
        at = {"motion": number, "fraction": 0.0}
        yield {"variable": "deformation", "at": at, "value": float(deformation(state)), "atol": 1e-11}
        yield {"variable": "rate", "at": at, "value": float(deformation(state[3:])), "atol": 1e-7}


def torque(stored):
    """Deformation as the period begins, at some torques of both sheets."""
    speed = float(fg.rad_per_s(250.0))
    branch, _ = torque_response(PLAY, 250.0, stored.torque.values, 6e-4)
    for sheet, part in enumerate(branch.sheets):
        for column in (25, 50):
            value = float(stored.torque.values[column])
            model = replace(PLAY, torque=value)
            near = part.orbits[int(np.abs(part.parameters - value).argmin())]
            found = periodic_orbit(model.system(speed), 1, near)
            state = shot(speed, found.start, 1, model)
            at = {"sheet": sheet, "torque": value}
            yield {"variable": "entering", "at": at, "value": float(deformation(state)), "atol": 1e-11}


def growth(back_flank, speeds_rpm):
    """Growth a mesh period of one motion without gap and torque, between its 30th and its 60th period."""
    free = replace(PLAY, back_flank=back_flank)
    for speed_rpm in speeds_rpm:
        drive = as_drive(replace(free, gap=0.0, torque=1e-300), float(fg.rad_per_s(speed_rpm)))
        state, sizes = np.array([1e-3, -1e-3, 2e-3, 1.0, -1.0, 0.5]), []
        for _ in range(60):
            state = drive.flown(state)[0]
            sizes.append(np.linalg.norm(state * [1e3, 1e3, 1e3, 1.0, 1.0, 1.0]))
        yield {
            "variable": "growth",
            "at": {"speed": speed_rpm},
            "value": float(np.log(sizes[-1] / sizes[29]) / 30.0),
            "atol": 0.02,
        }


def main() -> None:
    """Write the anchors of the files named on the command line, of all when none is."""
    jobs = {
        "ch08_torsion_response": response,
        "ch08_torsion_motions": motions,
        "ch08_torsion_torque": torque,
        "ch08_torsion_large": lambda stored: growth("reversed", (320.0, 640.0)),
    }
    for name in sys.argv[1:] or jobs:
        compute = jobs[name]
        content = {
            "figure": name,
            "route": ROUTE,
            "anchors": list(compute(load(DATA / "reference" / f"{name}.nc"))),
        }
        (DATA / "anchors" / f"{name}.yaml").write_text(
            yaml.safe_dump(content, sort_keys=False, allow_unicode=True)
        )


if __name__ == "__main__":
    main()
