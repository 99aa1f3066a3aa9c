"""Natural motions of a model over speed: which is which where curves cross, and where the mesh frequency meets them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq, linear_sum_assignment

from facegear.floquet.models import Model, require_model, system_at
from facegear.floquet.modes import NaturalMotions
from facegear.maps.axes import checked_speeds
from facegear.support.parameters import integer_within, positive
from facegear.support.threads import one_thread
from facegear.support.types import ComplexArray, FloatArray

if TYPE_CHECKING:
    import xarray

# Part of a motion that must be found again in the next for both to be one; else the step is halved, so many times.
_SAME, _HALVINGS = 0.9, 10
# Coordinates whose kinetic energies differ by less than this part move alike.
_ALIKE = 0.02
_MOST_HARMONICS = 20
# Relative difference from the mesh below which a motion is met at a speed that is given.
_ON = 1e-10


@dataclass(frozen=True, eq=False)
class _Motions:
    """Oscillating motions of the mean system at one speed.

    Attributes
    ----------
    speed, mesh_frequency : float
        [rad/s], [Hz].
    exponents : complex array, shape (m,)
        p [1/s], ascending by frequency.
    states : complex array, shape (2n, m)
        Columns (q, q̇) of unit energy.
    amplitudes : complex array, shape (m, 2n)
        Rows that take a state to the amplitude of each motion.
    energies : array, shape (n, m)
        Kinetic energy in each coordinate.
    """

    speed: float
    mesh_frequency: float
    exponents: ComplexArray
    states: ComplexArray
    amplitudes: ComplexArray
    energies: FloatArray

    @classmethod
    def at(cls, model: Model, speed: float) -> _Motions:
        system = system_at(model, speed)
        found = NaturalMotions.of_mean(system)
        kept = found.oscillating
        states = np.concatenate([found.displacements[:, kept], found.velocities[:, kept]])
        size = np.linalg.norm(found.from_state @ states, axis=0)
        # Nearly dependent motions, as at critical damping, only blur the parts.
        rows = (np.linalg.pinv(found.vectors) @ found.from_state)[kept] * size[:, np.newaxis]
        # By the symmetric root of the mass, which shares out what couples two coordinates evenly: never negative.
        values, axes = np.linalg.eigh(found.mass)
        root = (axes * np.sqrt(np.maximum(values, 0.0))) @ axes.T
        energies = np.abs(root @ found.velocities[:, kept]) ** 2
        return cls(
            speed,
            1.0 / system.period,
            found.exponents[kept],
            states / size,
            rows,
            energies,
        )

    def parts_of(self, other: _Motions) -> FloatArray:
        """Parts of these motions in those of another speed, (m, m of the other)."""
        return np.asarray(np.abs(self.amplitudes @ other.states))


@one_thread()
def campbell(model: Model, speeds: ArrayLike, *, harmonics: int = 3) -> xarray.Dataset:
    """Natural frequencies and damping of the mean system over speed, each motion followed through crossings.

    Parameters
    ----------
    model : Model
    speeds : array_like, shape (S,)
        Speeds [rad/s], greater than 0, ascending. Between two of them steps are halved until motions are told apart.
    harmonics : int
        Harmonics of the mesh frequency that are to meet them, 1 to 20.

    Returns
    -------
    xarray.Dataset
        Along "mode" and "speed": ``natural_frequency`` [Hz] (damped), ``damping_ratio`` [-] and ``log_decrement`` [-];
        not a number where a motion does not oscillate. ``mode`` numbers motions by their frequency at the first speed
        at which they are there, ``mode_name`` says which coordinates move most then. Along "speed":
        ``mesh_frequency`` [Hz]. Along "crossing": ``crossing_speed`` [rad/s], at which the harmonic
        ``crossing_harmonic`` of the mesh frequency meets the motion ``crossing_mode``. They are found where the
        difference changes its sign from one of the speeds given to the next: two between the same two are missed.

    Raises
    ------
    TypeError, ValueError
        Naming the argument.

    Examples
    --------
    Waves of a disk run with its rotation and against it: of one nodal diameter, at 600 rpm, by 10 Hz each.

    >>> import facegear as fg
    >>> body = fg.Body(fg.Drive(26, 130, 3.175e-3), thickness_ratio=0.03, nodal_circles=0, nodal_diameters=1)
    >>> disk = fg.Transverse(body, fg.MeshLoad(stiffness=0.0, damping=0.0, mass=0.0))
    >>> found = fg.campbell(disk, fg.rad_per_s([1.0, 600.0]))
    >>> found.mode_name.values.tolist()
    ['face gear (0, 1)', 'face gear (0, 1)', 'face gear (0, 0)']
    >>> against, along, _ = found.natural_frequency.values[:, -1]
    >>> round(float(along - against), 6)
    20.0
    """
    import xarray

    require_model(model)
    axis = checked_speeds(speeds)
    count = integer_within("harmonics", harmonics, 1, _MOST_HARMONICS)
    first = _Motions.at(model, float(axis[0]))
    tracks = list(range(first.exponents.size))
    names = [_name(first, mode, _names(model, first)) for mode in tracks]
    shown = [(first, tracks)]
    for speed in axis[1:].tolist():
        shown.append(_followed(model, *shown[-1], speed, names, _HALVINGS))
    exponents = np.full((len(names), axis.size), complex(np.nan, np.nan))
    for place, (motions, owners) in enumerate(shown):
        exponents[owners, place] = motions.exponents
    ratio = -exponents.real / np.abs(exponents)
    mesh = np.array([motions.mesh_frequency for motions, _ in shown])
    crossings = _crossings(model, shown, exponents, count)
    both = ("mode", "speed")
    return xarray.Dataset(
        {
            "natural_frequency": (both, exponents.imag / (2 * math.pi), {"units": "Hz"}),
            "damping_ratio": (both, ratio, {"units": "1"}),
            "log_decrement": (both, 2 * math.pi * ratio / np.sqrt(1.0 - ratio**2), {"units": "1"}),
            "mesh_frequency": ("speed", mesh, {"units": "Hz"}),
            "crossing_speed": (
                "crossing",
                np.array([c[0] for c in crossings], dtype=float),
                {"units": "rad/s"},
            ),
            "crossing_mode": ("crossing", np.array([c[1] + 1 for c in crossings], dtype=int)),
            "crossing_harmonic": ("crossing", np.array([c[2] for c in crossings], dtype=int)),
        },
        {
            "mode": np.arange(1, len(names) + 1),
            "mode_name": ("mode", names),
            "speed": ("speed", axis, {"units": "rad/s"}),
        },
        {"model": repr(model)},
    )


def _followed(
    model: Model, before: _Motions, owners: Sequence[int], speed: float, names: list[str], halvings: int
) -> tuple[_Motions, list[int]]:
    """Motions at a speed, and which track each belongs to; those that are new get a name."""
    here = _Motions.at(model, speed)
    parts = before.parts_of(here)
    rows, columns = linear_sum_assignment(-parts)
    if halvings and rows.size and parts[rows, columns].min() < _SAME:
        middle = (before.speed + speed) / 2.0
        halfway, known = _followed(model, before, owners, middle, names, halvings - 1)
        return _followed(model, halfway, known, speed, names, halvings - 1)
    found = dict(zip(columns.tolist(), (owners[row] for row in rows.tolist()), strict=True))
    for mode in range(here.exponents.size):
        if mode not in found:
            found[mode] = len(names)
            names.append(_name(here, mode, _names(model, here)))
    return here, [found[mode] for mode in range(here.exponents.size)]


def _names(model: Model, motions: _Motions) -> list[str]:
    """Names of the coordinates, their numbers where the model does not name each of them."""
    named = [coordinate.name for coordinate in getattr(model, "coordinates", ())]
    size = motions.energies.shape[0]
    return named if len(named) == size else [f"coordinate {number + 1}" for number in range(size)]


def _name(motions: _Motions, mode: int, names: Sequence[str]) -> str:
    """Name the coordinates that move most in a motion; cosine and sine of one shape are named once."""
    energy = motions.energies[:, mode]
    most = [name for name, part in zip(names, energy, strict=True) if part > (1.0 - _ALIKE) * energy.max()]
    return " and ".join(dict.fromkeys(name.removesuffix(" cos").removesuffix(" sin") for name in most))


def _crossings(
    model: Model, shown: Sequence[tuple[_Motions, list[int]]], exponents: ComplexArray, harmonics: int
) -> list[tuple[float, int, int]]:
    """Speeds at which harmonics of the mesh frequency meet motions: speed, track, harmonic, ascending."""
    found = []
    for place, ((before, owners), (after, _)) in enumerate(pairwise(shown)):
        for mode, track in enumerate(owners):
            ends = exponents[track, place : place + 2].imag / (2 * math.pi)
            for harmonic in range(1, harmonics + 1):
                mesh = harmonic * np.array([before.mesh_frequency, after.mesh_frequency])
                low, high = np.where(np.abs(ends - mesh) < _ON * mesh, 0.0, ends - mesh)
                # What lies on a speed belongs to the step that begins there, the last one to the last step.
                last = place == len(shown) - 2
                if low == 0.0 or low * high < 0.0 or (high == 0.0 and last):
                    at = (
                        _meets(model, before, mode, harmonic, after.speed)
                        if low and high
                        else float(before.speed if low == 0.0 else after.speed)
                    )
                    found.append((at, track, harmonic))
    return sorted(found)


def _meets(model: Model, before: _Motions, mode: int, harmonic: int, stop: float) -> float:
    """Speed at which a motion meets a harmonic, between that where it is known and another."""

    def apart(speed: float) -> float:
        here = _Motions.at(model, speed)
        same = int(before.parts_of(here)[mode].argmax())
        return float(here.exponents[same].imag / (2 * math.pi) - harmonic * here.mesh_frequency)

    if apart(before.speed) * apart(stop) > 0.0:
        # The motion is another one at the far end, where they veer: what is between is a straight line.
        return (before.speed + stop) / 2.0
    return float(brentq(apart, before.speed, stop, rtol=1e-12))


def mode_shapes(model: Model, speed: float) -> xarray.Dataset:
    """Natural motions of the mean system at a speed: how much each coordinate moves, and when.

    Parameters
    ----------
    model : Model
    speed : float
        [rad/s], greater than 0.

    Returns
    -------
    xarray.Dataset
        Along "mode", ascending by frequency: ``natural_frequency`` [Hz], ``damping_ratio`` [-], ``mode_name``. Along
        "mode" and "coordinate": ``amplitude``, the largest of each motion 1, and ``phase`` [rad], q ~ cos(ωt + phase),
        that of the largest 0, each coordinate in its own unit; ``energy_share``, of the kinetic energy, by
        the symmetric root of the mass where that couples coordinates, 1 in all.

    Raises
    ------
    TypeError, ValueError
        Naming the argument.

    Examples
    --------
    >>> import facegear as fg
    >>> from facegear.mechanics.gearboxes import FIGURES
    >>> found = fg.mode_shapes(FIGURES["7.12a"].model(), fg.rad_per_s(500.0))
    >>> found.mode_name.values.tolist()
    ['load', 'face gear', 'pinion']
    """
    import xarray

    require_model(model)
    motions = _Motions.at(model, positive("speed", speed, "rad/s"))
    n = motions.energies.shape[0]
    moved = motions.states[:n]
    largest = moved[np.abs(moved).argmax(axis=0), np.arange(moved.shape[1])]
    relative = (moved / largest).T
    both = ("mode", "coordinate")
    ratio = -motions.exponents.real / np.abs(motions.exponents)
    modes, names = range(motions.exponents.size), _names(model, motions)
    return xarray.Dataset(
        {
            "natural_frequency": ("mode", motions.exponents.imag / (2 * math.pi), {"units": "Hz"}),
            "damping_ratio": ("mode", ratio, {"units": "1"}),
            "amplitude": (both, np.abs(relative), {"units": "1"}),
            "phase": (both, np.angle(relative), {"units": "rad"}),
            "energy_share": (both, (motions.energies / motions.energies.sum(axis=0)).T, {"units": "1"}),
        },
        {
            "mode": np.arange(1, motions.exponents.size + 1),
            "mode_name": ("mode", [_name(motions, mode, names) for mode in modes]),
            "coordinate": names,
        },
        {"model": repr(model), "speed": float(speed)},
    )
