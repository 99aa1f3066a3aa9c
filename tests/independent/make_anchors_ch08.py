"""Compute the anchors of the chapter on flexible teeth: `python -m tests.independent.make_anchors_ch08`.

Takes some minutes. Growth rates are those of :mod:`tests.independent.complex_galerkin`: disks and pinions in complex
modes and metres, by DOP853 between the instants at which a pair enters or leaves. Where contact lines are is told by
the package, which the anchors of chapter 3 hold; stiffness of the teeth, rules of sharing and the other flanks are
written here once more.
"""

import math
import sys
from dataclasses import fields, replace
from functools import cache
from itertools import pairwise
from pathlib import Path

import numpy as np
import xarray as xr
import yaml
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import facegear as fg
from facegear.mechanics.cases import CASE_1, CASE_2, EXAMPLE_B
from facegear.support.labelled import load
from tests.independent.complex_galerkin import (
    ComplexDisk,
    Pinion,
    Spring,
    multipliers,
    oscillator_multipliers,
)
from tests.independent.make_anchors_ch04 import nominal_mass, reference_stiffness
from tests.independent.spread_load import Press, PressedDisk
from tests.mechanics.test_transverse import complex_disk

DATA = Path(__file__).resolve().parents[2] / "data"
ROUTE = (
    "tests/independent/complex_galerkin.py: disks and pinions in complex modes and metres, one smooth piece of the "
    "period after the other by DOP853; tolerance 1e-8 of the spectral radius"
)
FORCE_ROUTE = (
    "tests/independent/spread_load.py: plane stress under a body force shot from the bore by DOP853, its work on the "
    "slopes in complex exponentials; growth rates of maps by complex_galerkin.py, tolerance 1e-8 of the spectral radius"
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
    """Place of the one load of a mesh."""

    def position(x):
        radius, own = mean_place(path, np.asarray(x) + phase)
        return radius, own + angle

    return Pinion(position, sorted({0.0, *((x - phase) % 1.0 for x in path.breakpoints)}))


def mean_place(path, time):
    """Radius and angle of the centroid of the pairs, weighted by what the path says they carry."""
    states = path.pair_states(time)
    weight = states.length / states.length.sum(axis=0)
    return (weight * states.radius).sum(axis=0), (weight * states.angle).sum(axis=0)


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
    turn = math.nan if driving else 2.0 * passage_of(path) + 0.5

    def time(x):
        return x + phase if driving else turn - x - phase

    instants = ((x - phase if driving else turn - phase - x) % 1.0 for x in path.breakpoints)
    return time, [0.0, *sorted(instants)]


def passage_of(path):
    """Mesh periods since its entry at which a pair passes the pitch point; under load it is told by the package."""
    drive = path.drive
    if drive.shaper_teeth is not None:
        return path.pitch_passage
    sweep = drive.entry_rotation - drive.exit_rotation
    return (drive.entry_rotation + 0.5 * math.pi / drive.pinion_teeth) / sweep * path.contact_ratio


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
        radius, own = mean_place(path, np.asarray(time(x)))
        return radius, sense * own + angle

    weight = whole(path)
    return Spring(Pinion(position, instants), lambda x: weight(time(x)), number, disk)


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
    tregold = fg.ContactPath(CASE_1.drive)
    for row, column in ((30, 90), (150, 60)):
        at = cell(stored, "as printed: flexible", row, column)
        spring = Spring(centroid(tregold), whole(tregold))
        yield anchor(sprung(CASE_1, with_stiffness(LOADS["I"], at["value"]), [spring], at["speed"]), at)
    at = strongest(stored, "as printed: frozen")
    load = with_stiffness(LOADS["I"], at["value"])
    yield anchor(held(CASE_1, load, [centroid(tregold)], at["speed"]), at)


def bases(stored):
    for label, basis in (
        ("flexible, M, N = 2, 6", (2, 6)),
        ("flexible, M, N = 2, 8", (2, 8)),
        ("equal pairs, M, N = 1, 5", (1, 5)),
    ):
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
        ("length_share", "Tregold's clock", None),
    ):
        at = strongest(stored, f"{rule}; {clock}")
        found = springs_of_pairs(fg.ContactPath(CASE_1.drive, ratio), rule, (0.0, 0.0))
        yield anchor(sprung(CASE_1, with_stiffness(LOADS["I"], at["value"]), found, at["speed"]), at)


