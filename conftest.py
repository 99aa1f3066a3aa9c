"""Opens only those files in which `-m` can select something: to import all others takes seconds in every worker."""

import re
from functools import cache
from pathlib import Path

import pytest

# By the three selections that the Makefile makes.
MARKED = {"book": "mark.book", "slow and not book": "mark.slow"}
FAST = "not slow and not book"
WHOLE_FILE_MARKED = re.compile(r"^pytestmark = .*\bmark\.(slow|book)\b", re.MULTILINE)


@cache
def text_of(path: Path) -> str:
    """Return the text of a file."""
    return path.read_text(encoding="utf-8")


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Leave out files without the mark that is asked for, or as a whole with one that is not."""
    wanted = config.getoption("markexpr")
    if collection_path.suffix != ".py" or collection_path.name == "conftest.py":
        return None
    if wanted in MARKED and MARKED[wanted] not in text_of(collection_path):
        return True
    if wanted == FAST and WHOLE_FILE_MARKED.search(text_of(collection_path)):
        return True
    return None


def pytest_itemcollected(item: pytest.Item) -> None:
    """Refuse a mark that is not written in the file of its test: the test would never run."""
    for mark in ("slow", "book"):
        if item.get_closest_marker(mark) and f"mark.{mark}" not in text_of(item.path):
            raise pytest.UsageError(
                f"{item.nodeid} is marked {mark}, but mark.{mark} does not stand in its file"
            )
