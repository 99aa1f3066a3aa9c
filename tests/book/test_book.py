"""The built book, looked at in Chromium: `make book`, then `make test-book`."""

import contextlib
import functools
import os
import re
import shutil
import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from html.parser import HTMLParser
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any
from urllib.parse import parse_qs, unquote, urlsplit

import pytest
import yaml
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Browser, BrowserContext, ConsoleMessage, Locator, Page, Playwright, Request
from playwright.sync_api import TimeoutError as PlaywrightTimeoutError

pytestmark = pytest.mark.book

ROOT = Path(__file__).resolve().parents[2]
PAGES = ROOT / "build" / "_build" / "html"
# What Jupyter Book 1 itself says on every page; see sphinx-thebe and pydata-sphinx-theme.
KNOWN_MESSAGES = re.compile(r"'THEBE_JS_URL' has already been declared|Got invalid theme mode")
FLAGS = ["--headless=new", "--no-sandbox", "--disable-background-networking", "--enable-unsafe-swiftshader"]
# No name of a machine leads anywhere. (To intercept every request instead would turn off the browser's cache.)
FLAGS += ["--host-resolver-rules=MAP * ~NOTFOUND , EXCLUDE 127.0.0.1"]
LOWEST_CONTRAST = 4.5  # WCAG 2.2, level AA, for text of ordinary size


# Violations of axe-core's rules that are not this book's to mend: rule, selector, why. None so far.
NOT_OURS: dict[tuple[str, str], str] = {}


def pages_of_the_book() -> list[str]:
    """Return the addresses that the table of contents names, and those Sphinx adds."""
    contents = yaml.safe_load((ROOT / "book" / "_toc.yml").read_text(encoding="utf-8"))
    chapters = [chapter["file"] for part in contents["parts"] for chapter in part["chapters"]]
    return [f"{name}.html" for name in [contents["root"], *chapters]]


@dataclass
class Visit:
    """A page that has been opened, and what it has done since."""

    page: Page
    complaints: list[str] = field(default_factory=list)
    strangers: list[str] = field(default_factory=list)


class QuietHandler(SimpleHTTPRequestHandler):
    def log_message(self, *_: object) -> None:
        pass


@pytest.fixture(scope="session")
def server() -> Iterator[str]:
    assert (PAGES / "index.html").is_file(), "there is no book to look at: run `make book` first"
    handler = functools.partial(QuietHandler, directory=str(PAGES))
    with ThreadingHTTPServer(("127.0.0.1", 0), handler) as running:
        thread = threading.Thread(target=running.serve_forever)
        thread.start()
        yield f"http://127.0.0.1:{running.server_port}/"
        running.shutdown()
        thread.join()


@pytest.fixture(scope="session")
def browser(chromium_driver: Playwright) -> Iterator[Browser]:
    found = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    assert found, "Chromium is missing: apt-get install chromium"
    running = chromium_driver.chromium.launch(executable_path=found, args=FLAGS)
    yield running
    running.close()


def opened_page(context: BrowserContext, server: str, address: str, width: int) -> Visit:
    """Open a page of the book and wait until it stands."""
    visit = Visit(context.new_page())
    page = visit.page

    def note(request: Request) -> None:
        if not request.url.startswith((server, f"blob:{server}")):
            visit.strangers.append(request.url)

    def complain(text: str) -> None:
        if not KNOWN_MESSAGES.search(text):
            visit.complaints.append(text)

    def listen(message: ConsoleMessage) -> None:
        if message.type == "error":
            complain(f"{message.text} ({message.location.get('url', '')})")

    page.on("request", note)
    page.on("console", listen)
    page.on("pageerror", lambda error: complain(str(error)))
    page.set_viewport_size({"width": width, "height": 900})
    page.goto(server + address, wait_until="load")
    page.evaluate("async () => { if (window.MathJax) await MathJax.startup.promise; }")
    if page.locator("script[type='application/vnd.jupyter.widget-view+json']").count():
        page.wait_for_selector(".jupyter-widgets")
    for view in page.locator(".turning-view").all():
        view.locator("canvas").first.wait_for()
    return visit


