"""Transverse vibration of a face gear whose pinions hang on the teeth by springs (section 8.2, Figs 1.11 and 8.3).

In chapters 4 to 6 a pinion is a mass, spring and damper on the disk itself. Here each has a motion of its own, w_m, and
the teeth between are a spring and damper,

    m_p ẅ_m + c_b ẇ_m + k_b w_m = F,    F = c_z u̇ + k_z u,    u = w(r_c, θ_c, t) - w_m,

with -F on the disk at the moving contact. The spring has an end of its own there, which moves with the contact: u̇ is
the total rate, ẇ + ∇w·v_c - ẇ_m. As the teeth grow stiff the pinion follows the contact, and the model becomes
`Transverse` with total rate, velocity kicks included.

The force between teeth leans from the plane of the disk by the pressure angle: a deflection w along the axis closes the
teeth by w sin α_c, and of their force the part sin α_c acts along the axis, so that k_z is k_m sin²α_c for each pair.
That is said at the pitch radius. On a conjugate tooth the pressure angle changes along the face, and k_z with it,
which is left out.

Pinions may drive the disk from both faces. Mirrored in the plane of the disk, a mesh on the front is one on the back
that turns the disk the same way, with the contact at the same r and θ: seen from behind the disk turns the other way,
and the path is mirrored, which leaves it as it is in space. What remains of the face is the sign of u. Stability does
not hang on it; to what a transmission error does, which parts the teeth on either face, it matters.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from itertools import combinations
from typing import NamedTuple

import numpy as np

from facegear.floquet.loads import ContactLoad
from facegear.floquet.models import Coordinate
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.geometry.drive import Drive
from facegear.geometry.timed_pairs import mesh_period
from facegear.mechanics.contact import Contact
from facegear.mechanics.disk import disk_coordinates, modal_mass, unit_shape
from facegear.mechanics.pinions_on_disk import MOST_PERIODS, PinionsOnDisk
from facegear.mechanics.radial_modes import RadialModes
from facegear.mechanics.tooth_stiffness import mesh_stiffness
from facegear.mechanics.transverse import Transverse
from facegear.support.parameters import designed, finite_array, keep, nonnegative, positive, within
from facegear.support.types import FloatArray

FOLLOWED = Contact(rate="total")
"""Contact at the centroid of the contact lines (3-21), its own motion included."""

# Angles [rad] and phases [mesh periods] closer than this are the same.
_SAME = 1e-6
# Stiffness of a tooth pair over that of the teeth alone (7-2): room for the limits of soft and of rigid teeth.
_SOFTEST, _STIFFEST = 5e-6, 1e6
# Damping of the mesh over its stiffness [s].
_MOST_DAMPING = 0.01


@dataclass(frozen=True)
class MeshOscillator(PinionsOnDisk):
    """Transverse vibration of a face gear under equal pinions, each on the springs of its teeth (section 8.2).

    Parameters
    ----------
    body : Body
        Disk and modes. Stiff teeth bring in higher modes than M = 1, N = 3 has: see that results have converged.
    load : MeshLoad
        μ, ζ, τ of every pinion (4-17 to 4-19); τ greater than 0.
    pinion_angles : sequence of float
        θ_c of each pinion [rad], between -2π and 2π. What is left of an angle after whole teeth sets the phase of the
        pinion's mesh (5-1 to 5-4).
    contact : Contact
        How the teeth touch, the same for all pinions, with total rate: one load a pinion, or one for each tooth pair.
        Default: at the centroid of the contact lines, with Tregold's contact ratio. A load has the stiffness that its
        path gives it (:class:`facegear.mechanics.sharing.shared_load`,
        :class:`facegear.mechanics.paths.loaded_contact`), else that of a pair, or as the only one of cr pairs.
    force : DrivingForce, optional
        In the plane of the disk (4-21), the same for all pinions. Default: none.
    phases : sequence of float, optional
        Phase of each pinion's mesh [mesh periods], in place of that of its angle.
    mesh_stiffness : float
        k_m of a tooth pair along the line of action [N/m], greater than 0:
        :func:`facegear.mechanics.tooth_stiffness.mesh_stiffness` has (7-2).
    mesh_damping : float
        ζ_m, damping of the mesh over its stiffness [s], from above 0 to 0.01.
    sides : sequence of int, optional
        Face of the disk that each pinion meshes with, 1 for the front or -1 for the back. Default: all the front.
    clocking : float
        Phase by which the teeth of the back face are ahead of those of the front [mesh periods].

    Raises
    ------
    TypeError, ValueError
        If an argument is of the wrong kind or outside its range, or two pinions are the same.

    Examples
    --------
    >>> import facegear as fg
    >>> body, load = fg.Body(fg.Drive(26, 130, 3.175e-3), thickness_ratio=0.03), fg.MeshLoad(1.0, 3e-6, 1.0)
    >>> teeth = fg.mesh_stiffness(body.drive, correction_factor=0.5)
    >>> model = fg.MeshOscillator(body, load, mesh_stiffness=teeth, mesh_damping=1e-5)
    >>> model.system(speed=50.0).size
    15
    >>> both = fg.MeshOscillator(
    ...     body, load, (0.0, 0.0), sides=(1, -1), clocking=0.5, mesh_stiffness=teeth, mesh_damping=1e-5
    ... )
    >>> [coordinate.name for coordinate in both.coordinates[-2:]]
    ['pinion 1', 'pinion 2']
    """

    contact: Contact = FOLLOWED
    mesh_stiffness: float = field(kw_only=True, metadata=designed("mesh stiffness"))
    mesh_damping: float = field(kw_only=True, metadata=designed("mesh damping"))
    sides: Sequence[int] | None = field(default=None, kw_only=True)
    clocking: float = field(default=0.0, kw_only=True)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.contact.rate != "total":
            raise ValueError(
                'contact.rate must be "total" where the spring of the teeth has an end of its own, which moves with '
                f"the contact, got {self.contact.rate!r}"
            )
        if self.load.mass == 0.0:
            raise ValueError(
                "load.mass must be greater than 0 for a pinion to have a motion of its own, got 0.0"
            )
        own = mesh_stiffness(self.body.drive, 1.0, self.body.material)
        given = positive("mesh_stiffness", self.mesh_stiffness, "N/m")
        hint = "N/µm, not N/m?" if own * _SOFTEST <= 1e6 * given <= own else ""
        keep(
            self,
            mesh_stiffness=within("mesh_stiffness", given, own * _SOFTEST, own * _STIFFEST, "N/m", hint),
        )
        damping = nonnegative("mesh_damping", self.mesh_damping, "s")
        if damping == 0.0:
            raise ValueError(
                "mesh_damping must be greater than 0 s, or what rings in stiff teeth never dies away and they do not "
                f"become rigid ones, got {self.mesh_damping!r}"
            )
        if damping > _MOST_DAMPING:
            microseconds = (
                f" (µs? {1e-6 * damping:.6g} would be valid)" if 1e-6 * damping <= _MOST_DAMPING else ""
            )
            raise ValueError(
                f"mesh_damping must be greater than 0 and at most {_MOST_DAMPING:g} s, got {self.mesh_damping!r} s"
                f"{microseconds}"
            )
        keep(
            self,
            mesh_damping=damping,
            clocking=within("clocking", self.clocking, -MOST_PERIODS, MOST_PERIODS, "mesh periods"),
        )
        if self.sides is not None:
            keep(self, sides=_checked_sides(self.sides, len(self.pinion_angles)))
        self._require_different_pinions()

    def _require_different_pinions(self) -> None:
        """Refuse two pinions of one face at one angle in one phase: that is one pinion."""
        places = zip(self.faces, self.pinion_angles, self.mesh_phases, strict=True)
        for (one, first, early), (other, second, late) in combinations(places, 2):
            turns = np.array([(first - second) / (2 * math.pi), early - late])
            if one == other and (np.abs(turns - np.rint(turns)) < _SAME).all():
                raise ValueError(
                    "pinion_angles must differ from one another on each face, unless their phases do, got "
                    f"{self.pinion_angles!r} with sides = {self.sides!r}"
                )

    @property
    def faces(self) -> tuple[int, ...]:
        """Face that each pinion meshes with: `sides` if given, else all the front."""
        return (1,) * len(self.pinion_angles) if self.sides is None else tuple(self.sides)

    @property
    def mesh_phases(self) -> tuple[float, ...]:
        """Phase ψ of each pinion's mesh [mesh periods], the clocking of its face included."""
        ahead = (self.clocking if face < 0 else 0.0 for face in self.faces)
        return tuple(own + more for own, more in zip(super().mesh_phases, ahead, strict=True))

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Modes of the disk, and w_m of each pinion."""
        count = len(self.pinion_angles)
        names = ["pinion"] if count == 1 else [f"pinion {number + 1}" for number in range(count)]
        return (*disk_coordinates(self.body), *(Coordinate(name, "m", name) for name in names))

    @property
    def rigid(self) -> Transverse:
        """The same drive with rigid teeth.

        Raises
        ------
        ValueError
            As :class:`Transverse`: if there is a load for each tooth pair, or a mean point that jumps, which a rigid
            pinion would have to follow in no time.
        """
        return Transverse(
            self.body, self.load, self.pinion_angles, self.contact, self.force, phases=self.mesh_phases
        )

    @property
    def axial_stiffness(self) -> float:
        """k_m sin²α_c of a tooth pair along the gear's axis [N/m]."""
        return self.mesh_stiffness * math.sin(self.body.drive.pressure_angle) ** 2

    @cached_property
    def loads(self) -> tuple[ContactLoad, ...]:
        """Loads of all meshes, divided by 2πρh as those of (4-8), pinion by pinion."""
        found = []
        for number, phase in enumerate(self.mesh_phases):
            pinion = _Pinion(number, len(self.faces), self.pinion_angles[number], phase, self.faces[number])
            shapes = _mesh(self.body.modes, self.contact, self.body.drive, pinion)
            found += [self.mesh_load(shape, weight) for shape, weight in shapes]
        return tuple(found)

    def mesh_load(self, shape: PiecewiseChebyshev, weight: PiecewiseChebyshev | None) -> ContactLoad:
        """Load of a mesh, divided by 2πρh, from the shape vector of u [1/m, -] and the weight that its path says."""
        # A load whose path says nothing stands for one pair, or as the only one for all of them.
        pairs = self.contact_ratio if weight is None and self.contact.sharing != "each" else 1.0
        stiffness = pairs * self.axial_stiffness / modal_mass(self.body)
        return ContactLoad(shape, stiffness, self.mesh_damping * stiffness, rate="total", weight=weight)

    def system(self, speed: float) -> PeriodicSystem:
        """Equations of motion at a constant speed, divided by 2πρh as (4-8).

        Parameters
        ----------
        speed : float
            Ω2 of the face gear [rad/s], greater than 0.

        Returns
        -------
        PeriodicSystem
            (M + 1)(2N + 1) coordinates of the disk and one for each pinion, the period T0 (3-20). A transmission error
            e of its loads is that along the axis, 1/sin α_c times that along the line of action.

        Raises
        ------
        TypeError, ValueError
            If `speed` is not a finite number greater than 0.
        """
        speed = positive("speed", speed, "rad/s")
        count, scale = len(self.pinion_angles), modal_mass(self.body)
        disk = self.disk_matrices(speed)
        size = len(disk[0])
        mass, damping, stiffness = np.eye(size + count), *np.zeros((2, size + count, size + count))
        damping[:size, :size], stiffness[:size, :size] = disk
        pinions = slice(size, None)
        own = (self.pinion_mass, self.bearing_damping, self.bearing_stiffness)
        for matrix, value in zip((mass, damping, stiffness), own, strict=True):
            matrix[pinions, pinions] = value / scale * np.eye(count)
        return PeriodicSystem(mass, damping, stiffness, self.loads, mesh_period(self.body.drive, speed))


