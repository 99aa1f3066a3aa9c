"""What every committed notebook has in common."""

import re
import subprocess
import sys
from pathlib import Path

import nbformat
import pytest
import yaml

ROOT = Path(__file__).resolve().parents[2]
NOTEBOOKS = sorted((ROOT / "notebooks").glob("*.ipynb"))
CHAPTERS = [path for path in NOTEBOOKS if re.match(r"0\d_", path.stem)]
# Paths of somebody's machine: a root folder people keep files in, or a drive letter.
MACHINE_PATH = re.compile(r"(?<![\w.:/-])/(home|Users|root|tmp|work|mnt|opt|var)/\w|\b[A-Z]:\\{1,2}\w")

notebooks = pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)


def code(path: Path) -> list[nbformat.NotebookNode]:
    return [cell for cell in nbformat.read(path, as_version=4).cells if cell.cell_type == "code"]


def test_there_are_notebooks() -> None:
    assert NOTEBOOKS


@notebooks
def test_notebook_is_valid(path: Path) -> None:
    nbformat.validate(nbformat.read(path, as_version=4))


def test_notebooks_are_stripped() -> None:
    extra = "metadata.papermill metadata.widgets cell.metadata.papermill cell.metadata.execution"
    command = [sys.executable, "-m", "nbstripout", "--verify", "--keep-id", "--extra-keys", extra]
    done = subprocess.run([*command, *map(str, NOTEBOOKS)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    for path in NOTEBOOKS:
        assert all(not cell.outputs and cell.execution_count is None for cell in code(path)), path.name


@notebooks
def test_first_code_cell_holds_the_parameters(path: Path) -> None:
    first, *rest = code(path)
    assert "parameters" in first.metadata.get("tags", [])
    assert 'data_directory = "../data"' in first.source
    assert 'build_directory = "../build"' in first.source
    assert not any("parameters" in cell.metadata.get("tags", []) for cell in rest)


@pytest.mark.parametrize("path", CHAPTERS, ids=lambda path: path.stem)
def test_a_chapter_compares_its_values_and_ends_with_the_check_of_its_figures(path: Path) -> None:
    *before, last = (cell.source for cell in code(path))
    assert last == "chapter.finish()"
    assert [source.splitlines()[-1] for source in before].count("chapter.ledger()") == 1


@pytest.mark.book
def test_every_stored_figure_was_computed_by_the_build() -> None:
    """A figure that a chapter has stopped handing in: noticed after a build that began with nothing."""
    stored, computed = (
        {path.stem for path in (ROOT / folder).glob("*.nc")} for folder in ("data/reference", "build/arrays")
    )
    assert stored - computed == set()


@notebooks
def test_it_opens_with_a_title_and_what_the_reader_will_know_after_it(path: Path) -> None:
    first, second = nbformat.read(path, as_version=4).cells[:2]
    assert first.cell_type == "markdown"
    assert re.match(r"(\([\w-]+\)=\n)?# \S", first.source)
    opening = first.source + (second.source if second.cell_type == "markdown" else "")
    assert re.search(r"\bobjectives?\b", opening, re.IGNORECASE)


@notebooks
def test_no_path_of_a_machine(path: Path) -> None:
    found = [match.group() for match in MACHINE_PATH.finditer(path.read_text(encoding="utf-8"))]
    assert not found


def test_path_pattern_finds_paths() -> None:
    assert MACHINE_PATH.search('open("/home/someone/data.nc")')
    assert MACHINE_PATH.search(r'open("C:\\data.nc")')
    assert not MACHINE_PATH.search("https://example.org/home/page and ../data and a/b and 1/var")


def test_the_table_of_contents_names_every_notebook() -> None:
    contents = yaml.safe_load((ROOT / "book" / "_toc.yml").read_text(encoding="utf-8"))
    named = {
        chapter["file"].removeprefix("notebooks/")
        for part in contents["parts"]
        for chapter in part["chapters"]
        if chapter["file"].startswith("notebooks/")
    }
    assert named == {path.stem for path in NOTEBOOKS}
