"""A verdict to stake a gearbox on: a drive under every model that could change the answer.

The report on a drive (:mod:`facegear.drives.verdict`) computes what its file says. What a file cannot know is varied
here (:mod:`facegear.drives.variants`), each model in a basis in which its unstable speeds stand still, and values are
taken anywhere in their tolerances (:mod:`facegear.drives.tolerances`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from facegear.design.changes import effects_of_changes
from facegear.drives.basis import SettledTongues, settled_tongues, unstable_share, with_basis
from facegear.drives.contacts import massless, torsional_under
from facegear.drives.drive_file import DriveFile
from facegear.drives.findings import TORSION, best_change
from facegear.drives.intervals import Intervals, gaps, in_rpm, united
from facegear.drives.report_arrays import describe
from facegear.drives.tolerances import (
    Tolerances,
    WorstCase,
    not_known,
    worst_case,
    worst_case_in_torsion,
)
from facegear.drives.variants import (
    Variant,
    other_teeth,
    own_teeth,
    plain_contacts,
    with_own_teeth,
)
from facegear.drives.verdict import FORCES, driven
from facegear.floquet.models import Excited
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.maps.parallel import each_in_processes, in_processes
from facegear.maps.response_map import frequency_response
from facegear.maps.tracing import Tongue, tongues
from facegear.mechanics.contact import Contact
from facegear.mechanics.transverse import FaceGears
from facegear.support.labelled import text, variable
from facegear.support.parameters import number_of_workers, rpm

SAFE, UNSTABLE, DEPENDS = "safe under all", "unstable under all", "depends"
"""What an assessment may come to."""

# What two models may differ in, as a sentence has it.
_EFFECTS = {"contact": "the contact", "force": "the direction of the driving force", "teeth": "the teeth"}
_ARMS = {"printed": "arm as printed", "conjugate": "arm of conjugate teeth"}
# Bases tried for other teeth than the file's, the first of them one in which those stand still.
_MORE_BASES = 3
# Speeds of the forced response in torsion, and intervals of speed named one by one.
_RESPONSE_SPEEDS, _NAMED = 91, 4


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
    """

    variant: Variant
    tongues: tuple[Tongue, ...]
    settled: bool

    @property
    def is_stable(self) -> bool:
        """Whether it is stable at all speeds looked at."""
        return not self.tongues

    @property
    def growth_rate(self) -> float:
        """Largest growth rate [1/s], 0 where it is stable."""
        return max((tongue.growth_rate for tongue in self.tongues), default=0.0)


