"""Two face gears face to face that share pinions, as in split-torque gearboxes (section 8.2, Fig. 1.10).

Both gears mesh with every pinion, from below and from above. Turned by half a turn about the axis of a pinion, the mesh
below is the mesh above: the upper gear turns the other way, its contact runs along the mirrored path at the same
instants, and half a turn is N1/2 teeth of the pinion. Both gears are on one axis, square to those of the pinions: at
another shaft angle the upper gear would be one of another kind. A pinion stands between the gears only where its teeth
fit into both: from one pinion to another the lower gear turns its mesh by θ/θ_N periods and the upper one by −θ/θ_N, so
that angles differ by whole halves of the angular pitch θ_N.

A pinion that drives both gears is an *input*. An *idler* takes torque from the upper gear and gives it to the lower: on
the upper gear it presses with the other flanks of its teeth, whose contact is mirrored and runs backwards
(:meth:`facegear.mechanics.contact.LoadPlace.coasting`). An *output* does so on both.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Literal, NamedTuple, cast

import numpy as np

from facegear.floquet.loads import ContactLoad
from facegear.floquet.models import Coordinate
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.geometry.drive import Drive
from facegear.geometry.timed_pairs import mesh_period
from facegear.mechanics.contact import Contact
from facegear.mechanics.disk import disk_coordinates, disk_matrices, mirror_signs, modal_mass, unit_shape
from facegear.mechanics.mesh_oscillator import MeshOscillator
from facegear.mechanics.pinions_on_disk import Driving, PinionsOnDisk
from facegear.mechanics.radial_modes import RadialModes
from facegear.support.kinds import require_kind
from facegear.support.parameters import keep, one_of, positive
from facegear.support.types import FloatArray

Role = Literal["input", "idler", "output"]

DRIVES: dict[str, tuple[bool, bool]] = {
    "input": (True, True),
    "idler": (True, False),
    "output": (False, False),
}
"""Whether a pinion drives the lower and the upper gear, or is driven by it, by its role."""

# Parts of half an angular pitch by which a pinion may miss its place.
_FITS = 1e-6


def fitting_angles(drive: Drive, angles: Sequence[float]) -> tuple[float, ...]:
    """Angles at which pinions fit between two gears, the nearest to given ones [rad].

    Parameters
    ----------
    drive : Drive
    angles : sequence of float
        The first stays; those that fit, to a millionth of half an angular pitch, stay too.
    """
    half = 0.5 * drive.angular_pitch
    steps = [(angle - angles[0]) / half for angle in angles]
    return tuple(
        angle if abs(step - round(step)) <= _FITS else angles[0] + round(step) * half
        for angle, step in zip(angles, steps, strict=True)
    )


@dataclass(frozen=True)
class TwoGears:
    """Transverse vibration of two equal face gears that share their pinions, each pinion on the springs of its teeth.

    An input drives both gears; an idler takes torque from the upper gear and gives it to the lower; an output is driven
    by both. All meshes carry the same torque, and have the same force in the plane of their gear: a pinion that drives
    a gear pushes it the way it turns, one that is driven holds it back.

    Parameters
    ----------
    gear : MeshOscillator
        The lower gear with its pinions, all on its front, without phases of their own; the upper gear is another like
        it. Its `force` is that of each mesh: an input brings in twice the power.
    roles : sequence of {"input", "idler", "output"}, optional
        What each pinion does. Default: all are inputs.

    Raises
    ------
    TypeError, ValueError
        If an argument is of the wrong kind or outside its range, or a pinion does not fit between the gears.

    Examples
    --------
    >>> import facegear as fg
    >>> body, load = fg.Body(fg.Drive(26, 130, 3.175e-3), thickness_ratio=0.03), fg.MeshLoad(1.0, 3e-6, 1.0)
    >>> angles = tuple(body.drive.angular_pitch * teeth for teeth in (0, 65))
    >>> teeth = fg.mesh_stiffness(body.drive, correction_factor=0.5)
    >>> gear = fg.MeshOscillator(body, load, angles, mesh_stiffness=teeth, mesh_damping=1e-5)
    >>> fg.TwoGears(gear, roles=("input", "idler")).system(speed=50.0).size
    30
    """

    gear: MeshOscillator
    roles: Sequence[Role] | None = None

    def __post_init__(self) -> None:
        require_kind("gear", self.gear, MeshOscillator)
        for name in ("sides", "phases"):
            if (value := getattr(self.gear, name)) is not None:
                raise ValueError(f"gear.{name} must be None between two gears, got {value!r}")
        if self.gear.clocking != 0.0:
            raise ValueError(f"gear.clocking must be 0 between two gears, got {self.gear.clocking!r}")
        shaft = self.gear.body.drive.shaft_angle
        if abs(shaft - math.pi / 2.0) > _FITS:
            raise ValueError(
                "gear.body.drive.shaft_angle must be a right angle, or two gears on one axis are not alike, got "
                f"{shaft!r} rad"
            )
        if self.roles is not None:
            if not isinstance(self.roles, list | tuple) or len(self.roles) != len(self.gear.pinion_angles):
                raise ValueError(
                    f"roles must list one a pinion, {len(self.gear.pinion_angles)}, got {self.roles!r}"
                )
            for role in self.roles:
                one_of("roles", role, tuple(DRIVES))
            keep(self, roles=tuple(self.roles))
        self._require_fit()

    def _require_fit(self) -> None:
        """Refuse pinions whose teeth do not fit into both gears."""
        angles = self.gear.pinion_angles
        for angle, near in zip(angles, fitting_angles(self.gear.body.drive, angles), strict=True):
            if angle != near:
                raise ValueError(
                    "gear.pinion_angles must differ by whole halves of the angular pitch, or teeth do not fit into "
                    f"both gears, got {angle!r} rad; the nearest that fits is {near!r} rad"
                )

    @property
    def duties(self) -> tuple[str, ...]:
        """What each pinion does: `roles` if given, else all are inputs."""
        return ("input",) * len(self.gear.pinion_angles) if self.roles is None else tuple(self.roles)

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Modes of the lower and the upper disk, and w_m of each pinion, all along the axis of the lower one."""
        body, pinions = self.gear.body, self.gear.coordinates[-len(self.gear.pinion_angles) :]
        lower, upper = (disk_coordinates(body, part) for part in ("lower face gear", "upper face gear"))
        return (*lower, *upper, *pinions)

    def with_gear(self, gear: PinionsOnDisk) -> TwoGears:
        """Return two other gears, with pinions in the same roles; errors as of the class."""
        return replace(self, gear=cast("MeshOscillator", gear))

    @property
    def driving(self) -> tuple[Driving, ...]:
        """How the lower and the upper gear are driven, each seen as it turns."""
        (driving,) = self.gear.driving
        lower, upper = (
            tuple(1 if DRIVES[duty][above] else -1 for duty in self.duties) for above in (False, True)
        )
        return Driving(driving.angles, lower), Driving(tuple(-angle for angle in driving.angles), upper)

    @property
    def contact_ratio(self) -> float:
        """Mesh periods that a tooth pair stays in mesh."""
        return self.gear.contact_ratio

    @cached_property
    def loads(self) -> tuple[ContactLoad, ...]:
        """Loads of all meshes, divided by 2πρh as those of (4-8): of each pinion below, then above."""
        gear, duties = self.gear, self.duties
        found = []
        for number, (angle, phase) in enumerate(zip(gear.pinion_angles, gear.mesh_phases, strict=True)):
            for upper, driving in enumerate(DRIVES[duties[number]]):
                mesh = _Mesh(number, len(duties), bool(upper), driving, angle, phase)
                shapes = _shapes(gear.body.modes, gear.contact, gear.body.drive, mesh)
                found += [gear.mesh_load(shape, weight) for shape, weight in shapes]
        return tuple(found)

    def system(self, speed: float) -> PeriodicSystem:
        """Equations of motion at a constant speed, divided by 2πρh as (4-8).

        Parameters
        ----------
        speed : float
            Ω2 of the lower gear [rad/s], greater than 0; the upper one turns as fast the other way.

        Returns
        -------
        PeriodicSystem
            2(M + 1)(2N + 1) coordinates of the disks and one for each pinion, the period T0 (3-20).

        Raises
        ------
        TypeError, ValueError
            If `speed` is not a finite number greater than 0.
        """
        speed = positive("speed", speed, "rad/s")
        gear, count = self.gear, len(self.gear.pinion_angles)
        own = np.array([gear.pinion_mass, gear.bearing_damping, gear.bearing_stiffness]) / modal_mass(
            gear.body
        )
        signs = mirror_signs(gear.body)
        # The upper gear is driven as it turns: in the coordinates of the lower one that is the mirror image.
        images = (np.ones((1, 1)), np.outer(signs, signs))
        disks = [disk_matrices(gear.body, turning) for turning in (speed, -speed)]
        damping = _joined([disk[0] for disk in disks], own[1] * np.eye(count))
        pressed = [
            disk[1] + image * gear.force_stiffness(speed, driving)
            for disk, image, driving in zip(disks, images, self.driving, strict=True)
        ]
        stiffness = _joined(pressed, own[2] * np.eye(count))
        mass = np.diag(np.append(np.ones(len(damping) - count), np.full(count, own[0])))
        return PeriodicSystem(mass, damping, stiffness, self.loads, mesh_period(gear.body.drive, speed))


