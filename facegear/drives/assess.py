"""A verdict to stake a gearbox on: a drive under every model that could change the answer.

The report on a drive (:mod:`facegear.drives.verdict`) computes what its file says. What a file cannot know is varied
here (:mod:`facegear.drives.variants`), each model in a basis in which its unstable speeds stand still, and values are
taken anywhere in their tolerances (:mod:`facegear.drives.tolerances`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from facegear.design.changes import effects_of_changes
from facegear.drives.assessment import Assessment
from facegear.drives.basis import SettledTongues, settled_tongues, unstable_share, with_basis
from facegear.drives.contacts import massless, torsional_under
from facegear.drives.disk_response import disk_responses
from facegear.drives.drive_file import DriveFile
from facegear.drives.findings import TORSION, best_change
from facegear.drives.outcome import Outcome
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
from facegear.support.parameters import number_of_workers

_ARMS = {"printed": "arm as printed", "conjugate": "arm of conjugate teeth"}
# Bases tried for other teeth than the file's, the first of them one in which those stand still.
_MORE_BASES = 3
# Speeds of the forced response in torsion.
_RESPONSE_SPEEDS = 91


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
    say("tolerances and torsion are done; forced response and the change that helps most are looked for")
    return Assessment(
        file=file,
        outcomes=tuple(outcomes),
        torsion=torsion,
        worst=worst,
        response=_response(file, jobs, refused),
        change=_change(file, outcomes),
        left_out=tuple(dict.fromkeys(refused)),
        disk_responses=disk_responses(file, outcomes, jobs),
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
