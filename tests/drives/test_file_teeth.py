"""What a drive file says of teeth: contacts, springs, pinions on two faces and between two gears."""

import re
from dataclasses import replace

import pytest

from facegear.drives.drive_file import DriveFileError, parse_drive, read_drive_file
from facegear.floquet.multipliers import growth_rate
from facegear.geometry.drive import Drive
from facegear.mechanics.loaded_contact import LoadedContact
from facegear.mechanics.sharing import shared_load
from facegear.mechanics.tooth_stiffness import mesh_stiffness
from facegear.mechanics.two_gears import TwoGears
from facegear.support.parameters import rad_per_s
from tests.drives.drive_files import CASE_1, DRIVES, GEARBOX, refusal


class TestShaperWithMoreTeeth:
    LOCALIZED = (DRIVES / "localized.yaml").read_text(encoding="utf-8")

    def test_contact_under_the_torque_of_the_file(self):
        found = parse_drive(self.LOCALIZED)
        assert found.drive == Drive(26, 130, 3.175e-3, shaper_teeth=27)
        torque = 447.42e3 / rad_per_s(5000.0)
        assert found.transverse.contact_ratio == LoadedContact(found.drive, torque).contact_ratio
        assert list(found.contacts) == ["contact under load", "point contact"]
        assert found.contacts["contact under load"] == found.transverse.contact

    def test_contact_without_load(self):
        found = parse_drive(self.LOCALIZED.replace("mass: 1.0", "mass: 1.0\n  contact_ratio: unloaded"))
        assert found.transverse.contact_ratio == pytest.approx(1.557363852, abs=1e-9)
        assert list(found.contacts) == ["point contact", "contact under load"]

    def test_a_gearbox_has_the_contact_and_the_stiffness_of_its_teeth(self):
        text = GEARBOX.replace("pinion_teeth: 31", "pinion_teeth: 31\n  shaper_teeth: 33")
        found = parse_drive(text)
        path = found.torsional.contact.path
        assert path == found.transverse.contact.path
        assert path.of(found.drive).pair_stiffness == pytest.approx(found.torsional.gearbox.mesh_stiffness)
        assert (found.torsional.contact.sharing, found.torsional.contact.rate) == ("each", "total")

    def test_teeth_that_are_stiffer_than_teeth_are_refused(self):
        text = GEARBOX.replace("pinion_teeth: 31", "pinion_teeth: 31\n  shaper_teeth: 33")
        stiff = re.sub(r"mesh_stiffness_N_per_m: \S+", "mesh_stiffness_N_per_m: 1e10", text)
        with pytest.raises(
            DriveFileError, match=r"gearbox.mesh_stiffness_N_per_m must be at most .*got 1e\+10"
        ):
            parse_drive(stiff)


