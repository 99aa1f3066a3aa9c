"""Compute the anchors of chapter 3 and write them to data/anchors: `python -m tests.independent.make_anchors`.

Takes some minutes; nothing here imports facegear.
"""

import math
import sys
from pathlib import Path
from types import SimpleNamespace

import yaml
from mpmath import mpf
from tqdm import tqdm

from tests.independent import meshing_mpmath as independent
from tests.independent import shaper_envelope

FOLDER = Path(__file__).resolve().parents[2] / "data" / "anchors"
ROUTE = (
    "tests/independent/meshing_mpmath.py: the shaper moved by three rotations, contact where its velocity has no "
    "component along the numerical normal, 30 digits; lengths by quadrature, limits from the singular surface; beyond "
    "90 degrees the contact ratio by shaper_envelope.py, a shaper as a solid held against the points of the flank"
)
# What is left of the fourth-order differences in 30 digits is far below: the tolerance is that of double precision.
LENGTH, ANGLE, NUMBER = 1e-11, 1e-10, 1e-10
# A point that is just not cut, found by sampling the motion finer and finer about its deepest instant.
BRUTE_FORCE = 1e-9

CASE_1 = independent.Drive(26, 130, "3.175e-3")


def anchor(variable, value, atol, **at):
    return {
        "variable": variable,
        "at": {k: float(v) for k, v in at.items()},
        "value": float(value),
        "atol": atol,
    }


def rotation_at(share):
    first, last = independent.sweep(CASE_1)
    return first + (last - first) * mpf(share)


def line_at(share):
    line = independent.ContactLine(CASE_1, rotation_at(share))
    radius, angle = line.midpoint
    return line, line.length, radius, angle


def tooth():
    for step in (2, 4, 6, 8, 10):
        share = mpf(step) / 12
        line, length, radius, angle = line_at(share)
        yield anchor("length", length, LENGTH, fraction=share)
        yield anchor("contact_radius", radius, LENGTH, fraction=share)
        yield anchor("contact_angle", angle, ANGLE, fraction=share)
        for roll, point in ((line.start, 0), (line.end, 32)):
            end = CASE_1.to_gear(
                line.rotation, CASE_1.shaper_point(roll, CASE_1.u_of_contact(roll, line.rotation))
            )
            for axis in range(3):
                yield anchor("line", end[axis], LENGTH, fraction=share, point=point, axis=axis)


def travel(contact_ratio):
    """Travel about the gear's axis over that of the true sweep, when the gear turns by this many pitches meanwhile."""
    return mpf(contact_ratio) / independent.geometric_contact_ratio(CASE_1)


def positions():
    # Age of the pair in mesh periods over the contact ratio 1.5 is its share of the sweep.
    for pair, time in ((1, "0.45"), (1, "0.9"), (1, "1.35"), (2, "1.35"), (3, "2.7"), (4, "3.6")):
        _, _, radius, angle = line_at((mpf(time) - pair + 1) / mpf("1.5"))
        yield anchor("radius", radius, LENGTH, pair=pair, time=time)
        yield anchor("angle", angle * travel("1.5"), ANGLE, pair=pair, time=time)


def instants():
    for instant, pairs in (("0.25", (1, 2)), ("0.75", (1,))):
        for pair in pairs:
            _, length, radius, angle = line_at((mpf(instant) + pair - 1) / mpf("1.5"))
            yield anchor("length", length, LENGTH, instant=instant, pair=pair)
            yield anchor("point_across", radius * independent.sin(angle), LENGTH, instant=instant, pair=pair)
            yield anchor("point_radial", radius * independent.cos(angle), LENGTH, instant=instant, pair=pair)
        radius, angle = independent.contact_centroid(CASE_1, instant, "1.5")
        yield anchor("centroid_across", radius * independent.sin(angle), LENGTH, instant=instant)
        yield anchor("centroid_radial", radius * independent.cos(angle), LENGTH, instant=instant)


def motion():
    for time in ("0.02", "0.2", "0.45", "0.6", "0.9"):
        radius, angle = independent.contact_centroid(CASE_1, time, "1.5")
        for shift in (0, 1):
            yield anchor("centroid_radius", radius, LENGTH, time=mpf(time) + shift)
            yield anchor("centroid_angle", angle * travel("1.5"), ANGLE, time=mpf(time) + shift)


