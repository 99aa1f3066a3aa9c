"""Two thousand systems of every kind that an error estimate must hold for, the same to the bit on any processor.

All numbers are made of few bits by sums and products that do not round, so that no last digit hangs on BLAS or on the
mathematical library. Shapes and weights are polynomials of degree 2 at most, for
:mod:`tests.independent.exact_multipliers`, whose multipliers of all of them are stored in `error_systems.npz` by
``python -m tests.independent.make_error_systems``.
"""

import zlib
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
from flint import arb, arb_mat, ctx

from facegear.floquet.loads import ContactLoad, StateJump
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev

STORED = Path(__file__).with_suffix(".npz")
EACH = 125

Rng = np.random.Generator


def size_of(rng: Rng) -> int:
    """1 to 14, small ones more often: references of large systems are dear."""
    return int(rng.integers(7, 15)) if rng.random() < 0.07 else 1 + int(6 * rng.random() ** 1.5)


def power(rng: Rng, low: float, high: float) -> float:
    """Return a number of nine bits between about 2^low and 2^high, evenly spread by its logarithm."""
    exponent = int(rng.integers(int(np.floor(low)), int(np.ceil(high))))
    return (256 + int(rng.integers(256))) * 2.0 ** (exponent - 8)


def whole(rng: Rng, shape: int | tuple[int, ...], most: int = 16) -> np.ndarray:
    """Whole sixteenths between −most/16 and most/16."""
    return rng.integers(-most, most + 1, size=shape) / 16.0


def instants(rng: Rng, count: int) -> np.ndarray:
    """Fractions of the period, 1/32 apart at least."""
    return np.sort(rng.choice(32, size=count, replace=False)) / 32.0


def squares(rng: Rng, n: int, low: float = -3, high: float = 5) -> np.ndarray:
    """Build a positive definite matrix of n random dyads, with frequencies of many sizes."""
    columns = whole(rng, (n, n), 8) + np.eye(n)
    sizes = np.array([power(rng, low, high) for _ in range(n)])
    return np.einsum("ik,k,jk->ij", columns, sizes, columns)


def masses(rng: Rng, n: int) -> np.ndarray:
    column = whole(rng, n)
    return np.diag([power(rng, -2, 2) for _ in range(n)]) + np.outer(column, column)


def function(rng: Rng, components: int, pieces: int, degree: int, form: str) -> PiecewiseChebyshev:
    """Build a piecewise polynomial that jumps at its breakpoints, or is bent there."""
    at = instants(rng, pieces)
    if form == "jumps":
        return PiecewiseChebyshev(at, whole(rng, (pieces, degree + 1, components)))
    values = whole(rng, (pieces, components))
    following = np.roll(values, -1, axis=0)
    series = [(values + following) / 2.0, (following - values) / 2.0]
    if degree == 2:
        # 2s² − 1 less one vanishes at both ends.
        bulge = whole(rng, (pieces, components), 8)
        series = [series[0] - bulge, series[1], bulge]
    return PiecewiseChebyshev(at, np.stack(series, axis=1))


def steps(rng: Rng, components: int, pieces: int = 2) -> PiecewiseChebyshev:
    return function(rng, components, pieces, 0, "jumps")


def positive(weight: PiecewiseChebyshev) -> PiecewiseChebyshev:
    """Lift a weight so far that it is not negative."""
    series = weight.coefficients.copy()
    series[:, 0] += np.abs(series).sum(axis=1).max()
    return replace(weight, coefficients=series)


def constant(values: np.ndarray) -> PiecewiseChebyshev:
    return PiecewiseChebyshev(np.zeros(1), np.asarray(values, dtype=float)[None, None, :])


def sheared(rng: Rng, system: PeriodicSystem) -> PeriodicSystem:
    """Return the same motion in other coordinates, q = B y with B of whole numbers."""
    n = system.size
    basis = np.eye(n)
    for _ in range(n - 1):
        i, j = rng.choice(n, size=2, replace=False)
        basis[:, i] += float(rng.choice([-1.0, 1.0])) * basis[:, j]

    def dyad(matrix: np.ndarray) -> np.ndarray:
        return np.einsum("ki,kl,lj->ij", basis, matrix, basis)

    loads = []
    for load in system.loads:
        series = np.einsum("pdk,ki->pdi", load.shape.coefficients, basis)
        loads.append(replace(load, shape=PiecewiseChebyshev(load.shape.breakpoints, series)))
    return replace(
        system,
        mass=dyad(system.mass),
        damping=dyad(system.damping),
        stiffness=dyad(system.stiffness),
        loads=tuple(loads),
    )


