"""Take the picture of the title page that README.md shows: `python tools/take_screenshot.py` after `make book`."""

import functools
import shutil
import sys
import threading
from http.server import ThreadingHTTPServer
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from playwright.sync_api import sync_playwright  # noqa: E402

from tools.print_book import FLAGS, QuietHandler  # noqa: E402

PAGES = ROOT / "build" / "_build" / "html"
PICTURE = ROOT / ".github" / "title-page.png"


def main(pages: Path, picture: Path) -> None:
    """Open the title page as a reader with a small screen sees it, and store what is seen."""
    handler = functools.partial(QuietHandler, directory=str(pages))
    with ThreadingHTTPServer(("127.0.0.1", 0), handler) as server, sync_playwright() as playwright:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=FLAGS)
        page = browser.new_page(viewport={"width": 1200, "height": 870}, color_scheme="light")
        page.goto(f"http://127.0.0.1:{server.server_port}/intro.html", wait_until="networkidle")
        page.screenshot(path=picture)
        browser.close()
        server.shutdown()


if __name__ == "__main__":
    main(PAGES, PICTURE)