@pytest.fixture(scope="session")
def contexts(browser: Browser) -> Iterator[dict[str, BrowserContext]]:
    """One reader who prefers light colours and one who prefers dark ones; each keeps what it has fetched."""
    readers = {scheme: browser.new_context(color_scheme=scheme) for scheme in ("light", "dark")}
    yield readers
    for reader in readers.values():
        reader.close()


@pytest.fixture
def visit(server: str, contexts: dict[str, BrowserContext]) -> Iterator[Callable[..., Visit]]:
    """Open any page for one test alone."""
    opened = []

    def open_page(address: str, width: int = 1440, scheme: str = "light") -> Visit:
        opened.append(opened_page(contexts[scheme], server, address, width))
        return opened[-1]

    yield open_page
    for done in opened:
        done.page.close()


# conftest.py lets one worker do all tests of a page while it has the page open.
@pytest.fixture(scope="module", params=pages_of_the_book())
def address(request: pytest.FixtureRequest) -> str:
    """Every page of the book in turn."""
    return request.param


@pytest.fixture(scope="module")
def look(
    server: str, contexts: dict[str, BrowserContext], address: str
) -> Iterator[Callable[[int, str], Visit]]:
    """Show the page at hand, which is opened once: light on a telephone.

    From there it is made as wide or narrow as wanted, the way a window is or a telephone that is turned, and light or
    dark, the way a machine changes that in the evening. The title page is opened in dark as well.
    """
    opened: list[Visit] = []

    def show(width: int, scheme: str) -> Visit:
        if not opened:
            opened.append(opened_page(contexts["light"], server, address, NARROWEST))
        page = opened[0].page
        page.set_viewport_size({"width": width, "height": 900})
        page.emulate_media(color_scheme=scheme)
        page.evaluate(SETTLED)
        return opened[0]

    yield show
    for visit in opened:
        visit.page.close()


NARROWEST, WIDEST = 375, 1920
# Two frames later, and when colours that change gradually have changed.
SETTLED = """async () => {
  for (let k = 0; k < 2; k++) await new Promise(done => requestAnimationFrame(() => done()));
  const changes = document.getAnimations().filter(each => each instanceof CSSTransition);
  changes.forEach(each => each.finish());
}"""


@pytest.mark.parametrize(
    ("width", "scheme"),
    [(NARROWEST, "light"), (1280, "light"), (WIDEST, "dark"), (768, "dark"), (NARROWEST, "dark")],
)
def test_page_is_whole_and_readable(look: Callable[[int, str], Visit], width: int, scheme: str) -> None:
    opened = look(width, scheme)
    page = opened.page
    assert page.evaluate("document.documentElement.dataset.theme") == scheme

    # A view draws itself anew some moments after the page has become narrower.
    with contextlib.suppress(PlaywrightTimeoutError):
        page.wait_for_function(f"width => !({OVERFLOW})(width).length", arg=width, timeout=30_000)
    assert not page.evaluate(OVERFLOW, width)

    assert (
        page.locator(".bd-article .math").count()
        == page.locator(".bd-article .math:has(mjx-container)").count()
    )
    assert page.locator("mjx-merror").count() == 0
    if width >= 1280:
        assert not page.evaluate(CUT_FORMULAS)
        assert not page.evaluate(CUT_TABLES)
    assert not re.search(r"\$\$|\\\(|\\\[|\\begin\{", page.locator(".bd-article").evaluate(TEXT_OUTSIDE_CODE))

    for picture in page.locator("img").evaluate_all(PICTURES):
        # Without words Sphinx puts the name of the file there.
        assert picture["alt"].strip(), picture
        assert not picture["alt"].endswith((".svg", ".png")), picture
        assert picture["natural"] > 0, picture
        assert not picture["shown"] or picture["background"] >= 0.8 or not picture["figure"], picture

    faint = page.evaluate(FAINT_TEXT, LOWEST_CONTRAST)
    assert not faint

    assert not opened.strangers
    assert not opened.complaints


