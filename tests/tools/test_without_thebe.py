"""A page keeps all scripts but those of Thebe."""

from types import SimpleNamespace

from tools.without_thebe import without_thebe


def script(filename, body=""):
    return SimpleNamespace(filename=filename, attributes={"body": body} if body else {})


def test_only_those_of_thebe_are_dropped():
    kept = [script("_static/views.js"), script(None, "const DOCUMENTATION = 1"), "_static/code_links.js"]
    kept += [script(None, "a picture in letters: iVBORtHeBe0KGgo")]
    dropped = [script("_static/sphinx-thebe.js"), script(None, 'const THEBE_JS_URL = "…"')]
    assert without_thebe([dropped[0], *kept, dropped[1]]) == kept
