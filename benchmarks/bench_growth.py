"""Measure how the cost grows: with coordinates, with loads, with processes, and with the tasks of a cluster.

Run from the repository root: ``python -m benchmarks.bench_growth``. One core, except where processes are counted.
Longer lists of workers than this machine has cores are simulated: the measured seconds of the tasks of a map are given
to the worker that is free first.
"""

from __future__ import annotations

import heapq
import os
import time
from collections.abc import Callable

import numpy as np
from joblib import Parallel, delayed
from threadpoolctl import threadpool_limits

from benchmarks.record import write_record
from facegear.floquet.columns import column_spectral_radii
from facegear.floquet.multipliers import growth_rate
from facegear.geometry.drive import Drive
from facegear.mechanics.plate import Body
from facegear.mechanics.properties import MeshLoad
from facegear.mechanics.transverse import Transverse
from facegear.support.parameters import rad_per_s

DRIVE = Drive(26, 130, 3.175e-3)
LOAD = MeshLoad(stiffness=1.0, damping=3e-6, mass=1.0)
# Largest numbers of nodal circles and nodal diameters of the modes.
BASES = ((1, 3), (2, 4), (2, 6), (3, 6), (3, 8), (4, 10))
PINIONS = range(1, 7)
SPEED = float(rad_per_s(600.0))
STIFFNESSES = np.linspace(0.01, 2.0, 200)
WORKERS = (1, 2, 3, 4, 6, 8)
MAP_SPEEDS = rad_per_s(np.linspace(10.0, 1000.0, 200))
# Tasks that do nothing, sent through a Dask scheduler.
TASKS = 2000
# Repetitions of what takes milliseconds; the median counts.
REPEATED = 9


def model(basis: tuple[int, int] = BASES[0], pinions: int = 1) -> Transverse:
    body = Body(DRIVE, thickness_ratio=0.03, nodal_circles=basis[0], nodal_diameters=basis[1])
    return Transverse(body, LOAD, pinion_angles=tuple(2.0 * np.pi * np.arange(pinions) / 6.3))


def seconds(function: Callable[[], object], repeated: int = REPEATED) -> float:
    """Median of processor seconds of one call, after one that pays for what is derived once."""
    function()
    spans = []
    for _ in range(repeated):
        begin = time.process_time()
        function()
        spans.append(time.process_time() - begin)
    return float(np.median(spans))


def costs(chosen: Transverse) -> dict[str, float]:
    """Processor seconds of one growth rate, and of each cell of a column of bearing stiffness."""
    system = chosen.system(SPEED)
    load = system.loads[0]  # all are alike

    def column() -> object:
        return column_spectral_radii(system, load.mass, load.damping, STIFFNESSES * load.stiffness)

    return {
        "growth_rate": seconds(lambda: growth_rate(system)),
        "cell_of_column": seconds(column, 3) / STIFFNESSES.size,
    }


def column_of_map(speed: float) -> float:
    """Wall seconds of one column of a map, as a task of its own."""
    begin = time.perf_counter()
    with threadpool_limits(1):
        system = model().system(speed)
        load = system.loads[0]
        column_spectral_radii(system, load.mass, load.damping, STIFFNESSES * load.stiffness)
    return time.perf_counter() - begin


def makespan(tasks: list[float], workers: int) -> float:
    """Seconds until all tasks are done, each by the worker that is free first."""
    free = [0.0] * workers
    for task in tasks:
        heapq.heappush(free, heapq.heappop(free) + task)
    return max(free)


def processes() -> dict[str, object]:
    """Seconds of the columns of a map by number of processes: measured as far as there are cores, and simulated."""
    speeds = MAP_SPEEDS.tolist()
    column_of_map(speeds[0])
    tasks = [column_of_map(speed) for speed in speeds]
    measured = {}
    for count in range(1, (os.cpu_count() or 1) + 1):
        with Parallel(n_jobs=count) as parallel:
            parallel(delayed(column_of_map)(speed) for speed in speeds[: 4 * count])
            begin = time.perf_counter()
            parallel(delayed(column_of_map)(speed) for speed in speeds)
            measured[count] = time.perf_counter() - begin
    return {
        "tasks": len(tasks),
        "measured": measured,
        "simulated": {count: makespan(tasks, count) for count in WORKERS},
    }


def overhead() -> dict[str, float]:
    """Seconds that a Dask scheduler with one worker spends on each of many tasks that do nothing."""
    import distributed

    with (
        distributed.LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        client.gather(client.map(abs, range(TASKS), pure=False))
        begin = time.perf_counter()
        client.gather(client.map(abs, range(TASKS), pure=False))
        return {"tasks": TASKS, "seconds_a_task": (time.perf_counter() - begin) / TASKS}


def main() -> None:
    with threadpool_limits(1):
        coordinates = []
        for basis in BASES:
            chosen = model(basis)
            size = chosen.system(SPEED).size
            coordinates.append({"basis": basis, "coordinates": size} | costs(chosen))
            print(coordinates[-1], flush=True)
        loads = []
        for count in PINIONS:
            loads.append({"loads": count} | costs(model(pinions=count)))
            print(loads[-1], flush=True)
    shared = processes()
    print(shared, flush=True)
    cluster = overhead()
    print(cluster, flush=True)
    write_record("growth", coordinates=coordinates, loads=loads, processes=shared, cluster=cluster)


if __name__ == "__main__":
    main()
