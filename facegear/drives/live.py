"""The explorer as a page of its own: a notebook of one cell, which Voilà shows without its code."""

from __future__ import annotations

import importlib.util
import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

# A kernel has run the notebook before the page is opened: what then remains is what a browser does. The next one is
# made ready when the page has had time [s] to come up.
READY = ("--preheat_kernel=True", "--VoilaKernelManager.fill_delay=5")
_NEEDED = ("anywidget", "ipykernel", "ipywidgets", "plotly", "voila")


def uninstalled() -> list[str]:
    """List the packages of the extra `explore` that are not there."""
    return [name for name in _NEEDED if importlib.util.find_spec(name) is None]


def notebook(drive_file: str | Path | None) -> dict[str, Any]:
    """Make the notebook of the explorer.

    Parameters
    ----------
    drive_file : str or Path, optional
        Where its controls stand at first; the example `case_1` if left out.

    Returns
    -------
    dict
        As Jupyter writes it, format 4.5.
    """
    file = None if drive_file is None else str(Path(drive_file).resolve())
    code = [
        "from facegear.drives.explorer import MapExplorer\n",
        "from facegear.drives.file_study import study_of\n",
        # Voilà's kernel has another current folder.
        f"MapExplorer(study_of({file!r}), folder={str(Path.cwd())!r})",
    ]
    cell: dict[str, Any] = {
        "cell_type": "code",
        "id": "explorer",
        "metadata": {},
        "source": code,
        "outputs": [],
        "execution_count": None,
    }
    kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
    return {"cells": [cell], "metadata": {"kernelspec": kernel}, "nbformat": 4, "nbformat_minor": 5}


def serve(drive_file: str | Path | None, port: int | None, *, browser: bool) -> int:
    """Show the explorer until it is interrupted.

    Parameters
    ----------
    drive_file : str or Path, optional
    port : int, optional
        That it listens on, on this machine only.
    browser : bool
        Whether to open one.

    Returns
    -------
    int
        Exit code of Voilà.
    """
    with tempfile.TemporaryDirectory(prefix="facegear-") as folder:
        path = Path(folder, "facegear.ipynb")
        path.write_text(json.dumps(notebook(drive_file)), encoding="utf-8")
        command = [sys.executable, "-m", "voila", str(path), *READY, "--Voila.ip=127.0.0.1"]
        command += [] if port is None else [f"--port={port}"]
        command += [] if browser else ["--no-browser"]
        with subprocess.Popen(command) as running:
            try:
                return running.wait()
            except KeyboardInterrupt:
                running.terminate()
                running.wait()
                raise
