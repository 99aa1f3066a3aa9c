"""What `facegear` itself offers: a handful of names, each in use, each with its documentation."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

import facegear

ROOT = Path(__file__).resolve().parents[2]
PAGES = [ROOT / "README.md", *(ROOT / "book").glob("*.md"), *(ROOT / "notebooks").glob("*.ipynb")]


def test_there_are_as_many_as_one_can_learn():
    # 45, and `write_drive_file` beside `read_drive_file`, `assess` for the question that a gearbox is built on,
    # `campbell` and `mode_shapes` for those who come from rotors.
    assert 18 <= len(facegear.__all__) <= 49


@pytest.mark.parametrize("name", facegear.__all__)
def test_each_is_used_by_a_chapter_or_the_readme_and_says_what_it_is(name):
    assert any(re.search(rf"\bfg\.{name}\b", page.read_text(encoding="utf-8")) for page in PAGES)
    assert getattr(facegear, name) is not None
    assert name == "STEEL" or getattr(facegear, name).__doc__
    assert name in dir(facegear)


def test_another_name_is_no_attribute():
    with pytest.raises(AttributeError, match="no_such_name"):
        _ = facegear.no_such_name


def test_importing_it_loads_nothing_heavy():
    code = "import sys, facegear; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    loaded = set(done.stdout.split())
    assert not {"numpy", "scipy", "sympy", "matplotlib", "xarray"} & loaded


A_GROWTH_RATE = """
import sys
import facegear as fg

body = fg.Body(fg.Drive(26, 130, 3.175e-3), 0.03, nodal_diameters=2)
system = fg.Transverse(body, fg.MeshLoad(stiffness=0.6, damping=3e-6, mass=1.0)).system(50.0)
fg.growth_rate(system), fg.resonance_bands(system), body.drive.tooth_flank(3, 3)
print(*sys.modules)
"""


def test_a_growth_rate_loads_what_it_takes_and_no_more():
    """Derivations are kept as NumPy functions, and maps, figures and parallel work wait until they are asked for."""
    done = subprocess.run([sys.executable, "-c", A_GROWTH_RATE], capture_output=True, text=True, check=True)
    loaded = set(done.stdout.split())
    assert {"facegear.symbolic.twins", "facegear.floquet.multipliers", "scipy.linalg"} <= loaded
    assert (
        not {"sympy", "mpmath", "xarray", "pandas", "matplotlib", "joblib", "dask", "tqdm", "yaml"} & loaded
    )
