"""Change of matrices in their eigenvectors: in lockstep, by LAPACK, and from eigenvalues of changed matrices."""

import numpy as np
import pytest

from facegear.floquet import eigenvectors as module
from facegear.floquet.eigenvectors import change, critical

MANY = 70


@pytest.fixture(params=["lockstep", "LAPACK"])
def route(request, monkeypatch):
    """Both routes, of which one may be missing: without Numba all is LAPACK."""
    if request.param == "lockstep":
        pytest.importorskip("facegear.floquet.lockstep_vectors", exc_type=ImportError)
    else:
        monkeypatch.setattr(module, "_lockstep", lambda: None)
    return request.param


@pytest.fixture
def asked_again(monkeypatch):
    """Count the matrices that LAPACK gets."""
    counts = []
    by_lapack = module._by_lapack
    monkeypatch.setattr(module, "_by_lapack", lambda x, least: counts.append(len(x)) or by_lapack(x, least))
    return counts


def random(size, seed=0):
    return np.random.default_rng(seed + size).normal(size=(2, MANY, size, size))


def known(size):
    """Matrices with eigenvalues a pair, real and complex in turn, and the products of their vectors with a change.

    Built from the vectors: no eigenvalue problem is solved.
    """
    rng = np.random.default_rng(size)
    noise, slopes = rng.normal(size=(2, MANY, size, size))
    vectors = np.linalg.qr(noise)[0] + 0.2 * noise[::-1] / size
    blocks = np.zeros((MANY, size, size))
    for k in range(0, size - 1, 4):
        turn, growth = 0.3 + (2.4 * k + rng.uniform(size=MANY)) / size, 1.0 + 0.2 * rng.uniform(size=MANY)
        blocks[:, k, k] = blocks[:, k + 1, k + 1] = growth * np.cos(turn)
        blocks[:, k + 1, k] = growth * np.sin(turn)
        blocks[:, k, k + 1] = -blocks[:, k + 1, k]
        for other in range(k + 2, min(k + 4, size)):
            blocks[:, other, other] = 2.0 + 0.3 * other + rng.uniform(size=MANY) / 5.0
    inverse = np.linalg.inv(vectors)
    return vectors @ blocks @ inverse, slopes, blocks, inverse @ slopes @ vectors


@pytest.mark.parametrize("size", [2, 4, 6, 14, 28])
def test_products_are_those_of_the_vectors_that_the_matrix_was_made_of(route, size):
    matrices, slopes, blocks, inside = known(size)
    found = change(matrices, slopes)
    for k in range(0, size - 1, 4):
        # Of a turning block [[c, -s], [s, c]] the vectors are (1, -i) and (1, i)/2.
        value = blocks[:, k, k] + 1j * blocks[:, k + 1, k]
        right, left = np.array([1.0, -1j]), np.array([0.5, 0.5j])
        place = np.abs(found.values - value[:, None]).argmin(axis=1)
        cells = np.arange(MANY)
        assert np.abs(found.values[cells, place] - value).max() < 1e-11
        part = inside[:, k : k + 2, k : k + 2]
        assert np.allclose(found.direct[cells, place, place], left @ part @ right, atol=1e-9)
        # Alone the vectors may be longer and turn: of the crossed product the modulus is left.
        crossed = np.abs(left @ part @ right.conj())
        assert np.allclose(np.abs(found.crossed[cells, place, place]), crossed, atol=1e-9)
        for other in range(k + 2, min(k + 4, size)):
            there = np.abs(found.values - blocks[:, other, other, None]).argmin(axis=1)
            assert np.allclose(found.direct[cells, there, there], inside[:, other, other], atol=1e-9)
            both = (left @ inside[:, k : k + 2, other, None])[:, 0] * (
                inside[:, other, None, k : k + 2] @ right
            )[:, 0]
            product = found.direct[cells, place, there] * found.direct[cells, there, place]
            assert np.allclose(product, both, atol=1e-9)


@pytest.mark.parametrize("size", [2, 3, 6, 14])
def test_rates_are_difference_quotients_of_eigenvalues(route, size):
    matrices, slopes, *_ = known(size)
    found, step = change(matrices, slopes), 1e-5
    ends = [np.linalg.eigvals(matrices + sign * step * slopes) for sign in (1.0, -1.0)]
    for number in range(MANY):
        there = found.values[number] != 0.0
        values, rates = found.values[number][there], np.diag(found.direct[number])[there]
        # Eigenvalues next to what is foretold.
        after, before = (
            end[number][np.abs(values[:, None] + sign * step * rates[:, None] - end[number]).argmin(axis=1)]
            for sign, end in zip((1.0, -1.0), ends, strict=True)
        )
        assert np.allclose((after - before) / (2.0 * step), rates, rtol=1e-5, atol=1e-5)


@pytest.mark.parametrize("size", [1, 2, 3, 14, 28, 60])
def test_lockstep_needs_no_help_with_ordinary_matrices(asked_again, size):
    pytest.importorskip("facegear.floquet.lockstep_vectors", exc_type=ImportError)
    change(*random(size))
    assert asked_again == []