def _checked_sides(sides: Sequence[int], pinions: int) -> tuple[int, ...]:
    """Return the face of each pinion, and refuse what is none."""
    array = finite_array("sides", sides)
    if array.shape != (pinions,) or not np.isin(array, (1.0, -1.0)).all():
        raise ValueError(
            f"sides must list 1 (front) or -1 (back) for each of {pinions} pinions, got {sides!r}"
        )
    return tuple(int(side) for side in array)


class _Pinion(NamedTuple):
    """Which pinion of how many, and where: θ_c [rad], ψ [mesh periods], face."""

    number: int
    pinions: int
    angle: float
    phase: float
    face: int


@lru_cache(maxsize=256)
def _mesh(
    modes: tuple[RadialModes, ...], contact: Contact, drive: Drive, pinion: _Pinion
) -> tuple[tuple[PiecewiseChebyshev, PiecewiseChebyshev | None], ...]:
    """Shape vector of u of each load under a pinion, and its weight, against t/T0.

    Neither depends on thickness, masses or bearings: models that differ in these share them, and maps know that.
    """

    def vector(x: FloatArray, angle: FloatArray) -> FloatArray:
        disk = unit_shape(modes, x, angle) / drive.outer_radius
        pinions = np.zeros((*x.shape, pinion.pinions))
        pinions[..., pinion.number] = -1.0
        return pinion.face * np.concatenate([disk, pinions], axis=-1)

    places = contact.placed(contact.places(drive), pinion.angle, pinion.phase)
    return tuple((place.shape(vector), place.weight) for place in places)
