"""What grows, how and where, in words: a tongue, and the worst of values in tolerances."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from facegear.drives.findings import TORSION
from facegear.drives.intervals import Intervals, cut, gaps, in_rpm, inward
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
    >>> mechanism(Tongue(20.0, 30.0, float(rad_per_s(250.0)), 2.5, Combination(0, 0, "mean", 0)))
    'divergence of the mean system, mean 0 at 250 rpm, growing by 2.5 1/s'
    """
    named = tongue.combination
    by_itself = "flutter of the mean system," if named.k > 0 else "divergence of the mean system,"
    kind = "parametric resonance" if named.order > 0 else by_itself
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
    found = []
    for force, case in worst.items():
        parts = {**_parts(force, given), "speed": given.speed}
        ranges = ", ".join(f"{name} ±{100 * part:g} %" for name, part in parts.items() if part)
        found.append(f"With {ranges}, {force}: {_outcome(case)}.")
    return tuple(found)


def turning(force: str, case: WorstCase, given: Tolerances, speeds: tuple[float, float]) -> str:
    """Say which tolerances make a drive unstable that is stable without them, or may do so.

    Parameters
    ----------
    force : str
        Direction of the force, or "torsion".
    case : WorstCase
    given : Tolerances
    speeds : tuple of float
        Operating range [rad/s].

    Returns
    -------
    str
        That of speed only if it takes speeds beyond the operating ones.
    """
    names = [name for name, part in _parts(force, given).items() if part]
    beyond = not cut(case.possible, speeds)
    if beyond and any(case.points.get((1.0,) * len(case.factors), ())):
        return SPEED_TURNS
    names += ["speed"] * (beyond and given.speed > 0.0)
    one = len(names) == 1
    if not case.swept:
        return (
            f"whether anything in the {'tolerance' if one else 'tolerances'} of {listed(names)} is unstable, which is "
            "not known"
        )
    return f"where in {'its tolerance' if one else 'their tolerances'} {listed(names)} {'lies' if one else 'lie'}"


SPEED_TURNS = "speeds beyond the operating ones, in their tolerance"
"""What decides where a drive is stable at the operating speeds, and not just beyond them."""


def listed(words: Sequence[str]) -> str:
    """List words with "and" before the last; "the values taken" if there are none."""
    *others, last = words or ("the values taken",)
    return f"{', '.join(others)} and {last}" if others else last


def _parts(force: str, given: Tolerances) -> dict[str, float]:
    """Tolerances of stiffness and damping in the words of the disk's motion, or of torsion."""
    if force != TORSION:
        return {"stiffness": given.stiffness, "damping": given.damping}
    teeth = {"stiffness of teeth": given.stiffness, "damping of teeth": given.damping}
    return teeth | {"stiffness of shafts": given.shaft_stiffness, "damping of shafts": given.shaft_damping}


def _outcome(case: WorstCase) -> str:
    if case.unknown:
        return f"not known ({case.unknown})"
    looked = f"the {len(case.points)} values looked at"
    if case.is_stable:
        return f"stable at {looked}, and between them as far as the search under Tolerances tells"
    left = tuple(part for gap in gaps(case.swept, case.speeds) for part in cut(case.possible, gap))
    free = gaps(case.possible, case.speeds)
    rest = f"; not known at {told(left)}, where something may be unstable between {looked}" if left else ""
    rest += (
        f"; stable at {told(inward(free))}"
        if free
        else "; at no speed known to be stable for all of its values"
    )
    if not case.swept:
        return rest.removeprefix("; ")
    words = f"unstable for some values at {told(case.swept)}, {100 * case.share:.3g} % of the speeds"
    if case.fastest is None:
        return f"{words}; between {looked}, so that it is not known how fast{rest}"
    factors, tongue = case.fastest
    return f"{words}; fastest of {looked}: {mechanism(tongue)}, {corner(factors, case.factors)}{rest}"
