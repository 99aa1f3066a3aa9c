"""Teeth as cantilever plates: a compliance between slices, each for itself, and rigid teeth of the same mean stiffness.

A tooth under a load somewhere along its face gives way there most, and beside it less, as its face holds together: both
teeth bend as plates (:mod:`facegear.mechanics.elastic_teeth`), and next to the contact flanks give way by λ besides.
What a pair of teeth has in contact is then an integral equation over the slices s that are pressed, u their place
along the face, p the load per length and δ the approach:

    λ p(s) + ∫ K(s, s') p(s') u'(s') ds' = δ − s²,   p ≥ 0, and p = 0 at an end that is not one of the line.

K is as smooth as the polynomials are, so that few of Gauss' nodes on what is pressed solve it. Load and stiffness do
not change with a free end, to first order, as p is 0 there; and neither does p at the end itself: the slope of p alone
makes Newton's rule for the ends.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple, Self

import numpy as np
from numpy.polynomial import Chebyshev, legendre

from facegear.mechanics.compliance import Compliance, Lines, between
from facegear.mechanics.elastic_teeth import Tooth, local_compliance, teeth_of
from facegear.mechanics.line_influence import influence_on_lines, polynomial_slopes, polynomials
from facegear.mechanics.properties import Material
from facegear.mechanics.slices import Slices
from facegear.support.quadrature import gauss
from facegear.support.types import FloatArray

# Ages of lines for their mean stiffness.
_AGES = 64
# Gauss-Legendre nodes on what is pressed.
_NODES, _WEIGHTS = legendre.leggauss(20)
_DIAGONAL = np.arange(_NODES.size)
# Steps either way, of the one before.
_HALF = np.array([-0.5, 0.5]).reshape(2, 1, 1)
# Newton's rule for ends: steps, the error from which the next step is the last, and how much of a contact one may drop.
_STEPS, _NEARLY, _MOST = 80, 1e-8, 0.45


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
        law = cls(slices, slices.drive.face_width / bedding, bedding, teeth_of(slices, material), softer)
        return replace(law, pair_stiffness=law.whole_face_stiffness)

    @cached_property
    def whole_face_stiffness(self) -> float:
        """Width of the face times the stiffness per length of lines pressed from end to end, all of them [N/m].

        Slices of as much, and these plates, are equally stiff in the mean where a drive is loaded heavily.
        """
        ages, weights = gauss(0.0, self.slices.sweep, _AGES)
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
        """Influence on lines (P,), as double Chebyshev series from end to end, (P, m, m) [m/N]."""
        return self.softer * influence_on_lines(self.slices, self.teeth, lines)

    def _state(self, ends: FloatArray, lines: Lines, series: FloatArray, balance: _Balance) -> _State:
        """State of pairs (P,) that are pressed between two ends, (2, P); of those of no length, nothing."""
        middle, half = (
            part[:, np.newaxis] for part in (0.5 * (ends[0] + ends[1]), 0.5 * (ends[1] - ends[0]))
        )
        nodes = middle + half * _NODES
        weights = half * _WEIGHTS * self._slope(nodes)
        values = polynomials(nodes, lines)
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
        deflection = (polynomials(places, row) @ state.deflection[:, :, np.newaxis])[..., 0]
        return (state.approach[:, np.newaxis] - places**2 - deflection).reshape(*shape, -1)


def _at_ends(state: _State, lines: Lines) -> tuple[FloatArray, FloatArray]:
    """λp at both ends of what is pressed [m], and its slope [√m], both (2, P)."""
    ends, column = state.ends.T, state.deflection[:, :, np.newaxis]
    deflection, slope = (basis(ends, lines) @ column for basis in (polynomials, polynomial_slopes))
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
