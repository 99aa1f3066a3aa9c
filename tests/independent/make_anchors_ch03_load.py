"""Compute the anchors of the chapter on contact under load: `python -m tests.independent.make_anchors_ch03_load`.

Takes some minutes. Contact comes from :mod:`tests.independent.loaded_contact`, which does not import facegear. Growth
rates are those of :mod:`tests.independent.complex_galerkin` for disks, and of the three equations of motion integrated
here for gearboxes, both by DOP853; they take the place and the stiffness of the load from the package, which the
anchors of contact hold, and where a growth rate is largest from the stored arrays.
"""

import math
import sys
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import mpmath
import numpy as np
import xarray as xr
import yaml
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import facegear as fg
from facegear.mechanics.cases import CASE_1, CASE_2
from facegear.mechanics.gearboxes import FIGURES
from facegear.support.labelled import load
from tests.independent.complex_galerkin import Pinion, multipliers, total_rate_multipliers
from tests.independent.loaded_contact import LoadedContact
from tests.independent.make_anchors_ch04 import nominal_mass, reference_stiffness
from tests.mechanics.test_transverse import complex_disk

DATA = Path(__file__).resolve().parents[2] / "data"
CONTACT_ROUTE = (
    "tests/independent/loaded_contact.py: gap, lines and equilibrium from their definitions, by quadrature and root "
    "finding in 30-digit arithmetic"
)
DISK_ROUTE = (
    "tests/independent/complex_galerkin.py: (4-8) to (4-13) in complex exponentials, one smooth piece of the period "
    "after the other by DOP853 at 1e-12; tolerance 1e-8 of the spectral radius"
)
GEARBOX_ROUTE = (
    "tests/independent/make_anchors_ch03_load.py: three equations of motion with the constant lever, by DOP853 between "
    "the instants where a pair changes its state, rtol 1e-13"
)
MODULE = "3.175e-3"
RADIUS_TOLERANCE = 1e-8
NODES, WEIGHTS = np.polynomial.legendre.leggauss(60)
TEETH = {0: (26, 130), 1: (31, 155)}
BODIES = (CASE_1, CASE_2)
DAMPING = (3e-6, 1e-6)


def anchor(variable, value, atol, **at):
    return {
        "variable": variable,
        "at": {key: float(number) for key, number in at.items()},
        "value": float(value),
        "atol": float(atol),
    }


def contact(torque, law, more=1, teeth=(26, 130), **errors):
    return LoadedContact(teeth, teeth[0] + more, MODULE, repr(float(torque)), law, **errors)


# --- contact ------------------------------------------------------------------------------------------------------


def pattern(stored):
    """Root and marking band of parallel errors in closed form and by root finding."""
    for row, name in ((0, "offset"), (1, "gear_axial")):
        for step in (3, 10, 18):
            size = repr(float(stored["size"][row, step]))
            one = contact(1.0, "slice", **{name: mpmath.mpf(size)})
            yield anchor("position", one.K / mpmath.cos(one.q0), 1e-11, error=row, step=step)
            ends = one.reach(mpmath.mpf("6.35e-6"))
            for end, q in zip(("inner", "outer"), ends, strict=True):
                u = one.K / mpmath.cos(q)
                if one.inner < u < one.outer:
                    yield anchor(end, u, 1e-11, error=row, step=step)


def unloaded(one):
    """Contact ratio without load: line of action from the gear's tooth top to the pinion's tip."""
    alpha, m = one.alpha, one.own.module
    tip = mpmath.sqrt((one.own.pitch_radius + m) ** 2 - one.rb1**2)
    action = tip - one.rb1 * mpmath.tan(alpha) + m / mpmath.sin(alpha)
    return action / (mpmath.pi * m * mpmath.cos(alpha))


def ratio(stored):
    for law, more, place in ((0, 1, 10), (0, 3, 15), (1, 1, 12), (1, 2, 17)):
        torque = float(stored.torque[place])
        one = contact(torque, ("slice", "pair")[law], more)
        yield anchor("contact_ratio", one.stops() - one.begins(), 1e-10, law=law, more=more, torque=torque)
    for more in (1, 2, 3):
        yield anchor("unloaded", unloaded(contact(1.0, "pair", more)), 1e-11, more=more)