def period(rng: Rng, system: PeriodicSystem, low: float = -3, high: float = 4.5) -> float:
    """Draw a period of an angle of about 2^low to 2^high for the fastest motion, loads not counted."""
    size = float(np.trace(system.stiffness) / np.trace(system.mass))
    whole_power = round(np.log2(max(size, 2.0**-20)) / 2.0)
    return power(rng, low, high) * 2.0**-whole_power


def ordinary(rng: Rng) -> PeriodicSystem:
    """Build loads that are bent only, light damping: what drives are like."""
    n = size_of(rng)
    stiffness = squares(rng, n)
    loads = tuple(
        ContactLoad(
            function(rng, n, int(rng.integers(1, 3)), int(rng.integers(1, 3)), "bent"),
            power(rng, -2, 4),
            power(rng, -8, -3),
        )
        for _ in range(int(rng.integers(1, 3)))
    )
    mass = masses(rng, n)
    system = PeriodicSystem(mass, power(rng, -12, -4) * mass, stiffness, loads, 1.0)
    return replace(system, period=period(rng, system))


def jumping(rng: Rng) -> PeriodicSystem:
    """Shapes that jump, with either rate."""
    system = ordinary(rng)
    loads = tuple(
        ContactLoad(
            function(rng, system.size, int(rng.integers(1, 4)), int(rng.integers(0, 3)), "jumps"),
            power(rng, -2, 5),
            power(rng, -8, 0),
            rate=str(rng.choice(["frozen", "total"])),
        )
        for _ in range(int(rng.integers(1, 4)))
    )
    return replace(system, loads=loads)


def state_jumps(rng: Rng) -> PeriodicSystem:
    """Jumps of the state, small, large, or of rank one less."""
    system = ordinary(rng)
    n = system.size
    jumps = []
    for at in instants(rng, int(rng.integers(1, 4))):
        matrix = np.eye(2 * n) + power(rng, -8, 4) * whole(rng, (2 * n, 2 * n)) / n
        if rng.random() < 0.2:
            matrix[int(rng.integers(2 * n))] = 0.0
        jumps.append(StateJump(float(at), matrix))
    return replace(system, jumps=tuple(jumps))


def kicked(rng: Rng) -> PeriodicSystem:
    """Masses that follow shapes with bends, heavy ones in short periods too."""
    system = ordinary(rng)
    loads = tuple(
        ContactLoad(
            function(rng, system.size, int(rng.integers(2, 4)), int(rng.integers(1, 3)), "bent"),
            power(rng, -2, 5),
            power(rng, -8, 0),
            power(rng, -6, 4),
            "total",
        )
        for _ in range(int(rng.integers(1, 3)))
    )
    return replace(system, loads=loads, period=period(rng, system, -3, 3))


def weighted(rng: Rng) -> PeriodicSystem:
    """Weights on springs, dampers and masses."""
    system, loads = ordinary(rng), []
    for _ in range(int(rng.integers(1, 3))):
        heavy = power(rng, -5, 2) if rng.random() < 0.7 else 0.0
        rate = str(rng.choice(["frozen", "total"]))
        bent = heavy > 0.0 and rate == "total"
        shape = function(rng, system.size, 2, 1, "bent")
        weight = function(rng, 1, 2, int(rng.integers(0, 2)) if not bent else 1, "bent" if bent else "jumps")
        weight = positive(weight) if heavy or rng.random() < 0.5 else weight
        loads.append(ContactLoad(shape, power(rng, -2, 4), power(rng, -8, -1), heavy, rate, weight))
    return replace(system, loads=tuple(loads))


def dampers(rng: Rng) -> PeriodicSystem:
    """Contacts with strong dampers on an oscillating body."""
    system = ordinary(rng)
    loads = [ContactLoad(steps(rng, system.size, 2), power(rng, -2, 6), power(rng, 0, 18))]
    loads += [
        ContactLoad(function(rng, system.size, 2, 1, form), power(rng, -2, 4), power(rng, -4, 3), rate=rate)
        for form, rate in (("jumps", "frozen"), ("bent", "total"))
        if rng.random() < 0.4
    ]
    if len(loads) > 1:
        loads[0] = replace(loads[0], damping=power(rng, 0, 5))
    return replace(system, loads=tuple(loads))


