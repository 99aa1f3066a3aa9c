"""The ledger: a status follows from the numbers, or the chapter stops."""

import csv
import shutil
from pathlib import Path

import pytest
import yaml

from compendium import ledger_tables, printed

ENTRY = {
    "id": "case_1_outer_radius",
    "where": "Fig. 4.4, caption",
    "quantity": "Outer radius",
    "printed": "231.94",
    "unit": "mm",
    "how": "Drive(26, 130, 3.175e-3).outer_radius",
    "status": printed.REPRODUCED,
    "remark": "To every digit.",
}


def write(tmp_path, *entries):
    path = tmp_path / "ch03.yaml"
    path.write_text(yaml.safe_dump(list(entries)), encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("digits", "computed", "holds"),
    [
        ("231.94", 231.9449, True),
        ("231.94", 231.935, True),
        ("231.94", 231.9451, False),
        ("283", 283.49, True),
        ("283", 282.4, False),
        ("1.6e-3", 1.64e-3, True),
        ("1.6e-3", 2.43e-3, False),
        ("1.58e8", 1.5834e8, True),
        ("1.58e8", 1.5734e8, False),
        ("231.94", float("nan"), False),
    ],
)
def test_printed_digits_set_the_tolerance(tmp_path, digits, computed, holds):
    (value,) = printed.load_printed(write(tmp_path, ENTRY | {"printed": digits}))
    assert value.holds(computed) is holds


@pytest.mark.parametrize(
    ("entry", "computed", "status"),
    [
        (ENTRY, 231.94, printed.REPRODUCED),
        (ENTRY | {"convention": "tip addendum 1/Pd"}, 231.94, printed.REPRODUCED_UNDER_CONVENTION),
        (ENTRY, 240.0, printed.DIFFERS),
        (ENTRY, None, printed.UNDECIDED),
        (ENTRY | {"printed": True, "unit": ""}, True, printed.REPRODUCED),
        (ENTRY | {"printed": True, "unit": ""}, False, printed.DIFFERS),
    ],
)
def test_status_follows_from_the_numbers(tmp_path, entry, computed, status):
    values = printed.load_printed(write(tmp_path, entry | {"status": status}))
    (row,) = printed.ledger(values, {ENTRY["id"]: computed})
    assert row.status == status
    for wrong in set(printed.STATUSES) - {status}:
        values = printed.load_printed(write(tmp_path, entry | {"status": wrong}))
        with pytest.raises(printed.LedgerError, match="the file claims"):
            printed.ledger(values, {ENTRY["id"]: computed})


def test_nothing_printed_is_left_out_and_nothing_is_made_up(tmp_path):
    values = printed.load_printed(write(tmp_path, ENTRY))
    with pytest.raises(printed.LedgerError, match="case_1_outer_radius: printed but not computed"):
        printed.ledger(values, {})
    with pytest.raises(printed.LedgerError, match="other: computed but not printed"):
        printed.ledger(values, {ENTRY["id"]: 231.94, "other": 1.0})


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"status": "fine"}, "must be one of"),
        ({"printed": 231.94}, "must be digits in quotes"),
        ({"printed": "about 232"}, "must be digits in quotes"),
        ({"colour": "red"}, "colour"),
        ({"given": "yes"}, "given = 'yes' must be true or false"),
    ],
)
def test_bad_entries_are_refused(tmp_path, change, message):
    with pytest.raises(printed.LedgerError, match=message):
        printed.load_printed(write(tmp_path, ENTRY | change))


def test_missing_key_and_repeated_id_are_refused(tmp_path):
    with pytest.raises(printed.LedgerError, match="remark"):
        printed.load_printed(write(tmp_path, {k: v for k, v in ENTRY.items() if k != "remark"}))
    with pytest.raises(printed.LedgerError, match="more than once"):
        printed.load_printed(write(tmp_path, ENTRY, ENTRY))


@pytest.mark.parametrize("content", ["", "[1, 2", "a: 1"])
def test_unusable_file_is_refused(tmp_path, content):
    path = tmp_path / "ch03.yaml"
    path.write_text(content)
    with pytest.raises(printed.LedgerError, match=r"ch03\.yaml"):
        printed.load_printed(path)
    with pytest.raises(printed.LedgerError, match=r"none\.yaml is missing"):
        printed.load_printed(tmp_path / "none.yaml")


def test_a_truth_value_is_not_a_number(tmp_path):
    (number,) = printed.load_printed(write(tmp_path, ENTRY))
    with pytest.raises(printed.LedgerError, match="needs a number"):
        number.holds(True)
    (statement,) = printed.load_printed(write(tmp_path, ENTRY | {"printed": True}))
    with pytest.raises(printed.LedgerError, match="needs True or False"):
        statement.holds(1.0)


def test_saved_ledger_is_verified_again_when_read(tmp_path):
    rows = printed.ledger(printed.load_printed(write(tmp_path, ENTRY)), {ENTRY["id"]: 231.94})
    path = printed.save_ledger(rows, tmp_path / "build" / "ch03.yaml")
    assert printed.load_ledger(path) == rows
    path.write_text(path.read_text().replace("computed: 231.94", "computed: 240.0"))
    with pytest.raises(printed.LedgerError, match="the file claims"):
        printed.load_ledger(path)