def _joined(disks: Sequence[FloatArray], pinions: FloatArray) -> FloatArray:
    """Matrix of both disks, of one size, and of the pinions, none of which is coupled with another."""
    n = len(disks[0])
    matrix = np.zeros((2 * n + len(pinions), 2 * n + len(pinions)))
    matrix[:n, :n], matrix[n : 2 * n, n : 2 * n], matrix[2 * n :, 2 * n :] = *disks, pinions
    return matrix


class _Mesh(NamedTuple):
    """Which pinion of how many, on which gear, driving or driven, and where: θ_c [rad], ψ [mesh periods]."""

    number: int
    pinions: int
    upper: bool
    driving: bool
    angle: float
    phase: float


@lru_cache(maxsize=256)
def _shapes(
    modes: tuple[RadialModes, ...], contact: Contact, drive: Drive, mesh: _Mesh
) -> tuple[tuple[PiecewiseChebyshev, PiecewiseChebyshev | None], ...]:
    """Shape vector of u of each load of a mesh, and its weight, against t/T0."""
    # Along the one axis, what presses the upper gear upwards presses the lower one downwards.
    sign = -1.0 if mesh.upper else 1.0

    def vector(x: FloatArray, angle: FloatArray) -> FloatArray:
        disk = unit_shape(modes, x, angle) / drive.outer_radius
        parts = [disk, np.zeros_like(disk)]
        pinions = np.zeros((*x.shape, mesh.pinions))
        pinions[..., mesh.number] = -1.0
        return sign * np.concatenate([*(parts[::-1] if mesh.upper else parts), pinions], axis=-1)

    places = contact.places(drive) if mesh.driving else contact.coasting_places(drive)
    phase = mesh.phase
    if mesh.upper:
        places = tuple(place.mirrored() for place in places)
        phase += 0.5 * (drive.pinion_teeth % 2)
    there = contact.placed(places, mesh.angle, phase)
    return tuple((place.shape(vector), place.weight) for place in there)
