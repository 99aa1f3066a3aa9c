"""The command `facegear`, as a stranger calls it: from any folder, with files that are right and wrong."""

import argparse
import csv
import io
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
import warnings
from pathlib import Path

import nbformat
import psutil
import pytest
import yaml

import facegear
import facegear.__main__
from facegear.drives import command, sections
from facegear.drives.command import main
from facegear.drives.drive_file import read_drive_file
from facegear.drives.drive_schema import schema
from facegear.support.labelled import load
from tests.drives.test_page import HOSTILE, Reader

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = sorted((ROOT / "data" / "drives").glob("*.yaml"))
CASE_1 = (ROOT / "data" / "drives" / "case_1.yaml").read_text(encoding="utf-8")
ENVIRONMENT = os.environ | {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
COMMAND = [sys.executable, "-m", "facegear"]
FORCES = ("force follows the rim", "force keeps its direction")


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def rows(path):
    with path.open(encoding="utf-8-sig") as file:
        return list(csv.DictReader(file))


# --- check, and how to ask --------------------------------------------------------------------------------------


def test_there_are_eight_examples_and_all_can_be_used(capsys):
    assert main(["check", *map(str, EXAMPLES)]) == 0
    told = capsys.readouterr().out.splitlines()
    assert told == [f"{path}: can be used" for path in EXAMPLES]
    assert len(EXAMPLES) == 8


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


def test_one_wrong_file_does_not_keep_the_others_from_being_checked(here, capsys):
    shutil.copy(EXAMPLES[0], here / "right.yaml")
    assert main(["check", "none.yaml", "right.yaml"]) == 1
    out, err = capsys.readouterr()
    assert out == "right.yaml: can be used\n"
    assert "none.yaml' cannot be read" in err


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        ([], "the following arguments are required: COMMAND"),
        (["reprot", "a.yaml"], "invalid choice: 'reprot'"),
        (["report"], "the following arguments are required: FILE"),
        (["report", "a.yaml", "--cells", "0"], "must be at least 1, got 0"),
        (["report", "a.yaml", "--tolerance", "2"], "must be 1e-6 to 0.5, got 2"),
    ],
)
def test_what_cannot_be_understood(arguments, told, capsys):
    with pytest.raises(SystemExit) as caught:
        main(arguments)
    assert caught.value.code == 2
    assert told in capsys.readouterr().err


def test_an_interruption_while_the_command_is_loaded(monkeypatch):
    class Interrupts:
        @staticmethod
        def find_spec(name, *_):
            if name == "facegear.drives.command":
                raise KeyboardInterrupt

    monkeypatch.delitem(sys.modules, "facegear.drives.command")
    monkeypatch.setattr(sys, "meta_path", [Interrupts, *sys.meta_path])
    assert facegear.__main__.main() == 130


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


def test_version(capsys):
    with pytest.raises(SystemExit) as caught:
        main(["--version"])
    assert caught.value.code == 0
    assert capsys.readouterr().out == f"facegear {facegear.__version__}\n"


