"""Extension of Sphinx: references in docstrings, whether the page of public names has what they name or not.

A docstring names its neighbours as the code calls them, `with_method` or `facegear.maps.stability_map.stability_map`.
One that is public becomes a link to the page; one that exists and is not public stays code without a link; one that
does not exist is left to Sphinx, which complains.

A public name that is a value has its docstring below it, in the module that defines it, where Sphinx does not look.

The types of parameters and results are links too, through numpydoc: public names, and what `book/inventories` has
of other libraries. Words such as `float` that everybody knows are not.
"""

import ast
import importlib
import re
from dataclasses import fields, is_dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

from docutils import nodes
from numpydoc.xref import DEFAULT_LINKS
from sphinx.addnodes import pending_xref
from sphinx.application import Sphinx
from sphinx.config import Config
from sphinx.environment import BuildEnvironment
from sphinx.pycode import ModuleAnalyzer
from sphinx.util.logging import get_node_location

import facegear


def found(name: str) -> list[Any]:
    """Return the objects that a dotted name passes through from its module on, or nothing if there is none such."""
    words = name.split(".")
    for count in range(len(words), 0, -1):
        try:
            passed = [importlib.import_module(".".join(words[:count]))]
        except ImportError:
            continue
        for word in words[count:]:
            last = passed[-1]
            if is_dataclass(last) and word in {field.name for field in fields(last)}:
                passed.append(getattr(last, word, None))
            elif hasattr(last, word):
                passed.append(getattr(last, word))
            else:
                return []
        return passed
    return []


def candidates(target: str, owner: str) -> list[str]:
    """Return what a name in the docstring of `owner` may be short for, nearest first."""
    passed = found(owner)
    near = []
    if len(passed) > 1:
        first = passed[1] if isinstance(passed[0], ModuleType) else passed[0]
        if isinstance(first, type):
            near.append(f"{first.__module__}.{first.__qualname__}.{target}")
        module = getattr(first, "__module__", "")
        near.append(f"{module}.{target}")
    return [*near, target]


def public_name(thing: Any) -> str:
    """Return the public name of an object, or an empty string."""
    return next((name for name in facegear.__all__ if getattr(facegear, name) is thing), "")


def below(name: str) -> list[str]:
    """Return the lines that describe a public value below its definition, as `facegear/__init__.pyi` has its place."""
    for node in ast.parse(Path(facegear.__file__).with_suffix(".pyi").read_text(encoding="utf-8")).body:
        if isinstance(node, ast.ImportFrom) and any(alias.name == name for alias in node.names):
            described = ModuleAnalyzer.for_module(f"facegear.{node.module}").find_attr_docs()
            return described.get(("", name), [])
    return []


def describe(_app: Sphinx, what: str, name: str, _thing: object, _options: object, lines: list[str]) -> None:
    """Answer autodoc's event of a docstring: that of a value is not that of its class."""
    if what == "data" and (own := below(name.removeprefix("facegear."))):
        lines[:] = own


def resolve(
    app: Sphinx, env: BuildEnvironment, node: pending_xref, contnode: nodes.TextElement
) -> nodes.Element | None:
    """Answer Sphinx's event `missing-reference`."""
    if node.get("refdomain") != "py":
        return None
    owner = re.search(r"docstring of ([\w.]+)", get_node_location(node) or "")
    for name in candidates(node["reftarget"], owner[1] if owner else "facegear"):
        passed = found(name)
        if passed and name.startswith("facegear."):
            public = public_name(passed[-1])
            if not public:
                return contnode
            return env.domains["py"].resolve_xref(
                env, node["refdoc"], app.builder, "obj", f"facegear.{public}", node, contnode
            )
    return None


def link_types(app: Sphinx, config: Config) -> None:
    """Tell numpydoc which words of a type are links: its own are not, public names are."""
    # All others: as a text of `_config.yml` Jupyter Book would not let it through.
    config.numpydoc_xref_ignore = "all"
    own = {name: f"facegear.{name}" for name in facegear.__all__}
    config.numpydoc_xref_aliases = {word: word for word in DEFAULT_LINKS} | own | config.numpydoc_xref_aliases


def setup(app: Sphinx) -> dict[str, bool]:
    """Tell Sphinx what is here."""
    app.connect("missing-reference", resolve)
    app.connect("autodoc-process-docstring", describe, priority=100)  # before numpydoc does
    app.connect("config-inited", link_types, priority=100)  # before numpydoc looks at them
    return {"parallel_read_safe": True, "parallel_write_safe": True}
