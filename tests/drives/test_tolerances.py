"""Tolerances of a drive: factors on the right parameters, borders against values drawn at random."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from facegear.drives import basis
from facegear.drives.drive_file import DriveFileError, parse_drive, read_drive_file
from facegear.drives.intervals import united
from facegear.drives.tolerances import Toleranced, TolerancedGearbox, Tolerances
from facegear.drives.verdict import driven
from facegear.drives.worst_case import worst_case, worst_case_in_torsion
from facegear.floquet.multipliers import growth_rate
from facegear.geometry.drive import Drive
from facegear.maps.tracing import searched, tongues
from facegear.mechanics.heavy_shafts import HeavyShafts
from facegear.mechanics.torsional import Gearbox, Torsional
from facegear.support.parameters import rad_per_s

DRIVES = Path(__file__).resolve().parents[2] / "data" / "drives"
CASE_1 = read_drive_file(DRIVES / "case_1.yaml")
GEARBOX = read_drive_file(DRIVES / "gearbox_table_7_1.yaml")
SHAFTS = ("input", "output")
BOTH = read_drive_file(DRIVES / "both_faces.yaml")
TREGOLD = driven(CASE_1, "dead", CASE_1.contacts["Tregold"])
SWEEP = driven(CASE_1, "dead", CASE_1.contacts["true sweep"])
RANGE = (float(rad_per_s(570.0)), float(rad_per_s(605.0)))


def test_more_stiffness_leaves_damping_as_it_is_and_the_other_way_round():
    stiff, damped = Toleranced(TREGOLD, stiffness_factor=1.2), Toleranced(TREGOLD, damping_factor=1.5)
    one, other, third = (model.system(60.0) for model in (TREGOLD, stiff, damped))
    (load,), (stiffer,), (more,) = one.loads, other.loads, third.loads
    assert (stiffer.stiffness, stiffer.damping) == pytest.approx(
        (1.2 * load.stiffness, load.damping), rel=1e-12
    )
    assert (more.stiffness, more.damping) == pytest.approx((load.stiffness, 1.5 * load.damping), rel=1e-12)
    np.testing.assert_allclose(other.stiffness, one.stiffness, rtol=1e-12)
    # The disk's viscous damping, beside what its rotation adds, which no tolerance changes.
    viscous = np.diag(one.damping)
    np.testing.assert_allclose(np.diag(third.damping), 1.5 * viscous, rtol=1e-9)


def test_springs_of_teeth_change_with_those_of_bearings():
    own = BOTH.transverse
    changed = Toleranced(own, 1.1, 0.8).changed
    assert changed.mesh_stiffness == pytest.approx(1.1 * own.mesh_stiffness, rel=1e-15)
    assert changed.mesh_damping * changed.mesh_stiffness == pytest.approx(
        0.8 * own.mesh_damping * own.mesh_stiffness, rel=1e-12
    )
    assert changed.gear.body.material.viscous_loss_factor == pytest.approx(
        0.8 * own.gear.body.material.viscous_loss_factor, rel=1e-15
    )


def test_without_tolerances_the_drive_is_as_it_is():
    found = worst_case(TREGOLD, RANGE, Tolerances())
    assert list(found.points) == [(1.0, 1.0)]
    own = tongues(TREGOLD, RANGE)
    expected = united([(tongue.lower, tongue.upper) for tongue in own])
    np.testing.assert_allclose(found.swept, expected, rtol=1e-9)


def test_values_drawn_at_random_are_unstable_only_where_borders_say():
    tolerances = Tolerances(stiffness=0.1, damping=0.3)
    found = worst_case(TREGOLD, RANGE, tolerances)
    own = sum(tongue.width for tongue in tongues(TREGOLD, RANGE)) / (RANGE[1] - RANGE[0])
    assert found.share > 1.05 * own
    for stiffness, damping in np.random.default_rng(3).uniform([0.9, 0.7], [1.1, 1.3], (4, 2)):
        for tongue in tongues(Toleranced(TREGOLD, float(stiffness), float(damping)), RANGE):
            assert any(
                low - 1e-9 <= tongue.lower and tongue.upper <= high + 1e-9 for low, high in found.swept
            )


def test_speeds_beyond_the_range_are_looked_at():
    found = worst_case(TREGOLD, RANGE, Tolerances(speed=0.05))
    assert found.speeds == pytest.approx((0.95 * RANGE[0], 1.05 * RANGE[1]), rel=1e-12)


def test_a_drive_that_stays_stable():
    narrow = (float(rad_per_s(540.0)), float(rad_per_s(545.0)))
    found = worst_case(SWEEP, narrow, Tolerances(stiffness=0.02))
    assert (found.is_stable, found.swept, found.possible, found.share) == (True, (), (), 0.0)


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ("stiffness_percent: 0.01", r"tolerances.stiffness_percent must lie in .0.1, 50. in %, got 0.01"),
        ("damping_percent: 90", r"tolerances.damping_percent must .*got 90"),
        ("speed_percent: ten", r"tolerances.speed_percent must be .*got 'ten'"),
    ],
)
def test_keys_of_a_file(keys, message):
    text = (DRIVES / "case_1.yaml").read_text(encoding="utf-8")
    with pytest.raises(DriveFileError, match=message):
        parse_drive(f"{text}\ntolerances:\n  {keys}\n")


def test_a_file_gives_parts_of_one():
    text = (DRIVES / "case_1.yaml").read_text(encoding="utf-8")
    found = parse_drive(f"{text}\ntolerances:\n  stiffness_percent: 10\n  speed_percent: 2\n").tolerances
    assert found == Tolerances(stiffness=0.1, speed=0.02)
    assert not parse_drive(text).tolerances.given


def test_a_speed_beyond_what_the_rim_bears_is_refused():
    text = (DRIVES / "case_1.yaml").read_text(encoding="utf-8")
    text = text.replace("highest_speed_rpm: 1000", "highest_speed_rpm: 41000")
    text = text.replace("lowest_speed_rpm: 100", "lowest_speed_rpm: 5000")
    limit = pytest.raises(
        DriveFileError, match=r"tolerances.speed_percent must be at most .* for this body.*got 50"
    )
    with limit:
        parse_drive(f"{text}\ntolerances:\n  speed_percent: 50\n")


def test_more_stiffness_of_shafts_leaves_their_damping_and_the_mesh_as_they_are():
    own = GEARBOX.torsional
    one = own.system(60.0)
    stiff = TolerancedGearbox(own, shaft_stiffness_factor=1.2).system(60.0)
    damped = TolerancedGearbox(own, shaft_damping_factor=1.5).system(60.0)
    teeth = TolerancedGearbox(own, mesh_stiffness_factor=0.8, mesh_damping_factor=1.1).system(60.0)
    # Outside the mesh's loads both matrices are those of the shafts alone (7-12, 7-13).
    assert_allclose(stiff.stiffness, 1.2 * one.stiffness, rtol=1e-14)
    assert_allclose(stiff.damping, one.damping, rtol=1e-14)
    assert_allclose(damped.stiffness, one.stiffness, rtol=1e-14)
    assert_allclose(damped.damping, 1.5 * one.damping, rtol=1e-14)
    for load, of_stiff, of_teeth in zip(one.loads, stiff.loads, teeth.loads, strict=True):
        assert (of_stiff.stiffness, of_stiff.damping) == (load.stiffness, load.damping)
        assert (of_teeth.stiffness, of_teeth.damping) == pytest.approx(
            (0.8 * load.stiffness, 1.1 * load.damping), rel=1e-14
        )


def test_a_stiffer_shaft_of_the_same_length_is_heavier_in_proportion():
    heavy = HeavyShafts(GEARBOX.torsional, input_length=0.1, output_length=0.2)
    stiffer = TolerancedGearbox(heavy, shaft_stiffness_factor=1.3)
    bodies = np.diag([*np.diag(GEARBOX.torsional.system(60.0).mass), 0.0, 0.0, 0.0, 0.0])
    own, changed = (model.system(60.0).mass - bodies for model in (heavy, stiffer))
    assert_allclose(changed, 1.3 * own, rtol=1e-9, atol=1e-12 * np.abs(own).max())
    assert [c.name for c in stiffer.coordinates] == [c.name for c in heavy.coordinates]


def test_shafts_drawn_at_random_are_unstable_only_where_borders_say():
    """The largest tongue of Fig. 7.12(a), within ten per cent of the shafts' stiffness and thirty of their damping."""
    tolerances = Tolerances(stiffness=0.05, shaft_stiffness=0.1, shaft_damping=0.3)
    speeds = (float(rad_per_s(560.0)), float(rad_per_s(760.0)))
    found = worst_case_in_torsion(GEARBOX.torsional, speeds, tolerances)
    assert found.factors == ("mesh stiffness", "mesh damping", "shaft stiffness", "shaft damping")
    assert len(found.points) >= 19
    own = sum(tongue.width for tongue in tongues(GEARBOX.torsional, speeds)) / (speeds[1] - speeds[0])
    assert found.share > 1.05 * own > 0.0
    drawn = np.random.default_rng(5).uniform([0.95, 0.9, 0.7], [1.05, 1.1, 1.3], (6, 3))
    for mesh, stiffness, damping in drawn.tolist():
        box = GEARBOX.torsional.gearbox
        other = replace(
            box,
            mesh_stiffness=mesh * box.mesh_stiffness,
            **{f"{shaft}_stiffness": stiffness * getattr(box, f"{shaft}_stiffness") for shaft in SHAFTS},
            **{f"{shaft}_damping": damping * getattr(box, f"{shaft}_damping") for shaft in SHAFTS},
        )
        for tongue in tongues(replace(GEARBOX.torsional, gearbox=other), speeds):
            assert any(
                low - 1e-9 <= tongue.lower and tongue.upper <= high + 1e-9 for low, high in found.swept
            )


