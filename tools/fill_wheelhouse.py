"""Fill the folder `wheelhouse` with every package that `uv.lock` names for this Python and this machine.

`python tools/fill_wheelhouse.py` needs a network, and a Python of the version that the Containerfile has; what it
leaves is all that is needed to build the container without one. Works in an environment of its own.
"""

import subprocess
import sys
import tempfile
import venv
from pathlib import Path

from lock import ROOT
from set_up import UV_VERSION

FOLDER = ROOT / "wheelhouse"
REQUIREMENTS = FOLDER / "requirements.txt"
GROUPS = ("book", "dev", "build")


def main() -> int:
    """Export the lock with its hashes, download what it names; return the exit code."""
    FOLDER.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        venv.create(folder, with_pip=True)
        python = Path(folder, "Scripts" if sys.platform == "win32" else "bin", "python")
        pip = [str(python), "-m", "pip", "--disable-pip-version-check"]
        groups = [word for group in GROUPS for word in ("--group", group)]
        export = [str(python), "-m", "uv", "export", "--quiet", "--locked", "--no-emit-project", *groups]
        try:
            subprocess.run([*pip, "install", "--quiet", f"uv=={UV_VERSION}"], check=True)
            subprocess.run([*export, "--output-file", str(REQUIREMENTS)], cwd=ROOT, check=True)
            # The lock names all of them, and leaves out one that a package asks for (see pyproject.toml).
            download = ["download", "--quiet", "--dest", str(FOLDER), "--require-hashes", "--no-deps"]
            subprocess.run([*pip, *download, "--requirement", str(REQUIREMENTS)], check=True)
        except subprocess.CalledProcessError as problem:
            sys.stderr.write(f"wheelhouse: `{' '.join(map(str, problem.cmd))}` failed; see above.\n")
            return 1
    sys.stdout.write(f"wheelhouse: {sum(1 for _ in FOLDER.iterdir()) - 1} packages in {FOLDER}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
