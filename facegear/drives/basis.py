"""How many modes a verdict needs: the basis of a disk is raised until its unstable speeds stand still.

A force at one point calls on all modes, and a basis as small as the printed one, M = 1 and N = 3, is too stiff there:
borders of tongues move by a percent or two with more modes, and narrow tongues come and go. What stands here holds a
drive fixed, bearings in N/m and not in parts of a stiffness that changes with the basis, and says how far it went.

A narrow range of speed has all of a tongue in it or nothing, and two bases that agree there say little: tongues are
looked for around it, as around any range without one, and one that might come in, or leave it, asks for a larger basis.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from facegear.drives.intervals import Intervals, cut, united
from facegear.floquet.labels import growth_and_combination
from facegear.floquet.models import Model
from facegear.floquet.multipliers import growth_rate
from facegear.maps.peaks import largest_between
from facegear.maps.tracing import Searched, Tongue, searched
from facegear.mechanics.disk import disk_stiffness, reference_stiffness
from facegear.mechanics.edge_stiffness import complete_harmonics
from facegear.mechanics.pinions_on_disk import FaceGears
from facegear.mechanics.plate import Body
from facegear.mechanics.radial_modes import MAX_NODAL_CIRCLES, MAX_NODAL_DIAMETERS
from facegear.support.parameters import integer_at_least
from facegear.support.parameters import within as checked_within
from facegear.support.types import FloatArray

# Ratio of the highest and the lowest speed looked at, at least.
_WIDE = 1.5
# Speeds at which growth is tried in a part of a tongue without its peak.
_TRIED = 17
# Part by which a wide range without a tongue is looked at beyond its ends.
_BESIDE = 1.1
# A border outside the range may come nearer by so many times what it moved from one basis to the next, and so may the
# largest growth rate come nearer to 0 where nothing is unstable.
_ONWARD = 2.0
# Rate of decay [1/s] that is none: rounding of a multiplier, over the shortest period.
_UNDAMPED = 1e-3
# Growth in a period from which a speed counts as unstable in a basis whose multipliers are known less well.
_ROUGH = 1e-7

GROWTH_MOVED = 0.1
"""Part by which the largest growth rate may differ from one basis to the next where all of a range is unstable."""


def with_basis(model: FaceGears, nodal_circles: int, nodal_diameters: int) -> FaceGears:
    """Return the same drive in another basis.

    Bearing stiffness and damping keep their values in N/m and N s/m: μ (4-17) is measured by a stiffness of the disk
    that falls as modes are added. Harmonics of the driving force stay complete if they were.

    Parameters
    ----------
    model : FaceGears
    nodal_circles, nodal_diameters : int
        M and N of the new basis.

    Returns
    -------
    FaceGears

    Raises
    ------
    TypeError, ValueError
        As :class:`facegear.mechanics.plate.Body` for M and N.

    Examples
    --------
    >>> from facegear import Body, Drive, MeshLoad, Transverse
    >>> body = Body(Drive(26, 130, 3.175e-3), thickness_ratio=0.03)
    >>> model = Transverse(body, MeshLoad(stiffness=1.0, damping=3e-6, mass=1.0))
    >>> richer = with_basis(model, 2, 5)
    >>> round(richer.bearing_stiffness / model.bearing_stiffness, 12), round(richer.load.stiffness, 2)
    (1.0, 1.04)
    """
    gear = model.gear
    body = replace(gear.body, nodal_circles=nodal_circles, nodal_diameters=nodal_diameters)
    load = replace(gear.load, stiffness=gear.bearing_stiffness / reference_stiffness(body))
    force = gear.force
    if force is not None and force.harmonics >= complete_harmonics(gear.body):
        force = replace(force, harmonics=max(force.harmonics, complete_harmonics(body)))
    return model.with_gear(replace(gear, body=body, load=load, force=force))


def _is_narrow(speeds: tuple[float, float]) -> bool:
    low, high = speeds
    return high / low < _WIDE


def found_around(model: Model, speeds: tuple[float, float]) -> Searched:
    """Search a range, and beside it where the range is narrow or no tongue is in it."""
    low, high = speeds
    if _is_narrow(speeds):
        further = math.sqrt(_WIDE * low / high)
        return looked_at(model, (low / further, high * further), hints=(low, high))
    if (found := looked_at(model, speeds)).tongues:
        return found
    below, above = (traced(model, ends) for ends in ((low / _BESIDE, low), (high, high * _BESIDE)))
    return replace(found, tongues=(*below, *above))


def looked_at(model: Model, speeds: tuple[float, float], hints: Sequence[float] = ()) -> Searched:
    """Search a range; in a basis so large that multipliers are known less well, for tongues that grow faster."""
    try:
        return searched(model, speeds, hints=hints, progress=False)
    except ArithmeticError:
        return searched(model, speeds, threshold=_ROUGH, hints=hints, progress=False)


def traced(model: Model, speeds: tuple[float, float]) -> tuple[Tongue, ...]:
    """Trace tongues in a range, as :func:`looked_at`."""
    return looked_at(model, speeds).tongues


def within(model: Model, found: Sequence[Tongue], speeds: tuple[float, float]) -> tuple[Tongue, ...]:
    """Cut tongues of a model to a range of speed, with the largest growth there."""
    low, high = speeds
    inside = []
    for tongue in found:
        lower, upper, peak = max(tongue.lower, low), min(tongue.upper, high), min(max(tongue.peak, low), high)
        if lower < upper:
            part = replace(tongue, lower=lower, upper=upper, peak=peak)
            # Tongues merge, and what is largest in a part of one may be another resonance than that of its peak.
            inside.append(part if peak == tongue.peak else _with_peak(model, part))
    return tuple(inside)


def _with_peak(model: Model, tongue: Tongue) -> Tongue:
    """Find where a tongue grows fastest, how fast, and by what."""

    def growth(speed: float) -> float:
        return growth_rate(model.system(speed))

    speeds = np.linspace(tongue.lower, tongue.upper, _TRIED)
    rates = [growth(speed) for speed in speeds.tolist()]
    best = int(np.argmax(rates))
    low, high = speeds[[max(best - 1, 0), min(best + 1, _TRIED - 1)]].tolist()
    peaks = [(rates[best], float(speeds[best])), largest_between(growth, low, high, 1e-6 * high)[::-1]]
    rate, peak = max(peaks)
    _, name = growth_and_combination(model.system(peak))
    return replace(tongue, peak=peak, growth_rate=rate, combination=name)


def unstable_share(found: Sequence[Tongue], speeds: tuple[float, float]) -> float:
    """Part of a range of speed that tongues cover, 0 to 1."""
    low, high = speeds
    return sum(tongue.width for tongue in found) / (high - low)


def growth_moved(before: Sequence[Tongue], found: Sequence[Tongue]) -> float:
    """Part by which the largest growth rate differs in tongues found before; NaN where one has none."""
    was, now = (max((tongue.growth_rate for tongue in each), default=math.nan) for each in (before, found))
    return abs(was / now - 1.0)


def disagreement(first: Sequence[Tongue], second: Sequence[Tongue], speeds: tuple[float, float]) -> float:
    """Part of a range of speed in which only one of two sets of tongues is unstable, 0 to 1.

    No border has moved by more than this part of the range.

    Parameters
    ----------
    first, second : sequence of Tongue
        Both from the whole range.
    speeds : tuple of float
        Lowest and highest speed [rad/s].
    """
    one, other = (united([(tongue.lower, tongue.upper) for tongue in found]) for found in (first, second))
    return _apart(one, other, speeds)


def _apart(first: Intervals, second: Intervals, speeds: tuple[float, float]) -> float:
    """Part of a range that lies in one of two sets of intervals, each ascending and apart, 0 to 1."""
    one, other = cut(first, speeds), cut(second, speeds)
    both = sum(max(0.0, min(a[1], b[1]) - max(a[0], b[0])) for a in one for b in other)
    each = sum(high - low for low, high in (*one, *other))
    return max(0.0, each - 2.0 * both) / (speeds[1] - speeds[0])


@dataclass(frozen=True)
class BasisStep:
    """Tongues of a drive in one basis.

    Attributes
    ----------
    nodal_circles, nodal_diameters : int
        M and N.
    tongues : tuple of Tongue
    moved : float
        Part of the range of speed in which this basis and the one before disagree; NaN for the first.
    reaches : bool
        Whether all modes of the disk up to the mesh frequency are in it, at all speeds.
    """

    nodal_circles: int
    nodal_diameters: int
    tongues: tuple[Tongue, ...]
    moved: float
    reaches: bool = True


@dataclass(frozen=True)
class SettledTongues:
    """Tongues of a drive in the last of several bases.

    Attributes
    ----------
    model : FaceGears
        The drive in that basis.
    speeds : tuple of float
        Lowest and highest speed [rad/s].
    steps : tuple of BasisStep
        All bases, ascending.
    settled : bool
        Whether the last two agree on whether there is a tongue, and within the tolerance on where, and the last has
        all modes up to the mesh frequency.
    """

    model: FaceGears
    speeds: tuple[float, float]
    steps: tuple[BasisStep, ...]
    settled: bool

    @property
    def tongues(self) -> tuple[Tongue, ...]:
        """Tongues in the last basis."""
        return self.steps[-1].tongues

    @property
    def sufficient(self) -> BasisStep:
        """Smaller of the last two where they have settled and it reaches, or the last."""
        smaller = self.steps[-2:][0]
        return smaller if self.settled and smaller.reaches else self.steps[-1]

    @property
    def unstable_share(self) -> float:
        """Part of the range of speed that is unstable, 0 to 1."""
        return unstable_share(self.tongues, self.speeds)

    @property
    def growth_moved(self) -> float:
        """Part by which the largest growth rate differs in the basis before; NaN where it is not known."""
        *_, before, last = ((), *(step.tongues for step in self.steps))
        return growth_moved(before, last)

    @property
    def may_open(self) -> bool:
        """Whether all of a narrow range is unstable, by a growth that still moves: a gap may open in a tongue."""
        return (
            _is_narrow(self.speeds) and self.unstable_share == 1.0 and not self.growth_moved <= GROWTH_MOVED
        )


def settled_tongues(
    model: FaceGears,
    speeds: tuple[float, float],
    known: Searched | None = None,
    *,
    around: tuple[float, float] | None = None,
    tolerance: float = 0.02,
    most_steps: int = 5,
) -> SettledTongues:
    """Tongues of a drive in a basis that is raised until they stand still.

    In a narrow range they must do so twice in succession, and where all of it is unstable the largest growth rate must
    have settled as well, to a tenth. Two bases that lack the modes which the mesh could excite agree on nothing: only
    one that has all modes up to the mesh frequency at the highest speed can be the last. Two nodal diameters are added
    in each step, or as many as that takes, and a nodal circle where it takes one, or where that changes the static
    stiffness of the disk at its teeth by a third or more of what they do; the bearing stays as it is
    (:func:`with_basis`).

    Parameters
    ----------
    model : FaceGears
        Drive in the first basis.
    speeds : tuple of float
        Lowest and highest speed [rad/s].
    known : Searched, optional
        What :func:`found_around` has found in the first basis, where it has been asked already.
    around : tuple of float, optional
        Range in which they must stand still [rad/s], which has the other in it; that itself, if left out.
    tolerance : float
        Part of that range in which two bases in succession may disagree, 1e-6 to 0.5, and may still if borders outside
        of it come nearer by twice as much as they have moved. They must also agree on whether there is any tongue, and
        where there is none what decays most slowly must still decay if its rate moves on by twice what it has moved.
    most_steps : int
        Largest number of bases, at least 1; with one only, nothing is said of how good it is.

    Returns
    -------
    SettledTongues
        `settled` is false if the number of bases, or the largest basis there is, did not suffice.

    Raises
    ------
    TypeError, ValueError, ArithmeticError
        As :func:`facegear.maps.tracing.tongues`, or if an argument is outside its range.
    """
    tolerance = checked_within("tolerance", tolerance, 1e-6, 0.5)
    integer_at_least("most_steps", most_steps, 1)
    judged = speeds if around is None else around
    steps: list[BasisStep] = []
    before: Searched | None = None
    shown, still = model, 0
    for circles, diameters in _bases(model.gear.body, most_steps, judged[1]):
        shown = with_basis(model, circles, diameters) if steps else model
        found = known if known is not None and not steps else found_around(shown, judged)
        here = within(shown, found.tongues, speeds)
        moved = disagreement(steps[-1].tongues, here, speeds) if steps else math.nan
        reaches = min(_lowest_left_out(model.gear.body, circles, diameters, judged[1])) >= 1.0
        steps.append(BasisStep(circles, diameters, here, moved, reaches))
        still = (
            still + 1
            if before is not None
            and _stands_still(before.tongues, found.tongues, judged, tolerance)
            and not may_grow(before, found, judged)
            else 0
        )
        settled = SettledTongues(shown, speeds, tuple(steps), settled=True)
        if reaches and still >= (2 if _is_narrow(judged) else 1) and not settled.may_open:
            return settled
        before = found
    return SettledTongues(shown, speeds, tuple(steps), settled=False)


def _stands_still(
    before: Sequence[Tongue], found: Sequence[Tongue], speeds: tuple[float, float], tolerance: float
) -> bool:
    """Whether two bases agree in a range, and would if borders outside of it moved on."""
    if _without_partner(before, found, speeds) or _without_partner(found, before, speeds):
        return False
    one, other = (united([(tongue.lower, tongue.upper) for tongue in each]) for each in (before, found))
    return all(
        _apart(each, other, speeds) <= tolerance and bool(cut(each, speeds)) == bool(cut(other, speeds))
        for each in (one, *_moved_on(before, found, speeds))
    )


def may_grow(before: Searched, found: Searched, speeds: tuple[float, float]) -> bool:
    """Tell whether in a range without tongues something would grow if what decays most slowly moved on as it has.

    Without damping nothing decays, and whatever could open has.
    """
    low, high = speeds
    if any(tongue.lower < high and low < tongue.upper for tongue in found.tongues):
        return False
    was, now = (each.fastest_between(low, high) for each in (before, found))
    return min(was, now) < -_UNDAMPED and now + _ONWARD * abs(now - was) > 0.0


def _overlap(one: Tongue, other: Tongue) -> bool:
    return one.lower < other.upper and other.lower < one.upper


def _without_partner(found: Sequence[Tongue], others: Sequence[Tongue], speeds: tuple[float, float]) -> bool:
    """Whether a tongue as near to a range as twice its width overlaps none of others: it has come or gone whole."""
    low, high = speeds
    return any(
        0.0 < max(tongue.lower - high, low - tongue.upper) < _ONWARD * tongue.width
        and not any(_overlap(tongue, other) for other in others)
        for tongue in found
    )


def _before(tongue: Tongue, before: Sequence[Tongue], found: Sequence[Tongue]) -> tuple[float, float]:
    """Borders of a tongue in a basis before: of one that it overlaps, or the nearest that none overlaps, or its own."""
    free = [other for other in before if not any(_overlap(each, other) for each in found)]
    others = [other for other in before if _overlap(tongue, other)] or free or [tongue]
    was = min(others, key=lambda other: abs(other.lower - tongue.lower) + abs(other.upper - tongue.upper))
    return was.lower, was.upper


def _moved_on(
    before: Sequence[Tongue], found: Sequence[Tongue], speeds: tuple[float, float]
) -> tuple[Intervals, Intervals]:
    """Tongues whose borders outside of a range have come nearer, each by twice what it moved since a basis before.

    Those that lie beside the range alone, and those alone that reach into it, which uncover it so.
    """
    low, high = speeds
    coming, going = [], []
    for tongue in found:
        lower, upper = ends = (tongue.lower, tongue.upper)
        was = _before(tongue, before, found)
        up, down = (_ONWARD * abs(end - old) for end, old in zip(ends, was, strict=True))
        if lower > high or upper < low:
            coming.append((lower - up, upper) if lower > high else (lower, upper + down))
            going.append(ends)
        else:
            coming.append(ends)
            lower, upper = (lower + up if lower < low else lower), (upper - down if upper > high else upper)
            going += [(lower, upper)] if lower < upper else []
    return united(coming), united(going)


def _bases(body: Body, most: int, speed: float) -> list[tuple[int, int]]:
    """Give M and N of at most so many bases, up to the largest there is; from the second on they reach, if any does."""
    found = [(body.nodal_circles, body.nodal_diameters)]
    while len(found) < most:
        circles, diameters = found[-1]
        more_circles = min(circles + 1, MAX_NODAL_CIRCLES)
        more_diameters = min(diameters + 2, MAX_NODAL_DIAMETERS)
        here = _softness(body, circles, diameters)
        by_circles = np.abs(_softness(body, more_circles, diameters) / here - 1.0).max()
        by_diameters = np.abs(_softness(body, circles, more_diameters) / here - 1.0).max()
        larger = (more_circles if by_circles >= by_diameters / 3.0 else circles, more_diameters)
        if (larger := _reaching(body, *larger, speed)) == found[-1]:
            break
        found.append(larger)
    return found


def _reaching(body: Body, circles: int, diameters: int, speed: float) -> tuple[int, int]:
    """Give the smallest basis from one on that has all modes up to the mesh frequency, as far as there are any."""
    while circles < MAX_NODAL_CIRCLES and _lowest_left_out(body, circles, diameters, speed)[0] < 1.0:
        circles += 1
    while diameters < MAX_NODAL_DIAMETERS and _lowest_left_out(body, circles, diameters, speed)[1] < 1.0:
        diameters += 1
    return circles, diameters


def _lowest_left_out(body: Body, circles: int, diameters: int, speed: float) -> tuple[float, float]:
    """Lowest frequencies that a basis leaves out, with more circles and with more diameters, over the mesh frequency.

    Of the wave that runs against the gear's turning, as the mesh meets it. Of the largest basis there is, those of its
    last circle and diameter, which are lower.
    """
    more = (min(circles + 1, MAX_NODAL_CIRCLES), min(diameters + 1, MAX_NODAL_DIAMETERS))
    frequencies = np.sqrt(replace(body, nodal_circles=more[0], nodal_diameters=more[1]).eigenvalues)
    met = (frequencies - speed * np.arange(more[1] + 1)) / (body.drive.gear_teeth * speed)
    return float(met[-1].min()), float(met[:, -1].min())


def _softness(body: Body, nodal_circles: int, nodal_diameters: int) -> FloatArray:
    """Deflection per force of a disk at rest, at the inner, middle and outer radius of the teeth [m/N]."""
    basis = replace(body, nodal_circles=nodal_circles, nodal_diameters=nodal_diameters)
    inner, outer = body.drive.inner_radius, body.drive.outer_radius
    return np.array([1.0 / float(disk_stiffness(basis, 0.0, r)) for r in (inner, (inner + outer) / 2, outer)])
