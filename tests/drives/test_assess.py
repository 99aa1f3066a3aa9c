"""An assessment: what follows from what its models come to, and that these are what they are called."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
import yaml

from facegear.drives.assess import _Found, _in_torsion, _Tried, assess
from facegear.drives.assessment import Assessment
from facegear.drives.assessment_files import PAGE, sections, write_assessment
from facegear.drives.basis import with_basis
from facegear.drives.disk_response import RIGID as RIGID_TEETH
from facegear.drives.disk_response import DiskResponse
from facegear.drives.drive_file import parse_drive, read_drive_file
from facegear.drives.findings import TORSION, Findings
from facegear.drives.growth_words import told
from facegear.drives.intervals import gaps
from facegear.drives.outcome import Outcome
from facegear.drives.page import page
from facegear.drives.sections import torsion as torsion_section
from facegear.drives.shaft_modes import SettledTorsion
from facegear.drives.tolerances import Tolerances
from facegear.drives.variants import RIGID, RIGID_TOTAL, Variant, plain_contacts
from facegear.drives.verdict import FORCES, cases
from facegear.drives.worst_case import WorstCase, not_known
from facegear.floquet.labels import Combination
from facegear.floquet.response import steady_response
from facegear.maps.tracing import Tongue, tongues
from facegear.mechanics.heavy_shafts import HeavyShafts
from facegear.support.parameters import rad_per_s, rpm
from tests.drives.test_page import HOSTILE, Reader

DRIVES = Path(__file__).resolve().parents[2] / "data" / "drives"
CASE_1 = read_drive_file(DRIVES / "case_1.yaml")
FOLLOWER, DEAD = FORCES.values()
NARROW = """
tolerances:
  stiffness_percent: 5
