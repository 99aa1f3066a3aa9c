"""The command `facegear`, as a stranger calls it: from any folder, with files that are right and wrong."""

import argparse
import errno
import io
import os
import re
import shutil
import signal
import subprocess
import sys
import time
import warnings

import nbformat
import numpy as np
import psutil
import pytest
import yaml

import facegear
import facegear.__main__
from facegear.drives import command, sections
from facegear.drives.command import main
from facegear.drives.drive_file import read_drive_file
from facegear.support.labelled import load
from tests.drives.drive_files import CASE_1, DRIVES, ROOT, rows
from tests.drives.test_page import HOSTILE, Reader

EXAMPLES = sorted(DRIVES.glob("*.yaml"))
ENVIRONMENT = os.environ | {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
COMMAND = [sys.executable, "-m", "facegear"]
FORCES = ("force follows the rim", "force keeps its direction")


@pytest.mark.parametrize("command", ["check", "report"])
def test_a_mistake_is_told_before_any_work(here, capsys, command):
    wrong = here / "wrong.yaml"
    wrong.write_text(CASE_1.replace("module_mm: 3.175", "module_mm: 0.003175"), encoding="utf-8")
    assert main([command, "wrong.yaml"]) == 1
    out, err = capsys.readouterr()
    assert out == ""
    (line,) = err.splitlines()
    assert line.startswith("wrong.yaml: gears.module_mm must lie in [0.1, 100] in mm, got 0.003175 mm")
    assert list(here.iterdir()) == [wrong]


def test_an_interruption_while_the_command_is_loaded(monkeypatch):
    class Interrupts:
        @staticmethod
        def find_spec(name, *_):
            if name == "facegear.drives.command":
                raise KeyboardInterrupt

    monkeypatch.delitem(sys.modules, "facegear.drives.command")
    monkeypatch.setattr(sys, "meta_path", [Interrupts, *sys.meta_path])
    assert facegear.__main__.main() == 130


@pytest.mark.parametrize("encoding", ["cp1252", "ascii"])
def test_what_is_redirected_is_in_utf_8_whatever_the_system_writes(tmp_path, encoding):
    environment = ENVIRONMENT | {"PYTHONIOENCODING": encoding, "PYTHONUTF8": "0"}

    def run(*arguments):
        return subprocess.run([*COMMAND, *arguments], capture_output=True, check=True, env=environment).stdout

    assert "α" in run("new", "--help").decode("utf-8")
    (tmp_path / "mine.yaml").write_bytes(run("examples", "shaft_angle_85"))
    assert read_drive_file(tmp_path / "mine.yaml").drive.shaft_angle == pytest.approx(np.deg2rad(85.0))


def test_a_terminal_that_lacks_a_letter_shows_another(monkeypatch):
    class Terminal(io.TextIOWrapper):
        def isatty(self):
            return True

    written = io.BytesIO()
    terminal = Terminal(written, encoding="ascii", write_through=True)
    monkeypatch.setattr(sys, "stdout", terminal)
    monkeypatch.setattr(sys, "stderr", None)
    monkeypatch.setattr(sys, "argv", ["facegear", "examples", "shaft_angle_85"])
    assert facegear.__main__.main() == 0
    assert (terminal.encoding, b"85?" in written.getvalue()) == ("ascii", True)


def test_a_replaced_worker_is_not_worth_a_word(monkeypatch, recwarn):
    def warned(options):
        warnings.warn(
            "A worker stopped while some jobs were given to the executor.", UserWarning, stacklevel=1
        )
        warnings.warn("something else", UserWarning, stacklevel=1)
        return 0

    given = argparse.ArgumentParser()
    given.set_defaults(run=warned)
    monkeypatch.setattr(command, "parser", lambda: given)
    assert main([]) == 0
    assert [str(each.message) for each in recwarn] == ["something else"]


# --- the report -------------------------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.takes(60)
@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_a_report_in_any_folder(here, example, capsys):
    shutil.copy(example, here / "my_drive.yaml")
    # One basis: that bases are raised is tested with them, and the book's own example does it. One example in as many
    # processes as there are; of maps this small most of the time would go into starting them.
    jobs = [] if example.stem == "case_1" else ["--jobs", "1"]
    assert main(["report", "my_drive.yaml", "--cells", "12", "--most-steps", "1", *jobs]) == 0
    results = here / "my_drive_results"
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

    page = (results / "report.html").read_text(encoding="utf-8")
    read = Reader(page)
    assert "This part could not be computed" not in read.text
    assert "was not written" not in read.text
    faces = bool(file.teeth and file.teeth.sides)
    assert ("on the faces front, back of the gear" in read.text) == faces
    assert ("0.5 mesh periods ahead" in read.text) == faces
    assert (
        ("power of a mesh" in read.text) == (file.roles is not None) == ("power of a pinion" not in read.text)
    )
    assert read.elements.count("img") == 6 + (file.torsional is not None)
    assert capsys.readouterr().out == f"The report: {(results / 'report.html').as_uri()}\n"


@pytest.mark.slow
@pytest.mark.takes(30)
def test_the_command_leaves_a_page_beside_the_file(tmp_path):
    content = yaml.safe_load((ROOT / "data" / "drives" / "example_b.yaml").read_text(encoding="utf-8"))
    # Stable, and over few speeds: the shortest report there is, and one without a tongue.
    content["name"] = HOSTILE
    content["pinions"]["mass"] = 0.1
    content["operation"] |= {"lowest_speed_rpm": 950, "power_kW": 20.0}
    (tmp_path / "stable.yaml").write_text(yaml.safe_dump(content), encoding="utf-8")
    # Small as it is, in several processes most of the time would go into starting them.
    command = [*COMMAND, "report", "stable.yaml", "--jobs", "1"]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path, env=ENVIRONMENT)
    assert done.returncode == 0, done.stderr
    results = tmp_path / "stable_results"
    assert done.stdout == f"The report: {(results / 'report.html').as_uri()}\n"
    sections_of = [f"section {k} of 12" for k in range(1, 13)]
    cases_of = [f"case {k} of 4" for k in range(1, 5)]
    told = [line.split(":")[0] for line in done.stderr.splitlines()]
    assert told == [sections_of[0], *cases_of, *sections_of[1:]]
    page = (results / "report.html").read_text(encoding="utf-8")
    assert "for stability nothing has to change" in page
    assert "Stable at all speeds from 950 to 1000 rpm under the driving force of 20 kW a pinion" in page
    read = Reader(page)
    assert HOSTILE.replace("\n", " ") in read.text
    assert not {"script", "iframe", "object", "embed", "link"} & set(read.elements)
    assert not [name for name, _ in read.attributes if name.startswith("on")]
    assert not rows(results / "changes.csv")
    # Nothing is fetched, and every file that is listed is there.
    sources = [value for name, value in read.attributes if name in ("src", "href")]
    assert all(value.startswith(("data:image/svg+xml;base64,", "#section-")) for value in sources)
    listed = re.findall(r"<code>([\w.]+\.(?:csv|nc|stl))</code>", page)
    assert len(listed) > 10
    assert all((results / name).is_file() for name in listed)
    assert "rad/s" not in page
    for caption in ("Speeds at which the drive is unstable", "Mesh frequency over speed"):
        assert caption in page


