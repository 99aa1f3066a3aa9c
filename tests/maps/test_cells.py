"""Maps of small systems, cell by cell together: against single cells, and which maps they are taken for."""

from dataclasses import dataclass, field

import numpy as np
import pytest

from facegear.floquet.free_modes import UnsuitableSystemError
from facegear.floquet.loads import ContactLoad
from facegear.floquet.methods import AdaptiveMagnus
from facegear.floquet.models import replace_parameter
from facegear.floquet.multipliers import growth_rate
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.maps import cells as module
from facegear.maps import ways as engine
from facegear.maps.cells import cells_of
from facegear.maps.stability_map import stability_map
from facegear.mechanics.classical import Mathieu
from facegear.mechanics.gearboxes import FIGURES
from facegear.support.parameters import rad_per_s

GEARBOX = FIGURES["7.13b"]


def check(model, chart, parameter, among):
    for row in range(0, chart.shape[0], among):
        for column in range(0, chart.shape[1], among):
            cell = chart[row, column]
            own = replace_parameter(model, parameter, float(cell[parameter]))
            system = own.system(float(cell.speed))
            exact = growth_rate(system, AdaptiveMagnus(1e-12))
            assert float(cell) * system.period == pytest.approx(exact * system.period, abs=1e-9)


@pytest.mark.parametrize("parameter", ["output_damping", "input_stiffness", "mesh_damping"])
def test_gearbox(parameter):
    model, speeds = GEARBOX.model(), rad_per_s(np.linspace(GEARBOX.lowest_rpm, 1000.0, 12))
    chart = stability_map(model, speeds, parameter, np.geomspace(1e-6, 1e-2, 11), jobs=1, progress=False)
    assert chart.attrs["error_estimate"] < 1e-9
    check(model, chart, parameter, 5)


def test_cells_are_interpolated_along_speed_where_that_takes_fewer(monkeypatch):
    asked, over = [], module.Taylor.over
    monkeypatch.setattr(
        module.Taylor, "over", lambda own, family, turns: asked.append(turns.size) or over(own, family, turns)
    )
    model = Mathieu(depth=0.4, damping_ratio=0.02)
    chart = stability_map(
        model, np.linspace(0.4, 2.6, 150), "depth", np.linspace(0.0, 0.95, 7), jobs=1, progress=False
    )
    assert 0 < asked[0] < 75
    check(model, chart, "depth", 6)
    # Where a series is belied, each cell is computed.
    monkeypatch.setattr(module, "agree", lambda *found: False)
    again = stability_map(
        model, np.linspace(0.4, 2.6, 150), "depth", np.linspace(0.0, 0.95, 7), jobs=1, progress=False
    )
    assert 150 in asked
    assert np.abs(again - chart).max() < 1e-9


def test_and_along_a_line_of_load_parameters(monkeypatch):
    asked, over = [], module.Taylor.over
    monkeypatch.setattr(
        module.Taylor,
        "over",
        lambda own, family, turns: asked.append(len(family.systems)) or over(own, family, turns),
    )
    arguments = Mathieu(depth=0.4, damping_ratio=0.02), np.linspace(0.4, 2.6, 25), "depth"
    chart = stability_map(*arguments, np.linspace(0.0, 0.95, 80), jobs=1, progress=False)
    assert max(asked) < 20
    check(arguments[0], chart, "depth", 12)
    # On no line, each value has its own.
    values = np.append(np.linspace(0.0, 0.9, 49), 0.95)
    monkeypatch.setattr(module, "same_but_load_parameters", lambda one, other: False)
    alone = stability_map(*arguments, values, jobs=1, progress=False)
    assert max(asked) == 50
    assert np.abs(alone[-1] - chart[-1]).max() < 1e-9


@dataclass(frozen=True)
class Own:
    """A model of one coordinate whose stiffness may depend on speed."""

    depth: float = 0.3
    with_speed: float = 0.0
    mass: float = 0.0
    coordinates: tuple[object, ...] = field(default=(), repr=False)

    def system(self, speed):
        load = ContactLoad(PiecewiseChebyshev.constant([1.0]), stiffness=self.depth, mass=self.mass)
        return PeriodicSystem([[1.0]], [[0.01]], [[1.0 + self.with_speed * speed]], (load,), 2.0 / speed)


