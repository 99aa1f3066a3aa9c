"""Pages that the build puts together: index of figures, run times, citation."""

from pathlib import Path

import nbformat
import pytest
import yaml

from tools import pages

ROOT = Path(__file__).resolve().parents[2]
CONTENTS = """
sections: []
tables: []
figures:
- {number: "1.1", about: One gearbox, not_drawn: A photograph.}
- {number: "1.2", about: Another gearbox, not_drawn: A photograph.}
- {number: "4.4", about: Stability of Case I, data: true}
- {number: "4.5", about: Stability of Case II, data: true}
- {number: "4.6", about: Steps, not_drawn: A flow chart.}
- {number: "5.5", about: Stability over an angle, data: true}
"""


def notebook(path, figures, record=True):
    cells = [nbformat.v4.new_markdown_cell("# Title\n\nObjectives")]
    for name, caption in figures.items():
        cells.append(nbformat.v4.new_markdown_cell(f"## Section of {name}"))
        cells.append(nbformat.v4.new_code_cell("1 + 1"))
        cells[-1].metadata.mystnb = {"figure": {"name": name, "caption": caption}}
        if record:
            cells[-1].metadata.papermill = {"duration": float(len(cells))}
    content = nbformat.v4.new_notebook(cells=cells)
    if record:
        content.metadata.papermill = {"duration": 12.34, "start_time": "2026-11-22T16:34:08.041790+00:00"}
    path.parent.mkdir(exist_ok=True)
    nbformat.write(content, path)
    return path


@pytest.fixture
def listed(tmp_path):
    path = tmp_path / "contents.yaml"
    path.write_text(CONTENTS, encoding="utf-8")
    return path


def test_index_leads_to_labels_and_else_to_captions(tmp_path, listed):
    path = notebook(
        tmp_path / "04_one.ipynb",
        {
            "fig-4-4": "Case I, Fig. 4.4.",
            "fig-hsu": "Hsu over Fig. 4.4(a) ([data](a.nc)).",
            "fig-b": "See Fig. 4.5.",
        },
    )
    lines = pages.figure_index(listed, [path]).splitlines()
    assert "| 4.4 | Stability of Case I | {numref}`fig-4-4` |" in lines
    assert "| 4.5 | Stability of Case II | {numref}`fig-b` |" in lines
    assert "| 4.6 | Steps (drawing) | not drawn: a flow chart. |" in lines
    assert "| 5.5 | Stability over an angle | its chapter is not in the book yet |" in lines
    assert "| 1.1 to 1.2 | One gearbox; Another gearbox (drawing) | not drawn: a photograph. |" in lines
    assert any("2 of 3" in line for line in lines)


def test_index_takes_parts_of_a_figure_together(tmp_path, listed):
    path = notebook(
        tmp_path / "04_one.ipynb", {"fig-4-4a": "a", "fig-4-4-b": "b", "fig-4-5": "c", "fig-4-40": "d"}
    )
    text = pages.figure_index(listed, [path])
    assert "{numref}`fig-4-4a`, {numref}`fig-4-4-b` |" in text
    assert "fig-4-40" not in text


def test_index_refuses_a_figure_that_is_neither_shown_nor_explained(tmp_path, listed):
    path = notebook(tmp_path / "04_one.ipynb", {"fig-4-4": "Case I."})
    with pytest.raises(ValueError, match=r"figures 4\.5 are in no notebook"):
        pages.figure_index(listed, [path])


def test_index_of_this_book_shows_the_data_figures_of_its_chapters():
    notebooks = sorted((ROOT / "notebooks").glob("*.ipynb"))
    text = pages.figure_index(ROOT / "data" / "contents.yaml", notebooks)
    for number in ("3.9", "3.13", "4.4", "4.14"):
        (line,) = [line for line in text.splitlines() if line.startswith(f"| {number} |")]
        assert f"{{numref}}`fig-{number.replace('.', '-')}" in line


def test_run_times_are_those_of_papermill(tmp_path):
    first = notebook(tmp_path / "a" / "04_one.ipynb", {"fig-a": "a", "fig-b": "b"})
    second = notebook(tmp_path / "a" / "90_ledger.ipynb", {})
    lines = pages.run_times([first, second]).splitlines()
    assert "| 12.3 | {doc}`notebooks/04_one` | 5.0 | Section of fig-b | 2 | 2026-11-22 16:34 |" in lines
    assert any("25 s in sum" in line for line in lines)
    bare = notebook(tmp_path / "a" / "91_bare.ipynb", {}, record=False)
    with pytest.raises(ValueError, match=r"91_bare\.ipynb carries no record"):
        pages.run_times([bare])


def test_bibtex_says_what_the_citation_file_says():
    cff = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    text = pages.bibtex(ROOT / "CITATION.cff")
    assert text.count("{") == text.count("}")
    for value in (cff["title"], cff["version"], cff["references"][0]["title"], "Peng, Meng", "year = {2012}"):
        assert value in text


