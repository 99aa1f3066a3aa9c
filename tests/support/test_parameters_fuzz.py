"""Whatever is given for one parameter of a model's part, the answer is the part or a message that names a parameter."""

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from facegear.design.body import Requirements
from facegear.geometry.drive import Drive
from facegear.mechanics.cases import CASE_1
from facegear.mechanics.contact import Contact
from facegear.mechanics.edge_stiffness import DrivingForce
from facegear.mechanics.gearboxes import FIGURES
from facegear.mechanics.mesh_oscillator import MeshOscillator
from facegear.mechanics.paths import loaded_contact
from facegear.mechanics.plate import Body
from facegear.mechanics.properties import STEEL, Material, MeshLoad
from facegear.mechanics.sharing import shared_load
from facegear.mechanics.torsional import Gearbox, Torsional
from facegear.mechanics.transverse import Transverse
from facegear.mechanics.two_gears import TwoGears

LOAD = MeshLoad(1.0, 3e-6, 1.0)
SPRUNG = MeshOscillator(CASE_1, LOAD, (0.0, 1.0), mesh_stiffness=1.6e8, mesh_damping=1e-5)
FACES = MeshOscillator(
    CASE_1, LOAD, (0.0, 0.0), sides=(1, -1), clocking=0.5, mesh_stiffness=1.6e8, mesh_damping=1e-5
)
PITCH = CASE_1.drive.angular_pitch
BETWEEN = dataclasses.replace(SPRUNG, pinion_angles=(0.0, 40 * PITCH))
PARTS = [
    CASE_1.drive,
    CASE_1,
    STEEL,
    LOAD,
    Transverse(CASE_1, LOAD),
    Contact(),
    DrivingForce(4e5, 500.0),
    FIGURES["7.12a"].gearbox.in_si,
    FIGURES["7.12a"].model(),
    Requirements(4e5, 500.0, 1.5, (10.0, 100.0)),
    SPRUNG,
    FACES,
    TwoGears(BETWEEN),
    TwoGears(BETWEEN, roles=("input", "idler")),
    shared_load("equal"),
    loaded_contact(100.0),
]
TYPES = (
    *(Drive, Body, Material, MeshLoad, Transverse, Contact, DrivingForce, Gearbox, Torsional, Requirements),
    *(MeshOscillator, TwoGears, shared_load, loaded_contact),
)

numbers = st.one_of(
    st.integers(-(10**12), 10**12),
    st.floats(),
    st.floats(1e-6, 1e3),
    st.integers(0, 400),
    st.sampled_from([0, -0.0, math.inf, -math.inf, math.nan, 5e-324, 1e308, 10**400]),
)
anything = st.one_of(
    numbers,
    st.none(),
    st.booleans(),
    st.text(max_size=6),
    st.binary(max_size=3),
    st.complex_numbers(max_magnitude=10),
    st.lists(numbers, max_size=3),
    st.tuples(numbers, numbers),
    numbers.filter(lambda x: abs(x) < 1e300).map(np.float64),
    st.sampled_from([np.array([1.0, 2.0]), np.array(3), object(), dict, {"a": 1}, *PARTS]),
)


def test_parts_are_of_all_types():
    assert {type(part) for part in PARTS} == set(TYPES)


@pytest.mark.parametrize("part", PARTS, ids=lambda part: type(part).__name__)
@settings(max_examples=150)
@given(st.data())
def test_one_parameter_replaced_by_anything(part, data):
    names = [field.name for field in dataclasses.fields(part) if field.init]
    name = data.draw(st.sampled_from(names))
    value = data.draw(anything)
    try:
        made = dataclasses.replace(part, **{name: value})
    except (TypeError, ValueError) as error:
        message = str(error)
    else:
        message = f"{name} is valid"
        kept = getattr(made, name)
        assert np.array_equal(kept, value)  # noqa: TID251 - kept as given
        assert not isinstance(kept, float) or math.isfinite(kept)
    named = [other for other in names if other in message]
    # Teeth that fit no longer, or a power without its speed, may be told of the other one.
    several = (Drive, Body, Transverse, Gearbox, MeshOscillator, TwoGears)
    assert name in message or (named and type(part) in several), message
