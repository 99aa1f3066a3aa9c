"""What becomes of tongues with play: sizes that scale with the load, motions that are known from elsewhere."""

from dataclasses import replace

import numpy as np
import pytest

from facegear.drives.play import motions_in_tongues
from facegear.floquet.labels import Combination
from facegear.maps.tracing import Tongue
from facegear.mechanics.backlash import Backlash
from facegear.mechanics.gearboxes import FIGURES
from facegear.support.parameters import rad_per_s

PLAY = Backlash(FIGURES["7.12a"].model(), torque=800.0, gap=1e-4)


def tongue(peak_rpm, growth):
    low, peak, high = (float(rad_per_s(peak_rpm + away)) for away in (-1.0, 0.0, 1.0))
    return Tongue(low, high, peak, growth, Combination(1, 1, "sum", 1))


def test_the_principal_tongue_becomes_a_vibration_of_two_periods():
    """The chapter on play finds it by continuation, 97 µm of deformation at 640 rpm, 50 of which are the gap."""
    found = motions_in_tongues(PLAY, [tongue(640.0, 190.0)], "")
    assert found.motion.values.tolist() == ["repeats every 2 periods, flanks part"]
    assert float(found.compression[0]) == pytest.approx(47.0, abs=0.5)
    # 800 N m at the gear over its arm, on the mean stiffness of 1.56 pairs and what the arm varies.
    drive, mesh = PLAY.torsional.drive, PLAY.torsional.gearbox.in_si.mesh_stiffness
    force = 800.0 / (drive.base_radius * drive.gear_ratio)
    assert float(found.at_rest) == pytest.approx(1e6 * force / (mesh * drive.contact_ratio), rel=0.05)


def test_twice_the_gap_under_twice_the_torque_is_twice_the_motion():
    one, two = (
        motions_in_tongues(replace(PLAY, torque=f * 800.0, gap=f * 1e-4), [tongue(640.0, 190.0)], "")
        for f in (1.0, 2.0)
    )
    assert two.motion.values.tolist() == one.motion.values.tolist()
    np.testing.assert_allclose(two.compression, 2.0 * one.compression, rtol=1e-6)
    np.testing.assert_allclose(two.at_rest, 2.0 * one.at_rest, rtol=1e-12)


@pytest.mark.slow
def test_what_grows_whatever_the_gap_is_told():
    soft = Backlash(FIGURES["7.12b"].model(), torque=800.0, gap=1e-4)
    found = motions_in_tongues(soft, [tongue(147.575, 48.7)], "")
    assert found.motion.values.tolist() == ["grows beyond a thousand times the compression at rest"]
    assert np.isinf(found.compression.values).all()


def test_no_tongue_is_no_row():
    assert motions_in_tongues(PLAY, [], "").sizes["tongue"] == 0
