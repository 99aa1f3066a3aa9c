"""Multipliers of systems of piecewise polynomial shapes and weights, with any number of digits.

Taylor series on parts of the smooth pieces, in Arb's arithmetic (python-flint): nothing of the package but the numbers
that a system is given by, and no rounding that matters. Kicks follow from the balance of momentum.
"""

from itertools import pairwise

import numpy as np
from flint import acb, acb_mat, arb, arb_mat, ctx

from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev

# Growth of a motion over a part, as the integral of the norm of its equations, where Taylor series are begun with.
_LONGEST = 8.0
# What no Taylor series may take longer for.
_MOST_TERMS = 250


def multipliers(system: PeriodicSystem, bits: int = 256) -> np.ndarray:
    """Floquet multipliers, largest modulus first, shape (2n,): right to the last bit that a double has."""
    with ctx.workprec(bits):
        values = acb_mat(transition(system, bits)).eig(algorithm="approx", maxiter=100_000)
        return _ordered(values)


def _ordered(values: list[acb]) -> np.ndarray:
    found = np.array([complex(value) for value in values])
    return found[np.argsort(-np.abs(found), kind="stable")]


def transition_matrix(system: PeriodicSystem, bits: int = 256) -> np.ndarray:
    """Φ of the state (q, q̇) over a period, rounded to doubles, shape (2n, 2n)."""
    with ctx.workprec(bits):
        return _doubles(transition(system, bits))


def transition(system: PeriodicSystem, bits: int) -> arb_mat:
    """Φ, with so many bits behind the point."""
    n, period = system.size, arb(system.period)
    edges = sorted({0.0, 1.0, *_instants(system)})
    state = _identity(2 * n)
    for start, end in pairwise(edges):
        state = (_jump(system, start) * state).mid()
        state = (_piece(system, start, end, period, bits) * state).mid()
    return state


def _instants(system: PeriodicSystem) -> set[float]:
    found = {jump.fraction for jump in system.jumps}
    for load in system.loads:
        found |= set(load.shape.breakpoints.tolist())
        if load.weight is not None:
            found |= set(load.weight.breakpoints.tolist())
    return found


def _identity(size: int) -> arb_mat:
    return arb_mat(size, size, [arb(int(i == j)) for i in range(size) for j in range(size)])


def _matrix(values: np.ndarray) -> arb_mat:
    return arb_mat(*values.shape, [arb(x) for x in values.ravel().tolist()])


def _block(a: arb_mat, b: arb_mat, c: arb_mat, d: arb_mat) -> arb_mat:
    upper = [x + y for x, y in zip(a.tolist(), b.tolist(), strict=True)]
    lower = [x + y for x, y in zip(c.tolist(), d.tolist(), strict=True)]
    return arb_mat(upper + lower)


def _polynomial(
    function: PiecewiseChebyshev | None, start: arb, length: arb, inside: float
) -> list[list[arb]]:
    """Taylor coefficients in u of each component, x = start + length u, of the piece that `inside` lies in."""
    if function is None:
        return [[arb(1)]]
    piece = int(np.searchsorted(function.breakpoints, inside, side="right")) - 1
    first = arb(function.breakpoints[piece].item()) - int(piece < 0)
    last = function.breakpoints[(piece + 1) % function.breakpoints.size].item()
    past = int(piece == function.breakpoints.size - 1)
    span = arb(last) + past - first
    # s = origin + slope u runs from -1 to 1 along the piece.
    slope, origin = 2 * length / span, 2 * (start - first) / span - 1
    series = function.coefficients[piece]
    assert len(series) <= 3
    a, b, c = (series[i].tolist() if i < len(series) else [0.0] * function.components for i in range(3))
    found = []
    for x, y, z in zip(a, b, c, strict=True):
        x, y, z = arb(x) - arb(z), arb(y), 2 * arb(z)
        terms = [x + y * origin + z * origin**2, (y + 2 * z * origin) * slope, z * slope**2]
        found.append(terms[: len(series)])
    return found


