"""How pairs of teeth give way where their flanks are pressed.

A `Compliance` says what force a pair has at an approach along the normal. Two of them are the ends of what holds a
tooth together along its face: slices of a Winkler bedding, each for itself (`SliceCompliance`), and rigid teeth on one
spring a pair (`PairCompliance`). They bound teeth of the same mean stiffness.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from facegear.mechanics.properties import Material
from facegear.mechanics.slices import Slices
from facegear.mechanics.tooth_stiffness import mesh_stiffness
from facegear.support.types import FloatArray

# Newton's rule for the approach: steps, and the error at which it ends, relative.
_STEPS, _SETTLED, _LAST_DIGIT = 60, 1e-12, 4.0 * np.finfo(float).eps
# Part of the length of a line by which its end may be missed, as by rounding.
_ROUNDED = 1e-12
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(24)


class Lines(NamedTuple):
    """What a pair of teeth has in mesh at instants of shape S.

    Attributes
    ----------
    inner, outer : ndarray, shape S
        Ends as slices s [√m]; nothing is in mesh where both are one.
    age : ndarray, shape S
        Since the first line on both flanks [mesh periods].
    """

    inner: FloatArray
    outer: FloatArray
    age: FloatArray


@dataclass(frozen=True)
class Compliance(ABC):
    """How pairs of teeth give way.

    Parameters
    ----------
    slices : Slices
    pair_stiffness : float
        k_m of a pair pressed over the whole face [N/m].
    """

    slices: Slices
    pair_stiffness: float

    @classmethod
    def of(cls, slices: Slices, correction_factor: float, material: Material) -> Self:
        """Law for the teeth of a drive, from c_f of (7-2) and their material."""
        return cls(slices, mesh_stiffness(slices.drive, correction_factor, material))

    @abstractmethod
    def force(self, approach: FloatArray, lines: Lines) -> tuple[FloatArray, FloatArray]:
        """Force [N] and stiffness [N/m] of pairs at an approach [m], both of one shape."""

    @abstractmethod
    def pressed(self, approach: FloatArray, lines: Lines) -> tuple[FloatArray, FloatArray]:
        """Find the slices that are pressed, and the shares of the load that they have.

        Returns
        -------
        slices, shares : ndarray, shape S + (m,)
            s [√m], and weights that add up to 1 [-].
        """

    events: ClassVar[tuple[tuple[int, int], ...]]
    """What is pressed, or how, changes where an end of a line (0 inner, 1 outer) passes so many times √δ."""

    presses_points: ClassVar[bool] = False
    """Whether a line of no length, as the first and the last, can carry a load."""

    def reserves(self, approach: FloatArray, lines: Lines) -> FloatArray:
        """Quantities of which the signs tell the changes that no √δ tells, shape (m,) + S; here there are none."""
        return np.empty((0, *np.shape(lines.age)))

    def pressure(self, approach: FloatArray, lines: Lines, s: FloatArray) -> FloatArray:
        """Load per length of face on slices of lines, S + (m,) [N/m]; as long as they give way each for itself."""
        inner, outer = lines.inner[..., np.newaxis], lines.outer[..., np.newaxis]
        within = between(inner, s, outer)
        over = np.maximum(np.asarray(approach)[..., np.newaxis] - s**2, 0.0)
        return np.asarray(np.where(within, over, 0.0) * self.pair_stiffness / self.slices.drive.face_width)

    def equilibrium(self, force: float, approach: FloatArray, lines: Lines) -> FloatArray:
        """Approach δ [m], shape S, at which pairs (K,) + S have a force together [N], from a value that is near.

        By Newton's rule. Force grows with δ, and ever faster: from above no step goes too far, and from below only the
        first one does. Where no pair is reached, as between unloaded pairs that touch for less than a mesh period, the
        nearest one is, by a little.
        """
        there = lines.inner < lines.outer
        nearest = np.where(there, np.clip(0.0, lines.inner, lines.outer) ** 2, np.inf).min(axis=0)
        reached = nearest + force / self.pair_stiffness
        for _ in range(_STEPS):
            carried, stiffness = (part.sum(axis=0) for part in self.force(approach, lines))
            touches = stiffness > 0.0
            step = (carried - force) / np.where(touches, stiffness, self.pair_stiffness)
            settled = np.abs(step) <= np.maximum(_SETTLED * (approach - nearest), _LAST_DIGIT * approach)
            if np.all(settled & touches):
                return np.asarray(approach - step)
            approach = np.where(touches, approach - step, np.maximum(approach, reached))
        raise ArithmeticError(
            f"approach did not settle, last step {np.abs(step).max():.3g} m: a force of {force:.3g} N is lost in "
            "rounding beside gaps that it has to close first; give a larger torque"
        )

    def balanced(self, force: float, approach: FloatArray, lines: Lines) -> tuple[FloatArray, FloatArray]:
        """Approach [m] as of :meth:`equilibrium`, and stiffness of all pairs there [N/m], both of shape S."""
        settled = self.equilibrium(force, approach, lines)
        return settled, np.asarray(self.force(settled, lines)[1].sum(axis=0))


def between(first: FloatArray, s: FloatArray, last: FloatArray) -> NDArray[np.bool_]:
    """Whether slices lie between two, these included however they are rounded; none does where both are one."""
    slack = _ROUNDED * (last - first)
    return np.asarray((first - slack <= s) & (s <= last + slack) & (first < last))


@dataclass(frozen=True)
class SliceCompliance(Compliance):
    """Each slice for itself, k_m/L: the softest, as no slice is held by its neighbours (Winkler)."""

    # Contact begins, ends, or comes to an end of its line.
    events = ((0, 1), (0, -1), (1, 1), (1, -1))

    @property
    def _foundation(self) -> float:
        """Stiffness per length of face [N/m²]."""
        return self.pair_stiffness / self.slices.drive.face_width

    def _contact(self, approach: FloatArray, lines: Lines) -> tuple[FloatArray, FloatArray]:
        reach = np.sqrt(approach)
        first = np.maximum(lines.inner, -reach)
        return first, np.maximum(np.minimum(lines.outer, reach), first)

    def force(self, approach: FloatArray, lines: Lines) -> tuple[FloatArray, FloatArray]:
        """∫ (δ − g) du times k_m/L, and the length of contact times it."""
        first, last = self._contact(approach, lines)
        distance, area = self.slices.distance_and_area(np.stack([first, last]))
        # Two sums at one place may differ by rounding, which must not pass for contact.
        length = np.where(last > first, distance[1] - distance[0], 0.0)
        force = np.where(last > first, approach * length - (area[1] - area[0]), 0.0)
        return self._foundation * force, self._foundation * length

    def pressed(self, approach: FloatArray, lines: Lines) -> tuple[FloatArray, FloatArray]:
        """As the gap leaves it, on Gauss–Legendre nodes."""
        first, last = (end[..., np.newaxis] for end in self._contact(approach, lines))
        s = 0.5 * (first + last) + 0.5 * (last - first) * _NODES
        reach = np.sqrt(approach)[..., np.newaxis]
        shares = np.maximum((reach - s) * (reach + s), 0.0) * self.slices.position.deriv()(s) * _WEIGHTS
        whole = shares.sum(axis=-1, keepdims=True)
        # A pair that just touches does so at one place.
        return s, np.where(whole > 0.0, shares, _WEIGHTS) / np.where(whole > 0.0, whole, 2.0)


@dataclass(frozen=True)
class PairCompliance(Compliance):
    """Rigid teeth on one spring a pair: it touches at the least gap of its line, and has all of k_m there."""

    # Contact begins, ends, or its slice comes to an end of the line.
    events = ((0, 1), (1, -1), (0, 0), (1, 0))
    presses_points = True

    def _nearest(self, lines: Lines) -> FloatArray:
        return np.asarray(np.clip(0.0, lines.inner, lines.outer))

    def force(self, approach: FloatArray, lines: Lines) -> tuple[FloatArray, FloatArray]:
        """k_m (δ − g) at the least gap."""
        pressed = approach - self._nearest(lines) ** 2
        there = (pressed > 0.0) & (lines.inner < lines.outer)
        return self.pair_stiffness * np.where(there, pressed, 0.0), np.where(there, self.pair_stiffness, 0.0)

    def pressed(self, approach: FloatArray, lines: Lines) -> tuple[FloatArray, FloatArray]:
        """All at one slice."""
        s = self._nearest(lines)[..., np.newaxis]
        return s, np.ones_like(s)