def faces(stored):
    for label, body, path in (
        ("as printed", CASE_1, fg.ContactPath(CASE_1.drive)),
        ("line", CASE_1, fg.ContactPath(CASE_1.drive, CASE_1.drive.geometric_contact_ratio)),
        ("load", cut(CASE_1), fg.loaded_contact(RATED)(cut(CASE_1).drive)),
    ):
        at = strongest(stored, label)
        found = [one_spring(path, (0.0, phase), number=k) for k, phase in enumerate((0.0, 0.5))]
        yield anchor(sprung(body, with_stiffness(LOADS["I"], at["value"]), found, at["speed"]), at)


def between(stored):
    for label, body, path in (
        ("input, as printed", CASE_1, fg.ContactPath(CASE_1.drive)),
        ("idler, as printed", CASE_1, fg.ContactPath(CASE_1.drive)),
        ("idler, line", CASE_1, fg.ContactPath(CASE_1.drive, CASE_1.drive.geometric_contact_ratio)),
        ("input, load", cut(CASE_1), fg.loaded_contact(RATED)(cut(CASE_1).drive)),
    ):
        at = strongest(stored, label)
        drives = (True, label.startswith("input"))
        # An idler drives the lower gear and is driven by the upper one.
        found = [
            one_spring(
                path, (0.0, 0.0), driving, sense=(1.0 if driving else -1.0) * (1.0, -1.0)[gear], disk=gear
            )
            for gear, driving in enumerate(drives)
        ]
        load = with_stiffness(LOADS["I"], at["value"])
        yield anchor(sprung(body, load, found, at["speed"], (1.0, -1.0)), at)


def clocking(stored):
    for row, column in ((25, 40), (75, 25)):
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
    body = replace(CASE_1, drive=replace(CASE_1.drive, pinion_teeth=number))
    path = fg.ContactPath(body.drive)
    yield gears_at(strongest(stored, "all"), body, path)
    yield gears_at(cell(stored, "all", 1, 12), body, path)


def gears_at(at, body, path):
    number, step = body.drive.pinion_teeth, body.drive.angular_pitch
    second = round(at["value"])
    roles = ((1, 1), (1, 1), (1, 0), (1, 0), (0, 0))
    found = []
    for k, (place, drives) in enumerate(zip((0, second, 65, 65 + second, 97), roles, strict=True)):
        for gear, driving in enumerate(drives):
            sense = (1.0 if driving else -1.0) * (1.0, -1.0)[gear]
            phase = 0.5 * gear * (number % 2)
            found.append(one_spring(path, (place * step, phase), bool(driving), sense, k, gear))
    return anchor(sprung(body, LOADS["I"], found, at["speed"], (1.0, -1.0)), at)


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
    at = strongest(stored, "line contact, flexible")
    path = fg.ContactPath(body.drive, body.drive.geometric_contact_ratio)
    found = [one_spring(path, place, number=k) for k, place in enumerate(places)]
    yield anchor(sprung(body, load, found, at["speed"]), at)


def tongues(stored):
    """Largest growth of the strongest tongue of one pinion and of two on both faces, at the speed where it has it."""
    path = fg.ContactPath(CASE_1.drive)
    for name, phases in (("one pinion", (0.0,)), ("both faces, half a period", (0.0, 0.5))):
        section = stored.model_name.values.tolist().index(name)
        growth = stored.largest_growth.values[section]
        tongue = int(np.nanargmax(growth))
        found = [one_spring(path, (0.0, phase), number=k) for k, phase in enumerate(phases)]
        value = sprung(CASE_1, LOADS["I"], found, float(stored.peak.values[section, tongue]))
        yield anchor(value, {"section": section, "tongue": tongue}) | {"variable": "largest_growth"}


HORSEPOWER = 745.6998715822702
PINION_SPEED = 5000.0 * math.pi / 30.0


def teeth_at(path, x):
    """Angles of the pairs in mesh at t/T0 and their shares by length."""
    states = path.pair_states(np.atleast_1d(x))
    there = states.in_contact[:, 0]
    return states.angle[there, 0], (states.length / states.length.sum(axis=0))[there, 0]


