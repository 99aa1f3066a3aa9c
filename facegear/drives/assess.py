"""A verdict to stake a gearbox on: a drive under every model that could change the answer.

The report on a drive (:mod:`facegear.drives.verdict`) computes what its file says. What a file cannot know is varied
here (:mod:`facegear.drives.variants`), each model in a basis in which its unstable speeds stand still, and values are
taken anywhere in their tolerances (:mod:`facegear.drives.tolerances`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from facegear.design.changes import effects_of_changes
from facegear.drives.assessment import Assessment
from facegear.drives.basis import (
    SettledTongues,
    found_around,
    settled_tongues,
    traced,
    unstable_share,
    with_basis,
    within,
)
from facegear.drives.contacts import massless, torsional_under
from facegear.drives.disk_response import RESPONSE_SPEEDS, disk_response
from facegear.drives.drive_file import DriveFile
from facegear.drives.findings import TORSION, best_change
from facegear.drives.outcome import Outcome
from facegear.drives.refusals import told
from facegear.drives.report_arrays import describe
from facegear.drives.shaft_modes import SettledTorsion, modes_of, settled_torsion
from facegear.drives.tolerances import Tolerances
from facegear.drives.variants import (
    Variant,
    other_teeth,
    own_teeth,
    plain_contacts,
    with_own_teeth,
)
from facegear.drives.verdict import FORCES, driven
from facegear.drives.worst_case import WorstCase, not_known, worst_case, worst_case_in_torsion
from facegear.floquet.modified_models import Excited
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.maps.crew import Crew
from facegear.maps.response_map import frequency_response
from facegear.maps.tracing import Searched
from facegear.mechanics.contact import Contact
from facegear.mechanics.pinions_on_disk import FaceGears
from facegear.support.parameters import number_of_workers, rpm
from facegear.support.types import FloatArray

_ARMS = {"printed": "arm as printed", "conjugate": "arm of conjugate teeth"}
# Bases tried for other teeth than the file's, the first of them one in which those stand still.
_MORE_BASES = 3
# Speeds of the response in torsion.
_TORSION_SPEEDS = 91
# Urgency of cases, which other models wait for, above that of any size of a model; then comes what takes longest, so
# that no process is idle at the end: a search in tolerances takes about five times as long as tongues in two or three
# bases, and a forced response half as long.
_CASES_FIRST = 1e6
_SEARCH, _RESPONSE = 5.0, 0.5


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
    until its unstable speeds stand still. Then come torsion, tolerances, what the static transmission error under the
    load makes of the force of a mesh (:mod:`facegear.drives.disk_response`), and the change that helps most.

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
        As :func:`facegear.drives.basis.settled_tongues` where no model can be computed; otherwise models that cannot,
        or that the drive does not allow, are left out and named.

    Examples
    --------
    At one speed of Case I in the smallest basis there is, to be quick; no basis is said to suffice then.

    >>> import facegear as fg
    >>> from facegear.drives.drive_file import parse_drive
    >>> from facegear.drives.examples import example_text
    >>> text = example_text("case_1").replace("_speed_rpm: 1000", "_speed_rpm: 541")
    >>> text = text.replace("_speed_rpm: 100", "_speed_rpm: 540")
    >>> small = "body:\n  nodal_circles: 0\n  nodal_diameters: 1\n"
    >>> found = fg.assess(parse_drive(text.replace("body:\n", small)), most_steps=1, jobs=1)
    >>> found.verdict, found.decides[:3]
    ('depends', ('the contact', 'the direction of the driving force', 'the teeth'))
    >>> found.decides[3:]
    ('bases that have not settled',)
    """
    number_of_workers("jobs", jobs)
    found = _Found(file, tolerance, most_steps, tell or (lambda words: None))
    with Crew(jobs) as crew:
        found.begin(crew)
        for name, result in crew.results(found.at_work):
            found.take(crew, name, result)
    return found.assessment()


