"""Time what the reader of the explorer waits for: a first, coarse map, one of half the rows, all of it, a cell.

Run from the repository root: ``python -m benchmarks.bench_explorer``. Processor seconds of one core, after a first
map that pays for imports and derivations.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Mapping
from typing import Any

from facegear.drives.cell import cell_detail
from facegear.drives.explore import map_stages
from facegear.drives.studies.drive import drive_study
from facegear.drives.studies.gearbox import gearbox_study
from facegear.drives.studies.oscillator import oscillator_study
from facegear.drives.studies.study import Study
from facegear.floquet.models import replace_parameter

CASES: tuple[tuple[str, Study, str, Mapping[str, Any]], ...] = (
    ("one pinion, bearing stiffness", drive_study(), "stiffness", {}),
    ("one pinion, bearing damping", drive_study(), "damping", {}),
    ("one pinion, pinion mass", drive_study(), "mass", {}),
    ("other teeth", drive_study(), "stiffness", {"pinion_teeth": 29, "gear_teeth": 145}),
    ("three pinions", drive_study(), "stiffness", {"pinions": "3"}),
    ("power of 220 kW", drive_study(), "stiffness", {"power": 220.0}),
    ("thickness on the vertical axis", drive_study(), "thickness_ratio", {}),
    ("power on the vertical axis", drive_study(), "power", {}),
    ("Mathieu's equation", oscillator_study(), "depth", {}),
    ("gearbox, damping of a shaft", gearbox_study(), "input_damping", {}),
)


def measure(study: Study, vertical: str, changes: Mapping[str, Any]) -> tuple[float, float, float, float]:
    """Processor seconds to the first stage of the map, half of it and the last, and for the middle cell."""
    started = time.process_time()
    settings = study.settings(changes)
    model = study.model(settings)
    speeds, values = study.axes(settings, vertical)
    parameter = study.swept(vertical).parameter
    assert parameter is not None
    stages = map_stages(model, speeds, parameter, values)
    ends = [(stage.attrs["computed"], time.process_time() - started) for stage in stages]
    half = next(seconds for computed, seconds in ends if computed >= 0.5)
    chosen = replace_parameter(model, parameter, float(values[values.size // 4]))
    started = time.process_time()
    cell_detail(chosen, float(speeds[speeds.size // 2]))
    return ends[0][1], half, ends[-1][1], time.process_time() - started


def main() -> int:
    """Print the table."""
    measure(CASES[0][1], CASES[0][2], {"pinion_teeth": 25})
    sys.stdout.write(f"{'processor seconds':34s}{'coarse':>9s}{'half':>9s}{'final':>9s}{'cell':>9s}\n")
    for name, study, vertical, changes in CASES:
        seconds = measure(study, vertical, changes)
        sys.stdout.write(f"{name:34s}" + "".join(f"{one:9.2f}" for one in seconds) + "\n")
        sys.stdout.flush()
    return 0


if __name__ == "__main__":
    sys.exit(main())