def test_values_that_are_small_beside_the_largest_are_left_out(route):
    matrices = np.stack([np.diag([1.0, 1e-3, 1e-9]), np.diag([1e-9, 1e-9, 1e-9 + 1e-11])] * MANY)
    found = change(matrices, np.ones_like(matrices), least=1e-6)
    assert np.sort(found.values[0].real).tolist() == pytest.approx([1e-3, 1.0])
    # The largest one stays, however small it is.
    assert np.abs(found.values[1]).max() == pytest.approx(1e-9, rel=0.02)
    assert np.count_nonzero(found.values[1]) == 1


@pytest.mark.parametrize("pair", [False, True])
def test_the_critical_motion_is_the_one_that_was_put_in(route, pair):
    rng = np.random.default_rng(3)
    vectors = rng.normal(size=(MANY, 6, 6)) + 3.0 * np.eye(6)
    blocks = np.zeros((MANY, 6, 6)) + np.diag([0.0, 0.0, 0.9, -0.7, 0.4, 0.1])
    # A turning pair of modulus 1.2, or a negative value and a small one.
    blocks[:, :2, :2] = [[0.72, -0.96], [0.96, 0.72]] if pair else [[-1.2, 0.0], [0.0, 0.2]]
    inverse = np.linalg.inv(vectors)
    found = critical(vectors @ blocks @ inverse)
    assert found.values == pytest.approx(np.full(MANY, 0.72 + 0.96j if pair else -1.2), abs=1e-9)
    right = vectors[:, :, 0] - 1j * pair * vectors[:, :, 1]
    left = (inverse[:, 0] + 1j * pair * inverse[:, 1]) / (1 + pair)
    # Each of them up to a factor, both together without one.
    both = np.einsum("vi,vj->vij", found.right, found.left)
    assert both == pytest.approx(np.einsum("vi,vj->vij", right, left), abs=1e-8)


def with_block(block):
    """Ordinary matrices, and as number 7 one with a block like this."""
    matrices, slopes = random(6)
    turned = np.linalg.qr(matrices[7])[0]
    matrices[7] = turned @ block @ turned.T
    return matrices, slopes


def test_eigenvalues_that_coincide_are_left_to_lapack(asked_again):
    pytest.importorskip("facegear.floquet.lockstep_vectors", exc_type=ImportError)
    matrices, slopes = with_block(np.diag([1.0, 1.0, 2.0, 3.0, 4.0, 5.0]))
    found = change(matrices, slopes)
    assert asked_again == [1]
    alone = change(matrices[7:8], slopes[7:8])
    size = np.count_nonzero(alone.values)
    assert np.sort(found.values[7].real)[-size:] == pytest.approx(np.sort(alone.values[0].real), abs=1e-6)
    assert found.direct[7][:size, :size] == pytest.approx(alone.direct[0][:size, :size], rel=1e-6)


def test_vectors_of_a_defective_matrix_are_such_to_rounding(route):
    """Rounding parts its double eigenvalue by some 1e-8, into a pair or two real ones, as it happens."""
    block = np.diag([1.0, 1.0, 2.0, 3.0, 4.0, 5.0])
    block[0, 1] = 1.0
    matrices, _ = with_block(block)
    values, right, left = (part[7] for part in module._vectors(matrices, 0.0))
    there = values != 0.0
    values, columns, rows = values[there], *(part[0, there] + 1j * part[1, there] for part in (right, left))
    assert np.abs(values - np.rint(values.real)).max() < 1e-6
    left_over = np.abs(matrices[7] @ columns.T - values * columns.T).max(axis=0)
    assert (left_over <= 1e-12 * np.abs(columns).max(axis=1)).all()
    left_over = np.abs(rows @ matrices[7] - values[:, np.newaxis] * rows).max(axis=1)
    # Of two dependent vectors LAPACK's inverse is one of a matrix that is off by 1e-15.
    assert (left_over <= 1e-6 * np.abs(rows).max(axis=1)).all()


@pytest.mark.parametrize("fault", ["vector", "growth", "not a number"])
def test_a_wrong_result_is_found_and_done_again(fault, monkeypatch, asked_again):
    lockstep = pytest.importorskip("facegear.floquet.lockstep_vectors", exc_type=ImportError)
    right_one = lockstep.eigenvectors

    def faulty(matrices, real, imag, right, left, growth):
        right_one(matrices, real, imag, right, left, growth)
        if fault == "growth":
            growth[7, 0] = 1e9
        else:
            left[7, 0, 1, 2] = np.nan if fault == "not a number" else left[7, 0, 1, 2] + 1e-6

    expected = change(*random(14))
    monkeypatch.setattr(lockstep, "eigenvectors", faulty)
    found = change(*random(14))
    assert asked_again == [1]
    trace = np.einsum("vii->v", found.direct) - np.einsum("vii->v", expected.direct)
    assert np.abs(trace).max() < 1e-9


def test_few_matrices_are_lapacks(asked_again):
    change(*(part[:5] for part in random(4)))
    assert asked_again == [5]


def test_what_is_not_finite_is_refused(route):
    matrices = np.full((MANY, 3, 3), np.nan)
    with pytest.raises(ArithmeticError, match="not finite"):
        change(matrices, matrices)
