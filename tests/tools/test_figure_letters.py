"""Figures are numbered page by page."""

import pytest

from tools.figure_letters import in_order, lettered


def test_pages_with_figures_get_letters_in_the_order_of_the_contents():
    contents = {"intro": ["one", "plain", "two"], "one": ["below"]}
    numbers = {
        "two": {"figure": {"fig-c": (9,), "fig-d": (10,)}, "table": {"tab": (1,)}},
        "one": {"figure": {"fig-a": (1,)}},
        "below": {"figure": {"fig-b": (2,)}},
        "plain": {"figure": {}},
    }
    found = lettered(numbers, in_order(contents, "intro"))
    assert found["one"]["figure"] == {"fig-a": ("A1",)}
    assert found["below"]["figure"] == {"fig-b": ("B1",)}
    assert found["two"] == {"figure": {"fig-c": ("C1",), "fig-d": ("C2",)}, "table": {"tab": (1,)}}
    assert found["plain"] == {"figure": {}}


def test_more_pages_than_letters_are_refused():
    numbers = {str(page): {"figure": {f"fig-{page}": (page,)}} for page in range(27)}
    with pytest.raises(ValueError, match="27 pages have figures, and there are 26 letters"):
        lettered(numbers, numbers)
