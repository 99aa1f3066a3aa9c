"""Files that appear whole or not at all, and names for them.

What is being written lies hidden beside its place, under a name that says for which file, on which machine and in which
process. A process that is ended by force leaves that behind; the next one that writes to the same place clears it away
if the process is gone.
"""

from __future__ import annotations

import os
import platform
import re
import shutil
import tempfile
import unicodedata
from collections.abc import Collection, Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

_LONGEST_STEM = 60
# Of the name of a file in the hidden one beside it: names may have 255 bytes.
_SHOWN = 40


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


def _hidden(path: Path) -> str:
    """Begin the name of what is hidden beside a path, for this machine."""
    return f".{path.name[:_SHOWN]}.{file_stem(platform.node())[:20]}."


def _clear_leftovers(path: Path) -> None:
    """Remove what a process of this machine that is gone has left hidden beside a path."""
    # Windows would end a process that is asked in this way whether it is there.
    if os.name == "nt":
        return
    pattern = re.compile(rf"{re.escape(_hidden(path))}(\d{{1,9}})\.\w{{8}}({re.escape(path.suffix)})?")
    for left in list(path.parent.iterdir()):
        found = pattern.fullmatch(left.name)
        if found is None or _is_running(int(found[1])):
            continue
        if left.is_dir() and not left.is_symlink():
            shutil.rmtree(left, ignore_errors=True)
        else:
            with suppress(OSError):
                left.unlink()


def _is_running(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except OSError:
        pass  # it belongs to somebody else
    return True


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
        _clear_leftovers(path)
        prefix = f"{_hidden(path)}{os.getpid()}."
        handle, name = tempfile.mkstemp(prefix=prefix, suffix=path.suffix, dir=path.parent)
        os.close(handle)
    temporary = Path(name)
    try:
        yield temporary
        temporary.chmod(0o644)  # mkstemp makes it private; a data file is to be read
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)


@contextmanager
def files_written_whole(paths: Sequence[Path]) -> Iterator[tuple[Path, ...]]:
    """Give places to write several files to, which become the files when all of them are written.

    Parameters
    ----------
    paths : sequence of Path
        The files; their folders are made.

    Yields
    ------
    tuple of Path
        The same names, each in a hidden folder beside its file. What was at `paths` stays if the block raises.
    """
    with ExitStack() as hidden:
        places = []
        for path in paths:
            with _about(path):
                path.parent.mkdir(parents=True, exist_ok=True)
                _clear_leftovers(path)
                folder = tempfile.mkdtemp(prefix=f"{_hidden(path)}{os.getpid()}.", dir=path.parent)
            hidden.callback(shutil.rmtree, folder, ignore_errors=True)
            places.append(Path(folder, path.name))
        yield tuple(places)
        for place, path in zip(places, paths, strict=True):
            place.replace(path)


@contextmanager
def folder_written_whole(path: Path, own: Collection[str] = ()) -> Iterator[Path]:
    """Give a folder beside another to write to, whose files appear in it when all are written.

    Parameters
    ----------
    path : Path
        The folder; it and those above it are made.
    own : collection of str, optional
        Names of all files that may be written: those of an earlier time that are not written now are removed, or they
        would lie there as results of this one.

    Yields
    ------
    Path
        Another folder beside it, empty. It becomes `path`; where that is there already, files of the same name are
        replaced one by one, each whole, and others stay but for those of `own`. If the block raises, nothing of it is
        left, and `path` is as it was.
    """
    with _about(path):
        path.parent.mkdir(parents=True, exist_ok=True)
        _clear_leftovers(path)
        temporary = Path(tempfile.mkdtemp(prefix=f"{_hidden(path)}{os.getpid()}.", dir=path.parent))
    try:
        yield temporary
        temporary.chmod(0o755)  # mkdtemp makes it private
        if path.is_dir():
            written = {file.name for file in temporary.iterdir()}
            for name in sorted(set(own) - written):
                if not (earlier := path / name).is_dir():
                    earlier.unlink(missing_ok=True)
            for file in sorted(temporary.iterdir()):
                file.replace(path / file.name)
        else:
            temporary.replace(path)
    finally:
        shutil.rmtree(temporary, ignore_errors=True)
