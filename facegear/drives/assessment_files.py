"""An assessment as a page, with its table and arrays beside it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from facegear.drives.assess import Assessment, Outcome
from facegear.drives.findings import TORSION
from facegear.drives.page import Listing, Paragraph, Picture, Section, Table, page
from facegear.plotting import assessment as draw
from facegear.support import labelled
from facegear.support.files import folder_written_whole
from facegear.support.parameters import rpm
from facegear.support.tables import write_table

PAGE = "assessment.html"
"""Name of the page among the files of an assessment."""


def sections(found: Assessment) -> tuple[Section, ...]:
    """Sections of the page: verdict, models, tolerances, dynamic load, what was left out."""
    return tuple(make(found) for make in (_verdict, _models, _tolerances, _dynamic_load, _left_out))


def _verdict(found: Assessment) -> Section:
    good = found.verdict == "safe under all"
    parts: list[Paragraph | Listing] = [
        Paragraph(f"{found.file.name}.", strong=True),
        Paragraph(found.headline, "good" if good else "bad", strong=True),
    ]
    said = [*found.over_tolerances, found.dynamic_load, found.change]
    parts.append(Listing(tuple(sentence for sentence in said if sentence)))
    parts.append(Paragraph(found.not_varied, "bad"))
    return Section("Verdict", tuple(parts))


def _in_rpm(intervals: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    return [(float(rpm(start)), float(rpm(stop))) for start, stop in intervals]


def _group_of(outcome: Outcome) -> str:
    """Contact and direction of the force of a model, in words."""
    return f"{outcome.variant.contact}, {outcome.variant.force}"


def _models(found: Assessment) -> Section:
    groups: dict[str, dict[str, list[tuple[float, float]]]] = {}
    for outcome in found.outcomes:
        group = groups.setdefault(_group_of(outcome), {})
        group[outcome.variant.teeth] = _in_rpm([(tongue.lower, tongue.upper) for tongue in outcome.tongues])
    if found.torsion:
        groups["torsion"] = {
            name: _in_rpm([(tongue.lower, tongue.upper) for tongue in part])
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
        "Stable and unstable speeds under every model, the file's own contact and teeth first. The last strip: "
        "stable under all (tolerances included), unstable under all of the disk's motion or all of torsion, or "
        "depending on the model.",
        "Horizontal strips over speed, one for each model, green with red intervals; a last one in three colours",
    )
    places, table = {group: place for place, group in enumerate(groups)}, found.table()
    rows = tuple(
        (
            *(str(table[name].values[i]) for name in ("contact", "force", "teeth")),
            f"{100 * float(table['unstable_share'][i]):.3g}",
            f"{float(table['largest_growth'][i]):.3g}",
            "yes" if table["settled"].values[i] else "NO",
        )
        for i in sorted(range(len(found.outcomes)), key=lambda i: places[_group_of(found.outcomes[i])])
    )
    headings = (
        "contact",
        "driving force",
        "teeth",
        "unstable [% of speeds]",
        "fastest growth [1/s]",
        "settled",
    )
    return Section("Models", (strips, Table(headings, rows, "Models and what they come to")))


def _tolerances(found: Assessment) -> Section:
    title = "Tolerances"
    if not found.worst:
        return Section(title, (Paragraph("The file has no section tolerances."),))
    tables = tuple(_corners([name for name in found.worst if name != TORSION], found, "Corners of the range"))
    if TORSION in found.worst:
        tables += tuple(_corners([TORSION], found, "Corners of the range in torsion"))
    words = Paragraph(
        "Of the file's own contact and teeth. Between these corners a tongue that stands at both ends of a way has "
        "swept all speeds between; where all are stable the largest growth is followed along the edges of the range."
    )
    return Section(title, (words, Listing(found.over_tolerances), *tables))


def _corners(names: Sequence[str], found: Assessment, caption: str) -> Iterator[Table]:
    """Give the corners of worst cases that have factors of the same."""
    cases = {name: found.worst[name] for name in names if found.worst[name].corners}
    if not cases:
        return
    rows = tuple(
        (
            name,
            *(f"{factor:g}" for factor in factors),
            ", ".join(f"{rpm(t.lower):.4g} to {rpm(t.upper):.4g}" for t in tongues) or "none",
        )
        for name, case in cases.items()
        for factors, tongues in case.corners.items()
    )
    factors = next(iter(cases.values())).factors
    yield Table(("model", *(f"{words}, times" for words in factors), "unstable [rpm]"), rows, caption)


def _dynamic_load(found: Assessment) -> Section:
    title = "Dynamic load"
    if found.response is None:
        return Section(title, (Paragraph("It is computed in torsion, for files with a section gearbox."),))
    picture = Picture(
        draw.dynamic_load(found.response, found.static_force),
        "Forces between teeth under the torque of one pinion's power, over speed; none where the gearbox is unstable. "
        "The axis is linear near zero and logarithmic beyond.",
        "Two curves over speed that part near resonances",
    )
    return Section(title, (Paragraph(f"{found.dynamic_load}"), picture))


def _left_out(found: Assessment) -> Section:
    return Section("Left out", (Listing((*found.left_out, found.not_varied)),))


def write_assessment(found: Assessment, folder: str | Path) -> Path:
    """Write the page of an assessment, its table and its arrays; all of it appears at once, or nothing.

    Parameters
    ----------
    found : Assessment
    folder : str or Path
        If it is there already, files of the same name are replaced, and others stay.

    Returns
    -------
    Path
        The page.

    Raises
    ------
    OSError
        If the folder cannot be written to.
    """
    table = found.table()
    columns = {name: table[name].values.tolist() for name in ("contact", "force", "teeth", *table.data_vars)}
    with folder_written_whole(Path(folder)) as place:
        write_table(columns, place / "models.csv")
        labelled.save(table, place / "models.nc")
        title = f"Assessment of {found.file.name}"
        (place / PAGE).write_text(page(title, sections(found)), encoding="utf-8")
    return Path(folder, PAGE)
