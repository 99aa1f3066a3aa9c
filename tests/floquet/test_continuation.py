"""Families of periodic motions: folds against a closed form, ends, and what they say."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import fsolve

from facegear.floquet.arc_length import Following
from facegear.floquet.branches import Special
from facegear.floquet.clearance import ClearanceSystem
from facegear.floquet.contact_patterns import Panels
from facegear.floquet.continuation import doubled, followed, orbits_at
from facegear.floquet.multipliers import multipliers
from facegear.floquet.orbits import periodic_orbit
from facegear.floquet.transients import settled
from tests.floquet.test_orbits import ClosedForm, gear_pair, meshing

TURN = 2.0 * np.pi


@pytest.fixture(scope="module")
def resonance():
    start = periodic_orbit(gear_pair(1.0))
    return followed(gear_pair, 1.0, start, 0.4, 1.0, direction=-1.0, following=Following(longest_arc=0.3))


def test_resonance_bends_down_and_up_again(resonance):
    """Contact lost softens the spring, the back flank hardens it: a fold each, and an unstable part between them."""
    assert [point.kind for point in resonance.special] == ["fold", "fold"]
    assert resonance.ended == "at 0.4, the end of the range"
    assert resonance.parameters[-1] == 0.4
    first, second = (point.parameter for point in resonance.special)
    number = np.arange(resonance.parameters.size)
    unstable = number[~resonance.stable]
    assert (np.diff(unstable) == 1).all()
    turned = resonance.parameters[unstable[0] - 1 : unstable[-1] + 2]
    assert turned.min() == pytest.approx(first, abs=1e-3)
    assert turned.max() == pytest.approx(second, abs=1e-3)
    struck = resonance.along(lambda orbit: orbit.in_contact[1])
    assert struck[0] == 0.0
    assert struck[-1] > 0.05


def test_folds_in_closed_form(resonance):
    """Motion, repeated, and a multiplier 1: three equations of the closed form for state and frequency."""
    for point in resonance.special:
        assert np.abs(multipliers(point.orbit.linear) - 1.0).min() < 1e-6

        def equations(unknown):
            x, v, w = unknown
            exact, start, step = ClosedForm(w), np.array([x, v]), 1e-5
            ends = [
                exact.after(*(start + sign * d), TURN / w)[0]
                for d in step * np.eye(2)
                for sign in (1.0, -1.0)
            ]
            jacobian = np.array([ends[0] - ends[1], ends[2] - ends[3]]).T / (2.0 * step)
            left = exact.after(*start, TURN / w)[0] - start
            return [*left, np.linalg.det(jacobian - np.eye(2))]

        guess = [*(point.orbit.start * 1.0001), point.parameter * 1.0001]
        truth = fsolve(equations, guess, xtol=1e-11)
        assert point.parameter == pytest.approx(truth[2], abs=1e-8)
        np.testing.assert_allclose(point.orbit.start, truth[:2], atol=1e-5)


def test_three_motions_at_one_frequency(resonance):
    """Between the folds: one with contact lost, one between, one that strikes the back flank."""
    orbits = orbits_at(gear_pair, resonance, 0.46)
    assert [orbit.is_stable for orbit in orbits] == [True, False, True]
    exact = ClosedForm(0.46)
    for orbit in orbits:
        end, crossings = exact.after(*orbit.start, TURN / 0.46)
        np.testing.assert_allclose(end, orbit.start, atol=1e-9)
        assert crossings == len(orbit.pattern.crossings)
    assert [len(orbit.pattern.crossings) for orbit in orbits] == [2, 4, 4]
    assert [orbit is None for orbit in orbits_at(gear_pair, resonance, 0.9)] == [False, True, True]
    # Close to a fold, one on each side of it.
    lost, between, struck = orbits_at(gear_pair, resonance, resonance.special[0].parameter + 1e-4)
    assert lost.is_stable
    assert not between.is_stable
    assert struck.is_stable


def test_every_motion_is_one(resonance):
    for number in range(0, resonance.parameters.size, 9):
        orbit = resonance.orbits[number]
        again = periodic_orbit(gear_pair(resonance.parameters[number]), guess=orbit)
        np.testing.assert_allclose(again.start, orbit.start, atol=1e-9)
        end = orbit.state(1.0, "left")
        np.testing.assert_allclose(end, orbit.start, atol=1e-9)


def test_along_the_force_and_the_gap():
    """The motion is as large as gap and force are: families in either are one."""
    few = Following(longest_arc=0.2)
    start = periodic_orbit(gear_pair(0.8))

    def softer(force):
        return gear_pair(0.8, mean=0.1 * force, amplitude=0.05 * force)

    def narrower(gap):
        return gear_pair(0.8, gap=gap)

    by_force = followed(softer, 1.0, start, 0.8, 1.0, direction=-1.0, following=few)
    by_gap = followed(narrower, 1.0, start, 1.0, 1.25, following=few)
    np.testing.assert_allclose(by_force.orbits[-1].start * 1.25, by_gap.orbits[-1].start, atol=1e-9)
    assert by_force.ended == "at 0.8, the end of the range"
    assert by_gap.ended == "at 1.25, the end of the range"


@pytest.mark.slow
@pytest.mark.takes(10)
def test_a_closed_family_has_the_same_special_places_from_wherever_it_starts():
    """Motions of three periods under a strong force form a loop of their own."""

    def strong(frequency):
        return gear_pair(frequency, amplitude=0.6)

    found = []
    for frequency in (1.5, 1.8):
        states = settled(strong(frequency), np.random.default_rng(0).uniform(-4.0, 4.0, (60, 2)), 150, kept=4)
        again = np.abs(states[3] - states[0]).max(axis=1)
        once = np.abs(states[3] - states[2]).max(axis=1)
        start = states[3, np.flatnonzero((again < 1e-3) & (once > 0.1))[0]]
        orbit = periodic_orbit(strong(frequency), 3, start)
        branch = followed(strong, frequency, orbit, 0.8, 2.5)
        assert branch.ended == "closed upon itself"
        found.append(sorted((point.kind, point.parameter) for point in branch.special))
    first, second = found
    assert [kind for kind, _ in first] == [kind for kind, _ in second] == ["flip"] * 6 + ["fold"] * 6
    np.testing.assert_allclose([x for _, x in first], [x for _, x in second], atol=1e-7)


def test_joined_and_reversed(resonance):
    few = Following(most=4)
    start = periodic_orbit(gear_pair(1.0))
    up, down = (followed(gear_pair, 1.0, start, 0.4, 1.5, direction=d, following=few) for d in (1.0, -1.0))
    whole = down.reversed().joined(up)
    assert whole.parameters.size == 7
    assert (np.diff(whole.parameters) > 0.0).all()
    assert whole.ended.startswith("after 4 motions, at 1.")


def test_says_where_and_why_it_is_stuck():
    """A force that is another from some frequency on leaves the family nowhere to go."""

    def torn(frequency):
        return gear_pair(frequency, mean=0.1 if frequency > 1.2 else 0.2)

    few = Following(longest_arc=0.3)
    branch = followed(torn, 1.3, periodic_orbit(torn(1.3)), 0.4, 1.5, direction=-1.0, following=few)
    assert branch.ended.startswith("stuck at 1.2")
    assert branch.parameters[-1] == pytest.approx(1.2, abs=1e-4)


def test_ends_where_the_motion_has_grown():
    few = Following(largest=1.2, longest_arc=0.3)
    branch = followed(gear_pair, 1.0, periodic_orbit(gear_pair(1.0)), 0.4, 1.5, direction=-1.0, following=few)
    assert "the motion is 1.2 times as large" in branch.ended


def test_what_was_found_is_kept_where_loads_vanish():
    """Without a gap there is no back flank: the family ends before that, with a word, and not all of it is lost."""

    def gapped(gap):
        whole = gear_pair(1.5, gap=gap)
        if gap > 0.5:
            return whole
        return ClearanceSystem(replace(whole.system, loads=whole.system.loads[:1]), (1,), (gap,))

    branch = followed(gapped, 1.0, periodic_orbit(gapped(1.0)), 0.2, 1.5, direction=-1.0)
    assert branch.parameters[-1] == pytest.approx(0.5, abs=0.01)
    assert "1 coordinates and 1 loads" in branch.ended


def test_a_family_that_begins_at_the_end_of_its_range_ends_there():
    branch = followed(gear_pair, 1.5, ORBIT, 0.4, 1.5)
    assert (len(branch.orbits), branch.ended) == (1, "at 1.5, the end of the range")


ORBIT = periodic_orbit(gear_pair(1.5))


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (
            lambda: followed(3.0, 1.5, ORBIT, 0.4, 1.5),
            TypeError,
            "systems must be a function of the parameter",
        ),
        (lambda: followed(gear_pair, 1.5, 3.0, 0.4, 1.5), TypeError, "orbit must be an Orbit"),
        (lambda: followed(gear_pair, 1.5, ORBIT, 1.5, 0.4), ValueError, "low must be less than high"),
        (
            lambda: followed(gear_pair, 1.5, ORBIT, 0.4, 1.5, direction=0.0),
            ValueError,
            "direction must be greater than 0 for larger parameters or less",
        ),
        (lambda: followed(gear_pair, 1.6, ORBIT, 0.4, 1.5), ValueError, "parameter must lie in"),
        (
            lambda: followed(gear_pair, 0.7, ORBIT, 0.4, 1.5),
            ValueError,
            r"orbit must be a motion of systems\(0.7\)",
        ),
        (
            lambda: followed(lambda w: meshing().system, 1.0, ORBIT, 0.4, 1.5),
            TypeError,
            "must be a ClearanceSystem",
        ),
        (lambda: doubled(gear_pair, Special("fold", 1.5, ORBIT), 0.4, 1.5), ValueError, 'of kind "flip"'),
        (lambda: orbits_at(gear_pair, ORBIT, 1.5), TypeError, "branch must be a Branch"),
        (lambda: Following(longest_arc=2.0), ValueError, "longest_arc must lie in"),
        (lambda: Following(most=1), ValueError, "most must be at least 2"),
        (lambda: Following(largest=0.0), ValueError, "largest must be greater than 0"),
        (lambda: Following(panels=12), TypeError, "panels must be a Panels"),
        (lambda: Following(panels=Panels(nodes=50)), ValueError, "nodes must be"),
    ],
)
def test_bad_input_names_the_parameter(call, error, message):
    with pytest.raises(error, match=message):
        call()
