"""Drive files: examples, every kind of mistake, and thousands of files that nobody would write."""

import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from facegear.drives.drive_file import DriveFile, DriveFileError, parse_drive, read_drive_file
from facegear.drives.drive_keys import NAME, SECTIONS
from facegear.drives.forces import pressed
from facegear.floquet.multipliers import growth_rate
from facegear.geometry.drive import Drive
from facegear.mechanics import cases, gearboxes
from facegear.mechanics.edge_stiffness import DrivingForce
from facegear.mechanics.loaded_contact import LoadedContact
from facegear.mechanics.sharing import shared_load
from facegear.mechanics.spread_force import root_thickness
from facegear.mechanics.torsional import mesh_stiffness
from facegear.mechanics.two_gears import TwoGears
from facegear.support.parameters import rad_per_s

ROOT = Path(__file__).resolve().parents[2]
DRIVES = ROOT / "data" / "drives"
CASE_1 = (DRIVES / "case_1.yaml").read_text(encoding="utf-8")
GEARBOX = (DRIVES / "gearbox_table_7_1.yaml").read_text(encoding="utf-8")
BOTH_FACES = (DRIVES / "both_faces.yaml").read_text(encoding="utf-8")
PATHS = [NAME.name, *SECTIONS, *(f"{n}.{key.name}" for n, s in SECTIONS.items() for key in s.keys)]


def refusal(content):
    with pytest.raises(DriveFileError) as caught:
        parse_drive(content, "my.yaml")
    message = str(caught.value)
    assert message.startswith("my.yaml: ")
    assert "\n" not in message
    return message.removeprefix("my.yaml: ")


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

    def test_too_few_teeth_are_told_in_the_words_of_the_file(self):
        few = self.TEETH.replace("pinion_teeth: 26", "pinion_teeth: 18").replace(
            "gear_teeth: 130", "gear_teeth: 90"
        )
        few = few.replace("bore_radius_mm: 50", "bore_radius_mm: 30")
        told = refusal(few)
        assert re.match(
            r"teeth: gears.pinion_teeth = 18 is too few for a section teeth, whose model follows the moving contact "
            r"\(gears.gear_teeth = 90, .* 22 pinion teeth are enough",
            told,
        )
        assert "rate" not in told.replace("ratio", "")
        assert parse_drive(few.split("\nteeth:")[0]).teeth is None

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
                "gearbox.backlash_um must be 0 beside lengths of shafts",
            ),
        ],
    )
    def test_what_does_not_go_together_is_refused(self, keys, told):
        with pytest.raises(DriveFileError, match=told):
            parse_drive(GEARBOX.replace("gearbox:\n", f"gearbox:\n  {keys}\n"))


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
    ["<img src=x onerror='1'>", "a\nb", "# heading", "=1+1", "\u202e\0\x1b[31m", "Zahnrad Ⅱ 🦷", "a" * 80],
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