def press_of(body, name, instant=None):
    """Where the force presses, by the name that the chapter gives it; the pairs in the mean or at an instant."""
    drive, path = body.drive, fg.ContactPath(body.drive)
    face = (drive.inner_radius / drive.outer_radius, 1.0)
    root = drive.module * (math.pi / 2.0 + 2.5 * math.tan(drive.pressure_angle)) / drive.outer_radius
    if name == "point at the rim":
        return Press()
    if name == "point at the pitch radius":
        pitch = drive.module * drive.gear_teeth / 2.0 / drive.outer_radius
        return Press(strip=(pitch, pitch))
    if name == "face width":
        return Press(strip=face)
    if name == "face and root":
        return Press(strip=face, thickness=root)
    found = []
    if instant is not None:
        found.append((1.0, *teeth_at(path, instant)))
    nodes, weights = np.polynomial.legendre.leggauss(24)
    for start, end in pairwise([*path.breakpoints, 1.0] if instant is None else []):
        for node, weight in zip(nodes, weights, strict=True):
            x = (start + end) / 2.0 + (end - start) / 2.0 * node
            found.append(((end - start) / 2.0 * weight, *teeth_at(path, x)))
    angles = np.concatenate([angle for _, angle, _ in found])
    shares = np.concatenate([weight * share for weight, _, share in found])
    return Press(tuple(angles), tuple(shares), face, root)


@cache
def stiffness_of(body, press, speed):
    """K_f of a dead and of a following force with the moment of 1 N at the rim."""
    plain = disk_of(body)
    values = {field.name: getattr(plain, field.name) for field in fields(ComplexDisk)}
    return PressedDisk(**values, force=1.0, harmonics=5, press=press).parts(speed)


def flutter(body, press, part, speed, near):
    """Power at which the disk alone loses its stability, close to one [W]."""
    _, C, K = disk_of(body).constant_matrices(speed)
    dead, follower = stiffness_of(body, press, speed)
    newton = 1.0 / (PINION_SPEED * body.drive.pitch_radius)
    zero, one = np.zeros_like(K), np.eye(len(K))

    def growth(power):
        loaded = K + power * newton * (dead + part * (follower - dead))
        return float(np.linalg.eigvals(np.block([[zero, one], [-loaded, -C]])).real.max())

    assert growth(0.99 * near) < 0.0 < growth(1.01 * near)
    return brentq(growth, 0.99 * near, 1.01 * near, rtol=1e-13)


def value_at(variable, at, value, atol):
    return {"variable": variable, "at": at, "value": float(value), "atol": float(atol)}


def force_spread(stored):
    speed, bodies = 500.0 * math.pi / 30.0, (CASE_1, CASE_2)
    names = stored.spread_name.values.tolist()
    for number, name in ((0, "face width"), (1, "pairs in mesh"), (1, "point at the pitch radius")):
        at = {"body": float(number), "spread": float(names.index(name))}
        body, press = bodies[number], press_of(bodies[number], name)
        parts = stiffness_of(body, press, speed)
        rim = stiffness_of(body, Press(), speed)
        size = np.linalg.norm
        yield value_at("dead", at, size(parts[0]) / size(rim[0]), 1e-8)
        yield value_at("following", at, size(parts[1] - parts[0]) / size(rim[1] - rim[0]), 1e-8)
        yield value_at("change", at, size(parts[1] - rim[1]) / size(rim[1]), 1e-8)
        for variable, part in (("critical", 1.0), ("dead_critical", 0.0)):
            near = float(stored[variable].sel(at))
            yield value_at(variable, at, flutter(body, press, part, speed, near), 1e-7 * near)


def force_tilt(stored):
    for number, body in enumerate((CASE_1, CASE_2)):
        disk, place = complex_disk(body), 48
        r = body.bore_radius + (body.outer_radius - body.bore_radius) * place / 60.0
        for n in (1, 3):
            inside, rim = (float(disk.radial(0, n, np.asarray(at))) / at for at in (r, body.outer_radius))
            at = {"body": float(number), "diameters": float(n), "place": float(place)}
            yield value_at("tilt", at, (inside / rim) ** 2, 1e-9)


