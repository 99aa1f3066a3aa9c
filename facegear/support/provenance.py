"""Which version of the package, and which commit of its repository, makes what is written."""

from __future__ import annotations

import hashlib
import subprocess
from functools import cache
from importlib.metadata import version
from pathlib import Path

# What else makes arrays, from the root of the repository.
_BOOK = (":/book/compendium", ":/notebooks")

_PACKAGE = Path(__file__).resolve().parents[1]

COMMIT_FILE = "commit.txt"
"""What a wheel has in place of a repository, in the folder of the package."""

CHANGED = "+changes"
"""Follows the commit where the package, the book's own code or a notebook was changed after it."""


def made_by() -> dict[str, str]:
    """Version of the package, and its commit where it runs from its repository, as attributes of an array file.

    Returns
    -------
    dict of str to str
        ``facegear_version``, and ``facegear_commit`` if it is known: 40 digits, followed by "+changes" where package,
        the book's own code or notebooks are not as they were committed. An installed package has that of the
        repository in which its wheel was made.
    """
    commit = commit_of(_PACKAGE) or kept_commit(_PACKAGE)
    return {"facegear_version": version("facegear")} | ({"facegear_commit": commit} if commit else {})


def kept_commit(package: Path) -> str:
    """Commit that a wheel keeps of the repository it was made in, empty if there is none.

    Parameters
    ----------
    package : Path
        Folder of the package.
    """
    try:
        return (package / COMMIT_FILE).read_text(encoding="ascii").strip()
    except OSError:
        return ""


@cache
def code_digest() -> str:
    """SHA-256 over the code of the package: what an earlier code computed is not this one's."""
    state = hashlib.sha256()
    for path in sorted(_PACKAGE.rglob("*.py")):
        state.update(f"{path.relative_to(_PACKAGE).as_posix()}\n".encode() + path.read_bytes())
    return state.hexdigest()


@cache  # git takes some milliseconds, and a chapter writes dozens of files
def commit_of(package: Path) -> str:
    """Commit of the repository that tracks a package, empty if none does or git cannot tell.

    Parameters
    ----------
    package : Path
        Folder of the package.
    """
    # A package installed into somebody else's working tree is not tracked there.
    if not _git(package, "ls-files", "--", "__init__.py"):
        return ""
    commit = _git(package, "rev-parse", "HEAD")
    changes = _git(package, "--no-optional-locks", "status", "--porcelain", "--", ".", *_BOOK)
    return commit + CHANGED * bool(changes)


def _git(folder: Path, *arguments: str) -> str:
    """Answer of git, empty if there is none."""
    try:
        done = subprocess.run(
            ("git", *arguments), cwd=folder, capture_output=True, text=True, check=True, timeout=10.0
        )
    except (OSError, subprocess.SubprocessError):
        return ""
    return done.stdout.strip()
