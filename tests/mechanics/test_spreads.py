"""Spreads of the driving force: parts of one moment, means over the period, nodes."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad_vec

import facegear as fg
from facegear.mechanics import pressed_stiffness as stiffness
from facegear.mechanics import spreads
from facegear.mechanics.cases import CASE_1
from facegear.mechanics.pressed_stiffness import pressed_stiffness
from facegear.mechanics.spreads import (
    RIM_POINT,
    ContactPoints,
    ContactPointsAt,
    FaceStrip,
    PitchPoint,
    ToothPatches,
    pitch_ratio,
    root_thickness,
)
from tests.mechanics.own_spreads import DRIVE, SHARED, assert_same


class TestPoints:
    @pytest.mark.parametrize(
        "spread",
        [
            RIM_POINT,
            PitchPoint(),
            FaceStrip(),
            FaceStrip(8e-3),
            ContactPoints(SHARED),
            ContactPointsAt(SHARED, 0.3),
            ToothPatches(ContactPoints(SHARED), FaceStrip(8e-3)),
            ContactPoints(fg.Contact(path=fg.line_contact, sharing="each")),
            ContactPoints(fg.Contact()),
        ],
    )
    def test_shares_are_of_one_moment_on_the_teeth(self, spread):
        points = spread.points(DRIVE)
        assert points.share.sum() == pytest.approx(1.0, abs=1e-12)
        assert points.share.min() > 0.0
        assert points.radius.max() < 1.002
        assert points.radius.min() > DRIVE.inner_radius / DRIVE.outer_radius - 1e-9
        # Arm of the force about the axis: r cos θ, so that the moment is ϖ F_t a.
        force = np.hypot(points.tangential, points.radial)
        moment = force * points.radius * np.cos(points.angle)
        np.testing.assert_allclose(moment, points.share, rtol=1e-12)

    def test_the_mean_over_a_period_is_that_of_its_instants(self):
        def wave(x):
            points = ContactPointsAt(SHARED, x).points(DRIVE)
            return (points.share * points.radius * np.exp(3j * points.angle)).sum()

        edges = [*SHARED.places(DRIVE)[0].position.breakpoints, 1.0]
        mean = sum(quad_vec(wave, *ends, epsabs=1e-12, epsrel=1e-12)[0] for ends in pairwise(edges))
        points = ContactPoints(SHARED).points(DRIVE)
        found = (points.share * points.radius * np.exp(3j * points.angle)).sum()
        assert abs(found - mean) < 1e-10

    def test_against_the_rotation_the_points_are_mirrored(self):
        there = ContactPoints(SHARED).points(DRIVE)
        mirrored = ContactPoints(replace(SHARED, travel="with_disk")).points(DRIVE)
        np.testing.assert_allclose(mirrored.angle, -there.angle, atol=1e-15)
        np.testing.assert_allclose(mirrored.share, there.share, atol=1e-15)

    def test_more_nodes_change_nothing(self, monkeypatch):
        spread = ToothPatches(ContactPoints(SHARED), FaceStrip(root_thickness(DRIVE)))
        few = sum(pressed_stiffness(CASE_1, 50.0, 6, (0.0,), spread))
        for name, nodes in (("_ALONG", 20), ("_ACROSS", 8), ("_IN_PIECE", 32)):
            monkeypatch.setattr(spreads, name, nodes)
        stiffness._moments.cache_clear()
        more = sum(pressed_stiffness(CASE_1, 50.0, 6, (0.0,), spread))
        stiffness._moments.cache_clear()
        assert_same(few, more)

    def test_the_pitch_circle_bears_the_moment_of_the_power(self):
        force = fg.DrivingForce(4e5, 500.0)
        moment = force.newtons(DRIVE) * pitch_ratio(DRIVE) * DRIVE.outer_radius
        assert moment == pytest.approx(4e5 / (500.0 * DRIVE.speed_ratio), rel=1e-12)
        assert PitchPoint().points(DRIVE).radius == pytest.approx(pitch_ratio(DRIVE))
