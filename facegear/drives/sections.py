"""The sections of the report on a drive: what was found, in words, tables and pictures.

Each is made from :class:`facegear.drives.findings.Findings`, which computes what it needs. The page of the command
`facegear report` and the notebook of the book show the same ones.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from facegear.drives import findings, report_columns, report_rows
from facegear.drives.findings import INPUT_STIFFNESS, TORSION, Findings
from facegear.drives.page import Listing, Paragraph, Part, Picture, Section, Table, attempted
from facegear.drives.report_rows import Row
from facegear.drives.verdict import verdict as verdict_of
from facegear.floquet.models import value_of
from facegear.plotting import report as draw
from facegear.plotting.modes import plate_modes as draw_modes
from facegear.support.parameters import rpm

NOTHING_TO_CHANGE = "No tongue: for stability nothing has to change."
_DIGITS = (
    "Natural frequencies are given to as many digits as shafts with all of their modes confirm, and up to the first of "
    "which that is fewer than three."
)
_ADVICE = (findings.power_advice, findings.thickness_advice, findings.change_advice)


def number_table(rows: Sequence[Row], caption: str) -> Table:
    """Rows of quantity, value and unit."""
    shown = tuple((row.quantity, _readable(row.value), row.unit if row.unit != "1" else "") for row in rows)
    return Table(("quantity", "value", "unit"), shown, caption)


def _readable(value: float) -> str:
    """Five digits, four of a fraction, without a power of ten; those of a large number in groups of three."""
    precision = 5 if abs(value) >= 1.0 else 4
    plain = np.format_float_positional(value, precision=precision, fractional=False, trim="-")
    return f"{float(plain):,.0f}".replace(",", "\N{NARROW NO-BREAK SPACE}") if abs(value) >= 1e4 else plain


def verdict(found: Findings) -> Section:
    """Say whether the drive is safe, and what would help."""
    said = verdict_of(found.file, found.cases, None if found.torsional_failure else found.settled_torsion)
    unstable = any(found.tongues.values())
    parts: list[Part] = [
        Paragraph(f"{found.file.name}.", strong=True),
        Paragraph(said.headline, "bad" if unstable or said.in_doubt else "good", strong=True),
        Listing(said.findings),
    ]
    if found.torsional_failure:
        parts.append(
            Paragraph(f"Torsion is left out, it could not be computed: {found.torsional_failure}", "bad")
        )
    if unstable:
        advice = [sentence for advise in _ADVICE for sentence in _tried(advise, found)]
        parts.append(Paragraph(" ".join(advice)))
    elif not said.in_doubt:
        parts.append(Paragraph(NOTHING_TO_CHANGE))
    parts += [
        Paragraph(said.left_out, "bad"),
        Paragraph(
            "Everything holds for the power that the file gives. Two things about a real drive are not known "
            "and decide much: how long a tooth pair stays in mesh (with contact along lines Tregold's contact "
            "ratio, as in the dissertation, or that of the true sweep; with contact at a point that under the "
            "torque of the file or that without load), and whether the tooth force follows the bent rim or "
            "keeps its direction. All four combinations are computed."
        ),
    ]
    return Section("Verdict", tuple(parts))


def _tried(advise: Callable[[Findings], tuple[str, ...]], found: Findings) -> tuple[str, ...]:
    """Advice, or none where what it rests on could not be computed; the section of that says why."""
    try:
        return advise(found)
    except (ArithmeticError, ValueError):
        return ()


def the_drive(found: Findings) -> Section:
    """Describe the drive, and its dimensions."""
    file = found.file
    drive, gear = file.drive, file.transverse.gear
    body, load = gear.body, gear.load
    angles = ", ".join(f"{np.degrees(angle):g}°" for angle in gear.pinion_angles)
    teeth = "rigid teeth" if file.teeth is None else f"flexible teeth (load sharing: {file.teeth.sharing})"
    if file.teeth is not None and file.teeth.sides:
        faces = ", ".join("front" if side > 0 else "back" for side in file.teeth.sides)
        teeth += f", in this order on the faces {faces} of the gear"
        if "back" in faces:
            teeth += f", the teeth of the back {file.teeth.clocking:g} mesh periods ahead (clocking)"
    if file.roles is not None:
        teeth += f", between two gears ({', '.join(file.roles)})"
    low, high = found.range_rpm
    words = (
        f"{drive.pinion_teeth} and {drive.gear_teeth} teeth of module {1e3 * drive.module:g} mm, pressure "
        f"angle {math.degrees(drive.pressure_angle):g}°, shafts at {math.degrees(drive.shaft_angle):g}°; a "
        f"body of h/a = {body.thickness_ratio:g} with a bore of {1e3 * body.bore_radius:g} mm; pinions at "
        f"{angles} with μ = {load.stiffness:g}, ζ = {1e6 * load.damping:g} µs, τ = {load.mass:g}, on {teeth}. "
        f"Operating speeds of the face gear {low:g} to {high:g} rpm."
    )
    table = number_table(report_rows.geometry(file), "Dimensions, contact ratios, masses and stiffnesses")
    return Section("The drive", (Paragraph(words), table))


def unstable_speeds(found: Findings) -> Section:
    """Show at which speeds the drive is unstable and at which it is not."""
    strips = Picture(
        draw.speed_strips(found.tongue_tables, found.range_rpm),
        "Speeds at which the drive is unstable (orange, with the names of the tongues) and at which it is stable "
        "(green), for both contact ratios and both directions of the driving force; the contact ratio that "
        "the file asks for comes first.",
        "Horizontal strips over speed, one for each case, green with orange intervals",
    )
    names = Paragraph(
        "A name such as (1+8)/1 gives the natural frequencies of the mean system that combine, numbered from "
        "the lowest, and how many times the mesh frequency equals their combination. mean 1: natural motion 1 of the "
        "mean system grows by itself, oscillating (flutter); mean 0: what grows by itself does not oscillate "
        "(divergence)."
    )
    rows: list[tuple[str, ...]] = []
    for name, part in found.tongue_tables.items():
        columns = (part[key].values for key in ("label", "lower", "upper", "largest_growth", "peak"))
        for label, lower, upper, growth, peak in zip(*columns, strict=True):
            rows.append((name, str(label), f"{lower:.2f}", f"{upper:.2f}", f"{growth:.3g}", f"{peak:.1f}"))
        if not part.sizes["tongue"]:
            rows.append((name, "none", "", "", "", ""))
    headings = ("model", "tongue", "from [rpm]", "to [rpm]", "fastest growth [1/s]", "at [rpm]")
    tongues = Table(headings, tuple(rows), "Tongues: unstable intervals of speed")
    windows = Table(
        ("model", "stable from [rpm]", "to [rpm]", "width [rpm]"),
        tuple(
            (name, f"{lower:.1f}", f"{upper:.1f}", f"{upper - lower:.1f}")
            for name, part in found.windows.items()
            for lower, upper in zip(part["lower"].values, part["upper"].values, strict=True)
        ),
        "Stable intervals of speed",
    )
    return Section("Unstable speeds and safe ones", (strips, names, tongues, windows))


def bases(found: Findings) -> Section:
    """Say how far the number of modes moves the borders."""
    words = Paragraph(
        "A force at one point calls on all modes of the body. The basis is raised, the bearing being kept as "
        "it is in N/m, until it has all modes up to the mesh frequency at the highest speed and two in succession, "
        f"in a narrow range three, disagree in no more than {100 * found.tolerance:g} % of the speeds and agree on "
        "whether there is a tongue at all, and where there is none on what decays most slowly; at most "
        f"{found.most_steps} are tried."
    )
    rows = []
    for name, *row in zip(*report_columns.basis_columns(found.bases).values(), strict=True):
        circles, diameters, share, moved = row
        told = f"{100 * moved:.1f}" if np.isfinite(moved) else ""
        rows.append((name, str(circles), str(diameters), f"{100 * share:.1f}", told))
    headings = (
        "model",
        "nodal circles",
        "nodal diameters",
        "unstable [% of speeds]",
        "moved [% of speeds]",
    )
    return Section("How sure the borders are", (words, Table(headings, tuple(rows), "Bases that were tried")))


def frequencies(found: Findings) -> Section:
    """Show the natural frequencies of the body."""
    picture = Picture(
        draw_modes(found.modes),
        "Modes (m, n) of the body with m nodal circles and n nodal diameters and their natural frequencies at rest.",
        "Ring-shaped plates coloured by deflection, one for each number of nodal circles and nodal diameters",
    )
    return Section("Natural frequencies of the body", (picture,))


def origins(found: Findings) -> Section:
    """Show where the tongues come from."""
    combined = (
        " and those of their combinations that open a tongue (dashed)"
        if found.combinations["combination"].shape[0]
        else "; no tongue here is opened by a combination of them"
    )
    picture = Picture(
        draw.combinations(found.combinations, found.tongue_tables[found.cases[0].name]),
        f"Mesh frequency over speed against the natural frequencies of the mean transverse system (pale){combined}, "
        "for the first case.",
        "A straight line of mesh frequency crosses dashed curves of combined natural frequencies; thick marks "
        "where it meets them",
    )
    return Section("Where the tongues come from", (picture,))


def maps(found: Findings) -> Section:
    """Show stability over speed and bearing stiffness."""
    pictures = []
    for number, (chart, force) in enumerate(
        ((found.map_follower, "follows the rim"), (found.map_dead, "keeps its direction"))
    ):
        case = found.cases[number]
        own = case.found.model.gear.load.stiffness
        pictures.append(
            Picture(
                draw.growth_map(chart, found.tongue_tables[case.name], own, "bearing stiffness μ"),
                f"Transverse stability over speed and bearing stiffness where the force {force}, in the last "
                "basis. White is stable, colour tells how fast the vibration grows.",
                "Map of growth rates over speed and bearing stiffness with a dashed line at the drive's own "
                "stiffness",
            )
        )
    words = Paragraph(
        "Tongues narrower than a cell show only where a cell hits them. The lists above miss none that the "
        "search can find. The bearing stiffness μ is measured by the stiffness of the disk in the basis of "
        "the map."
    )
    return Section("Maps of stability", (*pictures, words))


def torsion(found: Findings) -> Section:
    """Show the torsional vibration of the gearbox, if the file has one."""
    title = "Torsional vibration"
    # Without its tongues, which may not be there, this section says why.
    if found.torsional_tongues is None or found.torsional_map is None or found.file.torsional is None:
        return Section(title, (Paragraph("The file has no section gearbox."),))
    own = float(value_of(found.file.torsional, INPUT_STIFFNESS))
    axis = "stiffness of the input shaft [kN m/rad]"
    parts: list[Part] = [
        Picture(
            draw.growth_map(found.torsional_map, found.tongue_tables[TORSION], own, axis, 1e-3),
            "Torsional stability over speed and the stiffness of the input shaft. White is stable, colour "
            "tells how fast the vibration grows.",
            "Map of growth rates over speed and stiffness of the input shaft with a dashed line at the drive's own "
            "stiffness",
        ),
        number_table(found.torsional_rows, "Natural frequencies and speeds of the gearbox"),
    ]
    if found.settled_torsion is not None and (basis := found.settled_torsion.basis):
        parts.append(Paragraph(f"{basis} {_DIGITS}"))
    if (count := len(found.file.transverse.gear.pinion_angles)) > 1:
        parts.insert(0, Paragraph(f"In torsion there is one pinion; the drive has {count}."))
    if found.file.play is None:
        parts.append(Paragraph("The file gives the teeth no play (gearbox.backlash_um)."))
    elif found.play is None:
        parts.append(Paragraph("No tongue in torsion: with play near-rest motions stay near rest."))
    else:
        parts += _motions(found)
    if found.damage is None:
        parts.append(Paragraph("The file has no damaged tooth (gearbox.damaged_tooth_percent)."))
    else:
        parts += _damage(found)
    return Section(title, tuple(parts))


def _motions(found: Findings) -> list[Part]:
    """Say what becomes of tongues where teeth have play."""
    moved = found.play
    assert moved is not None
    over = moved["compression"].values / float(moved["static"])
    rows = tuple(
        (str(label), f"{speed:.1f}", "" if np.isinf(times) else f"{times:.2g}", str(motion))
        for label, speed, times, motion in zip(
            moved["label"].values, moved["peak"].values, over, moved["motion"].values, strict=True
        )
    )
    words = Paragraph(
        "The teeth have play (gearbox.backlash_um). What becomes of each tongue: the motion from near rest, "
        "under the torque of one pinion's power, at the speed where the gearbox without play grows fastest. "
        "Larger disturbances may end elsewhere. The compression is the largest of a tooth pair, over that of one pair "
        "under the whole static force: so many times that force does its spring bear."
    )
    headings = ("tongue", "speed [rpm]", "largest compression over the static one", "motion")
    return [words, Table(headings, rows, "Motions of a gearbox whose teeth have play")]


def _damage(found: Findings) -> list[Part]:
    """Say what a damaged tooth would show."""
    signs = found.damage
    assert signs is not None
    columns = (signs[name].values for name in ("speed_rpm", "growth_intact", "growth_damaged", "sideband"))
    rows = tuple(
        (
            f"{speed:.4g}",
            f"{intact:.4g}",
            f"{damaged:.4g}",
            f"{100 * sideband:.3g}" if np.isfinite(sideband) else "",
        )
        for speed, intact, damaged, sideband in zip(*columns, strict=True)
    )
    words = Paragraph(
        "One tooth of the face gear is damaged (gearbox.damaged_tooth_percent), under the torque of one pinion's "
        "power. Flanks are taken as always in contact here, whatever play the file gives. Away from tongues growth "
        "rates hardly tell; the response of a stable gearbox does, by lines at multiples of the revolution beside "
        "those of the mesh. No sideband stands where either gearbox is unstable."
    )
    headings = (
        "speed [rpm]",
        "growth, intact [1/s]",
        "growth, damaged [1/s]",
        "largest sideband of the face gear's angle over its largest mesh harmonic [%]",
    )
    return [words, Table(headings, rows, "What a damaged tooth would show")]


def thickness(found: Findings) -> Section:
    """Say which thickness is stable."""
    words = Paragraph(
        "Above its critical thickness the body is stable at all operating speeds, with the same μ, ζ and τ "
        "and under the same power. Below it, that is below the top of the highest lobe of instability over "
        "thickness, there may be stable thicknesses, too."
    )
    body = found.file.transverse.gear.body
    points = []
    for case, verdict in found.thicknesses:
        if verdict.critical is None:
            points.append(
                f"{case.name}: none was found between 0.4 and 2.5 times the thickness: {verdict.reason}."
            )
            continue
        lobe, below = verdict.critical.lobe, ""
        if body.thickness_ratio < verdict.critical.thickness_ratio and not case.found.tongues:
            below = " The thickness of the file is one of the stable ones below it."
        points.append(f"{case.name}: decided by {lobe.label}, at {rpm(lobe.speed):.1f} rpm.{below}")
    table = number_table(found.thickness_rows, "Critical thickness")
    return Section("Critical thickness", (words, Listing(tuple(points)), table))


def strength(found: Findings) -> Section:
    """Compare stress and power with what is allowed."""
    words = Paragraph(
        "The critical power is that of the disk alone under the driving forces of all pinions (chapter 6 of "
        "the book). Pinions hold the disk and change it."
    )
    stress = number_table(report_rows.strength(found.file), "Stress at the root")
    # Teeth break or not whatever becomes of the disk.
    power = attempted("", lambda: Section("", (number_table(found.powers, "Critical power"), words)))
    return Section("Strength and power", (stress, *power.parts))


def what_to_change(found: Findings) -> Section:
    """Rank what could be changed."""
    parts: list[Part] = [
        Paragraph(
            "A change is rated by what it does to the sum of the widths of all tongues. The best three are "
            "then made in earnest, by ten percent in the better direction (a tenth of the mesh period for a "
            "phase), and all tongues are looked for anew."
        )
    ]
    if not any(found.tongues[name] for name in found.rated):
        parts.append(Paragraph(NOTHING_TO_CHANGE))
        return Section("What to change first", tuple(parts))
    shown = next(name for name in found.rated if found.tongues[name])
    parts.append(
        Picture(
            draw.changes(found.effects[shown]),
            "Change of the unstable width for one percent more of each parameter, or of the mesh period for a phase "
            f"({shown}). Green narrows it.",
            "Horizontal bars, the longest on top, to the left where more of a parameter narrows the tongues",
        )
    )
    rows = []
    for name, effect in found.effects.items():
        keys = ("width_slope", "growth_slope", "width_after", "growth_after")
        for what, *values in zip(
            effect["change_name"].values, *(effect[k].values for k in keys), strict=True
        ):
            told = (f"{value:.3g}" if np.isfinite(value) else "" for value in values)
            rows.append((name, str(what), *told))
    headings = (
        "model",
        "change",
        "per percent more: width [rpm]",
        "growth [1/s]",
        "after ten percent: width [rpm]",
        "growth [1/s]",
    )
    parts.append(Table(headings, tuple(rows), "What each change does to the tongues"))
    return Section("What to change first", tuple(parts))


SECTIONS: tuple[tuple[str, Callable[[Findings], Section]], ...] = (
    ("Verdict", verdict),
    ("The drive", the_drive),
    ("Unstable speeds and safe ones", unstable_speeds),
    ("How sure the borders are", bases),
    ("Natural frequencies of the body", frequencies),
    ("Where the tongues come from", origins),
    ("Maps of stability", maps),
    ("Torsional vibration", torsion),
    ("Critical thickness", thickness),
    ("Strength and power", strength),
    ("What to change first", what_to_change),
)
"""Titles and what makes each section, in the order of the page."""
