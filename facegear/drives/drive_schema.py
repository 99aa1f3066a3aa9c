"""The table of keys told to others: a JSON Schema to editors and validators, tables in Markdown to readers."""

from __future__ import annotations

from typing import Any

from facegear.drives.drive_keys import NAME, SECTIONS
from facegear.drives.keys import LONGEST_TEXT, MOST_PINIONS, Key, Section


def schema() -> dict[str, Any]:
    """JSON Schema (draft 2020-12) of a drive file, for editors and validators.

    It says what can be said key by key. Whether teeth, bore and speeds fit one another only
    :func:`facegear.drives.drive_file.parse_drive` can tell.
    """
    sections = {name: _section_schema(section) for name, section in SECTIONS.items()}
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Drive file of facegear",
        **_object(
            {NAME.name: _key_schema(NAME), **sections},
            [NAME.name, *(name for name, section in SECTIONS.items() if section.required)],
        ),
    }


def _object(properties: dict[str, Any], required: list[str]) -> dict[str, Any]:
    return {
        "type": "object",
        "additionalProperties": False,
        "required": required,
        "properties": properties,
    }


def _section_schema(section: Section) -> dict[str, Any]:
    properties = {key.name: _key_schema(key) for key in section.keys}
    required = [key.name for key, *others in section.quantities() if key.default is None and not others]
    exactly_one = [
        {"oneOf": [{"required": [key.name]} for key in keys]}
        for keys in section.quantities()
        if len(keys) > 1
    ]
    choices = {"allOf": exactly_one} if exactly_one else {}
    return {"description": section.meaning, **_object(properties, required), **choices}


def _key_schema(key: Key) -> dict[str, Any]:
    unit = f" [{key.unit}]" if key.unit else ""
    told: dict[str, Any] = {"description": f"{key.meaning.replace('$', '')}{unit}"}
    if key.default is not None:
        told["default"] = list(key.default) if isinstance(key.default, tuple) else key.default
    if key.kind == "text":
        return told | {"type": "string", "maxLength": LONGEST_TEXT, "pattern": r"\S"}
    if key.kind == "choice":
        return told | {"enum": list(key.choices)}
    if key.kind == "choices":
        each = {"enum": list(key.choices)}
        return told | {"type": "array", "minItems": key.fewest, "maxItems": MOST_PINIONS, "items": each}
    ends = {"minimum": key.lowest, "maximum": key.highest}
    if key.kind == "numbers":
        return told | {
            "type": "array",
            "minItems": key.fewest,
            "maxItems": MOST_PINIONS,
            "items": {"type": "number", **ends},
        }
    if key.or_zero:
        return told | {"type": key.kind, "anyOf": [{"const": 0}, ends]}
    return told | {"type": key.kind, **ends}


def documentation() -> str:
    """Tables of all keys, in Markdown."""
    head = "| key | meaning | unit | valid | if left out |\n| --- | --- | --- | --- | --- |"
    parts = [f"{head}\n{_row(NAME, [])}"]
    for name, section in SECTIONS.items():
        optional = "" if section.required else " (may be left out)"
        rows = "\n".join(
            _row(key, [f"`{other.name}`" for other in keys if other is not key])
            for keys in section.quantities()
            for key in keys
        )
        parts.append(f"### `{name}`{optional}\n\n{section.meaning}\n\n{head}\n{rows}")
    return "\n\n".join(parts)


def _row(key: Key, others: list[str]) -> str:
    default = "required" if key.default is None else _shown_default(key.default)
    if others:
        default = f"this or {' or '.join(others)}"
    valid = key.valid.replace(f" {key.unit}", "") if key.unit else key.valid
    unit = "" if key.kind in ("text", "choices") else key.unit or "1"
    return f"| `{key.name}` | {key.meaning} | {unit} | {valid} | {default} |"


def _shown_default(value: Any) -> str:
    if isinstance(value, tuple):
        return f"[{', '.join(f'{entry:g}' for entry in value)}]"
    return value if isinstance(value, str) else f"{value:g}"
