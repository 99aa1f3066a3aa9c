"""The report as files: what is on the page, what lies beside it, and what one part that fails leaves standing."""

import re
from pathlib import Path

import pytest
import yaml

from facegear.drives import critical_thickness, findings, report_files, sections, verdict
from facegear.drives.drive_file import parse_drive
from facegear.drives.examples import example_text
from facegear.drives.findings import Findings
from facegear.drives.page import attempted
from facegear.drives.page import page as page_of
from facegear.support.labelled import load
from tests.drives.test_page import Reader

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def file():
    content = yaml.safe_load((ROOT / "data" / "drives" / "example_b.yaml").read_text(encoding="utf-8"))
    content["operation"] |= {"lowest_speed_rpm": 960}
    return parse_drive(yaml.safe_dump(content))


@pytest.fixture(scope="module")
def results(file, tmp_path_factory):
    """Write a report whose search for the critical thickness fails."""
    folder, told = tmp_path_factory.mktemp("drive") / "results", []

    def fails(*_, **__):
        raise ArithmeticError("the search lost its way")

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(critical_thickness, "thickness_verdicts", fails)
        page = report_files.write_report(Findings(file, cells=3, most_steps=1, jobs=1), folder, told.append)
    return page, told


def test_one_part_that_fails_leaves_the_others(results):
    page, _ = results
    text = Reader(page.read_text(encoding="utf-8")).text
    assert text.count("This part could not be computed") == 1
    assert "the others could: the search lost its way" in text
    for words in ("Example B", "contact ratio, Tregold", "largest stress at the root"):
        assert words in text
    table = (page.parent / "summary.csv").read_text(encoding="utf-8-sig")
    assert "largest stress at the root" in table
    assert "critical power of a pinion" in table
    assert "critical thickness" not in table


def test_names_of_what_grows_by_itself_are_explained(results):
    text = Reader(results[0].read_text(encoding="utf-8")).text
    assert "mean 1: natural motion 1 of the mean system grows by itself, oscillating (flutter)" in text
    assert "mean 0: what grows by itself does not oscillate (divergence)" in text


def test_all_names_of_files_are_known(results):
    page, _ = results
    assert {path.name for path in page.parent.iterdir()} <= set(report_files.FILES)
    for name in (
        "play",
        "damage",
        "torsional_map",
        "tongues_torsion",
        "tongues_true_sweep_force_follows_the_rim",
    ):
        assert f"{name}.nc" in report_files.FILES


def test_without_cases_tables_and_meshes_are_still_written(file, tmp_path, monkeypatch):
    def fails(*_, **__):
        raise ArithmeticError("no tongue was found")

    monkeypatch.setattr(verdict, "cases", fails)
    found = Findings(file, cells=3, most_steps=1, jobs=1)
    earlier = page_of("Earlier", ())
    (tmp_path / "results").mkdir()
    (tmp_path / "results" / "report.html").write_text(earlier, encoding="utf-8")
    for name in ("tongues_torsion.nc", "play.nc", "tongues_mine.nc"):
        (tmp_path / "results" / name).write_text("of another drive")
    page = report_files.write_report(found, tmp_path / "results")
    assert not any((page.parent / name).exists() for name in ("tongues_torsion.nc", "play.nc"))
    assert (page.parent / "tongues_mine.nc").exists()
    written = {path.name for path in page.parent.iterdir()}
    assert {"summary.csv", "natural_frequencies.csv", "modes.nc", "tooth_mm.stl", "report.html"} <= written
    assert not {"tongues.csv", "map_dead.nc"} & written
    text = Reader(page.read_text(encoding="utf-8")).text
    assert "tongues.csv was not written: no tongue was found" in text
    assert "contact ratio, Tregold" in text
    assert "allowable over largest stress" in text


@pytest.mark.parametrize("name", ["report.html", "summary.csv", "tongues_torsion.nc"])
def test_files_that_no_report_wrote_are_not_replaced(file, tmp_path, name, monkeypatch):
    def computes(*_, **__):
        raise AssertionError("something was computed")

    monkeypatch.setattr(verdict, "cases", computes)
    (tmp_path / name).write_text("mine", encoding="utf-8")
    (tmp_path / "notes.txt").write_text("mine, too", encoding="utf-8")
    with pytest.raises(FileExistsError, match=f"{name} is there and would be replaced"):
        report_files.write_report(Findings(file, cells=3, most_steps=1, jobs=1), tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted([name, "notes.txt"])
    assert (tmp_path / name).read_text(encoding="utf-8") == "mine"


def test_torsion_that_fails_leaves_the_disk(tmp_path, monkeypatch):
    content = yaml.safe_load(example_text("gearbox_table_7_1"))
    content["operation"] |= {"lowest_speed_rpm": 970}
    file = parse_drive(yaml.safe_dump(content))

    def fails(*_, **__):
        raise ArithmeticError("multipliers are not known")

    monkeypatch.setattr(findings, "settled_torsion", fails)
    found = Findings(file, cells=3, most_steps=1, jobs=1)
    assert "torsion" not in found.tongues
    for title, make, told in (
        (
            "Verdict",
            sections.verdict,
            "Torsion is left out, it could not be computed: multipliers are not known",
        ),
        ("Torsional vibration", sections.torsion, "This part could not be computed"),
        ("Unstable speeds and safe ones", sections.unstable_speeds, "true sweep, force follows the rim"),
    ):
        assert told in Reader(attempted(title, lambda make=make: make(found)).as_html()).text


def test_progress_names_each_section(results):
    _, told = results
    titles = [*(title for title, _ in sections.SECTIONS), "Files"]
    assert told == [f"section {k} of {len(titles)}: {title}" for k, title in enumerate(titles, start=1)]


def test_the_page_has_the_sections_under_their_titles(results):
    page, _ = results
    found = re.findall(r'<h2 id="section-\d+">([^<]*)</h2>', page.read_text(encoding="utf-8"))
    assert found == [*(title for title, _ in sections.SECTIONS), "Files"]


def test_files_that_are_listed_are_there_and_no_others(results):
    page, _ = results
    listed = re.findall(r"<code>([\w.]+\.(?:csv|nc|stl))</code>", page.read_text(encoding="utf-8"))
    assert sorted([*listed, "report.html"]) == sorted(path.name for path in page.parent.iterdir())
    assert len(listed) > 10
    # Tables come before what takes long or fails more easily.
    kinds = [name.rpartition(".")[2] for name in listed]
    assert kinds == [*sorted(kinds[:-2], key=["csv", "nc"].index), "csv", "stl"]
    assert load(page.parent / "map_dead.nc")["growth_rate"].shape == (3, 3)
    assert [path.name for path in page.parent.parent.iterdir()] == ["results"]


def test_an_interruption_leaves_nothing(file, tmp_path):
    def interrupted(line):
        if line.startswith("section 3"):
            raise KeyboardInterrupt

    found = Findings(file, cells=3, most_steps=1, jobs=1)
    with pytest.raises(KeyboardInterrupt):
        report_files.write_report(found, tmp_path / "results", interrupted)
    assert not list(tmp_path.iterdir())


def test_results_lie_beside_the_file():
    assert report_files.results_directory("a/my_drive.yaml") == Path("a/my_drive_results")
