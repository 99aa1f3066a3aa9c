"""Resonance bands along speed, by first-order averaging with the matrices of each speed.

The bands of :mod:`facegear.floquet.hsu` are of the parametric frequency, with matrices as they are at one speed. Where
these change with speed, a combination is met where its own frequencies, at that speed, fit the parametric one.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from facegear.floquet.averaging import REACH, averaged_block, congruent_block, coupled
from facegear.floquet.hsu import (
    ROUNDING,
    ResonanceBand,
    block_bands,
    pairs,
    refuse_unstable_mean,
    without_repeats,
)
from facegear.floquet.modal import ModalExpansion, modal_expansion
from facegear.floquet.models import Model
from facegear.floquet.periodic import PeriodicSystem
from facegear.support.parameters import ascending, integer_at_least, nonnegative
from facegear.support.threads import one_thread


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
    for a, b in pairs(signed.shape[1] // 2):
        for s in range(1, order + 1):
            detuning = s * parametric - (signed[:, a] - signed[:, b])
            for i in np.flatnonzero(np.sign(detuning[:-1]) * np.sign(detuning[1:]) <= 0):
                if detuning[i + 1] == 0 and i + 2 < len(grid):
                    continue  # The next interval begins with this root.
                bracket = ((grid[i], detuning[i]), (grid[i + 1], detuning[i + 1]))
                found += _bands_near(model, expand, bracket, (a, b, s), order, reach)
    # A band is best known from the crossing of its own pair, then from the larger block.
    found.sort(key=lambda item: (not item[0], -len(item[1].band.block.members)))
    bands = without_repeats([band for _, band in found])
    return tuple(sorted(bands, key=lambda band: (band.centre, band.label)))


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
    refuse_unstable_mean(expansion)
    if congruent_block(expansion, a, b, s, expansion.parametric_frequency, reach).growth_bound <= 0:
        return
    if at_low * at_high < 0:
        crossing = float(brentq(residual, low, high, xtol=1e-10 * high))
        expansion = expand(model.system(crossing), order)
    block = congruent_block(expansion, a, b, s, expansion.parametric_frequency, reach)

    def growth(speed: float) -> float:
        here = expand(model.system(speed), order)
        return float(averaged_block(here, block.members, block.shifts).growth_rate(here.parametric_frequency))

    level = ROUNDING * float(np.abs(block.coupling).max())
    per_speed = crossing / expansion.parametric_frequency
    for band in block_bands(expansion, block, expansion.parametric_frequency):
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
