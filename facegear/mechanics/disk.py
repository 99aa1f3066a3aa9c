"""The spinning disk alone, in real coordinates: shape vector, matrices, stiffness (4-9 to 4-16).

The disk is discretised by its own modes. With w = Σ R_mn(r) e^{inθ} η_mn (4-5) and η_-n the conjugate of η_n,
each pair ±n becomes √2 R_mn (A_mn cos nθ + B_mn sin nθ): as many real coordinates as complex ones, the same
motion, and nothing rescaled (:mod:`facegear.symbolic.galerkin` derives it). The deflection is w = φ(r, θ)ᵀq;
the equations are divided by 2πρh, as in (4-8), so that the mass matrix of the disk is the identity.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike
from scipy.linalg import block_diag

from facegear.floquet.models import Coordinate
from facegear.mechanics.plate import Body
from facegear.mechanics.radial_modes import RadialModes, centrifugal_stiffness
from facegear.support.parameters import finite_array, positive, rad_per_s
from facegear.support.types import FloatArray

REFERENCE_SPEED = float(rad_per_s(1000.0))
"""End of the speed range over which the reference stiffness is averaged [rad/s of the face gear]."""
REFERENCE_SAMPLES = 101


@dataclass(frozen=True)
class DiskMode:
    """One real mode of the disk, the shape of a generalised coordinate.

    Attributes
    ----------
    body : Body
    nodal_circles, nodal_diameters : int
        m and n.
    wave : {"cos", "sin"}
        cos nθ or sin nθ.
    """

    body: Body
    nodal_circles: int
    nodal_diameters: int
    wave: Literal["cos", "sin"]

    @property
    def inner_radius(self) -> float:
        """Radius of the bore [m]."""
        return self.body.bore_radius

    @property
    def outer_radius(self) -> float:
        """Radius of the rim [m]."""
        return self.body.outer_radius

    def deflection(self, radius: ArrayLike, angle: ArrayLike) -> FloatArray:
        """Component of the shape vector (:func:`shape_vector`) that belongs to this mode [1/m]."""
        return np.asarray(shape_vector(self.body, radius, angle)[..., disk_modes(self.body).index(self)])


def disk_modes(body: Body) -> tuple[DiskMode, ...]:
    """Modes of the disk, in the order of all matrices and shape vectors.

    Parameters
    ----------
    body : Body

    Returns
    -------
    tuple of DiskMode, length (M + 1)(2N + 1)
        By nodal diameters, cosine before sine, then by nodal circles.
    """
    waves: tuple[Literal["cos", "sin"], ...] = ("cos", "sin")
    return tuple(
        DiskMode(body, m, n, wave)
        for n in range(body.nodal_diameters + 1)
        for wave in (waves if n else waves[:1])
        for m in range(body.nodal_circles + 1)
    )


def mirror_signs(body: Body) -> FloatArray:
    """Signs that a reflection θ → −θ gives the coordinates, (n,): −1 for sine waves.

    A matrix of the disk becomes that of the reflected one by these from both sides.
    """
    return np.array([-1.0 if mode.wave == "sin" else 1.0 for mode in disk_modes(body)])


def disk_coordinates(body: Body, part: str = "face gear") -> tuple[Coordinate, ...]:
    """Generalised coordinates of the disk, one for each of :func:`disk_modes`.

    Parameters
    ----------
    body : Body
    part : str
        What the disk is called.

    Returns
    -------
    tuple of Coordinate
        In m²: shape vectors are in 1/m.

    Examples
    --------
    >>> from facegear.geometry.drive import Drive
    >>> disk_coordinates(Body(Drive(26, 130, 3.175e-3), thickness_ratio=0.03))[2].name
    'face gear (0, 1) cos'
    """
    return tuple(
        Coordinate(f"{part} ({mode.nodal_circles}, {mode.nodal_diameters}) {mode.wave}", "m²", part, mode)
        for mode in disk_modes(body)
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
        R_m0, √2 R_mn cos nθ and √2 R_mn sin nθ [1/m].

    Raises
    ------
    ValueError
        If a radius lies off the disk.
    """
    # Written so that NaN fails too; the slack covers the rounding of r/a at the edges.
    r, slack = finite_array("radius", radius, "m"), 1e-12 * body.outer_radius
    if not np.all((r >= body.bore_radius - slack) & (r <= body.outer_radius + slack)):
        raise ValueError(
            f"radius must lie on the disk, from {body.bore_radius:.6g} to {body.outer_radius:.6g} m, got {radius!r}"
        )
    x = r / body.outer_radius
    return unit_shape(body.modes, x, finite_array("angle", angle, "rad")) / body.outer_radius


