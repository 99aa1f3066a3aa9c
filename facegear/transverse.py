"""Transverse vibration of a face gear with one or more spur pinions (chapters 4 and 5).

The disk is discretised by its own modes. With w = Σ R_mn(r) e^{inθ} η_mn (4-5) and η_-n the conjugate of η_n,
each pair ±n becomes √2 R_mn (A_mn cos nθ + B_mn sin nθ): as many real coordinates as complex ones, the same
motion, and nothing rescaled (:mod:`facegear.symbolic.galerkin` derives it). All coordinates carry √(2πρh),
so that the mass matrix of the disk is the identity and the deflection under a pinion is φᵀq [m].
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from facegear.parameters import FloatArray, MeshLoad, nonnegative, positive, rad_per_s, within
from facegear.periodic import ContactLoad, PeriodicSystem, Rate
from facegear.piecewise import PiecewiseChebyshev
from facegear.plate import Body, centrifugal_stiffness

REFERENCE_SPEED = float(rad_per_s(1000.0))
"""End of the speed range over which the reference stiffness is averaged [rad/s of the face gear]."""
REFERENCE_SAMPLES = 101


class Coordinate(NamedTuple):
    """One generalised coordinate of the disk."""

    nodal_circles: int
    nodal_diameters: int
    wave: str
    """"cos" or "sin"."""


def coordinates(body: Body) -> tuple[Coordinate, ...]:
    """Generalised coordinates of the disk, in the order of all matrices and shape vectors.

    Parameters
    ----------
    body : Body

    Returns
    -------
    tuple of Coordinate, length (M + 1)(2N + 1)
        By nodal diameters, cosine before sine, then by nodal circles.
    """
    return tuple(
        Coordinate(m, n, wave)
        for n in range(body.nodal_diameters + 1)
        for wave in (("cos", "sin") if n else ("cos",))
        for m in range(body.nodal_circles + 1)
    )


def shape_vector(body: Body, radius: ArrayLike, angle: ArrayLike) -> FloatArray:
    """Shape vector φ of the real basis: the deflection at a point is w = φᵀq.

    Parameters
    ----------
    body : Body
    radius : array_like
        r [m], between bore and rim.
    angle : array_like
        θ [rad]; broadcast against `radius`.

    Returns
    -------
    ndarray, shape (..., n)
        R_m0, √2 R_mn cos nθ, √2 R_mn sin nθ, over √(2πρh) [1/√kg].

    Raises
    ------
    ValueError
        If a radius lies off the disk.
    """
    radius, angle = np.broadcast_arrays(np.asarray(radius, dtype=float), np.asarray(angle, dtype=float))
    parts = []
    for n, modes in enumerate(body.modes):
        radial = modes(radius / body.outer_radius) / body.outer_radius
        if n == 0:
            parts.append(radial)
        else:
            parts += [math.sqrt(2) * radial * np.cos(n * angle), math.sqrt(2) * radial * np.sin(n * angle)]
    scale = math.sqrt(2 * math.pi * body.material.density * body.thickness)
    return np.moveaxis(np.concatenate(parts), 0, -1) / scale


def disk_matrices(body: Body, speed: float) -> tuple[FloatArray, FloatArray]:
    """Damping and stiffness of the spinning disk in the space-fixed frame (4-9, 4-11), real basis.

    Parameters
    ----------
    body : Body
    speed : float
        Ω2 [rad/s], 0 or greater.

    Returns
    -------
    damping, stiffness : ndarray, shape (n, n)
        C0 [1/s] and K0 [1/s²]; the mass matrix is the identity.
    """
    speed = nonnegative("speed", speed, "rad/s")
    xi = body.material.viscous_loss_factor
    per_circle = body.nodal_circles + 1
    size = per_circle * (2 * body.nodal_diameters + 1)
    damping, stiffness = np.zeros((size, size)), np.zeros((size, size))
    turning = np.array([[0.0, 1.0], [-1.0, 0.0]])
    start = 0
    for n, modes in enumerate(body.modes):
        waves = 2 if n else 1
        block = slice(start, start + waves * per_circle)
        start = block.stop
        # ∂/∂θ takes (A, B) of A cos nθ + B sin nθ to n (B, -A).
        derivative = np.kron(n * turning[:waves, :waves], np.eye(per_circle))
        elastic = np.diag(np.tile(body.eigenvalues[:, n], waves))
        centrifugal = np.kron(np.eye(waves), speed**2 * centrifugal_stiffness(modes))
        damping[block, block] = xi * elastic + 2 * speed * derivative
        stiffness[block, block] = (
            elastic + centrifugal + xi * speed * elastic @ derivative + speed**2 * derivative @ derivative
        )
    return damping, stiffness


def disk_stiffness(body: Body, speed: ArrayLike, radius: float) -> FloatArray:
    """Stiffness of the spinning disk against a force at rest in space (4-14 to 4-16).

    Parameters
    ----------
    body : Body
    speed : array_like
        Ω2 [rad/s], 0 or greater.
    radius : float
        r_d [m] where the force acts.

    Returns
    -------
    ndarray
        k_d, force over steady deflection under it [N/m], of the shape of `speed`.
    """
    speeds = np.asarray(speed, dtype=float)
    stiffness = np.stack([disk_matrices(body, float(value))[1] for value in speeds.ravel()])
    shape = shape_vector(body, radius, 0.0)
    compliance = np.linalg.solve(stiffness, shape[:, np.newaxis])[..., 0] @ shape
    return np.reshape(1.0 / compliance, speeds.shape)


@lru_cache(maxsize=256)
def reference_stiffness(body: Body, highest_speed: float = REFERENCE_SPEED) -> float:
    """Stiffness of the disk that bearing stiffnesses are measured by (denominator of 4-17).

    Parameters
    ----------
    body : Body
    highest_speed : float
        End of the range of Ω2 [rad/s] over which 101 equally spaced values are averaged.

    Returns
    -------
    float
        Average of k_d at radius (R1 + R2)/2 [N/m].

    Examples
    --------
    >>> from facegear.geometry import Drive
    >>> f"{reference_stiffness(Body(Drive(26, 130, 3.175e-3), thickness_ratio=0.03)):.4e}"
    '1.0343e+06'
    """
    radius = (body.drive.inner_radius + body.drive.outer_radius) / 2
    speeds = np.linspace(0.0, positive("highest_speed", highest_speed, "rad/s"), REFERENCE_SAMPLES)
    return float(np.mean(disk_stiffness(body, speeds, radius)))


def nominal_pinion_mass(body: Body) -> float:
    """Mass of the pinion as a solid cylinder, ρπr_p²(L2 - L1), the denominator of (4-19) [kg]."""
    drive = body.drive
    return body.material.density * math.pi * drive.pitch_radius**2 * drive.face_width
