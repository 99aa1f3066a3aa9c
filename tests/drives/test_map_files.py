"""Maps as files, and by what they are known again."""

import csv

import numpy as np
import pytest

from facegear.drives.drive_file import parse_drive
from facegear.drives.examples import example_text
from facegear.drives.map_files import WRITERS, columns, foreign
from facegear.drives.report_arrays import growth_map
from facegear.drives.sweeps import sweep
from facegear.support import labelled
from facegear.support.tables import write_table

CASE_1 = parse_drive(example_text("case_1"))


@pytest.fixture(scope="module")
def found():
    return sweep(CASE_1, "stiffness", lowest=0.2, highest=0.8, cells=3, speeds_rpm=(400.0, 600.0))


def test_files(found, tmp_path):
    for end, write in WRITERS.items():
        write(found, tmp_path / f"map{end}")
    assert sorted(path.suffix for path in tmp_path.iterdir()) == sorted(WRITERS)
    chart = labelled.load(tmp_path / "map.nc")
    np.testing.assert_allclose(chart["growth_rate"], found.chart["growth_rate"])
    with (tmp_path / "map.csv").open(encoding="utf-8-sig") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 9
    assert list(rows[0]) == ["stiffness", "speed_rpm", "growth_rate_per_s"]
    assert float(rows[5]["growth_rate_per_s"]) == pytest.approx(
        columns(found)["growth_rate_per_s"][5], rel=1e-11
    )


@pytest.mark.parametrize("end", list(WRITERS))
def test_a_map_is_known_again(found, tmp_path, end):
    path = tmp_path / f"map{end}"
    assert not foreign(path)
    WRITERS[end](found, path)
    assert not foreign(path)


@pytest.mark.parametrize("end", list(WRITERS))
@pytest.mark.parametrize(
    "content", [b"precious\n", b"", b"\xff\xfe\x00", b'"', b"stiffness,speed_rpm\n" * 200]
)
def test_what_no_map_wrote_is_told(tmp_path, end, content):
    path = tmp_path / f"map{end}"
    path.write_bytes(content)
    assert foreign(path).startswith(f"map{end} is there and would be replaced")


def test_a_folder_other_arrays_and_other_tables_are_no_maps(tmp_path):
    folder = tmp_path / "map.csv"
    folder.mkdir()
    report = growth_map(CASE_1.transverse.gear, "stiffness", [0.5, 1.0], [500.0, 600.0], "of a report")
    arrays = labelled.save(report, tmp_path / "map_dead.nc")
    table = write_table(
        {"stiffness": [1.0], "speed_rpm": [1.0], "growth_rate_per_s": [1.0], "mine": [1.0]},
        tmp_path / "t.csv",
    )
    for path in (folder, arrays, table):
        assert foreign(path), path
