"""Verdict on a drive: driving force, contact ratio, basis, in words."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from facegear.drives import verdict
from facegear.drives.basis import BasisStep, SettledTongues
from facegear.drives.drive_file import read_drive_file
from facegear.drives.forces import PLACES
from facegear.drives.shaft_modes import SettledTorsion
from facegear.drives.tolerances import Tolerances
from facegear.floquet.labels import Combination
from facegear.floquet.modes import mean_growth_rate
from facegear.floquet.multipliers import growth_rate
from facegear.maps.tracing import Tongue
from facegear.mechanics.contact import Contact
from facegear.mechanics.heavy_shafts import HeavyShafts
from facegear.mechanics.loaded_contact import LoadedContact
from facegear.support.parameters import rad_per_s

DRIVES = Path(__file__).resolve().parents[2] / "data" / "drives"
CASE_1 = read_drive_file(DRIVES / "case_1.yaml")
LOCALIZED = read_drive_file(DRIVES / "localized.yaml")
TWO_GEARS = read_drive_file(DRIVES / "two_gears.yaml")
EXAMPLE_B = read_drive_file(DRIVES / "example_b.yaml")
RANGE = (10.0, 110.0)


def in_range(file, low, high):
    speeds = (float(rad_per_s(low)), float(rad_per_s(high)))
    return replace(file, requirements=replace(file.requirements, speeds=speeds))


class TestDrivenModel:
    def test_case_1_flutters_under_its_own_power(self):
        """36 of 37 speeds on the true sweep and 35 with Tregold's ratio; none, or 7, where the force is left out."""
        speeds = np.linspace(*CASE_1.requirements.speeds, 37)
        counts = {}
        for name, contact in CASE_1.contacts.items():
            for force in ("follower", "dead"):
                model = verdict.driven(CASE_1, force, contact)
                counts[name, force] = sum(growth_rate(model.system(float(v))) > 0 for v in speeds)
        assert counts == {
            ("Tregold", "follower"): 35,
            ("Tregold", "dead"): 7,
            ("true sweep", "follower"): 36,
            ("true sweep", "dead"): 0,
        }

    def test_carries_the_power_and_all_harmonics(self):
        model = verdict.driven(EXAMPLE_B, "dead", Contact(contact_ratio=1.6))
        assert (model.force.power, model.force.pinion_speed) == (
            447.42e3,
            EXAMPLE_B.requirements.pinion_speed,
        )
        assert (model.force.following, model.force.harmonics, model.contact_ratio) == ("dead", 6, 1.6)

    @pytest.mark.parametrize("name", ["Tregold", "true sweep"])
    def test_force_presses_where_the_file_says(self, name):
        contact, drive = CASE_1.contacts[name], CASE_1.drive
        points = {}
        for place in PLACES:
            force = verdict.driven(replace(CASE_1, force_at=place), "follower", contact).force
            points[place] = force.spread.points(drive)
            assert points[place].share.sum() == pytest.approx(1.0, rel=1e-12)
        assert (points["rim"].radius, points["rim"].angle) == (1.0, 0.0)
        # N2 m/2 over the outer radius.
        at_pitch = 130 * 3.175e-3 / 2 / drive.outer_radius
        assert points["pitch"].radius == pytest.approx([at_pitch], rel=1e-12)
        for place in ("tooth", "pairs"):
            radius = points[place].radius
            assert radius.min() > drive.inner_radius / drive.outer_radius
            assert radius.max() < 1.0
        # Pairs enter and leave with the clock: with more of them in mesh they reach further from the axis.
        reach = np.ptp(points["pairs"].angle) - np.ptp(points["tooth"].angle)
        assert reach == pytest.approx(contact.ratio(drive) * drive.angular_pitch, rel=0.15)

    def test_pairs_of_a_contact_under_load_bear_what_the_load_gives_them(self):
        name, contact = next(iter(LOCALIZED.contacts.items()))
        force = verdict.driven(replace(LOCALIZED, force_at="pairs"), "dead", contact).force
        points = force.spread.points(LOCALIZED.drive)
        assert name == "contact under load"
        assert points.share.sum() == pytest.approx(1.0, rel=1e-9)

    def test_both_gears_have_the_force_of_each_mesh(self):
        model = verdict.driven(TWO_GEARS, "dead", TWO_GEARS.contacts["Tregold"])
        assert (model.roles, model.gear.contact) == (("input", "idler"), TWO_GEARS.contacts["Tregold"])
        assert (model.gear.force.power, model.gear.force.harmonics) == (TWO_GEARS.requirements.power, 6)

    def test_flutter_of_the_mean_system_needs_a_following_force(self):
        true_sweep = CASE_1.contacts["true sweep"]
        rates = [
            mean_growth_rate(verdict.driven(CASE_1, force, true_sweep).system(80.0))
            for force in ("follower", "dead")
        ]
        assert rates[0] > 0 > rates[1]