# --- mistakes that people make ----------------------------------------------------------------------------------


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
        (
            "bore_radius_mm: 50",
            "bore_radius_mm: 190",
            r"body.bore_radius_mm .* 11.5969 and 188.433 mm .*got 190 mm",
        ),
        ("thickness_ratio: 0.03", "thickness_ratio: 30", r"body.thickness_ratio .*0.2.* got 30 .*0.03 would"),
        (
            "damping_us: 3",
            "damping_us: 3e-6",
            r"pinions.damping_us .*got 3e-06 µs .*: 3 would be valid, in µs",
        ),
        ("damping_us: 3", "damping_us: -3", r"pinions.damping_us .*got -3"),
        ("damping_us: 3", "damping_us: '3'", r"pinions.damping_us must be 0, or a number from .*got '3'"),
        ("mass: 1.0", "mass: .nan", r"pinions.mass must be finite, got nan"),
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
            "mass: 1.0\n  angles_deg: [5, -355]",
            r"pinions.angles_deg\[1\] must differ .*at least 26\.\d+°.*-355° beside 5°",
        ),
        (
            "mass: 1.0",
            "mass: 1.0\n  contact_ratio: 1.5",
            r"pinions.contact_ratio must be usual or tregold or geometric or loaded or unloaded, got 1.5",
        ),
        (
            "mass: 1.0",
            "mass: 1.0\n  contact_ratio: loaded",
            r"^pinions.contact_ratio must be usual, tregold, geometric for a shaper of 26 teeth .* 26, got 'loaded'",
        ),
        (
            "gear_teeth: 130",
            "gear_teeth: 130\n  shaper_teeth: 25",
            r"gears.shaper_teeth must be at least 26, got 25",
        ),
        ("gear_teeth: 130", "gear_teeth: 130\n  shaper_teeth: false", r"gears.shaper_teeth must .*got False"),
        ("gear_teeth: 130", "gear_teeth: 130\n  shaper_teeth: 1", r"gears.shaper_teeth must .*10, got 1"),
        (
            "pinion_teeth: 26",
            "pinion_teeth: 26.0",
            r"gears.pinion_teeth must be an integer of at least 10, got 26.0",
        ),
        ("pinion_teeth: 26", "pinion_teeth: true", r"gears.pinion_teeth must be an integer .*got True"),
        ("pinion_teeth: 26", "pinion_teeth: 5", r"gears.pinion_teeth must be at least 10, got 5"),
        ("pinion_teeth: 26", "pinion_teeth: 11", r"gears.pinion_teeth=11 is too few.*take more teeth"),
        (
            "pinion_teeth: 26",
            "pinion_teeth: 140",
            r"gears.gear_teeth must exceed gears.pinion_teeth=140, got 130",
        ),
        (
            "module_mm: 3.175",
            "module_mm: 3.175\n  pressure_angle_deg: 0.436",
            r"gears.pressure_angle_deg .*14.5, 30.*got 0.436 ° .*24.98\d* would be valid",
        ),
        (
            "lowest_speed_rpm: 100",
            "lowest_speed_rpm: 10",
            r"operation.lowest_speed_rpm .*1/50 of it, got 10 rpm",
        ),
        ("lowest_speed_rpm: 100", "lowest_speed_rpm: 1000", r"operation.lowest_speed_rpm .*got 1000 rpm"),
        ("gears:", "gear:", r"gear = .* is no key of a drive file: did you mean gears\?"),
        (
            "name: Case I",
            "name: Case I\nthickness_ratio: 3",
            r"thickness_ratio = 3 is no key .*belongs to body",
        ),
        ("name: Case I", "name: 3", r"name must be text of 1 to 80 characters, got 3"),
        ("name: Case I", "name: '  '", r"name must be text of 1 to 80 characters, got '  '"),
        ("name: Case I", f"name: {'x' * 81}", r"name must be text of 1 to 80 characters, got 'xxx"),
        ("name: Case I", 'name: "\\ud800"', r"line 2: '\\ud800' holds half a character"),
        (
            "module_mm: 3.175",
            "module_mm: 3.175\n  diametral_pitch_per_inch: 8",
            r"gears.module_mm and gears.diametral_pitch_per_inch say the same: give one of them",
        ),
        (
            "power_kW: 447.42",
            "power_kW: 447.42\n  power_hp: 600",
            r"operation.power_kW and operation.power_hp say the same",
        ),
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
        # What is swapped, mistyped or meant otherwise is said where the other reading would do.
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
            "highest_speed_rpm: 1000",
            "highest_speed_rpm: 41650",
            r"operation.lowest_speed_rpm must be lower",
        ),
        (
            "lowest_speed_rpm: 100\n  highest_speed_rpm: 1000",
            "lowest_speed_rpm: 1000\n  highest_speed_rpm: 41650",
            r"operation.highest_speed_rpm must be at most 41589.6 rpm for this body.*got 41650 rpm",
        ),
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


@pytest.mark.parametrize("content", ["", "3", "- a\n- b", "name", b"\xff"])
def test_what_is_no_mapping_is_refused(content):
    assert re.search("must be a section|not text in UTF-8", refusal(content))


def test_long_values_are_cut_in_messages():
    assert len(refusal(CASE_1.replace("mass: 1.0", f"mass: {'x' * 5000}"))) < 250
    assert len(refusal(CASE_1.replace("mass: 1.0", f"{'x' * 500}: 1.0"))) < 400


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


def test_of_a_body_too_soft_each_key_that_could_help_is_named():
    told = refusal(yaml.safe_dump(yaml.safe_load(BOTH_FACES) | {"material": {"youngs_modulus_GPa": 1}}))
    keys = ("body.thickness_ratio", "material.youngs_modulus_GPa", "material.density_kg_per_m3")
    assert all(key in told for key in keys)