class _Found:
    """What has been found, piece by piece, and what each piece brings along."""

    def __init__(
        self, file: DriveFile, tolerance: float, most_steps: int, say: Callable[[str], object]
    ) -> None:
        self.file, self.say, self.speeds = file, say, file.requirements.speeds
        # Speeds that the drive may come to, and those where tongues are looked for that could come to these.
        self.judged = file.tolerances.widened(self.speeds)
        self.tolerance, self.most_steps = tolerance, most_steps
        self.contacts = plain_contacts(file)
        self.cases = [
            Variant(name, words, own_teeth(file), driven(file, force, with_own_teeth(file, contact)))
            for name, contact in self.contacts.items()
            for force, words in FORCES.items()
        ]
        # Of each case and of the teeth besides the file's in it, by number of the case and of the teeth: 0 its own.
        self.outcomes: dict[tuple[int, int], Outcome] = {}
        self.refused: dict[tuple[int, int], list[str]] = {}
        # Models that there are, but that could not be computed.
        self.failed: dict[tuple[int, int], list[str]] = {}
        self.others: dict[tuple[int, int], Variant] = {}
        self.torsion = _in_torsion(file, self.contacts)
        self.found: dict[tuple[str, Any], Any] = {}

    def begin(self, crew: Crew) -> None:
        """Look for the first verdict here while the second case is at work, then let all cases and torsion follow."""
        # No more beside it, or what somebody waits for would take longer.
        self._add_case(crew, 1, self.cases[1])
        known, words = self._first()
        self.say(f"the drive as its file has it, in the basis of the file: {words}")
        self._add_case(crew, 0, self.cases[0], *known)
        for number, case in enumerate(self.cases[2:], 2):
            self._add_case(crew, number, case)
        for number, (name, work) in enumerate(self.torsion.items()):
            # More follows from the first, which is the file's own.
            urgency = 0.0 if number else _SEARCH * len(work[0].coordinates)
            crew.add(("torsion", name), urgency, settled_torsion, *work, self.tolerance)

    def _first(self) -> tuple[tuple[Searched, ...], str]:
        """Search the speeds with the file's own model, if it can be computed, and give the first verdict in words."""
        try:
            found = found_around(self.cases[0].model, self.judged)
        except ArithmeticError as error:
            return (), f"it could not be computed ({told(error)})"
        share = unstable_share(within(self.cases[0].model, found.tongues, self.speeds), self.speeds)
        return (found,), f"unstable at {100 * share:.3g} % of the speeds"

    def _add_case(self, crew: Crew, number: int, case: Variant, *known: Searched) -> None:
        work = (case.model, self.speeds, self.judged, self.tolerance, self.most_steps, *known)
        crew.add(("case", number), _CASES_FIRST, _tried, *work)

    def _add_worst(self, crew: Crew, name: str, find: Callable[..., WorstCase], model: Any) -> None:
        size = float(len(model.coordinates))
        crew.add(("worst", name), _SEARCH * size, _at_worst, find, model, self.speeds, self.file.tolerances)

    def at_work(self, names: Sequence[tuple[str, Any]]) -> None:
        """Say what is being computed."""
        words: dict[str, Callable[[Any], str]] = {
            "case": lambda number: self.cases[number].name,
            "teeth": lambda which: self.others[which].name,
            "torsion": lambda name: f"torsion, {name}",
            "worst": lambda name: f"values in tolerances, {name}",
        }
        others = {
            "response": "response in torsion",
            "disk": "dynamic load of the disk",
            "change": "changes that may help",
        }
        told_of = [words[kind](which) if kind in words else others[kind] for kind, which in names]
        self.say(f"at work: {'; '.join(told_of)}")

    def take(self, crew: Crew, name: Any, result: Any) -> None:
        """Keep a result, and add what it brings along."""
        kind, which = name
        if kind == "case":
            self._take_case(crew, which, result)
        elif kind == "teeth":
            self._take_teeth(crew, which, result)
        else:
            self.found[kind, which] = result
            if name == ("torsion", next(iter(self.torsion), None)):
                self._take_own_torsion(crew, result)

    def _take_case(self, crew: Crew, number: int, tried: _Tried) -> None:
        case, failed, start = self.cases[number], [], self.cases[number].model
        if (found := tried.found) is None:
            failed, words = [f"{case.name}: {tried.reason}"], "could not be computed"
        else:
            self._keep(
                crew,
                (number, 0),
                Outcome(replace(case, model=found.model), found.tongues, found.settled, found.growth_moved),
            )
            # Where two bases agree for the file's teeth, the smaller is where the others begin.
            last, enough = found.steps[-2:][0], found.sufficient
            start = with_basis(case.model, last.nodal_circles, last.nodal_diameters)
            words = f"unstable at {100 * found.unstable_share:.3g} % of the speeds"
            # Those of the file's own contact and teeth.
            if number < len(FORCES) and self.file.tolerances.given:
                model = with_basis(case.model, enough.nodal_circles, enough.nodal_diameters)
                self._add_worst(crew, case.force, worst_case, model)
        variants, self.refused[number, 0], others = other_teeth(
            self.file, replace(case, model=start), self.contacts[case.contact]
        )
        self.failed[number, 0] = failed + others
        bases = min(_MORE_BASES, self.most_steps)
        for place, variant in enumerate(variants, 1):
            self.others[number, place] = variant
            size = float(len(variant.model.coordinates))
            work = (variant.model, self.speeds, self.speeds, self.tolerance, bases)
            crew.add(("teeth", (number, place)), size, _tried, *work)
        done = sum(place == 0 for _, place in self.failed)
        self.say(f"case {done} of {len(self.cases)}: {words} ({case.name})")
        if done == len(self.cases):
            self._add_change(crew)

    def _take_teeth(self, crew: Crew, which: tuple[int, int], tried: _Tried) -> None:
        variant = self.others[which]
        if tried.found is None:
            self.failed[which] = [f"{variant.name}: {tried.reason}"]
        else:
            here = replace(variant, model=tried.found.model)
            found = tried.found
            self._keep(crew, which, Outcome(here, found.tongues, found.settled, found.growth_moved))
        done = sum(place > 0 for _, place in {**self.outcomes, **self.failed})
        self.say(f"other teeth {done} of {len(self.others)} known so far: {variant.name}")

    def _take_own_torsion(self, crew: Crew, settled: SettledTorsion) -> None:
        """Look further at the gearbox as its file has it, its shafts with as many modes as its tongues needed."""
        torsional: Any = self.file.torsional
        if any(modes := modes_of(settled.model)):
            torsional = replace(torsional, modes=modes)
        crew.add(("response", ""), 0.0, _response, self.file, torsional)
        if self.file.tolerances.given_in_torsion:
            self._add_worst(crew, TORSION, worst_case_in_torsion, torsional)

    def _keep(self, crew: Crew, which: tuple[int, int], outcome: Outcome) -> None:
        self.outcomes[which] = outcome
        if outcome.variant.contact == self.cases[0].contact:
            force = self.file.requirements.pinion_torque / self.file.drive.base_radius
            size = float(len(outcome.variant.model.coordinates))
            crew.add(("disk", which), _RESPONSE * size, disk_response, outcome, force, self._charted)

    @property
    def _charted(self) -> FloatArray:
        return np.linspace(*self.speeds, RESPONSE_SPEEDS)

    def _add_change(self, crew: Crew) -> None:
        """Look for what helps the first unstable case, as soon as it is known which."""
        own = (
            self.outcomes[which]
            for number in range(len(self.cases))
            if (which := (number, 0)) in self.outcomes
        )
        if (unstable := next((outcome for outcome in own if outcome.tongues), None)) is not None:
            size = float(len(unstable.variant.model.coordinates))
            crew.add(("change", ""), size, _change, self.file, unstable, self.judged)

    def assessment(self) -> Assessment:
        """Put everything together, in an order that does not depend on what was done first."""
        own = [(number, 0) for number in range(len(self.cases))]
        others = sorted(self.others, key=lambda which: -len(self.others[which].model.coordinates))
        order = [which for which in (*own, *others) if which in self.outcomes]
        outcomes = tuple(self.outcomes[which] for which in order)
        refused, failed = (
            [reason for which in (*own, *others) for reason in reasons.get(which, ())]
            for reasons in (self.refused, self.failed)
        )
        if not outcomes:
            raise ArithmeticError("no model of the disk's motion could be computed: " + "; ".join(failed))
        response, reason = self.found.get(("response", ""), (None, "the file has no section gearbox"))
        refused += [f"dynamic load of the teeth in torsion: {reason}"] * bool(reason)
        change = self.found.get(("change", ""))
        if change is None:
            unstable = next((outcome for outcome in outcomes if outcome.tongues), None)
            change = "" if unstable is None else _change(self.file, unstable, self.judged)
        torsion = {name: self.found["torsion", name] for name in self.torsion}
        if change and any(found.tongues for found in torsion.values()):
            change += " In torsion no change was tried."
        return Assessment(
            file=self.file,
            outcomes=outcomes,
            torsion=torsion,
            worst={
                name: self.found["worst", name]
                for name in (*FORCES.values(), TORSION)
                if ("worst", name) in self.found
            },
            response=response,
            change=change,
            left_out=tuple(dict.fromkeys(refused)),
            failed=tuple(failed),
            disk_responses=tuple(
                self.found["disk", which] for which in order if ("disk", which) in self.found
            ),
        )


