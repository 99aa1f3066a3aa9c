"""How many modes the shafts of a gearbox need that have mass, each a number of its own, and whether it suffices.

A shaft held at both ends moves in sines besides the straight lines of its ends. Those left out act as springs that are
too stiff, by parts of x⁴ Σ 1/(jπ)⁴ of them, x half waves times π along the shaft at a frequency: the error falls with
the third power of their number once the first of them lies well above what moves. Tongues come from harmonics of the
mesh and from sums of natural frequencies, and what lies well above is found by trying it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from facegear.drives.basis import (
    GROWTH_MOVED,
    disagreement,
    growth_moved,
    looked_at,
    may_grow,
    traced,
    unstable_share,
    within,
)
from facegear.maps.tracing import Searched, Tongue
from facegear.mechanics.heavy_shafts import HeavyShafts
from facegear.mechanics.rods import MOST_MODES, shear_wave_speed
from facegear.support.types import FloatArray

# With modes up to so many times the mesh frequency growth rates above 1 1/s were right to 4 %, of shafts of 1 to 3 m,
# and borders to 0.2 % of themselves; with twice as many of them to 0.5 % and to 0.02 %.
_REACH = 4
# Half waves along a shaft at the mesh frequency below which one mode is enough: the next is 32 times as fast.
_SHORT = 1.0 / 16.0
# Most numbers of modes that are tried, the first of them half of what a gearbox has.
_MOST_STEPS = 4
# Part by which tongues are looked for beyond a range, to see what may come in.
_BESIDE = 1.05
# Rounding of a share of the speeds.
_ALL = 1.0 - 1e-9
# Part by which a natural frequency may be wrong that is told: three digits of it are right. And most digits told.
_KNOWN, _MOST_DIGITS = 5e-4, 5


def with_enough_modes(model: HeavyShafts, fastest: float) -> HeavyShafts:
    """Give each shaft the modes that the mesh asks for, or the most there are.

    Parameters
    ----------
    model : HeavyShafts
    fastest : float
        Highest speed of the face gear [rad/s].

    Returns
    -------
    HeavyShafts
        Half of the modes reach up to four times the mesh frequency, and there is one at least; of short shafts one.

    Examples
    --------
    >>> from facegear.mechanics.gearboxes import FIGURES
    >>> box = HeavyShafts(FIGURES["7.13a"].model(), input_length=0.1, output_length=1.5)
    >>> with_enough_modes(box, fastest=110.0).modes
    (2, 14)
    """
    first, second = (min(asked, MOST_MODES) for asked in _asked(model, fastest))
    return replace(model, modes=(first, second))


def _asked(model: HeavyShafts, fastest: float) -> tuple[int, int]:
    """Modes that shafts need, be there so many or not; 0 of a massless one."""
    # Half waves of a shaft at the mesh frequency.
    per_length = model.torsional.drive.gear_teeth * fastest / (math.pi * shear_wave_speed(model.material))
    first, second = (
        _asked_by(per_length * length) if length else 0
        for length in (model.input_length, model.output_length)
    )
    return first, second


def _asked_by(half_waves: float) -> int:
    """Modes that a shaft needs, from the number of half waves along it at the mesh frequency."""
    # Modes of short shafts are stiff, and what is left out behind the first of them is next to nothing.
    return 1 if half_waves < _SHORT else 2 * max(1, math.ceil(_REACH * half_waves) - 1)


def modes_of(torsional: Any) -> tuple[int, int]:
    """Modes of input and output shaft; 0 of a massless one."""
    first, second = getattr(torsional, "modes_of_each", (0, 0))
    return first, second


@dataclass(frozen=True)
class SettledTorsion:
    """Tongues of a gearbox, and whether more modes of its shafts leave them where they are.

    Attributes
    ----------
    model : Torsional or HeavyShafts
        With as many modes as the last that were tried.
    speeds : tuple of float
        Lowest and highest speed [rad/s].
    tongues : tuple of Tongue
    settled : bool
        Whether half the modes come to the same; a gearbox with massless shafts has none.
    moved : float
        Part of the range in which half the modes come to something else; NaN where there are none.
    growth_moved : float
        Part by which the largest growth rate differs with half the modes; NaN where it is not known.
    """

    model: Any
    speeds: tuple[float, float]
    tongues: tuple[Tongue, ...]
    settled: bool
    moved: float = math.nan
    growth_moved: float = math.nan

    @property
    def modes(self) -> str:
        """Modes of the shafts in words; empty if they are massless."""
        counts = zip(("input", "output"), modes_of(self.model), strict=True)
        return ", ".join(f"{counted(count, 'mode')} of the {shaft} shaft" for shaft, count in counts if count)

    @property
    def basis(self) -> str:
        """Modes of the shafts, and what half of them come to, in a sentence; empty if they are massless."""
        if not self.modes:
            return ""
        half = "half as many could not be compared"
        if not math.isnan(self.moved):
            half = f"half as many differ at {100 * self.moved:.2g} % of the speeds"
        return f"Shafts in torsion: {self.modes}; {half}{'' if self.settled else ', NOT SETTLED'}."


def counted(number: int, what: str) -> str:
    """Write a number of things that take an s."""
    return f"{number} {what}{'' if number == 1 else 's'}"


def settled_torsion(torsional: Any, speeds: tuple[float, float], tolerance: float = 0.02) -> SettledTorsion:
    """Tongues of a gearbox whose shafts have modes enough.

    Half of the modes that it has must come to the same, or they are doubled, up to four times.

    Parameters
    ----------
    torsional : Torsional or HeavyShafts
        From :func:`with_enough_modes`.
    speeds : tuple of float
        Lowest and highest speed [rad/s].
    tolerance : float
        Part of the range in which half the modes may come to something else. They must also agree on whether there is
        any tongue, none beside the range may have come nearer by more than is left between, and where all of the range
        is unstable the largest growth rate must agree to a tenth. Where none of it is, what decays most slowly must
        still decay if its rate moves on by twice what it has moved.

    Returns
    -------
    SettledTorsion
        Not settled if the number of modes, or the largest there is, did not suffice.

    Raises
    ------
    TypeError, ValueError, ArithmeticError
        As :func:`facegear.maps.tracing.tongues`.
    """
    if not any(modes_of(torsional)):
        return SettledTorsion(torsional, speeds, traced(torsional, speeds), settled=True)
    asked = _asked(torsional, speeds[1])
    wider = speeds[0] / _BESIDE, speeds[1] * _BESIDE
    before: Searched | None = None
    last: SettledTorsion | None = None
    for modes in _tried(modes_of(torsional)):
        model = replace(torsional, modes=modes)
        try:
            around = looked_at(model, wider, hints=speeds)
            here = within(model, around.tongues, speeds)
        except ArithmeticError:
            # Of many modes of strong dampers multipliers are not known well enough.
            if last is None:
                raise
            return replace(last, settled=False)
        if before is None or last is None:
            last = SettledTorsion(model, speeds, here, settled=False)
        else:
            moved, faster = disagreement(last.tongues, here, speeds), growth_moved(last.tongues, here)
            agree = (
                moved <= tolerance
                and bool(last.tongues) == bool(here)
                and not (unstable_share(here, speeds) >= _ALL and not faster <= GROWTH_MOVED)
                and not _comes_in(before.tongues, around.tongues, wider, speeds)
                and not may_grow(before, around, speeds)
            )
            covered = all(have >= need for have, need in zip(modes, asked, strict=True))
            last = SettledTorsion(model, speeds, here, agree and covered, moved, faster)
            if last.settled or (agree and not covered):
                return last
        before = around
    assert last is not None
    return last


def _tried(own: tuple[int, int]) -> list[tuple[int, int]]:
    """Numbers of modes, ascending: half of those that there are, these, and so many times as many."""
    first, second = own
    tried = [((first + 1) // 2, (second + 1) // 2), own]
    while len(tried) < _MOST_STEPS:
        first, second = (min(2 * number, MOST_MODES) for number in tried[-1])
        tried.append((first, second))
    return list(dict.fromkeys(tried))


def _comes_in(
    before: Sequence[Tongue], found: Sequence[Tongue], wider: tuple[float, float], speeds: tuple[float, float]
) -> bool:
    """Whether a tongue beside a range has come nearer by more than is left between."""
    was, now = (_gaps(each, wider, speeds) for each in (before, found))
    return any(new < old - new for old, new in zip(was, now, strict=True))


def _gaps(
    found: Sequence[Tongue], wider: tuple[float, float], speeds: tuple[float, float]
) -> tuple[float, float]:
    """From a range to what is unstable below it and above it, as far as that was looked for; 0 if that reaches in."""
    (low, high), (lowest, highest) = speeds, wider
    below = max((tongue.upper for tongue in found if tongue.lower < low), default=lowest)
    above = min((tongue.lower for tongue in found if tongue.upper > high), default=highest)
    return max(low - below, 0.0), max(above - high, 0.0)


def natural_frequencies(torsional: Any) -> tuple[FloatArray, FloatArray]:
    """Natural frequencies of a gearbox at rest that its shafts have modes enough for, and what they are with all modes.

    Parameters
    ----------
    torsional : Torsional or HeavyShafts

    Returns
    -------
    tuple of ndarray
        Ascending [rad/s], up to the first of which fewer than three digits are known; twice the same where shafts are
        massless.
    """
    own: FloatArray = torsional.natural_frequencies()
    if not any(modes_of(torsional)):
        return own, own
    true: FloatArray = torsional.exact_frequencies(own.size)
    known = int(np.append(np.abs(own / true - 1.0) <= _KNOWN, False).argmin())
    return own[:known], true[:known]


def confirmed(value: float, true: float) -> float:
    """Round a value to as many digits, at most five, as it has right.

    Examples
    --------
    >>> confirmed(1741.95, 1741.83), confirmed(1741.95, 1741.95)
    (1742.0, 1741.95)
    """
    error = abs(value - true)
    if error == 0.0:
        return value
    place = max(math.ceil(math.log10(2.0 * error)), math.floor(math.log10(value)) - _MOST_DIGITS + 1)
    return round(value, -place)