def overdamped(rng: Rng) -> PeriodicSystem:
    """Bodies that creep back."""
    system = ordinary(rng)
    damping = squares(rng, system.size, 0, 6)
    return replace(system, damping=damping, period=period(rng, system, -3, 2))


def stiff(rng: Rng) -> PeriodicSystem:
    """Dampers up to 2^18, or 2^30 in small systems, on all or some of the coordinates, and loads that step."""
    n = size_of(rng)
    mass, stiffness = masses(rng, n), squares(rng, n)
    column = whole(rng, (n, int(rng.integers(1, n + 1))))
    # Beyond 2^20 adaptive Magnus takes long to find that it cannot.
    strongest = power(rng, 20, 30) if n < 3 and rng.random() < 0.2 else power(rng, 4, 18)
    damping = strongest * np.einsum("ik,jk->ij", column, column)
    loads = tuple(
        ContactLoad(steps(rng, n), power(rng, -2, 5), power(rng, -8, 20) if rng.random() < 0.3 else 0.0)
        for _ in range(2)
    )
    system = PeriodicSystem(mass, damping, stiffness, loads, 1.0)
    return replace(system, period=period(rng, system))


def rigid(rng: Rng) -> PeriodicSystem:
    """Chains that hang on nothing: a double multiplier of 1; some with dampers, which leave it so."""
    n = max(2, size_of(rng))
    stiffness, damping = np.zeros((n, n)), np.zeros((n, n))
    for i in range(n - 1):
        between = np.eye(n)[i] - np.eye(n)[i + 1]
        stiffness += power(rng, -2, 5) * np.outer(between, between)
        if rng.random() < 0.3:
            damping += power(rng, -8, 3) * np.outer(between, between)
    loads = []
    for _ in range(int(rng.integers(1, 3))):
        i, j = rng.choice(n, size=2, replace=False)
        between = np.eye(n)[i] - np.eye(n)[j]
        scalar = function(rng, 1, 2, int(rng.integers(1, 3)), str(rng.choice(["bent", "jumps"])))
        shape = PiecewiseChebyshev(scalar.breakpoints, scalar.coefficients * between)
        loads.append(ContactLoad(shape, power(rng, -2, 5), power(rng, -8, 0)))
    system = PeriodicSystem(
        np.diag([power(rng, -2, 3) for _ in range(n)]), damping, stiffness, tuple(loads), 1.0
    )
    system = sheared(rng, system) if rng.random() < 0.5 else system
    return replace(system, period=period(rng, system))


def defective(rng: Rng) -> PeriodicSystem:
    """Two equal oscillators, one of which drives the other, or critical damping; loads that are the same on both."""
    n = int(rng.integers(1, 4))
    omega = power(rng, -1, 2)
    pairs = n if n < 2 else 2
    stiffness, damping = np.zeros((n, n)), np.zeros((n, n))
    np.fill_diagonal(stiffness, omega**2)
    kind = int(rng.integers(3))
    if kind == 0 or n == 1:
        np.fill_diagonal(damping, 2.0 * omega)
    elif kind == 1:
        np.fill_diagonal(damping, power(rng, -6, 0))
    for i in range(pairs, n):
        stiffness[i, i] = power(rng, 0, 4)
        damping[i, i] = power(rng, -6, 3)
    if n > 1:
        stiffness[1, 0] = power(rng, -6, 4)
    loads: tuple[ContactLoad, ...] = ()
    if kind and n > 1:
        weight = function(rng, 1, 2, int(rng.integers(0, 2)), "jumps")
        strength = power(rng, -4, 3)
        loads = tuple(ContactLoad(constant(np.eye(n)[i]), strength, weight=weight) for i in range(2))
    system = PeriodicSystem(np.eye(n), damping, stiffness, loads, 1.0)
    system = sheared(rng, system) if n > 1 and rng.random() < 0.7 else system
    return replace(system, period=power(rng, -3, 4) / omega if rng.random() < 0.5 else power(rng, -3, 3))


