"""Classical systems of two coordinates: tooth pairs in mesh, sum and difference."""

import math

import numpy as np
import pytest

from facegear.floquet import multipliers as floquet
from facegear.mechanics import classical_pairs


@pytest.mark.parametrize(("contact_ratio", "pieces"), [(1.0, 1), (1.6, 2), (2.0, 1), (3.286, 2)])
@pytest.mark.parametrize("droop", [0.0, 0.4, 1.0])
def test_tooth_pairs_in_mesh(contact_ratio, pieces, droop):
    wave = classical_pairs.tooth_pair_wave(contact_ratio, droop)
    assert wave.breakpoints.size == pieces
    assert np.abs(wave.jumps()).max() == pytest.approx(
        0.0 if droop == 1.0 or pieces == 1 else 1.0 - droop, abs=1e-9
    )
    middles = (np.arange(2000) + 0.5) / 2000
    assert wave(middles).mean() == pytest.approx(contact_ratio * (1.0 - droop / 3.0), abs=1e-3)


def test_symmetric_coupling_has_the_sum_and_circulation_the_difference():
    damping = 0.02
    first, second = (math.sqrt(s) for s in np.linalg.eigvalsh([[1.0, 0.8], [0.8, 3.5]]))
    spring = classical_pairs.CoupledPair(0.6, coupling=0.8, damping=damping).system(first + second)
    assert floquet.growth_rate(spring) > 1e-3
    spring = classical_pairs.CoupledPair(0.3, coupling=0.8, damping=damping).system(second - first)
    assert floquet.growth_rate(spring) < -1e-3
    first, second = (math.sqrt(s) for s in sorted(np.linalg.eigvals([[1.0, -0.8], [0.8, 3.5]]).real))
    crossed = classical_pairs.CoupledPair(0.3, circulation=0.8, damping=damping).system(second - first)
    assert floquet.growth_rate(crossed) > 1e-3
    crossed = classical_pairs.CoupledPair(0.3, circulation=0.8, damping=damping).system(first + second)
    assert floquet.growth_rate(crossed) < -1e-3
