"""Fetch the browser scripts the book reads from its own folder (the only step that needs Node).

`python tools/refresh_vendor.py` asks npm for the versions named below and replaces `book/_assets/vendor`.
The versions are pinned: `plotly` must be the one that `plotly.offline.get_plotlyjs_version()` names, and the
widget manager the one that speaks the protocol of the installed `ipywidgets`.
"""

import json
import shutil
import subprocess
import sys
import tarfile
import tempfile
from dataclasses import dataclass
from pathlib import Path

VENDOR = Path(__file__).resolve().parents[1] / "book" / "_assets" / "vendor"


@dataclass(frozen=True)
class Package:
    """One npm package: what it is for, and which of its files the book needs."""

    name: str
    version: str
    folder: str
    licence: str
    purpose: str
    files: tuple[tuple[str, str], ...]  # (path or folder inside the package, path inside `folder`)


PACKAGES = (
    Package(
        name="mathjax",
        version="3.2.2",
        folder="mathjax",
        licence="Apache-2.0",
        purpose="sets the equations",
        files=(
            ("LICENSE", "LICENSE"),
            ("es5/tex-mml-chtml.js", "tex-mml-chtml.js"),
            ("es5/input/tex/extensions", "input/tex/extensions"),
            ("es5/output/chtml/fonts/woff-v2", "output/chtml/fonts/woff-v2"),
        ),
    ),
    Package(
        name="requirejs",
        version="2.3.8",
        folder="requirejs",
        licence="MIT",
        purpose="loads the widget manager",
        files=(("require.js", "require.js"),),
    ),
    Package(
        name="@jupyter-widgets/html-manager",
        version="1.0.15",
        folder="@jupyter-widgets/html-manager",  # the manager looks for its fonts under its npm name
        licence="BSD-3-Clause",
        purpose="keeps sliders alive in the static pages",
        files=(
            ("dist/embed.js.LICENSE.txt", "dist/embed.js.LICENSE.txt"),
            ("dist/embed-amd.js", "dist/embed-amd.js"),
            ("dist/1551f4f60c37af51121f.woff2", "dist/1551f4f60c37af51121f.woff2"),
            ("dist/7a3337626410ca2f4071.woff2", "dist/7a3337626410ca2f4071.woff2"),
            ("dist/d878b0a6a1144760244f.woff2", "dist/d878b0a6a1144760244f.woff2"),
        ),
    ),
    Package(
        name="plotly.js-gl3d-dist-min",
        version="4.1.1",
        folder="plotly",
        licence="MIT",
        purpose="draws the views that turn",
        files=(("LICENSE", "LICENSE"), ("plotly-gl3d.min.js", "plotly-gl3d.min.js")),
    ),
)

# Two of the packages are published without their licence; its text is kept here.
LICENCES = Path(__file__).resolve().parent / "licences"


def unpack(package: Package, scratch: Path) -> Path:
    """Download one package with npm and return the folder it was unpacked to."""
    packed = subprocess.run(
        ["npm", "pack", "--json", f"{package.name}@{package.version}"],
        cwd=scratch,
        check=True,
        stdout=subprocess.PIPE,
    )
    listing = json.loads(packed.stdout)
    # npm 11 and later answer with a mapping by package name, earlier ones with a list.
    entry = next(iter(listing.values())) if isinstance(listing, dict) else listing[0]
    target = scratch / package.folder
    with tarfile.open(scratch / entry["filename"]) as archive:
        archive.extractall(target, filter="data")
    return target / "package"


def refresh(vendor: Path) -> None:
    """Replace `vendor` by freshly downloaded files."""
    with tempfile.TemporaryDirectory() as name:
        scratch = Path(name)
        new = scratch / "vendor"
        for package in PACKAGES:
            source = unpack(package, scratch)
            for inside, outside in package.files:
                target = new / package.folder / outside
                target.parent.mkdir(parents=True, exist_ok=True)
                if (source / inside).is_dir():
                    shutil.copytree(source / inside, target)
                else:
                    shutil.copyfile(source / inside, target)
        shutil.copyfile(LICENCES / "requirejs.txt", new / "requirejs" / "LICENSE")
        shutil.copyfile(LICENCES / "jupyter-widgets.txt", new / "@jupyter-widgets" / "LICENSE")
        rows = [f"| {p.name} | {p.version} | {p.licence} | {p.purpose} |" for p in PACKAGES]
        (new / "README.md").write_text(
            "# Scripts of others\n\n"
            "Fetched from npm by `tools/refresh_vendor.py`, unchanged. Each folder holds its licence.\n\n"
            "| package | version | licence | what for |\n| --- | --- | --- | --- |\n"
            + "\n".join(rows)
            + "\n",
            encoding="utf-8",
        )
        shutil.rmtree(vendor, ignore_errors=True)
        shutil.copytree(new, vendor)


if __name__ == "__main__":
    refresh(VENDOR)
    size = sum(file.stat().st_size for file in VENDOR.rglob("*") if file.is_file())
    sys.stdout.write(f"book/_assets/vendor: {size / 1e6:.1f} MB\n")
