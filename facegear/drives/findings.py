"""What a report on a drive finds, part by part: each is computed when it is first asked for, and then kept.

Parts stand alone: one that cannot be computed raises where it is asked for and leaves the others as they are.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import xarray as xr

from facegear.design import changes
from facegear.drives import critical_thickness, report_arrays, report_rows, verdict
from facegear.drives.damage import signs_of_damage
from facegear.drives.drive_file import DriveFile
from facegear.drives.play import motions_in_tongues
from facegear.drives.refusals import told
from facegear.drives.report_rows import Row
from facegear.drives.shaft_modes import SettledTorsion, confirmed, natural_frequencies, settled_torsion
from facegear.floquet.models import Model, value_of
from facegear.maps.tracing import Tongue
from facegear.mechanics.mode_shapes import plate_modes
from facegear.mechanics.torsional import natural_speed
from facegear.support.parameters import rpm
from facegear.support.types import FloatArray

TORSION = "torsion"
"""Name of the torsional model among those of a report."""

INPUT_STIFFNESS = "gearbox.input_stiffness"
"""Parameter that is swept in torsion."""

# Speeds at which it is listened for a damaged tooth.
_LISTENED = 13
# Speeds of the chart of natural frequencies.
_CHARTED = 41
# Widths of tongues that differ by less are the same [rpm].
_SAME_WIDTH = 1e-6


@dataclass(frozen=True, eq=False)
class Findings:
    """All that a report on a drive shows.

    Attributes
    ----------
    file : DriveFile
    cells : int
        Speeds and values of the maps.
    tolerance, most_steps
        As for :func:`facegear.drives.basis.settled_tongues`.
    jobs : int
        Number of processes, as joblib's ``n_jobs``.
    tell : callable
        Called with a line of progress in what takes long.
    """

    file: DriveFile
    cells: int = 60
    tolerance: float = 0.02
    most_steps: int = 5
    jobs: int = -1
    tell: Callable[[str], object] = lambda _: None

    @property
    def speeds(self) -> tuple[float, float]:
        """Lowest and highest speed [rad/s]."""
        return self.file.requirements.speeds

    @property
    def speeds_rpm(self) -> FloatArray:
        """Speeds of the maps [rpm]."""
        low, high = self.range_rpm
        return np.linspace(low, high, self.cells)

    @property
    def range_rpm(self) -> tuple[float, float]:
        """Lowest and highest speed [rpm]."""
        low, high = rpm(np.array(self.speeds)).tolist()
        return low, high

    @property
    def provenance(self) -> str:
        """Parameters as text, for arrays."""
        return report_arrays.describe(self.file)

    @cached_property
    def cases(self) -> tuple[verdict.Case, ...]:
        """Tongues under each contact and each direction of the driving force."""
        settings = {"tolerance": self.tolerance, "most_steps": self.most_steps}
        return verdict.cases(self.file, **settings, jobs=self.jobs, tell=self.tell)  # type: ignore[arg-type]

    @cached_property
    def settled_torsion(self) -> SettledTorsion | None:
        """The gearbox with modes of its shafts enough, and its tongues; None where the file has none."""
        if self.file.torsional is None:
            return None
        return settled_torsion(self.file.torsional, self.speeds, self.tolerance)

    @property
    def torsional_tongues(self) -> tuple[Tongue, ...] | None:
        """Tongues of the gearbox; None where the file has none."""
        return None if self.settled_torsion is None else self.settled_torsion.tongues

    @cached_property
    def torsional_failure(self) -> str:
        """Why the tongues of the gearbox could not be computed; empty where they could, or where there is none."""
        try:
            _ = self.torsional_tongues
        except (ArithmeticError, ValueError) as problem:
            return told(problem)
        return ""

    @cached_property
    def tongues(self) -> dict[str, tuple[Tongue, ...]]:
        """Tongues of each case, and of torsion if there is a gearbox whose tongues could be computed, by name."""
        found = {case.name: case.found.tongues for case in self.cases}
        torsional = None if self.torsional_failure else self.torsional_tongues
        return found if torsional is None else found | {TORSION: torsional}

    @cached_property
    def models(self) -> dict[str, Model]:
        """Models whose tongues there are, those of cases in their last basis."""
        models: dict[str, Model] = {case.name: case.found.model for case in self.cases}
        if TORSION in self.tongues and (torsion := self.settled_torsion) is not None:
            models[TORSION] = torsion.model
        return models

    @cached_property
    def tongue_tables(self) -> dict[str, xr.Dataset]:
        """Tongues of each model as arrays."""
        return {
            name: report_arrays.tongue_table(part, self.provenance) for name, part in self.tongues.items()
        }

    @cached_property
    def windows(self) -> dict[str, xr.Dataset]:
        """Stable intervals of speed of each model."""
        return {
            name: report_arrays.safe_windows(part, self.speeds) for name, part in self.tongue_tables.items()
        }

    @cached_property
    def bases(self) -> xr.Dataset:
        """How the unstable speeds moved from basis to basis."""
        return report_arrays.basis_table(self.cases, self.provenance)

    @cached_property
    def thicknesses(self) -> tuple[tuple[verdict.Case, critical_thickness.ThicknessVerdict], ...]:
        """Critical thickness for the contact that the file asks for, under both directions of the force."""
        chosen = self.cases[:2]
        models = [case.found.model for case in chosen]
        found = critical_thickness.thickness_verdicts(models, self.speeds, jobs=self.jobs)
        return tuple(zip(chosen, found, strict=True))

    @cached_property
    def rated(self) -> tuple[str, ...]:
        """Models whose changes are ranked: the first case that has a tongue, and torsion."""
        first = [name for name, part in self.tongues.items() if part and name != TORSION][:1]
        return (*first, *(name for name in (TORSION,) if name in self.models))

    @cached_property
    def effects(self) -> dict[str, xr.Dataset]:
        """What each change does to the tongues of the rated models."""
        return {
            name: changes.effects_of_changes(
                self.models[name], self.tongues[name], self.speeds, self.provenance
            )
            for name in self.rated
        }

    @cached_property
    def powers(self) -> tuple[Row, ...]:
        """Critical power of the disk alone against that of the drive."""
        return report_rows.flutter(self.cases[0].found.model, self.file.requirements)

    @cached_property
    def modes(self) -> xr.Dataset:
        """Modes of the body and their natural frequencies."""
        return plate_modes(self.file.transverse.gear.body)

    @cached_property
    def combinations(self) -> xr.Dataset:
        """Mesh frequency against natural frequencies of the first case."""
        first, (low, high) = self.cases[0].found, self.range_rpm
        charted = np.linspace(low, high, _CHARTED)
        return report_arrays.combinations(first.model, first.tongues, charted, self.provenance)

    @cached_property
    def map_follower(self) -> xr.Dataset:
        """Stability over speed and bearing stiffness of the first case, whose force follows the rim."""
        return self._map_of(0)

    @cached_property
    def map_dead(self) -> xr.Dataset:
        """Stability over speed and bearing stiffness of the second case, whose force keeps its direction."""
        return self._map_of(1)

    def _map_of(self, number: int) -> xr.Dataset:
        model = self.cases[number].found.model
        highest = 2.0 * max(model.gear.load.stiffness, 0.5)
        return self._map(model, "stiffness", highest)

    @cached_property
    def torsional_map(self) -> xr.Dataset | None:
        """Stability over speed and stiffness of the input shaft; None where there is no gearbox."""
        if self.settled_torsion is None:
            return None
        torsional = self.settled_torsion.model
        own = float(value_of(torsional, INPUT_STIFFNESS))
        return self._map(torsional, INPUT_STIFFNESS, 2.0 * own)

    def _map(self, model: Model, parameter: str, highest: float) -> xr.Dataset:
        values = highest * np.arange(1, self.cells + 1) / self.cells
        return report_arrays.growth_map(
            model, parameter, values, self.speeds_rpm, self.provenance, jobs=self.jobs
        )

    @cached_property
    def play(self) -> xr.Dataset | None:
        """Motions in the tongues of a gearbox whose teeth have play; None where there are none."""
        if self.file.play is None or not self.torsional_tongues:
            return None
        return motions_in_tongues(self.file.play, self.torsional_tongues, self.provenance)

    @cached_property
    def damage(self) -> xr.Dataset | None:
        """What the damaged tooth of the file would show, at a few speeds; None where none is damaged."""
        if self.file.cracked is None:
            return None
        low, high = self.range_rpm
        return signs_of_damage(self.file.cracked, np.linspace(low, high, _LISTENED), self.provenance)

    @cached_property
    def torsional_rows(self) -> tuple[Row, ...]:
        """Natural frequencies and speeds of the gearbox; empty where there is none."""
        if self.settled_torsion is None:
            return ()
        torsional = self.settled_torsion.model
        natural = natural_frequencies(torsional)
        frequencies = [each / (2 * math.pi) for each in natural]
        met = [rpm(natural_speed(self.file.drive, each)) for each in natural]
        quantities = (
            ("natural frequency", "Hz", frequencies),
            ("natural speed (mesh frequency = natural frequency)", "rpm", met),
        )
        return tuple(
            Row(f"torsional {quantity} {k}", confirmed(*pair), unit)
            for quantity, unit, values in quantities
            for k, pair in enumerate(zip(*(each.tolist() for each in values), strict=True), start=1)
        )

    @cached_property
    def thickness_rows(self) -> tuple[Row, ...]:
        """Critical thicknesses that were found."""
        body = self.file.transverse.gear.body
        found = (
            (case.name, thickness.critical.thickness_ratio)
            for case, thickness in self.thicknesses
            if thickness.critical is not None
        )
        return tuple(
            row
            for name, ratio in found
            for row in (
                Row(f"critical thickness ratio h/a, {name}", ratio, "1"),
                Row(f"critical thickness, {name}", 1e3 * ratio * body.outer_radius, "mm"),
                Row(f"thickness over critical thickness, {name}", body.thickness_ratio / ratio, "1"),
            )
        )


# --- what would help, in words ------------------------------------------------------------------------------------


def power_advice(found: Findings) -> tuple[str, ...]:
    """Say from which power on the disk alone flutters."""
    each = verdict.powered(found.file.transverse)
    critical = found.powers[1].value
    return (f"The disk alone flutters from {critical:.4g} kW a {each} on, where the force follows the rim.",)


def thickness_advice(found: Findings) -> tuple[str, ...]:
    """Say which thickness makes unstable cases stable."""
    here = found.file.transverse.gear.body.thickness_ratio
    return tuple(
        f"With h/a above {thickness.critical.thickness_ratio:.4g} (now {here:.4g}) the body is stable at all speeds in "
        f"the case “{case.name}”."
        for case, thickness in found.thicknesses
        if thickness.critical is not None and case.found.tongues
    )


def change_advice(found: Findings) -> tuple[str, ...]:
    """Say which small change helps most."""
    return tuple(
        sentence
        for name, effect in found.effects.items()
        for sentence in best_change(name, effect, found.tongues[name])
    )


def best_change(name: str, effect: xr.Dataset, tongues: Sequence[Tongue]) -> list[str]:
    """Say which of the changes that were made in earnest helps a model of that name most, if one does."""
    widths, growths = effect["width_after"].values, effect["growth_after"].values
    now = float(rpm(changes.unstable_width(tongues)))
    growth = max((tongue.growth_rate for tongue in tongues), default=0.0)
    # A change that narrows the tongues and makes them grow faster is no help.
    helpful = np.flatnonzero((widths <= now + _SAME_WIDTH) & (growths < growth))
    if not helpful.size:
        return []
    best = min(helpful, key=lambda place: (widths[place].round(6), growths[place]))
    slope = float(effect["width_slope"][best]) or float(effect["growth_slope"][best])
    what = f"ten percent {'more' if slope < 0 else 'less'} of {effect['change_name'].values[best]}"
    width = f"the unstable width from {now:.4g} to {widths[best]:.4g} rpm and "
    if abs(widths[best] - now) <= _SAME_WIDTH:
        width = ""
    return [
        f"Of small changes that do not make it grow faster {what} helps most: it takes {width}the largest growth "
        f"from {growth:.3g} to {growths[best]:.3g} 1/s ({name})."
    ]
