"""Contact of a real drive under load: how many teeth carry it, where they are pressed, how stiff the mesh is.

Teeth press where their approach δ along the normal exceeds the gap of their slices (:mod:`facegear.mechanics.slices`).
All pairs in mesh have one approach, as both gears turn as rigid bodies; δ follows from equilibrium with the torque at
every instant. Where it exceeds all gaps, contact is along whole lines, as with a shaper of the pinion's teeth; as it
goes to 0, at the point of the unloaded contact.

How a tooth gives way is a `Compliance`. Two of them are the ends of what holds the slices of a tooth together: slices
of a Winkler bedding, each for itself (`slice`), and rigid teeth on one spring a pair (`pair`), both with the mean
stiffness of (7-2). Between them is an elastic plate (`plate`, :mod:`facegear.mechanics.plate_compliance`), which
resists more where its neighbours are not pressed. It has a stiffness of its own, some 2.7 times that of (7-2) with the
drive of the examples: contact ratio and approach lie between those of the others if these are given the same, and need
not otherwise.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from facegear.floquet.piecewise import PiecewiseChebyshev, fourier_series
from facegear.geometry.drive import Drive
from facegear.geometry.misalignment import ALIGNED, Misalignment
from facegear.geometry.timed_pairs import merged
from facegear.mechanics.compliance import Compliance, Lines, PairCompliance, SliceCompliance
from facegear.mechanics.plate_compliance import PlateCompliance
from facegear.mechanics.properties import STEEL, Material
from facegear.mechanics.slices import Slices
from facegear.mechanics.tooth_stiffness import checked_factor, mesh_stiffness
from facegear.support.parameters import finite, finite_array, keep, one_of
from facegear.support.roots import crossing
from facegear.support.types import FloatArray

# Instants of a mesh period that are looked at for changes of contact; how many times as many if a fit finds another.
_INSTANTS, _FINER = 64, 4
# The first and the last line have no length but by rounding: so near to them others are looked at [mesh periods].
_NEXT = 1e-10
# Relative error of series over a mesh period.
_TOLERANCE = 1e-12
# Force over k_m, in modules: below, an approach is lost in rounding; above, teeth would give way by all of a module.
_LEAST, _MOST = 1e-18, 1.0
# How short a piece must be, in mesh periods, before it may have more.
_SHORT = 1e-3


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


def require_kinds(instance: object, **kinds: type) -> None:
    """Refuse fields of a dataclass that are not of their kinds, naming the first."""
    for name, kind in kinds.items():
        value = getattr(instance, name)
        if not isinstance(value, kind):
            raise TypeError(f"{name} must be a {kind.__name__}, got {value!r}")


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
        stiffness of their own, with the drive of the examples some 2.7 times k_m.
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
    def _law(self) -> Compliance:
        return COMPLIANCES[self.compliance].of(self.slices, self.correction_factor, self.material)

    # --- equilibrium ------------------------------------------------------------------------------------------

    def _lines(self, ages: FloatArray) -> Lines:
        """Lines of pairs so many mesh periods after the first line on both flanks; empty before it and after."""
        inner, outer = self.slices.ends(ages)
        beyond = (ages < 0.0) | (ages > self.slices.sweep)
        return Lines(np.where(beyond, 0.0, inner), np.where(beyond, 0.0, outer), ages)

    def _all_pairs(self, instants: FloatArray) -> FloatArray:
        """Ages since the first line of all pairs that may be in mesh, shape (K,) + S."""
        return _ages(instants, self.slices.sweep)

    def _total(self, approach: FloatArray, ages: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Force [N] and stiffness [N/m] of all pairs when one of them has an age."""
        force, stiffness = self._law.force(approach, self._lines(self._all_pairs(ages)))
        return force.sum(axis=0), stiffness.sum(axis=0)

    @cached_property
    def _coarse(self) -> FloatArray:
        """Approach at equally spaced instants of the period [m]."""
        most = max(float(np.abs(end).max()) for end in self.slices.ends(self.slices.breakpoints)) ** 2
        above = most + self.force / self.pair_stiffness
        return self._approach_from(np.full(_INSTANTS, above), np.arange(_INSTANTS) / _INSTANTS)

    def _approach(self, ages: FloatArray) -> FloatArray:
        """Approach δ when a pair has an age [m]."""
        return self._approach_from(self._near(ages), ages)

    def _settled(self, ages: FloatArray) -> FloatArray:
        """Approach when a pair has an age [m], from the series over the period: one step of Newton's rule."""
        first, _, series = self._mesh
        return self._approach_from(series(ages - first)[..., 0], ages)

    def _near(self, ages: FloatArray) -> FloatArray:
        """Approach from its neighbours in time [m]."""
        return np.interp(ages, np.arange(_INSTANTS) / _INSTANTS, self._coarse, period=1.0)

    def _approach_from(self, approach: FloatArray, ages: FloatArray) -> FloatArray:
        """Approach δ from a value that is near [m]."""
        return self._law.equilibrium(self.force, approach, self._lines(self._all_pairs(ages)))

    # --- events -----------------------------------------------------------------------------------------------

    def _events(self, instants: int) -> FloatArray:
        """Ages at which what is pressed, or how it is, changes [mesh periods since the first line], ascending."""
        phases = np.arange(instants) / instants
        count = math.floor(self.slices.sweep * instants)
        grid = np.append(np.arange(count + 1) / instants, self.slices.sweep)
        approach = self._approach(np.append(phases, self.slices.sweep))
        reach = np.sqrt(np.append(np.resize(approach[:-1], count + 1), approach[-1]))
        grid = np.clip(grid, _NEXT, self.slices.sweep - _NEXT)
        lines = self._lines(grid)
        return np.sort(
            np.concatenate([self._passages(grid, lines, reach), self._turns(grid, lines, reach**2)])
        )

    def _passages(self, grid: FloatArray, lines: Lines, reach: FloatArray) -> FloatArray:
        """Ages at which an end of a line passes a multiple of √δ, between those of a grid."""
        events = self._law.events
        signs = np.sign(np.stack([lines[end] - level * reach for end, level in events]))
        which, where = np.nonzero(signs[:, :-1] * signs[:, 1:] < 0.0)
        if not which.size:
            return np.empty(0)
        chosen = np.array(events, dtype=float)[which]

        def beyond(age: FloatArray, end: FloatArray, level: FloatArray, rising: FloatArray) -> FloatArray:
            """Of one sign with how far an end is beyond the approach, which need not be found for that."""
            lines = self._lines(age)
            s = np.where(end == 1.0, lines.outer, lines.inner)
            excess = self._total(s**2, age)[0] / self.force - 1.0
            return np.asarray(
                rising * np.where(level == 0.0, s, level * np.where(level * s > 0.0, excess, -1.0))
            )

        return crossing(beyond, grid[where], grid[where + 1], *chosen.T, signs[which, where + 1])

    def _turns(self, grid: FloatArray, lines: Lines, approach: FloatArray) -> FloatArray:
        """Ages at which a reserve of the law changes its sign, between those of a grid."""
        signs = np.sign(self._law.reserves(approach, lines))
        which, where = np.nonzero(signs[:, :-1] * signs[:, 1:] < 0.0)
        if not which.size:
            return np.empty(0)

        def reserve(age: FloatArray, number: FloatArray, rising: FloatArray) -> FloatArray:
            reserves = self._law.reserves(self._approach(age), self._lines(age))
            return np.asarray(rising * reserves[number.astype(int), np.arange(age.size)])

        return crossing(reserve, grid[where], grid[where + 1], which.astype(float), signs[which, where + 1])

    @cached_property
    def _mesh(self) -> tuple[float, float, PiecewiseChebyshev]:
        """Ages at which a pair begins and ends to be pressed, and approach and stiffness over the period from then."""
        failure: ValueError | None = None
        for finer in (1, _FINER, _FINER**2):
            ages = np.unique(np.concatenate([[0.0], self._events(finer * _INSTANTS), [self.slices.sweep]]))
            middles = 0.5 * (ages[:-1] + ages[1:])
            force, _ = self._law.force(self._approach(middles), self._lines(middles))
            pressed = np.flatnonzero(force > 0.0)
            first, last = float(ages[pressed[0]]), float(ages[pressed[-1] + 1])
            changes = np.concatenate([ages, self.slices.breakpoints]) - first
            try:
                return first, last, self._fit(first, merged([*changes.tolist(), last - first]))
            except ValueError as error:
                failure = error
        raise ArithmeticError(f"contact changes at instants that were not found: {failure}")

    def _fit(self, first: float, breakpoints: tuple[float, ...]) -> PiecewiseChebyshev:
        """Approach [m] and stiffness of all pairs [N/m] against t/T0."""
        # Both to one size, so that a fit resolves both.
        units = np.array([self.force / self.pair_stiffness, self.pair_stiffness])

        def values(fractions: FloatArray, pieces: NDArray[np.intp]) -> FloatArray:
            instants = fractions + first
            lines = self._lines(self._all_pairs(instants))
            balanced = self._law.balanced(self.force, self._near(instants), lines)
            return np.asarray(np.stack(balanced, axis=-1) / units)

        tolerances = fit_tolerances(breakpoints)
        return PiecewiseChebyshev.fit_together(values, breakpoints, tolerance=tolerances).transformed(
            np.diag(units)
        )

    # --- what comes of it -------------------------------------------------------------------------------------

    @property
    def contact_ratio(self) -> float:
        """Mesh periods that a pair of teeth is pressed: the effective contact ratio."""
        return self._mesh[1] - self._mesh[0]

    @property
    def begins_or_ends_at_once(self) -> bool:
        """Whether a pair takes up or drops a load at once: the law gives some to the first line, or the last."""
        return self._law.presses_points and (self._mesh[0] <= 0.0 or self._mesh[1] >= self.slices.sweep)

    @property
    def breakpoints(self) -> tuple[float, ...]:
        """Fractions of T0, ascending from 0 where a pair begins to be pressed, between which all is smooth."""
        return tuple(self._mesh[2].breakpoints.tolist())

    def age_of_line(self, line: float) -> float:
        """Mesh periods since a pair began to be pressed at which its line is θs = q − c, for c [rad]."""
        slices = self.slices
        return (slices.limits[0] - line) / slices.pitch - self._mesh[0]

    def transmission_error(self, fraction: ArrayLike) -> FloatArray:
        """Evaluate the loaded transmission error: approach δ of the teeth along the line of action [m].

        Over the pinion's base radius it is the angle by which the pinion is ahead of where rigid gears would have it.

        Parameters
        ----------
        fraction : array_like
            T/T0, from 0 where a pair begins to be pressed; period 1.

        Returns
        -------
        ndarray, of the shape of `fraction`

        Raises
        ------
        TypeError, ValueError
            Not numeric or not finite.
        """
        return self._mesh[2](finite_array("fraction", fraction))[..., 0]

    def mesh_stiffness(self, fraction: ArrayLike) -> FloatArray:
        """Stiffness of all pairs in mesh against a small further approach [N/m], arguments as there."""
        return self._mesh[2](finite_array("fraction", fraction))[..., 1]

    @property
    def excitation(self) -> PiecewiseChebyshev:
        """What the loaded transmission error departs from its mean over a mesh period, against t/T0 [m].

        A `transmission_error` of :class:`facegear.floquet.models.Excited`: the springs of the pairs would follow it, if
        nothing had inertia, without any change of the force.
        """
        error = self._mesh[2].transformed(np.array([[1.0, 0.0]]))
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
        return self.pairs_of_age(_ages(finite_array("fraction", fraction), self.contact_ratio))

    def pairs_of_age(self, ages: ArrayLike) -> LoadedPairs:
        """As :meth:`pairs`, of pairs that have been pressed for so many mesh periods, of any shape."""
        since_first_line = finite_array("ages", ages) + self._mesh[0]
        approach = self._settled(since_first_line)
        lines = self._lines(since_first_line)
        force, stiffness = self._law.force(approach, lines)
        # Where a pair is not pressed its place means nothing; that of the unloaded contact is always there.
        there = force > 0.0
        inner, outer = (np.where(there, end, 0.0) for end in (lines.inner, lines.outer))
        s, shares = self._law.pressed(approach, Lines(inner, outer, lines.age))
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
        ages = _ages(instants, self.contact_ratio) + self._mesh[0]
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
        return self._law.pressure(self._settled(ages), self._lines(ages), places)


def _ages(instants: FloatArray, longest: float) -> FloatArray:
    """Mesh periods since each pair that there may be began, (P,) + S, if one lasts for `longest`."""
    start = instants - np.floor(instants)
    return np.stack([start + k for k in range(math.ceil(longest))])


def fit_tolerances(breakpoints: tuple[float, ...]) -> FloatArray:
    """Relative errors that fits on pieces of a mesh period may have: on short ones they count by the duration."""
    return np.asarray(_TOLERANCE * np.maximum(1.0, _SHORT / np.diff(breakpoints, append=1.0)))