def force_part(stored):
    names = stored.spread_name.values.tolist()
    for number, body, way, place in ((0, CASE_1, "pairs in mesh", 6), (1, CASE_2, "point at the rim", 8)):
        part = float(stored.part[place])
        at = {"body": float(number), "spread": float(names.index(way)), "part": part}
        near = float(stored.critical.sel(at))
        found = flutter(body, press_of(body, way), part, 500.0 * math.pi / 30.0, near)
        yield value_at("critical", at, found, 1e-7 * near)


def force_map(stored, body, load):
    """One cell of each spread and direction: the strongest at the highest power."""
    path = fg.ContactPath(body.drive)
    for kind, way in (("growth_rate", 1), ("dead", 1), ("growth_rate", 0)):
        power = float(stored.power[-1])
        growth = stored[kind][way, -1].values
        row, column = np.unravel_index(growth.argmax(), growth.shape)
        at = {"spread": float(way), "power": power}
        at |= {"stiffness": float(stored.stiffness[row]), "speed_rpm": float(stored.speed_rpm[column])}
        speed = at["speed_rpm"] * math.pi / 30.0
        parts = stiffness_of(body, press_of(body, str(stored.spread_name.values[way])), speed)
        added = power / (PINION_SPEED * body.drive.pitch_radius) * parts[1 if kind == "growth_rate" else 0]

        class Loaded(ComplexDisk):
            def constant_matrices(self, speed, added=added):
                M, C, K = super().constant_matrices(speed)
                return M, C, K + added

        plain = complex_disk(body)
        disk = Loaded(**{field.name: getattr(plain, field.name) for field in fields(ComplexDisk)})
        period = 2.0 * math.pi / (body.drive.gear_teeth * speed)
        pinion = pinion_of(body, with_stiffness(load, at["stiffness"]))
        found = np.abs(multipliers(disk, [centroid(path)], speed, period, **pinion)).max()
        yield value_at(kind, at, math.log(found) / period, RADIUS_TOLERANCE / period)


def moving_growth(body, load, newtons, speed, moving):
    """Growth rate of a disk whose following force moves with the pairs, or rests in their mean [1/s]."""
    path, disk = fg.ContactPath(body.drive), disk_of(body)
    _, C, K = disk.constant_matrices(speed)
    pinion, place = pinion_of(body, load), centroid(path)
    period = 2.0 * math.pi / (body.drive.gear_teeth * speed)
    n, waves = len(K), np.repeat(disk.waves, disk.M + 1)
    mean = newtons * stiffness_of(body, press_of(body, "pairs in mesh"), 0.0)[1]
    scale = np.repeat([math.sqrt(np.abs(K).max()), 1.0], n)
    state = np.eye(2 * n, dtype=complex)
    for start, end in pairwise([*path.breakpoints, 1.0]):
        points = (start + end) / 2.0 + (end - start) / 2.0 * np.polynomial.chebyshev.chebpts1(14)
        parts = [stiffness_of(body, press_of(body, "pairs in mesh", x), 0.0)[1] for x in points if moving]
        series = np.polynomial.chebyshev.chebfit(
            np.polynomial.chebyshev.chebpts1(14),
            newtons * np.reshape(parts or [mean / newtons] * 14, (14, -1)),
            13,
        )

        def rates(t, flat, start=start, end=end, series=series):
            x = min(max(t / period, start + 1e-12), end - 1e-12)
            own = np.polynomial.chebyshev.chebval((2.0 * x - start - end) / (end - start), series).reshape(
                n, n
            )
            radius, angle = place.position(np.array([x]))
            shape = np.array(
                [disk.radial(m, abs(k), radius)[0] for k in disk.waves for m in range(disk.M + 1)]
            )
            phi = shape * np.exp(1j * waves * angle[0])
            dyad = np.outer(phi.conj(), phi) / (2.0 * math.pi * disk.rho * disk.h)
            Y = flat.reshape(2 * n, 2 * n) / scale[:, None]
            force = (K + own + pinion["k_b"] * dyad) @ Y[:n] + (C + pinion["c_b"] * dyad) @ Y[n:]
            moved = -np.linalg.solve(np.eye(n) + pinion["m_p"] * dyad, force)
            return (np.concatenate([Y[n:], moved]) * scale[:, None]).ravel()

        first = (state * scale[:, None]).ravel()
        run = solve_ivp(
            rates, (start * period, end * period), first, "DOP853", rtol=1e-9, atol=1e-9 * scale[0]
        )
        assert run.success, run.message
        state = run.y[:, -1].reshape(2 * n, 2 * n) / scale[:, None]
    found = np.abs(np.linalg.eigvals(state * scale[:, None] / scale[None, :])).max()
    return math.log(found) / period


