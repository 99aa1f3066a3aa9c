"""Arrays and tables of the report on a drive."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from facegear.design.changes import effects_of_changes
from facegear.design.envelope import mode_critical_powers
from facegear.design.teeth import root_stress
from facegear.drives import report
from facegear.drives.basis import BasisStep, SettledTongues
from facegear.drives.drive_file import read_drive_file
from facegear.drives.verdict import Case, driven
from facegear.maps.tracing import tongues
from facegear.mechanics.mode_shapes import plate_modes
from facegear.mechanics.spread_force import PitchPoint, RimPoint
from facegear.support.parameters import rad_per_s, rpm

DRIVES = Path(__file__).resolve().parents[2] / "data" / "drives"
CASE_1 = read_drive_file(DRIVES / "case_1.yaml")
TWO_GEARS = read_drive_file(DRIVES / "two_gears.yaml")
EXAMPLE_B = read_drive_file(DRIVES / "example_b.yaml")
BOX = read_drive_file(DRIVES / "gearbox_table_7_1.yaml")
RANGE = (float(rad_per_s(500.0)), float(rad_per_s(720.0)))
FOUND = tongues(CASE_1.transverse, RANGE)


def values(rows):
    return {row.quantity: row.value for row in rows}


def test_geometry_has_the_printed_numbers():
    found = values(report.geometry(CASE_1))
    assert found["outer radius of the teeth R2"] == pytest.approx(231.94, abs=5e-3)
    assert found["contact ratio, Tregold"] == pytest.approx(1.5532, abs=5e-5)
    assert found["gear ratio N2/N1"] == 5.0
    assert found["thickness of the body"] == pytest.approx(0.03 * found["outer radius of the teeth R2"])
    assert found["bearing stiffness"] == found["stiffness of the disk that bearings are measured by"]


def test_strength_follows_duty_and_material():
    found = values(report.strength(CASE_1))
    assert found["allowable stress"] == pytest.approx(439.9 / 1.5)
    stress = root_stress(CASE_1.drive, 447420.0, rad_per_s(5000.0))
    assert found["largest stress at the root"] == pytest.approx(1e-6 * stress)
    assert found["allowable over largest stress"] == pytest.approx(439.9e6 / 1.5 / stress)


FOLLOWER = "critical power of a pinion, disk alone, force follows the rim"
DEAD = "critical power of a pinion, disk alone, force keeps its direction"
POINTS = {"rim": RimPoint(), "pitch": PitchPoint()}
RATIO = "critical power over power of a pinion, force follows the rim"


@pytest.mark.slow
def test_flutter_needs_damping_to_be_kept_off():
    model, duty = CASE_1.transverse, CASE_1.requirements
    found = values(report.flutter(model, duty))
    assert found["power of a pinion"] == pytest.approx(447.42)
    assert found[RATIO] == pytest.approx(found[FOLLOWER] / 447.42)
    assert found[DEAD] > 10 * found[FOLLOWER]
    # P_c ≈ ξω³/ε: in proportion to the loss factor.
    for factor, expected in ((2.0, 2.0), (0.0, 0.0)):
        loss = factor * model.body.material.viscous_loss_factor
        other = replace(model.body, material=replace(model.body.material, viscous_loss_factor=loss))
        ratio = values(report.flutter(replace(model, body=other), duty))[RATIO]
        assert ratio == pytest.approx(expected * found[RATIO], rel=0.02, abs=1e-12)


@pytest.mark.slow
def test_two_pinions_flutter_at_half_the_power_of_each():
    """The report of a drive with two pinions gave that of one: twice what is right."""
    both, duty = EXAMPLE_B.transverse, EXAMPLE_B.requirements
    alone = values(report.flutter(replace(both, pinion_angles=(0.0,)), duty))
    together = values(report.flutter(both, duty))
    assert together[RATIO] == pytest.approx(alone[RATIO] / 2, rel=0.01)
    # First order, in closed form: the mean shear of p forces is p times that of one.
    first = float(mode_critical_powers(both.body, duty.pinion_speed).min())
    assert together[FOLLOWER] == pytest.approx(1e-3 * first / 2, rel=0.01)


@pytest.mark.slow
def test_a_force_at_the_pitch_circle_flutters_at_the_power_of_its_first_order():
    """In closed form; on the pairs in mesh chapter 8 anchors 1.08 to 1.14 times the power at the rim."""
    contact = CASE_1.contacts["Tregold"]
    found = {}
    for place in ("rim", "pitch", "pairs"):
        model = driven(replace(CASE_1, force_at=place), "follower", contact)
        found[place] = values(report.flutter(model, CASE_1.requirements))[FOLLOWER]
    body, speed = CASE_1.transverse.body, CASE_1.requirements.pinion_speed
    first = {place: mode_critical_powers(body, speed, spread).min() for place, spread in POINTS.items()}
    for place, power in first.items():
        assert found[place] == pytest.approx(1e-3 * power, rel=0.01)
    assert 1.08 < found["pairs"] / found["rim"] < 1.14


def test_between_two_gears_the_one_that_all_meshes_drive_flutters_first():
    """An idler drives the lower gear as an input does, and holds the upper one back."""
    both, duty = TWO_GEARS.transverse, TWO_GEARS.requirements
    lower = values(report.flutter(both.gear, duty))
    found = values(report.flutter(both, duty))
    assert list(found) == [name.replace("a pinion", "a mesh") for name in lower]
    found = dict(zip(lower, found.values(), strict=True))
    assert found[FOLLOWER] == pytest.approx(lower[FOLLOWER], rel=1e-9)
    # Without their mean shear the forces hardly make anything flutter.
    idle = values(report.flutter(replace(both, roles=("input", "output")), duty))
    assert idle[FOLLOWER.replace("a pinion", "a mesh")] > 2.0 * lower[FOLLOWER]


def test_tongues_and_windows_share_out_the_range():
    table = report.tongue_table(FOUND, "case 1")
    windows = report.safe_windows(table, RANGE)
    assert table["label"].values.tolist() == [tongue.label for tongue in FOUND]
    ends = np.sort(np.concatenate([part[side] for part in (table, windows) for side in ("lower", "upper")]))
    assert ends[[0, -1]] == pytest.approx([500.0, 720.0])
    np.testing.assert_allclose(ends[1:-1:2], ends[2:-1:2])
    widths = sum(float((part["upper"] - part["lower"]).sum()) for part in (table, windows))
    assert widths == pytest.approx(220.0)
    assert (windows["upper"] > windows["lower"]).all()


def test_windows_of_a_stable_and_of_an_unstable_range():
    empty = report.tongue_table((), "none")
    (window,) = report.safe_windows(empty, RANGE)["lower"].values
    assert window == pytest.approx(500.0)
    inside = (FOUND[0].lower + 1e-3, FOUND[0].upper - 1e-3)
    assert report.safe_windows(report.tongue_table(tongues(CASE_1.transverse, inside), ""), inside).sizes == {
        "window": 0
    }


def test_combinations_cross_the_mesh_frequency_in_their_tongues():
    speeds = np.linspace(500.0, 720.0, 23)
    chart = report.combinations(CASE_1.transverse, FOUND, speeds, "case 1")
    np.testing.assert_allclose(chart["mesh_frequency"], 130 * speeds / 60, rtol=1e-12)
    assert (np.diff(chart["natural_frequency"], axis=0) >= 0).all()
    for label, line in zip(chart["label"].values, chart["combination"], strict=True):
        (tongue,) = [tongue for tongue in FOUND if tongue.label == label]
        crossing = np.interp(0.0, chart["mesh_frequency"] - line, speeds)
        # The centre of the mean system lies in the tongue or, where the modulation is strong, near it.
        assert rpm(tongue.lower) - 15 < crossing < rpm(tongue.upper) + 15


def test_combinations_of_the_gearbox_has_its_natural_frequencies():
    chart = report.combinations(BOX.torsional, (), [10.0], "box")
    # All dampings are 10 µs times a stiffness: ω √(1 − (10 µs ω/2)²).
    free = BOX.torsional.natural_frequencies()
    damped = free * np.sqrt(1 - (1e-5 * free / 2) ** 2) / (2 * np.pi)
    np.testing.assert_allclose(chart["natural_frequency"][:, 0], damped, rtol=1e-4)
    assert chart.sizes["label"] == 0


def test_map_and_tongues_agree():
    table = report.tongue_table(FOUND, "")
    speeds = np.linspace(505.0, 715.0, 43)
    chart = report.growth_map(CASE_1.transverse, "stiffness", [0.5, 1.0], speeds, "case 1")
    inside = ((speeds[:, None] > table["lower"].values) & (speeds[:, None] < table["upper"].values)).any(
        axis=1
    )
    assert inside.any()
    assert (chart["growth_rate"].sel(stiffness=1.0) > 0).values.tolist() == inside.tolist()
    assert chart.attrs["parameters"] == "case 1, swept = stiffness"


@pytest.mark.slow
@pytest.mark.parametrize("force", ["follower", "dead"])
def test_critical_thickness_parts_stable_from_unstable(force):
    model = driven(CASE_1, force, CASE_1.contacts["Tregold"])
    critical = report.thickness_verdict(model, RANGE).critical.thickness_ratio
    for factor, stable in ((1.004, True), (0.996, False)):
        body = replace(model.body, thickness_ratio=factor * critical)
        assert bool(tongues(replace(model, body=body), RANGE)) != stable


@pytest.mark.slow
def test_flutter_decides_the_thickness_where_the_force_follows():
    """P_c goes with the fourth power of the thickness: ω³ and one more for the mass that the force moves."""
    narrow = (float(rad_per_s(900.0)), float(rad_per_s(905.0)))
    model = driven(CASE_1, "follower", CASE_1.contacts["true sweep"])
    critical = report.thickness_verdict(model, narrow).critical
    ratio = values(report.flutter(model, CASE_1.requirements))[RATIO]
    assert critical.thickness_ratio == pytest.approx(0.03 * ratio**-0.25, rel=0.02)
    assert critical.lobe.label.startswith("mean")


def test_no_critical_thickness_is_told_with_the_reason_in_rpm():
    narrow = (float(rad_per_s(600.0)), float(rad_per_s(601.0)))
    # 0.001 of the thickness up or down: stable there.
    verdict = report.thickness_verdict(CASE_1.transverse, narrow, widest=1.001)
    assert verdict.critical is None
    assert verdict.reason == "stable down to h/a = 0.02997"
    inside = (FOUND[0].lower, FOUND[0].upper)
    verdict = report.thickness_verdict(CASE_1.transverse, inside, widest=1.001)
    assert verdict.critical is None
    assert "still unstable at h/a = 0.03003, at 5" in verdict.reason
    assert verdict.reason.endswith("rpm")


def test_bases_of_all_cases_stand_in_one_table():
    steps = (BasisStep(1, 3, (), np.nan), BasisStep(2, 5, FOUND, 0.25))
    found = SettledTongues(CASE_1.transverse, RANGE, steps, settled=False)
    table = report.basis_table([Case("Tregold", "dead", found, 0.0)], "case 1")
    assert table["case_name"].values.tolist() == ["Tregold, force keeps its direction"] * 2
    assert table["unstable_share"].values == pytest.approx([0.0, found.unstable_share])
    assert report.basis_columns(table)["nodal_diameters"] == [3, 5]


def test_columns_of_tables():
    table = report.tongue_table(FOUND, "")
    empty = report.tongue_table((), "")
    columns = report.tongue_columns({"a": table, "none": empty, "b": table})
    assert columns["model"] == ["a"] * len(FOUND) + ["b"] * len(FOUND)
    assert columns["lower_rpm"] == 2 * table["lower"].values.tolist()
    windows = report.safe_windows(empty, RANGE)
    assert report.window_columns({"a": windows})["upper_rpm"] == pytest.approx([720.0])
    modes = plate_modes(CASE_1.transverse.body, 3)
    columns = report.frequency_columns(modes)
    assert len(columns["frequency_Hz"]) == 8
    assert columns["nodal_diameters"][:5] == [0, 1, 2, 3, 0]
    assert columns["nodal_circles"][3:5] == [0, 1]
    none = effects_of_changes(CASE_1.transverse, (), RANGE, "")
    assert report.change_columns({"a": none})["change"] == []
    rows = report.summary_columns(report.strength(CASE_1))
    assert rows["unit"] == ["mm", "MPa", "MPa", "1"]


def test_provenance_tells_drives_apart():
    assert report.describe(CASE_1) != report.describe(BOX)
    assert isinstance(report.tongue_table(FOUND, "x"), xr.Dataset)
