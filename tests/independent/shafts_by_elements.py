"""Gearboxes with shafts that have mass, by quadratic finite elements and DOP853.

Shares no code with the package: rods are cut into elements whose matrices come from Gauss quadrature of their shape
functions, gears and mesh are those of (7-3) and (7-10) to (7-13) in :mod:`tests.independent.torsional_switching`.
"""

import math
from itertools import pairwise

import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import eigh

from tests.independent.torsional_switching import matrices, skew_line


def element(stiffness_length, inertia_per_length, width):
    """Stiffness and mass of an element of three nodes: G J_p and ρ J_p against its width."""
    points, weights = np.polynomial.legendre.leggauss(3)
    shapes = np.array([points * (points - 1) / 2, 1 - points**2, points * (points + 1) / 2])
    slopes = np.array([points - 0.5, -2 * points, points + 0.5]) * 2 / width
    stiffness = stiffness_length * (slopes * weights) @ slopes.T * width / 2
    mass = inertia_per_length * (shapes * weights) @ shapes.T * width / 2
    return stiffness, mass


def rod(k, length, G, rho, elements):
    """Stiffness and mass of a rod of stiffness k between its ends, nodes in order along it."""
    nodes = 2 * elements + 1
    stiffness, mass = np.zeros((nodes, nodes)), np.zeros((nodes, nodes))
    rigidity = k * length  # G J_p
    own = element(rigidity, rho * rigidity / G, length / elements)
    for first in range(0, nodes - 1, 2):
        part = slice(first, first + 3)
        stiffness[part, part] += own[0]
        mass[part, part] += own[1]
    return stiffness, mass


def craig_bampton(k, length, G, rho, modes, elements):
    """Matrices of a rod's ends and its modes with both ends held, from elements; modes scaled to amplitude 1."""
    stiffness, mass = rod(k, length, G, rho, elements)
    inner, count = slice(1, -1), len(mass)
    basis = np.zeros((count, 2 + modes))
    basis[:, 0], basis[:, 1] = np.linspace(1, 0, count), np.linspace(0, 1, count)
    if modes:
        _, vectors = eigh(stiffness[inner, inner], mass[inner, inner], subset_by_index=[0, modes - 1])
    for number in range(modes):
        shape = vectors[:, number]
        # Amplitude 1, and rising from the first end, by least squares on a sine.
        sine = np.sin((number + 1) * np.pi * np.linspace(0, 1, count)[inner])
        basis[inner, 2 + number] = shape * (sine @ sine) / (shape @ sine)
    return basis.T @ stiffness @ basis, basis.T @ mass @ basis


def gearbox(n, l1, l2, G, rho, elements):
    """Mass, stiffness and damping of J1, J2, Jo and all nodes inside both shafts, without the mesh.

    `elements` are those of the input shaft and of the output shaft.
    """
    inside = 2 * elements[0] - 1
    size = 3 + inside + 2 * elements[1] - 1
    M, K, C = (np.zeros((size, size)) for _ in range(3))
    M[:3, :3] = np.diag([n.J1, n.J2, n.Jo])
    first = [*range(3, 3 + inside), 0]  # the end that turns at a constant speed left out
    second = [1, *range(3 + inside, size), 2]
    shafts = ((first, n.k1, n.c1, l1, 1), (second, n.k2, n.c2, l2, 0))
    for (places, k, c, length, held), count in zip(shafts, elements, strict=True):
        stiffness, mass = (matrix[held:, held:] for matrix in rod(k, length, G, rho, count))
        M[np.ix_(places, places)] += mass
        K[np.ix_(places, places)] += stiffness
        C[np.ix_(places, places)] += c / k * stiffness
    return M, C, K


def reduced_gearbox(n, l1, l2, G, rho, modes, elements):
    """Reduce both shafts of :func:`gearbox` to their ends and modes."""
    size = 3 + 2 * modes
    M, K, C = (np.zeros((size, size)) for _ in range(3))
    M[:3, :3] = np.diag([n.J1, n.J2, n.Jo])
    shafts = (
        ([0, *range(3, 3 + modes)], n.k1, n.c1, l1, 1),
        ([1, 2, *range(3 + modes, size)], n.k2, n.c2, l2, 0),
    )
    for places, k, c, length, held in shafts:
        stiffness, mass = (x[held:, held:] for x in craig_bampton(k, length, G, rho, modes, elements))
        M[np.ix_(places, places)] += mass
        K[np.ix_(places, places)] += stiffness
        C[np.ix_(places, places)] += c / k * stiffness
    return M, C, K


def growth_rate(n, constant, speed_rpm, rtol=1e-11):
    """ln(max|λ|)/T0 of the constant matrices (M, C, K) with the mesh of (7-12), (7-13), split where pairs switch."""
    M, C0, K0 = constant
    size, T0, radius = len(M), 60.0 / (n.N2 * speed_rpm), skew_line(n)
    inverse = np.linalg.inv(M)
    state = np.eye(2 * size).ravel()
    shafts = matrices(n, 0.0, T0, [], radius, 0.0)  # the massless ones, which are in C0 and K0 already
    for start, stop in pairwise(sorted({0.0, n.cr - math.floor(n.cr), 1.0})):
        middle = (start + stop) / 2
        meshing = [pair for pair in range(math.ceil(n.cr)) if middle + pair < n.cr]

        def rate(x, flat, meshing=meshing, middle=middle):
            q, v = flat.reshape(2, size, 2 * size)
            C, K = C0.copy(), K0.copy()
            own = matrices(n, x, T0, meshing, radius, middle)
            C[:3, :3] += own[0] - shafts[0]
            K[:3, :3] += own[1] - shafts[1]
            return np.concatenate([v, -(T0 * (inverse @ (C @ v)) + T0**2 * (inverse @ (K @ q)))]).ravel()

        result = solve_ivp(rate, (start, stop), state, method="DOP853", rtol=rtol, atol=1e-13)
        assert result.success
        state = result.y[:, -1]
    radius_ = np.abs(np.linalg.eigvals(state.reshape(2 * size, 2 * size))).max()
    return float(np.log(radius_) / T0)