def _product(one: list[arb_mat], other: list[arb_mat]) -> list[arb_mat]:
    """Product of two polynomials whose coefficients are matrices."""
    terms: list[arb_mat | None] = [None] * (len(one) + len(other) - 1)
    for i, x in enumerate(one):
        for j, y in enumerate(other):
            term, before = x * y, terms[i + j]
            terms[i + j] = term if before is None else before + term
    return [term for term in terms if term is not None]


def _slope(terms: list[arb_mat]) -> list[arb_mat]:
    return [i * terms[i] for i in range(1, len(terms))] or [0 * terms[0]]


def _equations(
    system: PeriodicSystem, start: arb, length: arb, inside: float
) -> tuple[list[arb_mat], list[arb_mat], list[arb_mat]]:
    """M, C, K as polynomials in u, x = start + length u, derivatives being by u."""
    h = length * arb(system.period)
    mass, damping, stiffness = (
        [_matrix(system.mass)],
        [h * _matrix(system.damping)],
        [h**2 * _matrix(system.stiffness)],
    )

    def add(to: list[arb_mat], factor: arb, terms: list[arb_mat]) -> None:
        for i, term in enumerate(terms):
            if i < len(to):
                to[i] = to[i] + factor * term
            else:
                to.append(factor * term)

    for load in system.loads:
        parts = _polynomial(load.shape, start, length, inside)
        (weight,) = _polynomial(load.weight, start, length, inside)
        column = [arb_mat([[row[i]] for row in parts]) for i in range(len(parts[0]))]
        row = [x.transpose() for x in column]
        force = _product(column, [arb_mat([[w]]) for w in weight])
        m, c, k = arb(load.mass), h * arb(load.damping), h**2 * arb(load.stiffness)
        add(mass, m, _product(force, row))
        add(damping, c, _product(force, row))
        add(stiffness, k, _product(force, row))
        if load.rate == "total":
            # u = φᵀq: u' = φᵀq' + φ'ᵀq, u'' = φᵀq'' + 2 φ'ᵀq' + φ''ᵀq.
            add(stiffness, c, _product(force, _slope(row)))
            add(damping, 2 * m, _product(force, _slope(row)))
            add(stiffness, m, _product(force, _slope(_slope(row))))
    return mass, damping, stiffness


def _zero(terms: list[arb_mat]) -> bool:
    return all(x == 0 for term in terms for x in term.entries())


def _piece(system: PeriodicSystem, start: float, end: float, period: arb, bits: int) -> arb_mat:
    """Transition matrix between two instants with nothing rough in between."""
    n, inside = system.size, (start + end) / 2.0
    length = arb(end) - arb(start)
    mass, damping, stiffness = _equations(system, arb(start), length, inside)
    if _zero(mass[1:]) and _zero(damping[1:]) and _zero(stiffness[1:]):
        inverse = mass[0].inv()
        zero = 0 * inverse
        state = _block(zero, _identity(n), -inverse * stiffness[0], -inverse * damping[0])
        return _in_time(_exponential(state), length * period, n)
    # How fast things are, to the accuracy of a double, which is enough to choose steps by.
    inverse = mass[0].inv()
    rates = [
        max(
            float(np.abs(np.linalg.eigvals(_doubles(inverse * term))).max()) ** (1.0 / (number + least))
            for number, term in enumerate(terms)
        )
        for least, terms in ((1, mass[1:] or [0 * inverse]), (1, damping), (2, stiffness))
    ]
    count = max(1, int(np.ceil(max(3.0 * rates[0], rates[1] / _LONGEST, rates[2] / _LONGEST))))
    whole, done = _identity(2 * n), arb(0)
    step = length / count
    while bool(done < length - step / 2):
        part = None
        while part is None:
            part = _series(_equations(system, arb(start) + done, step, inside), n, bits)
            step = step if part is not None else step / 2
        whole = (_in_time(part, step * period, n) * whole).mid()
        done = (done + step).mid()
    return whole


def _doubles(matrix: arb_mat) -> np.ndarray:
    return np.array([[float(x.mid()) for x in row] for row in matrix.tolist()])


