"""The order in which cells of the explorer's maps are computed."""

import numpy as np
import pytest

from facegear.drives.stages import Plan
from facegear.drives.studies.drive import drive_study
from facegear.drives.studies.gearbox import gearbox_study
from facegear.drives.studies.teeth import BETWEEN, teeth_study
from facegear.mechanics.sharing import RULES

DRIVES = {
    "one pinion": (drive_study(), {}),
    "three pinions": (drive_study(), {"pinions": "3"}),
    "two gears": (teeth_study(), {"pinions": BETWEEN}),
    "two gears, shared load": (teeth_study(), {"pinions": BETWEEN, "sharing": next(iter(RULES))}),
    "gearbox": (gearbox_study(), {}),
}


def planned(name, way):
    study, changes = DRIVES[name]
    settings = study.settings(changes)
    speeds, _ = study.axes(settings, study.vertical)
    return Plan.of(study.model(settings), speeds, way)


@pytest.mark.parametrize("way", ["cells", "loads", "columns", "rows"])
@pytest.mark.parametrize("name", DRIVES)
@pytest.mark.parametrize("shape", [(40, 60), (20, 40), (17, 12), (2, 2), (1, 3)])
def test_stages_fill_a_map_piece_by_piece_and_no_cell_twice_but_those_of_the_first(name, way, shape):
    plan, times = planned(name, way), np.zeros(shape, dtype=int)
    growth, parts = np.full(shape, np.nan), []
    for stage in range(len(plan.steps)):
        for rows, columns in plan.pieces(growth, stage):
            times[np.ix_(rows, columns)] += 1
        growth[times > 0] = 1.0
        # Of every so manyth row and speed all are there, and what is not has the value of a neighbour.
        assert np.isfinite(growth[np.ix_(*plan.grid(stage, shape))]).all()
        assert (plan.shown(growth, stage) == 1.0).all()
        parts.append(np.isfinite(growth).mean())
    assert parts == sorted(parts)
    assert parts[-1] == 1.0
    # Whole columns are computed over those cells of them that the first stage had.
    first = np.zeros(shape, dtype=bool)
    first[np.ix_(*plan.grid(0, shape))] = True
    assert (times[~first] == 1).all()
    assert (times <= (2 if way in ("loads", "columns") else 1)).all()


@pytest.mark.parametrize("way", ["loads", "columns", "rows"])
@pytest.mark.parametrize("name", ["three pinions", "two gears", "two gears, shared load"])
def test_a_costly_drive_has_a_map_that_can_be_read_after_a_quarter_of_its_cells(name, way):
    """Each of them takes up to four seconds for all of its cells, so a second for a quarter."""
    plan, shape = planned(name, way), (40, 60)
    growth, first = np.full(shape, np.nan), None
    for stage, (row_step, column_step) in enumerate(plan.steps):
        for rows, columns in plan.pieces(growth, stage):
            growth[np.ix_(rows, columns)] = 0.0
        first = np.isfinite(growth).mean() if first is None else first
        if row_step * column_step == 4:
            break
    assert row_step <= 2
    # Besides them there are the cells of the first stage, if whole columns follow.
    assert np.isfinite(growth).mean() <= 0.25 + first
    assert first < 0.04


@pytest.mark.parametrize("way", ["loads", "columns", "rows"])
@pytest.mark.parametrize("name", ["three pinions", "two gears", "two gears, shared load"])
def test_pieces_of_a_costly_drive_are_short(name, way):
    """A change is heard between them: of 2400 cells none has more than a twelfth."""
    plan, growth = planned(name, way), np.full((40, 60), np.nan)
    for stage in range(len(plan.steps)):
        for rows, columns in list(plan.pieces(growth, stage)):
            assert rows.size * columns.size <= 200
            growth[np.ix_(rows, columns)] = 0.0


def test_of_a_light_drive_whole_columns_are_one_piece():
    plan, growth = planned("one pinion", "loads"), np.full((40, 60), np.nan)
    ((rows, columns),) = plan.pieces(growth, 1)
    assert plan.steps[1] == (1, 1)
    assert (rows.size, columns.size) == (40, 60)
    assert len(plan.steps) == 2


def test_slow_drives_have_shorter_pieces_and_more_stages():
    """Their periods are long, and so is the computation of each cell."""
    study, _ = DRIVES["one pinion"]
    settings = study.settings({"highest_speed": 100.0})
    speeds, _ = study.axes(settings, study.vertical)
    slow = Plan.of(study.model(settings), speeds, "loads")
    usual = planned("one pinion", "loads")
    assert slow.cells < usual.cells
    assert len(slow.steps) > len(usual.steps)


def test_a_cell_that_is_not_there_has_the_value_of_its_neighbour_in_the_finest_stage_that_has_one():
    plan = planned("one pinion", "rows")
    growth = np.full((16, 16), np.nan)
    for stage in range(2):
        growth[np.ix_(*plan.grid(stage, growth.shape))] = float(stage)
    growth[0, 2] = 7.0
    shown = plan.shown(growth, 2)
    assert set(np.unique(shown)) == {1.0, 7.0}
    assert shown[0, :4].tolist() == [7.0] * 4
    assert shown[1, :4].tolist() == [7.0] * 4