@pytest.mark.parametrize(("low_rpm", "high_rpm"), [(301.0, 302.5), (155.5, 157.0)])
def test_a_tongue_that_crosses_a_narrow_range_between_the_values_looked_at_is_not_missed(low_rpm, high_rpm):
    """Nothing is unstable there at 0.7, 0.85, 1, 1.15 and 1.3 times the stiffness of the shafts, and yet between."""
    speeds = (float(rad_per_s(low_rpm)), float(rad_per_s(high_rpm)))
    found = worst_case_in_torsion(GEARBOX.torsional, speeds, Tolerances(shaft_stiffness=0.3))

    def at(factor):
        return tongues(TolerancedGearbox(GEARBOX.torsional, shaft_stiffness_factor=factor), speeds)

    assert not any(at(factor) for factor in (0.7, 0.85, 1.0, 1.15, 1.3))
    between = [tongue for factor in np.linspace(0.7, 1.0, 16) for tongue in at(float(factor))]
    assert between
    assert found.swept
    for tongue in between:
        assert any(low - 1e-9 <= tongue.lower and tongue.upper <= high + 1e-9 for low, high in found.possible)


def test_a_tongue_that_stands_nowhere_but_inside_the_range_of_stiffness_is_found():
    """Long and heavy shafts: between 1.18 and 1.27 times the stiffness of the teeth (7-1)/3 stands there, tuned."""
    gearbox = Gearbox(
        Drive(26, 80, 3.175e-3, pressure_angle=math.radians(25.0)),
        pinion_inertia=0.002,
        gear_inertia=0.2,
        load_inertia=2.0,
        mesh_stiffness=2.1164e8,
        mesh_damping=1200.0,
        input_stiffness=2e4,
        input_damping=0.12,
        output_stiffness=2e5,
        output_damping=1.2,
    )
    model = HeavyShafts(Torsional(gearbox), input_length=1.5, output_length=2.0)
    speeds = (float(rad_per_s(705.0)), float(rad_per_s(708.0)))
    for factor in (0.6, 1.0, 1.4):
        assert not tongues(TolerancedGearbox(model, factor), speeds)
    found = worst_case_in_torsion(model, speeds, Tolerances(stiffness=0.4))
    assert found.share == pytest.approx(1.0, abs=1e-12)
    assert found.fastest[0][0] == pytest.approx(1.2, abs=0.05)
    # What stands at a value is told of the speeds that were looked at there.
    assert found.looked_at.keys() == found.points.keys()
    for factors, parts in found.looked_at.items():
        assert all(
            any(low <= t.lower and t.upper <= high for low, high in parts) for t in found.points[factors]
        )
    (tongue,) = tongues(TolerancedGearbox(model, 1.21), speeds)
    assert found.fastest[1].growth_rate > 0.7 * tongue.growth_rate > 0.03


