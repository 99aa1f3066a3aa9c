"""Made-up systems with the structure of the transverse (28 states) and of the torsional model (6 states).

The disk: two nodal circles times nodal diameters 0 to 3 in cosine and sine, gyroscopic coupling, a slight
viscous loss, and contact points that move over the disk along an analytic path with kinks at four instants. No
gear geometry enters, so that the Floquet engine can be tested and timed without the chapters built on it.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

from facegear.floquet.loads import ContactLoad, Rate
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev

Array = NDArray[np.float64]

GEAR_TEETH = 130
LOSS_FACTOR = 5e-6  # [s]
# Natural frequencies at rest [rad/s], nodal circles by nodal diameters, in the range of a steel disk 7 mm thick.
FREQUENCIES = np.array([[1000.0, 1100.0, 1500.0, 2600.0], [5600.0, 6000.0, 7000.0, 8800.0]])
KINKS = np.array([0.0, 0.553, 0.554, 0.715])
CONTACT_STIFFNESS, CONTACT_DAMPING, CONTACT_MASS = 1.0e6, 10.0, 0.5


def contact_path(fraction: Array, piece: int) -> tuple[Array, Array]:
    """Relative radius and angle [rad] of the contact on one smooth piece; continuous over the whole period."""

    def entry(x: Array) -> tuple[Array, Array]:
        return 1.04 - 0.27 * np.sqrt(x + 0.066) - 0.05 * x, 0.01 * np.sin(1.5 * x) + 0.005 * x

    def step(x: Array) -> tuple[Array, Array]:
        radius, angle = entry(KINKS[1])
        return radius + 40.0 * (x - KINKS[1]), angle - 0.8 * (x - KINKS[1])

    def single(x: Array) -> tuple[Array, Array]:
        radius, angle = step(KINKS[2])
        return radius + 0.9 * (np.sqrt(x - KINKS[2] + 0.03) - np.sqrt(0.03)), angle + 0.02 * (x - KINKS[2])

    def exit_(x: Array) -> tuple[Array, Array]:
        (radius, angle), (first_radius, first_angle) = single(KINKS[3]), entry(np.float64(0.0))
        u = (x - KINKS[3]) / (1.0 - KINKS[3])
        bend = u + 0.3 * u * (1.0 - u)
        return radius + (first_radius - radius) * bend, angle + (first_angle - angle) * bend

    return (entry, step, single, exit_)[piece](fraction)


def shape_vector(radius: Array, angle: Array) -> Array:
    """Values of the 14 made-up modes at a point, shape (..., 14)."""
    x = (radius - 0.2) / 0.8
    circles = (3.0 * x**2 * (1.5 - 0.5 * x), -2.2 * x * np.sin(4.2 * x))
    columns = []
    for radial in circles:
        for diameter in range(4):
            amplitude = 0.45 * radial * (1.0 + 0.1 * diameter)
            if diameter == 0:
                columns.append(amplitude / np.sqrt(2.0))
            else:
                columns += [amplitude * np.cos(diameter * angle), amplitude * np.sin(diameter * angle)]
    return np.stack(columns, axis=-1)


def piece_of(fraction: float) -> int:
    """Smooth piece a fraction in [0, 1) lies on."""
    return int(np.searchsorted(KINKS, fraction, side="right")) - 1


def contact_shape(angle: float = 0.0, phase: float = 0.0) -> PiecewiseChebyshev:
    """Shape vector of a pinion at an angle [rad], ahead by a phase [-]."""

    def function(fraction: Array, piece: int) -> Array:
        radius, moved = contact_path(fraction, piece)
        return shape_vector(radius, moved + angle)

    return PiecewiseChebyshev.fit(function, KINKS).shift(phase)


PINIONS = ((0.0, 0.0), (2.0 * np.pi * 43.3 / GEAR_TEETH, 0.3), (2.0 * np.pi * 87.61 / GEAR_TEETH, 0.61))


def disk_matrices(speed: float) -> tuple[Array, Array]:
    """C and K of the spinning disk [rad/s] for M = I, each of shape (14, 14)."""
    damping, stiffness = np.zeros((14, 14)), np.zeros((14, 14))
    row = 0
    for circles in range(2):
        for diameters in range(4):
            square = FREQUENCIES[circles, diameters] ** 2 + 2.0 * speed**2
            rows = range(row, row + (1 if diameters == 0 else 2))
            for i in rows:
                damping[i, i] = LOSS_FACTOR * square
                stiffness[i, i] = square - (diameters * speed) ** 2
            if diameters:
                damping[row, row + 1], damping[row + 1, row] = (
                    -2.0 * diameters * speed,
                    2.0 * diameters * speed,
                )
                circulation = diameters * LOSS_FACTOR * speed * square
                stiffness[row, row + 1], stiffness[row + 1, row] = -circulation, circulation
            row = rows[-1] + 1
    return damping, stiffness


def synthetic_disk(
    speed: float, shapes: list[PiecewiseChebyshev], rate: Rate = "frozen", load: float = 1.0
) -> PeriodicSystem:
    """Build the disk at a speed [rad/s], one contact a shape; `load` scales mass, damping and stiffness."""
    damping, stiffness = disk_matrices(speed)
    loads = tuple(
        ContactLoad(shape, load * CONTACT_STIFFNESS, load * CONTACT_DAMPING, load * CONTACT_MASS, rate)
        for shape in shapes
    )
    return PeriodicSystem(np.eye(14), damping, stiffness, loads, 2.0 * np.pi / (GEAR_TEETH * speed))


@cache
def _mesh_shapes() -> tuple[PiecewiseChebyshev, PiecewiseChebyshev]:
    """Arms of two tooth pairs on three rotations: one leaves mesh at 0.5668 of the period, one stays."""

    def arms(x: Array) -> Array:
        return np.stack([0.0446 + 0.0 * x, -0.25 + 0.03 * x, 0.0 * x], axis=1)

    leaving = PiecewiseChebyshev.fit(lambda x, piece: arms(x) * (1 - piece), [0.0, 0.5668])
    return leaving, PiecewiseChebyshev.fit(lambda x, _: arms(x - 1.0), [0.0])


def synthetic_shafts(input_stiffness: float, period: float = 0.002) -> PeriodicSystem:
    """Build three inertias with 6 states; they rotate as a body where the shaft to ground is off."""
    loads = [ContactLoad(shape, 1.58e8, 200.0, 0.0, "total") for shape in _mesh_shapes()]
    inertia = np.diag([1.64e-3, 0.151, 0.166])
    shaft = 3e5
    stiffness = np.array([[input_stiffness, 0.0, 0.0], [0.0, shaft, -shaft], [0.0, -shaft, shaft]])
    return PeriodicSystem(inertia, 1e-6 * stiffness, stiffness, tuple(loads), period)
