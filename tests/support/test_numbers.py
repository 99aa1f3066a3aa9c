"""NumPy's scalars count as Python numbers at every door: the same result, and Python's own numbers inside."""

import dataclasses
import math
from numbers import Integral, Real

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from compendium.datasets.modulation import ScaledModulation
from facegear.design import cancellation, envelope
from facegear.design import teeth as tooth_design
from facegear.design.body import Requirements
from facegear.drives.studies.study import Quantity
from facegear.floquet.columns import column_spectral_radii
from facegear.floquet.loads import ContactLoad
from facegear.floquet.methods import AdaptiveMagnus, AlignedStepwise, Collocation, Magnus, Stepwise
from facegear.floquet.models import is_part
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.floquet.radau import Radau
from facegear.geometry.drive import Drive
from facegear.geometry.kinematics import ContactPath
from facegear.geometry.phases import phase_split
from facegear.geometry.skew_line import SkewLine
from facegear.geometry.timed_pairs import mesh_period
from facegear.maps.stability_map import stability_map
from facegear.maps.tracing import tongues
from facegear.mechanics import (
    cases,
    classical,
    classical_pairs,
    disk,
    radial_modes,
    tooth_stiffness,
    torsional,
)
from facegear.mechanics.contact import Contact
from facegear.mechanics.edge_stiffness import DrivingForce
from facegear.mechanics.gearboxes import FIGURES
from facegear.mechanics.inplane import EdgeLoadStress
from facegear.mechanics.properties import STEEL, MeshLoad
from facegear.mechanics.transverse import Transverse
from facegear.support.parameters import rad_per_s, rpm, watt

SCALARS = (
    *(np.int8, np.int16, np.int32, np.int64, np.uint8, np.uint16, np.uint32, np.uint64),
    *(np.float16, np.float32, np.float64, np.longdouble),
)
DRIVE = Drive(70, 350, 3e-3)
BODY = cases.CASE_1
LOAD = MeshLoad(1.0, 3e-6, 1.0)
BOX = FIGURES["7.12a"].gearbox.in_si
ONE = PiecewiseChebyshev.constant([1.0])


def system(**loads):
    return PeriodicSystem(np.eye(1), np.zeros((1, 1)), np.eye(1), [ContactLoad(ONE, **loads)], 3.0)


def fields(part, *left_out):
    """Numbers of a dataclass by their names."""
    values = {f.name: getattr(part, f.name) for f in dataclasses.fields(part) if f.name not in left_out}
    return {
        name: value
        for name, value in values.items()
        if isinstance(value, Real) and not isinstance(value, bool)
    }