"""


def tongue(low, high, growth=2.0):
    lower, upper = (float(rad_per_s(x)) for x in (low, high))
    return Tongue(lower, upper, (lower + upper) / 2, growth, Combination(1, 8, "sum", 1))


def outcome(contact, force, teeth, *unstable, settled=True):
    return Outcome(Variant(contact, force, teeth, CASE_1.transverse), unstable, settled)


def assessment(*outcomes, torsion=None, worst=None, file=CASE_1):
    return Assessment(file, outcomes, massless_shafts(torsion or {}), worst or {}, None, "", ())


def massless_shafts(torsion):
    """Tongues of gearboxes that have no modes of shafts to settle."""
    box = read_drive_file(DRIVES / "gearbox_table_7_1.yaml").torsional
    return {
        name: SettledTorsion(box, CASE_1.requirements.speeds, tongues, settled=True)
        for name, tongues in torsion.items()
    }


class TestVerdict:
    def test_safe_under_all(self):
        found = assessment(outcome("Tregold", DEAD, RIGID), outcome("Tregold", FOLLOWER, RIGID))
        assert (found.verdict, found.decides) == ("safe under all", ())
        assert found.headline == (
            "Safe under all: from 100 to 1000 rpm, of 2 models of the disk's motion none is unstable at any speed. "
            "Speeds at which every model is known to be stable: 100 to 1000 rpm. "
            "Speeds at which all models are unstable: no speed."
        )

    def test_that_nobody_knows_whether_flanks_part_is_said_beside_safe(self):
        safe = outcome("Tregold", DEAD, RIGID)
        words = "Whether flanks stay in contact under the load of the drive is not known (Dynamic load)."
        for reason, known in ((RIGID_TEETH, True), ("between two gears it is not computed", False)):
            response = DiskResponse(safe.variant, 0.0, None, reason)
            found = replace(assessment(safe), disk_responses=(response,))
            assert found.verdict == "safe under all"
            assert (words in found.headline) == (not known)

    def test_unstable_under_all_though_not_at_the_same_speeds(self):
        found = assessment(
            outcome("Tregold", DEAD, RIGID, tongue(200, 300)),
            outcome("Tregold", DEAD, RIGID_TOTAL, tongue(250, 400)),
        )
        assert found.verdict == "unstable under all"
        assert "Speeds at which all models are unstable: 250 to 300 rpm." in found.headline
        assert told(found.always_stable) == "100 to 200, 400 to 1000 rpm"
        assert (
            "Worst: parametric resonance (1+8)/1 at 250 rpm, growing by 2 1/s (Tregold; force keeps"
            in found.headline
        )

    def test_what_decides_is_what_alone_parts_stable_from_unstable(self):
        stable = outcome("true sweep", DEAD, RIGID)
        other = outcome("true sweep", FOLLOWER, RIGID, tongue(200, 300))
        assert assessment(stable, other).decides == ("the direction of the driving force",)
        # Two effects at once decide nothing of one of them.
        both = outcome("Tregold", FOLLOWER, RIGID, tongue(200, 300))
        assert assessment(stable, both).decides == ()
        found = assessment(stable, other, outcome("Tregold", DEAD, RIGID, tongue(500, 501)))
        assert found.decides == ("the contact", "the direction of the driving force")
        assert found.headline.startswith(
            "Depends on the contact and the direction of the driving force: from 100 to 1000 rpm, of 3 models of the "
            "disk's motion 1 is stable at all speeds."
        )

    def test_torsion_alone_makes_a_drive_unstable(self):
        torsion = {"Tregold, arm as printed": (tongue(600, 620, 90.0),)}
        found = assessment(outcome("Tregold", DEAD, RIGID), torsion=torsion)
        assert found.verdict == "unstable under all"
        assert told(found.always_unstable) == "600 to 620 rpm"
        assert "(torsion; Tregold, arm as printed)" in found.headline
        assert "The one model of torsion is unstable somewhere." in found.headline
        assert "unstable: 600 to 620 rpm" in found.headline
        torsion["true sweep, arm as printed"] = ()
        found = assessment(outcome("Tregold", DEAD, RIGID), torsion=torsion)
        assert (found.verdict, found.decides) == (
            "depends",
            ("the contact or the arm of the mesh force in torsion",),
        )

    def test_tolerances_turn_a_stable_drive(self):
        swept = ((float(rad_per_s(200.0)), float(rad_per_s(290.0))),)
        worst = {DEAD: WorstCase(CASE_1.requirements.speeds, {}, swept, swept)}
        file = replace(CASE_1, tolerances=Tolerances(stiffness=0.1, speed=0.02))
        found = assessment(outcome("Tregold", DEAD, RIGID), worst=worst, file=file)
        assert found.verdict == "depends"
        assert found.decides == ("where in its tolerance stiffness lies",)
        assert found.over_tolerances == (
            "With stiffness ±10 %, speed ±2 %, force keeps its direction: unstable for some values at 200 to 290 rpm, "
            "10 % of the speeds; between the 0 values looked at, so that it is not known how fast; stable at 100 to "
            "200, 290 to 1000 rpm.",
        )
        assert told(found.always_stable) == "100 to 200, 290 to 1000 rpm"

    @pytest.mark.parametrize(("number", "kind"), [(1, "flutter"), (0, "divergence")])
    def test_what_grows_by_itself_is_called_by_its_name(self, tmp_path, number, kind):
        """A motion that does not oscillate was called a flutter, and its name explained nowhere."""
        alone = replace(tongue(240, 260, 7.5), combination=Combination(number, number, "mean", 0))
        found = assessment(outcome("Tregold", DEAD, RIGID, alone))
        text = Reader(write_assessment(found, tmp_path).read_text(encoding="utf-8")).text
        assert f"Worst: {kind} of the mean system, mean {number} at 250 rpm" in text
        assert re.search(rf"mean {number}: [^:]*\({kind}\)", text)

    def test_growth_at_a_value_in_the_tolerances_is_told(self, tmp_path):
        """A corner that grows faster than every model at the values of the file is the worst, with its factors."""
        strong = replace(tongue(240, 260, 7.5), combination=Combination(1, 1, "mean", 0))
        points = {
            (1.0, 1.0): (tongue(200, 300),),
            (1.1, 0.8): (tongue(210, 290, 5.0), strong),
            (0.9, 0.8): (),
        }
        worst = {DEAD: WorstCase(CASE_1.requirements.speeds, points, ((20.0, 30.0),), ((20.0, 30.0),))}
        file = replace(CASE_1, tolerances=Tolerances(stiffness=0.1, damping=0.2))
        found = assessment(outcome("Tregold", DEAD, RIGID, tongue(200, 300)), worst=worst, file=file)
        said = f"flutter of the mean system, {strong.label} at 250 rpm, growing by 7.5 1/s"
        where = "with stiffness times 1.1, damping times 0.8"
        assert f"Worst: {said} ({DEAD}, tolerances; {where})." in found.headline
        assert found.over_tolerances[0].count(
            f"; fastest of the 3 values looked at: {said}, {where}; stable at "
        )
        text = Reader(write_assessment(found, tmp_path).read_text(encoding="utf-8")).text
        assert all(words in text for words in ("growth [1/s]", strong.label, "7.5"))
        table = (tmp_path / "tolerances.csv").read_text(encoding="utf-8-sig")
        assert f'"{where}",{strong.label},240,260,250,7.5' in table
        assert '"with stiffness times 0.9, damping times 0.8",,,,,0' in table
        # The same rate at the values of the file is told of the model.
        alone = {DEAD: replace(worst[DEAD], points={(1.0, 1.0): (tongue(200, 300),)})}
        assert f"({outcome('Tregold', DEAD, RIGID).variant.name})" in replace(found, worst=alone).headline

    def test_tolerances_of_shafts_turn_torsion(self):
        swept = ((float(rad_per_s(600.0)), float(rad_per_s(690.0))),)
        speeds = CASE_1.requirements.speeds
        worst = {TORSION: WorstCase(speeds, {}, swept, swept)}
        file = replace(CASE_1, tolerances=Tolerances(damping=0.2, shaft_stiffness=0.1))
        stable = {"Tregold, arm as printed": ()}
        found = assessment(outcome("Tregold", DEAD, RIGID), torsion=stable, worst=worst, file=file)
        assert (found.verdict, found.decides) == (
            "depends",
            ("where in their tolerances damping of teeth and stiffness of shafts lie",),
        )
        assert found.over_tolerances == (
            "With damping of teeth ±20 %, stiffness of shafts ±10 %, torsion: unstable for some values at 600 to 690 "
            "rpm, 10 % of the speeds; between the 0 values looked at, so that it is not known how fast; stable at 100 "
            "to 600, 690 to 1000 rpm.",
        )
        assert told(found.always_stable) == "100 to 600, 690 to 1000 rpm"

    def test_tolerances_that_could_not_be_followed_make_no_drive_safe(self):
        file = replace(CASE_1, tolerances=Tolerances(stiffness=0.1))
        worst = {DEAD: not_known("transition matrices jump", file.requirements.speeds, file.tolerances)}
        found = assessment(outcome("Tregold", DEAD, RIGID), worst=worst, file=file)
        assert found.verdict == "depends"
        assert found.over_tolerances == (
            "With stiffness ±10 %, force keeps its direction: not known (transition matrices jump).",
        )
        # What is not known is not called stable.
        assert found.always_stable == ()

    def test_where_a_tongue_may_come_nothing_is_called_stable(self):
        file = replace(CASE_1, tolerances=Tolerances(stiffness=0.1))
        at, around = (tuple(float(rad_per_s(x)) for x in part) for part in ((200.0, 290.0), (190.0, 300.0)))
        points = {(1.0, 1.0): (), (0.9, 1.0): (tongue(200, 290, 2.0),)}
        worst = {DEAD: WorstCase(file.requirements.speeds, points, (at,), (around,))}
        found = assessment(outcome("Tregold", DEAD, RIGID), worst=worst, file=file)
        assert told(found.always_stable) == "100 to 190, 300 to 1000 rpm"
        (said,) = found.over_tolerances
        assert "unstable for some values at 200 to 290 rpm, 10 % of the speeds" in said
        assert (
            "not known at 190 to 200, 290 to 300 rpm, where something may be unstable between the 2 values"
            in said
        )
        nowhere = {DEAD: replace(worst[DEAD], points={}, swept=())}
        (said,) = replace(found, worst=nowhere).over_tolerances
        assert said.endswith(
            "where something may be unstable between the 0 values looked at; stable at 100 to 190, 300 to 1000 rpm."
        )
        changed = replace(found, worst=nowhere)
        assert changed.verdict == "depends"
        # That it depends is not asserted.
        not_known = "whether anything in the tolerance of stiffness is unstable, which is not known"
        assert changed.decides == (not_known,)
        assert changed.headline.startswith(f"Depends on {not_known}: ")
        everywhere = replace(nowhere[DEAD], possible=(file.requirements.speeds,))
        assert (
            replace(found, worst={DEAD: everywhere})
            .over_tolerances[0]
            .endswith("; at no speed known to be stable for all of its values.")
        )

    def test_a_tolerance_of_speed_that_alone_decides_is_named(self):
        """A tongue that begins where the operating speeds end, at the stiffness and damping of the file already."""
        beyond = (tongue(1005, 1015, 3.0),)
        swept = tuple((t.lower, t.upper) for t in beyond)
        file = replace(CASE_1, tolerances=Tolerances(stiffness=0.1, speed=0.02))
        wide = file.tolerances.widened(file.requirements.speeds)
        disk = {DEAD: WorstCase(wide, {(1.0, 1.0): beyond}, swept, swept)}
        torsion = {"Tregold, arm as printed": beyond}
        for parts in ({"worst": disk}, {"torsion": torsion}, {"worst": disk, "torsion": torsion}):
            found = assessment(outcome("Tregold", DEAD, RIGID), file=file, **parts)
            assert (found.verdict, found.decides) == (
                "depends",
                ("speeds beyond the operating ones, in their tolerance",),
            )
        # Where it takes both, both are named.
        both = {DEAD: WorstCase(wide, {(1.0, 1.0): (), (0.9, 1.0): beyond}, swept, swept)}
        found = assessment(outcome("Tregold", DEAD, RIGID), file=file, worst=both)
        assert found.decides == ("where in their tolerances stiffness and speed lie",)

    def test_a_model_that_could_not_be_computed_is_counted_and_no_verdict_is_under_all(self, tmp_path):
        stable, unstable = outcome("Tregold", DEAD, RIGID), outcome("Tregold", DEAD, RIGID, tongue(200, 300))
        failed = ("Tregold; force; flexible teeth: it does not converge",)
        for one, count in ((stable, "1 is"), (unstable, "0 are")):
            found = replace(assessment(one), failed=failed)
            assert (found.verdict, found.decides) == ("depends", ("models that could not be computed",))
            assert found.headline.startswith(
                "Depends on models that could not be computed: from 100 to 1000 rpm, of 1 models of the disk's motion "
                f"{count} stable at all speeds. 1 more could not be computed, and what it comes to is not known"
            )
        text = Reader(write_assessment(found, tmp_path).read_text(encoding="utf-8")).text
        assert f"A model that could not be computed: {failed[0]}" in text
        # A gearbox that is unstable whatever its model is makes the drive so.
        found = replace(found, torsion=massless_shafts({"Tregold, arm as printed": (tongue(600, 620),)}))
        assert found.verdict == "unstable under all"

    def test_what_has_not_settled_says_so(self):
        found = assessment(outcome("Tregold", DEAD, RIGID, settled=False))
        assert "NOT SETTLED in 1 of 1 models: a larger basis may turn it." in found.headline
        # Nothing unstable was found, and that is not enough to be safe.
        assert found.verdict == "depends"
        assert found.decides == ("bases that have not settled",)
        assert (
            "no model was found unstable, which does not make them stable: 100 to 1000 rpm" in found.headline
        )
        assert "every model is known to be stable" not in found.headline

    def test_torsion_whose_shafts_lack_modes_makes_no_drive_safe(self):
        name, speeds = "Tregold, arm as printed", CASE_1.requirements.speeds
        box = read_drive_file(DRIVES / "gearbox_table_7_1.yaml").torsional
        shafts = {name: SettledTorsion(HeavyShafts(box, 0.0, 3.0, modes=40), speeds, (), settled=False)}
        stable = assessment(outcome("Tregold", DEAD, RIGID), torsion={name: ()})
        found = replace(stable, torsion=shafts)
        assert (stable.verdict, found.verdict) == ("safe under all", "depends")
        assert found.decides == ("more modes of a shaft in torsion",)
        assert (
            "NOT SETTLED in 1 of 1 models of torsion: more modes of a shaft may turn it. Speeds at which no model was "
            "found unstable, which does not make them stable"
        ) in found.headline
        assert "40 modes of the output shaft" in page("drive", sections(found))
        assert found.table()["settled"].values[-1] == 0.0


def test_each_model_of_torsion_unstable_somewhere_is_no_speed_unstable_under_all():
    torsion = {
        "Tregold, arm as printed": (tongue(600, 620),),
        "true sweep, arm as printed": (tongue(700, 720),),
    }
    headline = assessment(outcome("Tregold", DEAD, RIGID), torsion=torsion).headline
    assert headline.startswith("Unstable under all, because of torsion; from 100 to 1000 rpm, of 1 models")
    assert "Each of the 2 models of torsion is unstable somewhere." in headline
    assert "every model is known to be stable: 100 to 600, 620 to 700, 720 to 1000 rpm." in headline
    assert "of the disk's motion, or all of torsion, are unstable: no speed." in headline


def test_models_are_listed_with_their_basis_and_those_of_torsion_too(tmp_path):
    """Each in its own basis, which is not that of the file, as the provenance says."""
    richer = with_basis(CASE_1.transverse, 2, 5)
    disk = Outcome(
        Variant("Tregold", DEAD, RIGID, richer), (tongue(200, 300), tongue(400, 410, 3.0)), True, 0.04
    )
    file = replace(CASE_1, tolerances=Tolerances(speed=0.1))
    found = assessment(disk, torsion={"Tregold, arm as printed": (tongue(95, 97, 90.0),)}, file=file)
    table = found.table()
    assert table["motion"].values.tolist() == ["disk", "torsion"]
    assert table["contact"].values.tolist() == ["Tregold", "Tregold, arm as printed"]
    assert (float(table["nodal_circles"][0]), float(table["nodal_diameters"][0])) == (2.0, 5.0)
    assert np.isnan(table["nodal_circles"][1])
    assert np.isnan(table["settled"][1])
    assert table["largest_growth"].values.tolist() == [3.0, 90.0]
    np.testing.assert_allclose(rpm(table["fastest_speed"].values), [405.0, 96.0], rtol=1e-12)
    assert table["unstable_rpm"].values.tolist() == ["200 to 300; 400 to 410", "95 to 97"]
    # In torsion over 90 to 1100 rpm.
    np.testing.assert_allclose(table["unstable_share"], [110 / 900, 2 / 1010], rtol=1e-9)
    assert table.attrs["parameters"].endswith(
        "each model in a basis of its own, given beside it, not that of the file"
    )
    text = Reader(write_assessment(found, tmp_path).read_text(encoding="utf-8")).text
    assert all(
        words in text for words in ("nodal circles, diameters", "2, 5", "200 to 300, 400 to 410", "95 to 97")
    )
    rows = (tmp_path / "models.csv").read_text(encoding="utf-8-sig").splitlines()
    assert rows[1].startswith("disk,Tregold,")
    assert ",2,5,0.04,(1+8)/1,200 to 300; 400 to 410" in rows[1]
    # What grows fastest of all does so beyond the operating speeds.
    assert "at 96 rpm, growing by 90 1/s (torsion; Tregold, arm as printed, outside the range" in text
    assert rows[2].startswith('torsion,"Tregold, arm as printed",,,')


def test_that_torsion_has_one_pinion_is_said_where_the_drive_has_more():
    text = (DRIVES / "gearbox_table_7_1.yaml").read_text(encoding="utf-8")
    one = parse_drive(text)
    content = yaml.safe_load(text)
    content["pinions"]["angles_deg"] = [0, 120]
    two = parse_drive(yaml.safe_dump(content))
    said = "the other pinion in torsion, where there is one, temperature"
    assert said not in assessment(outcome("Tregold", DEAD, RIGID), file=one).not_varied
    assert said in assessment(outcome("Tregold", DEAD, RIGID), file=two).not_varied
    content["pinions"]["angles_deg"] = [0, 120, 240]
    three = parse_drive(yaml.safe_dump(content))
    assert (
        "the other pinions in torsion" in assessment(outcome("Tregold", DEAD, RIGID), file=three).not_varied
    )
    content["operation"] |= {"lowest_speed_rpm": 990}
    for pinions, shown in (([0], False), ([0, 120], True)):
        content["pinions"]["angles_deg"] = pinions
        file = parse_drive(yaml.safe_dump(content))
        section = torsion_section(Findings(file, cells=2, jobs=1))
        assert ("In torsion there is one pinion; the drive has 2." in section.as_html()) is shown


def test_torsion_is_looked_at_in_the_tolerance_of_speed():
    """Its principal tongue ends at 681.8 rpm: 5 % below 685 rpm it is unstable."""
    text = (DRIVES / "gearbox_table_7_1.yaml").read_text(encoding="utf-8")
    text = text.replace("lowest_speed_rpm: 100", "lowest_speed_rpm: 685").replace(
        "highest_speed_rpm: 1000", "highest_speed_rpm: 695"
    )
    stable = parse_drive(text)
    wide = parse_drive(text + "\ntolerances:\n  speed_percent: 5\n")
    found = {}
    for name, file in (("as it is", stable), ("with its tolerance", wide)):
        found[name] = tongues(*_in_torsion(file, plain_contacts(file))["Tregold, arm as printed"])
    assert found["as it is"] == ()
    assert rpm(found["with its tolerance"][-1].upper) == pytest.approx(681.8, abs=0.1)


def test_where_nothing_is_steady_there_is_no_load():
    nothing = np.full((3, 2), np.nan)
    response = xr.Dataset(
        {"force_highest": (("speed", "load"), nothing), "force_lowest": (("speed", "load"), nothing)},
        {"speed": [60.0, 61.0, 62.0]},
    )
    found = Assessment(CASE_1, (outcome("Tregold", DEAD, RIGID),), {}, {}, response, "", ())
    assert found.dynamic_load.startswith("In torsion it is unstable at all speeds looked at")


def test_gaps_between_intervals():
    assert gaps((), (1.0, 2.0)) == ((1.0, 2.0),)
    assert gaps([(1.0, 2.0)], (1.0, 2.0)) == ()
    assert gaps([(0.5, 1.5)], (1.0, 2.0)) == ((1.5, 2.0),)
    assert told(tuple((float(i), i + 0.1 * i) for i in range(1, 7))).endswith("rpm and 2 narrower intervals")


def test_the_page_shows_hostile_names_as_text(tmp_path):
    file = replace(CASE_1, name=HOSTILE)
    found = assessment(outcome("Tregold", DEAD, RIGID, tongue(200, 300)), file=file)
    assert [section.title for section in sections(found)] == [
        "Verdict",
        "Models",
        "Tolerances",
        "Dynamic load",
        "Left out",
        "Words",
    ]
    page = write_assessment(found, tmp_path / "out").read_text(encoding="utf-8")
    read = Reader(page)
    assert "script" not in read.elements
    assert [dict(read.attributes).get(name) for name in ("onerror", "onclick")] == [None, None]
    assert '<img src=x onerror="window.p=1">' in read.text
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == [PAGE, "models.csv", "models.nc"]


def test_files_of_an_earlier_assessment_do_not_lie_beside_a_new_page(tmp_path):
    earlier = ["disk_response_peaks.nc", "disk_response_peaks.csv", "torsion_response.nc", "tolerances.csv"]
    for name in (*earlier, "my_notes.csv"):
        (tmp_path / name).write_text("of another drive")
    # Without a page that says whose they are, they are nobody's to replace.
    with pytest.raises(FileExistsError, match="would be replaced"):
        write_assessment(assessment(outcome("Tregold", DEAD, RIGID)), tmp_path)
    assert (tmp_path / "tolerances.csv").read_text() == "of another drive"
    (tmp_path / PAGE).write_text(page("an earlier one", ()), encoding="utf-8")
    write_assessment(assessment(outcome("Tregold", DEAD, RIGID)), tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        PAGE,
        "models.csv",
        "models.nc",
        "my_notes.csv",
    ]


def test_largest_load_of_a_gearbox_is_that_of_its_steady_response_at_speeds_and_at_peaks_between():
    file = read_drive_file(DRIVES / "gearbox_table_7_1.yaml")
    torque = file.requirements.power / file.requirements.pinion_speed * file.drive.gear_ratio

    def forces(speed_rpm):
        steady = steady_response(file.torsional.under(torque, float(rad_per_s(speed_rpm))))
        return steady.contact_forces(np.linspace(0.0, 1.0, 2001))

    def response(speeds, peaks):
        each, between = ([forces(speed) for speed in some] for some in (speeds, peaks))
        ends = {"highest": np.max, "lowest": np.min}
        return xr.Dataset(
            {
                f"force_{name}": (("speed", "load"), [end(one, axis=0) for one in each])
                for name, end in ends.items()
            }
            | {f"peak_force_{name}": ("peak", [end(one) for one in between]) for name, end in ends.items()}
            | {"peak_speed": ("peak", rad_per_s(np.array(peaks)))},
            {"speed": rad_per_s(np.array(speeds))},
            {"at_borders": 0},
        )

    largest = {speed: forces(speed).max() for speed in (400.0, 700.0, 800.0)}
    assert largest[400.0] > max(largest[700.0], largest[800.0])
    for peaks in ([], [400.0]):
        found = Assessment(
            file, (outcome("Tregold", DEAD, RIGID),), {}, {}, response([700.0, 800.0], peaks), "", ()
        )
        speed = max((700.0, 800.0, *peaks), key=largest.__getitem__)
        assert f"{largest[speed]:.4g} N, at {speed:.4g} rpm" in found.dynamic_load
        assert ("of 1 peak of resonances between them" in found.dynamic_load) == bool(peaks)
    # The static force is that of the torque at the base circle.
    assert found.static_force == pytest.approx(
        torque / (file.drive.base_radius * file.drive.gear_ratio), rel=1e-12
    )


def test_a_model_whose_computation_fails_is_among_those_that_failed():
    work = _Found(CASE_1, 0.02, 1, lambda words: None)
    variant = Variant("Tregold", DEAD, RIGID_TOTAL, CASE_1.transverse)
    work.others[0, 1] = variant
    work.take(None, ("teeth", (0, 1)), _Tried(None, "it does not converge"))
    work.outcomes[0, 0] = outcome("Tregold", DEAD, RIGID)
    found = work.assessment()
    assert found.failed == (f"{variant.name}: it does not converge",)
    assert (found.verdict, found.left_out) == (
        "depends",
        ("dynamic load of the teeth in torsion: the file has no section gearbox",),
    )


class Recorder:
    """Crew that only remembers what there is to do."""

    def __init__(self):
        self.added = {}

    def add(self, name, urgency, function, *arguments):
        self.added[name] = arguments


def test_a_main_model_that_cannot_be_computed_leaves_the_others_to_be():
    said, crew = [], Recorder()
    work = _Found(CASE_1, 0.02, 1, said.append)
    number = len(work.cases)
    for which in range(number):
        work.take(crew, ("case", which), _Tried(None, "it does not converge"))
    assert said[-1].startswith(f"case {number} of {number}: could not be computed (")
    # Other teeth are tried all the same.
    assert {name[1][0] for name in crew.added if name[0] == "teeth"} == set(range(number))
    with pytest.raises(ArithmeticError, match=r"no model of the disk's motion could be computed: .*converge"):
        work.assessment()
    work.outcomes[0, 1] = outcome("Tregold", DEAD, RIGID_TOTAL)
    work.others = {(0, 1): work.outcomes[0, 1].variant}
    found = work.assessment()
    assert found.verdict == "depends"
    assert found.failed[0] == f"{work.cases[0].name}: it does not converge"
    assert len(found.failed) == number


def test_the_first_verdict_says_so_if_there_is_none(monkeypatch):
    def fails(*args, **options):
        raise ArithmeticError("it does not converge")

    monkeypatch.setattr("facegear.drives.assess.found_around", fails)
    said, crew = [], Recorder()
    _Found(CASE_1, 0.02, 1, said.append).begin(crew)
    assert said == [
        "the drive as its file has it, in the basis of the file: it could not be computed (it does not converge)"
    ]
    assert ("case", 0) in crew.added


def test_what_follows_in_torsion_has_the_modes_that_its_tongues_needed():
    text = (DRIVES / "gearbox_table_7_1.yaml").read_text(encoding="utf-8")
    file = parse_drive(text + NARROW)
    long = replace(file, torsional=HeavyShafts(file.torsional, 0.0, 1.5, modes=(0, 14)))
    for each, modes in ((long, (0, 28)), (file, None)):
        work, crew = _Found(each, 0.02, 1, lambda words: None), Recorder()
        own, other, *_ = work.torsion
        found = replace(each.torsional, modes=modes) if modes else each.torsional
        work.take(crew, ("torsion", other), SettledTorsion(found, each.requirements.speeds, (), settled=True))
        assert crew.added == {}
        work.take(crew, ("torsion", own), SettledTorsion(found, each.requirements.speeds, (), settled=True))
        assert crew.added["response", ""] == (each, found)
        assert crew.added["worst", TORSION][1] == found


@pytest.mark.slow
@pytest.mark.takes(40)
def test_models_are_those_of_the_report_and_of_single_searches(tmp_path):
    text = (DRIVES / "gearbox_table_7_1.yaml").read_text(encoding="utf-8")
    text = text.replace("lowest_speed_rpm: 100", "lowest_speed_rpm: 625").replace(
        "highest_speed_rpm: 1000", "highest_speed_rpm: 660"
    )
    file = parse_drive(text + NARROW)
    said = []
    found = assess(file, most_steps=2, jobs=2, tell=said.append)
    own = [o for o in found.outcomes if o.variant.teeth == RIGID]
    for outcome_, case in zip(own, cases(file, most_steps=2, jobs=2), strict=True):
        assert (outcome_.variant.contact, outcome_.variant.force) == (case.contact, FORCES[case.following])
        assert [t.label for t in outcome_.tongues] == [t.label for t in case.found.tongues]
        np.testing.assert_allclose(
            [t.upper for t in outcome_.tongues], [t.upper for t in case.found.tongues], rtol=1e-8
        )
    assert len(found.outcomes) == 4 * 6
    last = found.outcomes[-1]
    alone = tongues(last.variant.model, file.requirements.speeds)
    np.testing.assert_allclose([t.upper for t in last.tongues], [t.upper for t in alone], rtol=1e-8)
    # The principal tongue of Fig. 7.12(a) lies in the range; the conjugate arm has none.
    assert len(found.torsion) == 4
    printed = found.torsion["Tregold, arm as printed"].tongues
    assert [t.label for t in printed] == ["(1+1)/1"]
    assert printed[0].lower == pytest.approx(
        tongues(file.torsional, file.requirements.speeds)[0].lower, rel=1e-9
    )
    # The stiffness of the file is that of the teeth in torsion too.
    assert set(found.worst) == {FOLLOWER, DEAD, TORSION}
    assert said[0].startswith("the drive as its file has it, in the basis of the file: unstable at ")
    assert len(said) == 1 + 4 + 20
    # What each shakes the disk with, of the file's own contact, or why nothing.
    assert len(found.disk_responses) == 2 * 6
    assert all(each.data is not None or each.reason for each in found.disk_responses)
    page = write_assessment(found, tmp_path).read_text(encoding="utf-8")
    assert "Depends on" in page or "under all" in page


def test_of_play_and_a_damaged_tooth_it_says_who_has_them():
    file = read_drive_file(DRIVES / "gearbox_table_7_1.yaml")
    words = assessment(
        outcome("Tregold", DEAD, RIGID), file=replace(file, play=None, cracked=None)
    ).not_varied
    assert "facegear report" not in words
    both = replace(file, play=object(), cracked=object())
    words = assessment(outcome("Tregold", DEAD, RIGID), file=both).not_varied
    assert "in their play and the damaged tooth see `facegear report`" in words


def test_what_is_at_work_is_told_in_words():
    said = []
    found = _Found(CASE_1, 0.02, 1, said.append)
    found.at_work([("case", 0), ("torsion", "Tregold, arm as printed"), ("worst", TORSION), ("disk", (0, 0))])
    assert said == [
        f"at work: {found.cases[0].name}; torsion, Tregold, arm as printed; values in tolerances, torsion; "
        "dynamic load of the disk"
    ]
