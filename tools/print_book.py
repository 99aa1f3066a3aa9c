"""Print the whole book, built as one page, to one PDF with Chromium.

`python tools/print_book.py build/_build/singlehtml/intro.html build/facegear.pdf`

Nothing is fetched from beyond the folder of that page. What only works on a screen is left out: sliders and turning
views (each has a still picture beside it), folded code, menus. Tables and equations wider than the paper shrink to it.
"""

import argparse
import functools
import os
import shutil
import sys
import threading
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

from playwright.sync_api import Page, Route, sync_playwright

FLAGS = ["--headless=new", "--no-sandbox", "--disable-background-networking"]
# A4 with margins of 16 mm, printed at four fifths of the size on the screen.
SCALE, MARGIN = 0.8, "16mm"
WIDTH = round((210 - 2 * 16) / 25.4 * 96 / SCALE)
FOOTER = (
    '<div style="width: 100%; text-align: center; font-size: 8px; font-family: sans-serif">'
    '<span class="pageNumber"></span></div>'
)

STYLE = """
.bd-article, .bd-main, .bd-content, .bd-article-container, .bd-container__inner, .bd-container {
  display: block !important; max-width: none !important; width: auto !important;
  margin: 0 !important; padding: 0 !important; overflow: visible !important;
}
.bd-article { padding: 4px !important; }
.toctree-wrapper > span[id^="document-"] + section { break-before: page; }
.bd-article h1 { display: block !important; font-size: 2rem; }
.bd-article h2 { font-size: 1.6rem; }
h1, h2, h3, h4 { break-after: avoid; }
figure, tr, .admonition, .sd-card, mjx-container { break-inside: avoid; }
img { max-width: 100% !important; }
pre { white-space: pre-wrap !important; overflow: visible !important; }
.pst-scrollable-table-container, .cell_output, div.math { overflow: visible !important; }
a { text-decoration: none; }
.sd-row { --sd-gutter-x: 0; }
nav.contents-of-print a { display: block; margin: 0.2rem 0; }
"""

PREPARE = """() => {
  const drop = selector => document.querySelectorAll(selector).forEach(element => element.remove());
  drop(".bd-header, .bd-header-article, .bd-sidebar-primary, .bd-sidebar-secondary, .sbt-scroll-pixel-helper");
  drop(".prev-next-footer, .bd-footer, .bd-footer-content, .bd-footer-article, .skip-link, #pst-back-to-top, dialog");
  drop(".headerlink, .jupyter-widgets, .turning-view, .only-dark, .copybtn");
  // Code that lies open is printed, folded code is not, and of a folded answer what it shows.
  drop(".tag_hide-input .cell_input, .tag_hide-input > details, .tag_hide-cell .cell_input, .tag_hide-cell summary");
  for (const answer of document.querySelectorAll(".tag_hide-cell > details")) answer.replaceWith(...answer.childNodes);
  drop(".search-button__wrapper, .pst-async-banner-revealer, #pst-primary-sidebar-modal, .sidebar-toggle");
  drop("#jb-print-docs-body, .article-header-buttons");
  // Every page counts its own citations from id1; the bibliography's entries are what links lead to.
  for (const entry of document.querySelectorAll("div.citation[id]"))
    for (const other of document.querySelectorAll(`[id="${entry.id}"]`))
      if (other !== entry) other.removeAttribute("id");
  // A link inside the book stays; one to a file beside the page would lead nowhere on paper.
  for (const link of document.querySelectorAll("a[href]")) {
    const target = new URL(link.href);
    if (target.origin !== location.origin) continue;
    if (target.pathname === location.pathname && document.getElementById(decodeURIComponent(target.hash.slice(1))))
      link.setAttribute("href", target.hash);
    else link.removeAttribute("href");
  }
  // The list of chapters, after what the first page says.
  const list = document.createElement("nav");
  list.className = "contents-of-print";
  list.innerHTML = "<p><strong>Contents</strong></p>";
  for (const page of document.querySelectorAll(".toctree-wrapper > span[id^='document-'] + section")) {
    const link = document.createElement("a");
    link.href = "#" + page.previousElementSibling.id;
    link.textContent = page.querySelector("h2").textContent;
    list.append(link);
  }
  document.querySelector(".toctree-wrapper").before(list);
}"""

