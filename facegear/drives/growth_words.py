"""What grows, how and where, in words: a tongue, and the worst of values in tolerances."""

from __future__ import annotations

from collections.abc import Mapping

from facegear.drives.findings import TORSION
from facegear.drives.intervals import Intervals, cut, gaps, in_rpm
from facegear.drives.tolerances import Tolerances
from facegear.drives.worst_case import WorstCase
from facegear.maps.tracing import Tongue
from facegear.support.parameters import rpm

# Intervals of speed named one by one.
_NAMED = 4


def told(intervals: Intervals) -> str:
    """Intervals of speed [rad/s] in rpm, the widest of them; "no speed" where there is none."""
    return in_rpm(intervals, _NAMED) if intervals else "no speed"


def mechanism(tongue: Tongue) -> str:
    """Say what grows in a tongue, at which speed, and how fast.

    Examples
    --------
    >>> from facegear.floquet.labels import Combination
    >>> from facegear.support.parameters import rad_per_s
    >>> mechanism(Tongue(20.0, 30.0, float(rad_per_s(250.0)), 2.5, Combination(1, 8, "sum", 1)))
    'parametric resonance (1+8)/1 at 250 rpm, growing by 2.5 1/s'
    """
    kind = "parametric resonance" if tongue.combination.order > 0 else "flutter of the mean system,"
    return f"{kind} {tongue.label} at {rpm(tongue.peak):.4g} rpm, growing by {tongue.growth_rate:.3g} 1/s"


def corner(factors: tuple[float, ...], names: tuple[str, ...]) -> str:
    """Say where in the tolerances a corner is, by the factors that are not 1.

    Examples
    --------
    >>> corner((1.1, 1.0, 0.85), ("mesh stiffness", "mesh damping", "shaft stiffness"))
    'with mesh stiffness times 1.1, shaft stiffness times 0.85'
    >>> corner((1.0,), ("stiffness",))
    'with stiffness and damping of the file'
    """
    changed = [f"{name} times {f:.4g}" for name, f in zip(names, factors, strict=True) if f != 1.0]
    return f"with {', '.join(changed)}" if changed else "with stiffness and damping of the file"


def within_tolerances(worst: Mapping[str, WorstCase], given: Tolerances) -> tuple[str, ...]:
    """Say what tolerances make of a drive, a sentence for each direction of the force, and for torsion.

    Parameters
    ----------
    worst : mapping of str to WorstCase
        By the direction of the force, or "torsion".
    given : Tolerances
    """
    disk = {"stiffness": given.stiffness, "damping": given.damping, "speed": given.speed}
    torsion = {"stiffness of teeth": given.stiffness, "damping of teeth": given.damping}
    torsion |= {"stiffness of shafts": given.shaft_stiffness, "damping of shafts": given.shaft_damping}
    torsion |= {"speed": given.speed}
    found = []
    for force, case in worst.items():
        parts = torsion if force == TORSION else disk
        ranges = ", ".join(f"{name} ±{100 * part:g} %" for name, part in parts.items() if part)
        found.append(f"With {ranges}, {force}: {_outcome(case)}.")
    return tuple(found)


def _outcome(case: WorstCase) -> str:
    if case.unknown:
        return f"not known ({case.unknown})"
    if case.is_stable:
        return "stable at all values looked at"
    if case.opens:
        speeds = ", ".join(f"{rpm(each.speed):.4g}" for each in case.opens)
        return f"stable at all values looked at; tongues open between them at {speeds} rpm"
    left = tuple(part for gap in gaps(case.swept, case.speeds) for part in cut(case.possible, gap))
    rest = (
        f"not known at {told(left)}, where a tongue may come that stands at some of the values looked at only"
        if left
        else ""
    )
    if not case.swept:
        return f"{rest}; stable elsewhere at all values looked at"
    words = f"unstable for some values at {told(case.swept)}, {100 * case.share:.3g} % of the speeds"
    if case.fastest is None:
        words += "; between the values looked at, so that it is not known how fast"
    else:
        factors, tongue = case.fastest
        words += f"; fastest of the values looked at: {mechanism(tongue)}, {corner(factors, case.factors)}"
    return f"{words}; {rest}" if rest else words
