import dataclasses
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import dataclass

import joblib
import numpy as np
import pytest
from threadpoolctl import threadpool_info, threadpool_limits

from benchmarks.synthetic_disk import contact_shape, disk_matrices
from facegear.floquet.loads import ContactLoad
from facegear.floquet.methods import AdaptiveMagnus, Stepwise
from facegear.floquet.models import replace_parameter
from facegear.floquet.multipliers import growth_rate
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.geometry.drive import Drive
from facegear.maps import parallel, ways
from facegear.maps.stability_map import stability_map
from facegear.maps.tracing import borders
from facegear.mechanics import cases
from facegear.mechanics.cases import FIGURES
from facegear.mechanics.classical_pairs import GearPair
from facegear.mechanics.plate import Body
from facegear.mechanics.properties import MeshLoad
from facegear.mechanics.transverse import Transverse
from facegear.support.parameters import rad_per_s


@pytest.fixture(scope="module", autouse=True)
def _small_models_stand_for_large_ones():
    """Their cells would be computed together (test_cells); here they go by column, on sheets and by row."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ways, "cells_of", lambda models, probes, speeds: None)
        yield


TURN = 2.0 * np.pi
COSINE = PiecewiseChebyshev.fit(lambda x, piece: np.cos(TURN * x), [0.0])


@dataclass(frozen=True)
class Mathieu:
    """q̈ + c q̇ + ω²(1 + ε cos θt) q = 0 at the speed θ."""

    modulation: float = 0.2
    damping: float = 0.01
    frequency: float = 1.0

    def system(self, speed: float) -> PeriodicSystem:
        load = ContactLoad(
            PiecewiseChebyshev.constant([1.0]), self.modulation * self.frequency**2, weight=COSINE
        )
        return PeriodicSystem([[1.0]], [[self.damping]], [[self.frequency**2]], [load], TURN / speed)


@dataclass(frozen=True)
class Meissner:
    """Stiffness ω²(1 ± ε), each for half the period: multipliers in closed form."""

    modulation: float = 0.3

    def system(self, speed: float) -> PeriodicSystem:
        signs = PiecewiseChebyshev(np.array([0.0, 0.5]), np.array([[[1.0]], [[0.0]]]))
        load = ContactLoad(PiecewiseChebyshev.constant([1.0]), 2.0 * self.modulation, weight=signs)
        return PeriodicSystem([[1.0]], [[0.0]], [[1.0 - self.modulation]], [load], TURN / speed)

    def growth(self, speed: float) -> float:
        half, product = np.pi / speed, np.eye(2)
        for square in (1.0 + self.modulation, 1.0 - self.modulation):
            w = np.sqrt(square)
            step = [[np.cos(w * half), np.sin(w * half) / w], [-w * np.sin(w * half), np.cos(w * half)]]
            product = np.array(step) @ product
        return float(np.log(np.abs(np.linalg.eigvals(product)).max()) * speed / TURN)


@dataclass(frozen=True)
class Disk:
    """The made-up disk with 28 states; the parameter scales the contact stiffness with speed if asked to."""

    stiffness: float = 1.0e6
    stiffening: float = 0.0
    loss: float = 0.0

    def system(self, speed: float) -> PeriodicSystem:
        damping, stiffness = disk_matrices(speed)
        load = ContactLoad(contact_shape(), self.stiffness * (1.0 + self.stiffening * speed), 10.0, 0.5)
        period = TURN / (130 * speed)
        return PeriodicSystem(np.eye(14), damping + self.loss * np.eye(14), stiffness, [load], period)


TRANSVERSE = Transverse(Body(Drive(26, 130, 3.175e-3), thickness_ratio=0.03), MeshLoad(1.0, 3e-6, 1.0))


def cell(model, parameter, value, speed, method=None):
    return growth_rate(replace_parameter(model, parameter, value).system(speed), method)


def check_cells(model, chart, parameter, method=None, rtol=1e-8):
    """Compare a few cells with growth rates computed for them alone, by another method if one is named."""
    rows, columns = chart.shape
    assert np.isfinite(chart).all()
    for i, j in [(0, 0), (rows // 3, columns // 2), (rows - 1, columns - 1), (rows // 2, 0)]:
        value, speed = float(chart[parameter][i]), float(chart["speed"][j])
        expected = cell(model, parameter, value, speed, method)
        period = model.system(speed).period
        assert abs(float(chart[i, j]) - expected) * period < rtol


def test_meissner_map_is_the_closed_form():
    speeds, values = np.linspace(0.5, 3.0, 6), np.linspace(0.05, 0.6, 12)
    chart = stability_map(Meissner(), speeds, "modulation", values, jobs=1)
    expected = [[Meissner(value).growth(speed) for speed in speeds] for value in values]
    unstable = np.array(expected) > 1e-3
    assert 5 < unstable.sum() < unstable.size
    assert np.abs(chart.values - expected)[unstable].max() < 1e-8
    # On the unit circle a double multiplier is as uncertain as the root of the error of the matrix.
    assert np.abs(chart.values - expected).max() < 1e-5


@pytest.mark.parametrize("teeth", [[100.0, 130.0], [90.0, 100.0, 110.0, 130.0]])
def test_each_cell_has_its_own_period(teeth):
    chart = stability_map(TRANSVERSE, [60.0, 80.0], "gear_teeth", teeth, jobs=1)
    for i, number in enumerate(teeth):
        for j, speed in enumerate((60.0, 80.0)):
            expected = cell(TRANSVERSE, "gear_teeth", number, speed)
            assert float(chart[i, j]) == pytest.approx(expected, rel=1e-8)


@dataclass(frozen=True)
class Stepped(Mathieu):
    """Stiffer from a speed on, and with a period that is not in proportion to its inverse."""

    stiffer_from: float = 1.7

    def system(self, speed: float) -> PeriodicSystem:
        stiffened = Mathieu(self.modulation, self.damping, 1.0 + 0.1 * (speed > self.stiffer_from))
        return dataclasses.replace(stiffened.system(speed), period=TURN / speed + 0.01)


@pytest.mark.parametrize("model", [Mathieu(), Stepped()])
def test_many_speeds_of_few_values_are_interpolated_along_speed_where_that_is_smooth(model, monkeypatch):
    systems = []
    system = type(model).system
    monkeypatch.setattr(type(model), "system", lambda self, v: systems.append(v) or system(self, v))
    speeds = np.linspace(1.5, 2.5, 400)
    chart = stability_map(model, speeds, "damping", [0.001, 0.01], jobs=1)
    if type(model) is Mathieu:
        assert len(systems) < 0.3 * chart.size
    for number in (0, 57, 153, 222, 399):
        expected = cell(model, "damping", 0.01, float(speeds[number]))
        assert float(chart[1, number]) == pytest.approx(expected, abs=1e-8)


def computed_tasks(monkeypatch):
    """List the kinds of tasks that are run."""
    run, kinds = parallel._run, []
    monkeypatch.setattr(parallel, "_run", lambda i, task: kinds.append(type(task).__name__) or run(i, task))
    return kinds


@pytest.mark.parametrize(
    ("model", "parameter", "values", "low", "high"),
    [
        (Mathieu(), "modulation", np.linspace(0.0, 0.5, 30), 1.0, 2.5),
        (Mathieu(), "damping", np.linspace(0.0, 0.3, 30), 1.0, 2.5),
        (Disk(), "stiffness", np.linspace(1e5, 2e6, 20), 50.0, 100.0),
        (Disk(), "loss", np.linspace(0.0, 5.0, 20), 50.0, 100.0),
        (Disk(stiffening=0.02), "stiffness", np.linspace(1e5, 2e6, 30), 50.0, 100.0),
    ],
)
def test_many_columns_are_read_off_a_sheet(model, parameter, values, low, high, monkeypatch):
    kinds = computed_tasks(monkeypatch)
    speeds = np.linspace(low, high, 120)
    chart = stability_map(model, speeds, parameter, values, jobs=1)
    assert kinds.count("_SheetChunk") == 8
    assert kinds.count("_Samples") < 60
    assert "_Chunk" not in kinds
    rng = np.random.default_rng(0)
    for i, j in zip(rng.integers(0, values.size, 20), rng.integers(0, 120, 20), strict=True):
        expected = cell(model, parameter, float(values[i]), float(speeds[j]))
        assert abs(float(chart[i, j]) - expected) * model.system(float(speeds[j])).period < 1e-9


@dataclass(frozen=True)
class Tuned(Mathieu):
    """Stiffer in a narrow range of speed, which the samples of a sheet do not meet."""

    tuned_to: float = 1.0 + 1.5 * 40 / 119

    def system(self, speed: float) -> PeriodicSystem:
        bump = 0.2 * np.exp(-(((speed - self.tuned_to) / 3e-4) ** 2))
        return Mathieu(self.modulation, self.damping, self.frequency + bump).system(speed)


def test_a_sheet_that_a_column_belies_is_not_used_there(monkeypatch):
    kinds = computed_tasks(monkeypatch)
    speeds, values = np.linspace(1.0, 2.5, 120), np.linspace(0.05, 0.5, 30)
    chart = stability_map(Tuned(), speeds, "modulation", values, jobs=1)
    assert "_SheetChunk" in kinds
    # The 41st column is the middle of a group of sixteen.
    for j in (39, 40, 41, 100):
        expected = [cell(Tuned(), "modulation", value, float(speeds[j])) for value in values.tolist()]
        assert np.abs(chart.values[:, j] - expected).max() < 1e-8


def test_sheets_are_kept_and_taken_up_again(tmp_path, monkeypatch):
    arguments = (MATHIEU, np.linspace(1.0, 2.5, 120), "modulation", np.linspace(0.05, 0.5, 12))
    expected = stability_map(*arguments, jobs=1)
    with monkeypatch.context() as patch:
        interrupt_after(patch, 10)
        with pytest.raises(KeyboardInterrupt):
            stability_map(*arguments, jobs=1, cache_directory=tmp_path)
    done = interrupt_after(monkeypatch, 1000)
    resumed = stability_map(*arguments, jobs=2, cache_directory=tmp_path)
    np.testing.assert_allclose(resumed, expected, rtol=1e-12, atol=1e-12)
    assert len(done) == len(list(tmp_path.glob("*.npz"))) - 10
    done.clear()
    again = stability_map(*arguments, jobs=1, cache_directory=tmp_path)
    np.testing.assert_array_equal(again, resumed)  # noqa: TID251 - read, not computed
    assert done == []


def test_axes_coordinates_and_attributes():
    speeds = rad_per_s(np.array([100.0, 250.0]))
    chart = stability_map(TRANSVERSE, speeds, "stiffness", [0.5, 1.0, 2.0], jobs=1)
    assert chart.dims == ("stiffness", "speed")
    assert chart.shape == (3, 2)
    np.testing.assert_allclose(chart["speed_rpm"], [100.0, 250.0], rtol=1e-14)
    assert chart.attrs["units"] == "1/s"
    assert chart["speed"].attrs["units"] == "rad/s"
    assert chart["stiffness"].attrs["long_name"] == "load.stiffness"
    assert "thickness_ratio=0.03" in chart.attrs["model"]
    assert 0.0 <= chart.attrs["error_estimate"] < 1e-9


@pytest.mark.parametrize(
    ("parameter", "values"),
    [
        ("stiffness", np.linspace(0.05, 2.0, 21)),
        ("damping", np.linspace(0.0, 1e-5, 21)),
        ("mass", np.linspace(0.05, 2.0, 21)),
        ("thickness_ratio", np.linspace(0.025, 0.045, 41)),
    ],
)
def test_every_kind_of_parameter_of_the_transverse_model(parameter, values):
    speeds = rad_per_s(np.array([110.0, 480.0, 950.0]))
    chart = stability_map(TRANSVERSE, speeds, parameter, values, jobs=1)
    check_cells(TRANSVERSE, chart, parameter, AdaptiveMagnus(1e-11), rtol=1e-7)


def test_only_load_parameters_take_the_shared_column(monkeypatch):
    def refuse(*arguments):
        raise AssertionError("column of load parameters expected")

    monkeypatch.setattr(ways, "_by_row", refuse)
    stability_map(TRANSVERSE, [10.0], "mass", [0.1, 0.2], jobs=1)
    with pytest.raises(AssertionError, match="column of load parameters"):
        stability_map(TRANSVERSE, [10.0], "thickness_ratio", [0.03, 0.04], jobs=1)


def test_a_parameter_too_fast_for_series_at_low_speeds_is_interpolated_at_high_ones(monkeypatch):
    """Rows below some speed, whose long periods ask for as many matrices as there are values, columns from it on."""
    seen = {}

    def watched(name, whole):
        def route(prepared, speeds):
            seen[name] = speeds.size
            return whole(prepared, speeds)

        return route

    for name in ("_by_row", "_by_column"):
        monkeypatch.setattr(ways, name, watched(name, getattr(ways, name)))
    speeds, values = rad_per_s(np.array([60.0, 120.0, 480.0, 950.0])), np.linspace(0.025, 0.045, 41)
    chart = stability_map(TRANSVERSE, speeds, "thickness_ratio", values, jobs=1)
    assert seen == {"_by_row": 2, "_by_column": 2}
    check_cells(TRANSVERSE, chart, "thickness_ratio", AdaptiveMagnus(1e-11), rtol=1e-7)
    periods = [TRANSVERSE.system(speed).period for speed in speeds.tolist()]
    alone = [stability_map(TRANSVERSE, [speed], "thickness_ratio", values[7:9], jobs=1) for speed in speeds]
    for column, own in enumerate(alone):
        np.testing.assert_allclose(
            chart[7:9, column] * periods[column], own[:, 0] * periods[column], atol=1e-9
        )


def test_load_parameters_that_depend_on_speed_are_not_mistaken():
    model = Disk(stiffening=0.02)
    chart = stability_map(model, [20.0, 60.0], "stiffness", np.linspace(1e5, 2e6, 12), jobs=1)
    check_cells(model, chart, "stiffness")


def test_parameters_outside_the_loads_are_interpolated_to_the_same_accuracy():
    chart = stability_map(Disk(), [20.0, 60.0], "loss", np.linspace(0.0, 5.0, 40), jobs=1)
    check_cells(Disk(), chart, "loss", AdaptiveMagnus(1e-11))


def test_counted_parameters_are_computed_one_by_one():
    chart = stability_map(TRANSVERSE, [30.0], "nodal_diameters", [2, 3, 4], jobs=1)
    check_cells(TRANSVERSE, chart, "nodal_diameters")


@dataclass(frozen=True)
class Kinked(Mathieu):
    """Modulation |value|: not analytic."""

    def system(self, speed: float) -> PeriodicSystem:
        return Mathieu(abs(self.modulation - 0.02), self.damping).system(speed)


def test_a_parameter_that_is_not_smooth_is_not_interpolated():
    values = np.linspace(-0.5, 0.5, 60)
    chart = stability_map(Kinked(), [2.0], "modulation", values, jobs=1)
    for i, value in enumerate(values):
        assert float(chart[i, 0]) == pytest.approx(cell(Kinked(), "modulation", value, 2.0), abs=1e-8)


def test_the_method_asked_for_is_the_one_used():
    method = Stepwise(12)
    chart = stability_map(Mathieu(), [1.1, 2.0], "damping", [0.0, 0.01, 0.05], method=method, jobs=1)
    for i, value in enumerate([0.0, 0.01, 0.05]):
        assert float(chart[i, 1]) == pytest.approx(cell(Mathieu(), "damping", value, 2.0, method), abs=1e-12)
    exact = stability_map(Mathieu(), [1.1, 2.0], "damping", [0.0, 0.01, 0.05], jobs=1)
    difference = float(np.abs(chart - exact).max())
    assert difference > 1e-5
    # Twelve sub-intervals are coarse, and the error estimate says so.
    assert chart.attrs["error_estimate"] > 0.3 * difference * float(TURN / 2.0)


MATHIEU = Mathieu()
SPEEDS, VALUES = np.linspace(0.5, 2.5, 30), np.linspace(0.1, 0.4, 4)


def test_processes_give_what_one_gives():
    alone = stability_map(MATHIEU, SPEEDS, "modulation", VALUES, jobs=1)
    shared = stability_map(MATHIEU, SPEEDS, "modulation", VALUES, jobs=2)
    np.testing.assert_allclose(shared, alone, rtol=1e-12, atol=1e-12)


def test_a_dask_cluster_gives_what_one_process_gives():
    distributed = pytest.importorskip("distributed")
    alone = stability_map(MATHIEU, SPEEDS, "modulation", VALUES, jobs=1)
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=False, dashboard_address=None
        ) as cluster,
        distributed.Client(cluster),
        joblib.parallel_config(backend="dask"),
    ):
        shared = stability_map(MATHIEU, SPEEDS, "modulation", VALUES)
    np.testing.assert_allclose(shared, alone, rtol=1e-12, atol=1e-12)


@pytest.mark.slow
@pytest.mark.takes(10)
def test_a_dask_cluster_of_processes_gives_what_one_process_gives():
    distributed = pytest.importorskip("distributed")
    arguments = (TRANSVERSE, rad_per_s(np.linspace(100.0, 1000.0, 20)), "stiffness", [0.5, 1.0, 2.0])
    alone = stability_map(*arguments, jobs=1)
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster),
        joblib.parallel_config(backend="dask"),
    ):
        shared = stability_map(*arguments)
    np.testing.assert_allclose(alone, shared, rtol=0.0, atol=1e-9)


def interrupt_after(monkeypatch, tasks):
    """Stop as Ctrl-C does after some tasks; return the list of tasks that were run."""
    run, done = parallel._run, []

    def counted(number, task):
        if len(done) == tasks:
            raise KeyboardInterrupt
        done.append(number)
        return run(number, task)

    monkeypatch.setattr(parallel, "_run", counted)
    return done


def test_an_interrupted_map_goes_on_where_it_stopped(tmp_path, monkeypatch):
    arguments = (MATHIEU, SPEEDS, "modulation", VALUES)
    expected = stability_map(*arguments, jobs=1)
    with monkeypatch.context() as patch:
        interrupt_after(patch, 2)
        with pytest.raises(KeyboardInterrupt):
            stability_map(*arguments, jobs=1, cache_directory=tmp_path)
    assert len(list(tmp_path.glob("*.npz"))) == 2
    done = interrupt_after(monkeypatch, 100)
    resumed = stability_map(*arguments, jobs=1, cache_directory=tmp_path)
    assert sorted(done) == [2, 3]
    np.testing.assert_allclose(resumed, expected, rtol=1e-12, atol=1e-12)
    again = stability_map(*arguments, jobs=1, cache_directory=tmp_path)
    np.testing.assert_array_equal(again, resumed)  # noqa: TID251 - read, not computed
    assert len(done) == 2
    assert not list(tmp_path.glob("*.part"))


LONG_MAP = """
import numpy as np
from facegear.mechanics.cases import FIGURES
from facegear.maps.stability_map import stability_map
from facegear.maps.tracing import borders
from facegear.support.parameters import rad_per_s

