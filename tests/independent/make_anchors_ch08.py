"""Compute the anchors of the chapter on flexible teeth: `python -m tests.independent.make_anchors_ch08`.

Takes some minutes. Growth rates are those of :mod:`tests.independent.complex_galerkin`: disks and pinions in complex
modes and metres, by DOP853 between the instants at which a pair enters or leaves. Where contact lines are is told by
the package, which the anchors of chapter 3 hold; stiffness of the teeth, rules of sharing and the other flanks are
written here once more.
"""

import math
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import xarray as xr
import yaml

import facegear as fg
from facegear.mechanics.cases import CASE_1, CASE_2, EXAMPLE_B
from facegear.support.labelled import load
from tests.independent.complex_galerkin import Pinion, Spring, multipliers, oscillator_multipliers
from tests.independent.make_anchors_ch04 import nominal_mass, reference_stiffness
from tests.mechanics.test_transverse import complex_disk

DATA = Path(__file__).resolve().parents[2] / "data"
ROUTE = (
    "tests/independent/complex_galerkin.py: disks and pinions in complex modes and metres, one smooth piece of the "
    "period after the other by DOP853; tolerance 1e-8 of the spectral radius"
)
RADIUS_TOLERANCE = 1e-8
LOADS = {"I": (1.0, 3e-6, 1.0), "II": (1.0, 1e-6, 1.0), "B": (0.25, 1e-5, 1.0)}
RATED = 600.0 * 745.6998715822702 / (5000.0 * math.pi / 30.0)


def anchor(found, at):
    """Growth rate and its error [1/s] at a place."""
    growth, error = found
    return {
        "variable": "growth_rate",
        "at": {key: float(number) for key, number in at.items()},
        "value": float(growth),
        "atol": float(error),
    }


def disk_of(body):
    """Return the disk of the complex form, its modes continued beyond the rim, where a pair enters mesh."""

    def radial(m, n, r):
        return body.modes[n].continued(np.asarray(r) / body.outer_radius, 0)[m] / body.outer_radius

    return replace(complex_disk(body), radial=radial)


def tooth_pair(body):
    """k_m sin²α_c of (7-1) and (7-2) with c_f = 0.5."""
    m, alpha = body.drive.module, body.drive.pressure_angle
    tooth = 200e9 * (math.pi * m) ** 3 * body.drive.face_width / (32.0 * (2.25 * m) ** 3 * math.cos(alpha))
    return 0.5 * tooth / 2.0 * math.sin(alpha) ** 2


def pinion_of(body, load):
    stiffness, damping, mass = load
    k_b = stiffness * reference_stiffness(body)
    return {"m_p": mass * nominal_mass(body), "c_b": damping * k_b, "k_b": k_b}


def centroid(path, angle=0.0, phase=0.0):
    """Place of the one load of a mesh: the mean of the pairs, weighted by what the path says they carry."""

    def position(x):
        states = path.pair_states(np.asarray(x) + phase)
        weight = states.length / states.length.sum(axis=0)
        return (weight * states.radius).sum(axis=0), (weight * states.angle).sum(axis=0) + angle

    return Pinion(position, sorted({0.0, *((x - phase) % 1.0 for x in path.breakpoints)}))


def whole(path):
    """Stiffness of all pairs over k_m: cr of them, or what the load gives them."""

    def weight(x):
        states = path.pair_states(np.asarray(x))
        if states.stiffness is None:
            return np.full(np.shape(x), path.contact_ratio)
        return states.stiffness.sum(axis=0)

    return weight


def parts(rule, states, ratio):
    if rule == "length_share":
        return ratio * states.length / states.length.sum(axis=0)
    return states.in_contact.astype(float)


def clock(path, phase, driving):
    """Mesh time of a flank against t/T0 and its instants; a driven one runs a driving one's backwards."""
    drive = path.drive
    sweep = drive.entry_rotation - drive.exit_rotation
    passage = (drive.entry_rotation + 0.5 * math.pi / drive.pinion_teeth) / sweep * path.contact_ratio
    turn = 2.0 * passage + 0.5

    def time(x):
        return x + phase if driving else turn - x - phase

    instants = ((x - phase if driving else turn - phase - x) % 1.0 for x in path.breakpoints)
    return time, [0.0, *sorted(instants)]


