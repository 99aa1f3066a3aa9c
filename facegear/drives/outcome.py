"""What one model of a drive comes to."""

from __future__ import annotations

import math
from dataclasses import dataclass

from facegear.drives.variants import Variant
from facegear.maps.tracing import Tongue


@dataclass(frozen=True)
class Outcome:
    """What a model of a drive comes to.

    Attributes
    ----------
    variant : Variant
        In the basis that was used.
    tongues : tuple of Tongue
    settled : bool
        Whether they stood still from the basis before to that one.
    growth_moved : float
        Part by which the largest growth rate differs in the basis before; NaN where it is not known.
    """

    variant: Variant
    tongues: tuple[Tongue, ...]
    settled: bool
    growth_moved: float = math.nan

    @property
    def is_stable(self) -> bool:
        """Whether it is stable at all speeds looked at."""
        return not self.tongues

    @property
    def growth_rate(self) -> float:
        """Largest growth rate [1/s], 0 where it is stable."""
        return max((tongue.growth_rate for tongue in self.tongues), default=0.0)
