"""The list of what there is in the dissertation, and what of it the ledger covers."""

from pathlib import Path

import pytest

from compendium import contents
from compendium.printed import PrintedValue, load_printed

REST = "equations_without_row: []\ntables: []\nfigures: []\n"
ROOT = Path(__file__).resolve().parents[2]
CONTENTS = contents.load_contents(ROOT / "data" / "contents.yaml")
PRINTED = {path.stem: load_printed(path) for path in sorted((ROOT / "data" / "printed").glob("*.yaml"))}


def about(where):
    return PrintedValue("a", where, "q", True, "h", "reproduced", "r")


@pytest.mark.parametrize(
    ("text", "kind", "numbers"),
    [
        ("Section 4.7.1, Fig. 4.10", "section", ("4.7.1",)),
        ("Section 4.7.1, Fig. 4.10", "figure", ("4.10",)),
        ("Section 4.6, Figs 4.4(a), 4.5(a)", "figure", ("4.4", "4.5")),
        ("Sections 4.7.2 and 4.8, Fig. 4.14", "section", ("4.7.2", "4.8")),
        ("after (Figs 3.10 and 3.11) and Fig. 3.5, caption", "figure", ("3.10", "3.11", "3.5")),
        ("Figs 5.8 to 5.10", "figure", ("5.8", "5.9", "5.10")),
        ("Sections 7.4.1 to 7.4.3 and Table 7.1", "section", ("7.4.1", "7.4.2", "7.4.3")),
        ("Sections 7.4.1 to 7.4.3 and Table 7.1", "table", ("7.1",)),
        ("Configuration 4.4, 3.1 mm", "figure", ()),
    ],
)
def test_numbers_are_read_from_what_a_text_cites(text, kind, numbers):
    assert contents.cited(text, kind) == numbers


def test_other_kinds_are_refused():
    with pytest.raises(ValueError, match="kind = 'page'"):
        contents.cited("page 3", "page")


@pytest.mark.parametrize(
    ("text", "numbers"),
    [
        ("Equations (6-8) to (6-10), (6-12)", ("6-8", "6-9", "6-10", "6-12")),
        ("Section 3.5, (3-14)", ("3-14",)),
        ("(2-7) and (2-7)", ("2-7",)),
        ("Section 2-1, Figs 4.4(a) to 4.5", ()),
    ],
)
def test_numbers_of_equations_are_read(text, numbers):
    assert contents.cited_equations(text) == numbers


def test_an_equation_that_marks_a_place_is_not_compared():
    text = "Section 2.2.1, after (2-11), before (2-12), (2-13)"
    assert contents.compared_equations(text) == ("2-13",)


def test_a_range_of_equations_counts_for_every_section_that_it_touches():
    counts = {
        entry.section.number: entry.rows for entry in contents.coverage(CONTENTS, [about("(3-4) to (3-9)")])
    }
    assert [number for number, rows in counts.items() if rows] == ["3.3", "3.4", "3.5"]


def test_a_row_counts_for_its_section_by_number_or_by_equation():
    rows = [about("Section 3.5, Fig. 3.5"), about("(3-9)"), about("Equation (3-18)"), about("(3-19)")]
    counts = {entry.section.number: entry.rows for entry in contents.coverage(CONTENTS, rows)}
    assert counts["3.5"] == 3
    assert counts["3.6"] == 1
    assert sum(counts.values()) == 4


def test_a_table_and_a_section_of_one_number_are_told_apart():
    covered = contents.coverage(CONTENTS, [about("Table 4.3")])
    found = [(entry.section.kind, entry.section.number) for entry in covered if entry.rows]
    assert found == [("table", "4.3")]


def test_what_is_not_compared_says_why_or_shows():
    text = contents.coverage_as_markdown(contents.coverage(CONTENTS, [about("Section 2.2")]))
    lines = text.splitlines()
    assert "| Section 2.2 | 1 |  |" in lines
    assert any(line.startswith("| Section 3.1 |  | Overview") for line in lines)
    assert "| Section 2.3 |  | **not compared yet** |" in lines


def test_every_section_of_a_chapter_with_a_ledger_has_a_row_or_a_reason():
    printed = [value for values in PRINTED.values() for value in values]
    begun = {int(name[2:]) for name in PRINTED if "_" not in name}
    bare = [
        f"{entry.section.kind} {entry.section.number}"
        for entry in contents.coverage(CONTENTS, printed)
        if entry.section.chapter in begun and not entry.rows and not entry.section.nothing_to_check
    ]
    assert not bare


def test_every_equation_has_a_row_or_a_reason():
    printed = [value for values in PRINTED.values() for value in values]
    assert contents.bare_equations(CONTENTS, printed) == ()
    without = [value for value in printed if "2-26" not in contents.cited_equations(value.where)]
    assert contents.bare_equations(CONTENTS, without) == ("2-26",)


