"""What is known of the stability of a drive: the verdict, what decides it, and what of the speeds is left."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import xarray as xr

from facegear.drives.assessment_table import model_table
from facegear.drives.disk_response import DiskResponse
from facegear.drives.disk_response_table import peaks_table, response_table
from facegear.drives.disk_response_words import parting, sentences, steadiness_known
from facegear.drives.drive_file import DriveFile
from facegear.drives.findings import TORSION
from facegear.drives.growth_words import (
    SPEED_TURNS,
    corner,
    listed,
    mechanism,
    told,
    turning,
    within_tolerances,
)
from facegear.drives.intervals import Intervals, cut, gaps, inward, united
from facegear.drives.outcome import Outcome
from facegear.drives.report_arrays import describe
from facegear.drives.shaft_modes import SettledTorsion
from facegear.drives.torsion_response import in_words
from facegear.drives.worst_case import WorstCase
from facegear.maps.tracing import Tongue
from facegear.support.parameters import rpm

SAFE, UNSTABLE, DEPENDS = "safe under all", "unstable under all", "depends"
"""What an assessment may come to."""

# What two models may differ in, as a sentence has it.
_EFFECTS = {"contact": "the contact", "force": "the direction of the driving force", "teeth": "the teeth"}


@dataclass(frozen=True, eq=False)
class Assessment:
    """What is known of the stability of a drive.

    Attributes
    ----------
    file : DriveFile
    outcomes : tuple of Outcome
        The file's own contact and teeth first.
    torsion : dict of str to SettledTorsion
        Tongues in torsion under each contact and each arm of the mesh force, the file's own first, over the range of
        speed with its tolerance, and whether the modes of its shafts suffice; empty where the file has no gearbox.
    worst : dict of str to WorstCase
        Of the file's own contact and teeth, by the direction of the force, and of its gearbox in "torsion"; empty where
        the file has no tolerances.
    response : xarray.Dataset or None
        Steady response of the gearbox to the torque of one pinion's power
        (:func:`facegear.maps.response_map.frequency_response`), if there is one.
    change : str
        The change that helps the file's own model most, made in earnest; empty if there is none.
    left_out : tuple of str
        What there is not, or could not be computed beside the models, and why.
    disk_responses : tuple of DiskResponse
        Forced response of the disk in each model of the file's own contact, or why there is none.
    failed : tuple of str
        Models of the disk's motion that could not be computed, and why: what they come to is not known.
    """

    file: DriveFile
    outcomes: tuple[Outcome, ...]
    torsion: dict[str, SettledTorsion]
    worst: dict[str, WorstCase]
    response: xr.Dataset | None
    change: str
    left_out: tuple[str, ...]
    disk_responses: tuple[DiskResponse, ...] = ()
    failed: tuple[str, ...] = ()

    @property
    def speeds(self) -> tuple[float, float]:
        """Lowest and highest speed [rad/s]."""
        return self.file.requirements.speeds

    @property
    def verdict(self) -> str:
        """One of "safe under all", "unstable under all", "depends": models, and values in their tolerances."""
        disk = [outcome.is_stable for outcome in self.outcomes]
        # Beyond the operating speeds, in their tolerance, a drive need not run.
        torsion = [not self._operating(found) for found in self._in_torsion] or [True]
        if self.failed:
            return DEPENDS if any(torsion) else UNSTABLE
        if (
            all(disk)
            and not self.open_models
            and not any(self._in_torsion)
            and not self.open_torsion
            and all(case.is_stable for case in self.worst.values())
        ):
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
        own = next(iter(self._in_torsion), ())
        nominal[TORSION] = not self._operating(own)
        given = self.file.tolerances
        turned = [
            turning(force, case, given, self.speeds)
            for force, case in self.worst.items()
            if nominal.get(force) and not case.is_stable
        ]
        found += dict.fromkeys(turned + [SPEED_TURNS] * (nominal[TORSION] and bool(own)))
        if len({bool(self._operating(tongues)) for tongues in self._in_torsion}) == 2:
            found.append("the contact or the arm of the mesh force in torsion")
        if self.open_torsion:
            found.append("more modes of a shaft in torsion")
        if self.failed:
            found.append("models that could not be computed")
        if any(outcome.is_stable and not outcome.settled for outcome in self.outcomes):
            found.append("bases that have not settled")
        return tuple(found)

    @property
    def open_models(self) -> int:
        """Number of models of the disk's motion that have not settled: a larger basis may turn them."""
        return sum(not outcome.settled for outcome in self.outcomes)

    @property
    def open_torsion(self) -> int:
        """Number of models of torsion that have not settled: more modes of a shaft may turn them."""
        return sum(not found.settled for found in self.torsion.values())

    @property
    def _in_torsion(self) -> list[tuple[Tongue, ...]]:
        """Tongues of each model of torsion."""
        return [found.tongues for found in self.torsion.values()]

    def _operating(self, found: Sequence[Tongue]) -> Intervals:
        """Where tongues stand in the operating range, without its tolerance."""
        return cut(united(_intervals(found)), self.speeds)

    def _is_own(self, outcome: Outcome) -> bool:
        first = self.outcomes[0].variant
        return (outcome.variant.contact, outcome.variant.teeth) == (first.contact, first.teeth)

    @cached_property
    def always_unstable(self) -> Intervals:
        """Intervals of speed [rad/s] in which all models of the disk's motion, or all of torsion, are unstable."""

        def in_all(family: Sequence[Sequence[Tongue]]) -> Intervals:
            stable = [gap for found in family for gap in gaps(_intervals(found), self.speeds)]
            return gaps(united(stable), self.speeds) if family else ()

        return united([*in_all([o.tongues for o in self.outcomes]), *in_all(self._in_torsion)])

    @cached_property
    def always_stable(self) -> Intervals:
        """Intervals of speed [rad/s] in which every model, torsion and every value looked at is stable.

        Known it is only if all models have settled (:attr:`open_models`, :attr:`open_torsion`).
        """
        every = [interval for o in self.outcomes for interval in _intervals(o.tongues)]
        # Where it is not known, nothing is known to be stable.
        every += [interval for case in self.worst.values() for interval in case.possible]
        every += [interval for found in self._in_torsion for interval in _intervals(found)]
        return gaps(united(every), self.speeds)

    @property
    def headline(self) -> str:
        """The verdict in a sentence or two, with what it was computed for."""
        low, high = (f"{rpm(speed):.4g}" for speed in self.speeds)
        count = len(self.outcomes)
        safe = sum(outcome.is_stable for outcome in self.outcomes)
        are = f"{safe} {'is' if safe == 1 else 'are'}"
        where = f"from {low} to {high} rpm, of {count} models of the disk's motion"
        if self.verdict == SAFE:
            words = f"Safe under all: {where} none is unstable at any speed."
        elif self.verdict == UNSTABLE and safe:
            words = f"Unstable under all, because of torsion; {where} {are} stable at all speeds."
        elif self.verdict == UNSTABLE:
            words = f"Unstable under all: {where} each is unstable at some speeds."
        else:
            words = f"Depends on {listed(self.decides)}: {where} {are} stable at all speeds."
        parting = self.parting or (
            "Whether flanks stay in contact under the load of the drive is not known (Dynamic load)."
            if self.verdict == SAFE and not steadiness_known(self.disk_responses)
            else ""
        )
        words += f" {parting}" * bool(parting) + self._of_failed + self._of_torsion
        stable = told(inward(self.always_stable))
        if self.open_models or self.open_torsion:
            which = "no model, nor the file's own within its tolerances," if self.worst else "no model"
            words += (
                f"{self._not_settled} Speeds at which {which} was found unstable, which does not make them stable: "
                f"{stable}."
            )
        else:
            values = ", and the file's own within its tolerances" if self.worst else ""
            words += f" Speeds at which every model is known to be stable{values}: {stable}."
        families = (
            "all models of the disk's motion, or all of torsion, are" if self.torsion else "all models are"
        )
        words += f" Speeds at which {families} unstable: {told(self.always_unstable)}."
        if self.verdict != SAFE:
            words += f" Worst: {self.mechanism}."
        return words

    @property
    def _not_settled(self) -> str:
        """How many models have not settled, and what may turn them, as the headline has it; empty if all have."""
        families = (
            (self.open_models, len(self.outcomes), "models", "a larger basis"),
            (self.open_torsion, len(self.torsion), "models of torsion", "more modes of a shaft"),
        )
        return "".join(
            f" NOT SETTLED in {still} of {count} {what}: {more} may turn {'it' if still == 1 else 'them'}."
            for still, count, what, more in families
            if still
        )

    @property
    def _of_failed(self) -> str:
        """How many models could not be computed, as the headline has it; empty if all could."""
        count = len(self.failed)
        if not count:
            return ""
        return (
            f" {count} more could not be computed, and what {'it comes' if count == 1 else 'they come'} to is not "
            "known (Left out): what is said of every model is said of the others."
        )

    @property
    def _of_torsion(self) -> str:
        """How many models of torsion are stable, as the headline has it; empty without any."""
        if not self.torsion:
            return ""
        count, still = len(self.torsion), sum(not found for found in self._in_torsion)
        where = " in the range with its tolerance" if self.file.tolerances.speed else ""
        if not still:
            each = f"Each of the {count} models" if count > 1 else "The one model"
            return f" {each} of torsion is unstable somewhere{where}."
        return f" Of {count} models of torsion {still} {'is' if still == 1 else 'are'} stable at all speeds{where}."

    @property
    def mechanism(self) -> str:
        """What grows fastest of all models, and at values in their tolerances, and how."""
        unstable = [(o.variant.name, tongue) for o in self.outcomes for tongue in o.tongues]
        unstable += [(f"torsion; {name}", t) for name, found in self.torsion.items() for t in found.tongues]
        for name, case in self.worst.items():
            if case.fastest is not None:
                factors, tongue = case.fastest
                unstable.append((f"{name}, tolerances; {corner(factors, case.factors)}", tongue))
        if not unstable:
            return (
                "nothing grows at the values of the file, nor at those of its tolerances that were looked at"
            )
        # The first of equal ones, a model before a corner that is the same.
        name, strongest = max(unstable, key=lambda pair: pair[1].growth_rate)
        low, high = self.speeds
        where = "" if low <= strongest.peak <= high else ", outside the range, in the tolerance of speed"
        return f"{mechanism(strongest)} ({name}{where})"

    @property
    def over_tolerances(self) -> tuple[str, ...]:
        """What the tolerances of the file make of its own contact and teeth, a sentence for each force."""
        return within_tolerances(self.worst, self.file.tolerances)

    @property
    def static_force(self) -> float:
        """Whole force between the teeth of a mesh at rest [N]."""
        return self.file.requirements.pinion_torque / self.file.drive.base_radius

    @property
    def dynamic_load(self) -> str:
        """Largest force of a tooth pair over speed in torsion, against that at rest, in words; empty if not known."""
        if self.response is None:
            return ""
        return in_words(self.response, self.static_force)

    @property
    def forced(self) -> tuple[str, ...]:
        """Forced response of the disk in words: how far the force of a mesh departs from that at rest, or why not."""
        return sentences(self.disk_responses, self.static_force)

    @property
    def parting(self) -> str:
        """That flanks would part, and at how many speeds, though models have them in contact; empty if none says so."""
        return parting(self.disk_responses, self.static_force, self.response)

    @property
    def response_table(self) -> xr.Dataset | None:
        """Forced response of the disk as arrays (:func:`facegear.drives.disk_response_table.response_table`)."""
        return response_table(self.disk_responses, self._parameters)

    @property
    def response_peaks(self) -> xr.Dataset | None:
        """Peaks of the forced response (:func:`facegear.drives.disk_response_table.peaks_table`)."""
        return peaks_table(self.disk_responses, self._parameters)

    @property
    def _parameters(self) -> str:
        """Of the drive, for the provenance of arrays whose models have a basis each."""
        return (
            f"{describe(self.file)}; each model in a basis of its own, given beside it, not that of the file"
        )

    @property
    def not_varied(self) -> str:
        """What no model includes."""
        count = len(self.file.transverse.gear.pinion_angles)
        more = ["what becomes of motions once flanks part, in their play"] * (self.file.play is not None)
        more += ["the damaged tooth"] * (self.file.cracked is not None)
        there = f" For {listed(more)} see `facegear report`." if more else ""
        alone = f"the other {'pinion' if count == 2 else 'pinions'} in torsion, where there is one, "
        return (
            "Not included: tooth errors, the stiffness of the housing, the disk and the gearbox moving together, "
            f"{alone * (count > 1 and self.file.torsional is not None)}"
            "temperature; tolerances are those of the file's own contact and teeth, and of its own arm in torsion; "
            "the driving force is the same at all speeds, and speeds outside the range and its tolerance are not "
            f"looked at.{there}"
        )

    def table(self) -> xr.Dataset:
        """All models and what they come to, as arrays (:func:`facegear.drives.assessment_table.model_table`)."""
        wide = self.file.tolerances.widened(self.speeds)
        return model_table(self.outcomes, self.torsion, self.speeds, wide, self._parameters)


def _intervals(found: Sequence[Tongue]) -> Intervals:
    return tuple((tongue.lower, tongue.upper) for tongue in found)