def test_a_value_at_which_multipliers_are_known_less_well_does_not_leave_all_unknown(monkeypatch):
    speeds = (float(rad_per_s(560.0)), float(rad_per_s(760.0)))
    thresholds = []

    def roughly(model, around, *, threshold=1e-8, **rest):
        thresholds.append(threshold)
        if threshold < 5e-8 and model.shaft_stiffness_factor > 1.0:
            raise ArithmeticError("multipliers are known to 5e-08 only")
        return searched(model, around, threshold=threshold, **rest)

    monkeypatch.setattr(basis, "searched", roughly)
    found = worst_case_in_torsion(GEARBOX.torsional, speeds, Tolerances(shaft_stiffness=0.1))
    monkeypatch.undo()
    # With all of the damping and with half of it.
    assert thresholds.count(1e-7) == 2
    expected = worst_case_in_torsion(GEARBOX.torsional, speeds, Tolerances(shaft_stiffness=0.1))
    assert_allclose(found.swept, expected.swept, rtol=1e-6)


def test_of_a_tongue_that_reaches_into_the_range_the_growth_there_is_told():
    speeds = (float(rad_per_s(670.0)), float(rad_per_s(700.0)))
    found = worst_case_in_torsion(GEARBOX.torsional, speeds, Tolerances(shaft_stiffness=0.01))
    (tongue,) = found.points[(1.0,) * 4]
    assert tongue.lower == tongue.peak == pytest.approx(speeds[0], rel=1e-12)
    assert tongue.growth_rate == pytest.approx(growth_rate(GEARBOX.torsional.system(speeds[0])), rel=1e-9)
    assert found.fastest[1].growth_rate >= tongue.growth_rate