# What is wider than the page without a scroll bar of its own; the theme would clip it without a trace.
OVERFLOW = """width => {
  if (innerWidth !== width) return [`the window is ${innerWidth} wide`];
  const whole = document.documentElement.scrollWidth;
  if (whole > width) return [`the page is ${whole} wide`];
  const scrolls = element => ["auto", "scroll"].includes(getComputedStyle(element).overflowX);
  const article = document.querySelector(".bd-article");
  const inside = element => {
    for (let e = element.parentElement; e !== article; e = e.parentElement) if (scrolls(e)) return true;
    return false;
  };
  return [...article.querySelectorAll("*")]
    .filter(element => !element.closest("mjx-assistive-mml, .visually-hidden"))
    .filter(element => element.getBoundingClientRect().right > innerWidth + 1 && !inside(element))
    .map(element => element.outerHTML.slice(0, 120));
}"""

# Tables of which columns are out of sight.
CUT_TABLES = """() => [...document.querySelectorAll(".bd-article table")]
  .filter(table => [".pst-scrollable-table-container", ".text_html", "div.table"]
    .map(box => table.closest(box))
    .some(box => box !== null && box.clientWidth > 0 && box.scrollWidth > box.clientWidth + 1))
  .map(table => table.innerText.slice(0, 60))"""

# Displayed formulas that would have to be scrolled.
CUT_FORMULAS = """() => [...document.querySelectorAll('mjx-container[display="true"]')]
  .filter(formula => {
    const [place, own] = [formula, formula.querySelector("mjx-math")].map(e => e.getBoundingClientRect().width);
    return place > 0 && own > place + 1;
  })
  .map(formula => formula.textContent.slice(0, 60))"""

TEXT_OUTSIDE_CODE = """article => {
  const copy = article.cloneNode(true);
  copy.querySelectorAll("pre, code, script, mjx-container").forEach(element => element.remove());
  return copy.textContent;
}"""

# Relative luminance after WCAG 2.2; a colour is what `getComputedStyle` returns.
LUMINANCE = """
  const channels = colour => (colour.match(/[\\d.]+/g) || []).map(Number);
  const linear = c => (c /= 255) <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
  const luminance = ([r, g, b]) => 0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b);
  const background = element => {
    for (let e = element; e; e = e.parentElement) {
      const c = channels(getComputedStyle(e).backgroundColor);
      if (c.length === 3 || c[3] > 0.5) return c;
    }
    return [255, 255, 255];
  };
"""

PICTURES = (
    "images => {"
    + LUMINANCE
    + """
  return images.map(image => ({
    source: image.src.slice(0, 80), alt: image.alt, natural: image.naturalWidth,
    shown: image.getBoundingClientRect().width > 0,
    figure: image.closest(".cell_output") !== null,
    background: luminance(background(image)),
  }));
}"""
)

FAINT_TEXT = (
    "lowest => {"
    + LUMINANCE
    + """
  const faint = [];
  const walker = document.createTreeWalker(document.querySelector(".bd-article"), NodeFilter.SHOW_TEXT);
  while (walker.nextNode()) {
    const element = walker.currentNode.parentElement;
    if (!walker.currentNode.data.trim() || !element.checkVisibility({ opacityProperty: true })) continue;
    if (element.closest("script, style, mjx-container, svg, .turning-view, .headerlink")) continue;
    const ink = channels(getComputedStyle(element).color);
    let opacity = ink.length > 3 ? ink[3] : 1;
    for (let e = element; e; e = e.parentElement) opacity *= Number(getComputedStyle(e).opacity);
    const paper = background(element);
    const seen = [0, 1, 2].map(i => opacity * ink[i] + (1 - opacity) * paper[i]);
    const [low, high] = [luminance(seen), luminance(paper)].sort((a, b) => a - b);
    const contrast = (high + 0.05) / (low + 0.05);
    if (contrast < lowest) faint.push([walker.currentNode.data.trim().slice(0, 60), contrast.toFixed(2)]);
  }
  return faint;
}"""
)


def test_network_is_cut_off_and_whoever_asks_for_it_is_noted(
    server: str, visit: Callable[..., Visit]
) -> None:
    opened = visit("genindex.html")
    assert not opened.strangers
    elsewhere = server.replace("127.0.0.1", "localhost")
    asked = "url => fetch(url, {mode: 'no-cors'}).then(() => 'reached', () => 'cut off')"
    assert opened.page.evaluate(asked, server) == "reached"
    assert opened.page.evaluate(asked, elsewhere) == "cut off"
    assert opened.strangers == [elsewhere]
    assert opened.complaints


