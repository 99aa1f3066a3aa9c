"""Which of N slots of a periodic signal has a known pattern, and how much of it: a matched filter.

A signal of one revolution, N slots of S samples each, is what every slot has in common, plus a times a pattern that
begins at slot j, cyclically, plus white noise of deviation σ. What is common to the slots is taken off signal and
pattern. The slot on whose pattern the rest projects most is the most likely one for any a > 0 (Kay, Fundamentals of
Statistical Signal Processing: Detection Theory, 1998), and that projection over the energy of the pattern is the
estimate of a with the least variance, σ²/‖h‖². Slot k is taken for slot j with the probability Q(a ‖h_j − h_k‖/(2σ)) if
these two are all there is, which bounds the rate of errors from both sides: by the largest of these from below, by
their sum from above.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.stats import binomtest, norm

from facegear.support.parameters import finite_array, integer_at_least, integer_within, keep, positive, within
from facegear.support.types import FloatArray


@dataclass(frozen=True, eq=False)
class SlotFilter:
    """Matched filter over the slots of a revolution.

    Parameters
    ----------
    pattern : array_like, shape (N, S)
        The pattern that begins at slot 0, as samples of the whole revolution, or that plus anything that all slots have
        in common.

    Raises
    ------
    ValueError
        If there are less than two slots, or all are alike.
    """

    pattern: FloatArray

    def __post_init__(self) -> None:
        pattern = finite_array("pattern", self.pattern)
        if pattern.ndim != 2 or len(pattern) < 2 or pattern.shape[1] < 1:
            raise ValueError(
                f"pattern must have shape (slots, samples), two slots or more; got {pattern.shape}"
            )
        rest = without_common(pattern)
        if np.abs(rest).max() <= 1e-13 * np.abs(pattern).max():
            raise ValueError("pattern must not be the same in all slots: no filter could tell them apart")
        keep(self, pattern=rest)

    @property
    def energy(self) -> float:
        """‖h‖²."""
        return float((self.pattern**2).sum())

    def projections(self, signals: ArrayLike) -> FloatArray:
        """Projections of signals (..., N, S) on the pattern at each slot, shape (..., N)."""
        values = finite_array("signals", signals)
        if values.shape[-2:] != self.pattern.shape:
            raise ValueError(f"signals must have shape (..., {self.pattern.shape}), got {values.shape}")
        spectrum = np.fft.rfft(values, axis=-2) * np.fft.rfft(self.pattern, axis=0).conj()
        return np.asarray(np.fft.irfft(spectrum.sum(axis=-1), len(self.pattern), axis=-1), dtype=float)

    def found(self, signals: ArrayLike) -> tuple[Any, Any]:
        """Most likely slot and estimate of a of each signal.

        Some slot is always the most likely one, of a signal without any pattern too: an estimate within a few times
        :meth:`amount_deviation` of 0 says that there is none, and the slot is then one of chance.

        Parameters
        ----------
        signals : array_like, shape (..., N, S)

        Returns
        -------
        slots : int, or array of int, shape (...)
        amounts : float, or array, shape (...)
            Plain numbers for one signal.
        """
        projections = self.projections(signals)
        slots, amounts = projections.argmax(axis=-1), projections.max(axis=-1) / self.energy
        return (int(slots), float(amounts)) if projections.ndim == 1 else (slots, amounts)

    @property
    def distances(self) -> FloatArray:
        """‖h_0 − h_k‖ of the pattern at slot 0 and at all others, shape (N − 1,)."""
        overlaps = self.projections(self.pattern)[1:]
        return np.asarray(np.sqrt(np.maximum(2.0 * (self.energy - overlaps), 0.0)), dtype=float)

    def hit_rate_bounds(self, deviation: float, amount: float = 1.0) -> tuple[float, float]:
        """Probability that the right slot is found, between two bounds; they meet where noise is low.

        Parameters
        ----------
        deviation : float
            σ of each sample.
        amount : float
            a.
        """
        deviation, amount = positive("deviation", deviation), positive("amount", amount)
        errors = norm.sf(amount * self.distances / (2.0 * deviation))
        return float(max(0.0, 1.0 - errors.sum())), float(1.0 - errors.max())

    def amount_deviation(self, deviation: float) -> float:
        """Return the standard deviation σ/‖h‖ of the estimate of a where the slot is known: the Cramér–Rao bound."""
        return positive("deviation", deviation) / float(np.sqrt(self.energy))


def without_common(signals: ArrayLike) -> FloatArray:
    """Take off what all slots of signals (..., N, S) have in common: all harmonics of the slot."""
    values = finite_array("signals", signals)
    return np.asarray(values - values.mean(axis=-2, keepdims=True), dtype=float)


def share_interval(hits: int, trials: int, confidence: float = 0.95) -> tuple[float, float]:
    """Interval of a probability from a number of hits (Wilson).

    Parameters
    ----------
    hits, trials : int
        0 to `trials`, and 1 or more.
    confidence : float
        From 0.5 to 0.9999.

    Raises
    ------
    TypeError, ValueError
        Naming the argument and what would be valid.
    """
    trials = integer_at_least("trials", trials, 1)
    level = within("confidence", confidence, 0.5, 0.9999)
    interval = binomtest(integer_within("hits", hits, 0, trials), trials).proportion_ci(level, "wilson")
    return float(interval.low), float(interval.high)
