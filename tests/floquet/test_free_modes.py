"""Modes of the free motion: those of the state matrix, refused where they do not oscillate or are dependent."""

import numpy as np
import pytest
from scipy.linalg import expm

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


def shuffled_parts(rng):
    """Mass, damping and stiffness of parts of one, two and four coordinates that are not coupled, in no order."""
    sizes = [1, 2, 2, 4, 4, 4, 4, 4, 4]
    order = rng.permutation(sum(sizes))
    found = np.zeros((3, order.size, order.size))
    start = 0
    for size in sizes:
        here = order[start : start + size]
        roots = rng.normal(size=(2, size, size))
        turning = rng.normal(size=(size, size))
        spin = 0.1 * (turning - turning.T)
        found[0][np.ix_(here, here)] = np.eye(size) + 0.1 * roots[0] @ roots[0].T
        found[1][np.ix_(here, here)] = 0.02 * np.eye(size) + spin
        found[2][np.ix_(here, here)] = np.diag(rng.uniform(1.0, 9.0, size)) + 0.1 * roots[1] @ roots[1].T
        start += size
    return found


def test_parts_that_are_not_coupled_move_as_the_matrix_exponential_says():
    systems = [shuffled_parts(np.random.default_rng(3)) for _ in range(2)]
    systems[1][2] *= 1.5
    modes = FreeModes.of_matrices(*np.stack(systems, axis=1))
    for number, (mass, damping, stiffness) in enumerate(systems):
        n = len(mass)
        state = np.block(
            [
                [np.zeros((n, n)), np.eye(n)],
                [-np.linalg.solve(mass, stiffness), -np.linalg.solve(mass, damping)],
            ]
        )
        both = np.concatenate([modes.displacement[number], modes.velocity[number]])
        turned = np.exp(1.7 * modes.eigenvalues[number])[:, np.newaxis] * modes.coordinates[number]
        assert np.abs((both @ turned).real - expm(1.7 * state)).max() < 1e-10
        by_force = modes.input[number] @ mass - modes.coordinates[number][:, n:]
        assert np.abs(by_force).max() < 1e-10


def test_one_part_that_does_not_oscillate_is_enough_to_refuse():
    mass, damping, stiffness = shuffled_parts(np.random.default_rng(3))
    damping = damping + 20.0 * (np.count_nonzero(stiffness, axis=1) == 1) * np.eye(len(mass))
    with pytest.raises(UnsuitableSystemError, match="28 oscillating modes, not 29"):
        FreeModes.of_matrices(mass, damping, stiffness)