# Shrink what is wider than the paper; say what still is.
FIT = """() => {
  const room = document.querySelector(".bd-article").getBoundingClientRect().right;
  for (const element of document.querySelectorAll(".bd-article table, mjx-container[display=true], .bd-article pre")) {
    const box = element.getBoundingClientRect();
    const width = Math.max(box.width, element.scrollWidth);
    if (box.left + width > room) element.style.zoom = (room - box.left) / (width + 1);
  }
  return [...document.querySelectorAll(".bd-article *")]
    .filter(element => !element.closest("mjx-assistive-mml, .visually-hidden, svg"))
    .filter(element => element.getBoundingClientRect().right > room + 2)
    .map(element => element.outerHTML.slice(0, 160));
}"""


class QuietHandler(SimpleHTTPRequestHandler):
    """Serves files without a word."""

    def log_message(self, *_: object) -> None:
        """Say nothing."""


def lay_out(page: Page, address: str) -> None:
    """Open the page and bring it into the form for paper.

    Raises
    ------
    RuntimeError
        If something is wider than the paper, or an equation cannot be set.
    """
    page.emulate_media(media="print", color_scheme="light")
    page.goto(address, wait_until="load")
    page.add_style_tag(content=STYLE)
    page.evaluate("async () => { await MathJax.startup.promise; await document.fonts.ready; }")
    page.evaluate(PREPARE)
    page.locator("img").evaluate_all(
        "images => Promise.all(images.map(i => { i.loading = 'eager'; return i.decode(); }))"
    )
    wide = page.evaluate(FIT)
    if wide:
        raise RuntimeError(f"{len(wide)} elements are wider than the paper: " + " ".join(wide[:5]))
    if page.locator("mjx-merror").count():
        raise RuntimeError("an equation cannot be set: " + page.locator("mjx-merror").first.inner_text())


def print_book(source: Path, target: Path) -> None:
    """Print `source` to `target`; the file appears whole or not at all."""
    chromium = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if chromium is None:
        raise RuntimeError("Chromium is missing; on Debian and Ubuntu: sudo apt-get install chromium")
    handler = functools.partial(QuietHandler, directory=str(source.parent))
    with ThreadingHTTPServer(("127.0.0.1", 0), handler) as server, sync_playwright() as playwright:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        here = f"http://127.0.0.1:{server.server_port}/"
        browser = playwright.chromium.launch(executable_path=chromium, args=FLAGS)
        page = browser.new_page(viewport={"width": WIDTH, "height": 1200})
        # The whole book is one page: beside other work it takes longer to load than the half minute of a usual one.
        page.set_default_timeout(180_000)

        def guard(route: Route) -> None:
            if route.request.url.startswith(here):
                route.continue_()
            else:
                route.abort()

        page.route("**/*", guard)
        lay_out(page, here + source.name)
        unfinished = target.with_name(f".{target.stem}.{os.getpid()}.pdf")
        page.pdf(
            path=unfinished,
            format="A4",
            scale=SCALE,
            margin=dict.fromkeys(("top", "bottom", "left", "right"), MARGIN),
            print_background=True,
            display_header_footer=True,
            header_template="<span></span>",
            footer_template=FOOTER,
            outline=True,
            tagged=True,
        )
        browser.close()
        server.shutdown()
    unfinished.replace(target)


def main(arguments: list[str]) -> int:
    """Run the command line; return the exit code."""
    parser = argparse.ArgumentParser(description="Print the book to one PDF.")
    parser.add_argument("source", type=Path)
    parser.add_argument("target", type=Path)
    options = parser.parse_args(arguments)
    try:
        print_book(options.source, options.target)
    except RuntimeError as problem:
        sys.stderr.write(f"{problem}\n")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
