"""Points of one's own: what they may be, and what is said of those that they may not be."""

from dataclasses import replace

import numpy as np
import pytest

import facegear as fg
from facegear.design.envelope import mode_critical_powers
from facegear.mechanics.cases import CASE_1
from facegear.mechanics.pressed_points import PressedPoints, Spread
from facegear.mechanics.pressed_stiffness import pressed_stiffness
from facegear.mechanics.spreads import (
    ContactPointsAt,
)
from tests.mechanics.own_spreads import DRIVE, SHARED, Moved, Own, assert_same


class TestPointsOfOnesOwn:
    LOAD = fg.MeshLoad(1.0, 3e-6, 1.0)
    FORCE = fg.DrivingForce(3e5, 523.6)

    def test_lists_are_as_good_as_arrays(self):
        points = PressedPoints([0.9, 1], (0.0, 0.1), [0.25, 0.75])
        assert {column.dtype for column in (points.radius, points.angle, points.share)} == {np.dtype(float)}
        own = pressed_stiffness(CASE_1, 50.0, 6, (0.0,), Own((0.9, 1), (0, 0.1), (0.25, 0.75)))
        moved = pressed_stiffness(CASE_1, 50.0, 6, (0.0,), Moved([0.9, 1.0], [0.0, 0.1], [0.25, 0.75]))
        assert_same(sum(own), sum(moved), 1e-13)

    def test_a_pair_without_load_presses_nowhere(self):
        for instant in (*SHARED.places(DRIVE)[0].position.breakpoints, 1.0):
            points = ContactPointsAt(SHARED, float(instant)).points(DRIVE)
            assert points.share.min() > 0.0
            assert points.share.sum() == pytest.approx(1.0, abs=1e-12)

    @pytest.mark.parametrize(
        ("own", "error", "told"),
        [
            (Own(share=(2.0,)), ValueError, "share must have the sum 1, of one moment, got 2"),
            (Own((1.0, 1.0), (0.0, 0.1), (1.5, -0.5)), ValueError, "share must be greater than 0 .*got -0.5"),
            (Own(share=(np.nan,)), ValueError, "share must be finite, got an entry nan"),
            (Own(angle=(np.inf,)), ValueError, "angle must be finite, got an entry inf"),
            (
                Own(angle=(20.0,)),
                ValueError,
                r"angle must be less than .*got 20 rad \(radians, not degrees\?\)",
            ),
            (Own(radius=(231.9,)), ValueError, r"radius must be .* got 231\.9 \(a ratio, not m or mm\?\)"),
            (Own(radius=(0.0,)), ValueError, "radius must be .* got 0 "),
            (
                Own((1.0, 0.9), (0.0,), (1.0,)),
                ValueError,
                r"of one length, .*got the shapes \(2,\), \(1,\), \(1,\)",
            ),
            (Own((), (), ()), ValueError, "radius, angle and share must be lists .* of at least one point"),
            (Own(1.0, 0.0, 1.0), ValueError, "radius, angle and share must be lists"),
            (Own(radius=("rim",)), TypeError, "radius must be real numbers"),
        ],
    )
    def test_what_they_may_not_be_is_named_with_the_model(self, own, error, told):
        with pytest.raises(error, match=told):
            fg.Transverse(CASE_1, self.LOAD, force=replace(self.FORCE, spread=own))

    def test_points_in_the_bore_are_refused(self):
        bore = Own(radius=(0.9 * CASE_1.bore_ratio,))
        told = r"radius of Own.points must be r over the outer radius, at least that of the bore, .* not m or mm\?"
        with pytest.raises(ValueError, match=told):
            pressed_stiffness(CASE_1, 50.0, 6, (0.0,), bore)
        with pytest.raises(ValueError, match=told):
            mode_critical_powers(CASE_1, 523.6, bore)

    def test_something_else_than_points_is_refused(self):
        class Loose(Spread):
            def points(self, drive):
                return [1.0], [0.0], [1.0]

        with pytest.raises(
            TypeError, match=r"Loose\.points must return PressedPoints\(radius, angle, share\), got"
        ):
            pressed_stiffness(CASE_1, 50.0, 6, (0.0,), Loose())
