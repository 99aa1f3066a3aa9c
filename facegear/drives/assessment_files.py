"""An assessment as a page, with its table and arrays beside it."""

from __future__ import annotations

import errno
import math
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
import xarray as xr

from facegear.drives.assessment import SAFE, Assessment
from facegear.drives.assessment_columns import corner_columns, model_columns, peak_columns, response_columns
from facegear.drives.assessment_table import DISK
from facegear.drives.basis import unstable_share
from facegear.drives.disk_response_words import rounded
from facegear.drives.findings import TORSION
from facegear.drives.growth_words import told
from facegear.drives.outcome import Outcome
from facegear.drives.page import Listing, Paragraph, Picture, Section, Table, page
from facegear.drives.report_arrays import describe
from facegear.drives.report_files import foreign
from facegear.drives.shaft_modes import SettledTorsion
from facegear.drives.tolerance_cells import FINE, HALF, MOST, Factors
from facegear.drives.torsion_response import peaks_table, response_table
from facegear.drives.variants import Variant
from facegear.drives.worst_case import WorstCase
from facegear.maps.tracing import Tongue
from facegear.plotting import assessment as draw
from facegear.support import labelled
from facegear.support.files import folder_written_whole
from facegear.support.parameters import rpm
from facegear.support.tables import write_table

# Resonances of each model that the page names.
_PEAKS = 5
# Values in tolerances shown on the page, of each table.
_MOST_VALUES = 40
# Headings of what grows fastest.
_FASTEST = ("fastest", "growth [1/s]")
_BASIS = "nodal circles, diameters"
_WORDS = (
    "Contact: Tregold, the contact ratio of contact at a point; true sweep, that of lines which cross the whole face; "
    "under load, that of teeth which give way under it.",
    "Driving force: it follows the rim as that bends, or keeps its direction in space.",
    "Rate: frozen, dampers and masses feel how fast the disk moves at a place that stands still; total, how fast it "
    "moves under the contact as that travels.",
    "Load sharing of flexible teeth: centroid, one load at the mean contact point; equal, each pair the "
    "same; length, each as its line is long, so that the mesh is as stiff as the lines are; length_share, each its "
    "part of the length of all, so that the mesh is as stiff at all times.",
    "(1+8)/1: natural motions 1 and 8, numbered by frequency, whose frequencies make up once the mesh frequency; "
    "(8-1)/1: their difference does. mean 1: natural motion 1 grows by itself, oscillating (flutter); "
    "mean 0: what grows by itself does not oscillate (divergence).",
    "10/1: natural motion 10 in resonance with the first harmonic of the mesh.",
)

PAGE = "assessment.html"
"""Name of the page among the files of an assessment."""

_ARRAYS = ("models", "torsion_response", "torsion_response_peaks", "disk_response", "disk_response_peaks")
_TABLES = ("models", "tolerances", "disk_response", "disk_response_peaks")
FILES = (PAGE, *(f"{name}.nc" for name in _ARRAYS), *(f"{name}.csv" for name in _TABLES))
"""Names of all files that an assessment may have."""


def sections(found: Assessment) -> tuple[Section, ...]:
    """Sections of the page: verdict, models, tolerances, dynamic load, what was left out, words."""
    parts = tuple(make(found) for make in (_verdict, _models, _tolerances, _dynamic_load, _left_out))
    return (*parts, Section("Words", (Listing(_WORDS),)))


def _verdict(found: Assessment) -> Section:
    good = found.verdict == SAFE and not found.parting
    # What decides stands out; the sentences after it are many.
    first, dot, rest = found.headline.partition(". ")
    parts: list[Paragraph | Listing] = [
        Paragraph(f"{found.file.name}.", strong=True),
        Paragraph(first + dot, "good" if good else "bad", strong=True),
    ]
    if rest:
        parts.append(Paragraph(rest, "good" if good else "bad"))
    # Forced responses stand in their own section alone.
    said = [*found.over_tolerances, found.dynamic_load, found.change]
    parts.append(Listing(tuple(sentence for sentence in said if sentence)))
    parts.append(Paragraph(found.not_varied, "bad"))
    return Section("Verdict", tuple(parts))