def misaligned(stored):
    for law, torque, error, step in ((0, 10.0, 0, 2), (0, 1000.0, 1, 8), (1, 10.0, 1, 7), (1, 100.0, 0, 9)):
        name = stored.error_name.values[error]
        size = repr(float(stored["size"][error, step]))
        one = contact(torque, ("slice", "pair")[law], **{name: mpmath.mpf(size)})
        at = {"law": law, "torque": torque, "error": error, "step": step}
        yield anchor("contact_ratio", one.stops() - one.begins(), 1e-10, **at)


def period(stored):
    for law, torque in ((0, 10.0), (0, 300.0), (1, 100.0)):
        one = contact(torque, ("slice", "pair")[law])
        begins = one.begins()
        for place in (30, 125):
            time = float(stored.time[place])
            phase = (mpmath.mpf(repr(time)) + begins) % 1
            level = one.approach(phase)
            # From the youngest that is pressed on: a pair begins at `begins`.
            ages = [mpmath.mpf(repr(time)) + begins + k for k in range(4)]
            forces = [one.pair(level, age) for age in ages]
            at = {"law": law, "torque": torque, "time": time}
            yield anchor("approach", level, 1e-15, **at)
            yield anchor("stiffness", sum(f[1] for f in forces) / one.k, 1e-10, **at)
            for k in range(2):
                yield anchor("share", forces[k][0] / one.force, 1e-10, pair=k, **at)


def last_line(one):
    """Age at which nothing of a line is left on both flanks."""
    return mpmath.findroot(
        lambda age: one.ends(one.line(age))[1] - one.ends(one.line(age))[0], (2, 5), "illinois"
    )


def plates(stored):
    """Yield what plates cannot change: contact without load, and of a load that spans the face."""
    one = contact(1.0, "pair")
    yield anchor("unloaded", unloaded(one), 1e-11, more=1)
    yield anchor("contact_ratio", last_line(one), 1e-10, law=0, more=1, torque=float(stored.torque[-1]))


def flank(stored):
    """Yield the ends of lines, and what presses there."""
    for torque, place in ((30.0, 40), (300.0, 80), (3.0, 65)):
        one = contact(torque, "slice")
        age = last_line(one) * (place + 1) / (stored.sizes["age"] + 1)
        level = one.approach(age % 1)
        for point, q in zip((0, stored.sizes["point"] - 1), one.ends(one.line(age)), strict=True):
            roll = q - one.line(age)
            at = {"age": float(stored.age[place]), "point": point}
            yield anchor("position", one.K / mpmath.cos(q), 1e-10, **at)
            depth = one.rb * (mpmath.cos(q) + roll * mpmath.sin(q)) - one.shaper.tooth_top
            yield anchor("height", depth, 1e-10, **at)
            pressed = max(level - one.gap(q), 0) * one.k / (one.outer - one.inner)
            yield anchor("pressure", pressed, 1e-3, torque=torque, **at)


def swing(stored):
    one = contact(10.0, "slice")
    begins = one.begins()
    for place in (40, 170, 260):
        time = float(stored.time[place])
        phase = (mpmath.mpf(repr(time)) + begins) % 1
        level = one.approach(phase)
        forces = one.all_pairs(level, phase)
        radius = sum(f[2] for f in forces) / sum(f[0] for f in forces)
        yield anchor("radius", radius, 1e-10, contact=2, time=time)


# --- disks --------------------------------------------------------------------------------------------------------


def pinion(path):
    """Mean point of all pairs, weighted by what the path says they carry."""

    def position(fraction):
        states = path.pair_states(np.asarray(fraction))
        weight = states.length / states.length.sum(axis=0)
        return (weight * states.radius).sum(axis=0), (weight * states.angle).sum(axis=0)

    return Pinion(position, path.breakpoints)


def disk_growth(body, path, speed_rpm, stiffness, damping, rate="frozen"):
    """Growth rate [1/s], and the error of it that 1e-8 of the spectral radius makes."""
    k_b = stiffness * reference_stiffness(body)
    period = 60.0 / (body.drive.gear_teeth * speed_rpm)
    loads = {"m_p": nominal_mass(body), "c_b": damping * k_b, "k_b": k_b}
    speed = 2.0 * math.pi * speed_rpm / 60.0
    if rate == "total":
        found = total_rate_multipliers(complex_disk(body), pinion(path), speed, period, **loads)
    else:
        found = multipliers(complex_disk(body), [pinion(path)], speed, period, **loads)
    return math.log(np.abs(found).max()) / period, RADIUS_TOLERANCE / period


