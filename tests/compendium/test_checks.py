"""References and anchors together: nothing is accepted that lacks either or disagrees with either."""

import shutil
from pathlib import Path

import pytest

from compendium import checks, reference
from facegear.support import labelled
from tests.compendium.test_reference import figure

DATA = Path(__file__).resolve().parents[2] / "data"


@pytest.fixture
def directories(tmp_path):
    data, build = tmp_path / "data", tmp_path / "build"
    labelled.save(figure(), data / "reference" / "fig.nc")
    (data / "anchors").mkdir()
    write_anchor(data, 3.0)
    return data, build


def write_anchor(data, value, speed=2.0):
    (data / "anchors" / "fig.yaml").write_text(
        "figure: fig\nroute: by hand\nanchors:\n"
        f"- {{variable: radius, at: {{speed: {speed}, pair: 1}}, value: {value}, atol: 1.0e-9}}\n"
    )


def test_check_figures_writes_arrays_and_reports(directories):
    data, build = directories
    (row,) = checks.check_figures({"fig": figure(2e-10)}, data, build)
    assert row["anchors"] == 1
    assert row["anchor deviation / tolerance"] == pytest.approx(0.2, rel=1e-6)
    assert (build / "arrays" / "fig.nc").is_file()


def test_anchor_that_disagrees_is_refused_though_the_reference_agrees(directories):
    data, build = directories
    write_anchor(data, 3.1)
    with pytest.raises(reference.ReferenceCheckError, match=r"independent route gives 3\.1"):
        checks.check_figures({"fig": figure()}, data, build)


def test_anchor_off_the_grid_is_refused(directories):
    data, build = directories
    write_anchor(data, 3.0, speed=2.5)
    with pytest.raises(reference.ReferenceCheckError, match=r"speed = 2\.5 is not on the grid"):
        checks.check_figures({"fig": figure()}, data, build)


@pytest.mark.parametrize(
    "content",
    [
        "figure: fig\nroute: none\nanchors: []\n",
        "figure: fig\nroute: x\nanchor: []\n",
        "[1, 2",
        "figure: fig\nroute: x\nanchors: [{}]\n",
        "route: x\nanchors: [{variable: radius, at: {speed: 2.0, pair: 1}, value: 3.0, atol: 1.0e-9}]\n",
    ],
)
def test_unusable_anchor_file_is_refused(directories, content):
    data, build = directories
    (data / "anchors" / "fig.yaml").write_text(content)
    with pytest.raises(reference.ReferenceCheckError, match=r"fig\.yaml"):
        checks.check_figures({"fig": figure()}, data, build)


def test_anchors_of_another_figure_are_refused(directories):
    data, _ = directories
    shutil.copy(data / "anchors" / "fig.yaml", data / "anchors" / "other.yaml")
    with pytest.raises(checks.AnchorFileError, match=r"other\.yaml holds the anchors of 'fig'"):
        checks.load_anchors(data / "anchors" / "other.yaml")


@pytest.mark.parametrize("step", [8, pytest.param(1, marks=pytest.mark.slow)], ids=["some", "all"])
def test_every_stored_file_is_its_own(step):
    for path in sorted((DATA / "anchors").glob("*.yaml"))[::step]:
        assert checks.load_anchors(path)
    for path in sorted((DATA / "reference").glob("*.nc"))[::step]:
        labelled.load(path)


def test_all_arrays_are_written_before_the_first_failure(directories):
    data, build = directories
    with pytest.raises(reference.ReferenceCheckError) as caught:
        checks.check_figures({"lost": figure(), "fig": figure(1.0)}, data, build)
    assert len(str(caught.value).splitlines()) == 2
    assert {path.name for path in (build / "arrays").iterdir()} == {"lost.nc", "fig.nc"}
