"""Whether a drive is safe, said in words: under which contact and which direction of the driving force.

The driving force of chapter 6 either stays tangent to the bent rim, as the dissertation has it, or keeps its direction
in space. Which of them a real tooth force does is not known, and it decides between flutter and none, so that both are
computed; and so is the contact, whichever the file asks for: Tregold's ratio and that of the true sweep, or, with a
shaper of more teeth than the pinion, under the torque of the file and without load. Each case has a basis of its own
that is raised until its unstable speeds stand still (:mod:`facegear.drives.basis`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import astuple, dataclass, replace

import numpy as np

from facegear.drives.basis import SettledTongues, settled_tongues, unstable_share
from facegear.drives.drive_file import DriveFile
from facegear.drives.flexible_teeth import CENTROID
from facegear.drives.forces import in_words, pressed
from facegear.drives.intervals import in_rpm
from facegear.drives.shaft_modes import SettledTorsion, counted
from facegear.floquet.modes import mean_growth_rate
from facegear.maps.parallel import each_in_processes
from facegear.maps.tracing import Tongue
from facegear.mechanics.contact import Contact
from facegear.mechanics.edge_stiffness import DrivingForce, Following, complete_harmonics
from facegear.mechanics.pinions_on_disk import FaceGears
from facegear.support.parameters import rpm

FORCES: dict[Following, str] = {"follower": "force follows the rim", "dead": "force keeps its direction"}
"""Directions of the driving force, in words."""

# Speeds at which the mean system is tried for flutter.
_SPEEDS = 61
# Windows that are named one by one.
_NAMED = 3


@dataclass(frozen=True)
class Case:
    """A drive under one contact and one direction of the driving force.

    Attributes
    ----------
    contact : str
        Name of the contact, which sets the contact ratio.
    following : {"follower", "dead"}
    found : SettledTongues
    flutter_share : float
        Part of the range of speed in which the mean system alone is unstable, sampled at 61 speeds.
    """

    contact: str
    following: Following
    found: SettledTongues
    flutter_share: float

    @property
    def name(self) -> str:
        """Both in words."""
        return f"{self.contact}, {FORCES[self.following]}"


def driven(file: DriveFile, following: Following, contact: Contact) -> FaceGears:
    """Model of a drive file with the force that its power takes, all harmonics of its stress included.

    Parameters
    ----------
    file : DriveFile
    following : {"follower", "dead"}
    contact : Contact
    """
    duty, gear = file.requirements, file.transverse.gear
    spread = pressed(file.force_at, contact, file.drive)
    force = DrivingForce(duty.power, duty.pinion_speed, following, complete_harmonics(gear.body), spread)
    return file.transverse.with_gear(replace(gear, contact=contact, force=force))


def powered(model: FaceGears) -> str:
    """Say what has the power of a drive file: each pinion, or each mesh where a pinion has two of them."""
    return "mesh" if len(model.driving) > 1 else "pinion"


def cases(
    file: DriveFile,
    *,
    tolerance: float = 0.02,
    most_steps: int = 5,
    jobs: int = -1,
    tell: Callable[[str], object] = lambda _: None,
) -> tuple[Case, ...]:
    """Tongues of a drive under its power, for both contacts that its teeth can have and both directions of the force.

    Parameters
    ----------
    file : DriveFile
    tolerance, most_steps
        As for :func:`facegear.drives.basis.settled_tongues`.
    jobs : int
        Number of processes, as joblib's ``n_jobs``.
    tell : callable
        Called with a line as each case is there.

    Returns
    -------
    tuple of Case
        Those with the file's contact first, the following force before the dead one.
    """
    settings = [(name, contact, force) for name, contact in file.contacts.items() for force in FORCES]
    models = [driven(file, force, contact) for _, contact, force in settings]
    work = [(model, file.requirements.speeds, tolerance, most_steps) for model in models]
    found = []
    for (name, _, force), result in zip(settings, each_in_processes(_settled, work, jobs), strict=True):
        found.append(Case(name, force, *result))
        tell(f"case {len(found)} of {len(settings)}: {found[-1].name}")
    return tuple(found)


def _settled(
    model: FaceGears, speeds: tuple[float, float], tolerance: float, most_steps: int
) -> tuple[SettledTongues, float]:
    found = settled_tongues(model, speeds, tolerance=tolerance, most_steps=most_steps)
    growth = [mean_growth_rate(found.model.system(v)) for v in np.linspace(*speeds, _SPEEDS).tolist()]
    return found, float(np.mean(np.array(growth) > 0.0))


# --- in words ---------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Verdict:
    """What a report opens with.

    Attributes
    ----------
    headline : str
        Safe or not, in one sentence.
    findings : tuple of str
        One sentence a case: at which speeds, by which mechanism, in which basis.
    left_out : str
        What none of this includes.
    in_doubt : bool
        Whether a case or torsion has not settled: what is stable may not be.
    """

    headline: str
    findings: tuple[str, ...]
    left_out: str
    in_doubt: bool


def verdict(file: DriveFile, computed: Sequence[Case], torsion: SettledTorsion | None) -> Verdict:
    """Say whether a drive is safe.

    Parameters
    ----------
    file : DriveFile
    computed : sequence of Case
        From :func:`cases`.
    torsion : SettledTorsion, optional
        The gearbox, if the file has one.

    Returns
    -------
    Verdict
    """
    low, high = (f"{rpm(speed):.4g}" for speed in file.requirements.speeds)
    duty = file.requirements
    teeth = "rigid" if file.teeth is None else "flexible"
    each = powered(file.transverse)
    gears = "" if file.roles is None else f" between two gears ({', '.join(file.roles)})"
    where = (
        f"from {low} to {high} rpm under the driving force of {1e-3 * duty.power:.4g} kW a {each} at "
        f"{rpm(duty.pinion_speed):.4g} rpm of the pinion, pressing {in_words(file.force_at)}, on {teeth} teeth{gears}"
    )
    shares = {case: case.found.unstable_share for case in computed}
    unstable = [case for case in computed if shares[case] > 0.0]
    open_cases = sum(not case.found.settled for case in computed)
    if len(unstable) == len(computed):
        headline = (
            f"Not safe: unstable at some speeds {where}, whatever is assumed of contact ratio and force."
        )
    elif unstable:
        headline = f"Not shown to be safe {where}: it depends on {_what_decides(computed)}."
    elif open_cases:
        headline = f"Not shown to be safe {where}: nothing unstable was found, but not all bases suffice."
    else:
        headline = (
            f"Stable at all speeds {where}, under both contact ratios and both directions of the force."
        )
    torsional = None if torsion is None else torsion.tongues
    if torsional and not unstable:
        headline = f"Not safe: in torsion unstable at some speeds. Of the disk's motion: {headline}"
    elif torsional:
        headline += " In torsion it is unstable at some speeds."
    elif torsional is not None:
        headline += " In torsion it is stable at all of them."
    if open_cases:
        which = "it" if open_cases == 1 else "them"
        headline += (
            f" NOT SETTLED in {open_cases} of {len(computed)} cases: a larger basis may change {which}."
        )
    stress, allowed = duty.root_stresses(file.transverse.gear.body)
    strength = f"{1e-6 * stress:.4g} MPa at the root of the pinion's tooth, {1e-6 * allowed:.4g} MPa allowed"
    if stress >= allowed:
        headline += f" The teeth are not strong enough: {strength}."
    findings = [_finding(case) for case in computed]
    if torsional is not None:
        spoken = _speeds(torsional, file.requirements.speeds)
        findings.append(f"Torsion: {spoken}{_resonances(torsional)}.")
    findings += [f"Cannot be built as a solid shaft: {sentence}." for sentence in file.not_buildable]
    findings.append(f"Strength: {strength}.")
    in_doubt = open_cases > 0
    if torsion is not None and torsion.basis:
        findings.append(torsion.basis)
    if torsion is not None and not torsion.settled:
        headline += " NOT SETTLED in torsion: more modes of a shaft may change it."
        in_doubt = True
    return Verdict(headline, tuple(findings), _left_out(file), in_doubt)


def _what_decides(computed: Sequence[Case]) -> str:
    """Name what parts stable cases from unstable ones."""
    stable = {(case.contact, case.following): not case.found.tongues for case in computed}
    contact = any(stable[c, f] != stable[d, f] for c, f in stable for d, g in stable if f == g)
    force = any(stable[c, f] != stable[c, g] for c, f in stable for d, g in stable if c == d)
    names = ["the contact ratio"] * contact + ["whether the driving force follows the bent rim"] * force
    return " and on ".join(names)


def _finding(case: Case) -> str:
    """Say at which speeds a case is unstable, by which mechanism, in which basis."""
    found = case.found
    last = found.steps[-1]
    basis = (
        f"{counted(last.nodal_circles, 'nodal circle')} and {counted(last.nodal_diameters, 'nodal diameter')}"
    )
    if len(found.steps) == 1:
        sure = f"{basis}; no larger basis was tried"
    else:
        sure = f"{basis}; the basis before differs at {100 * last.moved:.2g} % of the speeds"
    if not found.settled:
        sure += ", NOT SETTLED"
    spoken = _speeds(found.tongues, found.speeds)
    if case.flutter_share > 0.0:
        cause = (
            f"; at {100 * case.flutter_share:.3g} % of {_SPEEDS} speeds looked at the driving force alone makes the "
            "mean system, pinions included, unstable (flutter, or divergence)"
        )
    else:
        cause = _resonances(found.tongues)
    return f"{case.name[0].upper()}{case.name[1:]}: {spoken}{cause} ({sure})."


def _speeds(found: Sequence[Tongue], speeds: tuple[float, float]) -> str:
    if not found:
        return "stable at all speeds"
    named = in_rpm([(tongue.lower, tongue.upper) for tongue in found], _NAMED)
    growth = max(tongue.growth_rate for tongue in found)
    share = 100 * unstable_share(found, speeds)
    return f"unstable at {share:.3g} % of the speeds ({named}; growth up to {growth:.3g} 1/s)"


def _resonances(found: Sequence[Tongue]) -> str:
    """Name the strongest resonance."""
    if not found:
        return ""
    strongest = max(found, key=lambda tongue: tongue.growth_rate)
    return f"; parametric resonance, the strongest {strongest.label} at {rpm(strongest.peak):.4g} rpm"


def _left_out(file: DriveFile) -> str:
    missing = ["torsion (the file has no section gearbox)"] * (file.torsional is None)
    if file.torsional is not None and file.roles is not None:
        missing += ["that torsion is that of one pinion on one gear, not of a train that shares its torque"]
    if file.teeth is None:
        missing += ["the flexibility of the teeth (the file has no section teeth)"]
        missing += ["how tooth pairs share the load"] * file.drive.has_line_contact
        missing += ["the inertia of the moving contact (total rate)"]
    elif file.teeth.sharing == CENTROID:
        missing += ["the load of each tooth pair by itself"]
    missing += [
        "tooth errors and backlash" if file.play is None else "tooth errors",
        "the stiffness of the housing",
    ]
    return (
        f"Not included: {', '.join(missing)}. The driving force is the same at all speeds; all parameters are taken as "
        "exact; speeds outside the range are not looked at."
        + " The tolerances of the file are left out here; facegear assess has them."
        * any(astuple(file.tolerances))
    )