def unit_shape(
    modes: tuple[RadialModes, ...], x: ArrayLike, angle: ArrayLike, *, by_radius: int = 0, by_angle: int = 0
) -> FloatArray:
    """Shape vector on unit outer radius, or a derivative of it.

    Parameters
    ----------
    modes : tuple of RadialModes
        `modes` of the body.
    x : array_like
        r/a [-]. A little beyond 1 the shapes are continued: R2 is measured along the pinion's axis, and a tooth
        enters mesh beside it, some thousandths further out.
    angle : array_like
        θ [rad]; broadcast against `x`.
    by_radius : {0, 1, 2}
        Order of the derivative in x.
    by_angle : int
        Order of the derivative in θ.

    Returns
    -------
    ndarray, shape (..., n)
    """
    x, angle = np.asarray(x, dtype=float), np.asarray(angle, dtype=float)
    shape = np.broadcast_shapes(x.shape, angle.shape)
    # Bessel functions are dear: they are asked for at each radius, not at each point.
    radii = x.reshape((1,) * (len(shape) - x.ndim) + x.shape)
    parts = []
    for n, radial in enumerate(modes):
        value = radial.continued(radii, by_radius) * float(n) ** by_angle
        if n == 0:
            parts.append(np.broadcast_to(value, (*value.shape[:1], *shape)))
        else:
            # A derivative turns the wave by a quarter.
            turned = n * angle + by_angle * np.pi / 2 if by_angle else n * angle
            parts += [math.sqrt(2) * value * np.cos(turned), math.sqrt(2) * value * np.sin(turned)]
    return np.moveaxis(np.concatenate(parts), 0, -1)


def disk_matrices(body: Body, speed: ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Damping and stiffness of the spinning disk in the space-fixed frame (4-9, 4-11), real basis.

    Parameters
    ----------
    body : Body
    speed : array_like
        Ω2 [rad/s]; negative for a disk that turns towards falling θ, as the second of two disks face to face.

    Returns
    -------
    damping, stiffness : ndarray, shape (..., n, n)
        C0 [1/s] and K0 [1/s²] for each speed; the mass matrix is the identity.

    Raises
    ------
    TypeError, ValueError
        If a speed is not a finite number.
    """
    omega = finite_array("speed", speed, "rad/s")[..., np.newaxis, np.newaxis]
    xi = body.material.viscous_loss_factor
    elastic, derivative, centrifugal = _disk_terms(body)
    return xi * elastic + 2 * omega * derivative, elastic + omega**2 * centrifugal + xi * omega * (
        elastic @ derivative
    )


@lru_cache(maxsize=256)  # a map over thickness goes through all its bodies, speed by speed
def _disk_terms(body: Body) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Build what the matrices of the disk are made of at any speed.

    Returns
    -------
    ndarray, each of shape (n, n)
        Squares of the natural frequencies [1/s²], ∂/∂θ [-], and what Ω2² multiplies: centrifugal stiffness with
        the part of ẅ that is ∂²/∂θ² [-].
    """
    circles = np.eye(body.nodal_circles + 1)
    # ∂/∂θ takes the pair (A, B) of A cos nθ + B sin nθ to n (B, -A).
    turning = np.array([[0.0, 1.0], [-1.0, 0.0]])
    elastic, centrifugal, derivative = [], [], []
    for n, modes in enumerate(body.modes):
        waves = 2 if n else 1
        elastic.append(np.tile(body.eigenvalues[:, n], waves))
        centrifugal.append(np.kron(np.eye(waves), centrifugal_stiffness(modes)))
        derivative.append(np.kron(n * turning[:waves, :waves], circles))
    T = block_diag(*derivative)
    terms = np.diag(np.concatenate(elastic)), T, block_diag(*centrifugal) + T @ T
    for term in terms:
        term.setflags(write=False)
    return terms


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
    _, stiffness = disk_matrices(body, speed)
    shape = shape_vector(body, radius, 0.0)
    compliance: FloatArray = np.linalg.solve(stiffness, shape[:, np.newaxis])[..., 0] @ shape
    return modal_mass(body) / compliance


def modal_mass(body: Body) -> float:
    """2πρh, by which (4-8) divides every load [kg/m²]."""
    return 2 * math.pi * body.material.density * body.thickness


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
    >>> from facegear.geometry.drive import Drive
    >>> f"{reference_stiffness(Body(Drive(26, 130, 3.175e-3), thickness_ratio=0.03)):.4e}"
    '1.0343e+06'
    """
    radius = (body.drive.inner_radius + body.drive.outer_radius) / 2
    speeds = np.linspace(0.0, positive("highest_speed", highest_speed, "rad/s"), REFERENCE_SAMPLES)
    return float(np.mean(disk_stiffness(body, speeds, radius)))
