"""Numbers of equations and percentages are kept on one line."""

import pytest
from docutils import nodes

from tools.unbroken import is_running_text, keep_with_formula, pieces, with_percent_kept


@pytest.mark.parametrize(
    ("text", "whole"),
    [
        ("By (3-20) and (4-2a).", ["(3-20)", "(4-2a)"]),
        ("(7-2)", ["(7-2)"]),
        ("pointed (3-13, 3-14), (3-9 to 3-11)", ["3-13", "3-14", "3-9", "3-11"]),
        ("From 3-20 on, (1.5-2), (2012-05) and (x-1)", []),
    ],
)
def test_numbers_of_equations_are_spans_and_the_text_is_the_same(text, whole):
    found = pieces(text)
    assert "".join(node.astext() for node in found) == text
    assert [node.astext() for node in found if isinstance(node, nodes.inline)] == whole
    assert all(node["classes"] == ["unbroken"] for node in found if isinstance(node, nodes.inline))


@pytest.mark.parametrize(("holder", "running"), [(nodes.emphasis, True), (nodes.literal, False)])
def test_code_is_left_alone(holder, running):
    text = nodes.Text("(3-20)")
    nodes.paragraph("", "", holder("", "", text))
    assert is_running_text(text) is running


@pytest.mark.parametrize(
    ("text", "kept"),
    [
        ("63.52 % of", "63.52\N{NO-BREAK SPACE}% of"),
        (" % after a number that is quoted", "\N{NO-BREAK SPACE}% after a number that is quoted"),
        ("unstable [%], a % sign", "unstable [%], a % sign"),
    ],
)
def test_a_per_cent_stays_with_its_number(text, kept):
    assert with_percent_kept(text) == kept


def test_a_stop_stays_with_the_formula_before_it():
    first, text = nodes.Text("), and so on."), nodes.Text("), and so on.")
    paragraph = nodes.paragraph("", "", nodes.math("", "k_1"), first, nodes.math("", "k_2"), text)
    rest = keep_with_formula(text)
    assert rest == " and so on."
    assert paragraph.astext() == "k_1), and so on.k_2), and so on."
    assert paragraph[1] is first  # though it reads alike
    whole = paragraph[2]
    assert whole["classes"] == ["unbroken"]
    assert whole.astext() == "k_2),"


@pytest.mark.parametrize("text", [" and so on", "-th"])
def test_other_text_after_a_formula_is_left_alone(text):
    node = nodes.Text(text)
    paragraph = nodes.paragraph("", "", nodes.math("", "k"), node)
    assert keep_with_formula(node) is node
    assert len(paragraph) == 2
