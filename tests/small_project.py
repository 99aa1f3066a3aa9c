"""A small project with this one's tools and settings, for tests of what a build does."""

import os
import shutil
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

import nbformat

ROOT = Path(__file__).resolve().parents[1]
CONTENTS = "sections: []\ntables: []\nfigures: []\n"


def write_notebook(path: Path, *cells: str) -> Path:
    notebook = nbformat.v4.new_notebook()
    notebook.metadata.kernelspec = {"display_name": "Python 3", "language": "python", "name": "python3"}
    notebook.cells = [nbformat.v4.new_markdown_cell(f"# {path.stem}")]
    notebook.cells += [nbformat.v4.new_code_cell(source) for source in cells]
    path.parent.mkdir(parents=True, exist_ok=True)
    nbformat.write(notebook, path)
    return path


def laid_out(folder: Path) -> Path:
    """Lay out a project with this one's tools and settings, two small notebooks and one page."""
    folder.mkdir(exist_ok=True)
    for name in ("dodo.py", "_config.yml", "CITATION.cff"):
        shutil.copy(ROOT / name, folder)
    (folder / "uv.lock").write_text("", encoding="utf-8")
    shutil.copytree(ROOT / "tools", folder / "tools")
    (folder / "facegear").mkdir()
    (folder / "facegear" / "module.py").write_text("from facegear import other\n", encoding="utf-8")
    (folder / "facegear" / "other.py").write_text("a = 1\n", encoding="utf-8")
    (folder / "data").mkdir()
    (folder / "data" / "contents.yaml").write_text(CONTENTS, encoding="utf-8")
    book = folder / "book"
    shutil.copytree(ROOT / "book" / "_assets", book / "_assets", ignore=shutil.ignore_patterns("vendor"))
    shutil.copytree(ROOT / "book" / "inventories", book / "inventories")
    (book / "references.bib").write_text("", encoding="utf-8")
    (book / "intro.md").write_text("# Page\n", encoding="utf-8")
    (book / "_toc.yml").write_text(
        "format: jb-book\nroot: intro\nchapters:\n- file: notebooks/03_one\n- file: notebooks/04_two\n",
        encoding="utf-8",
    )
    write_notebook(folder / "notebooks" / "03_one.ipynb", "print(1)")
    # It runs with the package of this project, and depends on what the small one has.
    imports = "def never():\n    import facegear.module\n"
    write_notebook(folder / "notebooks" / "04_two.ipynb", f"{imports}\nprint(2)")
    return folder


def build(
    project: Path, *tasks: str, environment: Mapping[str, str] | None = None
) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, str(project / "tools" / "build.py"), *tasks]
    # On GitHub the tests must not see the address of the repository they run in.
    known = {name: value for name, value in os.environ.items() if name != "GITHUB_REPOSITORY"}
    return subprocess.run(
        command,
        capture_output=True,
        text=True,
        check=False,
        cwd=project,
        env=known | dict(environment or {}),
    )


def executed(project: Path) -> dict[str, float]:
    return {path.stem: path.stat().st_mtime for path in (project / "build" / "executed").glob("[!.]*.ipynb")}
