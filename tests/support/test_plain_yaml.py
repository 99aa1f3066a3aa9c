"""Plain YAML: what is read, what is refused."""

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from facegear.support.plain_yaml import LARGEST_FILE, PlainYamlError, read_plain_yaml


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("a: 3e-6", {"a": 3e-6}),
        ("a: -1.5E+3", {"a": -1500.0}),
        ("a: 12", {"a": 12}),
        ("a: 010", {"a": 10}),
        ("a: .5", {"a": 0.5}),
        ("a: 1:30", {"a": "1:30"}),
        ("a: yes", {"a": "yes"}),
        ("a: true", {"a": True}),
        ("a: 2012-05-01", {"a": "2012-05-01"}),
        ("a: '3'", {"a": "3"}),
        ("a: 1_000", {"a": "1_000"}),
        ("a:", {"a": None}),
        ("a: [1, 2.0, x]", {"a": [1, 2.0, "x"]}),
        ("12: x", {"12": "x"}),
        ("a: ''", {"a": ""}),
        ("a: 1.", {"a": 1.0}),
        (b"\xef\xbb\xbfa: \xc2\xb0", {"a": "°"}),
        ("", None),
    ],
)
def test_scalars_are_those_of_yaml_1_2(text, value):
    assert read_plain_yaml(text) == value
    assert repr(read_plain_yaml(text)) == repr(value)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("a: {b: 1, b: 2}", "line 1: a.b is given twice"),
        ("a: 1\nc: 2\na: 3", "line 3: a is given twice"),
        ("a: &x [1]\nb: *x", "line 1: anchors and aliases"),
        ("a: !!python/object/apply:os.system ['true']", "line 1: tags"),
        ("a: !!int '3'", "line 1: tags"),
        ("? [1, 2]\n: x", "a key must be a word"),
        ("[" * 4000, "nested deeper than 8 levels"),
        ("a: 1\n--- \nb: 2", "not YAML"),
        ("a: [1", "not YAML"),
        ("\tx: 1", "not YAML"),
        ("a: \x07", "not YAML"),
        (b"\xff\xfea", "not text in UTF-8"),
        ("a: '" + "x" * LARGEST_FILE + "'", "longer than 64 kB"),
    ],
)
def test_what_could_surprise_is_refused(content, message):
    with pytest.raises(PlainYamlError) as caught:
        read_plain_yaml(content)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


def test_billion_laughs_are_refused_before_they_grow():
    lines = ["a0: &a0 [lol, lol]"] + [f"a{i}: &a{i} [*a{i - 1}, *a{i - 1}]" for i in range(1, 60)]
    with pytest.raises(PlainYamlError, match="anchors"):
        read_plain_yaml("\n".join(lines))


def test_neither_text_nor_bytes():
    with pytest.raises(TypeError, match="content must be bytes or text, got int"):
        read_plain_yaml(3)


# No digits: PyYAML, which reads YAML 1.1, writes the word 1e5 without quotes.
words = st.text("abnoy µ°ß-:#'\"{}[],&*!|>%@`~?", max_size=8)
plain = st.recursive(
    st.none() | st.booleans() | st.integers(-(10**30), 10**30) | st.floats(allow_nan=False) | words,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(words, inner, max_size=3),
    max_leaves=6,
)


@settings(max_examples=200, deadline=None, derandomize=True)
@given(plain)
def test_what_pyyaml_writes_comes_back(value):
    assert read_plain_yaml(yaml.safe_dump(value, allow_unicode=True)) == value


@settings(max_examples=300, deadline=None, derandomize=True)
@given(st.binary(max_size=60) | st.text(max_size=60))
def test_any_content_is_read_or_refused(content):
    try:
        found = read_plain_yaml(content)
    except PlainYamlError as error:
        found = str(error)
    assert found is None or isinstance(found, dict | list | str | int | float)
