"""Motion of a system with clearances along the panels of a pattern of contacts, and the pattern that it has."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial import chebyshev, legendre
from numpy.typing import NDArray

from facegear.floquet.contact_panels import Linearised, Rule, rule_of
from facegear.floquet.contact_patterns import BoolArray, Pattern, merged
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.support.types import FloatArray

# Two instants closer than this fraction of the period are one.
_SAME = 1e-11
# Steps of the search for an instant in its bracket.
_REFINEMENTS = 60
# Change of the place in a panel at which a step of Newton's method is the last: the next would be its square.
_FOUND = 1e-10


@dataclass(frozen=True, eq=False)
class Motion:
    """A motion along the panels of a pattern.

    Attributes
    ----------
    along : Linearised
    origin : array, shape (2n + 1,)
        State (q, q̇, 1) at 0.
    starts : array, shape (P, 2n + 1)
        States after the jumps at the starts of the panels.
    """

    along: Linearised
    origin: FloatArray
    starts: FloatArray

    @cached_property
    def accelerations(self) -> FloatArray:
        """q̈ at the nodes, shape (P, N, n)."""
        return np.asarray((self.along.accelerations @ self.starts[:, np.newaxis, :, np.newaxis])[..., 0])

    @cached_property
    def reached(self) -> FloatArray:
        """φᵀq of each load at the start, the nodes and the end of each panel, (P, N + 2, p)."""
        rule = rule_of(self.along.panels.nodes)
        places, none = np.concatenate([[0.0], rule.nodes, [1.0]]), np.zeros((1, rule.nodes.size))
        once = np.concatenate([none, rule.once, rule.end_once[np.newaxis]])
        q, _ = self._states(places, once, np.concatenate([none, rule.twice, rule.end_twice[np.newaxis]]))
        return np.stack([(at.phi_and_ends * q).sum(axis=-1) for at in self.along.loads], axis=-1)

    @property
    def _lengths(self) -> FloatArray:
        return np.asarray(np.diff(self.along.pattern.edges) * self.along.system.period)[
            :, np.newaxis, np.newaxis
        ]

    def _states(
        self, places: FloatArray, once: FloatArray, twice: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        n, h = self.along.system.size, self._lengths
        q, v = self.starts[:, np.newaxis, :n], self.starts[:, np.newaxis, n : 2 * n]
        a = self.accelerations
        return q + h * places[:, np.newaxis] * v + h**2 * (twice @ a), v + h * (once @ a)

    @cached_property
    def displacements(self) -> FloatArray:
        """Displacement u = φᵀq − e of each load at the places of :attr:`reached`."""
        return self.reached - np.stack([at.error_and_ends for at in self.along.loads], axis=-1)

    @cached_property
    def series(self) -> PiecewiseChebyshev:
        """State (q, q̇) against the fraction of the period."""
        rule = rule_of(self.along.panels.nodes)
        states = np.concatenate(
            self._states(rule.series_places, rule.series_once, rule.series_twice), axis=-1
        )
        return PiecewiseChebyshev(self.along.pattern.edges[:-1], rule.to_series @ states)

    def towards(self, before: PiecewiseChebyshev, part: float) -> tuple[PiecewiseChebyshev, FloatArray]:
        """Return a motion between another one and this, for steps that would go too far.

        Parameters
        ----------
        before : PiecewiseChebyshev
            State of the other motion.
        part : float
            How much of the way to this one, up to 1.

        Returns
        -------
        PiecewiseChebyshev
            State of the motion between.
        array, shape (P, N + 2, p)
            By how much displacements of the loads differ from those of this one there.
        """
        rule, n = rule_of(self.along.panels.nodes), self.along.system.size
        starts, lengths = self.along.pattern.edges[:-1, np.newaxis], self.series.lengths[:, np.newaxis]
        states = before(starts + lengths * rule.series_places)
        mixed = self.series.coefficients * part + (1.0 - part) * (rule.to_series @ states)
        between = PiecewiseChebyshev(self.series.breakpoints, mixed)
        places = np.concatenate([[0.0], rule.nodes, [1.0]])
        basis = chebyshev.chebvander(2.0 * places - 1.0, mixed.shape[1] - 1)
        moved = basis @ (mixed - self.series.coefficients)[..., :n]
        return between, np.stack([(at.phi_and_ends * moved).sum(axis=-1) for at in self.along.loads], axis=-1)

    @property
    def unresolved(self) -> float:
        """Last Legendre coefficients of the accelerations on a panel over the largest acceleration."""
        series = rule_of(self.along.panels.nodes).to_legendre @ self.accelerations
        return float(np.abs(series[:, -2:]).max() / max(np.abs(self.accelerations).max(), 1e-300))


def found_pattern(
    motion: Motion, base: FloatArray, further: FloatArray | float = 0.0
) -> tuple[Pattern, float]:
    """Contacts that a motion has.

    Parameters
    ----------
    motion : Motion
    base : array
        Ends of panels without regard to contacts.
    further : array, shape (P, N + 2, p), optional
        Added to the displacements of the loads.

    Returns
    -------
    Pattern
        On the panels of `base`, split where contacts are made or lost.
    float
        Largest distance from the clearance, over the largest displacement, at places where the pattern along which
        the motion was computed has another contact than it makes: 0 for a motion that is one of the system.
    """
    along = motion.along
    system, old, rule = along.system, along.pattern, rule_of(along.panels.nodes)
    sides, clearances = np.array(system.sides), np.array(system.clearances)
    there = np.stack([at.there for at in along.loads], axis=-1)
    beyond = (motion.displacements + further) * sides - clearances
    series, samples = rule.ends_to_legendre @ beyond, rule.to_places @ beyond
    guarded = there & (sides != 0)
    positive = samples > 0.0
    wrong = (positive != old.pressed[:, np.newaxis]) & guarded[:, np.newaxis]
    size = float(np.abs(motion.displacements).max(initial=0.0))
    mismatch = float(np.abs(samples[wrong]).max(initial=0.0)) / max(size, 1e-300)

    edges = merged(base, _crossed(series, samples, guarded, old.edges, rule))
    middles = (edges[:-1] + edges[1:]) / 2.0
    panel = np.searchsorted(old.edges, middles, side="right") - 1
    pressed = (_at(series, old.edges, panel, middles) > 0.0) & guarded[panel]
    pressed |= there[panel] & (sides == 0)
    return Pattern(edges, pressed, _crossings(motion, edges, pressed, guarded[panel])), mismatch


def _at(series: FloatArray, edges: FloatArray, panel: NDArray[np.intp], fractions: FloatArray) -> FloatArray:
    """Values of Legendre series (P, N + 2, p) on panels at some fractions, (m, p)."""
    local = 2.0 * (fractions - edges[panel]) / (edges[panel + 1] - edges[panel]) - 1.0
    return np.asarray(np.einsum("md,mdp->mp", legendre.legvander(local, series.shape[1] - 1), series[panel]))


def _crossed(
    series: FloatArray, samples: FloatArray, guarded: BoolArray, edges: FloatArray, rule: Rule
) -> FloatArray:
    """Fractions of the period at which some load meets its clearance."""
    positive = samples > 0.0
    panel, place, load = np.nonzero((positive[:, :-1] != positive[:, 1:]) & guarded[:, np.newaxis])
    brackets = [(panel, load, rule.places[place], rule.places[place + 1])]
    brackets += _grazes(series, samples, guarded, rule)
    panel, load, low, high = (np.concatenate(part) for part in zip(*brackets, strict=True))
    roots = _root(series[panel, :, load], low, high)
    inside = edges[panel] + (1.0 + roots) / 2.0 * (edges[panel + 1] - edges[panel])
    # Between the end of a panel and the start of the next, the motion goes on.
    both = guarded & np.roll(guarded, -1, axis=0)
    across = ((positive[:, -1] != np.roll(positive[:, 0], -1, axis=0)) & both).any(axis=1)
    found = np.concatenate([inside, edges[1:][across]])
    return found[(found > _SAME) & (found < 1.0 - _SAME)]


def _grazes(
    series: FloatArray, samples: FloatArray, guarded: BoolArray, rule: Rule
) -> list[tuple[NDArray[np.intp], NDArray[np.intp], FloatArray, FloatArray]]:
    """Brackets of pairs of crossings between neighbouring samples of one sign."""
    before, middle, after = samples[:, :-2], samples[:, 1:-1], samples[:, 2:]
    sign = np.sign(middle)
    least = (sign * before > sign * middle) & (sign * after >= sign * middle) & (sign * middle >= 0.0)
    slope, bend = (after - before) / 2.0, before - 2.0 * middle + after
    depth = slope**2 / np.where(bend == 0.0, 1.0, 2.0 * np.abs(bend))
    panel, place, load = np.nonzero(least & (depth > 0.2 * np.abs(middle)) & guarded[:, np.newaxis])
    if not panel.size:
        return []
    # Least value by Newton's method for the slope, in a bracket of two samples.
    own = series[panel, :, load].T
    first, second = legendre.legder(own), legendre.legder(own, 2)
    low, high = rule.places[place], rule.places[place + 2]
    z = rule.places[place + 1]
    for _ in range(8):
        bent = legendre.legval(z, second, tensor=False)
        z = np.clip(z - legendre.legval(z, first, tensor=False) / np.where(bent == 0.0, 1.0, bent), low, high)
    other = np.sign(legendre.legval(z, own, tensor=False)) * np.sign(middle[panel, place, load]) < 0.0
    panel, load, z, low, high = panel[other], load[other], z[other], low[other], high[other]
    return [(panel, load, low, z), (panel, load, z, high)]


def _root(series: FloatArray, low: FloatArray, high: FloatArray) -> FloatArray:
    """Roots of Legendre series (R, N + 2) in brackets, by Newton's method held in them."""
    if not low.size:
        return low
    own = series.T
    slope = legendre.legder(own)
    sign = np.sign(legendre.legval(high, own, tensor=False))
    z = (low + high) / 2.0
    for _ in range(_REFINEMENTS):
        value = legendre.legval(z, own, tensor=False)
        above = value * sign > 0.0
        low, high = np.where(above, low, z), np.where(above, z, high)
        steep = legendre.legval(z, slope, tensor=False)
        new = z - value / np.where(steep == 0.0, 1.0, steep)
        new = np.where((new >= low) & (new <= high), new, (low + high) / 2.0)
        change, z = np.abs(new - z).max(), new
        if change < _FOUND:
            break
    return z