def total_length(contact_ratio):
    for time in ("0.1", "0.5", "0.8"):
        pair, total = 0, mpf(0)
        while mpf(time) + pair < contact_ratio:
            share = (mpf(time) + pair) / contact_ratio
            total += independent.ContactLine(CASE_1, rotation_at(share)).length
            pair += 1
        yield anchor("total_length", total, LENGTH, time=time)


def skew_lines():
    inner, outer = independent.inner_limit(CASE_1), independent.outer_limit(CASE_1)
    for pair, time in ((1, "0.0"), (1, "0.7"), (1, "1.4"), (2, "1.4"), (3, "2.8"), (3, "3.5")):
        share = (mpf(time) - pair + 1) / mpf("1.5")
        yield anchor("skew_radius", outer + (inner - outer) * share, LENGTH, pair=pair, time=time)
    for time in ("0.7", "1.4"):
        yield anchor("radius", line_at(mpf(time) / mpf("1.5"))[2], LENGTH, pair=1, time=time)


def contact_ratios():
    for teeth in (20, 22, 26, 31, 35, 40):
        drive = independent.Drive(teeth, 5 * teeth, "3.175e-3")
        yield anchor("contact_ratio", independent.tregold_contact_ratio(drive), NUMBER, pinion_teeth=teeth)
        if teeth in (22, 26, 31):
            ratio = independent.geometric_contact_ratio(drive)
            yield anchor("geometric_contact_ratio", ratio, NUMBER, pinion_teeth=teeth)


def shaft_angles():
    for shaft in (60, 75, 90, 105, 120):
        drive = independent.Drive(26, 130, "3.175e-3", 25, shaft)
        sine = independent.sin(drive.shaft_angle)
        yield anchor("inner_radius", independent.inner_limit(drive) * sine, LENGTH, shaft_angle_deg=shaft)
        yield anchor("outer_radius", independent.outer_limit(drive) * sine, LENGTH, shaft_angle_deg=shaft)
        yield anchor("contact_ratio", independent.tregold_contact_ratio(drive), NUMBER, shaft_angle_deg=shaft)
        if shaft > 90:
            # The shaper cuts the flank again: brute force, in double precision.
            plain = SimpleNamespace(
                pinion_teeth=26,
                gear_teeth=130,
                module=float(drive.module),
                pressure_angle=math.radians(25),
                shaft_angle=float(drive.shaft_angle),
            )
            limits = (
                float(limit(drive) * sine) for limit in (independent.inner_limit, independent.outer_limit)
            )
            ratio = shaper_envelope.contact_ratio(plain, *limits)
            yield anchor("geometric_contact_ratio", ratio, BRUTE_FORCE, shaft_angle_deg=shaft)
    yield anchor(
        "geometric_contact_ratio", independent.geometric_contact_ratio(CASE_1), NUMBER, shaft_angle_deg=90
    )


def undercut():
    for number, tangent in enumerate(independent.singular_tangents(CASE_1)):
        yield anchor("roots", tangent, NUMBER, root=number)


def top_land():
    roll, rotation = independent.pointed_point(CASE_1)
    point = CASE_1.to_space(rotation, CASE_1.shaper_point(roll, CASE_1.u_of_contact(roll, rotation)))
    # At a right shaft angle the distance of the generating section is the coordinate along the pinion's axis.
    yield anchor("pointed_distance", point[2], LENGTH)


FIGURES = {
    "ch03_figure_3_05": tooth,
    "ch03_figure_3_09": positions,
    "ch03_figure_3_11": instants,
    "ch03_figure_3_12": motion,
    "ch03_figure_3_13": skew_lines,
    "ch03_figure_4_03": contact_ratios,
    "ch03_mesh_tregold": lambda: total_length(independent.tregold_contact_ratio(CASE_1)),
    "ch03_mesh_geometric": lambda: total_length(independent.geometric_contact_ratio(CASE_1)),
    "ch03_shaft_angle": shaft_angles,
    "ch03_undercut": undercut,
    "ch03_top_land": top_land,
}


def main():
    """Make the anchors of the figures named on the command line, of all when none is."""
    chosen = sys.argv[1:] or list(FIGURES)
    FOLDER.mkdir(parents=True, exist_ok=True)
    for name in tqdm(chosen):
        content = {"figure": name, "route": ROUTE, "anchors": list(FIGURES[name]())}
        text = yaml.safe_dump(content, sort_keys=False, width=110)
        (FOLDER / f"{name}.yaml").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
