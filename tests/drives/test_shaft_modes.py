"""Modes of shafts with mass: enough for the mesh, checked by half of them, said where they do not suffice."""

import math
from dataclasses import replace

import numpy as np
import pytest
import yaml
from scipy.linalg import eigh

import facegear as fg
from facegear.drives import sections, shaft_modes
from facegear.drives.drive_file import parse_drive
from facegear.drives.findings import Findings
from facegear.drives.shaft_modes import confirmed, natural_frequencies, settled_torsion, with_enough_modes
from facegear.floquet.labels import Combination
from facegear.maps.tracing import Searched, Tongue
from facegear.mechanics.rods import shear_modulus
from facegear.support.parameters import rad_per_s
from tests.drives.drive_files import GEARBOX
from tests.independent.shafts_by_elements import gearbox, growth_rate
from tests.independent.torsional_switching import numbers_of

LONG = """
name: long shafts
gears: {pinion_teeth: 31, gear_teeth: 107, module_mm: 3.175}
body: {thickness_ratio: 0.1, bore_radius_mm: 80, nodal_diameters: 1, nodal_circles: 0}
pinions: {stiffness: 0.3, damping_us: 10, mass: 1.0}
operation: {lowest_speed_rpm: 1081, highest_speed_rpm: 1088, power_kW: 60, pinion_speed_rpm: 1600}
gearbox:
  pinion_inertia_kg_m2: 0.001636931483
  gear_inertia_kg_m2: 0.1505519991
  load_inertia_kg_m2: 0.165607199
  mesh_stiffness_N_per_m: 157629095.3
  mesh_damping_us: 2
  input_stiffness_Nm_per_rad: 1000000.0
  input_damping_us: 1
  output_stiffness_Nm_per_rad: 5000000.0
  output_damping_us: 1
  input_length_mm: 1500
  output_length_mm: 1500
"""
FILE = parse_drive(LONG)
SPEEDS = FILE.requirements.speeds
FEW = replace(FILE.torsional, modes=2)


def tongue(low, high, growth=1.0):
    lower, upper = (float(rad_per_s(x)) for x in (low, high))
    return Tongue(lower, upper, (lower + upper) / 2, growth, Combination(1, 2, "sum", 1))


def elements(count):
    model = FILE.torsional
    sizes = (model.input_length, model.output_length, shear_modulus(model.material), model.material.density)
    return gearbox(numbers_of(model.torsional), *sizes, (count, count))


def test_growth_of_a_file_is_that_of_many_elements_by_dop853():
    truth = growth_rate(numbers_of(FILE.torsional.torsional), elements(10), 1085.0, rtol=1e-9)
    assert truth > 9.0
    assert fg.growth_rate(FILE.torsional.system(float(rad_per_s(1085.0)))) == pytest.approx(truth, rel=0.02)


def test_unstable_speeds_do_not_depend_on_modes_left_out():
    found = settled_torsion(FILE.torsional, SPEEDS)
    assert found.settled
    ((lower, upper),) = [(each.lower, each.upper) for each in found.tongues]
    assert (lower, upper) == SPEEDS
    assert found.growth_moved < 0.1
    assert (
        "14 modes of the input shaft, 14 modes of the output shaft; half as many differ at 0 %" in found.basis
    )


@pytest.mark.parametrize(
    ("lengths", "fastest_rpm", "modes"),
    [
        ((0.3, 0.25), 1088.0, (2, 2)),
        ((1.5, 0.1), 1088.0, (14, 2)),
        ((1.5, 0.1), 300.0, (4, 1)),
        ((0.0, 20.0), 1088.0, (0, 40)),
    ],
)
def test_a_longer_shaft_and_a_faster_mesh_ask_for_more(lengths, fastest_rpm, modes):
    model = replace(FILE.torsional, input_length=lengths[0], output_length=lengths[1])
    assert with_enough_modes(model, float(rad_per_s(fastest_rpm))).modes == modes


def test_a_file_asks_for_modes_up_to_its_tolerance_of_speed():
    wide = parse_drive(LONG + "tolerances: {speed_percent: 50}\n").torsional
    assert wide.modes == with_enough_modes(FEW, 1.5 * SPEEDS[1]).modes
    assert wide.modes[0] > FILE.torsional.modes[0]


def test_massless_shafts_have_nothing_to_raise():
    file = parse_drive(GEARBOX)
    found = settled_torsion(file.torsional, tuple(rad_per_s([600.0, 700.0]).tolist()))
    assert found.settled
    assert found.tongues
    assert (found.modes, found.basis) == ("", "")


def test_fewer_modes_than_the_mesh_asks_for_are_never_settled():
    assert not settled_torsion(replace(FEW, modes=1), SPEEDS).settled


