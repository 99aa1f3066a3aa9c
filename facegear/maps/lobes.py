"""Tips of lobes of instability in the chart of speed and thickness, the heart of the design of section 4.7.

Tips are sharp, so they are not looked for on a grid: :func:`facegear.maps.tracing.tongues` finds every tongue at a few
thicknesses, from above, and each is then followed to the thickness at which its largest growth rate vanishes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from facegear.floquet.labels import combination
from facegear.floquet.models import Model
from facegear.floquet.multipliers import growth_rate
from facegear.maps.peaks import Peak, critical_value, growth_peak
from facegear.maps.tracing import Tongue, tongues
from facegear.support.parameters import ascending, finite_array, within

# Thicknesses at which all tongues are looked for, each so many times the one above.
_LEVEL = 0.93
# Tongues of the levels are looked for above this part of the highest speed, where they are cheap to find; the
# whole range is searched just above the tip that they lead to.
_FAST_PART = 1 / 3
# Thickness steps in which the peak of a tongue is followed, relative, and window in which it is looked for.
_STEP = 0.01
_WINDOWS = {"window": 0.004, "widest": 0.004, "resolution": 2e-6}
# Speeds at which the growth of flutter is sampled as the thickness changes.
_FLUTTER_SAMPLES = 15


class UnstableTopError(ValueError):
    """A model is still unstable at the top of the range of thickness.

    Attributes
    ----------
    tongue : Tongue
        Where.
    thickness_ratio : float
        h/a there.
    """

    def __init__(self, tongue: Tongue, thickness_ratio: float) -> None:
        super().__init__(
            f"thickness_range must end above all lobes: at h/a = {thickness_ratio:.6g} the model is unstable at "
            f"{tongue.peak:.6g} rad/s, {tongue.label}"
        )
        self.tongue = tongue
        self.thickness_ratio = thickness_ratio

    def __reduce__(self) -> tuple[type, tuple[Tongue, float]]:
        """Come out of another process as what it was made of, not from its message."""
        return type(self), (self.tongue, self.thickness_ratio)


class StableRangeError(ValueError):
    """A model is stable in the whole range of thickness.

    Attributes
    ----------
    thickness_ratio : float
        Lowest h/a that was tried.
    """

    def __init__(self, thickness_ratio: float, speeds: tuple[float, float]) -> None:
        super().__init__(
            f"thickness_range must reach down to an unstable lobe: down to h/a = {thickness_ratio:.6g} the model is "
            f"stable from {speeds[0]:.6g} to {speeds[1]:.6g} rad/s"
        )
        self.thickness_ratio = thickness_ratio
        self._speeds = speeds

    def __reduce__(self) -> tuple[type, tuple[float, tuple[float, float]]]:
        """Come out of another process as what it was made of, not from its message."""
        return type(self), (self.thickness_ratio, self._speeds)


@dataclass(frozen=True)
class Lobe:
    """Tip of a lobe of instability in the chart of speed and thickness.

    Attributes
    ----------
    thickness_ratio : float
        h/a of its highest point [-].
    speed : float
        Ω2 there [rad/s]; an end of the speed range where the lobe is cut off by it.
    label : str
        Modes and order, as :attr:`facegear.maps.tracing.Tongue.label`.
    """

    thickness_ratio: float
    speed: float
    label: str


@dataclass(frozen=True)
class CriticalThickness:
    """Smallest thickness ratio above which a drive is stable in the whole speed range.

    Attributes
    ----------
    lobes : tuple of Lobe
        Lobes whose tips were traced, the deciding one first. Lobes far below it are not among them.
    """

    lobes: tuple[Lobe, ...]

    @property
    def lobe(self) -> Lobe:
        """Lobe that decides."""
        return self.lobes[0]

    @property
    def thickness_ratio(self) -> float:
        """Critical thickness ratio h/a [-]."""
        return self.lobe.thickness_ratio


def highest_lobes(
    model_at: Callable[[float], Model],
    lowest_speed: float,
    highest_speeds: Sequence[float],
    thickness_range: tuple[float, float],
    tolerance: float = 1e-5,
) -> tuple[CriticalThickness, ...]:
    """Tips of the highest lobes of any model that depends on a thickness ratio, for nested ranges of speed.

    From the top of the range downwards, all tongues are found at thicknesses 7 % apart until there are some. Each is
    followed upwards to its tip. Just above the highest tip all tongues are looked for once more, and followed if
    there are any, until there are none. What can be missed is a lobe that opens and closes between two of the
    levels above the result. A narrower range of speed begins where the wider one ended: above its result it is
    stable, too.

    Parameters
    ----------
    model_at : callable
        Thickness ratio to model.
    lowest_speed : float
        Lowest speed of all ranges [rad/s].
    highest_speeds : sequence of float
        Upper ends of the ranges [rad/s].
    thickness_range : tuple of float
        Lowest and highest thickness ratio.
    tolerance : float
        Accuracy of the tips in h/a, 1e-7 to 1e-3.

    Returns
    -------
    tuple of CriticalThickness
        One for each of `highest_speeds`, in their order.

    Raises
    ------
    TypeError, ValueError
        If a range is not two ascending positive numbers, the model is unstable at the top of the thickness range, or
        stable in all of it.
    """
    wanted = finite_array("highest_speeds", highest_speeds, "rad/s")
    if wanted.ndim != 1 or wanted.size == 0:
        raise ValueError(f"highest_speeds must list at least one speed in rad/s, got {highest_speeds!r}")
    for highest in wanted.tolist():
        lowest_speed, _ = ascending("speeds", (lowest_speed, highest), "rad/s")
    thinnest, thickest = ascending("thickness_range", thickness_range)
    tolerance = within("tolerance", tolerance, 1e-7, 1e-3)
    traced: list[Lobe] = []
    stable = math.inf
    results: dict[float, CriticalThickness] = {}
    for highest in sorted(set(wanted.tolist()), reverse=True):
        search = _Search(model_at, (lowest_speed, highest), (thinnest, thickest), tolerance)
        if stable == math.inf:
            search.refuse_unstable_top()
            stable = thickest
        # Tips strictly inside a narrower range are those of the wider one.
        inside = tuple(lobe for lobe in traced if lobe.speed < highest)
        if not (inside and inside[0].thickness_ratio >= stable - tolerance):
            inside = search.lobes_below(stable, inside)
        results[highest] = CriticalThickness(inside)
        traced, stable = list(inside), inside[0].thickness_ratio + tolerance
    return tuple(results[highest] for highest in wanted.tolist())


@dataclass(frozen=True)
class _Search:
    """Model, and where its lobes are looked for."""

    model_at: Callable[[float], Model]
    speeds: tuple[float, float]
    thickness_range: tuple[float, float]
    tolerance: float

    @property
    def fast_range(self) -> tuple[float, float]:
        lowest, highest = self.speeds
        return max(lowest, _FAST_PART * highest), highest

    def tongues_at(self, thickness_ratio: float, speeds: tuple[float, float]) -> tuple[Tongue, ...]:
        return tongues(self.model_at(thickness_ratio), speeds)

    def refuse_unstable_top(self) -> None:
        thickest = self.thickness_range[1]
        if found := self.tongues_at(thickest, self.fast_range):
            raise UnstableTopError(found[0], thickest)

    def lobes_below(self, stable: float, known: Sequence[Lobe]) -> tuple[Lobe, ...]:
        """Lobes below a thickness that is stable, the highest first; `known` are tips that have been traced."""
        thinnest = self.thickness_range[0]
        lobes, level = list(known), stable
        found: tuple[Tongue, ...] = ()
        if lobes:
            level = max(lobe.thickness_ratio for lobe in lobes) + self.tolerance
            found = self.tongues_at(level, self.speeds)
        else:
            while not found and level > thinnest:
                level = max(_LEVEL * level, thinnest)
                found = self.tongues_at(level, self.fast_range)
            # Without any in the fast part, slow lobes may still reach the bottom of the range.
            found = found or self.tongues_at(level, self.speeds)
        while found:
            lobes += [self.tip(level, tongue) for tongue in found]
            level = max(lobe.thickness_ratio for lobe in lobes) + self.tolerance
            found = self.tongues_at(level, self.speeds)
        if not lobes:
            lowest, highest = self.speeds
            raise StableRangeError(thinnest, (lowest, highest))
        return tuple(sorted(lobes, key=lambda lobe: -lobe.thickness_ratio))

    def tip(self, level: float, tongue: Tongue) -> Lobe:
        """Follow a tongue upwards to the thickness at which its largest growth rate vanishes."""
        flutter = tongue.combination.kind == "mean"
        peak = self.broad_peak(tongue) if flutter else self.sharp_peak(level, tongue)
        # A sharp peak is close to its tip as often as not.
        first, further = (_STEP, 2 * _STEP) if flutter else (0.1 * _STEP, _STEP)
        low, high, top = level, level * (1 + first), self.thickness_range[1]
        while peak(high)[1] > 0.0:
            if high >= top:
                raise UnstableTopError(tongue, high)
            low, high = high, high * (1 + further)
            if flutter:  # whose growth falls slowly: it must not be followed out of the range
                high = min(high, top)
        tip, speed = critical_value(peak, low, high, xtol=self.tolerance / 4)
        label = tongue.label if flutter else combination(self.model_at(tip).system(speed)).label
        return Lobe(tip, speed, label)

    def broad_peak(self, tongue: Tongue) -> Peak:
        """Peak of flutter, whose growth rate is not sharp over speed: samples of its speeds show the largest."""
        speeds = np.unique([*np.linspace(tongue.lower, tongue.upper, _FLUTTER_SAMPLES), tongue.peak]).tolist()

        def peak(thickness_ratio: float) -> tuple[float, float]:
            model = self.model_at(thickness_ratio)
            rates = [growth_rate(model.system(speed)) for speed in speeds]
            best = int(np.argmax(rates))
            return speeds[best], rates[best]

        return peak

    def sharp_peak(self, level: float, tongue: Tongue) -> Peak:
        """Peak of a resonance over speed, which is followed."""
        points = [(level, tongue.peak)]

        def peak(thickness_ratio: float) -> tuple[float, float]:
            (x0, y0), (x1, y1) = points[-2] if len(points) > 1 else points[0], points[-1]
            # Natural frequencies are nearly in proportion to thickness, until two points tell more.
            exponent = math.log(y1 / y0) / math.log(x1 / x0) if x1 != x0 else 1.0
            guess = y1 * (thickness_ratio / x1) ** min(max(exponent, 0.0), 2.0)
            speed, value = growth_peak(self.model_at(thickness_ratio), guess, self.speeds, **_WINDOWS)
            points.append((thickness_ratio, speed))
            return speed, value

        return peak
