"""Maps over any number of a drive file, in the file's units."""

import numpy as np
import pytest

from facegear.drives.drive_file import parse_drive
from facegear.drives.examples import example_text
from facegear.drives.sweeps import models, sweep, sweepable
from facegear.drives.verdict import driven
from facegear.floquet.models import replace_parameter
from facegear.floquet.multipliers import growth_rate
from facegear.support.parameters import rad_per_s

CASE_1 = parse_drive(example_text("case_1"))
BOX = parse_drive(example_text("gearbox_table_7_1"))
FEW = {"cells": 3, "speeds_rpm": (400.0, 600.0)}


@pytest.mark.parametrize(
    ("key", "low", "high", "parameter", "unit"),
    [
        ("stiffness", 0.2, 0.8, "stiffness", 1.0),
        ("damping_us", 1.0, 9.0, "load.damping", 1e-6),
        ("bore_radius_mm", 40.0, 60.0, "bore_radius", 1e-3),
        ("power_kW", 100.0, 300.0, "power", 1e3),
        ("youngs_modulus_GPa", 150.0, 210.0, "youngs_modulus", 1e9),
    ],
)
def test_each_row_is_the_drive_with_that_value_in_the_files_unit(key, low, high, parameter, unit):
    found = sweep(CASE_1, key, lowest=low, highest=high, contact="geometric", following="dead", **FEW)
    assert found.values == pytest.approx([low, (low + high) / 2, high])
    model = driven(CASE_1, "dead", CASE_1.contacts["true sweep"])
    expected = [
        [
            growth_rate(replace_parameter(model, parameter, value * unit).system(float(rad_per_s(v))))
            for v in (400.0, 500.0, 600.0)
        ]
        for value in (low, (low + high) / 2, high)
    ]
    np.testing.assert_allclose(found.chart["growth_rate"], expected, rtol=1e-5, atol=1e-3)


def test_a_key_of_the_gearbox_is_swept_in_torsion():
    key = "output_stiffness_Nm_per_rad"
    found = sweep(BOX, key, lowest=1e7, highest=2e7, **FEW)
    model = replace_parameter(BOX.torsional, "output_stiffness", 2e7)
    rate = growth_rate(model.system(float(rad_per_s(600.0))))
    assert found.chart["growth_rate"].values[2, 2] == pytest.approx(rate, rel=1e-5, abs=1e-3)
    keys = sweepable(models(BOX, "", "follower"))
    assert not [name for name in keys if name.endswith("damping_us") and name != "damping_us"]
    assert key not in sweepable(models(CASE_1, "", "follower"))


def test_half_and_one_and_a_half_times_the_own_value_if_nothing_is_said():
    found = sweep(CASE_1, "thickness_ratio", **FEW)
    assert found.values == pytest.approx([0.015, 0.03, 0.045])
    assert found.own == pytest.approx(0.03)


def test_nothing_of_a_number_that_may_be_zero_is_swept_too():
    found = sweep(CASE_1, "damping_us", lowest=0.0, highest=6.0, cells=2, speeds_rpm=(500.0, 600.0))
    assert found.values.tolist() == pytest.approx([0.0, 6.0])
    with pytest.raises(ValueError, match=r"be a number from .* for thickness_ratio, got 0 to"):
        sweep(CASE_1, "thickness_ratio", lowest=0.0, highest=0.1)


@pytest.mark.parametrize(
    ("example", "old", "new", "key", "told"),
    [
        ("case_1", "damping_us: 3", "damping_us: 0", "damping_us", r"damping_us = 0 µs: "),
        ("both_faces", "clocking: 0.5", "clocking: -0.5", "clocking", r"clocking = -0.5: "),
    ],
)
def test_where_half_and_one_and_a_half_times_are_no_range_it_is_asked_for(example, old, new, key, told):
    """Zero was swept "from 0.001 to 0", two values that nobody gave."""
    text = example_text(example)
    assert text.count(old) == 1
    file = parse_drive(text.replace(old, new))
    with pytest.raises(ValueError, match=f"^--from and --to must be given for {told}"):
        sweep(file, key, **FEW)
    with pytest.raises(ValueError, match=f"^--to must be given for {told}"):
        sweep(file, key, lowest=0.0, **FEW)


