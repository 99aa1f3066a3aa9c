"""The steps of the book, for doit: execute each notebook, then build the pages.

`python tools/build.py` (what `make book` calls) runs them under the lock of this checkout; `doit list --all`
shows them.
"""

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import nbformat
import yaml
from doit.exceptions import TaskFailed

from compendium.contents import ContentsError
from facegear.support.provenance import made_by
from tools.imports import imported_by
from tools.pages import bibtex, figure_index, offer_numbers, put_outputs_in_readers_digits, run_times
from tools.progress import CELLS, BuildReporter
from tools.run_notebook import code_cells

ROOT = Path(__file__).resolve().parent
BUILD = ROOT / "build"
BUILD.mkdir(exist_ok=True)  # doit opens its record there before any step runs
EXECUTED = BUILD / "executed"
SOURCE = BUILD / "book-src"
CODE = ROOT / "book" / "compendium"  # no page of the book
PICTURES = BUILD / "pictures"
PAGES = BUILD / "_build"
PDF = BUILD / "facegear.pdf"

DOIT_CONFIG = {
    "default_tasks": ["book"],
    "reporter": BuildReporter,
    "backend": "sqlite3",
    "dep_file": str(BUILD / "state.db"),
    "num_process": 2,
    "par_type": "thread",  # each thread waits for a process of its own
    "continue": True,  # a notebook that fails does not keep the others from running
}

NOTEBOOKS = sorted((ROOT / "notebooks").glob("*.ipynb"))
CHAPTERS = [path.stem for path in NOTEBOOKS if path.stem < "90"]
# Started first, the longest before the others, so that two processors end at about the same time.
LONGEST = (
    "08_transverse",
    "04_design",
    "03_contact_under_load",
    "05_multiple_pinions",
    "04_one_pinion",
    "06_in_plane_force",
    "08_shafts",
    "07_torsional",
    "08_damage",
    "your_drive",
    "08_torsional",
)
IN_ORDER = [
    *(path for stem in LONGEST for path in NOTEBOOKS if path.stem == stem),
    *(path for path in NOTEBOOKS if path.stem not in LONGEST),
]
# Which notebooks read what others leave in `build/`; all others stand alone.
NEEDS = {"90_ledger": CHAPTERS}
# The map on the title page: the notebook that computes it, and its arrays.
MAP_NOTEBOOK, MAP_ARRAYS = "04_one_pinion", "ch04_figure_4_04a.nc"
VIGNETTES = [
    PICTURES / f"vignette_{theme}.svg"
    for theme in ("light", "dark")
    if ROOT / "notebooks" / f"{MAP_NOTEBOOK}.ipynb" in NOTEBOOKS
]

