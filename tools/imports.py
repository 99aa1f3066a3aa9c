"""Which modules of the project a notebook or a script imports, directly or not."""

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import nbformat

ROOT = Path(__file__).resolve().parents[1]
# Package -> folder that it lies in.
PACKAGES = {"facegear": ROOT, "compendium": ROOT / "book", "tools": ROOT}


def imported_by(source: Path) -> list[Path]:
    """Return the files of the project that run when a notebook or a script is executed.

    Imports inside functions count, those for type checkers only do not. A name that `facegear` loads on first use,
    such as `fg.Drive`, counts as an import of the module that defines it.
    """
    found: set[Path] = set()
    waiting = list(_direct(source))
    while waiting:
        path = waiting.pop()
        if path not in found:
            found.add(path)
            waiting.extend(_direct(path))
    return sorted(found)


def _code(source: Path) -> str:
    """Python text of a module, or of the code cells of a notebook without IPython's own lines."""
    if source.suffix != ".ipynb":
        return source.read_text(encoding="utf-8")
    cells = nbformat.read(source, as_version=4).cells
    lines = [line for cell in cells if cell.cell_type == "code" for line in cell.source.splitlines()]
    return "\n".join("" if line.startswith(("%", "!")) else line for line in lines)


@cache
def _direct(source: Path) -> frozenset[Path]:
    """Files of the project that one file imports itself."""
    names: set[str] = set()
    public, aliases, attributes = _public(), set(), set()
    for node in _run(ast.parse(_code(source))):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
            aliases |= {alias.asname or alias.name for alias in node.names if alias.name == "facegear"}
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            names |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
            if node.module == "facegear":
                names |= {public[alias.name] for alias in node.names if alias.name in public}
        elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            attributes.add((node.value.id, node.attr))
    names |= {public[name] for alias, name in attributes if alias in aliases and name in public}
    return frozenset(path for name in names for path in _files(name))


def _run(node: ast.AST) -> Iterator[ast.AST]:
    """Walk what runs: everything but what stands under `if TYPE_CHECKING`."""
    yield node
    if isinstance(node, ast.If) and isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING":
        return
    for child in ast.iter_child_nodes(node):
        yield from _run(child)


def _files(module: str) -> Iterator[Path]:
    """Files of a module and of the packages around it; none for modules from outside."""
    parts = module.split(".")
    if parts[0] not in PACKAGES:
        return
    for k in range(1, len(parts) + 1):
        place = PACKAGES[parts[0]].joinpath(*parts[:k])
        for path in (place / "__init__.py", place.with_suffix(".py")):
            if path.is_file():
                yield path


@cache
def _public() -> dict[str, str]:
    """Public names of `facegear`, and the module that defines each, from its stub."""
    stub = PACKAGES["facegear"] / "facegear" / "__init__.pyi"
    if not stub.is_file():
        return {}
    nodes = [
        node for node in ast.parse(stub.read_text(encoding="utf-8")).body if isinstance(node, ast.ImportFrom)
    ]
    return {alias.name: f"facegear.{node.module}" for node in nodes for alias in node.names}