@dataclass(frozen=True, eq=False)
class Assessment:
    """What is known of the stability of a drive.

    Attributes
    ----------
    file : DriveFile
    outcomes : tuple of Outcome
        The file's own contact and teeth first.
    torsion : dict of str to tuple of Tongue
        Tongues in torsion under each contact and each arm of the mesh force, the file's own first, over the range of
        speed with its tolerance; empty where the file has no gearbox.
    worst : dict of str to WorstCase
        Of the file's own contact and teeth, by the direction of the force, and of its gearbox in "torsion"; empty where
        the file has no tolerances.
    response : xarray.Dataset or None
        Steady response of the gearbox to the torque of one pinion's power
        (:func:`facegear.maps.response_map.frequency_response`), if there is one.
    change : str
        The change that helps the file's own model most, made in earnest; empty if there is none.
    left_out : tuple of str
        What could not be computed, and why.
    """

    file: DriveFile
    outcomes: tuple[Outcome, ...]
    torsion: dict[str, tuple[Tongue, ...]]
    worst: dict[str, WorstCase]
    response: xr.Dataset | None
    change: str
    left_out: tuple[str, ...]

    @property
    def speeds(self) -> tuple[float, float]:
        """Lowest and highest speed [rad/s]."""
        return self.file.requirements.speeds

    @property
    def verdict(self) -> str:
        """One of "safe under all", "unstable under all", "depends": models, and values in their tolerances."""
        disk = [outcome.is_stable for outcome in self.outcomes]
        torsion = [not found for found in self.torsion.values()] or [True]
        if all(disk) and all(torsion) and all(case.is_stable for case in self.worst.values()):
            return SAFE
        # A drive is stable where the disk and the gearbox are.
        return DEPENDS if any(disk) and any(torsion) else UNSTABLE

    @property
    def decides(self) -> tuple[str, ...]:
        """What turns the verdict, in words: effects in which alone a stable and an unstable model differ."""
        found = []
        for effect, words in _EFFECTS.items():
            rest = [name for name in _EFFECTS if name != effect]
            seen: dict[tuple[str, ...], set[bool]] = {}
            for outcome in self.outcomes:
                key = tuple(getattr(outcome.variant, name) for name in rest)
                seen.setdefault(key, set()).add(outcome.is_stable)
            if any(len(kinds) == 2 for kinds in seen.values()):
                found.append(words)
        nominal = {o.variant.force: o.is_stable for o in reversed(self.outcomes) if self._is_own(o)}
        if self.torsion:
            nominal[TORSION] = not next(iter(self.torsion.values()))
        if any(nominal.get(force) and not case.is_stable for force, case in self.worst.items()):
            found.append("where in their tolerances stiffness, damping and speed lie")
        if len({bool(tongues) for tongues in self.torsion.values()}) == 2:
            found.append("contact or arm of the mesh force in torsion")
        return tuple(found)

    def _is_own(self, outcome: Outcome) -> bool:
        first = self.outcomes[0].variant
        return (outcome.variant.contact, outcome.variant.teeth) == (first.contact, first.teeth)

    @cached_property
    def always_unstable(self) -> Intervals:
        """Intervals of speed [rad/s] in which all models of the disk's motion, or all of torsion, are unstable."""

        def in_all(family: Sequence[Sequence[Tongue]]) -> Intervals:
            stable = [gap for found in family for gap in gaps(_intervals(found), self.speeds)]
            return gaps(united(stable), self.speeds) if family else ()

        return united([*in_all([o.tongues for o in self.outcomes]), *in_all([*self.torsion.values()])])

    @cached_property
    def always_stable(self) -> Intervals:
        """Intervals of speed [rad/s] in which every model, torsion and every value looked at is stable."""
        every = [interval for o in self.outcomes for interval in _intervals(o.tongues)]
        every += [interval for case in self.worst.values() for interval in case.swept]
        # What opens between two corners has no width that is known.
        every += [(each.speed, each.speed) for case in self.worst.values() for each in case.opens]
        every += [interval for found in self.torsion.values() for interval in _intervals(found)]
        return gaps(united(every), self.speeds)

    @property
    def headline(self) -> str:
        """The verdict in a sentence or two, with what it was computed for."""
        low, high = (f"{rpm(speed):.4g}" for speed in self.speeds)
        count = len(self.outcomes)
        stable = sum(outcome.is_stable for outcome in self.outcomes)
        are = f"{stable} {'is' if stable == 1 else 'are'}"
        where = f"from {low} to {high} rpm, of {count} models of the disk's motion"
        if self.verdict == SAFE:
            words = f"Safe under all: {where} none is unstable at any speed."
        elif self.verdict == UNSTABLE and stable:
            words = f"Unstable under all, in torsion; {where} {are} stable at all speeds."
        elif self.verdict == UNSTABLE:
            words = f"Unstable under all: {where} each is unstable at some speeds."
        else:
            words = f"Depends on {_listed(self.decides)}: {where} {are} stable at all speeds."
        if self.torsion:
            still = sum(not found for found in self.torsion.values())
            words += (
                f" Of {len(self.torsion)} models of torsion {still} {'is' if still == 1 else 'are'} stable"
            )
            words += " in the range with its tolerance." if self.file.tolerances.speed else "."
        words += f" Stable under all of them: {_told(self.always_stable)}."
        words += f" Unstable under all of them: {_told(self.always_unstable)}."
        if self.verdict != SAFE:
            words += f" Worst: {self.mechanism}."
        open_cases = sum(not outcome.settled for outcome in self.outcomes)
        if open_cases:
            words += f" NOT SETTLED in {open_cases} of {count} models: a larger basis may turn them."
        return words

    @property
    def mechanism(self) -> str:
        """What grows fastest of all models, and how."""
        unstable = [(o.variant.name, tongue) for o in self.outcomes for tongue in o.tongues]
        unstable += [(f"torsion; {name}", t) for name, found in self.torsion.items() for t in found]
        if not unstable:
            return "nothing grows at the values of the file"
        name, strongest = max(unstable, key=lambda pair: pair[1].growth_rate)
        kind = "parametric resonance" if strongest.combination.order > 0 else "flutter of the mean system,"
        speed = f"{rpm(strongest.peak):.4g} rpm"
        return f"{kind} {strongest.label} at {speed}, growing by {strongest.growth_rate:.3g} 1/s ({name})"

    @property
    def over_tolerances(self) -> tuple[str, ...]:
        """What the tolerances of the file make of its own contact and teeth, a sentence for each force."""
        given = self.file.tolerances
        disk = {"stiffness": given.stiffness, "damping": given.damping, "speed": given.speed}
        torsion = {"stiffness of teeth": given.stiffness, "damping of teeth": given.damping}
        torsion |= {"stiffness of shafts": given.shaft_stiffness, "damping of shafts": given.shaft_damping}
        torsion |= {"speed": given.speed}
        found = []
        for force, case in self.worst.items():
            parts = torsion if force == TORSION else disk
            ranges = ", ".join(f"{name} ±{100 * part:g} %" for name, part in parts.items() if part)
            if case.unknown:
                words = f"not known ({case.unknown})"
            elif case.is_stable:
                words = "stable for all values"
            elif case.swept:
                words = (
                    f"unstable for some values at {_told(case.swept)}, {100 * case.share:.3g} % of the speeds"
                )
            else:
                speeds = ", ".join(f"{rpm(each.speed):.4g}" for each in case.opens)
                words = f"stable at all corners; tongues open between them at {speeds} rpm"
            found.append(f"With {ranges}, {force}: {words}.")
        return tuple(found)

    @property
    def static_force(self) -> float:
        """Whole force between the teeth of a mesh at rest [N]."""
        return self.file.requirements.pinion_torque / self.file.drive.base_radius

    @property
    def dynamic_load(self) -> str:
        """Largest force of a tooth pair over speed in torsion, against that at rest, in words; empty if not known."""
        if self.response is None:
            return ""
        known = self.response.dropna("speed", subset=["force_highest"])
        if not known.sizes["speed"]:
            return "In torsion it is unstable at all speeds looked at: there is no steady load of the teeth."
        highest = known["force_highest"].max("load")
        at = int(highest.argmax("speed"))
        largest, speed = float(highest[at]), float(highest.speed[at])
        parted = int((known["force_lowest"].min("load") < 0.0).sum())
        count, every = known.sizes["speed"], self.response.sizes["speed"]
        return (
            f"In torsion, at {count} of {every} speeds where it is stable, and as long as flanks do not part, a tooth "
            f"pair bears up to {largest:.4g} N, at {rpm(speed):.4g} rpm: {largest / self.static_force:.3g} times the "
            f"whole static force of {self.static_force:.4g} N. At {parted} of these {count} speeds flanks would part."
        )

    @property
    def not_varied(self) -> str:
        """What no model includes."""
        return (
            "Not included: tooth errors, the stiffness of the housing, the disk and the gearbox moving together, "
            "temperature; tolerances are those of the file's own contact and teeth, and of its own arm in torsion; "
            "the driving force is the same at all speeds, and speeds outside the range and its tolerance are not "
            "looked at."
        )

    def table(self) -> xr.Dataset:
        """All models and what they come to, as arrays.

        Returns
        -------
        xarray.Dataset
            Over ``model``: ``unstable_share`` [-], ``largest_growth`` [1/s], ``tongues``, ``settled``; names of
            contact, force and teeth as coordinates.
        """
        names = {
            name: text("model", [getattr(o.variant, name) for o in self.outcomes], words)
            for name, words in (("contact", "Contact"), ("force", "Driving force"), ("teeth", "Teeth"))
        }
        shares = [unstable_share(o.tongues, self.speeds) for o in self.outcomes]
        growth = [o.growth_rate for o in self.outcomes]
        count = [float(len(o.tongues)) for o in self.outcomes]
        settled = [float(o.settled) for o in self.outcomes]
        return xr.Dataset(
            {
                "unstable_share": variable("model", shares, "Unstable part of the speeds", "1", atol=1e-7),
                "largest_growth": variable(
                    "model", growth, "Largest growth rate", "1/s", rtol=1e-6, atol=1e-6
                ),
                "tongues": variable("model", count, "Number of tongues", "1", atol=0.1),
                "settled": variable("model", settled, "1 where the basis suffices", "1", atol=0.1),
            },
            {"model": np.arange(len(self.outcomes)), **names},
            {"parameters": describe(self.file)},
        )