def cut(body):
    return fg.Drive(*TEETH[BODIES.index(body)], float(MODULE), shaper_teeth=TEETH[BODIES.index(body)][0] + 1)


def path_of(label, body):
    """Path of a contact by its name in the arrays."""
    if label.endswith("as printed"):
        return fg.ContactPath(body.drive)
    if label == "line":
        return fg.ContactPath(body.drive, body.drive.geometric_contact_ratio)
    law, torque = label.split()
    return fg.loaded_contact(float(torque), compliance="pair" if law == "pair" else "slice")(cut(body))


def shares(stored):
    labels = stored.contact_name.values.tolist()
    for label, case in (("as printed", 0), ("line", 1), ("pair 1000", 0), ("slice 60", 1), ("total 15", 0)):
        place = labels.index(label)
        body, path = BODIES[case], path_of(label, BODIES[case])
        value, error = disk_growth(
            replace(body, drive=path.drive),
            path,
            float(stored.speed_of_largest[place, case]),
            float(stored.value_of_largest[place, case]),
            DAMPING[case],
            "total" if label.startswith("total") else "frozen",
        )
        yield anchor("largest", value, error, contact=place, drive=case)


def torque_map(stored, case, stiffness):
    growth = stored.growth_rate.values
    places = [np.unravel_index(growth.argmax(), growth.shape), (4, 60), (12, 80)]
    for row, column in places:
        torque, speed = float(stored.torque[row]), float(stored.speed[column])
        path = fg.loaded_contact(torque)(cut(BODIES[case]))
        value, error = disk_growth(
            replace(BODIES[case], drive=path.drive), path, speed, stiffness, DAMPING[case]
        )
        yield anchor("growth_rate", value, error, torque=torque, speed=speed)


def outside(stored, rated):
    for place, law, options in ((2, "slice", {"offset": 2e-5, "gear_axial": 4e-5}), (5, "pair", {})):
        path = fg.loaded_contact(rated, fg.Misalignment(**options), law)(cut(CASE_1))
        value, error = disk_growth(
            replace(CASE_1, drive=path.drive),
            path,
            float(stored.speed_of_largest[place, 0]),
            float(stored.value_of_largest[place, 0]),
            DAMPING[0],
        )
        yield anchor("largest", value, error, contact=place, drive=0)


def faster(stored, rated):
    path = fg.loaded_contact(rated)(cut(CASE_1))
    value, error = disk_growth(
        replace(CASE_1, drive=path.drive),
        path,
        float(stored.speed_of_largest[0, 0]),
        float(stored.value_of_largest[0, 0]),
        DAMPING[0],
    )
    yield anchor("largest", value, error, contact=0, drive=0)


def designed(teeth, thickness, torque, law="slice"):
    """Body of Fig. 4.9 cut by a larger shaper, and its path under load."""
    path = fg.loaded_contact(torque, compliance=law)(
        fg.Drive(teeth, 5 * teeth, float(MODULE), shaper_teeth=teeth + 1)
    )
    return fg.Body(path.drive, thickness), path


def design_map(stored, teeth):
    growth = stored.growth_rate.values
    for row, column in (np.unravel_index(growth.argmax(), growth.shape), (2, 40), (6, 15)):
        torque, speed = float(stored.torque[row]), float(stored.speed[column])
        value, error = disk_growth(*designed(teeth, 0.032, torque), speed, 0.8, 1e-5)
        yield anchor("growth_rate", value, error, torque=torque, speed=speed)


def designs(stored):
    labels = stored.contact_name.values.tolist()
    for label, case in (("slice 60", 0), ("pair 60", 1), ("pair 1000", 2), ("as printed", 1)):
        place, teeth = labels.index(label), (25, 28, 32)[case]
        thickness = float(stored.value_of_largest[place, case])
        if label == "as printed":
            body = fg.Body(fg.Drive(teeth, 5 * teeth, float(MODULE)), thickness)
            path = fg.ContactPath(body.drive)
        else:
            law, torque = label.split()
            body, path = designed(teeth, thickness, float(torque), law)
        speed = float(stored.speed_of_largest[place, case])
        value, error = disk_growth(body, path, speed, 0.8, 1e-5)
        yield anchor("largest", value, error, contact=place, drive=case)


# --- gearboxes ----------------------------------------------------------------------------------------------------


