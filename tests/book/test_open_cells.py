"""A stranger copies the code that lies open on a chapter's page, from its first cell on: it runs and draws."""

import ast
import contextlib
import io
import re
from pathlib import Path

import matplotlib as mpl
import matplotlib.pyplot as plt
import pytest
from IPython.display import display

from tests.book.open_cells import code_cells, is_open, needed, python

ROOT = Path(__file__).resolve().parents[2]
LONGEST = 12  # lines of an open cell that a reader still takes in at once
WIDEST = 86  # characters of a line that the column of a page has room for at 1280 pixels (book.css)
CHAPTERS = sorted((ROOT / "notebooks").glob("[0o]*.ipynb"))  # and the page on systems of one's own

chapters = pytest.mark.parametrize("path", CHAPTERS, ids=lambda path: path.stem)
every_notebook = pytest.mark.parametrize(
    "path", sorted((ROOT / "notebooks").glob("*.ipynb")), ids=lambda path: path.stem
)


@pytest.mark.parametrize(
    ("source", "needs", "defines"),
    [
        ("import numpy as np\nx = np.sin(y)", {"y"}, {"np", "x"}),
        ("x = x + 1", {"x"}, {"x"}),
        ("x += 1", {"x"}, {"x"}),
        ("a = [k for k in rows]\nfor k in a:\n    b = k", {"rows"}, {"a", "k", "b"}),
        ("def f(t):\n    return f(t) + g(t)", {"g"}, {"f"}),
        ("def f():\n    return late\nlate = 1", {"late"}, {"f", "late"}),
        ("%matplotlib inline\nprint(len(z))", {"z"}, set()),
    ],
)
def test_names_are_told_that_a_cell_needs(source, needs, defines):
    found = needed(source)
    assert found[0] == needs
    assert defines <= found[1]


@every_notebook
def test_open_cells_need_nothing_that_is_folded(path):
    defined = set()
    for cell in code_cells(path):
        if is_open(cell):
            needs, defines = needed(cell.source)
            assert needs <= defined, cell.source
            defined |= defines


@every_notebook
def test_open_cells_take_nothing_from_the_books_own_code(path):
    for cell in filter(is_open, code_cells(path)):
        for node in ast.walk(ast.parse(python(cell.source))):
            names = [node.module] if isinstance(node, ast.ImportFrom) else []
            names += [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            assert not [name for name in names if name.split(".")[0] in ("compendium", "myst_nb")], (
                cell.source
            )


@every_notebook
def test_open_cells_are_short(path):
    too_long = {
        cell.id: lines
        for cell in filter(is_open, code_cells(path))
        if "parameters" not in cell.metadata.get("tags", [])
        if (lines := sum(1 for line in cell.source.splitlines() if line.strip())) > LONGEST
    }
    assert not too_long


@chapters
def test_lines_of_open_cells_fit_the_column_of_the_page(path):
    lines = [line for cell in filter(is_open, code_cells(path)) for line in cell.source.splitlines()]
    assert [line for line in lines if len(line) > WIDEST] == []


def on_a_coarse_grid(cell):
    """Make every axis of more than four values one of four, and no count of values larger that a run may change."""

    def smaller(found):
        return f"{found[1]}{min(int(found[2]), 4)}"

    source = re.sub(r"(np\.linspace\([^()]*, )(\d+)(?=\))", smaller, cell.source)
    if "parameters" in cell.metadata.get("tags", []):
        source = re.sub(
            r"^((?!\w*teeth)\w+(?:, \w+)* = (?:\d+, )*\(?\s*)(\d+)(?![\d.])",
            smaller,
            source,
            flags=re.MULTILINE,
        )
    return source


@pytest.mark.slow
@chapters
def test_open_cells_run_as_a_script_and_draw(path, monkeypatch):
    monkeypatch.chdir(path.parent)
    mpl.use("Agg")
    plt.close("all")
    names = {"display": display, "__name__": "__main__"}
    for cell in filter(is_open, code_cells(path)):
        with contextlib.redirect_stdout(io.StringIO()):
            exec(compile(python(on_a_coarse_grid(cell)), path.name, "exec"), names)
    drawn = plt.get_fignums()
    plt.close("all")
    assert drawn
