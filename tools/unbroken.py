"""Extension of Sphinx: no line ends within the number of an equation, as (3-20), or before a percent sign, as 19 %."""

import re
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.transforms.post_transforms import SphinxPostTransform

NUMBER = re.compile(r"(\(\d{1,2}-\d{1,2}[a-z]?\)|[-+−]?\d[\d.,]* %)")
# In these a text is not what a reader reads as running text, or is used again elsewhere.
LEFT_ALONE = (nodes.literal, nodes.literal_block, nodes.math, nodes.math_block, nodes.raw, nodes.title)


def pieces(text: str) -> list[nodes.Node]:
    """Return a text as nodes, numbers of equations and percentages in it each in a span of the class `unbroken`."""
    parts = NUMBER.split(text)  # every second one is a number
    return [
        nodes.inline(part, part, classes=["unbroken"]) if place % 2 else nodes.Text(part)
        for place, part in enumerate(parts)
        if part
    ]


def is_running_text(node: nodes.Node) -> bool:
    """Say whether none of what a node stands in is left alone."""
    while node.parent is not None:
        node = node.parent
        if isinstance(node, LEFT_ALONE):
            return False
    return True


class KeepNumbersWhole(SphinxPostTransform):
    """Put numbers of equations and percentages into spans that the style sheet keeps on one line."""

    default_priority = 900  # outputs of cells are text of the page by then
    formats = ("html",)

    def run(self, **_: Any) -> None:
        """Go through the texts of a page."""
        for text in list(self.document.findall(nodes.Text)):
            if NUMBER.search(text) and is_running_text(text):
                text.parent.replace(text, pieces(text))


def setup(app: Sphinx) -> dict[str, bool]:
    """Tell Sphinx what is here."""
    app.add_post_transform(KeepNumbersWhole)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