CLASSICAL = (
    classical.Hill(0.25, classical.cosine_wave(), 0.125, 3.0),
    classical.Mathieu(0.25, 0.125, 3.0),
    classical.Meissner(0.25, 0.25, 0.1, 3.0),
    classical_pairs.CoupledPair(0.3, 0.1, 0.2, 0.1),
    classical_pairs.GearPair(1.3, 0.7, 0.1, 0.3, shaft_damping=0.1),
)
DATACLASSES = [
    DRIVE,
    STEEL,
    LOAD,
    dataclasses.replace(BODY, nodal_circles=1),
    Contact(contact_ratio=2.0),
    DrivingForce(10000.0, 500.0),
    BOX,
    FIGURES["7.12a"].gearbox,
    Requirements(3e4, 500.0, 1.5, (10.0, 100.0)),
    ContactPath(DRIVE, 2.5),
    SkewLine(DRIVE, 2.5),
    EdgeLoadStress(BODY, 1000.0, 50.0, 6, "tangential", 0.5),
    ContactLoad(ONE, 3.0, 2.0, 1.0),
    system(stiffness=1.0),
    ScaledModulation(FIGURES["7.12a"].model(), 0.5),
    Quantity("name", "label", 1.0, 4.0, 2.0, 0.5, 2.0),
    *CLASSICAL,
    *(
        Stepwise(100),
        AlignedStepwise(100),
        Magnus(100),
        AdaptiveMagnus(1e-3),
        Collocation(12, 8.0),
        Radau(12, 1e-3),
    ),
]
FUNCTIONS = {
    "meissner_trace": (
        classical.meissner_trace,
        {"frequency": 2.0, "depth": 0.3, "duty": 0.25, "damping_ratio": 0.1, "natural_frequency": 1.1},
    ),
    "stiffnesses": (
        lambda first, second: classical_pairs.CoupledPair(0.3, stiffnesses=(first, second)),
        {"first": 1.0, "second": 3.0},
    ),
    "masses": (
        lambda mass, shaft: classical_pairs.GearPair(1.3, masses=(mass, 1), shaft_stiffnesses=(shaft, 1)),
        {"mass": 3.0, "shaft": 0.7},
    ),
    "frequency": (
        lambda **x: [model.system(**x) for model in CLASSICAL[:-1]],
        {"frequency": 2.0},
    ),
    "mesh_frequency": (CLASSICAL[-1].system, {"mesh_frequency": 2.0}),
    "mesh_period": (lambda speed: mesh_period(DRIVE, speed), {"speed": 50.3}),
    "mesh_stiffness": (lambda c: tooth_stiffness.mesh_stiffness(BOX.drive, c), {"c": 0.3}),
    "cylinder_inertia": (torsional.cylinder_inertia, {"radius": 0.1, "height": 0.3, "density": 7000.0}),
    "natural_speed": (
        lambda frequency: torsional.natural_speed(BOX.drive, frequency),
        {"frequency": 3000.0},
    ),
    "root_stress": (
        lambda **x: tooth_design.root_stress(DRIVE, **x),
        {"power": 30000.0, "pinion_speed": 500.3, "thickness": 0.01},
    ),
    "constant_pitch_radius": (
        tooth_design.constant_pitch_radius,
        {"pinion_teeth": 31, "pitch_radius": 0.05, "gear_ratio": 5},
    ),
    "disk_growth_rate": (
        lambda speed: envelope.disk_growth_rate(BODY, DrivingForce(3e4, 500.3), speed),
        {"speed": 50.3},
    ),
    "critical_power": (
        lambda **x: envelope.critical_power(BODY, **x),
        {"pinion_speed": 500.3, "speed": 50.3, "harmonics": 5},
    ),
    "disk_matrices": (lambda **x: disk.disk_matrices(BODY, **x), {"speed": 50.3}),
    "disk_stiffness": (lambda **x: disk.disk_stiffness(BODY, **x), {"speed": 50.3, "radius": 0.17}),
    "shape_vector": (lambda **x: disk.shape_vector(BODY, **x), {"radius": 0.17, "angle": 0.3}),
    "reference_stiffness": (lambda **x: disk.reference_stiffness(BODY, **x), {"highest_speed": 70.3}),
    "radial_modes": (
        lambda **x: radial_modes.radial_modes.__wrapped__(**x).coefficients,
        {"bore_ratio": 0.37, "poissons_ratio": 0.29, "nodal_circles": 1, "nodal_diameters": 2},
    ),
    "centrifugal_stress": (
        radial_modes.centrifugal_stress,
        {"x": 0.7, "bore_ratio": 0.37, "poissons_ratio": 0.29},
    ),
    "phase_split": (lambda angle: phase_split(DRIVE, [0.0, angle]), {"angle": 2.1}),
    "phasing_sum": (
        lambda angle, **x: cancellation.phasing_sum(pinion_angles=[0.0, angle], **x),
        {"gear_teeth": 200, "wave_number": 3, "order": 2, "angle": 0.3},
    ),
    "loud_wave_numbers": (
        cancellation.loud_wave_numbers,
        {"gear_teeth": 100, "pinions": 3, "highest": 7, "order": 2},
    ),
    "rad_per_s": (rad_per_s, {"speed_rpm": 100.3}),
    "rpm": (rpm, {"speed": 100.3}),
    "watt": (watt, {"power_hp": 600.0}),
    "shift": (lambda phase: ONE.shift(phase).breakpoints, {"phase": 0.3}),
    "replace_loads": (
        lambda **x: system().replace_loads(**x),
        {"mass": 0.3, "damping": 0.7, "stiffness": 0.9},
    ),
    "system": (lambda speed: Transverse(BODY, LOAD).system(speed), {"speed": 50.3}),
    "tongues": (
        lambda low, high, threshold: tongues(classical.Mathieu(0.3, 0.01), (low, high), threshold=threshold),
        {"low": 1.7, "high": 2.3, "threshold": 1e-3},
    ),
    "stability_map": (
        lambda speed, value: (
            stability_map(classical.Mathieu(0.3, 0.01), [speed], "depth", [value], jobs=1).values
        ),
        {"speed": 1.7, "value": 0.3},
    ),
    "column_spectral_radii": (
        lambda **x: column_spectral_radii(system(), **x),
        {"masses": 0.1, "dampings": 0.3, "stiffnesses": 0.7},
    ),
    **{
        type(part).__name__: (lambda part=part, **x: dataclasses.replace(part, **x), fields(part))
        for part in DATACLASSES
    },
}


