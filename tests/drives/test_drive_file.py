"""Drive files: examples, what does not go together, and thousands of files that nobody would write."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from facegear.drives.drive_file import DriveFile, DriveFileError, parse_drive, read_drive_file
from facegear.drives.drive_keys import NAME, SECTIONS
from facegear.drives.forces import pressed
from facegear.mechanics import cases, gearboxes
from facegear.mechanics.edge_stiffness import DrivingForce
from facegear.mechanics.spreads import root_thickness
from facegear.support.parameters import rad_per_s
from tests.drives.drive_files import BOTH_FACES, CASE_1, DRIVES, GEARBOX, refusal

PATHS = [NAME.name, *SECTIONS, *(f"{n}.{key.name}" for n, s in SECTIONS.items() for key in s.keys)]


# --- examples -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("name", "body"), [("case_1", cases.CASE_1), ("case_2", cases.CASE_2)])
def test_cases_are_those_of_the_dissertation(name, body):
    found = read_drive_file(DRIVES / f"{name}.yaml")
    assert found.transverse.body.drive.pinion_teeth == body.drive.pinion_teeth
    assert found.drive.module == pytest.approx(body.drive.module, rel=1e-15)
    assert found.transverse.body.bore_radius == pytest.approx(body.bore_radius, rel=1e-15)
    assert found.transverse.body.material == body.material
    assert found.transverse.body.thickness_ratio == body.thickness_ratio
    assert found.requirements.speeds == pytest.approx((rad_per_s(100.0), rad_per_s(1000.0)), rel=1e-15)
    assert found.torsional is None


def test_example_b_is_that_of_the_caption():
    found = read_drive_file(DRIVES / "example_b.yaml").transverse
    assert (found.body.drive.pinion_teeth, found.body.drive.gear_teeth) == (31, 155)
    assert found.body.thickness_ratio == 0.07
    assert (found.load.stiffness, found.load.damping, found.load.mass) == pytest.approx((0.25, 1e-5, 1.0))
    assert np.degrees(found.pinion_angles) == pytest.approx([0.0, 120.0])


def test_gearbox_is_that_of_chapter_7():
    box = read_drive_file(DRIVES / "gearbox_table_7_1.yaml").torsional.gearbox
    printed = gearboxes.FIGURES["7.12a"].gearbox.in_si
    for name in ("pinion", "gear", "load"):
        assert getattr(box, f"{name}_inertia") == pytest.approx(getattr(printed, f"{name}_inertia"), rel=1e-8)
    for name in ("mesh", "input", "output"):
        for part in ("stiffness", "damping"):
            assert getattr(box, f"{name}_{part}") == pytest.approx(
                getattr(printed, f"{name}_{part}"), rel=1e-8
            )
    assert box.drive.contact_ratio == pytest.approx(printed.drive.contact_ratio, rel=1e-12)


def test_shafts_at_85_degrees():
    found = read_drive_file(DRIVES / "shaft_angle_85.yaml")
    assert math.degrees(found.drive.shaft_angle) == pytest.approx(85.0)
    assert found.transverse.body.material.youngs_modulus == pytest.approx(71e9)
    assert found.transverse.body.nodal_diameters == 4


def test_clock_of_the_true_sweep():
    found = parse_drive(CASE_1.replace("mass: 1.0", "mass: 1.0\n  contact_ratio: geometric"))
    assert found.transverse.contact_ratio == found.drive.geometric_contact_ratio
    box = parse_drive(GEARBOX.replace("mass: 1.0", "mass: 1.0\n  contact_ratio: geometric"))
    assert box.torsional.contact_ratio == box.drive.geometric_contact_ratio


class TestPlaceOfTheForce:
    def test_the_rim_unless_another_place_is_given(self):
        assert parse_drive(CASE_1).force_at == "rim"
        assert parse_drive(CASE_1.replace("power_kW", "force_at: pairs\n  power_kW")).force_at == "pairs"

    def test_an_unknown_place_is_refused(self):
        told = refusal(CASE_1.replace("power_kW", "force_at: tip\n  power_kW"))
        assert told == "operation.force_at must be rim or pitch or tooth or pairs, got 'tip'"

    @pytest.mark.parametrize("place", ["tooth", "pairs"])
    def test_roots_that_meet_are_as_thick_as_the_pitch(self, place):
        """At 30° roots as thick as the rack's would overlap at R1."""
        text = CASE_1.replace("module_mm", "pressure_angle_deg: 30\n  module_mm")
        text = text.replace("pinion_teeth: 26", "pinion_teeth: 40").replace(
            "gear_teeth: 130", "gear_teeth: 150"
        )
        found = parse_drive(text.replace("power_kW", f"force_at: {place}\n  power_kW"))
        drive = found.drive
        pitch = drive.inner_radius * drive.angular_pitch
        assert root_thickness(drive) > pitch
        points = pressed("tooth", found.transverse.contact, drive).points(drive)
        assert np.ptp(points.radius * points.angle) * drive.outer_radius == pytest.approx(
            pitch * np.polynomial.legendre.leggauss(4)[0][-1], rel=1e-9
        )


