"""A chapter is done only when each of its figures and each printed value has been compared."""

import pytest
import xarray as xr

from compendium import printed
from compendium.chapter import Chapter, ChapterError
from compendium.reference import ReferenceCheckError
from facegear.support import labelled

STATEMENT = {"id": "grows", "where": "(2-8)", "quantity": "it grows", "printed": True, "how": "by hand"}
ROWS = [
    {**STATEMENT, "status": printed.REPRODUCED, "remark": ""},
    {**STATEMENT, "id": "half", "printed": "0.5", "status": printed.REPRODUCED, "remark": ""},
    {**STATEMENT, "id": "fast", "status": printed.DIFFERS, "remark": "It does not."},
    {**STATEMENT, "id": "loud", "status": printed.UNDECIDED, "remark": "Of what?"},
]
VALUES = {"grows": True, "half": 0.51, "fast": False, "loud": None}


def arrays(height=2.0):
    heights = labelled.variable("x", [1.0, height], "height", "m", atol=1e-9)
    return xr.Dataset({"y": heights}, {"x": [0.0, 1.0]})


@pytest.fixture
def chapter(tmp_path):
    """Make a chapter whose one figure and four printed values are stored."""
    data = tmp_path / "data"
    labelled.save(arrays(), data / "reference" / "ch02_tiny.nc")
    (data / "anchors").mkdir()
    (data / "anchors" / "ch02_tiny.yaml").write_text(
        "figure: ch02_tiny\nroute: by hand\nanchors:\n- {variable: y, at: {x: 1.0}, value: 2.0, atol: 1.0e-6}\n"
    )
    (data / "printed").mkdir()
    rows = [f"- {{{', '.join(f'{key}: {value!r}' for key, value in row.items())}}}" for row in ROWS]
    (data / "printed" / "ch02.yaml").write_text("\n".join(rows).replace("True", "true"))
    return Chapter("ch02", data, tmp_path / "build")


def test_a_whole_chapter(chapter, tmp_path):
    data = arrays()
    assert chapter.figure("ch02_tiny", data) is data
    chapter.values |= VALUES
    assert "| (2-8) | it grows | stated | holds | reproduced |" in chapter.ledger().data
    assert "| ch02_tiny |" in chapter.finish().data
    assert (tmp_path / "build" / "arrays" / "ch02_tiny.nc").is_file()
    stored = printed.load_chapters(tmp_path / "data" / "printed", tmp_path / "build" / "ledger")
    assert [row.computed for row in stored[2]] == list(VALUES.values())


def test_the_counts_are_there_for_the_text(chapter, monkeypatch):
    glued = {}
    monkeypatch.setattr("compendium.chapter.glue", lambda name, value, display: glued.update({name: value}))
    chapter.values |= VALUES
    chapter.ledger()
    assert glued == {"ch02_printed": 4, "ch02_hold": 2, "ch02_differ": 1, "ch02_undecided": 1}


def test_no_figure_at_all(chapter):
    chapter.values |= VALUES
    chapter.ledger()
    with pytest.raises(ChapterError, match="ch02: no figure was handed in"):
        chapter.finish()


def test_a_figure_that_is_stored_nowhere_or_has_changed(chapter, tmp_path):
    chapter.figure("ch02_tiny", arrays(2.0000001))
    chapter.figure("ch02_lost", arrays())
    with pytest.raises(ReferenceCheckError) as caught:
        chapter.finish()
    assert len(str(caught.value).splitlines()) == 2
    # Both are written, for whoever wants to store them anew.
    assert len(list((tmp_path / "build" / "arrays").iterdir())) == 2


@pytest.mark.parametrize("late", [False, True], ids=["never", "before the last value"])
def test_a_ledger_that_was_not_asked_for_with_all_values(chapter, late):
    chapter.figure("ch02_tiny", arrays())
    if late:
        chapter.values |= VALUES
        chapter.ledger()
        chapter.values["grows"] = False
    with pytest.raises(ChapterError, match=r"values were not compared with ch02\.yaml"):
        chapter.finish()


def test_a_value_that_is_missing_or_says_otherwise(chapter):
    chapter.values |= VALUES
    chapter.values["fast"] = True
    with pytest.raises(printed.LedgerError, match="the file claims 'differs'"):
        chapter.ledger()
    del chapter.values["fast"]
    with pytest.raises(printed.LedgerError, match="fast: printed but not computed"):
        chapter.ledger()


def test_names_of_another_chapter_and_names_given_twice(chapter):
    with pytest.raises(ValueError, match="name must be chNN or chNN_topic, got '02'"):
        Chapter("02", "data", "build")
    with pytest.raises(ValueError, match="figure must begin with 'ch02_'"):
        chapter.figure("ch03_tiny", arrays())
    chapter.figure("ch02_tiny", arrays())
    with pytest.raises(ValueError, match="figure 'ch02_tiny' was handed in before"):
        chapter.figure("ch02_tiny", arrays())


def test_what_the_text_says_of_a_number(chapter):
    chapter.require("order", 2.04, 1.9, 2.1)
    with pytest.raises(ChapterError, match=r"ch02: order is 2\.2, the text says 1\.9 to 2\.1"):
        chapter.require("order", 2.2, 1.9, 2.1)
    with pytest.raises(ChapterError, match="order is nan"):
        chapter.require("order", float("nan"), 1.9, 2.1)
