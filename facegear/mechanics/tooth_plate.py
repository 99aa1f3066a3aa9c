"""Teeth as cantilever plates: a compliance between slices, each for itself, and rigid teeth of the same mean stiffness.

A tooth under a load somewhere along its face gives way there most, and beside it less, as its face holds together.
Here it is a plate clamped at its root, of the true thickness of the tooth against height and along the face, that
bends, twists and shears (Mindlin). Wellauer and Seireg took the cantilever plate for a gear tooth (Bending strength of
gear teeth by cantilever-plate theory, ASME Journal of Engineering for Industry 82, 1960, p. 213); Gagnon, Gosselin and
Cloutier that of Mindlin with the true thickness (Analysis of spur and straight bevel gear teeth deflection by the
finite strip method). The deflection is found after Rayleigh and Ritz, in polynomials. Under loads on a line, across
which the shear jumps, it converges only as a power of their number: what they leave out is one or two hundredths.

Next to the contact the flanks give way besides, as two cylinders do that touch along a line. That depends on the load
by a logarithm, and is taken here for a constant per length of face, that at a Hertzian pressure of E/200: of steel
1 GPa. All of a tooth's compliance is so in inverse proportion to E, and the contact depends on load over E alone.

What a pair of teeth has in contact is then an integral equation over the slices s that are pressed, u their place
along the face, p the load per length and δ the approach:

    λ p(s) + ∫ K(s, s') p(s') u'(s') ds' = δ − s²,   p ≥ 0, and p = 0 at an end that is not one of the line.

K is as smooth as the polynomials are, so that few of Gauss' nodes on what is pressed solve it. Load and stiffness do
not change with a free end, to first order, as p is 0 there; and neither does p at the end itself: the slope of p alone
makes Newton's rule for the ends.

Left out are the fillets, the compression of the tooth along its height, and that λ grows as the load falls. What the
root of a tooth does to the gear's body, and so to its neighbours, is left to c_f of (7-2).
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import NamedTuple, Self

import numpy as np
from numpy.polynomial import Chebyshev, chebyshev, legendre

from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.geometry.drive import Drive
from facegear.mechanics.compliance import Compliance, Lines, between
from facegear.mechanics.slices import Slices
from facegear.support.parameters import Material
from facegear.support.types import FloatArray

# Polynomials of Ritz' method: against height, of degrees 1 and up, and along the face, of degrees 0 and up.
_ACROSS, _ALONG = 6, 12
# Shear correction of a rectangular section.
_SHEAR = 5.0 / 6.0
# Hertzian pressure for which the local compliance is taken, over E: 1 GPa with steel.
_PRESSURE = 0.005
# No tooth is thinner than so many modules: next to R2 its top comes to a point.
_THINNEST = 0.05
# Points of the involute between which its chord is interpolated.
_TABLE = 2000
# Error of the influence as a series in the age of lines, relative to the largest, and points on each line.
_NEGLIGIBLE, _POINTS = 1e-9, 22
# Ages of lines for their mean stiffness.
_AGES = 64
# Gauss-Legendre nodes on what is pressed.
_NODES, _WEIGHTS = legendre.leggauss(20)
_DIAGONAL = np.arange(_NODES.size)
# Chebyshev points of lines, and what makes series of values there.
_PLACES = chebyshev.chebpts1(_POINTS)
# Where each pair of polynomials is in the triangle above the diagonal.
_TRIANGLE = np.triu_indices(_POINTS)
_SQUARE = np.zeros((_POINTS, _POINTS), dtype=int)
_SQUARE[_TRIANGLE] = _SQUARE.T[_TRIANGLE] = np.arange(_TRIANGLE[0].size)
_TO_SLOPES = chebyshev.chebder(np.eye(_POINTS))
_TO_SERIES = np.linalg.inv(chebyshev.chebvander(_PLACES, _POINTS - 1))
# Steps either way, of the one before.
_HALF = np.array([-0.5, 0.5]).reshape(2, 1, 1)
# Newton's rule for ends: steps, the error from which the next step is the last, and how much of a contact one may drop.
_STEPS, _NEARLY, _MOST = 80, 1e-8, 0.45


class Load(NamedTuple):
    """Where a unit force along the normal presses on a tooth, at points of shape S, and what work it does.

    Attributes
    ----------
    height : ndarray, shape S
        Above the root [m].
    position : ndarray, shape S
        u along the face [m].
    across : ndarray, shape S
        Work per deflection of the middle of the tooth [-].
    up, along : ndarray, shape S
        Work per rotation of a fibre across the tooth, in its height and along the face [m]: components of the force in
        the plane of the tooth act at half its thickness.
    """

    height: FloatArray
    position: FloatArray
    across: FloatArray
    up: FloatArray
    along: FloatArray


@dataclass(frozen=True, eq=False)
class CantileverPlate:
    """A plate of variable thickness, clamped along one edge, that bends and shears (Mindlin).

    Its points move by w across it, and by −ζβ in its plane at a distance ζ from its middle.

    Parameters
    ----------
    height : float
        From the clamped edge to the free one [m].
    ends : (float, float)
        Coordinates u of the two free edges square to it [m].
    thickness : callable
        Of heights and u, arrays of one shape [m].
    modulus, poissons_ratio : float
        E [Pa] and ν.
    across, along : int
        Polynomials of each displacement: of degrees 1 to `across` in height, 0 to `along` − 1 along the face.
    """

    height: float
    ends: tuple[float, float]
    thickness: Callable[[FloatArray, FloatArray], FloatArray]
    modulus: float
    poissons_ratio: float
    across: int = _ACROSS
    along: int = _ALONG

    @property
    def _half(self) -> float:
        return 0.5 * (self.ends[1] - self.ends[0])

    def _polynomials(self, height: FloatArray, position: FloatArray) -> tuple[FloatArray, ...]:
        """Values and slopes of polynomials in height, (..., across), and along the face, (..., along)."""
        x = height / self.height
        y = (position - 0.5 * sum(self.ends)) / self._half
        plain, slopes = (_legendre(2.0 * x - 1.0, self.across), _legendre_slopes(2.0 * x - 1.0, self.across))
        clamped = x[..., np.newaxis] * plain
        clamped_slopes = (plain + 2.0 * x[..., np.newaxis] * slopes) / self.height
        return clamped, clamped_slopes, _legendre(y, self.along), _legendre_slopes(y, self.along) / self._half

    @cached_property
    def stiffness(self) -> FloatArray:
        """Second derivatives of the energy in the coefficients of w, hβ_h and hβ_u, (3n, 3n) [N/m]."""
        x, x_weights = _gauss(0.0, self.height, 2 * self.across + 8)
        u, u_weights = _gauss(*self.ends, 2 * self.along + 10)
        heights, positions = (part.ravel() for part in np.meshgrid(x, u, indexing="ij"))
        weights = np.outer(x_weights, u_weights).ravel()
        thickness = self.thickness(heights, positions)
        values, by_height, along, by_along = self._polynomials(heights, positions)
        count = self.across * self.along

        def products(one: FloatArray, other: FloatArray) -> FloatArray:
            return (one[:, :, np.newaxis] * other[:, np.newaxis, :]).reshape(len(one), count)

        plain, up, sideways = products(values, along), products(by_height, along), products(values, by_along)
        shear = self.modulus / (2.0 * (1.0 + self.poissons_ratio))
        membrane = weights * _SHEAR * shear * thickness
        bending = weights * self.modulus * thickness**3 / (12.0 * (1.0 - self.poissons_ratio**2))
        nothing, size = np.zeros_like(plain), self.height
        # Strains of the three displacements: two shears, two curvatures, twist.
        strains = (
            (membrane, [up, -plain / size, nothing]),
            (membrane, [sideways, nothing, -plain / size]),
            (bending * (1.0 + self.poissons_ratio) / 2.0, [nothing, up / size, sideways / size]),
            (bending * (1.0 - self.poissons_ratio) / 2.0, [nothing, up / size, -sideways / size]),
            (bending * (1.0 - self.poissons_ratio) / 2.0, [nothing, sideways / size, up / size]),
        )
        total = np.zeros((3 * count, 3 * count))
        for weight, parts in strains:
            rows = np.sqrt(weight)[:, np.newaxis] * np.concatenate(parts, axis=1)
            total += rows.T @ rows
        return total

    @cached_property
    def _root(self) -> FloatArray:
        """R with R Rᵀ the inverse of the stiffness, (3n, 3n)."""
        lower = np.linalg.cholesky(self.stiffness)
        return np.asarray(np.linalg.inv(lower).T)

    def influence_factor(self, load: Load) -> FloatArray:
        """F with F Fᵀ the influence: what a unit force at one point moves another along its own normal.

        Parameters
        ----------
        load : Load, shape S

        Returns
        -------
        ndarray, shape S + (3n,)
            [√(m/N)].
        """
        values, _, along, _ = self._polynomials(load.height, load.position)
        products = values[..., :, np.newaxis] * along[..., np.newaxis, :]
        work = np.stack([load.across, load.up / self.height, load.along / self.height], axis=-1)
        whole = work[..., np.newaxis, np.newaxis] * products[..., np.newaxis, :, :]
        # As one product of two matrices, which is faster than one for each line.
        factor = whole.reshape(load.height.size, -1) @ self._root
        return np.asarray(factor.reshape(*load.height.shape, -1))

    def influence(self, one: Load, other: Load) -> FloatArray:
        """Move of points, shape S, along their own normals by unit forces at others, T: S + T [m/N]."""
        first, second = self.influence_factor(one), self.influence_factor(other)
        return np.asarray(np.tensordot(first, second, axes=(-1, -1)))


@dataclass(frozen=True)
class Tooth(ABC):
    """A tooth as a plate, and where slices press on it.

    Parameters
    ----------
    slices : Slices
    material : Material
    across, along : int
        Polynomials of its plate, see :class:`CantileverPlate`.
    """

    slices: Slices
    material: Material
    across: int = _ACROSS
    along: int = _ALONG

    @property
    @abstractmethod
    def height(self) -> float:
        """From root to top [m]."""

    @abstractmethod
    def thickness(self, height: FloatArray, position: FloatArray) -> FloatArray:
        """Thickness at heights above the root and coordinates u, arrays of one shape [m]."""

    @abstractmethod
    def load(self, q: FloatArray, roll: FloatArray) -> Load:
        """Load on what the shaper makes at local pressure angles q and roll angles θs, arrays of one shape [rad]."""

    @cached_property
    def plate(self) -> CantileverPlate:
        """Plate of this thickness, as wide as the face."""
        elastic = self.material.youngs_modulus, self.material.poissons_ratio
        return CantileverPlate(
            self.height, face(self.slices), self.thickness, *elastic, self.across, self.along
        )


def face(slices: Slices) -> tuple[float, float]:
    """Coordinates u of the inner and outer end of the face at the height of the shaper's pitch circle [m].

    With all slices that come in mesh, and without what lies inside of all of the flank: the edge may not reach to that
    height.
    """
    drive = slices.drive.generating
    offset = drive.pitch_radius / math.tan(drive.shaft_angle)
    used = [slices.position(end) for end in slices.ends(slices.breakpoints)]
    start = drive.flank_start / math.sin(drive.shaft_angle) + offset
    inner = max(min(start, float(used[0].min())), slices.contact.face[0])
    return inner, max(drive.outer_limit + offset, float(used[1].max()))


@dataclass(frozen=True)
class PinionTooth(Tooth):
    """Tooth of the pinion, as wide as the face gear's.

    Its thickness is the chord of the involute; below the base circle, where that lies above the root, the flanks are
    radii. The root is where they come to the dedendum circle.
    """

    @property
    def _drive(self) -> Drive:
        return self.slices.drive

    @property
    def _half_angle(self) -> float:
        """Half the angle of the tooth on the base circle [rad]."""
        return math.pi / self._drive.pinion_teeth - self._drive.space_half_angle

    def _flank(self, roll: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Distance of the involute from the axis, along the middle of the tooth, and half the chord there [m]."""
        radius, half = (
            self._drive.base_radius * np.hypot(1.0, roll),
            self._half_angle - roll + np.arctan(roll),
        )
        return radius * np.cos(half), radius * np.sin(half)

    @cached_property
    def _profile(self) -> tuple[FloatArray, FloatArray]:
        """Involute from the base circle or the root to the tip, as :meth:`_flank` has it."""
        drive = self._drive
        lowest = math.sqrt(max((drive.dedendum_radius / drive.base_radius) ** 2 - 1.0, 0.0))
        return self._flank(np.linspace(lowest, drive.pinion_tip_roll, _TABLE))

    @cached_property
    def _root(self) -> float:
        """Distance of the root from the axis [m]."""
        heights, halves = self._profile
        return self._drive.dedendum_radius / math.hypot(1.0, float(halves[0] / heights[0]))

    @property
    def height(self) -> float:
        """From the root to the chord of the tip [m]."""
        return float(self._profile[0][-1] - self._root)

    def thickness(self, height: FloatArray, position: FloatArray) -> FloatArray:
        """Chord, the same all along the face [m]."""
        heights, halves = self._profile
        above = height + self._root
        half = np.where(
            above < heights[0], above * (halves[0] / heights[0]), np.interp(above, heights, halves)
        )
        return np.asarray(np.maximum(2.0 * half, _THINNEST * self._drive.module))

    def load(self, q: FloatArray, roll: FloatArray) -> Load:
        """Load along a tangent of the base circle."""
        own = self.slices.contact.own_roll(q, roll)
        height, half = self._flank(own)
        # Against a line square to the middle of the tooth, towards the root.
        direction = own - self._half_angle
        position = np.broadcast_to(self._drive.generating.contact_region.position(q), own.shape)
        return Load(
            height - self._root, position, np.cos(direction), -half * np.sin(direction), np.zeros_like(own)
        )


