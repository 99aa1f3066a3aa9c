"""What stops a build, and what it then says; what is done again, and what is not."""

import contextlib
import json
import os
import shutil
import signal
import sqlite3
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import nbformat
import numpy as np
import psutil
import pytest

from tests.small_project import ROOT, build, executed, laid_out, write_notebook

RUN = [sys.executable, str(ROOT / "tools" / "run_notebook.py")]

FIGURE = """
import xarray as xr
from compendium.checks import check_figures
from facegear.support.labelled import variable
arrays = xr.Dataset({{"y": variable("x", [1.0, {value}], "height", "m", atol=1e-9)}}, {{"x": [0.0, 1.0]}})
check_figures({{"figure_tiny": arrays}}, "{data}", "{build}")
"""
ANCHOR = (
    "figure: figure_tiny\nroute: by hand\nanchors:\n- {variable: y, at: {x: 1.0}, value: 2.0, atol: 1.0e-6}\n"
)


def run(notebook: Path) -> subprocess.CompletedProcess[str]:
    folder = notebook.parent
    command = [
        *RUN,
        str(notebook),
        str(folder / "executed" / notebook.name),
        "--failed",
        str(folder / "failed"),
    ]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def test_notebook_that_runs_appears_whole(tmp_path: Path) -> None:
    done = run(write_notebook(tmp_path / "tiny.ipynb", "a = 2", "print(a + 2)"))
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines() == ["cell 1 of 2", "cell 2 of 2"]
    assert [path.name for path in (tmp_path / "executed").iterdir()] == ["tiny.ipynb"]
    executed = nbformat.read(tmp_path / "executed" / "tiny.ipynb", as_version=4)
    assert executed.cells[2].outputs[0].text == "4\n"
    assert str(tmp_path) not in str(executed)
    assert not list((tmp_path / "failed").iterdir())


@pytest.mark.slow
def test_controls_are_off_where_nobody_can_turn_them(tmp_path: Path) -> None:
    notebook = write_notebook(tmp_path / "tiny.ipynb", "live_controls = True", "print(live_controls)")
    content = nbformat.read(notebook, as_version=4)
    content.cells[1].metadata["tags"] = ["parameters"]
    nbformat.write(content, notebook)
    done = run(notebook)
    assert done.stdout.splitlines() == ["cell 1 of 2", "cell 2 of 2"], done.stderr
    executed = nbformat.read(tmp_path / "executed" / "tiny.ipynb", as_version=4)
    assert executed.cells[-1].outputs[0].text == "False\n"
    assert "remove-cell" in executed.cells[-2].metadata["tags"]


@pytest.mark.slow
def test_failing_cell_stops_with_one_line_and_leaves_the_notebook(tmp_path: Path) -> None:
    done = run(write_notebook(tmp_path / "tiny.ipynb", "a = 2", "a / 0", "print('never')"))
    kept = tmp_path / "failed" / "tiny.ipynb"
    assert done.returncode == 1
    line = done.stderr.strip().splitlines()[-1]
    assert line == f"tiny.ipynb, cell [2]: ZeroDivisionError: division by zero (open {kept})"
    assert not list((tmp_path / "executed").iterdir())
    outputs = [
        output for cell in nbformat.read(kept, as_version=4).cells for output in cell.get("outputs", [])
    ]
    assert [output.ename for output in outputs if output.output_type == "error"] == ["ZeroDivisionError"]


def test_kernel_that_dies_stops_with_one_line(tmp_path: Path) -> None:
    done = run(write_notebook(tmp_path / "tiny.ipynb", "a = 2", "import os, signal\nos.kill(os.getpid(), 9)"))
    assert done.returncode == 1
    line = done.stderr.strip().splitlines()[-1]
    assert line == f"tiny.ipynb, code cell 2: the kernel died (open {tmp_path / 'failed' / 'tiny.ipynb'})"
    assert not list((tmp_path / "executed").iterdir())


@pytest.fixture
def checked(tmp_path: Path) -> Callable[[float], subprocess.CompletedProcess[str]]:
    """Run a notebook that computes `value` and checks it, against what `tmp_path/data` holds."""
    (tmp_path / "data" / "anchors").mkdir(parents=True)
    (tmp_path / "data" / "anchors" / "figure_tiny.yaml").write_text(ANCHOR, encoding="utf-8")

    def compute(value: float) -> subprocess.CompletedProcess[str]:
        source = FIGURE.format(value=value, data=tmp_path / "data", build=tmp_path / "build")
        return run(write_notebook(tmp_path / "tiny.ipynb", source))

    return compute


