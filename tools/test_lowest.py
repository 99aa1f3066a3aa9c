"""Run the tests with the oldest versions of the dependencies that `pyproject.toml` allows.

`python tools/test_lowest.py [pytest options]`: resolves with uv's `lowest-direct`, that is the lower bound of each
dependency named there, installs into `build/lowest` and runs pytest from it. `uv.lock` and `.venv` stay as they are.
"""

import subprocess
import sys

from lock import ROOT

FOLDER = ROOT / "build" / "lowest"
VERSIONS = FOLDER / "requirements.txt"
PYTHON = FOLDER / "environment" / ("Scripts" if sys.platform == "win32" else "bin") / "python"
UV = [sys.executable, "-m", "uv"]


def run(*command: object) -> None:
    """Run a command in the project's folder; end with its code if it fails."""
    done = subprocess.run([str(word) for word in command], cwd=ROOT, check=False)
    if done.returncode != 0:
        sys.exit(done.returncode)


def main(options: list[str]) -> None:
    """Resolve, install, test."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    groups = ["--group", "book", "--group", "dev"]
    resolution = ["--resolution", "lowest-direct", "--python", sys.executable]
    run(*UV, "pip", "compile", "--quiet", "pyproject.toml", *groups, *resolution, "--output-file", VERSIONS)
    run(*UV, "venv", "--quiet", "--clear", "--python", sys.executable, PYTHON.parents[1])
    run(*UV, "pip", "install", "--quiet", "--python", PYTHON, "--requirement", VERSIONS, "--editable", ".")
    run(PYTHON, "-m", "pytest", *options)


if __name__ == "__main__":
    main(sys.argv[1:])
