"""What models refuse, told in the words of the file."""

import re

import yaml

from facegear.drives.drive_file import parse_drive
from tests.drives.drive_files import BOTH_FACES, CASE_1, refusal

TEETH = CASE_1 + "\nteeth:\n  tooth_damping_us: 10\n"


def test_of_a_body_too_soft_each_key_that_could_help_is_named():
    told = refusal(yaml.safe_dump(yaml.safe_load(BOTH_FACES) | {"material": {"youngs_modulus_GPa": 1}}))
    keys = ("body.thickness_ratio", "material.youngs_modulus_GPa", "material.density_kg_per_m3")
    assert all(key in told for key in keys)


def test_too_few_teeth_are_told_in_the_words_of_the_file():
    few = TEETH.replace("pinion_teeth: 26", "pinion_teeth: 18").replace("gear_teeth: 130", "gear_teeth: 90")
    few = few.replace("bore_radius_mm: 50", "bore_radius_mm: 30")
    told = refusal(few)
    assert re.match(
        r"teeth: gears.pinion_teeth = 18 is too few for a section teeth, whose model follows the moving contact "
        r"\(gears.gear_teeth = 90, .* 22 pinion teeth are enough",
        told,
    )
    assert "rate" not in told.replace("ratio", "")
    assert parse_drive(few.split("\nteeth:")[0]).teeth is None