class Lumped:
    """Three inertias, two shafts, and one spring on the line of action whose stiffness goes with the pairs."""

    def __init__(self, gearbox, torque, law):
        self.box = gearbox
        teeth = gearbox.drive.pinion_teeth
        drive = fg.Drive(teeth, gearbox.drive.gear_teeth, gearbox.drive.module, shaper_teeth=teeth + 1)
        self.contact = fg.LoadedContact(drive, torque, compliance=law)
        # The constant lever of the conjugate tooth about the face gear's axis.
        base = drive.module * teeth / 2.0 * math.cos(math.radians(25.0))
        self.phi = np.array([base, -base * gearbox.drive.gear_teeth / teeth, 0.0])
        self.edges = [*self.contact.breakpoints, 1.0]
        b = gearbox
        self.mass = np.array([b.pinion_inertia, b.gear_inertia, b.load_inertia])
        self.shafts = [
            np.array([[first, 0, 0], [0, second, -second], [0, -second, second]])
            for first, second in (
                (b.input_stiffness, b.output_stiffness),
                (b.input_damping, b.output_damping),
            )
        ]

    def weight(self, x, edges):
        """Stiffness of all pairs over that of one, inside a piece."""
        middle, half = sum(edges) / 2.0, (edges[1] - edges[0]) / 2.0
        inside = np.clip(x, middle - half * (1 - 1e-9), middle + half * (1 - 1e-9))
        return float(self.contact.mesh_stiffness(inside)) / self.contact.pair_stiffness

    def run(self, period, start, forced, samples=False):
        """Motion over a period from columns of states (6, m); with `samples` also the mesh's states at instants."""
        box, phi, state, out = self.box, self.phi, start.astype(float), []
        error = self.contact.excitation
        slope = error.derivative()
        for edges in pairwise(self.edges):
            side = sum(edges) / 2.0

            def rate(x, flat, edges=edges, side=side):
                q, v = flat.reshape(2, 3, -1)
                w = self.weight(x, edges)
                inside = min(max(x, edges[0] + 1e-13), edges[1] - 1e-13)
                e = float(error(inside)[0]) * forced
                e_dot = float(slope(inside)[0]) / period * forced
                force = w * (box.mesh_stiffness * (phi @ q - e) + box.mesh_damping * (phi @ v - e_dot))
                torque = self.shafts[0] @ q + self.shafts[1] @ v + np.outer(phi, force)
                return np.concatenate([v, -torque / self.mass[:, np.newaxis]]).ravel() * period

            times = side + (edges[1] - edges[0]) / 2.0 * NODES if samples else None
            result = solve_ivp(
                rate,
                edges,
                state.ravel(),
                method="DOP853",
                rtol=1e-12,
                atol=1e-18,
                t_eval=times,
                dense_output=True,
            )
            assert result.success, side
            state = result.sol(edges[1]).reshape(6, -1)
            if samples:
                out.append((times, result.y))
        return (state, out) if samples else state


KINDS = ("7.9a", "7.11a", "7.11b", "7.12a", "7.12b", "7.13a")


def growth_of(lumped, speed):
    """Growth rate [1/s] at a speed [rpm], and the period [s]."""
    period = 60.0 / (lumped.box.drive.gear_teeth * speed)
    scale = np.diag([1.0, 1.0, 1.0, 1e3, 1e3, 1e3])
    matrix = np.linalg.solve(scale, lumped.run(period, scale, 0.0))
    return math.log(np.abs(np.linalg.eigvals(matrix)).max()) / period, period


def gearbox_tongues(stored):
    """Borders of the widest tongues with rigid pairs, where motions grow by 1e-7 a period."""

    def beyond(speed, lumped):
        growth, period = growth_of(lumped, speed)
        return growth - 1e-7 / period

    labels = stored.attrs["contacts"].split("; ")
    widths = (stored.upper - stored.lower).values
    of_pairs = [k for k, contact in enumerate(stored.contact.values) if labels[contact].startswith("pair")]
    for k in sorted(of_pairs, key=lambda k: -widths[k])[:2]:
        law, torque = labels[int(stored.contact[k])].split()
        lumped = Lumped(FIGURES[KINDS[int(stored.gearbox[k])]].gearbox.in_si, float(torque), law)
        for name, side in (("lower", -1.0), ("upper", 1.0)):
            # Searched from the middle of the tongue out to where the growth rate is negative.
            start = float(stored.lower[k] + stored.upper[k]) / 2.0
            if not 160.5 < float(stored[name][k]) < 999.5:
                continue
            end = start + side * 0.75 * float(widths[k])
            border = brentq(beyond, start, end, args=(lumped,), xtol=1e-7)
            yield anchor(name, border, 1e-4, tongue=k)