@pytest.mark.parametrize(
    ("old", "new"),
    [("module_mm: 3.175", "diametral_pitch_per_inch: 8"), ("power_kW: 447.42", "power_hp: 600.0001044")],
)
def test_the_same_in_another_unit(old, new):
    found, same = parse_drive(CASE_1.replace(old, new)), parse_drive(CASE_1)
    assert found.drive.module == pytest.approx(same.drive.module, rel=1e-15)
    assert found.requirements.power == pytest.approx(same.requirements.power, rel=1e-9)


@pytest.mark.parametrize(
    "name",
    ["<img src=x onerror='1'>", "a\nb", "# heading", "=1+1", "\u202e\x1b[31m", "Zahnrad Ⅱ 🦷", "a" * 80],
)
def test_a_name_is_any_text(name):
    content = {**yaml.safe_load(CASE_1), "name": name}
    assert parse_drive(yaml.safe_dump(content)).name == name


@pytest.mark.parametrize("name", ["case_1", "case_2", "shaft_angle_85"])
def test_every_speed_that_is_accepted_can_be_computed(name):
    content = yaml.safe_load((DRIVES / f"{name}.yaml").read_text(encoding="utf-8"))
    low, high = 1000.0, 1e5
    while high - low > 1e-3:
        middle = (low + high) / 2
        content["operation"].update(lowest_speed_rpm=middle / 50, highest_speed_rpm=middle)
        try:
            parse_drive(yaml.safe_dump(content))
        except DriveFileError:
            high = middle
        else:
            low = middle
    content["operation"].update(lowest_speed_rpm=low / 50, highest_speed_rpm=low)
    file = parse_drive(yaml.safe_dump(content))
    duty, model = file.requirements, file.transverse
    driven = replace(model, force=DrivingForce(duty.power, duty.pinion_speed))
    assert np.isfinite(driven.system(duty.speeds[1]).stiffness).all()
    with pytest.raises(ValueError, match="speed must lie in"):
        driven.system(1.001 * duty.speeds[1])