class _Tried(NamedTuple):
    """Tongues of a model, or why there are none to be told."""

    found: SettledTongues | None
    reason: str


def _tried(
    model: FaceGears,
    speeds: tuple[float, float],
    judged: tuple[float, float],
    tolerance: float,
    most_steps: int,
    known: Searched | None = None,
) -> _Tried:
    try:
        found = settled_tongues(
            model, speeds, known, around=judged, tolerance=tolerance, most_steps=most_steps
        )
    except (ArithmeticError, ValueError) as error:
        return _Tried(None, told(error))
    return _Tried(found, "")


def _in_torsion(
    file: DriveFile, contacts: Mapping[str, Contact]
) -> dict[str, tuple[Any, tuple[float, float]]]:
    """Models of torsion under each contact and each arm, the file's own first, and speeds with their tolerance."""
    if file.torsional is None:
        return {}
    own, wide = massless(file.torsional).arm, file.tolerances.widened(file.requirements.speeds)
    return {
        f"{name}, {_ARMS[arm]}": (torsional_under(file.torsional, contact, file.drive, arm), wide)
        for arm in sorted(_ARMS, key=lambda arm: arm != own)
        for name, contact in contacts.items()
    }


def _at_worst(
    find: Callable[..., WorstCase], model: Any, speeds: tuple[float, float], tolerances: Tolerances
) -> WorstCase:
    try:
        return find(model, speeds, tolerances)
    except (ArithmeticError, ValueError) as error:
        return not_known(told(error), speeds, tolerances)


def _response(file: DriveFile, torsional: Any) -> tuple[xr.Dataset | None, str]:
    """Steady response in torsion to the torque of one pinion's power, or why there is none."""
    torque = file.requirements.pinion_torque * file.drive.gear_ratio
    at_load = np.zeros(len(torsional.coordinates))
    at_load[2] = -torque
    loaded = Excited(torsional, force=PiecewiseChebyshev.constant(at_load))
    speeds = np.linspace(*file.requirements.speeds, _TORSION_SPEEDS)
    try:
        return frequency_response(loaded, speeds, jobs=1, progress=False), ""
    except ArithmeticError as error:
        return None, told(error)


def _change(file: DriveFile, unstable: Outcome, speeds: tuple[float, float]) -> str:
    """Say which change helps an unstable model most, at all speeds that the drive may come to."""
    model, found = unstable.variant.model, unstable.tongues
    if speeds != file.requirements.speeds:
        found = traced(model, speeds)
    effects = effects_of_changes(model, found, speeds, describe(file))
    low, high = (f"{rpm(speed):.4g}" for speed in speeds)
    name = f"{unstable.variant.name}; from {low} to {high} rpm"
    return " ".join(best_change(name, effects, found))