class TestFlexibleTeeth:
    TEETH = CASE_1 + "\nteeth:\n  tooth_damping_us: 10\n"

    def test_pinions_on_the_springs_of_their_teeth(self):
        found, rigid = parse_drive(self.TEETH), parse_drive(CASE_1)
        assert rigid.teeth is None
        model = found.transverse
        assert model.mesh_stiffness == mesh_stiffness(found.drive, 0.5, model.body.material)
        assert model.mesh_damping == pytest.approx(1e-5, rel=1e-15)
        assert (model.body, model.load, model.pinion_angles) == (
            rigid.transverse.body,
            rigid.transverse.load,
            rigid.transverse.pinion_angles,
        )
        assert list(found.contacts) == list(rigid.contacts)
        assert {contact.rate for contact in found.contacts.values()} == {"total"}
        softer = parse_drive(self.TEETH + "  correction_factor: 0.25\n").transverse
        assert softer.mesh_stiffness == pytest.approx(model.mesh_stiffness / 2.0, rel=1e-12)

    def test_stiff_teeth_are_nearly_rigid_ones_with_total_rate(self):
        found, speed = parse_drive(self.TEETH + "  correction_factor: 1\n"), float(rad_per_s(400.0))
        rigid = found.transverse.rigid
        stiff = replace(
            found.transverse, mesh_stiffness=1e4 * found.transverse.mesh_stiffness, mesh_damping=1e-8
        )
        assert growth_rate(stiff.system(speed)) == pytest.approx(growth_rate(rigid.system(speed)), rel=1e-3)

    @pytest.mark.parametrize("rule", ["length_share", "length", "equal"])
    def test_pairs_share_the_load_by_a_rule(self, rule):
        found = parse_drive(self.TEETH + f"  sharing: {rule}\n")
        for contact in found.contacts.values():
            assert (contact.sharing, contact.path) == ("each", shared_load(rule))

    def test_pairs_share_the_load_as_it_presses_them(self):
        text = (DRIVES / "localized.yaml").read_text(encoding="utf-8")
        found = parse_drive(
            text + "\nteeth:\n  tooth_damping_us: 10\n  sharing: compliance\n  correction_factor: 0.3\n"
        )
        contact = found.contacts["contact under load"]
        assert (contact.sharing, contact.rate) == ("each", "total")
        assert contact.path.correction_factor == pytest.approx(0.3, rel=1e-12)

    def test_pinions_on_both_faces(self):
        found = read_drive_file(DRIVES / "both_faces.yaml").transverse
        assert (found.faces, found.mesh_phases, found.pinion_angles) == ((1, -1), (0.0, 0.5), (0.0, 0.0))

    def test_stiffness_of_a_gearbox_is_that_of_its_teeth(self):
        found = parse_drive(self.with_gearbox("50"))
        assert found.transverse.mesh_stiffness == found.torsional.gearbox.mesh_stiffness
        assert found.transverse.mesh_damping == pytest.approx(
            found.torsional.gearbox.mesh_damping / found.torsional.gearbox.mesh_stiffness, rel=1e-12
        )

    def test_damping_that_is_left_out_is_that_of_the_gearbox(self):
        given = parse_drive(self.with_gearbox("50")).transverse
        for teeth in ("teeth:\n  sharing: centroid\n", "teeth: {}\n", "teeth:\n  tooth_damping_us: 0\n"):
            text = re.sub(r"teeth:\n  tooth_damping_us: 50\n", teeth, self.with_gearbox("50"))
            assert parse_drive(text).transverse == given

    def test_a_gearbox_without_mesh_damping_has_none_for_flexible_teeth(self):
        for own in ("0", "10"):
            text = self.with_gearbox(own).replace("mesh_damping_us: 50", "mesh_damping_us: 0")
            told = refusal(text)
            assert told.startswith("gearbox.mesh_damping_us must be greater than 0 beside a section teeth")

    @staticmethod
    def with_gearbox(damping, more=""):
        text = re.sub(r"mesh_damping_us: \S+", "mesh_damping_us: 50", GEARBOX)
        return f"{text}\nteeth:\n  tooth_damping_us: {damping}\n{more}"

    @pytest.mark.parametrize(
        ("text", "told"),
        [
            (
                TEETH + "  sharing: compliance\n",
                "teeth.sharing must be .* for contact along lines, got 'compliance'",
            ),
            (
                TEETH + "  sides: [1, 1]\n",
                r"teeth.sides must list 1 or -1 for each pinion of pinions.angles_deg, 1 in all, got \[1, 1\]",
            ),
            (TEETH + "  sides: [0.5]\n", r"teeth.sides\[0\] must be 1 or -1, got 0.5"),
            (TEETH + "  sides: [true]\n", r"teeth.sides\[0\] must be 1 or -1, got True"),
            (TEETH + "  sides: [front]\n", r"teeth.sides\[0\] must be 1 or -1, got 'front'"),
            (TEETH + "  sides: 1\n", "teeth.sides must be a list of 0 to 12 numbers, each 1 or -1, got 1"),
            (
                TEETH + "  clocking: 180\n",
                r"clocking must lie in \[-1, 1\], got 180 \(in mesh periods, not in degrees\?\)$",
            ),
            (
                TEETH + "  clocking: 0.5\n",
                "teeth.clocking must be 0 or left out where teeth.sides has no pinion on the back .*got 0.5",
            ),
            (
                TEETH + "  sides: [1]\n  clocking: 0.5\n",
                "teeth.clocking must be 0 or left out where teeth.sides has no pinion on the back .*got 0.5",
            ),
            (TEETH + "  clocking: 3\n", r"teeth.clocking must lie in \[-1, 1\], got 3"),
            (
                TEETH.replace("mass: 1.0", "mass: 0"),
                "pinions.mass must be greater than 0 for a pinion on flexible",
            ),
            (
                CASE_1 + "\nteeth:\n  sharing: equal\n",
                "teeth.tooth_damping_us is missing, or 0: without a section gearbox, .* from 0.001 to 10000 µs",
            ),
            (CASE_1 + "\nteeth:\n  tooth_damping_us: 0\n", "teeth.tooth_damping_us is missing, or 0"),
            (
                TEETH.replace("mass: 1.0", "mass: 1.0\n  angles_deg: [0, 0]"),
                r"pinions.angles_deg\[1\] must differ from the other angles",
            ),
        ],
    )
    def test_what_does_not_go_together_is_refused(self, text, told):
        with pytest.raises(DriveFileError, match=told):
            parse_drive(text)

    def test_a_gearbox_says_how_stiff_its_teeth_are(self):
        with pytest.raises(
            DriveFileError, match=r"teeth.correction_factor must be 0 or left out beside gearbox"
        ):
            parse_drive(self.with_gearbox("50", "  correction_factor: 0.4\n"))
        with pytest.raises(
            DriveFileError,
            match=r"teeth.tooth_damping_us must be left out, or be that of gearbox.mesh.*, 50 µs, got 40 µs",
        ):
            parse_drive(self.with_gearbox("40"))


