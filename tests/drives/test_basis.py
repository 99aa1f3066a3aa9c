"""Bases that are raised until unstable speeds stand still."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from facegear.drives.basis import disagreement, settled_tongues, unstable_share, with_basis
from facegear.drives.drive_file import read_drive_file
from facegear.floquet.labels import Combination
from facegear.maps.tracing import Tongue, tongues
from facegear.mechanics.edge_stiffness import DrivingForce
from facegear.support.parameters import rad_per_s
from tests.independent.complex_galerkin import multipliers
from tests.independent.make_anchors_ch04 import nominal_mass, pinion
from tests.mechanics.test_transverse import complex_disk

DRIVES = Path(__file__).resolve().parents[2] / "data" / "drives"
CASE_1 = read_drive_file(DRIVES / "case_1.yaml").transverse
TWO_GEARS = read_drive_file(DRIVES / "two_gears.yaml").transverse


def interval(low, high):
    return Tongue(low, high, (low + high) / 2, 1.0, Combination(1, 1, "sum", 1))


class TestDisagreement:
    def test_counts_speeds_at_which_only_one_is_unstable(self):
        first, second = (interval(1, 2), interval(4, 5)), (interval(1.5, 2.5), interval(7, 8))
        assert disagreement(first, second, (0.0, 10.0)) == pytest.approx((0.5 + 0.5 + 1 + 1) / 10)
        assert disagreement(second, first, (0.0, 10.0)) == pytest.approx(0.3)
        assert disagreement(first, (), (0.0, 10.0)) == unstable_share(first, (0.0, 10.0)) == 0.2

    def test_of_equal_ones_is_nothing(self):
        found = (interval(1, 2), interval(4, 5))
        assert disagreement(found, found, (0.0, 10.0)) == 0.0

    def test_of_one_cut_in_two_is_the_gap(self):
        assert disagreement(
            (interval(1, 5),), (interval(1, 2), interval(3, 5)), (0.0, 10.0)
        ) == pytest.approx(0.1)


class TestWithBasis:
    def test_keeps_the_bearing_in_newtons_per_metre(self):
        richer = with_basis(CASE_1, 2, 5)
        assert richer.bearing_stiffness == pytest.approx(CASE_1.bearing_stiffness, rel=1e-12)
        assert richer.bearing_damping == pytest.approx(CASE_1.bearing_damping, rel=1e-12)
        assert richer.pinion_mass == CASE_1.pinion_mass
        assert richer.load.stiffness > CASE_1.load.stiffness
        assert richer.system(50.0).size == 33

    def test_keeps_complete_harmonics_complete(self):
        for harmonics, expected in ((5, 5), (6, 10)):
            driven = replace(CASE_1, force=DrivingForce(4e5, 500.0, harmonics=harmonics))
            assert with_basis(driven, 2, 5).force.harmonics == expected

    def test_keeps_both_gears_and_what_their_pinions_do(self):
        richer = with_basis(TWO_GEARS, 2, 5)
        assert richer.roles == TWO_GEARS.roles
        assert richer.gear == with_basis(TWO_GEARS.gear, 2, 5)
        assert richer.system(50.0).size == 2 * 33 + 2

    @pytest.mark.slow
    def test_agrees_with_complex_modes_integrated_by_an_independent_route(self):
        model, speed = with_basis(CASE_1, 2, 5), float(rad_per_s(510.0))
        system = model.system(speed)
        found = multipliers(
            complex_disk(model.body),
            [pinion(model.body, None, 1)],
            speed,
            system.period,
            m_p=nominal_mass(model.body),
            c_b=3e-6 * CASE_1.bearing_stiffness,
            k_b=CASE_1.bearing_stiffness,
        )
        (tongue,) = tongues(model, (float(rad_per_s(505.0)), float(rad_per_s(515.0))))
        # Unstable here with five nodal diameters, stable with the printed three.
        assert np.abs(found).max() > 1.0
        assert tongue.lower < speed < tongue.upper
        assert not tongues(CASE_1, (float(rad_per_s(505.0)), float(rad_per_s(515.0))))


class TestSettledTongues:
    RANGE = (float(rad_per_s(495.0)), float(rad_per_s(520.0)))

    def test_a_verdict_of_the_printed_basis_that_turns(self):
        found = settled_tongues(CASE_1, self.RANGE, tolerance=0.05, most_steps=2)
        first, last = found.steps
        assert not first.tongues
        assert np.isnan(first.moved)
        assert last.tongues
        # Two bases that disagree on the verdict never settle, however wide the tolerance.
        assert not found.settled
        assert not settled_tongues(CASE_1, self.RANGE, tolerance=0.5, most_steps=2).settled
        assert found.tongues == last.tongues
        assert found.unstable_share == pytest.approx(last.moved)
        assert found.model.body.nodal_diameters == 5
        again = settled_tongues(CASE_1, self.RANGE, first.tongues, tolerance=0.05, most_steps=2)
        assert again.steps[0].tongues == first.tongues
        assert again.tongues == found.tongues
        # What is known is believed.
        told = settled_tongues(CASE_1, self.RANGE, last.tongues, most_steps=1)
        assert told.tongues == last.tongues

    def test_settles_where_nothing_moves(self):
        quiet = (float(rad_per_s(960.0)), float(rad_per_s(990.0)))
        found = settled_tongues(CASE_1, quiet, most_steps=3)
        assert found.settled
        assert [(step.nodal_circles, step.nodal_diameters) for step in found.steps] == [(1, 3), (1, 5)]
        assert found.steps[-1].moved == 0.0

    @pytest.mark.slow
    def test_the_largest_basis_is_the_end(self):
        largest = with_basis(CASE_1, 4, 10)
        narrow = (float(rad_per_s(980.0)), float(rad_per_s(981.0)))
        found = settled_tongues(largest, narrow, most_steps=5)
        assert len(found.steps) == 1
        assert not found.settled

    @pytest.mark.parametrize(
        ("named", "argument"), [("tolerance", {"tolerance": 0.0}), ("most_steps", {"most_steps": 0})]
    )
    def test_refuses_what_has_no_meaning(self, named, argument):
        with pytest.raises(ValueError, match=named):
            settled_tongues(CASE_1, self.RANGE, **argument)
