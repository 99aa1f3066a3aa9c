"""What the explorer computes, against closed forms and the maps it takes a shorter way to."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from facegear.drives import studies
from facegear.drives.cell import cell_detail
from facegear.drives.explore import (
    Choice,
    Quantity,
    Study,
    map_stages,
    reading_map,
    shown_only,
    unstable,
    view,
)
from facegear.floquet.models import replace_parameter
from facegear.floquet.multipliers import growth_rate
from facegear.geometry.drive import Drive
from facegear.maps.stability_map import stability_map
from facegear.mechanics import cases, gearboxes
from facegear.mechanics.classical import Meissner, meissner_trace
from facegear.mechanics.contact import Contact
from facegear.mechanics.disk import shape_vector
from facegear.mechanics.edge_stiffness import DrivingForce
from facegear.mechanics.heavy_shafts import HeavyShafts
from facegear.mechanics.mesh_oscillator import MeshOscillator
from facegear.mechanics.plate import Body
from facegear.mechanics.sharing import shared_load
from facegear.mechanics.spread_force import FaceStrip, PitchPoint
from facegear.mechanics.torsional import Torsional, mesh_stiffness
from facegear.mechanics.transverse import Transverse
from facegear.support.parameters import Material, MeshLoad, rad_per_s

SQUARE = Meissner(depth=0.6, duty=0.4)
FREQUENCIES = np.linspace(0.4, 2.6, 23)
DEPTHS = np.linspace(0.0, 0.9, 11)


def test_map_of_an_oscillator_is_unstable_where_the_trace_of_its_closed_form_says_so():
    *_, chart = map_stages(SQUARE, FREQUENCIES, "depth", DEPTHS)
    trace = np.abs(meissner_trace(FREQUENCIES, DEPTHS[:, np.newaxis], 0.4))
    clear = np.abs(trace - 2.0) > 1e-6
    assert clear.mean() > 0.9
    assert unstable(chart)[clear].tolist() == (trace > 2.0)[clear].tolist()
    # The larger of the two multipliers that have the trace for their sum and 1 for their product.
    radius = np.where(trace > 2.0, trace / 2.0 + np.sqrt(np.maximum(trace**2 / 4.0 - 1.0, 0.0)), 1.0)
    period = 2.0 * np.pi / FREQUENCIES
    assert chart.values[clear] == pytest.approx((np.log(radius) / period)[clear], abs=1e-8)


@pytest.mark.parametrize("parameter", ["depth", pytest.param("damping_ratio", marks=pytest.mark.slow)])
def test_last_stage_is_the_map_and_the_first_one_agrees_where_it_is_computed(parameter):
    model = replace(SQUARE, damping_ratio=0.02)
    values = np.linspace(0.01, 0.2, 8)
    stages = list(map_stages(model, FREQUENCIES, parameter, values))
    expected = stability_map(model, FREQUENCIES, parameter, values, jobs=1, progress=False)
    assert stages[-1].dims == expected.dims
    at_once = reading_map(model, FREQUENCIES, parameter, values)
    assert at_once.values == pytest.approx(expected.values, abs=1e-12)
    assert at_once.attrs == stages[-1].attrs
    assert at_once["period"].values == pytest.approx(2.0 * np.pi / FREQUENCIES)
    assert stages[-1].values == pytest.approx(expected.values, abs=1e-8)
    assert stages[0].values[2::5, 1::3] == pytest.approx(expected.values[2::5, 1::3], abs=1e-8)
    done = [stage.attrs["computed"] for stage in stages]
    assert done == sorted(done)
    assert done[0] < done[-1] == FREQUENCIES.size
    # What is not yet computed is a neighbour's, not a gap.
    assert np.isfinite(stages[0].values).all()


def test_multipliers_and_tongue_of_a_cell_are_those_of_the_closed_form():
    model = replace(SQUARE, depth=0.2)
    detail = cell_detail(model, 1.95)
    trace = float(meissner_trace(1.95, 0.2, 0.4))
    assert complex(detail.multipliers.sum()) == pytest.approx(trace, abs=1e-9)
    assert complex(detail.multipliers.prod()) == pytest.approx(1.0, abs=1e-9)
    assert detail.growth_rate == pytest.approx(np.log(abs(detail.critical)) * 1.95 / (2 * np.pi))
    assert detail.label == "(1+1)/1"
    assert detail.deflections == {}
    assert detail.tongue.lower < 1.95 < detail.tongue.upper
    for border in (detail.tongue.lower, detail.tongue.upper):
        assert abs(float(meissner_trace(border, 0.2, 0.4))) == pytest.approx(2.0, abs=1e-6)


def test_a_tongue_wider_than_what_is_searched_ends_where_the_search_does():
    detail = cell_detail(SQUARE, 1.9)
    assert abs(float(meissner_trace(detail.searched[0], 0.6, 0.4))) > 2.0
    assert detail.tongue.lower == detail.searched[0]
    assert abs(float(meissner_trace(detail.tongue.upper, 0.6, 0.4))) == pytest.approx(2.0, abs=1e-6)


def test_stable_cell_has_neither_tongue_nor_label():
    detail = cell_detail(SQUARE, 1.3)
    assert abs(float(meissner_trace(1.3, 0.6, 0.4))) < 2.0
    assert detail.tongue is None
    assert detail.label is None
    assert np.abs(detail.multipliers) == pytest.approx(1.0, abs=1e-9)


def test_motion_over_time_is_that_of_the_equation_and_returns_times_the_multiplier():
    model = replace(SQUARE, depth=0.2, damping_ratio=0.01)
    detail = cell_detail(model, 1.95)
    motion = detail.history[:, 0]
    # Within a part of the square wave the equation is q̈ + 2ϑ q̇ + (1 ± ε) q = 0.
    time = motion["time"].values
    first = motion.values[(time > 0.0) & (time < 0.4)]
    step = 2.0 * np.pi / 1.95 * (time[1] - time[0])
    acceleration = (first[2:] - 2.0 * first[1:-1] + first[:-2]) / step**2
    velocity = (first[2:] - first[:-2]) / (2.0 * step)
    residual = acceleration + 0.02 * velocity + 1.2 * first[1:-1]
    assert np.abs(residual).max() < 2e-3 * np.abs(first).max()
    one_period = motion.size // 6
    ahead = motion.values[one_period : 2 * one_period]
    assert ahead == pytest.approx(detail.critical.real * motion.values[:one_period], abs=1e-6)
    # What the integration over a period ends with is what the next one begins with.
    ends = motion.values[[one_period - 1, one_period]]
    assert ends[0] == pytest.approx(ends[1], abs=1e-6)


def test_critical_motion_of_a_free_disk_is_a_travelling_wave():
    free = Transverse(cases.CASE_1, MeshLoad(0.0, 0.0, 0.0))
    detail = cell_detail(free, float(rad_per_s(700.0)))
    deflection = detail.deflections["face gear"].values
    assert np.abs(deflection).max() == pytest.approx(1.0)
    assert np.abs(deflection[0]).max() < 1e-9  # clamped at the bore
    assert np.ptp(np.abs(deflection), axis=1).max() < 1e-6
    turns = np.unwrap(np.angle(deflection[-1]))
    diameters = (turns[-1] - turns[0]) / (2.0 * np.pi)
    assert abs(diameters) == pytest.approx(round(abs(diameters)), abs=1e-6)
    assert detail.deflections["face gear"]["radius"].values[[0, -1]] == pytest.approx(
        [cases.CASE_1.bore_radius, cases.CASE_1.outer_radius]
    )


def test_deflection_is_that_of_the_motion():
    model = cases.FIGURES["4.4a"].model()
    detail = cell_detail(model, float(rad_per_s(533.0)))
    radius, angle = (detail.deflections["face gear"][name].values for name in ("radius", "angle"))
    expected = shape_vector(model.body, radius[7], angle[30]) @ detail.motion
    assert complex(detail.deflections["face gear"].values[7, 30]) == pytest.approx(complex(expected))


def test_view_is_of_the_cell_that_was_asked_for():
    study = replace(studies.oscillator_study(), columns=9, rows=7)
    shown = view(study, 1.9, 0.6, changes={"wave": studies.SQUARE, "duty": 0.4, "damping_ratio": 0.0})
    assert shown.detail.speed == pytest.approx(1.9)
    assert abs(shown.detail.critical) == pytest.approx(abs(cell_detail(SQUARE, 1.9).critical))
    assert shown.chart.shape == (7, 9)


THREE = Transverse(
    Body(cases.CASE_2.drive, 0.05),
    MeshLoad(0.3, 2e-6, 0.7),
    pinion_angles=(0.0, 2.0, 4.0),
    contact=Contact(contact_ratio=cases.CASE_2.drive.geometric_contact_ratio),
    force=DrivingForce(3e5, 500.0, "dead", spread=PitchPoint()),
)


@pytest.mark.parametrize("start", [cases.FIGURES["4.5a"].model(), THREE])
def test_controls_of_a_drive_stand_at_first_where_its_model_does(start):
    study = studies.drive_study(start)
    built = study.model(study.settings())
    one, other = (model.system(60.0) for model in (start, built))
    for name in ("damping", "stiffness", "period"):
        assert getattr(one, name) == pytest.approx(getattr(other, name), rel=1e-9)
    assert len(one.loads) == len(other.loads)
    for a, b in zip(one.loads, other.loads, strict=True):
        assert (a.stiffness, a.damping, a.mass) == pytest.approx((b.stiffness, b.damping, b.mass), rel=1e-9)
        assert a.shape(0.3) == pytest.approx(b.shape(0.3), rel=1e-9)


OWN_DRIVE = Drive(30, 120, 3e-3, pressure_angle=math.radians(20.0), shaft_angle=math.radians(85.0))
ALUMINIUM = Material(2810.0, 71e9, 0.33, 2e-6, 4e8)
OWN_BODY = Body(OWN_DRIVE, 0.04, nodal_diameters=5, material=ALUMINIUM)
OWN = Transverse(
    OWN_BODY,
    MeshLoad(0.5, 4e-6, 0.0),
    (0.5, 1.5),
    Contact(rate="total", travel="with_disk"),
    DrivingForce(2e5, 400.0, harmonics=6),
    phases=(0.0, 0.3),
)
ROUND = Drive(30, 120, 3e-3)
ON_SPRINGS = MeshOscillator(
    Body(ROUND, 0.04), MeshLoad(0.5, 4e-6, 0.5), mesh_stiffness=mesh_stiffness(ROUND, 0.5), mesh_damping=2e-5
)
BY_RULE = Contact(
    path=shared_load("equal"), sharing="each", rate="total", contact_ratio=ROUND.geometric_contact_ratio
)


@pytest.mark.parametrize(
    ("study", "model"),
    [
        (studies.drive_study, OWN),
        (studies.teeth_study, ON_SPRINGS),
        (studies.teeth_study, replace(ON_SPRINGS, contact=BY_RULE, pinion_angles=(0.4,))),
        (studies.teeth_study, replace(ON_SPRINGS, force=DrivingForce(2e5, 400.0, "dead", 6))),
    ],
)
def test_what_has_no_control_stays_as_the_model_has_it(study, model):
    """Pressure angle, material, basis, rate, phases and the like were dropped without a word."""
    made = study(model)
    built = made.model(made.settings())
    assert growth_rate(built.system(60.0)) == pytest.approx(growth_rate(model.system(60.0)), abs=1e-7)
    assert built.system(60.0).size == model.system(60.0).size


@pytest.mark.parametrize(
    ("study", "model", "error", "message"),
    [
        (studies.drive_study, ON_SPRINGS, TypeError, "model must be a Transverse for this study, got"),
        (studies.teeth_study, OWN, TypeError, "model must be a MeshOscillator for this study, got"),
        (studies.teeth_study, "x", TypeError, "model must be a MeshOscillator for this study, got"),
        (
            studies.drive_study,
            replace(OWN, contact=Contact(sharing="mean", contact_ratio=1.7)),
            ValueError,
            r"contact_ratio of the model must be .*, got 1.7",
        ),
        (
            studies.teeth_study,
            replace(ON_SPRINGS, contact=Contact(rate="total", contact_ratio=2.2)),
            ValueError,
            "contact of the model must be along lines, shared by",
        ),
        (
            studies.teeth_study,
            replace(ON_SPRINGS, pinion_angles=(0.0, 2.0)),
            ValueError,
            "model must have one pinion",
        ),
        (
            studies.teeth_study,
            replace(ON_SPRINGS, sides=(-1,)),
            ValueError,
            "model must have one pinion on the front",
        ),
        (
            studies.shafts_study,
            HeavyShafts(Torsional(gearboxes.FIGURES["7.12a"].gearbox.in_si), 0.2, 0.4),
            TypeError,
            "gearbox of the model must be a ProportionalGearbox",
        ),
        (studies.shafts_study, gearboxes.FIGURES["7.12a"].model(), TypeError, "model must be a HeavyShafts"),
        (
            studies.damage_study,
            gearboxes.FIGURES["7.12a"].model(),
            TypeError,
            "gearbox of the model must be a Gearbox",
        ),
    ],
)
def test_a_model_that_controls_would_change_is_refused(study, model, error, message):
    with pytest.raises(error, match=message):
        study(model)


@pytest.mark.parametrize("study", [studies.drive_study, studies.teeth_study, studies.shafts_study])
@pytest.mark.parametrize("highest", [0, -1.0, "x"])
def test_a_highest_speed_that_is_none_is_named(study, highest):
    with pytest.raises((TypeError, ValueError), match="highest_speed"):
        study(None, highest)


def test_an_option_that_there_is_not_is_refused():
    study = studies.teeth_study()
    with pytest.raises(ValueError, match=r"pinions must be .*got 'x'"):
        study.model(study.settings({"pinions": "x"}))


def test_a_force_on_places_that_cannot_be_chosen_is_refused():
    elsewhere = replace(THREE, force=replace(THREE.force, spread=FaceStrip()))
    with pytest.raises(
        ValueError, match=r"force of the model must press on one point of the rim or .*, got FaceStrip"
    ):
        studies.drive_study(elsewhere)


def fingerprint(model, speed):
    system = model.system(speed)
    parts = [system.mass, system.damping, system.stiffness, np.array([system.period])]
    for load in system.loads:
        parts.append(load.breakpoints)
        parts += [np.array([load.mass, load.damping, load.stiffness]), load.shape(np.array([0.1, 0.7]))]
        parts += [] if load.weight is None else [load.weight(np.array([0.1, 0.45, 0.7]))]
    return np.concatenate([np.ravel(part) for part in parts])


STUDIES = {
    "drive": (studies.drive_study(THREE), {}, 60.0),
    "oscillator": (studies.oscillator_study(), {"wave": studies.SQUARE}, 1.9),
    "gearbox": (studies.gearbox_study(), {}, 60.0),
    "shafts": (studies.shafts_study(), {}, 60.0),
    "damage": (studies.damage_study(), {}, 60.0),
    "teeth": (studies.teeth_study(), {"pinions": studies.BOTH, "power": 300.0}, 60.0),
}


@pytest.mark.parametrize(
    ("key", "name"),
    [(key, control.name) for key, (study, _, _) in STUDIES.items() for control in study.controls],
)
def test_no_control_is_dead(key, name):
    study, changes, speed = STUDIES[key]
    control = next(c for c in study.controls if c.name == name)
    if isinstance(control, Choice):
        at_first = {**changes}.get(name, control.value)
        value = next(option for option in control.options if option != at_first)
    else:
        value = control.value + (1 if control.value + 1 <= control.highest else -1) * control.step
    before = fingerprint(study.model(study.settings(changes)), speed)
    after = fingerprint(study.model(study.settings({**changes, name: value})), speed)
    assert before.shape != after.shape or not np.allclose(before, after, rtol=1e-9, atol=0.0)


def refusal(study, changes):
    """Return what is said against settings, None if nothing."""
    try:
        study.model(study.settings(changes))
    except (TypeError, ValueError, ArithmeticError) as problem:
        return str(problem)
    return None


@given(st.data())
@settings(max_examples=40)
def test_a_drive_is_made_or_refused_with_a_sentence(data):
    study = STUDIES["drive"][0]
    changes = {}
    for control in study.controls:
        if isinstance(control, Choice):
            changes[control.name] = data.draw(st.sampled_from(control.options))
        elif control.whole:
            changes[control.name] = data.draw(st.integers(int(control.lowest), int(control.highest)))
        else:
            changes[control.name] = data.draw(st.floats(control.lowest, control.highest))
    said = refusal(study, changes)
    assert said is None or re.search("got|leave no face width|is too few", said)


def test_impossible_teeth_are_named():
    study = STUDIES["drive"][0]
    with pytest.raises(ValueError, match="gear_teeth must exceed pinion_teeth=60, got 50"):
        study.model(study.settings({"pinion_teeth": 60, "gear_teeth": 50}))
    with pytest.raises(ValueError, match="bore_radius must"):
        study.model(study.settings({"bore_radius": 200.0, "module": 1.0}))


@pytest.mark.slow
def test_few_teeth_at_a_high_ratio_are_explored():
    """Contact lines end on the pinion's base circle, where the contact point's speed has no limit."""
    study = STUDIES["drive"][0]
    few = study.model(study.settings({"pinion_teeth": 18, "gear_teeth": 124, "pinions": "1"}))
    values = np.array([0.4, 1.0])
    chart = reading_map(few, np.array([55.0, 60.0]), "load.stiffness", values)
    expected = [
        [growth_rate(replace_parameter(few, "load.stiffness", v).system(speed)) for speed in (55.0, 60.0)]
        for v in values
    ]
    np.testing.assert_allclose(chart.values, expected, atol=1e-5)


def test_axes_are_in_si_units_and_cover_the_range():
    study = replace(studies.drive_study(), columns=5, rows=3)
    speeds, values = study.axes(study.settings({"highest_speed": 600.0}), "damping")
    assert speeds == pytest.approx(rad_per_s(np.linspace(30.0, 600.0, 5)))
    assert values == pytest.approx([0.0, 1e-4, 2e-4])


def test_controls_that_are_not_shown_keep_their_values():
    study = shown_only(studies.drive_study(), ["mass", "stiffness"])
    assert [control.name for control in study.controls] == ["mass", "stiffness"]
    model = study.model(study.settings({"mass": 0.5}))
    assert model.load == MeshLoad(1.0, 3e-6, 0.5)
    assert model.body == cases.CASE_1


SPEED = Quantity("highest_speed", "speed", 1.0, 5.0, 2.6, 0.1)
DEPTH = Quantity("depth", "depth", 0.0, 0.9, 0.4, 0.1, parameter="depth")


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        (lambda: Quantity("depth", "depth", 0.0, 0.9, 1.4, 0.1), "value of depth must lie between"),
        (lambda: Quantity("depth", "depth", 0.0, 0.9, 0.4, 0.0), "step of depth must be greater than 0"),
        (lambda: Choice("wave", "wave", ("a", "b"), "c"), "value of wave must be one of"),
        (lambda: Study((DEPTH, DEPTH), lambda s: SQUARE, "depth", SPEED), "names that differ"),
        (lambda: Study((DEPTH,), lambda s: SQUARE, "duty", SPEED), "vertical must be one of"),
        (lambda: studies.drive_study().settings({"teeth": 3}), "settings must be among .*, got teeth"),
        (lambda: shown_only(studies.drive_study(), ["teeth"]), "names must be among .*, got teeth"),
        (lambda: shown_only(studies.drive_study(), ["mass"]), "vertical must be one of"),
        (
            lambda: studies.drive_study().model(studies.drive_study().settings({"pinion_teeth": 26.5})),
            "whole number",
        ),
        (lambda: cell_detail(SQUARE, -1.0), "speed must be greater than 0"),
        (lambda: replace(studies.drive_study(), columns=1), "columns must be at least 2"),
    ],
)
def test_wrong_descriptions_are_refused(wrong, message):
    with pytest.raises(ValueError, match=message):
        wrong()


class Unnamed:
    """A model that does not say, or says wrongly, what its coordinate is."""

    def __init__(self, **named):
        self.__dict__.update(named)

    def system(self, speed):
        return SQUARE.system(speed)


@pytest.mark.parametrize(
    ("model", "error", "says"),
    [
        (Unnamed(), TypeError, "each of its 1 rows, got None"),
        (Unnamed(coordinates=("q",)), TypeError, r"each of its 1 rows, got \('q',\)"),
        (Unnamed(coordinates=SQUARE.coordinates * 2), ValueError, "each of its 1 rows, got 2"),
        (Unnamed(system=lambda speed: None), TypeError, "must be a PeriodicSystem, got a NoneType"),
    ],
)
def test_a_cell_of_an_incomplete_model_says_what_is_missing(model, error, says):
    with pytest.raises(error, match=says):
        cell_detail(model, 1.9)
