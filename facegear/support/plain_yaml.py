"""YAML as people write it by hand: sections, lists, words and numbers, and nothing that could surprise.

Of YAML only that part is read which means the same to everyone. Refused are keys given twice, which YAML's usual
readers let pass with the last one winning, anchors and aliases, with which ten lines grow to gigabytes, tags, more
than one document, and nesting deeper than any such file needs. Numbers are those of YAML 1.2, so that ``3e-6`` is
one; dates, ``yes`` and ``1:30`` stay words.
"""

from __future__ import annotations

import re
from typing import Any

import yaml

LARGEST_FILE = 64 * 1024
DEEPEST = 8
_LONGEST_NUMBER = 40

_INTEGER = re.compile(r"[-+]?\d+", re.ASCII)
_FLOAT = re.compile(r"[-+]?(\.\d+|\d+(\.\d*)?)([eE][-+]?\d+)?", re.ASCII)
_SPECIAL = {
    **dict.fromkeys(("null", "Null", "NULL", "~", "")),
    **dict.fromkeys(("true", "True", "TRUE"), True),
    **dict.fromkeys(("false", "False", "FALSE"), False),
    **dict.fromkeys((".nan", ".NaN", ".NAN"), float("nan")),
    **dict.fromkeys((".inf", ".Inf", ".INF", "+.inf"), float("inf")),
    **dict.fromkeys(("-.inf", "-.Inf", "-.INF"), float("-inf")),
}


class PlainYamlError(ValueError):
    """The text is not plain YAML; the message says where and why."""


def read_plain_yaml(content: bytes | str) -> Any:
    """Read one plain YAML document.

    Parameters
    ----------
    content : bytes or str
        The text; bytes are UTF-8, with or without a byte order mark.

    Returns
    -------
    object
        dict, list, str, int, float, bool or None, nested.

    Raises
    ------
    TypeError
        If `content` is neither bytes nor text.
    PlainYamlError
        If it is too long, not UTF-8, not YAML, or more than plain YAML.
    """
    if not isinstance(content, bytes | str):
        raise TypeError(f"content must be bytes or text, got {type(content).__name__}")
    if len(content) > LARGEST_FILE:
        raise PlainYamlError(f"the file is longer than {LARGEST_FILE // 1024} kB, which no such file needs")
    try:
        text = content.decode("utf-8-sig") if isinstance(content, bytes) else content
        # Depth first: composing and constructing are recursive, scanning is not.
        _check_events(text)
        node = yaml.compose(text, Loader=yaml.SafeLoader)
    except UnicodeError as error:
        raise PlainYamlError(f"the file is not text in UTF-8 ({error})") from None
    except yaml.YAMLError as error:
        raise PlainYamlError(f"the file is not YAML: {' '.join(str(error).split())}") from None
    return None if node is None else _value(node, "")


def _check_events(text: str) -> None:
    depth = 0
    for event in yaml.parse(text, Loader=yaml.SafeLoader):
        line = _line(event)
        if isinstance(event, yaml.AliasEvent) or getattr(event, "anchor", None):
            raise PlainYamlError(f"line {line}: anchors and aliases (& and *) are not allowed")
        if getattr(event, "tag", None):
            raise PlainYamlError(f"line {line}: tags (!) are not allowed")
        if isinstance(event, yaml.CollectionStartEvent):
            depth += 1
        elif isinstance(event, yaml.CollectionEndEvent):
            depth -= 1
        if depth > DEEPEST:
            raise PlainYamlError(f"line {line}: nested deeper than {DEEPEST} levels")


def _value(node: yaml.Node, path: str) -> Any:
    """Python value of a node at a dotted path."""
    if isinstance(node, yaml.MappingNode):
        found: dict[str, Any] = {}
        for key_node, value_node in node.value:
            line = _line(key_node)
            if not isinstance(key_node, yaml.ScalarNode):
                raise PlainYamlError(f"line {line}: a key must be a word")
            key = _text(key_node)
            name = key if key.isprintable() else repr(key)
            here = f"{path}.{name}" if path else name
            if key in found:
                raise PlainYamlError(f"line {line}: {here} is given twice")
            found[key] = _value(value_node, here)
        return found
    if isinstance(node, yaml.SequenceNode):
        return [_value(entry, f"{path}[{i}]") for i, entry in enumerate(node.value)]
    # A scalar in quotes is a word whatever it looks like.
    quoted = getattr(node, "style", None)
    return _text(node) if quoted else _plain_scalar(_text(node))


def _text(node: yaml.Node) -> str:
    """Text of a scalar; half a character, which YAML's escapes can write and no file can hold, is refused."""
    text = str(node.value)
    if any("\ud800" <= letter <= "\udfff" for letter in text):
        raise PlainYamlError(
            f"line {_line(node)}: {text!r} holds half a character (a surrogate), which is no text"
        )
    return text


def _line(part: yaml.Event | yaml.Node) -> int:
    """Line of the file that an event or a node stands in, from 1."""
    return 1 if part.start_mark is None else part.start_mark.line + 1


def _plain_scalar(text: str) -> Any:
    """Value of a scalar without quotes, after the core schema of YAML 1.2 but for octal and hexadecimal numbers."""
    if text in _SPECIAL:
        return _SPECIAL[text]
    if len(text) <= _LONGEST_NUMBER and _INTEGER.fullmatch(text):
        return int(text)
    if len(text) <= _LONGEST_NUMBER and _FLOAT.fullmatch(text):
        return float(text)
    return text
