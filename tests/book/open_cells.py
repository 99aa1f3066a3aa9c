"""The code of a chapter that lies open on its page: which cells, and which names they need from before them."""

import ast
import builtins
import symtable
from collections.abc import Iterator
from pathlib import Path

import nbformat

FOLDED = {"hide-input", "hide-cell", "remove-input", "remove-cell"}
# What a notebook has without importing it.
GIVEN = {*dir(builtins), "display", "__name__"}


def code_cells(path: Path) -> list[nbformat.NotebookNode]:
    return [cell for cell in nbformat.read(path, as_version=4).cells if cell.cell_type == "code"]


def is_open(cell: nbformat.NotebookNode) -> bool:
    return not FOLDED & set(cell.metadata.get("tags", []))


def python(source: str) -> str:
    """Leave out the lines that are IPython's."""
    return "\n".join("" if line.startswith(("%", "!")) else line for line in source.splitlines())


def symbols(code: str) -> tuple[set[str], set[str], set[str]]:
    """Names of the module that code reads at once, reads in a scope of its own, and binds."""
    table = symtable.symtable(code, "cell", "exec")
    bound = {
        symbol.get_name()
        for symbol in table.get_symbols()
        if symbol.is_assigned() or symbol.is_imported() or symbol.is_namespace()
    }
    read = {symbol.get_name() for symbol in table.get_symbols() if symbol.is_referenced()}

    def inside(scope: symtable.SymbolTable) -> Iterator[str]:
        for child in scope.get_children():
            yield from (s.get_name() for s in child.get_symbols() if s.is_global() and s.is_referenced())
            yield from inside(child)

    return read, set(inside(table)), bound


def needed(source: str) -> tuple[set[str], set[str]]:
    """Names that a cell must find defined, and those that it defines."""
    needs: set[str] = set()
    defines: set[str] = set()
    for statement in ast.parse(python(source)).body:
        code = ast.unparse(statement)
        read, later, bound = symbols(code)
        if isinstance(statement, ast.Assign | ast.AnnAssign) and statement.value is not None:
            at_once, later, _ = symbols(ast.unparse(statement.value))
            targets = statement.targets if isinstance(statement, ast.Assign) else [statement.target]
            at_once |= {
                name.id
                for target in targets
                for name in ast.walk(target)
                if isinstance(name, ast.Name) and isinstance(name.ctx, ast.Load)
            }
        elif isinstance(statement, ast.AugAssign):
            at_once = read | bound
        else:
            at_once = read - bound
        if isinstance(statement, ast.FunctionDef | ast.ClassDef):
            later -= {statement.name}
        needs |= (at_once | (later - bound)) - defines - GIVEN
        defines |= bound
    return needs, defines
