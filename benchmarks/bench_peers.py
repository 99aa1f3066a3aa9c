"""Time maps of small systems, Mathieu's equation and a gearbox, beside general-purpose integrators and Hill's method.

Run from the repository root: ``python -m benchmarks.bench_peers``; heyoka is in the dependency group
``peers``. All on one core, in one run. heyoka and the package compute every cell; the slow routes are timed on a sample
of cells and scaled. SKHiPPR is in no package index: its method, the Koopman-Hill projection, is written out here.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import cached_property, partial
from itertools import pairwise
from typing import Any

import heyoka
import numpy as np
import scipy.linalg
from threadpoolctl import threadpool_limits

from benchmarks.bench_maps import (
    SAMPLED_SPEEDS,
    SUB_INTERVALS,
    Row,
    clocked,
    coarsest,
    run_batched,
    run_dop853,
    run_stepwise,
    sampled_row,
)
from benchmarks.record import write_record
from benchmarks.synthetic_disk import Array
from facegear.floquet.eigenvalues import spectral_radii
from facegear.floquet.methods import AdaptiveMagnus
from facegear.floquet.models import replace_parameter
from facegear.floquet.multipliers import multipliers
from facegear.floquet.periodic import PeriodicSystem
from facegear.maps.stability_map import stability_map
from facegear.mechanics.classical import Mathieu
from facegear.mechanics.gearboxes import FIGURES
from facegear.support.parameters import rad_per_s

# Local error of heyoka's steps, relative and absolute.
TAYLOR_TOLERANCE = 1e-9
# Cells that heyoka integrates at once; of once, twice and four times its own suggestion twice is the fastest here.
LANES = 2 * heyoka.recommended_simd_size()
# Harmonics that are tried; where the stiffness jumps, the projection converges slowly, and the last ones count.
HARMONICS = [2, 3, 4, 6, 8, 12, 16, 24, 32, 48]


@dataclass(frozen=True, eq=False)
class Problem:
    """A map of a small system: a model, its speeds and the values of one of its parameters."""

    name: str
    model: Any
    parameter: str
    speeds: Array
    values: Array

    def system(self, column: int, row: int) -> PeriodicSystem:
        model = replace_parameter(self.model, self.parameter, float(self.values[row]))
        return model.system(float(self.speeds[column]))

    @cached_property
    def sample(self) -> list[tuple[int, int]]:
        """Columns and rows of cells spread over the map."""
        columns = np.linspace(0, self.speeds.size - 1, SAMPLED_SPEEDS).astype(int).tolist()
        return [(column, (7 * column + 3) % self.values.size) for column in columns]

    @cached_property
    def exact(self) -> list[float]:
        """Spectral radii of the sample."""
        return [abs(multipliers(self.system(*cell), AdaptiveMagnus(1e-12))[0]) for cell in self.sample]

    @cached_property
    def periods(self) -> Array:
        """T0 of each column, by which growth rates become radii: known beforehand, as the numbers of heyoka's cells."""
        return np.array([self.system(column, 0).period for column in range(self.speeds.size)])

    def package(self, step: int = 1) -> Array:
        """Spectral radii of all cells, or of those at every so many speeds."""
        speeds = self.speeds[::step]
        chart = stability_map(self.model, speeds, self.parameter, self.values, jobs=1, progress=False)
        return np.exp(chart.to_numpy() * self.periods[::step])

    def whole(self, route: str, run: Callable[[], Array]) -> Row:
        """Time a route on all cells."""
        radii, wall, used = clocked(run)
        errors = [
            abs(radii[row, column] - x) for (column, row), x in zip(self.sample, self.exact, strict=True)
        ]
        return Row(f"{self.name}: {route}", 1, wall, used, max(errors), radii.size)