def test_axe_would_find_a_violation(browser: Browser) -> None:
    page = browser.new_page()
    faint = "<p style='color: #999'>faint</p><p style='color: #999; background: #000'>bright</p>"
    page.set_content(f"<html lang=en><title>t</title><main><h1>t</h1><img src=a.png>{faint}</main></html>")
    found = {rule["id"]: [node["html"] for node in rule["nodes"]] for rule in axe(page)["violations"]}
    page.close()
    assert "image-alt" in found
    assert [html.split(">")[1] for html in found["color-contrast"]] == ["faint</p"]


class Anchors(HTMLParser):
    """Collects what a page defines (ids) and what it points to."""

    def __init__(self) -> None:
        super().__init__()
        self.defined: set[str] = set()
        self.targets: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        for name, value in attrs:
            if name == "id" and value:
                self.defined.add(value)
            if name in ("href", "src") and value:
                self.targets.append(value)


@functools.cache
def parsed(path: Path) -> Anchors:
    anchors = Anchors()
    anchors.feed(path.read_text(encoding="utf-8"))
    return anchors


def test_links_inside_the_book_lead_somewhere(address: str) -> None:
    source = PAGES / address
    broken = []
    for link in parsed(source).targets:
        parts = urlsplit(link)
        if parts.scheme or parts.netloc:
            continue
        target = (source.parent / unquote(parts.path)).resolve() if parts.path else source
        if not target.is_file() or (
            parts.fragment
            and target.suffix == ".html"
            and unquote(parts.fragment) not in parsed(target).defined
        ):
            broken.append(link)
    assert not broken


def test_the_foot_names_version_and_commit(address: str) -> None:
    page = (PAGES / address).read_text(encoding="utf-8")
    (foot,) = re.findall(r'<div class="extra_footer">\s*(.*?)\s*</div>', page)
    assert re.fullmatch(r"Made by facegear \d+\.\d+\.\d+, commit [0-9a-f]{40}(\+changes)?\.", foot)


def test_buttons_open_files_of_the_repository(address: str) -> None:
    """Launch buttons name files by their path in the repository, where its address is known, and else there are none.

    tests/test_small_book.py builds pages with and without an address.
    """
    repository = os.environ.get("GITHUB_REPOSITORY")
    launched = [
        parts for parts in map(urlsplit, parsed(PAGES / address).targets) if parts.netloc == "mybinder.org"
    ]
    assert bool(launched) == (repository is not None and address.startswith("notebooks/"))
    for parts in launched:
        assert parts.path == f"/v2/gh/{repository}/main"
        (inside,) = parse_qs(parts.query)["urlpath"]
        assert (ROOT / inside.removeprefix("lab/tree/")).is_file(), inside


def test_there_is_a_slider_and_a_view_that_turns() -> None:
    texts = [(PAGES / address).read_text(encoding="utf-8") for address in pages_of_the_book()]
    assert any("SelectionSliderModel" in text or "IntSliderModel" in text for text in texts)
    assert any('class="turning-view"' in text for text in texts)


def reach_by_keyboard(page: Page, wanted: Locator) -> None:
    """Bring the focus to an element with the tabulator key, from the last element before it that takes focus."""
    wanted.evaluate(
        """element => {
          const all = [...document.querySelectorAll("a[href], button, summary, input, [tabindex='0']")];
          const before = all.filter(other => other.checkVisibility() && !other.disabled &&
            element.compareDocumentPosition(other) & Node.DOCUMENT_POSITION_PRECEDING);
          before.at(-1).focus();
        }"""
    )
    for _ in range(5):
        page.keyboard.press("Tab")
        if wanted.evaluate("element => element === document.activeElement"):
            return
    pytest.fail("the tabulator key does not lead to the slider")


