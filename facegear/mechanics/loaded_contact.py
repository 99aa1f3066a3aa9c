"""Contact of a real drive under load: how many teeth carry it, where they are pressed, how stiff the mesh is.

Teeth press where their approach δ along the normal exceeds the gap of their slices (:mod:`facegear.mechanics.slices`).
All pairs in mesh have one approach, as both gears turn as rigid bodies; δ follows from equilibrium with the torque at
every instant. Where it exceeds all gaps, contact is along whole lines, as with a shaper of the pinion's teeth; as it
goes to 0, at the point of the unloaded contact.

How a tooth gives way is a `Compliance`. Two of them are the ends of what holds the slices of a tooth together: slices
of a Winkler bedding, each for itself (`slice`), and rigid teeth on one spring a pair (`pair`), both with the mean
stiffness of (7-2). Between them is an elastic plate (`plate`, :mod:`facegear.mechanics.plate_compliance`), which
resists more where its neighbours are not pressed. It has a stiffness of its own, 2.0 to 2.7 times that of (7-2) from
60 to 855 N m with the drive of the examples: contact ratio and approach lie between those of the others if these are
given the same, and need not otherwise.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from facegear.floquet.fourier import fourier_series
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.geometry.drive import Drive
from facegear.geometry.misalignment import ALIGNED, Misalignment
from facegear.mechanics.compliance import Compliance, Lines, PairCompliance, SliceCompliance
from facegear.mechanics.mesh_cycle import MeshCycle, ages_of_pairs
from facegear.mechanics.plate_compliance import PlateCompliance
from facegear.mechanics.properties import STEEL, Material
from facegear.mechanics.slices import Slices
from facegear.mechanics.tooth_stiffness import checked_factor, mesh_stiffness
from facegear.support.kinds import require_kinds
from facegear.support.parameters import finite, finite_array, keep, one_of
from facegear.support.types import FloatArray

# Force over k_m, in modules: below, an approach is lost in rounding; above, teeth would give way by all of a module.
_LEAST, _MOST = 1e-18, 1.0


class LoadedPairs(NamedTuple):
    """What pairs of teeth carry at instants of shape S; rows are pairs.

    Attributes
    ----------
    force : ndarray, shape (P,) + S
        Along the normal [N]; 0 of a pair that is not pressed.
    stiffness : ndarray, shape (P,) + S
        Against a small further approach [N/m].
    radius, angle : ndarray, shape (P,) + S
        Centre of the pressure: r [m] and θ about the gear's axis, from the pinion's [rad].
    approach : ndarray, shape (P,) + S
        δ [m], the same for all pairs.
    """

    force: FloatArray
    stiffness: FloatArray
    radius: FloatArray
    angle: FloatArray
    approach: FloatArray


COMPLIANCES: dict[str, type[Compliance]] = {
    "slice": SliceCompliance,
    "plate": PlateCompliance,
    "pair": PairCompliance,
}
"""Laws of compliance by name."""


def checked_torque(torque: float) -> float:
    """Return a torque at the pinion that presses teeth [N m].

    Raises
    ------
    TypeError, ValueError
        If it is not a number greater than 0.
    """
    number = finite("torque", torque, "N m")
    if number <= 0.0:
        raise ValueError(
            f"torque must be greater than 0 N m, got {number:g} N m: without load UnloadedContact has the contact, and "
            "a torque the other way presses the other flank, for which an offset counts with the opposite sign"
        )
    return number


@lru_cache(maxsize=64)
def _slices(drive: Drive, misalignment: Misalignment) -> Slices:
    return Slices(drive, misalignment)


@dataclass(frozen=True)
class LoadedContact:
    """Contact of a pinion and a face gear cut by a shaper with more teeth, under a torque.

    Parameters
    ----------
    drive : Drive
        Its `shaper_teeth` exceed `pinion_teeth`.
    torque : float
        At the pinion [N m], greater than 0. Its force over k_m may be from 1e-18 modules, next to which nothing can be
        told from rounding, to 1 module, by which no tooth gives way.
    misalignment : Misalignment
        Default: none.
    compliance : {"slice", "plate", "pair"}
        How teeth give way: each slice of the face for itself, k_m/L (`SliceCompliance`), each pair as a rigid body on
        one spring k_m (`PairCompliance`), or as elastic plates of their own thickness (`PlateCompliance`). With one and
        the same mean stiffness the first two would bound contact ratio and approach of plates; but plates have a
        stiffness of their own: with the drive of the examples 2.0 times k_m at 60 N m and 2.7 times at 855.
    correction_factor : float
        c_f of the mean mesh stiffness k_m (7-2), from 1e-6 to 1; of plates, what it leaves of their stiffness.
    material : Material
        Of the teeth. Default: steel. Next to the contact flanks of plates give way as under a Hertzian pressure of
        E/200, 1 GPa with steel, so that under any law a contact depends on the torque over E alone.

    Raises
    ------
    TypeError, ValueError
        If contact is along lines or not on the flank, or an argument is of the wrong kind or outside its range.
    ArithmeticError
        From its properties: above 90°, if ends of contact lines cannot be followed where corners of the shaper cut
        the flank; if an equilibrium, or the instants at which contact changes, cannot be found, as at the least
        torques where unloaded pairs touch for less than a mesh period and a force is lost in rounding.

    Examples
    --------
    >>> import facegear as fg
    >>> contact = fg.LoadedContact(fg.Drive(26, 130, 3.175e-3, shaper_teeth=27), torque=100.0)
    >>> round(contact.contact_ratio, 4)
    2.9532
    >>> contact.mesh_stiffness([0.0, 0.5]).shape
    (2,)
    """

    drive: Drive
    torque: float
    misalignment: Misalignment = ALIGNED
    compliance: str = "slice"
    correction_factor: float = 0.5
    material: Material = STEEL

    def __post_init__(self) -> None:
        require_kinds(self, drive=Drive, misalignment=Misalignment, material=Material)
        one_of("compliance", self.compliance, tuple(COMPLIANCES))
        keep(self, torque=checked_torque(self.torque))
        keep(self, correction_factor=checked_factor(self.correction_factor))
        # Under which a pair pressed over the whole face gives way by a module.
        whole = self.drive.module * self.pair_stiffness * self.drive.base_radius
        least, most = _LEAST * whole, _MOST * whole
        if not least <= self.torque <= most:
            more = "teeth would give way by more than a module"
            why = more if self.torque > most else "less is lost in rounding"
            raise ValueError(
                f"torque must lie in [{least:.3g}, {most:.3g}] N m for this drive, material and correction_factor: "
                f"{why}; got {self.torque!r} N m"
            )
        _ = self.slices

    @property
    def slices(self) -> Slices:
        """Gap and lines of the flanks."""
        return _slices(self.drive, self.misalignment)

    @property
    def force(self) -> float:
        """Force of all pairs along the normal [N]: torque over the pinion's base radius."""
        return self.torque / self.drive.base_radius

    @property
    def pair_stiffness(self) -> float:
        """k_m of a pair pressed over the whole face [N/m] (7-2)."""
        return mesh_stiffness(self.drive, self.correction_factor, self.material)

    @cached_property
    def cycle(self) -> MeshCycle:
        """Equilibrium over a mesh period."""
        law = COMPLIANCES[self.compliance].of(self.slices, self.correction_factor, self.material)
        return MeshCycle(self.slices, law, self.force, self.pair_stiffness)

    @property
    def contact_ratio(self) -> float:
        """Mesh periods that a pair of teeth is pressed: the effective contact ratio."""
        return self.cycle.last - self.cycle.first

    @property
    def begins_or_ends_at_once(self) -> bool:
        """Whether a pair takes up or drops a load at once: the law gives some to the first line, or the last."""
        return self.cycle.law.presses_points and (
            self.cycle.first <= 0.0 or self.cycle.last >= self.slices.sweep
        )

    @property
    def breakpoints(self) -> tuple[float, ...]:
        """Fractions of T0, ascending from 0 where a pair begins to be pressed, between which all is smooth."""
        return tuple(self.cycle.series.breakpoints.tolist())

    def age_of_line(self, line: float) -> float:
        """Mesh periods since a pair began to be pressed at which its line is θs = q − c, for c [rad]."""
        slices = self.slices
        return (slices.limits[0] - line) / slices.pitch - self.cycle.first

    def transmission_error(self, fraction: ArrayLike) -> FloatArray:
        """Evaluate the loaded transmission error: approach δ of the teeth along the line of action [m].

        Over the pinion's base radius it is the angle by which the pinion is ahead of where rigid gears would have it.

        Parameters
        ----------
        fraction : array_like
            T/T0, from 0 where a pair begins to be pressed; period 1.

        Returns
        -------
        ndarray
            Of the shape of `fraction`.

        Raises
        ------
        TypeError, ValueError
            Not numeric or not finite.
        """
        return self.cycle.series(finite_array("fraction", fraction))[..., 0]

    def mesh_stiffness(self, fraction: ArrayLike) -> FloatArray:
        """Stiffness of all pairs in mesh against a small further approach [N/m], arguments as there."""
        return self.cycle.series(finite_array("fraction", fraction))[..., 1]

    @property
    def excitation(self) -> PiecewiseChebyshev:
        """What the loaded transmission error departs from its mean over a mesh period, against t/T0 [m].

        A `transmission_error` of :class:`facegear.floquet.modified_models.Excited`: the springs of the pairs would
        follow it, if nothing had inertia, without any change of the force.
        """
        error = self.cycle.series.transformed(np.array([[1.0, 0.0]]))
        coefficients = error.coefficients.copy()
        coefficients[:, 0] -= fourier_series(error, error.breakpoints, 1).mean
        return PiecewiseChebyshev(error.breakpoints, coefficients)

    def pairs(self, fraction: ArrayLike) -> LoadedPairs:
        """Find what each pair of teeth carries, and where.

        Parameters
        ----------
        fraction : array_like, shape S
            T/T0, from 0 where a pair begins to be pressed; period 1.

        Returns
        -------
        LoadedPairs
            Rows are pairs by age, the youngest first, as many as there are at most.

        Raises
        ------
        TypeError, ValueError
            Not numeric or not finite.
        """
        return self.pairs_of_age(ages_of_pairs(finite_array("fraction", fraction), self.contact_ratio))

    def pairs_of_age(self, ages: ArrayLike) -> LoadedPairs:
        """As :meth:`pairs`, of pairs that have been pressed for so many mesh periods, of any shape."""
        since_first_line = finite_array("ages", ages) + self.cycle.first
        approach = self.cycle.settled(since_first_line)
        lines = self.cycle.lines(since_first_line)
        force, stiffness = self.cycle.law.force(approach, lines)
        # Where a pair is not pressed its place means nothing; that of the unloaded contact is always there.
        there = force > 0.0
        inner, outer = (np.where(there, end, 0.0) for end in (lines.inner, lines.outer))
        s, shares = self.cycle.law.pressed(approach, Lines(inner, outer, lines.age))
        radius, angle = self.slices.place(s, since_first_line[..., np.newaxis])
        return LoadedPairs(
            force, stiffness, (shares * radius).sum(axis=-1), (shares * angle).sum(axis=-1), approach
        )

    def pressure(self, fraction: ArrayLike, position: ArrayLike) -> FloatArray:
        """Load per length of face on slices [N/m], that of each pair; of `pair`, which has none, that of `slice`.

        Parameters
        ----------
        fraction : array_like, shape S
            T/T0, from 0 where a pair begins to be pressed; period 1.
        position : array_like, shape (m,)
            Coordinates u along the shaper's axis [m], between the ends of :attr:`UnloadedContact.face`.

        Returns
        -------
        ndarray, shape (P,) + S + (m,)
            0 where a slice is not pressed, or not in mesh.

        Raises
        ------
        TypeError, ValueError
            Not numeric or not finite, or beyond the face.
        """
        instants, u = finite_array("fraction", fraction), finite_array("position", position, "m")
        ages = ages_of_pairs(instants, self.contact_ratio) + self.cycle.first
        return self.line_load(ages, self.slices.at(u))

    def line_load(self, age: ArrayLike, s: ArrayLike) -> FloatArray:
        """As :meth:`pressure`, on slices s, (m,) or S + (m,) [√m], of lines of an age as `slices.ends` counts it, S."""
        ages, places = finite_array("age", age), np.atleast_1d(finite_array("s", s, "√m"))
        if places.shape[:-1] not in ((), ages.shape):
            raise ValueError(
                f"s must list slices, the same ones on each line or as many rows as age has, {ages.shape}, got shape "
                f"{places.shape}"
            )
        places = np.broadcast_to(places, (*ages.shape, places.shape[-1]))
        return self.cycle.law.pressure(self.cycle.settled(ages), self.cycle.lines(ages), places)
