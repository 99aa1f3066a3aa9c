"""Motion of a system with clearances for a given pattern of contacts, and the pattern that a motion has.

Between the instants at which contacts are made or lost the equations are linear. The panels of an orbit end at the
breakpoints of the system and at those instants, so that the motion is smooth along each and Gauss collocation of the
accelerations converges exponentially with the number of nodes: Fourier series of the whole orbit converge as slowly as
the third power of their order, since a damper that lets go makes the accelerations jump.

Newton's method for the unknown motion follows at once. Where the iterate is in contact, the change of its force is
that of the spring and damper; where the contact is made or lost, the indicator of the contact changes by an impulse

    M Δq̇ = ∓ w φ c (u̇/|u̇|) (φᵀq − e ∓ b),

which vanishes when the new motion meets the clearance at that instant. What is left of it in the transition matrix,
∓ M⁻¹ w φ c φᵀ, is the saltation matrix of the contact. So each step of Newton's method is a linear periodic system with
jumps of the state, and its transition matrix, when the motion has settled, decides stability.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.polynomial import chebyshev, legendre
from numpy.typing import NDArray

from facegear.floquet.clearance import ClearanceSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.support.parameters import integer_within, keep, within
from facegear.support.types import FloatArray

BoolArray = NDArray[np.bool_]

# Two instants closer than this fraction of the period are one.
_SAME = 1e-11
# Steps of the search for an instant in its bracket.
_REFINEMENTS = 60
# Change of the place in a panel at which a step of Newton's method is the last: the next would be its square.
_FOUND = 1e-10
# Panels beyond which each step of Newton's method takes seconds.
_MOST_PANELS = 5000
# Samples of a panel, over its nodes, among which changes of sign are looked for.
_DENSITY = 3


@dataclass(frozen=True)
class Panels:
    """How finely a motion is resolved.

    Parameters
    ----------
    nodes : int
        Gauss nodes of each panel, 4 to 40: the degree to which accelerations are followed.
    angle : float
        Largest angle of the fastest natural motion along a panel [rad].

    Raises
    ------
    TypeError, ValueError
        Naming the argument.
    """

    nodes: int = 12
    angle: float = 2.5

    def __post_init__(self) -> None:
        keep(
            self,
            nodes=integer_within("nodes", self.nodes, 4, 40),
            angle=within("angle", self.angle, 0.05, 20.0),
        )

    def edges(self, system: ClearanceSystem) -> FloatArray:
        """Return the ends of panels without regard to contacts, breakpoints among them, from 0 to 1.

        Raises
        ------
        ArithmeticError
            If there are so many that no motion would be found in any time.
        """
        turns = system.fastest * system.period / self.angle
        if turns > _MOST_PANELS:
            raise ArithmeticError(
                f"the fastest motion in contact, {system.fastest:.3g} rad/s, takes {turns:.3g} panels of "
                f"{self.angle:g} rad in {system.period:.3g} s, more than {_MOST_PANELS}: contacts are too stiff to "
                "resolve"
            )
        return system.divided(self.angle)


@dataclass(frozen=True, eq=False)
class Pattern:
    """Which loads are in contact when.

    Attributes
    ----------
    edges : array, shape (P + 1,)
        Ends of the panels, from 0 to 1.
    pressed : array of bool, shape (P, p)
        Loads in contact along each panel.
    crossings : tuple of (int, int, float)
        Panel at whose start a contact is made or lost by the motion, load, and u̇ of the damper over |u̇| of the
        displacement, positive where contact is made.
    """

    edges: FloatArray
    pressed: BoolArray
    crossings: tuple[tuple[int, int, float], ...] = ()

    @property
    def instants(self) -> FloatArray:
        """Instants at which contacts are made or lost by the motion, fractions of the period."""
        return np.array([self.edges[panel] for panel, *_ in self.crossings])

    def repeated(self, periods: int) -> Pattern:
        """Return the pattern over several periods taken for one."""
        count = len(self.pressed)
        starts = (self.edges[:-1] + np.arange(periods)[:, np.newaxis]) / periods
        crossings = tuple((panel + k * count, i, r) for k in range(periods) for panel, i, r in self.crossings)
        return Pattern(np.append(starts.ravel(), 1.0), np.tile(self.pressed, (periods, 1)), crossings)

    def on(self, base: FloatArray) -> Pattern:
        """Return the pattern on other panels, its own instants kept."""
        edges = merged(base, self.instants)
        middles = (edges[:-1] + edges[1:]) / 2.0
        pressed = self.pressed[np.searchsorted(self.edges, middles, side="right") - 1]
        crossings = tuple(
            (int(np.abs(edges[:-1] - self.edges[panel]).argmin()), i, r) for panel, i, r in self.crossings
        )
        return Pattern(edges, pressed, crossings)


def merged(base: FloatArray, instants: FloatArray) -> FloatArray:
    """Return ends of panels with some instants among them; those that nearly coincide are one."""
    if not instants.size:
        return base
    away = np.abs(instants[:, np.newaxis] - base).min(axis=1)
    new = np.sort(instants[away > _SAME])
    if new.size:
        new = new[np.append(True, np.diff(new) > _SAME)]
    return np.sort(np.concatenate([base, new]))


@dataclass(frozen=True, eq=False)
class _Rule:
    """Gauss nodes of a panel from 0 to 1, and integrals of the polynomials through values there."""

    nodes: FloatArray
    once: FloatArray
    twice: FloatArray
    end_once: FloatArray
    end_twice: FloatArray
    to_legendre: FloatArray
    ends_to_legendre: FloatArray
    places: FloatArray
    to_places: FloatArray
    series_once: FloatArray
    series_twice: FloatArray
    series_places: FloatArray
    to_series: FloatArray


@lru_cache(maxsize=16)
def _rule(count: int) -> _Rule:
    z, weights = (np.asarray(x, dtype=float) for x in legendre.leggauss(count))
    degrees = np.arange(count)
    to_legendre = np.asarray(
        (degrees + 0.5)[:, np.newaxis] * legendre.legvander(z, count - 1).T * weights, dtype=float
    )
    once = np.asarray(legendre.legint(to_legendre, scl=0.5, lbnd=-1.0), dtype=float)
    twice = np.asarray(legendre.legint(once, scl=0.5, lbnd=-1.0), dtype=float)

    def at(series: FloatArray, places: FloatArray) -> FloatArray:
        return np.asarray(legendre.legvander(places, len(series) - 1) @ series, dtype=float)

    # Of values at the start, the nodes and the end.
    with_ends = legendre.legvander(np.concatenate([[-1.0], z, [1.0]]), count + 1)
    ends_to_legendre = np.asarray(np.linalg.inv(with_ends), dtype=float)
    places = np.asarray(-np.cos(np.linspace(0.0, np.pi, _DENSITY * count + 1)), dtype=float)
    points = np.asarray(chebyshev.chebpts1(count + 2), dtype=float)
    return _Rule(
        nodes=(1.0 + z) / 2.0,
        once=at(once, z),
        twice=at(twice, z),
        end_once=at(once, np.ones(1))[0],
        end_twice=at(twice, np.ones(1))[0],
        to_legendre=to_legendre,
        ends_to_legendre=ends_to_legendre,
        places=places,
        to_places=at(ends_to_legendre, places),
        series_once=at(once, points),
        series_twice=at(twice, points),
        series_places=(1.0 + points) / 2.0,
        to_series=np.asarray(np.linalg.inv(chebyshev.chebvander(points, count + 1)), dtype=float),
    )


@dataclass(frozen=True, eq=False)
class _Load:
    """One load at the nodes of all panels: shape and its rate (P, N, n), weight, e, ė (P, N), where it acts (P,).

    Shape and e at both ends besides, (P, N + 2, n) and (P, N + 2).
    """

    phi: FloatArray
    rate: FloatArray
    weight: FloatArray
    error: FloatArray
    error_rate: FloatArray
    there: BoolArray
    phi_and_ends: FloatArray
    error_and_ends: FloatArray


@dataclass(frozen=True, eq=False)
class Linearised:
    """A linear periodic system with jumps: one pattern of contacts, forces and clearances included.

    States are (q, q̇, 1), so that matrices carry what does not depend on the motion.

    Attributes
    ----------
    system : ClearanceSystem
    pattern : Pattern
    steps, jumps : array, shape (P, 2n + 1, 2n + 1)
        Along each panel, and at its start.
    accelerations : array, shape (P, N, n, 2n + 1)
        q̈ at the nodes for unit states at the start.
    loads : tuple
        Of the system, at the nodes.
    """

    system: ClearanceSystem
    pattern: Pattern
    panels: Panels
    steps: FloatArray
    jumps: FloatArray
    accelerations: FloatArray
    loads: tuple[_Load, ...]

    @cached_property
    def whole(self) -> FloatArray:
        """Transition matrix of the period, saltation included, shape (2n + 1, 2n + 1)."""
        matrices = self.steps @ self.jumps
        while len(matrices) > 1:
            even = len(matrices) - len(matrices) % 2
            matrices = np.concatenate([matrices[1:even:2] @ matrices[0:even:2], matrices[even:]])
        return np.asarray(matrices[0])

    def starts(self, state: FloatArray) -> FloatArray:
        """States at the starts of the panels after their jumps, (P, 2n + 1), of the motion from (q, q̇, a) at 0.

        With a = 0 it is a change of the motion, without what forces do.
        """
        found = np.empty((len(self.steps), state.size))
        for panel, (jump, step) in enumerate(zip(self.jumps, self.steps, strict=True)):
            found[panel] = jump @ state
            state = step @ found[panel]
        return found


def linearised(system: ClearanceSystem, pattern: Pattern, panels: Panels) -> Linearised:
    """Solve the motion along all panels of a pattern, for any states at their starts."""
    rule, n, count = _rule(panels.nodes), system.size, panels.nodes
    start, length = pattern.edges[:-1], np.diff(pattern.edges)
    fractions = start[:, np.newaxis] + length[:, np.newaxis] * rule.nodes
    inner, inverse = system.system, system.inverse_mass
    loads = tuple(_load_at(system, number, fractions, pattern.edges) for number in range(len(inner.loads)))
    shape = (*fractions.shape, n, n)
    stiffness = np.broadcast_to(inverse @ inner.stiffness, shape).copy()
    damping = np.broadcast_to(inverse @ inner.damping, shape).copy()
    force = np.zeros((*fractions.shape, n)) if inner.force is None else inner.force(fractions) @ inverse.T
    for number, (load, at) in enumerate(zip(inner.loads, loads, strict=True)):
        on = pattern.pressed[:, number]
        if not on.any():
            continue
        row = (at.phi[on] @ inverse.T) * at.weight[on][..., np.newaxis]
        beyond = at.error[on] + system.sides[number] * system.clearances[number]
        along = load.stiffness * at.phi[on]
        if load.damping > 0.0:
            damping[on] += load.damping * row[..., :, np.newaxis] * at.phi[on][..., np.newaxis, :]
            along = along + load.damping * at.rate[on]
        stiffness[on] += row[..., :, np.newaxis] * along[..., np.newaxis, :]
        force[on] += row * (load.stiffness * beyond + load.damping * at.error_rate[on])[..., np.newaxis]
    h = (length * inner.period)[:, np.newaxis, np.newaxis, np.newaxis, np.newaxis]
    left = (h * rule.once[:, np.newaxis, :, np.newaxis]) * damping[:, :, :, np.newaxis, :]
    left += (h**2 * rule.twice[:, np.newaxis, :, np.newaxis]) * stiffness[:, :, :, np.newaxis, :]
    left = left.reshape(-1, count * n, count * n)
    diagonal = np.arange(count * n)
    left[:, diagonal, diagonal] += 1.0
    drift = damping + h[..., 0] * rule.nodes[:, np.newaxis, np.newaxis] * stiffness
    right = np.concatenate([-stiffness, -drift, force[..., np.newaxis]], axis=-1)
    found = np.linalg.solve(left, right.reshape(-1, count * n, 2 * n + 1)).reshape(-1, count, n, 2 * n + 1)
    steps = np.broadcast_to(np.eye(2 * n + 1), (len(start), 2 * n + 1, 2 * n + 1)).copy()
    step = h[:, :, 0, 0]
    steps[:, :n, n : 2 * n] += step * np.eye(n)
    steps[:, :n] += step**2 * np.tensordot(rule.end_twice, found, axes=(0, 1))
    steps[:, n : 2 * n] += step * np.tensordot(rule.end_once, found, axes=(0, 1))
    return Linearised(system, pattern, panels, steps, _jumps(system, pattern), found, loads)


def _load_at(system: ClearanceSystem, number: int, fractions: FloatArray, edges: FloatArray) -> _Load:
    load, period = system.system.loads[number], system.period
    phi = _with_ends(load.shape, fractions, edges)
    inner = phi[:, 1:-1]
    rate = load.slope(fractions) / period if load.rate == "total" else np.zeros_like(inner)
    weight = np.ones(fractions.shape) if load.weight is None else load.weight(fractions)[..., 0]
    error, error_rate = np.zeros(phi.shape[:2]), np.zeros(fractions.shape)
    if load.transmission_error is not None:
        error = _with_ends(load.transmission_error, fractions, edges)[..., 0]
        error_rate = load.transmission_error.derivative()(fractions)[..., 0] / period
    there = (np.abs(inner).max(axis=(1, 2)) > 0.0) & (np.abs(weight).max(axis=1) > 0.0)
    return _Load(inner, rate, weight, error[:, 1:-1], error_rate, there, phi, error)


def _with_ends(function: PiecewiseChebyshev, fractions: FloatArray, edges: FloatArray) -> FloatArray:
    """Values at the starts, nodes (P, N) and ends of panels, limits from inside, (P, N + 2, ...)."""
    first = function(np.concatenate([edges[:-1, np.newaxis], fractions], axis=1))
    return np.concatenate([first, function(edges[1:], "left")[:, np.newaxis]], axis=1)


def struck(system: ClearanceSystem, number: int, at: float, ratio: float) -> tuple[FloatArray, FloatArray]:
    """Shape φ of a load at an instant, and M⁻¹ w φ c times a ratio: −(push φᵀ) is the saltation of its contact."""
    load = system.system.loads[number]
    phi = load.shape(at)
    weight = 1.0 if load.weight is None else load.weight(at)[0]
    return phi, system.inverse_mass @ phi * (weight * load.damping * ratio)


def _jumps(system: ClearanceSystem, pattern: Pattern) -> FloatArray:
    """Return what Newton's method makes of contacts made or lost at the starts of panels, (P, 2n + 1, 2n + 1)."""
    n = system.size
    jumps = np.broadcast_to(np.eye(2 * n + 1), (len(pattern.pressed), 2 * n + 1, 2 * n + 1)).copy()
    for panel, number, ratio in pattern.crossings:
        load, at = system.system.loads[number], float(pattern.edges[panel])
        if load.damping == 0.0:
            continue
        phi, push = struck(system, number, at, ratio)
        error = 0.0 if load.transmission_error is None else load.transmission_error(at)[0]
        beyond = error + system.sides[number] * system.clearances[number]
        jumps[panel, n : 2 * n] -= np.outer(push, np.concatenate([phi, np.zeros(n), [-beyond]]))
    return jumps


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
        rule = _rule(self.along.panels.nodes)
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
        rule = _rule(self.along.panels.nodes)
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
        rule, n = _rule(self.along.panels.nodes), self.along.system.size
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
        series = _rule(self.along.panels.nodes).to_legendre @ self.accelerations
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
    system, old, rule = along.system, along.pattern, _rule(along.panels.nodes)
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
    series: FloatArray, samples: FloatArray, guarded: BoolArray, edges: FloatArray, rule: _Rule
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
    series: FloatArray, samples: FloatArray, guarded: BoolArray, rule: _Rule
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
