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

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, Literal, TypeVar

from numpy.typing import ArrayLike

from facegear.floquet.averaging import (
    REACH,
    ResonanceBlock,
    congruent_block,
    coupled,
    driving_pair,
    signature,
    unstable_intervals,
)
from facegear.floquet.modal import ModalExpansion, modal_expansion
from facegear.floquet.periodic import PeriodicSystem
from facegear.support.parameters import integer_at_least, nonnegative
from facegear.support.types import FloatArray

Kind = Literal["sum", "difference"]

#: Relative size below which a rate is rounding.
ROUNDING = 1e-11


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
    parametric frequency alone varies. Where they change with speed use
    :func:`facegear.floquet.band_speeds.band_speeds`. Differences of frequencies within three times their coupling are
    left out: a modulation as slow as the growth it causes is not averaged.

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
    refuse_unstable_mean(expansion)
    bands: list[ResonanceBand] = []
    seen: set[tuple[tuple[int, int], ...]] = set()
    for a, b, s, centre in _combinations(expansion, order):
        block = congruent_block(expansion, a, b, s, centre, reach)
        key = signature(block)
        if key not in seen:
            seen.add(key)
            bands += block_bands(expansion, block, centre)
    # The larger of two blocks that find the same band has it better.
    bands.sort(key=lambda band: -len(band.block.members))
    return tuple(sorted(without_repeats(bands), key=lambda band: (band.centre, band.label)))


BandT = TypeVar("BandT", bound=Any)


def without_repeats(bands: list[BandT]) -> list[BandT]:
    """Keep the first of bands, each with `lower`, `upper` and `label`, that overlap and have the same label."""
    kept: list[BandT] = []
    for band in bands:
        if not any(
            band.label == other.label and band.lower <= other.upper and other.lower <= band.upper
            for other in kept
        ):
            kept.append(band)
    return kept


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


def refuse_unstable_mean(expansion: ModalExpansion) -> None:
    """Refuse a system whose mean is unstable by itself.

    Raises
    ------
    ValueError
        Naming its growth rate.
    """
    if expansion.mean_growth_rate > ROUNDING * expansion.frequencies[-1]:
        raise ValueError(
            f"system: its mean is unstable by itself (growth rate {expansion.mean_growth_rate:.6g} 1/s), so that there "
            "are no bands of parametric resonance to bound"
        )


def pairs(modes: int) -> Iterator[tuple[int, int]]:
    """Yield the signed eigenvalues (a, b) of all sums ω_k + ω_j and differences ω_j − ω_k = Ω_a − Ω_b."""
    for j in range(modes):
        for k in range(j + 1):
            yield j, modes + k
            if k < j:
                yield j, k


def _combinations(expansion: ModalExpansion, order: int) -> Iterator[tuple[int, int, int, float]]:
    """All coupled pairs with their order and centre frequency [rad/s]."""
    signed = expansion.signed_frequencies
    for a, b in pairs(len(expansion.frequencies)):
        distance = float(signed[a] - signed[b])
        for s in range(1, order + 1):
            slow = distance <= REACH * expansion.strength[expansion.order + s, a, b]
            if coupled(expansion, a, b, s) and not slow:
                yield a, b, s, distance / s


def block_bands(
    expansion: ModalExpansion, block: ResonanceBlock, frequency: float
) -> Iterator[ResonanceBand]:
    """Yield the bands of one block, each named after the pair that drives it."""
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
