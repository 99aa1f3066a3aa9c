"""The environment is described in several files; they say the same."""

import re
import tomllib
from pathlib import Path

import pytest
import yaml
from packaging.requirements import Requirement
from packaging.specifiers import SpecifierSet
from packaging.utils import canonicalize_name

ROOT = Path(__file__).resolve().parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
LOCK = tomllib.loads((ROOT / "uv.lock").read_text(encoding="utf-8"))
CONDA = yaml.safe_load((ROOT / "environment.yml").read_text(encoding="utf-8"))
GROUPS = {"": PROJECT["project"]["dependencies"], **PROJECT["dependency-groups"]}
EXTRAS = PROJECT["project"]["optional-dependencies"]


def bounds(requirements: list[str]) -> dict[str, SpecifierSet]:
    parsed = [Requirement(text) for text in requirements]
    return {canonicalize_name(requirement.name): requirement.specifier for requirement in parsed}


def bounds_of(rows: list[dict[str, str]]) -> dict[str, SpecifierSet]:
    return {row["name"]: SpecifierSet(row.get("specifier", "")) for row in rows}


def test_environment_yml_agrees_with_pyproject() -> None:
    conda = bounds([line for line in CONDA["dependencies"] if isinstance(line, str)])
    assert conda.pop("python") == SpecifierSet(PROJECT["project"]["requires-python"])
    assert conda.pop("pip") == SpecifierSet()
    assert conda == bounds(GROUPS[""] + GROUPS["book"])


def test_environment_yml_installs_the_package_itself_and_nothing_else_through_pip() -> None:
    (pip,) = [entry["pip"] for entry in CONDA["dependencies"] if isinstance(entry, dict)]
    assert pip == ["--no-deps --editable ."]


@pytest.mark.parametrize("group", GROUPS)
def test_lock_file_was_made_from_this_pyproject(group: str) -> None:
    (entry,) = [package for package in LOCK["package"] if package["name"] == PROJECT["project"]["name"]]
    metadata = entry["metadata"]
    needed = [row for row in metadata["requires-dist"] if "marker" not in row]
    listed = metadata["requires-dev"][group] if group else needed
    assert bounds_of(listed) == bounds(GROUPS[group])


@pytest.mark.parametrize("extra", EXTRAS)
def test_lock_file_has_the_extras_and_the_book_what_they_bring(extra: str) -> None:
    (entry,) = [package for package in LOCK["package"] if package["name"] == PROJECT["project"]["name"]]
    listed = [row for row in entry["metadata"]["requires-dist"] if row.get("marker") == f"extra == '{extra}'"]
    assert bounds_of(listed) == bounds(EXTRAS[extra])
    assert bounds(EXTRAS[extra]).items() <= bounds(GROUPS["book"]).items()


@pytest.mark.parametrize("group", GROUPS)
def test_locked_versions_are_within_the_bounds(group: str) -> None:
    versions: dict[str, list[str]] = {}
    for package in LOCK["package"]:
        if "version" in package:
            versions.setdefault(package["name"], []).append(package["version"])
    for name, allowed in bounds(GROUPS[group]).items():
        assert versions[name], name
        assert all(version in allowed for version in versions[name]), name


def test_lock_file_names_the_python_of_the_project() -> None:
    assert LOCK["requires-python"] == PROJECT["project"]["requires-python"]


def test_plotly_in_the_book_is_the_one_the_notebooks_write_for() -> None:
    from plotly.offline import get_plotlyjs_version

    (script,) = (ROOT / "book" / "_assets" / "vendor" / "plotly").glob("*.js")
    found = re.search(r"plotly\.js .*? v([\d.]+)", script.read_text(encoding="utf-8")[:300])
    assert found is not None
    assert found.group(1) == get_plotlyjs_version()


def test_every_vendored_folder_has_its_licence() -> None:
    folders = [path for path in (ROOT / "book" / "_assets" / "vendor").iterdir() if path.is_dir()]
    assert len(folders) >= 4
    for folder in folders:
        assert (folder / "LICENSE").read_text(encoding="utf-8").strip(), folder.name