@pytest.mark.slow
@pytest.mark.takes(25)
def test_missing_reference_wrong_array_and_damaged_reference_stop(
    tmp_path: Path, checked: Callable[[float], subprocess.CompletedProcess[str]]
) -> None:
    computed = tmp_path / "build" / "arrays" / "figure_tiny.nc"
    stored = tmp_path / "data" / "reference" / "figure_tiny.nc"

    done = checked(2.0)
    line = done.stderr.strip().splitlines()[-1]
    assert done.returncode == 1
    assert line.startswith("tiny.ipynb, cell [1]: ReferenceCheckError: array file figure_tiny.nc is missing")
    assert computed.exists()

    stored.parent.mkdir()
    shutil.copyfile(computed, stored)
    assert checked(2.0).returncode == 0

    done = checked(2.0000001)
    line = done.stderr.strip().splitlines()[-1]
    assert done.returncode == 1
    assert "ReferenceCheckError: figure_tiny: 1 of 2 arrays disagree" in line
    assert line.endswith(f"(open {tmp_path / 'failed' / 'tiny.ipynb'})")

    stored.write_bytes(stored.read_bytes()[:-9])
    done = checked(2.0)
    assert done.returncode == 1
    assert "ReferenceCheckError: array file figure_tiny.nc" in done.stderr.strip().splitlines()[-1]


@pytest.mark.slow
def test_notebook_ends_with_the_build_that_started_it(tmp_path: Path) -> None:
    notebook = write_notebook(
        tmp_path / "tiny.ipynb",
        "from pathlib import Path\nPath('started').touch()",
        "import time\ntime.sleep(600)",
    )
    command = [*RUN, str(notebook), str(tmp_path / "executed" / "tiny.ipynb")]
    command += ["--failed", str(tmp_path / "failed"), "--end-with-parent"]
    with (tmp_path / "log").open("w") as log:
        process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=log, stderr=log)
    while not (tmp_path / "started").exists():
        assert process.poll() is None, (tmp_path / "log").read_text()
        time.sleep(0.05)
    kernels = psutil.Process(process.pid).children(recursive=True)
    assert kernels
    process.stdin.close()
    assert process.wait(timeout=120) == 1
    _gone, alive = psutil.wait_procs(kernels, timeout=120)
    assert not alive
    assert not (tmp_path / "executed" / "tiny.ipynb").exists()

    write_notebook(notebook, "a = 1")
    assert run(notebook).returncode == 0
    assert [path.name for path in (tmp_path / "executed").iterdir()] == ["tiny.ipynb"]


def test_second_build_waits_for_the_first(tmp_path: Path) -> None:
    hold = (
        "import sys; from pathlib import Path; from tools.lock import one_at_a_time\n"
        f"with one_at_a_time(Path({str(tmp_path / '.lock')!r})):\n"
        "    print('in', flush=True); sys.stdin.read()\n"
    )

    def start() -> subprocess.Popen[str]:
        return subprocess.Popen(
            [sys.executable, "-c", hold],
            cwd=ROOT,
            text=True,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
        )

    with start() as first:
        assert first.stdout.readline() == "in\n"
        with start() as second:
            assert "waiting" in second.stderr.readline()
            second.stdin.close()
            first.send_signal(signal.SIGKILL)  # the lock is free however its holder ends
            assert second.stdout.readline() == "in\n"
            assert second.wait(timeout=120) == 0


@pytest.fixture
def project(tmp_path: Path) -> Path:
    return laid_out(tmp_path)


def inputs_of(project: Path, *notebooks: str) -> list[set[str]]:
    """Names of the data files that notebooks depend on."""
    script = (
        "import json, sys, dodo; from pathlib import Path\n"
        "print(json.dumps([[path.name for path in dodo.inputs(Path(name))] for name in sys.argv[1:]]))"
    )
    command = [sys.executable, "-c", script, *notebooks]
    done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=project)
    return [set(names) for names in json.loads(done.stdout)]


def test_a_drive_file_is_read_by_the_report_on_a_drive_alone(project: Path) -> None:
    data = project / "data"
    for name in ("drives/case_4.yaml", "reference/ch04_map.nc", "reference/drive_tongues.nc", "plain.yaml"):
        (data / name).parent.mkdir(exist_ok=True)
        (data / name).write_text("", encoding="utf-8")
    write_notebook(project / "notebooks" / "your_drive.ipynb", "print(3)")
    chapter, ledger, report = inputs_of(project, "04_two.ipynb", "90_ledger.ipynb", "your_drive.ipynb")
    assert chapter == {"ch04_map.nc"}
    assert ledger >= {"ch04_map.nc", "drive_tongues.nc", "plain.yaml"}
    assert "case_4.yaml" not in ledger
    assert report == {"case_4.yaml", "drive_tongues.nc"}


