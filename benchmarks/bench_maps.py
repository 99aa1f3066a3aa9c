"""Time 200 × 200 stability maps against the dissertation's rule and general-purpose integrators.

Run from the repository root: ``python -m benchmarks.bench_maps [--size 200]``.
All rows are measured in one run on one machine. The slow routes are timed on a sample of cells, spread over the map,
and scaled to all of them; the table says how many.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import cache, partial
from itertools import pairwise

import numpy as np
import scipy.linalg
from joblib import Parallel, delayed
from scipy.integrate import solve_ivp
from threadpoolctl import threadpool_limits

from benchmarks.record import peak_memory, processor_name, write_record
from benchmarks.synthetic_disk import (
    CONTACT_DAMPING,
    CONTACT_MASS,
    CONTACT_STIFFNESS,
    PINIONS,
    Array,
    contact_shape,
    synthetic_disk,
    synthetic_shafts,
)
from facegear.floquet.columns import column_spectral_radii, family_spectral_radii
from facegear.floquet.methods import AdaptiveMagnus, Stepwise
from facegear.floquet.multipliers import multipliers, transition_matrix
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.floquet.stepping import aligned_edges
from facegear.support.parameters import rad_per_s

LOWEST_RPM, HIGHEST_RPM = 10.0, 1000.0
TORSIONAL_RPM = (100.0, 1000.0)
FACE_GEAR_TEETH_TORSIONAL = 107
SAMPLE_ACCURACY = 1e-6
SAMPLED_SPEEDS = 12


@dataclass(frozen=True)
class Row:
    """One line of the table."""

    route: str
    cores: int
    seconds_per_map: float
    processor_seconds: float
    largest_error: float
    cells_timed: int


def radius(matrix: Array) -> float:
    return float(np.abs(np.linalg.eigvals(matrix)).max())


def transverse_column(speed: float, values: Array, pinions: int, swept: str) -> Array:
    """One column of a map of the synthetic disk: bearing stiffness, damping or contact mass swept."""
    column = dict.fromkeys(("mass", "damping", "stiffness"), np.ones(values.size))
    column[swept] = values
    return column_spectral_radii(
        synthetic_disk(speed, [_shape(i) for i in range(pinions)]),
        CONTACT_MASS * column["mass"],
        CONTACT_DAMPING * column["damping"],
        CONTACT_STIFFNESS * column["stiffness"],
    )


@cache
def _shape(pinion: int) -> PiecewiseChebyshev:
    return contact_shape(*PINIONS[pinion])


def torsional_column(speed: float, values: Array) -> Array:
    """One column of a map of the synthetic shafts: input-shaft stiffness swept."""
    period = 2.0 * np.pi / (FACE_GEAR_TEETH_TORSIONAL * speed)
    return family_spectral_radii(lambda stiffness: synthetic_shafts(stiffness, period), values)


def timed_column(column: Callable[[float], Array], speed: float) -> tuple[Array, float]:
    """One column and the processor time it took."""
    begin = time.thread_time()
    with threadpool_limits(limits=1):
        return column(speed), time.thread_time() - begin


def timed_map(
    column: Callable[[float], Array], speeds: Array, cores: int, workers: str
) -> tuple[Array, float, float]:
    """Spectral radii of a whole map, wall time with the start of the workers, processor time of all columns."""
    begin = time.perf_counter()
    done = Parallel(n_jobs=cores, prefer=workers)(delayed(timed_column)(column, speed) for speed in speeds)
    wall = time.perf_counter() - begin
    return np.stack([result for result, _ in done], axis=1), wall, sum(used for _, used in done)


def scipy_stepwise(system: PeriodicSystem, edges: Array) -> Array:
    """Midpoint rule (2-11) with one batched scipy.linalg.expm."""
    lengths = np.diff(edges) * system.period
    factors = scipy.linalg.expm(
        system.state_matrix(edges[:-1] + np.diff(edges) / 2.0) * lengths[:, None, None]
    )
    total = np.eye(2 * system.size)
    for factor in factors:
        total = factor @ total
    return total


def dissertation_rule(system: PeriodicSystem, sub_intervals: int) -> Array:
    """Stepwise exponential (2-9 to 2-11): matrices assembled together, one scipy.linalg.expm at a time."""
    step = 1.0 / sub_intervals
    matrices = system.state_matrix((np.arange(sub_intervals) + 0.5) * step) * (step * system.period)
    total = np.eye(2 * system.size)
    for matrix in matrices:
        total = scipy.linalg.expm(matrix) @ total
    return total


def dop853(system: PeriodicSystem) -> Array:
    """Transition matrix by scipy.integrate.solve_ivp, DOP853, rtol 1e-8, from kink to kink."""
    n = 2 * system.size
    y = np.eye(n).ravel()
    edges = np.append(system.breakpoints, 1.0) * system.period

    def rhs(t: float, y: Array) -> Array:
        return (system.state_matrix(t / system.period) @ y.reshape(n, n)).ravel()

    for a, b in pairwise(edges):
        y = solve_ivp(rhs, (a, b), y, method="DOP853", rtol=1e-8, atol=1e-11).y[:, -1]
    return y.reshape(n, n)


def sampled_row(route: str, cells: list[tuple[PeriodicSystem, float]], run, total: int) -> Row:
    """Time `run(system, exact)` -> (matrix, wall and processor seconds) on sample cells and scale to `total` cells."""
    seconds, used, errors = [], [], []
    for system, exact in cells:
        matrix, wall, processor = run(system, exact)
        seconds.append(wall)
        used.append(processor)
        errors.append(float(abs(radius(matrix) - exact)))
    return Row(
        route, 1, float(np.mean(seconds)) * total, float(np.mean(used)) * total, max(errors), len(cells)
    )


# Numbers of sub-intervals that are tried.
SUB_INTERVALS = [count for power in range(5, 17) for count in (2**power, 3 * 2 ** (power - 1))]


def coarsest(build: Callable[[int], Array], exact: float, counts: list[int] = SUB_INTERVALS) -> int:
    """Smallest of some counts from which on the sample accuracy holds, or the last one (search not timed).

    It must hold for the next three counts too: an error that changes its sign is small by accident somewhere.
    """
    met: list[int] = []
    for count in counts:
        if abs(radius(build(count)) - exact) <= SAMPLE_ACCURACY:
            met.append(count)
            if len(met) == 4:
                return met[0]
        else:
            met.clear()
    return counts[-1]


def clocked(function: Callable[[], Array]) -> tuple[Array, float, float]:
    begin, used = time.perf_counter(), time.process_time()
    result = function()
    return result, time.perf_counter() - begin, time.process_time() - used


def run_stepwise(system: PeriodicSystem, exact: float) -> tuple[Array, float, float]:
    # The search uses the package's own exponentials, the timed run scipy's.
    def fast(count: int) -> Array:
        return transition_matrix(system, Stepwise(count))

    count = coarsest(fast, exact)
    return clocked(lambda: dissertation_rule(system, count))


def run_batched(system: PeriodicSystem, exact: float) -> tuple[Array, float, float]:
    count = coarsest(lambda q: scipy_stepwise(system, aligned_edges(system.breakpoints, q)), exact)
    return clocked(lambda: scipy_stepwise(system, aligned_edges(system.breakpoints, count)))


def run_dop853(system: PeriodicSystem, exact: float) -> tuple[Array, float, float]:
    del exact
    return clocked(lambda: dop853(system))


def errors_of_map(
    chart: Array, speeds: Array, build: Callable[[float, int], PeriodicSystem]
) -> tuple[float, int]:
    """Largest error of a map at sampled cells against the adaptive Magnus route at 1e-12."""
    errors = []
    for i in np.linspace(0, speeds.size - 1, SAMPLED_SPEEDS).astype(int):
        row = (7 * i + 3) % chart.shape[0]
        exact = abs(multipliers(build(float(speeds[i]), row), AdaptiveMagnus(1e-12))[0])
        errors.append(abs(chart[row, i] - exact))
    return float(max(errors)), len(errors)


def measure(size: int) -> list[Row]:
    """All rows of the table for maps of `size` × `size` cells."""
    speeds = rad_per_s(np.linspace(LOWEST_RPM, HIGHEST_RPM, size))
    values = np.linspace(0.0, 1.0, size)
    rows = []
    for pinions, swept in ((1, "stiffness"), (1, "damping"), (1, "mass"), (2, "stiffness")):
        for cores in (1, 2):
            chart, seconds, used = timed_map(
                partial(transverse_column, values=values, pinions=pinions, swept=swept),
                speeds,
                cores,
                "threads",
            )

            def build(speed: float, row: int, pinions: int = pinions, swept: str = swept) -> PeriodicSystem:
                system = synthetic_disk(speed, [_shape(i) for i in range(pinions)])
                full = {"mass": CONTACT_MASS, "damping": CONTACT_DAMPING, "stiffness": CONTACT_STIFFNESS}
                return system.replace_loads(**{swept: full[swept] * values[row]})

            error, checked = errors_of_map(chart, speeds, build)
            name = f"collocation, 28 states, {pinions} load{'s'[: pinions - 1]}, {swept}"
            rows.append(Row(name, cores, seconds, used, error, chart.size))
            print(rows[-1], f"errors at {checked} cells", file=sys.stderr, flush=True)

    torsional_speeds = rad_per_s(np.linspace(*TORSIONAL_RPM, size))
    stiffnesses = np.linspace(1e4, 6e5, size)
    for cores in (1, 2):
        chart, seconds, used = timed_map(
            partial(torsional_column, values=stiffnesses), torsional_speeds, cores, "processes"
        )

        def build_shafts(speed: float, row: int) -> PeriodicSystem:
            return synthetic_shafts(stiffnesses[row], 2.0 * np.pi / (FACE_GEAR_TEETH_TORSIONAL * speed))

        error, _ = errors_of_map(chart, torsional_speeds, build_shafts)
        rows.append(Row("Magnus, 6 states, shaft stiffness", cores, seconds, used, error, chart.size))
        print(rows[-1], file=sys.stderr, flush=True)

    cells = []
    for i in np.linspace(0, size - 1, SAMPLED_SPEEDS).astype(int):
        system = synthetic_disk(float(speeds[i]), [_shape(0)]).replace_loads(
            stiffness=CONTACT_STIFFNESS * values[(7 * i + 3) % size]
        )
        cells.append((system, abs(multipliers(system, AdaptiveMagnus(1e-12))[0])))
    total = size * size
    for name, run in (
        ("dissertation's rule, scipy expm one by one, to 1e-6", run_stepwise),
        ("aligned midpoint rule, scipy expm batched, to 1e-6", run_batched),
        ("solve_ivp DOP853, rtol 1e-8", run_dop853),
    ):
        rows.append(sampled_row(name, cells, run, total))
        print(rows[-1], file=sys.stderr, flush=True)
    return rows


def fresh_rows(size: int) -> list[Row]:
    """Time the public call in fresh processes: first call with its imports, first call, second call."""
    rows = []
    for workers in (1, 2):
        command = [sys.executable, "-m", "benchmarks.first_call", str(size), str(workers)]
        done = subprocess.run(
            command,
            capture_output=True,
            text=True,
            check=True,
            env=os.environ | {"OPENBLAS_NUM_THREADS": "1"},
        )
        spans = json.loads(done.stdout)
        error = spans.pop("error_estimate")
        with_imports = {key: spans["imports"][key] + spans["first call"][key] for key in spans["imports"]}
        for name, span in (
            ("first call, imports included", with_imports),
            ("first call, imports done", spans["first call"]),
            ("second call", spans["second call"]),
        ):
            rows.append(
                Row(
                    f"stability_map of Fig. 4.4(a), {name}",
                    workers,
                    span["seconds"],
                    span["processor_seconds"],
                    error,
                    size**2,
                )
            )
            print(rows[-1], file=sys.stderr, flush=True)
    return rows


def table(rows: list[Row], size: int) -> str:
    """Text of the table; ratios are those of processor time to the first row, so a busy machine does not matter."""
    first = rows[0].processor_seconds
    lines = [
        f"{size} x {size} map, {LOWEST_RPM:.0f} to {HIGHEST_RPM:.0f} rpm (torsional from {TORSIONAL_RPM[0]:.0f}); "
        f"{processor_name()}, {os.cpu_count()} cores, one BLAS thread each",
        f"{'route':<54}{'cores':>6}{'wall s':>10}{'CPU s':>10}{'ratio':>8}{'error':>10}{'cells timed':>13}",
    ]
    for row in rows:
        ratio = row.processor_seconds / first
        lines.append(
            f"{row.route:<54}{row.cores:>6}{row.seconds_per_map:>10.2f}{row.processor_seconds:>10.2f}"
            f"{ratio:>8.1f}{row.largest_error:>10.0e}{row.cells_timed:>13}"
        )
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--size", type=int, default=200, help="cells along each axis")
    arguments = parser.parse_args()
    with threadpool_limits(1):
        rows = measure(arguments.size) + fresh_rows(arguments.size)
    print(table(rows, arguments.size))
    print(f"peak memory of one process: {peak_memory():.0f} MB")
    write_record("maps", size=arguments.size, rows=[asdict(row) for row in rows])


if __name__ == "__main__":
    main()
