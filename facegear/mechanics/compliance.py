"""How pairs of teeth give way where their flanks are pressed.

A `Compliance` says what force a pair has at an approach along the normal. Two of them bound the truth: slices of a
Winkler bedding, each for itself (`SliceCompliance`), and rigid teeth on one spring a pair (`PairCompliance`).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np

from facegear.mechanics.slices import Slices
from facegear.support.types import FloatArray

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

    @abstractmethod
    def force(self, approach: FloatArray, lines: Lines) -> tuple[FloatArray, FloatArray]:
        """Force [N] and stiffness [N/m] of pairs at an approach [m], both of one shape."""

    @abstractmethod
    def pressed(self, approach: FloatArray, lines: Lines) -> tuple[FloatArray, FloatArray]:
        """Ends of the contact as slices, and slices with the shares of the load that they have.

        Returns
        -------
        slices, shares : ndarray, shape S + (m,)
            s [√m], and weights that add up to 1 [-].
        """

    events: ClassVar[tuple[tuple[int, int], ...]]
    """What is pressed, or how, changes where an end of a line (0 inner, 1 outer) passes so many times √δ."""


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
        length = distance[1] - distance[0]
        force = approach * length - (area[1] - area[0])
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

    def _nearest(self, lines: Lines) -> FloatArray:
        return np.clip(0.0, lines.inner, lines.outer)

    def force(self, approach: FloatArray, lines: Lines) -> tuple[FloatArray, FloatArray]:
        """k_m (δ − g) at the least gap."""
        pressed = approach - self._nearest(lines) ** 2
        there = (pressed > 0.0) & (lines.inner < lines.outer)
        return self.pair_stiffness * np.where(there, pressed, 0.0), self.pair_stiffness * there

    def pressed(self, approach: FloatArray, lines: Lines) -> tuple[FloatArray, FloatArray]:
        """All at one slice."""
        s = self._nearest(lines)[..., np.newaxis]
        return s, np.ones_like(s)