chart = stability_map(
    FIGURES["4.4a"].model(), rad_per_s(np.linspace(50.0, 1000.0, 400)), "stiffness", np.linspace(0.1, 2.0, 20),
    jobs=2, cache_directory="{kept}",
)
np.save("{result}", chart.values)
"""


@pytest.mark.slow
@pytest.mark.takes(10)
def test_two_workers_stopped_by_ctrl_c_lose_only_what_they_were_at(tmp_path):
    kept, result = tmp_path / "kept", tmp_path / "result.npy"
    command = [sys.executable, "-c", LONG_MAP.format(kept=kept.as_posix(), result=result.as_posix())]
    with subprocess.Popen(command, stderr=subprocess.DEVNULL) as process:
        while len(list(kept.glob("*.npz"))) < 3:
            assert process.poll() is None
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        assert process.wait(60) != 0
    before = {path: path.stat().st_mtime_ns for path in kept.glob("*.npz")}
    assert len(before) >= 3
    assert not result.exists()
    subprocess.run(command, check=True, stderr=subprocess.DEVNULL)
    after = {path: path.stat().st_mtime_ns for path in kept.glob("*.npz")}
    assert len(before) < len(after)
    assert all(after[path] == moment for path, moment in before.items())
    alone = stability_map(
        FIGURES["4.4a"].model(),
        rad_per_s(np.linspace(50.0, 1000.0, 400)),
        "stiffness",
        np.linspace(0.1, 2.0, 20),
        jobs=1,
    )
    np.testing.assert_allclose(np.load(result), alone.values, rtol=0.0, atol=1e-9)


def truncate(path):
    path.write_bytes(path.read_bytes()[:-40])


def empty(path):
    path.write_bytes(b"")


def flip(path):
    content = bytearray(path.read_bytes())
    content[len(content) // 3] ^= 0xFF
    path.write_bytes(bytes(content))


def forge(path):
    with np.load(path) as file:
        digest = file["digest"]
        np.savez(path, result=file["result"] + 1.0, digest=digest)


def test_models_whose_matrices_change_are_kept_too(tmp_path, monkeypatch):
    arguments = (Meissner(), SPEEDS[:9], "modulation", VALUES[:2])
    expected = stability_map(*arguments, jobs=1, cache_directory=tmp_path)
    done = interrupt_after(monkeypatch, 100)
    again = stability_map(*arguments, jobs=1, cache_directory=tmp_path)
    np.testing.assert_array_equal(again, expected)  # noqa: TID251 - read, not computed
    assert done == []
    stability_map(Meissner(), SPEEDS[:9] + 1e-9, "modulation", VALUES[:2], jobs=1, cache_directory=tmp_path)
    assert len(done) == 1


@pytest.mark.parametrize("damage", [truncate, empty, flip, forge])
def test_a_damaged_cache_is_computed_anew(tmp_path, monkeypatch, damage):
    arguments = (MATHIEU, SPEEDS, "modulation", VALUES)
    expected = stability_map(*arguments, jobs=1, cache_directory=tmp_path)
    files = sorted(tmp_path.glob("*.npz"))
    assert len(files) == 4
    damage(files[1])
    done = interrupt_after(monkeypatch, 100)
    again = stability_map(*arguments, jobs=1, cache_directory=tmp_path)
    np.testing.assert_allclose(again, expected, rtol=1e-12, atol=1e-12)
    assert len(done) == 1


def test_results_that_lie_where_another_belongs_are_computed_anew(tmp_path, monkeypatch):
    arguments = (MATHIEU, SPEEDS, "modulation", VALUES)
    expected = stability_map(*arguments, jobs=1, cache_directory=tmp_path)
    one, other, *_ = sorted(tmp_path.glob("*.npz"))
    kept = one.read_bytes()
    one.write_bytes(other.read_bytes())
    other.write_bytes(kept)
    done = interrupt_after(monkeypatch, 100)
    np.testing.assert_allclose(
        stability_map(*arguments, jobs=1, cache_directory=tmp_path), expected, rtol=1e-12
    )
    assert len(done) == 2


def test_results_of_another_code_are_computed_anew(tmp_path, monkeypatch):
    arguments = (MATHIEU, SPEEDS, "modulation", VALUES)
    stability_map(*arguments, jobs=1, cache_directory=tmp_path)
    monkeypatch.setattr(parallel, "code_digest", lambda: "another")
    done = interrupt_after(monkeypatch, 100)
    stability_map(*arguments, jobs=1, cache_directory=tmp_path)
    assert len(done) == 4


@pytest.fixture(scope="module")
def two_maps(tmp_path_factory):
    """Fill a cache with two maps, for tests to copy."""
    folder = tmp_path_factory.mktemp("two_maps")
    stability_map(MATHIEU, SPEEDS, "modulation", VALUES, jobs=1, cache_directory=folder)
    stability_map(Mathieu(damping=0.02), SPEEDS, "damping", VALUES / 2, jobs=1, cache_directory=folder)
    assert len(list(folder.glob("*.npz"))) == 8
    return folder


@pytest.mark.parametrize(
    "other",
    [
        (MATHIEU, SPEEDS + 1e-9, "modulation", VALUES, {}),
        (MATHIEU, SPEEDS, "modulation", VALUES + 1e-9, {}),
        (MATHIEU, SPEEDS, "modulation", VALUES, {"method": Stepwise(40)}),
        (Meissner(), SPEEDS, "modulation", VALUES, {}),
        (Mathieu(), SPEEDS, "damping", VALUES, {}),
        (Mathieu(frequency=1.5), SPEEDS, "damping", VALUES, {}),
    ],
)
def test_the_cache_is_not_used_for_another_map(two_maps, tmp_path, monkeypatch, other):
    shutil.copytree(two_maps, tmp_path, dirs_exist_ok=True)
    done = interrupt_after(monkeypatch, 100)
    *arguments, options = other
    stability_map(*arguments, **options, jobs=1, cache_directory=tmp_path)
    assert len(done) == 4


@pytest.mark.parametrize(
    ("speeds", "values", "message"),
    [
        ([], [0.1], "speeds must list at least one"),
        ([1.0], [], "values must list at least one"),
        ([0.0, 1.0], [0.1], "speeds must be greater than 0"),
        ([1.0, 1.0], [0.1], "speeds must ascend"),
        ([2.0, 1.0], [0.1], "speeds must ascend"),
        ([1.0, np.nan], [0.1], "speeds must be finite"),
        ([1.0], [np.inf], "values must be finite"),
        ([1.0], [0.1, 0.1], "values must differ"),
        ([[1.0]], [0.1], "speeds must list"),
        (
            np.linspace(1.0, 2.0, 100_000),
            np.linspace(0.1, 0.2, 100_000),
            "at most 10000000 cells, got 100000 times 100000",
        ),
    ],
)
def test_axes_are_checked(speeds, values, message):
    with pytest.raises(ValueError, match=message):
        stability_map(Mathieu(), speeds, "modulation", values, jobs=1)


def test_unknown_parameters_are_answered_with_those_that_exist():
    with pytest.raises(ValueError, match="modulation, damping, frequency"):
        stability_map(Mathieu(), [1.0], "stiffness", [1.0], jobs=1)


def test_the_progress_bar_is_shown_when_asked_for(capsys):
    stability_map(MATHIEU, SPEEDS, "modulation", VALUES, jobs=1)
    assert capsys.readouterr().err == ""
    stability_map(MATHIEU, SPEEDS, "modulation", VALUES, jobs=1, progress=True)
    assert "stability map" in capsys.readouterr().err


def test_values_that_share_breakpoints_with_the_probes_only():
    """Contact ratios 1, 2 and 3 break the period alike, 1.5 and 2.5 do not: no series may run through all."""
    model, ratios = GearPair(1.5, 0.5), np.linspace(1.0, 3.0, 5)
    chart = stability_map(model, [1.0, 2.0], "contact_ratio", ratios, jobs=1, progress=False)
    for ratio, row in zip(ratios.tolist(), chart.values, strict=True):
        anew = [growth_rate(GearPair(ratio, 0.5).system(speed)) for speed in (1.0, 2.0)]
        np.testing.assert_allclose(row, anew, atol=1e-9)


@pytest.mark.parametrize("wrong", [3, cases.CASE_1, Transverse, cases.CASE_1.drive], ids=range(4))
def test_what_is_no_model_is_named(wrong):
    with pytest.raises(TypeError, match=r"model must have a method system\(speed\).*got (a|the class) "):
        stability_map(wrong, [50.0], "stiffness", [1.0])


@pytest.mark.parametrize(
    ("jobs", "error", "says"),
    [
        (0, ValueError, "got 0"),
        (1.5, TypeError, "got 1.5"),
        (True, TypeError, "got True"),
        ("2", TypeError, "got '2'"),
    ],
)
def test_a_number_of_workers_that_is_none_is_refused_first(jobs, error, says):
    with pytest.raises(error, match=f"jobs must be .*-1 for all processors, {says}"):
        stability_map(TRANSVERSE, [50.0, 60.0], "stiffness", [0.5], jobs=jobs)
    with pytest.raises(error, match=f"jobs must be .*-1 for all processors, {says}"):
        borders(TRANSVERSE, "stiffness", [0.5], (50.0, 60.0), jobs=jobs)
    with pytest.raises(error, match=f"jobs must be .*-1 for all processors, {says}"):
        parallel.in_processes(abs, [(1,)], jobs)


@dataclass(frozen=True)
class Overdamping:
    """Two oscillators, one of which stops oscillating as its damping is swept."""

    damping: float = 0.1

    def system(self, speed):
        shape = PiecewiseChebyshev.fit(
            lambda x, _: np.stack([np.cos(x), 1.0 + x * (1.0 - x)], axis=1), [0.0, 0.4]
        )
        load = ContactLoad(shape, 0.4, 0.05)
        return PeriodicSystem(
            np.eye(2), np.diag([self.damping, 0.02]), np.diag([1.0, 5.0]), (load,), 6.0 / speed
        )


def test_a_motion_may_stop_oscillating_along_the_parameter():
    speeds, values = np.linspace(0.7, 1.5, 30), np.linspace(0.1, 5.0, 14)
    chart = stability_map(Overdamping(), speeds, "damping", values, jobs=1)
    for i, j in ((0, 0), (5, 20), (9, 7), (13, 29)):
        cell = growth_rate(Overdamping(float(values[i])).system(float(speeds[j])))
        assert float(chart[i, j]) == pytest.approx(cell, abs=1e-9)


def test_one_thread_within_another_and_as_before_after_it():
    def threads():
        return {library["num_threads"] for library in threadpool_info() if library["user_api"] == "blas"}

    with threadpool_limits(limits=2, user_api="blas"):
        before = threads()
        with parallel.one_thread():
            with parallel.one_thread():
                assert threads() == {1}
            assert threads() == {1}
        assert threads() == before
