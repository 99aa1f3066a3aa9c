"""Time how long the reader of the explorer's page waits for the first map, from opening its address.

Run from the repository root: ``python -m benchmarks.bench_page``. Needs Chromium. Wall seconds on a machine that should
do nothing else, and processor seconds of Voilà and its kernels: once while the kernel is still being made ready, as
after ``facegear explore``, and then with one that is.
"""

from __future__ import annotations

import os
import shutil
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request

import psutil
from playwright.sync_api import Browser, sync_playwright

from facegear.drives.live import READY

FLAGS = ["--headless=new", "--no-sandbox", "--disable-background-networking"]
# Processor seconds a second below which Voilà has nothing more to make ready.
IDLE = 0.05


def processor_seconds(server: psutil.Process) -> float:
    """Return what the server and its kernels have used."""
    used = 0.0
    for process in (server, *server.children(recursive=True)):
        try:
            times = process.cpu_times()
        except psutil.NoSuchProcess:
            continue
        used += times.user + times.system
    return used


def wait_until_idle(server: psutil.Process) -> None:
    """Wait until kernels have run the notebook, without work for longer than they wait before they begin."""
    quiet = 0
    while quiet < 7:
        before = processor_seconds(server)
        time.sleep(1.0)
        quiet = quiet + 1 if processor_seconds(server) - before < IDLE else 0


def seconds_to_map(browser: Browser, address: str) -> float:
    """Wall seconds from opening the page to its map and its cell."""
    page = browser.new_page(viewport={"width": 1440, "height": 1100})
    page.set_default_timeout(300e3)
    started = time.perf_counter()
    page.goto(address, wait_until="commit")
    page.locator(".heatmaplayer image").first.wait_for(state="attached")
    page.locator("img.facegear-cell").wait_for()
    seconds = time.perf_counter() - started
    page.close()
    return seconds


def answers(address: str) -> bool:
    """Whether the server is there."""
    try:
        with urllib.request.urlopen(f"{address}voila/static/main.js", timeout=5):
            return True
    except urllib.error.HTTPError:
        return True
    except OSError:
        return False


def main() -> int:
    """Print the table."""
    chromium = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if chromium is None:
        sys.stdout.write("Chromium is missing: nothing measured\n")
        return 0
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = int(probe.getsockname()[1])
    address = f"http://127.0.0.1:{port}/"
    command = [sys.executable, "-m", "voila", "notebooks/explorer.ipynb", *READY, "--no-browser"]
    command += [f"--port={port}", "--Voila.ip=127.0.0.1", "--Voila.log_level=ERROR"]
    started = time.perf_counter()
    with subprocess.Popen(
        command, stderr=subprocess.DEVNULL, env=os.environ | {"OMP_NUM_THREADS": "1"}
    ) as running:
        try:
            server = psutil.Process(running.pid)
            while not answers(address):
                time.sleep(0.05)
            sys.stdout.write(f"{'server answers after':40s}{time.perf_counter() - started:9.2f} s\n")
            with sync_playwright() as play:
                browser = play.chromium.launch(executable_path=chromium, args=FLAGS)
                for name in ("first map, kernel not yet ready", "first map, kernel ready", "once more"):
                    used, seconds = processor_seconds(server), seconds_to_map(browser, address)
                    used = processor_seconds(server) - used
                    sys.stdout.write(f"{name:40s}{seconds:9.2f} s, of a processor {used:.2f} s\n")
                    sys.stdout.flush()
                    wait_until_idle(server)
                browser.close()
        finally:
            running.terminate()
    return 0


if __name__ == "__main__":
    sys.exit(main())
