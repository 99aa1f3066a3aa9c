"""Models of an assessment and what they come to, as arrays: of the disk's motion, each in its basis, and of torsion."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr

from facegear.drives.basis import unstable_share
from facegear.drives.findings import TORSION
from facegear.drives.outcome import Outcome
from facegear.drives.shaft_modes import SettledTorsion
from facegear.maps.tracing import Tongue
from facegear.support.labelled import text, variable
from facegear.support.parameters import rpm

DISK = "disk"
"""Motion of models that have a disk and a direction of the driving force; that of the others is torsion."""


class _Row(NamedTuple):
    """A model: its names, its tongues in a range of speed, and NaN where it has no basis."""

    motion: str
    contact: str
    force: str
    teeth: str
    tongues: Sequence[Tongue]
    speeds: tuple[float, float]
    settled: float = math.nan
    nodal_circles: float = math.nan
    nodal_diameters: float = math.nan
    growth_moved: float = math.nan

    @property
    def fastest(self) -> Tongue | None:
        """Tongue that grows fastest, if there is any."""
        return max(self.tongues, key=lambda tongue: tongue.growth_rate, default=None)


def _row(outcome: Outcome, speeds: tuple[float, float]) -> _Row:
    variant, body = outcome.variant, outcome.variant.model.gear.body
    names = (DISK, variant.contact, variant.force, variant.teeth)
    basis = (float(body.nodal_circles), float(body.nodal_diameters))
    return _Row(*names, outcome.tongues, speeds, float(outcome.settled), *basis, outcome.growth_moved)


def _whether_settled(found: SettledTorsion) -> tuple[float, float, float, float]:
    """Whether modes of shafts suffice, no disk, and by how much growth has moved; NaN where there are no modes."""
    if not found.modes:
        return (math.nan,) * 4
    return float(found.settled), math.nan, math.nan, found.growth_moved


def model_table(
    outcomes: Sequence[Outcome],
    torsion: Mapping[str, SettledTorsion],
    speeds: tuple[float, float],
    wide: tuple[float, float],
    parameters: str,
) -> xr.Dataset:
    """Put all models and what they come to into arrays.

    Parameters
    ----------
    outcomes : sequence of Outcome
        Of the disk's motion.
    torsion : mapping of str to SettledTorsion
        By contact and arm.
    speeds, wide : tuple of float
        Range looked at for the disk, and in torsion [rad/s].
    parameters : str
        Of the drive, for provenance.

    Returns
    -------
    xarray.Dataset
        Over ``model``, the disk's first: ``unstable_share`` [-], ``largest_growth`` [1/s], at ``fastest_speed``
        [rad/s], ``tongues``; ``settled``, the basis, ``nodal_circles`` and ``nodal_diameters``, and ``growth_moved``,
        the part by which the growth differs in the basis before [-], NaN in torsion with massless shafts; motion,
        contact, force and teeth, label of what grows fastest and unstable speeds in rpm as coordinates of text.
    """
    rows = [_row(outcome, speeds) for outcome in outcomes]
    rows += [
        _Row(TORSION, name, "", "", found.tongues, wide, *_whether_settled(found))
        for name, found in torsion.items()
    ]
    fastest = [row.fastest for row in rows]
    unstable = [
        "; ".join(f"{rpm(tongue.lower):.6g} to {rpm(tongue.upper):.6g}" for tongue in row.tongues)
        for row in rows
    ]
    numbers = {
        "unstable_share": ([unstable_share(row.tongues, row.speeds) for row in rows], "1", 0.0, 1e-7),
        "largest_growth": ([each.growth_rate if each else 0.0 for each in fastest], "1/s", 1e-6, 1e-6),
        "fastest_speed": ([each.peak if each else math.nan for each in fastest], "rad/s", 1e-6, 0.0),
        "tongues": ([float(len(row.tongues)) for row in rows], "1", 0.0, 0.1),
        "settled": ([row.settled for row in rows], "1", 0.0, 0.1),
        "nodal_circles": ([row.nodal_circles for row in rows], "1", 0.0, 0.1),
        "nodal_diameters": ([row.nodal_diameters for row in rows], "1", 0.0, 0.1),
        "growth_moved": ([row.growth_moved for row in rows], "1", 1e-4, 1e-4),
    }
    meanings = {
        "unstable_share": "Unstable part of the speeds",
        "largest_growth": "Largest growth rate",
        "fastest_speed": "Speed of the largest growth rate",
        "tongues": "Number of tongues",
        "settled": "1 where the basis suffices",
        "nodal_circles": "Nodal circles of the basis",
        "nodal_diameters": "Nodal diameters of the basis",
        "growth_moved": "Part by which the largest growth rate differs in the basis before",
    }
    names = {
        "motion": "Motion",
        "contact": "Contact, in torsion with the arm of the mesh force",
        "force": "Driving force",
        "teeth": "Teeth",
    }
    return xr.Dataset(
        {
            name: variable("model", values, meanings[name], units, rtol=rtol, atol=atol)
            for name, (values, units, rtol, atol) in numbers.items()
        },
        {
            "model": np.arange(len(rows)),
            **{
                name: text("model", [getattr(row, name) for row in rows], words)
                for name, words in names.items()
            },
            "fastest": text("model", [each.label if each else "" for each in fastest], "What grows fastest"),
            "unstable_rpm": text("model", unstable, "Unstable speeds [rpm]"),
        },
        {"parameters": parameters},
    )
