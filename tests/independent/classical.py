"""Classical periodic systems written out anew, with routes that share nothing with the package.

Every system is a pair (right-hand side A(x) as a function of the fraction of the period, list of instants where it is
not smooth) with its period. Transition matrices come from DOP853, the stepwise rules from scipy.linalg.expm one
sub-interval at a time, Mathieu's borders from mpmath, Hsu's bands from the formulas on paper.
"""

import math
from itertools import pairwise

import mpmath
import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import expm

TURN = 2 * math.pi


def companion(mass, damping, stiffness):
    n = len(mass)
    inverse = np.linalg.inv(mass)
    return np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ stiffness, -inverse @ damping]])


def mathieu(frequency, depth, damping_ratio=0.0):
    def matrix(x):
        return np.array([[0.0, 1.0], [-1.0 - depth * math.cos(TURN * x), -2.0 * damping_ratio]])

    return matrix, [0.0, 1.0], TURN / frequency


def meissner(frequency, depth, duty, damping_ratio=0.0):
    def matrix(x):
        stiffness = 1.0 + depth if x < duty else 1.0 - depth
        return np.array([[0.0, 1.0], [-stiffness, -2.0 * damping_ratio]])

    return matrix, [0.0, duty, 1.0], TURN / frequency


def coupled_pair(frequency, depth, coupling, circulation, damping):
    def matrix(x):
        spring = 1.0 + depth * math.cos(TURN * x)
        stiffness = np.array([[spring, coupling - circulation], [coupling + circulation, 3.5]])
        return companion(np.eye(2), damping * np.eye(2), stiffness)

    return matrix, [0.0, 1.0], TURN / frequency


def gear_pair(frequency, contact_ratio, droop, shaft_damping):
    def matrix(x):
        pairs, age = 0.0, x
        while age < contact_ratio:
            middle = contact_ratio / 2
            pairs += 1.0 - droop * ((age - middle) / middle) ** 2
            age += 1.0
        mesh = 0.6 * pairs * np.array([[1.0, -1.0], [-1.0, 1.0]])
        return companion(np.diag([1.0, 1.5]), shaft_damping * np.eye(2), np.diag([0.5, 1.0]) + mesh)

    return matrix, [0.0, contact_ratio - math.floor(contact_ratio), 1.0], TURN / frequency


def transition_matrix(system):
    """Integrate piece by piece; at the ends of a piece the limit from inside is meant."""
    matrix, edges, period = system
    size = len(matrix(0.5))
    state = np.eye(size)
    for start, stop in pairwise(edges):
        inside = 1e-13 * (stop - start)

        def rate(x, flat, low=start + inside, high=stop - inside):
            return (period * matrix(min(max(x, low), high)) @ flat.reshape(size, size)).ravel()

        result = solve_ivp(rate, (start, stop), state.ravel(), method="DOP853", rtol=1e-13, atol=1e-15)
        state = result.y[:, -1].reshape(size, size)
    return state


def growth_rate(system):
    return math.log(np.abs(np.linalg.eigvals(transition_matrix(system))).max()) / system[2]


def held(system, edges):
    """Product of exponentials with the matrix held at the middle of each sub-interval."""
    matrix, _, period = system
    product = np.eye(len(matrix(0.5)))
    for start, stop in pairwise(edges):
        product = expm(matrix((start + stop) / 2) * (stop - start) * period) @ product
    return product


def equal_edges(count):
    return [p / count for p in range(count + 1)]


def relative_error(wrong, right):
    return np.abs(wrong - right).max() / np.abs(right).max()


# Start (q, q') at z = 0 and what vanishes at z = π/2, for motions even or odd about both: cosine and sine, of the
# period of the coefficient and of twice that.
FAMILIES = (((1, 0), 1), ((0, 1), 0), ((1, 0), 0), ((0, 1), 1))


def followed(end, family, number, depth):
    """Eigenvalue a of a boundary value problem, from a = m² at no depth to the depth asked for."""
    multiple = 2 * number if family < 2 else 2 * number - 1
    before, a = float(multiple**2), float(multiple**2)
    for step in range(1, 21):
        eps = depth * step / 20
        before, a = a, secant(lambda x, eps=eps: end(x, eps), 2 * a - before if step > 1 else a)
    return a


