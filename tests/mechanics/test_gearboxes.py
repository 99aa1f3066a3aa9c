"""The gearbox of table 7.1 and the captions of chapter 7."""

import math
from dataclasses import replace

import pytest

from facegear.floquet.models import replace_parameter
from facegear.maps.stability_map import stability_map
from facegear.mechanics.contact import SKEW_LINE
from facegear.mechanics.gearboxes import (
    DRIVE,
    FIGURES,
    GEAR_INERTIA_RATIO,
    HIGHEST_SPEED_RPM,
    LOAD_INERTIA_RATIO,
)
from facegear.mechanics.properties import STEEL

# What the captions print, SI: km, k1, k2 and cm/km, c1/k1, c2/k2; None where swept or not given.
CAPTIONS = {
    "7.9a": (1.58e8, 3.15e8, 4.73e8, 5e-6, 5e-6, 5e-6),
    "7.9b": (1.58e8, 3.15e8, 4.73e8, 5e-6, 5e-6, 5e-6),
    "7.10a": (1.58e8, None, 1.58e7, None, None, None),
    "7.10b": (1.58e8, 7.88e7, None, None, None, None),
    "7.11a": (1.58e8, None, 1.58e7, 3e-6, 3e-6, 3e-6),
    "7.11b": (1.58e8, 7.88e7, None, 1e-5, 1e-5, 1e-5),
    "7.12a": (1.58e8, 1.42e6, 1.58e7, 1e-5, None, 1e-5),
    "7.12b": (3.15e7, 3.15e5, 9.46e6, 2e-6, None, 2e-6),
    "7.13a": (1.58e8, 1.58e7, 4.73e6, 1e-5, 1e-5, None),
    "7.13b": (3.15e7, 3.15e5, 9.46e6, 2e-6, 2e-6, None),
}


def matches(value, printed):
    """Whether a value rounds to three printed digits."""
    digit = 10 ** (math.floor(math.log10(printed)) - 2)
    return abs(value - printed) <= 0.5000001 * digit


@pytest.mark.parametrize("name", CAPTIONS)
def test_figures_have_what_captions_print(name):
    box = FIGURES[name].gearbox.in_si
    values = (
        box.mesh_stiffness,
        box.input_stiffness,
        box.output_stiffness,
        box.mesh_damping / box.mesh_stiffness,
        box.input_damping / box.input_stiffness,
        box.output_damping / box.output_stiffness,
    )
    for value, printed in zip(values, CAPTIONS[name], strict=True):
        assert printed is None or matches(value, printed)
    assert matches(box.pinion_inertia, 1.64e-3)


def test_table_7_1():
    assert (DRIVE.pinion_teeth, DRIVE.gear_teeth) == (31, 107)
    assert DRIVE.module == pytest.approx(3.175e-3)
    assert math.degrees(DRIVE.pressure_angle) == pytest.approx(25.0)
    assert math.degrees(DRIVE.shaft_angle) == pytest.approx(90.0)
    assert HIGHEST_SPEED_RPM == 1000.0
    assert (STEEL.density, STEEL.youngs_modulus) == (7840.0, 200e9)


def test_inertias_of_the_captions():
    assert round(GEAR_INERTIA_RATIO, 2) == 91.97
    assert round(LOAD_INERTIA_RATIO, 2) == 101.17
    a, b = FIGURES["7.9a"], FIGURES["7.9b"]
    assert (a.gearbox.load_inertia, b.gearbox.gear_inertia) == (10.0, 100.0)
    assert (a.lowest, a.highest, b.lowest, b.highest) == (1.0, 40.0, 1.0, 40.0)


@pytest.mark.parametrize("name", FIGURES)
def test_every_figure_can_be_swept(name):
    figure = FIGURES[name]
    for value in (figure.lowest, figure.highest):
        model = replace_parameter(figure.model(), figure.parameter, value)
        assert getattr(model.gearbox, figure.parameter) == value
        assert model.system(80.0).size == 3


def test_damping_of_a_shaft_follows_its_stiffness():
    model = replace_parameter(FIGURES["7.11a"].model(), "input_stiffness", 0.2)
    gearbox = model.gearbox.in_si
    assert gearbox.input_damping == pytest.approx(3e-6 * 0.2 * gearbox.mesh_stiffness)


def test_a_map_takes_the_model():
    figure = FIGURES["7.12a"]
    chart = stability_map(figure.model(), [65.0, 70.0], "input_damping", [0.0, 1e-5], jobs=1, progress=False)
    assert chart.shape == (2, 2)


def test_options_reach_the_model():
    model = FIGURES["7.13a"].model(arm="conjugate", contact=replace(SKEW_LINE, contact_ratio=1.4))
    assert (model.arm, model.contact_ratio) == ("conjugate", 1.4)
    assert FIGURES["7.13a"].model().contact.contact_ratio is None
    assert FIGURES["7.13a"].model().contact_ratio == DRIVE.contact_ratio


@pytest.mark.parametrize("name", ["gear_inertia", "load_inertia", "input_stiffness", "output_stiffness"])
def test_ratios_are_positive(name):
    with pytest.raises(ValueError, match=f"{name} must be greater than 0"):
        replace(FIGURES["7.12a"].gearbox, **{name: 0.0})


def test_bad_dampings_and_factors():
    with pytest.raises(ValueError, match="input_damping must be 0 or greater in s"):
        replace(FIGURES["7.12a"].gearbox, input_damping=-1e-6)
    with pytest.raises(ValueError, match="correction_factor"):
        replace(FIGURES["7.12a"].gearbox, correction_factor=2.0)
    with pytest.raises(ValueError, match="arm must be"):
        FIGURES["7.12a"].model(arm="round")
    with pytest.raises(TypeError, match="load_inertia must be"):
        replace(FIGURES["7.12a"].gearbox, load_inertia="12")