def assess(
    file: DriveFile,
    *,
    tolerance: float = 0.02,
    most_steps: int = 5,
    jobs: int = -1,
    tell: Callable[[str], None] | None = None,
) -> Assessment:
    r"""Run a drive under every model that could change the answer.

    Contacts (Tregold's time and that of the true sweep, or under all, half and a quarter of the load and without any)
    and directions of the driving force make cases. In each follow, besides the teeth of the file, frozen and total
    rate, rigid and flexible teeth, and the rules by which pairs share the load; every model in a basis that is raised
    until its unstable speeds stand still. Then come torsion, tolerances, and the change that helps most.

    Parameters
    ----------
    file : DriveFile
    tolerance, most_steps
        As for :func:`facegear.drives.basis.settled_tongues`.
    jobs : int
        Number of processes, as joblib's ``n_jobs``.
    tell : callable, optional
        Told in words how far it is; a first verdict, on the file's own model alone, within seconds.

    Returns
    -------
    Assessment

    Raises
    ------
    TypeError, ValueError, ArithmeticError
        As :func:`facegear.drives.basis.settled_tongues`; models that the drive does not allow are left out and named.

    Examples
    --------
    At one speed of Case I in the smallest basis there is, to be quick; no basis is said to suffice then.

    >>> from facegear.drives.drive_file import parse_drive
    >>> from facegear.drives.examples import example_text
    >>> text = example_text("case_1").replace("_speed_rpm: 1000", "_speed_rpm: 541")
    >>> text = text.replace("_speed_rpm: 100", "_speed_rpm: 540")
    >>> small = "body:\n  nodal_circles: 0\n  nodal_diameters: 1\n"
    >>> found = assess(parse_drive(text.replace("body:\n", small)), most_steps=1, jobs=1)
    >>> found.verdict, found.decides
    ('depends', ('the contact', 'the direction of the driving force', 'the teeth'))
    """
    number_of_workers("jobs", jobs)
    say = tell or (lambda words: None)
    speeds = file.requirements.speeds
    contacts = plain_contacts(file)
    cases = [
        Variant(name, words, own_teeth(file), driven(file, force, with_own_teeth(file, contact)))
        for name, contact in contacts.items()
        for force, words in FORCES.items()
    ]
    first = tongues(cases[0].model, speeds, progress=False)
    share = 100 * unstable_share(first, speeds)
    say(f"the drive as its file has it, in the basis of the file: unstable at {share:.3g} % of the speeds")
    outcomes: list[Outcome] = []
    refused: list[str] = []
    others: list[Variant] = []
    settle = partial(settled_tongues, tolerance=tolerance, most_steps=most_steps)
    work = [(case.model, speeds, None if number else first) for number, case in enumerate(cases)]
    for case, found in zip(cases, each_in_processes(settle, work, jobs), strict=True):
        outcomes.append(Outcome(replace(case, model=found.model), found.tongues, found.settled))
        # Where two bases agree for the file's teeth, the smaller is where the others begin.
        start = found.steps[-2:][0]
        own = replace(case, model=with_basis(case.model, start.nodal_circles, start.nodal_diameters))
        variants, reasons = other_teeth(file, own, contacts[case.contact])
        others += variants
        refused += reasons
        share = 100 * found.unstable_share
        say(f"case {len(outcomes)} of {len(cases)}: unstable at {share:.3g} % of the speeds ({case.name})")
    # The longest first, so that no processor waits for another at the end.
    others.sort(key=lambda variant: -len(variant.model.coordinates))
    bases = min(_MORE_BASES, most_steps)
    trials = [(variant.model, speeds, tolerance, bases) for variant in others]
    for number, (variant, tried) in enumerate(
        zip(others, each_in_processes(_tried, trials, jobs), strict=True)
    ):
        if tried.found is None:
            refused.append(f"{variant.name}: {tried.reason}")
        else:
            here = replace(variant, model=tried.found.model)
            outcomes.append(Outcome(here, tried.found.tongues, tried.found.settled))
        say(f"other teeth {number + 1} of {len(others)}: {variant.name}")
    worst = _worst(file, outcomes[:2], jobs)
    torsion = _torsion(file, contacts, jobs)
    say("tolerances and torsion are done; the change that helps most is looked for")
    return Assessment(
        file=file,
        outcomes=tuple(outcomes),
        torsion=torsion,
        worst=worst,
        response=_response(file, jobs, refused),
        change=_change(file, outcomes),
        left_out=tuple(dict.fromkeys(refused)),
    )