def border(rng: Rng) -> PeriodicSystem:
    """Near a tongue's border, where two multipliers of one oscillator of several meet: Meissner's equation."""
    n = min(6, size_of(rng))
    zeta = power(rng, -10, -2) if rng.random() < 0.5 else 0.0
    duty = int(rng.integers(4, 29)) / 32.0
    wave = PiecewiseChebyshev(np.array([0.0, duty]), whole(rng, (2, 1, 1)))
    stiffness = np.diag([power(rng, -2, 4) for _ in range(n)])
    strength = power(rng, -2, 3)
    load = ContactLoad(constant(np.eye(n)[0]), strength, weight=wave)
    system = PeriodicSystem(np.eye(n), zeta * np.eye(n), stiffness, (load,), 1.0)
    highs = [stiffness[0, 0] + strength * w for w in wave.coefficients.ravel().tolist()]
    at = _meeting(highs, zeta, duty, power(rng, -2, 2))
    if rng.random() < 0.8:
        at *= 1.0 + float(rng.choice([-1.0, 1.0])) * power(rng, -50, -8)
    system = replace(system, period=at)
    return sheared(rng, system) if n > 1 and rng.random() < 0.8 else system


def _meeting(stiffnesses: list[float], damping: float, duty: float, start: float) -> float:
    """Period after `start`, to the last bit, at which two multipliers of q'' + c q' + k(t) q = 0 meet."""

    def discriminant(period: float) -> arb:
        whole = arb_mat(2, 2, [1, 0, 0, 1])
        for k, part in zip(stiffnesses, (arb(duty), 1 - arb(duty)), strict=True):
            rates = arb_mat(2, 2, [arb(0), arb(1), -arb(k), -arb(damping)])
            whole = (rates * (part * arb(period))).exp() * whole
        return whole.trace() ** 2 - 4 * whole.det()

    with ctx.workprec(256):
        low, high = start, start * 1.0625
        sign = bool(discriminant(low) > 0)
        for _ in range(60):
            if bool(discriminant(high) > 0) != sign:
                break
            low, high = high, high * 1.0625
        else:
            return start
        while True:
            middle = (low + high) / 2.0
            if middle in (low, high):
                return middle
            if bool(discriminant(middle) > 0) == sign:
                low = middle
            else:
                high = middle


def long(rng: Rng) -> PeriodicSystem:
    """Many turns in a period, or next to none; loads that step."""
    n = size_of(rng)
    mass = masses(rng, n)
    loads = tuple(ContactLoad(steps(rng, n, 3), power(rng, -4, 2), power(rng, -12, -3)) for _ in range(2))
    system = PeriodicSystem(mass, power(rng, -14, -8) * mass, squares(rng, n), loads, 1.0)
    reach = (5, 11) if rng.random() < 0.7 else (-20, -6)
    return replace(system, period=period(rng, system, *reach))


def growing(rng: Rng) -> PeriodicSystem:
    """Motions that grow far and, in part of these, die again before the period ends."""
    n = size_of(rng)
    mass = masses(rng, n)
    weight = PiecewiseChebyshev(np.array([0.0, 0.5]), np.array([-1.0, 0.25])[:, None, None])
    loads = [ContactLoad(constant(whole(rng, n) + np.eye(n)[0]), power(rng, 4, 8), weight=weight)]
    if rng.random() < 0.6:
        later = PiecewiseChebyshev(np.array([0.0, 0.5]), np.array([0.0, 1.0])[:, None, None])
        loads.append(ContactLoad(constant(whole(rng, n) + np.eye(n)[0]), 0.0, power(rng, 3, 7), weight=later))
    system = PeriodicSystem(mass, power(rng, -8, 2) * mass, squares(rng, n, -3, 3), tuple(loads), 1.0)
    return replace(system, period=period(rng, system, -1, 3.5))


def undone(rng: Rng) -> PeriodicSystem:
    """Jumps of the state that are taken back later in the period, whose large parts cancel."""
    n = size_of(rng)
    mass = masses(rng, n)
    loads = (ContactLoad(steps(rng, n), power(rng, -2, 4), power(rng, -8, -3)),)
    system = PeriodicSystem(mass, power(rng, -8, -3) * mass, squares(rng, n), loads, 1.0)
    strength, forth, back = power(rng, 2, 20), np.eye(2 * n), np.eye(2 * n)
    i, j = rng.choice(2 * n, size=2, replace=False)
    forth[i, j], back[i, j] = strength, -strength
    first, second = instants(rng, 2)
    jumps = (StateJump(float(first), forth), StateJump(float(second), back))
    return replace(system, jumps=jumps, period=period(rng, system, -8, 3))


