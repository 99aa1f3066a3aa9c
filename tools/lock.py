"""One build at a time in a checkout (standard library only: used before anything is installed)."""

import sqlite3
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
LOCK = ROOT / "build" / ".lock"


@contextmanager
def one_at_a_time(path: Path = LOCK) -> Iterator[None]:
    """Hold the lock of this checkout; wait, and say so, while another process holds it.

    SQLite's file lock is the one in the standard library that works on every system, and the operating
    system frees it when the process ends, however it ends.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    connection = sqlite3.connect(path, timeout=0.0, isolation_level=None)
    try:
        try:
            connection.execute("BEGIN EXCLUSIVE")
        except sqlite3.OperationalError:
            sys.stderr.write("Another build is at work in this folder; waiting for it to end.\n")
            sys.stderr.flush()
            connection.execute("PRAGMA busy_timeout = 2147483647")
            connection.execute("BEGIN EXCLUSIVE")
        yield
    finally:
        connection.close()