def taken(model):
    return cells_of(
        [replace_parameter(model, "depth", x) for x in (0.1, 0.2, 0.3)], (0, 1, 2), np.arange(1.0, 4.0)
    )


def counted_rows(monkeypatch):
    """Numbers of values that go by rows, as they are asked for."""
    asked, by_row = [], engine._by_row
    monkeypatch.setattr(
        engine, "_by_row", lambda sweep, *rest: asked.append(len(sweep.values)) or by_row(sweep, *rest)
    )
    return asked


def test_a_mass_that_changes_leaves_each_row_in_lockstep(monkeypatch):
    asked, model = counted_rows(monkeypatch), GEARBOX.model()
    speeds = rad_per_s(np.linspace(GEARBOX.lowest_rpm, 1000.0, 12))
    inertias = model.gearbox.load_inertia * np.linspace(0.5, 4.0, 11)
    chart = stability_map(model, speeds, "load_inertia", inertias, jobs=1, progress=False)
    assert not asked
    assert chart.attrs["error_estimate"] < 1e-9
    check(model, chart, "load_inertia", 5)


def test_values_that_ask_for_too_many_steps_go_by_rows_and_no_others(monkeypatch):
    asked, model = counted_rows(monkeypatch), GEARBOX.model()
    speeds = rad_per_s(np.linspace(GEARBOX.lowest_rpm, 1000.0, 6))
    stiffness = model.gearbox.input_stiffness * np.geomspace(1.0, 1e5, 11)
    chart = stability_map(model, speeds, "input_stiffness", stiffness, jobs=1, progress=False)
    assert len(asked) == 1
    assert 0 < asked[0] < 6
    check(model, chart, "input_stiffness", 5)


def test_steps_that_are_enough_but_not_half_as_long_leave_the_estimate_to_another_method(monkeypatch):
    def too_many(systems):
        raise UnsuitableSystemError("coefficients ask for more steps")

    monkeypatch.setattr(module, "_scaled", too_many)
    model = Mathieu(depth=0.4, damping_ratio=0.02)
    chart = stability_map(
        model, np.linspace(1.5, 2.5, 7), "depth", np.linspace(0.1, 0.5, 6), jobs=1, progress=False
    )
    assert chart.attrs["error_estimate"] < 1e-9
    check(model, chart, "depth", 5)


@pytest.mark.parametrize(("lowest", "deepest"), [(0.1, 5.0), (0.05, 2.0)])
def test_cells_beside_others_that_grow_very_much_within_their_period(lowest, deepest):
    model = Mathieu(depth=0.0, damping_ratio=0.01)
    speeds, depths = np.linspace(lowest, 4.0, 200), np.linspace(0.0, deepest, 13)
    chart = stability_map(model, speeds, "depth", depths, jobs=1, progress=False)
    assert float((chart * 2.0 * np.pi / chart.speed).max()) > 25.0
    for row in range(0, 13, 4):
        for column in range(0, 200, 12):
            alone = growth_rate(replace_parameter(model, "depth", depths[row]).system(speeds[column]))
            assert float(chart[row, column]) == pytest.approx(alone, abs=1e-9)


def test_what_speed_changes_besides_the_period_is_not_taken_for_nothing():
    assert taken(Own()) is not None
    assert taken(Own(with_speed=1e-9)) is None


def test_contact_masses_go_another_way():
    model = Own(mass=0.5)
    chart = stability_map(
        model, np.linspace(1.0, 2.0, 5), "depth", [0.1, 0.2, 0.3, 0.4], jobs=1, progress=False
    )
    check(model, chart, "depth", 2)


def test_what_is_kept_is_taken_up_again(tmp_path, monkeypatch):
    monkeypatch.setattr(module, "_CELLS", 60)
    arguments = Mathieu(depth=0.4), np.linspace(1.0, 3.0, 20), "depth", np.linspace(0.0, 0.9, 8)
    first = stability_map(*arguments, jobs=1, progress=False, cache_directory=tmp_path)
    files = sorted(tmp_path.glob("*.npz"))
    assert len(files) == 3
    files[0].unlink()
    computed, compute = [], module._Chunk.compute
    monkeypatch.setattr(module._Chunk, "compute", lambda own: computed.append(own) or compute(own))
    again = stability_map(*arguments, jobs=2, progress=False, cache_directory=tmp_path)
    assert len(computed) == 1
    assert np.abs(again - first).max() < 1e-12