def test_each_command_has_examples_and_exit_codes(capsys):
    with pytest.raises(SystemExit):
        main(["--help"])
    names = re.findall(r"^    (\w+)  +\w", capsys.readouterr().out, re.MULTILINE)
    assert {"report", "check"} <= set(names)
    for name in names:
        with pytest.raises(SystemExit):
            main([name, "--help"])
        told = capsys.readouterr().out
        assert f"examples:\n  facegear {name}" in told
        assert "exit codes: 0 done, 1 a file cannot be used" in told


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
    command = [*COMMAND, "report", "stable.yaml"]
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
    ("how", "whom"),
    [(signal.SIGINT, "group"), (signal.SIGINT, "it"), (signal.SIGTERM, "it"), (signal.SIGKILL, "it")],
    ids=lambda value: getattr(value, "name", value),
)
def test_a_report_that_is_interrupted_leaves_neither_files_nor_workers(tmp_path, how, whom):
    (tmp_path / "my.yaml").write_text(CASE_1, encoding="utf-8")
    started = subprocess.Popen(
        [*COMMAND, "report", "my.yaml", "--jobs", "2"],
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
    time.sleep(2.0)  # into their work
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


# --- new, map, examples -------------------------------------------------------------------------------------------

FLAGS = [
    "--pinion-teeth",
    "26",
    "--gear-teeth",
    "130",
    "--module-mm",
    "3.175",
    "--thickness-ratio",
    "0.03",
    "--bore-radius-mm",
    "50",
    "--stiffness",
    "1",
    "--damping-us",
    "3",
    "--mass",
    "1",
    "--angles-deg",
    "-10",
    "120",
    "--lowest-speed-rpm",
    "100",
    "--highest-speed-rpm",
    "1000",
    "--power-kW",
    "447",
    "--pinion-speed-rpm",
    "5000",
]


def test_a_new_file_from_flags(here, capsys):
    assert main(["new", "my.yaml", *FLAGS]) == 0
    assert capsys.readouterr().out == "Written: my.yaml. Next: facegear report my.yaml\n"
    file = read_drive_file(here / "my.yaml")
    assert (file.name, file.drive.pinion_teeth, file.drive.module) == ("my", 26, 3.175e-3)
    assert file.transverse.gear.pinion_angles == pytest.approx((-0.174532925, 2.094395102))
    assert "# pressure_angle_deg: 25.0" in (here / "my.yaml").read_text(encoding="utf-8")


def test_a_file_that_is_there_is_not_replaced_unless_told(here, capsys):
    (here / "my.yaml").write_text("mine", encoding="utf-8")
    assert main(["new", "my.yaml", *FLAGS]) == 2
    assert "my.yaml is there already" in capsys.readouterr().err
    assert (here / "my.yaml").read_text(encoding="utf-8") == "mine"
    assert main(["new", "my.yaml", "--replace", *FLAGS]) == 0
    assert read_drive_file(here / "my.yaml").drive.gear_teeth == 130


def test_what_a_new_file_lacks_is_named_by_its_flags(here, capsys, monkeypatch):
    monkeypatch.setattr(sys, "stdin", (here / "nothing").open("w+"))
    assert main(["new", "--pinion-teeth", "26"]) == 2
    err = capsys.readouterr().err
    assert "give --gear-teeth, --module-mm or --diametral-pitch-per-inch, --thickness-ratio," in err
    assert main(["new", *FLAGS, "--gear-teeth", "20"]) == 2
    assert "my_drive.yaml: " in capsys.readouterr().err
    assert not (here / "my_drive.yaml").exists()
    sys.stdin.close()


def test_on_a_terminal_it_asks_until_answers_can_be_used(here, capsys, monkeypatch):
    # A comma, too many teeth for the gear, which turns up only with all the rest, then what is right.
    answers = [
        "26",
        "20",
        "3,175",
        "3.175",
        "0.03",
        "50",
        "1",
        "3",
        "1",
        "100",
        "1000",
        "447",
        "5000",
        "26",
        "130",
    ]
    monkeypatch.setattr(sys.stdin, "isatty", lambda: True, raising=False)
    monkeypatch.setattr(command, "_ask", lambda question: asked.append(question) or answers.pop(0))
    asked = []
    assert main(["new", "my.yaml", "--name", "Mine"]) == 0
    assert not answers
    assert asked[0] == "gears.pinion_teeth: N_1, teeth of the pinion (a whole number from 10 to 300)? "
    err = capsys.readouterr().err
    assert "a point, not a comma: 3.175" in err
    assert "gears.gear_teeth" in err
    assert (read_drive_file("my.yaml").name, read_drive_file("my.yaml").drive.gear_teeth) == ("Mine", 130)


def test_an_end_of_input_leaves_nothing(here, monkeypatch, capsys):
    monkeypatch.setattr(sys, "stdin", io.StringIO("26\n"))
    monkeypatch.setattr(sys.stdin, "isatty", lambda: True, raising=False)
    assert main(["new", "my.yaml"]) == 130
    assert not list(here.iterdir())


def test_a_map_in_three_kinds_of_files(here, capsys):
    (here / "my.yaml").write_text(CASE_1, encoding="utf-8")
    words = [
        "--parameter",
        "thickness_ratio",
        "--from",
        "0.02",
        "--to",
        "0.06",
        "--speeds",
        "500",
        "600",
        "--cells",
        "3",
        "--jobs",
        "1",
    ]
    assert main(["map", "my.yaml", *words]) == 0
    assert capsys.readouterr().out == "".join(f"The map: my_map{end}\n" for end in (".nc", ".csv", ".svg"))
    chart = load(here / "my_map.nc")
    assert chart["thickness_ratio"].values == pytest.approx([0.02, 0.04, 0.06])
    assert len(rows(here / "my_map.csv")) == 9
    assert main(["map", "my.yaml", *words, "--output", "a/b.png"]) == 0
    assert (here / "a" / "b.png").read_bytes()[:4] == b"\x89PNG"


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ("--parameter no_such", "parameter must be one of module_mm"),
        ("--from 2 --to 1", "from and to must ascend"),
        ("--output map.xls", "--output must end in .nc, .csv, .svg, .png, .pdf, got 'map.xls'"),
        ("--contact loaded", "contact must be tregold or geometric"),
    ],
)
def test_a_map_that_there_is_not(here, capsys, words, told):
    (here / "my.yaml").write_text(CASE_1, encoding="utf-8")
    assert main(["map", "my.yaml", *words.split()]) == 2
    assert told in capsys.readouterr().err
    assert [path.name for path in here.iterdir()] == ["my.yaml"]


def test_examples_are_listed_and_printed(capsys):
    assert main(["examples"]) == 0
    assert re.findall(r"^\w+$", capsys.readouterr().out, re.MULTILINE) == [path.stem for path in EXAMPLES]
    assert main(["examples", "case_1"]) == 0
    assert capsys.readouterr().out == CASE_1
    assert main(["examples", "--schema"]) == 0
    assert json.loads(capsys.readouterr().out) == schema()