@pytest.mark.slow
def test_the_longest_notebooks_are_started_first() -> None:
    script = "import json, dodo; print(json.dumps([dodo.LONGEST, dodo.task_book()['task_dep']]))"
    command = [sys.executable, "-c", script]
    done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT)
    longest, order = json.loads(done.stdout)
    names = [path.stem for path in (ROOT / "notebooks").glob("*.ipynb")]
    assert {name.removeprefix("notebook:") for name in order[: len(longest)]} == set(longest) <= set(names)
    assert sorted(order) == sorted(f"notebook:{name}" for name in names)


@pytest.mark.slow
def test_failing_notebook_stops_the_book_and_keeps_the_others(project: Path) -> None:
    write_notebook(project / "notebooks" / "03_one.ipynb", "raise RuntimeError('on purpose')")
    done = build(project)
    assert done.returncode != 0
    (line,) = [line for line in done.stderr.splitlines() if line.startswith("FAILED")]
    kept = project / "build" / "failed" / "03_one.ipynb"
    assert line == f"FAILED 03_one.ipynb, cell [1]: RuntimeError: on purpose (open {kept})"
    assert kept.exists()
    assert set(executed(project)) == {"04_two"}
    assert not (project / "build" / "_build").exists()


@pytest.mark.slow
@pytest.mark.takes(15)
@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT], ids=lambda how: how.name)
def test_build_that_is_ended_goes_on_where_it_was(project: Path, how: signal.Signals) -> None:
    started = project / "notebooks" / "started"
    write_notebook(
        project / "notebooks" / "04_two.ipynb",
        "from pathlib import Path\nimport time\nif not Path('started').exists():\n"
        "    Path('started').touch()\n    time.sleep(600)",
    )
    with (project / "log").open("w") as log:
        process = subprocess.Popen(
            [sys.executable, str(project / "tools" / "build.py"), "notebook"],
            cwd=project,
            stdout=log,
            stderr=log,
        )
    while not (started.exists() and "03_one" in executed(project) and is_on_record(project, "03_one")):
        assert process.poll() is None, told(project)
        time.sleep(0.05)
    below = psutil.Process(process.pid).children(recursive=True)
    os.kill(process.pid, how)
    assert process.wait(timeout=120) != 0
    _gone, alive = psutil.wait_procs(below, timeout=120)
    assert not alive

    times = executed(project)
    assert set(times) == {"03_one"}
    done = build(project, "notebook")
    assert done.returncode == 0, done.stderr
    assert executed(project)["03_one"] == times["03_one"]
    assert "04_two" in executed(project)


ARRAYS = """
import time
import numpy as np
import xarray as xr
from pathlib import Path
from facegear.support.labelled import save, variable
time.sleep(0.4)
values = np.cumsum(np.random.default_rng({seed}).random(1000))
save(xr.Dataset({{"y": variable("x", values, "height", "m", atol=1e-9)}}), "../build/arrays/{name}.nc")
with Path("../runs.txt").open("a") as record:
    record.write("{name}\\n")
"""


@pytest.fixture
def arrays(project: Path) -> Callable[[], dict[str, bytes]]:
    """Give both notebooks three arrays to compute, and return what reads them."""
    for number, name in enumerate(("03_one", "04_two")):
        cells = [ARRAYS.format(seed=10 * number + k, name=f"ch{name[:2]}_{k}") for k in range(3)]
        write_notebook(project / "notebooks" / f"{name}.ipynb", *cells)

    def read() -> dict[str, bytes]:
        return {path.name: path.read_bytes() for path in sorted((project / "build" / "arrays").iterdir())}

    return read


def start(project: Path) -> subprocess.Popen[str]:
    with (project / "log").open("a") as log:
        command = [sys.executable, str(project / "tools" / "build.py"), "notebook"]
        return subprocess.Popen(command, cwd=project, stdout=log, stderr=log)


