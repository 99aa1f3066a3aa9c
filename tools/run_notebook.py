"""Execute one notebook with papermill, whole or not at all.

`python tools/run_notebook.py notebooks/a.ipynb build/executed/a.ipynb --failed build/failed`

The executed notebook appears under its name only when every cell has run. When a cell fails, the notebook as
far as it came lies in the folder of the failed ones, and one line says which notebook, which cell, which error
and which file to open. Progress is printed to standard output, one line a cell: `cell 3 of 48`.
"""

import argparse
import os
import sys
import threading
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import nbformat
import papermill
from nbclient.exceptions import DeadKernelError
from papermill.exceptions import PapermillExecutionError

LONGEST_MESSAGE = 400
# Nobody can turn a control while papermill runs, nor on the page that comes of it: a notebook that has live
# controls shows a picture of them instead.
WITHOUT_A_READER = {"live_controls": False}
# A kernel on this machine warns at every start that what it hears and says is not encrypted.
QUIET_KERNEL = ["--IPKernelApp.log_level=ERROR"]
INJECTED = "injected-parameters"  # papermill's tag of the cell it adds


class NotebookFailedError(Exception):
    """A cell of a notebook raised, or its kernel died.

    Attributes
    ----------
    error : str
        Name of the exception's class.
    source : str
        The cell that raised; empty when the kernel died.
    """

    def __init__(self, message: str, error: str, source: str) -> None:
        super().__init__(message)
        self.error = error
        self.source = source


def code_cells(notebook: Path) -> list[str]:
    """Return the sources of a notebook's code cells that hold something."""
    content = nbformat.read(notebook, as_version=4)
    return [cell.source for cell in content.cells if cell.cell_type == "code" and cell.source.strip()]


def one_line(text: str) -> str:
    """Squeeze a message into one line of bearable length."""
    line = " ".join(text.split())
    return line if len(line) <= LONGEST_MESSAGE else line[: LONGEST_MESSAGE - 1] + "…"


def execute(
    notebook: Path,
    output: Path,
    failed: Path,
    parameters: Mapping[str, Any] | None = None,
    on_cell: Callable[[int], None] = lambda _: None,
) -> None:
    """Execute `notebook` in its own folder and move the result to `output` when it is complete.

    Parameters
    ----------
    notebook, output : Path
        What to execute, and the name of the executed notebook.
    failed : Path
        Folder that receives the notebook as far as it came when a cell fails.
    parameters : mapping, optional
        Papermill parameters; none leaves the values written in the notebook, but for `live_controls`, which is
        off.
    on_cell : callable
        Called with the number of code cells that have run.

    Raises
    ------
    NotebookFailedError
        When a cell raises or the kernel dies.
    """
    notebook, output, failed = notebook.resolve(), output.resolve(), failed.resolve()
    output.parent.mkdir(parents=True, exist_ok=True)
    failed.mkdir(parents=True, exist_ok=True)
    kept = failed / notebook.name
    kept.unlink(missing_ok=True)
    for left in output.parent.glob(f".{output.stem}.*.ipynb"):  # by a run that was killed
        left.unlink()
    unfinished = output.with_name(f".{output.stem}.{os.getpid()}.ipynb")
    declared = papermill.inspect_notebook(notebook)
    given = {name: value for name, value in WITHOUT_A_READER.items() if name in declared} | dict(
        parameters or {}
    )
    done = 0

    def count(cell: nbformat.NotebookNode, **_: object) -> None:
        nonlocal done
        if INJECTED not in cell.metadata.get("tags", []):
            done += 1
            on_cell(done)

    try:
        papermill.execute_notebook(
            notebook,
            unfinished,
            parameters=given,
            cwd=notebook.parent,
            progress_bar=False,
            on_cell_executed=count,
            extra_arguments=QUIET_KERNEL,
        )
    except PapermillExecutionError as problem:
        unfinished.replace(kept)
        where = f"{notebook.name}, cell [{problem.exec_count}]: {problem.ename}: {problem.evalue}"
        message = one_line(where) + f" (open {kept})"
        raise NotebookFailedError(message, problem.ename, problem.source) from problem
    except DeadKernelError as problem:
        unfinished.replace(kept)
        message = f"{notebook.name}, code cell {done + 1}: the kernel died (open {kept})"
        raise NotebookFailedError(message, "DeadKernelError", "") from problem
    made_presentable(unfinished)
    unfinished.replace(output)


def made_presentable(executed: Path) -> None:
    """Remove this machine's paths, which papermill records, and hide the cell it adds from the page."""
    content = nbformat.read(executed, as_version=4)
    for name in ("input_path", "output_path"):
        content.metadata.get("papermill", {}).pop(name, None)
    for cell in content.cells:
        if INJECTED in cell.metadata.get("tags", []):
            cell.metadata["tags"].append("remove-cell")
    nbformat.write(content, executed)


def end_with_parent() -> None:
    """End this process when its standard input closes, that is when the build that started it is gone."""

    def watch() -> None:
        while os.read(sys.stdin.fileno(), 1024):
            pass
        os._exit(1)  # the kernel notices within a second that its parent is gone

    threading.Thread(target=watch, daemon=True).start()


def main(arguments: list[str]) -> int:
    """Run the command line; return the exit code."""
    parser = argparse.ArgumentParser(description="Execute one notebook, whole or not at all.")
    parser.add_argument("notebook", type=Path)
    parser.add_argument("output", type=Path)
    parser.add_argument("--failed", type=Path, required=True, help="folder for a notebook that stops")
    parser.add_argument("--end-with-parent", action="store_true", help="stop when standard input closes")
    options = parser.parse_args(arguments)
    if options.end_with_parent:
        end_with_parent()
    total = len(code_cells(options.notebook))

    def report(done: int) -> None:
        sys.stdout.write(f"cell {done} of {total}\n")
        sys.stdout.flush()

    try:
        execute(options.notebook, options.output, options.failed, on_cell=report)
    except NotebookFailedError as problem:
        sys.stderr.write(f"{problem}\n")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