def springs_of_pairs(path, rule, place, driving=True, sense=1.0, number=0, disk=0):
    """Every pair of a mesh at a place (angle, phase); a driven flank is the mirror of a driving one."""
    angle, phase = place
    time, instants = clock(path, phase, driving)
    found = []
    for pair in range(path.pairs):

        def position(x, pair=pair):
            there = path.pair_states(time(x))
            radius = np.where(there.in_contact[pair], there.radius[pair], path.drive.outer_radius)
            return radius, sense * there.angle[pair] + angle

        def weight(x, pair=pair):
            return parts(rule, path.pair_states(time(x)), path.contact_ratio)[pair]

        found.append(Spring(Pinion(position, instants), weight, number, disk))
    return found


def one_spring(path, place, driving=True, sense=1.0, number=0, disk=0):
    """Teeth of one mesh as one spring at the centroid of its lines."""
    angle, phase = place
    time, instants = clock(path, phase, driving)

    def position(x):
        there = path.centroid(time(x))
        return there.radius, sense * there.angle + angle

    return Spring(
        Pinion(position, instants), lambda x: np.full(np.shape(x), path.contact_ratio), number, disk
    )


def sprung(body, load, springs, speed_rpm, senses=(1.0,)):
    """Growth rate with pinions on springs, and its error [1/s]."""
    period = 60.0 / (body.drive.gear_teeth * speed_rpm)
    speed, k_z = 2.0 * math.pi * speed_rpm / 60.0, tooth_pair(body)
    turning = [sense * speed for sense in senses]
    found = oscillator_multipliers(
        disk_of(body), springs, turning, period, k_z=k_z, c_z=1e-5 * k_z, **pinion_of(body, load)
    )
    return math.log(np.abs(found).max()) / period, RADIUS_TOLERANCE / period


def held(body, load, places, speed_rpm):
    """Growth rate with rigid pinions and frozen rate, and its error [1/s]."""
    period = 60.0 / (body.drive.gear_teeth * speed_rpm)
    found = multipliers(
        complex_disk(body), places, 2.0 * math.pi * speed_rpm / 60.0, period, **pinion_of(body, load)
    )
    return math.log(np.abs(found).max()) / period, RADIUS_TOLERANCE / period


def cell(stored, label, row, column):
    """Place of a cell, its value of the parameter, and its speed [rpm]."""
    model = stored.model_name.values.tolist().index(label)
    value, speed = float(stored.value[row]), float(stored.speed[column])
    return {"model": model, "value": value, "speed": speed}


def strongest(stored, label):
    """Return the cell of the largest growth rate."""
    growth = stored.growth_rate[stored.model_name.values.tolist().index(label)].values
    return cell(stored, label, *np.unravel_index(growth.argmax(), growth.shape))


def cut(body):
    return replace(body, drive=replace(body.drive, shaper_teeth=body.drive.pinion_teeth + 1))


def with_stiffness(load, stiffness):
    return (stiffness, *load[1:])


def maps(stored):
    geometric = fg.ContactPath(CASE_1.drive, CASE_1.drive.geometric_contact_ratio)
    loaded = fg.loaded_contact(RATED)(cut(CASE_1).drive)
    for label, body, path in (
        ("as printed: flexible", CASE_1, fg.ContactPath(CASE_1.drive)),
        ("line: flexible", CASE_1, geometric),
        ("load: flexible", cut(CASE_1), loaded),
    ):
        at = strongest(stored, label)
        spring = Spring(centroid(path), whole(path))
        yield anchor(sprung(body, with_stiffness(LOADS["I"], at["value"]), [spring], at["speed"]), at)
    at = strongest(stored, "as printed: frozen")
    load = with_stiffness(LOADS["I"], at["value"])
    yield anchor(held(CASE_1, load, [centroid(fg.ContactPath(CASE_1.drive))], at["speed"]), at)


def bases(stored):
    for label, basis in (("flexible, M, N = 2, 6", (2, 6)), ("equal pairs, M, N = 1, 5", (1, 5))):
        body = replace(CASE_1, nodal_circles=basis[0], nodal_diameters=basis[1])
        path, at = fg.ContactPath(CASE_1.drive), strongest(stored, label)
        found = [one_spring(path, (0.0, 0.0))]
        if label.startswith("equal"):
            found = springs_of_pairs(path, "equal", (0.0, 0.0))
        yield anchor(sprung(body, LOADS["I"], found, at["speed"]), at)


