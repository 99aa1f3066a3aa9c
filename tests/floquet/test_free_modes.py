"""Modes of the free motion: those of the state matrix, refused where they do not oscillate or are dependent."""

import numpy as np
import pytest

from benchmarks.synthetic_disk import synthetic_disk
from facegear.floquet.free_modes import FreeModes, UnsuitableSystemError
from facegear.floquet.multipliers import multipliers
from facegear.floquet.periodic import PeriodicSystem


@pytest.mark.parametrize(
    ("damping", "stiffness", "message"),
    [
        ([[10.0, 0.0], [0.0, 0.1]], np.eye(2), "overdamped"),
        (np.diag([0.0, 50.0]), [[1.0, 0.0], [0.0, 0.0]], "rigid-body"),
        (np.zeros((2, 2)), [[1.0, 1.0], [0.0, 1.0]], "dependent"),
    ],
)
def test_unsuitable_free_motion_is_refused_with_a_reason(damping, stiffness, message):
    system = PeriodicSystem(np.eye(2), damping, stiffness, (), 1.0)
    with pytest.raises(UnsuitableSystemError, match=message):
        FreeModes.of(system)
    assert np.isfinite(multipliers(system)).all()


def test_free_modes_are_those_of_the_disk():
    system = synthetic_disk(300.0 * np.pi / 30.0, [])
    modes = FreeModes.of(system)
    state = system.state_matrix(0.0)
    both = np.concatenate([modes.displacement, modes.velocity])
    residual = np.linalg.norm(state @ both - both * modes.eigenvalues, axis=0)
    assert (residual < 1e-9 * np.linalg.norm(state @ both, axis=0)).all()
    assert np.abs(modes.state_from_real() @ modes.real_from_state() - np.eye(28)).max() < 1e-10