class TestTwoGears:
    TEXT = (DRIVES / "two_gears.yaml").read_text(encoding="utf-8")

    def test_pinions_between_two_gears(self):
        found = parse_drive(self.TEXT)
        one = parse_drive(
            self.TEXT.split("second_gear:")[0] + "operation:" + self.TEXT.split("operation:")[1]
        )
        assert one.roles is None
        assert found.roles == ("input", "idler")
        assert found.transverse == TwoGears(one.transverse, ("input", "idler"))
        assert found.contacts == one.contacts
        assert found.drive == one.drive

    @pytest.mark.parametrize(
        ("old", "new", "told"),
        [
            (
                "teeth:\n  tooth_damping_us: 10\n",
                "",
                "second_gear must stand beside a section teeth",
            ),
            (
                "us: 10\n",
                "us: 10\n  sides: [1, 1]\n",
                "teeth.sides and teeth.clocking must be left out beside second",
            ),
            (
                "us: 10\n",
                "us: 10\n  clocking: 0.5\n",
                "teeth.sides and teeth.clocking must be left out beside",
            ),
            (
                "[input, idler]",
                "[input]",
                r"second_gear.roles must list one role for each of 2 pinions, .*\['input'\]",
            ),
            ("[input, idler]", "[idler, idler]", "an input among them"),
            (
                "[input, idler]",
                "[input, sun]",
                r"second_gear.roles\[1\] must be input or idler or output, got 'sun'",
            ),
            (
                "[input, idler]",
                "[input, [idler]]",
                r"second_gear.roles\[1\] must be input or idler or output, got",
            ),
            (
                "[input, idler]",
                "input",
                "second_gear.roles must be a list of 1 to 12 words, each input or idler or",
            ),
            ("  roles: [input, idler]", "  {}", "second_gear.roles is missing"),
            (
                "module_mm: 3.175",
                "module_mm: 3.175\n  shaft_angle_deg: 80",
                "gears.shaft_angle_deg must be 90° beside second_gear, .*got 80°",
            ),
            (
                "[0, 90]",
                "[0, 91]",
                r"pinions.angles_deg\[1\] must differ from the first by a whole number of halves of the angular pitch, "
                r"1.384615385°, .* got 91°; the nearest that fits is 91.38461538°",
            ),
        ],
    )
    def test_what_does_not_go_together_is_refused(self, old, new, told):
        assert old in self.TEXT
        with pytest.raises(DriveFileError, match=told):
            parse_drive(self.TEXT.replace(old, new))
