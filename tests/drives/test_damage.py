"""What a damaged tooth would show: against the anchored lines of the chapter on damage, and limits."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import facegear as fg
from facegear.drives.damage import signs_of_damage
from facegear.drives.drive_file import DriveFileError, parse_drive
from facegear.drives.findings import Findings
from facegear.drives.sections import torsion
from facegear.mechanics.gearboxes import FIGURES
from facegear.mechanics.tooth_damage import DamagedTooth
from facegear.support.labelled import load

ROOT = Path(__file__).resolve().parents[2]
GEARBOX = (ROOT / "data" / "drives" / "gearbox_table_7_1.yaml").read_text(encoding="utf-8")
CRACKED = DamagedTooth(fg.Torsional(FIGURES["7.12b"].gearbox.in_si), loss=0.1, tooth=33, torque=800.0)


def test_sidebands_are_those_that_the_chapter_anchors():
    """Lines of 0.1 of the stiffness at 500 rpm, held against DOP853 there."""
    stored = load(ROOT / "data" / "reference" / "ch08_damage_sidebands.nc").sel(tooth=33)
    lines = np.hypot(stored.amplitude_real, stored.amplitude_imaginary).sel(harmonic=slice(1, 321))
    mesh = lines.harmonic % 107 == 0
    found = signs_of_damage(CRACKED, [500.0], "")
    assert float(found.sideband[0]) == pytest.approx(float(lines[~mesh].max() / lines[mesh].max()), rel=1e-5)


def test_small_losses_show_in_proportion_and_none_at_all_does_not():
    some = [float(signs_of_damage(replace(CRACKED, loss=x), [500.0], "").sideband[0]) for x in (1e-3, 2e-3)]
    assert some[1] == pytest.approx(2.0 * some[0], rel=0.01)
    least = signs_of_damage(replace(CRACKED, loss=1e-9), [500.0], "")
    assert float(least.sideband[0]) < 1e-7
    assert float(least.growth_damaged[0]) == pytest.approx(float(least.growth_intact[0]), abs=1e-6)


def test_where_it_is_unstable_there_is_no_sideband():
    found = signs_of_damage(CRACKED, [400.0, 500.0], "")
    assert np.isnan(found.sideband.values).tolist() == [True, False]
    assert float(found.growth_intact[0]) > 0.0


def test_without_a_torque_nothing_vibrates():
    with pytest.raises(ValueError, match="torque of the damaged gearbox must be greater than 0"):
        signs_of_damage(replace(CRACKED, torque=0.0), [500.0], "")


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (
            lambda: signs_of_damage(CRACKED.torsional, [500.0], ""),
            TypeError,
            "cracked must be a DamagedTooth",
        ),
        (lambda: signs_of_damage(CRACKED, 500.0, ""), ValueError, "speeds_rpm must be a list of speeds"),
        (
            lambda: signs_of_damage(CRACKED, [-100.0], ""),
            ValueError,
            "speeds_rpm must be a list .* greater than 0",
        ),
    ],
)
def test_bad_input_names_the_parameter(call, error, message):
    with pytest.raises(error, match=message):
        call()


def test_the_key_of_a_file_and_its_place_in_the_report():
    text = GEARBOX.replace("gearbox:\n", "gearbox:\n  damaged_tooth_percent: 20\n")
    file = parse_drive(text)
    assert parse_drive(GEARBOX).cracked is None
    duty = file.requirements
    assert file.cracked.loss == pytest.approx(0.2, rel=1e-15)
    assert file.cracked.torque == pytest.approx(duty.power / duty.pinion_speed * 107 / 31, rel=1e-12)
    narrow = replace(file, requirements=replace(duty, speeds=(fg.rad_per_s(750.0), fg.rad_per_s(760.0))))
    page = torsion(Findings(narrow, cells=2, jobs=1)).as_html()
    assert "What a damaged tooth would show" in page
    with pytest.raises(
        DriveFileError,
        match=r"gearbox.damaged_tooth_percent must be 0 beside gearbox.input_length_mm = 100 mm.*got 20",
    ):
        parse_drive(text.replace("gearbox:\n", "gearbox:\n  input_length_mm: 100\n"))
    with pytest.raises(DriveFileError, match=r"gearbox.damaged_tooth_percent must .*got 100"):
        parse_drive(text.replace("percent: 20", "percent: 100"))
