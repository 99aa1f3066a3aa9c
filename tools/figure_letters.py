"""Extension of Sphinx: figures are numbered page by page, a letter for the page and a number on it, as Fig. D5.

The dissertation's figures are numbered by its chapters, as Fig. 4.4(a). The book's have letters, in the order of its
contents, so that neither is taken for the other, and a figure more on one page changes no number on the next.
"""

from collections.abc import Iterable, Mapping
from string import ascii_uppercase
from typing import Any

from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment

Numbers = dict[str, dict[str, dict[str, tuple[Any, ...]]]]


def lettered(numbers: Numbers, pages: Iterable[str]) -> Numbers:
    """Return the numbers of all figures by page and label, with letters for the pages.

    Parameters
    ----------
    numbers : mapping of str to mapping
        Sphinx's own ``toc_fignumbers``: page, kind of number, label.
    pages : iterable of str
        All pages in their order.

    Raises
    ------
    ValueError
        If there are more pages with figures than letters.
    """
    illustrated = [page for page in pages if numbers.get(page, {}).get("figure")]
    if len(illustrated) > len(ascii_uppercase):
        raise ValueError(
            f"{len(illustrated)} pages have figures, and there are {len(ascii_uppercase)} letters"
        )
    changed = dict(numbers)
    for letter, page in zip(ascii_uppercase, illustrated, strict=False):
        figures = sorted(numbers[page]["figure"], key=numbers[page]["figure"].__getitem__)
        changed[page] = numbers[page] | {
            "figure": {label: (f"{letter}{count}",) for count, label in enumerate(figures, start=1)}
        }
    return changed


def in_order(contents: Mapping[str, list[str]], page: str) -> list[str]:
    """Return a page and all below it, depth first, as the table of contents has them."""
    return [page, *(name for part in contents.get(page, []) for name in in_order(contents, part))]


def number_figures(app: Sphinx, env: BuildEnvironment) -> list[str]:
    """Answer Sphinx's event `env-get-updated`, after Sphinx has numbered the figures in its answer to it."""
    pages = in_order(env.toctree_includes, app.config.root_doc)
    env.toc_fignumbers = lettered(env.toc_fignumbers, pages)
    return []


def setup(app: Sphinx) -> dict[str, bool]:
    """Tell Sphinx what is here."""
    app.connect("env-get-updated", number_figures, priority=900)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