def plain(result):
    """Take a result apart into texts with every digit."""
    if is_part(result):
        return [(f.name, plain(getattr(result, f.name))) for f in dataclasses.fields(result)]
    if isinstance(result, np.ndarray):
        assert result.dtype in (np.float64, np.complex128, np.int64), result.dtype
        return result.tolist()
    return [plain(part) for part in result] if isinstance(result, tuple | list) else repr(result)


def numbers_inside(part):
    """All numbers of a dataclass and of those it holds."""
    for value in (getattr(part, f.name) for f in dataclasses.fields(part)):
        for entry in value if isinstance(value, tuple) else (value,):
            if is_part(entry):
                yield from numbers_inside(entry)
            elif isinstance(entry, Real) and not isinstance(entry, bool):
                yield entry


def fitting(value, scalar):
    """Return a number as a scalar of NumPy, or None if it does not fit into that."""
    whole = issubclass(scalar, np.integer)
    if isinstance(value, Integral) and not whole:
        return None
    if whole and not (float(value).is_integer() and np.iinfo(scalar).min <= value <= np.iinfo(scalar).max):
        return None
    with np.errstate(over="ignore"):
        made = scalar(value)
    # Too coarse a type leaves the range of the parameter: then nothing can be compared.
    return made if math.isclose(float(made), value, rel_tol=1e-3) else None


@pytest.mark.parametrize("scalar", SCALARS, ids=lambda scalar: scalar.__name__)
@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_scalar_of_numpy_counts_as_the_python_number(name, scalar):
    function, arguments = FUNCTIONS[name]
    given = {key: fitting(value, scalar) for key, value in arguments.items()}
    given = {key: value for key, value in given.items() if value is not None}
    same = {key: int(value) if isinstance(value, Integral) else float(value) for key, value in given.items()}
    result, expected = function(**{**arguments, **given}), function(**{**arguments, **same})
    assert plain(result) == plain(expected)
    if is_part(result):
        assert {type(number) for number in numbers_inside(result)} <= {int, float}


def test_every_type_is_tried_on_something():
    tried = {
        scalar: sum(fitting(value, scalar) is not None for _, x in FUNCTIONS.values() for value in x.values())
        for scalar in SCALARS
    }
    assert min(tried.values()) > 20, tried


@pytest.mark.parametrize("wrong", [True, np.True_, 1j, "1"], ids=repr)
@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_boolean_a_complex_number_and_a_text_are_no_numbers(name, wrong):
    function, arguments = FUNCTIONS[name]
    for key in arguments:
        with pytest.raises(
            TypeError, match=r"must be (an?|real) (integer|number|real number)|must be real numbers"
        ):
            function(**{**arguments, key: wrong})


def test_teeth_whose_products_pass_the_width_of_their_type():
    # int8 holds 127: 70 + 70 does not fit, and 2 · 70 · … even less.
    made = Drive(np.int8(70), np.int16(350), np.float16(0.003))
    assert made == Drive(70, 350, float(np.float16(0.003)))
    assert made.contact_ratio == Drive(70, 350, float(np.float16(0.003))).contact_ratio
    assert (
        repr(made)
        == f"Drive(pinion_teeth=70, gear_teeth=350, module={made.module!r}, {repr(made).split(', ', 3)[3]}"
    )


@pytest.mark.parametrize("scalar", SCALARS, ids=lambda scalar: scalar.__name__)
def test_arrays_of_any_type_are_computed_in_double(scalar):
    speeds = np.array([20, 50], dtype=scalar)
    np.testing.assert_allclose(rpm(speeds), rpm([20.0, 50.0]), rtol=1e-15)
    made = PeriodicSystem(np.eye(2, dtype=scalar), np.zeros((2, 2), scalar), np.eye(2, dtype=scalar), (), 1.0)
    assert {made.mass.dtype, made.damping.dtype, made.stiffness.dtype} == {np.dtype(float)}
    assert PiecewiseChebyshev(np.zeros(1, scalar), np.ones((1, 2, 1), scalar)).coefficients.dtype == float


@settings(max_examples=100)
@given(st.integers(10, 127), st.integers(128, 255))
def test_any_teeth_of_any_width(pinion_teeth, gear_teeth):
    def made(first, second):
        try:
            return repr(Drive(first, second, 3e-3))
        except ValueError as error:
            return str(error)

    assert made(np.int8(pinion_teeth), np.uint8(gear_teeth)) == made(pinion_teeth, gear_teeth)