class TestCases:
    def test_clock_of_the_file_first_and_both_forces(self):
        found = verdict.cases(in_range(CASE_1, 960, 980), most_steps=1, jobs=1)
        assert [case.name for case in found] == [
            "Tregold, force follows the rim",
            "Tregold, force keeps its direction",
            "true sweep, force follows the rim",
            "true sweep, force keeps its direction",
        ]
        assert [case.flutter_share for case in found] == [1.0, 0.0, 1.0, 0.0]
        assert [case.found.unstable_share for case in found] == pytest.approx([1.0, 0.0, 1.0, 0.0])

    def test_of_teeth_that_touch_at_a_point(self):
        found = verdict.cases(in_range(LOCALIZED, 700, 760), most_steps=1, jobs=1)
        assert [case.contact for case in found] == [*2 * ["contact under load"], *2 * ["point contact"]]
        duty = LOCALIZED.requirements
        loaded = LoadedContact(LOCALIZED.drive, duty.power / duty.pinion_speed).contact_ratio
        ratios = [case.found.model.contact_ratio for case in found]
        assert ratios == pytest.approx([loaded, loaded, 1.557363852, 1.557363852], abs=1e-9)


def case(clock, force, *intervals, settled=True, moved=0.004, flutter=0.0):
    found = tuple(
        Tongue(low, high, (low + high) / 2, growth, Combination(1, 2, "sum", 1))
        for low, high, growth in intervals
    )
    steps = (BasisStep(1, 3, found, np.nan), BasisStep(2, 5, found, moved))
    return verdict.Case(
        clock, force, SettledTongues(CASE_1.transverse, RANGE, steps, settled), flutter_share=flutter
    )


BAD = ((20.0, 30.0, 2.0),)


