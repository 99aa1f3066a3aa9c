"""Settings shared by all tests."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

import pytest
from hypothesis import settings

if TYPE_CHECKING:
    from playwright.sync_api import Playwright

settings.register_profile("facegear", deadline=None, derandomize=True, print_blob=True)
settings.load_profile("facegear")


@pytest.fixture(scope="session")
def chromium_driver() -> Iterator["Playwright"]:
    """Playwright, started once: a second one in the same process would refuse to run."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        yield playwright
