"""Extension of Sphinx: pages do without Thebe, which Jupyter Book loads on each though no page runs code with it.

Sphinx has its script from the list of scripts and, as the builder is there by then, from the builder: twice, so that a
browser complains of a name that is declared already.
"""

from collections.abc import Iterable
from typing import Any

from sphinx.application import Sphinx


def without_thebe(scripts: Iterable[Any]) -> list[Any]:
    """Return the scripts of a page but those of Thebe.

    Parameters
    ----------
    scripts : iterable of str or sphinx.builders.html._assets._JavaScript
    """
    return [script for script in scripts if not _is_thebe(script)]


def _is_thebe(script: Any) -> bool:
    """Say so by the name of a script's file, or by the variable that the one without a file sets.

    Data of a page, such as the pictures of its sliders, are scripts too: letters alone may stand in them by chance.
    """
    body = getattr(script, "attributes", {}).get("body") or ""
    return "thebe" in str(getattr(script, "filename", script)).lower() or "THEBE_JS_URL" in body


def drop(_app: Sphinx, _page: str, _template: str, context: dict[str, Any], _doctree: Any) -> None:
    """Answer Sphinx's event `html-page-context`."""
    context["script_files"] = without_thebe(context.get("script_files", []))


def setup(app: Sphinx) -> dict[str, bool]:
    """Tell Sphinx what is here."""
    app.connect("html-page-context", drop, priority=900)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
