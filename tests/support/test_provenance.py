"""Which version and which commit makes what is written."""

import shutil
import subprocess
from importlib.metadata import version

import pytest

from facegear.support import provenance

needs_git = pytest.mark.skipif(shutil.which("git") is None, reason="git is not here")


def git(folder, *arguments):
    identity = ("-c", "user.name=A", "-c", "user.email=a@example.org")
    done = subprocess.run(
        ("git", *identity, *arguments), cwd=folder, check=True, capture_output=True, text=True
    )
    return done.stdout.strip()


@pytest.fixture
def package(tmp_path):
    """Package in a repository of its own, all committed."""
    folder = tmp_path / "facegear"
    (tmp_path / "notebooks").mkdir()
    (tmp_path / "book" / "compendium").mkdir(parents=True)
    folder.mkdir()
    (folder / "__init__.py").write_text("", encoding="utf-8")
    (tmp_path / "notebooks" / "one.ipynb").write_text("{}", encoding="utf-8")
    git(tmp_path, "init", "--quiet")
    git(tmp_path, "add", ".")
    git(tmp_path, "commit", "--quiet", "--message", "One")
    provenance.commit_of.cache_clear()
    return folder


@needs_git
def test_the_commit_of_a_clean_tree(package):
    assert provenance.commit_of(package) == git(package, "rev-parse", "HEAD")


@needs_git
@pytest.mark.parametrize(
    "changed", ["facegear/new.py", "facegear/__init__.py", "book/compendium/new.py", "notebooks/one.ipynb"]
)
def test_changes_are_marked(package, changed):
    (package.parent / changed).write_text("1", encoding="utf-8")
    assert provenance.commit_of(package) == git(package, "rev-parse", "HEAD") + "+changes"


@needs_git
def test_what_computes_nothing_is_no_change(package):
    (package.parent / "notes.txt").write_text("1", encoding="utf-8")
    assert provenance.commit_of(package) == git(package, "rev-parse", "HEAD")


@needs_git
def test_a_package_installed_into_the_tree_of_another_has_no_commit(package):
    installed = package.parent / ".venv" / "facegear"
    shutil.copytree(package, installed)
    assert provenance.commit_of(installed) == ""


def test_without_git_or_repository_there_is_a_version_only(tmp_path, monkeypatch):
    provenance.commit_of.cache_clear()
    assert provenance.commit_of(tmp_path) == ""
    monkeypatch.setenv("PATH", "")
    provenance.commit_of.cache_clear()
    assert provenance.made_by() == {"facegear_version": version("facegear")}
    provenance.commit_of.cache_clear()


def test_the_code_is_told_from_another(tmp_path, monkeypatch):
    here = provenance.code_digest()
    for text in ("a = 1", "a = 2"):
        (tmp_path / "provenance.py").write_text(text, encoding="utf-8")
        monkeypatch.setattr(provenance, "_PACKAGE", tmp_path)
        provenance.code_digest.cache_clear()
        assert provenance.code_digest() != here
        here = provenance.code_digest()
    monkeypatch.undo()
    provenance.code_digest.cache_clear()