def _in_rpm(intervals: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    return [(float(rpm(start)), float(rpm(stop))) for start, stop in intervals]


def _group_of(outcome: Outcome) -> str:
    """Contact and direction of the force of a model, in words."""
    return f"{outcome.variant.contact}, {outcome.variant.force}"


def _basis_of(variant: Variant) -> str:
    """Nodal circles and diameters of a model, in words."""
    body = variant.model.gear.body
    return f"{body.nodal_circles}, {body.nodal_diameters}"


def _models(found: Assessment) -> Section:
    groups: dict[str, dict[str, list[tuple[float, float]]]] = {}
    for outcome in found.outcomes:
        group = groups.setdefault(_group_of(outcome), {})
        group[outcome.variant.teeth] = _in_rpm([(tongue.lower, tongue.upper) for tongue in outcome.tongues])
    if found.torsion:
        groups["torsion"] = {
            name: _in_rpm([(tongue.lower, tongue.upper) for tongue in part.tongues])
            for name, part in found.torsion.items()
        }
    low, high = found.speeds
    strips = Picture(
        draw.model_strips(
            groups,
            _in_rpm(found.always_stable),
            _in_rpm(found.always_unstable),
            (float(rpm(low)), float(rpm(high))),
        ),
        "Stable (pale) and unstable speeds under every model, the file's own contact and teeth first. The last strip: "
        "stable under all (the file's own one within its tolerances), unstable under all of the disk's "
        "motion or all of torsion, or depending on the model.",
        "Horizontal strips over speed, one for each model, green with red intervals; a last one in three colours",
    )
    names = ("motion", "contact", "driving force", "teeth", "unstable [% of speeds]", "unstable [rpm]")
    headings = (*names, *_FASTEST, _BASIS, "settled")
    words = Paragraph(
        "Settled: the unstable speeds of two bases agree, of which the larger has all modes of the disk up to the mesh "
        "frequency; in a narrow range of three, also if borders beside it came nearer by twice as much as they moved. "
        "Where nothing is unstable, what decays most slowly must still decay if its rate moved on by as much. "
        "In torsion: those with half the modes of the shafts and with all. Growth rates are those of the basis that "
        "stands beside them; in brackets, by how much of itself the largest differs in the basis before."
    )
    table = Table(headings, _model_rows(found), "Models and what they come to")
    return Section("Models", (strips, words, table))


def _model_rows(found: Assessment) -> tuple[tuple[str, ...], ...]:
    """Rows of the table of models, by contact and force, those of torsion last."""
    places: dict[str, int] = {}
    for outcome in found.outcomes:
        places.setdefault(_group_of(outcome), len(places))
    order = sorted(found.outcomes, key=lambda outcome: places[_group_of(outcome)])
    disk = (
        (
            DISK,
            *(outcome.variant.contact, outcome.variant.force, outcome.variant.teeth),
            *_what_grows(outcome.tongues, found.speeds),
            _basis_of(outcome.variant),
            _settled(outcome),
        )
        for outcome in order
    )
    wide = found.file.tolerances.widened(found.speeds)
    motion = TORSION
    if found.file.tolerances.speed:
        motion += f", {rpm(wide[0]):.4g} to {rpm(wide[1]):.4g} rpm"
    torsion = (
        (motion, name, "", "", *_what_grows(part.tongues, wide), *_shafts(part))
        for name, part in found.torsion.items()
    )
    return (*disk, *torsion)


def _shafts(found: SettledTorsion) -> tuple[str, str]:
    """Modes of shafts with mass, and whether they suffice."""
    return (found.modes, _settled(found)) if found.modes else ("", "")


def _settled(outcome: Outcome | SettledTorsion) -> str:
    """Say whether unstable speeds stand still, and how far the largest growth rate has moved."""
    words = "yes" if outcome.settled else "NO"
    return words if math.isnan(outcome.growth_moved) else f"{words} ({100 * outcome.growth_moved:.2g} %)"


def _what_grows(found: Sequence[Tongue], speeds: tuple[float, float]) -> tuple[str, ...]:
    """Part of the speeds that is unstable, the widest intervals, and what grows fastest."""
    where = told(tuple((tongue.lower, tongue.upper) for tongue in found)) if found else "none"
    return f"{100 * unstable_share(found, speeds):.3g}", where.replace(" rpm", ""), *_fastest(found)


def _tolerances(found: Assessment) -> Section:
    title = "Tolerances"
    if not found.worst:
        return Section(title, (Paragraph("The file has no section tolerances."),))
    tables = tuple(
        _at_values([name for name in found.worst if name != TORSION], found, "Values in the range")
    )
    if TORSION in found.worst:
        tables += tuple(_at_values([TORSION], found, "Values in the range, in torsion"))
    words = Paragraph(
        "Of the file's own contact and teeth, of the disk in the smaller of two bases that agree at the values of the "
        "file, or in the last one if none do. At both ends of each damping, and at values of each stiffness as close "
        "together as it took, over speeds so wide that no tongue comes into the range from outside unseen. Natural "
        "frequencies rise with every stiffness: a tongue that stands at neighbouring values has swept all speeds "
        "between its places. One that stands at some of them only, or between them where it is better tuned, is looked "
        f"for with {HALF:g} times the damping as well: where anything stands then, the values are taken closer, down "
        f"to {100 * (FINE - 1):.3g} % of the stiffness, and there it is looked for with {MOST:g} times the damping. "
        "Speeds at which something stands even so, or at which two resonances meet, or for which the work allowed was "
        "not enough, are not known. Stable are those at which nothing stands: a resonance whose strength doubles "
        "within a part of a step would still be missed. Where the contact ratio depends on the load, values are as "
        "close together as its change asks for. Between the values something may also grow faster than at any."
    )
    return Section(title, (words, Listing(found.over_tolerances), *tables))


def _at_values(names: Sequence[str], found: Assessment, caption: str) -> Iterator[Table]:
    """Give the values of worst cases that have factors of the same."""
    cases = {name: found.worst[name] for name in names if found.worst[name].points}
    if not cases:
        return
    points = [(name, *point) for name, case in cases.items() for point in case.points.items()]
    shown = sorted(points, key=lambda row: -max((t.growth_rate for t in row[2]), default=0.0))[:_MOST_VALUES]
    rows = tuple(
        (
            name,
            *(f"{factor:.4g}" for factor in factors),
            ", ".join(f"{rpm(t.lower):.4g} to {rpm(t.upper):.4g}" for t in tongues) or "none",
            _where(cases[name], factors),
            *_fastest(tongues),
        )
        for name, factors, tongues in points
        if any(row[:2] == (name, factors) for row in shown)
    )
    if len(points) > len(shown):
        caption += (
            f"; of {len(points)} the {len(shown)} at which something grows fastest, all are in tolerances.csv"
        )
    factors = next(iter(cases.values())).factors
    headings = (
        "model",
        *(f"{words}, times" for words in factors),
        "unstable [rpm]",
        "looked at [rpm]",
        *_FASTEST,
    )
    yield Table(headings, rows, caption)


def _where(case: WorstCase, factors: Factors) -> str:
    """Say in which part of the range some values were looked at."""
    parts = case.looked_at.get(factors, (case.speeds,))
    return "all" if parts == (case.speeds,) else told(parts).replace(" rpm", "")


def _fastest(found: Sequence[Tongue]) -> tuple[str, str]:
    """Label of the tongue that grows fastest and its growth rate."""
    if not found:
        return "none", "0"
    tongue = max(found, key=lambda each: each.growth_rate)
    return tongue.label, f"{tongue.growth_rate:.3g}"


def _dynamic_load(found: Assessment) -> Section:
    parts: list[Paragraph | Picture | Table | Listing] = [*_in_torsion(found), *_of_the_disk(found)]
    return Section("Dynamic load", tuple(parts))


def _in_torsion(found: Assessment) -> Iterator[Paragraph | Picture]:
    if found.response is None:
        yield Paragraph("In torsion it is computed for files with a section gearbox.")
        return
    yield Picture(
        draw.dynamic_load(found.response, found.static_force),
        "Forces between teeth in torsion under the torque of one pinion's power, over speed, and at its resonances "
        "between the speeds; none where the gearbox is unstable. Where forces go beyond a hundred times the static one "
        "the axis is logarithmic away from zero.",
        "Two curves over speed that part near resonances",
    )


def _of_the_disk(found: Assessment) -> Iterator[Paragraph | Picture | Table | Listing]:
    yield Paragraph(
        "The disk is shaken by the static transmission error: what teeth give way under the constant load of the "
        "drive, less its mean, as pairs come and go. Forces are those of all pairs of a mesh, along the normal."
    )
    yield Listing(found.forced)
    computed = {
        f"{each.variant.teeth}; {each.variant.force}": each.data
        for each in found.disk_responses
        if each.data is not None
    }
    if not computed:
        return
    yield Picture(
        draw.disk_forces(computed, found.static_force),
        f"Force of a mesh, lowest and highest over a mesh period, over the static one, with the file's own contact "
        f"({found.disk_responses[0].variant.contact}); below zero flanks part. Triangles: resonances between the "
        "speeds. None where the model is unstable.",
        "Bands over speed around one that widen at resonances",
    )
    rows = tuple(
        (
            f"{each.variant.teeth}; {each.variant.force}",
            *peak,
            _basis_of(each.variant),
            "yes" if each.settled else "NO",
        )
        for each in found.disk_responses
        if each.data is not None
        for peak in _highest_peaks(each.data, 3 if each.settled else 2)
    )
    if rows:
        caption = f"Highest resonances of the force of a mesh, at most {_PEAKS} of each model"
        forces = ("rms of what varies of the force [N]", "lowest less static [N]", "highest less static [N]")
        headings = ("model", "mode / harmonic of the mesh", "speed [rpm]", *forces)
        yield Table((*headings, _BASIS, "settled"), rows, caption)


def _highest_peaks(data: xr.Dataset, digits: int) -> Iterator[tuple[str, ...]]:
    """Label, speed [rpm], rms, lowest and highest force [N] of the highest peaks, the highest first."""
    for i in np.argsort(-data["peak_force_rms"].values)[:_PEAKS].tolist():
        yield (
            str(data["peak_label"].values[i]),
            rounded(float(rpm(data["peak_speed"].values[i])), digits + 1),
            *(
                rounded(float(data[f"peak_force_{name}"].values[i]), digits)
                for name in ("rms", "lowest", "highest")
            ),
        )


def _left_out(found: Assessment) -> Section:
    return Section("Left out", (Listing((*_failures(found.failed), *found.left_out, found.not_varied)),))


def _failures(failed: Sequence[str]) -> list[str]:
    return [f"A model that could not be computed: {each}" for each in failed]


def write_assessment(found: Assessment, folder: str | Path) -> Path:
    """Write the page of an assessment, its table and its arrays; all of it appears at once, or nothing.

    Parameters
    ----------
    found : Assessment
    folder : str or Path
        If it is there already, files of an earlier assessment are replaced or removed, and others stay.

    Returns
    -------
    Path
        The page.

    Raises
    ------
    OSError
        If the folder cannot be written to, or has files of these names that no assessment wrote.
    """
    if reason := foreign(Path(folder), FILES):
        raise FileExistsError(errno.EEXIST, reason, str(folder))
    table = found.table()
    with folder_written_whole(Path(folder), FILES) as place:
        write_table(model_columns(table), place / "models.csv")
        labelled.save(table, place / "models.nc")
        if found.response is not None:
            parameters = describe(found.file)
            labelled.save(response_table(found.response, parameters), place / "torsion_response.nc")
            if (peaks := peaks_table(found.response, parameters)) is not None:
                labelled.save(peaks, place / "torsion_response_peaks.nc")
        if any(case.points for case in found.worst.values()):
            write_table(corner_columns(found.worst), place / "tolerances.csv")
        if (response := found.response_table) is not None:
            labelled.save(response, place / "disk_response.nc")
            write_table(response_columns(response), place / "disk_response.csv")
        if (of_disk := found.response_peaks) is not None:
            labelled.save(of_disk, place / "disk_response_peaks.nc")
            write_table(peak_columns(of_disk), place / "disk_response_peaks.csv")
        title = f"Assessment of {found.file.name}"
        (place / PAGE).write_text(page(title, sections(found)), encoding="utf-8")
    return Path(folder, PAGE)
