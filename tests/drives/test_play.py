"""What becomes of tongues with play: sizes that scale with the load, motions that are known from elsewhere."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from facegear.drives.play import motion_arrays, motion_from_rest, motions_in_tongues
from facegear.floquet.labels import Combination
from facegear.floquet.orbits import periodic_orbit
from facegear.floquet.response import steady_response
from facegear.maps.tracing import Tongue
from facegear.mechanics.backlash import Backlash
from facegear.mechanics.gearboxes import FIGURES
from facegear.plotting.motions import motions
from facegear.support.parameters import rad_per_s

PLAY = Backlash(FIGURES["7.12a"].model(), torque=800.0, gap=1e-4)


def tongue(peak_rpm, growth):
    low, peak, high = (float(rad_per_s(peak_rpm + away)) for away in (-1.0, 0.0, 1.0))
    return Tongue(low, high, peak, growth, Combination(1, 1, "sum", 1))


def integrated(play, speed, state, periods):
    """State after some periods and largest compression of a pair, by DOP853 piece by piece."""
    box, system, half = play.torsional.gearbox.in_si, play.system(speed).system, play.gap / 2.0
    loads, outside = system.loads, np.array([0.0, 0.0, -play.torque])
    sides = np.repeat([1.0, -1.0], len(loads) // 2)

    def pairs(x, q):
        shapes = np.array([load.shape(x % 1.0) for load in loads])
        return shapes, np.where(shapes.any(axis=1), sides * (shapes @ q) - half, -half)

    def rate(x, state):
        q, v = np.split(state, 2)
        shapes, depths = pairs(x, q)
        force = outside - box.stiffness_matrix @ q - box.damping_matrix @ v
        for load, phi, depth, side in zip(loads, shapes, depths, sides, strict=True):
            if depth > 0.0:
                through = phi @ v + load.slope(x % 1.0) @ q / system.period
                force = force - phi * (side * box.mesh_stiffness * depth + box.mesh_damping * through)
        return system.period * np.concatenate([v, np.linalg.solve(box.mass_matrix, force)])

    instants = np.append(np.ravel(np.arange(periods)[:, None] + system.breakpoints), float(periods))
    largest = -np.inf
    for start, stop in pairwise(instants):
        # Just short of the end, where shapes are still those of the piece.
        inside = np.linspace(start, stop - 1e-12, 60)
        found = solve_ivp(rate, inside[[0, -1]], state, "DOP853", inside, rtol=1e-8, atol=1e-13).y.T
        largest = max([largest, *(pairs(x, y[:3])[1].max() for x, y in zip(inside, found, strict=True))])
        state = found[-1]
    return state, largest


def test_the_principal_tongue_becomes_a_vibration_of_two_periods():
    """The chapter on play finds it by continuation, 97 µm of deformation at 640 rpm, 50 of which are the gap.

    That is the deformation of conjugate teeth; the force of a pair, and its compression, go by the printed arm.
    """
    found = motions_in_tongues(PLAY, [tongue(640.0, 190.0)], "")
    assert found.motion.values.tolist() == ["repeats every 2 periods, flanks part"]
    # 800 N m at the gear over its arm, on the stiffness of one pair.
    drive, mesh = PLAY.torsional.drive, PLAY.torsional.gearbox.in_si.mesh_stiffness
    force = 800.0 / (drive.base_radius * drive.gear_ratio)
    assert float(found.static) == pytest.approx(1e6 * force / mesh, rel=1e-12)
    orbit = motion_from_rest(PLAY, float(rad_per_s(640.0))).orbit
    assert 1e6 * PLAY.deformation(orbit, np.linspace(0.0, 1.0, 800)).max() == pytest.approx(97.0, abs=0.5)


@pytest.mark.parametrize("arm", ["printed", "conjugate"])
def test_the_largest_compression_is_that_of_a_pair_whose_force_moves_the_gearbox(arm):
    play = replace(PLAY, torsional=FIGURES["7.12a"].model(arm=arm))
    speed = float(rad_per_s(640.0))
    motion = motion_from_rest(play, speed)
    assert motion.orbit.periods == 2
    state, largest = integrated(play, speed, motion.orbit.start, 2)
    assert state == pytest.approx(motion.orbit.start, rel=1e-4, abs=1e-7 * np.abs(motion.orbit.start).max())
    assert motion.compression == pytest.approx(largest, rel=2e-3)


def test_twice_the_gap_under_twice_the_torque_is_twice_the_motion():
    one, two = (
        motions_in_tongues(replace(PLAY, torque=f * 800.0, gap=f * 1e-4), [tongue(640.0, 190.0)], "")
        for f in (1.0, 2.0)
    )
    assert two.motion.values.tolist() == one.motion.values.tolist()
    np.testing.assert_allclose(two.compression, 2.0 * one.compression, rtol=1e-6)
    np.testing.assert_allclose(two.static, 2.0 * one.static, rtol=1e-12)


@pytest.mark.slow
def test_what_grows_whatever_the_gap_is_told():
    soft = Backlash(FIGURES["7.12b"].model(), torque=800.0, gap=1e-4)
    found = motions_in_tongues(soft, [tongue(147.575, 48.7)], "")
    assert found.motion.values.tolist() == ["grows beyond a thousand times the static compression"]
    assert np.isinf(found.compression.values).all()


def test_a_motion_from_rest_under_a_large_torque_is_that_of_the_linear_gearbox():
    """With a constant arm the gap does nothing but turn gear and load on by its half."""
    play = replace(PLAY, torsional=FIGURES["7.12a"].model(arm="conjugate"))
    speed = float(rad_per_s(500.0))
    found = motion_from_rest(play, speed)
    assert found.words == "repeats each period, stays pressed"
    linear = steady_response(play.pressed(speed)).displacements(np.linspace(0.0, 1.0, 40))
    shown = motion_arrays(play, [found.orbit], 40)
    expected = play.torsional.deformation(linear) + play.gap / 2.0
    assert shown.deformation.values[0] == pytest.approx(expected, rel=1e-6)
    assert (shown.contact.values, shown.periods.values) == (0.0, 1)


def test_motions_are_in_order_of_size_and_their_rate_is_a_slope():
    near, far = (float(rad_per_s(speed)) for speed in (750.0, 700.0))
    small, large = sorted(
        (periodic_orbit(PLAY.system(speed)) for speed in (near, far)),
        key=lambda orbit: PLAY.deformation(orbit, np.linspace(0.0, 1.0, 400)).max(),
    )
    data = motion_arrays(PLAY, [large, small], 401)
    for orbit, row in zip((small, large), data.deformation.values, strict=True):
        assert row[0] == pytest.approx(float(PLAY.deformation(orbit, 0.0)), rel=1e-12)
        assert row[0] == pytest.approx(row[-1], abs=1e-12)
        period, rate = (
            orbit.system.system.period,
            PLAY.torsional.deformation(orbit.velocities(data.fraction.values)),
        )
        slope = np.gradient(row, data.fraction.values * period)
        assert np.median(np.abs(slope - rate)) < 0.02 * np.abs(rate).max()
    figure = motions(data, PLAY.gap)
    assert [axes.get_xlabel() for axes in figure.axes] == ["mesh periods", "mesh deformation [µm]"]


def test_no_tongue_is_no_row():
    assert motions_in_tongues(PLAY, [], "").sizes["tongue"] == 0


class TestRefusals:
    @pytest.mark.parametrize("wrong", [None, FIGURES["7.12a"].model()])
    def test_what_has_no_play(self, wrong):
        with pytest.raises(TypeError, match="play must be a Backlash, a gearbox whose teeth have a gap, got"):
            motion_from_rest(wrong, 70.0)

    def test_a_speed_that_takes_too_many_steps_is_told_at_once(self):
        """At 0.001 rpm it asked for 170 GiB."""
        for speed in (0.001, 5.0):
            with pytest.raises(ArithmeticError, match=r"takes .* steps in a period .*, more than 5000"):
                motion_from_rest(PLAY, float(rad_per_s(speed)))

    def test_a_tongue_that_cannot_be_followed_takes_no_others_along(self):
        slow = tongue(5.0, 1.0)
        found = motions_in_tongues(
            PLAY, [replace(slow, lower=slow.peak, upper=slow.peak), tongue(640.0, 190.0)], ""
        )
        assert found.motion.values[0].startswith("not followed: the fastest motion in contact")
        assert np.isnan(found.compression.values).tolist() == [True, False]

    def test_periods_that_are_no_multiple(self):
        with pytest.raises(ValueError, match="periods must be a multiple of 50, got 70"):
            motion_from_rest(PLAY, 70.0, periods=70)