def workers(process):
    below = process.children(recursive=True)
    return below if any("LokyProcess" in " ".join(child.cmdline()) for child in below) else []


@pytest.mark.slow
@pytest.mark.takes(30)
@pytest.mark.skipif(os.name == "nt", reason="signals as POSIX has them")
@pytest.mark.parametrize(
    ("what", "how", "whom"),
    [
        ("report", signal.SIGINT, "group"),
        ("report", signal.SIGINT, "it"),
        ("report", signal.SIGTERM, "it"),
        ("report", signal.SIGKILL, "it"),
        ("assess", signal.SIGINT, "group"),
        ("assess", signal.SIGTERM, "it"),
        ("assess", signal.SIGKILL, "it"),
    ],
    ids=lambda value: getattr(value, "name", value),
)
def test_what_is_interrupted_leaves_neither_files_nor_workers(tmp_path, what, how, whom):
    (tmp_path / "my.yaml").write_text(CASE_1, encoding="utf-8")
    started = subprocess.Popen(
        [*COMMAND, what, "my.yaml", "--jobs", "2"],
        cwd=tmp_path,
        env=ENVIRONMENT,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    process = psutil.Process(started.pid)
    while not (below := workers(process)):
        assert started.poll() is None
        time.sleep(0.1)
    # Into their work: while Python starts in one of them it would complain by itself.
    starting = [child for child in below if "LokyProcess" in " ".join(child.cmdline())]
    for _ in range(300):
        if all(child.cpu_times().user > 1.0 for child in starting):
            break
        time.sleep(0.1)
    time.sleep(1.0)
    if whom == "group":
        os.killpg(started.pid, how)
    else:
        os.kill(started.pid, how)
    told = started.communicate(timeout=60)[1]
    _gone, alive = psutil.wait_procs(below, timeout=30)
    assert not alive
    if how == signal.SIGKILL:
        return
    assert started.returncode == 130
    assert told.splitlines()[-1] == "Interrupted: nothing was left half-written."
    assert "Traceback" not in told
    assert [path.name for path in tmp_path.iterdir()] == ["my.yaml"]


# --- the notebook, which shows the same --------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.takes(30)
def test_the_notebook_shows_every_section_of_the_page(tmp_path):
    notebook = nbformat.read(ROOT / "notebooks" / "your_drive.ipynb", as_version=4)
    headings = [c.source.removeprefix("## ") for c in notebook.cells if c.source.startswith("## ")]
    assert [heading.splitlines()[0] for heading in headings] == [
        *(title for title, _ in sections.SECTIONS),
        "Files",
        "Check",
    ]
    shutil.copy(ROOT / "data" / "drives" / "example_b.yaml", tmp_path / "my_drive.yaml")
    command = [sys.executable, "-m", "papermill", str(ROOT / "notebooks" / "your_drive.ipynb"), "out.ipynb"]
    values = {
        "drive_file": "my_drive.yaml",
        "cells": 4,
        "most_steps": 1,
        "jobs": 1,
        "build_directory": "build",
    }
    command += [word for name, value in values.items() for word in ("-p", name, str(value))]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path, env=ENVIRONMENT)
    assert done.returncode == 0, done.stderr
    outputs = [
        output
        for cell in nbformat.read(tmp_path / "out.ipynb", as_version=4).cells
        for output in cell.get("outputs", [])
        if output.output_type != "stream"
    ]
    shown = " ".join(str(form) for output in outputs for form in output.get("data", {}).values())
    assert "could not be computed" not in shown
    assert shown.count("data:image/svg+xml") == 6
    assert "There is no reference for this file." in shown
    assert (tmp_path / "build" / "drives" / "my_drive" / "tooth_mm.stl").is_file()