@dataclass(frozen=True)
class GearTooth(Tooth):
    """Tooth of the face gear, from the shaper's tip circle, its root, to its top.

    Height and u are those at which the shaper makes a point. That the tooth turns by a few degrees about the gear's
    axis meanwhile counts in its thickness and in the direction of the load, not in these. Below the flank, where the
    fillet is, it is as thick as at the end of the flank. Its ends are taken square to the root.
    """

    @property
    def _drive(self) -> Drive:
        return self.slices.drive.generating

    @property
    def height(self) -> float:
        """From the root to the top [m]."""
        return self._drive.shaper_tip_radius - self._drive.tooth_top_distance

    def _turned(
        self, q: FloatArray, roll: FloatArray, x: FloatArray, outwards: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Components of a vector square to the middle of the tooth, and outwards in the gear's plane.

        From those, x and −y_p, where its point is made.
        """
        turn = self._drive.speed_ratio * (q - roll - self._drive.space_half_angle)
        return x * np.cos(turn) - outwards * np.sin(turn), x * np.sin(turn) + outwards * np.cos(turn)

    def _depth(self, q: FloatArray, roll: FloatArray) -> FloatArray:
        """Distance from the shaper's axis, in the plane of both axes [m]."""
        return np.asarray(self._drive.base_radius * (np.cos(q) + roll * np.sin(q)))

    def _half_thickness(self, q: FloatArray, roll: FloatArray) -> FloatArray:
        drive, region = self._drive, self._drive.contact_region
        outwards = region.position(q) * math.sin(drive.shaft_angle)
        outwards = outwards - self._depth(q, roll) * math.cos(drive.shaft_angle)
        return self._turned(q, roll, drive.base_radius * (np.sin(q) - roll * np.cos(q)), outwards)[0]

    def thickness(self, height: FloatArray, position: FloatArray) -> FloatArray:
        """Chord of the generated flanks [m]."""
        drive = self._drive
        q = np.arccos(float(drive.contact_region.position(0.0)) / position)
        roll = ((drive.shaper_tip_radius - height) / drive.base_radius - np.cos(q)) / np.sin(q)
        half = self._half_thickness(q, np.clip(roll, 0.0, drive.shaper_tip_roll))
        return np.asarray(np.maximum(2.0 * half, _THINNEST * drive.module))

    def load(self, q: FloatArray, roll: FloatArray) -> Load:
        """Load along the normal of the generated flank, into the tooth."""
        drive = self._drive
        sine, cosine = math.sin(drive.shaft_angle), math.cos(drive.shaft_angle)
        # The normal is −(cos q, sin q, 0) where it is made.
        across, outwards = self._turned(q, roll, -np.cos(q), -np.sin(q) * cosine)
        axial = -np.sin(q) * sine
        upwards, along = axial * sine + outwards * cosine, outwards * sine - axial * cosine
        half = self._half_thickness(q, roll)
        height = drive.shaper_tip_radius - self._depth(q, roll)
        position = np.broadcast_to(drive.contact_region.position(q), half.shape)
        return Load(height, position, across, -half * upwards, -half * along)


def local_compliance(slices: Slices, material: Material) -> float:
    """Give way of both flanks next to the contact, per load per length of face, λ [m²/N].

    Two cylinders of one material come nearer by p 2(1 − ν²)/(πE) [ln(4 d1 d2/a²) − ν/(1 − ν)], with the half width a of
    the contact and depths d, here as far as the middle of the teeth (Weber and Banaschek, Formänderung und
    Profilrücknahme bei gerad- und schrägverzahnten Rädern, 1953; Johnson, Contact Mechanics, section 5.6). a is that
    at a Hertzian pressure p0 of 0.005 E, with steel 1 GPa, in the middle of the path of the unloaded contact: as a =
    4 p0/(κE'), E' = E/(1 − ν²), it does not depend on E, and λ does by 1/E' alone. With the drive of the examples λ is
    1.55e-11 m²/N.
    """
    contact, stiffness = slices.contact, material.youngs_modulus / (1.0 - material.poissons_ratio**2)
    pressure = _PRESSURE * material.youngs_modulus
    half_width = 4.0 * pressure / (float(contact.principal_curvatures[1]) * stiffness)
    q, roll = np.array(contact.pressure_angle), np.array(0.5 * contact.rolls.sum())
    loads = [tooth.load(q, roll) for tooth in _teeth(slices, material)]
    # Half the thickness across is |up| over the sine of the force, and the depth longer by its cosine.
    depths = [
        float(np.hypot(load.up, load.along) / np.sqrt(1.0 - load.across**2) / abs(load.across))
        for load in loads
    ]
    logarithm = math.log(4.0 * math.prod(depths) / half_width**2)
    poissons_ratio = material.poissons_ratio
    return 2.0 / (math.pi * stiffness) * (logarithm - poissons_ratio / (1.0 - poissons_ratio))


@lru_cache(maxsize=64)
def _teeth(slices: Slices, material: Material) -> tuple[Tooth, Tooth]:
    return PinionTooth(slices, material), GearTooth(slices, material)


@lru_cache(maxsize=64)
def _influence(slices: Slices, teeth: tuple[Tooth, ...]) -> PiecewiseChebyshev:
    """Influence on lines of all teeth together, against age as :attr:`Slices.breakpoints` count it [m/N].

    On each line it is a double Chebyshev series from end to end, of which the triangle above the diagonal is kept.
    """
    whole = slices.sweep + 1.0

    def along_lines(fraction: FloatArray, piece: int) -> FloatArray:
        ages = np.minimum(fraction * whole, slices.sweep)
        inner, outer = slices.ends(ages)
        middle, half = 0.5 * (inner + outer), 0.5 * (outer - inner)
        where = slices.generated(middle[:, np.newaxis] + half[:, np.newaxis] * _PLACES, ages[:, np.newaxis])
        total = np.zeros((ages.size, _POINTS, _POINTS))
        for tooth in teeth:
            series = _TO_SERIES @ tooth.plate.influence_factor(tooth.load(*where))
            total += series @ series.swapaxes(1, 2)
        return total[:, *_TRIANGLE]

    edges = np.append(slices.breakpoints, slices.sweep) / whole
    # On pieces next to a square root it counts by the duration.
    tolerance = _NEGLIGIBLE * np.maximum(1.0, 1e-3 / np.diff(edges, append=1.0))
    return PiecewiseChebyshev.fit(along_lines, edges, tolerance=tolerance)


_Balance = Callable[[FloatArray, FloatArray], FloatArray]
"""Approach of pairs (P,) from their forces at a unit of it, and what the gap takes from these."""


class _State(NamedTuple):
    """What P pairs have pressed, on n nodes.

    Attributes
    ----------
    approach : ndarray, shape (P,)
        δ [m].
    ends : ndarray, shape (2, P)
        s [√m].
    nodes, weights : ndarray, shape (P, n)
        s [√m], and weights of du [m].
    load, stiffness : ndarray, shape (P, n)
        p [N/m], and dp/dδ [N/m²].
    deflection : ndarray, shape (P, m)
        By which the plates give way along the line, as a Chebyshev series from end to end [m].
    """

    approach: FloatArray
    ends: FloatArray
    nodes: FloatArray
    weights: FloatArray
    load: FloatArray
    stiffness: FloatArray
    deflection: FloatArray


@dataclass(frozen=True)
class PlateCompliance(Compliance):
    """Teeth as elastic plates, with a Winkler bedding for what flanks give way next to the contact.

    Parameters
    ----------
    slices : Slices
    pair_stiffness : float
        That of a pair pressed over the whole face, if its lines were as long [N/m], see `whole_face_stiffness`.
    bedding : float
        λ/c_f [m²/N].
    teeth : tuple of Tooth
        Those of pinion and face gear.
    softer : float
        1/c_f, by which the plates are softer than the teeth alone [-].

    Examples
    --------
    >>> from facegear.geometry.drive import Drive
    >>> from facegear.mechanics.loaded_contact import LoadedContact
    >>> drive = Drive(26, 130, 3.175e-3, shaper_teeth=27)
    >>> round(LoadedContact(drive, torque=100.0, compliance="plate").contact_ratio, 3)
    2.495
    """

    bedding: float
    teeth: tuple[Tooth, ...]
    softer: float

    # Contact begins or ends. What else changes is in `reserves`.
    events = ((0, 1), (1, -1))

    @classmethod
    def of(cls, slices: Slices, correction_factor: float, material: Material) -> Self:
        """Teeth of a drive, all of their compliance over c_f, as in (7-2)."""
        softer = 1.0 / correction_factor
        bedding = softer * local_compliance(slices, material)
        law = cls(slices, slices.drive.face_width / bedding, bedding, _teeth(slices, material), softer)
        return replace(law, pair_stiffness=law.whole_face_stiffness)

    @cached_property
    def whole_face_stiffness(self) -> float:
        """Width of the face times the stiffness per length of lines pressed from end to end, all of them [N/m].

        Slices of as much, and these plates, are equally stiff in the mean where a drive is loaded heavily.
        """
        ages, weights = _gauss(0.0, self.slices.sweep, _AGES)
        inner, outer = self.slices.ends(ages)
        lines = Lines(inner, outer, ages)
        unit = np.ones_like(ages)
        state = self._state(
            np.stack([inner, outer]), lines, self._series(lines), lambda stiffness, missing: unit
        )
        length = state.weights.sum(axis=-1)
        stiffness = (state.stiffness * state.weights).sum(axis=-1)
        return self.slices.drive.face_width * float(weights @ stiffness) / float(weights @ length)

    @cached_property
    def _slope(self) -> Chebyshev:
        """du/ds [√m]."""
        return self.slices.position.deriv()

    # --- along lines ------------------------------------------------------------------------------------------

    def _series(self, lines: Lines) -> FloatArray:
        """Influence on lines (P,), as double Chebyshev series from end to end, (P, _POINTS, _POINTS) [m/N]."""
        if not self.teeth:
            return np.zeros((lines.age.size, _POINTS, _POINTS))
        sweep = self.slices.sweep
        fraction = np.clip(lines.age, 0.0, sweep) / (sweep + 1.0)
        return np.asarray(self.softer * _influence(self.slices, self.teeth)(fraction)[:, _SQUARE])

    def _state(self, ends: FloatArray, lines: Lines, series: FloatArray, balance: _Balance) -> _State:
        """State of pairs (P,) that are pressed between two ends, (2, P); of those of no length, nothing."""
        middle, half = (
            part[:, np.newaxis] for part in (0.5 * (ends[0] + ends[1]), 0.5 * (ends[1] - ends[0]))
        )
        nodes = middle + half * _NODES
        weights = half * _WEIGHTS * self._slope(nodes)
        values = _values(nodes, lines)
        matrix = (values @ series @ values.swapaxes(1, 2)) * weights[:, np.newaxis, :]
        matrix[:, _DIAGONAL, _DIAGONAL] += self.bedding
        # Load that a unit of approach makes, and what the gap takes from it.
        sides = np.stack([np.ones_like(nodes), nodes**2], axis=-1)
        stiffness, missing = np.moveaxis(np.linalg.solve(matrix, sides), -1, 0)
        approach = balance((stiffness * weights).sum(axis=-1), (missing * weights).sum(axis=-1))
        load = approach[:, np.newaxis] * stiffness - missing
        deflection = (series @ (values.swapaxes(1, 2) @ (load * weights)[:, :, np.newaxis]))[..., 0]
        return _State(approach, ends, nodes, weights, load, stiffness, deflection)

    def _settled(self, approach: FloatArray, lines: Lines, balance: _Balance) -> tuple[_State, FloatArray]:
        """State of pairs (P,) at a balance, from an approach that is near, and λp at both its ends, (2, P).

        From ends that are too far out, where flanks would have to stick, Newton's rule comes nearer from one side.
        """
        series = self._series(lines)
        ends, change = _reach(approach, lines), np.array(np.inf)
        before = np.zeros(ends.shape)
        for _ in range(_STEPS):
            state = self._state(ends, lines, series, balance)
            over, slope = _at_ends(state, lines)
            if np.all(change <= _NEARLY * np.sqrt(state.approach)):
                return state, over
            limits = _reach(state.approach, lines)
            moved = np.clip(ends + _step(over, slope, ends[1] - ends[0]), *limits)
            # A pair that was not pressed, and is within reach now.
            moved = np.where(ends[1] > ends[0], moved, limits)
            # An end that turns back goes half as far at most, lest it go to and fro for ever.
            step = moved - ends
            step = np.where(step * before < 0.0, np.clip(step, *_HALF * np.abs(before)), step)
            ends, before, change = ends + step, step, np.abs(step)
        raise ArithmeticError(f"ends of the contact did not settle: last step {change.max():.3g} √m")

    def _at(self, approach: FloatArray, lines: Lines) -> tuple[_State, FloatArray]:
        """State of lines of shape S, in one row, at an approach."""
        row = Lines(*(np.ravel(part) for part in lines))
        given = np.broadcast_to(approach, np.shape(lines.inner)).ravel()
        return self._settled(given, row, lambda stiffness, missing: given)

    # --- the law ----------------------------------------------------------------------------------------------

    def force(self, approach: FloatArray, lines: Lines) -> tuple[FloatArray, FloatArray]:
        """∫ p du, and how it grows with δ: where a free end moves, there is no load."""
        state = self._at(approach, lines)[0]
        shape = np.shape(lines.inner)
        return (
            (state.load * state.weights).sum(axis=-1).reshape(shape),
            (state.stiffness * state.weights).sum(axis=-1).reshape(shape),
        )

    def equilibrium(self, force: float, approach: FloatArray, lines: Lines) -> FloatArray:
        """As of any law."""
        return self.balanced(force, approach, lines)[0]

    def balanced(self, force: float, approach: FloatArray, lines: Lines) -> tuple[FloatArray, FloatArray]:
        """As of any law, with the ends of all pairs and their approach in one iteration.

        Loads are linear in δ as long as ends stay, so that it is known for any ends; and as they come to where p = 0,
        they no longer change it.
        """
        shape = np.shape(lines.inner)
        row = Lines(*(np.ravel(part) for part in lines))
        start = np.broadcast_to(approach, shape).ravel()

        def balance(stiffness: FloatArray, missing: FloatArray) -> FloatArray:
            total, gap = stiffness.reshape(shape).sum(axis=0), missing.reshape(shape).sum(axis=0)
            # Where nothing is within reach yet, one looks farther.
            farther = np.square(row.inner).max() + force / self.pair_stiffness
            together = np.where(total > 0.0, (force + gap) / np.where(total > 0.0, total, 1.0), farther)
            return np.broadcast_to(together, shape).ravel()

        state = self._settled(start, row, balance)[0]
        stiffness = (state.stiffness * state.weights).sum(axis=-1).reshape(shape).sum(axis=0)
        return state.approach.reshape(shape)[0], stiffness

    def pressed(self, approach: FloatArray, lines: Lines) -> tuple[FloatArray, FloatArray]:
        """Nodes of what is pressed, and their shares."""
        state = self._at(approach, lines)[0]
        shares = state.load * state.weights
        whole = shares.sum(axis=-1, keepdims=True)
        shares = np.where(whole > 0.0, shares, _WEIGHTS) / np.where(whole > 0.0, whole, 2.0)
        shape = (*np.shape(lines.inner), _NODES.size)
        return state.nodes.reshape(shape), shares.reshape(shape)

    def reserves(self, approach: FloatArray, lines: Lines) -> FloatArray:
        """Of the inner and the outer end of a line: λp/δ there, or less than 0 as far as what is pressed ends before.

        Contact begins and ends where the gap is least: at an end of the line that is pressed then, when the other is
        not.
        """
        state, over = self._at(approach, lines)
        row = np.stack([np.ravel(lines.inner), np.ravel(lines.outer)])
        size = np.sqrt(state.approach)
        open_part = -np.abs(state.ends - row) / size
        none = np.sign(np.clip(0.0, *row)) * np.array([[1.0], [-1.0]])
        reserves = np.where(open_part < 0.0, open_part, over / size**2)
        reserves = np.where(state.ends[0] < state.ends[1], reserves, none)
        return reserves.reshape(2, *np.shape(lines.inner))

    def pressure(self, approach: FloatArray, lines: Lines, s: FloatArray) -> FloatArray:
        """Load per length of face on slices of lines, S + (m,) [N/m]."""
        state = self._at(approach, lines)[0]
        first, last = (end.reshape(*np.shape(lines.inner), 1) for end in state.ends)
        return np.where(between(first, s, last), self.overlap(approach, lines, s), 0.0) / self.bedding

    def overlap(self, approach: FloatArray, lines: Lines, s: FloatArray) -> FloatArray:
        """Find what gap and bending leave of the approach on slices of lines, S + (m,) [m].

        Where teeth are pressed it is λ times the load per length; elsewhere it is less than 0, and says how far apart
        the flanks are.
        """
        shape = np.shape(lines.inner)
        state = self._at(approach, lines)[0]
        places = np.broadcast_to(s, (*shape, np.shape(s)[-1])).reshape(len(state.approach), -1)
        row = Lines(*(np.ravel(part) for part in lines))
        deflection = (_values(places, row) @ state.deflection[:, :, np.newaxis])[..., 0]
        return (state.approach[:, np.newaxis] - places**2 - deflection).reshape(*shape, -1)


def _at_ends(state: _State, lines: Lines) -> tuple[FloatArray, FloatArray]:
    """λp at both ends of what is pressed [m], and its slope [√m], both (2, P)."""
    ends, column = state.ends.T, state.deflection[:, :, np.newaxis]
    deflection, slope = (basis(ends, lines) @ column for basis in (_values, _slopes))
    over = state.approach - state.ends**2 - deflection[..., 0].T
    return over, -2.0 * state.ends - slope[..., 0].T


def _reach(approach: FloatArray, lines: Lines) -> FloatArray:
    """Find the ends, (2, P), of what is nearer than the approach on lines; no more than that can be pressed."""
    reach = np.sqrt(approach)
    return np.stack([np.clip(-reach, lines.inner, lines.outer), np.clip(reach, lines.inner, lines.outer)])


def _step(over: FloatArray, slope: FloatArray, length: FloatArray) -> FloatArray:
    """Newton's step of both ends, (2, P), to where nothing is pressed.

    Where λp does not fall outwards there is none: an end then leaves what sticks, or goes on while it is pressed.
    """
    outwards = np.array([[-1.0], [1.0]])
    falls = -outwards * slope
    newton = np.where(falls > 0.0, over / np.where(falls > 0.0, falls, 1.0), np.sign(over) * length)
    return outwards * np.maximum(newton, -_MOST * length)


def _local(s: FloatArray, lines: Lines) -> tuple[FloatArray, FloatArray]:
    """Slices (P, n) on their lines from -1 to 1, and half the length of these, (P, 1)."""
    half = 0.5 * (lines.outer - lines.inner)[:, np.newaxis]
    half = np.where(half > 0.0, half, 1.0)
    return (s - 0.5 * (lines.inner + lines.outer)[:, np.newaxis]) / half, half


def _values(s: FloatArray, lines: Lines) -> FloatArray:
    """Chebyshev polynomials on lines at slices, (P, n, _POINTS)."""
    return np.asarray(chebyshev.chebvander(_local(s, lines)[0], _POINTS - 1))


def _slopes(s: FloatArray, lines: Lines) -> FloatArray:
    """Slopes of Chebyshev polynomials on lines at slices, (P, n, _POINTS) [1/√m]."""
    local, half = _local(s, lines)
    return np.asarray(chebyshev.chebvander(local, _POINTS - 2) @ _TO_SLOPES / half[..., np.newaxis])


def _gauss(low: float, high: float, count: int) -> tuple[FloatArray, FloatArray]:
    """Nodes and weights of Gauss and Legendre on an interval."""
    nodes, weights = legendre.leggauss(count)
    return 0.5 * (low + high) + 0.5 * (high - low) * nodes, 0.5 * (high - low) * weights


def _legendre(x: FloatArray, count: int) -> FloatArray:
    """Legendre polynomials of degrees 0 to count − 1, (..., count)."""
    return np.asarray(legendre.legvander(x, count - 1))


def _legendre_slopes(x: FloatArray, count: int) -> FloatArray:
    """Slopes of them."""
    return np.asarray(np.moveaxis(legendre.legval(x, legendre.legder(np.eye(count))), 0, -1))
