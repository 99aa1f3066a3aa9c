"""Every name that the nomenclature gives exists in the module."""

import dataclasses
import importlib
import pkgutil
import re
from pathlib import Path

import pytest

import facegear

PAGE = Path(__file__).resolve().parents[1] / "book" / "nomenclature.md"
ROWS = [
    line.strip("|").split(" | ")
    for line in PAGE.read_text(encoding="utf-8").splitlines()
    if line[:3] == "| $"
]
NAMES = sorted({name for row in ROWS for name in re.findall(r"`([\w.]+)`", row[-1])})


def defined() -> dict[str, object]:
    found: dict[str, object] = {}
    for entry in pkgutil.walk_packages(facegear.__path__, "facegear."):
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
