"""What a drive file says of a gearbox: play of the teeth, shafts with mass, mistakes."""

import re

import pytest

from facegear.drives.drive_file import DriveFileError, parse_drive
from tests.drives.drive_files import GEARBOX, refusal


class TestPlay:
    def test_teeth_have_play_under_the_torque_of_a_pinion(self):
        found = parse_drive(GEARBOX.replace("gearbox:\n", "gearbox:\n  backlash_um: 80\n"))
        duty = found.requirements
        assert parse_drive(GEARBOX).play is None
        assert found.play.torsional == found.torsional == parse_drive(GEARBOX).torsional
        assert found.play.gap == pytest.approx(8e-5, rel=1e-15)
        assert found.play.torque == pytest.approx(duty.power / duty.pinion_speed * 107 / 31, rel=1e-12)

    @pytest.mark.parametrize(
        ("keys", "told"),
        [
            ("backlash_um: -3", "gearbox.backlash_um must lie in .*got -3"),
            ("backlash_um: 1e5", "gearbox.backlash_um must be at most the module, 3175 µm, got 100000 µm"),
            (
                "backlash_um: 80\n  input_length_mm: 200",
                "gearbox.backlash_um must be 0 beside gearbox.input_length_mm = 200 mm: .*, got 80 µm",
            ),
            (
                "damaged_tooth_percent: 20\n  input_length_mm: 200\n  output_length_mm: 300",
                "damaged_tooth_percent must be 0 beside .*input_length_mm = 200 mm and .*output_length_mm = 300 mm: "
                ".*, got 20 %",
            ),
        ],
    )
    def test_what_does_not_go_together_is_refused(self, keys, told):
        with pytest.raises(DriveFileError, match=told):
            parse_drive(GEARBOX.replace("gearbox:\n", f"gearbox:\n  {keys}\n"))


class TestShaftsWithMass:
    LENGTHS = "  input_length_mm: 300\n  output_length_mm: 250\n"

    def test_lengths_give_shafts_their_mass(self):
        found, massless = parse_drive(GEARBOX + self.LENGTHS), parse_drive(GEARBOX)
        assert (found.torsional.input_length, found.torsional.output_length) == pytest.approx((0.3, 0.25))
        assert found.torsional.torsional == massless.torsional
        assert found.torsional.material == found.transverse.body.material
        # The report reads stiffnesses off either.
        assert found.torsional.gearbox == massless.torsional.gearbox
        assert found.not_buildable == massless.not_buildable == ()

    def test_one_shaft_may_be_massless(self):
        found = parse_drive(GEARBOX + "  output_length_mm: 250\n").torsional
        assert found.system(60.0).size == 5

    def test_what_cannot_be_built_is_said(self):
        (sentence,) = parse_drive(GEARBOX + self.LENGTHS.replace("300", "500")).not_buildable
        assert sentence.startswith("input shaft of 98.4 mm diameter is thicker than the root circle")

    def test_lengths_out_of_range_are_refused(self):
        # 0.3 is a length in metres.
        told = refusal(GEARBOX + self.LENGTHS.replace("300", "0.3"))
        assert "gearbox.input_length_mm must lie in [1, 20000] in mm, got 0.3 mm" in told


def test_mistakes_in_the_gearbox():
    told = refusal(
        GEARBOX.replace("mesh_stiffness_N_per_m: 157629095.3", "mesh_stiffness_N_per_m: 157629.0953")
    )
    assert re.search(r"gearbox.mesh_stiffness_N_per_m must lie in .*wrong by a factor of 1000", told)
    assert "gearbox.arm must be printed or conjugate" in refusal(GEARBOX + "  arm: bent\n")