def force_period(stored, body, load, power):
    mean = stiffness_of(body, press_of(body, "pairs in mesh"), 0.0)[1]
    for place in (5, 70):
        x = float(stored.instant[place])
        own = stiffness_of(body, press_of(body, "pairs in mesh", x), 0.0)[1]
        departure = np.linalg.norm(own - mean) / np.linalg.norm(mean)
        yield value_at("departure", {"instant": x}, departure, 1e-6)
    shown = float(stored.speed_rpm[int(np.abs(stored.moving.values - stored["mean"].values).argmax())])
    newtons = power * HORSEPOWER / (PINION_SPEED * body.drive.pitch_radius)
    for variable, moving in (("moving", True), ("mean", False)):
        found = moving_growth(body, load, newtons, shown * math.pi / 30.0, moving)
        # The chapter's steps are of fourth order.
        yield value_at(variable, {"speed_rpm": shown}, found, 1e-3)


def main() -> None:
    """Write the anchors of the figures named, or of all."""
    two_pinions = (0.0, 2.0 * math.pi / 3.0)
    geometric = fg.ContactPath(CASE_1.drive, CASE_1.drive.geometric_contact_ratio)
    loaded = fg.loaded_contact(RATED)(cut(CASE_1).drive)
    jobs = {
        "ch08_maps": maps,
        "ch08_bases": bases,
        "ch08_tongues": tongues,
        "ch08_sharing": sharing,
        "ch08_faces": faces,
        "ch08_between": between,
        "ch08_clocking": clocking,
        "ch08_clocking_rigid": clocking_rigid,
        "ch08_gears_26": lambda stored: gears(stored, 26),
        "ch08_gears_25": lambda stored: gears(stored, 25),
        "ch08_gears_line": lambda stored: [gears_at(strongest(stored, "all"), CASE_1, geometric)],
        "ch08_gears_load": lambda stored: [gears_at(strongest(stored, "all"), cut(CASE_1), loaded)],
        "ch08_verdict_1": lambda stored: verdict(stored, CASE_1, LOADS["I"], (0.0,)),
        "ch08_verdict_2": lambda stored: verdict(stored, CASE_2, LOADS["II"], (0.0,)),
        "ch08_verdict_3": lambda stored: verdict(stored, EXAMPLE_B.body, LOADS["B"], two_pinions),
        "ch08_force_spread": force_spread,
        "ch08_force_tilt": force_tilt,
        "ch08_force_part": force_part,
        "ch08_force_6_06": lambda stored: force_map(stored, CASE_1, LOADS["I"]),
        "ch08_force_6_07": lambda stored: force_map(stored, CASE_2, LOADS["II"]),
        "ch08_force_period_1": lambda stored: force_period(stored, CASE_1, LOADS["I"], 300.0),
        "ch08_force_period_2": lambda stored: force_period(stored, CASE_2, LOADS["II"], 1000.0),
    }
    for name, compute in jobs.items():
        if sys.argv[1:] and name not in sys.argv[1:]:
            continue
        stored: xr.Dataset = load(DATA / "reference" / f"{name}.nc")
        route = FORCE_ROUTE if name.startswith("ch08_force") else ROUTE
        content = {"figure": name, "route": route, "anchors": list(compute(stored))}
        (DATA / "anchors" / f"{name}.yaml").write_text(
            yaml.safe_dump(content, sort_keys=False, allow_unicode=True)
        )
        sys.stdout.write(f"{name}: {len(content['anchors'])} anchors\n")
        sys.stdout.flush()


if __name__ == "__main__":
    main()