@pytest.mark.parametrize(
    ("half", "all_of_them", "settled"),
    [
        ((), (), True),
        ((), (tongue(1084, 1084.01),), False),
        ((tongue(1082, 1084),), (tongue(1082, 1084.1),), True),
        ((tongue(1082, 1084),), (tongue(1082, 1084.2),), False),
        # All of the range: a gap may open.
        ((tongue(1060, 1110, 2.0),), (tongue(1060, 1110, 2.1),), True),
        ((tongue(1060, 1110, 2.0),), (tongue(1060, 1110, 2.5),), False),
        # Beside the range: it may come in.
        ((tongue(1060, 1070),), (tongue(1060, 1071),), True),
        ((tongue(1060, 1070),), (tongue(1060, 1076),), False),
        ((tongue(1098, 1100),), (tongue(1092, 1100),), False),
    ],
)
def test_half_of_the_modes_must_come_to_the_same(monkeypatch, half, all_of_them, settled):
    def looked_at(model, speeds, hints=()):
        found = half if model.modes == (7, 7) else all_of_them
        return Searched(found, np.array(hints), np.array([-1.0, -1.0]))

    def cut(model, found, speeds):
        low, high = speeds
        return tuple(
            replace(each, lower=max(each.lower, low), upper=min(each.upper, high))
            for each in found
            if each.lower < high and each.upper > low
        )

    monkeypatch.setattr(shaft_modes, "looked_at", looked_at)
    monkeypatch.setattr(shaft_modes, "within", cut)
    monkeypatch.setattr(shaft_modes, "_MOST_STEPS", 2)
    found = settled_torsion(FILE.torsional, SPEEDS)
    assert found.settled is settled
    assert ("NOT SETTLED" in found.basis) is not settled


@pytest.mark.parametrize(("decay", "settled"), [(-1.3, True), (-0.7, True), (-0.6, False)])
def test_where_nothing_grows_with_half_the_modes_its_decay_must_stand_still_too(monkeypatch, decay, settled):
    def looked_at(model, speeds, hints=()):
        rate = -1.0 if model.modes == (7, 7) else decay
        return Searched((), np.array(hints), np.array([2.0 * rate, rate]))

    monkeypatch.setattr(shaft_modes, "looked_at", looked_at)
    monkeypatch.setattr(shaft_modes, "_MOST_STEPS", 2)
    assert settled_torsion(FILE.torsional, SPEEDS).settled is settled


def test_modes_that_cannot_be_computed_leave_it_open(monkeypatch):
    def looked_at(model, speeds, hints=()):
        if model.modes == (7, 7):
            return Searched((), np.array(hints), np.array([-1.0, -1.0]))
        raise ArithmeticError("multipliers are not known")

    monkeypatch.setattr(shaft_modes, "looked_at", looked_at)
    found = settled_torsion(FILE.torsional, SPEEDS)
    assert not found.settled
    assert "7 modes of the output shaft; half as many could not be compared, NOT SETTLED" in found.basis
    assert math.isnan(found.moved)


def test_digits_told_are_those_of_elements():
    """Rods of one length have frequencies of their own where both ends are held: none of the gearbox is lost there."""
    mass, _, stiffness = elements(40)
    box = FILE.torsional.torsional
    stiffness[:3, :3] += box.mean_stiffness - box.gearbox.in_si.stiffness_matrix
    truth = np.sqrt(eigh(stiffness, mass, eigvals_only=True)[:8]) / (2 * np.pi)
    own, true = (each[:8] / (2 * np.pi) for each in natural_frequencies(FILE.torsional))
    np.testing.assert_allclose(true, truth, rtol=1e-5)
    told = [confirmed(*pair) for pair in zip(own.tolist(), true.tolist(), strict=True)]
    assert told[2:5] == pytest.approx([941.7, 1580.0, 1742.0], abs=1e-9)


def test_a_report_says_what_has_not_settled():
    """Of few modes a tongue is not seen, and none of its words may call the drive stable without saying so."""
    content = yaml.safe_load(LONG)
    content["operation"]["lowest_speed_rpm"] = 1086
    file = parse_drive(yaml.safe_dump(content))
    told = {}
    for name, model in (("enough", file.torsional), ("few", replace(file.torsional, modes=1))):
        page = sections.verdict(Findings(replace(file, torsional=model), cells=2, most_steps=1, jobs=1))
        told[name] = page.as_html()
    assert "NOT SETTLED in torsion: more modes of a shaft may change it." in told["few"]
    assert "NOT SETTLED in torsion" not in told["enough"]
    assert "in torsion unstable at some speeds" in told["enough"]
    assert "Shafts in torsion: 14 modes of the input shaft" in told["enough"]