def unequal(rng: Rng) -> PeriodicSystem:
    """Coordinates in units of very unequal size, bodies of very unequal mass, springs and dampers of either."""
    system = mixed(rng)
    units = 2.0 ** rng.integers(-20, 21, size=system.size)
    loads = tuple(
        replace(load, shape=PiecewiseChebyshev(load.shape.breakpoints, load.shape.coefficients * units))
        for load in system.loads
    )
    both = np.append(units, units)
    jumps = tuple(StateJump(x.fraction, x.matrix / both[:, None] * both) for x in system.jumps)
    dyad = np.outer(units, units)
    return replace(
        system,
        mass=system.mass * dyad,
        damping=system.damping * dyad,
        stiffness=system.stiffness * dyad,
        loads=loads,
        jumps=jumps,
    )


def mixed(rng: Rng) -> PeriodicSystem:
    """Everything at once."""
    parts = [build(rng) for build in (kicked, weighted, jumping, state_jumps)]
    system = parts[0]
    n = system.size
    loads = list(system.loads[:1])
    for other in parts[1:]:
        for load in other.loads[:1]:
            if rng.random() < 0.6:
                series = np.zeros((*load.shape.coefficients.shape[:2], n))
                shared = min(n, load.shape.components)
                series[..., :shared] = load.shape.coefficients[..., :shared]
                loads.append(replace(load, shape=PiecewiseChebyshev(load.shape.breakpoints, series)))
    jumps: tuple[StateJump, ...] = ()
    if rng.random() < 0.5:
        matrix = np.eye(2 * n) + power(rng, -8, 0) * whole(rng, (2 * n, 2 * n)) / n
        jumps = (StateJump(float(instants(rng, 1)[0]), matrix),)
    twist = np.zeros((n, n))
    if n > 1 and rng.random() < 0.5:
        twist[0, 1], twist[1, 0] = power(rng, -6, 2), -power(rng, -6, 2)
    damping = system.damping + (twist if rng.random() < 0.5 else 0.0)
    stiffness = system.stiffness + (twist if rng.random() < 0.3 else 0.0)
    return replace(system, loads=tuple(loads), jumps=jumps, damping=damping, stiffness=stiffness)


KINDS: dict[str, Callable[[Rng], PeriodicSystem]] = {
    build.__name__: build
    for build in (
        ordinary,
        jumping,
        state_jumps,
        kicked,
        weighted,
        dampers,
        overdamped,
        stiff,
        rigid,
        defective,
        border,
        long,
        growing,
        undone,
        unequal,
        mixed,
    )
}


def system_of(kind: str, number: int) -> PeriodicSystem:
    """Return a system by its kind and number, 0 to 124."""
    return KINDS[kind](np.random.default_rng([20, list(KINDS).index(kind), number]))


def checksum(system: PeriodicSystem) -> int:
    """Tell systems apart to the last bit."""
    parts = [system.mass, system.damping, system.stiffness, np.array([system.period])]
    for load in system.loads:
        parts.append(np.array([load.stiffness, load.damping, load.mass, float(load.rate == "total")]))
        for part in (load.shape, load.weight):
            parts += [] if part is None else [part.breakpoints, part.coefficients]
    for jump in system.jumps:
        parts += [np.array([jump.fraction]), jump.matrix]
    sum_ = 0
    for part in parts:
        # Minus zero is zero.
        sum_ = zlib.crc32((np.ascontiguousarray(part, dtype="<f8") + 0.0).tobytes(), sum_)
    return sum_


def stored() -> dict[tuple[str, int], tuple[int, np.ndarray]]:
    """Checksum and exact multipliers of each system, by kind and number."""
    with np.load(STORED) as file:
        sums, ends, values = file["checksums"], file["ends"], file["multipliers"]
    keys = [(kind, number) for kind in KINDS for number in range(EACH)]
    parts = np.split(values, ends[:-1])
    return {key: (int(sum_), part) for key, sum_, part in zip(keys, sums, parts, strict=True)}