# --- what does not go together ----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "bore_radius_mm: 50",
            "bore_radius_mm: 190",
            r"body.bore_radius_mm .* 11.5969 and 188.433 mm .*got 190 mm$",
        ),
        (
            "module_mm: 3.175 # diametral pitch 8 per inch\n\nbody:\n  thickness_ratio: 0.03\n  bore_radius_mm: 50",
            "module_mm: 4\n\nbody:\n  thickness_ratio: 0.03\n  bore_radius_mm: 240",
            r"body.bore_radius_mm .* whose teeth reach from 237.396 .* got 240 mm$",
        ),
        (
            "gear_teeth: 130",
            "gear_teeth: 27",
            r"body.bore_radius_mm must lie between 2.4086 and .* got 50 mm$",
        ),
        (
            "mass: 1.0",
            "mass: 1.0\n  angles_deg: [5, -355]",
            r"pinions.angles_deg\[1\] must differ .*at least 26\.\d+°.*-355° beside 5°",
        ),
        (
            "mass: 1.0",
            "mass: 1.0\n  contact_ratio: loaded",
            r"^pinions.contact_ratio must be usual, tregold, geometric for a shaper of 26 teeth .* 26, got 'loaded'",
        ),
        (
            "gear_teeth: 130",
            "gear_teeth: 130\n  shaper_teeth: 25",
            r"gears.shaper_teeth must be 0, or an integer from 26 to 129, got 25$",
        ),
        ("pinion_teeth: 26", "pinion_teeth: 11", r"gears.pinion_teeth=11 is too few.*take at least 12 teeth"),
        (
            "pinion_teeth: 26",
            "pinion_teeth: 140",
            r"gears.gear_teeth must exceed gears.pinion_teeth=140, got 130",
        ),
        (
            "lowest_speed_rpm: 100",
            "lowest_speed_rpm: 10",
            r"operation.lowest_speed_rpm .*1/50 of it, got 10 rpm",
        ),
        ("lowest_speed_rpm: 100", "lowest_speed_rpm: 1000", r"operation.lowest_speed_rpm .*got 1000 rpm"),
        (
            "lowest_speed_rpm: 100\n  highest_speed_rpm: 1000",
            "lowest_speed_rpm: 300\n  highest_speed_rpm: 300.001",
            r"operation.highest_speed_rpm must be at least 1.001 times operation.lowest_speed_rpm = 300 rpm, that is "
            r"300.3 rpm, got 300.001 rpm$",
        ),
        (
            "lowest_speed_rpm: 100\n  highest_speed_rpm: 1000",
            "lowest_speed_rpm: 300\n  highest_speed_rpm: 300.0000000000001",
            r"operation.highest_speed_rpm must be at least 1.001 times .*, got 300 rpm$",
        ),
        (
            "pinion_teeth: 26\n  gear_teeth: 130",
            "pinion_teeth: 130\n  gear_teeth: 26",
            r"must exceed gears.pinion_teeth=130, got 26 \(gears.pinion_teeth and gears.gear_teeth swapped\?\)",
        ),
        (
            "lowest_speed_rpm: 100\n  highest_speed_rpm: 1000",
            "lowest_speed_rpm: 1000\n  highest_speed_rpm: 100",
            r"got 1000 rpm \(operation.lowest_speed_rpm and operation.highest_speed_rpm swapped\?\)",
        ),
        (
            "module_mm: 3.175 # diametral pitch 8 per inch\n\nbody:\n  thickness_ratio: 0.03\n  bore_radius_mm: 50",
            "module_mm: 8\n\nbody:\n  thickness_ratio: 0.03\n  bore_radius_mm: 20",
            r"body.bore_radius_mm must lie between 29.* \(is 8 mm a diametral pitch per inch\?\)",
        ),
        (
            "module_mm: 3.175 # diametral pitch 8 per inch\n\nbody:\n  thickness_ratio: 0.03\n  bore_radius_mm: 50",
            "diametral_pitch_per_inch: 3.175\n\nbody:\n  thickness_ratio: 0.03\n  bore_radius_mm: 20",
            r"body.bore_radius_mm must lie .* \(is 3.175 1/in a module in mm\?\)",
        ),
        (
            "highest_speed_rpm: 1000",
            "highest_speed_rpm: 41650",
            r"operation.lowest_speed_rpm must be lower",
        ),
        (
            "lowest_speed_rpm: 100\n  highest_speed_rpm: 1000",
            "lowest_speed_rpm: 1000\n  highest_speed_rpm: 41650",
            r"operation.highest_speed_rpm must be at most 41589.6 rpm for this body.*got 41650 rpm",
        ),
    ],
)
def test_values_that_do_not_go_together_end_in_one_sentence_that_names_what_would(old, new, message):
    assert CASE_1.count(old) == 1
    assert re.search(message, refusal(CASE_1.replace(old, new)))