class TestWords:
    FILE = replace(CASE_1, requirements=replace(CASE_1.requirements, speeds=RANGE))

    def said(self, *computed, torsional=None):
        torsion = None if torsional is None else SettledTorsion(None, RANGE, torsional, settled=True)
        return verdict.verdict(self.FILE, computed, torsion)

    @pytest.mark.parametrize(
        ("unstable", "words"),
        [
            ((True, True, True, True), "Not safe"),
            (
                (False, False, False, False),
                "Stable at all speeds from 95.49 to 1050 rpm under the driving force of 447.4 kW a pinion at 5000 rpm",
            ),
            ((True, False, True, False), "depends on whether the driving force follows the bent rim."),
            ((True, True, False, False), "depends on the contact ratio."),
            (
                (True, False, False, False),
                "depends on the contact ratio and on whether the driving force follows",
            ),
        ],
    )
    def test_headline_follows_from_the_cases(self, unstable, words):
        settings = [(clock, force) for clock in ("Tregold", "true sweep") for force in ("follower", "dead")]
        computed = [
            case(clock, force, *(BAD if bad else ()))
            for (clock, force), bad in zip(settings, unstable, strict=True)
        ]
        assert words in self.said(*computed).headline

    def test_torsion_is_part_of_it(self):
        stable = case("Tregold", "follower")
        alone = self.said(stable, torsional=stable_or(BAD)).headline
        assert alone.startswith(
            "Not safe: in torsion unstable at some speeds. Of the disk's motion: Stable at all"
        )
        both = self.said(case("Tregold", "follower", *BAD), torsional=stable_or(BAD)).headline
        assert both.startswith("Not safe: unstable at some speeds")
        assert both.endswith("In torsion it is unstable at some speeds.")
        assert "In torsion it is stable" in self.said(stable, torsional=()).headline
        assert "torsion (the file has no section gearbox)" in self.said(stable).left_out

    def test_shafts_that_cannot_be_built_are_among_the_findings(self):
        box = read_drive_file(DRIVES / "gearbox_table_7_1.yaml")
        file = replace(box, torsional=HeavyShafts(box.torsional, 0.5, 0.5))
        torsion = SettledTorsion(file.torsional, RANGE, (), settled=True)
        found = verdict.verdict(file, [case("Tregold", "follower")], torsion).findings
        (sentence,) = [finding for finding in found if "built" in finding]
        assert sentence.startswith(
            "Cannot be built as a solid shaft: input shaft of 98.4 mm diameter is thicker"
        )

    def test_speeds_in_rpm_with_four_digits(self):
        many = tuple((10.0 + 10 * i, 11.0 + 10 * i + 0.1 * i, 1.0) for i in range(5))
        finding, _ = self.said(case("Tregold", "follower", *many)).findings
        assert "286.5 to 297.9, 382 to 394.4, 477.5 to 490.8 rpm and 2 narrower intervals" in finding
        assert "rad/s" not in finding
        assert "parametric resonance, the strongest (1+2)/1" in finding
        assert (
            "2 nodal circles and 5 nodal diameters; the basis before differs at 0.4 % of the speeds"
            in finding
        )

    def test_one_of_a_kind_is_one(self):
        stable = case("Tregold", "follower")
        small = replace(stable.found.steps[-1], nodal_circles=1, nodal_diameters=1)
        found = replace(stable.found, steps=(*stable.found.steps[:-1], small))
        finding, _ = self.said(replace(stable, found=found)).findings
        assert "1 nodal circle and 1 nodal diameter;" in finding

    def test_what_has_not_settled_says_so(self):
        said = self.said(case("Tregold", "follower", *BAD, settled=False, moved=0.2))
        finding, _ = said.findings
        assert "NOT SETTLED" in finding
        assert "NOT SETTLED in 1 of 1 cases" in said.headline
        quiet = self.said(case("Tregold", "follower", settled=False, moved=0.0))
        assert quiet.headline.startswith("Not shown to be safe")
        # A page then says neither that it is good nor that nothing has to change.
        assert quiet.in_doubt
        assert not self.said(case("Tregold", "follower")).in_doubt
        assert "NOT SETTLED" not in self.said(case("Tregold", "follower")).headline

    def test_teeth_that_are_too_weak_are_part_of_it(self):
        strong = self.said(case("Tregold", "follower"))
        assert "strong enough" not in strong.headline
        weak = replace(self.FILE.requirements, power=3.0 * self.FILE.requirements.power)
        said = verdict.verdict(replace(self.FILE, requirements=weak), (case("Tregold", "follower"),), None)
        stress = float(re.search(r"The teeth are not strong enough: ([\d.]+) MPa", said.headline)[1])
        # In proportion to the power.
        spoken = re.search(
            r"Strength: ([\d.]+) MPa at the root of the pinion's tooth, ([\d.]+)", strong.findings[-1]
        )
        assert stress == pytest.approx(3.0 * float(spoken[1]), rel=1e-3)
        assert float(spoken[1]) < float(spoken[2]) < stress

    def test_flutter_is_named(self):
        finding, _ = self.said(case("Tregold", "follower", *BAD, flutter=0.5)).findings
        assert "at 50 % of 61 speeds looked at the driving force alone makes the mean system" in finding


def stable_or(intervals):
    return case("Tregold", "follower", *intervals).found.tongues


def test_a_report_says_that_it_leaves_tolerances_out():
    file = read_drive_file(DRIVES / "case_1.yaml")
    assert "tolerances" not in verdict._left_out(file)
    given = replace(file, tolerances=Tolerances(stiffness=0.1))
    assert verdict._left_out(given).endswith(
        "The tolerances of the file are left out here; facegear assess has them."
    )
