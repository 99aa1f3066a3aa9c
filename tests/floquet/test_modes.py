"""Natural motions against the equation that they solve."""

import numpy as np
import pytest

from facegear.floquet.modes import NaturalMotions, natural_exponents

RNG = np.random.default_rng(3)
N = 4
SQUARE = RNG.normal(size=(3, N, N))
MASS = SQUARE @ SQUARE.swapaxes(-1, -2) + np.eye(N)
# Gyroscopic, damped, circulatory, and of frequencies far apart.
DAMPING = RNG.normal(size=(3, N, N))
STIFFNESS = RNG.normal(size=(3, N, N)) + np.diag([1.0, 10.0, 1e3, 1e5])


def test_motions_of_several_systems_solve_their_equations():
    motions = NaturalMotions.of(MASS, DAMPING, STIFFNESS)
    p, q = motions.exponents[:, np.newaxis], motions.displacements
    terms = [MASS @ q * p**2, DAMPING @ q * p, STIFFNESS @ q]
    size = sum(np.abs(term).max(axis=1) for term in terms)
    assert (np.abs(sum(terms)).max(axis=1) < 1e-10 * size).all()
    assert motions.velocities == pytest.approx(q * p, abs=1e-9 * np.abs(q * p).max())
    state = np.concatenate([q, motions.velocities], axis=1)
    assert motions.amplitudes @ motions.from_state @ state == pytest.approx(
        np.broadcast_to(np.eye(2 * N), (3, 2 * N, 2 * N)), abs=1e-9
    )
    # A force of short duration changes the velocity by M⁻¹ of it.
    kick = np.concatenate([np.zeros((3, N, N)), np.linalg.inv(MASS)], axis=1)
    assert motions.of_forces(motions.amplitudes) == pytest.approx(
        motions.amplitudes @ motions.from_state @ kick, abs=1e-9
    )


def test_exponents_alone_are_those_of_the_motions():
    for number in range(3):
        one = (MASS[number], DAMPING[number], STIFFNESS[number])
        both = (np.sort_complex(x) for x in (natural_exponents(*one), NaturalMotions.of(*one).exponents))
        assert np.abs(np.subtract(*both)).max() < 1e-9


def test_a_body_that_nothing_holds_drifts():
    assert np.abs(natural_exponents(np.eye(2), np.zeros((2, 2)), np.zeros((2, 2)))).max() == 0.0