class Taylor:
    """heyoka's integrators of the columns of X, dX/dx = T0 A(x) X, one for each smooth piece of the period x.

    Numbers that are the same in all cells are compiled in, the others are parameters of the integrator.
    """

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        cells = [(column, row) for row in range(problem.values.size) for column in range(problem.speeds.size)]
        systems = [problem.system(*cell) for cell in cells]
        first = systems[0]
        self.size, self.edges = first.size, np.append(first.breakpoints, 1.0)
        numbers = np.array([self.numbers(system) for system in systems])
        varying = np.ptp(numbers, axis=0) > 0.0
        self.parameters = numbers[:, varying].T
        names = iter([heyoka.par[i] for i in range(len(self.parameters))])
        terms = [next(names) if varies else float(x) for varies, x in zip(varying, numbers[0], strict=True)]
        self.integrators = [self.integrator(first, piece, terms) for piece in range(first.breakpoints.size)]

    @staticmethod
    def numbers(system: PeriodicSystem) -> Array:
        """T0, M⁻¹C, M⁻¹K and stiffness and damping of the loads, one after the other."""
        inverse = np.linalg.inv(system.mass)
        loads = [[load.stiffness, load.damping] for load in system.loads]
        return np.concatenate(
            [[system.period], *(inverse @ system.damping), *(inverse @ system.stiffness), *loads]
        )

    def integrator(self, system: PeriodicSystem, piece: int, terms: list[Any]) -> Any:
        n = self.size
        period, damping, stiffness = terms[0], terms[1 : 1 + n * n], terms[1 + n * n : 1 + 2 * n * n]
        inverse = np.linalg.inv(system.mass)
        start, equations = self.edges[piece], []
        shapes = [self.shape(load, start, self.edges[piece + 1]) for load in system.loads]
        for column in range(2 * n):
            q = [heyoka.make_vars(f"q{i}_{column}") for i in range(n)]
            v = [heyoka.make_vars(f"v{i}_{column}") for i in range(n)]
            pull = [
                sum(damping[n * i + j] * v[j] + stiffness[n * i + j] * q[j] for j in range(n))
                for i in range(n)
            ]
            for load, (phi, slope, weight), k, c in zip(
                system.loads, shapes, terms[1 + 2 * n * n :: 2], terms[2 + 2 * n * n :: 2], strict=True
            ):
                moved = sum(phi[j] * q[j] for j in range(n))
                rate = sum(phi[j] * v[j] for j in range(n))
                if load.rate == "total":
                    rate += sum(slope[j] * q[j] for j in range(n)) / period
                force = weight * (k * moved + c * rate)
                for i in range(n):
                    pull[i] += force * sum(float(inverse[i, j]) * phi[j] for j in range(n))
            equations += [(q[i], period * v[i]) for i in range(n)]
            equations += [(v[i], -period * pull[i]) for i in range(n)]
        state = np.zeros((len(equations), LANES))
        parameters = np.zeros((len(self.parameters), LANES))
        return heyoka.taylor_adaptive_batch(equations, state, tol=TAYLOR_TOLERANCE, pars=parameters)

    @staticmethod
    def shape(load: Any, start: float, end: float) -> tuple[list[Any], list[float], Any]:
        """φ and its slope on a piece, where it is a straight line, and the weight, where it is 1 or a cosine."""
        ends = load.shape(start), load.shape(end, "left")
        slope = (ends[1] - ends[0]) / (end - start)
        middle = np.abs(load.shape((start + end) / 2.0) - (ends[0] + ends[1]) / 2.0).max()
        assert middle < 1e-12 * np.abs(ends).max(initial=1e-300), "shape is no straight line"
        phi = [float(a) + float(b) * (heyoka.time - start) for a, b in zip(ends[0], slope, strict=True)]
        weight = 1.0
        if load.weight is not None:
            x = np.linspace(0.0, 1.0, 9)
            assert np.abs(load.weight(x)[:, 0] - np.cos(2.0 * np.pi * x)).max() < 1e-9, "weight is no cosine"
            weight = heyoka.cos(2.0 * np.pi * heyoka.time)
        return phi, slope.tolist(), weight

    def radii(self) -> Array:
        """Spectral radii of all cells, shape (V, S)."""
        n = self.size
        cells = self.parameters.shape[1]
        found = np.empty((cells, 2 * n, 2 * n))
        # Columns of X, one after the other, begin as those of the unit matrix; for the last cells lanes repeat.
        unit = np.repeat(np.eye(2 * n).reshape(-1, 1), LANES, axis=1)
        for begin in range(0, cells, LANES):
            lanes = np.minimum(np.arange(begin, begin + LANES), cells - 1)
            state = unit
            for integrator, (start, end) in zip(self.integrators, pairwise(self.edges), strict=True):
                integrator.set_time(start)
                integrator.state[:] = state
                integrator.pars[:] = self.parameters[:, lanes]
                integrator.propagate_until(end)
                state = integrator.state
            found[lanes] = state.T.reshape(LANES, 2 * n, 2 * n).swapaxes(1, 2)
        return spectral_radii(found).reshape(self.problem.values.size, self.problem.speeds.size)