def sharing(stored):
    geometric = CASE_1.drive.geometric_contact_ratio
    for rule, clock, ratio in (
        ("equal", "Tregold's clock", None),
        ("length_share", "clock of the true sweep", geometric),
        ("equal", "clock of the true sweep", geometric),
    ):
        at = strongest(stored, f"{rule}; {clock}")
        found = springs_of_pairs(fg.ContactPath(CASE_1.drive, ratio), rule, (0.0, 0.0))
        yield anchor(sprung(CASE_1, with_stiffness(LOADS["I"], at["value"]), found, at["speed"]), at)


def clocking(stored):
    for row, column in ((8, 40), (3, 25)):
        at = cell(stored, "flexible teeth", row, column)
        path = fg.ContactPath(CASE_1.drive)
        found = [one_spring(path, (0.0, phase), number=k) for k, phase in enumerate((0.0, at["value"]))]
        yield anchor(sprung(CASE_1, LOADS["I"], found, at["speed"]), at)


def clocking_rigid(stored):
    for row, column in ((8, 40), (3, 25)):
        at = cell(stored, "all", row, column)
        path = fg.ContactPath(CASE_1.drive)
        places = [centroid(path, phase=phase) for phase in (0.0, at["value"])]
        yield anchor(held(CASE_1, LOADS["I"], places, at["speed"]), at)


def gears(stored, number):
    at = strongest(stored, "all")
    body = replace(CASE_1, drive=replace(CASE_1.drive, pinion_teeth=number))
    path, step = fg.ContactPath(body.drive), body.drive.angular_pitch
    second = round(at["value"])
    roles = ((1, 1), (1, 1), (1, 0), (1, 0), (0, 0))
    found = []
    for k, (place, drives) in enumerate(zip((0, second, 65, 65 + second, 97), roles, strict=True)):
        for gear, driving in enumerate(drives):
            sense = (1.0 if driving else -1.0) * (1.0, -1.0)[gear]
            phase = 0.5 * gear * (number % 2)
            found.append(one_spring(path, (place * step, phase), bool(driving), sense, k, gear))
    yield anchor(sprung(body, LOADS["I"], found, at["speed"], (1.0, -1.0)), at)


def verdict(stored, body, load, angles):
    path = fg.ContactPath(body.drive)
    places = [(angle, (angle / body.drive.angular_pitch) % 1.0) for angle in angles]
    at = strongest(stored, "as printed")
    yield anchor(held(body, load, [centroid(path, *place) for place in places], at["speed"]), at)
    at = strongest(stored, "flexible, equal pairs")
    found = [
        spring
        for k, place in enumerate(places)
        for spring in springs_of_pairs(path, "equal", place, number=k)
    ]
    yield anchor(sprung(body, load, found, at["speed"]), at)


def main() -> None:
    """Write the anchors of the figures named, or of all."""
    two_pinions = (0.0, 2.0 * math.pi / 3.0)
    jobs = {
        "ch08_maps": maps,
        "ch08_bases": bases,
        "ch08_sharing": sharing,
        "ch08_clocking": clocking,
        "ch08_clocking_rigid": clocking_rigid,
        "ch08_gears_26": lambda stored: gears(stored, 26),
        "ch08_gears_25": lambda stored: gears(stored, 25),
        "ch08_verdict_1": lambda stored: verdict(stored, CASE_1, LOADS["I"], (0.0,)),
        "ch08_verdict_2": lambda stored: verdict(stored, CASE_2, LOADS["II"], (0.0,)),
        "ch08_verdict_3": lambda stored: verdict(stored, EXAMPLE_B.body, LOADS["B"], two_pinions),
    }
    for name, compute in jobs.items():
        if sys.argv[1:] and name not in sys.argv[1:]:
            continue
        stored: xr.Dataset = load(DATA / "reference" / f"{name}.nc")
        content = {"figure": name, "route": ROUTE, "anchors": list(compute(stored))}
        (DATA / "anchors" / f"{name}.yaml").write_text(
            yaml.safe_dump(content, sort_keys=False, allow_unicode=True)
        )
        sys.stdout.write(f"{name}: {len(content['anchors'])} anchors\n")
        sys.stdout.flush()


if __name__ == "__main__":
    main()
