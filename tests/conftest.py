"""Settings shared by all tests."""

import gc
import re
from collections.abc import Iterator
from typing import TYPE_CHECKING

import pytest
from hypothesis import settings

if TYPE_CHECKING:
    from playwright.sync_api import Playwright
    from xdist.remote import Producer
    from xdist.scheduler import LoadScopeScheduling

settings.register_profile("facegear", deadline=None, derandomize=True, print_blob=True)
settings.load_profile("facegear")


# What these files test takes long to make or to read, and is shared.
FILES_FOR_ONE_WORKER = ("test_pdf.py", "test_small_book.py")


def group_of(test: str) -> str:
    """Return the name of the group that a test belongs to; one worker does all tests of a group.

    The tests of a page of the book share the page in the browser, those of some files what the file makes; all others
    stand alone. (The mark `xdist_group` of pytest-xdist 3.8 has no effect under pytest 9.)
    """
    page = re.search(r"\[([\w/]+\.html)", test)
    if page:
        return page[1]
    file = test.split("::")[0]
    return file if file.endswith(FILES_FOR_ONE_WORKER) else test


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: "Producer") -> "LoadScopeScheduling | None":
    """With `--dist loadscope`, hand out tests by the groups above, in the order in which they were collected."""
    if config.getvalue("dist") != "loadscope":
        return None
    from xdist.scheduler import LoadScopeScheduling

    class Groups(LoadScopeScheduling):
        def _split_scope(self, nodeid: str) -> str:
            return group_of(nodeid)

    # Those with the most tests are not those that take longest.
    config.option.loadscopereorder = False
    return Groups(config, log)


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Put the longest tests first, so that two workers end at about the same time."""

    def seconds(item: pytest.Item) -> float:
        mark = item.get_closest_marker("takes")
        return mark.args[0] if mark else 0.0

    items.sort(key=seconds, reverse=True)


@pytest.hookimpl(tryfirst=True)
def pytest_collection() -> None:
    """Make no rounds for garbage while what stays is loaded: half a million objects, half a second a round."""
    gc.disable()


@pytest.hookimpl(trylast=True)
def pytest_collection_finish() -> None:
    """Leave what has been loaded out of all further rounds."""
    gc.freeze()
    gc.enable()


@pytest.fixture(scope="session")
def chromium_driver() -> Iterator["Playwright"]:
    """Playwright, started once: a second one in the same process would refuse to run."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        yield playwright
