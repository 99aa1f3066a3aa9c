"""Extension of Sphinx: what belongs together is not parted where a line ends.

That is the number of an equation of the dissertation, as (3-20) or each of (3-9 to 3-11); a number and its per cent; a
formula and the stop after it.
"""

import re
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.transforms.post_transforms import SphinxPostTransform

# In parentheses of its own; or in some that have nothing but numbers and words: (7-5, 7-6), (section 2.1, 2-10).
NUMBER = re.compile(
    r"(\(\d{1,2}-\d{1,2}[a-z]?\)|(?<![\w.+/-])[2-8]-\d{1,2}[a-z]?(?=(?:(?: to |, | and )[^()]*)?\)))"
)
PERCENT = re.compile(r"(?:(?<=\d)|^)[ \n]%")
CLOSING = re.compile(r"^[.,;:!?)\]]+")
# In these a text is not what a reader reads as running text, or is used again elsewhere.
LEFT_ALONE = (nodes.literal, nodes.literal_block, nodes.math, nodes.math_block, nodes.raw, nodes.title)


def pieces(text: str) -> list[nodes.Node]:
    """Return a text as nodes, the numbers of equations in it each in a span of the class `unbroken`."""
    parts = NUMBER.split(text)  # every second one is a number
    return [
        nodes.inline(part, part, classes=["unbroken"]) if place % 2 else nodes.Text(part)
        for place, part in enumerate(parts)
        if part
    ]


def with_percent_kept(text: str) -> str:
    """Join each per cent to the number before it, which may end the node before, by a space that does not break."""
    return PERCENT.sub("\N{NO-BREAK SPACE}%", text)


def place_of(node: nodes.Node) -> int:
    """Return where a node stands in its parent: it and no other, for texts that read alike are equal."""
    return next(place for place, child in enumerate(node.parent.children) if child is node)


def keep_with_formula(text: nodes.Text) -> nodes.Text:
    """Put a formula and what closes it into one span, if a text begins so; return the text that is left."""
    siblings, place = text.parent.children, place_of(text)
    closing = CLOSING.match(text)
    if closing is None or place == 0 or not isinstance(siblings[place - 1], nodes.math):
        return text
    parent, rest = text.parent, nodes.Text(text[closing.end() :])
    whole = nodes.inline("", "", siblings[place - 1].deepcopy(), nodes.Text(closing[0]), classes=["unbroken"])
    parent[place - 1 : place + 1] = [whole, rest]
    return rest


def is_running_text(node: nodes.Node) -> bool:
    """Say whether none of what a node stands in is left alone."""
    while node.parent is not None:
        node = node.parent
        if isinstance(node, LEFT_ALONE):
            return False
    return True


class KeepTogether(SphinxPostTransform):
    """Put what belongs together into spans that the style sheet keeps on one line."""

    default_priority = 900  # outputs of cells are text of the page by then
    formats = ("html",)

    def run(self, **_: Any) -> None:
        """Go through the texts of a page."""
        for text in list(self.document.findall(nodes.Text)):
            if text.parent is None or not is_running_text(text):  # extensions leave texts that have no parent
                continue
            left = keep_with_formula(text)
            kept = with_percent_kept(left)
            if NUMBER.search(kept) or kept != left:
                place = place_of(left)
                left.parent[place : place + 1] = pieces(kept)


def setup(app: Sphinx) -> dict[str, bool]:
    """Tell Sphinx what is here."""
    app.add_post_transform(KeepTogether)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
