"""The report on a drive, as a stranger makes it: from any folder, with papermill or with the project's own command."""

import csv
import os
import shutil
import subprocess
import sys
from pathlib import Path

import nbformat
import pytest

from facegear.drive_file import read_drive_file
from facegear.reference import load

ROOT = Path(__file__).resolve().parents[1]
NOTEBOOK = ROOT / "notebooks" / "your_drive.ipynb"
EXAMPLES = sorted((ROOT / "data" / "drives").glob("*.yaml"))
ENVIRONMENT = os.environ | {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
COMMAND = [sys.executable, str(ROOT / "tools" / "run_drive.py")]


def called(command, folder):
    return subprocess.run(command, capture_output=True, text=True, check=False, cwd=folder, env=ENVIRONMENT)


def rows(path):
    with path.open(encoding="utf-8-sig") as file:
        return list(csv.DictReader(file))


def test_there_are_five_examples():
    assert [path.stem for path in EXAMPLES] == [
        "case_1",
        "case_2",
        "example_b",
        "gearbox_table_7_1",
        "shaft_angle_85",
    ]


@pytest.mark.slow
@pytest.mark.takes(20)
@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_papermill_makes_the_report_in_any_folder(tmp_path, example):
    shutil.copy(example, tmp_path / "my_drive.yaml")
    command = [sys.executable, "-m", "papermill", str(NOTEBOOK), "out.ipynb"]
    command += ["-p", "drive_file", "my_drive.yaml", "-p", "cells", "12"]
    done = called(command, tmp_path)
    assert done.returncode == 0, done.stderr
    results = tmp_path / "my_drive_results"
    file = read_drive_file(example)

    models = ["transverse", "transverse, true sweep"] + ["torsional"] * (file.torsional is not None)
    low, high = (30 / 3.141592653589793 * speed for speed in file.requirements.speed_range)
    unstable, safe = rows(results / "tongues.csv"), rows(results / "safe_windows.csv")
    for model in models:
        parts = [row for table in (unstable, safe) for row in table if row["model"] == model]
        width = sum(float(row["upper_rpm"]) - float(row["lower_rpm"]) for row in parts)
        assert width == pytest.approx(high - low, rel=1e-6), model
    assert {row["model"] for row in unstable + safe} == set(models)
    assert all(float(row["growth_per_s"]) > 0 for row in unstable)

    summary = {row["quantity"]: float(row["value"]) for row in rows(results / "summary.csv")}
    assert summary["outer radius of the teeth R2"] == pytest.approx(1e3 * file.drive.outer_radius, rel=1e-9)
    assert summary["critical thickness ratio h/a"] > 0
    assert summary["largest stress at the root"] > 0
    assert ("torsional natural frequency 3" in summary) == (file.torsional is not None)
    assert load(results / "transverse_map.nc")["growth_rate"].shape == (12, 12)
    assert (results / "torsional_map.nc").exists() == (file.torsional is not None)
    assert (results / "tooth_mm.stl").stat().st_size > 84
    assert len(rows(results / "tooth_points_mm.csv")) == 2 * 33 * 17
    assert {row["change"] for row in rows(results / "changes.csv")} >= {"pinion mass", "bearing stiffness"}

    outputs = [
        output
        for cell in nbformat.read(tmp_path / "out.ipynb", as_version=4).cells
        for output in cell.get("outputs", [])
    ]
    pictures = [output for output in outputs if "image/svg+xml" in output.get("data", {})]
    assert len(pictures) == 5 + (file.torsional is not None)
    assert not [output for output in outputs if output.output_type in ("error", "stream")]


@pytest.mark.slow
@pytest.mark.takes(20)
def test_the_projects_command_leaves_a_page_beside_the_file(tmp_path):
    text = (ROOT / "data" / "drives" / "example_b.yaml").read_text(encoding="utf-8")
    # Stable, and with few modes: the shortest report there is, and one without a tongue.
    text = text.replace("mass: 1.0", "mass: 0.1").replace("lowest_speed_rpm: 60", "lowest_speed_rpm: 800")
    (tmp_path / "stable.yaml").write_text(text, encoding="utf-8")
    done = called([*COMMAND, "stable.yaml"], tmp_path)
    assert done.returncode == 0, done.stderr
    results = tmp_path / "stable_results"
    assert (results / "report.html").as_uri() in done.stdout
    page = (results / "report.html").read_text(encoding="utf-8")
    assert "nothing has to change" in page
    assert "Example B" in page
    assert not rows(results / "changes.csv")
    assert not (results / "failed").exists()


def test_a_mistake_is_told_before_any_work(tmp_path):
    text = EXAMPLES[0].read_text(encoding="utf-8").replace("module_mm: 3.175", "module_mm: 0.003175")
    (tmp_path / "wrong.yaml").write_text(text, encoding="utf-8")
    done = called([*COMMAND, "wrong.yaml"], tmp_path)
    assert done.returncode == 1
    assert done.stdout == ""
    (line,) = done.stderr.splitlines()
    assert line.startswith("wrong.yaml: gears.module_mm must lie in [0.1, 100] in mm, got 0.003175 mm")
    assert [path.name for path in tmp_path.iterdir()] == ["wrong.yaml"]


@pytest.mark.slow
def test_papermill_stops_at_a_mistake(tmp_path):
    (tmp_path / "wrong.yaml").write_text("name: A\ngear: {}\n", encoding="utf-8")
    command = [
        sys.executable,
        "-m",
        "papermill",
        str(NOTEBOOK),
        "out.ipynb",
        "-p",
        "drive_file",
        "wrong.yaml",
    ]
    done = called(command, tmp_path)
    assert done.returncode == 1
    assert (
        "DriveFileError: wrong.yaml: gear = {} is no key of a drive file: did you mean gears?" in done.stderr
    )
    assert not list(tmp_path.glob("*_results"))


def test_how_to_call_it(tmp_path):
    done = called(COMMAND, tmp_path)
    assert done.returncode == 2
    assert "python tools/run_drive.py my_drive.yaml" in done.stderr