def test_every_figure_with_numbers_has_a_row_or_a_reason():
    printed = [value for values in PRINTED.values() for value in values]
    named = {number for value in printed for number in contents.cited(value.where, "figure")}
    bare = [
        figure.number
        for figure in CONTENTS.figures
        if figure.data and not figure.nothing_to_check and figure.number not in named
    ]
    assert not bare


def test_reasons_are_given_only_where_there_is_no_row():
    """A reason that a row has overtaken is not true any more."""
    printed = [value for values in PRINTED.values() for value in values]
    covered = contents.coverage(CONTENTS, printed)
    assert not [entry.section.number for entry in covered if entry.rows and entry.section.nothing_to_check]
    named = {number for value in printed for number in contents.compared_equations(value.where)}
    excused = [n for e in CONTENTS.equations_without_row for n in contents.cited_equations(e.numbers)]
    assert len(excused) == len(set(excused))
    assert set(excused) <= set(CONTENTS.equations) - named
    figures = {number for value in printed for number in contents.cited(value.where, "figure")}
    assert not [
        f.number for f in CONTENTS.figures if f.nothing_to_check and (f.number in figures or not f.data)
    ]


def test_equations_that_are_not_compared_say_why_or_show():
    text = contents.equations_as_markdown(CONTENTS, [about("(2-4)"), about("(2-7) to (2-8)")])
    lines = text.splitlines()
    assert lines[0] == "Of 133 numbered equations 3 are named by a row of the ledger."
    assert "| (2-5), (2-6) | Define the transition matrix. |" in lines
    assert lines[-1].startswith("| (2-10), (2-11), (2-19), ")
    assert lines[-1].endswith(" | **not compared yet** |")


def test_every_printed_value_names_a_place_that_exists():
    listed = {
        "section": {entry.number for entry in CONTENTS.sections},
        "table": {entry.number for entry in CONTENTS.tables},
        "figure": {entry.number for entry in CONTENTS.figures},
    }
    for name, values in PRINTED.items():
        for value in values:
            places = {kind: contents.cited(value.where, kind) for kind in listed}
            unknown = [
                number for kind, numbers in places.items() for number in numbers if number not in listed[kind]
            ]
            assert not unknown, (name, value.id, unknown)
            assert set(contents.cited_equations(value.where)) <= set(CONTENTS.equations), (name, value.id)
            by_equation = contents.coverage(CONTENTS, [value])
            assert any(places.values()) or any(entry.rows for entry in by_equation), (name, value.id)


def test_the_list_is_complete():
    """Numbers run through without a gap, as many as the dissertation's lists have."""
    figures = [tuple(map(int, figure.number.split("."))) for figure in CONTENTS.figures]
    last = {1: 12, 3: 14, 4: 14, 5: 11, 6: 7, 7: 13, 8: 5}
    assert figures == [(chapter, number) for chapter, count in last.items() for number in range(1, count + 1)]
    assert [table.number for table in CONTENTS.tables] == ["4.1", "4.2", "4.3", "4.4", "7.1"]
    chapters = [section.chapter for section in CONTENTS.sections]
    counts = {chapter: chapters.count(chapter) for chapter in sorted(set(chapters))}
    # Of the first chapter the one section that says something about contact.
    assert counts == {1: 1, 2: 5, 3: 9, 4: 10, 5: 11, 6: 5, 7: 8, 8: 2}
    equations = [tuple(map(int, text.split("-"))) for s in CONTENTS.sections for text in s.equations]
    ends = {2: 28, 3: 26, 4: 22, 5: 7, 6: 29, 7: 20}
    for chapter, end in ends.items():
        inside = [number for found, number in equations if found == chapter]
        assert inside[0] == 1
        assert inside[-1] == end
        assert all(b == a + 1 for a, b in zip(inside[1:-1:2], inside[2::2], strict=True))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "must be a mapping"),
        ("sections: []\nequations_without_row: []\ntables: []\n", "missing figures"),
        (f"sections: [{{number: 4.10}}]\n{REST}", "must be in quotes"),
        (f'sections: [{{number: "4.1", title: x}}]\n{REST}', "unknown title"),
        (
            f'sections: [{{number: "4.1", equations: ["4-1"]}}]\n{REST}',
            "the first and the last",
        ),
        (
            f'sections: [{{number: "4.1"}}, {{number: "4.1"}}]\n{REST}',
            "4.1 stands more than once",
        ),
        ("sections: [\n", "contents.yaml"),
        (
            "sections: []\ntables: []\nfigures: []\nequations_without_row: [{numbers: 2-1, because: x}]\n",
            "must name equations",
        ),
    ],
)
def test_a_wrong_list_is_refused(tmp_path, text, message):
    path = tmp_path / "contents.yaml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(contents.ContentsError, match=message):
        contents.load_contents(path)


def test_a_missing_list_is_named(tmp_path):
    with pytest.raises(contents.ContentsError, match=r"contents\.yaml is missing"):
        contents.load_contents(tmp_path / "contents.yaml")
