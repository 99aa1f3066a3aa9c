"""Paths of line, point and loaded contact in the models."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import facegear as fg
from facegear.mechanics.cases import CASE_1
from facegear.mechanics.gearboxes import FIGURES
from tests.independent.make_anchors_ch03_load import Lumped, disk_growth

DRIVE = fg.Drive(26, 130, 3.175e-3)
CUT = fg.Drive(26, 130, 3.175e-3, shaper_teeth=27)
LOAD = fg.MeshLoad(stiffness=0.6, damping=3e-6, mass=1.0)


def test_each_path_has_the_clock_of_its_own_contact():
    def ratio(drive, path):
        return fg.Contact(path=path, sharing="mean").ratio(drive)

    assert ratio(DRIVE, fg.ContactPath) == DRIVE.contact_ratio
    assert ratio(DRIVE, fg.line_contact) == DRIVE.geometric_contact_ratio
    assert ratio(CUT, fg.point_contact) == fg.UnloadedContact(CUT).contact_ratio
    assert ratio(CUT, fg.loaded_contact(30.0)) == fg.LoadedContact(CUT, 30.0).contact_ratio
    given = fg.Contact(path=fg.line_contact, contact_ratio=1.7)
    assert given.ratio(DRIVE) == 1.7


def test_line_contact_is_the_path_of_the_lines_on_that_clock():
    given = fg.Contact(contact_ratio=DRIVE.geometric_contact_ratio)
    [one], [other] = (contact.places(DRIVE) for contact in (fg.Contact(path=fg.line_contact), given))
    time = np.linspace(0.0, 1.0, 50)
    np.testing.assert_allclose(one.position(time), other.position(time), rtol=0, atol=1e-14)


@pytest.mark.parametrize("law", ["slice", "pair"])
@pytest.mark.parametrize("torque", [1.0, 60.0, 2000.0])
def test_the_load_is_where_the_pressure_is(law, torque):
    [place] = fg.Contact(path=fg.loaded_contact(torque, compliance=law)).places(CUT)
    contact = fg.LoadedContact(CUT, torque, compliance=law)
    time = np.random.default_rng(1).uniform(0.0, 1.0, 60)
    pairs = contact.pairs(time)
    share = pairs.force / contact.force
    expected = np.stack([(share * pairs.radius).sum(0) / CUT.outer_radius, (share * pairs.angle).sum(0)], -1)
    np.testing.assert_allclose(place.position(time), expected, atol=1e-10)
    np.testing.assert_allclose(
        place.weight(time)[:, 0], contact.mesh_stiffness(time) / contact.pair_stiffness, rtol=1e-9
    )


def test_pairs_by_themselves_have_their_own_stiffness():
    contact = fg.LoadedContact(CUT, 60.0)
    places = fg.Contact(path=fg.loaded_contact(60.0), sharing="each", rate="total").places(CUT)
    time = np.random.default_rng(2).uniform(0.0, 1.0, 60)
    stiffness = contact.pairs(time).stiffness / contact.pair_stiffness
    np.testing.assert_allclose([place.weight(time)[:, 0] for place in places], stiffness, atol=1e-9)
    moved = places[0].shifted(0.3).rotated(0.1)
    np.testing.assert_allclose(moved.weight(time), places[0].weight(time + 0.3), atol=1e-12)


@pytest.mark.parametrize(("rate", "torque"), [("frozen", 30.0), ("total", 300.0)])
def test_disk_under_load_against_complex_exponentials(rate, torque):
    contact = fg.Contact(path=fg.loaded_contact(torque), rate=rate)
    model = fg.Transverse(fg.Body(CUT, CASE_1.thickness_ratio, CASE_1.bore_radius), LOAD, contact=contact)
    path = fg.loaded_contact(torque)(CUT)
    value, error = disk_growth(replace(CASE_1, drive=CUT), path, 640.0, 0.6, 3e-6, rate)
    assert fg.growth_rate(model.system(fg.rad_per_s(640.0))) == pytest.approx(value, abs=error)


@pytest.mark.parametrize("law", ["slice", "pair"])
def test_gearbox_under_load_against_three_equations_of_motion(law):
    box = FIGURES["7.12a"].gearbox.in_si
    lumped = Lumped(box, 60.0, law)
    own = replace(box, drive=replace(box.drive, shaper_teeth=box.drive.pinion_teeth + 1))
    contact = fg.Contact(path=fg.loaded_contact(60.0, compliance=law), sharing="each", rate="total")
    model = fg.Torsional(own, contact, arm="conjugate")
    speed = 430.0
    period = 60.0 / (box.drive.gear_teeth * speed)
    scale = np.diag([1.0, 1.0, 1.0, 1e3, 1e3, 1e3])
    matrix = np.linalg.solve(scale, lumped.run(period, scale, 0.0))
    expected = math.log(np.abs(np.linalg.eigvals(matrix)).max()) / period
    assert fg.growth_rate(model.system(fg.rad_per_s(speed))) == pytest.approx(expected, abs=1e-7 / period)


def test_pinions_elsewhere_have_the_same_load_in_their_own_phase():
    body = fg.Body(CUT, 0.03, 0.05)
    contact = fg.Contact(path=fg.loaded_contact(100.0))
    two = fg.Transverse(body, LOAD, pinion_angles=(0.0, 0.4), contact=contact)
    one = fg.Transverse(body, LOAD, contact=contact)
    phase = fg.phase_split(CUT, (0.0, 0.4)).phase[1]
    time = np.linspace(0.0, 1.0, 11)
    # The mode without nodal diameters does not know angles.
    np.testing.assert_allclose(two.shapes[1](time)[:, :2], one.shapes[0](time + phase)[:, :2], atol=1e-9)


def test_torque_is_a_parameter():
    model = fg.Transverse(fg.Body(CUT, 0.03), LOAD, contact=fg.Contact(path=fg.loaded_contact(100.0)))
    other = fg.replace_parameter(model, "torque", 10.0)
    assert other.contact.path.torque == 10.0
    assert other.contact_ratio == fg.LoadedContact(CUT, 10.0).contact_ratio
    speeds, torques = fg.rad_per_s(np.linspace(300.0, 900.0, 4)), [5.0, 50.0]
    chart = fg.stability_map(model, speeds, "torque", torques, jobs=1)
    cells = [
        [fg.growth_rate(fg.replace_parameter(model, "torque", t).system(float(v))) for v in speeds]
        for t in torques
    ]
    np.testing.assert_allclose(chart.values, cells, atol=1e-4)


def transverse(path, **given):
    return fg.Transverse(fg.Body(CUT, 0.03), LOAD, contact=fg.Contact(path=path, **given))


def test_what_messages_send_one_to_works():
    for made in (
        transverse(fg.point_contact, sharing="mean"),
        transverse(fg.loaded_contact(500.0), rate="total"),
        transverse(fg.loaded_contact(500.0, compliance="pair")),
        # At small loads rigid teeth take up their loads little by little.
        transverse(fg.loaded_contact(30.0, compliance="pair"), rate="total"),
        replace(
            transverse(fg.loaded_contact(500.0, compliance="pair"), sharing="mean"),
            load=replace(LOAD, mass=0.0),
            contact=fg.Contact(path=fg.loaded_contact(500.0, compliance="pair"), rate="total"),
        ),
    ):
        assert np.isfinite(fg.growth_rate(made.system(60.0)))


def test_teeth_of_the_shaper_can_be_swept():
    model = transverse(fg.point_contact, sharing="mean")
    speeds = fg.rad_per_s(np.array([300.0, 600.0]))
    chart = fg.stability_map(model, speeds, "shaper_teeth", [27, 28], jobs=1)
    other = fg.replace_parameter(model, "body.drive.shaper_teeth", 28)
    expected = [fg.growth_rate(other.system(float(speed))) for speed in speeds]
    np.testing.assert_allclose(chart.values[1], expected, atol=1e-4)


@pytest.mark.parametrize("fields", [{"misalignment": 3}, {"material": 3}, {"correction_factor": None}])
def test_wrong_kinds(fields):
    with pytest.raises(TypeError, match=f"{next(iter(fields))} must be"):
        fg.loaded_contact(1.0, **fields)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: transverse(fg.point_contact), 'sharing must be "mean" for one load a pinion on a PointPath'),
        (
            lambda: transverse(fg.point_contact, sharing="each"),
            'sharing must be "mean" for one load a pinion on a PointPath',
        ),
        (
            lambda: transverse(fg.point_contact, sharing="mean", rate="total"),
            'load.mass must be 0 .*; else take rate "frozen"; got load.mass=1.0',
        ),
        (
            lambda: transverse(fg.loaded_contact(500.0, compliance="pair"), rate="total"),
            'load.mass must be 0 .*; else take compliance "slice" or "plate", .* or rate "frozen"; got load.mass',
        ),
        (
            lambda: fg.loaded_contact(1.0, correction_factor=2.0),
            r"correction_factor must lie in \[1e-06, 1\]",
        ),
        (lambda: fg.loaded_contact(0.0), "torque must be greater than 0"),
        (lambda: fg.loaded_contact(10.0, compliance="beam"), "compliance must be"),
        (
            lambda: fg.Contact(path=fg.loaded_contact(10.0), contact_ratio=1.5).ratio(CUT),
            "contact_ratio must be None",
        ),
        (lambda: fg.Contact(path=fg.loaded_contact(10.0)).places(DRIVE), "shaper_teeth must exceed"),
        (lambda: fg.line_contact(CUT), "contact is at a point"),
        (lambda: fg.point_contact(DRIVE), "shaper_teeth must exceed"),
        (lambda: fg.Contact(path=fg.point_contact).require(CUT), 'sharing must be "mean" or "each"'),
        (
            lambda: fg.Contact(path=fg.loaded_contact(10.0), rate="total").require(
                fg.Drive(19, 95, 3e-3, shaper_teeth=20)
            ),
            "pinion_teeth = 19 is too few",
        ),
    ],
)
def test_bad_input(call, message):
    with pytest.raises(ValueError, match=message):
        call()
