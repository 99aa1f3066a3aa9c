"""Make `.venv` what `uv.lock` says; runs on any Python from 3.11 on, with nothing installed.

Creates the environment, installs the pinned uv into it and lets uv do the rest. Nothing to do takes a fraction
of a second; an interrupted set-up is taken up again by the next call.
"""

import os
import subprocess
import sys
from pathlib import Path

from lock import ROOT, one_at_a_time

UV_VERSION = "0.13.9"
ENVIRONMENT = ROOT / ".venv"
PROGRAMS = ENVIRONMENT / ("Scripts" if os.name == "nt" else "bin")
PYTHON = PROGRAMS / ("python.exe" if os.name == "nt" else "python")


def answers(*command: str | Path) -> str:
    """Return what a command prints, or an empty string when it does not work."""
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return ""
    return done.stdout


def installed_uv() -> str:
    """Return the version of the uv inside the environment, or an empty string."""
    words = answers(PYTHON, "-m", "uv", "--version").split()
    return words[1] if len(words) > 1 else ""


def create_environment() -> None:
    """Create `.venv` with pip in it, replacing one that is broken."""
    say("creating .venv")
    done = subprocess.run([sys.executable, "-m", "venv", "--clear", str(ENVIRONMENT)], check=False)
    if done.returncode != 0:
        sys.exit(
            f"`{sys.executable} -m venv` failed. On Debian and Ubuntu: sudo apt-get install python3-venv; "
            "then run make again."
        )


def say(message: str) -> None:
    """Print one line about the set-up."""
    sys.stdout.write(f"set-up: {message}\n")
    sys.stdout.flush()


def set_up() -> None:
    """Create the environment if it is missing and bring it in line with `uv.lock`."""
    if not answers(PYTHON, "-m", "pip", "--version"):
        create_environment()
    pip = [str(PYTHON), "-m", "pip", "--disable-pip-version-check", "install", "--quiet"]
    if installed_uv() != UV_VERSION:
        say(f"installing uv {UV_VERSION}")
        subprocess.run([*pip, f"uv=={UV_VERSION}"], check=True)
    # The caller's own environment must not redirect uv away from `.venv`.
    clean = {name: value for name, value in os.environ.items() if name not in ("VIRTUAL_ENV", "UV_PYTHON")}
    clean |= {"UV_PROJECT_ENVIRONMENT": str(ENVIRONMENT), "UV_PYTHON_DOWNLOADS": "never"}
    quiet = [] if sys.stderr.isatty() else ["--quiet"]
    command = [str(PYTHON), "-m", "uv", "sync", "--locked", "--python", str(PYTHON), *quiet]
    subprocess.run(command, cwd=ROOT, env=clean, check=True)


def main() -> int:
    """Run the set-up; return the exit code."""
    if sys.version_info < (3, 11):  # noqa: UP036 - this file is what tells the owner of an older one
        version = ".".join(map(str, sys.version_info[:3]))
        sys.stderr.write(f"facegear needs Python 3.11 or newer; {sys.executable} is {version}.\n")
        return 1
    with one_at_a_time():
        try:
            set_up()
        except subprocess.CalledProcessError as problem:
            sys.stderr.write(f"set-up: `{' '.join(map(str, problem.cmd))}` failed; see above.\n")
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