def _exponential(state: arb_mat) -> arb_mat:
    """Exponential with as many bits as are asked for, whatever its norm."""
    norm = float(max(abs(x) for x in state.entries()).mid()) * state.nrows() + 1.0
    with ctx.workprec(ctx.prec + 64 + 4 * int(np.log2(norm))):
        return state.exp().mid()


def _in_time(matrix: arb_mat, h: arb, n: int) -> arb_mat:
    """From (q, dq/du) to (q, q̇), t = h u."""
    scale = arb_mat(
        [[(arb(1) if i < n else 1 / h) * (arb(int(i == j))) for j in range(2 * n)] for i in range(2 * n)]
    )
    back = arb_mat(
        [[(arb(1) if i < n else h) * (arb(int(i == j))) for j in range(2 * n)] for i in range(2 * n)]
    )
    return scale * matrix * back


def _series(
    equations: tuple[list[arb_mat], list[arb_mat], list[arb_mat]], n: int, bits: int
) -> arb_mat | None:
    """Transition matrix of (q, q') over u from 0 to 1, or None if the series does not end soon."""
    inverse = equations[0][0].inv()
    mass, damping, stiffness = ([(-inverse * term).mid() for term in terms] for terms in equations)
    zero = 0 * inverse
    terms = [
        arb_mat([x + y for x, y in zip(a, b, strict=True)])
        for a, b in ((_identity(n).tolist(), zero.tolist()), (zero.tolist(), _identity(n).tolist()))
    ]
    position, velocity = terms[0] + terms[1], terms[1]
    small = 0
    for k in range(_MOST_TERMS):
        total = 0 * terms[0]
        for j in range(1, min(len(mass), k + 1)):
            total += ((k - j + 2) * (k - j + 1)) * (mass[j] * terms[k - j + 2])
        for j in range(min(len(damping), k + 2)):
            total += (k - j + 1) * (damping[j] * terms[k - j + 1])
        for j in range(min(len(stiffness), k + 1)):
            total += stiffness[j] * terms[k - j]
        term = (total * (arb(1) / ((k + 2) * (k + 1)))).mid()
        terms.append(term)
        position += term
        velocity += (k + 2) * term
        size = float(max(abs(x) for x in term.entries())) * (k + 2)
        small = small + 1 if size < 2.0 ** (-bits + 24) else 0
        if size > 1e12:
            return None
        # Several terms, because the recurrence reaches back by the degree of its polynomials.
        if small > max(map(len, (mass, damping, stiffness))) + 2:
            return arb_mat(position.tolist() + velocity.tolist())
    return None


def _jump(system: PeriodicSystem, at: float) -> arb_mat:
    """Say what happens to the state at an instant: kicks, and after them the jumps of the system's own."""
    n = system.size
    mass, impulse = _matrix(system.mass), 0 * _matrix(system.mass)
    for load in system.loads:
        after, before = (_at(load.shape, at, after) for after in (True, False))
        if load.mass == 0.0 or load.rate != "total":
            weight = _at(load.weight, at, True)[0][0, 0]
            mass += arb(load.mass) * weight * after[0] * after[0].transpose()
            continue
        weight = _at(load.weight, at, True)[0][0, 0]
        force = arb(load.mass) * weight * after[0]
        mass += force * after[0].transpose()
        impulse += force * (after[1] - before[1]).transpose() * (1 / arb(system.period))
    zero, unit = 0 * mass, _identity(n)
    matrix = _block(unit, zero, -mass.inv() * impulse, unit)
    for jump in system.jumps:
        if jump.fraction == at:
            matrix = _matrix(jump.matrix) * matrix
    return matrix


def _at(function: PiecewiseChebyshev | None, at: float, after: bool) -> tuple[arb_mat, arb_mat]:
    """Value and slope by the fraction of the period, on one side of an instant."""
    nearby = 1e-6 if after else -1e-6
    parts = _polynomial(function, arb(at), arb(1), at + nearby)
    return (
        arb_mat([[part[0]] for part in parts]),
        arb_mat([[part[1] if len(part) > 1 else arb(0)] for part in parts]),
    )