@pytest.mark.parametrize(("command", "name"), [("report", "summary.csv"), ("assess", "models.csv")])
def test_a_folder_with_files_of_others_is_refused_before_anything_is_computed(
    command, name, tmp_path, capsys
):
    (tmp_path / name).write_text("mine", encoding="utf-8")
    file = str(ROOT / "data" / "drives" / "case_1.yaml")
    assert main([command, file, "--output", str(tmp_path)]) == 2
    said = capsys.readouterr().err
    assert said.startswith("facegear: error: --output must be a folder")
    assert f"{name} is there and would be replaced" in said
    assert (tmp_path / name).read_text(encoding="utf-8") == "mine"


@pytest.mark.parametrize("command", ["report", "assess"])
def test_a_folder_that_cannot_be_made_is_refused_before_anything_is_computed(
    command, tmp_path, capsys, monkeypatch
):
    def refuses(*_, **__):
        raise PermissionError(errno.EACCES, "Permission denied")

    monkeypatch.setattr("tempfile.TemporaryDirectory", refuses)
    file = str(ROOT / "data" / "drives" / "case_1.yaml")
    assert main([command, file, "--output", str(tmp_path / "new")]) == 2
    said = capsys.readouterr().err
    assert "--output must be a folder that can be written to" in said
    assert "Permission denied" in said