def koopman_hill(system: PeriodicSystem, harmonics: int) -> Array:
    """Φ from one exponential of Hill's matrix: the Koopman-Hill projection (Bayer, Leine, Nonlinear Dyn. 111, 2023)."""
    n, order = system.size, 2 * harmonics
    _, damping, stiffness = system.fourier(order)
    inverse = np.linalg.inv(system.mass)
    coefficients = np.zeros((2 * order + 1, 2 * n, 2 * n), dtype=complex)
    for series, part in ((stiffness, slice(0, n)), (damping, slice(n, None))):
        half = -inverse @ (series.cosine - 1j * series.sine) / 2.0
        coefficients[order + 1 :, n:, part] = half
        coefficients[order - 1 :: -1, n:, part] = half.conj()
        coefficients[order, n:, part] = -inverse @ series.mean
    coefficients[order, :n, n:] = np.eye(n)
    numbers = np.arange(-harmonics, harmonics + 1)
    blocks = coefficients[order + numbers[:, None] - numbers]
    hill = blocks.swapaxes(1, 2).reshape(numbers.size * 2 * n, -1) * system.period
    hill -= 2j * np.pi * np.diag(np.repeat(numbers, 2 * n))
    rows = slice(harmonics * 2 * n, (harmonics + 1) * 2 * n)
    return scipy.linalg.expm(hill)[rows].reshape(2 * n, numbers.size, 2 * n).sum(axis=1).real


def run_koopman_hill(system: PeriodicSystem, exact: float) -> tuple[Array, float, float]:
    count = coarsest(partial(koopman_hill, system), exact, HARMONICS)
    return clocked(lambda: koopman_hill(system, count))


def problems(size: int, gearbox_size: int) -> list[Problem]:
    figure = FIGURES["7.13b"]
    return [
        Problem(
            f"Mathieu, 2 states, {size} × {size}",
            Mathieu(depth=0.4, damping_ratio=0.02),
            "depth",
            np.linspace(0.4, 2.6, size),
            np.linspace(0.0, 0.95, size),
        ),
        Problem(
            f"Fig. 7.13(b), 6 states, {gearbox_size} × {gearbox_size}",
            figure.model(),
            figure.parameter,
            rad_per_s(np.linspace(figure.lowest_rpm, 1000.0, gearbox_size)),
            np.geomspace(figure.lowest, figure.highest, gearbox_size),
        ),
    ]


def measure(size: int, gearbox_size: int) -> list[Row]:
    rows = []

    def keep(row: Row) -> None:
        rows.append(row)
        print(
            f"{row.route:<100}{row.processor_seconds:>10.2f} s{row.largest_error:>10.0e}{row.cells_timed:>8}",
            flush=True,
        )

    for problem in problems(size, gearbox_size):
        problem.package(problem.speeds.size // 3)  # pays for what is compiled and derived once
        keep(problem.whole("facegear.stability_map", problem.package))
        keep(problem.whole(f"heyoka, Taylor, tolerance {TAYLOR_TOLERANCE:.0e}", Taylor(problem).radii))
        cells = [(problem.system(*cell), x) for cell, x in zip(problem.sample, problem.exact, strict=True)]
        for route, run in (
            (f"Koopman-Hill projection (SKHiPPR), to 1e-6 or {HARMONICS[-1]} harmonics", run_koopman_hill),
            ("solve_ivp DOP853, rtol 1e-8", run_dop853),
            ("aligned midpoint rule, scipy expm batched, to 1e-6", run_batched),
            (
                f"dissertation's rule, scipy expm one by one, to 1e-6 or {SUB_INTERVALS[-1]} steps",
                run_stepwise,
            ),
        ):
            keep(
                sampled_row(f"{problem.name}: {route}", cells, run, problem.speeds.size * problem.values.size)
            )
    return rows


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--size", type=int, default=200, help="cells along each axis, Mathieu")
    parser.add_argument("--gearbox-size", type=int, default=60, help="cells along each axis, gearbox")
    arguments = parser.parse_args()
    with threadpool_limits(1):
        rows = measure(arguments.size, arguments.gearbox_size)
    write_record("peers", rows=[asdict(row) for row in rows])


if __name__ == "__main__":
    main()
