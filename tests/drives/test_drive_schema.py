"""What is made from the table of keys: schema, documentation."""

import json
from pathlib import Path

import jsonschema
import pytest
import yaml

from facegear.drives.drive_file import read_drive_file
from facegear.drives.drive_keys import NAME, SECTIONS
from facegear.drives.drive_schema import documentation, schema
from tools import document_drive_file

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = sorted((ROOT / "data" / "drives").glob("*.yaml"))
CASE_1 = (ROOT / "data" / "drives" / "case_1.yaml").read_text(encoding="utf-8")
VALIDATOR = jsonschema.Draft202012Validator(schema())


def content(path):
    return yaml.safe_load(path.read_text(encoding="utf-8"))


def test_schema_is_valid_and_stored():
    jsonschema.Draft202012Validator.check_schema(schema())
    stored = (ROOT / "data" / "drive.schema.json").read_text(encoding="utf-8")
    assert stored == document_drive_file.schema_text(), "run python tools/document_drive_file.py"
    assert json.loads(stored) == schema()


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_examples_obey_the_schema(path):
    VALIDATOR.validate(content(path))
    assert read_drive_file(path).name == content(path)["name"]


@pytest.mark.parametrize(
    ("section", "key", "value"),
    [
        ("gears", "module_mm", 0.003),
        ("gears", "diametral_pitch_per_inch", 8),
        ("operation", "power_hp", 600),
        ("gears", "pinion_teeth", 26.5),
        ("gears", "teeth", 3),
        ("pinions", "damping_us", 3e-6),
        ("pinions", "angles_deg", []),
        ("pinions", "contact_ratio", "mine"),
        ("body", "thickness_ratio", "thick"),
        ("teeth", "sides", [0.5]),
        ("teeth", "sides", ["front"]),
        ("operation", "safety_factor", 0.5),
    ],
)
def test_schema_and_reader_refuse_the_same_mistakes(section, key, value, tmp_path):
    wrong = yaml.safe_load(CASE_1)
    wrong.setdefault(section, {})[key] = value
    assert not VALIDATOR.is_valid(wrong)
    path = tmp_path / "wrong.yaml"
    path.write_text(yaml.safe_dump(wrong), encoding="utf-8")
    with pytest.raises(ValueError, match=f"{section}.{key}"):
        read_drive_file(path)


@pytest.mark.parametrize("name", [name for name, section in SECTIONS.items() if section.required])
def test_a_required_section_is_required_by_both(name, tmp_path):
    wrong = yaml.safe_load(CASE_1)
    del wrong[name]
    assert not VALIDATOR.is_valid(wrong)
    path = tmp_path / "wrong.yaml"
    path.write_text(yaml.safe_dump(wrong), encoding="utf-8")
    with pytest.raises(ValueError, match=f"{name} is missing"):
        read_drive_file(path)


def test_page_holds_the_tables_and_the_example():
    page = (ROOT / "book" / "drive_file.md").read_text(encoding="utf-8")
    assert page == document_drive_file.page_text(page), "run python tools/document_drive_file.py"
    assert f"```yaml\n{CASE_1}```" in page


def test_every_key_is_documented_with_its_unit():
    text = documentation()
    for key in [NAME, *(key for section in SECTIONS.values() for key in section.keys)]:
        (row,) = [line for line in text.splitlines() if line.startswith(f"| `{key.name}` |")]
        assert key.meaning in row
        assert not key.unit or f"| {key.unit} |" in row
