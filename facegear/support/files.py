"""Files that appear whole or not at all, and names for them."""

from __future__ import annotations

import os
import re
import shutil
import tempfile
import unicodedata
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

_LONGEST_STEM = 60


@contextmanager
def _about(path: Path) -> Iterator[None]:
    """Let errors of the system name what was to be written, not the temporary name beside it."""
    try:
        yield
    except OSError as error:
        raise type(error)(error.errno, error.strerror, str(path)) from error


def file_stem(text: str) -> str:
    """Make a name of a file, without its ending, from any text.

    Parameters
    ----------
    text : str
        For example the name of a drive or of a model, as somebody typed it.

    Returns
    -------
    str
        Small letters, digits and single underscores, which every system takes and no shell reads anything into: at
        least one, at most 60 of them. Accents are taken off; what has no such letter is left out. Different texts may
        get the same name.

    Examples
    --------
    >>> file_stem("Torsional, true sweep"), file_stem("../../etc/passwd"), file_stem("=°")
    ('torsional_true_sweep', 'etc_passwd', 'unnamed')
    """
    plain = unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode().lower()
    stem = re.sub(r"[^a-z0-9]+", "_", plain)[:_LONGEST_STEM].strip("_")
    # Windows keeps these names to itself, with any ending.
    reserved = re.fullmatch(r"con|prn|aux|nul|(com|lpt)\d", stem)
    return f"{stem}_" if reserved else stem or "unnamed"


@contextmanager
def written_whole(path: Path) -> Iterator[Path]:
    """Give a place beside a file to write to, which becomes the file when all is written.

    Parameters
    ----------
    path : Path
        The file; its folder is made.

    Yields
    ------
    Path
        Another name in the same folder, with the same ending. What was at `path` stays if the block raises.
    """
    with _about(path):
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(prefix=".", suffix=path.suffix, dir=path.parent)
        os.close(handle)
    temporary = Path(name)
    try:
        yield temporary
        temporary.chmod(0o644)  # mkstemp makes it private; a data file is to be read
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)


@contextmanager
def folder_written_whole(path: Path) -> Iterator[Path]:
    """Give a folder beside another to write to, whose files appear in it when all are written.

    Parameters
    ----------
    path : Path
        The folder; it and those above it are made.

    Yields
    ------
    Path
        Another folder beside it, empty. It becomes `path`; where that is there already, files of the same name are
        replaced one by one, each whole, and others stay. If the block raises, nothing of it is left, and `path` is as
        it was.
    """
    with _about(path):
        path.parent.mkdir(parents=True, exist_ok=True)
        temporary = Path(tempfile.mkdtemp(prefix=f".{path.name}.", dir=path.parent))
    try:
        yield temporary
        temporary.chmod(0o755)  # mkdtemp makes it private
        if path.is_dir():
            for file in sorted(temporary.iterdir()):
                file.replace(path / file.name)
        else:
            temporary.replace(path)
    finally:
        shutil.rmtree(temporary, ignore_errors=True)
