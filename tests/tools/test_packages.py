"""Each package says in its docstring what every one of its modules is for."""

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = sorted(
    init.parent
    for folder in ("facegear", "book/compendium")
    for init in (ROOT / folder).rglob("__init__.py")
    if init.parent != ROOT / "facegear"  # whose docstring is the workflow
)


def modules(package: Path) -> set[str]:
    inside = {path.stem for path in package.glob("*.py")} - {"__init__"}
    return inside | {path.parent.name for path in package.glob("*/__init__.py")}


@pytest.mark.parametrize("package", PACKAGES, ids=lambda package: package.name)
def test_a_package_names_every_module_and_none_that_is_gone(package):
    text = ast.get_docstring(ast.parse((package / "__init__.py").read_text(encoding="utf-8"))) or ""
    # After that word stand names of classes and functions.
    named = {name for name in re.findall(r"`(\w+)`", text.partition("Public: ")[0]) if name.islower()}
    assert modules(package) - named == set()
    assert named - modules(package) - {"facegear"} == set()
