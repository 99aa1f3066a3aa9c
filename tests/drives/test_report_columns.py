"""Columns of the tables of a report."""

import pytest

from facegear.design.changes import effects_of_changes
from facegear.drives import report_arrays, report_columns, report_rows
from facegear.drives.drive_file import read_drive_file
from facegear.maps.tracing import tongues
from facegear.mechanics.mode_shapes import plate_modes
from facegear.support.parameters import rad_per_s
from tests.drives.drive_files import DRIVES

CASE_1 = read_drive_file(DRIVES / "case_1.yaml")
RANGE = (float(rad_per_s(500.0)), float(rad_per_s(720.0)))
FOUND = tongues(CASE_1.transverse, RANGE)


def test_columns_of_tables():
    table = report_arrays.tongue_table(FOUND, "")
    empty = report_arrays.tongue_table((), "")
    columns = report_columns.tongue_columns({"a": table, "none": empty, "b": table})
    assert columns["model"] == ["a"] * len(FOUND) + ["b"] * len(FOUND)
    assert columns["lower_rpm"] == 2 * table["lower"].values.tolist()
    windows = report_arrays.safe_windows(empty, RANGE)
    assert report_columns.window_columns({"a": windows})["upper_rpm"] == pytest.approx([720.0])
    modes = plate_modes(CASE_1.transverse.body, 3)
    columns = report_columns.frequency_columns(modes)
    assert len(columns["frequency_Hz"]) == 8
    assert columns["nodal_diameters"][:5] == [0, 1, 2, 3, 0]
    assert columns["nodal_circles"][3:5] == [0, 1]
    none = effects_of_changes(CASE_1.transverse, (), RANGE, "")
    assert report_columns.change_columns({"a": none})["change"] == []
    rows = report_columns.summary_columns(report_rows.strength(CASE_1))
    assert rows["unit"] == ["mm", "MPa", "MPa", "1"]