class _Tried(NamedTuple):
    """Tongues of a model, or why there are none to be told."""

    found: SettledTongues | None
    reason: str


def _tried(model: FaceGears, speeds: tuple[float, float], tolerance: float, most_steps: int) -> _Tried:
    try:
        return _Tried(settled_tongues(model, speeds, tolerance=tolerance, most_steps=most_steps), "")
    except (ArithmeticError, ValueError) as error:
        return _Tried(None, str(error))


def _torsion(file: DriveFile, contacts: Mapping[str, Contact], jobs: int) -> dict[str, tuple[Tongue, ...]]:
    """Tongues in torsion under each contact and each arm of the mesh force, the file's own first."""
    if file.torsional is None:
        return {}
    own = massless(file.torsional).arm
    models = {
        f"{name}, {_ARMS[arm]}": torsional_under(file.torsional, contact, file.drive, arm)
        for arm in sorted(_ARMS, key=lambda arm: arm != own)
        for name, contact in contacts.items()
    }
    speeds = file.tolerances.widened(file.requirements.speeds)
    found = in_processes(tongues, [(model, speeds) for model in models.values()], jobs)
    return dict(zip(models, found, strict=True))


def _worst(file: DriveFile, own: Sequence[Outcome], jobs: int) -> dict[str, WorstCase]:
    work: dict[str, tuple[Any, ...]] = {}
    if file.tolerances.given:
        work |= {outcome.variant.force: (worst_case, outcome.variant.model) for outcome in own}
    if file.tolerances.given_in_torsion and file.torsional is not None:
        work[TORSION] = (worst_case_in_torsion, file.torsional)
    where = (file.requirements.speeds, file.tolerances)
    found = in_processes(_at_worst, [(*each, *where) for each in work.values()], jobs)
    return dict(zip(work, found, strict=True))