def _crossings(
    motion: Motion, edges: FloatArray, pressed: BoolArray, guarded: BoolArray
) -> tuple[tuple[int, int, float], ...]:
    """Contacts that the motion makes or loses, not those that begin or end with the load itself."""
    before = np.roll(pressed, 1, axis=0)
    changed = (before != pressed) & guarded & np.roll(guarded, 1, axis=0)
    found = []
    for panel, number in zip(*np.nonzero(changed), strict=True):
        load = motion.along.system.system.loads[number]
        own = np.abs(load.breakpoints - edges[panel])
        if np.minimum(own, 1.0 - own).min() < _SAME:
            continue
        sign = 1.0 if pressed[panel, number] else -1.0
        moves = load.rate == "frozen" and load.slope.largest > 0.0
        ratio = _frozen_ratio(motion, int(number), float(edges[panel])) if moves else 1.0
        found.append((int(panel), int(number), sign * ratio))
    return tuple(found)


def _frozen_ratio(motion: Motion, number: int, fraction: float) -> float:
    """Rate that a damper with frozen rate feels over that of its displacement, at an instant."""
    system = motion.along.system
    load, n = system.system.loads[number], system.size
    state = motion.series(fraction)
    q, v = state[:n], state[n:]
    felt = float(load.shape(fraction) @ v)
    if load.transmission_error is not None:
        felt -= float(load.transmission_error.derivative()(fraction)[0]) / system.period
    moving = float(load.slope(fraction) @ q) / system.period
    return felt / (felt + moving) if felt + moving != 0.0 else 1.0
