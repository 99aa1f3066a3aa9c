"""Small systems with known parametric resonances."""

import functools

import numpy as np
from hypothesis import settings
from hypothesis import strategies as st

from facegear.floquet.loads import ContactLoad
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from tests.independent.monodromy import TURN

CHECK = settings(deadline=None, derandomize=True, max_examples=25)


@functools.cache
def wave(function):
    return PiecewiseChebyshev.fit(lambda x, piece: function(TURN * x), [0.0])


def load(shape, strength, function, kind="stiffness"):
    """Load of constant shape whose stiffness or damping is strength × function(ωt)."""
    return ContactLoad(
        PiecewiseChebyshev.constant(np.array(shape)), **{kind: strength}, weight=wave(function)
    )


def mathieu(modulation, damping=0.0):
    return PeriodicSystem([[1.0]], [[damping]], [[1.0]], [load([1.0], modulation, np.cos)], 1.0)


def by_label(bands):
    assert len({band.label for band in bands}) == len(bands)
    return {band.label: band for band in bands}


PHI = np.array([[0.8, 0.6], [-0.6, 0.8]])


def coupled_matrices(modulation, damping, velocity=False):
    """Natural frequencies 1 and √5 in turned coordinates, a cosine on the first coordinate."""
    mean = PHI @ np.diag([1.0, 5.0]) @ PHI.T

    def matrices(phase):
        periodic = np.diag([modulation * np.cos(phase), 0.0])
        if velocity:
            return np.eye(2), damping * np.eye(2) + periodic, mean
        return np.eye(2), damping * np.eye(2), mean + periodic

    kind = "damping" if velocity else "stiffness"
    system = PeriodicSystem(
        np.eye(2), damping * np.eye(2), mean, [load([1.0, 0.0], modulation, np.cos, kind)], 1.0
    )
    return matrices, system


MESH = np.array([1.0, -0.7])
SHAFTS = np.diag([1.0, 2.5])
CONTACT = 0.6


def gear_pair(size, damping):
    """Mesh stiffness 1 + size over 0.6 of the period and 1 − size over the rest, on two sprung inertias."""
    weight = PiecewiseChebyshev.fit(
        lambda x, piece: np.full_like(x, 1.0 if piece == 0 else -1.0), [0.0, CONTACT]
    )
    shape = PiecewiseChebyshev.constant(MESH)
    loads = [ContactLoad(shape, stiffness=size, weight=weight)]
    return PeriodicSystem(np.eye(2), damping * np.eye(2), SHAFTS + np.outer(MESH, MESH), loads, 1.0)


def disk(rotation, size, damping=0.0):
    """One pair of nodal diameter waves at ω0 = 1, turning at `rotation`, sprung periodically at one point."""
    gyroscopic = 2 * rotation * np.array([[0.0, 1.0], [-1.0, 0.0]]) + damping * np.eye(2)
    mean = (1 - rotation**2) * np.eye(2)
    system = PeriodicSystem(np.eye(2), gyroscopic, mean, [load([1.0, 0.0], size, np.cos)], 1.0)

    def matrices(phase):
        return np.eye(2), gyroscopic, mean + np.diag([size * np.cos(phase), 0.0])

    return matrices, system


entry = st.floats(-1.0, 1.0)


@st.composite
def symmetric_systems(draw, damped):
    n = draw(st.integers(2, 4))
    frequencies = np.cumsum([draw(st.floats(0.3, 1.5)) for _ in range(n)])
    seed = draw(st.integers(0, 10_000))
    turn, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(n, n)))
    loads = [
        load(
            [draw(entry) for _ in range(n)],
            draw(st.floats(0.01, 0.1)),
            lambda p: np.cos(p) + 0.5 * np.sin(2 * p),
        )
    ]
    damping = draw(st.floats(1e-3, 0.02)) * np.eye(n) if damped else np.zeros((n, n))
    return PeriodicSystem(np.eye(n), damping, turn @ np.diag(frequencies**2) @ turn.T, loads, 1.0)
