r"""Resonance bands by first-order averaging: Hsu's method (section 2.2.2, equations 2-21 to 2-28).

A system in the eigenbasis of its mean (:mod:`facegear.floquet.modal`) is unstable to first order where an integer
multiple s of the parametric frequency ω = 2π/T0 comes close to ω_k + ω_j ("sum") or to ω_j − ω_k
("difference") and the averaged equations of the pair grow. Two eigenvalues make the 2 × 2 block of 2-25, whose
borders are in closed form (:func:`facegear.symbolic.hsu.border_detunings`). Every further eigenvalue congruent
to them joins the block, as the text asks for multiple natural frequencies; its borders are roots of the growth
rate.

First order in the modulation: borders and growth rates are off by terms of its square, and a resonance that
needs two harmonics in a row, as the second one of Mathieu's equation, is not there at all.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Literal, TypeVar

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq, minimize_scalar

from facegear.floquet.averaging import (
    REACH,
    ResonanceBlock,
    averaged_block,
    congruent_block,
    coupled,
    driving_pair,
    signature,
    unstable_intervals,
)
from facegear.floquet.modal import ModalExpansion, modal_expansion
from facegear.floquet.models import Model
from facegear.floquet.periodic import PeriodicSystem
from facegear.support.parameters import ascending, integer_at_least, nonnegative
from facegear.support.threads import one_thread
from facegear.support.types import FloatArray

Kind = Literal["sum", "difference"]

_ROUNDING = 1e-11  # Relative size below which a rate is rounding.


@dataclass(frozen=True, eq=False)
class ResonanceBand:
    """Interval of the parametric frequency where a combination of natural frequencies grows.

    Attributes
    ----------
    k, j : int
        Numbers of the two natural frequencies, from 1 as in the text, ascending; equal for a single frequency.
    kind : {"sum", "difference"}
        sω ≈ ω_k + ω_j or sω ≈ ω_j − ω_k.
    order : int
        s.
    frequencies : tuple of float
        ω_k and ω_j [rad/s].
    centre : float
        (ω_k + ω_j)/s or (ω_j − ω_k)/s [rad/s].
    lower, upper : float
        Borders of the parametric frequency ω [rad/s]. Upper is infinite, and lower 0, where first order sets no
        border: one of the two modes is undamped and the other is not.
    peak : float
        Parametric frequency of the fastest growth [rad/s]; the centre where both modes are damped alike.
    growth_rate : float
        Growth rate σ there [1/s], positive.
    modes : tuple of int
        All natural frequencies that take part, from 1: more than k and j where frequencies are multiple or close.
    """

    k: int
    j: int
    kind: Kind
    order: int
    frequencies: tuple[float, float]
    centre: float
    lower: float
    upper: float
    peak: float
    growth_rate: float
    modes: tuple[int, ...]
    block: ResonanceBlock = field(repr=False)

    @property
    def label(self) -> str:
        """Combination and order as the text writes them, such as "(1+2)/1" or "(3-1)/2"."""
        if self.kind == "sum":
            return f"({self.k}+{self.j})/{self.order}"
        return f"({self.j}-{self.k})/{self.order}"

    def growth(self, frequency: ArrayLike) -> FloatArray:
        """Growth rate σ [1/s] of this resonance at parametric frequencies [rad/s], negative where it decays."""
        return self.block.growth_rate(frequency)


@dataclass(frozen=True, eq=False)
class SpeedBand:
    """Interval of speed where a combination of natural frequencies grows.

    Attributes
    ----------
    lower, upper : float
        Borders, in the unit of the speeds asked for; 0 and infinite as in :class:`ResonanceBand`.
    centre : float
        Speed at which sω equals the combination of natural frequencies.
    band : ResonanceBand
        The band of the parametric frequency with all matrices taken at a crossing of sω with its pair, or with
        another pair of the same block.
    """

    lower: float
    upper: float
    centre: float
    band: ResonanceBand

    @property
    def label(self) -> str:
        """Label of the band."""
        return self.band.label


def resonance_bands(
    system: PeriodicSystem | ModalExpansion, *, order: int = 6, reach: float = REACH
) -> tuple[ResonanceBand, ...]:
    """Bands of the parametric frequency in which a system is unstable to first order.

    Parameters
    ----------
    system : PeriodicSystem or ModalExpansion
        A system is expanded by :func:`facegear.floquet.modal.modal_expansion`. For the dissertation's own approximation
        give ``standard_form(system, order).expansion()``.
    order : int
        Highest s.
    reach : float
        Further eigenvalues join a pair if closer to it than ``reach`` times their coupling to it. With 0 each pair
        stands alone, as in 2-26 to 2-28: multiple natural frequencies are then not taken together, and
        resonances driven by way of a third eigenvalue are missed.

    Returns
    -------
    tuple of ResonanceBand
        Ascending by centre; empty if damping leaves none.

    Raises
    ------
    ValueError
        If the mean system is unstable or has a rigid-body mode, ``order`` exceeds that of the expansion given, or
        ``reach`` is negative.

    Notes
    -----
    Matrices are taken as they are at the system's period, as functions of the fraction of the period; the
    parametric frequency alone varies. Where they change with speed use :func:`band_speeds`. Differences of
    frequencies within three times their coupling are left out: a modulation as slow as the growth it causes
    is not averaged.

    Examples
    --------
    >>> import facegear as fg
    >>> body = fg.Body(fg.Drive(26, 130, 3.175e-3), thickness_ratio=0.03)
    >>> model = fg.Transverse(body, fg.MeshLoad(stiffness=0.6, damping=3e-6, mass=1.0))
    >>> bands = fg.resonance_bands(model.system(fg.rad_per_s(530.0)))
    >>> print(f"{bands[0].lower:.0f} to {bands[0].upper:.0f} rad/s, up to {bands[0].growth_rate:.2f} 1/s")
    781 to 784 rad/s, up to 0.89 1/s
    """
    expansion = _expanded(system, order, reach)
    _refuse_unstable_mean(expansion)
    bands: list[ResonanceBand] = []
    seen: set[tuple[tuple[int, int], ...]] = set()
    for a, b, s, centre in _combinations(expansion, order):
        block = congruent_block(expansion, a, b, s, centre, reach)
        key = signature(block)
        if key not in seen:
            seen.add(key)
            bands += _block_bands(expansion, block, centre)
    # The larger of two blocks that find the same band has it better.
    bands.sort(key=lambda band: -len(band.block.members))
    return tuple(sorted(_without_repeats(bands), key=lambda band: (band.centre, band.label)))


@one_thread()
def band_speeds(
    model: Model,
    speeds: tuple[float, float],
    *,
    order: int = 6,
    reach: float = REACH,
    points: int = 41,
    expand: Callable[[PeriodicSystem, int], ModalExpansion] = modal_expansion,
) -> tuple[SpeedBand, ...]:
    """Intervals of speed in which a model whose matrices change with speed is unstable to first order.

    Parameters
    ----------
    model : Model
        Its system at each speed [rad/s].
    speeds : tuple of float
        Lowest and highest speed at which sω may equal a combination of natural frequencies; borders may lie
        outside.
    order : int
        Highest s.
    reach : float
        As for :func:`resonance_bands`.
    points : int
        Speeds at which combinations are first compared with sω, at least 2. A combination is missed only if it
        crosses sω twice between two of them.
    expand : callable
        Expansion about the mean: :func:`facegear.floquet.modal.modal_expansion`, or for the dissertation's own
        approximation ``lambda system, order: standard_form(system, order).expansion()``.

    Returns
    -------
    tuple of SpeedBand
        Ascending by centre.

    Raises
    ------
    ValueError
        If the range is empty or not positive, the number of oscillating modes changes inside it, or the mean
        system is unstable at a crossing.
    """
    order = integer_at_least("order", order, 1)
    reach = nonnegative("reach", reach)
    low, high = ascending("speeds", speeds, "rad/s")
    grid = np.linspace(low, high, integer_at_least("points", points, 2))
    sampled = [expand(model.system(float(speed)), 1) for speed in grid]
    sizes = {len(mean.frequencies) for mean in sampled}
    if len(sizes) > 1:
        raise ValueError(
            f"speeds = {speeds!r}: the number of oscillating modes changes in this range (between {min(sizes)} and "
            f"{max(sizes)}); give ranges in which it stays"
        )
    signed = np.array([mean.signed_frequencies for mean in sampled])
    parametric = np.array([mean.parametric_frequency for mean in sampled])

    found: list[tuple[bool, SpeedBand]] = []
    for a, b in _pairs(signed.shape[1] // 2):
        for s in range(1, order + 1):
            detuning = s * parametric - (signed[:, a] - signed[:, b])
            for i in np.flatnonzero(np.sign(detuning[:-1]) * np.sign(detuning[1:]) <= 0):
                if detuning[i + 1] == 0 and i + 2 < len(grid):
                    continue  # The next interval begins with this root.
                bracket = ((grid[i], detuning[i]), (grid[i + 1], detuning[i + 1]))
                found += _bands_near(model, expand, bracket, (a, b, s), order, reach)
    # A band is best known from the crossing of its own pair, then from the larger block.
    found.sort(key=lambda item: (not item[0], -len(item[1].band.block.members)))
    bands = _without_repeats([band for _, band in found])
    return tuple(sorted(bands, key=lambda band: (band.centre, band.label)))


_Band = TypeVar("_Band", ResonanceBand, SpeedBand)


def _without_repeats(bands: list[_Band]) -> list[_Band]:
    """Keep the first of bands that overlap and have the same label."""
    kept: list[_Band] = []
    for band in bands:
        if not any(
            band.label == other.label and band.lower <= other.upper and other.lower <= band.upper
            for other in kept
        ):
            kept.append(band)
    return kept


def _bands_near(
    model: Model,
    expand: Callable[[PeriodicSystem, int], ModalExpansion],
    bracket: tuple[tuple[float, float], tuple[float, float]],
    pair: tuple[int, int, int],
    order: int,
    reach: float,
) -> Iterator[tuple[bool, SpeedBand]]:
    """Bands of the block around one crossing, and whether it is the crossing of the pair that drives them.

    Borders are followed with the matrices of each speed.
    """
    a, b, s = pair

    def residual(speed: float) -> float:
        mean = expand(model.system(speed), 1)
        return float(
            s * mean.parametric_frequency - (mean.signed_frequencies[a] - mean.signed_frequencies[b])
        )

    # The chord is good enough to see whether there is anything to be found.
    (low, at_low), (high, at_high) = bracket
    crossing = low if at_low == at_high else low - at_low * (high - low) / (at_high - at_low)
    expansion = expand(model.system(crossing), order)
    if not coupled(expansion, a, b, s):
        return
    _refuse_unstable_mean(expansion)
    if congruent_block(expansion, a, b, s, expansion.parametric_frequency, reach).growth_bound <= 0:
        return
    if at_low * at_high < 0:
        crossing = float(brentq(residual, low, high, xtol=1e-10 * high))
        expansion = expand(model.system(crossing), order)
    block = congruent_block(expansion, a, b, s, expansion.parametric_frequency, reach)

    def growth(speed: float) -> float:
        here = expand(model.system(speed), order)
        return float(averaged_block(here, block.members, block.shifts).growth_rate(here.parametric_frequency))

    level = _ROUNDING * float(np.abs(block.coupling).max())
    per_speed = crossing / expansion.parametric_frequency
    for band in _block_bands(expansion, block, expansion.parametric_frequency):
        # The frozen band scaled to speed is where the true one begins to be looked for.
        peak = band.peak * per_speed
        if growth(peak) <= level and band.lower > 0 and math.isfinite(band.upper):
            wide = 2 * (band.upper - band.lower) * per_speed
            bounds = (max(peak - wide, peak / 2), peak + wide)
            peak = float(minimize_scalar(lambda v: -growth(v), bounds=bounds, method="bounded").x)
        if growth(peak) <= level:
            continue
        borders = []
        for frozen in (band.lower, band.upper):
            if frozen in (0.0, math.inf):
                borders.append(frozen)
                continue
            step = (frozen - band.peak) * per_speed
            inside, outside = peak, peak + step * 1.02
            for _ in range(12):
                if outside <= 0 or growth(outside) <= level:
                    break
                inside, outside = outside, outside + step
            else:
                raise ArithmeticError(
                    f"the band {band.label} near speed {crossing:.6g} has no border to be found"
                )
            found = (
                brentq(lambda v: growth(v) - level, inside, outside, xtol=1e-9 * crossing)
                if outside > 0
                else 0
            )
            borders.append(float(found))
        centre = band.centre * per_speed
        yield abs(centre - crossing) <= 1e-9 * crossing, SpeedBand(borders[0], borders[1], centre, band)


def _expanded(system: PeriodicSystem | ModalExpansion, order: int, reach: float) -> ModalExpansion:
    order = integer_at_least("order", order, 1)
    reach = nonnegative("reach", reach)
    if isinstance(system, PeriodicSystem):
        return modal_expansion(system, order)
    if not isinstance(system, ModalExpansion):
        raise TypeError(f"system = {system!r}: valid are a PeriodicSystem and a ModalExpansion")
    if order > system.order:
        raise ValueError(f"order = {order}: the expansion holds orders 1 to {system.order}")
    return system


def _refuse_unstable_mean(expansion: ModalExpansion) -> None:
    if expansion.mean_growth_rate > _ROUNDING * expansion.frequencies[-1]:
        raise ValueError(
            f"system: its mean is unstable by itself (growth rate {expansion.mean_growth_rate:.6g} 1/s), so that there "
            "are no bands of parametric resonance to bound"
        )


def _pairs(modes: int) -> Iterator[tuple[int, int]]:
    """Signed eigenvalues (a, b) of all sums ω_k + ω_j and differences ω_j − ω_k = Ω_a − Ω_b."""
    for j in range(modes):
        for k in range(j + 1):
            yield j, modes + k
            if k < j:
                yield j, k


def _combinations(expansion: ModalExpansion, order: int) -> Iterator[tuple[int, int, int, float]]:
    """All coupled pairs with their order and centre frequency [rad/s]."""
    signed = expansion.signed_frequencies
    for a, b in _pairs(len(expansion.frequencies)):
        distance = float(signed[a] - signed[b])
        for s in range(1, order + 1):
            slow = distance <= REACH * expansion.strength[expansion.order + s, a, b]
            if coupled(expansion, a, b, s) and not slow:
                yield a, b, s, distance / s


def _block_bands(
    expansion: ModalExpansion, block: ResonanceBlock, frequency: float
) -> Iterator[ResonanceBand]:
    """Bands of one block, each named after the pair that drives it."""
    modes = tuple(sorted({member % block.modes + 1 for member in block.members}))
    intervals = unstable_intervals(block, frequency)
    for lower, upper, peak in intervals:
        a, b = driving_pair(block, (lower, upper, peak))
        s = block.shifts[a] - block.shifts[b]
        if s < 0:
            a, b, s = b, a, -s
        first, second = block.members[a], block.members[b]
        kind: Kind = "sum" if (first < block.modes) != (second < block.modes) else "difference"
        k, j = sorted((first % block.modes, second % block.modes))
        yield ResonanceBand(
            k=k + 1,
            j=j + 1,
            kind=kind,
            order=s,
            frequencies=(float(expansion.frequencies[k]), float(expansion.frequencies[j])),
            centre=float(block.signed_frequencies[a] - block.signed_frequencies[b]) / s,
            lower=max(lower, 0.0),
            upper=upper,
            peak=peak,
            growth_rate=float(block.growth_rate(peak)),
            modes=modes,
            block=block,
        )
