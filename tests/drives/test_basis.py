"""Bases that are raised until unstable speeds stand still."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from facegear.drives import basis
from facegear.drives.basis import (
    BasisStep,
    SettledTongues,
    disagreement,
    settled_tongues,
    unstable_share,
    with_basis,
    within,
)
from facegear.drives.drive_file import parse_drive, read_drive_file
from facegear.drives.variants import plain_contacts
from facegear.drives.verdict import driven
from facegear.floquet.labels import Combination
from facegear.floquet.multipliers import growth_rate
from facegear.maps.tracing import Searched, Tongue, tongues
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
        known = basis.found_around(CASE_1, self.RANGE)
        again = settled_tongues(CASE_1, self.RANGE, known, tolerance=0.05, most_steps=2)
        assert again.steps[0].tongues == first.tongues
        assert again.tongues == found.tongues
        # What is known is believed.
        told = settled_tongues(CASE_1, self.RANGE, replace(known, tongues=last.tongues), most_steps=1)
        assert told.tongues == last.tongues

    def test_settles_where_nothing_moves(self):
        quiet, thick = (
            (float(rad_per_s(960.0)), float(rad_per_s(990.0))),
            replace(CASE_1.body, thickness_ratio=0.1),
        )
        found = settled_tongues(replace(CASE_1, body=thick), quiet, most_steps=4)
        assert found.settled
        assert found.steps[-1].moved == 0.0

    def test_bases_without_the_modes_that_the_mesh_excites_agree_on_nothing(self):
        # Without nodal diameters two bases have no tongue, and none of their modes is as fast as the mesh. With (1, 4)
        # growth is 26.4 1/s at 661.6 rpm, by integration (DOP853); DOP853 has it so in (1, 6) too, less.
        file = parse_drive(
            "name: no diameters\n"
            "gears: {pinion_teeth: 26, gear_teeth: 130, module_mm: 3.175}\n"
            "body: {thickness_ratio: 0.03, bore_radius_mm: 50, nodal_diameters: 0, nodal_circles: 0}\n"
            "material: {viscous_loss_factor_us: 2}\n"
            "pinions: {stiffness: 0.065, damping_us: 3, mass: 1}\n"
            "operation: {lowest_speed_rpm: 655, highest_speed_rpm: 670, power_kW: 5, pinion_speed_rpm: 5000}\n"
        )
        model, speeds = (
            driven(file, "follower", plain_contacts(file)["Tregold"]),
            file.requirements.speeds,
        )
        found = settled_tongues(model, speeds, most_steps=2)
        assert [step.reaches for step in found.steps] == [False, True]
        assert not found.steps[0].tongues
        assert not found.settled
        (tongue,) = found.tongues
        assert tongue.lower < rad_per_s(661.6) < tongue.upper
        assert growth_rate(with_basis(model, 1, 4).system(float(rad_per_s(661.6)))) == pytest.approx(
            26.4, abs=0.05
        )

    @pytest.mark.parametrize("highest", [1000.0, 3000.0])
    def test_the_last_basis_has_all_modes_up_to_the_mesh_frequency_if_any_has(self, highest):
        speed = float(rad_per_s(highest))
        circles, diameters = basis._bases(CASE_1.body, 2, speed)[-1]
        body = replace(CASE_1.body, nodal_circles=4, nodal_diameters=10)
        below = np.argwhere(body.natural_frequencies_hz() < 130 * highest / 60)
        assert (below <= (circles, diameters)).all()
        # At 3000 rpm modes beyond those of the largest basis are below it too.
        reaches = min(basis._lowest_left_out(CASE_1.body, circles, diameters, speed)) >= 1.0
        assert reaches == (highest == 1000.0)

    def test_a_tongue_beside_a_narrow_range_that_comes_nearer_asks_for_more(self):
        # Nothing is unstable here with up to seven nodal diameters; with nine it is all of it.
        file = parse_drive(
            "name: fourteen teeth\n"
            "gears: {pinion_teeth: 14, gear_teeth: 23, module_mm: 5, shaft_angle_deg: 110, pressure_angle_deg: 20}\n"
            "body: {thickness_ratio: 0.02, bore_radius_mm: 15}\n"
            "pinions: {stiffness: 0.2, damping_us: 0.5, mass: 1, angles_deg: [0]}\n"
            "operation: {lowest_speed_rpm: 2764, highest_speed_rpm: 2770, power_kW: 1, pinion_speed_rpm: 6000}\n"
        )
        model, speeds = driven(file, "dead", plain_contacts(file)["true sweep"]), file.requirements.speeds
        few = settled_tongues(model, speeds, most_steps=2)
        assert [step.tongues for step in few.steps] == [(), ()]
        assert not few.settled
        assert growth_rate(with_basis(model, 2, 9).system(sum(speeds) / 2.0)) > 0.0

    def test_a_border_outside_of_the_range_may_move_on_and_uncover_or_cover_it(self):
        narrow = (10.0, 10.1)
        for before, found, stands in (
            ((interval(11.0, 12.0),), (interval(10.5, 12.0),), False),  # comes from above
            ((interval(11.0, 12.0),), (interval(10.9, 12.0),), True),
            ((interval(8.0, 9.0),), (interval(8.0, 9.6),), False),  # from below
            ((interval(9.0, 13.0),), (interval(9.0, 11.0),), False),  # uncovers it
            ((interval(9.0, 11.1),), (interval(9.0, 11.0),), True),
            # What comes from one side does not make up for what goes.
            ((interval(9.0, 13.0),), (interval(9.0, 11.0), interval(12.0, 13.0)), False),
            # One that is new and narrow, and far from the range; one that has moved by more than its width.
            ((interval(8.0, 9.0),), (interval(8.0, 9.0), interval(12.0, 12.5)), True),
            ((interval(11.5, 11.6),), (interval(11.0, 11.1),), False),
            ((), (interval(10.5, 12.0),), False),
            # One beside the range that is gone, though another has stayed.
            ((interval(8.0, 9.0), interval(11.0, 12.0)), (interval(8.0, 9.0),), False),
            ((), (), True),
        ):
            assert basis._stands_still(before, found, narrow, 0.02) is stands

    def test_no_tongue_in_two_bases_is_none_only_if_decay_stands_still_too(self):
        """Stable in (1, 7) and in (2, 9), by 0.6 and 0.05 1/s; in the largest basis it grows."""
        file = parse_drive(
            "name: hidden\n"
            "gears: {pinion_teeth: 26, gear_teeth: 130, module_mm: 3.175}\n"
            "body: {thickness_ratio: 0.03, bore_radius_mm: 50}\n"
            "pinions: {stiffness: 1.2, damping_us: 3, mass: 1.0}\n"
            "operation: {lowest_speed_rpm: 544, highest_speed_rpm: 564, power_kW: 1, pinion_speed_rpm: 2700}\n"
        )
        model, speeds = driven(file, "dead", plain_contacts(file)["Tregold"]), file.requirements.speeds
        few = settled_tongues(with_basis(model, 1, 5), speeds, most_steps=3)
        assert [step.tongues for step in few.steps] == [(), (), ()]
        assert not few.settled
        # By another method, and without any scan.
        assert growth_rate(with_basis(model, 4, 10).system(float(rad_per_s(551.5)))) == pytest.approx(
            0.162, abs=2e-3
        )

    def test_how_near_to_growing_two_bases_without_a_tongue_may_be(self):
        speeds = (10.0, 20.0)
        for was, now, may in (
            (-1.0, -0.9, False),
            (-1.0, -0.7, False),
            (-1.0, -0.6, True),
            (-0.6, -1.0, False),
            (-0.1, -1.0, True),
            (-1e-9, -2e-9, False),  # undamped
            (-1.0, -1e-9, True),
        ):
            before, found = (
                Searched((), np.array([9.0, 15.0, 21.0]), np.array([5.0, rate, 5.0])) for rate in (was, now)
            )
            assert basis.may_grow(before, found, speeds) is may
            with_one = replace(found, tongues=(interval(12.0, 13.0),))
            assert basis.may_grow(before, with_one, speeds) is False

    def test_a_wide_range_without_a_tongue_is_looked_at_beyond_its_ends(self, monkeypatch):
        asked = []

        def looked_at(model, speeds, hints=()):
            asked.append(speeds)
            found = (interval(109.0, 111.0),) if speeds[0] == 100.0 else ()
            return Searched(found, np.array(speeds), np.array([-1.0, -2.0]))

        monkeypatch.setattr(basis, "looked_at", looked_at)
        found = basis.found_around(None, (10.0, 100.0))
        assert found.tongues == (interval(109.0, 111.0),)
        assert found.speeds.tolist() == [10.0, 100.0]
        assert asked == [
            (10.0, 100.0),
            (pytest.approx(10.0 / 1.1), 10.0),
            (100.0, pytest.approx(110.0)),
        ]
        asked.clear()
        basis.found_around(None, (99.0, 101.0))
        ((low, high),) = asked
        assert (high / low, low * high) == (pytest.approx(1.5), pytest.approx(99.0 * 101.0))

    def test_a_narrow_range_that_is_all_unstable_asks_for_growth_that_has_settled(self):
        narrow, wide = (10.0, 10.5), (10.0, 20.0)
        for speeds, rates, opens in (
            (narrow, (5.0, 4.0), True),
            (narrow, (4.2, 4.0), False),
            (wide, (5.0, 4.0), False),
        ):
            steps = tuple(BasisStep(1, 3, (replace(interval(*speeds), growth_rate=r),), 0.0) for r in rates)
            assert SettledTongues(CASE_1, speeds, steps, settled=True).may_open is opens

    def test_of_a_part_of_a_tongue_the_largest_growth_there_is_found_and_named(self):
        # Two resonances have grown together, and the part has the slope of one and the peak of the other.
        low, high = (float(rad_per_s(value)) for value in (560.0, 700.0))
        (whole, *_) = found = tongues(CASE_1, (low, high))
        middle = (whole.lower + whole.upper) / 2.0
        for speeds in ((low, middle), (middle, high)):
            for part in within(CASE_1, found, speeds):
                tried = [
                    growth_rate(CASE_1.system(speed)) for speed in np.linspace(part.lower, part.upper, 101)
                ]
                assert part.growth_rate >= max(tried) * (1.0 - 1e-6)
                assert speeds[0] <= part.lower <= part.peak <= part.upper <= speeds[1]
                assert growth_rate(CASE_1.system(part.peak)) == pytest.approx(part.growth_rate, rel=1e-9)

    def test_growth_that_moves_is_told(self):
        steps = tuple(
            BasisStep(1, n, (replace(interval(1, 2), growth_rate=rate),), 0.0)
            for n, rate in ((3, 5.0), (5, 4.0))
        )
        found = SettledTongues(CASE_1, (1.0, 3.0), steps, settled=True)
        assert found.growth_moved == pytest.approx(0.25)
        assert np.isnan(replace(found, steps=steps[:1]).growth_moved)

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
