"""Eigenvalues in lockstep against LAPACK, one matrix of each kind among many, and each kind many times."""

import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from facegear.floquet import eigenvalues as module
from facegear.floquet.eigenvalues import eigenvalues, spectral_radii
from tests.resonance_systems import CHECK

MANY = 70


@pytest.fixture(params=["lockstep", "LAPACK"])
def route(request, monkeypatch):
    """Both routes, of which one may be missing: without Numba all is LAPACK."""
    if request.param == "lockstep":
        pytest.importorskip("numba")
    else:
        monkeypatch.setattr(module, "_lockstep", lambda: None)
    return request.param


@pytest.fixture
def asked_again(monkeypatch):
    """Count the matrices that LAPACK gets."""
    counts = []
    by_lapack = module._by_lapack
    monkeypatch.setattr(module, "_by_lapack", lambda x: counts.append(len(x)) or by_lapack(x))
    return counts


def random(size, rng):
    return rng.normal(size=(MANY, size, size))


def companion(size, rng):
    matrices = np.zeros((MANY, size, size))
    matrices[:, np.arange(1, size), np.arange(size - 1)] = 1.0
    matrices[:, 0] = rng.normal(size=(MANY, size))
    return matrices


def orthogonal(size, rng):
    return np.linalg.qr(random(size, rng))[0]