def _at_worst(
    find: Callable[..., WorstCase], model: Any, speeds: tuple[float, float], tolerances: Tolerances
) -> WorstCase:
    try:
        return find(model, speeds, tolerances)
    except (ArithmeticError, ValueError) as error:
        return not_known(str(error), speeds, tolerances)


def _response(file: DriveFile, jobs: int, refused: list[str]) -> xr.Dataset | None:
    """Steady response in torsion to the torque of one pinion's power."""
    if file.torsional is None:
        refused.append("dynamic load of the teeth: the file has no section gearbox")
        return None
    torque = file.requirements.pinion_torque * file.drive.gear_ratio
    at_load = np.zeros(len(file.torsional.coordinates))
    at_load[2] = -torque
    loaded = Excited(file.torsional, force=PiecewiseChebyshev.constant(at_load))
    speeds = np.linspace(*file.requirements.speeds, _RESPONSE_SPEEDS)
    try:
        return frequency_response(loaded, speeds, jobs=jobs, progress=False)
    except ArithmeticError as error:
        refused.append(f"dynamic load of the teeth: {error}")
        return None


def _change(file: DriveFile, outcomes: Sequence[Outcome]) -> str:
    """Say which change helps the first unstable model most."""
    unstable = next((outcome for outcome in outcomes if outcome.tongues), None)
    if unstable is None:
        return ""
    speeds = file.requirements.speeds
    effects = effects_of_changes(unstable.variant.model, unstable.tongues, speeds, describe(file))
    return " ".join(best_change(unstable.variant.name, effects, unstable.tongues))


def _intervals(found: Sequence[Tongue]) -> Intervals:
    return tuple((tongue.lower, tongue.upper) for tongue in found)


def _told(intervals: Intervals) -> str:
    return in_rpm(intervals, _NAMED) if intervals else "no speed"


def _listed(words: Sequence[str]) -> str:
    *others, last = words or ("the values taken",)
    return f"{', '.join(others)} and {last}" if others else last
