"""Tables as CSV, which programs read as they were written and spreadsheets run nothing of."""

import csv
import unicodedata

import pytest

from facegear.support.tables import write_table

HOSTILE = [
    "=1+1",
    "+cmd|' /C calc'!A0",
    "-2+3",
    "@SUM(A1)",
    "\t=1",
    "\r=1",
    "\n=1",
    "＝1+1",
    "-",
    '="",1',
    "<b>",
    "a\nb",
]


def test_tables(tmp_path):
    path = write_table({"name": ["a", "b, c"], "value_mm": [1.0 / 3.0, 2]}, tmp_path / "new" / "table.csv")
    assert path.read_bytes().startswith(b"\xef\xbb\xbfname,value_mm")
    assert path.read_text(encoding="utf-8-sig").splitlines() == [
        "name,value_mm",
        "a,0.333333333333",
        '"b, c",2',
    ]
    with pytest.raises(ValueError, match="zip"):
        write_table({"a": [1], "b": [1, 2]}, path)
    assert path.read_text(encoding="utf-8-sig").startswith("name,value_mm")
    assert [p.name for p in path.parent.iterdir()] == ["table.csv"]


def test_a_number_that_there_is_not_is_an_empty_cell(tmp_path):
    path = write_table({"name": ["a", "b"], "value_mm": [float("nan"), 2.5]}, tmp_path / "table.csv")
    assert path.read_text(encoding="utf-8-sig").splitlines() == ["name,value_mm", "a,", "b,2.5"]


@pytest.mark.parametrize("text", HOSTILE)
def test_no_cell_is_a_formula(tmp_path, text):
    path = write_table({"name": [text], text: [1.0]}, tmp_path / "table.csv")
    with path.open(encoding="utf-8-sig", newline="") as file:
        heading, (cell, value) = csv.reader(file)
    for found in (heading[1], cell):
        assert unicodedata.normalize("NFKC", found)[0] not in "=+-@\t\r\n"
        assert found in (text, f"'{text}")
    assert value == "1"


def test_numbers_and_harmless_text_stay_as_they_are(tmp_path):
    cells = ["-1.5", "+2", "-3e-05", "a=b", "", "°", "mean 2", "1-2", "'quoted'"]
    path = write_table({"text": cells, "number": [-1.5] * len(cells)}, tmp_path / "table.csv")
    with path.open(encoding="utf-8-sig", newline="") as file:
        assert [row["text"] for row in csv.DictReader(file)] == cells
    assert '"-1.5' not in path.read_text(encoding="utf-8-sig")
