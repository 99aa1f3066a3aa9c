"""The explorer as a page of its own, in Chromium: a control, a click, and the network cut off."""

import os
import shutil
import signal
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request
from collections.abc import Callable, Iterator
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from playwright.sync_api import Page, Playwright, Route

from facegear.drives.drive_file import read_drive_file
from facegear.drives.live import READY

pytestmark = [pytest.mark.book, pytest.mark.takes(30)]

ROOT = Path(__file__).resolve().parents[2]
FLAGS = ["--headless=new", "--no-sandbox", "--disable-background-networking"]
PATIENCE = 180.0  # [s]; a kernel has to start on a machine that may be busy
# A few icons that Voilà's own template would fetch; nothing on this page uses them.
ICONS = "/npm/@fortawesome/fontawesome-free"


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """Start Voilà as `make explorer` does and wait until it answers."""
    assert f"notebooks/explorer.ipynb {' '.join(READY)}" in (ROOT / "Makefile").read_text(encoding="utf-8")
    port = free_port()
    command = [sys.executable, "-m", "voila", "notebooks/explorer.ipynb", *READY, "--no-browser"]
    command += [f"--port={port}", "--Voila.ip=127.0.0.1"]
    log = tmp_path_factory.mktemp("voila") / "log.txt"
    with log.open("w", encoding="utf-8") as messages:
        running = subprocess.Popen(
            command, cwd=ROOT, stdout=messages, stderr=messages, env=os.environ | {"OMP_NUM_THREADS": "1"}
        )
    try:
        wait_for(lambda: answers(port) or running.poll() is not None)
        assert running.poll() is None, log.read_text(encoding="utf-8")
        yield f"http://127.0.0.1:{port}/"
    finally:
        running.terminate()
        running.wait(30)


def answers(port: int) -> bool:
    try:
        with urllib.request.urlopen(f"http://127.0.0.1:{port}/voila/static/main.js", timeout=5):
            return True
    except urllib.error.HTTPError:
        return True
    except OSError:
        return False


def wait_for(condition: Callable[[], bool]) -> None:
    end = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < end, "waited too long"
        time.sleep(0.1)


def picture_of_the_map(page: Page) -> str | None:
    return page.locator(".heatmaplayer image").first.evaluate(
        "image => image.getAttribute('xlink:href') || image.getAttribute('href')"
    )


def test_explorer_follows_controls_and_clicks_without_a_network(
    address: str, chromium_driver: Playwright
) -> None:
    found = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    assert found, "Chromium is missing: apt-get install chromium"
    strangers: list[str] = []
    complaints: list[str] = []

    def guard(route: Route) -> None:
        parts = urlsplit(route.request.url)
        if parts.hostname == "127.0.0.1" or parts.scheme in ("data", "blob"):
            route.continue_()
            return
        if not parts.path.startswith(ICONS):
            strangers.append(route.request.url)
        route.abort()

    browser = chromium_driver.chromium.launch(executable_path=found, args=FLAGS)
    page = browser.new_page(viewport={"width": 1440, "height": 1100})
    page.set_default_timeout(PATIENCE * 1e3)
    page.route("**/*", guard)
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.goto(address)
    page.locator("img.facegear-cell").wait_for()
    page.locator(".heatmaplayer image").first.wait_for(state="attached")

    report, cell = page.locator(".facegear-report"), page.locator("img.facegear-cell")
    assert ": stable" in report.inner_text()
    drawn = cell.get_attribute("src")
    box = page.locator(".js-plotly-plot .nsewdrag").first.bounding_box()
    assert box is not None
    # In the middle of the speeds and low on the axis of bearing stiffness there is a tongue.
    page.mouse.move(box["x"] + 0.5 * box["width"], box["y"] + 0.92 * box["height"])
    page.mouse.click(box["x"] + 0.5 * box["width"], box["y"] + 0.92 * box["height"])
    wait_for(lambda: "(1+8)/1" in report.inner_text() and cell.get_attribute("src") != drawn)

    before, words = picture_of_the_map(page), report.inner_text()
    page.locator(".widget-hslider:has-text('pinion mass') .noUi-handle").press("PageDown")
    wait_for(lambda: picture_of_the_map(page) != before)
    wait_for(lambda: report.inner_text() != words)

    assert not page.locator("[role=alert]").count()
    page.locator(".widget-hslider:has-text('teeth of the face gear') .noUi-handle").press("Home")
    page.locator(".widget-hslider:has-text('teeth of the pinion') .noUi-handle").press("End")
    page.locator("[role=alert]").wait_for()
    assert "gear_teeth must exceed pinion_teeth" in page.locator("[role=alert]").inner_text()
    browser.close()
    assert not strangers
    assert not complaints


def test_the_command_explores_a_drive_file_and_saves_it(tmp_path: Path, chromium_driver: Playwright) -> None:
    found = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    assert found, "Chromium is missing: apt-get install chromium"
    shutil.copy(ROOT / "data" / "drives" / "example_b.yaml", tmp_path / "my.yaml")
    port = free_port()
    command = [sys.executable, "-m", "facegear", "explore", "my.yaml", "--no-browser", "--port", str(port)]
    with (tmp_path / "log.txt").open("w", encoding="utf-8") as messages:
        running = subprocess.Popen(
            command, cwd=tmp_path, stdout=messages, stderr=messages, env=os.environ | {"OMP_NUM_THREADS": "1"}
        )
    try:
        wait_for(lambda: answers(port) or running.poll() is not None)
        assert running.poll() is None, (tmp_path / "log.txt").read_text(encoding="utf-8")
        browser = chromium_driver.chromium.launch(executable_path=found, args=FLAGS)
        page = browser.new_page(viewport={"width": 1440, "height": 1100})
        page.set_default_timeout(PATIENCE * 1e3)
        page.goto(f"http://127.0.0.1:{port}/")
        page.locator("img.facegear-cell").wait_for()
        page.get_by_role("button", name="Save as drive file").click()
        page.get_by_text("Saved: ").wait_for()
        browser.close()
    finally:
        running.send_signal(signal.SIGINT)
        assert running.wait(30) == 130
    file, saved = (read_drive_file(tmp_path / name) for name in ("my.yaml", "my_drive.yaml"))
    assert saved.transverse.gear.body == file.transverse.gear.body
    assert saved.transverse.gear.load == file.transverse.gear.load