def test_a_file_gives_tolerances_of_shafts_where_it_has_some():
    text = (DRIVES / "gearbox_table_7_1.yaml").read_text(encoding="utf-8")
    given = "\ntolerances:\n  shaft_stiffness_percent: 10\n  shaft_damping_percent: 20\n"
    found = parse_drive(text + given).tolerances
    assert found == Tolerances(shaft_stiffness=0.1, shaft_damping=0.2)
    assert (found.given, found.given_in_torsion) == (False, True)
    without = (DRIVES / "case_1.yaml").read_text(encoding="utf-8")
    with pytest.raises(
        DriveFileError,
        match=r"^[^:]*: tolerances.shaft_stiffness_percent must be 0 or left out without a section gearbox.*got 10$",
    ):
        parse_drive(without + given)


def test_a_contact_under_load_is_that_of_a_file_with_stiffer_teeth():
    """The corner at 1.1 is the drive whose file says 1.1 times c_f, up to 1, where bodies give way no more."""
    text = (DRIVES / "localized.yaml").read_text(encoding="utf-8")

    def drive(factor):
        return parse_drive(
            f"{text}\nteeth:\n  tooth_damping_us: 30\n  correction_factor: {factor}\n"
        ).transverse

    own, stiffer = drive(0.5), drive(0.55)
    changed = Toleranced(own, stiffness_factor=1.1).changed
    assert changed.gear.contact.path.correction_factor == pytest.approx(0.55, rel=1e-14)
    assert changed.mesh_stiffness == pytest.approx(stiffer.mesh_stiffness, rel=1e-12)
    at = np.linspace(0.0, 1.0, 101)[:-1] + 0.003
    places, expected, before = (
        np.array([load.shape(at) for load in model.system(50.0).loads]) for model in (changed, stiffer, own)
    )
    size = np.abs(expected).max()
    assert_allclose(places, expected, atol=1e-9 * size)
    assert np.abs(before - expected).max() > 1e-4 * size
    assert Toleranced(drive(0.8), stiffness_factor=1.5).changed.gear.contact.path.correction_factor == 1.0
    # What does not depend on the stiffness of teeth stays.
    assert Toleranced(TREGOLD, stiffness_factor=1.1).changed.gear.contact == TREGOLD.gear.contact


def test_a_contact_under_load_changes_with_the_mesh_of_a_gearbox():
    text = (DRIVES / "gearbox_table_7_1.yaml").read_text(encoding="utf-8")
    loaded = parse_drive(text.replace("pinion_teeth: 31", "pinion_teeth: 31\n  shaper_teeth: 33")).torsional
    own = loaded.contact.path.correction_factor
    changed = TolerancedGearbox(loaded, mesh_stiffness_factor=1.1).changed
    assert changed.contact.path.correction_factor == pytest.approx(1.1 * own, rel=1e-14)
    assert changed.gearbox.mesh_stiffness == pytest.approx(
        1.1 * loaded.gearbox.in_si.mesh_stiffness, rel=1e-14
    )
    heavy = TolerancedGearbox(
        HeavyShafts(loaded, input_length=0.1, output_length=0.1), mesh_stiffness_factor=0.8
    ).changed
    assert heavy.torsional.contact.path.correction_factor == pytest.approx(0.8 * own, rel=1e-14)