def gearbox_growth(stored):
    labels = stored.contact_name.values.tolist()
    for row, label in ((3, "slice 1000"), (3, "pair 60"), (1, "pair 1000"), (0, "slice 60")):
        law, torque = label.split()
        lumped = Lumped(FIGURES[KINDS[row]].gearbox.in_si, float(torque), law)
        place = labels.index(label)
        value, period = growth_of(lumped, float(stored.speed_of_largest[row, place]))
        yield anchor("largest", value, RADIUS_TOLERANCE / period, gearbox=row, contact=place)


def response(stored):
    for torque, column in ((60.0, 40), (1000.0, 120)):
        lumped = Lumped(FIGURES["7.12a"].gearbox.in_si, torque, "slice")
        speed = float(stored.speed[column])
        period = 60.0 / (lumped.box.drive.gear_teeth * speed)
        free = lumped.run(period, np.eye(6), 0.0)
        from_rest = lumped.run(period, np.zeros((6, 1)), 1.0)
        steady = np.linalg.solve(np.eye(6) - free, from_rest)
        _, pieces = lumped.run(period, steady, 1.0, samples=True)
        error, slope = lumped.contact.excitation, lumped.contact.excitation.derivative()
        mean = square = 0.0
        for (times, states), edges in zip(pieces, pairwise(lumped.edges), strict=True):
            u = lumped.phi @ states[:3] - error(times)[:, 0]
            v = lumped.phi @ states[3:] - slope(times)[:, 0] / period
            weight = lumped.contact.mesh_stiffness(times) / lumped.contact.pair_stiffness
            force = weight * (lumped.box.mesh_stiffness * u + lumped.box.mesh_damping * v)
            # Gauss–Legendre on each piece.
            share = (edges[1] - edges[0]) / 2.0 * WEIGHTS
            mean, square = mean + share @ force, square + share @ force**2
        value = math.sqrt(square - mean**2) / lumped.contact.force
        yield anchor("dynamic_force", value, 1e-6 * value, torque=torque, speed=speed)


def main() -> None:
    """Write the anchors of the figures named, or of all."""
    rated = float(fg.watt(600.0) / fg.rad_per_s(5000.0))
    jobs = {
        "ch03_load_pattern": (CONTACT_ROUTE, pattern),
        "ch03_load_ratio": (CONTACT_ROUTE, ratio),
        "ch03_load_misaligned": (CONTACT_ROUTE, misaligned),
        "ch03_load_period": (CONTACT_ROUTE, period),
        "ch03_load_flank": (CONTACT_ROUTE, flank),
        "ch03_load_swing": (CONTACT_ROUTE, swing),
        "ch03_load_plates": (CONTACT_ROUTE, plates),
        "ch03_load_share": (DISK_ROUTE, shares),
        "ch03_load_map_1": (DISK_ROUTE, lambda stored: torque_map(stored, 0, 0.6)),
        "ch03_load_map_2": (DISK_ROUTE, lambda stored: torque_map(stored, 1, 0.25)),
        **{
            f"ch03_load_design_{k}": (DISK_ROUTE, lambda stored, teeth=teeth: design_map(stored, teeth))
            for k, teeth in enumerate((25, 28, 32), start=1)
        },
        "ch03_load_designs": (DISK_ROUTE, designs),
        "ch03_load_outside": (DISK_ROUTE, lambda stored: outside(stored, rated)),
        "ch03_load_faster": (DISK_ROUTE, lambda stored: faster(stored, rated)),
        "ch03_load_gearboxes": (GEARBOX_ROUTE, gearbox_growth),
        "ch03_load_tongues": (GEARBOX_ROUTE, gearbox_tongues),
        "ch03_load_response": (GEARBOX_ROUTE, response),
    }
    for name, (route, compute) in jobs.items():
        if sys.argv[1:] and name not in sys.argv[1:]:
            continue
        stored: xr.Dataset = load(DATA / "reference" / f"{name}.nc")
        content = {"figure": name, "route": route, "anchors": list(compute(stored))}
        (DATA / "anchors" / f"{name}.yaml").write_text(
            yaml.safe_dump(content, sort_keys=False, allow_unicode=True)
        )
        sys.stdout.write(f"{name}: {len(content['anchors'])} anchors\n")


if __name__ == "__main__":
    main()
