"""The page of public names, and how references in docstrings are resolved."""

import ast
import builtins
import doctest
import re
from pathlib import Path
from pydoc import locate

import pytest
import yaml

import facegear as fg
from tools.public_names import below, candidates, describe, found, public_name

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "book" / "api.md"


def test_page_has_every_public_name_once():
    described = re.findall(
        r"^\.\. auto(?:class|function|data):: (\w+)$", PAGE.read_text("utf-8"), re.MULTILINE
    )
    assert sorted(described) == sorted(fg.__all__)


def test_page_lists_at_the_head_of_a_section_what_the_section_has():
    for section in PAGE.read_text("utf-8").split("\n## ")[1:]:
        listed = re.findall(r"^   (\w+)$", section, re.MULTILINE)
        assert listed == re.findall(r"^\.\. auto(?:class|function|data):: (\w+)$", section, re.MULTILINE)


def description(name):
    return "\n".join(below(name)) or getattr(fg, name).__doc__


@pytest.mark.parametrize("name", sorted(fg.__all__))
def test_every_public_name_has_an_example(name):
    assert ">>> " in description(name)


@pytest.mark.parametrize("name", sorted(fg.__all__))
def test_a_copied_example_brings_all_its_names_along(name):
    examples = doctest.DocTestParser().get_examples(description(name))
    nodes = list(ast.walk(ast.parse("".join(example.source for example in examples))))
    used = {node.id for node in nodes if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load)}
    made = {node.id for node in nodes if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)}
    made |= {node.arg for node in nodes if isinstance(node, ast.arg)}
    made |= {node.name for node in nodes if isinstance(node, ast.FunctionDef | ast.ClassDef)}
    for node in nodes:
        if isinstance(node, ast.Import | ast.ImportFrom):
            made |= {(alias.asname or alias.name).split(".")[0] for alias in node.names}
    assert not used - made - set(dir(builtins))


def test_name_is_followed_from_its_module_on():
    assert found("facegear.floquet.methods.with_method")[-1] is not None
    assert found("facegear.floquet.periodic.PeriodicSystem.fourier")[-1] is fg.PeriodicSystem.fourier
    assert found("facegear.mechanics.properties.MeshLoad.stiffness")  # a field without default
    assert found("facegear.floquet.multipliers.no_such_method") == []
    assert found("no_such_package.name") == []


def test_short_name_is_looked_for_in_the_class_and_in_the_module_of_its_docstring():
    near = candidates("jumps", "facegear.PeriodicSystem.state_jumps")
    assert near[:2] == ["facegear.floquet.periodic.PeriodicSystem.jumps", "facegear.floquet.periodic.jumps"]
    assert (
        candidates("block_bands", "facegear.floquet.hsu.resonance_bands")[0]
        == "facegear.floquet.hsu.block_bands"
    )


def test_public_object_is_known_by_where_it_is_defined_too():
    assert public_name(found("facegear.maps.stability_map.stability_map")[-1]) == "stability_map"
    assert public_name(found("facegear.floquet.methods.with_method")[-1]) == ""


def outside_names():
    """Return the names that the stored inventories know, and what `_config.yml` links them from."""
    config = yaml.safe_load((ROOT / "_config.yml").read_text("utf-8"))["sphinx"]["config"]
    names = []
    for _, path in config["intersphinx_mapping"].values():
        names += (line.split()[0] for line in (ROOT / "book" / path).read_text("utf-8").splitlines()[3:])
    return names, config["numpydoc_xref_aliases"]


def test_names_of_other_libraries_exist_and_each_has_its_word():
    names, aliases = outside_names()
    assert sorted(re.sub(r":obj:`(.*)`", r"\1", target) for target in aliases.values()) == sorted(names)
    assert all(locate(name) is not None for name in names)


def test_a_public_value_is_described_by_what_stands_below_it_and_not_by_its_class():
    lines = ["Isotropic linear elastic material."]
    describe(None, "data", "facegear.STEEL", None, None, lines)
    assert "table 4.3" in lines[0]
    assert any(line.startswith(">>> fg.STEEL") for line in lines)
    assert below("Drive") == []
    kept = ["Bevel drive."]
    describe(None, "class", "facegear.Drive", None, None, kept)
    assert kept == ["Bevel drive."]
