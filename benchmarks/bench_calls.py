"""Time the public calls that readers wait for, on one core and on two, warm: maps, tongues, one growth rate.

Run from the repository root: ``python -m benchmarks.bench_calls``.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import partial
from typing import Any

import numpy as np

from benchmarks.record import write_record
from facegear.floquet.multipliers import growth_rate
from facegear.geometry.drive import Drive
from facegear.maps.stability_map import stability_map
from facegear.maps.tracing import tongues
from facegear.mechanics.contact import Contact
from facegear.mechanics.gearboxes import FIGURES
from facegear.mechanics.paths import loaded_contact, point_contact
from facegear.mechanics.plate import Body
from facegear.mechanics.properties import MeshLoad
from facegear.mechanics.transverse import Transverse
from facegear.support.parameters import rad_per_s

LOAD = MeshLoad(stiffness=1.0, damping=3e-6, mass=1.0)
GROWTH_RATES, PATHS = 50, 50


@dataclass(frozen=True)
class Call:
    """One line of the table; `error` is the estimate that the call itself gives, where it does."""

    call: str
    cores: int
    seconds: float
    processor_seconds: float
    error: float | None


def case_1(**basis: int) -> Transverse:
    return Transverse(Body(Drive(26, 130, 3.175e-3), thickness_ratio=0.03, **basis), LOAD)


def timed(name: str, cores: int, run: Callable[[], Any], repeated: int = 1) -> Call:
    """Time one call; processor time counts that of threads but not that of other processes."""
    begin, used = time.perf_counter(), time.process_time()
    result = run()
    wall, processor = time.perf_counter() - begin, time.process_time() - used
    error = result.attrs["error_estimate"] if hasattr(result, "attrs") else None
    call = Call(name, cores, wall / repeated, processor / repeated, error)
    print(call, flush=True)
    return call


def growth_rates(model: Transverse) -> None:
    for speed in rad_per_s(np.linspace(300.0, 900.0, GROWTH_RATES)).tolist():
        growth_rate(model.system(speed))


def measure() -> list[Call]:
    model, gearbox = case_1(), FIGURES["7.13b"]
    speeds = partial(np.linspace, 10.0, 1000.0)
    drive = Drive(26, 130, 3.175e-3, shaper_teeth=27)
    under_load = Transverse(
        Body(drive, thickness_ratio=0.03), LOAD, contact=Contact(path=loaded_contact(100.0))
    )
    maps = (
        (
            "Case I, bearing stiffness, 200 × 200",
            model,
            rad_per_s(speeds(200)),
            "stiffness",
            np.linspace(0.01, 2.0, 200),
        ),
        (
            "Case I, thickness, 60 × 60",
            model,
            rad_per_s(speeds(60)),
            "thickness_ratio",
            np.linspace(0.02, 0.06, 60),
        ),
        (
            "gearbox of Fig. 7.13(b), shaft damping, 60 × 60",
            gearbox.model(),
            rad_per_s(np.linspace(gearbox.lowest_rpm, 1000.0, 60)),
            gearbox.parameter,
            np.geomspace(gearbox.lowest, gearbox.highest, 60),
        ),
        (
            "gearbox of Fig. 7.13(b), shaft damping, 150 × 150",
            gearbox.model(),
            rad_per_s(np.linspace(gearbox.lowest_rpm, 1000.0, 150)),
            gearbox.parameter,
            np.geomspace(gearbox.lowest, gearbox.highest, 150),
        ),
        (
            "Case I under load, torque, 60 × 100",
            under_load,
            rad_per_s(np.linspace(100.0, 1000.0, 100)),
            "torque",
            np.geomspace(4.0, 1000.0, 60),
        ),
    )
    calls = []
    for name, chosen, over, parameter, values in maps:
        stability_map(chosen, over[::20], parameter, values, jobs=2, progress=False)
        for cores in (1, 2):
            run = partial(stability_map, chosen, over, parameter, values, jobs=cores, progress=False)
            calls.append(timed(f"map of {name}", cores, run))
    modules = np.linspace(3e-3, 4e-3, PATHS).tolist()
    calls.append(
        timed(
            "path of contact at a point, its drive included",
            1,
            lambda: [point_contact(Drive(26, 130, m, shaper_teeth=27)) for m in modules],
            PATHS,
        )
    )
    low, high = rad_per_s(np.array([10.0, 1000.0])).tolist()
    calls.append(
        timed(
            "tongues of Case I, 10 to 1000 rpm, labels",
            1,
            lambda: [x.label for x in tongues(model, (low, high))],
        )
    )
    growth_rates(model)
    calls.append(
        timed("growth_rate of Case I, its system included", 1, partial(growth_rates, model), GROWTH_RATES)
    )
    large = case_1(nodal_circles=4, nodal_diameters=10)
    high, low = rad_per_s(np.array([1000.0, 800.0])).tolist()
    calls.append(
        timed(
            f"tongues with modes of 4 × 10, {large.system(high).size} coordinates, 800 to 1000 rpm, labels",
            1,
            lambda: [x.label for x in tongues(large, (low, high))],
        )
    )
    return calls


def main() -> None:
    write_record("calls", rows=[asdict(call) for call in measure()])


if __name__ == "__main__":
    main()
