"""Every key of a drive file by itself: mistakes that people make."""

import re

import pytest

from tests.drives.drive_files import CASE_1, refusal


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "module_mm: 3.175",
            "module_mm: 0.003175",
            r"gears.module_mm .*got 0.003175 mm .*3.175 would be valid",
        ),
        ("module_mm: 3.175", "module_mm: 3175", r"gears.module_mm .*got 3175 mm .*3.175 would be valid"),
        (
            "module_mm: 3.175",
            "modul_mm: 3.175",
            r"gears.modul_mm = 3.175 is no key .*did you mean gears.module_mm",
        ),
        (
            "  module_mm: 3.175",
            "  # module_mm: 3.175",
            r"gears.module_mm or gears.diametral_pitch_per_inch is missing: m_d, module.* valid is a number",
        ),
        ("bore_radius_mm: 50", "bore_radius_mm:", r"body.bore_radius_mm is missing"),
        ("bore_radius_mm: 50", "bore_radius_mm: 0.05", r"body.bore_radius_mm .*50 would be valid, in mm"),
        ("thickness_ratio: 0.03", "thickness_ratio: 30", r"body.thickness_ratio .*0.2.* got 30 .*0.03 would"),
        (
            "damping_us: 3",
            "damping_us: 3e-6",
            r"pinions.damping_us .*got 3e-06 µs .*: 3 would be valid, in µs",
        ),
        ("damping_us: 3", "damping_us: -3", r"pinions.damping_us .*got -3"),
        ("damping_us: 3", "damping_us: '3'", r"pinions.damping_us must be 0, or a number from .*got '3'"),
        ("mass: 1.0", "mass: .nan", r"pinions.mass must lie in \[1e-06, 1000\], got nan \(0 is valid, too\)"),
        ("mass: 1.0", "mass: 1.0\n  mass: 2", r"line \d+: pinions.mass is given twice"),
        ("mass: 1.0", "mass: [1.0]", r"pinions.mass must be 0, or a number .*got \[1.0\]"),
        ("mass: 1.0", "mass: 1.0\n  angles_deg: 0", r"pinions.angles_deg must be a list .*got 0"),
        (
            "mass: 1.0",
            "mass: 1.0\n  angles_deg: ['0', '90']",
            r"^pinions.angles_deg\[0\] must be a number from -360 to 360 °, got '0'$",
        ),
        ("mass: 1.0", "mass: 1.0\n  angles_deg: [0, 400]", r"pinions.angles_deg\[1\] .*got 400 °"),
        (
            "mass: 1.0",
            "mass: 1.0\n  contact_ratio: 1.5",
            r"pinions.contact_ratio must be usual or tregold or geometric or loaded or unloaded, got 1.5",
        ),
        ("gear_teeth: 130", "gear_teeth: 130\n  shaper_teeth: false", r"gears.shaper_teeth must .*got False"),
        (
            "gear_teeth: 130",
            "gear_teeth: 130\n  shaper_teeth: 1",
            r"gears.shaper_teeth must be 0, or a whole number from 10 to 2999, got 1$",
        ),
        (
            "pinion_teeth: 26",
            "pinion_teeth: 26.0",
            r"gears.pinion_teeth must be a whole number from 10 to 300, got 26.0",
        ),
        ("pinion_teeth: 26", "pinion_teeth: true", r"gears.pinion_teeth must be a whole number .*got True"),
        (
            "pinion_teeth: 26",
            "pinion_teeth: 5",
            r"gears.pinion_teeth must be a whole number from 10 to 300, got 5$",
        ),
        (
            "module_mm: 3.175",
            "module_mm: 3.175\n  pressure_angle_deg: 0.436",
            r"gears.pressure_angle_deg .*14.5, 30.*got 0.436 ° .*24.98\d* would be valid",
        ),
        ("gears:", "gear:", r"gear = .* is no key of a drive file: did you mean gears\?"),
        (
            "name: Case I",
            "name: Case I\nthickness_ratio: 3",
            r"thickness_ratio = 3 is no key .*belongs to body",
        ),
        ("name: Case I", "name: 3", r"name must be text of 1 to 80 characters, got 3"),
        ("name: Case I", "name: '  '", r"name must be text of 1 to 80 characters, got '  '"),
        (
            "name: Case I",
            'name: "a\\0b"',
            r"name must be text .*, none of them NUL, got 'a\\x00b'",
        ),
        ("name: Case I", f"name: {'x' * 81}", r"name must be text of 1 to 80 characters, got 'xxx"),
        ("name: Case I", 'name: "\\ud800"', r"line 2: '\\ud800' holds half a character"),
        (
            "module_mm: 3.175",
            "module_mm: 3.175\n  diametral_pitch_per_inch: 8",
            r"gears.module_mm = 3.175 and gears.diametral_pitch_per_inch = 8 say the same: give one of them",
        ),
        (
            "power_kW: 447.42",
            "power_kW: 447.42\n  power_hp: 600",
            r"operation.power_kW = 447.42 and operation.power_hp = 600 say the same",
        ),
        ("pinion_teeth: 26", "pinion_teeth: 26 teeth", r"300, got '26 teeth' \(the number alone, .*: 26\)$"),
        ("damping_us: 3", "damping_us: 1.2.3 µs", r"pinions.damping_us must be 0, or .*, got '1.2.3 µs'$"),
        ("damping_us: 3", "damping_us: .5 µs", r"got '.5 µs' \(the number alone, .*: .5\)$"),
        ("name: Case I", "name: Case I\nmaterial: {poissons_ratio: 0.6}", r"poissons_ratio .*, got 0.6$"),
        ("name: Case I", "name: Case I\ntolerances: {speed_percent: 300}", r"got 300 % \(0 is valid, too\)$"),
        (
            "name: Case I",
            "name: Case I\ntolerances: {speed_percent: 0.05}",
            r"got 0.05 % \(wrong unit\? tolerances.speed_percent: 5 would be valid, in %\)$",
        ),
        ("highest_speed_rpm: 1000", "highest_speed_rpm: 2e5", r"got 200000.0 rpm$"),
        # A guess is one that would be valid.
        ("pinion_teeth: 26", "pinion_teeth: 0x1A", r"from 10 to 300, got '0x1A'$"),
        ("pinion_teeth: 26", "pinion_teeth: 26,5", r"from 10 to 300, got '26,5'$"),
        (
            "bore_radius_mm: 50",
            "bore_radius_mm: 50\n  nodal_circles: 7",
            r"body.nodal_circles must be a whole number from 0 to 4, got 7$",
        ),
        ("power_kW: 447.42", "power_kW: .inf", r"power_kW must lie in \[0.01, 100000\] in kW, got inf kW$"),
        (
            "power_kW: 447.42",
            "power: 447.42",
            r"operation.power = 447.42 is no key .*did you mean operation.power_",
        ),
        (
            "  power_kW: 447.42 # 600 hp\n",
            "",
            r"operation.power_kW or operation.power_hp is missing: power of one",
        ),
        (
            "module_mm: 3.175",
            "diametral_pitch_per_inch: 800",
            r"gears.diametral_pitch_per_inch must lie in \[0.3, 200\] in 1/in, got 800",
        ),
        ("thickness_ratio: 0.03", "thickness_ratio: 0,03", r"got '0,03' \(a point, not a comma: 0.03\)"),
        (
            "damping_us: 3",
            "damping_us: 3 µs",
            r"got '3 µs' \(the number alone, its unit is that of the key: 3\)",
        ),
        ("thickness_ratio: 0.03", "thickness_ratio: 6.9", r"thickness_ratio .*\(a ratio, not mm\?"),
        ("stiffness: 1.0", "stiffness: 1e6", r"pinions.stiffness .*got 1000000.0 \(a ratio, not N/m\?"),
        ("mass: 1.0", "mass: 3400", r"pinions.mass .*got 3400 \(a ratio, not kg\?"),
        (
            "name: Case I",
            "name: Case I\nmaterial: steel",
            r"material must be a section with the keys density.*'steel'",
        ),
        ("name: Case I", "name: Case I\nmaterial:", r"material must be a section .*None"),
        (
            "name: Case I",
            "name: Case I\nmaterial: {youngs_modulus_GPa: 2e11}",
            r"material.youngs_modulus_GPa .*: 200 wo",
        ),
        ("name: Case I", "name: Case I\ngearbox: {}", r"gearbox.pinion_inertia_kg_m2 is missing"),
    ],
)
def test_a_mistake_ends_in_one_sentence_that_names_key_value_and_what_is_valid(old, new, message):
    assert CASE_1.count(old) == 1
    assert re.search(message, refusal(CASE_1.replace(old, new)))


@pytest.mark.parametrize("content", ["", "3", "- a\n- b", "name", b"\xff"])
def test_what_is_no_mapping_is_refused(content):
    assert re.search("must be a section|not text in UTF-8", refusal(content))


def test_long_values_are_cut_in_messages():
    assert len(refusal(CASE_1.replace("mass: 1.0", f"mass: {'x' * 5000}"))) < 250
    assert len(refusal(CASE_1.replace("mass: 1.0", f"{'x' * 500}: 1.0"))) < 400
