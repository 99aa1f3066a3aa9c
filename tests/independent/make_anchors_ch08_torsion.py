"""Compute the anchors of the chapter on play between teeth: `python -m tests.independent.make_anchors_ch08_torsion`.

Takes some minutes. Motions are those of :mod:`tests.independent.impacts`: DOP853 from contact to contact on the
formulas of the text, repeated by Newton's method with differences of whole periods. The package tells where to begin.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
import yaml

import facegear as fg
from compendium.datasets.backlash import families
from facegear.floquet.continuation import orbits_at
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


def shot(speed, start, periods):
    """State at the beginning of the motion that repeats itself, from one nearby."""
    drive, state = as_drive(PLAY, speed), np.array(start)
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
    """Write the anchors."""
    jobs = {
        "ch08_torsion_response": response,
        "ch08_torsion_large": lambda stored: growth("reversed", (320.0, 640.0)),
    }
    for name, compute in jobs.items():
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