def test_sliders_change_the_picture(look: Callable[[int, str], Visit]) -> None:
    opened = look(1440, "light")
    for slider in opened.page.locator(".jupyter-widgets.widget-vbox:has(.widget-slider)").all():

        def shown(widget: Locator = slider) -> list[str]:
            return [image.get_attribute("src") for image in widget.locator("img").all() if image.is_visible()]

        handle = slider.locator(".noUi-handle")
        before = shown()
        assert len(before) == 1
        reach_by_keyboard(opened.page, handle)
        opened.page.keyboard.press("ArrowRight")
        assert len(shown()) == 1
        assert shown() != before
        opened.page.keyboard.press("ArrowLeft")
        assert shown() == before
    assert not opened.complaints


def test_views_turn(look: Callable[[int, str], Visit]) -> None:
    opened = look(1440, "light")
    for view in opened.page.locator(".turning-view").all():
        view.scroll_into_view_if_needed()
        camera = "view => JSON.stringify(view.querySelector('.js-plotly-plot')._fullLayout.scene._scene.getCamera())"
        before = view.evaluate(camera)
        box = view.bounding_box()
        x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
        opened.page.mouse.move(x, y)
        opened.page.mouse.down()
        opened.page.mouse.move(x + 120, y + 40, steps=8)
        opened.page.mouse.up()
        assert view.evaluate(camera) != before
    assert not opened.complaints


# Below what listens for complaints: axe-core fetches style sheets by names that do not exist, in the same page.
# Everything is checked; of what passes, axe-core need not describe each element.
BRIEF = {"resultTypes": ["violations"]}

# To find the paper under each word axe-core takes the colours of all that is around it to numbers, on a large page a
# hundred thousand times, of a dozen colours.
COLOURS_READ_ONCE = """() => {
  const colour = axe.commons.color.Color.prototype;
  const read = colour.parseString;
  const known = new Map();
  colour.parseString = function (text) {
    if (!known.has(text)) {
      read.call(this, text);
      known.set(text, [this.r, this.g, this.b, this.alpha]);
    }
    [this.r, this.g, this.b, this.alpha] = known.get(text);
    return this;
  };
}"""


def axe(page: Page) -> dict[str, Any]:
    """Return what axe-core finds on a page."""
    if not page.evaluate("'axe' in window"):
        page.evaluate(Axe().axe_script)
        page.evaluate(COLOURS_READ_ONCE)
    return page.evaluate("options => axe.run(options)", BRIEF)


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_axe_finds_no_serious_violation(look: Callable[[int, str], Visit], scheme: str) -> None:
    opened = look(1440, scheme)
    for slider in opened.page.locator(".widget-slider").all():
        slider.locator(".noUi-handle[aria-label]").wait_for()
    found = axe(opened.page)
    assert found["passes"]
    grave = [
        (rule["id"], target, node["html"][:120])
        for rule in found["violations"]
        if rule["impact"] in ("serious", "critical")
        for node in rule["nodes"]
        for target in node["target"]
        if (rule["id"], target) not in NOT_OURS
    ]
    assert not grave


@pytest.mark.parametrize(
    ("word", "page"),
    [("Tregold", "notebooks/04_one_pinion.html"), ("undercutting", "notebooks/03_geometry_and_meshing.html")],
)
def test_search_finds_pages_without_a_network(visit: Callable[..., Visit], word: str, page: str) -> None:
    opened = visit(f"search.html?q={word}")
    opened.page.wait_for_function("document.querySelector('#search-results h2')?.textContent !== 'Searching'")
    found = opened.page.locator("#search-results li a").evaluate_all(
        "links => links.map(link => link.pathname)"
    )
    assert f"/{page}" in found
    assert not opened.strangers
    assert not opened.complaints


def test_search_is_reached_by_keyboard_from_any_page(visit: Callable[..., Visit]) -> None:
    opened = visit("intro.html")
    opened.page.keyboard.press("Control+k")
    opened.page.keyboard.type("Tregold")
    opened.page.keyboard.press("Enter")
    opened.page.wait_for_selector("#search-results li a")
    assert urlsplit(opened.page.url).path == "/search.html"
    assert not opened.strangers


