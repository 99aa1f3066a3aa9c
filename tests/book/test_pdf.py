"""The printed book: `make pdf`, then `make test-book`."""

import io
import re
import shutil
import unicodedata
from collections.abc import Iterator, Mapping
from pathlib import Path

import nbformat
import pytest
import yaml
from playwright.sync_api import Browser, Page, Playwright
from pypdf import PdfReader
from pypdf.generic import ArrayObject, ContentStream, Destination

from tools.print_book import FLAGS, lay_out

pytestmark = [pytest.mark.book, pytest.mark.takes(20)]

ROOT = Path(__file__).resolve().parents[2]
PDF = ROOT / "build" / "facegear.pdf"
# Operators that draw a path, as Chromium writes them: one a row, after their numbers.
LINES = re.compile(rb"^[-+.\d ]+ (?:m|l|c|v|y|re)\n", re.MULTILINE)


@pytest.fixture(scope="module")
def reader() -> PdfReader:
    assert PDF.is_file(), "there is no PDF to look at: run `make pdf` first"
    return PdfReader(PDF)


@pytest.fixture(scope="module")
def extracted(reader: PdfReader) -> tuple[list[str], str]:
    """Return the text of each page, and what is no code. Lines of figures, most of a page, are not even taken apart."""
    prose: list[str] = []

    def note(
        part: str, _matrix: object, _place: object, font: Mapping[str, str] | None, _size: float
    ) -> None:
        if "Mono" not in (font or {}).get("/BaseFont", ""):
            prose.append(part)

    parse = ContentStream._parse_content_stream
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(
            ContentStream,
            "_parse_content_stream",
            lambda content, stream: parse(content, io.BytesIO(LINES.sub(b"", stream.read()))),
        )
        return [page.extract_text(visitor_text=note) for page in reader.pages], " ".join(prose)


@pytest.fixture(scope="module")
def texts(extracted: tuple[list[str], str]) -> list[str]:
    return extracted[0]


@pytest.fixture(scope="module")
def text(texts: list[str]) -> str:
    # The browser's fonts set fi and fl as one sign.
    return " ".join(unicodedata.normalize("NFKC", " ".join(texts)).split())


def titles() -> list[str]:
    """Return the title of every page the table of contents names, in its order."""
    contents = yaml.safe_load((ROOT / "book" / "_toc.yml").read_text(encoding="utf-8"))
    names = [contents["root"]]
    names += [chapter["file"] for part in contents["parts"] for chapter in part["chapters"]]
    found = []
    for name in names:
        notebook, page = ROOT / f"{name}.ipynb", ROOT / "build" / "book-src" / f"{name}.md"
        source = (
            nbformat.read(notebook, as_version=4).cells[0].source
            if notebook.is_file()
            else page.read_text(encoding="utf-8")
        )
        found.append(re.search(r"^# (.+)$", source, re.MULTILINE)[1])
    return found


def outline(entries: list[Destination | list]) -> Iterator[str]:
    for entry in entries:
        if isinstance(entry, list):
            yield from outline(entry)
        else:
            yield entry.title


def test_every_page_of_the_book_is_in_it(reader: PdfReader, text: str) -> None:
    assert len(reader.pages) > 3 * len(titles())
    # Chromium drops the space at which a heading goes on to the next line.
    listed = [entry.replace(" ", "") for entry in outline(reader.outline)]
    places = []
    for title in titles():
        assert title in text
        places.append(listed.index(title.replace(" ", "")))
    assert places == sorted(places)


def test_equations_are_set(extracted: tuple[list[str], str]) -> None:
    _, prose = extracted
    assert "Floquet transition matrix" in prose
    assert not re.search(r"\$\$|\\\(|\\\[|\\begin\{|\\frac|\\Omega", prose)
    assert prose.count("$") == 0


def test_code_that_lies_open_is_printed_and_bookkeeping_is_not(text: str) -> None:
    assert "import facegear as fg" in text
    assert "fg.stability_map(" in text
    assert "chapter.finish()" not in text


def test_pages_are_a4_and_none_is_empty(reader: PdfReader, texts: list[str]) -> None:
    for number, page in enumerate(reader.pages, start=1):
        assert [round(float(side) / 72 * 25.4) for side in page.mediabox[2:]] == [210, 297], number
    assert not [number for number, text in enumerate(texts, start=1) if not text.strip()]


def test_links_stay_inside_or_lead_to_the_web(reader: PdfReader) -> None:
    inside = 0
    for page in reader.pages:
        for annotation in page.get("/Annots", ArrayObject()):
            link = annotation.get_object()
            if link["/Subtype"] != "/Link":
                continue
            if "/A" in link and "/URI" in link["/A"]:
                assert re.match(r"https?://(?!127\.|localhost)", link["/A"]["/URI"]), link
            else:
                target = link["/Dest"] if "/Dest" in link else link["/A"]["/D"]
                assert not isinstance(target, str) or target in reader.named_destinations
                inside += 1
    assert inside > len(titles())


@pytest.fixture(scope="module")
def browser(chromium_driver: Playwright) -> Iterator[Browser]:
    found = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    assert found, "Chromium is missing: apt-get install chromium"
    running = chromium_driver.chromium.launch(executable_path=found, args=FLAGS)
    yield running
    running.close()


@pytest.fixture
def sheet(browser: Browser) -> Iterator[Page]:
    page = browser.new_page(viewport={"width": 800, "height": 600})
    yield page
    page.close()


def page_with(tmp_path: Path, content: str) -> str:
    path = tmp_path / "page.html"
    path.write_text(
        "<script>MathJax = {startup: {promise: Promise.resolve()}}</script>"
        f"<article class='bd-article'>{content}<div class='toctree-wrapper'></div></article>",
        encoding="utf-8",
    )
    return path.as_uri()


def test_a_wide_table_shrinks_to_the_paper(sheet: Page, tmp_path: Path) -> None:
    cells = "".join(f"<td>{'x' * 12}</td>" for _ in range(20))
    lay_out(sheet, page_with(tmp_path, f"<table><tr>{cells}</tr></table>"))
    assert sheet.locator("table").bounding_box()["width"] <= 800


def test_what_cannot_shrink_stops_the_print(sheet: Page, tmp_path: Path) -> None:
    with pytest.raises(RuntimeError, match="1 elements are wider than the paper"):
        lay_out(sheet, page_with(tmp_path, "<div style='width: 1200px'>wide</div>"))


def test_an_equation_that_cannot_be_set_stops_the_print(sheet: Page, tmp_path: Path) -> None:
    with pytest.raises(RuntimeError, match="an equation cannot be set"):
        lay_out(sheet, page_with(tmp_path, "<mjx-merror>Missing brace</mjx-merror>"))
