from dataclasses import dataclass, replace

import numpy as np
import pytest

from facegear.floquet.models import (
    is_whole_number,
    parameter_names,
    parameter_path,
    replace_parameter,
    value_of,
)
from facegear.floquet.periodic import PeriodicSystem
from facegear.geometry.drive import Drive
from facegear.mechanics.cases import FIGURES
from facegear.mechanics.plate import Body
from facegear.mechanics.properties import MeshLoad
from facegear.mechanics.transverse import Transverse

TRANSVERSE = Transverse(Body(Drive(26, 130, 3.175e-3), thickness_ratio=0.03), MeshLoad(1.0, 3e-6, 0.5))


@dataclass(frozen=True)
class Shaft:
    stiffness: float
    limit: float | None = None
    name: str = "shaft"
    ends: tuple[float, float] = (0.0, 1.0)


@dataclass(frozen=True)
class TwoShafts:
    first: Shaft
    second: Shaft
    teeth: int = 20

    def system(self, speed: float) -> PeriodicSystem:
        return PeriodicSystem(
            np.eye(1), np.zeros((1, 1)), [[self.first.stiffness]], (), 1.0 / (self.teeth * speed)
        )


PAIR = TwoShafts(Shaft(1.0), Shaft(2.0))


def test_parameters_of_the_transverse_model_are_found_in_its_parts():
    names = parameter_names(TRANSVERSE)
    assert {"load.stiffness", "load.damping", "load.mass", "body.thickness_ratio"} <= set(names)
    assert "body.drive.pinion_teeth" in names
    assert parameter_path(TRANSVERSE, "stiffness") == ("load", "stiffness")
    assert parameter_path(TRANSVERSE, "pinion_teeth") == ("body", "drive", "pinion_teeth")


def test_replacing_changes_one_parameter_and_leaves_the_model_alone():
    changed = replace_parameter(TRANSVERSE, "stiffness", 0.25)
    assert changed.load == MeshLoad(0.25, 3e-6, 0.5)
    assert changed.body == TRANSVERSE.body
    assert TRANSVERSE.load.stiffness == 1.0
    assert replace_parameter(TRANSVERSE, "thickness_ratio", 0.04).body.thickness_ratio == 0.04


def test_names_that_occur_twice_take_the_dotted_form():
    with pytest.raises(ValueError, match=r"'stiffness' could be first.stiffness or second.stiffness"):
        replace_parameter(PAIR, "stiffness", 3.0)
    assert replace_parameter(PAIR, "second.stiffness", 3.0) == TwoShafts(Shaft(1.0), Shaft(3.0))


def test_optional_numbers_are_parameters_and_text_and_tuples_are_not():
    assert parameter_names(PAIR) == (
        "teeth",
        "first.stiffness",
        "first.limit",
        "second.stiffness",
        "second.limit",
    )


def test_counted_parameters_take_whole_numbers():
    assert is_whole_number(PAIR, "teeth")
    assert not is_whole_number(PAIR, "first.stiffness")
    assert isinstance(replace_parameter(PAIR, "teeth", 24.0).teeth, int)
    with pytest.raises(TypeError, match="pinion_teeth"):
        replace_parameter(TRANSVERSE, "pinion_teeth", 26.5)


def test_counted_parameters_that_may_be_left_out_do_too():
    body = replace(TRANSVERSE.body, drive=replace(TRANSVERSE.body.drive, shaper_teeth=26))
    model = replace(TRANSVERSE, body=body)
    assert is_whole_number(model, "shaper_teeth")
    assert replace_parameter(model, "shaper_teeth", 26.0) == model
    with pytest.raises(TypeError, match="shaper_teeth must be an integer"):
        replace_parameter(model, "shaper_teeth", 26.5)


def test_present_value():
    assert value_of(TRANSVERSE, "pinion_teeth") == 26.0
    with pytest.raises(ValueError, match=r"contact_ratio is None, the model's default"):
        value_of(TRANSVERSE, "contact_ratio")
    assert value_of(replace_parameter(TRANSVERSE, "contact_ratio", 2.0), "contact_ratio") == 2.0


def test_unknown_parameters_are_answered_with_those_that_exist():
    with pytest.raises(ValueError, match=r"load\.stiffness.*got 'stifness'"):
        replace_parameter(TRANSVERSE, "stifness", 1.0)
    with pytest.raises(ValueError, match="name"):
        replace_parameter(PAIR, "name", 1.0)
    with pytest.raises(TypeError, match="model must be a dataclass"):
        replace_parameter(object(), "stiffness", 1.0)


def test_the_model_checks_the_value():
    with pytest.raises(ValueError, match="stiffness must be 0 or greater"):
        replace_parameter(TRANSVERSE, "stiffness", -1.0)


@pytest.mark.parametrize("wrong", ["27", True, None, [27]], ids=repr)
def test_what_is_no_number_is_left_to_the_check_of_the_part(wrong):
    model = FIGURES["4.4a"].model()
    with pytest.raises(TypeError, match="pinion_teeth must be an integer"):
        replace_parameter(model, "pinion_teeth", wrong)
