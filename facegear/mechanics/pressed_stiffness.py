"""How stiff against bending a force that presses on the disk makes it there.

Where the disk bends by w = Σ q_i φ_i it is drawn in: its points move in its plane by u = ½ Σ q_i q_j
v_ij, with v_ij the field, held at the bore and free of load, that relaxes the strain E_ij = sym(∇φ_i ⊗ ∇φ_j). A dead
force has the potential -F·u, and thus the stiffness

    K_ij = -F·v_ij at the place where it acts.

By Betti's theorem this is the work ∫ σ : E_ij h dA of its stresses (6-27); the acceleration of the steady field is
symmetric too, so that it holds for a spinning disk. But the force may act anywhere: v_ij is smooth where σ has a pole
under the force. Averages of a smooth field over a patch need a few points, and there is no field to be solved with a
force inside the disk. A force that follows the slope of the disk pushes sideways on the deflection under it, and adds
-φ_i (F_θ φ_j,θ/r + F_r φ_j,r) at each of its points: the one part that is not symmetric.

In the harmonic k the amplitudes of v obey the equations of :mod:`facegear.mechanics.inplane` with the right-hand sides

    U' = ... - x(E_rr + ν E_θθ),    V' = ... - 2x E_rθ,    P' = ... + x E_θθ,    Q' = ... - k x E_θθ

and S = T = 0 at the rim (:func:`facegear.symbolic.inplane.drawn_in` derives them). All that is asked of the solution is
its value at points, a linear functional; so one solution of the transposed equations for each k serves all i, j.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from facegear.geometry.drive import Drive
from facegear.mechanics.disk import unit_shape
from facegear.mechanics.inplane import (
    collocation_points,
    collocation_system,
    edge_rows,
    resolving_degree,
    spin_per_speed,
)
from facegear.mechanics.plate import Body
from facegear.mechanics.pressed_points import Spread, points_from
from facegear.support.types import ComplexArray, FloatArray


class PressedStiffness(NamedTuple):
    """Stiffness K_f of forces whose moment is that of 1 N at the rim, in two parts [1/(s² N)].

    Attributes
    ----------
    dead : ndarray, shape (n, n)
        Of forces that keep their direction; symmetric.
    following : ndarray, shape (n, n)
        What is added for forces that follow the slope of the disk.
    """

    dead: FloatArray
    following: FloatArray


def pressed_stiffness(
    body: Body, speed: float, harmonics: int, angles: tuple[float, ...], spread: Spread
) -> PressedStiffness:
    """Sum of K_f of equal forces at several angles.

    Parameters
    ----------
    body : Body
    speed : float
        Ω2 [rad/s].
    harmonics : int
        Largest k of the forces.
    angles : tuple of float
        Of the pinions [rad].
    spread : Spread
        Where each presses.

    Returns
    -------
    PressedStiffness
    """
    c, nu = body.bore_ratio, body.material.poissons_ratio
    spin = speed * spin_per_speed(body)
    harmonics = min(harmonics, 2 * body.nodal_diameters)
    degree = _degree(body)
    grid = _disk_grid(body, harmonics)
    x = _radii(c, degree)
    moments = _moments(spread, body.drive, c, degree, harmonics)
    # What each harmonic of the forces asks of E_rr, E_rθ, E_θθ at radii and angles; and the forces themselves.
    radial, mixed, hoop = (np.zeros((degree + 1, grid.angles.size)) for _ in range(3))
    pushed = np.zeros((2, degree + 1, grid.angles.size))
    for k in range(harmonics + 1):
        turned = moments[:, k] * np.exp(1j * k * np.asarray(angles)).sum()
        sine, cosine = np.sin(k * grid.angles), np.cos(k * grid.angles)
        part = (2 if k else 1) / grid.angles.size
        asked = part * _asked(c, nu, spin, k, turned)
        radial += np.outer(asked[0, :, 0], sine) + np.outer(asked[0, :, 1], cosine)
        mixed += np.outer(asked[1, :, 0], cosine) - np.outer(asked[1, :, 1], sine)
        hoop += np.outer(asked[2, :, 0], sine) + np.outer(asked[2, :, 1], cosine)
        pushed += part * (turned.real[..., np.newaxis] * cosine + turned.imag[..., np.newaxis] * sine)

    by_radius, by_angle = grid.by_radius, grid.by_angle / x[:, np.newaxis, np.newaxis]
    dead = _work(by_radius, radial, by_radius) + _work(by_angle, hoop, by_angle)
    crossed = _work(by_radius, mixed, by_angle) / 2
    dead += crossed + crossed.T
    tilted = _work(grid.value, pushed[0], by_angle) + _work(grid.value, pushed[1], by_radius)
    scale = -1.0 / (2 * math.pi * body.material.density * body.thickness * body.outer_radius**3)
    return PressedStiffness(scale * dead, scale * tilted)


def _work(left: FloatArray, weights: FloatArray, right: FloatArray) -> FloatArray:
    """Sum over radii and angles, (R, A, n), (R, A) and (R, A, n) to (n, n)."""
    product: FloatArray = np.tensordot(left, weights[:, :, np.newaxis] * right, axes=((0, 1), (0, 1)))
    return product


def _asked(c: float, nu: float, spin: float, k: int, forces: ComplexArray) -> FloatArray:
    """Factors of the amplitudes of E_rr, E_rθ, E_θθ at the radii in the work of forces on v.

    Parameters
    ----------
    forces : complex array, shape (2, radii)
        Sum of e^{ikθ} times tangential and radial force, in factors of values at the radii.

    Returns
    -------
    ndarray, shape (3, radii, 2)
        Of the amplitudes of sin, cos, sin, and of those of the field a quarter of a wave on, cos, -sin, cos.
    """
    size = forces.shape[1]
    tangential, radial = forces
    asked = np.zeros((4, size, 2))
    asked[0] = np.stack([radial.imag, radial.real], axis=-1)
    asked[1] = np.stack([tangential.real, -tangential.imag], axis=-1)
    system = collocation_system(c, nu, spin, k, size - 1)
    answer = np.linalg.solve(system.T, asked.reshape(4 * size, 2))
    answer[edge_rows(size - 1)] = 0.0  # the conditions at the edges have no right-hand side
    u, v, p, q = _radii(c, size - 1)[:, np.newaxis] * answer.reshape(4, size, 2)
    return np.stack([-u, -2 * v, -nu * u + p - k * q])


class _DiskGrid(NamedTuple):
    """Basis functions and their derivatives in x and θ at radii and angles, each of shape (radii, angles, n)."""

    angles: FloatArray
    value: FloatArray
    by_radius: FloatArray
    by_angle: FloatArray


def _degree(body: Body) -> int:
    """Degree that resolves the drawn-in field of all pairs of modes to rounding."""
    return resolving_degree(body.bore_ratio, 2 * body.nodal_diameters) + 8 * body.nodal_circles


def _radii(bore_ratio: float, degree: int) -> FloatArray:
    """Radii x = r/a of the points of the collocation, from the rim to the bore."""
    t, _ = collocation_points(degree)
    radii: FloatArray = np.exp(-math.log(bore_ratio) / 2 * (t - 1.0))
    return radii


@lru_cache(maxsize=64)
def _disk_grid(body: Body, harmonics: int) -> _DiskGrid:
    # Products of two modes and a harmonic have at most 2N + K waves: with more points than that sums are exact.
    count = 2 * body.nodal_diameters + harmonics + 1
    angles = 2 * np.pi * np.arange(count) / count
    x = _radii(body.bore_ratio, _degree(body))[:, np.newaxis]
    parts = (unit_shape(body.modes, x, angles, by_radius=i, by_angle=j) for i, j in ((0, 0), (1, 0), (0, 1)))
    return _DiskGrid(angles, *parts)


@lru_cache(maxsize=256)
def _moments(spread: Spread, drive: Drive, bore_ratio: float, degree: int, harmonics: int) -> ComplexArray:
    """Sum of e^{ikθ} times tangential and radial force, in factors of values at the radii; (2, K + 1, radii)."""
    points = points_from(spread, drive, bore_ratio)
    t, _ = collocation_points(degree)
    local = 1.0 - np.log(points.radius) / (math.log(bore_ratio) / 2)
    to_points = np.linalg.solve(chebyshev.chebvander(t, degree).T, chebyshev.chebvander(local, degree).T)
    waves = np.exp(1j * np.multiply.outer(np.arange(harmonics + 1), points.angle))
    found = np.stack([(waves * force) @ to_points.T for force in (points.tangential, points.radial)])
    found.setflags(write=False)
    return found