@pytest.mark.slow
@pytest.mark.takes(40)
def test_build_killed_at_any_moment_comes_to_the_same_arrays(
    project: Path, arrays: Callable[[], dict[str, bytes]]
) -> None:
    # However fast the machine is, now and at the next build, none comes to its end before it is killed.
    go = project / "go"
    notebook = project / "notebooks" / "04_two.ipynb"
    content = nbformat.read(notebook, as_version=4)
    wait = "while not Path('../go').exists():\n    time.sleep(0.05)"
    content.cells.append(nbformat.v4.new_code_cell(wait))
    nbformat.write(content, notebook)

    go.touch()
    began = time.monotonic()
    assert build(project, "notebook").returncode == 0
    whole = time.monotonic() - began
    expected = arrays()
    assert len(expected) == 6

    shutil.rmtree(project / "build")
    go.unlink()
    for moment in np.random.default_rng(7).uniform(0.1, 0.9, 4):
        process = start(project)
        with pytest.raises(subprocess.TimeoutExpired):
            process.wait(timeout=moment * whole)
        below = psutil.Process(process.pid).children(recursive=True)
        process.kill()
        assert process.wait() == -signal.SIGKILL
        _gone, alive = psutil.wait_procs(below, timeout=120)
        assert not alive
        for name, content in arrays().items() if (project / "build" / "arrays").exists() else ():
            # A file that was being written has a name of its own.
            assert expected.get(name, content) == content

    go.touch()
    assert build(project, "notebook").returncode == 0
    found = arrays()
    assert {name: found[name] for name in expected} == expected
    assert sorted(executed(project)) == ["03_one", "04_two"]


@pytest.mark.slow
@pytest.mark.takes(20)
def test_two_builds_at_once_do_not_disturb_each_other(
    project: Path, arrays: Callable[[], dict[str, bytes]]
) -> None:
    both = [start(project), start(project)]
    assert [process.wait(timeout=300) for process in both] == [0, 0]
    assert "waiting for it to end" in told(project)
    # The one that came second found everything done.
    runs = (project / "runs.txt").read_text(encoding="utf-8").split()
    assert sorted(runs) == sorted(Path(name).stem for name in arrays())
    assert len(runs) == 6
    assert sorted(executed(project)) == ["03_one", "04_two"]


def is_on_record(project: Path, notebook: str) -> bool:
    """Whether all that doit keeps of a finished notebook is written: what it depends on comes last."""
    database = project / "build" / "state.db"
    with contextlib.closing(sqlite3.connect(f"{database.as_uri()}?mode=ro", uri=True)) as connection:
        try:
            query = "select task_data from doit where task_id = ?"
            row = connection.execute(query, (f"notebook:{notebook}",)).fetchone()
        except sqlite3.OperationalError:  # there is no table yet, or it is being written
            return False
    return row is not None and "deps:" in json.loads(row[0])


def told(project: Path) -> str:
    return (project / "log").read_text(encoding="utf-8")


@pytest.mark.slow
@pytest.mark.takes(25)
def test_references_are_made_anew_only_on_demand_and_say_what_moved(project: Path) -> None:
    def compute(value: float) -> None:
        source = 'data_directory = "../data"\nbuild_directory = "../build"'
        check = FIGURE.format(value=value, data="{data_directory}", build="{build_directory}")
        notebook = write_notebook(project / "notebooks" / "03_one.ipynb", source, check)
        content = nbformat.read(notebook, as_version=4)
        content.cells[1].metadata["tags"] = ["parameters"]
        content.cells[2].source = check.replace('"{data_directory}"', "data_directory").replace(
            '"{build_directory}"', "build_directory"
        )
        nbformat.write(content, notebook)

    def update() -> subprocess.CompletedProcess[str]:
        command = [sys.executable, str(project / "tools" / "update_references.py")]
        return subprocess.run(command, capture_output=True, text=True, check=False)

    stored = project / "data" / "reference" / "figure_tiny.nc"
    anchors = project / "data" / "anchors" / "figure_tiny.yaml"
    anchors.parent.mkdir()
    anchors.write_text(ANCHOR, encoding="utf-8")
    (project / "notebooks" / "04_two.ipynb").unlink()

    compute(2.0)
    first = update()
    assert first.returncode == 0, first.stdout + first.stderr
    assert "figure_tiny.nc: new, 2 arrays" in first.stdout

    compute(2.5)
    (project / "data" / "reference" / "figure_old.nc").write_bytes(stored.read_bytes())
    moved = update()
    assert moved.returncode == 0
    assert "figure_tiny.nc: 1 of 2 arrays moved" in moved.stdout
    assert "y: largest change 0.5, relative 0.25, BEYOND tolerance" in moved.stdout
    assert "figure_old.nc: no notebook computes it any more; removed" in moved.stdout
    assert [path.name for path in stored.parent.iterdir()] == ["figure_tiny.nc"]
    # The stored array now agrees, the anchor does not: the book still cannot be built.
    assert "the independent route gives 2" in build(project, "notebook").stderr

    before = stored.read_bytes()
    write_notebook(project / "notebooks" / "02_zero.ipynb", "1 / 0")
    stopped = update()
    assert stopped.returncode == 1
    assert "Nothing was replaced." in stopped.stdout
    assert stored.read_bytes() == before