def test_half_of_zero_is_zero_where_that_is_valid():
    file = parse_drive(example_text("case_1").replace("damping_us: 3", "damping_us: 0"))
    found = sweep(file, "damping_us", highest=6.0, cells=2, speeds_rpm=(500.0, 600.0))
    assert found.values.tolist() == pytest.approx([0.0, 6.0])


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"key": "nosuch"}, r"parameter must be one of module_mm, .*stiffness.*, got 'nosuch'"),
        ({"key": "input_stiffness_Nm_per_rad"}, "parameter must be one of"),
        ({"lowest": 2.0, "highest": 1.0}, "from and to must ascend"),
        ({"lowest": -1.0}, "from and to must ascend and be 0, or a number from 1e-06 to 1000 for stiffness"),
        ({"speeds_rpm": (500.0, 400.0)}, "speeds must be greater than 0 and ascend, got 500 to 400"),
        # Zero is valid, and so is 1e-6: what lies between is not.
        ({"lowest": 0.0, "highest": 1e-7}, "must .* be 0, or a number from 1e-06 to 1000 .*, got 0 to 1e-07"),
        (
            {"speeds_rpm": (1.0, 1e5)},
            "face gear must be greater than 0 and at most 41589.6 rpm, got 100000 rpm",
        ),
        (
            {"key": "yield_strength_MPa"},
            "parameter must be one that changes stability, got 'yield_strength_MPa'",
        ),
        ({"contact": "loaded"}, "contact must be tregold or geometric for these teeth, got 'loaded'"),
        ({"cells": 1}, "cells must be an integer from 2 to 1000, got 1"),
        ({"cells": 100_000}, "cells must be an integer from 2 to 1000, got 100000"),
    ],
)
def test_what_cannot_be_swept(changes, told):
    with pytest.raises(ValueError, match=told):
        sweep(CASE_1, **({"key": "stiffness"} | changes))


def test_tolerances_are_no_numbers_of_a_model():
    """`stiffness_percent` swept the bearing stiffness: 5 % was μ = 0.05."""
    file = parse_drive(example_text("case_1"))
    for key in ("stiffness_percent", "damping_percent", "speed_percent"):
        with pytest.raises(ValueError, match=key):
            sweep(file, key, lowest=5.0, highest=15.0, cells=2)


def test_a_gearbox_has_the_contact_that_is_asked_for():
    """At 678 rpm it is unstable with Tregold's contact ratio and not with that of the true sweep."""
    file = parse_drive(example_text("gearbox_table_7_1"))
    found = {}
    for contact in ("tregold", "geometric"):
        chart = sweep(
            file,
            "input_stiffness_Nm_per_rad",
            lowest=1e5,
            highest=2e5,
            speeds_rpm=(670.0, 680.0),
            cells=2,
            contact=contact,
        ).chart
        found[contact] = chart.growth_rate.values
    assert not np.allclose(found["tregold"], found["geometric"])


def test_a_phase_is_swept_although_it_is_the_same_at_both_ends():
    file = parse_drive(example_text("both_faces"))
    found = sweep(file, "clocking", lowest=-0.5, highest=0.5, cells=3, speeds_rpm=(500.0, 600.0))
    growth = found.chart["growth_rate"].values
    np.testing.assert_allclose(growth[0], growth[-1], rtol=1e-6, atol=1e-6)
    assert np.abs(growth[1] - growth[0]).max() > 1e-3


@pytest.mark.parametrize(
    ("example", "key", "lowest", "highest", "told"),
    [
        (
            "two_gears",
            "shaft_angle_deg",
            80.0,
            100.0,
            r"gears.shaft_angle_deg must be a right angle, .* got 80°$",
        ),
        (
            "both_faces",
            "pressure_angle_deg",
            14.5,
            30.0,
            r"gears.pinion_teeth = 26 is too few for a model that foll",
        ),
        ("both_faces", "tooth_damping_us", 0.0, 3.0, r"teeth.tooth_damping_us must be greater than 0"),
        (
            "case_1",
            "pressure_angle_deg",
            20.0,
            30.0,
            r"gears.pinion_teeth=26 is too few.* take at least 38 teeth",
        ),
    ],
)
def test_what_a_model_refuses_is_told_in_words_of_the_file(example, key, lowest, highest, told):
    with pytest.raises(ValueError, match=told):
        sweep(parse_drive(example_text(example)), key, lowest=lowest, highest=highest, cells=2)
