"""The book of a small project: what a build does again, the buttons on its pages, warnings that stop it."""

import re
import shutil
from html import unescape
from pathlib import Path
from urllib.parse import SplitResult, parse_qs, urlsplit

import pytest

from facegear.support.provenance import made_by
from tests.small_project import build, executed, laid_out, write_notebook

pytestmark = [pytest.mark.slow, pytest.mark.takes(60)]


@pytest.fixture(scope="module")
def first_book(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """Build the small project's book; return the project's folder and a copy of it."""
    folder = tmp_path_factory.mktemp("book")
    project = laid_out(folder / "project")
    done = build(project)
    assert done.returncode == 0, done.stderr
    assert (project / "build" / "_build" / "html" / "index.html").as_uri() in done.stdout
    return project, shutil.copytree(project, folder / "kept")


@pytest.fixture
def built(first_book: tuple[Path, Path]) -> Path:
    """Bring the project back as its first build left it, to the same place: the record of a build names places."""
    project, kept = first_book
    shutil.rmtree(project)
    return shutil.copytree(kept, project)


def test_only_what_changed_is_done_again(built: Path) -> None:
    project, page = built, built / "build" / "_build" / "html" / "notebooks" / "03_one.html"
    times, written = executed(project), page.stat().st_mtime

    again = build(project)
    assert again.returncode == 0
    assert executed(project) == times
    assert page.stat().st_mtime == written

    write_notebook(project / "notebooks" / "03_one.ipynb", "print('other')")
    assert build(project).returncode == 0
    assert executed(project)["03_one"] > times["03_one"]
    assert executed(project)["04_two"] == times["04_two"]
    assert "other" in page.read_text(encoding="utf-8")

    times = executed(project)
    (project / "data" / "ch04.yaml").write_text("new: 1\n", encoding="utf-8")
    assert build(project, "notebook").returncode == 0
    assert executed(project)["03_one"] == times["03_one"]
    assert executed(project)["04_two"] > times["04_two"]

    times = executed(project)
    # What one of the notebooks imports, through another module.
    (project / "facegear" / "other.py").write_text("a = 2\n", encoding="utf-8")
    assert build(project, "notebook").returncode == 0
    assert executed(project)["03_one"] == times["03_one"]
    assert executed(project)["04_two"] > times["04_two"]


def test_the_foot_of_every_page_names_version_and_commit(built: Path) -> None:
    made = made_by()
    commit = f", commit {made['facegear_commit']}" if "facegear_commit" in made else ""
    foot = f"Made by facegear {made['facegear_version']}{commit}."
    html = built / "build" / "_build" / "html"
    for page in ("intro.html", "notebooks/03_one.html", "notebooks/04_two.html"):
        text = re.sub(r"\s+", " ", (html / page).read_text(encoding="utf-8"))
        assert f'<div class="extra_footer"> {foot} </div>' in text, page


def test_buttons_lead_to_files_of_the_repository_where_its_address_is_known(built: Path) -> None:
    """On GitHub the pages have buttons; in anybody's clone they have none."""
    project = built

    def links(page: str) -> list[SplitResult]:
        text = (project / "build" / "_build" / "html" / page).read_text(encoding="utf-8")
        return [urlsplit(unescape(link)) for link in re.findall(r'href="([^"]+)"', text)]

    def elsewhere(page: str) -> list[SplitResult]:
        return [link for link in links(page) if link.netloc in ("mybinder.org", "github.com")]

    assert not elsewhere("notebooks/03_one.html")
    shutil.rmtree(project / "build" / "_build")
    assert build(project, environment={"GITHUB_REPOSITORY": "someone/facegear"}).returncode == 0
    buttons = elsewhere("notebooks/03_one.html")
    (binder,) = [link for link in buttons if link.netloc == "mybinder.org"]
    assert binder.path == "/v2/gh/someone/facegear/main"
    assert parse_qs(binder.query) == {"urlpath": ["lab/tree/notebooks/03_one.ipynb"]}
    assert (project / "notebooks" / "03_one.ipynb").is_file()
    assert "mybinder.org" not in {link.netloc for link in elsewhere("intro.html")}
    on_github = [link.path for link in buttons + elsewhere("intro.html") if link.netloc == "github.com"]
    assert "/someone/facegear" in on_github
    for path in on_github:
        if "/blob/" in path or "/edit/" in path:
            assert (project / re.split("/(?:blob|edit)/main/", path)[1]).is_file(), path


def test_warning_of_sphinx_stops_every_build(built: Path) -> None:
    project, page = built, built / "book" / "intro.md"
    page.write_text("# Page\n\nSee {ref}`nothing-of-this-name`.\n", encoding="utf-8")
    for _ in range(2):
        done = build(project)
        assert done.returncode != 0
        (line,) = [line for line in done.stderr.splitlines() if line.startswith("FAILED")]
        assert line.startswith("FAILED intro.md:3: WARNING: undefined label: 'nothing-of-this-name'")
        assert str(project / "build" / "logs" / "sphinx.txt") in line


def test_warning_printed_by_a_notebook_stops_the_build(built: Path) -> None:
    project = built
    write_notebook(project / "notebooks" / "03_one.ipynb", "import warnings\nwarnings.warn('look')")
    done = build(project)
    assert done.returncode != 0
    (line,) = [line for line in done.stderr.splitlines() if line.startswith("FAILED")]
    assert "notebooks/03_one.ipynb" in line
    assert "stderr" in line