def polished(end_in_digits, a):
    """ω/ω0 = 2/√a from the root of the same problem in 20 digits."""
    with mpmath.workdps(20):
        root = mpmath.findroot(end_in_digits, (a, a * (1 + 1e-8)), solver="secant", tol=1e-30, verify=False)
        return float(2 / mpmath.sqrt(root))


def mathieu_border(family, number, depth):
    """ω/ω0 on a border: the boundary value problem q'' + a (1 + ε cos 2z) q = 0, a = (2/ω)², by shooting.

    Followed in double precision, polished with Taylor series.
    """
    start, component = FAMILIES[family]

    def end(a, eps):
        result = solve_ivp(
            lambda z, y: (y[1], -a * (1 + eps * math.cos(2 * z)) * y[0]),
            (0, math.pi / 2),
            start,
            method="DOP853",
            rtol=1e-11,
            atol=1e-12,
        )
        return result.y[component, -1]

    def end_in_digits(a):
        solution = mpmath.odefun(
            lambda z, y: [y[1], -a * (1 + mpmath.mpf(depth) * mpmath.cos(2 * z)) * y[0]], 0, start
        )
        return solution(mpmath.pi / 2)[component]

    return polished(end_in_digits, followed(end, family, number, depth))


def meissner_border(family, number, depth):
    """ω/ω0 on a border for a duty of one half: from the middle of the stiff part to that of the soft part.

    Followed in double precision, polished with matrix exponentials in 20 digits.
    """
    start, component = FAMILIES[family]

    def end(a, eps):
        state = np.array(start, dtype=float)
        for sign in (1, -1):
            state = expm(np.array([[0.0, 1.0], [-a * (1 + sign * eps), 0.0]]) * math.pi / 4) @ state
        return state[component]

    def end_in_digits(a):
        state = mpmath.matrix(start)
        for sign in (1, -1):
            square = a * (1 + sign * mpmath.mpf(depth))
            state = mpmath.expm(mpmath.matrix([[0, 1], [-square, 0]]) * mpmath.pi / 4) * state
        return state[component]

    return polished(end_in_digits, followed(end, family, number, depth))


def secant(function, guess):
    first, second = guess, guess * (1 + 1e-6)
    at_first, at_second = function(first), function(second)
    for _ in range(20):
        if abs(second - first) < 1e-11 * abs(second) or at_second == at_first:
            break
        third = second - at_second * (second - first) / (at_second - at_first)
        first, at_first, second, at_second = second, at_second, third, function(third)
    return second


def hsu_single_damped(depth, damping_ratio):
    """Borders of ω ≈ 2ω_d for Mathieu's equation: |coupling| = ε/(4ω_d) against ζ and half the detuning."""
    damped = math.sqrt(1.0 - damping_ratio**2)
    half_width = 2.0 * math.sqrt((depth / (4.0 * damped)) ** 2 - damping_ratio**2)
    return 2.0 * damped - half_width, 2.0 * damped + half_width


def hsu_pair(depth, coupling, circulation, damping):
    """Borders of ω ≈ ω_1 ± ω_2 of the coupled pair by (2-26) to (2-28), equal damping of both modes.

    Square roots of the eigenvalues of K by the quadratic formula; d_12 d_21 from the projection on the eigenvectors.
    """
    low_k, high_k = 1.0, 3.5
    product = coupling**2 - circulation**2
    mean, apart = (low_k + high_k) / 2, math.sqrt((high_k - low_k) ** 2 / 4 + product)
    squares = mean - apart, mean + apart
    frequencies = [math.sqrt(s - damping**2 / 4) for s in squares]
    # Share of the first coordinate in each mode: left times right component, which add up to one.
    share = (high_k - squares[0]) / (squares[1] - squares[0])
    exchange = depth**2 * share * (1.0 - share)
    sign = 1.0 if exchange > 0 else -1.0
    centre = frequencies[1] + sign * frequencies[0]
    strength = abs(exchange) / (frequencies[0] * frequencies[1])
    half_width = math.sqrt(strength - 4.0 * damping**2) / 2.0
    return centre, centre - half_width, centre + half_width
