"""What a release says of itself stands in several files; they say the same."""

import json
import re
import tomllib
from pathlib import Path

import pytest
import yaml

import facegear

ROOT = Path(__file__).resolve().parents[2]


def text(name):
    return (ROOT / name).read_text(encoding="utf-8")


PROJECT = tomllib.loads(text("pyproject.toml"))["project"]
CFF = yaml.safe_load(text("CITATION.cff"))
CODEMETA = json.loads(text("codemeta.json"))
ZENODO = json.loads(text(".zenodo.json"))
VERSION, DATE = re.search(
    r"^## (\d+\.\d+\.\d+) – (\d{4}-\d\d-\d\d)$", text("CHANGELOG.md"), re.MULTILINE
).groups()
FORMS = sorted((ROOT / ".github" / "ISSUE_TEMPLATE").glob("*.yml"))


def test_all_name_the_same_version():
    locked = tomllib.loads(text("uv.lock"))["package"]
    (own,) = [package["version"] for package in locked if package["name"] == "facegear"]
    named = [
        PROJECT["version"],
        CFF["version"],
        CODEMETA["version"],
        ZENODO["version"],
        own,
        facegear.__version__,
    ]
    assert named == [VERSION] * len(named)


def test_all_name_the_same_day():
    named = [str(CFF["date-released"]), CODEMETA["dateModified"], ZENODO["publication_date"]]
    assert named == [DATE] * 3


def test_all_name_the_same_title_authors_and_subject():
    assert CFF["title"] == CODEMETA["name"] == ZENODO["title"]
    authors = [author["name"] for author in CFF["authors"]]
    assert authors == [author["name"] for author in PROJECT["authors"]]
    assert authors == [author["name"] for author in CODEMETA["author"]]
    assert authors == [creator["name"] for creator in ZENODO["creators"]]
    assert CFF["keywords"] == CODEMETA["keywords"] == ZENODO["keywords"]
    assert " ".join(CFF["abstract"].split()) == CODEMETA["description"] == ZENODO["description"]


def test_all_refer_to_the_dissertation():
    (thesis,) = CFF["references"]
    assert CODEMETA["referencePublication"]["url"] == thesis["url"]
    assert CODEMETA["referencePublication"]["name"] == thesis["title"]
    assert [each["identifier"] for each in ZENODO["related_identifiers"]] == [thesis["url"]]


def test_licences_are_there_and_named():
    assert CFF["license"] == ["MIT", "CC-BY-4.0"]
    assert [address.rpartition("/")[2] for address in CODEMETA["license"]] == CFF["license"]
    assert ZENODO["license"] == PROJECT["license"] == "MIT"
    assert text("LICENSE").startswith("MIT License\n")
    assert "Attribution 4.0 International Public License" in text("LICENSE-CC-BY-4.0")
    assert "Section 8 -- Interpretation." in text("LICENSE-CC-BY-4.0")
    for name in ("LICENSE", "LICENSE-CC-BY-4.0"):
        assert f"`{name}`" in text("README.md")


@pytest.mark.parametrize("path", FORMS, ids=lambda path: path.stem)
def test_issue_forms_are_such(path):
    form = yaml.safe_load(path.read_text(encoding="utf-8"))
    if path.stem == "config":
        assert set(form) <= {"blank_issues_enabled", "contact_links"}
        return
    assert form["name"]
    assert form["description"]
    names = [part["id"] for part in form["body"]]
    assert len(set(names)) == len(names)
    assert all(part["type"] in ("textarea", "input", "dropdown", "checkboxes") for part in form["body"])
    assert all(part["attributes"]["label"] for part in form["body"])
    assert any(part["validations"]["required"] for part in form["body"])


def test_there_are_forms_for_what_people_come_with():
    assert {path.stem for path in FORMS} == {"config", "question", "proposal", "wrong_result"}


def test_the_container_takes_the_packages_of_the_lock_and_the_python_that_it_says():
    lines = text("Containerfile")
    tags = set(re.findall(r"python:(\d+\.\d+)-slim", lines))
    assert len(tags) == 1
    assert f"Python :: {tags.pop()}" in " ".join(PROJECT["classifiers"])
    for words in ("--no-index", "--require-hashes", "tools/fill_wheelhouse.py", "--network=none"):
        assert words in lines
    assert text(".dockerignore") == text(".containerignore")
    assert "wheelhouse" not in text(".containerignore")
    assert "wheelhouse" in text(".gitignore")
