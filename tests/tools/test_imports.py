"""What a notebook depends on: all modules that run when it does, and no other."""

from pathlib import Path

import pytest

from tests.small_project import write_notebook
from tools import imports
from tools.imports import ROOT, imported_by

NOTEBOOKS = sorted((ROOT / "notebooks").glob("*.ipynb"))


def dependents(module: str) -> set[str]:
    return {notebook.stem for notebook in NOTEBOOKS if ROOT / module in imported_by(notebook)}


def test_a_label_in_a_drawing_of_chapter_7_reruns_chapter_7_alone():
    assert dependents("book/compendium/plotting/torsional.py") == {"07_torsional"}


def test_the_engine_reruns_every_chapter_that_computes_stability():
    chapters = {"02", "04", "05", "06", "07"}
    found = dependents("facegear/floquet/collocation.py")
    assert found >= {notebook.stem for notebook in NOTEBOOKS if notebook.stem[:2] in chapters}
    assert "03_geometry_and_meshing" not in found


def test_every_module_is_imported_by_a_notebook_a_tool_or_the_command():
    command = ROOT / "facegear" / "__main__.py"
    used = {command, *imported_by(command)}
    used |= {path for notebook in NOTEBOOKS for path in imported_by(notebook)}
    used |= {path for tool in (ROOT / "tools").glob("*.py") for path in imported_by(tool)}
    modules = {path for folder in ("facegear", "book/compendium") for path in (ROOT / folder).rglob("*.py")}
    assert modules - used == set()


@pytest.fixture
def project(tmp_path, monkeypatch):
    monkeypatch.setattr(imports, "PACKAGES", {"facegear": tmp_path, "compendium": tmp_path / "book"})
    imports._direct.cache_clear()
    imports._public.cache_clear()
    for name, text in {
        "facegear/__init__.py": "",
        "facegear/__init__.pyi": "from .floquet.series import Series as Series\n",
        "facegear/floquet/__init__.py": "",
        "facegear/floquet/series.py": "from facegear.support import checks\n",
        "facegear/floquet/unused.py": "",
        "facegear/support/__init__.py": "",
        "facegear/support/checks.py": "import math\n",
        "book/compendium/__init__.py": "",
        "book/compendium/figures.py": "def draw():\n    import facegear.floquet.series\n",
        "book/compendium/types.py": (
            "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    import facegear.floquet.series\n"
        ),
    }.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    yield tmp_path
    imports._direct.cache_clear()
    imports._public.cache_clear()


SERIES = {"floquet", "floquet/series", "support", "support/checks"}


@pytest.mark.parametrize(
    ("code", "modules", "book"),
    [
        ("import numpy as np", set(), set()),
        ("import facegear as fg\nfg.Series(1)", {"", *SERIES}, set()),
        ("import facegear as fg\nfg.nothing", {""}, set()),
        ("from facegear import Series", {"", *SERIES}, set()),
        ("from facegear.floquet import series as s", {"", *SERIES}, set()),
        ("%matplotlib inline\n!ls\nfrom compendium import figures", {"", *SERIES}, {"", "figures"}),
        ("from compendium.types import *", set(), {"", "types"}),
    ],
)
def test_each_kind_of_import(project, code, modules, book):
    def files(folder: Path, names: set[str]) -> set[Path]:
        packages = {"", "floquet", "support"}
        return {
            folder / name / "__init__.py" if name in packages else folder / f"{name}.py" for name in names
        }

    notebook = write_notebook(project / "notebooks" / "one.ipynb", code)
    expected = files(project / "facegear", modules) | files(project / "book" / "compendium", book)
    assert set(imported_by(notebook)) == expected
