"""Numbers of equations and percentages are kept on one line."""

import pytest
from docutils import nodes

from tools.unbroken import is_running_text, pieces


@pytest.mark.parametrize(
    ("text", "whole"),
    [
        ("By (3-20) and (4-2a).", ["(3-20)", "(4-2a)"]),
        ("(7-2)", ["(7-2)"]),
        ("19 % and -12.8 %, not 7 rpm", ["19 %", "-12.8 %"]),
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
