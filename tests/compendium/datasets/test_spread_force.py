"""Arrays and figures of the driving force spread over teeth."""

from dataclasses import replace

import numpy as np
import pytest

import facegear as fg
from compendium.datasets import spread_force as arrays
from compendium.plotting import spread_force as draw
from facegear.design.envelope import critical_power, disk_growth_rate
from facegear.mechanics.spreads import RIM_POINT, ContactPoints, FaceStrip, PitchPoint, ToothPatches
from tests.figures import texts

BODY = fg.Body(fg.Drive(26, 130, 3.175e-3), 0.03, nodal_circles=0, nodal_diameters=2)
SHARED = fg.Contact(path=fg.shared_load("length_share"))
SPEED = float(fg.rad_per_s(5000.0))
HELD = fg.Transverse(BODY, fg.MeshLoad(1.0, 3e-6, 1.0), force=fg.DrivingForce(1e5, SPEED))


def spreads(drive):
    return {"rim": RIM_POINT, "pitch": PitchPoint(), "face": FaceStrip()}


@pytest.fixture(scope="module")
def changes():
    return arrays.stiffness_changes(
        {"a": BODY, "b": replace(BODY, thickness_ratio=0.04)}, spreads, SPEED, 50.0
    )


def test_changes_are_over_what_the_rim_has(changes):
    at_rim = changes.isel(spread=0)
    np.testing.assert_allclose(at_rim.dead, 1.0)
    np.testing.assert_allclose(at_rim.following, 1.0)
    np.testing.assert_allclose(at_rim.change, 0.0)
    assert float(changes.critical[0, 2]) == critical_power(BODY, SPEED, 50.0, spread=FaceStrip())
    # Power goes with the fourth power of the thickness (chapter 6), whatever the spread.
    np.testing.assert_allclose(changes.first_order[1], changes.first_order[0] * (4 / 3) ** 4, rtol=1e-9)
    np.testing.assert_allclose(changes.dead[1], changes.dead[0], rtol=1e-9)


def test_tilt_at_a_radius_is_what_a_point_there_makes_of_the_power(changes):
    tilt = arrays.tilt_along_face({"a": BODY}, samples=5)
    np.testing.assert_allclose(tilt.tilt[..., -1], 1.0)
    np.testing.assert_allclose(tilt.tilt[..., 0], 0.0, atol=1e-12)
    fine = arrays.tilt_along_face({"a": BODY}, samples=4001)
    at = np.interp(PitchPoint().points(BODY.drive).radius[0], fine.radius[0], fine.tilt[0, 0])
    ratio = float(changes.first_order[0, 0, 0] / changes.first_order[0, 1, 0])
    assert at == pytest.approx(ratio, rel=1e-5)


def test_a_force_that_follows_in_part_lies_between_following_and_dead():
    data = arrays.partly_following({"a": BODY}, spreads, SPEED, 50.0, [0.0, 0.5, 1.0])
    critical = data.critical.values[0]
    for row, spread in zip(critical, spreads(BODY.drive).values(), strict=True):
        assert row[2] == pytest.approx(critical_power(BODY, SPEED, 50.0, spread=spread), rel=1e-9)
        dead = critical_power(BODY, SPEED, 50.0, spread=spread, following="dead")
        assert row[0] == pytest.approx(dead, rel=1e-9)
        assert row[1] == pytest.approx(2 * row[2], rel=0.02)
    shown = texts(draw.partly_following(data))
    assert all(words in shown for words in ("a", "rim", "face"))


def test_maps_hold_growth_rates_of_single_cells():
    data = arrays.power_maps(HELD, spreads(BODY.drive), [1e5, 2e5], [500.0, 600.0], [0.5, 1.0], jobs=1)
    force = fg.DrivingForce(2e5, SPEED, "dead", spread=FaceStrip())
    cell = fg.growth_rate(replace(HELD, force=force).system(float(fg.rad_per_s(600.0))))
    assert float(data.dead[2, 1, 1, 1]) == pytest.approx(cell, abs=1e-6)
    cell = fg.growth_rate(
        replace(HELD, force=replace(force, following="follower")).system(float(fg.rad_per_s(600.0)))
    )
    assert float(data.growth_rate[2, 1, 1, 1]) == pytest.approx(cell, abs=1e-6)
    shown = texts(draw.power_maps(data))
    assert all(words in shown for words in ("134 hp, rim", "268 hp, face", "growth rate [1/s]"))


def test_the_mean_over_a_period_gives_what_the_model_gives():
    model = replace(HELD, contact=SHARED)
    teeth = ToothPatches(ContactPoints(replace(SHARED, sharing="each")))
    sought = replace(model, force=replace(model.force, spread=teeth)).system(float(fg.rad_per_s(600.0)))
    data = arrays.within_the_period(model, FaceStrip(), [600.0], sub_intervals=12)
    assert float(data["mean"][0]) == pytest.approx(fg.growth_rate(sought), rel=1e-2)
    finer = arrays.within_the_period(model, FaceStrip(), [600.0], sub_intervals=48)
    # The steps are of fourth order; what is left is speed, which K_f leaves out here.
    assert float(finer["mean"][0]) == pytest.approx(fg.growth_rate(sought), rel=1e-4)
    assert 0.0 < float(data.departure.min()) < float(data.departure.max()) < 0.1
    assert float(finer.moving[0]) != pytest.approx(float(finer["mean"][0]), rel=2e-5)


def test_tilt_is_drawn_for_every_body_and_mode():
    bodies = {"thin": BODY, "thick": replace(BODY, thickness_ratio=0.05)}
    shown = texts(draw.tilt_along_face(arrays.tilt_along_face(bodies)))
    assert all(words in shown for words in ("thin", "thick", "1 nodal diameter", "2 nodal diameters"))


def test_a_disk_that_nothing_makes_flutter_has_no_critical_power():
    still = replace(BODY, nodal_diameters=0)
    data = arrays.partly_following({"a": still}, lambda drive: {"rim": RIM_POINT}, SPEED, 50.0, [0.5])
    assert np.isinf(data.critical.values).all()
    assert disk_growth_rate(still, fg.DrivingForce(1e9, SPEED), 50.0) < 0.0
