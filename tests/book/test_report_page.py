"""The page of a report in a browser: hostile text is text, and nothing is asked of a network."""

import shutil

import pytest

from facegear.drives.page import page as page_of
from tests.book.test_book import FLAGS
from tests.drives.test_page import EVERYWHERE, HOSTILE


@pytest.mark.book
@pytest.mark.parametrize("width", [390, 1440])
def test_hostile_text_is_text_in_a_browser(tmp_path, chromium_driver, width):
    (tmp_path / "report.html").write_text(page_of(HOSTILE, [EVERYWHERE]), encoding="utf-8")
    found = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    browser = chromium_driver.chromium.launch(executable_path=found, args=FLAGS)
    page = browser.new_page(viewport={"width": width, "height": 900})
    asked, complaints = [], []
    page.on("request", lambda request: asked.append(request.url))
    page.on("console", lambda message: complaints.append(message.text))
    page.goto((tmp_path / "report.html").as_uri())
    assert page.evaluate("window.p") is None
    assert page.locator("h1").inner_text() == HOSTILE.replace("\n", " ")
    assert page.locator("img").count() == 1
    assert page.locator("img").evaluate("image => image.naturalWidth") > 100
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    assert [url for url in asked if not url.startswith(("file:", "data:"))] == []
    assert complaints == []
    browser.close()