def test_names_in_code_lead_to_their_place(visit: Callable[..., Visit]) -> None:
    page = visit("notebooks/04_one_pinion.html").page
    links = page.locator("a.code-link")
    targets = {
        urlsplit(address).fragment for address in links.evaluate_all("links => links.map(a => a.href)")
    }
    assert {"facegear.Drive", "facegear.Transverse", "facegear.stability_map"} <= targets
    links.first.click()
    page.wait_for_url("**/api.html#facegear.*")
    missing = [name for name in targets if page.locator(f'[id="{name}"]').count() != 1]
    assert not missing


def test_types_in_docstrings_lead_to_public_names_and_to_other_libraries(visit: Callable[..., Visit]) -> None:
    page = visit("api.html").page
    links = page.locator(".classifier a.reference, dt > strong > a.reference, dl.field-list dt a.reference")
    addresses = set(links.evaluate_all("links => links.map(link => link.href)"))
    stored = {
        line.split()[0]
        for path in (ROOT / "book" / "inventories").glob("*.txt")
        for line in path.read_text(encoding="utf-8").splitlines()[3:]
    }
    assert stored == {urlsplit(address).fragment for address in addresses if "/api.html" not in address}
    assert {"facegear.Drive", "facegear.Contact"} <= {urlsplit(address).fragment for address in addresses}


@pytest.mark.parametrize(("width", "said"), [(NARROWEST, True), (1280, False)])
def test_a_figure_that_moves_sideways_says_so(visit: Callable[..., Visit], width: int, said: bool) -> None:
    page = visit("notebooks/04_one_pinion.html", width=width).page
    figure = page.locator(".cell_output figure:has(> img)").first
    assert figure.evaluate("it => it.scrollWidth > it.clientWidth") is said
    hint = figure.evaluate("it => getComputedStyle(it.querySelector('figcaption'), '::before').content")
    assert ("sideways" in hint) is said


@pytest.mark.parametrize(
    ("name", "width", "box"),
    [
        ("notebooks/90_ledger.html", NARROWEST, ".pst-scrollable-table-container"),
        ("notebooks/04_one_pinion.html", NARROWEST, "div.math"),
        ("notebooks/90_ledger.html", 1280, ".pst-scrollable-table-container"),
        ("notebooks/your_drive.html", NARROWEST, "div.table"),
    ],
)
def test_tables_and_equations_that_move_sideways_say_so(
    visit: Callable[..., Visit], name: str, width: int, box: str
) -> None:
    page = visit(name, width=width).page
    page.wait_for_timeout(1000)  # formulas are set after the page has loaded
    wide, said = page.evaluate(
        """(box) => {
            const boxes = [...document.querySelectorAll(".bd-article " + box)];
            const parts = (it) => [it, it.querySelector("mjx-container[display=true]")].filter((part) => part);
            const wide = boxes.filter((it) => parts(it).some((part) => part.scrollWidth > part.clientWidth + 1));
            const words = (it) => getComputedStyle(it, "::before").content;
            return [wide.length, boxes.filter((it) => words(it).includes("sideways")).length];
        }""",
        box,
    )
    assert wide == said
    assert wide > 0 or width == 1280


def test_numbers_of_equations_stay_on_one_line(visit: Callable[..., Visit]) -> None:
    page = visit("nomenclature.html", width=NARROWEST).page
    numbers = page.locator(".unbroken").all()
    assert len(numbers) > 20
    assert all(number.evaluate("it => it.getClientRects().length") == 1 for number in numbers)


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_title_page_says_in_one_screen_what_the_book_is(visit: Callable[..., Visit], scheme: str) -> None:
    page = visit("intro.html", width=1200, scheme=scheme).page
    cards = page.locator(".sd-card").all()
    assert [card.locator(".sd-card-title").inner_text() for card in cards] == [
        "Read",
        "Rerun",
        "Use your drive",
    ]
    maps = [image for image in page.locator(".bd-article img").all() if image.is_visible()]
    assert [image.get_attribute("src").rsplit("_", 1)[1] for image in maps] == [f"{scheme}.svg"]
    for element in (*cards, *maps):
        box = element.bounding_box()
        assert box["y"] >= 0
        assert box["y"] + box["height"] <= 900
    for card in cards:
        assert card.locator("a").count()


def test_front_door_leads_to_the_introduction() -> None:
    assert 'url=intro.html"' in (PAGES / "index.html").read_text(encoding="utf-8")
