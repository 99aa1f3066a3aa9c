"""The report on a drive, as a stranger makes it: from any folder, with papermill or with the project's own command."""

import csv
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import nbformat
import pytest
import yaml
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook

from facegear.drives.drive_file import read_drive_file
from facegear.support.labelled import load
from tests.drives.test_verdict import Reader
from tools import run_drive

ROOT = Path(__file__).resolve().parents[2]
NOTEBOOK = ROOT / "notebooks" / "your_drive.ipynb"
EXAMPLES = sorted((ROOT / "data" / "drives").glob("*.yaml"))
ENVIRONMENT = os.environ | {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
FORCES = ("force follows the rim", "force keeps its direction")
COMMAND = [sys.executable, str(ROOT / "tools" / "run_drive.py")]


def called(command, folder):
    return subprocess.run(command, capture_output=True, text=True, check=False, cwd=folder, env=ENVIRONMENT)


def rows(path):
    with path.open(encoding="utf-8-sig") as file:
        return list(csv.DictReader(file))


def test_there_are_eight_examples():
    assert [path.stem for path in EXAMPLES] == [
        "both_faces",
        "case_1",
        "case_2",
        "example_b",
        "gearbox_table_7_1",
        "localized",
        "shaft_angle_85",
        "two_gears",
    ]


@pytest.mark.slow
@pytest.mark.takes(80)
@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_papermill_makes_the_report_in_any_folder(tmp_path, example):
    shutil.copy(example, tmp_path / "my_drive.yaml")
    command = [sys.executable, "-m", "papermill", str(NOTEBOOK), "out.ipynb"]
    # One basis: that bases are raised is tested with them, and the book's own example does it.
    command += ["-p", "drive_file", "my_drive.yaml", "-p", "cells", "12", "-p", "most_steps", "1"]
    # One example in as many processes as the notebook takes by itself. Of maps this small most of the time would go
    # into starting them, and two of these tests run at once.
    if example.stem != "case_1":
        command += ["-p", "jobs", "1"]
    done = called(command, tmp_path)
    assert done.returncode == 0, done.stderr
    results = tmp_path / "my_drive_results"
    file = read_drive_file(example)

    models = [f"{clock}, {force}" for clock in file.contacts for force in FORCES]
    models += ["torsion"] * (file.torsional is not None)
    low, high = (30 / 3.141592653589793 * speed for speed in file.requirements.speeds)
    unstable, safe = rows(results / "tongues.csv"), rows(results / "safe_windows.csv")
    for model in models:
        parts = [row for table in (unstable, safe) for row in table if row["model"] == model]
        width = sum(float(row["upper_rpm"]) - float(row["lower_rpm"]) for row in parts)
        assert width == pytest.approx(high - low, rel=1e-6), model
    assert {row["model"] for row in unstable + safe} == set(models)
    assert all(float(row["growth_per_s"]) > 0 for row in unstable)

    summary = {row["quantity"]: float(row["value"]) for row in rows(results / "summary.csv")}
    assert summary["outer radius of the teeth R2"] == pytest.approx(1e3 * file.drive.outer_radius, rel=1e-9)
    assert any(name.startswith("critical thickness ratio h/a, ") for name in summary)
    assert summary["largest stress at the root"] > 0
    assert ("torsional natural frequency 3" in summary) == (file.torsional is not None)
    assert load(results / "map_follower.nc")["growth_rate"].shape == (12, 12)
    assert (results / "torsional_map.nc").exists() == (file.torsional is not None)
    assert (results / "tooth_mm.stl").stat().st_size > 84
    assert len(rows(results / "tooth_points_mm.csv")) == 2 * 33 * 17
    assert {row["change"] for row in rows(results / "changes.csv")} >= {"pinion mass", "bearing stiffness"}

    outputs = [
        output
        for cell in nbformat.read(tmp_path / "out.ipynb", as_version=4).cells
        for output in cell.get("outputs", [])
    ]
    words = " ".join(str(form) for output in outputs for form in output.get("data", {}).values())
    faces = bool(file.teeth and file.teeth.sides)
    assert ("on the faces front, back of the gear" in words) == ("0.5 mesh periods ahead" in words) == faces
    assert ("power of a mesh" in words) == (file.roles is not None) == ("power of a pinion" not in words)
    pictures = [output for output in outputs if "image/svg+xml" in output.get("data", {})]
    assert len(pictures) == 6 + (file.torsional is not None)
    assert not [output for output in outputs if output.output_type in ("error", "stream")]


HOSTILE = """<img src=x onerror="window.p=1"> $x^2$ {ref}`a` [l](javascript:0)
# B | c"""


@pytest.mark.slow
@pytest.mark.takes(70)
def test_the_projects_command_leaves_a_page_beside_the_file(tmp_path):
    content = yaml.safe_load((ROOT / "data" / "drives" / "example_b.yaml").read_text(encoding="utf-8"))
    # Stable, and over few speeds: the shortest report there is, and one without a tongue.
    content["name"] = HOSTILE
    content["pinions"]["mass"] = 0.1
    content["operation"] |= {"lowest_speed_rpm": 950, "power_kW": 20.0}
    (tmp_path / "stable.yaml").write_text(yaml.safe_dump(content), encoding="utf-8")
    done = called([*COMMAND, "stable.yaml"], tmp_path)
    assert done.returncode == 0, done.stderr
    results = tmp_path / "stable_results"
    *progress, last = done.stdout.splitlines()
    assert [line.split(":")[0] for line in progress] == [f"cell {k} of 24" for k in range(1, 25)]
    assert last == f"The report: {(results / 'report.html').as_uri()}"
    assert "encryption" not in done.stderr
    page = (results / "report.html").read_text(encoding="utf-8")
    assert "for stability nothing has to change" in page
    assert "Stable at all speeds from 950 to 1000 rpm under the driving force of 20 kW a pinion" in page
    read = Reader(page)
    assert HOSTILE.replace("\n", " ") in read.text
    assert not {"img", "iframe", "object", "embed"} & set(read.elements)
    assert not rows(results / "changes.csv")
    assert not (results / "failed").exists()
    # Nothing is fetched, nothing is left as an object's name, every file that is listed is there.
    assert not re.findall(r"""(?:src|href)=["']?(?:https?:)?//|from ["']https?:|url\(["']?https?:""", page)
    assert "IPython" not in re.sub(r"<(style|script).*?</\1>", "", page, flags=re.DOTALL)
    listed = re.findall(r"<code>([\w.]+\.(?:csv|nc|stl))</code>", page)
    assert len(listed) > 10
    assert all((results / name).is_file() for name in listed)
    assert "rad/s" not in page
    for caption in ("Speeds at which the drive is unstable", "Mesh frequency over speed"):
        assert caption in page


def test_a_mistake_is_told_before_any_work(tmp_path):
    text = (ROOT / "data" / "drives" / "case_1.yaml").read_text(encoding="utf-8")
    (tmp_path / "wrong.yaml").write_text(
        text.replace("module_mm: 3.175", "module_mm: 0.003175"), encoding="utf-8"
    )
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


def test_every_cell_that_starts_is_told_and_the_report_comes_last(tmp_path, monkeypatch, capfd):
    """Minutes went by without a line, but for a warning of the kernel."""
    parameters = new_code_cell(
        "drive_file = output_directory = ''\nmost_steps = 1", metadata={"tags": ["parameters"]}
    )
    cells = [
        new_markdown_cell("# A report"),
        parameters,
        new_code_cell(""),
        new_code_cell("import sys\nprint('trouble', file=sys.__stderr__)"),
        new_markdown_cell("Words.\n\n## Its end\n\nMore words."),
        new_code_cell("2 + 3"),
    ]
    kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
    nbformat.write(new_notebook(cells=cells, metadata={"kernelspec": kernel}), tmp_path / "short.ipynb")
    monkeypatch.setattr(run_drive, "NOTEBOOK", tmp_path / "short.ipynb")
    assert run_drive.make_report(tmp_path / "my.yaml", tmp_path / "results") == 0
    said, complaints = capfd.readouterr()
    page = tmp_path / "results" / "report.html"
    assert said.splitlines() == [
        "cell 1 of 3: A report",
        "cell 2 of 3: A report",
        "cell 3 of 3: Its end",
        f"The report: {page.as_uri()}",
    ]
    assert "trouble" in complaints
    assert "encryption" not in complaints
    assert ">5<" in page.read_text(encoding="utf-8").replace("\n", "")


def test_how_to_call_it(tmp_path):
    done = called(COMMAND, tmp_path)
    assert done.returncode == 2
    assert "python tools/run_drive.py my_drive.yaml" in done.stderr