@pytest.mark.parametrize(
    "path", sorted((Path(__file__).parents[2] / "data" / "printed").glob("*.yaml")), ids=lambda p: p.stem
)
def test_the_files_of_the_repository_are_well_formed(path):
    assert printed.load_printed(path)


def test_tables_show_every_row_with_two_more_digits_than_printed(tmp_path):
    entries = [
        ENTRY,
        ENTRY | {"id": "b", "printed": "282", "status": printed.DIFFERS, "given": True},
        ENTRY
        | {
            "id": "c",
            "printed": True,
            "unit": "",
            "convention": "as chosen",
            "status": printed.REPRODUCED_UNDER_CONVENTION,
        },
        ENTRY | {"id": "d", "status": printed.UNDECIDED},
    ]
    values = {ENTRY["id"]: 231.93881, "b": 283.04, "c": True, "d": None}
    rows = printed.ledger(printed.load_printed(write(tmp_path, *entries)), values)
    table = ledger_tables.as_markdown(rows).splitlines()
    assert len(table) == 2 + len(rows)
    assert "| 231.94 mm | 231.9388 mm | reproduced |" in table[2]
    assert "| 282 mm | 283.04 mm | differs |" in table[3]
    assert "| stated | holds |" in table[4]
    assert "| 231.94 mm | – |" in table[5]
    assert ledger_tables.counts_as_markdown({3: rows}).splitlines()[2] == "| 3 | 1 | 1 | 1 | 1 | 4 | 1 |"
    assert (
        ledger_tables.counts_as_markdown({3: rows}).splitlines()[3] == "| **all** | 1 | 1 | 1 | 1 | 4 | 1 |"
    )
    (remark,) = [line for line in ledger_tables.remarks_as_markdown(rows).splitlines() if "282" in line]
    assert "282 mm | To every digit." in remark
    assert remark.endswith(": 283.04 mm |")
    last = ledger_tables.remarks_as_markdown(rows).splitlines()[-1]
    assert last.endswith(f"{rows[-1].printed.how} |")  # nothing was computed, and nothing stands for it


def test_a_bar_in_a_cell_does_not_end_it():
    value = printed.PrintedValue(**(ENTRY | {"how": "where |σ| > 1"}))
    row = printed.LedgerRow(value, 231.94, printed.REPRODUCED)
    line = ledger_tables.remarks_as_markdown([row]).splitlines()[-1]
    assert r"where \|σ\| > 1" in line
    assert line.replace(r"\|", "").count("|") == 5


def test_all_rows_are_written_as_one_table(tmp_path):
    entries = (printed.PrintedValue(**ENTRY), printed.PrintedValue(**(ENTRY | {"id": "b", "printed": True})))
    rows = printed.ledger(entries, {ENTRY["id"]: 231.94, "b": True})
    path = ledger_tables.save_csv({3: rows[:1], 4: rows[1:]}, tmp_path / "new" / "ledger.csv")
    with path.open(encoding="utf-8-sig", newline="") as stream:
        table = list(csv.DictReader(stream))
    assert [(row["chapter"], row["id"], row["computed"]) for row in table] == [
        ("3", ENTRY["id"], "231.94"),
        ("4", "b", "True"),
    ]
    assert table[0]["printed"] == ENTRY["printed"]


def test_files_of_one_chapter_are_put_together(tmp_path):
    (tmp_path / "printed").mkdir()
    for name in ("ch03", "ch04", "ch04_design"):
        entry = [ENTRY | {"id": name}]
        source = tmp_path / "printed" / f"{name}.yaml"
        source.write_text(yaml.safe_dump(entry), encoding="utf-8")
        rows = printed.ledger(printed.load_printed(source), {name: 231.94})
        printed.save_ledger(rows, tmp_path / "ledger" / source.name)
    chapters = printed.load_chapters(tmp_path / "printed", tmp_path / "ledger")
    assert {number: [row.printed.id for row in rows] for number, rows in chapters.items()} == {
        3: ["ch03"],
        4: ["ch04", "ch04_design"],
    }


def test_a_ledger_of_another_chapter_is_refused(tmp_path):
    (tmp_path / "printed").mkdir()
    for name in ("ch03", "ch04"):
        source = tmp_path / "printed" / f"{name}.yaml"
        source.write_text(yaml.safe_dump([ENTRY | {"id": name}]), encoding="utf-8")
        rows = printed.ledger(printed.load_printed(source), {name: 231.94})
        printed.save_ledger(rows, tmp_path / "ledger" / source.name)
    shutil.copy(tmp_path / "ledger" / "ch03.yaml", tmp_path / "ledger" / "ch04.yaml")
    with pytest.raises(
        printed.LedgerError, match=r"ledger ch04\.yaml does not hold the printed values of ch04\.yaml"
    ):
        printed.load_chapters(tmp_path / "printed", tmp_path / "ledger")


@pytest.mark.parametrize("name", ["chapter3", "ch3", "notes", "ch04-design"])
def test_a_file_that_names_no_chapter_is_refused(tmp_path, name):
    (tmp_path / f"{name}.yaml").write_text(yaml.safe_dump([ENTRY]), encoding="utf-8")
    with pytest.raises(printed.LedgerError, match=f"{name}.yaml: a file of printed values must be called"):
        printed.load_chapters(tmp_path, tmp_path)
