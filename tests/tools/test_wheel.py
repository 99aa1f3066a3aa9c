"""The wheel alone, in an environment with its dependencies and nothing else, called from a folder elsewhere."""

import os
import shutil
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest
import yaml
from packaging.requirements import Requirement

ROOT = Path(__file__).resolve().parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
PROGRAMS = "Scripts" if os.name == "nt" else "bin"
UV = [sys.executable, "-m", "uv"]
FLAGS = [
    "--headless=new",
    "--no-sandbox",
    "--disable-background-networking",
    "--host-resolver-rules=MAP * ~NOTFOUND",
]

pytestmark = [pytest.mark.slow, pytest.mark.takes(90)]


def done(*command, **options):
    finished = subprocess.run(
        [str(word) for word in command], capture_output=True, text=True, check=False, **options
    )
    assert finished.returncode == 0, finished.stderr
    return finished.stdout


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    folder = tmp_path_factory.mktemp("wheel")
    done(*UV, "build", "--quiet", "--wheel", "--out-dir", folder, cwd=ROOT)
    (path,) = folder.glob("*.whl")
    return path


@pytest.fixture(scope="module")
def environment(wheel, tmp_path_factory):
    """Install the wheel with what it needs."""
    folder = tmp_path_factory.mktemp("installed") / "environment"
    done(*UV, "venv", "--quiet", "--python", sys.executable, folder)
    done(*UV, "pip", "install", "--quiet", "--python", folder / PROGRAMS / "python", wheel)
    return folder


@pytest.fixture
def facegear(environment, tmp_path):
    # Nothing of the checkout is in reach.
    clean = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "VIRTUAL"))}
    clean |= {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}

    def call(*words, code=0):
        command = [str(environment / PROGRAMS / "facegear"), *words]
        finished = subprocess.run(
            command,
            capture_output=True,
            text=True,
            check=False,
            cwd=tmp_path,
            env=clean,
            stdin=subprocess.DEVNULL,
        )
        assert finished.returncode == code, finished.stderr
        return finished.stdout + finished.stderr

    return call


def test_the_wheel_holds_the_package_and_the_examples_and_nothing_else(wheel):
    names = zipfile.ZipFile(wheel).namelist()
    assert {name.split("/")[0] for name in names} == {"facegear", f"facegear-{PROJECT['version']}.dist-info"}
    examples = {Path(name).stem for name in names if name.startswith("facegear/drives/example_files/")}
    assert examples == {path.stem for path in (ROOT / "data" / "drives").glob("*.yaml")}
    assert not [name for name in names if "test" in name or name.endswith(".ipynb")]


def test_the_wheel_keeps_its_commit(environment):
    code = "from facegear.support.provenance import made_by; print(made_by()['facegear_commit'])"
    printed = done(environment / PROGRAMS / "python", "-I", "-c", code).strip()
    assert printed.removesuffix("+changes") == done("git", "rev-parse", "HEAD", cwd=ROOT).strip()


def test_only_what_pyproject_names_is_installed(environment):
    listed = done(
        *UV, "pip", "list", "--quiet", "--format", "freeze", "--python", environment / PROGRAMS / "python"
    )
    found = {line.split("==")[0].lower() for line in listed.splitlines()}
    wanted = {Requirement(text).name.lower() for text in PROJECT["dependencies"]}
    assert wanted | {"facegear"} <= found
    assert not {"ipython", "ipykernel", "ipywidgets", "nbformat", "jupyter-core", "numba", "plotly"} & found


def test_the_command_works_there(facegear, tmp_path):
    assert facegear("--version") == f"facegear {PROJECT['version']}\n"
    (tmp_path / "case_1.yaml").write_text(facegear("examples", "case_1"), encoding="utf-8")
    assert facegear("check", "case_1.yaml") == "case_1.yaml: can be used\n"
    values = {
        "--pinion-teeth": "26",
        "--gear-teeth": "130",
        "--diametral-pitch-per-inch": "8",
        "--thickness-ratio": "0.03",
        "--bore-radius-mm": "50",
        "--stiffness": "1",
        "--damping-us": "3",
        "--mass": "1",
        "--lowest-speed-rpm": "500",
        "--highest-speed-rpm": "600",
        "--power-hp": "600",
        "--pinion-speed-rpm": "5000",
    }
    facegear("new", "new.yaml", *(word for pair in values.items() for word in pair))
    assert facegear("check", "new.yaml") == "new.yaml: can be used\n"
    facegear("map", "new.yaml", "--cells", "8", "--jobs", "1")
    assert {path.suffix for path in tmp_path.glob("new_map.*")} == {".nc", ".csv", ".svg"}
    assert "facegear[explore]" in facegear("explore", code=1)


def test_a_report_made_there_opens_without_a_network(facegear, tmp_path):
    from playwright.sync_api import sync_playwright

    content = yaml.safe_load((ROOT / "data" / "drives" / "example_b.yaml").read_text(encoding="utf-8"))
    content["operation"] |= {"lowest_speed_rpm": 940}
    (tmp_path / "my.yaml").write_text(yaml.safe_dump(content), encoding="utf-8")
    told = facegear("report", "my.yaml", "--cells", "10", "--most-steps", "1")
    assert "section 12 of 12: Files" in told
    page = tmp_path / "my_results" / "report.html"
    found = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    assert found, "Chromium is missing: apt-get install chromium"
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=found, args=FLAGS)
        view = browser.new_page(viewport={"width": 390, "height": 900})
        asked, complaints = [], []
        view.on("request", lambda request: asked.append(request.url))
        view.on("console", lambda message: complaints.append(message.text))
        view.goto(page.as_uri())
        assert view.locator("h2").count() == 12
        widths = view.locator("img").evaluate_all("images => images.map(image => image.naturalWidth)")
        assert len(widths) == 5
        assert min(widths) > 100
        assert view.evaluate("document.documentElement.scrollWidth") <= 390
        assert [url for url in asked if not url.startswith(("file:", "data:"))] == []
        assert complaints == []
        browser.close()