def figure_cell(source, name="fig-x", caption="A map."):
    cell = nbformat.v4.new_code_cell(source)
    cell.metadata.mystnb = {"figure": {"name": name, "caption": caption}}
    return cell


@pytest.mark.parametrize(
    ("cell", "names"),
    [
        (figure_cell('data = chapter.figure("ch02_swing", swing(1))'), ["ch02_swing"]),
        (
            figure_cell('chapter.figure(\n    "ch02_swing", a)\nchapter.figure("ch02_lost", b)'),
            ["ch02_swing"],
        ),
        (figure_cell("draw(charts)", "fig-4-4"), ["ch04_figure_4_04a", "ch04_figure_4_04b"]),
        (figure_cell("draw(charts)", "fig-4-4b"), ["ch04_figure_4_04b"]),
        (figure_cell("draw(charts)", "fig-4-4-true"), []),
        (figure_cell("draw(charts)", "fig-4-9"), []),
        (figure_cell("draw(charts)"), []),
    ],
)
def test_caption_offers_the_numbers_that_the_cell_shows(cell, names):
    stored = {"ch02_swing", "ch04_figure_4_04a", "ch04_figure_4_04b", "ch04_figure_4_14"}
    pages.offer_numbers(cell, stored)
    caption = cell.metadata.mystnb.figure.caption
    assert [word for word in stored if f"<../data/{word}.nc>" in caption] == [
        word for word in stored if word in names
    ]
    assert caption.startswith("A map." + (" Numbers: {download}`" if names else ""))


def test_caption_that_offers_numbers_itself_and_cells_without_figure_are_left_alone():
    own = figure_cell(
        'chapter.figure("ch02_swing", a)', caption="A map: {download}`x <../data/ch02_swing.nc>`."
    )
    plain = nbformat.v4.new_code_cell('chapter.figure("ch02_swing", a)')
    for cell in (own, plain):
        before = str(cell)
        pages.offer_numbers(cell, {"ch02_swing"})
        assert str(cell) == before


@pytest.mark.parametrize(
    ("written", "read"),
    [
        ("off by 1.6e-06 of it", "off by 1.6·10⁻⁶ of it"),
        ("1e-12; -2.5e+08 N/m", "10⁻¹²; −2.5·10⁸ N/m"),
        ("| 1.047e+04 | 5.6e-04 | 3e-2 |", "| 10470 | 0.00056 | 0.03 |"),
        ("$k_m$ = 1.5763e+08 N/m", "$k_m$ = 1.5763·10⁸ N/m"),
        ("| 1.58 10⁸ N/m | 10⁸ N/m |", "| 1.58·10⁸ N/m | 10⁸ N/m |"),
        ("$k = 1.5e+08$", r"$k = 1.5\cdot 10^{8}$"),
        ("`rtol=1e-9` and\n```python\nx = 1e-9\n```", "`rtol=1e-9` and\n```python\nx = 1e-9\n```"),
        ("| -0.00 | −0 | -0.05 | 3-0 |", "| 0.00 | 0 | −0.05 | 3-0 |"),
        ("module_1e5 and 2.1e", "module_1e5 and 2.1e"),
        ("from -1.7 to -0.7 %, (-5), +-2", "from −1.7 to −0.7 %, (−5), +−2"),
        ("-2.05-1670.86i; 2026-11-30; (7-2)", "−2.05−1670.86i; 2026-11-30; (7-2)"),
        ('<p style="margin:-1px"> -1 < 2</p>', '<p style="margin:-1px"> −1 < 2</p>'),
        ("|--:|---|\n| -1 | $-1$ |", "|--:|---|\n| −1 | $-1$ |"),
    ],
)
def test_numbers_are_put_in_a_readers_digits(written, read):
    assert pages.in_readers_digits(written) == read


def test_outputs_are_put_in_a_readers_digits_and_what_code_prints_is_not():
    cell = nbformat.v4.new_code_cell("1e-9")
    table = nbformat.v4.new_output("display_data", {"text/markdown": "| 1e-9 |", "text/plain": "1e-9"})
    quoted = nbformat.v4.new_output("display_data", {"application/papermill.record/text/plain": "'2e-9'"})
    html = nbformat.v4.new_output("display_data", {"text/html": "<td class=x>-3.0</td><b>-3</b>"})
    printed = nbformat.v4.new_output("stream", name="stdout", text="1e-9")
    cell.outputs = [table, quoted, printed, html]
    pages.put_outputs_in_readers_digits(cell)
    assert cell.outputs[0].data == {"text/markdown": "| 10⁻⁹ |", "text/plain": "1e-9"}
    assert cell.outputs[1].data == {"application/papermill.record/text/plain": "'2·10⁻⁹'"}
    assert cell.outputs[2].text == "1e-9"
    assert cell.outputs[3].data == {"text/html": "<td class=x>−3.0</td><b>-3</b>"}