def coupled_in_blocks(size, rng):
    matrices = random(size, rng)
    matrices[:, size // 2 :, : size // 2] = 0.0
    return matrices


def triangular(size, rng):
    return np.triu(random(size, rng))


def hardly_coupled(size, rng):
    """Entries below the diagonal whose squares are lost in rounding beside the others."""
    return np.triu(random(size, rng)) + 3e-9 * random(size, rng)


def neighbours(size, rng):
    """As on a map: each close to the next, unlike in size."""
    return random(size, rng)[0] + np.linspace(0.0, 0.1, MANY)[:, None, None] * random(size, rng)[1]


def mixed(size, rng):
    """No two beside each other of one kind."""
    kinds = [kind(size, rng) for kind in (random, companion, orthogonal, triangular)]
    return np.stack([kinds[number % 4][number] for number in range(MANY)])


def apart(one, other):
    """Largest distance of an eigenvalue from the nearest of the others, for each matrix."""
    distance = np.abs(one[:, :, None] - other[:, None, :])
    return np.maximum(distance.min(axis=1).max(axis=1), distance.min(axis=2).max(axis=1))


@pytest.mark.parametrize(
    "kind", [random, orthogonal, coupled_in_blocks, hardly_coupled, neighbours, companion, triangular, mixed]
)
@pytest.mark.parametrize("size", [1, 2, 3, 14, 28])
def test_eigenvalues_are_those_of_lapack_to_their_condition(route, kind, size):
    matrices = kind(size, np.random.default_rng(size))
    expected, vectors = np.linalg.eig(matrices)
    norm = np.linalg.norm(matrices, axis=(1, 2))
    found = eigenvalues(matrices)
    # An error of the matrix moves an eigenvalue by as much times the condition of its vectors at most.
    assert (apart(found, expected) <= 5e-15 * norm * np.linalg.cond(vectors)).all()


@pytest.mark.parametrize("kind", [random, orthogonal, neighbours])
def test_radii_agree_to_rounding(route, kind):
    for size in (1, 2, 3, 14, 28):
        matrices = kind(size, np.random.default_rng(size))
        norm = np.linalg.norm(matrices, axis=(1, 2))
        expected = np.abs(np.linalg.eigvals(matrices)).max(axis=1)
        assert (np.abs(spectral_radii(matrices) - expected) <= 5e-15 * norm).all()


@pytest.mark.parametrize(
    "kind", [random, orthogonal, coupled_in_blocks, hardly_coupled, neighbours, companion, triangular, mixed]
)
@pytest.mark.parametrize("size", [1, 2, 3, 14, 28, 60])
def test_lockstep_needs_no_help_with_ordinary_matrices(asked_again, kind, size):
    pytest.importorskip("numba")
    eigenvalues(kind(size, np.random.default_rng(size)))
    assert asked_again == []


@pytest.mark.parametrize("size", [2, 3, 14])
def test_defective_matrices_are_known_to_a_root_of_rounding(route, size):
    block = np.eye(size) + np.diag(np.ones(size - 1), 1)
    turned = orthogonal(size, np.random.default_rng(3))
    matrices = turned @ block @ turned.swapaxes(1, 2)
    assert np.abs(eigenvalues(matrices) - 1.0).max() < (1e-14) ** (1.0 / size)
    assert np.abs(eigenvalues(np.broadcast_to(block, (MANY, size, size))) - 1.0).max() == 0.0


@pytest.mark.parametrize("size", [1, 2, 3, 14])
@pytest.mark.parametrize("scale", [0.0, 5e-324, 1e-310, 1e-200, 1e-100, 1e100, 1e200, 1e300])
def test_any_size_of_entries(route, size, scale):
    matrices = np.full((MANY, size, size), scale)
    assert spectral_radii(matrices) == pytest.approx(size * scale, rel=1e-13, abs=1e-322)


def test_cyclic_shifts_of_unit_vectors_need_unusual_shifts(route):
    """Francis' double shifts stand still on them."""
    matrices = np.stack([np.roll(np.eye(size), 1, axis=0) for size in [14] * MANY])
    assert np.abs(np.abs(eigenvalues(matrices)) - 1.0).max() < 1e-13


@given(seed=st.integers(0, 2**16), size=st.integers(2, 14), powers=st.integers(0, 60))
@CHECK
def test_badly_scaled_matrices_are_balanced(seed, size, powers):
    """Eigenvalues of D A D⁻¹ are those of A, however unlike the entries of D are."""
    rng = np.random.default_rng(seed)
    scale = 2.0 ** rng.integers(-powers, powers + 1, size=(MANY, size))
    matrices = random(size, rng)
    radii = np.abs(np.linalg.eigvals(matrices)).max(axis=1)
    found = spectral_radii(scale[:, :, None] * matrices / scale[:, None, :])
    condition = np.linalg.cond(np.linalg.eig(matrices)[1])
    assert (np.abs(found - radii) <= 1e-13 * np.linalg.norm(matrices, axis=(1, 2)) * condition).all()


@pytest.mark.parametrize("wrong", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("count", [1, MANY])
def test_what_is_not_finite_is_refused(route, wrong, count):
    matrices = np.ones((count, 3, 3))
    matrices[-1, 1, 2] = wrong
    with pytest.raises(ArithmeticError, match="not finite"):
        spectral_radii(matrices)


@pytest.mark.parametrize("fault", ["value", "flag", "not a number"])
def test_a_wrong_result_is_found_and_done_again(fault, monkeypatch, asked_again):
    lockstep = pytest.importorskip("facegear.floquet.lockstep", exc_type=ImportError)
    right = lockstep.eigenvalues

    def faulty(matrices, real, imag, converged):
        right(matrices, real, imag, converged)
        if fault == "flag":
            converged[7] = False
        else:
            real[7, 2] = real[7, 2] + 1e-9 if fault == "value" else np.nan

    monkeypatch.setattr(lockstep, "eigenvalues", faulty)
    matrices = random(14, np.random.default_rng(0))
    assert np.abs(spectral_radii(matrices) - np.abs(np.linalg.eigvals(matrices)).max(axis=1)).max() < 1e-13
    assert asked_again == [1]


def test_few_matrices_and_none(asked_again):
    assert spectral_radii(np.zeros((0, 4, 4))).shape == (0,)
    assert spectral_radii(np.eye(4)[None]).tolist() == [1.0]
    assert asked_again == [0, 1]


def test_matrices_need_not_lie_in_rows(route):
    matrices = random(6, np.random.default_rng(0))
    assert np.abs(spectral_radii(matrices.swapaxes(1, 2)) - spectral_radii(matrices)).max() < 1e-13


def test_without_a_map_nothing_is_compiled():
    code = "import sys, facegear as fg; fg.stability_map, fg.tongues; assert 'numba' not in sys.modules"
    subprocess.run([sys.executable, "-c", code], check=True)
