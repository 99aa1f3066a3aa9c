"""The page of a report in a browser: a hostile name is text, and nothing is asked of a network."""

import shutil

import nbformat
import pytest

from facegear.drives.verdict import as_html
from tests.book.test_book import FLAGS
from tests.tools.test_run_drive import HOSTILE
from tools.run_drive import page_of


@pytest.mark.book
def test_a_name_is_text_in_a_browser(tmp_path, chromium_driver):
    """The name of a drive does nothing on the page of its report, which asks nothing of a network."""
    name = "<p><strong>" + as_html(HOSTILE) + "</strong></p>"
    output = nbformat.v4.new_output("display_data", data={"text/html": name})
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell("", outputs=[output])])
    (tmp_path / "report.html").write_text(page_of(notebook), encoding="utf-8")
    found = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    browser = chromium_driver.chromium.launch(executable_path=found, args=FLAGS)
    page = browser.new_page()
    asked = []
    page.on("request", lambda request: asked.append(request.url))
    page.goto((tmp_path / "report.html").as_uri())
    assert page.evaluate("window.p") is None
    assert page.locator("strong").inner_text() == HOSTILE.replace("\n", " ")
    assert page.locator("img").count() == 0
    assert [url for url in asked if not url.startswith(("file:", "data:"))] == []
    browser.close()
