"""Every name that the nomenclature gives exists in the module."""

import dataclasses
import importlib
import json
import pkgutil
import re
from pathlib import Path

import pytest

import compendium
import facegear

PAGE = Path(__file__).resolve().parents[2] / "book" / "nomenclature.md"
ROWS = [
    line.strip("|").split(" | ")
    for line in PAGE.read_text(encoding="utf-8").splitlines()
    if line[:3] == "| $"
]
NAMES = sorted({name for row in ROWS for name in re.findall(r"`([\w.]+)`", row[-1])})


def defined() -> dict[str, object]:
    found: dict[str, object] = {}
    for package in (facegear, compendium):
        for entry in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            found.update(vars(importlib.import_module(entry.name)))
    return found


def test_every_row_has_symbol_meaning_unit_and_name() -> None:
    assert len(ROWS) > 30
    assert all(len(row) == 4 and all(cell.strip() for cell in row) for row in ROWS)


@pytest.mark.parametrize("name", NAMES)
def test_name_exists(name: str) -> None:
    head, *rest = name.split(".")
    owner = defined()[head]
    for attribute in rest:
        fields = (
            {field.name for field in dataclasses.fields(owner)} if dataclasses.is_dataclass(owner) else set()
        )
        assert attribute in fields or hasattr(owner, attribute), name


def symbols(row: list[str]) -> list[str]:
    return re.findall(r"\$([^$]+)\$", row[0])


def test_a_symbol_stands_in_one_row_only() -> None:
    found = [symbol for row in ROWS for symbol in symbols(row)]
    assert sorted(set(found)) == sorted(found)


# Where each letter without a subscript, or with one that counts, may stand: it means one thing there.
ALLOWED = {
    r"\\alpha(?![_a-zA-Z])": {"02", "03"},  # named as the dissertation's own letter, once each
    r"\\alpha_\{?(?!c\b|s\b|p\b|i\b|\{?va)": set(),
    r"\\beta(?![_a-zA-Z])": {"02", "04"},  # wave number of a mode; in chapter 2 the dissertation's own letter
    r"\\zeta(?![_a-zA-Z])": {"04", "05", "06", "08"},  # damping over stiffness of the bearing
    r"\\psi(?!_L)": {
        "05",
        "07",
        "08",
    },  # phase between pinions, or faces; in chapter 7 the dissertation's own letter
    r"\\lambda(?![_a-zA-Z])": {"02", "07"},  # a multiplier
    r"\\cos q\b|\bq - n\b|n-q\b|\(1-q\)": set(),  # q is the vector of coordinates
}


@pytest.mark.parametrize("pattern", ALLOWED)
def test_letter_has_one_meaning_in_the_chapters(pattern: str) -> None:
    folder = PAGE.parents[1] / "notebooks"
    where = set()
    for path in folder.glob("0*.ipynb"):
        cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
        text = "\n".join(
            ["".join(cell["source"]) for cell in cells] + [json.dumps(cell["metadata"]) for cell in cells]
        )
        where |= {path.name[:2]} if re.search(pattern, text) else set()
    assert where <= ALLOWED[pattern]


@pytest.mark.parametrize(
    "text", ["|α|", "e^{λ", "(λt", "∂α", "Re $\\alpha", "ζ ω0", "ζω0", "sin k(θ-α)", "r_b1 ψ1"]
)
def test_package_calls_things_by_the_names_of_the_page(text: str) -> None:
    sources = (PAGE.parents[1] / "facegear").rglob("*.py")
    assert [path.name for path in sources if text in path.read_text(encoding="utf-8")] == []
