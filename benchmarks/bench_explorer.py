"""Time what the reader of the explorer waits for: a first, coarse map, a fine one, all of it, a cell.

Run from the repository root: ``python -m benchmarks.bench_explorer``. Processor seconds of one core, the least of
three, after a first map that pays for imports and derivations. Fine is a map of every second row at every second speed,
or of a quarter of either. A change is heard between two pieces: the longest is in the column `piece`.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Mapping
from itertools import pairwise
from typing import Any

from facegear.drives.cell import cell_detail
from facegear.drives.explore import map_stages
from facegear.drives.studies.contact import TRUE_SWEEP
from facegear.drives.studies.drive import drive_study
from facegear.drives.studies.force import DEAD
from facegear.drives.studies.gearbox import gearbox_study, shafts_study
from facegear.drives.studies.oscillator import oscillator_study
from facegear.drives.studies.study import Study
from facegear.drives.studies.teeth import BETWEEN, BOTH, FRONT, teeth_study
from facegear.floquet.models import replace_parameter
from facegear.mechanics.sharing import RULES

CASES: tuple[tuple[str, Study, str, Mapping[str, Any]], ...] = (
    ("one pinion, bearing stiffness", drive_study(), "stiffness", {}),
    ("one pinion, bearing damping", drive_study(), "damping", {}),
    ("one pinion, pinion mass", drive_study(), "mass", {}),
    ("other teeth", drive_study(), "stiffness", {"pinion_teeth": 29, "gear_teeth": 145}),
    ("three pinions", drive_study(), "stiffness", {"pinions": "3"}),
    ("three pinions, power", drive_study(), "power", {"pinions": "3"}),
    ("three pinions, thickness", drive_study(), "thickness_ratio", {"pinions": "3"}),
    (
        "three pinions, thickness, true sweep",
        drive_study(),
        "thickness_ratio",
        {"pinions": "3", "contact_ratio": TRUE_SWEEP},
    ),
    ("three pinions, thickness, 220 kW", drive_study(), "thickness_ratio", {"pinions": "3", "power": 220.0}),
    ("power of 220 kW", drive_study(), "stiffness", {"power": 220.0}),
    ("thickness", drive_study(), "thickness_ratio", {}),
    ("thickness, wide bore", drive_study(), "thickness_ratio", {"bore_radius": 150.0}),
    ("thickness, 220 kW", drive_study(), "thickness_ratio", {"power": 220.0}),
    ("thickness, 220 kW, dead", drive_study(), "thickness_ratio", {"power": 220.0, "following": DEAD}),
    ("power", drive_study(), "power", {}),
    ("flexible teeth", teeth_study(), "mesh_stiffness", {}),
    *(
        (f"{where}, {vertical}", teeth_study(), vertical, {"pinions": where})
        for where in (FRONT, BOTH, BETWEEN)
        for vertical in ("mesh_stiffness", "stiffness", "mass", "thickness_ratio")
    ),
    *((f"shared by {rule}", teeth_study(), "mesh_stiffness", {"sharing": rule}) for rule in RULES),
    *(
        (
            f"shared by {rule}, two gears",
            teeth_study(),
            "mesh_stiffness",
            {"sharing": rule, "pinions": BETWEEN},
        )
        for rule in RULES
    ),
    ("Mathieu's equation", oscillator_study(), "depth", {}),
    ("gearbox, damping of a shaft", gearbox_study(), "input_damping", {}),
    ("gearbox, inertia", gearbox_study(), "gear_inertia", {}),
    ("heavy shafts, length", shafts_study(), "output_length", {}),
    # Beyond what a second allows: periods ten times as long, and shafts with modes far faster than the mesh.
    (
        "three pinions, thickness, 100 rpm",
        drive_study(),
        "thickness_ratio",
        {"pinions": "3", "highest_speed": 100.0},
    ),
    ("heavy shafts, three modes", shafts_study(), "output_length", {"modes": 3}),
)
COLUMNS = ("coarse", "fine", "half", "final", "piece", "cell")


def measure(study: Study, vertical: str, changes: Mapping[str, Any]) -> tuple[float, ...]:
    """Processor seconds to what each of the columns says, of one map and its middle cell."""
    started = time.process_time()
    settings = study.settings(changes)
    model = study.model(settings)
    speeds, values = study.axes(settings, vertical)
    parameter = study.swept(vertical).parameter
    assert parameter is not None
    ends, steps, parts = [], [], []
    for chart in map_stages(model, speeds, parameter, values):
        ends.append(time.process_time() - started)
        steps.append(chart.attrs["row_step"] * chart.attrs["column_step"])
        parts.append(chart.attrs["computed"])
    fine = ends[next(k for k, step in enumerate(steps) if step <= 4)]
    half = ends[next(k for k, part in enumerate(parts) if part >= 0.5)]
    piece = max(later - earlier for earlier, later in pairwise(ends))
    chosen = replace_parameter(model, parameter, float(values[values.size // 4]))
    started = time.process_time()
    cell_detail(chosen, float(speeds[speeds.size // 2]))
    return ends[0], fine, half, ends[-1], piece, time.process_time() - started


def main() -> int:
    """Print the table, of all cases or of those whose names have a word that is given."""
    measure(CASES[0][1], CASES[0][2], {"pinion_teeth": 25})
    sys.stdout.write(f"{'processor seconds':44s}" + "".join(f"{name:>8s}" for name in COLUMNS) + "\n")
    for name, study, vertical, changes in CASES:
        if len(sys.argv) > 1 and not any(word in name for word in sys.argv[1:]):
            continue
        runs = [measure(study, vertical, changes) for _ in range(3)]
        least = (min(seconds) for seconds in zip(*runs, strict=True))
        sys.stdout.write(f"{name:44s}" + "".join(f"{one:8.2f}" for one in least) + "\n")
        sys.stdout.flush()
    return 0


if __name__ == "__main__":
    sys.exit(main())
