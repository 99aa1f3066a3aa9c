"""Drive files written: read again they say the same, to the last digit, and people can read them."""

import re
from dataclasses import replace

import pytest
import yaml
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from facegear.drives.drive_file import DriveFileError, parse_drive, read_drive_file
from facegear.drives.drive_keys import NAME, SECTIONS
from facegear.drives.drive_text import drive_text, write_drive_file
from facegear.drives.examples import about, example_names, example_text
from facegear.support.plain_yaml import read_plain_yaml

examples = pytest.mark.parametrize("name", example_names())


@examples
def test_examples_come_back_to_the_last_digit(tmp_path, name):
    file = parse_drive(example_text(name))
    again = read_drive_file(write_drive_file(file, tmp_path / "folder" / "my_drive.yaml"))
    assert again == file
    assert again.content == file.content
    assert about(name).endswith(".")


def value_of(key):
    """Values that a key may have by itself, in every way in which they can be written."""
    if key.kind == "text":
        return st.text(st.characters(exclude_categories=["Cs"]), min_size=1, max_size=80)
    if key.kind == "choice":
        return st.sampled_from(key.choices)
    if key.kind == "choices":
        return st.lists(st.sampled_from(key.choices), min_size=key.fewest, max_size=12)
    if key.kind == "integer":
        return st.integers(int(key.lowest), int(key.highest))
    number = st.floats(key.lowest, key.highest)
    if key.highest >= 1:
        number |= st.integers(int(key.lowest) + 1, int(key.highest))
    return number if key.kind == "number" else st.lists(number, min_size=1, max_size=12)


WHOLE = {
    NAME.name: value_of(NAME),
    **{
        name: st.fixed_dictionaries({}, optional={key.name: value_of(key) for key in section.keys})
        for name, section in SECTIONS.items()
    },
}


@given(st.fixed_dictionaries({NAME.name: WHOLE.pop(NAME.name)}, optional=WHOLE))
def test_whatever_a_file_says_is_written_as_it_is(content):
    """Whether it can be used or not: every key, any name, numbers to the last digit."""
    assert read_plain_yaml(drive_text(content)) == content


CASE_1 = yaml.safe_load(example_text("case_1"))
GEARBOX = yaml.safe_load(example_text("gearbox_table_7_1"))["gearbox"]
NEAR = {
    "gears": {
        "pinion_teeth": st.integers(20, 40),
        "gear_teeth": st.integers(90, 180),
        "module_mm": st.floats(1.0, 6.0),
        "pressure_angle_deg": st.floats(18.0, 28.0),
    },
    "body": {"thickness_ratio": st.floats(0.02, 0.08), "nodal_diameters": st.integers(2, 4)},
    "material": {"youngs_modulus_GPa": st.floats(60.0, 220.0), "viscous_loss_factor_us": st.floats(1.0, 9.0)},
    "pinions": {
        "stiffness": st.floats(0.1, 3.0),
        "damping_us": st.floats(0.5, 20.0),
        "mass": st.floats(0.1, 2.0),
        "angles_deg": st.lists(st.floats(-180.0, 180.0), min_size=1, max_size=3),
    },
    "operation": {
        "power_kW": st.floats(1.0, 900.0),
        "safety_factor": st.floats(1.0, 3.0),
        "force_at": st.sampled_from(["rim", "pitch", "tooth"]),
    },
}


@settings(max_examples=40)
@given(
    st.fixed_dictionaries({}, optional={n: st.fixed_dictionaries({}, optional=o) for n, o in NEAR.items()}),
    st.booleans(),
)
def test_models_come_back_to_the_last_digit(changes, with_gearbox):
    content = {
        n: CASE_1[n] | changes.get(n, {}) if n in CASE_1 and n != "name" else CASE_1.get(n) for n in CASE_1
    }
    content |= {"material": changes["material"]} if changes.get("material") else {}
    content |= {"gearbox": GEARBOX} if with_gearbox else {}
    try:
        file = parse_drive(drive_text(content))
    except DriveFileError:
        assume(False)
    again = parse_drive(drive_text(file.content))
    assert again == file
    assert again.transverse.gear.body.drive.module == content["gears"]["module_mm"] / 1e3


def test_a_section_that_is_there_with_nothing_in_it_stays():
    content = CASE_1 | {"teeth": {}, "material": {}, "gearbox": GEARBOX}
    text = drive_text(content)
    assert read_plain_yaml(text) == content
    assert parse_drive(text).teeth is not None


def test_a_file_whose_parts_were_exchanged_is_not_written(tmp_path):
    file = parse_drive(example_text("case_1"))
    other = replace(file, requirements=replace(file.requirements, power=1e3))
    with pytest.raises(ValueError, match=r"file = 'Case I' must be as it was .* else than requirements$"):
        write_drive_file(other, tmp_path / "my_drive.yaml")
    bare = replace(file, content={})
    with pytest.raises(ValueError, match="its content is no drive: "):
        write_drive_file(bare, tmp_path / "my_drive.yaml")
    assert not list(tmp_path.iterdir())


def test_every_key_has_a_comment_and_those_left_out_their_values():
    text = drive_text(CASE_1)
    assert "  module_mm: 3.175 # m_d, module; not a diametral pitch [mm]\n" in text
    assert "  # pressure_angle_deg: 25.0 # α_c, pressure angle [°]\n" in text
    assert "# gearbox: may have the keys pinion_inertia_kg_m2," in text
    names = "|".join([*SECTIONS, *(key.name for section in SECTIONS.values() for key in section.keys)])
    uncommented = re.sub(rf"^( *)# ( *)(?=({names}):(?! may have))", r"\1\2", text, flags=re.MULTILINE)
    assert "\n  pressure_angle_deg: 25.0" in uncommented
    # With what is commented out switched on the drive is the same.
    assert parse_drive(uncommented) == parse_drive(text)


def test_an_example_that_there_is_not():
    with pytest.raises(ValueError, match=r"name must be one of both_faces, case_1, .*, got 'case_9'"):
        example_text("case_9")