# One thread a process: two notebooks share the machine, and threads slow small matrices down.
ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}
# Each notebook shares its maps out over its half of the processors (joblib's own name for that).
HALF_THE_PROCESSORS = {"LOKY_MAX_CPU_COUNT": str(max(1, (os.cpu_count() or 1) // 2))}
# Modules are compiled once and kept, whatever the caller's shell says; else each notebook would compile them anew.
COMPILED_ONCE = {"PYTHONDONTWRITEBYTECODE": ""}


def files(folder: str, pattern: str) -> list[Path]:
    """Return the files below a folder of the project that match a pattern."""
    return sorted(path for path in (ROOT / folder).rglob(pattern) if path.is_file())


def inputs(notebook: Path) -> list[Path]:
    """Return the data files a notebook is checked against: those whose first number is its chapter's.

    A file without a number belongs to no chapter, and a notebook that is not a chapter reads everything. Drive files
    are read by the report on a drive alone, which reads nothing else but references of its own.
    """

    def number(path: Path) -> int | None:
        found = re.search(r"\d+", path.stem)
        return int(found.group()) if found else None

    drives = files("data/drives", "*.yaml")
    if notebook.stem == "your_drive":
        return [*drives, *files("data", "drive_*")]
    chapter = number(notebook)
    everything = notebook.stem not in CHAPTERS
    others = (path for path in files("data", "*.*") if path not in drives)
    return [path for path in others if everything or number(path) == chapter]


def execute_notebook(notebook: Path) -> TaskFailed | None:
    """Run one notebook in a process of its own and follow its cells."""
    name = notebook.stem
    command = [sys.executable, str(ROOT / "tools" / "run_notebook.py"), str(notebook)]
    command += [str(EXECUTED / notebook.name), "--failed", str(BUILD / "failed"), "--end-with-parent"]
    CELLS.start(name)
    log = BUILD / "logs" / f"{name}.txt"
    log.parent.mkdir(parents=True, exist_ok=True)
    with (
        log.open("w", encoding="utf-8") as messages,
        subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=messages,
            text=True,
            env=os.environ | ONE_THREAD | HALF_THE_PROCESSORS | COMPILED_ONCE,
        ) as process,
    ):
        for line in process.stdout:
            if line.startswith("cell "):
                CELLS.advance(name, int(line.split()[1]))
    CELLS.finish(name, "done" if process.returncode == 0 else "stopped")
    if process.returncode == 0:
        return None
    lines = log.read_text(encoding="utf-8").strip().splitlines()
    return TaskFailed(lines[-1] if lines else f"{notebook.name}: ended with code {process.returncode}")


def task_notebook() -> Iterator[dict]:
    """Execute a notebook and check its arrays."""
    for notebook in IN_ORDER:
        before = [EXECUTED / f"{name}.ipynb" for name in NEEDS.get(notebook.stem, [])]
        yield {
            "name": notebook.stem,
            "doc": f"execute notebooks/{notebook.name} and check its arrays",
            "actions": [(execute_notebook, [notebook])],
            "file_dep": [
                notebook,
                *before,
                *imported_by(notebook),
                *inputs(notebook),
                ROOT / "uv.lock",
                ROOT / "tools" / "run_notebook.py",
            ],
            "targets": [EXECUTED / notebook.name],
            "meta": {"notebook": notebook.stem, "cells": len(code_cells(notebook))},
            "io": {"capture": False},
        }


def task_vignette() -> Iterator[dict]:
    """Draw the map of the title page."""
    if VIGNETTES:
        script = ROOT / "tools" / "draw_vignette.py"
        yield {
            "name": MAP_NOTEBOOK,
            "doc": "draw the map of the title page",
            "actions": [[sys.executable, str(script), str(BUILD / "arrays" / MAP_ARRAYS), str(PICTURES)]],
            "file_dep": [
                EXECUTED / f"{MAP_NOTEBOOK}.ipynb",
                script,
                *imported_by(script),
            ],
            "targets": VIGNETTES,
        }


def stage() -> TaskFailed | None:
    """Lay out the source folder of the book: pages, executed notebooks, pictures, files for download."""
    shutil.rmtree(SOURCE, ignore_errors=True)
    shutil.copytree(ROOT / "book", SOURCE, ignore=shutil.ignore_patterns("compendium"))
    (SOURCE / "notebooks").mkdir()
    stored = {path.stem for path in files("data/reference", "*.nc")}
    for notebook in NOTEBOOKS:
        content = nbformat.read(EXECUTED / notebook.name, as_version=4)
        for cell in content.cells:
            offer_numbers(cell, stored)
            put_outputs_in_readers_digits(cell)
        for output in (output for cell in content.cells for output in cell.get("outputs", [])):
            # Meant for JupyterLab; Sphinx would warn of it. The same output carries HTML for the pages.
            output.get("data", {}).pop("application/vnd.plotly.v1+json", None)
        nbformat.write(content, SOURCE / "notebooks" / notebook.name)
    (SOURCE / "data").mkdir()
    for array in files("data/reference", "*.nc"):
        shutil.copy2(array, SOURCE / "data")
    if (BUILD / "ledger.csv").exists():
        shutil.copy2(BUILD / "ledger.csv", SOURCE / "data")
    if PICTURES.exists():
        shutil.copytree(PICTURES, SOURCE / "pictures")
    executed = [EXECUTED / notebook.name for notebook in NOTEBOOKS]
    try:
        pages = {
            "figures.md": figure_index(ROOT / "data" / "contents.yaml", NOTEBOOKS),
            "run_times.md": run_times(executed),
            "citation.bib": bibtex(ROOT / "CITATION.cff"),
        }
    except (ValueError, ContentsError) as problem:
        return TaskFailed(str(problem))
    for name, text in pages.items():
        (SOURCE / name).write_text(text, encoding="utf-8")
    return None


def write_config() -> Path:
    """Write the configuration of the book: what made it at the foot, buttons where the repository's address is known.

    A workflow on GitHub knows the address; in anybody's clone a button would lead nowhere.
    """
    config = yaml.safe_load((ROOT / "_config.yml").read_text(encoding="utf-8"))
    made = made_by()
    commit = f", commit {made['facegear_commit']}" if "facegear_commit" in made else ""
    config["html"]["extra_footer"] = f"Made by facegear {made['facegear_version']}{commit}."
    repository = os.environ.get("GITHUB_REPOSITORY")
    if repository:
        config["repository"] = {"url": f"https://github.com/{repository}", "branch": "main"}
        config["launch_buttons"] = {
            "notebook_interface": "jupyterlab",
            "binderhub_url": "https://mybinder.org",
            "thebe": False,
        }
        config["html"] |= {"use_repository_button": True, "use_issues_button": True}
    path = BUILD / "config.yml"
    path.write_text(yaml.safe_dump(config, sort_keys=False), encoding="utf-8")
    return path


def run_sphinx(*options: str) -> TaskFailed | None:
    """Build pages; any warning of Sphinx is a failure."""
    command = [sys.executable, str(ROOT / "tools" / "build_pages.py"), "build", str(SOURCE)]
    command += ["--config", str(write_config()), "--path-output", str(BUILD)]
    command += [*options, "-W", "-n", "--keep-going"]
    log = BUILD / "logs" / "sphinx.txt"
    log.parent.mkdir(parents=True, exist_ok=True)
    with log.open("w", encoding="utf-8") as messages:
        done = subprocess.run(
            command,
            stdout=messages,
            stderr=subprocess.STDOUT,
            env=os.environ | ONE_THREAD,
            check=False,
        )
    # Jupyter Book colours what it writes, terminal or not.
    report = re.sub(r"\x1b\[[\d;]*m", "", log.read_text(encoding="utf-8"))
    log.write_text(report, encoding="utf-8")
    if done.returncode == 0:
        return None
    marks = ("WARNING:", "ERROR:", "CRITICAL:")
    lines = [line for line in report.splitlines() if any(mark in line for mark in marks)]
    first = lines[0].replace(str(SOURCE) + os.sep, "") if lines else "jupyter-book stopped"
    return TaskFailed(f"{first} ({len(lines)} such lines in {log})")


def build_pages() -> TaskFailed | None:
    """Build the pages of the book."""
    # From scratch, because Sphinx repeats a warning only for pages it reads anew: after a failed run the
    # next one would pass.
    shutil.rmtree(PAGES, ignore_errors=True)
    return run_sphinx()


def print_pages() -> TaskFailed | None:
    """Build the book as one page, of the sources as they were read for the pages, and print that."""
    folder = PAGES / "singlehtml"
    shutil.rmtree(folder, ignore_errors=True)
    problem = run_sphinx("--builder", "singlehtml")
    if problem is not None:
        return problem
    page = folder / "intro.html"
    command = [sys.executable, str(ROOT / "tools" / "print_book.py"), str(page), str(PDF)]
    done = subprocess.run(command, stderr=subprocess.PIPE, text=True, check=False)
    return None if done.returncode == 0 else TaskFailed(done.stderr.strip() or "the book was not printed")


def task_book() -> dict:
    """Lay the pages out and build the book."""
    return {
        "actions": [stage, build_pages],
        # The files below would do, but doit keeps those in no order.
        "task_dep": [f"notebook:{notebook.stem}" for notebook in IN_ORDER],
        "file_dep": [
            *(EXECUTED / notebook.name for notebook in NOTEBOOKS),
            *(path for path in files("book", "*") if CODE not in path.parents),
            *files("facegear", "*.py"),  # their docstrings are a page
            *files("data/reference", "*.nc"),
            *VIGNETTES,
            ROOT / "data" / "contents.yaml",
            ROOT / "tools" / "pages.py",
            ROOT / "tools" / "public_names.py",
            ROOT / "tools" / "figure_letters.py",
            ROOT / "tools" / "unbroken.py",
            ROOT / "tools" / "without_thebe.py",
            ROOT / "CITATION.cff",
            ROOT / "_config.yml",
            ROOT / "uv.lock",
        ],
        "targets": [PAGES / "html" / "index.html"],
        "io": {"capture": False},
    }


def task_pdf() -> dict:
    """Print the book, all of it in one file."""
    return {
        "actions": [print_pages],
        "file_dep": [PAGES / "html" / "index.html", ROOT / "tools" / "print_book.py"],
        "targets": [PDF],
        "io": {"capture": False},
    }