def test_a_file_that_is_not_there(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(
        DriveFileError, match=r"drive_file 'a\.yaml' cannot be read: No such file .*current folder is"
    ):
        read_drive_file("a.yaml")
    with pytest.raises(DriveFileError, match="cannot be read: Is a directory"):
        read_drive_file(tmp_path)
    for wrong in ("", None, 3):
        with pytest.raises(DriveFileError, match="drive_file must be the path of a YAML file"):
            read_drive_file(wrong)
    with pytest.raises(DriveFileError, match="cannot be read"):
        read_drive_file("a\0b")


# --- files that nobody would write ------------------------------------------------------------------------------


def checked(content):
    """Read a file; a refusal must be the project's own, on one line."""
    try:
        return parse_drive(content, "my.yaml")
    except DriveFileError as error:
        message = str(error)
    assert message.startswith("my.yaml: ")
    assert len(message.splitlines()) == 1
    return message


numbers = st.one_of(
    st.integers(-(10**20), 10**20),
    st.floats(),
    st.sampled_from([0, 0.0, -0.0, 1, 1e-300, 1e300, 5e-324, 2**63]),
)
values = st.one_of(
    numbers,
    st.none(),
    st.booleans(),
    st.text(max_size=10),
    st.lists(numbers, max_size=4),
    st.dictionaries(st.text(max_size=3), numbers, max_size=2),
)


@st.composite
def near_valid(draw, key):
    """Value of a key that is valid or nearly so, on the scale of its range."""
    if key.kind in ("text", "choice"):
        return draw(values)
    low = math.log10(max(key.lowest, 1e-4)) if key.lowest > 0 else -3.0
    exponent = draw(st.floats(low - 1.0, math.log10(key.highest) + 1.0))
    value = 10.0**exponent * draw(st.sampled_from([1, 1, 1, -1]))
    if key.kind == "integer":
        return round(value)
    return [value, 0.0] if key.kind == "numbers" else value


@st.composite
def mutated(draw, base, valid=False):
    """Drive file with some values replaced, and the paths of those; `valid` draws on the scale of each key."""
    content = yaml.safe_load(base)
    changed = []
    for _ in range(draw(st.integers(1, 3))):
        section = draw(st.sampled_from([name for name in SECTIONS if name in content] + ["material"]))
        key = draw(st.sampled_from(SECTIONS[section].keys))
        content.setdefault(section, {})[key.name] = draw(near_valid(key) if valid else values)
        changed.append(f"{section}.{key.name}")
    return content, changed


def any_value_of_any_key_is_valid_or_named(case):
    content, changed = case
    found = checked(yaml.safe_dump(content, allow_unicode=True))
    if isinstance(found, str):
        assert any(path in found for path in changed) or "bore_radius" in found, found


@settings(max_examples=60)
@given(mutated(GEARBOX) | mutated(BOTH_FACES))
def test_any_value_of_any_key_is_valid_or_named(case):
    any_value_of_any_key_is_valid_or_named(case)


@pytest.mark.slow
@settings(max_examples=500)
@given(mutated(GEARBOX) | mutated(BOTH_FACES))
def test_any_value_of_any_key_is_valid_or_named_in_very_many_files(case):
    any_value_of_any_key_is_valid_or_named(case)


def any_number_of_the_right_size_is_valid_or_named(case):
    content, changed = case
    found = checked(yaml.safe_dump(content, allow_unicode=True))
    sections = {path.split(".")[0] for path in changed}
    if isinstance(found, str):
        named = {path for path in PATHS if path in found}
        # What a change makes impossible may be told of another key: other teeth, and the bore does not fit.
        assert named, found
        assert any(path in found for path in changed) or "gears" in sections, found


@settings(max_examples=60)
@given(mutated(GEARBOX, valid=True))
def test_any_number_of_the_right_size_is_valid_or_named(case):
    any_number_of_the_right_size_is_valid_or_named(case)


@pytest.mark.slow
@settings(max_examples=400)
@given(mutated(GEARBOX, valid=True))
def test_any_number_of_the_right_size_is_valid_or_named_in_very_many_files(case):
    any_number_of_the_right_size_is_valid_or_named(case)


def keys_left_out_or_misspelt_are_named(data):
    content = yaml.safe_load(GEARBOX)
    section = data.draw(st.sampled_from([name for name in SECTIONS if name in content]))
    key = data.draw(st.sampled_from(sorted(content[section])))
    value = content[section].pop(key)
    other = data.draw(st.none() | st.text(min_size=1, max_size=12))
    if other is not None:
        content[section].setdefault(other, value)
    found = checked(yaml.safe_dump(content, allow_unicode=True))
    required = {k.name for k in SECTIONS[section].keys if k.default is None}
    assert isinstance(found, DriveFile) == (key not in required and (other is None or other == key))
    if isinstance(found, str):
        assert f"{section}." in found or "not YAML" in found, found


@settings(max_examples=40)
@given(st.data())
def test_keys_left_out_or_misspelt_are_named(data):
    keys_left_out_or_misspelt_are_named(data)


@pytest.mark.slow
@settings(max_examples=200)
@given(st.data())
def test_keys_left_out_or_misspelt_are_named_in_very_many_files(data):
    keys_left_out_or_misspelt_are_named(data)


@settings(max_examples=200)
@given(st.data())
def test_damaged_text_is_refused_or_read(data):
    start = data.draw(st.integers(0, len(GEARBOX)))
    length = data.draw(st.integers(0, 40))
    text = GEARBOX[:start] + data.draw(st.text(max_size=6)) + GEARBOX[start + length :]
    checked(text)


@settings(max_examples=200)
@given(st.binary(max_size=200))
def test_any_bytes_are_refused(content):
    assert isinstance(checked(content), str)


@pytest.mark.slow
@settings(max_examples=300)
@given(mutated(GEARBOX, valid=True))
def test_what_is_valid_gives_systems(case):
    found = checked(yaml.safe_dump(case[0], allow_unicode=True))
    if isinstance(found, DriveFile):
        for speed in found.requirements.speeds:
            for model in (found.transverse, found.torsional):
                system = model.system(speed)
                for load in system.loads:
                    assert np.isfinite(load.shape(np.array([0.0, 0.3, 0.9]))).all()
                assert np.isfinite(system.stiffness).all()


def test_a_body_too_soft_to_measure_bearings_by_is_refused():
    """Beyond its critical speed the disk's stiffness against a force at rest is negative."""
    soft = yaml.safe_load(GEARBOX) | {"material": {"youngs_modulus_GPa": 0.11547819846894582}}
    with pytest.raises(DriveFileError, match="thickness_ratio must be larger, or the material stiffer"):
        parse_drive(yaml.safe_dump(soft))
